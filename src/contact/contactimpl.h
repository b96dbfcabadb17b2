/* Private to contact. Along a nonmortar edge (nodes 0, 1) the parameter is lambda = N_1 in [0, 1] (xi = 2 lambda - 1), N_0 = 1 - lambda.

   Variables. Everything on one edge is first a function of y = (x_0, x_1, n_0, n_1, mortar nodes): positions and *nodal normals* count as
   independent. Only at the end of the edge do the normals become functions of the nodes (x_0, x_1 and the two outer neighbours). One segment sees 16
   of these numbers:   0 x_0   2 x_1   4 n_0   6 n_1   8 c   10 d   12 foreign bound 0   14 foreign bound 1
   where (c, d) is its mortar edge; foreign bounds exist only where mortar edges overlap in the nonmortar edge's view (fold rule, segment.c).

   Half form. A symmetric H is kept as W with H = W + W^T: one outer product a b^T instead of two, symmetrised once per edge. */
#pragma once
#include "contact.h"

/* Gauss points per segment. The integrand is (hats)^2 times g = A |n| / B, A and B linear and |n|^2 quadratic in lambda. Where both nodal normals agree
   g is linear and 3 points would be exact (4 axisymmetric); 5 leave an error below 1e-9 of the gap for normals 0.35 rad apart (test_contact_gap). */
#define CONTACT_GAUSS 5
#define CONTACT_SNAP 5e-10     /* in lambda, 1e-9 in xi: bounds this close to an edge's end are that end, and do not move */
#define CONTACT_OPPOSE 0.3     /* search keeps pairs with N_s . N_m < -0.3 */
#define CONTACT_GRAZE 1e-4     /* evaluation: rays that meet a mortar edge at a flatter angle (cosine) do not see it */
#define CONTACT_SINGULAR 1e-13 /* det D2 / (tr D2)^2 of an edge that is too little covered to have a dual basis */
#define CONTACT_FOLDED 1e-6    /* |sum of unit edge normals| below which a node has no normal */
#define CONTACT_LOCAL 16       /* numbers a segment sees */
#define CONTACT_PAIRS (3 * CONTACT_GAUSS + 2)
#define CONTACT_MOMENTS 5 /* q = (m00, m01, m11, G0, G1), see mortar.c */

/* A nonmortar edge in current configuration. */
typedef struct {
  PetscReal x[2][2], n[2][2]; /* nodes and their unit normals */
  PetscReal dx[2], dn[2];     /* x_1 - x_0, n_1 - n_0 */
  PetscReal length;
  PetscReal ring; /* 2 pi when axisymmetric (measure 2 pi r dgamma, r = first coordinate), else 0 (measure dgamma) */
} EdgeFrame;

/* Part of a nonmortar edge that sees one mortar edge. */
typedef struct {
  PetscInt  mortar_facet;
  PetscReal lambda[2]; /* lambda[0] < lambda[1] */
  PetscInt  bound[2];  /* mortar node on whose ray the bound lies; -1: the edge's own end, fixed */
  PetscInt  local[4];  /* places of c, d, bound[0], bound[1] in the edge's list of mortar nodes (-1: none) */
} Segment;

/* The same with positions, as the integrals want it. */
typedef struct {
  PetscReal c[2], d[2], e[2]; /* mortar edge, e = d - c */
  PetscReal lambda[2];
  PetscReal m[2][2];  /* positions of the bound nodes */
  PetscInt  place[2]; /* where bound node's position stands among the 16 numbers; -1: bound fixed */
} SegmentGeometry;

/* The gap and its first derivatives at one point of the nonmortar edge. */
typedef struct {
  PetscReal N[2], x[2], n[2];               /* hats, position, interpolated normal */
  PetscReal A, B, R;                        /* (c - x) x e, n x e, |n|: ray parameter s = A / B, gap g = s |n| */
  PetscReal g, gA, gB, gR;                  /* gap and its derivatives by A, B, R */
  PetscReal Al, Bl, Rl, gl;                 /* by lambda */
  PetscReal dA[12], dB[12], dR[12], dg[12]; /* by x_0, x_1, n_0, n_1, c, d */
} GapPoint;

