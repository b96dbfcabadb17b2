/* Weighted gaps of one nonmortar edge with the dual basis of its covered part, or with standard multipliers (psi = N), and their exact derivatives.

   On the covered part let D2_jk = int N_j N_k, D1_j = int N_j = D2_j0 + D2_j1, G_j = int N_j g. The dual basis psi = A N, A = diag(D1) D2^-1, gives
     gt_j = int psi_j g = D1_j c_j,   c = D2^-1 G,   w_j = int psi_j = D1_j:
   c_j is the value at node j of the straight line that fits g best (L2) on the covered part. D2 of a barely covered edge is nearly singular in the
   hats, not in 1 and M = (lambda - centre) / half, [centre - half, centre + half] the covered part. As gt_j does not depend on the choice of basis,
   centre and half are plain numbers without derivatives, and with q = (m00, m01, m11, G0, G1) = (int 1, M, M^2, g, M g)
     k = m^-1 G,   c_j = k_0 + E_j k_1,   E = (-centre, 1 - centre) / half,   D1 = ((1 - centre) m00 - half m01, centre m00 + half m01).
   Standard: gt_j = G_j. Measure: dgamma = L rho dlambda; the length L of the edge is taken out of all integrals: D1 and gt scale with L, c does not.
   Derivatives: dgt_j = L sum_q s_jq dq + s_j dL, s_j = D1_j c_j (standard: G_j); second ones of S = sum_j z_j s_j:
     L (sum_q S_q Hess q + sum_qr S_qr dq dr^T) + dL dS^T + dS dL^T + S Hess L.
   Sources: dual basis on the covered part: Cichosz & Bischoff 2011, Popp, Seitz, Gee & Wall 2013; the Lagrangian form keeps momentum exactly. */
#include "contactimpl.h"

typedef struct {
  PetscReal centre, half, E[2];
  PetscReal k[2], c[2], D1[2], inverse[2][2];                                        /* inverse of m */
  PetscReal kq[CONTACT_MOMENTS][2], dc[CONTACT_MOMENTS][2], dD1[CONTACT_MOMENTS][2]; /* derivatives by q */
  PetscReal s[2], ds[CONTACT_MOMENTS][2];                                            /* s_j = gt_j / L and its derivatives by q */
} Dual;

/* Row vectors of dm/dq times v. */
static void MassTimes_Private(int q, const PetscReal v[2], PetscReal out[2])
{
  out[0] = q == 0 ? v[0] : q == 1 ? v[1] : 0;
  out[1] = q == 1 ? v[0] : q == 2 ? v[1] : 0;
}

/* Standard multipliers: s_j = int N_j g, linear in the moments. */
static void StandardValues_Private(const PetscReal q[CONTACT_MOMENTS], Dual *d)
{
  const PetscReal T[2][2] = {{1 - d->centre, -d->half}, {d->centre, d->half}};

  memset(d->ds, 0, sizeof(d->ds));
  memset(d->dD1, 0, sizeof(d->dD1));
  for (int j = 0; j < 2; j++) {
    d->D1[j] = T[j][0] * q[0] + T[j][1] * q[1];
    d->s[j]  = T[j][0] * q[3] + T[j][1] * q[4];
    for (int k = 0; k < 2; k++) d->dD1[k][j] = d->ds[3 + k][j] = T[j][k];
  }
}

