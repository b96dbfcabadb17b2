/* Viscous forces against the deformation since a state of the problem (mechanics/viscous.c). */
#include "problemimpl.h"

PetscErrorCode ProblemSetViscosity(Problem p, PetscReal rate, Vec from)
{
  PetscReal *u;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  if (rate > 0) PetscCall(ProblemLocalDisplacement(p, from, u));
  PetscCall(MechanicsSetViscosity(p->mechanics, rate, u));
  p->viscous = (PetscBool)(rate > 0);
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMayFreezeSegmentation(Problem p, PetscBool any, PetscBool *yes)
{
  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  if (!p->viscous) PetscCall(InterfaceMayFreezeSegmentation(p->interface, any, yes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemViscousWork(Problem p, Vec x, PetscReal *work)
{
  PetscReal *u;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(MechanicsViscousWork(p->mechanics, u, work));
  PetscCall(VecRestoreArray(p->u_local, &u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, work, 1, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
