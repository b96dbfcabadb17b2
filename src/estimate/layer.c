/* Linear contact faces before cells of higher order: how far their layer is to be subdivided (contact.<pair>.subdivide: auto).

   Subdividing the layer takes the error that the faces make down by 4 in the force and leaves that of the cells inside as it is, so it pays as long as the
   layer's share is the larger one. Where it still is after p + 1 times, something else makes it (a sharp edge in the contact zone), which is not for a whole
   layer to cure. */
#include "estimateimpl.h"

/* Squared estimates of the leaves with a facet of these groups and an order above 1, and of those with no facet of any pair; the layer's highest order. */
static void Shares_Private(const Estimate *e, const ForestTables *t, uint64_t pair, uint64_t all, const int8_t order[], PetscReal *layer, PetscReal *inside,
                           PetscInt *highest)
{
  *layer = *inside = 0;
  *highest         = 1;
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    if (!ForestLeafTouches(t, l, all)) {
      *inside += e->eta2[l];
    } else if (order[l] > 1 && ForestLeafTouches(t, l, pair)) {
      *layer += e->eta2[l];
      *highest = PetscMax(*highest, order[l]);
    }
  }
}

static uint64_t Groups_Private(const ContactSpec *c)
{
  return UINT64_C(1) << c->nonmortar | UINT64_C(1) << c->mortar;
}

/* Mark all cells at a pair. */
static void Split_Private(const ForestTables *t, uint64_t groups, int8_t split[])
{
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    if (ForestLeafTouches(t, l, groups)) split[l] = (int8_t)((1 << t->dim) - 1);
  }
}

PetscErrorCode EstimateMarkLayers(const Estimate *e, const SceneData *data, Forest forest, const int8_t order[], PetscInt subdivided[], MarkList *marks,
                                  PetscInt *num_marked, PetscBool *room)
{
  const ForestTables *t   = ForestGetTables(forest);
  uint64_t            all = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(t->num_leaves, &marks->split));
  PetscCall(PetscCalloc1(t->num_leaves, &marks->coarsen));
  *num_marked = 0;
  *room       = PETSC_TRUE;
  for (PetscInt i = 0; i < data->num_contacts; ++i) all |= Groups_Private(&data->contacts[i]);
  for (PetscInt i = 0; i < data->num_contacts; ++i) {
    const uint64_t groups = Groups_Private(&data->contacts[i]);
    PetscReal      layer, inside;
    PetscInt       highest, more = 0;
    if (!data->contacts[i].subdivide_auto) continue;
    Shares_Private(e, t, groups, all, order, &layer, &inside, &highest);
    if (layer <= inside || subdivided[i] > highest) continue;
    for (PetscInt l = 0; l < t->num_leaves; ++l) more += !marks->split[l] && ForestLeafTouches(t, l, groups);
    if (t->num_leaves + (*num_marked + more) * ((1 << t->dim) - 1) > data->adapt.max_cells) {
      *room = PETSC_FALSE;
      continue;
    }
    Split_Private(t, groups, marks->split);
    *num_marked += more;
    ++subdivided[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
