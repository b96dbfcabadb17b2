/* Stress and energy of cases.md O-01, closed forms, tangent against central differences, objectivity, symmetry, small strains, volumetric measure. */
#include "material.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"

#define OK(call) assert_int_equal(call, 0)

typedef struct {
  const char *law;
  Volumetric  volumetric;
  PetscInt    num;
  const char *names[7];
  PetscReal   values[7];
  PetscReal   W, P[4]; /* P11, P12, P21, P33 */
  PetscInt    num_fibers;
  PetscReal   fiber[2][3];
} Row;

#define CAROTID "c", "kappa", "k1", "k2" /* {3, 100, 2.3632, .8393} */
#define OGDEN "mu1", "alpha1", "mu2", "alpha2", "mu3", "alpha3", "kappa"
#define COS29 0.87461970713939580
#define SIN29 0.48480962024633703

/* cases.md O-01; St. Venant-Kirchhoff by hand, F1 (lambda tr E 1 + 2 mu E); mooney_rivlin log: its energy and differences of it, with 30 digits */
static const Row rows[] = {
    {"neo_hookean", VOLUMETRIC_LOG, 2, {"mu", "lambda"}, {1, 2}, 0.147591766098, {0.4943538338, 0.2024829125, 0.1798664768, 0.2282784872}, 0, {{0}}},
    {"neo_hookean", VOLUMETRIC_SIMO, 2, {"mu", "kappa"}, {1, 50}, 0.315349668375, {4.0652953955, -0.0760681971, -0.4919977784, 4.4054403799}, 0, {{0}}},
    {"neo_hookean", VOLUMETRIC_QUADRATIC, 2, {"mu", "kappa"}, {1, 50}, 0.320524161883, {4.2260656643, -0.0880255949, -0.521585792, 4.5926565725}, 0, {{0}}},
    {"mooney_rivlin",
     VOLUMETRIC_LOG,
     3,
     {"c1", "c2", "kappa"},
     {.3, .2, 5},
     0.17072095564751,
     {0.72302229111, 0.223948059782, 0.180225636978, 0.484085925315},
     0,
     {{0}}},
    {"mooney_rivlin",
     VOLUMETRIC_QUADRATIC,
     3,
     {"c1", "c2", "kappa"},
     {.3, .2, 50},
     0.330987571105,
     {4.2318835549, -0.0589440653, -0.4902377314, 4.597179224},
     0,
     {{0}}},
    {"saint_venant_kirchhoff", VOLUMETRIC_QUADRATIC, 2, {"mu", "lambda"}, {1, 2}, 0.19665207, {1.12835, 0.27366, 0.19992, 0.68128}, 0, {{0}}},
    {"hgo",
     VOLUMETRIC_SIMO,
     4,
     {CAROTID},
     {3, 100, 2.3632, .8393},
     0.978881863111,
     {9.6793456744, 1.1414069696, 0.1987635883, 7.5934566203},
     2,
     {{COS29, SIN29, 0}, {COS29, -SIN29, 0}}},
    {"hgo", VOLUMETRIC_SIMO, 4, {CAROTID}, {3, 100, 2.3632, .8393}, 0.835055658301, {8.0806264828, 0.425178633, -0.3980327008, 8.8112858645}, 1, {{1, 2, 2}}},
    {"hgo", VOLUMETRIC_QUADRATIC, 5, {"c", "c2", "kappa", "k1", "k2"}, {1, .5, 50, 3, 2}, 0, {0}, 2, {{1, 0, 0}, {0, 1, 0}}}, /* the second is slack */
    {"mooney_rivlin", VOLUMETRIC_SIMO, 3, {"c1", "c2", "kappa"}, {.3, .2, 50}, 0, {0}, 0, {{0}}},
    {"ogden", VOLUMETRIC_SIMO, 7, {OGDEN}, {.63, 1.3, .0012, 5, -.01, -2, 50}, 0, {0}, 0, {{0}}},
    {"ogden", VOLUMETRIC_QUADRATIC, 3, {"mu1", "alpha1", "kappa"}, {-.4, -3, 50}, 0, {0}, 0, {{0}}},
    {"yeoh", VOLUMETRIC_SIMO, 4, {"c1", "c2", "c3", "kappa"}, {.5, -.05, .02, 50}, 0, {0}, 0, {{0}}},
    {"arruda_boyce", VOLUMETRIC_QUADRATIC, 3, {"mu", "locking_stretch", "kappa"}, {1, 1.7, 50}, 0, {0}, 0, {{0}}},
    {"linear", VOLUMETRIC_QUADRATIC, 2, {"mu", "kappa"}, {1, 50}, 0, {0}, 0, {{0}}},
};
#define NUM_ROWS PETSC_STATIC_ARRAY_LENGTH(rows)

