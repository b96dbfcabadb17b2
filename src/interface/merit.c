/* Contact in the augmented Lagrangian (src/problem/energy.c), without compliances and forces of a frozen segmentation: gaps, weights and their derivatives are
   as the mesh has them. */
#include "interfaceimpl.h"

/* Constraints without compliance (on false), or as they were. */
static void Softness_Private(Interface p, PetscBool on)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) ContactPairSetSoftness(p->contacts[i].pair, on ? p->contacts[i].softness : NULL);
}

static PetscReal Pressure_Private(const Contact *c, PetscInt j, PetscReal factor, PetscReal lambda)
{
  return c->has_multiplier[j] && ContactCovered_Private(c, j) ? PetscMax(0, lambda - factor * c->c[j] * c->gap[j] / c->weight[j]) : 0;
}

/* Multipliers of a vector from the gaps: z_j = max(0, lambda_j - kappa_j g_j), lambda_j in change. plus: z_j + lambda_j. */
static PetscErrorCode SetMultipliers_Private(const Contact *c, PetscReal factor, PetscBool plus, Vec x)
{
  PetscReal *to;

  PetscFunctionBegin;
  PetscCall(VecGetArray(x, &to));
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];
    if (c->zlocal[j] >= 0) to[c->zlocal[j]] = Pressure_Private(c, j, factor, c->change[j]) + (plus ? c->change[j] : 0);
  }
  PetscCall(VecRestoreArray(x, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's part of Phi, lambda_j in change. */
static PetscReal Energy_Private(const Contact *c, PetscReal factor)
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];
    if (c->zlocal[j] < 0 || !ContactCovered_Private(c, j)) continue;
    sum += c->weight[j] * (PetscSqr(Pressure_Private(c, j, factor, c->change[j])) - PetscSqr(c->change[j])) / (2 * factor * c->c[j]);
  }
  return sum;
}

/* z_j dgt_j - a_j dw_j on both sides, lambda_j in change. */
static PetscErrorCode Forces_Private(Contact *c, PetscReal factor)
{
  PetscReal *z, *a;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(c->side[0].num_nodes, &z, c->side[0].num_nodes, &a));
  for (PetscInt i = 0; i < c->num_valued; ++i) {
    const PetscInt j = c->valued_node[i];
    if (!c->has_multiplier[j] || !ContactCovered_Private(c, j)) continue;
    z[j] = Pressure_Private(c, j, factor, c->change[j]);
    a[j] = (z[j] * z[j] - PetscSqr(c->change[j])) / (2 * factor * c->c[j]) + z[j] * c->gap[j] / c->weight[j];
  }
  ContactFacetForces_Private(c, z, a);
  PetscCall(PetscFree2(z, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One pair: its part of Phi, its forces off r (NULL: not wanted), its multipliers into x. Derivatives come of facets whose multipliers do not vanish: for them
   x has z + lambda. */
static PetscErrorCode Pair_Private(Interface p, Contact *c, PetscReal factor, Vec lambda, const PetscReal u[], PetscReal pending, PetscReal r[], Vec x,
                                   PetscReal *energy, PetscBool *failed)
{
  PetscFunctionBegin;
  PetscCall(ContactEvaluate_Private(p, c, lambda, u, pending, PETSC_FALSE, PETSC_FALSE, failed));
  PetscCall(PetscArraycpy(c->change, c->z, c->side[0].num_nodes));
  *energy += Energy_Private(c, factor);
  if (r) {
    PetscCall(SetMultipliers_Private(c, factor, PETSC_TRUE, x));
    PetscCall(ContactEvaluate_Private(p, c, x, u, pending, PETSC_TRUE, PETSC_FALSE, failed));
    PetscCall(Forces_Private(c, factor));
    PetscCall(ContactForcesSubtract_Private(p, c, r));
  }
  PetscCall(SetMultipliers_Private(c, factor, PETSC_FALSE, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceMerit(Interface p, PetscReal factor, Vec lambda, const PetscReal u[], PetscReal pending, PetscReal r[], Vec x, PetscReal *energy,
                              PetscBool *failed)
{
  PetscFunctionBegin;
  Softness_Private(p, PETSC_FALSE);
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(Pair_Private(p, &p->contacts[i], factor, lambda, u, pending, r, x, energy, failed));
  Softness_Private(p, PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceMeritDepth(Interface p, Vec depth)
{
  PetscReal *to;

  PetscFunctionBegin;
  PetscCall(VecSet(depth, 0));
  PetscCall(VecGetArray(depth, &to));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      const PetscInt j = c->side[0].own[k];
      if (c->zlocal[j] >= 0) to[c->zlocal[j]] = ContactCovered_Private(c, j) ? PetscMax(0, -c->gap[j] / (c->weight[j] * c->extent[j])) : -1;
    }
  }
  PetscCall(VecRestoreArray(depth, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceMeritEvaluate(Interface p, Vec x, const PetscReal u[], PetscReal pending, PetscBool open, PetscBool *failed)
{
  PetscFunctionBegin;
  Softness_Private(p, PETSC_FALSE);
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    PetscCall(ContactEvaluate_Private(p, c, x, u, pending, PETSC_TRUE, PETSC_TRUE, failed));
    for (PetscInt k = 0; k < c->num_valued; ++k) {
      const PetscInt j = c->valued_node[k];
      c->active[j]     = (PetscBool)(!open && c->has_multiplier[j] && c->z[j] > 0);
    }
  }
  Softness_Private(p, PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceMeritHessians(Interface p, const InterfaceSystem *a)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt f = 0; f < c->num_facets; ++f) {
      if (c->mine[c->facets[f].facet] && c->facets[f].hessian) PetscCall(ContactFacetHessian_Private(p, a, c, &c->facets[f]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of the multipliers of this rank: c_j b_j of those that press, each times -1, and the diagonal. */
static PetscErrorCode Rows_Private(Interface p, const InterfaceSystem *a, const Contact *c, PetscReal factor)
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    const ContactRow open = {.z = {-c->w0[j]}}, pressed = {.factor = -c->c[j], .mean = c->gap[j] / c->weight[j], .z = {-c->weight[j] / factor}};
    if (c->zlocal[j] >= 0) PetscCall(ContactInsertRow_Private(p, a, c, j, c->active[j] ? &pressed : &open));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceMeritRows(Interface p, const InterfaceSystem *a, PetscReal factor)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(Rows_Private(p, a, &p->contacts[i], factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}
