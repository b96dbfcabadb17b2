/* What a solution is made of: a vector, element pressures, histories of the material, the place it started from. */
#include "problemimpl.h"

PetscErrorCode StateCreate(Problem p, State *s)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  const ForestTables *t = ForestGetTables(p->forest);
  PetscCall(ProblemCreateVector(p, &s->x));
  PetscCall(MechanicsNumPressure(p->mechanics, &s->num_pressure));
  PetscCall(PetscCalloc1(s->num_pressure, &s->pressure));
  PetscCall(MechanicsNumHistory(p->mechanics, &s->num_history));
  PetscCall(PetscMalloc1(s->num_history, &s->history));
  PetscCall(MechanicsInitialHistory(p->mechanics, s->history));
  if (InterfaceSlips(p->interface)) {
    s->num_before = p->num_local + p->num_z;
    PetscCall(PetscCalloc1(s->num_before, &s->before));
  }
  s->form       = FormPlain(PETSC_FALSE);
  s->num_leaves = t->num_leaves;
  PetscCall(PetscMalloc1(s->num_leaves, &s->leaf_order));
  PetscCall(PetscArraycpy(s->leaf_order, p->leaf_order, s->num_leaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateCopy(const State *from, State *to)
{
  PetscFunctionBegin;
  PetscCall(VecCopy(from->x, to->x));
  PetscCall(PetscArraycpy(to->pressure, from->pressure, from->num_pressure));
  PetscCall(PetscArraycpy(to->history, from->history, from->num_history));
  PetscCall(PetscArraycpy(to->before, from->before, from->num_before));
  PetscCall(PetscArraycpy(to->leaf_order, from->leaf_order, from->num_leaves));
  to->t    = from->t;
  to->form = from->form;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateKeepOrigin(Problem p, State *s)
{
  const PetscReal *x;

  PetscFunctionBegin;
  if (!s->num_before) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemLocalDisplacement(p, s->x, s->before));
  PetscCall(VecGetArrayRead(s->x, &x));
  PetscCall(PetscArraycpy(s->before + p->num_local, x + p->num_u, p->num_z));
  PetscCall(VecRestoreArrayRead(s->x, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateFlowError(Problem p, State *from, State *to, PetscReal *energy)
{
  const size_t num = (size_t)p->num_local;
  PetscReal   *u0, *u1;

  PetscFunctionBegin;
  *energy = 0;
  if (!MechanicsIsPlastic(&p->scene->mechanics)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(num, &u0, num, &u1));
  PetscCall(ProblemSetState(p, from));
  PetscCall(ProblemSetTime(p, from->t));
  PetscCall(ProblemJump(p));
  PetscCall(ProblemLocalDisplacement(p, from->x, u0));
  PetscCall(ProblemSetState(p, to));
  PetscCall(ProblemSetTime(p, to->t));
  PetscCall(ProblemJump(p));
  PetscCall(ProblemLocalDisplacement(p, to->x, u1));
  PetscCall(MechanicsFlowError(p->mechanics, u0, u1, energy));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPI_SUM, p->comm));
  PetscCall(PetscFree2(u0, u1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateCommit(Problem p, State *s)
{
  PetscReal *local;
  PetscBool  bad;

  PetscFunctionBegin;
  PetscCall(ProblemSetState(p, s));
  PetscCall(VecGetArray(p->u_local, &local));
  PetscCall(ProblemLocalDisplacement(p, s->x, local));
  PetscCall(MechanicsCommit(p->mechanics, local, s->history, &bad));
  PetscCall(VecRestoreArray(p->u_local, &local));
  PetscCheck(!bad, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "a state outside the domain cannot be accepted");
  PetscCall(StateKeepOrigin(p, s));
  PetscCall(ProblemSetState(p, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateAdmit(Problem p, State *s)
{
  PetscReal *local;

  PetscFunctionBegin;
  PetscCall(ProblemSetState(p, s));
  PetscCall(VecGetArray(p->u_local, &local));
  PetscCall(ProblemLocalDisplacement(p, s->x, local));
  PetscCall(MechanicsAdmit(p->mechanics, local, s->history));
  PetscCall(VecRestoreArray(p->u_local, &local));
  PetscCall(StateKeepOrigin(p, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateDestroy(State *s)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&s->x));
  PetscCall(FreeAll(4, (void *[]){&s->pressure, &s->history, &s->before, &s->leaf_order}));
  PetscFunctionReturn(PETSC_SUCCESS);
}
