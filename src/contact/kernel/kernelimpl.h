/* Private to contact, the kernel: gaps along a direction that is continuous over the nonmortar surface, for facets of any order in two and three dimensions.

   Facet. Position x(xi) = sum N_a x_a on the Gauss-Lobatto lattice, tangents t_k = x,k, n = t_1 x t_2 (plane: t_2 = e_z). Directions d_v at corners are means
   of facet vectors (direction.c), d(xi) their multilinear interpolation. Ray: x(xi) + s d(xi) = x_m(eta). Gap density g = s d.n per dxi: (x_m - x).n, so that
   where both surfaces coincide the forces are z n whatever d is; where a length counts as closed, linear on the facet, g = (s - closed / |d|) d.n.
   Axisymmetric: times 2 pi r.

   Chart. Integration is over a constant plane picture of the facet, Y(xi) multilinear: corners of the reference facet (plane: the square, Y = xi). Mortar
   facets are seen in it by the images of their corners, joined by straight lines: neighbours share images, so they tile the chart. Points of the plane problem
   have Y_2 = 0; polygons are then strips over an interval.

   Numbers of a facet: D * node + component for the lattice nodes, the directions at the corners, the mortar nodes it meets; then m numbers for each image.
   Those of one overlap stand component by component in each of the three groups, so that sums over functions run along memory.
   Vectors have three components everywhere; plane problems leave the third zero. Order-1 lattices list the corners 0 1 3 2 (plane: 0 1). */
#pragma once
#include "element.h"
#include "functionimpl.h"

#define INLINE static inline __attribute__((always_inline, unused))
#define RAY_ORDER MORTISE_MAX_ORDER
#define RAY_LATTICE ((RAY_ORDER + 1) * (RAY_ORDER + 1))
#define RAY_ROOM (RAY_LATTICE + 12) /* values of a lattice's functions: loops of fixed length write beyond the last */
#define RAY_MOMENTS (2 * RAY_LATTICE + 1)
#define RAY_FAR                                                                                                                                                \
  (1 / PETSC_SQRT_MACHINE_EPSILON) /* parametric coordinate up to which images are looked for: a facet may be that much smaller than what it sees */

/* Overlap. Where a mortar facet covers the nonmortar one, in the chart: a convex polygon whose sides lie on lines 0..3 (sides of the nonmortar facet, line i
   from node i to node i + 1) and 4..7 (sides of the mortar facet, nodes listed backwards so that both run counterclockwise). Vertices are intersections of
   neighbouring lines. */
#define FACET_VERTICES 8 /* of an overlap */
#define FACET_OUTSIDE 2  /* parametric coordinate up to which what meets a facet may lie beyond its sides, which may be curved */

/* A facet in the plane's axes. */
typedef struct {
  PetscReal Y[4][2], h[4];
} PlaneQuad;

typedef struct {
  PlaneQuad side[2]; /* nonmortar, mortar (backwards) */
  PetscInt  num;
  PetscReal v[FACET_VERTICES][2];
  int8_t    line[FACET_VERTICES]; /* from vertex k to k + 1 */
  PetscReal area;
  PetscInt  corner[4]; /* names of the images at the corners of side[1] (pieces.c) */
  int       node;      /* node to segment: the edge's end whose ray meets the mortar edge, else -1 */
  PetscReal distance;  /* occlusion.c: of the mortar facet at the middle */
  int8_t    seen;      /* occlusion.c: 0 where it is hidden, -1 as long as that is not known */
} Overlap;

/* bilinear.c: the four coefficients of four corners; xi at Y from a first guess, False: no such point (degenerate quadrilateral, or far outside). */
void      ContactBilinear(const PetscReal Y[][2], PetscReal c[][2]);
PetscBool ContactBilinearLocate(const PetscReal c[4][2], const PetscReal Y[2], PetscReal xi[2]);
PetscBool ContactQuadIsConvex(const PlaneQuad *);

/* clip.c. size: root of the area of the whole facet, of which side[0] may be a part. False: no overlap, or (num > FACET_VERTICES) none that could be used. */
PetscBool ContactClip(Overlap *, PetscReal size);

