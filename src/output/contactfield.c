/* Gap, pressure and status at the nodes of both sides of a pair. The nonmortar side has them; at a mortar node m they are means over what faces it,

     f_m = int N_m f dgamma / int N_m dgamma   over the node's segments, dgamma the nonmortar side's length or area, f interpolated between nonmortar nodes,

   for the gap and the status over the nodes only that have one. Constants come over exactly, linear fields inside the zone up to half a facet. */
#include "outputimpl.h"

/* Numbers summed at a mortar node: int N_m, int N_m p, those of friction, and of nonmortar nodes that face something int N_m, int N_m g, int N_m [active];
   those of tractions as vectors. */
enum { SUM_ALL, SUM_PRESSURE, SUM_SHEAR, SUM_SLIP, SUM_KNOWN, SUM_GAP, SUM_ACTIVE, SUM_TRACTION, NUM_SUMS = SUM_TRACTION + 3 };

/* A point of a segment: place on both facets, share of the segment's length or area. */
typedef struct {
  PetscReal xi[2], eta[2], weight;
} SegmentPoint;

/* ---- facets -------------------------------------------------------------------------------------------------------------------- */

/* The interval between nodes that s of [0, 1] lies in, and the place in it. */
static PetscInt Interval_Private(PetscInt order, PetscReal s, PetscReal *place)
{
  const PetscReal *nodes;
  PetscInt         i = 0;

  PetscCallAbort(PETSC_COMM_SELF, ElementGetNodes(order, &nodes));
  while (i + 1 < order && s > nodes[i + 1]) ++i;
  *place = (s - nodes[i]) / (nodes[i + 1] - nodes[i]);
  return i;
}

/* Hats at xi[dim-1] in [-1, 1] of a facet's corners, of higher order: of the corners of the piece between nodes of the lattice that xi lies in; 2 or 4 of them
   and their nodes. */
static void FacetHats_Private(const SurfaceView *s, PetscInt facet, const PetscReal xi[], PetscReal N[4], PetscInt node[4])
{
  const PetscInt q      = s->order[facet];
  PetscInt       low[2] = {0, 0};
  PetscReal      at[2]  = {0, 0};

  for (PetscInt a = 0; a < s->dim - 1; ++a) low[a] = Interval_Private(q, 0.5 * (1 + xi[a]), &at[a]);
  for (PetscInt k = 0; k < s->corners; ++k) {
    N[k]    = ((k & 1) ? at[0] : 1 - at[0]) * ((k & 2) ? at[1] : 1 - at[1]);
    node[k] = s->lattice[s->first[facet] + low[0] + (k & 1) + (q + 1) * (low[1] + k / 2)];
  }
}

void OutputFacetPoint(const SurfaceView *s, const PetscReal x[], PetscInt facet, const PetscReal xi[], PetscReal point[3])
{
  const PetscInt *node, num = SurfaceFacetNodes(s, facet, &node);
  PetscReal       N[SURFACE_MOST_NODES];

  SurfaceShape(s->dim, s->order[facet], xi, N, NULL);
  for (PetscInt c = 0; c < 3; ++c) {
    point[c] = 0;
    for (PetscInt k = 0; k < num && c < s->dim; ++k) point[c] += N[k] * x[s->dim * node[k] + c];
  }
}

void OutputFacetNormal(const SurfaceView *s, const PetscReal x[], PetscInt facet, const PetscReal xi[], PetscReal normal[3])
{
  PetscReal tangent[2][3], length;

  if (s->higher) {
    SurfaceTangents(s, facet, x, xi, tangent);
    Cross3(tangent[0], tangent[1], normal);
  } else
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
    f->gap[n] = f->pressure[n] = f->shear[n] = f->slip[n] = 0;
    for (PetscInt c = 0; c < 3; ++c) f->traction[3 * n + c] = 0;
    f->status[n] = CONTACT_ALONE;
    for (PetscInt k = s->hang[n]; k < s->hang[n + 1]; ++k) {
      const PetscInt master = s->hang_master[k];
      f->pressure[n] += s->hang_weight[k] * f->pressure[master];
      f->shear[n] += s->hang_weight[k] * f->shear[master];
      f->slip[n] += s->hang_weight[k] * f->slip[master];
      for (PetscInt c = 0; c < 3; ++c) f->traction[3 * n + c] += s->hang_weight[k] * f->traction[3 * master + c];
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
    f->shear[n]             = v->slip && !v->traction ? v->z[v->nonmortar.num_nodes + n] : 0;
    f->slip[n]              = v->slip && covered && v->active[n] ? v->slip[n] : 0;
    f->status[n]            = !covered ? CONTACT_ALONE : v->active[n] ? CONTACT_TOUCHING : CONTACT_OPEN;
    for (PetscInt c = 0; c < 3; ++c) {
      const PetscReal tied   = v->spec->law == CONTACT_TIED && c < v->num_z ? v->z[c * v->nonmortar.num_nodes + n] : 0;
      f->traction[3 * n + c] = v->traction ? -v->traction[3 * n + c] : -tied;
    }
  }
  Follow_Private(&v->nonmortar, f);
}

