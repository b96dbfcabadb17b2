/* Transfer on straight cells: polynomials of degree p survive refinement, coarsening, both at once with repartition, orders that rise and fall, mixed orders,
   along the axes of a cell too, and skew frames, on any number of ranks, to 1e-12; pressures of degree p-1 likewise; any function of the space does when orders
   rise; a merged cell's pressure is the L2 projection (its mean is the children's mean). */
#include "bulkfixture.h"
#include "share.h"
#include "transferimpl.h"

static PetscReal Polynomial(PetscInt degree, PetscInt component, const PetscReal X[3])
{
  const PetscReal s = 0.3 * X[0] - 0.7 * X[1] + 0.4 * X[2] + 0.1 * component;
  PetscReal       v = 1;
  for (PetscInt i = 0; i < degree; ++i) v = v * s + X[component % 3] - 0.2;
  return v;
}

/* Dofs of the polynomial at true nodes; hanging entries are poisoned. */
static void FillDisplacement(const Bulk *b, PetscInt degree, PetscReal **u)
{
  const HPTables *v;

  v = HPSpaceGetTables(b->space);
  OK(PetscMalloc1(v->num_nodes * v->dim, u));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal *frame;
    OK(HPSpaceGetFrame(b->space, n, &frame));
    for (PetscInt c = 0; c < v->dim; ++c) {
      PetscReal value = frame ? 0 : Polynomial(degree, c, v->X + 3 * n);
      for (PetscInt k = 0; frame && k < v->dim; ++k) value += frame[3 * c + k] * Polynomial(degree, k, v->X + 3 * n);
      (*u)[n * v->dim + c] = v->node_hang[n + 1] > v->node_hang[n] ? PETSC_MAX_REAL : value;
    }
  }
}

/* Positions of a cell's points from its nodes. */
static void Positions(HPSpace space, PetscInt cell, PetscInt dim, PetscInt order, PetscInt np, const PetscReal xi[], PetscReal (*X)[3])
{
  PetscReal nodes[3 * 125], N[125];

  OK(HPSpaceGatherPositions(space, cell, nodes));
  for (PetscInt q = 0; q < np; ++q) {
    OK(ElementEvaluate(dim, order, xi + q * dim, N, NULL));
    X[q][0] = X[q][1] = X[q][2] = 0;
    for (PetscInt i = 0; i < ElementNumNodes(dim, order); ++i)
      for (PetscInt c = 0; c < dim; ++c) X[q][c] += N[i] * nodes[i * dim + c];
  }
}

/* Pressure coefficients of the polynomial of degree order-1 of each cell (order: lowest of all, so that it fits in merged cells too). */
static void FillPressure(const Bulk *b, PetscInt degree, PetscReal **pressure)
{
  const HPTables *v;
  PetscInt        num;

  v = HPSpaceGetTables(b->space);
  OK(MechanicsNumPressure(b->mechanics, &num));
  OK(PetscMalloc1(num, pressure));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscReal xi[3 * 125], X[125][3], values[125], weights[125];
    PetscInt  first, m, np = ElementNumNodes(v->dim, 4);
    for (PetscInt q = 0; q < np; ++q) {
      for (PetscInt d = 0, i = q; d < v->dim; ++d, i /= 5) xi[q * v->dim + d] = (0.5 + i % 5) / 5;
      weights[q] = 1;
    }
    Positions(b->space, c, v->dim, v->cell_order[c], np, xi, X);
    for (PetscInt q = 0; q < np; ++q) values[q] = Polynomial(degree, 2, X[q]);
    OK(MechanicsPressureRange(b->mechanics, c, &first, &m));
    OK(MechanicsPressureProject(v->dim, v->cell_order[c], np, xi, weights, values, *pressure + first));
  }
}

