/* Forces of contact pairs and the rows of their multipliers in the residual. */
#include "interfaceimpl.h"

void ContactFacetForces_Private(Contact *c, const PetscReal z[], const PetscReal measure[])
{
  const PetscInt dim = c->side[0].dim;

  for (PetscInt k = 0; k < 2; ++k) {
    Surface *s = &c->side[k];
    for (PetscInt n = 0; n < s->num_nodes; ++n)
      for (PetscInt d = 0; d < dim && s->has[n]; ++d) s->force[dim * n + d] = 0;
  }
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e    = &c->facets[i];
    const PetscReal    *push = e->push && !measure ? e->push : e->dgap;
    if (!c->mine[e->facet] || !e->dgap) continue;
    const PetscReal yield = e->compliance && e->dshare && !e->push ? 0.5 * e->kappa[1] * ContactFacetYield(e, e->nodes, z) : 0;
    for (PetscInt a = 0; a < e->num; ++a) {
      PetscReal *f = c->side[NODE_SIDE(e->nodes[a])].force + dim * NODE_INDEX(e->nodes[a]);
      for (PetscInt d = 0; d < dim && yield != 0; ++d) f[d] += yield * e->dshare[dim * a + d];
      for (PetscInt k = 0; k < e->num_rows; ++k) {
        const PetscInt j = e->nodes[k], at = dim * (k * e->num + a);
        for (PetscInt d = 0; d < dim && c->has_multiplier[j] && z[j] != 0; ++d) f[d] += z[j] * push[at + d];
        for (PetscInt d = 0; d < dim && measure && c->has_multiplier[j] && measure[j] != 0; ++d) f[d] -= measure[j] * e->dweight[at + d];
        for (PetscInt d = 0; d < dim * (dim - 1) && e->shear && c->has_multiplier[j]; ++d)
          f[d % dim] += z[c->side[0].num_nodes * (1 + d / dim) + j] * e->shear[dim * e->num_rows * e->num * (d / dim) + at + d % dim];
      }
    }
  }
}

PetscErrorCode ContactForcesSubtract_Private(Interface p, Contact *c, PetscReal r[])
{
  const PetscInt dim = p->dim;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) {
    Surface *s = &c->side[k];
    PetscCall(LinkCollect_Private(p, &s->values, dim, s->force));
    for (PetscInt n = 0; n < s->num_nodes; ++n) {
      for (PetscInt d = 0; d < dim && !s->owned[n] && s->hang[n] == s->hang[n + 1]; ++d) s->force[dim * n + d] = NAN; /* a part, which is with the owner */
    }
    for (PetscInt i = 0; i < s->num_own; ++i) {
      const PetscInt n = s->own[i];
      for (PetscInt d = 0; d < dim; ++d)
        for (PetscInt a = 0; a < dim; ++a) r[dim * s->local[n] + d] -= s->frame[dim * (dim * n + d) + a] * s->force[dim * n + a];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodal contact forces -dL_c/dx = grad (z_j gt_j + z_j S_jl z_l / 2) on both sides, small kinematics: at fixed measure. */
PetscErrorCode InterfaceForces(Interface p, PetscReal local[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes && c->mean0; ++j) c->change[j] = c->z[j] * c->mean0[j];
    ContactFacetForces_Private(c, c->z, c->mean0 ? c->change : NULL);
    if (c->tie) TieForces_Private(c);
    PetscCall(ContactForcesSubtract_Private(p, c, local));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceRows(Interface p, PetscReal r[])
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      if (c->zlocal[j] < 0) continue;
      ContactRow row[MOST_MULTIPLIERS];
      ContactRows_Private(c, j, PETSC_FALSE, PETSC_FALSE, row);
      for (PetscInt k = 0; k < c->num; ++k) r[c->zlocal[j] + k] = -row[k].side;
    }
  }
}

