/* Friction in space: forces by tangential tractions and their derivatives against differences, balance of forces and moments at any positions, slip since
   points were kept with its gradient, rigid motion of both sides, slip over many facets. Random pairs that do not match, curved, with hanging nodes and planes
   of symmetry, covered in part. */
#include "rayfixture.h"

#define STEP 2e-5 /* and less, where derivatives jump nearby */

typedef struct {
  PetscInt  order, mortar;
  PetscBool standard, partly, hanging, mirror, frozen, linear; /* linear: surfaces without lattices */
} Kind;

static void MakeSide(const Kind *kind, PetscInt side, uint64_t *seed, const PetscReal shape[4], Patch *p)
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal a = p->u[2 * n] - 0.5, b = p->u[2 * n + 1] - 0.5, noise = 0.04 / (PetscReal)(p->order * p->order), turn = side ? 0.3 * shape[3] : 0;
    PetscReal      *x = p->x + 3 * n;

    x[0] = 0.5 + cos(turn) * a - sin(turn) * b + noise * Random(seed);
    x[1] = 0.5 + sin(turn) * a + cos(turn) * b + noise * Random(seed);
    x[2] = (side ? 0.03 + 0.1 * shape[2] * a : 0) + 0.15 * shape[0] * (a * a + a * b) + 0.1 * shape[1] * a * a * a + 0.4 * noise * Random(seed);
    if (side == 0 && kind->mirror && p->u[2 * n] == 0) p->mirror[6 * n] = 0.995, p->mirror[6 * n + 2] = 0.0998749217771909;
    for (int c = 0; c < 3; c++) p->X[3 * n + c] = x[c] + 0.02 * Random(seed);
  }
  PatchFollow(p);
  if (kind->linear) p->s.order = NULL, p->s.first = p->s.lattice = NULL;
}

static void MakePair(const Kind *kind, uint64_t *seed, Patch *nonmortar, Patch *mortar)
{
  const PetscReal shape[4] = {Random(seed), Random(seed), Random(seed), Random(seed)};

  PatchCreate(nonmortar, 3, kind->order, 2, 0, 1, PETSC_TRUE, kind->hanging);
  PatchCreate(mortar, 3, kind->mortar, 3, kind->partly ? 0.31 : -0.35, kind->partly ? 1.4 : 1.35, PETSC_FALSE, kind->hanging);
  MakeSide(kind, 0, seed, shape, nonmortar);
  MakeSide(kind, 1, seed, shape, mortar);
}

/* Forces of z and of the traction, with the Hessian, in a Sum. */
static void Forces(Sum *s, ContactPair pair, const Patch *a, const Patch *b, const PetscReal z[], const PetscReal traction[], PetscBool hessian)
{
  const ContactFacet *facets;
  PetscInt            num;
  PetscBool           failed;

  SumReset(s);
  CHECK_CALL(ContactPairEvaluate(pair, &a->s, &b->s, z, NULL, PETSC_TRUE, hessian, &num, &facets, &failed));
  assert_false(failed);
  for (PetscInt i = 0; i < num; i++) SumAdd(s, &facets[i], z);
  for (PetscInt i = 0; i < num; i++)
    for (PetscInt j = 0; j < 2 * facets[i].num_rows; j++) {
      const PetscReal q = traction[s->nn * (j / facets[i].num_rows) + facets[i].nodes[j % facets[i].num_rows]];

      for (PetscInt k = 0; k < 3 * facets[i].num; k++) s->gradient[SumRow(s, &facets[i], k)] += q * facets[i].shear[j * 3 * facets[i].num + k];
    }
}

/* Slip along both axes slip[2][nn], its gradient [2 nn][size] (NULL: not wanted), the weights. */
static void Slip(const Sum *s, ContactPair pair, const Patch *a, const Patch *b, PetscReal slip[], PetscReal gradient[], PetscReal weight[])
{
  const ContactFacet *facets;
  PetscInt            num;

  memset(slip, 0, 2 * (size_t)s->nn * sizeof(PetscReal));
  memset(weight, 0, (size_t)s->nn * sizeof(PetscReal));
  CHECK_CALL(ContactPairSlip(pair, &a->s, &b->s, NULL, &num, &facets));
  for (PetscInt i = 0; i < num; i++)
    for (PetscInt j = 0; j < 2 * facets[i].num_rows; j++) {
      const PetscInt row = s->nn * (j / facets[i].num_rows) + facets[i].nodes[j % facets[i].num_rows];

      slip[row] += facets[i].gap[j];
      if (j < facets[i].num_rows) weight[row] += facets[i].weight[j];
      for (PetscInt k = 0; k < 3 * facets[i].num && gradient; k++)
        gradient[row * s->size + SumRow(s, &facets[i], k)] += facets[i].dgap[j * 3 * facets[i].num + k];
    }
}

