/* Sums over the cells: residual, tangent, element pressures, point values. */
#include "mechanicsimpl.h"

#define MOST_STRETCH2 400 /* mean square of the stretches up to which the noise of forces grows with them */

/* Buffers of one batch, cut from the work array. */
typedef struct {
  PetscReal *u, *r, *K, *consistent, *pressure, *energy, *min_det, *stretch2;
} Buffers;

static Buffers CutBuffers_Private(Mechanics m, const CellGroup *g)
{
  const PetscInt nd = g->n * m->dim;
  Buffers        b;
  b.u          = m->work;
  b.r          = b.u + g->batch * nd;
  b.K          = b.r + g->batch * nd;
  b.consistent = b.K + g->batch * nd * nd;
  b.pressure   = b.consistent + g->batch * (g->m + g->num_unknown);
  b.energy     = b.pressure + g->batch * g->num_unknown;
  b.min_det    = b.energy + g->batch;
  b.stretch2   = b.min_det + g->batch;
  return b;
}

static PetscErrorCode GatherBatch_Private(Mechanics m, const CellGroup *g, PetscInt first, PetscInt nc, const PetscReal u[], PetscReal *values)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < nc; ++i) PetscCall(HPSpaceGather(m->space, g->cells[first + i], u, values + i * g->n * m->dim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By how much the noise of a cell's forces exceeds that for F = I: det F errs by epsilon |cof F : F|, and cof F turns the pressure of that into forces:
   |cof F|^2 <= |F|^4/3. Where the pressure is given (NULL: it is not) the noise is that of the shear modulus, and the pressure adds its own. Beyond stretches
   that any material bears it does not grow any more, or a body that has flown apart would be in balance within its noise. */
static PetscReal Growth_Private(Mechanics m, const CellGroup *g, PetscReal stretch2, const PetscReal pressure[])
{
  const PetscReal of_F = m->spec->kinematics == KINEMATICS_SMALL ? 1 : 3 * PetscSqr(PetscMin(stretch2, MOST_STRETCH2)), E = MaterialYoung(g->material);
  PetscReal       sum = E;

  if (!pressure) return of_F;
  for (PetscInt a = 0; a < g->m + g->num_unknown; ++a) sum += PetscAbsReal(pressure[a]);
  return of_F * sum / E * MechanicsNoiseModulus_Private(g->material, PETSC_TRUE) / MechanicsNoiseModulus_Private(g->material, PETSC_FALSE);
}

PetscErrorCode MechanicsFindFolded(Mechanics m, const PetscReal u[], int8_t folded[])
{
  PetscFunctionBegin;
  if (m->spec->kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  const HPTables *v = HPSpaceGetTables(m->space);
  for (PetscInt g = 0; g < m->num_groups; ++g) {
    const CellGroup *group = &m->groups[g];
    const PetscInt   nd    = group->n * m->dim;
    PetscReal       *x     = CutBuffers_Private(m, group).u;
    for (PetscInt i = 0; i < group->num_cells; ++i) {
      PetscInt inverted;
      PetscCall(GatherBatch_Private(m, group, i, 1, u, x));
      for (PetscInt k = 0; k < nd; ++k) x[k] += group->X[i * nd + k];
      PetscCall(CellKernelFindInverted(group->kernel, 1, x, &inverted));
      if (inverted == 0) folded[v->cell_leaf[group->cells[i]]] = 1;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GroupResidual_Private(Mechanics m, const CellGroup *g, const PetscReal u[], const PetscReal pressure[], PetscReal r[],
                                            MechanicsStatus *status)
{
  const Buffers  b  = CutBuffers_Private(m, g);
  const PetscInt nd = g->n * m->dim;

  PetscFunctionBegin;
  for (PetscInt first = 0; first < g->num_cells; first += g->batch) {
    CellBatch batch = {.nc       = PetscMin(g->batch, g->num_cells - first),
                       .X        = g->X + first * nd,
                       .u        = b.u,
                       .fiber    = g->fiber + first * g->num_fibers,
                       .energy   = b.energy,
                       .residual = b.r,
                       .min_det  = b.min_det,
                       .stretch2 = b.stretch2,
                       .history  = MechanicsBatchHistory_Private(m, g, first)};
    PetscCall(GatherBatch_Private(m, g, first, batch.nc, u, b.u));
    if (g->num_unknown) {
      MechanicsUnknownsGather_Private(m, g, first, batch.nc, b.pressure);
      batch.pressure   = b.pressure;
      batch.consistent = b.consistent;
    }
    if (g->m && pressure) {
      batch.pressure = pressure + g->pressure + first * g->m;
      batch.acts     = PETSC_TRUE;
    }
    PetscCall(CellKernelEvaluate(g->kernel, &batch));
    for (PetscInt i = 0; i < batch.nc; ++i) status->min_det = PetscMin(status->min_det, b.min_det[i]);
    if (batch.bad) {
      status->bad = PETSC_TRUE;
      continue;
    }
    if (g->num_unknown) MechanicsUnknownsRows_Private(m, g, first, batch.nc, b.consistent, &status->volume);
    for (PetscInt i = 0; i < batch.nc; ++i) {
      const PetscReal growth = Growth_Private(m, g, b.stretch2[i], batch.pressure ? batch.pressure + i * (g->m + g->num_unknown) : NULL);
      status->energy += b.energy[i];
      status->noise2 += g->noise2[first + i] * PetscSqr(growth);
      status->drift2 += g->drift2[first + i] * PetscSqr(growth);
      if (m->viscosity > 0) PetscCall(MechanicsViscousForces_Private(m, g, first + i, b.u + i * nd, b.r + i * nd));
      for (PetscInt k = 0; k < nd; ++k) status->scale2 += PetscSqr(b.r[i * nd + k]);
      PetscCall(HPSpaceScatterAdd(m->space, g->cells[first + i], b.r + i * nd, r));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsResidual(Mechanics m, const PetscReal u[], const PetscReal pressure[], PetscReal r[], MechanicsStatus *status)
{
  PetscFunctionBegin;
  status->energy    = 0;
  status->scale2    = 0;
  status->noise2    = 0;
  status->drift2    = 0;
  status->largest   = 0;
  status->volume    = 0;
  status->min_det   = PETSC_MAX_REAL;
  status->bad       = PETSC_FALSE;
  const HPTables *v = HPSpaceGetTables(m->space);
  for (PetscInt i = 0; i < v->num_nodes * m->dim; ++i) status->largest = PetscMax(status->largest, PetscAbsReal(u[i]));
  for (PetscInt g = 0; g < m->num_groups; ++g) PetscCall(GroupResidual_Private(m, &m->groups[g], u, pressure, r, status));
  if (m->dead) {
    for (PetscInt i = 0; i < v->num_nodes * m->dim; ++i) {
      r[i] += m->dead[i];
      status->scale2 += PetscSqr(m->dead[i]);
    }
  }
  PetscCall(MechanicsFollowers_Private(m, u, r, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Diagonal element k of the matrix of cell i. */
static PetscReal *Diagonal_Private(Mechanics m, const CellGroup *g, PetscInt i, PetscReal K[], PetscInt k)
{
  const PetscInt nd = g->n * m->dim, ni = m->condense_work ? g->num_inner * m->dim : 0;

  return k < ni ? g->factor + i * ni * nd + k * (nd + 1) : K + (k - ni) * (nd - ni + 1);
}

/* Matrix of cell i of the group to the sink; without its inner nodes where they are condensed. */
static PetscErrorCode SendMatrix_Private(Mechanics m, CellGroup *g, PetscInt i, PetscReal K[], PetscReal *Km, PetscInt *dofs, MatrixSink sink, void *context,
                                         PetscBool *bad)
{
  const PetscInt cell = g->cells[i], nd = g->n * m->dim;
  PetscBool      singular = PETSC_FALSE;
  PetscInt       num;

  PetscFunctionBegin;
  if (m->free_share[cell] > 0) {
    PetscReal trace = 0;
    for (PetscInt k = 0; k < nd; ++k) trace += *Diagonal_Private(m, g, i, K, k);
    for (PetscInt k = 0; k < nd; ++k) *Diagonal_Private(m, g, i, K, k) += m->free_share[cell] * m->free_part * trace / nd;
  }
  if (m->viscosity > 0) {
    const PetscInt ni = m->condense_work ? g->num_inner * m->dim : 0;
    MechanicsViscousMatrix_Private(m, g, i, ni, g->factor + i * ni * nd, K);
  }
  if (m->condense_work) {
    PetscCall(StageBegin(STAGE_CONDENSE));
    PetscCall(MechanicsCondenseCell_Private(m, g, i, K, &singular));
    PetscCall(StageEnd(STAGE_CONDENSE));
    if (singular) *bad = PETSC_TRUE;
    PetscCall(HPSpaceTransformBoundary(m->space, cell, g->n - g->num_inner, g->outer, K, Km, dofs, &num));
  } else
    PetscCall(HPSpaceTransformMatrix(m->space, cell, K, Km, dofs, &num));
  PetscCall(sink(context, cell, num, dofs, Km));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Most masters of any owned cell. */
static PetscErrorCode MostMasters_Private(Mechanics m, PetscInt *most)
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  *most = 1;
  for (PetscInt c = 0; c < v->num_cells; ++c) *most = PetscMax(*most, v->cell_row[c + 1] - v->cell_row[c]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsTangent(Mechanics m, const PetscReal u[], const PetscReal pressure[], MatrixSink sink, void *context, PetscBool *bad)
{
  PetscInt   most, *dofs;
  PetscReal *Km, *dpressure = m->dpressure;

  PetscFunctionBegin;
  *bad            = PETSC_FALSE;
  m->num_negative = 0;
  PetscCall(MostMasters_Private(m, &most));
  PetscCall(PetscMalloc2(most * m->dim, &dofs, most * m->dim * most * m->dim, &Km));
  for (PetscInt ig = 0; ig < m->num_groups; ++ig) {
    CellGroup     *g  = &m->groups[ig];
    const Buffers  b  = CutBuffers_Private(m, g);
    const PetscInt nd = g->n * m->dim, rest = g->place ? nd - g->num_inner * m->dim : nd; /* rows of what is left of a cell's matrix */
    for (PetscInt first = 0; first < g->num_cells; first += g->batch) {
      CellBatch batch = {.nc        = PetscMin(g->batch, g->num_cells - first),
                         .X         = g->X + first * nd,
                         .u         = b.u,
                         .fiber     = g->fiber + first * g->num_fibers,
                         .tangent   = b.K,
                         .place     = g->place,
                         .num_inner = g->num_inner,
                         .inner     = g->factor + first * g->num_inner * m->dim * nd,
                         .edge      = m->edge,
                         .secant    = m->secant,
                         .history   = MechanicsBatchHistory_Private(m, g, first)};
      PetscCall(GatherBatch_Private(m, g, first, batch.nc, u, b.u));
      if (g->m) {
        batch.pressure   = pressure ? pressure + g->pressure + first * g->m : NULL;
        batch.consistent = m->linear + g->pressure + first * g->m;
        batch.dpressure  = dpressure + first * g->m * nd;
      }
      if (g->num_unknown) {
        MechanicsUnknownsGather_Private(m, g, first, batch.nc, b.pressure);
        batch.pressure  = b.pressure;
        batch.dpressure = g->volume + first * g->num_unknown * nd;
      }
      PetscCall(CellKernelEvaluate(g->kernel, &batch));
      if (batch.bad)
        *bad = PETSC_TRUE;
      else
        for (PetscInt i = 0; i < batch.nc; ++i) PetscCall(SendMatrix_Private(m, g, first + i, b.K + i * rest * rest, Km, dofs, sink, context, bad));
    }
    dpressure += g->num_cells * g->m * nd;
  }
  PetscCall(PetscFree2(dofs, Km));
  PetscCall(MechanicsFollowers_Private(m, u, NULL, sink, context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsUpdatePressure(Mechanics m, const PetscReal du[], PetscReal step, PetscReal pressure[])
{
  const PetscReal *dpressure = m->dpressure;

  PetscFunctionBegin;
  for (PetscInt ig = 0; ig < m->num_groups; ++ig) {
    const CellGroup *g  = &m->groups[ig];
    const PetscInt   nd = g->n * m->dim;
    for (PetscInt i = 0; i < g->num_cells && g->m; ++i) {
      PetscCall(HPSpaceGather(m->space, g->cells[i], du, m->work));
      for (PetscInt a = 0; a < g->m; ++a, dpressure += nd) {
        PetscReal target = m->linear[g->pressure + i * g->m + a];
        for (PetscInt k = 0; k < nd; ++k) target += dpressure[k] * m->work[k];
        pressure[g->pressure + i * g->m + a] += step * (target - pressure[g->pressure + i * g->m + a]);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPoints(Mechanics m, PetscInt cell, PetscInt np, const PetscReal xi[], const PetscReal u[], const PointValues *points)
{
  const CellGroup    *g;
  const HPTables     *v        = HPSpaceGetTables(m->space);
  const Forest        forest   = HPSpaceGetForest(m->space);
  const ForestTables *t        = ForestGetTables(forest);
  const PetscReal    *pressure = NULL;
  PetscReal          *X, *values, consistent[MOST_PRESSURES];
  PetscBool           bad;

  PetscFunctionBegin;
  PetscCheck(m->cell_group[cell] >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "cell %" PetscInt_FMT " is rigid: it has no stress", cell);
  g                        = &m->groups[m->cell_group[cell]];
  X                        = m->work;
  values                   = X + g->n * m->dim;
  const PetscReal *history = g->h ? m->history.values + m->history.place[cell] : NULL;
  PetscCall(HPSpaceGatherPositions(m->space, cell, X));
  PetscCall(HPSpaceGather(m->space, cell, u, values));
  if (g->m && m->has_stored)
    pressure = m->stored.values + m->stored.place[cell];
  else if (g->m) { /* the volume alone tells the pressure, no fibres */
    CellBatch batch = {.nc = 1, .X = X, .u = values, .consistent = consistent, .history = history};
    PetscCall(CellKernelEvaluate(g->kernel, &batch));
    pressure = consistent;
  }
  if (g->num_unknown) pressure = m->pressure + m->unknown_first[cell];
  PetscCall(CellKernelPoints(g->kernel, t->leaf_root[v->cell_leaf[cell]], np, xi, X, values, pressure, history, points, &bad));
  PetscFunctionReturn(PETSC_SUCCESS);
}