static const PetscReal F1[9]  = {1.2, .15, -.1, .05, .9, .2, -.08, .12, 1.05};
static const PetscReal one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

static void SpecMake(const Row *row, MaterialSpec *spec)
{
  PetscMemzero(spec, sizeof(*spec));
  PetscStrncpy(spec->name, "test", sizeof(spec->name));
  spec->law        = MaterialLawFind(row->law);
  spec->volumetric = row->volumetric;
  spec->num_fibers = row->num_fibers;
  for (PetscInt f = 0; f < row->num_fibers; f++) {
    spec->fiber[f].straight = PETSC_TRUE;
    PetscMemcpy(spec->fiber[f].direction, row->fiber[f], sizeof(row->fiber[f]));
  }
  assert_non_null(spec->law);
  OK(MaterialSetUp(spec, row->num, row->names, row->values));
}

static void Evaluate(const MaterialSpec *spec, MaterialPart part, const PetscReal F[9], PetscReal *W, PetscReal *P, PetscReal *A)
{
  const PetscReal origin[3] = {0};
  PetscReal       fiber[MATERIAL_MAX_FIBERS][3];
  MaterialPoints  point = {.n = 1, .F = F, .fiber = fiber[0], .W = W, .P = P, .A = A};

  MaterialFiberDirections(spec, 0, origin, fiber);
  OK(MaterialEvaluate(spec, part, &point));
  assert_false(point.bad);
}

/* Printed digits end at 1e-10 absolute for P (values up to 5) and 1e-12 for W. */
static void PointValuesOfO01(void **state)
{
  for (size_t i = 0; i < 8; i++) {
    MaterialSpec spec;
    PetscReal    W, P[9];

    SpecMake(&rows[i], &spec);
    Evaluate(&spec, MATERIAL_FULL, F1, &W, P, NULL);
    assert_near(W, rows[i].W, 1e-12);
    assert_near(P[0], rows[i].P[0], 1e-10);
    assert_near(P[1], rows[i].P[1], 1e-10);
    assert_near(P[3], rows[i].P[2], 1e-10);
    assert_near(P[8], rows[i].P[3], 1e-10);
  }
}

/* dW/dF = P and dP/dF = A, fourth-order differences with step 1e-3: 1e-8 of the modulus. A is symmetric. */
static void DerivativesAgree(void **state)
{
  const PetscReal h = 1e-3, modulus = 50;

  for (size_t i = 0; i < NUM_ROWS; i++) {
    for (int part = 0; part < 2; part++) {
      MaterialSpec spec;
      PetscReal    P[9], A[81], w[4], p[4][9];

      SpecMake(&rows[i], &spec);
      if (part == MATERIAL_ISOCHORIC && spec.law->whole) continue;
      Evaluate(&spec, (MaterialPart)part, F1, NULL, P, A);
      for (int b = 0; b < 9; b++) {
        for (int s = 0; s < 4; s++) {
          PetscReal F[9];

          PetscMemcpy(F, F1, sizeof(F));
          F[b] += h * (s < 2 ? s - 2 : s - 1);
          Evaluate(&spec, (MaterialPart)part, F, &w[s], p[s], NULL);
        }
        assert_near(P[b], (w[0] - 8 * w[1] + 8 * w[2] - w[3]) / (12 * h), 1e-9 * modulus);
        for (int a = 0; a < 9; a++) {
          assert_near(A[9 * a + b], (p[0][a] - 8 * p[1][a] + 8 * p[2][a] - p[3][a]) / (12 * h), 1e-9 * modulus);
          assert_near(A[9 * a + b], A[9 * b + a], 1e-13 * modulus);
        }
      }
    }
  }
}

