/* Floor 2. The hp finite element space on the leaves of a forest: orders by the minimum rule, numbering, hanging-node and order constraints.

   A *node* is a scalar location (vertex, or interior Gauss-Lobatto point of an edge, face or cell); the field has dim components at each.
   An edge has one order, a face or cell one along each axis of its frame.
   Local nodes: those of all entities of this rank's leaf DMPlex; dof of node i, component c: local vector entry i*dim + c. A node is *free* of hanging
   constraints ("true") or *hanging* (its row lists true nodes). Cell rows are resolved to true nodes.
   Nodes may carry a frame (skew supports): the dofs of such a node are components along the rows of its frame. Gather and Scatter
   speak Cartesian components to the cells, so nobody else sees frames. */
#pragma once
#include "element.h"
#include "forest.h"

typedef struct _p_HPSpace *HPSpace;

/* Local tables, borrowed. Cells: owned first, then ghosts. */
typedef struct {
  PetscInt        dim, num_nodes, num_cells, num_owned_cells;
  const PetscInt *cell_leaf;   /* [num_cells] */
  const PetscInt *cell_order;  /* [num_cells] */
  const PetscInt *cell_row;    /* [num_cells+1] offsets into cell_master */
  const PetscInt *cell_master; /* true local nodes a cell depends on; count n_m = cell_row[c+1]-cell_row[c] */
  const PetscInt
      *cell_weight; /* [num_cells] offset of the dense matrix [(p+1)^dim][n_m] in weight, -1: the masters are the cell's nodes in lexicographic order */
  const PetscReal *weight;
  const PetscInt  *node_entity; /* [num_nodes] global entity id */
  const PetscInt  *node_hang;   /* [num_nodes+1] offsets of a hanging node's row (empty: true node) */
  const PetscInt  *hang_master; /* true local nodes */
  const PetscReal *hang_weight;
  const PetscReal *X;          /* [num_nodes][3] reference positions: the hp interpolant of the exact geometry, hanging nodes included */
  const PetscInt  *point_node; /* [num_points+1] first node of each DMPlex point */
} HPTables;

/* Space with leaf_order[num_leaves] (replicated) cell orders; leaf_cap[num_leaves][3] (replicated; NULL: none): the order along an axis of a cell is the lower
   of leaf_order and this cap. Cells are integrated with nodes of leaf_order in all directions, lower orders are constraints on them; on entities in the closure
   of facets with a bit of linear_groups the order is 1 (contact faces). Facets with a bit of mirror_groups lie in planes of symmetry: linear faces that end
   there go on as their mirror images. Numbers nodes and computes rows. Collective. */
PetscErrorCode HPSpaceCreate(Forest, const int8_t leaf_order[], const int8_t leaf_cap[][3], uint64_t linear_groups, uint64_t mirror_groups, HPSpace *);
/* Prescribed dofs: fixed[num_nodes] bit c: component c (in the node's frame) is prescribed; frames: num_frames nodes and their 3x3 rows.
   Hanging nodes must not be marked. `inactive` nodes (NULL: none; of rigid bodies) carry no unknowns: all dofs prescribed.
   Builds the local and global section, the DM's default constraints with bias, and vectors. Collective. */
PetscErrorCode HPSpaceSetUp(HPSpace, const int8_t fixed[], PetscInt num_frames, const PetscInt frame_node[], const PetscReal frame[][9]);
PetscErrorCode HPSpaceDestroy(HPSpace *);
/* Raise order[num_leaves] (replicated) until no two leaves that share a facet, or a part of one, differ by more than `difference`; leaves with a mark in
   fixed[num_leaves] stay as they are, whatever their neighbours. Not collective. */
PetscErrorCode  HPOrdersLimit(Forest, PetscInt difference, const int8_t fixed[], int8_t order[]);
const HPTables *HPSpaceGetTables(HPSpace);
Forest          HPSpaceGetForest(HPSpace);
DM              HPSpaceGetDM(HPSpace); /* leaf DM clone with section and constraints */
/* Global index of each local dof, [num_nodes*dim]: -1 prescribed or hanging. Numbering of the space's own global vector. */
PetscErrorCode HPSpaceGetGlobalDofs(HPSpace, const PetscInt **);
PetscErrorCode HPSpaceGetFrame(HPSpace, PetscInt node, const PetscReal **frame); /* NULL: Cartesian */
/* Order of a global entity, in this rank's chart or not: the highest along its axes; of a cell its leaf_order. */
PetscInt HPSpaceGetOrder(HPSpace, PetscInt entity);
/* Orders of a global entity along the axes of its frame; its nodes are the products of their interior Gauss-Lobatto points, lexicographic. Not collective. */
PetscErrorCode HPSpaceGetAxisOrders(HPSpace, PetscInt entity, PetscInt orders[3]);
/* Does any cell of any rank have a lower order than its leaf_order along some axis? The nodes inside such a cell cannot be condensed. Not collective. */
PetscErrorCode HPSpaceIsDirectional(HPSpace, PetscBool *directional);