/* Dual coefficients from the moments; false when the covered part is too small: det D2 <= 1e-13 (tr D2)^2. */
static PetscBool DualValues_Private(const PetscReal q[CONTACT_MOMENTS], Dual *d)
{
  const PetscReal det = q[0] * q[2] - q[1] * q[1], T[2][2] = {{1 - d->centre, -d->half}, {d->centre, d->half}};
  PetscReal       trace = 0;

  for (int j = 0; j < 2; j++) trace += T[j][0] * T[j][0] * q[0] + 2 * T[j][0] * T[j][1] * q[1] + T[j][1] * T[j][1] * q[2];
  if (!(d->half * d->half * det > CONTACT_SINGULAR * trace * trace)) return PETSC_FALSE; /* det D2 = (det T)^2 det m, det T = half */
  d->inverse[0][0] = q[2] / det, d->inverse[1][1] = q[0] / det, d->inverse[0][1] = d->inverse[1][0] = -q[1] / det;
  for (int i = 0; i < 2; i++) d->k[i] = d->inverse[i][0] * q[3] + d->inverse[i][1] * q[4];
  d->E[0] = -d->centre / d->half, d->E[1] = (1 - d->centre) / d->half;
  for (int j = 0; j < 2; j++) {
    d->c[j]  = d->k[0] + d->E[j] * d->k[1];
    d->D1[j] = T[j][0] * q[0] + T[j][1] * q[1];
    d->s[j]  = d->D1[j] * d->c[j];
  }
  return PETSC_TRUE;
}

/* First derivatives by q: k_q = m^-1 (G_q - m_q k). */
static void DualFirst_Private(Dual *d)
{
  for (int q = 0; q < CONTACT_MOMENTS; q++) {
    PetscReal v[2];

    MassTimes_Private(q, d->k, v);
    v[0] = (q == 3) - v[0], v[1] = (q == 4) - v[1];
    for (int i = 0; i < 2; i++) d->kq[q][i] = d->inverse[i][0] * v[0] + d->inverse[i][1] * v[1];
    for (int j = 0; j < 2; j++) {
      d->dc[q][j]  = d->kq[q][0] + d->E[j] * d->kq[q][1];
      d->dD1[q][j] = q == 0 ? (j ? d->centre : 1 - d->centre) : q == 1 ? (j ? d->half : -d->half) : 0;
      d->ds[q][j]  = d->dD1[q][j] * d->c[j] + d->D1[j] * d->dc[q][j];
    }
  }
}

/* Second derivatives of S = sum_j z_j D1_j c_j by q: k_qr = -m^-1 (m_q k_r + m_r k_q). */
static void DualSecond_Private(const Dual *d, const PetscReal z[2], PetscReal S[CONTACT_MOMENTS][CONTACT_MOMENTS])
{
  for (int q = 0; q < CONTACT_MOMENTS; q++)
    for (int r = 0; r <= q; r++) {
      PetscReal a[2], b[2], kqr[2], sum = 0;

      MassTimes_Private(q, d->kq[r], a);
      MassTimes_Private(r, d->kq[q], b);
      for (int i = 0; i < 2; i++) kqr[i] = -d->inverse[i][0] * (a[0] + b[0]) - d->inverse[i][1] * (a[1] + b[1]);
      for (int j = 0; j < 2; j++) sum += z[j] * (d->dD1[q][j] * d->dc[r][j] + d->dD1[r][j] * d->dc[q][j] + d->D1[j] * (kqr[0] + d->E[j] * kqr[1]));
      S[q][r] = S[r][q] = sum;
    }
}

/* Everything on one edge by y. Arrays live in the pair's work space. */
typedef struct {
  EdgeFrame      frame;
  Dual           dual;
  PetscInt       num_segments, num_y;
  const Segment *segment;
  PetscReal      q[CONTACT_MOMENTS], dL[4], ddL[4][4];
  PetscReal     *dq; /* [CONTACT_MOMENTS][num_y] */
  PetscReal     *dy; /* [num_y] one gradient */
  PetscReal     *W;  /* [num_y][num_y] */
} EdgeSums;

