/* The hp space on irregular meshes: hanging nodes, mixed orders, rotated cells (O-02's mesh part). Claims:
   - polynomial reproduction: nodal values of a field of degree r (the lowest order in play) at true nodes give that field in every cell;
   - continuity: any true values give the same trace from both sides of every facet, hanging or not;
   - the DM's default constraints fill hanging nodes with the same values as the rows, and distribute residuals by the transpose;
   - all that for orders 1 to 8 over the 24 proper rotations of the cells;
   - the same with orders of their own along each axis of a cell, and products of polynomials of these orders in the directions of a box;
   - as many true nodes as such products have coefficients;
   - without caps every entity has one order, that of the minimum rule with one number per entity;
   - numbering and positions do not depend on the number of ranks. */
#include "forest_box.h"
#include "hp.h"
#include "share.h"

#define MOST 729 /* nodes of a cell of order 8 in space */

static PetscInt hanging_entities[2][3]; /* vertices, edges and faces that hung, in the plane and in space */

static void RandomOrders(const ForestTables *t, PetscInt low, PetscInt high, int8_t **orders)
{
  OK(PetscMalloc1(t->num_leaves, orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) (*orders)[l] = (int8_t)(low + BoxRandom(high - low + 1));
}

static PetscReal Polynomial(PetscInt degree, PetscInt component, const PetscReal X[3])
{
  const PetscReal s = 0.3 * X[0] - 0.7 * X[1] + 0.4 * X[2] + 0.1 * component;
  PetscReal       v = 1;
  for (PetscInt i = 0; i < degree; ++i) v = v * s + X[component % 3] - 0.2;
  return v;
}

static void FillPolynomial(const HPTables *v, PetscInt degree, PetscReal *local)
{
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    for (PetscInt c = 0; c < v->dim; ++c) local[n * v->dim + c] = v->node_hang[n + 1] > v->node_hang[n] ? PETSC_MAX_REAL : Polynomial(degree, c, v->X + 3 * n);
  }
}

/* Interpolated field and position at random points of all cells. */
static PetscReal ReproductionError(HPSpace space, PetscInt degree)
{
  const HPTables *v;
  PetscReal      *local, values[3 * MOST], X[3 * MOST], N[MOST], error = 0;

  v = HPSpaceGetTables(space);
  OK(PetscMalloc1(v->num_nodes * v->dim, &local));
  FillPolynomial(v, degree, local);
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    const PetscInt p = v->cell_order[c], n = ElementNumNodes(v->dim, p);
    OK(HPSpaceGather(space, c, local, values));
    OK(HPSpaceGatherPositions(space, c, X));
    for (PetscInt k = 0; k < 5; ++k) {
      const PetscReal xi[3] = {BoxRandom(1000) / 999., BoxRandom(1000) / 999., BoxRandom(1000) / 999.};
      PetscReal       x[3] = {0, 0, 0}, f[3] = {0, 0, 0};
      OK(ElementEvaluate(v->dim, p, xi, N, NULL));
      for (PetscInt i = 0; i < n; ++i) {
        for (PetscInt a = 0; a < v->dim; ++a) {
          x[a] += N[i] * X[i * v->dim + a];
          f[a] += N[i] * values[i * v->dim + a];
        }
      }
      for (PetscInt a = 0; a < v->dim; ++a) error = PetscMax(error, PetscAbsReal(f[a] - Polynomial(degree, a, x)));
    }
  }
  OK(PetscFree(local));
  return error;
}

static void test_reproduction(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt seed = 0; seed < 6; ++seed) {
      for (PetscInt low = 1; low <= 2; ++low) {
        Forest              forest;
        const ForestTables *t;
        HPSpace             space;
        int8_t             *orders;
        forest = BoxRandomForest(dim, 1, dim == 2 ? 3 : 2, 5, (PetscBool)(seed % 2), seed);
        t      = ForestGetTables(forest);
        RandomOrders(t, low, 4, &orders);
        OK(HPSpaceCreate(forest, orders, NULL, 0, 0, &space));
        const PetscReal error = ReproductionError(space, low);
        if (!(error < 1e-11)) print_message("dim %d seed %d low %d: error %g\n", (int)dim, (int)seed, (int)low, (double)error);
        assert_true(error < 1e-11);
        OK(HPSpaceDestroy(&space));
        OK(PetscFree(orders));
        OK(ForestDestroy(&forest));
      }
    }
  }
}

