/* Vertices of linear contact faces. In the plane a strip under the parabola y = 1 + c x^2, cells of width h, its top the contact surface.
   - cells of order 2: inner vertices lie c h^2 / 6 under the curve (the mean distance of the chord), and so do the ends at planes of symmetry: the polygon has
     the curve's area, and dual moments of the gap between them vanish; other ends on the curve;
   - cells of order 1, or a top that is no contact surface: every vertex on the curve.
   In space a part of a thick unit sphere between the planes of symmetry x = 0 and y = 0, refined at the pole or not: the mean distance of the facets is that of
   the sphere to the fourth order (of facets with vertices on it: -h^2 / 6), vertices stay in the planes, and no cell is inverted. */
#include "stripfixture.h"

static void Check(int8_t order, uint64_t linear, uint64_t mirror, PetscReal inner)
{
  Forest          forest = Strip();
  HPSpace         space;
  const HPTables *v;
  int8_t          orders[NUM];
  PetscInt        found = 0;

  for (PetscInt c = 0; c < NUM; ++c) orders[c] = order;
  OK(HPSpaceCreate(forest, orders, NULL, linear, mirror, &space));
  v = HPSpaceGetTables(space);
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal *X = v->X + 3 * n, above = X[1] - 1 - CURVE * X[0] * X[0];
    const PetscReal  cell = X[0] / width;
    if (above < -0.1 || PetscAbsReal(cell - PetscFloorReal(cell + 0.5)) > 1e-12) continue; /* vertices of the top only */
    const PetscBool end = (PetscBool)((cell < 0.5 && !mirror) || cell > NUM - 0.5);
    assert_true(PetscAbsReal(above - (end ? 0 : inner)) < 1e-14);
    ++found;
  }
  assert_int_equal(found, NUM + 1);
  OK(HPSpaceDestroy(&space));
  OK(ForestDestroy(&forest));
}

static void behind_order_2_they_project_the_curve(void **state)
{
  Check(2, 1, 0, -CURVE * width * width / 6);
}

static void so_do_ends_at_planes_of_symmetry(void **state)
{
  Check(2, 1, 2, -CURVE * width * width / 6);
}

static void behind_order_1_they_lie_on_it(void **state)
{
  Check(1, 1, 2, 0);
}

static void without_contact_they_lie_on_it(void **state)
{
  Check(2, 0, 2, 0);
}

/* ---- the sphere ----------------------------------------------------------------------------------------------------------- */

enum { MOST = 8, GEOMETRY = 4 };
#define SPAN (PETSC_PI / 4) /* angle to the sides that are no planes of symmetry */

/* Point of the shell: angles x and y from the planes of symmetry, z from radius 0.5 to 1. */
static void ShellPoint(PetscReal x, PetscReal y, PetscReal z, PetscReal X[3])
{
  const PetscReal a = PetscTanReal(SPAN * x), b = PetscTanReal(SPAN * y), r = (0.5 + 0.5 * z) / PetscSqrtReal(1 + a * a + b * b);

  X[0] = r * a;
  X[1] = r * b;
  X[2] = r;
}

