/* Fields of the nodes of a contact surface: positions, supports, places in the problem's vector, and their exchange between ranks. */
#include "interfaceimpl.h"

/* A node where the surface ends on a plane along which it may only slide: its normal is averaged with its mirror image. A support that holds the end across the
   surface is no such plane: the image would cancel the normal. Facets that lie in the plane, as the side of half a body, meet nothing and are no part of it. */
static void NodeMirror_Private(Surface *s, PetscInt n, PetscInt fixed)
{
  const PetscReal *plane = s->frame + 4 * n + (fixed == 1 ? 0 : 2);
  PetscInt         steep = 0;

  if (fixed != 1 && fixed != 2) return;
  for (PetscInt f = s->node_first[n]; f < s->node_first[n + 1]; ++f) {
    const PetscInt  *node = s->facets + 2 * s->node_facet[f];
    const PetscReal *a = s->X + 2 * node[0], *b = s->X + 2 * node[1];
    const PetscReal  along = plane[0] * (b[0] - a[0]) + plane[1] * (b[1] - a[1]), across = plane[0] * (b[1] - a[1]) - plane[1] * (b[0] - a[0]);

    if (node[0] != n && node[1] != n) return; /* inside an edge */
    if (PetscAbsReal(along) <= ROUND_LENGTH * PetscAbsReal(across)) continue;
    if (PetscAbsReal(along) < PetscAbsReal(across)) return;
    ++steep;
  }
  for (PetscInt c = 0; c < 2 && steep == 1; ++c) s->mirror[2 * n + c] = plane[c];
}

/* The same in space: is the plane through a node with this unit normal one in which its facets end, all to one side of it, with an edge in it, and steeply? */
static PetscBool IsMirror_Private(const Surface *s, PetscInt n, const PetscReal plane[3])
{
  PetscReal lo = 0, hi = 0, N[3] = {0, 0, 0};
  PetscInt  on = 0;

  for (PetscInt f = s->node_first[n]; f < s->node_first[n + 1]; ++f) {
    const PetscInt *node = s->facets + 4 * s->node_facet[f];
    PetscReal       vector[3], e[3];

    ContactFacetVector(3, s->X, node, vector);
    if (PetscAbsReal(Dot3(plane, vector)) > (1 - ROUND_LENGTH) * PetscSqrtReal(Dot3(vector, vector))) continue; /* it lies in the plane */
    for (PetscInt c = 0; c < 3; ++c) N[c] += vector[c];
    for (PetscInt a = 0; a < 4; ++a) {
      for (PetscInt c = 0; c < 3; ++c) e[c] = s->X[3 * node[a] + c] - s->X[3 * n + c];
      const PetscReal along = Dot3(plane, e);

      lo = PetscMin(lo, along), hi = PetscMax(hi, along);
      if (node[a] != n && PetscSqr(along) < PetscSqr(ROUND_LENGTH) * Dot3(e, e)) ++on;
    }
  }
  return (PetscBool)(on > 0 && PetscMin(-lo, hi) <= ROUND_LENGTH * PetscMax(-lo, hi) && PetscSqr(Dot3(plane, N)) <= 0.5 * Dot3(N, N));
}

static void AddMirror_Private(Surface *s, PetscInt n, const PetscReal plane[3], PetscInt *num)
{
  if (*num == 2 || !IsMirror_Private(s, n, plane)) return;
  if (*num == 1 && PetscAbsReal(Dot3(plane, s->mirror + 6 * n)) > 1 - ROUND_LENGTH) return;
  for (PetscInt c = 0; c < 3; ++c) s->mirror[6 * n + 3 * (*num) + c] = plane[c];
  ++(*num);
}

/* Up to two planes: directions in which a corner is held. Where two planes meet at an angle these are orthonormal, the second of them no plane's normal: then
   also the normals to the line along which it may slide and to an edge. */
