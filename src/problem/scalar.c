/* Unknowns that belong to no node, the last of the last rank's part of the vector: pressures that are found (mechanics/control.c), motions of rigid
   bodies that forces move (rigid.c), then, where a path is followed (path.c), pseudo-time. Each has one row and one column in the matrix, so that nothing is
   lost where the rest of it is singular:

     R_k = E/L (V_k(u) - target_k(t)),   dR/dp_k = int N n da                                                             (unit of the rows: force)

   E: mean shear modulus of the cells behind the boundary, L: its extent. */
#include "problemimpl.h"

/* Diagonal of the box around all bodies. */
static void Extent_Private(Problem p)
{
  const CoarseMesh *mesh = ForestGetCoarse(p->forest);
  PetscReal         lo[3], hi[3], square = 0;

  ForestCoarseBox(mesh, lo, hi);
  for (PetscInt c = 0; c < 3; ++c) square += PetscSqr(hi[c] - lo[c]);
  p->extent = PetscSqrtReal(square);
}

PetscErrorCode ScalarsCreate_Private(Problem p)
{
  const PetscInt *boundary;
  const PetscBool ring = (PetscBool)(p->scene->mechanics.model == MODEL_AXISYMMETRIC);

  PetscFunctionBegin;
  PetscCall(MechanicsGetControls(p->mechanics, &p->num_controls, &boundary));
  Extent_Private(p);
  PetscCall(RigidCreate_Private(p));
  p->num_scalars = p->num_controls + p->num_rigid + (p->scene->load.control == LOAD_ARC_LENGTH);
  PetscCall(PetscCalloc4(p->num_scalars, &p->scalar, p->num_controls, &p->factor, p->num_controls, &p->norm, p->num_controls, &p->measure));
  for (PetscInt k = 0; k < p->num_controls; ++k) {
    PetscReal sum[2];
    PetscCall(MechanicsControlArea(p->mechanics, k, sum));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, p->comm));
    p->factor[k] = sum[1] / sum[0] / (p->dim == 2 && !ring ? sum[0] : PetscSqrtReal(sum[0]));
    p->norm[k]   = p->scene->mechanics.boundaries[boundary[k]].advance ? sum[0] : 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScalarsDestroy_Private(Problem p)
{
  PetscFunctionBegin;
  PetscCall(PetscFree4(p->scalar, p->factor, p->norm, p->measure));
  PetscCall(VecDestroy(&p->path));
  PetscCall(PetscFree(p->node_link));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Place of scalar k in this rank's part of the vector; -1: another rank's. */
static PetscInt Local_Private(Problem p, PetscInt k)
{
  return p->rank == p->size - 1 ? p->num_dofs - p->num_scalars + k - p->start : -1;
}

PetscInt RigidLocal_Private(Problem p)
{
  return Local_Private(p, p->num_controls);
}

/* Is a path followed? */
static PetscBool HasPath_Private(Problem p)
{
  return (PetscBool)(p->num_scalars > p->num_controls + p->num_rigid);
}

/* Its row in the matrix. */
static PetscInt Row_Private(Problem p, PetscInt k)
{
  return p->row_start[p->size] - p->num_scalars + k;
}

PetscErrorCode ProblemGetScalars(Problem p, Vec x, PetscReal values[])
{
  const PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(x, &array));
  if (p->rank == p->size - 1) PetscCall(PetscArraycpy(values, array + Local_Private(p, 0), p->num_scalars));
  PetscCall(VecRestoreArrayRead(x, &array));
  PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)p->num_scalars, MPIU_REAL, p->size - 1, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSetScalars(Problem p, const PetscReal values[], Vec x)
{
  PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetArray(x, &array));
  if (p->rank == p->size - 1) PetscCall(PetscArraycpy(array + Local_Private(p, 0), values, p->num_scalars));
  PetscCall(VecRestoreArray(x, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ProblemNumScalars(Problem p)
{
  return p->num_scalars;
}

PetscErrorCode ScalarsRead_Private(Problem p, Vec x)
{
  PetscFunctionBegin;
  if (!p->num_scalars) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemGetScalars(p, x, p->scalar));
  PetscCall(MechanicsSetControls(p->mechanics, p->scalar));
  if (p->num_rigid) PetscCall(RigidRead_Private(p, p->scalar + p->num_controls));
  if (HasPath_Private(p)) PetscCall(MechanicsSetTime(p->mechanics, p->scalar[p->num_scalars - 1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScalarsMeasure_Private(Problem p, const PetscReal u[])
{
  PetscFunctionBegin;
  if (!p->num_controls) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < p->num_controls; ++k) PetscCall(MechanicsControl(p->mechanics, k, u, &p->measure[k], NULL, NULL));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, p->measure, (PetscMPIInt)p->num_controls, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScalarsResidual_Private(Problem p, Vec x, PetscReal r[])
{
  const PetscReal origin[3] = {0, 0, 0};
  const PetscInt *boundary;
  PetscInt        num;
  PetscReal       target;

  PetscFunctionBegin;
  if (!p->num_scalars) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MechanicsGetControls(p->mechanics, &num, &boundary));
  for (PetscInt k = 0; k < num && Local_Private(p, k) >= 0; ++k) {
    const BoundarySpec *b = &p->scene->mechanics.boundaries[boundary[k]];
    PetscCall(MechanicsValue(b->volume ? b->volume : b->advance, &b->amplitude, origin, p->t, &target));
    r[Local_Private(p, k)] = p->factor[k] * (p->measure[k] - target * p->norm[k]);
  }
  for (PetscInt k = 0; k < p->num_rigid && RigidLocal_Private(p) >= 0; ++k) r[RigidLocal_Private(p) + k] = p->rigid[k].force - p->rigid[k].load;
  if (HasPath_Private(p)) {
    PetscCall(PathResidual_Private(p, x, &target));
    if (Local_Private(p, num) >= 0) r[Local_Private(p, num)] = target;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemGetControls(Problem p, Vec x, PetscReal pressure[], PetscReal value[])
{
  PetscReal *u;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(p->num_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(ScalarsMeasure_Private(p, u));
  PetscCall(PetscFree(u));
  for (PetscInt k = 0; k < p->num_controls; ++k) {
    pressure[k] = p->scalar[k];
    value[k]    = p->measure[k] / p->norm[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- matrix -------------------------------------------------------------------------------------------------------------- */

/* Rows of the matrix that scalar k meets, ascending, the same on every rank, freed by the caller. */
static PetscErrorCode Support_Private(Problem p, PetscInt k, PetscInt *num, PetscInt **rows)
{
  PetscBool *mark;
  PetscInt  *own, mine = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(p->tables->num_nodes, &mark));
  PetscCall(PetscMalloc1(p->num_local, &own));
  PetscCall(MechanicsControlNodes(p->mechanics, k, mark));
  for (PetscInt i = 0; i < p->num_local; ++i) {
    if (mark[i / p->dim] && p->row[i] >= 0) own[mine++] = p->row[i];
  }
  PetscCall(GatherAll(p->comm, mine, sizeof(PetscInt), own, num, rows));
  PetscCall(PetscSortRemoveDupsInt(num, *rows));
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(mark));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row and column of one scalar over the given rows: counted, or without counters written as explicit zeros by their owners. */
static PetscErrorCode CrossPattern_Private(Problem p, PetscInt scalar, PetscInt num, const PetscInt rows[], PetscInt diagonal[], PetscInt other[])
{
  const PetscInt  first = p->first_row, end = p->first_row + p->num_rows;
  const PetscBool mine = (PetscBool)(scalar >= first && scalar < end);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; ++i) {
    const PetscBool here = (PetscBool)(rows[i] >= first && rows[i] < end);
    if (diagonal) {
      if (here) ++(mine ? diagonal : other)[rows[i] - first];
      if (mine) ++(here ? diagonal : other)[scalar - first];
      continue;
    }
    if (here) PetscCall(MatSetValue(p->matrix, rows[i], scalar, 0, ADD_VALUES));
    if (mine) PetscCall(MatSetValue(p->matrix, scalar, rows[i], 0, ADD_VALUES));
  }
  if (!diagonal && mine) PetscCall(MatSetValue(p->matrix, scalar, scalar, 0, ADD_VALUES)); /* the diagonal has its room anyway */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScalarsPattern_Private(Problem p, PetscInt diagonal[], PetscInt other[])
{
  PetscInt num, *rows;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_scalars; ++k) {
    if (k >= p->num_controls && k < p->num_controls + p->num_rigid) { /* with each other; all else is contact's */
      for (PetscInt j = p->num_controls; j < p->num_controls + p->num_rigid && p->rank == p->size - 1; ++j) {
        if (diagonal) ++diagonal[Row_Private(p, k) - p->first_row];
        if (!diagonal) PetscCall(MatSetValue(p->matrix, Row_Private(p, k), Row_Private(p, j), 0, ADD_VALUES));
      }
      continue;
    }
    if (k < p->num_controls)
      PetscCall(Support_Private(p, k, &num, &rows));
    else { /* the path: everything but the scalars */
      num = Row_Private(p, 0);
      PetscCall(PetscMalloc1(num, &rows));
      for (PetscInt i = 0; i < num; ++i) rows[i] = i;
    }
    PetscCall(CrossPattern_Private(p, Row_Private(p, k), num, rows, diagonal, other));
    PetscCall(PetscFree(rows));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScalarsColumn_Private(Problem p, PetscInt k, const PetscReal local[])
{
  const PetscInt column = Row_Private(p, k);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_local; ++i) {
    if (local[i] != 0 && p->row[i] >= 0) PetscCall(MatSetValue(p->matrix, p->row[i], column, local[i], ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Derivative of what control k follows: free dofs to the matrix, prescribed ones times their motion to the lift. */
static PetscErrorCode ControlRow_Private(Problem p, PetscInt k, const PetscReal gradient[])
{
  const PetscInt row    = Row_Private(p, k);
  PetscReal      motion = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_local; ++i) {
    if (gradient[i] == 0) continue;
    if (p->row[i] >= 0)
      PetscCall(MatSetValue(p->matrix, row, p->row[i], p->factor[k] * gradient[i], ADD_VALUES));
    else if (p->index[i] < 0)
      motion += p->factor[k] * gradient[i] * p->increment[i];
  }
  if (p->lift) PetscCall(VecSetValue(p->lift, row, motion, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ScalarsTangent_Private(Problem p, const PetscReal u[])
{
  PetscReal *gradient, *force, value;

  PetscFunctionBegin;
  if (!p->num_scalars) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(p->num_local, &gradient, p->num_local, &force));
  for (PetscInt k = 0; k < p->num_controls; ++k) {
    PetscCall(PetscArrayzero(gradient, p->num_local));
    PetscCall(PetscArrayzero(force, p->num_local));
    PetscCall(MechanicsControl(p->mechanics, k, u, &value, gradient, force));
    PetscCall(ScalarsColumn_Private(p, k, force));
    PetscCall(ControlRow_Private(p, k, gradient));
  }
  PetscCall(PetscFree2(gradient, force));
  PetscCall(RigidTangent_Private(p));
  if (HasPath_Private(p)) PetscCall(PathTangent_Private(p, Row_Private(p, p->num_controls), u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
