/* Nodes, Kronecker property, exactness of values, derivatives, quadrature and Legendre polynomials. */
#include "element.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"

#define OK(call) assert_int_equal(call, 0)

static PetscReal Power(PetscReal x, PetscInt k)
{
  return k == 0 ? 1 : x * Power(x, k - 1);
}

static void NodesAreGaussLobatto(void **state)
{
  const PetscReal *x;

  OK(ElementGetNodes(1, &x));
  assert_true(x[0] == 0 && x[1] == 1);
  OK(ElementGetNodes(3, &x)); /* 1/2 -+ 1/(2 sqrt 5) */
  assert_near(x[1], 0.5 - 0.5 / PetscSqrtReal(5), 1e-15);
  OK(ElementGetNodes(4, &x)); /* 1/2 -+ sqrt(3/7)/2 */
  assert_near(x[1], 0.5 - 0.5 * PetscSqrtReal(3. / 7), 1e-15);
  assert_true(x[2] == 0.5);
  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++) {
    OK(ElementGetNodes(p, &x));
    assert_true(x[0] == 0 && x[p] == 1);
    for (PetscInt i = 0; i < p; i++) assert_true(x[i] < x[i + 1]);
    for (PetscInt i = 0; i <= p; i++) assert_near(x[i] + x[p - i], 1, 2e-16);
  }
}

static void KroneckerIsExact(void **state)
{
  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++) {
    const PetscReal *x;
    PetscReal        value[MORTISE_MAX_ORDER + 1];

    OK(ElementGetNodes(p, &x));
    for (PetscInt i = 0; i <= p; i++) {
      OK(ElementEvaluate1D(p, x[i], value, NULL));
      for (PetscInt j = 0; j <= p; j++) assert_true(value[j] == (i == j));
    }
  }
}

/* Interpolating x^k, k <= p, gives x^k and k x^(k-1) anywhere, inside or outside the cell: 1e-12. */
static void PolynomialsAreReproduced(void **state)
{
  const PetscReal where[] = {0, 0.123, 0.5, 0.77, 1, 1.1, -0.05};

  for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++) {
    const PetscReal *x;
    PetscReal        value[MORTISE_MAX_ORDER + 1], derivative[MORTISE_MAX_ORDER + 1];

    OK(ElementGetNodes(p, &x));
    for (size_t s = 0; s < PETSC_STATIC_ARRAY_LENGTH(where); s++) {
      OK(ElementEvaluate1D(p, where[s], value, derivative));
      for (PetscInt k = 0; k <= p; k++) {
        PetscReal f = 0, df = 0;

        for (PetscInt j = 0; j <= p; j++) {
          f += value[j] * Power(x[j], k);
          df += derivative[j] * Power(x[j], k);
        }
        assert_near(f, Power(where[s], k), 1e-12);
        assert_near(df, k == 0 ? 0 : k * Power(where[s], k - 1), 1e-11);
      }
    }
  }
}

/* n Gauss points integrate x^k exactly up to k = 2n-1. */
static void QuadratureIsExact(void **state)
{
  for (PetscInt n = 1; n <= MORTISE_MAX_ORDER + 4; n++) {
    const Basis1D *b;

    OK(Basis1DGet(2, n, &b));
    assert_int_equal(b->num_points, n);
    for (PetscInt k = 0; k <= 2 * n; k++) {
      PetscReal sum = 0;

      for (PetscInt q = 0; q < n; q++) sum += b->weights[q] * Power(b->points[q], k);
      if (k < 2 * n)
        assert_near(sum, 1. / (k + 1), 2e-15);
      else if (n <= 6)
        assert_true(PetscAbsReal(sum - 1. / (k + 1)) > 1e-9); /* and no further */
    }
  }
}

static void TableAgreesWithEvaluation(void **state)
{
  const Basis1D *b, *again;
  PetscReal      value[6], derivative[6];

  OK(Basis1DGet(5, 7, &b));
  OK(Basis1DGet(5, 7, &again));
  assert_ptr_equal(b, again);
  for (PetscInt q = 0; q < 7; q++) {
    OK(ElementEvaluate1D(5, b->points[q], value, derivative));
    for (PetscInt j = 0; j < 6; j++) assert_true(b->B[q * 6 + j] == value[j] && b->D[q * 6 + j] == derivative[j]);
  }
  assert_int_not_equal(ElementNumNodes(3, 2), ElementNumNodes(2, 3));
}

