/* Private to estimate. The traction defect of a facet is sum over its sides of (P N - T): a jump inside, P N - T on the boundary.
   It is sampled at Gauss points of the *finest* facets, where both neighbours evaluate their own P: so hanging facets need nothing special. */
#pragma once
#include "estimate.h"

enum { PART_INTERIOR, PART_JUMP, PART_BOUNDARY, PART_CONTACT, PART_VOLUME, NUM_PARTS };

/* How a leaf sees a facet: tangential coordinate k of its side is start[k] + slope[k] * eta[axis[k]], eta in the facet's frame. */
typedef struct {
  PetscInt  cell; /* local cell, -1: nobody, or a rigid body */
  PetscInt  side; /* 2*direction + (high side) */
  PetscInt  axis[2];
  PetscReal start[2], slope[2];
} FacetSide;

typedef struct {
  PetscInt  facet;               /* index from first[dim-1] */
  PetscInt  order;               /* of the trace: the facet entity's */
  PetscInt  first_point, num_1d; /* num_1d^(dim-1) Gauss points from first_point */
  PetscInt  fixed;               /* bits 0..dim-1: prescribed components; bit 3: the normal one */
  uint64_t  groups;              /* boundary groups */
  PetscBool loaded;              /* some group carries a load */
  FacetSide side[2];
} FacetPlace;

/* Facets that touch an owned, deformable cell and are not wholly prescribed. */
typedef struct {
  PetscInt    num, num_points, most_points; /* most_points: at facets of one cell */
  FacetPlace *facets;                       /* owned */
  PetscInt   *cell_first;                   /* owned [num_cells+1] into cell_facet */
  PetscInt   *cell_facet;                   /* owned: 2*facet + side */
} FacetList;

/* Which contact facet a facet of the mesh is, and what presses on this rank's facets; built from the views of the problem. */
typedef struct {
  const ContactView *view;
  PetscBool          bare;           /* it bears nothing, and overlap counts as such: it is not tied, and no gap counts as closed */
  PetscReal         *theta;          /* owned [nonmortar num_facets] share of the dual functions, of the facets as below */
  PetscReal         *z, *normal, *x; /* owned [nonmortar num_nodes], [..][dim]: at the nodes of nonmortar facets of this rank, or that its mortar facets face */
  PetscReal         *traction;       /* owned [nonmortar num_nodes][3] friction in space: on the mortar side; else NULL */
  PetscInt          *facet_place[2]; /* owned [num_facets] facet of the nonmortar, mortar side, or -1 */
  PetscInt          *segment_first;  /* owned [mortar num_facets + 1] */
  ContactSegment    *segments;       /* owned, on mortar facets of this rank, by mortar facet */
  PetscReal (*box)[4];               /* owned, three dimensions: where on the mortar facet to look at each segment: low, high corner */
} ContactTerm;

typedef struct {
  Interface    interface;
  Kinematics   kinematics;
  Model        model;
  PetscInt     num;
  ContactTerm *terms; /* owned */
} ContactTerms;

/* Two surfaces at a point of the interface. Pairs: nonmortar, mortar side. */
typedef struct {
  const ContactSegment *segment;
  PetscReal             xi[2], weight;     /* place on the nonmortar facet; weight times measure there */
  PetscReal             gap, nodal;        /* between the two facets; as the nodes show it, by their functions */
  PetscReal             jump[3];           /* of a tied pair: between the material points, of which gap is the size */
  PetscReal             pressure, trace;   /* by the functions of the nodes, not negative; by the multiplier's functions */
  PetscReal             height;            /* of the mortar side along the middle normal of the nonmortar facet */
  PetscReal             bulge[2], mean[2]; /* what the round surfaces stand out of the facets; its mean over the facet */
} GapPoint;

typedef struct {
  PetscInt  num, most;
  GapPoint *points; /* owned [most] */
} GapPoints;

