/* O-15: numerical inf-sup constants of the pairs Q_p / P_(p-1) in the plane, u = 0 all round: beta^2 is the least nonzero eigenvalue of
   M^-1 B K^-1 B^T, K the norm 2 eps:eps (equal to grad:grad + div div here), M the pressures' mass. p = 2..4 are stable: constants are the only kernel and beta
   changes by less than 10 % at each doubling, on uniform, 1-irregular and graded meshes. Q1/P0 shows its checkerboard and falls like h: a test
   that did not see that would see nothing. */
#include "mechanicsimpl.h"
#include "solvefixture.h"
#include <petscblaslapack.h>

typedef struct {
  PetscInt  kernel; /* pressures that do no work on any displacement */
  PetscReal beta;   /* the least nonzero value */
} InfSup;

static void Supported(Bulk *b, Formulation formulation, Forest forest, PetscInt order)
{
  *b = (Bulk){.forest = forest};
  BulkInit(b, 2, MODEL_PLANE_STRAIN, KINEMATICS_SMALL);
  BulkMaterial(&b->material, "linear", VOLUMETRIC_QUADRATIC, formulation, 1, 2. / 3); /* lambda = 0 */
  for (PetscInt s = 0; s < 4; ++s) b->boundaries[s].fix[0] = b->boundaries[s].fix[1] = PETSC_TRUE;
  BulkSetUp(b, order, order);
}

static PetscInt NumFree(const Bulk *b, const PetscInt **global)
{
  const HPTables *v;
  PetscInt        n = 0;

  OK(HPSpaceGetTables(b->space, &v));
  OK(HPSpaceGetGlobalDofs(b->space, global));
  for (PetscInt i = 0; i < 2 * v->num_nodes; ++i) n = PetscMax(n, (*global)[i] + 1);
  return n;
}

