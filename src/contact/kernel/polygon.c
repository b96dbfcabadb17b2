/* Polygons of the chart, how their corners move, their simplices and quadrature.

   Corners are fixed, images, or crossings C = Y_a + t e of an image's side e = Y_b - Y_a with a fixed line nu: dt = -nu . ((1 - t) dY_a + t dY_b) / nu.e,
   half of d2C = dt (de - e nu.de / nu.e).

   Where both meet at a small angle the crossing runs along them with the angle's inverse, and what rounding and quadrature leave in derivatives by its place
   with it (quadrature of facets of order 4: 1e-10 over the angle): two meshes whose lines nearly lie on each other would press by forces that flicker. Such a
   crossing is taken as two corners at one place, the first of which rests on the line, V = 0, and the second goes with a point of the side, V = (1 - t) dY_a +
   t dY_b. Nothing lies between them, and as derivatives of an integral depend on how the sides move across themselves, first derivatives are exact,
   dF = sum_k F,k . V_k. Their change has besides F,kl V_k V_l what comes of the place's motion P along both lines, F,kl V_k . (P - V)_l + F,k . dV_k, dV = dt
   (dY_b - dY_a), symmetric but for quadrature. Where lines coincide but for rounding there is no such place, and it is left out. */
#include "kernelimpl.h"
#include <petscblaslapack.h>
#include <petscdt.h>

#define MOST_POINTS 144
#define SMALL 0.01 /* sine of an angle: lines that meet at less lie nearly on each other */

enum { JOINT = 8 }; /* name of the line between the two corners at one place */

/* W[nl][nr] += factor sum_k left[k][nl] right[k][nr] */
void ContactRayProducts(PetscInt num, PetscReal factor, PetscInt nl, const PetscReal left[], PetscInt ldl, PetscInt nr, const PetscReal right[], PetscInt ldr,
                        PetscReal W[], PetscInt ldw)
{
  const PetscBLASInt m = (PetscBLASInt)nr, n = (PetscBLASInt)nl, k = (PetscBLASInt)num, lda = (PetscBLASInt)ldr, ldb = (PetscBLASInt)ldl,
                     ldc = (PetscBLASInt)ldw;
  const PetscReal one    = 1;

  if (num == 0 || nl == 0 || nr == 0) return;
  BLASgemm_("N", "T", &m, &n, &k, &factor, right, &lda, left, &ldb, &one, W, &ldc);
}

/* ---- quadrature ---------------------------------------------------------------------------------------------------------------------- */

/* Barycentric points and weights, Gauss' on intervals, symmetric on triangles, up to degree 20 of least number. What is integrated between flat parallelograms
   is a polynomial of degree 2 order_s + 2 order_m at most, 4 order_s where it is a derivative by the facet's own nodes; two degrees more than the first, at
   least, are for others, and on triangles no rule is of less than degree 11. Node to segment: the node. */
PetscErrorCode ContactRayRule(const RayFacet *f, const Overlap *o, PetscInt mortar_order, PetscInt *num, const PetscReal (**point)[3], const PetscReal **weight)
{
  static const PetscReal End[2][3] = {{1, 0, 0}, {0, 1, 0}}, Half = 0.5;
  static PetscReal       P[2][RAY_ORDER + 5][MOST_POINTS][3], Q[2][RAY_ORDER + 5][MOST_POINTS];
  static PetscInt        N[2][RAY_ORDER + 5];
  const PetscInt         m = f->m, half = PetscMax(f->s.order + mortar_order + 1, 2 * f->s.order);
  const PetscInt         n = PetscMin(m == 1 ? half + 2 : PetscMax(half, 5) + 1, RAY_ORDER + 4);
  PetscReal(*const p)[3]   = P[m - 1][n];
  const PetscReal *x, *w;
  PetscQuadrature  rule;

  PetscFunctionBegin;
  *num = N[m - 1][n], *point = (const PetscReal(*)[3])p, *weight = Q[m - 1][n];
  if (o->node >= 0) *num = 1, *point = End + o->node, *weight = &Half;
  if (*num) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscDTSimplexQuadrature(m, 2 * n - 1, PETSCDTSIMPLEXQUAD_DEFAULT, &rule));
  PetscCall(PetscQuadratureGetData(rule, NULL, NULL, num, &x, &w));
  PetscCheck(*num <= MOST_POINTS, PETSC_COMM_SELF, PETSC_ERR_PLIB, "quadrature rule of %" PetscInt_FMT " points", *num);
  N[m - 1][n] = *num;
  for (PetscInt k = 0; k < *num; k++) {
    p[k][1]        = 0.5 * (1 + x[m * k]);
    p[k][2]        = m == 2 ? 0.5 * (1 + x[2 * k + 1]) : 0;
    p[k][0]        = 1 - p[k][1] - p[k][2];
    Q[m - 1][n][k] = 0.5 * w[k];
  }
  PetscCall(PetscQuadratureDestroy(&rule));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- polygons ------------------------------------------------------------------------------------------------------------------------ */

