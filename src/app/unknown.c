/* Options that neither this program nor PETSc knows: refused before anything is meshed or solved. Of PETSc's own only the first word is known here: most are
   asked for when the object they belong to is first used. */
#include "appimpl.h"
#include <ctype.h>

/* First words of PETSc's options, a space before and after each: of the system, of objects, and of ours with a prefix (solve/). */
static const char Petsc[] = " options log malloc info memory mpi on fp debug debugger stop start error history display draw x nox skip version help "
                            "check viewer view viewerfrom no get objects citations saws tmp shared prefix use blas device root cuda hip sycl "
                            "viewfromoptions process snes ksp pc mat vec is dm sf sub mg section petscsection petscpartitioner petscspace petscfe "
                            "petscdualspace petscsf matload vecscatter random superlu saddle multigrid again dll python ";

static PetscBool IsPetsc_Private(const char *name)
{
  char word[64];

  if (snprintf(word, sizeof(word), " %.*s ", (int)strcspn(name, "_"), name) >= (int)sizeof(word)) return PETSC_FALSE;
  for (char *c = word; *c; ++c) *c = (char)tolower(*c);
  return strstr(Petsc, word) ? PETSC_TRUE : PETSC_FALSE;
}

/* Of keys of the scene, options of the solver and of the run. */
static PetscErrorCode Nearest_Private(Scene scene, const char *name, size_t capacity, char nearest[])
{
  const char *candidate[] = {NULL, SolverNearestOption(name), "restart", "max_seconds", "solution_view", "check", "help", "list", "options_file"};
  char        key[256];

  PetscFunctionBegin;
  PetscCall(SceneNearestOption(scene, name, sizeof(key), key));
  candidate[0] = key;
  PetscCall(PetscStrncpy(nearest, NameNearest(name, PETSC_STATIC_ARRAY_LENGTH(candidate), candidate), capacity));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppCheckOptions(Scene scene)
{
  PetscInt num;
  char   **names, **values, unknown[256] = "", nearest[256];

  PetscFunctionBegin;
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values));
  for (PetscInt i = num - 1; i >= 0; --i) {
    if (!IsPetsc_Private(names[i])) PetscCall(PetscStrncpy(unknown, names[i], sizeof(unknown)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  if (!unknown[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Nearest_Private(scene, unknown, sizeof(nearest), nearest));
  PetscCall(ErrorInput("-%.80s is no key of a scene and no option of mortise or PETSc; the nearest one is -%s", unknown, nearest));
  PetscFunctionReturn(PETSC_SUCCESS);
}
