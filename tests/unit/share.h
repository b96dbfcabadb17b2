/* Wide sweeps of tests that run on 1, 2 and 3 ranks: all cases on one rank, and everywhere with -slow; on more one in `stride`, others on 2 than on 3. A stride
   that has no common divisor with what the cases alternate by leaves every kind on every number of ranks. */
#pragma once
#include <petscsys.h>

static PetscBool share_all = PETSC_FALSE; /* -slow */

static inline PetscBool Whole(void)
{
  PetscMPIInt size = 1;

  return (PetscBool)(share_all || MPI_Comm_size(PETSC_COMM_WORLD, &size) || size == 1);
}

static inline PetscBool Share(PetscInt k, PetscInt stride)
{
  PetscMPIInt size = 1;

  return (PetscBool)(Whole() || MPI_Comm_size(PETSC_COMM_WORLD, &size) || k % stride == size % stride);
}
