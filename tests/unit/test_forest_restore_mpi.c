/* A forest made from the list of splits of another has the same leaves with the same numbers and entities, whatever splits, merges and closures led there; it
   can be adapted further alike. The hash of the coarse mesh knows each of its parts. */
#include "forest_box.h"

static void SameTables(const ForestTables *a, const ForestTables *b)
{
  assert_int_equal(a->num_leaves, b->num_leaves);
  assert_memory_equal(a->leaf_root, b->leaf_root, sizeof(PetscInt) * (size_t)a->num_leaves);
  assert_memory_equal(a->leaf_lo, b->leaf_lo, sizeof(PetscInt) * 3 * (size_t)a->num_leaves);
  assert_memory_equal(a->leaf_level, b->leaf_level, 3 * (size_t)a->num_leaves);
  assert_int_equal(a->num_entities, b->num_entities);
  const PetscInt last = a->num_entities - 1, size = a->closure_offset[last] + ForestPow3[a->dim];
  assert_memory_equal(a->closure_offset, b->closure_offset, sizeof(PetscInt) * (size_t)a->num_entities);
  assert_memory_equal(a->closure, b->closure, sizeof(PetscInt) * (size_t)size);
  assert_memory_equal(a->orientation, b->orientation, (size_t)size);
  assert_memory_equal(a->parent, b->parent, sizeof(PetscInt) * (size_t)a->num_entities);
}

/* Restore with the owners turned round, then adapt both alike. */
static void Restored(Forest *forest, PetscInt round)
{
  const ForestTables *t, *u;
  Forest              other;
  PetscMPIInt         size, *owner;
  PetscInt            num;
  int8_t             *split;

  t = ForestGetTables(*forest);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  OK(PetscMalloc1(t->num_leaves, &owner));
  for (PetscInt l = 0; l < t->num_leaves; ++l) owner[l] = size - 1 - t->leaf_rank[l];
  OK(ForestGetSplits(*forest, &num, &split));
  OK(ForestRestore(*forest, num, split, t->revision, t->num_leaves, round % 2 ? owner : NULL, NULL, &other));
  OK(PetscFree(split));
  u = ForestGetTables(other);
  SameTables(t, u);
  assert_int_equal(t->revision, u->revision);
  if (round % 2) assert_memory_equal(u->leaf_rank, owner, sizeof(PetscMPIInt) * (size_t)t->num_leaves);
  OK(PetscFree(owner));
  for (PetscInt k = 0; k < 2; ++k) {
    MarkList       marks, same;
    const PetscInt dim = t->dim, n = t->num_leaves;
    BoxRandomMarks(dim, n, 4, PETSC_TRUE, &marks);
    OK(PetscMalloc1(n, &same.split));
    OK(PetscMalloc1(n, &same.coarsen));
    OK(PetscArraycpy(same.split, marks.split, n));
    OK(PetscArraycpy(same.coarsen, marks.coarsen, n));
    AdaptBy(forest, &marks);
    AdaptBy(&other, &same);
    t = ForestGetTables(*forest);
    u = ForestGetTables(other);
    SameTables(t, u);
  }
  OK(ForestDestroy(&other));
}

static void Random(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    Box    box;
    Forest forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 2, dim == 3 ? 2 : 1}, 2, 1, 7, &box);
    for (PetscInt round = 0; round < 2; ++round) Restored(&forest, round);
    OK(ForestDestroy(&forest));
  }
}

static void Hash(void **state)
{
  Box        box;
  Forest     forest = BoxForest(PETSC_COMM_WORLD, 3, (const PetscInt[3]){2, 1, 2}, 2, 0, 7, &box);
  Coarse    *c      = forest->coarse;
  uint64_t   hash, other;
  MarkList   marks;
  PetscReal *x    = &c->mesh.cell_geometry[3 * 40 + 1];
  PetscInt  *body = &c->mesh.cell_body[3], *vertex = &c->mesh.cell_vertices[17];

  OK(ForestCoarseHash(forest, &hash));
  BoxRandomMarks(3, forest->tables.num_leaves, 2, PETSC_TRUE, &marks);
  AdaptBy(&forest, &marks); /* another forest on the same coarse mesh */
  OK(ForestCoarseHash(forest, &other));
  assert_true(hash == other);
  *x += 1e-15 + 1e-15 * PetscAbsReal(*x);
  OK(ForestCoarseHash(forest, &other));
  assert_true(hash != other);
  hash = other;
  ++*body;
  OK(ForestCoarseHash(forest, &other));
  assert_true(hash != other);
  hash = other;
  ++*vertex;
  OK(ForestCoarseHash(forest, &other));
  assert_true(hash != other);
  hash = other;
  c->facet_groups[2] ^= 4;
  OK(ForestCoarseHash(forest, &other));
  assert_true(hash != other);
  hash = other;
  c->mesh.boundary_name[1][0] ^= 1;
  OK(ForestCoarseHash(forest, &other));
  assert_true(hash != other);
  OK(ForestDestroy(&forest));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Random), cmocka_unit_test(Hash)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