/* occlusion.c: drop overlaps, with their mortar facets, that lie behind others in the view of a facet of this area. */
void ContactUnfold(PetscInt *num, Overlap overlap[], PetscInt mortar[], PetscReal area);

/* Functions of a lattice at a point of [-1, 1]^m: values and derivatives 1 2, 11 12 22, 111 112 122 222. */
typedef struct {
  PetscReal N[RAY_ROOM], d[2][RAY_ROOM], dd[3][RAY_ROOM], ddd[4][RAY_ROOM];
} RayFunctions;

typedef struct {
  PetscInt  order, num;
  PetscReal x[RAY_LATTICE][4]; /* the fourth, zero, fills a vector register */
  PetscReal c[4][3];           /* bilinear: x = c_0 + c_1 xi_1 + c_2 xi_2 + c_3 xi_1 xi_2 */
} RayLattice;

typedef struct {
  PetscReal Y[2], J[2][2] /* J[i]: Y,i */, inverse[2][2] /* dxi_i / dY_c */, mixed[2], det, ddet[2];
} RayChartPoint;

/* Slopes beyond a facet: that of the side at 1 has the share + turn h of the other coordinate in the one along direction i (continuation.c). */
typedef struct {
  PetscReal share[2], turn[2];
} RayBeyond;

/* Position, direction and their slopes at a point of a facet (plane: t_2 = e_z). */
typedef struct {
  PetscReal p[3], d[3], t[2][3], di[2][3];
} RayFrame;

/* Nonmortar facet. */
typedef struct {
  PetscInt   D, m, nv;  /* dimension of space and facet, corners */
  RayLattice s, d;      /* d: directions, order 1 */
  PlaneQuad  chart;     /* counterclockwise */
  PetscReal  c[4][2];   /* Y = c_0 + c_1 xi_1 + c_2 xi_2 + c_3 xi_1 xi_2 */
  PetscReal  area;      /* of the chart */
  PetscReal  ring;      /* 2 pi or 0 */
  PetscBool  closes;    /* is not all of s a gap? */
  PetscReal  closed[4]; /* length along the rays that counts as no gap, of corners in the order of a lattice, user's units */
  RayBeyond  beyond;
  RayFrame   middle;
} RayFacet;

/* Image of a mortar vertex, or the mean of two images that come before it in the list: of a vertex that hangs in the middle of a straight edge those of the
   edge's ends, and in a facet that is seen in pieces (pieces.c). */
typedef struct {
  PetscInt  node, parent[2]; /* names (pieces.c); -1: it is the vertex's own */
  PetscBool found;
  PetscReal v[3], xi[2], s, Y[2];
} RayImage;

/* A ray and all that varies with it. */
typedef struct {
  RayFunctions  S, V, M; /* facet, directions, mortar facet */
  RayChartPoint chart;
  PetscReal     p[3], t[2][3], tt[3][3], ttt[4][3], d[3], di[2][3], dij[3];
  PetscReal     X[3], Xi[2][3], Xij[3][3];
  PetscReal     xi[2], eta[2], s;
  PetscBool     closes;
  PetscReal     open, dopen;                       /* of s what counts as a gap, s - closed / |d|; closed / |d|^3, so that d open = ds + dopen d . dd */
  PetscReal     closing[3];                        /* closed,1 / |d|, closed,2 / |d|, closed,12 / |d| */
  PetscReal     n[3], unit[3], a, beta, rho, turn; /* turn: drho / dr */
  PetscReal     kappa[3], zeta[2][3];              /* ds = kappa . r, deta = zeta . r, r = variation of x + s d - x_m */
} RayPoint;

/* Where a ray starts and ends. */
typedef struct {
  PetscReal xi[2], eta[2];
} RayPlace;

/* Weight of the gap density at a point with derivatives by xi. */
typedef struct {
  PetscReal v, d[2], dd[3];
} RayWeight;

/* Around points: their mean and the greatest distance of one from it. */
typedef struct {
  PetscReal x[3], radius;
} RayBall;

/* Tangential axes at a node (frame.c): what they are made of, its lengths, and they. */
typedef struct {
  PetscReal d[3], c[3], size, across, m[3], e[2][3];
  PetscBool given; /* c is a direction in space */
} NodeFrame;

