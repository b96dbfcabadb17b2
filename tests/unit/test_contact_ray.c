/* Contact along a continuous direction: gradients and Hessians against differences with Richardson's extrapolation on random non-matching, tilted, curved,
   partly covered pairs of any order, compliant where they are, with and without lengths that are closed; balance of forces and moments; rigid motion. */
#include "rayfixture.h"

#define STEP 5e-5

typedef struct {
  PetscInt  dim, order, mortar; /* orders of both sides */
  PetscBool standard, partly;
  PetscInt  hanging; /* 1: on one facet of either side; 2: on two of the mortar side, whose sides are curved by a third of the width of fine facets (space) */
  PetscInt  mirror;  /* 1: planes of symmetry on two sides; 2: on all four of a single facet (space) */
  PetscBool ring;
} Kind;

typedef struct {
  PetscReal gradient, weight, hessian, symmetry, force, moment, motion, again;
  PetscInt  columns, kinks;
} Errors;

/* Planes x = 0 and, in space, y = 0, tilted a little; or four. In space the reference positions lie in them, so that their sides are known for such. */
static void MakePlanes(const Kind *kind, Patch *p)
{
  static const PetscReal Plane[2][2][3] = {{{0.995, 0, 0.0998749217771909}, {0.96, 0.28, 0}}, {{0, 1, 0}, {-0.28, 0.96, 0}}};
  const PetscInt         D              = kind->dim;

  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    PetscReal *m   = p->mirror + (D == 2 ? 2 : 6) * n;
    PetscInt   num = 0;

    if (D == 2 && p->u[2 * n] == 0) m[0] = 0.995, m[1] = 0.0998749217771909;
    for (int i = 0; i < 2 && D == 3; i++)
      for (int k = 0; k < kind->mirror; k++) {
        if (p->u[2 * n + i] == k) memcpy(m + 3 * num++, Plane[i][k], sizeof(Plane[i][k]));
      }
    for (int sweep = 0; sweep < 200; sweep++) /* of two planes, one after the other */
      for (int k = 0; k < num; k++) {
        PetscReal      *X     = p->X + 3 * n;
        const PetscInt  i     = m[3 * k] > 0.5 ? 0 : 1;
        const PetscReal at[3] = {i == 0 ? p->u[2 * n] : 0, i == 1 ? p->u[2 * n + 1] : 0, 0}, off = Dot3(m + 3 * k, X) - Dot3(m + 3 * k, at);

        for (int c = 0; c < 3; c++) X[c] -= off * m[3 * k + c];
      }
  }
}

static void MakePair(const Kind *kind, uint64_t *seed, Patch *nonmortar, Patch *mortar)
{
  const PetscInt         D = kind->dim, ns = D == 2 ? 4 : kind->mirror == 2 ? 1 : 2, nm = D == 2 ? 5 : 3;
  static const PetscBool Refined[9] = {[1] = PETSC_TRUE, [3] = PETSC_TRUE};
  const PetscReal        curve = 0.15 * Random(seed), bend = 0.1 * Random(seed), tilt = 0.1 * Random(seed), turn = 0.3 * Random(seed);

  /* nonmortar: outward +z (plane: +y), body below; in the plane that runs from right to left */
  PatchCreate(nonmortar, D, kind->order, ns, 0, 1, D == 2 ? PETSC_FALSE : PETSC_TRUE, (PetscBool)(kind->hanging == 1));
  if (kind->hanging == 2)
    PatchRefined(mortar, 3, kind->mortar, nm, kind->partly ? 0.31 : -0.35, kind->partly ? 1.4 : 1.35, PETSC_FALSE, Refined);
  else
    PatchCreate(mortar, D, kind->mortar, nm, kind->partly ? 0.31 : -0.35, kind->partly ? 1.4 : 1.35, D == 2 ? PETSC_TRUE : PETSC_FALSE,
                (PetscBool)(kind->hanging && D == 3));
  for (int side = 0; side < 2; side++) {
    Patch *p = side ? mortar : nonmortar;

    for (PetscInt n = 0; n < p->s.num_nodes; n++) {
      const PetscReal a = p->u[2 * n] - 0.5, b = p->u[2 * n + 1] - 0.5, noise = (side && kind->hanging == 2 ? 0.4 : 0.04) / (PetscReal)(p->order * p->order);
      PetscReal      *x = p->x + D * n, X[3];

      X[0] = side && D == 3 ? cos(turn) * a - sin(turn) * b : a;
      X[1] = side && D == 3 ? sin(turn) * a + cos(turn) * b : b;
      for (int c = 0; c < 2; c++) X[c] += 0.5 + noise * Random(seed);
      X[D - 1] = (side ? 0.03 + tilt * a : 0) + curve * (a * a + (D == 3 ? a * b : 0)) + bend * a * a * a + 0.4 * noise * Random(seed);
      if (kind->ring) X[0] += 0.7;
      for (PetscInt c = 0; c < D; c++) {
        x[c]            = X[c];
        p->X[D * n + c] = X[c] + 0.02 * Random(seed);
      }
    }
    PatchFollow(p);
  }
  if (kind->mirror) MakePlanes(kind, nonmortar);
}

