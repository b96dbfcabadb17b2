/* The pressure of the mixed formulation, condensed in the cell: energy m/2 int (Proj g)^2, Proj the L2 projection on complete polynomials of degree p-1
   in reference coordinates with the reference volume as weight. pi = m M^-1 int q g(J) is what u implies (docs/theory.md, mixed formulation). Incompressible
   cells are given pi and return int q g(J). */
#include "mechanicsimpl.h"

/* In-place Cholesky factor (lower) of M[m][m]. */
static void Factor_Private(PetscInt m, Lanes *M)
{
  for (PetscInt j = 0; j < m; j++) {
    for (PetscInt i = j; i < m; i++) {
      Lanes sum = M[i * m + j];

      for (PetscInt l = 0; l < j; l++) sum -= M[i * m + l] * M[j * m + l];
      if (i == j) {
        for (int lane = 0; lane < NUM_LANES; lane++) M[j * m + j][lane] = PetscSqrtReal(sum[lane]);
      } else
        M[i * m + j] = sum / M[j * m + j];
    }
  }
}

/* x = L^-1 x for num right sides x[m][num]. */
static void SolveLower_Private(PetscInt m, const Lanes *L, PetscInt num, Lanes *x)
{
  for (PetscInt i = 0; i < m; i++) {
    for (PetscInt l = 0; l < i; l++) {
      for (PetscInt j = 0; j < num; j++) x[i * num + j] -= L[i * m + l] * x[l * num + j];
    }
    for (PetscInt j = 0; j < num; j++) x[i * num + j] /= L[i * m + i];
  }
}

/* x = L^-T x for one right side with stride. */
static void SolveUpper_Private(PetscInt m, const Lanes *L, PetscInt stride, Lanes *x)
{
  for (PetscInt i = m - 1; i >= 0; i--) {
    for (PetscInt l = i + 1; l < m; l++) x[i * stride] -= L[l * m + i] * x[l * stride];
    x[i * stride] /= L[i * m + i];
  }
}

/* Sum of coefficients times pressure functions at point q. */
INLINE Lanes Evaluate_Private(CellKernel k, PetscInt q, const Lanes *coefficient)
{
  Lanes sum = {0};

  for (PetscInt i = 0; i < k->num_pressure; i++) sum += k->legendre[q * k->num_pressure + i] * coefficient[i];
  return sum;
}

/* What of the volume coarser cells did not see as they flowed takes no pressure (MaterialLaw.settled). */
static void Settle_Private(CellKernel k, Lanes *g)
{
  const PetscInt h = k->material.law->num_history, slab = k->slab_points;

  for (PetscInt q = 0; q < k->num_points; q++) g[q] -= k->history[((q / slab) * h + k->material.law->settled) * slab + q % slab];
}

void CellKernelProject_Private(CellKernel k)
{
  const PetscInt  m = k->num_pressure, nq = k->num_points;
  const PetscReal modulus = MaterialVolumetricModulus(&k->material);
  Lanes          *g       = k->measure + nq;

  MaterialVolumetricPoints(&k->material, nq * NUM_LANES, (PetscReal *)k->measure, (PetscReal *)g, (PetscReal *)(g + nq), (PetscReal *)(g + 2 * nq));
  if (k->material.law->settled) Settle_Private(k, g);
  for (PetscInt i = 0; i < m * m; i++) k->mass[i] = (Lanes){0};
  for (PetscInt i = 0; i < m; i++) k->moment[i] = (Lanes){0};
  for (PetscInt q = 0; q < nq; q++) {
    const PetscReal *L = k->legendre + q * m;

    for (PetscInt i = 0; i < m; i++) {
      const Lanes wi = k->volume[q] * L[i];

      for (PetscInt j = 0; j <= i; j++) k->mass[i * m + j] += wi * L[j];
      k->moment[i] += wi * g[q];
    }
  }
  if (k->incompressible) return; /* pi is no function of u */
  Factor_Private(m, k->mass);
  for (PetscInt i = 0; i < m; i++) k->coefficient[i] = modulus * k->moment[i];
  SolveLower_Private(m, k->mass, 1, k->coefficient);
  SolveUpper_Private(m, k->mass, 1, k->coefficient);
}

