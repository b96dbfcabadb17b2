/* The contact pair: life cycle, what callers ask of it, evaluations. */
#include "kernelimpl.h"

PetscErrorCode ContactPairCreate(PetscInt dim, PetscBool axisymmetric, const ContactSpec *spec, ContactPair *pair)
{
  PetscFunctionBegin;
  PetscCall(ContactRayLatticePrepare());
  PetscCall(PetscNew(pair));
  (*pair)->dim             = dim;
  (*pair)->axisymmetric    = axisymmetric;
  (*pair)->node_to_segment = spec->node_to_segment;
  (*pair)->self            = spec->self;
  (*pair)->friction        = (PetscBool)(spec->law == CONTACT_COULOMB);
  (*pair)->standard        = (PetscBool)(spec->standard || spec->node_to_segment);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairDestroy(ContactPair *pair)
{
  ContactPair p = *pair;

  PetscFunctionBegin;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeAll(15, (void *[]){&p->listed, &p->start, &p->candidate, &p->base.start, &p->base.found, &p->last.start, &p->last.found, &p->normal, &p->output,
                                   &p->ids, &p->result, &p->slot, &p->state.x[0], &p->state.x[1], &p->state.z}));
  PetscCall(ContactSlipDestroy(&p->slip));
  PetscCall(ContactRayWorkDestroy(&p->ray));
  PetscCall(ContactMultiplierDestroy(&p->multiplier));
  PetscCall(PetscFree(*pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairGetSegments(ContactPair pair, PetscInt *num, const ContactSegment **segments)
{
  *num      = pair->num_segments;
  *segments = pair->output;
}

PetscInt ContactPairGetDegenerate(ContactPair pair)
{
  return pair->num_degenerate;
}

const PetscReal *ContactPairGetNormals(ContactPair pair)
{
  return pair->normal;
}

/* False when a known position is infinite or not a number: a mortar node without a place would silently see nothing. */
static PetscBool IsFinite_Private(const ContactSurface *s)
{
  PetscReal sum = 0;

  for (PetscInt n = 0; n < s->num_nodes; n++)
    for (PetscInt i = 0; i < s->dim && ContactHas(s, n); i++) sum += 0 * s->x[s->dim * n + i];
  return sum == 0 ? PETSC_TRUE : PETSC_FALSE;
}

void ContactPairFreezeNormals(ContactPair pair, PetscBool frozen)
{
  if (pair->held != frozen) pair->state.stands = PETSC_FALSE; /* other derivatives */
  pair->held = frozen;
}

void ContactPairFreezeSegmentation(ContactPair pair, PetscBool frozen)
{
  if (pair->frozen_segmentation != frozen) pair->state.stands = PETSC_FALSE; /* other forces */
  pair->frozen_segmentation = frozen;
}

void ContactPairSetPrecedence(ContactPair pair, const PetscInt precedence[])
{
  pair->precedence   = precedence;
  pair->state.stands = PETSC_FALSE;
}

void ContactPairSetMet(ContactPair pair, const PetscBool met[])
{
  pair->met          = met;
  pair->state.stands = PETSC_FALSE;
}

PetscErrorCode ContactPairEvaluate(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[],
                                   const PetscBool wanted[], PetscBool derivatives, PetscBool hessian, PetscInt *num, const ContactFacet **facets,
                                   PetscBool *failed)
{
  const PetscBool derives = (PetscBool)(derivatives || hessian);
  EvaluateContext ctx     = {pair, nonmortar, mortar, z, wanted, derives, hessian, PETSC_FALSE};

  PetscFunctionBegin;
  PetscCheck(nonmortar->num_nodes == pair->num_nodes && nonmortar->num_facets == pair->num_facets && mortar->num_nodes == pair->num_mortar_nodes &&
                 mortar->num_facets == pair->num_mortar_facets,
             PETSC_COMM_SELF, PETSC_ERR_ORDER, "surfaces differ from those of the last ContactPairSearch: search again after the mesh changes");
  PetscCheck(!hessian || z || pair->num_listed == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "the Hessian of sum_j z_j gt_j needs z");
  *failed   = IsFinite_Private(nonmortar) && IsFinite_Private(mortar) ? PETSC_FALSE : PETSC_TRUE;
  ctx.again = (PetscBool)(!*failed && ContactStateStands(pair, nonmortar, mortar));
  if (!ctx.again) pair->num_results = pair->num_segments = 0;
  if (!ctx.again) ContactSlipForget(pair);
  if (!*failed) PetscCall(ContactRayEvaluate(&ctx, failed));
  pair->state.stands = PETSC_FALSE;
  if (!*failed) PetscCall(ContactStateKeep(pair, nonmortar, mortar, z));
  if (*failed) pair->num_results = pair->num_segments = 0;
  *num    = pair->num_results;
  *facets = pair->result;
  PetscFunctionReturn(PETSC_SUCCESS);
}