/* ---- mortar side ------------------------------------------------------------------------------------------------------------------ */

/* Pieces along a segment, of which each has points of its own: facets of higher order are seen as pieces between nodes. */
static PetscInt Pieces_Private(const ContactView *v, const ContactSegment *s)
{
  return PetscMax(v->nonmortar.order[s->facet], v->mortar.order[s->mortar_facet]);
}

/* Two dimensions: the two Gauss points of each piece of a segment. A hit of node-to-segment contact is a point and counts as 1. */
static PetscInt EdgePoints_Private(const ContactView *v, const PetscReal x[], const ContactSegment *s, SegmentPoint point[])
{
  const PetscInt pieces = Pieces_Private(v, s);
  PetscReal      end[2][3], square = 0;

  for (PetscInt k = 0; k < 2; ++k) OutputFacetPoint(&v->nonmortar, x, s->facet, s->xi[k], end[k]);
  for (PetscInt c = 0; c < 2; ++c) square += PetscSqr(end[1][c] - end[0][c]);
  for (PetscInt q = 0; q < 2 * pieces; ++q) {
    const PetscReal at = (q / 2 + (0.5 + (q % 2 ? 0.5 : -0.5) / PetscSqrtReal(3.))) / pieces;
    point[q].xi[0]     = (1 - at) * s->xi[0][0] + at * s->xi[1][0];
    point[q].eta[0]    = (1 - at) * s->eta[0][0] + at * s->eta[1][0];
    point[q].weight    = 0.5 * (v->spec->node_to_segment ? 1 : PetscSqrtReal(square)) / pieces;
  }
  return 2 * pieces;
}

/* Corner k of the small triangle (i, j) of a triangle cut into n^2, upright or upside down, in weights of the large one's corners. */
static void Small_Private(PetscInt n, PetscInt i, PetscInt j, PetscBool down, PetscInt k, PetscReal weight[3])
{
  const PetscInt a = i + (down ? k < 2 : k == 1), b = j + (down ? k > 0 : k == 2);

  weight[0] = (PetscReal)(n - a - b) / (PetscReal)n;
  weight[1] = (PetscReal)a / (PetscReal)n;
  weight[2] = (PetscReal)b / (PetscReal)n;
}

/* The middles of the sides of a small triangle, and a third each of its share of the area (given twice). */
static void AddTriangle_Private(const ContactSegment *s, const PetscInt fan[3], PetscInt n, PetscInt i, PetscInt j, PetscBool down, PetscReal twice,
                                SegmentPoint point[3])
{
  PetscReal w[3][3];

  for (PetscInt k = 0; k < 3; ++k) Small_Private(n, i, j, down, k, w[k]);
  for (PetscInt q = 0; q < 3; ++q) {
    point[q].weight = twice / (6 * n * n);
    for (PetscInt c = 0; c < 2; ++c) {
      point[q].xi[c] = point[q].eta[c] = 0;
      for (PetscInt k = 0; k < 3; ++k) {
        const PetscReal share = 0.5 * (w[q][k] + w[(q + 1) % 3][k]);
        point[q].xi[c] += share * s->xi[fan[k]][c];
        point[q].eta[c] += share * s->eta[fan[k]][c];
      }
    }
  }
}

