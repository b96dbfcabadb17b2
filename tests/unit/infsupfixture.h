/* Numerical inf-sup constants of pairs Q_k / P_(k-1) on boxes: beta^2 is the least nonzero eigenvalue of M^-1 B K^-1 B^T, K the norm |grad u|^2,
   M the pressures' mass, B the coupling that the condensed tangent of the program contains. */
#pragma once
#include "mechanicsimpl.h"
#include "problemfixture.h"
#include "solvefixture.h"
#include <petscblaslapack.h>

#define MOST_NODES 343 /* order 6 in space */

/* CLAMPED: u = 0 all round. STANDING: on the bottom alone. LINEAR: STANDING, and the faces of the top have order 1. */
typedef enum { CLAMPED, STANDING, LINEAR } Support;
static const char *const support_names[] = {"clamped", "standing", "linear top"};

typedef struct {
  PetscInt  kernel; /* pressures that do no work on any displacement */
  PetscReal beta;   /* the least nonzero value */
} InfSup;

/* Bottom: side 2*dim - 2, top: 2*dim - 1. orders[num_leaves] */
static inline void Supported(Bulk *b, Forest forest, const int8_t orders[], Support support)
{
  const ForestTables *t;
  PetscInt            dim;

  t   = ForestGetTables(forest);
  dim = t->dim;
  *b  = (Bulk){.forest = forest};
  BulkInit(b, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_SMALL);
  BulkMaterial(&b->material, "linear", VOLUMETRIC_QUADRATIC, FORMULATION_MIXED, 1, 1);
  for (PetscInt s = 0; s < 2 * dim; ++s)
    for (PetscInt c = 0; c < dim; ++c) b->boundaries[s].fix[c] = (PetscBool)(support == CLAMPED || s == 2 * dim - 2);
  OK(PetscMalloc1(t->num_leaves, &b->orders));
  OK(PetscArraycpy(b->orders, orders, t->num_leaves));
  OK(HPSpaceCreate(forest, b->orders, NULL, support == LINEAR ? (uint64_t)1 << (2 * dim - 1) : 0, 0, &b->space));
  OK(MechanicsSupportsCreate(b->space, &b->spec, &b->supports));
  OK(HPSpaceSetUp(b->space, b->supports.fixed, 0, NULL, NULL));
  OK(MechanicsCreate(b->space, &b->spec, &b->supports, &b->mechanics));
  OK(MechanicsSetTime(b->mechanics, 1));
}

/* Gauss points of a cell with positions X, exact for products of two of its functions if it is affine: weights times volume, and gradients [node][dim] of
   its functions unless NULL. Returns their number. */
static inline PetscInt Points(PetscInt dim, PetscInt order, const PetscReal X[], PetscReal xi[], PetscReal weight[], PetscReal (*gradient)[3 * MOST_NODES])
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

static inline PetscInt NumFree(const Bulk *b, const PetscInt **global)
{
  const HPTables *v;
  PetscInt        n = 0;

  v = HPSpaceGetTables(b->space);
  OK(HPSpaceGetGlobalDofs(b->space, global));
  for (PetscInt i = 0; i < v->dim * v->num_nodes; ++i) n = PetscMax(n, (*global)[i] + 1);
  return n;
}

/* int grad Na : grad Nb of a cell, [n*dim][n*dim]. */
static inline void CellNorm(const Bulk *b, PetscInt dim, PetscInt order, PetscInt cell, PetscReal K[])
{
  static PetscReal   gradient[MOST_NODES][3 * MOST_NODES], slope[3 * MOST_NODES * MOST_NODES], sum[MOST_NODES * MOST_NODES];
  PetscReal          X[3 * MOST_NODES], xi[3 * MOST_NODES], weight[MOST_NODES], one = 1, zero = 0;
  const PetscInt     n    = ElementNumNodes(dim, order);
  const PetscBLASInt size = (PetscBLASInt)n;

  OK(HPSpaceGatherPositions(b->space, cell, X));
  const PetscInt     np    = Points(dim, order, X, xi, weight, gradient);
  const PetscBLASInt inner = (PetscBLASInt)(dim * np);
  for (PetscInt p = 0; p < np; ++p)
    for (PetscInt i = 0; i < n; ++i)
      for (PetscInt c = 0; c < dim; ++c) slope[(dim * p + c) * n + i] = PetscSqrtReal(weight[p]) * gradient[p][dim * i + c];
  BLASgemm_("N", "T", &size, &size, &inner, &one, slope, &size, slope, &size, &zero, sum, &size);
  OK(PetscArrayzero(K, PetscSqr(dim * n)));
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt c = 0; c < dim; ++c) K[(dim * i + c) * dim * n + dim * j + c] = sum[i * n + j];
}

