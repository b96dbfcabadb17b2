/* Contact along a continuous direction where the mortar side ends just at the side of a nonmortar facet: functions of a covered facet and hats weigh gaps
   differently. Which are taken follows from the positions, whatever was evaluated before. */
#include "rayfixture.h"

#define COVERED 1e-3 /* share of the facet beyond the mortar side: taken for covered */
#define UNCOVERED 1e-2
#define CENTRE 4 /* node in the middle of a facet of order 2, whose share of the area is 4/9; of its hat, 1/4 */

/* The mortar side ends at x = 1 - share. */
static void End(Patch *mortar, PetscReal share)
{
  for (PetscInt n = 0; n < mortar->s.num_nodes; n++) {
    const PetscReal *u = mortar->u + 2 * n;

    mortar->x[3 * n] = -0.5 + (1.5 - share) * u[0], mortar->x[3 * n + 1] = 3 * u[1] - 1, mortar->x[3 * n + 2] = 0.05;
  }
}

static PetscReal CentreWeight(ContactPair pair, const Patch *nonmortar, Patch *mortar, PetscReal share)
{
  PetscReal weight = 0;
  Sum       s;

  End(mortar, share);
  SearchAll(pair, nonmortar, mortar, 0.5, 1e-3); /* as in every iteration */
  SumCreate(&s, nonmortar, mortar);
  for (int again = 0; again < 2; again++) { /* the second is of the same state */
    SumEvaluate(&s, pair, nonmortar, mortar, NULL, PETSC_FALSE);
    assert_false(s.failed);
    assert_true(PetscAbsReal(s.area - (1 - share)) < 1e-12);
    for (PetscInt j = 0; j < s.nn; j++) assert_true(PetscAbsReal(s.gap[j] - 0.05 * s.weight[j]) < 1e-12);
    if (again) assert_true(s.weight[nonmortar->lattice[CENTRE]] == weight);
    weight = s.weight[nonmortar->lattice[CENTRE]];
  }
  SumDestroy(&s);
  return weight;
}

static void test_to_and_fro(void **state)
{
  const ContactSpec spec = {.friction = 0};
  Patch             nonmortar, mortar;
  PetscReal         first[2];
  ContactPair       pair;

  (void)state;
  PatchCreate(&nonmortar, 3, 2, 1, 0, 1, PETSC_TRUE, PETSC_FALSE);
  for (PetscInt n = 0; n < nonmortar.s.num_nodes; n++)
    for (int c = 0; c < 3; c++) nonmortar.x[3 * n + c] = nonmortar.X[3 * n + c] = c < 2 ? nonmortar.u[2 * n + c] : 0;
  PatchCreate(&mortar, 3, 1, 1, 0, 1, PETSC_FALSE, PETSC_FALSE);
  End(&mortar, 0);
  memcpy(mortar.X, mortar.x, sizeof(PetscReal) * 3 * (size_t)mortar.s.num_nodes);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  for (int k = 0; k < 6; k++) {
    const PetscReal covered = CentreWeight(pair, &nonmortar, &mortar, COVERED), uncovered = CentreWeight(pair, &nonmortar, &mortar, UNCOVERED);

    print_message("turn %d: weight in the middle %.4f covered, %.4f uncovered\n", k, (double)covered, (double)uncovered);
    assert_true(PetscAbsReal(uncovered - 0.25) < UNCOVERED);
    assert_true(PetscAbsReal(covered - 4. / 9) < 2 * COVERED);
    assert_true(k == 0 || (covered == first[0] && uncovered == first[1]));
    first[0] = covered, first[1] = uncovered;
  }
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_to_and_fro)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
