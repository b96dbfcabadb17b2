/* Sorted arrays, buffers that grow. */
#include "base.h"

PetscInt SortedFrom(const void *key, const void *array, PetscInt num, size_t entry, int (*compare)(const void *, const void *))
{
  PetscInt lo = 0, hi = num;

  while (lo < hi) {
    const PetscInt middle = (lo + hi) / 2;
    if (compare((const char *)array + (size_t)middle * entry, key) < 0)
      lo = middle + 1;
    else
      hi = middle;
  }
  return lo;
}

PetscErrorCode GatherToAll(MPI_Comm comm, size_t entry, PetscInt *num, void **array)
{
  PetscMPIInt  size, *counts, *starts, own;
  MPI_Datatype type;
  PetscInt     all = 0;
  char        *gathered;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(*num, &own));
  PetscCall(PetscMalloc2(size, &counts, size, &starts));
  PetscCallMPI(MPI_Allgather(&own, 1, MPI_INT, counts, 1, MPI_INT, comm));
  for (PetscMPIInt r = 0; r < size; ++r) {
    PetscCall(PetscMPIIntCast(all, &starts[r]));
    all += counts[r];
  }
  PetscCall(PetscMalloc1((size_t)all * entry, &gathered));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)entry, MPI_BYTE, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCallMPI(MPI_Allgatherv(*array, own, type, gathered, counts, starts, type, comm));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(PetscFree2(counts, starts));
  PetscCall(PetscFree(*array));
  *array = gathered;
  *num   = all;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowBufferGrow(RowBuffer *b, PetscInt num)
{
  PetscFunctionBegin;
  if (num <= b->size) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RowBufferDestroy(b));
  b->size = 2 * num;
  PetscCall(PetscMalloc2(b->size, &b->index, b->size, &b->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RowBufferDestroy(RowBuffer *b)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(b->index, b->value));
  b->size = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
