/* Bilinear quadrilaterals seen in a plane: hats at a point Y(xi) = sum_a N_a(xi) Y_a. */
#include "kernelimpl.h"

static const PetscReal Corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

/* Newton's method: quadratic, and exact after one step on a parallelogram. */
PetscBool ContactQuadLocate(const PlaneQuad *s, const PetscReal Y[2], PetscReal N[4])
{
  PetscReal c[4][2]; /* Y(xi) = c_0 + c_1 xi_1 + c_2 xi_2 + c_3 xi_1 xi_2 */
  PetscReal xi[2] = {0, 0}, step = 1;

  for (int i = 0; i < 2; i++) {
    const PetscReal a = s->Y[0][i], b = s->Y[1][i], d = s->Y[2][i], e = s->Y[3][i];

    c[0][i] = 0.25 * (a + b + d + e) - Y[i];
    c[1][i] = 0.25 * (b + d - a - e);
    c[2][i] = 0.25 * (d + e - a - b);
    c[3][i] = 0.25 * (a + d - b - e);
  }
  for (int k = 0; k < 20 && step >= 1e-9; k++) {
    const PetscReal J1[2] = {c[1][0] + c[3][0] * xi[1], c[1][1] + c[3][1] * xi[1]}, J2[2] = {c[2][0] + c[3][0] * xi[0], c[2][1] + c[3][1] * xi[0]};
    const PetscReal det = Cross2(J1, J2);
    PetscReal       r[2], d[2];

    if (!(PetscAbsReal(det) > 0)) return PETSC_FALSE;
    for (int i = 0; i < 2; i++) r[i] = c[0][i] + c[1][i] * xi[0] + c[2][i] * xi[1] + c[3][i] * xi[0] * xi[1];
    d[0] = Cross2(r, J2) / det;
    d[1] = Cross2(J1, r) / det;
    for (int i = 0; i < 2; i++) xi[i] -= d[i];
    step = PetscMax(PetscAbsReal(d[0]), PetscAbsReal(d[1]));
  }
  if (!(step < 1e-9) || !(PetscMax(PetscAbsReal(xi[0]), PetscAbsReal(xi[1])) < FACET_OUTSIDE)) return PETSC_FALSE;
  for (int a = 0; a < 4; a++) N[a] = 0.25 * (1 + Corner[a][0] * xi[0]) * (1 + Corner[a][1] * xi[1]);
  return PETSC_TRUE;
}

/* Strictly convex and counterclockwise, with corners that are no flatter than 1e-6. */
PetscBool ContactQuadIsConvex(const PlaneQuad *s)
{
  for (int a = 0; a < 4; a++) {
    const PetscReal *x = s->Y[a], *y = s->Y[(a + 1) % 4], *z = s->Y[(a + 2) % 4], d[2] = {y[0] - x[0], y[1] - x[1]}, e[2] = {z[0] - y[0], z[1] - y[1]};

    if (!(Cross2(d, e) > 1e-6 * PetscSqrtReal(Dot2(d, d) * Dot2(e, e)))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
