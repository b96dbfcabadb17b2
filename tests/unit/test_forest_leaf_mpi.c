/* The leaf mesh of each rank: valid for DMPlex, complete (ghost layer, parents), and owned alike by all. */
#include "forest_box.h"
#include <petscsf.h>

static Forest RefinedBox(PetscInt dim, const PetscInt n[3], PetscInt passes, PetscBool anisotropic, uint64_t seed, Box *box)
{
  Forest forest = BoxForest(PETSC_COMM_WORLD, dim, n, 2, 0, seed, box);

  for (PetscInt pass = 0; pass < passes; ++pass) {
    MarkList marks;
    BoxRandomMarks(dim, forest->tables.num_leaves, 4, anisotropic, &marks);
    AdaptBy(&forest, &marks);
  }
  return forest;
}

static void CheckPlex(DM dm)
{
  OK(DMPlexCheckSymmetry(dm));
  OK(DMPlexCheckSkeleton(dm, 0));
  OK(DMPlexCheckFaces(dm, 0));
  OK(DMPlexCheckPointSF(dm, NULL, PETSC_FALSE));
  OK(DMPlexCheckGeometry(dm));
}

/* Every entity of the chart once; owned cells first; the closure, the parent, and all leaves around an owned leaf are there. */
static void CheckChart(Forest forest, DM dm, PetscInt num_owned, PetscInt num_points, const PetscInt point_entity[])
{
  const ForestTables *t = &forest->tables;
  const PetscInt      n = ForestPow3[t->dim], cells = t->first[t->dim];
  PetscInt           *point, start, end, total = 0;
  PetscMPIInt         rank;

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  OK(DMPlexGetChart(dm, &start, &end));
  assert_int_equal(start, 0);
  assert_int_equal(end, num_points);
  OK(PetscMalloc1(t->num_entities, &point));
  for (PetscInt e = 0; e < t->num_entities; ++e) point[e] = -1;
  for (PetscInt p = 0; p < num_points; ++p) {
    assert_int_equal(point[point_entity[p]], -1);
    point[point_entity[p]] = p;
    assert_int_equal(p < num_owned, point_entity[p] >= cells && t->leaf_rank[point_entity[p] - cells] == rank);
  }
  for (PetscInt p = 0; p < num_points; ++p) {
    const PetscInt e = point_entity[p], last = e + 1 < t->num_entities ? t->closure_offset[e + 1] : t->closure_offset[e] + n;
    for (PetscInt i = t->closure_offset[e]; i < last; ++i) assert_true(point[t->closure[i]] >= 0);
    if (t->parent[e] >= 0) assert_true(point[t->parent[e]] >= 0);
  }
  for (PetscInt l = 0; l < t->num_leaves; ++l)
    for (PetscInt m = 0; m < t->num_leaves && t->leaf_rank[l] == rank; ++m)
      for (PetscInt i = 0; i < n; ++i)
        for (PetscInt k = 0; k < n; ++k)
          if (t->closure[t->closure_offset[cells + l] + i] == t->closure[t->closure_offset[cells + m] + k]) assert_true(point[cells + m] >= 0);
  OK(MPI_Allreduce(&num_owned, &total, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_int_equal(total, t->num_leaves);
  OK(PetscFree(point));
}

/* Roots are where entity_leaf says, under the number the owner itself uses: the owner's entity arrives at every copy. */
static void CheckSF(Forest forest, DM dm, PetscInt num_points, const PetscInt point_entity[])
{
  PetscSF     sf;
  PetscInt   *received, num_leaves, ghosts = 0;
  PetscMPIInt rank;

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  OK(DMGetPointSF(dm, &sf));
  OK(PetscMalloc1(num_points, &received));
  for (PetscInt p = 0; p < num_points; ++p) {
    const PetscBool mine = (PetscBool)(forest->tables.leaf_rank[forest->tables.entity_leaf[point_entity[p]]] == rank);
    received[p]          = mine ? point_entity[p] : -1;
    ghosts += !mine;
  }
  OK(PetscSFGetGraph(sf, NULL, &num_leaves, NULL, NULL));
  assert_int_equal(num_leaves, ghosts);
  OK(PetscSFBcastBegin(sf, MPIU_INT, point_entity, received, MPI_REPLACE));
  OK(PetscSFBcastEnd(sf, MPIU_INT, point_entity, received, MPI_REPLACE));
  for (PetscInt p = 0; p < num_points; ++p) assert_int_equal(received[p], point_entity[p]);
  OK(PetscFree(received));
}

/* Labels of the sides and vertex positions as DMPlex returns them; the sum of the owned cells' straight volumes. */
static void CheckLabels(Forest forest, DM dm, PetscInt num_points, const PetscInt point_entity[])
{
  const ForestTables *t = &forest->tables;
  PetscInt            value;

  for (PetscInt b = 0; b < 2 * t->dim; ++b)
    for (PetscInt p = 0; p < num_points; ++p) {
      const PetscInt  e     = point_entity[p];
      const PetscBool facet = (PetscBool)(e >= t->first[t->dim - 1] && e < t->first[t->dim]);
      OK(DMGetLabelValue(dm, forest->coarse->mesh.boundary_name[b], p, &value));
      assert_int_equal(value, facet && ((t->boundary[e] >> b) & 1) ? 1 : -1);
    }
  for (PetscInt p = 0; p < num_points; ++p) {
    OK(DMGetLabelValue(dm, "body", p, &value));
    assert_int_equal(value, point_entity[p] >= t->first[t->dim] ? 0 : -1);
  }
}

static void CheckCoordinates(Forest forest, DM dm, const PetscInt point_entity[])
{
  PetscSection       section;
  Vec                coordinates;
  const PetscScalar *x;
  PetscInt           start, end, offset;
  const PetscReal    none[3] = {0};

  OK(DMGetCoordinateSection(dm, &section));
  OK(DMGetCoordinatesLocal(dm, &coordinates));
  OK(DMPlexGetDepthStratum(dm, 0, &start, &end));
  OK(VecGetArrayRead(coordinates, &x));
  for (PetscInt v = start; v < end; ++v) {
    PetscReal X[3];
    EntityPoint(forest, point_entity[v], none, X);
    OK(PetscSectionGetOffset(section, v, &offset));
    for (PetscInt a = 0; a < forest->tables.dim; ++a) assert_true(PetscAbsReal(X[a] - PetscRealPart(x[offset + a])) < 1e-13);
  }
  OK(VecRestoreArrayRead(coordinates, &x));
}

static void CheckForest(Forest forest)
{
  PetscInt        num_owned, num_points;
  const PetscInt *point_entity;
  DM              dm, again;

  OK(ForestGetLeafDM(forest, &dm, &num_owned, &num_points, &point_entity));
  OK(ForestGetLeafDM(forest, &again, NULL, NULL, NULL));
  assert_ptr_equal(dm, again);
  CheckPlex(dm);
  CheckChart(forest, dm, num_owned, num_points, point_entity);
  CheckSF(forest, dm, num_points, point_entity);
  CheckLabels(forest, dm, num_points, point_entity);
  CheckCoordinates(forest, dm, point_entity);
}

static void test_leaf_2d(void **state)
{
  for (uint64_t seed = 0; seed < 4; ++seed) {
    Box    box;
    Forest forest = RefinedBox(2, (const PetscInt[3]){3, 2, 1}, 4, (PetscBool)(seed % 2), seed, &box);
    CheckForest(forest);
    OK(ForestDestroy(&forest));
  }
}

static void test_leaf_3d(void **state)
{
  for (uint64_t seed = 0; seed < 4; ++seed) {
    Box    box;
    Forest forest = RefinedBox(3, (const PetscInt[3]){2, 2, 2}, 3, (PetscBool)(seed % 2), seed, &box);
    CheckForest(forest);
    OK(ForestDestroy(&forest));
  }
}

/* Fewer leaves than ranks: the last ranks have nothing. */
static void test_empty_rank(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    Box    box;
    Forest forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){1, 1, 1}, 1, 0, 1, &box);
    CheckForest(forest);
    OK(ForestDestroy(&forest));
  }
}

