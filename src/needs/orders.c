/* Orders higher than the tolerance needs: the strain that the displacements lose with their highest polynomials, along single axes of cells or all.

   On a line lower orders have the same ends and the best slope, the Legendre polynomials of the slope up to degree q - 1: what is lost of the nodal functions
   are integrals of the others. */
#include "needsimpl.h"

#define MOST_1D (MORTISE_MAX_ORDER + 1)

/* What is lost of nodal function i at node j on the way from an order to a lower one: R[j * (order + 1) + i]. */
static PetscErrorCode Lost_Private(PetscInt order, PetscInt lower, PetscReal R[])
{
  const Basis1D *basis;
  PetscReal      P[MOST_1D + 1];

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, order + 1, &basis));
  PetscCall(PetscArrayzero(R, (order + 1) * (order + 1)));
  for (PetscInt i = 0; i <= order; ++i) {
    PetscReal slope[MOST_1D] = {0}; /* its Legendre coefficients */
    for (PetscInt q = 0; q <= order; ++q) {
      PetscCall(ElementLegendre(order, basis->points[q], P, NULL));
      for (PetscInt k = lower; k < order; ++k) slope[k] += (PetscReal)(2 * k + 1) * basis->weights[q] * P[k] * basis->D[q * (order + 1) + i];
    }
    for (PetscInt j = 0; j <= order; ++j) {
      PetscCall(ElementLegendre(order, basis->nodes[j], P, NULL));
      for (PetscInt k = lower; k < order; ++k) R[j * (order + 1) + i] += slope[k] * (P[k + 1] - P[k - 1]) / (PetscReal)(2 * (2 * k + 1));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u less R u along an axis of the cell, in place. */
static void Lower_Private(PetscInt dim, PetscInt order, PetscInt axis, const PetscReal R[], PetscReal u[])
{
  const PetscInt n1 = order + 1, n = ElementNumNodes(dim, order) * dim;
  PetscInt       stride = dim;

  for (PetscInt d = 0; d < axis; ++d) stride *= n1;
  for (PetscInt start = 0; start < n; ++start) {
    PetscReal line[MOST_1D];
    if (start / stride % n1) continue;
    for (PetscInt k = 0; k < n1; ++k) line[k] = u[start + k * stride];
    for (PetscInt j = 0; j < n1; ++j)
      for (PetscInt k = 0; k < n1; ++k) u[start + j * stride] -= R[j * n1 + k] * line[k];
  }
}

/* Gradient of a field, values[n][dim], from those of the nodal functions. */
static void Gradient_Private(PetscInt dim, PetscInt n, const PetscReal gradient[], const PetscReal values[], PetscReal F[9])
{
  for (PetscInt k = 0; k < 9; ++k) F[k] = 0;
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt a = 0; a < dim; ++a)
      for (PetscInt b = 0; b < dim; ++b) F[3 * a + b] += values[dim * i + a] * gradient[dim * i + b];
}

/* int mu |sym grad u|^2 over a cell with nodes at X. */
static PetscErrorCode Strain_Private(PetscInt dim, PetscInt order, PetscBool ring, PetscReal mu, const PetscReal X[], const PetscReal u[], PetscReal *energy)
{
  const PetscInt n = ElementNumNodes(dim, order);
  const Basis1D *basis;
  PetscReal     *value, *gradient;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, order + 1, &basis));
  PetscCall(PetscMalloc2(n, &value, n * dim, &gradient));
  for (PetscInt q = 0; q < n; ++q) {
    PetscReal xi[3], J[9], G[9], radius = 0, sum = 0;
    PetscReal weight = Basis1DPoint(basis, dim, q, xi);
    PetscCall(ElementEvaluate(dim, order, xi, value, gradient));
    Gradient_Private(dim, n, gradient, X, J);
    Gradient_Private(dim, n, gradient, u, G);
    if (dim == 2) J[8] = 1;
    for (PetscInt i = 0; i < n; ++i) radius += value[i] * X[dim * i];
    for (PetscInt a = 0; a < dim; ++a) { /* rows of G J^-1: J^T g = G^T */
      const PetscReal c0[3] = {J[0], J[1], J[2]}, c1[3] = {J[3], J[4], J[5]}, c2[3] = {J[6], J[7], J[8]};
      const PetscReal T[9] = {c0[0], c1[0], c2[0], c0[1], c1[1], c2[1], c0[2], c1[2], c2[2]}, right[3] = {G[3 * a], G[3 * a + 1], G[3 * a + 2]};
      PetscReal       g[3];
      if (!Solve3(T, right, g)) g[0] = g[1] = g[2] = 0;
      for (PetscInt b = 0; b < 3; ++b) G[3 * a + b] = g[b];
    }
    for (PetscInt a = 0; a < 3; ++a)
      for (PetscInt b = 0; b < 3; ++b) sum += 0.25 * PetscSqr(G[3 * a + b] + G[3 * b + a]);
    weight *= PetscAbsReal(Det3(J)) * (ring ? 2 * PETSC_PI * radius : 1);
    *energy += weight * mu * sum;
  }
  PetscCall(PetscFree2(value, gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The direction of space that an axis of the cell runs mostly along. */
static PetscInt Mostly_Private(PetscInt dim, PetscInt order, PetscInt axis, const PetscReal X[])
{
  PetscInt  stride = 1, best = 0;
  PetscReal line[3] = {0};

  for (PetscInt d = 0; d < axis; ++d) stride *= order + 1;
  for (PetscInt i = 0; i < ElementNumNodes(dim, order); ++i) {
    const PetscInt at = i / stride % (order + 1);
    for (PetscInt c = 0; c < dim && (at == 0 || at == order); ++c) line[c] += at ? X[dim * i + c] : -X[dim * i + c];
  }
  for (PetscInt c = 1; c < dim; ++c)
    if (PetscAbsReal(line[c]) > PetscAbsReal(line[best])) best = c;
  return best;
}

PetscErrorCode NeedsLostByOrder(const NeedsRun *run, PetscInt body, PetscInt direction, PetscInt lower, PetscReal *energy)
{
  const MechanicsSpec *m   = &run->data->mechanics;
  const PetscReal      mu  = m->bodies[body].material->mu;
  const PetscInt       dim = m->model == MODEL_3D ? 3 : 2, most = ElementNumNodes(dim, MORTISE_MAX_ORDER) * dim;
  HPSpace              space = ProblemSpace(run->level->problem);
  PetscReal           *local, *X, *u, *kept, R[MOST_1D * MOST_1D];

  PetscFunctionBegin;
  *energy               = 0;
  const ForestTables *t = ForestGetTables(run->level->forest);
  const HPTables     *v = HPSpaceGetTables(space);
  PetscCall(PetscMalloc4(v->num_nodes * v->dim, &local, most, &X, most, &u, most, &kept));
  PetscCall(ProblemLocalDisplacement(run->level->problem, run->level->accepted.x, local));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt p = v->cell_order[c], n = ElementNumNodes(dim, p) * dim;
    if (t->leaf_body[v->cell_leaf[c]] != body || p <= lower) continue;
    PetscCall(HPSpaceGatherPositions(space, c, X));
    PetscCall(HPSpaceGather(space, c, local, u));
    PetscCall(PetscArraycpy(kept, u, n));
    PetscCall(Lost_Private(p, lower, R));
    for (PetscInt d = 0; d < dim; ++d)
      if (direction < 0 || Mostly_Private(dim, p, d, X) == direction) Lower_Private(dim, p, d, R, kept);
    for (PetscInt i = 0; i < n; ++i) u[i] -= kept[i];
    PetscCall(Strain_Private(dim, p, (PetscBool)(m->model == MODEL_AXISYMMETRIC), mu, X, u, energy));
  }
  PetscCall(PetscFree4(local, X, u, kept));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, energy, 1, MPIU_REAL, MPI_SUM, run->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
