/* What counts as no gap: initial gaps of this mesh at the reference positions, an interference, the change of all gaps by as much along their directions there,
   and the share of initial overlaps that is ramped (overlap.c). The last two may change with time.

   With finite kinematics lengths that are linear on the facets are taken off within the integral (ContactPairSetClosed): forces are then those of what is
   left, none of which acts where the sides bear. Taken off the integrals as constants they would leave forces z grad gt of the gaps that are closed, which jump
   by pressure times gap where an end of the mortar side passes one of the nonmortar side. What such lengths leave, and all of it with small kinematics, are
   constants. */
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
static PetscErrorCode Time_Private(Interface p, Contact *c, PetscReal t)
{
  const PetscReal open = Open_Private(c->spec, t);
  PetscReal       interference;

  PetscFunctionBegin;
  PetscCall(Value_Private(c->spec, t, &interference));
  if (p->spec->kinematics == KINEMATICS_SMALL)
    interference -= open * c->ramped;
  else
    ContactLeaveRamp_Private(c, open);
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];
    c->offset[j]     = interference * c->reach[j] + c->initial[j];
  }
  for (PetscInt n = 0; n < c->side[0].num_nodes && c->closed; ++n) c->closed[n] = interference + c->corner_gap[n];
  if (c->closed) ContactPairSetClosed(c->pair, c->closed);
  c->view.interference = interference;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What an interference of 1 is at the nodes of this rank. */
static void Reach_Private(Contact *c)
{
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *f = &c->facets[i];
    for (PetscInt k = 0; k < f->num_rows; ++k) {
      if (c->side[0].owned[f->nodes[k]]) c->reach[f->nodes[k]] += f->reach[k];
    }
  }
}

/* At the reference positions: gaps and weights of the nodes of this rank. */
static PetscErrorCode AtRest_Private(Interface p, Contact *c)
{
  ContactSurface      side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};
  const ContactFacet *facets;
  PetscBool           failed;

  PetscFunctionBegin;
  PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], NULL, NULL, PETSC_FALSE, PETSC_FALSE, &c->num_facets, &facets, &failed));
  c->facets = facets;
  PetscCall(ContactNodeSums_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gaps at the corners, as lengths along the directions: means over what is covered of the facets there. Collective. */
static PetscErrorCode Corners_Private(Interface p, const Contact *c, PetscReal gaps[])
{
  const Surface *s = &c->side[0];
  PetscReal     *sum;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(2 * s->num_nodes, &sum));
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *f      = &c->facets[i];
    const PetscInt     *corner = s->facets + s->corners * f->facet;
    PetscReal           gap = 0, length = 0;

    for (PetscInt k = 0; k < f->num_rows; ++k) gap += f->gap[k], length += f->length[k];
    for (PetscInt v = 0; v < s->corners && c->mine[f->facet]; ++v) sum[2 * corner[v]] += gap, sum[2 * corner[v] + 1] += length;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(2 * s->num_nodes), MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (sum[2 * n + 1] != 0) gaps[n] = sum[2 * n] / sum[2 * n + 1];
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lengths on the facets, and what they do not take off of what is to be taken off at the nodes: of an interference of 1, and of initial gaps. Collective. */
static PetscErrorCode Lengths_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(s->num_nodes, &c->closed, s->num_nodes, &c->corner_gap));
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *f = &c->facets[i];

    for (PetscInt k = 0; k < f->num_rows; ++k)
      if (s->owned[f->nodes[k]]) c->reach[f->nodes[k]] -= f->length[k];
  }
  if (!c->spec->adjust) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Corners_Private(p, c, c->corner_gap));
  ContactPairSetClosed(c->pair, c->corner_gap);
  PetscCall(AtRest_Private(p, c));
  for (PetscInt i = 0; i < s->num_own; ++i) c->initial[s->own[i]] = c->gap[s->own[i]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactOffset_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(c->offset, s->num_nodes));
  if (!c->spec->adjust && !c->spec->ramp && !c->spec->interference) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactSearch_Private(p, c, PETSC_TRUE, 0));
  PetscCall(AtRest_Private(p, c));
  Reach_Private(c);
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j  = s->own[i];
    c->initial[j]     = c->spec->adjust ? c->gap[j] : 0;
    c->initial_gap[j] = c->weight[j] > 0 ? c->initial[j] / c->weight[j] : 0;
    if (c->spec->adjust && ContactCovered_Private(c, j)) c->view.adjusted = PetscMax(c->view.adjusted, PetscAbsReal(c->gap[j] / c->weight[j]));
  }
  PetscCall(LinkSpread_Private(p, &c->side[0].values, 1, c->initial_gap));
  SurfaceFollow_Private(&c->side[0], 1, c->initial_gap);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->view.adjusted, 1, MPIU_REAL, MPI_MAX, p->comm));
  if (c->spec->ramp) PetscCall(ContactRamp_Private(p, c));
  if (p->spec->kinematics == KINEMATICS_FINITE && (c->spec->adjust || c->spec->interference)) PetscCall(Lengths_Private(p, c));
  c->num_facets = 0;
  PetscCall(Time_Private(p, c, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceSetTime(Interface p, PetscReal t)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    PetscCall(Time_Private(p, &p->contacts[i], t));
    PetscCall(Friction_Private(&p->contacts[i], t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