/* x fastest; gradient of x^2 y z on order 2 at a point. */
static void TensorFunctionsAreLexicographic(void **state)
{
  const PetscReal  xi[3] = {0.3, 0.6, 0.9};
  const PetscReal *x;
  PetscReal        value[27], gradient[81], f = 0, g[3] = {0, 0, 0};

  OK(ElementGetNodes(2, &x));
  OK(ElementEvaluate(3, 2, xi, value, gradient));
  for (PetscInt node = 0; node < 27; node++) {
    const PetscReal at = Power(x[node % 3], 2) * x[node / 3 % 3] * x[node / 9];

    f += value[node] * at;
    for (PetscInt r = 0; r < 3; r++) g[r] += gradient[3 * node + r] * at;
  }
  assert_near(f, 0.09 * 0.54, 1e-15);
  assert_near(g[0], 0.6 * 0.54, 1e-14);
  assert_near(g[1], 0.09 * 0.9, 1e-14);
  assert_near(g[2], 0.09 * 0.6, 1e-14);
}

/* Orthogonality int P_i P_j = delta / (2i+1) and central differences of the derivative. */
static void LegendreIsOrthogonal(void **state)
{
  const Basis1D *b;
  PetscReal      mass[8][8] = {{0}}, v[8], d[8], plus[8], minus[8];

  OK(Basis1DGet(1, 8, &b));
  for (PetscInt q = 0; q < 8; q++) {
    OK(ElementLegendre(7, b->points[q], v, NULL));
    for (PetscInt i = 0; i < 8; i++) {
      for (PetscInt j = 0; j < 8; j++) mass[i][j] += b->weights[q] * v[i] * v[j];
    }
  }
  for (PetscInt i = 0; i < 8; i++) {
    for (PetscInt j = 0; j < 8; j++) assert_near(mass[i][j], i == j ? 1. / (2 * i + 1) : 0, 1e-14);
  }
  OK(ElementLegendre(7, 1, v, d));
  for (PetscInt i = 0; i < 8; i++) {
    assert_near(v[i], 1, 1e-14);
    assert_near(d[i], i * (i + 1), 1e-12);
  }
  OK(ElementLegendre(7, 0.3, v, d));
  OK(ElementLegendre(7, 0.3 + 1e-5, plus, NULL));
  OK(ElementLegendre(7, 0.3 - 1e-5, minus, NULL));
  for (PetscInt i = 0; i < 8; i++) assert_near(d[i], (plus[i] - minus[i]) / 2e-5, 1e-6);
}

/* Three fields of a cell at points that share coordinates with the one before, in all ways, and at points that share none: as by all the functions, to 1e-12.
 */
static void FieldsAreTheSumsOverAllFunctions(void **state)
{
  static const PetscReal place[][3] = {{0.1, 0.2, 0.3}, {0.7, 0.2, 0.3}, {0.7, 1, 0.3},   {0.7, 1, 0},
                                       {0.1, 1, 0.9},   {0.1, 0.2, 0.9}, {0.1, 0.2, 0.9}, {0.4, 0.5, 0.6}};
  static ElementFields   f;

  for (PetscInt dim = 2; dim <= 3; dim++) {
    for (PetscInt p = 1; p <= MORTISE_MAX_ORDER; p++) {
      static PetscReal two[2 * 729], one[729], N[729], G[3 * 729];
      const PetscInt   n = ElementNumNodes(dim, p);

      for (PetscInt i = 0; i < n; i++) {
        two[2 * i]     = PetscSinReal(i);
        two[2 * i + 1] = PetscCosReal(2 * i);
        one[i]         = PetscSinReal(3 * i + 1);
      }
      ElementFieldsBegin(&f, dim, p);
      ElementFieldsAdd(&f, 0, 2, two);
      ElementFieldsAdd(&f, 2, 1, one);
      for (size_t q = 0; q < sizeof(place) / sizeof(place[0]); q++) {
        Lanes     value[4];
        PetscReal sum[4][3] = {{0}};

        OK(ElementFieldsAt(&f, place[q], value));
        OK(ElementEvaluate(dim, p, place[q], N, G));
        for (PetscInt i = 0; i < n; i++) {
          const PetscReal at[3] = {two[2 * i], two[2 * i + 1], one[i]};
          for (PetscInt c = 0; c < 3; c++) {
            sum[0][c] += N[i] * at[c];
            for (PetscInt d = 0; d < dim; d++) sum[1 + d][c] += G[i * dim + d] * at[c];
          }
        }
        for (PetscInt k = 0; k <= dim; k++) {
          for (PetscInt c = 0; c < 3; c++) assert_near(value[k][c], sum[k][c], 1e-12 * p * p);
        }
      }
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NodesAreGaussLobatto),
                                     cmocka_unit_test(KroneckerIsExact),
                                     cmocka_unit_test(PolynomialsAreReproduced),

                                     cmocka_unit_test(QuadratureIsExact),
                                     cmocka_unit_test(TableAgreesWithEvaluation),
                                     cmocka_unit_test(TensorFunctionsAreLexicographic),
                                     cmocka_unit_test(LegendreIsOrthogonal),
                                     cmocka_unit_test(FieldsAreTheSumsOverAllFunctions)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
