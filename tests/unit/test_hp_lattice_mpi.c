/* Cells as they are drawn, on curved irregular meshes of mixed orders 1 to 8. Claims:
   - no gaps: two cells draw the same position and the same value wherever they meet, for any number of pieces; by their polynomials alone they would not;
   - where all cells have one order and none hangs every point of the lattice lies on the exact geometry and has the value of the polynomial. */
#include "forest_box.h"
#include "hp.h"

#define SAMPLES 9 /* places in each direction of a side */
#define MOST ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1))

typedef struct {
  PetscReal X[3], drawn[6]; /* exact place; position and value as drawn */
} Sample;

/* A deterministic value of every true node, the same on every rank. */
static PetscReal *Values(const HPTables *v)
{
  PetscReal *local;

  OK(PetscMalloc1(v->num_nodes * v->dim, &local));
  for (PetscInt n = 0; n < v->num_nodes; ++n)
    for (PetscInt c = 0; c < v->dim; ++c) local[n * v->dim + c] = PetscSinReal(3 * v->X[3 * n] + 4 * v->X[3 * n + 1] + 5 * v->X[3 * n + 2] + c);
  return local;
}

/* What the pieces of a cell show at xi. */
static void Drawn(PetscInt dim, PetscInt n, const PetscReal lattice[], const PetscReal xi[], PetscReal value[])
{
  PetscInt at[3] = {0, 0, 0};

  for (PetscInt a = 0; a < dim; ++a) at[a] = PetscMin(n - 1, (PetscInt)PetscFloorReal(n * xi[a]));
  for (PetscInt c = 0; c < dim; ++c) value[c] = 0;
  for (PetscInt corner = 0; corner < 1 << dim; ++corner) {
    PetscReal weight = 1;
    PetscInt  point = 0, stride = 1;
    for (PetscInt a = 0; a < dim; ++a, stride *= n + 1) {
      const PetscReal share = n * xi[a] - at[a];
      weight *= corner >> a & 1 ? share : 1 - share;
      point += stride * (at[a] + (corner >> a & 1));
    }
    for (PetscInt c = 0; c < dim; ++c) value[c] += weight * lattice[dim * point + c];
  }
}

/* Positions and values at the lattice by the polynomials alone. */
static void Polynomials(HPSpace space, PetscInt cell, PetscInt n, const PetscReal local[], PetscReal X[], PetscReal values[])
{
  const HPTables *v;
  PetscReal       nodal[2][3 * MOST], N[MOST];

  v = HPSpaceGetTables(space);
  OK(HPSpaceGatherPositions(space, cell, nodal[0]));
  OK(HPSpaceGather(space, cell, local, nodal[1]));
  for (PetscInt i = 0; i < ElementNumNodes(v->dim, n); ++i) {
    const PetscReal xi[3] = {(PetscReal)(i % (n + 1)) / n, (PetscReal)(i / (n + 1) % (n + 1)) / n, (PetscReal)(i / ((n + 1) * (n + 1))) / n};
    OK(ElementEvaluate(v->dim, v->cell_order[cell], xi, N, NULL));
    for (PetscInt c = 0; c < v->dim; ++c) {
      X[v->dim * i + c] = values[v->dim * i + c] = 0;
      for (PetscInt k = 0; k < ElementNumNodes(v->dim, v->cell_order[cell]); ++k) {
        X[v->dim * i + c] += N[k] * nodal[0][v->dim * k + c];
        values[v->dim * i + c] += N[k] * nodal[1][v->dim * k + c];
      }
    }
  }
}

static int Compare(const void *a, const void *b)
{
  const PetscReal x = ((const Sample *)a)->X[0], y = ((const Sample *)b)->X[0];
  return x < y ? -1 : x > y;
}

