/* Culling of back faces. The far side of a neighbour opposes a facet just like the near side of a body that overlaps its own: a tooth of a thread sees, through
   itself and through the next tooth of the nut, that one's other flank. What tells them apart is how far in they are. Along a ray of the nonmortar facet into
   its body, which meets the mortar facet at depth d, the own body measures t, and the other one, from there back towards the ray's start, t'. If the bodies
   overlap, the mortar facet lies inside the own body or the start inside the other one: d <= max(t, t'). If it is the far side of a body behind, all of both
   lies between: d >= t + t'. So what is deeper than (t + t') / 2 is no overlap.

   Nor is what lies round a corner. Where the edge of one body lies on the other, its side faces the far side of that one, through all of it, along the surface
   on which they touch. There sides of both bodies that face each other run beside the ray: a to one side of its end, b to the other of its start. Across it the
   bodies overlap by a + b; where that is less than d they have met there.

   A body that may meet itself (both sides of a pair are of it) has facets that face each other through itself: there both thicknesses are the depth. Such
   facets see each other at the reference positions along a straight line that does not leave the body. What met across a void does not: between bore and bore,
   or limb and limb, it does.

   Thicknesses are those at the reference positions, along directions that turn with the facets. Whether a body faces itself across its thickness is asked for
   places inside facets: at a re-entrant corner that two facets share a ray leaves by one of them at once (hull.c), though behind it there is body. */
#include "kernelimpl.h"

#define INSIDE (1 - 1. / 64) /* of half a facet: as near to its ends as places are inside it */

enum { MOST_SIDES = 32, LEVELS = 6 }; /* of the search for the ray to the middle of the mortar facet: to 1/32 of the facet */

static void Axes_Private(PetscInt dim, const PetscReal x[4][3], PetscReal axis[3][3])
{
  static const PetscInt node[4] = {0, 1, 2, 3};
  PetscReal            *n       = axis[dim - 1], e[3], flat[4][2], along, length;

  for (int a = 0; a < 4; a++) flat[a][0] = x[a][0], flat[a][1] = x[a][1];
  (void)ContactFacetNormal(dim, dim == 2 ? flat[0] : x[0], node, n);
  for (int c = 0; c < 3; c++) e[c] = x[1][c] - x[0][c];
  along = Dot3(e, n);
  for (int c = 0; c < 3; c++) e[c] -= along * n[c];
  length = PetscSqrtReal(Dot3(e, e));
  for (int c = 0; c < 3; c++) axis[0][c] = e[c] / length;
  if (dim == 3) Cross3(n, axis[0], axis[1]);
}

static void Corners_Private(const ContactSurface *s, PetscInt facet, FacetCorners *p)
{
  const PetscInt dim = p->dim = s->dim;

  p->nv = dim == 2 ? 2 : 4;
  memset(p->x, 0, sizeof(p->x));
  memset(p->X, 0, sizeof(p->X));
  memset(p->d, 0, sizeof(p->d));
  for (PetscInt a = 0; a < p->nv; a++)
    for (PetscInt c = 0; c < dim; c++) {
      p->x[a][c] = s->x[dim * s->facets[p->nv * facet + a] + c];
      p->X[a][c] = s->X[dim * s->facets[p->nv * facet + a] + c];
    }
  Axes_Private(dim, p->x, p->axis);
  Axes_Private(dim, p->X, p->axis0);
}

/* Hats at xi in [-1, 1]^(dim - 1); those of corners that edges do not have are 0. */
static void Hats_Private(const FacetCorners *p, const PetscReal xi[2], PetscReal N[4])
{
  const PetscReal low = p->nv == 2 ? 1 : 0.5 * (1 - xi[1]), high = p->nv == 2 ? 0 : 0.5 * (1 + xi[1]);

  N[0] = 0.5 * (1 - xi[0]) * low;
  N[1] = 0.5 * (1 + xi[0]) * low;
  N[2] = 0.5 * (1 + xi[0]) * high;
  N[3] = 0.5 * (1 - xi[0]) * high;
}

static void Sum_Private(const PetscReal x[4][3], const PetscReal N[4], PetscReal y[3])
{
  for (int c = 0; c < 3; c++) y[c] = N[0] * x[0][c] + N[1] * x[1][c] + N[2] * x[2][c] + N[3] * x[3][c];
}