static void NodeMirrors_Private(Surface *s, PetscInt n, PetscInt fixed)
{
  PetscInt         num = 0, held[3], num_held = 0;
  const PetscReal *frame = s->frame + 9 * n;

  for (PetscInt k = 0; k < 3; ++k) {
    if (fixed >> k & 1) held[num_held++] = k;
  }
  for (PetscInt k = 0; k < num_held; ++k) AddMirror_Private(s, n, frame + 3 * held[k], &num);
  if (num_held != 2) return;
  for (PetscInt f = s->node_first[n]; f < s->node_first[n + 1]; ++f) {
    const PetscInt *node = s->facets + 4 * s->node_facet[f];

    for (PetscInt a = 0; a < 4; ++a) {
      PetscReal line[3], e[3], plane[3], length;

      for (PetscInt c = 0; c < 3; ++c) e[c] = s->X[3 * node[a] + c] - s->X[3 * n + c];
      Cross3(frame + 3 * held[0], frame + 3 * held[1], line);
      Cross3(line, e, plane);
      length = PetscSqrtReal(Dot3(plane, plane));
      if (!(length > ROUND_LENGTH * PetscSqrtReal(Dot3(e, e)))) continue; /* n itself, or an edge along the line */
      for (PetscInt c = 0; c < 3; ++c) plane[c] /= length;
      AddMirror_Private(s, n, plane, &num);
    }
  }
}

/* What this rank owns, and what it knows without asking: nodes that its cells and ghost cells depend on. */
static PetscErrorCode Shares_Private(Interface p, const HPTables *v, const ForestTables *t, Surface *s)
{
  PetscBool *used;

  PetscFunctionBegin;
  PetscCall(PetscMalloc5(s->num_nodes, &s->owner, s->num_nodes, &s->own, s->num_facets, &s->mine, s->num_nodes, &s->here, s->num_nodes, &s->has));
  PetscCall(PetscCalloc1(v->num_nodes, &used));
  for (PetscInt k = 0; k < v->cell_row[v->num_cells]; ++k) used[v->cell_master[k]] = PETSC_TRUE;
  s->num_own = s->num_mine = 0;
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    s->owner[n] = (PetscMPIInt)t->leaf_rank[t->entity_leaf[s->node_entity[n]]];
    s->owned[n] = (PetscBool)(s->owner[n] == p->rank && s->hang[n] == s->hang[n + 1]); /* the unknowns of a hanging node are its masters' */
    s->here[n]  = (PetscBool)(s->hang[n] == s->hang[n + 1] && s->local[n] >= 0 && used[s->local[n]]);
    if (s->owned[n]) s->own[s->num_own++] = n;
    for (PetscInt c = 0; c < s->dim && !s->owned[n]; ++c) s->force[s->dim * n + c] = s->hang[n] < s->hang[n + 1] ? 0 : NAN;
  }
  for (PetscInt f = s->num_facets - 1; f >= 0; --f) { /* backwards: the first facet has the last word */
    const PetscInt *node, num = SurfaceNodes_Private(s, f, &node);
    for (PetscInt k = 0; k < num; ++k) {
      if (s->hang[node[k]] < s->hang[node[k] + 1]) s->owner[node[k]] = (PetscMPIInt)t->leaf_rank[s->facet_leaf[f]];
    }
  }
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    if (t->leaf_rank[s->facet_leaf[f]] == p->rank) s->mine[s->num_mine++] = f;
  }
  PetscCall(PetscFree(used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fields of the mesh that every rank has of all nodes: gathered to all from the owners, once per mesh. */
PetscErrorCode SurfaceFields_Private(Interface p, Surface *s)
{
  const PetscInt      dim = s->dim, room = dim + dim * dim + 1; /* of a node: position, frame, fixed bits */
  const HPTables     *v = HPSpaceGetTables(p->space);
  const ForestTables *t = p->tables;
  PetscInt           *number;
  PetscReal          *buffer;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(s->num_nodes, &s->local, s->num_nodes, &s->owned, dim * s->num_nodes, &s->dof));
  PetscCall(PetscCalloc4(dim * s->num_nodes, &s->X, dim * s->num_nodes, &s->x, 2 * dim * s->num_nodes, &s->mirror, dim * dim * s->num_nodes, &s->frame));
  PetscCall(PetscCalloc2(dim * s->num_nodes, &s->du, dim * s->num_nodes, &s->force));
  PetscCall(PetscMalloc1(t->first[dim], &number));
  for (PetscInt e = 0; e < t->first[dim]; ++e) number[e] = -1;
  for (PetscInt n = v->num_nodes - 1; n >= 0; --n) { /* the first of each entity stays */
    if (v->node_entity[n] < t->first[dim]) number[v->node_entity[n]] = n;
  }
  PetscCall(PetscCalloc1(room * s->num_nodes, &buffer));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    const PetscInt first = number[s->node_entity[n]];
    s->local[n]          = first >= 0 && s->node_index[n] >= 0 ? first + s->node_index[n] : -1;
    if (t->leaf_rank[t->entity_leaf[s->node_entity[n]]] != p->rank || s->node_index[n] < 0) continue;
    const PetscReal *frame;
    PetscReal       *b = buffer + room * n;
    PetscCall(HPSpaceGetFrame(p->space, s->local[n], &frame));
    for (PetscInt c = 0; c < dim; ++c) b[c] = v->X[3 * s->local[n] + c];
    for (PetscInt k = 0; k < dim; ++k)
      for (PetscInt c = 0; c < dim; ++c) b[dim + dim * k + c] = frame ? frame[3 * k + c] : (PetscReal)(k == c);
    b[room - 1] = p->fixed[s->local[n]];
  }
  PetscCall(PetscFree(number));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, buffer, (PetscMPIInt)(room * s->num_nodes), MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscCall(PetscArraycpy(s->X + dim * n, buffer + room * n, dim));
    PetscCall(PetscArraycpy(s->frame + dim * dim * n, buffer + room * n + dim, dim * dim));
    for (PetscInt c = 0; c < dim; ++c) s->dof[dim * n + c] = (PetscInt)buffer[room * n + room - 1]; /* the fixed bits, until the indices are known */
  }
  if (s->higher) SurfaceFollow_Private(s, dim, s->X); /* not all of them are nodes of the space */
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (dim == 2) NodeMirror_Private(s, n, s->dof[2 * n]);
    if (dim == 3) NodeMirrors_Private(s, n, s->dof[3 * n]);
  }
  PetscCall(PetscArraycpy(s->x, s->X, dim * s->num_nodes));
  PetscCall(PetscFree(buffer));
  PetscCall(Shares_Private(p, v, t, s));
  SurfaceForget_Private(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of the nodes' dofs in the matrix, gathered to all from their owners once per mesh (stored +2 so that a sum works and -1 survives); hanging nodes have
 * none.
 */
PetscErrorCode SurfaceIndices_Private(Interface p, const PetscInt row[], Surface *s)
{
  const PetscInt dim = s->dim;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    for (PetscInt c = 0; c < dim; ++c) s->dof[dim * n + c] = s->owned[n] ? row[s->local[n] * dim + c] + 2 : 0;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->dof, (PetscMPIInt)(dim * s->num_nodes), MPIU_INT, MPI_SUM, p->comm));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    for (PetscInt c = 0; c < dim; ++c) s->dof[dim * n + c] = s->hang[n + 1] > s->hang[n] ? -1 : s->dof[dim * n + c] - 2;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* values of hanging nodes from their masters, num of them per node; NaN where a master is not known. */
