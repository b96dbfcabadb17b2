/* Contact multipliers: linear along the old nonmortar edges, evaluated at the new nodes. Places along a boundary are compared in root coordinates,
   where leaf corners are integers: no search by distance. */
#include "transferimpl.h"

/* Root coordinates of the corner of a leaf that is this vertex. */
static PetscErrorCode Corner_Private(const ForestTables *t, PetscInt leaf, PetscInt vertex, PetscInt at[2])
{
  const PetscInt *cl = t->closure + t->closure_offset[t->first[2] + leaf];
  PetscInt        i  = 0;

  PetscFunctionBegin;
  while (i < 9 && cl[i] != vertex) ++i;
  PetscCheck(i < 9, PETSC_COMM_SELF, PETSC_ERR_PLIB, "vertex %" PetscInt_FMT " is no corner of leaf %" PetscInt_FMT, vertex, leaf);
  for (PetscInt d = 0; d < 2; ++d, i /= 3) at[d] = t->leaf_lo[3 * leaf + d] + (i % 3 == 2) * (1 << (FOREST_MAX_LEVEL - t->leaf_level[3 * leaf + d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nonmortar edges of each leaf: edge[first[leaf] .. first[leaf+1]). */
static PetscErrorCode LeafEdges_Private(PetscInt num_leaves, const SurfaceView *s, PetscInt **first, PetscInt **edge)
{
  PetscInt *next;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num_leaves + 1, first));
  PetscCall(PetscMalloc1(s->num_facets, edge));
  PetscCall(PetscMalloc1(num_leaves + 1, &next));
  for (PetscInt e = 0; e < s->num_facets; ++e) (*first)[s->facet_leaf[e] + 1]++;
  for (PetscInt l = 0; l < num_leaves; ++l) (*first)[l + 1] += (*first)[l];
  PetscCall(PetscArraycpy(next, *first, num_leaves + 1));
  for (PetscInt e = 0; e < s->num_facets; ++e) (*edge)[next[s->facet_leaf[e]]++] = e;
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fraction of the point along the segment a-b in root coordinates, all integers; PETSC_FALSE: not on it. The segment runs along one axis. */
static PetscBool OnEdge_Private(const PetscInt a[2], const PetscInt b[2], const PetscInt at[2], PetscReal *fraction)
{
  const PetscInt along = a[0] == b[0] ? 1 : 0;

  if (at[1 - along] != a[1 - along]) return PETSC_FALSE;
  *fraction = (PetscReal)(at[along] - a[along]) / (PetscReal)(b[along] - a[along]);
  return (PetscBool)(*fraction >= 0 && *fraction <= 1);
}

/* Value on an old edge. A node whose multiplier was removed (it is held by a support) takes its neighbour's value. */
static PetscReal EdgeValue_Private(const PetscInt node[2], const PetscReal z[], const PetscBool has_multiplier[], PetscReal fraction)
{
  if (!has_multiplier[node[0]]) return has_multiplier[node[1]] ? z[node[1]] : 0;
  if (!has_multiplier[node[1]]) return z[node[0]];
  return (1 - fraction) * z[node[0]] + fraction * z[node[1]];
}

PetscErrorCode TransferMultiplier_Private(const ForestTables *old_t, const SurfaceView *old_view, const PetscReal z[], const PetscBool has_multiplier[],
                                          const ForestTables *new_t, const SurfaceView *new_view, const ForestMap *map, PetscReal new_z[])
{
  PetscInt *first, *edge;

  PetscFunctionBegin;
  PetscCall(LeafEdges_Private(old_t->num_leaves, old_view, &first, &edge));
  PetscCall(PetscArrayzero(new_z, new_view->num_nodes));
  for (PetscInt i = 0; i < 2 * new_view->num_facets; ++i) { /* ends of new edges: most nodes twice, with the same result */
    const PetscInt leaf = new_view->facet_leaf[i / 2], node = new_view->facets[i];
    PetscInt       at[2], a[2], b[2];
    PetscBool      found = PETSC_FALSE;
    PetscCall(Corner_Private(new_t, leaf, new_view->node_entity[node], at));
    for (PetscInt l = map->old_first[leaf]; l < map->old_first[leaf] + map->old_count[leaf] && !found; ++l) {
      for (PetscInt k = first[l]; k < first[l + 1] && !found; ++k) {
        const PetscInt *ends = old_view->facets + 2 * edge[k];
        PetscReal       fraction;
        PetscCall(Corner_Private(old_t, l, old_view->node_entity[ends[0]], a));
        PetscCall(Corner_Private(old_t, l, old_view->node_entity[ends[1]], b));
        found = OnEdge_Private(a, b, at, &fraction);
        if (found) new_z[node] = EdgeValue_Private(ends, z, has_multiplier, fraction);
      }
    }
    PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_PLIB, "nonmortar node %" PetscInt_FMT " lies on no old nonmortar edge", node);
  }
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(edge));
  PetscFunctionReturn(PETSC_SUCCESS);
}
