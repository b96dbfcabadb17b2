/* Steps that take the load off. The tangent expects points on the yield surface to flow on, which is a good start of most steps; where loads turn it is none:
   as soft as flow, the material follows the load far back, and Newton's method does not find out. What such a linear step does tell is where it leads: off the
   yield surface at most points. It is then found again with the elastic tangent. */
#include "problemimpl.h"

PetscErrorCode ProblemUnloads(Problem p, Vec x, Vec dx, PetscBool *yes)
{
  /* of the linear step: far enough to tell the sides of the yield surface apart, too little to reach the other end of it */
  const PetscReal part = PetscPowReal(PETSC_MACHINE_EPSILON, 1. / 3);
  PetscReal      *u;
  PetscInt        num[2];

  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  if (!MechanicsIsPlastic(&p->scene->mechanics)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(p->num_local, &u));
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  for (PetscInt side = 0; side < 2; ++side) { /* points that would flow on, and points that would if the step went the other way */
    PetscCall(ProblemLocalDisplacement(p, x, u));
    for (PetscInt i = 0; i < p->num_local; ++i) u[i] += (side ? -part : part) * p->increment[i];
    PetscCall(MechanicsNumFlowing(p->mechanics, u, &num[side]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, num, 2, MPIU_INT, MPI_SUM, p->comm));
  *yes = (PetscBool)(num[1] > num[0]);
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
