/* Private to mechanics: cell and facet kernels. They see nodal values only: no mesh, no constraints, no parallelism. */
#pragma once
#include "mechanics.h"
#include <petscblaslapack.h>
#include <petscsf.h>

/* ---- cells (cell.c): residual, tangent and energy of batches of tensor-product cells of one order, law and model ---- */

typedef struct _p_CellKernel *CellKernel;

/* Arrays of one batch of nc cells; n = nodes of a cell, d = dim, m = num_pressure. Node-major: X[c][node][d], lexicographic nodes.
   NULL outputs are skipped. */
typedef struct {
  PetscInt         nc;
  const PetscReal *X; /* [nc][n][d] reference positions */
  const PetscReal *u; /* [nc][n][d] displacements */
  const PetscReal
      *fiber; /* [nc][num_fibers][3][points] of CellKernelFibers; NULL for materials without fibres, and where no energy, residual or tangent is asked */
  const PetscReal *pressure; /* [nc][m] stored pressure coefficients: enter the geometric stiffness only, and with `acts` the residual. NULL: the consistent
                                ones are used. Incompressible: the pressure, never NULL where residual or tangent are asked for */
  PetscBool        acts;     /* residual: that of the stored pressure */
  PetscReal       *energy;   /* [nc] */
  PetscReal       *residual; /* [nc][n*d] dE/du, row node*d + component; a function of u alone unless the stored pressure acts */
  const PetscReal *history;  /* [nc][points][num_history] of laws with history, as the last accepted step left it */
  PetscReal       *trial;    /* [nc][points][num_history] as a step that ended at u would leave it */
  MaterialEdge     edge;     /* for the tangent, and */
  PetscReal        secant;   /* as in MaterialPoints */
  PetscBool        held;     /* trial alone: as in MaterialPoints */
  PetscReal       *tangent;  /* [nc][n*d][n*d] full, symmetric unless the law is not; exact derivative of residual when pressure is NULL or consistent */
  const PetscInt  *place;    /* [n] NULL, or where the nodes stand, inner ones first: then of the symmetric matrix only K[row <= column] are written,
                                rows of inner nodes to inner, and the others' to tangent [nc][nb*d][nb*d], nb = n - num_inner; not with unsymmetric laws */
  PetscInt   num_inner;      /* with place */
  PetscReal *inner;          /* [nc][num_inner*d][n*d] with place */
  PetscReal *consistent;     /* [nc][m] pressure coefficients that u implies: modulus * M^-1 int q g(J); incompressible: int q g(J) */
  PetscReal *mass;           /* [nc][m] int q^2; incompressible only */
  PetscReal *dpressure;      /* [nc][m][n*d] derivative of consistent with respect to u */
  PetscReal *min_det;        /* [nc] smallest det F over the quadrature points */
  PetscReal *stretch2;       /* [nc] largest F:F/3 over the quadrature points */
  PetscBool  bad;            /* out: some det F <= 0 in the batch (finite kinematics), or no answer of the law: outputs of that batch are not to be used */
} CellBatch;

/* Gauss points of a cell in each direction: p+1, from order 6 on one more and for order 8 two, because stresses are no polynomials (docs/results.md,
   convergence in p). */
static inline PetscInt CellLinePoints(PetscInt order)
{
  return order + 1 + PetscMax(0, (order - 4) / 2);
}
#define MOST_LINE_POINTS (MORTISE_MAX_ORDER + 1 + (MORTISE_MAX_ORDER - 4) / 2)

/* Kernel for cells of order p. Mixed (material->mixed): pressure in the complete polynomials of degree p-1 in the
   reference cell (Q_p / P_(p-1) discontinuous; Q1/P0), condensed: energy = int W_iso + modulus/2 int (Proj g(J))^2, where Proj is the L2 projection
   with the reference-volume weight. body_force is not here. Axisymmetric: hoop stretch 1 + u_r/R, weight 2 pi R. Small: F = I + grad u,
   law `linear` on the symmetric gradient. Incompressible (material->incompressible): energy = int W_iso, residual that of int W_iso + pi g(J) with the pressure
   given, tangent its derivative at fixed pressure. */
