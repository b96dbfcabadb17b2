/* Bulk marking: the fewest leaves for the share, ties together, limits kept, coarsening below its share, directions, the same list whatever comes in which
 * order. */
#include "estimate.h"
#include "forest_box.h"

static void Mark(Forest forest, PetscReal eta2[], PetscReal fraction, PetscReal coarsen, PetscInt max_cells, MarkList *marks, PetscInt *num)
{
  const ForestTables *t;
  const AdaptSpec     spec = {.fraction = fraction, .coarsen = coarsen, .max_cells = max_cells};
  Estimate            e    = {.eta2 = eta2};

  t            = ForestGetTables(forest);
  e.num_leaves = t->num_leaves;
  OK(EstimateMark(&e, &spec, forest, marks, NULL, num));
}

static void Shares(void **state)
{
  Box       box;
  Forest    forest  = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){3, 3, 1}, 1, 0, 1, &box);
  PetscReal eta2[9] = {4, 1, 9, 0, 16, 1, 2, 3, 0.001}; /* sum 36.001; sorted 16 9 4 3 2 1 1 .001 0 */
  MarkList  marks;
  PetscInt  num;

  Mark(forest, eta2, 0.5, 0, 1000, &marks, &num); /* 16 + 9 > 18.0005 */
  assert_int_equal(num, 2);
  for (PetscInt l = 0; l < 9; ++l) assert_int_equal(marks.split[l], l == 4 || l == 2 ? 3 : 0);
  OK(MarkListDestroy(&marks));
  Mark(forest, eta2, 0.4, 0, 1000, &marks, &num);
  assert_int_equal(num, 1);
  OK(MarkListDestroy(&marks));
  Mark(forest, eta2, 0.96, 0, 1000, &marks, &num); /* needs 34.56: five give 34, so the two ones go together */
  assert_int_equal(num, 7);
  OK(MarkListDestroy(&marks));
  Mark(forest, eta2, 1, 0, 1000, &marks, &num); /* never a leaf without error */
  assert_int_equal(num, 8);
  assert_int_equal(marks.split[3], 0);
  OK(MarkListDestroy(&marks));
  OK(ForestDestroy(&forest));
}

static void TiesAndOrder(void **state)
{
  Box       box;
  Forest    forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){4, 4, 1}, 1, 0, 1, &box);
  PetscReal eta2[16];
  MarkList  marks;
  PetscInt  num;

  for (PetscInt l = 0; l < 16; ++l) eta2[l] = 1 + 1e-9 * ((7 * l) % 16); /* a symmetric state up to the solver's tolerance */
  Mark(forest, eta2, 0.3, 0, 1000, &marks, &num);
  assert_int_equal(num, 16);
  OK(MarkListDestroy(&marks));
  for (PetscInt l = 0; l < 16; ++l) eta2[l] = 1 + 1e-4 * ((7 * l) % 16); /* different enough: the largest five or so */
  Mark(forest, eta2, 0.3, 0, 1000, &marks, &num);
  assert_int_equal(num, 5);
  for (PetscInt l = 0; l < 16; ++l) assert_int_equal(marks.split[l] != 0, (7 * l) % 16 >= 11);
  OK(MarkListDestroy(&marks));
  OK(ForestDestroy(&forest));
}

static void Limits(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    Box       box;
    Forest    forest  = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){3, 3, 1}, 1, 0, 1, &box);
    PetscReal eta2[9] = {4, 1, 9, 0, 16, 1, 2, 3, 0.001};
    MarkList  marks;
    PetscInt  num;
    for (PetscInt room = -3; room < 60; ++room) {
      Mark(forest, eta2, 1, 0, 9 + room, &marks, &num);
      assert_true(num * ((1 << dim) - 1) <= PetscMax(room, 0));
      assert_true(num >= PetscMin(8, PetscMax(room, 0) / ((1 << dim) - 1) - 1)); /* -1: the pair of ties goes in or stays out together */
      assert_int_equal(marks.split[1], marks.split[5]);
      OK(MarkListDestroy(&marks));
    }
    OK(ForestDestroy(&forest));
  }
}

