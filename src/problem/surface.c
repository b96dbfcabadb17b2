/* Replicated curves of facets for contact in two dimensions: topology, positions, places of their dofs in the problem's vector. */
#include "problemimpl.h"

/* Ends of a leaf's side in the order that keeps the body on the left. */
static PetscErrorCode EdgeVertices_Private(const ForestTables *t, PetscInt facet, PetscInt leaf, PetscInt vertex[2])
{
  const PetscInt *cl    = t->closure + t->closure_offset[t->first[2] + leaf];
  PetscInt        index = 0;

  PetscFunctionBegin;
  while (cl[index] != facet) ++index;
  const PetscInt  direction = index % 3 == 1 ? 1 : 0, high = (direction == 0 ? index % 3 : index / 3) == 2;
  const PetscInt  stride = direction == 0 ? 3 : 1, base = index - stride; /* the two ends lie one stride below and above */
  const PetscBool keep = (PetscBool)((direction == 0) == (high == 1));
  vertex[0]            = cl[keep ? base : index + stride];
  vertex[1]            = cl[keep ? index + stride : base];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SurfaceTopology_Private(const ForestTables *t, PetscInt group, Surface *s)
{
  PetscInt *number;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->first[1], &number));
  for (PetscInt v = 0; v < t->first[1]; ++v) number[v] = -1;
  for (PetscInt f = t->first[1]; f < t->first[2]; ++f) s->num_edges += (t->boundary[f] >> group) & 1;
  PetscCall(PetscMalloc3(2 * s->num_edges, &s->edges, s->num_edges, &s->edge_leaf, 2 * s->num_edges, &s->node_entity));
  s->num_edges = 0;
  for (PetscInt f = t->first[1]; f < t->first[2]; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - t->first[1]);
    PetscInt        vertex[2];
    if (!((t->boundary[f] >> group) & 1) || leaf[0] < 0 || leaf[1] >= 0 || t->parent[f] >= 0) continue;
    PetscCall(EdgeVertices_Private(t, f, leaf[0], vertex));
    for (PetscInt k = 0; k < 2; ++k) {
      if (number[vertex[k]] < 0) {
        number[vertex[k]]              = s->num_nodes;
        s->node_entity[s->num_nodes++] = vertex[k];
      }
      s->edges[2 * s->num_edges + k] = number[vertex[k]];
    }
    s->edge_leaf[s->num_edges++] = leaf[0];
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SurfaceNeighbours_Private(Surface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * s->num_nodes, &s->node_edge));
  for (PetscInt n = 0; n < 2 * s->num_nodes; ++n) s->node_edge[n] = -1;
  for (PetscInt e = 0; e < s->num_edges; ++e) {
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscInt n = s->edges[2 * e + k];
      PetscCheckInput(s->node_edge[2 * n + (k == 0)] < 0,
                      "contact: a surface branches at one of its points, or runs through it twice; give its parts names of their own");
      s->node_edge[2 * n + (k == 0)] = e; /* 0: the edge that ends here, 1: the one that begins */
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A node where the surface ends on a plane along which it may only slide: its normal is averaged with its mirror image. A support that holds the end across the
   surface is no such plane: the image would cancel the normal. */
static void NodeMirror_Private(Surface *s, PetscInt n, PetscInt fixed)
{
  if (s->node_edge[2 * n] >= 0 && s->node_edge[2 * n + 1] >= 0) return;
  if (fixed != 1 && fixed != 2) return;
  const PetscInt   k = fixed == 1 ? 0 : 1, edge = PetscMax(s->node_edge[2 * n], s->node_edge[2 * n + 1]);
  const PetscReal *plane = s->frame + 4 * n + 2 * k, *a = s->X + 2 * s->edges[2 * edge], *b = s->X + 2 * s->edges[2 * edge + 1];
  const PetscReal  along = plane[0] * (b[0] - a[0]) + plane[1] * (b[1] - a[1]), across = plane[0] * (b[1] - a[1]) - plane[1] * (b[0] - a[0]);
  if (PetscAbsReal(along) < PetscAbsReal(across)) return;
  for (PetscInt c = 0; c < 2; ++c) s->mirror[2 * n + c] = s->frame[4 * n + 2 * k + c];
}

/* Fields every rank needs of nodes it may not have: one reduction from the owners. */
static PetscErrorCode SurfaceFields_Private(Problem p, Surface *s)
{
  const HPTables     *v;
  const ForestTables *t;
  const PetscInt     *point_entity;
  PetscInt            num_points, owned_cells;
  PetscReal          *buffer;
  DM                  dm;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(ForestGetTables(p->forest, &t));
  PetscCall(ForestGetLeafDM(p->forest, &dm, &owned_cells, &num_points, &point_entity));
  PetscCall(PetscMalloc3(s->num_nodes, &s->local, s->num_nodes, &s->owned, 2 * s->num_nodes, &s->dof));
  PetscCall(PetscCalloc4(2 * s->num_nodes, &s->X, 2 * s->num_nodes, &s->x, 2 * s->num_nodes, &s->mirror, 4 * s->num_nodes, &s->frame));
  PetscCall(PetscCalloc2(2 * s->num_nodes, &s->du, 2 * s->num_nodes, &s->force));
  PetscInt *number;
  PetscCall(PetscMalloc1(t->first[1], &number));
  for (PetscInt e = 0; e < t->first[1]; ++e) number[e] = -1;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    if (v->node_entity[n] < t->first[1]) number[v->node_entity[n]] = n;
  }
  PetscCall(PetscCalloc1(7 * s->num_nodes, &buffer));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    s->local[n] = number[s->node_entity[n]];
    s->owned[n] = (PetscBool)(t->leaf_rank[t->entity_leaf[s->node_entity[n]]] == p->rank);
    if (!s->owned[n]) continue;
    const PetscReal *frame;
    PetscReal       *b = buffer + 7 * n;
    PetscCall(HPSpaceGetFrame(p->space, s->local[n], &frame));
    for (PetscInt c = 0; c < 2; ++c) b[c] = v->X[3 * s->local[n] + c];
    for (PetscInt k = 0; k < 2; ++k)
      for (PetscInt c = 0; c < 2; ++c) b[2 + 2 * k + c] = frame ? frame[3 * k + c] : (PetscReal)(k == c);
    b[6] = p->supports.fixed[s->local[n]];
  }
  PetscCall(PetscFree(number));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, buffer, (PetscMPIInt)(7 * s->num_nodes), MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscCall(PetscArraycpy(s->X + 2 * n, buffer + 7 * n, 2));
    PetscCall(PetscArraycpy(s->frame + 4 * n, buffer + 7 * n + 2, 4));
    s->dof[2 * n] = s->dof[2 * n + 1] = (PetscInt)buffer[7 * n + 6]; /* the fixed bits, until the indices are known */
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) NodeMirror_Private(s, n, s->dof[2 * n]);
  PetscCall(PetscArraycpy(s->x, s->X, 2 * s->num_nodes));
  PetscCall(PetscFree(buffer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceCreate_Private(Problem p, PetscInt group, Surface *s)
{
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  PetscCall(ForestGetTables(p->forest, &t));
  PetscCall(SurfaceTopology_Private(t, group, s));
  PetscCall(SurfaceNeighbours_Private(s));
  PetscCall(SurfaceFields_Private(p, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceDestroy_Private(Surface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(s->edges, s->edge_leaf, s->node_entity));
  PetscCall(PetscFree(s->node_edge));
  PetscCall(PetscFree3(s->local, s->owned, s->dof));
  PetscCall(PetscFree4(s->X, s->x, s->mirror, s->frame));
  PetscCall(PetscFree2(s->du, s->force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Indices of the nodes' dofs in the problem's vector, from their owners (stored +2 so that a sum works and -1 survives). */
PetscErrorCode SurfaceIndices_Private(Problem p, Surface *s)
{
  PetscFunctionBegin;
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    for (PetscInt c = 0; c < 2; ++c) s->dof[2 * n + c] = s->owned[n] ? p->index[s->local[n] * 2 + c] + 2 : 0;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->dof, (PetscMPIInt)(2 * s->num_nodes), MPIU_INT, MPI_SUM, p->comm));
  for (PetscInt n = 0; n < 2 * s->num_nodes; ++n) s->dof[n] -= 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceGather_Private(Problem p, const Surface *s, const PetscReal local[], const PetscReal base[], PetscReal values[])
{
  PetscFunctionBegin;
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    for (PetscInt c = 0; c < 2; ++c) {
      const PetscReal *q = s->frame + 4 * n, *dof = local + 2 * s->local[n];
      values[2 * n + c] = s->owned[n] ? q[c] * dof[0] + q[2 + c] * dof[1] : 0;
    }
  }
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, values, (PetscMPIInt)(2 * s->num_nodes), MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt n = 0; base && n < 2 * s->num_nodes; ++n) values[n] += base[n];
  PetscFunctionReturn(PETSC_SUCCESS);
}
