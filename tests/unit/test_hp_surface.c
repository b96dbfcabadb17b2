/* Vertices of linear contact faces: a strip under the parabola y = 1 + c x^2, cells of width h, its top the contact surface.
   - cells of order 2: inner vertices lie c h^2 / 6 under the curve (the mean distance of the chord), ends on it; so the polygon has the curve's area up to its
     ends, and dual moments of the gap between them vanish;
   - cells of order 1, or a top that is no contact surface: every vertex on the curve. */
#include "forest_box.h"
#include "hp.h"

enum { NUM = 6 };
#define CURVE 0.2
static const PetscReal width = 0.5;

static Forest Strip(void)
{
  CoarseMesh mesh = {.dim = 2, .num_cells = NUM, .num_vertices = 2 * (NUM + 1), .geometry_order = 2, .num_bodies = 1, .num_boundaries = 1};
  PetscInt   facets[NUM][2];
  uint64_t   groups[NUM];
  Forest     forest;

  OK(PetscCalloc1(1, &mesh.body_name));
  OK(PetscCalloc1(1, &mesh.boundary_name));
  OK(PetscStrcpy(mesh.body_name[0], "strip"));
  OK(PetscStrcpy(mesh.boundary_name[0], "top"));
  OK(PetscMalloc1(4 * NUM, &mesh.cell_vertices));
  OK(PetscCalloc1(27 * NUM, &mesh.cell_geometry));
  OK(PetscCalloc1(NUM, &mesh.cell_body));
  for (PetscInt c = 0; c < NUM; ++c) {
    for (PetscInt v = 0; v < 4; ++v) mesh.cell_vertices[4 * c + v] = c + v % 2 + (NUM + 1) * (v / 2);
    for (PetscInt k = 0; k < 9; ++k) {
      PetscReal *X = mesh.cell_geometry + 3 * (9 * c + k);
      X[0]         = width * (c + 0.5 * (k % 3));
      X[1]         = 0.5 * (k / 3) * (1 + CURVE * X[0] * X[0]);
    }
    facets[c][0] = c + NUM + 1;
    facets[c][1] = c + NUM + 2;
    groups[c]    = 1;
  }
  OK(ForestCreateFromCoarse(PETSC_COMM_SELF, &mesh, NUM, facets[0], groups, 0, &forest));
  return forest;
}

static void Check(int8_t order, uint64_t linear, PetscReal inner)
{
  Forest          forest = Strip();
  HPSpace         space;
  const HPTables *v;
  int8_t          orders[NUM];
  PetscInt        found = 0;

  for (PetscInt c = 0; c < NUM; ++c) orders[c] = order;
  OK(HPSpaceCreate(forest, orders, linear, &space));
  OK(HPSpaceGetTables(space, &v));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal *X = v->X + 3 * n, above = X[1] - 1 - CURVE * X[0] * X[0];
    const PetscReal  cell = X[0] / width;
    if (above < -0.1 || PetscAbsReal(cell - PetscFloorReal(cell + 0.5)) > 1e-12) continue; /* vertices of the top only */
    const PetscBool end = (PetscBool)(cell < 0.5 || cell > NUM - 0.5);
    assert_true(PetscAbsReal(above - (end ? 0 : inner)) < 1e-14);
    ++found;
  }
  assert_int_equal(found, NUM + 1);
  OK(HPSpaceDestroy(&space));
  OK(ForestDestroy(&forest));
}

static void behind_order_2_they_project_the_curve(void **state)
{
  Check(2, 1, -CURVE * width * width / 6);
}

static void behind_order_1_they_lie_on_it(void **state)
{
  Check(1, 1, 0);
}

static void without_contact_they_lie_on_it(void **state)
{
  Check(2, 0, 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(behind_order_2_they_project_the_curve),
      cmocka_unit_test(behind_order_1_they_lie_on_it),
      cmocka_unit_test(without_contact_they_lie_on_it),
  };

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 1 : failed;
}