typedef struct {
  PetscReal tangent, slip, force, moment, motion;
  PetscInt  kinks;
} Errors;

/* Which facets meet, and how: derivatives jump where that changes. */
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

static void CheckBalance(const Sum *s, const Patch *a, const Patch *b, Errors *e)
{
  const PetscReal scale    = Largest(s->gradient, s->size);
  PetscReal       force[3] = {0, 0, 0}, moment[3] = {0, 0, 0};

  for (PetscInt n = 0; n < s->nn + s->nm; n++) {
    const PetscReal *x = n < s->nn ? a->x + 3 * n : b->x + 3 * (n - s->nn), *g = s->gradient + 3 * n;
    PetscReal        m[3];

    Cross3(x, g, m);
    for (int c = 0; c < 3; c++) force[c] += g[c], moment[c] += m[c];
  }
  e->force  = PetscMax(e->force, Largest(force, 3) / scale);
  e->moment = PetscMax(e->moment, Largest(moment, 3) / scale);
}

/* Forces, slip and their derivatives at these positions. */
typedef struct {
  Sum        sum;
  PetscReal *slip, *gradient, *weight;
  uint64_t   signature;
} Here;

static void HereCreate(ContactPair pair, const Patch *a, const Patch *b, const PetscReal z[], const PetscReal traction[], Here *at)
{
  SumCreate(&at->sum, a, b);
  at->slip     = calloc(2 * (size_t)at->sum.nn, sizeof(PetscReal));
  at->weight   = calloc((size_t)at->sum.nn, sizeof(PetscReal));
  at->gradient = calloc((size_t)(2 * at->sum.nn * at->sum.size), sizeof(PetscReal));
  Forces(&at->sum, pair, a, b, z, traction, PETSC_TRUE);
  at->signature = Signature(pair);
  Slip(&at->sum, pair, a, b, at->slip, at->gradient, at->weight);
}

static void HereDestroy(Here *at)
{
  SumDestroy(&at->sum);
  free(at->slip), free(at->gradient), free(at->weight);
}

/* Derivatives along one direction of all positions, by differences with step h. */
static void Derivatives(ContactPair pair, Patch *a, Patch *b, const PetscReal z[], const PetscReal traction[], const PetscReal direction[], PetscReal h,
                        const Here *exact, Errors *e)
{
  static const PetscReal At[4]   = {-2, -1, 1, 2};
  Patch                 *side[2] = {a, b};
  const PetscInt         nn = exact->sum.nn, size = exact->sum.size;
  PetscReal             *from[2], *slip[4], tangent = 0, error = 0, scale[2] = {0, 0};
  PetscBool              kink = PETSC_FALSE;
  Sum                    moved[4];

  for (int k = 0; k < 2; k++) {
    from[k] = malloc(3 * (size_t)side[k]->s.num_nodes * sizeof(PetscReal));
    memcpy(from[k], side[k]->x, 3 * (size_t)side[k]->s.num_nodes * sizeof(PetscReal));
  }
  for (int m = 0; m < 4; m++) {
    for (int k = 0; k < 2; k++) {
      for (PetscInt i = 0; i < 3 * side[k]->s.num_nodes; i++) side[k]->x[i] = from[k][i] + At[m] * h * direction[(k ? 3 * nn : 0) + i];
      PatchFollow(side[k]);
    }
    SumCreate(&moved[m], a, b);
    Forces(&moved[m], pair, a, b, z, traction, PETSC_FALSE);
    kink    = (PetscBool)(kink || Signature(pair) != exact->signature);
    slip[m] = calloc(2 * (size_t)nn, sizeof(PetscReal));
    Slip(&exact->sum, pair, a, b, slip[m], NULL, exact->weight);
  }
  for (PetscInt i = 0; i < size; i++) {
    const PetscReal f[4] = {moved[0].gradient[i], moved[1].gradient[i], moved[2].gradient[i], moved[3].gradient[i]}, d = Difference(f, h);
    PetscReal       sum = 0;

    for (PetscInt k = 0; k < size; k++) sum += exact->sum.hessian[i * size + k] * direction[k];
    tangent = PetscMax(tangent, PetscAbsReal(sum - d)), scale[0] = PetscMax(scale[0], PetscAbsReal(d));
  }
  for (PetscInt j = 0; j < 2 * nn; j++) {
    const PetscReal f[4] = {slip[0][j], slip[1][j], slip[2][j], slip[3][j]}, d = Difference(f, h);
    PetscReal       sum = 0;

    for (PetscInt k = 0; k < size; k++) sum += exact->gradient[j * size + k] * direction[k];
    error = PetscMax(error, PetscAbsReal(sum - d)), scale[1] = PetscMax(scale[1], PetscAbsReal(d));
  }
  *e = (Errors){.tangent = tangent / scale[0], .slip = error / scale[1], .kinks = kink};
  for (int m = 0; m < 4; m++) SumDestroy(&moved[m]), free(slip[m]);
  for (int k = 0; k < 2; k++) memcpy(side[k]->x, from[k], 3 * (size_t)side[k]->s.num_nodes * sizeof(PetscReal)), free(from[k]);
}