static uint64_t Signature(ContactPair pair)
{
  const ContactSegment *s;
  PetscInt              num;
  uint64_t              hash = 1469598103934665603ULL;

  ContactPairGetSegments(pair, &num, &s);
  for (PetscInt i = 0; i < num; i++) {
    int end = 0;

    for (PetscInt k = 0; k < s[i].num; k++)
      for (int c = 0; c < 2; c++) end = 3 * end + (s[i].xi[k][c] < -1 + 1e-9 ? 1 : s[i].xi[k][c] > 1 - 1e-9 ? 2 : 0);
    hash = (hash ^ (uint64_t)(s[i].facet * 100000 + s[i].mortar_facet * 10 + s[i].num + 10000000LL * end)) * 1099511628211ULL;
  }
  return hash;
}

static void ColumnErrors(const Sum *exact, const Sum moved[4], PetscInt i, PetscReal h, const PetscReal scale[3], PetscReal error[4])
{
  error[0] = error[1] = error[2] = error[3] = 0;
  for (PetscInt j = 0; j < exact->nn; j++) {
    PetscReal g[4], w[4];

    for (int m = 0; m < 4; m++) g[m] = moved[m].gap[j], w[m] = moved[m].weight[j];
    error[0] = PetscMax(error[0], PetscAbsReal(Difference(g, h) - exact->dgap[j * exact->size + i]) / scale[0]);
    error[1] = PetscMax(error[1], PetscAbsReal(Difference(w, h) - exact->dweight[j * exact->size + i]) / scale[1]);
  }
  for (PetscInt k = 0; k < exact->size; k++) {
    PetscReal d[4];

    for (int m = 0; m < 4; m++) d[m] = moved[m].gradient[k];
    error[2] = PetscMax(error[2], PetscAbsReal(Difference(d, h) - exact->hessian[k * exact->size + i]) / scale[2]);
    error[3] = PetscMax(error[3], PetscAbsReal(exact->hessian[i * exact->size + k] - exact->hessian[k * exact->size + i]) / scale[2]);
  }
}

/* Sums of the gradient's forces and moments over both surfaces. */
static void CheckBalance(Errors *err, const Sum *s, const Patch *nonmortar, const Patch *mortar, PetscReal scale)
{
  const PetscInt D        = s->dim;
  PetscReal      force[3] = {0, 0, 0}, moment[3] = {0, 0, 0};

  for (PetscInt n = 0; n < s->nn + s->nm; n++) {
    const PetscReal *x = n < s->nn ? nonmortar->x + D * n : mortar->x + D * (n - s->nn), *g = s->gradient + D * n;
    PetscReal        v[3] = {x[0], x[1], D == 3 ? x[2] : 0}, f[3] = {g[0], g[1], D == 3 ? g[2] : 0}, m[3];

    Cross3(v, f, m);
    for (int c = 0; c < 3; c++) force[c] += f[c], moment[c] += m[c];
  }
  err->force  = PetscMax(err->force, Largest(force, 3) / scale);
  err->moment = PetscMax(err->moment, Largest(moment, 3) / scale);
}

