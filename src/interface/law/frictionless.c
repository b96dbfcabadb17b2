/* Frictionless contact: gt >= 0, z >= 0, z gt = 0, as  R = w0 [z - max(0, z - c gt / w)]. With compliances S of the constraints: gt + S z in place of gt, and
   w + c S_jj in place of w in the row, so that it stays of the size of a gap however small w is. */
#include "interfaceimpl.h"

PetscInt ContactOneMultiplier_Private(PetscInt dim)
{
  return 1;
}

void ContactCompliantRow_Private(const ContactPoint *p, PetscReal S, PetscReal slope, PetscBool symmetric, ContactRow *row)
{
  const PetscReal z = p->z[0], value = p->gap + S * z, measure = p->weight + p->c * S, mean = value / measure;
  const PetscReal factor = symmetric ? -p->c : p->w0 * p->c / measure;

  if (p->state == 0)
    *row = (ContactRow){.value = value, .z = {symmetric ? -p->w0 : p->w0}, .side = symmetric ? p->w0 * z : -p->w0 * z};
  else {
    *row      = (ContactRow){.value = value, .factor = factor, .mean = mean - slope * (z - mean * p->c), .along = mean * p->c, .z = {factor * S}};
    row->side = symmetric ? p->c * (value + p->lift) : -p->w0 * (p->c * (value + p->lift) / measure);
  }
}

static int8_t State_Private(const ContactPoint *p)
{
  return p->z[0] - p->c * p->gap / p->weight > 0;
}

static void Rows_Private(const ContactPoint *p, PetscBool symmetric, ContactRow row[])
{
  ContactCompliantRow_Private(p, p->spring, 0, symmetric, row);
}

const ContactLawOps ContactFrictionless = {
    .name = "frictionless", .symmetric = PETSC_TRUE, .num_multipliers = ContactOneMultiplier_Private, .state = State_Private, .rows = Rows_Private};