/* Curved cells: linear fields of the *interpolated* position are reproduced on any mesh (isoparametric). */
static void test_reproduction_curved(void **state)
{
  for (PetscInt seed = 0; seed < 4; ++seed) {
    Forest              forest;
    const ForestTables *t;
    HPSpace             space;
    int8_t             *orders;
    forest = BoxRandomForest(2 + seed % 2, 2, 2, 5, PETSC_TRUE, seed);
    t      = ForestGetTables(forest);
    RandomOrders(t, 1, 4, &orders);
    OK(HPSpaceCreate(forest, orders, NULL, 0, 0, &space));
    const PetscReal error = ReproductionError(space, 1);
    if (!(error < 1e-11)) print_message("curved seed %d: error %g\n", (int)seed, (double)error);
    assert_true(error < 1e-11);
    OK(HPSpaceDestroy(&space));
    OK(PetscFree(orders));
    OK(ForestDestroy(&forest));
  }
}

/* A deterministic value for a true node, the same on every rank: a function of its position. */
static void FillRandom(const HPTables *v, PetscReal *local)
{
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    for (PetscInt c = 0; c < v->dim; ++c) local[n * v->dim + c] = PetscSinReal(37 * v->X[3 * n] + 91 * v->X[3 * n + 1] + 53 * v->X[3 * n + 2] + c);
  }
}

static int ByPlace(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;
  return x < y ? -1 : x > y;
}

/* Largest difference, over matching points, of the two fields that two leaves give on shared positions: cells are sampled on their faces, values
   are collected by position. */
static PetscReal ContinuityError(HPSpace space)
{
  const HPTables *v      = HPSpaceGetTables(space);
  const Forest    forest = HPSpaceGetForest(space);
  PetscReal      *local, values[3 * MOST], N[MOST], error = 0;

  OK(PetscMalloc1(v->num_nodes * v->dim, &local));
  FillRandom(v, local);
  PetscReal(*sample)[6];
  PetscInt num = 0;
  OK(PetscMalloc1(v->num_cells * 6 * 81, &sample));
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    const PetscInt n = ElementNumNodes(v->dim, v->cell_order[c]);
    OK(HPSpaceGather(space, c, local, values));
    for (PetscInt side = 0; side < 2 * v->dim; ++side) {
      for (PetscInt k = 0; k < (v->dim == 3 ? 81 : 9); ++k) {
        PetscReal xi[3] = {0, 0, 0}, X[3], f[3] = {0, 0, 0};
        for (PetscInt a = 0, j = k; a < v->dim; ++a) {
          if (a == side / 2)
            xi[a] = side % 2;
          else {
            xi[a] = (j % 9) / 8.;
            j /= 9;
          }
        }
        OK(ElementEvaluate(v->dim, v->cell_order[c], xi, N, NULL));
        for (PetscInt i = 0; i < n; ++i)
          for (PetscInt a = 0; a < v->dim; ++a) f[a] += N[i] * values[i * v->dim + a];
        OK(ForestMapPoint(forest, v->cell_leaf[c], xi, X));
        for (PetscInt a = 0; a < 3; ++a) {
          sample[num][a]     = X[a];
          sample[num][3 + a] = a < v->dim ? f[a] : 0;
        }
        ++num;
      }
    }
  }
  qsort(sample, (size_t)num, sizeof(*sample), ByPlace);
  for (PetscInt i = 0; i < num; ++i) {
    for (PetscInt j = i + 1; j < num && sample[j][0] - sample[i][0] < 1e-10; ++j) {
      if (PetscAbsReal(sample[i][1] - sample[j][1]) + PetscAbsReal(sample[i][2] - sample[j][2]) > 1e-10) continue;
      for (PetscInt a = 3; a < 6; ++a) error = PetscMax(error, PetscAbsReal(sample[i][a] - sample[j][a]));
    }
  }
  OK(PetscFree(sample));
  OK(PetscFree(local));
  return error;
}

