/* O-05: the manufactured finite-strain field u = 0.1 (sin(pi X) Y (1+Z), X^2 Y, sin(pi Z) X) on the unit cube, law "log" with mu = 1, lambda = 2, u prescribed
   all round, body force -Div P: H1 error falls like h^p, L2 error like h^(p+1), p = 1..4, with and without hanging nodes (rates over the last two meshes,
   0.15 less is allowed); at fixed mesh each order up to 8 divides the error by 4 at least, and its logarithm is nearly a straight line; energy and norm of the
   limit. The estimate is 0.3 to 5 times the error in energy, on the finer mesh within 20 % of what it is on the coarser one. */
#include "effectivityfixture.h"

#define ENERGY 0.138562678930
#define NORM 0.078881063775
#define MOST_NODES (9 * 9 * 9)
#define MOST_POINTS (11 * 11 * 11)

static void Exact(const PetscReal X[3], PetscReal u[3], PetscReal H[9])
{
  const PetscReal s = 0.1 * PetscSinReal(PETSC_PI * X[0]), c = 0.1 * PETSC_PI * PetscCosReal(PETSC_PI * X[0]);
  const PetscReal h[9] = {c * X[1] * (1 + X[2]),
                          s * (1 + X[2]),
                          s * X[1],
                          0.2 * X[0] * X[1],
                          0.1 * X[0] * X[0],
                          0,
                          0.1 * PetscSinReal(PETSC_PI * X[2]),
                          0,
                          0.1 * PETSC_PI * PetscCosReal(PETSC_PI * X[2]) * X[0]};

  u[0] = s * X[1] * (1 + X[2]);
  u[1] = 0.1 * X[0] * X[0] * X[1];
  u[2] = 0.1 * PetscSinReal(PETSC_PI * X[2]) * X[0];
  OK(PetscArraycpy(H, h, 9));
}

/* F = [a b c; d e 0; g 0 h], its cofactors and the derivatives of its entries, as texts. The cofactors are free of divergence, so that
   Div P = mu lap u + cof grad s,  s = (lambda ln J - mu)/J,  s' = (lambda + mu - lambda ln J)/J^2. */
#define A_ "(1+.1*pi*cos(pi*X)*Y*(1+Z))"
#define B_ "(.1*sin(pi*X)*(1+Z))"
#define C_ "(.1*sin(pi*X)*Y)"
#define D_ "(.2*X*Y)"
#define E_ "(1+.1*X^2)"
#define G_ "(.1*sin(pi*Z))"
#define H_ "(1+.1*pi*cos(pi*Z)*X)"
#define DET A_ "*" E_ "*" H_ "-" B_ "*" D_ "*" H_ "-" C_ "*" G_ "*" E_
static const char *const cofactor[3][3] = {
    {E_ "*" H_, "(-" D_ "*" H_ ")", "(-" E_ "*" G_ ")"},
    {"(-" B_ "*" H_ ")", "(" A_ "*" H_ "-" C_ "*" G_ ")", B_ "*" G_},
    {"(-" C_ "*" E_ ")", C_ "*" D_, "(" A_ "*" E_ "-" B_ "*" D_ ")"},
};
#define AX "(-.1*pi^2*sin(pi*X)*Y*(1+Z))"
#define AY ".1*pi*cos(pi*X)*(1+Z)"
#define AZ ".1*pi*cos(pi*X)*Y"
#define BZ ".1*sin(pi*X)"
#define GZ ".1*pi*cos(pi*Z)"
#define HZ "(-.1*pi^2*sin(pi*Z)*X)"
static const char *const derivative[3][3][3] = {
    {{AX, AY, AZ}, {".2*Y", ".2*X", NULL}, {NULL, NULL, GZ}},
    {{AY, NULL, BZ}, {".2*X", NULL, NULL}, {NULL, NULL, NULL}},
    {{AZ, BZ, NULL}, {NULL, NULL, NULL}, {GZ, NULL, HZ}},
}; /* [column of F][row][by X, Y, Z] */
static const char *const laplace[3] = {AX, ".2*Y", HZ};
static const char *const field[3]   = {".1*sin(pi*X)*Y*(1+Z)", ".1*X^2*Y", ".1*sin(pi*Z)*X"};