static PetscReal PressureError(const Bulk *b, PetscInt degree, const PetscReal pressure[])
{
  const HPTables *v;
  PetscReal       error = 0;

  v = HPSpaceGetTables(b->space);
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscReal xi[9] = {0.1, 0.7, 0.3, 0.9, 0.2, 0.8, 0, 1, 0.5}, X[3][3], values[3];
    PetscInt  first, m;
    OK(MechanicsPressureRange(b->mechanics, c, &first, &m));
    Positions(b->space, c, v->dim, v->cell_order[c], 3, xi, X);
    OK(MechanicsPressureEvaluate(v->dim, v->cell_order[c], 3, xi, pressure + first, values));
    for (PetscInt q = 0; q < 3; ++q) error = PetscMax(error, PetscAbsReal(values[q] - Polynomial(degree, 2, X[q])));
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  return error;
}

/* Largest difference at true nodes that this rank owns. */
static PetscReal DisplacementError(const Bulk *b, PetscInt degree, const PetscReal u[])
{
  const HPTables     *v;
  const ForestTables *t;
  PetscReal          *exact, error = 0;
  PetscMPIInt         rank;

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  v = HPSpaceGetTables(b->space);
  t = ForestGetTables(b->forest);
  FillDisplacement(b, degree, &exact);
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscInt e = v->node_entity[n];
    for (PetscInt c = 0; c < v->dim && t->parent[e] < 0 && t->leaf_rank[t->entity_leaf[e]] == rank; ++c)
      error = PetscMax(error, PetscAbsReal(u[n * v->dim + c] - exact[n * v->dim + c]));
  }
  OK(PetscFree(exact));
  OK(MPI_Allreduce(MPI_IN_PLACE, &error, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  return error;
}

/* A roller on x = 1 in a slightly tilted world would need a tilted box; any frames do for the transfer: every node of side 3 gets one. */
static void Setting(Bulk *b, PetscInt dim)
{
  *b = (Bulk){0};
  BulkInit(b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
  BulkMaterial(&b->material, "neo_hookean", VOLUMETRIC_QUADRATIC, FORMULATION_MIXED, 1, 100);
}

static PetscInt lowest_cap; /* random caps of the orders along each axis, this or one more; 0: none */

static void Frames(Bulk *b, PetscInt dim)
{
  int8_t(*caps)[3] = NULL;
  const HPTables     *v;
  const ForestTables *t;

  t = ForestGetTables(b->forest);
  if (lowest_cap) OK(PetscMalloc1(t->num_leaves, &caps));
  for (PetscInt i = 0; caps && i < 3 * t->num_leaves; ++i) caps[i / 3][i % 3] = (int8_t)(lowest_cap + BoxRandom(2));
  OK(HPSpaceCreate(b->forest, b->orders, caps, 0, 0, &b->space));
  OK(PetscFree(caps));
  v = HPSpaceGetTables(b->space);
  OK(PetscCalloc1(v->num_nodes, &b->supports.fixed));
  OK(PetscMalloc2(v->num_nodes, &b->supports.frame_node, v->num_nodes, &b->supports.frame));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal c = PetscCosReal(0.3 + v->X[3 * n]), s = PetscSinReal(0.3 + v->X[3 * n]), frame[9] = {c, s, 0, -s, c, 0, 0, 0, 1};
    if (t->parent[v->node_entity[n]] >= 0 || !(t->boundary[v->node_entity[n]] & 8)) continue;
    b->supports.frame_node[b->supports.num_frames] = n;
    OK(PetscArraycpy(b->supports.frame[b->supports.num_frames++], frame, 9));
  }
  OK(HPSpaceSetUp(b->space, b->supports.fixed, b->supports.num_frames, b->supports.frame_node, (const PetscReal(*)[9])b->supports.frame));
  OK(MechanicsCreate(b->space, &b->spec, &b->supports, &b->mechanics));
}

static PetscInt num_lowered, num_raised, num_merged[3], num_refined[3]; /* new leaves, by mode: the test is only worth something when both occur */

/* From one bulk to the next by the marks; checks and replaces. mode: 0 refine, 1 coarsen, 2 both; weights shift the partition. */
static void Step(Bulk *from, Bulk *to, PetscInt dim, PetscInt degree, PetscInt mode, uint64_t seed)
{
  TransferContext     c = {.old_space = from->space, .old_mechanics = from->mechanics, .spec = &from->spec};
  OldCells            old;
  const ForestTables *t;
  const HPTables     *v;
  MarkList            marks;
  ForestMap           map;
  PetscReal          *u, *pressure, *weight, *new_u, *new_pressure;
  PetscInt            num;

  t = ForestGetTables(from->forest);
  BoxRandomMarks(dim, t->num_leaves, mode == 1 ? 1000000 : 3, (PetscBool)(seed % 2), &marks);
  OK(PetscMalloc1(t->num_leaves, &weight));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    if (mode) marks.coarsen[l] = !marks.split[l];
    weight[l] = 1 + 5 * BoxRandom(2);
  }
  Setting(to, dim);
  OK(ForestAdapt(from->forest, &marks, weight, 0, NULL, &to->forest, &map));
  OK(TransferOrders(&map, from->orders, &to->orders));
  for (PetscInt l = 0; l < map.num && seed == 3; ++l) {
    to->orders[l] = (int8_t)(degree + BoxRandom(2));
    num_lowered += to->orders[l] < from->orders[map.old_first[l]];
    num_raised += to->orders[l] > from->orders[map.old_first[l]];
  }
  for (PetscInt l = 0; l < map.num; ++l) {
    num_merged[mode] += map.old_count[l] > 1;
    if (l && map.old_first[l] == map.old_first[l - 1]) num_refined[mode]++;
    for (PetscInt k = map.old_first[l]; seed < 3 && k < map.old_first[l] + map.old_count[l]; ++k) assert_true(to->orders[l] >= from->orders[k]);
  }
  Frames(to, dim);
  FillDisplacement(from, degree, &u);
  FillPressure(from, degree - 1, &pressure);
  c.new_space     = to->space;
  c.new_mechanics = to->mechanics;
  c.map           = &map;
  OK(TransferContextSetUp_Private(&c));
  OK(OldCellsFetch_Private(&c, &(OldFields){.u = u, .pressure = pressure}, &old));
  v = HPSpaceGetTables(to->space);
  OK(MechanicsNumPressure(to->mechanics, &num));
  OK(PetscCalloc1(v->num_nodes * dim, &new_u));
  OK(PetscCalloc1(num, &new_pressure));
  OK(TransferDisplacement_Private(&c, &old, new_u));
  OK(TransferPressure_Private(&c, &old, new_pressure, NULL));
  const PetscReal displacement = DisplacementError(to, degree, new_u), of_pressure = PressureError(to, degree - 1, new_pressure);
  if (!(displacement < 1e-12) || !(of_pressure < 1e-12))
    fail_msg("dim %d degree %d mode %d seed %d: u %g, pressure %g", (int)dim, (int)degree, (int)mode, (int)seed, (double)displacement, (double)of_pressure);
  OK(OldCellsDestroy_Private(&old));
  MarksDestroy(&marks);
  OK(ForestMapDestroy(&map));
  OK(PetscFree(u));
  OK(PetscFree(pressure));
  OK(PetscFree(weight));
  OK(PetscFree(new_u));
  OK(PetscFree(new_pressure));
}

