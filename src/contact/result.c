/* Results of facets along rays (facet.c): the nodes that do not hang on which one depends, the vertices it is computed with by these
   nodes, and the storage in which results are handed out. */
#include "contactimpl.h"

static PetscErrorCode StoreDestroy_Private(Store *s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num; i++) PetscCall(PetscFree(s->block[i]));
  PetscCall(PetscFree(s->block));
  PetscCall(PetscFree(s->room));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactStoreReserve(Store *s, PetscInt num, PetscReal **array)
{
  PetscFunctionBegin;
  while (s->at < s->num && s->used + num > s->room[s->at]) s->at++, s->used = 0;
  if (s->at == s->num) {
    PetscInt size = s->size;

    PetscCall(ArrayGrow(s->num + 1, sizeof(PetscReal *), &size, &s->block));
    PetscCall(ArrayGrow(s->num + 1, sizeof(PetscInt), &s->size, &s->room));
    s->room[s->num] = PetscMax(num, s->num ? 2 * s->room[s->num - 1] : 0);
    PetscCall(PetscMalloc1(s->room[s->num], &s->block[s->num]));
    s->num++;
    s->used = 0;
  }
  *array = s->block[s->at] + s->used;
  s->used += num;
  PetscCall(PetscArrayzero(*array, num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactResultDestroy(Result *r)
{
  PetscFunctionBegin;
  PetscCall(StoreDestroy_Private(&r->store));
  PetscCall(FreeAll(4, (void *[]){&r->node, &r->row_first, &r->row_node, &r->row_weight}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactResultNode(Result *r, PetscInt id, PetscInt *place)
{
  PetscFunctionBegin;
  for (*place = 0; *place < r->num_nodes; (*place)++)
    if (r->node[*place] == id) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayGrow(r->num_nodes + 1, sizeof(PetscInt), &r->size_node, &r->node));
  r->node[r->num_nodes++] = id;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactResultMasters(Result *r, const ContactSurface *s, PetscInt node)
{
  const PetscReal *weight;
  const PetscInt  *master, masters = ContactNodeRow(s, &node, &master, &weight);
  PetscInt         place;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < masters; i++) PetscCall(ContactResultNode(r, master[i], &place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactResultRow(Result *r, const ContactSurface *s, PetscInt node, PetscBool mortar, PetscInt v, PetscInt *num)
{
  const PetscInt  *master;
  const PetscReal *weight;
  const PetscInt   masters = ContactNodeRow(s, &node, &master, &weight);

  PetscFunctionBegin;
  PetscCall(ArrayGrow(*num + masters, sizeof(PetscInt), &r->size_row_node, &r->row_node));
  PetscCall(ArrayGrow(*num + masters, sizeof(PetscReal), &r->size_row_weight, &r->row_weight));
  r->row_first[v] = *num;
  for (PetscInt k = 0; k < masters; k++, (*num)++) {
    PetscCall(ContactResultNode(r, mortar ? ~master[k] : master[k], &r->row_node[*num]));
    r->row_weight[*num] = weight[k];
  }
  r->row_first[v + 1] = *num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ContactResultDerivatives(const EvaluateContext *ctx, PetscInt num_rows, const PetscInt node[], PetscBool loaded)
{
  if (!ctx->derivatives || loaded) return ctx->derivatives;
  if (!ctx->hessian && ctx->z) return PETSC_FALSE;
  if (!ctx->wanted) return PETSC_TRUE;
  for (PetscInt j = 0; j < num_rows; j++)
    if (ctx->wanted[node[j]]) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode ContactResultSegment(ContactPair pair, PetscInt facet, PetscInt mortar_facet, PetscInt num, ContactSegment **segment)
{
  PetscFunctionBegin;
  PetscCall(ArrayGrow(pair->num_segments + 1, sizeof(ContactSegment), &pair->size_segments, &pair->output));
  *segment                 = &pair->output[pair->num_segments++];
  (*segment)->facet        = facet;
  (*segment)->mortar_facet = mortar_facet;
  (*segment)->num          = num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the result of a facet lacks at the positions it belongs to. */
static PetscErrorCode Complete_Private(const EvaluateContext *ctx, PetscInt i, ResultFunction evaluate, PetscBool *failed)
{
  ContactFacet *out = &ctx->pair->result[i], more = *out;
  PetscBool     loaded = PETSC_FALSE, use = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt j = 0; j < out->num_rows && ctx->z; j++) loaded = (PetscBool)(loaded || ctx->z[out->nodes[j]] != 0);
  if ((out->dgap || !ContactResultDerivatives(ctx, out->num_rows, out->nodes, loaded)) && (out->hessian || !ctx->hessian || !loaded))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(evaluate(ctx, ctx->pair->slot[i], &more, &use, failed));
  if (use) *out = more;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Again_Private(const EvaluateContext *ctx, ResultFunction evaluate, PetscBool *failed)
{
  ContactPair     pair       = ctx->pair;
  const PetscInt  degenerate = pair->num_degenerate;
  const PetscBool loads      = ContactStateLoads(pair, ctx->z);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < pair->num_results; i++) {
    if (!loads) pair->result[i].hessian = NULL; /* of other multipliers */
    PetscCall(Complete_Private(ctx, i, evaluate, failed));
  }
  pair->num_degenerate = degenerate;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactResultsEvaluate(const EvaluateContext *ctx, Result *r, ResultFunction evaluate, PetscBool *failed)
{
  ContactPair pair = ctx->pair;

  PetscFunctionBegin;
  if (ctx->again) {
    PetscCall(Again_Private(ctx, evaluate, failed));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  pair->num_degenerate = pair->num_ids = 0;
  PetscCall(ArrayGrow(pair->num_listed, sizeof(PetscInt), &pair->size_slot, &pair->slot));
  r->store.at = r->store.used = 0;
  for (PetscInt slot = 0; slot < pair->num_listed; slot++) {
    ContactFacet *out = &pair->result[pair->num_results];
    PetscBool     use = PETSC_FALSE;

    PetscCall(evaluate(ctx, slot, out, &use, failed));
    if (*failed) PetscFunctionReturn(PETSC_SUCCESS);
    if (!use) continue;
    out->facet    = pair->listed[slot];
    out->num_rows = r->num_rows;
    out->num      = r->num_nodes;
    PetscCall(ArrayGrow(pair->num_ids + out->num, sizeof(PetscInt), &pair->size_ids, &pair->ids));
    PetscCall(PetscArraycpy(pair->ids + pair->num_ids, r->node, out->num));
    pair->num_ids += out->num;
    for (PetscInt j = 0; j < out->num_rows; j++)
      if (PetscIsInfOrNanReal(out->gap[j])) *failed = PETSC_TRUE;
    pair->slot[pair->num_results++] = slot;
  }
  pair->num_ids = 0; /* the array is where it stays now */
  for (PetscInt i = 0; i < pair->num_results; i++) {
    pair->result[i].nodes = pair->ids + pair->num_ids;
    pair->num_ids += pair->result[i].num;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