PetscErrorCode CellKernelCreate(PetscInt dim, Model, Kinematics, PetscInt order, const MaterialSpec *, CellKernel *);
PetscErrorCode CellKernelDestroy(CellKernel *);
void           CellKernelSizes(CellKernel, PetscInt *num_nodes, PetscInt *num_pressure, PetscInt *best_batch);
/* Integration points of a cell, and numbers remembered at each. */
void           CellKernelHistory(CellKernel, PetscInt *num_points, PetscInt *num_history);
PetscErrorCode CellKernelEvaluate(CellKernel, CellBatch *);
/* Weight times reference volume of the integration points of a cell with nodes X[n][d] (axisymmetric: of the full revolution). */
PetscErrorCode CellKernelVolumes(CellKernel, const PetscReal *X, PetscReal *volume);
/* One of nc cells with nodes X[nc][n][d] that is inverted at an integration point, or lies beyond the axis there; -1: none. */
PetscErrorCode CellKernelFindInverted(CellKernel, PetscInt nc, const PetscReal *X, PetscInt *cell);

/* Fibre directions at the integration points of one cell with nodes X[n][dim], which lies in the coarse cell root: num = 3 num_fibers points numbers,
 * [num_fibers][3][points]. */
void           CellKernelNumFibers(CellKernel, PetscInt *num);
PetscErrorCode CellKernelFibers(CellKernel, PetscInt root, const PetscReal *X, PetscReal *fiber);

/* Point values for output and estimation at given reference points xi[np][dim] of one cell of the coarse cell root with nodes X, u ([n][dim]) and pressure
   coefficients (mixed, else NULL; P then has the pressure field's volumetric part). Laws with history know their stress at the integration points alone, from
   history[points][num_history] (else NULL): elsewhere the Kirchhoff stress and W are the polynomials through these. */
PetscErrorCode CellKernelPoints(CellKernel, PetscInt root, PetscInt np, const PetscReal *xi, const PetscReal *X, const PetscReal *u, const PetscReal *pressure,
                                const PetscReal *history, const PointValues *, PetscBool *bad);

/* ---- facets (facet.c): loads on one facet, given by its (p+1)^(dim-1) trace nodes ------------------------------------ */

/* Dead traction: r[node*d+c] = - int t_c N_node dA over the reference facet; traction at quadrature points by callback-free arrays:
   FacetQuadrature gives the reference positions first. All facets use p+2 Gauss points per direction. Axisymmetric: weight 2 pi R (follower: 2 pi r). */
PetscInt       FacetNumPoints(PetscInt dim, PetscInt order);
PetscErrorCode FacetQuadrature(PetscInt dim, Model, PetscInt order, const PetscReal *X, PetscReal *position /* [np][3] */, PetscReal *dA /* [np] weight*area */,
                               PetscReal *normal /* [np][3] unit, not oriented: sign by tangent order */);
PetscErrorCode FacetTraction(PetscInt dim, Model, PetscInt order, const PetscReal *X, const PetscReal *traction /* [np][3] */, PetscReal *residual);
/* Follower pressure p[np] against the outward normal; `side` (+1/-1) makes the normal of the tangent order outward. Residual and exact tangent
   [n*d][n*d] (NULL: skip) at current positions x[n][d]. Small kinematics: call with x = X and no tangent. */
PetscErrorCode FacetPressure(PetscInt dim, Model, PetscInt order, const PetscReal *x, PetscInt side, const PetscReal *pressure, PetscReal *residual,
                             PetscReal *tangent);

/* ---- supports of a node (prescribe.c) ------------------------------------------------------------------------------------- */

/* Directions prescribed at one node so far: orthonormal, displacements along them, who asked for each (an index of a boundary, -2 - body of a rigid body) and
   for which, of which the earlier ones were taken off. What adds no direction must agree with those before: the pair that disagrees the most, the direction of
   the later one, what the earlier ones give along it and what it asks. */
typedef struct {
  PetscInt  num;
  PetscReal direction[3][3], value[3], wish[3][3];
  PetscInt  cause[3], rivals[2];
  PetscReal along[3], given, asked;
} NodeSupport;