static void CheckMotion(Errors *err, const Sum *s, ContactPair pair, Patch *nonmortar, Patch *mortar, const PetscReal z[], uint64_t *seed)
{
  const PetscReal axis[3] = {nonmortar->dim == 3 ? Random(seed) : 0, nonmortar->dim == 3 ? Random(seed) : 0, 1}, angle = 3 * Random(seed);
  const PetscReal shift[3] = {Random(seed), Random(seed), Random(seed)}, scale = Largest(s->weight, s->nn);
  Sum             turned;

  SumCreate(&turned, nonmortar, mortar);
  PatchMove(nonmortar, axis, angle, shift);
  PatchMove(mortar, axis, angle, shift);
  SumEvaluate(&turned, pair, nonmortar, mortar, z, PETSC_FALSE);
  for (PetscInt j = 0; j < s->nn; j++) {
    err->motion = PetscMax(err->motion, PetscAbsReal(turned.gap[j] - s->gap[j]) / scale);
    err->motion = PetscMax(err->motion, PetscAbsReal(turned.weight[j] - s->weight[j]) / scale);
  }
  SumDestroy(&turned);
}

static PetscReal Apart(const PetscReal a[], const PetscReal b[], PetscInt n)
{
  PetscReal most = 0;

  for (PetscInt i = 0; i < n; i++) most = PetscMax(most, PetscAbsReal(a[i] - b[i]));
  return most;
}

/* At the positions of the last evaluation results are completed: gaps, forces, tangents for other and for these multipliers, one after the other. */
static void CheckAgain(Errors *err, const Sum *s, ContactPair pair, Patch *nonmortar, Patch *mortar, const PetscReal z[], const PetscReal scale[3])
{
  PetscReal *other = calloc((size_t)nonmortar->s.num_nodes, sizeof(PetscReal));
  Sum        again;

  SumCreate(&again, nonmortar, mortar);
  for (PetscInt j = 0; j < nonmortar->s.num_nodes; j++) other[j] = -z[j];
  mortar->x[mortar->dim - 1] += 1e-3;
  SumEvaluate(&again, pair, nonmortar, mortar, z, PETSC_TRUE);
  mortar->x[mortar->dim - 1] -= 1e-3;
  SumSurfaces(&again, pair, &nonmortar->s, &mortar->s, z, PETSC_FALSE, PETSC_FALSE);
  SumEvaluate(&again, pair, nonmortar, mortar, z, PETSC_FALSE);
  SumEvaluate(&again, pair, nonmortar, mortar, other, PETSC_TRUE);
  SumEvaluate(&again, pair, nonmortar, mortar, z, PETSC_TRUE);
  err->again = PetscMax(err->again, Apart(s->gap, again.gap, s->nn) / Largest(s->weight, s->nn));
  err->again = PetscMax(err->again, Apart(s->dgap, again.dgap, s->nn * s->size) / scale[0]);
  err->again = PetscMax(err->again, Apart(s->dweight, again.dweight, s->nn * s->size) / scale[1]);
  err->again = PetscMax(err->again, Apart(s->hessian, again.hessian, s->size * s->size) / scale[2]);
  assert_int_equal(s->num, again.num);
  SumDestroy(&again);
  free(other);
}

