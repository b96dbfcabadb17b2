/* The gap at a point and its integrals over one segment, with exact first and second derivatives by the 16 numbers of contactimpl.h.

   At lambda: x = N_0 x_0 + N_1 x_1, n = N_0 n_0 + N_1 n_1 (not renormalised). The ray x + s n meets the line c + tau e, e = d - c, where
     s = A / B,  A = (c - x) x e,  B = n x e;   g = n . (x_m - x) / |n| = s |n| = A R / B,  R = |n|:
   a length along the unit direction n / |n|, positive when open. A, B are multilinear, so their second derivatives are constants times hats.
   Integral over a segment: T = (l1 - l0) sum_i w_i F(l0 + zeta_i (l1 - l0)), F = rho (P + g Q), rho = 1 or 2 pi r, P and Q polynomials of lambda;
   T depends on the bounds l0, l1, which depend on the nodes as roots of f(lambda) = n(lambda) x (m - x(lambda)). */
#include "contactimpl.h"

/* Gauss points on [0, 1]; weights sum to 1. */
static const PetscReal GaussPoint[CONTACT_GAUSS]  = {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155, 0.953089922969332};
static const PetscReal GaussWeight[CONTACT_GAUSS] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454};

/* First derivatives of A, B, R, g. */
static void GapGradient_Private(const EdgeFrame *f, const SegmentGeometry *s, GapPoint *p)
{
  const PetscReal *e = s->e, *n = p->n, *x = p->x;

  for (int k = 0; k < 2; k++) {
    const PetscReal N = p->N[k];

    p->dA[2 * k] = -N * e[1], p->dA[2 * k + 1] = N * e[0];
    p->dA[4 + 2 * k] = p->dA[5 + 2 * k] = 0;
    p->dB[2 * k] = p->dB[2 * k + 1] = 0;
    p->dB[4 + 2 * k] = N * e[1], p->dB[5 + 2 * k] = -N * e[0];
    p->dR[2 * k] = p->dR[2 * k + 1] = 0;
    p->dR[4 + 2 * k] = N * n[0] / p->R, p->dR[5 + 2 * k] = N * n[1] / p->R;
    p->dR[8 + 2 * k] = p->dR[9 + 2 * k] = 0;
  }
  p->dA[8] = s->d[1] - x[1], p->dA[9] = x[0] - s->d[0];
  p->dA[10] = x[1] - s->c[1], p->dA[11] = s->c[0] - x[0];
  p->dB[8] = n[1], p->dB[9] = -n[0], p->dB[10] = -n[1], p->dB[11] = n[0];
  for (int i = 0; i < 12; i++) p->dg[i] = p->gA * p->dA[i] + p->gB * p->dB[i] + p->gR * p->dR[i];
  p->Al = -Cross2(f->dx, e);
  p->Bl = Cross2(f->dn, e);
  p->Rl = Dot2(n, f->dn) / p->R;
  p->gl = p->gA * p->Al + p->gB * p->Bl + p->gR * p->Rl;
}

/* Gap at lambda, with first derivatives when asked. */
void ContactPointGap(const EdgeFrame *f, const SegmentGeometry *s, PetscReal lambda, PetscBool derivatives, GapPoint *p)
{
  PetscReal cx[2];

  p->N[0] = 1 - lambda, p->N[1] = lambda;
  for (int i = 0; i < 2; i++) {
    p->x[i] = p->N[0] * f->x[0][i] + p->N[1] * f->x[1][i];
    p->n[i] = p->N[0] * f->n[0][i] + p->N[1] * f->n[1][i];
    cx[i]   = s->c[i] - p->x[i];
  }
  p->A  = Cross2(cx, s->e);
  p->B  = Cross2(p->n, s->e);
  p->R  = PetscSqrtReal(Dot2(p->n, p->n));
  p->gA = p->R / p->B;
  p->gR = p->A / p->B;
  p->gB = -p->gA * p->gR;
  p->g  = p->A * p->gA;
  if (derivatives) GapGradient_Private(f, s, p);
}

