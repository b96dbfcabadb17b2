/* Integrals over one overlap and their exact derivatives by the 24 numbers it depends on.

   The polygon is split into triangles from its first vertex; each Gauss point Y = sum_i beta_i v_i (beta constant) is projected along the facet's normal, that
   is located in the plane, on both facets: xi and eta with Y = sum N_a(xi) q_a = sum N_b(eta) r_b. The integrand, with heights h_a and k_b, is f = Q2(xi) +
   Q1(xi) g,   g = sum N_b(eta) k_b - sum N_a(xi) h_a,   Q2 = sum D_jk N_j N_k,   Q1 = sum g_j N_j. Variations: J dxi = dY - sum N_a dq_a, and d2 of both sides
   gives f_xi . d2xi = A . (d2Y - 2 sum_a (N_a,i dxi_i) dq_a - 2 T dxi_1 dxi_2),   A = J^-T f_xi,   T = d2Y / dxi_1 dxi_2, so that d2f/2 = dxi_i (F_ij dxi_j / 2
   + C_ij deta_j + sigma_i + Q1_i theta) + deta_i (E_ij deta_j / 2 + tau_i): sigma_i = sum_a N_a,i (-A . dq_a - Q1 dh_a),   tau_i = sum_b N_b,i (-B . dr_b + Q1
   dk_b),   theta = sum N_b dk_b - sum N_a dh_a: four outer products per point. The area of a triangle is bilinear in its vertices. Vertices that are corners of
   a facet are nodes; intersections of two lines move with four nodes, with second derivatives (MoveCurvature_Private). */
#include "facetimpl.h"

#define WIDTH 32 /* 24 numbers, 6 of the triangle's vertices, padding */
#define WHOLE (FACET_LOCAL + 2 * FACET_VERTICES)

/* How vertex k moves: with a node (place of its Y among the numbers), or with four of them. */
typedef struct {
  PetscInt  place;    /* >= 0: a node's; else own numbers FACET_LOCAL + 2 k */
  PetscInt  node[4];  /* ends of the nonmortar side, ends of the mortar side */
  PetscReal e[2][2];  /* the two sides' vectors */
  PetscReal det;      /* e_0 x e_1; 0: (nearly) one line, the vertex keeps its place on the nonmortar side */
  PetscReal share[2]; /* place along both sides */
  PetscReal ds[2][8]; /* derivatives of the shares by the four nodes */
  PetscReal dv[2][8];
} Move;

static void MoveLine_Private(const Overlap *o, int line, int which, Move *m)
{
  const PlaneQuad *s = &o->side[line / 4];
  const int        a = line % 4, b = (a + 1) % 4;

  m->node[2 * which]     = 4 * (line / 4) + a;
  m->node[2 * which + 1] = 4 * (line / 4) + b;
  for (int i = 0; i < 2; i++) m->e[which][i] = s->Y[b][i] - s->Y[a][i];
}

/* v = q_a + t e_0 = r_c + u e_1:  dt = (dp_1 - dp_0) x e_1 / det, du = (dp_1 - dp_0) x e_0 / det, dp the motion of the points of the sides at fixed t, u. */
static void MoveCrossing_Private(const Overlap *o, PetscInt k, int a, int b, Move *m)
{
  const int        first = a < b ? a : b, second = a < b ? b : a;
  const PetscReal *p = o->side[0].Y[first % 4], *r = o->side[1].Y[second % 4];

  MoveLine_Private(o, first, 0, m);
  MoveLine_Private(o, second, 1, m);
  m->det = Cross2(m->e[0], m->e[1]);
  if (PetscAbsReal(m->det) <= 1e-12 * PetscSqrtReal(Dot2(m->e[0], m->e[0]) * Dot2(m->e[1], m->e[1]))) m->det = 0;
  for (int w = 0; w < 2; w++) {
    const PetscReal *start = w ? r : p, d[2] = {o->v[k][0] - start[0], o->v[k][1] - start[1]};

    m->share[w] = Dot2(d, m->e[w]) / Dot2(m->e[w], m->e[w]);
  }
  if (m->det != 0) {
    const PetscReal apart[2] = {r[0] - p[0], r[1] - p[1]};

    if (PetscAbsReal(Cross2(apart, m->e[1]) / m->det - m->share[0]) > 0.1 * FACET_STRAY) m->det = 0; /* it was not taken: clip.c */
  }
  for (int n = 0; n < 4; n++) {
    const PetscReal at = n % 2 ? m->share[n / 2] : 1 - m->share[n / 2], sign = n < 2 ? -at : at;
    const PetscReal over = m->det != 0 ? sign / m->det : 0;

    for (int w = 0; w < 2; w++) {
      const PetscReal *e = m->e[1 - w];

      m->ds[w][2 * n]     = over * e[1];
      m->ds[w][2 * n + 1] = -over * e[0];
    }
    for (int i = 0; i < 2; i++)
      for (int c = 0; c < 2; c++) m->dv[i][2 * n + c] = m->e[0][i] * m->ds[0][2 * n + c] + (n < 2 && c == i ? at : 0);
  }
}