static void test_continuity(void **state)
{
  for (PetscInt seed = 0; seed < 6; ++seed) {
    Forest              forest;
    const ForestTables *t;
    HPSpace             space;
    int8_t             *orders;
    forest = BoxRandomForest(2 + seed % 2, 1, seed % 2 ? 1 : 3, 5, (PetscBool)(seed >= 2), seed);
    t      = ForestGetTables(forest);
    RandomOrders(t, 1, 4, &orders);
    OK(HPSpaceCreate(forest, orders, NULL, seed == 5 ? 1 : 0, 0, &space));
    const PetscReal error = ContinuityError(space);
    if (!(error < 1e-11)) print_message("seed %d: jump %g\n", (int)seed, (double)error);
    assert_true(error < 1e-11);
    OK(HPSpaceDestroy(&space));
    OK(PetscFree(orders));
    OK(ForestDestroy(&forest));
  }
}

/* Orders 1 to 8 at random, all rotations, isotropic and anisotropic splits: reproduction of the lowest order's polynomials, and continuity. */
static void CheckRotation(PetscInt dim, PetscInt rotation)
{
  Forest              forest;
  const ForestTables *t;
  HPSpace             space;
  int8_t             *orders;
  PetscInt            hanging[3] = {0};

  box_rotation = rotation;
  forest       = BoxRandomForest(dim, 1, dim == 2 ? 4 : 1, 5, (PetscBool)(rotation % 3 > 0), (uint64_t)rotation);
  box_rotation = -1;
  t            = ForestGetTables(forest);
  RandomOrders(t, 1 + rotation % 2, 8, &orders);
  OK(HPSpaceCreate(forest, orders, NULL, rotation % 4 == 0, 0, &space));
  for (PetscInt e = 0; e < t->first[dim]; ++e) hanging[e < t->first[1] ? 0 : e < t->first[2] ? 1 : 2] += t->parent[e] >= 0;
  const PetscReal error = ReproductionError(space, rotation % 4 ? 1 + rotation % 2 : 1), jump = ContinuityError(space);
  if (!(error < 1e-11 && jump < 1e-11)) print_message("dim %d rotation %d: error %g, jump %g\n", (int)dim, (int)rotation, (double)error, (double)jump);
  assert_true(error < 1e-11 && jump < 1e-11);
  for (PetscInt d = 0; d < dim; ++d) hanging_entities[dim - 2][d] += hanging[d];
  OK(HPSpaceDestroy(&space));
  OK(PetscFree(orders));
  OK(ForestDestroy(&forest));
}

static void test_all_rotations(void **state)
{
  for (PetscInt rotation = 0; rotation < 24; ++rotation) {
    if (!Share(rotation, 5)) continue;
    CheckRotation(2, rotation);
    CheckRotation(3, rotation);
  }
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (PetscInt d = 0; d < dim; ++d) assert_true(hanging_entities[dim - 2][d] > (Whole() ? 100 : 20));
}

/* Random orders of cells and caps of their axes up to `high`, all rotations: polynomials of the lowest order in play, and continuity. */
static void CheckCaps(PetscInt dim, PetscInt rotation, PetscInt high)
{
  const PetscInt      low = 1 + rotation % 2;
  Forest              forest;
  const ForestTables *t;
  HPSpace             space;
  PetscBool           directional;
  int8_t             *orders, (*caps)[3];

  box_rotation = rotation;
  forest       = BoxRandomForest(dim, 1, dim == 2 ? 4 : 1, 5, (PetscBool)(rotation % 3 > 0), (uint64_t)rotation);
  box_rotation = -1;
  t            = ForestGetTables(forest);
  RandomOrders(t, low, high, &orders);
  OK(PetscMalloc1(t->num_leaves, &caps));
  for (PetscInt l = 0; l < t->num_leaves; ++l)
    for (PetscInt a = 0; a < 3; ++a) caps[l][a] = (int8_t)(low + BoxRandom(high + 1 - low));
  OK(HPSpaceCreate(forest, orders, caps, rotation % 4 == 0, 0, &space));
  OK(HPSpaceIsDirectional(space, &directional));
  assert_true(directional);
  const PetscReal error = ReproductionError(space, rotation % 4 ? low : 1), jump = ContinuityError(space);
  if (!(error < 1e-11 && jump < 1e-11)) print_message("caps, dim %d rotation %d: error %g, jump %g\n", (int)dim, (int)rotation, (double)error, (double)jump);
  assert_true(error < 1e-11 && jump < 1e-11);
  OK(HPSpaceDestroy(&space));
  OK(PetscFree(caps));
  OK(PetscFree(orders));
  OK(ForestDestroy(&forest));
}

