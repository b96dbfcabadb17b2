/* Is the map of a coarse cell one to one? The sign of its Jacobian determinant: at sample points, and where these leave doubt for the whole cell, by the
   determinant's Bernstein coefficients, which bound it. */
#include "forestimpl.h"

#define DEGREE 11   /* of the determinant, up to which coefficients are sought: geometry up to order 6 in the plane and 4 in space */
#define DOUBT 0.5   /* the least sample over the largest, above which samples tell enough */
#define HALVINGS 5  /* of the cell in each direction, after which bounds are as good as the samples of a part */
#define SMALL 1e-12 /* of the largest value: round-off */
enum { SIZE = DEGREE + 1, MOST = SIZE * SIZE * SIZE };

/* n values in each direction; c: lowest and highest. */
typedef struct {
  PetscInt  dim, n, num;
  PetscReal value[MOST];
} Grid;

static void Extremes_Private(const PetscReal value[], PetscInt num, PetscReal *lowest, PetscReal *highest)
{
  *lowest  = PETSC_MAX_REAL;
  *highest = -PETSC_MAX_REAL;
  for (PetscInt i = 0; i < num; ++i) {
    *lowest  = PetscMin(*lowest, value[i]);
    *highest = PetscMax(*highest, value[i]);
  }
}

/* The determinant at n equispaced points in each direction; value[n^dim], NULL: its extremes alone. */
static void Sample_Private(const CoarseMesh *mesh, PetscInt cell, PetscInt n, PetscReal value[], PetscReal *lowest, PetscReal *highest)
{
  const PetscInt dim = mesh->dim, nz = dim == 3 ? n : 1;
  PetscReal      J[9], X[3];

  *lowest  = PETSC_MAX_REAL;
  *highest = -PETSC_MAX_REAL;
  for (PetscInt k = 0; k < nz; ++k)
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = 0; i < n; ++i) {
        const PetscReal xi[3] = {(PetscReal)i / (n - 1), (PetscReal)j / (n - 1), (PetscReal)k / (n - 1)};
        ForestCoarseMapPoint(mesh, cell, xi, X, J);
        const PetscReal det = dim == 3 ? Det3(J) : J[0] * J[3] - J[1] * J[2];
        if (value) value[(k * n + j) * n + i] = det;
        *lowest  = PetscMin(*lowest, det);
        *highest = PetscMax(*highest, det);
      }
}

/* Each line of values along a direction times M[n][n]. */
static void Apply_Private(Grid *g, PetscInt direction, const PetscReal M[SIZE][SIZE])
{
  const PetscInt stride = direction == 0 ? 1 : direction == 1 ? g->n : g->n * g->n;

  for (PetscInt start = 0; start < g->num; ++start) {
    PetscReal line[SIZE];
    if (start / stride % g->n) continue;
    for (PetscInt i = 0; i < g->n; ++i) line[i] = g->value[start + i * stride];
    for (PetscInt i = 0; i < g->n; ++i) {
      PetscReal sum = 0;
      for (PetscInt j = 0; j < g->n; ++j) sum += M[i][j] * line[j];
      g->value[start + i * stride] = sum;
    }
  }
}

static PetscReal Choose_Private(PetscInt n, PetscInt k)
{
  PetscReal c = 1;

  for (PetscInt i = 0; i < k; ++i) c *= (PetscReal)(n - i) / (PetscReal)(i + 1);
  return c;
}

