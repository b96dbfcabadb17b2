/* A state out of balance in its forces and its gaps: with all of the imbalance left it is a solution to the last digit, with none the problem is what it was;
   taken away little by little it leads to the solution, from places where Newton's method alone finds none. */
#include "patchfixture.h"
#include "path.h"

enum { CUT = 1, HOMOTOPY };

static void Create(Patch *p)
{
  const PetscInt n[2] = {3, 4};

  PatchScene(p, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_AUTO);
  p->forest = PatchForest(n);
  PatchStart(p);
  PatchSolve(p->problem, &p->state);
}

/* Displacements off by up to `size`, pressures by a third, every fifth of them gone. */
static void Disturb(Patch *p, PetscReal size, Vec x)
{
  PetscReal *values;
  PetscInt   num_u, num_z, dim, first;

  OK(VecCopy(p->state.x, x));
  OK(ProblemGetBlocks(p->problem, &num_u, &num_z, &dim));
  OK(VecGetOwnershipRange(x, &first, NULL));
  OK(VecGetArray(x, &values));
  for (PetscInt i = 0; i < num_u; ++i) values[i] += size * PetscSinReal((PetscReal)(first + i) + 1);
  for (PetscInt i = num_u; i < num_u + num_z; ++i) values[i] *= i % 5 ? 1 + PetscSinReal((PetscReal)i) / 3 : 0;
  OK(VecRestoreArray(x, &values));
}

static void ShareCounts(void **state)
{
  Patch         p;
  ProblemStatus status;
  PetscBool     usable;
  PetscReal     norm, off;
  Vec           x, r, all;

  Create(&p);
  OK(ProblemCreateVector(p.problem, &x));
  OK(VecDuplicate(x, &r));
  OK(VecDuplicate(x, &all));
  Disturb(&p, 0.02, x);
  PatchEvaluate(p.problem, x, all, &status);
  OK(VecNorm(all, NORM_2, &norm));
  assert_true(norm > 0.01);
  OK(ProblemNoteImbalance(p.problem, x, &usable));
  assert_true(usable);
  OK(ProblemLeaveImbalance(p.problem, 1));
  PatchEvaluate(p.problem, x, r, &status);
  OK(VecNorm(r, NORM_2, &off));
  assert_true(off < 1e-14 * norm + 1e-15);
  OK(ProblemLeaveImbalance(p.problem, 0.3));
  OK(ProblemLeaveImbalance(p.problem, 0));
  PatchEvaluate(p.problem, x, r, &status);
  OK(VecAXPY(r, -1, all));
  OK(VecNorm(r, NORM_2, &off));
  assert_true(off < 1e-14 * norm + 1e-15);
  OK(VecDestroy(&x));
  OK(VecDestroy(&r));
  OK(VecDestroy(&all));
  PatchDestroy(&p);
}

/* From a disturbance to the solution, piece by piece. */
static void Follow(PetscReal size)
{
  Patch        p;
  State        off;
  SolverReport report;
  PetscReal    error, norm;

  Create(&p);
  Level    level = {.forest = p.forest, .problem = p.problem, .accepted = p.state};
  Path     path  = {.level = &level, .data = &p.data};
  PathLoop load  = {.metric = &PathTime, .stop = 1};
  OK(SolverCreate(p.problem, &level.solver));
  OK(StateCreate(p.problem, &level.state));
  OK(StateCreate(p.problem, &off));
  OK(StateCopy(&p.state, &off));
  Disturb(&p, size, off.x);
  for (PetscInt row = 0; row < PATH_RECOVERIES; ++row) path.recovery[row].mode = row == HOMOTOPY ? RECOVERY_ON : RECOVERY_OFF;
  assert_string_equal(PathRecoveries[HOMOTOPY].name, "homotopy");
  assert_string_equal(PathRecoveries[CUT].name, "cut"); /* the load again is the cheaper way */
  report.converged = PETSC_FALSE;
  OK(PathRecover(&path, &load, 1, &off, &report));
  if (!report.converged) fail_msg("no solution: %s", report.reason);
  assert_int_equal(path.recovery[HOMOTOPY].tried, 1);
  assert_int_equal(path.recovery[HOMOTOPY].succeeded, 1);
  OK(VecNorm(p.state.x, NORM_2, &norm));
  OK(VecAXPY(level.state.x, -1, p.state.x));
  OK(VecNorm(level.state.x, NORM_2, &error));
  assert_true(error < 1e-8 * norm);
  OK(StateDestroy(&off));
  OK(StateDestroy(&level.state));
  OK(SolverDestroy(&level.solver));
  PatchDestroy(&p);
}

static void Arrives(void **state)
{
  Follow(0.02);
}

static void ArrivesWhereNewtonStalls(void **state)
{
  PetscMPIInt size;

  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (size > 1) skip(); /* the disturbance goes by the numbers of unknowns */
  Follow(0.04);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(ShareCounts), cmocka_unit_test(Arrives), cmocka_unit_test(ArrivesWhereNewtonStalls)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
