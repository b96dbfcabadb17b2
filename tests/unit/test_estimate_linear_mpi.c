/* A linear displacement field leaves no residual on any mesh (curved cells, hanging nodes, anisotropic splits, mixed orders, rotated cells), whatever the
   law and formulation, when boundaries carry its tractions: dead, follower or through a support. And where the tractions are left out, the estimate is
   exactly scale h/(p m) |P N|^2. Tolerances: 1e-11 of the energy norm (round-off of P: 1e-15 times condition of Div ~ 1/h; squared sums of a few hundred
   terms). */
#include "bulkfixture.h"
#include "estimateimpl.h"

static const PetscReal gradient[9] = {0.05, 0.08, -0.03, -0.04, 0.07, 0.02, 0.06, -0.05, -0.03}; /* H, rows i */

static void FillLinear(const Bulk *b, const PetscReal H[9], PetscReal **u)
{
  const HPTables *v;

  v = HPSpaceGetTables(b->space);
  OK(PetscMalloc1(v->num_nodes * v->dim, u));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal *frame;
    PetscReal        value[3] = {0, 0, 0};
    for (PetscInt c = 0; c < v->dim; ++c)
      for (PetscInt k = 0; k < v->dim; ++k) value[c] += H[3 * c + k] * v->X[3 * n + k];
    OK(HPSpaceGetFrame(b->space, n, &frame));
    for (PetscInt c = 0; c < v->dim; ++c)
      (*u)[n * v->dim + c] = frame ? frame[3 * c] * value[0] + frame[3 * c + 1] * value[1] + frame[3 * c + 2] * value[2] : value[c];
  }
}

/* Constant P of the linear field. */
static void ConstantStress(const Bulk *b, PetscInt dim, const PetscReal H[9], PetscReal F[9], PetscReal P[9])
{
  const PetscBool small = (PetscBool)(b->spec.kinematics == KINEMATICS_SMALL);
  MaterialSpec    law   = b->material;

  if (small) law.law = MaterialLawFind("linear");
  for (PetscInt k = 0; k < 9; ++k) F[k] = (k % 4 == 0) + (k % 3 < dim && k / 3 < dim ? H[k] : 0);
  MaterialPoints point = {.n = 1, .F = F, .P = P};
  OK(MaterialEvaluate(&law, MATERIAL_FULL, &point));
  assert_false(point.bad);
}

