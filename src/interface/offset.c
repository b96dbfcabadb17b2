/* What counts as no gap: initial gaps of this mesh at the reference positions, and an interference, the change of all gaps by as much along their directions
   there. Both may change with time.

   With finite kinematics the facets' means are taken off within the integral (ContactPairSetClosed): forces are then those of what is left, none of which
   acts where the sides bear. Taken off the integrals as constants they would leave forces z grad gt of the gaps that are closed, which jump by pressure times
   gap where an end of the mortar side passes one of the nonmortar side. What the means leave, and all of it with small kinematics, are constants. */
#include "interfaceimpl.h"

/* Initial overlaps that are ramped count by the share t, from t = 1 on whole. */
static PetscReal Open_Private(const ContactSpec *spec, PetscReal t)
{
  return spec->ramp ? PetscMax(0, 1 - PetscMax(0, t)) : 0;
}

static PetscErrorCode Value_Private(const ContactSpec *spec, PetscReal t, PetscReal *interference)
{
  const PetscReal origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  *interference = 0;
  if (spec->interference) PetscCall(ExpressionEvaluate(spec->interference, origin, t, interference));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Friction_Private(Contact *c, PetscReal t)
{
  const PetscReal origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  if (!c->law->slips) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ExpressionEvaluate(c->spec->friction, origin, t, &c->view.friction));
  if (!(c->view.friction < 0)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ExpressionRefuse(c->spec->friction, t, c->view.friction, CONTACT_FRICTION));
  c->view.friction = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* To what is closed at time t. */
static PetscErrorCode Time_Private(Contact *c, PetscReal t)
{
  const PetscReal open = Open_Private(c->spec, t), share = c->spec->adjust ? 1 : open;
  PetscReal       interference;

  PetscFunctionBegin;
  PetscCall(Value_Private(c->spec, t, &interference));
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];
    c->offset[j]     = interference * c->reach[j] + share * c->initial[j];
  }
  for (PetscInt f = 0; f < c->side[0].num_facets && c->closed; ++f) c->closed[f] = interference + share * c->mean_gap[f];
  if (c->closed) PetscCall(ContactPairSetClosed(c->pair, c->closed));
  c->view.interference = interference;
  c->view.open         = open;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What an interference of 1 is at the nodes of this rank. Facets that have no reach of their own measure gaps along normals of length 1. */
static void Reach_Private(Contact *c)
{
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *f = &c->facets[i];
    for (PetscInt k = 0; k < f->num_rows; ++k) {
      if (c->side[0].owned[f->nodes[k]]) c->reach[f->nodes[k]] += f->reach ? f->reach[k] : f->weight[k];
    }
  }
}

/* Weighted gaps at the reference positions, of nodes into c->gap, with lengths that are closed. */
static PetscErrorCode Gaps_Private(Interface p, Contact *c, const PetscReal closed[])
{
  ContactSurface      side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};
  const ContactFacet *facets;
  PetscBool           failed;

  PetscFunctionBegin;
  PetscCall(ContactPairSetClosed(c->pair, closed));
  PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], NULL, NULL, PETSC_FALSE, PETSC_FALSE, &c->num_facets, &facets, &failed));
  c->facets = facets;
  PetscCall(ContactNodeSums_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Weighted gaps of facets, summed up, into to[]; those that meet nothing have none. */
static void OfFacets_Private(const Contact *c, PetscReal to[])
{
  for (PetscInt i = 0; i < c->num_facets; ++i)
    for (PetscInt k = 0; k < c->facets[i].num_rows; ++k) to[c->facets[i].facet] += c->facets[i].gap[k];
}

/* Means of the facets' lengths along their rays, and of what was to be taken off at the nodes that part which lengths on facets do not: c->gap is the gaps of
   the mesh. */
static PetscErrorCode Means_Private(Interface p, Contact *c)
{
  const Surface *s   = &c->side[0];
  const PetscInt num = s->num_facets;
  PetscReal     *whole, *less;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(num, &c->closed, num, &c->mean_gap));
  PetscCall(PetscCalloc2(num, &whole, num, &less));
  PetscCall(PetscArraycpy(c->gap0, c->gap, s->num_nodes));
  OfFacets_Private(c, whole);
  for (PetscInt f = 0; f < num; ++f) c->closed[f] = 1;
  PetscCall(Gaps_Private(p, c, c->closed));
  OfFacets_Private(c, less);
  for (PetscInt i = 0; i < s->num_own; ++i) c->reach[s->own[i]] -= c->gap0[s->own[i]] - c->gap[s->own[i]];
  for (PetscInt f = 0; f < num; ++f) {
    c->mean_gap[f] = whole[f] != less[f] ? whole[f] / (whole[f] - less[f]) : 0;
    if (!c->spec->adjust) c->mean_gap[f] = PetscMin(c->mean_gap[f], 0);
  }
  PetscCall(Gaps_Private(p, c, c->mean_gap));
  for (PetscInt i = 0; i < s->num_own; ++i) c->initial[s->own[i]] -= c->gap0[s->own[i]] - c->gap[s->own[i]];
  PetscCall(PetscFree2(whole, less));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactOffset_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(c->offset, s->num_nodes));
  if (!c->spec->adjust && !c->spec->ramp && !c->spec->interference) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactSearch_Private(p, c, PETSC_TRUE, 0));
  PetscCall(Gaps_Private(p, c, NULL));
  Reach_Private(c);
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    c->initial[j]    = c->spec->adjust ? c->gap[j] : PetscMin(c->gap[j], 0);
    if (c->spec->adjust && ContactCovered_Private(c, j)) c->view.adjusted = PetscMax(c->view.adjusted, PetscAbsReal(c->gap[j] / c->weight[j]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->view.adjusted, 1, MPIU_REAL, MPI_MAX, p->comm));
  if (p->spec->kinematics == KINEMATICS_FINITE) PetscCall(Means_Private(p, c));
  c->num_facets = 0;
  PetscCall(Time_Private(c, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceSetTime(Interface p, PetscReal t)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    PetscCall(Time_Private(&p->contacts[i], t));
    PetscCall(Friction_Private(&p->contacts[i], t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
