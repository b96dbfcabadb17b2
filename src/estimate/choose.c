/* What to do with a marked cell: split it, or raise its order? And with one far below its share?

   Where the solution is analytic the amplitudes of its Legendre coefficients fall like exp(-s k) with the degree k (decay.c), at a rate s that grows with the
   distance of the next singularity in units of the cell: a higher order pays. Near a singularity they fall like a power k^-m. Seen through the degrees 2..p
   that looks like a rate of about m (ln p - ln 2)/(p - 2), which falls with p: from 1.4 (p = 3) over 1.1 (4) to 0.7 (8) in the cells at the corner of the
   L-shape (m = 3), where their neighbours show 2.1 to 1.9 and cells further away more. So the rate that tells one from the other falls with p as well. */
#include "estimateimpl.h"

#define MOST_DIFFERENCE 1 /* of orders across a face */
#define UNTOLD 2          /* up to this order too few coefficients are known, and the order is raised: that is what makes them known */

static PetscReal Threshold_Private(PetscInt order)
{
  return 1 + 1 / (PetscReal)order;
}

static PetscBool Smooth_Private(const Estimate *e, PetscInt leaf)
{
  return (PetscBool)(e->order[leaf] > UNTOLD && e->decay[leaf] > Threshold_Private(e->order[leaf]));
}

static PetscBool Pays_Private(const Estimate *e, PetscInt leaf)
{
  if (e->irregular[leaf] & (ESTIMATE_IRREGULAR_FACE | ESTIMATE_IRREGULAR_RIM)) return PETSC_FALSE;
  if (e->order[leaf] > UNTOLD) return Smooth_Private(e, leaf);
  return (PetscBool) !(e->irregular[leaf] & ESTIMATE_IRREGULAR_CORNER);
}

void EstimateChoices_Private(const Estimate *e, const AdaptSpec *spec, int8_t split[], int8_t raise[])
{
  for (PetscInt l = 0; l < e->num_leaves; ++l) {
    const PetscBool wanted = spec->strategy == ADAPT_P || !split[l] ? (PetscBool) !(e->irregular[l] & ESTIMATE_IRREGULAR_FACE) : Pays_Private(e, l);
    raise[l]               = (int8_t)(wanted && e->order[l] < spec->max_order);
    if (raise[l] || spec->strategy == ADAPT_P) split[l] = 0;
  }
}

/* A face of lower order than its cells wastes some of their functions. Cells with a contact face of order 1 stay as they are: their geometry is that of the
   face, which high polynomials would not follow. */
PetscErrorCode EstimateEven_Private(const Estimate *e, Forest forest, int8_t order[])
{
  int8_t *fixed;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(e->num_leaves, &fixed));
  for (PetscInt l = 0; l < e->num_leaves; ++l) fixed[l] = e->irregular[l] & ESTIMATE_IRREGULAR_FACE;
  PetscCall(HPOrdersLimit(forest, MOST_DIFFERENCE, fixed, order));
  PetscCall(PetscFree(fixed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Smooth cells rather grow, others rather lose the order that gains them nothing. */
void EstimateLower_Private(const Estimate *e, const AdaptSpec *spec, const ForestTables *t, PetscInt leaf, int8_t *coarsen, int8_t *order)
{
  const int8_t   *level    = t->leaf_level + 3 * leaf;
  const PetscBool is_split = (PetscBool)(level[0] || level[1] || level[2]);

  *coarsen = (int8_t)(spec->strategy == ADAPT_HP && is_split && Smooth_Private(e, leaf));
  if (!*coarsen && *order > e->lowest[leaf]) --*order;
}
