/* A factor in single precision as preconditioner of GMRES in double: a saddle matrix of a cube of two stiffnesses with constraints across them, in any units,
   with new values and a new pattern, unsymmetric; what is singular fails and says so. */
#include "solveimpl.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define N 9                 /* points along an edge of the cube */
#define POINTS (N * N * N)  /* the rows of constraints follow them */
#define MULTIPLIERS (N * N) /* each makes two neighbours across the middle plane equal */

static void OK(PetscErrorCode ierr)
{
  assert_int_equal(ierr, 0);
}

/* Springs along the edges of the lattice, 1 below and stiff above; held: two opposite corners to the ground. skew: unsymmetric by that share. */
typedef struct {
  PetscReal unit, stiff, skew;
  PetscBool held;
  PetscInt  multipliers; /* active ones */
} Case;

static void Spring(const Case *c, Mat A, PetscInt i, PetscInt step)
{
  const PetscReal k    = c->unit * (i / (N * N) < N / 2 ? 1 : c->stiff);
  const PetscInt  j[2] = {i, i + step};

  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) OK(MatSetValue(A, j[a], j[b], (a == b ? 1 : -1 + (a ? c->skew : -c->skew)) * k, ADD_VALUES));
  }
}

static void Constraint(const Case *c, Mat A, PetscInt m)
{
  const PetscInt i = N * N * (N / 2 - 1) + m, row = POINTS + m;

  for (int side = 0; side < 2 && m < c->multipliers; ++side) {
    OK(MatSetValue(A, row, i + side * N * N, side ? 1 : -1, ADD_VALUES));
    OK(MatSetValue(A, i + side * N * N, row, side ? 1 : -1, ADD_VALUES));
  }
  OK(MatSetValue(A, row, row, m < c->multipliers ? 0 : -1, ADD_VALUES));
}

