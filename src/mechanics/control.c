/* Follower pressures that are found: what makes the boundary enclose so much more volume, or advance so far. Here: what is followed, and its derivative. */
#include "mechanicsimpl.h"

#define SWEEP_POINTS 2 /* Gauss points on the way from X to X + u: normals are of degree 1 to 2 in it */

PetscErrorCode MechanicsControlsCreate_Private(Mechanics m)
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc2(m->spec->num_boundaries, &m->control, m->spec->num_boundaries, &m->control_pressure));
  for (PetscInt b = 0; b < m->spec->num_boundaries; ++b) {
    if (BoundaryIsControlled(&m->spec->boundaries[b])) m->control[m->num_controls++] = b;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsGetControls(Mechanics m, PetscInt *num, const PetscInt **boundary)
{
  PetscFunctionBegin;
  *num      = m->num_controls;
  *boundary = m->control;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetControls(Mechanics m, const PetscReal pressure[])
{
  PetscFunctionBegin;
  PetscCall(PetscArraycpy(m->control_pressure, pressure, m->num_controls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPressure(Mechanics m, PetscInt boundary, const PetscReal X[3], PetscReal t, PetscReal *pressure)
{
  const BoundarySpec *b = &m->spec->boundaries[boundary];
  PetscInt            k = 0;

  PetscFunctionBegin;
  if (b->pressure) {
    PetscCall(MechanicsValue(b->pressure, &b->amplitude, X, t, pressure));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  while (m->control[k] != boundary) ++k;
  *pressure = m->control_pressure[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One facet: nodes, positions, displacements, and room for what FacetPressure makes at X + s u. */
typedef struct {
  Mechanics        m;
  const LoadFacet *f;
  PetscInt         order, num, size, nodes[MOST_FACET_NODES];
  PetscReal        X[3 * MOST_FACET_NODES], u[3 * MOST_FACET_NODES], one[MOST_FACET_POINTS];
  PetscReal        r[3 * MOST_FACET_NODES], *K; /* owned [size][size] */
} Patch;

static PetscErrorCode PatchCreate_Private(Mechanics m, const LoadFacet *f, const PetscReal u[], PetscReal *values, Patch *p)
{
  PetscFunctionBegin;
  p->m     = m;
  p->f     = f;
  p->order = m->groups[m->cell_group[f->cell]].order;
  p->num   = MechanicsTrace_Private(m, f, p->nodes, p->X);
  p->size  = p->num * m->dim;
  PetscCall(HPSpaceGather(m->space, f->cell, u, values));
  for (PetscInt i = 0; i < p->size; ++i) p->u[i] = values[p->nodes[i / m->dim] * m->dim + i % m->dim];
  for (PetscInt q = 0; q < FacetNumPoints(m->dim, p->order); ++q) p->one[q] = 1;
  PetscCall(PetscMalloc1(p->size * p->size, &p->K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* p->r: int N n da at X + s u, n out of the body; p->K its derivative by position when wanted. */
static PetscErrorCode PatchAt_Private(Patch *p, PetscReal s, PetscBool derivative)
{
  PetscReal x[3 * MOST_FACET_NODES];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->size; ++i) x[i] = p->X[i] + s * p->u[i];
  PetscCall(FacetPressure(p->m->dim, p->m->spec->model, p->order, x, MechanicsOutwardSign_Private(p->f->side), p->one, p->r, derivative ? p->K : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add -weight int u . n da at X + s u to the value; its derivative by u to g[size]. */
static PetscErrorCode PatchSweep_Private(Patch *p, PetscReal s, PetscReal weight, PetscBool derivative, PetscReal *value, PetscReal g[])
{
  PetscFunctionBegin;
  PetscCall(PatchAt_Private(p, s, (PetscBool)(derivative && s > 0)));
  for (PetscInt i = 0; i < p->size; ++i) {
    *value -= weight * p->u[i] * p->r[i];
    g[i] -= weight * p->r[i];
    for (PetscInt j = 0; derivative && s > 0 && j < p->size; ++j) g[j] -= weight * s * p->u[i] * p->K[i * p->size + j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add what belongs to the nodes of a facet to a local array. */
static PetscErrorCode PatchScatter_Private(const Patch *p, const PetscReal g[], PetscReal *values, PetscReal local[])
{
  const PetscInt dim = p->m->dim;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(values, p->m->groups[p->m->cell_group[p->f->cell]].n * dim));
  for (PetscInt i = 0; i < p->size; ++i) values[p->nodes[i / dim] * dim + i % dim] = g[i];
  PetscCall(HPSpaceScatterAdd(p->m->space, p->f->cell, values, local));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsControl(Mechanics m, PetscInt k, const PetscReal u[], PetscReal *value, PetscReal gradient[], PetscReal force[])
{
  const BoundarySpec *b = &m->spec->boundaries[m->control[k]];
  const Basis1D      *way;
  PetscReal          *values;
  Patch               p;

  PetscFunctionBegin;
  *value = 0;
  PetscCall(Basis1DGet(1, SWEEP_POINTS, &way));
  PetscCall(PetscMalloc1(3 * (MORTISE_MAX_ORDER + 1) * MOST_FACET_NODES, &values));
  for (PetscInt i = 0; i < m->num_facets; ++i) {
    PetscReal g[3 * MOST_FACET_NODES] = {0};
    if (m->facets[i].boundary != m->control[k]) continue;
    PetscCall(PatchCreate_Private(m, &m->facets[i], u, values, &p));
    for (PetscInt s = 0; s < SWEEP_POINTS && b->volume; ++s)
      PetscCall(PatchSweep_Private(&p, way->points[s], way->weights[s], (PetscBool)(gradient != NULL), value, g));
    if (b->advance) PetscCall(PatchSweep_Private(&p, 0, 1, PETSC_TRUE, value, g));
    if (gradient) PetscCall(PatchScatter_Private(&p, g, values, gradient));
    if (force) PetscCall(PatchAt_Private(&p, 1, PETSC_FALSE));
    if (force) PetscCall(PatchScatter_Private(&p, p.r, values, force));
    PetscCall(PetscFree(p.K));
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsControlArea(Mechanics m, PetscInt k, PetscReal sum[2])
{
  PetscInt  nodes[MOST_FACET_NODES];
  PetscReal X[3 * MOST_FACET_NODES], dA[MOST_FACET_POINTS];

  PetscFunctionBegin;
  sum[0] = sum[1] = 0;
  for (PetscInt i = 0; i < m->num_facets; ++i) {
    const LoadFacet *f = &m->facets[i];
    const CellGroup *g = &m->groups[m->cell_group[f->cell]];
    if (f->boundary != m->control[k]) continue;
    (void)MechanicsTrace_Private(m, f, nodes, X);
    PetscCall(FacetQuadrature(m->dim, m->spec->model, g->order, X, NULL, dA, NULL));
    for (PetscInt q = 0; q < FacetNumPoints(m->dim, g->order); ++q) {
      sum[0] += dA[q];
      sum[1] += dA[q] * g->material->mu;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsControlNodes(Mechanics m, PetscInt k, PetscBool mark[])
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num_facets; ++i) {
    const PetscInt cell = m->facets[i].cell;
    if (m->facets[i].boundary != m->control[k]) continue;
    for (PetscInt j = v->cell_row[cell]; j < v->cell_row[cell + 1]; ++j) mark[v->cell_master[j]] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