/* At F = 1: no energy, no stress, and A = lambda 1 (x) 1 + mu (transposed identities). */
static void ReferenceIsStressFree(void **state)
{
  for (size_t i = 0; i < NUM_ROWS; i++) {
    MaterialSpec spec;
    PetscReal    W, P[9], A[81];

    SpecMake(&rows[i], &spec);
    Evaluate(&spec, MATERIAL_FULL, one, &W, P, A);
    assert_true(W == 0);
    for (int a = 0; a < 9; a++) {
      assert_near(P[a], 0, 1e-15);
      for (int b = 0; b < 9; b++) {
        const int i0 = a / 3, J = a % 3, k = b / 3, L = b % 3;

        assert_near(A[9 * a + b], spec.lambda * (i0 == J) * (k == L) + spec.mu * ((i0 == k) * (J == L) + (i0 == L) * (J == k)), 1e-13);
      }
    }
  }
}

/* P(Q F) = Q P(F), W(Q F) = W(F) for a rotation Q by 0.7 about (1,2,2)/3. */
static void LawsAreObjective(void **state)
{
  const PetscReal n[3] = {1. / 3, 2. / 3, 2. / 3}, c = PetscCosReal(0.7), s = PetscSinReal(0.7);
  const PetscReal spin[9] = {0, -n[2], n[1], n[2], 0, -n[0], -n[1], n[0], 0};
  PetscReal       Q[9], QF[9] = {0};

  for (int i = 0; i < 9; i++) Q[i] = c * one[i] + s * spin[i] + (1 - c) * n[i / 3] * n[i % 3];
  for (int i = 0; i < 27; i++) QF[i / 3] += Q[3 * (i / 9) + i % 3] * F1[3 * (i % 3) + i / 3 % 3];
  for (size_t i = 0; i < NUM_ROWS; i++) {
    MaterialSpec spec;
    PetscReal    W, P[9], WQ, PQ[9];

    SpecMake(&rows[i], &spec);
    if (spec.law->small) continue;
    Evaluate(&spec, MATERIAL_FULL, F1, &W, P, NULL);
    Evaluate(&spec, MATERIAL_FULL, QF, &WQ, PQ, NULL);
    assert_near(WQ, W, 1e-13);
    for (int a = 0; a < 9; a++) {
      PetscReal sum = 0;

      for (int m = 0; m < 3; m++) sum += Q[3 * (a / 3) + m] * P[3 * m + a % 3];
      assert_near(PQ[a], sum, 1e-12);
    }
  }
}

/* Strain 1e-6: P agrees with linear elasticity to second order (1e-11 of the modulus, that is 1e-5 of P), and W to its leading order. */
static void SmallStrainsKeepTheirDigits(void **state)
{
  const PetscReal grad[9] = {3, 1, -2, 2, -1, 4, 1, -3, 2}, e = 1e-6;
  PetscReal       F[9];

  for (int k = 0; k < 9; k++) F[k] = one[k] + e * grad[k];
  for (size_t i = 0; i < NUM_ROWS; i++) {
    MaterialSpec spec;
    PetscReal    W, P[9], energy = 0;

    SpecMake(&rows[i], &spec);
    if (spec.num_fibers) continue; /* stiffer in tension to first order */
    Evaluate(&spec, MATERIAL_FULL, F, &W, P, NULL);
    for (int a = 0; a < 9; a++) {
      const PetscReal stress = e * (spec.lambda * (grad[0] + grad[4] + grad[8]) * one[a] + spec.mu * (grad[a] + grad[3 * (a % 3) + a / 3]));

      assert_near(P[a], stress, 2e-11 * (10 * spec.kappa + 40 * spec.mu));
      energy += 0.5 * stress * e * grad[a];
    }
    assert_near(W / energy, 1, 1e-4);
  }
}