static void Moves_Private(const Overlap *o, Move move[])
{
  for (PetscInt k = 0; k < o->num; k++) {
    const int a = o->line[(k + o->num - 1) % o->num], b = o->line[k];

    move[k].place = -1;
    if (a / 4 != b / 4)
      MoveCrossing_Private(o, k, a, b, &move[k]);
    else
      move[k].place = 3 * (4 * (a / 4) + ((a + 1) % 4 == b % 4 ? b % 4 : a % 4));
  }
}

static inline PetscInt VertexPlace_Private(const Move *m, PetscInt k)
{
  return m->place >= 0 ? m->place : FACET_LOCAL + 2 * k;
}

/* Where the 30 numbers of triangle (0, k, k + 1) stand among all. */
static void TrianglePlaces_Private(const Move move[], PetscInt k, PetscInt place[30])
{
  const PetscInt vertex[3] = {0, k, k + 1};

  for (PetscInt i = 0; i < FACET_LOCAL; i++) place[i] = i;
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 2; i++) place[FACET_LOCAL + 2 * j + i] = VertexPlace_Private(&move[vertex[j]], vertex[j]) + i;
}

/* A row by all numbers -> by the 24: what falls on crossings goes to their nodes. */
static void ReduceRow_Private(const Overlap *o, const Move move[], const PetscReal all[WHOLE], PetscReal row[FACET_LOCAL])
{
  for (PetscInt i = 0; i < FACET_LOCAL; i++) row[i] = all[i];
  for (PetscInt k = 0; k < o->num; k++) {
    if (move[k].place >= 0) continue;
    for (int i = 0; i < 2; i++) {
      const PetscReal value = all[FACET_LOCAL + 2 * k + i];

      for (int n = 0; n < 4; n++)
        for (int c = 0; c < 2; c++) row[3 * move[k].node[n] + c] += value * move[k].dv[i][2 * n + c];
    }
  }
}

/* Derivatives of a triangle's area by its vertices. */
static PetscReal TriangleArea_Private(const Overlap *o, PetscInt k, PetscReal da[6])
{
  const PetscReal *a = o->v[0], *b = o->v[k], *c = o->v[k + 1];
  const PetscReal  x[3] = {a[0], b[0], c[0]}, y[3] = {a[1], b[1], c[1]};

  for (int i = 0; i < 3; i++) {
    da[2 * i]     = 0.5 * (y[(i + 1) % 3] - y[(i + 2) % 3]);
    da[2 * i + 1] = 0.5 * (x[(i + 2) % 3] - x[(i + 1) % 3]);
  }
  return 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
}

typedef struct {
  PlanePoint p[2];
  PetscReal  gap, dh[2], dk[2], h12, k12; /* of the heights by parametric coordinates */
} OverlapPoint;

