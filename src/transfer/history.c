/* Histories at integration points, from the old points to the new: polynomials through the old points of the leaf in which a new one lies, of quantities whose
   every value is admissible. Components 0-5 are a symmetric positive tensor G of determinant 1 (Cp^-1): the logarithm of such a tensor is traceless, and the
   exponential of any traceless one has determinant 1. What is interpolated is not G, as large as the flow was, but the elastic strain be = Fbar G Fbar^T that
   goes with the displacement, as small as stress is against the modulus: what a polynomial misses of G would be a stress, often beyond the yield surface, of
   its own. Component 6 (alpha) must not fall below 0. What is still beyond the yield surface StateAdmit sees to.

   Component 7 is the settled volume. Mixed cells see means of g(J), and what coarse ones did not see of it grew as they flowed, to many times the strain at
   which they yield. Finer cells would see some of it at once, as pressures that nothing had built up, and flow that has to undo it. So what the old cell did
   not see, g(J) - pi/modulus with its pressure pi, is settled in the share that flow has in the strain, 1 - MaterialSecant: all of it after much flow, where
   the new cell then has the old one's pressure, and nothing where material is elastic, whose state depends on no mesh before. */
#include "transferimpl.h"
#include <petscblaslapack.h>

#define H 8
#define VALUES 13 /* at an old point: logarithms of be and of G, alpha */
#define MOST_NODES ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1))
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

/* Fbar = J^(-1/3) F of the old leaf at xi; PETSC_FALSE: it is inverted there. */
static PetscErrorCode Deformation_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, const PetscReal xi[], PetscReal work[], PetscReal F[9],
                                          PetscReal *J, PetscBool *valid)
{
  const PetscInt dim = c->old_t->dim;
  PetscReal      dX[9], size;
  OldPoint       p;

  PetscFunctionBegin;
  PetscCall(TransferOldPoint_Private(c, old, leaf, xi, work, &p));
  for (PetscInt a = 0; a < 3; ++a) /* rows of F are those of dx/dxi times (dX/dxi)^-1: the transpose's solutions */
    for (PetscInt b = 0; b < 3; ++b) dX[3 * a + b] = p.dX[b][a];
  *valid = (PetscBool)(Det3(dX) > 0);
  for (PetscInt a = 0; a < 3 && *valid; ++a) {
    const PetscReal dx[3] = {p.dX[a][0] + p.du[a][0], p.dX[a][1] + p.du[a][1], p.dX[a][2] + p.du[a][2]};
    (void)Solve3(dX, dx, F + 3 * a);
  }
  if (dim == 2 && c->spec->model == MODEL_AXISYMMETRIC) F[8] = 1 + p.u[0] / p.X[0];
  size   = *valid ? Det3(F) : 0;
  *J     = size;
  *valid = (PetscBool)(size > 0);
  for (PetscInt k = 0; k < 9 && *valid; ++k) F[k] /= PetscCbrtReal(size);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* out = A in A^T of symmetric tensors. */
static void Congruent_Private(const PetscReal A[9], const PetscReal in[6], PetscReal out[6])
{
  static const int8_t at[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  PetscReal           B[9];

  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J) B[3 * i + J] = A[3 * i] * in[at[J]] + A[3 * i + 1] * in[at[3 + J]] + A[3 * i + 2] * in[at[6 + J]];
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) out[at[3 * i + j]] = Dot3(B + 3 * i, A + 3 * j);
}

/* Inverse of a matrix of determinant 1. */
static void Inverse_Private(const PetscReal A[9], PetscReal inverse[9])
{
  PetscReal c[3];

  for (int i = 0; i < 3; ++i) {
    Cross3(A + 3 * ((i + 1) % 3), A + 3 * ((i + 2) % 3), c);
    for (int k = 0; k < 3; ++k) inverse[3 * k + i] = c[k];
  }
}

/* Old points of one leaf: logarithms of be and of G, and alpha. */
typedef struct {
  PetscInt       leaf, num; /* leaf -1: none yet */
  const Basis1D *basis;
  PetscReal     *value; /* owned [num][VALUES] */
  PetscReal      lo, hi;
  PetscBool      valid; /* is the leaf's deformation, at all its points? */
  PetscReal      work[4 * MOST_NODES];
} OldPoints;

