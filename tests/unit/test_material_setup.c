/* Which parameters a material takes, what follows from them, and the sentence wrong ones get. */
#include "material.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"
#include <stdio.h>
#include <unistd.h>

#define OK(call) assert_int_equal(call, 0)

static MaterialSpec spec;
static char         said[1024];

/* MaterialSetUp with what it prints caught in `said`. */
static PetscErrorCode Try(const char *law, PetscInt num, const char *const names[], const PetscReal values[])
{
  FILE          *file = tmpfile();
  const int      keep = dup(STDERR_FILENO);
  PetscErrorCode code;
  size_t         length;

  spec.law = MaterialLawFind(law);
  assert_non_null(spec.law);
  fflush(stderr);
  dup2(fileno(file), STDERR_FILENO);
  code = MaterialSetUp(&spec, num, names, values);
  fflush(stderr);
  dup2(keep, STDERR_FILENO);
  close(keep);
  rewind(file);
  length       = fread(said, 1, sizeof(said) - 1, file);
  said[length] = 0;
  fclose(file);
  return code;
}

static int Fresh(void **state)
{
  PetscMemzero(&spec, sizeof(spec));
  PetscStrncpy(spec.name, "rubber", sizeof(spec.name));
  return 0;
}

#define NAMES(...) ((const char *const[]){__VA_ARGS__})
#define VALUES(...) ((const PetscReal[]){__VA_ARGS__})
#define REFUSED(sentence, law, num, names, values)                                                                                                             \
  do {                                                                                                                                                         \
    assert_int_equal(Try(law, num, names, values), MORTISE_ERR_INPUT);                                                                                         \
    assert_string_equal(said, "mortise: material.rubber." sentence "\n");                                                                                      \
  } while (0)

static void PairsAreEquivalent(void **state)
{
  OK(Try("neo_hookean", 2, NAMES("E", "nu"), VALUES(2.8, 0.4)));
  assert_near(spec.mu, 1, 1e-15);
  assert_near(spec.lambda, 4, 1e-14);
  assert_near(spec.kappa, 14. / 3, 1e-14);
  assert_string_equal(said, "");
  OK(Try("neo_hookean", 2, NAMES("kappa", "mu"), VALUES(14. / 3, 1)));
  assert_near(spec.lambda, 4, 1e-14);
  assert_near(spec.parameter[0], 2.8, 1e-14);
  OK(Try("linear", 2, NAMES("mu", "lambda"), VALUES(1, 4)));
  assert_near(spec.kappa, 14. / 3, 1e-14);
  assert_near(spec.parameter[1], 0.4, 1e-15);
  OK(Try("neo_hookean", 2, NAMES("mu", "nu"), VALUES(1, 0.4)));
  assert_near(spec.lambda, 4, 1e-14);
  assert_near(spec.kappa, 14. / 3, 1e-14);
  assert_near(spec.parameter[0], 2.8, 1e-14);
  OK(Try("mooney_rivlin", 3, NAMES("c1", "c2", "kappa"), VALUES(.3, .2, 50)));
  assert_near(spec.mu, 1, 1e-15);
  assert_near(spec.kappa, 50, 0);
  assert_near(spec.log_modulus, 50 - 4 * .3 / 3 - 16 * .2 / 3, 1e-13);
  OK(Try("rigid", 0, NULL, NULL));
  assert_false(spec.mixed);
}

static void MixedIsResolved(void **state)
{
  OK(Try("neo_hookean", 2, NAMES("E", "nu"), VALUES(1, 0.44)));
  assert_false(spec.mixed);
  OK(Try("neo_hookean", 2, NAMES("E", "nu"), VALUES(1, 0.45)));
  assert_true(spec.mixed);
  spec.formulation = FORMULATION_DISPLACEMENT;
  OK(Try("neo_hookean", 2, NAMES("E", "nu"), VALUES(1, 0.49)));
  assert_false(spec.mixed);
  OK(Try("saint_venant_kirchhoff", 2, NAMES("E", "nu"), VALUES(1, 0.49)));
  assert_false(spec.mixed);
  spec.formulation = FORMULATION_MIXED;
  OK(Try("neo_hookean", 2, NAMES("E", "nu"), VALUES(1, 0.1)));
  assert_true(spec.mixed);
}

