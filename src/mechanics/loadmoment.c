/* A load that is given as an expression in X, Y, Z, at the Gauss points of a facet: not its value there, which says nothing of a load that ends between them,
   but v_j = 1/w_j int q l_j dxi, l_j the Lagrange functions of the points. With these values the rule gives the moments of q with all polynomials up to its
   degree n - 1, and so with the facet's shape functions: of facets that are straight the load that q is, wherever it jumps, for smooth q that of the points.
   The integrals are found on halves of halves of the facet (quarters in space), until those of a part are those of its parts twice in a row: once a jump may
   be where neither rule has a point. */
#include "mechanicsimpl.h"

#define PLANE_TOLERANCE 1e-8 /* of an integral over a part, of the facet times the largest value seen */
#define SPACE_TOLERANCE 1e-5 /* the same: each halving of the parts along a jump doubles their number */

enum { MOST_HALVINGS = 30 };

typedef struct {
  const LoadExpression *load;
  const PetscReal      *trace;
  const Basis1D        *gauss;
  PetscInt              dim, order, n, num;
  PetscReal             t, largest;
} Facet;

/* The Lagrange functions of the points at xi. */
static void Lagrange_Private(const Basis1D *gauss, PetscReal xi, PetscReal l[])
{
  for (PetscInt j = 0; j < gauss->num_points; ++j) {
    l[j] = 1;
    for (PetscInt k = 0; k < gauss->num_points; ++k)
      if (k != j) l[j] *= (xi - gauss->points[k]) / (gauss->points[j] - gauss->points[k]);
  }
}

/* integral[num] += that over the part of the facet at low, of this size, by one rule. */
static PetscErrorCode Add_Private(Facet *f, const PetscReal low[2], PetscReal size, PetscReal integral[])
{
  const PetscInt m = f->dim - 1;
  PetscReal      N[MOST_FACET_NODES], l[2][MORTISE_MAX_ORDER + 2];

  PetscFunctionBegin;
  for (PetscInt q = 0; q < f->num; ++q) {
    PetscReal xi[2] = {0, 0}, X[3] = {0, 0, 0}, weight = Basis1DPoint(f->gauss, m, q, xi), value;
    for (PetscInt d = 0; d < m; ++d) {
      xi[d] = low[d] + size * xi[d];
      weight *= size;
      Lagrange_Private(f->gauss, xi[d], l[d]);
    }
    PetscCall(ElementEvaluate(m, f->order, xi, N, NULL));
    for (PetscInt a = 0; a < ElementNumNodes(m, f->order); ++a)
      for (PetscInt c = 0; c < f->dim; ++c) X[c] += N[a] * f->trace[f->dim * a + c];
    PetscCall(MechanicsValue(f->load->expression, f->load->amplitude, X, f->t, &value));
    f->largest = PetscMax(f->largest, PetscAbsReal(value));
    for (PetscInt j = 0; j < f->num; ++j) integral[j] += weight * value * l[0][j % f->n] * (m == 2 ? l[1][j / f->n] : 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* integral[num]: over the part, in as many parts as it takes; on entry by one rule. agreed: that of the part that this is one of was that of its parts. */
static PetscErrorCode Part_Private(Facet *f, const PetscReal low[2], PetscReal size, PetscInt halved, PetscBool agreed, PetscReal integral[])
{
  const PetscInt  parts     = 1 << (f->dim - 1);
  const PetscReal tolerance = f->dim == 2 ? PLANE_TOLERANCE : SPACE_TOLERANCE;
  PetscReal       half[4][MOST_FACET_POINTS], at[4][2];
  PetscBool       agrees = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(half[0], 4 * MOST_FACET_POINTS));
  for (PetscInt k = 0; k < parts; ++k) {
    at[k][0] = low[0] + (k & 1) * size / 2;
    at[k][1] = low[1] + (k >> 1) * size / 2;
    PetscCall(Add_Private(f, at[k], size / 2, half[k]));
  }
  for (PetscInt j = 0; j < f->num; ++j) {
    const PetscReal change = half[0][j] + half[1][j] + half[2][j] + half[3][j] - integral[j];
    if (PetscAbsReal(change) > tolerance * f->largest) agrees = PETSC_FALSE;
  }
  for (PetscInt k = 0; k < parts && !(agrees && agreed) && halved < MOST_HALVINGS; ++k)
    PetscCall(Part_Private(f, at[k], size / 2, halved + 1, agrees, half[k]));
  for (PetscInt j = 0; j < f->num; ++j) integral[j] = half[0][j] + half[1][j] + half[2][j] + half[3][j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsLoadMoments_Private(PetscInt dim, PetscInt order, const PetscReal trace[], const LoadExpression *load, PetscReal t, PetscReal value[])
{
  const PetscReal low[2] = {0, 0};
  Facet           f      = {.load = load, .trace = trace, .dim = dim, .order = order, .n = order + 2, .num = FacetNumPoints(dim, order), .t = t};

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, f.n, &f.gauss));
  PetscCall(PetscArrayzero(value, f.num));
  PetscCall(Add_Private(&f, low, 1, value));
  PetscCall(Part_Private(&f, low, 1, 0, PETSC_FALSE, value));
  for (PetscInt j = 0; j < f.num; ++j) value[j] /= f.gauss->weights[j % f.n] * (dim == 3 ? f.gauss->weights[j / f.n] : 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}
