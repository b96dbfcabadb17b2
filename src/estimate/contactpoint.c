/* Contact traction at a point of a facet, two and three dimensions by the same formulas: an edge is a strip of width 1, its second tangent the unit vector
   across.

   Nonmortar: -z n stretch, z and n interpolated by the functions of the facet's nodes, n normalised (facets of higher order: their own normal). Mortar: +z n
   stretch at the place that the segments give: linear within the part of an edge, or within the triangles of a fan on the corners of a polygon. Stretch:
   current over reference measure. */
#include "estimateimpl.h"

/* Facets of a bent surface are seen in planes of their own, and the sides of a polygon are no straight lines on a warped facet: polygons leave slits. This far
   (the facet is 2 wide) a point may lie outside all of them and still belong to the nearest. */
#define SLIT 0.02

void ContactShape_Private(const SurfaceView *s, PetscInt facet, const PetscReal xi[2], PetscReal N[])
{
  SurfaceShape(s->dim, s->order[facet], xi, N, NULL);
}

/* Multipliers of a facet that is covered in part are the coefficients of Bernstein polynomials, no values at the nodes. */
void ContactPressureShape_Private(const ContactTerm *term, PetscInt facet, const PetscReal xi[2], const PetscReal N[], PetscReal V[])
{
  const PetscInt  m = term->view->nonmortar.dim - 1, order = term->view->nonmortar.order[facet], num = ElementNumNodes(m, order);
  const PetscReal theta = term->theta[facet];
  PetscReal       B[SURFACE_MOST_NODES];

  for (PetscInt a = 0; a < num; ++a) V[a] = N[a];
  if (theta == 1) return;
  ContactBernstein(m, order, xi, B);
  for (PetscInt a = 0; a < num; ++a) V[a] = theta * N[a] + (1 - theta) * B[a];
}

PetscReal ContactMeasure_Private(const PetscReal tangent[2][3])
{
  PetscReal square = 0;
  for (PetscInt c = 0; c < 3; ++c) square += PetscSqr(tangent[0][c] * tangent[1][(c + 1) % 3] - tangent[0][(c + 1) % 3] * tangent[1][c]);
  return PetscSqrtReal(square);
}

void ContactPosition_Private(const SurfaceView *s, PetscInt facet, const PetscReal x[], const PetscReal N[], PetscReal position[3])
{
  const PetscInt *node, num = SurfaceFacetNodes(s, facet, &node);

  for (PetscInt c = 0; c < 3; ++c) position[c] = 0;
  for (PetscInt a = 0; a < num; ++a) {
    for (PetscInt c = 0; c < s->dim; ++c) position[c] += N[a] * x[s->dim * node[a] + c];
  }
}

/* Place of reference position X on a facet. Gauss and Newton's method: X lies on the facet, so it converges as Newton's does (an edge, a parallelogram: one
   step); where it lies beside it by round-off this is the nearest place. */
static void Locate_Private(const SurfaceView *s, PetscInt facet, const PetscReal X[3], PetscReal xi[2])
{
  xi[0] = xi[1] = 0;
  for (PetscInt iteration = 0; iteration < 20; ++iteration) {
    PetscReal N[SURFACE_MOST_NODES], r[3], t[2][3];
    ContactShape_Private(s, facet, xi, N);
    ContactPosition_Private(s, facet, s->X, N, r);
    SurfaceTangents(s, facet, s->X, xi, t);
    for (PetscInt c = 0; c < 3; ++c) r[c] = c < s->dim ? X[c] - r[c] : 0;
    const PetscReal a = Dot3(t[0], t[0]), b = Dot3(t[0], t[1]), d = Dot3(t[1], t[1]), det = a * d - b * b, f = Dot3(t[0], r), g = Dot3(t[1], r);
    if (!(det > 0)) return;
    const PetscReal step[2] = {(d * f - b * g) / det, (a * g - b * f) / det};
    for (PetscInt k = 0; k < 2; ++k) xi[k] += step[k];
    if (PetscAbsReal(step[0]) + PetscAbsReal(step[1]) < 1e-9) return; /* the error left is its square */
  }
}

/* Current over reference measure at a place; in the axisymmetric model circumferences included. */
PetscReal ContactStretch_Private(const ContactTerms *terms, const SurfaceView *s, PetscInt facet, const PetscReal xi[2])
{
  PetscReal now[2][3], before[2][3], N[SURFACE_MOST_NODES], x[3], X[3];

  if (terms->kinematics != KINEMATICS_FINITE) return 1;
  SurfaceTangents(s, facet, s->x, xi, now);
  SurfaceTangents(s, facet, s->X, xi, before);
  const PetscReal ratio = ContactMeasure_Private(now) / ContactMeasure_Private(before);
  if (terms->model != MODEL_AXISYMMETRIC) return ratio;
  ContactShape_Private(s, facet, xi, N);
  ContactPosition_Private(s, facet, s->x, N, x);
  ContactPosition_Private(s, facet, s->X, N, X);
  return ratio * x[0] / X[0];
}

