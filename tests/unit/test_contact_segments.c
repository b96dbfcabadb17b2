/* Segments: covered length, ends that touch, vertices on rays, degenerate edges; along curved non-matching surfaces neither gaps nor overlaps. */
#include "contactfixture.h"

static void Segments(Chain *nonmortar, Chain *mortar, ContactPair *pair, PetscInt *num, const ContactSegment **s)
{
  Sum sum;

  EvaluateOnce(nonmortar, mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, pair, &sum);
  assert_false(sum.failed);
  ContactPairGetSegments(*pair, num, s);
  SumDestroy(&sum);
}

static void Cleanup(Chain *nonmortar, Chain *mortar, ContactPair *pair)
{
  CHECK_CALL(ContactPairDestroy(pair));
  ChainDestroy(nonmortar);
  ChainDestroy(mortar);
}

/* One edge of length 2 (xi = -(x - 1)), mortar from a to b in num edges: covered from max(a, 0) to min(b, 2). */
static void CheckCover(PetscReal a, PetscReal b, PetscInt num)
{
  const PetscReal       covered = PetscMax(0, PetscMin(b, 2) - PetscMax(a, 0));
  Chain                 nonmortar, mortar;
  ContactPair           pair;
  const ContactSegment *s;
  PetscInt              n;
  PetscReal             length = 0, lo = 1, hi = -1;

  ChainLine(&nonmortar, 2, 2, 0, 0, 0);
  ChainLine(&mortar, num + 1, a, 0.1, b, 0.1);
  Segments(&nonmortar, &mortar, &pair, &n, &s);
  for (PetscInt i = 0; i < n; i++) {
    assert_true(s[i].xi[1][0] > s[i].xi[0][0]);
    length += s[i].xi[1][0] - s[i].xi[0][0];
    lo = PetscMin(lo, s[i].xi[0][0]);
    hi = PetscMax(hi, s[i].xi[1][0]);
  }
  assert_near(length, covered, 1e-14);
  if (covered > 0) {
    assert_near(lo, 1 - PetscMin(b, 2), 1e-14);
    assert_near(hi, 1 - PetscMax(a, 0), 1e-14);
  } else
    assert_int_equal(n, 0);
  Cleanup(&nonmortar, &mortar, &pair);
}

static void CoveredLength(void **state)
{
  CheckCover(-1, 3, 1);
  CheckCover(-1, 3, 7);
  CheckCover(0.3, 1.1, 3);
  CheckCover(-0.5, 0.7, 5);
  CheckCover(1.9, 4, 2);
  CheckCover(2, 4, 2);  /* ends touch: no segment */
  CheckCover(-2, 0, 1); /* ends touch on the other side */
  CheckCover(2.5, 4, 1);
}

/* Matching meshes, also turned: every mortar vertex lies on a nonmortar node's ray up to rounding. One segment per edge, bounds exactly the ends. */
static void VertexOnRay(void **state)
{
  for (int turn = 0; turn < 12; turn++) {
    Chain                 nonmortar, mortar;
    ContactPair           pair;
    const ContactSegment *s;
    PetscInt              n;

    ChainLine(&nonmortar, 8, 1, 0, 0, 0);
    ChainLine(&mortar, 8, 0, 0.07, 1, 0.07);
    ChainMove(&nonmortar, 0.37 * turn, 3, 2);
    ChainMove(&mortar, 0.37 * turn, 3, 2);
    Segments(&nonmortar, &mortar, &pair, &n, &s);
    assert_int_equal(n, 7);
    for (PetscInt i = 0; i < n; i++) {
      assert_true(s[i].xi[0][0] == -1 && s[i].xi[1][0] == 1);
      assert_int_equal(s[i].mortar_facet, 6 - s[i].facet);
    }
    Cleanup(&nonmortar, &mortar, &pair);
  }
}

/* A mortar edge without length sees nothing and disturbs nothing; a nonmortar edge without length is a numerical status. */
static void Degenerate(void **state)
{
  Chain                 nonmortar, mortar;
  ContactPair           pair;
  Sum                   sum;
  const ContactSegment *s;
  PetscInt              n;
  PetscReal             length = 0;

  ChainLine(&nonmortar, 2, 1, 0, 0, 0);
  ChainLine(&mortar, 4, -1, 0.1, 2, 0.1);
  mortar.x[4] = mortar.x[2] = 0.4;
  EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, &pair, &sum);
  ContactPairGetSegments(pair, &n, &s);
  assert_false(sum.failed);
  assert_int_equal(n, 2);
  for (PetscInt i = 0; i < n; i++) length += s[i].xi[1][0] - s[i].xi[0][0];
  assert_near(length, 2, 1e-14);
  nonmortar.x[0] = 0;
  SumEvaluate(&sum, pair, &nonmortar, &mortar, NULL, PETSC_FALSE, PETSC_FALSE);
  assert_true(sum.failed);
  nonmortar.x[0] = 1;
  mortar.x[1]    = NAN; /* neither may a position that is no number pass in silence */
  SumEvaluate(&sum, pair, &nonmortar, &mortar, NULL, PETSC_FALSE, PETSC_FALSE);
  assert_true(sum.failed);
  SumDestroy(&sum);
  Cleanup(&nonmortar, &mortar, &pair);
}

