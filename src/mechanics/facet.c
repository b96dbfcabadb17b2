/* Loads on one facet with (p+1)^(dim-1) trace nodes, p+2 Gauss points in each direction. The normal of the tangent order is (t_y, -t_x) in 2-D and
   t_1 x t_2 in 3-D. Axisymmetric: the full revolution. */
#include "mechanicsimpl.h"

#define MOST_NODES ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1))

/* One Gauss point of a facet with nodes x[n][dim]. */
typedef struct {
  PetscReal value[MOST_NODES], slope[2][MOST_NODES]; /* shape functions and derivatives along the tangents */
  PetscReal weight;
  PetscReal x[3], tangent[2][3];
  PetscReal area[3]; /* normal times area density, without the factor 2 pi r */
} FacetPoint;

PetscInt FacetNumPoints(PetscInt dim, PetscInt order)
{
  return dim == 2 ? order + 2 : (order + 2) * (order + 2);
}

static inline void Cross_Private(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static void PointSet_Private(PetscInt dim, const Basis1D *b, PetscInt q, const PetscReal *x, FacetPoint *f)
{
  const PetscInt n1 = b->num_nodes, np = b->num_points, n = dim == 2 ? n1 : n1 * n1, qx = q % np, qy = q / np;

  PetscArrayzero(f->x, 3);
  PetscArrayzero(f->tangent[0], 6);
  f->weight = b->weights[qx] * (dim == 3 ? b->weights[qy] : 1);
  for (PetscInt a = 0; a < n; a++) {
    const PetscInt  ax = a % n1, ay = a / n1;
    const PetscReal by = dim == 3 ? b->B[qy * n1 + ay] : 1, dy = dim == 3 ? b->D[qy * n1 + ay] : 0;

    f->value[a]    = b->B[qx * n1 + ax] * by;
    f->slope[0][a] = b->D[qx * n1 + ax] * by;
    f->slope[1][a] = b->B[qx * n1 + ax] * dy;
    for (PetscInt c = 0; c < dim; c++) {
      f->x[c] += f->value[a] * x[a * dim + c];
      f->tangent[0][c] += f->slope[0][a] * x[a * dim + c];
      f->tangent[1][c] += f->slope[1][a] * x[a * dim + c];
    }
  }
  if (dim == 2) f->tangent[1][2] = 1; /* (t_x, t_y, 0) x e_z = (t_y, -t_x, 0) */
  Cross_Private(f->tangent[0], f->tangent[1], f->area);
}

PetscErrorCode FacetQuadrature(PetscInt dim, Model model, PetscInt order, const PetscReal *X, PetscReal *position, PetscReal *dA, PetscReal *normal)
{
  const Basis1D *b;
  FacetPoint     f;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, order + 2, &b));
  for (PetscInt q = 0; q < FacetNumPoints(dim, order); q++) {
    PetscReal area;

    PointSet_Private(dim, b, q, X, &f);
    area = PetscSqrtReal(Dot3(f.area, f.area));
    for (PetscInt c = 0; c < 3; c++) {
      if (position) position[3 * q + c] = f.x[c];
      if (normal) normal[3 * q + c] = f.area[c] / area;
    }
    if (dA) dA[q] = f.weight * area * (model == MODEL_AXISYMMETRIC ? 2 * PETSC_PI * f.x[0] : 1);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FacetTraction(PetscInt dim, Model model, PetscInt order, const PetscReal *X, const PetscReal *traction, PetscReal *residual)
{
  const PetscInt n = ElementNumNodes(dim - 1, order);
  const Basis1D *b;
  FacetPoint     f;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, order + 2, &b));
  PetscCall(PetscArrayzero(residual, n * dim));
  for (PetscInt q = 0; q < FacetNumPoints(dim, order); q++) {
    PetscReal dA;

    PointSet_Private(dim, b, q, X, &f);
    dA = f.weight * PetscSqrtReal(Dot3(f.area, f.area)) * (model == MODEL_AXISYMMETRIC ? 2 * PETSC_PI * f.x[0] : 1);
    for (PetscInt i = 0; i < n * dim; i++) residual[i] -= dA * f.value[i / dim] * traction[3 * q + i % dim];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d(weight r area)/dx_(b k), r = 1 but in axisymmetry: D_1b e_k x t_2 - D_2b e_k x t_1 and the derivative of r. */
static void AreaDerivative_Private(PetscInt dim, PetscBool hoop, const FacetPoint *f, PetscInt node, PetscInt k, PetscReal d[3])
{
  PetscReal e[3] = {0, 0, 0}, with1[3], with2[3];

  e[k] = 1;
  Cross_Private(e, f->tangent[1], with2);
  Cross_Private(e, f->tangent[0], with1);
  for (PetscInt c = 0; c < 3; c++) {
    d[c] = f->slope[0][node] * with2[c] - (dim == 3 ? f->slope[1][node] * with1[c] : 0);
    if (hoop) d[c] = 2 * PETSC_PI * (f->x[0] * d[c] + (k == 0 ? f->value[node] * f->area[c] : 0));
  }
}

PetscErrorCode FacetPressure(PetscInt dim, Model model, PetscInt order, const PetscReal *x, PetscInt side, const PetscReal *pressure, PetscReal *residual,
                             PetscReal *tangent)
{
  const PetscInt  n = ElementNumNodes(dim - 1, order), size = n * dim;
  const PetscBool hoop = model == MODEL_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE;
  const Basis1D  *b;
  FacetPoint      f;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(order, order + 2, &b));
  if (residual) PetscCall(PetscArrayzero(residual, size));
  if (tangent) PetscCall(PetscArrayzero(tangent, size * size));
  for (PetscInt q = 0; q < FacetNumPoints(dim, order); q++) {
    PetscReal force; /* the load -p n da enters the residual with the opposite sign */

    PointSet_Private(dim, b, q, x, &f);
    force = side * f.weight * pressure[q];
    for (PetscInt i = 0; residual && i < size; i++) residual[i] += force * f.value[i / dim] * f.area[i % dim] * (hoop ? 2 * PETSC_PI * f.x[0] : 1);
    for (PetscInt j = 0; tangent && j < size; j++) {
      PetscReal d[3];

      AreaDerivative_Private(dim, hoop, &f, j / dim, j % dim, d);
      for (PetscInt i = 0; i < size; i++) tangent[i * size + j] += force * f.value[i / dim] * d[i % dim];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
