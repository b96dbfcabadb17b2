/* What ties surfaces (ContactPairTie): between two flat surfaces that do not match material points keep together under any polynomial of the facets' order;
   rows know nothing of a motion of both sides; functions of facets covered in part tell how much of them is. */
#include "rayfixture.h"

/* A motion of degree `order` at a place of the flat surfaces. */
static PetscReal Field(PetscInt order, const PetscReal u[2])
{
  return pow(0.3 + u[0], (double)order) - 0.7 * pow(0.2 + u[1], (double)order) + 0.4;
}

static void test_polynomials(void **state)
{
  const ContactSpec spec = {.law = CONTACT_TIED};

  (void)state;
  for (PetscInt dim = 2; dim <= 3; dim++)
    for (PetscInt order = 1; order <= (dim == 2 ? 5 : 3); order++)
      for (int part = 0; part < 2; part++) {
        const ContactFacet *facets;
        ContactPair         pair;
        Patch               a, b;
        PetscInt            num, partly = 0;
        PetscReal           area = 0, weight = 0;
        PetscBool           failed;

        PatchCreate(&a, dim, order, 2, 0, 1, dim == 3, (PetscBool)(dim == 3));
        PatchCreate(&b, dim, order, 3, part ? 0.13 : -0.2, 1.2, dim == 2, (PetscBool)(dim == 3));
        for (int side = 0; side < 2; side++) {
          Patch *p = side ? &b : &a;
          for (PetscInt n = 0; n < p->s.num_nodes; n++) {
            for (PetscInt c = 0; c < dim; c++) p->x[dim * n + c] = p->X[dim * n + c] = c < dim - 1 ? p->u[2 * n + c] : 0;
          }
        }
        CHECK_CALL(ContactPairCreate(dim, PETSC_FALSE, &spec, &pair));
        SearchAll(pair, &a, &b, 0.5, 0);
        CHECK_CALL(ContactPairTie(pair, &a.s, &b.s, &num, &facets, &failed));
        assert_false(failed);
        assert_true(num > 0);
        for (PetscInt f = 0; f < num; f++) {
          area += facets[f].area;
          for (PetscInt r = 0; r < facets[f].num_rows; r++) {
            PetscReal value = 0, sum = 0;
            for (PetscInt k = 0; k < facets[f].num; k++) {
              const PetscInt id = facets[f].nodes[k];
              value += facets[f].tie[r * facets[f].num + k] * Field(order, id < 0 ? b.u + 2 * ~id : a.u + 2 * id);
              sum += facets[f].tie[r * facets[f].num + k];
            }
            assert_near(value, 0, 1e-13);
            assert_near(sum, 0, 1e-14);
            weight += facets[f].weight[r];
            assert_true(part || fabs(facets[f].weight[r] - facets[f].whole[r]) < 1e-13);
            if (fabs(facets[f].weight[r] - facets[f].whole[r]) > 1e-3) partly++;
          }
        }
        assert_near(area, pow(part ? 0.87 : 1, (double)dim - 1), 1e-12);
        assert_near(weight, area, 1e-12);
        assert_true(part ? partly > 0 : partly == 0);
        CHECK_CALL(ContactPairEvaluate(pair, &a.s, &b.s, NULL, NULL, PETSC_FALSE, PETSC_FALSE, &num, &facets, &failed));
        assert_null(facets[0].tie);
        CHECK_CALL(ContactPairDestroy(&pair));
        PatchDestroy(&a), PatchDestroy(&b);
      }
}

/* Facets with a node that other pairs constrain, too, are compliant, tied or not: a traction that is constant is not seen. */
static void test_shared(void **state)
{
  const ContactSpec spec = {.law = CONTACT_TIED};

  (void)state;
  for (PetscInt dim = 2; dim <= 3; dim++)
    for (PetscInt order = 1; order <= 3; order++) {
      const ContactFacet *facets;
      ContactPair         pair;
      Patch               a, b;
      PetscInt            num, compliant = 0;
      PetscReal          *softness;
      PetscBool           failed, *shared;

      PatchCreate(&a, dim, order, 3, 0, 1, dim == 3, PETSC_FALSE);
      PatchCreate(&b, dim, order, 2, -0.2, 1.2, dim == 2, PETSC_FALSE);
      for (int side = 0; side < 2; side++) {
        Patch *p = side ? &b : &a;
        for (PetscInt n = 0; n < p->s.num_nodes; n++)
          for (PetscInt c = 0; c < dim; c++) p->x[dim * n + c] = p->X[dim * n + c] = c < dim - 1 ? p->u[2 * n + c] : 0;
      }
      CHECK_CALL(PetscMalloc1(a.s.num_nodes, &softness));
      CHECK_CALL(PetscCalloc1(a.s.num_nodes, &shared));
      for (PetscInt n = 0; n < a.s.num_nodes; n++) softness[n] = 0.5;
      CHECK_CALL(ContactPairCreate(dim, PETSC_FALSE, &spec, &pair));
      ContactPairSetSoftness(pair, softness);
      SearchAll(pair, &a, &b, 0.5, 0);
      CHECK_CALL(ContactPairTie(pair, &a.s, &b.s, &num, &facets, &failed));
      for (PetscInt f = 0; f < num; f++) assert_null(facets[f].compliance);
      shared[facets[0].nodes[0]] = PETSC_TRUE;
      ContactPairSetShared(pair, shared, PETSC_FALSE);
      CHECK_CALL(ContactPairTie(pair, &a.s, &b.s, &num, &facets, &failed));
      for (PetscInt f = 0; f < num; f++) {
        PetscReal sum = 0;
        PetscBool has = PETSC_FALSE;
        for (PetscInt r = 0; r < facets[f].num_rows; r++) has = (PetscBool)(has || shared[facets[f].nodes[r]]);
        assert_true(has == (facets[f].compliance != NULL));
        if (!has) continue;
        for (PetscInt r = 0; r < facets[f].num_rows; r++) sum += facets[f].compliance[r];
        assert_near(facets[f].kappa[0], 0.002 / (double)order, 1e-15);
        assert_near(sum, 0.5 * facets[f].area, 1e-13);
        compliant++;
      }
      assert_true(compliant > 0 && compliant < num);
      CHECK_CALL(ContactPairEvaluate(pair, &a.s, &b.s, NULL, NULL, PETSC_FALSE, PETSC_FALSE, &num, &facets, &failed));
      for (PetscInt f = 0; f < num; f++) {
        PetscBool has = PETSC_FALSE;
        for (PetscInt r = 0; r < facets[f].num_rows; r++) has = (PetscBool)(has || shared[facets[f].nodes[r]]);
        assert_true(has == (facets[f].compliance != NULL));
      }
      CHECK_CALL(ContactPairDestroy(&pair));
      CHECK_CALL(PetscFree(softness));
      CHECK_CALL(PetscFree(shared));
      PatchDestroy(&a), PatchDestroy(&b);
    }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_polynomials), cmocka_unit_test(test_shared)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
