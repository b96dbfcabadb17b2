/* Cells per second of the cell kernel on one core: residual alone, and residual with full tangent. neo_hookean, finite kinematics.
   Usage: bench_kernel [seconds per figure] */
#include "mechanicsimpl.h"
#include <petsctime.h>
#include <stdio.h>

/* A slightly distorted grid of cells with a smooth displacement. */
static void Fill(PetscInt dim, PetscInt order, PetscInt nc, PetscReal *X, PetscReal *u)
{
  const PetscReal *nodes;
  const PetscInt   n1 = order + 1, n = ElementNumNodes(dim, order);

  PetscCallAbort(PETSC_COMM_SELF, ElementGetNodes(order, &nodes));
  for (PetscInt c = 0; c < nc; c++) {
    for (PetscInt node = 0; node < n; node++) {
      const PetscReal xi[3] = {nodes[node % n1] + c % 7, nodes[node / n1 % n1], dim == 3 ? nodes[node / (n1 * n1)] : 0};

      for (PetscInt i = 0; i < dim; i++) {
        X[(c * n + node) * dim + i] = xi[i] + 0.05 * PetscSinReal(xi[0] + 2 * xi[1] + i) + 0.02 * xi[2];
        u[(c * n + node) * dim + i] = 0.05 * PetscSinReal(1 + i + 2 * xi[i] * xi[(i + 1) % 3]);
      }
    }
  }
}

/* Fastest of batches repeated for about `seconds`. */
static PetscReal Rate(CellKernel kernel, CellBatch *batch, PetscReal seconds)
{
  PetscLogDouble start, now, begin, best = 1e30;

  PetscTime(&start);
  do {
    PetscTime(&begin);
    for (int i = 0; i < 4; i++) PetscCallAbort(PETSC_COMM_SELF, CellKernelEvaluate(kernel, batch));
    PetscTime(&now);
    best = PetscMin(best, (now - begin) / 4);
  } while (now - start < seconds);
  return batch->nc / best;
}

static PetscErrorCode Measure(PetscInt dim, PetscInt order, Formulation formulation, PetscReal seconds)
{
  const char *const names[]  = {"E", "nu"};
  const PetscReal   values[] = {1, 0.3};
  MaterialSpec      spec     = {.name = "bench", .law = MaterialLawFind("neo_hookean"), .formulation = formulation};
  PetscInt          n, m, nc, size;
  PetscReal        *X, *u, *r, *K, *e, *det, residual_rate, rate;
  CellKernel        kernel;

  PetscFunctionBegin;
  PetscCall(MaterialSetUp(&spec, 2, names, values));
  PetscCall(CellKernelCreate(dim, dim == 3 ? MODEL_3D : MODEL_PLANE_STRAIN, KINEMATICS_FINITE, order, &spec, &kernel));
  CellKernelSizes(kernel, &n, &m, &nc);
  size = n * dim;
  PetscCall(PetscMalloc6(nc * size, &X, nc * size, &u, nc * size, &r, nc * size * size, &K, nc, &e, nc, &det));
  Fill(dim, order, nc, X, u);
  {
    CellBatch batch = {.nc = nc, .X = X, .u = u, .energy = e, .residual = r, .min_det = det};

    residual_rate = Rate(kernel, &batch, seconds);
    batch.tangent = K;
    rate          = Rate(kernel, &batch, seconds);
    PetscCheck(!batch.bad, PETSC_COMM_SELF, PETSC_ERR_PLIB, "det F <= 0");
  }
  printf("%-4s  %5d  %-12s  %5d  %12.0f  %18.0f\n", dim == 3 ? "hex" : "quad", (int)order, FormulationNames[formulation], (int)nc, residual_rate, rate);
  PetscCall(PetscFree6(X, u, r, K, e, det));
  PetscCall(CellKernelDestroy(&kernel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscReal seconds = argc > 1 ? atof(argv[1]) : 0.3;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  printf("cell  order  formulation   batch  residual/s    residual+tangent/s\n");
  for (PetscInt dim = 2; dim <= 3; dim++) {
    for (PetscInt order = 1; order <= 4; order++) {
      PetscCall(Measure(dim, order, FORMULATION_DISPLACEMENT, seconds));
      PetscCall(Measure(dim, order, FORMULATION_MIXED, seconds));
    }
  }
  return PetscFinalize();
}
