/* Friction: forces by tangential tractions and their derivatives against differences, balance of forces and moments at any positions, slip since points were
   kept with its gradient, rigid motion of both sides, slip over many facets. Random pairs in the plane that do not match, curved, covered in part. */
#include "rayfixture.h"

#define STEP 5e-5

typedef struct {
  PetscInt  order, mortar;
  PetscBool standard, partly, ring, linear; /* linear: surfaces without lattices */
} Kind;

static void MakeSide(const Kind *kind, PetscInt side, uint64_t *seed, const PetscReal shape[3], Patch *p)
{
  const PetscReal noise = 0.04 / (PetscReal)(p->order * p->order);

  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal a = p->u[2 * n] - 0.5;
    PetscReal      *x = p->x + 2 * n;

    x[0] = a + 0.5 + noise * Random(seed) + (kind->ring ? 0.7 : 0);
    x[1] = (side ? 0.03 + shape[2] * a : 0) + shape[0] * a * a + shape[1] * a * a * a + 0.4 * noise * Random(seed);
    for (int c = 0; c < 2; c++) p->X[2 * n + c] = x[c] + 0.02 * Random(seed);
  }
  if (kind->linear) p->s.order = NULL, p->s.first = p->s.lattice = NULL;
}

static void MakePair(const Kind *kind, uint64_t *seed, Patch *nonmortar, Patch *mortar)
{
  const PetscReal shape[3] = {0.15 * Random(seed), 0.1 * Random(seed), 0.1 * Random(seed)};

  PatchCreate(nonmortar, 2, kind->order, 4, 0, 1, PETSC_FALSE, PETSC_FALSE);
  PatchCreate(mortar, 2, kind->mortar, 5, kind->partly ? 0.31 : -0.35, kind->partly ? 1.4 : 1.35, PETSC_TRUE, PETSC_FALSE);
  MakeSide(kind, 0, seed, shape, nonmortar);
  MakeSide(kind, 1, seed, shape, mortar);
}

/* Forces of z and of the traction, or the slip with its gradient, in a Sum. */
static void Forces(Sum *s, ContactPair pair, const Patch *a, const Patch *b, const PetscReal z[], const PetscReal traction[], PetscBool hessian)
{
  const ContactFacet *facets;
  PetscInt            num;
  PetscBool           failed;

  SumSurfaces(s, pair, &a->s, &b->s, z, PETSC_TRUE, hessian);
  CHECK_CALL(ContactPairEvaluate(pair, &a->s, &b->s, z, NULL, PETSC_TRUE, hessian, &num, &facets, &failed));
  assert_false(failed);
  for (PetscInt i = 0; i < num; i++)
    for (PetscInt j = 0; j < facets[i].num_rows; j++)
      for (PetscInt k = 0; k < 2 * facets[i].num; k++)
        s->gradient[SumRow(s, &facets[i], k)] += traction[facets[i].nodes[j]] * facets[i].shear[j * 2 * facets[i].num + k];
}

static void SlipFrom(Sum *s, ContactPair pair, const Patch *a, const Patch *b, const ContactSurface from[])
{
  const ContactFacet *facets;

  memset(s->gap, 0, (size_t)s->nn * sizeof(PetscReal));
  memset(s->weight, 0, (size_t)s->nn * sizeof(PetscReal));
  memset(s->dgap, 0, (size_t)(s->nn * s->size) * sizeof(PetscReal));
  CHECK_CALL(ContactPairSlip(pair, &a->s, &b->s, from, &s->num, &facets));
  for (PetscInt i = 0; i < s->num; i++)
    for (PetscInt j = 0; j < facets[i].num_rows; j++) {
      s->gap[facets[i].nodes[j]] += facets[i].gap[j];
      s->weight[facets[i].nodes[j]] += facets[i].weight[j];
      for (PetscInt k = 0; k < 2 * facets[i].num; k++)
        s->dgap[facets[i].nodes[j] * s->size + SumRow(s, &facets[i], k)] += facets[i].dgap[j * 2 * facets[i].num + k];
    }
}

