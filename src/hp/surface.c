/* Where the vertices of linear contact faces lie when the cells behind them are of higher order (two dimensions).

   On the exact curve they would span an inscribed polygon: for facets of length h on radius R its mean distance from the curve is h^2/(12 R), a spurious gap
   (and in nearly incompressible bodies a lack of volume) far above the error of the cells: 0.4 % of the force of rubber2d.yml at h = 0.1. Instead they take the
   dual projection of the curve, int psi_j (X - X_h) = 0 with the functions psi_j that also test the gap: the weighted gap of the polygon is that of the curve,
   to the accuracy of the facets' lengths. Local, and exact on straight parts. Ends of a surface stay on the curve: another boundary begins there. Behind cells
   of order 1 every boundary is an inscribed polygon and the error of the cells is of the same order: nothing moves. */
#include "hpimpl.h"

#define NUM_POINTS 3 /* Gauss points: exact for geometry up to order 4 */

/* The leaf behind a facet on the surface and above order 1, or -1. */
static PetscInt LeafBehind_Private(HPSpace hp, PetscInt facet, uint64_t groups)
{
  const ForestTables *t = hp->tables;

  if (!(t->boundary[facet] & groups)) return -1;
  const PetscInt *sides = t->facet_leaf + 2 * (facet - t->first[1]), leaf = sides[0] >= 0 ? sides[0] : sides[1];
  return leaf >= 0 && hp->entity_order[t->first[2] + leaf] > 1 ? leaf : -1;
}

static PetscErrorCode CurvePoint_Private(HPSpace hp, PetscInt leaf, PetscInt facet, PetscReal s, PetscReal X[3])
{
  const PetscReal eta[3] = {s, 0, 0};
  PetscReal       xi[3]  = {0, 0, 0};

  PetscFunctionBegin;
  HPEntityToLeaf_Private(hp->tables, leaf, facet, 1, eta, xi);
  PetscCall(ForestMapPoint(hp->forest, leaf, xi, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* moment[j] = int psi_j (X - chord), psi = 2 - 3s, 3s - 1; length of the chord. */
static PetscErrorCode Moments_Private(HPSpace hp, PetscInt leaf, PetscInt facet, PetscReal moment[2][3], PetscReal *length)
{
  const Basis1D *gauss;
  PetscReal      a[3], b[3], X[3], square = 0;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(1, NUM_POINTS, &gauss));
  PetscCall(CurvePoint_Private(hp, leaf, facet, 0, a));
  PetscCall(CurvePoint_Private(hp, leaf, facet, 1, b));
  for (PetscInt c = 0; c < 3; ++c) {
    moment[0][c] = moment[1][c] = 0;
    square += PetscSqr(b[c] - a[c]);
  }
  *length = PetscSqrtReal(square);
  for (PetscInt q = 0; q < NUM_POINTS; ++q) {
    const PetscReal s = gauss->points[q], w = gauss->weights[q] * *length;
    PetscCall(CurvePoint_Private(hp, leaf, facet, s, X));
    for (PetscInt c = 0; c < 3; ++c) {
      const PetscReal d = X[c] - (1 - s) * a[c] - s * b[c];
      moment[0][c] += w * (2 - 3 * s) * d;
      moment[1][c] += w * (3 * s - 1) * d;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* shift [num vertices][3], zero where nothing moves; freed by the caller. */
PetscErrorCode HPSpaceSurfaceShift_Private(HPSpace hp, uint64_t groups, PetscReal **shift)
{
  const ForestTables *t   = hp->tables;
  const PetscInt      num = t->first[1];
  PetscReal          *weight;
  PetscInt           *count;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(3 * num, shift));
  PetscCall(PetscCalloc2(num, &weight, num, &count));
  for (PetscInt facet = t->first[1]; t->dim == 2 && facet < t->first[2]; ++facet) {
    const PetscInt *vertices = t->closure + t->closure_offset[facet], leaf = LeafBehind_Private(hp, facet, groups);
    PetscReal       moment[2][3], length;
    if (leaf < 0) continue;
    PetscCall(Moments_Private(hp, leaf, facet, moment, &length));
    for (PetscInt j = 0; j < 2; ++j) {
      const PetscInt v = vertices[2 * j];
      for (PetscInt c = 0; c < 3; ++c) (*shift)[3 * v + c] += moment[j][c];
      weight[v] += 0.5 * length;
      count[v]++;
    }
  }
  for (PetscInt v = 0; v < num; ++v) {
    for (PetscInt c = 0; c < 3; ++c) (*shift)[3 * v + c] = count[v] == 2 ? (*shift)[3 * v + c] / weight[v] : 0;
  }
  PetscCall(PetscFree2(weight, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}
