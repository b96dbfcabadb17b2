/* Search: same pairs as brute force, margin kept, layers told apart, large sliding, n log n, time. */
#include "contactfixture.h"
#include "contactimpl.h"
#include <time.h>

static void Cleanup(Chain *nonmortar, Chain *mortar, ContactPair *pair, Sum *s)
{
  CHECK_CALL(ContactPairDestroy(pair));
  ChainDestroy(nonmortar);
  ChainDestroy(mortar);
  SumDestroy(s);
}

/* Gap along the ray from parameter l of edge e to mortar edge m by solving x + s n = c + tau (d - c); false: not hit or not facing. */
static PetscBool Hit(const Chain *nonmortar, const Chain *mortar, PetscInt e, PetscReal l, PetscInt m, PetscReal *g)
{
  const PetscInt   a = nonmortar->edges[2 * e], b = nonmortar->edges[2 * e + 1];
  const PetscReal *c = &mortar->x[2 * mortar->edges[2 * m]], *d = &mortar->x[2 * mortar->edges[2 * m + 1]];
  const PetscReal *xa = &nonmortar->x[2 * a], *xb = &nonmortar->x[2 * b];
  const PetscReal  x[2] = {(1 - l) * xa[0] + l * xb[0], (1 - l) * xa[1] + l * xb[1]};
  PetscReal        na[2], nb[2];

  ChainDirection(nonmortar, e, 0, na);
  ChainDirection(nonmortar, e, 1, nb);
  const PetscReal n[2] = {(1 - l) * na[0] + l * nb[0], (1 - l) * na[1] + l * nb[1]};
  const PetscReal E[2] = {d[0] - c[0], d[1] - c[1]}, t[2] = {xb[0] - xa[0], xb[1] - xa[1]};
  const PetscReal det = -n[0] * E[1] + E[0] * n[1], r[2] = {c[0] - x[0], c[1] - x[1]};
  const PetscReal s = (-r[0] * E[1] + E[0] * r[1]) / det, tau = (n[0] * r[1] - n[1] * r[0]) / det;

  *g = s * hypot(n[0], n[1]);
  return tau >= 0 && tau <= 1 && t[0] * E[0] + t[1] * E[1] < -CONTACT_OPPOSE * hypot(t[0], t[1]) * hypot(E[0], E[1]) ? PETSC_TRUE : PETSC_FALSE;
}

/* Sample points of every edge: covered by a facing mortar edge within `distance` if and only if one is there; by the nearest. */
static void CheckBrute(Chain *nonmortar, Chain *mortar, PetscReal distance, uint64_t *rng, PetscInt *samples, PetscInt *covered)
{
  ContactPair           pair;
  Sum                   s;
  const ContactSegment *seg;
  PetscInt              num;

  EvaluateOnce(nonmortar, mortar, PETSC_FALSE, PETSC_FALSE, distance, NULL, &pair, &s);
  ContactPairGetSegments(pair, &num, &seg);
  for (PetscInt i = 0; i < 20 * nonmortar->s.num_facets; i++) {
    const PetscInt  e    = i / 20;
    const PetscReal l    = 0.5 + 0.499 * Random(rng);
    PetscInt        near = 0, all = 0, only = -1, got = -1;
    PetscReal       least = PETSC_MAX_REAL, g_got = 0;

    for (PetscInt m = 0; m < mortar->s.num_facets; m++) {
      PetscReal g;

      if (!Hit(nonmortar, mortar, e, l, m, &g)) continue;
      near += PetscAbsReal(g) < distance;
      least = PetscMin(least, PetscAbsReal(g));
      if (PetscAbsReal(g) < 2 * distance) all++, only = m;
    }
    for (PetscInt k = 0; k < num; k++)
      if (seg[k].facet == e && seg[k].xi[0][0] <= 2 * l - 1 && 2 * l - 1 <= seg[k].xi[1][0]) got = seg[k].mortar_facet;
    if (near > 0) assert_true(got >= 0);
    if (near > 0 && all == 1) assert_int_equal(got, only);
    if (all == 0) assert_int_equal(got, -1);
    if (got >= 0) (void)Hit(nonmortar, mortar, e, l, got, &g_got);
    if (got >= 0) assert_true(PetscAbsReal(g_got) < least + 1e-12);
    *covered += got >= 0;
    (*samples)++;
  }
  CHECK_CALL(ContactPairDestroy(&pair));
  SumDestroy(&s);
}

