/* Cells per second of processor time of the cell kernel: residual alone, with full tangent, and with the tangent from which the nodes inside the cell are
   eliminated. neo_hookean, finite kinematics. Usage: bench_kernel [seconds per figure [highest order [lowest order [lowest dimension]]]] */
#include "mechanicsimpl.h"
#include <stdio.h>
#include <time.h>

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
        u[(c * n + node) * dim + i] = 0.03 * PetscSinReal(1 + i + 2 * xi[i] * xi[(i + 1) % 3]);
      }
    }
  }
}

/* One batch, and its condensation when mechanics is given. */
static PetscErrorCode Once(CellKernel kernel, CellBatch *batch, Mechanics mechanics)
{
  PetscFunctionBegin;
  PetscCall(CellKernelEvaluate(kernel, batch));
  for (PetscInt c = 0; mechanics && c < batch->nc; c++) {
    CellGroup     *g        = mechanics->groups;
    const PetscInt rest     = (g->n - g->num_inner) * mechanics->dim;
    PetscBool      singular = PETSC_FALSE;

    PetscCall(MechanicsCondenseCell_Private(mechanics, g, c, batch->tangent + c * rest * rest, &singular));
    PetscCheck(!singular, PETSC_COMM_SELF, PETSC_ERR_PLIB, "singular");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of this process: other processes of the machine do not count. */
static PetscReal Seconds(void)
{
  struct timespec now;

  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (PetscReal)now.tv_sec + 1e-9 * (PetscReal)now.tv_nsec;
}

/* Fastest of batches repeated for about `seconds`. */
static PetscReal Rate(CellKernel kernel, CellBatch *batch, Mechanics mechanics, PetscReal seconds)
{
  const PetscReal start = Seconds();
  PetscReal       begin, now, best = 1e30;

  do {
    begin = Seconds();
    PetscCallAbort(PETSC_COMM_SELF, Once(kernel, batch, mechanics));
    now  = Seconds();
    best = PetscMin(best, now - begin);
  } while (now - start < seconds);
  return batch->nc / best;
}

/* Wanted of hexahedra without pressures, and whether it is met. */
static const char *Verdict(PetscInt dim, PetscInt order, Formulation formulation, PetscReal residual, PetscReal condensed)
{
  if (dim != 3 || formulation != FORMULATION_DISPLACEMENT) return "";
  if (order == 4) return residual >= 60000 && condensed >= 1000 ? "residual 60000, condensed 1000: met" : "residual 60000, condensed 1000: missed";
  if (order == 6) return condensed >= 100 ? "condensed 100: met" : "condensed 100: missed";
  return "";
}

static PetscErrorCode Measure(PetscInt dim, PetscInt order, Formulation formulation, PetscReal seconds)
{
  const char *const   names[]  = {"E", "nu"};
  const PetscReal     values[] = {1, 0.3};
  MaterialSpec        spec     = {.name = "bench", .law = MaterialLawFind("neo_hookean"), .formulation = formulation};
  PetscInt            n, m, nc, size;
  PetscReal          *X, *u, *r, *K, *e, *det, residual_rate, rate, condensed;
  CellGroup           group     = {.order = order};
  struct _p_Mechanics mechanics = {.dim = dim, .num_groups = 1, .groups = &group};
  CellKernel          kernel;

  PetscFunctionBegin;
  PetscCall(MaterialSetUp(&spec, 2, names, values));
  PetscCall(CellKernelCreate(dim, dim == 3 ? MODEL_3D : MODEL_PLANE_STRAIN, KINEMATICS_FINITE, order, &spec, &kernel));
  CellKernelSizes(kernel, &n, &m, &nc);
  size            = n * dim;
  group.n         = n;
  group.num_cells = nc;
  PetscCall(MechanicsSetCondense(&mechanics));
  PetscCall(PetscMalloc6(nc * size, &X, nc * size, &u, nc * size, &r, nc * size * size, &K, nc, &e, nc, &det));
  Fill(dim, order, nc, X, u);
  {
    CellBatch batch = {.nc = nc, .X = X, .u = u, .energy = e, .residual = r, .min_det = det};

    residual_rate   = Rate(kernel, &batch, NULL, seconds);
    batch.tangent   = K;
    rate            = Rate(kernel, &batch, NULL, seconds);
    batch.place     = group.place;
    batch.num_inner = group.num_inner;
    batch.inner     = group.factor;
    condensed       = Rate(kernel, &batch, &mechanics, seconds);
    PetscCheck(!batch.bad, PETSC_COMM_SELF, PETSC_ERR_PLIB, "det F <= 0");
  }
  printf("%-4s  %5d  %-12s  %5d  %12.0f  %18.0f  %12.0f  %s\n", dim == 3 ? "hex" : "quad", (int)order,
         formulation == FORMULATION_MIXED ? "mixed" : "displacement", (int)nc, residual_rate, rate, condensed,
         Verdict(dim, order, formulation, residual_rate, condensed));
  PetscCall(PetscFree6(X, u, r, K, e, det));
  PetscCall(MechanicsCondenseDestroy_Private(&mechanics));
  PetscCall(CellKernelDestroy(&kernel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const PetscReal seconds = argc > 1 ? atof(argv[1]) : 0.3;
  const PetscInt  highest = argc > 2 ? atoi(argv[2]) : 6, lowest = argc > 3 ? atoi(argv[3]) : 1, least = argc > 4 ? atoi(argv[4]) : 2;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  printf("cell  order  formulation   batch  residual/s    residual+tangent/s   condensed/s  wanted\n");
  for (PetscInt dim = least; dim <= 3; dim++) {
    for (PetscInt order = lowest; order <= highest; order++) {
      PetscCall(Measure(dim, order, FORMULATION_DISPLACEMENT, seconds));
      PetscCall(Measure(dim, order, FORMULATION_MIXED, seconds));
    }
  }
  return PetscFinalize();
}
