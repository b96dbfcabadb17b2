/* Storage of results: blocks that are kept and filled anew at each evaluation; pointers into them stay valid until then. */
#include "facetimpl.h"

#define BLOCK 131072

PetscErrorCode ContactStoreDestroy(Store *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num; i++) PetscCall(PetscFree(s->block[i]));
  PetscCall(PetscFree(s->block));
  PetscCall(PetscFree(s->room));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for num zeros. */
PetscErrorCode ContactStoreReserve(Store *s, PetscInt num, PetscReal **array)
{
  PetscFunctionBegin;
  while (s->at < s->num && s->used + num > s->room[s->at]) s->at++, s->used = 0;
  if (s->at == s->num) {
    PetscInt size = s->size;

    PetscCall(ContactGrow(s->num + 1, sizeof(PetscReal *), &size, &s->block));
    PetscCall(ContactGrow(s->num + 1, sizeof(PetscInt), &s->size, &s->room));
    s->room[s->num] = PetscMax(num, BLOCK);
    PetscCall(PetscMalloc1(s->room[s->num], &s->block[s->num]));
    s->num++;
    s->used = 0;
  }
  *array = s->block[s->at] + s->used;
  s->used += num;
  PetscCall(PetscArrayzero(*array, num));
  PetscFunctionReturn(PETSC_SUCCESS);
}
