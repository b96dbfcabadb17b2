/* Grid segments: where one mortar facet faces one nonmortar facet. Two dimensions: a quad between both parts; three: a fan of triangles on the nonmortar facet.
 */
#include "outputimpl.h"

/* What this rank writes. */
typedef struct {
  PetscInt   corners, num_points, num_cells;
  PetscReal *X, *displacement, *gap; /* owned [num_points][3], [num_points] */
  PetscReal *label[3];               /* owned [num_cells] pair, facet, mortar_facet */
  PetscInt  *conn;                   /* owned [num_cells][corners] */
} SegmentGrid;

/* Points and cells of a segment. */
static PetscInt Points_Private(PetscInt dim, const ContactSegment *s)
{
  return dim == 2 ? 4 : s->num;
}
static PetscInt Cells_Private(PetscInt dim, const ContactSegment *s)
{
  return dim == 2 ? 1 : PetscMax(0, s->num - 2);
}

static void AddPoint_Private(SegmentGrid *g, const SurfaceView *s, PetscInt facet, const PetscReal xi[2])
{
  PetscReal *X = g->X + 3 * g->num_points, *displacement = g->displacement + 3 * g->num_points;

  OutputFacetPoint(s, s->X, facet, xi, X);
  OutputFacetPoint(s, s->x, facet, xi, displacement);
  for (PetscInt c = 0; c < 3; ++c) displacement[c] -= X[c];
  ++g->num_points;
}

static void AddCell_Private(SegmentGrid *g, PetscInt pair, const ContactSegment *s)
{
  g->label[0][g->num_cells]   = (PetscReal)pair;
  g->label[1][g->num_cells]   = (PetscReal)s->facet;
  g->label[2][g->num_cells++] = (PetscReal)s->mortar_facet;
}

static void AddQuad_Private(SegmentGrid *g, const ContactView *v, PetscInt pair, const ContactSegment *s)
{
  for (PetscInt k = 0; k < 4; ++k) g->conn[4 * g->num_cells + k] = g->num_points + k;
  for (PetscInt k = 0; k < 2; ++k) AddPoint_Private(g, &v->nonmortar, s->facet, s->xi[k]);
  for (PetscInt k = 0; k < 2; ++k) AddPoint_Private(g, &v->mortar, s->mortar_facet, s->eta[k]);
  AddCell_Private(g, pair, s);
}

/* The gap at a corner is the distance along the nonmortar facet's normal, taken at the reference positions in small kinematics. */
static void AddFan_Private(SegmentGrid *g, const ContactView *v, PetscInt pair, PetscBool small, const ContactSegment *s)
{
  const PetscInt first = g->num_points;
  PetscReal      normal[3], own[3], other[3];

  for (PetscInt k = 0; k < s->num; ++k) {
    OutputFacetNormal(&v->nonmortar, small ? v->nonmortar.X : v->nonmortar.x, s->facet, s->xi[k], normal);
    OutputFacetPoint(&v->nonmortar, v->nonmortar.x, s->facet, s->xi[k], own);
    OutputFacetPoint(&v->mortar, v->mortar.x, s->mortar_facet, s->eta[k], other);
    g->gap[g->num_points] = 0;
    for (PetscInt c = 0; c < 3; ++c) g->gap[g->num_points] += normal[c] * (other[c] - own[c]);
    AddPoint_Private(g, &v->nonmortar, s->facet, s->xi[k]);
  }
  for (PetscInt k = 1; k + 1 < s->num; ++k) {
    const PetscInt fan[3] = {0, k, k + 1};
    for (PetscInt a = 0; a < 3; ++a) g->conn[3 * g->num_cells + a] = first + fan[a];
    AddCell_Private(g, pair, s);
  }
}

/* Segments of all pairs that this rank writes, those whose nonmortar facet is a side of its cells: facets at the border are evaluated by several ranks.
   With X NULL they are counted only. */
static PetscErrorCode Collect_Private(Problem problem, PetscInt dim, SegmentGrid *g)
{
  const SceneData      *scene = ProblemGetScene(problem);
  const ContactView    *v;
  const ContactSegment *segment;
  Forest                forest = ProblemForest(problem);
  const ForestTables   *t      = ForestGetTables(forest);
  PetscInt              num;
  PetscMPIInt           rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  const PetscBool small = (PetscBool)(scene->mechanics.kinematics == KINEMATICS_SMALL);
  g->num_points = g->num_cells = 0;
  for (PetscInt i = 0; i < scene->num_contacts; ++i) {
    const PetscInt pair = scene->contacts[i].pair;
    v                   = InterfaceGetContact(ProblemInterface(problem), i);
    ContactPairGetSegments(v->pair, &num, &segment);
    for (PetscInt s = 0; s < num; ++s) {
      if (t->leaf_rank[v->nonmortar.facet_leaf[segment[s].facet]] != rank) continue;
      if (!g->X) {
        g->num_points += Points_Private(dim, &segment[s]);
        g->num_cells += Cells_Private(dim, &segment[s]);
      } else if (dim == 2)
        AddQuad_Private(g, v, pair, &segment[s]);
      else
        AddFan_Private(g, v, pair, small, &segment[s]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputWriteSegments(Writer writer, Problem problem)
{
  static const char *const name[] = {"pair", "facet", "mortar_facet"};
  const ForestTables      *t      = ForestGetTables(ProblemForest(problem));
  SegmentGrid              g      = {0};

  PetscFunctionBegin;
  g.corners = t->dim == 2 ? 4 : 3;
  PetscCall(Collect_Private(problem, t->dim, &g));
  const PetscInt points = g.num_points, cells = g.num_cells;
  PetscCall(PetscMalloc4(3 * points + 1, &g.X, 3 * points, &g.displacement, points, &g.gap, g.corners * cells, &g.conn));
  PetscCall(PetscMalloc3(cells, &g.label[0], cells, &g.label[1], cells, &g.label[2]));
  PetscCall(Collect_Private(problem, t->dim, &g));
  PetscCall(WriterGrid(writer, "segments", t->dim == 2 ? CELL_QUAD4 : CELL_TRIANGLE3, g.num_points, g.X, g.num_cells, g.conn));
  PetscCall(WriterField(writer, "displacement", PETSC_FALSE, 3, g.displacement));
  if (t->dim == 3) PetscCall(WriterField(writer, "gap", PETSC_FALSE, 1, g.gap));
  for (PetscInt i = 0; i < 3; ++i) PetscCall(WriterField(writer, name[i], PETSC_TRUE, 1, g.label[i]));
  PetscCall(PetscFree4(g.X, g.displacement, g.gap, g.conn));
  PetscCall(PetscFree3(g.label[0], g.label[1], g.label[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
