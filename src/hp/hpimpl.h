/* Private to hp. */
#pragma once
#include "hp.h"

struct _p_HPSpace {
  Forest              forest;          /* borrowed */
  const ForestTables *tables;          /* borrowed */
  PetscInt            dim, num_points; /* points of the leaf DMPlex */
  const PetscInt     *point_entity;    /* borrowed [num_points] */
  PetscInt           *entity_point;    /* owned [num_entities], -1 where the entity is not in this rank's chart */
  int8_t             *entity_order;    /* owned [num_entities]: the highest of axis_order, of cells that of the kernel */
  int8_t (*axis_order)[3];             /* owned [num_entities] along the axes of the entity's frame, by the minimum rule */
  DM         dm;                       /* owned: clone of the leaf DM with section and constraints */
  HPTables   view;                     /* what HPSpaceGetTables shows; arrays below own its memory */
  PetscInt  *point_node, *node_entity, *cell_leaf, *cell_order, *cell_row, *cell_master, *cell_weight, *node_hang, *hang_master;
  PetscReal *weight, *hang_weight, *X;
  PetscInt  *global_dof; /* owned [num_nodes*dim], -1 constrained */
  PetscInt   num_frames;
  PetscInt  *node_frame; /* owned [num_nodes] index into frame or -1; NULL: no frames */
  PetscReal (*frame)[9]; /* owned [num_frames] rows are the directions of the dofs */
  PetscReal *work;       /* owned, gather and transform */
};

/* A sparse row under construction: true local nodes and weights. */
typedef struct {
  PetscBool  everywhere; /* nodes as HP_NODE(entity, index), which every rank knows, instead of local ones */
  PetscInt   num, size;
  PetscInt  *node;
  PetscReal *weight;
} HPRow;

#define HP_SIDE_NODES ((MORTISE_MAX_ORDER - 1) * (MORTISE_MAX_ORDER - 1)) /* most of an entity below cells */
_Static_assert(HP_SIDE_NODES <= FOREST_PARTS, "HP_NODE overflows");
#define HP_NODE(entity, index) (HP_SIDE_NODES * (entity) + (index))

/* order.c: entity_order and axis_order from leaf orders and their caps (NULL: none). */
PetscErrorCode HPSpaceOrders_Private(HPSpace, const int8_t leaf_order[], const int8_t leaf_cap[][3], uint64_t linear_groups);
/* node.c: numbering, positions of nodes. */
PetscErrorCode HPSpaceNodes_Private(HPSpace, PetscInt num_owned_cells);
PetscErrorCode HPSpacePositions_Private(HPSpace, uint64_t linear_groups, uint64_t mirror_groups);
/* Point of node i of an entity in its frame: interior Gauss-Lobatto points of the orders along its axes, lexicographic. */
PetscErrorCode HPNodePoint_Private(HPSpace, PetscInt entity, PetscInt i, PetscReal eta[3]);
void           HPEntityToLeaf_Private(const ForestTables *, PetscInt leaf, PetscInt entity, PetscInt d, const PetscReal eta[], PetscReal xi[3]);
/* surface.c: how far the vertices of linear contact faces lie off the exact geometry, [num vertices][3], owned by the caller. */
PetscErrorCode HPSpaceSurfaceShift_Private(HPSpace, uint64_t groups, uint64_t mirror_groups, PetscReal **shift);
/* constraint.c: rows of hanging nodes and cells. */
PetscErrorCode HPSpaceRows_Private(HPSpace);
PetscErrorCode HPRowReset_Private(HPRow *);
PetscErrorCode HPRowDestroy_Private(HPRow *);
PetscErrorCode HPRowAccumulate_Private(HPSpace, PetscInt entity, const PetscReal xi[], PetscInt limit, PetscReal scale, HPRow *);
/* Point xi of a hanging entity in the frame of the one it hangs on. */
void HPToParent_Private(PetscInt parent_dim, const int8_t place[3], const PetscReal xi[], PetscReal eta[3]);
/* Tensor node i of a leaf of order p: its place in the closure, integer and real tangential coordinates; returns their number. */
PetscInt HPLeafNode_Private(PetscInt dim, PetscInt p, const PetscReal *nodes, PetscInt i, PetscInt *index, PetscInt ia[3], PetscReal tangent[3]);
/* section.c: sections and default constraints. */
PetscErrorCode HPSpaceSections_Private(HPSpace, const int8_t fixed[]);

static inline const PetscReal *HPFrame_Private(HPSpace hp, PetscInt node)
{
  return hp->node_frame && hp->node_frame[node] >= 0 ? hp->frame[hp->node_frame[node]] : NULL;
}

/* Cartesian values of a true node. */
static inline void HPNodeValue_Private(HPSpace hp, PetscInt node, const PetscReal local[], PetscReal value[])
{
  const PetscReal *q = HPFrame_Private(hp, node), *dof = local + node * hp->dim;
  for (PetscInt c = 0; c < hp->dim; ++c) {
    if (!q)
      value[c] = dof[c];
    else {
      value[c] = 0;
      for (PetscInt k = 0; k < hp->dim; ++k) value[c] += q[3 * k + c] * dof[k];
    }
  }
}

static inline PetscInt HPEntityDim_Private(const ForestTables *t, PetscInt entity)
{
  PetscInt d = 0;
  while (entity >= t->first[d + 1]) ++d;
  return d;
}

static inline PetscInt HPNodesOfEntity_Private(PetscInt d, const int8_t order[3])
{
  PetscInt n = 1;
  for (PetscInt a = 0; a < d; ++a) n *= order[a] - 1;
  return n;
}
