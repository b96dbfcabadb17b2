/* Numbers that ranks have here and there, as fields spread over all ranks in equal parts, and back. */
#include "transferimpl.h"

PetscErrorCode PlacesCreate_Private(PetscInt num, PetscInt total, Places *p)
{
  PetscFunctionBegin;
  p->num   = num;
  p->total = total;
  PetscCall(PetscMalloc2(num, &p->index, num, &p->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlacesDestroy_Private(Places *p)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(p->index, p->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlacesSend_Private(MPI_Comm comm, const Places *p, Vec *field)
{
  PetscFunctionBegin;
  PetscCall(VecCreateMPI(comm, PETSC_DECIDE, p->total, field));
  PetscCall(VecSetValues(*field, p->num, p->index, p->value, INSERT_VALUES));
  PetscCall(VecAssemblyBegin(*field));
  PetscCall(VecAssemblyEnd(*field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlacesFetch_Private(Vec field, Places *p)
{
  Vec        values;
  IS         index;
  VecScatter scatter;
  PetscInt   size;

  PetscFunctionBegin;
  PetscCall(VecGetSize(field, &size));
  PetscCheckInput(size == p->total,
                  "-restart: a field of the checkpoint has %" PetscInt_FMT " numbers, not %" PetscInt_FMT ": another version of mortise wrote it", size,
                  p->total);
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, p->num, p->value, &values));
  PetscCall(ISCreateGeneral(PETSC_COMM_SELF, p->num, p->index, PETSC_USE_POINTER, &index));
  PetscCall(VecScatterCreate(field, index, values, NULL, &scatter));
  PetscCall(VecScatterBegin(scatter, field, values, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, field, values, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterDestroy(&scatter));
  PetscCall(ISDestroy(&index));
  PetscCall(VecDestroy(&values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
