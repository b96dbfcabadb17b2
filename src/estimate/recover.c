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

PetscErrorCode RecoveryCreate_Private(PetscInt dim, VolumeTable *table)
{
  const PetscInt degree = table->order + RECOVERY_EXTRA, n = (dim == 2 ? (degree + 1) * (degree + 2) / 2 : (degree + 1) * (degree + 2) * (degree + 3) / 6) - 1;

  PetscFunctionBegin;
  table->num_functions = n;
  PetscCall(PetscMalloc2(table->num * n, &table->value, table->num * n * dim, &table->gradient));
  PetscCall(PetscMalloc2(n * n, &table->matrix, n * (dim + 1), &table->solution));
  for (PetscInt q = 0; q < table->num; ++q) {
    PetscInt num;
    PetscCall(Functions_Private(dim, degree, table->xi + q * dim, table->value + q * n, table->gradient + q * n * dim, &num));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RecoveryDestroy_Private(VolumeTable *table)
{
  PetscFunctionBegin;
  if (!table->value) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(table->value, table->gradient));
  PetscCall(PetscFree2(table->matrix, table->solution));
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

/* In-place Cholesky solution of A x = b, lower triangle. A direction without stiffness (to round-off) gets 0. */
static void Solve_Private(PetscInt n, PetscReal A[], PetscReal b[])
{
  for (PetscInt j = 0; j < n; ++j) {
    const PetscReal before = A[j * n + j];
    for (PetscInt k = 0; k < j; ++k) A[j * n + j] -= A[j * n + k] * A[j * n + k];
    const PetscBool dead = (PetscBool)(A[j * n + j] < 1e-13 * before);
    A[j * n + j]         = dead ? PETSC_MAX_REAL : PetscSqrtReal(A[j * n + j]);
    for (PetscInt i = j + 1; i < n; ++i) {
      for (PetscInt k = 0; k < j; ++k) A[i * n + j] -= A[i * n + k] * A[j * n + k];
      A[i * n + j] = dead ? 0 : A[i * n + j] / A[j * n + j];
    }
  }
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt k = 0; k < i; ++k) b[i] -= A[i * n + k] * b[k];
    b[i] /= A[i * n + i];
  }
  for (PetscInt i = n - 1; i >= 0; --i) {
    for (PetscInt k = i + 1; k < n; ++k) b[i] -= A[k * n + i] * b[k];
    b[i] /= A[i * n + i];
  }
}

/* Force T grad of every function at a Gauss point, [num_functions][dim]. */
static void Forces_Private(PetscInt dim, Kinematics kinematics, const VolumeTable *t, const CellWork *w, PetscInt q, PetscReal force[])
{
  const PetscReal *g = t->gradient + q * t->num_functions * dim;
  PetscReal        T[9];

  GradientMap_Private(dim, kinematics, w->F + 9 * q, w->J + 9 * q, T);
  for (PetscInt a = 0; a < t->num_functions; ++a) {
    for (PetscInt i = 0; i < dim; ++i) {
      force[a * dim + i] = 0;
      for (PetscInt r = 0; r < dim; ++r) force[a * dim + i] += T[i * dim + r] * g[a * dim + r];
    }
  }
}

/* Least squares fit of the coefficients, in table->solution. */
static void Fit_Private(PetscInt dim, Kinematics kinematics, VolumeTable *t, const CellWork *w)
{
  const PetscInt n = t->num_functions;
  PetscReal     *A = t->matrix, *b = t->solution, *force = t->solution + n;

  for (PetscInt k = 0; k < n * n; ++k) A[k] = 0;
  for (PetscInt k = 0; k < n; ++k) b[k] = 0;
  for (PetscInt q = 0; q < t->num; ++q) {
    Forces_Private(dim, kinematics, t, w, q, force);
    for (PetscInt a = 0; a < n; ++a) {
      for (PetscInt i = 0; i < dim; ++i) {
        const PetscReal f = w->weight[q] * force[a * dim + i];
        b[a] -= f * w->R[3 * q + i];
        for (PetscInt c = 0; c <= a; ++c) A[a * n + c] += f * force[c * dim + i];
      }
    }
  }
  Solve_Private(n, A, b);
}

PetscErrorCode EstimateRecover_Private(const EstimateSum *sum, VolumeTable *t, CellWork *w, PetscInt traces, const PetscReal xi[], const PetscReal F[],
                                       PetscReal P[])
{
  const PetscInt   dim = sum->v->dim, n = t->num_functions;
  const Kinematics kinematics = sum->spec->kinematics;
  PetscReal        mean = 0, volume = 0, value[ESTIMATE_MOST_NODES], cof[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, *force = t->solution + n;
  PetscInt         num;

  PetscFunctionBegin;
  Fit_Private(dim, kinematics, t, w);
  for (PetscInt q = 0; q < t->num; ++q) {
    Forces_Private(dim, kinematics, t, w, q, force);
    w->recovered[q] = 0;
    for (PetscInt a = 0; a < n; ++a) {
      w->recovered[q] += t->solution[a] * t->value[q * n + a];
      for (PetscInt i = 0; i < dim; ++i) w->R[3 * q + i] += t->solution[a] * force[a * dim + i];
    }
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
