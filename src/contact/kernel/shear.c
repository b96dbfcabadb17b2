/* Friction in space (docs/theory.md, 5): forces of tangential tractions and their derivatives.

   Traction. At a point with unit normal n: tau = sum_j psi_j sum_a q_ja t_ja, t_ja the axes of node j carried there (frame.c). In components along the facet,
   |n| tau = sigma_1 x,1 + sigma_2 x,2, sigma_1 = tau . (x,2 x n), sigma_2 = tau . (n x x,1), and those are held while positions y vary:
     f = d/dy int sigma_i y,i . (y_m(eta) - y(xi)) dxi:   h_a = N_a,i sigma_i R - N_a |n| tau,   h_b = M_b |n| tau,   R = x_m - x less what is closed of it.
   Nothing of it changes under rigid motion of y.

   Every row of h is a sum of three factors, of the row's node, times three vectors of the point: (- N, N,1, N,2) or (M, M,1, M,2) times (|n| tau, sigma_1 R,
   sigma_2 R) or, of the changes of M, (.., deta_1 |n| tau, deta_2 |n| tau). Columns of these vectors: those of unit tractions, and for the tangent derivatives
   by positions and directions at fixed xi, by axes, by the covered share. What moves with the ends of overlaps comes after. */
#include "kernelimpl.h"

/* Columns at a point: [2 nr] unit tractions; then, with derivatives, [3][na + nv + nb] numbers, [nr][6] changes of Q_j and m_j, the covered share. */
typedef struct {
  PetscInt   na, nb, nv, nr, units, numbers, width;
  PetscReal *psi;                   /* [nr] values, [nr] by the share, [nr] by xi_1, [nr] by xi_2 */
  PetscReal *left[2], *right[2];    /* of lattice and mortar nodes: [points][3][na or nb], [points][3][3][width] */
  PetscReal *sum[2];                /* [na or nb][3][width] */
  PetscReal *slope, *mean, *corner; /* [2][rows] at a point, [rows], [3][2][rows]; rows: 3 (na + nb) */
} Work;

/* Sums over a facet. Rows: 3 numbers of each node of the lattice, then of the mortar nodes. */
typedef struct {
  PetscInt   rows, n, nr;
  PetscReal *F, *K, *Q, *share; /* [2 nr][rows]; [rows][n], [rows][6 nr], [rows] or NULL */
} Sums;

/* What tractions make of a point. */
typedef struct {
  PetscReal n[3], a, R[3], b[2][3];        /* unit normal, size, x_m - x; sigma_i = tau . b_i */
  PetscReal tau[3], sigma[2], along[2][3]; /* along: sum_j psi_j,k t_j */
  PetscReal C[2][3][3], S[2][2][3];        /* d(|n| tau) = C_k dx,k; dsigma_i = S_i,k . dx,k */
} Traction;

static void Traction_Private(const RayPoint *r, Traction *t)
{
  t->a = r->a;
  for (int c = 0; c < 3; c++) t->n[c] = r->unit[c];
  ContactRayOpening(r, t->R);
  Cross3(r->t[1], t->n, t->b[0]);
  Cross3(t->n, r->t[0], t->b[1]);
}

