/* Refinement that the scene asks for before the first solve: near a place, along a boundary, or both. */
#include "forestimpl.h"

#define TOUCH 1e-9 /* of the cell's size: a ball this close to a cell touches it */

/* Distance of a point from the box around a leaf's corners; that box's diagonal. */
static PetscErrorCode BoxDistance_Private(Forest forest, PetscInt leaf, const PetscReal point[3], PetscReal *distance, PetscReal *diagonal)
{
  const PetscInt dim = forest->tables.dim;
  PetscReal      lo[3], hi[3], X[3], square = 0, size = 0;

  PetscFunctionBegin;
  for (PetscInt corner = 0; corner < 1 << dim; ++corner) {
    const PetscReal xi[3] = {(PetscReal)(corner & 1), (PetscReal)((corner >> 1) & 1), (PetscReal)((corner >> 2) & 1)};
    PetscCall(ForestMapPoint(forest, leaf, xi, X));
    for (PetscInt d = 0; d < dim; ++d) {
      lo[d] = corner ? PetscMin(lo[d], X[d]) : X[d];
      hi[d] = corner ? PetscMax(hi[d], X[d]) : X[d];
    }
  }
  for (PetscInt d = 0; d < dim; ++d) {
    square += PetscSqr(PetscMax(0, PetscMax(lo[d] - point[d], point[d] - hi[d])));
    size += PetscSqr(hi[d] - lo[d]);
  }
  *distance = PetscSqrtReal(square);
  *diagonal = PetscSqrtReal(size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ForestLeafTouches(const ForestTables *t, PetscInt leaf, uint64_t groups)
{
  const PetscInt *closure = t->closure + t->closure_offset[t->first[t->dim] + leaf];

  for (PetscInt i = 0, n = t->dim == 2 ? 9 : 27; i < n; ++i) {
    const PetscInt e = closure[i];
    if (e >= t->first[t->dim - 1] && e < t->first[t->dim] && (t->boundary[e] & groups)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode Once_Private(Forest forest, const RefineSpec *spec, Forest *refined)
{
  const ForestTables *t     = &forest->tables;
  MarkList            marks = {0};
  PetscBool           any   = PETSC_FALSE;
  ForestMap           map;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(t->num_leaves, &marks.split));
  for (PetscInt leaf = 0; leaf < t->num_leaves; ++leaf) {
    PetscReal distance = 0, diagonal = 0;
    if (spec->group >= 0 && !ForestLeafTouches(t, leaf, UINT64_C(1) << spec->group)) continue;
    if (spec->radius >= 0) PetscCall(BoxDistance_Private(forest, leaf, spec->X, &distance, &diagonal));
    if (spec->radius < 0 || distance <= spec->radius + TOUCH * diagonal) marks.split[leaf] = (int8_t)((1 << t->dim) - 1), any = PETSC_TRUE;
  }
  if (!any) PetscCall(PetscFree(marks.split));
  PetscCheckInput(any, "refine.%s: no cell is there (its boundary, and within its radius of x, y, z)", spec->name);
  PetscCall(ForestAdapt(forest, &marks, NULL, 0, NULL, refined, &map));
  PetscCall(ForestMapDestroy(&map));
  PetscCall(PetscFree(marks.split));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestRefine(Forest *forest, const RefineSpec *spec)
{
  PetscFunctionBegin;
  for (PetscInt level = 0; level < spec->levels; ++level) {
    Forest refined;
    PetscCall(Once_Private(*forest, spec, &refined));
    PetscCall(ForestDestroy(forest));
    *forest = refined;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