static PetscBool Point_Private(const Overlap *o, PetscInt k, int gauss, OverlapPoint *p)
{
  const PetscReal *beta = ContactRulePoint[gauss];
  PetscReal        Y[2];

  for (int i = 0; i < 2; i++) Y[i] = beta[0] * o->v[0][i] + beta[1] * o->v[k][i] + beta[2] * o->v[k + 1][i];
  for (int s = 0; s < 2; s++)
    if (!ContactQuadLocate(&o->side[s], Y, &p->p[s])) return PETSC_FALSE;
  p->gap = p->h12 = p->k12 = 0;
  for (int i = 0; i < 2; i++) p->dh[i] = p->dk[i] = 0;
  for (int a = 0; a < 4; a++) {
    p->gap += p->p[1].N[a] * o->side[1].h[a] - p->p[0].N[a] * o->side[0].h[a];
    p->h12 += ContactMixed[a] * o->side[0].h[a];
    p->k12 += ContactMixed[a] * o->side[1].h[a];
    for (int i = 0; i < 2; i++) {
      p->dh[i] += p->p[0].d[i][a] * o->side[0].h[a];
      p->dk[i] += p->p[1].d[i][a] * o->side[1].h[a];
    }
  }
  return PETSC_TRUE;
}

/* Variations of xi (side 0) or eta (side 1): rows 0 and 1 by the 30 numbers. */
static void LocateRows_Private(const PlanePoint *p, int side, const PetscReal beta[3], PetscReal row[2][WIDTH])
{
  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < WIDTH; j++) row[i][j] = 0;
    for (int a = 0; a < 4; a++)
      for (int c = 0; c < 2; c++) row[i][3 * (4 * side + a) + c] = -p->inverse[i][c] * p->N[a];
    for (int v = 0; v < 3; v++)
      for (int c = 0; c < 2; c++) row[i][FACET_LOCAL + 2 * v + c] = p->inverse[i][c] * beta[v];
  }
}

/* Variation of the gap at fixed xi and eta. */
static void ThetaRow_Private(const OverlapPoint *p, PetscReal row[WIDTH])
{
  for (int j = 0; j < WIDTH; j++) row[j] = 0;
  for (int a = 0; a < 4; a++) {
    row[3 * a + 2]       = -p->p[0].N[a];
    row[3 * (4 + a) + 2] = p->p[1].N[a];
  }
}

static void MomentValues_Private(const OverlapPoint *p, PetscReal f[FACET_MOMENTS])
{
  const PetscReal *N = p->p[0].N;
  int              q = 8;

  for (int j = 0; j < 4; j++) {
    f[j]     = N[j] * p->gap;
    f[4 + j] = N[j];
    for (int k = j; k < 4; k++) f[q++] = N[j] * N[k];
  }
}

/* Moments by (xi_1, xi_2, gap). */
static void MomentFactors_Private(const OverlapPoint *p, PetscReal c[FACET_MOMENTS][3])
{
  const PlanePoint *s = &p->p[0];
  int               q = 8;

  for (int j = 0; j < 4; j++) {
    for (int i = 0; i < 2; i++) {
      c[j][i]     = s->d[i][j] * p->gap;
      c[4 + j][i] = s->d[i][j];
    }
    c[j][2]     = s->N[j];
    c[4 + j][2] = 0;
    for (int k = j; k < 4; k++, q++) {
      for (int i = 0; i < 2; i++) c[q][i] = s->d[i][j] * s->N[k] + s->N[j] * s->d[i][k];
      c[q][2] = 0;
    }
  }
}

/* Derivatives of the moments at one point, times weight, into sum[FACET_MOMENTS][WIDTH]. */
static void PointGradient_Private(const OverlapPoint *p, const PetscReal beta[3], PetscReal weight, PetscReal sum[][WIDTH])
{
  PetscReal xi[2][WIDTH], eta[2][WIDTH], gap[WIDTH], c[FACET_MOMENTS][3];

  LocateRows_Private(&p->p[0], 0, beta, xi);
  LocateRows_Private(&p->p[1], 1, beta, eta);
  ThetaRow_Private(p, gap);
  for (int j = 0; j < WIDTH; j++) gap[j] += p->dk[0] * eta[0][j] + p->dk[1] * eta[1][j] - p->dh[0] * xi[0][j] - p->dh[1] * xi[1][j];
  MomentFactors_Private(p, c);
  for (int q = 0; q < FACET_MOMENTS; q++)
    for (int j = 0; j < WIDTH; j++) sum[q][j] += weight * (c[q][0] * xi[0][j] + c[q][1] * xi[1][j] + c[q][2] * gap[j]);
}

