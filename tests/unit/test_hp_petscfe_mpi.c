/* A field of the space in PETSc's own finite elements: what DMInterpolation makes of it is what the space's own functions say, and DMProjectField what the
   field's values say. Random distorted cells with random axes, hanging nodes, one order 1..4 and orders mixed, in the plane and in space. */
#include "bulkfixture.h"
#include "share.h"
#include <petscds.h>
#include <petscsnes.h>

/* Something that is no polynomial. */
static PetscReal Field(const PetscReal X[], PetscInt c)
{
  return PetscSinReal(0.3 + 1.7 * X[0] + 1.1 * X[1] + 0.7 * X[2] + (PetscReal)c);
}

/* Place of leaf l by the multilinear functions of its corners. */
static void Place(Forest forest, PetscInt dim, PetscInt leaf, const PetscReal xi[3], PetscReal X[3])
{
  PetscReal corner[3], at[3] = {0, 0, 0}, N[8];

  OK(ElementEvaluate(dim, 1, xi, N, NULL));
  X[0] = X[1] = X[2] = 0;
  for (PetscInt k = 0; k < 1 << dim; ++k) {
    for (PetscInt d = 0; d < dim; ++d) at[d] = k >> d & 1;
    OK(ForestMapPoint(forest, leaf, at, corner));
    for (PetscInt d = 0; d < dim; ++d) X[d] += N[k] * corner[d];
  }
}

/* The field at a place of a leaf by its owner, 0 elsewhere. */
static void Own(const Bulk *b, PetscInt leaf, const PetscReal xi[3], const PetscReal local[], PetscReal value[])
{
  const HPTables *v;
  PetscReal      *nodal, *N;

  v = HPSpaceGetTables(b->space);
  for (PetscInt d = 0; d < v->dim; ++d) value[d] = 0;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt n = ElementNumNodes(v->dim, v->cell_order[c]);
    if (v->cell_leaf[c] != leaf) continue;
    OK(PetscMalloc2(n * v->dim, &nodal, n, &N));
    OK(HPSpaceGather(b->space, c, local, nodal));
    OK(ElementEvaluate(v->dim, v->cell_order[c], xi, N, NULL));
    for (PetscInt i = 0; i < n * v->dim; ++i) value[i % v->dim] += N[i / v->dim] * nodal[i];
    OK(PetscFree2(nodal, N));
  }
}

/* DMInterpolation gives each rank the points in its cells, in their order: by position they are known again. */
static PetscInt Compare(DM dm, Vec x, PetscInt dim, PetscInt num, PetscReal X[], const PetscReal own[], PetscReal *error)
{
  DMInterpolationInfo context;
  const PetscReal    *at, *value;
  PetscInt            found = 0;
  Vec                 y;

  OK(DMInterpolationCreate(PETSC_COMM_WORLD, &context));
  OK(DMInterpolationSetDim(context, dim));
  OK(DMInterpolationSetDof(context, dim));
  OK(DMInterpolationAddPoints(context, num, X));
  OK(DMInterpolationSetUp(context, dm, PETSC_TRUE, PETSC_FALSE));
  OK(DMInterpolationGetVector(context, &y));
  OK(DMInterpolationEvaluate(context, dm, x, y));
  OK(VecGetArrayRead(context->coords, &at));
  OK(VecGetArrayRead(y, &value));
  for (PetscInt i = 0; i < context->n; ++i) {
    for (PetscInt k = 0; k < num; ++k) {
      PetscReal distance = 0;
      for (PetscInt d = 0; d < dim; ++d) distance += PetscAbsReal(at[i * dim + d] - X[k * dim + d]);
      if (distance > 1e-14) continue;
      ++found;
      for (PetscInt d = 0; d < dim; ++d) *error = PetscMax(*error, PetscAbsReal(value[i * dim + d] - own[k * dim + d]));
    }
  }
  OK(VecRestoreArrayRead(context->coords, &at));
  OK(VecRestoreArrayRead(y, &value));
  OK(DMInterpolationRestoreVector(context, &y));
  OK(DMInterpolationDestroy(&context));
  return found;
}