/* Sine of the angle between lines a and b, one of either facet. */
static PetscReal Sine_Private(const Overlap *o, int a, int b)
{
  const PetscReal *p = o->side[a / 4].Y[a % 4], *P = o->side[a / 4].Y[(a + 1) % 4], *q = o->side[b / 4].Y[b % 4], *Q = o->side[b / 4].Y[(b + 1) % 4];
  const PetscReal  d[2] = {P[0] - p[0], P[1] - p[1]}, e[2] = {Q[0] - q[0], Q[1] - q[1]};

  return PetscAbsReal(Cross2(d, e)) / PetscSqrtReal(Dot2(d, d) * Dot2(e, e));
}

static void Crossing_Private(const Overlap *o, PetscInt k, int side, int image, RayMove *move)
{
  const PetscReal *p = o->side[0].Y[side], *P = o->side[0].Y[(side + 1) % 4], *a = o->side[1].Y[image], *b = o->side[1].Y[(image + 1) % 4];
  const PetscReal  nu[2] = {p[1] - P[1], P[0] - p[0]}, e[2] = {b[0] - a[0], b[1] - a[1]}, det = Dot2(nu, e), r[2] = {p[0] - a[0], p[1] - a[1]};
  const PetscReal  size = PetscSqrtReal(Dot2(nu, nu));
  PetscReal        t;

  if (PetscAbsReal(det) <= CONTACT_ROUND * size * PetscSqrtReal(Dot2(e, e))) return;
  t = Dot2(nu, r) / det;
  for (int i = 0; i < 2; i++)
    if (PetscAbsReal(a[i] + t * e[i] - o->v[k][i]) > CONTACT_GRAZE * size) return; /* it was not taken: clip.c */
  move->a = image, move->b = (image + 1) % 4;
  for (int i = 0; i < 2; i++) {
    move->e[i]  = e[i];
    move->nu[i] = nu[i] / det;
  }
  for (int i = 0; i < 2; i++) {
    move->dt[2 * move->a + i] = -(1 - t) * move->nu[i];
    move->dt[2 * move->b + i] = -t * move->nu[i];
  }
  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < RAY_IMAGES; j++) move->d[i][j] = e[i] * move->dt[j];
    move->d[i][2 * move->a + i] += 1 - t;
    move->d[i][2 * move->b + i] += t;
  }
}

/* One of two corners at a place: the one that goes with a point of the image's side, or the one that rests. */
static void Joint_Private(const Overlap *o, PetscInt k, int side, int image, PetscBool along, RayMove *move)
{
  const int        next = (image + 1) % 4;
  const PetscReal *a = o->side[1].Y[image], *b = o->side[1].Y[next], e[2] = {b[0] - a[0], b[1] - a[1]}, r[2] = {o->v[k][0] - a[0], o->v[k][1] - a[1]};
  const PetscReal  t        = Dot2(r, e) / Dot2(e, e);
  RayMove          crossing = {.a = -1};

  for (int i = 0; i < 2 && along; i++) {
    move->d[i][2 * image + i] = 1 - t;
    move->d[i][2 * next + i]  = t;
  }
  if (Sine_Private(o, side, 4 + image) > ROUND_LENGTH) Crossing_Private(o, k, side, image, &crossing);
  if (crossing.a < 0) return;
  move->slips = PETSC_TRUE;
  for (int j = 0; j < RAY_IMAGES; j++) {
    for (int i = 0; i < 2; i++) move->slip[i][j] = 0.5 * (crossing.d[i][j] - move->d[i][j]);
    move->dt[j] = 0.5 * crossing.dt[j];
  }
  if (along) move->a = image, move->b = next;
}

