/* Private to contact. Overlaps of facets in a plane, and results of facets.

   Overlap. Where a mortar facet covers the nonmortar one, in a plane: a convex polygon whose sides lie on lines 0..3 (sides of the nonmortar facet, line i from
   node i to node i + 1) and 4..7 (sides of the mortar facet, nodes listed backwards so that both run counterclockwise). Vertices are intersections of
   neighbouring lines. */
#pragma once
#include "contactimpl.h"

#define FACET_VERTICES 8  /* of an overlap */
#define FACET_MOMENTS 18  /* G_j (4), D_j (4), D_jk, j <= k (10) */
#define FACET_ON 1e-9     /* distance from a line, over the facet's size, within which a vertex is on it */
#define FACET_STRAY 1e-3  /* distance, over the facet's size, from the side that is cut, beyond which a crossing is not taken */
#define FACET_OUTSIDE 1.5 /* parametric coordinate up to which the projection on a facet may lie outside */

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
  PetscInt  corner[4]; /* names of the images at the corners of side[1] (raypieces.c) */
  int       node;      /* node to segment: the edge's end whose ray meets the mortar edge, else -1 */
} Overlap;

/* quad.c: hats at a point of the plane. False: no such point (degenerate quadrilateral, or far outside). */
PetscBool ContactQuadLocate(const PlaneQuad *, const PetscReal Y[2], PetscReal N[4]);
PetscBool ContactQuadIsConvex(const PlaneQuad *);

/* clip.c. size: root of the area of the whole facet, of which side[0] may be a part. False: no overlap, or (num > FACET_VERTICES) none that could be used. */
PetscBool ContactClip(Overlap *, PetscReal size);

/* rule.c: barycentric points and weights on a triangle. */
/* The symmetric rule of the lowest degree, 10 at least, that is exact to `degree`. False: none is. */
PetscBool ContactRuleGet(PetscInt degree, PetscInt *num, const PetscReal (**point)[3], const PetscReal **weight);

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

/* weights.c: from moments to weighted gaps. G_j -> gt_j and their derivatives in terms of the moments. */
typedef struct {
  PetscReal gap[4];
  PetscReal dgap[4][FACET_MOMENTS];                          /* by moments */
  PetscReal g[4], D[4][4];                                   /* derivative of sum_j z_j gt_j by G_j and int N_j N_k: weights of ContactRayHessian */
  PetscReal left[4][FACET_MOMENTS], right[4][FACET_MOMENTS]; /* second derivatives of it by moments, half form: sum_k left_k x right_k */
  int       num_pairs;
} FacetWeights;
/* False: too little covered to tell. */
PetscBool ContactFacetWeights(const PetscReal q[FACET_MOMENTS], const PetscReal z[4], FacetWeights *);