/* C and S, from B = sum_j psi_j B_j. */
static void Variation_Private(const RayPoint *r, const PetscReal B[3][3], Traction *t)
{
  PetscReal G[3][3], BP[3][3], cross[2][3], x[3];

  for (int c = 0; c < 3; c++) {
    const PetscReal along = Dot3(B[c], t->n);

    for (int e = 0; e < 3; e++) {
      BP[c][e] = B[c][e] - along * t->n[e];
      G[c][e]  = t->tau[c] * t->n[e] + BP[c][e];
    }
    Cross3(r->t[1], G[c], t->C[0][c]);
    Cross3(G[c], r->t[0], t->C[1][c]);
  }
  Cross3(t->tau, r->t[1], cross[0]);
  Cross3(r->t[0], t->tau, cross[1]);
  for (int i = 0; i < 2; i++) {
    const PetscReal along = Dot3(cross[i], t->n);
    PetscReal       g[3];

    for (int e = 0; e < 3; e++) {
      g[e] = cross[i][e] - along * t->n[e];
      for (int c = 0; c < 3; c++) g[e] += t->b[i][c] * BP[c][e];
      g[e] /= t->a;
    }
    Cross3(r->t[1], g, t->S[i][0]);
    Cross3(g, r->t[0], t->S[i][1]);
  }
  Cross3(t->n, t->tau, x);
  for (int c = 0; c < 3; c++) t->S[0][1][c] += x[c], t->S[1][0][c] -= x[c];
}

/* Columns of the three vectors of a traction t at the point. */
static void Column_Private(const Work *o, const Traction *at, PetscReal factor, const PetscReal t[3], PetscReal *right[2], PetscInt column)
{
  for (int c = 0; c < 3; c++) {
    const PetscReal value = factor * at->a * t[c];

    right[0][c * o->width + column] = right[1][c * o->width + column] = value;
    for (int i = 0; i < 2; i++) right[0][(3 * (i + 1) + c) * o->width + column] = factor * Dot3(t, at->b[i]) * at->R[c];
  }
}

/* Unit tractions, and by axes and share, of row j; adds to what the tractions q make. */
static void Row_Private(const EvaluateContext *ctx, const Work *o, PetscInt j, Traction *at, PetscReal B[3][3], PetscReal share[3], PetscReal *right[2])
{
  const RayWork    w    = ctx->pair->ray;
  const PetscInt   node = w->result.node[j], nr = o->nr;
  const NodeFrame *f = &w->frame[node];
  const PetscReal *q = ctx->pair->traction, psi = o->psi[j];
  PetscReal        Q[3] = {0, 0, 0}, t[3], A[3][3], Bj[3][3], a;

  for (int i = 0; i < 2; i++) {
    ContactCarry(f->m, at->n, f->e[i], t);
    Column_Private(o, at, psi, t, right, 2 * j + i);
    for (int c = 0; c < 3; c++) Q[c] += q[ctx->nonmortar->num_nodes * i + node] * f->e[i][c];
  }
  if (!o->numbers) return;
  a = ContactCarry(f->m, at->n, Q, t);
  ContactCarryRows(f->m, at->n, Q, A, Bj);
  for (int c = 0; c < 3; c++) {
    const PetscReal column[3] = {A[0][c], A[1][c], A[2][c]};
    const PetscInt  place     = o->units + o->numbers + 6 * j + c;

    at->tau[c] += psi * t[c];
    share[c] += o->psi[nr + j] * t[c];
    for (int k = 0; k < 2; k++) at->along[k][c] += o->psi[(2 + k) * nr + j] * t[c];
    for (int e = 0; e < 3; e++) B[c][e] += psi * Bj[c][e];
    Column_Private(o, at, psi, column, right, place);
    Column_Private(o, at, -a * psi, column, right, place + 3);
  }
}

/* By one number: component e of a node, of which x,k changes by d[k], r by value, so that deta = value zeta, and d by turns. */
static void Number_Private(const Work *o, const RayPoint *r, const Traction *at, int e, PetscReal value, PetscReal place, PetscReal turns, const PetscReal d[2],
                           PetscReal *right[2], PetscInt column)
{
  PetscReal dR[3], dd[3] = {0, 0, 0}, dsigma[2] = {0, 0};

  for (int c = 0; c < 3; c++) dR[c] = value * (r->Xi[0][c] * r->zeta[0][e] + r->Xi[1][c] * r->zeta[1][e]);
  dR[e] -= place;
  dd[e] = turns;
  if (turns != 0) ContactRayOpeningTurns(r, dd, dR);
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 2; k++) dsigma[i] += at->S[i][k][e] * d[k];
  for (int c = 0; c < 3; c++) {
    right[0][c * o->width + column] = right[1][c * o->width + column] = at->C[0][c][e] * d[0] + at->C[1][c][e] * d[1];
    for (int i = 0; i < 2; i++) {
      right[0][(3 * (i + 1) + c) * o->width + column] = dsigma[i] * at->R[c] + at->sigma[i] * dR[c];
      right[1][(3 * (i + 1) + c) * o->width + column] = value * r->zeta[i][e] * at->a * at->tau[c];
    }
  }
}