/* The multilinear function through the vertices that takes node's place in the space of order 1 on this mesh: true local vertex nodes and weights,
   at most max of them. A node that is a true vertex: itself. */
PetscErrorCode HPSpaceGetVertexRow(HPSpace, PetscInt node, PetscInt max, PetscInt *num, PetscInt vertices[], PetscReal weights[]);

/* The trace of the space at xi of the frame of an entity below cells, of this rank's chart or not: num (at most max) true nodes by their entity and their place
   in it (interior Gauss-Lobatto points, lexicographic in its frame), and weights. Not collective. */
PetscErrorCode HPSpaceGetTraceRow(HPSpace, PetscInt entity, const PetscReal xi[], PetscInt max, PetscInt *num, PetscInt nodes[][2], PetscReal weights[]);

/* Cartesian nodal values [n][dim] of cell from a local array of true dofs (hanging entries of the array are not read). */
PetscErrorCode HPSpaceGather(HPSpace, PetscInt cell, const PetscReal local[], PetscReal values[]);
/* Reference positions [n][dim] of the cell's nodes. */
PetscErrorCode HPSpaceGatherPositions(HPSpace, PetscInt cell, PetscReal X[]);
/* Pieces each way in which cells, faces and edges of each order are drawn: divide (1..MORTISE_MAX_ORDER), or with 0 as many as the order; where orders above 1
   are mixed the next power of two. Not collective. */
PetscErrorCode HPSpacePieces(HPSpace, PetscInt divide, PetscInt pieces[MORTISE_MAX_ORDER + 1]);
/* The cell as it is drawn, in n = pieces[its order] pieces each way: positions X and values (Cartesian, from a local array) at the (n+1)^dim points of the
   equispaced lattice, [..][dim]. They are those of the polynomials, except on entities that are cut into fewer pieces or hang: what is drawn of neighbours
   meets everywhere (lattice.c). Not collective. */
PetscErrorCode HPSpaceLattice(HPSpace, PetscInt cell, const PetscInt pieces[], const PetscReal local[], PetscReal X[], PetscReal values[]);
/* The leaf DM with a PetscFE of the highest order of any cell as its one field, for PETSc's own tools; cells have straight sides there. The caller destroys it.
   Collective. */
PetscErrorCode HPSpaceCreateFE(HPSpace, const char *field, DM *);
/* The same field in it: a local vector of that DM (its ghost cells included) from a local array of true dofs. Not collective. */
PetscErrorCode HPSpaceToFE(HPSpace, const PetscReal local[], DM, Vec);
/* Add P^T r to the local array (true dofs). */
PetscErrorCode HPSpaceScatterAdd(HPSpace, PetscInt cell, const PetscReal r[], PetscReal local[]);
/* K_m = P^T K P: true dofs of the cell, in order masters x components (frames applied); work at least (n*dim)^2. dofs: local dof indices [n_m*dim]. */
PetscErrorCode HPSpaceTransformMatrix(HPSpace, PetscInt cell, const PetscReal K[], PetscReal Km[], PetscInt dofs[], PetscInt *num_dofs);
/* The same for a matrix from which the nodes inside the cell are eliminated: K over the cell's nodes nodes[num] (lexicographic places), all but the inner ones;
   Km over the masters but these. The nodes inside a cell are the local nodes point_node[cell] .. point_node[cell+1]-1, true ones without a frame, which no
   other cell depends on. Not for a space with directional orders. */
PetscErrorCode HPSpaceTransformBoundary(HPSpace, PetscInt cell, PetscInt num, const PetscInt nodes[], const PetscReal K[], PetscReal Km[], PetscInt dofs[],
                                        PetscInt *num_dofs);
