/* The rate at which Legendre coefficients fall, for functions whose rate is known; what follows from it for marked cells and for those far below their share;
   the limit of differences across faces. */
#include "bulkfixture.h"
#include "estimateimpl.h"

typedef PetscReal (*Function)(PetscReal x, PetscReal y);

static PetscReal Pole(PetscReal x, PetscReal y) /* at 2x - 1 = 1.25: coefficients like 2^-k */
{
  return 1 / (1.25 - (2 * x - 1)) + 0.1 * y;
}
static PetscReal Entire(PetscReal x, PetscReal y)
{
  return PetscExpReal(x + 0.5 * y);
}
static PetscReal Corner(PetscReal x, PetscReal y) /* r^0.54: coefficients like k^-3 */
{
  return PetscPowReal(x * x + y * y, 0.27);
}
static PetscReal Beyond(PetscReal x, PetscReal y) /* the same corner, one cell away */
{
  return Corner(x + 1, y);
}
static PetscReal Square(PetscReal x, PetscReal y)
{
  return 3 * x * x - x * y + y;
}

/* Rate of the interpolant of order p in the cell [0,1]^2. */
static PetscReal Rate(Function f, PetscInt order)
{
  Bulk            b = {0};
  Box             box;
  const HPTables *v;
  EstimateSum     sum;
  PetscReal      *u, decay = -1;

  BulkInit(&b, 2, MODEL_PLANE_STRAIN, KINEMATICS_SMALL);
  BulkMaterial(&b.material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_DISPLACEMENT, 1, 1);
  b.forest = BoxForest(PETSC_COMM_SELF, 2, (const PetscInt[3]){1, 1, 1}, 1, 0, 0, &box);
  BulkSetUp(&b, order, order);
  v = HPSpaceGetTables(b.space);
  OK(PetscMalloc1(2 * v->num_nodes, &u));
  for (PetscInt i = 0; i < v->num_nodes; ++i) u[2 * i] = 1 + f(v->X[3 * i], v->X[3 * i + 1]), u[2 * i + 1] = 5 * v->X[3 * i];
  sum = (EstimateSum){.space = b.space, .v = v, .u = u};
  OK(EstimateDecay_Private(&sum, &decay));
  OK(PetscFree(u));
  BulkDestroy(&b);
  return decay;
}

static void Rates(void **state)
{
  for (PetscInt order = 3; order <= 8; ++order) {
    const PetscReal pole = Rate(Pole, order), entire = Rate(Entire, order), corner = Rate(Corner, order), beyond = Rate(Beyond, order);
    print_message("order %d: pole %.2f entire %.2f corner %.2f beyond %.2f\n", (int)order, (double)pole, (double)entire, (double)corner, (double)beyond);
    assert_true(PetscAbsReal(pole - PetscLogReal(2)) < 0.25);
    assert_true(entire > 1.8);
    if (order > 3) assert_true(corner < 1 + 1. / order);
    assert_true(beyond > 1.5);
  }
  assert_true(Rate(Square, 2) == 0); /* nothing can be told */
  for (PetscInt order = 3; order <= 8; ++order) assert_true(Rate(Square, order) > 20);
}

enum { NUM = 9 };
static PetscReal      eta2[NUM]      = {9, 9, 9, 9, 9, 9, 9, 9, 9};
static PetscReal      decay[NUM]     = {0, 0, 2, 1, 2, 2, 2, 0, 2};
static int8_t         order[NUM]     = {1, 2, 4, 4, 8, 4, 4, 2, 3};
static int8_t         lowest[NUM]    = {1, 1, 1, 1, 1, 1, 1, 1, 1};
static int8_t         irregular[NUM] = {0, 0, 0, 0, 0, ESTIMATE_IRREGULAR_FACE, ESTIMATE_IRREGULAR_RIM, ESTIMATE_IRREGULAR_CORNER, ESTIMATE_IRREGULAR_CORNER};
static const Estimate e              = {.num_leaves = NUM, .eta2 = eta2, .decay = decay, .order = order, .lowest = lowest, .irregular = irregular};

static void Choices(void **state)
{
  /* few coefficients: raise; smooth: raise; rough: split; order 8: split; a linear face and a rim: split; a corner: split while little is known */
  const int8_t raised[NUM] = {1, 1, 1, 0, 0, 0, 0, 0, 1};
  AdaptSpec    spec        = {.strategy = ADAPT_HP, .max_order = 8};
  int8_t       split[NUM], raise[NUM];

  for (PetscInt l = 0; l < NUM; ++l) split[l] = 3;
  EstimateChoices_Private(&e, &spec, split, raise);
  for (PetscInt l = 0; l < NUM; ++l) {
    assert_int_equal(raise[l], raised[l]);
    assert_int_equal(split[l], raised[l] ? 0 : 3);
    split[l] = l == 3 ? 0 : 3; /* as small as a leaf can be */
  }
  spec.max_order = 5;
  EstimateChoices_Private(&e, &spec, split, raise);
  assert_int_equal(raise[3], 1);
  spec = (AdaptSpec){.strategy = ADAPT_P, .max_order = 4};
  for (PetscInt l = 0; l < NUM; ++l) split[l] = 3;
  EstimateChoices_Private(&e, &spec, split, raise);
  for (PetscInt l = 0; l < NUM; ++l) {
    assert_int_equal(split[l], 0);
    assert_int_equal(raise[l], order[l] < 4 && irregular[l] != ESTIMATE_IRREGULAR_FACE);
  }
}

