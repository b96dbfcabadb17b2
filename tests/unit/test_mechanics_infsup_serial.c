/* O-15: numerical inf-sup constants of the pairs Q_k / P_(k-1). beta^2 is the least nonzero eigenvalue of M^-1 B K^-1 B^T, K the norm |grad u|^2, M the
   pressures' mass, B the coupling that the condensed tangent of the program contains. Unit square and cube, u = 0 all round or on the bottom alone; the faces
   of the top may be linear as those of contact are. k >= 2 is stable: u = 0 all round leaves constants as the only kernel, a free surface none, and beta
   changes by less than 10 % at each doubling, on uniform, 1-irregular and graded meshes, in the plane and in space. Q1/P0 is not. In the plane: one
   checkerboard, and what remains falls like h. In space worse: n cells in each direction and u = 0 all round leave (-1)^(i+j) a(k) and its like in the other
   directions, 3n - 2 of them, and what remains falls faster than h, towards h^2: a modulated (-1)^(i+j+k) is felt through its mixed second differences only. A
   refined island adds one kernel, a free surface or not. A test that did not see that would see nothing. */
#include "mechanicsimpl.h"
#include "problemfixture.h"
#include "solvefixture.h"
#include <petscblaslapack.h>

#define MOST_NODES 125 /* order 4 in space */
#define MOST_PRESSURES 20

/* CLAMPED: u = 0 all round. STANDING: on the bottom alone. LINEAR: STANDING, and the faces of the top have order 1. */
typedef enum { CLAMPED, STANDING, LINEAR } Support;
static const char *const support_names[] = {"clamped", "standing", "linear top"};

typedef struct {
  PetscInt  kernel; /* pressures that do no work on any displacement */
  PetscReal beta;   /* the least nonzero value */
} InfSup;

