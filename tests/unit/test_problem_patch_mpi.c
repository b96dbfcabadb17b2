/* O-02: u = H X on the whole boundary gives u_h = H X and P = P(F1) everywhere, on 2^dim rotated, distorted cells of which a corner one and one of its
   children are split (in all directions or some), with orders 1..8 at random; and a quadratic field under the body force of linear elasticity is found
   exactly by orders 2..8. The same with an order for each direction of space. Tolerance 1e-11 of the largest value. With -slow: all masks of the split in
   space with orders to 8, mixed cells to 6, orders of directions to 8. */
#include "problemfixture.h"
#include "share.h"

#define MOST 729 /* nodes of a cell of order 8 in space */

static const PetscReal Most[9] = {1.2, .15, -.1, .05, .9, .2, -.08, .12, 1.05};
static PetscReal       F1[9];

static PetscReal worst[3]; /* linear field: error of u, of P relative to P(F1); quadratic field: error of u */

static PetscInt along[3]; /* orders of the body along x, y, z; 0: those of the cells */

static void SetDirections(Solved *s, PetscInt dim)
{
  for (PetscInt d = 0; d < dim; ++d) {
    s->bulk.body.order_along[d] = along[d];
    s->bulk.body.order          = PetscMax(s->bulk.body.order, along[d]);
  }
}

/* Are there cells of lower order in some direction if and only if there should be? */
static void CheckDirections(const Solved *s)
{
  PetscBool directional;

  OK(HPSpaceIsDirectional(s->space, &directional));
  assert_int_equal(directional, along[0] > 0);
}

typedef void (*Field)(const PetscReal X[3], PetscReal u[3]);

static void Linear(const PetscReal X[3], PetscReal u[3])
{
  for (PetscInt i = 0; i < 3; ++i) {
    u[i] = -X[i];
    for (PetscInt k = 0; k < 3; ++k) u[i] += F1[3 * i + k] * X[k];
  }
}

static void Quadratic(const PetscReal X[3], PetscReal u[3])
{
  u[0] = 0.03 * X[0] * X[0] - 0.02 * X[0] * X[1] + 0.01 * X[1] * X[2];
  u[1] = 0.02 * X[1] * X[1] + 0.04 * X[0] * X[1] - 0.03 * X[2] * X[2];
  u[2] = -0.01 * X[2] * X[2] + 0.02 * X[0] * X[2] + 0.05 * X[0] * X[1];
}

/* Largest |u_h - u| at the nodes of all cells, hanging ones included. */
static PetscReal FieldError(const Solved *s, Field field)
{
  const HPTables *v     = s->tables;
  PetscReal       error = 0, X[3 * MOST], u[3 * MOST];

  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    OK(HPSpaceGatherPositions(s->space, c, X));
    OK(HPSpaceGather(s->space, c, s->u, u));
    for (PetscInt i = 0; i < ElementNumNodes(v->dim, v->cell_order[c]); ++i) {
      PetscReal position[3] = {0, 0, 0}, exact[3];
      for (PetscInt d = 0; d < v->dim; ++d) position[d] = X[i * v->dim + d];
      field(position, exact);
      for (PetscInt d = 0; d < v->dim; ++d) error = PetscMax(error, PetscAbsReal(u[i * v->dim + d] - exact[d]));
    }
  }
  return LargestOfRanks(error);
}

/* Largest |P - P(F1)| at the quadrature points, and largest |P(F1)|. */
static PetscReal StressError(const Solved *s, PetscReal *scale)
{
  const HPTables *v    = s->tables;
  PetscReal       F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, P[9], error = 0, xi[3 * MOST], weight[MOST], Fq[9 * MOST], Pq[9 * MOST];

  for (PetscInt i = 0; i < v->dim; ++i)
    for (PetscInt k = 0; k < v->dim; ++k) F[3 * i + k] = F1[3 * i + k];
  MaterialPoints point = {.n = 1, .F = F, .P = P};
  OK(MaterialEvaluate(&s->bulk.material, MATERIAL_FULL, &point));
  assert_false(point.bad);
  *scale = 0;
  for (PetscInt k = 0; k < 9; ++k) *scale = PetscMax(*scale, PetscAbsReal(P[k]));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt np = CellGauss(v->dim, v->cell_order[c] + 1, xi, weight);
    OK(MechanicsPoints(s->mechanics, c, np, xi, s->u, &(PointValues){.F = Fq, .P = Pq}));
    for (PetscInt q = 0; q < 9 * np; ++q) error = PetscMax(error, PetscAbsReal(Pq[q] - P[q % 9]));
  }
  return LargestOfRanks(error);
}

