/* The linear solver: one direct factorisation by default, LDL^T where the tangent is symmetric, LU otherwise; MUMPS, in single precision
 * with GMRES in double where that pays; every option of KSP and PC works as usual. */
#include "solveimpl.h"

/* A factor as preconditioner: with less than this, nodes at the edge of contact switch wrongly, and a slide that needs no cut is cut. */
#define REFINE_RTOL 1e-10
#define REFINEMENTS 20       /* triangular solves worth less than a factorisation in three dimensions */
#define FRESH_RTOL 1e-12     /* with the factor of the very matrix: nearly what one in double gives, for an iteration more */
#define FORCING 0.01         /* of the relative residual of Newton's method: to what GMRES goes */
#define TRUE_RTOL 1e-8       /* what round-off may leave */
#define MOST_OPERATIONS 36e3 /* of a factorisation for each entry of the matrix: from there on multigrid is faster, with order 1 */

/* What factorises the tangent, in the precision that serves. */
static PetscErrorCode Kind_Private(Solver s)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(s->ksp, &pc));
  if (s->single) {
    PetscCall(SingleFactorSet_Private(pc, s->symmetric));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PCSetType(pc, s->symmetric ? PCCHOLESKY : PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Single precision? In three dimensions a factor soon costs more than all else. A solver named by hand is taken as it is. */
static PetscErrorCode UseSingle_Private(Solver s)
{
  PetscBool type, package;
  PetscInt  num_u, num_z, dim;

  PetscFunctionBegin;
  PetscCheckInput(s->factor != FACTOR_SINGLE || SingleFactorExists_Private(), "-solve_factor single: this build has no MUMPS in single precision");
  PetscCall(PetscOptionsHasName(NULL, NULL, "-pc_type", &type));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-pc_factor_mat_solver_type", &package));
  PetscCheckInput(s->factor != FACTOR_SINGLE || !(type || package), "-solve_factor single and -pc_type or -pc_factor_mat_solver_type exclude each other");
  ProblemGetBlocks(s->problem, &num_u, &num_z, &dim);
  const PetscInt dofs = ProblemNumDofs(s->problem);
  s->single           = (PetscBool)(s->factor == FACTOR_AUTO && dim == 3 && dofs >= SOLVER_LARGE && SingleFactorExists_Private() && !type && !package);
  if (s->factor == FACTOR_SINGLE) s->single = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverLinear_Private(Solver s)
{
  PetscFunctionBegin;
  PetscCall(SNESGetKSP(s->snes, &s->ksp));
  PetscCall(KSPSetType(s->ksp, KSPPREONLY));
  PetscCall(UseSingle_Private(s));
  PetscCall(SolverInertiaSetUp_Private(s));
  PetscCall(Kind_Private(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverUnsymmetric_Private(Solver s)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(PetscInfo(s->snes, "forces hold lines of a contact face, the tangent is not symmetric: factors are LU from here on\n"));
  s->symmetric = s->factored = PETSC_FALSE;
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCReset(pc));
  PetscCall(Kind_Private(s));
  PetscCall(PCSetFromOptions(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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
  if ((info != -8 && info != -9) || reserve > SOLVER_MOST_RESERVE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(text, sizeof(text), "%" PetscInt_FMT, 4 * PetscMax(reserve, 20)));
  PetscCall(PetscOptionsSetValue(NULL, "-mat_mumps_icntl_14", text));
  PetscCall(PetscInfo(pc, "MUMPS ran out of workspace: reserve raised to %s percent\n", text));
  PetscCall(PCReset(pc));
  *again = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are all entries finite? With others MUMPS ends in a signal. */
static PetscErrorCode IsFinite_Private(Mat A, PetscBool *yes)
{
  PetscReal norm;

  PetscFunctionBegin;
  PetscCall(MatNorm(A, NORM_FROBENIUS, &norm));
  *yes = (PetscBool)!PetscIsInfOrNanReal(norm);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factorise A. A failure shows in the solve that follows. */
static PetscErrorCode Factor_Private(Solver s, Mat A)
{
  PCFailedReason failed;
  PetscBool      again;
  PC             pc;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_FACTOR));
  ++s->report->factorisations;
  PetscCall(KSPGetPC(s->ksp, &pc));
  do {
    PetscCall(KSPSetOperators(s->ksp, A, A));
    PetscCall(KSPSetUp(s->ksp));
    PetscCall(PCGetFailedReason(pc, &failed));
    again = (PetscBool)(failed != PC_NOERROR);
    if (again) PetscCall(MoreWorkspace_Private(pc, &again));
  } while (again);
  s->no_memory = (PetscBool)(failed == PC_FACTOR_OUTMEMORY);
  PetscCall(SolverInertia_Private(s, pc));
  PetscCall(StageEnd(STAGE_FACTOR));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS out of memory, or off the rails, while it solves: PETSc makes an error of it, which here is a solution that is not found. The preconditioner was left
   in the middle of its work: another has to take its place. */
PetscErrorCode SolverFactorSolve_Private(KSP ksp, Vec rhs, Vec x, PetscBool *failed, PetscBool *ok)
{
  PetscErrorCode     code;
  KSPConvergedReason reason;
  PetscReal          norm;

  PetscFunctionBegin;
  *ok = PETSC_FALSE;
  PetscCall(StageBegin(STAGE_SOLVE));
  PetscCall(ErrorForesee("MUMPS in solve"));
  code = KSPSolve(ksp, rhs, x);
  PetscCall(ErrorForeseen(code, failed));
  PetscCall(StageEnd(STAGE_SOLVE));
  if (*failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(VecNorm(x, NORM_2, &norm));
  *ok = (PetscBool)(reason >= 0 && !PetscIsInfOrNanReal(norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve_Private(Solver s, Vec rhs, Vec x, PetscBool *ok)
{
  PetscBool failed;
  PC        pc;

  PetscFunctionBegin;
  PetscCall(SolverFactorSolve_Private(s->ksp, rhs, x, &failed, ok));
  if (!failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "MUMPS failed in the solve\n"));
  PetscCall(KSPDestroy(&s->refine));
  PetscCall(PCCreate(PetscObjectComm((PetscObject)s->ksp), &pc));
  PetscCall(KSPSetPC(s->ksp, pc));
  PetscCall(Kind_Private(s));
  PetscCall(PCSetFromOptions(pc));
  PetscCall(PCDestroy(&pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The residual has to fall by rtol; one that is not a quarter of the way there, in decades, after a quarter of the iterations will not get there. */
static PetscErrorCode Converged_Private(KSP ksp, PetscInt it, PetscReal norm, KSPConvergedReason *reason, void *context)
{
  Solver    s = (Solver)context;
  PetscReal rtol;

  PetscFunctionBegin;
  PetscCall(KSPGetTolerances(ksp, &rtol, NULL, NULL, NULL));
  if (it == 0) s->refine_first = norm;
  *reason = KSP_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(norm))
    *reason = KSP_DIVERGED_NANORINF;
  else if (norm <= rtol * s->refine_first)
    *reason = KSP_CONVERGED_RTOL;
  else if (it == REFINEMENTS / 4 && norm > PetscPowReal(rtol, 0.25) * s->refine_first)
    *reason = KSP_DIVERGED_ITS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is |b - A x| small against |b|? Where A is nearly singular the residual GMRES keeps account of is not that of its solution. */
static PetscErrorCode IsSolution_Private(Mat A, Vec b, Vec x, PetscReal rtol, PetscBool *yes)
{
  PetscReal norm, residual;
  Vec       r;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(b, &r));
  PetscCall(MatMult(A, x, r));
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, &residual));
  PetscCall(VecNorm(b, NORM_2, &norm));
  PetscCall(VecDestroy(&r));
  *yes = (PetscBool)(residual <= rtol * norm);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve with the factor there is as preconditioner, in single precision or of an earlier tangent. Tangents of one problem differ little: a few rows switched by
   the active set, a Newton step taken; some triangular solves cost less than a new factor. *ok false: they do not get there, factorise. Flexible GMRES: it
   keeps what the preconditioner returned, whose round-off would otherwise be all of the solution's, and needs one triangular solve less. */
static PetscErrorCode Refine_Private(Solver s, Mat A, Vec rhs, PetscReal rtol, Vec x, PetscBool *ok)
{
  KSPConvergedReason reason;
  PC                 pc;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_SOLVE));
  PetscCall(KSPGetPC(s->ksp, &pc));
  if (!s->refine) {
    PetscCall(KSPCreate(PetscObjectComm((PetscObject)A), &s->refine));
    PetscCall(KSPSetOptionsPrefix(s->refine, "again_"));
    PetscCall(KSPSetType(s->refine, KSPFGMRES));
    PetscCall(KSPSetConvergenceTest(s->refine, Converged_Private, s, NULL));
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
  if (*ok) PetscCall(IsSolution_Private(A, rhs, x, TRUE_RTOL, ok));
  PetscCall(StageEnd(STAGE_SOLVE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factorise A and solve. Where a factor in single precision does not serve, those in double take over for good. */
static PetscErrorCode Direct_Private(Solver s, Mat A, Vec rhs, Vec x, PetscBool *ok)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(IsFinite_Private(A, ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->single) {
    PetscCall(Factor_Private(s, A));
    PetscCall(Refine_Private(s, A, rhs, FRESH_RTOL, x, ok));
    if (*ok) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(PetscInfo(s->snes, "a factor in single precision does not serve: double from here on\n"));
    ++s->report->single_failures;
    s->single = PETSC_FALSE;
    PetscCall(Kind_Private(s));
    PetscCall(KSPGetPC(s->ksp, &pc));
    PetscCall(PCSetFromOptions(pc));
  }
  PetscCall(Factor_Private(s, A));
  PetscCall(Solve_Private(s, rhs, x, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far GMRES need go: so far that no Newton iteration is lost, which costs more than the few more of GMRES. */
static PetscReal Forcing_Private(Solver s)
{
  return PetscMin(TRUE_RTOL, PetscMax(s->linear_rtol, FORCING * s->report->residual / PetscMax(s->report->scale, PETSC_MIN_REAL)));
}

/* Operations that a factorisation will take: of the factor in single precision, whose analysis is needed anyway, or of MUMPS's; 0: the user's choice of a
   factor stands. */
static PetscErrorCode Operations_Private(Solver s, Mat A, PetscReal *operations)
{
  PetscBool     type, package;
  MatFactorInfo info;
  Mat           F;
  PC            pc;

  PetscFunctionBegin;
  PetscCall(KSPGetPC(s->ksp, &pc));
  if (s->single) {
    PetscCall(SingleFactorOperations_Private(pc, A, operations));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscOptionsHasName(NULL, NULL, "-pc_type", &type));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-pc_factor_mat_solver_type", &package));
  *operations = 0;
  if (type || package) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatFactorInfoInitialize(&info));
  PetscCall(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &F));
  PetscCall(MatCholeskyFactorSymbolic(F, A, NULL, &info));
  PetscCall(MatMumpsGetRinfog(F, 1, operations));
  PetscCall(MatDestroy(&F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a factorisation worth its operations? A cycle of multigrid costs what the matrix has entries and takes about as many iterations on any mesh; with higher
   orders less than half as many, and its hierarchy is that of a small part of the unknowns: a third is measured (docs/results.md). Of two bodies with as many
   unknowns the factor of the thinner one costs far less. */
static PetscErrorCode Choose_Private(Solver s, Mat A, PetscBool *ok)
{
  PetscReal operations;
  MatInfo   info;
  PC        pc;

  PetscFunctionBegin;
  PetscCall(IsFinite_Private(A, ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  s->choose = PETSC_FALSE;
  PetscCall(StageBegin(STAGE_FACTOR));
  PetscCall(Operations_Private(s, A, &operations));
  PetscCall(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  PetscCall(PetscInfo(s->snes, "a factor takes %g operations for each of %g entries\n", (double)(operations / info.nz_used), (double)info.nz_used));
  const PetscBool multigrid = (PetscBool)(operations > MOST_OPERATIONS * info.nz_used / (s->order > 1 ? 3 : 1));
  if (multigrid) PetscCall(SaddleCreate_Private(s->problem, s->multigrid, &s->saddle));
  if (multigrid && s->single) {
    PetscCall(KSPGetPC(s->ksp, &pc));
    PetscCall(SingleFactorForget_Private(pc));
  }
  PetscCall(StageEnd(STAGE_FACTOR));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverMatrixSolve_Private(Solver s, Vec rhs, PetscBool again)
{
  PetscBool ok = PETSC_TRUE;
  PetscInt  rows;
  Mat       A;

  PetscFunctionBegin;
  s->no_solution = PETSC_FALSE;
  PetscCall(ProblemGetMatrix(s->problem, &A));
  PetscCall(MatGetSize(A, &rows, NULL));
  if (rows == 0) PetscFunctionReturn(PETSC_SUCCESS); /* all is prescribed or condensed: MUMPS would refuse it */
  if (s->choose) PetscCall(Choose_Private(s, A, &ok));
  s->no_solution = (PetscBool)!ok;
  if (!ok) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->saddle) {
    PetscCall(StageBegin(STAGE_FACTOR));
    PetscCall(SaddleSetUp_Private(s->saddle, A, s->symmetric));
    PetscCall(StageEnd(STAGE_FACTOR));
    PetscCall(StageBegin(STAGE_SOLVE));
    PetscCall(SaddleSolve_Private(s->saddle, rhs, Forcing_Private(s), again, s->y, &ok));
    PetscCall(StageEnd(STAGE_SOLVE));
    if (ok) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(PetscInfo(s->snes, "multigrid failed: factorising\n"));
  }
  if (s->factored) {
    PetscCall(Refine_Private(s, A, rhs, PetscMin(REFINE_RTOL, Forcing_Private(s)), s->y, &ok));
    if (ok) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Direct_Private(s, A, rhs, s->y, &ok));
  s->no_solution = (PetscBool)!ok;
  s->factored    = (PetscBool)(ok && s->reuse);
  PetscFunctionReturn(PETSC_SUCCESS);
}
