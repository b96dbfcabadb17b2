/* Directions of the estimate: a field that varies along one axis of the box marks its cells in that axis alone, along two in these two, however the cells' own
   axes lie; cells without a neighbour across an axis are split in it, too. Small kinematics, all sides prescribed, so that no boundary term stands in the way.
 */
#include "bulkfixture.h"
#include "estimateimpl.h"

/* u_c: the field at X of component c varies along the box axes in `axes`. */
static PetscReal Field(PetscInt axes, PetscInt c, const PetscReal X[3])
{
  PetscReal u = 0;
  for (PetscInt a = 0; a < 3; ++a) u += ((axes >> a) & 1) * 0.01 * PetscSinReal((1.3 + 0.4 * c) * X[a] + c);
  return u;
}

static void Along(Bulk *b, PetscInt dim, PetscInt axes, Estimate *e)
{
  const ForestTables *t;
  const HPTables     *v;
  PetscReal          *u, *eta2, (*along)[3];

  t = ForestGetTables(b->forest);
  v = HPSpaceGetTables(b->space);
  OK(PetscMalloc1(v->num_nodes * dim, &u));
  for (PetscInt i = 0; i < v->num_nodes * dim; ++i) u[i] = Field(axes, i % dim, v->X + 3 * (i / dim));
  OK(PetscCalloc1(t->num_leaves, &eta2));
  OK(PetscCalloc1(t->num_leaves, &along));
  EstimateSum sum = {.space = b->space, .mechanics = b->mechanics, .spec = &b->spec, .u = u, .eta2 = eta2, .along = along};
  OK(EstimateBulk_Private(&sum));
  OK(MPI_Allreduce(MPI_IN_PLACE, eta2, (PetscMPIInt)t->num_leaves, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(MPI_Allreduce(MPI_IN_PLACE, along, (PetscMPIInt)(3 * t->num_leaves), MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(PetscFree(u));
  *e = (Estimate){.num_leaves = t->num_leaves, .eta2 = eta2, .along = along};
}

/* n[3] cells, halved once when `refine`; all leaves are marked. expected: box axes. */
static void Marks(PetscInt dim, const PetscInt n[3], PetscInt refine, PetscInt order, uint64_t seed, PetscInt axes, PetscInt expected)
{
  const AdaptSpec     spec = {.fraction = 1, .max_cells = 100000, .anisotropic = PETSC_TRUE, .share = 1e-6, .aspect = 64};
  const ForestTables *t;
  Bulk                b = {0};
  Box                 box;
  Estimate            e;
  MarkList            marks;
  PetscInt            num;

  BulkInit(&b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_SMALL);
  BulkMaterial(&b.material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_DISPLACEMENT, 1, 2);
  for (PetscInt s = 0; s < 2 * dim; ++s) b.boundaries[s].fix[0] = b.boundaries[s].fix[1] = b.boundaries[s].fix[2] = PETSC_TRUE;
  b.forest = BoxForest(PETSC_COMM_WORLD, dim, n, 1, refine, seed, &box);
  BulkSetUp(&b, order, order);
  Along(&b, dim, axes, &e);
  t = ForestGetTables(b.forest);
  OK(EstimateMark(&e, &spec, b.forest, &marks, NULL, &num));
  assert_int_equal(num, t->num_leaves);
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    PetscInt split = 0;
    for (PetscInt s = 0; s < dim; ++s) split |= ((marks.split[l] >> s) & 1) << box.axis[t->leaf_root[l]][s];
    assert_int_equal(split, expected);
  }
  OK(MarkListDestroy(&marks));
  OK(EstimateDestroy(&e));
  BulkDestroy(&b);
}

static void Axes(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (PetscInt order = 1; order <= 3; ++order)
      for (PetscInt axes = 1; axes < 1 << dim; ++axes) Marks(dim, (const PetscInt[3]){3, 2, 2}, order < 3, order, (uint64_t)(7 * axes + order), axes, axes);
}

static void Doubt(void **state)
{
  for (PetscInt order = 1; order <= 2; ++order) {
    Marks(2, (const PetscInt[3]){4, 1, 1}, 0, order, 3, 1, 3);
    Marks(3, (const PetscInt[3]){4, 2, 1}, 0, order, 5, 1, 5);
    Marks(3, (const PetscInt[3]){4, 1, 1}, 0, order, 5, 1, 7);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Axes), cmocka_unit_test(Doubt)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