/* Bottom: side 2*dim - 2, top: 2*dim - 1. */
static void Supported(Bulk *b, Forest forest, PetscInt order, Support support)
{
  const ForestTables *t;
  PetscInt            dim;

  OK(ForestGetTables(forest, &t));
  dim = t->dim;
  *b  = (Bulk){.forest = forest};
  BulkInit(b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_SMALL);
  BulkMaterial(&b->material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_MIXED, 1, 1);
  for (PetscInt s = 0; s < 2 * dim; ++s)
    for (PetscInt c = 0; c < dim; ++c) b->boundaries[s].fix[c] = (PetscBool)(support == CLAMPED || s == 2 * dim - 2);
  OK(PetscMalloc1(t->num_leaves, &b->orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) b->orders[l] = (int8_t)order;
  OK(HPSpaceCreate(forest, b->orders, support == LINEAR ? (uint64_t)1 << (2 * dim - 1) : 0, 0, &b->space));
  OK(MechanicsSupportsCreate(b->space, &b->spec, &b->supports));
  OK(HPSpaceSetUp(b->space, b->supports.fixed, 0, NULL, NULL));
  OK(MechanicsCreate(b->space, &b->spec, &b->supports, &b->mechanics));
  OK(MechanicsSetTime(b->mechanics, 1));
}

/* Gauss points of a cell with positions X, exact for products of two of its functions if it is affine: weights times volume, and gradients [node][dim] of
   its functions unless NULL. Returns their number. */
static PetscInt Points(PetscInt dim, PetscInt order, const PetscReal X[], PetscReal xi[], PetscReal weight[], PetscReal (*gradient)[3 * MOST_NODES])
{
  const PetscInt n = ElementNumNodes(dim, order), np = CellGauss(dim, order + 1, xi, weight);

  for (PetscInt p = 0; p < np; ++p) {
    PetscReal N[MOST_NODES], D[3 * MOST_NODES], J[9] = {0, 0, 0, 0, 0, 0, 0, 0, dim == 2}, det;
    OK(ElementEvaluate(dim, order, xi + dim * p, N, D));
    for (PetscInt k = 0; k < n; ++k)
      for (PetscInt c = 0; c < dim; ++c)
        for (PetscInt r = 0; r < dim; ++r) J[3 * c + r] += X[dim * k + c] * D[dim * k + r];
    det = Det3(J);
    weight[p] *= det;
    for (PetscInt c = 0; gradient && c < dim; ++c) { /* d/dX_c = sum over r of cof J_cr / det J d/dxi_r */
      for (PetscInt k = 0; k < n; ++k) gradient[p][dim * k + c] = 0;
      for (PetscInt r = 0; r < dim; ++r) {
        const PetscInt  c1 = (c + 1) % 3, c2 = (c + 2) % 3, r1 = (r + 1) % 3, r2 = (r + 2) % 3;
        const PetscReal inverse = (J[3 * c1 + r1] * J[3 * c2 + r2] - J[3 * c1 + r2] * J[3 * c2 + r1]) / det;
        for (PetscInt k = 0; k < n; ++k) gradient[p][dim * k + c] += inverse * D[dim * k + r];
      }
    }
  }
  return np;
}

static PetscInt NumFree(const Bulk *b, const PetscInt **global)
{
  const HPTables *v;
  PetscInt        n = 0;

  OK(HPSpaceGetTables(b->space, &v));
  OK(HPSpaceGetGlobalDofs(b->space, global));
  for (PetscInt i = 0; i < v->dim * v->num_nodes; ++i) n = PetscMax(n, (*global)[i] + 1);
  return n;
}

/* int grad Na : grad Nb of a cell, [n*dim][n*dim]. */
static void CellNorm(const Bulk *b, PetscInt dim, PetscInt order, PetscInt cell, PetscReal K[])
{
  static PetscReal gradient[MOST_NODES][3 * MOST_NODES];
  PetscReal        X[3 * MOST_NODES], xi[3 * MOST_NODES], weight[MOST_NODES];
  const PetscInt   n = ElementNumNodes(dim, order);

  OK(HPSpaceGatherPositions(b->space, cell, X));
  const PetscInt np = Points(dim, order, X, xi, weight, gradient);
  OK(PetscArrayzero(K, PetscSqr(dim * n)));
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt j = 0; j < n; ++j) {
      PetscReal sum = 0;
      for (PetscInt p = 0; p < np; ++p)
        for (PetscInt c = 0; c < dim; ++c) sum += weight[p] * gradient[p][dim * i + c] * gradient[p][dim * j + c];
      for (PetscInt c = 0; c < dim; ++c) K[(dim * i + c) * dim * n + dim * j + c] = sum;
    }
  }
}

static Mat Norm(const Bulk *b, PetscInt n)
{
  const HPTables *v;
  Assembly        a;

  OK(HPSpaceGetTables(b->space, &v));
  OK(HPSpaceGetGlobalDofs(b->space, &a.global));
  OK(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 2 * ElementNumNodes(v->dim, 2 * v->cell_order[0]), NULL, &a.A)); /* twice a row of a regular mesh */
  OK(MatSetOption(a.A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  OK(MatSetOption(a.A, MAT_IGNORE_ZERO_ENTRIES, PETSC_TRUE)); /* components do not couple */
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt nodes = PetscMax(ElementNumNodes(v->dim, v->cell_order[c]), v->cell_row[c + 1] - v->cell_row[c]), size = v->dim * nodes;
    PetscReal     *K, *Km;
    PetscInt      *dofs, num;
    OK(PetscMalloc3(size * size, &K, size * size, &Km, size, &dofs));
    CellNorm(b, v->dim, v->cell_order[c], c, K);
    OK(HPSpaceTransformMatrix(b->space, c, K, Km, dofs, &num));
    OK(Insert(&a, num, dofs, Km));
    OK(PetscFree3(K, Km, dofs));
  }
  OK(MatAssemblyBegin(a.A, MAT_FINAL_ASSEMBLY));
  OK(MatAssemblyEnd(a.A, MAT_FINAL_ASSEMBLY));
  return a.A;
}