/* A hollow of three edges, whose rays cross 0.7 above it: what lies beyond has no picture there, and that is told. Below nothing is lost. */
static void Lost(void **state)
{
  for (int beyond = 0; beyond < 2; beyond++) {
    const PetscReal z[4] = {0};
    Chain           nonmortar, mortar;
    ContactPair     pair;
    Sum             sum;
    PetscInt        lost;

    ChainCreate(&nonmortar, 4, PETSC_FALSE);
    memcpy(nonmortar.x, (const PetscReal[8]){0.5, 0.2, 0.2, 0, -0.2, 0, -0.5, 0.2}, 8 * sizeof(PetscReal));
    ChainLine(&mortar, 4, -0.3, beyond ? 2 : 0.1, 0.3, beyond ? 2 : 0.1);
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 3, z, &pair, &sum);
    lost = ContactPairGetDegenerate(pair);
    print_message("%s the crossing: %d lost, area %g\n", beyond ? "beyond" : "before", (int)lost, (double)sum.area);
    assert_true(beyond ? lost > 0 : lost == 0 && sum.area > 0.4);
    SumDestroy(&sum);
    Cleanup(&nonmortar, &mortar, &pair);
  }
}

/* x_s + s d lies on the mortar edge at eta. */
static void CheckProjection(const Chain *nonmortar, const Chain *mortar, const ContactSegment *s)
{
  for (int k = 0; k < 2; k++) {
    PetscReal x[2] = {0, 0}, n[2] = {0, 0}, m[2] = {0, 0};

    for (int v = 0; v < 2; v++) {
      const PetscReal N = 0.5 * (1 + (2 * v - 1) * s->xi[k][0]), M = 0.5 * (1 + (2 * v - 1) * s->eta[k][0]);
      const PetscInt  a = nonmortar->edges[2 * s->facet + v], b = mortar->edges[2 * s->mortar_facet + v];
      PetscReal       d[2];

      ChainDirection(nonmortar, s->facet, v, d);
      for (int i = 0; i < 2; i++) {
        x[i] += N * nonmortar->x[2 * a + i];
        n[i] += N * d[i];
        m[i] += M * mortar->x[2 * b + i];
      }
    }
    assert_near(n[0] * (m[1] - x[1]) - n[1] * (m[0] - x[0]), 0, 1e-13);
    assert_true(PetscAbsReal(s->eta[k][0]) < 1 + 1e-12);
  }
}

/* The covered part of the chain is one interval without seams: each segment starts in the very number where the one before stops. */
static void CheckSeams(PetscInt num, const ContactSegment *s)
{
  for (PetscInt i = 1; i < num; i++) {
    if (s[i].facet == s[i - 1].facet)
      assert_true(s[i].xi[0][0] == s[i - 1].xi[1][0]);
    else {
      assert_int_equal(s[i].facet, s[i - 1].facet + 1);
      assert_true(s[i - 1].xi[1][0] == 1 && s[i].xi[0][0] == -1);
    }
    assert_true(s[i].mortar_facet == s[i - 1].mortar_facet || s[i].mortar_facet == s[i - 1].mortar_facet - 1);
    assert_near(s[i].mortar_facet == s[i - 1].mortar_facet ? s[i].eta[0][0] - s[i - 1].eta[1][0] : s[i].eta[0][0] - 1 - (s[i - 1].eta[1][0] + 1), 0, 1e-8);
  }
}

static int Along(const void *a, const void *b)
{
  const ContactSegment *s = a, *t = b;

  if (s->facet != t->facet) return s->facet < t->facet ? -1 : 1;
  return (s->xi[0][0] > t->xi[0][0]) - (s->xi[0][0] < t->xi[0][0]);
}

static void RandomSurfaces(void **state)
{
  PetscInt total = 0;

  for (uint64_t seed = 1; seed <= 400; seed++) {
    uint64_t              rng = seed * 77777;
    Chain                 nonmortar, mortar;
    ContactPair           pair;
    const ContactSegment *s;
    ContactSegment       *sorted;
    PetscInt              n;

    RandomPair(&rng, 5 + (PetscInt)(seed % 9), 4 + (PetscInt)(seed % 13), 0.04, &nonmortar, &mortar);
    ChainMove(&nonmortar, (PetscReal)seed, 0, 0);
    ChainMove(&mortar, (PetscReal)seed, 0, 0);
    Segments(&nonmortar, &mortar, &pair, &n, &s);
    assert_true(n > 0);
    sorted = memcpy(malloc((size_t)n * sizeof(*s)), s, (size_t)n * sizeof(*s));
    qsort(sorted, (size_t)n, sizeof(*s), Along);
    CheckSeams(n, sorted);
    for (PetscInt i = 0; i < n; i++) CheckProjection(&nonmortar, &mortar, &s[i]);
    free(sorted);
    total += n;
    Cleanup(&nonmortar, &mortar, &pair);
  }
  print_message("400 random pairs, %d segments\n", (int)total);
}

CONTACT_TEST_MAIN("contact: segments", cmocka_unit_test(CoveredLength), cmocka_unit_test(VertexOnRay), cmocka_unit_test(Degenerate), cmocka_unit_test(Lost),
                  cmocka_unit_test(RandomSurfaces))
