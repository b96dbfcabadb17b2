/* Sharp corners of the mortar side that press within a facet of the nonmortar side, or at a node of it alone, in the plane. Gaps to both sides of such a corner
   open away from it and are weighted with functions that are fixed to the facet, so that the corner rides over bumps whose slope is that of the gaps, at any
   size of facets. The side of the corner has a node there, and is the better one to carry the multipliers (theory, 5, roles). */
#include "interfaceimpl.h"

#define ENDS 2 /* of the mortar facets at a corner: that of the facet before it, and of the one after */

/* A corner: nonmortar facet that faces either end, -1: it faces nothing; how the mortar facet slants to it (sine of the angle); is the corner inside? */
typedef struct {
  PetscReal facet[ENDS], slant[ENDS], inside;
} Seen;

/* What presses there: nodes of the facet that the corner lies in, or of the two that it lies between; and nodes of those beside. */
typedef struct {
  PetscReal there, beside;
} Pressed;

/* The facets of an outline that end and begin at each of its corners; -1: there is none. */
static void Neighbours_Private(const Surface *s, PetscInt before[], PetscInt after[])
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) before[n] = after[n] = -1;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    after[s->facets[2 * f]]      = f;
    before[s->facets[2 * f + 1]] = f;
  }
}

/* Of the angle from one vector to another one. */
static void Angle_Private(const PetscReal a[3], const PetscReal b[3], PetscReal *cosine, PetscReal *sine)
{
  const PetscReal size = PetscSqrtReal(Dot3(a, a) * Dot3(b, b));

  *cosine = Dot3(a, b) / size;
  *sine   = (a[0] * b[1] - a[1] * b[0]) / size;
}

/* Convex, by more than 40 degrees at the reference positions. */
static PetscBool IsCorner_Private(const Surface *s, PetscInt before, PetscInt after)
{
  PetscReal a[3], b[3], cosine, sine;

  if (before < 0 || after < 0) return PETSC_FALSE;
  ContactFacetVector(2, s->X, s->facets + 2 * before, a);
  ContactFacetVector(2, s->X, s->facets + 2 * after, b);
  Angle_Private(a, b, &cosine, &sine);
  return (PetscBool)(sine > 0 && cosine < CONTACT_SHARP);
}