static PetscErrorCode Ignore(void *context, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  return PETSC_SUCCESS;
}

/* Lower Cholesky factor of the pressure mass of a cell with positions X. */
static void MassFactor(PetscInt dim, PetscInt order, PetscInt m, const PetscReal X[], PetscReal *L)
{
  PetscReal      xi[3 * MOST_NODES], weight[MOST_NODES], q[MOST_PRESSURES][MOST_NODES];
  const PetscInt np = Points(dim, order, X, xi, weight, NULL);

  for (PetscInt k = 0; k < m; ++k) {
    PetscReal unit[MOST_PRESSURES] = {0};
    unit[k]                        = 1;
    OK(MechanicsPressureEvaluate(dim, order, np, xi, unit, q[k]));
  }
  for (PetscInt i = 0; i < m; ++i) {
    for (PetscInt j = 0; j <= i; ++j) {
      PetscReal sum = 0;
      for (PetscInt p = 0; p < np; ++p) sum += weight[p] * q[i][p] * q[j][p];
      for (PetscInt k = 0; k < j; ++k) sum -= L[i * m + k] * L[j * m + k];
      L[i * m + j] = i == j ? PetscSqrtReal(sum) : sum / L[j * m + j];
      if (j < i) L[j * m + i] = 0;
    }
  }
}

/* Columns L^T M^-1 b of all pressures, [n][num_pressure], from the derivative of the condensed pressure that the tangent leaves behind. */
static Mat Coupling(const Bulk *b, PetscInt n)
{
  const Mechanics mech = b->mechanics;
  const HPTables *v;
  const PetscInt *global;
  PetscReal      *u, *r, *array, X[3 * MOST_NODES], L[MOST_PRESSURES * MOST_PRESSURES];
  PetscBool       bad;
  Mat             B;

  OK(HPSpaceGetTables(b->space, &v));
  OK(HPSpaceGetGlobalDofs(b->space, &global));
  OK(PetscCalloc1(v->dim * v->num_nodes, &u));
  OK(PetscMalloc1(v->dim * v->num_nodes, &r));
  OK(MechanicsTangent(mech, u, NULL, Ignore, NULL, &bad));
  assert_int_equal(mech->num_groups, 1);
  const CellGroup *g  = &mech->groups[0];
  const PetscInt   nd = v->dim * g->n;
  OK(MatCreateSeqDense(PETSC_COMM_SELF, n, mech->num_pressure, NULL, &B));
  OK(MatDenseGetArray(B, &array));
  for (PetscInt c = 0; c < g->num_cells; ++c) {
    const PetscReal *D = mech->dpressure + c * g->m * nd;
    OK(HPSpaceGatherPositions(b->space, g->cells[c], X));
    MassFactor(v->dim, g->order, g->m, X, L);
    for (PetscInt l = 0; l < g->m; ++l) {
      PetscReal row[3 * MOST_NODES] = {0};
      for (PetscInt k = l; k < g->m; ++k)
        for (PetscInt i = 0; i < nd; ++i) row[i] += L[k * g->m + l] * D[k * nd + i] / MaterialVolumetricModulus(&b->material);
      OK(PetscArrayzero(r, v->dim * v->num_nodes));
      OK(HPSpaceScatterAdd(b->space, g->cells[c], row, r));
      for (PetscInt i = 0; i < v->dim * v->num_nodes; ++i)
        if (global[i] >= 0) array[(size_t)(c * g->m + l) * n + global[i]] = r[i];
    }
  }
  OK(MatDenseRestoreArray(B, &array));
  OK(MatAssemblyBegin(B, MAT_FINAL_ASSEMBLY));
  OK(MatAssemblyEnd(B, MAT_FINAL_ASSEMBLY));
  OK(PetscFree(u));
  OK(PetscFree(r));
  return B;
}

