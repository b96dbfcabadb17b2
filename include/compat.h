/* Differences between PETSc 3.18 (Debian 12) and current releases, all of them, in this one place. */
#pragma once
#include <petscdmplex.h>
#include <petscsnes.h>
#include <stdint.h>

#ifndef PETSC_SUCCESS
#define PETSC_SUCCESS ((PetscErrorCode)0)
#endif

#if PETSC_VERSION_GE(3, 22, 0)
#define CompatSectionCreateGlobal(s, sf, g) PetscSectionCreateGlobalSection(s, sf, PETSC_TRUE, PETSC_FALSE, PETSC_FALSE, g)
#define CompatVecSetInf(x) VecFlag(x, 1)
#else
#define CompatSectionCreateGlobal(s, sf, g) PetscSectionCreateGlobalSection(s, sf, PETSC_FALSE, PETSC_FALSE, g)
#define CompatVecSetInf(x) VecSetInf(x)
#endif

/* The MPI type of a PetscBool: it was an enumeration, of the size of an int, and is a C bool since. */
#if PETSC_VERSION_GE(3, 24, 0)
#define COMPAT_MPI_BOOL MPI_C_BOOL
#else
#define COMPAT_MPI_BOOL MPIU_BOOL
#endif
