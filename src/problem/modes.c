/* What multigrid methods want of a problem: rigid-body modes, and the space of order 1 inside the one of higher order. */
#include "problemimpl.h"

#define MOST_VERTICES 64 /* of a node's row: 8 of a cell, each with up to 8 masters */

void ProblemGetBlocks(Problem p, PetscInt *num_u, PetscInt *num_z, PetscInt *dim)
{
  *num_u = p->num_u - p->num_inner;
  *num_z = p->num_z;
  *dim   = p->dim;
}

/* Row of a local dof among this rank's displacement dofs in the matrix, -1: prescribed, hanging, condensed or another rank's. */
static inline PetscInt Row_Private(Problem p, PetscInt dof)
{
  const PetscInt row = p->row[dof] - p->first_row;
  return p->row[dof] >= 0 && row >= 0 && row < p->num_u - p->num_inner ? row : -1;
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

/* Rigid-body modes over the dofs whose places are row[num_nodes*dim] (-1: none) of size entries on this rank. */
static PetscErrorCode Modes_Private(Problem p, const PetscInt row[], PetscInt size, MatNullSpace *modes)
{
  const PetscInt  num = p->dim == 2 ? 3 : 6;
  const HPTables *v   = p->tables;
  PetscReal       centre[3];
  Vec             mode[6];

  PetscFunctionBegin;
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

/* Columns of the vertices' dofs: dim of them for every vertex of which some dof is free, so that blocks stay whole. On this rank column[num_nodes*dim] (-1: no
   vertex with a free dof here), in all global[num_nodes*dim] (-1: prescribed, hanging, no vertex). */
static PetscErrorCode CoarseNumbers_Private(Problem p, const HPTables *v, const ForestTables *t, PetscInt column[], PetscInt global[], PetscInt *size)
{
  const PetscInt   dim = p->dim;
  const PetscReal *u;
  PetscReal       *array;
  PetscInt         first = 0;
  const DM         dm    = HPSpaceGetDM(p->space);

  PetscFunctionBegin;
  *size = 0;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    PetscBool free = PETSC_FALSE;
    for (PetscInt d = 0; d < dim; ++d) free = (PetscBool)(free || (v->node_entity[n] < t->first[1] && Row_Private(p, n * dim + d) >= 0));
    for (PetscInt d = 0; d < dim; ++d) column[n * dim + d] = free ? *size + d : -1;
    if (free) *size += dim;
  }
  PetscCallMPI(MPI_Exscan(size, &first, 1, MPIU_INT, MPI_SUM, p->comm));
  PetscCall(VecSet(p->u_global, -1));
  PetscCall(VecGetArray(p->u_global, &array));
  for (PetscInt i = 0; i < v->num_nodes * dim; ++i) {
    if (column[i] >= 0 && Row_Private(p, i) >= 0) array[p->num_inner + Row_Private(p, i)] = (PetscReal)(first + column[i]);
  }
  PetscCall(VecRestoreArray(p->u_global, &array));
  PetscCall(DMGlobalToLocal(dm, p->u_global, INSERT_VALUES, p->u_local));
  PetscCall(VecGetArrayRead(p->u_local, &u));
  for (PetscInt i = 0; i < v->num_nodes * dim; ++i) global[i] = p->index[i] >= 0 && v->node_entity[i / dim] < t->first[1] ? (PetscInt)u[i] : -1;
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

/* Ones on the diagonal of columns that stand for prescribed dofs, nothing else. */
static PetscErrorCode Pinned_Private(Problem p, const HPTables *v, const PetscInt column[], PetscInt size, Mat *pinned)
{
  PetscInt first;

  PetscFunctionBegin;
  PetscCall(MatCreateAIJ(p->comm, size, size, PETSC_DETERMINE, PETSC_DETERMINE, 1, NULL, 0, NULL, pinned));
  PetscCall(MatGetOwnershipRange(*pinned, &first, NULL));
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) {
    if (column[i] >= 0 && Row_Private(p, i) < 0) PetscCall(MatSetValue(*pinned, first + column[i], first + column[i], 1, INSERT_VALUES));
  }
  PetscCall(MatAssemble(*pinned, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemProlongation(Problem p, Mat *P, Mat *pinned, MatNullSpace *modes, PetscBool *higher)
{
  const HPTables     *v = p->tables;
  const ForestTables *t = ForestGetTables(p->forest);
  PetscInt           *column, *global, size, first;
  int                 any = 0;

  PetscFunctionBegin;
  for (PetscInt n = 0; n < v->num_nodes; ++n) any = any || v->node_entity[n] >= t->first[1];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, p->comm));
  *higher = (PetscBool)any;
  PetscCall(PetscMalloc2(p->num_local, &column, p->num_local, &global));
  PetscCall(CoarseNumbers_Private(p, v, t, column, global, &size));
  PetscCall(MatCreate(p->comm, P));
  PetscCall(MatSetSizes(*P, p->num_u - p->num_inner, size, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetBlockSizes(*P, 1, p->dim));
  PetscCall(MatSetType(*P, MATAIJ));
  PetscCall(MatSeqAIJSetPreallocation(*P, any ? MOST_VERTICES : 1, NULL));
  PetscCall(MatMPIAIJSetPreallocation(*P, any ? MOST_VERTICES : 1, NULL, any ? MOST_VERTICES / 2 : 1, NULL));
  PetscCall(MatSetOption(*P, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(MatGetOwnershipRange(*P, &first, NULL));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    PetscBool mine = PETSC_FALSE;
    for (PetscInt d = 0; d < p->dim; ++d) mine = (PetscBool)(mine || Row_Private(p, n * p->dim + d) >= 0);
    if (mine) PetscCall(NodeRows_Private(p, n, first, global, *P));
  }
  PetscCall(MatAssemble(*P, MAT_FINAL_ASSEMBLY));
  PetscCall(Pinned_Private(p, v, column, size, pinned));
  PetscCall(Modes_Private(p, column, size, modes));
  PetscCall(PetscFree2(column, global));
  PetscFunctionReturn(PETSC_SUCCESS);
}