/* Adds the norm to the first rows and columns of A. */
static inline void Norm(const Bulk *b, Mat A)
{
  const HPTables *v;
  Assembly        a = {.A = A};

  v = HPSpaceGetTables(b->space);
  OK(HPSpaceGetGlobalDofs(b->space, &a.global));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt nodes = PetscMax(ElementNumNodes(v->dim, v->cell_order[c]), v->cell_row[c + 1] - v->cell_row[c]), size = v->dim * nodes;
    PetscReal     *K, *Km;
    PetscInt      *dofs, num;
    OK(PetscMalloc3(size * size, &K, size * size, &Km, size, &dofs));
    CellNorm(b, v->dim, v->cell_order[c], c, K);
    OK(HPSpaceTransformMatrix(b->space, c, K, Km, dofs, &num));
    OK(Insert(&a, c, num, dofs, Km));
    OK(PetscFree3(K, Km, dofs));
  }
}

static inline PetscErrorCode Ignore(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  return PETSC_SUCCESS;
}

/* Lower Cholesky factor of the pressure mass of a cell with positions X. */
static inline void MassFactor(PetscInt dim, PetscInt order, PetscInt m, const PetscReal X[], PetscReal *L)
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

/* Columns L^T M^-1 b of all pressures, behind the n of A, from the derivative of the condensed pressure that the tangent leaves behind; on the diagonal 0. */
static inline void Coupling(const Bulk *b, PetscInt n, Mat A)
{
  const Mechanics  mech = b->mechanics;
  const HPTables  *v;
  const PetscInt  *global;
  const PetscReal *dpressure = mech->dpressure;
  PetscReal       *u, *r, X[3 * MOST_NODES], L[MOST_PRESSURES * MOST_PRESSURES];
  PetscInt         column = n;
  PetscBool        bad;

  v = HPSpaceGetTables(b->space);
  OK(HPSpaceGetGlobalDofs(b->space, &global));
  OK(PetscCalloc1(v->dim * v->num_nodes, &u));
  OK(PetscMalloc1(v->dim * v->num_nodes, &r));
  OK(MechanicsTangent(mech, u, NULL, Ignore, NULL, &bad));
  for (PetscInt k = 0; k < mech->num_groups; ++k) {
    const CellGroup *g  = &mech->groups[k];
    const PetscInt   nd = v->dim * g->n;
    for (PetscInt c = 0; c < g->num_cells; ++c, dpressure += g->m * nd) {
      OK(HPSpaceGatherPositions(b->space, g->cells[c], X));
      MassFactor(v->dim, g->order, g->m, X, L);
      for (PetscInt l = 0; l < g->m; ++l, ++column) {
        PetscReal row[3 * MOST_NODES] = {0};
        for (PetscInt j = l; j < g->m; ++j)
          for (PetscInt i = 0; i < nd; ++i) row[i] += L[j * g->m + l] * dpressure[j * nd + i] / MaterialVolumetricModulus(&b->material);
        OK(PetscArrayzero(r, v->dim * v->num_nodes));
        OK(HPSpaceScatterAdd(b->space, g->cells[c], row, r));
        for (PetscInt i = 0; i < v->dim * v->num_nodes; ++i)
          if (global[i] >= 0 && r[i] != 0) OK(MatSetValue(A, global[i], column, r[i], INSERT_VALUES));
        OK(MatSetValue(A, column, column, 0, INSERT_VALUES));
      }
    }
  }
  OK(PetscFree(u));
  OK(PetscFree(r));
}

