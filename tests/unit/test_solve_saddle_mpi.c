/* The iterative solution of the tangent (saddle.c) where rows of multipliers are compliant (B and C in one row, as where facets are covered in part) among firm
   ones and inactive ones: the direct solution, for compliances over nine decades, of the symmetric and of the exact form. */
#include "patchfixture.h"
#include "share.h"
#include "solveimpl.h"

static PetscReal Solve(Saddle saddle, Mat A, PetscBool symmetric, Vec rhs, Vec x)
{
  PetscBool ok;
  PetscReal norm, residual;
  Vec       r;

  OK(VecDuplicate(rhs, &r));
  OK(SaddleSetUp_Private(saddle, A, symmetric));
  OK(SaddleSolve_Private(saddle, rhs, 1e-12, PETSC_FALSE, x, &ok));
  assert_true(ok);
  OK(MatMult(A, x, r));
  OK(VecAXPY(r, -1, rhs));
  OK(VecNorm(r, NORM_2, &residual));
  OK(VecNorm(rhs, NORM_2, &norm));
  OK(VecDestroy(&r));
  return residual / norm;
}

static void Direct(Mat A, Vec rhs, Vec x)
{
  KSP ksp;
  PC  pc;

  OK(KSPCreate(PETSC_COMM_WORLD, &ksp));
  OK(KSPSetOperators(ksp, A, A));
  OK(KSPSetType(ksp, KSPPREONLY));
  OK(KSPGetPC(ksp, &pc));
  OK(PCSetType(pc, PCLU));
  OK(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  OK(PetscOptionsSetValue(NULL, "-mat_mumps_icntl_14", "200")); /* the room that it takes varies beside busy processes */
  OK(KSPSolve(ksp, rhs, x));
  OK(KSPDestroy(&ksp));
}

/* Every other active row of multipliers gets -compliance (exact form: +, the sign of its row), relative to b D^-1 b^T of that row, on its diagonal. Returns the
 * number of rows changed on all ranks.
 */
static PetscInt Soften(Patch *p, PetscBool symmetric, PetscReal compliance, Mat A)
{
  PetscInt num_u, num_z, dim, first, last, changed = 0;
  Vec      diagonal;

  ProblemGetBlocks(p->problem, &num_u, &num_z, &dim);
  OK(MatGetOwnershipRange(A, &first, &last));
  OK(MatCreateVecs(A, &diagonal, NULL));
  OK(MatGetDiagonal(A, diagonal));
  for (PetscInt row = first + num_u; row < first + num_u + num_z; row += 2) {
    const PetscInt    *column;
    const PetscScalar *value;
    PetscInt           num;
    PetscReal          flexible = 0, own;
    OK(VecGetValues(diagonal, 1, &row, &own));
    OK(MatGetRow(A, row, &num, &column, &value));
    for (PetscInt k = 0; k < num; ++k) {
      PetscReal stiff = 1;
      if (column[k] < first || column[k] >= first + num_u) continue; /* those of this rank will do */
      OK(VecGetValues(diagonal, 1, &column[k], &stiff));
      flexible += PetscSqr(value[k]) / stiff;
    }
    OK(MatRestoreRow(A, row, &num, &column, &value));
    if (own != 0 || flexible == 0) continue;
    flexible *= symmetric ? -compliance : compliance;
    OK(VecSetValues(diagonal, 1, &row, &flexible, INSERT_VALUES));
    ++changed;
  }
  OK(VecAssemblyBegin(diagonal));
  OK(VecAssemblyEnd(diagonal));
  OK(MatDiagonalSet(A, diagonal, INSERT_VALUES));
  OK(VecDestroy(&diagonal));
  OK(MPI_Allreduce(MPI_IN_PLACE, &changed, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  return changed;
}

static void CompliantRows(PetscBool symmetric, MultigridKind kind)
{
  static const PetscReal compliance[] = {0, 1e-6, 1e-3, 1, 1e3};
  const PetscInt         n[2]         = {12, 16};
  Patch                  p;
  Saddle                 saddle;
  Mat                    A, soft;
  Vec                    rhs, x, exact;
  PetscBool              bad;
  PetscReal              norm, error, firm = 0;
  const Form             form = {.symmetric = symmetric, .proximal = 1};

  PatchScene(&p, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_AUTO);
  p.forest = PatchForest(n);
  PatchStart(&p);
  PatchSolve(p.problem, &p.state);
  OK(ProblemSetForm(p.problem, &form));
  OK(ProblemTangent(p.problem, p.state.x, p.state.pressure, NULL, &bad));
  assert_false(bad);
  OK(ProblemGetMatrix(p.problem, &A));
  OK(MatCreateVecs(A, &rhs, &x));
  OK(VecDuplicate(x, &exact));
  OK(VecSetRandom(rhs, NULL));
  OK(SaddleCreate_Private(p.problem, kind, &saddle));
  for (size_t i = 0; i < sizeof(compliance) / sizeof(compliance[0]); ++i) {
    if (i > 0 && !Share((PetscInt)i, 2)) continue;
    OK(MatDuplicate(A, MAT_COPY_VALUES, &soft));
    if (compliance[i] > 0) assert_in_range(Soften(&p, symmetric, compliance[i], soft), 4, 100);
    Direct(soft, rhs, exact);
    const PetscReal residual = Solve(saddle, soft, symmetric, rhs, x);
    OK(VecNorm(exact, NORM_2, &norm));
    if (i == 0) firm = norm;
    if (i > 0) assert_true(PetscAbsReal(norm / firm - 1) > 1e-9); /* another problem */
    OK(VecAXPY(x, -1, exact));
    OK(VecNorm(x, NORM_2, &error));
    print_message("compliance %g: residual %.1e, error %.1e\n", (double)compliance[i], (double)residual, (double)(error / norm));
    assert_true(residual < 1e-9 && error < 1e-8 * norm);
    OK(MatDestroy(&soft));
  }
  OK(SaddleDestroy_Private(&saddle));
  OK(VecDestroy(&rhs));
  OK(VecDestroy(&x));
  OK(VecDestroy(&exact));
  PatchDestroy(&p);
}

static void SymmetricForm(void **state)
{
  CompliantRows(PETSC_TRUE, MULTIGRID_AUTO);
}

static void ExactForm(void **state)
{
  CompliantRows(PETSC_FALSE, MULTIGRID_AUTO);
}

static void Hypre(void **state)
{
#if defined(PETSC_HAVE_HYPRE)
  CompliantRows(PETSC_TRUE, MULTIGRID_BOOMERAMG);
  CompliantRows(PETSC_FALSE, MULTIGRID_BOOMERAMG);
#else
  skip();
#endif
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(SymmetricForm), cmocka_unit_test(ExactForm), cmocka_unit_test(Hypre)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 2;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