static void Slip(Sum *s, ContactPair pair, const Patch *a, const Patch *b)
{
  SlipFrom(s, pair, a, b, NULL);
}

static void Turn(Patch *p, const PetscReal from[], PetscReal angle, const PetscReal shift[2])
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    p->x[2 * n]     = cos(angle) * from[2 * n] - sin(angle) * from[2 * n + 1] + shift[0];
    p->x[2 * n + 1] = sin(angle) * from[2 * n] + cos(angle) * from[2 * n + 1] + shift[1];
  }
}

typedef struct {
  PetscReal tangent, slip, force, moment, motion;
  PetscInt  kinks;
} Errors;

/* Which facets meet, and at which of their ends overlaps end: derivatives jump where that changes. */
static uint64_t Signature(ContactPair pair)
{
  const ContactSegment *s;
  PetscInt              num;
  uint64_t              hash = 1469598103934665603ULL;

  ContactPairGetSegments(pair, &num, &s);
  for (PetscInt i = 0; i < num; i++) {
    int end = 0;

    for (PetscInt k = 0; k < 2; k++) end = 3 * end + (s[i].xi[k][0] < -1 + 1e-9 ? 1 : s[i].xi[k][0] > 1 - 1e-9 ? 2 : 0);
    hash = (hash ^ (uint64_t)(s[i].facet * 1000 + 10 * s[i].mortar_facet + end)) * 1099511628211ULL;
  }
  return hash;
}

static void CheckBalance(const Kind *kind, const Sum *s, const Patch *a, const Patch *b, Errors *e)
{
  const PetscReal scale    = Largest(s->gradient, s->size);
  PetscReal       force[2] = {0, 0}, moment = 0;

  for (PetscInt n = 0; n < s->nn + s->nm; n++) {
    const PetscReal *x = n < s->nn ? a->x + 2 * n : b->x + 2 * (n - s->nn), *g = s->gradient + 2 * n;

    for (int c = 0; c < 2; c++) force[c] += g[c];
    moment += x[0] * g[1] - x[1] * g[0];
  }
  e->force = PetscMax(e->force, PetscAbsReal(force[1]) / scale);
  if (kind->ring) return;
  e->force  = PetscMax(e->force, PetscAbsReal(force[0]) / scale);
  e->moment = PetscMax(e->moment, PetscAbsReal(moment) / scale);
}

