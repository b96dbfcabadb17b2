/* Moments int N_a g, int N_a dA, int N_a N_b dA of one facet over its overlaps, with exact first derivatives.

   Polygons are split into triangles (plane: intervals); a Gauss point Y = sum_k beta_k C_k, beta constant, moves with their corners C: dxi = J^-1 dY.
   Integrands per dY carry 1 / det Y,xi. */
#include "rayimpl.h"

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

/* Moments' functions: num that weigh the gap, the same for the area, products for the mass. */
static PetscInt Factors_Private(const RayFacet *f, const RayTest *t, const RayFunctions *T, PetscBool mass, RayWeight w[])
{
  PetscInt num = 0;

  for (int twice = 0; twice < 2; twice++)
    for (PetscInt a = 0; a < t->num; a++, num++) {
      w[num].v = T->N[a];
      for (PetscInt i = 0; i < f->m; i++) w[num].d[i] = T->d[i][a];
    }
  for (PetscInt a = 0; a < t->num && mass; a++)
    for (PetscInt b = a; b < t->num; b++, num++) {
      w[num].v = T->N[a] * T->N[b];
      for (PetscInt i = 0; i < f->m; i++) w[num].d[i] = T->d[i][a] * T->N[b] + T->N[a] * T->d[i][b];
    }
  return num;
}

/* Sums over one simplex. */
typedef struct {
  PetscInt   num, nq;             /* moments, numbers */
  PetscReal *weight, *gap, *area; /* [points][num], [points][nq], [points][nq] */
  PetscReal  mean[RAY_MOMENTS], (*corner)[6];
} Batch;

static PetscBool Batch_Private(RayWork w, const RayLattice *mortar, const Overlap *o, const RayTest *t, const RaySimplex *s, PetscInt points,
                               const PetscReal point[][3], const PetscReal weight[], PetscBool mass, PetscBool derivatives, RayPoint *r, Batch *b)
{
  const RayFacet *f = &w->facet;
  RayFunctions    T;
  RayWeight       factor[RAY_MOMENTS], phi;

  for (PetscInt q = 0; q < b->num; q++) b->mean[q] = 0;
  for (PetscInt k = 0; k < points; k++) {
    PetscReal gap_xi[2], area_xi[2], gap, area, over;

    if (!ContactRayPoint(f, mortar, o, s, point[k], derivatives ? 2 : 1, r)) return PETSC_FALSE;
    gap = ContactRayGap(r), area = ContactRayArea(r), over = weight[k] / r->chart.det;
    w->min_gap = PetscMin(w->min_gap, r->s * r->beta / r->a);
    w->covered += weight[k] * s->size * area / r->chart.det;
    ContactRayTestFunctions(f, t, &r->S, r->xi, &T);
    Factors_Private(f, t, &T, mass, factor);
    if (derivatives) ContactRayFirst(f, mortar, r, b->gap + k * b->nq, b->area + k * b->nq, gap_xi, area_xi);
    for (PetscInt q = 0; q < b->num; q++) {
      const PetscBool isgap = (PetscBool)(q < t->num);

      phi.v = factor[q].v * over;
      for (PetscInt i = 0; i < f->m && derivatives; i++) phi.d[i] = factor[q].d[i] * over - phi.v * r->chart.ddet[i] / r->chart.det;
      b->mean[q] += phi.v * (isgap ? gap : area);
      if (!derivatives) continue;
      b->weight[k * b->num + q] = phi.v;
      for (PetscInt c = 0; c < f->m; c++) {
        PetscReal sum = 0;

        for (PetscInt i = 0; i < f->m; i++) sum += r->chart.inverse[i][c] * (isgap ? phi.v * gap_xi[i] + phi.d[i] * gap : phi.v * area_xi[i] + phi.d[i] * area);
        for (PetscInt j = 0; j <= f->m; j++) b->corner[q][f->m * j + c] += point[k][j] * sum;
      }
    }
  }
  return PETSC_TRUE;
}

