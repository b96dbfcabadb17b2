/* O-05 for all orders, in the plane, where meshes fine enough for order 8 are cheap: u = 0.1 (sin(pi X) Y, X^2 Y) on the unit square, plane strain, law "log"
   with mu = 1, lambda = 2, u prescribed all round, body force -Div P. The H1 error falls like h^p, the L2 error like h^(p+1) for p = 1..8, with hanging nodes
   too (0.15 less is allowed), and on one mesh exponentially in p: each order divides it by 4 at least, and its logarithm is nearly a straight line. The
   estimate is 0.3 to 5 times the error in energy, on the finer mesh within 20 % of what it is on the coarser one. */
#include "effectivityfixture.h"

#define MOST_NODES (9 * 9)
#define MOST_POINTS (11 * 11)

static void Exact(const PetscReal X[3], PetscReal u[2], PetscReal H[4])
{
  const PetscReal s = 0.1 * PetscSinReal(PETSC_PI * X[0]), c = 0.1 * PETSC_PI * PetscCosReal(PETSC_PI * X[0]);

  u[0] = s * X[1];
  u[1] = 0.1 * X[0] * X[0] * X[1];
  H[0] = c * X[1];
  H[1] = s;
  H[2] = 0.2 * X[0] * X[1];
  H[3] = 0.1 * X[0] * X[0];
}

/* F = [a b; d e], J = a e - b d. Cofactors are free of divergence: Div P = mu lap u + cof grad s, s = (lambda ln J - mu)/J, grad s = (3 - 2 ln J)/J^2 grad J.
 */
#define A_ "(1+.1*pi*cos(pi*X)*Y)"
#define B_ "(.1*sin(pi*X))"
#define D_ "(.2*X*Y)"
#define E_ "(1+.1*X^2)"
#define DET "(" A_ "*" E_ "-" B_ "*" D_ ")"
#define DET_X "(" E_ "*(-.1*pi^2*sin(pi*X)*Y)+" A_ "*.2*X-" D_ "*.1*pi*cos(pi*X)-" B_ "*.2*Y)"
#define DET_Y "(" E_ "*.1*pi*cos(pi*X)-" B_ "*.2*X)"
#define SLOPE "(3-2*ln(" DET "))/" DET "^2"
static const char *const field[2] = {".1*sin(pi*X)*Y", ".1*X^2*Y"};
static const char *const force[2] = {
    ".1*pi^2*sin(pi*X)*Y-" SLOPE "*(" E_ "*" DET_X "-" D_ "*" DET_Y ")",
    "-.2*Y-" SLOPE "*(" A_ "*" DET_Y "-" B_ "*" DET_X ")",
};

typedef struct {
  PetscReal h1, l2, effectivity; /* of the estimate, against the error in the energy of the exact tangent */
} Errors;

static Errors Integrate(const Solved *s)
{
  const HPTables  *v = s->tables;
  static PetscReal xi[2 * MOST_POINTS], weight[MOST_POINTS], F[9 * MOST_POINTS], P[9 * MOST_POINTS];
  PetscReal        X[2 * MOST_NODES], u[2 * MOST_NODES], N[MOST_NODES], D[2 * MOST_NODES];
  PetscReal        energy = 0;
  Errors           e      = {0};

  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt p = v->cell_order[c], n = ElementNumNodes(2, p), np = CellGauss(2, p + 3, xi, weight);
    OK(HPSpaceGatherPositions(s->space, c, X));
    OK(HPSpaceGather(s->space, c, s->u, u));
    OK(MechanicsPoints(s->mechanics, c, np, xi, s->u, &(PointValues){.F = F, .P = P}));
    for (PetscInt q = 0; q < np; ++q) {
      const PetscReal *G     = F + 9 * q;
      PetscReal        at[3] = {0}, uh[2] = {0}, J[4] = {0}, exact[2], H[4];
      OK(ElementEvaluate(2, p, xi + 2 * q, N, D));
      for (PetscInt i = 0; i < n; ++i) {
        for (PetscInt k = 0; k < 2; ++k) {
          at[k] += N[i] * X[2 * i + k];
          uh[k] += N[i] * u[2 * i + k];
          for (PetscInt r = 0; r < 2; ++r) J[2 * k + r] += D[2 * i + r] * X[2 * i + k];
        }
      }
      Exact(at, exact, H);
      const PetscReal area = weight[q] * (J[0] * J[3] - J[1] * J[2]);
      e.h1 += area * (PetscSqr(G[0] - 1 - H[0]) + PetscSqr(G[1] - H[1]) + PetscSqr(G[3] - H[2]) + PetscSqr(G[4] - 1 - H[3]));
      energy += area * EnergyDensity(&s->bulk.material, (const PetscReal[]){1 + H[0], H[1], 0, H[2], 1 + H[3], 0, 0, 0, 1},
                                     (const PetscReal[]){G[0] - 1 - H[0], G[1] - H[1], 0, G[3] - H[2], G[4] - 1 - H[3], 0, 0, 0, 0});
      e.l2 += area * (PetscSqr(uh[0] - exact[0]) + PetscSqr(uh[1] - exact[1]));
    }
  }
  e.h1 = PetscSqrtReal(e.h1);
  e.l2 = PetscSqrtReal(e.l2);

  e.effectivity = Estimated(s) / PetscSqrtReal(energy);
  return e;
}