/* Ascending eigenvalues of B^T K^-1 B. */
static void Eigenvalues(Mat K, Mat B, PetscInt m, PetscReal *value)
{
  Mat           factor, X, S;
  IS            row, column;
  MatFactorInfo info;
  PetscReal    *array, *work;
  PetscBLASInt  size = (PetscBLASInt)m, length = 34 * size, error;

  OK(MatGetOrdering(K, MATORDERINGND, &row, &column));
  OK(MatFactorInfoInitialize(&info));
  OK(MatGetFactor(K, MATSOLVERMUMPS, MAT_FACTOR_LU, &factor));
  OK(MatLUFactorSymbolic(factor, K, row, column, &info));
  OK(MatLUFactorNumeric(factor, K, &info));
  OK(MatDuplicate(B, MAT_DO_NOT_COPY_VALUES, &X));
  OK(MatMatSolve(factor, B, X));
  OK(MatTransposeMatMult(B, X, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &S));
  OK(MatDenseGetArray(S, &array));
  OK(PetscMalloc1(length, &work));
  LAPACKsyev_("N", "L", &size, array, &size, value, work, &length, &error);
  assert_int_equal(error, 0);
  OK(PetscFree(work));
  OK(MatDenseRestoreArray(S, &array));
  OK(ISDestroy(&row));
  OK(ISDestroy(&column));
  OK(MatDestroy(&factor));
  OK(MatDestroy(&X));
  OK(MatDestroy(&S));
}

/* Takes the forest over. */
static InfSup Measure(Forest forest, PetscInt order, Support support, const char *what, PetscInt n)
{
  Bulk            b;
  const PetscInt *global;
  PetscReal      *value;
  InfSup          result = {0};

  Supported(&b, forest, order, support);
  const PetscInt dim = b.mechanics->dim, num = NumFree(&b, &global), m = b.mechanics->num_pressure;
  Mat            K = Norm(&b, num), B = Coupling(&b, num);
  OK(PetscMalloc1(m, &value));
  Eigenvalues(K, B, m, value);
  while (result.kernel < m && value[result.kernel] < 1e-10) ++result.kernel;
  result.beta = result.kernel < m ? PetscSqrtReal(value[result.kernel]) : 0;
  assert_true(value[m - 1] <= (support == CLAMPED ? 1 : dim) + 1e-10); /* |grad u|^2 = |div u|^2 + |curl u|^2 if u = 0 all round */
  print_message("%" PetscInt_FMT "-D Q%" PetscInt_FMT "/P%" PetscInt_FMT " %-10s %-11s %2" PetscInt_FMT ": %5" PetscInt_FMT " displacements, %4" PetscInt_FMT
                " pressures, kernel %2" PetscInt_FMT ", beta %.4f\n",
                dim, order, order - 1, support_names[support], what, n, num, m, result.kernel, (double)result.beta);
  OK(PetscFree(value));
  OK(MatDestroy(&K));
  OK(MatDestroy(&B));
  BulkDestroy(&b);
  return result;
}

/* n cells in each direction. */
static Forest Unit(PetscInt dim, PetscInt n)
{
  Box    box;
  Forest forest;

  box_width = 1. / n;
  forest    = BoxForest(PETSC_COMM_SELF, dim, (const PetscInt[3]){n, n, n}, 1, 0, 1, &box);
  box_width = 1;
  return forest;
}

typedef PetscBool (*Choice)(const PetscReal low[3], const PetscReal high[3]);

/* Split the leaves whose boxes are chosen. */
static void Split(Forest *forest, Choice choice)
{
  const ForestTables *t;
  MarkList            marks;
  Forest              next;
  ForestMap           map;

  OK(ForestGetTables(*forest, &t));
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    PetscReal a[3], b[3], low[3], high[3];
    OK(ForestMapPoint(*forest, l, (const PetscReal[3]){0, 0, 0}, a));
    OK(ForestMapPoint(*forest, l, (const PetscReal[3]){1, 1, 1}, b));
    for (PetscInt c = 0; c < 3; ++c) low[c] = PetscMin(a[c], b[c]), high[c] = PetscMax(a[c], b[c]);
    marks.split[l] = (int8_t)(choice(low, high) ? (1 << t->dim) - 1 : 0);
  }
  OK(ForestAdapt(*forest, &marks, NULL, 0, NULL, &next, &map));
  MarksDestroy(&marks);
  OK(ForestMapDestroy(&map));
  OK(ForestDestroy(forest));
  *forest = next;
}