struct _p_RayWork {
  /* topology of the nonmortar surface */
  PetscInt  *ring_first, *ring; /* corners of facets at each node: corner k of facet f is nv f + k */
  PetscInt  *sheet;             /* [corners] those of one node with the same sheet have one direction (direction.c) */
  PetscInt  *parent;            /* [num_nodes][2] ends of the edge on which a node hangs, -1 */
  PetscInt  *end;               /* [corners][2] corners at these ends whose directions count, -1: the node does not hang */
  int8_t    *along;             /* [corners][2] does the facet lie along this plane of symmetry, as it was at the search? -1: not known here yet */
  PetscReal *d;                 /* [corners][3] directions */
  PetscBool *kept;              /* [num_facets][4] does the side from corner k on lie in a plane of symmetry? (space) */
  PetscInt  *mortar_parent;     /* [mortar num_nodes][2] of nodes that hang on straight sides */
  PetscInt  *mortar_middle;     /* [mortar num_facets][4] nodes that hang in the middle of curved sides, -1 */
  RayBall   *ball;              /* [mortar num_facets], at the positions of the last evaluation */
  PetscInt   size_ball;
  /* friction in space */
  PetscInt *home; /* [num_nodes] a facet that has the node, -1; where it lies there */
  PetscReal (*home_xi)[2];
  NodeFrame *frame; /* [num_nodes] at the positions of the last evaluation */
  /* one facet */
  RayFacet     facet;
  PetscInt     num_images, num_overlaps, num_mortar;
  RayImage    *image;
  Overlap     *overlap;
  PetscInt    *mortar; /* [num_overlaps] mortar facet */
  PetscInt    *vertex; /* [num_mortar] mortar nodes */
  PetscBool    ends;   /* the mortar side covers it in part */
  PetscBool    frozen; /* forces without the motion of the mortar side's lines */
  PetscInt     n, nn, num_moments;
  PetscReal    q[RAY_MOMENTS], length[RAY_LATTICE], covered, min_gap; /* length: moments of a gap of 1 along unit directions */
  ContactShare share;
  PetscBool    across;                              /* an edge beyond which the mortar side goes on with another face lies in the facet */
  PetscReal   *dq, *W, *J, *R, *WJ, *part, *buffer; /* dq [num_moments][n], W [n][n]; J, R: chainrule.c */
  PetscReal   *T, *rows;                            /* [num_rows][lattice], values and derivative by the share; [n][num_rows] */
  Result       result;                              /* vertices: lattice, then mortar nodes */
  PetscInt     size_image, size_overlap, size_mortar, size_vertex, size_dq, size_W, size_J, size_R, size_WJ, size_part, size_buffer;
  PetscInt     size_T, size_rows;
  /* where the rays of the integration points met, overlap after overlap: the Hessian is integrated there again */
  PetscInt        num_places, size_places, *first_place, size_first_place; /* first_place[num_listed]: -1: some overlap was dropped */
  RayPlace       *place;
  const RayPlace *places; /* of the facet at hand */
};

/* lagrange.c */
PetscErrorCode ContactRayLatticePrepare(void);
/* depth: highest derivative. Beyond [-1, 1] continued by its tangent, which keeps one derivative continuous. */
void ContactRayFunctions(PetscInt m, PetscInt order, const PetscReal xi[2], int depth, RayFunctions *);
void ContactRayLatticeSum(const RayLattice *, const PetscReal f[], PetscReal v[3]);
void ContactRayLatticeGather(const ContactSurface *, PetscInt facet, RayLattice *);
void ContactRayLatticePolynomial(RayLattice *);

/* continuation.c: the same, but beyond [-1, 1]^2 (m = 2) turning to the slope between the corners; NULL, of directions: at h. */
void ContactRayBeyond(const RayBeyond *, PetscInt m, PetscInt order, const PetscReal xi[2], int depth, RayFunctions *);
/* kept[k]: the side from corner k on lies in a plane of symmetry. */
void ContactRayBeyondSides(const PetscBool kept[4], RayBeyond *);

