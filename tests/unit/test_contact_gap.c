/* Weighted gaps of known fields, accuracy of the quadrature, momentum balance and invariance. */
#include "contactfixture.h"

static void Cleanup(Chain *nonmortar, Chain *mortar, ContactPair *pair, Sum *s)
{
  CHECK_CALL(ContactPairDestroy(pair));
  ChainDestroy(nonmortar);
  ChainDestroy(mortar);
  SumDestroy(s);
}

/* Parallel straight faces, any meshes, any cover, any direction: gt_j = g w_j, open and penetrated. */
static void ParallelFaces(void **state)
{
  for (uint64_t seed = 1; seed <= 50; seed++) {
    uint64_t        rng = seed * 991;
    const PetscReal g   = 0.1 * Random(&rng);
    Chain           nonmortar, mortar;
    ContactPair     pair;
    Sum             s;

    ChainLine(&nonmortar, 6, 1, 0, 0, 0);
    ChainLine(&mortar, 8, 0.2 * Random(&rng), g, 1 + 0.2 * Random(&rng), g);
    ChainMove(&nonmortar, (PetscReal)seed, 0, 0);
    ChainMove(&mortar, (PetscReal)seed, 0, 0);
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, &pair, &s);
    for (int j = 0; j < 6; j++) assert_near(s.gap[j], g * s.weight[j], 1e-14);
    assert_near(s.min_gap, g, 1e-14);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

/* int of the hat of node i of a straight chain along x over [a, b]. */
static PetscReal HatIntegral(const Chain *c, PetscInt i, PetscReal a, PetscReal b)
{
  const PetscReal x   = c->x[2 * i];
  PetscReal       sum = 0;

  for (int side = -1; side <= 1; side += 2) {
    const PetscInt k = i + side;
    PetscReal      lo, hi, y;

    if (k < 0 || k >= c->s.num_nodes) continue;
    y  = c->x[2 * k];
    lo = PetscMax(a, PetscMin(x, y));
    hi = PetscMin(b, PetscMax(x, y));
    if (lo < hi) sum += (hi - lo) * (1 - PetscAbsReal(0.5 * (lo + hi) - x) / PetscAbsReal(y - x));
  }
  return sum;
}

/* z = 1 on flat closed faces, non-matching, mortar from .13 to .83: the patch test's loads. Both sides get exactly the integrals of their hats over the
   covered part, normal to the face, nothing along it. */
static void ConstantPressure(void **state)
{
  const PetscReal z[6] = {1, 1, 1, 1, 1, 1};
  Chain           nonmortar, mortar;
  ContactPair     pair;
  Sum             s;

  ChainLine(&nonmortar, 6, 1, 0, 0, 0);
  ChainLine(&mortar, 9, 0.13, 0, 0.83, 0);
  EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, z, &pair, &s);
  for (PetscInt i = 0; i < s.size; i += 2) {
    const PetscInt  own   = i < 12;
    const PetscReal force = own ? -HatIntegral(&nonmortar, i / 2, 0.13, 0.83) : HatIntegral(&mortar, i / 2 - 6, 0.13, 0.83);

    assert_near(s.gradient[i], 0, 1e-15);
    assert_near(s.gradient[i + 1], force, 1e-14);
  }
  Cleanup(&nonmortar, &mortar, &pair, &s);
}

/* Reference: gt_j = D1_j c_j with integrals by 4000 midpoints on one edge whose end directions are d; mortar one long straight edge. */
static void EdgeReference(const PetscReal d[2][2], PetscReal y, PetscReal slope, PetscReal gt[2])
{
  PetscReal D[3] = {0}, G[2] = {0}, det;

  for (int i = 0; i < 4000; i++) {
    const PetscReal l = (i + 0.5) / 4000, N[2] = {1 - l, l}, x = 1 - l, dx = N[0] * d[0][0] + N[1] * d[1][0], dy = N[0] * d[0][1] + N[1] * d[1][1];
    const PetscReal g = (y + slope * x) / (dy - slope * dx) * dy; /* across the edge, x + s d on the line Y = y + slope X */

    D[0] += N[0] * N[0] / 4000, D[1] += N[0] * N[1] / 4000, D[2] += N[1] * N[1] / 4000;
    for (int j = 0; j < 2; j++) G[j] += N[j] * g / 4000;
  }
  det   = D[0] * D[2] - D[1] * D[1];
  gt[0] = (D[0] + D[1]) * (D[2] * G[0] - D[1] * G[1]) / det;
  gt[1] = (D[1] + D[2]) * (D[0] * G[1] - D[1] * G[0]) / det;
}