static Mat Matrix(const Case *c)
{
  PetscMPIInt rank;
  Mat         A;

  OK(MatCreateAIJ(PETSC_COMM_WORLD, PETSC_DECIDE, PETSC_DECIDE, POINTS + MULTIPLIERS, POINTS + MULTIPLIERS, 10, NULL, 10, NULL, &A));
  OK(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (PetscInt i = 0; i < POINTS && rank == 0; ++i) {
    if (i % N < N - 1) Spring(c, A, i, 1);
    if (i / N % N < N - 1) Spring(c, A, i, N);
    if (i / (N * N) < N - 1) Spring(c, A, i, N * N);
  }
  for (PetscInt m = 0; m < MULTIPLIERS && rank == 0; ++m) Constraint(c, A, m);
  if (rank == 0 && c->held) {
    OK(MatSetValue(A, 0, 0, c->unit, ADD_VALUES));
    OK(MatSetValue(A, POINTS - 1, POINTS - 1, c->unit, ADD_VALUES));
  }
  OK(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  OK(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

static KSP Make(PetscBool symmetric)
{
  KSP ksp;
  PC  pc;

  OK(KSPCreate(PETSC_COMM_WORLD, &ksp));
  OK(KSPSetType(ksp, KSPFGMRES));
  OK(KSPSetTolerances(ksp, 1e-12, 1e-300, PETSC_DEFAULT, 20));
  OK(KSPGetPC(ksp, &pc));
  OK(SingleFactorSet_Private(pc, symmetric));
  return ksp;
}

/* Solve for a right-hand side; true residual against it, or infinity without convergence. */
static PetscReal Solve(KSP ksp, const Case *c, PetscInt *iterations)
{
  KSPConvergedReason reason;
  PetscReal          norm, residual;
  PetscInt           first, last;
  Mat                A = Matrix(c);
  Vec                x, b;

  OK(MatCreateVecs(A, &x, &b));
  OK(VecGetOwnershipRange(b, &first, &last));
  for (PetscInt i = first; i < last; ++i) OK(VecSetValue(b, i, i < POINTS ? c->unit * ((i * 7) % 11 - 3) : 0, INSERT_VALUES));
  OK(VecAssemblyBegin(b));
  OK(VecAssemblyEnd(b));
  OK(KSPSetOperators(ksp, A, A));
  OK(KSPSolve(ksp, b, x));
  OK(KSPGetConvergedReason(ksp, &reason));
  OK(KSPGetIterationNumber(ksp, iterations));
  OK(VecNorm(b, NORM_2, &norm));
  OK(VecScale(b, -1));
  OK(MatMultAdd(A, x, b, b));
  OK(VecNorm(b, NORM_2, &residual));
  OK(VecDestroy(&x));
  OK(VecDestroy(&b));
  OK(MatDestroy(&A));
  return reason > 0 ? residual / norm : PETSC_INFINITY;
}

static void Refines(void **state)
{
  const Case cases[] = {
      {.unit = 1, .stiff = 10, .held = PETSC_TRUE, .multipliers = MULTIPLIERS},
      {.unit = 1e45, .stiff = 10, .held = PETSC_TRUE, .multipliers = MULTIPLIERS}, /* more than a float holds */
      {.unit = 1e-45, .stiff = 1e4, .held = PETSC_TRUE},                           /* less */
      {.unit = 1, .stiff = 10, .held = PETSC_TRUE, .multipliers = 0},
      {.unit = 1, .stiff = 1e4, .held = PETSC_TRUE, .multipliers = MULTIPLIERS / 2},
  };
  PetscInt iterations;
  KSP      ksp;

  if (!SingleFactorExists_Private()) skip();
  ksp = Make(PETSC_TRUE); /* one solver for all: new values, new patterns */
  for (size_t i = 0; i < sizeof(cases) / sizeof(*cases); ++i) {
    const PetscReal residual = Solve(ksp, &cases[i], &iterations);
    print_message("unit %g stiff %g: %d iterations, residual %.1e\n", (double)cases[i].unit, (double)cases[i].stiff, (int)iterations, (double)residual);
    assert_true(residual < 1e-12 * PetscSqr(cases[i].stiff)); /* round-off of A x grows with the displacement of what is hardly held */
    assert_in_range(iterations, 2, 10);                       /* one iteration would be a factor in double */
  }
  OK(KSPDestroy(&ksp));
}

static void Unsymmetric(void **state)
{
  const Case c = {.unit = 1, .stiff = 10, .skew = 0.3, .held = PETSC_TRUE, .multipliers = MULTIPLIERS};
  PetscInt   iterations;
  KSP        ksp;

  if (!SingleFactorExists_Private()) skip();
  ksp = Make(PETSC_FALSE);
  assert_true(Solve(ksp, &c, &iterations) < 1e-11);
  assert_in_range(iterations, 2, 10);
  OK(KSPDestroy(&ksp));
}

/* Nothing holds the cube, and the right-hand side pushes it away: there is no solution, whatever GMRES says. */
static void SingularShows(void **state)
{
  const Case free = {.unit = 1, .stiff = 10, .multipliers = MULTIPLIERS}, held = {.unit = 1, .stiff = 10, .held = PETSC_TRUE, .multipliers = MULTIPLIERS};
  PetscInt   iterations;
  KSP        ksp;

  if (!SingleFactorExists_Private()) skip();
  ksp = Make(PETSC_TRUE);
  assert_true(Solve(ksp, &free, &iterations) > 1e-3);
  assert_true(Solve(ksp, &held, &iterations) < 1e-11); /* and the next matrix is served again */
  OK(KSPDestroy(&ksp));
}

/* A factor that MUMPS was told to throw away: the factorisation is well, no solve is. */
static void FailedSolveShows(void **state)
{
  const Case c = {.unit = 1, .stiff = 10, .held = PETSC_TRUE, .multipliers = MULTIPLIERS};
  PetscInt   iterations;
  KSP        ksp;

  if (!SingleFactorExists_Private()) skip();
  OK(PetscOptionsSetValue(NULL, "-mat_mumps_icntl_31", "1"));
  ksp = Make(PETSC_TRUE);
  assert_true(Solve(ksp, &c, &iterations) == PETSC_INFINITY);
  assert_in_range(iterations, 0, 1);
  OK(KSPDestroy(&ksp));
  OK(PetscOptionsClearValue(NULL, "-mat_mumps_icntl_31"));
  ksp = Make(PETSC_TRUE);
  assert_true(Solve(ksp, &c, &iterations) < 1e-11);
  OK(KSPDestroy(&ksp));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Refines), cmocka_unit_test(Unsymmetric), cmocka_unit_test(SingularShows),
                                     cmocka_unit_test(FailedSolveShows)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
