/* Moments int N_a g, int N_a dA, int N_a N_b dA of one facet over its overlaps, with exact first derivatives.

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

/* Moments' functions with derivatives by Y: num that weigh the gap, the same for the area, products for the mass. */
typedef struct {
  PetscReal v[RAY_MOMENTS], d[2][RAY_MOMENTS];
} Factors;

INLINE void FactorsOf_Private(PetscInt m, PetscInt n, const RayFunctions *T, const RayChartPoint *chart, PetscBool mass, PetscBool derivatives, Factors *w)
{
  const PetscReal *N = T->N;
  PetscInt         num;

  for (PetscInt a = 0; a < n; a++) w->v[a] = w->v[n + a] = N[a];
  num = 2 * n;
  for (PetscInt a = 0; a < n && mass; a++)
    for (PetscInt b = a; b < n; b++) w->v[num++] = N[a] * N[b];
  for (PetscInt c = 0; c < m && derivatives; c++) {
    PetscReal *d = w->d[c];

    for (PetscInt a = 0; a < n; a++) {
      d[a] = 0;
      for (PetscInt i = 0; i < m; i++) d[a] += chart->inverse[i][c] * T->d[i][a];
      d[n + a] = d[a];
    }
    num = 2 * n;
    for (PetscInt a = 0; a < n && mass; a++)
      for (PetscInt b = a; b < n; b++) d[num++] = d[a] * N[b] + N[a] * d[b];
  }
}

static void Factors_Private(const RayFacet *f, const RayTest *t, const RayFunctions *T, const RayChartPoint *chart, PetscBool mass, PetscBool derivatives,
                            Factors *w)
{
  if (f->m == 2 && t->num == 4)
    FactorsOf_Private(2, 4, T, chart, mass, derivatives, w);
  else
    FactorsOf_Private(f->m, t->num, T, chart, mass, derivatives, w);
}

/* Sums over one simplex. */
typedef struct {
  PetscInt   num, nq, na;                 /* moments, numbers, numbers of the lattice */
  PetscReal *weight, *gap, *area, *along; /* [points][num], [points][nq], [points][na], [points][m][num] */
  PetscReal *corner;                      /* [m + 1][m][num] derivatives by the simplex's corners */
  PetscReal  mean[RAY_MOMENTS], reach[RAY_LATTICE];
} Batch;

/* along[m][num]: derivatives by Y of functions [from, to) over det times the density g. */
static void Along_Private(const RayFacet *f, const RayChartPoint *chart, const Factors *w, PetscInt from, PetscInt to, PetscReal over, PetscReal g,
                          const PetscReal g_xi[2], PetscInt num, PetscReal along[])
{
  for (PetscInt c = 0; c < f->m; c++) {
    const PetscReal *d = w->d[c], y = over * g;
    PetscReal        x = 0;

    for (PetscInt i = 0; i < f->m; i++) x += chart->inverse[i][c] * over * (g_xi[i] - g * chart->ddet[i] / chart->det);
    for (PetscInt q = from; q < to; q++) along[c * num + q] = x * w->v[q] + y * d[q];
  }
}

static PetscBool Batch_Private(RayWork w, const RayLattice *mortar, const Overlap *o, const RayTest *t, const RayGuess *guess, const RaySimplex *s,
                               PetscInt points, const PetscReal point[][3], const PetscReal weight[], PetscBool mass, PetscBool derivatives, RayPoint *r,
                               Batch *b)
{
  const RayFacet *f     = &w->facet;
  RayPlace       *place = w->place + w->num_places;
  RayFunctions    T;
  Factors         factor;

  for (PetscInt q = 0; q < b->num; q++) b->mean[q] = 0;
  for (PetscInt k = 0; k < points; k++) {
    PetscReal gap_xi[2], area_xi[2], gap, area, over, unit;

    if (!ContactRayPoint(f, mortar, o, guess, s, point[k], derivatives ? 2 : 1, r)) return PETSC_FALSE;
    for (int i = 0; i < 2; i++) place[k].xi[i] = r->xi[i], place[k].eta[i] = r->eta[i];
    gap = ContactRayGap(r), area = ContactRayArea(r), over = weight[k] / r->chart.det;
    w->min_gap = PetscMin(w->min_gap, r->s * r->beta / r->a);
    w->covered += s->size * area * over;
    if (t->hats) ContactRayTestFunctions(f, t, r->xi, &T);
    Factors_Private(f, t, t->hats ? &T : &r->S, &r->chart, mass, derivatives, &factor);
    unit = s->size * over * r->beta * r->rho / PetscSqrtReal(Dot3(r->d, r->d));
    for (PetscInt q = 0; q < t->num; q++) {
      b->mean[q] += factor.v[q] * over * gap;
      b->reach[q] += factor.v[q] * unit;
    }
    for (PetscInt q = t->num; q < b->num; q++) b->mean[q] += factor.v[q] * over * area;
    if (!derivatives) continue;
    for (PetscInt q = 0; q < b->num; q++) b->weight[k * b->num + q] = factor.v[q] * over;
    ContactRayFirst(f, mortar, r, b->gap + k * b->nq, b->area + k * b->na, gap_xi, area_xi);
    Along_Private(f, &r->chart, &factor, 0, t->num, over, gap, gap_xi, b->num, b->along + k * f->m * b->num);
    Along_Private(f, &r->chart, &factor, t->num, b->num, over, area, area_xi, b->num, b->along + k * f->m * b->num);
  }
  w->num_places += points;
  return PETSC_TRUE;
}