/* Twice the field, and one more. */
static void Twice(PetscInt dim, PetscInt num, PetscInt num_aux, const PetscInt offset[], const PetscInt offset_x[], const PetscScalar u[],
                  const PetscScalar u_t[], const PetscScalar u_x[], const PetscInt aux_offset[], const PetscInt aux_offset_x[], const PetscScalar a[],
                  const PetscScalar a_t[], const PetscScalar a_x[], PetscReal t, const PetscReal X[], PetscInt num_constants, const PetscScalar constants[],
                  PetscScalar value[])
{
  for (PetscInt d = 0; d < dim; ++d) value[d] = 2 * u[d] + 1;
}

/* Largest difference of PETSc's projection of that from its values. */
static PetscReal Project(DM dm, Vec global)
{
  PetscPointFunc twice[] = {Twice};
  PetscReal      error;
  Vec            projected;

  OK(DMCreateGlobalVector(dm, &projected));
  OK(DMProjectField(dm, 0, global, twice, INSERT_VALUES, projected));
  OK(VecAXPY(projected, -2, global));
  OK(VecShift(projected, -1));
  OK(VecNorm(projected, NORM_INFINITY, &error));
  OK(VecDestroy(&projected));
  return error;
}

static void Case(PetscInt dim, PetscInt low, PetscInt high, PetscInt seed)
{
  const PetscInt      n[3] = {2, 2, dim == 3 ? 2 : 1};
  const ForestTables *t;
  const HPTables     *v;
  Box                 box;
  Bulk                b = {0};
  PetscReal          *local, *X, *own, error = 0, projection;
  PetscInt            num, found;
  DM                  dm;
  Vec                 x, global;

  box_distorted = PETSC_TRUE;
  b.forest      = BoxForest(PETSC_COMM_WORLD, dim, n, 1, 0, (uint64_t)seed, &box);
  box_distorted = PETSC_FALSE;
  BulkRefine(&b.forest, dim, dim == 2 ? 2 : 1, PETSC_FALSE);
  BulkMaterial(&b.material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_DISPLACEMENT, 1, 2);
  BulkInit(&b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_SMALL);
  BulkSetUp(&b, low, high);
  v   = HPSpaceGetTables(b.space);
  t   = ForestGetTables(b.forest);
  num = t->num_leaves;
  OK(PetscMalloc3(v->num_nodes * dim, &local, num * dim, &X, num * dim, &own));
  for (PetscInt i = 0; i < v->num_nodes * dim; ++i) local[i] = Field(v->X + 3 * (i / dim), i % dim);
  for (PetscInt k = 0; k < num; ++k) {
    PetscReal xi[3], at[3];
    for (PetscInt d = 0; d < 3; ++d) xi[d] = 0.25 + 0.5 * (PetscReal)BoxRandom(1000) / 1000;
    Place(b.forest, dim, k, xi, at);
    for (PetscInt d = 0; d < dim; ++d) X[k * dim + d] = at[d];
    Own(&b, k, xi, local, own + k * dim);
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, own, (int)(num * dim), MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(HPSpaceCreateFE(b.space, "field", &dm));
  OK(DMCreateLocalVector(dm, &x));
  OK(DMCreateGlobalVector(dm, &global));
  OK(HPSpaceToFE(b.space, local, dm, x));
  OK(DMLocalToGlobal(dm, x, INSERT_VALUES, global)); /* and back: ghosts have what their owners have */
  OK(DMGlobalToLocal(dm, global, INSERT_VALUES, x));
  found = Compare(dm, x, dim, num, X, own, &error);
  OK(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  OK(MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  projection = Project(dm, global);
  print_message("dimension %d, orders %d to %d: %d points of %d, error %.1e, of the projection %.1e\n", (int)dim, (int)low, (int)high, (int)found, (int)num,
                (double)error, (double)projection);
  assert_int_equal(found, num);
  assert_true(error < 1e-12 && projection < 1e-12);
  OK(VecDestroy(&x));
  OK(VecDestroy(&global));
  OK(DMDestroy(&dm));
  OK(PetscFree3(local, X, own));
  BulkDestroy(&b);
}

static void Plane(void **state)
{
  for (PetscInt p = 1; p <= 4; ++p)
    if (Share(p + 2, 2)) Case(2, p, p, p);
  Case(2, 1, 4, 5);
}

static void Space(void **state)
{
  for (PetscInt p = 1; p <= 4; ++p)
    if (Share(p + 3, 2)) Case(3, p, p, p);
  Case(3, 1, 4, 5);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Plane), cmocka_unit_test(Space)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 2;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