static void test_caps(void **state)
{
  for (PetscInt rotation = 0; rotation < 24; ++rotation) {
    if (!Share(rotation, 5)) continue;
    CheckCaps(2, rotation, 4);
    CheckCaps(3, rotation, 4);
    CheckCaps(2, rotation, MORTISE_MAX_ORDER);
    if (rotation % 4 == 1) CheckCaps(3, rotation, MORTISE_MAX_ORDER);
  }
}

/* Degree of the product of polynomials in each direction of the box. */
static PetscInt product_degree[3];

static PetscReal Product(PetscInt component, const PetscReal X[3])
{
  PetscReal v = 1;
  for (PetscInt d = 0; d < 3; ++d)
    for (PetscInt k = 0; k < product_degree[d]; ++k) v *= 0.6 * X[d] - 0.3 * k + 0.1 * component - 0.4;
  return v;
}

/* Largest error at the lattice nodes of all cells when true nodes have the values of Product. */
static PetscReal ProductError(HPSpace space)
{
  const HPTables *v;
  PetscReal      *local, values[3 * MOST], X[3 * MOST], error = 0;

  v = HPSpaceGetTables(space);
  OK(PetscMalloc1(v->num_nodes * v->dim, &local));
  for (PetscInt n = 0; n < v->num_nodes; ++n)
    for (PetscInt c = 0; c < v->dim; ++c) local[n * v->dim + c] = v->node_hang[n + 1] > v->node_hang[n] ? PETSC_MAX_REAL : Product(c, v->X + 3 * n);
  for (PetscInt cell = 0; cell < v->num_cells; ++cell) {
    OK(HPSpaceGather(space, cell, local, values));
    OK(HPSpaceGatherPositions(space, cell, X));
    for (PetscInt i = 0; i < ElementNumNodes(v->dim, v->cell_order[cell]); ++i) {
      PetscReal x[3] = {0, 0, 0};
      for (PetscInt a = 0; a < v->dim; ++a) x[a] = X[i * v->dim + a];
      for (PetscInt a = 0; a < v->dim; ++a) error = PetscMax(error, PetscAbsReal(values[i * v->dim + a] - Product(a, x)));
    }
  }
  OK(PetscFree(local));
  OK(MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  return error;
}

/* True nodes of all ranks, each once. */
static PetscInt NumTrueNodes(HPSpace space, const ForestTables *t)
{
  const HPTables *v;
  PetscMPIInt     rank;
  PetscInt        num = 0;

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  v = HPSpaceGetTables(space);
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscInt e = v->node_entity[n];
    if (t->parent[e] < 0 && t->leaf_rank[t->entity_leaf[e]] == rank) ++num;
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &num, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  return num;
}

/* Cubes whose axes run along any directions of the box, orders degree[d] along direction d: products of these degrees, and no more, on regular meshes by the
   number of nodes (2 degree + 1 in each direction), on irregular ones by a product of one degree more, which is missed. */
static void CheckProducts(PetscInt dim, PetscInt rotation, PetscInt rounds)
{
  const PetscInt      degree[3] = {1 + rotation % 4, 1 + rotation / 4 % 4, dim == 2 ? 0 : 1 + (rotation / 2 + 2) % 4};
  Forest              forest;
  const ForestTables *t;
  HPSpace             space;
  PetscInt            highest = 0, num = 1;
  PetscReal           missed = PETSC_MAX_REAL;
  int8_t             *orders, (*caps)[3];

  box_rotation = rotation;
  forest       = BoxRandomForest(dim, 1, rounds, 5, (PetscBool)(rotation % 3 > 0), (uint64_t)rotation);
  box_rotation = -1;
  for (PetscInt d = 0; d < dim; ++d) {
    highest = PetscMax(highest, degree[d]);
    num *= 2 * degree[d] + 1;
  }
  t = ForestGetTables(forest);
  RandomOrders(t, highest, highest, &orders);
  OK(PetscMalloc1(t->num_leaves, &caps));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    for (PetscInt a = 0; a < dim; ++a) {
      PetscReal xi[3] = {0, 0, 0}, low[3], high[3];
      OK(ForestMapPoint(forest, l, xi, low));
      xi[a] = 1;
      OK(ForestMapPoint(forest, l, xi, high));
      for (PetscInt d = 0; d < dim; ++d)
        if (PetscAbsReal(high[d] - low[d]) > 1e-10) caps[l][a] = (int8_t)degree[d];
    }
  }
  OK(HPSpaceCreate(forest, orders, caps, 0, 0, &space));
  OK(PetscArraycpy(product_degree, degree, 3));
  const PetscReal error = ProductError(space);
  if (!(error < 1e-11)) print_message("products, dim %d rotation %d: error %g\n", (int)dim, (int)rotation, (double)error);
  assert_true(error < 1e-11);
  for (PetscInt d = 0; d < dim; ++d) { /* in a direction of the highest order the nodes are those of the cells, and interpolation is not checked by them */
    if (degree[d] == highest) continue;
    ++product_degree[d];
    missed = PetscMin(missed, ProductError(space));
    --product_degree[d];
  }
  assert_true(missed > 1e-8);
  if (rounds == 0) assert_int_equal(NumTrueNodes(space, t), num);
  OK(HPSpaceDestroy(&space));
  OK(PetscFree(caps));
  OK(PetscFree(orders));
  OK(ForestDestroy(&forest));
}

