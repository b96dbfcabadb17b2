/* O-80, the singular L-shape (plane strain, E = 1e5, nu = 0.3; also nearly incompressible), adapted by the estimate: effectivity in [0.5, 3] on every mesh,
   energy error N^(-p/2) for adaptive meshes of order p (slope -.5 +- .07, -1 +- .15 over the last cycles), and at least 60 % of the refined leaves touch the
   corner in each of the first three cycles of p = 1 (counted: leaves within one cell layer of the corner). */
#include "estimate.h"
#include "solvefixture.h"

#define EXPONENT 0.544483736782464
static PetscReal mu = 1e5 / 2.6, lambda = 1e5 * 0.3 / (1.3 * 0.4);

static void Constants(PetscReal *c1, PetscReal *c2)
{
  const PetscReal om = 3 * PETSC_PI / 4, a = EXPONENT;
  *c1 = -PetscCosReal((a + 1) * om) / PetscCosReal((a - 1) * om);
  *c2 = 2 * (lambda + 2 * mu) / (lambda + mu);
}

/* Strain of the mode I field, from its polar components. */
static void Strain(const PetscReal X[3], PetscReal H[9])
{
  const PetscReal a = EXPONENT, r = PetscSqrtReal(X[0] * X[0] + X[1] * X[1]), t = PetscAtan2Real(X[1], X[0]), f = PetscPowReal(r, a - 1) / (2 * mu);
  PetscReal       c1, c2;

  Constants(&c1, &c2);
  const PetscReal ur = -(a + 1) * PetscCosReal((a + 1) * t) + (c2 - a - 1) * c1 * PetscCosReal((a - 1) * t),
                  ut = (a + 1) * PetscSinReal((a + 1) * t) + (c2 + a - 1) * c1 * PetscSinReal((a - 1) * t);
  const PetscReal dr = (a + 1) * (a + 1) * PetscSinReal((a + 1) * t) - (a - 1) * (c2 - a - 1) * c1 * PetscSinReal((a - 1) * t),
                  dt = (a + 1) * (a + 1) * PetscCosReal((a + 1) * t) + (a - 1) * (c2 + a - 1) * c1 * PetscCosReal((a - 1) * t);
  const PetscReal rr = f * a * ur, tt = f * (ur + dt), rt = 0.5 * f * (dr + (a - 1) * ut), c = PetscCosReal(t), s = PetscSinReal(t);
  const PetscReal h[9] = {c * c * rr - 2 * c * s * rt + s * s * tt,
                          c * s * (rr - tt) + (c * c - s * s) * rt,
                          0,
                          c * s * (rr - tt) + (c * c - s * s) * rt,
                          s * s * rr + 2 * c * s * rt + c * c * tt,
                          0,
                          0,
                          0,
                          0};
  OK(PetscArraycpy(H, h, 9));
}

/* Three quads around the corner; group 0: the outer boundary, the two free faces have no group. */
static Forest LShape(PetscInt refine)
{
  const PetscReal at[8][2]     = {{0, 0}, {-1, -1}, {0, -2}, {1, -1}, {2, 0}, {1, 1}, {0, 2}, {-1, 1}};
  const PetscInt  cells[3][4]  = {{1, 2, 0, 3}, {0, 3, 5, 4}, {0, 5, 7, 6}};
  const PetscInt  facets[6][2] = {{1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 7}};
  const uint64_t  groups[6]    = {1, 1, 1, 1, 1, 1};
  CoarseMesh      mesh         = {.dim = 2, .num_cells = 3, .num_vertices = 8, .geometry_order = 1, .num_bodies = 1, .num_boundaries = 1};
  Forest          forest;

  OK(PetscCalloc1(1, &mesh.body_name));
  OK(PetscCalloc1(1, &mesh.boundary_name));
  OK(PetscStrcpy(mesh.body_name[0], "plate"));
  OK(PetscStrcpy(mesh.boundary_name[0], "outer"));
  OK(PetscMalloc1(12, &mesh.cell_vertices));
  OK(PetscCalloc1(36, &mesh.cell_geometry));
  OK(PetscCalloc1(3, &mesh.cell_body));
  for (PetscInt i = 0; i < 12; ++i) {
    mesh.cell_vertices[i] = cells[i / 4][i % 4];
    OK(PetscArraycpy(mesh.cell_geometry + 3 * i, at[cells[i / 4][i % 4]], 2));
  }
  OK(ForestCreateFromCoarse(PETSC_COMM_SELF, &mesh, 6, facets[0], groups, refine, &forest));
  return forest;
}

static void Texts(Bulk *b)
{
  const double a = EXPONENT;
  PetscReal    c1, c2;
  char         ur[512], ut[512];

  Constants(&c1, &c2);
  snprintf(ur, sizeof(ur), "(%.17g*cos(%.17g*atan2(Y,X)) + %.17g*cos(%.17g*atan2(Y,X)))", -(a + 1), a + 1, (double)((c2 - a - 1) * c1), a - 1);
  snprintf(ut, sizeof(ut), "(%.17g*sin(%.17g*atan2(Y,X)) + %.17g*sin(%.17g*atan2(Y,X)))", a + 1, a + 1, (double)((c2 + a - 1) * c1), a - 1);
  b->boundaries[0].displacement[0] = BulkExpression("(X^2+Y^2)^%.17g/%.17g*(cos(atan2(Y,X))*%s-sin(atan2(Y,X))*%s)", a / 2, (double)(2 * mu), ur, ut);
  b->boundaries[0].displacement[1] = BulkExpression("(X^2+Y^2)^%.17g/%.17g*(sin(atan2(Y,X))*%s+cos(atan2(Y,X))*%s)", a / 2, (double)(2 * mu), ur, ut);
}