/* What the sums run over. The caller owns everything but facets, which EstimateBulk_Private makes and frees. */
typedef struct {
  HPSpace              space;
  Mechanics            mechanics;
  const MechanicsSpec *spec;
  const HPTables      *v;
  const ForestTables  *t;
  const ContactTerms  *contact; /* NULL: none */
  PetscReal            time;
  const PetscReal     *u; /* local array of displacement dofs */
  FacetList            facets;
  PetscReal (*defect)[3]; /* [facets.num_points] */
  PetscReal (*normal)[3]; /* [facets.num_points] outward of side 0's cell */
  PetscReal *dA;          /* [facets.num_points] weight times reference area */
  PetscReal *modulus;     /* [facets.num_points] mean of the sides': the weight is the same seen from either side, and a soft neighbour of a hard body is not
                             overestimated */
  PetscReal (*flux)[3];   /* [facets.num_points] cof F N of side 0: what a unit of pressure adds to its traction */
  PetscReal *compliance;  /* [num_owned_cells] of cells whose pressure is one number: what a unit of it adds to eta2 inside; else -1 */
  PetscReal *left;        /* [num_leaves] what flow has left of a cell's stiffness, squared; NULL: nothing can flow (flow.c) */
  PetscReal *eta2;        /* [num_leaves] sums of this rank, as if nothing had flowed: they rank the cells */
  PetscReal (*along)[3];  /* [num_leaves] sums of this rank: eta2 that can be told to come from each axis; NULL: not wanted */
  PetscReal       part[NUM_PARTS], energy; /* part: sums of this rank, with what flow has left of the stiffness: they are what is told */
  EstimateOverlap overlap;                 /* of this rank */
} EstimateSum;

/* Fill space, mechanics, spec, contact, time, u, eta2 and along (zeroed); get this rank's sums. Collective where there is contact. */
PetscErrorCode EstimateBulk_Private(EstimateSum *);

#define ESTIMATE_MOST_1D (MORTISE_MAX_ORDER + 4)
#define ESTIMATE_MOST_NODES ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1))

/* Gauss points of a cell of one order, the derivative of the Lagrange polynomials through them, and what mixed cells need to recover their pressure. */
typedef struct {
  PetscInt   order, n1, num; /* n1 points in each direction */
  PetscReal *xi, *weight;    /* owned [num][dim], [num] */
  PetscReal  D[ESTIMATE_MOST_1D][ESTIMATE_MOST_1D];
  PetscInt   num_functions;                        /* of the recovered pressure; rows of the arrays below are that many rounded up to whole lanes */
  PetscReal *value, *gradient;                     /* owned [num], [num][dim] rows; NULL: not mixed */
  PetscReal *matrix, *solution, *force, *weighted; /* owned, work */
} VolumeTable;

/* Buffers of one cell. */
typedef struct {
  PetscReal *X, *xi, *F, *P, *W, *J, *position, *weight, *g, *R, *S, *recovered; /* S: EstimateInterior_Private */
} CellWork;

/* flow.c: makes left; 1 where it is NULL. Collective. */
PetscErrorCode EstimateFlow_Private(EstimateSum *);
PetscReal      EstimateLeft_Private(const EstimateSum *, PetscInt leaf);
/* recover.c */
PetscErrorCode RecoveryCreate_Private(PetscInt dim, VolumeTable *);
PetscErrorCode RecoveryDestroy_Private(VolumeTable *);
/* Recover the pressure of a mixed cell: adds its share to w->R and to P at the facet points, leaves q at the Gauss points in w->recovered. */
PetscErrorCode EstimateRecover_Private(const EstimateSum *, VolumeTable *, CellWork *w, PetscInt traces, const PetscReal xi[], const PetscReal F[],
                                       PetscReal P[]);
/* direction.c: what of the interior term comes from each axis, S[num][3] being |dP/dxi_d . (grad xi_d)/|grad xi_d||^2; then axes that no jump tells of */
void           EstimateInterior_Private(EstimateSum *, PetscInt leaf, PetscInt num, const PetscReal weight[], const PetscReal S[], PetscReal eta2);
PetscErrorCode EstimateDoubts_Private(EstimateSum *);
/* split.c: directions in which to split each leaf, if it is split at all; split[num_leaves] */
PetscErrorCode EstimateSplits_Private(const Estimate *, const AdaptSpec *, Forest, int8_t split[]);
/* choose.c: which leaves are rather raised than split (split[] becomes 0 there; strategy p: everywhere); then what to do with one far below its share: merge or
   lower */