/* dg/dF: g' cof F; small: g = tr eps, so 1. */
INLINE void MeasureGradient_Private(CellKernel k, PetscInt q, Lanes grad[9])
{
  const PetscInt slab = k->slab_points;
  const Lanes   *F    = k->F + (q / slab) * 9 * slab + q % slab;
  Lanes          local[9];

  for (int c = 0; c < 9; c++) local[c] = F[c * slab];
  CellCofactor(local, grad);
  for (int c = 0; c < 9; c++) grad[c] = k->small ? (Lanes){0} + (c % 4 == 0 ? 1 : 0) : grad[c] * k->measure[2 * k->num_points + q];
}

void CellKernelAddPressure_Private(CellKernel k, const Lanes *coefficient)
{
  const PetscInt slab = k->slab_points;

  for (PetscInt q = 0; q < k->num_points; q++) {
    Lanes      *P  = k->P + (q / slab) * 9 * slab + q % slab, grad[9];
    const Lanes pi = Evaluate_Private(k, q, coefficient);

    MeasureGradient_Private(k, q, grad);
    for (int c = 0; c < 9; c++) P[c * slab] += pi * grad[c];
  }
}

void CellKernelAddPressureTangent_Private(CellKernel k, PetscInt s, const Lanes *coefficient)
{
  const PetscInt slab = k->slab_points, nq = k->num_points;

  if (k->small) return; /* g is linear in u */
  for (PetscInt i = 0; i < slab; i++) {
    const PetscInt q  = s * slab + i;
    const Lanes    pi = Evaluate_Private(k, q, coefficient), c1 = pi * k->measure[2 * nq + q], c2 = pi * k->measure[3 * nq + q];
    Lanes          F[9], cof[9], *A                                                               = k->A + i;

    for (int c = 0; c < 9; c++) F[c] = k->F[(s * 9 + c) * slab + i];
    CellCofactor(F, cof);
    for (int a = 0; a < 9; a++) {
      const int   i1 = (a / 3 + 1) % 3, i2 = (a / 3 + 2) % 3, J1 = (a % 3 + 1) % 3, J2 = (a % 3 + 2) % 3;
      const Lanes ca = c2 * cof[a];

      for (int b = 0; b < 9; b++) A[(9 * a + b) * slab] += ca * cof[b];
      A[(9 * a + 3 * i1 + J1) * slab] += c1 * F[3 * i2 + J2];
      A[(9 * a + 3 * i2 + J2) * slab] += c1 * F[3 * i1 + J1];
      A[(9 * a + 3 * i1 + J2) * slab] -= c1 * F[3 * i2 + J1];
      A[(9 * a + 3 * i2 + J1) * slab] -= c1 * F[3 * i1 + J2];
    }
  }
}

/* b_l = int q_l dg/dF : grad N, then L^-1 b, so that b^T M^-1 b is a sum of squares. dpressure = modulus M^-1 b. */
void CellKernelCouple_Private(CellKernel k, PetscInt num_cells, PetscReal *dpressure)
{
  const PetscInt  m = k->num_pressure, nq = k->num_points, n = k->num_nodes, d = k->dim, size = n * d, len = d * k->num_derivatives;
  const PetscReal modulus = MaterialVolumetricModulus(&k->material);
  Lanes          *base = k->gradient, *flux = k->P; /* P is free once the residual is done; len <= 9 */

  for (PetscInt q = 0; q < nq; q++) {
    Lanes grad[9];

    MeasureGradient_Private(k, q, grad);
    CellKernelPullBack_Private(k, q, grad, base);
  }
  for (PetscInt l = 0; l < m; l++) {
    for (PetscInt c = 0; c < len; c++) {
      for (PetscInt q = 0; q < nq; q++) flux[c * nq + q] = k->legendre[q * m + l] * base[c * nq + q];
    }
    CellKernelIntegrate_Private(k, flux, k->coupling + l * size);
  }
  if (!k->incompressible) SolveLower_Private(m, k->mass, size, k->coupling);
  if (!dpressure) return;
  for (PetscInt c = 0; c < d; c++) {
    for (PetscInt node = 0; node < n; node++) {
      Lanes x[(MORTISE_MAX_ORDER * (MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 2)) / 6];

      for (PetscInt l = 0; l < m; l++) x[l] = (k->incompressible ? 1 : modulus) * k->coupling[l * size + c * n + node];
      if (!k->incompressible) SolveUpper_Private(m, k->mass, 1, x);
      for (PetscInt l = 0; l < m; l++) {
        for (PetscInt cell = 0; cell < num_cells; cell++) dpressure[(cell * m + l) * size + node * d + c] = x[l][cell];
      }
    }
  }
}
