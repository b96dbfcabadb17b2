/* Half Hessian of a weighted sum of moments of one facet: W with H = W + W^T.

   Triangle: size (S F)'' / 2 with F the mean of the integrand by the numbers at fixed xi (products of rows, gathered for all points), and by xi, which follow
   the corners: dxi = J^-1 sum beta_k dC_k, d2xi = -2 J^-1 Y,12 dxi_1 dxi_2. Corners then follow the images (polygon.c), images the nodes (image.c). */
#include "kernelimpl.h"

#define CORNERS (2 * FACET_VERTICES)

/* v_f eps_cef into W[row + c][column + e]; v_f: `apart` apart */
static void AddSkew_Private(PetscInt D, const PetscReal v[], PetscInt apart, PetscReal *W, PetscInt n)
{
  const PetscReal z = v[2 * apart];

  W[1] += z, W[n] -= z;
  if (D == 2) return;
  W[n + 2] += v[0], W[2 * n + 1] -= v[0];
  W[2 * n] += v[apart], W[2] -= v[apart];
}

/* Weight of the gap at a point. */
static void Weight_Private(const RayFacet *f, const RayFunctions *S, const PetscReal y[], RayWeight *phi)
{
  memset(phi, 0, sizeof(*phi));
  for (PetscInt a = 0; a < f->s.num; a++) {
    phi->v += y[a] * S->N[a];
    for (PetscInt i = 0; i < f->m; i++) phi->d[i] += y[a] * S->d[i][a];
    for (PetscInt i = 0; i < 2 * f->m - 1; i++) phi->dd[i] += y[a] * S->dd[i][a];
  }
}

/* Sums over the points of a triangle; rows of left and right follow one another. */
typedef struct {
  PetscInt   nq, nf, no, num_points, num_own, num_xi;
  PetscReal *basis, *right;                                     /* [points][nf], [D][points][nq] */
  PetscReal *turn_left, *turn_right, *twist_left, *twist_right; /* [points] [nv], [3][nodes], [nodes], [3][nodes] */
  PetscReal *own_left, *own_right;                              /* [num_own][no] */
  PetscReal *left_xi, *right_xi;                                /* [num_xi][6], [num_xi][nq + 6] */
  PetscReal *gradient, mean;                                    /* [nq + 6] */
} Batch;

/* d_v . (dx_a x turn[v][.][a]), twist[a][.][b] . (dx_a x dx_b) */
typedef struct {
  PetscReal *turn, *twist;
} Pairs;

/* What varies through the corners: rows left_xi x right_xi. */
static void Corners_Private(const RayFacet *f, const RayPoint *r, const PetscReal beta[3], const RaySecond *o, Batch *b)
{
  const PetscInt m = f->m, nc   = m * (m + 1);
  PetscReal      G[2][2], *left = b->left_xi + 6 * b->num_xi;

  for (PetscInt i = 0; i < m; i++)
    for (PetscInt j = 0; j < m; j++) {
      G[i][j] = o->xixi[i + j];
      if (i == j) continue;
      for (PetscInt k = 0; k < m; k++) G[i][j] -= o->xi[k] * Dot2(r->chart.inverse[k], r->chart.mixed);
    }
  for (PetscInt i = 0; i < m; i++)
    for (PetscInt v = 0; v <= m; v++)
      for (PetscInt c = 0; c < m; c++) left[6 * i + m * v + c] = r->chart.inverse[i][c] * beta[v];
  for (PetscInt i = 0; i < m; i++, b->num_xi++) {
    PetscReal *right = b->right_xi + (b->nq + 6) * b->num_xi;

    for (PetscInt k = 0; k < nc; k++) {
      right[b->nq + k] = 0;
      for (PetscInt j = 0; j < m; j++) right[b->nq + k] += 0.5 * G[i][j] * left[6 * j + k];
      b->gradient[b->nq + k] += o->xi[i] * left[6 * i + k];
    }
  }
}

/* place: where the rays met when the moments were found. share: factor of the weight of the
   covered share besides. */
