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

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_polynomials)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
