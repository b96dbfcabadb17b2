/* Polynomial geometry of the coarse cells: Lagrange interpolation at equispaced nodes. */
#include "forestimpl.h"

/* Lagrange functions of order q at the nodes i/q and their derivatives. */
static void Equispaced_Private(PetscInt q, PetscReal xi, PetscReal value[], PetscReal derivative[])
{
  if (q == 1) {
    value[0] = 1 - xi, value[1] = xi;
    derivative[0] = -1, derivative[1] = 1;
    return;
  }
  for (PetscInt i = 0; i <= q; ++i) {
    PetscReal v = 1, d = 0;
    for (PetscInt j = 0; j <= q; ++j) {
      if (j == i) continue;
      const PetscReal factor = (q * xi - j) / (i - j);
      d                      = d * factor + v * q / (i - j);
      v *= factor;
    }
    value[i]      = v;
    derivative[i] = d;
  }
}

void ForestCoarseMapPoint(const CoarseMesh *mesh, PetscInt cell, const PetscReal xi[], PetscReal X[3], PetscReal jacobian[])
{
  const PetscInt   dim = mesh->dim, q = mesh->geometry_order, n = q + 1, nz = dim == 3 ? n : 1;
  const PetscReal *node                       = &mesh->cell_geometry[3 * cell * n * n * nz];
  PetscReal        B[3][FOREST_MAX_ORDER + 1] = {{0}}, D[3][FOREST_MAX_ORDER + 1] = {{0}};

  B[2][0] = 1;
  for (PetscInt i = 0; i < dim; ++i) Equispaced_Private(q, xi[i], B[i], D[i]);
  X[0] = X[1] = X[2] = 0;
  if (jacobian)
    for (PetscInt i = 0; i < 3 * dim; ++i) jacobian[i] = 0;
  for (PetscInt k = 0; k < nz; ++k)
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = 0; i < n; ++i, node += 3) {
        const PetscReal value       = B[0][i] * B[1][j] * B[2][k];
        const PetscReal gradient[3] = {D[0][i] * B[1][j] * B[2][k], B[0][i] * D[1][j] * B[2][k], B[0][i] * B[1][j] * D[2][k]};
        for (PetscInt c = 0; c < 3; ++c) {
          X[c] += value * node[c];
          if (jacobian)
            for (PetscInt a = 0; a < dim; ++a) jacobian[c * dim + a] += gradient[a] * node[c];
        }
      }
}

void ForestCoarseBox(const CoarseMesh *mesh, PetscReal lo[3], PetscReal hi[3])
{
  const PetscInt num = mesh->num_cells * PetscPowInt(mesh->geometry_order + 1, mesh->dim);

  for (PetscInt c = 0; c < 3; ++c) lo[c] = hi[c] = mesh->cell_geometry[c];
  for (PetscInt i = 0; i < 3 * num; ++i) {
    lo[i % 3] = PetscMin(lo[i % 3], mesh->cell_geometry[i]);
    hi[i % 3] = PetscMax(hi[i % 3], mesh->cell_geometry[i]);
  }
}

PetscErrorCode ForestMapPoint(Forest forest, PetscInt leaf, const PetscReal xi[], PetscReal X[3])
{
  const ForestTables *t = &forest->tables;
  PetscReal           eta[3];

  PetscFunctionBeginHot;
  for (PetscInt i = 0; i < t->dim; ++i) {
    const PetscInt extent = FOREST_ONE >> t->leaf_level[3 * leaf + i];
    eta[i]                = (t->leaf_lo[3 * leaf + i] + xi[i] * extent) / FOREST_ONE;
  }
  ForestCoarseMapPoint(&forest->coarse->mesh, t->leaf_root[leaf], eta, X, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}
