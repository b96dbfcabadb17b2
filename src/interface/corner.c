/* Sharp corners (plane) and edges (space) of the mortar side that press within facets of the nonmortar side, or at nodes of it alone. Gaps to both sides of
   such an edge open away from it and are weighted with functions that are fixed to the facets, so that the edge rides over bumps whose slope is that of the
   gaps, at any size of facets. The side of the edge has nodes there, and is the better one to carry the multipliers (theory, 5, roles). */
#include "interfaceimpl.h"

/* Two facets of the mortar side that meet, in the plane at a node, in space along an edge, and where on each (Ends_Private); ends: its first and last node;
   turn: the angle from one facet to the other at the reference positions, 0 inwards. */
typedef struct {
  PetscInt  facet[2], place[2], ends[2];
  PetscReal turn;
} Edge;

/* What it faces, as all ranks know: 1 or 0, and how long the facets are (plane: length; space: root of the area) that it presses on. */
typedef struct {
  PetscReal flat, inside, presses, length;
} Seen;

static PetscInt Places_Private(const Surface *s)
{
  return s->dim == 2 ? 2 : 4;
}

/* The nodes at an end of a facet of the plane, or along one of its four edges. */
static void Ends_Private(const Surface *s, PetscInt facet, PetscInt place, PetscInt ends[2])
{
  const PetscInt *v = s->facets + s->corners * facet;

  ends[0] = v[place];
  ends[1] = s->dim == 2 ? v[place] : v[(place + 1) % 4];
}

/* Is a corner of a segment at this place of its mortar facet? In space segments are cut along directions that vary: that near to it. */
static PetscBool IsOn_Private(PetscInt dim, const ContactSegment *e, PetscInt corner, PetscInt place)
{
  const PetscInt  axis = dim == 2 ? 0 : (place + 1) % 2;
  const PetscReal end  = dim == 2 ? (place ? 1 : -1) : (place == 0 || place == 3 ? -1 : 1);

  return (PetscBool)(PetscAbsReal(e->eta[corner][axis] - end) <= (dim == 2 ? CONTACT_ROUND : CONTACT_SLIVER));
}

/* Does it reach it, with an end or along an edge? */
static PetscBool Reaches_Private(PetscInt dim, const ContactSegment *e, PetscInt place)
{
  PetscInt on = 0;

  for (PetscInt k = 0; k < e->num; ++k) on += IsOn_Private(dim, e, k, place);
  return (PetscBool)(on >= dim - 1);
}

static PetscReal Length_Private(const Surface *s, PetscInt facet)
{
  const PetscReal measure = SurfaceMeasure_Private(s, s->X, facet);
  return s->dim == 2 ? measure : PetscSqrtReal(measure);
}

/* Edge.turn, from the facets' mean normals. */
static PetscReal Turn_Private(const Surface *s, const Edge *e)
{
  PetscReal N[2][3], out = 0;

  for (PetscInt k = 0; k < 2; ++k) (void)ContactFacetNormal(s->dim, s->X, s->facets + s->corners * e->facet[k], N[k]);
  for (PetscInt k = 0; k < s->corners; ++k)
    for (PetscInt d = 0; d < s->dim; ++d) out += N[0][d] * (s->X[s->dim * s->facets[s->corners * e->facet[1] + k] + d] - s->X[s->dim * e->ends[0] + d]);
  return out < 0 ? PetscAcosReal(PetscMax(-1, PetscMin(1, Dot3(N[0], N[1])))) : 0;
}

/* Is it a corner, of more than 40 degrees, to facets of this length? Where curved facets meet smoothly, few of them round a ball, so much of the angle counts
   as a facet wraps round. */
static PetscBool IsSharp_Private(const Surface *s, const Edge *e, PetscReal length)
{
  const ContactSurface reference = SurfaceAt_Private(s, s->X);

  if (ContactFacetJoint(&reference, e->facet[0], e->facet[1]) == JOINT_SHARP) return PETSC_TRUE;
  return (PetscBool)(2 * e->turn * length > PetscAcosReal(CONTACT_SHARP) * (Length_Private(s, e->facet[0]) + Length_Private(s, e->facet[1])));
}

/* A place of a facet, for pairs of them to be found. */
typedef struct {
  PetscInt least, most, facet, place;
} Half;

