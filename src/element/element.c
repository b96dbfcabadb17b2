/* One-dimensional tables: Gauss-Lobatto Lagrange functions at Gauss points. Built at first use, freed by PetscFinalize. */
#include "element.h"

#define MAX_NODES (MORTISE_MAX_ORDER + 1)
#define MAX_POINTS (MORTISE_MAX_ORDER + 4)

typedef struct {
  PetscBool ready;
  PetscReal nodes[MAX_NODES];
  PetscReal weight[MAX_NODES]; /* barycentric: 1 / prod_(k != j) (x_j - x_k) */
} Lagrange;

typedef struct {
  Basis1D   basis; /* pointers into this struct */
  PetscReal points[MAX_POINTS], weights[MAX_POINTS];
  PetscReal B[MAX_POINTS * MAX_NODES], D[MAX_POINTS * MAX_NODES];
} Table;

static Lagrange  lagrange[MORTISE_MAX_ORDER + 1];
static Table    *table[MORTISE_MAX_ORDER + 1][MAX_POINTS + 1];
static PetscBool finalize_registered;

static PetscErrorCode TablesDestroy_Private(void)
{
  PetscFunctionBegin;
  for (PetscInt p = 0; p <= MORTISE_MAX_ORDER; p++) {
    for (PetscInt n = 0; n <= MAX_POINTS; n++) PetscCall(PetscFree(table[p][n]));
  }
  finalize_registered = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Points x[n] of [-1,1] to [0,1], exactly symmetric about 1/2. */
static void MapSymmetric_Private(PetscInt n, PetscReal x[])
{
  for (PetscInt i = 0; i < (n + 1) / 2; i++) {
    const PetscReal half = (x[n - 1 - i] - x[i]) / 4;

    x[i]         = 0.5 - half;
    x[n - 1 - i] = 0.5 + half;
  }
}

static PetscErrorCode LagrangeGet_Private(PetscInt order, const Lagrange **out)
{
  Lagrange *l = &lagrange[order];
  PetscReal unused[MAX_NODES];

  PetscFunctionBegin;
  PetscAssert(order >= 1 && order <= MORTISE_MAX_ORDER, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "Order %" PetscInt_FMT " not in 1..%d", order,
              MORTISE_MAX_ORDER);
  *out = l;
  if (l->ready) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscDTGaussLobattoLegendreQuadrature(order + 1, PETSCGAUSSLOBATTOLEGENDRE_VIA_LINEAR_ALGEBRA, l->nodes, unused));
  MapSymmetric_Private(order + 1, l->nodes);
  l->nodes[0]     = 0;
  l->nodes[order] = 1;
  for (PetscInt j = 0; j <= order; j++) {
    PetscReal product = 1;

    for (PetscInt k = 0; k <= order; k++) {
      if (k != j) product *= l->nodes[j] - l->nodes[k];
    }
    l->weight[j] = 1 / product;
  }
  l->ready = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ElementGetNodes(PetscInt order, const PetscReal **nodes)
{
  const Lagrange *l;

  PetscFunctionBegin;
  PetscCall(LagrangeGet_Private(order, &l));
  *nodes = l->nodes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* N_j = w_j prod_(k<j) (x - x_k) prod_(k>j) (x - x_k): a running product from each side, so exactly 0 at other nodes. */
PetscErrorCode ElementEvaluate1D(PetscInt order, PetscReal xi, PetscReal value[], PetscReal derivative[])
{
  const Lagrange *l;
  PetscReal       right[MAX_NODES], dright[MAX_NODES], left = 1, dleft = 0;

  PetscFunctionBegin;
  PetscCall(LagrangeGet_Private(order, &l));
  right[order]  = 1;
  dright[order] = 0;
  for (PetscInt j = order; j > 0; j--) {
    right[j - 1]  = right[j] * (xi - l->nodes[j]);
    dright[j - 1] = dright[j] * (xi - l->nodes[j]) + right[j];
  }
  for (PetscInt j = 0; j <= order; j++) {
    value[j] = xi == l->nodes[j] ? 1 : l->weight[j] * left * right[j];
    if (derivative) derivative[j] = l->weight[j] * (dleft * right[j] + left * dright[j]);
    dleft = dleft * (xi - l->nodes[j]) + left;
    left *= xi - l->nodes[j];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ElementEvaluate(PetscInt dim, PetscInt order, const PetscReal xi[], PetscReal value[], PetscReal gradient[])
{
  const PetscInt n1 = order + 1;
  PetscReal      v[3][MAX_NODES], d[3][MAX_NODES];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < dim; c++) PetscCall(ElementEvaluate1D(order, xi[c], v[c], d[c]));
  for (PetscInt node = 0; node < ElementNumNodes(dim, order); node++) {
    const PetscInt index[3] = {node % n1, node / n1 % n1, node / (n1 * n1)};

    value[node] = 1;
    for (PetscInt c = 0; c < dim; c++) value[node] *= v[c][index[c]];
    for (PetscInt r = 0; gradient && r < dim; r++) {
      PetscReal product = 1;

      for (PetscInt c = 0; c < dim; c++) product *= c == r ? d[c][index[c]] : v[c][index[c]];
      gradient[node * dim + r] = product;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lagrange polynomials of n points at x. */
static void LagrangeThrough_Private(PetscInt n, const PetscReal points[], PetscReal x, PetscReal value[])
{
  for (PetscInt i = 0; i < n; i++) {
    value[i] = 1;
    for (PetscInt j = 0; j < n; j++) value[i] *= j == i ? 1 : (x - points[j]) / (points[i] - points[j]);
  }
}

void Basis1DInterpolate(const Basis1D *b, PetscInt dim, const PetscReal xi[], PetscInt num, const PetscReal values[], PetscReal out[])
{
  const PetscInt n = b->num_points;
  PetscReal      L[3][MAX_POINTS];

  for (PetscInt d = 0; d < dim; d++) LagrangeThrough_Private(n, b->points, xi[d], L[d]);
  for (PetscInt k = 0; k < num; k++) out[k] = 0;
  for (PetscInt q = 0; q < ElementNumNodes(dim, n - 1); q++) {
    const PetscReal weight = L[0][q % n] * (dim > 1 ? L[1][q / n % n] : 1) * (dim > 2 ? L[2][q / (n * n)] : 1);

    for (PetscInt k = 0; k < num; k++) out[k] += weight * values[q * num + k];
  }
}

/* Bonnet's recursion n P_n = (2n-1) s P_(n-1) - (n-1) P_(n-2) with s = 2 xi - 1; P'_n = P'_(n-2) + (2n-1) P_(n-1) (times ds/dxi = 2). */
PetscErrorCode ElementLegendre(PetscInt degree, PetscReal xi, PetscReal value[], PetscReal derivative[])
{
  const PetscReal s = 2 * xi - 1;

  PetscFunctionBegin;
  value[0] = 1;
  if (degree > 0) value[1] = s;
  for (PetscInt n = 2; n <= degree; n++) value[n] = ((2 * n - 1) * s * value[n - 1] - (n - 1) * value[n - 2]) / n;
  if (!derivative) PetscFunctionReturn(PETSC_SUCCESS);
  derivative[0] = 0;
  if (degree > 0) derivative[1] = 2;
  for (PetscInt n = 2; n <= degree; n++) derivative[n] = derivative[n - 2] + 2 * (2 * n - 1) * value[n - 1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TableCreate_Private(PetscInt order, PetscInt num_points, Table **out)
{
  const Lagrange *l;
  Table          *t;

  PetscFunctionBegin;
  PetscCall(LagrangeGet_Private(order, &l));
  PetscCall(PetscNew(&t));
  PetscCall(PetscDTGaussQuadrature(num_points, -1, 1, t->points, t->weights));
  MapSymmetric_Private(num_points, t->points);
  for (PetscInt q = 0; q < num_points; q++) {
    t->weights[q] /= 2;
    PetscCall(ElementEvaluate1D(order, t->points[q], &t->B[q * (order + 1)], &t->D[q * (order + 1)]));
  }
  t->basis = (Basis1D){order, order + 1, num_points, l->nodes, t->points, t->weights, t->B, t->D};
  *out     = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Basis1DGet(PetscInt order, PetscInt num_points, const Basis1D **basis)
{
  PetscFunctionBegin;
  PetscCheck(order >= 1 && order <= MORTISE_MAX_ORDER && num_points >= 1 && num_points <= MAX_POINTS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "No table of order %" PetscInt_FMT " at %" PetscInt_FMT " points", order, num_points);
  if (!table[order][num_points]) {
    if (!finalize_registered) PetscCall(PetscRegisterFinalize(TablesDestroy_Private));
    finalize_registered = PETSC_TRUE;
    PetscCall(TableCreate_Private(order, num_points, &table[order][num_points]));
  }
  *basis = &table[order][num_points]->basis;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One direction after the other: before step d the array has `to` entries in the first d directions and `from` in the others. */
PetscErrorCode ElementTransform(PetscInt dim, PetscInt from, PetscInt to, PetscInt num, const PetscReal M[], const PetscReal in[], PetscReal out[],
                                PetscReal work[])
{
  const PetscReal *source = in;
  PetscInt         inner = num, outer = dim == 1 ? 1 : ElementNumNodes(dim - 1, from - 1);

  PetscFunctionBegin;
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal *result = (dim - d) % 2 ? out : work; /* the last step ends in out */
    for (PetscInt o = 0; o < outer; ++o) {
      for (PetscInt r = 0; r < to; ++r) {
        PetscReal *sum = result + (o * to + r) * inner;
        PetscCall(PetscArrayzero(sum, inner));
        for (PetscInt i = 0; i < from; ++i) {
          const PetscReal *term = source + (o * from + i) * inner;
          for (PetscInt k = 0; k < inner; ++k) sum[k] += M[r * from + i] * term[k];
        }
      }
    }
    source = result;
    inner *= to;
    outer /= from;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