/* The widest gap among those alike ends the list: below where the share is reached, above it where room is short. */
static void Alike(void **state)
{
  static const struct {
    PetscReal fraction, alike;
    PetscInt  room, num;
  } cases[] = {
      {0.5, 0, 100, 4},                                      /* 20 + 19.6 + 19.5 + 19 > 72.4 */
      {0.5, 0.1, 100, 5},                                    /* the fifth is near, the sixth is not */
      {0.5, 0.3, 100, 7},                                    /* 13.9 to 10 is wider than 18.8 to 14 */
      {0.5, 0.5, 100, 9},                                    /* all are within 9.5 */
      {0.5, 0.3, 12, 3},                                     /* room for 4 of 7: 19.5 to 19 is the widest gap among those */
      {0.5, 0, 12, 4},    {1, 0.3, 100, 9}, {1, 0.3, 20, 5}, /* room for 6 */
      {1, 0.3, 26, 7},                                       /* for 8 */
  };
  Box       box;
  Forest    forest  = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){3, 3, 1}, 1, 0, 1, &box);
  PetscReal eta2[9] = {13.9, 19, 10, 20, 14, 19.5, 18.8, 10, 19.6}; /* sum 144.8 */

  for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); ++i) {
    const AdaptSpec spec = {.fraction = cases[i].fraction, .alike = cases[i].alike, .max_cells = 9 + cases[i].room};
    const Estimate  e    = {.eta2 = eta2, .num_leaves = 9};
    MarkList        marks;
    PetscInt        num;
    OK(EstimateMark(&e, &spec, forest, &marks, NULL, &num));
    assert_int_equal(num, cases[i].num);
    OK(MarkListDestroy(&marks));
  }
  OK(ForestDestroy(&forest));
}

static void Coarsening(void **state)
{
  Box       box;
  Forest    forest  = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){3, 3, 1}, 1, 0, 1, &box);
  PetscReal eta2[9] = {4, 1, 9, 0, 16, 1, 2, 3, 0.001}; /* mean 4.0001 */
  MarkList  marks;
  PetscInt  num;

  Mark(forest, eta2, 0.5, 0.6, 1000, &marks, &num); /* below 0.36 * 4.0001 = 1.44: the ones and .001; zero means rigid */
  for (PetscInt l = 0; l < 9; ++l) assert_int_equal(marks.coarsen[l], l == 1 || l == 5 || l == 8);
  OK(MarkListDestroy(&marks));
  Mark(forest, eta2, 1, 10, 1000, &marks, &num); /* what is split does not coarsen */
  for (PetscInt l = 0; l < 9; ++l) assert_int_equal(marks.coarsen[l], 0);
  OK(MarkListDestroy(&marks));
  OK(ForestDestroy(&forest));
}

/* Directions by their share of the largest; all where nothing is known; cells that would grow too long are split across, too. */
static void Directions(void **state)
{
  Box            box;
  Forest         forest      = BoxForest(PETSC_COMM_WORLD, 3, (const PetscInt[3]){4, 1, 1}, 1, 0, 1, &box);
  PetscReal      eta2[4]     = {4, 3, 2, 1};
  PetscReal      along[4][3] = {{1, 0.09, 0.11}, {0, 0, 0}, {0, 0, 3}, {0.05, 1, 1}};
  const PetscInt expected[4] = {5, 7, 4, 6};
  const Estimate e           = {.num_leaves = 4, .eta2 = eta2, .along = along};
  AdaptSpec      spec        = {.fraction = 1, .max_cells = 1000, .anisotropic = PETSC_TRUE, .share = 0.1, .aspect = 2};
  MarkList       marks;
  PetscInt       num;

  OK(EstimateMark(&e, &spec, forest, &marks, NULL, &num));
  assert_int_equal(num, 4);
  for (PetscInt l = 0; l < 4; ++l) assert_int_equal(marks.split[l], expected[l]);
  OK(MarkListDestroy(&marks));
  spec.aspect = 1.5; /* half a cube is twice as long as wide */
  OK(EstimateMark(&e, &spec, forest, &marks, NULL, &num));
  for (PetscInt l = 0; l < 4; ++l) assert_int_equal(marks.split[l], 7);
  OK(MarkListDestroy(&marks));
  spec.aspect    = 2;
  spec.max_cells = 4 + 3 + 7; /* 3 more by the first, 7 by the second, nothing left for the third */
  OK(EstimateMark(&e, &spec, forest, &marks, NULL, &num));
  assert_int_equal(num, 2);
  OK(MarkListDestroy(&marks));
  spec.anisotropic = PETSC_FALSE;
  spec.max_cells   = 1000;
  OK(EstimateMark(&e, &spec, forest, &marks, NULL, &num));
  for (PetscInt l = 0; l < 4; ++l) assert_int_equal(marks.split[l], 7);
  OK(MarkListDestroy(&marks));
  OK(ForestDestroy(&forest));
}

