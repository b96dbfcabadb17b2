/* Histories from mesh to mesh, on any number of ranks: fields whose elastic strain (its logarithm) and plastic strain are polynomials of the cells' order
   arrive as they are, however the cells are deformed (split, merged, orders raised and lowered, repartitioned); rough ones stay admissible: determinant 1, no
   plastic strain below 0 or far beyond the old cell's; those of flow that interpolation takes beyond the yield surface go back to it radially, without flow; a
   cell that stays keeps its bits; ghosts know what their owners do. */
#include "bulkfixture.h"
#include "share.h"
#include "transferimpl.h"

enum { H = 8 };
enum { ROUGH = -1, FLOWN = -2, DEFORMED = 2 }; /* fields that are no polynomials: any numbers; what two steps of plastic flow left. Degree with a motion */
static const PetscReal Yield = 0.01, Hardening = 0.05;

static void Setting(Bulk *b, PetscInt dim)
{
  const char *const names[]  = {"mu", "kappa", "yield", "hardening"};
  const PetscReal   values[] = {1, 3, Yield, Hardening};

  *b = (Bulk){0};
  BulkInit(b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
  b->material = (MaterialSpec){.law = MaterialLawFind("j2"), .formulation = FORMULATION_DISPLACEMENT};
  OK(PetscStrcpy(b->material.name, "steel"));
  OK(MaterialSetUp(&b->material, 4, names, values));
}

/* Logarithm (traceless) and plastic strain at X: polynomials of this degree. */
static void Field(PetscInt degree, const PetscReal X[3], PetscReal log[6], PetscReal *alpha)
{
  const PetscReal s = 0.3 * X[0] - 0.4 * X[1] + 0.2 * X[2];
  PetscReal       p = 1;

  for (PetscInt i = 0; i < degree; ++i) p *= s;
  log[0] = 0.2 + 0.5 * p;
  log[1] = 0.3 - 0.2 * p;
  log[2] = 0.1 * p;
  log[3] = -0.4 + 0.1 * p;
  log[4] = -0.2 + 0.3 * p;
  log[5] = -log[0] - log[3];
  *alpha = 2 + p; /* |p| < 1: admissible, and monotone enough for no bound to act */
}

/* exp of a symmetric tensor by scaling and squaring: another way than the transfer's. */
static void Exp(const PetscReal log[6], PetscReal out[6])
{
  static const int at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  PetscReal        A[9], E[9], T[9];

  for (int k = 0; k < 9; ++k) {
    A[k] = log[at[k]] / 1024;
    E[k] = T[k] = k % 4 == 0;
  }
  for (int n = 1; n < 8; ++n) {
    PetscReal next[9] = {0};
    for (int k = 0; k < 27; ++k) next[k / 3] += T[3 * (k / 9) + k % 3] * A[3 * (k % 3) + k / 3 % 3] / n;
    for (int k = 0; k < 9; ++k) E[k] += T[k] = next[k];
  }
  for (int n = 0; n < 10; ++n) {
    PetscReal next[9] = {0};
    for (int k = 0; k < 27; ++k) next[k / 3] += E[3 * (k / 9) + k % 3] * E[3 * (k % 3) + k / 3 % 3];
    PetscMemcpy(E, next, sizeof(E));
  }
  for (int k = 0; k < 9; ++k) out[at[k]] = E[k];
}

/* Reference positions of a cell's integration points; returns their number. */
static PetscInt Points(const Bulk *b, PetscInt cell, PetscReal (*X)[3])
{
  const HPTables *v;
  const Basis1D  *rule;
  PetscReal       nodes[3 * 343], N[343];

  v = HPSpaceGetTables(b->space);
  OK(HPSpaceGatherPositions(b->space, cell, nodes));
  OK(MechanicsPointRule(v->cell_order[cell], &rule));
  const PetscInt n = rule->num_points, num = ElementNumNodes(v->dim, n - 1);
  for (PetscInt q = 0; q < num; ++q) {
    const PetscReal xi[3] = {rule->points[q % n], rule->points[q / n % n], rule->points[q / (n * n) % n]};
    OK(ElementEvaluate(v->dim, v->cell_order[cell], xi, N, NULL));
    X[q][0] = X[q][1] = X[q][2] = 0;
    for (PetscInt i = 0; i < ElementNumNodes(v->dim, v->cell_order[cell]); ++i)
      for (PetscInt c = 0; c < v->dim; ++c) X[q][c] += N[i] * nodes[i * v->dim + c];
  }
  return num;
}

/* Displacement of degree 2 at the end of a step (0, 1), and its deformation gradient: flow here and there, then in other directions and elsewhere. */
static void Motion(PetscInt dim, PetscInt step, const PetscReal X[3], PetscReal u[3], PetscReal F[9])
{
  static const PetscReal form[3][4] = {{.3, -.7, .4, .1}, {.5, .2, -.3, -.6}, {-.2, .6, .5, -.4}};

  for (PetscInt k = 0; k < 9; ++k) F[k] = k % 4 == 0;
  for (PetscInt c = 0; c < dim; ++c) {
    const PetscReal *a = form[c], *b = form[(c + 1 + step) % 3];
    PetscReal        p = a[3], q = b[3];
    for (PetscInt J = 0; J < dim; ++J) {
      p += a[J] * X[J];
      q += b[J] * X[J];
    }
    u[c] = 0.03 * p * q;
    for (PetscInt J = 0; J < dim; ++J) F[3 * c + J] += 0.03 * (p * b[J] + q * a[J]);
  }
}

static void Move(const Bulk *b, PetscInt step, PetscReal u[])
{
  const HPTables *v;

  v = HPSpaceGetTables(b->space);
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    PetscReal to[3], F[9];
    Motion(v->dim, step, v->X + 3 * n, to, F);
    for (PetscInt c = 0; c < v->dim; ++c) u[n * v->dim + c] = to[c];
  }
}

