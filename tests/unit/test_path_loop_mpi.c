/* The loop that all continuation goes through: pieces are halved where they fail, grow where they are found at once, are given up when they are too short or
   too many; what failed leaves no trace; recoveries are tried when they are due, and counted. The problem stays the same, what refuses is the metric. */
#include "patchfixture.h"
#include "path.h"

#define MOST 64

typedef struct {
  Patch patch;
  Level level;
  Path  path;
} Run;

static PetscInt  num_asked, refusals; /* how often the metric refuses yet, -1: for ever */
static PetscReal asked[MOST], longest;

static PetscReal End(const Path *p, const PathLoop *loop)
{
  return PetscMin(loop->s + loop->piece, loop->stop);
}

static PetscErrorCode Set(Path *p, const PathLoop *loop, PetscReal to)
{
  assert_true(num_asked < MOST);
  asked[num_asked++] = to;
  return PETSC_SUCCESS;
}

/* A refusal leaves a state of no use. */
static PetscErrorCode Found(Path *p, const PathLoop *loop, PetscReal to, SolverReport *report)
{
  if (to - loop->s <= longest && refusals == 0) return PETSC_SUCCESS;
  if (refusals > 0) --refusals;
  report->converged = PETSC_FALSE;
  report->reason    = "refused";
  return VecScale(p->level->state.x, 2);
}

static const PathMetric Plain = {"plain", 0.5, 2, PETSC_FALSE, End, Set, Found}, Load = {"load", 0.5, 2, PETSC_TRUE, End, Set, Found};

static void Create(Run *r)
{
  const PetscInt n[2] = {3, 4};

  PatchScene(&r->patch, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_AUTO);
  r->patch.forest = PatchForest(n);
  PatchStart(&r->patch);
  PatchSolve(r->patch.problem, &r->patch.state);
  r->level = (Level){.forest = r->patch.forest, .problem = r->patch.problem, .accepted = r->patch.state};
  r->path  = (Path){.level = &r->level, .data = &r->patch.data};
  OK(SolverCreate(r->level.problem, &r->level.solver));
  OK(StateCreate(r->level.problem, &r->level.state));
  OK(StateCopy(&r->level.accepted, &r->level.state));
  num_asked = refusals = 0;
  longest              = 0.3;
}

static void Destroy(Run *r)
{
  OK(StateDestroy(&r->level.state));
  OK(SolverDestroy(&r->level.solver));
  PatchDestroy(&r->patch);
}

static void Unchanged(const Run *r)
{
  PetscBool same;

  OK(VecEqual(r->level.state.x, r->level.accepted.x, &same));
  assert_true(same);
}

static void Pieces(void **state)
{
  const PetscReal to[] = {0.5, 0.25, 0.5, 1, 0.75, 1};
  PathLoop        loop = {.metric = &Plain, .stop = 1, .piece = 0.5, .least = 0.01, .most = 1};
  SolverReport    report;
  Run             r;

  Create(&r);
  OK(PathFollow(&r.path, &loop, &report));
  assert_true(report.converged);
  assert_int_equal(num_asked, PETSC_STATIC_ARRAY_LENGTH(to));
  for (PetscInt i = 0; i < num_asked; ++i) assert_near(asked[i], to[i], 1e-15);
  assert_int_equal(r.path.step_cuts, 0);
  Unchanged(&r);
  Destroy(&r);
}

static void GivesUp(void **state)
{
  const PetscReal least[]    = {0.2, 0.001};
  const PetscInt  attempts[] = {0, 3}, num[] = {2, 3};

  for (PetscInt i = 0; i < 2; ++i) {
    PathLoop     loop = {.metric = &Plain, .stop = 1, .piece = 0.5, .least = least[i], .most = 1, .attempts = attempts[i]};
    SolverReport report;
    Run          r;
    Create(&r);
    refusals = -1;
    OK(PathFollow(&r.path, &loop, &report));
    assert_false(report.converged);
    assert_string_equal(report.reason, "refused");
    assert_int_equal(num_asked, num[i]);
    Unchanged(&r);
    Destroy(&r);
  }
}

/* Without descent, the first failure of a step is answered by a shorter one; an equilibrium farther off is looked for at the second, the fourth, … */
static void Recovers(void **state)
{
  const PetscInt viscous = PATH_UNFOLDED - 1, descent = viscous - 1;

  for (PetscInt off = 0; off < 2; ++off) {
    PathLoop     loop = {.metric = &Load, .stop = 1, .piece = 1, .least = 0.1, .most = 1, .step = PETSC_TRUE};
    SolverReport report;
    Run          r;
    Create(&r);
    assert_string_equal(PathRecoveries[viscous].name, "viscous");
    assert_string_equal(PathRecoveries[descent].name, "descent");
    r.path.recovery[descent].mode = RECOVERY_OFF;
    r.path.recovery[viscous].mode = off ? RECOVERY_OFF : RECOVERY_AUTO;
    longest                       = PETSC_MAX_REAL;
    refusals                      = off ? -1 : 2;
    PathBegin(&r.path, PETSC_FALSE);
    OK(PathFollow(&r.path, &loop, &report));
    assert_int_equal(report.converged, !off);
    assert_int_equal(r.path.recovery[viscous].tried, !off);
    assert_int_equal(r.path.recovery[viscous].succeeded, !off);
    assert_int_equal(r.path.step_cuts, off ? 4 : 1);
    assert_int_equal(r.path.recovery[PATH_UNFOLDED].tried, 0); /* not of this mesh */
    for (PetscInt row = 0; row < viscous; ++row) assert_int_equal(r.path.recovery[row].tried, 0);
    Unchanged(&r);
    Destroy(&r);
  }
}

/* The first two that are found are none. */
static PetscErrorCode RefuseTwo(Problem problem, const PetscReal from[], const State *state, PetscReal scale, const char **reason)
{
  *reason = num_asked < 3 ? "looked at and refused" : NULL;
  return PETSC_SUCCESS;
}

/* What is refused counts as not found, and is counted; a path that does not look takes it. */
static void Refuses(void **state)
{
  for (PetscInt off = 0; off < 2; ++off) {
    PathLoop     loop = {.metric = &Plain, .stop = 1, .piece = 1, .least = 0.01, .most = 1};
    SolverReport report;
    Run          r;
    Create(&r);
    longest                           = PETSC_MAX_REAL;
    r.path.refusal[PATH_THROUGH].ask  = RefuseTwo;
    r.path.refusal[PATH_THROUGH].mode = off ? RECOVERY_OFF : RECOVERY_AUTO;
    OK(PathFollow(&r.path, &loop, &report));
    assert_true(report.converged);
    assert_int_equal(r.path.refusal[PATH_THROUGH].num, off ? 0 : 2);
    assert_near(asked[2 - 2 * off], off ? 1 : 0.25, 1e-15);
    Unchanged(&r);
    Destroy(&r);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Pieces), cmocka_unit_test(GivesUp), cmocka_unit_test(Recovers), cmocka_unit_test(Refuses)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
