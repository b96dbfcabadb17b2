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

/* The box that two leaves share: its low corner and extents in root units. PETSC_FALSE: none (the map of a cell that was merged and split again lists
   neighbours too). */
static PetscBool Overlap_Private(const TransferContext *c, PetscInt new_leaf, PetscInt old_leaf, PetscInt lo[3], PetscInt extent[3])
{
  const ForestTables *n = c->new_t, *o = c->old_t;

  for (PetscInt d = 0; d < n->dim; ++d) {
    const PetscInt a = n->leaf_lo[3 * new_leaf + d], b = o->leaf_lo[3 * old_leaf + d];
    const PetscInt a_end = a + (1 << (FOREST_MAX_LEVEL - n->leaf_level[3 * new_leaf + d])),
                   b_end = b + (1 << (FOREST_MAX_LEVEL - o->leaf_level[3 * old_leaf + d]));
    lo[d]                = PetscMax(a, b);
    extent[d]            = PetscMin(a_end, b_end) - lo[d];
    if (extent[d] <= 0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Place in a leaf, along direction d, of a point of the overlap at fraction `at` of its extent. */
static PetscReal InLeaf_Private(const ForestTables *t, PetscInt leaf, PetscInt d, PetscInt lo, PetscInt extent, PetscReal at)
{
  return ((PetscReal)(lo - t->leaf_lo[3 * leaf + d]) + at * (PetscReal)extent) / (PetscReal)(1 << (FOREST_MAX_LEVEL - t->leaf_level[3 * leaf + d]));
}

/* Append the Gauss points of the overlap with one old leaf as samples. */
static PetscErrorCode Sample_Private(const TransferContext *c, const OldCells *old, PetscInt new_leaf, PetscInt old_leaf, PetscInt new_order, Samples *s)
{
  const PetscInt dim = c->new_t->dim, first = s->num;
  const Basis1D *gauss;
  PetscReal     *old_xi;
  PetscInt       order, points = 1, lo[3], extent[3];

  PetscFunctionBegin;
  if (!Overlap_Private(c, new_leaf, old_leaf, lo, extent)) PetscFunctionReturn(PETSC_SUCCESS);
  order = HPSpaceGetOrder(c->old_space, c->old_t->first[dim] + old_leaf);
  PetscCall(Basis1DGet(1, PetscMax(order, new_order) + 1, &gauss));
  for (PetscInt d = 0; d < dim; ++d) points *= gauss->num_points;
  PetscCall(PetscMalloc1(points * dim, &old_xi));
  for (PetscInt q = 0; q < points; ++q, ++s->num) {
    s->weight[s->num] = 1;
    for (PetscInt d = 0, i = q; d < dim; ++d, i /= gauss->num_points) {
      const PetscReal at      = gauss->points[i % gauss->num_points];
      s->xi[s->num * dim + d] = InLeaf_Private(c->new_t, new_leaf, d, lo[d], extent[d], at);
      old_xi[q * dim + d]     = InLeaf_Private(c->old_t, old_leaf, d, lo[d], extent[d], at);
      s->weight[s->num] *= gauss->weights[i % gauss->num_points] * extent[d] / (1 << (FOREST_MAX_LEVEL - c->new_t->leaf_level[3 * new_leaf + d]));
    }
  }
  const PetscReal *coefficients = old->values + old->offset[old_leaf] + TransferNumNodal_Private(dim, order);
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

PetscErrorCode TransferPressure_Private(const TransferContext *c, const OldCells *old, PetscReal pressure[], PetscReal unknown[])
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
    PetscCall(MechanicsUnknownRange(c->new_mechanics, cell, &first, &num));
    if (num) PetscCall(Cell_Private(c, old, cell, X, N, G, &s, unknown + first));
  }
  PetscCall(PetscFree3(s.xi, s.weight, s.value));
  PetscCall(PetscFree3(X, N, G));
  PetscFunctionReturn(PETSC_SUCCESS);
}
