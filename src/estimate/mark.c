/* Bulk (Dörfler) marking: the fewest leaves that hold a given share of the squared estimate, and those far below the mean. */
#include "estimateimpl.h"

#define TIE 1e-6 /* relative: indicators this close are the same, so that a symmetric problem keeps a symmetric mesh */

typedef struct {
  PetscReal eta2;
  PetscInt  leaf, more; /* more: leaves that splitting it adds */
} Rank;

/* Largest first; ties by leaf. */
static int Compare_Private(const void *a, const void *b)
{
  const Rank *x = a, *y = b;
  if (x->eta2 != y->eta2) return x->eta2 < y->eta2 ? 1 : -1;
  return x->leaf < y->leaf ? -1 : x->leaf > y->leaf;
}

/* First position after `at` whose indicator is smaller than that of `at` by more than a tie. */
static PetscInt TieEnd_Private(PetscInt num, const Rank rank[], PetscInt at)
{
  PetscInt end = at + 1;
  while (end < num && rank[end].eta2 >= (1 - TIE) * rank[at].eta2) ++end;
  return end;
}

/* How many of the ranked leaves to split: whole groups of ties until the share is reached, none that would exceed `room`. */
static PetscInt Bulk_Private(PetscInt num, const Rank rank[], PetscReal wanted, PetscInt room)
{
  PetscReal sum   = 0;
  PetscInt  taken = 0;

  while (taken < num && sum < wanted && rank[taken].eta2 > 0) {
    const PetscInt end = TieEnd_Private(num, rank, taken);
    for (PetscInt i = taken; i < end; ++i) room -= rank[i].more;
    if (room < 0) break;
    for (; taken < end; ++taken) sum += rank[taken].eta2;
  }
  return taken;
}

/* Leaves with eta2 exactly 0 (rigid bodies) never coarsen: their surface is geometry, not solution. */
PetscErrorCode EstimateMark(const Estimate *e, const AdaptSpec *spec, Forest forest, MarkList *marks, PetscInt *num_marked)
{
  const ForestTables *t;
  Rank               *rank;
  PetscReal           total = 0;
  int8_t             *split;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(forest, &t));
  PetscCheck(e->num_leaves == t->num_leaves, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "estimate of %" PetscInt_FMT " leaves for a forest of %" PetscInt_FMT,
             e->num_leaves, t->num_leaves);
  PetscCall(PetscMalloc2(e->num_leaves, &rank, e->num_leaves, &split));
  PetscCall(EstimateSplits_Private(e, spec, forest, split));
  PetscCall(PetscCalloc1(e->num_leaves, &marks->split));
  PetscCall(PetscCalloc1(e->num_leaves, &marks->coarsen));
  for (PetscInt l = 0; l < e->num_leaves; ++l) {
    rank[l] = (Rank){e->eta2[l], l, (1 << __builtin_popcount((unsigned)split[l])) - 1};
    total += e->eta2[l];
  }
  qsort(rank, (size_t)e->num_leaves, sizeof(*rank), Compare_Private);
  *num_marked = Bulk_Private(e->num_leaves, rank, spec->fraction * total * (1 - 1e-12), PetscMax(0, spec->max_cells - e->num_leaves));
  for (PetscInt i = 0; i < *num_marked; ++i) marks->split[rank[i].leaf] = split[rank[i].leaf];
  const PetscReal low = PetscSqr(spec->coarsen) * total / PetscMax(e->num_leaves, 1);
  for (PetscInt l = 0; l < e->num_leaves; ++l) marks->coarsen[l] = !marks->split[l] && e->eta2[l] > 0 && e->eta2[l] < low;
  PetscCall(PetscFree2(rank, split));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MarkListDestroy(MarkList *marks)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(marks->split));
  PetscCall(PetscFree(marks->coarsen));
  PetscFunctionReturn(PETSC_SUCCESS);
}