/* Gauss points of a segment: cutting the mortar edge in 16 (16 times the points) changes gt by less than 1e-9 of itself for directions 0.35 apart; and both
   agree with the midpoint sum to its own accuracy. */
static void Quadrature(void **state)
{
  const PetscReal slope = 0.1, y = 0.2, tilt = tan(0.35);
  PetscReal       gt[2][2], ref[2], d[2][2];

  for (int fine = 0; fine < 2; fine++) {
    const PetscInt      edge = 1;
    Chain               nonmortar, mortar;
    ContactPair         pair;
    const ContactFacet *e;
    PetscInt            num;
    PetscBool           failed;

    ChainCreate(&nonmortar, 4, PETSC_FALSE);
    memcpy(nonmortar.x, (const PetscReal[8]){2, -tilt, 1, 0, 0, 0, -1, -tilt}, 8 * sizeof(PetscReal));
    ChainLine(&mortar, fine ? 17 : 2, -3, y - 3 * slope, 3, y + 3 * slope);
    ChainReference(&nonmortar);
    PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
    CHECK_CALL(ContactPairSearch(pair, &nonmortar.s, &mortar.s, 1, &edge, 1, 0));
    CHECK_CALL(ContactPairEvaluate(pair, &nonmortar.s, &mortar.s, NULL, NULL, PETSC_FALSE, PETSC_FALSE, &num, &e, &failed));
    assert_int_equal(num, 1);
    for (int j = 0; j < 2; j++) gt[fine][j] = e[0].gap[j];
    for (int v = 0; v < 2; v++) ChainDirection(&nonmortar, edge, v, d[v]);
    CHECK_CALL(ContactPairDestroy(&pair));
    ChainDestroy(&nonmortar);
    ChainDestroy(&mortar);
  }
  EdgeReference(d, y, slope, ref);
  print_message("directions %.3f apart: quadrature error %.1e, %.1e of gt\n", atan2(d[0][0], d[0][1]) - atan2(d[1][0], d[1][1]), gt[0][0] / gt[1][0] - 1,
                gt[0][1] / gt[1][1] - 1);
  for (int j = 0; j < 2; j++) {
    assert_near(gt[0][j] / gt[1][j], 1, 1e-9);
    assert_near(gt[1][j] / ref[j], 1, 1e-7);
  }
}

