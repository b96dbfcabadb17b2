/* Rigid-body modes as the multigrid method wants them. */
#include "problemimpl.h"

PetscErrorCode ProblemGetBlocks(Problem p, PetscInt *num_u, PetscInt *num_z, PetscInt *dim)
{
  PetscFunctionBegin;
  *num_u = p->num_u;
  *num_z = p->num_z;
  *dim   = p->dim;
  PetscFunctionReturn(PETSC_SUCCESS);
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

PetscErrorCode ProblemRigidModes(Problem p, IS is_u, MatNullSpace *modes)
{
  const PetscInt  num = p->dim == 2 ? 3 : 6;
  const HPTables *v;
  Vec             mode[6];
  PetscInt        size;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(ISGetLocalSize(is_u, &size));
  for (PetscInt k = 0; k < num; ++k) {
    PetscReal *array;
    PetscCall(VecCreate(p->comm, &mode[k]));
    PetscCall(VecSetSizes(mode[k], size, PETSC_DETERMINE));
    PetscCall(VecSetType(mode[k], VECSTANDARD));
    PetscCall(VecGetArray(mode[k], &array));
    for (PetscInt n = 0; n < v->num_nodes; ++n) {
      const PetscReal *frame;
      PetscCall(HPSpaceGetFrame(p->space, n, &frame));
      for (PetscInt d = 0; d < p->dim; ++d) {
        const PetscInt row = p->index[n * p->dim + d] - p->start;
        if (p->index[n * p->dim + d] < 0 || row < 0 || row >= p->num_u) continue;
        array[row] = 0;
        for (PetscInt c = 0; c < p->dim; ++c) array[row] += (frame ? frame[3 * d + c] : (PetscReal)(c == d)) * Mode_Private(p->dim, k, v->X + 3 * n, c);
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
