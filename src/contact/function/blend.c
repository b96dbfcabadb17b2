/* One continuous rule for facets that are covered in part.

   Share s: of the weight rho = prod_i 3/4 (1 - xi_i^2) that the mortar side covers. rho vanishes at the facet's sides, so that s has a continuous derivative
   even where an end of the mortar side lies along one of them. What lies beyond a share x of a side has the weight P(x) = 3 x^2 - 2 x^3.

   Functions: psi(s) = theta(s) dual + (1 - theta(s)) Bernstein, of the facet's order. The dual ones have the best rates, but int psi_j over a part of the facet
   may be negative; Bernstein polynomials are positive, so that weights are, whatever is covered, and they sum to 1 and reproduce what is linear as well. With
   e = P(1 / (p (p + 1) + 1))^(d - 1): theta = 1 while less than a sliver, 0.1 e, is uncovered, 0 from e on, two derivatives continuous. Where the dual function
   of a corner has lost all its weight on one side (at a third of the facet, order 1; 0.155, 0.089, 0.057, orders 2 to 4), it is theta = 0 that holds; so no
   weight is negative, whatever part of a parallelogram is covered.

   Compliance: gaps count as gt + S z, S = kappa(s) [diag m - m m^T / sum m]: pressure that is constant on a facet does not see it. m_j: softness times
   reference measure of the Bernstein function. Where the mortar side ends a little beyond a node, all that is covered of the facet's other functions is a
   sliver. Their constraints say nearly the same as the first one's, and pressures that grow like powers of 1 / w_j would bend the facet so that the sliver
   fits. With kappa, which vanishes no faster with s than these w_j do, a sliver's pressure is that of the facet. kappa is 0 where theta = 1: nothing that is
   covered is ever compliant. */
#include "functionimpl.h"

#define EPSILON 0.002 /* order 1: a facet a third of which is covered has this share of the cells' compliance */
#define ACROSS 0.2    /* the same where the mortar side goes on with another face */

void ContactShareWeight(PetscInt m, const PetscReal xi[2], PetscReal *v, PetscReal d[2], PetscReal dd[3])
{
  const PetscReal a[2] = {3 * (1 - xi[0] * xi[0]) / 4, m == 2 ? 3 * (1 - xi[1] * xi[1]) / 4 : 1}, b[2] = {-3 * xi[0] / 2, m == 2 ? -3 * xi[1] / 2 : 0};

  *v   = a[0] * a[1];
  d[0] = b[0] * a[1], d[1] = a[0] * b[1];
  dd[0] = -3 * a[1] / 2, dd[1] = b[0] * b[1], dd[2] = m == 2 ? -3 * a[0] / 2 : 0;
}

void ContactShareOf(PetscInt m, PetscInt order, PetscReal share, PetscBool across, ContactShare *o)
{
  const PetscReal e = 1 / (PetscReal)(order * (order + 1) + 1), side = e * e * (3 - 2 * e), corner = m == 1 ? side : side * side,
                  whole = 1 - CONTACT_SLIVER * corner;
  const PetscReal u = (whole - share) / ((1 - CONTACT_SLIVER) * corner), du = -1 / ((1 - CONTACT_SLIVER) * corner), t = share / whole;
  const PetscReal factor = 27 * (across ? ACROSS : EPSILON) / (4 * (PetscReal)order); /* 1 / max t (1 - t)^2, at a third */

  *o = (ContactShare){.part = (PetscBool)(share < whole), .theta = {1, 0, 0}, .kappa = {0, 0, 0}};
  if (!o->part) return;
  if (u < 1) {
    o->theta[0] = 1 - u * u * u * (10 - 15 * u + 6 * u * u);
    o->theta[1] = -30 * u * u * (1 - u) * (1 - u) * du;
    o->theta[2] = -60 * u * (1 - u) * (1 - 2 * u) * du * du;
  } else
    o->theta[0] = 0;
  o->kappa[0] = factor * t * (1 - t) * (1 - t);
  o->kappa[1] = factor * (1 - t) * (1 - 3 * t) / whole;
  o->kappa[2] = factor * (6 * t - 4) / (whole * whole);
}

PetscReal ContactShareMost(PetscInt order)
{
  return EPSILON / (PetscReal)order;
}

void ContactBernstein(PetscInt m, PetscInt order, const PetscReal xi[], PetscReal B[])
{
  const PetscInt n                           = order + 1;
  PetscReal      b[2][MORTISE_MAX_ORDER + 1] = {{0}, {1}};

  for (PetscInt d = 0; d < m; d++)
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal x = 0.5 * (1 + xi[d]);

      b[d][j] = 1;
      for (PetscInt k = 0; k < j; k++) b[d][j] *= x * (PetscReal)(order - k) / (PetscReal)(k + 1);
      for (PetscInt k = j; k < order; k++) b[d][j] *= 1 - x;
    }
  for (PetscInt j = 0; j < ElementNumNodes(m, order); j++) B[j] = b[0][j % n] * b[1][j / n];
}

PetscErrorCode ContactBernsteinRows(PetscInt m, PetscInt order, PetscReal C[])
{
  const PetscInt   n = order + 1, num = ElementNumNodes(m, order);
  const PetscReal *x;
  PetscReal        B[MULTIPLIER_LATTICE];

  PetscFunctionBegin;
  PetscCall(ElementGetNodes(order, &x));
  for (PetscInt a = 0; a < num; a++) {
    ContactBernstein(m, order, (const PetscReal[2]){2 * x[a % n] - 1, 2 * x[a / n] - 1}, B);
    for (PetscInt j = 0; j < num; j++) C[num * j + a] = B[j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