static void CheckDerivatives(ContactPair pair, Patch *a, Patch *b, const PetscReal z[], const PetscReal traction[], uint64_t *seed, Errors *e)
{
  const PetscInt size      = 3 * (a->s.num_nodes + b->s.num_nodes);
  PetscReal     *direction = malloc((size_t)size * sizeof(PetscReal));
  Errors         least     = {.tangent = PETSC_MAX_REAL, .slip = PETSC_MAX_REAL}, at;
  Here           exact;

  HereCreate(pair, a, b, z, traction, &exact);
  for (PetscInt i = 0; i < size; i++) direction[i] = Random(seed);
  for (PetscReal h = STEP; h > STEP / 300 && least.tangent > 2e-9; h /= 5) {
    Derivatives(pair, a, b, z, traction, direction, h, &exact, &at);
    if (at.kinks) {
      least.kinks = 1;
      continue;
    }
    least.tangent = PetscMin(least.tangent, at.tangent), least.slip = PetscMin(least.slip, at.slip), least.kinks = 0;
  }
  HereDestroy(&exact);
  e->kinks += least.kinks;
  if (!least.kinks) e->tangent = PetscMax(e->tangent, least.tangent), e->slip = PetscMax(e->slip, least.slip);
  free(direction);
}

static void CheckMotion(ContactPair pair, Patch *a, Patch *b, uint64_t *seed, Errors *e)
{
  const PetscReal axis[3] = {Random(seed), Random(seed), Random(seed)}, shift[3] = {Random(seed), Random(seed), Random(seed)}, angle = 3 * Random(seed);
  const PetscReal no[3] = {0, 0, 0}, back[3] = {-shift[0], -shift[1], -shift[2]};
  PetscReal      *slip, *weight;
  Sum             s;

  SumCreate(&s, a, b);
  slip = calloc(2 * (size_t)s.nn, sizeof(PetscReal)), weight = calloc((size_t)s.nn, sizeof(PetscReal));
  PatchMove(a, axis, angle, shift), PatchMove(b, axis, angle, shift);
  Slip(&s, pair, a, b, slip, NULL, weight);
  e->motion = PetscMax(e->motion, Largest(slip, 2 * s.nn));
  PatchMove(a, axis, 0, back), PatchMove(b, axis, 0, back);
  PatchMove(a, axis, -angle, no), PatchMove(b, axis, -angle, no);
  SumDestroy(&s);
  free(slip), free(weight);
}

