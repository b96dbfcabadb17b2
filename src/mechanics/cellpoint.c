/* Deformation gradient, stress and energy density at single points of one cell, for output and estimation. */
#include "mechanicsimpl.h"

#define MOST_NODES ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1))

/* inv[r][J] = dxi_r/dX_J of G[J][r] (dim x dim); returns the determinant. */
static PetscReal Invert_Private(PetscInt dim, const PetscReal G[9], PetscReal inv[9])
{
  PetscReal det;

  if (dim == 2) {
    det    = G[0] * G[3] - G[1] * G[2];
    inv[0] = G[3] / det;
    inv[1] = -G[1] / det;
    inv[2] = -G[2] / det;
    inv[3] = G[0] / det;
    return det;
  }
  det = Det3(G);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;

      inv[3 * j + i] = (G[3 * i1 + j1] * G[3 * i2 + j2] - G[3 * i1 + j2] * G[3 * i2 + j1]) / det;
    }
  }
  return det;
}

/* Reference position of xi, a third component 0 in the plane; and grad u there, embedded in 3x3. */
static PetscErrorCode PointGradient_Private(CellKernel k, const PetscReal *xi, const PetscReal *X, const PetscReal *u, PetscReal position[3], PetscReal H[9])
{
  const PetscInt d = k->dim;
  PetscReal      value[MOST_NODES], gradient[3 * MOST_NODES], G[9] = {0}, g[9] = {0}, inv[9], ur = 0;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(position, 3));
  PetscCall(ElementEvaluate(d, k->order, xi, value, gradient));
  for (PetscInt node = 0; node < k->num_nodes; node++) {
    for (PetscInt i = 0; i < d; i++) {
      for (PetscInt r = 0; r < d; r++) {
        G[i * d + r] += X[node * d + i] * gradient[node * d + r];
        g[i * d + r] += u[node * d + i] * gradient[node * d + r];
      }
      position[i] += value[node] * X[node * d + i];
    }
    ur += value[node] * u[node * d];
  }
  Invert_Private(d, G, inv);
  PetscCall(PetscArrayzero(H, 9));
  for (PetscInt i = 0; i < d; i++) {
    for (PetscInt r = 0; r < d; r++) {
      for (PetscInt J = 0; J < d; J++) H[3 * i + J] += g[i * d + r] * inv[r * d + J];
    }
  }
  /* On the axis the hoop strain is the limit u_r/R -> du_r/dR. */
  if (k->hoop) H[8] = position[0] > 0 ? ur / position[0] : H[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CellKernelNumFibers(CellKernel k, PetscInt *num)
{
  *num = 3 * k->material.num_fibers * k->num_points;
}

PetscErrorCode CellKernelFibers(CellKernel k, PetscInt root, const PetscReal *X, PetscReal *fiber)
{
  PetscReal value[MOST_NODES];

  PetscFunctionBegin;
  for (PetscInt q = 0; q < k->num_points; q++) {
    PetscReal xi[3], place[3] = {0, 0, 0}, direction[MATERIAL_MAX_FIBERS][3];

    Basis1DPoint(k->basis, k->dim, q, xi);
    PetscCall(ElementEvaluate(k->dim, k->order, xi, value, NULL));
    for (PetscInt i = 0; i < k->num_nodes * k->dim; i++) place[i % k->dim] += value[i / k->dim] * X[i];
    MaterialFiberDirections(&k->material, root, place, direction);
    for (PetscInt i = 0; i < 3 * k->material.num_fibers; i++) fiber[i * k->num_points + q] = direction[i / 3][i % 3];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pressure field at xi, functions in the order of TablesCreate_Private (cell.c). */
static PetscErrorCode PointPressure_Private(CellKernel k, const PetscReal *xi, const PetscReal *coefficient, PetscReal *pi)
{
  PetscReal v[3][MORTISE_MAX_ORDER + 1] = {{0}};
  PetscInt  l                           = 0;

  PetscFunctionBegin;
  v[2][0] = 1;
  for (PetscInt c = 0; c < k->dim; c++) PetscCall(ElementLegendre(k->order - 1, xi[c], v[c], NULL));
  for (PetscInt z = 0; z < (k->dim == 3 ? k->order : 1); z++) {
    for (PetscInt y = 0; y + z < k->order; y++) {
      for (PetscInt x = 0; x + y + z < k->order; x++) *pi += coefficient[l++] * v[0][x] * v[1][y] * v[2][z];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* P += pi g'(J) cof F, W += pi^2 / (2 modulus); small: g = tr eps. */
static PetscErrorCode AddPointPressure_Private(CellKernel k, const PetscReal *xi, const PetscReal *coefficient, const PetscReal F[9], PetscReal P[9],
                                               PetscReal *W)
{
  PetscReal pi = 0, cof[9], g[3];

  PetscFunctionBegin;
  PetscCall(PointPressure_Private(k, xi, coefficient, &pi));
  MaterialVolumetric(&k->material, k->small ? 1 : Det3(F), g);
  for (int a = 0; a < 9; a++) {
    const int i1 = (a / 3 + 1) % 3, i2 = (a / 3 + 2) % 3, J1 = (a % 3 + 1) % 3, J2 = (a % 3 + 2) % 3;

    cof[a] = k->small ? (a % 4 == 0) : F[3 * i1 + J1] * F[3 * i2 + J2] - F[3 * i1 + J2] * F[3 * i2 + J1];
    P[a] += pi * g[1] * cof[a];
  }
  *W += pi * pi / (2 * MaterialVolumetricModulus(&k->material));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define REMEMBERED 10 /* Kirchhoff stress, energy density */

/* What a law with history answers at the integration points: [num_points][REMEMBERED]. */
static PetscErrorCode Remembered_Private(CellKernel k, const PetscReal *X, const PetscReal *u, const PetscReal *history, PetscReal *values, PetscBool *bad)
{
  const PetscInt h = k->material.law->num_history;

  PetscFunctionBegin;
  for (PetscInt q = 0; q < k->num_points; q++, values += REMEMBERED, history += h) {
    PetscReal      xi[3], F[9], P[9], position[3];
    MaterialPoints point = {.n = 1, .F = F, .W = values + 9, .P = P, .history = history};

    Basis1DPoint(k->basis, k->dim, q, xi);
    PetscCall(PointGradient_Private(k, xi, X, u, position, F));
    for (int c = 0; c < 9; c += 4) F[c] += 1;
    PetscCall(MaterialEvaluate(&k->material, k->mixed ? MATERIAL_ISOCHORIC : MATERIAL_FULL, &point));
    if (point.bad) *bad = PETSC_TRUE;
    for (int c = 0; c < 9; c++) values[c] = Dot3(P + 3 * (c / 3), F + 3 * (c % 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* P = tau F^-T. */
static void FirstPiola_Private(const PetscReal tau[9], const PetscReal F[9], PetscReal P[9])
{
  PetscReal inv[9];

  Invert_Private(3, F, inv);
  for (int c = 0; c < 9; c++) P[c] = Dot3(tau + 3 * (c / 3), inv + 3 * (c % 3));
}

PetscErrorCode CellKernelPoints(CellKernel k, PetscInt root, PetscInt np, const PetscReal *xi, const PetscReal *X, const PetscReal *u,
                                const PetscReal *pressure, const PetscReal *history, PetscReal *F, PetscReal *P, PetscReal *W, PetscBool *bad)
{
  const PetscBool remembers = (PetscBool)(k->material.law->num_history > 0);
  PetscReal      *values    = NULL;

  PetscFunctionBegin;
  PetscCheck(!k->mixed || pressure, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "A mixed cell needs its pressure coefficients");
  *bad = PETSC_FALSE;
  if (remembers) PetscCall(PetscMalloc1(k->num_points * REMEMBERED, &values));
  if (remembers) PetscCall(Remembered_Private(k, X, u, history, values, bad));
  for (PetscInt q = 0; q < np; q++) {
    PetscReal      f[9], p[9], w, t[REMEMBERED], position[3], fiber[MATERIAL_MAX_FIBERS][3];
    MaterialPoints point = {.n = 1, .F = f, .fiber = fiber[0], .W = &w, .P = p};

    PetscCall(PointGradient_Private(k, xi + q * k->dim, X, u, position, f));
    MaterialFiberDirections(&k->material, root, position, fiber);
    for (int c = 0; c < 9; c += 4) f[c] += 1;
    if (remembers) {
      Basis1DInterpolate(k->basis, k->dim, xi + q * k->dim, REMEMBERED, values, t);
      FirstPiola_Private(t, f, p);
      w = t[9];
    } else
      PetscCall(MaterialEvaluate(&k->material, k->mixed ? MATERIAL_ISOCHORIC : MATERIAL_FULL, &point));
    if (point.bad) *bad = PETSC_TRUE;
    if (k->mixed) PetscCall(AddPointPressure_Private(k, xi + q * k->dim, pressure, f, p, &w));
    if (F) PetscCall(PetscArraycpy(F + 9 * q, f, 9));
    if (P) PetscCall(PetscArraycpy(P + 9 * q, p, 9));
    if (W) W[q] = w;
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
