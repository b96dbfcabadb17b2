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
  assert_string_equal(ContactLaws[CONTACT_TIED]->name, "tied");
}

/* Sets of pairs have a bit for each of the first 64; what has none is in that of all alone. */
static void Sets(void **state)
{
  for (PetscInt pair = 0; pair < 200; ++pair) {
    assert_true(FormHas(ALL_PAIRS, pair));
    assert_int_equal(FormHas(FormPair(pair), pair), pair < 64);
    assert_false(FormHas(FormPair(pair), pair + 64));
    assert_false(FormHas(FormPair(3), pair) && pair != 3);
  }
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

/* Tied: each component by itself, without states; one that has no multiplier is 0. */
static void Tied(void **state)
{
  const ContactSpec    spec = {.law = CONTACT_TIED};
  const ContactLawOps *law  = ContactLaws[CONTACT_TIED];
  const ContactPoint   p    = {.spec = &spec, .num = 3, .z = {0.4, 0.5, 0.6}, .w0 = 0.5, .c = 3, .tie = {{0.1, 0.4, 0.02}, {0.2, 0, 0}, {-0.3, 0.5, 0}}};

  (void)state;
  assert_int_equal(law->num_multipliers(3), 3);
  assert_true(law->state(&p) != 0);
  for (int symmetric = 0; symmetric < 2; ++symmetric) {
    ContactRow row[MOST_MULTIPLIERS];
    law->rows(&p, (PetscBool)symmetric, row);
    for (int k = 0; k < 3; ++k) assert_int_equal(row[k].component, k);
    assert_near(row[0].side, -row[0].factor * 0.12, 1e-15);
    assert_near(row[2].side, row[2].factor * 0.3, 1e-15);
    assert_near(row[0].factor, symmetric ? -3 : 0.5 * 3 / 0.4, 1e-15);
    assert_near(row[1].side / row[1].z[1], -0.5, 1e-15);
    assert_true(row[1].factor == 0 && row[0].z[0] == 0);
  }
}

/* Coulomb: states, rows as derivatives of the projection form, and no way from slip to slip the other way but by stick. */
static void Friction(void **state)
{
  static const PetscReal Slip[3] = {0, -0.3, 0.3}, q[3] = {0.05, 0.2, -0.2};
  const ContactSpec      spec = {.law = CONTACT_COULOMB};
  const ContactLawOps   *law  = ContactLaws[CONTACT_COULOMB];

  (void)state;
  for (int k = 0; k < 3; ++k) {
    ContactPoint p = {
        .spec = &spec, .friction = 0.4, .z = {0.5, q[k]}, .gap = 0, .weight = 0.4, .w0 = 0.5, .c = 3, .dim = 2, .slip = {Slip[k]}, .slip_weight = 0.3};
    ContactRow row[MOST_MULTIPLIERS];

    p.state = law->state(&p);
    assert_int_equal(p.state, k + 1);
    assert_int_equal(law->slides(p.state), k != 0);
    law->rows(&p, PETSC_FALSE, row);
    assert_near(row[1].side, k == 0 ? 0 : -0.5 * (q[k] - (k == 1 ? 0.2 : -0.2)), 1e-14);
    assert_near(row[1].slip[0] != 0 ? row[1].slip[0] : row[1].z[1], k == 0 ? 0.5 * 3 / 0.3 : 0.5, 1e-14);
    assert_near(row[1].z[0], k == 0 ? 0 : k == 1 ? -0.2 : 0.2, 1e-14);
    if (k == 0) continue;
    p.slip[0] = -p.slip[0], p.z[1] = -p.z[1]; /* now it would slip the other way */
    assert_int_equal(law->state(&p), 1);
    p.state = 0;
    assert_int_equal(law->state(&p), 4 - k);
    p.slip_weight = 0; /* it met nothing where the step began */
    assert_int_equal(law->slides(law->state(&p)), 0);
    p.slip_weight = 0.3, p.friction = 0, p.z[1] = 0; /* friction that comes later: no traction, whatever the slip */
    p.state = law->state(&p);
    law->rows(&p, PETSC_FALSE, row);
    assert_near(row[1].z[1], 0.5, 1e-15);
    assert_true(row[1].z[0] == 0 && row[1].slip[0] == 0 && row[1].side == 0);
    p.gap = 1;
    assert_int_equal(law->state(&p), 0);
  }
}

/* Residual of row i at a node in space whose traction and slip change with s; supports hold it along so many axes. */
static ContactPoint InSpace(const ContactSpec *spec, PetscInt held, PetscReal s)
{
  const ContactLawOps *law = ContactLaws[CONTACT_COULOMB];
  ContactPoint         p   = {.spec        = spec,
                              .friction    = 0.4,
                              .z           = {0.5 + 0.2 * s, 0.1 + 0.3 * s, -0.05 + 0.1 * s},
                              .weight      = 0.4,
                              .w0          = 0.5,
                              .c           = 3,
                              .dim         = 3,
                              .slip_weight = 0.3,
                              .held        = held,
                              .q           = {0.12, 0.02}};

  p.slip[0] = -0.02 + 0.07 * s, p.slip[1] = 0.01 - 0.04 * s;
  p.state = law->state(&p);
  law->aim(&p, p.aim);
  return p;
}

/* In space rows of slip are derivatives of q - b tau / |tau|. */
static void RowsInSpace(PetscInt held)
{
  const ContactSpec    spec = {.law = CONTACT_COULOMB};
  const ContactLawOps *law  = ContactLaws[CONTACT_COULOMB];
  const PetscReal      h = 1e-5, dz[3] = {0.2, 0.3, 0.1}, ds[2] = {0.07, -0.04};
  ContactRow           row[MOST_MULTIPLIERS], up[MOST_MULTIPLIERS], down[MOST_MULTIPLIERS];
  ContactPoint         p = InSpace(&spec, held, 0), q = InSpace(&spec, held, h), r = InSpace(&spec, held, -h);

  assert_int_equal(law->slides(p.state), 1);
  law->rows(&p, PETSC_FALSE, row), law->rows(&q, PETSC_FALSE, up), law->rows(&r, PETSC_FALSE, down);
  for (int i = 1; i < 3; ++i) {
    const PetscReal exact = row[i].z[0] * dz[0] + row[i].z[1] * dz[1] + row[i].z[2] * dz[2] + row[i].slip[0] * ds[0] + row[i].slip[1] * ds[1];

    assert_near(exact, -(up[i].side - down[i].side) / (2 * h), 1e-9);
  }
  p.slip[0] = -p.slip[0], p.slip[1] = -p.slip[1], p.z[1] = p.z[2] = p.q[0] = p.q[1] = 0; /* now it would slip back */
  assert_int_equal(law->slides(law->state(&p)), 0);
}

static void FrictionInSpace(void **state)
{
  (void)state;
  for (PetscInt held = 0; held < 3; ++held) RowsInSpace(held);
}

/* A node that a support holds along the surface: a spring from the traction that was, up to the bound; in a plane of symmetry none. */
static void Held(void **state)
{
  const ContactSpec    spec = {.law = CONTACT_COULOMB};
  const ContactLawOps *law  = ContactLaws[CONTACT_COULOMB];

  (void)state;
  for (PetscInt plane = 0; plane < 2; ++plane) {
    ContactPoint p = {.spec        = &spec,
                      .friction    = 0.4,
                      .z           = {0.5, 0.3},
                      .weight      = 0.4,
                      .w0          = 0.5,
                      .c           = 3,
                      .dim         = 2,
                      .slip        = {0.002},
                      .slip_weight = 0.3,
                      .held        = 1,
                      .plane       = plane,
                      .q           = {plane ? 0 : 0.1}};
    ContactRow   row[MOST_MULTIPLIERS];

    p.state = law->state(&p);
    assert_int_equal(p.state, 1);
    law->rows(&p, PETSC_FALSE, row);
    assert_near(row[1].side, -0.5 * (plane ? 0.3 : 0.3 - (0.1 - 3 * 0.002 / 0.3)), 1e-14);
    assert_near(row[1].z[1], 0.5, 1e-14);
    assert_near(row[1].slip[0], plane ? 0 : 0.5 * 3 / 0.3, 1e-14);
    p.slip[0] = -1;
    assert_int_equal(law->slides(law->state(&p)), !plane);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Names),           cmocka_unit_test(Sets), cmocka_unit_test(Derivatives), cmocka_unit_test(Friction),
                                     cmocka_unit_test(FrictionInSpace), cmocka_unit_test(Held), cmocka_unit_test(Tied)};
  return cmocka_run_group_tests_name("interface: contact laws", tests, NULL, NULL);
}