static void Check(const Kind *kind, uint64_t *seed, Errors *e)
{
  const ContactSpec spec = {.standard = kind->standard};
  PetscReal         z[256], traction[512];
  Patch             a, b;
  ContactPair       pair;
  PetscBool         failed;
  Sum               s;
  PetscReal         closed[1024];
  uint64_t          lengths = *seed;

  MakePair(kind, seed, &a, &b);
  for (PetscInt n = 0; n < a.s.num_nodes; n++) z[n] = 1 + 0.5 * Random(seed);
  for (PetscInt n = 0; n < 2 * a.s.num_nodes; n++) traction[n] = Random(seed);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  ContactPairSetTraction(pair, traction);
  if (kind->frozen) ContactPairFreezeSegmentation(pair, PETSC_TRUE);
  SearchAll(pair, &a, &b, 0.5, 0.1);
  CHECK_CALL(ContactPairKeepPoints(pair, &a.s, &b.s, &failed));
  assert_false(failed);
  CheckMotion(pair, &a, &b, seed, e);
  for (PetscInt n = 0; n < 3 * a.s.num_nodes; n++) a.x[n] += 0.01 / (PetscReal)(kind->order * kind->order) * Random(seed);
  for (PetscInt n = 0; n < 3 * b.s.num_nodes; n++) b.x[n] += 0.01 / (PetscReal)(kind->mortar * kind->mortar) * Random(seed);
  PatchFollow(&a), PatchFollow(&b);
  SumCreate(&s, &a, &b);
  Forces(&s, pair, &a, &b, z, traction, PETSC_FALSE);
  if (!kind->mirror) CheckBalance(&s, &a, &b, e);
  CheckDerivatives(pair, &a, &b, z, traction, seed, e);
  for (PetscInt n = 0; n < a.s.num_nodes; n++) closed[n] = 0.03 * Random(&lengths);
  ContactPairSetClosed(pair, closed);
  CheckDerivatives(pair, &a, &b, z, traction, &lengths, e);
  SumDestroy(&s);
  CHECK_CALL(ContactPairDestroy(&pair));
  PatchDestroy(&a), PatchDestroy(&b);
}

static int trials = 1; /* -slow: 2 */

static void test_derivatives(void **state)
{
  (void)state;
  for (int kind = 0; kind < 24; kind++) {
    const Kind k    = {.order    = 1 + kind % 3 + (kind == 11),
                       .mortar   = 1 + kind / 3 % 3,
                       .standard = kind % 5 == 4,
                       .partly   = kind / 12 % 2,
                       .hanging  = kind % 2,
                       .mirror   = kind % 7 == 3,
                       .frozen   = kind % 4 == 1,
                       .linear   = kind == 0 || kind == 9};
    Errors     e    = {0};
    uint64_t   seed = (uint64_t)kind + 1;

    for (int trial = 0; trial < trials; trial++) Check(&k, &seed, &e);
    printf("order %d on %d%s%s%s%s%s%s: tangent %.1e, slip %.1e, force %.1e, moment %.1e, rigid motion %.1e; kinks %d\n", (int)k.order, (int)k.mortar,
           k.standard ? ", standard" : "", k.partly ? ", in part" : "", k.hanging ? ", hanging" : "", k.mirror ? ", symmetry" : "", k.frozen ? ", frozen" : "",
           k.linear ? ", linear" : "", e.tangent, e.slip, e.force, e.moment, e.motion, (int)e.kinks);
    assert_true(e.kinks <= trials / 2);
    assert_true(e.tangent < 1e-8 && e.slip < 1e-8);
    assert_true(e.force < 1e-12 && e.moment < 1e-12 && e.motion < 1e-13);
  }
}

