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
#else
#define CompatSectionCreateGlobal(s, sf, g) PetscSectionCreateGlobalSection(s, sf, PETSC_FALSE, PETSC_FALSE, g)
#endif