/* Where the history of an old leaf of this order starts. */
static const PetscReal *OldHistory_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, PetscInt order)
{
  return old->values + old->offset[leaf] + TransferNumNodal_Private(c->old_t->dim, order) + TransferNumPressure_Private(c, c->old_t->leaf_body[leaf], order);
}

static PetscErrorCode Load_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, OldPoints *p)
{
  const PetscInt dim = c->old_t->dim;

  PetscFunctionBegin;
  if (p->leaf == leaf) PetscFunctionReturn(PETSC_SUCCESS);
  p->leaf              = leaf;
  const PetscInt order = HPSpaceGetOrder(c->old_space, c->old_t->first[dim] + leaf);
  PetscCall(MechanicsPointRule(order, &p->basis));
  p->num                = ElementNumNodes(dim, p->basis->num_points - 1);
  const PetscReal *from = OldHistory_Private(c, old, leaf, order);
  PetscCall(PetscFree(p->value));
  PetscCall(PetscMalloc1(p->num * VALUES, &p->value));
  p->lo = p->hi = from[6];
  p->valid      = PETSC_TRUE;
  for (PetscInt q = 0; q < p->num; ++q, from += H) {
    PetscReal *value = p->value + q * VALUES, xi[3], F[9], be[6], J;
    PetscBool  valid;

    (void)Basis1DPoint(p->basis, dim, q, xi);
    PetscCall(Deformation_Private(c, old, leaf, xi, p->work, F, &J, &valid));
    p->valid = (PetscBool)(p->valid && valid);
    if (valid) Congruent_Private(F, from, be);
    PetscCall(Function_Private(valid ? be : from, Log_Private, value));
    PetscCall(Function_Private(from, Log_Private, value + 6));
    value[12] = from[6];
    p->lo     = PetscMin(p->lo, from[6]);
    p->hi     = PetscMax(p->hi, from[6]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* exp of its traceless part; what there is else is round-off. */
static PetscErrorCode Exponential_Private(PetscReal log[6], PetscReal out[6])
{
  const PetscReal trace = (log[0] + log[3] + log[5]) / 3;

  PetscFunctionBegin;
  log[0] -= trace;
  log[3] -= trace;
  log[5] -= trace;
  PetscCall(Function_Private(log, Exp_Private, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* history[7] at xi of the old leaf, where history[0..6] is known. */
static PetscErrorCode Settle_Private(const TransferContext *c, const OldCells *old, PetscInt leaf, const PetscReal xi[], PetscReal J, PetscReal history[])
{
  const PetscInt      dim = c->old_t->dim, order = HPSpaceGetOrder(c->old_space, c->old_t->first[dim] + leaf);
  const MaterialSpec *m = c->spec->bodies[c->old_t->leaf_body[leaf]].material;
  PetscReal           pressure, g[3], strain, work;

  PetscFunctionBegin;
  if (!m->mixed || !m->law->settled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MechanicsPressureEvaluate(dim, order, 1, xi, old->values + old->offset[leaf] + TransferNumNodal_Private(dim, order), &pressure));
  MaterialVolumetric(m, J, g);
  m->law->plastic(m, history, &strain, &work);
  history[7] = (1 - MaterialSecant(m, strain, work)) * (g[0] - pressure / MaterialVolumetricModulus(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* History at xi of the old leaf; where its deformation is inverted, from the logarithms of G. */
static PetscErrorCode Point_Private(const TransferContext *c, const OldCells *old, OldPoints *p, const PetscReal xi[], PetscReal history[])
{
  const PetscReal slack = OVERSHOOT * (p->hi - p->lo);
  PetscReal       sum[VALUES], F[9], inverse[9], be[6], J;
  PetscBool       valid = p->valid;

  PetscFunctionBegin;
  Basis1DInterpolate(p->basis, c->old_t->dim, xi, VALUES, p->value, sum);
  if (valid) PetscCall(Deformation_Private(c, old, p->leaf, xi, p->work, F, &J, &valid));
  PetscCall(Exponential_Private(valid ? sum : sum + 6, be));
  if (valid) {
    Inverse_Private(F, inverse);
    Congruent_Private(inverse, be, history);
  } else
    PetscCall(PetscArraycpy(history, be, 6));
  history[6] = PetscMax(0, PetscMin(PetscMax(sum[12], p->lo - slack), p->hi + slack));
  history[7] = 0;
  if (valid) PetscCall(Settle_Private(c, old, p->leaf, xi, J, history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The naive ways (adapt.history): what the nearest point of the old leaf remembers. */
static PetscErrorCode Nearest_Private(const TransferContext *c, const OldCells *old, const OldPoints *p, const PetscReal xi[], PetscReal history[])
{
  PetscReal least = PETSC_MAX_REAL;
  PetscInt  order, nearest = 0;

  PetscFunctionBegin;
  for (PetscInt q = 0; q < p->num; ++q) {
    PetscReal at[3], distance = 0;
    Basis1DPoint(p->basis, c->old_t->dim, q, at);
    for (PetscInt k = 0; k < c->old_t->dim; ++k) distance += PetscSqr(at[k] - xi[k]);
    if (distance >= least) continue;
    least   = distance;
    nearest = q;
  }
  order = HPSpaceGetOrder(c->old_space, c->old_t->first[c->old_t->dim] + p->leaf);
  PetscCall(PetscArraycpy(history, OldHistory_Private(c, old, p->leaf, order) + nearest * H, H));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Cell_Private(const TransferContext *c, const OldCells *old, PetscInt cell, OldPoints *p, PetscReal history[])
{
  const PetscInt      dim = c->new_t->dim, leaf = c->new_v->cell_leaf[cell], first = c->map->old_first[leaf], end = first + c->map->old_count[leaf];
  const Basis1D      *basis;
  const MaterialSpec *material = c->spec->bodies[c->new_t->leaf_body[leaf]].material;

  PetscFunctionBegin;
  PetscCall(MechanicsPointRule(c->new_v->cell_order[cell], &basis));
  for (PetscInt q = 0; q < ElementNumNodes(dim, basis->num_points - 1); ++q) {
    PetscReal place[3], xi[3];
    PetscInt  k = first;
    Basis1DPoint(basis, dim, q, place);
    while (k < end && !TransferPlace_Private(c, leaf, place, k, xi)) ++k;
    PetscCheck(k < end, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the old leaves of leaf %" PetscInt_FMT " do not cover it", leaf);
    PetscCall(Load_Private(c, old, k, p));
    if (c->kept == HISTORY_CARRIED)
      PetscCall(Point_Private(c, old, p, xi, history + q * H));
    else if (c->kept == HISTORY_NEAREST)
      PetscCall(Nearest_Private(c, old, p, xi, history + q * H));
    else
      material->law->initial(material, history + q * H);
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
  OldPoints *p;

  PetscFunctionBegin;
  PetscCall(PetscNew(&p));
  p->leaf = -1;
  for (PetscInt cell = 0; cell < c->new_v->num_owned_cells; ++cell) {
    const PetscInt leaf = c->new_v->cell_leaf[cell], k = c->map->old_first[leaf];
    PetscInt       first, num, order;
    PetscCall(MechanicsHistoryRange(c->new_mechanics, cell, &first, &num));
    if (!num) continue;
    PetscCheck(c->spec->bodies[c->new_t->leaf_body[leaf]].material->law->num_history == H, PETSC_COMM_SELF, PETSC_ERR_SUP, "no transfer for this history");
    order = HPSpaceGetOrder(c->old_space, c->old_t->first[c->old_t->dim] + k);
    if (c->map->old_count[leaf] == 1 && order == c->new_v->cell_order[cell] && SameLeaf_Private(c, leaf, k)) /* bit by bit */
      PetscCall(PetscArraycpy(history + first, OldHistory_Private(c, old, k, order), num));
    else
      PetscCall(Cell_Private(c, old, cell, p, history + first));
  }
  PetscCall(PetscFree(p->value));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
