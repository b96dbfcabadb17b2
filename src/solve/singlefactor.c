/* A factor in single precision as a preconditioner: half the memory and about half the time of one in double, and GMRES in double needs two or three iterations
   with it where the matrix is regular. PETSc has no such factor in a build of double precision, so MUMPS is called directly (LDL^T or LU).

   Rows and columns are scaled by d_i = (max_j |a_ij|)^-1/2, so that no unit overflows: the factor is that of D A D. */
#include "solveimpl.h"

#if defined(MORTISE_SMUMPS)
#include <smumps_c.h>

enum { BEGIN = -1, END = -2, ANALYSE = 1, FACTORISE = 2, SOLVE = 3 }; /* jobs of MUMPS */

typedef struct {
  SMUMPS_STRUC_C   mumps;
  PetscBool        symmetric;
  PetscObjectId    id; /* of the matrix analysed, and its pattern's state */
  PetscObjectState pattern;
  Vec              scale, work, all; /* all: on rank 0 */
  VecScatter       gather;
  MUMPS_INT       *row, *column; /* owned [num], from 1 */
  float           *value, *side; /* owned [num]; right-hand side, on rank 0 */
} SingleFactor;

static void Call_Private(SingleFactor *f, int job)
{
  f->mumps.job = job;
  smumps_c(&f->mumps);
}

