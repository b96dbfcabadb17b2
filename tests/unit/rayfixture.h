/* Surfaces of facets of any order for the tests of rays along a continuous direction: charts [0, 1]^m mapped by a function, optionally with one refined corner
   (hanging nodes), assembled results. */
#pragma once
#include "contactsum.h"
#include "element.h"

typedef struct {
  ContactSurface s;
  PetscInt       dim, order;
  PetscInt      *facets, *first, *lattice, *hang, *hang_master;
  int8_t        *orders;
  PetscReal     *x, *X, *mirror, *hang_weight, *u; /* u[num_nodes][2]: place in the chart */
  PetscInt       num_true, *real;                  /* nodes that do not hang */
} Patch;

/* Node at a place of the chart; added when new. */
static inline PetscInt PatchNode(Patch *p, PetscReal a, PetscReal b)
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++)
    if (fabs(p->u[2 * n] - a) < 1e-9 && fabs(p->u[2 * n + 1] - b) < 1e-9) return n;
  p->u[2 * p->s.num_nodes]     = a;
  p->u[2 * p->s.num_nodes + 1] = b;
  return p->s.num_nodes++;
}

/* Facet [a, a + da] x [b, b + db] of the chart; forward: its outward normal is (1, 2) -> 3 of the chart, else against it (plane: body to the left of growing
 * a). */
static inline void PatchFacet(Patch *p, PetscReal a, PetscReal da, PetscReal b, PetscReal db, PetscBool forward)
{
  const PetscInt   q = p->order, f = p->s.num_facets++, m = p->dim - 1, num = m == 1 ? q + 1 : (q + 1) * (q + 1), nv = 2 * m;
  const PetscReal *node;

  CHECK_CALL(ElementGetNodes(q, &node));
  p->first[f + 1] = p->first[f] + num;
  p->orders[f]    = (int8_t)q;
  for (PetscInt k = 0; k < num; k++) {
    PetscInt i = k % (q + 1), j = k / (q + 1);

    if (!forward && m == 1) i = q - i;
    if (!forward && m == 2) {
      const PetscInt swap = i;

      i = j, j = swap;
    }
    p->lattice[p->first[f] + k] = PatchNode(p, a + da * node[i], m == 1 ? 0 : b + db * node[j]);
  }
  for (PetscInt v = 0; v < nv; v++) {
    const PetscInt at = v == 0 ? 0 : v == 1 ? q : v == 2 ? num - 1 : num - 1 - q;

    p->facets[nv * f + v] = p->lattice[p->first[f] + at];
  }
}

/* Nodes on a side of a refined facet hang on the facet that shares it, from (a, b) on, along direction i of the chart, unless they are nodes of it, too. */
static inline void PatchHang(Patch *p, PetscInt v, PetscReal a, PetscReal b, int i, PetscReal h, PetscInt *num)
{
  const PetscReal  from[2] = {a, b}, along = (p->u[2 * v + i] - from[i]) / h;
  PetscReal        value[MORTISE_MAX_ORDER + 1];
  const PetscReal *node;

  if (*num > p->hang[v] || fabs(p->u[2 * v + 1 - i] - from[1 - i]) > 1e-9 || along < 0 || along > 1) return;
  CHECK_CALL(ElementGetNodes(p->order, &node));
  for (PetscInt k = 0; k <= p->order; k++)
    if (fabs(node[k] - along) < 1e-9) return;
  CHECK_CALL(ElementEvaluate1D(p->order, along, value, NULL));
  for (PetscInt k = 0; k <= p->order; k++, (*num)++) {
    p->hang_master[*num] = PatchNode(p, a + (i ? 0 : h * node[k]), b + (i ? h * node[k] : 0));
    p->hang_weight[*num] = value[k];
  }
}