/* One overlap: its moments into q[], derivatives by nq + RAY_IMAGES numbers into dq. False: a ray misses. */
static PetscErrorCode Overlap_Private(RayWork w, const RayLattice *mortar, PetscInt k, PetscBool mass, PetscBool derivatives, PetscReal q[], PetscReal dq[],
                                      PetscBool *good)
{
  const RayFacet *f = &w->facet;
  const Overlap  *o = &w->overlap[k];
  const RayTest  *t = &w->test[w->window[k]];
  const PetscInt  D = f->D, nq = D * (f->s.num + f->nv + mortar->num), width = nq + RAY_IMAGES, num = 2 * t->num + (mass ? t->num * (t->num + 1) / 2 : 0);
  PetscReal       corner[RAY_MOMENTS][6], all[FACET_VERTICES][2];
  RayMove         move[FACET_VERTICES];
  Batch           b = {.num = num, .nq = nq, .corner = corner};
  RayPoint        r;
  PetscInt        points;
  const PetscReal(*point)[3], *weight;

  PetscFunctionBegin;
  *good = PETSC_TRUE;
  PetscCall(ContactRayRule(f->m, f->s.order, mortar->order, &points, &point, &weight));
  PetscCall(ContactGrow(points * (num + 2 * nq), sizeof(PetscReal), &w->size_buffer, &w->buffer));
  b.weight = w->buffer, b.gap = b.weight + points * num, b.area = b.gap + points * nq;
  for (PetscInt i = 0; i < num; i++) q[i] = 0;
  if (derivatives) {
    PetscCall(PetscArrayzero(dq, num * width));
    ContactRayMoves(f, o, move);
  }
  r.eta[0] = r.eta[1] = r.s = 0;
  for (PetscInt j = 0; j < ContactRaySimplices(f, o); j++) {
    RaySimplex s;

    ContactRaySimplex(f, o, j, &s);
    memset(corner, 0, (size_t)num * sizeof(corner[0]));
    *good = Batch_Private(w, mortar, o, t, &s, points, point, weight, mass, derivatives, &r, &b);
    if (!*good) PetscFunctionReturn(PETSC_SUCCESS);
    for (PetscInt i = 0; i < num; i++) q[i] += s.size * b.mean[i];
    if (!derivatives) continue;
    ContactRayProducts(points, s.size, t->num, b.weight, num, nq, b.gap, nq, dq, width);
    ContactRayProducts(points, s.size, num - t->num, b.weight + t->num, num, D * f->s.num, b.area, nq, dq + t->num * width, width);
    for (PetscInt i = 0; i < num; i++) {
      memset(all, 0, sizeof(all));
      for (PetscInt v = 0; v <= f->m; v++)
        for (PetscInt c = 0; c < f->m; c++) all[s.corner[v]][c] += s.size * corner[i][f->m * v + c] + b.mean[i] * s.d[f->m * v + c];
      for (PetscInt v = 0; v <= f->m; v++)
        for (PetscInt c = 0; c < f->m; c++)
          for (int l = 0; l < RAY_IMAGES; l++) dq[i * width + nq + l] += all[s.corner[v]][c] * move[s.corner[v]].d[c][l];
    }
  }
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
  w->n           = f->D * (own + w->num_mortar) + f->m * w->num_images;
  w->num_moments = 2 * na + (mass ? na * (na + 1) / 2 : 0);
  w->covered = 0, w->min_gap = PETSC_MAX_REAL;
  PetscCall(PetscArrayzero(w->q, w->num_moments));
  if (derivatives) {
    PetscCall(ContactGrow(w->num_moments * w->n, sizeof(PetscReal), &w->size_dq, &w->dq));
    PetscCall(PetscArrayzero(w->dq, w->num_moments * w->n));
  }
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    const RayTest  *t       = &w->test[w->window[k]];
    const PetscReal covered = w->covered, gap = w->min_gap;
    PetscBool       good;
    PetscInt        num, width;

    ContactRayLatticeGather(mortar, w->mortar[k], &facet);
    num   = 2 * t->num + (mass ? t->num * (t->num + 1) / 2 : 0);
    width = f->D * (own + facet.num) + RAY_IMAGES;
    PetscCall(ContactGrow(num * width, sizeof(PetscReal), &w->size_part, &w->part));
    PetscCall(Overlap_Private(w, &facet, k, mass, derivatives, q, w->part, &good));
    if (!good) {
      w->covered = covered, w->min_gap = gap;
      pair->num_degenerate++;
      continue;
    }
    ContactRayPlaces(w, mortar, w->mortar[k], facet.num, place);
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
  PetscFunctionReturn(PETSC_SUCCESS);
}
