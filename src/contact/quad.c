/* Bilinear quadrilaterals seen in a plane: hats and the inverse of Y(xi) = sum_a N_a(xi) Y_a. */
#include "facetimpl.h"

static const PetscReal Corner[4][2]    = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
const PetscReal        ContactMixed[4] = {0.25, -0.25, 0.25, -0.25};

static void Hats_Private(const PetscReal xi[2], PetscReal N[4])
{
  for (int a = 0; a < 4; a++) N[a] = 0.25 * (1 + Corner[a][0] * xi[0]) * (1 + Corner[a][1] * xi[1]);
}

/* Newton's method: quadratic, and exact after one step on a parallelogram. */
PetscBool ContactQuadLocate(const PlaneQuad *s, const PetscReal Y[2], PlanePoint *p)
{
  PetscReal c[4][2]; /* Y(xi) = c_0 + c_1 xi_1 + c_2 xi_2 + c_3 xi_1 xi_2 */
  PetscReal step = 1;

  for (int i = 0; i < 2; i++) {
    const PetscReal a = s->Y[0][i], b = s->Y[1][i], d = s->Y[2][i], e = s->Y[3][i];

    c[0][i] = 0.25 * (a + b + d + e) - Y[i];
    c[1][i] = 0.25 * (b + d - a - e);
    c[2][i] = 0.25 * (d + e - a - b);
    c[3][i] = 0.25 * (a + d - b - e);
  }
  p->xi[0] = p->xi[1] = 0;
  for (int k = 0; k < 20; k++) {
    const PetscReal J1[2] = {c[1][0] + c[3][0] * p->xi[1], c[1][1] + c[3][1] * p->xi[1]}, J2[2] = {c[2][0] + c[3][0] * p->xi[0], c[2][1] + c[3][1] * p->xi[0]};
    const PetscReal det = Cross2(J1, J2);
    PetscReal       r[2], d[2];

    if (!(PetscAbsReal(det) > 0)) return PETSC_FALSE;
    p->inverse[0][0] = J2[1] / det, p->inverse[0][1] = -J2[0] / det;
    p->inverse[1][0] = -J1[1] / det, p->inverse[1][1] = J1[0] / det;
    if (step < 1e-9) break; /* the last step left a square of that: the inverse now belongs to the final xi */
    for (int i = 0; i < 2; i++) r[i] = c[0][i] + c[1][i] * p->xi[0] + c[2][i] * p->xi[1] + c[3][i] * p->xi[0] * p->xi[1];
    for (int i = 0; i < 2; i++) d[i] = p->inverse[i][0] * r[0] + p->inverse[i][1] * r[1];
    for (int i = 0; i < 2; i++) p->xi[i] -= d[i];
    step = PetscMax(PetscAbsReal(d[0]), PetscAbsReal(d[1]));
  }
  if (!(step < 1e-9) || !(PetscMax(PetscAbsReal(p->xi[0]), PetscAbsReal(p->xi[1])) < FACET_OUTSIDE)) return PETSC_FALSE;
  for (int i = 0; i < 2; i++) p->mixed[i] = c[3][i];
  Hats_Private(p->xi, p->N);
  for (int a = 0; a < 4; a++) {
    p->d[0][a] = 0.25 * Corner[a][0] * (1 + Corner[a][1] * p->xi[1]);
    p->d[1][a] = 0.25 * Corner[a][1] * (1 + Corner[a][0] * p->xi[0]);
  }
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
