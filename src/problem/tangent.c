/* The tangent and its right-hand side: bulk, contact, incompressible cells, scalars, and the first-order effect of prescribed motion still to come. */
#include "problemimpl.h"

/* A cell's matrix: free rows and columns to the matrix, columns of prescribed dofs times their motion to the lift. */
PetscErrorCode ProblemCellSink_Private(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  Problem   p          = (Problem)context;
  PetscBool prescribed = PETSC_FALSE, added;

  PetscFunctionBegin;
  PetscCall(RowBufferGrow(&p->work, num));
  for (PetscInt i = 0; i < num; ++i) {
    p->work.index[i] = p->row[dofs[i]];
    if (p->work.index[i] < 0 && p->lift && p->increment[dofs[i]] != 0) prescribed = PETSC_TRUE;
  }
  PetscCall(ProblemScatterAdd_Private(p, cell, num, dofs, K, &added));
  if (!added) PetscCall(MatSetValues(p->matrix, num, p->work.index, num, p->work.index, K, ADD_VALUES));
  if (!prescribed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < num; ++i) {
    p->work.value[i] = 0;
    for (PetscInt j = 0; j < num; ++j) p->work.value[i] += K[i * num + j] * p->increment[dofs[j]];
  }
  PetscCall(VecSetValues(p->lift, num, p->work.index, p->work.value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

InterfaceSystem ProblemSystem_Private(Problem p)
{
  return (InterfaceSystem){p->matrix, p->symmetric, p->increment, p->lift};
}

PetscErrorCode ProblemRightSide(Problem p, Vec r, Vec lift, Vec rhs)
{
  const InterfaceSystem system = ProblemSystem_Private(p);

  PetscFunctionBegin;
  PetscCall(ProblemReduce_Private(p, r, rhs));
  PetscCall(VecAXPY(rhs, 1.0, lift));
  PetscCall(VecScale(rhs, -1.0));
  PetscCall(PressureSides_Private(p, rhs));
  PetscCall(InterfaceRightSide(p->interface, &system, rhs));
  PetscCall(VecAssemble(rhs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The matrix with room for all of contact, zero. */
PetscErrorCode ProblemReadyMatrix_Private(Problem p)
{
  PetscBool grown;
  int       ok;

  PetscFunctionBegin;
  PetscCall(InterfaceGrow(p->interface, &grown));
  ok = p->matrix && !grown;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &ok, 1, MPI_INT, MPI_MIN, p->comm));
  if (!ok)
    PetscCall(ProblemMatrix_Private(p));
  else
    PetscCall(MatZeroEntries(p->matrix));
  PetscCall(ProblemScatter_Private(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemTangent(Problem p, Vec x, const PetscReal pressure[], Vec lift, PetscBool *bad)
{
  PetscReal *local, pending;
  PetscBool  failed = PETSC_FALSE, holds = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(VecGetArray(p->u_local, &local));
  PetscCall(ProblemLocalDisplacement(p, x, local));
  PetscCall(ProblemPending(p, &pending));
  PetscCall(StageBegin(STAGE_CONTACT));
  PetscCall(InterfaceEvaluate(p->interface, x, local, pending, PETSC_TRUE, &failed));
  if (p->form.symmetric) PetscCall(InterfaceHoldsLines(p->interface, &holds));
  p->symmetric = (PetscBool)(p->form.symmetric && !holds);
  PetscCall(StageEnd(STAGE_CONTACT));
  p->lift = lift;
  if (lift) PetscCall(VecSetOption(lift, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt i = 0; i < p->num_local; ++i) p->increment[i] = p->target[i] - p->applied[i];
  PetscCall(ProblemReadyMatrix_Private(p));
  PetscCall(StageBegin(STAGE_ASSEMBLE));
  PetscCall(MechanicsTangent(p->mechanics, local, pressure, ProblemCellSink_Private, p, bad));
  if (!*bad) PetscCall(PressureBlocks_Private(p));
  PetscCall(ScalarsTangent_Private(p, local));
  PetscCall(StageEnd(STAGE_ASSEMBLE));
  PetscCall(VecRestoreArray(p->u_local, &local));
  PetscCall(StageBegin(STAGE_CONTACT));
  const InterfaceSystem system = ProblemSystem_Private(p);
  PetscCall(InterfaceBlocks(p->interface, &system));
  if (p->scene->num_contacts) {
    PetscCall(MatAssemble(p->matrix, MAT_FLUSH_ASSEMBLY));
    PetscCall(InterfaceInsertRows(p->interface, &system));
  }
  PetscCall(StageEnd(STAGE_CONTACT));
  PetscCall(StageBegin(STAGE_ASSEMBLE));
  PetscCall(MatAssemble(p->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(StageEnd(STAGE_ASSEMBLE));
  if (lift) PetscCall(VecAssemble(lift));
  p->lift = NULL;
  int any = *bad || failed;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, p->comm));
  *bad = (PetscBool)any;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemRowScale(Problem p, Mat A, Vec scale)
{
  PetscReal *array;
  PetscInt   num;

  PetscFunctionBegin;
  PetscCall(MatGetRowMaxAbs(A, scale, NULL));
  PetscCall(VecGetLocalSize(scale, &num));
  PetscCall(VecGetArray(scale, &array));
  for (PetscInt i = p->num_u - p->num_inner; i < num; ++i) array[i] = 0;
  PetscCall(VecRestoreArray(scale, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSymmetricPart(Problem p, Vec x, const PetscReal pressure[], PetscReal shift, PetscBool *is_there)
{
  const PetscBool plain = p->form.symmetric;
  PetscBool       bad;
  Mat             transpose;
  Vec             diagonal;

  PetscFunctionBegin;
  p->form.symmetric = PETSC_TRUE;
  PetscCall(ProblemTangent(p, x, pressure, NULL, &bad));
  p->form.symmetric = plain;
  *is_there         = (PetscBool)(!bad && p->symmetric);
  if (!*is_there) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ProblemIsSymmetric(p)) {
    PetscCall(MatTranspose(p->matrix, MAT_INITIAL_MATRIX, &transpose));
    PetscCall(MatAXPY(p->matrix, 1, transpose, SAME_NONZERO_PATTERN)); /* rows and columns of the multipliers have one pattern, too */
    PetscCall(MatScale(p->matrix, 0.5));
    PetscCall(MatDestroy(&transpose));
  }
  PetscCall(ProblemCreateRightSide(p, &diagonal));
  PetscCall(ProblemRowScale(p, p->matrix, diagonal));
  PetscCall(VecScale(diagonal, shift));
  PetscCall(MatDiagonalSet(p->matrix, diagonal, ADD_VALUES));
  PetscCall(VecDestroy(&diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSwitchActiveSet(Problem p, Vec dx, SwitchRule rule, Vec rhs, PetscInt *disagree)
{
  const InterfaceSystem system = ProblemSystem_Private(p);

  PetscFunctionBegin;
  *disagree = 0;
  if (!p->scene->num_contacts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  PetscCall(InterfaceSwitch(p->interface, &system, dx, rule, rhs, disagree));
  if (*disagree) PetscCall(MatAssemble(p->matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}