/* The place on the facet, taken for a parallelogram, that is nearest to y along its sides. */
static void Locate_Private(const FacetCorners *p, const PetscReal y[3], PetscReal xi[2])
{
  PetscReal g[2][3] = {{0, 0, 0}, {0, 0, 0}}, r[3], a[2][2], b[2], det;

  for (int c = 0; c < 3; c++) {
    r[c] = y[c];
    for (PetscInt k = 0; k < p->nv; k++) {
      r[c] -= p->x[k][c] / (PetscReal)p->nv;
      g[0][c] += (k == 1 || k == 2 ? 1 : -1) * p->x[k][c] / (PetscReal)p->nv;
      g[1][c] += (k > 1 ? 1 : -1) * p->x[k][c] / (PetscReal)p->nv;
    }
  }
  for (int i = 0; i < 2; i++) {
    b[i] = Dot3(g[i], r);
    for (int j = 0; j < 2; j++) a[i][j] = Dot3(g[i], g[j]);
  }
  det   = a[0][0] * a[1][1] - a[0][1] * a[1][0];
  xi[0] = p->dim == 2 ? b[0] / a[0][0] : (b[0] * a[1][1] - b[1] * a[0][1]) / det;
  xi[1] = p->dim == 2 ? 0 : (b[1] * a[0][0] - b[0] * a[1][0]) / det;
  for (int i = 0; i < 2; i++) xi[i] = PetscMax(-1, PetscMin(1, xi[i]));
}

/* The place X of xi on the facet of a body, at the reference positions, and what was there the direction d of now: it turns with the facet. */
static void Reference_Private(const FacetCorners *p, const PetscReal xi[2], const PetscReal d[3], PetscReal X[3], PetscReal D[3])
{
  PetscReal N[4];

  Hats_Private(p, xi, N);
  Sum_Private(p->X, N, X);
  D[0] = D[1] = D[2] = 0;
  for (PetscInt k = 0; k < p->dim; k++)
    for (int c = 0; c < 3; c++) D[c] += Dot3(p->axis[k], d) * p->axis0[k][c];
}

/* What the part measures from xi on its facet into it, along d. */
static PetscReal Across_Private(ContactHull hull, PetscInt part, const FacetCorners *p, const PetscReal xi[2], const PetscReal d[3], PetscReal most)
{
  PetscReal X[3], D[3];

  Reference_Private(p, xi, d, X, D);
  return ContactHullAcross(hull, part, X, D, most);
}

/* Sides of the part that run along d and are closer to the place at this depth below xi than the reach; normals as they have turned with the facet. */
static PetscInt Beside_Private(ContactHull hull, PetscInt part, const FacetCorners *p, const PetscReal xi[2], const PetscReal d[3], PetscReal depth,
                               PetscReal reach, HullSide side[MOST_SIDES])
{
  PetscReal X[3], D[3];
  PetscInt  num;

  Reference_Private(p, xi, d, X, D);
  for (int c = 0; c < 3; c++) X[c] += depth * D[c];
  num = ContactHullBeside(hull, part, X, D, reach, MOST_SIDES, side);
  for (PetscInt i = 0; i < num; i++) {
    PetscReal n[3] = {0, 0, 0};

    for (PetscInt k = 0; k < p->dim; k++)
      for (int c = 0; c < 3; c++) n[c] += Dot3(p->axis0[k], side[i].N) * p->axis[k][c];
    for (int c = 0; c < 3; c++) side[i].N[c] = n[c];
  }
  return num;
}