/* Stress s = dev(J^(-2/3) F G F^T) (mu = 1) at F; returns |s| over the radius of the yield surface. */
static PetscReal Stress(const PetscReal F[9], const PetscReal history[H], PetscReal s[9])
{
  static const int at[9]  = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  const PetscReal  J      = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  PetscReal        square = 0;

  for (PetscInt i = 0; i < 9; ++i) {
    s[i] = 0;
    for (PetscInt k = 0; k < 9; ++k) s[i] += PetscPowReal(J, -2. / 3) * F[i - i % 3 + k / 3] * history[at[k]] * F[3 * (i % 3) + k % 3];
  }
  const PetscReal mean = (s[0] + s[4] + s[8]) / 3;
  for (PetscInt i = 0; i < 9; ++i) {
    s[i] -= i % 4 == 0 ? mean : 0;
    square += s[i] * s[i];
  }
  return PetscSqrtReal(square) / (PetscSqrtReal(2. / 3) * (Yield + Hardening * history[6]));
}

/* The displacement after two steps and the history they left. */
static void Flow(const Bulk *b, PetscReal u[], PetscReal history[])
{
  PetscBool bad;

  OK(MechanicsInitialHistory(b->mechanics, history));
  for (PetscInt step = 0; step < 2; ++step) {
    Move(b, step, u);
    OK(MechanicsSetHistory(b->mechanics, history));
    OK(MechanicsCommit(b->mechanics, u, history, &bad));
    assert_false(bad);
  }
}

static PetscReal Determinant(const PetscReal g[6])
{
  return g[0] * (g[3] * g[5] - g[4] * g[4]) - g[1] * (g[1] * g[5] - g[4] * g[2]) + g[2] * (g[1] * g[4] - g[3] * g[2]);
}

static PetscInt  num_within, num_beyond;
static PetscReal most_beyond;

/* history becomes admissible: no stress beyond the yield surface, determinant 1; where there was none the bits stay, elsewhere the stress has its direction and
   now the length of the radius; plastic strains stay. */
