/* One state as fields: the bulk grid. Layouts and fields are documented in output.h. */
#include "output.h"

/* The grid of this rank's owned cells. Output cells are pieces of cells; `point` tells which output point a cell's node is. */
typedef struct {
  const HPTables *v;
  PetscBool       shared;                          /* points shared between cells, stress-like fields per cell */
  PetscInt        pieces[MORTISE_MAX_ORDER + 1];   /* of a cell in each direction, by its order */
  PetscInt        num_points, num_pieces, largest; /* largest number of nodes of a cell and of its lattice */
  PetscInt       *first, *piece;                   /* owned [num_owned_cells+1] offsets of a cell's nodes in point, of its pieces */
  PetscInt       *point;                           /* owned */
  PetscInt       *conn;                            /* owned [num_pieces][2^dim] */
} BulkGrid;

static PetscInt Divide_Private(const BulkGrid *g, PetscInt cell)
{
  return g->pieces[g->v->cell_order[cell]];
}

/* Have all cells order 1, in this run throughout, and are they drawn as they are? Cells of a restarted run have the orders of the checkpoint, not of the scene.
 */
static PetscErrorCode IsLinear_Private(const SceneData *scene, MPI_Comm comm, const HPTables *v, PetscBool *yes)
{
  PetscFunctionBegin;
  *yes = (PetscBool)(scene->output.divide <= 1 && (scene->adapt.tolerance == 0 || scene->adapt.strategy == ADAPT_H));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) *yes = (PetscBool)(*yes && v->cell_order[c] == 1);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, yes, 1, MPIU_BOOL, MPI_LAND, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number points: a vertex of several cells once (shared), or every node of every cell. */
