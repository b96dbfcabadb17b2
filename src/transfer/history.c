/* Histories at integration points, from the old points to the new: polynomials through the old points of the leaf in which a new one lies, of quantities whose
   every value is admissible. Components 0-5 are a symmetric positive tensor of determinant 1 (Cp^-1): its logarithm is a traceless tensor, and the
   exponential of any such has determinant 1. Component 6 (alpha) must not fall below 0. Whether the stress is within the yield surface is a matter of the
   displacement, too: StateAdmit sees to it. */
#include "transferimpl.h"
#include <petscblaslapack.h>

#define H 7
#define OVERSHOOT 0.5 /* new points lie a little beyond the old ones: how far, in units of the old values' range, alpha may follow */

/* out = f(in) of a symmetric tensor (xx xy xz yy yz zz) on its eigenvalues. */
static PetscErrorCode Function_Private(const PetscReal in[6], PetscReal (*f)(PetscReal), PetscReal out[6])
{
  static const PetscInt row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  const PetscBLASInt    n = 3, lwork = 32;
  PetscReal             Q[9], w[3], work[32];
  PetscBLASInt          info;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 6; ++k) Q[3 * row[k] + column[k]] = Q[3 * column[k] + row[k]] = in[k];
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, Q, &n, w, work, &lwork, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "eigenvectors of a symmetric tensor: LAPACK says %d", (int)info);
  for (PetscInt k = 0; k < 6; ++k) {
    out[k] = 0;
    for (PetscInt e = 0; e < 3; ++e) out[k] += f(w[e]) * Q[3 * e + row[k]] * Q[3 * e + column[k]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Log_Private(PetscReal x)
{
  return PetscLogReal(x);
}

static PetscReal Exp_Private(PetscReal x)
{
  return PetscExpReal(x);
}

/* Old points of one leaf: logarithms and alpha. */
typedef struct {
  PetscInt       leaf, num; /* leaf -1: none yet */
  const Basis1D *basis;
  PetscReal     *value; /* owned [num][H] */
  PetscReal      lo, hi;
} OldPoints;

/* Where the history of an old leaf of this order starts. */
static const PetscReal *OldHistory_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, PetscInt order)
{
  return old->values + old->offset[leaf] + TransferNumNodal_Private(c->old_t->dim, order) + TransferNumPressure_Private(c, c->old_t->leaf_body[leaf], order);
}

static PetscErrorCode Load_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, OldPoints *p)
{
  const PetscInt dim = c->old_t->dim;
  PetscInt       order;

  PetscFunctionBegin;
  if (p->leaf == leaf) PetscFunctionReturn(PETSC_SUCCESS);
  p->leaf = leaf;
  PetscCall(HPSpaceGetOrder(c->old_space, c->old_t->first[dim] + leaf, &order));
  PetscCall(MechanicsPointRule(order, &p->basis));
  p->num                = ElementNumNodes(dim, p->basis->num_points - 1);
  const PetscReal *from = OldHistory_Private(c, old, leaf, order);
  PetscCall(PetscFree(p->value));
  PetscCall(PetscMalloc1(p->num * H, &p->value));
  p->lo = p->hi = from[6];
  for (PetscInt q = 0; q < p->num; ++q, from += H) {
    PetscCall(Function_Private(from, Log_Private, p->value + q * H));
    p->value[q * H + 6] = from[6];
    p->lo               = PetscMin(p->lo, from[6]);
    p->hi               = PetscMax(p->hi, from[6]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* History at xi of the old leaf. */
static PetscErrorCode Point_Private(PetscInt dim, const OldPoints *p, const PetscReal xi[], PetscReal history[])
{
  const PetscReal slack = OVERSHOOT * (p->hi - p->lo);
  PetscReal       sum[H];

  PetscFunctionBegin;
  Basis1DInterpolate(p->basis, dim, xi, H, p->value, sum);
  const PetscReal trace = (sum[0] + sum[3] + sum[5]) / 3; /* round-off */
  sum[0] -= trace;
  sum[3] -= trace;
  sum[5] -= trace;
  PetscCall(Function_Private(sum, Exp_Private, history));
  history[6] = PetscMax(0, PetscMin(PetscMax(sum[6], p->lo - slack), p->hi + slack));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Cell_Private(const TransferContext *c, const OldCells *old, PetscInt cell, OldPoints *p, PetscReal history[])
{
  const PetscInt dim = c->new_t->dim, leaf = c->new_v->cell_leaf[cell], first = c->map->old_first[leaf], end = first + c->map->old_count[leaf];
  const Basis1D *basis;

  PetscFunctionBegin;
  PetscCall(MechanicsPointRule(c->new_v->cell_order[cell], &basis));
  for (PetscInt q = 0; q < ElementNumNodes(dim, basis->num_points - 1); ++q) {
    PetscReal place[3], xi[3];
    PetscInt  k = first;
    Basis1DPoint(basis, dim, q, place);
    while (k < end && !TransferPlace_Private(c, leaf, place, k, xi)) ++k;
    PetscCheck(k < end, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the old leaves of leaf %" PetscInt_FMT " do not cover it", leaf);
    PetscCall(Load_Private(c, old, k, p));
    PetscCall(Point_Private(dim, p, xi, history + q * H));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the new leaf the old one? */
static PetscBool SameLeaf_Private(const TransferContext *c, PetscInt new_leaf, PetscInt old_leaf)
{
  for (PetscInt d = 0; d < c->new_t->dim; ++d) {
    if (c->new_t->leaf_level[3 * new_leaf + d] != c->old_t->leaf_level[3 * old_leaf + d]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscErrorCode TransferHistory_Private(const TransferContext *c, const OldCells *old, PetscReal history[])
{
  OldPoints p = {.leaf = -1};

  PetscFunctionBegin;
  for (PetscInt cell = 0; cell < c->new_v->num_owned_cells; ++cell) {
    const PetscInt leaf = c->new_v->cell_leaf[cell], k = c->map->old_first[leaf];
    PetscInt       first, num, order;
    PetscCall(MechanicsHistoryRange(c->new_mechanics, cell, &first, &num));
    if (!num) continue;
    PetscCheck(c->spec->bodies[c->new_t->leaf_body[leaf]].material->law->num_history == H, PETSC_COMM_SELF, PETSC_ERR_SUP, "no transfer for this history");
    PetscCall(HPSpaceGetOrder(c->old_space, c->old_t->first[c->old_t->dim] + k, &order));
    if (c->map->old_count[leaf] == 1 && order == c->new_v->cell_order[cell] && SameLeaf_Private(c, leaf, k)) /* bit by bit */
      PetscCall(PetscArraycpy(history + first, OldHistory_Private(c, old, k, order), num));
    else
      PetscCall(Cell_Private(c, old, cell, &p, history + first));
  }
  PetscCall(PetscFree(p.value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
