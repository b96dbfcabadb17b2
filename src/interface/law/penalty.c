/* For comparison: a linear penalty, z = epsilon max(0, -gt / w): overlaps by pressure over epsilon. A compliance w / epsilon of the constraint. */
#include "interfaceimpl.h"

static int8_t State_Private(const ContactPoint *p)
{
  return p->gap < 0;
}

static void Rows_Private(const ContactPoint *p, PetscBool symmetric, ContactRow row[])
{
  ContactCompliantRow_Private(p, p->spring + p->weight / p->spec->penalty, 1 / p->spec->penalty, symmetric, row);
}

const ContactLawOps ContactPenalty = {
    .name = "penalty", .symmetric = PETSC_TRUE, .num_multipliers = ContactOneMultiplier_Private, .state = State_Private, .rows = Rows_Private};
