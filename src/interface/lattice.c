/* Contact surfaces: nodes on the Gauss-Lobatto lattices of their facets.

   A facet's nodes are those of the space on it and on its sides; where a side has a lower order, or hangs, the lattice's nodes in it hang on the side's own.
   All of it follows from the replicated tables of the forest and the orders, so every rank makes the same surface. */
#include "interfaceimpl.h"
#include <petsc/private/hashmapi.h>

#define KEY(entity, index) (FOREST_PARTS * (entity) + (index))

/* Under construction. */
typedef struct {
  HPSpace             space;
  const ForestTables *t;
  Surface            *s;
  PetscHMapI          number;            /* node of an entity -> node of the surface */
  PetscInt            room, hangs, rows; /* for nodes; rows so far, and room for them */
  PetscReal          *place;             /* [room] coordinate on its edge of a lattice node in one, in space */
  PetscInt           *master;            /* [rows] */
  PetscReal          *weight;            /* [rows] */
} Lattice;

/* The node of an entity (index -1: one that nobody shares), new unless it is there. */
static PetscErrorCode Node_Private(Lattice *l, PetscInt entity, PetscInt index, PetscReal place, PetscInt *node)
{
  Surface *s = l->s;

  PetscFunctionBegin;
  *node = -1;
  if (index >= 0) PetscCall(PetscHMapIGet(l->number, KEY(entity, index), node));
  if (*node >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->num_nodes == l->room) {
    l->room = 2 * l->room + 64;
    PetscCall(PetscRealloc(l->room * sizeof(PetscInt), &s->node_entity));
    PetscCall(PetscRealloc(l->room * sizeof(PetscInt), &s->node_index));
    PetscCall(PetscRealloc(l->room * sizeof(PetscReal), &l->place));
  }
  s->node_entity[s->num_nodes] = entity;
  s->node_index[s->num_nodes]  = index;
  l->place[s->num_nodes]       = place;
  *node                        = s->num_nodes++;
  if (index >= 0) PetscCall(PetscHMapISet(l->number, KEY(entity, index), *node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a corner lies in the frame of its facet: 0 or 1 along each axis. */
static void Corner_Private(const Lattice *l, PetscInt facet, PetscInt corner, PetscInt at[2])
{
  const Surface  *s      = l->s;
  const PetscInt  vertex = s->node_entity[s->facets[s->corners * facet + corner]];
  const PetscInt *cl     = l->t->closure + l->t->closure_offset[s->facet_entity[facet]];
  PetscInt        i      = 0;

  while (cl[i] != vertex) ++i;
  at[0] = i % 3 / 2;
  at[1] = i / 6;
}

/* The node at g (0..q along each axis of the facet's frame). */
static PetscErrorCode LatticeNode_Private(Lattice *l, PetscInt facet, PetscInt q, const PetscInt g[2], PetscInt *node)
{
  const ForestTables *t        = l->t;
  const PetscInt      place[2] = {g[0] == 0 ? 0 : g[0] == q ? 2 : 1, g[1] == 0 ? 0 : g[1] == q ? 2 : 1};
  const PetscInt      axes = t->dim - 1, at = t->closure_offset[l->s->facet_entity[facet]] + place[0] + (axes == 2 ? 3 * place[1] : 0);
  const PetscInt      entity = t->closure[at], inside = (place[0] == 1) + (axes == 2 && place[1] == 1);
  const PetscReal    *nodes;

  PetscFunctionBegin;
  if (inside == axes) {
    PetscCall(Node_Private(l, entity, g[0] - 1 + (axes == 2 ? (q - 1) * (g[1] - 1) : 0), 0, node));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (inside == 0) {
    PetscCall(Node_Private(l, entity, 0, 0, node));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const PetscInt along = place[0] == 1 ? g[0] : g[1], i = t->orientation[at] & 1 ? q - along : along;
  PetscCall(ElementGetNodes(q, &nodes));
  const PetscInt order = HPSpaceGetOrder(l->space, entity);
  PetscCall(Node_Private(l, entity, order == q ? i - 1 : -1, nodes[i], node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lattice of one facet, first direction from corner 0 to 1, second from corner 0 to 3. */
static PetscErrorCode FacetLattice_Private(Lattice *l, PetscInt facet)
{
  Surface       *s = l->s;
  const PetscInt q = s->order[facet], axes = s->dim - 1;
  PetscInt       at[3][2];

  PetscFunctionBegin;
  Corner_Private(l, facet, 0, at[0]);
  Corner_Private(l, facet, 1, at[1]);
  Corner_Private(l, facet, s->corners - 1, at[2]); /* in the plane the same again, and not used */
  for (PetscInt k = s->first[facet]; k < s->first[facet + 1]; ++k) {
    const PetscInt i = (k - s->first[facet]) % (q + 1), j = (k - s->first[facet]) / (q + 1);
    PetscInt       g[2] = {0, 0};
    if (axes == 1 && i % q == 0) { /* a corner may have more nodes than one */
      s->lattice[k] = s->facets[2 * facet + i / q];
      continue;
    }
    for (PetscInt a = 0; a < axes; ++a) g[a] = q * at[0][a] + i * (at[1][a] - at[0][a]) + j * (at[2][a] - at[0][a]);
    PetscCall(LatticeNode_Private(l, facet, q, g, &s->lattice[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row of a node in an edge of space, empty if it is a true node. Masters that are no nodes yet (of a coarse edge at the rim) become some. */
static PetscErrorCode NodeRow_Private(Lattice *l, PetscInt node)
{
  const PetscInt entity = l->s->node_entity[node];
  PetscInt       num, nodes[MOST_LATTICE_MASTERS][2];
  PetscReal      weights[MOST_LATTICE_MASTERS];

  PetscFunctionBegin;
  if (entity >= l->t->first[2] || (l->t->parent[entity] < 0 && l->s->node_index[node] >= 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HPSpaceGetTraceRow(l->space, entity, &l->place[node], MOST_LATTICE_MASTERS, &num, nodes, weights));
  if (l->hangs + num > l->rows) {
    l->rows = 2 * (l->hangs + num);
    PetscCall(PetscRealloc(l->rows * sizeof(PetscInt), &l->master));
    PetscCall(PetscRealloc(l->rows * sizeof(PetscReal), &l->weight));
  }
  for (PetscInt k = 0; k < num; ++k) {
    PetscCall(Node_Private(l, nodes[k][0], nodes[k][1], 0, &l->master[l->hangs]));
    l->weight[l->hangs++] = weights[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Rows_Private(Lattice *l)
{
  Surface       *s   = l->s;
  const PetscInt num = s->num_nodes; /* masters that join here are true */
  PetscInt      *hang;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num + 1, &hang));
  hang[0] = 0;
  for (PetscInt n = 0; n < num; ++n) {
    if (s->dim == 3) PetscCall(NodeRow_Private(l, n));
    hang[n + 1] = l->hangs;
  }
  PetscCall(PetscMalloc1(s->num_nodes + 1, &s->hang));
  for (PetscInt n = 0; n <= s->num_nodes; ++n) s->hang[n] = hang[PetscMin(n, num)];
  PetscCall(PetscMalloc2(l->hangs, &s->hang_master, l->hangs, &s->hang_weight));
  PetscCall(PetscArraycpy(s->hang_master, l->master, l->hangs));
  PetscCall(PetscArraycpy(s->hang_weight, l->weight, l->hangs));
  PetscCall(PetscFree(hang));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceLattice_Private(HPSpace space, const ForestTables *t, Surface *s)
{
  Lattice l = {.space = space, .t = t, .s = s, .room = s->num_nodes};

  PetscFunctionBegin;
  PetscCall(PetscHMapICreate(&l.number));
  PetscCall(PetscCalloc1(l.room, &l.place));
  PetscCall(PetscRealloc(l.room * sizeof(PetscInt), &s->node_entity)); /* the corners have room for as many as there are corners of facets */
  for (PetscInt n = 0; n < s->num_nodes; ++n) PetscCall(PetscHMapISet(l.number, KEY(s->node_entity[n], 0), n));
  PetscCall(PetscMalloc1(s->num_facets, &s->order));
  PetscCall(PetscMalloc1(s->num_facets + 1, &s->first));
  s->first[0] = 0;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    PetscInt q;
    q               = HPSpaceGetOrder(space, s->facet_entity[f]);
    s->order[f]     = (int8_t)q;
    s->higher       = (PetscBool)(s->higher || q > 1);
    s->first[f + 1] = s->first[f] + ElementNumNodes(s->dim - 1, q);
  }
  PetscCall(PetscMalloc1(s->first[s->num_facets], &s->lattice));
  for (PetscInt f = 0; f < s->num_facets; ++f) PetscCall(FacetLattice_Private(&l, f));
  PetscCall(Rows_Private(&l));
  PetscCall(PetscHMapIDestroy(&l.number));
  PetscCall(FreeAll(3, (void *[]){&l.place, &l.master, &l.weight}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SurfacePoint_Private(const Surface *s, PetscInt facet, const PetscReal x[], const PetscReal xi[], PetscBool axisymmetric, PetscReal N[])
{
  const PetscInt *node, num = SurfaceNodes_Private(s, facet, &node);
  PetscReal       tangent[2][3], normal[3], radius = 0;

  SurfaceTangents_Private(s->dim, s->order[facet], num, node, x, xi, N, tangent);
  for (PetscInt k = 0; k < num; ++k) radius += N[k] * x[s->dim * node[k]];
  Cross3(tangent[0], tangent[1], normal);
  return PetscSqrtReal(Dot3(normal, normal)) * (axisymmetric ? 2 * PETSC_PI * radius : 1);
}