/* Second derivatives of a sum over points, gathered as outer products plus the sparse second derivatives of A, B, R. */
typedef struct {
  PetscInt  num;
  PetscReal left[CONTACT_PAIRS][CONTACT_LOCAL], right[CONTACT_PAIRS][CONTACT_LOCAL];
  PetscReal A, AN[2], BN[2], RNN[4][4];
} HessianSum;

/* Nodal normal and its derivatives by (previous node, node, next node). */
typedef struct {
  PetscReal n[2], d[2][6], dd[2][6][6];
} NormalDerivative;

/* Bounding-volume tree over mortar facets: node i's children are child[i], child[i] + 1; leaves hold item[first .. first + count). In two dimensions the third
   extent is [0, 0]. */
typedef struct {
  PetscReal box[6]; /* xmin, ymin, zmin, xmax, ymax, zmax */
  PetscInt  first, count, child;
} TreeNode;
typedef struct {
  PetscInt  num;
  TreeNode *node;      /* owned */
  PetscInt *item;      /* owned */
  PetscReal (*box)[6]; /* owned, [num items] */
} Tree;

#define TREE_DEPTH 128 /* of a stack for a walk through it; median splits need log2(items) + 1 */

/* Of the last evaluation in the general form (result.c): positions and multipliers (loaded: they were given). */
typedef struct {
  PetscBool  stands, loaded;
  PetscReal *x[2], *z; /* owned */
  PetscInt   size_x[2], size_z;
} ContactState;

/* Which functions a facet of higher order had last, and how often it has gone back to those of a covered one (cover.c). */
typedef struct {
  PetscBool known, whole;
  PetscInt  returns;
} ContactCoverage;

typedef struct _p_RayWork *RayWork;

struct _p_ContactPair {
  PetscInt                  dim;
  PetscBool                 axisymmetric, node_to_segment, standard, continuous;
  PetscBool                 rays;           /* the last search was for rays along a continuous direction */
  PetscBool                 held;           /* directions do not vary */
  PetscBool                 lines_held;     /* forces without the motion of any line of the mortar side */
  PetscInt                  num_degenerate; /* overlaps of the last evaluation that could not be used */
  struct ContactMultiplier *multiplier;     /* functions of facets of higher order, else NULL */
  const PetscReal          *softness;       /* borrowed; NULL: no compliance */
  RayWork                   ray;            /* rays along a continuous direction: work space, NULL until needed */
  /* topology of the nonmortar side, from the last search: neighbours of a node along the surface, -1: none */
  PetscInt  num_nodes, num_facets, num_mortar_nodes, num_mortar_facets;
  PetscInt *prev, *next; /* owned, [num_nodes] */
  /* candidates: mortar edges of listed edge i are candidate[start[i] .. start[i+1]), ascending */
  PetscInt         num_listed, *listed, *start, *candidate, size_candidate; /* owned */
  ContactCoverage *coverage;                                                /* owned, [num_facets], since the last ContactPairForget; rays only */
  PetscReal        distance, margin;
  PetscReal        depth;   /* of overlaps that are looked for */
  ContactHull      hull;    /* borrowed; NULL: thicknesses are not known */
  PetscReal        untold;  /* by the last search */
  PetscReal        deepest; /* overlap between its parts that can be told; 0: the search distance */
  const PetscInt  *part[2]; /* borrowed: of the facets of both sides */
  /* results of the last evaluation, all owned; sizes only grow */
  PetscReal      *normal; /* [num_nodes][2] */
  PetscInt        num_segments, size_segments;
  Segment        *segment;
  ContactSegment *output;
  PetscInt       *first_segment;                        /* [num_listed + 1] */
  PetscInt       *first_node;                           /* [num_listed + 1] into node */
  PetscInt        num_local, size_local, *node;         /* mortar nodes that listed edges meet */
  PetscInt        num_results, num_ids, size_ids, *ids; /* ids: storage behind ContactFacet.nodes */
  ContactFacet   *result;                               /* [num_listed] */
  PetscInt       *slot, size_slot;                      /* [num_results] places of their facets in the list; general form */
  ContactState    state;
  PetscReal      *real; /* storage behind dgap, dweight, hessian */
  PetscInt        size_real;
  PetscReal      *work; /* one edge's sums */
  PetscInt        size_work;
};

