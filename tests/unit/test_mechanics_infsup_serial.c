/* O-15: numerical inf-sup constants of the pairs Q_k / P_(k-1). beta^2 is the least nonzero eigenvalue of M^-1 B K^-1 B^T, K the norm |grad u|^2, M the
   pressures' mass, B the coupling that the condensed tangent of the program contains. Unit square and cube, u = 0 all round or on the bottom alone; the faces
   of the top may be linear as those of contact are. k >= 2 is stable: u = 0 all round leaves constants as the only kernel, a free surface none, and beta
   changes by less than 10 % at each doubling, on uniform, 1-irregular and graded meshes, in the plane and in space. Q1/P0 is not. In the plane: one
   checkerboard, and what remains falls like h. In space worse: n cells in each direction and u = 0 all round leave (-1)^(i+j) a(k) and its like in the other
   directions, 3n - 2 of them, and what remains falls faster than h, towards h^2: a modulated (-1)^(i+j+k) is felt through its mixed second differences only. A
   refined island adds one kernel, a free surface or not. A test that did not see that would see nothing. */
#include "infsupfixture.h"

static void StableInPlane(void **state)
{
  for (PetscInt order = 2; order <= 4; ++order) {
    InfSup uniform[4], irregular[3], graded[4];
    for (PetscInt i = 0, n = 2; i < (order < 4 ? 4 : 3); ++i, n *= 2) {
      uniform[i] = Measure(Unit(2, n), order, CLAMPED, "uniform", n);
      CheckStable(CLAMPED, order, 1, i ? &uniform[i - 1] : NULL, &uniform[i]);
    }
    for (PetscInt i = 0, n = 2; i < 3; ++i, n *= 2) {
      irregular[i] = Measure(Refined(2, n, Orthant, 1), order, CLAMPED, "1-irregular", n);
      CheckStable(CLAMPED, order, 1, i ? &irregular[i - 1] : NULL, &irregular[i]);
    }
    for (PetscInt i = 0; i < 4; ++i) {
      graded[i] = Measure(Refined(2, 4, Corner, 2 * (i + 1)), order, CLAMPED, "graded", 2 * (i + 1));
      CheckStable(CLAMPED, order, 1, i ? &graded[i - 1] : NULL, &graded[i]);
    }
  }
}

/* The figures are those of an independent computation with n = 8. */
static void StableInPlaneStanding(void **state)
{
  const PetscReal figure[] = {0.66, 0.70, 0.71};

  for (Support support = STANDING; support <= LINEAR; ++support) {
    for (PetscInt order = 2; order <= 4; ++order) {
      const InfSup coarse = Measure(Unit(2, 4), order, support, "uniform", 4), fine = Measure(Unit(2, 8), order, support, "uniform", 8);
      CheckStable(support, order, 1, &coarse, &fine);
      CheckFigure(fine.beta, figure[order - 2], 0.005);
    }
  }
}

/* Orders 2 and 3 with 2, 3, 4 cells in each direction, order 4 with 2, 3. The figures, with 4, 3, 2 cells, are those of an independent computation. */
static void StableInSpace(void **state)
{
  const PetscReal figure[] = {0.609, 0.692, 0.732};

  for (PetscInt order = 2; order <= 4; ++order) {
    const PetscInt most = order < 4 ? 4 : 3, known = 6 - order;
    for (Support support = CLAMPED; support <= STANDING; ++support) {
      InfSup uniform[5];
      for (PetscInt n = 2; n <= most; ++n) uniform[n] = Measure(Unit(3, n), order, support, "uniform", n);
      CheckStable(support, order, PetscLog2Real((PetscReal)most / (most - 1)), &uniform[most - 1], &uniform[most]);
      if (support == STANDING) CheckFigure(uniform[known].beta, figure[order - 2], 0.001);
      const InfSup irregular = Measure(Refined(3, 2, Orthant, 1), order, support, "1-irregular", 2);
      CheckStable(support, order, 1, NULL, &irregular);
      const InfSup island = Measure(Refined(3, 3, Middle, 1), order, support, "island", 3);
      CheckStable(support, order, 1, &uniform[3], &island);
    }
    const InfSup graded = Measure(Refined(3, 2, Corner, 2), order, CLAMPED, "graded", 2);
    CheckStable(CLAMPED, order, 1, NULL, &graded);
    const InfSup linear = Measure(Unit(3, known), order, LINEAR, "uniform", known);
    CheckStable(LINEAR, order, 1, NULL, &linear);
    CheckFigure(linear.beta, figure[order - 2], 0.001); /* linear faces on one side leave it as it is */
  }
}

/* Constants and the checkerboard if clamped; half at each doubling in the end. */
static void LowestOrderInPlane(void **state)
{
  const PetscReal figure[2][3] = {{0.37, 0.22, 0.11}, {0.43, 0.25, 0.13}};

  for (Support support = CLAMPED; support <= STANDING; ++support) {
    InfSup last = {0};
    for (PetscInt i = 0, n = 4; i < 3; ++i, n *= 2) {
      const InfSup now = Measure(Unit(2, n), 1, support, "uniform", n);
      assert_int_equal(now.kernel, support == CLAMPED ? 2 : 0);
      CheckFigure(now.beta, figure[support][i], 0.006);
      if (n == 16) assert_true(now.beta / last.beta > 0.4 && now.beta / last.beta < 0.6);
      last = now;
    }
  }
}

/* A quarter at each doubling in the end. */
static void LowestOrderInSpace(void **state)
{
  for (Support support = CLAMPED; support <= STANDING; ++support) {
    InfSup now[9];
    for (PetscInt n = 2; n <= 8; ++n) {
      now[n] = Measure(Unit(3, n), 1, support, "uniform", n);
      assert_int_equal(now[n].kernel, support == CLAMPED ? 3 * n - 1 : 0);
    }
    assert_true(now[8].beta / now[4].beta > 0.25 && now[8].beta / now[4].beta < 0.35);
    assert_true(now[8].beta / now[4].beta < now[6].beta / now[3].beta);
  }
}

static void LowestOrderIsland(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (Support support = CLAMPED; support <= STANDING; ++support) {
      const InfSup uniform = Measure(Unit(dim, 5), 1, support, "uniform", 5), island = Measure(Refined(dim, 5, Middle, 1), 1, support, "island", 5);
      assert_int_equal(island.kernel, uniform.kernel + 1);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LowestOrderInPlane), cmocka_unit_test(LowestOrderInSpace),    cmocka_unit_test(LowestOrderIsland),
                                     cmocka_unit_test(StableInPlane),      cmocka_unit_test(StableInPlaneStanding), cmocka_unit_test(StableInSpace)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