void SurfaceFollow_Private(const Surface *s, PetscInt num, PetscReal values[])
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (s->hang[n] == s->hang[n + 1]) continue;
    for (PetscInt c = 0; c < num; ++c) values[num * n + c] = 0;
    for (PetscInt k = s->hang[n]; k < s->hang[n + 1]; ++k)
      for (PetscInt c = 0; c < num; ++c) values[num * n + c] += s->hang_weight[k] * values[num * s->hang_master[k] + c];
  }
}

static void Place_Private(const Surface *s, const PetscReal local[], PetscReal values[])
{
  const PetscInt dim = s->dim;

  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    for (PetscInt c = 0; c < dim && s->here[n]; ++c) {
      values[dim * n + c] = 0;
      for (PetscInt k = 0; k < dim; ++k) values[dim * n + c] += s->frame[dim * (dim * n + k) + c] * local[dim * s->local[n] + k];
    }
  }
}

static void Finish_Private(const Surface *s, const PetscReal base[], PetscReal values[])
{
  SurfaceFollow_Private(s, s->dim, values);
  for (PetscInt n = 0; base && n < s->dim * s->num_nodes; ++n) values[n] += base[n];
}

void SurfacePlace_Private(const Surface *s, const PetscReal local[], const PetscReal base[], PetscReal values[])
{
  Place_Private(s, local, values);
  Finish_Private(s, base, values);
}

PetscErrorCode SurfaceGather_Private(Interface p, const Surface *s, const PetscReal local[], const PetscReal base[], PetscReal values[])
{
  PetscFunctionBegin;
  Place_Private(s, local, values);
  PetscCall(LinkSpread_Private(p, &s->places, s->dim, values));
  Finish_Private(s, base, values);
  PetscFunctionReturn(PETSC_SUCCESS);
}
