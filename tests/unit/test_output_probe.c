/* Probes: points of curved cells are found again, whatever the cell's axes; points outside are refused by name; round-off at the border is forgiven. */
#include "forest_box.h"
#include "near.h"
#include "output.h"

#define NUM 40

static void LocatesAgain(void **state)
{
  const PetscInt n[3] = {3, 2, 2};

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt q = 1; q <= 3; ++q) {
      ProbeSpec           spec[NUM];
      SceneData           scene = {.num_probes = NUM, .probes = spec};
      const ForestTables *t;
      Box                 box;
      Forest              forest = BoxForest(PETSC_COMM_WORLD, dim, n, q, 1, (uint64_t)(10 * dim + q), &box);
      Probes              probes;

      t = ForestGetTables(forest);
      for (PetscInt i = 0; i < NUM; ++i) {
        /* also on sides and corners of leaves */
        const PetscReal xi[3] = {BoxRandom(5) / 4., BoxRandom(5) / 4., BoxRandom(5) / 4.};
        memset(&spec[i], 0, sizeof(spec[i]));
        OK(ForestMapPoint(forest, BoxRandom(t->num_leaves), xi, spec[i].X));
      }
      OK(ProbesCreate(&scene, forest, &probes));
      for (PetscInt i = 0; i < NUM; ++i) {
        PetscInt  root, leaf = 0;
        PetscReal xi[3], X[3], in_leaf[3];
        OK(ProbesGetPlace(probes, i, &root, xi));
        while (t->leaf_root[leaf] != root) ++leaf;
        /* the geometry of a leaf extends over its whole coarse cell */
        for (PetscInt d = 0; d < dim; ++d)
          in_leaf[d] = (xi[d] * FOREST_ONE - t->leaf_lo[3 * leaf + d]) / (PetscReal)(FOREST_ONE >> t->leaf_level[3 * leaf + d]);
        OK(ForestMapPoint(forest, leaf, in_leaf, X));
        for (PetscInt d = 0; d < dim; ++d) {
          assert_near(X[d], spec[i].X[d], 1e-12);
          assert_true(xi[d] >= 0 && xi[d] <= 1);
        }
      }
      OK(ProbesDestroy(&probes));
      OK(ForestDestroy(&forest));
    }
  }
}

/* Side by side with the border: 1e-9 outside is the border, 0.2 outside is nowhere. */
static void Outside(void **state)
{
  const PetscInt n[3]  = {2, 2, 1};
  ProbeSpec      spec  = {.name = "tip", .X = {2 + 1e-9, 0.5, 0}};
  SceneData      scene = {.num_probes = 1, .probes = &spec};
  Box            box;
  Forest         forest = BoxForest(PETSC_COMM_WORLD, 2, n, 2, 0, 5, &box);
  Probes         probes;
  PetscInt       root;
  PetscReal      xi[3];

  OK(ProbesCreate(&scene, forest, &probes));
  OK(ProbesGetPlace(probes, 0, &root, xi));
  for (PetscInt d = 0; d < 2; ++d) assert_true(xi[d] >= 0 && xi[d] <= 1);
  OK(ProbesDestroy(&probes));
  spec.X[0] = 2.2;
  OK(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  assert_int_equal(ProbesCreate(&scene, forest, &probes), MORTISE_ERR_INPUT);
  OK(PetscPopErrorHandler());
  OK(ForestDestroy(&forest));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LocatesAgain), cmocka_unit_test(Outside)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
