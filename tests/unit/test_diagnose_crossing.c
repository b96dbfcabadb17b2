/* Points that go through pieces of surfaces, both on straight ways: against signs of the height along the way, and whether what is found lies on the piece. */
#include "../../src/diagnose/diagnoseimpl.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"

#define SAMPLES 4001

static unsigned long seed = 7;

static PetscReal Random(void)
{
  seed = seed * 6364136223846793005ul + 1442695040888963407ul;
  return (PetscReal)(seed >> 11) / 9007199254740992. * 2 - 1;
}

static void At(PetscInt num, const PetscReal a[], const PetscReal b[], PetscReal s, PetscReal x[])
{
  for (PetscInt i = 0; i < num; ++i) x[i] = (1 - s) * a[i] + s * b[i];
}

/* Height of the point over the piece (in the plane: of a point over a segment), and whether it lies above or below it and not beside; margin: of its size. */
static PetscReal Height(PetscInt dim, const PetscReal x[2][9], const PetscReal y[2][3], PetscReal s, PetscReal margin, PetscBool *on)
{
  PetscReal c[9], p[3], N[3], edge[3], to[3], turn[3], least = PETSC_MAX_REAL;

  At(9, x[0], x[1], s, c);
  At(3, y[0], y[1], s, p);
  MovingNormal_Private(dim, x, s, N);
  for (PetscInt a = 0; a < dim; ++a) {
    const PetscReal *from = c + 3 * a, *end = c + 3 * ((a + 1) % dim);
    for (PetscInt k = 0; k < 3; ++k) edge[k] = end[k] - from[k], to[k] = p[k] - from[k];
    Cross3(edge, to, turn);
    least = PetscMin(least, dim == 2 ? Dot3(edge, to) / Dot3(edge, edge) : Dot3(turn, N));
  }
  *on = (PetscBool)(least > margin);
  for (PetscInt k = 0; k < 3; ++k) to[k] = p[k] - c[k];
  return Dot3(to, N);
}

static void Ways(void **state)
{
  PetscInt all = 0, twice = 0;

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt trial = 0; trial < 300; ++trial) {
      PetscReal x[2][9] = {{0}}, y[2][3] = {{0}}, N[3];
      Crossing  crossing[3];
      PetscBool on;
      PetscInt  seen = 0;
      for (PetscInt k = 0; k < 2; ++k) {
        for (PetscInt i = 0; i < 3 * dim; ++i) x[k][i] = i % 3 < dim ? Random() : 0;
        for (PetscInt i = 0; i < dim; ++i) y[k][i] = 0.5 * Random();
      }
      const PetscInt num = CrossingsFind_Private(dim, x, y, crossing);
      for (PetscInt i = 0; i < num; ++i) { /* each is one */
        assert_true(crossing[i].s > -1 && crossing[i].s < 1 && (i == 0 || crossing[i].s > crossing[i - 1].s));
        assert_near(Height(dim, x, y, crossing[i].s, -1e-6, &on), 0, 1e-9);
        assert_true(on);
        MovingNormal_Private(dim, x, crossing[i].s, N);
        assert_near(Dot3(N, crossing[i].N), 1, 1e-12);
      }
      for (PetscInt k = 1; k < SAMPLES; ++k) { /* and there are no others */
        const PetscReal s0 = -1 + 2. * (PetscReal)(k - 1) / (SAMPLES - 1), s1 = -1 + 2. * (PetscReal)k / (SAMPLES - 1);
        PetscBool       on0, on1, found = PETSC_FALSE;
        const PetscReal h0 = Height(dim, x, y, s0, 1e-2, &on0), h1 = Height(dim, x, y, s1, 1e-2, &on1);
        if (!on0 || !on1 || h0 * h1 >= 0 || PetscAbsReal(h0 - h1) > 0.1) continue; /* its normal does not turn round there */
        for (PetscInt i = 0; i < num; ++i) found = (PetscBool)(found || (crossing[i].s >= s0 && crossing[i].s <= s1 && crossing[i].out == (h0 < 0)));
        assert_true(found);
        ++seen;
      }
      all += seen;
      twice += seen > 1;
    }
  }
  assert_true(all > 100 && twice > 10);
}

/* A point that touches a piece from above, to round-off, and goes down: into it at the start. */
static void Touch(void **state)
{
  const PetscReal edge[2][9] = {{1, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 0, 0}}, triangle[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}};

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt i = -1; i <= 1; ++i) {
      PetscReal y[2][3] = {{0.25, dim == 2 ? 1e-16 * i : 0.25, dim == 2 ? 0 : 1e-16 * i}, {0.25, 0.25, 0}};
      Crossing  crossing[3];
      y[1][dim - 1] = -1;
      assert_int_equal(CrossingsFind_Private(dim, dim == 2 ? edge : triangle, y, crossing), 1);
      assert_true(!crossing[0].out && PetscAbsReal(crossing[0].s) < 1e-15);
      assert_near(crossing[0].N[dim - 1], 1, 1e-15);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Ways), cmocka_unit_test(Touch)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
