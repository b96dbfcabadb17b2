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

/* A cell's positions and displacements, in lanes 0..d-1 and d..2d-1. */
static void Fields_Private(CellKernel k, const PetscReal *X, const PetscReal *u, ElementFields *fields)
{
  ElementFieldsBegin(fields, k->dim, k->order);
  ElementFieldsAdd(fields, 0, k->dim, X);
  ElementFieldsAdd(fields, k->dim, k->dim, u);
}

/* Reference position of xi, a third component 0 in the plane; dX/dxi and F = 1 + grad u there, embedded in 3x3. */
static PetscErrorCode PointGradient_Private(CellKernel k, ElementFields *fields, const PetscReal *xi, PetscReal position[3], PetscReal J[9], PetscReal F[9])
{
  const PetscInt d = k->dim;
  Lanes          value[4];
  PetscReal      G[9], inv[9];

  PetscFunctionBegin;
  PetscCall(ElementFieldsAt(fields, xi, value));
  PetscCall(PetscArrayzero(F, 9));
  for (PetscInt c = 0; c < 9; c++) J[c] = c % 4 == 0;
  position[2] = 0;
  for (PetscInt i = 0; i < d; i++) {
    position[i] = value[0][i];
    for (PetscInt r = 0; r < d; r++) J[3 * i + r] = G[i * d + r] = value[1 + r][i];
  }
  Invert_Private(d, G, inv);
  for (PetscInt i = 0; i < d; i++) {
    for (PetscInt r = 0; r < d; r++) {
      for (PetscInt K = 0; K < d; K++) F[3 * i + K] += value[1 + r][d + i] * inv[r * d + K];
    }
  }
  /* On the axis, by the round-off of a mesh file, the hoop strain is the limit u_r/R -> du_r/dR. */
  if (k->hoop) F[8] = position[0] > ROUND_LENGTH * (PetscAbsReal(G[0]) + PetscAbsReal(G[1])) ? value[0][d] / position[0] : F[0];
  for (PetscInt c = 0; c < 9; c += 4) F[c] += 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CellKernelNumFibers(CellKernel k, PetscInt *num)
{
  *num = 3 * k->material.num_fibers * k->num_points;
}

/* Directions at point `at` of n into fiber [num_fibers][3][n]. */
static void PackFibers_Private(CellKernel k, PetscInt root, const PetscReal position[3], PetscInt at, PetscInt n, PetscReal *fiber)
{
  PetscReal direction[MATERIAL_MAX_FIBERS][3];

  MaterialFiberDirections(&k->material, root, position, direction);
  for (PetscInt i = 0; i < 3 * k->material.num_fibers; i++) fiber[i * n + at] = direction[i / 3][i % 3];
}

PetscErrorCode CellKernelFibers(CellKernel k, PetscInt root, const PetscReal *X, PetscReal *fiber)
{
  PetscReal value[MOST_NODES];

  PetscFunctionBegin;
  for (PetscInt q = 0; q < k->num_points; q++) {
    PetscReal xi[3], place[3] = {0, 0, 0};

    Basis1DPoint(k->basis, k->dim, q, xi);
    PetscCall(ElementEvaluate(k->dim, k->order, xi, value, NULL));
    for (PetscInt i = 0; i < k->num_nodes * k->dim; i++) place[i % k->dim] += value[i / k->dim] * X[i];
    PackFibers_Private(k, root, place, q, k->num_points, fiber);
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
static PetscErrorCode Remembered_Private(CellKernel k, ElementFields *fields, const PetscReal *history, PetscReal *values, PetscBool *bad)
{
  const PetscInt h = k->material.law->num_history;

  PetscFunctionBegin;
  for (PetscInt q = 0; q < k->num_points; q++, values += REMEMBERED, history += h) {
    PetscReal      xi[3], F[9], J[9], P[9], position[3];
    MaterialPoints point = {.n = 1, .F = F, .W = values + 9, .P = P, .history = history};

    Basis1DPoint(k->basis, k->dim, q, xi);
    PetscCall(PointGradient_Private(k, fields, xi, position, J, F));
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

/* What the laws see and answer at up to NUM_LANES points, [..][points]. */
typedef struct {
  PetscReal fiber[3 * MATERIAL_MAX_FIBERS * NUM_LANES], F[9 * NUM_LANES], P[9 * NUM_LANES], W[NUM_LANES];
} Pack;

/* Is an answer of the law wanted? */
static PetscBool Stress_Private(const PointValues *out)
{
  return (PetscBool)(out->P || out->W);
}

/* n points from xi on; remembered: NULL, or what a law with history knows. */
static PetscErrorCode Points_Private(CellKernel k, PetscInt root, PetscInt n, const PetscReal *xi, ElementFields *fields, const PetscReal *pressure,
                                     const PetscReal *remembered, const PointValues *out, PetscBool *bad)
{
  Pack      pack;
  PetscReal t[REMEMBERED], J[NUM_LANES][9], F[NUM_LANES][9], P[NUM_LANES][9], position[NUM_LANES][3];

  PetscFunctionBegin;
  for (PetscInt q = 0; q < n; q++) {
    PetscCall(PointGradient_Private(k, fields, xi + q * k->dim, position[q], J[q], F[q]));
    if (!Stress_Private(out)) continue;
    PackFibers_Private(k, root, position[q], q, n, pack.fiber);
    for (PetscInt c = 0; c < 9; c++) pack.F[c * n + q] = F[q][c];
  }
  if (out->X) PetscCall(PetscArraycpy(out->X, position[0], 3 * n));
  if (out->J) PetscCall(PetscArraycpy(out->J, J[0], 9 * n));
  if (out->F) PetscCall(PetscArraycpy(out->F, F[0], 9 * n));
  if (!Stress_Private(out)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!remembered) {
    MaterialPoints point = {.n = n, .F = pack.F, .fiber = pack.fiber, .W = pack.W, .P = pack.P};
    PetscCall(MaterialEvaluate(&k->material, k->mixed ? MATERIAL_ISOCHORIC : MATERIAL_FULL, &point));
    if (point.bad) *bad = PETSC_TRUE;
  }
  for (PetscInt q = 0; q < n; q++) {
    for (PetscInt c = 0; !remembered && c < 9; c++) P[q][c] = pack.P[c * n + q];
    if (remembered) {
      Basis1DInterpolate(k->basis, k->dim, xi + q * k->dim, REMEMBERED, remembered, t);
      FirstPiola_Private(t, F[q], P[q]);
      pack.W[q] = t[9];
    }
    if (k->mixed) PetscCall(AddPointPressure_Private(k, xi + q * k->dim, pressure, F[q], P[q], &pack.W[q]));
  }
  if (out->P) PetscCall(PetscArraycpy(out->P, P[0], 9 * n));
  if (out->W) PetscCall(PetscArraycpy(out->W, pack.W, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellKernelPoints(CellKernel k, PetscInt root, PetscInt np, const PetscReal *xi, const PetscReal *X, const PetscReal *u,
                                const PetscReal *pressure, const PetscReal *history, const PointValues *values, PetscBool *bad)
{
  PetscReal    *remembered = NULL;
  ElementFields fields;

  PetscFunctionBegin;
  PetscCheck(!k->mixed || pressure, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "A mixed cell needs its pressure coefficients");
  *bad = PETSC_FALSE;
  Fields_Private(k, X, u, &fields);
  if (k->material.law->num_history > 0 && Stress_Private(values)) {
    PetscCall(PetscMalloc1(k->num_points * REMEMBERED, &remembered));
    PetscCall(Remembered_Private(k, &fields, history, remembered, bad));
  }
  for (PetscInt q = 0; q < np; q += NUM_LANES) {
    const PointValues from = {values->X ? values->X + 3 * q : NULL, values->J ? values->J + 9 * q : NULL, values->F ? values->F + 9 * q : NULL,
                              values->P ? values->P + 9 * q : NULL, values->W ? values->W + q : NULL};
    PetscCall(Points_Private(k, root, PetscMin(NUM_LANES, np - q), xi + q * k->dim, &fields, pressure, remembered, &from, bad));
  }
  PetscCall(PetscFree(remembered));
  PetscFunctionReturn(PETSC_SUCCESS);
}
