/* Zone of contact: its edge from the pressures of the nodes within, its area, extreme gaps; the reported radius against Hertz' profile. What an adaptation
 * changed. */
#include "diagnose.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "near.h"

#define MAX 401

/* A straight surface of n nodes from x = lo to x = hi at height y, body above; pressure(x) > 0 is active. */
typedef struct {
  PetscInt    edges[2 * MAX], first[MAX];
  PetscReal   x[2 * MAX], z[MAX], gap[MAX], weight[MAX];
  int8_t      active[MAX];
  PetscBool   has[MAX];
  ContactView view;
} Line;

static void LineMake(Line *l, PetscInt n, PetscReal lo, PetscReal hi, PetscReal (*pressure)(PetscReal))
{
  const PetscReal h = (hi - lo) / (PetscReal)(n - 1);

  memset(l, 0, sizeof(*l));
  for (PetscInt i = 0; i < n; ++i) {
    l->x[2 * i]  = lo + h * (PetscReal)i;
    l->z[i]      = PetscMax(0., pressure(l->x[2 * i]));
    l->active[i] = l->z[i] > 0;
    l->has[i]    = PETSC_TRUE;
    l->weight[i] = i == 0 || i == n - 1 ? h / 2 : h;
    l->gap[i]    = l->active[i] ? -1e-9 * l->weight[i] : l->weight[i] * (PetscAbsReal(l->x[2 * i]) - 1);
  }
  for (PetscInt e = 0; e < n - 1; ++e) {
    l->edges[2 * e]     = e;
    l->edges[2 * e + 1] = e + 1;
    l->first[e + 1]     = 2 * e + 2;
  }
  l->view.nonmortar             = (SurfaceView){.dim        = 2,
                                                .corners    = 2,
                                                .num_nodes  = n,
                                                .num_facets = n - 1,
                                                .facets     = l->edges,
                                                .first      = l->first,
                                                .lattice    = l->edges,
                                                .x          = l->x,
                                                .X          = l->x,
                                                .owned      = l->has};
  static const ContactSpec spec = {.law = CONTACT_FRICTIONLESS};
  l->view.spec                  = &spec;
  l->view.z                     = l->z;
  l->view.gap                   = l->gap;
  l->view.weight                = l->weight;
  l->view.active                = l->active;
  l->view.has_multiplier        = l->has;
}

static PetscReal Hertz(PetscReal x)
{
  return PetscAbsReal(x) < 1 ? PetscSqrtReal(1 - x * x) : 0;
}
static PetscReal Punch(PetscReal x)
{
  return PetscAbsReal(x) < 1 ? 1 / PetscSqrtReal(1.0001 - x * x) : 0;
}
static PetscReal Nothing(PetscReal x)
{
  return 0;
}
static PetscReal Everywhere(PetscReal x)
{
  return 2;
}

/* p^2 = 1 - x^2 is parabolic, extended along its chord over at most one edge: the error in the radius is below h^2, much less than the edge h. */
static void HertzRadius(void **state)
{
  static Line l;
  PairFigures f;

  for (PetscInt n = 20; n <= 320; n *= 2) {
    const PetscReal h = 4.2 / (PetscReal)(n - 1);
    LineMake(&l, n, -2.1, 2.1, Hertz);
    assert_int_equal(BalanceZone(PETSC_COMM_SELF, &l.view, &f), 0);
    assert_near(f.radius, 1, h * h);
    assert_near(f.area, 2, 2 * h);
    assert_near(f.max_pressure, 1, h * h);
    assert_near(f.min_gap, -1e-9, 1e-15);
    assert_near(f.max_gap, 1.1, 1e-12);
    assert_int_equal(f.covered_nodes, n);
  }
}

