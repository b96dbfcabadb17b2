/* How a facet goes on beyond [-1, 1]^2: f(h) + sum_i (xi_i - h_i) sigma_i, h(xi_i) bounded and twice continuous, sigma_i a slope between its corners. It leaves
   along its tangent, so that one derivative is continuous, and turns to the slope it has as a whole.

   Of nonmortar facets: mortar vertices far beyond a bilinear facet may have no image, as the map folds where opposite sides meet. The slope is the mean of the
   two sides in direction i; but where one of them lies in a plane of symmetry, that side's: its line goes on in the plane, in which x and d lie, and there the
   mortar side ends, too. Where both do, it changes from one to the other, linearly in h of the other direction: the map then folds where the planes meet.

   Directions are taken at h alone: turning on by their slope they would cross at the distance of the facet's radius of curvature, and corners of what it sees
   that lie beyond, behind the tangent plane at a round edge, would have no image.

   Of mortar facets: rays from the strip between a curved side and its straight picture miss the facet itself. Where it is bent, its tangent at the side may be
   a fraction of that slope, across the rays, or fold; with it alone rays met it far away, or not at all. */
#include "kernelimpl.h"

/* h = xi in [-1, 1], at most 1.5; with two derivatives. */
static void Bound_Private(PetscReal xi, PetscReal h[3])
{
  const PetscReal sign = xi < 0 ? -1 : 1, v = 2 * PetscMax(0, PetscAbsReal(xi) - 1), root = 1 / PetscSqrtReal(1 + v * v);

  h[0] = v > 0 ? sign * (1 + 0.5 * v * root) : xi;
  h[1] = root * root * root;
  h[2] = -6 * sign * v * h[1] * root * root;
}

void ContactRayBeyondSides(const PetscBool kept[4], RayBeyond *b)
{
  for (int i = 0; i < 2; i++) {
    const PetscBool low = i ? kept[3] : kept[0], high = i ? kept[1] : kept[2]; /* sides in direction i, where the other coordinate is -1 and 1 */

    b->share[i] = low == high ? 0.5 : high;
    b->turn[i]  = low && high ? 0.5 : 0;
  }
}

/* Slopes of the functions that take over beyond the facet, between the corners, and their derivatives by the other coordinate's h. */
static void Slope_Private(const RayBeyond *b, PetscInt m, PetscInt order, const PetscReal h[2], PetscReal slope[2][RAY_LATTICE], PetscReal turn[2][RAY_LATTICE])
{
  const PetscInt num = ElementNumNodes(m, order), corner[4] = {0, order, num - 1 - order, num - 1};

  for (PetscInt i = 0; i < m; i++) {
    const PetscReal high = m == 1 ? 0 : b->share[i] + b->turn[i] * h[1 - i];

    for (int k = 0; k < 2 * m; k++) {
      const PetscBool to = (PetscBool)(i ? k / 2 : k % 2), on = (PetscBool)(i ? k % 2 : k / 2); /* end and side of direction i */

      slope[i][corner[k]] = (to ? 0.5 : -0.5) * (on ? high : 1 - high);
      if (m == 2) turn[i][corner[k]] = (to == on ? 0.5 : -0.5) * b->turn[i];
    }
  }
}

/* f(h) + sum_i (xi_i - h_i) slope_i; b NULL: slopes 0 */
void ContactRayBeyond(const RayBeyond *b, PetscInt m, PetscInt order, const PetscReal xi[2], int depth, RayFunctions *to)
{
  PetscReal h[2][3], slope[2][RAY_LATTICE], turn[2][RAY_LATTICE], at[2] = {0, 0}, past[2] = {0, 0};

  if (PetscMax(PetscAbsReal(xi[0]), m == 1 ? 0 : PetscAbsReal(xi[1])) <= 1) {
    ContactRayFunctions(m, order, xi, depth, to);
    return;
  }
  for (PetscInt i = 0; i < m; i++) {
    Bound_Private(xi[i], h[i]);
    at[i]   = h[i][0];
    past[i] = xi[i] - at[i];
  }
  memset(slope, 0, sizeof(slope));
  memset(turn, 0, sizeof(turn));
  if (b) Slope_Private(b, m, order, at, slope, turn);
  ContactRayFunctions(m, order, at, depth, to);
  for (PetscInt a = 0; a < ElementNumNodes(m, order); a++) {
    if (depth > 1 && m == 2) to->dd[1][a] = to->dd[1][a] * h[0][1] * h[1][1] + turn[0][a] * (1 - h[0][1]) * h[1][1] + turn[1][a] * (1 - h[1][1]) * h[0][1];
    for (PetscInt i = 0; i < m; i++) {
      const PetscReal more = to->d[i][a] - slope[i][a] + (m == 2 ? past[1 - i] * turn[1 - i][a] : 0);

      to->N[a] += past[i] * slope[i][a];
      if (depth > 1) to->dd[2 * i][a] = to->dd[2 * i][a] * PetscSqr(h[i][1]) + more * h[i][2];
      to->d[i][a] = slope[i][a] + more * h[i][1];
    }
  }
}