/* Second derivatives of the gap by lambda and one of the 12 numbers, and twice by lambda. */
static PetscReal GapMixed_Private(const EdgeFrame *f, const SegmentGeometry *s, const GapPoint *p, PetscReal mixed[12])
{
  const PetscReal *e = s->e, *dx = f->dx, *dn = f->dn, *n = p->n, iB = 1 / p->B, iR = 1 / p->R;
  const PetscReal  gAB = -p->R * iB * iB, gAR = iB, gBB = -2 * p->gB * iB, gBR = -p->A * iB * iB;
  const PetscReal  vA = gAB * p->Bl + gAR * p->Rl, vB = gAB * p->Al + gBB * p->Bl + gBR * p->Rl, vR = gAR * p->Al + gBR * p->Bl;
  const PetscReal  nn = p->Rl * iR;

  for (int i = 0; i < 12; i++) mixed[i] = vA * p->dA[i] + vB * p->dB[i] + vR * p->dR[i];
  for (int k = 0; k < 2; k++) {
    const PetscReal sign = k ? 1 : -1;

    mixed[2 * k] -= p->gA * sign * e[1];
    mixed[2 * k + 1] += p->gA * sign * e[0];
    mixed[4 + 2 * k] += p->gB * sign * e[1] + p->gR * iR * (sign * n[0] + p->N[k] * (dn[0] - nn * n[0]));
    mixed[5 + 2 * k] += -p->gB * sign * e[0] + p->gR * iR * (sign * n[1] + p->N[k] * (dn[1] - nn * n[1]));
  }
  mixed[8] += -p->gA * dx[1] + p->gB * dn[1];
  mixed[9] += p->gA * dx[0] - p->gB * dn[0];
  mixed[10] += p->gA * dx[1] - p->gB * dn[1];
  mixed[11] += -p->gA * dx[0] + p->gB * dn[0];
  return p->gR * iR * (Dot2(dn, dn) - p->Rl * p->Rl) + p->Al * vA + p->Bl * vB + p->Rl * vR;
}

void ContactHessianClear(HessianSum *h)
{
  h->num = 0;
  h->A = h->AN[0] = h->AN[1] = h->BN[0] = h->BN[1] = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) h->RNN[i][j] = 0;
}

/* Add weight times the Hessian of g at fixed lambda; ring_weight times (grad r (x) grad g + transpose) (axisymmetric measure; 0 otherwise). */
void ContactHessianPoint(const EdgeFrame *f, const GapPoint *p, const SegmentGeometry *s, PetscReal weight, PetscReal ring_weight, HessianSum *h)
{
  const PetscReal iB = 1 / p->B, gAB = -p->R * iB * iB * weight, gAR = iB * weight, hBB = -p->gB * iB * weight, gBR = -p->A * iB * iB * weight;
  const PetscReal wA = weight * p->gA, wB = weight * p->gB, wR = 0.5 * weight * p->gR / p->R, u[2] = {p->n[0] / p->R, p->n[1] / p->R};
  PetscReal      *rA = h->right[h->num], *rB = h->right[h->num + 1], *lA = h->left[h->num], *lB = h->left[h->num + 1];

  for (int i = 0; i < 12; i++) {
    lA[i] = p->dA[i];
    rA[i] = gAB * p->dB[i] + gAR * p->dR[i];
    lB[i] = p->dB[i];
    rB[i] = hBB * p->dB[i] + gBR * p->dR[i];
  }
  for (int i = 12; i < CONTACT_LOCAL; i++) lA[i] = rA[i] = lB[i] = rB[i] = 0;
  h->num += 2;
  h->A += wA;
  for (int k = 0; k < 2; k++) {
    h->AN[k] += wA * p->N[k];
    h->BN[k] += wB * p->N[k];
    for (int l = 0; l < 2; l++)
      for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) h->RNN[2 * k + i][2 * l + j] += wR * p->N[k] * p->N[l] * ((i == j) - u[i] * u[j]);
  }
  if (ring_weight != 0) {
    PetscReal *l = h->left[h->num], *r = h->right[h->num];

    for (int i = 0; i < CONTACT_LOCAL; i++) l[i] = 0, r[i] = i < 12 ? ring_weight * p->dg[i] : 0;
    l[0] = p->N[0], l[2] = p->N[1];
    h->num++;
  }
}