/* Derivatives along one random direction of all positions. */
static void CheckDerivatives(ContactPair pair, Patch *a, Patch *b, const PetscReal z[], const PetscReal traction[], uint64_t *seed, Errors *e)
{
  static const PetscReal At[4] = {-2, -1, 1, 2};
  const PetscInt         na = 2 * a->s.num_nodes, nb = 2 * b->s.num_nodes;
  PetscReal             *from[2] = {malloc((size_t)na * sizeof(PetscReal)), malloc((size_t)nb * sizeof(PetscReal))};
  PetscReal             *along = malloc((size_t)(na + nb) * sizeof(PetscReal)), tangent = 0, slip = 0, scale[2] = {0, 0};
  PetscBool              kink = PETSC_FALSE;
  uint64_t               signature;
  Sum                    exact, kept, moved[4], slipped[4];

  memcpy(from[0], a->x, (size_t)na * sizeof(PetscReal)), memcpy(from[1], b->x, (size_t)nb * sizeof(PetscReal));
  for (PetscInt i = 0; i < na + nb; i++) along[i] = Random(seed);
  SumCreate(&exact, a, b), SumCreate(&kept, a, b);
  Forces(&exact, pair, a, b, z, traction, PETSC_TRUE);
  Slip(&kept, pair, a, b);
  signature = Signature(pair);
  for (int m = 0; m < 4; m++) {
    for (PetscInt i = 0; i < na; i++) a->x[i] = from[0][i] + At[m] * STEP * along[i];
    for (PetscInt i = 0; i < nb; i++) b->x[i] = from[1][i] + At[m] * STEP * along[na + i];
    SumCreate(&moved[m], a, b), SumCreate(&slipped[m], a, b);
    Forces(&moved[m], pair, a, b, z, traction, PETSC_FALSE);
    Slip(&slipped[m], pair, a, b);
    kink = (PetscBool)(kink || Signature(pair) != signature);
  }
  for (PetscInt i = 0; i < exact.size; i++) {
    const PetscReal f[4] = {moved[0].gradient[i], moved[1].gradient[i], moved[2].gradient[i], moved[3].gradient[i]}, d = Difference(f, STEP);
    PetscReal       sum = 0;

    for (PetscInt k = 0; k < exact.size; k++) sum += exact.hessian[i * exact.size + k] * along[k];
    tangent = PetscMax(tangent, PetscAbsReal(sum - d)), scale[0] = PetscMax(scale[0], PetscAbsReal(d));
  }
  for (PetscInt j = 0; j < exact.nn; j++) {
    const PetscReal f[4] = {slipped[0].gap[j], slipped[1].gap[j], slipped[2].gap[j], slipped[3].gap[j]}, d = Difference(f, STEP);
    PetscReal       sum = 0;

    for (PetscInt k = 0; k < exact.size; k++) sum += kept.dgap[j * exact.size + k] * along[k];
    slip = PetscMax(slip, PetscAbsReal(sum - d)), scale[1] = PetscMax(scale[1], PetscAbsReal(d));
  }
  e->kinks += kink;
  if (!kink) e->tangent = PetscMax(e->tangent, tangent / scale[0]);
  e->slip = PetscMax(e->slip, slip / scale[1]);
  memcpy(a->x, from[0], (size_t)na * sizeof(PetscReal)), memcpy(b->x, from[1], (size_t)nb * sizeof(PetscReal));
  SumDestroy(&exact), SumDestroy(&kept);
  for (int m = 0; m < 4; m++) SumDestroy(&moved[m]), SumDestroy(&slipped[m]);
  free(from[0]), free(from[1]), free(along);
}

static void CheckMotion(ContactPair pair, Patch *a, Patch *b, uint64_t *seed, Errors *e)
{
  const PetscReal angle = 3 * Random(seed), shift[2] = {Random(seed), Random(seed)};
  const size_t    na = 2 * (size_t)a->s.num_nodes * sizeof(PetscReal), nb = 2 * (size_t)b->s.num_nodes * sizeof(PetscReal);
  PetscReal      *from[2] = {malloc(na), malloc(nb)};
  Sum             s;

  memcpy(from[0], a->x, na), memcpy(from[1], b->x, nb);
  SumCreate(&s, a, b);
  Turn(a, from[0], angle, shift), Turn(b, from[1], angle, shift);
  Slip(&s, pair, a, b);
  for (PetscInt j = 0; j < s.nn; j++) e->motion = PetscMax(e->motion, PetscAbsReal(s.gap[j]));
  memcpy(a->x, from[0], na), memcpy(b->x, from[1], nb);
  SumDestroy(&s);
  free(from[0]), free(from[1]);
}

static void Check(const Kind *kind, uint64_t *seed, Errors *e)
{
  const ContactSpec spec = {.standard = kind->standard};
  PetscReal         z[64], traction[64];
  Patch             a, b;
  ContactPair       pair;
  PetscBool         failed;
  Sum               s;
  PetscReal         closed[256];
  uint64_t          lengths = *seed;

  MakePair(kind, seed, &a, &b);
  for (PetscInt n = 0; n < a.s.num_nodes; n++) z[n] = 1 + 0.5 * Random(seed), traction[n] = Random(seed);
  CHECK_CALL(ContactPairCreate(2, kind->ring, &spec, &pair));
  ContactPairSetTraction(pair, traction);
  SearchAll(pair, &a, &b, 0.5, 0.1);
  CHECK_CALL(ContactPairKeepPoints(pair, &a.s, &b.s, &failed));
  assert_false(failed);
  CheckMotion(pair, &a, &b, seed, e);
  for (PetscInt n = 0; n < 2 * a.s.num_nodes; n++) a.x[n] += 0.01 / (PetscReal)(kind->order * kind->order) * Random(seed);
  for (PetscInt n = 0; n < 2 * b.s.num_nodes; n++) b.x[n] += 0.01 / (PetscReal)(kind->mortar * kind->mortar) * Random(seed);
  SumCreate(&s, &a, &b);
  Forces(&s, pair, &a, &b, z, traction, PETSC_FALSE);
  CheckBalance(kind, &s, &a, &b, e);
  CheckDerivatives(pair, &a, &b, z, traction, seed, e);
  for (PetscInt n = 0; n < a.s.num_nodes; n++) closed[n] = 0.03 * Random(&lengths);
  ContactPairSetClosed(pair, closed);
  CheckDerivatives(pair, &a, &b, z, traction, &lengths, e);
  SumDestroy(&s);
  CHECK_CALL(ContactPairDestroy(&pair));
  PatchDestroy(&a), PatchDestroy(&b);
}

