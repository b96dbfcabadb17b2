/* O-15 at orders 5 and 6, and where orders are mixed: neighbours of orders 2 to 6 share edges and faces of the lower one, linear contact faces included, and
   the pairs are still stable. beta changes by less than 10 % at each doubling and stays above 0.3. With -slow: orders 5 and 6 on more cells. */
#include "infsupfixture.h"

static PetscInt finest = 4; /* cells in each direction of the plane at orders 5 and 6, with -slow 8 */

static void HighInPlane(void **state)
{
  for (PetscInt order = 5; order <= 6; ++order) {
    InfSup last = {0};
    for (PetscInt n = 2; n <= finest; n *= 2) {
      const InfSup now = Measure(Unit(2, n), order, CLAMPED, "uniform", n);
      CheckStable(CLAMPED, order, 1, n > 2 ? &last : NULL, &now);
      last = now;
    }
    for (PetscInt n = 2; n <= 4; n *= 2) {
      const InfSup now = Measure(Refined(2, n, Orthant, 1), order, CLAMPED, "1-irregular", n);
      CheckStable(CLAMPED, order, 1, n > 2 ? &last : NULL, &now);
      last = now;
    }
    for (PetscInt times = 2; times <= 6; times += 2) {
      const InfSup now = Measure(Refined(2, 4, Corner, times), order, CLAMPED, "graded", times);
      CheckStable(CLAMPED, order, 1, times > 2 ? &last : NULL, &now);
      last = now;
    }
    for (Support support = STANDING; support <= LINEAR; ++support) {
      const InfSup coarse = Measure(Unit(2, finest / 2), order, support, "uniform", finest / 2);
      const InfSup fine   = Measure(Unit(2, finest), order, support, "uniform", finest);
      CheckStable(support, order, 1, &coarse, &fine);
    }
  }
}

static void HighInSpace(void **state)
{
  for (PetscInt order = 5; order <= 6; ++order) {
    for (Support support = CLAMPED; support <= LINEAR; ++support) {
      const InfSup now = Measure(Unit(3, 2), order, support, "uniform", 2);
      CheckStable(support, order, 1, NULL, &now);
    }
  }
  const InfSup irregular = Measure(Refined(3, 2, Orthant, 1), 5, CLAMPED, "1-irregular", 2);
  CheckStable(CLAMPED, 5, 1, NULL, &irregular);
}

/* Orders by the place of the cell's middle. RAMP: 2 to 6 along the first axis; STEP: 6 where x < 1/2, else 2; MIXED: any of 2 to 6. */
typedef enum { RAMP, STEP, MIXED } Grading;
static const char *const grading_names[] = {"ramp", "step", "mixed"};

static InfSup MeasureGraded(Forest forest, Grading grading, Support support, PetscInt n)
{
  const ForestTables *t;
  InfSup              result;
  int8_t             *orders;

  t = ForestGetTables(forest);
  OK(PetscMalloc1(t->num_leaves, &orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    PetscReal X[3];
    OK(ForestMapPoint(forest, l, (const PetscReal[3]){0.5, 0.5, 0.5}, X));
    orders[l] = (int8_t)(grading == RAMP ? 2 + (PetscInt)(5 * X[0]) : grading == STEP ? (X[0] < 0.5 ? 6 : 2) : 2 + BoxRandom(5));
  }
  result = MeasureOrders(forest, orders, 6, support, grading_names[grading], n);
  OK(PetscFree(orders));
  return result;
}

static void GradedInPlane(void **state)
{
  for (Support support = CLAMPED; support <= LINEAR; ++support) {
    for (Grading grading = RAMP; grading <= MIXED; ++grading) {
      const InfSup coarse = MeasureGraded(Unit(2, 4), grading, support, 4), fine = MeasureGraded(Unit(2, 8), grading, support, 8);
      CheckStable(support, 6, 1, &coarse, &fine);
      const InfSup irregular = MeasureGraded(Refined(2, 4, Orthant, 1), grading, support, 4),
                   corner    = MeasureGraded(Refined(2, 4, Corner, 4), grading, support, 4);
      CheckStable(support, 6, 1, NULL, &irregular);
      CheckStable(support, 6, 1, NULL, &corner);
    }
  }
}

static void GradedInSpace(void **state)
{
  for (Grading grading = RAMP; grading <= MIXED; ++grading) {
    for (Support support = CLAMPED; support <= LINEAR; support += 2) {
      const InfSup now = MeasureGraded(Unit(3, 2), grading, support, 2);
      CheckStable(support, 6, 1, NULL, &now);
    }
  }
  const InfSup irregular = MeasureGraded(Refined(3, 2, Orthant, 1), MIXED, CLAMPED, 2);
  CheckStable(CLAMPED, 6, 1, NULL, &irregular);
}

/* From 2 to 3 cells in each direction. */
static void HighInSpaceFiner(void **state)
{
  for (PetscInt order = 5; order <= 6; ++order) {
    for (Support support = CLAMPED; support <= (order == 5 ? STANDING : CLAMPED); ++support) {
      const InfSup coarse = Measure(Unit(3, 2), order, support, "uniform", 2), fine = Measure(Unit(3, 3), order, support, "uniform", 3);
      CheckStable(support, order, PetscLog2Real(1.5), &coarse, &fine);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(HighInPlane), cmocka_unit_test(GradedInPlane), cmocka_unit_test(GradedInSpace),
                                     cmocka_unit_test(HighInSpace)};
  const struct CMUnitTest slow[]  = {cmocka_unit_test(HighInPlane), cmocka_unit_test(HighInSpaceFiner)};
  PetscBool               is_slow;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &is_slow));
  if (is_slow) finest = 8;
  const int failed = is_slow ? cmocka_run_group_tests(slow, NULL, NULL) : cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