static PetscErrorCode Batch_Private(const RayWork w, const RayLattice *mortar, const RaySimplex *s, PetscInt points, const PetscReal point[][3],
                                    const PetscReal weight[], const PetscReal y[], PetscReal share, const RayPlace place[], RayPoint *r, RaySecond *second,
                                    Batch *b)
{
  const RayFacet *f  = &w->facet;
  const PetscInt  na = f->s.num;
  RayWeight       sum, phi, rho, sigma;

  PetscFunctionBegin;
  b->num_points = points;
  b->num_own = b->num_xi = 0;
  b->mean                = 0;
  for (PetscInt i = 0; i < b->nq + 6; i++) b->gradient[i] = 0;
  for (PetscInt k = 0; k < points; k++) {
    PetscCheck(ContactRayAgain(f, mortar, &place[k], 3, r), PETSC_COMM_SELF, PETSC_ERR_PLIB, "a ray that met the mortar facet does not meet it again");
    Weight_Private(f, &r->S, y, &sum);
    ContactRayOverDet(f, &r->chart, weight[k], &sum, &phi);
    ContactShareWeight(f->m, r->xi, &rho.v, rho.d, rho.dd);
    ContactRayOverDet(f, &r->chart, share * weight[k], &rho, &sigma);
    second->basis       = b->basis + k * b->nf;
    second->turn_left   = b->turn_left + k * f->nv;
    second->turn_right  = b->turn_right + k * 3 * na;
    second->twist_left  = b->twist_left + k * na;
    second->twist_right = b->twist_right + k * 3 * na;
    for (PetscInt c = 0; c < f->D; c++) second->right[c] = b->right + (c * points + k) * b->nq;
    second->own_left  = b->own_left + b->num_own * b->no;
    second->own_right = b->own_right + b->num_own * b->no;
    for (PetscInt i = 0; i < f->m; i++) second->mixed[i] = b->right_xi + (b->num_xi + i) * (b->nq + 6);
    ContactRaySecond(f, mortar, r, &phi, s->size, second);
    b->num_own += second->num_own;
    for (PetscInt i = 0; i < f->m; i++) second->xi[i] += sigma.d[i];
    for (PetscInt i = 0; i < 2 * f->m - 1; i++) second->xixi[i] += sigma.dd[i];
    b->mean += phi.v * ContactRayGap(r) + sigma.v;
    for (PetscInt i = 0; i < b->nq; i++) b->gradient[i] += second->gradient[i];
    Corners_Private(f, r, point[k], second, b);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One triangle into all[N][N], N = nq + CORNERS, and the gradient by corners. */
static void Simplex_Private(const RayFacet *f, const RaySimplex *s, const Batch *b, const Pairs *pairs, PetscReal all[], PetscReal corner[])
{
  const PetscInt m = f->m, nc = m * (m + 1), nq = b->nq, N = nq + CORNERS, group[4] = {0, f->s.num, f->s.num + f->nv, b->nf}, points = b->num_points;
  PetscReal     *part = b->gradient + nq + 6; /* [6][nq + 6] */

  for (PetscInt c = 0; c < f->D; c++)
    for (int g = 0; g < 3; g++) {
      const PetscInt from = group[g], num = group[g + 1] - from;

      ContactRayProducts(points, 1, num, b->basis + from, b->nf, nq, b->right + c * points * nq, nq, all + (f->D * from + c * num) * N, N);
    }
  ContactRayProducts(points, 1, f->nv, b->turn_left, f->nv, 3 * f->s.num, b->turn_right, 3 * f->s.num, pairs->turn, 3 * f->s.num);
  if (m == 2) ContactRayProducts(points, 1, f->s.num, b->twist_left, f->s.num, 3 * f->s.num, b->twist_right, 3 * f->s.num, pairs->twist, 3 * f->s.num);
  ContactRayProducts(b->num_own, 1, b->no, b->own_left, b->no, b->no, b->own_right, b->no, all, N);
  for (PetscInt i = 0; i < 6 * (nq + 6); i++) part[i] = 0;
  ContactRayProducts(b->num_xi, s->size, nc, b->left_xi, 6, nq + nc, b->right_xi, nq + 6, part, nq + 6);
  for (PetscInt i = 0; i < nc; i++)
    for (PetscInt k = 0; k < nq + nc; k++) part[i * (nq + 6) + k] += s->d[i] * b->gradient[k];
  for (int i = 0; i < 3 && m == 2; i++) { /* half of the area's second derivatives, each pair once */
    const int next = (i + 1) % 3, last = (i + 2) % 3;

    part[2 * i * (nq + 6) + nq + 2 * next + 1] += 0.5 * b->mean;
    part[2 * i * (nq + 6) + nq + 2 * last + 1] -= 0.5 * b->mean;
  }
  for (PetscInt i = 0; i < nc; i++) {
    const PetscInt at = m * s->corner[i / m] + i % m;

    corner[at] += s->size * b->gradient[nq + i] + b->mean * s->d[i];
    for (PetscInt k = 0; k < nq; k++) all[(nq + at) * N + k] += part[i * (nq + 6) + k];
    for (PetscInt k = 0; k < nc; k++) all[(nq + at) * N + nq + m * s->corner[k / m] + k % m] += part[i * (nq + 6) + nq + k];
  }
}

/* slipped = V^T W S + S^T W V, W the corners' part of all[N][N], V and S how corners move and slip. */
static void Slips_Private(const Overlap *o, const RayMove move[], PetscInt nq, const PetscReal all[], PetscReal slipped[RAY_IMAGES][RAY_IMAGES])
{
  const PetscInt N = nq + CORNERS;

  for (PetscInt v = 0; v < o->num; v++) {
    if (!move[v].slips) continue;
    for (PetscInt i = 2 * v; i < 2 * v + 2; i++)
      for (PetscInt k = 0; k < 2 * o->num; k++) {
        const PetscReal *d = move[k / 2].d[k % 2], *s = move[v].slip[i % 2], below = all[(nq + k) * N + nq + i], above = all[(nq + i) * N + nq + k];

        for (int l = 0; l < RAY_IMAGES; l++)
          for (int j = 0; j < RAY_IMAGES; j++) slipped[l][j] += below * d[l] * s[j] + above * s[l] * d[j];
      }
  }
}

/* From corners to images: all[N][N] -> its first nq + RAY_IMAGES rows and columns. */
static void Collapse_Private(const RayFacet *f, const Overlap *o, const RayMove move[], const PetscReal corner[], PetscInt nq, PetscReal all[])
{
  const PetscInt m = f->m, N = nq + CORNERS, nc = m * (f->m == 1 ? 2 : o->num);
  PetscReal      fold[RAY_IMAGES][CORNERS], row[RAY_IMAGES];
  PetscReal      slipped[RAY_IMAGES][RAY_IMAGES] = {{0}};

  if (m == 2) Slips_Private(o, move, nq, all, slipped);
  for (PetscInt i = 0; i < nc; i++)
    for (int l = 0; l < RAY_IMAGES; l++) fold[l][i] = move[i / m].d[i % m][l];
  for (PetscInt i = nq; i < nq + nc; i++) {
    for (int l = 0; l < RAY_IMAGES; l++) {
      row[l] = 0;
      for (PetscInt k = 0; k < nc; k++) row[l] += all[i * N + nq + k] * fold[l][k];
    }
    for (int l = 0; l < RAY_IMAGES; l++) all[i * N + nq + l] = row[l];
  }
  for (PetscInt k = 0; k < nq + RAY_IMAGES; k++) {
    for (int l = 0; l < RAY_IMAGES; l++) {
      row[l] = 0;
      for (PetscInt i = 0; i < nc; i++) row[l] += fold[l][i] * all[(nq + i) * N + k];
    }
    for (int l = 0; l < RAY_IMAGES; l++) all[(nq + l) * N + k] = row[l];
  }
  for (int l = 0; l < RAY_IMAGES; l++)
    for (int j = 0; j < RAY_IMAGES; j++) all[(nq + l) * N + nq + j] += slipped[l][j];
  for (PetscInt v = 0; v < o->num && m == 2; v++) { /* curvature of crossings */
    const RayMove  *c    = &move[v];
    const PetscReal w[2] = {corner[2 * v], corner[2 * v + 1]};

    if (c->a < 0) continue;
    for (int i = 0; i < 2; i++) {
      const PetscReal value = w[i] - Dot2(w, c->e) * c->nu[i];

      for (int l = 0; l < RAY_IMAGES; l++) {
        all[(nq + l) * N + nq + 2 * c->b + i] += c->dt[l] * value;
        all[(nq + l) * N + nq + 2 * c->a + i] -= c->dt[l] * value;
      }
    }
  }
}

/* *place: the overlap's first; moves on to the next one's. */
static PetscErrorCode Overlap_Private(RayWork w, const RayLattice *mortar, PetscInt k, const PetscReal y[], PetscReal share, const RayPlace **place,
                                      const Pairs *pairs, PetscReal all[], PetscReal gradient[])
{
  const RayFacet *f  = &w->facet;
  const PetscInt  na = f->s.num, nq = f->D * (na + f->nv + mortar->num);
  Overlap         split;
  const Overlap  *o               = &split;
  PetscReal       corner[CORNERS] = {0};
  RayMove         move[FACET_VERTICES];
  RaySecond       second;
  RayPoint        r;
  PetscInt        points;
  const PetscInt  own = f->D + 2; /* most products of numbers of the facet at a point: of its radius, of the length that is closed */
  Batch           b   = {.nq = nq, .nf = nq / f->D, .no = f->D * (na + f->nv)};
  const PetscReal(*point)[3], *weight;

  PetscFunctionBegin;
  ContactRaySplit(f, &w->overlap[k], &split);
  PetscCall(ContactRayRule(f, o, mortar->order, &points, &point, &weight));
  PetscCall(ArrayGrow(points * (b.nf + f->D * nq + 2 * own * b.no + f->m * (nq + 12) + f->nv + 7 * na) + 8 * (nq + 6), sizeof(PetscReal), &w->size_buffer,
                      &w->buffer));
  b.basis         = w->buffer;
  b.right         = b.basis + points * b.nf;
  b.own_left      = b.right + points * f->D * nq;
  b.own_right     = b.own_left + points * own * b.no;
  b.left_xi       = b.own_right + points * own * b.no;
  b.right_xi      = b.left_xi + points * f->m * 6;
  b.turn_left     = b.right_xi + points * f->m * (nq + 6);
  b.turn_right    = b.turn_left + points * f->nv;
  b.twist_left    = b.turn_right + points * 3 * na;
  b.twist_right   = b.twist_left + points * na;
  second.gradient = b.twist_right + points * 3 * na;
  b.gradient      = second.gradient + nq + 6;
  ContactRayMoves(f, o, move);
  for (PetscInt j = 0; j < ContactRaySimplices(f, o); j++) {
    RaySimplex s;

    ContactRaySimplex(f, o, j, &s);
    PetscCall(Batch_Private(w, mortar, &s, points, point, weight, y, share, *place, &r, &second, &b));
    *place += points;
    Simplex_Private(f, &s, &b, pairs, all, corner);
    for (PetscInt i = 0; i < nq; i++) gradient[i] += s.size * b.gradient[i];
  }
  for (PetscInt i = 0; i < f->m * (f->m == 1 ? 2 : o->num); i++)
    for (int l = 0; l < RAY_IMAGES; l++) gradient[nq + l] += corner[i] * move[i / f->m].d[i % f->m][l];
  Collapse_Private(f, o, move, corner, nq, all);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pairs of nodes of the facet. */
static void AddPairs_Private(RayWork w, const Pairs *pairs)
{
  const RayFacet *f = &w->facet;
  const PetscInt  D = f->D, na = f->s.num, n = w->n;

  for (PetscInt a = 0; a < na; a++) {
    for (PetscInt v = 0; v < f->nv; v++) AddSkew_Private(D, pairs->turn + 3 * v * na + a, na, w->W + D * (na + v) * n + D * a, n);
    for (PetscInt b = 0; b < na && f->m == 2; b++) AddSkew_Private(D, pairs->twist + 3 * a * na + b, na, w->W + D * a * n + D * b, n);
  }
}

/* Curvature of an image: of the numbers of lattice and directions and of its vertex. */
static PetscErrorCode Image_Private(RayWork w, PetscInt k, const PetscReal gradient[])
{
  const RayFacet *f = &w->facet;
  const PetscInt  D = f->D, own = D * (f->s.num + f->nv), width = own + D, n = w->n;
  const PetscReal along[2] = {gradient[0], f->m == 2 ? gradient[1] : 0};
  PetscInt        at       = 0;

  PetscFunctionBegin;
  if (along[0] == 0 && along[1] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  while (w->vertex[at] != w->image[k].node) at++;
  PetscCall(ArrayGrow(width * width + 4 * width, sizeof(PetscReal), &w->size_part, &w->part));
  PetscCall(PetscArrayzero(w->part, width * width));
  ContactImageCurvature(f, &w->image[k], f->s.num + f->nv, along, width, w->part, w->part + width * width);
  for (PetscInt i = 0; i < width; i++)
    for (PetscInt j = 0; j < width; j++) w->W[(i < own ? i : i + D * at) * n + (j < own ? j : j + D * at)] += w->part[i * width + j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a half form: the other half. */
static void Transpose_Private(PetscInt n, PetscReal W[])
{
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < i; j++) {
      const PetscReal value = W[i * n + j];

      W[i * n + j] = W[j * n + i];
      W[j * n + i] = value;
    }
}

PetscErrorCode ContactRayHessian(ContactPair pair, const ContactSurface *mortar, const PetscReal y[], PetscReal share, PetscReal gradient[])
{
  RayWork         w   = pair->ray;
  const RayFacet *f   = &w->facet;
  const PetscInt  own = f->s.num + f->nv, images = f->D * (own + w->num_mortar), n = w->n, pairs = f->s.num * own;
  PetscInt        place[3 * (2 * RAY_LATTICE + 4) + RAY_IMAGES];
  const RayPlace *at = w->places;
  RayLattice      facet;
  Pairs           pair_sums;
  PetscReal      *slope;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(gradient, n));
  PetscCall(ArrayGrow(n * n, sizeof(PetscReal), &w->size_W, &w->W));
  PetscCall(PetscArrayzero(w->W, n * n));
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    PetscInt N, width;

    ContactRayLatticeGather(mortar, w->mortar[k], &facet);
    N     = f->D * (own + facet.num) + CORNERS;
    width = N - CORNERS + f->m * f->nv;
    PetscCall(ArrayGrow(N * N + 3 * pairs + N, sizeof(PetscReal), &w->size_part, &w->part));
    PetscCall(PetscArrayzero(w->part, N * N + 3 * pairs + N));
    pair_sums.turn  = w->part + N * N;
    pair_sums.twist = pair_sums.turn + 3 * f->nv * f->s.num;
    slope           = pair_sums.turn + 3 * pairs;
    PetscCall(Overlap_Private(w, &facet, k, y, share, &at, &pair_sums, w->part, slope));
    AddPairs_Private(w, &pair_sums);
    ContactRayPlaces(w, mortar, k, facet.num, place);
    for (PetscInt a = 0; a < width; a++) gradient[place[a]] += slope[a];
    for (PetscInt a = 0; a < width; a++)
      for (PetscInt b = 0; b < width; b++) w->W[place[a] * n + place[b]] += w->part[a * N + b];
  }
  ContactImagesFold(w, n, w->W, n);
  Transpose_Private(n, w->W);
  ContactImagesFold(w, n, w->W, n);
  ContactImagesFold(w, 1, gradient, n);
  if (w->frozen) PetscCall(PetscArrayzero(gradient + images, n - images));
  for (PetscInt k = 0; k < w->num_images; k++) PetscCall(Image_Private(w, k, gradient + images + f->m * k));
  PetscFunctionReturn(PETSC_SUCCESS);
}
