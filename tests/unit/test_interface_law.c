/* Contact laws: every word of the scene's key has its row; rows of both forms are derivatives of one residual. */
#include "base.h"
#include "interfaceimpl.h"
#include "sceneimpl.h"

#include <cmocka.h>

#include "near.h"

/* The same order in three places: the table, its enum and the words of the key. */
static void Names(void **state)
{
  char          words[256] = "";
  const Option *o          = Options;

  for (const ContactLawOps *const *law = ContactLaws; *law; ++law) {
    if (words[0]) strcat(words, "|");
    strcat(words, (*law)->name);
  }
  while (strcmp(o->pattern, "contact.<pair>.law")) ++o;
  assert_string_equal(o->range, words);
  assert_string_equal(ContactLaws[CONTACT_FRICTIONLESS]->name, "frictionless");
  assert_string_equal(ContactLaws[CONTACT_PENALTY]->name, "penalty");
  assert_string_equal(ContactLaws[CONTACT_COULOMB]->name, "coulomb");
}

/* A node whose gap, weight and multiplier change with s. */
static ContactPoint At(const ContactSpec *spec, PetscReal open, PetscReal s)
{
  const ContactLawOps *law = ContactLaws[spec->law];
  ContactPoint p = {.spec = spec, .z = {open > 0 ? 0 : 0.7 + 0.3 * s}, .gap = open + 0.2 * s, .weight = 0.4 - 0.1 * s, .spring = 0.05, .w0 = 0.5, .c = 3};

  p.state = law->state(&p);
  return p;
}

static PetscReal Residual(const ContactSpec *spec, PetscReal open, PetscReal s)
{
  const ContactPoint p = At(spec, open, s);
  ContactRow         row;

  ContactLaws[spec->law]->rows(&p, PETSC_FALSE, &row);
  return -row.side;
}

static void Derivatives(void **state)
{
  const PetscReal h = 1e-4;

  for (int law = 0; ContactLaws[law]->symmetric; ++law) {
    const ContactSpec spec = {.law = (ContactLaw)law, .penalty = 20};
    for (int open = 0; open < 2; ++open) {
      const PetscReal    gap = open ? 0.3 : -0.01, difference = (Residual(&spec, gap, h) - Residual(&spec, gap, -h)) / (2 * h);
      const ContactPoint p = At(&spec, gap, 0);
      ContactRow         exact, symmetric;
      assert_int_equal(p.state, !open);
      ContactLaws[law]->rows(&p, PETSC_FALSE, &exact);
      ContactLaws[law]->rows(&p, PETSC_TRUE, &symmetric);
      assert_near(exact.factor * (0.2 - exact.mean * -0.1) + exact.z[0] * 0.3, open ? 0.3 * p.w0 : difference, 1e-7);
      assert_near(symmetric.factor * exact.z[0], exact.factor * symmetric.z[0], 1e-14);
      if (!open) assert_near(symmetric.side / symmetric.factor, exact.side / exact.factor, 1e-14);
      if (open) assert_near(symmetric.side / symmetric.z[0], exact.side / exact.z[0], 1e-14);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Names), cmocka_unit_test(Derivatives)};
  return cmocka_run_group_tests_name("interface: contact laws", tests, NULL, NULL);
}
