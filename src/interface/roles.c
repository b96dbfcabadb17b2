/* Roles of the facets of a surface that may meet itself. Of two that face each other one is the nonmortar facet: that of the softer body, else that of the
   lower colour, else the one of the lower number, so none passes another whatever the colours are. Colours make roles the same over whole zones of contact, and
   put the seams between them where surfaces are farthest from meeting: facets that face each other should differ, and those side by side be alike. Both are
   ties with the distance at which the facet meets something for a length, and they are satisfied by growing length, as those of a shortest spanning tree; one
   that contradicts shorter ones is a seam, a crease between two walls for instance. Before all of them facets that bear stay nonmortar: multipliers that come
   from another mesh or a checkpoint keep their side.

   A pair that bears nothing has no forces, whatever its roles: they are chosen at every search until it bears, and stay. All parts of a pair (faces.c) have the
   same: facet f that sees g belongs to the part of g's colour, the other way round to that of f's. */
#include "interfaceimpl.h"

/* a and b are alike, or differ. */
typedef struct {
  PetscReal length;
  PetscInt  a, b;
  PetscBool differ;
} Bond;

/* What each facet meets first (-1: nothing), how far off, and the sum of the multipliers of its nodes. */
typedef struct {
  PetscInt  *partner;
  PetscReal *distance, *pressed;
} Facing;

static int Compare_Private(const void *a, const void *b)
{
  const Bond *x = a, *y = b;

  if (x->length != y->length) return x->length < y->length ? -1 : 1;
  if (x->differ != y->differ) return x->differ ? -1 : 1;
  if (x->a != y->a) return x->a < y->a ? -1 : 1;
  return x->b < y->b ? -1 : x->b > y->b;
}

/* The root of i's tree, and whether i differs from it. */
static PetscInt Root_Private(PetscInt parent[], PetscBool differs[], PetscInt i, PetscBool *differ)
{
  PetscInt root = i;

  *differ = PETSC_FALSE;
  for (; parent[root] != root; root = parent[root]) *differ = (PetscBool)(*differ != differs[root]);
  for (PetscBool rest = *differ; parent[i] != root && i != root;) { /* shorten the path */
    const PetscInt  next = parent[i];
    const PetscBool own  = differs[i];
    parent[i]            = root;
    differs[i]           = rest;
    rest                 = (PetscBool)(rest != own);
    i                    = next;
  }
  return root;
}

static void Join_Private(PetscInt parent[], PetscBool differs[], const Bond *tie)
{
  PetscBool      differ[2];
  const PetscInt a = Root_Private(parent, differs, tie->a, &differ[0]), b = Root_Private(parent, differs, tie->b, &differ[1]);

  if (a == b) return;
  parent[PetscMax(a, b)]  = PetscMin(a, b);
  differs[PetscMax(a, b)] = (PetscBool)((differ[0] != differ[1]) != tie->differ);
}

static void Pressed_Private(const Contact *c, PetscReal pressed[])
{
  const Surface *s = &c->side[0];

  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt *node, num = SurfaceNodes_Private(s, f, &node);
    for (PetscInt k = 0; k < num && c->mine[f]; ++k) pressed[f] += c->has_multiplier[node[k]] ? PetscAbsReal(c->z[node[k]]) : 0;
  }
}

/* The middle of a segment on either facet, and the gap there along the nonmortar one's normal. */
static PetscReal Gap_Private(const Contact *c, const ContactSegment *e)
{
  const PetscInt facet[2] = {e->facet, e->mortar_facet}, dim = c->side[0].dim;
  PetscReal      x[2][3] = {{0, 0, 0}, {0, 0, 0}}, N[SURFACE_MOST_NODES], n[3], gap = 0;

  for (PetscInt k = 0; k < 2; ++k) {
    const Surface  *s = &c->side[k];
    const PetscInt *node, num = SurfaceNodes_Private(s, facet[k], &node);
    PetscReal       xi[2] = {0, 0};
    for (PetscInt i = 0; i < e->num; ++i)
      for (PetscInt d = 0; d < dim - 1; ++d) xi[d] += (k ? e->eta : e->xi)[i][d] / (PetscReal)e->num;
    SurfaceShape(dim, s->order[facet[k]], xi, N, NULL);
    for (PetscInt i = 0; i < num; ++i)
      for (PetscInt d = 0; d < dim; ++d) x[k][d] += N[i] * s->x[dim * node[i] + d];
  }
  ContactFacetVector(dim, c->side[0].x, c->side[0].facets + c->side[0].corners * facet[0], n);
  for (PetscInt d = 0; d < dim; ++d) gap += (x[1][d] - x[0][d]) * n[d];
  return gap / PetscSqrtReal(Dot3(n, n));
}