PetscBool ContactOverlapMoments(const Overlap *o, FacetMoments *m, PetscReal dq[][FACET_LOCAL])
{
  PetscReal    all[FACET_MOMENTS][WHOLE], sum[FACET_MOMENTS][WIDTH], da[6], f[FACET_MOMENTS], mean[FACET_MOMENTS];
  PetscInt     place[30];
  Move         move[FACET_VERTICES];
  OverlapPoint p;

  if (dq) {
    memset(all, 0, sizeof(all));
    Moves_Private(o, move);
  }
  for (PetscInt k = 1; k + 1 < o->num; k++) {
    const PetscReal area = TriangleArea_Private(o, k, da);

    for (int q = 0; q < FACET_MOMENTS; q++) mean[q] = 0;
    if (dq) memset(sum, 0, sizeof(sum));
    for (int i = 0; i < CONTACT_RULE; i++) {
      if (!Point_Private(o, k, i, &p)) return PETSC_FALSE;
      m->min_gap = PetscMin(m->min_gap, p.gap);
      MomentValues_Private(&p, f);
      for (int q = 0; q < FACET_MOMENTS; q++) mean[q] += ContactRuleWeight[i] * f[q];
      if (dq) PointGradient_Private(&p, ContactRulePoint[i], area * ContactRuleWeight[i], sum);
    }
    for (int q = 0; q < FACET_MOMENTS; q++) m->q[q] += area * mean[q];
    if (!dq) continue;
    TrianglePlaces_Private(move, k, place);
    for (int q = 0; q < FACET_MOMENTS; q++) {
      for (int j = 0; j < 6; j++) sum[q][FACET_LOCAL + j] += mean[q] * da[j];
      for (int j = 0; j < 30; j++) all[q][place[j]] += sum[q][j];
    }
  }
  for (int q = 0; dq && q < FACET_MOMENTS; q++) ReduceRow_Private(o, move, all[q], dq[q]);
  return PETSC_TRUE;
}

/* ---- second derivatives ------------------------------------------------------------------------------------------------------------- */

/* Q1, Q2 and their derivatives at a point. */
typedef struct {
  PetscReal Q1, d1[2], m1, Q2, d2[2], dd2[2][2];
} Weighting;

static void Weighting_Private(const PlanePoint *s, const PetscReal g[4], const PetscReal D[4][4], Weighting *w)
{
  w->Q1 = w->m1 = w->Q2 = 0;
  for (int i = 0; i < 2; i++) w->d1[i] = w->d2[i] = w->dd2[i][0] = w->dd2[i][1] = 0;
  for (int j = 0; j < 4; j++) {
    PetscReal DN = 0, Dd[2] = {0, 0};

    for (int k = 0; k < 4; k++) {
      DN += D[j][k] * s->N[k];
      for (int i = 0; i < 2; i++) Dd[i] += D[j][k] * s->d[i][k];
    }
    w->Q1 += g[j] * s->N[j];
    w->m1 += g[j] * ContactMixed[j];
    w->Q2 += s->N[j] * DN;
    for (int i = 0; i < 2; i++) {
      w->d1[i] += g[j] * s->d[i][j];
      w->d2[i] += 2 * s->d[i][j] * DN;
      for (int k = 0; k < 2; k++) w->dd2[i][k] += 2 * (s->d[i][j] * Dd[k] + (i != k ? ContactMixed[j] * DN : 0));
    }
  }
}

