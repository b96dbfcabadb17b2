/* Multigrid for the displacement block: cells of higher order first go to the space of order 1 on the same mesh (one level, one symmetric sweep of
   Gauss-Seidel before and after), whose matrix is the Galerkin product; from there algebraic multigrid by smoothed aggregation with the rigid-body
   modes, or a factorisation when it is small. */
#include "solveimpl.h"

#define SMALL 20000 /* unknowns of order 1 below which a factorisation is cheaper than a hierarchy */

struct _p_Multigrid {
  KSP          ksp;
  Mat          P, coarse; /* NULL: all cells have order 1 */
  MatNullSpace modes, coarse_modes;
};

/* Coarse solver: options prefix multigrid_mg_coarse_. */
static PetscErrorCode Coarse_Private(KSP coarse, PetscInt size)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPSetType(coarse, KSPPREONLY));
  PetscCall(KSPGetPC(coarse, &pc));
  if (size > SMALL)
    PetscCall(PCSetType(pc, PCGAMG));
  else {
    PetscCall(PCSetType(pc, PCCHOLESKY));
#if defined(PETSC_HAVE_MUMPS)
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
#endif
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TwoLevels_Private(Multigrid m, PC pc)
{
  PetscInt size;
  KSP      level;
  PC       smoother;

  PetscFunctionBegin;
  PetscCall(MatGetSize(m->P, NULL, &size));
  PetscCall(PCSetType(pc, PCMG));
  PetscCall(PCMGSetLevels(pc, 2, NULL));
  PetscCall(PCMGSetGalerkin(pc, PC_MG_GALERKIN_NONE));
  PetscCall(PCMGSetInterpolation(pc, 1, m->P));
  PetscCall(PCMGGetSmoother(pc, 1, &level));
  PetscCall(KSPSetType(level, KSPRICHARDSON));
  PetscCall(KSPSetTolerances(level, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 1));
  PetscCall(KSPGetPC(level, &smoother));
  PetscCall(PCSetType(smoother, PCSOR));
  PetscCall(PCMGGetCoarseSolve(pc, &level));
  PetscCall(Coarse_Private(level, size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MultigridCreate_Private(Problem problem, MPI_Comm comm, Multigrid *multigrid)
{
  Multigrid m;
  PC        pc;

  PetscFunctionBegin;
  PetscCall(PetscNew(&m));
  PetscCall(KSPCreate(comm, &m->ksp));
  PetscCall(KSPSetOptionsPrefix(m->ksp, "multigrid_"));
  PetscCall(KSPSetType(m->ksp, KSPPREONLY));
  PetscCall(KSPGetPC(m->ksp, &pc));
  PetscCall(ProblemRigidModes(problem, &m->modes));
  PetscCall(ProblemProlongation(problem, &m->P, &m->coarse_modes));
  if (m->P)
    PetscCall(TwoLevels_Private(m, pc));
  else
    PetscCall(PCSetType(pc, PCGAMG));
  PetscCall(KSPSetFromOptions(m->ksp));
  *multigrid = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MultigridDestroy_Private(Multigrid *multigrid)
{
  Multigrid m = *multigrid;

  PetscFunctionBegin;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&m->ksp));
  PetscCall(MatDestroy(&m->P));
  PetscCall(MatDestroy(&m->coarse));
  PetscCall(MatNullSpaceDestroy(&m->modes));
  PetscCall(MatNullSpaceDestroy(&m->coarse_modes));
  PetscCall(PetscFree(*multigrid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A: symmetric, borrowed until the next call. keep: the hierarchy of the last one will do. */
PetscErrorCode MultigridSetUp_Private(Multigrid m, Mat A, PetscBool keep)
{
  KSP coarse, fine;
  PC  pc;

  PetscFunctionBegin;
  PetscCall(MatSetNearNullSpace(A, m->modes));
  PetscCall(KSPGetPC(m->ksp, &pc));
  PetscCall(PCSetReusePreconditioner(pc, keep));
  PetscCall(KSPSetOperators(m->ksp, A, A));
  if (m->P) {
    PetscCall(PCMGGetSmoother(pc, 1, &fine));
    PetscCall(KSPSetOperators(fine, A, A));
  }
  if (m->P && !keep) {
    PetscCall(MatDestroy(&m->coarse));
    PetscCall(MatPtAP(A, m->P, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &m->coarse));
    PetscCall(MatSetOption(m->coarse, MAT_SYMMETRIC, PETSC_TRUE));
    PetscCall(MatSetNearNullSpace(m->coarse, m->coarse_modes));
    PetscCall(PCMGGetCoarseSolve(pc, &coarse));
    PetscCall(KSPSetOperators(coarse, m->coarse, m->coarse));
  }
  PetscCall(KSPSetUp(m->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One cycle. */
PetscErrorCode MultigridApply_Private(Multigrid m, Vec x, Vec y)
{
  PetscFunctionBegin;
  PetscCall(KSPSolve(m->ksp, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
