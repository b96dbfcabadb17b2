/* A mortar node on, or within rounding of, a nonmortar node's ray: derivatives stay finite, forces stay continuous and balanced across the snap. */
#include "contactfixture.h"

enum { NN = 5, NM = 6 };

/* Curved pair; mortar node 3 stands exactly on nonmortar node 2's ray (in its own construction), then moves by `offset` along x. */
static void OnRay(PetscReal offset, Chain *nonmortar, Chain *mortar)
{
  const PetscReal *n;
  ContactPair      pair;
  Sum              s;
  uint64_t         rng = 4242;

  RandomPair(&rng, NN, NM, 0.03, nonmortar, mortar);
  EvaluateOnce(nonmortar, mortar, PETSC_FALSE, PETSC_FALSE, 0.5, NULL, &pair, &s);
  n = ContactPairGetNormals(pair);
  for (int i = 0; i < 2; i++) mortar->x[6 + i] = nonmortar->x[4 + i] + 0.05 * n[4 + i];
  mortar->x[6] += offset;
  CHECK_CALL(ContactPairDestroy(&pair));
  SumDestroy(&s);
}

static void Evaluate(PetscReal offset, Sum *s, PetscInt *segments)
{
  const PetscReal       z[NN] = {1, 0.7, 2, 1.5, 0.3};
  const ContactSegment *seg;
  Chain                 nonmortar, mortar;
  ContactPair           pair;

  OnRay(offset, &nonmortar, &mortar);
  EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 0.5, z, &pair, s);
  ContactPairGetSegments(pair, segments, &seg);
  CHECK_CALL(ContactPairDestroy(&pair));
  ChainDestroy(&nonmortar);
  ChainDestroy(&mortar);
}

static void Continuous(void **state)
{
  const PetscReal offset[] = {1e-16, 1e-13, 1e-12, 1e-11, 9e-11, 1.1e-10, 1e-10, 3e-10, 1e-9, 3e-9};
  Sum             at;
  PetscInt        num, least = 100, most = 0;
  PetscReal       worst = 0, size = 0;

  Evaluate(0, &at, &num);
  for (PetscInt i = 0; i < at.size; i++) size = PetscMax(size, PetscAbsReal(at.gradient[i]));
  for (int k = 0; k < 2 * (int)(sizeof(offset) / sizeof(offset[0])); k++) {
    Sum       s;
    PetscReal f[2] = {0, 0};

    Evaluate((k % 2 ? -1 : 1) * offset[k / 2], &s, &num);
    least = PetscMin(least, num);
    most  = PetscMax(most, num);
    for (PetscInt i = 0; i < s.size; i++) {
      worst = PetscMax(worst, PetscAbsReal(s.gradient[i] - at.gradient[i]) / size);
      f[i % 2] += s.gradient[i];
      assert_false(PetscIsInfOrNanReal(s.gradient[i]));
    }
    for (PetscInt i = 0; i < s.size * s.size; i++) assert_true(PetscAbsReal(s.hessian[i]) < 1e3);
    assert_true(hypot(f[0], f[1]) < 1e-13 * size);
    SumDestroy(&s);
  }
  print_message("mortar node 1e-16 .. 3e-9 from the ray: gradient moves by %.1e, %d to %d segments\n", worst, (int)least, (int)most);
  assert_true(worst < 1e-8);
  assert_true(most > least); /* the range really crosses the snap */
  SumDestroy(&at);
}

/* Without the mark "fixed" on snapped bounds the fluxes psi g dlambda of the neighbours would not cancel: the derivative of S along the mortar node's
   motion must match the difference quotient over the snap. */
static void SnapIsConsistent(void **state)
{
  const PetscReal h = 1e-7; /* the Hessian jumps at the ray: error h times the jump */
  Sum             minus, at, plus;
  PetscInt        num;

  Evaluate(-h, &minus, &num);
  Evaluate(0, &at, &num);
  Evaluate(h, &plus, &num);
  assert_near((plus.S - minus.S) / (2 * h), at.gradient[2 * NN + 6], 5e-8);
  SumDestroy(&minus);
  SumDestroy(&at);
  SumDestroy(&plus);
}

CONTACT_TEST_MAIN("contact: slivers", cmocka_unit_test(Continuous), cmocka_unit_test(SnapIsConsistent))
