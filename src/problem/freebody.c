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