static Expression BodyForce(PetscInt i)
{
  char gradient[8000] = "";

  for (PetscInt k = 0; k < 3; ++k) { /* J,k = cof : F,k */
    TextAppend(sizeof(gradient), gradient, k ? "+" : "");
    TextAppend(sizeof(gradient), gradient, cofactor[i][k]);
    TextAppend(sizeof(gradient), gradient, "*(0");
    for (PetscInt row = 0; row < 3; ++row) {
      for (PetscInt column = 0; column < 3; ++column) {
        if (!derivative[column][row][k]) continue;
        TextAppend(sizeof(gradient), gradient, "+");
        TextAppend(sizeof(gradient), gradient, cofactor[row][column]);
        TextAppend(sizeof(gradient), gradient, "*");
        TextAppend(sizeof(gradient), gradient, derivative[column][row][k]);
      }
    }
    TextAppend(sizeof(gradient), gradient, ")");
  }
  return BulkExpression("-%s-(3-2*ln(" DET "))/(" DET ")^2*(%s)", laplace[i], gradient);
}

static void BodyForceIsRight(void **state)
{
  const PetscReal X[2][3] = {{.25, .5, .75}, {.6, .2, .4}};
  const PetscReal b[2][3] = {{2.295315699083, -1.176616836295, 0.362902997271}, {0.291853506223, 0.4155766747, 2.079812646413}};

  for (PetscInt i = 0; i < 3; ++i) {
    Expression force = BodyForce(i);
    PetscReal  value;
    for (PetscInt k = 0; k < 2; ++k) {
      OK(ExpressionEvaluate(force, X[k], 1, &value));
      assert_near(value, b[k][i], 1e-11);
    }
  }
  while (bulk_num_expressions) OK(ExpressionDestroy(&bulk_expressions[--bulk_num_expressions]));
}

typedef struct {
  PetscReal h1, l2, energy, norm; /* errors, strain energy, L2 norm of u_h */
  PetscReal effectivity;          /* of the estimate, against the error in the energy of the exact tangent */
  PetscInt  dofs;
} Figures;

static void Integrate(const Solved *s, Figures *f)
{
  const HPTables  *v = s->tables;
  static PetscReal xi[3 * MOST_POINTS], weight[MOST_POINTS], F[9 * MOST_POINTS], P[9 * MOST_POINTS], X[3 * MOST_NODES], u[3 * MOST_NODES], N[MOST_NODES],
      D[3 * MOST_NODES];
  PetscReal error = 0;

  *f      = (Figures){.energy = s->report.status.energy};
  f->dofs = ProblemNumDofs(s->problem);
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt p = v->cell_order[c], n = ElementNumNodes(3, p), np = CellGauss(3, p + 3, xi, weight);
    OK(HPSpaceGatherPositions(s->space, c, X));
    OK(HPSpaceGather(s->space, c, s->u, u));
    OK(MechanicsPoints(s->mechanics, c, np, xi, s->u, &(PointValues){.F = F, .P = P}));
    for (PetscInt q = 0; q < np; ++q) {
      PetscReal at[3] = {0}, uh[3] = {0}, J[9] = {0}, exact[3], H[9], E[9], h1 = 0, l2 = 0, norm = 0;
      OK(ElementEvaluate(3, p, xi + 3 * q, N, D));
      for (PetscInt i = 0; i < n; ++i) {
        for (PetscInt k = 0; k < 3; ++k) {
          at[k] += N[i] * X[3 * i + k];
          uh[k] += N[i] * u[3 * i + k];
          for (PetscInt r = 0; r < 3; ++r) J[3 * k + r] += D[3 * i + r] * X[3 * i + k];
        }
      }
      Exact(at, exact, H);
      for (PetscInt k = 0; k < 9; ++k) {
        H[k] += k % 4 == 0;
        E[k] = F[9 * q + k] - H[k];
        h1 += PetscSqr(E[k]);
      }
      for (PetscInt k = 0; k < 3; ++k) l2 += PetscSqr(uh[k] - exact[k]), norm += PetscSqr(uh[k]);
      const PetscReal volume = weight[q] * Det3(J);
      error += volume * EnergyDensity(&s->bulk.material, H, E);
      f->h1 += volume * h1;
      f->l2 += volume * l2;
      f->norm += volume * norm;
    }
  }
  f->effectivity = Estimated(s) / PetscSqrtReal(error);
  f->h1          = PetscSqrtReal(f->h1);
  f->l2          = PetscSqrtReal(f->l2);
  f->norm        = PetscSqrtReal(f->norm);
}