/* Third coordinates are 0 in the plane. */
static PetscBool Orthant(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(high[0] < 0.5 + 1e-9 && high[1] < 0.5 + 1e-9 && high[2] < 0.5 + 1e-9);
}

static PetscBool Corner(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(low[0] < 1e-9 && low[1] < 1e-9 && low[2] < 1e-9);
}

/* The one cell in the middle of an odd number. */
static PetscBool Middle(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(low[0] < 0.5 && high[0] > 0.5 && low[1] < 0.5 && high[1] > 0.5 && low[2] < 0.5 && (high[2] > 0.5 || high[2] < 1e-9));
}

static Forest Refined(PetscInt dim, PetscInt n, Choice choice, PetscInt times)
{
  Forest forest = Unit(dim, n);

  for (PetscInt k = 0; k < times; ++k) Split(&forest, choice);
  return forest;
}

/* last (NULL: none): the mesh `doublings` coarser. Q1/P0 of n = 16 in the plane and of 4 in space is below the floor. */
static void CheckStable(Support support, PetscInt order, PetscReal doublings, const InfSup *last, const InfSup *now)
{
  assert_int_equal(now->kernel, support == CLAMPED);
  assert_true(now->beta > 0.3);
  if (last && !(PetscAbsReal(PetscPowReal(now->beta / last->beta, 1 / doublings) - 1) < 0.1))
    fail_msg("order %d: beta %g after %g", (int)order, (double)now->beta, (double)last->beta);
}

/* Against a figure from elsewhere, to its last digit. */
static void CheckFigure(PetscReal beta, PetscReal figure, PetscReal digit)
{
  if (!(PetscAbsReal(beta - figure) < digit)) fail_msg("beta %g, known as %g", (double)beta, (double)figure);
}

static void StableInPlane(void **state)
{
  for (PetscInt order = 2; order <= 4; ++order) {
    InfSup uniform[4], irregular[3], graded[4];
    for (PetscInt i = 0, n = 2; i < (order < 4 ? 4 : 3); ++i, n *= 2) {
      uniform[i] = Measure(Unit(2, n), order, CLAMPED, "uniform", n);
      if (n > 2) CheckStable(CLAMPED, order, 1, n > 4 ? &uniform[i - 1] : NULL, &uniform[i]);
    }
    for (PetscInt i = 0, n = 2; i < 3; ++i, n *= 2) {
      irregular[i] = Measure(Refined(2, n, Orthant, 1), order, CLAMPED, "1-irregular", n);
      CheckStable(CLAMPED, order, 1, i ? &irregular[i - 1] : NULL, &irregular[i]);
    }
    for (PetscInt i = 0; i < 4; ++i) {
      graded[i] = Measure(Refined(2, 4, Corner, 2 * (i + 1)), order, CLAMPED, "graded", 2 * (i + 1));
      CheckStable(CLAMPED, order, 1, i ? &graded[i - 1] : NULL, &graded[i]);
    }
  }
}

/* The figures are those of an independent computation with n = 8. */
static void StableInPlaneStanding(void **state)
{
  const PetscReal figure[] = {0.66, 0.70, 0.71};

  for (Support support = STANDING; support <= LINEAR; ++support) {
    for (PetscInt order = 2; order <= 4; ++order) {
      const InfSup coarse = Measure(Unit(2, 4), order, support, "uniform", 4), fine = Measure(Unit(2, 8), order, support, "uniform", 8);
      CheckStable(support, order, 1, &coarse, &fine);
      CheckFigure(fine.beta, figure[order - 2], 0.005);
    }
  }
}

