/* Contact multipliers: interpolated by the functions of the old nonmortar facets, evaluated at the new nodes. Places along a boundary are compared in root
   coordinates, where facets are rectangles along the axes and leaf corners are integers: no search by distance. */
#include "transferimpl.h"

#define SLACK 1e-9 /* of a facet, which a place may lie beside it: nodes of lattices are no integers */

/* Root coordinates of the corner of a leaf that is this vertex. */
static PetscErrorCode Corner_Private(const ForestTables *t, PetscInt leaf, PetscInt vertex, PetscReal at[3])
{
  const PetscInt *cl = t->closure + t->closure_offset[t->first[t->dim] + leaf], size = t->dim == 2 ? 9 : 27;
  PetscInt        i = 0;

  PetscFunctionBegin;
  while (i < size && cl[i] != vertex) ++i;
  PetscCheck(i < size, PETSC_COMM_SELF, PETSC_ERR_PLIB, "vertex %" PetscInt_FMT " is no corner of leaf %" PetscInt_FMT, vertex, leaf);
  for (PetscInt d = 0; d < t->dim; ++d, i /= 3)
    at[d] = (PetscReal)(t->leaf_lo[3 * leaf + d] + (i % 3 == 2) * (1 << (FOREST_MAX_LEVEL - t->leaf_level[3 * leaf + d])));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nonmortar facets of each leaf: facet[first[leaf] .. first[leaf+1]). */
static PetscErrorCode LeafFacets_Private(PetscInt num_leaves, const SurfaceView *s, PetscInt **first, PetscInt **facet)
{
  PetscInt *next;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num_leaves + 1, first));
  PetscCall(PetscMalloc1(s->num_facets, facet));
  PetscCall(PetscMalloc1(num_leaves + 1, &next));
  for (PetscInt e = 0; e < s->num_facets; ++e) (*first)[s->facet_leaf[e] + 1]++;
  for (PetscInt l = 0; l < num_leaves; ++l) (*first)[l + 1] += (*first)[l];
  PetscCall(PetscArraycpy(next, *first, num_leaves + 1));
  for (PetscInt e = 0; e < s->num_facets; ++e) (*facet)[next[s->facet_leaf[e]]++] = e;
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corners 0, 1 and (in space) 3 of a facet in root coordinates: where its directions begin and end. */
static PetscErrorCode Frame_Private(const ForestTables *t, const SurfaceView *s, PetscInt facet, PetscReal at[3][3])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->dim; ++k) {
    const PetscInt corner = k == 2 ? 3 : k;
    PetscCall(Corner_Private(t, s->facet_leaf[facet], s->node_entity[s->facets[s->corners * facet + corner]], at[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coordinates in [-1, 1] of a place on a facet of this frame; PETSC_FALSE: it is not on it. */
static PetscBool Locate_Private(PetscInt dim, const PetscReal frame[3][3], const PetscReal at[3], PetscReal xi[2])
{
  for (PetscInt d = 0; d < dim; ++d) {
    PetscInt along = -1;
    for (PetscInt k = 1; k < dim; ++k) {
      if (frame[k][d] != frame[0][d]) along = k - 1;
    }
    if (along < 0 && at[d] != frame[0][d]) return PETSC_FALSE;
    if (along < 0) continue;
    xi[along] = 2 * ((at[d] - frame[0][d]) / (frame[along + 1][d] - frame[0][d])) - 1;
    if (PetscAbsReal(xi[along]) > 1 + SLACK) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Value at an old node; a hanging one has the mean of its masters, as far as they have one. PETSC_FALSE: the multiplier was removed (a support holds the node).
 */
static PetscBool NodeValue_Private(const SurfaceView *s, const PetscReal z[], const PetscBool has_multiplier[], PetscInt node, PetscReal *value)
{
  PetscReal sum = 0, weight = 0;

  *value = z[node];
  if (s->hang[node] == s->hang[node + 1]) return has_multiplier[node];
  for (PetscInt k = s->hang[node]; k < s->hang[node + 1]; ++k) {
    if (!has_multiplier[s->hang_master[k]]) continue;
    sum += s->hang_weight[k] * z[s->hang_master[k]];
    weight += s->hang_weight[k];
  }
  if (weight > 0) *value = sum / weight;
  return (PetscBool)(weight > 0);
}

/* Steps along the sides of a facet, or the pieces of its lattice, between two of its nodes. */
static PetscInt Steps_Private(const SurfaceView *s, PetscInt facet, PetscInt a, PetscInt b)
{
  const PetscInt q = s->order[facet];

  return PetscAbsInt(a % (q + 1) - b % (q + 1)) + PetscAbsInt(a / (q + 1) - b / (q + 1));
}

/* Values at the nodes of an old facet. A node without one takes the mean of those nearest to it, by steps, that have one. */
static void FacetValues_Private(const SurfaceView *s, const PetscReal z[], const PetscBool has_multiplier[], PetscInt facet, PetscReal value[])
{
  const PetscInt *node, num = SurfaceFacetNodes(s, facet, &node);
  PetscBool       has[SURFACE_MOST_NODES];
  PetscReal       own[SURFACE_MOST_NODES];

  for (PetscInt k = 0; k < num; ++k) has[k] = NodeValue_Private(s, z, has_multiplier, node[k], &own[k]);
  for (PetscInt k = 0; k < num; ++k) {
    PetscReal sum     = 0;
    PetscInt  nearest = PETSC_MAX_INT, count = 0;
    for (PetscInt i = 0; i < num; ++i) {
      const PetscInt steps = Steps_Private(s, facet, k, i);
      if (!has[i] || steps > nearest) continue;
      if (steps < nearest) sum = 0, count = 0;
      nearest = steps;
      sum += own[i];
      ++count;
    }
    value[k] = count ? sum / (PetscReal)count : 0;
  }
}

/* Value of the old multiplier at a place of an old leaf's facet; *found PETSC_FALSE: it lies elsewhere. */
static PetscErrorCode FacetValue_Private(const ForestTables *t, const SurfaceView *s, const PetscReal z[], const PetscBool has_multiplier[], PetscInt facet,
                                         const PetscReal at[3], PetscReal *value, PetscBool *found)
{
  const PetscInt *node, num = SurfaceFacetNodes(s, facet, &node);
  PetscReal       frame[3][3], xi[2], N[SURFACE_MOST_NODES], own[SURFACE_MOST_NODES];

  PetscFunctionBegin;
  PetscCall(Frame_Private(t, s, facet, frame));
  *found = Locate_Private(t->dim, frame, at, xi);
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  SurfaceShape(s->dim, s->order[facet], xi, N, NULL);
  FacetValues_Private(s, z, has_multiplier, facet, own);
  *value = 0;
  for (PetscInt k = 0; k < num; ++k) *value += N[k] * own[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Root coordinates of node k of a facet. */
static PetscErrorCode NodePlace_Private(const ForestTables *t, const SurfaceView *s, PetscInt facet, PetscInt k, PetscReal at[3])
{
  const PetscInt   q = s->order[facet];
  const PetscReal *nodes;
  PetscReal        frame[3][3];

  PetscFunctionBegin;
  PetscCall(Frame_Private(t, s, facet, frame));
  PetscCall(ElementGetNodes(q, &nodes));
  for (PetscInt d = 0; d < t->dim; ++d) {
    at[d] = frame[0][d] + nodes[k % (q + 1)] * (frame[1][d] - frame[0][d]);
    if (t->dim == 3) at[d] += nodes[k / (q + 1)] * (frame[2][d] - frame[0][d]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mark the nodes of a facet, and those they hang on. */
static void MarkNodes_Private(const SurfaceView *s, PetscInt facet, PetscBool wanted[])
{
  const PetscInt *node, num = SurfaceFacetNodes(s, facet, &node);

  for (PetscInt k = 0; k < num; ++k) {
    wanted[node[k]] = PETSC_TRUE;
    for (PetscInt m = s->hang[node[k]]; m < s->hang[node[k] + 1]; ++m) wanted[s->hang_master[m]] = PETSC_TRUE;
  }
}

PetscErrorCode TransferMultiplierNeeds_Private(const ForestTables *old_t, const SurfaceView *old_view, const SurfaceView *new_view, const ForestMap *map,
                                               PetscBool wanted[])
{
  PetscInt *first, *facet;

  PetscFunctionBegin;
  PetscCall(LeafFacets_Private(old_t->num_leaves, old_view, &first, &facet));
  PetscCall(PetscArrayzero(wanted, old_view->num_nodes));
  for (PetscInt f = 0; f < new_view->num_facets; ++f) {
    const PetscInt leaf = new_view->facet_leaf[f], end = map->old_first[leaf] + map->old_count[leaf], *node, num = SurfaceFacetNodes(new_view, f, &node);
    PetscBool      mine = PETSC_FALSE;
    for (PetscInt i = 0; i < num; ++i) mine = (PetscBool)(mine || new_view->owned[node[i]]);
    for (PetscInt k = first[map->old_first[leaf]]; k < first[end] && mine; ++k) MarkNodes_Private(old_view, facet[k], wanted);
  }
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(facet));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferMultiplier_Private(const ForestTables *old_t, const SurfaceView *old_view, const PetscReal z[], const PetscBool has_multiplier[],
                                          const ForestTables *new_t, const SurfaceView *new_view, const ForestMap *map, PetscReal new_z[])
{
  PetscInt *first, *facet;

  PetscFunctionBegin;
  PetscCall(LeafFacets_Private(old_t->num_leaves, old_view, &first, &facet));
  PetscCall(PetscArrayzero(new_z, new_view->num_nodes));
  for (PetscInt f = 0; f < new_view->num_facets; ++f) {
    const PetscInt leaf = new_view->facet_leaf[f], end = map->old_first[leaf] + map->old_count[leaf], *node, num = SurfaceFacetNodes(new_view, f, &node);
    for (PetscInt i = 0; i < num; ++i) { /* a node of several facets comes up several times, mostly with the same result */
      PetscReal at[3];
      PetscBool found = PETSC_FALSE;
      if (!new_view->owned[node[i]]) continue;
      PetscCall(NodePlace_Private(new_t, new_view, f, i, at));
      for (PetscInt k = first[map->old_first[leaf]]; k < first[end] && !found; ++k)
        PetscCall(FacetValue_Private(old_t, old_view, z, has_multiplier, facet[k], at, &new_z[node[i]], &found));
      PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_PLIB, "nonmortar node %" PetscInt_FMT " lies on no old nonmortar facet", node[i]);
    }
  }
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(facet));
  PetscFunctionReturn(PETSC_SUCCESS);
}
