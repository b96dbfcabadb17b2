/* What the constraints of contact do not see: a stiff block with few facets carries the multipliers on a fine, soft one whose bottom is waved. All that is
   wrong is that too few means of the gap, or of the slip where it sticks, vanish: the solution minimises the energy over more than it may, and (everything is
   linear and closed) the squared energy norm of its error is exactly twice the energy that is missing, against the same soft mesh under 96 facets. */
#include "../../src/estimate/estimateimpl.h"
#include "patchfixture.h"

#define FINE 48 /* coarse cells side by side: of the soft block, and of the upper one for what is right */

static void CheckSticks(Problem problem)
{
  FrictionFigures friction;

  OK(InterfaceFriction(ProblemInterface(problem), 0, &friction));
  assert_int_equal(friction.slipping, 0);
}

/* Twice the energy under `cells` coarse cells (twice as many facets), and what contact has in the estimate. sticks: the blocks stick to each other, and the
   bottom is moved along, not across. */
static PetscReal TwiceEnergy(PetscInt cells, PetscInt order, PetscBool sticks, PetscReal *contact)
{
  const char *const names[]  = {"E", "nu"};
  const PetscReal   values[] = {1e4, 0.3};
  const PetscInt    along    = sticks ? 0 : 1;
  MaterialSpec      stiff    = {.law = MaterialLawFind("neo_hookean"), .name = "stiff"};
  Patch             p;
  int8_t           *orders;
  Estimate          e;

  PatchScene(&p, order, MODEL_PLANE_STRAIN, KINEMATICS_SMALL, FORMULATION_DISPLACEMENT);
  OK(MaterialSetUp(&stiff, 2, names, values));
  p.bodies[1].material        = &stiff;
  p.boundaries[BOTTOM].fix[1] = sticks;
  if (sticks) {
    p.contact.law = CONTACT_COULOMB;
    OK(ExpressionCreate("friction", "1000", &p.contact.friction));
  }
  OK(ExpressionCreate("bottom", sticks ? "0.02*sin(3.141592653589793*X)" : "0.02*cos(3.141592653589793*X)", &p.boundaries[BOTTOM].displacement[along]));
  p.forest = PatchForest((const PetscInt[2]){FINE, cells});
  OK(ProblemInitialOrders(&p.data, p.forest, &orders));
  PatchProblem(&p.data, p.forest, orders, &p.problem, &p.state);
  OK(StateKeepOrigin(p.problem, &p.state));
  PatchSolve(p.problem, &p.state);
  if (sticks) CheckSticks(p.problem);
  OK(EstimateCompute(p.problem, &p.state, &e));
  const PetscReal square = PetscSqr(e.norm);
  *contact               = e.part[PART_CONTACT];
  OK(EstimateDestroy(&e));
  OK(ExpressionDestroy(&p.contact.friction));
  OK(ExpressionDestroy(&p.boundaries[BOTTOM].displacement[along]));
  OK(PetscFree(orders));
  PatchDestroy(&p);
  return square;
}

/* With up to `most` cells: with more the soft mesh's own errors are told. */
static void Check(PetscBool sticks, PetscInt most)
{
  for (PetscInt order = 2; order <= 3; ++order) {
    PetscReal       contact;
    const PetscReal right = TwiceEnergy(FINE, order, sticks, &contact);
    for (PetscInt cells = 2; cells <= most; cells *= 2) {
      const PetscReal error = PetscSqrtReal(right - TwiceEnergy(cells, order, sticks, &contact)), ratio = PetscSqrtReal(contact) / error;
      printf("%s, order %d, %d facets: error %.3e of %.3e, told %.2f of it\n", sticks ? "slip" : "gap", (int)order, (int)(2 * cells), (double)error,
             (double)PetscSqrtReal(right), (double)ratio);
      assert_true(ratio > 0.3 && ratio < 3);
    }
  }
}

static void Gap(void **state)
{
  Check(PETSC_FALSE, 8);
}

static void Slip(void **state)
{
  Check(PETSC_TRUE, 4);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Gap), cmocka_unit_test(Slip)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