/* Split along one axis again and again: no leaf is ever longer than the limit. */
static void Aspect(void **state)
{
  Box       box;
  Forest    forest = BoxForest(PETSC_COMM_WORLD, 3, (const PetscInt[3]){1, 1, 1}, 1, 0, 1, &box);
  AdaptSpec spec   = {.fraction = 1, .max_cells = 100000, .anisotropic = PETSC_TRUE, .share = 0.1, .aspect = 4};

  for (PetscInt pass = 0; pass < 5; ++pass) {
    const ForestTables *t;
    Estimate            e = {0};
    MarkList            marks;
    Forest              adapted;
    ForestMap           map;
    PetscInt            num;
    t            = ForestGetTables(forest);
    e.num_leaves = t->num_leaves;
    OK(PetscMalloc1(t->num_leaves, &e.eta2));
    OK(PetscCalloc1(t->num_leaves, &e.along));
    for (PetscInt l = 0; l < t->num_leaves; ++l) {
      e.eta2[l]     = 1;
      e.along[l][1] = 1;
    }
    OK(EstimateMark(&e, &spec, forest, &marks, NULL, &num));
    OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &adapted, &map));
    OK(MarkListDestroy(&marks));
    OK(ForestMapDestroy(&map));
    OK(EstimateDestroy(&e));
    OK(ForestDestroy(&forest));
    forest              = adapted;
    t                   = ForestGetTables(forest);
    const int8_t *level = t->leaf_level;
    assert_int_equal(level[1], pass + 1);
    assert_int_equal(level[0], PetscMax(0, pass - 1));
    assert_int_equal(level[2], PetscMax(0, pass - 1));
  }
  OK(ForestDestroy(&forest));
}

/* Nearly all of the error is the corner's, whatever its size. */
static PetscErrorCode MarkCorner(Forest forest, PetscReal norm, PetscReal tolerance, MarkList *marks, PetscInt *num)
{
  const AdaptSpec     spec = {.fraction = 0.5, .tolerance = tolerance, .max_cells = 1000};
  Estimate            e    = {.norm = norm};
  const ForestTables *t;

  t            = ForestGetTables(forest);
  e.num_leaves = t->num_leaves;
  OK(PetscMalloc1(t->num_leaves, &e.eta2));
  for (PetscInt l = 0; l < t->num_leaves; ++l) e.eta2[l] = t->leaf_lo[3 * l] || t->leaf_lo[3 * l + 1] ? 1e-6 : 1;
  for (PetscInt l = 0; l < t->num_leaves; ++l) e.total += e.eta2[l];
  e.total = PetscSqrtReal(e.total);
  OK(EstimateMark(&e, &spec, forest, marks, NULL, num));
  OK(EstimateDestroy(&e));
  return 0;
}