/* Many points at once, any count, equal the points one by one; det F <= 0 is reported and disturbs no other point. */
static void BatchesEqualPoints(void **state)
{
  enum { N = 21 };

  for (size_t i = 0; i < NUM_ROWS; i++) {
    MaterialSpec   spec;
    PetscReal      F[9 * N], W[N], P[9 * N], A[81 * N], fiber[6 * N], w, p[9], a[81];
    MaterialPoints points = {.n = N, .F = F, .fiber = fiber, .W = W, .P = P, .A = A};

    SpecMake(&rows[i], &spec);
    for (int k = 0; k < 3 * N * spec.num_fibers; k++) fiber[k] = spec.fiber[k / (3 * N)].direction[k / N % 3];
    for (int q = 0; q < N; q++) {
      for (int k = 0; k < 9; k++) F[k * N + q] = F1[k] + 0.01 * q * (k == q % 9);
    }
    OK(MaterialEvaluate(&spec, MATERIAL_FULL, &points));
    assert_false(points.bad);
    for (int q = 0; q < N; q++) {
      PetscReal f[9];

      for (int k = 0; k < 9; k++) f[k] = F[k * N + q];
      Evaluate(&spec, MATERIAL_FULL, f, &w, p, a);
      assert_near(W[q], w, 1e-14);
      for (int k = 0; k < 9; k++) assert_near(P[k * N + q], p[k], 1e-13);
      for (int k = 0; k < 81; k++) assert_near(A[k * N + q], a[k], 1e-12);
    }
    if (spec.law->small) continue;
    for (int k = 0; k < 9; k++) F[k * N + 17] = -one[k];
    points.A = NULL;
    OK(MaterialEvaluate(&spec, MATERIAL_FULL, &points));
    assert_true(points.bad);
    for (int k = 0; k < 9; k++) F[k * N + 17] = F1[k];
    points.P   = NULL;
    points.bad = PETSC_FALSE;
    OK(MaterialEvaluate(&spec, MATERIAL_FULL, &points));
    assert_false(points.bad);
  }
}

/* Beyond exp(k2 E^2) = e^20 a stretch along the fibres counts as impossible. */
static void FibresEndSomewhere(void **state)
{
  const Row    row = {"hgo", VOLUMETRIC_SIMO, 4, {CAROTID}, {3, 100, 2.3632, .8393}, 0, {0}, 1, {{1, 0, 0}}};
  MaterialSpec spec;

  SpecMake(&row, &spec);
  for (int k = 0; k < 2; k++) {
    const PetscReal stretch = PetscSqrtReal(1 + PetscSqrtReal((k ? 20.1 : 19.9) / .8393)), across = 1 / PetscSqrtReal(stretch);
    const PetscReal F[9] = {stretch, 0, 0, 0, across, 0, 0, 0, across}, fiber[3] = {1, 0, 0};
    PetscReal       W, P[9];
    MaterialPoints  point = {.n = 1, .F = F, .fiber = fiber, .W = &W, .P = P};
    OK(MaterialEvaluate(&spec, MATERIAL_FULL, &point));
    assert_int_equal(point.bad, k);
  }
}

/* A family that is slack leaves the stress alone, in tension it pulls along its direction; the stress is continuous and the tangent jumps by
   k1 D (x) D, D = d(J^(-2/3) |F M|^2)/dF. */
static void FibresCarryTensionOnly(void **state)
{
  const Row    row[2] = {{"hgo", VOLUMETRIC_SIMO, 4, {CAROTID}, {3, 100, 2.3632, .8393}, 0, {0}, 1, {{1, 0, 0}}},
                         {"neo_hookean", VOLUMETRIC_SIMO, 2, {"mu", "kappa"}, {3, 100}, 0, {0}, 0, {{0}}}};
  MaterialSpec fibres, plain;

  SpecMake(&row[0], &fibres);
  SpecMake(&row[1], &plain);
  for (int side = -1; side <= 1; side += 2) { /* isochoric: E = stretch^2 - 1 */
    for (int small = 0; small < 2; small++) {
      const PetscReal stretch = 1 + side * (small ? 1e-9 : 0.1), other = 1 / PetscSqrtReal(stretch), F[9] = {stretch, 0, 0, 0, other, 0, 0, 0, other};
      const PetscReal E = stretch * stretch - 1, e = PetscExpReal(.8393 * E * E), pull = side > 0 ? 2 * 2.3632 * E * e : 0;
      PetscReal       P[2][9], A[2][81], D[9] = {4. / 3 * stretch, 0, 0, 0, -2. / 3 * stretch * stretch / other, 0, 0, 0, -2. / 3 * stretch * stretch / other};

      Evaluate(&fibres, MATERIAL_FULL, F, NULL, P[0], A[0]);
      Evaluate(&plain, MATERIAL_FULL, F, NULL, P[1], A[1]);
      for (int k = 0; k < 9; k++) assert_near(P[0][k] - P[1][k], 0.5 * pull * D[k], 1e-13);
      for (int k = 0; small && k < 81; k++) assert_near(A[0][k] - A[1][k], side > 0 ? 2.3632 * D[k / 9] * D[k % 9] : 0, 1e-7);
    }
  }
}