static inline PetscReal Cross2(const PetscReal a[2], const PetscReal b[2])
{
  return a[0] * b[1] - a[1] * b[0];
}
static inline PetscReal Dot2(const PetscReal a[2], const PetscReal b[2])
{
  return a[0] * b[0] + a[1] * b[1];
}

/* Is the position of a node of the surface known here? */
static inline PetscBool ContactHas(const ContactSurface *s, PetscInt node)
{
  return (PetscBool)(!s->has || s->has[node]);
}

/* Make room for num entries of *array, *size are there; contents are kept. */
PetscErrorCode ContactGrow(PetscInt num, size_t entry, PetscInt *size, void *array);

/* search.c */
PetscErrorCode ContactTreeBuild(PetscInt num, PetscReal (*box)[6], Tree *);
PetscErrorCode ContactTreeDestroy(Tree *);
PetscInt       ContactTreeQuery(const Tree *, const PetscReal box[6], PetscInt max, PetscInt items[]);

/* Nodes that shape a facet: its corners, or its lattice; returns their number. */
PetscInt ContactFacetNodes(const ContactSurface *, PetscInt facet, const PetscInt **node);

/* hull.c: from x, inside or on a facet of this part of the bodies, along the unit vector d to where the ray leaves the part; most: not before. x, d: [dim],
   reference positions. */
PetscReal ContactHullAcross(ContactHull, PetscInt part, const PetscReal x[], const PetscReal d[], PetscReal most);
/* A side of a part near a place: its distance, its unit normal; reference positions. */
typedef struct {
  PetscReal distance, N[3];
} HullSide;
/* Facets of the part closer to x than the radius that run along the direction d rather than across it, at most `most`. Returns their number. */
PetscInt ContactHullBeside(ContactHull, PetscInt part, const PetscReal x[], const PetscReal d[], PetscReal radius, PetscInt most, HullSide side[]);
/* behind.c. A facet by its corners: now and at the reference positions, axes (the last one the outward normal); of a nonmortar facet, the unit directions of
   its rays. */
typedef struct {
  PetscInt  dim, nv;
  PetscReal x[4][3], X[4][3], axis[3][3], axis0[3][3], d[4][3];
} FacetCorners;

/* Once for a nonmortar facet, nothing where the pair knows no hull. */
void ContactCorners(ContactPair, const ContactSurface *nonmortar, PetscInt facet, FacetCorners *);
/* Does the mortar facet lie behind the nonmortar one and both bodies, or did the bodies come to overlap another way? */
PetscBool ContactBehind(ContactPair, PetscInt facet, const FacetCorners *nonmortar, const ContactSurface *mortar, PetscInt other);

/* normal.c */
PetscErrorCode ContactTopologyBuild(ContactPair, const ContactSurface *);
PetscErrorCode ContactNormalsBuild(ContactPair, const ContactSurface *, PetscBool *failed);
void           ContactNormalDerivative(ContactPair, const ContactSurface *, PetscInt node, NormalDerivative *);
void           ContactFrame(ContactPair, const ContactSurface *, PetscInt edge, EdgeFrame *);

