/* Contact along a continuous direction: exact sums on flat surfaces that do not match, of facets and of their children, and orders of convergence on curved
   ones. */
#include "rayfixture.h"

typedef struct {
  PetscInt dim, order, mortar;
} Kind;

/* A chart point to space: flat (distorted inside), or on a circle or sphere of radius 1 about the origin seen along the last axis. */
static void Flat(PetscInt D, const PetscReal u[2], PetscReal bend, PetscReal x[3])
{
  const PetscReal a = u[0], b = D == 3 ? u[1] : 0;

  x[0]     = a + bend * sin(3 * a) * (1 + b);
  x[1]     = b + bend * sin(2 * b) * a;
  x[D - 1] = 0;
}

static void Round(PetscInt D, const PetscReal u[2], PetscReal bend, PetscReal x[3])
{
  const PetscReal a = 0.7 * (u[0] - 0.5), b = D == 3 ? 0.7 * (u[1] - 0.5) : 0, t[2] = {tan(a), tan(b)}, l = sqrt(1 + t[0] * t[0] + t[1] * t[1]);

  (void)bend;
  x[0] = t[0] / l, x[1] = t[1] / l;
  x[D - 1] = 1 / l;
}

static void Place(Patch *p, void (*map)(PetscInt, const PetscReal[2], PetscReal, PetscReal[3]), PetscReal bend)
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    PetscReal x[3];

    map(p->dim, p->u + 2 * n, bend, x);
    for (PetscInt c = 0; c < p->dim; c++) p->x[p->dim * n + c] = p->X[p->dim * n + c] = x[c];
  }
}

/* Straight facets: lattice nodes at the multilinear places of their corners. */
static void Straighten(Patch *p)
{
  const PetscInt   D = p->dim, q = p->order, nv = 2 * (D - 1);
  const PetscReal *node;

  CHECK_CALL(ElementGetNodes(q, &node));
  for (PetscInt f = 0; f < p->s.num_facets; f++)
    for (PetscInt k = p->first[f]; k < p->first[f + 1]; k++) {
      const PetscReal a = node[(k - p->first[f]) % (q + 1)], b = node[(k - p->first[f]) / (q + 1)];
      const PetscReal N[4] = {(1 - a) * (D == 3 ? 1 - b : 1), a * (D == 3 ? 1 - b : 1), a * b, (1 - a) * b};

      for (PetscInt c = 0; c < D; c++) {
        PetscReal x = 0;

        for (PetscInt v = 0; v < nv; v++) x += N[v] * p->X[D * p->facets[nv * f + v] + c];
        p->x[D * p->lattice[k] + c] = x;
      }
    }
  for (PetscInt i = 0; i < D * p->s.num_nodes; i++) p->X[i] = p->x[i];
}

/* Unit pressure on flat surfaces of straight facets, mortar side covering all: forces on the mortar nodes of its covered facets are int M_b. Returns the
   largest error of the forces of nonmortar nodes against int N_a (z = 1), and of the sum over mortar nodes against the area. */
