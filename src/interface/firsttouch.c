/* First touch: where a pair that bears nothing yet is moved into each other, the linearised gaps overlap far beyond the zone of contact to be, since the bodies
   have not given way. Sets that begin with all those nodes lose the superfluous ones from the edge inwards, a few at each linear solve; those that begin
   with too few grow to the edge at once. */
#include "interfaceimpl.h"

/* Nodes in the deepest quarter begin. At the edge of Hertz's contact the undeformed bodies overlap by half of the deepest in space, by more in the plane. */
#define DEEP 0.75

PetscErrorCode ContactLeastOverlap_Private(Interface p, const Contact *c, PetscReal *least)
{
  const Surface *s        = &c->side[0];
  PetscReal      range[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL}; /* largest overlap and minus the least of nodes that would begin to bear */
  PetscReal      more     = 0;                                  /* of them than of active ones */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    if (c->zlocal[j] < 0 || !c->near[j] || !ContactCovered_Private(c, j)) continue;
    if (c->active[j]) more -= 1;
    if (c->active[j] || !(ContactOverlap_Private(c, j) > 0)) continue;
    more += 1;
    range[0] = PetscMax(range[0], ContactOverlap_Private(c, j));
    range[1] = PetscMax(range[1], -ContactOverlap_Private(c, j));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPIU_REAL, MPI_MAX, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &more, 1, MPIU_REAL, MPI_SUM, p->comm));
  /* where all overlap alike, round-off does not choose */
  *least = more <= 0 ? 0 : DEEP * range[0] + (1 - DEEP) * -range[1] - ROUND_LENGTH * range[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFindUntouched(Interface p, uint64_t *pairs)
{
  PetscFunctionBegin;
  *pairs = 0;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c    = &p->contacts[i];
    PetscReal      most = 0;
    if (c->tie) continue;
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      const PetscInt j = c->side[0].own[k];
      if (c->zlocal[j] >= 0) most = PetscMax(most, PetscAbsReal(c->z[j]));
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, p->comm));
    if (most == 0) *pairs |= FormPair(i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