/* hgo with c2, volume kept: Cauchy stress differences of an incompressible Mooney-Rivlin solid, s_i - s_j = (l_i^2 - l_j^2) (c + c2 l_k^2), with the fibres
   along axis x, y or z: 2 k1 E exp(k2 E^2) l^2 more along them where they are longer, E = l^2 - 1. Uniaxial, biaxial, general. */
static void SecondInvariantOfWalls(void **state)
{
  static const PetscReal stretch[][2] = {{1.3, 0}, {0.8, 0}, {1.3, 1.3}, {0.8, 0.8}, {1.4, 0.9}, {1.1, 1.2}}; /* second one 0: free */
  const PetscReal        c = 1, c2 = 0.5, k1 = 3, k2 = 2;

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(stretch); i++) {
    for (int along = 0; along < 3; along++) {
      const PetscReal second = stretch[i][1] > 0 ? stretch[i][1] : 1 / PetscSqrtReal(stretch[i][0]);
      const PetscReal l[3] = {stretch[i][0], second, 1 / (stretch[i][0] * second)}, F[9] = {l[0], 0, 0, 0, l[1], 0, 0, 0, l[2]};
      const PetscReal E = l[along] * l[along] - 1, pull = E > 0 ? 2 * k1 * E * PetscExpReal(k2 * E * E) * l[along] * l[along] : 0;
      const Row       row = {
                "hgo", VOLUMETRIC_QUADRATIC, 5, {"c", "c2", "kappa", "k1", "k2"}, {c, c2, 50, k1, k2}, 0, {0}, 1, {{along == 0, along == 1, along == 2}}};
      MaterialSpec spec;
      PetscReal    P[9];

      SpecMake(&row, &spec);
      Evaluate(&spec, MATERIAL_FULL, F, NULL, P, NULL);
      for (int a = 0; a < 3; a++) {
        const int       b = (a + 1) % 3, other = (a + 2) % 3;
        const PetscReal solid = (l[a] * l[a] - l[b] * l[b]) * (c + c2 * l[other] * l[other]);
        assert_near(P[4 * a] * l[a] - P[4 * b] * l[b], solid + (a == along ? pull : 0) - (b == along ? pull : 0), 1e-13 * (10 + pull));
      }
    }
  }
}

/* O-06: Ogden's solid is neo-Hookean with alpha = 2, and Mooney-Rivlin with 2 and -2; Yeoh's with c1 alone, and the eight-chain model with chains without end,
   are neo-Hookean: W, P and A, at a general deformation, where two stretches are equal or nearly so, and at tiny strains. */
