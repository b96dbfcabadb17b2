/* Multigrid for the displacement block. The space of order 1 on the same mesh, in whole blocks of a vertex, has the Galerkin matrix P^T A P with ones for
   prescribed components; it is treated by smoothed aggregation with the rigid-body modes, by hypre's BoomerAMG, or factorised when it is small. Cells of higher
   order have one level above it, with a symmetric sweep of Gauss-Seidel before and after; cells of order 1 need none, P only completes the blocks. */
#include "solveimpl.h"

struct _p_Multigrid {
  KSP          coarse, smoother; /* smoother NULL: order 1 */
  Mat          A, P, pinned, A1; /* A borrowed */
  MatNullSpace modes;            /* near null space of A1 */
  Vec          x1, y1, r, y;     /* y: a second sweep's correction */
};

#if defined(PETSC_HAVE_HYPRE)
/* BoomerAMG for elasticity: vertices are coarsened in whole (nodal), rotations are interpolated beside the components themselves (GM-2 of Baker, Kolev & Yang,
   2010). That they are kept is what slender bodies need, and that interpolation is short (ext+i, four entries a row) what its coarse matrices need. */
static const char *const BoomerAMG[][2] = {
    {"nodal_coarsen", "1"}, {"vec_interp_variant", "2"}, {"coarsen_type", "HMIS"}, {"interp_type", "ext+i"}, {"P_max", "4"}};

#define PREFIX "-multigrid_pc_hypre_boomeramg_"

/* Through the options: PETSc has no functions for them. Those that the user gave stay. */
static PetscErrorCode BoomerAMG_Private(Multigrid m, PC pc)
{
  PetscBool  constant;
  const Vec *mode;
  PetscInt   num, dim;

  PetscFunctionBegin;
  PetscCall(PCSetType(pc, PCHYPRE));
  PetscCall(PCHYPRESetType(pc, "boomeramg"));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(BoomerAMG); ++i) {
    char      name[64];
    PetscBool set;
    PetscCall(PetscSNPrintf(name, sizeof(name), PREFIX "%s", BoomerAMG[i][0]));
    PetscCall(PetscOptionsHasName(NULL, NULL, name, &set));
    if (!set) PetscCall(PetscOptionsSetValue(NULL, name, BoomerAMG[i][1]));
  }
  /* translations are there already, and would spoil the interpolation if given again */
  PetscCall(MatNullSpaceGetVecs(m->modes, &constant, &num, &mode));
  PetscCall(MatGetBlockSizes(m->P, NULL, &dim));
  MatNullSpace rotations;
  PetscCall(MatNullSpaceCreate(PetscObjectComm((PetscObject)pc), PETSC_FALSE, num - dim, mode + dim, &rotations));
  PetscCall(MatNullSpaceDestroy(&m->modes));
  m->modes = rotations;
  PetscFunctionReturn(PETSC_SUCCESS);
}
#else
static PetscErrorCode BoomerAMG_Private(Multigrid m, PC pc)
{
  return PETSC_SUCCESS; /* refused by MultigridCheck_Private */
}
#endif

static PetscBool Begins_Private(const char *name, const char *with)
{
  return (PetscBool)!strncmp(name, with, strlen(with));
}

