/* The new displacement interpolates the old one at the new true nodes. */
#include "transferimpl.h"

#define INSIDE 1e-12 /* a point this far outside a leaf (in its own units) still belongs to it: round-off of node positions */

PetscBool TransferPlace_Private(const TransferContext *c, PetscInt new_leaf, const PetscReal place[], PetscInt old_leaf, PetscReal xi[3])
{
  const ForestTables *o = c->old_t, *n = c->new_t;

  if (o->leaf_root[old_leaf] != n->leaf_root[new_leaf]) return PETSC_FALSE;
  for (PetscInt d = 0; d < o->dim; ++d) {
    const PetscReal from  = (PetscReal)(n->leaf_lo[3 * new_leaf + d] - o->leaf_lo[3 * old_leaf + d]); /* exact: integers */
    const PetscReal size  = (PetscReal)(1 << (FOREST_MAX_LEVEL - n->leaf_level[3 * new_leaf + d])),
                    whole = (PetscReal)(1 << (FOREST_MAX_LEVEL - o->leaf_level[3 * old_leaf + d]));
    xi[d]                 = (from + place[d] * size) / whole;
    if (xi[d] < -INSIDE || xi[d] > 1 + INSIDE) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Place in the leaf `entity_leaf` of node `index` of an entity of dimension d and orders p[d] along its axes. */
static PetscErrorCode NodePlace_Private(const ForestTables *t, PetscInt entity, PetscInt d, const PetscInt p[], PetscInt index, PetscReal place[3])
{
  const PetscInt   offset = t->closure_offset[t->first[t->dim] + t->entity_leaf[entity]];
  const PetscReal *nodes;
  PetscReal        eta[3], tangent[3];
  PetscInt         at = 0, k = 0;

  PetscFunctionBegin;
  for (PetscInt a = 0, i = index; a < d; i /= p[a] - 1, ++a) {
    PetscCall(ElementGetNodes(p[a], &nodes));
    eta[a] = nodes[1 + i % (p[a] - 1)];
  }
  while (t->closure[offset + at] != entity) ++at;
  const int8_t code = t->orientation[offset + at];
  for (PetscInt a = 0; a < d; ++a) { /* inverse of ForestOrient */
    const PetscBool flip                      = (PetscBool)(d < 3 && ((code >> a) & 1));
    tangent[d == 2 && (code & 4) ? 1 - a : a] = flip ? 1 - eta[a] : eta[a];
  }
  for (PetscInt a = 0, j = at; a < t->dim; ++a, j /= 3) place[a] = j % 3 == 1 ? tangent[k++] : (j % 3) / 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The old displacement (Cartesian) at a place of a new leaf. Where several old leaves meet they agree: the field is continuous. */
static PetscErrorCode OldValue_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, const PetscReal place[], PetscReal *basis, PetscReal u[3])
{
  PetscInt  k = c->map->old_first[leaf], order;
  PetscReal xi[3];

  PetscFunctionBegin;
  while (k < c->map->old_first[leaf] + c->map->old_count[leaf] && !TransferPlace_Private(c, leaf, place, k, xi)) ++k;
  PetscCheck(k < c->map->old_first[leaf] + c->map->old_count[leaf], PETSC_COMM_SELF, PETSC_ERR_PLIB, "the old leaves of leaf %" PetscInt_FMT " do not cover it",
             leaf);
  PetscCall(HPSpaceGetOrder(c->old_space, c->old_t->first[c->old_t->dim] + k, &order));
  PetscCall(ElementEvaluate(c->old_t->dim, order, xi, basis, NULL));
  const PetscReal *values = old->values + old->offset[k];
  for (PetscInt a = 0; a < c->old_t->dim; ++a) u[a] = 0;
  for (PetscInt i = 0; i < ElementNumNodes(c->old_t->dim, order); ++i) {
    for (PetscInt a = 0; a < c->old_t->dim; ++a) u[a] += basis[i] * values[i * c->old_t->dim + a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferTurn_Private(HPSpace space, PetscInt dim, PetscInt node, PetscBool back, const PetscReal from[], PetscReal to[])
{
  const PetscReal *frame;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetFrame(space, node, &frame));
  for (PetscInt k = 0; k < dim; ++k) {
    to[k] = frame ? 0 : from[k];
    for (PetscInt a = 0; frame && a < dim; ++a) to[k] += (back ? frame[3 * a + k] : frame[3 * k + a]) * from[a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferDisplacement_Private(const TransferContext *c, const OldCells *old, PetscReal local[])
{
  const ForestTables *t = c->new_t;
  PetscReal          *basis, place[3], u[3];
  PetscInt            orders[3], start = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(ElementNumNodes(t->dim, MORTISE_MAX_ORDER), &basis));
  for (PetscInt n = 0; n < c->new_v->num_nodes; ++n) {
    const PetscInt entity = c->new_v->node_entity[n], leaf = t->entity_leaf[entity];
    PetscInt       d = 0;
    if (n && entity != c->new_v->node_entity[n - 1]) start = n;
    if (t->parent[entity] >= 0 || t->leaf_rank[leaf] != c->rank) continue;
    while (entity >= t->first[d + 1]) ++d;
    PetscCall(HPSpaceGetAxisOrders(c->new_space, entity, orders));
    PetscCall(NodePlace_Private(t, entity, d, orders, n - start, place));
    PetscCall(OldValue_Private(c, old, leaf, place, basis, u));
    PetscCall(TransferTurn_Private(c->new_space, t->dim, n, PETSC_FALSE, u, local + n * t->dim));
  }
  PetscCall(PetscFree(basis));
  PetscFunctionReturn(PETSC_SUCCESS);
}
