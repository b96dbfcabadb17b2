/* Life cycle of the bulk: owned cells grouped by law and order so that kernels see long contiguous batches. */
#include "mechanicsimpl.h"

static PetscInt FindGroup_Private(Mechanics m, const MaterialSpec *const *material, const MaterialSpec *wanted, PetscInt order)
{
  for (PetscInt g = 0; g < m->num_groups; ++g) {
    if (material[g] == wanted && m->groups[g].order == order) return g;
  }
  return -1;
}

/* Group of every local cell (ghosts too: MechanicsPoints serves them), counts of owned cells. */
static PetscErrorCode Groups_Private(Mechanics m, const HPTables *v, const ForestTables *t)
{
  const MaterialSpec **material;
  const PetscInt       most = m->spec->num_bodies * MORTISE_MAX_ORDER;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(most, &m->groups));
  PetscCall(PetscMalloc1(most, &material));
  PetscCall(PetscMalloc2(v->num_cells, &m->cell_group, v->num_cells, &m->cell_index));
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    const MaterialSpec *mine = m->spec->bodies[t->leaf_body[v->cell_leaf[c]]].material;
    m->cell_group[c] = m->cell_index[c] = -1;
    if (mine->law->rigid) continue;
    PetscInt g = FindGroup_Private(m, material, mine, v->cell_order[c]);
    if (g < 0) {
      g                     = m->num_groups++;
      material[g]           = mine;
      m->groups[g].order    = v->cell_order[c];
      m->groups[g].material = mine;
      PetscCall(CellKernelCreate(m->dim, m->spec->model, m->spec->kinematics, v->cell_order[c], mine, &m->groups[g].kernel));
      CellKernelSizes(m->groups[g].kernel, &m->groups[g].n, &m->groups[g].m, &m->groups[g].batch);
      if (mine->incompressible) m->groups[g].num_unknown = m->groups[g].m;
      if (mine->incompressible) m->groups[g].m = 0;
      CellKernelHistory(m->groups[g].kernel, &m->groups[g].num_points, &m->groups[g].h);
      CellKernelNumFibers(m->groups[g].kernel, &m->groups[g].num_fibers);
    }
    m->cell_group[c] = g;
    if (c < v->num_owned_cells) m->cell_index[c] = m->groups[g].num_cells++;
  }
  PetscCall(PetscFree(material));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillGroups_Private(Mechanics m, const HPTables *v, const ForestTables *t)
{
  PetscInt dpressure = 0;

  PetscFunctionBegin;
  for (PetscInt g = 0; g < m->num_groups; ++g) {
    CellGroup     *group = &m->groups[g];
    const PetscInt nd = group->n * m->dim, per_cell = 2 * nd + nd * nd + 3 * (group->m + group->num_unknown) + 5;
    PetscCall(
        PetscMalloc4(group->num_cells, &group->cells, group->num_cells * nd, &group->X, group->num_cells, &group->noise2, group->num_cells, &group->drift2));
    PetscCall(PetscMalloc1(group->num_cells * group->num_fibers, &group->fiber));
    group->pressure = m->num_pressure;
    m->num_pressure += group->num_cells * group->m;
    dpressure += group->num_cells * group->m * nd;
    m->work_size = PetscMax(m->work_size, group->batch * per_cell);
  }
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    if (m->cell_group[c] < 0) continue;
    CellGroup *group               = &m->groups[m->cell_group[c]];
    PetscReal *X                   = group->X + m->cell_index[c] * group->n * m->dim;
    group->cells[m->cell_index[c]] = c;
    PetscCall(HPSpaceGatherPositions(m->space, c, X));
    if (group->num_fibers) PetscCall(CellKernelFibers(group->kernel, t->leaf_root[v->cell_leaf[c]], X, group->fiber + m->cell_index[c] * group->num_fibers));
  }
  PetscCall(PetscMalloc2(m->num_pressure, &m->linear, dpressure, &m->dpressure));
  PetscCall(PetscMalloc1(m->work_size, &m->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Round-off of nodal forces in the reference state: epsilon * modulus * face for an F of size one, and that over the spacing of the nodes for each unit of
 * displacement. */
static void Noise_Private(Mechanics m)
{
  for (PetscInt g = 0; g < m->num_groups; ++g) {
    const CellGroup *group   = &m->groups[g];
    const PetscReal  modulus = MechanicsNoiseModulus_Private(group->material, PETSC_FALSE);
    for (PetscInt c = 0; c < group->num_cells; ++c) {
      PetscReal lo[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[3] = {PETSC_MIN_REAL, PETSC_MIN_REAL, PETSC_MIN_REAL}, most = 0,
                least = PETSC_MAX_REAL;
      for (PetscInt i = 0; i < group->n * m->dim; ++i) {
        const PetscReal x = group->X[c * group->n * m->dim + i];
        lo[i % m->dim]    = PetscMin(lo[i % m->dim], x);
        hi[i % m->dim]    = PetscMax(hi[i % m->dim], x);
      }
      for (PetscInt d = 0; d < m->dim; ++d) {
        most  = PetscMax(most, hi[d] - lo[d]);
        least = PetscMin(least, hi[d] - lo[d]);
      }
      const PetscReal face  = m->dim == 3 ? most * most : m->spec->model == MODEL_AXISYMMETRIC ? 2 * PETSC_PI * hi[0] * most : most;
      const PetscReal force = PETSC_MACHINE_EPSILON * modulus * face;
      group->noise2[c]      = PetscSqr(force);
      group->drift2[c]      = PetscSqr(force * group->order * group->order / least);
    }
  }
}

PetscErrorCode MechanicsCreate(HPSpace space, const MechanicsSpec *spec, const Supports *supports, Mechanics *mechanics)
{
  Mechanics m;

  PetscFunctionBegin;
  PetscCall(PetscNew(&m));
  m->space                   = space;
  m->spec                    = spec;
  m->supports                = supports;
  m->free_part               = 1;
  const HPTables     *v      = HPSpaceGetTables(space);
  const Forest        forest = HPSpaceGetForest(space);
  const ForestTables *t      = ForestGetTables(forest);
  m->dim                     = v->dim;
  PetscCall(Groups_Private(m, v, t));
  PetscCall(FillGroups_Private(m, v, t));
  Noise_Private(m);
  PetscCall(MechanicsUnknownsCreate_Private(m));
  PetscCall(MechanicsControlsCreate_Private(m));
  PetscCall(MechanicsLoadFacets_Private(m));
  PetscCall(MechanicsFreeBodies_Private(m));
  PetscCall(MechanicsStoredCreate_Private(m));
  PetscCall(MechanicsHistoryCreate_Private(m));
  *mechanics = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsDestroy(Mechanics *mechanics)
{
  Mechanics m = *mechanics;

  PetscFunctionBegin;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MechanicsCondenseDestroy_Private(m));
  PetscCall(MechanicsUnknownsDestroy_Private(m));
  PetscCall(CellNumbersDestroy_Private(&m->history));
  PetscCall(PetscFree(m->free_motion));
  PetscCall(CellNumbersDestroy_Private(&m->stored));
  for (PetscInt g = 0; g < m->num_groups; ++g) {
    PetscCall(CellKernelDestroy(&m->groups[g].kernel));
    PetscCall(PetscFree(m->groups[g].fiber));
    PetscCall(PetscFree4(m->groups[g].cells, m->groups[g].X, m->groups[g].noise2, m->groups[g].drift2));
  }
  PetscCall(PetscFree(m->groups));
  PetscCall(PetscFree2(m->cell_group, m->cell_index));
  PetscCall(PetscFree(m->facets));
  PetscCall(PetscFree(m->pressures));
  PetscCall(PetscFree2(m->control, m->control_pressure));
  PetscCall(PetscFree(m->dead));
  PetscCall(PetscFree(m->free_share));
  PetscCall(PetscFree(m->held));
  PetscCall(PetscFree(m->body_group));
  PetscCall(PetscFree(m->hold));
  PetscCall(PetscFree2(m->viscous_from, m->viscous_room));
  PetscCall(PetscFree2(m->linear, m->dpressure));
  PetscCall(PetscFree(m->work));
  PetscCall(PetscFree(*mechanics));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsFindInverted(Mechanics m, PetscInt *order, PetscReal X[3], PetscInt *leaf)
{
  const HPTables *v    = HPSpaceGetTables(m->space);
  PetscInt        cell = -1;

  PetscFunctionBegin;
  *order = 0;
  *leaf  = -1;
  X[0] = X[1] = X[2] = 0;
  for (PetscInt g = 0; g < m->num_groups && cell < 0; ++g) {
    const CellGroup *group = &m->groups[g];
    PetscCall(CellKernelFindInverted(group->kernel, group->num_cells, group->X, &cell));
    if (cell < 0) continue;
    *order = group->order;
    *leaf  = v->cell_leaf[group->cells[cell]];
    for (PetscInt i = 0; i < m->dim; ++i) X[i] = group->X[cell * group->n * m->dim + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetTime(Mechanics m, PetscReal t)
{
  PetscFunctionBegin;
  m->t = t;
  PetscCall(MechanicsDeadLoads_Private(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsNumPressure(Mechanics m, PetscInt *num)
{
  PetscFunctionBegin;
  *num = m->num_pressure;
  PetscFunctionReturn(PETSC_SUCCESS);
}