void ContactRaySplit(const RayFacet *f, const Overlap *o, Overlap *to)
{
  *to = *o;
  if (f->m == 1) return;
  to->num = 0;
  for (PetscInt k = 0; k < o->num; k++) {
    const int       a = o->line[(k + o->num - 1) % o->num], b = o->line[k];
    const PetscBool split = (PetscBool)(a / 4 != b / 4 && to->num + o->num - k < FACET_VERTICES && Sine_Private(o, a, b) < SMALL);

    for (int twice = split ? 1 : 0; twice >= 0; twice--) {
      for (int i = 0; i < 2; i++) to->v[to->num][i] = o->v[k][i];
      to->line[to->num++] = twice ? JOINT : o->line[k];
    }
  }
}

void ContactRayMoves(const RayFacet *f, const Overlap *o, RayMove move[])
{
  for (PetscInt k = 0; k < o->num; k++) {
    const int a = o->line[(k + o->num - 1) % o->num], b = o->line[k];

    memset(&move[k], 0, sizeof(RayMove));
    move[k].a = -1;
    if (f->m == 1) {
      if (k < 2 && b >= 0) move[k].d[0][b] = 1; /* one number for each image */
      continue;
    }
    if (a == JOINT || b == JOINT) {
      const int line = a == JOINT ? b : a, other = a == JOINT ? o->line[(k + o->num - 2) % o->num] : o->line[(k + 1) % o->num];

      Joint_Private(o, k, PetscMin(line, other), PetscMax(line, other) % 4, (PetscBool)(line >= 4), &move[k]);
    } else if (a >= 4 && b >= 4) {
      const int image = (a + 1) % 4 == b % 4 ? b % 4 : a % 4;

      for (int i = 0; i < 2; i++) move[k].d[i][2 * image + i] = 1;
    } else if (a >= 4 || b >= 4)
      Crossing_Private(o, k, a < 4 ? a : b, (a < 4 ? b : a) % 4, &move[k]);
  }
}

PetscInt ContactRaySimplices(const RayFacet *f, const Overlap *o)
{
  return f->m == 1 ? 1 : o->num - 2;
}

void ContactRaySimplex(const RayFacet *f, const Overlap *o, PetscInt k, RaySimplex *s)
{
  s->corner[0] = 0, s->corner[1] = k + 1, s->corner[2] = k + 2;
  if (f->m == 1) {
    s->size = o->v[1][0] - o->v[0][0];
    s->d[0] = -1, s->d[1] = 1;
    return;
  }
  const PetscReal *a = o->v[0], *b = o->v[k + 1], *c = o->v[k + 2], x[3] = {a[0], b[0], c[0]}, y[3] = {a[1], b[1], c[1]};

  s->size = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
  for (int i = 0; i < 3; i++) {
    s->d[2 * i]     = 0.5 * (y[(i + 1) % 3] - y[(i + 2) % 3]);
    s->d[2 * i + 1] = 0.5 * (x[(i + 2) % 3] - x[(i + 1) % 3]);
  }
}

void ContactRayGuess(const RayFacet *f, const RayLattice *mortar, const Overlap *o, RayGuess *g)
{
  RayPoint r;

  r.eta[0] = r.eta[1] = 0;
  for (PetscInt v = 0; v < (f->m == 1 ? 2 : o->num); v++) {
    PetscReal xi[2] = {0, 0};

    if (!ContactChartLocate(f, o->v[v], xi)) xi[0] = xi[1] = 0;
    const PetscBool met = ContactRaySolve(f, mortar, xi, 1, &r);

    if (!met) r.eta[0] = r.eta[1] = 0;
    for (PetscInt j = 0; j < f->m; j++) {
      PetscReal along[3];

      for (int c = 0; c < 3; c++) along[c] = r.t[j][c] + r.s * r.di[j][c];
      for (PetscInt i = 0; i < f->m; i++) g->slope[v][i][j] = met ? Dot3(r.zeta[i], along) : 0;
    }
    for (int i = 0; i < 2; i++) g->xi[v][i] = xi[i], g->eta[v][i] = r.eta[i];
  }
}

