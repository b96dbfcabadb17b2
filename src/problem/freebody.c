/* Bodies that supports do not hold. */
#include "problemimpl.h"

PetscErrorCode ProblemFreeAxes(Problem p, PetscInt body, PetscInt *axes, PetscBool *turns)
{
  const PetscReal *hold;

  PetscFunctionBegin;
  PetscCall(MechanicsGetHold(p->mechanics, &hold));
  hold += 9 * body;
  *axes = 0;
  for (PetscInt c = 0; c < p->dim; ++c)
    if (hold[4 * c] <= MECHANICS_FREE * (hold[0] + hold[4] + hold[8])) *axes |= 1 << c;
  *turns = (PetscBool)(!*axes && !MechanicsIsHeld(p->mechanics, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemHasFreeBody(Problem p, PetscBool *yes)
{
  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  for (PetscInt b = 0; b < p->scene->mechanics.num_bodies; ++b) *yes = (PetscBool)(*yes || !MechanicsIsHeld(p->mechanics, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFindSlide(Problem p, Vec dx, Vec force, PetscReal *excess)
{
  PetscReal pending;

  PetscFunctionBegin;
  *excess = 0;
  PetscCall(ProblemPending(p, &pending));
  if (pending > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  PetscCall(InterfaceFindSlide(p->interface, p->increment, force, excess));
  PetscFunctionReturn(PETSC_SUCCESS);
}