static void Sum(const Bulk *b, const PetscReal u[], EstimateSum *sum, PetscReal **eta2)
{
  const ForestTables *t;
  PetscReal           shares[NUM_PARTS + 1];

  t = ForestGetTables(b->forest);
  OK(PetscCalloc1(t->num_leaves, eta2));
  *sum = (EstimateSum){.space = b->space, .mechanics = b->mechanics, .spec = &b->spec, .time = 1, .u = u, .eta2 = *eta2};
  OK(EstimateBulk_Private(sum));
  OK(MPI_Allreduce(MPI_IN_PLACE, *eta2, (PetscMPIInt)t->num_leaves, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(PetscArraycpy(shares, sum->part, NUM_PARTS));
  shares[NUM_PARTS] = sum->energy;
  OK(MPI_Allreduce(MPI_IN_PLACE, shares, NUM_PARTS + 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(PetscArraycpy(sum->part, shares, NUM_PARTS));
  sum->energy = shares[NUM_PARTS];
}

static PetscReal Total(const EstimateSum *sum)
{
  PetscReal total = 0;
  for (PetscInt k = 0; k < NUM_PARTS; ++k) total += sum->part[k];
  return PetscSqrtReal(total);
}

/* Dead tractions P N on every side of the box, except `skip`. */
static void LoadSides(Bulk *b, PetscInt dim, const PetscReal P[9], PetscInt skip)
{
  for (PetscInt s = 0; s < 2 * dim; ++s) {
    for (PetscInt c = 0; c < dim && s != skip; ++c) b->boundaries[s].traction[c] = BulkExpression("%.17g", (double)((s % 2 ? 1 : -1) * P[3 * c + s / 2]));
  }
}

static void Setting(Bulk *b, PetscInt dim, PetscInt kind)
{
  *b = (Bulk){0};
  BulkInit(b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, kind == 2 ? KINEMATICS_SMALL : KINEMATICS_FINITE);
  if (kind == 0) BulkMaterial(&b->material, "neo_hookean", VOLUMETRIC_LOG, FORMULATION_DISPLACEMENT, 1.5, 2);
  if (kind == 1) BulkMaterial(&b->material, "neo_hookean", VOLUMETRIC_QUADRATIC, FORMULATION_MIXED, 1.5, 200);
  if (kind == 2) BulkMaterial(&b->material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_MIXED, 1.5, 30);
}

static void NoResidual(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt kind = 0; kind < 3; ++kind) {
      for (PetscInt seed = 0; seed < 3; ++seed) {
        Bulk        b;
        Box         box;
        EstimateSum sum;
        PetscReal  *u, *eta2, F[9], P[9];
        Setting(&b, dim, kind);
        b.forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 2, 1}, 2, 0, (uint64_t)seed, &box);
        BulkRefine(&b.forest, dim, dim == 2 ? 3 : 2, (PetscBool)(seed > 0));
        ConstantStress(&b, dim, gradient, F, P);
        LoadSides(&b, dim, P, -1);
        BulkSetUp(&b, 1, dim == 2 ? 4 : 3);
        FillLinear(&b, gradient, &u);
        Sum(&b, u, &sum, &eta2);
        const PetscReal scale = PetscSqrtReal(2 * sum.energy);
        assert_true(scale > 0.05);
        if (!(Total(&sum) < 1e-11 * scale))
          fail_msg("dim %d kind %d seed %d: %g of %g; %g %g %g %g", (int)dim, (int)kind, (int)seed, (double)Total(&sum), (double)scale, (double)sum.part[0],
                   (double)sum.part[1], (double)sum.part[2], (double)sum.part[4]);
        OK(PetscFree(u));
        OK(PetscFree(eta2));
        BulkDestroy(&b);
      }
    }
  }
}

/* Without the traction on one side: that side alone carries scale area h/(p m) |P N|^2. Orders 1, box of one cell refined twice: h = 1/4. */
static void MissingTraction(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt order = 1; order <= 2; ++order) {
      Bulk        b;
      Box         box;
      EstimateSum sum;
      PetscReal  *u, *eta2, F[9], P[9], square = 0;
      Setting(&b, dim, 0);
      b.forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){1, 1, 1}, 1, 2, 3, &box);
      ConstantStress(&b, dim, gradient, F, P);
      LoadSides(&b, dim, P, 1);
      BulkSetUp(&b, order, order);
      FillLinear(&b, gradient, &u);
      Sum(&b, u, &sum, &eta2);
      for (PetscInt c = 0; c < dim; ++c) square += PetscSqr(P[3 * c]);
      assert_near(sum.part[PART_BOUNDARY], EstimateScale_Private(order) * 0.25 / (order * EstimateModulus_Private(&b.material)) * square, 1e-13);
      assert_near(Total(&sum), PetscSqrtReal(EstimateScale_Private(order) * 0.25 / (order * EstimateModulus_Private(&b.material)) * square), 1e-12);
      OK(PetscFree(u));
      OK(PetscFree(eta2));
      BulkDestroy(&b);
    }
  }
}

/* A roller answers for the normal traction only, and the rest counts as half of the jump to the mirror image, 2 |P_t|^2; full supports for everything; a
 * prescribed component for itself. */
