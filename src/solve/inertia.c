/* The inertia of the symmetric tangent. At a stable equilibrium K is positive on every motion the constraints allow, and the matrix [K B^T; B 0] then has one
   negative eigenvalue for each constraint. Each one more is a direction of motion in which the energy falls: the equilibrium is unstable. Newton's method finds
   such states as it finds others. Where there is an energy a stable equilibrium is looked for from there (stable.c, load.stable); elsewhere, and along a path
   that load or motion prescribes, where they may be what is wanted (behind a bifurcation, beyond a limit point), they are counted, not refused.

   LU, of a tangent that is not symmetric, tells no inertia, but the sign of the determinant: rows of multipliers are such that each adds a factor above zero
   where K is positive, pressures of incompressible material one below. So it tells an odd number of such directions, as there is beyond the first of a column's
   critical loads, and nothing of an even one, as of two columns. So at the end of a load step the symmetric part of K is factorised as well, of follower loads
   and of material that flows: where that is positive there is no such direction. Not with friction, which holds motions to both sides, nor with bodies that
   contact alone holds: round ones turn over facets, up and down by less than the mesh is off.

   A motion that meets no resistance has an eigenvalue that is round-off, whose sign says nothing: a shift by as much counts it as stable. */
#include "solveimpl.h"

/* An option of factors before they are made. Asked for afterwards, it is none that nothing used, where nothing is factorised. */
static PetscErrorCode FactorOption_Private(const char *name, const char *value)
{
  PetscBool set;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, name, &set));
  if (!set) PetscCall(PetscOptionsSetValue(NULL, name, value));
  PetscCall(PetscOptionsHasName(NULL, NULL, name, &set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS leaves the root of a distributed factor to ScaLAPACK, which does not count pivots, unless ICNTL(13) is 1: so chosen where somebody wants to know, with
   incompressible material and where unstable equilibria give way to stable ones, on any number of ranks. */
PetscErrorCode SolverInertiaSetUp_Private(Solver s)
{
  const SceneData *scene = ProblemGetScene(s->problem);

  PetscFunctionBegin;
  s->negative = -1;
  if (ProblemIsIncompressible(s->problem) || (ProblemHasEnergy(s->problem) && scene->load.stable)) PetscCall(FactorOption_Private("-mat_mumps_icntl_13", "1"));
  PetscCall(FactorOption_Private("-mat_mumps_icntl_33", "1")); /* the determinant */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS' factor in pc, NULL: another one. */
static PetscErrorCode Factor_Private(PC pc, Mat *F)
{
  MatSolverType type;
  PetscBool     mumps;

  PetscFunctionBegin;
  *F = NULL;
  PetscCall(PCFactorGetMatSolverType(pc, &type));
  PetscCall(PetscStrcmp(type, MATSOLVERMUMPS, &mumps));
  if (mumps) PetscCall(PCFactorGetMatrix(pc, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is left of negative pivots without those of the constraints. */
static PetscErrorCode Beyond_Private(Problem problem, PetscInt *negative)
{
  PetscInt constraints;

  PetscFunctionBegin;
  PetscCall(ProblemNumNegative(problem, &constraints));
  PetscCall(PetscInfo(NULL, "%" PetscInt_FMT " negative pivots, %" PetscInt_FMT " constraints\n", *negative, constraints));
  *negative = PetscMax(0, *negative - constraints);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LDL^T: negative pivots beyond those of the constraints; -1: the factor does not tell. */
static PetscErrorCode Pivots_Private(Solver s, PC pc, PetscInt *negative)
{
  PetscMPIInt size;
  PetscInt    whole = 0;
  PetscBool   set;
  Mat         F;

  PetscFunctionBegin;
  *negative = -1;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)pc), &size));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-mat_mumps_icntl_13", &whole, &set));
  if (size > 1 && whole != 1) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->single)
    PetscCall(SingleFactorNegative_Private(pc, negative));
  else {
    PetscCall(Factor_Private(pc, &F));
    if (F) PetscCall(MatMumpsGetInfog(F, 12, negative));
  }
  if (*negative >= 0) PetscCall(Beyond_Private(s->problem, negative));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* LU: 1 where the sign of the determinant is not that of a stable equilibrium, else 0; -1: it does not tell. */
static PetscErrorCode Sign_Private(Solver s, PC pc, PetscInt *negative)
{
  PetscReal mantissa;
  PetscInt  stable;
  Mat       F;

  PetscFunctionBegin;
  *negative = -1;
  PetscCall(ProblemStableSign(s->problem, &stable));
  if (s->single || stable == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Factor_Private(pc, &F));
  if (!F) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatMumpsGetRinfog(F, 12, &mantissa));
  PetscCall(PetscInfo(s->snes, "mantissa of the determinant %g, sign at a stable equilibrium %" PetscInt_FMT "\n", (double)mantissa, stable));
  if (mantissa != 0) *negative = mantissa * (PetscReal)stable < 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverInertia_Private(Solver s, PC pc)
{
  PCFailedReason failed;

  PetscFunctionBegin;
  s->negative = -1;
  PetscCall(PCGetFailedReason(pc, &failed));
  if (failed == PC_NOERROR) PetscCall((s->symmetric ? Pivots_Private : Sign_Private)(s, pc, &s->negative));
  if (s->negative > 0) ++s->report->indefinite;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InertiaFactors_Private(MPI_Comm comm, KSP *ksp)
{
  PC pc;

  PetscFunctionBegin;
  PetscCall(FactorOption_Private("-inertia_mat_mumps_icntl_13", "1"));
  PetscCall(FactorOption_Private("-inertia_mat_mumps_icntl_14", "80"));
  PetscCall(KSPCreate(comm, ksp));
  PetscCall(KSPSetOptionsPrefix(*ksp, "inertia_"));
  PetscCall(KSPSetType(*ksp, KSPPREONLY));
  PetscCall(KSPGetPC(*ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  PetscCall(PCSetFromOptions(pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InertiaFactor_Private(Problem problem, KSP ksp, Mat A, PetscInt *negative)
{
  PCFailedReason failed;
  PC             pc;
  Mat            F;

  PetscFunctionBegin;
  *negative = INERTIA_NO_FACTOR;
  PetscCall(StageBegin(STAGE_FACTOR));
  PetscCall(KSPSetOperators(ksp, A, A));
  PetscCall(KSPSetUp(ksp));
  PetscCall(StageEnd(STAGE_FACTOR));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetFailedReason(pc, &failed));
  if (failed == PC_FACTOR_OUTMEMORY) *negative = INERTIA_NO_MEMORY;
  if (failed != PC_NOERROR) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCFactorGetMatrix(pc, &F));
  PetscCall(MatMumpsGetInfog(F, 12, negative));
  PetscCall(Beyond_Private(problem, negative));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SolverIsSymmetric(Solver s)
{
  return s->symmetric;
}

PetscErrorCode SolverCountUnstable(Solver s, State *state, PetscInt *num)
{
  const PetscInt order = ProblemNumDofs(s->problem);
  PetscBool      is_there;
  PetscInt       sign;
  KSP            ksp;
  Mat            A;

  PetscFunctionBegin;
  *num = -1;
  PetscCall(ProblemStableSign(s->problem, &sign));
  if (s->saddle || sign == 0 || InterfaceSlips(ProblemInterface(s->problem)) || ProblemHasFreeBody(s->problem)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetState(s->problem, state));
  PetscCall(ProblemSymmetricPart(s->problem, state->x, state->pressure, PETSC_MACHINE_EPSILON * (PetscReal)order, &is_there));
  if (!is_there) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemGetMatrix(s->problem, &A));
  PetscCall(InertiaFactors_Private(PetscObjectComm((PetscObject)A), &ksp));
  PetscCall(InertiaFactor_Private(s->problem, ksp, A, num));
  PetscCall(KSPDestroy(&ksp));
  PetscCall(PetscInfo(s->snes, "the symmetric part has %" PetscInt_FMT " unstable directions\n", *num));
  PetscFunctionReturn(PETSC_SUCCESS);
}