/* segment.c */
PetscReal      ContactRaySide(const PetscReal x[2], const PetscReal n[2], const PetscReal m[2]);
PetscReal      ContactGapAt(const EdgeFrame *, const PetscReal c[2], const PetscReal d[2], PetscReal lambda, PetscReal *cosine, PetscReal *tau);
PetscBool      ContactSegmentBuild(const EdgeFrame *, const ContactSurface *mortar, PetscInt mortar_facet, Segment *);
PetscErrorCode ContactSegmentsBuild(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar);
PetscErrorCode ContactSegmentsPush(ContactPair, PetscInt edge, const EdgeFrame *, const ContactSurface *mortar, const Segment *);

/* integral.c */
void ContactPointGap(const EdgeFrame *, const SegmentGeometry *, PetscReal lambda, PetscBool derivatives, GapPoint *);
void ContactHessianClear(HessianSum *);
void ContactHessianPoint(const EdgeFrame *, const GapPoint *, const SegmentGeometry *, PetscReal weight, PetscReal ring_weight, HessianSum *);
void ContactHessianFinish(const HessianSum *, PetscReal W[CONTACT_LOCAL][CONTACT_LOCAL]);
void ContactSegmentMoments(const EdgeFrame *, const SegmentGeometry *, PetscReal centre, PetscReal half, PetscBool derivatives, PetscReal q[CONTACT_MOMENTS],
                           PetscReal dq[CONTACT_MOMENTS][CONTACT_LOCAL], PetscReal *min_gap);
void ContactSegmentHessian(const EdgeFrame *, const SegmentGeometry *, PetscReal centre, PetscReal half, const PetscReal phi[CONTACT_MOMENTS],
                           PetscReal W[CONTACT_LOCAL][CONTACT_LOCAL]);

/* chain.c: one edge's derivatives from y to node positions */
typedef struct {
  PetscInt         num_y, num_u; /* 8 + 2 mortar nodes; 2 nodes of the result */
  PetscInt         column[8];    /* place of x_0, x_1, x_previous, x_next components in the result; -1: no such node */
  PetscReal        dn[4][8];     /* normals (n_0, n_1) by those 8 numbers */
  NormalDerivative normal[2];
} EdgeChain;
void ContactChainBuild(ContactPair, const ContactSurface *, PetscInt edge, PetscInt num_mortar, EdgeChain *, PetscInt nodes[], PetscInt *num);
void ContactChainGradient(const EdgeChain *, const PetscReal y[], PetscReal u[]);
void ContactChainHessian(const EdgeChain *, const PetscReal gradient[], const PetscReal W[], PetscReal H[]);
void ContactScatter(const PetscInt local[4], PetscInt num_y, const PetscReal w[CONTACT_LOCAL][CONTACT_LOCAL], PetscReal W[]);
void ContactScatterVector(const PetscInt local[4], const PetscReal v[CONTACT_LOCAL], PetscReal y[]);
void ContactLengthDerivative(const EdgeFrame *, PetscReal dL[4], PetscReal ddL[4][4]);
void ContactGeometry(const ContactSurface *mortar, const Segment *, SegmentGeometry *);

/* mortar.c, nts.c: fill one result; *use PETSC_FALSE: the edge contributes nothing */
typedef struct {
  ContactPair           pair;
  const ContactSurface *nonmortar, *mortar;
  const PetscReal      *z;
  const PetscBool      *wanted;
  PetscBool             derivatives, hessian;
  PetscBool             again; /* the positions of the last evaluation, whose results are completed */
} EvaluateContext;

/* again.c. Are these the positions of the last evaluation, and its multipliers? */
PetscBool      ContactStateStands(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar);
PetscBool      ContactStateLoads(ContactPair, const PetscReal z[]);
PetscErrorCode ContactStateKeep(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[]);
PetscErrorCode ContactStateDestroy(ContactPair);

void           ContactMortarEdge(const EvaluateContext *, PetscInt slot, ContactFacet *, PetscBool *use);
void           ContactNodeEdge(const EvaluateContext *, PetscInt slot, ContactFacet *, PetscBool *use);
PetscErrorCode ContactNodeHitsBuild(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar);
