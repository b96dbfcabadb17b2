/* Contact surfaces after splits in random sets of directions, several levels deep: nodes that hang on hanging nodes follow their masters, and the contact patch
   is solved exactly on either choice of multipliers; with -slow one split deeper. */
#include "estimate.h"
#include "share.h"
#include "solidpatch.h"

static PetscInt deep; /* hanging nodes with more than two masters: they hang on hanging ones */

static void Split(Forest *forest, PetscInt times)
{
  for (PetscInt k = 0; k < times; ++k) {
    const ForestTables *t;
    MarkList            marks;
    t = ForestGetTables(*forest);
    OK(PetscCalloc1(t->num_leaves, &marks.split));
    OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
    for (PetscInt l = 0; l < t->num_leaves; ++l) marks.split[l] = (int8_t)(BoxRandom(3) ? 0 : 1 + BoxRandom(7));
    AdaptBy(forest, &marks);
  }
}

/* Masters of hanging nodes do not hang, and their mean is the node's place. */
static void Follow(const SurfaceView *s)
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal X[3] = {0, 0, 0}, sum = 0;
    if (s->hang[n] == s->hang[n + 1]) continue;
    deep += s->hang[n + 1] - s->hang[n] > 2;
    for (PetscInt k = s->hang[n]; k < s->hang[n + 1]; ++k) {
      const PetscInt m = s->hang_master[k];
      assert_int_equal(s->hang[m], s->hang[m + 1]);
      sum += s->hang_weight[k];
      for (PetscInt c = 0; c < 3; ++c) X[c] += s->hang_weight[k] * s->X[3 * m + c];
    }
    assert_near(sum, 1, 1e-15);
    for (PetscInt c = 0; c < 3; ++c) assert_near(X[c], s->X[3 * n + c], 1e-14);
  }
}

static void Surfaces(void **state)
{
  deep = 0;
  for (PetscInt seed = 0; seed < 12; ++seed) {
    if (!Share(seed, 4)) continue;
    box_random_state = 88172645463325252ULL + 97 * (uint64_t)seed;
    Patch              p;
    const ContactView *view;
    PatchScene(&p, 1, KINEMATICS_FINITE, PETSC_FALSE, "0");
    p.forest = PatchForest(2, 3);
    Split(&p.forest, 4);
    PatchStart(&p);
    view = InterfaceGetContact(ProblemInterface(p.problem), 0);
    Follow(&view->nonmortar);
    Follow(&view->mortar);
    PatchDestroy(&p);
  }
  assert_true(deep > (Whole() ? 10 : 2));
}

static void PatchTest(void **state)
{
  for (PetscInt kind = 0; kind < 4; ++kind) {
    if (!Share(kind + kind / 2, 2)) continue;
    Patch              p;
    Estimate           e;
    const ContactView *view;
    box_random_state = 88172645463325252ULL + (uint64_t)kind;
    PatchScene(&p, 1 + kind % 2, KINEMATICS_FINITE, (PetscBool)(kind > 1), "-0.1");
    p.forest = PatchForest(2, 3);
    Split(&p.forest, share_all ? 4 : 3);
    PatchStart(&p);
    view = InterfaceGetContact(ProblemInterface(p.problem), 0);
    assert_true(PatchHanging(&view->nonmortar) > 0 && PatchHanging(&view->mortar) > 0);
    PatchSolve(p.problem, &p.state);
    OK(EstimateCompute(p.problem, &p.state, &e));
    assert_true(e.norm > 0.05);
    if (!(e.total < 1e-7 * e.norm))
      fail_msg("kind %d: %g of %g", (int)kind, (double)e.total, (double)e.norm); /* z g of a gap of round-off: the root of 1e-16 */
    OK(EstimateDestroy(&e));
    PatchDestroy(&p);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Surfaces), cmocka_unit_test(PatchTest)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
