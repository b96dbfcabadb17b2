/* Element pressures: polynomials of degree p-1 in each cell, carried over by L2 projection on the new cell: exact in a refined cell, best fit in a
   merged one. */
#include "transferimpl.h"

#define MOST_1D (MORTISE_MAX_ORDER + 2)

/* Points and weights (reference measure of the new cell) on the part of a new leaf that one old leaf covers, and the old pressure there. */
typedef struct {
  PetscInt   num;
  PetscReal *xi, *weight, *value; /* owned: [num][dim], [num], [num] */
} Samples;

/* Reference volume per unit of leaf coordinates, from the new cell's nodes; axisymmetric: times radius. */
static PetscErrorCode Measure_Private(const TransferContext *c, PetscInt order, const PetscReal X[], const PetscReal xi[], PetscReal N[], PetscReal G[],
                                      PetscReal *measure)
{
  const PetscInt dim  = c->new_t->dim;
  PetscReal      J[9] = {0}, radius = 0;

  PetscFunctionBegin;
  PetscCall(ElementEvaluate(dim, order, xi, N, G));
  if (dim == 2) J[8] = 1;
  for (PetscInt i = 0; i < ElementNumNodes(dim, order); ++i) {
    radius += N[i] * X[i * dim];
    for (PetscInt a = 0; a < dim; ++a)
      for (PetscInt d = 0; d < dim; ++d) J[3 * a + d] += G[i * dim + d] * X[i * dim + a];
  }
  *measure = Det3(J) * (c->spec->model == MODEL_AXISYMMETRIC ? radius : 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Append the Gauss points of the smaller of the two leaves (the overlap) as samples. */
static PetscErrorCode Sample_Private(const TransferContext *c, const OldCells *old, PetscInt new_leaf, PetscInt old_leaf, PetscInt new_order, Samples *s)
{
  const PetscInt dim = c->new_t->dim, first = s->num;
  const Basis1D *gauss;
  PetscReal     *old_xi;
  PetscInt       order, points = 1;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetOrder(c->old_space, c->old_t->first[dim] + old_leaf, &order));
  PetscCall(Basis1DGet(1, PetscMax(order, new_order) + 1, &gauss));
  for (PetscInt d = 0; d < dim; ++d) points *= gauss->num_points;
  PetscCall(PetscMalloc1(points * dim, &old_xi));
  for (PetscInt q = 0; q < points; ++q, ++s->num) {
    PetscReal *xi     = s->xi + s->num * dim, at[3];
    s->weight[s->num] = 1;
    for (PetscInt d = 0, i = q; d < dim; ++d, i /= gauss->num_points) {
      const PetscInt new_size = 1 << (FOREST_MAX_LEVEL - c->new_t->leaf_level[3 * new_leaf + d]),
                     old_size = 1 << (FOREST_MAX_LEVEL - c->old_t->leaf_level[3 * old_leaf + d]);
      const PetscReal part    = PetscMin(1.0, (PetscReal)old_size / new_size);
      const PetscReal start   = PetscMax(0.0, (PetscReal)(c->old_t->leaf_lo[3 * old_leaf + d] - c->new_t->leaf_lo[3 * new_leaf + d]) / new_size);
      xi[d]                   = start + part * gauss->points[i % gauss->num_points];
      s->weight[s->num] *= part * gauss->weights[i % gauss->num_points];
    }
    PetscCheck(TransferPlace_Private(c, new_leaf, xi, old_leaf, at), PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "leaf %" PetscInt_FMT " does not overlap old leaf %" PetscInt_FMT, new_leaf, old_leaf);
    for (PetscInt d = 0; d < dim; ++d) old_xi[q * dim + d] = at[d];
  }
  const PetscReal *coefficients = old->values + old->offset[old_leaf] + ElementNumNodes(dim, order) * dim;
  PetscCall(MechanicsPressureEvaluate(dim, order, points, old_xi, coefficients, s->value + first));
  PetscCall(PetscFree(old_xi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Cell_Private(const TransferContext *c, const OldCells *old, PetscInt cell, PetscReal *X, PetscReal *N, PetscReal *G, Samples *s,
                                   PetscReal pressure[])
{
  const PetscInt leaf = c->new_v->cell_leaf[cell], order = c->new_v->cell_order[cell];

  PetscFunctionBegin;
  s->num = 0;
  PetscCall(HPSpaceGatherPositions(c->new_space, cell, X));
  for (PetscInt k = c->map->old_first[leaf]; k < c->map->old_first[leaf] + c->map->old_count[leaf]; ++k) PetscCall(Sample_Private(c, old, leaf, k, order, s));
  for (PetscInt q = 0; q < s->num; ++q) {
    PetscReal measure;
    PetscCall(Measure_Private(c, order, X, s->xi + q * c->new_t->dim, N, G, &measure));
    s->weight[q] *= measure;
  }
  PetscCall(MechanicsPressureProject(c->new_t->dim, order, s->num, s->xi, s->weight, s->value, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Most old leaves that merge into one new one of this rank. */
static PetscInt MostOld_Private(const TransferContext *c)
{
  PetscInt most = 1;
  for (PetscInt i = 0; i < c->new_v->num_owned_cells; ++i) most = PetscMax(most, c->map->old_count[c->new_v->cell_leaf[i]]);
  return most;
}

PetscErrorCode TransferPressure_Private(const TransferContext *c, const OldCells *old, PetscReal pressure[])
{
  const PetscInt dim = c->new_t->dim, n = ElementNumNodes(dim, MORTISE_MAX_ORDER),
                 most = MostOld_Private(c) * (dim == 2 ? MOST_1D * MOST_1D : MOST_1D * MOST_1D * MOST_1D);
  PetscReal *X, *N, *G;
  Samples    s;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(n * dim, &X, n, &N, n * dim, &G));
  PetscCall(PetscMalloc3(most * dim, &s.xi, most, &s.weight, most, &s.value));
  for (PetscInt cell = 0; cell < c->new_v->num_owned_cells; ++cell) {
    PetscInt first, num;
    PetscCall(MechanicsPressureRange(c->new_mechanics, cell, &first, &num));
    if (num) PetscCall(Cell_Private(c, old, cell, X, N, G, &s, pressure + first));
  }
  PetscCall(PetscFree3(s.xi, s.weight, s.value));
  PetscCall(PetscFree3(X, N, G));
  PetscFunctionReturn(PETSC_SUCCESS);
}