static int CompareHalves_Private(const void *a, const void *b)
{
  const Half *x = a, *y = b;

  if (x->least != y->least) return x->least < y->least ? -1 : 1;
  if (x->most != y->most) return x->most < y->most ? -1 : 1;
  return x->facet < y->facet ? -1 : x->facet > y->facet;
}

/* The edges of a surface at which it turns outwards by more than 40 degrees, where exactly two facets meet, and at[facet][place]: their numbers, -1. (Edges
 * that hang are none.) */
static PetscErrorCode Edges_Private(const Surface *s, PetscInt *num, Edge edge[], PetscInt at[])
{
  const PetscInt places = Places_Private(s), halves = places * s->num_facets;
  Half          *half;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(halves, &half));
  for (PetscInt i = 0; i < halves; ++i) {
    PetscInt ends[2];
    Ends_Private(s, i / places, i % places, ends);
    half[i] = (Half){PetscMin(ends[0], ends[1]), PetscMax(ends[0], ends[1]), i / places, i % places};
    at[i]   = -1;
  }
  qsort(half, (size_t)halves, sizeof(Half), CompareHalves_Private);
  *num = 0;
  for (PetscInt i = 0, end; i < halves; i = end) {
    for (end = i + 1; end < halves && half[end].least == half[i].least && half[end].most == half[i].most;) ++end;
    if (end != i + 2) continue;
    Edge e = {{half[i].facet, half[i + 1].facet}, {half[i].place, half[i + 1].place}, {half[i].least, half[i].most}, 0};
    e.turn = Turn_Private(s, &e);
    if (e.turn <= PetscAcosReal(CONTACT_SHARP)) continue;
    for (PetscInt k = 0; k < 2; ++k) at[places * e.facet[k] + e.place[k]] = *num;
    edge[(*num)++] = e;
  }
  PetscCall(PetscFree(half));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Position of a point of a facet. */
static void Point_Private(const Surface *s, PetscInt facet, const PetscReal xi[2], PetscReal x[3])
{
  const PetscInt *on, num = SurfaceNodes_Private(s, facet, &on);
  PetscReal       shape[SURFACE_MOST_NODES];

  SurfaceShape(s->dim, s->order[facet], xi, shape, NULL);
  for (PetscInt d = 0; d < 3; ++d) {
    x[d] = 0;
    for (PetscInt k = 0; k < num && d < s->dim; ++k) x[d] += shape[k] * s->x[s->dim * on[k] + d];
  }
}

/* Is a corner of the segment inside the other body, or off by less than a share of the facet's length? Where an edge is a little within a facet, no mean of
   gaps may be closed yet. */
static PetscBool IsInside_Private(const Contact *c, const ContactSegment *e, PetscInt corner, const PetscReal N[3], PetscReal slack)
{
  PetscReal x[2][3], gap = 0;

  Point_Private(&c->side[0], e->facet, e->xi[corner], x[0]);
  Point_Private(&c->side[1], e->mortar_facet, e->eta[corner], x[1]);
  for (PetscInt d = 0; d < 3; ++d) gap += N[d] * (x[1][d] - x[0][d]);
  return (PetscBool)(gap < slack * PetscSqrtReal(Dot3(N, N)) * Length_Private(&c->side[0], e->facet));
}

/* One segment that reaches an edge. */
static void Look_Private(const Contact *c, const ContactSegment *e, PetscInt place, PetscReal slack, Seen *seen)
{
  const Surface *s = &c->side[0], *m = &c->side[1];
  PetscReal      N[3], M[3], across[3];

  ContactFacetVector(s->dim, s->x, s->facets + s->corners * e->facet, N);
  ContactFacetVector(m->dim, m->x, m->facets + m->corners * e->mortar_facet, M);
  Cross3(N, M, across);
  if (Dot3(across, across) <= PetscSqr(CONTACT_SLIVER) * Dot3(N, N) * Dot3(M, M)) seen->flat = 1;
  seen->length = PetscMax(seen->length, Length_Private(s, e->facet));
  for (PetscInt k = 0; k < e->num; ++k)
    if (IsOn_Private(s->dim, e, k, place) && IsInside_Private(c, e, k, N, slack)) seen->inside = 1;
}

static PetscBool IsPressed_Private(const Contact *c, PetscInt node)
{
  return (PetscBool)(c->has_multiplier[node] && c->valued[node] && c->active[node]);
}