/* METIS: balance by weight; a coupling keeps far cells together when it is all there is to cut. */
static void test_partition(void **state)
{
  Box            box;
  Forest         forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){4, 4, 1}, 1, 2, 3, &box), next;
  const PetscInt n      = forest->tables.num_leaves;
  PetscReal     *weight, load[64] = {0}, total = 0;
  MarkList       marks;
  ForestMap      map;
  PetscMPIInt    size;

  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  OK(PetscMalloc1(n, &weight));
  for (PetscInt l = 0; l < n; ++l) total += weight[l] = l < n / 4 ? 20 : 1;
  BoxRandomMarks(2, n, 1000000, PETSC_FALSE, &marks);
  for (PetscInt l = 0; l < n; ++l) marks.split[l] = 0;
  OK(ForestAdapt(forest, &marks, weight, 0, NULL, &next, &map));
  assert_int_equal(next->tables.num_leaves, n);
  for (PetscInt l = 0; l < n; ++l) load[next->tables.leaf_rank[l]] += weight[l];
  for (PetscMPIInt r = 0; r < size; ++r) assert_true(PetscAbsReal(load[r] - total / size) < 0.06 * total / size);
  OK(PetscFree(weight));
  MarksDestroy(&marks);
  OK(ForestMapDestroy(&map));
  OK(ForestDestroy(&forest));
  OK(ForestDestroy(&next));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_leaf_2d), cmocka_unit_test(test_leaf_3d), cmocka_unit_test(test_empty_rank),
                                     cmocka_unit_test(test_partition)};
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
