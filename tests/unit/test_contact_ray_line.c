/* Contact along a continuous direction where lines of both meshes lie on each other but for round-off, the mortar side ending inside: cells of hats see the
   mortar facets on the same side of the line as the facet does, and forces are continuous. */
#include "rayfixture.h"

#define ON 4.7e-10 /* steps of the line, about where clipping decides: 1e-9 of the root of a facet's area */

/* Flat facets of order 2, 2 x 2 on either side, a wedge of a gap between them; the mortar side covers x < 0.7, its line y = 1/2 runs from low to high. */
static void Evaluate(PetscReal low, PetscReal high, Sum *s)
{
  const ContactSpec spec = {.continuous = PETSC_TRUE};
  PetscReal         z[25];
  Patch             nonmortar, mortar;
  ContactPair       pair;

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
  memcpy(mortar.X, mortar.x, sizeof(PetscReal) * 3 * (size_t)mortar.s.num_nodes);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.5, 1e-3);
  SumCreate(s, &nonmortar, &mortar);
  SumEvaluate(s, pair, &nonmortar, &mortar, z, PETSC_FALSE);
  assert_false(s->failed);
  assert_near(s->area, 0.7, 1e-8);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
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

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_line_on_line)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