/* M: values at i/(n-1) -> Bernstein coefficients, the inverse of B_ij = C(n-1, j) t_i^j (1 - t_i)^(n-1-j), by Gauss and Jordan. */
static void Coefficients_Private(PetscInt n, PetscReal M[SIZE][SIZE])
{
  PetscReal B[SIZE][2 * SIZE] = {{0}};

  for (PetscInt i = 0; i < n; ++i) {
    const PetscReal t = (PetscReal)i / (PetscReal)(n - 1);
    for (PetscInt j = 0; j < n; ++j) B[i][j] = Choose_Private(n - 1, j) * PetscPowRealInt(t, (int)j) * PetscPowRealInt(1 - t, (int)(n - 1 - j));
    B[i][n + i] = 1;
  }
  for (PetscInt k = 0; k < n; ++k) {
    PetscInt pivot = k;
    for (PetscInt i = k; i < n; ++i)
      if (PetscAbsReal(B[i][k]) > PetscAbsReal(B[pivot][k])) pivot = i;
    for (PetscInt j = 0; j < 2 * n; ++j) {
      const PetscReal swap = B[k][j];
      B[k][j]              = B[pivot][j];
      B[pivot][j]          = swap;
    }
    for (PetscInt i = 0; i < n; ++i) {
      const PetscReal factor = i == k ? 0 : B[i][k] / B[k][k];
      for (PetscInt j = k; j < 2 * n && factor != 0; ++j) B[i][j] -= factor * B[k][j];
    }
  }
  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt j = 0; j < n; ++j) M[i][j] = B[i][n + j] / B[i][i];
}

/* Is the function with these coefficients above small everywhere? half: coefficients -> those of the lower and the upper half (de Casteljau). */
static PetscBool Positive_Private(const Grid *g, PetscReal small, const PetscReal half[2][SIZE][SIZE], PetscInt halvings)
{
  PetscReal lowest, highest;
  PetscBool positive = PETSC_TRUE;

  Extremes_Private(g->value, g->num, &lowest, &highest);
  if (lowest > small) return PETSC_TRUE;
  for (PetscInt corner = 0; corner < 1 << g->dim; ++corner) { /* the values there */
    PetscInt at = 0;
    for (PetscInt d = g->dim - 1; d >= 0; --d) at = at * g->n + (corner >> d & 1) * (g->n - 1);
    if (!(g->value[at] > small)) return PETSC_FALSE;
  }
  for (PetscInt part = 0; part < 1 << g->dim && halvings && positive; ++part) {
    Grid child = *g;
    for (PetscInt d = 0; d < g->dim; ++d) Apply_Private(&child, d, half[part >> d & 1]);
    positive = Positive_Private(&child, small, half, halvings - 1);
  }
  return positive;
}

/* The determinant times sign over the whole cell. */
static PetscBool Proven_Private(const CoarseMesh *mesh, PetscInt cell, PetscReal sign)
{
  PetscReal lowest, highest, M[SIZE][SIZE], half[2][SIZE][SIZE] = {{{0}}};
  Grid      g = {.dim = mesh->dim, .n = mesh->dim * mesh->geometry_order};

  g.num = g.n * g.n * (g.dim == 3 ? g.n : 1);
  Sample_Private(mesh, cell, g.n, g.value, &lowest, &highest);
  for (PetscInt i = 0; i < g.num; ++i) g.value[i] *= sign;
  Coefficients_Private(g.n, M);
  for (PetscInt d = 0; d < g.dim; ++d) Apply_Private(&g, d, M);
  for (PetscInt i = 0; i < g.n; ++i)
    for (PetscInt j = 0; j <= i; ++j) half[0][i][j] = half[1][g.n - 1 - i][g.n - 1 - j] = Choose_Private(i, j) * PetscPowRealInt(0.5, (int)i);
  return Positive_Private(&g, SMALL * PetscMax(PetscAbsReal(lowest), PetscAbsReal(highest)), half, HALVINGS);
}

PetscInt ForestCoarseJacobianSign(const CoarseMesh *mesh, PetscInt cell)
{
  PetscReal lowest, highest;

  Sample_Private(mesh, cell, mesh->geometry_order + 2, NULL, &lowest, &highest);
  /* A corner of a nearly flat angle is not inverted by rounding alone: the sign must be clear against the largest value. */
  const PetscReal most = PetscMax(PetscAbsReal(lowest), PetscAbsReal(highest)), least = PetscMin(PetscAbsReal(lowest), PetscAbsReal(highest));
  const PetscInt  sign = lowest > SMALL * most ? 1 : highest < -SMALL * most ? -1 : 0;

  if (!sign || least > DOUBT * most || mesh->dim * mesh->geometry_order - 1 > DEGREE) return sign;
  return Proven_Private(mesh, cell, (PetscReal)sign) ? sign : 0;
}
