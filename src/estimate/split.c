/* In which directions to split a leaf (none where it is as small as a leaf can be): those that carry a share of what the largest one does, and as many more as
 * keep the cell from growing too long. */
#include "estimateimpl.h"

/* Mean length of the leaf's edges in each direction, on the exact geometry. */
static PetscErrorCode Lengths_Private(Forest forest, PetscInt dim, PetscInt leaf, PetscReal length[3])
{
  PetscReal X[8][3];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 1 << dim; ++k) {
    const PetscReal xi[3] = {(PetscReal)(k & 1), (PetscReal)((k >> 1) & 1), (PetscReal)(k >> 2)};
    PetscCall(ForestMapPoint(forest, leaf, xi, X[k]));
  }
  for (PetscInt d = 0; d < dim; ++d) {
    length[d] = 0;
    for (PetscInt k = 0; k < 1 << dim; ++k) {
      PetscReal edge[3];
      if ((k >> d) & 1) continue;
      for (PetscInt c = 0; c < 3; ++c) edge[c] = X[k | (1 << d)][c] - X[k][c];
      length[d] += PetscSqrtReal(Dot3(edge, edge)) / (1 << (dim - 1));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Directions that carry at least `share` of the largest one's squared estimate; all when there is none. */
static int8_t Carriers_Private(PetscInt dim, const PetscReal along[3], PetscReal share)
{
  const PetscReal most  = PetscMax(along[0], PetscMax(along[1], along[2]));
  int8_t          split = 0;

  for (PetscInt d = 0; d < dim; ++d) split |= (int8_t)((along[d] >= share * most) << d);
  return split;
}

/* Add directions whose edges would be longer than `aspect` times the shortest one after the split. A cell that is that long before is not split the other
   way alone. */
static int8_t Rounder_Private(PetscInt dim, const PetscReal length[3], PetscReal aspect, int8_t split)
{
  PetscReal shortest = PETSC_MAX_REAL;

  for (PetscInt d = 0; d < dim; ++d) shortest = PetscMin(shortest, (split >> d) & 1 ? 0.5 * length[d] : length[d]);
  for (PetscInt d = 0; d < dim; ++d) split |= (int8_t)((length[d] > aspect * (1 + 1e-9) * shortest) << d);
  return split;
}

PetscErrorCode EstimateSplits_Private(const Estimate *e, const AdaptSpec *spec, Forest forest, int8_t split[])
{
  const ForestTables *t = ForestGetTables(forest);

  PetscFunctionBegin;
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    PetscReal length[3];
    split[l] = (int8_t)((1 << t->dim) - 1);
    if (spec->anisotropic && e->along) {
      PetscCall(Lengths_Private(forest, t->dim, l, length));
      split[l] = Rounder_Private(t->dim, length, spec->aspect, Carriers_Private(t->dim, e->along[l], spec->share));
    }
    for (PetscInt d = 0; d < t->dim; ++d) {
      if (t->leaf_level[3 * l + d] >= FOREST_MAX_LEVEL) split[l] = 0;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
