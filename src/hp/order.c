/* Orders of edges and faces by the minimum rule, direction by direction. */
#include "hpimpl.h"

static PetscBool Lower_Private(int8_t *order, int8_t to)
{
  if (*order <= to) return PETSC_FALSE;
  *order = to;
  return PETSC_TRUE;
}

/* One sweep of: a part of an entity's closure has, along each of its axes, at most the entity's order in that direction. Edges of faces matter as well as
   faces of cells: a face lowered by a hanging neighbour must lower its edges, or its tensor basis could not follow them. */
static PetscBool SweepClosures_Private(const ForestTables *t, int8_t (*order)[3])
{
  PetscBool changed = PETSC_FALSE;
  /* first[3] ends the two-dimensional entities: faces in 3-D, cells in 2-D (first[dim+1] = num_entities). */
  for (PetscInt e = t->first[2]; e < t->num_entities; ++e) {
    const PetscInt  n    = e < t->first[3] ? 9 : 27;
    const PetscInt *cl   = t->closure + t->closure_offset[e];
    const int8_t   *code = t->orientation + t->closure_offset[e];
    for (PetscInt i = 0; i < n; ++i) {
      PetscInt along[3], d = 0;
      if (cl[i] < t->first[1]) continue;
      for (PetscInt a = 0, j = i; a < 3; ++a, j /= 3)
        if (j % 3 == 1) along[d++] = a;
      for (PetscInt k = 0; k < d; ++k) {
        const PetscInt axis = d == 2 && (code[i] & 4) ? 1 - k : k; /* of the part's frame, as in ForestOrient */
        if (Lower_Private(&order[cl[i]][axis], order[e][along[k]])) changed = PETSC_TRUE;
      }
    }
  }
  return changed;
}

/* One sweep of: a hanging entity and the one it hangs on share their orders along common axes, the lower of the two. */
static PetscBool SweepParents_Private(const ForestTables *t, int8_t (*order)[3])
{
  PetscBool changed = PETSC_FALSE;
  for (PetscInt e = t->first[1]; e < t->first[t->dim]; ++e) {
    const PetscInt parent = t->parent[e], d = parent < 0 ? 0 : HPEntityDim_Private(t, parent);
    for (PetscInt a = 0, k = 0; a < d; ++a) {
      if (t->parent_place[3 * e + a] == 3) continue;
      if (Lower_Private(&order[parent][a], order[e][k])) changed = PETSC_TRUE;
      if (Lower_Private(&order[e][k], order[parent][a])) changed = PETSC_TRUE;
      ++k;
    }
  }
  return changed;
}

/* One sweep of: faces have one order, the lower of their two. An edge may be lowered by cells that meet the face it hangs in nowhere else. */
static PetscBool SweepIsotropic_Private(const ForestTables *t, int8_t (*order)[3])
{
  PetscBool changed = PETSC_FALSE;
  for (PetscInt e = t->first[2]; e < t->first[t->dim]; ++e) {
    if (Lower_Private(&order[e][0], order[e][1])) changed = PETSC_TRUE;
    if (Lower_Private(&order[e][1], order[e][0])) changed = PETSC_TRUE;
  }
  return changed;
}

PetscErrorCode HPSpaceOrders_Private(HPSpace hp, const int8_t leaf_order[], const int8_t leaf_cap[][3], uint64_t linear_groups)
{
  const ForestTables *t = hp->tables;
  int8_t(*order)[3];

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(t->num_entities, &hp->entity_order, t->num_entities, &hp->axis_order));
  order = hp->axis_order;
  for (PetscInt e = 0; e < t->first[t->dim]; ++e)
    for (PetscInt a = 0; a < 3; ++a) order[e][a] = e >= t->first[1] && t->boundary[e] & linear_groups ? 1 : MORTISE_MAX_ORDER;
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    PetscCheckInput(leaf_order[l] >= 1 && leaf_order[l] <= MORTISE_MAX_ORDER, "order: %d is out of range, allowed are 1 to %d", (int)leaf_order[l],
                    MORTISE_MAX_ORDER);
    for (PetscInt a = 0; a < 3; ++a) order[t->first[t->dim] + l][a] = leaf_cap ? PetscMin(leaf_order[l], leaf_cap[l][a]) : leaf_order[l];
  }
  for (PetscBool changed = PETSC_TRUE; changed;) {
    changed = SweepClosures_Private(t, order);
    if (SweepParents_Private(t, order)) changed = PETSC_TRUE;
    if (!leaf_cap && SweepIsotropic_Private(t, order)) changed = PETSC_TRUE;
  }
  for (PetscInt e = 0; e < t->first[t->dim]; ++e) {
    hp->entity_order[e] = 0;
    for (PetscInt a = 0; a < PetscMax(1, HPEntityDim_Private(t, e)); ++a) hp->entity_order[e] = PetscMax(hp->entity_order[e], order[e][a]);
  }
  PetscCall(PetscArraycpy(hp->entity_order + t->first[t->dim], leaf_order, t->num_leaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Highest order of the leaves of each facet; of a hanging one: of the facet it hangs on, too. */
static void FacetOrders_Private(const ForestTables *t, const int8_t leaf_order[], int8_t *facet_order)
{
  const PetscInt first = t->first[t->dim - 1], num = t->first[t->dim] - first;

  for (PetscInt f = 0; f < num; ++f) {
    facet_order[f] = 0;
    for (PetscInt s = 0; s < 2; ++s) {
      const PetscInt leaf = t->facet_leaf[2 * f + s];
      if (leaf >= 0) facet_order[f] = PetscMax(facet_order[f], leaf_order[leaf]);
    }
  }
  for (PetscBool changed = PETSC_TRUE; changed;) {
    changed = PETSC_FALSE;
    for (PetscInt f = 0; f < num; ++f) {
      const PetscInt parent = t->parent[first + f];
      if (parent < 0 || facet_order[f] == facet_order[parent - first]) continue;
      facet_order[f] = facet_order[parent - first] = PetscMax(facet_order[f], facet_order[parent - first]);
      changed                                      = PETSC_TRUE;
    }
  }
}

PetscErrorCode HPOrdersLimit(Forest forest, PetscInt difference, const int8_t fixed[], int8_t order[])
{
  const ForestTables *t = ForestGetTables(forest);
  int8_t             *facet_order;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->first[t->dim] - t->first[t->dim - 1], &facet_order));
  for (PetscBool changed = PETSC_TRUE; changed;) {
    changed = PETSC_FALSE;
    FacetOrders_Private(t, order, facet_order);
    for (PetscInt f = 0; f < t->first[t->dim] - t->first[t->dim - 1]; ++f) {
      for (PetscInt s = 0; s < 2; ++s) {
        const PetscInt leaf = t->facet_leaf[2 * f + s];
        if (leaf < 0 || fixed[leaf] || order[leaf] + difference >= facet_order[f]) continue;
        order[leaf] = (int8_t)(facet_order[f] - difference);
        changed     = PETSC_TRUE;
      }
    }
  }
  PetscCall(PetscFree(facet_order));
  PetscFunctionReturn(PETSC_SUCCESS);
}