/* direction.c */
/* parent[num_nodes][2]: ends of the edge in whose middle a corner hangs, -1. middle[num_facets][4] (or NULL): the corner that hangs on a side, -1. */
PetscErrorCode ContactParents(const ContactSurface *, PetscInt parent[], PetscInt middle[]);
PetscErrorCode ContactDirectionTopology(RayWork, const ContactSurface *, PetscBool friction);
/* Which images count: asked at the search, of facets that are not known here then at the next evaluation, which is at its positions: all ranks agree. */
void      ContactDirectionImages(RayWork, const ContactSurface *, PetscBool friction);
void      ContactDirections(RayWork, const ContactSurface *);
PetscBool ContactDirectionUsable(RayWork, const ContactSurface *, PetscInt corner);
typedef struct {
  PetscInt  facet;
  PetscReal R[9]; /* weight times images in planes of symmetry */
} DirectionTerm;
#define RAY_TERMS 64 /* most facets around a corner, over all it hangs on */
/* d at a corner of a facet = sum_terms R (vector of facet). Returns their number. */
PetscInt ContactDirectionTerms(RayWork, const ContactSurface *, PetscInt corner, DirectionTerm[RAY_TERMS]);
/* The nodes that it depends on, to a result; J[D][nn] += its derivatives by the nodes of a result, which has them. */
PetscErrorCode ContactDirectionNodes(RayWork, const ContactSurface *, PetscInt corner, Result *);
PetscErrorCode ContactDirectionRows(RayWork, const ContactSurface *, PetscInt corner, PetscReal factor, Result *, PetscReal J[]);
/* Corner of a facet at the place of a lattice of order 1. */
static inline PetscInt ContactCorner(PetscInt nv, PetscInt facet, PetscInt place)
{
  return nv * facet + (place < 2 ? place : 5 - place);
}

/* chart.c */
PetscBool ContactChartCreate(const ContactSurface *, PetscInt facet, RayFacet *);
void      ContactChartAt(const RayFacet *, const PetscReal xi[2], RayChartPoint *);
/* xi: a first guess. */
PetscBool ContactChartLocate(const RayFacet *, const PetscReal Y[2], PetscReal xi[2]);

/* image.c */
/* Once for a facet. */
void ContactImagesPrepare(RayFacet *);
void ContactImageFind(const RayFacet *, RayImage *);
/* rows[m][n] += derivatives of Y; vertex: its place among the facet's nodes. */
void ContactImageRows(const RayFacet *, const RayImage *, PetscInt vertex, PetscInt n, PetscReal rows[]);
/* Columns of rows[num][ld] that belong to images that hang, halves of them to those of their edge's ends. */
void ContactImagesFold(RayWork, PetscInt num, PetscReal rows[], PetscInt ld);
/* W += half of w . d2Y */
void ContactImageCurvature(const RayFacet *, const RayImage *, PetscInt vertex, const PetscReal w[2], PetscInt n, PetscReal W[], PetscReal work[]);

/* pieces.c. Names of images are those of mortar nodes, and others. */
/* The two images in the middle of which one lies, -1: it is a mortar node's own. */
void ContactRayParents(const RayWork, const ContactSurface *mortar, PetscInt name, PetscInt parent[2]);
/* Corners of the pieces in which a mortar facet is seen, in its own order. Returns their number. */
PetscInt ContactRayPieces(const RayWork, const ContactSurface *mortar, PetscInt facet, PetscInt corner[4][4]);

/* coverage.c: what covers a facet */
PetscErrorCode ContactCover(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt slot, PetscBool *failed);

/* nodetosegment.c: of what covers the facet, the hits of its nodes' rays */
void ContactNodeHits(RayWork);

