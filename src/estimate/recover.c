/* The pressure of a mixed cell, improved by equilibrium. Why: in energy, a force that is the gradient of a pressure costs 1/kappa, not 1/mu; weighing all of
   Div P + B by 1/mu overestimates by sqrt(kappa/mu). The error of the discrete pressure pi is all but orthogonal to its own space (its projection error is of
   the order of the displacement's, times mu: inf-sup), so what is missing is q with
       cof F grad q = -(Div P + B)  as well as polynomials of degree p+2 can (least squares over the cell),  int q = 0,
   since Div(q cof F) = cof F grad q (Piola). With P + q cof F the residuals are free of the large gradient part, inside and on facets, and may be weighed
   by 1/mu; q itself is the error of the pressure and costs |q|^2/kappa. Any q gives an upper bound: for a test function v, int q cof F : grad v is either
   zero (volume kept) or paid for by kappa. Measured in tests/unit/test_estimate_effectivity_serial.c. */
#include "estimateimpl.h"

#define RECOVERY_EXTRA 2 /* degree of the recovered pressure above the order of the cell */

/* Products of Legendre polynomials of total degree 1..degree at xi: values and reference gradients. Returns their number. */
static PetscErrorCode Functions_Private(PetscInt dim, PetscInt degree, const PetscReal xi[], PetscReal value[], PetscReal gradient[], PetscInt *num)
{
  PetscReal L[3][MORTISE_MAX_ORDER + RECOVERY_EXTRA + 1], D[3][MORTISE_MAX_ORDER + RECOVERY_EXTRA + 1];

  PetscFunctionBegin;
  *num    = 0;
  L[2][0] = 1;
  D[2][0] = 0;
  for (PetscInt d = 0; d < dim; ++d) PetscCall(ElementLegendre(degree, xi[d], L[d], D[d]));
  for (PetscInt z = 0; z < (dim == 3 ? degree + 1 : 1); ++z) {
    for (PetscInt y = 0; y + z <= degree; ++y) {
      for (PetscInt x = y + z == 0; x + y + z <= degree; ++x) {
        value[*num] = L[0][x] * L[1][y] * L[2][z];
        if (gradient) {
          PetscReal *g = gradient + *num * dim;
          g[0]         = D[0][x] * L[1][y] * L[2][z];
          g[1]         = L[0][x] * D[1][y] * L[2][z];
          if (dim == 3) g[2] = L[0][x] * L[1][y] * D[2][z];
        }
        ++*num;
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The functions a row of lanes is made of: NUM_LANES of them to a block, zeros beyond the last. */
static PetscInt NumBlocks_Private(const VolumeTable *t)
{
  return (t->num_functions + NUM_LANES - 1) / NUM_LANES;
}

PetscErrorCode RecoveryCreate_Private(PetscInt dim, VolumeTable *table)
{
  const PetscInt degree = table->order + RECOVERY_EXTRA, n = (dim == 2 ? (degree + 1) * (degree + 2) / 2 : (degree + 1) * (degree + 2) * (degree + 3) / 6) - 1;
  PetscReal     *value, *gradient;

  PetscFunctionBegin;
  table->num_functions = n;
  const PetscInt width = NUM_LANES * NumBlocks_Private(table), rows = table->num * dim;
  PetscCall(PetscMalloc2(n, &value, n * dim, &gradient));
  PetscCall(PetscCalloc2(table->num * width, &table->value, rows * width, &table->gradient));
  PetscCall(PetscMalloc4(width * width, &table->matrix, 2 * width, &table->solution, rows * width, &table->force, rows * width, &table->weighted));
  for (PetscInt q = 0; q < table->num; ++q) {
    PetscInt num;
    PetscCall(Functions_Private(dim, degree, table->xi + q * dim, value, gradient, &num));
    for (PetscInt a = 0; a < n; ++a) {
      table->value[q * width + a] = value[a];
      for (PetscInt r = 0; r < dim; ++r) table->gradient[(q * dim + r) * width + a] = gradient[a * dim + r];
    }
  }
  PetscCall(PetscFree2(value, gradient));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RecoveryDestroy_Private(VolumeTable *table)
{
  PetscFunctionBegin;
  if (!table->value) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(table->value, table->gradient));
  PetscCall(PetscFree4(table->matrix, table->solution, table->force, table->weighted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Cofactor_Private(const PetscReal F[9], PetscReal cof[9])
{
  for (PetscInt k = 0; k < 9; ++k) {
    const PetscInt i1 = (k / 3 + 1) % 3, i2 = (k / 3 + 2) % 3, J1 = (k % 3 + 1) % 3, J2 = (k % 3 + 2) % 3;
    cof[k] = F[3 * i1 + J1] * F[3 * i2 + J2] - F[3 * i1 + J2] * F[3 * i2 + J1];
  }
}

/* T[dim][dim]: cof F J^-T, from reference-coordinate gradients to forces. Small: J^-T. */
static void GradientMap_Private(PetscInt dim, Kinematics kinematics, const PetscReal F[9], const PetscReal J[9], PetscReal T[9])
{
  PetscReal       cofF[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, cofJ[9];
  const PetscReal det     = Det3(J);

  if (kinematics == KINEMATICS_FINITE) Cofactor_Private(F, cofF);
  Cofactor_Private(J, cofJ); /* det J J^-T */
  for (PetscInt i = 0; i < dim; ++i) {
    for (PetscInt r = 0; r < dim; ++r) {
      T[i * dim + r] = 0;
      for (PetscInt K = 0; K < dim; ++K) T[i * dim + r] += cofF[3 * i + K] * cofJ[3 * K + r] / det;
    }
  }
}

/* In-place Cholesky solution of A x = b, A = U^T U by rows of `width`, upper triangle. A direction without stiffness (to round-off) gets 0. diagonal[n]: work.
 */
static void Solve_Private(PetscInt n, PetscInt width, PetscReal A[], PetscReal b[], PetscReal diagonal[])
{
  for (PetscInt j = 0; j < n; ++j) diagonal[j] = A[j * width + j];
  for (PetscInt j = 0; j < n; ++j) {
    PetscReal      *row  = A + j * width;
    const PetscBool dead = (PetscBool)(row[j] < 1e-13 * diagonal[j]);
    row[j]               = dead ? PETSC_MAX_REAL : PetscSqrtReal(row[j]);
    for (PetscInt k = j + 1; k < n; ++k) row[k] = dead ? 0 : row[k] / row[j];
    for (PetscInt i = j + 1; i < n; ++i) {
      PetscReal      *to = A + i * width;
      const PetscReal u  = row[i];
      for (PetscInt k = i; k < n; ++k) to[k] -= u * row[k];
    }
  }
  for (PetscInt j = 0; j < n; ++j) {
    b[j] /= A[j * width + j];
    for (PetscInt i = j + 1; i < n; ++i) b[i] -= A[j * width + i] * b[j];
  }
  for (PetscInt i = n - 1; i >= 0; --i) {
    for (PetscInt k = i + 1; k < n; ++k) b[i] -= A[i * width + k] * b[k];
    b[i] /= A[i * width + i];
  }
}

/* Force T grad of every function at the Gauss points, one row for each point and direction; and the same times the point's weight. */
static void Forces_Private(PetscInt dim, Kinematics kinematics, const VolumeTable *t, const CellWork *w)
{
  const PetscInt width = NUM_LANES * NumBlocks_Private(t);

  for (PetscInt q = 0; q < t->num; ++q) {
    PetscReal T[9];
    GradientMap_Private(dim, kinematics, w->F + 9 * q, w->J + 9 * q, T);
    for (PetscInt i = 0; i < dim; ++i) {
      PetscReal *force = t->force + (q * dim + i) * width, *weighted = t->weighted + (q * dim + i) * width;
      for (PetscInt a = 0; a < width; a += NUM_LANES) {
        Lanes sum = {0};
        for (PetscInt r = 0; r < dim; ++r) sum += T[i * dim + r] * *(const LanesAny *)(t->gradient + (q * dim + r) * width + a);
        *(LanesAny *)(force + a)    = sum;
        *(LanesAny *)(weighted + a) = w->weight[q] * sum;
      }
    }
  }
}

#define TILE 4 /* rows of the matrix, by two blocks of lanes: as many sums as stay in registers */

/* A = sum over rows of weighted (x) force, blocks on and right of the diagonal. */
static void Matrix_Private(PetscInt rows, const VolumeTable *t)
{
  const PetscInt width = NUM_LANES * NumBlocks_Private(t);

  for (PetscInt a = 0; a < width; a += TILE) {
    for (PetscInt c = a / NUM_LANES * NUM_LANES; c < width; c += 2 * NUM_LANES) {
      const PetscInt next         = c + NUM_LANES < width ? NUM_LANES : 0; /* the last block may stand alone: then it is summed twice */
      Lanes          sum[TILE][2] = {{{0}}};
      for (PetscInt k = 0; k < rows; ++k) {
        const PetscReal *f = t->weighted + k * width + a;
        const Lanes      x = *(const LanesAny *)(t->force + k * width + c), y = *(const LanesAny *)(t->force + k * width + c + next);
        for (PetscInt i = 0; i < TILE; ++i) {
          sum[i][0] += f[i] * x;
          sum[i][1] += f[i] * y;
        }
      }
      for (PetscInt i = 0; i < TILE; ++i) {
        *(LanesAny *)(t->matrix + (a + i) * width + c)        = sum[i][0];
        *(LanesAny *)(t->matrix + (a + i) * width + c + next) = sum[i][1];
      }
    }
  }
}

/* Least squares fit of the coefficients, in table->solution. */
static void Fit_Private(PetscInt dim, VolumeTable *t, const CellWork *w)
{
  const PetscInt width = NUM_LANES * NumBlocks_Private(t);
  PetscReal     *b     = t->solution;

  Matrix_Private(t->num * dim, t);
  for (PetscInt a = 0; a < width; ++a) b[a] = 0;
  for (PetscInt k = 0; k < t->num * dim; ++k) {
    const PetscReal R = w->R[3 * (k / dim) + k % dim];
    for (PetscInt a = 0; a < width; ++a) b[a] -= R * t->weighted[k * width + a];
  }
  Solve_Private(t->num_functions, width, t->matrix, b, b + width);
}

/* sum over n numbers of a b, in lanes. */
static PetscReal Product_Private(PetscInt n, const PetscReal a[], const PetscReal b[])
{
  Lanes     sum   = {0};
  PetscReal total = 0;

  for (PetscInt i = 0; i < n; i += NUM_LANES) sum += *(const LanesAny *)(a + i) * *(const LanesAny *)(b + i);
  for (PetscInt l = 0; l < NUM_LANES; ++l) total += sum[l];
  return total;
}

PetscErrorCode EstimateRecover_Private(const EstimateSum *sum, VolumeTable *t, CellWork *w, PetscInt traces, const PetscReal xi[], const PetscReal F[],
                                       PetscReal P[])
{
  const PetscInt   dim = sum->v->dim, n = t->num_functions, width = NUM_LANES * NumBlocks_Private(t);
  const Kinematics kinematics = sum->spec->kinematics;
  PetscReal        mean = 0, volume = 0, value[ESTIMATE_MOST_NODES], cof[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscInt         num;

  PetscFunctionBegin;
  Forces_Private(dim, kinematics, t, w);
  Fit_Private(dim, t, w);
  for (PetscInt q = 0; q < t->num; ++q) {
    w->recovered[q] = Product_Private(width, t->solution, t->value + q * width);
    for (PetscInt i = 0; i < dim; ++i) w->R[3 * q + i] += Product_Private(width, t->solution, t->force + (q * dim + i) * width);
    mean += w->weight[q] * w->recovered[q];
    volume += w->weight[q];
  }
  mean /= volume;
  for (PetscInt q = 0; q < t->num; ++q) w->recovered[q] -= mean;
  for (PetscInt i = 0; i < traces; ++i) {
    PetscReal pressure = -mean;
    PetscCall(Functions_Private(dim, t->order + RECOVERY_EXTRA, xi + i * dim, value, NULL, &num));
    for (PetscInt a = 0; a < n; ++a) pressure += t->solution[a] * value[a];
    if (kinematics == KINEMATICS_FINITE) Cofactor_Private(F + 9 * i, cof);
    for (PetscInt k = 0; k < 9; ++k) P[9 * i + k] += pressure * cof[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
