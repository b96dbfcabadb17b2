/* Weights of facets that are covered in part. The functions sum to 1, so that weights sum to what is covered and weighted gaps to the integral of the gap; the
   weights are positive, whatever is covered. A facet that is covered has the dual basis: where the gap is linear, gt_j = int psi_j g = g_j w_j. */
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
    ContactPairGetSegments(pair, &num, &seg);
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

/* Edge from (2,0) to (0,0); mortar edges on y = .1 + .05 x over the intervals [a, b] (hole between). sum: integral of the gap. */
static void Cover(PetscInt num, const PetscReal interval[][2], PetscBool axisymmetric, Sum *s, PetscReal *area, PetscReal *gap)
{
  const PetscReal z[2] = {1, 1};
  Chain           nonmortar, mortar;
  ContactPair     pair;

  ChainLine(&nonmortar, 2, 2, 0, 0, 0);
  ChainCreate(&mortar, 2 * num, PETSC_FALSE);
  mortar.s.num_facets = num;
  *area = *gap = 0;
  for (PetscInt i = 0; i < num; i++) {
    mortar.edges[2 * i]     = 2 * i;
    mortar.edges[2 * i + 1] = 2 * i + 1;
    for (int k = 0; k < 2; k++) {
      const PetscReal x = interval[i][k], length = interval[i][1] - interval[i][0];
      const PetscReal point = 0.5 * (interval[i][0] + interval[i][1]) + (k ? 0.5 : -0.5) * length / sqrt(3); /* two Gauss points: exact for cubics */
      const PetscReal dw    = 0.5 * length * (axisymmetric ? 2 * PETSC_PI * point : 1);

      mortar.x[2 * (2 * i + k)]     = x;
      mortar.x[2 * (2 * i + k) + 1] = 0.1 + 0.05 * x;
      *area += dw;
      *gap += dw * (0.1 + 0.05 * point);
    }
  }
  EvaluateOnce(&nonmortar, &mortar, axisymmetric, PETSC_FALSE, 0.5, z, &pair, s);
  CHECK_CALL(ContactPairDestroy(&pair));
  ChainDestroy(&nonmortar);
  ChainDestroy(&mortar);
}

static void Biorthogonal(void **state)
{
  const PetscReal whole[1][2] = {{0, 2}}, most[1][2] = {{0.1, 2}};
  PetscReal       area, gap;
  Sum             s;

  Cover(1, whole, PETSC_FALSE, &s, &area, &gap);
  for (int j = 0; j < 2; j++) assert_near(s.gap[j] / s.weight[j], j ? 0.1 : 0.2, 1e-14);
  SumDestroy(&s);
  Cover(1, most, PETSC_FALSE, &s, &area, &gap);                   /* the same functions on what is covered */
  assert_near(s.weight[0], 1 + 0.1 - 1.5 * 0.1 * 0.1 / 2, 1e-14); /* int over x from 0.1 of 3 x / 2 - 1, node 0 at x = 2 */
  assert_near(s.weight[0] + s.weight[1], 1.9, 1e-14);
  SumDestroy(&s);
}

static void Partly(void **state)
{
  const PetscReal cover[][3][2] = {{{0.9, 2}}, {{0, 0.3}}, {{0.1, 0.3}, {0.7, 0.75}, {1.5, 2}}, {{1 - 1e-3, 1 + 1e-3}}, {{2 - 1e-3, 2}}, {{1, 1 + 4e-7}}};
  const PetscInt  num[]         = {1, 1, 3, 1, 1, 1};

  for (size_t k = 0; k < sizeof(num) / sizeof(num[0]); k++)
    for (int axi = 0; axi < 2; axi++) {
      PetscReal area, gap;
      Sum       s;

      Cover(num[k], cover[k], axi, &s, &area, &gap);
      assert_int_equal(s.num, 1);
      for (int j = 0; j < 2; j++) assert_true(s.weight[j] > 0);
      assert_near((s.weight[0] + s.weight[1]) / area, 1, 1e-9); /* round-off over the share */
      assert_near((s.gap[0] + s.gap[1]) / gap, 1, 1e-9);
      SumDestroy(&s);
    }
}

CONTACT_TEST_MAIN("contact: weights and dual basis", cmocka_unit_test(SumOfWeights), cmocka_unit_test(Biorthogonal), cmocka_unit_test(Partly))