static void test_products(void **state)
{
  for (PetscInt rotation = 0; rotation < 24; ++rotation) {
    if (!Share(rotation, 5)) continue;
    CheckProducts(2, rotation, 0);
    CheckProducts(3, rotation, 0);
    CheckProducts(2, rotation, 3);
    CheckProducts(3, rotation, 1);
  }
}

/* The minimum rule with one number per entity: parts of a closure have at most its order, what hangs and what it hangs on share theirs. */
static PetscErrorCode ScalarRule(const ForestTables *t, const int8_t orders[], uint64_t linear, int8_t *order)
{
  for (PetscInt e = 0; e < t->num_entities; ++e)
    order[e] = e >= t->first[t->dim] ? orders[e - t->first[t->dim]] : t->boundary[e] & linear ? 1 : MORTISE_MAX_ORDER;
  for (PetscBool changed = PETSC_TRUE; changed;) {
    changed = PETSC_FALSE;
    for (PetscInt e = t->first[1]; e < t->num_entities; ++e) {
      const PetscInt n = e < t->first[2] ? 0 : e < t->first[3] ? 9 : 27, parent = t->parent[e];
      for (PetscInt i = 0; i < n; ++i) {
        const PetscInt part = t->closure[t->closure_offset[e] + i];
        if (part < t->first[1] || order[part] <= order[e]) continue;
        order[part] = order[e];
        changed     = PETSC_TRUE;
      }
      if (parent < 0 || order[parent] == order[e]) continue;
      order[parent] = order[e] = PetscMin(order[parent], order[e]);
      changed                  = PETSC_TRUE;
    }
  }
  return PETSC_SUCCESS;
}

static void test_isotropic(void **state)
{
  for (uint64_t seed = 0; seed < 24; ++seed) {
    if (!Share((PetscInt)seed, 5)) continue;
    const PetscInt      dim    = 2 + (PetscInt)(seed % 2);
    Forest              forest = BoxRandomForest(dim, 1, 2, 5, (PetscBool)(seed % 3 > 0), seed);
    const ForestTables *t;
    HPSpace             space;
    int8_t             *orders, *scalar;

    t = ForestGetTables(forest);
    RandomOrders(t, 1 + (PetscInt)(seed % 4), 8, &orders);
    OK(PetscMalloc1(t->num_entities, &scalar));
    OK(HPSpaceCreate(forest, orders, NULL, seed % 5, 0, &space));
    OK(ScalarRule(t, orders, seed % 5, scalar));
    for (PetscInt e = t->first[1]; e < t->num_entities; ++e) {
      PetscInt along[3], d = 1;
      while (e >= t->first[d + 1]) ++d;
      OK(HPSpaceGetAxisOrders(space, e, along));
      for (PetscInt a = 0; a < d; ++a) assert_int_equal(along[a], scalar[e]);
    }
    OK(HPSpaceDestroy(&space));
    OK(PetscFree(scalar));
    OK(PetscFree(orders));
    OK(ForestDestroy(&forest));
  }
}