static void Polynomials(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (PetscInt degree = 1; degree <= 3; ++degree) {
      for (uint64_t seed = 0; seed < 6; ++seed) {
        const PetscInt modes[] = {0, 2, 1};
        if (!Share(dim + degree + (PetscInt)seed, 2)) continue;
        lowest_cap = seed < 4 ? 0 : degree;
        Bulk b;
        Box  box;
        Setting(&b, dim);
        b.forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 2, 1}, 1, dim == 2 ? 2 : 1, seed, &box);
        const ForestTables *t;
        t = ForestGetTables(b.forest);
        OK(PetscMalloc1(t->num_leaves, &b.orders));
        for (PetscInt l = 0; l < t->num_leaves; ++l) b.orders[l] = (int8_t)(degree + (seed >= 2 ? BoxRandom(2) : 0));
        Frames(&b, dim);
        for (PetscInt i = 0; i < (dim == 3 && degree == 3 ? 2 : 3); ++i) {
          Bulk next;
          Step(&b, &next, dim, degree, modes[i], seed);
          BulkDestroy(&b);
          b               = next;
          b.body.material = &b.material;
          OK(MechanicsDestroy(&b.mechanics));
          b.spec.bodies     = &b.body;
          b.spec.boundaries = b.boundaries;
          OK(MechanicsCreate(b.space, &b.spec, &b.supports, &b.mechanics));
        }
        BulkDestroy(&b);
      }
    }
  }
  lowest_cap           = 0;
  const PetscInt parts = Whole() ? 1 : 2;
  assert_true(num_refined[0] > 100 / parts && num_refined[2] > 100 / parts);
  assert_true(num_merged[1] > 20 / parts && num_merged[2] > 20 / parts);
  assert_true(num_raised > 50 / parts && num_lowered > 50 / parts);
}