static void IncompressibleLimit(void **state)
{
  for (int i = 0; i < 5; i++) {
    if (i == 0) OK(Try("neo_hookean", 2, NAMES("E", "nu"), VALUES(3, 0.5)));
    if (i == 1) OK(Try("neo_hookean", 2, NAMES("mu", "kappa"), VALUES(1, INFINITY)));
    if (i == 2) OK(Try("mooney_rivlin", 3, NAMES("c1", "c2", "kappa"), VALUES(0.3, 0.2, INFINITY)));
    if (i == 3) OK(Try("linear", 2, NAMES("E", "nu"), VALUES(3, 0.5)));
    if (i == 4) OK(Try("neo_hookean", 2, NAMES("mu", "nu"), VALUES(1, 0.5)));
    assert_true(spec.incompressible && spec.mixed && PetscIsInfReal(spec.kappa));
    assert_float_equal(spec.mu, 1, 1e-15);
    assert_float_equal(MaterialYoung(&spec), 3, 1e-15);
    if (i < 2) assert_float_equal(spec.parameter[1], 0.5, 0);
  }
  OK(Try("neo_hookean", 2, NAMES("E", "nu"), VALUES(1, 0.4999999)));
  assert_true(spec.mixed && !spec.incompressible);
  spec.formulation = FORMULATION_DISPLACEMENT;
  REFUSED("formulation: displacements alone cannot keep the volume (kappa: inf, nu: 0.5); take mixed, or nu below 0.5", "neo_hookean", 2, NAMES("E", "nu"),
          VALUES(1, 0.5));
  spec.formulation = FORMULATION_AUTO;
  REFUSED("law: saint_venant_kirchhoff has no incompressible limit (nu: 0.5, kappa: inf); take neo_hookean, or nu below 0.5", "saint_venant_kirchhoff", 2,
          NAMES("E", "nu"), VALUES(1, 0.5));
  REFUSED("kappa: the bulk modulus 1e+13 is more than 1e12 times the shear modulus 1, of which round-off leaves nothing; take inf (incompressible)",
          "neo_hookean", 2, NAMES("mu", "kappa"), VALUES(1, 1e13));
  spec.volumetric = VOLUMETRIC_LOG;
  REFUSED("volumetric: log has no incompressible limit (kappa: inf, nu: 0.5); take quadratic or simo", "neo_hookean", 2, NAMES("mu", "kappa"),
          VALUES(1, INFINITY));
}

static void WrongValuesAreRefused(void **state)
{
  REFUSED("E: -1 is not a finite number above 0", "neo_hookean", 2, NAMES("E", "nu"), VALUES(-1, 0.3));
  REFUSED("mu: 0 is not a finite number above 0", "neo_hookean", 2, NAMES("mu", "kappa"), VALUES(0, 1));
  REFUSED("nu: 0.6 is not between -1 and 0.5", "neo_hookean", 2, NAMES("E", "nu"), VALUES(1, 0.6));
  REFUSED("E: inf is not a finite number above 0", "neo_hookean", 2, NAMES("E", "nu"), VALUES(INFINITY, 0.3));
  REFUSED("lambda: inf is not a finite number", "neo_hookean", 2, NAMES("mu", "lambda"), VALUES(1, INFINITY));
  REFUSED("E: nan is not a finite number above 0", "neo_hookean", 2, NAMES("E", "nu"), VALUES((PetscReal)NAN, 0.3));
  REFUSED("lambda: -1 gives the bulk modulus -0.333333, which must be positive", "neo_hookean", 2, NAMES("mu", "lambda"), VALUES(1, -1));
  REFUSED("c1: shear modulus 2 (c1 + c2) = -0.2 must be positive", "mooney_rivlin", 3, NAMES("c1", "c2", "kappa"), VALUES(.1, -.2, 5));
}

static void WrongSetsAreRefused(void **state)
{
  REFUSED("Nu: unknown; nearest known: nu (neo_hookean has E, nu, mu, kappa, lambda)", "neo_hookean", 2, NAMES("E", "Nu"), VALUES(1, 0.3));
  REFUSED("kapa: unknown; nearest known: kappa (mooney_rivlin has c1, c2, kappa)", "mooney_rivlin", 1, NAMES("kapa"), VALUES(1));
  REFUSED("E: the law rigid takes no parameters", "rigid", 1, NAMES("E"), VALUES(1));
  REFUSED("nu: missing; neo_hookean needs E and nu, or mu and nu, kappa or lambda", "neo_hookean", 1, NAMES("E"), VALUES(1));
  REFUSED("E: missing; linear needs E and nu, or mu and nu, kappa or lambda", "linear", 0, NULL, NULL);
  REFUSED("c2: missing; mooney_rivlin needs c1, c2 and kappa", "mooney_rivlin", 2, NAMES("c1", "kappa"), VALUES(1, 2));
  REFUSED("mu: one parameter too many; neo_hookean takes E and nu, or mu and nu, kappa or lambda", "neo_hookean", 3, NAMES("E", "nu", "mu"), VALUES(1, 0.3, 2));
}

