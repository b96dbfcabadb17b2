/* Contact terms of the estimate: none on the contact patch (both sides' tractions are z n times the stretch, meshes do not match, one of them has hanging
   nodes); exactly scale h/(p m) d^2 area on both sides when the multiplier is off by d; the complementarity of a gap under pressure. */
#include "estimate.h"
#include "patchfixture.h"

static void NoResidual(void **state)
{
  for (PetscInt kind = 0; kind < 5; ++kind) {
    const Model       model[]       = {MODEL_PLANE_STRAIN, MODEL_PLANE_STRAIN, MODEL_AXISYMMETRIC, MODEL_PLANE_STRAIN, MODEL_AXISYMMETRIC};
    const Kinematics  kinematics[]  = {KINEMATICS_FINITE, KINEMATICS_FINITE, KINEMATICS_FINITE, KINEMATICS_SMALL, KINEMATICS_FINITE};
    const Formulation formulation[] = {FORMULATION_DISPLACEMENT, FORMULATION_MIXED, FORMULATION_DISPLACEMENT, FORMULATION_DISPLACEMENT, FORMULATION_MIXED};
    Patch             p;
    Forest            adapted;
    ForestMap         map;
    int8_t           *orders;
    Estimate          e;
    PatchScene(&p, 1 + kind % 2, model[kind], kinematics[kind], formulation[kind]);
    p.forest = PatchForest((const PetscInt[2]){3, 5});
    PatchAdapt(p.forest, 3, PETSC_FALSE, &adapted, &map);
    OK(ForestMapDestroy(&map));
    OK(ForestDestroy(&p.forest));
    p.forest = adapted;
    OK(ProblemInitialOrders(&p.data, p.forest, &orders));
    PatchProblem(&p.data, p.forest, orders, &p.problem, &p.state);
    PatchSolve(p.problem, &p.state);
    OK(EstimateCompute(p.problem, &p.state, &e));
    assert_true(e.norm > 0.05);
    if (!(e.total < 1e-7 * e.norm)) /* z g of a gap of round-off: the root of 1e-16 */
      fail_msg("kind %d: %g of %g, shares %g %g %g %g %g", (int)kind, (double)e.total, (double)e.norm, (double)e.part[0], (double)e.part[1], (double)e.part[2],
               (double)e.part[3], (double)e.part[4]);
    OK(EstimateDestroy(&e));
    OK(PetscFree(orders));
    PatchDestroy(&p);
  }
}

/* All z raised by d: scale h/(p m) d^2 times the area, on either side; h = 1/2, p = 1; no complementarity, for the gap stays 0. m = sqrt(mu (kappa + 4/3 mu)).
   Plane strain: area 2, axisymmetric: 2 pi int_0^2 R dR = 4 pi. */
static void WrongPressure(void **state)
{
  for (PetscInt axisymmetric = 0; axisymmetric < 2; ++axisymmetric) {
    const PetscReal    d = 0.07;
    Patch              p;
    int8_t            *orders;
    Estimate           e;
    const ContactView *view;
    PetscReal         *z;
    PatchScene(&p, 1, axisymmetric ? MODEL_AXISYMMETRIC : MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
    p.forest = PatchForest((const PetscInt[2]){3, 5});
    OK(ProblemInitialOrders(&p.data, p.forest, &orders));
    PatchProblem(&p.data, p.forest, orders, &p.problem, &p.state);
    PatchSolve(p.problem, &p.state);
    view = InterfaceGetContact(ProblemInterface(p.problem), 0);
    OK(PetscMalloc1(view->nonmortar.num_nodes, &z));
    for (PetscInt n = 0; n < view->nonmortar.num_nodes; ++n) z[n] = view->z[n] + d;
    OK(InterfaceSetMultipliers(ProblemInterface(p.problem), 0, z, p.state.x));
    OK(EstimateCompute(p.problem, &p.state, &e));
    const PetscReal mu = p.material.mu, modulus = PetscSqrtReal(mu * (p.material.kappa + 4 * mu / 3)),
                    expected = 1. / 6 * 0.5 / modulus * d * d * 2 * (axisymmetric ? 4 * PETSC_PI : 2);
    assert_near(e.part[3], expected, 1e-9 * expected);
    assert_near(PetscSqr(e.total), expected, 1e-9 * expected);
    OK(EstimateDestroy(&e));
    OK(PetscFree(z));
    OK(PetscFree(orders));
    PatchDestroy(&p);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NoResidual), cmocka_unit_test(WrongPressure)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
