/* Rows of hanging nodes and cells, resolved to true nodes.

   All constraints are interpolation: the trace on an entity is a tensor polynomial of the entity's orders along its axes, its values at the entity's
   Gauss-Lobatto nodes are the entity's own unknowns inside and the traces of its sub-entities on its boundary; a hanging entity's
   trace is that of the entity it hangs on (the orders agree by HPSpaceOrders_Private). */
#include "hpimpl.h"

#define SMALL_WEIGHT 1e-13 /* below this an interpolation weight is round-off of an exact zero */

PetscErrorCode HPRowReset_Private(HPRow *row)
{
  PetscFunctionBegin;
  row->num = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPRowDestroy_Private(HPRow *row)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(row->node));
  PetscCall(PetscFree(row->weight));
  row->num = row->size = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RowAdd_Private(HPRow *row, PetscInt node, PetscReal weight)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < row->num; ++i) {
    if (row->node[i] == node) {
      row->weight[i] += weight;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  if (row->num == row->size) {
    row->size = PetscMax(16, 2 * row->size);
    PetscCall(PetscRealloc(row->size * sizeof(PetscInt), &row->node));
    PetscCall(PetscRealloc(row->size * sizeof(PetscReal), &row->weight));
  }
  row->node[row->num]     = node;
  row->weight[row->num++] = weight;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Point xi of a hanging entity in the frame of the one it hangs on. */
void HPToParent_Private(PetscInt parent_dim, const int8_t place[3], const PetscReal xi[], PetscReal eta[3])
{
  for (PetscInt a = 0, k = 0; a < parent_dim; ++a) {
    if (place[a] == 3)
      eta[a] = 0.5;
    else if (place[a] == 2)
      eta[a] = xi[k++];
    else
      eta[a] = 0.5 * (xi[k++] + place[a]);
  }
}

/* Add scale * (trace of the entity at xi of its frame) to the row, of the space with all orders cut down to limit. Recurses to sub-entities and parents.
   Not collective. */
PetscErrorCode HPRowAccumulate_Private(HPSpace hp, PetscInt entity, const PetscReal xi[], PetscInt limit, PetscReal scale, HPRow *row)
{
  const ForestTables *t = hp->tables;
  const PetscInt      d = HPEntityDim_Private(t, entity);
  PetscReal           L[3][MORTISE_MAX_ORDER + 1], eta[3];
  const PetscReal    *nodes[3];
  PetscInt            num = 1, p[3];

  PetscFunctionBegin;
  if (t->parent[entity] >= 0) {
    const PetscInt parent = t->parent[entity];
    HPToParent_Private(HPEntityDim_Private(t, parent), t->parent_place + 3 * entity, xi, eta);
    PetscCall(HPRowAccumulate_Private(hp, parent, eta, limit, scale, row));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCheck(row->everywhere || hp->entity_point[entity] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "entity %" PetscInt_FMT " is needed as a master but is not in this rank's chart", entity);
  const PetscInt first = row->everywhere ? HP_NODE(entity, 0) : hp->point_node[hp->entity_point[entity]];
  if (d == 0) {
    PetscCall(RowAdd_Private(row, first, scale));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt a = 0; a < d; ++a) {
    p[a] = PetscMin(hp->axis_order[entity][a], limit);
    num *= p[a] + 1;
    PetscCall(ElementGetNodes(p[a], &nodes[a]));
    PetscCall(ElementEvaluate1D(p[a], xi[a], L[a], NULL));
  }
  for (PetscInt i = 0; i < num; ++i) {
    PetscInt  index = 0, inner = 0, stride = 1, k = 0, place = 1;
    PetscReal weight = scale, tangent[3];
    for (PetscInt a = 0, j = i; a < d; ++a, stride *= 3) {
      const PetscInt ia = j % (p[a] + 1), ta = ia == 0 ? 0 : ia == p[a] ? 2 : 1;
      weight *= L[a][ia];
      index += ta * stride;
      if (ta == 1) {
        tangent[k++] = nodes[a][ia];
        inner += (ia - 1) * place;
        place *= p[a] - 1;
      }
      j /= p[a] + 1;
    }
    if (PetscAbsReal(weight) < SMALL_WEIGHT) continue;
    if (k == d) {
      PetscCall(RowAdd_Private(row, first + inner, weight));
      continue;
    }
    const PetscInt offset = t->closure_offset[entity] + index;
    ForestOrient(k, t->orientation[offset], tangent, eta);
    PetscCall(HPRowAccumulate_Private(hp, t->closure[offset], eta, limit, weight, row));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Node of an entity for integer tangential node indices ia (1..p-1, the owner's axes, k of them) under an orientation code. */
static PetscInt OrientedNode_Private(PetscInt first, PetscInt k, int8_t code, PetscInt p, const PetscInt ia[])
{
  if (k == 0) return first;
  if (k == 1) return first + ((code & 1) ? p - ia[0] : ia[0]) - 1;
  if (k == 3) return first + (ia[0] - 1) + (p - 1) * ((ia[1] - 1) + (p - 1) * (ia[2] - 1));
  PetscInt a = (code & 4) ? ia[1] : ia[0], b = (code & 4) ? ia[0] : ia[1];
  if (code & 1) a = p - a;
  if (code & 2) b = p - b;
  return first + (a - 1) + (p - 1) * (b - 1);
}

/* Tensor node i of a leaf of order p: its place in the closure, integer and real tangential coordinates; returns their number. */
PetscInt HPLeafNode_Private(PetscInt dim, PetscInt p, const PetscReal *nodes, PetscInt i, PetscInt *index, PetscInt ia[3], PetscReal tangent[3])
{
  PetscInt k = 0, stride = 1;
  *index = 0;
  for (PetscInt a = 0; a < dim; ++a, i /= p + 1, stride *= 3) {
    const PetscInt j = i % (p + 1);
    if (j == 0) continue;
    *index += (j == p ? 2 : 1) * stride;
    if (j == p) continue;
    tangent[k] = nodes[j];
    ia[k++]    = j;
  }
  return k;
}

/* Has the entity this order along all its axes? */
static PetscBool HasOrder_Private(HPSpace hp, PetscInt entity, PetscInt d, PetscInt p)
{
  for (PetscInt a = 0; a < d; ++a)
    if (hp->axis_order[entity][a] != p) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Row of tensor node i of a cell: a single true node (returned) or, where order or hanging intervene, a row (-1 returned). */
static PetscErrorCode CellNodeRow_Private(HPSpace hp, PetscInt cell, PetscInt i, const PetscReal *nodes, PetscInt *node, HPRow *row)
{
  const ForestTables *t = hp->tables;
  const PetscInt      p = hp->cell_order[cell], offset = t->closure_offset[t->first[t->dim] + hp->cell_leaf[cell]];
  PetscInt            index, ia[3];
  PetscReal           tangent[3], eta[3];

  PetscFunctionBegin;
  const PetscInt k      = HPLeafNode_Private(t->dim, p, nodes, i, &index, ia, tangent);
  const PetscInt entity = t->closure[offset + index];
  if (t->parent[entity] < 0 && HasOrder_Private(hp, entity, k, p)) {
    *node = OrientedNode_Private(hp->point_node[hp->entity_point[entity]], k, t->orientation[offset + index], p, ia);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *node = -1;
  PetscCall(HPRowReset_Private(row));
  ForestOrient(k, t->orientation[offset + index], tangent, eta);
  PetscCall(HPRowAccumulate_Private(hp, entity, eta, MORTISE_MAX_ORDER, 1.0, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Reserve_Private(PetscInt needed, PetscInt *size, size_t unit, void *array)
{
  PetscFunctionBegin;
  if (needed > *size) {
    *size = PetscMax(needed, 2 * *size);
    PetscCall(PetscRealloc(*size * unit, (void **)array));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Masters of a cell that is not simple: union of the rows of its nodes, and the dense matrix. */
static PetscErrorCode ConstrainedCell_Private(HPSpace hp, PetscInt cell, PetscInt n, const PetscReal *nodes, HPRow *rows, HPRow *masters, PetscReal **dense,
                                              PetscInt *size)
{
  PetscFunctionBegin;
  PetscCall(HPRowReset_Private(masters));
  for (PetscInt pass = 0; pass < 2; ++pass) {
    if (pass) {
      PetscCall(Reserve_Private(n * masters->num, size, sizeof(PetscReal), dense));
      PetscCall(PetscArrayzero(*dense, n * masters->num));
    }
    for (PetscInt i = 0; i < n; ++i) {
      PetscInt node;
      PetscCall(CellNodeRow_Private(hp, cell, i, nodes, &node, rows));
      if (node >= 0) {
        PetscCall(HPRowReset_Private(rows));
        PetscCall(RowAdd_Private(rows, node, 1.0));
      }
      for (PetscInt k = 0; k < rows->num; ++k) {
        PetscInt m = 0;
        if (!pass)
          PetscCall(RowAdd_Private(masters, rows->node[k], 0.0));
        else {
          while (masters->node[m] != rows->node[k]) ++m;
          (*dense)[i * masters->num + m] += rows->weight[k];
        }
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CellRows_Private(HPSpace hp)
{
  HPTables  *v   = &hp->view;
  HPRow      row = {0}, masters = {0};
  PetscInt   size = 0, wsize = 0, dsize = 0, used = 0, wused = 0;
  PetscReal *dense = NULL;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(v->num_cells + 1, &hp->cell_row, v->num_cells, &hp->cell_weight));
  hp->cell_row[0] = 0;
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    const PetscInt   n = ElementNumNodes(hp->dim, hp->cell_order[c]);
    const PetscReal *nodes;
    PetscInt         i = 0, node;
    PetscCall(ElementGetNodes(hp->cell_order[c], &nodes));
    PetscCall(Reserve_Private(used + n, &size, sizeof(PetscInt), &hp->cell_master));
    for (; i < n; ++i) {
      PetscCall(CellNodeRow_Private(hp, c, i, nodes, &node, &row));
      if (node < 0) break;
      hp->cell_master[used + i] = node;
    }
    hp->cell_weight[c] = -1;
    if (i == n)
      used += n;
    else {
      PetscCall(ConstrainedCell_Private(hp, c, n, nodes, &row, &masters, &dense, &dsize));
      PetscCall(Reserve_Private(used + masters.num, &size, sizeof(PetscInt), &hp->cell_master));
      PetscCall(Reserve_Private(wused + n * masters.num, &wsize, sizeof(PetscReal), &hp->weight));
      PetscCall(PetscArraycpy(hp->cell_master + used, masters.node, masters.num));
      PetscCall(PetscArraycpy(hp->weight + wused, dense, n * masters.num));
      hp->cell_weight[c] = wused;
      used += masters.num;
      wused += n * masters.num;
    }
    hp->cell_row[c + 1] = used;
  }
  PetscCall(HPRowDestroy_Private(&row));
  PetscCall(HPRowDestroy_Private(&masters));
  PetscCall(PetscFree(dense));
  v->cell_row    = hp->cell_row;
  v->cell_master = hp->cell_master;
  v->cell_weight = hp->cell_weight;
  v->weight      = hp->weight;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row of local node `index` of a hanging entity. */
static PetscErrorCode HangingNodeRow_Private(HPSpace hp, PetscInt entity, PetscInt index, HPRow *row)
{
  PetscReal xi[3] = {0, 0, 0};

  PetscFunctionBegin;
  PetscCall(HPNodePoint_Private(hp, entity, index, xi));
  PetscCall(HPRowReset_Private(row));
  PetscCall(HPRowAccumulate_Private(hp, entity, xi, MORTISE_MAX_ORDER, 1.0, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode HangingRows_Private(HPSpace hp)
{
  HPTables *v     = &hp->view;
  HPRow     row   = {0};
  PetscInt  msize = 0, wsize = 0, used = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_nodes + 1, &hp->node_hang));
  hp->node_hang[0] = 0;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscInt entity = hp->node_entity[n];
    if (hp->tables->parent[entity] >= 0) {
      PetscCall(HangingNodeRow_Private(hp, entity, n - hp->point_node[hp->entity_point[entity]], &row));
      PetscCall(Reserve_Private(used + row.num, &msize, sizeof(PetscInt), &hp->hang_master));
      PetscCall(Reserve_Private(used + row.num, &wsize, sizeof(PetscReal), &hp->hang_weight));
      PetscCall(PetscArraycpy(hp->hang_master + used, row.node, row.num));
      PetscCall(PetscArraycpy(hp->hang_weight + used, row.weight, row.num));
      used += row.num;
    }
    hp->node_hang[n + 1] = used;
  }
  PetscCall(HPRowDestroy_Private(&row));
  v->node_hang   = hp->node_hang;
  v->hang_master = hp->hang_master;
  v->hang_weight = hp->hang_weight;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceRows_Private(HPSpace hp)
{
  PetscFunctionBegin;
  PetscCall(HangingRows_Private(hp));
  PetscCall(CellRows_Private(hp));
  PetscFunctionReturn(PETSC_SUCCESS);
}