static PetscReal PatchError(const Kind *k, PetscReal bend)
{
  const ContactSpec spec = {.standard = PETSC_TRUE};
  const PetscInt    D    = k->dim;
  Patch             nonmortar, mortar;
  ContactPair       pair;
  Sum               s;
  PetscReal        *z, sum[2] = {0, 0}, first[2] = {0, 0}, error = 0;

  PatchCreate(&nonmortar, D, k->order, D == 2 ? 4 : 3, 0, 1, D == 2 ? PETSC_FALSE : PETSC_TRUE, PETSC_FALSE);
  PatchCreate(&mortar, D, k->mortar, D == 2 ? 7 : 4, -0.25, 1.25, D == 2 ? PETSC_TRUE : PETSC_FALSE, PETSC_FALSE);
  Place(&nonmortar, Flat, bend);
  Place(&mortar, Flat, -bend);
  Straighten(&nonmortar);
  Straighten(&mortar);
  z = calloc((size_t)nonmortar.s.num_nodes, sizeof(PetscReal));
  for (PetscInt j = 0; j < nonmortar.s.num_nodes; j++) z[j] = 1;
  CHECK_CALL(ContactPairCreate(D, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.2, 0);
  SumCreate(&s, &nonmortar, &mortar);
  SumEvaluate(&s, pair, &nonmortar, &mortar, z, PETSC_FALSE);
  for (PetscInt n = 0; n < s.nn; n++) {
    for (PetscInt c = 0; c < D; c++) error = PetscMax(error, PetscAbsReal(s.gradient[D * n + c] + (c == D - 1 ? s.weight[n] : 0)) / s.area * s.nn);
    sum[0] += s.weight[n];
    first[0] += s.weight[n] * nonmortar.x[D * n];
  }
  for (PetscInt n = 0; n < s.nm; n++) {
    sum[1] += s.gradient[D * (s.nn + n) + D - 1];
    first[1] += s.gradient[D * (s.nn + n) + D - 1] * mortar.x[D * n];
    for (PetscInt c = 0; c < D - 1; c++) error = PetscMax(error, PetscAbsReal(s.gradient[D * (s.nn + n) + c]) / s.area * s.nn);
  }
  error = PetscMax(error, PetscAbsReal(sum[1] - sum[0]) / s.area);
  error = PetscMax(error, PetscAbsReal(first[1] - first[0]) / s.area);
  SumDestroy(&s);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  free(z);
  CHECK_CALL(ContactPairDestroy(&pair));
  return error;
}

static void test_flat(void **state)
{
  static const Kind Kinds[] = {{2, 1, 1}, {2, 2, 2}, {2, 3, 1}, {2, 4, 4}, {3, 1, 1}, {3, 2, 2}, {3, 3, 3}, {3, 2, 1}, {3, 1, 3}};

  (void)state;
  for (size_t k = 0; k < sizeof(Kinds) / sizeof(Kinds[0]); k++) {
    const PetscReal error[2] = {PatchError(&Kinds[k], 0), PatchError(&Kinds[k], 0.05)};

    print_message("flat, %dD orders %d/%d: forces of a constant pressure off by %.1e, distorted %.1e\n", (int)Kinds[k].dim, (int)Kinds[k].order,
                  (int)Kinds[k].mortar, error[0], error[1]);
    assert_true(error[0] < 1e-12);
    assert_true(error[1] < 1e-12);
  }
}

/* Root mean square of gap / weight and of the angle between the gap's gradient and the radius on a round interface with n and 1.5 n facets, inside. */
static void RoundError(const Kind *k, PetscInt n, PetscReal error[2])
{
  const ContactSpec spec = {.standard = PETSC_TRUE};
  const PetscInt    D    = k->dim;
  Patch             nonmortar, mortar;
  ContactPair       pair;
  PetscInt          num = 0;
  Sum               s;

  PatchCreate(&nonmortar, D, k->order, n, 0, 1, D == 2 ? PETSC_FALSE : PETSC_TRUE, PETSC_FALSE);
  PatchCreate(&mortar, D, k->mortar, n + n / 2, -0.2, 1.2, D == 2 ? PETSC_TRUE : PETSC_FALSE, PETSC_FALSE);
  Place(&nonmortar, Round, 0);
  Place(&mortar, Round, 0);
  CHECK_CALL(ContactPairCreate(D, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.1, 0);
  SumCreate(&s, &nonmortar, &mortar);
  SumEvaluate(&s, pair, &nonmortar, &mortar, NULL, PETSC_FALSE);
  error[0] = error[1] = 0;
  for (PetscInt j = 0; j < s.nn; j++) {
    PetscReal length = 0, along = 0, force[3] = {0, 0, 0};

    if (fabs(nonmortar.u[2 * j] - 0.5) > 0.3 || (D == 3 && fabs(nonmortar.u[2 * j + 1] - 0.5) > 0.3)) continue;
    for (PetscInt m = 0; m < s.nm; m++)
      for (PetscInt c = 0; c < D; c++) force[c] += s.dgap[j * s.size + D * (s.nn + m) + c];
    for (PetscInt c = 0; c < D; c++) length += force[c] * force[c], along += force[c] * nonmortar.x[D * j + c];
    error[0] += PetscSqr(s.gap[j] / s.weight[j]);
    error[1] += PetscMax(0, 1 - along * along / length);
    num++;
  }
  for (int e = 0; e < 2; e++) error[e] = sqrt(error[e] / (PetscReal)num);
  SumDestroy(&s);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

static void test_round(void **state)
{
  static const Kind Kinds[] = {{2, 1, 1}, {2, 2, 2}, {2, 3, 3}, {2, 4, 4}, {3, 1, 1}, {3, 2, 2}, {3, 3, 3}};

  (void)state;
  for (size_t k = 0; k < sizeof(Kinds) / sizeof(Kinds[0]); k++) {
    const PetscInt n = Kinds[k].dim == 2 ? 6 : 3;
    PetscReal      coarse[2], fine[2], rate[2];

    RoundError(&Kinds[k], n, coarse);
    RoundError(&Kinds[k], 4 * n, fine);
    for (int e = 0; e < 2; e++) rate[e] = 0.5 * log2(coarse[e] / fine[e]);
    print_message("round, %dD order %d: gap %.2e -> %.2e (h^%.1f), direction %.2e -> %.2e (h^%.1f)\n", (int)Kinds[k].dim, (int)Kinds[k].order, coarse[0],
                  fine[0], rate[0], coarse[1], fine[1], rate[1]);
    assert_true(rate[0] > (PetscReal)Kinds[k].order + 0.5);
    assert_true(fine[1] <
                0.1 * pow(0.7 / (4 * (PetscReal)n), (PetscReal)Kinds[k].order)); /* far below h^order: averages of a force that swings about the normal */
  }
}

/* Sums over nodes of a finer mesh with the functions of the coarse one, n x n facets of [0, 1]^2, one for each of its nodes. */
static void Restrict(const Patch *coarse, PetscInt n, const Patch *fine, const PetscReal values[], PetscReal sums[])
{
  const PetscInt q = coarse->order;

  for (PetscInt j = 0; j < fine->s.num_nodes; j++) {
    PetscReal N[2][MORTISE_MAX_ORDER + 1];
    PetscInt  at[2];

    for (int c = 0; c < 2; c++) {
      const PetscReal place = (PetscReal)n * fine->u[2 * j + c];

      at[c] = PetscMin((PetscInt)(place + 1e-9), n - 1);
      CHECK_CALL(ElementEvaluate1D(q, place - (PetscReal)at[c], N[c], NULL));
    }
    for (PetscInt k = 0; k < (q + 1) * (q + 1); k++)
      sums[coarse->lattice[coarse->first[at[0] + n * at[1]] + k]] += N[0][k % (q + 1)] * N[1][k / (q + 1)] * values[j];
  }
}

typedef struct {
  PetscInt  order, mortar, coarse, fine; /* orders of both sides; facets of the nonmortar side each way */
  PetscBool refined, standard, partly;   /* the last facet of the finer mesh in four: nodes hang on it */
} Family;

static void EvaluateFlat(const Family *k, PetscInt n, PetscBool refined, uint64_t seed, Patch *nonmortar, Sum *s)
{
  const ContactSpec spec = {.standard = k->standard};
  Patch             mortar;
  ContactPair       pair;

  PatchCreate(nonmortar, 3, k->order, n, 0, 1, PETSC_TRUE, refined);
  PatchCreate(&mortar, 3, k->mortar, 3, k->partly ? 0.31 : -0.35, 1.35, PETSC_FALSE, PETSC_FALSE);
  Place(nonmortar, Flat, 0);
  Place(&mortar, Flat, 0);
  for (PetscInt v = 0; v < mortar.s.num_nodes; v++) mortar.x[3 * v + 2] = mortar.X[3 * v + 2] = 0.1 + 0.03 * Random(&seed);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, nonmortar, &mortar, 0.4, 0);
  SumCreate(s, nonmortar, &mortar);
  SumEvaluate(s, pair, nonmortar, &mortar, NULL, PETSC_FALSE);
  assert_false(s->failed);
  CHECK_CALL(ContactPairDestroy(&pair));
  PatchDestroy(&mortar);
}

/* Difference of the gaps (or weights) of a coarse mesh and of those that its functions make of the finer one's: node by node where both have their own
   functions, else of the integral over all. */
static PetscReal FamilyError(const Family *k, const Patch *coarse, const PetscReal parent[], const Patch *fine, const PetscReal child[])
{
  PetscReal *sums = calloc((size_t)coarse->s.num_nodes, sizeof(PetscReal)), error = 0, total = 0, size = Largest(parent, coarse->s.num_nodes);

  Restrict(coarse, k->coarse, fine, child, sums);
  for (PetscInt i = 0; i < coarse->s.num_nodes; i++) {
    error = PetscMax(error, PetscAbsReal(sums[i] - parent[i]));
    total += sums[i] - parent[i];
  }
  free(sums);
  return (k->standard && !k->partly ? error : PetscAbsReal(total)) / size;
}

/* O-103: flat facets of any order and the finer ones in their place carry the same weighted gaps against a mortar side that is bent at random, nodes that hang
   included: integrals of g N_i, N_i the parent's functions, where multipliers are standard; of g, where they are dual or facets are covered in part. */
static void test_children(void **state)
{
  static const Family Families[] = {{1, 1, 1, 2, 0, 1, 0}, {2, 2, 1, 2, 0, 1, 0}, {2, 1, 1, 4, 0, 1, 0}, {2, 3, 2, 2, 1, 1, 0}, {3, 2, 1, 2, 0, 1, 0},
                                    {3, 3, 2, 2, 1, 1, 0}, {4, 2, 1, 2, 0, 1, 0}, {4, 4, 2, 2, 1, 1, 0}, {2, 2, 1, 4, 0, 0, 0}, {3, 2, 2, 2, 1, 0, 0},
                                    {2, 2, 1, 4, 0, 1, 1}, {3, 3, 2, 2, 1, 1, 1}, {4, 2, 2, 2, 1, 0, 1}};

  (void)state;
  for (size_t k = 0; k < sizeof(Families) / sizeof(Families[0]); k++) {
    const Family *family   = &Families[k];
    PetscReal     error[2] = {0, 0};

    for (uint64_t seed = 1; seed <= 4; seed++) {
      Patch coarse, fine;
      Sum   parent, child;

      EvaluateFlat(family, family->coarse, PETSC_FALSE, seed, &coarse, &parent);
      EvaluateFlat(family, family->fine, family->refined, seed, &fine, &child);
      assert_true(Largest(parent.gap, parent.nn) > 1e-3);
      error[0] = PetscMax(error[0], FamilyError(family, &coarse, parent.gap, &fine, child.gap));
      error[1] = PetscMax(error[1], FamilyError(family, &coarse, parent.weight, &fine, child.weight));
      SumDestroy(&parent);
      SumDestroy(&child);
      PatchDestroy(&coarse);
      PatchDestroy(&fine);
    }
    print_message("children, orders %d/%d, %d on %d%s %s%s: weighted gap differs by %.1e, weights by %.1e\n", (int)family->order, (int)family->mortar,
                  (int)family->coarse, (int)family->fine, family->refined ? " hanging" : "", family->standard ? "standard" : "dual",
                  family->partly ? " partly" : "", error[0], error[1]);
    assert_true(error[0] < 1e-12);
    assert_true(error[1] < 1e-12);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_flat), cmocka_unit_test(test_children), cmocka_unit_test(test_round)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
