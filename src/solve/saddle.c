/* Iterative solution of the tangent, displacements u and multipliers z:

     [ K   F ] [u]   [f]
     [ B   C ] [z] = [g],     rows of inactive nodes: B = 0, C = -w0/c; of active ones: C = 0, B = minus the normalised gradient
                              (C < 0 where facets are covered in part). F, the forces of the multipliers, is B^T in the symmetric form.

   Augmented form (Fortin & Glowinski): the same solution satisfies (K + B^T G B) u + (F + B^T G C) z = f + B^T G g, G diagonal over the active rows. With
   G_j = g_j = (b_j D b_j^T) / (b_j b_j^T)^2, D = diag K, the augmentation is as stiff as the mesh itself: it spoils no multigrid method and holds bodies that
   only contact holds; where a constraint is compliant it is as stiff as both in a row, 1 / G_j = 1 / g_j + |C_jj|.
   Right preconditioner [ M  F ] [ 0  -S  ],   M: one cycle of algebraic multigrid with rigid-body modes on K + B^T G B, S = G^-1 (active), -C (inactive):
   with exact M the Schur complement times G has eigenvalues s/(1+s) < 1, s those of G B K^-1 B^T, which are bounded below on any mesh. GMRES.
   Where forces hold lines of a contact face (docs/theory.md, (5.8)) the tangent has its exact form: rows of inactive nodes C = w0, and columns are nearly
   multiples of rows, f_j ~ sigma_j b_j^T; then S = sigma G^-1 - C. What else is not symmetric M does not see. */
#include "solveimpl.h"

struct _p_Saddle {
  Problem       problem; /* borrowed */
  MultigridKind kind;
  KSP           ksp;
  Multigrid     multigrid;
  IS            is_u, is_z;
  Mat           K, B, C, F; /* blocks of the last tangent; K with the augmentation B^T G B; F NULL: B^T */
  Mat           operator;
  Vec           G, S, scale, work_u, work_z, rhs; /* scale: of the rows of multipliers, to forces */
  PetscInt      iterations, first;                /* of the last solve, of the first one with this hierarchy (0: none yet) */
};

