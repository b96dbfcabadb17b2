/* Contact along a continuous direction where the mortar side's facets are many times as wide as those of a round edge that lies on it: directions turn by much
   from facet to facet, and where they went on turning beyond a facet they would cross before they reach the corners of what it sees. */
#include "rayfixture.h"

#define RADIUS 0.05
#define DEPTH 0.2

/* A round edge of radius r along y, tilted by up to `most` about its top, and the plane z = r + gap over it. Nothing of what the rays meet may depend on the
   mortar side's mesh. */
static void Edge(Patch *p, PetscReal most)
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal a = most * p->u[2 * n], *u = p->u + 2 * n;

    p->x[3 * n] = RADIUS * sin(a), p->x[3 * n + 1] = DEPTH * u[1], p->x[3 * n + 2] = RADIUS * cos(a);
  }
  memcpy(p->X, p->x, sizeof(PetscReal) * 3 * (size_t)p->s.num_nodes);
}

static void Plane(Patch *p, PetscReal gap)
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal *u = p->u + 2 * n;

    p->x[3 * n] = 2 * u[0] - 0.9, p->x[3 * n + 1] = 2 * u[1] - 0.8, p->x[3 * n + 2] = RADIUS + gap;
  }
  PatchFollow(p);
  memcpy(p->X, p->x, sizeof(PetscReal) * 3 * (size_t)p->s.num_nodes);
}

/* On a mortar side of n x n facets. */
static PetscInt Evaluate(PetscInt order, PetscReal most, PetscReal gap, PetscInt n, PetscBool hanging, Sum *s)
{
  Patch nonmortar, mortar;

  PatchCreate(&nonmortar, 3, order, 3, 0, 1, PETSC_TRUE, PETSC_FALSE);
  Edge(&nonmortar, most);
  PatchCreate(&mortar, 3, 1, n, 0, 1, PETSC_FALSE, hanging);
  Plane(&mortar, gap);
  return SumBetween(s, &nonmortar, &mortar);
}

/* Area, weights and weighted gaps on coarse mortar sides are those on a fine one. */
static void Check(PetscInt order, PetscReal most, PetscReal gap)
{
  Sum fine;

  assert_int_equal(Evaluate(order, most, gap, 24, PETSC_FALSE, &fine), 0);
  for (PetscInt n = 1; n <= 5; n++) {
    PetscReal      weight = 0, gaps = 0;
    Sum            s;
    const PetscInt degenerate = Evaluate(order, most, gap, n, (PetscBool)(n > 2), &s);

    for (PetscInt j = 0; j < s.nn; j++) {
      weight = PetscMax(weight, PetscAbsReal(s.weight[j] - fine.weight[j]) / Largest(fine.weight, s.nn));
      gaps   = PetscMax(gaps, PetscAbsReal(s.gap[j] - fine.gap[j]) / Largest(fine.gap, s.nn));
    }
    print_message("order %d, up to %.0f degrees, gap %g radii, %d x %d facets: area off by %.1e, weights by %.1e, gaps by %.1e, %d not seen\n", (int)order,
                  (double)(most * 180 / PETSC_PI), (double)(gap / RADIUS), (int)n, (int)n, (double)(s.area / fine.area - 1), (double)weight, (double)gaps,
                  (int)degenerate);
    assert_false(s.failed);
    assert_int_equal(degenerate, 0);
    assert_true(PetscAbsReal(s.area / fine.area - 1) < 1e-12);
    assert_true(PetscMax(weight, gaps) < 1e-7); /* quadrature over other polygons */
    SumDestroy(&s);
  }
  SumDestroy(&fine);
}

/* The same in the plane. */
static void EvaluatePlane(PetscInt order, PetscReal most, PetscReal gap, PetscInt n, Sum *s)
{
  Patch nonmortar, mortar;

  PatchCreate(&nonmortar, 2, order, 6, 0, 1, PETSC_TRUE, PETSC_FALSE);
  for (PetscInt v = 0; v < nonmortar.s.num_nodes; v++) {
    const PetscReal a = most * nonmortar.u[2 * v];

    nonmortar.x[2 * v] = -RADIUS * sin(a), nonmortar.x[2 * v + 1] = RADIUS * cos(a);
  }
  PatchCreate(&mortar, 2, 1, n, 0, 1, PETSC_TRUE, PETSC_FALSE);
  for (PetscInt v = 0; v < mortar.s.num_nodes; v++) mortar.x[2 * v] = 400 * mortar.u[2 * v] - 210.1, mortar.x[2 * v + 1] = RADIUS + gap;
  memcpy(nonmortar.X, nonmortar.x, sizeof(PetscReal) * 2 * (size_t)nonmortar.s.num_nodes);
  memcpy(mortar.X, mortar.x, sizeof(PetscReal) * 2 * (size_t)mortar.s.num_nodes);
  assert_int_equal(SumBetween(s, &nonmortar, &mortar), 0);
}

/* Weights and gaps on mortar sides of one to five facets, up to 10^5 times as long as those of the edge, are those on many. */
static void test_plane(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 4; order++)
    for (int g = 0; g < 3; g++) {
      Sum fine;

      EvaluatePlane(order, PETSC_PI / 6, g * 0.2 * RADIUS, 400, &fine);
      for (PetscInt n = 1; n <= 5; n++) {
        PetscReal off = 0;
        Sum       s;

        EvaluatePlane(order, PETSC_PI / 6, g * 0.2 * RADIUS, n, &s);
        for (PetscInt j = 0; j < s.nn; j++)
          off = PetscMax(off, PetscMax(PetscAbsReal(s.weight[j] - fine.weight[j]) / Largest(fine.weight, s.nn),
                                       PetscAbsReal(s.gap[j] - fine.gap[j]) / Largest(fine.gap, s.nn)));
        print_message("plane, order %d, gap %g radii, %d facets: area off by %.1e, weights and gaps by %.1e\n", (int)order, g * 0.2, (int)n,
                      (double)(s.area / fine.area - 1), (double)off);
        assert_false(s.failed);
        assert_true(PetscAbsReal(s.area / fine.area - 1) < 1e-12 && off < 1e-7);
        SumDestroy(&s);
      }
      SumDestroy(&fine);
    }
}

static void test_far(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 3; order++)
    for (int k = 0; k < 3; k++)
      for (int g = 0; g < 3; g++) Check(order, (1 + k) * PETSC_PI / 9, g * 0.2 * RADIUS);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_far), cmocka_unit_test(test_plane)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