PetscErrorCode InterfaceHoldsLines(Interface p, PetscBool *holds)
{
  PetscBool mine = PETSC_FALSE;

  PetscFunctionBegin;
  *holds = PETSC_FALSE;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt f = 0; f < c->num_facets && !ContactIsReleased_Private(p, c); ++f) {
      const ContactFacet *e = &c->facets[f];
      for (PetscInt k = 0; k < e->num_rows && e->push; ++k) mine = (PetscBool)(mine || c->active[e->nodes[k]]);
    }
  }
  if (p->num_contacts) PetscCallMPI(MPI_Allreduce(&mine, holds, 1, COMPAT_MPI_BOOL, MPI_LOR, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Bears_Private(const Contact *c, const ContactFacet *e)
{
  for (PetscInt k = 0; k < e->num_rows; ++k)
    if (c->active[e->nodes[k]]) return PETSC_TRUE;
  return PETSC_FALSE;
}

void InterfaceWatchEnds(Interface p, PetscBool begin)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt f = 0; f < c->side[0].num_facets && begin; ++f) c->watch[f] = (EndWatch){.ends = -1};
    for (PetscInt f = 0; f < c->num_facets; ++f) {
      const ContactFacet *e = &c->facets[f];
      EndWatch           *w = &c->watch[e->facet];

      if (w->ends >= 0 && w->ends != (PetscInt)e->ends && Bears_Private(c, e)) ++w->changes;
      w->ends = e->ends;
    }
  }
}

/* Does one of this rank's facets bear whose segmentation is not frozen yet but could be? In the plane: where an end came back, or any, as of surfaces that meet
   themselves, where the ends of both sides come to lie on each other. */
static PetscBool Movable_Private(const Contact *c, PetscBool any)
{
  for (PetscInt f = 0; f < c->num_facets; ++f) {
    const ContactFacet *e = &c->facets[f];
    if (e->push || (c->side[0].dim == 2 ? !(any || c->spec->self ? e->ends : c->watch[e->facet].changes > 1) : c->side[0].order[e->facet] == 1)) continue;
    if (Bears_Private(c, e)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode InterfaceMayFreezeSegmentation(Interface p, PetscBool any, PetscBool *yes)
{
  PetscBool mine = PETSC_FALSE;

  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  if (p->spec->kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < p->num_contacts && !mine; ++i) mine = Movable_Private(&p->contacts[i], any);
  PetscCallMPI(MPI_Allreduce(&mine, yes, 1, COMPAT_MPI_BOOL, MPI_LOR, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Square of what round-off of positions leaves in the rows and forces of this rank's active nodes: epsilon |x| (E + z) w0 / extent. */
PetscReal InterfaceNoise2(Interface p)
{
  PetscReal sum = 0;

  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      const PetscInt j      = c->side[0].own[k];
      PetscReal      square = 0;
      for (PetscInt d = 0; d < p->dim; ++d) square += PetscSqr(c->side[0].x[p->dim * j + d]);
      if (c->active[j]) sum += (PetscReal)c->num * square * PetscSqr(PETSC_MACHINE_EPSILON * (c->w0[j] * (c->c[j] + PetscAbsReal(c->z[j]) / c->extent[j])));
    }
  }
  return sum;
}

/* Where the forces act: with small kinematics at the reference positions. */
PetscErrorCode InterfaceResultant(Interface p, PetscInt pair, PetscReal force[3], PetscReal moment[3])
{
  const Surface   *s      = &p->contacts[pair].side[0];
  const PetscReal *at     = p->spec->kinematics == KINEMATICS_SMALL ? s->X : s->x;
  PetscReal        sum[6] = {0}, *f = sum, *m = sum + 3;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < s->num_own; ++k) {
    const PetscReal *q = s->force + p->dim * s->own[k], *y = at + p->dim * s->own[k];
    for (PetscInt d = 0; d < p->dim; ++d) f[d] += q[d];
    m[2] += y[0] * q[1] - y[1] * q[0];
    if (p->dim == 2) continue;
    m[0] += y[1] * q[2] - y[2] * q[1];
    m[1] += y[2] * q[0] - y[0] * q[2];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 6, MPIU_REAL, MPI_SUM, p->comm));
  PetscCall(PetscArraycpy(force, f, 3));
  PetscCall(PetscArraycpy(moment, m, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}
