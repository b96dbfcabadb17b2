/* Force in place of pressure where facets are covered in part. The linear step at a node of weight w adds a pressure dz so
   that dz w balances what closes its gap; the weight of a wholly covered node stays what it is but for the strain of the
   step, that of one covered by a sliver may grow by any factor. So dz counts over the weight after the step, where that
   is the greater one. At a solution dz is 0, and the order of convergence stays: w changes by no more than the step does. */
#include "interfaceimpl.h"

void InterfaceKeepWeights(Interface p)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    const Surface *s = &c->side[0];
    for (PetscInt k = 0; k < s->num_own && !c->tie; ++k) c->before[s->own[k]] = c->spring[s->own[k]] > 0 ? c->weight[s->own[k]] : PETSC_INFINITY;
  }
}

PetscErrorCode InterfaceCarryForces(Interface p, Vec dx, PetscBool *changed)
{
  PetscReal *change;

  PetscFunctionBegin;
  *changed = PETSC_FALSE;
  PetscCall(VecGetArray(dx, &change));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    const Surface *s = &c->side[0];
    for (PetscInt n = 0; n < s->num_own && !c->tie; ++n) {
      const PetscInt j = s->own[n];
      if (c->zlocal[j] < 0 || !(c->weight[j] > PetscMax(0, c->before[j]))) continue; /* that of a sliver may be below 0 by round-off */
      for (PetscInt k = 0; k < c->num; ++k) {
        *changed = (PetscBool)(*changed || change[c->zlocal[j] + k] != 0);
        change[c->zlocal[j] + k] *= c->before[j] / c->weight[j];
      }
    }
  }
  PetscCall(VecRestoreArray(dx, &change));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, changed, 1, MPIU_BOOL, MPI_LOR, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