static void test_derivatives(void **state)
{
  (void)state;
  for (int kind = 0; kind < 40; kind++) {
    const Kind k    = {.order    = 1 + kind % 4,
                       .mortar   = 1 + kind / 4 % 4,
                       .standard = kind % 5 == 4,
                       .partly   = kind / 16 % 2,
                       .ring     = kind % 7 == 3,
                       .linear   = kind % 4 == 0 && kind / 4 % 4 == 0};
    Errors     e    = {0};
    uint64_t   seed = (uint64_t)kind + 1;

    for (int trial = 0; trial < 5; trial++) Check(&k, &seed, &e);
    printf("order %d on %d%s%s%s%s: tangent %.1e, slip %.1e, force %.1e, moment %.1e, rigid motion %.1e; kinks %d\n", (int)k.order, (int)k.mortar,
           k.standard ? ", standard" : "", k.partly ? ", in part" : "", k.ring ? ", axisymmetric" : "", k.linear ? ", linear" : "", e.tangent, e.slip, e.force,
           e.moment, e.motion, (int)e.kinks);
    assert_true(e.kinks <= 2);
    assert_true(e.tangent < 1e-7 && e.slip < 1e-8);
    assert_true(e.force < 1e-13 && e.moment < 1e-13 && e.motion < 1e-14);
  }
}

/* Flat surfaces, one slides by 0.617 over several facets of the other while both are turned: slip is just that, and tractions are as much force. */
static void test_slide(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 3; order++) {
    const ContactSpec spec        = {0};
    const PetscReal   shift[2][2] = {{0, 0}, {0.617 * cos(1.1), 0.617 * sin(1.1)}};
    PetscReal         traction[64], *from[2], force = 0;
    Patch             a, b;
    ContactPair       pair;
    PetscBool         failed;
    Sum               s;

    PatchCreate(&a, 2, order, 4, 0, 1, PETSC_FALSE, PETSC_FALSE);
    PatchCreate(&b, 2, 4 - order, 17, -1, 2, PETSC_TRUE, PETSC_FALSE);
    for (PetscInt n = 0; n < a.s.num_nodes; n++) a.x[2 * n] = a.X[2 * n] = a.u[2 * n], traction[n] = 1;
    for (PetscInt n = 0; n < b.s.num_nodes; n++) b.x[2 * n] = b.X[2 * n] = b.u[2 * n];
    from[0] = malloc(2 * (size_t)a.s.num_nodes * sizeof(PetscReal)), from[1] = malloc(2 * (size_t)b.s.num_nodes * sizeof(PetscReal));
    memcpy(from[0], a.x, 2 * (size_t)a.s.num_nodes * sizeof(PetscReal)), memcpy(from[1], b.x, 2 * (size_t)b.s.num_nodes * sizeof(PetscReal));
    CHECK_CALL(ContactPairCreate(2, PETSC_FALSE, &spec, &pair));
    ContactPairSetTraction(pair, traction);
    SearchAll(pair, &a, &b, 0.5, 0.1);
    CHECK_CALL(ContactPairKeepPoints(pair, &a.s, &b.s, &failed));
    Turn(&a, from[0], 1.1, shift[0]), Turn(&b, from[1], 1.1, shift[1]);
    SumCreate(&s, &a, &b);
    Slip(&s, pair, &a, &b);
    for (PetscInt j = 0; j < s.nn; j++) assert_near(s.gap[j] / s.weight[j], -0.617, 1e-13); /* facets run from right to left */
    SearchAll(pair, &a, &b, 0.5, 0.1);
    Forces(&s, pair, &a, &b, traction, traction, PETSC_FALSE);
    for (PetscInt n = s.nn; n < s.nn + s.nm; n++) force += s.gradient[2 * n] * cos(1.1) + s.gradient[2 * n + 1] * sin(1.1);
    assert_near(force, -1, 1e-12);
    SumDestroy(&s);
    CHECK_CALL(ContactPairDestroy(&pair));
    PatchDestroy(&a), PatchDestroy(&b);
    free(from[0]), free(from[1]);
  }
}

