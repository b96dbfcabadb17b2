/* Prismatic bodies in space of which nothing moves or changes along one axis: a section in plane strain is enough. */
#include "appimpl.h"

#define SAME 1e-7 /* of the mesh's size: positions closer are one, as gmsh writes them with fewer digits than it has */

/* A column: coarse cells, or corners of cells, over one place of the section. */
typedef struct {
  PetscReal X[3], key; /* X: along the axis 0 */
  PetscReal u[3], sum; /* displacement of a corner; height of a cell */
  PetscInt  body, cells;
} Column;

static int CompareKey_Private(const void *a, const void *b)
{
  const PetscReal x = ((const Column *)a)->key, y = ((const Column *)b)->key;
  return (x > y) - (x < y);
}

static void Key_Private(Column *c, PetscInt axis)
{
  const PetscReal weight[3] = {0.618033988749895, 0.414213562373095, 0.732050807568877};

  c->X[axis] = 0;
  c->key     = Dot3(weight, c->X);
}

static PetscBool Over_Private(const Column *a, const Column *b, PetscReal least)
{
  for (PetscInt d = 0; d < 3; ++d)
    if (PetscAbsReal(a->X[d] - b->X[d]) > least) return PETSC_FALSE;
  return (PetscBool)(a->body == b->body);
}

/* A coarse cell as a right prism along the axis: each geometry node lies over another one of the lowest side, and heights are two. */
static PetscBool Prism_Private(const CoarseMesh *m, PetscInt cell, PetscInt axis, PetscReal least, Column *column)
{
  const PetscInt   line = m->geometry_order + 1, num = line * line * line;
  const PetscReal *X         = m->cell_geometry + 3 * num * cell;
  const PetscInt   corner[8] = {0, line - 1, line * (line - 1), line * line - 1, num - line * line, num - line * line + line - 1, num - line, num - 1};
  PetscReal        lo = PETSC_MAX_REAL, hi = -PETSC_MAX_REAL;

  *column = (Column){.body = m->cell_body[cell], .cells = 1};
  for (PetscInt i = 0; i < num; ++i) {
    lo = PetscMin(lo, X[3 * i + axis]);
    hi = PetscMax(hi, X[3 * i + axis]);
    for (PetscInt d = 0; d < 3; ++d) column->X[d] += X[3 * i + d] / (PetscReal)num;
  }
  for (PetscInt k = 0; k < 8; ++k) {
    const PetscReal *p    = X + 3 * corner[k];
    PetscBool        over = PETSC_FALSE;
    if (p[axis] > lo + least && p[axis] < hi - least) return PETSC_FALSE;
    for (PetscInt j = 0; j < 8 && !over; ++j) {
      const PetscReal *q = X + 3 * corner[j];
      over               = (PetscBool)(j != k && PetscAbsReal(p[axis] - q[axis]) > hi - lo - least);
      for (PetscInt d = 0; d < 3; ++d)
        if (d != axis && PetscAbsReal(p[d] - q[d]) > least) over = PETSC_FALSE;
    }
    if (!over) return PETSC_FALSE;
  }
  column->sum = hi - lo;
  Key_Private(column, axis);
  return PETSC_TRUE;
}

