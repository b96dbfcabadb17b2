/* First derivatives of gt_j and w_j and the Hessian of sum_j z_j gt_j against fourth-order central differences, random states (case O-94): what
   test_contact_ray has not. */
#include "contactfixture.h"

enum { NN = 6, NM = 7 };

typedef struct {
  PetscBool axisymmetric, nts, folded, closed, barely;
  PetscReal gap, radius;
} Kind;

typedef struct {
  PetscReal gradient, weight, hessian, symmetry; /* largest relative errors */
  PetscInt  columns, kinks;                      /* unknowns tried; those whose differences reach over a change of who sees whom */
} Errors;

/* Who sees whom: changes mark a kink. */
static uint64_t Signature(ContactPair pair)
{
  const ContactSegment *s;
  PetscInt              num;
  uint64_t              hash = 1469598103934665603ULL;

  ContactPairGetSegments(pair, &num, &s);
  for (PetscInt i = 0; i < num; i++) hash = (hash ^ (uint64_t)(s[i].facet * 1000 + s[i].mortar_facet)) * 1099511628211ULL;
  return hash;
}

/* Put the mortar side's last node 0.05 above nonmortar node 2 along its normal and 2e-3 ahead: the edge (1, 2) is covered by about 1 % only. */
static void CoverBarely(const Chain *nonmortar, Chain *mortar)
{
  const PetscReal *x    = nonmortar->x;
  PetscReal        m[2] = {0, 0};

  for (int e = 1; e < 3; e++) {
    const PetscReal t[2] = {x[2 * e + 2] - x[2 * e], x[2 * e + 3] - x[2 * e + 1]}, length = hypot(t[0], t[1]);

    m[0] += t[1] / length;
    m[1] -= t[0] / length;
  }
  for (int i = 0; i < 2; i++) mortar->x[2 * NM - 2 + i] = x[4 + i] + 0.05 * m[i] / hypot(m[0], m[1]) + (i ? 0 : 2e-3);
  for (PetscInt k = 0; k < NM - 1; k++) mortar->x[2 * k] = -0.1 + (mortar->x[2 * NM - 2] + 0.05) * (PetscReal)k / (NM - 1);
}

static void MakePair(const Kind *kind, uint64_t *seed, Chain *nonmortar, Chain *mortar)
{
  PetscReal angle = kind->axisymmetric ? 0.3 * Random(seed) : 3 * Random(seed);

  RandomPair(seed, NN, NM, kind->gap, nonmortar, mortar);
  if (kind->barely) CoverBarely(nonmortar, mortar);
  if (kind->closed) { /* a triangle, top edge first: each node's two neighbours are the other two */
    ChainDestroy(nonmortar);
    ChainCreate(nonmortar, 3, PETSC_TRUE);
    memcpy(nonmortar->x, (const PetscReal[6]){1, 0, 0, 0.02, 0.5 + 0.2 * Random(seed), -0.6}, 6 * sizeof(PetscReal));
  }
  if (kind->folded) { /* pull the middle node of the mortar side back over its neighbour */
    mortar->x[2 * 3] -= 0.3;
    mortar->x[2 * 3 + 1] += 0.05;
  }
  ChainMove(nonmortar, angle, kind->radius, 0.2);
  ChainMove(mortar, angle, kind->radius, 0.2);
}

static void Compare(Errors *err, const Sum *exact, const PetscReal gap[4][NN], const PetscReal weight[4][NN], PetscReal *const gradient[4], PetscInt i,
                    PetscReal h, const PetscReal scale[3])
{
  for (PetscInt j = 0; j < exact->nn; j++) {
    const PetscReal g[4] = {gap[0][j], gap[1][j], gap[2][j], gap[3][j]}, w[4] = {weight[0][j], weight[1][j], weight[2][j], weight[3][j]};

    err->gradient = PetscMax(err->gradient, PetscAbsReal(Difference(g, h) - exact->dgap[j * exact->size + i]) / scale[0]);
    err->weight   = PetscMax(err->weight, PetscAbsReal(Difference(w, h) - exact->dweight[j * exact->size + i]) / scale[1]);
  }
  for (PetscInt k = 0; k < exact->size; k++) {
    const PetscReal d[4] = {gradient[0][k], gradient[1][k], gradient[2][k], gradient[3][k]};

    err->hessian  = PetscMax(err->hessian, PetscAbsReal(Difference(d, h) - exact->hessian[k * exact->size + i]) / scale[2]);
    err->symmetry = PetscMax(err->symmetry, PetscAbsReal(exact->hessian[i * exact->size + k] - exact->hessian[k * exact->size + i]) / scale[2]);
  }
}

