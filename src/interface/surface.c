/* Surfaces of facets for contact: their topology, replicated. */
#include "interfaceimpl.h"

/* Ends of a leaf's side in the order that keeps the body on the left. */
static void EdgeVertices_Private(const PetscInt *cl, PetscInt index, PetscInt vertex[])
{
  const PetscInt  direction = index % 3 == 1 ? 1 : 0, high = (direction == 0 ? index % 3 : index / 3) == 2;
  const PetscInt  stride = direction == 0 ? 3 : 1, base = index - stride; /* the two ends lie one stride below and above */
  const PetscBool keep = (PetscBool)((direction == 0) == (high == 1));
  vertex[0]            = cl[keep ? base : index + stride];
  vertex[1]            = cl[keep ? index + stride : base];
}

/* Corners of a hexahedron's side, counterclockwise seen from outside. */
static void FaceVertices_Private(const PetscInt *cl, PetscInt index, PetscInt vertex[])
{
  const PetscInt stride[3] = {1, 3, 9}, place[3] = {index % 3, index / 3 % 3, index / 9};
  const PetscInt d = place[0] != 1 ? 0 : place[1] != 1 ? 1 : 2, a = stride[(d + 1) % 3], b = stride[(d + 2) % 3];
  const PetscInt around[4] = {index - a - b, index + a - b, index + a + b, index - a + b};
  for (PetscInt k = 0; k < 4; ++k) vertex[k] = cl[around[place[d] == 2 ? k : 3 - k]];
}

static void FacetVertices_Private(const ForestTables *t, PetscInt facet, PetscInt leaf, PetscInt vertex[])
{
  const PetscInt *cl    = t->closure + t->closure_offset[t->first[t->dim] + leaf];
  PetscInt        index = 0;
  while (cl[index] != facet) ++index;
  if (t->dim == 2)
    EdgeVertices_Private(cl, index, vertex);
  else
    FaceVertices_Private(cl, index, vertex);
}

