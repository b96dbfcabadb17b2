/* Weights of functions of a facet covered in part are positive: a mortar side that leaves a corner of the facet bare, where a dual function has all its weight.
 */
#include "contactfixture.h"

#include "functionimpl.h"

#define POINTS 4000 /* of the midpoint rule along a facet */

/* 1D integrals of dual functions and Bernstein polynomials over [0, a] and [0, 1]. */
typedef struct {
  PetscReal dual[2][MORTISE_MAX_ORDER + 1], bernstein[2][MORTISE_MAX_ORDER + 1];
} Parts;

static void Integrate(PetscInt p, PetscReal a, Parts *o)
{
  const PetscInt   n = p + 1;
  const PetscReal *node;
  PetscReal        C[(MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1)], N[MORTISE_MAX_ORDER + 1], L[MORTISE_MAX_ORDER + 1], Lj[MORTISE_MAX_ORDER + 1];

  memset(o, 0, sizeof(*o));
  CHECK_CALL(ElementGetNodes(p, &node));
  CHECK_CALL(ContactBernsteinRows(1, p, C));
  for (PetscInt i = 0; i < POINTS; i++) {
    const PetscReal x = (0.5 + (PetscReal)i) / POINTS;
    CHECK_CALL(ElementEvaluate1D(p, x, N, NULL));
    CHECK_CALL(ElementLegendre(p, x, L, NULL));
    for (PetscInt j = 0; j < n; j++) {
      PetscReal b = 0;
      CHECK_CALL(ElementLegendre(p, node[j], Lj, NULL));
      for (PetscInt k = 0; k < n; k++) b += C[n * j + k] * N[k];
      for (int whole = x < a ? 0 : 1; whole < 2; whole++) {
        o->dual[whole][j] += (N[j] + L[p] / ((PetscReal)p * Lj[p])) / POINTS;
        o->bernstein[whole][j] += b / POINTS;
      }
    }
  }
}

static PetscReal Left(PetscInt m, const PetscReal part[2][MORTISE_MAX_ORDER + 1], PetscInt j, PetscInt k)
{
  return m == 1 ? part[1][j] - part[0][j] : part[1][j] * part[1][k] - part[0][j] * part[0][k];
}

/* Least weight over what it is on the facet as a whole, a strip or the square of side a at a corner being bare. */
static PetscReal Least(PetscInt m, PetscInt p)
{
  PetscReal least = 1;

  for (PetscReal a = 0.01; a < 0.995; a += 0.01) {
    const PetscReal bare = a * a * (3 - 2 * a);
    Parts           o;
    ContactShare    share;

    Integrate(p, a, &o);
    ContactShareOf(m, p, 1 - (m == 1 ? bare : bare * bare), PETSC_FALSE, &share);
    for (PetscInt j = 0; j <= p; j++)
      for (PetscInt k = 0; k <= (m == 1 ? 0 : p); k++) {
        const PetscReal theta = share.theta[0],
                        whole = theta * o.dual[1][j] * (m == 1 ? 1 : o.dual[1][k]) + (1 - theta) * o.bernstein[1][j] * (m == 1 ? 1 : o.bernstein[1][k]);
        least                 = PetscMin(least, (theta * Left(m, o.dual, j, k) + (1 - theta) * Left(m, o.bernstein, j, k)) / whole);
      }
    if (share.theta[0] == 0) break; /* Bernstein polynomials are positive */
  }
  return least;
}

static void Positive(void **state)
{
  (void)state;
  for (PetscInt m = 1; m <= 2; m++)
    for (PetscInt p = 1; p <= 4; p++) {
      const PetscReal least = Least(m, p);
      print_message("%dD order %d: least weight %.2f of the whole one\n", (int)m + 1, (int)p, (double)least);
      assert_true(least > 0.2);
    }
}

CONTACT_TEST_MAIN("contact: functions of facets covered in part", cmocka_unit_test(Positive))
