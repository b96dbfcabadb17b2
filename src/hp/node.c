/* Node numbering in the order of the leaf DMPlex's points, and node positions. */
#include "hpimpl.h"

PetscErrorCode HPSpaceNodes_Private(HPSpace hp, PetscInt num_owned_cells)
{
  const ForestTables *t         = hp->tables;
  HPTables           *v         = &hp->view;
  PetscInt            num_cells = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(t->num_entities, &hp->entity_point, hp->num_points + 1, &hp->point_node));
  for (PetscInt e = 0; e < t->num_entities; ++e) hp->entity_point[e] = -1;
  hp->point_node[0] = 0;
  for (PetscInt i = 0; i < hp->num_points; ++i) {
    const PetscInt e      = hp->point_entity[i];
    hp->entity_point[e]   = i;
    hp->point_node[i + 1] = hp->point_node[i] + HPNodesOfEntity_Private(HPEntityDim_Private(t, e), hp->axis_order[e]);
    if (e >= t->first[t->dim]) ++num_cells;
  }
  v->num_nodes = hp->point_node[hp->num_points];
  PetscCall(PetscMalloc3(v->num_nodes, &hp->node_entity, num_cells, &hp->cell_leaf, num_cells, &hp->cell_order));
  for (PetscInt i = 0; i < hp->num_points; ++i) {
    for (PetscInt n = hp->point_node[i]; n < hp->point_node[i + 1]; ++n) hp->node_entity[n] = hp->point_entity[i];
  }
  for (PetscInt c = 0; c < num_cells; ++c) {
    hp->cell_leaf[c]  = hp->point_entity[c] - t->first[t->dim];
    hp->cell_order[c] = hp->entity_order[hp->point_entity[c]];
  }
  v->dim             = t->dim;
  v->num_cells       = num_cells;
  v->num_owned_cells = num_owned_cells;
  v->point_node      = hp->point_node;
  v->node_entity     = hp->node_entity;
  v->cell_leaf       = hp->cell_leaf;
  v->cell_order      = hp->cell_order;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPNodePoint_Private(HPSpace hp, PetscInt entity, PetscInt i, PetscReal eta[3])
{
  const PetscInt d = HPEntityDim_Private(hp->tables, entity);

  PetscFunctionBegin;
  for (PetscInt a = 0; a < d; ++a) {
    const PetscInt   inner = hp->axis_order[entity][a] - 1;
    const PetscReal *nodes;
    PetscCall(ElementGetNodes(inner + 1, &nodes));
    eta[a] = nodes[1 + i % inner];
    i /= inner;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Inverse of ForestOrient in two dimensions and below. */
static void OrientInverse_Private(PetscInt d, int8_t code, const PetscReal eta[], PetscReal xi[])
{
  if (d == 1) xi[0] = (code & 1) ? 1 - eta[0] : eta[0];
  if (d == 2) {
    const PetscReal a = (code & 1) ? 1 - eta[0] : eta[0], b = (code & 2) ? 1 - eta[1] : eta[1];
    xi[0] = (code & 4) ? b : a;
    xi[1] = (code & 4) ? a : b;
  }
  if (d == 3)
    for (PetscInt a = 0; a < 3; ++a) xi[a] = eta[a];
}

/* Position in leaf coordinates of the point eta of an entity in the closure of the leaf. */
void HPEntityToLeaf_Private(const ForestTables *t, PetscInt leaf, PetscInt entity, PetscInt d, const PetscReal eta[], PetscReal xi[3])
{
  const PetscInt  offset = t->closure_offset[t->first[t->dim] + leaf];
  const PetscInt *cl     = t->closure + offset;
  PetscReal       tangent[3];
  PetscInt        i = 0, k = 0;

  while (cl[i] != entity) ++i;
  OrientInverse_Private(d, t->orientation[offset + i], eta, tangent);
  for (PetscInt a = 0, j = i; a < t->dim; ++a, j /= 3) xi[a] = j % 3 == 1 ? tangent[k++] : (j % 3) / 2;
}

/* X of true nodes lies on the exact geometry (vertices of linear contact faces: see surface.c); hanging nodes follow their masters, so that geometry and
   displacement live in one space: rigid motions and linear fields are represented exactly on every mesh, and neighbours never gape. */
PetscErrorCode HPSpacePositions_Private(HPSpace hp, uint64_t linear_groups, uint64_t mirror_groups)
{
  const ForestTables *t = hp->tables;
  PetscReal          *shift;

  PetscFunctionBegin;
  PetscCall(HPSpaceSurfaceShift_Private(hp, linear_groups, mirror_groups, &shift));
  PetscCall(PetscCalloc1(3 * hp->view.num_nodes, &hp->X));
  hp->view.X = hp->X;
  for (PetscInt i = 0; i < hp->num_points; ++i) {
    const PetscInt e = hp->point_entity[i], d = HPEntityDim_Private(t, e);
    if (t->parent[e] >= 0) continue;
    for (PetscInt n = hp->point_node[i]; n < hp->point_node[i + 1]; ++n) {
      PetscReal eta[3] = {0, 0, 0}, xi[3] = {0, 0, 0};
      PetscCall(HPNodePoint_Private(hp, e, n - hp->point_node[i], eta));
      HPEntityToLeaf_Private(t, t->entity_leaf[e], e, d, eta, xi);
      PetscCall(ForestMapPoint(hp->forest, t->entity_leaf[e], xi, &hp->X[3 * n]));
      for (PetscInt a = 0; d == 0 && a < 3; ++a) hp->X[3 * n + a] += shift[3 * e + a];
    }
  }
  PetscCall(PetscFree(shift));
  for (PetscInt n = 0; n < hp->view.num_nodes; ++n) {
    for (PetscInt k = hp->node_hang[n]; k < hp->node_hang[n + 1]; ++k) {
      for (PetscInt a = 0; a < 3; ++a) hp->X[3 * n + a] += hp->hang_weight[k] * hp->X[3 * hp->hang_master[k] + a];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