/* n (x n) facets, those that are refined[n x n] (space; NULL: none) in four. */
static inline void PatchRefined(Patch *p, PetscInt dim, PetscInt order, PetscInt n, PetscReal lo, PetscReal hi, PetscBool forward, const PetscBool refined[])
{
  const PetscInt  m = dim - 1, most = m == 1 ? n : 4 * n * n, num = m == 1 ? order + 1 : (order + 1) * (order + 1), nodes = most * num;
  const PetscReal h = (hi - lo) / (PetscReal)n;

  memset(p, 0, sizeof(*p));
  p->dim = dim, p->order = order;
  p->facets      = calloc((size_t)(4 * most), sizeof(PetscInt));
  p->first       = calloc((size_t)(most + 1), sizeof(PetscInt));
  p->lattice     = calloc((size_t)nodes, sizeof(PetscInt));
  p->orders      = calloc((size_t)most, sizeof(int8_t));
  p->u           = calloc((size_t)(2 * nodes), sizeof(PetscReal));
  p->x           = calloc((size_t)(3 * nodes), sizeof(PetscReal));
  p->X           = calloc((size_t)(3 * nodes), sizeof(PetscReal));
  p->mirror      = calloc((size_t)(6 * nodes), sizeof(PetscReal));
  p->hang        = calloc((size_t)(nodes + 1), sizeof(PetscInt));
  p->hang_master = calloc((size_t)(nodes * (order + 1)), sizeof(PetscInt));
  p->hang_weight = calloc((size_t)(nodes * (order + 1)), sizeof(PetscReal));
  p->real        = calloc((size_t)nodes, sizeof(PetscInt));
  for (PetscInt k = 0; k < (m == 1 ? n : n * n); k++) {
    const PetscReal a = lo + h * (PetscReal)(k % n), b = lo + h * (PetscReal)(k / n);

    if (!refined || !refined[k])
      PatchFacet(p, a, h, b, h, forward);
    else
      for (int c = 0; c < 4; c++) PatchFacet(p, a + c % 2 * h / 2, h / 2, b + c / 2 * h / 2, h / 2, forward);
  }
  for (PetscInt v = 0, num_hang = 0; v < p->s.num_nodes; v++) {
    p->hang[v] = num_hang;
    for (PetscInt k = 0; k < n * n && refined; k++)
      for (int side = 0; side < 4 && refined[k]; side++) {
        const PetscInt i = side % 2, at[2] = {k % n, k / n}, across = at[1 - i] + (side / 2 ? 1 : -1), line = at[1 - i] + side / 2;

        if (across < 0 || across == n || refined[i ? n * at[1] + across : n * across + at[0]]) continue;
        PatchHang(p, v, lo + h * (PetscReal)(i ? line : at[0]), lo + h * (PetscReal)(i ? at[1] : line), (int)i, h, &num_hang);
      }
    p->hang[v + 1] = num_hang;
  }
  for (PetscInt v = 0; v < p->s.num_nodes; v++)
    if (p->hang[v] == p->hang[v + 1]) p->real[p->num_true++] = v;
  p->s.dim = dim, p->s.facets = p->facets, p->s.x = p->x, p->s.X = p->X, p->s.mirror = p->mirror;
  p->s.order = p->orders, p->s.first = p->first, p->s.lattice = p->lattice;
  if (refined) p->s.hang = p->hang, p->s.hang_master = p->hang_master, p->s.hang_weight = p->hang_weight;
}

/* The same, refined: the last of them. */
static inline void PatchCreate(Patch *p, PetscInt dim, PetscInt order, PetscInt n, PetscReal lo, PetscReal hi, PetscBool forward, PetscBool refined)
{
  PetscBool last[64] = {PETSC_FALSE};

  if (refined) last[n * n - 1] = PETSC_TRUE;
  PatchRefined(p, dim, order, n, lo, hi, forward, refined ? last : NULL);
}

static inline void PatchDestroy(Patch *p)
{
  free(p->facets), free(p->first), free(p->lattice), free(p->orders), free(p->u), free(p->x), free(p->X), free(p->mirror);
  free(p->hang), free(p->hang_master), free(p->hang_weight), free(p->real);
}

/* Hanging nodes follow. */
static inline void PatchFollow(Patch *p)
{
  for (PetscInt v = 0; v < p->s.num_nodes; v++) {
    if (p->hang[v] == p->hang[v + 1]) continue;
    for (PetscInt c = 0; c < p->dim; c++) {
      p->x[p->dim * v + c] = 0;
      for (PetscInt k = p->hang[v]; k < p->hang[v + 1]; k++) p->x[p->dim * v + c] += p->hang_weight[k] * p->x[p->dim * p->hang_master[k] + c];
    }
  }
}

static inline void SumCreate(Sum *s, const Patch *nonmortar, const Patch *mortar)
{
  SumCreateFor(s, nonmortar->dim, nonmortar->s.num_nodes, mortar->s.num_nodes);
}

#define SumEvaluate(sum, pair, nonmortar, mortar, z, hessian) SumSurfaces(sum, pair, &(nonmortar)->s, &(mortar)->s, z, PETSC_TRUE, hessian)

/* What a pair with nothing but these two patches gives, which are no longer needed then; how many facets were not seen. */
static inline PetscInt SumBetween(Sum *s, Patch *nonmortar, Patch *mortar)
{
  const ContactSpec spec = {.friction = 0};
  PetscInt          degenerate;
  ContactPair       pair;

  CHECK_CALL(ContactPairCreate(nonmortar->dim, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, nonmortar, mortar, 0.5, 1e-3);
  SumCreate(s, nonmortar, mortar);
  SumEvaluate(s, pair, nonmortar, mortar, NULL, PETSC_FALSE);
  degenerate = ContactPairGetDegenerate(pair);
  PatchDestroy(nonmortar);
  PatchDestroy(mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
  return degenerate;
}

/* Rotation of space about an axis through the origin and a shift, x only. */
static inline void PatchMove(Patch *p, const PetscReal axis[3], PetscReal angle, const PetscReal shift[3])
{
  const PetscReal l = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]), k[3] = {axis[0] / l, axis[1] / l, axis[2] / l};

  for (PetscInt n = 0; n < p->s.num_nodes + (p->dim == 3 ? 2 : 1) * p->s.num_nodes; n++) { /* positions, then planes of symmetry */
    const PetscBool place = (PetscBool)(n < p->s.num_nodes);
    PetscReal      *x = place ? p->x + p->dim * n : p->mirror + p->dim * (n - p->s.num_nodes), v[3] = {x[0], x[1], p->dim == 3 ? x[2] : 0};
    const PetscReal along = k[0] * v[0] + k[1] * v[1] + k[2] * v[2];

    for (PetscInt i = 0; i < p->dim; i++)
      x[i] = cos(angle) * v[i] + sin(angle) * (k[(i + 1) % 3] * v[(i + 2) % 3] - k[(i + 2) % 3] * v[(i + 1) % 3]) + (1 - cos(angle)) * along * k[i] +
             (place ? shift[i] : 0);
  }
}
