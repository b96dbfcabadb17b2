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

PetscErrorCode ArrayGrow(PetscInt num, size_t entry, PetscInt *size, void *array)
{
  PetscFunctionBegin;
  if (num <= *size) PetscFunctionReturn(PETSC_SUCCESS);
  *size = num + num / 2 + 16;
  PetscCall(PetscRealloc((size_t)*size * entry, array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeAll(PetscInt num, void *const pointer[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; i++) PetscCall(PetscFree(*(void **)pointer[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
