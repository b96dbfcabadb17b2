/* Orders of the new leaves. */
#include "transfer.h"

PetscErrorCode TransferOrders(const ForestMap *map, const int8_t old_order[], int8_t **new_order)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(map->num, new_order));
  for (PetscInt l = 0; l < map->num; ++l) {
    (*new_order)[l] = 1;
    for (PetscInt k = map->old_first[l]; k < map->old_first[l] + map->old_count[l]; ++k) (*new_order)[l] = PetscMax((*new_order)[l], old_order[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
