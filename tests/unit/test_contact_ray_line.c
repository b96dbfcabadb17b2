/* Contact along a continuous direction where lines of both meshes lie on each other but for round-off, the mortar side ending inside: cells of hats see the
   mortar facets on the same side of the line as the facet does, and forces are continuous. And where a mortar corner lies on a side of a facet, its line at a
   small angle to it, since curved facets picture what lies beyond them a little beside a plane of symmetry: forces do not see by which of both the crossing is
   found, and their derivatives are exact. And where a crease of the mortar side, which is not quite the straight line as which it is seen, comes to lie on a
   side of a facet along its whole length: forces of a frozen segmentation are continuous, derivatives of the weighted gaps are not. */
#include "rayfixture.h"

#define ON 4.7e-10 /* steps of the line, about where clipping decides: 1e-9 of the root of a facet's area */

/* Sums over the pair of these patches, the mortar side at its reference positions; both are destroyed. held: the segmentation is frozen. */
static void Take(Patch *nonmortar, Patch *mortar, const PetscReal z[], PetscBool held, PetscBool hessian, Sum *s)
{
  const ContactSpec spec = {.friction = 0};
  ContactPair       pair;

  memcpy(mortar->X, mortar->x, sizeof(PetscReal) * 3 * (size_t)mortar->s.num_nodes);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  ContactPairFreezeSegmentation(pair, held);
  SearchAll(pair, nonmortar, mortar, 0.5, 1e-3);
  SumCreate(s, nonmortar, mortar);
  SumEvaluate(s, pair, nonmortar, mortar, z, hessian);
  assert_false(s->failed);
  PatchDestroy(nonmortar);
  PatchDestroy(mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

/* Flat facets of order 2, 2 x 2 on either side, a wedge of a gap between them; the mortar side covers x < 0.7, its line y = 1/2 runs from low to high. */
static void Evaluate(PetscReal low, PetscReal high, Sum *s)
{
  PetscReal z[25];
  Patch     nonmortar, mortar;

  PatchCreate(&nonmortar, 3, 2, 2, 0, 1, PETSC_TRUE, PETSC_FALSE);
  PatchCreate(&mortar, 3, 2, 2, 0, 1, PETSC_FALSE, PETSC_FALSE);
  for (PetscInt n = 0; n < nonmortar.s.num_nodes; n++) {
    PetscReal       *x = nonmortar.x + 3 * n, *y = mortar.x + 3 * n;
    const PetscReal *u = nonmortar.u + 2 * n, *v = mortar.u + 2 * n;

    z[n] = 1 + u[0] * u[1];
    x[0] = u[0], x[1] = u[1], x[2] = 0;
    y[0] = v[0] - 0.3, y[1] = 0.5 + 1.2 * (v[1] - 0.5), y[2] = 0.02 + 0.1 * v[0];
    if (v[1] == 0.5) y[1] += low + (high - low) * v[0];
  }
  memcpy(nonmortar.X, nonmortar.x, sizeof(PetscReal) * 3 * (size_t)nonmortar.s.num_nodes);
  Take(&nonmortar, &mortar, z, PETSC_FALSE, PETSC_FALSE, s);
  assert_near(s->area, 0.7, 1e-8);
}

static void test_line_on_line(void **state)
{
  PetscReal worst = 0, size;
  Sum       at, s;

  (void)state;
  Evaluate(0, 0, &at);
  size = Largest(at.gradient, at.size);
  for (int i = -6; i <= 6; i++)
    for (int j = -6; j <= 6; j++) {
      Evaluate(ON * i, ON * j, &s);
      for (PetscInt k = 0; k < s.size; k++) worst = PetscMax(worst, PetscAbsReal(s.gradient[k] - at.gradient[k]) / size);
      SumDestroy(&s);
    }
  print_message("lines within 3e-9 of each other: forces change by %.1e\n", worst);
  assert_true(worst < 2e-8);
  SumDestroy(&at);
}

/* Curved facets, 2 x 2 on either side, symmetric about y = 1/2 but for what the mortar corner that lies on a side there is moved by along y, whose number is
 *corner. Sides of the nonmortar facets spread along x. */
static void Spread(PetscInt order, PetscReal moved, PetscBool hessian, Sum *s, PetscInt *corner)
{
  PetscReal z[81];
  Patch     nonmortar, mortar;

  PatchCreate(&nonmortar, 3, order, 2, 0, 1, PETSC_TRUE, PETSC_FALSE);
  PatchCreate(&mortar, 3, order, 2, 0, 1, PETSC_FALSE, PETSC_FALSE);
  for (PetscInt n = 0; n < nonmortar.s.num_nodes; n++) {
    PetscReal       *x = nonmortar.x + 3 * n, *y = mortar.x + 3 * n, *X = nonmortar.X + 3 * n;
    const PetscReal *u = nonmortar.u + 2 * n, *v = mortar.u + 2 * n, b = u[1] - 0.5, c = v[1] - 0.5;

    z[n] = 1 + u[0] + b * b;
    X[0] = u[0], X[1] = u[1], X[2] = 0;
    x[0] = u[0], x[1] = 0.5 + b * (1 + 0.02 * u[0] * u[0]), x[2] = 0.3 * (1 - cos(1.5 * (u[0] - 0.4))) + 0.1 * b * b;
    y[0] = -0.35 + 1.8 * v[0], y[1] = 0.5 + 1.5 * c;
    y[2] = 0.02 + 0.3 * (1 - cos(1.5 * (y[0] - 0.4))) + 0.2 * c * c + 0.05 * fabs(c);
    if (v[0] != 0.5 || v[1] != 0.5) continue;
    y[1] += moved;
    *corner = 3 * (nonmortar.s.num_nodes + n) + 1;
  }
  Take(&nonmortar, &mortar, z, PETSC_FALSE, hessian, s);
}

static void test_corner_on_line(void **state)
{
  (void)state;
  for (PetscInt order = 2; order <= 4; order++) {
    PetscReal worst = 0;
    PetscInt  corner;
    Sum       s;

    for (int i = -8; i <= 8; i++) {
      Spread(order, ON * i, PETSC_FALSE, &s, &corner);
      worst = PetscMax(worst, PetscAbsReal(s.gradient[corner]) / Largest(s.gradient, s.size));
      SumDestroy(&s);
    }
    print_message("order %d, corner within 4e-9 of a side: force across it %.1e\n", (int)order, worst);
    assert_true(worst < 2e-9);
  }
}

/* The crossing runs along the side with 100 times the corner's motion. */
static void test_crossing_runs(void **state)
{
  const PetscReal moved = 1e-3, h = 2e-6, step[4] = {-2 * h, -h, h, 2 * h};

  (void)state;
  for (PetscInt order = 2; order <= 4; order++) {
    PetscReal worst = 0;
    PetscInt  corner;
    Sum       at, s[4];

    Spread(order, moved, PETSC_TRUE, &at, &corner);
    for (int i = 0; i < 4; i++) Spread(order, moved + step[i], PETSC_FALSE, &s[i], &corner);
    for (PetscInt k = 0; k < at.size; k++) {
      const PetscReal f[4] = {s[0].gradient[k], s[1].gradient[k], s[2].gradient[k], s[3].gradient[k]};

      worst = PetscMax(worst, PetscAbsReal(at.hessian[k * at.size + corner] - Difference(f, h)));
    }
    worst /= Largest(at.hessian, at.size * at.size);
    print_message("order %d, crossing at a small angle: Hessian against differences %.1e\n", (int)order, worst);
    assert_true(worst < 1e-6);
    for (int i = 0; i < 4; i++) SumDestroy(&s[i]);
    SumDestroy(&at);
  }
}

/* Flat facets of order 2, 2 x 2 on either side, under a roof: its ridge, bent by 0.01 between its corners, lies at y = 1/2 + moved, where two facets meet.
   held: forces hold it and its picture. */
static void Roof(PetscReal moved, PetscBool held, Sum *s)
{
  PetscReal z[25];
  Patch     nonmortar, mortar;

  PatchCreate(&nonmortar, 3, 2, 2, 0, 1, PETSC_TRUE, PETSC_FALSE);
  PatchCreate(&mortar, 3, 2, 2, 0, 1, PETSC_FALSE, PETSC_FALSE);
  for (PetscInt n = 0; n < nonmortar.s.num_nodes; n++) {
    PetscReal       *x = nonmortar.x + 3 * n, *y = mortar.x + 3 * n;
    const PetscReal *u = nonmortar.u + 2 * n, *v = mortar.u + 2 * n, c = v[1] - 0.5, side = fmod(2 * v[0], 1);

    z[n] = 1 + 0.5 * (PetscReal)(n % 3);
    x[0] = u[0], x[1] = u[1], x[2] = 0;
    y[0] = -0.2 + 1.4 * v[0], y[1] = 0.5 + 1.4 * c + moved + (c == 0 ? 0.04 * side * (1 - side) : 0), y[2] = 0.02 - 0.3 * fabs(c);
  }
  memcpy(nonmortar.X, nonmortar.x, sizeof(PetscReal) * 3 * (size_t)nonmortar.s.num_nodes);
  Take(&nonmortar, &mortar, z, held, PETSC_FALSE, s);
}

static void test_crease_on_line(void **state)
{
  const PetscReal step = 1e-7;
  PetscReal       jump[2], size;
  Sum             s[2];

  (void)state;
  for (int held = 0; held < 2; held++) {
    for (int i = 0; i < 2; i++) Roof(i ? step : -step, held ? PETSC_TRUE : PETSC_FALSE, &s[i]);
    assert_true(s[0].size == 150);
    size       = Largest(s[0].gradient, s[0].size);
    jump[held] = 0;
    for (PetscInt k = 0; k < s[0].size; k++) jump[held] = PetscMax(jump[held], PetscAbsReal(s[1].gradient[k] - s[0].gradient[k]) / size);
    for (int i = 0; i < 2; i++) SumDestroy(&s[i]);
  }
  print_message("a crease passes a side: derivatives of weighted gaps change by %.1e, forces of a frozen segmentation by %.1e\n", jump[0], jump[1]);
  assert_true(jump[1] < 10 * step && jump[0] > 1e-4);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_line_on_line), cmocka_unit_test(test_corner_on_line), cmocka_unit_test(test_crossing_runs),
                                     cmocka_unit_test(test_crease_on_line)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
