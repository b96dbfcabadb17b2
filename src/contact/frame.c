/* Axes of a nonmortar facet, and how everything seen along its normal changes when the normal turns.

   N = d_1 x d_2, d_1 = X_2 - X_0, d_2 = X_3 - X_1 the diagonals. In the facet's own axes both diagonals are horizontal, N = (0, 0, N_3), and
     ds_1 = (d_1y dd_2z - d_2y dd_1z) / N_3,   ds_2 = (d_2x dd_1z - d_1x dd_2z) / N_3,   d2s_i = d2N_i / N_3 - 2 dN_i dN_3 / N_3^2.
   With Y = (X_1, X_2) - s X_3 and p_i the vector that holds X_3 at the places of Y_i:  dU = (1 - sum_i p_i sigma_i^T) dX,  d2Y = -2 ds dX_3 - d2s X_3. */
#include "facetimpl.h"

void ContactFacetLocal(const FacetFrame *f, const PetscReal x[3], PetscReal X[3])
{
  const PetscReal r[3] = {x[0] - f->origin[0], x[1] - f->origin[1], x[2] - f->origin[2]};

  for (int i = 0; i < 3; i++) X[i] = Dot3(f->E[i], r);
}

/* Places of the diagonals among the 12 numbers: d_1 = X_2 - X_0, d_2 = X_3 - X_1. */
static void AddDiagonal_Private(PetscReal row[12], int diagonal, int component, PetscReal value)
{
  row[3 * (2 + diagonal) + component] += value;
  row[3 * diagonal + component] -= value;
}

static void Tilt_Private(FacetFrame *f)
{
  const PetscReal d[2][2] = {{f->X[2][0] - f->X[0][0], f->X[2][1] - f->X[0][1]}, {f->X[3][0] - f->X[1][0], f->X[3][1] - f->X[1][1]}};

  memset(f->sigma, 0, sizeof(f->sigma));
  AddDiagonal_Private(f->sigma[0], 1, 2, d[0][1] / f->normal3);
  AddDiagonal_Private(f->sigma[0], 0, 2, -d[1][1] / f->normal3);
  AddDiagonal_Private(f->sigma[1], 0, 2, d[1][0] / f->normal3);
  AddDiagonal_Private(f->sigma[1], 1, 2, -d[0][0] / f->normal3);
}

PetscBool ContactFacetFrame(const PetscReal x[4][3], FacetFrame *f)
{
  PetscReal d[3], e[3], length, normal;
  PlaneQuad plane;

  for (int i = 0; i < 3; i++) {
    d[i]         = x[2][i] - x[0][i];
    e[i]         = x[3][i] - x[1][i];
    f->origin[i] = 0.25 * (x[0][i] + x[1][i] + x[2][i] + x[3][i]);
  }
  Cross3(d, e, f->E[2]);
  length = PetscSqrtReal(Dot3(d, d));
  normal = PetscSqrtReal(Dot3(f->E[2], f->E[2]));
  if (!(normal > 0)) return PETSC_FALSE;
  for (int i = 0; i < 3; i++) {
    f->E[0][i] = d[i] / length;
    f->E[2][i] /= normal;
  }
  Cross3(f->E[2], f->E[0], f->E[1]);
  f->normal3 = normal;
  f->area    = 0.5 * normal;
  for (int a = 0; a < 4; a++) {
    ContactFacetLocal(f, x[a], f->X[a]);
    plane.Y[a][0] = f->X[a][0], plane.Y[a][1] = f->X[a][1];
  }
  Tilt_Private(f);
  return ContactQuadIsConvex(&plane);
}

void ContactTiltGradient(const FacetFrame *f, PetscInt num, const PetscReal X[], PetscReal g[])
{
  PetscReal T[2] = {0, 0};

  for (PetscInt n = 0; n < num; n += 3)
    for (int i = 0; i < 2; i++) T[i] += g[n + i] * X[n + 2];
  for (int i = 0; i < 2; i++)
    for (int a = 0; a < 12; a++) g[a] -= T[i] * f->sigma[i][a];
}

/* W -= T (half of d2s_i) */
static void TiltCurvature_Private(const FacetFrame *f, int i, PetscReal T, PetscInt num, PetscReal W[])
{
  const PetscReal d[2][2] = {{f->X[2][0] - f->X[0][0], f->X[2][1] - f->X[0][1]}, {f->X[3][0] - f->X[1][0], f->X[3][1] - f->X[1][1]}};
  const int       other   = 1 - i;
  PetscReal       dN3[12] = {0}, left[2][12] = {{0}}, right[2][12] = {{0}};

  AddDiagonal_Private(dN3, 0, 0, d[1][1]);
  AddDiagonal_Private(dN3, 0, 1, -d[1][0]);
  AddDiagonal_Private(dN3, 1, 1, d[0][0]);
  AddDiagonal_Private(dN3, 1, 0, -d[0][1]);
  /* half of d2N_1 = dd_1y dd_2z - dd_1z dd_2y, of d2N_2 = dd_1z dd_2x - dd_1x dd_2z */
  AddDiagonal_Private(left[0], 0, other, 1);
  AddDiagonal_Private(right[0], 1, 2, i == 0 ? 1 : -1);
  AddDiagonal_Private(left[1], 0, 2, 1);
  AddDiagonal_Private(right[1], 1, other, i == 0 ? -1 : 1);
  for (int a = 0; a < 12; a++)
    for (int b = 0; b < 12; b++) W[a * num + b] -= T / f->normal3 * (left[0][a] * right[0][b] + left[1][a] * right[1][b] - f->sigma[i][a] * dN3[b]);
}

void ContactTiltHessian(const FacetFrame *f, PetscInt num, const PetscReal X[], const PetscReal gradient[], PetscReal W[], PetscReal work[])
{
  PetscReal T[2] = {0, 0}, twice[2][2];

  for (int i = 0; i < 2; i++) { /* work_i = S p_i, S = W + W^T */
    PetscReal *to = work + i * num;

    for (PetscInt a = 0; a < num; a++) {
      to[a] = 0;
      for (PetscInt n = 0; n < num; n += 3) to[a] += (W[a * num + n + i] + W[(n + i) * num + a]) * X[n + 2];
    }
    for (PetscInt n = 0; n < num; n += 3) T[i] += gradient[n + i] * X[n + 2];
  }
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      twice[i][j] = 0;
      for (PetscInt n = 0; n < num; n += 3) twice[i][j] += X[n + 2] * work[j * num + n + i];
    }
  for (int i = 0; i < 2; i++) {
    for (PetscInt n = 0; n < num; n += 3) work[i * num + n + 2] += gradient[n + i]; /* d2Y = -2 ds dX_3 */
    for (int a = 0; a < 12; a++) {
      for (PetscInt b = 0; b < num; b++) W[a * num + b] -= f->sigma[i][a] * work[i * num + b];
      for (int j = 0; j < 2; j++)
        for (int b = 0; b < 12; b++) W[a * num + b] += 0.5 * twice[i][j] * f->sigma[i][a] * f->sigma[j][b];
    }
    TiltCurvature_Private(f, i, T[i], num, W);
  }
}
