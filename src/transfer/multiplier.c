/* Contact multipliers: interpolated by the hats of the old nonmortar facets, evaluated at the new nodes. Places along a boundary are compared in root
   coordinates, where leaf corners are integers and facets are rectangles along the axes: no search by distance. */
#include "transferimpl.h"

/* Root coordinates of the corner of a leaf that is this vertex. */
static PetscErrorCode Corner_Private(const ForestTables *t, PetscInt leaf, PetscInt vertex, PetscInt at[3])
{
  const PetscInt *cl = t->closure + t->closure_offset[t->first[t->dim] + leaf], size = t->dim == 2 ? 9 : 27;
  PetscInt        i = 0;

  PetscFunctionBegin;
  while (i < size && cl[i] != vertex) ++i;
  PetscCheck(i < size, PETSC_COMM_SELF, PETSC_ERR_PLIB, "vertex %" PetscInt_FMT " is no corner of leaf %" PetscInt_FMT, vertex, leaf);
  for (PetscInt d = 0; d < t->dim; ++d, i /= 3) at[d] = t->leaf_lo[3 * leaf + d] + (i % 3 == 2) * (1 << (FOREST_MAX_LEVEL - t->leaf_level[3 * leaf + d]));
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

/* Hats at a place of the old facet's corners, all in root coordinates; PETSC_FALSE: the place is not on it. */
static PetscBool Hats_Private(PetscInt dim, PetscInt corners, const PetscInt corner[][3], const PetscInt at[3], PetscReal N[])
{
  for (PetscInt k = 0; k < corners; ++k) N[k] = 1;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscInt low = corner[0][d], high = corner[0][d];
    for (PetscInt k = 1; k < corners; ++k) {
      low  = PetscMin(low, corner[k][d]);
      high = PetscMax(high, corner[k][d]);
    }
    if (at[d] < low || at[d] > high) return PETSC_FALSE;
    for (PetscInt k = 0; k < corners && high > low; ++k) N[k] *= (PetscReal)(corner[k][d] == low ? high - at[d] : at[d] - low) / (PetscReal)(high - low);
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

/* Values at the corners of an old facet. A corner without one takes the mean of its neighbours along the facet's sides, else that of the opposite corner. */
static void CornerValues_Private(const SurfaceView *s, const PetscReal z[], const PetscBool has_multiplier[], PetscInt facet, PetscReal value[])
{
  const PetscInt n = s->corners;
  PetscBool      has[4];
  PetscReal      own[4];

  for (PetscInt k = 0; k < n; ++k) has[k] = NodeValue_Private(s, z, has_multiplier, s->facets[n * facet + k], &own[k]);
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt next = (k + 1) % n, last = (k + n - 1) % n, across = (k + n / 2) % n;
    value[k] = 0;
    if (has[k])
      value[k] = own[k];
    else if (has[next] || has[last])
      value[k] = ((has[next] ? own[next] : 0) + (has[last] ? own[last] : 0)) / (PetscReal)(has[next] + has[last]);
    else if (has[across])
      value[k] = own[across];
  }
}

/* Value of the old multiplier at a place of an old leaf's facet; *found PETSC_FALSE: it lies elsewhere. */
static PetscErrorCode FacetValue_Private(const ForestTables *t, const SurfaceView *s, const PetscReal z[], const PetscBool has_multiplier[], PetscInt facet,
                                         const PetscInt at[3], PetscReal *value, PetscBool *found)
{
  PetscInt  corner[4][3];
  PetscReal N[4], own[4];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->corners; ++k) PetscCall(Corner_Private(t, s->facet_leaf[facet], s->node_entity[s->facets[s->corners * facet + k]], corner[k]));
  *found = Hats_Private(t->dim, s->corners, corner, at, N);
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  CornerValues_Private(s, z, has_multiplier, facet, own);
  *value = 0;
  for (PetscInt k = 0; k < s->corners; ++k) *value += N[k] * own[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TransferMultiplierNeeds_Private(const ForestTables *old_t, const SurfaceView *old_view, const SurfaceView *new_view, const ForestMap *map,
                                               PetscBool wanted[])
{
  const PetscInt corners = old_view->corners;
  PetscInt      *first, *facet;

  PetscFunctionBegin;
  PetscCall(LeafFacets_Private(old_t->num_leaves, old_view, &first, &facet));
  PetscCall(PetscArrayzero(wanted, old_view->num_nodes));
  for (PetscInt i = 0; i < new_view->corners * new_view->num_facets; ++i) {
    const PetscInt leaf = new_view->facet_leaf[i / new_view->corners], end = map->old_first[leaf] + map->old_count[leaf];
    if (!new_view->owned[new_view->facets[i]]) continue;
    for (PetscInt k = corners * first[map->old_first[leaf]]; k < corners * first[end]; ++k) {
      const PetscInt node = old_view->facets[corners * facet[k / corners] + k % corners];
      wanted[node]        = PETSC_TRUE;
      for (PetscInt m = old_view->hang[node]; m < old_view->hang[node + 1]; ++m) wanted[old_view->hang_master[m]] = PETSC_TRUE;
    }
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
  for (PetscInt i = 0; i < new_view->corners * new_view->num_facets;
       ++i) { /* corners of new facets: a node comes up several times, mostly with the same result */
    const PetscInt leaf = new_view->facet_leaf[i / new_view->corners], node = new_view->facets[i], end = map->old_first[leaf] + map->old_count[leaf];
    PetscInt       at[3];
    PetscBool      found = PETSC_FALSE;
    if (!new_view->owned[node]) continue;
    PetscCall(Corner_Private(new_t, leaf, new_view->node_entity[node], at));
    for (PetscInt k = first[map->old_first[leaf]]; k < first[end] && !found; ++k)
      PetscCall(FacetValue_Private(old_t, old_view, z, has_multiplier, facet[k], at, &new_z[node], &found));
    PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_PLIB, "nonmortar node %" PetscInt_FMT " lies on no old nonmortar facet", node);
  }
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(facet));
  PetscFunctionReturn(PETSC_SUCCESS);
}