static Forest Shell(PetscInt n)
{
  CoarseMesh mesh = {.dim = 3, .num_cells = n * n, .num_vertices = 2 * (n + 1) * (n + 1), .geometry_order = GEOMETRY, .num_bodies = 1, .num_boundaries = 2};
  PetscInt   facets[MOST * MOST + 2 * MOST][4], num = 0, at = 0;
  uint64_t   groups[MOST * MOST + 2 * MOST];
  Forest     forest;

  OK(PetscCalloc1(1, &mesh.body_name));
  OK(PetscCalloc1(2, &mesh.boundary_name));
  OK(PetscStrcpy(mesh.body_name[0], "shell"));
  OK(PetscStrcpy(mesh.boundary_name[0], "sphere"));
  OK(PetscStrcpy(mesh.boundary_name[1], "planes"));
  OK(PetscMalloc1(8 * n * n, &mesh.cell_vertices));
  OK(PetscMalloc1(3 * 125 * n * n, &mesh.cell_geometry));
  OK(PetscCalloc1(n * n, &mesh.cell_body));
  for (PetscInt c = 0; c < n * n; ++c) {
    const PetscInt i = c % n, j = c / n, *v = mesh.cell_vertices + 8 * c;
    for (PetscInt k = 0; k < 8; ++k) mesh.cell_vertices[8 * c + k] = i + (k & 1) + (n + 1) * (j + ((k >> 1) & 1) + (n + 1) * (k >> 2));
    for (PetscInt k = 0; k < 125; ++k, at += 3) ShellPoint((i + k % 5 / 4.) / n, (j + k / 5 % 5 / 4.) / n, k / 25 / 4., mesh.cell_geometry + at);
    for (PetscInt side = 0; side < 3; ++side) {
      if ((side == 0 && i) || (side == 1 && j)) continue;
      for (PetscInt k = 0; k < 4; ++k) facets[num][k] = v[side == 0 ? 2 * k : side == 1 ? (k & 1) + 4 * (k >> 1) : 4 + k];
      groups[num++] = side == 2 ? 1 : 2;
    }
  }
  OK(ForestCreateFromCoarse(PETSC_COMM_SELF, &mesh, num, facets[0], groups, 0, &forest));
  return forest;
}

/* The forest with its first leaf, at the pole, split `times`. */
static Forest SplitPole(Forest forest, PetscInt times)
{
  for (PetscInt k = 0; k < times; ++k) {
    const ForestTables *t;
    MarkList            marks;
    ForestMap           map;
    Forest              fine;

    t = ForestGetTables(forest);
    OK(PetscCalloc1(t->num_leaves, &marks.split));
    OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
    for (PetscInt l = 0; l < t->num_leaves; ++l) { /* at the pole and at the sphere */
      if (t->leaf_root[l] == 0 && !t->leaf_lo[3 * l] && !t->leaf_lo[3 * l + 1] && (t->boundary[t->closure[t->closure_offset[t->first[3] + l] + 22]] & 1))
        marks.split[l] = 7;
    }
    OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &fine, &map));
    OK(ForestMapDestroy(&map));
    MarksDestroy(&marks);
    OK(ForestDestroy(&forest));
    forest = fine;
  }
  return forest;
}

/* Integral of |X| - 1 over the bilinear facet through corners, by parameters, and of 1. */
static void AddDistance(PetscReal corner[4][3], PetscReal measure, PetscReal sum[2])
{
  const Basis1D *g;

  OK(Basis1DGet(1, 4, &g));
  for (PetscInt q = 0; q < 16; ++q) {
    const PetscReal s = g->points[q % 4], t = g->points[q / 4], w = measure * g->weights[q % 4] * g->weights[q / 4];
    PetscReal       square = 0;
    for (PetscInt c = 0; c < 3; ++c)
      square += PetscSqr((1 - t) * ((1 - s) * corner[0][c] + s * corner[1][c]) + t * ((1 - s) * corner[2][c] + s * corner[3][c]));
    sum[0] += w * (PetscSqrtReal(square) - 1);
    sum[1] += w;
  }
}

static void CheckPlanes(const PetscReal X[3], const PetscReal exact[3])
{
  for (PetscInt c = 0; c < 2; ++c)
    if (PetscAbsReal(exact[c]) < 1e-14) assert_true(PetscAbsReal(X[c]) < 1e-14);
}

/* Smallest Jacobian of a cell relative to its mean. */
static PetscReal SmallestJacobian(PetscInt p, const PetscReal X[])
{
  PetscReal value[27], gradient[81], smallest = PETSC_MAX_REAL, sum = 0;

  for (PetscInt q = 0; q < 125; ++q) {
    const PetscReal xi[3] = {q % 5 / 4., q / 5 % 5 / 4., q / 25 / 4.};
    PetscReal       J[9]  = {0};
    OK(ElementEvaluate(3, p, xi, value, gradient));
    for (PetscInt i = 0; i < ElementNumNodes(3, p); ++i)
      for (PetscInt k = 0; k < 9; ++k) J[k] += X[3 * i + k / 3] * gradient[3 * i + k % 3];
    smallest = PetscMin(smallest, Det3(J));
    sum += Det3(J) / 125;
  }
  return smallest / sum;
}