/* Options of PETSc for a solver that is not in use: of multigrid beside factors, of a method that was not named. type: the user chose by PETSc's own option. */
static PetscErrorCode CheckForeign_Private(MultigridKind kind, LinearKind linear, PetscBool type)
{
  static const struct {
    const char   *begin, *method;
    MultigridKind kind;
  } of[] = {{"multigrid_pc_gamg_", "gamg", MULTIGRID_GAMG}, {"multigrid_pc_hypre_", "boomeramg", MULTIGRID_BOOMERAMG}};
  char      **names, **values, found[128] = "";
  const char *method = NULL;
  PetscInt    num;

  PetscFunctionBegin;
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values));
  for (PetscInt i = 0; i < num; ++i) {
    const PetscBool beside = (PetscBool)(linear == LINEAR_DIRECT && (Begins_Private(names[i], "multigrid_") || Begins_Private(names[i], "saddle_")));
    const char     *needs  = NULL;
    for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(of); ++k)
      if (!type && kind != of[k].kind && Begins_Private(names[i], of[k].begin)) needs = of[k].method;
    if (!beside && !needs) continue;
    PetscCall(PetscStrncpy(found, names[i], sizeof(found)));
    method = beside ? NULL : needs;
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  PetscCheckInput(!found[0] || method, "-%.80s cannot act with -solve_linear direct; take iterative or auto", found);
  PetscCheckInput(!found[0], "-%.80s cannot act with -solve_multigrid %s; take %s", found,
                  kind == MULTIGRID_BOOMERAMG ? "boomeramg"
                  : kind == MULTIGRID_GAMG    ? "gamg"
                                              : "auto, which may choose another method",
                  method);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MultigridCheck_Private(MultigridKind kind, LinearKind linear)
{
  PetscBool type;

  PetscFunctionBegin;
  PetscCheckInput(kind == MULTIGRID_AUTO || linear != LINEAR_DIRECT, "-solve_multigrid %s cannot act with -solve_linear direct; take iterative or auto",
                  kind == MULTIGRID_GAMG ? "gamg" : "boomeramg");
#if !defined(PETSC_HAVE_HYPRE)
  PetscCheckInput(kind != MULTIGRID_BOOMERAMG, "-solve_multigrid boomeramg: this PETSc was built without hypre; take gamg");
#endif
  PetscCall(PetscOptionsHasName(NULL, NULL, "-multigrid_pc_type", &type));
  PetscCheckInput(kind == MULTIGRID_AUTO || !type, "-solve_multigrid and -multigrid_pc_type exclude each other; give one of them");
  PetscCall(CheckForeign_Private(kind, linear, type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is best where nothing was said: in the space of order 1 inside one of higher order a factor, which soon costs too much, or BoomerAMG, with which GMRES
   takes as many iterations, GAMG half as many again; for order 1 GAMG, whose iterations are cheaper (docs/results.md). */
static MultigridKind Best_Private(Multigrid m, PetscInt size)
{
  if (!m->smoother) return MULTIGRID_GAMG;
  if (size <= SOLVER_LARGE) return MULTIGRID_AUTO;
#if defined(PETSC_HAVE_HYPRE)
  return MULTIGRID_BOOMERAMG;
#else
  return MULTIGRID_GAMG;
#endif
}

static PetscErrorCode Coarse_Private(Multigrid m, MultigridKind kind)
{
  PetscBool type;
  PetscInt  size;
  PC        pc;

  PetscFunctionBegin;
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)m->P), &m->coarse));
  PetscCall(KSPSetOptionsPrefix(m->coarse, "multigrid_"));
  PetscCall(KSPSetType(m->coarse, KSPPREONLY));
  PetscCall(KSPGetPC(m->coarse, &pc));
  PetscCall(MatGetSize(m->P, NULL, &size));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-multigrid_pc_type", &type)); /* the user's */
  if (kind == MULTIGRID_AUTO && !type) kind = Best_Private(m, size);
  if (kind == MULTIGRID_BOOMERAMG)
    PetscCall(BoomerAMG_Private(m, pc));
  else if (kind == MULTIGRID_GAMG)
    PetscCall(PCSetType(pc, PCGAMG));
  else {
    PetscCall(PCSetType(pc, PCCHOLESKY));
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
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

PetscErrorCode MultigridCreate_Private(Problem problem, MultigridKind kind, Multigrid *multigrid)
{
  Multigrid m;
  PetscBool higher;

  PetscFunctionBegin;
  PetscCall(PetscNew(&m));
  PetscCall(ProblemProlongation(problem, &m->P, &m->pinned, &m->modes, &higher));
  if (higher) PetscCall(Smoother_Private(m));
  PetscCall(Coarse_Private(m, kind));
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
  PetscCall(VecDestroyAll(4, (Vec *[]){&m->x1, &m->y1, &m->r, &m->y}));
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
