/* Gap, pressure and status at the nodes of both sides of a pair. The nonmortar side has them; at a mortar node m they are means over what faces it,

     f_m = int N_m f dgamma / int N_m dgamma   over the node's segments, dgamma the nonmortar side's length or area, f interpolated between nonmortar nodes,

   for the gap and the status over the nodes only that have one. Constants come over exactly, linear fields inside the zone up to half a facet. */
#include "outputimpl.h"

/* Numbers summed at a mortar node: int N_m, int N_m p, and of nonmortar nodes that face something int N_m, int N_m g, int N_m [active]. */
enum { SUM_ALL, SUM_PRESSURE, SUM_KNOWN, SUM_GAP, SUM_ACTIVE, NUM_SUMS };

/* A point of a segment: place on both facets, share of the segment's length or area. */
typedef struct {
  PetscReal xi[2], eta[2], weight;
} SegmentPoint;

/* ---- facets -------------------------------------------------------------------------------------------------------------------- */

void OutputFacetHats(PetscInt dim, const PetscReal xi[], PetscReal N[4])
{
  const PetscReal a[2] = {0.5 * (1 - xi[0]), 0.5 * (1 + xi[0])};

  if (dim == 2) {
    N[0] = a[0];
    N[1] = a[1];
    return;
  }
  const PetscReal b[2] = {0.5 * (1 - xi[1]), 0.5 * (1 + xi[1])};
  N[0]                 = a[0] * b[0];
  N[1]                 = a[1] * b[0];
  N[2]                 = a[1] * b[1];
  N[3]                 = a[0] * b[1];
}

void OutputFacetPoint(const SurfaceView *s, const PetscReal x[], PetscInt facet, const PetscReal xi[], PetscReal point[3])
{
  PetscReal N[4];

  OutputFacetHats(s->dim, xi, N);
  for (PetscInt c = 0; c < 3; ++c) {
    point[c] = 0;
    for (PetscInt k = 0; k < s->corners && c < s->dim; ++k) point[c] += N[k] * x[s->dim * s->facets[s->corners * facet + k] + c];
  }
}

void OutputFacetNormal(const SurfaceView *s, const PetscReal x[], PetscInt facet, PetscReal normal[3])
{
  PetscReal length;

  ContactFacetVector(s->dim, x, s->facets + s->corners * facet, normal);
  length = PetscSqrtReal(Dot3(normal, normal));
  for (PetscInt c = 0; c < 3 && length > 0; ++c) normal[c] /= length;
}

/* ---- nonmortar side -------------------------------------------------------------------------------------------------------------- */

/* Hanging nodes: pressure and gap interpolated between their masters (the gap between those that have one), touching where a master touches. */
static void Follow_Private(const SurfaceView *s, ContactFields *f)
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal known = 0;
    if (s->hang[n] == s->hang[n + 1]) continue;
    f->gap[n] = f->pressure[n] = 0;
    f->status[n]               = CONTACT_ALONE;
    for (PetscInt k = s->hang[n]; k < s->hang[n + 1]; ++k) {
      const PetscInt master = s->hang_master[k];
      f->pressure[n] += s->hang_weight[k] * f->pressure[master];
      f->status[n] = PetscMax(f->status[n], f->status[master]);
      if (f->status[master] == CONTACT_ALONE) continue;
      f->gap[n] += s->hang_weight[k] * f->gap[master];
      known += s->hang_weight[k];
    }
    if (known > 0) f->gap[n] /= known;
  }
}

void OutputContactFields(const ContactView *v, ContactFields *f)
{
  for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n) {
    const PetscBool covered = (PetscBool)(v->has_multiplier[n] && v->weight[n] > 0);
    f->gap[n]               = covered ? v->gap[n] / v->weight[n] : 0;
    f->pressure[n]          = v->z[n];
    f->status[n]            = !covered ? CONTACT_ALONE : v->active[n] ? CONTACT_TOUCHING : CONTACT_OPEN;
  }
  Follow_Private(&v->nonmortar, f);
}

/* ---- mortar side ------------------------------------------------------------------------------------------------------------------ */

/* Two dimensions: the two Gauss points of a segment. A hit of node-to-segment contact is a point and counts as 1. */
static PetscInt EdgePoints_Private(const ContactView *v, const PetscReal x[], const ContactSegment *s, SegmentPoint point[])
{
  PetscReal end[2][3], square = 0;

  for (PetscInt k = 0; k < 2; ++k) OutputFacetPoint(&v->nonmortar, x, s->facet, s->xi[k], end[k]);
  for (PetscInt c = 0; c < 2; ++c) square += PetscSqr(end[1][c] - end[0][c]);
  for (PetscInt q = 0; q < 2; ++q) {
    const PetscReal at = 0.5 + (q ? 0.5 : -0.5) / PetscSqrtReal(3.);
    point[q].xi[0]     = (1 - at) * s->xi[0][0] + at * s->xi[1][0];
    point[q].eta[0]    = (1 - at) * s->eta[0][0] + at * s->eta[1][0];
    point[q].weight    = 0.5 * (v->spec->node_to_segment ? 1 : PetscSqrtReal(square));
  }
  return 2;
}

