/* One mesh for many states: the largest indicator of each leaf over all of them, each relative to its state, for marking what any of them needs. */
#include "estimateimpl.h"

#define ROOM_H 4 /* numbers by which a leaf is stored: eta2, along; more where orders are chosen: decay, order, lowest, irregular */
#define ROOM_HP 8

static PetscErrorCode Create_Private(PetscInt num_leaves, PetscBool orders, Estimate *most)
{
  PetscFunctionBegin;
  *most = (Estimate){.num_leaves = num_leaves};
  PetscCall(PetscCalloc1(num_leaves, &most->eta2));
  PetscCall(PetscCalloc1(num_leaves, &most->along));
  if (!orders) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(num_leaves, &most->decay));
  PetscCall(PetscCalloc1(num_leaves, &most->order));
  PetscCall(PetscCalloc1(num_leaves, &most->lowest));
  PetscCall(PetscCalloc1(num_leaves, &most->irregular));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateLargest(const Estimate *e, Estimate *most)
{
  const PetscReal whole = PetscSqr(e->norm) + PetscSqr(e->total);

  PetscFunctionBegin;
  if (whole == 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (!most->num_leaves) PetscCall(Create_Private(e->num_leaves, (PetscBool)(e->decay != NULL), most));
  PetscCheck(e->num_leaves == most->num_leaves, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "estimate of %" PetscInt_FMT " leaves for one of %" PetscInt_FMT,
             e->num_leaves, most->num_leaves);
  most->relative = PetscMax(most->relative, e->relative);
  for (PetscInt l = 0; l < e->num_leaves; ++l) {
    if (e->decay) most->order[l] = e->order[l], most->lowest[l] = e->lowest[l];
    if (e->eta2[l] / whole <= most->eta2[l]) continue;
    most->eta2[l] = e->eta2[l] / whole;
    for (PetscInt d = 0; d < 3; ++d) most->along[l][d] = e->along[l][d] / whole;
    if (e->decay) most->decay[l] = e->decay[l], most->irregular[l] = e->irregular[l];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateStore(const Estimate *most, PetscInt *num, PetscReal **values)
{
  const PetscInt room = most->decay ? ROOM_HP : ROOM_H;

  PetscFunctionBegin;
  *num = room * most->num_leaves;
  PetscCall(PetscMalloc1(*num, values));
  for (PetscInt l = 0; l < most->num_leaves; ++l) {
    PetscReal *v = *values + room * l;
    *v++         = most->eta2[l];
    for (PetscInt d = 0; d < 3; ++d) *v++ = most->along[l][d];
    if (!most->decay) continue;
    *v++ = most->decay[l];
    *v++ = most->order[l];
    *v++ = most->lowest[l];
    *v++ = most->irregular[l];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateLoad(PetscInt num_leaves, PetscInt num, const PetscReal values[], Estimate *most)
{
  const PetscInt room = num == ROOM_HP * num_leaves ? ROOM_HP : ROOM_H;

  PetscFunctionBegin;
  PetscCheck(num == room * num_leaves, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "%" PetscInt_FMT " numbers for %" PetscInt_FMT " leaves", num, num_leaves);
  PetscCall(Create_Private(num_leaves, (PetscBool)(room == ROOM_HP), most));
  for (PetscInt l = 0; l < num_leaves; ++l) {
    const PetscReal *v = values + room * l;
    most->eta2[l]      = *v++;
    for (PetscInt d = 0; d < 3; ++d) most->along[l][d] = *v++;
    if (!most->decay) continue;
    most->decay[l]     = *v++;
    most->order[l]     = (int8_t)*v++;
    most->lowest[l]    = (int8_t)*v++;
    most->irregular[l] = (int8_t)*v++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
