/* The leaf DMPlex of a rank. */
#include "forestimpl.h"
#include <petscsf.h>

/* The part of the forest a rank sees. Points: cells (owned, then ghosts), vertices, then faces (3-D), then edges. */
typedef struct {
  const ForestTables *t;
  char               *seen;         /* [num_entities] CORE, CHART */
  PetscInt           *entity_point; /* [num_entities] -1: not here */
  PetscInt           *point_entity; /* [num_points], handed to the forest */
  PetscInt            num_owned, num_points;
  PetscInt            start[4], end[4]; /* points of each dimension */
} Chart;

enum { CORE = 1, CHART = 2 }; /* closure of owned leaves with their parents; the same of ghosts too */

/* Flag an entity, its closure, and what it hangs in, recursively. */
static void Mark_Private(const ForestTables *t, PetscInt entity, char flag, char seen[])
{
  const PetscInt end = entity + 1 < t->num_entities ? t->closure_offset[entity + 1] : t->closure_offset[entity] + ForestPow3[t->dim];

  if (seen[entity] & flag) return;
  seen[entity] |= flag;
  for (PetscInt i = t->closure_offset[entity]; i < end; ++i) Mark_Private(t, t->closure[i], flag, seen);
  if (t->parent[entity] >= 0) Mark_Private(t, t->parent[entity], flag, seen);
}

/* Next points for the entities of dimension d that are in the chart; of the cells only those that are owned, or only the others. */
static void Number_Private(Chart *chart, PetscInt d, PetscMPIInt rank, PetscBool owned)
{
  const ForestTables *t = chart->t;

  for (PetscInt e = t->first[d]; e < t->first[d + 1]; ++e) {
    if (!chart->seen[e]) continue;
    if (d == t->dim && (t->leaf_rank[e - t->first[d]] == rank) != owned) continue;
    chart->entity_point[e]                   = chart->num_points;
    chart->point_entity[chart->num_points++] = e;
  }
}

