/* Static condensation of the nodes inside cells (mechanics/condense.c): the matrix and its right-hand side know only the other unknowns. Inner nodes are
   the first of every rank's part of the problem's vector, since the space numbers them by cells, vertices, faces, edges: what the matrix knows is its tail. */
#include "problemimpl.h"

/* Numbers of the unknowns in the matrix from those in the vector. */
PetscErrorCode ProblemRows_Private(Problem p)
{
  const HPTables *v = p->tables;
  PetscInt       *inner, *counts;

  PetscFunctionBegin;
  p->num_inner = 0;
  for (PetscInt i = 0; i < v->point_node[v->num_owned_cells] * p->dim && p->condensed; ++i) {
    if (p->index[i] < 0) continue;
    PetscCheck(p->index[i] == p->start + p->num_inner, PETSC_COMM_SELF, PETSC_ERR_PLIB, "inner nodes are not the first");
    ++p->num_inner;
  }
  PetscCall(PetscMalloc2(p->size, &inner, p->size, &counts));
  PetscCallMPI(MPI_Allgather(&p->num_inner, 1, MPIU_INT, inner, 1, MPIU_INT, p->comm));
  p->row_start[0] = 0;
  for (PetscMPIInt r = 0; r < p->size; ++r) {
    p->row_start[r + 1] = p->row_start[r] + p->p_start[r + 1] - p->p_start[r] - inner[r];
    counts[r]           = p->u_start[r + 1] - p->u_start[r];
  }
  p->first_row = p->row_start[p->rank];
  p->num_rows  = p->row_start[p->rank + 1] - p->first_row;
  for (PetscInt i = 0; i < p->num_local; ++i) {
    PetscMPIInt r = 0;
    p->row[i]     = -1;
    if (p->index[i] < 0 || (p->condensed && i < v->point_node[v->num_cells] * p->dim)) continue;
    while (p->index[i] >= p->p_start[r + 1]) ++r;
    p->row[i] = p->index[i] - p->p_start[r] - inner[r] + p->row_start[r];
  }
  PetscCall(PressureRowNumbers_Private(p, inner));
  for (PetscMPIInt r = 0; r < p->size; ++r) inner[r] = p->row_start[r] - inner[r];
  PetscCall(InterfaceSetRows(p->interface, counts, inner, p->row, p->num_inner));
  PetscCall(RigidSetRows_Private(p, p->row_start[p->size] - p->num_scalars + p->num_controls));
  PetscCall(PetscFree2(inner, counts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSetCondense(Problem p)
{
  PetscFunctionBegin;
  if (p->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!p->matrix, p->comm, PETSC_ERR_ORDER, "condensation is chosen before the matrix is made");
  p->condensed = PETSC_TRUE;
  PetscCall(MechanicsSetCondense(p->mechanics));
  PetscCall(ProblemRows_Private(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemCreateRightSide(Problem p, Vec *rhs)
{
  PetscFunctionBegin;
  PetscCall(VecCreate(p->comm, rhs));
  PetscCall(VecSetSizes(*rhs, p->num_rows, PETSC_DETERMINE));
  PetscCall(VecSetType(*rhs, VECSTANDARD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rhs = r of the matrix's unknowns, with the forces of inner nodes condensed. */
PetscErrorCode ProblemReduce_Private(Problem p, Vec r, Vec rhs)
{
  const HPTables  *v = p->tables;
  const PetscReal *from;
  PetscReal       *local, *to, *change;
  DM               dm;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(r, &from));
  PetscCall(VecGetArray(rhs, &to));
  PetscCall(PetscArraycpy(to, from + p->num_inner, p->num_rows));
  if (p->condensed) {
    dm = HPSpaceGetDM(p->space);
    PetscCall(VecSet(p->r_local, 0));
    PetscCall(VecGetArray(p->r_local, &local));
    for (PetscInt i = 0; i < v->point_node[v->num_owned_cells] * p->dim; ++i) {
      if (p->index[i] >= 0) local[i] = from[p->index[i] - p->start];
    }
    PetscCall(MechanicsCondenseForces(p->mechanics, local));
    PetscCall(VecRestoreArray(p->r_local, &local));
    PetscCall(VecSet(p->u_global, 0));
    PetscCall(DMLocalToGlobal(dm, p->r_local, ADD_VALUES, p->u_global));
    PetscCall(VecGetArray(p->u_global, &change));
    for (PetscInt i = p->num_inner; i < p->num_u; ++i) to[i - p->num_inner] += change[i];
    PetscCall(VecRestoreArray(p->u_global, &change));
  }
  PetscCall(VecRestoreArray(rhs, &to));
  PetscCall(VecRestoreArrayRead(r, &from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemRecover(Problem p, Vec y, Vec dx)
{
  const PetscReal *from;
  PetscReal       *to;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(y, &from));
  PetscCall(VecGetArray(dx, &to));
  PetscCall(PetscArrayzero(to, p->num_inner));
  PetscCall(PetscArraycpy(to + p->num_inner, from, p->num_rows));
  if (p->symmetric) InterfaceScaleIncrement(p->interface, to);
  PetscCall(VecRestoreArray(dx, &to));
  PetscCall(VecRestoreArrayRead(y, &from));
  if (!p->condensed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  PetscCall(MechanicsRecover(p->mechanics, p->increment));
  PetscCall(ProblemSetDisplacement(p, p->increment, dx));
  PetscFunctionReturn(PETSC_SUCCESS);
}
