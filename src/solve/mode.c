/* The mode in which an equilibrium is least stiff: the eigenvector of the eigenvalue nearest to 0 of its tangent K against D, which is as large as the entries
   of the rows of displacements; by inverse iteration with one factor. At a bifurcation or a limit point that eigenvalue is 0. */
#include "solveimpl.h"

#define ITERATIONS 30

/* D: the largest entry of each row of displacements, 0 for all others. */
static PetscErrorCode Scale_Private(Solver s, Mat A, Vec scale)
{
  PetscInt   num_u, num_z, dim, num;
  PetscReal *array;

  PetscFunctionBegin;
  PetscCall(MatGetRowMaxAbs(A, scale, NULL));
  ProblemGetBlocks(s->problem, &num_u, &num_z, &dim);
  PetscCall(VecGetLocalSize(scale, &num));
  PetscCall(VecGetArray(scale, &array));
  for (PetscInt i = num_u; i < num; ++i) array[i] = 0;
  PetscCall(VecRestoreArray(scale, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K y = D v, again and again, from forces without symmetry. s->y is the mode. */
static PetscErrorCode Iterate_Private(Solver s, Vec scale, PetscReal *stiffness)
{
  PetscReal  norm2, product;
  PetscInt   first, num;
  PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetOwnershipRange(s->rhs, &first, &num));
  PetscCall(VecGetArray(s->rhs, &array));
  for (PetscInt i = 0; i < num - first; ++i) array[i] = 1 + PetscSinReal(PetscSqrtReal(3) * (PetscReal)(first + i));
  PetscCall(VecRestoreArray(s->rhs, &array));
  PetscCall(VecPointwiseMult(s->rhs, s->rhs, scale));
  for (PetscInt i = 0; i < ITERATIONS; ++i) {
    PetscCall(SolverMatrixSolve_Private(s, s->rhs, (PetscBool)(i > 0)));
    if (s->no_solution) break;
    PetscCall(VecDot(s->rhs, s->y, &product));
    PetscCall(VecPointwiseMult(s->rhs, s->y, scale));
    PetscCall(VecDot(s->rhs, s->y, &norm2));
    if (!(norm2 > 0)) break;
    *stiffness = product / norm2;
    PetscCall(VecScale(s->rhs, 1 / PetscSqrtReal(norm2)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverLowestMode(Solver s, State *state, PetscReal *stiffness, Vec mode, PetscBool *known)
{
  SolverReport report = {.reason = ""};
  Vec          scale, r;
  PetscInt     order;
  PetscBool    bad;
  Mat          A;

  PetscFunctionBegin;
  *known      = PETSC_FALSE;
  *stiffness  = 0;
  s->report   = &report;
  s->pressure = state->pressure;
  s->form     = state->form;
  PetscCall(ProblemSetState(s->problem, state));
  s->form.symmetric = s->symmetric;
  PetscCall(ProblemSetForm(s->problem, &s->form));
  PetscCall(ProblemSearch(s->problem, state->x));
  PetscCall(VecDuplicate(state->x, &r));
  PetscCall(ProblemResidual(s->problem, state->x, NULL, r, &report.status));
  PetscCall(VecDestroy(&r));
  PetscCall(VecZeroEntries(s->lift));
  PetscCall(ProblemTangent(s->problem, state->x, s->pressure, s->lift, &bad));
  if (!bad && s->symmetric && !ProblemGetSymmetric(s->problem)) PetscCall(SolverUnsymmetric_Private(s));
  if (!bad) {
    PetscCall(ProblemGetMatrix(s->problem, &A));
    PetscCall(VecDuplicate(s->rhs, &scale));
    PetscCall(Scale_Private(s, A, scale));
    PetscCall(Iterate_Private(s, scale, stiffness));
    PetscCall(VecDestroy(&scale));
    PetscCall(VecGetSize(s->y, &order));
    *known = (PetscBool)!s->no_solution;
    if (PetscAbsReal(*stiffness) <= PETSC_MACHINE_EPSILON * (PetscReal)order) *stiffness = 0; /* as the rank of a matrix is told in floating point */
    PetscCall(PetscInfo(s->snes, "softest mode: eigenvalue %g\n", (double)*stiffness));
    if (*known && mode) PetscCall(ProblemRecover(s->problem, s->y, mode));
  }
  s->report   = NULL;
  s->pressure = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
