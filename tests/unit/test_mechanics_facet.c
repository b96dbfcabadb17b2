/* Loads on facets: totals, moments, closed surfaces under follower pressure, tangents by differences, axisymmetric weights. */
#include "mechanicsimpl.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"

#define OK(call) assert_int_equal(call, 0)
#define MOST (3 * 81)

static uint64_t seed = 99;

static PetscReal Random(void)
{
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (PetscReal)(seed >> 11) / 9007199254740992. - 0.5;
}

/* Nodes of the unit cell's side, in the order of the remaining directions, at x = position(X). */
static PetscInt SideNodes(PetscInt dim, PetscInt order, PetscInt side, PetscInt nodes[])
{
  const PetscInt n1  = order + 1;
  PetscInt       num = 0;

  for (PetscInt i = 0; i < ElementNumNodes(dim, order); i++) {
    const PetscInt index[3] = {i % n1, i / n1 % n1, i / (n1 * n1)};

    if (index[side / 2] == (side % 2 ? order : 0)) nodes[num++] = i;
  }
  return num;
}

static void UnitCell(PetscInt dim, PetscInt order, PetscReal *X)
{
  const PetscReal *x;
  const PetscInt   n1 = order + 1;

  OK(ElementGetNodes(order, &x));
  for (PetscInt i = 0; i < ElementNumNodes(dim, order); i++) {
    X[i * dim]     = x[i % n1];
    X[i * dim + 1] = x[i / n1 % n1];
    if (dim == 3) X[i * dim + 2] = x[i / (n1 * n1)];
  }
}

/* Outward sign of the tangent order's normal. */
static PetscInt Outward(PetscInt side)
{
  return (side / 2 == 1 ? -1 : 1) * (side % 2 ? 1 : -1);
}

/* A parallelogram facet in space: area, normal, total force and moment of a linear traction, 1e-13. */
static void DeadTractionHasItsTotal(void **state)
{
  const PetscReal a[3] = {1, 0.2, 0.1}, b[3] = {-0.3, 0.8, 0.4}, n[3] = {0.2 * 0.4 - 0.1 * 0.8, 0.1 * -0.3 - 1 * 0.4, 1 * 0.8 - 0.2 * -0.3},
                  area = PetscSqrtReal(Dot3(n, n));

  for (PetscInt order = 1; order <= 4; order++) {
    const PetscInt   num = ElementNumNodes(2, order), np = FacetNumPoints(3, order), n1 = order + 1;
    const PetscReal *x;
    PetscReal        X[MOST], position[3 * 100], dA[100], normal[3 * 100], traction[3 * 100], r[MOST], total[3] = {0}, first[3] = {0}, sum = 0;

    OK(ElementGetNodes(order, &x));
    for (PetscInt i = 0; i < num * 3; i++) X[i] = 2 + x[i / 3 % n1] * a[i % 3] + x[i / 3 / n1] * b[i % 3];
    OK(FacetQuadrature(3, MODEL_3D, order, X, position, dA, normal));
    for (PetscInt q = 0; q < np; q++) {
      sum += dA[q];
      for (int c = 0; c < 3; c++) {
        assert_near(normal[3 * q + c], n[c] / area, 1e-14);
        traction[3 * q + c] = (c + 1) * (position[3 * q] + 0.5);
      }
    }
    assert_near(sum, area, 1e-14);
    OK(FacetTraction(3, MODEL_3D, order, X, traction, r));
    for (PetscInt i = 0; i < num * 3; i++) {
      total[i % 3] -= r[i];
      first[i % 3] -= r[i] * X[i / 3 * 3]; /* first moment about x = 0 */
    }
    /* mean of x is xm; int x^2 over the parallelogram = area (xm^2 + (a_x^2 + b_x^2)/12) */
    const PetscReal xm = 2 + (a[0] + b[0]) / 2, x2 = xm * xm + (a[0] * a[0] + b[0] * b[0]) / 12;
    for (int c = 0; c < 3; c++) {
      assert_near(total[c], (c + 1) * area * (xm + 0.5), 1e-13);
      assert_near(first[c], (c + 1) * area * (x2 + 0.5 * xm), 1e-13);
    }
  }
}

