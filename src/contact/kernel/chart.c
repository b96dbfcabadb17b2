/* The plane picture of a facet over which one integrates: corners of its reference shape seen along its vector area, so that straight facets of a flat surface,
   however distorted, are seen without distortion. Constant. In the plane: the square [-1, 1]^2, of which only the first coordinate is used. */
#include "kernelimpl.h"

static const PetscReal Square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

/* Y(xi) = c_0 + c_1 xi_1 + c_2 xi_2 + c_3 xi_1 xi_2 */
static void Polynomial_Private(RayFacet *f)
{
  for (int i = 0; i < 2; i++) {
    const PetscReal a = f->chart.Y[0][i], b = f->chart.Y[1][i], d = f->chart.Y[2][i], e = f->chart.Y[3][i];

    f->c[0][i] = 0.25 * (a + b + d + e);
    f->c[1][i] = 0.25 * (b + d - a - e);
    f->c[2][i] = 0.25 * (d + e - a - b);
    f->c[3][i] = 0.25 * (a + d - b - e);
  }
}

/* Corners along the first diagonal and across it, origin in their middle. False: the facet has no area, or is not convex. */
static PetscBool Corners_Private(const PetscReal x[4][3], RayFacet *f)
{
  PetscReal d[3], e[3], E[2][3], N[3], length, normal;

  for (int i = 0; i < 3; i++) {
    d[i] = x[2][i] - x[0][i];
    e[i] = x[3][i] - x[1][i];
  }
  Cross3(d, e, N);
  length = PetscSqrtReal(Dot3(d, d));
  normal = PetscSqrtReal(Dot3(N, N));
  if (!(normal > 0)) return PETSC_FALSE;
  for (int i = 0; i < 3; i++) {
    E[0][i] = d[i] / length;
    N[i] /= normal;
  }
  Cross3(N, E[0], E[1]);
  f->area = 0.5 * normal;
  for (int a = 0; a < 4; a++) {
    PetscReal r[3];

    for (int i = 0; i < 3; i++) r[i] = x[a][i] - 0.25 * (x[0][i] + x[1][i] + x[2][i] + x[3][i]);
    for (int i = 0; i < 2; i++) f->chart.Y[a][i] = Dot3(E[i], r);
  }
  return ContactQuadIsConvex(&f->chart);
}

PetscBool ContactChartCreate(const ContactSurface *s, PetscInt facet, RayFacet *f)
{
  PetscReal x[4][3];

  for (int a = 0; a < 4; a++) {
    f->chart.h[a]    = 0;
    f->chart.Y[a][0] = Square[a][0], f->chart.Y[a][1] = Square[a][1];
  }
  f->area = 4;
  if (s->dim == 2) {
    Polynomial_Private(f);
    return PETSC_TRUE;
  }
  for (int a = 0; a < 4; a++)
    for (int c = 0; c < 3; c++) x[a][c] = s->X[3 * s->facets[4 * facet + a] + c];
  if (!Corners_Private(x, f)) return PETSC_FALSE;
  Polynomial_Private(f);
  return PETSC_TRUE;
}

void ContactChartAt(const RayFacet *f, const PetscReal xi[2], RayChartPoint *p)
{
  const PetscReal(*c)[2] = f->c;

  for (int i = 0; i < 2; i++) {
    p->J[0][i]  = c[1][i] + c[3][i] * xi[1];
    p->J[1][i]  = c[2][i] + c[3][i] * xi[0];
    p->Y[i]     = c[0][i] + c[1][i] * xi[0] + c[2][i] * xi[1] + c[3][i] * xi[0] * xi[1];
    p->mixed[i] = c[3][i];
  }
  p->det           = Cross2(p->J[0], p->J[1]);
  p->ddet[0]       = Cross2(c[1], c[3]);
  p->ddet[1]       = Cross2(c[3], c[2]);
  p->inverse[0][0] = p->J[1][1] / p->det, p->inverse[0][1] = -p->J[1][0] / p->det;
  p->inverse[1][0] = -p->J[0][1] / p->det, p->inverse[1][1] = p->J[0][0] / p->det;
}

PetscBool ContactChartLocate(const RayFacet *f, const PetscReal Y[2], PetscReal xi[2])
{
  const PetscReal(*c)[2] = f->c;

  if (f->m == 1) {
    xi[0] = Y[0], xi[1] = 0;
    return PETSC_TRUE;
  }
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
    if (PetscMax(PetscAbsReal(d[0]), PetscAbsReal(d[1])) < RAY_SOLVED)
      return PetscMax(PetscAbsReal(xi[0]), PetscAbsReal(xi[1])) < FACET_OUTSIDE ? PETSC_TRUE : PETSC_FALSE;
  }
  return PETSC_FALSE;
}