/* n^2 cells, each with axes of its own; hanging: those of the quadrant at the origin split once more. */
static Errors Solve(PetscInt n, PetscInt order, PetscBool hanging)
{
  const ForestTables *t;
  Solved              s = {0};
  Errors              e;
  Box                 box;
  PetscReal           H[4];

  box_width     = 1. / n;
  s.bulk.forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){n, n, 1}, 1, 0, 1, &box);
  box_width     = 1;
  if (hanging) {
    for (PetscInt cell = 0, leaf = 0; cell < n * n; ++cell, ++leaf) {
      if (cell % n >= n / 2 || cell / n >= n / 2) continue;
      SplitLeaf(&s.bulk.forest, leaf, 3);
      leaf += 3;
    }
    t = ForestGetTables(s.bulk.forest);
    assert_int_equal(t->num_leaves, n * n + 3 * (n / 2) * (n / 2));
  }
  BulkInit(&s.bulk, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE);
  BulkMaterial(&s.bulk.material, "neo_hookean", VOLUMETRIC_LOG, FORMULATION_DISPLACEMENT, 1, 8. / 3);
  for (PetscInt c = 0; c < 2; ++c) {
    for (PetscInt b = 0; b < 4; ++b) s.bulk.boundaries[b].displacement[c] = BulkExpression("%s", field[c]);
    s.bulk.body.force[c] = BulkExpression("%s", force[c]);
  }
  SolvedCreate(&s, order, order);
  for (PetscInt i = 0; i < s.tables->num_nodes; ++i) Exact(s.tables->X + 3 * i, s.u + 2 * i, H); /* start: close enough for one step */
  OK(ProblemSetDisplacement(s.problem, s.u, s.state.x));
  OK(ProblemSetTime(s.problem, 1));
  OK(ProblemJump(s.problem));
  SolvedSolve(&s);
  e = Integrate(&s);
  print_message("p %d n %2d%s: H1 %.3e L2 %.3e, effectivity %.2f\n", (int)order, (int)n, hanging ? " hanging" : "", (double)e.h1, (double)e.l2,
                (double)e.effectivity);
  SolvedDestroy(&s);
  return e;
}

/* The last two meshes of each order, before round-off. */
static void Rates(void **state)
{
  const PetscInt fine[8] = {16, 16, 16, 16, 8, 8, 8, 4};

  for (PetscInt hanging = 0; hanging <= 1; ++hanging) {
    for (PetscInt p = 1; p <= 8; ++p) {
      const PetscInt  n = fine[p - 1];
      const Errors    e = Solve(n / 2, p, (PetscBool)hanging), f = Solve(n, p, (PetscBool)hanging);
      const PetscReal h1 = PetscLog2Real(e.h1 / f.h1), l2 = PetscLog2Real(e.l2 / f.l2);
      print_message("p %d%s: rates %.2f and %.2f\n", (int)p, hanging ? " hanging" : "", (double)h1, (double)l2);
      if (!(h1 > p - 0.15 && l2 > p + 1 - 0.15)) fail_msg("order %d: H1 rate %g, L2 rate %g", (int)p, (double)h1, (double)l2);
      assert_true(e.effectivity > 0.3 && e.effectivity < 5 && f.effectivity > 0.3 && f.effectivity < 5);
      assert_true(PetscAbsReal(f.effectivity / e.effectivity - 1) < 0.2);
    }
  }
}

static void Exponential(void **state)
{
  PetscReal error[8];

  for (PetscInt p = 1; p <= 8; ++p) error[p - 1] = Solve(4, p, PETSC_FALSE).h1;
  CheckExponential(8, error);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Rates), cmocka_unit_test(Exponential)};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || StageRegister()) return 1;
  OK(PetscOptionsSetValue(NULL, "-solve_rtol", "1e-13"));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
