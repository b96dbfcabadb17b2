/* Second derivatives of phi g at a point, g = o b rho, o = s - closed / |d|, b = d.n, rho = 1 or 2 pi r, phi a function of xi.

   With r = P + s V - M (ray.c) half of d2g at fixed xi is
     b rho (ds kappa.V - deta_i kappa.M,i - deta_i deta_j kappa.x_m,ij / 2) + o rho (V.dn + d.(T_1 x T_2)) + rho ds db + (b ds + o db) drho.
   and where a length is closed, o changes with d, too: d o = ds + k d.V, k = closed / |d|^3, whose second derivative adds
     k (b rho (V.V - 3 (d.V)^2 / d.d) / 2 + d.V (rho db + b drho)); along the facet, o,i has - closed,i / |d| besides.
   Products with few left factors: ds, deta_i, drho; V.dn and T_1 x T_2 couple nodes by one vector for each pair. Derivatives by xi follow with P -> P + t_i
   dxi_i and so on: mixed[i] are full rows, xixi full. */
#include "kernelimpl.h"

static inline void Axpy3_Private(PetscReal a, const PetscReal x[3], PetscReal y[3])
{
  for (int c = 0; c < 3; c++) y[c] += a * x[c];
}
static inline void AddCross_Private(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  for (int i = 0; i < 3; i++) c[i] += a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Dimensions of space and facet, functions of the three groups of numbers in a row. */
typedef struct {
  PetscInt D, m, na, nv, nb;
} Layout;

/* w: dn . h = T_1 . w_1 + T_2 . w_2 */
static inline void Normal_Private(const RayPoint *r, const PetscReal h[3], PetscReal w[2][3])
{
  Cross3(r->t[1], h, w[0]);
  Cross3(h, r->t[0], w[1]);
}

static inline void Scale_Private(PetscReal a, const PetscReal x[3], PetscReal y[3])
{
  for (int c = 0; c < 3; c++) y[c] = a * x[c];
}

/* Products of the residual's components, r_c = sum_f basis_f (number f, c), with rows: from ds, kappa_c (V.dn + d.(T_1 x T_2) + db drho ..), from deta the
   second derivatives of the mortar facet, Q, and its turn. */
INLINE void Products_Private(const Layout *l, const RayPoint *r, PetscReal phi, PetscReal weight, RaySecond *o)
{
  const PetscInt  D       = l->D;
  const PetscReal br      = phi * r->beta * r->rho;
  PetscReal       Q[3][3] = {{0}}, v[3], w[2][3], h[3];

  for (PetscInt a = 0; a < l->na; a++) o->basis[a] = weight * r->S.N[a];
  for (PetscInt a = 0; a < l->nv; a++) o->basis[l->na + a] = weight * r->s * r->V.N[a];
  for (PetscInt a = 0; a < l->nb; a++) o->basis[l->na + l->nv + a] = -weight * r->M.N[a];
  for (PetscInt i = 0; i < l->m; i++)
    for (PetscInt j = 0; j < l->m; j++) {
      const PetscReal x = -0.5 * br * Dot3(r->kappa, r->Xij[i + j]);

      for (PetscInt c = 0; c < D; c++) Axpy3_Private(x * r->zeta[i][c], r->zeta[j], Q[c]);
    }
  Scale_Private(phi * r->rho, r->d, v);
  Normal_Private(r, v, w);
  for (PetscInt c = 0; c < D; c++) {
    PetscReal *own = o->right[c], *across = own + D * l->na, *mortar = across + D * l->nv, slope[2][3];

    Scale_Private(1, Q[c], h);
    h[0] += r->kappa[c] * phi * r->beta * r->turn;
    for (int k = 0; k < 2; k++) Scale_Private(r->kappa[c], w[k], slope[k]);
    ContactRaySlopes(D, l->m, l->na, r->S.N, h, r->S.d, slope, own);
    for (int e = 0; e < 3; e++) h[e] = r->s * Q[c][e] + r->kappa[c] * (br * r->kappa[e] + phi * r->rho * r->n[e]);
    ContactRaySet(D, l->nv, r->V.N, h, across);
    Scale_Private(-1, Q[c], h);
    for (int k = 0; k < 2; k++) Scale_Private(-br * r->zeta[k][c], r->kappa, slope[k]);
    ContactRaySlopes(D, l->m, l->nb, r->M.N, h, r->M.d, slope, mortar);
  }
}

/* The next product of numbers of the facet and its directions. */
INLINE PetscReal *Row_Private(const Layout *l, RaySecond *o, PetscReal **right)
{
  const PetscInt no   = l->D * (l->na + l->nv);
  PetscReal     *left = o->own_left + no * o->num_own;

  *right = o->own_right + no * o->num_own++;
  for (PetscInt i = 0; i < no; i++) left[i] = (*right)[i] = 0;
  return left;
}

/* What is closed: d.V k (rho db + b drho - 3 b rho d.V / (2 d.d)) and k b rho V.V / 2. */
INLINE void Closed_Private(const Layout *l, const RayPoint *r, PetscReal phi, PetscReal weight, RaySecond *o)
{
  const PetscInt  D = l->D, own = D * l->na;
  const PetscReal k = phi * r->dopen, br = r->beta * r->rho, along = 3 * br / (2 * Dot3(r->d, r->d));
  PetscReal       v[3], h[3] = {k * r->beta * r->turn, 0, 0}, w[2][3], *right, *left = Row_Private(l, o, &right);

  Scale_Private(weight, r->d, v);
  ContactRaySet(D, l->nv, r->V.N, v, left + own);
  Scale_Private(k * r->rho, r->d, v);
  Normal_Private(r, v, w);
  ContactRaySlopes(D, l->m, l->na, r->S.N, h, r->S.d, w, right);
  for (int c = 0; c < 3; c++) v[c] = k * (r->rho * r->n[c] - along * r->d[c]);
  ContactRaySet(D, l->nv, r->V.N, v, right + own);
  for (PetscInt c = 0; c < D; c++) {
    left = Row_Private(l, o, &right);
    for (int e = 0; e < 3; e++) v[e] = e == c ? weight : 0, h[e] = e == c ? 0.5 * k * br : 0;
    ContactRaySet(D, l->nv, r->V.N, v, left + own);
    ContactRaySet(D, l->nv, r->V.N, h, right + own);
  }
}

/* Products of numbers of the facet and its directions: drho, and what is closed. */
INLINE void Own_Private(const Layout *l, const RayPoint *r, PetscReal phi, PetscReal weight, RaySecond *o)
{
  static const PetscReal none[3] = {0, 0, 0};
  const PetscInt         D       = l->D;
  PetscReal              v[3], w[2][3], *right;

  o->num_own = 0;
  if (r->turn != 0) {
    PetscReal *left = Row_Private(l, o, &right);

    v[0] = weight * r->turn, v[1] = v[2] = 0;
    ContactRaySet(D, l->na, r->S.N, v, left);
    Scale_Private(phi * r->open, r->d, v);
    Normal_Private(r, v, w);
    ContactRaySlopes(D, l->m, l->na, r->S.N, none, r->S.d, w, right);
    Scale_Private(phi * r->open, r->n, v);
    ContactRaySet(D, l->nv, r->V.N, v, right + D * l->na);
  }
  if (r->closes) Closed_Private(l, r, phi, weight, o);
}

/* Pairs of nodes. */
INLINE void Pairs_Private(const Layout *l, const RayPoint *r, PetscReal phi, PetscReal weight, RaySecond *o)
{
  const PetscReal factor = weight * phi * r->open * r->rho;
  PetscReal       k[3], u[2][3];

  for (int c = 0; c < 3; c++) {
    k[c]    = factor * r->d[c];
    u[0][c] = factor * r->t[1][c];
    u[1][c] = -factor * r->t[0][c];
  }
  for (PetscInt v = 0; v < l->nv; v++) o->turn_left[v] = r->V.N[v];
  ContactRaySet(3, l->na, r->S.d[0], u[0], o->turn_right);
  if (l->m == 1) return;
  ContactRayAdd(3, l->na, r->S.d[1], u[1], o->turn_right);
  for (PetscInt a = 0; a < l->na; a++) o->twist_left[a] = r->S.d[0][a];
  ContactRaySet(3, l->na, r->S.d[1], k, o->twist_right);
}

INLINE void Second_Private(const Layout *l, const RayPoint *r, const RayWeight *phi, PetscReal weight, RaySecond *o)
{
  const PetscInt  m = l->m, D = l->D, na = l->na, nv = l->nv, nb = l->nb;
  const PetscReal br = r->beta * r->rho, sr = r->open * r->rho, gap = ContactRayGap(r);
  PetscReal       Ag[3], Cg[3], k[3], A[3], B[2][3], C[3], E[3];
  PetscReal       sigma[2], openi[2], etai[2][2], betai[2], rhoi[2], ni[2][3], gi[2];

  Products_Private(l, r, phi->v, weight, o);
  Own_Private(l, r, phi->v, weight, o);
  Pairs_Private(l, r, phi->v, weight, o);
  for (int c = 0; c < 3; c++) {
    Ag[c] = br * r->kappa[c] + (c == 0 ? r->open * r->beta * r->turn : 0);
    Cg[c] = br * r->s * r->kappa[c] + sr * r->n[c];
    if (r->closes) Cg[c] += br * r->dopen * r->d[c];
    k[c] = phi->v * sr * r->d[c];
    A[c] = phi->v * Ag[c];
    C[c] = phi->v * Cg[c];
    E[c] = -phi->v * br * r->kappa[c];
  }
  Cross3(r->t[1], k, B[0]);
  Cross3(k, r->t[0], B[1]);
  ContactRaySlopes(D, m, na, r->S.N, A, r->S.d, B, o->gradient);
  ContactRaySet(D, nv, r->V.N, C, o->gradient + D * na);
  ContactRaySet(D, nb, r->M.N, E, o->gradient + D * (na + nv));
  for (PetscInt i = 0; i < m; i++) { /* how everything changes along the facet */
    PetscReal along[3];

    for (int c = 0; c < 3; c++) along[c] = r->t[i][c] + r->s * r->di[i][c];
    sigma[i] = Dot3(r->kappa, along);
    openi[i] = sigma[i] + r->dopen * Dot3(r->d, r->di[i]) - (r->closes ? r->closing[i] : 0);
    for (PetscInt j = 0; j < m; j++) etai[j][i] = Dot3(r->zeta[j], along);
    Cross3(r->tt[i], r->t[1], ni[i]);
    if (m == 2) AddCross_Private(r->t[0], r->tt[i + 1], ni[i]);
    betai[i] = Dot3(r->n, r->di[i]) + Dot3(r->d, ni[i]);
    rhoi[i]  = r->turn * r->t[i][0];
    gi[i]    = br * openi[i] + sr * betai[i] + r->open * r->beta * rhoi[i];
  }
  for (PetscInt i = 0; i < m; i++) {
    const PetscReal b   = phi->v * (r->rho * openi[i] + r->open * rhoi[i]);
    PetscReal      *row = o->mixed[i], u[3] = {0, 0, 0}, h[3], v[3], w[2][3] = {{0}}, n[2][3];

    /* r: from ds, deta */
    Axpy3_Private(phi->v * (br * Dot3(r->kappa, r->di[i]) + r->rho * betai[i] + r->beta * rhoi[i]), r->kappa, u);
    for (PetscInt j = 0; j < m; j++)
      for (PetscInt q = 0; q < m; q++) Axpy3_Private(-phi->v * br * Dot3(r->kappa, r->Xij[j + q]) * etai[j][i], r->zeta[q], u);
    /* P */
    for (int c = 0; c < 3; c++) v[c] = u[c] + phi->d[i] * Ag[c];
    v[0] += phi->v * (r->beta * openi[i] + r->open * betai[i]) * r->turn;
    /* T_k */
    for (int c = 0; c < 3; c++) h[c] = phi->v * sr * r->di[i][c] + b * r->d[c] + phi->d[i] * sr * r->d[c];
    Normal_Private(r, h, n);
    if (m == 2) AddCross_Private(r->tt[i + 1], k, w[0]);
    AddCross_Private(k, r->tt[i], w[1]);
    Axpy3_Private(1, A, w[i]);
    for (PetscInt j = 0; j < m; j++) Axpy3_Private(1, n[j], w[j]);
    ContactRaySlopes(D, m, na, r->S.N, v, r->S.d, w, row);
    for (PetscInt j = 0; j < m; j++) ContactRayAdd(D, na, r->S.dd[i + j], B[j], row);
    /* V */
    for (int c = 0; c < 3; c++) v[c] = r->s * u[c] + phi->d[i] * Cg[c] + phi->v * (br * sigma[i] * r->kappa[c] + sr * ni[i][c]) + b * r->n[c];
    if (r->closes) {
      const PetscReal square = Dot3(r->d, r->d), along = r->rho * betai[i] + r->beta * rhoi[i] - 3 * br * Dot3(r->d, r->di[i]) / square;

      for (int c = 0; c < 3; c++) v[c] += phi->v * (r->dopen * (br * r->di[i][c] + along * r->d[c]) + br * r->closing[i] / square * r->d[c]);
    }
    ContactRaySet(D, nv, r->V.N, v, row + D * na);
    ContactRayAdd(D, nv, r->V.d[i], C, row + D * na);
    /* M */
    for (int c = 0; c < 3; c++) v[c] = -u[c] - phi->d[i] * br * r->kappa[c];
    for (PetscInt j = 0; j < m; j++) Scale_Private(etai[j][i], E, w[j]);
    ContactRaySlopes(D, m, nb, r->M.N, v, r->M.d, w, row + D * (na + nv));
    o->xi[i] = phi->v * gi[i] + phi->d[i] * gap;
  }
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = i; j < m; j++) {
      PetscReal sum = phi->dd[i + j] * gap + phi->d[i] * gi[j] + phi->d[j] * gi[i], x[3] = {0, 0, 0};

      sum += Dot3(A, r->tt[i + j]) + phi->v * br * (sigma[i] * Dot3(r->kappa, r->di[j]) + sigma[j] * Dot3(r->kappa, r->di[i]));
      for (PetscInt q = 0; q < m; q++) sum += Dot3(B[q], r->ttt[i + j + q]);
      if (i != j) sum += Dot3(C, r->dij);
      for (PetscInt p = 0; p < m; p++)
        for (PetscInt q = 0; q < m; q++) sum -= phi->v * br * Dot3(r->kappa, r->Xij[p + q]) * etai[p][i] * etai[q][j];
      sum += phi->v * sr * (Dot3(r->di[i], ni[j]) + Dot3(r->di[j], ni[i])) + phi->v * r->rho * (openi[i] * betai[j] + openi[j] * betai[i]);
      if (m == 2) {
        AddCross_Private(r->tt[i], r->tt[j + 1], x);
        AddCross_Private(r->tt[j], r->tt[i + 1], x);
      }
      sum += Dot3(k, x) + phi->v * ((r->beta * openi[i] + r->open * betai[i]) * rhoi[j] + (r->beta * openi[j] + r->open * betai[j]) * rhoi[i]);
      if (r->closes) {
        const PetscReal square = Dot3(r->d, r->d), along[2] = {Dot3(r->d, r->di[i]), Dot3(r->d, r->di[j])};

        sum += phi->v * br * r->dopen * (Dot3(r->di[i], r->di[j]) - 3 * along[0] * along[1] / square);
        sum += phi->v * br * ((r->closing[i] * along[1] + r->closing[j] * along[0]) / square - (i != j ? r->closing[2] : 0));
      }
      o->xixi[i + j] = sum;
    }
}

/* Facets of order 1 with numbers that are known here: loops are unrolled. */
void ContactRaySecond(const RayFacet *f, const RayLattice *mortar, const RayPoint *r, const RayWeight *phi, PetscReal weight, RaySecond *o)
{
  const PetscInt num = f->s.num == mortar->num && f->s.num == f->nv ? f->nv : 0;
  const Layout   l = {f->D, f->m, f->s.num, f->nv, mortar->num}, edges = {2, 1, 2, 2, 2}, quads = {3, 2, 4, 4, 4};

  if (num == 2)
    Second_Private(&edges, r, phi, weight, o);
  else if (num == 4)
    Second_Private(&quads, r, phi, weight, o);
  else
    Second_Private(&l, r, phi, weight, o);
}