/* W (half form) = the outer products and the sparse second derivatives of A, B, R. */
void ContactHessianFinish(const HessianSum *h, PetscReal W[CONTACT_LOCAL][CONTACT_LOCAL])
{
  for (int i = 0; i < CONTACT_LOCAL; i++) {
    PetscReal row[CONTACT_LOCAL] = {0};

    for (PetscInt p = 0; p < h->num; p++)
      for (int j = 0; j < CONTACT_LOCAL; j++) row[j] += h->left[p][i] * h->right[p][j];
    for (int j = 0; j < CONTACT_LOCAL; j++) W[i][j] = row[j];
  }
  W[8][11] += h->A, W[9][10] -= h->A; /* c x d */
  for (int k = 0; k < 2; k++) {
    W[8][2 * k + 1] -= h->AN[k], W[9][2 * k] += h->AN[k];       /* -N_k c x x_k */
    W[2 * k][11] -= h->AN[k], W[2 * k + 1][10] += h->AN[k];     /* -N_k x_k x d */
    W[4 + 2 * k][11] += h->BN[k], W[5 + 2 * k][10] -= h->BN[k]; /* N_k n_k x d */
    W[4 + 2 * k][9] -= h->BN[k], W[5 + 2 * k][8] += h->BN[k];   /* -N_k n_k x c */
  }
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) W[4 + i][4 + j] += h->RNN[i][j];
}

/* A bound's root lambda of f = n x (m - x): implicit function, f_y + f_l lambda_y = 0. curve receives f_ly + f_ll lambda_y / 2, so that
   Hess lambda = -(f_yy + lambda_y (x) curve + curve (x) lambda_y) / f_l. A fixed bound has no derivative. Returns f_l (1 when fixed). */
static PetscReal BoundDerivative_Private(const EdgeFrame *f, const SegmentGeometry *s, int b, PetscReal dl[CONTACT_LOCAL], PetscReal curve[CONTACT_LOCAL])
{
  const PetscReal N[2] = {1 - s->lambda[b], s->lambda[b]};
  const PetscInt  at   = s->place[b];
  PetscReal       d[2], n[2], fl, fll;

  for (int i = 0; i < CONTACT_LOCAL; i++) dl[i] = curve[i] = 0;
  if (at < 0) return 1;
  for (int i = 0; i < 2; i++) {
    d[i] = s->m[b][i] - N[0] * f->x[0][i] - N[1] * f->x[1][i];
    n[i] = N[0] * f->n[0][i] + N[1] * f->n[1][i];
  }
  fl  = Cross2(f->dn, d) - Cross2(n, f->dx);
  fll = -2 * Cross2(f->dn, f->dx);
  for (int k = 0; k < 2; k++) {
    const PetscReal sign = k ? 1 : -1;

    dl[2 * k] = -N[k] * n[1] / fl, dl[2 * k + 1] = N[k] * n[0] / fl;
    dl[4 + 2 * k] = -N[k] * d[1] / fl, dl[5 + 2 * k] = N[k] * d[0] / fl;
    curve[2 * k] = sign * n[1] + N[k] * f->dn[1], curve[2 * k + 1] = -sign * n[0] - N[k] * f->dn[0];
    curve[4 + 2 * k] = sign * d[1] - N[k] * f->dx[1], curve[5 + 2 * k] = -sign * d[0] + N[k] * f->dx[0];
  }
  dl[at] = n[1] / fl, dl[at + 1] = -n[0] / fl;
  curve[at] = -f->dn[1], curve[at + 1] = f->dn[0];
  for (int i = 0; i < CONTACT_LOCAL; i++) curve[i] += 0.5 * fll * dl[i];
  return fl;
}