static PetscErrorCode Points_Private(const ForestTables *t, BulkGrid *g)
{
  const HPTables *v = g->v;
  PetscInt       *number;

  PetscFunctionBegin;
  if (!g->shared) {
    g->num_points = g->first[v->num_owned_cells];
    for (PetscInt i = 0; i < g->num_points; ++i) g->point[i] = i;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(t->first[1], &number));
  for (PetscInt i = 0; i < t->first[1]; ++i) number[i] = -1;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt *closure = t->closure + t->closure_offset[t->first[v->dim] + v->cell_leaf[c]];
    for (PetscInt k = 0; k < 1 << v->dim; ++k) {
      const PetscInt vertex = closure[2 * (k & 1) + 6 * (k >> 1 & 1) + 18 * (k >> 2)];
      if (number[vertex] < 0) number[vertex] = g->num_points++;
      g->point[g->first[c] + k] = number[vertex];
    }
  }
  PetscCall(PetscFree(number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pieces of a cell, lexicographic, and their corners. */
static void Connect_Private(BulkGrid *g, PetscInt cell)
{
  const PetscInt dim = g->v->dim, p = Divide_Private(g, cell), n = p + 1, *point = g->point + g->first[cell];
  PetscInt      *conn = g->conn + (g->piece[cell] << dim);

  for (PetscInt s = 0; s < ElementNumNodes(dim, p - 1); ++s) {
    const PetscInt i = s % p, j = s / p % p, k = s / (p * p), corner = (k * n + j) * n + i;
    for (PetscInt a = 0; a < 1 << dim; ++a) *conn++ = point[corner + (a & 1) + n * (a >> 1 & 1) + n * n * (a >> 2)];
  }
}

static PetscErrorCode GridCreate_Private(const SceneData *scene, Forest forest, HPSpace space, BulkGrid *g)
{
  const ForestTables *t = ForestGetTables(forest);
  const HPTables     *v = HPSpaceGetTables(space);

  PetscFunctionBegin;
  PetscCall(PetscMemzero(g, sizeof(*g)));
  g->v = v;
  PetscCall(IsLinear_Private(scene, ForestComm(forest), v, &g->shared));
  PetscCall(HPSpacePieces(space, scene->output.divide, g->pieces));
  PetscCall(PetscMalloc2(v->num_owned_cells + 1, &g->first, v->num_owned_cells + 1, &g->piece));
  g->first[0] = g->piece[0] = 0;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt p = v->cell_order[c], n = Divide_Private(g, c);
    g->first[c + 1] = g->first[c] + ElementNumNodes(v->dim, n);
    g->piece[c + 1] = g->piece[c] + ElementNumNodes(v->dim, n - 1);
    g->largest      = PetscMax(g->largest, ElementNumNodes(v->dim, PetscMax(n, p)));
  }
  g->num_pieces = g->piece[v->num_owned_cells];
  PetscCall(PetscMalloc2(g->first[v->num_owned_cells], &g->point, g->num_pieces << v->dim, &g->conn));
  PetscCall(Points_Private(t, g));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) Connect_Private(g, c);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GridDestroy_Private(BulkGrid *g)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(g->first, g->piece));
  PetscCall(PetscFree2(g->point, g->conn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Positions and displacement at the points. */
static PetscErrorCode WriteMotion_Private(Writer writer, HPSpace space, const BulkGrid *g, const PetscReal u[])
{
  const PetscInt dim = g->v->dim;
  PetscReal     *X, *motion, *nodal;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(3 * g->num_points, &X, 3 * g->num_points, &motion));
  PetscCall(PetscMalloc1(2 * g->largest * dim, &nodal));
  for (PetscInt c = 0; c < g->v->num_owned_cells; ++c) {
    const PetscInt n = g->first[c + 1] - g->first[c];
    PetscCall(HPSpaceLattice(space, c, g->pieces, u, nodal, nodal + n * dim));
    for (PetscInt i = 0; i < n; ++i) {
      const PetscInt at = 3 * g->point[g->first[c] + i];
      for (PetscInt d = 0; d < dim; ++d) {
        X[at + d]      = nodal[i * dim + d];
        motion[at + d] = nodal[(n + i) * dim + d];
      }
    }
  }
  PetscCall(WriterGrid(writer, "bulk", dim == 2 ? CELL_QUAD4 : CELL_HEX8, g->num_points, X, g->num_pieces, g->conn));
  PetscCall(WriterField(writer, "displacement", PETSC_FALSE, 3, motion));
  PetscCall(PetscFree(nodal));
  PetscCall(PetscFree2(X, motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal VonMises_Private(const PetscReal s[6])
{
  const PetscReal normal = PetscSqr(s[0] - s[3]) + PetscSqr(s[3] - s[5]) + PetscSqr(s[5] - s[0]);
  return PetscSqrtReal(0.5 * normal + 3 * (s[1] * s[1] + s[2] * s[2] + s[4] * s[4]));
}

/* Stress-like fields, per cell or per point. */
static PetscErrorCode WriteStress_Private(Writer writer, Problem problem, const BulkGrid *g, const PetscReal u[])
{
  const PetscInt num = g->shared ? g->num_pieces : g->num_points;
  PetscReal     *stress, *pressure, *mises, *J, *sample, *nodal, *work;

  PetscFunctionBegin;
  PetscCall(PetscMalloc4(6 * num, &stress, num, &pressure, num, &mises, num, &J));
  PetscCall(PetscMalloc3(7 * g->largest, &sample, 7 * g->largest, &nodal, 7 * g->largest, &work));
  for (PetscInt c = 0; c < g->v->num_owned_cells; ++c) {
    const PetscInt first = g->shared ? g->piece[c] : g->first[c], n = g->shared ? 1 : g->first[c + 1] - g->first[c];
    PetscCall(OutputSampleCell(problem, c, u, sample));
    if (!g->shared) PetscCall(OutputExtend(g->v->dim, g->v->cell_order[c], Divide_Private(g, c), 7, sample, nodal, work));
    for (PetscInt i = 0; i < n; ++i) {
      const PetscReal *s = (g->shared ? sample : nodal) + 7 * i;
      PetscCall(PetscArraycpy(stress + 6 * (first + i), s, 6));
      pressure[first + i] = -(s[0] + s[3] + s[5]) / 3;
      mises[first + i]    = VonMises_Private(s);
      J[first + i]        = s[6];
    }
  }
  PetscCall(WriterField(writer, "pressure", g->shared, 1, pressure));
  PetscCall(WriterField(writer, "stress", g->shared, 6, stress));
  PetscCall(WriterField(writer, "von_mises", g->shared, 1, mises));
  PetscCall(WriterField(writer, "J", g->shared, 1, J));
  PetscCall(PetscFree3(sample, nodal, work));
  PetscCall(PetscFree4(stress, pressure, mises, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Those of output.quantities, taken out of what OutputSampleQuantities gives. */
static PetscErrorCode WriteQuantities_Private(Writer writer, Problem problem, int wanted, const BulkGrid *g, const PetscReal u[])
{
  static const struct {
    const char *name;
    PetscInt    first, num;
  } field[]           = {{"principal_stretches", 0, 3}, {"logarithmic_strain", 3, 6}, {"energy_density", 9, 1}, {"first_piola", 10, 9}};
  const PetscInt num  = g->shared ? g->num_pieces : g->num_points;
  const PetscInt room = OUTPUT_QUANTITIES * g->largest;
  PetscReal     *all, *one, *sample, *work;

  PetscFunctionBegin;
  PetscCall(PetscMalloc4(OUTPUT_QUANTITIES * num, &all, 9 * num, &one, room, &sample, room, &work));
  for (PetscInt c = 0; c < g->v->num_owned_cells; ++c) {
    PetscReal *values = all + OUTPUT_QUANTITIES * (g->shared ? g->piece[c] : g->first[c]);
    PetscCall(OutputSampleQuantities(problem, c, u, g->shared ? values : sample));
    if (!g->shared) PetscCall(OutputExtend(g->v->dim, g->v->cell_order[c], Divide_Private(g, c), OUTPUT_QUANTITIES, sample, values, work));
  }
  for (PetscInt f = 0; f < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(field); ++f) {
    if (!(wanted & 1 << f)) continue;
    for (PetscInt i = 0; i < num; ++i)
      for (PetscInt k = 0; k < field[f].num; ++k) one[field[f].num * i + k] = all[OUTPUT_QUANTITIES * i + field[f].first + k];
    PetscCall(WriterField(writer, field[f].name, g->shared, field[f].num, one));
  }
  PetscCall(PetscFree4(all, one, sample, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WritePlastic_Private(Writer writer, Problem problem, const BulkGrid *g, const PetscReal u[])
{
  const PetscInt num = g->shared ? g->num_pieces : g->num_points;
  PetscReal     *strain, *sample, *work;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(num, &strain, g->largest, &sample, g->largest, &work));
  for (PetscInt c = 0; c < g->v->num_owned_cells; ++c) {
    const PetscInt first = g->shared ? g->piece[c] : g->first[c], n = g->shared ? 1 : g->first[c + 1] - g->first[c];
    PetscCall(OutputSamplePlastic(problem, c, u, g->shared ? strain + first : sample));
    if (!g->shared) PetscCall(OutputExtend(g->v->dim, g->v->cell_order[c], Divide_Private(g, c), 1, sample, strain + first, work));
    for (PetscInt i = first; i < first + n; ++i) strain[i] = PetscMax(0, strain[i]); /* polynomials may undershoot beside a plastic front */
  }
  PetscCall(WriterField(writer, "plastic_strain", g->shared, 1, strain));
  PetscCall(PetscFree3(strain, sample, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What belongs to a leaf as a whole, repeated on its pieces. */
static PetscErrorCode WriteLeafFields_Private(Writer writer, const ForestTables *t, const BulkGrid *g, const Estimate *estimate)
{
  static const char *const name[] = {"order", "level", "body", "rank", "error", "cell"};
  PetscReal               *value;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(g->num_pieces, &value));
  for (PetscInt f = 0; f < 6; ++f) {
    for (PetscInt c = 0; c < g->v->num_owned_cells; ++c) {
      const PetscInt  leaf  = g->v->cell_leaf[c];
      const int8_t   *level = t->leaf_level + 3 * leaf;
      const PetscReal all[] = {(PetscReal)g->v->cell_order[c],
                               (PetscReal)PetscMax(PetscMax(level[0], level[1]), g->v->dim == 3 ? level[2] : 0),
                               (PetscReal)t->leaf_body[leaf],
                               (PetscReal)t->leaf_rank[leaf],
                               estimate ? PetscSqrtReal(estimate->eta2[leaf]) : 0,
                               (PetscReal)leaf};
      for (PetscInt s = g->piece[c]; s < g->piece[c + 1]; ++s) value[s] = all[f];
    }
    PetscCall(WriterField(writer, name[f], PETSC_TRUE, 1, value));
  }
  PetscCall(PetscFree(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputWriteState(Writer writer, Problem problem, const State *state, const Estimate *estimate, PetscReal series_time, PetscInt step,
                                PetscInt pass)
{
  const SceneData *scene;
  HPSpace          space = ProblemSpace(problem);
  BulkGrid         grid;
  PetscReal       *u;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_OUTPUT));
  scene                 = ProblemGetScene(problem);
  const ForestTables *t = ForestGetTables(ProblemForest(problem));
  const HPTables     *v = HPSpaceGetTables(space);
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(ProblemSetState(problem, state));
  PetscCall(ProblemLocalDisplacement(problem, state->x, u));
  PetscCall(GridCreate_Private(scene, ProblemForest(problem), space, &grid));
  WriterDescribe(writer, scene);
  PetscCall(WriterBegin(writer, series_time, step, pass, state->t));
  PetscCall(WriteMotion_Private(writer, space, &grid, u));
  PetscCall(WriteStress_Private(writer, problem, &grid, u));
  if (scene->output.quantities) PetscCall(WriteQuantities_Private(writer, problem, scene->output.quantities, &grid, u));
  if (MechanicsIsPlastic(&scene->mechanics)) PetscCall(WritePlastic_Private(writer, problem, &grid, u));
  PetscCall(WriteLeafFields_Private(writer, t, &grid, estimate));
  if (scene->num_contacts) {
    PetscCall(ProblemRefresh(problem, state->x));
    PetscCall(OutputWriteContact(writer, problem));
  }
  PetscCall(WriterEnd(writer));
  PetscCall(GridDestroy_Private(&grid));
  PetscCall(PetscFree(u));
  PetscCall(StageEnd(STAGE_OUTPUT));
  PetscFunctionReturn(PETSC_SUCCESS);
}