/* One Gauss point: gradient (30 numbers) and four outer products left x right. Returns f. */
static PetscReal PointHessian_Private(const OverlapPoint *p, const PetscReal beta[3], const PetscReal g[4], const PetscReal D[4][4], PetscReal gradient[WIDTH],
                                      PetscReal left[4][WIDTH], PetscReal right[4][WIDTH])
{
  const PlanePoint *s = &p->p[0], *m = &p->p[1];
  PetscReal         fs[2], fm[2], A[2], B[2], theta[WIDTH], F[2][2], E;
  Weighting         w;

  Weighting_Private(s, g, D, &w);
  for (int i = 0; i < 2; i++) {
    fs[i] = w.d2[i] + w.d1[i] * p->gap - w.Q1 * p->dh[i];
    fm[i] = w.Q1 * p->dk[i];
  }
  for (int i = 0; i < 2; i++) {
    A[i] = s->inverse[0][i] * fs[0] + s->inverse[1][i] * fs[1];
    B[i] = m->inverse[0][i] * fm[0] + m->inverse[1][i] * fm[1];
  }
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) F[i][j] = w.dd2[i][j] - w.d1[i] * p->dh[j] - w.d1[j] * p->dh[i];
  F[0][1] += w.m1 * p->gap - w.Q1 * p->h12 - Dot2(A, s->mixed);
  F[1][0] = F[0][1];
  E       = w.Q1 * p->k12 - Dot2(B, m->mixed);
  LocateRows_Private(s, 0, beta, left);
  LocateRows_Private(m, 1, beta, left + 2);
  ThetaRow_Private(p, theta);
  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < WIDTH; j++) {
      right[i][j]     = 0.5 * (F[i][0] * left[0][j] + F[i][1] * left[1][j]) + w.d1[i] * (p->dk[0] * left[2][j] + p->dk[1] * left[3][j] + theta[j]);
      right[2 + i][j] = 0.5 * E * left[3 - i][j];
    }
    for (int a = 0; a < 4; a++) {
      for (int c = 0; c < 2; c++) {
        right[i][3 * a + c] -= s->d[i][a] * A[c];
        right[2 + i][12 + 3 * a + c] -= m->d[i][a] * B[c];
      }
      right[i][3 * a + 2] -= s->d[i][a] * w.Q1;
      right[2 + i][12 + 3 * a + 2] += m->d[i][a] * w.Q1;
    }
  }
  for (int j = 0; j < WIDTH; j++) gradient[j] = w.Q1 * theta[j] + fs[0] * left[0][j] + fs[1] * left[1][j] + fm[0] * left[2][j] + fm[1] * left[3][j];
  return w.Q2 + w.Q1 * p->gap;
}

/* w . d2v / 2 of a crossing, times its gradient w: dt (w . de_0 - c de_0 x e_1) + du c de_1 x e_1, c = w . e_0 / det. */
static void MoveCurvature_Private(const Move *m, const PetscReal w[2], PetscReal W[FACET_LOCAL][FACET_LOCAL])
{
  const PetscReal c = m->det != 0 ? Dot2(w, m->e[0]) / m->det : 0;
  PetscReal       right[2][8];

  if (m->det == 0) return;
  for (int n = 0; n < 4; n++) {
    const PetscReal sign = n % 2 ? 1 : -1;

    right[0][2 * n]     = n < 2 ? sign * (w[0] - c * m->e[1][1]) : 0;
    right[0][2 * n + 1] = n < 2 ? sign * (w[1] + c * m->e[1][0]) : 0;
    right[1][2 * n]     = n < 2 ? 0 : sign * c * m->e[1][1];
    right[1][2 * n + 1] = n < 2 ? 0 : -sign * c * m->e[1][0];
  }
  for (int k = 0; k < 2; k++)
    for (int a = 0; a < 8; a++)
      for (int b = 0; b < 8; b++) W[3 * m->node[a / 2] + a % 2][3 * m->node[b / 2] + b % 2] += m->ds[k][a] * right[k][b];
}