static void Numbers_Private(const Work *o, const RayPoint *r, const Traction *at, PetscReal *right[2])
{
  const PetscReal none[2] = {0, 0};

  for (int e = 0; e < 3; e++) {
    for (PetscInt a = 0; a < o->na; a++) {
      const PetscReal d[2] = {r->S.d[0][a], r->S.d[1][a]};

      Number_Private(o, r, at, e, r->S.N[a], r->S.N[a], 0, d, right, o->units + e * o->na + a);
    }
    for (PetscInt v = 0; v < o->nv; v++) Number_Private(o, r, at, e, r->s * r->V.N[v], 0, r->V.N[v], none, right, o->units + 3 * o->na + e * o->nv + v);
    for (PetscInt b = 0; b < o->nb; b++) Number_Private(o, r, at, e, -r->M.N[b], -r->M.N[b], 0, none, right, o->units + 3 * (o->na + o->nv) + e * o->nb + b);
  }
}

/* slope[2][rows]: how the density changes along the facet; mean[rows] of the density over det: += weight. */
static void Slope_Private(const Work *o, const RayPoint *r, const Traction *at, PetscReal weight, PetscReal mean[], PetscReal slope[])
{
  const PetscInt rows = 3 * (o->na + o->nb);
  PetscReal      h[2 * RAY_LATTICE][3];

  for (PetscInt a = 0; a < o->na; a++)
    for (int c = 0; c < 3; c++) h[a][c] = (r->S.d[0][a] * at->sigma[0] + r->S.d[1][a] * at->sigma[1]) * at->R[c] - r->S.N[a] * at->a * at->tau[c];
  for (PetscInt b = 0; b < o->nb; b++)
    for (int c = 0; c < 3; c++) h[o->na + b][c] = r->M.N[b] * at->a * at->tau[c];
  for (PetscInt i = 0; i < rows; i++) mean[i] += weight * h[i / 3][i % 3];
  for (int k = 0; k < 2; k++) {
    PetscReal along[3], eta[2], Rk[3], Tk[3], sk[2];

    for (int c = 0; c < 3; c++) along[c] = r->t[k][c] + r->s * r->di[k][c];
    for (int i = 0; i < 2; i++) {
      eta[i] = Dot3(r->zeta[i], along);
      sk[i]  = Dot3(at->S[i][0], r->tt[k]) + Dot3(at->S[i][1], r->tt[k + 1]) + Dot3(at->b[i], at->along[k]);
    }
    for (int c = 0; c < 3; c++) {
      Rk[c] = r->Xi[0][c] * eta[0] + r->Xi[1][c] * eta[1] - r->t[k][c];
      Tk[c] = Dot3(at->C[0][c], r->tt[k]) + Dot3(at->C[1][c], r->tt[k + 1]) + at->a * at->along[k][c];
    }
    ContactRayOpeningAlong(r, k, Rk);
    for (PetscInt i = 0; i < rows; i++) {
      const PetscInt c = i % 3, a = i / 3, b = a - o->na;
      PetscReal      x = -h[a][c] * r->chart.ddet[k] / r->chart.det;

      if (b < 0) {
        for (int l = 0; l < 2; l++) x += r->S.dd[l + k][a] * at->sigma[l] * at->R[c] + r->S.d[l][a] * (sk[l] * at->R[c] + at->sigma[l] * Rk[c]);
        x -= r->S.d[k][a] * at->a * at->tau[c] + r->S.N[a] * Tk[c];
      } else
        x += (r->M.d[0][b] * eta[0] + r->M.d[1][b] * eta[1]) * at->a * at->tau[c] + r->M.N[b] * Tk[c];
      slope[k * rows + i] = weight * x;
    }
  }
}

