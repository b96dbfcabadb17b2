/* What laws remember at the integration points of cells: layout, ghosts, and the step from one accepted state to the next. */
#include "mechanicsimpl.h"

/* Places of cells in the history array: own cells group after group, then ghosts. */
static void Layout_Private(Mechanics m, const HPTables *v, PetscInt *total)
{
  *total = 0;
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    CellGroup *g = &m->groups[i];
    g->history   = *total;
    *total += g->num_cells * g->num_points * g->h;
  }
  m->num_history = *total;
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    if (m->cell_group[c] < 0) continue;
    const CellGroup *g    = &m->groups[m->cell_group[c]];
    const PetscInt   size = g->num_points * g->h;
    m->cell_history[c]    = c < v->num_owned_cells ? g->history + m->cell_index[c] * size : *total;
    if (c >= v->num_owned_cells) *total += size;
  }
}

/* Ghosts' entries from their owners': first the owners say where theirs are, by leaf. */
static PetscErrorCode Ghosts_Private(Mechanics m, const HPTables *v, const ForestTables *t, MPI_Comm comm, PetscInt total)
{
  PetscInt     num = 0, *owner_place, *place;
  PetscSF      leaves;
  PetscSFNode *remote;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(t->num_leaves, &owner_place, v->num_cells, &place));
  PetscCall(PetscMalloc1(v->num_cells - v->num_owned_cells, &remote));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) owner_place[v->cell_leaf[c]] = m->cell_history[c];
  for (PetscInt c = v->num_owned_cells; c < v->num_cells; ++c) {
    remote[c - v->num_owned_cells].rank  = t->leaf_rank[v->cell_leaf[c]];
    remote[c - v->num_owned_cells].index = v->cell_leaf[c];
  }
  PetscCall(PetscSFCreate(comm, &leaves));
  PetscCall(PetscSFSetGraph(leaves, t->num_leaves, v->num_cells - v->num_owned_cells, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFBcastBegin(leaves, MPIU_INT, owner_place, place, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(leaves, MPIU_INT, owner_place, place, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&leaves));

  PetscInt *here;
  PetscCall(PetscMalloc1(total - m->num_history, &remote));
  PetscCall(PetscMalloc1(total - m->num_history, &here));
  for (PetscInt c = v->num_owned_cells; c < v->num_cells; ++c) {
    const CellGroup *g = m->cell_group[c] < 0 ? NULL : &m->groups[m->cell_group[c]];
    for (PetscInt k = 0; g && k < g->num_points * g->h; ++k, ++num) {
      remote[num].rank  = t->leaf_rank[v->cell_leaf[c]];
      remote[num].index = place[c - v->num_owned_cells] + k;
      here[num]         = m->cell_history[c] + k;
    }
  }
  PetscCall(PetscSFCreate(comm, &m->history_sf));
  PetscCall(PetscSFSetGraph(m->history_sf, m->num_history, num, here, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscFree2(owner_place, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsHistoryCreate_Private(Mechanics m)
{
  const HPTables     *v;
  const ForestTables *t;
  Forest              forest;
  PetscInt            total;
  PetscBool           any = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->spec->num_bodies; ++b) any = (PetscBool)(any || m->spec->bodies[b].material->law->num_history > 0);
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HPSpaceGetTables(m->space, &v));
  PetscCall(HPSpaceGetForest(m->space, &forest));
  PetscCall(ForestGetTables(forest, &t));
  PetscCall(PetscMalloc1(v->num_cells, &m->cell_history));
  Layout_Private(m, v, &total);
  PetscCall(PetscMalloc1(total, &m->history));
  PetscCall(Ghosts_Private(m, v, t, ForestComm(forest), total));
  PetscCall(MechanicsInitialHistory(m, m->history));
  PetscCall(MechanicsSetHistory(m, m->history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsHistoryDestroy_Private(Mechanics m)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(m->cell_history));
  PetscCall(PetscFree(m->history));
  PetscCall(PetscSFDestroy(&m->history_sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsNumHistory(Mechanics m, PetscInt *num)
{
  PetscFunctionBegin;
  *num = m->num_history;
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
  if (!m->history_sf) PetscFunctionReturn(PETSC_SUCCESS);
  if (history != m->history) PetscCall(PetscArraycpy(m->history, history, m->num_history));
  PetscCall(PetscSFBcastBegin(m->history_sf, MPIU_REAL, m->history, m->history, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(m->history_sf, MPIU_REAL, m->history, m->history, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsHistoryRange(Mechanics m, PetscInt cell, PetscInt *first, PetscInt *num)
{
  PetscFunctionBegin;
  *first = *num = 0;
  if (!m->history_sf || m->cell_group[cell] < 0 || m->cell_index[cell] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  const CellGroup *g = &m->groups[m->cell_group[cell]];
  *num               = g->num_points * g->h;
  *first             = m->cell_history[cell];
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
      if (inverted) PetscCall(PetscArraycpy(history + g->history + c * size, m->history + g->history + c * size, size));
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

PetscErrorCode MechanicsPlastic(Mechanics m, const PetscReal u[], PetscReal *strain, PetscReal *work, PetscReal integral[][2])
{
  const HPTables     *v;
  const ForestTables *t;
  Forest              forest;
  PetscReal          *trial;
  PetscBool           bad;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(m->space, &v));
  PetscCall(HPSpaceGetForest(m->space, &forest));
  PetscCall(ForestGetTables(forest, &t));
  PetscCall(PetscArrayzero(integral, m->spec->num_bodies));
  *strain = *work = 0;
  PetscCall(PetscMalloc1(m->num_history, &trial));
  PetscCall(MechanicsCommit(m, u, trial, &bad));
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g = &m->groups[i];
    for (PetscInt c = 0; c < g->num_cells && g->h && g->material->law->plastic; ++c) {
      const PetscInt body   = t->leaf_body[v->cell_leaf[g->cells[c]]];
      PetscReal     *volume = m->work;
      PetscCall(CellKernelVolumes(g->kernel, g->X + c * g->n * m->dim, volume));
      for (PetscInt q = 0; q < g->num_points; ++q) {
        PetscReal alpha, density;
        g->material->law->plastic(g->material, trial + g->history + (c * g->num_points + q) * g->h, &alpha, &density);
        *strain = PetscMax(*strain, alpha);
        *work += volume[q] * density;
        integral[body][0] += volume[q] * alpha;
        integral[body][1] += volume[q];
      }
    }
  }
  PetscCall(PetscFree(trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsNumFlowing(Mechanics m, const PetscReal u[], PetscInt *num)
{
  PetscReal *trial;
  PetscBool  bad;

  PetscFunctionBegin;
  *num = 0;
  PetscCall(PetscMalloc1(m->num_history, &trial));
  PetscCall(MechanicsCommit(m, u, trial, &bad));
  for (PetscInt i = 0; i < m->num_groups; ++i) {
    const CellGroup *g = &m->groups[i];
    for (PetscInt q = 0; q < g->num_cells * g->num_points && g->h && g->material->law->plastic; ++q) {
      const PetscInt at = g->history + q * g->h;
      PetscReal      before, after, work;
      g->material->law->plastic(g->material, m->history + at, &before, &work);
      g->material->law->plastic(g->material, trial + at, &after, &work);
      if (after > before) ++*num;
    }
  }
  PetscCall(PetscFree(trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetEdge(Mechanics m, MaterialEdge edge)
{
  PetscFunctionBegin;
  m->edge = edge;
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