/* ray.c. Functions of a mortar facet, which rays may meet beyond its curved sides. */
void ContactRayMortar(PetscInt m, PetscInt order, const PetscReal eta[2], int depth, RayFunctions *);
/* False: the ray misses. */
PetscBool ContactRaySolve(const RayFacet *, const RayLattice *mortar, const PetscReal xi[2], int depth, RayPoint *);
/* Where they are known to meet. */
PetscBool ContactRayAgain(const RayFacet *, const RayLattice *mortar, const RayPlace *, int depth, RayPoint *);
/* Normal and measures from the tangents of the nonmortar facet and the direction. */
void ContactRayDensities(const RayFacet *, RayPoint *);
/* K^-1 from the ray and the tangents of the mortar facet. */
PetscBool ContactRayInverse(RayPoint *);
/* open, dopen and closing, from s. */
void ContactRayOpen(const RayFacet *, RayPoint *);
/* R = x_m - x less the length that is closed, and what a change of d changes of it: dR -= closed (I - d d^T / d.d) dd / |d|. */
void ContactRayOpening(const RayPoint *, PetscReal R[3]);
void ContactRayOpeningTurns(const RayPoint *, const PetscReal dd[3], PetscReal dR[3]);
/* dR -= how that length and its direction change along xi_k. */
void      ContactRayOpeningAlong(const RayPoint *, PetscInt k, PetscReal dR[3]);
PetscReal ContactRayGap(const RayPoint *);
PetscReal ContactRayArea(const RayPoint *);
void      ContactRayFirst(const RayFacet *, const RayLattice *mortar, const RayPoint *, PetscReal gap[], PetscReal area[], PetscReal gap_xi[2],
                          PetscReal area_xi[2]);

/* to[c * num + a] = f_a v_c */
INLINE void ContactRaySet(PetscInt D, PetscInt num, const PetscReal f[restrict], const PetscReal v[3], PetscReal to[restrict])
{
  for (PetscInt c = 0; c < D; c++)
    for (PetscInt a = 0; a < num; a++) to[c * num + a] = f[a] * v[c];
}

/* to[c * num + a] += f_a v_c */
INLINE void ContactRayAdd(PetscInt D, PetscInt num, const PetscReal f[restrict], const PetscReal v[3], PetscReal to[restrict])
{
  for (PetscInt c = 0; c < D; c++)
    for (PetscInt a = 0; a < num; a++) to[c * num + a] += f[a] * v[c];
}

/* to[c * num + a] = f_a v_c + g1_a w1_c (+ g2_a w2_c, m = 2) */
INLINE void ContactRaySlopes(PetscInt D, PetscInt m, PetscInt num, const PetscReal f[restrict], const PetscReal v[3], const PetscReal g[restrict][RAY_ROOM],
                             const PetscReal w[2][3], PetscReal to[restrict])
{
  for (PetscInt c = 0; c < D; c++)
    for (PetscInt a = 0; a < num; a++) to[c * num + a] = f[a] * v[c] + g[0][a] * w[0][c] + (m == 2 ? g[1][a] * w[1][c] : 0);
}

/* raybilinear.c: the same between bilinear facets. */
PetscBool ContactRayBilinear(const RayFacet *, const RayLattice *mortar, const PetscReal xi[2], PetscBool known, int depth, RayPoint *);

/* raysecond.c: weighted gap phi g. */
typedef struct {
  PetscReal *basis, *right[3]; /* products (basis_f at component c) x right[c] by the numbers of facet, directions and mortar facet */
  PetscInt   num_own;          /* products own_left x own_right by the numbers of lattice and directions */
  PetscReal *own_left, *own_right;
  PetscReal *mixed[2]; /* rows by xi */
  PetscReal  xi[2], xixi[3];
  PetscReal *gradient;
  /* d_v . (dx_a x u[v][a]), u[v][a] += turn_left[v] turn_right[.][a];   u[a][b] . (dx_a x dx_b), u[a][b] += twist_left[a] twist_right[.][b] */
  PetscReal *turn_left, *turn_right, *twist_left, *twist_right;
} RaySecond;
/* Products and pairs are multiplied with weight. */
void ContactRaySecond(const RayFacet *, const RayLattice *mortar, const RayPoint *, const RayWeight *phi, PetscReal weight, RaySecond *);