/* Three dimensions: the polygon as a fan of triangles, the middles of whose sides integrate quadratic functions. */
static PetscInt PolygonPoints_Private(const ContactView *v, const PetscReal x[], const ContactSegment *s, SegmentPoint point[])
{
  PetscReal corner[CONTACT_SEGMENT][3], normal[3], d[3], e[3];
  PetscInt  num = 0;

  for (PetscInt k = 0; k < s->num; ++k) OutputFacetPoint(&v->nonmortar, x, s->facet, s->xi[k], corner[k]);
  for (PetscInt k = 1; k + 1 < s->num; ++k) {
    const PetscInt fan[3] = {0, k, k + 1};
    for (PetscInt c = 0; c < 3; ++c) {
      d[c] = corner[k][c] - corner[0][c];
      e[c] = corner[k + 1][c] - corner[0][c];
    }
    Cross3(d, e, normal);
    for (PetscInt q = 0; q < 3; ++q, ++num) {
      const PetscInt a = fan[q], b = fan[(q + 1) % 3];
      for (PetscInt c = 0; c < 2; ++c) {
        point[num].xi[c]  = 0.5 * (s->xi[a][c] + s->xi[b][c]);
        point[num].eta[c] = 0.5 * (s->eta[a][c] + s->eta[b][c]);
      }
      point[num].weight = PetscSqrtReal(Dot3(normal, normal)) / 6;
    }
  }
  return num;
}

static void AddToNode_Private(const SurfaceView *mortar, PetscInt node, PetscReal weight, const PetscReal value[NUM_SUMS], PetscReal sums[])
{
  if (mortar->hang[node] == mortar->hang[node + 1]) {
    for (PetscInt i = 0; i < NUM_SUMS; ++i) sums[NUM_SUMS * node + i] += weight * value[i];
    return;
  }
  for (PetscInt k = mortar->hang[node]; k < mortar->hang[node + 1]; ++k) {
    const PetscReal share = weight * mortar->hang_weight[k];
    for (PetscInt i = 0; i < NUM_SUMS; ++i) sums[NUM_SUMS * mortar->hang_master[k] + i] += share * value[i];
  }
}

static void AddPoint_Private(const ContactView *v, const ContactSegment *s, const SegmentPoint *point, const ContactFields *f, PetscReal sums[])
{
  const PetscInt corners = v->nonmortar.corners, *own = v->nonmortar.facets + corners * s->facet, *other = v->mortar.facets + corners * s->mortar_facet;
  PetscReal      N[4], M[4], value[NUM_SUMS]                                                             = {[SUM_ALL] = 1};

  OutputFacetHats(v->nonmortar.dim, point->xi, N);
  OutputFacetHats(v->nonmortar.dim, point->eta, M);
  for (PetscInt k = 0; k < corners; ++k) {
    value[SUM_PRESSURE] += N[k] * f->pressure[own[k]];
    if (f->status[own[k]] == CONTACT_ALONE) continue;
    value[SUM_KNOWN] += N[k];
    value[SUM_GAP] += N[k] * f->gap[own[k]];
    value[SUM_ACTIVE] += N[k] * f->status[own[k]];
  }
  for (PetscInt k = 0; k < corners; ++k) AddToNode_Private(&v->mortar, other[k], point->weight * M[k], value, sums);
}

/* Sums over the segments of this rank's nonmortar facets: facets at the border are evaluated by several ranks. */
static PetscErrorCode Sums_Private(Problem problem, const ContactView *v, const ContactFields *f, PetscReal sums[])
{
  const SceneData      *scene;
  const ForestTables   *t;
  const ContactSegment *segment;
  Forest                forest;
  PetscInt              num;
  PetscMPIInt           rank;
  SegmentPoint          point[3 * CONTACT_SEGMENT];

  PetscFunctionBegin;
  PetscCall(ProblemGetScene(problem, &scene));
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCall(ForestGetTables(forest, &t));
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  const PetscReal *x = scene->mechanics.kinematics == KINEMATICS_SMALL ? v->nonmortar.X : v->nonmortar.x;
  PetscCall(ContactPairGetSegments(v->pair, &num, &segment));
  for (PetscInt s = 0; s < num; ++s) {
    if (t->leaf_rank[v->nonmortar.facet_leaf[segment[s].facet]] != rank) continue;
    const PetscInt points = v->nonmortar.dim == 2 ? EdgePoints_Private(v, x, &segment[s], point) : PolygonPoints_Private(v, x, &segment[s], point);
    for (PetscInt q = 0; q < points; ++q) AddPoint_Private(v, &segment[s], &point[q], f, sums);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputProjectFields(Problem problem, PetscInt pair, const ContactFields *from, ContactFields *to)
{
  const ContactView *v;
  Forest             forest;
  PetscReal         *sums;

  PetscFunctionBegin;
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCall(ProblemGetContact(problem, pair, &v));
  const PetscInt n = v->mortar.num_nodes;
  PetscCall(PetscCalloc1(NUM_SUMS * n, &sums));
  PetscCall(Sums_Private(problem, v, from, sums));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(NUM_SUMS * n), MPIU_REAL, MPI_SUM, ForestComm(forest)));
  for (PetscInt m = 0; m < n; ++m) {
    const PetscReal *s = sums + NUM_SUMS * m;
    to->pressure[m]    = s[SUM_ALL] > 0 ? s[SUM_PRESSURE] / s[SUM_ALL] : 0;
    to->gap[m]         = s[SUM_KNOWN] > 0 ? s[SUM_GAP] / s[SUM_KNOWN] : 0;
    to->status[m]      = !(s[SUM_KNOWN] > 0) ? CONTACT_ALONE : 2 * s[SUM_ACTIVE] >= s[SUM_KNOWN] ? CONTACT_TOUCHING : CONTACT_OPEN;
  }
  Follow_Private(&v->mortar, to);
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}
