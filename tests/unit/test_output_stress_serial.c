/* Stress fields: extension from Gauss points to nodes reproduces polynomials; Cauchy stress from the first Piola stress. */
#include "output.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"

/* Degree `degree` in each direction, all mixed terms. */
static PetscReal Polynomial(PetscInt dim, PetscInt degree, const PetscReal x[])
{
  PetscReal product = 1;

  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal sum = 0;
    for (PetscInt k = 0; k <= degree; ++k) sum += PetscPowRealInt(x[d] - 0.3, (int)k) * (PetscReal)(k + d + 1);
    product *= sum;
  }
  return product;
}

static void Place(PetscInt dim, PetscInt n, const PetscReal line[], PetscInt i, PetscReal x[3])
{
  const PetscInt at[3] = {i % n, i / n % n, i / (n * n)};
  for (PetscInt d = 0; d < dim; ++d) x[d] = line[at[d]];
}

static void ExtensionIsExact(void **state)
{
  static PetscReal samples[512 * 2], nodal[729 * 2], work[729 * 2];

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; ++p) {
      const Basis1D *basis;
      PetscReal      x[3];
      assert_int_equal(Basis1DGet(p, p, &basis), 0);
      for (PetscInt i = 0; i < ElementNumNodes(dim, p - 1); ++i) {
        Place(dim, p, basis->points, i, x);
        samples[2 * i]     = Polynomial(dim, p - 1, x);
        samples[2 * i + 1] = 1;
      }
      for (PetscInt n = 1; n <= MORTISE_MAX_ORDER; ++n) {
        PetscReal nodes[MORTISE_MAX_ORDER + 1];
        for (PetscInt k = 0; k <= n; ++k) nodes[k] = (PetscReal)k / n;
        assert_int_equal(OutputExtend(dim, p, n, 2, samples, nodal, work), 0);
        for (PetscInt i = 0; i < ElementNumNodes(dim, n); ++i) {
          Place(dim, n + 1, nodes, i, x);
          assert_near(nodal[2 * i], Polynomial(dim, p - 1, x), 1e-10 * PetscMax(1, PetscAbsReal(Polynomial(dim, p - 1, x))));
          assert_near(nodal[2 * i + 1], 1, 1e-11);
        }
      }
    }
  }
}

/* O-01: NHc(1,2) at F1; sigma = P F^T / J is symmetric, and its invariant parts are those of the closed form mu/J (b - 1) + lambda/J ln J. */
static void CauchyOfNeoHooke(void **state)
{
  const PetscReal F[9] = {1.2, .15, -.1, .05, .9, .2, -.08, .12, 1.05}, J = Det3(F);
  PetscReal       P[9], sigma[6], b[9], j;

  for (PetscInt i = 0; i < 9; ++i) b[i] = Dot3(F + 3 * (i / 3), F + 3 * (i % 3));
  /* P = tau F^-T with tau = mu (b - 1) + lambda ln J: solve P F^T = tau by Cramer's rule, row by row */
  for (PetscInt r = 0; r < 3; ++r) {
    for (PetscInt c = 0; c < 3; ++c) {
      PetscReal m[9];
      for (PetscInt i = 0; i < 9; ++i) m[i] = i % 3 == c ? b[3 * r + i / 3] - (r == i / 3) + 2 * PetscLogReal(J) * (r == i / 3) : F[i];
      P[3 * r + c] = Det3(m) / J;
    }
  }
  assert_near(P[0], 0.4943538338, 1e-9);
  assert_near(P[1], 0.2024829125, 1e-9);
  OutputCauchy(KINEMATICS_FINITE, F, P, sigma, &j);
  assert_near(j, 1.087125, 1e-14);
  assert_near(sigma[0], (b[0] - 1 + 2 * PetscLogReal(J)) / J, 1e-13);
  assert_near(sigma[1], b[1] / J, 1e-13);
  assert_near(sigma[2], b[2] / J, 1e-13);
  assert_near(sigma[3], (b[4] - 1 + 2 * PetscLogReal(J)) / J, 1e-13);
  assert_near(sigma[4], b[5] / J, 1e-13);
  assert_near(sigma[5], (b[8] - 1 + 2 * PetscLogReal(J)) / J, 1e-13);
  OutputCauchy(KINEMATICS_SMALL, F, P, sigma, &j);
  assert_near(sigma[1], P[1], 0);
  assert_near(j, 1.15, 1e-14);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(ExtensionIsExact), cmocka_unit_test(CauchyOfNeoHooke)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