void           EstimateChoices_Private(const Estimate *, const AdaptSpec *, int8_t split[], int8_t raise[]);
PetscErrorCode EstimateEven_Private(const Estimate *, Forest, int8_t order[]);
void           EstimateLower_Private(const Estimate *, const AdaptSpec *, const ForestTables *, PetscInt leaf, int8_t *coarsen, int8_t *order);
/* decay.c, irregular.c: of this rank's leaves, others stay; after EstimateBulk_Private. The first is not collective, the second is. */
PetscErrorCode EstimateDecay_Private(const EstimateSum *, PetscReal decay[]);
PetscErrorCode EstimateIrregular_Private(const EstimateSum *, int8_t irregular[]);
/* facet.c */
PetscErrorCode FacetListCreate_Private(const EstimateSum *, FacetList *);
PetscErrorCode FacetListDestroy_Private(FacetList *);
/* Components that boundary groups prescribe on a facet (bit 3: the normal one), and whether any of them loads it. */
void FacetConditions_Private(const MechanicsSpec *, uint64_t groups, PetscInt dim, PetscInt *fixed, PetscBool *loaded);
void FacetSidePoint_Private(const FacetSide *, PetscInt dim, const PetscReal eta[], PetscReal xi[3]);
/* jump.c: reference points of a cell's facets, xi[...][dim]; then the defects at them; then the sums */
PetscErrorCode EstimateTracePoints_Private(const EstimateSum *, PetscInt cell, PetscReal xi[]);
PetscErrorCode EstimateTraces_Private(EstimateSum *, PetscInt cell, const PetscReal position[], const PetscReal J[], const PetscReal F[], const PetscReal P[],
                                      PetscReal modulus);
PetscErrorCode EstimateFacets_Private(EstimateSum *, const PetscReal height[][3]);
/* The share of an owned side in the sum over a facet's points of Free(defect)/mu: what eta2 of its leaf has; and Free(defect), as far as it counts. */
PetscReal EstimateFacetWeight_Private(const EstimateSum *, const FacetPlace *, PetscInt side, const PetscReal height[][3]);
PetscReal EstimateFree_Private(const EstimateSum *, const FacetPlace *, PetscInt point, const PetscReal defect[3]);
/* level.c: levels of the pressures of cells of order 1, for which the estimate is least; into defect, eta2 and part. Collective. */
PetscErrorCode EstimateLevels_Private(EstimateSum *, MPI_Comm, const PetscReal height[][3]);
/* contactterm.c */
PetscErrorCode ContactTermsCreate_Private(Problem, ContactTerms *);
PetscErrorCode ContactTermsDestroy_Private(ContactTerms *);
PetscBool      ContactTermsHave_Private(const ContactTerms *, PetscInt facet);
/* Complementarity: int z+ g+ of nodal gaps on the nonmortar facets of owned leaves. */
PetscErrorCode EstimateComplementarity_Private(EstimateSum *);
/* Measure at a place of a nonmortar facet per unit of xi: length or area, axisymmetric: of the revolution. */
PetscReal ContactTermsMeasure_Private(const ContactTerms *, const SurfaceView *, PetscInt facet, const PetscReal xi[2], const PetscReal N[]);
/* Current over reference measure there. */
PetscReal ContactStretch_Private(const ContactTerms *, const SurfaceView *, PetscInt facet, const PetscReal xi[2]);
/* Gap at a node from the weighted gap; PETSC_FALSE where the node, or one that it hangs on, sees next to nothing of this measure. */
PetscBool ContactNodalGap_Private(const ContactView *, PetscInt node, PetscReal measure, PetscReal *gap);
/* gappoint.c: points of a facet from its segments; gapterm.c: overlap, and opening under pressure, from point to point, with the exact geometry. Collective. */
PetscErrorCode GapPointsFind_Private(const EstimateSum *, const ContactTerm *, PetscInt num, const ContactSegment segments[], GapPoints *);
PetscErrorCode EstimateGap_Private(EstimateSum *);
/* (1 - nu^2)/E of a leaf's body, 0: rigid. Size of a facet over the order of its functions. */
PetscReal EstimateCompliance_Private(const EstimateSum *, PetscInt leaf, PetscBool flowed);
PetscReal ContactFacetSize_Private(const SurfaceView *, PetscInt facet);
/* slipterm.c: friction. Collective. */
PetscErrorCode EstimateSlip_Private(EstimateSum *);
/* contactpoint.c: at xi in [-1, 1]^(dim-1) of a facet: functions of its nodes, N[SURFACE_MOST_NODES], length or area per unit of xi from its tangents
   (SurfaceTangents), and nodal positions (or normals) x[num_nodes][dim] interpolated (two dimensions: third component 0) */