/* Largest distance between what two cells draw at one place of their sides. */
static PetscReal Gap(HPSpace space, PetscInt divide, PetscBool closed)
{
  static PetscReal X[3 * MOST], values[3 * MOST];
  PetscInt         pieces[MORTISE_MAX_ORDER + 1], num = 0, pairs = 0;
  const HPTables  *v;
  Forest           forest;
  Sample          *sample;
  PetscReal       *local, gap = 0;

  v      = HPSpaceGetTables(space);
  forest = HPSpaceGetForest(space);
  OK(HPSpacePieces(space, divide, pieces));
  local = Values(v);
  OK(PetscMalloc1(v->num_owned_cells * 6 * SAMPLES * SAMPLES, &sample));
  for (PetscInt cell = 0; cell < v->num_owned_cells; ++cell) {
    const PetscInt n = pieces[v->cell_order[cell]];
    if (closed)
      OK(HPSpaceLattice(space, cell, pieces, local, X, values));
    else
      Polynomials(space, cell, n, local, X, values);
    for (PetscInt k = 0; k < 2 * v->dim * (v->dim == 3 ? SAMPLES * SAMPLES : SAMPLES); ++k, ++num) {
      const PetscInt side = k % (2 * v->dim);
      PetscReal      xi[3];
      for (PetscInt a = 0, j = k / (2 * v->dim); a < v->dim; ++a) {
        xi[a] = a == side / 2 ? side % 2 : (PetscReal)(j % SAMPLES) / (SAMPLES - 1);
        if (a != side / 2) j /= SAMPLES;
      }
      OK(ForestMapPoint(forest, v->cell_leaf[cell], xi, sample[num].X));
      Drawn(v->dim, n, X, xi, sample[num].drawn);
      Drawn(v->dim, n, values, xi, sample[num].drawn + v->dim);
    }
  }
  qsort(sample, (size_t)num, sizeof(Sample), Compare);
  for (PetscInt i = 0; i < num; ++i) {
    for (PetscInt j = i + 1; j < num && sample[j].X[0] - sample[i].X[0] < 1e-9; ++j) {
      if (Distance(sample[i].X, sample[j].X) > 1e-9) continue;
      ++pairs;
      for (PetscInt a = 0; a < 2 * v->dim; ++a) gap = PetscMax(gap, PetscAbsReal(sample[i].drawn[a] - sample[j].drawn[a]));
    }
  }
  assert_true(pairs > num / 4 || v->num_owned_cells < 4);
  OK(PetscFree(sample));
  OK(PetscFree(local));
  OK(MPI_Allreduce(MPI_IN_PLACE, &gap, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  return gap;
}

/* Orders 1 to 8 at random, or one order everywhere; linear: faces of side 0 have order 1; capped: random caps of the orders along the axes of cells. */
static void CheckGaps(PetscInt dim, uint64_t seed, PetscInt low, PetscInt high, uint64_t linear, PetscBool capped)
{
  Forest              forest = BoxRandomForest(dim, 2, dim == 2 ? 5 : 2, dim == 2 ? 3 : 5, PETSC_TRUE, seed);
  const ForestTables *t;
  HPSpace             space;
  int8_t             *orders, (*caps)[3];

  t = ForestGetTables(forest);
  OK(PetscMalloc2(t->num_leaves, &orders, t->num_leaves, &caps));
  for (PetscInt l = 0; l < t->num_leaves; ++l) orders[l] = (int8_t)(low + BoxRandom(high - low + 1));
  for (PetscInt i = 0; i < 3 * t->num_leaves && capped; ++i) caps[i / 3][i % 3] = (int8_t)(1 + BoxRandom(high));
  OK(HPSpaceCreate(forest, orders, capped ? caps : NULL, linear, 0, &space));
  for (PetscInt divide = 0; divide <= 5; ++divide) {
    const PetscReal gap = Gap(space, divide, PETSC_TRUE);
    if (!(gap < 1e-11)) print_message("dim %d seed %d orders %d..%d divide %d: gap %g\n", (int)dim, (int)seed, (int)low, (int)high, (int)divide, (double)gap);
    assert_true(gap < 1e-11);
  }
  const PetscReal open = Gap(space, 0, PETSC_FALSE);
  if (!(open > 1e-4)) print_message("dim %d seed %d orders %d..%d: polynomials meet within %g\n", (int)dim, (int)seed, (int)low, (int)high, (double)open);
  assert_true(open > 1e-4);
  OK(HPSpaceDestroy(&space));
  OK(PetscFree2(orders, caps));
  OK(ForestDestroy(&forest));
}

static void test_no_gaps(void **state)
{
  for (uint64_t seed = 0; seed < 6; ++seed) {
    CheckGaps(2, seed, 1, 8, seed % 2, PETSC_FALSE);
    CheckGaps(2, seed, 3, 3, 0, PETSC_FALSE);
    CheckGaps(2, seed, 1, 8, seed % 2, PETSC_TRUE);
    CheckGaps(2, seed, 3, 3, 0, PETSC_TRUE);
  }
  CheckGaps(3, 1, 1, 5, 1, PETSC_FALSE);
  CheckGaps(3, 2, 3, 3, 0, PETSC_FALSE);
  CheckGaps(3, 3, 1, 5, 1, PETSC_TRUE);
  CheckGaps(3, 4, 4, 4, 0, PETSC_TRUE);
}

/* One order, no hanging nodes: on the exact geometry, with the polynomial's values. */
static void test_exact(void **state)
{
  static PetscReal X[3 * MOST], values[3 * MOST];

  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt p = 2; p <= MORTISE_MAX_ORDER; p += dim == 2 ? 1 : 3) {
      Forest              forest = BoxRandomForest(dim, 2, 0, 1, PETSC_FALSE, (uint64_t)p);
      const ForestTables *t;
      const HPTables     *v;
      HPSpace             space;
      int8_t             *orders;
      PetscInt            pieces[MORTISE_MAX_ORDER + 1];
      t = ForestGetTables(forest);
      OK(PetscMalloc1(t->num_leaves, &orders));
      for (PetscInt l = 0; l < t->num_leaves; ++l) orders[l] = (int8_t)p;
      OK(HPSpaceCreate(forest, orders, NULL, 0, 0, &space));
      v = HPSpaceGetTables(space);
      OK(HPSpacePieces(space, p == 2 ? 5 : 0, pieces));
      assert_int_equal(pieces[p], p == 2 ? 5 : p);
      PetscReal *local;
      OK(PetscMalloc1(v->num_nodes * dim, &local)); /* the position is a polynomial of degree 2 in each cell, so is this */
      for (PetscInt n = 0; n < v->num_nodes; ++n)
        for (PetscInt c = 0; c < dim; ++c) local[n * dim + c] = 1 + 2 * v->X[3 * n + c] - v->X[3 * n + (c + 1) % dim];
      for (PetscInt cell = 0; cell < v->num_owned_cells; ++cell) {
        const PetscInt n = pieces[p];
        OK(HPSpaceLattice(space, cell, pieces, local, X, values));
        for (PetscInt i = 0; i < ElementNumNodes(dim, n); ++i) {
          const PetscReal xi[3] = {(PetscReal)(i % (n + 1)) / n, (PetscReal)(i / (n + 1) % (n + 1)) / n, (PetscReal)(i / ((n + 1) * (n + 1))) / n};
          PetscReal       exact[3];
          OK(ForestMapPoint(forest, v->cell_leaf[cell], xi, exact));
          for (PetscInt c = 0; c < dim; ++c) {
            assert_true(PetscAbsReal(X[dim * i + c] - exact[c]) < 1e-12);
            assert_true(PetscAbsReal(values[dim * i + c] - (1 + 2 * exact[c] - exact[(c + 1) % dim])) < 1e-11);
          }
        }
      }
      OK(PetscFree(local));
      OK(HPSpaceDestroy(&space));
      OK(PetscFree(orders));
      OK(ForestDestroy(&forest));
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_no_gaps), cmocka_unit_test(test_exact)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