static void LinearField(PetscInt dim, PetscInt q, PetscInt high, PetscInt split, PetscBool mixed, uint64_t seed)
{
  Solved    s = {0};
  PetscReal scale;

  HangingMesh(&s, dim, q, split, seed);
  /* Homogeneous states of nearly incompressible material are not the only ones near them at this strain: of high order a third of it */
  for (PetscInt k = 0; k < 9; ++k) F1[k] = (k % 4 == 0) + (high > 4 && mixed ? 0.3 : 1) * (Most[k] - (k % 4 == 0));
  BulkInit(&s.bulk, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
  BulkMaterial(&s.bulk.material, "neo_hookean", mixed ? VOLUMETRIC_SIMO : VOLUMETRIC_LOG, mixed ? FORMULATION_MIXED : FORMULATION_DISPLACEMENT, 1,
               mixed ? 50 : 8. / 3);
  for (PetscInt b = 0; b < 2 * dim; ++b) {
    for (PetscInt c = 0; c < dim; ++c) {
      const PetscReal *H = F1 + 3 * c;
      s.bulk.boundaries[b].displacement[c] =
          BulkExpression("%.17g*X + %.17g*Y + %.17g*Z", (double)(H[0] - (c == 0)), (double)(H[1] - (c == 1)), (double)(H[2] - (c == 2)));
    }
  }
  SetDirections(&s, dim);
  SolvedCreate(&s, 1, high);
  CheckDirections(&s);
  OK(VecSetRandom(s.state.x, NULL));               /* off the line to the answer, which one linear solve would find */
  OK(VecScale(s.state.x, high > 4 ? 2e-5 : 1e-3)); /* nodes of higher order are close together */
  SolvedSolve(&s);
  assert_true(s.report.iterations > 2);
  const PetscReal u = FieldError(&s, Linear), P = StressError(&s, &scale);
  worst[0] = PetscMax(worst[0], u);
  worst[1] = PetscMax(worst[1], P / scale);
  if (!(u < 1e-11 && P < 1e-11 * scale))
    fail_msg("dim %d q %d split %d mixed %d seed %d: |u - HX| %g, |P - P(F1)| %g of %g", (int)dim, (int)q, (int)split, mixed, (int)seed, (double)u, (double)P,
             (double)scale);
  SolvedDestroy(&s);
}

static void LinearPlane(void **state)
{
  for (PetscInt q = 1; q <= 2; ++q)
    for (PetscInt split = 1; split <= 3; ++split)
      for (uint64_t seed = 0; seed < 4; ++seed)
        if (Share(12 * q + 4 * split + (PetscInt)seed, 5)) LinearField(2, q, seed < 2 ? 4 : 8, split, (PetscBool)(seed % 2), seed);
}

static void LinearSpace(void **state)
{
  const PetscInt split[] = {7, 7, 1, 6, 3, 4};
  for (PetscInt i = 0; i < 4; ++i)
    if (Share(i, 2)) LinearField(3, 1 + i % 2, 4, split[i], (PetscBool)(i / 2 % 2), (uint64_t)i);
  if (Share(4, 2)) LinearField(3, 2, 8, 4, PETSC_FALSE, 6);
}

/* b = -mu lap u - (lambda + mu) grad div u, constant. */
static void QuadraticField(PetscInt dim, PetscInt high, PetscInt split, PetscBool mixed, uint64_t seed)
{
  static const char *const text[]         = {"0.03*X^2 - 0.02*X*Y + 0.01*Y*Z", "0.02*Y^2 + 0.04*X*Y - 0.03*Z^2", "-0.01*Z^2 + 0.02*X*Z + 0.05*X*Y"};
  const PetscReal          laplace[2][3]  = {{0.06, 0.04, 0}, {0.06, 0.04 - 0.06, -0.02}};
  const PetscReal          grad_div[2][3] = {{0.06 + 0.04, -0.02 + 0.04, 0}, {0.06 + 0.04 + 0.02, -0.02 + 0.04, -0.02}};
  Solved                   s              = {0};

  HangingMesh(&s, dim, 1, split, seed);
  BulkInit(&s.bulk, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_SMALL);
  BulkMaterial(&s.bulk.material, "linear", VOLUMETRIC_QUADRATIC, mixed ? FORMULATION_MIXED : FORMULATION_DISPLACEMENT, 1.5, 4);
  for (PetscInt c = 0; c < dim; ++c) {
    for (PetscInt b = 0; b < 2 * dim; ++b) s.bulk.boundaries[b].displacement[c] = BulkExpression("%s", text[c]);
    s.bulk.body.force[c] = BulkExpression("%.17g", (double)(-1.5 * laplace[dim - 2][c] - (s.bulk.material.lambda + 1.5) * grad_div[dim - 2][c]));
  }
  SetDirections(&s, dim);
  SolvedCreate(&s, 2, high);
  CheckDirections(&s);
  SolvedSolve(&s);
  const PetscReal error = FieldError(&s, Quadratic);
  worst[2]              = PetscMax(worst[2], error);
  if (!(error < 1e-11)) fail_msg("dim %d split %d mixed %d seed %d: |u_h - u| %g", (int)dim, (int)split, mixed, (int)seed, (double)error);
  SolvedDestroy(&s);
}

static void QuadraticExact(void **state)
{
  for (uint64_t seed = 0; seed < 3; ++seed)
    for (PetscInt split = 1; split <= 3; ++split)
      if (Share((PetscInt)seed + split, 2)) QuadraticField(2, seed ? 8 : 4, split, PETSC_FALSE, seed);
  if (Share(0, 2)) QuadraticField(3, 4, 7, PETSC_FALSE, 3);
  if (Share(1, 2)) QuadraticField(3, 4, 5, PETSC_FALSE, 4);
  if (Share(1, 2)) QuadraticField(3, 8, 2, PETSC_FALSE, 5);
}

static void Directions(void **state)
{
  static const PetscInt linear[][3] = {{1, 4, 2}, {3, 1, 4}, {4, 2, 1}, {1, 1, 4}}, quadratic[][3] = {{2, 4, 3}, {4, 2, 2}};

  for (PetscInt i = 0; i < 4; ++i) {
    if (!Share(i, 2)) continue;
    OK(PetscArraycpy(along, linear[i], 3));
    if (along[0] != along[1]) LinearField(2, 1 + i % 2, 4, 1 + i % 3, PETSC_FALSE, (uint64_t)i);
    LinearField(3, 1 + i % 2, 4, i < 2 ? 7 : 1 + i, PETSC_FALSE, (uint64_t)i);
  }
  for (PetscInt i = 0; i < 2; ++i) {
    if (!Share(i, 2)) continue;
    OK(PetscArraycpy(along, quadratic[i], 3));
    QuadraticField(2, 4, 3 - i, PETSC_FALSE, (uint64_t)i);
    QuadraticField(3, 4, 7 - 2 * i, PETSC_FALSE, (uint64_t)i);
  }
  OK(PetscArrayzero(along, 3));
}

/* Every mask of the split, orders to 8, mixed ones to 6. Random curved cells: of seeds 1 to 6 one whose cells are not inverted, nor so nearly that the noise of
   the start is too much for Newton's method. */
static void LinearSpaceHigh(void **state)
{
  static const uint64_t seed[] = {4, 3, 4, 3, 1, 3, 5}, mixed[] = {1, 3, 6, 3, 1, 3, 1};

  for (PetscInt split = 1; split <= 7; ++split) LinearField(3, 1 + split % 2, 8, split, PETSC_FALSE, seed[split - 1]);
  for (PetscInt split = 1; split <= 7; split += 2) LinearField(3, 2, 6, split, PETSC_TRUE, mixed[split - 1]);
  LinearField(3, 1, 6, 4, PETSC_TRUE, mixed[3]);
}

static void QuadraticSpaceHigh(void **state)
{
  for (PetscInt split = 1; split <= 7; split += 2) QuadraticField(3, 8, split, PETSC_FALSE, (uint64_t)(200 + split));
}

static void DirectionsHigh(void **state)
{
  static const PetscInt linear[][3] = {{1, 8, 4}, {8, 3, 1}, {2, 5, 8}, {6, 7, 1}}, quadratic[][3] = {{2, 8, 5}, {8, 6, 2}};

  for (PetscInt i = 0; i < 4; ++i) {
    OK(PetscArraycpy(along, linear[i], 3));
    LinearField(2, 1 + i % 2, 8, 1 + i % 3, PETSC_FALSE, (uint64_t)i);
    LinearField(3, 1 + i % 2, 8, 7 - i, PETSC_FALSE, (uint64_t)i);
  }
  for (PetscInt i = 0; i < 2; ++i) {
    OK(PetscArraycpy(along, quadratic[i], 3));
    QuadraticField(2, 8, 1 + i, PETSC_FALSE, (uint64_t)i);
    QuadraticField(3, 8, 1 + 2 * i, PETSC_FALSE, (uint64_t)i);
  }
  OK(PetscArrayzero(along, 3));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LinearPlane), cmocka_unit_test(LinearSpace), cmocka_unit_test(QuadraticExact),
                                     cmocka_unit_test(Directions)};
  const struct CMUnitTest slow[]  = {cmocka_unit_test(LinearPlane),   cmocka_unit_test(LinearSpace),     cmocka_unit_test(QuadraticExact),
                                     cmocka_unit_test(Directions),    cmocka_unit_test(LinearSpaceHigh), cmocka_unit_test(QuadraticSpaceHigh),
                                     cmocka_unit_test(DirectionsHigh)};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || StageRegister()) return 1;
  OK(PetscOptionsSetValue(NULL, "-solve_rtol", "1e-13"));
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  const int failed = share_all ? cmocka_run_group_tests(slow, NULL, NULL) : cmocka_run_group_tests(tests, NULL, NULL);
  print_message("at most |u - HX| %.1e, |P - P(F1)|/|P(F1)| %.1e, quadratic |u_h - u| %.1e\n", (double)worst[0], (double)worst[1], (double)worst[2]);
  return PetscFinalize() || failed;
}
