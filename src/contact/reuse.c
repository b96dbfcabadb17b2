/* Evaluations at positions of the last one. Newton's method asks for forces at a state, then for its tangent, and to prepare that for the gaps once more: what
   has been found stands, and what a facet's result lacks is added (result.c). */
#include "contactimpl.h"

static PetscErrorCode Copy_Private(PetscInt num, const PetscReal from[], PetscInt *size, PetscReal **to)
{
  PetscFunctionBegin;
  PetscCall(ArrayGrow(num, sizeof(PetscReal), size, to));
  PetscCall(PetscArraycpy(*to, from, num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Same_Private(PetscInt num, const PetscReal a[], const PetscReal b[])
{
  return (PetscBool)!memcmp(a, b, (size_t)num * sizeof(PetscReal)); /* positions that are not known are NaN */
}

PetscBool ContactStateStands(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar)
{
  const ContactState *s = &pair->state;

  return (PetscBool)(s->stands && !pair->traction && !pair->keeps && Same_Private(pair->dim * nonmortar->num_nodes, s->x[0], nonmortar->x) &&
                     Same_Private(pair->dim * mortar->num_nodes, s->x[1], mortar->x));
}

PetscBool ContactStateLoads(ContactPair pair, const PetscReal z[])
{
  return (PetscBool)(z && pair->state.loaded && Same_Private(pair->num_nodes, pair->state.z, z));
}

PetscErrorCode ContactStateKeep(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[])
{
  const ContactSurface *side[2] = {nonmortar, mortar};
  ContactState         *s       = &pair->state;

  PetscFunctionBegin;
  s->stands = PETSC_TRUE;
  s->loaded = (PetscBool)(z != NULL);
  for (int k = 0; k < 2; k++) PetscCall(Copy_Private(pair->dim * side[k]->num_nodes, side[k]->x, &s->size_x[k], &s->x[k]));
  if (z) PetscCall(Copy_Private(pair->num_nodes, z, &s->size_z, &s->z));
  PetscFunctionReturn(PETSC_SUCCESS);
}