/* First guesses: xi linear between the corners, eta the quadratic polynomial that its values and slopes there suggest. */
PetscBool ContactRayPoint(const RayFacet *f, const RayLattice *mortar, const Overlap *o, const RayGuess *g, const RaySimplex *s, const PetscReal beta[3],
                          int depth, RayPoint *r)
{
  PetscReal Y[2] = {0, 0}, xi[2] = {0, 0};

  r->eta[0] = r->eta[1] = 0;
  for (PetscInt k = 0; k <= f->m; k++) {
    const PetscInt at = s->corner[k];

    for (PetscInt i = 0; i < f->m; i++) {
      Y[i] += beta[k] * o->v[at][i];
      xi[i] += beta[k] * g->xi[at][i];
    }
  }
  if (!ContactChartLocate(f, Y, xi)) return PETSC_FALSE;
  for (PetscInt k = 0; k <= f->m; k++) {
    const PetscInt at = s->corner[k];

    for (PetscInt i = 0; i < f->m; i++) {
      PetscReal eta = g->eta[at][i];

      for (PetscInt j = 0; j < f->m; j++) eta += 0.5 * g->slope[at][i][j] * (xi[j] - g->xi[at][j]);
      r->eta[i] += beta[k] * eta;
    }
  }
  return ContactRaySolve(f, mortar, xi, depth, r);
}

/* Places of an overlap's numbers among the facet's: of its three groups of nodes, component by component, then m for each image. */
void ContactRayPlaces(const RayWork w, const ContactSurface *mortar, PetscInt overlap, PetscInt nb, PetscInt place[])
{
  const RayFacet *f = &w->facet;
  const PetscInt  D = f->D, own = f->s.num + f->nv, images = D * (own + w->num_mortar);
  PetscInt        at;
  FacetLattice    l;

  for (PetscInt c = 0; c < D; c++) {
    for (PetscInt a = 0; a < f->s.num; a++) place[c * f->s.num + a] = D * a + c;
    for (PetscInt v = 0; v < f->nv; v++) place[D * f->s.num + c * f->nv + v] = D * (f->s.num + v) + c;
  }
  ContactFacetLattice(mortar, w->mortar[overlap], &l);
  for (PetscInt b = 0; b < nb; b++) {
    for (at = 0; at < w->num_mortar && w->vertex[at] != l.node[b]; at++) continue;
    for (PetscInt c = 0; c < D; c++) place[D * own + c * nb + b] = D * (own + at) + c;
  }
  for (PetscInt k = 0; k < f->nv; k++) {
    for (at = 0; at < w->num_images && w->image[at].node != w->overlap[overlap].corner[k]; at++) continue;
    for (PetscInt i = 0; i < f->m; i++) place[D * (own + nb) + f->m * k + i] = images + f->m * at + i;
  }
}

PetscErrorCode ContactRayWalk(RayWork w, const ContactSurface *surface, RayPointFunction function, void *context)
{
  const RayFacet *f     = &w->facet;
  const RayPlace *place = w->places;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    Overlap    o;
    RayLattice mortar;
    PetscInt   column[3 * (2 * RAY_LATTICE + 4) + RAY_IMAGES], points;
    const PetscReal(*point)[3], *weight;

    ContactRaySplit(f, &w->overlap[k], &o);
    ContactRayLatticeGather(surface, w->mortar[k], &mortar);
    ContactRayPlaces(w, surface, k, mortar.num, column);
    PetscCall(ContactRayRule(f, &o, mortar.order, &points, &point, &weight));
    for (PetscInt q = 0; q < points * ContactRaySimplices(f, &o); q++, place++) {
      RaySimplex s;
      RayPoint   r;

      ContactRaySimplex(f, &o, q / points, &s);
      PetscCheck(ContactRayAgain(f, &mortar, place, 1, &r), PETSC_COMM_SELF, PETSC_ERR_PLIB, "a ray that met the mortar facet does not meet it again");
      PetscCall(function(context, w, k, column, mortar.num, place, &r, s.size * weight[q % points] * ContactRayArea(&r) / r.chart.det));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