/* -mat_mumps_icntl_* and cntl_* mean here what they mean to PETSc, except for those that say how data are handed over. */
static PetscErrorCode Options_Private(PC pc, SMUMPS_STRUC_C *mumps)
{
  const char *prefix;
  char        name[32];

  PetscFunctionBegin;
  PetscCall(PCGetOptionsPrefix(pc, &prefix));
  for (int i = 1; i <= 40; ++i) {
    PetscInt  value;
    PetscBool set;
    if (i == 5 || i == 18 || i == 20 || i == 21) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "-mat_mumps_icntl_%d", i));
    PetscCall(PetscOptionsGetInt(NULL, prefix, name, &value, &set));
    if (set) mumps->icntl[i - 1] = (MUMPS_INT)value;
  }
  for (int i = 1; i <= 7; ++i) {
    PetscReal value;
    PetscBool set;
    PetscCall(PetscSNPrintf(name, sizeof(name), "-mat_mumps_cntl_%d", i));
    PetscCall(PetscOptionsGetReal(NULL, prefix, name, &value, &set));
    if (set) mumps->cntl[i - 1] = (float)value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything that belongs to one pattern. */
static PetscErrorCode Clear_Private(SingleFactor *f)
{
  PetscFunctionBegin;
  if (f->scale) Call_Private(f, END);
  PetscCall(VecDestroy(&f->scale));
  PetscCall(VecDestroy(&f->work));
  PetscCall(VecDestroy(&f->all));
  PetscCall(VecScatterDestroy(&f->gather));
  PetscCall(PetscFree3(f->row, f->column, f->value));
  PetscCall(PetscFree(f->side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many owned entries are handed over: of the symmetric form those on and right of the diagonal. */
static PetscErrorCode Count_Private(const SingleFactor *f, Mat A, PetscInt64 *num)
{
  const PetscInt *j;
  PetscInt        first, last, n;

  PetscFunctionBegin;
  *num = 0;
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i) {
    PetscCall(MatGetRow(A, i, &n, &j, NULL));
    for (PetscInt k = 0; k < n; ++k) *num += !f->symmetric || j[k] >= i;
    PetscCall(MatRestoreRow(A, i, &n, &j, NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those entries of D A D, d on all ranks. */
static PetscErrorCode Entries_Private(SingleFactor *f, Mat A, const PetscScalar d[])
{
  const PetscScalar *a;
  const PetscInt    *j;
  PetscInt           first, last, n;
  PetscInt64         e = 0;

  PetscFunctionBegin;
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  for (PetscInt i = first; i < last; ++i) {
    PetscCall(MatGetRow(A, i, &n, &j, &a));
    for (PetscInt k = 0; k < n; ++k) {
      if (f->symmetric && j[k] < i) continue;
      f->row[e]     = (MUMPS_INT)(i + 1);
      f->column[e]  = (MUMPS_INT)(j[k] + 1);
      f->value[e++] = (float)(d[i] * a[k] * d[j[k]]);
    }
    PetscCall(MatRestoreRow(A, i, &n, &j, &a));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The scale, and with it the entries. */
static PetscErrorCode Values_Private(SingleFactor *f, Mat A)
{
  const PetscScalar *every;
  PetscScalar       *d;
  PetscInt           n;
  VecScatter         spread;
  Vec                everywhere;

  PetscFunctionBegin;
  PetscCall(MatGetRowMaxAbs(A, f->scale, NULL));
  PetscCall(VecGetLocalSize(f->scale, &n));
  PetscCall(VecGetArray(f->scale, &d));
  for (PetscInt i = 0; i < n; ++i) d[i] = d[i] > 0 ? 1 / PetscSqrtReal(d[i]) : 1;
  PetscCall(VecRestoreArray(f->scale, &d));
  PetscCall(VecScatterCreateToAll(f->scale, &spread, &everywhere));
  PetscCall(VecScatterBegin(spread, f->scale, everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(spread, f->scale, everywhere, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArrayRead(everywhere, &every));
  PetscCall(Entries_Private(f, A, every));
  PetscCall(VecRestoreArrayRead(everywhere, &every));
  PetscCall(VecScatterDestroy(&spread));
  PetscCall(VecDestroy(&everywhere));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Storage, options and analysis for A's pattern. */
static PetscErrorCode Begin_Private(PC pc, SingleFactor *f, Mat A)
{
  SMUMPS_STRUC_C *m = &f->mumps;
  PetscInt        size, local;
  PetscInt64      num;

  PetscFunctionBegin;
  PetscCall(Clear_Private(f));
  PetscCall(MatCreateVecs(A, &f->scale, NULL));
  PetscCall(VecDuplicate(f->scale, &f->work));
  PetscCall(VecScatterCreateToZero(f->scale, &f->gather, &f->all));
  PetscCall(VecGetLocalSize(f->all, &local));
  PetscCall(PetscMalloc1(local, &f->side));
  PetscCall(Count_Private(f, A, &num));
  PetscCall(PetscMalloc3(num, &f->row, num, &f->column, num, &f->value));
  PetscCall(PetscMemzero(m, sizeof(*m)));
  m->par          = 1;
  m->sym          = f->symmetric ? 2 : 0;
  m->comm_fortran = MPI_Comm_c2f(PetscObjectComm((PetscObject)A));
  Call_Private(f, BEGIN);
  for (int i = 0; i < 4; ++i) m->icntl[i] = i < 3 ? -1 : 0; /* no messages */
  m->icntl[17] = 3;                                         /* entries from every rank, right-hand side and solution on rank 0 */
  PetscCall(Options_Private(pc, m));
  PetscCall(MatGetSize(A, &size, NULL));
  m->n       = (MUMPS_INT)size;
  m->nnz_loc = num;
  m->irn_loc = f->row;
  m->jcn_loc = f->column;
  m->a_loc   = f->value;
  m->rhs     = f->side;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The entries of A, and where its pattern is not the one at hand, the analysis. */
static PetscErrorCode Analyse_Private(PC pc, SingleFactor *f, Mat A, PetscBool *ok)
{
  PetscObjectId    id;
  PetscObjectState pattern;

  PetscFunctionBegin;
  PetscCall(PetscObjectGetId((PetscObject)A, &id));
  PetscCall(MatGetNonzeroState(A, &pattern));
  const PetscBool analyse = (PetscBool)(!f->scale || id != f->id || pattern != f->pattern);
  if (analyse) PetscCall(Begin_Private(pc, f, A));
  PetscCall(Values_Private(f, A));
  if (analyse) Call_Private(f, ANALYSE);
  *ok        = (PetscBool)(f->mumps.infog[0] >= 0 || !analyse);
  f->id      = *ok ? id : 0; /* a failed analysis is no analysis */
  f->pattern = pattern;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp_Private(PC pc)
{
  SingleFactor *f;
  Mat           A;
  PetscBool     ok;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &f));
  PetscCall(PCGetOperators(pc, NULL, &A));
  PetscCall(Analyse_Private(pc, f, A, &ok));
  if (ok) Call_Private(f, FACTORISE);
  while ((f->mumps.infog[0] == -8 || f->mumps.infog[0] == -9) && f->mumps.icntl[13] < SOLVER_MOST_RESERVE) { /* out of workspace */
    f->mumps.icntl[13] = 4 * PetscMax(f->mumps.icntl[13], 20);
    Call_Private(f, FACTORISE);
  }
  PetscCall(PetscInfo(pc, "single factor: status %d, ordering %d, %.3g operations, %d negative and %d delayed pivots\n", (int)f->mumps.infog[0],
                      (int)f->mumps.infog[6], (double)f->mumps.rinfog[2], (int)f->mumps.infog[11], (int)f->mumps.infog[12]));
  PetscCall(PCSetFailedReason(pc, f->mumps.infog[0] < 0 ? PC_FACTOR_OTHER : PC_NOERROR));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Apply_Private(PC pc, Vec x, Vec y)
{
  SingleFactor *f;
  PetscScalar  *all;
  PetscInt      n;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &f));
  PetscCall(VecPointwiseMult(f->work, x, f->scale));
  PetscCall(VecScatterBegin(f->gather, f->work, f->all, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(f->gather, f->work, f->all, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetLocalSize(f->all, &n));
  PetscCall(VecGetArray(f->all, &all));
  for (PetscInt i = 0; i < n; ++i) f->side[i] = (float)all[i];
  Call_Private(f, SOLVE);
  for (PetscInt i = 0; i < n; ++i) all[i] = f->side[i];
  PetscCall(VecRestoreArray(f->all, &all));
  if (f->mumps.infog[0] < 0) { /* GMRES sees it and says that it did not converge */
    PetscCall(PetscInfo(pc, "single factor: solve failed with status %d\n", (int)f->mumps.infog[0]));
    PetscCall(PCSetFailedReason(pc, PC_SUBPC_ERROR));
    PetscCall(CompatVecSetInf(y));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecScatterBegin(f->gather, f->all, y, INSERT_VALUES, SCATTER_REVERSE));
  PetscCall(VecScatterEnd(f->gather, f->all, y, INSERT_VALUES, SCATTER_REVERSE));
  PetscCall(VecPointwiseMult(y, y, f->scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Private(PC pc)
{
  SingleFactor *f;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &f));
  PetscCall(Clear_Private(f));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SingleFactorSet_Private(PC pc, PetscBool symmetric)
{
  SingleFactor *f;

  PetscFunctionBegin;
  PetscCall(PetscNew(&f));
  f->symmetric = symmetric;
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetName(pc, "factor in single precision (MUMPS)"));
  PetscCall(PCShellSetContext(pc, f));
  PetscCall(PCShellSetSetUp(pc, SetUp_Private));
  PetscCall(PCShellSetApply(pc, Apply_Private));
  PetscCall(PCShellSetDestroy(pc, Destroy_Private));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SingleFactorNegative_Private(PC pc, PetscInt *negative)
{
  SingleFactor *f;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &f));
  *negative = (PetscInt)f->mumps.infog[11];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SingleFactorOperations_Private(PC pc, Mat A, PetscReal *operations)
{
  SingleFactor *f;
  PetscBool     ok;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &f));
  PetscCall(Analyse_Private(pc, f, A, &ok));
  *operations = ok ? (PetscReal)f->mumps.rinfog[0] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SingleFactorForget_Private(PC pc)
{
  SingleFactor *f;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &f));
  PetscCall(Clear_Private(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SingleFactorExists_Private(void)
{
  return PETSC_TRUE;
}

#else

PetscErrorCode SingleFactorSet_Private(PC pc, PetscBool symmetric)
{
  PetscFunctionBegin;
  SETERRQ(PetscObjectComm((PetscObject)pc), PETSC_ERR_SUP, "built without MUMPS in single precision");
}

PetscErrorCode SingleFactorNegative_Private(PC pc, PetscInt *negative)
{
  PetscFunctionBegin;
  SETERRQ(PetscObjectComm((PetscObject)pc), PETSC_ERR_SUP, "built without MUMPS in single precision");
}

PetscErrorCode SingleFactorOperations_Private(PC pc, Mat A, PetscReal *operations)
{
  PetscFunctionBegin;
  SETERRQ(PetscObjectComm((PetscObject)pc), PETSC_ERR_SUP, "built without MUMPS in single precision");
}

PetscErrorCode SingleFactorForget_Private(PC pc)
{
  PetscFunctionBegin;
  SETERRQ(PetscObjectComm((PetscObject)pc), PETSC_ERR_SUP, "built without MUMPS in single precision");
}

PetscBool SingleFactorExists_Private(void)
{
  return PETSC_FALSE;
}
#endif
