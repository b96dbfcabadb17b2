/* Tied surfaces: what faced each other keeps together. The multipliers are the components of the traction, each with the row G_k = 0 (tie.c); no node
   is ever open. A component that the node carries no multiplier of is 0. */
#include "interfaceimpl.h"

static PetscInt All_Private(PetscInt dim)
{
  return dim;
}

static int8_t State_Private(const ContactPoint *p)
{
  return 1;
}

static void Rows_Private(const ContactPoint *p, PetscBool symmetric, ContactRow row[])
{
  for (PetscInt k = 0; k < p->num; ++k) {
    const TiePoint *t      = &p->tie[k];
    const PetscReal factor = symmetric ? -p->c : t->weight > 0 ? p->w0 * p->c / t->weight : 0;

    row[k]      = (ContactRow){.component = k};
    row[k].z[k] = symmetric ? -p->w0 : p->w0;
    row[k].side = -row[k].z[k] * p->z[k];
    if (!(t->weight > 0)) continue;
    row[k].value  = t->gap;
    row[k].factor = factor;
    row[k].z[k]   = factor * t->spring;
    row[k].side   = -factor * (t->gap + t->lift);
  }
}

const ContactLawOps ContactTied = {
    .name = "tied", .symmetric = PETSC_TRUE, .ties = PETSC_TRUE, .num_multipliers = All_Private, .state = State_Private, .rows = Rows_Private};
