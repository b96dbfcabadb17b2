/* Private to contact in three dimensions. A nonmortar facet and the mortar facets it faces, in the facet's own axes.

   Plane. Facets are bilinear quadrilaterals. N = (x_2 - x_0) x (x_3 - x_1) is twice the vector area of the nonmortar facet: the auxiliary plane is normal to
   it. Axes e_1, e_2 in the plane and e_3 = N/|N|, origin in the middle of the facet; they are constants while derivatives are taken. A node at (X_1, X_2, X_3)
   is seen along N at Y = (X_1, X_2) - s X_3, s = (N_1, N_2) / N_3 the tilt (zero at the evaluation itself, but not its derivatives), and has the height h =
   X_3. The gap along e_3 times the area normal to e_3 is the difference of heights times dY whatever the tilt, so with dY = the measure in the axes' plane int
   N_j g dA = int N_j (h_m - h_s) dY,   int N_j dA = cos(tilt) int N_j dY. Everything is therefore a function of U = (Y_1, Y_2, h) at the nodes; only at the end
   (chain of facet.c) Y depends on the tilt.

   Overlap. Where a mortar facet covers the nonmortar one: a convex polygon whose sides lie on lines 0..3 (sides of the nonmortar facet, line i from node i to
   node i + 1) and 4..7 (sides of the mortar facet, nodes listed backwards so that both run counterclockwise). Vertices are intersections of neighbouring lines.

   Local numbers of an overlap: 3 * node + component for nodes 0..3 nonmortar, 4..7 mortar. Half form: symmetric H kept as W, H = W + W^T. */
#pragma once
#include "contactimpl.h"

#define FACET_LOCAL 24    /* numbers one overlap sees */
#define FACET_VERTICES 8  /* of an overlap */
#define FACET_MOMENTS 18  /* G_j (4), D_j (4), D_jk, j <= k (10) */
#define FACET_ON 1e-9     /* distance from a line, over the facet's size, within which a vertex is on it */
#define FACET_STRAY 1e-3  /* distance, over the facet's size, from the side that is cut, beyond which a crossing is not taken */
#define FACET_OUTSIDE 1.5 /* parametric coordinate up to which the projection on a facet may lie outside */

/* A facet in the plane's axes. */
typedef struct {
  PetscReal Y[4][2], h[4];
} PlaneQuad;

/* Place of a point of the plane on a facet: parametric coordinates, hats and their derivatives, inverse of dY/dxi, mixed derivative of Y. */
typedef struct {
  PetscReal xi[2], N[4], d[2][4], inverse[2][2], mixed[2];
} PlanePoint;

typedef struct {
  PlaneQuad side[2]; /* nonmortar, mortar (backwards) */
  PetscInt  num;
  PetscReal v[FACET_VERTICES][2];
  int8_t    line[FACET_VERTICES]; /* from vertex k to k + 1 */
  PetscReal area;
  PetscInt  corner[4]; /* rays: names of the images at the corners of side[1] (raypieces.c) */
} Overlap;

extern const PetscReal ContactMixed[4]; /* d2 N_a / dxi_1 dxi_2 */

/* quad.c. False: no such point (degenerate quadrilateral, or far outside). */
PetscBool ContactQuadLocate(const PlaneQuad *, const PetscReal Y[2], PlanePoint *);
PetscBool ContactQuadIsConvex(const PlaneQuad *);

/* clip.c. size: root of the area of the whole facet, of which side[0] may be a part. False: no overlap, or (num > FACET_VERTICES) none that could be used. */
PetscBool ContactClip(Overlap *, PetscReal size);

/* rule.c: barycentric points and weights on a triangle. */
#define CONTACT_RULE 25
extern const PetscReal ContactRulePoint[CONTACT_RULE][3], ContactRuleWeight[CONTACT_RULE];
/* The symmetric rule of the lowest degree, 10 at least, that is exact to `degree`. False: none is. */
PetscBool ContactRuleGet(PetscInt degree, PetscInt *num, const PetscReal (**point)[3], const PetscReal **weight);

/* overlap.c */
typedef struct {
  PetscReal q[FACET_MOMENTS], min_gap;
} FacetMoments;
/* Adds int of moments over the overlap; dq (NULL: none) [FACET_MOMENTS][FACET_LOCAL] is set. False: a point of it could not be projected. */
PetscBool ContactOverlapMoments(const Overlap *, FacetMoments *, PetscReal dq[][FACET_LOCAL]);
/* Half Hessian of sum_j g_j G_j + sum_jk D[j][k] int N_j N_k (D symmetric), W set. */
PetscBool ContactOverlapHessian(const Overlap *, const PetscReal g[4], const PetscReal D[4][4], PetscReal W[FACET_LOCAL][FACET_LOCAL]);

/* frame.c: the nonmortar facet's axes and tilt. */
typedef struct {
  PetscReal origin[3], E[3][3]; /* rows e_1, e_2, e_3 */
  PetscReal area;               /* N_3 / 2 */
  PetscReal normal3;            /* N_3 */
  PetscReal X[4][3];            /* its nodes in these axes */
  PetscReal sigma[2][12];       /* derivatives of the tilt by X */
} FacetFrame;
/* False: the facet has no area, or is not convex. */
PetscBool ContactFacetFrame(const PetscReal x[4][3], FacetFrame *);
void      ContactFacetLocal(const FacetFrame *, const PetscReal x[3], PetscReal X[3]);
/* g[num] by U -> by X at all num / 3 nodes, X[num]; the first four are the facet's. */
void ContactTiltGradient(const FacetFrame *, PetscInt num, const PetscReal X[], PetscReal g[]);
/* The same for W[num][num] in half form and its function's gradient by U; work [2 num]. */
void ContactTiltHessian(const FacetFrame *, PetscInt num, const PetscReal X[], const PetscReal gradient[], PetscReal W[], PetscReal work[]);