/* The 24 proper rotations of a cube are there, each once; the 4 of a square. */
static void test_rotation_numbers(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    PetscInt seen[27] = {0};
    for (PetscInt k = 0; k < (dim == 2 ? 4 : 24); ++k) {
      PetscInt  axis[3], flip[3];
      PetscReal R[9] = {0};
      BoxRotationNumber(dim, k, axis, flip);
      for (PetscInt i = 0; i < 3; ++i) R[3 * axis[i] + i] = flip[i] ? -1 : 1;
      assert_true(Det3(R) > 0.5);
      const PetscInt name = (PetscInt)(R[0] + 2 * R[1] + 3 * R[2] + 6), other = (PetscInt)(R[3] + 2 * R[4] + 3 * R[5] + 6);
      for (PetscInt j = 0; j < k; ++j) assert_true(seen[j] != 100 * name + other + 1);
      seen[k] = 100 * name + other + 1;
    }
  }
}

/* Global-to-local fills hanging nodes from true ones, prescribed values included; local-to-global is its transpose. */
static void test_default_constraints(void **state)
{
  Forest              forest;
  const ForestTables *t;
  const HPTables     *v;
  HPSpace             space;
  int8_t             *orders, *fixed;
  DM                  dm;
  Vec                 g, l, r, rg;
  PetscReal          *a, lg, gl;

  forest = BoxRandomForest(2, 1, 3, 5, PETSC_FALSE, 7);
  t      = ForestGetTables(forest);
  RandomOrders(t, 1, 3, &orders);
  OK(HPSpaceCreate(forest, orders, NULL, 0, 0, &space));
  v = HPSpaceGetTables(space);
  OK(PetscCalloc1(v->num_nodes, &fixed));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    if (t->parent[v->node_entity[n]] < 0 && t->boundary[v->node_entity[n]] & 3) fixed[n] = t->boundary[v->node_entity[n]] & 1 ? 3 : 2;
  }
  OK(HPSpaceSetUp(space, fixed, 0, NULL, NULL));
  dm = HPSpaceGetDM(space);
  OK(DMCreateGlobalVector(dm, &g));
  OK(DMCreateLocalVector(dm, &l));
  OK(VecDuplicate(l, &r));
  OK(VecDuplicate(g, &rg));
  /* values: a bilinear field through true nodes; prescribed ones written first */
  OK(VecGetArray(l, &a));
  FillPolynomial(v, 1, a);
  OK(VecRestoreArray(l, &a));
  OK(DMLocalToGlobal(dm, l, INSERT_VALUES, g));
  OK(DMGlobalToLocal(dm, g, INSERT_VALUES, l));
  OK(VecGetArray(l, &a));
  for (PetscInt n = 0; n < v->num_nodes; ++n)
    for (PetscInt c = 0; c < 2; ++c) assert_true(PetscAbsReal(a[2 * n + c] - Polynomial(1, c, v->X + 3 * n)) < 1e-12);
  OK(VecRestoreArray(l, &a));
  /* adjoint: with zero prescribed values <r, G2L g> = <L2G r, g> */
  OK(VecSet(l, 0));
  OK(DMGlobalToLocal(dm, g, INSERT_VALUES, l));
  OK(VecGetArray(r, &a));
  for (PetscInt i = 0; i < 2 * v->num_nodes; ++i) a[i] = PetscCosReal(13.0 * i);
  OK(VecRestoreArray(r, &a));
  OK(VecDot(r, l, &lg));
  OK(MPI_Allreduce(MPI_IN_PLACE, &lg, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  OK(VecSet(rg, 0));
  OK(DMLocalToGlobal(dm, r, ADD_VALUES, rg));
  OK(VecDot(rg, g, &gl));
  assert_true(PetscAbsReal(lg - gl) < 1e-11 * (1 + PetscAbsReal(gl)));
  OK(VecDestroy(&g));
  OK(VecDestroy(&l));
  OK(VecDestroy(&r));
  OK(VecDestroy(&rg));
  OK(PetscFree(fixed));
  OK(PetscFree(orders));
  OK(HPSpaceDestroy(&space));
  OK(ForestDestroy(&forest));
}

/* P^T K P of the transform agrees with gather and scatter, frames included. */
static void test_transform(void **state)
{
  Forest              forest;
  const ForestTables *t;
  const HPTables     *v;
  HPSpace             space;
  int8_t             *orders;
  const PetscReal     c = PetscCosReal(0.3), s = PetscSinReal(0.3);

  forest = BoxRandomForest(2, 1, 3, 5, PETSC_TRUE, 7);
  t      = ForestGetTables(forest);
  RandomOrders(t, 1, 3, &orders);
  OK(HPSpaceCreate(forest, orders, NULL, 0, 0, &space));
  v = HPSpaceGetTables(space);
  PetscInt *node, num = 0;
  PetscReal(*frame)[9];
  OK(PetscMalloc2(v->num_nodes, &node, v->num_nodes, &frame));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    if (t->parent[v->node_entity[n]] >= 0 || !(t->boundary[v->node_entity[n]] & 4)) continue;
    const PetscReal q[9] = {c, s, 0, -s, c, 0, 0, 0, 1};
    node[num]            = n;
    OK(PetscArraycpy(frame[num++], q, 9));
  }
  OK(HPSpaceSetUp(space, NULL, num, node, (const PetscReal(*)[9])frame));
  PetscReal *x, *r1, *r2, K[32 * 32], Km[64 * 64], values[32], y[32];
  PetscInt   dofs[64], nd;
  OK(PetscMalloc3(2 * v->num_nodes, &x, 2 * v->num_nodes, &r1, 2 * v->num_nodes, &r2));
  for (PetscInt i = 0; i < 2 * v->num_nodes; ++i) x[i] = PetscSinReal(3.0 * i);
  for (PetscInt cell = 0; cell < v->num_owned_cells; ++cell) {
    const PetscInt n = 2 * ElementNumNodes(2, v->cell_order[cell]);
    for (PetscInt i = 0; i < n * n; ++i) K[i] = PetscCosReal(1.7 * i);
    OK(PetscArrayzero(r1, 2 * v->num_nodes));
    OK(PetscArrayzero(r2, 2 * v->num_nodes));
    OK(HPSpaceGather(space, cell, x, values));
    for (PetscInt i = 0; i < n; ++i) {
      y[i] = 0;
      for (PetscInt j = 0; j < n; ++j) y[i] += K[i * n + j] * values[j];
    }
    OK(HPSpaceScatterAdd(space, cell, y, r1));
    OK(HPSpaceTransformMatrix(space, cell, K, Km, dofs, &nd));
    assert_true(nd <= 64);
    for (PetscInt i = 0; i < nd; ++i)
      for (PetscInt j = 0; j < nd; ++j) r2[dofs[i]] += Km[i * nd + j] * x[dofs[j]];
    for (PetscInt i = 0; i < 2 * v->num_nodes; ++i) assert_true(PetscAbsReal(r1[i] - r2[i]) < 1e-11);
  }
  OK(PetscFree3(x, r1, r2));
  OK(PetscFree2(node, frame));
  OK(PetscFree(orders));
  OK(HPSpaceDestroy(&space));
  OK(ForestDestroy(&forest));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_reproduction),  cmocka_unit_test(test_reproduction_curved),
      cmocka_unit_test(test_continuity),    cmocka_unit_test(test_default_constraints),
      cmocka_unit_test(test_transform),     cmocka_unit_test(test_rotation_numbers),
      cmocka_unit_test(test_all_rotations), cmocka_unit_test(test_caps),
      cmocka_unit_test(test_products),      cmocka_unit_test(test_isotropic),
  };
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
