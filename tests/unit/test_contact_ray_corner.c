/* Contact along a continuous direction at a sharp edge of the nonmortar side: a strip bent by a right angle over a floor that goes on beyond it. Each side of
   the edge keeps its own direction, so that facets of the upright half see nothing, and those on the floor what they would see without it: weights are
   integrals of the functions and weighted gaps, under any gap, the weights times it. Derivatives against differences, with the upright half tilted, too. */
#include "rayfixture.h"

#define GAP 0.07

/* Chart [0, 1] x ..: the lower half flat, the rest upright beyond the edge at 1/2, leaning over the floor by `lean`. */
static void Bend(Patch *p, PetscReal lean)
{
  const PetscInt D = p->dim;

  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal a = p->u[2 * n] - 0.5, up = PetscMax(0, a);
    PetscReal      *x = p->x + D * n, *X = p->X + D * n;

    for (PetscInt c = 0; c < D; c++) x[c] = X[c] = c == 1 && D == 3 ? p->u[2 * n + 1] : 0;
    x[0]     = PetscMin(a, 0) + lean * up;
    X[0]     = PetscMin(a, 0);
    x[D - 1] = X[D - 1] = up;
  }
}

static void Floor(Patch *p)
{
  const PetscInt D = p->dim;

  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    PetscReal *x = p->x + D * n;

    x[0] = 3 * p->u[2 * n] - 1.37;
    if (D == 3) x[1] = 3 * p->u[2 * n + 1] - 1.21;
    x[D - 1] = -GAP;
  }
  PatchFollow(p);
  memcpy(p->X, p->x, sizeof(PetscReal) * (size_t)(D * p->s.num_nodes));
}

static void Check(PetscInt dim, PetscInt order, PetscReal lean, PetscBool refined)
{
  const ContactSpec spec = {.friction = 0};
  Patch             nonmortar, mortar;
  ContactPair       pair;
  Sum               s, moved;
  PetscReal         weight = 0, off = 0, error = 0, *z;
  uint64_t          seed = 7;

  PatchCreate(&nonmortar, dim, order, 4, 0, 1, (PetscBool)(dim == 2), refined); /* outward is downward */
  Bend(&nonmortar, lean);
  PatchCreate(&mortar, dim, 1, 3, 0, 1, (PetscBool)(dim == 3), PETSC_FALSE);
  Floor(&mortar);
  CHECK_CALL(ContactPairCreate(dim, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.5, 1e-3);
  SumCreate(&s, &nonmortar, &mortar);
  SumCreate(&moved, &nonmortar, &mortar);
  z = calloc((size_t)s.nn, sizeof(PetscReal));
  for (PetscInt j = 0; j < s.nn; j++) z[j] = 1 + 0.5 * Random(&seed);
  SumEvaluate(&s, pair, &nonmortar, &mortar, z, PETSC_FALSE);
  assert_false(s.failed);
  for (PetscInt j = 0; j < s.nn; j++) {
    weight += s.weight[j];
    off = PetscMax(off, PetscAbsReal(s.gap[j] - GAP * s.weight[j]));
    if (nonmortar.u[2 * j] > 0.5 + 1e-9) assert_true(s.weight[j] == 0);
  }
  for (PetscInt k = 0; k < dim * nonmortar.num_true; k++) { /* nodes that do not hang, those of the edge among them */
    const PetscInt at = dim * nonmortar.real[k / dim] + k % dim;
    PetscReal      value[2];

    for (int side = 0; side < 2; side++) {
      nonmortar.x[at] += (side ? 2 : -1) * 1e-5;
      PatchFollow(&nonmortar);
      SumEvaluate(&moved, pair, &nonmortar, &mortar, z, PETSC_FALSE);
      value[side] = moved.S;
    }
    nonmortar.x[at] -= 1e-5;
    error = PetscMax(error, PetscAbsReal((value[1] - value[0]) / 2e-5 - s.gradient[at]));
  }
  print_message("%dD, order %d, leaning by %g%s: covered %.1e, gaps %.1e, gradient %.1e\n", (int)dim, (int)order, (double)lean,
                refined ? ", hanging nodes" : "", (double)(weight - 0.5), (double)off, (double)error);
  assert_true(PetscAbsReal(weight - 0.5) < 1e-12);
  assert_true(off < 1e-12);
  assert_true(error < 1e-8);
  free(z);
  SumDestroy(&s);
  SumDestroy(&moved);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

static void test_plane(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 4; order++)
    for (int lean = 0; lean < 2; lean++) Check(2, order, 0.2 * lean, PETSC_FALSE);
}

static void test_space(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 2; order++)
    for (int lean = 0; lean < 2; lean++)
      for (int refined = 0; refined < 2; refined++) Check(3, order, 0.2 * lean, (PetscBool)refined);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_plane), cmocka_unit_test(test_space)};
  int                     status;

  CHECK_CALL(PetscInitialize(&argc, &argv, NULL, NULL));
  status = cmocka_run_group_tests(tests, NULL, NULL);
  CHECK_CALL(PetscFinalize());
  return status;
}
