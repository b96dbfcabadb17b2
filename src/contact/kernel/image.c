/* Image of a mortar vertex v on a facet: xi with x(xi) + s d(xi) = v, and its place Y(xi) in the chart. Beyond the facet x, Y and d go on as in continuation.c:
   on flat facets Y is linear in x everywhere.

   A (dxi, ds) = dv - sum N_a dx_a - s sum V_v dd_v,   A = [t_i + s d,i, d] (plane: and e_z);
   A (d2xi, d2s) = -2 (dt_i + s dd,i + ds d,i) dxi_i - 2 ds dd - (x,ij + s d,ij) dxi_i dxi_j: half of w . d2Y is three products. */
#include "kernelimpl.h"

typedef struct {
  RayFunctions S, V; /* V: of directions */
  RayFrame     at;
  PetscReal    inverse[3][3]; /* rows: dxi_1, dxi_2, ds */
  PetscReal    det;
} Place;

/* Y with derivatives 1 2, 11 12 22, from the functions of order 1. */
typedef struct {
  PetscReal Y[2], d[2][2], dd[3][2];
} Picture;

static void Picture_Private(const RayFacet *f, const PetscReal xi[2], int depth, Picture *p)
{
  RayFunctions functions, *V = &functions;

  ContactRayBeyond(&f->beyond, f->m, 1, xi, depth, V);
  memset(p, 0, sizeof(*p));
  for (PetscInt a = 0; a < f->nv; a++)
    for (PetscInt i = 0; i < f->m; i++) {
      const PetscReal Y = f->chart.Y[a < 2 ? a : 5 - a][i];

      p->Y[i] += V->N[a] * Y;
      for (PetscInt k = 0; k < f->m; k++) p->d[k][i] += V->d[k][a] * Y;
      for (PetscInt k = 0; k < 2 * f->m - 1 && depth > 1; k++) p->dd[k][i] += V->dd[k][a] * Y;
    }
}

static void At_Private(const RayFacet *f, const PetscReal xi[2], int depth, RayFunctions *S, RayFunctions *V, RayFrame *at)
{
  static const PetscReal none[3] = {0, 0, 0}, ez[3] = {0, 0, 1};

  ContactRayBeyond(&f->beyond, f->m, f->s.order, xi, depth, S);
  ContactRayBeyond(NULL, f->m, 1, xi, depth, V);
  ContactRayLatticeSum(&f->s, S->N, at->p);
  ContactRayLatticeSum(&f->d, V->N, at->d);
  memcpy(at->t[1], ez, sizeof(ez));
  memcpy(at->di[1], none, sizeof(none));
  for (PetscInt i = 0; i < f->m; i++) {
    ContactRayLatticeSum(&f->s, S->d[i], at->t[i]);
    ContactRayLatticeSum(&f->d, V->d[i], at->di[i]);
  }
}

/* A^-1 at s; returns det A. */
static PetscReal Inverse_Private(const RayFrame *at, PetscReal s, PetscReal inverse[3][3])
{
  PetscReal A[2][3], det, over;

  for (int i = 0; i < 2; i++)
    for (int c = 0; c < 3; c++) A[i][c] = at->t[i][c] + s * at->di[i][c];
  Cross3(A[1], at->d, inverse[0]);
  Cross3(at->d, A[0], inverse[1]);
  Cross3(A[0], A[1], inverse[2]);
  det  = Dot3(inverse[2], at->d);
  over = 1 / det;
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++) inverse[i][c] *= over;
  return det;
}

static void Place_Private(const RayFacet *f, const PetscReal xi[2], PetscReal s, int depth, Place *p)
{
  At_Private(f, xi, depth, &p->S, &p->V, &p->at);
  p->det = Inverse_Private(&p->at, s, p->inverse);
}

void ContactImagesPrepare(RayFacet *f)
{
  const PetscReal middle[2] = {0, 0};
  RayFunctions    S, V;

  At_Private(f, middle, 1, &S, &V, &f->middle);
}

/* Newton's method from (0, 0); ahead: the first step is along the ray, which leads to what is near by, but may end beyond the point where rays cross. */
static PetscBool Find_Private(const RayFacet *f, PetscBool ahead, RayImage *image)
{
  RayFrame     at = f->middle;
  RayFunctions S, V;

  image->xi[0] = image->xi[1] = image->s = 0;
  for (int k = 0; k < 30; k++) {
    PetscReal r[3], inverse[3][3], step = 0, size = 1;

    if (!(Inverse_Private(&at, image->s, inverse) > 0)) return PETSC_FALSE; /* beyond the point where rays cross */
    for (int c = 0; c < 3; c++) r[c] = image->v[c] - at.p[c] - image->s * at.d[c];
    if (ahead && k == 0) {
      image->s = Dot3(r, at.d) / Dot3(at.d, at.d);
      continue;
    }
    for (PetscInt i = 0; i < f->m; i++) {
      const PetscReal dx = Dot3(inverse[i], r);

      image->xi[i] += dx;
      step = PetscMax(step, PetscAbsReal(dx));
      size = PetscMax(size, PetscAbsReal(image->xi[i]));
    }
    image->s += Dot3(inverse[2], r);
    if (!(size < RAY_FAR)) return PETSC_FALSE;
    if (step < CONTACT_ROUND * size) return PETSC_TRUE;
    At_Private(f, image->xi, 1, &S, &V, &at);
  }
  return PETSC_FALSE;
}