/* Children with constant pressures merge: the parent's constant is their mean. */
static void MergedMean(void **state)
{
  Bulk                from, to;
  Box                 box;
  TransferContext     c;
  OldCells            old;
  const HPTables     *v;
  const ForestTables *t;
  MarkList            marks;
  ForestMap           map;
  PetscReal          *u, pressure[16], result[4];
  PetscInt            first, num, owned;

  Setting(&from, 2);
  from.forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){2, 2, 1}, 1, 1, 0, &box);
  BulkSetUp(&from, 1, 1);
  v = HPSpaceGetTables(from.space);
  t = ForestGetTables(from.forest);
  for (PetscInt cell = 0; cell < v->num_owned_cells; ++cell) {
    OK(MechanicsPressureRange(from.mechanics, cell, &first, &num));
    assert_int_equal(num, 1);
    pressure[first] = PetscSinReal(5. * v->cell_leaf[cell]);
  }
  OK(PetscCalloc1(2 * v->num_nodes, &u));
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscMalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) marks.coarsen[l] = 1;
  Setting(&to, 2);
  OK(ForestAdapt(from.forest, &marks, NULL, 0, NULL, &to.forest, &map));
  BulkSetUp(&to, 1, 1);
  assert_int_equal(map.num, 4);
  c = (TransferContext){
      .old_space = from.space, .old_mechanics = from.mechanics, .spec = &from.spec, .new_space = to.space, .new_mechanics = to.mechanics, .map = &map};
  OK(TransferContextSetUp_Private(&c));
  OK(OldCellsFetch_Private(&c, &(OldFields){.u = u, .pressure = pressure}, &old));
  OK(TransferPressure_Private(&c, &old, result, NULL));
  v     = HPSpaceGetTables(to.space);
  owned = v->num_owned_cells;
  for (PetscInt cell = 0; cell < owned; ++cell) {
    PetscReal      mean = 0;
    const PetscInt leaf = v->cell_leaf[cell];
    for (PetscInt k = 0; k < 4; ++k) mean += 0.25 * PetscSinReal(5. * (map.old_first[leaf] + k));
    OK(MechanicsPressureRange(to.mechanics, cell, &first, &num));
    assert_near(result[first], mean, 1e-14);
  }
  OK(OldCellsDestroy_Private(&old));
  MarksDestroy(&marks);
  OK(ForestMapDestroy(&map));
  OK(PetscFree(u));
  BulkDestroy(&from);
  BulkDestroy(&to);
}

