/* Normals, tangents and lengths of facets at their vertices (plane) or edges (space): what faces and corners of a contact side are found from (faces.c,
   corner.c). Of the coarse mesh and its curved sides, as it is refined. */
#include "rim.h"

/* Normal, tangent and length of the side of a leaf at an entity of its closure. */
static void Axes_Private(const CoarseMesh *mesh, const ForestTables *t, PetscInt leaf, PetscInt place, PetscInt entity, Rim *r)
{
  const PetscInt  dim = t->dim, d = place / 2, a = (d + 1) % dim, b = dim == 3 ? (d + 2) % 3 : 2;
  const PetscInt *cl    = t->closure + t->closure_offset[t->first[dim] + leaf];
  PetscInt        index = 0;
  PetscReal       xi[3] = {0, 0, 0}, X[3], J[9], N[3], e[2][3] = {{0, 0, 0}, {0, 0, 1}}, outward = 0;

  while (cl[index] != entity) ++index;
  const PetscInt at[3] = {index % 3, index / 3 % 3, index / 9};
  for (PetscInt i = 0; i < dim; ++i)
    xi[i] = ((PetscReal)t->leaf_lo[3 * leaf + i] + 0.5 * (PetscReal)at[i] * (PetscReal)(1 << (FOREST_MAX_LEVEL - t->leaf_level[3 * leaf + i]))) /
            (PetscReal)(1 << FOREST_MAX_LEVEL);
  ForestCoarseMapPoint(mesh, t->leaf_root[leaf], xi, X, J);
  for (PetscInt c = 0; c < 3; ++c) {
    e[0][c] = J[c * dim + a];
    if (dim == 3) e[1][c] = J[c * dim + b];
  }
  Cross3(e[0], e[1], N);
  for (PetscInt c = 0; c < 3; ++c) outward += N[c] * J[c * dim + d] * (place % 2 ? 1 : -1);
  const PetscReal measure = PetscSqrtReal(Dot3(N, N)) * (outward < 0 ? -1 : 1);
  for (PetscInt c = 0; c < 3; ++c) {
    r->N[c] = N[c] / measure;
    r->T[c] = (PetscReal)(1 - at[a]) * e[0][c] + (dim == 3 ? (PetscReal)(1 - at[b]) * e[1][c] : 0);
  }
  r->length = PetscSqrtReal(Dot3(e[0], e[0])) / (PetscReal)(1 << t->leaf_level[3 * leaf + a]);
  r->across = r->length;
  if (dim == 2) return;
  const PetscReal other = PetscSqrtReal(Dot3(e[1], e[1])) / (PetscReal)(1 << t->leaf_level[3 * leaf + b]);
  if (at[a] == 1) r->across = other;
  r->length = PetscMin(r->length, other);
}

static int Compare_Private(const void *a, const void *b)
{
  const Rim *x = a, *y = b;

  if (x->entity != y->entity) return x->entity < y->entity ? -1 : 1;
  return x->side < y->side ? -1 : x->side > y->side;
}

PetscErrorCode SceneRims(Forest forest, PetscInt group, PetscInt *num, Rim **rim)
{
  const CoarseMesh   *mesh = ForestGetCoarse(forest);
  const ForestTables *t    = ForestGetTables(forest);
  PetscInt            room = 0, number = 0;

  PetscFunctionBegin;
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim]; ++f) room += t->boundary[f] >> group & 1 ? 2 * 4 : 0;
  PetscCall(PetscMalloc1(room, rim));
  *num = 0;
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim]; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - t->first[t->dim - 1]), *cl = t->closure + t->closure_offset[f];
    if (!(t->boundary[f] >> group & 1) || (leaf[0] >= 0 && leaf[1] >= 0)) continue;
    const PetscInt cell = leaf[0] >= 0 ? leaf[0] : leaf[1], side = ForestCoarseSide(t, cell, f);
    for (PetscInt k = 0; k < (t->dim == 2 ? 3 : 9); ++k) {
      if (cl[k] == f) continue;
      Rim *r       = *rim + (*num)++;
      r->entity    = cl[k];
      r->side      = side;
      r->facet     = number;
      r->place     = k;
      r->is_vertex = (PetscBool)(t->dim == 3 && k % 2 == 0);
      r->groups    = t->boundary[f];
      Axes_Private(mesh, t, cell, side % (2 * t->dim), cl[k], r);
    }
    ++number;
  }
  qsort(*rim, (size_t)*num, sizeof(Rim), Compare_Private);
  PetscFunctionReturn(PETSC_SUCCESS);
}