static void CheckSeed(const Kind *kind, uint64_t seed, Errors *err)
{
  const PetscReal h = 2e-5;
  Chain           nonmortar, mortar;
  ContactPair     pair;
  Sum             exact, moved[4];
  PetscReal       z[NN], gap[4][NN], weight[4][NN], *gradient[4], scale[3];
  uint64_t        signature;

  MakePair(kind, &seed, &nonmortar, &mortar);
  for (int j = 0; j < NN; j++) z[j] = Random(&seed);
  ChainReference(&nonmortar);
  ChainReference(&mortar);
  PairCreate(kind->axisymmetric, kind->nts, &pair);
  SearchAll(pair, &nonmortar, &mortar, 0.6, 1e-3);
  SumCreate(&exact, nonmortar.s.num_nodes, NM);
  SumEvaluate(&exact, pair, &nonmortar, &mortar, z, PETSC_TRUE, PETSC_TRUE);
  signature = Signature(pair);
  assert_false(exact.failed);
  assert_true(exact.num >= (kind->closed ? 1 : NN / 2));
  scale[0] = Largest(exact.dgap, exact.nn * exact.size);
  scale[1] = PetscMax(1e-3, Largest(exact.dweight, exact.nn * exact.size));
  scale[2] = Largest(exact.hessian, exact.size * exact.size);
  for (int m = 0; m < 4; m++) SumCreate(&moved[m], exact.nn, NM);
  for (PetscInt i = 0; i < exact.size; i++) {
    PetscReal *x = Unknown(&nonmortar, &mortar, i), x0 = *x;
    PetscBool  kink = PETSC_FALSE;

    for (int m = 0; m < 4; m++) {
      *x = x0 + (m < 2 ? m - 2 : m - 1) * h;
      SumEvaluate(&moved[m], pair, &nonmortar, &mortar, z, PETSC_TRUE, PETSC_FALSE);
      if (Signature(pair) != signature) kink = PETSC_TRUE;
      memcpy(gap[m], moved[m].gap, (size_t)exact.nn * sizeof(PetscReal));
      memcpy(weight[m], moved[m].weight, (size_t)exact.nn * sizeof(PetscReal));
      gradient[m] = moved[m].gradient;
    }
    *x = x0;
    err->columns++;
    err->kinks += kink;
    if (!kink) Compare(err, &exact, gap, weight, gradient, i, h, scale);
  }
  for (int m = 0; m < 4; m++) SumDestroy(&moved[m]);
  SumDestroy(&exact);
  CHECK_CALL(ContactPairDestroy(&pair));
  ChainDestroy(&nonmortar);
  ChainDestroy(&mortar);
}

static int part = 3; /* of the seeds a third; with -slow all */

static void CheckKind(const char *name, const Kind *kind, int all)
{
  Errors    worst = {0};
  const int seeds = all / part;

  for (int i = 0; i < seeds; i++) {
    Errors err = {0};

    CheckSeed(kind, 1000 + (uint64_t)i * 7919, &err);
    if (err.gradient > 1e-6 || err.weight > 1e-6 || err.hessian > 1e-6)
      print_message("%s, seed %d: gradient %.1e weight %.1e hessian %.1e\n", name, i, err.gradient, err.weight, err.hessian);
    worst.gradient = PetscMax(worst.gradient, err.gradient);
    worst.weight   = PetscMax(worst.weight, err.weight);
    worst.hessian  = PetscMax(worst.hessian, err.hessian);
    worst.symmetry = PetscMax(worst.symmetry, err.symmetry);
    worst.columns += err.columns;
    worst.kinks += err.kinks;
  }
  print_message("%-28s %d seeds: gradient %.1e, weight %.1e, Hessian %.1e, asymmetry %.1e, %d of %d columns at kinks\n", name, seeds, worst.gradient,
                worst.weight, worst.hessian, worst.symmetry, (int)worst.kinks, (int)worst.columns);
  assert_true(worst.kinks * 100 <= worst.columns);
  assert_true(worst.gradient < 1e-6);
  assert_true(worst.weight < 1e-6);
  assert_true(worst.hessian < 1e-6);
  assert_true(worst.symmetry < 1e-14);
}

static void Axisymmetric(void **state)
{
  CheckKind("axisymmetric", &(Kind){.gap = 0.02, .axisymmetric = PETSC_TRUE, .radius = 0.7}, 60);
}

static void Folded(void **state)
{
  CheckKind("folded mortar side", &(Kind){.gap = 0.05, .folded = PETSC_TRUE}, 60);
}

static void BarelyCovered(void **state)
{
  CheckKind("an edge covered by 1 %", &(Kind){.gap = 0.05, .barely = PETSC_TRUE}, 60);
}

static void Closed(void **state)
{
  CheckKind("closed nonmortar triangle", &(Kind){.gap = 0.05, .closed = PETSC_TRUE}, 30);
}

static void NodeToSegment(void **state)
{
  CheckKind("node to segment", &(Kind){.gap = 0.03, .nts = PETSC_TRUE}, 60);
  CheckKind("node to segment, axisymmetric", &(Kind){.gap = 0.03, .nts = PETSC_TRUE, .axisymmetric = PETSC_TRUE, .radius = 0.7}, 60);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Axisymmetric), cmocka_unit_test(Folded), cmocka_unit_test(Closed), cmocka_unit_test(BarelyCovered),
                                     cmocka_unit_test(NodeToSegment)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (argc > 1 && !strcmp(argv[1], "-slow")) part = 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