/* All columns of cells reach from end to end; *layers: cells of the highest column. */
static PetscErrorCode Stacks_Private(const CoarseMesh *m, PetscInt axis, PetscReal length, PetscReal least, PetscInt *layers)
{
  PetscBool good = PETSC_TRUE;
  Column   *column;

  PetscFunctionBegin;
  *layers = 0;
  PetscCall(PetscMalloc1(m->num_cells, &column));
  for (PetscInt c = 0; c < m->num_cells && good; ++c) good = Prism_Private(m, c, axis, least, &column[c]);
  if (good) qsort(column, (size_t)m->num_cells, sizeof(*column), CompareKey_Private);
  for (PetscInt i = 0, first = 0; i < m->num_cells && good; ++i) {
    PetscReal height = 0;
    PetscInt  cells  = 0;
    while (column[first].key < column[i].key - 4 * least) ++first;
    for (PetscInt j = first; j < m->num_cells && column[j].key < column[i].key + 4 * least; ++j) {
      if (!Over_Private(&column[i], &column[j], least)) continue;
      height += column[j].sum;
      ++cells;
    }
    good    = (PetscBool)(PetscAbsReal(height - length) < 4 * least);
    *layers = PetscMax(*layers, cells);
  }
  if (!good) *layers = 0;
  PetscCall(PetscFree(column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* most[1]: largest displacement of this rank's corners of cells. most[0]: largest one along the axis, or largest difference of two corners
   over each other, of all ranks. Collective. */
static PetscErrorCode Moves_Private(const App *app, PetscInt axis, PetscReal least, PetscReal most[2])
{
  const HPTables     *v;
  HPSpace             space;
  PetscReal          *local, *X, *u;
  PetscInt            num = 0, size = 1;
  Column             *column;
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(app->level.forest, &t));
  PetscCall(ProblemGetSpace(app->level.problem, &space));
  PetscCall(HPSpaceGetTables(space, &v));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) size = PetscMax(size, ElementNumNodes(3, v->cell_order[c]));
  PetscCall(PetscMalloc3(v->num_nodes * 3, &local, 3 * size, &X, 3 * size, &u));
  PetscCall(PetscMalloc1(8 * v->num_owned_cells, &column));
  PetscCall(ProblemLocalDisplacement(app->level.problem, app->level.accepted.x, local));
  most[0] = most[1] = 0;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt p = v->cell_order[c];
    PetscCall(HPSpaceGatherPositions(space, c, X));
    PetscCall(HPSpaceGather(space, c, local, u));
    for (PetscInt k = 0; k < 8; ++k) {
      const PetscInt node = 3 * p * ((k & 1) + (p + 1) * ((k >> 1 & 1) + (p + 1) * (k >> 2)));
      Column        *q    = &column[num++];
      *q                  = (Column){.body = t->leaf_body[v->cell_leaf[c]], .X = {X[node], X[node + 1], X[node + 2]}, .u = {u[node], u[node + 1], u[node + 2]}};
      for (PetscInt d = 0; d < 3; ++d) most[1] = PetscMax(most[1], PetscAbsReal(q->u[d]));
      most[0] = PetscMax(most[0], PetscAbsReal(q->u[axis]));
      Key_Private(q, axis);
    }
  }
  PetscCall(GatherToAll(app->comm, sizeof(*column), &num, (void **)&column)); /* what is over each other may be of several ranks */
  qsort(column, (size_t)num, sizeof(*column), CompareKey_Private);
  for (PetscInt i = 0, first = 0; i < num; ++i) {
    while (column[first].key < column[i].key - 4 * least) ++first;
    for (PetscInt j = first; j < i; ++j)
      for (PetscInt d = 0; d < 3 && Over_Private(&column[i], &column[j], least); ++d)
        most[0] = PetscMax(most[0], PetscAbsReal(column[i].u[d] - column[j].u[d]));
  }
  PetscCall(PetscFree3(local, X, u));
  PetscCall(PetscFree(column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppFindPrism(const App *app, PetscInt axis, PetscReal strain, PetscInt *layers, PetscReal *change)
{
  const CoarseMesh *m;
  PetscReal         lo[3], hi[3], size = 0, most[2];

  PetscFunctionBegin;
  *layers = 0;
  PetscCall(ForestGetCoarse(app->level.forest, &m));
  if (m->dim < 3) PetscFunctionReturn(PETSC_SUCCESS);
  ForestCoarseBox(m, lo, hi);
  for (PetscInt d = 0; d < 3; ++d) size = PetscMax(size, hi[d] - lo[d]);
  PetscCall(Stacks_Private(m, axis, hi[axis] - lo[axis], SAME * size, layers));
  if (!*layers) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Moves_Private(app, axis, SAME * size, most));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, app->comm));
  *change = most[1] > 0 ? most[0] / most[1] : 0;
  if (strain > 0) *change = PetscMax(*change, most[0] / ((hi[axis] - lo[axis]) * strain));
  PetscFunctionReturn(PETSC_SUCCESS);
}