/* polygon.c */
#define RAY_IMAGES 8 /* numbers of the images of one mortar facet */
/* How corner k of a polygon moves: rows by the RAY_IMAGES numbers; crossings: between which images, e and nu / nu.e. */
typedef struct {
  PetscReal d[2][RAY_IMAGES], dt[RAY_IMAGES], e[2], nu[2];
  PetscInt  a, b; /* a = -1: no crossing */
  PetscBool slips;
  PetscReal slip[2][RAY_IMAGES]; /* one of two corners at a place: half of how the place moves besides d */
} RayMove;
/* A simplex: places of its corners in the polygon, size and derivatives by its m + 1 corners, m numbers each. */
typedef struct {
  PetscInt  corner[3];
  PetscReal size, d[6];
} RaySimplex;
/* W[nl][nr] += factor sum_k left[k][nl] right[k][nr]; ld: length of rows in memory */
void ContactRayProducts(PetscInt num, PetscReal factor, PetscInt nl, const PetscReal left[], PetscInt ldl, PetscInt nr, const PetscReal right[], PetscInt ldr,
                        PetscReal W[], PetscInt ldw);
/* On a simplex of this overlap. */
PetscErrorCode ContactRayRule(const RayFacet *, const Overlap *, PetscInt mortar_order, PetscInt *num, const PetscReal (**point)[3], const PetscReal **weight);
/* The same polygon, with crossings at a small angle as two corners at one place. */
void     ContactRaySplit(const RayFacet *, const Overlap *, Overlap *to);
void     ContactRayMoves(const RayFacet *, const Overlap *, RayMove[]);
PetscInt ContactRaySimplices(const RayFacet *, const Overlap *);
void     ContactRaySimplex(const RayFacet *, const Overlap *, PetscInt k, RaySimplex *);
/* Where rays from the corners of an overlap meet the mortar facet; slope: deta_i / dxi_j. */
typedef struct {
  PetscReal xi[FACET_VERTICES][2], eta[FACET_VERTICES][2], slope[FACET_VERTICES][2][2];
} RayGuess;
void      ContactRayGuess(const RayFacet *, const RayLattice *mortar, const Overlap *, RayGuess *);
PetscBool ContactRayPoint(const RayFacet *, const RayLattice *mortar, const Overlap *, const RayGuess *, const RaySimplex *, const PetscReal beta[3], int depth,
                          RayPoint *);
void      ContactRayPlaces(const RayWork, const ContactSurface *mortar, PetscInt overlap, PetscInt nb, PetscInt place[]);

/* For each integration point of the facet at hand where its rays met when the moments were found: on overlap k, whose numbers have these places
   (ContactRayPlaces), with its part of the surface. */
typedef PetscErrorCode (*RayPointFunction)(void *context, RayWork, PetscInt k, const PetscInt place[], PetscInt num_mortar, const RayPlace *, const RayPoint *,
                                           PetscReal area);
PetscErrorCode ContactRayWalk(RayWork, const ContactSurface *mortar, RayPointFunction, void *context);

/* moments.c, hessian.c: integrals over the overlaps of the facet at hand */
void ContactRayOverDet(const RayFacet *, const RayChartPoint *, PetscReal factor, const RayWeight *, RayWeight *);
/* q: gap moments, area moments, covered share (blend.c). */
PetscErrorCode ContactRayMoments(ContactPair, const ContactSurface *mortar, PetscBool derivatives);
/* W of the work space: half Hessian of sum_a y_a G_a + share times the covered share at the facet's places; gradient[n] of it is set. Where lines are held the
   images' part of the gradient vanishes. */
PetscErrorCode ContactRayHessian(ContactPair, const ContactSurface *mortar, const PetscReal y[], PetscReal share, PetscReal gradient[]);

/* chainrule.c. held: directions do not vary. */
PetscErrorCode ContactRayChain(RayWork, const ContactSurface *nonmortar, PetscInt facet, PetscBool held);
/* X[n][num], by the facet's numbers: the part by the images is added to what they follow. */
void ContactRayChainImages(RayWork, PetscInt num, PetscReal X[]);
/* to[num][nn] += X^T by the nodes, without the part by the images. */
void ContactRayChainNodes(RayWork, PetscInt num, const PetscReal X[], PetscReal to[]);
/* to[rows][nn] += K[rows][n], how forces change by the facet's numbers; K is overwritten. */
PetscErrorCode ContactRayChainForces(RayWork, PetscInt rows, PetscReal K[], PetscReal to[]);
/* H += both halves of the work space's W; forces at held lines: not symmetric, H[i][j] derivative of force i by position j. */
PetscErrorCode ContactRayChainHessian(RayWork, PetscReal H[]);
PetscErrorCode ContactRayDirectionCurvature(RayWork, const ContactSurface *, PetscInt facet, const PetscReal gradient[], PetscReal H[]);