/* Does a node of facet f press, but for those that it shares with facet `but` (-1: none)? */
static PetscBool Presses_Private(const Contact *c, PetscInt f, PetscInt but)
{
  const Surface  *s = &c->side[0];
  const PetscInt *node, *other = NULL, num = SurfaceNodes_Private(s, f, &node), others = but < 0 ? 0 : SurfaceNodes_Private(s, but, &other);

  for (PetscInt k = 0; k < num; ++k) {
    PetscBool shared = PETSC_FALSE;
    for (PetscInt i = 0; i < others; ++i) shared = (PetscBool)(shared || other[i] == node[k]);
    if (!shared && c->has_multiplier[node[k]] && c->valued[node[k]] && c->active[node[k]]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Is the corner inside the other body, or off by less than a share of the facet's length? Where it is a little within a facet, no mean of gaps may be closed
   yet. */
static PetscBool IsInside_Private(const Contact *c, const ContactSegment *e, PetscInt end, const PetscReal N[3], PetscReal slack)
{
  const Surface  *s = &c->side[0], *m = &c->side[1];
  const PetscInt *node, num = SurfaceNodes_Private(s, e->facet, &node), corner = m->facets[2 * e->mortar_facet + (e->eta[end][0] > 0)];
  PetscReal       shape[SURFACE_MOST_NODES], gap = 0;

  SurfaceShape(2, s->order[e->facet], e->xi[end], shape, NULL);
  for (PetscInt d = 0; d < 2; ++d) {
    PetscReal x = 0;
    for (PetscInt k = 0; k < num; ++k) x += shape[k] * s->x[2 * node[k] + d];
    gap += N[d] * (m->x[2 * corner + d] - x);
  }
  return (PetscBool)(gap < slack * Dot3(N, N));
}

/* One end of a segment lies at a corner. */
static void Look_Private(const Contact *c, const ContactSegment *e, PetscInt at, PetscReal slack, Seen *seen)
{
  const PetscInt end = e->eta[at][0] > 0 ? 0 : 1; /* the facet before the corner ends there */
  PetscReal      N[3], M[3], cosine, sine;

  ContactFacetVector(2, c->side[0].x, c->side[0].facets + 2 * e->facet, N);
  ContactFacetVector(2, c->side[1].x, c->side[1].facets + 2 * e->mortar_facet, M);
  Angle_Private(N, M, &cosine, &sine);
  seen->facet[end] = (PetscReal)e->facet;
  seen->slant[end] = PetscAbsReal(sine);
  if (IsInside_Private(c, e, at, N, slack)) seen->inside = 1;
}

/* What the segments of this rank's facets tell of the corners, seen[corner[mortar node]]. */
static PetscErrorCode Segments_Private(const Contact *c, PetscReal slack, const PetscInt corner[], Seen seen[])
{
  const ContactSegment *e;
  PetscInt              num;

  PetscFunctionBegin;
  ContactPairGetSegments(c->pair, &num, &e);
  for (PetscInt i = 0; i < num; ++i)
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscReal eta  = e[i].eta[k][0];
      const PetscInt  node = c->side[1].facets[2 * e[i].mortar_facet + (eta > 0)];
      if (PetscAbsReal(eta) < 1 - CONTACT_ROUND || corner[node] < 0) continue;
      Look_Private(c, &e[i], k, slack, &seen[corner[node]]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The facet that the corner lies in, first and last, or the two that it lies between; false: it faces nothing, or facets that are apart. */
static PetscBool Region_Private(const Surface *s, const PetscInt after[], const Seen *at, PetscInt *first, PetscInt *last)
{
  const PetscInt facet[ENDS] = {(PetscInt)at->facet[0], (PetscInt)at->facet[1]};
  const PetscInt k           = facet[0] < 0 || (facet[1] >= 0 && after[s->facets[2 * facet[0] + 1]] != facet[1]); /* the first */

  *first = facet[k];
  *last  = facet[1 - k] < 0 ? facet[k] : facet[1 - k];
  return (PetscBool)(*first >= 0 && (*first == *last || after[s->facets[2 * *first + 1]] == *last));
}

/* What presses of one part, as far as this rank knows. */
static void Press_Private(const Contact *c, const PetscInt before[], const PetscInt after[], const Seen *at, Pressed *pressed)
{
  const Surface *s = &c->side[0];
  PetscInt       first, last;

  if (!Region_Private(s, after, at, &first, &last)) return;
  const PetscInt beyond[2] = {before[s->facets[2 * first]], after[s->facets[2 * last + 1]]};
  if (Presses_Private(c, first, -1) || Presses_Private(c, last, -1)) pressed->there = 1;
  if ((beyond[0] >= 0 && Presses_Private(c, beyond[0], first)) || (beyond[1] >= 0 && Presses_Private(c, beyond[1], last))) pressed->beside = 1;
}

/* The corner presses as nothing beside it does, and both its faces turn away from the facet there: what does not face it is upright. */
static PetscBool IsAlone_Private(const Surface *s, const PetscInt after[], const Seen *at, const Pressed *pressed)
{
  PetscInt first, last;

  if (pressed->beside > 0 || (pressed->there <= 0 && at->inside <= 0) || !Region_Private(s, after, at, &first, &last)) return PETSC_FALSE;
  for (PetscInt k = 0; k < ENDS; ++k)
    if (at->facet[k] >= 0 && at->slant[k] <= CONTACT_SLIVER) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* How often the facets at the corner are to be halved so that they are less than twice as long as the facet that it presses on. */
static PetscInt Splits_Private(const Surface *s, const Surface *m, PetscInt before, PetscInt after, const Seen *at)
{
  const PetscReal length  = SurfaceMeasure_Private(s, s->X, (PetscInt)PetscMax(at->facet[0], at->facet[1])) * (2 - ROUND_LENGTH);
  PetscReal       longest = PetscMax(SurfaceMeasure_Private(m, m->X, before), SurfaceMeasure_Private(m, m->X, after));
  PetscInt        splits  = 0;

  for (; longest >= length; longest /= 2) ++splits;
  return splits;
}

/* The parts of one pair, which have the same sides: corners are added to the list. */
static PetscErrorCode Pair_Private(Interface p, PetscReal slack, PetscInt num_parts, const Contact part[], PetscInt *num, InterfaceCorner **list)
{
  const Surface *s = &part[0].side[0], *m = &part[0].side[1];
  PetscInt      *corner, *before[2], *after[2], corners = 0, room = *num;
  Seen          *seen;
  Pressed       *pressed;

  PetscFunctionBegin;
  PetscCall(PetscMalloc5(m->num_nodes, &corner, s->num_nodes, &before[0], s->num_nodes, &after[0], m->num_nodes, &before[1], m->num_nodes, &after[1]));
  for (PetscInt k = 0; k < 2; ++k) Neighbours_Private(&part[0].side[k], before[k], after[k]);
  for (PetscInt n = 0; n < m->num_nodes; ++n) corner[n] = IsCorner_Private(m, before[1][n], after[1][n]) ? corners++ : -1;
  PetscCall(PetscMalloc1(corners, &seen));
  PetscCall(PetscCalloc1(corners, &pressed));
  for (PetscInt k = 0; k < corners; ++k) seen[k] = (Seen){.facet = {-1, -1}};
  for (PetscInt i = 0; i < num_parts && corners > 0; ++i) PetscCall(Segments_Private(&part[i], slack, corner, seen));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seen, (PetscMPIInt)(sizeof(Seen) / sizeof(PetscReal)) * (PetscMPIInt)corners, MPIU_REAL, MPI_MAX, p->comm));
  for (PetscInt i = 0; i < num_parts; ++i)
    for (PetscInt k = 0; k < corners; ++k) Press_Private(&part[i], before[0], after[0], &seen[k], &pressed[k]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, pressed, 2 * (PetscMPIInt)corners, MPIU_REAL, MPI_MAX, p->comm));
  for (PetscInt n = 0; n < m->num_nodes; ++n) {
    if (corner[n] < 0 || !IsAlone_Private(s, after[0], &seen[corner[n]], &pressed[corner[n]])) continue;
    PetscCall(ArrayGrow(*num + 1, sizeof(**list), &room, list));
    InterfaceCorner *c = &(*list)[(*num)++];
    *c                 = (InterfaceCorner){.pair = part[0].spec->pair, .X = {m->X[2 * n], m->X[2 * n + 1], 0}};
    c->splits          = Splits_Private(s, m, before[1][n], after[1][n], &seen[corner[n]]);
  }
  PetscCall(PetscFree(seen));
  PetscCall(PetscFree(pressed));
  PetscCall(PetscFree5(corner, before[0], after[0], before[1], after[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFindCorners(Interface p, PetscBool near, PetscInt *num, InterfaceCorner **corners)
{
  PetscFunctionBegin;
  *num     = 0;
  *corners = NULL;
  for (PetscInt i = 0, end; i < p->num_contacts && p->dim == 2; i = end) {
    const ContactSpec *spec = p->contacts[i].spec;
    for (end = i + 1; end < p->num_contacts && p->contacts[end].spec->pair == spec->pair;) ++end;
    if (spec->self || spec->node_to_segment || p->contacts[i].law->ties) continue;
    PetscCall(Pair_Private(p, near ? CONTACT_SLIVER : -CONTACT_ROUND, end - i, &p->contacts[i], num, corners));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
