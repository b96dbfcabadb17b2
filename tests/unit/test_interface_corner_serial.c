/* Corners of the mortar side that press alone: within a facet or at a node of the nonmortar side, with both faces slanted to it, and nothing beside. */
#include "contactfixture.h"
#include "interfaceimpl.h"

#define NODES 9 /* of a flat nonmortar side from x = 4 to x = -4 */

static void Fill(Surface *s, Chain *c)
{
  s->dim = s->corners = 2;
  s->num_nodes        = c->s.num_nodes;
  s->num_facets       = c->s.num_facets;
  s->facets = s->lattice = c->edges;
  s->X                   = c->X;
  s->x                   = c->x;
  s->order               = calloc((size_t)s->num_facets, sizeof(int8_t));
  s->first               = calloc((size_t)s->num_facets + 1, sizeof(PetscInt));
  for (PetscInt f = 0; f <= s->num_facets; ++f) s->first[f] = 2 * f;
  for (PetscInt f = 0; f < s->num_facets; ++f) s->order[f] = 1;
}

/* A tip at (x, y) with faces that rise by these angles (degrees), in facets of this length, over nodes of which those at x = from .. to press; splits of what
   is found, -1: nothing is. */
static PetscInt Find(PetscReal x, PetscReal y, const PetscReal rise[2], PetscReal length, PetscReal from, PetscReal to, PetscBool near)
{
  const ContactSpec   spec                  = {.pair = 3};
  PetscBool           has_multiplier[NODES] = {PETSC_FALSE}, valued[NODES];
  int8_t              active[NODES];
  Contact             c = {.spec = &spec, .law = ContactLaws[CONTACT_FRICTIONLESS], .has_multiplier = has_multiplier, .valued = valued, .active = active};
  struct _p_Interface interface = {.comm = PETSC_COMM_SELF, .dim = 2, .num_contacts = 1, .contacts = &c};
  Chain               nonmortar, mortar;
  InterfaceCorner    *corner;
  PetscInt            num, splits = -1;
  Sum                 s;

  ChainLine(&nonmortar, NODES, 4, 0, -4, 0);
  ChainLine(&mortar, 3, x, y, x, y);
  for (int k = 0; k < 2; ++k) { /* the outline runs towards +x */
    const PetscReal angle = rise[k] * PETSC_PI / 180;
    mortar.x[4 * k] += (k ? 1 : -1) * length * cos(angle);
    mortar.x[4 * k + 1] += length * sin(angle);
  }
  ChainReference(&mortar);
  EvaluateOnce(&nonmortar, &mortar, PETSC_FALSE, PETSC_FALSE, 2, NULL, &c.pair, &s);
  Fill(&c.side[0], &nonmortar);
  Fill(&c.side[1], &mortar);
  for (PetscInt n = 0; n < NODES; ++n) {
    has_multiplier[n] = valued[n] = PETSC_TRUE;
    active[n]                     = nonmortar.x[2 * n] > from - 0.1 && nonmortar.x[2 * n] < to + 0.1;
  }
  CHECK_CALL(InterfaceFindCorners(&interface, UINT64_MAX, near, &num, &corner));
  assert_true(num <= 1);
  if (num) {
    assert_int_equal(corner->pair, 3);
    assert_near(corner->X[0], x, 0);
    assert_near(corner->X[1], y, 0);
    splits = corner->splits;
  }
  CHECK_CALL(PetscFree(corner));
  CHECK_CALL(ContactPairDestroy(&c.pair));
  for (int k = 0; k < 2; ++k) free(c.side[k].order), free(c.side[k].first);
  ChainDestroy(&nonmortar);
  ChainDestroy(&mortar);
  SumDestroy(&s);
  return splits;
}

static const PetscReal Wedge[2] = {45, 45}, Leaning[2] = {20, 60}, Flat[2] = {1, 89}, Blunt[2] = {18, 18};

static void Alone(void **state)
{
  assert_int_equal(Find(0.3, -0.01, Wedge, 0.9, 0, 1, PETSC_FALSE), 0);   /* within a facet whose nodes press */
  assert_int_equal(Find(0.3, -0.01, Wedge, 0.9, 9, 9, PETSC_FALSE), 0);   /* inside, though no node presses yet */
  assert_int_equal(Find(0, -0.01, Wedge, 0.9, 0, 0, PETSC_FALSE), 0);     /* at a node */
  assert_int_equal(Find(0, -0.01, Wedge, 0.9, -1, 1, PETSC_FALSE), 0);    /* between two facets, which press */
  assert_int_equal(Find(0.3, -0.01, Leaning, 0.9, 0, 1, PETSC_FALSE), 0); /* faces that slant by different angles */
}

static void Not(void **state)
{
  assert_int_equal(Find(0.3, -0.01, Wedge, 0.9, -1, 1, PETSC_FALSE), -1); /* something presses beside it … */
  assert_int_equal(Find(0, -0.01, Wedge, 0.9, -1, 2, PETSC_FALSE), -1);   /* … or beside both facets */
  assert_int_equal(Find(0.3, 0.01, Wedge, 0.9, 9, 9, PETSC_FALSE), -1);   /* it is off, and nothing presses */
  assert_int_equal(Find(0.3, -0.01, Flat, 0.9, 0, 1, PETSC_FALSE), -1);   /* one face lies on the facet */
  assert_int_equal(Find(0.3, -0.01, Blunt, 0.9, 0, 1, PETSC_FALSE), -1);  /* no sharp corner: 36 degrees */
}

static void Near(void **state)
{
  assert_int_equal(Find(0.3, 0.05, Wedge, 0.9, 9, 9, PETSC_TRUE), 0); /* off by less than a tenth of the facet */
  assert_int_equal(Find(0.3, 0.15, Wedge, 0.9, 9, 9, PETSC_TRUE), -1);
}

static void Splits(void **state)
{
  assert_int_equal(Find(0.3, -0.01, Wedge, 1.9, 0, 1, PETSC_FALSE), 0);
  assert_int_equal(Find(0.3, -0.01, Wedge, 2, 0, 1, PETSC_FALSE), 1);
  assert_int_equal(Find(0.3, -0.01, Wedge, 3.9, 0, 1, PETSC_FALSE), 1);
  assert_int_equal(Find(0.3, -0.01, Wedge, 4, 0, 1, PETSC_FALSE), 2);
}

CONTACT_TEST_MAIN("interface: corners that press alone", cmocka_unit_test(Alone), cmocka_unit_test(Not), cmocka_unit_test(Near), cmocka_unit_test(Splits))