/* Of the nodes' normals; round an edge a node has that of another facet, and the facet's own counts. */
static void Interpolate_Private(const ContactTerm *term, PetscBool finite, PetscInt facet, const PetscReal N[], PetscReal n[3])
{
  const SurfaceView *s         = &term->view->nonmortar;
  const PetscReal    middle[2] = {0, 0};
  const PetscInt    *node, num = SurfaceFacetNodes(s, facet, &node);
  PetscReal          t[2][3], own[3], length;

  SurfaceTangents(s, facet, finite ? term->x : s->X, middle, t);
  Cross3(t[0], t[1], own);
  length = PetscSqrtReal(Dot3(own, own));
  n[0] = n[1] = n[2] = 0;
  for (PetscInt a = 0; a < num; ++a) {
    PetscReal m[3] = {0, 0, 0};
    for (PetscInt c = 0; c < s->dim; ++c) m[c] = term->normal[s->dim * node[a] + c];
    const PetscBool beyond = (PetscBool)(Dot3(m, own) < CONTACT_SHARP * length);
    for (PetscInt c = 0; c < 3; ++c) n[c] += N[a] * (beyond ? own[c] / length : m[c]);
  }
}

void ContactNormal_Private(const ContactTerm *term, PetscBool finite, PetscInt facet, const PetscReal xi[2], const PetscReal N[], PetscReal n[3])
{
  const SurfaceView *s = &term->view->nonmortar;
  PetscReal          t[2][3];

  if (s->higher) {
    SurfaceTangents(s, facet, finite ? term->x : s->X, xi, t);
    Cross3(t[0], t[1], n);
  } else
    Interpolate_Private(term, finite, facet, N, n);
  const PetscReal length = PetscSqrtReal(Dot3(n, n));
  for (PetscInt c = 0; c < 3 && length > 0; ++c) n[c] /= length;
}

/* T += factor * z of a tied pair, whose tractions are per reference area. */
static void Tie_Private(const ContactTerm *term, PetscInt facet, const PetscReal xi[2], PetscReal factor, PetscReal T[3])
{
  const SurfaceView *s = &term->view->nonmortar;
  const PetscInt    *node, num = SurfaceFacetNodes(s, facet, &node);
  PetscReal          N[SURFACE_MOST_NODES], V[SURFACE_MOST_NODES];

  ContactShape_Private(s, facet, xi, N);
  ContactPressureShape_Private(term, facet, xi, N, V);
  for (PetscInt a = 0; a < num; ++a)
    for (PetscInt c = 0; c < s->dim; ++c) T[c] += factor * V[a] * term->z[c * s->num_nodes + node[a]];
}

PetscReal ContactPressing_Private(const ContactTerm *term, PetscBool finite, PetscInt facet, const PetscReal xi[2], PetscReal n[3], PetscReal q[3])
{
  const SurfaceView *s = &term->view->nonmortar;
  const PetscInt    *node, num = SurfaceFacetNodes(s, facet, &node);
  const PetscBool    slips = (PetscBool)(term->view->slip && s->dim == 2);
  PetscReal          N[SURFACE_MOST_NODES], V[SURFACE_MOST_NODES], z = 0, along = 0;

  ContactShape_Private(s, facet, xi, N);
  ContactPressureShape_Private(term, facet, xi, N, V);
  ContactNormal_Private(term, finite, facet, xi, N, n);
  for (PetscInt a = 0; a < num; ++a) z += V[a] * term->z[node[a]];
  for (PetscInt a = 0; a < num && slips; ++a) along += V[a] * term->z[s->num_nodes + node[a]];
  q[0] = -along * n[1];
  q[1] = along * n[0];
  q[2] = 0;
  for (PetscInt a = 0; a < num && term->traction; ++a) {
    const PetscReal *t = term->traction + 3 * node[a], across = Dot3(t, n);
    for (PetscInt c = 0; c < 3; ++c) q[c] += V[a] * (t[c] - across * n[c]);
  }
  return z;
}

/* T += factor * (z n + q) at a place of a nonmortar facet. */
static void Push_Private(const ContactTerm *term, PetscBool finite, PetscInt facet, const PetscReal xi[2], PetscReal factor, PetscReal T[3])
{
  PetscReal       n[3], q[3];
  const PetscReal z = ContactPressing_Private(term, finite, facet, xi, n, q);

  for (PetscInt c = 0; c < term->view->nonmortar.dim; ++c) T[c] += factor * z * n[c];
  for (PetscInt c = 0; c < 3 && term->view->slip; ++c) T[c] += factor * q[c];
}