static void Admit(const Bulk *b, PetscReal history[])
{
  const HPTables *v;
  PetscReal      *u, *before;
  PetscInt        num, first, size;

  v = HPSpaceGetTables(b->space);
  OK(MechanicsNumHistory(b->mechanics, &num));
  OK(PetscMalloc2(v->num_nodes * v->dim, &u, num, &before));
  OK(PetscArraycpy(before, history, num));
  Move(b, 1, u);
  OK(MechanicsSetHistory(b->mechanics, history));
  OK(MechanicsAdmit(b->mechanics, u, history));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscReal      X[343][3];
    const PetscInt points = Points(b, c, X);
    OK(MechanicsHistoryRange(b->mechanics, c, &first, &size));
    for (PetscInt q = 0; q < points; ++q) {
      const PetscReal *old = before + first + q * H, *new = history + first + q *H;
      PetscReal x[3], F[9], s[2][9];
      Motion(v->dim, 1, X[q], x, F);
      const PetscReal was = Stress(F, old, s[0]), is = Stress(F, new, s[1]);
      assert_near(Determinant(new), 1, 1e-12);
      assert_true(new[6] == old[6] && new[6] >= 0);
      assert_true(is <= 1 + 2e-9);
      most_beyond = PetscMax(most_beyond, was);
      if (was < 1 + 1e-10) {
        assert_memory_equal(new, old, H * sizeof(PetscReal));
        num_within++;
      }
      if (was < 1 + 1e-6) continue;
      assert_near(is, 1, 1e-12);
      for (PetscInt i = 0; i < 9; ++i) assert_near(s[1][i], s[0][i] / was, 1e-13);
      num_beyond++;
    }
  }
  OK(PetscFree2(u, before));
}

/* G = Fbar^-1 be Fbar^-T at the end of the motion. */
static void PullBack(PetscInt dim, const PetscReal X[3], PetscReal history[H])
{
  static const int at[9]      = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  const PetscReal  unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  PetscReal        u[3], F[9], inverse[9], column[3], out[6] = {0};

  Motion(dim, 1, X, u, F);
  for (int j = 0; j < 3; ++j) {
    assert_true(Solve3(F, unit[j], column));
    for (int i = 0; i < 3; ++i) inverse[3 * i + j] = column[i] * PetscCbrtReal(Det3(F));
  }
  for (int k = 0; k < 81; ++k) {
    const int K = k / 27, L = k / 9 % 3, i = k / 3 % 3, j = k % 3;
    if (K <= L) out[at[3 * K + L]] += inverse[3 * K + i] * history[at[3 * i + j]] * inverse[3 * L + j];
  }
  PetscMemcpy(history, out, sizeof(out));
}

/* degree < 0: rough, by leaf and point. */
static void Fill(const Bulk *b, PetscInt degree, PetscBool deformed, PetscReal history[])
{
  const HPTables *v;

  v = HPSpaceGetTables(b->space);
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscReal      X[343][3];
    const PetscInt num = Points(b, c, X);
    PetscInt       first, size;
    OK(MechanicsHistoryRange(b->mechanics, c, &first, &size));
    assert_int_equal(size, num * H);
    for (PetscInt q = 0; q < num; ++q) {
      PetscReal *to = history + first + q * H, log[6];
      Field(PetscMax(degree, 0), X[q], log, &to[6]);
      if (degree < 0) {
        const PetscReal r = PetscSinReal(37. * v->cell_leaf[c] + 11. * q);
        for (int k = 0; k < 5; ++k) log[k] = 0.3 * PetscSinReal(5. * v->cell_leaf[c] + 3. * q + k);
        log[5] = -log[0] - log[3];
        to[6]  = PetscMax(0, r);
      }
      Exp(log, to);
      if (deformed) PullBack(v->dim, X[q], to);
    }
  }
}

static PetscInt num_kept, num_merged, num_split, num_orders;

/* Is it what the field says, or (degree < 0) admissible? */
static void Check(const Bulk *from, const Bulk *to, const ForestMap *map, PetscInt degree, PetscBool deformed, const PetscReal history[])
{
  const HPTables *v = HPSpaceGetTables(to->space);

  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscReal      X[343][3];
    const PetscInt num = Points(to, c, X), leaf = v->cell_leaf[c];
    PetscInt       first, size;
    OK(MechanicsHistoryRange(to->mechanics, c, &first, &size));
    num_merged += map->old_count[leaf] > 1;
    num_orders += from->orders[map->old_first[leaf]] != to->orders[leaf];
    for (PetscInt q = 0; q < num; ++q) {
      const PetscReal *g = history + first + q * H;
      assert_near(Determinant(g), 1, 1e-10);
      assert_true(g[6] >= 0 && g[6] <= 3.5);
      assert_true(g[7] == 0); /* without pressures there is no volume that they do not see */
      if (degree < 0) {
        assert_true(g[0] > 0 && g[0] * g[3] - g[1] * g[1] > 0);
        continue;
      }
      PetscReal log[6], exact[H];
      Field(degree, X[q], log, &exact[6]);
      Exp(log, exact);
      if (deformed) PullBack(v->dim, X[q], exact);
      for (int k = 0; k < H; ++k) assert_near(g[k], exact[k], 1e-11);
    }
  }
}

