/* Floor 1. One-dimensional bases and quadrature on [0,1], from which every tensor-product cell is made.
   Reference cells are [0,1]^dim; nodes and quadrature points are numbered lexicographically, x fastest. */
#pragma once
#include "base.h"

/* Nodal Lagrange basis on the Gauss-Lobatto points of [0,1], tabulated at Gauss points. Cached: never free. */
typedef struct {
  PetscInt         order;      /* p >= 1 */
  PetscInt         num_nodes;  /* p + 1 */
  PetscInt         num_points; /* quadrature points */
  const PetscReal *nodes;      /* [num_nodes] Gauss-Lobatto points in [0,1] */
  const PetscReal *points;     /* [num_points] Gauss points in [0,1] */
  const PetscReal *weights;    /* [num_points], sum 1 */
  const PetscReal *B;          /* [num_points][num_nodes] values */
  const PetscReal *D;          /* [num_points][num_nodes] derivatives */
} Basis1D;

/* Table of order `order` (1..MORTISE_MAX_ORDER) at `num_points` Gauss points (1..MORTISE_MAX_ORDER+4). Not collective. */
PetscErrorCode Basis1DGet(PetscInt order, PetscInt num_points, const Basis1D **);

/* Gauss-Lobatto nodes of order p on [0,1]; [p+1], cached. */
PetscErrorCode ElementGetNodes(PetscInt order, const PetscReal **nodes);

/* Values (and derivatives unless NULL) of the p+1 Lagrange functions of order p at xi; exact 0/1 at the nodes. */
PetscErrorCode ElementEvaluate1D(PetscInt order, PetscReal xi, PetscReal value[], PetscReal derivative[]);

/* Values [n] and gradients [n][dim] (unless NULL) of the n = (p+1)^dim tensor functions at xi[dim]. */
PetscErrorCode ElementEvaluate(PetscInt dim, PetscInt order, const PetscReal xi[], PetscReal value[], PetscReal gradient[]);

#define ELEMENT_MOST_LINE (MORTISE_MAX_ORDER + 1)

/* Up to NUM_LANES fields on the nodes of one cell, one in each lane, and what is kept from one point to the next. About 60 kB. */
typedef struct {
  PetscInt  dim, order;
  PetscReal at[3], N[3][ELEMENT_MOST_LINE], D[3][ELEMENT_MOST_LINE]; /* the last point; functions of a line there */
  Lanes     node[ELEMENT_MOST_LINE * ELEMENT_MOST_LINE * ELEMENT_MOST_LINE];
  Lanes     plane[2][ELEMENT_MOST_LINE * ELEMENT_MOST_LINE]; /* at z: values, derivatives by z */
  Lanes     line[3][ELEMENT_MOST_LINE];                      /* at y, z: values, derivatives by y, by z */
} ElementFields;

/* No field yet; then values[n][num] into the lanes from `first` on. */
void ElementFieldsBegin(ElementFields *, PetscInt dim, PetscInt order);
void ElementFieldsAdd(ElementFields *, PetscInt first, PetscInt num, const PetscReal values[]);
/* Values at xi[dim], value[0], and derivatives by each coordinate, value[1..dim]. Cheapest from one point to the next when the last coordinates stay. */
PetscErrorCode ElementFieldsAt(ElementFields *, const PetscReal xi[], Lanes value[]);

/* A matrix M[to][from] applied in every direction of a tensor of from^dim entries of num components (fastest): out[to^dim][num]. out and work need room for
   max(from, to)^dim * num numbers. */
PetscErrorCode ElementTransform(PetscInt dim, PetscInt from, PetscInt to, PetscInt num, const PetscReal M[], const PetscReal in[], PetscReal out[],
                                PetscReal work[]);

/* Quadrature point q of the tensor product of a table's points: xi[dim]; returns its weight (of the unit cell). */
static inline PetscReal Basis1DPoint(const Basis1D *b, PetscInt dim, PetscInt q, PetscReal xi[])
{
  PetscReal weight = 1;

  for (PetscInt d = 0; d < dim; d++, q /= b->num_points) {
    xi[d] = b->points[q % b->num_points];
    weight *= b->weights[q % b->num_points];
  }
  return weight;
}

/* The polynomials of lowest degree through values[num_points^dim][num] at the tensor product of a table's quadrature points, at xi[dim]: out[num]. */
void Basis1DInterpolate(const Basis1D *, PetscInt dim, const PetscReal xi[], PetscInt num, const PetscReal values[], PetscReal out[]);

/* Legendre polynomials 0..degree on [0,1] at xi: P_0 = 1, P_n(1) = 1; and derivatives unless NULL. */
PetscErrorCode ElementLegendre(PetscInt degree, PetscReal xi, PetscReal value[], PetscReal derivative[]);

static inline PetscInt ElementNumNodes(PetscInt dim, PetscInt order)
{
  return dim == 1 ? order + 1 : dim == 2 ? (order + 1) * (order + 1) : (order + 1) * (order + 1) * (order + 1);
}
