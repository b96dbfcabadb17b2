/* A fresh directory for a whole test program, known to all ranks: group set-up and tear-down of cmocka. Include after cmocka.h. */
#pragma once
#include <petscsys.h>
#include <stdlib.h>
#include <string.h>

static char directory[PETSC_MAX_PATH_LEN];

static inline int DirectoryCreate(void **unused)
{
  PetscMPIInt rank;

  strcpy(directory, "/tmp/mortise-test-XXXXXX");
  if (MPI_Comm_rank(PETSC_COMM_WORLD, &rank) || (rank == 0 && !mkdtemp(directory))) return 1;
  return MPI_Bcast(directory, sizeof(directory), MPI_CHAR, 0, PETSC_COMM_WORLD);
}

static inline int DirectoryRemove(void **unused)
{
  PetscMPIInt rank;

  MPI_Barrier(PETSC_COMM_WORLD);
  if (MPI_Comm_rank(PETSC_COMM_WORLD, &rank)) return 1;
  return rank == 0 ? PetscRMTree(directory) != 0 : 0;
}