/* Forces f = -dS/dx: their sum over both sides and their moment about the origin in the current configuration vanish (case O-90). */
static void CheckBalance(PetscBool nts, PetscReal *force, PetscReal *moment)
{
  for (uint64_t seed = 1; seed <= 100; seed++) {
    uint64_t    rng = seed * 7;
    Chain       nonmortar, mortar;
    ContactPair pair;
    Sum         s;
    PetscReal   z[9], f[2] = {0, 0}, m = 0, size = 0, size_m = 0;

    RandomPair(&rng, 9, 7, 0.03, &nonmortar, &mortar);
    ChainMove(&nonmortar, (PetscReal)seed, 1, 2);
    ChainMove(&mortar, (PetscReal)seed, 1, 2);
    for (int j = 0; j < 9; j++) z[j] = 1 + Random(&rng);
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, nts, 0.5, z, &pair, &s);
    for (PetscInt i = 0; i < s.size; i += 2) {
      const PetscReal *x = Unknown(&nonmortar, &mortar, i), *g = &s.gradient[i];

      for (int k = 0; k < 2; k++) f[k] += g[k];
      size += hypot(g[0], g[1]);
      m += x[0] * g[1] - x[1] * g[0];
      size_m += hypot(g[0], g[1]) * hypot(x[0], x[1]);
    }
    *force  = PetscMax(*force, hypot(f[0], f[1]) / size);
    *moment = PetscMax(*moment, PetscAbsReal(m) / size_m);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

static void Balance(void **state)
{
  for (int nts = 0; nts < 2; nts++) {
    PetscReal force = 0, moment = 0;

    CheckBalance(nts, &force, &moment);
    print_message("%s: force %.1e, moment %.1e of the nodal forces' sums, worst of 100\n", nts ? "node to segment" : "mortar", force, moment);
    assert_true(force < 1e-13);
    assert_true(moment < 1e-12);
  }
}

/* Turning and moving both bodies changes nothing but the direction of gradients. */
static void RigidMotion(void **state)
{
  PetscReal worst = 0;

  for (uint64_t seed = 1; seed <= 50; seed++) {
    Sum             s[2];
    const PetscReal angle = (PetscReal)seed, cs = cos(angle), sn = sin(angle);
    PetscReal       z[8], largest = 0;

    for (int moved = 0; moved < 2; moved++) {
      uint64_t    rng = seed * 12345;
      Chain       nonmortar, mortar;
      ContactPair pair;

      RandomPair(&rng, 8, 7, 0.03, &nonmortar, &mortar);
      for (int j = 0; j < 8; j++) z[j] = Random(&rng);
      nonmortar.mirror[0] = 1;
      if (moved) ChainMove(&nonmortar, angle, 0.3, -0.8);
      if (moved) ChainMove(&mortar, angle, 0.3, -0.8);
      EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, z, &pair, &s[moved]);
      CHECK_CALL(ContactPairDestroy(&pair));
      ChainDestroy(&nonmortar);
      ChainDestroy(&mortar);
    }
    for (int j = 0; j < 8; j++) largest = PetscMax(largest, PetscAbsReal(s[0].gap[j]));
    for (int j = 0; j < 8; j++) {
      worst = PetscMax(worst, PetscAbsReal(s[0].gap[j] - s[1].gap[j]) / largest);
      worst = PetscMax(worst, PetscAbsReal(s[0].weight[j] - s[1].weight[j]));
    }
    for (PetscInt i = 0; i < s[0].size; i += 2) {
      assert_near(cs * s[0].gradient[i] - sn * s[0].gradient[i + 1], s[1].gradient[i], 1e-12);
      assert_near(sn * s[0].gradient[i] + cs * s[0].gradient[i + 1], s[1].gradient[i + 1], 1e-12);
    }
    SumDestroy(&s[0]);
    SumDestroy(&s[1]);
  }
  print_message("rigid motion: gt and w change by %.1e\n", worst);
  assert_true(worst < 1e-13);
}

/* O-103: a straight nonmortar edge and its two (or four) children carry the same weighted gap and the same weights: the sum of gt_j, which is the integral of
   the gap, and w of the parent's nodes as the hats of the parent combine the children's. Mortar face bent, non-matching, cover whole or partial. */
static void ParentAndChildren(void **state)
{
  PetscReal worst_gap = 0, worst_weight = 0;

  for (uint64_t seed = 1; seed <= 40; seed++) {
    const PetscReal left = seed % 2 ? -0.2 : 0.31, tilt = 0.05 * (PetscReal)(seed % 5);
    PetscReal       gap[3] = {0, 0, 0}, weight[3] = {0, 0, 0};

    for (int level = 0; level < 3; level++) {
      const PetscInt nodes  = (1 << level) + 1;
      uint64_t       random = seed;
      Chain          nonmortar, mortar;
      ContactPair    pair;
      Sum            sum;

      ChainLine(&nonmortar, nodes, 1, tilt, 0, 0);
      ChainLine(&mortar, 6, left, 0.4, 1.2, 0.4);
      for (PetscInt i = 0; i < 12; i++) mortar.x[i] += 0.03 * Random(&random);
      EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 1, NULL, &pair, &sum);
      for (PetscInt j = 0; j < nodes; j++) {
        gap[level] += sum.gap[j];
        weight[level] += sum.weight[j];
      }
      CHECK_CALL(ContactPairDestroy(&pair));
      SumDestroy(&sum);
      ChainDestroy(&nonmortar);
      ChainDestroy(&mortar);
    }
    assert_true(gap[0] > 1e-3);
    for (int level = 1; level < 3; level++) {
      worst_gap    = PetscMax(worst_gap, PetscAbsReal(gap[level] / gap[0] - 1));
      worst_weight = PetscMax(worst_weight, PetscAbsReal(weight[level] - weight[0]));
    }
  }
  print_message("parent and children: weighted gap differs by %.1e, weights by %.1e\n", worst_gap, worst_weight);
  assert_true(worst_gap < 1e-12 && worst_weight < 1e-12);
}

CONTACT_TEST_MAIN("contact: gaps, balance, invariance", cmocka_unit_test(ParallelFaces), cmocka_unit_test(ConstantPressure), cmocka_unit_test(Quadrature),
                  cmocka_unit_test(Balance), cmocka_unit_test(RigidMotion), cmocka_unit_test(ParentAndChildren))