/* Integrals over the body that tell a function: of |u|^2, of the pressure's square, and of both against X_1 X_2 (1 + X_1). */
static void Moments(const Bulk *b, PetscReal u[], const PetscReal pressure[], PetscReal moment[4])
{
  const HPTables *v;
  const PetscInt  dim = b->spec.model == MODEL_3D ? 3 : 2;

  v = HPSpaceGetTables(b->space);
  OK(PetscArrayzero(moment, 4));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt order = v->cell_order[c], n = ElementNumNodes(dim, order);
    const Basis1D *gauss;
    PetscReal      values[3 * 125], nodes[3 * 125], N[125], G[3 * 125];
    PetscInt       first, num;
    OK(Basis1DGet(order, order + 3, &gauss));
    OK(HPSpaceGather(b->space, c, u, values));
    OK(HPSpaceGatherPositions(b->space, c, nodes));
    OK(MechanicsPressureRange(b->mechanics, c, &first, &num));
    for (PetscInt q = 0; q < ElementNumNodes(dim, order + 2); ++q) {
      PetscReal xi[3], X[3] = {0}, uh[3] = {0}, J[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, weight = 1, p;
      for (PetscInt d = 0, i = q; d < dim; ++d, i /= gauss->num_points) {
        xi[d] = gauss->points[i % gauss->num_points];
        weight *= gauss->weights[i % gauss->num_points];
      }
      OK(ElementEvaluate(dim, order, xi, N, G));
      for (PetscInt a = 0; a < dim; ++a) J[4 * a] = 0;
      for (PetscInt i = 0; i < n; ++i) {
        for (PetscInt a = 0; a < dim; ++a) {
          X[a] += N[i] * nodes[i * dim + a];
          uh[a] += N[i] * values[i * dim + a];
          for (PetscInt d = 0; d < dim; ++d) J[3 * a + d] += G[i * dim + d] * nodes[i * dim + a];
        }
      }
      weight *= Det3(J);
      OK(MechanicsPressureEvaluate(dim, order, 1, xi, pressure + first, &p));
      const PetscReal test = X[0] * X[1] * (1 + X[0]);
      moment[0] += weight * Dot3(uh, uh);
      moment[1] += weight * (uh[0] - 2 * uh[1]) * test;
      moment[2] += weight * p * p;
      moment[3] += weight * p * test;
    }
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, moment, 4, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
}

/* Nodes of other ranks' from their owners. */
static void Complete(const Bulk *b, PetscReal u[])
{
  const HPTables     *v;
  const ForestTables *t;
  const PetscInt     *global;
  const PetscScalar  *array;
  DM                  dm;
  Vec                 g, l;
  PetscMPIInt         rank;

  OK(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  v = HPSpaceGetTables(b->space);
  t = ForestGetTables(b->forest);
  OK(HPSpaceGetGlobalDofs(b->space, &global));
  dm = HPSpaceGetDM(b->space);
  OK(DMCreateGlobalVector(dm, &g));
  OK(DMCreateLocalVector(dm, &l));
  for (PetscInt i = 0; i < v->num_nodes * v->dim; ++i) {
    const PetscInt entity = v->node_entity[i / v->dim];
    if (global[i] >= 0 && t->leaf_rank[t->entity_leaf[entity]] == rank) OK(VecSetValue(g, global[i], u[i], INSERT_VALUES));
  }
  OK(VecAssemblyBegin(g));
  OK(VecAssemblyEnd(g));
  OK(DMGlobalToLocal(dm, g, INSERT_VALUES, l));
  OK(VecGetArrayRead(l, &array));
  OK(PetscArraycpy(u, array, v->num_nodes * v->dim));
  OK(VecRestoreArrayRead(l, &array));
  OK(VecDestroy(&g));
  OK(VecDestroy(&l));
}

/* A number that every rank makes of a place alike. */
static PetscReal Hash(const PetscReal X[3], PetscReal salt)
{
  const PetscReal v = 1e4 * PetscSinReal(12.9898 * X[0] + 78.233 * X[1] + 37.719 * X[2] + salt);
  return v - PetscFloorReal(v) - 0.5;
}

/* Any function of the space, hanging nodes and mixed cells included: where orders rise (and some cells are split, too) it stays what it is. */
static void Raised(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (uint64_t seed = 0; seed < 4; ++seed) {
      if (!Share((PetscInt)seed / 2 + (PetscInt)seed + dim, 2)) continue;
      Bulk                from, to;
      Box                 box;
      TransferContext     c;
      OldCells            old;
      const HPTables     *v;
      const ForestTables *t;
      MarkList            marks;
      ForestMap           map;
      PetscReal          *u, *pressure, *new_u, *new_pressure, *weight, before[4], after[4];
      PetscInt            num, raised = 0;

      Setting(&from, dim);
      from.forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 2, 1}, 1, 1, 0, &box);
      BulkRefine(&from.forest, dim, 1, (PetscBool)(seed % 2));
      t = ForestGetTables(from.forest);
      OK(PetscMalloc1(t->num_leaves, &from.orders));
      for (PetscInt l = 0; l < t->num_leaves; ++l) from.orders[l] = (int8_t)(1 + BoxRandom(dim == 2 ? 3 : 2));
      Frames(&from, dim);
      v = HPSpaceGetTables(from.space);
      OK(PetscMalloc1(v->num_nodes * dim, &u));
      for (PetscInt i = 0; i < v->num_nodes * dim; ++i)
        u[i] = v->node_hang[i / dim + 1] > v->node_hang[i / dim] ? PETSC_MAX_REAL : Hash(v->X + 3 * (i / dim), (PetscReal)(i % dim));
      OK(MechanicsNumPressure(from.mechanics, &num));
      OK(PetscMalloc1(num, &pressure));
      for (PetscInt cell = 0; cell < v->num_owned_cells; ++cell) {
        PetscInt first, m;
        OK(MechanicsPressureRange(from.mechanics, cell, &first, &m));
        for (PetscInt k = 0; k < m; ++k) pressure[first + k] = Hash((const PetscReal[3]){v->cell_leaf[cell], k, 0}, 0);
      }
      Moments(&from, u, pressure, before);
      OK(PetscCalloc1(t->num_leaves, &marks.split));
      OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
      OK(PetscMalloc1(t->num_leaves, &weight));
      for (PetscInt l = 0; l < t->num_leaves; ++l) {
        marks.split[l] = (int8_t)(seed >= 2 && !BoxRandom(4) ? 1 + BoxRandom((1 << dim) - 1) : 0);
        weight[l]      = 1 + 5 * BoxRandom(2);
      }
      Setting(&to, dim);
      OK(ForestAdapt(from.forest, &marks, weight, 0, NULL, &to.forest, &map));
      OK(TransferOrders(&map, from.orders, &to.orders));
      for (PetscInt l = 0; l < map.num; ++l) {
        const int8_t more = (int8_t)BoxRandom(2);
        to.orders[l] += more;
        raised += more;
      }
      assert_true(raised > 0);
      Frames(&to, dim);
      c = (TransferContext){
          .old_space = from.space, .old_mechanics = from.mechanics, .spec = &from.spec, .new_space = to.space, .new_mechanics = to.mechanics, .map = &map};
      OK(TransferContextSetUp_Private(&c));
      OK(OldCellsFetch_Private(&c, &(OldFields){.u = u, .pressure = pressure}, &old));
      v = HPSpaceGetTables(to.space);
      OK(PetscCalloc1(v->num_nodes * dim, &new_u));
      OK(MechanicsNumPressure(to.mechanics, &num));
      OK(PetscCalloc1(num, &new_pressure));
      OK(TransferDisplacement_Private(&c, &old, new_u));
      OK(TransferPressure_Private(&c, &old, new_pressure, NULL));
      Complete(&to, new_u);
      Moments(&to, new_u, new_pressure, after);
      for (PetscInt k = 0; k < 4; ++k) {
        assert_true(k % 2 || before[k] > 1e-2);
        assert_near(after[k], before[k], 1e-12);
      }
      OK(OldCellsDestroy_Private(&old));
      MarksDestroy(&marks);
      OK(ForestMapDestroy(&map));
      OK(PetscFree(weight));
      OK(PetscFree(u));
      OK(PetscFree(pressure));
      OK(PetscFree(new_u));
      OK(PetscFree(new_pressure));
      BulkDestroy(&from);
      BulkDestroy(&to);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Polynomials), cmocka_unit_test(MergedMean), cmocka_unit_test(Raised)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
