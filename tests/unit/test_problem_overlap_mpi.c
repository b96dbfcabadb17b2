/* Overlap at the start: how deep it is; with all of it left nothing touches, with a share the rest counts; with none the problem is what it was. The blocks of
   the patch, into which the nodes of the upper one's face that are none of the lower one's reach down. */
#include "patchfixture.h"

#define DEPTH 0.01

static void Create(Patch *p, Vec *x)
{
  const PetscInt  n[2] = {3, 4};
  const HPTables *v;
  PetscReal      *u;

  PatchScene(p, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_AUTO);
  p->forest = PatchForest(n);
  PatchStart(p);
  v = HPSpaceGetTables(ProblemSpace(p->problem));
  OK(ProblemCreateVector(p->problem, x));
  OK(VecSet(*x, 0));
  OK(PetscCalloc1(2 * v->num_nodes, &u));
  for (PetscInt i = 0; i < v->num_nodes; ++i) {
    const PetscReal *X = v->X + 3 * i, place = 6 * X[0]; /* the lower face has nodes at sixths */
    if (fabs(X[1] - 1) < 1e-9 && fabs(place - round(place)) > 1e-3) u[2 * i + 1] = -DEPTH;
  }
  OK(ProblemSetDisplacement(p->problem, u, *x));
  OK(PetscFree(u));
}

static PetscReal LeastGap(Patch *p, Vec x, PetscReal share)
{
  const ContactView *view;
  ProblemStatus      status;
  Interface          interface = ProblemInterface(p->problem);
  Vec                r;

  OK(VecDuplicate(x, &r));
  ProblemLeaveOverlap(p->problem, share);
  OK(ProblemSearch(p->problem, x));
  OK(ProblemResidual(p->problem, x, NULL, r, &status));
  view = InterfaceGetContact(interface, 0);
  OK(VecDestroy(&r));
  return view->min_gap;
}

static void SharesCount(void **state)
{
  Patch     p;
  Vec       x;
  PetscReal deepest;

  Create(&p, &x);
  const PetscReal whole = LeastGap(&p, x, 0);
  OK(ProblemNoteOverlap(p.problem, x, &deepest));
  assert_true(whole < -0.1 * DEPTH);
  assert_float_equal(deepest, -whole, 1e-12);
  assert_true(LeastGap(&p, x, 1) > -1e-3 * DEPTH);
  assert_in_range((int)(1000 * LeastGap(&p, x, 0.25) / whole), 700, 760);
  assert_float_equal(LeastGap(&p, x, 0), whole, 1e-14);
  OK(VecDestroy(&x));
  PatchDestroy(&p);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(SharesCount)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
