/* Compliances S of facets that are covered in part (contact.h), at the nodes: what the pressures of others add to a gap. */
#include "interfaceimpl.h"

void ContactCoupling_Private(const Contact *c, const PetscReal z[], PetscReal coupled[])
{
  const Surface *s = &c->side[0];

  for (PetscInt i = 0; i < s->num_own; ++i) coupled[s->own[i]] = 0;
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e = &c->facets[i];
    if (!e->compliance) continue;
    const PetscReal mean = ContactFacetMean(e, e->nodes, z);
    for (PetscInt k = 0; k < e->num_rows; ++k) {
      const PetscInt j = e->nodes[k];
      if (s->owned[j]) coupled[j] += e->kappa[0] * e->compliance[k] * (z[j] - mean) - ContactCompliance_Private(e, k, k) * z[j];
    }
  }
}

PetscReal ContactIdle_Private(const Contact *c, PetscInt j)
{
  const Surface *s   = &c->side[0];
  PetscReal      sum = 0;

  for (PetscInt i = s->node_first[j]; i < s->node_first[j + 1]; ++i) {
    PetscInt            row;
    const ContactFacet *e = ContactCompliant_Private(c, 0, j, i, &row);
    for (PetscInt l = 0; e && l < e->num_rows; ++l) {
      if (l != row && !c->active[e->nodes[l]]) sum += ContactSoft_Private(c, 0, e, row, l) * c->z[e->nodes[l]];
    }
  }
  return sum;
}

PetscReal ContactYield_Private(const Contact *c, const ContactFacet *e, PetscInt k, PetscReal along)
{
  if (!e->compliance || !e->dshare) return 0;
  return e->kappa[1] * e->compliance[k] * (c->z[e->nodes[k]] - ContactFacetMean(e, e->nodes, c->z) - along * (1 - e->compliance[k] / e->compliance_sum));
}
