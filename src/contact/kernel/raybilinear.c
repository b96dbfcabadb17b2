/* A ray between bilinear facets in space, as in ray.c with all functions written out: x = c_0 + c_1 xi_1 + c_2 xi_2 + c_3 xi_1 xi_2 for positions,
   directions and mortar positions. Two vectors normal to the ray leave two bilinear equations for eta. */
#include "kernelimpl.h"

static const PetscReal Mixed[4] = {0.25, -0.25, -0.25, 0.25};

static inline void Hats_Private(const PetscReal xi[2], int depth, RayFunctions *f)
{
  const PetscReal a = 0.25 * (1 - xi[0]), b = 0.25 * (1 + xi[0]), c = 1 - xi[1], d = 1 + xi[1];

  f->N[0] = a * c, f->N[1] = b * c, f->N[2] = a * d, f->N[3] = b * d;
  f->d[0][0] = -0.25 * c, f->d[0][1] = 0.25 * c, f->d[0][2] = -0.25 * d, f->d[0][3] = 0.25 * d;
  f->d[1][0] = -a, f->d[1][1] = -b, f->d[1][2] = a, f->d[1][3] = b;
  for (int k = 0; k < 4 && depth > 1; k++) f->dd[0][k] = f->dd[2][k] = 0, f->dd[1][k] = Mixed[k];
}

static inline void At_Private(const RayLattice *l, const PetscReal xi[2], PetscReal x[3], PetscReal d1[3], PetscReal d2[3])
{
  for (int i = 0; i < 3; i++) {
    d1[i] = l->c[1][i] + l->c[3][i] * xi[1];
    d2[i] = l->c[2][i] + l->c[3][i] * xi[0];
    x[i]  = l->c[0][i] + l->c[1][i] * xi[0] + d2[i] * xi[1];
  }
}

static void Facet_Private(const RayFacet *f, int depth, RayPoint *r)
{
  Hats_Private(r->xi, depth, &r->S);
  memcpy(r->V.N, r->S.N, 4 * sizeof(PetscReal));
  for (int k = 0; k < 2; k++) memcpy(r->V.d[k], r->S.d[k], 4 * sizeof(PetscReal));
  ContactChartAt(f, r->xi, &r->chart);
  At_Private(&f->s, r->xi, r->p, r->t[0], r->t[1]);
  At_Private(&f->d, r->xi, r->d, r->di[0], r->di[1]);
  if (depth > 1) {
    memset(r->tt, 0, sizeof(r->tt));
    memset(r->ttt, 0, sizeof(r->ttt));
    memcpy(r->tt[1], f->s.c[3], sizeof(r->tt[1]));
    memcpy(r->dij, f->d.c[3], sizeof(r->dij));
  }
  ContactRayDensities(f, r);
}

/* eta where the ray meets the mortar facet. */
static PetscBool Meet_Private(const RayLattice *mortar, RayPoint *r)
{
  PetscReal u[3], v[3], a[4][2], from[3];

  Cross3(r->d, r->t[0], u);
  Cross3(r->d, u, v);
  for (int c = 0; c < 3; c++) from[c] = mortar->c[0][c] - r->p[c];
  for (int k = 0; k < 4; k++) {
    const PetscReal *c = k ? mortar->c[k] : from;

    a[k][0] = Dot3(u, c), a[k][1] = Dot3(v, c);
  }
  for (int k = 0; k < 20; k++) {
    PetscReal J1[2], J2[2], F[2], step[2], over, size;

    for (int i = 0; i < 2; i++) {
      J1[i] = a[1][i] + a[3][i] * r->eta[1], J2[i] = a[2][i] + a[3][i] * r->eta[0];
      F[i] = a[0][i] + a[1][i] * r->eta[0] + J2[i] * r->eta[1];
    }
    over    = 1 / Cross2(J1, J2);
    step[0] = Cross2(F, J2) * over, step[1] = Cross2(J1, F) * over;
    r->eta[0] -= step[0], r->eta[1] -= step[1];
    size = PetscMax(PetscAbsReal(step[0]), PetscAbsReal(step[1]));
    if (!(size < 10)) return PETSC_FALSE;
    if (size < CONTACT_ROUND) return PetscMax(PetscAbsReal(r->eta[0]), PetscAbsReal(r->eta[1])) < FACET_OUTSIDE ? PETSC_TRUE : PETSC_FALSE;
  }
  return PETSC_FALSE;
}

/* From r->eta as a first guess, unless it is known. */
PetscBool ContactRayBilinear(const RayFacet *f, const RayLattice *mortar, const PetscReal xi[2], PetscBool known, int depth, RayPoint *r)
{
  PetscReal square = 0, along = 0;

  r->xi[0] = xi[0], r->xi[1] = xi[1];
  Facet_Private(f, depth, r);
  if (!known && !Meet_Private(mortar, r)) return PETSC_FALSE;
  Hats_Private(r->eta, 1, &r->M);
  At_Private(mortar, r->eta, r->X, r->Xi[0], r->Xi[1]);
  if (depth > 1) {
    memset(r->Xij, 0, sizeof(r->Xij));
    memcpy(r->Xij[1], mortar->c[3], sizeof(r->Xij[1]));
  }
  for (int c = 0; c < 3; c++) {
    square += r->d[c] * r->d[c];
    along += r->d[c] * (r->X[c] - r->p[c]);
  }
  r->s = along / square;
  ContactRayOpen(f, r);
  return ContactRayInverse(r);
}
