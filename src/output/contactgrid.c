/* The contact surface of a state: nonmortar edges with gap, pressure and status, and on request the segments. The surface is replicated: rank 0 writes it. */
#include "output.h"

/* All pairs' nonmortar surfaces put together. */
typedef struct {
  PetscInt   num_points, num_facets;
  PetscReal *X, *displacement, *normal; /* owned [num_points][3] */
  PetscReal *gap, *pressure, *status;   /* owned [num_points] */
  PetscReal *pair, *cell;               /* owned [num_facets] */
  PetscInt  *conn;                      /* owned [num_facets][2] */
} ContactGrid;

/* Append a pair's surface at point, edge. */
static PetscErrorCode Append_Private(ContactGrid *g, PetscInt number, const ContactView *v)
{
  const SurfaceView *s = &v->nonmortar;
  const PetscReal   *normal;

  PetscFunctionBegin;
  PetscCall(ContactPairGetNormals(v->pair, &normal));
  for (PetscInt e = 0; e < s->num_facets; ++e, ++g->num_facets) {
    for (PetscInt k = 0; k < 2; ++k) g->conn[2 * g->num_facets + k] = g->num_points + s->facets[2 * e + k];
    g->pair[g->num_facets] = (PetscReal)number;
    g->cell[g->num_facets] = (PetscReal)s->facet_leaf[e];
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n, ++g->num_points) {
    const PetscInt  at      = g->num_points;
    const PetscBool covered = (PetscBool)(v->has_multiplier[n] && v->weight[n] > 0);
    for (PetscInt c = 0; c < 3; ++c) {
      g->X[3 * at + c]            = c < 2 ? s->X[2 * n + c] : 0;
      g->displacement[3 * at + c] = c < 2 ? s->x[2 * n + c] - s->X[2 * n + c] : 0;
      g->normal[3 * at + c]       = c < 2 && normal ? normal[2 * n + c] : 0;
    }
    g->gap[at]      = covered ? v->gap[n] / v->weight[n] : 0;
    g->pressure[at] = v->z[n];
    g->status[at]   = !covered ? -1 : v->active[n] ? 1 : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteSurface_Private(Writer writer, Problem problem, PetscInt num_contacts, PetscMPIInt rank)
{
  ContactGrid        g = {0};
  const ContactView *v;
  PetscInt           points = 0, edges = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num_contacts && rank == 0; ++i) {
    PetscCall(ProblemGetContact(problem, i, &v));
    points += v->nonmortar.num_nodes;
    edges += v->nonmortar.num_facets;
  }
  PetscCall(PetscMalloc3(3 * points, &g.X, 3 * points, &g.displacement, 3 * points, &g.normal));
  PetscCall(PetscMalloc3(points, &g.gap, points, &g.pressure, points, &g.status));
  PetscCall(PetscMalloc3(edges, &g.pair, edges, &g.cell, 2 * edges, &g.conn));
  for (PetscInt i = 0; i < num_contacts && rank == 0; ++i) {
    PetscCall(ProblemGetContact(problem, i, &v));
    PetscCall(Append_Private(&g, i, v));
  }
  PetscCall(WriterGrid(writer, "contact", CELL_POLYLINE2, g.num_points, g.X, g.num_facets, g.conn));
  PetscCall(WriterField(writer, "displacement", PETSC_FALSE, 3, g.displacement));
  PetscCall(WriterField(writer, "gap", PETSC_FALSE, 1, g.gap));
  PetscCall(WriterField(writer, "contact_pressure", PETSC_FALSE, 1, g.pressure));
  PetscCall(WriterField(writer, "status", PETSC_FALSE, 1, g.status));
  PetscCall(WriterField(writer, "normal", PETSC_FALSE, 3, g.normal));
  PetscCall(WriterField(writer, "pair", PETSC_TRUE, 1, g.pair));
  PetscCall(WriterField(writer, "cell", PETSC_TRUE, 1, g.cell));
  PetscCall(PetscFree3(g.X, g.displacement, g.normal));
  PetscCall(PetscFree3(g.gap, g.pressure, g.status));
  PetscCall(PetscFree3(g.pair, g.cell, g.conn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- segments ------------------------------------------------------------------------------------------------------------ */

/* Reference position and displacement at place in [-1, 1] of an edge. */
static void EdgePoint_Private(const SurfaceView *s, PetscInt edge, PetscReal place, PetscReal X[3], PetscReal displacement[3])
{
  const PetscInt a = s->facets[2 * edge], b = s->facets[2 * edge + 1];

  X[2] = displacement[2] = 0;
  for (PetscInt c = 0; c < 2; ++c) {
    X[c]            = 0.5 * ((1 - place) * s->X[2 * a + c] + (1 + place) * s->X[2 * b + c]);
    displacement[c] = 0.5 * ((1 - place) * s->x[2 * a + c] + (1 + place) * s->x[2 * b + c]) - X[c];
  }
}

/* Segments are written by the rank that owns the nonmortar edge's cell: edges at the border are evaluated by several. With X NULL they are counted only. */
static PetscErrorCode Segments_Private(Problem problem, const ForestTables *t, PetscMPIInt rank, PetscInt num_contacts, PetscInt *num, PetscReal *X,
                                       PetscReal *displacement, PetscReal *label[3])
{
  PetscFunctionBegin;
  *num = 0;
  for (PetscInt i = 0; i < num_contacts; ++i) {
    const ContactView    *v;
    const ContactSegment *segment;
    PetscInt              count;
    PetscCall(ProblemGetContact(problem, i, &v));
    PetscCall(ContactPairGetSegments(v->pair, &count, &segment));
    for (PetscInt s = 0; s < count; ++s) {
      if (t->leaf_rank[v->nonmortar.facet_leaf[segment[s].facet]] != rank) continue;
      for (PetscInt k = 0; k < 2 && X; ++k) {
        const PetscInt at = 3 * (4 * *num + k);
        EdgePoint_Private(&v->nonmortar, segment[s].facet, segment[s].xi[k][0], X + at, displacement + at);
        EdgePoint_Private(&v->mortar, segment[s].mortar_facet, segment[s].eta[k][0], X + at + 6, displacement + at + 6);
      }
      if (X) {
        label[0][*num] = (PetscReal)i;
        label[1][*num] = (PetscReal)segment[s].facet;
        label[2][*num] = (PetscReal)segment[s].mortar_facet;
      }
      ++*num;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteSegments_Private(Writer writer, Problem problem, const ForestTables *t, PetscInt num_contacts, PetscMPIInt rank)
{
  PetscReal *X, *displacement, *label[3];
  PetscInt   num, *conn;

  PetscFunctionBegin;
  PetscCall(Segments_Private(problem, t, rank, num_contacts, &num, NULL, NULL, NULL));
  PetscCall(PetscMalloc3(12 * num, &X, 12 * num, &displacement, 4 * num, &conn));
  PetscCall(PetscMalloc3(num, &label[0], num, &label[1], num, &label[2]));
  PetscCall(Segments_Private(problem, t, rank, num_contacts, &num, X, displacement, label));
  for (PetscInt i = 0; i < 4 * num; ++i) conn[i] = i;
  PetscCall(WriterGrid(writer, "segments", CELL_QUAD4, 4 * num, X, num, conn));
  PetscCall(WriterField(writer, "displacement", PETSC_FALSE, 3, displacement));
  PetscCall(WriterField(writer, "pair", PETSC_TRUE, 1, label[0]));
  PetscCall(WriterField(writer, "edge", PETSC_TRUE, 1, label[1]));
  PetscCall(WriterField(writer, "mortar_facet", PETSC_TRUE, 1, label[2]));
  PetscCall(PetscFree3(X, displacement, conn));
  PetscCall(PetscFree3(label[0], label[1], label[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputWriteContact(Writer writer, Problem problem)
{
  const SceneData    *scene;
  const ForestTables *t;
  Forest              forest;
  PetscMPIInt         rank;

  PetscFunctionBegin;
  PetscCall(ProblemGetScene(problem, &scene));
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCall(ForestGetTables(forest, &t));
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  PetscCall(WriteSurface_Private(writer, problem, scene->num_contacts, rank));
  if (scene->output.segments) PetscCall(WriteSegments_Private(writer, problem, t, scene->num_contacts, rank));
  PetscFunctionReturn(PETSC_SUCCESS);
}
