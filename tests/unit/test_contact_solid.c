/* Three-dimensional mortar contact: derivatives against differences on random warped, tilted, partly covered pairs (case O-94), exact sums, rigid motion. */
#include "solidfixture.h"

enum { NS = 3, NM = 4, SEEDS = 56, STRIDE = 8 }; /* of a seed every eighth column: seven seeds of each kind for every column */

typedef struct {
  PetscBool standard, partly, sliver; /* sliver: the mortar side ends just beyond lines of the other */
} Kind;

typedef struct {
  PetscReal gradient, weight, force, hessian, symmetry;
  PetscInt  columns, kinks, springs;
} Errors;

static void MakePair(const Kind *kind, uint64_t *seed, Sheet *nonmortar, Sheet *mortar)
{
  const PetscReal axis[3] = {Random(seed), Random(seed), Random(seed)}, shift[3] = {Random(seed), Random(seed), Random(seed)}, angle = 3 * Random(seed);
  const PetscReal curve = 0.1 * Random(seed), turn[3] = {0.2 * Random(seed), 0.2 * Random(seed), 1}, none[3] = {0, 0, 0}, small = kind->sliver ? 0.1 : 1;

  SheetCreate(nonmortar, NS, NS, 0, 1, 0, PETSC_TRUE);
  SheetCreate(mortar, NM, NM, kind->partly ? 0.27 : -0.3, kind->sliver ? 0.345 : kind->partly ? 1.4 : 1.3, 0.03, PETSC_FALSE);
  SheetMove(mortar, turn, 0.4 * small * Random(seed), none);
  for (int k = 0; k < 2; k++) {
    Sheet *c = k ? mortar : nonmortar;

    for (PetscInt n = 0; n < c->s.num_nodes; n++) {
      PetscReal *x = c->x + 3 * n;

      x[2] += curve * (x[0] * x[0] + x[0] * x[1]) + 0.02 * Random(seed);
      x[0] += 0.05 * small * Random(seed);
      x[1] += 0.05 * small * Random(seed);
    }
    SheetMove(c, axis, angle, shift);
  }
}

/* Who sees whom, and how many corners: changes mark a kink. */
static uint64_t Signature(ContactPair pair)
{
  const ContactSegment *s;
  PetscInt              num;
  uint64_t              hash = 1469598103934665603ULL;

  CHECK_CALL(ContactPairGetSegments(pair, &num, &s));
  for (PetscInt i = 0; i < num; i++) hash = (hash ^ (uint64_t)(s[i].facet * 100000 + s[i].mortar_facet * 10 + s[i].num)) * 1099511628211ULL;
  return hash;
}

static void CheckColumn(Errors *err, const Sum *exact, const Sum moved[4], PetscInt i, PetscReal h, const PetscReal scale[4])
{
  const PetscReal S[4] = {moved[0].S, moved[1].S, moved[2].S, moved[3].S};

  err->force = PetscMax(err->force, PetscAbsReal(Difference(S, h) - exact->gradient[i]) / scale[3]);
  for (PetscInt j = 0; j < exact->nn; j++) {
    PetscReal g[4], w[4];

    for (int m = 0; m < 4; m++) g[m] = moved[m].gap[j], w[m] = moved[m].weight[j];
    err->gradient = PetscMax(err->gradient, PetscAbsReal(Difference(g, h) - exact->dgap[j * exact->size + i]) / scale[0]);
    err->weight   = PetscMax(err->weight, PetscAbsReal(Difference(w, h) - exact->dweight[j * exact->size + i]) / scale[1]);
  }
  for (PetscInt k = 0; k < exact->size; k++) {
    PetscReal d[4];

    for (int m = 0; m < 4; m++) d[m] = moved[m].gradient[k];
    err->hessian  = PetscMax(err->hessian, PetscAbsReal(Difference(d, h) - exact->hessian[k * exact->size + i]) / scale[2]);
    err->symmetry = PetscMax(err->symmetry, PetscAbsReal(exact->hessian[i * exact->size + k] - exact->hessian[k * exact->size + i]) / scale[2]);
  }
}

