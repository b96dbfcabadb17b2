/* Private to mechanics: cell and facet kernels. They see nodal values only: no mesh, no constraints, no parallelism. */
#pragma once
#include "mechanics.h"

/* ---- cells (cell.c): residual, tangent and energy of batches of tensor-product cells of one order, law and model ---- */

typedef struct _p_CellKernel *CellKernel;

/* Arrays of one batch of nc cells; n = nodes of a cell, d = dim, m = num_pressure. Node-major: X[c][node][d], lexicographic nodes.
   NULL outputs are skipped. */
typedef struct {
  PetscInt         nc;
  const PetscReal *X;        /* [nc][n][d] reference positions */
  const PetscReal *u;        /* [nc][n][d] displacements */
  const PetscReal *pressure; /* [nc][m] stored pressure coefficients: enter the geometric stiffness only. NULL: the consistent ones are used */
  PetscReal       *energy;   /* [nc] */
  PetscReal       *residual; /* [nc][n*d] dE/du, row node*d + component; a function of u alone */
  PetscReal       *tangent;  /* [nc][n*d][n*d] symmetric, full; exact derivative of residual when pressure is NULL or consistent */
  PetscReal       *consistent; /* [nc][m] pressure coefficients that u implies: modulus * M^-1 int q g(J) */
  PetscReal       *dpressure;  /* [nc][m][n*d] derivative of consistent with respect to u */
  PetscReal       *min_det;    /* [nc] smallest det F over the quadrature points */
  PetscBool        bad;        /* out: some det F <= 0 in the batch (finite kinematics): outputs of that batch are not to be used */
} CellBatch;

/* Kernel for cells of order p with p+1 Gauss points in each direction. Mixed (material->mixed): pressure in the complete polynomials of degree p-1 in the
   reference cell (Q_p / P_(p-1) discontinuous; Q1/P0), condensed: energy = int W_iso + modulus/2 int (Proj g(J))^2, where Proj is the L2 projection
   with the reference-volume weight. body_force is not here. Axisymmetric: hoop stretch 1 + u_r/R, weight 2 pi R. Small: F = I + grad u,
   law `linear` on the symmetric gradient. */
PetscErrorCode CellKernelCreate(PetscInt dim, Model, Kinematics, PetscInt order, const MaterialSpec *, CellKernel *);
PetscErrorCode CellKernelDestroy(CellKernel *);
void           CellKernelSizes(CellKernel, PetscInt *num_nodes, PetscInt *num_pressure, PetscInt *best_batch);
PetscErrorCode CellKernelEvaluate(CellKernel, CellBatch *);

/* Point values for output and estimation at given reference points xi[np][dim] of one cell with nodes X, u ([n][dim]) and pressure coefficients (mixed, else NULL):
   F[np][9], P[np][9] (with the pressure field's volumetric part), J, weight-free. */
PetscErrorCode CellKernelPoints(CellKernel, PetscInt np, const PetscReal *xi, const PetscReal *X, const PetscReal *u, const PetscReal *pressure, PetscReal *F, PetscReal *P, PetscReal *W, PetscBool *bad);

/* ---- facets (facet.c): loads on one facet, given by its (p+1)^(dim-1) trace nodes ------------------------------------ */

/* Dead traction: r[node*d+c] = - int t_c N_node dA over the reference facet; traction at quadrature points by callback-free arrays:
   FacetQuadrature gives the reference positions first. All facets use p+2 Gauss points per direction. Axisymmetric: weight 2 pi R (follower: 2 pi r). */
PetscInt       FacetNumPoints(PetscInt dim, PetscInt order);
PetscErrorCode FacetQuadrature(PetscInt dim, Model, PetscInt order, const PetscReal *X, PetscReal *position /* [np][3] */, PetscReal *dA /* [np] weight*area */, PetscReal *normal /* [np][3] unit, not oriented: sign by tangent order */);
PetscErrorCode FacetTraction(PetscInt dim, Model, PetscInt order, const PetscReal *X, const PetscReal *traction /* [np][3] */, PetscReal *residual);
/* Follower pressure p[np] against the outward normal; `side` (+1/-1) makes the normal of the tangent order outward. Residual and exact tangent
   [n*d][n*d] (NULL: skip) at current positions x[n][d]. Small kinematics: call with x = X and no tangent. */
PetscErrorCode FacetPressure(PetscInt dim, Model, PetscInt order, const PetscReal *x, PetscInt side, const PetscReal *pressure, PetscReal *residual, PetscReal *tangent);

/* ---- the bulk of one mesh ------------------------------------------------------------------------------------------------ */

/* Owned cells of one law and order, kept contiguous. */
typedef struct {
  CellKernel kernel; /* owned */
  PetscInt   order, num_cells, n, m, batch; /* nodes and pressure coefficients of a cell; cells per call */
  PetscInt  *cells;            /* owned [num_cells] local cells */
  PetscReal *X;                /* owned [num_cells][n][dim] */
  PetscInt   pressure;         /* first coefficient in the pressure array */
} CellGroup;

/* A facet that carries a load. */
typedef struct {
  PetscInt cell, side, boundary; /* side = 2*direction + (high side) */
} LoadFacet;

struct _p_Mechanics {
  HPSpace              space;    /* borrowed */
  const MechanicsSpec *spec;     /* borrowed */
  const Supports      *supports; /* borrowed */
  PetscInt             dim, num_groups, num_pressure, num_facets;
  CellGroup           *groups;    /* owned */
  PetscInt            *cell_group, *cell_index; /* owned [num_cells] group (-1: rigid) and position in it (-1: ghost) */
  LoadFacet           *facets;    /* owned */
  PetscReal            t;
  PetscReal           *dead;      /* owned local array: dead loads at t, negative as in the residual; NULL: none */
  PetscReal           *linear, *dpressure; /* owned: linearised pressure and derivative of the last tangent; dpressure holds [m][n*dim] cell by cell */
  PetscReal           *work;      /* owned batch buffers */
  PetscInt             work_size;
};

PetscErrorCode MechanicsLoadFacets_Private(Mechanics);
PetscErrorCode MechanicsDeadLoads_Private(Mechanics);
/* Follower pressures: add to r (NULL: skip) and to the sink (NULL: skip). */
PetscErrorCode MechanicsFollowers_Private(Mechanics, const PetscReal u[], PetscReal r[], MatrixSink, void *context);
/* value of an expression times the amplitude; an expression that speaks of t itself takes the amplitude only when one is given. */
PetscErrorCode MechanicsValue_Private(Expression, const Amplitude *, const PetscReal X[3], PetscReal t, PetscReal *value);
