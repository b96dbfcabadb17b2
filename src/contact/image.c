/* Image of a mortar vertex v on a facet: xi with x(xi) + s d(xi) = v, and its place Y(xi) in the chart. Vertices far beyond a bilinear facet may have none:
   there the map folds where opposite sides meet. So beyond [-1, 1]^2 the mixed terms of x, d and Y are those of h(xi_1) h(xi_2), h bounded and twice
   continuous: on flat facets Y is linear in x everywhere.

   A (dxi, ds) = dv - sum N_a dx_a - s sum V_v dd_v,   A = [t_i + s d,i, d] (plane: and e_z);
   A (d2xi, d2s) = -2 (dt_i + s dd,i + ds d,i) dxi_i - 2 ds dd - (x,ij + s d,ij) dxi_i dxi_j: half of w . d2Y is three products. */
#include "rayimpl.h"

typedef struct {
  RayFunctions S, V;
  PetscReal    p[3], d[3], A[2][3], d12[3], di[2][3];
  PetscReal    inverse[3][3]; /* rows: dxi_1, dxi_2, ds */
  PetscReal    det;
} Place;

/* h = xi in [-1, 1], at most 1.5; with two derivatives. */
static void Bound_Private(PetscReal xi, PetscReal h[3])
{
  const PetscReal sign = xi < 0 ? -1 : 1, v = 2 * PetscMax(0, PetscAbsReal(xi) - 1), root = 1 / PetscSqrtReal(1 + v * v);

  h[0] = v > 0 ? sign * (1 + 0.5 * v * root) : xi;
  h[1] = root * root * root;
  h[2] = -6 * sign * v * h[1] * root * root;
}

/* Slope of the functions in direction i that takes over beyond the facet: that between the corners. */
static void Slope_Private(PetscInt order, PetscReal slope[2][RAY_LATTICE])
{
  const PetscInt num = (order + 1) * (order + 1), corner[4] = {0, order, num - 1 - order, num - 1};

  memset(slope[0], 0, (size_t)num * sizeof(PetscReal));
  memset(slope[1], 0, (size_t)num * sizeof(PetscReal));
  for (int k = 0; k < 4; k++) {
    slope[0][corner[k]] = k % 2 ? 0.25 : -0.25;
    slope[1][corner[k]] = k / 2 ? 0.25 : -0.25;
  }
}

/* f(h) + sum_i (xi_i - h_i) slope_i */
void ContactRayBeyond(PetscInt m, PetscInt order, const PetscReal xi[2], int depth, RayFunctions *to)
{
  const PetscInt num = (order + 1) * (order + 1);
  PetscReal      h[2][3], slope[2][RAY_LATTICE], at[2];

  if (m == 1 || PetscMax(PetscAbsReal(xi[0]), PetscAbsReal(xi[1])) <= 1) {
    ContactRayFunctions(m, order, xi, depth, to);
    return;
  }
  for (int i = 0; i < 2; i++) {
    Bound_Private(xi[i], h[i]);
    at[i] = h[i][0];
  }
  Slope_Private(order, slope);
  ContactRayFunctions(2, order, at, depth, to);
  for (PetscInt a = 0; a < num; a++) {
    for (int i = 0; i < 2; i++) to->N[a] += (xi[i] - at[i]) * slope[i][a];
    for (int i = 0; i < 2 && depth > 1; i++) to->dd[2 * i][a] = to->dd[2 * i][a] * PetscSqr(h[i][1]) + (to->d[i][a] - slope[i][a]) * h[i][2];
    if (depth > 1) to->dd[1][a] *= h[0][1] * h[1][1];
    for (int i = 0; i < 2; i++) to->d[i][a] = slope[i][a] + (to->d[i][a] - slope[i][a]) * h[i][1];
  }
}

/* Y with derivatives 1 2, 11 12 22. */
typedef struct {
  PetscReal Y[2], d[2][2], dd[3][2];
} Picture;