static void BruteForce(void **state)
{
  PetscInt samples = 0, covered = 0;

  for (uint64_t seed = 1; seed <= 60; seed++) {
    uint64_t rng = seed * 13;
    Chain    nonmortar, mortar;

    RandomPair(&rng, 20, 31, 0.05, &nonmortar, &mortar);
    for (PetscInt i = 0; i < 31; i++) mortar.x[2 * i + 1] += 0.1 * (1 + sin(9 * mortar.x[2 * i] + (PetscReal)seed)); /* partly out of reach */
    CheckBrute(&nonmortar, &mortar, 0.12, &rng, &samples, &covered);
    ChainDestroy(&nonmortar);
    ChainDestroy(&mortar);
  }
  print_message("%d samples, %d covered\n", (int)samples, (int)covered);
  assert_true(covered > samples / 4 && covered < samples * 9 / 10);
}

/* Candidates with a margin: nodes moved by up to the margin give, bit for bit, what a new search gives. */
static void Margin(void **state)
{
  for (uint64_t seed = 1; seed <= 40; seed++) {
    const PetscReal margin = 0.04;
    uint64_t        rng    = seed * 1717;
    Chain           nonmortar, mortar;
    ContactPair     pair, fresh;
    Sum             s, t;

    RandomPair(&rng, 9, 11, 0.03, &nonmortar, &mortar);
    PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
    SearchAll(pair, &nonmortar, &mortar, 0.5, margin);
    for (PetscInt i = 0; i < 2 * (9 + 11); i++) *Unknown(&nonmortar, &mortar, i) += margin / sqrt(2) * (i % 2 ? 0.2 : 1) * Random(&rng);
    SumCreate(&s, 9, 11);
    SumEvaluate(&s, pair, &nonmortar, &mortar, NULL, PETSC_TRUE, PETSC_FALSE);
    PairCreate(PETSC_FALSE, PETSC_FALSE, &fresh);
    SearchAll(fresh, &nonmortar, &mortar, 0.5, 0);
    SumCreate(&t, 9, 11);
    SumEvaluate(&t, fresh, &nonmortar, &mortar, NULL, PETSC_TRUE, PETSC_FALSE);
    for (int j = 0; j < 9; j++) assert_true(s.gap[j] == t.gap[j] && s.weight[j] == t.weight[j]);
    CHECK_CALL(ContactPairDestroy(&fresh));
    SumDestroy(&t);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

/* How many candidates a facet in the middle of 100 has below 100 others, `gap` away, nodes free to move by 5 facets. */
static PetscInt Sideways(PetscReal gap)
{
  const PetscInt *start, *candidate;
  PetscInt        num;
  Chain           nonmortar, mortar;
  ContactPair     pair;

  ChainLine(&nonmortar, 101, 1, 0, 0, 0);
  ChainLine(&mortar, 101, 0, gap, 1, gap);
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  SearchAll(pair, &nonmortar, &mortar, 0.5, 0.05);
  ContactPairGetCandidates(pair, &start, &candidate);
  num = start[51] - start[50];
  CHECK_CALL(ContactPairDestroy(&pair));
  ChainDestroy(&nonmortar);
  ChainDestroy(&mortar);
  return num;
}

/* Turning rays sway the more the longer they are: what is near is looked for nearby, whatever the search distance. */
static void Near(void **state)
{
  assert_in_range(Sideways(0), 21, 24); /* 2 margin = 10 facets to either side, the own one, ends */
  assert_in_range(Sideways(0.01), 41, 44);
  assert_int_equal(Sideways(0.1), 100);
}

/* Mortar: two thin closed bars above each other, all their sides listed. The near bar's near side is met, open or penetrated, never its far side
   nor the bar behind (which has the lower numbers). */
static void Layers(void **state)
{
  for (int k = 0; k < 4; k++) {
    const PetscReal       gap = (const PetscReal[]){0.02, 0, -0.004, -0.008}[k], thick = 0.01;
    Chain                 nonmortar, mortar;
    ContactPair           pair;
    Sum                   s;
    const ContactSegment *seg;
    PetscInt              num;

    ChainLine(&nonmortar, 12, 1, 0, 0, 0);
    ChainCreate(&mortar, 16, PETSC_TRUE);
    for (int bar = 0; bar < 2; bar++) /* bottom -0.2 .. 1.2 in three edges, then top backwards */
      for (int i = 0; i < 4; i++) {
        const PetscInt lower = 8 * bar + i, upper = 8 * bar + 7 - i;

        mortar.x[2 * lower] = mortar.x[2 * upper] = -0.2 + 1.4 * i / 3;
        mortar.x[2 * lower + 1]                   = gap + 0.03 * (1 - bar);
        mortar.x[2 * upper + 1]                   = gap + 0.03 * (1 - bar) + thick;
      }
    mortar.edges[2 * 7 + 1]  = 0;
    mortar.edges[2 * 15 + 1] = 8;
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, &pair, &s);
    ContactPairGetSegments(pair, &num, &seg);
    for (PetscInt i = 0; i < num; i++) assert_true(seg[i].mortar_facet >= 8 && seg[i].mortar_facet < 11);
    for (int j = 0; j < 12; j++) assert_near(s.gap[j], gap * s.weight[j], 1e-15);
    assert_near(s.area, 1, 1e-14);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

/* Mortar: two edges, the near one over 0.6 of the nonmortar edge, the far one behind it over `length` from 0.1 on, however little both cover in sum; or beside
   it over the rest. What is hidden is not met. */
static void Shoulder(void **state)
{
  for (int k = 0; k < 4; k++) {
    const PetscReal from = k == 3 ? 0.7 : 0.1, length = (const PetscReal[]){0.2, 0.4, 0.5, 0.2}[k], seen = k == 3 ? length : 0;
    Chain           nonmortar, mortar;
    ContactPair     pair;
    Sum             s;

    ChainLine(&nonmortar, 2, 1, 0, 0, 0);
    ChainCreate(&mortar, 4, PETSC_FALSE);
    mortar.s.num_facets = 2;
    mortar.edges[2] = 2, mortar.edges[3] = 3;
    mortar.x[2] = 0.6, mortar.x[4] = from, mortar.x[6] = from + length;
    mortar.x[1] = mortar.x[3] = 0.1, mortar.x[5] = mortar.x[7] = 0.3;
    ChainReference(&mortar);
    EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, &pair, &s);
    assert_near(s.area, 0.6 + seen, 1e-14);
    assert_near(s.gap[0] + s.gap[1], 0.1 * 0.6 + 0.3 * seen, 1e-14);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

/* Rays that a facet would meet at more than 72.5 degrees from its normal, it does not look for. */
static void Grazing(void **state)
{
  for (int steep = 0; steep < 2; steep++) {
    const PetscReal angle = (steep ? 75 : 70) * PETSC_PI / 180;
    const PetscInt *start, *candidate;
    Chain           nonmortar, mortar;
    ContactPair     pair;

    ChainLine(&nonmortar, 2, 1, 0, 0, 0);
    ChainLine(&mortar, 2, 0.5 - 0.5 * cos(angle), 0.1, 0.5 + 0.5 * cos(angle), 0.1 + sin(angle));
    PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
    SearchAll(pair, &nonmortar, &mortar, 2, 0.1);
    ContactPairGetCandidates(pair, &start, &candidate);
    assert_int_equal(start[1], steep ? 0 : 1);
    CHECK_CALL(ContactPairDestroy(&pair));
    ChainDestroy(&nonmortar);
    ChainDestroy(&mortar);
  }
}

/* How many candidates one facet has below another that lies at this angle to it. */
static PetscInt At(ContactPair pair, const Chain *nonmortar, PetscReal degrees)
{
  const PetscReal angle = degrees * PETSC_PI / 180;
  const PetscInt *start, *candidate;
  Chain           mortar;

  ChainLine(&mortar, 2, 0.5 - 0.5 * cos(angle), 0.1, 0.5 + 0.5 * cos(angle), 0.1 + sin(angle));
  SearchAll(pair, nonmortar, &mortar, 2, 0.1);
  ContactPairGetCandidates(pair, &start, &candidate);
  ChainDestroy(&mortar);
  return start[1];
}

/* What trial steps find depends on the iterate that they start from, not on trials before them: a pair of facets stays beyond 72.5 degrees though it was lost
   in between, and goes once an iterate without it was kept. */
static void Trials(void **state)
{
  Chain       nonmortar;
  ContactPair pair;

  ChainLine(&nonmortar, 2, 1, 0, 0, 0);
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  assert_int_equal(At(pair, &nonmortar, 75), 0);
  assert_int_equal(At(pair, &nonmortar, 70), 1);
  ContactPairGoOn(pair, PETSC_TRUE);
  assert_int_equal(At(pair, &nonmortar, 75), 1);
  assert_int_equal(At(pair, &nonmortar, 100), 0);
  assert_int_equal(At(pair, &nonmortar, 75), 1);
  assert_int_equal(At(pair, &nonmortar, 100), 0);
  ContactPairKeepSearch(pair);
  ContactPairKeepSearch(pair); /* nothing was looked for in between */
  assert_int_equal(At(pair, &nonmortar, 75), 0);
  CHECK_CALL(ContactPairDestroy(&pair));
  ChainDestroy(&nonmortar);
}

/* How many candidates the two flanks of a wedge of 90 degrees have below a facet that leans by this angle. */
static PetscInt Leans(ContactPair pair, const Chain *wedge, PetscReal degrees)
{
  const PetscReal c = cos(degrees * PETSC_PI / 180), s = sin(degrees * PETSC_PI / 180);
  const PetscInt *start, *candidate;
  Chain           mortar;

  ChainLine(&mortar, 2, -c, 0.1 - s, c, 0.1 + s);
  SearchAll(pair, wedge, &mortar, 2, 0.1);
  ContactPairGetCandidates(pair, &start, &candidate);
  ChainDestroy(&mortar);
  return start[2];
}

/* The flank that only grazes what the other one faces is left out, and in one solve stays so until it faces it more squarely than the other one: at 45 degrees
   gaps would jump at whatever iterate comes by. */
static void Grazes(void **state)
{
  Chain       wedge;
  ContactPair pair;

  ChainLine(&wedge, 3, 1, -1, -1, -1);
  wedge.x[3] = 0;
  ChainReference(&wedge);
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  assert_int_equal(Leans(pair, &wedge, 0.2), 2);
  assert_int_equal(Leans(pair, &wedge, 10), 1);
  ContactPairGoOn(pair, PETSC_TRUE);
  assert_int_equal(Leans(pair, &wedge, 0.2), 1);
  assert_int_equal(Leans(pair, &wedge, -0.2), 2);
  assert_int_equal(Leans(pair, &wedge, 0.2), 1);
  assert_int_equal(Leans(pair, &wedge, -0.2), 2);
  ContactPairKeepSearch(pair);
  assert_int_equal(Leans(pair, &wedge, 10), 2);
  CHECK_CALL(ContactPairDestroy(&pair));
  ChainDestroy(&wedge);
}

/* A groove with flanks at 45 degrees; in it facets of `turn` degrees each, joined to a nose or apart, the first with its normal 50 degrees left of downwards.
   How many of them the right flank has for candidates. */
static PetscInt InGroove(PetscInt num_facets, PetscReal turn, PetscBool joined)
{
  const PetscInt *start, *candidate;
  const PetscInt  apart = joined ? 1 : 2;
  PetscInt        num;
  Chain           nonmortar, mortar;
  ContactPair     pair;

  ChainLine(&nonmortar, 3, 1, 1, -1, 1);
  nonmortar.x[3] = 0;
  ChainReference(&nonmortar);
  ChainCreate(&mortar, joined ? num_facets + 1 : 2 * num_facets, PETSC_FALSE);
  mortar.s.num_facets = num_facets;
  for (PetscInt e = 0; e < num_facets; e++) {
    for (int k = 0; k < 2; k++) {
      const PetscReal angle = (-140 - 0.5 * turn + turn * (e + k)) * PETSC_PI / 180;
      const PetscInt  node  = apart * e + k;

      mortar.edges[2 * e + k] = node;
      mortar.x[2 * node]      = 0.6 * cos(angle);
      mortar.x[2 * node + 1]  = 1.2 + 0.6 * sin(angle);
    }
  }
  ChainReference(&mortar);
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  SearchAll(pair, &nonmortar, &mortar, 2, 0.1);
  ContactPairGetCandidates(pair, &start, &candidate);
  num = start[1];
  CHECK_CALL(ContactPairDestroy(&pair));
  ChainDestroy(&nonmortar);
  ChainDestroy(&mortar);
  return num;
}

/* What the other flank faces squarely this one drops, but not where a smooth surface goes on in it: normals are 95, 75, 55, 35, 15 and 5 degrees away. */
static void Groove(void **state)
{
  assert_int_equal(InGroove(6, 20, PETSC_TRUE), 4);
  assert_int_equal(InGroove(6, 20, PETSC_FALSE), 3);
}

/* A face of another body below one of this body: pressed into it by up to `distance` it is an overlap, farther down it is behind the body. The room that a
   margin gives for motion, here more than four times the distance, is none for overlaps. */
static void Behind(void **state)
{
  for (int k = 0; k < 4; k++) {
    const PetscReal gap = (const PetscReal[]){2, -0.49, -0.51, -2}[k];
    Chain           nonmortar, mortar;
    ContactPair     pair;
    Sum             s;

    ChainLine(&nonmortar, 51, 1, 0, 0, 0);
    ChainLine(&mortar, 9, 0, gap, 1, gap);
    PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
    SearchAll(pair, &nonmortar, &mortar, 0.5, 0.05);
    SumCreate(&s, 51, 9);
    SumEvaluate(&s, pair, &nonmortar, &mortar, NULL, PETSC_TRUE, PETSC_FALSE);
    assert_near(s.area, k < 2 ? 1 : 0, 1e-13);
    Cleanup(&nonmortar, &mortar, &pair, &s);
  }
}

/* A short block slides over a long one, ten times its length in 100 steps, search at every step: always fully covered at the exact gap. */
static void LargeSliding(void **state)
{
  Chain       nonmortar, mortar;
  ContactPair pair;
  Sum         s;

  ChainLine(&nonmortar, 9, 1, 0, 0, 0);
  ChainLine(&mortar, 190, -1, -0.01, 12.5, -0.01);
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  SumCreate(&s, 9, 190);
  for (int step = 0; step < 100; step++) {
    SearchAll(pair, &nonmortar, &mortar, 0.1, 0.02);
    ChainMove(&nonmortar, 0, 0.1, 0);
    SearchAll(pair, &nonmortar, &mortar, 0.1, 0.02);
    SumEvaluate(&s, pair, &nonmortar, &mortar, NULL, PETSC_TRUE, PETSC_FALSE);
    assert_near(s.area, 1, 1e-13);
    for (int j = 0; j < 9; j++) assert_near(s.gap[j], -0.01 * s.weight[j], 1e-13);
  }
  Cleanup(&nonmortar, &mortar, &pair, &s);
}

/* A rank without listed edges, and a mortar side without edges: no results, no failure. */
static void Empty(void **state)
{
  const ContactFacet   *edges;
  const ContactSegment *seg;
  Chain                 nonmortar, mortar;
  ContactPair           pair;
  PetscInt              num;
  PetscBool             failed;

  ChainLine(&nonmortar, 3, 1, 0, 0, 0);
  ChainLine(&mortar, 3, 0, 0.1, 1, 0.1);
  for (int k = 0; k < 2; k++) {
    PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
    if (k) mortar.s.num_facets = mortar.s.num_nodes = 0;
    if (k)
      SearchAll(pair, &nonmortar, &mortar, 0.5, 0.1);
    else
      CHECK_CALL(ContactPairSearch(pair, &nonmortar.s, &mortar.s, 0, NULL, 0.5, 0.1));
    CHECK_CALL(ContactPairEvaluate(pair, &nonmortar.s, &mortar.s, (const PetscReal[3]){0}, NULL, PETSC_TRUE, PETSC_TRUE, &num, &edges, &failed));
    assert_int_equal(num, 0);
    assert_false(failed);
    ContactPairGetSegments(pair, &num, &seg);
    assert_int_equal(num, 0);
    CHECK_CALL(ContactPairDestroy(&pair));
  }
  ChainDestroy(&nonmortar);
  ChainDestroy(&mortar);
}

/* Processor time of this process, in seconds: others may share the processor. */
static PetscLogDouble Now(void)
{
  struct timespec t;

  assert_int_equal(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t), 0);
  return (PetscLogDouble)t.tv_sec + 1e-9 * (PetscLogDouble)t.tv_nsec;
}

static void Wave(Chain *c, PetscReal height)
{
  for (PetscInt i = 0; i < c->s.num_nodes; i++) c->x[2 * i + 1] = height + 0.1 * sin(6 * c->x[2 * i]);
}

/* Seconds of the search (best of 3) for n nonmortar and about n mortar edges. */
static PetscLogDouble SearchTime(PetscInt n, ContactPair pair, Chain *nonmortar, Chain *mortar)
{
  PetscLogDouble best = 1e9;

  ChainLine(nonmortar, n + 1, 1, 0, 0, 0);
  ChainLine(mortar, n + n / 7, 0, 0, 1, 0);
  Wave(nonmortar, 0);
  Wave(mortar, 0.1 / (PetscReal)n);
  for (int k = 0; k < 3; k++) {
    const PetscLogDouble start = Now();

    SearchAll(pair, nonmortar, mortar, 2 / (PetscReal)n, 0.5 / (PetscReal)n);
    best = PetscMin(best, Now() - start);
  }
  return best;
}

/* 100 000 edges well below a second; 16 times the edges in much less than 16^2 times the time. Prints the cost of the evaluation. */
static void Time(void **state)
{
  PetscLogDouble t[2];
  PetscReal     *z;

  for (int k = 0; k < 2; k++) {
    const PetscInt        n = k ? 100000 : 6250;
    Chain                 nonmortar, mortar;
    ContactPair           pair;
    const ContactFacet   *edges;
    const ContactSegment *seg;
    PetscInt              num, num_seg;
    PetscBool             failed;

    PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
    t[k] = SearchTime(n, pair, &nonmortar, &mortar);
    print_message("search, %6d edges: %.3f s\n", (int)n, t[k]);
    z = malloc((size_t)(n + 1) * sizeof(PetscReal));
    for (PetscInt j = 0; j <= n; j++) z[j] = 1;
    for (int mode = 0; k == 0 && mode < 3; mode++) {
      PetscLogDouble best = 1e9;

      for (int r = 0; r < 2; r++) {
        const PetscLogDouble start = Now();

        mortar.x[0] += 1e-13; /* else the last results stand */
        CHECK_CALL(ContactPairEvaluate(pair, &nonmortar.s, &mortar.s, z, NULL, mode > 0, mode > 1, &num, &edges, &failed));
        best = PetscMin(best, Now() - start);
      }
      ContactPairGetSegments(pair, &num_seg, &seg);
      assert_int_equal(num, n);
      print_message("%-28s %.2f us per edge, %.2f us per segment\n",
                    (const char *const[]){"values:", "values + gradients:", "values + gradients + Hessian:"}[mode], 1e6 * best / (double)num,
                    1e6 * best / (double)num_seg);
    }
    free(z);
    CHECK_CALL(ContactPairDestroy(&pair));
    ChainDestroy(&nonmortar);
    ChainDestroy(&mortar);
  }
  assert_true(t[1] < 5);
  assert_true(t[1] < 60 * t[0]);
}

/* A bar 4 long between y0 and y1: its contour counterclockwise in edges of length 1, which go to the hull, too. */
static void Bar(Chain *c, PetscReal y0, PetscReal y1, PetscInt part, PetscInt *num, PetscInt *parts, PetscReal *X)
{
  ChainCreate(c, 10, PETSC_TRUE);
  for (PetscInt i = 0; i < 10; i++) c->x[2 * i] = i < 5 ? (PetscReal)i : (PetscReal)(9 - i), c->x[2 * i + 1] = i < 5 ? y0 : y1;
  ChainReference(c);
  for (PetscInt e = 0; e < 10; e++) {
    for (int k = 0; k < 4; k++) X[4 * *num + k] = c->x[2 * c->edges[2 * e + k / 2] + k % 2];
    parts[(*num)++] = part;
  }
}

/* A bar over a bar, whole contours, 0.1 apart or overlapping by 0.3 of their thickness of 1: the upper one's top faces the lower one's bottom, which lies 2.1
   or 1.7 deep, just like an overlap. With the hull it is dropped as a back face, near sides are found as ever. Inside the bars the hull measures what they do.
 */
static void FarSides(void **state)
{
  for (int overlap = 0; overlap < 2; overlap++) {
    const PetscReal top = overlap ? 0.3 : -0.1;
    PetscInt        num = 0, *parts = NULL;
    PetscReal      *X       = NULL;
    PetscInt        near[2] = {0, 0}, far[2] = {0, 0}, facet[2] = {0, 0};
    ContactHull     hull;
    ContactPair     pair;
    Chain           upper, lower;

    CHECK_CALL(PetscMalloc1(20, &parts));
    CHECK_CALL(PetscMalloc1(80, &X));
    Bar(&upper, 0, 1, 0, &num, parts, X);
    Bar(&lower, top - 1, top, 1, &num, parts, X);
    CHECK_CALL(ContactHullCreate(2, num, parts, X, &hull));
    for (int k = 0; k < 2; k++) {
      const PetscReal from[2] = {1.3, k ? top : 0}, along[2] = {0.6, k ? -0.8 : 0.8};

      assert_true(PetscAbsReal(ContactHullAcross(hull, k, from, along, 10) - 1.25) < 1e-14);
      assert_true(ContactHullAcross(hull, k, from, along, 1) == 1);
    }
    {
      const PetscReal from[2] = {0, 0}, inward[2] = {0.6, 0.8}, outward[2] = {-0.6, 0.8}; /* from a corner; out of it, beside the bar, nothing is measured */

      assert_true(PetscAbsReal(ContactHullAcross(hull, 0, from, inward, 10) - 1.25) < 1e-14);
      assert_true(ContactHullAcross(hull, 0, from, outward, 10) == 0);
    }
    for (int with = 0; with < 2; with++) {
      PetscInt part[2][10];

      for (int e = 0; e < 10; e++) part[0][e] = 0, part[1][e] = 1;
      PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
      if (with) ContactPairSetHull(pair, hull, part[0], part[1], 0);
      SearchAll(pair, &upper, &lower, 3, 0.3);
      const PetscInt *start, *candidate;
      ContactPairGetCandidates(pair, &start, &candidate);
      for (PetscInt i = 0; i < 10; i++)
        for (PetscInt k = start[i]; k < start[i + 1]; k++) {
          facet[0] = i, facet[1] = candidate[k];
          near[with] += facet[0] < 4 && facet[1] > 4 && facet[1] < 9; /* bottom of the upper bar, top of the lower one */
          far[with] += facet[0] > 4 && facet[0] < 9 && facet[1] < 4;
        }
      CHECK_CALL(ContactPairDestroy(&pair));
    }
    print_message("overlap %g: near %d %d, far %d %d\n", (double)top, (int)near[0], (int)near[1], (int)far[0], (int)far[1]);
    assert_true(near[0] == near[1] && near[0] >= 4);
    assert_true(far[0] >= 4 && far[1] == 0);
    CHECK_CALL(ContactHullDestroy(&hull));
    ChainDestroy(&upper);
    ChainDestroy(&lower);
  }
}

/* A block [0, 2] x [y0, y0 + 1]: its contour counterclockwise in edges of length 1/4, which go to the hull, too. */
static void Block(Chain *c, PetscReal y0, PetscInt part, PetscInt *num, PetscInt *parts, PetscReal *X)
{
  ChainCreate(c, 24, PETSC_TRUE);
  for (PetscInt i = 0; i < 24; i++) {
    c->x[2 * i]     = 0.25 * (PetscReal)(i < 8 ? i : i < 12 ? 8 : i < 20 ? 20 - i : 0);
    c->x[2 * i + 1] = y0 + 0.25 * (PetscReal)(i < 8 ? 0 : i < 12 ? i - 8 : i < 20 ? 4 : 24 - i);
  }
  for (PetscInt e = 0; e < 24; e++) {
    for (int k = 0; k < 4; k++) X[4 * *num + k] = c->x[2 * c->edges[2 * e + k / 2] + k % 2];
    parts[(*num)++] = part;
  }
  ChainReference(c);
}

/* A block on a block, moved by half its length and pressed in by 0.5: through the strip in which they overlap its left side, upright, sees the other's right
   one, 1 deep in blocks 2 long; but the short way out is up. Its bottom sees the other's top. */
static void Strip(void **state)
{
  PetscInt        num = 0, seen = 0, *parts = NULL, part[2][24];
  PetscReal      *X = NULL;
  const PetscInt *start, *candidate;
  ContactHull     hull;
  ContactPair     pair;
  Chain           upper, lower;

  CHECK_CALL(PetscMalloc1(48, &parts));
  CHECK_CALL(PetscMalloc1(192, &X));
  Block(&upper, 0, 0, &num, parts, X);
  Block(&lower, -1, 1, &num, parts, X);
  CHECK_CALL(ContactHullCreate(2, num, parts, X, &hull));
  for (int e = 0; e < 24; e++) part[0][e] = 0, part[1][e] = 1;
  ChainMove(&upper, 0, 1, -0.5);
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  ContactPairSetHull(pair, hull, part[0], part[1], 2);
  SearchAll(pair, &upper, &lower, 1, 0.01);
  ContactPairGetCandidates(pair, &start, &candidate);
  assert_int_equal(start[24] - start[20], 0); /* the left side */
  for (PetscInt i = 1; i < 3; i++)
    for (PetscInt k = start[i]; k < start[i + 1]; k++) seen += candidate[k] >= 12 && candidate[k] < 20;
  assert_true(seen >= 2); /* the bottom, but for its ends */
  CHECK_CALL(ContactPairDestroy(&pair));
  CHECK_CALL(ContactHullDestroy(&hull));
  ChainDestroy(&upper);
  ChainDestroy(&lower);
}

/* An angle section of thickness 1, its contour in edges of length 1, whose upright limb bends a little to either side. Facets of the contour, which may meet
   itself, see nothing through their own limb: not at the re-entrant corner (1, 1) either, behind which there is body whichever of its two facets a ray starts
   from. How many pairs of a facet there and one of the outer side of the same limb are candidates. */
static PetscInt ThroughLimb(PetscReal bend)
{
  static const PetscReal place[20][2] = {{0, 0}, {1.2, 0}, {2.2, 0}, {3.2, 0}, {4.2, 0}, {5, 0}, {5, 1},   {4, 1},   {3, 1},   {2, 1},
                                         {1, 1}, {1, 2},   {1, 3},   {1, 4},   {1, 5},   {0, 5}, {0, 4.2}, {0, 3.2}, {0, 2.2}, {0, 1.2}};
  PetscInt              *parts = NULL, part[20] = {0}, through = 0;
  PetscReal             *X = NULL;
  const PetscInt        *start, *candidate;
  ContactHull            hull;
  ContactPair            pair;
  Chain                  section;

  CHECK_CALL(PetscCalloc1(20, &parts));
  CHECK_CALL(PetscMalloc1(80, &X));
  ChainCreate(&section, 20, PETSC_TRUE);
  for (PetscInt i = 0; i < 20; i++)
    for (int c = 0; c < 2; c++) section.x[2 * i + c] = place[i][c];
  for (PetscInt e = 0; e < 20; e++)
    for (int k = 0; k < 4; k++) X[4 * e + k] = section.x[2 * section.edges[2 * e + k / 2] + k % 2];
  ChainReference(&section);
  CHECK_CALL(ContactHullCreate(2, 20, parts, X, &hull));
  for (PetscInt i = 0; i < 20; i++) section.x[2 * i] -= bend * PetscSqr(place[i][1]), section.x[2 * i + 1] += bend * place[i][0] * place[i][1];
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  ContactPairSetHull(pair, hull, part, part, 1);
  SearchAll(pair, &section, &section, 2, 0.01);
  ContactPairGetCandidates(pair, &start, &candidate);
  for (PetscInt i = 6; i < 14; i++)
    for (PetscInt k = start[i]; k < start[i + 1]; k++) through += i < 10 ? candidate[k] < 5 : candidate[k] > 14;
  CHECK_CALL(ContactPairDestroy(&pair));
  CHECK_CALL(ContactHullDestroy(&hull));
  ChainDestroy(&section);
  return through;
}

static void Limb(void **state)
{
  const PetscReal bend[] = {-0.05, -1e-3, -1e-6, 0, 1e-6, 1e-3, 0.05};

  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(bend); k++) assert_int_equal(ThroughLimb(bend[k]), 0);
}

/* A wedge of 67 degrees, its flanks in pieces of 0.05, whose tip is this deep in a flat bottom: does the flank beside the tip see it? Its last ray leaves the
   wedge at the tip; rays from beside the tip would run along the other flank, and the bottom be taken for a side beside them. */
static PetscBool TipSees(PetscReal depth)
{
  static const PetscReal corner[4][2] = {{0.4, -0.4}, {0, 0}, {-0.1, -0.25}, {0, -0.8}};
  static const PetscInt  pieces[4] = {11, 5, 1, 1}, tip = 11;
  PetscInt              *parts = NULL, part[2][18], num = 0, n = 0;
  PetscReal             *X = NULL;
  const PetscInt        *start, *candidate;
  ContactHull            hull;
  ContactPair            pair;
  Chain                  wedge, bar;
  PetscBool              sees = PETSC_FALSE;

  for (int e = 0; e < 18; e++) part[0][e] = 0, part[1][e] = 1;
  CHECK_CALL(PetscMalloc1(28, &parts));
  CHECK_CALL(PetscMalloc1(112, &X));
  Bar(&bar, -0.5, 0.5, 1, &num, parts, X);
  ChainMove(&bar, 0, -2, 0.5);
  for (PetscInt k = 0; k < 40; k++) X[k] += k % 2 ? 0.5 : -2;
  ChainReference(&bar);
  ChainCreate(&wedge, 18, PETSC_TRUE);
  for (PetscInt s = 0; s < 4; s++)
    for (PetscInt k = 0; k < pieces[s]; k++, n++)
      for (int c = 0; c < 2; c++) wedge.x[2 * n + c] = corner[s][c] + (corner[(s + 1) % 4][c] - corner[s][c]) * (PetscReal)k / (PetscReal)pieces[s];
  ChainReference(&wedge);
  for (PetscInt e = 0; e < 18; e++) {
    for (int k = 0; k < 4; k++) X[4 * num + k] = wedge.x[2 * wedge.edges[2 * e + k / 2] + k % 2];
    parts[num++] = 0;
  }
  CHECK_CALL(ContactHullCreate(2, num, parts, X, &hull));
  ChainMove(&wedge, -0.08, 0.7, depth);
  PairCreate(PETSC_FALSE, PETSC_FALSE, &pair);
  ContactPairSetHull(pair, hull, part[0], part[1], 1);
  SearchAll(pair, &wedge, &bar, 0.5, 1e-5);
  ContactPairGetCandidates(pair, &start, &candidate);
  for (PetscInt k = start[tip - 1]; k < start[tip]; k++) sees = (PetscBool)(sees || candidate[k] == 2);
  CHECK_CALL(ContactPairDestroy(&pair));
  CHECK_CALL(ContactHullDestroy(&hull));
  ChainDestroy(&wedge);
  ChainDestroy(&bar);
  return sees;
}

static void Tip(void **state)
{
  for (PetscReal depth = 1e-4; depth < 0.02; depth *= 1.5) assert_true(TipSees(depth));
}

CONTACT_TEST_MAIN("contact: search", cmocka_unit_test(BruteForce), cmocka_unit_test(Margin), cmocka_unit_test(Near), cmocka_unit_test(Groove),
                  cmocka_unit_test(Layers), cmocka_unit_test(Shoulder), cmocka_unit_test(Behind), cmocka_unit_test(Grazing), cmocka_unit_test(Trials),
                  cmocka_unit_test(Grazes), cmocka_unit_test(FarSides), cmocka_unit_test(Strip), cmocka_unit_test(Limb), cmocka_unit_test(Tip),
                  cmocka_unit_test(LargeSliding), cmocka_unit_test(Empty), cmocka_unit_test(Time))
