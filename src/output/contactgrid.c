/* The contact surfaces of a state: both sides of all pairs with gap, pressure, status and normal. Their values are gathered to all ranks, and rank 0 writes
 * them. */
#include "outputimpl.h"

/* All surfaces put together, pair by pair, the nonmortar side first. */
typedef struct {
  PetscInt   corners, num_points, num_facets;
  PetscReal *X, *displacement, *normal; /* owned [num_points][3] */
  PetscReal *gap, *pressure, *status;   /* owned [num_points] */
  PetscReal *shear, *slip, *traction;   /* owned [num_points], [num_points][3]: friction */
  PetscReal *pair, *side, *cell;        /* owned [num_facets] */
  PetscInt  *conn;                      /* owned [num_facets][corners], lexicographic */
} ContactGrid;

/* Facets of higher order are cut at their nodes. */
static PetscInt Pieces_Private(const SurfaceView *s, PetscInt facet)
{
  const PetscInt q = s->order[facet];
  return s->dim == 2 ? q : q * q;
}

static PetscInt AllPieces_Private(const SurfaceView *s)
{
  PetscInt sum = 0;

  for (PetscInt f = 0; f < s->num_facets; ++f) sum += Pieces_Private(s, f);
  return sum;
}

/* Corner k, lexicographic, of a piece of a facet. */
static PetscInt PieceCorner_Private(const SurfaceView *s, PetscInt facet, PetscInt piece, PetscInt k)
{
  const PetscInt q = s->order[facet];

  return s->lattice[s->first[facet] + piece % q + k % 2 + (q + 1) * (piece / q + k / 2)];
}

/* Append the shape of a side: points, facets, and what belongs to facets as a whole. Nodal fields stand at the returned place. */
static PetscInt AppendSurface_Private(ContactGrid *g, const SurfaceView *s, PetscInt pair, PetscInt side)
{
  const PetscInt first = g->num_points;

  for (PetscInt f = 0; f < s->num_facets; ++f) {
    for (PetscInt piece = 0; piece < Pieces_Private(s, f); ++piece, ++g->num_facets) {
      for (PetscInt k = 0; k < s->corners; ++k) g->conn[s->corners * g->num_facets + k] = first + PieceCorner_Private(s, f, piece, k);
      g->pair[g->num_facets] = (PetscReal)pair;
      g->side[g->num_facets] = (PetscReal)side;
      g->cell[g->num_facets] = (PetscReal)s->facet_leaf[f];
    }
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n, ++g->num_points) {
    for (PetscInt c = 0; c < 3; ++c) {
      g->X[3 * g->num_points + c]            = c < s->dim ? s->X[s->dim * n + c] : 0;
      g->displacement[3 * g->num_points + c] = c < s->dim ? s->x[s->dim * n + c] - s->X[s->dim * n + c] : 0;
    }
  }
  return first;
}

