/* Drag against the deformation since a state of the problem (mechanics/drag.c). */
#include "problemimpl.h"

PetscErrorCode ProblemSetDrag(Problem p, PetscReal rate, Vec from)
{
  PetscReal *u;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  if (rate > 0) PetscCall(ProblemLocalDisplacement(p, from, u));
  PetscCall(MechanicsSetDrag(p->mechanics, rate, u));
  p->dragged = (PetscBool)(rate > 0);
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemDragWork(Problem p, Vec x, PetscReal *work)
{
  PetscReal *u;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(MechanicsDragWork(p->mechanics, u, work));
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work, 1, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
