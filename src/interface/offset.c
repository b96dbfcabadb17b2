/* What changes with time. What counts as no gap: gt_j less a constant, so that forces and derivatives stay as they are. Initial gaps are those of this mesh at
   the reference positions; an interference is the change of all gaps by as much along their directions there. Both may change with time: constants of another
   size at each load. */
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

/* To the offsets at time t. */
static PetscErrorCode Time_Private(Contact *c, PetscReal t)
{
  const PetscReal open = Open_Private(c->spec, t);
  PetscReal       interference;

  PetscFunctionBegin;
  PetscCall(Value_Private(c->spec, t, &interference));
  for (PetscInt i = 0; i < c->side[0].num_own; ++i) {
    const PetscInt j = c->side[0].own[i];
    c->offset[j] += (interference - c->interference) * c->reach[j];
    if (c->spec->ramp) c->offset[j] += (open - c->open) * c->initial[j];
  }
  c->interference = c->view.interference = interference;
  c->open = c->view.open = open;
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

PetscErrorCode ContactOffset_Private(Interface p, Contact *c)
{
  const Surface      *s       = &c->side[0];
  ContactSurface      side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};
  const ContactFacet *facets;
  PetscBool           failed;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(c->offset, s->num_nodes));
  if (!c->spec->adjust && !c->spec->ramp && !c->spec->interference) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactSearch_Private(p, c, PETSC_TRUE, 0));
  PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], NULL, NULL, PETSC_FALSE, PETSC_FALSE, &c->num_facets, &facets, &failed));
  c->facets = facets;
  PetscCall(ContactNodeSums_Private(p, c));
  Reach_Private(c);
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    c->initial[j]    = c->spec->adjust ? c->gap[j] : PetscMin(c->gap[j], 0);
    if (c->spec->adjust) c->offset[j] += c->initial[j];
    if (c->spec->adjust && ContactCovered_Private(c, j)) c->view.adjusted = PetscMax(c->view.adjusted, PetscAbsReal(c->gap[j] / c->weight[j]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->view.adjusted, 1, MPIU_REAL, MPI_MAX, p->comm));
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
