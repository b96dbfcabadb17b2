/* Bodies that supports do not hold. */
#include "problemimpl.h"

PetscErrorCode ProblemFreeAxes(Problem p, PetscInt body, PetscInt *axes, PetscBool *turns)
{
  const PetscReal *hold;

  PetscFunctionBegin;
  PetscCall(MechanicsGetHold(p->mechanics, &hold, NULL));
  *axes  = MechanicsFreeAxes(p->dim, hold + 9 * body);
  *turns = (PetscBool)(!*axes && !MechanicsIsHeld(p->mechanics, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ProblemHasFreeBody(Problem p)
{
  for (PetscInt b = 0; b < p->scene->mechanics.num_bodies; ++b)
    if (!MechanicsIsHeld(p->mechanics, b)) return PETSC_TRUE;
  return PETSC_FALSE;
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