void ContactImageFind(const RayFacet *f, RayImage *image)
{
  Picture c;

  image->found = Find_Private(f, PETSC_TRUE, image);
  if (!image->found) image->found = Find_Private(f, PETSC_FALSE, image);
  if (!image->found) {
    image->xi[0] = image->xi[1] = image->s = 0;
    return;
  }
  Picture_Private(f, image->xi, 1, &c);
  image->Y[0] = c.Y[0], image->Y[1] = c.Y[1];
}

/* row += factor v . (dv - sum N_a dx_a - s sum V_v dd_v) */
static void Motion_Private(const RayFacet *f, const Place *p, PetscReal s, PetscInt vertex, const PetscReal v[3], PetscReal row[])
{
  const PetscInt D = f->D;

  for (PetscInt c = 0; c < D; c++) {
    for (PetscInt a = 0; a < f->s.num; a++) row[D * a + c] -= p->S.N[a] * v[c];
    for (PetscInt a = 0; a < f->nv; a++) row[D * (f->s.num + a) + c] -= s * p->V.N[a] * v[c];
    row[D * vertex + c] += v[c];
  }
}

void ContactImagesFold(RayWork w, PetscInt num, PetscReal rows[], PetscInt ld)
{
  const PetscInt m = w->facet.m, images = w->facet.D * (w->facet.s.num + w->facet.nv + w->num_mortar);

  for (PetscInt k = w->num_images - 1; k >= 0; k--) {
    if (w->image[k].parent[0] < 0) continue;
    for (int e = 0; e < 2; e++) {
      PetscInt at = 0;

      while (w->image[at].node != w->image[k].parent[e]) at++;
      for (PetscInt r = 0; r < num; r++)
        for (PetscInt i = 0; i < m; i++) rows[r * ld + images + m * at + i] += 0.5 * rows[r * ld + images + m * k + i];
    }
    for (PetscInt r = 0; r < num; r++)
      for (PetscInt i = 0; i < m; i++) rows[r * ld + images + m * k + i] = 0;
  }
}

void ContactImageRows(const RayFacet *f, const RayImage *image, PetscInt vertex, PetscInt n, PetscReal rows[])
{
  Picture chart;
  Place   p;

  Place_Private(f, image->xi, image->s, 1, &p);
  Picture_Private(f, image->xi, 1, &chart);
  for (PetscInt i = 0; i < f->m; i++) {
    PetscReal v[3] = {0, 0, 0};

    for (PetscInt j = 0; j < f->m; j++)
      for (int c = 0; c < 3; c++) v[c] += chart.d[j][i] * p.inverse[j][c];
    Motion_Private(f, &p, image->s, vertex, v, rows + i * n);
  }
}

void ContactImageCurvature(const RayFacet *f, const RayImage *image, PetscInt vertex, const PetscReal w[2], PetscInt n, PetscReal W[], PetscReal work[])
{
  const PetscInt D = f->D, na = f->s.num;
  PetscReal     *left[3] = {work, work + n, work + 2 * n}, *right = work + 3 * n, mu[3] = {0, 0, 0};
  Picture        chart;
  Place          p;

  Place_Private(f, image->xi, image->s, 2, &p);
  Picture_Private(f, image->xi, 2, &chart);
  for (PetscInt i = 0; i < f->m; i++)
    for (int c = 0; c < 3; c++) mu[c] += Dot2(w, chart.d[i]) * p.inverse[i][c];
  for (PetscInt i = 0; i < 4 * n; i++) work[i] = 0;
  for (int i = 0; i < 3; i++) Motion_Private(f, &p, image->s, vertex, p.inverse[i], left[i]);
  for (PetscInt i = 0; i < f->m; i++) { /* left dxi_i: -mu . (dt_i + s dd,i + ds d,i) + sum_j G_ij dxi_j / 2 */
    const PetscReal along = -Dot3(mu, p.at.di[i]);

    for (PetscInt k = 0; k < n; k++) right[k] = along * left[2][k];
    for (PetscInt c = 0; c < D; c++) {
      for (PetscInt a = 0; a < na; a++) right[D * a + c] -= mu[c] * p.S.d[i][a];
      for (PetscInt a = 0; a < f->nv; a++) right[D * (na + a) + c] -= mu[c] * image->s * p.V.d[i][a];
    }
    for (PetscInt j = 0; j < f->m; j++) {
      PetscReal x[3], d[3], G;

      ContactRayLatticeSum(&f->s, p.S.dd[i + j], x);
      ContactRayLatticeSum(&f->d, p.V.dd[i + j], d);
      G = Dot2(w, chart.dd[i + j]) - Dot3(mu, x) - image->s * Dot3(mu, d);
      for (PetscInt k = 0; k < n; k++) right[k] += 0.5 * G * left[j][k];
    }
    for (PetscInt a = 0; a < n; a++)
      if (left[i][a] != 0)
        for (PetscInt b = 0; b < n; b++) W[a * n + b] += left[i][a] * right[b];
  }
  for (PetscInt k = 0; k < n; k++) right[k] = 0; /* left ds: -mu . dd */
  for (PetscInt c = 0; c < D; c++)
    for (PetscInt a = 0; a < f->nv; a++) right[D * (na + a) + c] = -mu[c] * p.V.N[a];
  for (PetscInt a = 0; a < n; a++)
    if (left[2][a] != 0)
      for (PetscInt b = 0; b < n; b++) W[a * n + b] += left[2][a] * right[b];
}
