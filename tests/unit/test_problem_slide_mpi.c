/* Does contact move along, so that bodies are to be carried first? The left half of a pair comes into contact, its right half is open but has pressures: where
   they are real, contact moves; where they are the round-off of open nodes, wherever in the zone that comes, it does not. E = 1. */
#include "patchfixture.h"

#define DEEP 0.01

/* The upper block, turned about the middle of its bottom: DEEP into the lower one at the left, as far off it at the right. */
static void Turn(const Patch *p, const ContactView *view)
{
  const HPTables *v;
  PetscReal      *u;

  v = HPSpaceGetTables(ProblemSpace(p->problem));
  OK(PetscCalloc1(2 * v->num_nodes, &u));
  for (PetscInt j = 0; j < view->nonmortar.num_nodes; ++j) {
    for (PetscInt n = 0; n < v->num_nodes; ++n)
      if (v->node_entity[n] == view->nonmortar.node_entity[j]) u[2 * n + 1] = DEEP * (view->nonmortar.X[2 * j] - 1);
  }
  OK(ProblemSetDisplacement(p->problem, u, p->state.x));
  OK(PetscFree(u));
}

/* Do bodies move where the nodes right of the middle have this pressure? */
static PetscBool Moves(PetscReal pressure)
{
  Patch              p;
  const ContactView *view;
  ProblemStatus      status;
  PetscReal         *z;
  PetscInt           sum[2] = {0, 0}; /* nodes in contact, open ones with pressure */
  uint64_t           pairs;
  Vec                r;

  PatchScene(&p, 1, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
  p.forest = PatchForest((const PetscInt[2]){7, 5});
  PatchStart(&p);
  view = InterfaceGetContact(ProblemInterface(p.problem), 0);
  Turn(&p, view);
  OK(PetscCalloc1(view->nonmortar.num_nodes, &z));
  for (PetscInt j = 0; j < view->nonmortar.num_nodes; ++j) z[j] = view->nonmortar.X[2 * j] > 1 + 1e-9 ? pressure : 0;
  OK(InterfaceSetMultipliers(ProblemInterface(p.problem), 0, z, p.state.x));
  OK(ProblemCreateVector(p.problem, &r));
  PatchEvaluate(p.problem, p.state.x, r, &status);
  for (PetscInt j = 0; j < view->nonmortar.num_nodes; ++j) {
    if (!view->nonmortar.owned[j]) continue;
    sum[0] += view->active[j];
    sum[1] += z[j] > 0 && !view->active[j];
  }
  assert_int_equal(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD), 0);
  assert_true(sum[0] > 0 && sum[1] > 0);
  PetscReal pending;
  OK(ProblemPending(p.problem, &pending));
  OK(InterfaceFindSliding(ProblemInterface(p.problem), pending, PETSC_FALSE, &pairs));
  OK(VecDestroy(&r));
  OK(PetscFree(z));
  PatchDestroy(&p);
  return (PetscBool)(pairs != 0);
}

static void RoundOffDecidesNothing(void **unused)
{
  assert_true(Moves(1e-4));
  assert_false(Moves(1e-16));
  assert_false(Moves(1e-21));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(RoundOffDecidesNothing)};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || ErrorHandlerPush()) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