/* The facet is one of those that the edge faces. */
static void Mark_Private(const Contact *c, PetscInt facet, Seen *seen, int8_t mark[])
{
  const PetscInt *node, num = SurfaceNodes_Private(&c->side[0], facet, &node);

  mark[facet] = 1;
  for (PetscInt k = 0; k < num; ++k)
    if (IsPressed_Private(c, node[k])) seen->presses = 1;
}

/* Visits the segments of this rank's facets that reach an edge: what they tell of it, or (mark) which facets it faces if none of its own lies flat there. */
static PetscErrorCode Segments_Private(const Contact *c, PetscReal slack, const PetscInt at[], Seen seen[], int8_t mark[])
{
  const PetscInt        places = Places_Private(&c->side[1]);
  const ContactSegment *e;
  PetscInt              num;

  PetscFunctionBegin;
  ContactPairGetSegments(c->pair, &num, &e);
  for (PetscInt i = 0; i < num; ++i)
    for (PetscInt k = 0; k < places; ++k) {
      const PetscInt edge = at[places * e[i].mortar_facet + k];
      if (edge < 0 || !Reaches_Private(c->side[1].dim, &e[i], k)) continue;
      if (!mark)
        Look_Private(c, &e[i], k, slack, &seen[edge]);
      else if (seen[edge].flat <= 0)
        Mark_Private(c, e[i].facet, &seen[edge], mark);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a node press that is of a facet beside the marked ones, and of none of these? Facets beside have a node in common with them. */
static PetscErrorCode Beside_Private(const Contact *c, const int8_t mark[], PetscBool *pressed)
{
  const Surface  *s = &c->side[0];
  const PetscInt *node;
  PetscBool      *of_marked; /* [node] */

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(s->num_nodes, &of_marked));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt num = SurfaceNodes_Private(s, f, &node);
    for (PetscInt k = 0; k < num && mark[f]; ++k) of_marked[node[k]] = PETSC_TRUE;
  }
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt num    = SurfaceNodes_Private(s, f, &node);
    PetscBool      beside = PETSC_FALSE, presses = PETSC_FALSE;
    for (PetscInt k = 0; k < num; ++k) {
      if (of_marked[node[k]])
        beside = PETSC_TRUE;
      else if (IsPressed_Private(c, node[k]))
        presses = PETSC_TRUE;
    }
    if (beside && presses) *pressed = PETSC_TRUE;
  }
  PetscCall(PetscFree(of_marked));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How often the facets at the edge are to be halved so that they are less than twice as long as the facets that it presses on. */
static PetscInt Splits_Private(const Surface *m, const Edge *edge, PetscReal length)
{
  PetscReal longest = PetscMax(Length_Private(m, edge->facet[0]), Length_Private(m, edge->facet[1]));
  PetscInt  splits  = 0;

  for (; longest >= length * (2 - ROUND_LENGTH); longest /= 2) ++splits;
  return splits;
}

