/* The plane picture of a facet over which one integrates: corners of its reference shape seen along its vector area, so that straight facets of a flat surface,
   however distorted, are seen without distortion. Constant. In the plane: the square [-1, 1]^2, of which only the first coordinate is used. */
#include "kernelimpl.h"

static const PetscReal Square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

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
  for (int a = 0; a < 4 && s->dim == 3; a++)
    for (int c = 0; c < 3; c++) x[a][c] = s->X[3 * s->facets[4 * facet + a] + c];
  if (s->dim == 3 && !Corners_Private(x, f)) return PETSC_FALSE;
  ContactBilinear(f->chart.Y, f->c);
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
  if (f->m == 2) return ContactBilinearLocate(f->c, Y, xi);
  xi[0] = Y[0], xi[1] = 0;
  return PETSC_TRUE;
}