static void RubbersAgree(void **state)
{
  static const struct {
    Row row, same;
  } pairs[]                      = {{{"ogden", VOLUMETRIC_SIMO, 3, {"mu1", "alpha1", "kappa"}, {1.2, 2, 50}, 0, {0}, 0, {{0}}},
                                     {"neo_hookean", VOLUMETRIC_SIMO, 2, {"mu", "kappa"}, {1.2, 50}, 0, {0}, 0, {{0}}}},
                                    {{"ogden", VOLUMETRIC_QUADRATIC, 5, {"mu1", "alpha1", "mu2", "alpha2", "kappa"}, {.6, 2, -.4, -2, 50}, 0, {0}, 0, {{0}}},
                                     {"mooney_rivlin", VOLUMETRIC_QUADRATIC, 3, {"c1", "c2", "kappa"}, {.3, .2, 50}, 0, {0}, 0, {{0}}}},
                                    {{"yeoh", VOLUMETRIC_SIMO, 2, {"c1", "kappa"}, {.6, 50}, 0, {0}, 0, {{0}}},
                                     {"neo_hookean", VOLUMETRIC_SIMO, 2, {"mu", "kappa"}, {1.2, 50}, 0, {0}, 0, {{0}}}},
                                    {{"arruda_boyce", VOLUMETRIC_SIMO, 3, {"mu", "locking_stretch", "kappa"}, {1.2, 1e8, 50}, 0, {0}, 0, {{0}}},
                                     {"neo_hookean", VOLUMETRIC_SIMO, 2, {"mu", "kappa"}, {1.2, 50}, 0, {0}, 0, {{0}}}}};
  static const PetscReal at[][9] = {{1.2, .15, -.1, .05, .9, .2, -.08, .12, 1.05}, {1.3, 0, 0, 0, 1.3, 0, 0, 0, .6},        {.8, 0, 0, 0, .8, 0, 0, 0, .8},
                                    {1.3, 0, 0, 0, 1.3 + 1e-9, 0, 0, 0, .6},       {0, -1.1, 0, 1.1, 1e-13, 0, 0, 1e-7, 1}, {1, 1e-9, 0, 0, 1, 0, 0, 0, 1}};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(pairs); i++) {
    for (size_t j = 0; j < PETSC_STATIC_ARRAY_LENGTH(at); j++) {
      MaterialSpec spec[2];
      PetscReal    W[2], P[2][9], A[2][81];

      for (int k = 0; k < 2; k++) {
        SpecMake(k ? &pairs[i].same : &pairs[i].row, &spec[k]);
        Evaluate(&spec[k], MATERIAL_FULL, at[j], &W[k], P[k], A[k]);
      }
      assert_near(spec[0].mu, spec[1].mu, 1e-14);
      assert_near(W[0], W[1], 1e-13 * PetscMax(1e-8, PetscAbsReal(W[1])) * 100);
      for (int k = 0; k < 9; k++) assert_near(P[0][k], P[1][k], 1e-13);
      for (int k = 0; k < 81; k++) assert_near(A[0][k], A[1][k], 2e-12);
    }
  }
}

/* Volume kept: nominal stresses of an incompressible solid under a stretch l, P1 - P2 l^(-3/2) in uniaxial tension with F = diag(l, l^-1/2, l^-1/2): Ogden's
   sum mu_p (l^(a-1) - l^(-a/2-1)) with Treloar's rubber (Ogden 1972), Yeoh's and the eight-chain series 2 (l - l^-2) dW/dI1. */
static void UniaxialRubbers(void **state)
{
  static const Row       rows3[3]   = {{"ogden", VOLUMETRIC_SIMO, 7, {OGDEN}, {6.3, 1.3, .012, 5, -.1, -2, 1e3}, 0, {0}, 0, {{0}}},
                                       {"yeoh", VOLUMETRIC_SIMO, 4, {"c1", "c2", "c3", "kappa"}, {.5, -.05, .02, 50}, 0, {0}, 0, {{0}}},
                                       {"arruda_boyce", VOLUMETRIC_SIMO, 3, {"mu", "locking_stretch", "kappa"}, {1, 2.8, 50}, 0, {0}, 0, {{0}}}};
  static const PetscReal term[3][2] = {{6.3, 1.3}, {.012, 5}, {-.1, -2}}, series[5] = {1. / 2, 1. / 20, 11. / 1050, 19. / 7000, 519. / 673750};

  for (PetscReal l = .5; l < 5; l += .5) {
    const PetscReal across = 1 / PetscSqrtReal(l), F[9] = {l, 0, 0, 0, across, 0, 0, 0, across}, I1 = l * l + 2 / l, Y = I1 - 3;
    PetscReal       expected[3] = {0, 2 * (l - 1 / (l * l)) * (.5 - .1 * Y + .06 * Y * Y), 0};

    for (int p = 0; p < 3; p++) expected[0] += term[p][0] * (PetscPowReal(l, term[p][1] - 1) - PetscPowReal(l, -term[p][1] / 2 - 1));
    for (int i = 1; i <= 5; i++) expected[2] += 2 * (l - 1 / (l * l)) * series[i - 1] * i * PetscPowRealInt(I1 / (2.8 * 2.8), i - 1);
    for (int k = 0; k < 3; k++) {
      MaterialSpec spec;
      PetscReal    P[9];

      SpecMake(&rows3[k], &spec);
      Evaluate(&spec, MATERIAL_FULL, F, NULL, P, NULL);
      assert_near(P[0] - P[4] * across / l, expected[k], 1e-12 * (1 + PetscAbsReal(expected[k])));
    }
  }
}

