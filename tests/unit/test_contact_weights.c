/* Weights and the dual basis. On one straight edge with straight mortar edges on a common line the gap is linear, g = N_0 g_0 + N_1 g_1, and
   gt_j = int psi_j g = g_j w_j exactly when psi is biorthogonal to the hats on the covered part: any cover, with holes, down to slivers. */
#include "contactfixture.h"

static void Cleanup(Chain *nonmortar, Chain *mortar, ContactPair *pair, Sum *s)
{
  CHECK_CALL(ContactPairDestroy(pair));
  ChainDestroy(nonmortar);
  ChainDestroy(mortar);
  SumDestroy(s);
}

static void SumOfWeights(void **state)
{
  for (uint64_t seed = 1; seed <= 100; seed++) {
    uint64_t              rng = seed * 31;
    Chain                 nonmortar, mortar;
    ContactPair           pair;
    Sum                   s;
    const ContactSegment *seg;
    PetscInt              num;
    PetscReal             w = 0, length = 0;

    RandomPair(&rng, 7, 9, 0.04, &nonmortar, &mortar);
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, &pair, &s);
    CHECK_CALL(ContactPairGetSegments(pair, &num, &seg));
    for (PetscInt i = 0; i < num; i++) {
      const PetscInt e = seg[i].facet;

      length += 0.5 * (seg[i].xi[1][0] - seg[i].xi[0][0]) * hypot(nonmortar.x[2 * e + 2] - nonmortar.x[2 * e], nonmortar.x[2 * e + 3] - nonmortar.x[2 * e + 1]);
    }
    for (int j = 0; j < 7; j++) {
      assert_true(s.weight[j] >= 0);
      w += s.weight[j];
    }
    assert_near(w, length, 1e-13);
    assert_near(s.area, length, 1e-13);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

/* Edge from (2,0) to (0,0); mortar edges on y = .1 + .05 x over the intervals [a, b] (hole between). lambda = 1 - x/2. */
static void CheckLinear(PetscInt num, const PetscReal interval[][2], PetscBool axisymmetric, PetscReal tolerance)
{
  const PetscReal z[2] = {1, 1};
  Chain           nonmortar, mortar;
  ContactPair     pair;
  Sum             s;
  PetscReal       w[2] = {0, 0};

  ChainLine(&nonmortar, 2, 2, 0, 0, 0);
  ChainCreate(&mortar, 2 * num, PETSC_FALSE);
  mortar.s.num_facets = num;
  for (PetscInt i = 0; i < num; i++) {
    mortar.edges[2 * i]     = 2 * i;
    mortar.edges[2 * i + 1] = 2 * i + 1;
    for (int k = 0; k < 2; k++) {
      const PetscReal x = interval[i][k], length = interval[i][1] - interval[i][0];
      const PetscReal point = 0.5 * (interval[i][0] + interval[i][1]) + (k ? 0.5 : -0.5) * length / sqrt(3); /* two Gauss points: exact for cubics */
      const PetscReal dw    = 0.5 * length * (axisymmetric ? 2 * PETSC_PI * point : 1);

      mortar.x[2 * (2 * i + k)]     = x;
      mortar.x[2 * (2 * i + k) + 1] = 0.1 + 0.05 * x;
      w[0] += dw * point / 2;
      w[1] += dw * (2 - point) / 2;
    }
  }
  EvaluateOnce(&nonmortar, &mortar, axisymmetric, PETSC_FALSE, 0.5, z, &pair, &s);
  assert_int_equal(s.num, 1);
  for (int j = 0; j < 2; j++) {
    assert_near(s.weight[j] / w[j], 1, tolerance);
    assert_near(s.gap[j] / s.weight[j], j ? 0.1 : 0.2, tolerance);
  }
  Cleanup(&nonmortar, &mortar, &pair, &s);
}

static void Biorthogonal(void **state)
{
  for (int axi = 0; axi < 2; axi++) {
    CheckLinear(1, (const PetscReal[][2]){{0, 2}}, axi, 1e-14);
    CheckLinear(1, (const PetscReal[][2]){{0.9, 2}}, axi, 1e-13);
    CheckLinear(1, (const PetscReal[][2]){{0, 0.3}}, axi, 1e-13);
    CheckLinear(3, (const PetscReal[][2]){{0.1, 0.3}, {0.7, 0.75}, {1.5, 2}}, axi, 1e-13);
    CheckLinear(1, (const PetscReal[][2]){{1 - 1e-3, 1 + 1e-3}}, axi, 1e-10); /* round-off over the square of the covered share */
    CheckLinear(1, (const PetscReal[][2]){{2 - 1e-3, 2}}, axi, 1e-10);
  }
}

/* Covered by less than 5e-7 of its length between its nodes the edge has no dual basis and contributes nothing. */
static void BarelyCovered(void **state)
{
  const PetscReal width[2] = {4e-6, 4e-7};

  for (int k = 0; k < 2; k++) {
    Chain       nonmortar, mortar;
    ContactPair pair;
    Sum         s;

    ChainLine(&nonmortar, 2, 2, 0, 0, 0);
    ChainLine(&mortar, 2, 1, 0.1, 1 + width[k], 0.1);
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, &pair, &s);
    assert_int_equal(s.num, k == 0);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

CONTACT_TEST_MAIN("contact: weights and dual basis", cmocka_unit_test(SumOfWeights), cmocka_unit_test(Biorthogonal), cmocka_unit_test(BarelyCovered))
