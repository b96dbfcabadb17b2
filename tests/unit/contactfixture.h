/* Chains of edges, random contact configurations and assembled results for the contact tests. Lower body: nonmortar, its top runs towards -x.
   Upper body: mortar, its bottom runs towards +x. */
#pragma once
#include "contactsum.h"

typedef struct {
  ContactSurface s;
  PetscInt      *edges;
  PetscReal     *x, *X, *mirror;
} Chain;

static inline void ChainCreate(Chain *c, PetscInt num_nodes, PetscBool closed)
{
  const PetscInt ne = closed ? num_nodes : num_nodes - 1;

  c->edges  = calloc((size_t)(2 * ne), sizeof(PetscInt));
  c->x      = calloc((size_t)(2 * num_nodes), sizeof(PetscReal));
  c->X      = calloc((size_t)(2 * num_nodes), sizeof(PetscReal));
  c->mirror = calloc((size_t)(2 * num_nodes), sizeof(PetscReal));
  for (PetscInt e = 0; e < ne; e++) c->edges[2 * e] = e, c->edges[2 * e + 1] = (e + 1) % num_nodes;
  c->s = (ContactSurface){.dim = 2, .num_nodes = num_nodes, .num_facets = ne, .facets = c->edges, .x = c->x, .X = c->X, .mirror = c->mirror};
}

static inline void ChainDestroy(Chain *c)
{
  free(c->edges);
  free(c->x);
  free(c->X);
  free(c->mirror);
}

/* The places of now are the reference positions. */
static inline void ChainReference(Chain *c)
{
  memcpy(c->X, c->x, sizeof(PetscReal) * 2 * (size_t)c->s.num_nodes);
}

/* Straight chain from a to b, equal edges. */
static inline void ChainLine(Chain *c, PetscInt num_nodes, PetscReal ax, PetscReal ay, PetscReal bx, PetscReal by)
{
  ChainCreate(c, num_nodes, PETSC_FALSE);
  for (PetscInt i = 0; i < num_nodes; i++) {
    const PetscReal t = (PetscReal)i / (PetscReal)(num_nodes - 1);

    c->x[2 * i]     = ax + t * (bx - ax);
    c->x[2 * i + 1] = ay + t * (by - ay);
  }
  ChainReference(c);
}

static inline void ChainMove(Chain *c, PetscReal angle, PetscReal dx, PetscReal dy)
{
  const PetscReal cs = cos(angle), sn = sin(angle);

  for (PetscInt i = 0; i < c->s.num_nodes; i++) {
    const PetscReal x = c->x[2 * i], y = c->x[2 * i + 1], mx = c->mirror[2 * i], my = c->mirror[2 * i + 1];

    c->x[2 * i]          = cs * x - sn * y + dx;
    c->x[2 * i + 1]      = sn * x + cs * y + dy;
    c->mirror[2 * i]     = cs * mx - sn * my;
    c->mirror[2 * i + 1] = sn * mx + cs * my;
  }
}

/* Direction of the rays at end v of edge e of an open chain: mean vector of the edges there, but for one that turns by more than 40 degrees. */
static inline void ChainDirection(const Chain *c, PetscInt e, int v, PetscReal d[2])
{
  const PetscInt edge[2] = {e, e + 2 * v - 1};
  PetscReal      N[2][2], length[2];

  for (int k = 0; k < 2; k++) {
    const PetscReal *a = c->x + 2 * edge[k], *b = a + 2;

    if (edge[k] < 0 || edge[k] >= c->s.num_facets) continue;
    N[k][0] = b[1] - a[1], N[k][1] = a[0] - b[0];
    length[k] = hypot(N[k][0], N[k][1]);
  }
  if (edge[1] < 0 || edge[1] >= c->s.num_facets || N[0][0] * N[1][0] + N[0][1] * N[1][1] <= cos(40 * PETSC_PI / 180) * length[0] * length[1])
    N[1][0] = N[1][1] = length[1] = 0;
  for (int i = 0; i < 2; i++) d[i] = (N[0][i] + N[1][i]) / (length[0] + length[1]);
}