/* Angles count from axis x (X - point) towards the axis, at every position; in axisymmetric models from the third direction towards y. */
static void FibresTurnWithTheFrame(void **state)
{
  const PetscReal X[3] = {1 + 3, 2 + 4, 7}, axial[3] = {0.3, 0.2, 0};
  const Row       row = {"hgo", VOLUMETRIC_SIMO, 4, {CAROTID}, {3, 100, 2.3632, .8393}, 0, {0}, 1, {{1, 0, 0}}};
  MaterialSpec    spec;
  PetscReal       M[MATERIAL_MAX_FIBERS][3];

  SpecMake(&row, &spec);
  spec.fiber[0].straight = PETSC_FALSE;
  spec.fiber[0].angle    = 29;
  spec.frame             = (MaterialFrame){.axis = 2, .point = {1, 2, 0}};
  MaterialFiberDirections(&spec, 0, X, M);
  assert_near(M[0][0], -0.8 * COS29, 1e-15);
  assert_near(M[0][1], 0.6 * COS29, 1e-15);
  assert_near(M[0][2], SIN29, 1e-15);
  spec.frame = (MaterialFrame){.axis = 0, .point = {0, 2, 4}};
  MaterialFiberDirections(&spec, 0, X, M); /* x cross (y = 4, z = 3) = (y = -3, z = 4) */
  assert_near(M[0][0], SIN29, 1e-15);
  assert_near(M[0][1], -0.6 * COS29, 1e-15);
  assert_near(M[0][2], 0.8 * COS29, 1e-15);
  spec.frame = (MaterialFrame){.axis = 1, .meridian = PETSC_TRUE};
  MaterialFiberDirections(&spec, 0, axial, M);
  assert_near(M[0][0], 0, 0);
  assert_near(M[0][1], SIN29, 1e-15);
  assert_near(M[0][2], COS29, 1e-15);
}

/* m/2 g^2 is the volumetric energy; derivatives by differences, also across the switch between series and formula. */
static void VolumetricMeasure(void **state)
{
  const PetscReal where[] = {0.5, 0.8, 0.9, 0.9000001, 0.97, 1 - 1e-6, 1, 1 + 1e-9, 1.05, 1.0999999, 1.1, 1.4, 3}, h = 1e-3;

  for (size_t i = 0; i < 4; i++) {
    MaterialSpec spec;

    SpecMake(&rows[i], &spec);
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(where); k++) {
      const PetscReal J = where[k], root = PetscPowReal(J, 1. / 3), F[9] = {root, 0, 0, 0, root, 0, 0, 0, root};
      PetscReal       g[3], s[4][3], full, isochoric;

      MaterialVolumetric(&spec, J, g);
      for (int j = 0; j < 4; j++) MaterialVolumetric(&spec, J + h * (j < 2 ? j - 2 : j - 1), s[j]);
      assert_near(g[1], (s[0][0] - 8 * s[1][0] + 8 * s[2][0] - s[3][0]) / (12 * h), 1e-9);
      assert_near(g[2], (s[0][1] - 8 * s[1][1] + 8 * s[2][1] - s[3][1]) / (12 * h), 1e-9);
      Evaluate(&spec, MATERIAL_FULL, F, &full, NULL, NULL);
      Evaluate(&spec, MATERIAL_ISOCHORIC, F, &isochoric, NULL, NULL);
      assert_near(full - isochoric, 0.5 * MaterialVolumetricModulus(&spec) * g[0] * g[0], 1e-12);
    }
    PetscReal g[3];
    MaterialVolumetric(&spec, 1, g);
    assert_true(g[0] == 0 && g[1] == 1);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(PointValuesOfO01),
                                     cmocka_unit_test(DerivativesAgree),
                                     cmocka_unit_test(ReferenceIsStressFree),
                                     cmocka_unit_test(LawsAreObjective),
                                     cmocka_unit_test(SmallStrainsKeepTheirDigits),
                                     cmocka_unit_test(BatchesEqualPoints),
                                     cmocka_unit_test(FibresEndSomewhere),
                                     cmocka_unit_test(FibresCarryTensionOnly),
                                     cmocka_unit_test(SecondInvariantOfWalls),
                                     cmocka_unit_test(RubbersAgree),
                                     cmocka_unit_test(UniaxialRubbers),
                                     cmocka_unit_test(FibresTurnWithTheFrame),
                                     cmocka_unit_test(VolumetricMeasure)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