/* Someone asks for a displacement along a unit direction. */
void MechanicsAsk_Private(PetscInt dim, const PetscReal direction[3], PetscReal value, PetscInt cause, NodeSupport *);
/* All that boundaries ask at a node; time NULL: 0 along each direction. normal[num_boundaries] of Supports. */
PetscErrorCode MechanicsNodeSupport_Private(const MechanicsSpec *, const PetscReal normal[][3], const HPTables *, const ForestTables *, PetscInt node,
                                            const PetscReal *time, NodeSupport *);
/* support.c. The forces r (local array) of node n, Cartesian, by who holds it: force[k] of the k-th in NodeSupport, along what it asked for, for no support
   bears what it does not hold; of a rigid body all of it. */
PetscErrorCode MechanicsNodeForces_Private(Mechanics, PetscInt n, const PetscReal r[], NodeSupport *, PetscReal force[3][3]);

/* ---- the bulk of one mesh ------------------------------------------------------------------------------------------------ */

/* Owned cells of one law and order, kept contiguous. */
typedef struct {
  CellKernel          kernel;                        /* owned */
  const MaterialSpec *material;                      /* borrowed */
  PetscInt            order, num_cells, n, m, batch; /* nodes and condensed pressure coefficients of a cell; cells per call */
  PetscInt            num_unknown;                   /* pressure unknowns of a cell: of incompressible material, which has no condensed ones */
  PetscInt           *cells;                         /* owned [num_cells] local cells */
  PetscReal          *X;                             /* owned [num_cells][n][dim] */
  PetscInt            num_fibers;                    /* numbers that describe the fibres of a cell */
  PetscReal          *fiber;                         /* owned [num_cells][num_fibers] */
  PetscReal          *noise2, *drift2;               /* owned [num_cells] shares in those of MechanicsStatus for F = I */
  PetscInt            pressure;                      /* first coefficient in the pressure array */
  PetscInt            history, h, num_points;        /* first number in the history array; numbers at a point; integration points of a cell */
  PetscInt            num_inner;                     /* nodes inside a cell */
  PetscInt           *place, *outer;                 /* owned [n] where each node stands when the inner ones come first; [n - num_inner] the others */
  PetscReal          *factor;                        /* owned [num_cells][num_inner*dim][n*dim] condense.c; NULL: no condensation */
  PetscReal          *inner;                         /* owned [num_cells][num_inner*dim] forces of the inner nodes, solved for */
  PetscReal          *volume;                        /* owned [num_cells][num_unknown][n*dim] derivative of int q g(J) at the last tangent */
  PetscBLASInt       *pivot;                         /* owned [num_cells][num_inner*dim] of LDL^T; first 0: Cholesky */
} CellGroup;

#define MOST_PRESSURES ((MORTISE_MAX_ORDER * (MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 2)) / 6) /* coefficients of a cell */

/* Numbers that cells carry (numbers.c). */
typedef struct {
  PetscInt   num;    /* of owned cells */
  PetscInt  *place;  /* owned [num_cells] where those of a cell, ghosts too, start */
  PetscReal *values; /* owned: own cells group after group, then ghosts */
  PetscSF    ghosts; /* owned: their numbers from their owners; NULL: not created */
} CellNumbers;

/* A facet that carries a load. */
typedef struct {
  PetscInt cell, side, boundary; /* side = 2*direction + (high side) */
  PetscInt pressure;             /* place of its values among Mechanics.pressures, -1: it has none there */
} LoadFacet;

/* A load as the scene gives it; both borrowed. */
typedef struct {
  Expression       expression;
  const Amplitude *amplitude;
} LoadExpression;

#define MOST_FACET_NODES ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1))
#define MOST_FACET_POINTS ((MORTISE_MAX_ORDER + 2) * (MORTISE_MAX_ORDER + 2))