/* Random curved, tilted, non-matching pair near x in [0, 1], distance about `gap`, nonmortar partly covered. */
static inline void RandomPair(uint64_t *seed, PetscInt nodes_n, PetscInt nodes_m, PetscReal gap, Chain *nonmortar, Chain *mortar)
{
  const PetscReal curve = 0.1 * Random(seed), bump = 0.03 * Random(seed), tilt = 0.1 * Random(seed);
  const PetscReal left = 0.15 * Random(seed), right = 1 + 0.15 * Random(seed);

  ChainLine(nonmortar, nodes_n, 1, 0, 0, 0);
  ChainLine(mortar, nodes_m, left, gap, right, gap);
  for (PetscInt i = 0; i < nodes_n; i++) {
    PetscReal *x = &nonmortar->x[2 * i];

    x[0] += 0.2 / (PetscReal)nodes_n * Random(seed);
    x[1] += curve * x[0] * (1 - x[0]) * 4 + 0.01 * Random(seed);
  }
  for (PetscInt i = 0; i < nodes_m; i++) {
    PetscReal *x = &mortar->x[2 * i];

    x[0] += 0.2 / (PetscReal)nodes_m * Random(seed);
    x[1] += curve * x[0] * (1 - x[0]) * 4 + bump * sin(7 * x[0]) + tilt * (x[0] - 0.5) + 0.01 * Random(seed);
  }
}

static inline void SumCreate(Sum *s, PetscInt nn, PetscInt nm)
{
  SumCreateFor(s, 2, nn, nm);
}

#define SumEvaluate(sum, pair, nonmortar, mortar, z, derivatives, hessian) SumSurfaces(sum, pair, &(nonmortar)->s, &(mortar)->s, z, derivatives, hessian)

/* A pair in two dimensions. */
static inline void PairCreate(PetscBool axisymmetric, PetscBool node_to_segment, ContactPair *pair)
{
  const ContactSpec spec = {.node_to_segment = node_to_segment};

  CHECK_CALL(ContactPairCreate(2, axisymmetric, &spec, pair));
}

/* Unknown i of both chains. */
static inline PetscReal *Unknown(Chain *nonmortar, Chain *mortar, PetscInt i)
{
  return i < 2 * nonmortar->s.num_nodes ? &nonmortar->x[i] : &mortar->x[i - 2 * nonmortar->s.num_nodes];
}

#define CONTACT_TEST_MAIN(title, ...)                                                                                                                          \
  int main(int argc, char **argv)                                                                                                                              \
  {                                                                                                                                                            \
    const struct CMUnitTest tests[] = {__VA_ARGS__};                                                                                                           \
    int                     failures;                                                                                                                          \
                                                                                                                                                               \
    if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;                                                                                                   \
    failures = cmocka_run_group_tests_name(title, tests, NULL, NULL);                                                                                          \
    return PetscFinalize() ? 1 : failures;                                                                                                                     \
  }

/* One evaluation of undeformed surfaces: pair created, searched, evaluated into s (created here). Destroy both. */
static inline void EvaluateOnce(Chain *nonmortar, Chain *mortar, PetscBool axisymmetric, PetscBool nts, PetscReal distance, const PetscReal z[],
                                ContactPair *pair, Sum *s)
{
  ChainReference(nonmortar);
  ChainReference(mortar);
  PairCreate(axisymmetric, nts, pair);
  SearchAll(*pair, nonmortar, mortar, distance, 0);
  SumCreate(s, nonmortar->s.num_nodes, mortar->s.num_nodes);
  SumEvaluate(s, *pair, nonmortar, mortar, z, PETSC_TRUE, z ? PETSC_TRUE : PETSC_FALSE);
}
