/* Descent: from a state from which Newton's method finds nothing every iterate lowers the energy, no cell is inverted on the way, and it ends at the solution.
 */
#include "patchfixture.h"
#include "solveimpl.h"

#define SIZE 0.05 /* of the disturbance: all but inverts a cell */

/* The solution of the patch, and a state off it, by the reference positions, so that ranks agree. */
static void Create(Patch *p, PetscReal size, State *off)
{
  const PetscInt  n[2] = {3, 4};
  const HPTables *t;
  PetscReal      *local;

  PatchScene(p, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
  p->forest = PatchForest(n);
  PatchStart(p);
  PatchSolve(p->problem, &p->state);
  OK(StateCreate(p->problem, off));
  OK(StateCopy(&p->state, off));
  t = HPSpaceGetTables(ProblemSpace(p->problem));
  OK(PetscMalloc1(t->num_nodes * t->dim, &local));
  OK(ProblemLocalDisplacement(p->problem, off->x, local));
  for (PetscInt i = 0; i < t->num_nodes * t->dim; ++i) {
    const PetscReal *X = t->X + 3 * (i / t->dim);
    local[i] += size * PetscSinReal(17 * X[0] + 23 * X[1] + 5 * (PetscReal)(i % t->dim));
  }
  OK(ProblemSetDisplacement(p->problem, local, off->x));
  OK(PetscFree(local));
}

static void EachIterateIsLower(void **state)
{
  Patch        p;
  State        off;
  Solver       solver;
  SolverReport report = {.reason = ""};
  Descent      d;
  PetscReal    slope, last = PETSC_MAX_REAL;
  PetscBool    ok, done = PETSC_FALSE, moved = PETSC_TRUE, bent = PETSC_FALSE;
  PetscInt     i;

  Create(&p, SIZE, &off);
  OK(SolverCreate(p.problem, &solver));
  OK(ProblemSetState(p.problem, &off));
  OK(DescentCreate_Private(solver, &report, &d));
  OK(VecCopy(p.state.x, d.lambda));
  for (i = 0; i < 60; ++i) {
    if (moved) {
      OK(DescentLinearise_Private(&d, off.x, &done, &ok));
      assert_true(ok && d.status.min_det > 0 && d.merit < last);
      last = d.merit;
    }
    if (done) break;
    OK(DescentDirection_Private(&d, &slope, &ok));
    assert_true(ok && slope < 0);
    bent = (PetscBool)(bent || d.shift > 0);
    OK(DescentSearch_Private(&d, off.x, slope, &moved));
  }
  print_message("down in %d directions, negative curvature %s\n", (int)i, bent ? "met" : "not met");
  assert_true(done && bent);
  OK(DescentDestroy_Private(&d));
  OK(StateDestroy(&off));
  OK(SolverDestroy(&solver));
  PatchDestroy(&p);
}

static void EndsAtTheSolution(void **state)
{
  Patch        p;
  State        off;
  Solver       solver;
  SolverReport report;
  PetscReal    error, norm;

  Create(&p, SIZE, &off);
  OK(SolverCreate(p.problem, &solver));
  OK(SolverSolve(solver, &off, &report));
  assert_false(report.converged);
  OK(StateDestroy(&off));
  OK(SolverDestroy(&solver));
  PatchDestroy(&p);
  Create(&p, SIZE, &off);
  OK(SolverCreate(p.problem, &solver));
  OK(SolverDescend(solver, &off, &report));
  print_message("%d descents, %d factorisations: %s\n", (int)report.descents, (int)report.factorisations, report.converged ? "found" : report.reason);
  assert_true(report.converged && report.unstable == 0);
  OK(VecNorm(p.state.x, NORM_2, &norm));
  OK(VecAXPY(off.x, -1, p.state.x));
  OK(VecNorm(off.x, NORM_2, &error));
  assert_true(error < 1e-8 * norm);
  OK(StateDestroy(&off));
  OK(SolverDestroy(&solver));
  PatchDestroy(&p);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(EachIterateIsLower), cmocka_unit_test(EndsAtTheSolution)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
