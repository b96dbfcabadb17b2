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
  PetscCall(PetscMalloc1(s->num_history, &s->fine));
  PetscCall(PetscArraycpy(s->fine, s->history, s->num_history));
  s->num_from = MechanicsIsPlastic(&p->scene->mechanics) ? p->num_local : 0;
  PetscCall(PetscCalloc1(s->num_from, &s->from));
  PetscCall(PetscMalloc1(s->num_from, &s->way));
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
  PetscCall(PetscArraycpy(to->fine, from->fine, from->num_history));
  PetscCall(PetscArraycpy(to->from, from->from, from->num_from));
  to->has_way = from->has_way;
  if (from->has_way) PetscCall(PetscArraycpy(to->way, from->way, from->num_from));
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

PetscErrorCode StateNoteWay(Problem p, Vec x, Vec dx, State *s)
{
  PetscReal *local;
  PetscBool  same;

  PetscFunctionBegin;
  if (!s->num_from || s->has_way) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(s->num_from, &local));
  PetscCall(ProblemLocalDisplacement(p, x, local));
  PetscCall(PetscArraycmp(local, s->from, s->num_from, &same));
  PetscCall(PetscFree(local));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPIU_BOOL, MPI_LAND, p->comm));
  if (!same) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  PetscCall(PetscArraycpy(s->way, p->increment, s->num_from));
  s->has_way = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateFlowError(Problem p, const State *s, PetscReal *energy)
{
  PetscFunctionBegin;
  *energy = 0;
  if (!s->num_from) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetState(p, s));
  PetscCall(MechanicsFlowError(p->mechanics, s->from, s->fine, energy));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateKeepFrom(Problem p, State *s)
{
  PetscFunctionBegin;
  s->has_way = PETSC_FALSE;
  if (s->num_from) PetscCall(ProblemLocalDisplacement(p, s->x, s->from));
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
  if (s->num_from) PetscCall(MechanicsFollowFlow(p->mechanics, s->from, s->has_way ? s->way : NULL, local, s->fine));
  PetscCall(StateKeepFrom(p, s));
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
  PetscCall(MechanicsSetHistory(p->mechanics, s->fine));
  PetscCall(MechanicsAdmit(p->mechanics, local, s->fine));
  PetscCall(StateKeepFrom(p, s));
  PetscCall(ProblemSetState(p, s));
  PetscCall(VecRestoreArray(p->u_local, &local));
  PetscCall(StateKeepOrigin(p, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateDestroy(State *s)
{
  PetscFunctionBegin;
  PetscCall(VecDestroy(&s->x));
  PetscCall(FreeAll(7, (void *[]){&s->pressure, &s->history, &s->fine, &s->from, &s->way, &s->before, &s->leaf_order}));
  PetscFunctionReturn(PETSC_SUCCESS);
}
