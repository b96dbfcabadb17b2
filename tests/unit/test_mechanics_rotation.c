/* Rotations that take points nearest to others, in the plane and in space. */
#include "mechanics.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define POINTS 5

static const PetscReal X[POINTS][3] = {{1, 0.2, -0.3}, {-0.4, 0.9, 0.1}, {0.3, -0.7, 0.8}, {-1.1, 0.1, 0.5}, {0.2, 0.6, -1}};

/* Products of points about their centroid with those turned by phi and stretched. */
static void Products(PetscInt dim, const PetscReal phi[3], PetscReal stretch, PetscReal S[9])
{
  PetscReal R[9], mean[3] = {0};

  RotationMatrix(phi, R);
  for (PetscInt k = 0; k < POINTS; ++k)
    for (PetscInt c = 0; c < dim; ++c) mean[c] += X[k][c] / POINTS;
  for (PetscInt i = 0; i < 9; ++i) S[i] = 0;
  for (PetscInt k = 0; k < POINTS; ++k) {
    PetscReal a[3] = {0}, b[3];
    for (PetscInt c = 0; c < dim; ++c) a[c] = X[k][c] - mean[c];
    for (PetscInt c = 0; c < 3; ++c) b[c] = stretch * Dot3(R + 3 * c, a);
    for (PetscInt i = 0; i < 9; ++i) S[i] += a[i / 3] * b[i % 3];
  }
}

static void found(void **state)
{
  static const PetscReal phi[5][3] = {{0, 0, 0.1}, {0, 0, -2.9}, {0.3, -0.2, 0.5}, {-1.9, 1.2, 0.4}, {0, 0, 0}};

  for (PetscInt i = 0; i < 5; ++i)
    for (PetscInt dim = i < 2 ? 2 : 3; dim <= 3; ++dim) {
      PetscReal S[9], q[4], sign, angle = PetscSqrtReal(Dot3(phi[i], phi[i]));
      PetscBool unique;
      Products(dim, phi[i], 1.3, S);
      assert_int_equal(RotationNearest(dim, S, q, &unique), 0);
      assert_true(unique);
      sign = q[0] < 0 ? -1 : 1; /* q and -q are one rotation */
      assert_true(PetscAbsReal(sign * q[0] - PetscCosReal(angle / 2)) < 1e-14);
      for (PetscInt c = 0; c < 3; ++c) assert_true(PetscAbsReal(sign * q[1 + c] - (angle > 0 ? PetscSinReal(angle / 2) * phi[i][c] / angle : 0)) < 1e-14);
    }
}

static void points_at_one_place_or_in_line(void **state)
{
  static const PetscReal none[9] = {0}, line[9] = {1};
  PetscReal              q[4];
  PetscBool              unique;

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    assert_int_equal(RotationNearest(dim, none, q, &unique), 0);
    assert_false(unique);
  }
  assert_int_equal(RotationNearest(3, line, q, &unique), 0);
  assert_false(unique);
  assert_int_equal(RotationNearest(2, line, q, &unique), 0);
  assert_true(unique && q[0] == 1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(found), cmocka_unit_test(points_at_one_place_or_in_line)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