/* Place of node k of a facet, in [-1, 1]. */
static PetscErrorCode NodePlace_Private(const SurfaceView *s, PetscInt facet, PetscInt k, PetscReal xi[2])
{
  const PetscInt   q = s->order[facet];
  const PetscReal *nodes;

  PetscFunctionBegin;
  PetscCall(ElementGetNodes(q, &nodes));
  xi[0] = 2 * nodes[k % (q + 1)] - 1;
  xi[1] = 2 * nodes[k / (q + 1)] - 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sum of the unit normals of a node's facets at positions x, normalised. normal [num_nodes][3] */
static PetscErrorCode MeanNormals_Private(const SurfaceView *s, const PetscReal x[], PetscReal normal[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < 3 * s->num_nodes; ++i) normal[i] = 0;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt *node, num = SurfaceFacetNodes(s, f, &node);
    for (PetscInt k = 0; k < num; ++k) {
      PetscReal xi[2], N[3];
      PetscCall(NodePlace_Private(s, f, k, xi));
      OutputFacetNormal(s, x, f, xi, N);
      for (PetscInt c = 0; c < 3; ++c) normal[3 * node[k] + c] += N[c];
    }
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal      *N      = normal + 3 * n;
    const PetscReal length = PetscSqrtReal(N[0] * N[0] + N[1] * N[1] + N[2] * N[2]);
    for (PetscInt c = 0; c < 3 && length > 0; ++c) N[c] /= length;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Normals of the nonmortar side as the contact uses them. */
static void OwnNormals_Private(const ContactView *v, PetscReal normal[])
{
  const PetscInt dim = v->nonmortar.dim;

  for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n)
    for (PetscInt c = 0; c < 3; ++c) normal[3 * n + c] = c < dim ? v->normal[dim * n + c] : 0;
}

/* Tangential traction on either body from that along e_z x n of the nonmortar side: n of the other one is the opposite, and so is the force. In space it stands
   there. */
static void Tractions_Private(const SurfaceView *s, const ContactFields *f, PetscInt at, ContactGrid *g)
{
  for (PetscInt n = 0; n < s->num_nodes && s->dim == 2; ++n) {
    const PetscReal *N = g->normal + 3 * (at + n);
    PetscReal       *t = g->traction + 3 * (at + n);

    t[0] = f->shear[n] * N[1];
    t[1] = -f->shear[n] * N[0];
    t[2] = 0;
  }
}

/* Pressure and tangential traction of a tied pair, from the traction on the body. */
static void Tied_Private(const SurfaceView *s, const ContactFields *f, const PetscReal normal[])
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    f->pressure[n] = -Dot3(f->traction + 3 * n, normal + 3 * n);
    for (PetscInt c = 0; c < 3; ++c) f->traction[3 * n + c] += f->pressure[n] * normal[3 * n + c];
  }
}

/* What another part of the pair tells at the nodes of both sides: tractions are of the face that presses most, the gap is that of the nearest. */
static void AddPart_Private(const ContactGrid *g, PetscInt first, PetscInt part, PetscInt num)
{
  for (PetscInt to = first, n = part; to < first + num; ++to, ++n) {
    if (g->status[n] != CONTACT_ALONE && (g->status[to] == CONTACT_ALONE || g->gap[n] < g->gap[to])) g->gap[to] = g->gap[n];
    g->status[to] = PetscMax(g->status[to], g->status[n]);
    if (!(g->pressure[n] > g->pressure[to])) continue;
    g->pressure[to] = g->pressure[n];
    g->shear[to]    = g->shear[n];
    g->slip[to]     = g->slip[n];
    for (PetscInt c = 0; c < 3; ++c) g->traction[3 * to + c] = g->traction[3 * n + c];
  }
}

