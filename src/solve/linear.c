/* The linear solver: one direct factorisation by default, LDL^T where the tangent is symmetric, LU otherwise; MUMPS where PETSc has it; every option of KSP and
 * PC works as usual. */
#include "solveimpl.h"

PetscErrorCode SolverLinear_Private(Solver s)
{
  KSP ksp;
  PC  pc;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(s->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(PCSetType(pc, s->symmetric ? PCCHOLESKY : PCLU));
#if defined(PETSC_HAVE_MUMPS)
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}