/* Share of the marked leaves that lie within one layer of cells of the corner: |centre| < 2 diagonals of the leaf. */
static PetscReal CornerShare(Forest forest, const ForestTables *t, const MarkList *marks)
{
  PetscReal near = 0, all = 0;

  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    const PetscReal middle[3] = {0.5, 0.5, 0.5}, low[3] = {0, 0, 0};
    PetscReal       X[3], Y[3];
    if (!marks->split[l]) continue;
    OK(ForestMapPoint(forest, l, middle, X));
    OK(ForestMapPoint(forest, l, low, Y));
    all++;
    if (PetscSqrtReal(X[0] * X[0] + X[1] * X[1]) < 4.5 * Distance(X, Y)) near++;
  }
  return near / all;
}

static void Cycles(PetscInt order, PetscInt cycles, Formulation formulation, PetscReal slope, PetscReal tolerance)
{
  Forest    forest = LShape(1);
  PetscReal errors[20], dofs[20];

  for (PetscInt cycle = 0; cycle < cycles; ++cycle) {
    Bulk                b = {0};
    EstimateSum         sum;
    const HPTables     *v;
    const ForestTables *t;
    const PetscInt     *global;
    PetscReal          *u;
    Estimate            e;
    AdaptSpec           spec = {.fraction = 0.5, .coarsen = 0, .max_cells = 100000};
    MarkList            marks;
    ForestMap           map;
    PetscInt            marked, n = 0;
    BulkInit(&b, 2, MODEL_PLANE_STRAIN, KINEMATICS_SMALL);
    b.spec.num_boundaries = 1;
    BulkMaterial(&b.material, "linear", VOLUMETRIC_QUADRATIC, formulation, mu, lambda + 2 * mu / 3);
    Texts(&b);
    b.forest = forest;
    BulkSetUp(&b, order, order);
    v = HPSpaceGetTables(b.space);
    t = ForestGetTables(forest);
    OK(HPSpaceGetGlobalDofs(b.space, &global));
    for (PetscInt i = 0; i < 2 * v->num_nodes; ++i) n = PetscMax(n, global[i] + 1);
    OK(PetscCalloc1(2 * v->num_nodes, &u));
    BulkSolve(&b, u);
    e = (Estimate){.num_leaves = t->num_leaves};
    OK(PetscCalloc1(t->num_leaves, &e.eta2));
    sum = (EstimateSum){.space = b.space, .mechanics = b.mechanics, .spec = &b.spec, .time = 1, .u = u, .eta2 = e.eta2};
    OK(EstimateBulk_Private(&sum));
    for (PetscInt l = 0; l < t->num_leaves; ++l) e.total += e.eta2[l];
    errors[cycle] = BulkError(&b, Strain, u);
    dofs[cycle]   = n;
    OK(EstimateMark(&e, &spec, forest, &marks, NULL, &marked));
    const PetscReal effectivity = PetscSqrtReal(e.total) / errors[cycle], share = CornerShare(forest, t, &marks);
    print_message("p %d %s cycle %2d cells %5d dofs %6d |e|/norm %.3e eta/|e| %.3f marked %4d corner %.2f energy %.10e\n", (int)order,
                  b.material.mixed ? "mixed" : "displ", (int)cycle, (int)t->num_leaves, (int)n, (double)(errors[cycle] / PetscSqrtReal(2 * sum.energy)),
                  (double)effectivity, (int)marked, (double)share, (double)sum.energy);
    assert_true(effectivity > 0.5 && effectivity < 3);
    if (order == 1 && cycle < 3) assert_true(share >= 0.6);
    OK(ForestAdapt(b.forest, &marks, NULL, 0, NULL, &forest, &map));
    OK(MarkListDestroy(&marks));
    OK(ForestMapDestroy(&map));
    OK(EstimateDestroy(&e));
    OK(PetscFree(u));
    BulkDestroy(&b);
  }
  OK(ForestDestroy(&forest));
  const PetscReal rate = PetscLogReal(errors[cycles - 1] / errors[cycles - 5]) / PetscLogReal(dofs[cycles - 1] / dofs[cycles - 5]);
  print_message("p %d: slope %.3f\n", (int)order, (double)rate);
  assert_near(rate, slope, tolerance);
}

static void LinearCells(void **state)
{
  Cycles(1, 10, FORMULATION_DISPLACEMENT, -0.5, 0.07);
}

static void QuadraticCells(void **state)
{
  Cycles(2, 14, FORMULATION_DISPLACEMENT, -1, 0.15);
}

static void NearlyIncompressible(void **state)
{
  mu     = 1 / 2.998;
  lambda = 0.499 / (1.499 * 0.002);
  Cycles(2, 14, FORMULATION_MIXED, -1, 0.15);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LinearCells), cmocka_unit_test(QuadraticCells), cmocka_unit_test(NearlyIncompressible)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