static void Point_Private(const EvaluateContext *ctx, const Work *o, const RayPoint *r, PetscReal weight, PetscInt q, const PetscReal beta[3])
{
  const RayWork  w  = ctx->pair->ray;
  const PetscInt na = o->na, nr = o->nr, rows = 3 * (na + o->nb);
  PetscReal     *right[2] = {o->right[0] + 9 * o->width * q, o->right[1] + 9 * o->width * q}, *left[2] = {o->left[0] + 3 * na * q, o->left[1] + 3 * o->nb * q};
  PetscReal      B[3][3] = {{0}}, share[3] = {0, 0, 0};
  Traction       at = {0};

  Traction_Private(r, &at);
  for (PetscInt j = 0; j < 4 * nr; j++) o->psi[j] = 0;
  for (PetscInt j = 0; j < nr; j++)
    for (PetscInt a = 0; a < na; a++) {
      o->psi[j] += w->T[j * na + a] * r->S.N[a];
      o->psi[nr + j] += w->T[(nr + j) * na + a] * r->S.N[a];
      for (int k = 0; k < 2; k++) o->psi[(2 + k) * nr + j] += w->T[j * na + a] * r->S.d[k][a];
    }
  for (PetscInt j = 0; j < nr; j++) Row_Private(ctx, o, j, &at, B, share, right);
  for (PetscInt a = 0; a < na; a++) left[0][a] = -weight * r->S.N[a], left[0][na + a] = weight * r->S.d[0][a], left[0][2 * na + a] = weight * r->S.d[1][a];
  for (PetscInt b = 0; b < o->nb; b++) {
    left[1][b] = weight * r->M.N[b];
    for (int k = 0; k < 2; k++) left[1][(k + 1) * o->nb + b] = weight * r->M.d[k][b];
  }
  if (!o->numbers) return;
  for (int i = 0; i < 2; i++) at.sigma[i] = Dot3(at.tau, at.b[i]);
  Variation_Private(r, B, &at);
  Numbers_Private(o, r, &at, right);
  Column_Private(o, &at, 1, share, right, o->width - 1);
  Slope_Private(o, r, &at, weight, o->mean, o->slope);
  for (int v = 0; v < 3; v++)
    for (int c = 0; c < 2; c++)
      for (PetscInt i = 0; i < rows; i++)
        o->corner[(2 * v + c) * rows + i] += beta[v] * (r->chart.inverse[0][c] * o->slope[i] + r->chart.inverse[1][c] * o->slope[rows + i]);
}

