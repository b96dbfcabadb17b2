/* Held directions: first derivatives differ from the exact ones by what turning directions do, and by nothing else. */
#include "rayfixture.h"

/* A bent nonmortar surface across a wide gap from a flat one. */
static void Place(Patch *p, PetscReal height, PetscReal bend)
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal a = p->u[2 * n], b = p->u[2 * n + 1];

    p->x[p->dim * n] = a;
    if (p->dim == 3) p->x[p->dim * n + 1] = b;
    p->x[p->dim * n + p->dim - 1] = height + bend * (a * a + 0.5 * b * b);
    for (PetscInt c = 0; c < p->dim; c++) p->X[p->dim * n + c] = p->x[p->dim * n + c];
  }
}

/* Derivatives of the weighted gaps along a motion. */
static void Along(const Sum *s, const PetscReal motion[], PetscReal change[])
{
  for (PetscInt j = 0; j < s->nn; j++) {
    change[j] = 0;
    for (PetscInt i = 0; i < s->size; i++) change[j] += s->dgap[j * s->size + i] * motion[i];
  }
}

static PetscReal Distance(const Sum *a, const Sum *b, const PetscReal motion[])
{
  PetscReal *x = calloc((size_t)(2 * a->nn), sizeof(PetscReal)), most = 0;

  Along(a, motion, x);
  Along(b, motion, x + a->nn);
  for (PetscInt j = 0; j < a->nn; j++) most = PetscMax(most, PetscAbsReal(x[j] - x[a->nn + j]));
  most /= Largest(x, a->nn);
  free(x);
  return most;
}

static void Check(PetscInt dim, PetscInt order, uint64_t seed)
{
  const ContactSpec spec = {.friction = 0};
  Patch             nonmortar, mortar;
  ContactPair       pair;
  Sum               exact, held;
  PetscReal        *z, *motion;

  PatchCreate(&nonmortar, dim, order, 3, 0, 1, dim == 2 ? PETSC_FALSE : PETSC_TRUE, PETSC_FALSE);
  PatchCreate(&mortar, dim, order, 4, -0.5, 1.5, dim == 2 ? PETSC_TRUE : PETSC_FALSE, PETSC_FALSE);
  Place(&nonmortar, 0, -0.3);
  Place(&mortar, 0.4, 0);
  CHECK_CALL(ContactPairCreate(dim, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 2, 0);
  SumCreate(&exact, &nonmortar, &mortar);
  SumCreate(&held, &nonmortar, &mortar);
  z      = calloc((size_t)exact.nn, sizeof(PetscReal));
  motion = calloc((size_t)exact.size, sizeof(PetscReal));
  for (PetscInt j = 0; j < exact.nn; j++) z[j] = 1 + Random(&seed);
  SumEvaluate(&exact, pair, &nonmortar, &mortar, z, PETSC_TRUE);
  ContactPairFreezeNormals(pair, PETSC_TRUE);
  SumEvaluate(&held, pair, &nonmortar, &mortar, z, PETSC_TRUE);
  assert_false(exact.failed || held.failed);
  assert_true(Largest(exact.hessian, exact.size * exact.size) > 0);
  assert_true(Largest(held.hessian, held.size * held.size) == 0);
  for (PetscInt j = 0; j < exact.nn; j++) assert_true(exact.gap[j] == held.gap[j] && exact.weight[j] == held.weight[j]);
  for (PetscInt n = 0; n < exact.nn; n++) /* a translation of the nonmortar side, any motion of the other: nothing turns */
    for (PetscInt c = 0; c < dim; c++) motion[dim * n + c] = 0.3 + (PetscReal)c;
  for (PetscInt i = dim * exact.nn; i < exact.size; i++) motion[i] = Random(&seed);
  assert_true(Distance(&exact, &held, motion) < 1e-12);
  for (PetscInt i = 0; i < exact.size; i++) motion[i] = 0;
  for (PetscInt n = 0; n < exact.nn; n++) motion[dim * n + dim - 1] = PetscSqr(nonmortar.x[dim * n]); /* a bend turns directions by as much as it moves */
  print_message("%dD, order %d: %.2g\n", (int)dim, (int)order, Distance(&exact, &held, motion));
  assert_true(Distance(&exact, &held, motion) > 0.1);
  ContactPairFreezeNormals(pair, PETSC_FALSE);
  SumEvaluate(&held, pair, &nonmortar, &mortar, z, PETSC_TRUE);
  assert_true(Distance(&exact, &held, motion) == 0);
  free(z), free(motion);
  SumDestroy(&exact);
  SumDestroy(&held);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

static void test_plane(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 4; order++) Check(2, order, 7);
}

static void test_space(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 2; order++) Check(3, order, 7);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_plane), cmocka_unit_test(test_space)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