static void Picture_Private(const RayFacet *f, const PetscReal xi[2], Picture *p)
{
  PetscReal     h[2][3];
  RayChartPoint c;

  memset(p, 0, sizeof(*p));
  if (f->m == 1) {
    ContactChartAt(f, xi, &c);
    memcpy(p->Y, c.Y, sizeof(p->Y));
    memcpy(p->d, c.J, sizeof(p->d));
    memcpy(p->dd[1], c.mixed, sizeof(p->dd[1]));
    return;
  }
  Bound_Private(xi[0], h[0]);
  Bound_Private(xi[1], h[1]);
  for (int i = 0; i < 2; i++) {
    p->Y[i]    = f->c[0][i] + f->c[1][i] * xi[0] + f->c[2][i] * xi[1] + f->c[3][i] * h[0][0] * h[1][0];
    p->d[0][i] = f->c[1][i] + f->c[3][i] * h[0][1] * h[1][0];
    p->d[1][i] = f->c[2][i] + f->c[3][i] * h[0][0] * h[1][1];
    for (int k = 0; k < 3; k++) p->dd[k][i] = f->c[3][i] * h[0][2 - k] * h[1][k];
  }
}

static void Place_Private(const RayFacet *f, const PetscReal xi[2], PetscReal s, int depth, Place *p)
{
  ContactRayBeyond(f->m, f->s.order, xi, depth, &p->S);
  ContactRayBeyond(f->m, 1, xi, depth, &p->V);
  ContactRayLatticeSum(&f->s, p->S.N, p->p);
  ContactRayLatticeSum(&f->d, p->V.N, p->d);
  for (PetscInt i = 0; i < 2; i++) {
    PetscReal t[3] = {0, 0, 1};

    p->di[i][0] = p->di[i][1] = p->di[i][2] = 0;
    if (i < f->m) {
      ContactRayLatticeSum(&f->s, p->S.d[i], t);
      ContactRayLatticeSum(&f->d, p->V.d[i], p->di[i]);
    }
    for (int c = 0; c < 3; c++) p->A[i][c] = t[c] + s * p->di[i][c];
  }
  Cross3(p->A[1], p->d, p->inverse[0]);
  Cross3(p->d, p->A[0], p->inverse[1]);
  Cross3(p->A[0], p->A[1], p->inverse[2]);
  p->det = Dot3(p->inverse[2], p->d);
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++) p->inverse[i][c] /= p->det;
}

void ContactImageFind(const RayFacet *f, RayImage *image)
{
  PetscReal step = 1;
  Place     p;

  image->found = PETSC_FALSE;
  image->xi[0] = image->xi[1] = image->s = 0;
  for (int k = 0; k < 30; k++) {
    PetscReal r[3];

    Place_Private(f, image->xi, image->s, 1, &p);
    if (!(p.det > 0)) return; /* beyond the point where rays cross */
    for (int c = 0; c < 3; c++) r[c] = image->v[c] - p.p[c] - image->s * p.d[c];
    if (k == 0) { /* first along the ray: rays turn with distance */
      image->s = Dot3(r, p.d) / Dot3(p.d, p.d);
      continue;
    }
    step = 0;
    for (PetscInt i = 0; i < f->m; i++) {
      const PetscReal dx = Dot3(p.inverse[i], r);

      image->xi[i] += dx;
      step = PetscMax(step, PetscAbsReal(dx));
    }
    image->s += Dot3(p.inverse[2], r);
    if (!(step < 1e3)) return;
    if (step < RAY_SOLVED) break;
  }
  if (step < RAY_SOLVED) {
    Picture c;

    Picture_Private(f, image->xi, &c);
    image->Y[0] = c.Y[0], image->Y[1] = f->m == 2 ? c.Y[1] : 0;
    image->found = PETSC_TRUE;
  }
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
  Picture_Private(f, image->xi, &chart);
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
  Picture_Private(f, image->xi, &chart);
  for (PetscInt i = 0; i < f->m; i++)
    for (int c = 0; c < 3; c++) mu[c] += Dot2(w, chart.d[i]) * p.inverse[i][c];
  for (PetscInt i = 0; i < 4 * n; i++) work[i] = 0;
  for (int i = 0; i < 3; i++) Motion_Private(f, &p, image->s, vertex, p.inverse[i], left[i]);
  for (PetscInt i = 0; i < f->m; i++) { /* left dxi_i: -mu . (dt_i + s dd,i + ds d,i) + sum_j G_ij dxi_j / 2 */
    const PetscReal along = -Dot3(mu, p.di[i]);

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