static void CheckSeed(const Kind *kind, uint64_t seed, PetscInt first, PetscInt stride, Errors *err)
{
  const PetscReal   step[4] = {-2, -1, 1, 2};
  const ContactSpec spec    = {.standard = kind->standard};
  Patch             nonmortar, mortar;
  ContactPair       pair;
  Sum               exact, moved[4];
  PetscReal        *z, *softness, *closed, *stabilisation, scale[3];
  uint64_t          signature;
  PetscInt          columns;
  const PetscBool   closes = (PetscBool)(seed % 2 == 0), shares = (PetscBool)(seed % 3 == 0), stabilises = (PetscBool)(seed % 5 < 2);
  PetscBool        *shared;
  uint64_t          lengths = seed;

  MakePair(kind, &seed, &nonmortar, &mortar);
  CHECK_CALL(PetscMalloc4(nonmortar.s.num_nodes, &z, nonmortar.s.num_nodes, &softness, nonmortar.s.num_nodes, &closed, nonmortar.s.num_nodes, &shared));
  CHECK_CALL(PetscMalloc1(nonmortar.s.num_facets, &stabilisation));
  for (int f = 0; f < nonmortar.s.num_facets; f++) stabilisation[f] = 0.01 * f;
  for (int j = 0; j < nonmortar.s.num_nodes; j++) z[j] = Random(&seed);
  for (int j = 0; j < nonmortar.s.num_nodes; j++) softness[j] = 20 + 10 * Random(&seed); /* so that facets covered in part give as much as their gaps */
  CHECK_CALL(ContactPairCreate(kind->dim, kind->ring, &spec, &pair));
  for (int j = 0; j < nonmortar.s.num_nodes; j++) closed[j] = 0.1 * Random(&lengths);
  for (int j = 0; j < nonmortar.s.num_nodes; j++) shared[j] = (PetscBool)(j % 2);
  if (closes) ContactPairSetClosed(pair, closed);
  if (shares) ContactPairSetShared(pair, shared, PETSC_FALSE);
  if (!kind->hanging) ContactPairSetSoftness(pair, softness);
  if (stabilises) ContactPairSetStabilisation(pair, stabilisation);
  SearchAll(pair, &nonmortar, &mortar, 0.5, 1e-3);
  SumCreate(&exact, &nonmortar, &mortar);
  SumEvaluate(&exact, pair, &nonmortar, &mortar, z, PETSC_TRUE);
  signature = Signature(pair);
  assert_false(exact.failed);
  assert_true(exact.num >= (kind->mirror == 2 ? 1 : 2));
  scale[0] = Largest(exact.dgap, exact.nn * exact.size);
  scale[1] = Largest(exact.dweight, exact.nn * exact.size);
  scale[2] = Largest(exact.hessian, exact.size * exact.size);
  if (!kind->mirror && !kind->ring) CheckBalance(err, &exact, &nonmortar, &mortar, Largest(exact.gradient, exact.size));
  if (!kind->hanging) CheckAgain(err, &exact, pair, &nonmortar, &mortar, z, scale);
  for (int m = 0; m < 4; m++) SumCreate(&moved[m], &nonmortar, &mortar);
  columns = kind->dim * (nonmortar.num_true + mortar.num_true);
  for (PetscInt i = first; i < columns; i += stride) {
    const PetscBool own = (PetscBool)(i < kind->dim * nonmortar.num_true);
    Patch          *p   = own ? &nonmortar : &mortar;
    const PetscInt  k = own ? i : i - kind->dim * nonmortar.num_true, at = kind->dim * p->real[k / kind->dim] + k % kind->dim;
    const PetscReal x0       = p->x[at];
    PetscReal       least[4] = {1, 1, 1, 1};
    PetscBool       kink     = PETSC_FALSE;

    for (PetscReal h = STEP; h > STEP / 3000 && !kink && (least[0] > 2e-9 || least[1] > 2e-9 || least[2] > 2e-8);
         h /= 5) { /* corners move fast where lines meet at a small angle */
      PetscReal error[4];

      for (int m = 0; m < 4; m++) {
        p->x[at] = x0 + step[m] * h;
        PatchFollow(p);
        SumEvaluate(&moved[m], pair, &nonmortar, &mortar, z, PETSC_FALSE);
        if (Signature(pair) != signature) kink = PETSC_TRUE;
      }
      ColumnErrors(&exact, moved, (own ? 0 : kind->dim * exact.nn) + at, h, scale, error);
      for (int e = 0; e < 4; e++) least[e] = PetscMin(least[e], error[e]);
    }
    p->x[at] = x0;
    PatchFollow(p);
    err->columns++;
    if (kink) {
      err->kinks++;
      continue;
    }
    err->gradient = PetscMax(err->gradient, least[0]);
    err->weight   = PetscMax(err->weight, least[1]);
    err->hessian  = PetscMax(err->hessian, least[2]);
    err->symmetry = PetscMax(err->symmetry, least[3]);
  }
  if (!kind->ring) CheckMotion(err, &exact, pair, &nonmortar, &mortar, z, &seed);
  for (int m = 0; m < 4; m++) SumDestroy(&moved[m]);
  SumDestroy(&exact);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(PetscFree4(z, softness, closed, shared));
  CHECK_CALL(PetscFree(stabilisation));
  CHECK_CALL(ContactPairDestroy(&pair));
}

