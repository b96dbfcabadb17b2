/* Cells of incompressible material (kappa infinite): the pressure pi is no function of u any more. Its coefficients are unknowns of the whole problem and
   int q g(J) = 0 for every pressure function q their equations, the limit of  int q (g(J) - pi/kappa) = 0  that condensed cells solve inside.

   A pressure that no displacement answers (a constant where the whole boundary is held, a checkerboard of linear cells) would make the tangent singular. A
   diagonal of HOLD / mu int q^2 is taken off the tangent, not the residual: such a pressure stays what it was, any other is found in one step up to a part of
   about HOLD. */
#include "mechanicsimpl.h"

#define HOLD 1e-12

static PetscInt CellUnknowns_Private(Mechanics m, PetscInt cell)
{
  return m->cell_group[cell] < 0 ? 0 : m->groups[m->cell_group[cell]].num_unknown;
}

/* int q^2 of the cells of a group; its work arrays. */
static PetscErrorCode Group_Private(Mechanics m, CellGroup *g)
{
  const PetscInt nd = g->n * m->dim;
  PetscReal     *zero, *mass;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)g->num_cells * g->num_unknown * nd, &g->volume));
  PetscCall(PetscMalloc1(g->num_cells * g->num_unknown, &mass));
  PetscCall(PetscCalloc1(g->num_cells * nd, &zero));
  CellBatch batch = {.nc = g->num_cells, .X = g->X, .u = zero, .mass = mass};
  PetscCall(CellKernelEvaluate(g->kernel, &batch));
  for (PetscInt i = 0; i < g->num_cells; ++i) PetscCall(PetscArraycpy(m->mass + m->unknown_first[g->cells[i]], mass + i * g->num_unknown, g->num_unknown));
  PetscCall(PetscFree(mass));
  PetscCall(PetscFree(zero));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest extent of a cell along the axes. */
static PetscReal Extent_Private(PetscInt dim, PetscInt n, const PetscReal X[])
{
  PetscReal most = 0;

  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal lo = PETSC_MAX_REAL, hi = PETSC_MIN_REAL;
    for (PetscInt i = 0; i < n; ++i) {
      lo = PetscMin(lo, X[i * dim + d]);
      hi = PetscMax(hi, X[i * dim + d]);
    }
    most = PetscMax(most, hi - lo);
  }
  return most;
}