/* The blocks of a vector, lent or (restore) given back. */
static PetscErrorCode Blocks_Private(Saddle s, Vec x, PetscBool restore, Vec *u, Vec *z)
{
  PetscFunctionBegin;
  PetscCall((restore ? VecRestoreSubVector : VecGetSubVector)(x, s->is_u, u));
  PetscCall((restore ? VecRestoreSubVector : VecGetSubVector)(x, s->is_z, z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y += (F + B^T G C) x */
static PetscErrorCode AddForces_Private(Saddle s, Vec x, Vec y)
{
  PetscFunctionBegin;
  PetscCall(MatMult(s->C, x, s->work_z));
  PetscCall(VecPointwiseMult(s->work_z, s->work_z, s->G));
  PetscCall(MatMultTransposeAdd(s->B, s->work_z, y, y));
  if (s->F)
    PetscCall(MatMultAdd(s->F, x, y, y));
  else
    PetscCall(MatMultTransposeAdd(s->B, x, y, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = [augmented F; B C] x */
static PetscErrorCode Operator_Private(Mat A, Vec x, Vec y)
{
  Saddle s;
  Vec    xu, xz, yu, yz;

  PetscFunctionBegin;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(Blocks_Private(s, x, PETSC_FALSE, &xu, &xz));
  PetscCall(Blocks_Private(s, y, PETSC_FALSE, &yu, &yz));
  PetscCall(MatMult(s->K, xu, yu));
  PetscCall(AddForces_Private(s, xz, yu));
  PetscCall(MatMult(s->C, xz, yz));
  PetscCall(MatMultAdd(s->B, xu, yz, yz));
  PetscCall(VecPointwiseMult(yz, yz, s->scale));
  PetscCall(Blocks_Private(s, x, PETSC_TRUE, &xu, &xz));
  PetscCall(Blocks_Private(s, y, PETSC_TRUE, &yu, &yz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Precondition_Private(PC pc, Vec x, Vec y)
{
  Saddle s;
  Vec    xu, xz, yu, yz;

  PetscFunctionBegin;
  PetscCall(PCShellGetContext(pc, &s));
  PetscCall(Blocks_Private(s, x, PETSC_FALSE, &xu, &xz));
  PetscCall(Blocks_Private(s, y, PETSC_FALSE, &yu, &yz));
  PetscCall(VecPointwiseDivide(yz, xz, s->S));
  PetscCall(VecPointwiseDivide(yz, yz, s->scale));
  PetscCall(VecCopy(xu, s->work_u)); /* xu - F yz, yz = -S^-1 xz */
  PetscCall(AddForces_Private(s, yz, s->work_u));
  PetscCall(VecScale(yz, -1));
  PetscCall(MultigridApply_Private(s->multigrid, s->work_u, yu));
  PetscCall(Blocks_Private(s, x, PETSC_TRUE, &xu, &xz));
  PetscCall(Blocks_Private(s, y, PETSC_TRUE, &yu, &yz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create_Private(Saddle s, Mat A)
{
  PetscInt first, last, num_u, num_z, dim;
  PC       pc;
  Vec      x;

  PetscFunctionBegin;
  ProblemGetBlocks(s->problem, &num_u, &num_z, &dim);
  PetscCall(MatGetOwnershipRange(A, &first, &last));
  PetscCall(ISCreateStride(PetscObjectComm((PetscObject)A), num_u, first, 1, &s->is_u));
  PetscCall(ISCreateStride(PetscObjectComm((PetscObject)A), num_z, first + num_u, 1, &s->is_z));
  PetscCall(MatCreateVecs(A, &x, NULL));
  PetscCall(VecDuplicate(x, &s->rhs));
  PetscCall(MatCreateShell(PetscObjectComm((PetscObject)A), last - first, last - first, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->operator));
  PetscCall(MatShellSetOperation(s->operator, MATOP_MULT, (void (*)(void))Operator_Private));
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)A), &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, "saddle_"));
  PetscCall(KSPSetType(s->ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(s->ksp, 100));
  PetscCall(KSPSetPCSide(s->ksp, PC_RIGHT));
  PetscCall(KSPSetTolerances(s->ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 200));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, s));
  PetscCall(PCShellSetApply(pc, Precondition_Private));
  PetscCall(KSPSetFromOptions(s->ksp));
  PetscCall(MultigridCreate_Private(s->problem, s->kind, &s->multigrid));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Square every entry. */
static PetscErrorCode Square_Private(Mat A)
{
  Mat        part[2] = {A, NULL};
  MatInfo    info;
  PetscReal *value;
  PetscBool  parallel;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)A, MATMPIAIJ, &parallel));
  if (parallel) PetscCall(MatMPIAIJGetSeqAIJ(A, &part[0], &part[1], NULL));
  for (PetscInt k = 0; k < 2 && part[k]; ++k) {
    PetscCall(MatGetInfo(part[k], MAT_LOCAL, &info));
    PetscCall(MatSeqAIJGetArray(part[k], &value));
    for (PetscInt i = 0; i < (PetscInt)info.nz_used; ++i) value[i] *= value[i];
    PetscCall(MatSeqAIJRestoreArray(part[k], &value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sigma_j = f_j b_j / b_j b_j^T of active rows, else 1: the least squares of f_j - sigma_j b_j^T. */
static PetscErrorCode Ratios_Private(Saddle s, Vec sigma)
{
  const PetscInt    *column[2];
  const PetscScalar *value[2];
  PetscInt           first, last, num[2];
  PetscScalar       *ratio;
  Mat                side[2] = {s->B, NULL};

  PetscFunctionBegin;
  PetscCall(VecSet(sigma, 1));
  if (!s->F) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MatTranspose(s->F, MAT_INITIAL_MATRIX, &side[1]));
  PetscCall(MatGetOwnershipRange(s->B, &first, &last));
  PetscCall(VecGetArray(sigma, &ratio));
  for (PetscInt i = first; i < last; ++i) {
    PetscReal own = 0, product = 0;

    for (int k = 0; k < 2; k++) PetscCall(MatGetRow(side[k], i, &num[k], &column[k], &value[k]));
    for (PetscInt a = 0, b = 0; a < num[0]; ++a) {
      own += value[0][a] * value[0][a];
      while (b < num[1] && column[1][b] < column[0][a]) ++b;
      if (b < num[1] && column[1][b] == column[0][a]) product += value[0][a] * value[1][b];
    }
    for (int k = 0; k < 2; k++) PetscCall(MatRestoreRow(side[k], i, &num[k], &column[k], &value[k]));
    if (own > 0 && product != 0) ratio[i - first] = product / own;
  }
  PetscCall(VecRestoreArray(sigma, &ratio));
  PetscCall(MatDestroy(&side[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* G_j = (b_j D b_j^T) / (b_j b_j^T)^2, 0 for empty rows; S = sigma/G or -C. GMRES measures one norm over forces and gaps: rows of multipliers are scaled to
   the forces that their augmentation would exert, so that the unit of length does not matter. */
static PetscErrorCode Weights_Private(Saddle s)
{
  Vec              D, square, weighted, C, sigma;
  Mat              B2;
  PetscReal       *g, *sc, *d, sum[2] = {0, 0};
  const PetscReal *q, *w, *c, *ratio;
  PetscInt         n;

  PetscFunctionBegin;
  PetscCall(MatCreateVecs(s->K, &D, NULL));
  PetscCall(MatGetDiagonal(s->K, D));
  PetscCall(MatDuplicate(s->B, MAT_COPY_VALUES, &B2));
  PetscCall(Square_Private(B2));
  PetscCall(VecDuplicateAll(s->G, 4, (Vec *[]){&square, &weighted, &C, &sigma}));
  PetscCall(Ratios_Private(s, sigma));
  PetscCall(MatMult(B2, D, weighted));
  PetscCall(VecSet(D, 1));
  PetscCall(MatMult(B2, D, square));
  PetscCall(MatGetDiagonal(s->C, C));
  PetscCall(VecGetLocalSize(s->G, &n));
  PetscCall(VecGetArray(s->G, &g));
  PetscCall(VecGetArray(s->S, &sc));
  PetscCall(VecGetArrayRead(square, &q));
  PetscCall(VecGetArrayRead(weighted, &w));
  PetscCall(VecGetArrayRead(C, &c));
  PetscCall(VecGetArrayRead(sigma, &ratio));
  PetscCall(VecGetArray(s->scale, &d));
  for (PetscInt j = 0; j < n; ++j) {
    g[j]  = q[j] > 0 ? 1 / (q[j] * q[j] / w[j] + PetscAbsReal(c[j] / ratio[j])) : 0;
    sc[j] = (q[j] > 0 ? ratio[j] * q[j] * q[j] / w[j] : 0) - c[j];
    sum[0] += PetscSqrtReal(q[j]);
    sum[1] += q[j] > 0;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, PetscObjectComm((PetscObject)s->G)));
  for (PetscInt j = 0; j < n; ++j) d[j] = g[j] > 0 ? g[j] * PetscSqrtReal(q[j]) : (sum[1] > 0 ? sum[0] / sum[1] : 1) / sc[j];
  PetscCall(VecRestoreArray(s->scale, &d));
  PetscCall(VecRestoreArray(s->G, &g));
  PetscCall(VecRestoreArray(s->S, &sc));
  PetscCall(VecRestoreArrayRead(square, &q));
  PetscCall(VecRestoreArrayRead(weighted, &w));
  PetscCall(VecRestoreArrayRead(C, &c));
  PetscCall(VecRestoreArrayRead(sigma, &ratio));
  PetscCall(VecDestroyAll(5, (Vec *[]){&D, &square, &weighted, &C, &sigma}));
  PetscCall(MatDestroy(&B2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K += B^T G B */
static PetscErrorCode Augment_Private(Saddle s)
{
  Mat GB, product;

  PetscFunctionBegin;
  PetscCall(MatDuplicate(s->B, MAT_COPY_VALUES, &GB));
  PetscCall(MatDiagonalScale(GB, s->G, NULL));
  PetscCall(MatTransposeMatMult(s->B, GB, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  PetscCall(MatAXPY(s->K, 1, product, DIFFERENT_NONZERO_PATTERN));
  PetscCall(MatDestroy(&product));
  PetscCall(MatDestroy(&GB));
  PetscCall(MatSetOption(s->K, MAT_SYMMETRIC, (PetscBool)!s->F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleCreate_Private(Problem problem, MultigridKind kind, Saddle *saddle)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(saddle));
  (*saddle)->problem = problem;
  (*saddle)->kind    = kind;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The blocks of a tangent. */
static PetscErrorCode Forget_Private(Saddle s)
{
  PetscFunctionBegin;
  PetscCall(MatDestroy(&s->K));
  PetscCall(MatDestroy(&s->B));
  PetscCall(MatDestroy(&s->C));
  PetscCall(MatDestroy(&s->F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleDestroy_Private(Saddle *saddle)
{
  Saddle s = *saddle;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(MultigridDestroy_Private(&s->multigrid));
  PetscCall(ISDestroy(&s->is_u));
  PetscCall(ISDestroy(&s->is_z));
  PetscCall(Forget_Private(s));
  PetscCall(MatDestroy(&s->operator));
  PetscCall(VecDestroyAll(6, (Vec *[]){&s->G, &s->S, &s->scale, &s->work_u, &s->work_z, &s->rhs}));
  PetscCall(PetscFree(*saddle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A: the tangent. The multigrid hierarchy stays as long as it serves: tangents of one load step differ little. */
PetscErrorCode SaddleSetUp_Private(Saddle s, Mat A, PetscBool symmetric)
{
  const PetscBool keep = (PetscBool)(s->first > 0 && s->iterations <= s->first + s->first / 2 + 5);

  PetscFunctionBegin;
  if (!keep) s->first = 0;
  if (!s->ksp) PetscCall(Create_Private(s, A));
  PetscCall(Forget_Private(s));
  PetscCall(MatCreateSubMatrix(A, s->is_u, s->is_u, MAT_INITIAL_MATRIX, &s->K));
  PetscCall(MatCreateSubMatrix(A, s->is_z, s->is_u, MAT_INITIAL_MATRIX, &s->B));
  PetscCall(MatCreateSubMatrix(A, s->is_z, s->is_z, MAT_INITIAL_MATRIX, &s->C));
  if (!symmetric) PetscCall(MatCreateSubMatrix(A, s->is_u, s->is_z, MAT_INITIAL_MATRIX, &s->F));
  if (!s->G) {
    PetscCall(MatCreateVecs(s->B, &s->work_u, &s->G));
    PetscCall(VecDuplicateAll(s->G, 3, (Vec *[]){&s->S, &s->scale, &s->work_z}));
  }
  PetscCall(Weights_Private(s));
  PetscCall(Augment_Private(s));
  PetscCall(MultigridSetUp_Private(s->multigrid, s->K, keep));
  PetscCall(KSPSetOperators(s->ksp, s->operator, s->operator));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x: solution of A x = rhs to a relative residual of rtol, from x as it comes if guess is set; *ok: GMRES got there. */
PetscErrorCode SaddleSolve_Private(Saddle s, Vec rhs, PetscReal rtol, PetscBool guess, Vec x, PetscBool *ok)
{
  KSPConvergedReason reason;
  Vec                u, z, weighted;

  PetscFunctionBegin;
  PetscCall(VecCopy(rhs, s->rhs));
  PetscCall(Blocks_Private(s, s->rhs, PETSC_FALSE, &u, &z));
  PetscCall(VecDuplicate(z, &weighted));
  PetscCall(VecPointwiseMult(weighted, s->G, z));
  PetscCall(MatMultTransposeAdd(s->B, weighted, u, u));
  PetscCall(VecDestroy(&weighted));
  PetscCall(VecPointwiseMult(z, z, s->scale));
  PetscCall(Blocks_Private(s, s->rhs, PETSC_TRUE, &u, &z));
  PetscCall(KSPSetTolerances(s->ksp, rtol, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, guess));
  PetscCall(KSPSolve(s->ksp, s->rhs, x));
  PetscCall(KSPGetConvergedReason(s->ksp, &reason));
  PetscCall(KSPGetIterationNumber(s->ksp, &s->iterations));
  PetscCall(PetscInfo(s->ksp, "%" PetscInt_FMT " iterations of GMRES\n", s->iterations));
  *ok = (PetscBool)(reason > 0);
  if (s->first == 0) s->first = PetscMax(s->iterations, 1);
  if (!*ok) s->first = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