static void Step(PetscInt dim, PetscInt degree, PetscBool deformed, PetscBool merge, PetscInt raise, uint64_t seed)
{
  Bulk                from, to;
  Box                 box;
  OldCells            old;
  const ForestTables *t;
  const HPTables     *v;
  MarkList            marks;
  ForestMap           map;
  PetscReal          *u, *history, *result, *weight;
  PetscInt            num;
  const PetscInt      low = degree == FLOWN ? 2 : PetscMax(degree, 1);

  Setting(&from, dim);
  from.forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 2, 1}, 1, 1, seed, &box);
  BulkRefine(&from.forest, dim, 1, (PetscBool)(seed % 2));
  BulkSetUp(&from, low, low + (raise != 0));
  t = ForestGetTables(from.forest);
  BoxRandomMarks(dim, t->num_leaves, merge ? 1000000 : 3, (PetscBool)(seed % 2), &marks);
  OK(PetscMalloc1(t->num_leaves, &weight));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    if (merge) marks.coarsen[l] = !marks.split[l];
    weight[l] = 1 + 5 * BoxRandom(2);
  }
  Setting(&to, dim);
  OK(ForestAdapt(from.forest, &marks, weight, 0, NULL, &to.forest, &map));
  BulkSetUp(&to, low, low + (raise != 0));
  TransferContext c = {
      .old_space = from.space, .old_mechanics = from.mechanics, .spec = &from.spec, .new_space = to.space, .new_mechanics = to.mechanics, .map = &map};
  OK(TransferContextSetUp_Private(&c));
  v = HPSpaceGetTables(from.space);
  OK(MechanicsNumHistory(from.mechanics, &num));
  OK(PetscCalloc2(v->num_nodes * dim, &u, num, &history));
  if (degree == FLOWN)
    Flow(&from, u, history);
  else
    Fill(&from, degree, deformed, history);
  if (deformed) Move(&from, 1, u);
  OK(OldCellsFetch_Private(&c, &(OldFields){.u = u, .history = history}, &old));
  OK(MechanicsNumHistory(to.mechanics, &num));
  OK(PetscMalloc1(num, &result));
  OK(TransferHistory_Private(&c, &old, result));
  Check(&from, &to, &map, degree, deformed, result);
  if (degree == FLOWN) Admit(&to, result);

  /* cells that stay, on one rank: bit by bit */
  const ForestTables *nt;
  const HPTables     *nv;
  PetscMPIInt         size;
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  nt = ForestGetTables(to.forest);
  nv = HPSpaceGetTables(to.space);
  for (PetscInt cell = 0; cell < nv->num_owned_cells && size == 1; ++cell) {
    const PetscInt leaf = nv->cell_leaf[cell], k = map.old_first[leaf];
    PetscBool      same = (PetscBool)(map.old_count[leaf] == 1 && from.orders[k] == to.orders[leaf]);
    PetscInt       a, b, na, nb, source = 0;
    for (PetscInt d = 0; d < dim; ++d) same = (PetscBool)(same && nt->leaf_level[3 * leaf + d] == t->leaf_level[3 * k + d]);
    for (PetscInt d = 0; d < dim; ++d) num_split += nt->leaf_level[3 * leaf + d] > t->leaf_level[3 * k + d];
    while (v->cell_leaf[source] != k) ++source;
    if (!same) continue;
    OK(MechanicsHistoryRange(from.mechanics, source, &a, &na));
    OK(MechanicsHistoryRange(to.mechanics, cell, &b, &nb));
    assert_int_equal(na, nb);
    assert_memory_equal(history + a, result + b, (size_t)na * sizeof(PetscReal));
    num_kept++;
  }
  OK(OldCellsDestroy_Private(&old));
  MarksDestroy(&marks);
  OK(ForestMapDestroy(&map));
  OK(PetscFree2(u, history));
  OK(PetscFree(result));
  OK(PetscFree(weight));
  BulkDestroy(&from);
  BulkDestroy(&to);
}

