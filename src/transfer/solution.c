/* The new displacement is the old one at the new true nodes. */
#include "transferimpl.h"

#define INSIDE 1e-12 /* a point this far outside a leaf (in its own units) still belongs to it: round-off of node positions */
#define STILL 1e-10  /* a node that has moved by less, in units of its cell, has not */

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

/* u += du/dX (X - X_old) with the gradients by xi of both. Singular maps (edges that meet in an axis): nothing. */
static void Shift_Private(PetscInt dim, const PetscReal dX[3][3], const PetscReal du[3][3], const PetscReal away[3], PetscReal u[3])
{
  PetscReal a[3];

  if (!(Det3((const PetscReal *)dX) > 0) || !Solve3((const PetscReal *)dX, away, a)) return;
  for (PetscInt k = 0; k < dim; ++k) {
    for (PetscInt i = 0; i < dim; ++i) u[k] += du[k][i] * a[i];
  }
}

PetscErrorCode TransferOldPoint_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, const PetscReal xi[], PetscReal work[], OldPoint *p)
{
  const PetscInt dim = c->old_t->dim;

  PetscFunctionBegin;
  *p                      = (OldPoint){.dX = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const PetscInt   order  = HPSpaceGetOrder(c->old_space, c->old_t->first[dim] + leaf);
  const PetscInt   n      = ElementNumNodes(dim, order);
  const PetscReal *values = old->values + old->offset[leaf], *nodes = values + n * dim, *slope = work + n;
  PetscCall(ElementEvaluate(dim, order, xi, work, work + n));
  for (PetscInt a = 0; a < dim; ++a) {
    p->dX[a][a] = 0;
    for (PetscInt i = 0; i < n; ++i) {
      p->u[a] += work[i] * values[i * dim + a];
      p->X[a] += work[i] * nodes[i * dim + a];
      for (PetscInt b = 0; b < dim; ++b) {
        p->dX[a][b] += slope[i * dim + b] * nodes[i * dim + a];
        p->du[a][b] += slope[i * dim + b] * values[i * dim + a];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The old displacement (Cartesian) for a node at X and at `place` of a new leaf. Where several old leaves meet they agree: the field is continuous. The place
   need not be where it was: linear faces that are split follow a curved boundary more closely. The displacement goes on along the old leaf's gradient then, so
   that the deformation stays the same; interpolated, a layer that is thinner by a share f would be strained by as much, against the bulk modulus. */
static PetscErrorCode OldValue_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, const PetscReal place[], const PetscReal X[],
                                       PetscReal work[], PetscReal u[3])
{
  const PetscInt dim = c->old_t->dim;
  PetscInt       k   = c->map->old_first[leaf];
  PetscReal      xi[3], away[3] = {0}, far2 = 0, size2 = 0;
  OldPoint       p;

  PetscFunctionBegin;
  while (k < c->map->old_first[leaf] + c->map->old_count[leaf] && !TransferPlace_Private(c, leaf, place, k, xi)) ++k;
  PetscCheck(k < c->map->old_first[leaf] + c->map->old_count[leaf], PETSC_COMM_SELF, PETSC_ERR_PLIB, "the old leaves of leaf %" PetscInt_FMT " do not cover it",
             leaf);
  PetscCall(TransferOldPoint_Private(c, old, k, xi, work, &p));
  for (PetscInt a = 0; a < dim; ++a) {
    u[a]    = p.u[a];
    away[a] = X[a] - p.X[a];
    far2 += PetscSqr(away[a]);
    for (PetscInt b = 0; b < dim; ++b) size2 += PetscSqr(p.dX[a][b]);
  }
  if (far2 > PetscSqr(STILL) * size2) Shift_Private(dim, (const PetscReal(*)[3])p.dX, (const PetscReal(*)[3])p.du, away, u);
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
  PetscCall(PetscMalloc1((1 + t->dim) * ElementNumNodes(t->dim, MORTISE_MAX_ORDER), &basis));
  for (PetscInt n = 0; n < c->new_v->num_nodes; ++n) {
    const PetscInt entity = c->new_v->node_entity[n], leaf = t->entity_leaf[entity];
    PetscInt       d = 0;
    if (n && entity != c->new_v->node_entity[n - 1]) start = n;
    if (t->parent[entity] >= 0 || t->leaf_rank[leaf] != c->rank) continue;
    while (entity >= t->first[d + 1]) ++d;
    PetscCall(HPSpaceGetAxisOrders(c->new_space, entity, orders));
    PetscCall(NodePlace_Private(t, entity, d, orders, n - start, place));
    PetscCall(OldValue_Private(c, old, leaf, place, c->new_v->X + 3 * n, basis, u));
    PetscCall(TransferTurn_Private(c->new_space, t->dim, n, PETSC_FALSE, u, local + n * t->dim));
  }
  PetscCall(PetscFree(basis));
  PetscFunctionReturn(PETSC_SUCCESS);
}
