/* Vertices of linear contact faces before cells of order 2 move when the faces are split or merged: closer to the curve (test_hp_surface.c), by c h^2 / 8. A
   displacement that is affine in space stays what it is, and goes with them. */
#include "stripfixture.h"
#include "transferimpl.h"

static void Affine(const PetscReal X[3], PetscReal u[2])
{
  u[0] = 0.1 + 0.3 * X[0] - 0.2 * X[1];
  u[1] = -0.2 + 0.15 * X[0] - 0.4 * X[1];
}

static HPSpace Space(Forest forest)
{
  const ForestTables *t;
  const HPTables     *v;
  HPSpace             space;
  int8_t             *orders, *fixed;

  t = ForestGetTables(forest);
  OK(PetscMalloc1(t->num_leaves, &orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) orders[l] = 2;
  OK(HPSpaceCreate(forest, orders, NULL, 1, 0, &space));
  v = HPSpaceGetTables(space);
  OK(PetscCalloc1(v->num_nodes, &fixed));
  OK(HPSpaceSetUp(space, fixed, 0, NULL, NULL));
  OK(PetscFree(fixed));
  OK(PetscFree(orders));
  return space;
}

/* From one mesh to another; largest error at true nodes. */
static PetscReal Carry(HPSpace from, HPSpace to, const ForestMap *map)
{
  TransferContext     c = {.old_space = from, .new_space = to, .map = map};
  const ForestTables *t;
  const HPTables     *v;
  Forest              forest;
  OldCells            old;
  PetscReal          *u, *moved, exact[2], error = 0;

  v = HPSpaceGetTables(from);
  OK(PetscCalloc1(2 * v->num_nodes, &u));
  for (PetscInt n = 0; n < v->num_nodes; ++n) Affine(v->X + 3 * n, u + 2 * n);
  OK(TransferContextSetUp_Private(&c));
  OK(OldCellsFetch_Private(&c, &(OldFields){.u = u}, &old));
  v      = HPSpaceGetTables(to);
  forest = HPSpaceGetForest(to);
  t      = ForestGetTables(forest);
  OK(PetscCalloc1(2 * v->num_nodes, &moved));
  OK(TransferDisplacement_Private(&c, &old, moved));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    Affine(v->X + 3 * n, exact);
    for (PetscInt d = 0; d < 2 && t->parent[v->node_entity[n]] < 0; ++d) error = PetscMax(error, PetscAbsReal(moved[2 * n + d] - exact[d]));
  }
  OK(OldCellsDestroy_Private(&old));
  OK(PetscFree(u));
  OK(PetscFree(moved));
  return error;
}

/* How far the corners of the old mesh have moved, at most. */
static PetscReal Moved(HPSpace from, HPSpace to)
{
  const HPTables *a, *b;
  PetscReal       far = 0;

  a = HPSpaceGetTables(from);
  b = HPSpaceGetTables(to);
  for (PetscInt n = 0; n < a->num_nodes; ++n) {
    for (PetscInt m = 0; m < b->num_nodes; ++m) {
      const PetscReal x = a->X[3 * n] - b->X[3 * m], y = a->X[3 * n + 1] - b->X[3 * m + 1];
      if (PetscAbsReal(x) < 1e-12 && PetscAbsReal(y) < 0.02) far = PetscMax(far, PetscAbsReal(y));
    }
  }
  return far;
}

static void AffineStaysAffine(void **state)
{
  Forest    coarse = Strip(), fine;
  ForestMap map;
  MarkList  marks;

  OK(PetscCalloc1(NUM, &marks.split));
  OK(PetscCalloc1(NUM, &marks.coarsen));
  for (PetscInt l = 0; l < NUM; ++l) marks.split[l] = (int8_t)(l == 1 || l == 2 || l == 5 ? 3 : 0);
  OK(ForestAdapt(coarse, &marks, NULL, 0, NULL, &fine, &map));
  MarksDestroy(&marks);
  HPSpace from = Space(coarse), to = Space(fine);
  assert_true(Moved(from, to) > 0.5 * CURVE * width * width / 8);
  assert_true(Carry(from, to, &map) < 1e-13);
  OK(ForestMapDestroy(&map));
  OK(HPSpaceDestroy(&from));
  OK(ForestDestroy(&coarse));

  const ForestTables *t;
  t = ForestGetTables(fine);
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscMalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) marks.coarsen[l] = 1;
  OK(ForestAdapt(fine, &marks, NULL, 0, NULL, &coarse, &map));
  MarksDestroy(&marks);
  HPSpace back = Space(coarse);
  assert_int_equal(map.num, NUM);
  assert_true(Carry(to, back, &map) < 1e-13);
  OK(ForestMapDestroy(&map));
  OK(HPSpaceDestroy(&to));
  OK(HPSpaceDestroy(&back));
  OK(ForestDestroy(&fine));
  OK(ForestDestroy(&coarse));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(AffineStaysAffine)};
  int                     failed;

  if (PetscInitializeNoArguments()) return 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