/* Mean distance from the sphere of the facets that do not touch the sides: with their vertices where they are [0], on the sphere [1]. */
static void MeanDistance(PetscInt n, PetscInt times, PetscReal mean[2])
{
  Forest              forest = SplitPole(Shell(n), times);
  const ForestTables *t;
  const HPTables     *v;
  HPSpace             space;
  int8_t             *orders;
  PetscReal           sum[2][2] = {{0}};

  t = ForestGetTables(forest);
  OK(PetscMalloc1(t->num_leaves, &orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) orders[l] = 2;
  OK(HPSpaceCreate(forest, orders, NULL, 1, 2, &space));
  v = HPSpaceGetTables(space);
  for (PetscInt cell = 0; cell < v->num_owned_cells; ++cell) {
    const PetscInt leaf = v->cell_leaf[cell];
    PetscReal      X[81], corner[2][4][3], side = 0;
    OK(HPSpaceGatherPositions(space, cell, X));
    assert_true(SmallestJacobian(2, X) > 0.2);
    if (!(t->boundary[t->closure[t->closure_offset[t->first[3] + leaf] + 22]] & 1)) continue;
    for (PetscInt k = 0; k < 4; ++k) {
      const PetscReal xi[3] = {k & 1, k >> 1, 1};
      OK(ForestMapPoint(forest, leaf, xi, corner[1][k]));
      OK(PetscArraycpy(corner[0][k], X + 3 * (18 + 2 * (k & 1) + 6 * (k >> 1)), 3));
      CheckPlanes(corner[0][k], corner[1][k]);
      side = PetscMax(side, PetscMax(corner[1][k][0], corner[1][k][1]) / corner[1][k][2]);
    }
    if (side > 1 - 1e-6) { /* beyond the last vertices another boundary begins: they stay */
      for (PetscInt k = 0; k < 4; ++k)
        if (PetscMax(corner[1][k][0], corner[1][k][1]) / corner[1][k][2] > 1 - 1e-6) assert_true(Distance(corner[0][k], corner[1][k]) < 1e-14);
      continue;
    }
    const PetscReal measure = Distance(corner[1][0], corner[1][3]) * Distance(corner[1][1], corner[1][2]);
    for (PetscInt m = 0; m < 2; ++m) AddDistance(corner[m], measure, sum[m]);
  }
  for (PetscInt m = 0; m < 2; ++m) mean[m] = sum[m][0] / sum[m][1];
  OK(PetscFree(orders));
  OK(HPSpaceDestroy(&space));
  OK(ForestDestroy(&forest));
}

static void facets_of_a_sphere_have_its_mean_distance(void **state)
{
  PetscReal coarse[2], fine[2];

  MeanDistance(2, 0, coarse); /* 22.5 degrees a cell: not inverted */
  MeanDistance(4, 0, coarse);
  MeanDistance(8, 0, fine);
  assert_true(coarse[1] < -4e-3 && PetscAbsReal(coarse[0]) < 2e-3 * -coarse[1]);
  assert_true(PetscAbsReal(fine[0]) < PetscAbsReal(coarse[0]) / 8 && fine[1] < coarse[1] / 5);
}

static void refined_at_the_pole_too(void **state)
{
  PetscReal mean[2];

  for (PetscInt times = 1; times < 4; ++times) {
    MeanDistance(4, times, mean);
    assert_true(PetscAbsReal(mean[0]) < 1e-3 * -mean[1]);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(behind_order_2_they_project_the_curve),
      cmocka_unit_test(so_do_ends_at_planes_of_symmetry),
      cmocka_unit_test(behind_order_1_they_lie_on_it),
      cmocka_unit_test(without_contact_they_lie_on_it),
      cmocka_unit_test(facets_of_a_sphere_have_its_mean_distance),
      cmocka_unit_test(refined_at_the_pole_too),
  };

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
