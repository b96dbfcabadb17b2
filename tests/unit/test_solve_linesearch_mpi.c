/* Steps that go too far: the place inside a step where forces along it balance, and the work that tells. */
#include "patchfixture.h"
#include "solveimpl.h"

/* An answer that stiffens: below 0 up to s = 0.2, twenty times as steep from there on. */
static PetscReal Work(PetscReal s)
{
  return s < 0.2 ? s - 0.2 : 20 * (s - 0.2);
}

static void FindsBalance(void **state)
{
  PetscReal at[2] = {0, 1}, g[2] = {Work(0), Work(1)}, s = 1;

  for (PetscInt trial = 0; trial < 6 && fabs(Work(s)) > 0.1; ++trial) {
    s               = SolverInside_Private(at, g);
    at[Work(s) > 0] = s;
    g[Work(s) > 0]  = Work(s);
  }
  assert_true(fabs(Work(s)) <= 0.1);
}

static void StaysInside(void **state)
{
  const PetscReal at[2] = {0.25, 0.5}, high[2] = {-1e-9, 1}, low[2] = {-1, 1e-9}, even[2] = {-1, 1};

  assert_float_equal(SolverInside_Private(at, high), 0.275, 1e-15);
  assert_float_equal(SolverInside_Private(at, low), 0.475, 1e-15);
  assert_float_equal(SolverInside_Private(at, even), 0.375, 1e-15);
}

/* Multipliers do no work: of all ones, it is the number of displacements that are free. */
static void CountsDisplacements(void **state)
{
  const PetscInt n[2] = {3, 4};
  PetscInt       num_u, num_z, dim;
  PetscReal      work, all;
  Patch          patch;
  Vec            r, dx;

  PatchScene(&patch, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_AUTO);
  patch.forest = PatchForest(n);
  PatchStart(&patch);
  OK(ProblemCreateVector(patch.problem, &r));
  OK(VecDuplicate(r, &dx));
  OK(VecSet(r, 2));
  OK(VecSet(dx, -1));
  ProblemGetBlocks(patch.problem, &num_u, &num_z, &dim);
  OK(ProblemWork(patch.problem, r, dx, &work));
  all = -2 * (PetscReal)num_u;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD);
  assert_float_equal(work, all, 1e-12);
  OK(VecDestroy(&r));
  OK(VecDestroy(&dx));
  PatchDestroy(&patch);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(FindsBalance), cmocka_unit_test(StaysInside), cmocka_unit_test(CountsDisplacements)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
