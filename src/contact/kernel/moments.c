/* Moments int N_a g, int N_a dA of one facet over its overlaps, and the covered share (blend.c), with exact first derivatives.

   Polygons are split into triangles (plane: intervals); a Gauss point Y = sum_k beta_k C_k, beta constant, moves with their corners C: dxi = J^-1 dY.
   Integrands per dY carry 1 / det Y,xi. */
#include "kernelimpl.h"

/* Weights per dY: functions over det, with derivatives by xi. */
void ContactRayOverDet(const RayFacet *f, const RayChartPoint *c, PetscReal factor, const RayWeight *w, RayWeight *to)
{
  const PetscReal over = factor / c->det;

  to->v = w->v * over;
  for (PetscInt i = 0; i < f->m; i++) to->d[i] = (w->d[i] - w->v * c->ddet[i] / c->det) * over;
  for (PetscInt i = 0; i < f->m; i++)
    for (PetscInt j = i; j < f->m; j++)
      to->dd[i + j] = (w->dd[i + j] - (w->d[i] * c->ddet[j] + w->d[j] * c->ddet[i]) / c->det + 2 * w->v * c->ddet[i] * c->ddet[j] / (c->det * c->det)) * over;
}

/* Functions of the lattice that weigh gap and area, and the weight of the share behind them, with derivatives by Y. */
typedef struct {
  PetscReal v[RAY_LATTICE + 1], d[2][RAY_LATTICE + 1];
} Factors;

INLINE void FactorsOf_Private(PetscInt m, PetscInt n, const RayFunctions *S, const RayChartPoint *chart, PetscBool derivatives, Factors *w)
{
  for (PetscInt a = 0; a < n; a++) w->v[a] = S->N[a];
  for (PetscInt c = 0; c < m && derivatives; c++)
    for (PetscInt a = 0; a < n; a++) {
      w->d[c][a] = 0;
      for (PetscInt i = 0; i < m; i++) w->d[c][a] += chart->inverse[i][c] * S->d[i][a];
    }
}

static void Factors_Private(const RayFacet *f, const RayFunctions *S, const PetscReal xi[2], const RayChartPoint *chart, PetscBool derivatives, Factors *w)
{
  PetscReal d[2], dd[3];

  if (f->m == 2 && f->s.num == 4)
    FactorsOf_Private(2, 4, S, chart, derivatives, w);
  else
    FactorsOf_Private(f->m, f->s.num, S, chart, derivatives, w);
  ContactShareWeight(f->m, xi, &w->v[f->s.num], d, dd);
  for (PetscInt c = 0; c < f->m && derivatives; c++) {
    w->d[c][f->s.num] = 0;
    for (PetscInt i = 0; i < f->m; i++) w->d[c][f->s.num] += chart->inverse[i][c] * d[i];
  }
}

/* Sums over one simplex. */
typedef struct {
  PetscInt   num, nq, na;                 /* functions, numbers, numbers of the lattice */
  PetscReal *weight, *gap, *area, *along; /* [points][num], [points][nq], [points][na], [points][m][2 num + 1] */
  PetscReal *corner;                      /* [m + 1][m][2 num + 1] derivatives by the simplex's corners */
  PetscReal  mean[RAY_MOMENTS], length[RAY_LATTICE];
} Batch;

/* along[m][ld]: derivatives by Y of functions from .. from + num over det times the density g. */
static void Along_Private(const RayFacet *f, const RayChartPoint *chart, const Factors *w, PetscReal over, PetscReal g, const PetscReal g_xi[2], PetscInt from,
                          PetscInt num, PetscInt ld, PetscReal along[])
{
  for (PetscInt c = 0; c < f->m; c++) {
    const PetscReal *d = w->d[c] + from, *v = w->v + from, y = over * g;
    PetscReal        x = 0;

    for (PetscInt i = 0; i < f->m; i++) x += chart->inverse[i][c] * over * (g_xi[i] - g * chart->ddet[i] / chart->det);
    for (PetscInt q = 0; q < num; q++) along[c * ld + q] = x * v[q] + y * d[q];
  }
}