PetscErrorCode MechanicsUnknownsCreate_Private(Mechanics m)
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_cells + 1, &m->unknown_first));
  m->unknown_first[0] = 0;
  for (PetscInt c = 0; c < v->num_cells; ++c) m->unknown_first[c + 1] = m->unknown_first[c] + CellUnknowns_Private(m, c);
  const PetscInt owned = m->unknown_first[v->num_owned_cells];
  PetscCall(PetscCalloc1(m->unknown_first[v->num_cells], &m->pressure));
  PetscCall(PetscCalloc3(owned, &m->volume, owned, &m->mass, v->num_owned_cells, &m->volume_scale));
  for (PetscInt ig = 0; ig < m->num_groups; ++ig) {
    CellGroup *g = &m->groups[ig];
    if (!g->num_unknown) continue;
    PetscCall(Group_Private(m, g));
    for (PetscInt i = 0; i < g->num_cells; ++i)
      m->volume_scale[g->cells[i]] = MaterialYoung(g->material) / Extent_Private(m->dim, g->n, g->X + i * g->n * m->dim);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsUnknownsDestroy_Private(Mechanics m)
{
  PetscFunctionBegin;
  for (PetscInt g = 0; g < m->num_groups; ++g) PetscCall(PetscFree(m->groups[g].volume));
  PetscCall(PetscFree(m->unknown_first));
  PetscCall(PetscFree(m->pressure));
  PetscCall(PetscFree3(m->volume, m->mass, m->volume_scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void MechanicsUnknownsGather_Private(Mechanics m, const CellGroup *g, PetscInt i, PetscInt num, PetscReal pressure[])
{
  for (PetscInt k = 0; k < num; ++k) {
    for (PetscInt a = 0; a < g->num_unknown; ++a) *pressure++ = m->pressure[m->unknown_first[g->cells[i + k]] + a];
  }
}

void MechanicsUnknownsRows_Private(Mechanics m, const CellGroup *g, PetscInt i, PetscInt num, const PetscReal constraint[], PetscReal *largest)
{
  for (PetscInt k = 0; k < num; ++k) {
    const PetscInt cell = g->cells[i + k];
    for (PetscInt a = m->unknown_first[cell]; a < m->unknown_first[cell + 1]; ++a, ++constraint) {
      m->volume[a] = m->volume_scale[cell] * *constraint;
      *largest     = PetscMax(*largest, PetscAbsReal(*constraint) / m->mass[a]);
    }
  }
}

PetscErrorCode MechanicsNumUnknowns(Mechanics m, PetscInt *owned, PetscInt *all)
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  *owned = m->unknown_first[v->num_owned_cells];
  *all   = m->unknown_first[v->num_cells];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsUnknownRange(Mechanics m, PetscInt cell, PetscInt *first, PetscInt *num)
{
  PetscFunctionBegin;
  *first = m->unknown_first[cell];
  *num   = m->unknown_first[cell + 1] - *first;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetPressure(Mechanics m, const PetscReal pressure[])
{
  PetscInt owned, all;

  PetscFunctionBegin;
  PetscCall(MechanicsNumUnknowns(m, &owned, &all));
  PetscCall(PetscArraycpy(m->pressure, pressure, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsGetPressure(Mechanics m, PetscInt first, PetscInt num, PetscReal pressure[])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(pressure, m->pressure + first, num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsVolumeRows(Mechanics m, PetscReal rows[])
{
  PetscInt owned, all;

  PetscFunctionBegin;
  PetscCall(MechanicsNumUnknowns(m, &owned, &all));
  PetscCall(PetscArraycpy(rows, m->volume, owned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* B P: the rows of a cell by the dofs of its masters; local[num_nodes*dim] is 0 before and after. */
static PetscErrorCode Rows_Private(Mechanics m, const CellGroup *g, PetscInt cell, const PetscReal b[], PetscReal local[], PetscInt *num, PetscInt dofs[],
                                   PetscReal B[])
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  *num = 0;
  for (PetscInt k = v->cell_row[cell]; k < v->cell_row[cell + 1]; ++k)
    for (PetscInt d = 0; d < m->dim; ++d) dofs[(*num)++] = v->cell_master[k] * m->dim + d;
  for (PetscInt a = 0; a < g->num_unknown; ++a) {
    PetscCall(HPSpaceScatterAdd(m->space, cell, b + a * g->n * m->dim, local));
    for (PetscInt k = 0; k < *num; ++k) {
      B[a * *num + k] = local[dofs[k]];
      local[dofs[k]]  = 0;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsVolumeTangent(Mechanics m, VolumeSink sink, void *context)
{
  const HPTables *v    = HPSpaceGetTables(m->space);
  PetscInt        most = 0, num, *dofs;
  PetscReal      *B, *local, hold[MOST_PRESSURES];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    if (CellUnknowns_Private(m, c)) most = PetscMax(most, m->dim * (v->cell_row[c + 1] - v->cell_row[c]));
  }
  PetscCall(PetscMalloc2(most, &dofs, most * MOST_PRESSURES, &B));
  PetscCall(PetscCalloc1(v->num_nodes * m->dim, &local));
  for (PetscInt ig = 0; ig < m->num_groups; ++ig) {
    const CellGroup *g = &m->groups[ig];
    for (PetscInt i = 0; i < g->num_cells && g->num_unknown; ++i) {
      const PetscInt cell = g->cells[i];
      PetscCall(Rows_Private(m, g, cell, g->volume + (size_t)i * g->num_unknown * g->n * m->dim, local, &num, dofs, B));
      for (PetscInt a = 0; a < g->num_unknown; ++a) hold[a] = HOLD / g->material->mu * m->mass[m->unknown_first[cell] + a];
      PetscCall(sink(context, cell, g->num_unknown, num, dofs, B, m->volume_scale[cell], hold));
    }
  }
  PetscCall(PetscFree2(dofs, B));
  PetscCall(PetscFree(local));
  PetscFunctionReturn(PETSC_SUCCESS);
}