/* Both sides of a pair, named by its number; what its further parts tell enters there. first: its points. Collective: fields are gathered. */
static PetscErrorCode AppendPair_Private(ContactGrid *g, Problem problem, PetscInt i, PetscInt *first)
{
  const SceneData   *scene = ProblemGetScene(problem);
  const ContactView *v;
  ContactFields      fields[2];
  const PetscInt     points = g->num_points, facets = g->num_facets;

  PetscFunctionBegin;
  PetscCall(InterfaceGatherContactToAll(ProblemInterface(problem), i, &v));
  for (PetscInt k = 0; k < 2; ++k) {
    const SurfaceView *s  = k ? &v->mortar : &v->nonmortar;
    const PetscInt     at = AppendSurface_Private(g, s, v->spec->pair, k);
    fields[k]             = (ContactFields){g->gap + at, g->pressure + at, g->status + at, g->shear + at, g->slip + at, g->traction + 3 * at};
    if (k == 0 && v->spec->law != CONTACT_TIED)
      OwnNormals_Private(v, g->normal + 3 * at);
    else
      PetscCall(MeanNormals_Private(s, scene->mechanics.kinematics == KINEMATICS_SMALL ? s->X : s->x, g->normal + 3 * at));
  }
  OutputContactFields(v, &fields[0]);
  PetscCall(OutputProjectFields(problem, i, &fields[0], &fields[1]));
  for (PetscInt side = 0; side < 2; ++side) {
    const SurfaceView *s  = side ? &v->mortar : &v->nonmortar;
    const PetscInt     at = (PetscInt)(fields[side].gap - g->gap);
    if (v->spec->law == CONTACT_TIED)
      Tied_Private(s, &fields[side], g->normal + 3 * at);
    else
      Tractions_Private(s, &fields[side], at, g);
  }
  if (v->spec->part) {
    AddPart_Private(g, *first, points, g->num_points - points);
    g->num_points = points;
    g->num_facets = facets;
  } else
    *first = points;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteSurfaces_Private(Writer writer, Problem problem, const SceneData *scene, PetscMPIInt rank)
{
  const PetscInt     num_contacts = scene->num_contacts;
  ContactGrid        g            = {.corners = 2};
  const ContactView *v;
  PetscInt           points = 0, facets = 0, first = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num_contacts; ++i) {
    v         = InterfaceGetContact(ProblemInterface(problem), i);
    g.corners = v->nonmortar.corners;
    points += v->nonmortar.num_nodes + v->mortar.num_nodes;
    facets += AllPieces_Private(&v->nonmortar) + AllPieces_Private(&v->mortar);
  }
  PetscCall(PetscMalloc3(3 * points, &g.X, 3 * points, &g.displacement, 3 * points, &g.normal));
  PetscCall(PetscMalloc3(points, &g.gap, points, &g.pressure, points, &g.status));
  PetscCall(PetscMalloc3(points, &g.shear, points, &g.slip, 3 * points, &g.traction));
  PetscCall(PetscMalloc4(facets, &g.pair, facets, &g.side, facets, &g.cell, g.corners * facets, &g.conn));
  for (PetscInt i = 0; i < num_contacts; ++i) PetscCall(AppendPair_Private(&g, problem, i, &first));
  if (rank) g.num_points = g.num_facets = 0;
  PetscCall(WriterGrid(writer, "contact", g.corners == 2 ? CELL_POLYLINE2 : CELL_QUAD4, g.num_points, g.X, g.num_facets, g.conn));
  PetscCall(WriterField(writer, "displacement", PETSC_FALSE, 3, g.displacement));
  PetscCall(WriterField(writer, "gap", PETSC_FALSE, 1, g.gap));
  PetscCall(WriterField(writer, "contact_pressure", PETSC_FALSE, 1, g.pressure));
  PetscCall(WriterField(writer, "status", PETSC_FALSE, 1, g.status));
  const PetscBool slips = InterfaceSlips(ProblemInterface(problem));
  if (slips || InterfaceTies(ProblemInterface(problem))) PetscCall(WriterField(writer, "tangential_traction", PETSC_FALSE, 3, g.traction));
  if (slips) PetscCall(WriterField(writer, "slip", PETSC_FALSE, 1, g.slip));
  PetscCall(WriterField(writer, "normal", PETSC_FALSE, 3, g.normal));
  PetscCall(WriterField(writer, "pair", PETSC_TRUE, 1, g.pair));
  PetscCall(WriterField(writer, "side", PETSC_TRUE, 1, g.side));
  PetscCall(WriterField(writer, "cell", PETSC_TRUE, 1, g.cell));
  PetscCall(PetscFree3(g.X, g.displacement, g.normal));
  PetscCall(PetscFree3(g.gap, g.pressure, g.status));
  PetscCall(PetscFree3(g.shear, g.slip, g.traction));
  PetscCall(PetscFree4(g.pair, g.side, g.cell, g.conn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputWriteContact(Writer writer, Problem problem)
{
  const SceneData *scene = ProblemGetScene(problem);
  PetscMPIInt      rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(ForestComm(ProblemForest(problem)), &rank));
  PetscCall(WriteSurfaces_Private(writer, problem, scene, rank));
  if (scene->output.segments) PetscCall(OutputWriteSegments(writer, problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}
