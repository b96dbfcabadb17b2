/* Results of facets in the general form (facet.c, rayfacet.c): the nodes that do not hang on which one depends, the vertices it is computed with by these
   nodes, and the storage in which results are handed out. */
#include "facetimpl.h"

PetscErrorCode ContactResultDestroy(Result *r)
{
  PetscFunctionBegin;
  PetscCall(ContactStoreDestroy(&r->store));
  PetscCall(PetscFree(r->node));
  PetscCall(PetscFree(r->row_first));
  PetscCall(PetscFree(r->row_node));
  PetscCall(PetscFree(r->row_weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactResultNode(Result *r, PetscInt id, PetscInt *place)
{
  PetscFunctionBegin;
  for (*place = 0; *place < r->num_nodes; (*place)++)
    if (r->node[*place] == id) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactGrow(r->num_nodes + 1, sizeof(PetscInt), &r->size_node, &r->node));
  r->node[r->num_nodes++] = id;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ContactMasters(const ContactSurface *s, const PetscInt *node, const PetscInt **master, const PetscReal **weight)
{
  static const PetscReal one = 1;

  if (!s->hang || s->hang[*node] == s->hang[*node + 1]) {
    *master = node, *weight = &one;
    return 1;
  }
  *master = s->hang_master + s->hang[*node], *weight = s->hang_weight + s->hang[*node];
  return s->hang[*node + 1] - s->hang[*node];
}

PetscErrorCode ContactResultRow(Result *r, const ContactSurface *s, PetscInt node, PetscBool mortar, PetscInt v, PetscInt *num)
{
  const PetscInt  *master;
  const PetscReal *weight;
  const PetscInt   masters = ContactMasters(s, &node, &master, &weight);

  PetscFunctionBegin;
  PetscCall(ContactGrow(*num + masters, sizeof(PetscInt), &r->size_row_node, &r->row_node));
  PetscCall(ContactGrow(*num + masters, sizeof(PetscReal), &r->size_row_weight, &r->row_weight));
  r->row_first[v] = *num;
  for (PetscInt k = 0; k < masters; k++, (*num)++) {
    PetscCall(ContactResultNode(r, mortar ? ~master[k] : master[k], &r->row_node[*num]));
    r->row_weight[*num] = weight[k];
  }
  r->row_first[v + 1] = *num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ContactResultDerivatives(const EvaluateContext *ctx, const Result *r, PetscBool loaded)
{
  if (!ctx->derivatives || loaded) return ctx->derivatives;
  if (!ctx->hessian && ctx->z) return PETSC_FALSE;
  if (!ctx->wanted) return PETSC_TRUE;
  for (PetscInt j = 0; j < r->num_rows; j++)
    if (ctx->wanted[r->node[j]]) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode ContactResultSegment(ContactPair pair, PetscInt facet, PetscInt mortar_facet, PetscInt num, ContactSegment **segment)
{
  PetscFunctionBegin;
  PetscCall(ContactGrow(pair->num_segments + 1, sizeof(ContactSegment), &pair->size_segments, &pair->output));
  *segment                 = &pair->output[pair->num_segments++];
  (*segment)->facet        = facet;
  (*segment)->mortar_facet = mortar_facet;
  (*segment)->num          = num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactResultsEvaluate(const EvaluateContext *ctx, Result *r, ResultFunction evaluate, PetscBool *failed)
{
  ContactPair pair = ctx->pair;

  PetscFunctionBegin;
  pair->num_degenerate = pair->num_ids = 0;
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
    PetscCall(ContactGrow(pair->num_ids + out->num, sizeof(PetscInt), &pair->size_ids, &pair->ids));
    PetscCall(PetscArraycpy(pair->ids + pair->num_ids, r->node, out->num));
    pair->num_ids += out->num;
    for (PetscInt j = 0; j < out->num_rows; j++)
      if (PetscIsInfOrNanReal(out->gap[j])) *failed = PETSC_TRUE;
    pair->num_results++;
  }
  pair->num_ids = 0; /* the array is where it stays now */
  for (PetscInt i = 0; i < pair->num_results; i++) {
    pair->result[i].nodes = pair->ids + pair->num_ids;
    pair->num_ids += pair->result[i].num;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