/* facet.c */
PetscErrorCode ContactRayTopology(ContactPair, const ContactSurface *);
PetscErrorCode ContactRayMortarTopology(RayWork, const ContactSurface *mortar);
PetscErrorCode ContactRayEvaluate(const EvaluateContext *, PetscBool *failed);
PetscErrorCode ContactRayWorkDestroy(RayWork *);

/* frame.c: friction in space. Axes of all nodes, after their directions; those of nodes without known neighbours are NaN. */
PetscErrorCode ContactFrames(ContactPair, const ContactSurface *);
/* Adds the nodes that those of a node depend on. rows[9][dim * nodes]: derivatives of e_1, e_2 and m by the nodes of the result, which has them all. */
PetscErrorCode ContactFrameNodes(RayWork, const ContactSurface *, PetscInt node, Result *);
PetscErrorCode ContactFrameRows(RayWork, const ContactSurface *, PetscInt node, Result *, PetscReal rows[]);
/* t: Q, across m, carried to n; returns a of dt = A (dQ - a dm) + B dn. */
PetscReal ContactCarry(const PetscReal m[3], const PetscReal n[3], const PetscReal Q[3], PetscReal t[3]);
void      ContactCarryRows(const PetscReal m[3], const PetscReal n[3], const PetscReal Q[3], PetscReal A[3][3], PetscReal B[3][3]);

/* shear.c in space, shearplane.c in the plane: forces of the facet at hand by tangential tractions, and their part of the Hessian. */
PetscErrorCode ContactShear(const EvaluateContext *, ContactFacet *out);
PetscErrorCode ContactShearPlane(const EvaluateContext *, ContactFacet *out);

/* slip.c: to[D masters][ld] += from[D (lattice, then mortar nodes)][stride] of the facet at hand. */
void ContactSlipMasters(const RayWork, PetscInt stride, const PetscReal from[], PetscInt ld, PetscReal to[]);
/* Of the facet at hand. Does a tangential traction act on it? */
PetscBool ContactSlipLoads(const EvaluateContext *);
/* After its moments, for the result `out`: its points, where they are to be kept; forces by tangential tractions, and their part of the Hessian. */
PetscErrorCode ContactSlipFacet(const EvaluateContext *, PetscInt facet, PetscBool derivatives, ContactFacet *out);

/* tie.c: after the moments of the facet at hand, for the result `out`: what ties it, where that is wanted. */
PetscErrorCode ContactTieFacet(const EvaluateContext *, PetscInt facet, ContactFacet *out);

/* region.c */
typedef struct {
  PetscReal box[6], axis[3][3], lo[3], hi[3], slack, shallow; /* shallow: along axis[2], the margin below the facet */
  PetscReal low, high, base, turn;                            /* of the facet along axis[2]; slack there, and what it grows by per height above or below */
} RayRegion;
void ContactRayRegion(ContactPair, const ContactSurface *, PetscInt facet, RayRegion *);
/* May it meet anything in this box? */
PetscBool ContactRayRegionMeetsBox(const RayRegion *, const PetscReal box[6]);
/* again: for a facet that was found before, as long as it opposes at all, and in the body no deeper than the margin. */
PetscBool ContactRayRegionMeets(const RayRegion *, const ContactSurface *mortar, PetscInt facet, PetscBool again);

/* bundle.c */
/* Of all mortar facets, once for positions. */
PetscErrorCode ContactRayBalls(RayWork, const ContactSurface *mortar);
typedef struct {
  RayBall   from, along; /* of the facet's nodes and its directions */
  PetscReal over;        /* 1 / square of the mean direction */
} RayBundle;
void      ContactRayBundle(const RayFacet *, RayBundle *);
PetscBool ContactRayBundleMeets(const RayBundle *, const RayBall *);