/* Flat surfaces, one slides by 0.617 over several facets of the other while both are turned: slip is just that, and tractions are as much force. */
static void test_slide(void **state)
{
  const PetscReal axis[3] = {1, 2, -1}, none[3] = {0, 0, 0}, slide[3] = {0.5, -0.36152455, 0};

  (void)state;
  for (PetscInt order = 1; order <= 3; order++) {
    const ContactSpec spec = {0};
    PetscReal         traction[512], slip[512], weight[256], total[3] = {0, 0, 0}, length = PetscSqrtReal(Dot3(slide, slide));
    Patch             a, b;
    ContactPair       pair;
    PetscBool         failed;
    Sum               s;

    PatchCreate(&a, 3, order, 2, 0, 1, PETSC_TRUE, PETSC_TRUE);
    PatchCreate(&b, 3, 4 - order, 7, -1, 2, PETSC_FALSE, PETSC_FALSE);
    for (PetscInt n = 0; n < a.s.num_nodes; n++)
      for (int c = 0; c < 2; c++) a.x[3 * n + c] = a.X[3 * n + c] = a.u[2 * n + c];
    for (PetscInt n = 0; n < b.s.num_nodes; n++)
      for (int c = 0; c < 2; c++) b.x[3 * n + c] = b.X[3 * n + c] = b.u[2 * n + c];
    for (PetscInt n = 0; n < 2 * a.s.num_nodes; n++) traction[n] = n < a.s.num_nodes;
    CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
    ContactPairSetTraction(pair, traction);
    SearchAll(pair, &a, &b, 0.5, 0.1);
    CHECK_CALL(ContactPairKeepPoints(pair, &a.s, &b.s, &failed));
    assert_false(failed);
    PatchMove(&a, axis, 0, slide);
    PatchMove(&a, axis, 1.1, none), PatchMove(&b, axis, 1.1, none);
    SumCreate(&s, &a, &b);
    Slip(&s, pair, &a, &b, slip, NULL, weight);
    SearchAll(pair, &a, &b, 0.5, 0.1);
    Forces(&s, pair, &a, &b, NULL, traction, PETSC_FALSE);
    for (PetscInt j = 0; j < s.nn; j++) {
      if (a.hang[j] < a.hang[j + 1]) continue;
      assert_near(PetscSqrtReal(PetscSqr(slip[j]) + PetscSqr(slip[s.nn + j])) / weight[j], length, 1e-13);
    }
    for (PetscInt n = 3 * s.nn; n < s.size; n++) total[n % 3] += s.gradient[n];
    assert_near(PetscSqrtReal(Dot3(total, total)), 1, 1e-12);
    SumDestroy(&s);
    CHECK_CALL(ContactPairDestroy(&pair));
    PatchDestroy(&a), PatchDestroy(&b);
  }
}

/* Facets without multipliers, whose nodes supports hold, say nothing of slip. */
static void test_held(void **state)
{
  const ContactSpec spec = {0};

  (void)state;
  for (PetscInt dim = 2; dim <= 3; dim++) {
    PetscReal           traction[32] = {0};
    PetscBool           carries[32]  = {PETSC_FALSE}, failed;
    Patch               a, b;
    ContactPair         pair;
    ContactSurface      side[2];
    ContactSlipPoint   *points;
    const ContactFacet *facets;
    PetscInt            num;

    PatchCreate(&a, dim, 1, 2, 0, 1, (PetscBool)(dim == 3), PETSC_FALSE);
    PatchCreate(&b, dim, 1, 3, -1, 2, (PetscBool)(dim == 2), PETSC_FALSE);
    for (int k = 0; k < 2; k++) {
      const Patch *p = k ? &b : &a;

      for (PetscInt n = 0; n < p->s.num_nodes; n++)
        for (PetscInt c = 0; c < dim - 1; c++) p->x[dim * n + c] = p->X[dim * n + c] = p->u[2 * n + c];
      side[k] = p->s;
    }
    CHECK_CALL(ContactPairCreate(dim, PETSC_FALSE, &spec, &pair));
    CHECK_CALL(ContactPairSetCarriers(pair, &a.s, carries, NULL));
    ContactPairSetTraction(pair, traction);
    SearchAll(pair, &a, &b, 0.5, 0.1);
    CHECK_CALL(ContactPairKeepPoints(pair, &a.s, &b.s, &failed));
    assert_false(failed);
    CHECK_CALL(ContactPairSlip(pair, &a.s, &b.s, side, &num, &facets));
    for (PetscInt i = 0; i < num; i++) assert_true(facets[i].num_rows > 0);
    CHECK_CALL(ContactPairSlipPoints(pair, side, NULL, &num, &points));
    for (PetscInt q = 0; q < num; q++) assert_true(points[q].weight > 0);
    CHECK_CALL(PetscFree(points));
    CHECK_CALL(ContactPairDestroy(&pair));
    PatchDestroy(&a), PatchDestroy(&b);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives), cmocka_unit_test(test_slide), cmocka_unit_test(test_held)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  if (argc > 1 && !strcmp(argv[1], "-slow")) trials = 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
