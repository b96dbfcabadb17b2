/* A kink of the displacement across x = 1 with hanging facets on it: eta^2 of every leaf by hand.
   Box [0,2] x [0,1] (x [0,1]); the left cell is split, the right one is not. Small kinematics, mu = 1, lambda = 0, u = (a x, 0, 0) left, slope b right:
   the traction jumps by 2 mu (a-b) along x, so |[P N]|^2 = 4 d^2, d = a-b. Left leaves have h = 1/2, the right one h = 1 (it sees all its small facets):
     isotropic: a left leaf at the kink 1/2 * 1/2 * 4 d^2 * A (A: its facet's area, 1/2 or 1/4), the right leaf 1/2 * 1 * 4 d^2 * 1;
     split in y only: left leaves have height 1 over the kink: 1/2 * 1 * 4 d^2 * 1/2.  All times scale / (p m). */
#include "bulkfixture.h"
#include "estimateimpl.h"

static void Kink(PetscInt dim, PetscInt order, PetscBool anisotropic, uint64_t seed)
{
  const PetscReal     a = 0.3, slope = 0.1, d2 = PetscSqr(a - slope);
  Bulk                b = {0};
  Box                 box;
  MarkList            marks;
  const ForestTables *t;
  const HPTables     *v;
  EstimateSum         sum;
  PetscReal          *u, *eta2, jumps = 0;

  BulkInit(&b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_SMALL);
  BulkMaterial(&b.material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_DISPLACEMENT, 1, 2. / 3);
  for (PetscInt s = 0; s < 2 * dim; ++s) b.boundaries[s].fix[0] = b.boundaries[s].fix[1] = b.boundaries[s].fix[2] = PETSC_TRUE;
  b.forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 1, 1}, 1, 0, seed, &box);
  t        = ForestGetTables(b.forest);
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    if (t->leaf_root[l] != 0) continue;
    for (PetscInt s = 0; s < dim; ++s) marks.split[l] |= (int8_t)(!anisotropic || box.axis[0][s] == 1 ? 1 << s : 0);
  }
  AdaptBy(&b.forest, &marks);
  BulkSetUp(&b, order, order);
  t = ForestGetTables(b.forest);
  v = HPSpaceGetTables(b.space);
  OK(PetscCalloc1(v->num_nodes * dim, &u));
  for (PetscInt n = 0; n < v->num_nodes; ++n) u[n * dim] = v->X[3 * n] < 1 ? a * v->X[3 * n] : a + slope * (v->X[3 * n] - 1);
  OK(PetscCalloc1(t->num_leaves, &eta2));
  sum = (EstimateSum){.space = b.space, .mechanics = b.mechanics, .spec = &b.spec, .u = u, .eta2 = eta2};
  OK(EstimateBulk_Private(&sum));
  OK(MPI_Allreduce(MPI_IN_PLACE, eta2, (PetscMPIInt)t->num_leaves, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  const PetscReal factor = EstimateScale_Private(order) / (order * PetscSqrtReal(2)); /* modulus sqrt(mu (kappa + 4/3 mu)) = sqrt(2) */
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    int64_t   lo[3], hi[3];
    PetscReal expected = 0;
    BoxLeaf(&box, t, l, lo, hi);
    if (lo[0] == FOREST_ONE)
      expected = 2 * d2;
    else if (hi[0] == FOREST_ONE)
      expected = anisotropic ? d2 : dim == 2 ? 0.5 * d2 : 0.25 * d2;
    assert_near(eta2[l], factor * expected, 1e-14);
    jumps += eta2[l];
  }
  assert_near(jumps, factor * (anisotropic ? 4 : 3) * d2, 1e-14);
  OK(PetscFree(u));
  OK(PetscFree(eta2));
  BulkDestroy(&b);
}

static void HangingFacets(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (PetscInt order = 1; order <= 3; ++order)
      for (uint64_t seed = 0; seed < 4; ++seed) Kink(dim, order, PETSC_FALSE, seed);
}

static void AnisotropicSplit(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (uint64_t seed = 0; seed < 4; ++seed) Kink(dim, 1, PETSC_TRUE, seed);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(HangingFacets), cmocka_unit_test(AnisotropicSplit)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
