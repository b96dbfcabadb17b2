/* Static condensation: the dofs i of nodes inside a cell meet only those b of its own boundary, so that

     [ K_ii  K_ib ] [x_i]   [f_i]         S x_b = f_b - K_bi K_ii^-1 f_i,   S = K_bb - K_bi K_ii^-1 K_ib,
     [ K_bi  K_bb ] [x_b] = [f_b]   =>    x_i = K_ii^-1 (f_i - K_ib x_b)

   cell by cell. Inner nodes first, the columns of K_ii and K_bi make one panel [size][num_i] (column by column), which becomes L and K_bi L^-T with K_ii = L
   L^T; where K_ii is indefinite it holds the factors of K_ii = L D L^T and K_bi as it is. */
#include "mechanicsimpl.h"

#define LDL_BLOCK 32 /* columns for which dsytrf gets room */
#define LEAF 16      /* columns of a panel that are factored directly; the rest of it are products, which OpenBLAS does twice as fast as dpotrf and dtrsm */
#define STRIP 64     /* rows of those at once, in cache */

static PetscErrorCode GroupPlaces_Private(Mechanics m, CellGroup *g)
{
  const PetscInt n1    = g->order + 1;
  PetscInt       inner = 0, outer = 0;

  PetscFunctionBegin;
  g->num_inner = 1;
  for (PetscInt d = 0; d < m->dim; ++d) g->num_inner *= g->order - 1;
  PetscCall(PetscMalloc2(g->n, &g->place, g->n - g->num_inner, &g->outer));
  for (PetscInt i = 0; i < g->n; ++i) {
    PetscBool inside = PETSC_TRUE;
    for (PetscInt d = 0, k = i; d < m->dim; ++d, k /= n1) inside = (PetscBool)(inside && k % n1 > 0 && k % n1 < g->order);
    if (inside)
      g->place[i] = inner++;
    else {
      g->outer[outer] = i;
      g->place[i]     = g->num_inner + outer++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetCondense(Mechanics m)
{
  PetscInt most = 0;

  PetscFunctionBegin;
  if (m->condense_work) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt ig = 0; ig < m->num_groups; ++ig) {
    CellGroup *g = &m->groups[ig];
    PetscCall(GroupPlaces_Private(m, g));
    const PetscInt ni = g->num_inner * m->dim, nd = g->n * m->dim, nb = nd - ni;
    PetscCall(PetscMalloc1((size_t)g->num_cells * ni * nd, &g->factor));
    PetscCall(PetscMalloc2(g->num_cells * ni, &g->inner, g->num_cells * ni, &g->pivot));
    most = PetscMax(most, ni * ni + ni * PetscMax(nb, LDL_BLOCK) + 3 * nd);
  }
  PetscCall(PetscMalloc1(most + 1, &m->condense_work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsCondenseDestroy_Private(Mechanics m)
{
  PetscFunctionBegin;
  for (PetscInt ig = 0; ig < m->num_groups && m->condense_work; ++ig) {
    PetscCall(PetscFree2(m->groups[ig].place, m->groups[ig].outer));
    PetscCall(PetscFree(m->groups[ig].factor));
    PetscCall(PetscFree2(m->groups[ig].inner, m->groups[ig].pivot));
  }
  PetscCall(PetscFree(m->condense_work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sizes of a cell's blocks as BLAS wants them, and where the cell's data are. */
typedef struct {
  PetscBLASInt ni, nb, nd, *pivot;
  PetscReal   *panel, *outer, *inner; /* outer: K_bi inside the panel */
} Cell;

static PetscErrorCode CellOf_Private(Mechanics m, const CellGroup *g, PetscInt i, Cell *c)
{
  PetscFunctionBegin;
  PetscCall(PetscBLASIntCast(g->num_inner * m->dim, &c->ni));
  PetscCall(PetscBLASIntCast(g->n * m->dim, &c->nd));
  c->nb    = c->nd - c->ni;
  c->panel = g->factor + (size_t)i * c->ni * c->nd;
  c->outer = c->panel + c->ni;
  c->inner = g->inner + i * c->ni;
  c->pivot = g->pivot + i * c->ni;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K_ii = L D L^T with pivots; K_bb -= K_bi K_ii^-1 K_ib, lower triangle. */
static PetscErrorCode Indefinite_Private(const Cell *c, PetscReal *Kbb, PetscReal *work, PetscBool *singular)
{
  const PetscReal    one = 1, minus = -1;
  const PetscBLASInt lwork = LDL_BLOCK * c->ni;
  PetscBLASInt       info;

  PetscFunctionBegin;
  PetscCallBLAS("LAPACKsytrf", LAPACKsytrf_("L", &c->ni, c->panel, &c->nd, c->pivot, work, &lwork, &info));
  PetscCheck(info >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "dsytrf: argument %" PetscBLASInt_FMT, -info);
  if (info > 0) *singular = PETSC_TRUE;
  if (info > 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscBLASInt j = 0; j < c->nb; ++j)
    for (PetscBLASInt i = 0; i < c->ni; ++i) work[j * c->ni + i] = c->outer[i * c->nd + j];
  PetscCallBLAS("LAPACKsytrs", LAPACKsytrs_("L", &c->ni, &c->nb, c->panel, &c->nd, c->pivot, work, &c->ni, &info));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &c->nb, &c->nb, &c->ni, &minus, c->outer, &c->nd, work, &c->ni, &one, Kbb, &c->nb));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Negative eigenvalues of D: a block of two has one. */
static PetscInt Negative_Private(const Cell *c)
{
  PetscInt num = 0;

  for (PetscBLASInt j = 0; j < c->ni; ++j) {
    if (c->pivot[j] > 0)
      num += c->panel[(size_t)j * c->nd + j] < 0;
    else {
      ++num;
      ++j;
    }
  }
  return num;
}

/* Its factor L in place of the lower triangle of A[cols][cols], columns of stride. False: not positive definite. */
static PetscBool LeafTriangle_Private(PetscInt cols, PetscInt stride, PetscReal A[])
{
  for (PetscInt j = 0; j < cols; ++j) {
    PetscReal *x = A + j * stride;
    for (PetscInt k = 0; k < j; ++k) {
      const PetscReal *L = A + k * stride, factor = L[j];
      for (PetscInt i = j; i < cols; ++i) x[i] -= factor * L[i];
    }
    if (!(x[j] > 0)) return PETSC_FALSE;
    const PetscReal root = PetscSqrtReal(x[j]);
    for (PetscInt i = j; i < cols; ++i) x[i] /= root;
  }
  return PETSC_TRUE;
}

/* X = X L^-T of the rows below, L at A. */
static void LeafBelow_Private(PetscInt rows, PetscInt cols, PetscInt stride, const PetscReal A[], PetscReal X[])
{
  for (PetscInt first = 0; first < rows; first += STRIP) {
    const PetscInt num = PetscMin(STRIP, rows - first);
    for (PetscInt j = 0; j < cols; ++j) {
      PetscReal      *x       = X + first + j * stride;
      const PetscReal inverse = 1 / A[j * (stride + 1)];
      PetscInt        k       = 0;
      for (; k + 3 < j; k += 4) {
        const PetscReal *L = A + k * stride + j, *y = X + first + k * stride, a = L[0], b = L[stride], c = L[2 * stride], d = L[3 * stride];
        for (PetscInt i = 0; i < num; ++i) x[i] -= a * y[i] + b * y[stride + i] + c * y[2 * stride + i] + d * y[3 * stride + i];
      }
      for (; k < j; ++k) {
        const PetscReal *y = X + first + k * stride, factor = A[k * stride + j];
        for (PetscInt i = 0; i < num; ++i) x[i] -= factor * y[i];
      }
      for (PetscInt i = 0; i < num; ++i) x[i] *= inverse;
    }
  }
}

/* The first of two halves of so many columns. */
static PetscBLASInt Left_Private(PetscBLASInt cols)
{
  return (cols / 2 + 7) / 8 * 8;
}

/* X = X L^-T of rows below L[cols][cols]: the left half first, then its products off the right one. */
static PetscErrorCode FactorBelow_Private(PetscBLASInt rows, PetscBLASInt cols, PetscBLASInt stride, const PetscReal L[], PetscReal X[])
{
  const PetscReal    one = 1, minus = -1;
  const PetscBLASInt left = Left_Private(cols), right = cols - left;
  PetscReal         *Y = X + (size_t)left * stride;

  PetscFunctionBegin;
  if (cols <= LEAF) {
    LeafBelow_Private(rows, cols, stride, L, X);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(FactorBelow_Private(rows, left, stride, L, X));
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "T", &rows, &right, &left, &minus, X, &stride, L + left, &stride, &one, Y, &stride));
  PetscCall(FactorBelow_Private(rows, right, stride, L + (size_t)left * (stride + 1), Y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cholesky's method on A[n][n], of which the lower triangle is read: the left half, what is below it, its products off the right one. */
static PetscErrorCode FactorTriangle_Private(PetscBLASInt n, PetscBLASInt stride, PetscReal A[], PetscBool *definite)
{
  const PetscReal    one = 1, minus = -1;
  const PetscBLASInt left = Left_Private(n), right = n - left;
  PetscReal         *B = A + (size_t)left * (stride + 1);

  PetscFunctionBegin;
  if (n <= LEAF) {
    *definite = LeafTriangle_Private(n, stride, A);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(FactorTriangle_Private(left, stride, A, definite));
  if (!*definite) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FactorBelow_Private(right, left, stride, A, A + left));
  PetscCallBLAS("BLASsyrk", BLASsyrk_("L", "N", &right, &left, &minus, A + left, &stride, &one, B, &stride));
  PetscCall(FactorTriangle_Private(right, stride, B, definite));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S[n][n] from its lower triangle (columns): eight columns at a time are turned into pieces of the rows below them. */
static void Mirror_Private(PetscInt n, PetscReal S[])
{
  for (PetscInt first = 0; first < n; first += 8) {
    const PetscInt last = PetscMin(n, first + 8);
    for (PetscInt k = first; k < n; ++k)
      for (PetscInt j = first; j < PetscMin(last, k); ++j) S[k * n + j] = S[j * n + k];
  }
}

/* The lower triangle of A[n][n] (columns of stride) to B (columns of n), or back. */
static PetscErrorCode CopyTriangle_Private(PetscInt n, PetscInt from, const PetscReal A[], PetscInt to, PetscReal B[])
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < n; ++j) PetscCall(PetscArraycpy(B + j * (to + 1), A + j * (from + 1), n - j));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsCondenseCell_Private(Mechanics m, CellGroup *g, PetscInt i, PetscReal K[], PetscBool *singular)
{
  const PetscReal one = 1, minus = -1;
  PetscReal      *kept = m->condense_work;
  Cell            c;
  PetscBool       definite;

  PetscFunctionBegin;
  PetscCall(CellOf_Private(m, g, i, &c));
  if (c.ni > 0) {
    PetscCall(CopyTriangle_Private(c.ni, c.nd, c.panel, c.ni, kept));
    c.pivot[0] = 0;
    PetscCall(FactorTriangle_Private(c.ni, c.nd, c.panel, &definite));
    if (definite) {
      PetscCall(FactorBelow_Private(c.nb, c.ni, c.nd, c.panel, c.outer));
      PetscCallBLAS("BLASsyrk", BLASsyrk_("L", "N", &c.nb, &c.ni, &minus, c.outer, &c.nd, &one, K, &c.nb));
    } else {
      PetscCall(CopyTriangle_Private(c.ni, c.ni, kept, c.nd, c.panel));
      PetscCall(Indefinite_Private(&c, K, kept + c.ni * c.ni, singular));
      m->num_negative += Negative_Private(&c);
    }
  }
  Mirror_Private(c.nb, K);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x = L^-1 x, or K_ii^-1 x where K_ii is indefinite; back: x = L^-T x, or x. */
static PetscErrorCode SolveInner_Private(const Cell *c, PetscBool back, PetscReal x[])
{
  const PetscReal    one    = 1;
  const PetscBLASInt single = 1;
  PetscBLASInt       info;

  PetscFunctionBegin;
  if (c->pivot[0] == 0)
    PetscCallBLAS("BLAStrsm", BLAStrsm_("L", "L", back ? "T" : "N", "N", &c->ni, &single, &one, c->panel, &c->nd, x, &c->ni));
  else if (!back)
    PetscCallBLAS("LAPACKsytrs", LAPACKsytrs_("L", &c->ni, &single, c->panel, &c->nd, c->pivot, x, &c->ni, &info));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsNumNegative(Mechanics m, PetscInt *num)
{
  PetscFunctionBegin;
  *num = m->num_negative;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For all cells with inner nodes: mine, their part of the local array x. */
typedef PetscErrorCode (*CellFunction)(Mechanics, const CellGroup *, PetscInt cell, const Cell *, PetscReal mine[], PetscReal x[]);

static PetscErrorCode EachCell_Private(Mechanics m, CellFunction function, PetscReal x[])
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  for (PetscInt ig = 0; ig < m->num_groups; ++ig) {
    const CellGroup *g = &m->groups[ig];
    for (PetscInt i = 0; i < g->num_cells && g->num_inner; ++i) {
      Cell c;
      PetscCall(CellOf_Private(m, g, i, &c));
      PetscCall(function(m, g, g->cells[i], &c, x + v->point_node[g->cells[i]] * m->dim, x));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CellForces_Private(Mechanics m, const CellGroup *g, PetscInt cell, const Cell *c, PetscReal mine[], PetscReal r[])
{
  const PetscReal    one = 1, zero = 0;
  const PetscBLASInt single = 1;
  PetscReal         *y = m->condense_work, *values = y + c->nb;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(c->inner, mine, c->ni));
  PetscCall(PetscArrayzero(mine, c->ni));
  PetscCall(SolveInner_Private(c, PETSC_FALSE, c->inner));
  PetscCallBLAS("BLASgemv", BLASgemv_("N", &c->nb, &c->ni, &one, c->outer, &c->nd, c->inner, &single, &zero, y, &single));
  PetscCall(PetscArrayzero(values, c->nd));
  for (PetscInt k = 0; k < g->n - g->num_inner; ++k)
    for (PetscInt d = 0; d < m->dim; ++d) values[g->outer[k] * m->dim + d] = -y[k * m->dim + d];
  PetscCall(HPSpaceScatterAdd(m->space, cell, values, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsCondenseForces(Mechanics m, PetscReal r[])
{
  PetscFunctionBegin;
  PetscCall(EachCell_Private(m, CellForces_Private, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CellRecover_Private(Mechanics m, const CellGroup *g, PetscInt cell, const Cell *c, PetscReal mine[], PetscReal du[])
{
  const PetscReal    one = 1, zero = 0;
  const PetscBLASInt single = 1;
  PetscReal         *values = m->condense_work, *b = values + c->nd;

  PetscFunctionBegin;
  PetscCall(HPSpaceGather(m->space, cell, du, values));
  for (PetscInt k = 0; k < g->n - g->num_inner; ++k)
    for (PetscInt d = 0; d < m->dim; ++d) b[k * m->dim + d] = values[g->outer[k] * m->dim + d];
  PetscCallBLAS("BLASgemv", BLASgemv_("T", &c->nb, &c->ni, &one, c->outer, &c->nd, b, &single, &zero, mine, &single));
  if (c->pivot[0] != 0) PetscCall(SolveInner_Private(c, PETSC_FALSE, mine));
  for (PetscInt k = 0; k < c->ni; ++k) mine[k] = -mine[k] - c->inner[k];
  PetscCall(SolveInner_Private(c, PETSC_TRUE, mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsRecover(Mechanics m, PetscReal du[])
{
  PetscFunctionBegin;
  PetscCall(EachCell_Private(m, CellRecover_Private, du));
  PetscFunctionReturn(PETSC_SUCCESS);
}