/* W (half form) += factor * f_yy of bound b: f = sum_k N_k n_k x m - sum_kl N_k N_l n_k x x_l. */
static void AddBoundCurvature_Private(const SegmentGeometry *s, int b, PetscReal factor, PetscReal W[CONTACT_LOCAL][CONTACT_LOCAL])
{
  const PetscReal N[2] = {1 - s->lambda[b], s->lambda[b]};
  const PetscInt  at   = s->place[b];

  if (at < 0) return;
  for (int k = 0; k < 2; k++) {
    W[4 + 2 * k][at + 1] += factor * N[k], W[5 + 2 * k][at] -= factor * N[k];
    for (int l = 0; l < 2; l++) W[4 + 2 * k][2 * l + 1] -= factor * N[k] * N[l], W[5 + 2 * k][2 * l] += factor * N[k] * N[l];
  }
}

/* Moments of one segment, per unit length of the edge: q = integrals of rho (1, M, M^2, g, M g) dlambda with M = (lambda - centre) / half, added to q;
   dq[.][16] (overwritten) their gradients when asked; *min_gap lowered to the least gap at points and ends. */
void ContactSegmentMoments(const EdgeFrame *f, const SegmentGeometry *s, PetscReal centre, PetscReal half, PetscBool derivatives, PetscReal q[CONTACT_MOMENTS],
                           PetscReal dq[CONTACT_MOMENTS][CONTACT_LOCAL], PetscReal *min_gap)
{
  const PetscReal h = s->lambda[1] - s->lambda[0], Ml = 1 / half;
  PetscReal       by0[CONTACT_MOMENTS] = {0}, by1[CONTACT_MOMENTS] = {0}, dl[2][CONTACT_LOCAL], curve[CONTACT_LOCAL];
  GapPoint        p;

  if (derivatives) memset(dq, 0, CONTACT_MOMENTS * sizeof(dq[0]));
  for (int b = 0; b < 2; b++) {
    ContactPointGap(f, s, s->lambda[b], PETSC_FALSE, &p);
    *min_gap = PetscMin(*min_gap, p.g);
  }
  for (int i = 0; i < CONTACT_GAUSS; i++) {
    const PetscReal zeta = GaussPoint[i], w = GaussWeight[i], lambda = s->lambda[0] + zeta * h, M = (lambda - centre) / half;

    ContactPointGap(f, s, lambda, derivatives, &p);
    *min_gap = PetscMin(*min_gap, p.g);
    {
      const PetscReal rho = f->ring > 0 ? f->ring * p.x[0] : 1, rhol = f->ring * f->dx[0];
      const PetscReal P[CONTACT_MOMENTS] = {1, M, M * M, p.g, M * p.g};

      for (int k = 0; k < CONTACT_MOMENTS; k++) q[k] += h * w * rho * P[k];
      if (!derivatives) continue;
      const PetscReal Pl[CONTACT_MOMENTS] = {0, Ml, 2 * M * Ml, p.gl, Ml * p.g + M * p.gl};
      for (int k = 0; k < CONTACT_MOMENTS; k++) {
        const PetscReal F = w * rho * P[k], Fl = h * w * (rhol * P[k] + rho * Pl[k]);

        by0[k] += (1 - zeta) * Fl - F;
        by1[k] += zeta * Fl + F;
        dq[k][0] += h * w * f->ring * p.N[0] * P[k];
        dq[k][2] += h * w * f->ring * p.N[1] * P[k];
      }
      for (int j = 0; j < 12; j++) {
        dq[3][j] += h * w * rho * p.dg[j];
        dq[4][j] += h * w * rho * M * p.dg[j];
      }
    }
  }
  if (!derivatives) return;
  for (int b = 0; b < 2; b++) BoundDerivative_Private(f, s, b, dl[b], curve);
  for (int k = 0; k < CONTACT_MOMENTS; k++)
    for (int j = 0; j < CONTACT_LOCAL; j++) dq[k][j] += by0[k] * dl[0][j] + by1[k] * dl[1][j];
}

/* What a segment's Hessian needs beside the outer products: derivatives by the bounds. */
typedef struct {
  PetscReal first[2], second[2][2], mixed[2][12];
} BoundSum;

