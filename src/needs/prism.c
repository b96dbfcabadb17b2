/* Prismatic bodies in space of which nothing moves or changes along one axis: a section in plane strain is enough. */
#include "needsimpl.h"

static PetscBool Over_Private(const Place *a, const Place *b, PetscReal size)
{
  return (PetscBool)(a->body == b->body && PlaceIs(a, b, 0, 0, 1, size));
}

/* A coarse cell as a right prism along the axis: each geometry node lies over another one of the lowest side, and heights are two. */
static PetscBool Prism_Private(const CoarseMesh *m, PetscInt cell, PetscInt axis, PetscReal least, Place *column)
{
  const PetscInt   line = m->geometry_order + 1, num = line * line * line;
  const PetscReal *X         = m->cell_geometry + 3 * num * cell;
  const PetscInt   corner[8] = {0, line - 1, line * (line - 1), line * line - 1, num - line * line, num - line * line + line - 1, num - line, num - 1};
  PetscReal        lo = PETSC_MAX_REAL, hi = -PETSC_MAX_REAL;

  *column = (Place){.body = m->cell_body[cell]};
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
  column->height = hi - lo;
  PlaceKey(column, axis, NULL);
  return PETSC_TRUE;
}

/* All columns of cells reach from end to end; *layers: cells of the highest column. */
static PetscErrorCode Stacks_Private(const CoarseMesh *m, PetscInt axis, PetscReal length, PetscReal size, PetscInt *layers)
{
  PetscBool good = PETSC_TRUE;
  Place    *column;

  PetscFunctionBegin;
  *layers = 0;
  PetscCall(PetscMalloc1(m->num_cells, &column));
  for (PetscInt c = 0; c < m->num_cells && good; ++c) good = Prism_Private(m, c, axis, NEEDS_SAME * size, &column[c]);
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
    good    = (PetscBool)(PetscAbsReal(height - length) < 4 * NEEDS_SAME * size);
    *layers = PetscMax(*layers, cells);
  }
  if (!good) *layers = 0;
  PetscCall(PetscFree(column));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NeedsFindPrism(const NeedsRun *run, PetscInt axis, PetscReal strain, PetscInt *layers, PetscReal *change)
{
  const CoarseMesh *m;
  PetscReal         lo[3], hi[3], most = 0, largest; /* along the axis, or difference of two corners over each other; of all displacements */
  PetscInt          num;
  Place            *corner;

  PetscFunctionBegin;
  *layers = 0;
  PetscCall(ForestGetCoarse(run->level->forest, &m));
  if (m->dim < 3) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscReal size = NeedsSize(m, lo, hi);
  PetscCall(Stacks_Private(m, axis, hi[axis] - lo[axis], size, layers));
  if (!*layers) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NeedsCorners(run, axis, NULL, &num, &corner, &largest));
  for (PetscInt i = 0, first = 0; i < num; ++i) {
    most = PetscMax(most, PetscAbsReal(corner[i].u[axis]));
    (void)PlacesLike(num, corner, i, size, &first);
    for (PetscInt j = first; j < i; ++j)
      for (PetscInt d = 0; d < 3 && Over_Private(&corner[i], &corner[j], size); ++d) most = PetscMax(most, PetscAbsReal(corner[i].u[d] - corner[j].u[d]));
  }
  PetscCall(PetscFree(corner));
  *change = largest > 0 ? most / largest : 0;
  if (strain > 0) *change = PetscMax(*change, most / ((hi[axis] - lo[axis]) * strain));
  PetscFunctionReturn(PETSC_SUCCESS);
}
