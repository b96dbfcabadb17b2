/* Inverse iteration: the eigenvalue nearest to 0 of a matrix A against a diagonal D, A y = theta D y, with one factor of A. */
#include "solveimpl.h"

#define ITERATIONS 30

void SolverWithoutSymmetry_Private(const HPTables *v, PetscReal local[])
{
  for (PetscInt i = 0; i < v->num_nodes * v->dim; ++i) {
    const PetscReal *X = v->X + 3 * (i / v->dim), a = 1 + (PetscReal)(i % v->dim);
    local[i] = 1 / a + PetscSinReal(X[0] + PetscSqrtReal(3) * X[1] + PetscSqrtReal(5) * X[2] + a);
  }
}

PetscErrorCode SolverInverseIteration_Private(InverseApply apply, void *context, Vec scale, Vec rhs, Vec y, Lowest *low, PetscBool *ok)
{
  PetscReal product;
  PetscInt  order;

  PetscFunctionBegin;
  *low = (Lowest){0};
  for (PetscInt i = 0; i < ITERATIONS; ++i) {
    PetscCall(apply(context, (PetscBool)(i > 0), ok));
    if (!*ok) break;
    PetscCall(VecDot(rhs, y, &product));
    PetscCall(VecPointwiseMult(rhs, scale, y));
    PetscCall(VecDot(rhs, y, &low->norm2));
    *ok = (PetscBool)(low->norm2 > 0);
    if (!*ok) break;
    low->theta = product / low->norm2;
    PetscCall(VecScale(rhs, 1 / PetscSqrtReal(low->norm2)));
  }
  PetscCall(VecGetSize(y, &order));
  low->round_off = PETSC_MACHINE_EPSILON * (PetscReal)order; /* as the rank of a matrix is told in floating point */
  PetscFunctionReturn(PETSC_SUCCESS);
}
