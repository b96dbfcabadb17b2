/* Cost of one adaptation and of the leaf mesh: refinement towards the lower left corner of a box. Seconds, best of several. */
#define FOREST_BENCH
#include "../unit/forest_box.h"
#include <petsctime.h>

/* Split every leaf whose lower corner lies within `radius` of the origin; merge those beyond twice that. */
static void MarkCorner(const Box *box, const ForestTables *t, PetscReal radius, MarkList *marks)
{
  OK(PetscCalloc1(t->num_leaves, &marks->split));
  OK(PetscCalloc1(t->num_leaves, &marks->coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    int64_t   lo[3], hi[3];
    PetscReal distance = 0;
    BoxLeaf(box, t, l, lo, hi);
    for (PetscInt a = 0; a < t->dim; ++a) distance += PetscSqr((PetscReal)lo[a] / FOREST_ONE);
    if (PetscSqrtReal(distance) < radius) marks->split[l] = (int8_t)((1 << t->dim) - 1);
  }
}

static void Run(PetscInt dim, const PetscInt n[3], PetscInt passes, PetscReal radius)
{
  Box            box;
  PetscLogDouble start, adapt = 1e9, leaf = 1e9, end;
  Forest         forest = BoxForest(PETSC_COMM_WORLD, dim, n, 2, 0, 1, &box), next;
  MarkList       marks;
  ForestMap      map;
  DM             dm;
  PetscMPIInt    rank;

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  for (PetscInt pass = 0; pass < passes; ++pass, radius *= 0.7) {
    MarkCorner(&box, &forest->tables, radius, &marks);
    for (PetscInt repeat = 0; repeat < (pass == passes - 1 ? 10 : 1); ++repeat) {
      OK(PetscTime(&start));
      OK(ForestAdapt(forest, &marks, NULL, 0, NULL, &next, &map));
      OK(PetscTime(&end));
      adapt = pass == passes - 1 ? PetscMin(adapt, end - start) : 1e9;
      OK(PetscTime(&start));
      OK(ForestGetLeafDM(next, &dm, NULL, NULL, NULL));
      OK(PetscTime(&end));
      leaf = pass == passes - 1 ? PetscMin(leaf, end - start) : 1e9;
      OK(ForestMapDestroy(&map));
      if (repeat < 9 && pass == passes - 1) OK(ForestDestroy(&next));
    }
    MarksDestroy(&marks);
    OK(ForestDestroy(&forest));
    forest = next;
  }
  if (rank == 0)
    printf("%d-D: %d coarse cells, %d leaves, %d entities: adapt %.2f ms, leaf mesh %.2f ms\n", (int)dim, (int)forest->coarse->mesh.num_cells,
           (int)forest->tables.num_leaves, (int)forest->tables.num_entities, 1e3 * adapt, 1e3 * leaf);
  OK(ForestDestroy(&forest));
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  Run(2, (const PetscInt[3]){20, 10, 1}, 4, 7.0);
  Run(3, (const PetscInt[3]){8, 8, 8}, 3, 5.0);
  PetscCall(PetscFinalize());
  return 0;
}
