/* The gap between two surfaces at Gauss points of the segments of a nonmortar facet, and how far the round surfaces that the mesh stands for (ForestMapPoint)
   stand out of the facets there. */
#include "estimateimpl.h"

/* Place in its leaf of a place on a facet: both are known by their corners. */
static void LeafPoint_Private(const ForestTables *t, const SurfaceView *s, PetscInt facet, const PetscReal xi[2], PetscReal place[3])
{
  const PetscInt offset = t->closure_offset[t->first[t->dim] + s->facet_leaf[facet]];
  PetscReal      N[4];

  SurfaceShape(s->dim, 1, xi, N, NULL); /* lexicographic */
  for (PetscInt d = 0; d < 3; ++d) place[d] = 0;
  for (PetscInt k = 0; k < s->corners; ++k) {
    for (PetscInt v = 0; v < 1 << t->dim; ++v) {
      const PetscInt index = 2 * ((v & 1) + 3 * ((v >> 1) & 1) + 9 * (v >> 2)); /* in the 3^dim closure table */
      if (t->closure[offset + index] != s->node_entity[s->facets[s->corners * facet + k]]) continue;
      for (PetscInt d = 0; d < t->dim; ++d) place[d] += N[k < 2 ? k : 5 - k] * ((v >> d) & 1);
    }
  }
}

