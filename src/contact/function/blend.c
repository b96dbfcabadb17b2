/* One continuous rule for facets that are covered in part. s: covered share of the chart, e = 1 / (p (p + 1))^(d - 1): a
   corner's share of the weights.

   Functions: psi(s) = theta(s) dual + (1 - theta(s)) Bernstein, of the facet's order. The dual ones have the best rates,
   but int psi_j over a part of the facet may be negative; Bernstein polynomials are positive, so that weights are,
   whatever is covered, and they sum to 1 and reproduce what is linear as well. theta = 1 while less than 0.3 e is
   uncovered (no weight of a dual function gets near zero), 0 from e on, two derivatives continuous.

   Compliance: gaps count as gt + S z, S = kappa(s) [diag m - m m^T / sum m]: pressure that is constant on a facet does not
   see it. m_j: softness times reference measure of the Bernstein function. Where the mortar side ends a little beyond a
   node, all that is covered of the facet's other functions is a sliver. Their constraints say nearly the same as the
   first one's, and pressures that grow like powers of 1 / w_j would bend the facet so that the sliver fits. With kappa,
   which vanishes with s slower than these w_j do, a sliver's pressure is that of the facet. kappa is 0 where theta = 1:
   nothing that is covered is ever compliant. */
#include "functionimpl.h"

#define WHOLE 0.3     /* of a corner's share: what may be uncovered of a facet that counts as covered */
#define EPSILON 0.002 /* order 1: a facet that is half covered has this share of the cells' compliance */

void ContactShareOf(PetscInt m, PetscInt order, PetscReal share, ContactShare *o)
{
  const PetscReal p = (PetscReal)order, corner = m == 1 ? 1 / (p * (p + 1)) : 1 / (p * (p + 1) * p * (p + 1)), whole = 1 - WHOLE * corner;
  const PetscReal u = (whole - share) / ((1 - WHOLE) * corner), du = -1 / ((1 - WHOLE) * corner), t = share / whole, factor = 16 * EPSILON / p;

  *o = (ContactShare){.part = (PetscBool)(share < whole), .theta = {1, 0, 0}, .kappa = {0, 0, 0}};
  if (!o->part) return;
  if (u < 1) {
    o->theta[0] = 1 - u * u * u * (10 - 15 * u + 6 * u * u);
    o->theta[1] = -30 * u * u * (1 - u) * (1 - u) * du;
    o->theta[2] = -60 * u * (1 - u) * (1 - 2 * u) * du * du;
  } else
    o->theta[0] = 0;
  o->kappa[0] = factor * t * t * (1 - t) * (1 - t);
  o->kappa[1] = factor * 2 * t * (1 - t) * (1 - 2 * t) / whole;
  o->kappa[2] = factor * 2 * (1 - 6 * t + 6 * t * t) / (whole * whole);
}

PetscErrorCode ContactBernstein(PetscInt m, PetscInt order, PetscReal C[])
{
  const PetscInt   n = order + 1, num = ElementNumNodes(m, order);
  const PetscReal *x;
  PetscReal        b[MORTISE_MAX_ORDER + 1][MORTISE_MAX_ORDER + 1]; /* [function][node] */

  PetscFunctionBegin;
  PetscCall(ElementGetNodes(order, &x));
  for (PetscInt a = 0; a < n; a++)
    for (PetscInt j = 0; j < n; j++) {
      b[j][a] = 1;
      for (PetscInt k = 0; k < j; k++) b[j][a] *= x[a] * (PetscReal)(order - k) / (PetscReal)(k + 1);
      for (PetscInt k = j; k < order; k++) b[j][a] *= 1 - x[a];
    }
  for (PetscInt j = 0; j < num; j++)
    for (PetscInt a = 0; a < num; a++) C[num * j + a] = b[j % n][a % n] * (m == 2 ? b[j / n][a / n] : 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}
