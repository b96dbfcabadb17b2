/* What a state lacks of equilibrium, and problems in which a share of it counts as being in balance: the way from that state to a solution.

   A state carried to another mesh is off in two ways. Cells whose stress was interpolated are out of balance, and so are surfaces: linear contact faces that
   are split follow a curved boundary more closely, and gaps change by the height of the arc over a face. Forces and gaps are therefore taken note of alike. */
#include "problemimpl.h"

/* The constant by which the gap of a node contradicts its pressure: all of the gap where it presses, what lies over the other side where it does not. */
static PetscReal Misfit_Private(const Contact *c, PetscInt j)
{
  if (!c->has_multiplier[j] || !ContactCovered_Private(c, j)) return 0;
  return ContactPressed_Private(c, j) ? ContactRowGap_Private(c, j) : PetscMin(c->gap[j], 0);
}

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
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) c->misfit[c->side[0].own[k]] = Misfit_Private(c, c->side[0].own[k]);
  }
  *usable = (PetscBool)!status.bad;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemLeaveImbalance(Problem p, PetscReal share)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      const PetscInt j = c->side[0].own[k];
      c->offset[j] += (share - p->share) * c->misfit[j];
    }
  }
  p->share = share;
  PetscFunctionReturn(PETSC_SUCCESS);
}
