/* How fast the Legendre coefficients of the displacement in a cell fall.

   u(xi) = sum_a c_a P_a1(xi_1) P_a2(xi_2) (P_a3(xi_3)) on the cell's reference coordinates; B_k, the L2 norm there of the part with max a_d = k. The rate is
   minus the slope of the straight line that fits ln B_k, k = 2 .. p, best; rigid motion and uniform strain (k = 0, 1) say nothing of smoothness. Where a
   symmetry makes a B_k small, the next one counts for it, too. */
#include "estimateimpl.h"

#define MOST_1D (MORTISE_MAX_ORDER + 1)
#define RATE_MOST 40.0 /* nothing but round-off beyond degree 1 */
#define ROUND_OFF 1e-13

/* T[k][i]: coefficient of P_k in the nodal function i, (2k+1) int P_k N_i, exact by p+1 Gauss points. */
static PetscErrorCode ToLegendre_Private(PetscInt order, PetscReal T[MOST_1D][MOST_1D])
{
  const Basis1D *basis;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, order + 1, &basis));
  PetscCall(PetscMemzero(T, sizeof(PetscReal[MOST_1D][MOST_1D])));
  for (PetscInt q = 0; q <= order; ++q) {
    PetscReal P[MOST_1D];
    PetscCall(ElementLegendre(order, basis->points[q], P, NULL));
    for (PetscInt k = 0; k <= order; ++k)
      for (PetscInt i = 0; i <= order; ++i) T[k][i] += (PetscReal)(2 * k + 1) * basis->weights[q] * P[k] * basis->B[q * (order + 1) + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* values[n][dim], in place: nodal to Legendre along each axis. */
static void Transform_Private(PetscInt dim, PetscInt order, const PetscReal T[MOST_1D][MOST_1D], PetscReal values[])
{
  const PetscInt n1 = order + 1, n = ElementNumNodes(dim, order);

  for (PetscInt d = 0, stride = dim; d < dim; ++d, stride *= n1) {
    for (PetscInt start = 0; start < n * dim; ++start) {
      PetscReal line[MOST_1D];
      if (start / stride % n1) continue;
      for (PetscInt k = 0; k < n1; ++k) {
        line[k] = 0;
        for (PetscInt i = 0; i < n1; ++i) line[k] += T[k][i] * values[start + i * stride];
      }
      for (PetscInt k = 0; k < n1; ++k) values[start + k * stride] = line[k];
    }
  }
}

/* B_k^2, k = 0..p, from the coefficients. */
static void Shells_Private(PetscInt dim, PetscInt order, const PetscReal coefficients[], PetscReal B2[MOST_1D])
{
  for (PetscInt k = 0; k <= order; ++k) B2[k] = 0;
  for (PetscInt i = 0; i < ElementNumNodes(dim, order); ++i) {
    PetscInt  most = 0;
    PetscReal norm = 1;
    for (PetscInt d = 0, j = i; d < dim; ++d, j /= order + 1) {
      most = PetscMax(most, j % (order + 1));
      norm /= (PetscReal)(2 * (j % (order + 1)) + 1);
    }
    for (PetscInt c = 0; c < dim; ++c) B2[most] += norm * PetscSqr(coefficients[i * dim + c]);
  }
}

/* Below order 3 there is no slope: 0. */
static PetscReal Rate_Private(PetscInt order, PetscReal B2[])
{
  PetscReal mean_k = 0, mean_b = 0, kb = 0, kk = 0, whole = 0;
  PetscInt  num = order - 1;

  if (order < 3) return 0;
  for (PetscInt k = 0; k <= order; ++k) whole += B2[k];
  for (PetscInt k = order - 1; k >= 2; --k) B2[k] = PetscMax(B2[k], B2[k + 1]);
  while (num > 0 && B2[num + 1] <= PetscSqr(ROUND_OFF) * whole) --num;
  if (num < 2) return RATE_MOST;
  for (PetscInt k = 2; k < num + 2; ++k) {
    mean_k += (PetscReal)k / (PetscReal)num;
    mean_b += 0.5 * PetscLogReal(B2[k]) / (PetscReal)num;
  }
  for (PetscInt k = 2; k < num + 2; ++k) {
    kk += PetscSqr((PetscReal)k - mean_k);
    kb += ((PetscReal)k - mean_k) * (0.5 * PetscLogReal(B2[k]) - mean_b);
  }
  return PetscMin(RATE_MOST, -kb / kk);
}

PetscErrorCode EstimateDecay_Private(const EstimateSum *sum, PetscReal decay[])
{
  const PetscInt dim = sum->v->dim;
  PetscReal      T[MORTISE_MAX_ORDER + 1][MOST_1D][MOST_1D], *values, B2[MOST_1D];
  PetscBool      ready[MORTISE_MAX_ORDER + 1] = {PETSC_FALSE};

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(ESTIMATE_MOST_NODES * dim, &values));
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) {
    const PetscInt order = sum->v->cell_order[c];
    if (!ready[order]) PetscCall(ToLegendre_Private(order, T[order]));
    ready[order] = PETSC_TRUE;
    PetscCall(HPSpaceGather(sum->space, c, sum->u, values));
    Transform_Private(dim, order, (const PetscReal(*)[MOST_1D])T[order], values);
    Shells_Private(dim, order, values, B2);
    decay[sum->v->cell_leaf[c]] = Rate_Private(order, B2);
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
