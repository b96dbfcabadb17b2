/* Chains of edges, random contact configurations and assembled results for the contact tests. Lower body: nonmortar, its top runs towards -x.
   Upper body: mortar, its bottom runs towards +x. */
#pragma once
#include "contactsum.h"

typedef struct {
  ContactSurface s;
  PetscInt      *edges;
  PetscReal     *x, *mirror;
} Chain;

static inline void ChainCreate(Chain *c, PetscInt num_nodes, PetscBool closed)
{
  const PetscInt ne = closed ? num_nodes : num_nodes - 1;

  c->edges  = calloc((size_t)(2 * ne), sizeof(PetscInt));
  c->x      = calloc((size_t)(2 * num_nodes), sizeof(PetscReal));
  c->mirror = calloc((size_t)(2 * num_nodes), sizeof(PetscReal));
  for (PetscInt e = 0; e < ne; e++) c->edges[2 * e] = e, c->edges[2 * e + 1] = (e + 1) % num_nodes;
  c->s = (ContactSurface){.dim = 2, .num_nodes = num_nodes, .num_facets = ne, .facets = c->edges, .x = c->x, .mirror = c->mirror};
}

static inline void ChainDestroy(Chain *c)
{
  free(c->edges);
  free(c->x);
  free(c->mirror);
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

/* One evaluation: pair created, searched, evaluated into s (created here). Destroy both. */
static inline void EvaluateOnce(Chain *nonmortar, Chain *mortar, PetscBool axisymmetric, PetscBool nts, PetscReal distance, const PetscReal z[],
                                ContactPair *pair, Sum *s)
{
  PairCreate(axisymmetric, nts, pair);
  SearchAll(*pair, nonmortar, mortar, distance, 0);
  SumCreate(s, nonmortar->s.num_nodes, mortar->s.num_nodes);
  SumEvaluate(s, *pair, nonmortar, mortar, z, PETSC_TRUE, z ? PETSC_TRUE : PETSC_FALSE);
}