static PetscBool slow = PETSC_FALSE; /* all seeds */

static void CheckKind(const Kind *kind, PetscInt seeds, PetscInt stride)
{
  Errors err = {0};

  for (PetscInt s = 0; s < seeds; s++) CheckSeed(kind, 1000003u * (uint64_t)(s + 1), s % stride, stride, &err);
  print_message("%dD orders %d/%d %s%s%s%s%s: gradient %.1e, weight %.1e, Hessian %.1e, symmetry %.1e, force %.1e, moment %.1e, motion %.1e, again %.1e; %d of "
                "%d kinks\n",
                (int)kind->dim, (int)kind->order, (int)kind->mortar, kind->standard ? "standard" : "dual", kind->partly ? " partly" : "",
                kind->hanging == 2 ? " bent"
                : kind->hanging    ? " hanging"
                                   : "",
                kind->mirror == 2 ? " between mirrors"
                : kind->mirror    ? " mirror"
                                  : "",
                kind->ring ? " ring" : "", err.gradient, err.weight, err.hessian, err.symmetry, err.force, err.moment, err.motion, err.again, (int)err.kinks,
                (int)err.columns);
  assert_true(err.kinks < err.columns / 4);
  assert_true(err.gradient < 1e-8);
  assert_true(err.weight < 1e-8);
  assert_true(err.hessian < 1e-7);
  if (kind->dim == 2 || !kind->partly) assert_true(err.symmetry < 1e-12); /* else: rims are held */
  assert_true(err.force < 1e-12);
  assert_true(err.moment < 1e-12);
  assert_true(err.motion < 1e-12);
  assert_true(err.again < 1e-12);
}

static void test_plane(void **state)
{
  static const Kind Kinds[] = {{2, 1, 1, 1, 0, 0, 0, 0}, {2, 1, 1, 0, 1, 0, 1, 0}, {2, 1, 2, 0, 1, 0, 0, 1}, {2, 2, 2, 0, 0, 0, 1, 0}, {2, 2, 1, 0, 1, 0, 0, 1},
                               {2, 3, 3, 0, 1, 0, 1, 0}, {2, 3, 2, 0, 0, 0, 0, 1}, {2, 4, 4, 0, 1, 0, 0, 0}, {2, 4, 1, 0, 1, 0, 1, 1}};

  (void)state;
  for (size_t k = 0; k < sizeof(Kinds) / sizeof(Kinds[0]); k++) CheckKind(&Kinds[k], slow ? 50 : 18, 3);
}

static void test_space(void **state)
{
  static const Kind Kinds[] = {{3, 1, 1, 1, 0, 0, 0, 0}, {3, 1, 1, 0, 1, 0, 1, 0}, {3, 1, 1, 0, 1, 1, 0, 0}, {3, 1, 2, 0, 0, 1, 1, 0}, {3, 2, 2, 0, 0, 0, 1, 0},
                               {3, 2, 1, 0, 1, 1, 0, 0}, {3, 2, 3, 0, 1, 0, 1, 0}, {3, 3, 3, 0, 1, 0, 0, 0}, {3, 3, 2, 0, 0, 1, 1, 0}, {3, 1, 1, 0, 0, 0, 2, 0},
                               {3, 2, 2, 0, 0, 0, 2, 0}, {3, 2, 2, 0, 0, 2, 0, 0}, {3, 1, 2, 0, 1, 2, 0, 0}, {3, 2, 3, 0, 1, 2, 0, 0}};

  (void)state;
  for (size_t k = 0; k < sizeof(Kinds) / sizeof(Kinds[0]); k++) {
    const PetscBool large = (PetscBool)(Kinds[k].order + Kinds[k].mortar > 2);
    CheckKind(&Kinds[k], (large ? 14 : 50) / (slow ? 1 : 2), large ? 151 : 41);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_plane), cmocka_unit_test(test_space)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  slow   = (PetscBool)(argc > 1 && !strcmp(argv[1], "-slow"));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
