/* Values of PETSc's options that it would look at when a solver is first set up, which is after the results of an earlier run are gone: refused before. */
#include "solveimpl.h"
#include <strings.h>

#define CANNOT "an option of PETSc cannot act: "

static PetscBool Ends_Private(const char *name, const char *end)
{
  const size_t n = strlen(name), m = strlen(end);

  return (PetscBool)(n >= m && !strcasecmp(name + n - m, end) && (n == m || name[n - m - 1] == '_'));
}

/* Types that are in a list of PETSc's, by the end of the option's name, whatever the prefix. */
static PetscErrorCode CheckType_Private(const char *name, const char *value)
{
  const struct {
    const char       *end, *object;
    PetscFunctionList list;
  } types[] = {{"ksp_type", "KSP", KSPList}, {"pc_type", "PC", PCList}};

  PetscFunctionBegin;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(types); ++i) {
    void (*create)(void) = NULL;
    if (!Ends_Private(name, types[i].end)) continue;
    PetscCall(PetscFunctionListFind(types[i].list, value, &create));
    PetscCheckInput(create, CANNOT "-%s: this PETSc has no %s type %s", name, types[i].object, value);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Packages that factorise: one that can do so with a matrix over these processes, or over one where a prefix says that the matrix is another. */
static PetscErrorCode CheckPackage_Private(const char *name, const char *package)
{
  static const char *const ours   = "pc_factor_mat_solver_type";
  const char *const        type[] = {MATMPIAIJ, MATSEQAIJ};
  PetscMPIInt              size;
  PetscBool                found = PETSC_FALSE;

  PetscFunctionBegin;
  if (!Ends_Private(name, ours)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  for (int t = size == 1; t < (size == 1 || strcasecmp(name, ours) ? 2 : 1); ++t) {
    for (int factor = MAT_FACTOR_NONE + 1; factor < MAT_FACTOR_NUM_TYPES; ++factor) {
      PetscErrorCode (*create)(Mat, MatFactorType, Mat *) = NULL;
      PetscCall(MatSolverTypeGet(package, type[t], (MatFactorType)factor, NULL, NULL, &create));
      found = (PetscBool)(found || create);
    }
  }
  PetscCheckInput(found, CANNOT "-%s: this PETSc has no solver type %s for matrices on %d process%s", name, package, (int)size, size == 1 ? "" : "es");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc itself tells of what is no number. */
static PetscErrorCode CheckNumber_Private(const char *name, const char *value)
{
  PetscInt  integer;
  PetscReal real;

  PetscFunctionBegin;
  if (strstr(name, "mat_mumps_icntl_")) PetscCall(PetscOptionsStringToInt(value, &integer));
  if (strstr(name, "mat_mumps_cntl_")) PetscCall(PetscOptionsStringToReal(value, &real));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverCheckTypes_Private(void)
{
  PetscInt       num;
  char         **names, **values;
  PetscErrorCode status = PETSC_SUCCESS;

  PetscFunctionBegin;
  PetscCall(KSPInitializePackage());
  PetscCall(PCInitializePackage());
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values));
  for (PetscInt i = 0; i < num && !status; ++i) {
    const char *value = values[i] ? values[i] : "";
    status            = CheckType_Private(names[i], value);
    if (!status) status = CheckPackage_Private(names[i], value);
    if (!status) status = CheckNumber_Private(names[i], value);
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  PetscCall(status);
  PetscFunctionReturn(PETSC_SUCCESS);
}