static Mat Stiffness(const Bulk *b, PetscInt n)
{
  const HPTables *v;
  Assembly        a;
  PetscReal      *u;
  PetscBool       bad;

  OK(HPSpaceGetTables(b->space, &v));
  OK(HPSpaceGetGlobalDofs(b->space, &a.global));
  OK(PetscCalloc1(2 * v->num_nodes, &u));
  OK(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 200, NULL, &a.A));
  OK(MatSetOption(a.A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  OK(MechanicsTangent(b->mechanics, u, NULL, Insert, &a, &bad));
  OK(MatAssemblyBegin(a.A, MAT_FINAL_ASSEMBLY));
  OK(MatAssemblyEnd(a.A, MAT_FINAL_ASSEMBLY));
  OK(PetscFree(u));
  return a.A;
}

static PetscErrorCode Ignore(void *context, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  return PETSC_SUCCESS;
}

/* Lower Cholesky factor of the pressure mass of a cell with positions X. */
static void MassFactor(PetscInt order, PetscInt m, const PetscReal X[], PetscReal *L)
{
  PetscReal xi[2 * 64], weight[64], q[10][64];
  PetscInt  np = 0;

  for (PetscInt j = 0; j < order + 1; ++j) {
    for (PetscInt i = 0; i < order + 1; ++i, ++np) {
      const Basis1D *gauss;
      PetscReal      N[25], D[50], J[4] = {0};
      OK(Basis1DGet(order, order + 1, &gauss));
      xi[2 * np]     = gauss->points[i];
      xi[2 * np + 1] = gauss->points[j];
      OK(ElementEvaluate(2, order, xi + 2 * np, N, D));
      for (PetscInt k = 0; k < ElementNumNodes(2, order); ++k)
        for (PetscInt c = 0; c < 4; ++c) J[c] += X[2 * k + c / 2] * D[2 * k + c % 2];
      weight[np] = gauss->weights[i] * gauss->weights[j] * (J[0] * J[3] - J[1] * J[2]);
    }
  }
  for (PetscInt k = 0; k < m; ++k) {
    PetscReal unit[10] = {0};
    unit[k]            = 1;
    OK(MechanicsPressureEvaluate(2, order, np, xi, unit, q[k]));
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
  PetscReal      *u, *r, *array, X[50], L[100];
  PetscBool       bad;
  Mat             B;

  OK(HPSpaceGetTables(b->space, &v));
  OK(HPSpaceGetGlobalDofs(b->space, &global));
  OK(PetscCalloc1(2 * v->num_nodes, &u));
  OK(PetscMalloc1(2 * v->num_nodes, &r));
  OK(MechanicsTangent(mech, u, NULL, Ignore, NULL, &bad));
  assert_int_equal(mech->num_groups, 1);
  const CellGroup *g  = &mech->groups[0];
  const PetscInt   nd = 2 * g->n;
  OK(MatCreateSeqDense(PETSC_COMM_SELF, n, mech->num_pressure, NULL, &B));
  OK(MatDenseGetArray(B, &array));
  for (PetscInt c = 0; c < g->num_cells; ++c) {
    const PetscReal *D = mech->dpressure + c * g->m * nd;
    OK(HPSpaceGatherPositions(b->space, g->cells[c], X));
    MassFactor(g->order, g->m, X, L);
    for (PetscInt l = 0; l < g->m; ++l) {
      PetscReal row[50] = {0};
      for (PetscInt k = l; k < g->m; ++k)
        for (PetscInt i = 0; i < nd; ++i) row[i] += L[k * g->m + l] * D[k * nd + i] / MaterialVolumetricModulus(&b->material);
      OK(PetscArrayzero(r, 2 * v->num_nodes));
      OK(HPSpaceScatterAdd(b->space, g->cells[c], row, r));
      for (PetscInt i = 0; i < 2 * v->num_nodes; ++i)
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
static InfSup Measure(Forest forest, PetscInt order, const char *what, PetscInt n)
{
  Bulk            displacement, mixed;
  const PetscInt *global;
  PetscReal      *value;
  InfSup          result = {0};

  Supported(&displacement, FORMULATION_DISPLACEMENT, forest, order);
  Supported(&mixed, FORMULATION_MIXED, forest, order);
  const PetscInt free = NumFree(&mixed, &global), m = mixed.mechanics->num_pressure;
  Mat            K = Stiffness(&displacement, free), B = Coupling(&mixed, free);
  OK(PetscMalloc1(m, &value));
  Eigenvalues(K, B, m, value);
  while (result.kernel < m && value[result.kernel] < 1e-10) ++result.kernel;
  result.beta = result.kernel < m ? PetscSqrtReal(value[result.kernel]) : 0;
  assert_true(value[m - 1] <= 1 + 1e-10); /* |div u|^2 <= |grad u|^2 + |div u|^2 */
  print_message("Q%d/P%d %-11s %2d: %4d pressures, kernel %d, beta %.4f\n", (int)order, (int)order - 1, what, (int)n, (int)m, (int)result.kernel,
                (double)result.beta);
  OK(PetscFree(value));
  OK(MatDestroy(&K));
  OK(MatDestroy(&B));
  displacement.forest = NULL;
  BulkDestroy(&displacement);
  BulkDestroy(&mixed);
  return result;
}

static Forest Square(PetscInt n)
{
  Box    box;
  Forest forest;

  box_width = 1. / n;
  forest    = BoxForest(PETSC_COMM_SELF, 2, (const PetscInt[3]){n, n, 1}, 1, 0, 1, &box);
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
    OK(ForestMapPoint(*forest, l, (const PetscReal[3]){1, 1, 0}, b));
    for (PetscInt c = 0; c < 3; ++c) low[c] = PetscMin(a[c], b[c]), high[c] = PetscMax(a[c], b[c]);
    marks.split[l] = choice(low, high) ? 3 : 0;
  }
  OK(ForestAdapt(*forest, &marks, NULL, 0, NULL, &next, &map));
  MarksDestroy(&marks);
  OK(ForestMapDestroy(&map));
  OK(ForestDestroy(forest));
  *forest = next;
}

static PetscBool Quadrant(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(high[0] < 0.5 + 1e-9 && high[1] < 0.5 + 1e-9);
}

static PetscBool Corner(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(low[0] < 1e-9 && low[1] < 1e-9);
}

static void CheckStable(PetscInt order, const InfSup *last, const InfSup *now)
{
  assert_int_equal(now->kernel, 1);
  assert_true(now->beta > 0.1);
  if (last && !(PetscAbsReal(now->beta / last->beta - 1) < 0.1)) fail_msg("order %d: beta %g after %g", (int)order, (double)now->beta, (double)last->beta);
}

static void Stable(void **state)
{
  for (PetscInt order = 2; order <= 4; ++order) {
    InfSup uniform[4], irregular[3], graded[4];
    for (PetscInt i = 0, n = 2; i < (order < 4 ? 4 : 3); ++i, n *= 2) {
      uniform[i] = Measure(Square(n), order, "uniform", n);
      if (n > 2) CheckStable(order, n > 4 ? &uniform[i - 1] : NULL, &uniform[i]);
    }
    for (PetscInt i = 0, n = 2; i < 3; ++i, n *= 2) {
      Forest forest = Square(n);
      Split(&forest, Quadrant);
      irregular[i] = Measure(forest, order, "1-irregular", n);
      CheckStable(order, i ? &irregular[i - 1] : NULL, &irregular[i]);
    }
    for (PetscInt i = 0; i < 4; ++i) {
      Forest forest = Square(4);
      for (PetscInt k = 0; k < 2 * (i + 1); ++k) Split(&forest, Corner);
      graded[i] = Measure(forest, order, "graded", 2 * (i + 1));
      CheckStable(order, i ? &graded[i - 1] : NULL, &graded[i]);
    }
  }
}

/* Constants and the checkerboard; what remains falls by half at each doubling in the end. */
static void LowestOrderIsNot(void **state)
{
  InfSup last = {0};

  for (PetscInt n = 4; n <= 16; n *= 2) {
    const InfSup now = Measure(Square(n), 1, "uniform", n);
    assert_int_equal(now.kernel, 2);
    if (n == 16) assert_true(now.beta / last.beta > 0.4 && now.beta / last.beta < 0.6);
    last = now;
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(LowestOrderIsNot), cmocka_unit_test(Stable)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