static void PolynomialsArrive(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (PetscInt degree = 1; degree <= 2; ++degree)
      for (uint64_t seed = 0; seed < 3; ++seed)
        for (PetscInt merge = 0; merge < 2; ++merge)
          if (Share(dim + degree + (PetscInt)seed + merge, 2)) Step(dim, degree, PETSC_FALSE, (PetscBool)merge, seed == 2, seed);
}

static void ElasticStrainsArrive(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (uint64_t seed = 0; seed < 3; ++seed)
      for (PetscInt merge = 0; merge < 2; ++merge)
        if (Share(dim + (PetscInt)seed + merge, 2)) Step(dim, DEFORMED, PETSC_TRUE, (PetscBool)merge, seed == 2, seed);
}

static void RoughOnesStayAdmissible(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (uint64_t seed = 0; seed < 3; ++seed)
      for (PetscInt merge = 0; merge < 2; ++merge)
        if (Share(dim + (PetscInt)seed + merge, 2)) Step(dim, ROUGH, PETSC_FALSE, (PetscBool)merge, seed == 2, seed);
  PetscMPIInt size;
  OK(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  if (size == 1) assert_true(num_kept > 20 && num_split > 100 && num_merged > 20 && num_orders > 20);
}

static void FlowStaysWithinTheYieldSurface(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim)
    for (uint64_t seed = 0; seed < 3; ++seed)
      for (PetscInt merge = 0; merge < 2; ++merge)
        if (Share(dim + (PetscInt)seed + merge, 2)) Step(dim, FLOWN, PETSC_FALSE, (PetscBool)merge, seed == 2, seed);
  const PetscInt least = Whole() ? 100 : 50;
  assert_true(num_within > least && num_beyond > least && most_beyond > 1.05);
}

/* Ghosts: the stress at a place of a cell is the same seen from its owner and from a neighbour. */
static void GhostsKnowTheirHistory(void **state)
{
  Bulk            b;
  Box             box;
  const HPTables *v;
  PetscReal      *u, *history, *sum;
  PetscInt        num;

  Setting(&b, 2);
  b.forest = BoxForest(PETSC_COMM_WORLD, 2, (const PetscInt[3]){3, 3, 1}, 1, 1, 1, &box);
  BulkSetUp(&b, 1, 2);
  v = HPSpaceGetTables(b.space);
  const ForestTables *t;
  t = ForestGetTables(b.forest);
  OK(MechanicsNumHistory(b.mechanics, &num));
  OK(PetscCalloc3(v->num_nodes * 2, &u, num, &history, t->num_leaves, &sum));
  Fill(&b, 1, PETSC_FALSE, history);
  OK(MechanicsSetHistory(b.mechanics, history));
  for (PetscInt ghost = 0; ghost < 2; ++ghost) {
    for (PetscInt c = ghost ? v->num_owned_cells : 0; c < (ghost ? v->num_cells : v->num_owned_cells); ++c) {
      const PetscReal xi[2] = {0.2, 0.9};
      PetscReal       P[9];
      OK(MechanicsPoints(b.mechanics, c, 1, xi, u, &(PointValues){.P = P}));
      assert_true(PetscAbsReal(P[0]) + PetscAbsReal(P[4]) + PetscAbsReal(P[8]) > 1e-4);
      if (ghost)
        assert_near(P[0], sum[v->cell_leaf[c]], 1e-14);
      else
        sum[v->cell_leaf[c]] = P[0];
    }
    if (!ghost) OK(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)t->num_leaves, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  }
  OK(PetscFree3(u, history, sum));
  BulkDestroy(&b);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(PolynomialsArrive), cmocka_unit_test(ElasticStrainsArrive), cmocka_unit_test(RoughOnesStayAdmissible),
                                     cmocka_unit_test(FlowStaysWithinTheYieldSurface), cmocka_unit_test(GhostsKnowTheirHistory)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
