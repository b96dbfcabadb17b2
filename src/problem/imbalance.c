/* What a state lacks of equilibrium, and problems in which a share of it counts as being in balance: the way from that state to a solution.

   A state carried to another mesh is off in two ways. Cells whose stress was interpolated are out of balance, and so are surfaces: linear contact faces that
   are split follow a curved boundary more closely, and gaps change by the height of the arc over a face. Forces and gaps are therefore taken note of alike. */
#include "problemimpl.h"

PetscErrorCode ProblemNoteImbalance(Problem p, Vec x, PetscBool *usable)
{
  ProblemStatus status;
  PetscScalar  *r;
  PetscInt      num;

  PetscFunctionBegin;
  PetscCall(ProblemLeaveImbalance(p, 0));
  if (!p->imbalance) PetscCall(ProblemCreateVector(p, &p->imbalance));
  PetscCall(ProblemSearch(p, x));
  PetscCall(ProblemResidual(p, x, NULL, p->imbalance, &status));
  PetscCall(VecGetLocalSize(p->imbalance, &num));
  PetscCall(VecGetArray(p->imbalance, &r));
  PetscCall(PetscArrayzero(r + p->num_u, num - p->num_u)); /* other rows: by the gaps, or not at all */
  PetscCall(VecRestoreArray(p->imbalance, &r));
  PetscCall(InterfaceNoteMisfit(p->interface));
  *usable = (PetscBool)!status.bad;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemLeaveImbalance(Problem p, PetscReal share)
{
  PetscFunctionBegin;
  PetscCall(InterfaceLeaveMisfit(p->interface, share));
  p->share = share;
  PetscFunctionReturn(PETSC_SUCCESS);
}