static PetscBool Batch_Private(RayWork w, const RayLattice *mortar, const Overlap *o, const RayGuess *guess, const RaySimplex *s, PetscInt points,
                               const PetscReal point[][3], const PetscReal weight[], PetscBool derivatives, RayPoint *r, Batch *b)
{
  const RayFacet *f   = &w->facet;
  const PetscInt  num = b->num, all = 2 * num + 1;
  const PetscReal flat[2] = {0, 0};
  RayPlace       *place   = w->place + w->num_places;
  Factors         factor;

  for (PetscInt q = 0; q < all; q++) b->mean[q] = 0;
  for (PetscInt k = 0; k < points; k++) {
    PetscReal gap_xi[2], area_xi[2], gap, area, over, unit;

    if (!ContactRayPoint(f, mortar, o, guess, s, point[k], derivatives ? 2 : 1, r)) return PETSC_FALSE;
    for (int i = 0; i < 2; i++) place[k].xi[i] = r->xi[i], place[k].eta[i] = r->eta[i];
    gap = ContactRayGap(r), area = ContactRayArea(r), over = weight[k] / r->chart.det;
    w->min_gap = PetscMin(w->min_gap, r->s * r->beta / r->a);
    w->covered += s->size * area * over;
    Factors_Private(f, &r->S, r->xi, &r->chart, derivatives, &factor);
    unit = s->size * over * r->beta * r->rho / PetscSqrtReal(Dot3(r->d, r->d));
    for (PetscInt q = 0; q < num; q++) {
      b->mean[q] += factor.v[q] * over * gap;
      b->mean[num + q] += factor.v[q] * over * area;
      b->length[q] += factor.v[q] * unit;
    }
    b->mean[2 * num] += factor.v[num] * over;
    if (!derivatives) continue;
    for (PetscInt q = 0; q < num; q++) b->weight[k * num + q] = factor.v[q] * over;
    ContactRayFirst(f, mortar, r, b->gap + k * b->nq, b->area + k * b->na, gap_xi, area_xi);
    Along_Private(f, &r->chart, &factor, over, gap, gap_xi, 0, num, all, b->along + k * f->m * all);
    Along_Private(f, &r->chart, &factor, over, area, area_xi, 0, num, all, b->along + k * f->m * all + num);
    Along_Private(f, &r->chart, &factor, over, 1, flat, num, 1, all, b->along + k * f->m * all + 2 * num);
  }
  w->num_places += points;
  return PETSC_TRUE;
}

