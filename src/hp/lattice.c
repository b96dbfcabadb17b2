/* Cells as they are drawn: positions and values on an equispaced lattice.

   Each piece is drawn (multi)linear. Neighbours that cut a curved face or edge at different points would gape, so every entity has one lattice, that of its
   order (the lowest around it), and where a cell's points lie between those of the entity, they lie on its pieces; points of a hanging entity on the pieces of
   the one it hangs on. No piece crosses a point of a coarser lattice: halves of n pieces are cut where the whole is, and numbers of pieces in one mesh divide
   one another (HPSpacePieces). It is constraint.c once more, with hats on the lattice in place of the polynomials. */
#include "hpimpl.h"

#define SMALL_SHARE 1e-12 /* closer to a point of the lattice, in pieces: on it */

PetscErrorCode HPSpacePieces(HPSpace hp, PetscInt divide, PetscInt pieces[MORTISE_MAX_ORDER + 1])
{
  const ForestTables *t     = hp->tables;
  PetscInt            order = 1;
  PetscBool           mixed = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt e = t->first[1]; e < t->num_entities; ++e) {
    if (hp->entity_order[e] == 1 || hp->entity_order[e] == order) continue;
    if (order > 1) mixed = PETSC_TRUE;
    order = hp->entity_order[e];
  }
  for (PetscInt p = 1, power = 1; p <= MORTISE_MAX_ORDER; ++p) {
    while (power < p) power *= 2;
    pieces[p] = divide ? divide : mixed ? power : p;
  }
  pieces[0] = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add scale * (what is drawn of the entity at xi of its frame) to the row. Recurses to sub-entities and parents. */
static PetscErrorCode Drawn_Private(HPSpace hp, PetscInt entity, const PetscReal xi[], const PetscInt pieces[], PetscReal scale, HPRow *row)
{
  const ForestTables *t = hp->tables;
  const PetscInt      d = HPEntityDim_Private(t, entity), n = pieces[hp->entity_order[entity]], parent = t->parent[entity];
  PetscReal           share[3], eta[3];
  PetscInt            piece[3];

  PetscFunctionBegin;
  if (parent >= 0) {
    HPToParent_Private(HPEntityDim_Private(t, parent), t->parent_place + 3 * entity, xi, eta);
    PetscCall(Drawn_Private(hp, parent, eta, pieces, scale, row));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt a = 0; a < d; ++a) {
    piece[a] = PetscMax(0, PetscMin(n - 1, (PetscInt)PetscFloorReal(n * xi[a])));
    share[a] = n * xi[a] - piece[a];
  }
  for (PetscInt corner = 0; corner < 1 << d; ++corner) {
    PetscReal weight = scale, tangent[3];
    PetscInt  index = 0, k = 0;
    for (PetscInt a = 0, stride = 1; a < d; ++a, stride *= 3) {
      const PetscInt high = corner >> a & 1, at = piece[a] + high;
      weight *= high ? share[a] : 1 - share[a];
      index += (at == 0 ? 0 : at == n ? 2 : 1) * stride;
      if (at > 0 && at < n) tangent[k++] = (PetscReal)at / n;
    }
    if (PetscAbsReal(weight) < SMALL_SHARE) continue;
    if (k == d) { /* a point of the lattice inside the entity: the polynomial */
      PetscCall(HPRowAccumulate_Private(hp, entity, tangent, MORTISE_MAX_ORDER, weight, row));
      continue;
    }
    const PetscInt offset = t->closure_offset[entity] + index;
    ForestOrient(k, t->orientation[offset], tangent, eta);
    PetscCall(Drawn_Private(hp, t->closure[offset], eta, pieces, weight, row));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Positions and values at the lattice by the cell's own polynomials, both[(max(n, p)+1)^dim][2 dim]. */
static PetscErrorCode Polynomials_Private(HPSpace hp, PetscInt cell, PetscInt n, const PetscReal local[], PetscReal both[])
{
  const PetscInt dim = hp->dim, p = hp->cell_order[cell], num = ElementNumNodes(dim, p), most = ElementNumNodes(dim, PetscMax(n, p));
  PetscReal     *nodal, *in, *work, E[(MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1)];

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(2 * dim * num, &nodal, 2 * dim * num, &in, 2 * dim * most, &work));
  PetscCall(HPSpaceGatherPositions(hp, cell, nodal));
  PetscCall(HPSpaceGather(hp, cell, local, nodal + dim * num));
  for (PetscInt i = 0; i < num; ++i) {
    for (PetscInt c = 0; c < dim; ++c) {
      in[2 * dim * i + c]       = nodal[dim * i + c];
      in[2 * dim * i + dim + c] = nodal[dim * (num + i) + c];
    }
  }
  for (PetscInt k = 0; k <= n; ++k) PetscCall(ElementEvaluate1D(p, (PetscReal)k / n, E + k * (p + 1), NULL));
  PetscCall(ElementTransform(dim, p + 1, n + 1, 2 * dim, E, in, both, work));
  PetscCall(PetscFree3(nodal, in, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceLattice(HPSpace hp, PetscInt cell, const PetscInt pieces[], const PetscReal local[], PetscReal X[], PetscReal values[])
{
  const ForestTables *t   = hp->tables;
  const PetscInt      dim = hp->dim, offset = t->closure_offset[t->first[dim] + hp->cell_leaf[cell]];
  const PetscInt      n = pieces[hp->cell_order[cell]], num = ElementNumNodes(dim, n);
  PetscReal          *both, nodes[MORTISE_MAX_ORDER + 1];
  HPRow               row = {0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k <= n; ++k) nodes[k] = (PetscReal)k / n;
  PetscCall(PetscMalloc1(2 * dim * ElementNumNodes(dim, PetscMax(n, hp->cell_order[cell])), &both));
  PetscCall(Polynomials_Private(hp, cell, n, local, both));
  for (PetscInt i = 0; i < num; ++i) {
    PetscReal tangent[3], eta[3], *x = X + dim * i, *value = values + dim * i;
    PetscInt  index, ia[3];
    PetscCall(PetscArraycpy(x, both + 2 * dim * i, dim));
    PetscCall(PetscArraycpy(value, both + 2 * dim * i + dim, dim));
    const PetscInt k = HPLeafNode_Private(dim, n, nodes, i, &index, ia, tangent), entity = t->closure[offset + index];
    if (t->parent[entity] < 0 && (k == 0 || k == dim || pieces[hp->entity_order[entity]] == n)) continue;
    ForestOrient(k, t->orientation[offset + index], tangent, eta);
    PetscCall(HPRowReset_Private(&row));
    PetscCall(Drawn_Private(hp, entity, eta, pieces, 1, &row));
    PetscCall(PetscArrayzero(x, dim));
    PetscCall(PetscArrayzero(value, dim));
    for (PetscInt m = 0; m < row.num; ++m) {
      PetscReal u[3];
      HPNodeValue_Private(hp, row.node[m], local, u);
      for (PetscInt c = 0; c < dim; ++c) {
        x[c] += row.weight[m] * hp->X[3 * row.node[m] + c];
        value[c] += row.weight[m] * u[c];
      }
    }
  }
  PetscCall(HPRowDestroy_Private(&row));
  PetscCall(PetscFree(both));
  PetscFunctionReturn(PETSC_SUCCESS);
}