/* Sum moments and their gradients over the edge's segments. */
static void Moments_Private(const EvaluateContext *ctx, EdgeSums *s, PetscReal *min_gap)
{
  PetscReal       dq[CONTACT_MOMENTS][CONTACT_LOCAL];
  SegmentGeometry g;

  s->dual.centre = 0.5 * (s->segment[0].lambda[0] + s->segment[s->num_segments - 1].lambda[1]);
  s->dual.half   = 0.5 * (s->segment[s->num_segments - 1].lambda[1] - s->segment[0].lambda[0]);
  for (int k = 0; k < CONTACT_MOMENTS; k++) s->q[k] = 0;
  if (ctx->derivatives)
    for (PetscInt i = 0; i < CONTACT_MOMENTS * s->num_y; i++) s->dq[i] = 0;
  for (PetscInt i = 0; i < s->num_segments; i++) {
    ContactGeometry(ctx->mortar, &s->segment[i], &g);
    ContactSegmentMoments(&s->frame, &g, s->dual.centre, s->dual.half, ctx->derivatives, s->q, dq, min_gap);
    if (!ctx->derivatives) continue;
    for (int k = 0; k < CONTACT_MOMENTS; k++) ContactScatterVector(s->segment[i].local, dq[k], s->dq + k * s->num_y);
  }
}

/* dy = L sum_q factor_q dq + value dL */
static void Combine_Private(const EdgeSums *s, const PetscReal factor[CONTACT_MOMENTS], PetscReal value, PetscReal dy[])
{
  for (PetscInt i = 0; i < s->num_y; i++) dy[i] = 0;
  for (int k = 0; k < CONTACT_MOMENTS; k++)
    for (PetscInt i = 0; i < s->num_y; i++) dy[i] += s->frame.length * factor[k] * s->dq[k * s->num_y + i];
  for (int a = 0; a < 4; a++) dy[a] += value * s->dL[a];
}

/* Gradients of gt_j and w_j by y, carried to nodes. */
static void Gradients_Private(const EdgeSums *s, const EdgeChain *chain, PetscReal *dgap, PetscReal *dweight)
{
  const Dual *d = &s->dual;

  for (int j = 0; j < 2; j++) {
    PetscReal factor[CONTACT_MOMENTS];

    for (int k = 0; k < CONTACT_MOMENTS; k++) factor[k] = d->ds[k][j];
    Combine_Private(s, factor, d->s[j], s->dy);
    ContactChainGradient(chain, s->dy, dgap + j * chain->num_u);
    for (int k = 0; k < CONTACT_MOMENTS; k++) factor[k] = d->dD1[k][j];
    Combine_Private(s, factor, d->D1[j], s->dy);
    ContactChainGradient(chain, s->dy, dweight + j * chain->num_u);
  }
}

/* W += half of L S_qr dq dr^T, dL dS^T and half of S Hess L; right: room for num_y. */
static void OuterProducts_Private(const EdgeSums *s, const PetscReal first[CONTACT_MOMENTS], PetscReal second[CONTACT_MOMENTS][CONTACT_MOMENTS], PetscReal S,
                                  PetscReal right[])
{
  const PetscInt ny = s->num_y;

  for (int q = 0; q < CONTACT_MOMENTS; q++) {
    for (PetscInt i = 0; i < ny; i++) {
      right[i] = 0;
      for (int r = 0; r < CONTACT_MOMENTS; r++) right[i] += 0.5 * s->frame.length * second[q][r] * s->dq[r * ny + i];
    }
    for (PetscInt i = 0; i < ny; i++)
      for (PetscInt j = 0; j < ny; j++) s->W[i * ny + j] += s->dq[q * ny + i] * right[j];
  }
  for (PetscInt i = 0; i < ny; i++) {
    PetscReal dS = 0;

    for (int q = 0; q < CONTACT_MOMENTS; q++) dS += first[q] * s->dq[q * ny + i];
    for (int a = 0; a < 4; a++) s->W[a * ny + i] += s->dL[a] * dS;
  }
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < 4; b++) s->W[a * ny + b] += 0.5 * S * s->ddL[a][b];
}

