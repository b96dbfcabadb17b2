/* Functions of a contact facet's nodes. */
#include "interface.h"

void SurfaceShape(PetscInt dim, PetscInt order, const PetscReal xi[], PetscReal N[], PetscReal dN[][2])
{
  PetscReal L[2][MORTISE_MAX_ORDER + 1] = {{0}, {1}}, D[2][MORTISE_MAX_ORDER + 1] = {{0}, {0}};

  for (PetscInt a = 0; a < dim - 1; ++a) PetscCallAbort(PETSC_COMM_SELF, ElementEvaluate1D(order, 0.5 * (1 + xi[a]), L[a], dN ? D[a] : NULL));
  for (PetscInt k = 0; k < ElementNumNodes(dim - 1, order); ++k) {
    const PetscInt i = k % (order + 1), j = k / (order + 1);
    N[k] = L[0][i] * L[1][j];
    if (!dN) continue;
    dN[k][0] = 0.5 * D[0][i] * L[1][j];
    dN[k][1] = 0.5 * L[0][i] * D[1][j];
  }
}

void SurfaceTangents_Private(PetscInt dim, PetscInt order, PetscInt num, const PetscInt node[], const PetscReal x[], const PetscReal xi[], PetscReal N[],
                             PetscReal tangent[2][3])
{
  PetscReal dN[SURFACE_MOST_NODES][2];

  for (PetscInt c = 0; c < 3; ++c) tangent[0][c] = tangent[1][c] = 0;
  if (dim == 2) tangent[1][2] = 1;
  SurfaceShape(dim, order, xi, N, dN);
  for (PetscInt k = 0; k < num; ++k) {
    for (PetscInt a = 0; a < dim - 1; ++a)
      for (PetscInt c = 0; c < dim; ++c) tangent[a][c] += dN[k][a] * x[dim * node[k] + c];
  }
}

void SurfaceTangents(const SurfaceView *s, PetscInt facet, const PetscReal x[], const PetscReal xi[], PetscReal tangent[2][3])
{
  const PetscInt *node, num = SurfaceFacetNodes(s, facet, &node);
  PetscReal       N[SURFACE_MOST_NODES];

  SurfaceTangents_Private(s->dim, s->order[facet], num, node, x, xi, N, tangent);
}