struct _p_Mechanics {
  HPSpace              space;    /* borrowed */
  const MechanicsSpec *spec;     /* borrowed */
  const Supports      *supports; /* borrowed */
  PetscInt             dim, num_groups, num_pressure, num_facets;
  CellGroup           *groups;                  /* owned */
  PetscInt            *cell_group, *cell_index; /* owned [num_cells] group (-1: rigid) and position in it (-1: ghost) */
  LoadFacet           *facets;                  /* owned */
  PetscReal           *pressures;               /* owned: follower pressures that depend on the place, at t, at the points of the facets that carry them */
  PetscReal (*free_motion)[6];                  /* owned [num_bodies] translation and rotation vector that forces bring about; NULL: none do */
  PetscInt   num_controls, *control;            /* owned: boundaries whose pressure is found */
  PetscReal *control_pressure;                  /* owned [num_controls] */
  PetscReal  t;
  PetscReal *dead;                     /* owned local array: dead loads at t, negative as in the residual; NULL: none */
  PetscReal *linear, *dpressure;       /* owned: linearised pressure and derivative of the last tangent; dpressure holds [m][n*dim] cell by cell */
  PetscReal *free_share;               /* owned [num_owned_cells] diagonal of cells of unsupported bodies relative to their stiffness, else 0 */
  PetscReal  free_part;                /* part of it that counts */
  PetscReal  viscosity, *viscous_from; /* rate, 0: none; owned local array: displacements it counts from */
  PetscReal *viscous_room;             /* owned: room for a cell's displacements, twice */
  PetscReal *hold;                     /* owned [num_bodies][9], see MechanicsGetHold */
  PetscInt  *body_group;               /* owned [num_bodies], see MechanicsGetHold */
  PetscBool *held;                     /* owned [num_bodies], see MechanicsIsHeld */
  PetscReal *work;                     /* owned batch buffers */
  PetscInt   work_size;
  PetscReal *condense_work; /* owned: condense.c */
  PetscInt   num_negative;  /* eigenvalues of the blocks eliminated at the last tangent */

  /* incompressible.c: pressure unknowns of local cells, owned ones first */
  PetscInt  *unknown_first; /* owned [num_cells+1] */
  PetscReal *pressure;      /* owned [unknowns] as set from outside */
  PetscReal *volume, *mass; /* owned [unknowns of owned cells] rows at the last residual; int q^2 */
  PetscReal *volume_scale;  /* owned [num_owned_cells] E / h: what turns int q g(J) into a force */

  /* history.c */
  CellNumbers  stored;     /* element pressures that are condensed, as MechanicsStorePressure took them; no ghosts: there are none */
  PetscBool    has_stored; /* it did */
  CellNumbers  history;    /* as the last accepted step left it; no ghosts: no law has any */
  MaterialEdge edge;       /* for the tangent, and */
  PetscReal    secant;     /* as in MaterialPoints */
};

/* History of the cells of a group from position `first` on; NULL: its law has none. */
static inline const PetscReal *MechanicsBatchHistory_Private(Mechanics m, const CellGroup *g, PetscInt first)
{
  return g->h ? m->history.values + g->history + first * g->num_points * g->h : NULL;
}
/* What round-off of F is multiplied by in nodal forces: where the pressure is given the bulk modulus has no part in it. */
static inline PetscReal MechanicsNoiseModulus_Private(const MaterialSpec *material, PetscBool given)
{
  return (given || material->incompressible ? MaterialYoung(material) : material->kappa) + 4. / 3 * material->mu;
}
PetscErrorCode MechanicsLoadFacets_Private(Mechanics);
PetscErrorCode MechanicsDeadLoads_Private(Mechanics);
/* loadmoment.c: values at the points of a facet, nodes trace[n][dim], that stand for a load which depends on the place. */
PetscErrorCode MechanicsLoadMoments_Private(PetscInt dim, PetscInt order, const PetscReal trace[], const LoadExpression *, PetscReal t, PetscReal value[]);
/* Sign that makes the normal of the tangent order (edge tangent; first x second tangent) of a cell's side point outward. */
PetscInt MechanicsOutwardSign_Private(PetscInt side);
/* Nodes[MOST_FACET_NODES] of a facet by their place in the cell, and their reference positions X[..][dim]; returns their number. */
PetscInt MechanicsTrace_Private(Mechanics, const LoadFacet *, PetscInt nodes[], PetscReal X[]);
/* control.c */
PetscErrorCode MechanicsControlsCreate_Private(Mechanics);
/* condense.c: eliminate the nodes inside cell i of the group, whose matrix stands in the group's factor and in K[nb*dim][nb*dim], nb nodes of group->outer,
   as CellBatch with place and inner = factor leaves it. K becomes what is left, full. *singular: it cannot be done. */