/* fold.c: drop overlaps that lie behind others in the facet's view. */
void ContactUnfold(PetscInt *num, Overlap overlap[], PetscInt order[], PetscReal area);

/* store.c */
typedef struct {
  PetscInt    num, size, at, *room, used;
  PetscReal **block;
} Store;
PetscErrorCode ContactStoreDestroy(Store *);
PetscErrorCode ContactStoreReserve(Store *, PetscInt num, PetscReal **array);

/* result.c: one facet's result in the making. Rows of the result belong to the first num_rows nodes. */
typedef struct {
  PetscInt   num_rows, num_nodes, *node; /* nodes of the result, as in ContactFacet */
  PetscInt  *row_first, *row_node;       /* masters of the vertices: [vertices + 1] offsets, places in node */
  PetscReal *row_weight;
  PetscInt   size_node, size_row_first, size_row_node, size_row_weight;
  Store      store; /* of all results */
} Result;
PetscErrorCode ContactResultDestroy(Result *);
/* Place of a node; new ones are added. */
PetscErrorCode ContactResultNode(Result *, PetscInt id, PetscInt *place);
/* Masters of a node: itself when it does not hang. */
PetscInt ContactMasters(const ContactSurface *, const PetscInt *node, const PetscInt **master, const PetscReal **weight);
/* Row of vertex v by places among the nodes; row_first has room for v + 1, *num entries are there. */
PetscErrorCode ContactResultRow(Result *, const ContactSurface *, PetscInt node, PetscBool mortar, PetscInt v, PetscInt *num);
/* Do derivatives have a use? node[num_rows]: the facet's multipliers; loaded: one of them is not zero. */
PetscBool      ContactResultDerivatives(const EvaluateContext *, PetscInt num_rows, const PetscInt node[], PetscBool loaded);
PetscErrorCode ContactResultSegment(ContactPair, PetscInt facet, PetscInt mortar_facet, PetscInt num, ContactSegment **);
/* Calls the function for every listed facet and hands out those results it sets *use for. At the positions of the last evaluation (again) for those only
   whose results lack what is asked for; they stand in the function's ContactFacet when it is called. */
typedef PetscErrorCode (*ResultFunction)(const EvaluateContext *, PetscInt slot, ContactFacet *, PetscBool *use, PetscBool *failed);
PetscErrorCode ContactResultsEvaluate(const EvaluateContext *, Result *, ResultFunction, PetscBool *failed);

/* sliver.c: compliances K_j of the result's rows, their first and second derivatives by the facet's part of w_j, [3][num_rows]; NULL: all are 0. */
PetscErrorCode ContactSliver(ContactPair, const ContactSurface *nonmortar, PetscInt facet, Result *, const PetscReal weight[], const PetscReal **spring);

/* facet.c: everything about one nonmortar facet. Vertices: the facet's four, then the mortar facets' ones; n = 3 * their number. */
struct _p_FacetWork {
  FacetFrame   frame;
  PetscInt     num_overlaps, num_vertices;
  Overlap     *overlap;
  PetscInt    *mortar; /* [num_overlaps] mortar facet */
  PetscInt    *corner; /* [num_overlaps][4] places of its nodes among the vertices, backwards as in the overlap */
  PetscInt    *vertex; /* [num_vertices] node of its surface */
  PetscReal   *X;      /* [num_vertices][3] in the facet's axes */
  FacetMoments moments;
  PetscReal    covered;
  PetscReal   *dq;      /* [FACET_MOMENTS][n] by U */
  PetscReal   *W, *row; /* [n][n] half form; work */
  PetscInt     size_overlap, size_mortar, size_corner, size_vertex, size_X, size_dq, size_W, size_row;
  Result       result;
};
PetscErrorCode ContactFacetWorkDestroy(FacetWork *);
PetscErrorCode ContactFacetTopology(ContactPair, const ContactSurface *);
/* All listed facets: segments and results into the pair. */
PetscErrorCode ContactFacetsEvaluate(const EvaluateContext *, PetscBool *failed);

/* region.c: what one facet may meet. */
typedef struct {
  FacetFrame frame;
  PetscReal  x[4][3], reach, depth, slack, box[6]; /* how far out of the body, into it, to the sides */
} FacetRegion;
void      ContactRegionCreate(ContactPair, const ContactSurface *, PetscInt facet, FacetRegion *);
PetscBool ContactRegionMeets(const FacetRegion *, const ContactSurface *mortar, PetscInt facet);

/* weights.c: from moments to weighted gaps. G_j -> gt_j and their derivatives in terms of the moments. */
typedef struct {
  PetscReal gap[4], weight[4];
  PetscReal dgap[4][FACET_MOMENTS];                          /* by moments */
  PetscReal g[4], D[4][4];                                   /* derivative of sum_j z_j gt_j by G_j and int N_j N_k: weights of ContactOverlapHessian */
  PetscReal left[4][FACET_MOMENTS], right[4][FACET_MOMENTS]; /* second derivatives of it by moments, half form: sum_k left_k x right_k; standard: none */
  int       num_pairs;
} FacetWeights;
/* False: too little covered to tell. */
PetscBool ContactFacetWeights(PetscBool standard, const PetscReal q[FACET_MOMENTS], const PetscReal z[4], FacetWeights *);