/* Half a model with the axis at its end, as symmetric scenes have it. */
static void HalfModel(void **state)
{
  static Line l;
  PairFigures f;

  LineMake(&l, 64, 0, 2.1, Hertz);
  assert_int_equal(BalanceZone(PETSC_COMM_SELF, &l.view, &f), 0);
  assert_near(f.radius, 1, PetscSqr(2.1 / 63));
}

/* Below a sharp corner the pressure grows towards the edge of the zone: half an edge is the best guess. */
static void PunchRadius(void **state)
{
  static Line l;
  PairFigures f;

  for (PetscInt n = 20; n <= 320; n *= 2) {
    LineMake(&l, n, -2.1, 2.1, Punch);
    assert_int_equal(BalanceZone(PETSC_COMM_SELF, &l.view, &f), 0);
    assert_near(f.radius, 1, 0.5000001 * 4.2 / (PetscReal)(n - 1));
  }
}

static void NoZone(void **state)
{
  static Line l;
  PairFigures f;

  LineMake(&l, 9, -2, 2, Nothing);
  assert_int_equal(BalanceZone(PETSC_COMM_SELF, &l.view, &f), 0);
  assert_near(f.radius, 0, 0);
  assert_near(f.area, 0, 0);
  assert_int_equal(f.active_nodes, 0);
  assert_near(f.min_gap, -1, 1e-14);
}

/* The whole surface in contact: it ends where the surface ends. Nodes that face nothing take no part. */
static void WholeSurface(void **state)
{
  static Line l;
  PairFigures f;

  LineMake(&l, 9, -2, 2, Everywhere);
  assert_int_equal(BalanceZone(PETSC_COMM_SELF, &l.view, &f), 0);
  assert_near(f.radius, 2, 1e-14);
  assert_near(f.area, 4, 1e-14);
  for (PetscInt i = 6; i < 9; ++i) {
    l.weight[i] = 0;
    l.gap[i]    = NAN;
    l.active[i] = 0;
    l.z[i]      = 0;
  }
  assert_int_equal(BalanceZone(PETSC_COMM_SELF, &l.view, &f), 0);
  assert_int_equal(f.covered_nodes, 6);
  assert_near(f.area, 2.75, 1e-14);
  assert_near(f.min_gap, -1e-9, 1e-15);
}

/* Forces (3, 4) of a support and 12 between the bodies: 13 in all. Where the support is a closed boundary its forces cancel but for round-off. */
static void Change(void **unused)
{
  PetscReal   reaction[2][3] = {{3, 4, 0}, {3, 4.13, 0}}, noise[2][3] = {{1e-13, 0, 0}, {0, -4e-13, 0}}, change[3];
  PairFigures pair[2] = {{.total = 12}, {.total = 12.24}};
  Balance     a       = {.num_boundaries = 1, .reaction = reaction, .plastic_work = 2, .status = {.scale = 20}};
  Balance     b       = {.num_boundaries = 1, .reaction = reaction + 1, .plastic_work = 2.02, .plastic_strain = 1};

  BalanceChange(&a, &b, change);
  assert_near(change[0], 0.026, 1e-14);
  assert_near(change[1], 0.01, 1e-14);
  assert_near(change[2], 0, 0); /* nothing had flowed before */
  a.num_contacts = b.num_contacts = 1;
  a.pair                          = pair;
  b.pair                          = pair + 1;
  BalanceChange(&a, &b, change);
  assert_near(change[0], PetscSqrtReal(0.13 * 0.13 + 0.24 * 0.24) / 13, 1e-14);
  a.reaction = noise;
  b.reaction = noise + 1;
  BalanceChange(&a, &b, change);
  assert_near(change[0], 0.02, 1e-12);
  a.num_contacts = b.num_contacts = 0;
  BalanceChange(&a, &b, change);
  assert_near(change[0], 0, 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(HertzRadius), cmocka_unit_test(HalfModel),    cmocka_unit_test(PunchRadius),
                                     cmocka_unit_test(NoZone),      cmocka_unit_test(WholeSurface), cmocka_unit_test(Change)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