PetscErrorCode SurfaceCorners_Private(Forest forest, PetscInt facet, PetscInt leaf, PetscReal X[])
{
  const ForestTables *t = ForestGetTables(forest);
  PetscInt            vertex[4];

  PetscFunctionBegin;
  const PetscInt *cl = t->closure + t->closure_offset[t->first[t->dim] + leaf];
  FacetVertices_Private(t, facet, leaf, vertex);
  for (PetscInt k = 0; k < (t->dim == 2 ? 2 : 4); ++k) {
    PetscReal x[3];
    PetscInt  index = 0;
    while (cl[index] != vertex[k]) index++;
    const PetscReal xi[3] = {0.5 * (PetscReal)(index % 3), 0.5 * (PetscReal)(index / 3 % 3), 0.5 * (PetscReal)(index / 9)};
    PetscCall(ForestMapPoint(forest, leaf, xi, x));
    PetscCall(PetscArraycpy(X + t->dim * k, x, t->dim));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A leaf's facet of the group that no other leaf has, none that hangs. */
static PetscBool IsOuter_Private(const ForestTables *t, PetscInt group, PetscInt f)
{
  const PetscInt *leaf = t->facet_leaf + 2 * (f - t->first[t->dim - 1]);
  return (PetscBool)((t->boundary[f] >> group & 1) && leaf[0] >= 0 && leaf[1] < 0 && t->parent[f] < 0);
}

static PetscErrorCode SurfaceTopology_Private(const ForestTables *t, const SurfaceFacets *of, Surface *s)
{
  const PetscInt first = t->first[t->dim - 1], last = t->first[t->dim];
  PetscInt      *number;

  PetscFunctionBegin;
  s->dim     = t->dim;
  s->corners = t->dim == 2 ? 2 : 4;
  PetscCall(PetscMalloc1(t->first[1], &number));
  for (PetscInt v = 0; v < t->first[1]; ++v) number[v] = -1;
  for (PetscInt f = first; f < last; ++f) s->num_facets += (t->boundary[f] >> of->group) & 1;
  PetscCall(PetscMalloc3(s->corners * s->num_facets, &s->facets, s->num_facets, &s->facet_leaf, s->num_facets, &s->facet_entity));
  PetscCall(PetscMalloc1(s->corners * s->num_facets, &s->node_entity));
  s->num_facets = 0;
  for (PetscInt f = first; f < last; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - first);
    PetscInt        vertex[4];
    if (!IsOuter_Private(t, of->group, f)) continue;
    FacetVertices_Private(t, f, leaf[0], vertex);
    for (PetscInt k = 0; k < s->corners; ++k) {
      if (number[vertex[k]] < 0) {
        number[vertex[k]]              = s->num_nodes;
        s->node_entity[s->num_nodes++] = vertex[k];
      }
      s->facets[s->corners * s->num_facets + k] = number[vertex[k]];
    }
    s->facet_entity[s->num_facets] = f;
    s->facet_leaf[s->num_facets++] = leaf[0];
  }
  PetscCall(PetscFree(number));
  PetscCall(PetscCalloc1(s->num_nodes, &s->node_index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Append the nodes of a facet, hanging ones replaced by their masters. */
static PetscErrorCode AddNodes_Private(const Surface *s, PetscInt facet, PetscInt *count, PetscInt *size, PetscInt **nodes)
{
  const PetscInt *own, total = SurfaceNodes_Private(s, facet, &own);
  PetscInt        room = *count;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < total; ++k) room += PetscMax(1, s->hang[own[k] + 1] - s->hang[own[k]]);
  PetscCall(ArrayGrow(room, sizeof(PetscInt), size, nodes));
  for (PetscInt k = 0; k < total; ++k) {
    const PetscReal *weight;
    const PetscInt  *master, num = SurfaceRow_Private(s, &own[k], &master, &weight);
    for (PetscInt i = 0; i < num; ++i) (*nodes)[(*count)++] = master[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes that carry each facet's shape or its multiplier functions, ascending. */
static PetscErrorCode SurfaceTrue_Private(Surface *s)
{
  const ContactSurface own   = SurfaceAt_Private(s, s->X);
  PetscInt            *nodes = NULL, *root, *next, num = 0, room = 0, size = 0; /* next: the facet after one in its group, round */

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s->num_facets, &root, s->num_facets, &next));
  PetscCall(ContactFacetGroups(&own, root));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    next[f] = root[f] == f ? f : next[root[f]];
    if (root[f] != f) next[root[f]] = f;
  }
  PetscCall(PetscCalloc1(s->num_facets + 1, &s->true_first));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    PetscInt count = 0;
    PetscCall(AddNodes_Private(s, f, &count, &size, &nodes));
    for (PetscInt g = next[f]; g != f; g = next[g]) PetscCall(AddNodes_Private(s, g, &count, &size, &nodes));
    PetscCall(PetscSortRemoveDupsInt(&count, nodes));
    PetscCall(ArrayGrow(num + count, sizeof(PetscInt), &room, &s->true_node));
    PetscCall(PetscArraycpy(s->true_node + num, nodes, count));
    s->true_first[f + 1] = num += count;
  }
  PetscCall(PetscFree(nodes));
  PetscCall(PetscFree2(root, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets at each node that does not hang. */
static PetscErrorCode SurfaceNeighbours_Private(Surface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1(s->num_nodes + 2, &s->node_first));
  PetscCall(PetscMalloc1(s->true_first[s->num_facets], &s->node_facet));
  for (PetscInt k = 0; k < s->true_first[s->num_facets]; ++k) s->node_first[s->true_node[k] + 2]++;
  for (PetscInt n = 0; n < s->num_nodes; ++n) s->node_first[n + 2] += s->node_first[n + 1];
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    for (PetscInt k = s->true_first[f]; k < s->true_first[f + 1]; ++k) s->node_facet[s->node_first[s->true_node[k] + 1]++] = f;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In the plane a surface is a line. */
static PetscErrorCode Line_Private(const Surface *s, const char *pair)
{
  PetscFunctionBegin;
  for (PetscInt n = 0; s->dim == 2 && n < s->num_nodes; ++n) {
    const PetscInt *at = s->node_facet + s->node_first[n], num = s->node_first[n + 1] - s->node_first[n];
    PetscCheckInput(
        num == 1 || (num == 2 && (s->facets[2 * at[0]] == n) != (s->facets[2 * at[1]] == n)),
        "contact.%s: a side branches at (%g, %g), or runs through it twice; where the mesh should not have it so look at its lines there, else give "
        "the parts of the side names of their own",
        pair, (double)s->X[2 * n], (double)s->X[2 * n + 1]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corners that facets of another face have as well. */
static PetscErrorCode Rim_Private(const ForestTables *t, const SurfaceFacets *of, Surface *s)
{
  PetscBool *other;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(t->first[1], &other));
  PetscCall(PetscCalloc1(s->num_nodes, &s->rim));
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim]; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - t->first[t->dim - 1]);
    PetscInt        vertex[4];
    if (!IsOuter_Private(t, of->group, f) || of->face[ForestCoarseSide(t, leaf[0], f)] == of->colour) continue;
    FacetVertices_Private(t, f, leaf[0], vertex);
    for (PetscInt k = 0; k < s->corners; ++k) other[vertex[k]] = PETSC_TRUE;
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) s->rim[n] = (PetscBool)(s->node_entity[n] < t->first[1] && other[s->node_entity[n]]);
  PetscCall(PetscFree(other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets of the colour. */
static PetscErrorCode Met_Private(const ForestTables *t, const SurfaceFacets *of, Surface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_facets, &s->met));
  for (PetscInt f = 0; f < s->num_facets; ++f) s->met[f] = (PetscBool)(of->face[ForestCoarseSide(t, s->facet_leaf[f], s->facet_entity[f])] == of->colour);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceCreate_Private(Interface p, const char *pair, const SurfaceFacets *of, Surface *s)
{
  const ForestTables *t = p->tables;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  PetscCall(SurfaceTopology_Private(t, of, s));
  PetscCall(SurfaceLattice_Private(p->space, t, s));
  PetscCall(SurfaceTrue_Private(s));
  PetscCall(SurfaceNeighbours_Private(s));
  PetscCall(SurfaceFields_Private(p, s));
  PetscCall(Line_Private(s, pair));
  if (of->face) PetscCall(Rim_Private(t, of, s));
  if (of->face) PetscCall(Met_Private(t, of, s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceDestroy_Private(Surface *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(s->facets, s->facet_leaf, s->facet_entity));
  PetscCall(FreeAll(6, (void *[]){&s->node_entity, &s->node_index, &s->order, &s->first, &s->lattice, &s->hang}));
  PetscCall(PetscFree2(s->hang_master, s->hang_weight));
  PetscCall(FreeAll(6, (void *[]){&s->true_first, &s->true_node, &s->node_first, &s->node_facet, &s->rim, &s->met}));
  PetscCall(PetscFree3(s->local, s->owned, s->dof));
  PetscCall(PetscFree4(s->X, s->x, s->mirror, s->frame));
  PetscCall(PetscFree2(s->du, s->force));
  PetscCall(PetscFree5(s->owner, s->own, s->mine, s->here, s->has));
  PetscCall(LinkDestroy_Private(&s->places));
  PetscCall(LinkDestroy_Private(&s->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SurfaceMeasure_Private(const Surface *s, const PetscReal x[], PetscInt facet)
{
  PetscReal N[3];

  ContactFacetVector(s->dim, x, s->facets + s->corners * facet, N);
  return PetscSqrtReal(Dot3(N, N));
}

/* What the contact module is told about the surface at positions x. Reference positions are known everywhere. */
ContactSurface SurfaceAt_Private(const Surface *s, const PetscReal x[])
{
  return (ContactSurface){s->dim,         s->num_nodes,   s->num_facets, s->facets, x,          s->mirror, s->hang,
                          s->hang_master, s->hang_weight, s->order,      s->first,  s->lattice, s->X,      x == s->X ? NULL : s->has,
                          s->rim};
}