static void CheckSeed(const Kind *kind, uint64_t seed, PetscInt first, Errors *err)
{
  const PetscReal   h = 1e-5, step[4] = {-2, -1, 1, 2};
  const ContactSpec spec = {.standard = kind->standard};
  Sheet             nonmortar, mortar;
  ContactPair       pair;
  Sum               exact, moved[4];
  PetscReal         z[(NS + 1) * (NS + 1)], X[3 * (NS + 1) * (NS + 1)], softness[(NS + 1) * (NS + 1)], scale[4];
  uint64_t          signature;

  MakePair(kind, &seed, &nonmortar, &mortar);
  for (int j = 0; j < nonmortar.s.num_nodes; j++) z[j] = Random(&seed);
  for (int j = 0; j < nonmortar.s.num_nodes; j++) softness[j] = 0.5 + 0.1 * Random(&seed);
  memcpy(X, nonmortar.x, sizeof(X));
  nonmortar.s.X = X;
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  if (kind->sliver) CHECK_CALL(ContactPairSetSoftness(pair, softness));
  SearchAll(pair, &nonmortar, &mortar, 0.5, 1e-3);
  SumCreate(&exact, nonmortar.s.num_nodes, mortar.s.num_nodes);
  SumEvaluate(&exact, pair, &nonmortar, &mortar, z, PETSC_TRUE);
  signature = Signature(pair);
  assert_false(exact.failed);
  assert_true(exact.num >= (kind->sliver ? 1 : NS));
  scale[0] = Largest(exact.dgap, exact.nn * exact.size);
  scale[1] = Largest(exact.dweight, exact.nn * exact.size);
  scale[2] = Largest(exact.hessian, exact.size * exact.size);
  scale[3] = Largest(exact.gradient, exact.size);
  err->springs += exact.springs;
  for (int m = 0; m < 4; m++) SumCreate(&moved[m], exact.nn, exact.nm);
  for (PetscInt i = first; i < exact.size; i += STRIDE) {
    PetscReal *x = i < 3 * exact.nn ? nonmortar.x + i : mortar.x + i - 3 * exact.nn, x0 = *x;
    PetscBool  kink = PETSC_FALSE;

    for (int m = 0; m < 4; m++) {
      *x = x0 + step[m] * h;
      SumEvaluate(&moved[m], pair, &nonmortar, &mortar, z, PETSC_FALSE);
      if (Signature(pair) != signature) kink = PETSC_TRUE;
    }
    *x = x0;
    err->columns++;
    if (kink)
      err->kinks++;
    else
      CheckColumn(err, &exact, moved, i, h, scale);
  }
  for (int m = 0; m < 4; m++) SumDestroy(&moved[m]);
  SumDestroy(&exact);
  SheetDestroy(&nonmortar);
  SheetDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

static void CheckKind(const Kind *kind, PetscInt seeds, PetscReal tolerance)
{
  Errors err = {0};

  for (PetscInt s = 0; s < seeds; s++) CheckSeed(kind, 1000003u * (uint64_t)(s + 1), s % STRIDE, &err);
  print_message(
      "standard %d, partly covered %d, compliances %d: gradient %.1e, weight %.1e, force %.1e, Hessian %.1e, symmetry %.1e; %d of %d columns over a kink\n",
      kind->standard, kind->partly, (int)err.springs, err.gradient, err.weight, err.force, err.hessian, err.symmetry, (int)err.kinks, (int)err.columns);
  assert_true(err.kinks < err.columns / 10);
  assert_true((err.springs > seeds) == kind->sliver);
  assert_true(err.force < tolerance);
  assert_true(err.gradient < tolerance);
  assert_true(err.weight < tolerance);
  assert_true(err.hessian < tolerance);
  assert_true(err.symmetry < 1e-12);
}

static void test_standard(void **state)
{
  (void)state;
  CheckKind(&(Kind){PETSC_TRUE, PETSC_FALSE, PETSC_FALSE}, SEEDS, 1e-7);
  CheckKind(&(Kind){PETSC_TRUE, PETSC_TRUE, PETSC_FALSE}, SEEDS, 1e-7);
}

static void test_dual(void **state)
{
  (void)state;
  CheckKind(&(Kind){PETSC_FALSE, PETSC_FALSE, PETSC_FALSE}, SEEDS, 1e-7);
  CheckKind(&(Kind){PETSC_FALSE, PETSC_TRUE, PETSC_FALSE}, SEEDS, 1e-7);
}

/* Compliances of constraints that slivers hold are part of what the forces derive from. */
static void test_sliver(void **state)
{
  (void)state;
  CheckKind(&(Kind){PETSC_FALSE, PETSC_FALSE, PETSC_TRUE}, SEEDS, 1e-6);
}

/* A mortar facet pushed in at a corner until it is not convex: counted, left out, nothing fails. */
static void test_unusable(void **state)
{
  const ContactSpec   spec = {.standard = PETSC_FALSE};
  const ContactFacet *facets;
  Sheet               nonmortar, mortar;
  ContactPair         pair;
  PetscInt            num, unusable;
  PetscReal           area[2];
  PetscBool           failed;

  (void)state;
  SheetCreate(&nonmortar, 2, 2, 0, 1, 0, PETSC_TRUE);
  SheetCreate(&mortar, 2, 2, 0, 1, 0.01, PETSC_FALSE);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.5, 0.3);
  for (int folded = 0; folded < 2; folded++) {
    if (folded) mortar.x[0] = mortar.x[1] = 0.35; /* beyond the diagonal of its facet */
    CHECK_CALL(ContactPairEvaluate(pair, &nonmortar.s, &mortar.s, NULL, NULL, PETSC_TRUE, PETSC_FALSE, &num, &facets, &failed));
    CHECK_CALL(ContactPairGetDegenerate(pair, &unusable));
    assert_false(failed);
    assert_int_equal(unusable > 0, folded);
    area[folded] = 0;
    for (PetscInt i = 0; i < num; i++) area[folded] += facets[i].area;
  }
  assert_near(area[0], 1, 1e-12);
  assert_near(area[1], 0.75, 1e-12);
  SheetDestroy(&nonmortar);
  SheetDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

/* One nonmortar facet below a mortar facet of its size, and nearer ones of the given width side by side in between. Area that is covered. */
static PetscReal CoveredBehind(PetscInt num, PetscReal width)
{
  const ContactSpec   spec = {.standard = PETSC_FALSE};
  const ContactFacet *facets;
  Sheet               nonmortar, mortar;
  ContactPair         pair;
  PetscInt            n;
  PetscReal           area = 0;
  PetscBool           failed;

  SheetCreate(&nonmortar, 1, 1, 0, 1, 0, PETSC_TRUE);
  SheetCreate(&mortar, num + 2, 1, 0, 1, 0.03, PETSC_FALSE); /* facet 0: the large one; 1: none; the rest: the nearer ones */
  mortar.x[3] = mortar.x[3 * (num + 4)] = 1;
  for (PetscInt k = 0; k <= num; k++) {
    PetscReal *low = mortar.x + 3 * (2 + k), *high = mortar.x + 3 * (num + 5 + k);

    low[0] = high[0] = 0.3 + width * (PetscReal)k;
    low[1]           = 0.3;
    high[1]          = 0.3 + width * (PetscReal)num;
    low[2] = high[2] = 0.02;
  }
  memmove(mortar.facets + 4, mortar.facets + 8, (size_t)(4 * num) * sizeof(PetscInt));
  mortar.s.num_facets = num + 1;
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.5, 0.3);
  CHECK_CALL(ContactPairEvaluate(pair, &nonmortar.s, &mortar.s, NULL, NULL, PETSC_TRUE, PETSC_FALSE, &n, &facets, &failed));
  assert_false(failed);
  for (PetscInt i = 0; i < n; i++) area += facets[i].area;
  SheetDestroy(&nonmortar);
  SheetDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
  return area;
}

/* What lies behind something tiny still counts; what lies behind many small ones that hide a good part of it does not. */
static void test_behind(void **state)
{
  (void)state;
  assert_near(CoveredBehind(1, 0.05), 1 + 0.05 * 0.05, 1e-12);
  assert_near(CoveredBehind(3, 0.05), 1 + 0.15 * 0.15, 1e-12);
  assert_near(CoveredBehind(8, 0.05), 0.4 * 0.4, 1e-12);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_standard), cmocka_unit_test(test_dual), cmocka_unit_test(test_unusable),
                                     cmocka_unit_test(test_sliver), cmocka_unit_test(test_behind)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