static PetscErrorCode ChartCreate_Private(const ForestTables *t, PetscMPIInt rank, Chart *chart)
{
  const PetscInt n = ForestPow3[t->dim];

  PetscFunctionBegin;
  *chart = (Chart){.t = t};
  PetscCall(PetscCalloc1(t->num_entities, &chart->seen));
  PetscCall(PetscMalloc1(t->num_entities, &chart->entity_point));
  PetscCall(PetscMalloc1(t->num_entities, &chart->point_entity));
  for (PetscInt e = 0; e < t->num_entities; ++e) chart->entity_point[e] = -1;
  for (PetscInt l = 0; l < t->num_leaves; ++l)
    if (t->leaf_rank[l] == rank) Mark_Private(t, t->first[t->dim] + l, CORE, chart->seen);
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    const PetscInt *closure = &t->closure[t->closure_offset[t->first[t->dim] + l]];
    PetscBool       ghost   = PETSC_FALSE;
    for (PetscInt i = 0; i < n && !ghost; ++i) ghost = (PetscBool)(chart->seen[closure[i]] & CORE);
    if (ghost) Mark_Private(t, t->first[t->dim] + l, CHART, chart->seen);
  }
  Number_Private(chart, t->dim, rank, PETSC_TRUE);
  chart->num_owned = chart->num_points;
  Number_Private(chart, t->dim, rank, PETSC_FALSE);
  chart->end[t->dim] = chart->num_points;
  for (PetscInt k = 0; k < t->dim; ++k) {
    const PetscInt d = k == 0 ? 0 : t->dim - k;
    chart->start[d]  = chart->num_points;
    Number_Private(chart, d, rank, PETSC_TRUE);
    chart->end[d] = chart->num_points;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cone orientation of a quad face in a hex: where the first two vertices of DMPlex's view of that face lie in the face's own cyclic order.
   v0, v1: those vertices in the cell's tangential axes (bit 0, bit 1). */
static PetscInt FaceOrientation_Private(int8_t code, PetscInt v0, PetscInt v1)
{
  static const PetscInt cyclic[4] = {0, 1, 3, 2};
  PetscInt              at[2];

  for (PetscInt i = 0; i < 2; ++i) {
    const PetscInt v = i ? v1 : v0, swapped = code & 4 ? (v >> 1) | (v & 1) << 1 : v;
    at[i] = cyclic[swapped ^ (code & 3)];
  }
  if (at[1] == (at[0] + 1) % 4) return at[0];
  return at[0] == 3 ? -1 : -2 - at[0];
}

/* Cone of an entity as entities, with orientations; returns its size. Orders as in DMPlex: quad cyclic, hex bottom top front back right left. */
static PetscInt Cone_Private(const ForestTables *t, PetscInt d, PetscInt entity, PetscInt cone[6], PetscInt orientation[6])
{
  static const PetscInt quad_place[4] = {1, 5, 7, 3}, hex_place[6] = {4, 22, 10, 16, 14, 12};
  static const PetscInt hex_view[6][2] = {{0, 2}, {0, 1}, {0, 1}, {1, 0}, {0, 1}, {0, 2}};
  const PetscInt        offset = t->closure_offset[entity], size = 2 * d;

  for (PetscInt i = 0; i < size; ++i) {
    const PetscInt at   = offset + (d == 1 ? 2 * i : d == 2 ? quad_place[i] : hex_place[i]);
    const int8_t   code = t->orientation[at];
    cone[i]             = t->closure[at];
    orientation[i]      = 0;
    if (d == 2) orientation[i] = (code & 1) != (i > 1) ? -1 : 0; /* the last two edges are walked backwards */
    if (d == 3) orientation[i] = FaceOrientation_Private(code, hex_view[i][0], hex_view[i][1]);
  }
  return size;
}

static PetscErrorCode SetCones_Private(const Chart *chart, DM dm)
{
  const ForestTables *t = chart->t;
  PetscInt            cone[6], orientation[6];

  PetscFunctionBegin;
  PetscCall(DMPlexSetChart(dm, 0, chart->num_points));
  for (PetscInt d = 1; d <= t->dim; ++d)
    for (PetscInt p = chart->start[d]; p < chart->end[d]; ++p) PetscCall(DMPlexSetConeSize(dm, p, 2 * d));
  PetscCall(DMSetUp(dm));
  for (PetscInt d = 1; d <= t->dim; ++d)
    for (PetscInt p = chart->start[d]; p < chart->end[d]; ++p) {
      const PetscInt size = Cone_Private(t, d, chart->point_entity[p], cone, orientation);
      for (PetscInt i = 0; i < size; ++i) cone[i] = chart->entity_point[cone[i]];
      PetscCall(DMPlexSetCone(dm, p, cone));
      PetscCall(DMPlexSetConeOrientation(dm, p, orientation));
    }
  PetscCall(DMPlexSymmetrize(dm));
  PetscCall(DMPlexStratify(dm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Types are set explicitly: a parent without support would be taken for a cell. */
static PetscErrorCode SetCellTypes_Private(const Chart *chart, DM dm)
{
  static const DMPolytopeType type[4] = {DM_POLYTOPE_POINT, DM_POLYTOPE_SEGMENT, DM_POLYTOPE_QUADRILATERAL, DM_POLYTOPE_HEXAHEDRON};

  PetscFunctionBegin;
  for (PetscInt d = 0; d <= chart->t->dim; ++d)
    for (PetscInt p = chart->start[d]; p < chart->end[d]; ++p) PetscCall(DMPlexSetCellType(dm, p, type[d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetLabels_Private(const Chart *chart, const CoarseMesh *mesh, DM dm)
{
  const ForestTables *t = chart->t;
  DMLabel             body;

  PetscFunctionBegin;
  PetscCall(DMCreateLabel(dm, "body"));
  PetscCall(DMGetLabel(dm, "body", &body));
  for (PetscInt p = 0; p < chart->end[t->dim]; ++p) PetscCall(DMLabelSetValue(body, p, t->leaf_body[chart->point_entity[p] - t->first[t->dim]]));
  for (PetscInt b = 0; b < mesh->num_boundaries - mesh->num_unions; ++b) {
    DMLabel label;
    PetscCall(DMCreateLabel(dm, mesh->boundary_name[b]));
    PetscCall(DMGetLabel(dm, mesh->boundary_name[b], &label));
    for (PetscInt p = chart->start[t->dim - 1]; p < chart->end[t->dim - 1]; ++p)
      if ((t->boundary[chart->point_entity[p]] >> b) & 1) PetscCall(DMLabelSetValue(label, p, 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Vertex positions, through the corners of the cells and, for vertices of parents without a cell here, through their lowest leaf. */
static PetscErrorCode SetCoordinates_Private(Forest forest, const Chart *chart, DM dm)
{
  const ForestTables *t = chart->t;
  PetscSection        section;
  PetscScalar        *x;
  Vec                 coordinates;

  PetscFunctionBegin;
  PetscCall(DMSetCoordinateDim(dm, t->dim));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(PetscSectionSetNumFields(section, 1));
  PetscCall(PetscSectionSetFieldComponents(section, 0, t->dim));
  PetscCall(PetscSectionSetChart(section, chart->start[0], chart->end[0]));
  for (PetscInt v = chart->start[0]; v < chart->end[0]; ++v) {
    PetscCall(PetscSectionSetDof(section, v, t->dim));
    PetscCall(PetscSectionSetFieldDof(section, v, 0, t->dim));
  }
  PetscCall(PetscSectionSetUp(section));
  PetscCall(VecCreate(PETSC_COMM_SELF, &coordinates));
  PetscCall(PetscObjectSetName((PetscObject)coordinates, "coordinates"));
  PetscCall(VecSetSizes(coordinates, t->dim * (chart->end[0] - chart->start[0]), PETSC_DETERMINE));
  PetscCall(VecSetBlockSize(coordinates, t->dim));
  PetscCall(VecSetType(coordinates, VECSTANDARD));
  PetscCall(VecGetArrayWrite(coordinates, &x));
  for (PetscInt v = chart->start[0]; v < chart->end[0]; ++v) {
    const PetscInt  entity = chart->point_entity[v], leaf = t->entity_leaf[entity];
    const PetscInt *closure = &t->closure[t->closure_offset[t->first[t->dim] + leaf]];
    PetscReal       xi[3], X[3];
    PetscInt        i = 0;
    while (closure[i] != entity) ++i;
    for (PetscInt a = 0; a < t->dim; ++a) xi[a] = 0.5 * ((i / ForestPow3[a]) % 3);
    PetscCall(ForestMapPoint(forest, leaf, xi, X));
    for (PetscInt a = 0; a < t->dim; ++a) x[(v - chart->start[0]) * t->dim + a] = X[a];
  }
  PetscCall(VecRestoreArrayWrite(coordinates, &x));
  PetscCall(DMSetCoordinatesLocal(dm, coordinates));
  PetscCall(VecDestroy(&coordinates));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Exclusive sums of counts; returns the total. */
static PetscMPIInt Offsets_Private(PetscMPIInt size, const PetscMPIInt count[], PetscMPIInt offset[])
{
  PetscMPIInt total = 0;

  for (PetscMPIInt r = 0; r < size; ++r) {
    offset[r] = total;
    total += count[r];
  }
  return total;
}

/* Every rank asks the owners for their numbers of the entities it shares. asked[num]: entities sorted by owner, count[] of them each. */
static PetscErrorCode AskOwners_Private(MPI_Comm comm, const Chart *chart, const PetscMPIInt count[], PetscInt asked[], PetscInt answer[])
{
  PetscMPIInt *serve, *offset, *serve_offset, size;
  PetscInt    *request;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc3(size, &serve, size, &offset, size, &serve_offset));
  PetscCallMPI(MPI_Alltoall(count, 1, MPI_INT, serve, 1, MPI_INT, comm));
  Offsets_Private(size, count, offset);
  const PetscMPIInt total = Offsets_Private(size, serve, serve_offset);
  PetscCall(PetscMalloc1(total, &request));
  PetscCallMPI(MPI_Alltoallv(asked, count, offset, MPIU_INT, request, serve, serve_offset, MPIU_INT, comm));
  for (PetscMPIInt i = 0; i < total; ++i) request[i] = chart->entity_point[request[i]];
  PetscCallMPI(MPI_Alltoallv(request, serve, serve_offset, MPIU_INT, answer, count, offset, MPIU_INT, comm));
  PetscCall(PetscFree(request));
  PetscCall(PetscFree3(serve, offset, serve_offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Point SF: leaves are the points whose entity another rank owns. */
static PetscErrorCode SetPointSF_Private(MPI_Comm comm, const Chart *chart, DM dm)
{
  const ForestTables *t = chart->t;
  PetscMPIInt        *count, *next, size, rank;
  PetscInt           *asked, *answer, *local, *sorted, num = 0;
  PetscSFNode        *remote;
  PetscSF             sf;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscCalloc2(size, &count, size, &next));
  for (PetscInt p = 0; p < chart->num_points; ++p) ++count[t->leaf_rank[t->entity_leaf[chart->point_entity[p]]]];
  count[rank] = 0;
  num         = Offsets_Private(size, count, next);
  PetscCall(PetscMalloc3(num, &asked, num, &answer, num, &sorted));
  PetscCall(PetscMalloc1(num, &local));
  PetscCall(PetscMalloc1(num, &remote));
  for (PetscInt p = 0, i = 0; p < chart->num_points; ++p) {
    const PetscMPIInt owner = t->leaf_rank[t->entity_leaf[chart->point_entity[p]]];
    if (owner == rank) continue;
    asked[next[owner]] = chart->point_entity[p];
    remote[i].rank     = owner;
    sorted[i]          = next[owner]++;
    local[i++]         = p;
  }
  PetscCall(AskOwners_Private(comm, chart, count, asked, answer));
  for (PetscInt i = 0; i < num; ++i) remote[i].index = answer[sorted[i]];
  PetscCall(DMGetPointSF(dm, &sf));
  PetscCall(PetscSFSetGraph(sf, chart->num_points, num, local, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscFree3(asked, answer, sorted));
  PetscCall(PetscFree2(count, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildLeafDM_Private(Forest forest)
{
  Chart       chart;
  PetscMPIInt rank;
  DM          dm;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(forest->comm, &rank));
  PetscCall(ChartCreate_Private(&forest->tables, rank, &chart));
  PetscCall(DMPlexCreate(forest->comm, &dm));
  PetscCall(DMSetDimension(dm, forest->tables.dim));
  PetscCall(SetCones_Private(&chart, dm));
  PetscCall(SetCellTypes_Private(&chart, dm));
  PetscCall(SetPointSF_Private(forest->comm, &chart, dm));
  PetscCall(DMPlexSetOverlap(dm, NULL, 1));
  PetscCall(SetLabels_Private(&chart, &forest->coarse->mesh, dm));
  PetscCall(SetCoordinates_Private(forest, &chart, dm));
  forest->leaf_dm         = dm;
  forest->num_owned_cells = chart.num_owned;
  forest->num_points      = chart.num_points;
  forest->point_entity    = chart.point_entity;
  PetscCall(PetscFree(chart.seen));
  PetscCall(PetscFree(chart.entity_point));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestGetLeafDM(Forest forest, DM *dm, PetscInt *num_owned_cells, PetscInt *num_points, const PetscInt **point_entity)
{
  PetscFunctionBegin;
  if (!forest->leaf_dm) PetscCall(BuildLeafDM_Private(forest));
  *dm = forest->leaf_dm;
  if (num_owned_cells) *num_owned_cells = forest->num_owned_cells;
  if (num_points) *num_points = forest->num_points;
  if (point_entity) *point_entity = forest->point_entity;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ForestCoarseSide(const ForestTables *t, PetscInt leaf, PetscInt facet)
{
  const PetscInt *cl    = t->closure + t->closure_offset[t->first[t->dim] + leaf];
  PetscInt        index = 0;

  while (cl[index] != facet) ++index;
  const PetscInt place[3] = {index % 3, t->dim > 1 ? index / 3 % 3 : 1, t->dim > 2 ? index / 9 : 1}, d = place[0] != 1 ? 0 : place[1] != 1 ? 1 : 2;
  return 2 * (t->dim * t->leaf_root[leaf] + d) + place[d] / 2;
}