static void Supported(void **state)
{
  Bulk        b;
  Box         box;
  EstimateSum sum;
  PetscReal  *u, *eta2, F[9], P[9];

  Setting(&b, 2, 0);
  b.forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){1, 1, 1}, 1, 2, 5, &box);
  ConstantStress(&b, 2, gradient, F, P);
  b.boundaries[0].fix[0] = b.boundaries[0].fix[1] = PETSC_TRUE; /* nothing left on x = 0 */
  b.boundaries[1].fix_normal                      = PETSC_TRUE; /* P_yX left on x = 1, twice */
  b.boundaries[2].fix[0]                          = PETSC_TRUE; /* P_yY left on y = 0 */
  BulkSetUp(&b, 1, 1);
  FillLinear(&b, gradient, &u);
  Sum(&b, u, &sum, &eta2);
  const PetscReal expected = ESTIMATE_SCALE * 0.25 / EstimateModulus_Private(&b.material) *
                             (2 * PetscSqr(P[3]) + PetscSqr(P[4]) + PetscSqr(P[1]) + PetscSqr(P[4])); /* y = 1 is free */
  assert_near(sum.part[PART_BOUNDARY], expected, 1e-13);
  assert_near(PetscSqr(Total(&sum)), expected, 1e-13);
  OK(PetscFree(u));
  OK(PetscFree(eta2));
  BulkDestroy(&b);
}

/* Equal biaxial stretch l in plane strain: P_11 = P_22 is a follower pressure p = -P_11 / l pulled back. */
static void FollowerPressure(void **state)
{
  const PetscReal H[9] = {0.2, 0, 0, 0, 0.2, 0, 0, 0, 0};
  Bulk            b;
  Box             box;
  EstimateSum     sum;
  PetscReal      *u, *eta2, F[9], P[9];

  Setting(&b, 2, 1);
  b.forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){2, 2, 1}, 2, 1, 5, &box);
  ConstantStress(&b, 2, H, F, P);
  for (PetscInt s = 0; s < 4; ++s) b.boundaries[s].pressure = BulkExpression("%.17g", (double)(-P[0] / 1.2));
  BulkSetUp(&b, 1, 2);
  FillLinear(&b, H, &u);
  Sum(&b, u, &sum, &eta2);
  assert_true(PetscAbsReal(P[0]) > 1);
  assert_true(Total(&sum) < 1e-11 * PetscSqrtReal(2 * sum.energy));
  OK(PetscFree(u));
  OK(PetscFree(eta2));
  BulkDestroy(&b);
}

/* Axisymmetric: u = (a r, b z) has no residual; weights 2 pi R: a side left free carries 2 pi scale int h/(p m) P_zZ^2 R dR over 0..2, h = 1/2 on the uniform
 * mesh.
 */
static void Axisymmetric(void **state)
{
  const PetscReal H[9] = {0.1, 0, 0, 0, -0.15, 0, 0, 0, 0}, stretched[9] = {1.1, 0, 0, 0, 0.85, 0, 0, 0, 1.1};

  for (PetscInt uniform = 0; uniform < 2; ++uniform) {
    PetscReal   P[9];
    Bulk        b = {0};
    Box         box;
    EstimateSum sum;
    PetscReal  *u, *eta2;
    BulkInit(&b, 2, MODEL_AXISYMMETRIC, KINEMATICS_FINITE);
    BulkMaterial(&b.material, "neo_hookean", VOLUMETRIC_LOG, FORMULATION_DISPLACEMENT, 1.5, 3);
    b.forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){2, 2, 1}, uniform ? 1 : 2, uniform ? 1 : 0, 7, &box);
    if (!uniform) BulkRefine(&b.forest, 2, 2, PETSC_FALSE);
    MaterialPoints point = {.n = 1, .F = stretched, .P = P};
    OK(MaterialEvaluate(&b.material, MATERIAL_FULL, &point));
    LoadSides(&b, 2, P, uniform ? 2 : -1);
    BulkSetUp(&b, 2, 2);
    FillLinear(&b, H, &u);
    Sum(&b, u, &sum, &eta2);
    const PetscReal expected = uniform ? ESTIMATE_SCALE * 0.5 / (2 * EstimateModulus_Private(&b.material)) * PetscSqr(P[4]) * 4 * PETSC_PI : 0;
    assert_near(PetscSqr(Total(&sum)), expected, 1e-12);
    assert_near(sum.part[PART_BOUNDARY], expected, 1e-12);
    OK(PetscFree(u));
    OK(PetscFree(eta2));
    BulkDestroy(&b);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NoResidual), cmocka_unit_test(MissingTraction), cmocka_unit_test(Supported),
                                     cmocka_unit_test(FollowerPressure), cmocka_unit_test(Axisymmetric)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