/* Do the bodies overlap less across the ray than along it? Their sides there face each other. */
static PetscBool IsBeside_Private(PetscInt num_a, const HullSide a[], PetscInt num_b, const HullSide b[], PetscReal reach)
{
  for (PetscInt i = 0; i < num_a; i++)
    for (PetscInt j = 0; j < num_b; j++)
      if (a[i].distance + b[j].distance < reach && Dot3(a[i].N, b[j].N) < -CONTACT_OPPOSE) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The ray from xi: its start, its unit direction n; returns the square of the distance at which it passes y. */
static PetscReal Pass_Private(const FacetCorners *s, const PetscReal xi[2], const PetscReal y[3], PetscReal x[3], PetscReal n[3])
{
  PetscReal r[3], N[4], length, along;

  Hats_Private(s, xi, N);
  Sum_Private(s->d, N, n);
  Sum_Private(s->x, N, x);
  length = PetscSqrtReal(Dot3(n, n));
  for (int c = 0; c < 3; c++) n[c] /= length, r[c] = y[c] - x[c];
  along = Dot3(r, n);
  return Dot3(r, r) - along * along;
}

/* The place whose ray passes nearest to y, by trial, since rays may cross behind the facet; its ray. */
static void Aim_Private(const FacetCorners *s, const PetscReal y[3], PetscReal xi[2], PetscReal x[3], PetscReal n[3])
{
  PetscReal least = PETSC_MAX_REAL, step = 1;

  xi[0] = xi[1] = 0;
  for (int level = 0; level < LEVELS; level++, step *= 0.5) {
    const PetscReal from[2] = {xi[0], xi[1]};

    for (int k = 0; k < (s->dim == 2 ? 3 : 9); k++) {
      if (level > 0 && k == (s->dim == 2 ? 1 : 4)) continue; /* where it stands */
      const PetscReal at[2]    = {PetscMax(-1, PetscMin(1, from[0] + (k % 3 - 1) * step)),
                               s->dim == 2 ? 0 : PetscMax(-1, PetscMin(1, from[1] + (k / 3 - 1) * step))};
      const PetscReal distance = Pass_Private(s, at, y, x, n);

      if (distance < least) least = distance, xi[0] = at[0], xi[1] = at[1];
    }
  }
  (void)Pass_Private(s, xi, y, x, n);
}

/* Is all of s in front of the mortar facet? Then no ray of it meets that one at a depth. middle: of the mortar facet. */
static PetscBool IsInFront_Private(const FacetCorners *s, const ContactSurface *mortar, PetscInt other, PetscReal middle[3])
{
  const PetscInt *node = mortar->facets + s->nv * other;
  PetscReal       N[3];

  ContactFacetVector(s->dim, mortar->x, node, N);
  for (PetscInt c = 0; c < 3; c++) {
    middle[c] = 0;
    for (PetscInt a = 0; c < s->dim && a < s->nv; a++) middle[c] += mortar->x[s->dim * node[a] + c] / (PetscReal)s->nv;
  }
  for (PetscInt a = 0; a < s->nv; a++) {
    const PetscReal r[3] = {middle[0] - s->x[a][0], middle[1] - s->x[a][1], middle[2] - s->x[a][2]};

    if (Dot3(r, N) > 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Has x, in the plane of the mortar facet, come close to its middle? */
static PetscBool IsOver_Private(const FacetCorners *m, const PetscReal x[3], const PetscReal middle[3])
{
  PetscReal size = 0, r[3];

  for (PetscInt a = 0; a < m->nv; a++) {
    for (int c = 0; c < 3; c++) r[c] = m->x[a][c] - middle[c];
    size = PetscMax(size, Dot3(r, r));
  }
  for (int c = 0; c < 3; c++) r[c] = x[c] - middle[c];
  return (PetscBool)(Dot3(r, r) <= PetscSqr(CONTACT_SLIVER) * size);
}

void ContactCorners(ContactPair pair, const ContactSurface *nonmortar, PetscInt facet, FacetCorners *s)
{
  if (!pair->hull) return;
  Corners_Private(nonmortar, facet, s);
  memcpy(s->d, pair->ray->d + 3 * s->nv * facet, sizeof(PetscReal) * 3 * (size_t)s->nv);
}

/* Are both places the two ends of their own body's thickness? */
static PetscBool IsThickness_Private(ContactHull hull, PetscInt part, const FacetCorners *s, const PetscReal xi[2], const FacetCorners *m,
                                     const PetscReal eta[2])
{
  PetscReal N[4], X[3], Y[3], d[3], length, inside[2][2];

  for (int i = 0; i < 2; i++) {
    inside[0][i] = PetscMax(-INSIDE, PetscMin(INSIDE, xi[i]));
    inside[1][i] = PetscMax(-INSIDE, PetscMin(INSIDE, eta[i]));
  }
  Hats_Private(s, inside[0], N);
  Sum_Private(s->X, N, X);
  Hats_Private(m, inside[1], N);
  Sum_Private(m->X, N, Y);
  for (int c = 0; c < 3; c++) d[c] = Y[c] - X[c];
  length = PetscSqrtReal(Dot3(d, d));
  for (int c = 0; c < 3; c++) d[c] /= length;
  if (!(Dot3(d, s->axis0[s->dim - 1]) < -CONTACT_OPPOSE && Dot3(d, m->axis0[m->dim - 1]) > CONTACT_OPPOSE)) return PETSC_FALSE;
  return (PetscBool)(ContactHullAcross(hull, part, X, d, length) > (1 - ROUND_LENGTH) * length);
}

PetscBool ContactBehind(ContactPair pair, PetscInt facet, const FacetCorners *s, const ContactSurface *mortar, PetscInt other, PetscReal shallow)
{
  PetscReal        n[3], x[3], middle[3], r[3], xi[2], eta[2], depth, own;
  PetscInt         num_own, num_other;
  HullSide         side[2][MOST_SIDES];
  const PetscReal *N;
  FacetCorners     m;
  PetscBool        behind;

  if (!pair->hull || IsInFront_Private(s, mortar, other, middle)) return PETSC_FALSE;
  Corners_Private(mortar, other, &m);
  N = m.axis[m.dim - 1];
  Aim_Private(s, middle, xi, x, n);
  for (int c = 0; c < 3; c++) r[c] = middle[c] - x[c];
  depth = -Dot3(r, N) / Dot3(n, N);
  if (!(Dot3(n, N) < -CONTACT_GRAZE) || !(depth > shallow)) return PETSC_FALSE;
  for (int c = 0; c < 3; c++) x[c] -= depth * n[c], r[c] = -n[c];
  Locate_Private(&m, x, eta);
  if (pair->part[0][facet] == pair->part[1][other] && IsThickness_Private(pair->hull, pair->part[0][facet], s, xi, &m, eta)) return PETSC_TRUE;
  own = Across_Private(pair->hull, pair->part[0][facet], s, xi, r, 2 * depth);
  if (own < 2 * depth) own += Across_Private(pair->hull, pair->part[1][other], &m, eta, n, 2 * depth - own);
  behind = (PetscBool)(own < 2 * depth);
  /* nearer to the deepest overlap that can be told, own / 2, than to the far side, own */
  if (behind && depth - 0.5 * own < own - depth && IsOver_Private(&m, x, middle)) pair->untold = PetscMax(pair->untold, depth);
  if (behind) return PETSC_TRUE;
  num_own   = Beside_Private(pair->hull, pair->part[0][facet], s, xi, r, depth, depth, side[0]);
  num_other = num_own ? Beside_Private(pair->hull, pair->part[1][other], &m, eta, n, depth, depth, side[1]) : 0;
  return IsBeside_Private(num_own, side[0], num_other, side[1], depth);
}

void ContactPairGetUntold(ContactPair pair, PetscReal *depth)
{
  *depth = pair->untold;
}

void ContactHullThickness(ContactHull hull, const ContactSurface *s, const PetscInt part[], PetscReal *most)
{
  const ContactSurface reference = {.dim = s->dim, .facets = s->facets, .x = s->X, .X = s->X};
  FacetCorners         p;

  *most = 0;
  for (PetscInt f = 0; f < s->num_facets; f++) {
    PetscReal x[3] = {0, 0, 0}, d[3];

    Corners_Private(&reference, f, &p);
    for (int c = 0; c < 3; c++) {
      for (PetscInt a = 0; a < p.nv; a++) x[c] += p.X[a][c] / (PetscReal)p.nv;
      d[c] = -p.axis0[p.dim - 1][c];
    }
    const PetscReal across = ContactHullAcross(hull, part[f], x, d, PETSC_MAX_REAL);

    if (across < PETSC_MAX_REAL) *most = PetscMax(*most, across); /* else through a crack between facets of curved bodies */
  }
}

void ContactPairSetHull(ContactPair pair, ContactHull hull, const PetscInt part[], const PetscInt mortar_part[], PetscReal deepest)
{
  pair->hull    = hull;
  pair->deepest = deepest;
  pair->part[0] = part;
  pair->part[1] = mortar_part;
}