PetscErrorCode MechanicsCondenseDestroy_Private(Mechanics);
PetscErrorCode MechanicsCondenseCell_Private(Mechanics, CellGroup *, PetscInt i, PetscReal K[], PetscBool *singular);
/* numbers.c: size[num_groups] numbers of each cell, 0 at first. Collective. */
PetscErrorCode CellNumbersCreate_Private(Mechanics, const PetscInt size[], CellNumbers *);
/* Take those of owned cells, ghosts get theirs; nothing where not created. Collective. */
PetscErrorCode CellNumbersSet_Private(CellNumbers *, const PetscReal own[]);
PetscErrorCode CellNumbersDestroy_Private(CellNumbers *);
/* pressure.c: room for those that are stored. Collective. */
PetscErrorCode MechanicsStoredCreate_Private(Mechanics);
/* history.c: layout and initial values. Collective. */
PetscErrorCode MechanicsHistoryCreate_Private(Mechanics);
/* viscous.c: forces at displacements u[n][dim] of cell i of the group, added to r; their derivatives, to the cell's matrix as integrate.c has it. */
PetscErrorCode MechanicsViscousForces_Private(Mechanics, const CellGroup *, PetscInt i, const PetscReal u[], PetscReal r[]);
void           MechanicsViscousMatrix_Private(Mechanics, const CellGroup *, PetscInt i, PetscInt num_inner, PetscReal inner[], PetscReal K[]);
/* free.c: free_share. Collective. */
PetscErrorCode MechanicsFreeBodies_Private(Mechanics);
/* incompressible.c: after the groups. */
PetscErrorCode MechanicsUnknownsCreate_Private(Mechanics);
PetscErrorCode MechanicsUnknownsDestroy_Private(Mechanics);
/* Pressures of num cells of the group from the i-th on, as the kernel wants them; their int q g(J) into the rows, the largest of
   int q g(J) / int q^2 among them. */
void MechanicsUnknownsGather_Private(Mechanics, const CellGroup *, PetscInt i, PetscInt num, PetscReal pressure[]);
void MechanicsUnknownsRows_Private(Mechanics, const CellGroup *, PetscInt i, PetscInt num, const PetscReal constraint[], PetscReal *largest);
/* Follower pressures: add to r (NULL: skip) and to the sink (NULL: skip). */
PetscErrorCode MechanicsFollowers_Private(Mechanics, const PetscReal u[], PetscReal r[], MatrixSink, void *context);

/* ---- inside the cell kernel (cell.c, cellfield.c, cellpressure.c, celltangent.c): NUM_LANES cells at a time, one in each lane ---- */

#define INLINE static inline __attribute__((always_inline, unused))

/* Shapes: n nodes (n1 = p+1 along a line), q points (q1), d = dim, r = num_derivatives (d; with hoop strain 3, the third "derivative" being the value itself),
   m pressures. Nodal fields are stored by component, [d][n]; point fields [..][q]. Points form slabs (a 3-D layer): F, W, P hold slab after slab,
   [slab][9][points of a slab]. */
struct _p_CellKernel {
  PetscInt       dim, order, n1, q1, num_nodes, num_points, num_pressure, num_derivatives, num_slabs, slab_points;
  PetscBool      small, mixed, incompressible, hoop, unsymmetric;
  MaterialSpec   material; /* a copy; the linear law in small kinematics */
  const Basis1D *basis;
  PetscReal     *weight;                        /* owned [q] quadrature weights */
  PetscReal     *legendre;                      /* owned [q][m] pressure functions */
  PetscReal     *pairs;                         /* owned [n1][n1][2][2][q1]: products of (value | derivative) of functions a and b at the 1-D points */
  void          *arena;                         /* owned: memory of all lanes below */
  Lanes         *X, *u;                         /* [d][n] */
  Lanes         *gradient;                      /* [d][r][q] by reference coordinates; later fluxes of the same shape */
  Lanes         *layer;                         /* [3][n1][q1*q1] scratch of the tensor contractions in space */
  Lanes         *inverse;                       /* [d*d][q] d xi_r / d X_J */
  Lanes         *hoop_inverse;                  /* [q] 1/R */
  Lanes         *volume;                        /* [q] weight times reference volume */
  Lanes         *F, *P, *W, *A;                 /* [9], [9], [1] over all points; A: [81] over one slab */
  Lanes         *fiber;                         /* [num_fibers][3] over all points */
  Lanes         *measure;                       /* [4][q] J-1, g, g', g'' */
  Lanes         *history, *trial;               /* [num_history] over all points, slab after slab like F */
  Lanes         *mass;                          /* [m][m] Cholesky factor of the pressure mass matrix */
  Lanes         *moment, *coefficient, *stored; /* [m] int q g; consistent and stored pressure coefficients */
  Lanes         *coupling;                      /* [m][d][n] b, then L^-1 b */
  Lanes         *reference_tangent;             /* [d*d][r*r][q] A pulled back to reference coordinates, times volume */
  Lanes         *layer_tangent;                 /* [d*d][r*r][q1*q1] */
  Lanes         *tile;                          /* [n1*d][n1*d] */
};

