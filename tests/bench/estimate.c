/* Processor time of one estimate (this rank, without the reduction): 2048 quads and 1024 hexes, displacement and mixed. */
#define FOREST_BENCH
#include "../unit/bulkfixture.h"
#include "estimateimpl.h"
#include <time.h>

static void Time(PetscInt dim, PetscInt order, Formulation formulation)
{
  Bulk                b = {0};
  Box                 box;
  const HPTables     *v;
  const ForestTables *t;
  PetscReal          *u, *eta2;
  clock_t             start;
  PetscReal           best = 1e9;

  BulkInit(&b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
  BulkMaterial(&b.material, "neo_hookean", VOLUMETRIC_QUADRATIC, formulation, 1, 10);
  b.forest = BoxForest(PETSC_COMM_SELF, dim, (const PetscInt[3]){2, 1, 1}, 1, dim == 2 ? 5 : 3, 1, &box);
  BulkSetUp(&b, order, order);
  v = HPSpaceGetTables(b.space);
  t = ForestGetTables(b.forest);
  OK(PetscCalloc1(v->num_nodes * dim, &u));
  for (PetscInt n = 0; n < v->num_nodes; ++n) u[n * dim] = 0.1 * PetscSinReal(v->X[3 * n] + 2 * v->X[3 * n + 1]);
  OK(PetscCalloc1(t->num_leaves, &eta2));
  for (PetscInt k = 0; k < 10; ++k) {
    EstimateSum sum = {.space = b.space, .mechanics = b.mechanics, .spec = &b.spec, .time = 1, .u = u, .eta2 = eta2};
    start           = clock();
    OK(EstimateBulk_Private(&sum));
    best = PetscMin(best, (PetscReal)(clock() - start) / CLOCKS_PER_SEC);
  }
  OK(PetscPrintf(PETSC_COMM_SELF, "estimate, %s, p = %" PetscInt_FMT ", %4" PetscInt_FMT " cells, %s: %7.2f ms, %6.2f us a cell\n", dim == 2 ? "2-D" : "3-D",
                 order, t->num_leaves, formulation == FORMULATION_MIXED ? "mixed       " : "displacement", 1e3 * best, 1e6 * best / (double)t->num_leaves));
  OK(PetscFree(u));
  OK(PetscFree(eta2));
  BulkDestroy(&b);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt order = 1; order <= (dim == 2 ? 4 : 3); ++order) {
      Time(dim, order, FORMULATION_DISPLACEMENT);
      Time(dim, order, FORMULATION_MIXED);
    }
  }
  return PetscFinalize();
}
