/* The active set that a linear step begins with: what the residual tells of each node, z - c g > 0, or the set that the last linear step ended with. Both are
   iterated until they agree with the step (src/solve/activeset.c), but the first knows nothing of what the bodies do together: after a rolling body has turned
   by theta its surface is by theta^2 R / 2 off, and more than the pressure over c leaves no node in contact, nor anything that holds the body. */
#include "interfaceimpl.h"

uint64_t InterfaceKeepActiveSet(Interface p)
{
  uint64_t bear = 0;

  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own && !c->tie; ++k) {
      const PetscInt j = c->side[0].own[k];
      c->kept[j]       = c->active[j];
      if (c->active[j]) bear |= FormPair(i);
    }
  }
  return bear;
}

PetscErrorCode ContactWarmStart_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    if (c->valued[j]) c->active[j] = c->has_multiplier[j] && ContactCovered_Private(c, j) ? c->kept[j] : 0;
  }
  PetscCall(ContactShareStates_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
