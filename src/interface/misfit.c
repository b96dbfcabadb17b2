/* The part of gaps that contradicts the pressures of a state that is no solution, and shares of it that count as no gap (src/problem/imbalance.c). */
#include "interfaceimpl.h"

/* The constant by which the gap of a node contradicts its pressure: all of the gap where it presses, what lies over the other side where it does not. */
static PetscReal Misfit_Private(const Contact *c, PetscInt j)
{
  ContactRow row[MOST_MULTIPLIERS];

  if (c->tie || !c->has_multiplier[j] || !ContactCovered_Private(c, j)) return 0;
  ContactRows_Private(c, j, PETSC_FALSE, PETSC_FALSE, row);
  return ContactPressed_Private(c, j) ? row[0].value : PetscMin(c->gap[j], 0);
}

PetscErrorCode InterfaceNoteMisfit(Interface p)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) c->misfit[c->side[0].own[k]] = Misfit_Private(c, c->side[0].own[k]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceLeaveMisfit(Interface p, PetscReal share)
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
