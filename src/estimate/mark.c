/* Bulk (Dörfler) marking: the fewest leaves that hold a given share of the squared estimate, and those far below the mean. */
#include "estimateimpl.h"

#define TIE 1e-6 /* relative: indicators this close are the same, so that a symmetric problem keeps a symmetric mesh */

typedef struct {
  PetscReal eta2;
  PetscInt  leaf, more; /* more: leaves that splitting it adds, 0 where its order is raised instead */
} Rank;

/* Largest first; ties by leaf. */
static int Compare_Private(const void *a, const void *b)
{
  const Rank *x = a, *y = b;
  if (x->eta2 != y->eta2) return x->eta2 < y->eta2 ? 1 : -1;
  return x->leaf < y->leaf ? -1 : x->leaf > y->leaf;
}

/* The position lo..hi, 1 or more, where the leaf is farthest below the one before it, as a share of that; the first of equal ones; 0: nowhere by more than
   `least`. */
static PetscInt WidestGap_Private(PetscInt num, const Rank rank[], PetscInt lo, PetscInt hi, PetscReal least)
{
  PetscReal widest = least;
  PetscInt  best   = 0;

  for (PetscInt at = PetscMax(lo, 1); at <= hi; ++at) {
    const PetscReal gap = at < num ? 1 - rank[at].eta2 / rank[at - 1].eta2 : 1;
    if (gap <= widest + (best ? TIE : 0)) continue;
    widest = gap;
    best   = at;
  }
  return best;
}

/* How many of the ranked leaves to change: as few as hold the share, and from there down to the widest gap among those alike. When there is no room for all of
   these, to the widest gap above the last for which there is; ties stay together. */
static PetscInt Bulk_Private(PetscInt num, const Rank rank[], PetscReal wanted, PetscReal alike, PetscInt room)
{
  PetscReal sum  = 0;
  PetscInt  want = 0, fit = 0, end, begin;

  while (want < num && sum < wanted && rank[want].eta2 > 0) sum += rank[want++].eta2;
  for (end = want; want && end < num && rank[end].eta2 > 0 && rank[end].eta2 >= (1 - alike) * rank[want - 1].eta2;) ++end;
  while (fit < end && rank[fit].more <= room) room -= rank[fit++].more;
  if (fit == end) return PetscMax(want, WidestGap_Private(num, rank, want, end, 0));
  for (begin = fit; begin > 0 && (1 - alike) * rank[begin - 1].eta2 <= rank[fit].eta2;) --begin;
  return WidestGap_Private(num, rank, begin, fit, TIE);
}

/* Leaves that nothing may be done to (as small as they can be, or strategy p, and at the highest order) rank as if they had no error, and their share is
   nobody's: it stays, *left. */
static PetscReal Rank_Private(const Estimate *e, const int8_t split[], const int8_t raise[], Rank rank[], PetscReal *left)
{
  PetscReal total = 0;

  *left = 0;
  for (PetscInt l = 0; l < e->num_leaves; ++l) {
    const PetscReal eta2 = split[l] || raise[l] ? e->eta2[l] : 0;
    rank[l]              = (Rank){eta2, l, (1 << __builtin_popcount((unsigned)split[l])) - 1};
    total += eta2;
    *left += e->eta2[l] - eta2;
  }
  qsort(rank, (size_t)e->num_leaves, sizeof(*rank), Compare_Private);
  return total;
}

/* Is the error that stays above the tolerance by itself? Then nothing that is done to other leaves meets it: at a singular corner they would be refined without
   end. Strategy p, whose cells are never split, goes on to the highest orders. With a path the parts of eta2 are of different times (norm is 0), and may not be
   added up. share: of the squared estimate, stays. */
static PetscBool IsInVain_Private(const Estimate *e, const AdaptSpec *spec, PetscReal share)
{
  const PetscReal left = share * PetscSqr(e->total);

  if (spec->strategy == ADAPT_P || !(e->norm > 0)) return PETSC_FALSE;
  return (PetscBool)(left > PetscSqr(spec->tolerance) * (PetscSqr(e->norm) + left));
}

/* Rigid bodies: their surface is geometry, not solution, and nothing of their estimate comes from an axis. */
static PetscBool IsRigid_Private(const Estimate *e, PetscInt leaf)
{
  return (PetscBool)(e->along && !(e->along[leaf][0] + e->along[leaf][1] + e->along[leaf][2] > 0));
}

/* Leaves of rigid bodies never coarsen. */
static void Low_Private(const Estimate *e, const AdaptSpec *spec, const ForestTables *t, MarkList *marks, int8_t order[])
{
  PetscReal total = 0;

  for (PetscInt l = 0; l < e->num_leaves; ++l) total += e->eta2[l];
  const PetscReal low = PetscSqr(spec->coarsen) * total / PetscMax(e->num_leaves, 1);
  for (PetscInt l = 0; l < e->num_leaves; ++l) {
    if (marks->split[l] || IsRigid_Private(e, l) || !(e->eta2[l] > 0 && e->eta2[l] < low)) continue;
    if (!order)
      marks->coarsen[l] = 1;
    else if (order[l] == e->order[l])
      EstimateLower_Private(e, spec, t, l, &marks->coarsen[l], &order[l]);
  }
}

PetscErrorCode EstimateMark(const Estimate *e, const AdaptSpec *spec, Forest forest, MarkList *marks, int8_t order[], PetscInt *num_marked)
{
  const ForestTables *t = ForestGetTables(forest);
  Rank               *rank;
  int8_t             *split, *raise;
  PetscReal           left;

  PetscFunctionBegin;
  PetscCheck(e->num_leaves == t->num_leaves, PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "estimate of %" PetscInt_FMT " leaves for a forest of %" PetscInt_FMT,
             e->num_leaves, t->num_leaves);
  PetscCheck(!order == (spec->strategy == ADAPT_H), PETSC_COMM_SELF, PETSC_ERR_ARG_INCOMP, "orders come with the strategies p and hp, and only with them");
  PetscCall(PetscMalloc2(e->num_leaves, &rank, e->num_leaves, &split));
  PetscCall(PetscCalloc1(e->num_leaves, &raise));
  PetscCall(EstimateSplits_Private(e, spec, forest, split));
  if (order) EstimateChoices_Private(e, spec, split, raise);
  PetscCall(PetscCalloc1(e->num_leaves, &marks->split));
  PetscCall(PetscCalloc1(e->num_leaves, &marks->coarsen));
  if (order) PetscCall(PetscArraycpy(order, e->order, e->num_leaves));
  const PetscReal total = Rank_Private(e, split, raise, rank, &left), share = total + left > 0 ? left / (total + left) : 0;
  const PetscInt  room = PetscMax(0, spec->max_cells - e->num_leaves);
  *num_marked =
      IsInVain_Private(e, spec, share) ? 0 : Bulk_Private(e->num_leaves, rank, spec->fraction * total * (1 - 1e-12), PetscMax(TIE, spec->alike), room);
  for (PetscInt i = 0; i < *num_marked; ++i) {
    marks->split[rank[i].leaf] = split[rank[i].leaf];
    if (order) order[rank[i].leaf] += raise[rank[i].leaf];
  }
  Low_Private(e, spec, t, marks, order);
  if (order) PetscCall(EstimateEven_Private(e, forest, order));
  PetscCall(PetscFree(raise));
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