/* Constant pressure on all sides of a deformed cell: no total force, and int x . n da = dim * volume (det F here): 1e-13. */
static void ClosedSurfaceIsBalanced(void **state)
{
  for (PetscInt dim = 2; dim <= 3; dim++) {
    for (PetscInt order = 1; order <= 3; order++) {
      PetscReal X[3 * 64], F[9], total[3] = {0}, work = 0, pressure[100];
      PetscInt  nodes[64];

      UnitCell(dim, order, X);
      for (int c = 0; c < 9; c++) F[c] = (c % 4 == 0) + 0.4 * Random();
      if (dim == 2) F[2] = F[5] = F[6] = F[7] = 0, F[8] = 1;
      for (PetscInt i = 0; i < 100; i++) pressure[i] = 1.7;
      for (PetscInt pass = 0; pass < 2; pass++) { /* affine with a known volume, then bent at random */
        PetscReal x[3 * 64];

        for (PetscInt i = 0; i < ElementNumNodes(dim, order) * dim; i++) {
          x[i] = pass * 0.1 * Random();
          for (PetscInt J = 0; J < dim; J++) x[i] += F[3 * (i % dim) + J] * X[i / dim * dim + J];
        }
        PetscArrayzero(total, 3);
        work = 0;
        for (PetscInt side = 0; side < 2 * dim; side++) {
          const PetscInt num = SideNodes(dim, order, side, nodes);
          PetscReal      trace[MOST], r[MOST];

          for (PetscInt i = 0; i < num * dim; i++) trace[i] = x[nodes[i / dim] * dim + i % dim];
          OK(FacetPressure(dim, dim == 3 ? MODEL_3D : MODEL_PLANE_STRAIN, order, trace, Outward(side), pressure, r, NULL));
          for (PetscInt i = 0; i < num * dim; i++) {
            total[i % dim] += r[i];
            work += r[i] * trace[i];
          }
        }
        for (int c = 0; c < 3; c++) assert_near(total[c], 0, 1e-13);
        if (pass == 0) assert_near(work, 1.7 * dim * Det3(F), 1e-13);
      }
    }
  }
}

/* Against central differences (exact: the residual is at most cubic) 1e-9, every model and order. */
static void FollowerTangentIsExact(void **state)
{
  for (int model = 0; model < 3; model++) {
    const PetscInt dim = model == MODEL_3D ? 3 : 2;

    for (PetscInt order = 1; order <= 4; order++) {
      const PetscInt   num = ElementNumNodes(dim - 1, order), size = num * dim, n1 = order + 1;
      const PetscReal *nodes, h = 1e-3;
      PetscReal        x[MOST], pressure[100], K[75 * 75], r[75], rs[4][75];

      OK(ElementGetNodes(order, &nodes));
      for (PetscInt i = 0; i < size; i++) x[i] = 1 + 0.2 * Random() + (i % dim == 0 ? nodes[i / dim % n1] : i % dim == 1 && dim == 3 ? nodes[i / dim / n1] : 0);
      for (PetscInt i = 0; i < 100; i++) pressure[i] = 1 + Random();
      OK(FacetPressure(dim, (Model)model, order, x, -1, pressure, r, K));
      for (PetscInt j = 0; j < size; j++) {
        const PetscReal keep = x[j];

        for (int s = 0; s < 4; s++) {
          x[j] = keep + h * (s < 2 ? s - 2 : s - 1);
          OK(FacetPressure(dim, (Model)model, order, x, -1, pressure, rs[s], NULL));
        }
        x[j] = keep;
        for (PetscInt i = 0; i < size; i++) assert_near(K[i * size + j], (rs[0][i] - 8 * rs[1][i] + 8 * rs[2][i] - rs[3][i]) / (12 * h), 1e-11);
      }
    }
  }
}

/* Full revolution: a cylinder of radius 2 and height 3 under pressure 1.5 has the radial total 2 pi R h p, a disc of radius 2 the axial total pi R^2 p. */
static void AxisymmetricWeights(void **state)
{
  for (PetscInt order = 1; order <= 4; order++) {
    const PetscReal *nodes;
    PetscReal        X[20], Y[20], pressure[10], r[20], traction[30] = {0}, dA[10], radial = 0, axial = 0, dead = 0, area = 0;

    OK(ElementGetNodes(order, &nodes));
    for (PetscInt i = 0; i <= order; i++) {
      X[2 * i]     = 2;
      X[2 * i + 1] = 3 * nodes[i];
      Y[2 * i]     = 2 * nodes[i];
      Y[2 * i + 1] = 1;
    }
    for (PetscInt i = 0; i < 10; i++) pressure[i] = 1.5, traction[3 * i + 1] = 0.5;
    OK(FacetPressure(2, MODEL_AXISYMMETRIC, order, X, Outward(1), pressure, r, NULL));
    for (PetscInt i = 0; i <= order; i++) radial += r[2 * i];
    OK(FacetPressure(2, MODEL_AXISYMMETRIC, order, Y, Outward(3), pressure, r, NULL));
    for (PetscInt i = 0; i <= order; i++) axial += r[2 * i + 1];
    OK(FacetTraction(2, MODEL_AXISYMMETRIC, order, Y, traction, r));
    for (PetscInt i = 0; i <= order; i++) dead -= r[2 * i + 1];
    OK(FacetQuadrature(2, MODEL_AXISYMMETRIC, order, Y, NULL, dA, NULL));
    for (PetscInt q = 0; q < FacetNumPoints(2, order); q++) area += dA[q];
    assert_near(radial, 2 * PETSC_PI * 2 * 3 * 1.5, 1e-12);
    assert_near(axial, PETSC_PI * 4 * 1.5, 1e-12);
    assert_near(dead, PETSC_PI * 4 * 0.5, 1e-12);
    assert_near(area, PETSC_PI * 4, 1e-12);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(DeadTractionHasItsTotal), cmocka_unit_test(ClosedSurfaceIsBalanced),
                                     cmocka_unit_test(FollowerTangentIsExact), cmocka_unit_test(AxisymmetricWeights)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