/* How deep a place lies in a part [a, b] of an edge: the less of the ways to its ends, below 0 outside. */
static PetscReal InPart_Private(PetscReal a, PetscReal b, PetscReal place)
{
  return PetscMin(place - PetscMin(a, b), PetscMax(a, b) - place);
}

/* The same of eta in the part of a mortar edge; then xi on its nonmortar edge. */
static PetscReal OnPart_Private(const ContactSegment *s, PetscReal eta, PetscReal xi[2])
{
  const PetscReal a = (eta - s->eta[0][0]) / (s->eta[1][0] - s->eta[0][0]);

  xi[0] = s->xi[0][0] + a * (s->xi[1][0] - s->xi[0][0]);
  xi[1] = 0;
  return InPart_Private(s->eta[0][0], s->eta[1][0], eta);
}

/* Weights of the corners p of a triangle at eta; returns how deep it lies inside (negative: outside) in the units of eta. */
static PetscReal InTriangle_Private(const PetscReal *const p[3], const PetscReal eta[2], PetscReal weight[3])
{
  PetscReal area[3], total = 0, depth = PETSC_MAX_REAL;

  for (PetscInt k = 0; k < 3; ++k) {
    const PetscReal *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
    area[k] = (a[0] - eta[0]) * (b[1] - eta[1]) - (a[1] - eta[1]) * (b[0] - eta[0]);
    total += area[k];
  }
  if (total == 0) return PETSC_MIN_REAL;
  for (PetscInt k = 0; k < 3; ++k) {
    const PetscReal *a = p[(k + 1) % 3], *b = p[(k + 2) % 3], side = PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
    weight[k] = area[k] / total;
    depth     = PetscMin(depth, (total > 0 ? area[k] : -area[k]) / side);
  }
  return depth;
}

/* How deep eta lies in the polygon of a segment, at least `least`; then xi by the nearest triangle of the fan, weights of a point outside cut off at zero. */
static PetscReal InPolygon_Private(const ContactSegment *s, const PetscReal eta[2], PetscReal least, PetscReal xi[2])
{
  for (PetscInt k = 1; k + 1 < s->num && least < 0; ++k) {
    const PetscInt         corner[3] = {0, k, k + 1};
    const PetscReal *const p[3]      = {s->eta[0], s->eta[k], s->eta[k + 1]};
    PetscReal              weight[3], total = 0;
    const PetscReal        depth = InTriangle_Private(p, eta, weight);
    if (!(depth > least)) continue;
    least = depth;
    for (PetscInt i = 0; i < 3; ++i) total += weight[i] = PetscMax(weight[i], 0);
    for (PetscInt d = 0; d < 2; ++d) xi[d] = (weight[0] * s->xi[corner[0]][d] + weight[1] * s->xi[corner[1]][d] + weight[2] * s->xi[corner[2]][d]) / total;
  }
  return least;
}

void ContactSegmentBox_Private(const ContactSegment *s, PetscReal box[4])
{
  for (PetscInt d = 0; d < 2; ++d) {
    box[d]     = PETSC_MAX_REAL;
    box[2 + d] = PETSC_MIN_REAL;
    for (PetscInt k = 0; k < s->num; ++k) {
      box[d]     = PetscMin(box[d], s->eta[k][d] - SLIT);
      box[2 + d] = PetscMax(box[2 + d], s->eta[k][d] + SLIT);
    }
  }
}

/* The nonmortar facet that a place on a mortar facet is seen from, -1: none, the place there, and how deep in what is seen from there eta lies. The first
   segment that holds eta, else the nearest in reach. */
static PetscInt Seen_Private(const ContactTerm *term, PetscInt mortar_facet, const PetscReal eta[2], PetscReal xi[2], PetscReal *depth)
{
  PetscInt found = -1;

  *depth = term->view->mortar.dim == 2 ? 0 : -SLIT;
  for (PetscInt i = term->segment_first[mortar_facet]; i < term->segment_first[mortar_facet + 1]; ++i) {
    const ContactSegment *s   = &term->segments[i];
    const PetscReal      *box = term->box ? term->box[i] : NULL;
    if (box && (*depth >= 0 || eta[0] < box[0] || eta[1] < box[1] || eta[0] > box[2] || eta[1] > box[3])) continue;
    PetscReal       place[2];
    const PetscReal deep = box ? InPolygon_Private(s, eta, *depth, place) : OnPart_Private(s, eta[0], place);
    if (!(deep > *depth || (!box && found < 0 && deep == 0))) continue;
    *depth = deep;
    found  = s->facet;
    xi[0]  = place[0];
    xi[1]  = place[1];
  }
  return found;
}

