/* Viscous regularisation: forces against the deformation since a given state, in residual and tangent alike. With it there is a solution near that state where
   without there is none: what snaps creeps from one equilibrium to the next (path/recover.c).

     r_i += c (d_i - mean of d over the cell's n nodes),   d = u - from,   c = rate E p^2 h^(dim-2) / n   (axisymmetric: times 2 pi R)

   E Young's modulus, h the cell's extent: with rate 1 about what the cell answers itself. Cells that only move as a whole feel nothing of it. */
#include "mechanicsimpl.h"

PetscErrorCode MechanicsSetViscosity(Mechanics m, PetscReal rate, const PetscReal from[])
{
  PetscInt most = 0;

  PetscFunctionBegin;
  m->viscosity = rate;
  if (rate == 0) PetscFunctionReturn(PETSC_SUCCESS);
  const HPTables *v = HPSpaceGetTables(m->space);
  for (PetscInt g = 0; g < m->num_groups; ++g) most = PetscMax(most, m->groups[g].n * m->dim);
  if (!m->viscous_from) PetscCall(PetscMalloc2(v->num_nodes * m->dim, &m->viscous_from, 2 * most, &m->viscous_room));
  PetscCall(PetscArraycpy(m->viscous_from, from, v->num_nodes * m->dim));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* c of cell i of a group. */
static PetscReal Coefficient_Private(Mechanics m, const CellGroup *g, PetscInt i)
{
  const PetscReal *X = g->X + i * g->n * m->dim;
  PetscReal        lo[3], hi[3], size = 1;

  for (PetscInt d = 0; d < m->dim; ++d) lo[d] = hi[d] = X[d];
  for (PetscInt k = 0; k < g->n * m->dim; ++k) {
    lo[k % m->dim] = PetscMin(lo[k % m->dim], X[k]);
    hi[k % m->dim] = PetscMax(hi[k % m->dim], X[k]);
  }
  if (m->dim == 3) size = cbrt((hi[0] - lo[0]) * (hi[1] - lo[1]) * (hi[2] - lo[2]));
  if (m->spec->model == MODEL_AXISYMMETRIC) size = PETSC_PI * (lo[0] + hi[0]);
  return m->viscosity * MaterialYoung(g->material) * PetscSqr((PetscReal)g->order) * size / (PetscReal)g->n;
}

/* d less its mean, at displacements u[n][dim] of the cell; d[n][dim]. */
static PetscErrorCode Change_Private(Mechanics m, const CellGroup *g, PetscInt i, const PetscReal u[], PetscReal d[])
{
  PetscReal mean[3] = {0, 0, 0};

  PetscFunctionBegin;
  PetscCall(HPSpaceGather(m->space, g->cells[i], m->viscous_from, d));
  for (PetscInt k = 0; k < g->n * m->dim; ++k) {
    d[k] = u[k] - d[k];
    mean[k % m->dim] += d[k] / (PetscReal)g->n;
  }
  for (PetscInt k = 0; k < g->n * m->dim; ++k) d[k] -= mean[k % m->dim];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsViscousForces_Private(Mechanics m, const CellGroup *g, PetscInt i, const PetscReal u[], PetscReal r[])
{
  const PetscReal c = Coefficient_Private(m, g, i);

  PetscFunctionBegin;
  PetscCall(Change_Private(m, g, i, u, m->viscous_room));
  for (PetscInt k = 0; k < g->n * m->dim; ++k) r[k] += c * m->viscous_room[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same for any order of the nodes: rows of those inside stand apart where they are condensed, without the transpose of their other columns. */
void MechanicsViscousMatrix_Private(Mechanics m, const CellGroup *g, PetscInt i, PetscInt num_inner, PetscReal inner[], PetscReal K[])
{
  const PetscReal c  = Coefficient_Private(m, g, i);
  const PetscInt  nd = g->n * m->dim;

  for (PetscInt k = 0; k < nd; ++k) {
    for (PetscInt l = k < num_inner ? 0 : num_inner; l < nd; ++l) {
      PetscReal *to = k < num_inner ? inner + k * nd + l : K + (k - num_inner) * (nd - num_inner) + l - num_inner;
      if (k % m->dim == l % m->dim) *to += c * ((PetscReal)(k == l) - 1 / (PetscReal)g->n);
    }
  }
}

PetscErrorCode MechanicsViscousWork(Mechanics m, const PetscReal u[], PetscReal *work)
{
  PetscFunctionBegin;
  *work = 0;
  for (PetscInt ig = 0; ig < m->num_groups && m->viscosity > 0; ++ig) {
    const CellGroup *g = &m->groups[ig];
    PetscReal       *d = m->viscous_room, *values = d + g->n * m->dim;
    for (PetscInt i = 0; i < g->num_cells; ++i) {
      const PetscReal c = Coefficient_Private(m, g, i);
      PetscCall(HPSpaceGather(m->space, g->cells[i], u, values));
      PetscCall(Change_Private(m, g, i, values, d));
      for (PetscInt k = 0; k < g->n * m->dim; ++k) *work += c * PetscSqr(d[k]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
