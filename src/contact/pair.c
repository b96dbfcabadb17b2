/* The contact pair: life cycle, and the evaluation loop over the edges of the last search. */
#include "rayimpl.h"

PetscErrorCode ContactPairCreate(PetscInt dim, PetscBool axisymmetric, const ContactSpec *spec, ContactPair *pair)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(pair));
  (*pair)->dim             = dim;
  (*pair)->axisymmetric    = axisymmetric;
  (*pair)->node_to_segment = spec->node_to_segment;
  (*pair)->standard        = spec->standard;
  (*pair)->continuous      = spec->continuous;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairDestroy(ContactPair *pair)
{
  ContactPair p = *pair;

  PetscFunctionBegin;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(p->prev, p->next));
  PetscCall(PetscFree(p->listed));
  PetscCall(PetscFree(p->start));
  PetscCall(PetscFree(p->candidate));
  PetscCall(PetscFree(p->normal));
  PetscCall(PetscFree(p->segment));
  PetscCall(PetscFree(p->output));
  PetscCall(PetscFree2(p->first_segment, p->first_node));
  PetscCall(PetscFree(p->node));
  PetscCall(PetscFree(p->ids));
  PetscCall(PetscFree(p->result));
  PetscCall(PetscFree(p->coverage));
  PetscCall(PetscFree(p->slot));
  PetscCall(ContactStateDestroy(p));
  PetscCall(PetscFree(p->real));
  PetscCall(PetscFree(p->work));
  PetscCall(ContactRayWorkDestroy(&p->ray));
  PetscCall(ContactMultiplierDestroy(&p->multiplier));
  PetscCall(PetscFree(*pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairForget(ContactPair pair)
{
  PetscFunctionBegin;
  if (pair->coverage) PetscCall(PetscArrayzero(pair->coverage, pair->num_facets));
  pair->state.stands = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairGetSegments(ContactPair pair, PetscInt *num, const ContactSegment **segments)
{
  PetscFunctionBegin;
  *num      = pair->num_segments;
  *segments = pair->output;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairGetDegenerate(ContactPair pair, PetscInt *num)
{
  PetscFunctionBegin;
  *num = pair->num_degenerate;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairGetNormals(ContactPair pair, const PetscReal **normals)
{
  PetscFunctionBegin;
  *normals = pair->normal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for the results of all edges that have segments: integers, reals, one edge's work space. */
static PetscErrorCode ReserveResults_Private(ContactPair pair, PetscBool derivatives, PetscBool hessian)
{
  PetscInt ids = 0, real = 0, work = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < pair->num_listed; i++) {
    const PetscInt mortar = pair->first_node[i + 1] - pair->first_node[i], n = 2 * (4 + mortar);

    if (mortar == 0) continue;
    ids += 4 + mortar;
    real += 4 + (derivatives ? 4 * n : 0) + (hessian ? n * n : 0);
    work = PetscMax(work, (CONTACT_MOMENTS + 1 + n) * n);
  }
  PetscCall(ContactGrow(ids, sizeof(PetscInt), &pair->size_ids, &pair->ids));
  PetscCall(ContactGrow(real, sizeof(PetscReal), &pair->size_real, &pair->real));
  PetscCall(ContactGrow(work, sizeof(PetscReal), &pair->size_work, &pair->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hand a result its storage and its list of nodes; advances *ids and *real. */
static void PrepareResult_Private(const EvaluateContext *ctx, PetscInt slot, ContactFacet *out, PetscInt **ids, PetscReal **real)
{
  const ContactPair pair = ctx->pair;
  const PetscInt   *edge = &ctx->nonmortar->facets[2 * pair->listed[slot]], mortar = pair->first_node[slot + 1] - pair->first_node[slot];
  const PetscInt    own = 2 + (pair->prev[edge[0]] >= 0) + (pair->next[edge[1]] >= 0), n = 2 * (own + mortar);

  out->facet    = pair->listed[slot];
  out->num_rows = 2;
  out->num      = own + mortar;
  out->nodes    = *ids;
  out->gap      = *real;
  out->weight   = *real + 2;
  *real += 4;
  for (PetscInt i = 0; i < mortar; i++) (*ids)[own + i] = ~pair->node[pair->first_node[slot] + i];
  *ids += own + mortar;
  out->reach = out->spring = out->dgap = out->dweight = out->push = out->hessian = NULL;
  if (ctx->derivatives) {
    out->dgap    = *real;
    out->dweight = *real + 2 * n;
    *real += 4 * n;
  }
  if (ctx->hessian) {
    out->hessian = *real;
    *real += n * n;
  }
}

/* Loop over listed edges; the results of edges without contribution are dropped. *failed on anything that is not a number. */
static PetscErrorCode EvaluateEdges_Private(const EvaluateContext *ctx, PetscBool *failed)
{
  ContactPair pair = ctx->pair;
  PetscInt   *ids  = pair->ids;
  PetscReal  *real = pair->real;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < pair->num_listed; i++) {
    ContactFacet *out = &pair->result[pair->num_results];
    PetscBool     use;

    if (pair->first_node[i + 1] == pair->first_node[i]) continue;
    PrepareResult_Private(ctx, i, out, &ids, &real);
    if (pair->node_to_segment)
      ContactNodeEdge(ctx, i, out, &use);
    else
      ContactMortarEdge(ctx, i, out, &use);
    if (!use) continue;
    if (PetscIsInfOrNanReal(out->gap[0]) || PetscIsInfOrNanReal(out->gap[1])) *failed = PETSC_TRUE;
    pair->num_results++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* False when a known position is infinite or not a number: a mortar node without a place would silently see nothing. */
static PetscBool IsFinite_Private(const ContactSurface *s)
{
  PetscReal sum = 0;

  for (PetscInt n = 0; n < s->num_nodes; n++)
    for (PetscInt i = 0; i < s->dim && ContactHas(s, n); i++) sum += 0 * s->x[s->dim * n + i];
  return sum == 0 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ContactPairHold(ContactPair pair, PetscBool held)
{
  PetscFunctionBegin;
  if (pair->held != held) pair->state.stands = PETSC_FALSE; /* other derivatives */
  pair->held = held;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairHoldLines(ContactPair pair, PetscBool held)
{
  PetscFunctionBegin;
  if (pair->lines_held != held) pair->state.stands = PETSC_FALSE; /* other forces */
  pair->lines_held = held;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Along rays. */
static PetscErrorCode Rays_Private(EvaluateContext *ctx, PetscBool *failed)
{
  ContactPair pair = ctx->pair;

  PetscFunctionBegin;
  ctx->again = (PetscBool)(!*failed && ContactStateStands(pair, ctx->nonmortar, ctx->mortar));
  if (!ctx->again) pair->num_results = pair->num_segments = 0;
  if (!*failed) PetscCall(ContactRayEvaluate(ctx, failed));
  pair->state.stands = PETSC_FALSE;
  if (!*failed) PetscCall(ContactStateKeep(pair, ctx->nonmortar, ctx->mortar, ctx->z));
  if (*failed) pair->num_results = pair->num_segments = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairEvaluate(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[],
                                   const PetscBool wanted[], PetscBool derivatives, PetscBool hessian, PetscInt *num, const ContactFacet **facets,
                                   PetscBool *failed)
{
  const PetscBool derives = (PetscBool)(derivatives || hessian);
  EvaluateContext ctx     = {pair, nonmortar, mortar, z, wanted, derives, (PetscBool)(hessian && (pair->rays || !pair->held)), PETSC_FALSE};

  PetscFunctionBegin;
  PetscCheck(nonmortar->num_nodes == pair->num_nodes && nonmortar->num_facets == pair->num_facets && mortar->num_nodes == pair->num_mortar_nodes &&
                 mortar->num_facets == pair->num_mortar_facets,
             PETSC_COMM_SELF, PETSC_ERR_ORDER, "surfaces differ from those of the last ContactPairSearch: search again after the mesh changes");
  PetscCheck(!hessian || z || pair->num_listed == 0, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "the Hessian of sum_j z_j gt_j needs z");
  *failed = IsFinite_Private(nonmortar) && IsFinite_Private(mortar) ? PETSC_FALSE : PETSC_TRUE;
  *num    = 0;
  *facets = pair->result;
  if (pair->rays) {
    PetscCall(Rays_Private(&ctx, failed));
    *num = pair->num_results;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  pair->num_results = pair->num_segments = 0;
  if (*failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactNormalsBuild(pair, nonmortar, failed));
  if (*failed) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair->node_to_segment)
    PetscCall(ContactNodeHitsBuild(pair, nonmortar, mortar));
  else
    PetscCall(ContactSegmentsBuild(pair, nonmortar, mortar));
  PetscCall(ReserveResults_Private(pair, ctx.derivatives, ctx.hessian));
  PetscCall(EvaluateEdges_Private(&ctx, failed));
  *num = pair->num_results;
  PetscFunctionReturn(PETSC_SUCCESS);
}
