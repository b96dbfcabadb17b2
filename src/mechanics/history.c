/* What laws remember at the integration points of cells: layout, and the step from one accepted state to the next. */
#include "mechanicsimpl.h"

PetscErrorCode MechanicsHistoryCreate_Private(Mechanics m)
{
  PetscInt  num = 0, *size;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->spec->num_bodies; ++b) any = (PetscBool)(any || m->spec->bodies[b].material->law->num_history > 0);
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(m->num_groups, &size));
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    CellGroup *g = &m->groups[i];
    size[i]      = g->num_points * g->h;
    g->history   = num;
    num += g->num_cells * size[i];
  }
  PetscCall(CellNumbersCreate_Private(m, size, &m->history));
  PetscCall(PetscFree(size));
  PetscCall(MechanicsInitialHistory(m, m->history.values));
  PetscCall(MechanicsSetHistory(m, m->history.values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsNumHistory(Mechanics m, PetscInt *num)
{
  PetscFunctionBegin;
  *num = m->history.num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsInitialHistory(Mechanics m, PetscReal history[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g = &m->groups[i];
    for (PetscInt q = 0; q < g->num_cells * g->num_points && g->h; ++q) g->material->law->initial(g->material, history + g->history + q * g->h);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetHistory(Mechanics m, const PetscReal history[])
{
  PetscFunctionBegin;
  PetscCall(CellNumbersSet_Private(&m->history, history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsHistoryRange(Mechanics m, PetscInt cell, PetscInt *first, PetscInt *num)
{
  PetscFunctionBegin;
  *first = *num = 0;
  if (!m->history.ghosts || m->cell_group[cell] < 0 || m->cell_index[cell] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  const CellGroup *g = &m->groups[m->cell_group[cell]];
  *num               = g->num_points * g->h;
  *first             = m->history.place[cell];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a step to u leaves in cells first .. of a group; held: as in MaterialPoints. */
static PetscErrorCode Trial_Private(Mechanics m, const CellGroup *g, PetscInt first, PetscInt num, PetscBool held, const PetscReal u[], PetscReal trial[],
                                    PetscBool *bad)
{
  const PetscInt nd    = g->n * m->dim;
  CellBatch      batch = {.nc = num, .X = g->X + first * nd, .u = m->work, .history = MechanicsBatchHistory_Private(m, g, first), .trial = trial, .held = held};

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; ++i) PetscCall(HPSpaceGather(m->space, g->cells[first + i], u, m->work + i * nd));
  PetscCall(CellKernelEvaluate(g->kernel, &batch));
  if (batch.bad) *bad = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsCommit(Mechanics m, const PetscReal u[], PetscReal history[], PetscBool *bad)
{
  PetscFunctionBegin;
  *bad = PETSC_FALSE;
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g = &m->groups[i];
    for (PetscInt first = 0; first < g->num_cells && g->h; first += g->batch)
      PetscCall(Trial_Private(m, g, first, PetscMin(g->batch, g->num_cells - first), PETSC_FALSE, u, history + g->history + first * g->num_points * g->h, bad));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One by one: a cell that is inverted has no stress, and no part in that of others. */
PetscErrorCode MechanicsAdmit(Mechanics m, const PetscReal u[], PetscReal history[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g    = &m->groups[i];
    const PetscInt   size = g->num_points * g->h;
    for (PetscInt c = 0; c < g->num_cells && g->h; ++c) {
      PetscBool inverted = PETSC_FALSE;
      PetscCall(Trial_Private(m, g, c, 1, PETSC_TRUE, u, history + g->history + c * size, &inverted));
      if (inverted) PetscCall(PetscArraycpy(history + g->history + c * size, m->history.values + g->history + c * size, size));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool MechanicsIsPlastic(const MechanicsSpec *spec)
{
  for (PetscInt b = 0; b < spec->num_bodies; ++b) {
    if (spec->bodies[b].material->law->plastic) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The largest of values at a cell's integration points and of the polynomial through them at its nodes: these lie on its faces, where flow is largest, and
   which the points are short of by a tenth of the cell. */
static PetscErrorCode Largest_Private(Mechanics m, const CellGroup *g, const PetscReal values[], PetscReal *largest)
{
  const PetscInt p = g->order, n = p + 1;
  const Basis1D *rule;

  PetscFunctionBegin;
  PetscCall(MechanicsPointRule(p, &rule));
  for (PetscInt q = 0; q < g->num_points; ++q) *largest = PetscMax(*largest, values[q]);
  for (PetscInt i = 0; i < ElementNumNodes(m->dim, p); ++i) {
    const PetscReal xi[3] = {(PetscReal)(i % n) / p, (PetscReal)(i / n % n) / p, (PetscReal)(i / (n * n)) / p};
    PetscReal       value;
    Basis1DInterpolate(rule, m->dim, xi, 1, values, &value);
    *largest = PetscMax(*largest, value);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPlastic(Mechanics m, const PetscReal u[], PetscReal *strain, PetscReal *work, PetscReal integral[][2])
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);
  PetscReal          *trial, *alpha;
  PetscInt            most = 0;
  PetscBool           bad;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(integral, m->spec->num_bodies));
  *strain = *work = 0;
  for (PetscInt i = 0; i < m->num_groups; ++i) most = PetscMax(most, m->groups[i].num_points);
  PetscCall(PetscMalloc2(m->history.num, &trial, most, &alpha));
  PetscCall(MechanicsCommit(m, u, trial, &bad));
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g = &m->groups[i];
    for (PetscInt c = 0; c < g->num_cells && g->h && g->material->law->plastic; ++c) {
      const PetscInt body   = t->leaf_body[v->cell_leaf[g->cells[c]]];
      PetscReal     *volume = m->work;
      PetscCall(CellKernelVolumes(g->kernel, g->X + c * g->n * m->dim, volume));
      for (PetscInt q = 0; q < g->num_points; ++q) {
        PetscReal density;
        g->material->law->plastic(g->material, trial + g->history + (c * g->num_points + q) * g->h, &alpha[q], &density);
        *work += volume[q] * density;
        integral[body][0] += volume[q] * alpha[q];
        integral[body][1] += volume[q];
      }
      PetscCall(Largest_Private(m, g, alpha, strain));
    }
  }
  PetscCall(PetscFree2(trial, alpha));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsNumFlowing(Mechanics m, const PetscReal u[], PetscInt *num)
{
  PetscReal *trial;
  PetscBool  bad;

  PetscFunctionBegin;
  *num = 0;
  PetscCall(PetscMalloc1(m->history.num, &trial));
  PetscCall(MechanicsCommit(m, u, trial, &bad));
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g = &m->groups[i];
    for (PetscInt q = 0; q < g->num_cells * g->num_points && g->h && g->material->law->plastic; ++q) {
      const PetscInt at = g->history + q * g->h;
      PetscReal      before, after, work;
      g->material->law->plastic(g->material, m->history.values + at, &before, &work);
      g->material->law->plastic(g->material, trial + at, &after, &work);
      if (after > before) ++*num;
    }
  }
  PetscCall(PetscFree(trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetFlow(Mechanics m, MaterialEdge edge, PetscReal secant)
{
  PetscFunctionBegin;
  m->edge   = edge;
  m->secant = secant;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPlasticStrain(Mechanics m, PetscInt cell, PetscInt np, const PetscReal xi[], const PetscReal u[], PetscReal strain[])
{
  const CellGroup *g = m->cell_group[cell] < 0 ? NULL : &m->groups[m->cell_group[cell]];
  const Basis1D   *rule;
  PetscReal       *trial, *alpha, work;
  PetscBool        bad;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(strain, np));
  if (!g || !g->h || !g->material->law->plastic) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(g->num_points * g->h, &trial, g->num_points, &alpha));
  PetscCall(Trial_Private(m, g, m->cell_index[cell], 1, PETSC_FALSE, u, trial, &bad));
  for (PetscInt q = 0; q < g->num_points; ++q) g->material->law->plastic(g->material, trial + q * g->h, &alpha[q], &work);
  PetscCall(MechanicsPointRule(g->order, &rule));
  for (PetscInt p = 0; p < np; ++p) Basis1DInterpolate(rule, m->dim, xi + p * m->dim, 1, alpha, &strain[p]);
  PetscCall(PetscFree2(trial, alpha));
  PetscFunctionReturn(PETSC_SUCCESS);
}