/* How far the round surface stands out of a facet at xi. */
static PetscErrorCode Bulge_Private(const EstimateSum *sum, const SurfaceView *s, PetscInt facet, const PetscReal xi[2], PetscReal *bulge)
{
  PetscReal    place[3], N[SURFACE_MOST_NODES], X[3], exact[3], t[2][3], n[3];
  const Forest forest = HPSpaceGetForest(sum->space);

  PetscFunctionBegin;
  LeafPoint_Private(sum->t, s, facet, xi, place);
  PetscCall(ForestMapPoint(forest, s->facet_leaf[facet], place, exact));
  ContactShape_Private(s, facet, xi, N);
  ContactPosition_Private(s, facet, s->X, N, X);
  SurfaceTangents(s, facet, s->X, xi, t);
  Cross3(t[0], t[1], n);
  for (PetscInt c = 0; c < 3; ++c) X[c] = c < s->dim ? exact[c] - X[c] : 0;
  *bulge = Dot3(X, n) / PetscSqrtReal(Dot3(n, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gauss points in each direction of a facet. */
static PetscInt NumPoints_Private(const SurfaceView *s, PetscInt facet)
{
  return s->order[facet] + 2;
}

/* Its mean over the facet. */
static PetscErrorCode MeanBulge_Private(const EstimateSum *sum, const SurfaceView *s, PetscInt facet, PetscReal *mean)
{
  const PetscInt n1 = NumPoints_Private(s, facet);
  const Basis1D *gauss;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(1, n1, &gauss));
  *mean = 0;
  for (PetscInt q = 0; q < (s->dim == 3 ? n1 : 1) * n1; ++q) {
    const PetscReal xi[2] = {2 * gauss->points[q % n1] - 1, 2 * gauss->points[q / n1] - 1};
    PetscReal       bulge;
    PetscCall(Bulge_Private(sum, s, facet, xi, &bulge));
    *mean += gauss->weights[q % n1] * (s->dim == 3 ? gauss->weights[q / n1] : 1) * bulge;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the ray from x along n meets a mortar facet at these positions, from a place eta near it: t0 d0 + t1 d1 - g n = x - y by Newton's method. Segments are
   seen along the directions of the corners, not along n, so across a wide gap the ray may pass the facet by (PETSC_FALSE): then the nearest place of it. Met
   on the facet continued it would tell of an overlap that is none. */
static PetscBool Ray_Private(const SurfaceView *s, const PetscReal positions[], PetscInt facet, const PetscReal x[3], const PetscReal n[3], PetscReal eta[2])
{
  const PetscReal most[2] = {PetscMax(1, PetscAbsReal(eta[0])), PetscMax(1, PetscAbsReal(eta[1]))};
  PetscBool       met     = PETSC_FALSE;

  for (PetscInt iteration = 0; iteration < 3; ++iteration) {
    PetscReal N[SURFACE_MOST_NODES], y[3], t[2][3], a[3], b[3];
    ContactShape_Private(s, facet, eta, N);
    ContactPosition_Private(s, facet, positions, N, y);
    SurfaceTangents(s, facet, positions, eta, t);
    for (PetscInt i = 0; i < 3; ++i) y[i] = x[i] - y[i];
    Cross3(t[1], n, a);
    Cross3(n, t[0], b);
    const PetscReal det = Dot3(t[0], a);
    if (det == 0) return PETSC_FALSE;
    eta[0] += Dot3(y, a) / det;
    if (s->dim == 3) eta[1] += Dot3(y, b) / det;
    met = (PetscBool)(PetscAbsReal(eta[0]) <= most[0] && PetscAbsReal(eta[1]) <= most[1]);
    for (PetscInt d = 0; d < 2; ++d) eta[d] = PetscClipInterval(eta[d], -most[d], most[d]);
  }
  return met;
}

/* With small kinematics contact is linearised at the reference positions, where gaps may be open, with directions and measure held: not the gap of the
   displaced places but, with the direction n and the normal nm of the mortar facet that it meets at y, n.(Y - X) + nm.(u_m - u_s)/(nm.n). */
static PetscReal LinearGap_Private(const SurfaceView *m, PetscInt facet, const PetscReal eta[2], const PetscReal n[3], const PetscReal X[3],
                                   const PetscReal x[3])
{
  PetscReal M[SURFACE_MOST_NODES], t[2][3], nm[3], Y[3], y[3], gap = 0, change = 0;

  ContactShape_Private(m, facet, eta, M);
  ContactPosition_Private(m, facet, m->X, M, Y);
  ContactPosition_Private(m, facet, m->x, M, y);
  SurfaceTangents(m, facet, m->X, eta, t);
  Cross3(t[0], t[1], nm);
  for (PetscInt c = 0; c < 3; ++c) {
    gap += n[c] * (Y[c] - X[c]);
    change += nm[c] * (y[c] - Y[c] - (x[c] - X[c]));
  }
  return gap + change / Dot3(nm, n);
}

static PetscBool IsTied_Private(const ContactTerm *term)
{
  return (PetscBool)(term->view->spec->law == CONTACT_TIED);
}

/* Do gaps of the mesh count as closed? */
static PetscBool IsAdjusted_Private(const ContactTerm *term)
{
  return (PetscBool)(IsTied_Private(term) || term->view->spec->adjust);
}

/* What of the gap at the start counts as none, where initial_gap: adjust closes it: that of the mesh at the point, as sides of other divisions of a circle
   have it, on the mortar facet that is met now; where the ray met another one, as the nodes show it. */
static PetscReal InitialGap_Private(const ContactTerm *term, const ContactSegment *segment, const PetscReal xi[2], const PetscReal N[], const PetscReal eta[2])
{
  const SurfaceView *s = &term->view->nonmortar, *m = &term->view->mortar;
  const PetscInt    *node, num                      = SurfaceFacetNodes(s, segment->facet, &node);
  PetscReal          place[2] = {eta[0], eta[1]}, n[3], X[3], Y[3], M[SURFACE_MOST_NODES], gap = 0;

  if (!term->view->spec->adjust) return 0;
  ContactNormal_Private(term, PETSC_FALSE, segment->facet, xi, N, n);
  ContactPosition_Private(s, segment->facet, s->X, N, X);
  if (Ray_Private(m, m->X, segment->mortar_facet, X, n, place)) {
    ContactShape_Private(m, segment->mortar_facet, place, M);
    ContactPosition_Private(m, segment->mortar_facet, m->X, M, Y);
    return Dot3(n, Y) - Dot3(n, X);
  }
  for (PetscInt a = 0; a < num; ++a) gap += N[a] * term->view->initial_gap[node[a]];
  return gap;
}

/* Does the direction n face the mortar facet at eta? */
static PetscBool Faces_Private(const SurfaceView *m, const PetscReal positions[], PetscInt facet, const PetscReal eta[2], const PetscReal n[3])
{
  PetscReal t[2][3], normal[3];

  SurfaceTangents(m, facet, positions, eta, t);
  Cross3(t[0], t[1], normal);
  return (PetscBool)(Dot3(normal, n) < 0);
}

/* Gap and height of the mortar side at a point. A part of a facet that has turned away from what other parts of it face, as one that is folded back in a cell
   that is turned inside out, overlaps nothing there. */
static void Gap_Private(const EstimateSum *sum, const ContactTerm *term, const ContactSegment *segment, const PetscReal N[], PetscReal eta[2], GapPoint *p)
{
  const PetscBool    finite = (PetscBool)(sum->spec->kinematics == KINEMATICS_FINITE);
  const SurfaceView *s = &term->view->nonmortar, *m = &term->view->mortar;
  const PetscReal    center[2] = {0, 0};
  PetscReal          M[SURFACE_MOST_NODES], X[3], x[3], y[3], n[3], middle[3];

  ContactNormal_Private(term, finite, segment->facet, p->xi, N, n);
  ContactPosition_Private(s, segment->facet, finite ? s->x : s->X, N, X);
  Ray_Private(m, finite ? m->x : m->X, segment->mortar_facet, X, n, eta);
  ContactPosition_Private(s, segment->facet, s->x, N, x);
  ContactShape_Private(m, segment->mortar_facet, eta, M);
  ContactPosition_Private(m, segment->mortar_facet, m->x, M, y);
  ContactShape_Private(s, segment->facet, center, M);
  ContactNormal_Private(term, finite, segment->facet, center, M, middle);
  p->gap = finite ? Dot3(n, y) - Dot3(n, x) : LinearGap_Private(m, segment->mortar_facet, eta, n, X, x);
  p->gap -= term->view->interference + InitialGap_Private(term, segment, p->xi, N, eta);
  if (p->gap < 0 && !Faces_Private(m, finite ? m->x : m->X, segment->mortar_facet, eta, n)) p->gap = 0;
  p->height = Dot3(middle, y);
}

/* Functions of the nonmortar facet's nodes: pressure, and the gap that the constraints know of. On facets of order 1 the dual functions are the hats three
   times as steep about the middle, products of 2 N0 - N1 and 2 N1 - N0: theirs is the pressure that works, for which the facets' vertices are placed so that
   their bulges do none (src/hp/surface.c); where a facet is covered in part they give way to the hats. */
static void Nodal_Private(const ContactTerm *term, PetscInt facet, const PetscReal N[], GapPoint *p)
{
  const SurfaceView *s = &term->view->nonmortar;
  const PetscInt    *node, num = SurfaceFacetNodes(s, facet, &node);
  const PetscReal    steep[2] = {3 * p->xi[0], 3 * p->xi[1]};
  const PetscReal    theta    = s->higher || term->view->spec->standard ? 0 : term->theta[facet];
  PetscReal          dual[SURFACE_MOST_NODES], V[SURFACE_MOST_NODES], gap;

  ContactShape_Private(s, facet, steep, dual);
  ContactPressureShape_Private(term, facet, p->xi, N, V);
  for (PetscInt a = 0; a < num; ++a) {
    p->pressure += V[a] * term->z[node[a]];
    p->trace += (theta * dual[a] + (1 - theta) * V[a]) * term->z[node[a]];
    if (ContactNodalGap_Private(term->view, node[a], 0, &gap)) p->nodal += N[a] * gap;
  }
  p->pressure = PetscMax(p->pressure, 0);
}

/* How far material points of a tied pair have come apart: a gap that was there turns and stretches with the nonmortar facet beside it. */
static void Jump_Private(const EstimateSum *sum, const ContactTerm *term, const ContactSegment *segment, const PetscReal N[], PetscReal eta[2], GapPoint *p)
{
  const PetscReal   *now = sum->spec->kinematics == KINEMATICS_FINITE ? term->view->nonmortar.x : term->view->nonmortar.X;
  const SurfaceView *s = &term->view->nonmortar, *m = &term->view->mortar;
  PetscReal          M[SURFACE_MOST_NODES], X[3], Y[3], x[3], y[3], n[3], gap[3], frame[2][3][3];

  ContactNormal_Private(term, PETSC_FALSE, segment->facet, p->xi, N, n);
  ContactPosition_Private(s, segment->facet, s->X, N, X);
  Ray_Private(m, m->X, segment->mortar_facet, X, n, eta);
  ContactShape_Private(m, segment->mortar_facet, eta, M);
  ContactPosition_Private(m, segment->mortar_facet, m->X, M, Y);
  ContactPosition_Private(s, segment->facet, s->x, N, x);
  ContactPosition_Private(m, segment->mortar_facet, m->x, M, y);
  for (PetscInt k = 0; k < 2; ++k) {
    SurfaceTangents(s, segment->facet, k ? now : s->X, p->xi, frame[k]);
    Cross3(frame[k][0], frame[k][1], frame[k][2]);
  }
  for (PetscInt c = 0; c < 3; ++c) {
    gap[c]     = Y[c] - X[c];
    p->jump[c] = y[c] - x[c];
  }
  for (PetscInt i = 0; i < 3; ++i) {
    PetscReal across[3];
    Cross3(frame[0][(i + 1) % 3], frame[0][(i + 2) % 3], across);
    const PetscReal arm = Dot3(across, gap) / Dot3(across, frame[0][i]);
    for (PetscInt c = 0; c < 3; ++c) p->jump[c] -= arm * frame[1][i][c];
  }
}

/* Gaps of the mesh that were closed: what differs from the mean. */
static void Close_Private(GapPoints *points)
{
  PetscReal area = 0, mean[3] = {0, 0, 0};

  for (PetscInt i = 0; i < points->num; ++i) {
    area += points->points[i].weight;
    for (PetscInt c = 0; c < 3; ++c) mean[c] += points->points[i].weight * points->points[i].jump[c];
  }
  for (PetscInt i = 0; i < points->num && area > 0; ++i)
    for (PetscInt c = 0; c < 3; ++c) points->points[i].jump[c] -= mean[c] / area;
}

static PetscErrorCode AddPoint_Private(const EstimateSum *sum, const ContactTerm *term, const ContactSegment *segment, const PetscReal mean[2],
                                       const PetscReal xi[2], PetscReal eta[2], PetscReal weight, GapPoints *to)
{
  const SurfaceView *s = &term->view->nonmortar, *m = &term->view->mortar;
  PetscReal          N[SURFACE_MOST_NODES];
  GapPoint           p = {.xi = {xi[0], xi[1]}, .segment = segment, .mean = {mean[0], mean[1]}};

  PetscFunctionBegin;
  ContactShape_Private(s, segment->facet, xi, N);
  if (IsTied_Private(term))
    Jump_Private(sum, term, segment, N, eta, &p);
  else {
    Nodal_Private(term, segment->facet, N, &p);
    Gap_Private(sum, term, segment, N, eta, &p);
  }
  p.weight = weight * ContactTermsMeasure_Private(sum->contact, s, segment->facet, xi, N);
  if (p.pressure > 0 && !IsAdjusted_Private(term)) {
    PetscCall(Bulge_Private(sum, s, segment->facet, xi, &p.bulge[0]));
    PetscCall(Bulge_Private(sum, m, segment->mortar_facet, eta, &p.bulge[1]));
  }
  if (to->num == to->most) {
    to->most = 2 * to->most + 64;
    PetscCall(PetscRealloc(sizeof(GapPoint) * (size_t)to->most, &to->points));
  }
  to->points[to->num++] = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Surfaces that touch at one point first do so at a corner of one of them, where no Gauss point is. While nothing bears, overlap there is as deep as it is, and
   where Gauss points see none, it counts as an end of the Gauss-Lobatto rule of the next order would. */
static PetscErrorCode AddCorners_Private(const EstimateSum *sum, const ContactTerm *term, const ContactSegment *segment, PetscBool counts,
                                         const PetscReal mean[2], GapPoints *to)
{
  const PetscInt n       = NumPoints_Private(&term->view->nonmortar, segment->facet);
  PetscReal      measure = segment->num == 2 ? PetscAbsReal(segment->xi[1][0] - segment->xi[0][0]) : 0;

  PetscFunctionBegin;
  for (PetscInt k = 1; k + 1 < segment->num; ++k) {
    const PetscReal *p = segment->xi[0], *q = segment->xi[k], *r = segment->xi[k + 1];
    measure += PetscAbsReal((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / 2;
  }
  measure *= (counts ? 1. : 0.) / (PetscReal)(n * (n + 1));
  for (PetscInt k = 0; k < segment->num; ++k) {
    PetscReal eta[2] = {segment->eta[k][0], segment->eta[k][1]};
    PetscCall(AddPoint_Private(sum, term, segment, mean, segment->xi[k], eta, measure, to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Triangle k of the fan that a polygon is: a square with one side drawn together. */
static PetscErrorCode AddTriangle_Private(const EstimateSum *sum, const ContactTerm *term, const ContactSegment *segment, PetscInt k, const PetscReal mean[2],
                                          GapPoints *to)
{
  const PetscReal *const p[3] = {segment->xi[0], segment->xi[k], segment->xi[k + 1]}, *const e[3] = {segment->eta[0], segment->eta[k], segment->eta[k + 1]};
  const PetscReal twice = PetscAbsReal((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
  const PetscInt  n1    = NumPoints_Private(&term->view->nonmortar, segment->facet);
  const Basis1D  *gauss;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(1, n1, &gauss));
  for (PetscInt q = 0; q < n1 * n1; ++q) {
    const PetscReal a = gauss->points[q % n1], b = gauss->points[q / n1], share[3] = {1 - a, a * (1 - b), a * b};
    PetscReal       xi[2] = {0, 0}, eta[2] = {0, 0};
    for (PetscInt i = 0; i < 3; ++i) {
      for (PetscInt d = 0; d < 2; ++d) xi[d] += share[i] * p[i][d], eta[d] += share[i] * e[i][d];
    }
    PetscCall(AddPoint_Private(sum, term, segment, mean, xi, eta, gauss->weights[q % n1] * gauss->weights[q / n1] * a * twice, to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddPart_Private(const EstimateSum *sum, const ContactTerm *term, const ContactSegment *segment, const PetscReal mean[2], GapPoints *to)
{
  const PetscInt n1 = NumPoints_Private(&term->view->nonmortar, segment->facet);
  const Basis1D *gauss;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(1, n1, &gauss));
  for (PetscInt q = 0; q < n1; ++q) {
    const PetscReal a = gauss->points[q], xi[2] = {(1 - a) * segment->xi[0][0] + a * segment->xi[1][0], 0};
    PetscReal       eta[2] = {(1 - a) * segment->eta[0][0] + a * segment->eta[1][0], 0};
    PetscCall(AddPoint_Private(sum, term, segment, mean, xi, eta, gauss->weights[q] * PetscAbsReal(segment->xi[1][0] - segment->xi[0][0]), to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GapPointsFind_Private(const EstimateSum *sum, const ContactTerm *term, PetscInt num, const ContactSegment segments[], GapPoints *points)
{
  PetscReal mean[2] = {0, 0};
  PetscBool unseen  = term->bare;

  PetscFunctionBegin;
  points->num = 0;
  for (PetscInt i = 0; i < num; ++i) {
    if (!IsAdjusted_Private(term)) {
      PetscCall(MeanBulge_Private(sum, &term->view->nonmortar, segments[i].facet, &mean[0]));
      PetscCall(MeanBulge_Private(sum, &term->view->mortar, segments[i].mortar_facet, &mean[1]));
    }
    if (segments[i].num == 2) PetscCall(AddPart_Private(sum, term, &segments[i], mean, points));
    for (PetscInt k = 1; k + 1 < segments[i].num; ++k) PetscCall(AddTriangle_Private(sum, term, &segments[i], k, mean, points));
  }
  for (PetscInt i = 0; i < points->num; ++i) unseen = (PetscBool)(unseen && points->points[i].gap >= 0);
  for (PetscInt i = 0; i < num && term->bare; ++i) PetscCall(AddCorners_Private(sum, term, &segments[i], unseen, mean, points));
  if (IsTied_Private(term) && term->view->spec->close) Close_Private(points);
  for (PetscInt i = 0; i < points->num && IsTied_Private(term); ++i)
    points->points[i].gap = PetscSqrtReal(Dot3(points->points[i].jump, points->points[i].jump));
  PetscFunctionReturn(PETSC_SUCCESS);
}
