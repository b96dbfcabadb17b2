/* What multigrid methods want of a problem: rigid-body modes, and the space of order 1 inside the one of higher order. */
#include "problemimpl.h"

#define MOST_VERTICES 64 /* of a node's row: 8 of a cell, each with up to 8 masters */

PetscErrorCode ProblemGetBlocks(Problem p, PetscInt *num_u, PetscInt *num_z, PetscInt *dim)
{
  PetscFunctionBegin;
  *num_u = p->num_u;
  *num_z = p->num_z;
  *dim   = p->dim;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row of a local dof among this rank's displacement dofs, -1: prescribed, hanging or another rank's. */
static inline PetscInt Row_Private(Problem p, PetscInt dof)
{
  const PetscInt row = p->index[dof] - p->start;
  return p->index[dof] >= 0 && row >= 0 && row < p->num_u ? row : -1;
}

/* Component c of mode k at X: translations, then rotations (in the plane: one). */
static PetscReal Mode_Private(PetscInt dim, PetscInt k, const PetscReal X[3], PetscInt c)
{
  if (k < dim) return c == k;
  const PetscInt axis = dim == 2 ? 2 : k - dim;
  if (c == (axis + 1) % 3) return -X[(axis + 2) % 3];
  if (c == (axis + 2) % 3) return X[(axis + 1) % 3];
  return 0;
}

/* Mean reference position of this rank's nodes, over ranks: rotations about it are as large as the bodies, wherever these are. */
static PetscErrorCode Centre_Private(Problem p, const HPTables *v, PetscReal centre[3])
{
  PetscReal sum[4] = {0, 0, 0, 0};

  PetscFunctionBegin;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    if (Row_Private(p, n * p->dim) < 0) continue;
    for (PetscInt c = 0; c < 3; ++c) sum[c] += v->X[3 * n + c];
    sum[3] += 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt c = 0; c < 3; ++c) centre[c] = sum[3] > 0 ? sum[c] / sum[3] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Modes over the dofs whose places are row[num_nodes*dim] (-1: none) of size entries on this rank. */
static PetscErrorCode Modes_Private(Problem p, const PetscInt row[], PetscInt size, MatNullSpace *modes)
{
  const PetscInt  num = p->dim == 2 ? 3 : 6;
  const HPTables *v;
  PetscReal       centre[3];
  Vec             mode[6];

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(Centre_Private(p, v, centre));
  for (PetscInt k = 0; k < num; ++k) {
    PetscReal *array;
    PetscCall(VecCreate(p->comm, &mode[k]));
    PetscCall(VecSetSizes(mode[k], size, PETSC_DETERMINE));
    PetscCall(VecSetType(mode[k], VECSTANDARD));
    PetscCall(VecGetArray(mode[k], &array));
    for (PetscInt n = 0; n < v->num_nodes; ++n) {
      const PetscReal X[3] = {v->X[3 * n] - centre[0], v->X[3 * n + 1] - centre[1], v->X[3 * n + 2] - centre[2]}, *frame;
      PetscCall(HPSpaceGetFrame(p->space, n, &frame));
      for (PetscInt d = 0; d < p->dim; ++d) {
        const PetscInt at = row[n * p->dim + d];
        if (at < 0) continue;
        array[at] = 0;
        for (PetscInt c = 0; c < p->dim; ++c) array[at] += (frame ? frame[3 * d + c] : (PetscReal)(c == d)) * Mode_Private(p->dim, k, X, c);
      }
    }
    PetscCall(VecRestoreArray(mode[k], &array));
    for (PetscInt j = 0; j < k; ++j) { /* Gram-Schmidt */
      PetscScalar dot;
      PetscCall(VecDot(mode[k], mode[j], &dot));
      PetscCall(VecAXPY(mode[k], -dot, mode[j]));
    }
    PetscCall(VecNormalize(mode[k], NULL));
  }
  PetscCall(MatNullSpaceCreate(p->comm, PETSC_FALSE, num, mode, modes));
  for (PetscInt k = 0; k < num; ++k) PetscCall(VecDestroy(&mode[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemRigidModes(Problem p, MatNullSpace *modes)
{
  const HPTables *v;
  PetscInt       *row;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(PetscMalloc1(v->num_nodes * p->dim, &row));
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) row[i] = Row_Private(p, i);
  PetscCall(Modes_Private(p, row, p->num_u, modes));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places of the vertices' dofs: on this rank row[num_nodes*dim], in all global[num_nodes*dim] (-1: none). */
static PetscErrorCode CoarseNumbers_Private(Problem p, const HPTables *v, const ForestTables *t, PetscInt row[], PetscInt global[], PetscInt *size)
{
  const PetscReal *u;
  PetscReal       *array;
  PetscInt         first = 0;
  DM               dm;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetDM(p->space, &dm));
  *size = 0;
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) row[i] = v->node_entity[i / p->dim] < t->first[1] && Row_Private(p, i) >= 0 ? (*size)++ : -1;
  PetscCallMPI(MPI_Exscan(size, &first, 1, MPIU_INT, MPI_SUM, p->comm));
  PetscCall(VecSet(p->u_global, -1));
  PetscCall(VecGetArray(p->u_global, &array));
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) {
    if (row[i] >= 0) array[Row_Private(p, i)] = (PetscReal)(first + row[i]);
  }
  PetscCall(VecRestoreArray(p->u_global, &array));
  PetscCall(DMGlobalToLocalBegin(dm, p->u_global, INSERT_VALUES, p->u_local));
  PetscCall(DMGlobalToLocalEnd(dm, p->u_global, INSERT_VALUES, p->u_local));
  PetscCall(VecGetArrayRead(p->u_local, &u));
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) global[i] = p->index[i] >= 0 && v->node_entity[i / p->dim] < t->first[1] ? (PetscInt)u[i] : -1;
  PetscCall(VecRestoreArrayRead(p->u_local, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One node's rows of the interpolation. */
static PetscErrorCode NodeRows_Private(Problem p, PetscInt node, PetscInt first, const PetscInt global[], Mat P)
{
  PetscInt         num, vertices[MOST_VERTICES];
  PetscReal        weights[MOST_VERTICES];
  const PetscReal *own, *other;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetVertexRow(p->space, node, MOST_VERTICES, &num, vertices, weights));
  PetscCall(HPSpaceGetFrame(p->space, node, &own));
  for (PetscInt d = 0; d < p->dim; ++d) {
    const PetscInt row = Row_Private(p, node * p->dim + d);
    if (row < 0) continue;
    for (PetscInt k = 0; k < num; ++k) {
      PetscCall(HPSpaceGetFrame(p->space, vertices[k], &other));
      for (PetscInt e = 0; e < p->dim; ++e) {
        PetscReal value = 0;
        for (PetscInt c = 0; c < p->dim; ++c) value += (own ? own[3 * d + c] : (PetscReal)(c == d)) * (other ? other[3 * e + c] : (PetscReal)(c == e));
        if (value == 0 || global[vertices[k] * p->dim + e] < 0) continue;
        PetscCall(MatSetValue(P, first + row, global[vertices[k] * p->dim + e], value * weights[k], ADD_VALUES));
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemProlongation(Problem p, Mat *P, MatNullSpace *modes)
{
  const HPTables     *v;
  const ForestTables *t;
  PetscInt           *row, *global, size, first;
  int                 higher = 0;

  PetscFunctionBegin;
  *P     = NULL;
  *modes = NULL;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(ForestGetTables(p->forest, &t));
  for (PetscInt n = 0; n < v->num_nodes; ++n) higher = higher || v->node_entity[n] >= t->first[1];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &higher, 1, MPI_INT, MPI_MAX, p->comm));
  if (!higher) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(v->num_nodes * p->dim, &row, v->num_nodes * p->dim, &global));
  PetscCall(CoarseNumbers_Private(p, v, t, row, global, &size));
  PetscCall(MatCreateAIJ(p->comm, p->num_u, size, PETSC_DETERMINE, PETSC_DETERMINE, MOST_VERTICES, NULL, MOST_VERTICES / 2, NULL, P));
  PetscCall(MatSetOption(*P, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(MatGetOwnershipRange(*P, &first, NULL));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    PetscBool mine = PETSC_FALSE;
    for (PetscInt d = 0; d < p->dim; ++d) mine = (PetscBool)(mine || Row_Private(p, n * p->dim + d) >= 0);
    if (mine) PetscCall(NodeRows_Private(p, n, first, global, *P));
  }
  PetscCall(MatAssemblyBegin(*P, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*P, MAT_FINAL_ASSEMBLY));
  PetscCall(Modes_Private(p, row, size, modes));
  PetscCall(PetscFree2(row, global));
  PetscFunctionReturn(PETSC_SUCCESS);
}