static void WrongVariantsAreRefused(void **state)
{
  spec.volumetric = VOLUMETRIC_LOG;
  REFUSED("volumetric: linear has no other volumetric law than quadratic", "linear", 2, NAMES("E", "nu"), VALUES(1, 0.3));
  spec.volumetric = VOLUMETRIC_QUADRATIC;
  REFUSED("formulation: saint_venant_kirchhoff has no mixed form (meant for nu from 0.45 up, here 0.49); set formulation: displacement or take neo_hookean",
          "saint_venant_kirchhoff", 2, NAMES("E", "nu"), VALUES(1, 0.49));
  spec.formulation = FORMULATION_MIXED;
  REFUSED("formulation: saint_venant_kirchhoff has no mixed form (meant for nu from 0.45 up, here 0.3); set formulation: displacement or take neo_hookean",
          "saint_venant_kirchhoff", 2, NAMES("E", "nu"), VALUES(1, 0.3));
  spec.volumetric = VOLUMETRIC_LOG;
  REFUSED("formulation: mixed with volumetric: log needs lambda above 0, which is -0.1", "neo_hookean", 2, NAMES("mu", "lambda"), VALUES(1, -0.1));
  REFUSED("formulation: mixed with volumetric: log needs kappa - 4/3 c1 - 16/3 c2 above 0, which is -1.66667", "mooney_rivlin", 3, NAMES("c1", "c2", "kappa"),
          VALUES(1, 1, 5));
}

#define HGO NAMES("c", "kappa", "k1", "k2")

/* A family's own moduli win over the material's, directions become unit vectors, mu is the ground substance's. */
static void FibresAreSetUp(void **state)
{
  spec.num_fibers = 2;
  spec.fiber[0]   = (MaterialFiber){.name = "a", .straight = PETSC_TRUE, .direction = {0, 3, 4}};
  spec.fiber[1]   = (MaterialFiber){.name = "b", .angle = 29, .k1 = 7};
  OK(Try("hgo", 4, HGO, VALUES(3, 1e5, 2, 0.8)));
  assert_near(spec.fiber[0].direction[1], 0.6, 1e-16);
  assert_near(spec.fiber[0].direction[2], 0.8, 1e-16);
  assert_true(spec.fiber[0].k1 == 2 && spec.fiber[1].k1 == 7 && spec.fiber[1].k2 == 0.8);
  assert_true(spec.mu == 3 && spec.kappa == 1e5 && spec.mixed && spec.parameter[4] == 0);
}

static void WrongFibresAreRefused(void **state)
{
  REFUSED("fiber: missing; hgo needs one to 4 families, fiber: {a: {angle: 29}}", "hgo", 4, HGO, VALUES(3, 1e5, 2, 0.8));
  spec.num_fibers = 1;
  spec.fiber[0]   = (MaterialFiber){.name = "a", .straight = PETSC_TRUE};
  REFUSED("fiber: the law neo_hookean has no fibres; hgo has", "neo_hookean", 2, NAMES("E", "nu"), VALUES(1, 0.3));
  REFUSED("fiber.a.direction: (0, 0, 0) has no direction", "hgo", 4, HGO, VALUES(3, 1e5, 2, 0.8));
  REFUSED("k2: 0 is not a finite number above 0", "hgo", 4, HGO, VALUES(3, 1e5, 2, 0));
  REFUSED("kappa: missing; hgo needs c, kappa, k1 and k2", "hgo", 1, NAMES("c"), VALUES(3));
  REFUSED("c2: -1 is below 0", "hgo", 5, NAMES("c", "kappa", "k1", "k2", "c2"), VALUES(3, 10, 1, 1, -1));
  spec.fiber[0] = (MaterialFiber){.name = "a", .angle = 29};
  REFUSED("fiber.a.k2: missing or not positive; it is given here or as material.rubber.k2 for all families", "hgo", 3, NAMES("c", "kappa", "k1"),
          VALUES(3, 10, 1));
  spec.volumetric = VOLUMETRIC_LOG;
  REFUSED("volumetric: hgo knows quadratic and simo, not log", "hgo", 4, HGO, VALUES(3, 1e5, 2, 0.8));
}

static void TableIsComplete(void **state)
{
  assert_null(MaterialLawFind("neohookean"));
  for (const MaterialLaw *law = MaterialLaws; law->name; law++) {
    assert_ptr_equal(MaterialLawFind(law->name), law);
    assert_non_null(law->help);
    assert_non_null(law->parameters);
    assert_true(law->rigid || law->evaluate);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test_setup(PairsAreEquivalent, Fresh),   cmocka_unit_test_setup(MixedIsResolved, Fresh),
                                     cmocka_unit_test_setup(IncompressibleLimit, Fresh),  cmocka_unit_test_setup(WrongValuesAreRefused, Fresh),
                                     cmocka_unit_test_setup(WrongSetsAreRefused, Fresh),  cmocka_unit_test_setup(WrongVariantsAreRefused, Fresh),
                                     cmocka_unit_test_setup(TableIsComplete, Fresh),      cmocka_unit_test_setup(FibresAreSetUp, Fresh),
                                     cmocka_unit_test_setup(WrongFibresAreRefused, Fresh)};

  if (PetscInitialize(&argc, &argv, NULL, NULL) || ErrorHandlerPush()) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