/* The corner is split until it is as small as a leaf can be. Then others are only where the tolerance can be met so. */
static void Smallest(void **state)
{
  const struct {
    PetscReal norm, tolerance;
    PetscBool marks;
  } cases[] = {
      {1, 0.7, PETSC_FALSE}, /* the corner alone: (1 / (1 + 1))^½ = 0.707 */
      {1, 0.71, PETSC_TRUE},
      {0, 0.7, PETSC_TRUE}, /* parts of several times */
  };
  Box      box;
  Forest   forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){1, 1, 1}, 1, 0, 1, &box);
  MarkList marks;
  PetscInt num;

  for (PetscInt pass = 0; pass < FOREST_MAX_LEVEL; ++pass) {
    Forest    adapted;
    ForestMap map;
    OK(MarkCorner(forest, 1, 0.1, &marks, &num));
    assert_int_equal(num, 1);
    OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &adapted, &map));
    OK(MarkListDestroy(&marks));
    OK(ForestMapDestroy(&map));
    OK(ForestDestroy(&forest));
    forest = adapted;
  }
  for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); ++i) {
    OK(MarkCorner(forest, cases[i].norm, cases[i].tolerance, &marks, &num));
    assert_int_equal(num > 0, cases[i].marks);
    OK(MarkListDestroy(&marks));
  }
  OK(ForestDestroy(&forest));
}

/* Two pairs of sides (bits 0 and 1: left and right of 4 x 4 cells; 2 and 3: below and above), the first one automatic. */
static void Layers(void **state)
{
  Box                 box;
  Forest              forest   = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){4, 4, 1}, 1, 0, 1, &box);
  ContactSpec         pairs[2] = {{.nonmortar = 0, .mortar = 1, .subdivide_auto = PETSC_TRUE}, {.nonmortar = 2, .mortar = 3}};
  const SceneData     data     = {.num_contacts = 2, .contacts = pairs, .adapt = {.max_cells = 16 + 8 * 3}};
  SceneData           small    = data;
  const ForestTables *t;
  int8_t              order[16];
  PetscReal           eta2[16];
  PetscInt            times[2] = {0, 0}, num;
  PetscBool           room;
  MarkList            marks;

  t = ForestGetTables(forest);
  for (PetscInt l = 0; l < 16; ++l) {
    const PetscBool side = ForestLeafTouches(t, l, 1 | 2), other = ForestLeafTouches(t, l, 4 | 8);
    order[l] = 2;
    eta2[l]  = side ? 0.6 : other ? 100 : 1; /* 8 * 0.6 against 4: the other pair's cells count for neither */
  }
  const Estimate e = {.num_leaves = 16, .eta2 = eta2};
  for (PetscInt k = 0; k < 4; ++k) { /* p + 1 times at most */
    OK(EstimateMarkLayers(&e, &data, forest, order, times, &marks, &num, &room));
    assert_int_equal(num, k < 3 ? 8 : 0);
    assert_int_equal(times[0], PetscMin(k + 1, 3));
    assert_true(room);
    for (PetscInt l = 0; l < 16; ++l) assert_int_equal(marks.split[l], k < 3 && ForestLeafTouches(t, l, 1 | 2) ? 3 : 0);
    OK(MarkListDestroy(&marks));
  }
  assert_int_equal(times[1], 0);
  times[0] = 0;
  --small.adapt.max_cells;
  OK(EstimateMarkLayers(&e, &small, forest, order, times, &marks, &num, &room));
  assert_true(num == 0 && !room && times[0] == 0);
  OK(MarkListDestroy(&marks));
  for (PetscInt l = 0; l < 16; ++l) order[l] = ForestLeafTouches(t, l, 1) ? 1 : 2; /* cells of order 1 have nothing better inside: 4 * 0.6 against 4 */
  OK(EstimateMarkLayers(&e, &data, forest, order, times, &marks, &num, &room));
  assert_true(num == 0 && room && times[0] == 0);
  OK(MarkListDestroy(&marks));
  OK(ForestDestroy(&forest));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Shares), cmocka_unit_test(TiesAndOrder), cmocka_unit_test(Limits),
                                     cmocka_unit_test(Alike),  cmocka_unit_test(Coarsening),   cmocka_unit_test(Directions),
                                     cmocka_unit_test(Aspect), cmocka_unit_test(Smallest),     cmocka_unit_test(Layers)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