/* The mortar side comes from where it faced two of four facets or none, while both are turned: all that face it now have slipped by as much. */
static void test_arrival(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 3; order++)
    for (int apart = 0; apart < 2; apart++) {
      const ContactSpec   spec = {0};
      const PetscReal     lo = apart ? 1.4 : 0.45, slip = lo + 0.2, shift[2][2] = {{0, 0}, {-slip * cos(1.1), -slip * sin(1.1)}};
      PetscReal           traction[64] = {0}, *at[2];
      Patch               p[2];
      ContactPair         pair;
      ContactSurface      from[2];
      const ContactFacet *facets;
      PetscBool           failed;
      PetscInt            num;
      Sum                 s;

      PatchCreate(&p[0], 2, order, 4, 0, 1, PETSC_FALSE, PETSC_FALSE);
      PatchCreate(&p[1], 2, 4 - order, 7, lo, lo + 1.6, PETSC_TRUE, PETSC_FALSE);
      for (int k = 0; k < 2; k++) {
        const size_t size = 2 * (size_t)p[k].s.num_nodes * sizeof(PetscReal);

        for (PetscInt n = 0; n < p[k].s.num_nodes; n++) p[k].x[2 * n] = p[k].X[2 * n] = p[k].u[2 * n];
        at[k]     = memcpy(malloc(size), p[k].x, size);
        from[k]   = p[k].s;
        from[k].x = at[k];
      }
      CHECK_CALL(ContactPairCreate(2, PETSC_FALSE, &spec, &pair));
      ContactPairSetTraction(pair, traction);
      SearchAll(pair, &p[0], &p[1], 0.5, 0.1);
      CHECK_CALL(ContactPairKeepPoints(pair, &p[0].s, &p[1].s, &failed));
      for (int k = 0; k < 2; k++) Turn(&p[k], at[k], 1.1, shift[k]);
      SearchAll(pair, &p[0], &p[1], 0.5, 0.1);
      CHECK_CALL(ContactPairEvaluate(pair, &p[0].s, &p[1].s, NULL, NULL, PETSC_TRUE, PETSC_FALSE, &num, &facets, &failed));
      SumCreate(&s, &p[0], &p[1]);
      SlipFrom(&s, pair, &p[0], &p[1], from);
      assert_int_equal(s.num, 4);
      for (PetscInt j = 0; j < s.nn; j++) assert_near(s.gap[j] / s.weight[j], slip, 1e-13); /* facets run from right to left */
      for (PetscInt j = 0; j < s.nn; j++) {
        PetscReal change = 0; /* by a motion of the mortar side along t */

        for (PetscInt n = s.nn; n < s.nn + s.nm; n++) change -= s.dgap[j * s.size + 2 * n] * cos(1.1) + s.dgap[j * s.size + 2 * n + 1] * sin(1.1);
        assert_near(change / s.weight[j], 1, 1e-13);
      }
      SumDestroy(&s);
      CHECK_CALL(ContactPairDestroy(&pair));
      for (int k = 0; k < 2; k++) PatchDestroy(&p[k]), free(at[k]);
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives), cmocka_unit_test(test_slide), cmocka_unit_test(test_arrival)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