/* One Gauss point of ContactSegmentHessian. */
static void HessianGauss_Private(const EdgeFrame *f, const SegmentGeometry *s, PetscReal centre, PetscReal half, const PetscReal phi[CONTACT_MOMENTS], int i,
                                 HessianSum *h, BoundSum *t)
{
  const PetscReal zeta[2] = {1 - GaussPoint[i], GaussPoint[i]}, w = GaussWeight[i], step = s->lambda[1] - s->lambda[0];
  const PetscReal lambda = s->lambda[0] + GaussPoint[i] * step, M = (lambda - centre) / half, Ml = 1 / half;
  const PetscReal Q = phi[3] + phi[4] * M, Ql = phi[4] * Ml, Pl = phi[1] * Ml + 2 * phi[2] * M * Ml, Pll = 2 * phi[2] * Ml * Ml;
  PetscReal       F, Fl, Fll, Fy[12], Fly[12], gll;
  GapPoint        p;

  ContactPointGap(f, s, lambda, PETSC_TRUE, &p);
  gll = GapMixed_Private(f, s, &p, Fly);
  {
    const PetscReal rho = f->ring > 0 ? f->ring * p.x[0] : 1, rhol = f->ring * f->dx[0];
    const PetscReal K = phi[0] + phi[1] * M + phi[2] * M * M + p.g * Q, Kl = Pl + p.gl * Q + p.g * Ql, Kll = Pll + gll * Q + 2 * p.gl * Ql;

    F   = rho * K;
    Fl  = rhol * K + rho * Kl;
    Fll = 2 * rhol * Kl + rho * Kll;
    for (int j = 0; j < 12; j++) {
      Fy[j]  = rho * Q * p.dg[j];
      Fly[j] = rho * Q * Fly[j] + (rhol * Q + rho * Ql) * p.dg[j];
    }
    for (int k = 0; k < 2; k++) {
      Fy[2 * k] += f->ring * p.N[k] * K;
      Fly[2 * k] += f->ring * (p.N[k] * Kl + (k ? K : -K));
    }
    ContactHessianPoint(f, &p, s, w * step * rho * Q, w * step * f->ring * Q, h);
  }
  for (int b = 0; b < 2; b++) {
    const PetscReal sign = b ? w : -w;

    t->first[b] += sign * F + step * w * zeta[b] * Fl;
    for (int j = 0; j < 12; j++) t->mixed[b][j] += sign * Fy[j] + step * w * zeta[b] * Fly[j];
    for (int c = 0; c < 2; c++) t->second[b][c] += (sign * zeta[c] + (c ? w : -w) * zeta[b]) * Fl + step * w * zeta[b] * zeta[c] * Fll;
  }
}

/* Hessian of sum_q phi_q q of one segment in half form. */
void ContactSegmentHessian(const EdgeFrame *f, const SegmentGeometry *s, PetscReal centre, PetscReal half, const PetscReal phi[CONTACT_MOMENTS],
                           PetscReal W[CONTACT_LOCAL][CONTACT_LOCAL])
{
  PetscReal  dl[2][CONTACT_LOCAL], curve[2][CONTACT_LOCAL], factor[2];
  BoundSum   t;
  HessianSum h;

  memset(&t, 0, sizeof(t));
  ContactHessianClear(&h);
  for (int i = 0; i < CONTACT_GAUSS; i++) HessianGauss_Private(f, s, centre, half, phi, i, &h, &t);
  for (int b = 0; b < 2; b++) factor[b] = -t.first[b] / BoundDerivative_Private(f, s, b, dl[b], curve[b]);
  for (int b = 0; b < 2; b++) {
    PetscReal *l = h.left[h.num], *r = h.right[h.num];

    for (int j = 0; j < CONTACT_LOCAL; j++) {
      l[j] = dl[b][j];
      r[j] = (j < 12 ? t.mixed[b][j] : 0) + 0.5 * (t.second[b][0] * dl[0][j] + t.second[b][1] * dl[1][j]) + factor[b] * curve[b][j];
    }
    h.num++;
  }
  ContactHessianFinish(&h, W);
  for (int b = 0; b < 2; b++) AddBoundCurvature_Private(s, b, factor[b], W);
}
