/* The largest indicators over several states of one mesh: each relative to its state, with what that state tells of the leaf; as numbers and back. */
#include "estimate.h"
#include "forest_box.h"
#include "near.h"

enum { LEAVES = 3 };

static void Same(const Estimate *a, const Estimate *b)
{
  for (PetscInt l = 0; l < LEAVES; ++l) {
    assert_true(a->eta2[l] == b->eta2[l]);
    assert_memory_equal(a->along[l], b->along[l], sizeof(a->along[l]));
    if (!a->decay) continue;
    assert_true(a->decay[l] == b->decay[l]);
    assert_int_equal(a->order[l], b->order[l]);
    assert_int_equal(a->lowest[l], b->lowest[l]);
    assert_int_equal(a->irregular[l], b->irregular[l]);
  }
  assert_int_equal(!a->decay, !b->decay);
}

/* The second state has ten times the energy of the first: its second leaf matters more although its indicator is smaller. */
static void Largest(void **unused)
{
  for (PetscInt orders = 0; orders < 2; ++orders) {
    PetscReal eta2[2][LEAVES] = {{1, 4, 0}, {20, 30, 0}}, along[2][LEAVES][3] = {{{1, 0, 0}, {3, 1, 0}, {0, 0, 0}}, {{0, 20, 0}, {0, 30, 0}, {0, 0, 0}}};
    PetscReal decay[2][LEAVES] = {{.1, .2, .3}, {.4, .5, .6}}, *values;
    int8_t    order[LEAVES] = {2, 3, 4}, lowest[LEAVES] = {1, 2, 2}, irregular[2][LEAVES] = {{1, 2, 4}, {2, 4, 1}};
    Estimate  e[2], most = {0}, again;
    PetscInt  num;

    for (PetscInt i = 0; i < 2; ++i) {
      e[i] = (Estimate){.num_leaves = LEAVES, .eta2 = eta2[i], .along = along[i], .total = i ? PetscSqrtReal(50) : PetscSqrtReal(5), .relative = i ? .4 : .6};
      e[i].norm = PetscSqrtReal((i ? 100 : 10) - PetscSqr(e[i].total));
      if (!orders) continue;
      e[i].decay     = decay[i];
      e[i].irregular = irregular[i];
      e[i].order     = order;
      e[i].lowest    = lowest;
    }
    OK(EstimateLargest(&(Estimate){.num_leaves = LEAVES, .eta2 = (PetscReal[LEAVES]){0}}, &most)); /* nothing moved yet */
    assert_int_equal(most.num_leaves, 0);
    for (PetscInt i = 0; i < 2; ++i) OK(EstimateLargest(&e[i], &most));
    assert_near(most.eta2[0], 0.2, 1e-14);
    assert_near(most.eta2[1], 0.4, 1e-14);
    assert_true(most.eta2[2] == 0 && most.relative == .6);
    assert_near(most.along[0][1], 0.2, 1e-14);
    assert_near(most.along[1][0], 0.3, 1e-14);
    if (orders) {
      assert_true(most.decay[0] == .4 && most.decay[1] == .2);
      assert_true(most.irregular[0] == 2 && most.irregular[1] == 2 && most.order[2] == 4 && most.lowest[2] == 2);
    }
    OK(EstimateStore(&most, &num, &values));
    OK(EstimateLoad(LEAVES, num, values, &again));
    Same(&most, &again);
    OK(PetscFree(values));
    OK(EstimateDestroy(&again));
    OK(EstimateDestroy(&most));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Largest)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