static PetscErrorCode Add_Private(const Contact *c, const Edge *edge, PetscReal length, PetscInt *num, InterfaceCorner **list)
{
  const Surface *m      = &c->side[1];
  PetscInt       room   = *num;
  const PetscInt splits = Splits_Private(m, edge, length);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < m->dim - 1; ++k) {
    PetscCall(ArrayGrow(*num + 1, sizeof(**list), &room, list));
    (*list)[*num] = (InterfaceCorner){.pair = c->spec->pair, .splits = splits};
    for (PetscInt d = 0; d < m->dim; ++d) (*list)[*num].X[d] = m->X[m->dim * edge->ends[k] + d];
    ++*num;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The parts of one pair, which have the same sides: edges that press are added to the list. */
static PetscErrorCode Pair_Private(Interface p, PetscReal slack, PetscInt num_parts, const Contact part[], PetscInt *num, InterfaceCorner **list)
{
  const Surface *s = &part[0].side[0], *m = &part[0].side[1];
  PetscInt       edges, *at;
  PetscBool      beside = PETSC_FALSE;
  int8_t        *mark;
  Edge          *edge;
  Seen          *seen;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(Places_Private(m) * m->num_facets, &edge, Places_Private(m) * m->num_facets, &at));
  PetscCall(Edges_Private(m, &edges, edge, at));
  PetscCall(PetscCalloc2(edges, &seen, s->num_facets, &mark));
  const PetscMPIInt numbers = (PetscMPIInt)(sizeof(Seen) / sizeof(PetscReal)) * (PetscMPIInt)edges;
  for (PetscInt i = 0; i < num_parts && edges > 0; ++i) PetscCall(Segments_Private(&part[i], slack, at, seen, NULL));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seen, numbers, MPIU_REAL, MPI_MAX, p->comm));
  for (PetscInt i = 0; i < num_parts && edges > 0; ++i) PetscCall(Segments_Private(&part[i], slack, at, seen, mark));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seen, numbers, MPIU_REAL, MPI_MAX, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mark, (PetscMPIInt)s->num_facets, MPI_SIGNED_CHAR, MPI_MAX, p->comm));
  for (PetscInt i = 0; i < num_parts; ++i) PetscCall(Beside_Private(&part[i], mark, &beside));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &beside, 1, COMPAT_MPI_BOOL, MPI_LOR, p->comm));
  for (PetscInt k = 0; k < edges && !beside; ++k)
    if (seen[k].flat <= 0 && (seen[k].inside > 0 || seen[k].presses > 0) && IsSharp_Private(m, &edge[k], seen[k].length))
      PetscCall(Add_Private(&part[0], &edge[k], seen[k].length, num, list));
  PetscCall(PetscFree2(seen, mark));
  PetscCall(PetscFree2(edge, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a facet press with nodes that are not those of the edge? */
static PetscBool Bears_Private(const Contact *c, const Edge *e, PetscInt k)
{
  const PetscInt *node, num = SurfaceNodes_Private(&c->side[0], e->facet[k], &node);

  for (PetscInt i = 0; i < num; ++i)
    if (node[i] != e->ends[0] && node[i] != e->ends[1] && IsPressed_Private(c, node[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Does a nonmortar side press beside the facets at its sharp corners; does it press on both sides of one? */
static PetscErrorCode Spread_Private(const Contact *c, PetscBool *beside, PetscBool *both)
{
  const Surface *s      = &c->side[0];
  const PetscInt places = Places_Private(s);
  PetscInt       edges, *at;
  int8_t        *mark;
  Edge          *edge;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(places * s->num_facets, &edge, places * s->num_facets, &at));
  PetscCall(PetscCalloc1(s->num_facets, &mark));
  PetscCall(Edges_Private(s, &edges, edge, at));
  for (PetscInt k = 0; k < edges; ++k) {
    mark[edge[k].facet[0]] = mark[edge[k].facet[1]] = 1;
    if (Bears_Private(c, &edge[k], 0) && Bears_Private(c, &edge[k], 1)) *both = PETSC_TRUE;
  }
  PetscCall(Beside_Private(c, mark, beside));
  PetscCall(PetscFree(mark));
  PetscCall(PetscFree2(edge, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFindSpread(Interface p, uint64_t pairs, uint64_t *spread)
{
  uint64_t set[2] = {0, 0}; /* those that press beside corners, and on both sides of one */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c      = &p->contacts[i];
    PetscBool      beside = PETSC_FALSE, both = PETSC_FALSE;
    if (c->spec->pair >= 64 || !(pairs >> c->spec->pair & 1)) continue;
    PetscCall(Spread_Private(c, &beside, &both));
    if (beside) set[0] |= UINT64_C(1) << c->spec->pair;
    if (both) set[1] |= UINT64_C(1) << c->spec->pair;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, set, 2, MPI_UINT64_T, MPI_BOR, p->comm));
  *spread = set[0] & ~set[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFindCorners(Interface p, uint64_t pairs, PetscBool near, PetscInt *num, InterfaceCorner **corners)
{
  PetscFunctionBegin;
  *num     = 0;
  *corners = NULL;
  for (PetscInt i = 0, end; i < p->num_contacts; i = end) {
    const ContactSpec *spec = p->contacts[i].spec;
    for (end = i + 1; end < p->num_contacts && p->contacts[end].spec->pair == spec->pair;) ++end;
    if (spec->pair >= 64 || !(pairs >> spec->pair & 1) || spec->self || spec->node_to_segment || p->contacts[i].law->ties) continue;
    PetscCall(Pair_Private(p, near ? CONTACT_SLIVER : -CONTACT_ROUND, end - i, &p->contacts[i], num, corners));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