/* Hessian of sum_j z_j gt_j by nodes. */
static void Hessian_Private(const EvaluateContext *ctx, const EdgeSums *s, const EdgeChain *chain, const PetscReal z[2], PetscReal *H)
{
  const Dual     *d = &s->dual;
  PetscReal       S = 0, first[CONTACT_MOMENTS], phi[CONTACT_MOMENTS], second[CONTACT_MOMENTS][CONTACT_MOMENTS], w[CONTACT_LOCAL][CONTACT_LOCAL];
  SegmentGeometry g;

  for (int j = 0; j < 2; j++) S += z[j] * d->s[j];
  for (int q = 0; q < CONTACT_MOMENTS; q++) {
    first[q] = 0;
    for (int j = 0; j < 2; j++) first[q] += z[j] * d->ds[q][j];
    phi[q] = s->frame.length * first[q];
  }
  if (ctx->pair->standard)
    memset(second, 0, sizeof(second));
  else
    DualSecond_Private(d, z, second);
  for (PetscInt i = 0; i < s->num_y * s->num_y; i++) s->W[i] = 0;
  for (PetscInt i = 0; i < s->num_segments; i++) {
    ContactGeometry(ctx->mortar, &s->segment[i], &g);
    ContactSegmentHessian(&s->frame, &g, d->centre, d->half, phi, w);
    ContactScatter(s->segment[i].local, s->num_y, w, s->W);
  }
  OuterProducts_Private(s, first, second, S, s->dy);
  Combine_Private(s, first, S, s->dy);
  ContactChainHessian(chain, s->dy, s->W, H);
}

/* Fill one result from the segments of listed edge `slot`. *use is false when the edge is not covered, or too little for a dual basis. */
void ContactMortarEdge(const EvaluateContext *ctx, PetscInt slot, ContactFacet *out, PetscBool *use)
{
  ContactPair    pair       = ctx->pair;
  const PetscInt num_mortar = pair->first_node[slot + 1] - pair->first_node[slot], *nodes = &ctx->nonmortar->facets[2 * pair->listed[slot]];
  EdgeChain      chain;
  EdgeSums       s;
  PetscInt       num;

  s.num_segments = pair->first_segment[slot + 1] - pair->first_segment[slot];
  s.segment      = &pair->segment[pair->first_segment[slot]];
  s.num_y        = 8 + 2 * num_mortar;
  s.dq           = pair->work;
  s.dy           = s.dq + CONTACT_MOMENTS * s.num_y;
  s.W            = s.dy + s.num_y;
  *use           = PETSC_FALSE;
  if (s.num_segments == 0) return;
  ContactFrame(pair, ctx->nonmortar, pair->listed[slot], &s.frame);
  out->min_gap = PETSC_MAX_REAL;
  Moments_Private(ctx, &s, &out->min_gap);
  if (pair->standard)
    StandardValues_Private(s.q, &s.dual);
  else if (!DualValues_Private(s.q, &s.dual))
    return;
  *use = PETSC_TRUE;
  for (int j = 0; j < 2; j++) {
    ((PetscReal *)out->weight)[j] = s.frame.length * s.dual.D1[j];
    ((PetscReal *)out->gap)[j]    = s.frame.length * s.dual.s[j];
  }
  out->area = s.frame.length * s.q[0];
  ContactChainBuild(pair, ctx->nonmortar, pair->listed[slot], num_mortar, &chain, (PetscInt *)out->nodes, &num);
  if (!ctx->derivatives) return;
  if (!pair->standard) DualFirst_Private(&s.dual);
  ContactLengthDerivative(&s.frame, s.dL, s.ddL);
  Gradients_Private(&s, &chain, (PetscReal *)out->dgap, (PetscReal *)out->dweight);
  if (ctx->hessian) {
    const PetscReal z[2] = {ctx->z[nodes[0]], ctx->z[nodes[1]]};

    Hessian_Private(ctx, &s, &chain, z, (PetscReal *)out->hessian);
  }
}
