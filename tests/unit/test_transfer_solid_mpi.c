/* States between live problems of contact in three dimensions: the patch carried over to refined, coarsened, repartitioned meshes with hanging nodes is in
   equilibrium there, bilinear multipliers arrive as they were, and a node whose multiplier was removed takes its neighbours' value. */
#include "solidpatch.h"
#include "transferimpl.h"

static void Equilibrium(void **state)
{
  for (PetscInt order = 1; order <= 2; ++order) {
    Patch         p;
    ProblemStatus status;
    Vec           r;
    PetscReal     norm;
    PatchScene(&p, order, KINEMATICS_FINITE, PETSC_FALSE, "-0.1");
    p.forest = PatchForest(2, 3);
    PatchStart(&p);
    PatchSolve(p.problem, &p.state);
    for (PetscInt step = 0; step < 3; ++step) {
      PatchMove(&p, step % 2 ? 20 : 8, (PetscBool)(step % 2), PETSC_FALSE);
      OK(ProblemCreateVector(p.problem, &r));
      PatchEvaluate(p.problem, p.state.x, r, &status);
      OK(VecNorm(r, NORM_INFINITY, &norm));
      assert_true(status.scale > 1e-3);
      assert_near(norm, 0, 1e-9 * status.scale);
      OK(VecDestroy(&r));
    }
    PatchDestroy(&p);
  }
}

static PetscReal Field(const PetscReal X[3])
{
  return 0.1 + 0.03 * X[0] - 0.02 * X[1] + 0.05 * X[0] * X[1];
}

static void BilinearMultipliers(void **state)
{
  Patch              p;
  const ContactView *view;
  PetscReal         *z;
  ProblemStatus      status;
  Vec                r;
  PetscInt           hanging = 0;

  PatchScene(&p, 1, KINEMATICS_FINITE, PETSC_FALSE, "0");
  p.forest = PatchForest(2, 3);
  PatchRefine(&p.forest, 2);
  PatchStart(&p);
  view = InterfaceGetContact(ProblemInterface(p.problem), 0);
  OK(PetscMalloc1(view->nonmortar.num_nodes, &z));
  for (PetscInt n = 0; n < view->nonmortar.num_nodes; ++n) z[n] = Field(view->nonmortar.X + 3 * n);
  OK(InterfaceSetMultipliers(ProblemInterface(p.problem), 0, z, p.state.x));
  OK(PetscFree(z));
  OK(ProblemSearch(p.problem, p.state.x));
  for (PetscInt step = 0; step < 4; ++step) {
    PatchMove(&p, step % 2 ? 20 : 8, (PetscBool)(step % 2), PETSC_FALSE);
    OK(ProblemCreateVector(p.problem, &r));
    PatchEvaluate(p.problem, p.state.x, r, &status);
    OK(VecDestroy(&r));
    OK(InterfaceGatherContactToAll(ProblemInterface(p.problem), 0, &view));
    hanging += PatchHanging(&view->nonmortar);
    for (PetscInt n = 0; n < view->nonmortar.num_nodes; ++n) assert_near(view->z[n], Field(view->nonmortar.X + 3 * n), 1e-13);
  }
  assert_true(hanging > 0);
  PatchDestroy(&p);
}

/* Without multipliers at x = 0, as a support there would leave them: new nodes in the row of facets beside take the values along the line of the next old
   nodes, and those further on keep theirs. */
static void RemovedMultipliers(void **state)
{
  Patch               p;
  Forest              adapted;
  ForestMap           map;
  Problem             problem;
  State               next;
  int8_t             *orders;
  const ContactView  *from, *to;
  const ForestTables *old_t, *new_t;
  PetscBool          *has;
  PetscReal          *z, *new_z;
  PetscInt            checked = 0;

  PatchScene(&p, 1, KINEMATICS_FINITE, PETSC_FALSE, "0");
  p.forest = PatchForest(2, 3);
  PatchStart(&p);
  PatchAdapt(p.forest, 1, PETSC_FALSE, &adapted, &map);
  OK(TransferOrders(&map, p.state.leaf_order, &orders));
  PatchProblem(&p.data, adapted, orders, &problem, &next);
  from  = InterfaceGetContact(ProblemInterface(p.problem), 0);
  to    = InterfaceGetContact(ProblemInterface(problem), 0);
  old_t = ForestGetTables(p.forest);
  new_t = ForestGetTables(adapted);
  OK(PetscMalloc2(from->nonmortar.num_nodes, &z, from->nonmortar.num_nodes, &has));
  OK(PetscMalloc1(to->nonmortar.num_nodes, &new_z));
  for (PetscInt n = 0; n < from->nonmortar.num_nodes; ++n) {
    const PetscReal *X = from->nonmortar.X + 3 * n;
    has[n]             = (PetscBool)(X[0] > 0.1);
    z[n]               = has[n] ? Field(X) : 0;
  }
  OK(TransferMultiplier_Private(old_t, &from->nonmortar, z, has, new_t, &to->nonmortar, &map, new_z));
  for (PetscInt n = 0; n < to->nonmortar.num_nodes; ++n) {
    if (!to->nonmortar.owned[n]) continue;
    const PetscReal *X = to->nonmortar.X + 3 * n, at[3] = {PetscMax(X[0], 2. / 3), X[1], X[2]};
    checked += X[0] < 0.5;
    assert_near(new_z[n], Field(at), 1e-13);
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &checked, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_int_equal(checked, 14); /* two rows of seven nodes */
  OK(PetscFree2(z, has));
  OK(PetscFree(new_z));
  OK(PetscFree(orders));
  OK(ForestMapDestroy(&map));
  OK(StateDestroy(&next));
  OK(ProblemDestroy(&problem));
  OK(ForestDestroy(&adapted));
  PatchDestroy(&p);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Equilibrium), cmocka_unit_test(BilinearMultipliers), cmocka_unit_test(RemovedMultipliers)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