/* Three dimensions: the polygon as a fan of triangles, in pieces, the middles of whose sides integrate quadratic functions. */
static PetscInt PolygonPoints_Private(const ContactView *v, const PetscReal x[], const ContactSegment *s, SegmentPoint point[])
{
  const PetscInt n = Pieces_Private(v, s);
  PetscReal      corner[CONTACT_SEGMENT][3], normal[3], d[3], e[3];
  PetscInt       num = 0;

  for (PetscInt k = 0; k < s->num; ++k) OutputFacetPoint(&v->nonmortar, x, s->facet, s->xi[k], corner[k]);
  for (PetscInt k = 1; k + 1 < s->num; ++k) {
    const PetscInt fan[3] = {0, k, k + 1};
    for (PetscInt c = 0; c < 3; ++c) {
      d[c] = corner[k][c] - corner[0][c];
      e[c] = corner[k + 1][c] - corner[0][c];
    }
    Cross3(d, e, normal);
    const PetscReal twice = PetscSqrtReal(Dot3(normal, normal)); /* the area */
    for (PetscInt i = 0; i < n; ++i) {
      for (PetscInt j = 0; i + j < n; ++j) {
        AddTriangle_Private(s, fan, n, i, j, PETSC_FALSE, twice, point + 3 * num++);
        if (i + j < n - 1) AddTriangle_Private(s, fan, n, i, j, PETSC_TRUE, twice, point + 3 * num++);
      }
    }
  }
  return 3 * num;
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
  const PetscInt corners = v->nonmortar.corners;
  PetscInt       own[4], other[4];
  PetscReal      N[4], M[4], value[NUM_SUMS] = {[SUM_ALL] = 1};

  FacetHats_Private(&v->nonmortar, s->facet, point->xi, N, own);
  FacetHats_Private(&v->mortar, s->mortar_facet, point->eta, M, other);
  for (PetscInt k = 0; k < corners; ++k) {
    value[SUM_PRESSURE] += N[k] * f->pressure[own[k]];
    value[SUM_SHEAR] += N[k] * f->shear[own[k]];
    value[SUM_SLIP] += N[k] * f->slip[own[k]];
    for (PetscInt c = 0; c < 3; ++c) value[SUM_TRACTION + c] += N[k] * f->traction[3 * own[k] + c];
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
  const SceneData      *scene = ProblemGetScene(problem);
  const ContactSegment *segment;
  Forest                forest = ProblemForest(problem);
  const ForestTables   *t      = ForestGetTables(forest);
  PetscInt              num;
  PetscMPIInt           rank;
  SegmentPoint          point[3 * CONTACT_SEGMENT * MORTISE_MAX_ORDER * MORTISE_MAX_ORDER];

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  const PetscReal *x = scene->mechanics.kinematics == KINEMATICS_SMALL ? v->nonmortar.X : v->nonmortar.x;
  ContactPairGetSegments(v->pair, &num, &segment);
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
  PetscReal         *sums;

  PetscFunctionBegin;
  v                = InterfaceGetContact(ProblemInterface(problem), pair);
  const PetscInt n = v->mortar.num_nodes;
  PetscCall(PetscCalloc1(NUM_SUMS * n, &sums));
  PetscCall(Sums_Private(problem, v, from, sums));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, (PetscMPIInt)(NUM_SUMS * n), MPIU_REAL, MPI_SUM, ForestComm(ProblemForest(problem))));
  for (PetscInt m = 0; m < n; ++m) {
    const PetscReal *s = sums + NUM_SUMS * m;
    to->pressure[m]    = s[SUM_ALL] > 0 ? s[SUM_PRESSURE] / s[SUM_ALL] : 0;
    to->shear[m]       = s[SUM_ALL] > 0 ? s[SUM_SHEAR] / s[SUM_ALL] : 0;
    to->slip[m]        = s[SUM_ALL] > 0 ? s[SUM_SLIP] / s[SUM_ALL] : 0;
    for (PetscInt c = 0; c < 3; ++c) to->traction[3 * m + c] = s[SUM_ALL] > 0 ? -s[SUM_TRACTION + c] / s[SUM_ALL] : 0;
    to->gap[m]    = s[SUM_KNOWN] > 0 ? s[SUM_GAP] / s[SUM_KNOWN] : 0;
    to->status[m] = !(s[SUM_KNOWN] > 0) ? CONTACT_ALONE : 2 * s[SUM_ACTIVE] >= s[SUM_KNOWN] ? CONTACT_TOUCHING : CONTACT_OPEN;
  }
  Follow_Private(&v->mortar, to);
  PetscCall(PetscFree(sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}
