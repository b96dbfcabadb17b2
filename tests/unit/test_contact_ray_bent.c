/* Contact along a continuous direction where sides of the mortar side's facets are curved along the surface, by more than the finer facets that hang on them
   are wide: nothing is lost, nothing counted twice. */
#include "rayfixture.h"

/* All of the plane z = 0.05 within the border of the patch of 4 x 4 facets: their corners stay, the middles of their sides are moved across them by `bend`. */
static void Bend(Patch *p, PetscReal bend)
{
  for (PetscInt n = 0; n < p->s.num_nodes; n++) {
    const PetscReal *u = p->u + 2 * n, a = sin(4 * PETSC_PI * u[0]), b = sin(4 * PETSC_PI * u[1]);

    p->x[3 * n]     = u[0] + (fabs(u[0] - 0.5) < 0.49 ? bend * b * b : 0);
    p->x[3 * n + 1] = u[1] - (fabs(u[1] - 0.5) < 0.49 ? bend * a * a : 0);
    p->x[3 * n + 2] = 0.05;
  }
  PatchFollow(p);
  memcpy(p->X, p->x, sizeof(PetscReal) * 3 * (size_t)p->s.num_nodes);
}

/* How far rays from the corners of segments leave the mortar facets they are given to. */
static PetscReal Beyond(ContactPair pair)
{
  const ContactSegment *s;
  PetscReal             most = 0;
  PetscInt              num;

  ContactPairGetSegments(pair, &num, &s);
  for (PetscInt i = 0; i < num; i++)
    for (PetscInt k = 0; k < s[i].num; k++)
      for (int c = 0; c < 2; c++) most = PetscMax(most, PetscAbsReal(s[i].eta[k][c]) - 1);
  return most;
}

/* Errors of area and weighted gaps of a flat nonmortar side within the mortar side's border. */
static void Check(PetscInt order, PetscInt mortar_order, PetscBool standard, PetscReal bend)
{
  static const PetscBool Refined[16] = {[1] = PETSC_TRUE, [5] = PETSC_TRUE, [7] = PETSC_TRUE, [10] = PETSC_TRUE};
  const ContactSpec      spec        = {.standard = standard};
  PetscReal              worst = 0, area = 0;
  Patch                  nonmortar, mortar;
  PetscInt               degenerate;
  ContactPair            pair;
  Sum                    s;

  PatchCreate(&nonmortar, 3, order, 3, 0.12, 0.9, PETSC_TRUE, PETSC_FALSE);
  for (PetscInt n = 0; n < nonmortar.s.num_nodes; n++)
    for (int c = 0; c < 3; c++) nonmortar.x[3 * n + c] = nonmortar.X[3 * n + c] = c < 2 ? nonmortar.u[2 * n + c] : 0;
  PatchRefined(&mortar, 3, mortar_order, 4, 0, 1, PETSC_FALSE, Refined);
  Bend(&mortar, bend);
  CHECK_CALL(ContactPairCreate(3, PETSC_FALSE, &spec, &pair));
  SearchAll(pair, &nonmortar, &mortar, 0.5, 1e-3);
  SumCreate(&s, &nonmortar, &mortar);
  SumEvaluate(&s, pair, &nonmortar, &mortar, NULL, PETSC_FALSE);
  degenerate = ContactPairGetDegenerate(pair);
  for (PetscInt j = 0; j < s.nn; j++) worst = PetscMax(worst, PetscAbsReal(s.gap[j] - 0.05 * s.weight[j]) / Largest(s.weight, s.nn));
  area = PetscAbsReal(s.area - 0.78 * 0.78);
  print_message("orders %d/%d, bent by %g: area off by %.1e, weighted gaps by %.1e, %d dropped, rays up to %.2f beyond\n", (int)order, (int)mortar_order,
                (double)bend, area, worst, (int)degenerate, Beyond(pair));
  assert_false(s.failed);
  assert_int_equal(degenerate, 0);
  assert_true(area < 1e-12);
  assert_true(Beyond(pair) < 1.1 * bend / 0.125 + 1e-12); /* from fine facets, whose sides are as straight as half of a coarse one's */
  assert_true(worst < 1e-12);
  SumDestroy(&s);
  PatchDestroy(&nonmortar);
  PatchDestroy(&mortar);
  CHECK_CALL(ContactPairDestroy(&pair));
}

static void test_bent(void **state)
{
  (void)state;
  for (PetscInt order = 1; order <= 3; order++)
    for (PetscInt mortar = 2; mortar <= 4; mortar++)
      for (int k = 0; k < 3; k++) Check(order, mortar, PETSC_TRUE, 0.017 * k);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_bent)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