/* How deep a place on a nonmortar facet of this rank lies in what faces the mortar side; PETSC_MIN_REAL: outside. Segments come by ascending facets. */
static PetscReal Faces_Private(const ContactTerm *term, PetscInt facet, const PetscReal xi[2])
{
  const PetscBool       edges = (PetscBool)(term->view->nonmortar.dim == 2);
  const ContactSegment *s;
  PetscReal             deepest = PETSC_MIN_REAL;
  PetscInt              num, low = 0, high;

  ContactPairGetSegments(term->view->pair, &num, &s);
  for (high = num; low < high;) {
    const PetscInt middle = (low + high) / 2;
    if (s[middle].facet < facet)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < num && s[low].facet == facet; ++low) {
    if (edges) deepest = PetscMax(deepest, InPart_Private(s[low].xi[0][0], s[low].xi[1][0], xi[0]));
    for (PetscInt k = 1; k + 1 < s[low].num && !edges; ++k) {
      const PetscReal *const p[3] = {s[low].xi[0], s[low].xi[k], s[low].xi[k + 1]};
      PetscReal              weight[3];
      deepest = PetscMax(deepest, InTriangle_Private(p, xi, weight));
    }
  }
  return edges ? (deepest >= 0 ? deepest : PETSC_MIN_REAL) : deepest > -SLIT ? deepest : PETSC_MIN_REAL;
}

/* What presses at a place: of pairs that do and whose regions end there, so that slits leave it in several, the one that it lies deepest in, the mean of those
   where it lies alike, as on the border itself. A pair that is open there may see it from farther off. */
typedef struct {
  PetscInt  pair, num; /* num: how many pairs it is of */
  PetscReal depth, T[3];
} Pressing;

static void Take_Private(Pressing *p, PetscInt pair, PetscReal depth, const PetscReal T[3])
{
  const PetscReal alike = 1e-6;
  const PetscBool other = (PetscBool)(!p->num || p->pair != pair);

  if (Dot3(T, T) == 0 || (p->num && other && depth < p->depth - alike)) return;
  if (!p->num || (other && depth > p->depth + alike)) *p = (Pressing){.depth = depth};
  if (other) ++p->num;
  p->pair  = pair;
  p->depth = PetscMax(p->depth, depth);
  for (PetscInt c = 0; c < 3; ++c) p->T[c] += T[c];
}

void ContactTermsTraction_Private(const ContactTerms *terms, PetscInt facet, const PetscReal X[3], PetscReal T[3])
{
  const PetscBool finite   = (PetscBool)(terms->kinematics == KINEMATICS_FINITE);
  Pressing        pressing = {0};

  for (PetscInt i = 0; i < terms->num; ++i) {
    const ContactTerm *term      = &terms->terms[i];
    const PetscInt     nonmortar = term->facet_place[0][facet], mortar = term->facet_place[1][facet];
    const PetscBool    ties = (PetscBool)(term->view->spec->law == CONTACT_TIED);
    PetscReal          xi[2], eta[2], depth;
    if (nonmortar >= 0) {
      PetscReal t[3] = {0, 0, 0};
      Locate_Private(&term->view->nonmortar, nonmortar, X, xi);
      depth = Faces_Private(term, nonmortar, xi); /* round a corner, or past an end of the mortar side, nothing presses */
      if (depth > PETSC_MIN_REAL && ties) Tie_Private(term, nonmortar, xi, -1, t);
      if (depth > PETSC_MIN_REAL && !ties) Push_Private(term, finite, nonmortar, xi, -ContactStretch_Private(terms, &term->view->nonmortar, nonmortar, xi), t);
      if (depth > PETSC_MIN_REAL) Take_Private(&pressing, term->view->spec->pair, depth, t);
    }
    if (mortar < 0) continue;
    PetscReal t[3] = {0, 0, 0};
    Locate_Private(&term->view->mortar, mortar, X, eta);
    const PetscInt seen = Seen_Private(term, mortar, eta, xi, &depth);
    if (seen < 0) continue;
    if (ties) Tie_Private(term, seen, xi, 1, t);
    if (!ties) Push_Private(term, finite, seen, xi, ContactStretch_Private(terms, &term->view->mortar, mortar, eta), t);
    Take_Private(&pressing, term->view->spec->pair, depth, t);
  }
  for (PetscInt c = 0; c < 3 && pressing.num; ++c) T[c] += pressing.T[c] / pressing.num;
}