/* CALL(nodes, points of a line) for the order of a kernel: constants for the usual orders, so that loops unroll. */
#define CELL_OF_ORDER(k, CALL)                                                                                                                                 \
  switch ((k)->order) {                                                                                                                                        \
  case 1:                                                                                                                                                      \
    CALL(2, CellLinePoints(1));                                                                                                                                \
    break;                                                                                                                                                     \
  case 2:                                                                                                                                                      \
    CALL(3, CellLinePoints(2));                                                                                                                                \
    break;                                                                                                                                                     \
  case 3:                                                                                                                                                      \
    CALL(4, CellLinePoints(3));                                                                                                                                \
    break;                                                                                                                                                     \
  case 4:                                                                                                                                                      \
    CALL(5, CellLinePoints(4));                                                                                                                                \
    break;                                                                                                                                                     \
  case 5:                                                                                                                                                      \
    CALL(6, CellLinePoints(5));                                                                                                                                \
    break;                                                                                                                                                     \
  case 6:                                                                                                                                                      \
    CALL(7, CellLinePoints(6));                                                                                                                                \
    break;                                                                                                                                                     \
  default:                                                                                                                                                     \
    CALL((k)->n1, (k)->q1);                                                                                                                                    \
  }

/* cellfield.c */
PetscInt CellKernelGeometry_Private(CellKernel); /* X -> inverse, volume, hoop_inverse; a lane with a volume that is not positive, -1: none */
void     CellKernelDeformation_Private(CellKernel, Lanes *min_det);                         /* u -> F, measure[0] when mixed */
void     CellKernelFlux_Private(CellKernel, Lanes *flux);                                   /* P -> flux [d][r][q] */
void     CellKernelIntegrate_Private(CellKernel, const Lanes *flux, Lanes *result);         /* [d][r][q] -> [d][n] */
void     CellKernelPullBack_Private(CellKernel, PetscInt q, const Lanes T[9], Lanes *flux); /* flux [d][r][q] at q of a stress-like T, times volume */
/* cellpressure.c */
void CellKernelProject_Private(CellKernel);                                                     /* measure -> mass, moment, coefficient */
void CellKernelAddPressure_Private(CellKernel, const Lanes *coefficient);                       /* P += pi g' cof */
void CellKernelAddPressureTangent_Private(CellKernel, PetscInt slab, const Lanes *coefficient); /* A += pi (g'' cof (x) cof + g' dcof/dF) */
void CellKernelCouple_Private(CellKernel, PetscInt num_cells,
                              PetscReal *dpressure); /* coupling; dpressure [num_cells][m][n*d] unless NULL, incompressible: of int q g */
/* celltangent.c */
void CellKernelTangentSlab_Private(CellKernel, PetscInt slab); /* A of a slab -> reference_tangent */
/* reference_tangent, coupling -> tangent of cells first .. first+num-1 of the batch */
void CellKernelTangent_Private(CellKernel, const CellBatch *, PetscInt first, PetscInt num);

/* cof F = J F^-T. */
INLINE void CellCofactor(const Lanes F[9], Lanes cof[9])
{
  for (int k = 0; k < 9; k++) {
    const int i1 = (k / 3 + 1) % 3, i2 = (k / 3 + 2) % 3, J1 = (k % 3 + 1) % 3, J2 = (k % 3 + 2) % 3;

    cof[k] = F[3 * i1 + J1] * F[3 * i2 + J2] - F[3 * i1 + J2] * F[3 * i2 + J1];
  }
}
