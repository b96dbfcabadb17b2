/* Multigrid for the displacement block. The space of order 1 on the same mesh, in whole blocks of a vertex, has the Galerkin matrix P^T A P with ones for
   prescribed components; it is treated by smoothed aggregation with the rigid-body modes, or factorised when it is small. Cells of higher order have one
   level above it, with a symmetric sweep of Gauss-Seidel before and after; cells of order 1 need none, P only completes the blocks. */
#include "solveimpl.h"

#define SMALL 20000 /* unknowns of order 1 below which a factorisation is cheaper than a hierarchy */

struct _p_Multigrid {
  KSP          coarse, smoother; /* smoother NULL: order 1 */
  Mat          A, P, pinned, A1; /* A borrowed */
  MatNullSpace modes;
  Vec          x1, y1, r, y; /* y: a second sweep's correction */
};

static PetscErrorCode Coarse_Private(Multigrid m)
{
  PetscInt size;
  PC       pc;

  PetscFunctionBegin;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)m->P), &m->coarse));
  PetscCall(KSPSetOptionsPrefix(m->coarse, "multigrid_"));
  PetscCall(KSPSetType(m->coarse, KSPPREONLY));
  PetscCall(KSPGetPC(m->coarse, &pc));
  PetscCall(MatGetSize(m->P, NULL, &size));
  if (!m->smoother || size > SMALL)
    PetscCall(PCSetType(pc, PCGAMG));
  else {
    PetscCall(PCSetType(pc, PCCHOLESKY));
#if defined(PETSC_HAVE_MUMPS)
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
#endif
  }
  PetscCall(KSPSetFromOptions(m->coarse));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Smoother_Private(Multigrid m)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)m->P), &m->smoother));
  PetscCall(KSPSetOptionsPrefix(m->smoother, "multigrid_smoother_"));
  PetscCall(KSPSetType(m->smoother, KSPRICHARDSON));
  PetscCall(KSPSetNormType(m->smoother, KSP_NORM_NONE));
  PetscCall(KSPSetConvergenceTest(m->smoother, KSPConvergedSkip, NULL, NULL));
  PetscCall(KSPSetTolerances(m->smoother, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 1));
  PetscCall(KSPGetPC(m->smoother, &pc));
  PetscCall(PCSetType(pc, PCSOR));
  PetscCall(KSPSetFromOptions(m->smoother));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MultigridCreate_Private(Problem problem, Multigrid *multigrid)
{
  Multigrid m;
  PetscBool higher;

  PetscFunctionBegin;
  PetscCall(PetscNew(&m));
  PetscCall(ProblemProlongation(problem, &m->P, &m->pinned, &m->modes, &higher));
  if (higher) PetscCall(Smoother_Private(m));
  PetscCall(Coarse_Private(m));
  PetscCall(MatCreateVecs(m->P, &m->x1, &m->r));
  PetscCall(VecDuplicate(m->x1, &m->y1));
  PetscCall(VecDuplicate(m->r, &m->y));
  *multigrid = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MultigridDestroy_Private(Multigrid *multigrid)
{
  Multigrid m = *multigrid;

  PetscFunctionBegin;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&m->coarse));
  PetscCall(KSPDestroy(&m->smoother));
  PetscCall(MatDestroy(&m->P));
  PetscCall(MatDestroy(&m->pinned));
  PetscCall(MatDestroy(&m->A1));
  PetscCall(MatNullSpaceDestroy(&m->modes));
  PetscCall(VecDestroy(&m->x1));
  PetscCall(VecDestroy(&m->y1));
  PetscCall(VecDestroy(&m->r));
  PetscCall(VecDestroy(&m->y));
  PetscCall(PetscFree(*multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A1 = P^T A P + scale * pinned, scale the mean of A's diagonal. */
static PetscErrorCode Galerkin_Private(Multigrid m)
{
  Vec         diagonal;
  PetscScalar sum;
  PetscInt    size;

  PetscFunctionBegin;
  PetscCall(MatDestroy(&m->A1));
  PetscCall(MatPtAP(m->A, m->P, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &m->A1));
  PetscCall(MatCreateVecs(m->A, &diagonal, NULL));
  PetscCall(MatGetDiagonal(m->A, diagonal));
  PetscCall(VecSum(diagonal, &sum));
  PetscCall(VecGetSize(diagonal, &size));
  PetscCall(VecDestroy(&diagonal));
  PetscCall(MatAXPY(m->A1, sum / (PetscReal)PetscMax(size, 1), m->pinned, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatSetOption(m->A1, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(MatSetNearNullSpace(m->A1, m->modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A: symmetric or nearly so, borrowed until the next call. keep: the coarse matrix of the last one will do. */
PetscErrorCode MultigridSetUp_Private(Multigrid m, Mat A, PetscBool keep)
{
  PetscFunctionBegin;
  m->A = A;
  if (m->smoother) {
    PetscCall(KSPSetOperators(m->smoother, A, A));
    PetscCall(KSPSetUp(m->smoother));
  }
  if (keep) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Galerkin_Private(m));
  PetscCall(KSPSetOperators(m->coarse, m->A1, m->A1));
  PetscCall(KSPSetUp(m->coarse));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One symmetric cycle: y = M x. */
PetscErrorCode MultigridApply_Private(Multigrid m, Vec x, Vec y)
{
  PetscFunctionBegin;
  if (!m->smoother) {
    PetscCall(MatMultTranspose(m->P, x, m->x1));
    PetscCall(KSPSolve(m->coarse, m->x1, m->y1));
    PetscCall(MatMult(m->P, m->y1, y));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(KSPSolve(m->smoother, x, y));
  PetscCall(MatMult(m->A, y, m->r));
  PetscCall(VecAYPX(m->r, -1, x));
  PetscCall(MatMultTranspose(m->P, m->r, m->x1));
  PetscCall(KSPSolve(m->coarse, m->x1, m->y1));
  PetscCall(MatMultAdd(m->P, m->y1, y, y));
  PetscCall(MatMult(m->A, y, m->r));
  PetscCall(VecAYPX(m->r, -1, x));
  PetscCall(KSPSolve(m->smoother, m->r, m->y));
  PetscCall(VecAXPY(y, 1, m->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