/* Far below its share: smooth cells merge where they were split, others lose an order, none below the lowest. */
static void Lower(void **state)
{
  Box                 box;
  Forest              forest = BoxForest(PETSC_COMM_SELF, 2, (const PetscInt[3]){3, 3, 1}, 1, 0, 1, &box), fine = forest;
  const ForestTables *t;
  AdaptSpec           spec = {.strategy = ADAPT_HP, .max_order = 8};
  int8_t              coarsen, p;

  t = ForestGetTables(forest);
  for (PetscInt l = 0; l < NUM; ++l) {
    p = order[l];
    EstimateLower_Private(&e, &spec, t, l, &coarsen, &p);
    assert_int_equal(coarsen, 0);
    assert_int_equal(p, PetscMax(1, order[l] - 1));
  }
  fine = BoxForest(PETSC_COMM_SELF, 2, (const PetscInt[3]){2, 2, 1}, 1, 1, 1, &box);
  t    = ForestGetTables(fine);
  for (PetscInt l = 0; l < NUM; ++l) {
    const int8_t smooth = (int8_t)(order[l] > 2 && decay[l] > 1.5);
    p                   = order[l];
    EstimateLower_Private(&e, &spec, t, l, &coarsen, &p);
    assert_int_equal(coarsen, smooth);
    assert_int_equal(p, smooth ? order[l] : PetscMax(1, order[l] - 1));
  }
  OK(ForestDestroy(&fine));
  OK(ForestDestroy(&forest));
}

/* The whole: shares as ever, orders of what is marked one higher, differences of at most 1 except at cells with a linear face; no leaf more than max_cells. */
static void Marks(void **state)
{
  Box                 box;
  Forest              forest = BoxForest(PETSC_COMM_SELF, 2, (const PetscInt[3]){3, 3, 1}, 1, 0, 1, &box);
  const ForestTables *t;
  AdaptSpec           spec = {.strategy = ADAPT_HP, .max_order = 8, .fraction = 0.3, .max_cells = 9};
  PetscReal           one[NUM];
  MarkList            marks;
  PetscInt            num;
  int8_t              next[NUM], low[NUM];
  Estimate            one_peak = e;

  t = ForestGetTables(forest);
  for (PetscInt l = 0; l < NUM; ++l) one[l] = l == 2 ? 16 : l == 3 ? 15 : 1, low[l] = 2;
  one_peak.eta2  = one;
  one_peak.order = low;
  low[5]         = 1;
  OK(EstimateMark(&one_peak, &spec, forest, &marks, next, &num)); /* 16 > 0.3 * 38: raised, so that max_cells is no limit */
  assert_int_equal(num, 1);
  assert_int_equal(next[2], 3);
  for (PetscInt l = 0; l < NUM; ++l) assert_int_equal(marks.split[l], 0);
  OK(MarkListDestroy(&marks));
  for (PetscInt l = 0; l < NUM; ++l) low[l] = l == 2 ? 6 : 1; /* a difference that nobody would make: evened out over the mesh, but for the linear face */
  decay[2] = 3;
  OK(EstimateMark(&one_peak, &spec, forest, &marks, next, &num));
  assert_int_equal(next[2], 7);
  assert_int_equal(next[5], 1);
  for (PetscInt f = 0; f < t->first[2] - t->first[1]; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * f;
    if (leaf[0] >= 0 && leaf[1] >= 0 && leaf[0] != 5 && leaf[1] != 5) assert_true(PetscAbs(next[leaf[0]] - next[leaf[1]]) <= 1);
  }
  OK(MarkListDestroy(&marks));
  OK(ForestDestroy(&forest));
}

/* Across hanging faces, too. */
static void Even(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt difference = 1; difference <= 2; ++difference) {
      Box                 box;
      Forest              forest = BoxForest(PETSC_COMM_SELF, dim, (const PetscInt[3]){2, 2, 2}, 1, 1, 1, &box);
      const ForestTables *t;
      int8_t             *p, *fixed;
      BulkRefine(&forest, dim, 2, PETSC_TRUE);
      t = ForestGetTables(forest);
      OK(PetscMalloc1(t->num_leaves, &p));
      OK(PetscCalloc1(t->num_leaves, &fixed));
      for (PetscInt l = 0; l < t->num_leaves; ++l) p[l] = (int8_t)(1 + 7 * !BoxRandom(20));
      OK(HPOrdersLimit(forest, difference, fixed, p));
      const PetscInt first = t->first[dim - 1];
      for (PetscInt f = first; f < t->first[dim]; ++f) {
        PetscInt whole = f;
        for (PetscInt s = 0; s < 2; ++s) {
          const PetscInt leaf = t->facet_leaf[2 * (f - first) + s];
          for (whole = f; leaf >= 0 && whole >= 0; whole = t->parent[whole]) {
            for (PetscInt k = 0; k < 2; ++k) {
              const PetscInt other = t->facet_leaf[2 * (whole - first) + k];
              if (other >= 0) assert_true(PetscAbs(p[leaf] - p[other]) <= difference);
            }
          }
        }
      }
      OK(PetscFree(p));
      OK(PetscFree(fixed));
      OK(ForestDestroy(&forest));
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Rates), cmocka_unit_test(Choices), cmocka_unit_test(Lower), cmocka_unit_test(Marks),
                                     cmocka_unit_test(Even)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