/* K and B of n displacements and m pressures, the upper triangle of [K B; B^T 0]. */
static inline Mat Saddle(const Bulk *b, PetscInt n, PetscInt m)
{
  const HPTables *v;
  PetscInt        order = 1;
  Mat             A;

  v = HPSpaceGetTables(b->space);
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) order = PetscMax(order, v->cell_order[c]);
  OK(MatCreateSeqAIJ(PETSC_COMM_SELF, n + m, n + m, 3 * ElementNumNodes(v->dim, 2 * order), NULL, &A)); /* more than a row of a regular mesh */
  OK(MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  OK(MatSetOption(A, MAT_IGNORE_ZERO_ENTRIES, PETSC_TRUE)); /* components do not couple */
  Norm(b, A);
  OK(MatAssemblyBegin(A, MAT_FLUSH_ASSEMBLY));
  OK(MatAssemblyEnd(A, MAT_FLUSH_ASSEMBLY));
  Coupling(b, n, A);
  OK(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  OK(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  return A;
}

/* Ascending eigenvalues of B^T K^-1 B, less the Schur complement of the pressures: MUMPS, which has use for B's zeros, forms it while it factors K. */
static inline void Eigenvalues(Mat A, PetscInt n, PetscInt m, PetscReal *value)
{
  Mat           factor, S;
  IS            pressures;
  MatFactorInfo info;
  PetscReal    *array, *work;
  PetscBLASInt  size = (PetscBLASInt)m, length = 34 * size, error;

  OK(ISCreateStride(PETSC_COMM_SELF, m, n, 1, &pressures));
  OK(MatFactorInfoInitialize(&info));
  OK(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor));
  OK(MatFactorSetSchurIS(factor, pressures));
  OK(MatCholeskyFactorSymbolic(factor, A, NULL, &info));
  OK(MatCholeskyFactorNumeric(factor, A, &info));
  OK(MatFactorCreateSchurComplement(factor, &S, NULL));
  OK(MatScale(S, -1));
  OK(MatDenseGetArray(S, &array));
  OK(PetscMalloc1(length, &work));
  LAPACKsyev_("N", "L", &size, array, &size, value, work, &length, &error);
  assert_int_equal(error, 0);
  OK(PetscFree(work));
  OK(MatDenseRestoreArray(S, &array));
  OK(ISDestroy(&pressures));
  OK(MatDestroy(&factor));
  OK(MatDestroy(&S));
}

/* Pairs of orders[num_leaves] (order: the largest, for the message). Takes the forest over. */
static inline InfSup MeasureOrders(Forest forest, const int8_t orders[], PetscInt order, Support support, const char *what, PetscInt n)
{
  Bulk            b;
  const PetscInt *global;
  PetscReal      *value;
  InfSup          result = {0};

  Supported(&b, forest, orders, support);
  const PetscInt dim = b.mechanics->dim, num = NumFree(&b, &global), m = b.mechanics->num_pressure;
  Mat            A = Saddle(&b, num, m);
  OK(PetscMalloc1(m, &value));
  Eigenvalues(A, num, m, value);
  while (result.kernel < m && value[result.kernel] < 1e-10) ++result.kernel;
  result.beta = result.kernel < m ? PetscSqrtReal(value[result.kernel]) : 0;
  assert_true(value[m - 1] <= (support == CLAMPED ? 1 : dim) + 1e-10); /* |grad u|^2 = |div u|^2 + |curl u|^2 if u = 0 all round */
  print_message("%" PetscInt_FMT "-D Q%" PetscInt_FMT "/P%" PetscInt_FMT " %-10s %-11s %2" PetscInt_FMT ": %5" PetscInt_FMT " displacements, %4" PetscInt_FMT
                " pressures, kernel %2" PetscInt_FMT ", beta %.4f\n",
                dim, order, order - 1, support_names[support], what, n, num, m, result.kernel, (double)result.beta);
  OK(PetscFree(value));
  OK(MatDestroy(&A));
  BulkDestroy(&b);
  return result;
}

static inline InfSup Measure(Forest forest, PetscInt order, Support support, const char *what, PetscInt n)
{
  const ForestTables *t;
  InfSup              result;
  int8_t             *orders;

  t = ForestGetTables(forest);
  OK(PetscMalloc1(t->num_leaves, &orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) orders[l] = (int8_t)order;
  result = MeasureOrders(forest, orders, order, support, what, n);
  OK(PetscFree(orders));
  return result;
}

/* n cells in each direction. */
static inline Forest Unit(PetscInt dim, PetscInt n)
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
static inline void Split(Forest *forest, Choice choice)
{
  const ForestTables *t;
  MarkList            marks;

  t = ForestGetTables(*forest);
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    PetscReal a[3], b[3], low[3], high[3];
    OK(ForestMapPoint(*forest, l, (const PetscReal[3]){0, 0, 0}, a));
    OK(ForestMapPoint(*forest, l, (const PetscReal[3]){1, 1, 1}, b));
    for (PetscInt c = 0; c < 3; ++c) low[c] = PetscMin(a[c], b[c]), high[c] = PetscMax(a[c], b[c]);
    marks.split[l] = (int8_t)(choice(low, high) ? (1 << t->dim) - 1 : 0);
  }
  AdaptBy(forest, &marks);
}

/* Third coordinates are 0 in the plane. */
static inline PetscBool Orthant(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(high[0] < 0.5 + 1e-9 && high[1] < 0.5 + 1e-9 && high[2] < 0.5 + 1e-9);
}

static inline PetscBool Corner(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(low[0] < 1e-9 && low[1] < 1e-9 && low[2] < 1e-9);
}

/* The one cell in the middle of an odd number. */
static inline PetscBool Middle(const PetscReal low[3], const PetscReal high[3])
{
  return (PetscBool)(low[0] < 0.5 && high[0] > 0.5 && low[1] < 0.5 && high[1] > 0.5 && low[2] < 0.5 && (high[2] > 0.5 || high[2] < 1e-9));
}

static inline Forest Refined(PetscInt dim, PetscInt n, Choice choice, PetscInt times)
{
  Forest forest = Unit(dim, n);

  for (PetscInt k = 0; k < times; ++k) Split(&forest, choice);
  return forest;
}

/* last (NULL: none): the mesh `doublings` coarser. Q1/P0 of n = 16 in the plane and of 4 in space is below the floor. */
static inline void CheckStable(Support support, PetscInt order, PetscReal doublings, const InfSup *last, const InfSup *now)
{
  assert_int_equal(now->kernel, support == CLAMPED);
  assert_true(now->beta > 0.3);
  if (last && !(PetscAbsReal(PetscPowReal(now->beta / last->beta, 1 / doublings) - 1) < 0.1))
    fail_msg("order %d: beta %g after %g", (int)order, (double)now->beta, (double)last->beta);
}

/* Against a figure from elsewhere, to its last digit. */
static inline void CheckFigure(PetscReal beta, PetscReal figure, PetscReal digit)
{
  if (!(PetscAbsReal(beta - figure) < digit)) fail_msg("beta %g, known as %g", (double)beta, (double)figure);
}
