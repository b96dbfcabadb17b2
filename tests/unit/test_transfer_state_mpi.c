/* A whole state between two live problems: the contact patch carried over to a refined, coarsened, repartitioned mesh is in equilibrium there without a
   further iteration (displacements, element pressures and multipliers, 1e-9 of the nodal forces), and multipliers that vary linearly arrive as they were. */
#include "diagnose.h"
#include "patchfixture.h"
#include "transfer.h"

static void Equilibrium(void **state)
{
  for (PetscInt kind = 0; kind < 4; ++kind) {
    Patch         p;
    int8_t       *orders;
    ProblemStatus status;
    Vec           r;
    PetscReal     norm;
    PatchScene(&p, 1 + kind % 2, kind == 3 ? MODEL_AXISYMMETRIC : MODEL_PLANE_STRAIN, KINEMATICS_FINITE,
               kind >= 2 ? FORMULATION_MIXED : FORMULATION_DISPLACEMENT);
    p.forest = PatchForest((const PetscInt[2]){3, 5});
    OK(ProblemInitialOrders(&p.data, p.forest, &orders));
    PatchProblem(&p.data, p.forest, orders, &p.problem, &p.state);
    OK(PetscFree(orders));
    PatchSolve(p.problem, &p.state);
    for (PetscInt step = 0; step < 4; ++step) {
      PatchMove(&p, 3, (PetscBool)(step % 2), PETSC_FALSE);
      OK(ProblemCreateVector(p.problem, &r));
      OK(ProblemSearch(p.problem, p.state.x));
      OK(ProblemResidual(p.problem, p.state.x, NULL, r, &status));
      OK(VecNorm(r, NORM_INFINITY, &norm));
      assert_true(status.scale > 1e-3);
      assert_near(norm, 0, 1e-9 * status.scale);
      for (PetscInt i = 0; i < p.state.num_pressure; i += kind == 2 ? 1 : 3) { /* order 1: the constants; order 2: constant, then gradients */
        assert_near(p.state.pressure[i], -0.05 * p.material.kappa, 1e-9);
        for (PetscInt k = 1; kind == 3 && k < 3; ++k) assert_near(p.state.pressure[i + k], 0, 1e-9);
      }
      OK(VecDestroy(&r));
    }
    PatchDestroy(&p);
  }
}

/* The same with orders that rise at random, from cell to cell: 1 .. 5. */
static void RaisedOrders(void **state)
{
  for (PetscInt kind = 0; kind < 4; ++kind) {
    Patch    p;
    int8_t  *orders;
    PetscInt highest = 0;
    PatchScene(&p, 1, kind % 2 ? MODEL_AXISYMMETRIC : MODEL_PLANE_STRAIN, KINEMATICS_FINITE, kind >= 2 ? FORMULATION_MIXED : FORMULATION_DISPLACEMENT);
    p.forest = PatchForest((const PetscInt[2]){3, 5});
    OK(ProblemInitialOrders(&p.data, p.forest, &orders));
    PatchProblem(&p.data, p.forest, orders, &p.problem, &p.state);
    OK(PetscFree(orders));
    PatchSolve(p.problem, &p.state);
    for (PetscInt step = 0; step < 4; ++step) {
      ProblemStatus status;
      Vec           r;
      PetscReal     norm;
      PatchMove(&p, 3, (PetscBool)(step % 2), PETSC_TRUE);
      OK(ProblemCreateVector(p.problem, &r));
      OK(ProblemSearch(p.problem, p.state.x));
      OK(ProblemResidual(p.problem, p.state.x, NULL, r, &status));
      OK(VecNorm(r, NORM_INFINITY, &norm));
      assert_true(status.scale > 1e-3);
      assert_near(norm, 0, 1e-9 * status.scale);
      OK(VecDestroy(&r));
    }
    for (PetscInt l = 0; l < p.state.num_leaves; ++l) highest = PetscMax(highest, p.state.leaf_order[l]);
    assert_true(highest >= 3);
    PatchDestroy(&p);
  }
}

static void LinearMultipliers(void **state)
{
  Patch              p;
  int8_t            *orders;
  const ContactView *view;
  PetscReal         *z;
  ProblemStatus      status;
  Vec                r;

  PatchScene(&p, 1, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
  p.forest = PatchForest((const PetscInt[2]){3, 5});
  OK(ProblemInitialOrders(&p.data, p.forest, &orders));
  PatchProblem(&p.data, p.forest, orders, &p.problem, &p.state);
  OK(PetscFree(orders));
  PatchSolve(p.problem, &p.state);
  view = InterfaceGetContact(ProblemInterface(p.problem), 0);
  OK(PetscMalloc1(view->nonmortar.num_nodes, &z));
  for (PetscInt n = 0; n < view->nonmortar.num_nodes; ++n) z[n] = 0.1 + 0.03 * view->nonmortar.X[2 * n];
  OK(InterfaceSetMultipliers(ProblemInterface(p.problem), 0, z, p.state.x));
  OK(PetscFree(z));
  for (PetscInt step = 0; step < 4; ++step) {
    PatchMove(&p, 3, (PetscBool)(step % 2), PETSC_FALSE);
    OK(ProblemCreateVector(p.problem, &r));
    OK(ProblemSearch(p.problem, p.state.x));
    OK(ProblemResidual(p.problem, p.state.x, NULL, r, &status));
    OK(VecDestroy(&r));
    OK(InterfaceGatherContactToAll(ProblemInterface(p.problem), 0, &view));
    for (PetscInt n = 0; n < view->nonmortar.num_nodes; ++n) assert_near(view->z[n], 0.1 + 0.03 * view->nonmortar.X[2 * n], 1e-13);
  }
  PatchDestroy(&p);
}

/* No cell is folded at rest; all are in their mirror image. */
static void FoldedCells(void **state)
{
  const ForestTables *t;
  const HPTables     *v;
  Patch               p;
  PetscReal          *u;
  int8_t             *orders, *leaf;
  Folded              folded;

  PatchScene(&p, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
  p.forest = PatchForest((const PetscInt[2]){3, 5});
  OK(ProblemInitialOrders(&p.data, p.forest, &orders));
  PatchProblem(&p.data, p.forest, orders, &p.problem, &p.state);
  OK(PetscFree(orders));
  t = ForestGetTables(p.forest);
  v = HPSpaceGetTables(ProblemSpace(p.problem));
  OK(PetscMalloc1(t->num_leaves, &leaf));
  OK(PetscMalloc1(v->num_nodes * 2, &u));
  OK(FoldedFind(p.problem, p.state.x, &folded, leaf));
  assert_true(folded.num == 0 && PetscAbsReal(folded.det - 1) < 1e-12);
  for (PetscInt l = 0; l < t->num_leaves; ++l) assert_true(leaf[l] == 0);
  for (PetscInt i = 0; i < 2 * v->num_nodes; ++i) u[i] = i % 2 ? 0 : -2 * v->X[3 * (i / 2)];
  OK(ProblemSetDisplacement(p.problem, u, p.state.x));
  OK(FoldedFind(p.problem, p.state.x, &folded, leaf));
  assert_true(folded.num == t->num_leaves && folded.det <= -1 + 1e-12); /* supports hold some nodes where they are */
  for (PetscInt l = 0; l < t->num_leaves; ++l) assert_true(leaf[l] == 1);
  OK(PetscFree(u));
  OK(PetscFree(leaf));
  PatchDestroy(&p);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(FoldedCells), cmocka_unit_test(Equilibrium), cmocka_unit_test(RaisedOrders),
                                     cmocka_unit_test(LinearMultipliers)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