/* All facets look at all others. Collective. */
static PetscErrorCode Look_Private(Interface p, Contact *c, Facing *to, PetscBool *failed)
{
  const ContactSurface  side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].x), SurfaceAt_Private(&c->side[1], c->side[1].x)};
  const PetscInt        n       = c->side[0].num_facets;
  const ContactSegment *segment;
  const ContactFacet   *facets;
  PetscInt              num;

  PetscFunctionBegin;
  ContactPairSetPrecedence(c->pair, NULL);
  ContactPairSetMet(c->pair, NULL);
  PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], NULL, NULL, PETSC_FALSE, PETSC_FALSE, &num, &facets, failed));
  ContactPairGetSegments(c->pair, &num, &segment);
  for (PetscInt f = 0; f < n; ++f) {
    to->partner[f]  = -1;
    to->distance[f] = PETSC_MAX_REAL;
  }
  for (PetscInt i = 0; i < num && !*failed; ++i) {
    if (!c->mine[segment[i].facet]) continue;
    const PetscReal gap = Gap_Private(c, &segment[i]);
    if (!(gap < to->distance[segment[i].facet])) continue;
    to->distance[segment[i].facet] = gap;
    to->partner[segment[i].facet]  = segment[i].mortar_facet;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, failed, 1, MPIU_BOOL, MPI_LOR, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, to->partner, (PetscMPIInt)n, MPIU_INT, MPI_MAX, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, to->distance, (PetscMPIInt)n, MPIU_REAL, MPI_MIN, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Add_Private(Bond **tie, PetscInt *num, PetscInt *room, PetscReal length, PetscInt a, PetscInt b, PetscBool differ)
{
  PetscFunctionBegin;
  PetscCall(ArrayGrow(*num + 1, sizeof(Bond), room, tie));
  (*tie)[(*num)++] = (Bond){length, a, b, differ};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Colours_Private(const Surface *s, const PetscInt partner[], const PetscReal distance[], const PetscReal pressed[], PetscBool second[])
{
  const PetscInt n = s->num_facets; /* tie n: to bear */
  PetscInt      *parent, num = 0, room = 0;
  PetscBool     *differs, bears;
  Bond          *tie = NULL;

  PetscFunctionBegin;
  for (PetscInt f = 0; f < n; ++f) {
    if (partner[f] < 0) continue;
    if (pressed[f] > pressed[partner[f]]) PetscCall(Add_Private(&tie, &num, &room, PETSC_MIN_REAL, f, n, PETSC_FALSE));
    PetscCall(Add_Private(&tie, &num, &room, distance[f], f, partner[f], PETSC_TRUE));
  }
  for (PetscInt j = 0; j < s->num_nodes; ++j) {
    for (PetscInt k = s->node_first[j] + 1; k < s->node_first[j + 1]; ++k) {
      const PetscInt f = s->node_facet[k - 1], g = s->node_facet[k];
      if (partner[f] < 0 || partner[g] < 0) continue;
      PetscCall(Add_Private(&tie, &num, &room, PetscMax(distance[f], distance[g]), f, g, PETSC_FALSE));
    }
  }
  qsort(tie, (size_t)num, sizeof(Bond), Compare_Private);
  PetscCall(PetscMalloc2(n + 1, &parent, n + 1, &differs));
  for (PetscInt f = 0; f <= n; ++f) parent[f] = f, differs[f] = PETSC_FALSE;
  for (PetscInt i = 0; i < num; ++i) Join_Private(parent, differs, &tie[i]);
  const PetscInt bearing = Root_Private(parent, differs, n, &bears);
  for (PetscInt f = 0; f < n; ++f) {
    const PetscInt root = Root_Private(parent, differs, f, &second[f]);
    if (root == bearing) second[f] = (PetscBool)(second[f] != bears);
  }
  PetscCall(PetscFree2(parent, differs));
  PetscCall(PetscFree(tie));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Softer bodies first, then by colour, then by number. */
static void Order_Private(Interface p, const Contact *c, const PetscBool second[])
{
  const Surface      *s = &c->side[0];
  const ForestTables *t = p->tables;

  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscReal young  = MaterialYoung(p->spec->bodies[t->leaf_body[s->facet_leaf[f]]].material);
    PetscInt        softer = 0;
    for (PetscInt b = 0; b < p->spec->num_bodies; ++b) softer += !p->spec->bodies[b].material->law->rigid && MaterialYoung(p->spec->bodies[b].material) < young;
    c->precedence[f] = (2 * softer + (second[f] ? 1 : 0)) * s->num_facets + f;
  }
}

PetscErrorCode ContactRoles_Private(Interface p, PetscInt num, Contact part[], Vec x, const PetscReal u[])
{
  Contact       *c    = &part[0];
  const PetscInt n    = c->side[0].num_facets;
  PetscReal      most = 0;
  Facing         facing;
  PetscBool     *second, failed = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscMalloc4(n, &facing.partner, n, &facing.distance, n, &facing.pressed, n, &second));
  PetscCall(PetscArrayzero(facing.pressed, n));
  for (PetscInt i = 0; i < num; ++i) {
    PetscCall(ContactGatherMultipliers_Private(p, &part[i], x));
    Pressed_Private(&part[i], facing.pressed);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, facing.pressed, (PetscMPIInt)n, MPIU_REAL, MPI_MAX, p->comm));
  for (PetscInt f = 0; f < n; ++f) most = PetscMax(most, facing.pressed[f]);
  if (!c->precedence || most == 0) {
    for (PetscInt k = 0; k < 2; ++k) PetscCall(SurfaceGather_Private(p, &c->side[k], u, ContactBase_Private(c, k), c->side[k].x));
    PetscCall(Look_Private(p, c, &facing, &failed));
    if (!c->precedence) PetscCall(PetscCalloc1(n, &c->precedence));
    PetscCall(Colours_Private(&c->side[0], facing.partner, facing.distance, facing.pressed, second));
    Order_Private(p, c, second);
    for (PetscInt i = 0; i < num; ++i) {
      part[i].precedence = c->precedence;
      ContactPairSetPrecedence(part[i].pair, c->precedence);
      ContactPairSetMet(part[i].pair, part[i].side[1].met);
    }
  }
  PetscCall(PetscFree4(facing.partner, facing.distance, facing.pressed, second));
  PetscFunctionReturn(PETSC_SUCCESS);
}