/* One overlap: its moments into q[], derivatives by nq + RAY_IMAGES numbers into dq. False: a ray misses. */
static PetscErrorCode Overlap_Private(RayWork w, const RayLattice *mortar, PetscInt k, PetscBool mass, PetscBool derivatives, PetscReal q[], PetscReal dq[],
                                      PetscBool *good)
{
  const RayFacet *f = &w->facet;
  Overlap         split;
  const Overlap  *o = &split;
  const RayTest  *t = &w->test[w->window[k]];
  const PetscInt  D = f->D, nq = D * (f->s.num + f->nv + mortar->num), width = nq + RAY_IMAGES, num = 2 * t->num + (mass ? t->num * (t->num + 1) / 2 : 0);
  const PetscInt  m = f->m;
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
  b.num = num, b.nq = nq, b.na = D * f->s.num;
  PetscCall(ContactRayRule(f, o, mortar->order, &points, &point, &weight));
  PetscCall(ContactGrow(points * (num + nq + b.na + m * num) + m * (m + 1) * num, sizeof(PetscReal), &w->size_buffer, &w->buffer));
  PetscCall(ContactGrow(w->num_places + simplices * points, sizeof(RayPlace), &w->size_places, &w->place));
  b.weight = w->buffer, b.gap = b.weight + points * num, b.area = b.gap + points * nq, b.along = b.area + points * b.na;
  b.corner = b.along + points * m * num;
  for (PetscInt i = 0; i < num; i++) q[i] = 0;
  for (PetscInt i = 0; i < t->num; i++) b.reach[i] = 0;
  if (derivatives) {
    PetscCall(PetscArrayzero(dq, num * width));
    ContactRayMoves(f, o, move);
  }
  ContactRayGuess(f, mortar, o, &guess);
  for (PetscInt j = 0; j < simplices; j++) {
    RaySimplex s;

    ContactRaySimplex(f, o, j, &s);
    *good = Batch_Private(w, mortar, o, t, &guess, &s, points, point, weight, mass, derivatives, &r, &b);
    if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
    for (PetscInt i = 0; i < num; i++) q[i] += s.size * b.mean[i];
    if (!derivatives) continue;
    ContactRayProducts(points, s.size, t->num, b.weight, num, nq, b.gap, nq, dq, width);
    ContactRayProducts(points, s.size, num - t->num, b.weight + t->num, num, b.na, b.area, b.na, dq + t->num * width, width);
    PetscCall(PetscArrayzero(b.corner, m * (m + 1) * num));
    ContactRayProducts(points, s.size, m + 1, point[0], 3, m * num, b.along, m * num, b.corner, m * num);
    for (PetscInt v = 0; v <= m; v++)
      for (PetscInt c = 0; c < m; c++) {
        const PetscReal *along = move[s.corner[v]].d[c], *corner = b.corner + (m * v + c) * num, d = s.d[m * v + c];

        for (PetscInt i = 0; i < num; i++)
          for (int l = 0; l < RAY_IMAGES; l++) dq[i * width + nq + l] += (corner[i] + b.mean[i] * d) * along[l];
      }
  }
  for (PetscInt i = 0; i < t->num; i++) w->reach[t->place[i]] += b.reach[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactRayMoments(ContactPair pair, const ContactSurface *mortar, PetscBool mass, PetscBool derivatives)
{
  RayWork         w  = pair->ray;
  const RayFacet *f  = &w->facet;
  const PetscInt  na = f->s.num, own = na + f->nv;
  PetscReal       q[RAY_MOMENTS];
  PetscInt        place[3 * (2 * RAY_LATTICE + 4) + RAY_IMAGES], kept = 0;
  RayLattice      facet;

  PetscFunctionBegin;
  w->num_moments = 2 * na + (mass ? na * (na + 1) / 2 : 0);
  w->covered = 0, w->min_gap = PETSC_MAX_REAL;
  PetscCall(PetscArrayzero(w->reach, na));
  PetscCall(PetscArrayzero(w->q, w->num_moments));
  if (derivatives) {
    PetscCall(ContactGrow(w->num_moments * w->n, sizeof(PetscReal), &w->size_dq, &w->dq));
    PetscCall(PetscArrayzero(w->dq, w->num_moments * w->n));
  }
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    const RayTest  *t       = &w->test[w->window[k]];
    const PetscReal covered = w->covered, gap = w->min_gap;
    const PetscInt  places = w->num_places;
    PetscBool       good;
    PetscInt        num, width;

    ContactRayLatticeGather(mortar, w->mortar[k], &facet);
    num   = 2 * t->num + (mass ? t->num * (t->num + 1) / 2 : 0);
    width = f->D * (own + facet.num) + RAY_IMAGES;
    PetscCall(ContactGrow(num * width, sizeof(PetscReal), &w->size_part, &w->part));
    PetscCall(Overlap_Private(w, &facet, k, mass, derivatives, q, w->part, &good));
    if (!good) {
      w->covered = covered, w->min_gap = gap, w->num_places = places;
      pair->num_degenerate++;
      continue;
    }
    ContactRayPlaces(w, mortar, k, facet.num, place);
    for (PetscInt i = 0; i < num; i++) {
      const PetscInt row = i < 2 * t->num ? na * (i / t->num) + t->place[i % t->num] : i;

      w->q[row] += q[i];
      for (PetscInt l = 0; derivatives && l < width - RAY_IMAGES + f->m * f->nv; l++) w->dq[row * w->n + place[l]] += w->part[i * width + l];
    }
    w->overlap[kept]  = w->overlap[k];
    w->window[kept]   = w->window[k];
    w->mortar[kept++] = w->mortar[k];
  }
  w->num_overlaps = kept;
  if (derivatives) ContactImagesFold(w, w->num_moments, w->dq, w->n);
  PetscFunctionReturn(PETSC_SUCCESS);
}