/* Orders 2 and 3 with 2, 3, 4 cells in each direction, order 4 with 2, 3. The figures, with 4, 3, 2 cells, are those of an independent computation. */
static void StableInSpace(void **state)
{
  const PetscReal figure[] = {0.609, 0.692, 0.732};

  for (PetscInt order = 2; order <= 4; ++order) {
    const PetscInt most = order < 4 ? 4 : 3, known = 6 - order;
    for (Support support = CLAMPED; support <= STANDING; ++support) {
      InfSup uniform[5];
      for (PetscInt n = 2; n <= most; ++n) uniform[n] = Measure(Unit(3, n), order, support, "uniform", n);
      CheckStable(support, order, PetscLog2Real((PetscReal)most / (most - 1)), &uniform[most - 1], &uniform[most]);
      if (support == STANDING) CheckFigure(uniform[known].beta, figure[order - 2], 0.001);
      const InfSup irregular = Measure(Refined(3, 2, Orthant, 1), order, support, "1-irregular", 2);
      CheckStable(support, order, 1, NULL, &irregular);
      const InfSup island = Measure(Refined(3, 3, Middle, 1), order, support, "island", 3);
      CheckStable(support, order, 1, &uniform[3], &island);
    }
    const InfSup graded = Measure(Refined(3, 2, Corner, 2), order, CLAMPED, "graded", 2);
    CheckStable(CLAMPED, order, 1, NULL, &graded);
    const InfSup linear = Measure(Unit(3, known), order, LINEAR, "uniform", known);
    CheckStable(LINEAR, order, 1, NULL, &linear);
    CheckFigure(linear.beta, figure[order - 2], 0.001); /* linear faces on one side leave it as it is */
  }
}

/* Constants and the checkerboard if clamped; half at each doubling in the end. */
static void LowestOrderInPlane(void **state)
{
  const PetscReal figure[2][3] = {{0.37, 0.22, 0.11}, {0.43, 0.25, 0.13}};

  for (Support support = CLAMPED; support <= STANDING; ++support) {
    InfSup last = {0};
    for (PetscInt i = 0, n = 4; i < 3; ++i, n *= 2) {
      const InfSup now = Measure(Unit(2, n), 1, support, "uniform", n);
      assert_int_equal(now.kernel, support == CLAMPED ? 2 : 0);
      CheckFigure(now.beta, figure[support][i], 0.006);
      if (n == 16) assert_true(now.beta / last.beta > 0.4 && now.beta / last.beta < 0.6);
      last = now;
    }
  }
}

/* A quarter at each doubling in the end. */
static void LowestOrderInSpace(void **state)
{
  for (Support support = CLAMPED; support <= STANDING; ++support) {
    InfSup now[9];
    for (PetscInt n = 2; n <= 8; ++n) {
      now[n] = Measure(Unit(3, n), 1, support, "uniform", n);
      assert_int_equal(now[n].kernel, support == CLAMPED ? 3 * n - 1 : 0);
    }
    assert_true(now[8].beta / now[4].beta > 0.25 && now[8].beta / now[4].beta < 0.35);
    assert_true(now[8].beta / now[4].beta < now[6].beta / now[3].beta);
  }
}

static void LowestOrderIsland(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    for (Support support = CLAMPED; support <= STANDING; ++support) {
      const InfSup uniform = Measure(Unit(dim, 5), 1, support, "uniform", 5), island = Measure(Refined(dim, 5, Middle, 1), 1, support, "island", 5);
      assert_int_equal(island.kernel, uniform.kernel + 1);
    }
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LowestOrderInPlane), cmocka_unit_test(LowestOrderInSpace),    cmocka_unit_test(LowestOrderIsland),
                                     cmocka_unit_test(StableInPlane),      cmocka_unit_test(StableInPlaneStanding), cmocka_unit_test(StableInSpace)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