void ContactShape_Private(const SurfaceView *, PetscInt facet, const PetscReal xi[2], PetscReal N[]);
/* What the multipliers of a facet's nodes count with in the pressure at a place where its functions are N[]. */
void      ContactPressureShape_Private(const ContactTerm *, PetscInt facet, const PetscReal xi[2], const PetscReal N[], PetscReal V[]);
PetscReal ContactMeasure_Private(const PetscReal tangent[2][3]);
void      ContactPosition_Private(const SurfaceView *, PetscInt facet, const PetscReal x[], const PetscReal N[], PetscReal position[3]);
/* Direction of a nonmortar facet there, of length 1. */
void ContactNormal_Private(const ContactTerm *, PetscBool finite, PetscInt facet, const PetscReal xi[2], const PetscReal N[], PetscReal n[3]);
/* Pressure there, that direction, and the tangential traction on the mortar side. */
PetscReal ContactPressing_Private(const ContactTerm *, PetscBool finite, PetscInt facet, const PetscReal xi[2], PetscReal n[3], PetscReal q[3]);
/* The box of a segment. */
void ContactSegmentBox_Private(const ContactSegment *, PetscReal box[4]);
/* Add the contact traction (per reference area) on a facet at reference position X. */
void ContactTermsTraction_Private(const ContactTerms *, PetscInt facet, const PetscReal X[3], PetscReal T[3]);

/* Calibration of the residual terms (interior, jumps, boundary, contact tractions): with 1 the estimate is 2 to 3 times too large for shear and more for
   compression on every mesh and order (tests/unit/test_estimate_effectivity_serial.c), as the constants of the proofs, 1/12 for a smooth field at p = 1,
   suggest. */
#define ESTIMATE_SCALE (1.0 / 6)

/* From order 3 on times 4/(p+2): with h/p alone the effectivity grows with p, at a corner like 1 + 0.35 p (the known gap of residual estimates in p), on smooth
   fields from 2.1 (p = 2) to 3.1 (6). Orders are weighed against each other where they differ from cell to cell. */
static inline PetscReal EstimateScale_Private(PetscInt order)
{
  return ESTIMATE_SCALE * (order <= 2 ? 1 : 4 / (PetscReal)(order + 2));
}

/* Modulus that answers a residual: shear for mixed cells (their compression is accounted for by the recovered pressure), else the geometric mean of what
   answers shear, mu, and compression, kappa + 4/3 mu: neither kind of field is then far off up to nu = 0.45. */
static inline PetscReal EstimateModulus_Private(const MaterialSpec *material)
{
  return material->mixed ? material->mu : PetscSqrtReal(material->mu * (material->kappa + 4 * material->mu / 3));
}

/* The same for a material far from its reference shape, where a further displacement meets a tangent of the order of |P_iso| |F^-1|, P_iso the isochoric
   stress: 1/2 of it when that is more. At the clamped edge of a free surface a nearly incompressible cell collapses (det F of 0.3 to 0.01 at a Gauss point in
   rubber2d.yml) and P grows like det F^(-5/3): weighed by mu alone, that one cell estimated 10 times the rest and took all the refinement. */
static inline PetscReal EstimateTangent_Private(const MaterialSpec *material, Kinematics kinematics, const PetscReal F[9], const PetscReal P[9])
{
  const PetscReal modulus = EstimateModulus_Private(material), J = Det3(F);
  PetscReal       cofactor[9], product = 0, stress = 0, inverse = 0;

  if (kinematics != KINEMATICS_FINITE) return modulus;
  for (PetscInt k = 0; k < 9; ++k) {
    const PetscInt i1 = (k / 3 + 1) % 3, i2 = (k / 3 + 2) % 3, J1 = (k % 3 + 1) % 3, J2 = (k % 3 + 2) % 3;
    cofactor[k] = F[3 * i1 + J1] * F[3 * i2 + J2] - F[3 * i1 + J2] * F[3 * i2 + J1];
    product += P[k] * F[k];
  }
  for (PetscInt k = 0; k < 9; ++k) {
    stress += PetscSqr(P[k] - product / (3 * J) * cofactor[k]);
    inverse += PetscSqr(cofactor[k] / J);
  }
  return PetscMax(modulus, 0.5 * PetscSqrtReal(stress * inverse));
}