/* Start: the field at the nodes, which is close enough for one step. */
static void Interpolate(Solved *s)
{
  PetscReal H[9];

  for (PetscInt n = 0; n < s->tables->num_nodes; ++n) Exact(s->tables->X + 3 * n, s->u + 3 * n, H);
  OK(ProblemSetDisplacement(s->problem, s->u, s->state.x));
  OK(ProblemSetTime(s->problem, 1));
  OK(ProblemJump(s->problem));
}

static PetscBool interpolants = PETSC_FALSE; /* -interpolant: no solution, the field at the nodes */

/* n^3 cells; hanging: those of the octant at the origin split once more. */
static Figures Solve(PetscInt n, PetscInt order, PetscBool hanging)
{
  const ForestTables *t;
  Solved              s = {0};
  Figures             f;
  Box                 box;

  const PetscInt refine = n > 8 ? 1 : 0, m = n >> refine; /* a box has 512 cells at most */
  box_width     = 1. / m;
  s.bulk.forest = BoxForest(PETSC_COMM_WORLD, 3, (const PetscInt[3]){m, m, m}, 1, refine, 1, &box);
  box_width     = 1;
  if (hanging) {
    MarkList marks = {0};
    t              = ForestGetTables(s.bulk.forest);
    OK(PetscCalloc1(t->num_leaves, &marks.split));
    OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
    for (PetscInt l = 0; l < t->num_leaves; ++l) marks.split[l] = l % n < n / 2 && l / n % n < n / 2 && l / (n * n) < n / 2 ? 7 : 0;
    AdaptBy(&s.bulk.forest, &marks);
  }
  BulkInit(&s.bulk, 3, MODEL_3D, KINEMATICS_FINITE);
  BulkMaterial(&s.bulk.material, "neo_hookean", VOLUMETRIC_LOG, FORMULATION_DISPLACEMENT, 1, 8. / 3);
  for (PetscInt c = 0; c < 3; ++c) {
    for (PetscInt b = 0; b < 6; ++b) s.bulk.boundaries[b].displacement[c] = BulkExpression("%s", field[c]);
    s.bulk.body.force[c] = BodyForce(c);
  }
  SolvedCreate(&s, order, order);
  Interpolate(&s);
  if (!interpolants) SolvedSolve(&s);
  Integrate(&s, &f);
  print_message("p %d n %2d%s: %6d dofs, H1 %.3e L2 %.3e energy %.12f norm %.12f effectivity %.2f\n", (int)order, (int)n, hanging ? " hanging" : "",
                (int)f.dofs, (double)f.h1, (double)f.l2, (double)f.energy, (double)f.norm, (double)f.effectivity);
  SolvedDestroy(&s);
  return f;
}

