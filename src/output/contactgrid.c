/* The contact surfaces of a state: both sides of all pairs with gap, pressure, status and normal. Their values are gathered to all ranks, and rank 0 writes
 * them. */
#include "outputimpl.h"

/* All surfaces put together, pair by pair, the nonmortar side first. */
typedef struct {
  PetscInt   corners, num_points, num_facets;
  PetscReal *X, *displacement, *normal; /* owned [num_points][3] */
  PetscReal *gap, *pressure, *status;   /* owned [num_points] */
  PetscReal *pair, *side, *cell;        /* owned [num_facets] */
  PetscInt  *conn;                      /* owned [num_facets][corners], lexicographic */
} ContactGrid;

/* Append the shape of a side: points, facets, and what belongs to facets as a whole. Nodal fields stand at the returned place. */
static PetscInt AppendSurface_Private(ContactGrid *g, const SurfaceView *s, PetscInt pair, PetscInt side)
{
  static const PetscInt lexicographic[4] = {0, 1, 3, 2};
  const PetscInt        first            = g->num_points;

  for (PetscInt f = 0; f < s->num_facets; ++f, ++g->num_facets) {
    for (PetscInt k = 0; k < s->corners; ++k) g->conn[s->corners * g->num_facets + k] = first + s->facets[s->corners * f + lexicographic[k]];
    g->pair[g->num_facets] = (PetscReal)pair;
    g->side[g->num_facets] = (PetscReal)side;
    g->cell[g->num_facets] = (PetscReal)s->facet_leaf[f];
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n, ++g->num_points) {
    for (PetscInt c = 0; c < 3; ++c) {
      g->X[3 * g->num_points + c]            = c < s->dim ? s->X[s->dim * n + c] : 0;
      g->displacement[3 * g->num_points + c] = c < s->dim ? s->x[s->dim * n + c] - s->X[s->dim * n + c] : 0;
    }
  }
  return first;
}

/* Sum of the unit normals of a node's facets at positions x, normalised. normal [num_nodes][3] */
static void MeanNormals_Private(const SurfaceView *s, const PetscReal x[], PetscReal normal[])
{
  for (PetscInt i = 0; i < 3 * s->num_nodes; ++i) normal[i] = 0;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    PetscReal N[3];
    OutputFacetNormal(s, x, f, N);
    for (PetscInt k = 0; k < s->corners; ++k)
      for (PetscInt c = 0; c < 3; ++c) normal[3 * s->facets[s->corners * f + k] + c] += N[c];
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal      *N      = normal + 3 * n;
    const PetscReal length = PetscSqrtReal(N[0] * N[0] + N[1] * N[1] + N[2] * N[2]);
    for (PetscInt c = 0; c < 3 && length > 0; ++c) N[c] /= length;
  }
}

/* Normals of the nonmortar side as the contact uses them. */
static void OwnNormals_Private(const ContactView *v, PetscReal normal[])
{
  const PetscInt dim = v->nonmortar.dim;

  for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n)
    for (PetscInt c = 0; c < 3; ++c) normal[3 * n + c] = c < dim ? v->normal[dim * n + c] : 0;
}

/* Both sides of a pair. Collective: fields are gathered. */
static PetscErrorCode AppendPair_Private(ContactGrid *g, Problem problem, PetscInt pair)
{
  const SceneData   *scene;
  const ContactView *v;
  ContactFields      fields[2];

  PetscFunctionBegin;
  PetscCall(ProblemGetScene(problem, &scene));
  PetscCall(ProblemGatherContactToAll(problem, pair, &v));
  for (PetscInt side = 0; side < 2; ++side) {
    const SurfaceView *s  = side ? &v->mortar : &v->nonmortar;
    const PetscInt     at = AppendSurface_Private(g, s, pair, side);
    fields[side]          = (ContactFields){g->gap + at, g->pressure + at, g->status + at};
    if (side == 0)
      OwnNormals_Private(v, g->normal + 3 * at);
    else
      MeanNormals_Private(s, scene->mechanics.kinematics == KINEMATICS_SMALL ? s->X : s->x, g->normal + 3 * at);
  }
  OutputContactFields(v, &fields[0]);
  PetscCall(OutputProjectFields(problem, pair, &fields[0], &fields[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteSurfaces_Private(Writer writer, Problem problem, PetscInt num_contacts, PetscMPIInt rank)
{
  ContactGrid        g = {.corners = 2};
  const ContactView *v;
  PetscInt           points = 0, facets = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num_contacts; ++i) {
    PetscCall(ProblemGetContact(problem, i, &v));
    g.corners = v->nonmortar.corners;
    points += v->nonmortar.num_nodes + v->mortar.num_nodes;
    facets += v->nonmortar.num_facets + v->mortar.num_facets;
  }
  PetscCall(PetscMalloc3(3 * points, &g.X, 3 * points, &g.displacement, 3 * points, &g.normal));
  PetscCall(PetscMalloc3(points, &g.gap, points, &g.pressure, points, &g.status));
  PetscCall(PetscMalloc4(facets, &g.pair, facets, &g.side, facets, &g.cell, g.corners * facets, &g.conn));
  for (PetscInt i = 0; i < num_contacts; ++i) PetscCall(AppendPair_Private(&g, problem, i));
  if (rank) g.num_points = g.num_facets = 0;
  PetscCall(WriterGrid(writer, "contact", g.corners == 2 ? CELL_POLYLINE2 : CELL_QUAD4, g.num_points, g.X, g.num_facets, g.conn));
  PetscCall(WriterField(writer, "displacement", PETSC_FALSE, 3, g.displacement));
  PetscCall(WriterField(writer, "gap", PETSC_FALSE, 1, g.gap));
  PetscCall(WriterField(writer, "contact_pressure", PETSC_FALSE, 1, g.pressure));
  PetscCall(WriterField(writer, "status", PETSC_FALSE, 1, g.status));
  PetscCall(WriterField(writer, "normal", PETSC_FALSE, 3, g.normal));
  PetscCall(WriterField(writer, "pair", PETSC_TRUE, 1, g.pair));
  PetscCall(WriterField(writer, "side", PETSC_TRUE, 1, g.side));
  PetscCall(WriterField(writer, "cell", PETSC_TRUE, 1, g.cell));
  PetscCall(PetscFree3(g.X, g.displacement, g.normal));
  PetscCall(PetscFree3(g.gap, g.pressure, g.status));
  PetscCall(PetscFree4(g.pair, g.side, g.cell, g.conn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputWriteContact(Writer writer, Problem problem)
{
  const SceneData *scene;
  Forest           forest;
  PetscMPIInt      rank;

  PetscFunctionBegin;
  PetscCall(ProblemGetScene(problem, &scene));
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  PetscCall(WriteSurfaces_Private(writer, problem, scene->num_contacts, rank));
  if (scene->output.segments) PetscCall(OutputWriteSegments(writer, problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}