/* By all numbers -> by the 24. */
static void ReduceHalf_Private(const Overlap *o, const Move move[], PetscReal all[WHOLE][WHOLE], const PetscReal gradient[WHOLE],
                               PetscReal W[FACET_LOCAL][FACET_LOCAL])
{
  for (PetscInt k = 0; k < o->num; k++) {
    if (move[k].place >= 0) continue;
    for (int i = 0; i < 2; i++) {
      const PetscInt from = FACET_LOCAL + 2 * k + i;

      for (int n = 0; n < 4; n++)
        for (int c = 0; c < 2; c++) {
          PetscReal      *to    = all[3 * move[k].node[n] + c];
          const PetscReal value = move[k].dv[i][2 * n + c];

          for (PetscInt j = 0; j < WHOLE; j++) to[j] += value * all[from][j];
        }
    }
  }
  for (PetscInt a = 0; a < FACET_LOCAL; a++) ReduceRow_Private(o, move, all[a], W[a]);
  for (PetscInt k = 0; k < o->num; k++)
    if (move[k].place < 0) MoveCurvature_Private(&move[k], &gradient[FACET_LOCAL + 2 * k], W);
}

/* One triangle: half Hessian and gradient by its 30 numbers. */
static PetscBool Triangle_Private(const Overlap *o, PetscInt k, const PetscReal g[4], const PetscReal D[4][4], PetscReal W[WIDTH][WIDTH], PetscReal sum[WIDTH])
{
  PetscReal       da[6], mean = 0, gradient[WIDTH], left[4][WIDTH], right[4][WIDTH];
  const PetscReal area = TriangleArea_Private(o, k, da);
  OverlapPoint    p;

  memset(W, 0, WIDTH * sizeof(W[0]));
  for (int j = 0; j < WIDTH; j++) sum[j] = 0;
  for (int i = 0; i < CONTACT_RULE; i++) {
    if (!Point_Private(o, k, i, &p)) return PETSC_FALSE;
    mean += ContactRuleWeight[i] * PointHessian_Private(&p, ContactRulePoint[i], g, D, gradient, left, right);
    for (int j = 0; j < WIDTH; j++) sum[j] += ContactRuleWeight[i] * gradient[j];
    for (int a = 0; a < 30; a++)
      for (int l = 0; l < 4; l++) {
        const PetscReal value = area * ContactRuleWeight[i] * left[l][a];

        for (int j = 0; j < WIDTH; j++) W[a][j] += value * right[l][j];
      }
  }
  for (int a = 0; a < 6; a++)
    for (int j = 0; j < WIDTH; j++) W[FACET_LOCAL + a][j] += da[a] * sum[j];
  for (int j = 0; j < WIDTH; j++) sum[j] *= area;
  for (int a = 0; a < 6; a++) sum[FACET_LOCAL + a] += mean * da[a];
  for (int i = 0; i < 3; i++) { /* half of the area's second derivatives: x_i (y_(i+1) - y_(i+2)) / 2 has each pair once */
    const int b = (i + 1) % 3, c = (i + 2) % 3;

    W[FACET_LOCAL + 2 * i][FACET_LOCAL + 2 * b + 1] += 0.5 * mean;
    W[FACET_LOCAL + 2 * i][FACET_LOCAL + 2 * c + 1] -= 0.5 * mean;
  }
  return PETSC_TRUE;
}

PetscBool ContactOverlapHessian(const Overlap *o, const PetscReal g[4], const PetscReal D[4][4], PetscReal W[FACET_LOCAL][FACET_LOCAL])
{
  PetscReal all[WHOLE][WHOLE], gradient[WHOLE], part[WIDTH][WIDTH], sum[WIDTH];
  PetscInt  place[30];
  Move      move[FACET_VERTICES];

  memset(all, 0, sizeof(all));
  memset(gradient, 0, sizeof(gradient));
  Moves_Private(o, move);
  for (PetscInt k = 1; k + 1 < o->num; k++) {
    if (!Triangle_Private(o, k, g, D, part, sum)) return PETSC_FALSE;
    TrianglePlaces_Private(move, k, place);
    for (int a = 0; a < 30; a++) {
      gradient[place[a]] += sum[a];
      for (int b = 0; b < 30; b++) all[place[a]][place[b]] += part[a][b];
    }
  }
  ReduceHalf_Private(o, move, all, gradient, W);
  return PETSC_TRUE;
}