static PetscErrorCode WorkCreate_Private(const RayWork w, PetscInt nb, PetscInt points, PetscBool derivatives, Work *o)
{
  const PetscInt na = w->facet.s.num, nv = w->facet.nv, nr = w->result.num_rows, rows = 3 * (na + nb);

  PetscFunctionBegin;
  *o       = (Work){.na = na, .nb = nb, .nv = nv, .nr = nr, .units = 2 * nr, .numbers = derivatives ? 3 * (na + nv + nb) : 0};
  o->width = o->units + (derivatives ? o->numbers + 6 * nr + 1 : 0);
  PetscCall(PetscCalloc6(4 * nr, &o->psi, 3 * na * points, &o->left[0], 3 * nb * points, &o->left[1], 9 * o->width * points, &o->right[0],
                         9 * o->width * points, &o->right[1], 3 * na * o->width, &o->sum[0]));
  PetscCall(PetscCalloc4(3 * nb * o->width, &o->sum[1], 2 * rows, &o->slope, rows, &o->mean, 6 * rows, &o->corner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WorkDestroy_Private(Work *o)
{
  PetscFunctionBegin;
  PetscCall(PetscFree6(o->psi, o->left[0], o->left[1], o->right[0], o->right[1], o->sum[0]));
  PetscCall(PetscFree4(o->sum[1], o->slope, o->mean, o->corner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums of an overlap to those of the facet. row[]: of a node's component; column[]: of the overlap's numbers among the facet's. */
static void Gather_Private(const Work *o, const PetscInt row[], const PetscInt column[], Sums *s)
{
  for (PetscInt i = 0; i < 3 * (o->na + o->nb); i++) {
    const PetscReal *from = i < 3 * o->na ? o->sum[0] + i * o->width : o->sum[1] + (i - 3 * o->na) * o->width;

    for (PetscInt l = 0; l < o->units; l++) s->F[l * s->rows + row[i]] += from[l];
    if (!o->numbers) continue;
    from += o->units;
    for (PetscInt l = 0; l < o->numbers; l++) s->K[row[i] * s->n + column[l]] += from[l];
    from += o->numbers;
    for (PetscInt l = 0; l < 6 * o->nr; l++) s->Q[row[i] * 6 * o->nr + l] += from[l];
    s->share[row[i]] += from[6 * o->nr];
  }
}

static PetscErrorCode Overlap_Private(const EvaluateContext *ctx, PetscInt k, const RayPlace **place, Sums *s)
{
  RayWork         w  = ctx->pair->ray;
  const RayFacet *f  = &w->facet;
  const PetscInt  na = f->s.num;
  PetscInt        column[3 * (2 * RAY_LATTICE + 4) + RAY_IMAGES], row[6 * RAY_LATTICE], points;
  Overlap         o;
  RayLattice      mortar;
  RayMove         move[FACET_VERTICES];
  Work            work;
  const PetscReal(*point)[3], *weight;

  PetscFunctionBegin;
  ContactRaySplit(f, &w->overlap[k], &o);
  ContactRayLatticeGather(ctx->mortar, w->mortar[k], &mortar);
  ContactRayPlaces(w, ctx->mortar, k, mortar.num, column);
  for (PetscInt i = 0; i < 3 * (na + mortar.num); i++) {
    const PetscInt b = i / 3 - na;

    row[i] = b < 0 ? i : column[3 * (na + f->nv) + i % 3 * mortar.num + b] - 3 * f->nv;
  }
  ContactRayMoves(f, &o, move);
  PetscCall(ContactRayRule(f, &o, mortar.order, &points, &point, &weight));
  PetscCall(WorkCreate_Private(w, mortar.num, points, (PetscBool)(s->K != NULL), &work));
  for (PetscInt j = 0; j < ContactRaySimplices(f, &o); j++) {
    const PetscInt rows = 3 * (na + mortar.num), images = work.numbers;
    RaySimplex     simplex;

    ContactRaySimplex(f, &o, j, &simplex);
    PetscCall(PetscArrayzero(work.mean, rows));
    PetscCall(PetscArrayzero(work.corner, 6 * rows));
    for (PetscInt q = 0; q < points; q++, (*place)++) {
      RayPoint r;

      PetscCheck(ContactRayAgain(f, &mortar, *place, 2, &r), PETSC_COMM_SELF, PETSC_ERR_PLIB, "a ray that met the mortar facet does not meet it again");
      Point_Private(ctx, &work, &r, weight[q] / r.chart.det, q, point[q]);
    }
    ContactRayProducts(3 * points, simplex.size, na, work.left[0], na, 3 * work.width, work.right[0], 3 * work.width, work.sum[0], 3 * work.width);
    ContactRayProducts(3 * points, simplex.size, mortar.num, work.left[1], mortar.num, 3 * work.width, work.right[1], 3 * work.width, work.sum[1],
                       3 * work.width);
    for (PetscInt v = 0; v < 6 && s->K; v++)
      for (PetscInt i = 0; i < rows; i++) {
        const PetscReal slope = simplex.size * work.corner[v * rows + i] + simplex.d[v] * work.mean[i], *along = move[simplex.corner[v / 2]].d[v % 2];

        for (int l = 0; l < RAY_IMAGES; l++) s->K[row[i] * s->n + column[images + l]] += slope * along[l];
      }
  }
  Gather_Private(&work, row, column, s);
  PetscCall(WorkDestroy_Private(&work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* to[rows][nn] += Q times how axes follow the nodes. */
static PetscErrorCode Axes_Private(const EvaluateContext *ctx, const Sums *s, PetscReal to[])
{
  RayWork          w  = ctx->pair->ray;
  const PetscInt   nn = w->nn, num = ctx->nonmortar->num_nodes;
  const PetscReal *q = ctx->pair->traction;
  PetscReal       *axes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(9 * nn, &axes));
  for (PetscInt j = 0; j < s->nr; j++) {
    const PetscInt node = w->result.node[j];

    PetscCall(ContactFrameRows(w, ctx->nonmortar, node, &w->result, axes));
    for (PetscInt i = 0; i < 3 * nn; i++) axes[3 * nn + i] = q[node] * axes[i] + q[num + node] * axes[3 * nn + i];
    for (PetscInt i = 0; i < s->rows; i++)
      for (PetscInt l = 0; l < 6; l++) {
        const PetscReal factor = s->Q[(i * s->nr + j) * 6 + l];

        for (PetscInt c = 0; c < nn && factor != 0; c++) to[i * nn + c] += factor * axes[(3 + l) * nn + c];
      }
  }
  PetscCall(PetscFree(axes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Tangent_Private(const EvaluateContext *ctx, const Sums *s, PetscReal H[])
{
  RayWork          w = ctx->pair->ray;
  const PetscInt   n = s->n, rows = s->rows;
  const PetscReal *dshare = w->dq + 2 * w->facet.s.num * n;
  PetscReal       *to;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < rows && w->share.part; i++)
    for (PetscInt j = 0; j < n; j++) s->K[i * n + j] += s->share[i] * dshare[j];
  PetscCall(PetscCalloc1(rows * w->nn, &to));
  PetscCall(ContactRayChainForces(w, rows, s->K, to));
  PetscCall(Axes_Private(ctx, s, to));
  ContactSlipMasters(w, w->nn, to, w->nn, H);
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactShear(const EvaluateContext *ctx, ContactFacet *out)
{
  RayWork         w     = ctx->pair->ray;
  const PetscInt  nr    = w->result.num_rows;
  const RayPlace *place = w->places;
  Sums            s     = {.rows = 3 * (w->facet.s.num + w->num_mortar), .n = w->n, .nr = nr};
  const PetscInt  more  = out->hessian ? s.rows : 0;
  PetscReal      *shear;

  PetscFunctionBegin;
  PetscCall(PetscCalloc4(2 * nr * s.rows, &s.F, more * s.n, &s.K, more * 6 * nr, &s.Q, more, &s.share));
  if (!more) s.K = NULL;
  for (PetscInt k = 0; k < w->num_overlaps; k++) PetscCall(Overlap_Private(ctx, k, &place, &s));
  PetscCall(ContactStoreReserve(&w->result.store, 2 * nr * w->nn, &shear));
  for (PetscInt r = 0; r < nr; r++)
    for (PetscInt i = 0; i < 2; i++) ContactSlipMasters(w, 1, s.F + (2 * r + i) * s.rows, 1, shear + (nr * i + r) * w->nn);
  out->shear = shear;
  if (s.K) PetscCall(Tangent_Private(ctx, &s, (PetscReal *)out->hessian));
  PetscCall(PetscFree4(s.F, s.K, s.Q, s.share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
