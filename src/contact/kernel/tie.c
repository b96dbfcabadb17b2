/* Tied surfaces (docs/theory.md, 5): weights of the positions of both sides' nodes in what the multipliers' functions see of the distance between material
   points that face each other, at the positions of the evaluation:

     int psi_j (x_m(eta) - x(xi)) dgamma = sum_a t_ja x_a. */
#include "kernelimpl.h"

/* context: m[(na + num_mortar)][na], by vertices of the facet's result (its lattice, then mortar nodes) and functions N_i of the lattice. */
static PetscErrorCode Point_Private(void *context, RayWork w, PetscInt k, const PetscInt column[], PetscInt num_mortar, const RayPlace *place,
                                    const RayPoint *r, PetscReal area)
{
  PetscReal     *m = context;
  const PetscInt D = w->facet.D, na = w->facet.s.num, nv = w->facet.nv;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < na; i++) {
    const PetscReal phi = area * r->S.N[i];

    for (PetscInt a = 0; a < na; a++) m[a * na + i] -= phi * r->S.N[a];
    for (PetscInt b = 0; b < num_mortar; b++) m[(column[D * (na + nv) + b] / D - nv) * na + i] += phi * r->M.N[b];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactTieFacet(const EvaluateContext *ctx, PetscInt facet, ContactFacet *out)
{
  RayWork        w  = ctx->pair->ray;
  const PetscInt na = w->facet.s.num, nr = w->result.num_rows, num = w->result.num_nodes;
  PetscReal     *m, *tie, *whole;

  PetscFunctionBegin;
  out->tie = NULL;
  if (!ctx->pair->ties) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1((na + w->num_mortar) * na, &m));
  PetscCall(ContactRayWalk(w, ctx->mortar, Point_Private, m));
  PetscCall(ContactStoreReserve(&w->result.store, nr * num, &tie));
  PetscCall(ContactStoreReserve(&w->result.store, nr, &whole));
  for (PetscInt r = 0; r < nr; r++) whole[r] = w->share.part ? ctx->pair->multiplier->measure[ctx->pair->multiplier->row_first[facet] + r] : out->weight[r];
  for (PetscInt v = 0; v < na + w->num_mortar; v++)
    for (PetscInt k = w->result.row_first[v]; k < w->result.row_first[v + 1]; k++)
      for (PetscInt r = 0; r < nr; r++)
        for (PetscInt i = 0; i < na; i++) tie[r * num + w->result.row_node[k]] += w->result.row_weight[k] * w->T[r * na + i] * m[v * na + i];
  PetscCall(PetscFree(m));
  out->tie   = tie;
  out->whole = whole;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairTie(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt *num, const ContactFacet **facets,
                              PetscBool *failed)
{
  PetscFunctionBegin;
  pair->ties         = PETSC_TRUE;
  pair->state.stands = PETSC_FALSE;
  PetscCall(ContactPairEvaluate(pair, nonmortar, mortar, NULL, NULL, PETSC_FALSE, PETSC_FALSE, num, facets, failed));
  pair->ties = pair->state.stands = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
