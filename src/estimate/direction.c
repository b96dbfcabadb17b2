/* Which axis of a cell its error comes from.

   The displacement is continuous: across a facet only its derivative along the axis that crosses the facet jumps, by about h^p times the (p+1)-th derivative
   along that axis. So the jump term of a facet belongs to the axis across it, on any mesh, skewed cells included. The interior term belongs to the axes in the
   ratio of what each adds to Div P over a length of the cell. Terms of boundaries, contact and volume say nothing of their own: they are taken to come from the
   axes as the others do.
   A cell without a neighbour along an axis has no jump there and, of order 1, no curvature either: its error along that axis is unknown. */
#include "estimateimpl.h"

void EstimateInterior_Private(EstimateSum *sum, PetscInt leaf, PetscInt num, const PetscReal weight[], const PetscReal S[], PetscReal eta2)
{
  PetscReal along[3] = {0, 0, 0}, total = 0;

  if (!sum->along) return;
  for (PetscInt q = 0; q < num; ++q) {
    for (PetscInt d = 0; d < sum->v->dim; ++d) along[d] += weight[q] * S[3 * q + d];
  }
  for (PetscInt d = 0; d < 3; ++d) total += along[d];
  for (PetscInt d = 0; d < 3 && total > 0; ++d) sum->along[leaf][d] += eta2 * along[d] / total;
}

/* Axes that cross no inner facet of the cell take the value of the largest: in doubt, cells are split. */
PetscErrorCode EstimateDoubts_Private(EstimateSum *sum)
{
  int8_t *crossed;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(sum->v->num_owned_cells, &crossed));
  for (PetscInt i = 0; i < sum->facets.num; ++i) {
    const FacetSide *side = sum->facets.facets[i].side;
    if (side[0].cell < 0 || side[1].cell < 0) continue;
    for (PetscInt s = 0; s < 2; ++s) {
      if (side[s].cell < sum->v->num_owned_cells) crossed[side[s].cell] |= (int8_t)(1 << side[s].side / 2);
    }
  }
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) {
    PetscReal *along = sum->along[sum->v->cell_leaf[c]], most = PetscMax(along[0], PetscMax(along[1], along[2]));
    for (PetscInt d = 0; d < sum->v->dim; ++d) {
      if (!((crossed[c] >> d) & 1)) along[d] = most;
    }
  }
  PetscCall(PetscFree(crossed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
