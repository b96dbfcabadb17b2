/* The linear solver: one direct factorisation by default, LDL^T where the tangent is symmetric, LU otherwise; MUMPS where PETSc has it; every option of KSP and
 * PC works as usual. */
#include "solveimpl.h"

#define REFINEMENTS 12 /* triangular solves worth less than a factorisation in three dimensions */

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

#if defined(PETSC_HAVE_MUMPS)
/* Did MUMPS run out of its own workspace estimate? Then forget the factor and let the next one have four times the reserve (percent, ICNTL(14)). It has to
   come through the options: MUMPS ignores a new value between analysis and factorisation. */
static PetscErrorCode MoreWorkspace_Private(PC pc, PetscBool *again)
{
  Mat           F;
  MatSolverType type;
  PetscBool     mumps;
  PetscInt      info, reserve;
  char          text[16];

  PetscFunctionBegin;
  *again = PETSC_FALSE;
  PetscCall(PCFactorGetMatSolverType(pc, &type));
  PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, &mumps));
  if (!mumps) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(MatMumpsGetInfog(F, 1, &info));
  PetscCall(MatMumpsGetIcntl(F, 14, &reserve));
  if ((info != -8 && info != -9) || reserve > 1000) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(text, sizeof(text), "%" PetscInt_FMT, 4 * PetscMax(reserve, 20)));
  PetscCall(PetscOptionsSetValue(NULL, "-mat_mumps_icntl_14", text));
  PetscCall(PetscInfo(pc, "MUMPS ran out of workspace: reserve raised to %s percent\n", text));
  PetscCall(PCReset(pc));
  *again = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
#endif

/* Factorise A. A failure shows in the solve that follows. */
PetscErrorCode SolverFactor_Private(Solver s, Mat A)
{
  KSP ksp;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(s->snes, &ksp));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetUp(ksp));
#if defined(PETSC_HAVE_MUMPS)
  for (PetscBool again = PETSC_TRUE; again;) {
    PCFailedReason failed;
    PC             pc;
    again = PETSC_FALSE;
    PetscCall(KSPGetPC(ksp, &pc));
    PetscCall(PCGetFailedReason(pc, &failed));
    if (failed != PC_NOERROR) PetscCall(MoreWorkspace_Private(pc, &again));
    if (!again) break;
    PetscCall(KSPSetOperators(ksp, A, A));
    PetscCall(KSPSetUp(ksp));
  }
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve with the factor of an earlier tangent as preconditioner. Tangents of one problem differ little: a few rows switched by the active set, a Newton step
   taken; some triangular solves cost less than a new factor. *ok false: they do not get there, factorise. */
PetscErrorCode SolverRefine_Private(Solver s, Mat A, Vec rhs, PetscReal rtol, Vec x, PetscBool *ok)
{
  KSPConvergedReason reason;
  KSP                ksp;
  PC                 pc;

  PetscFunctionBegin;
  PetscCall(SNESGetKSP(s->snes, &ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  if (!s->refine) {
    PetscCall(KSPCreate(PetscObjectComm((PetscObject)A), &s->refine));
    PetscCall(KSPSetOptionsPrefix(s->refine, "again_"));
    PetscCall(KSPSetType(s->refine, KSPGMRES));
    PetscCall(KSPSetPCSide(s->refine, PC_RIGHT));
    PetscCall(KSPSetPC(s->refine, pc));
  }
  PetscCall(PCSetReusePreconditioner(pc, PETSC_TRUE));
  PetscCall(KSPSetOperators(s->refine, A, A));
  PetscCall(KSPSetTolerances(s->refine, rtol, PETSC_DEFAULT, PETSC_DEFAULT, REFINEMENTS));
  PetscCall(KSPSetFromOptions(s->refine));
  PetscCall(KSPSolve(s->refine, rhs, x));
  PetscCall(KSPGetConvergedReason(s->refine, &reason));
  PetscCall(PCSetReusePreconditioner(pc, PETSC_FALSE));
  *ok = (PetscBool)(reason > 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}