static void CheckRate(PetscInt order, PetscInt coarse, const Figures *f, PetscInt fine, const Figures *g)
{
  const PetscReal ratio = PetscLogReal((PetscReal)fine / coarse), h1 = PetscLogReal(f->h1 / g->h1) / ratio, l2 = PetscLogReal(f->l2 / g->l2) / ratio;

  print_message("p %d: rates %.2f and %.2f\n", (int)order, (double)h1, (double)l2);
  if (!(h1 > order - 0.15 && l2 > order + 1 - 0.15)) fail_msg("order %d: H1 rate %g, L2 rate %g", (int)order, (double)h1, (double)l2);
  assert_true(f->effectivity > 0.3 && f->effectivity < 5 && g->effectivity > 0.3 && g->effectivity < 5);
  assert_true(PetscAbsReal(g->effectivity / f->effectivity - 1) < 0.2);
}

static PetscBool slow = PETSC_FALSE; /* finer meshes */

static void Rates(void **state)
{
  const PetscInt quick[4][2] = {{4, 8}, {2, 4}, {2, 4}, {2, 3}}, fine[4][2] = {{8, 16}, {4, 8}, {3, 5}, {3, 4}};
  const PetscInt common = slow ? 4 : 2;
  PetscReal      last   = 0;

  for (PetscInt order = 1; order <= 4; ++order) {
    const PetscInt *m = (slow ? fine : quick)[order - 1];
    const Figures   f = Solve(m[0], order, PETSC_FALSE), g = Solve(m[1], order, PETSC_FALSE);
    const Figures   same = m[0] == common ? f : m[1] == common ? g : Solve(common, order, PETSC_FALSE);
    CheckRate(order, m[0], &f, m[1], &g);
    if (order > 1 && !(same.h1 < last / 4)) fail_msg("order %d divides the error by %g only", (int)order, (double)(last / same.h1));
    last = same.h1;
    if (order < 4 || common < 4) continue; /* HighOrders compares the limit's energy and norm closer */
    assert_near(same.energy, ENERGY, 1e-8);
    assert_near(same.norm, NORM, 1e-9);
  }
}

/* 8 cells, orders 1 to 8; the rate of order 5. */
static void HighOrders(void **state)
{
  PetscReal error[8];
  Figures   f, fifth = {0};

  for (PetscInt order = 1; order <= 8; ++order) {
    f                = Solve(2, order, PETSC_FALSE);
    error[order - 1] = f.h1;
    if (order == 5) fifth = f;
  }
  CheckExponential(8, error);
  assert_near(f.energy, ENERGY, 2e-12);
  assert_near(f.norm, NORM, 2e-12);
  f = Solve(3, 5, PETSC_FALSE);
  CheckRate(5, 2, &fifth, 3, &f);
}

static void HangingRates(void **state)
{
  const PetscInt quick[4][2] = {{4, 6}, {2, 4}, {2, 3}, {2, 3}}, fine[4][2] = {{4, 8}, {2, 4}, {2, 4}, {2, 4}};

  for (PetscInt order = 1; order <= 4; ++order) {
    const PetscInt *n = (slow ? fine : quick)[order - 1];
    const Figures   f = Solve(n[0], order, PETSC_TRUE), g = Solve(n[1], order, PETSC_TRUE);
    CheckRate(order, n[0], &f, n[1], &g);
  }
}

/* Instead of the tests: figures of one mesh and order, -cells N -order P [-interpolant]. */
static PetscBool Asked(void)
{
  PetscInt  n, order = 1;
  PetscBool asked;

  OK(PetscOptionsGetInt(NULL, NULL, "-cells", &n, &asked));
  OK(PetscOptionsGetInt(NULL, NULL, "-order", &order, NULL));
  OK(PetscOptionsGetBool(NULL, NULL, "-interpolant", &interpolants, NULL));
  if (asked) Solve(n, order, PETSC_FALSE);
  return asked;
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(BodyForceIsRight), cmocka_unit_test(Rates), cmocka_unit_test(HangingRates), cmocka_unit_test(HighOrders)};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || StageRegister()) return 1;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &slow));
  const int failed = Asked() ? 0 : cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
