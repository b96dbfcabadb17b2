/* Bilinear quadrilaterals in a plane, corners counterclockwise: Y(xi) = c_0 + c_1 xi_1 + c_2 xi_2 + c_3 xi_1 xi_2. */
#include "kernelimpl.h"

void ContactBilinear(const PetscReal Y[][2], PetscReal c[][2])
{
  for (int i = 0; i < 2; i++) {
    const PetscReal a = Y[0][i], b = Y[1][i], d = Y[2][i], e = Y[3][i];

    c[0][i] = 0.25 * (a + b + d + e);
    c[1][i] = 0.25 * (b + d - a - e);
    c[2][i] = 0.25 * (d + e - a - b);
    c[3][i] = 0.25 * (a + d - b - e);
  }
}

/* Newton's method: quadratic, and exact after one step on a parallelogram. */
PetscBool ContactBilinearLocate(const PetscReal c[4][2], const PetscReal Y[2], PetscReal xi[2])
{
  for (int k = 0; k < 20; k++) {
    PetscReal J1[2], J2[2], r[2], d[2], det;

    for (int i = 0; i < 2; i++) {
      J1[i] = c[1][i] + c[3][i] * xi[1], J2[i] = c[2][i] + c[3][i] * xi[0];
      r[i] = Y[i] - c[0][i] - c[1][i] * xi[0] - J2[i] * xi[1];
    }
    det = Cross2(J1, J2);
    if (!(PetscAbsReal(det) > 0)) return PETSC_FALSE;
    d[0] = Cross2(r, J2) / det, d[1] = Cross2(J1, r) / det;
    xi[0] += d[0], xi[1] += d[1];
    if (PetscMax(PetscAbsReal(d[0]), PetscAbsReal(d[1])) < CONTACT_ROUND)
      return PetscMax(PetscAbsReal(xi[0]), PetscAbsReal(xi[1])) < FACET_OUTSIDE ? PETSC_TRUE : PETSC_FALSE;
  }
  return PETSC_FALSE;
}

/* Strictly convex and counterclockwise, with corners that are not flat. */
PetscBool ContactQuadIsConvex(const PlaneQuad *s)
{
  for (int a = 0; a < 4; a++) {
    const PetscReal *x = s->Y[a], *y = s->Y[(a + 1) % 4], *z = s->Y[(a + 2) % 4], d[2] = {y[0] - x[0], y[1] - x[1]}, e[2] = {z[0] - y[0], z[1] - y[1]};

    if (!(Cross2(d, e) > ROUND_LENGTH * PetscSqrtReal(Dot2(d, d) * Dot2(e, e)))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
