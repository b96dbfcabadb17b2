/* Bodies in space of which nothing changes along one axis, or around it: a section in plane strain, or an axisymmetric model, is enough. Around: of cylinder
   coordinates, radius, angle times the mesh's size and height, the second takes the place of the axis. */
#include "needsimpl.h"

#define TURN 1 /* the coordinate that goes around */

static PetscBool Over_Private(const Place *a, const Place *b, PetscReal size)
{
  return (PetscBool)(a->body == b->body && PlaceIs(a, b, 0, 0, 1, size));
}

/* Cylinder coordinates about an axis through the origin; the angle next to that of `near`. */
static void Around_Private(PetscInt axis, PetscReal size, const PetscReal near[3], const PetscReal X[3], PetscReal Y[3])
{
  const PetscInt  a = (axis + 1) % 3, b = (axis + 2) % 3;
  const PetscReal from = atan2(near[b], near[a]);

  Y[0]    = hypot(X[a], X[b]);
  Y[TURN] = size * (from + remainder(atan2(X[b], X[a]) - from, 2 * PETSC_PI));
  Y[2]    = X[axis];
}

/* A coarse cell as a right prism along the axis: each corner lies over another one of the lowest side, and heights are two. */
static PetscBool Prism_Private(const CoarseMesh *m, PetscInt cell, PetscInt axis, PetscBool around, PetscReal size, Place *column)
{
  const PetscInt   line = m->geometry_order + 1, num = line * line * line;
  const PetscReal *X = m->cell_geometry + 3 * num * cell, least = NEEDS_SAME * size;
  const PetscInt   corner[8] = {0, line - 1, line * (line - 1), line * line - 1, num - line * line, num - line * line + line - 1, num - line, num - 1};
  const PetscInt   along     = around ? TURN : axis;
  PetscReal        Y[8][3], lo = PETSC_MAX_REAL, hi = -PETSC_MAX_REAL;

  *column = (Place){.body = m->cell_body[cell]};
  for (PetscInt k = 0; k < 8; ++k) {
    for (PetscInt d = 0; d < 3; ++d) Y[k][d] = X[3 * corner[k] + d];
    if (around) Around_Private(axis, size, X, X + 3 * corner[k], Y[k]);
    if (around && Y[k][0] < least) return PETSC_FALSE;
    lo = PetscMin(lo, Y[k][along]);
    hi = PetscMax(hi, Y[k][along]);
    for (PetscInt d = 0; d < 3; ++d) column->X[d] += Y[k][d] / 8;
  }
  for (PetscInt k = 0; k < 8; ++k) {
    PetscBool over = PETSC_FALSE;
    if (Y[k][along] > lo + least && Y[k][along] < hi - least) return PETSC_FALSE;
    for (PetscInt j = 0; j < 8 && !over; ++j) {
      over = (PetscBool)(j != k && PetscAbsReal(Y[k][along] - Y[j][along]) > hi - lo - least);
      for (PetscInt d = 0; d < 3; ++d)
        if (d != along && PetscAbsReal(Y[k][d] - Y[j][d]) > least) over = PETSC_FALSE;
    }
    if (!over) return PETSC_FALSE;
  }
  column->height = hi - lo;
  PlaceKey(column, along, NULL);
  return PETSC_TRUE;
}

/* All columns of cells reach from end to end, all that there is to go; *layers: cells of the highest column. */
static PetscErrorCode Stacks_Private(const CoarseMesh *m, PetscInt axis, PetscBool around, PetscReal size, PetscInt *layers, PetscReal *length)
{
  PetscBool good = PETSC_TRUE;
  Place    *column;

  PetscFunctionBegin;
  *layers = 0;
  *length = 0;
  PetscCall(PetscMalloc1(m->num_cells, &column));
  for (PetscInt c = 0; c < m->num_cells && good; ++c) good = Prism_Private(m, c, axis, around, size, &column[c]);
  if (good) PlacesSort(m->num_cells, column);
  for (PetscInt i = 0, first = 0; i < m->num_cells && good; ++i) {
    const PetscInt last   = PlacesLike(m->num_cells, column, i, size, &first);
    PetscReal      height = 0;
    PetscInt       cells  = 0;
    for (PetscInt j = first; j < last; ++j) {
      if (!Over_Private(&column[i], &column[j], size)) continue;
      height += column[j].height;
      ++cells;
    }
    if (i == 0) *length = height;
    good    = (PetscBool)(PetscAbsReal(height - *length) < 4 * NEEDS_SAME * size);
    *layers = PetscMax(*layers, cells);
  }
  if (!good) *layers = 0;
  PetscCall(PetscFree(column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corners and their displacements in cylinder coordinates, sorted anew. */
static void Turn_Private(PetscInt axis, PetscReal size, PetscInt num, Place corner[])
{
  const PetscInt a = (axis + 1) % 3, b = (axis + 2) % 3;

  for (PetscInt i = 0; i < num; ++i) {
    Place    *p    = &corner[i];
    PetscReal Y[3] = {0};
    Around_Private(axis, size, p->X, p->X, Y);
    const PetscReal c = p->X[a] / Y[0], s = p->X[b] / Y[0], u[3] = {c * p->u[a] + s * p->u[b], c * p->u[b] - s * p->u[a], p->u[axis]};
    for (PetscInt d = 0; d < 3; ++d) {
      p->X[d] = Y[d];
      p->u[d] = u[d];
    }
    PlaceKey(p, TURN, NULL);
  }
  PlacesSort(num, corner);
}

PetscErrorCode NeedsFindPrism(const NeedsRun *run, PetscInt axis, PetscBool around, PetscReal strain, PetscInt *layers, PetscReal *change)
{
  const PetscInt  along = around ? TURN : axis;
  const PetscReal plane = 0;
  PetscReal       lo[3], hi[3], length, most = 0, largest; /* along the axis, or difference of two corners over each other; of all displacements */
  PetscInt        num;
  Place          *corner;

  PetscFunctionBegin;
  *layers             = 0;
  const CoarseMesh *m = ForestGetCoarse(run->level->forest);
  if (m->dim < 3) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscReal size = NeedsSize(m, lo, hi);
  PetscCall(Stacks_Private(m, axis, around, size, layers, &length));
  if (!around && length < hi[axis] - lo[axis] - 4 * NEEDS_SAME * size) *layers = 0;
  if (!*layers) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NeedsCorners(run, axis, around ? &plane : NULL, &num, &corner, &largest));
  if (around) Turn_Private(axis, size, num, corner);
  for (PetscInt i = 0, first = 0; i < num; ++i) {
    most = PetscMax(most, PetscAbsReal(corner[i].u[along]));
    (void)PlacesLike(num, corner, i, size, &first);
    for (PetscInt j = first; j < i; ++j)
      for (PetscInt d = 0; d < 3 && Over_Private(&corner[i], &corner[j], size); ++d) most = PetscMax(most, PetscAbsReal(corner[i].u[d] - corner[j].u[d]));
  }
  PetscCall(PetscFree(corner));
  *change = largest > 0 ? most / largest : 0;
  if (strain > 0) *change = PetscMax(*change, most / (length * strain));
  PetscFunctionReturn(PETSC_SUCCESS);
}
