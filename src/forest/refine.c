/* Refinement that the scene asks for before the first solve: near a place, along a boundary, or both. */
#include "forestimpl.h"

#define TOUCH 1e-9 /* of the cell's size: a ball this close to a cell touches it */

/* Place xi of a cell whose sides are straight. */
static void Between_Private(PetscInt dim, PetscReal corners[8][3], const PetscReal xi[3], PetscReal X[3])
{
  for (PetscInt d = 0; d < 3; ++d) X[d] = 0;
  for (PetscInt k = 0; k < 1 << dim; ++k) {
    PetscReal weight = 1;
    for (PetscInt d = 0; d < dim; ++d) weight *= k >> d & 1 ? xi[d] : 1 - xi[d];
    for (PetscInt d = 0; d < dim; ++d) X[d] += weight * corners[k][d];
  }
}

/* Moves xi along direction d, in which such a cell is linear, to where it is nearest to the point. */
static void Approach_Private(PetscInt dim, PetscReal corners[8][3], const PetscReal point[3], PetscInt d, PetscReal xi[3])
{
  PetscReal from[3], to[3], along = 0, length2 = 0;

  xi[d] = 1;
  Between_Private(dim, corners, xi, to);
  xi[d] = 0;
  Between_Private(dim, corners, xi, from);
  for (PetscInt c = 0; c < dim; ++c) {
    along += (to[c] - from[c]) * (point[c] - from[c]);
    length2 += PetscSqr(to[c] - from[c]);
  }
  if (length2 > 0) xi[d] = PetscMin(1, PetscMax(0, along / length2));
}

/* Is a point within the radius of a leaf? One direction after the other, as long as that brings it nearer, with straight sides: the point is moved by what
   they are off at the place found before. */
static PetscErrorCode IsNear_Private(Forest forest, PetscInt leaf, const PetscReal point[3], PetscReal radius, PetscBool *near)
{
  const PetscInt dim = forest->tables.dim;
  PetscReal      X[8][3], xi[3] = {0.5, 0.5, 0.5}, at[3], straight[3], moved[3], square = PETSC_MAX_REAL, before, size2 = 0;

  PetscFunctionBegin;
  for (PetscInt corner = 0; corner < 1 << dim; ++corner) {
    const PetscReal end[3] = {(PetscReal)(corner & 1), (PetscReal)((corner >> 1) & 1), (PetscReal)((corner >> 2) & 1)};
    PetscReal       edge2  = 0;
    PetscCall(ForestMapPoint(forest, leaf, end, X[corner]));
    for (PetscInt d = 0; d < dim; ++d) edge2 += PetscSqr(X[corner][d] - X[0][d]);
    size2 = PetscMax(size2, edge2);
  }
  do {
    before = square;
    square = 0;
    PetscCall(ForestMapPoint(forest, leaf, xi, at));
    Between_Private(dim, X, xi, straight);
    for (PetscInt d = 0; d < dim; ++d) moved[d] = point[d] - (at[d] - straight[d]);
    for (PetscInt d = 0; d < dim; ++d) Approach_Private(dim, X, moved, d, xi);
    PetscCall(ForestMapPoint(forest, leaf, xi, at));
    for (PetscInt d = 0; d < dim; ++d) square += PetscSqr(at[d] - point[d]);
    *near = (PetscBool)(PetscSqrtReal(square) <= radius + TOUCH * PetscSqrtReal(size2));
  } while (!*near && square < (1 - TOUCH) * before);
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
    PetscBool near = PETSC_TRUE;
    if (spec->group >= 0 && !ForestLeafTouches(t, leaf, UINT64_C(1) << spec->group)) continue;
    if (spec->radius >= 0) PetscCall(IsNear_Private(forest, leaf, spec->X, spec->radius, &near));
    if (near) marks.split[leaf] = (int8_t)((1 << t->dim) - 1), any = PETSC_TRUE;
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