/* One overlap: its moments into q[], derivatives by nq + RAY_IMAGES numbers into dq. False: a ray misses. */
static PetscErrorCode Overlap_Private(RayWork w, const RayLattice *mortar, PetscInt k, PetscBool derivatives, PetscReal q[], PetscReal dq[], PetscBool *good)
{
  const RayFacet *f = &w->facet;
  Overlap         split;
  const Overlap  *o = &split;
  const PetscInt  D = f->D, na = f->s.num, nq = D * (na + f->nv + mortar->num), width = nq + RAY_IMAGES, m = f->m, all = 2 * na + 1;
  RayMove         move[FACET_VERTICES];
  RayGuess        guess;
  Batch           b;
  RayPoint        r;
  PetscInt        points, simplices;
  const PetscReal(*point)[3], *weight;

  PetscFunctionBegin;
  ContactRaySplit(f, &w->overlap[k], &split);
  simplices = ContactRaySimplices(f, o);
  *good     = PETSC_TRUE;
  b.num = na, b.nq = nq, b.na = D * na;
  PetscCall(ContactRayRule(f, o, mortar->order, &points, &point, &weight));
  PetscCall(ArrayGrow(points * (na + nq + b.na + m * all) + m * (m + 1) * all, sizeof(PetscReal), &w->size_buffer, &w->buffer));
  PetscCall(ArrayGrow(w->num_places + simplices * points, sizeof(RayPlace), &w->size_places, &w->place));
  b.weight = w->buffer, b.gap = b.weight + points * na, b.area = b.gap + points * nq, b.along = b.area + points * b.na;
  b.corner = b.along + points * m * all;
  for (PetscInt i = 0; i < all; i++) q[i] = 0;
  for (PetscInt i = 0; i < na; i++) b.length[i] = 0;
  if (derivatives) {
    PetscCall(PetscArrayzero(dq, all * width));
    ContactRayMoves(f, o, move);
  }
  ContactRayGuess(f, mortar, o, &guess);
  for (PetscInt j = 0; j < simplices; j++) {
    RaySimplex s;

    ContactRaySimplex(f, o, j, &s);
    *good = Batch_Private(w, mortar, o, &guess, &s, points, point, weight, derivatives, &r, &b);
    if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
    for (PetscInt i = 0; i < all; i++) q[i] += s.size * b.mean[i];
    if (!derivatives) continue;
    ContactRayProducts(points, s.size, na, b.weight, na, nq, b.gap, nq, dq, width);
    ContactRayProducts(points, s.size, na, b.weight, na, b.na, b.area, b.na, dq + na * width, width);
    PetscCall(PetscArrayzero(b.corner, m * (m + 1) * all));
    ContactRayProducts(points, s.size, m + 1, point[0], 3, m * all, b.along, m * all, b.corner, m * all);
    for (PetscInt v = 0; v <= m; v++)
      for (PetscInt c = 0; c < m; c++) {
        const PetscReal *along = move[s.corner[v]].d[c], *corner = b.corner + (m * v + c) * all, d = s.d[m * v + c];

        for (PetscInt i = 0; i < all; i++)
          for (int l = 0; l < RAY_IMAGES; l++) dq[i * width + nq + l] += (corner[i] + b.mean[i] * d) * along[l];
      }
  }
  for (PetscInt i = 0; i < na; i++) w->length[i] += b.length[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactRayMoments(ContactPair pair, const ContactSurface *mortar, PetscBool derivatives)
{
  RayWork         w  = pair->ray;
  const RayFacet *f  = &w->facet;
  const PetscInt  na = f->s.num, own = na + f->nv;
  PetscReal       q[RAY_MOMENTS];
  PetscInt        place[3 * (2 * RAY_LATTICE + 4) + RAY_IMAGES], kept = 0;
  RayLattice      facet;

  PetscFunctionBegin;
  w->num_moments = 2 * na + 1;
  w->covered = 0, w->min_gap = PETSC_MAX_REAL;
  PetscCall(PetscArrayzero(w->length, na));
  PetscCall(PetscArrayzero(w->q, w->num_moments));
  if (derivatives) {
    PetscCall(ArrayGrow(w->num_moments * w->n, sizeof(PetscReal), &w->size_dq, &w->dq));
    PetscCall(PetscArrayzero(w->dq, w->num_moments * w->n));
  }
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    const PetscReal covered = w->covered, gap = w->min_gap;
    const PetscInt  places = w->num_places;
    PetscBool       good;
    PetscInt        width;

    ContactRayLatticeGather(mortar, w->mortar[k], &facet);
    width = f->D * (own + facet.num) + RAY_IMAGES;
    PetscCall(ArrayGrow(w->num_moments * width, sizeof(PetscReal), &w->size_part, &w->part));
    PetscCall(Overlap_Private(w, &facet, k, derivatives, q, w->part, &good));
    if (!good) {
      w->covered = covered, w->min_gap = gap, w->num_places = places;
      pair->num_degenerate++;
      continue;
    }
    ContactRayPlaces(w, mortar, k, facet.num, place);
    for (PetscInt i = 0; i < w->num_moments; i++) {
      w->q[i] += q[i];
      for (PetscInt l = 0; derivatives && l < width - RAY_IMAGES + f->m * f->nv; l++) w->dq[i * w->n + place[l]] += w->part[i * width + l];
    }
    w->overlap[kept]  = w->overlap[k];
    w->mortar[kept++] = w->mortar[k];
  }
  w->num_overlaps = kept;
  if (derivatives) ContactImagesFold(w, w->num_moments, w->dq, w->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}
