/* Floor 3. Mortar contact between two surfaces: search, segments, dual multipliers, weighted gaps, exact derivatives.
   This file knows deformed positions of facet nodes only: no bodies, no laws, no solver. Two dimensions here: facets are straight edges.

   Sides: the *nonmortar* side carries the multiplier. Outward normal of an edge (a, b): the body lies to the left of a -> b, so
   t = (x_b - x_a)/|x_b - x_a|, N = (t_y, -t_x). Nodal normal n_j: normalised sum of the unit normals of its (one or two) edges; at a node
   on a symmetry plane the mirror image of its edge's normal takes part (mirror[j] = plane's unit normal, zero elsewhere).
   Along an edge the nodal normals are interpolated and not renormalised, n(xi) = sum N_k(xi) n_k: only the direction of the ray counts.
   Gap: g(xi) = n . (x_m - x_s) / |n| = A |n| / B, A = (c - x_s) x (d - c), B = n x (d - c): a length along the unit direction, positive when open;
   x_m is where the ray x_s + s n meets the mortar edge (c, d).
   Segment bounds: root of f(xi) = n(xi) x (x_m - x_s(xi)) for a mortar node, the edge's end where the signs of f at both ends say so; roots with
   |xi| > 1 - 1e-9 are that end and do not move. Where several mortar edges face the same part, each piece between bounds goes to the one with the
   least |g| at its middle (segment.c), so nothing is covered twice; a change of that choice is a jump.
   Weighted gap: gt_j = int psi_j g dgamma over the covered part of the nonmortar edges, psi_j dual to the hats on the covered part:
   psi = A N, A = diag(int N_j) [int N_j N_k]^-1 edge by edge (an edge whose second
   matrix is singular to 1e-13 contributes nothing); w_j = int psi_j = int N_j. Measure: current length (axisymmetric: times 2 pi r).
   Multiplier z_j >= 0 is the contact pressure. Lagrangian L = Pi(u) - sum_j z_j gt_j(u).
   Node to segment (comparison): g_j along n_j to the edge that the node's ray hits; per edge of current length L: w_j = rho L / 2, gt_j = g_j w_j (rho = 1 or
   2 pi r_j), with exact derivatives of both. */
#pragma once
#include "base.h"

typedef struct {
  PetscInt         num_nodes, num_edges;
  const PetscInt  *edges;  /* [num_edges][2] */
  const PetscReal *x;      /* [num_nodes][2] current positions */
  const PetscReal *mirror; /* [num_nodes][2] unit normal of the symmetry plane through the node, zero if none; nonmortar side only, may be NULL */
} ContactSurface;

typedef struct {
  char      name[MORTISE_NAME];
  PetscInt  nonmortar, mortar; /* boundary groups */
  PetscReal friction;          /* 0 here: anything else is an input error until friction is built */
  PetscInt  order;             /* 1 */
  PetscReal search;            /* search distance, in multiples of the larger edge length; default 0: automatic */
  PetscBool node_to_segment;   /* comparison only */
  PetscBool adjust;            /* the gaps of the mesh at the reference positions count as closed */
  PetscReal interference;      /* overlap at the reference positions, besides that of the geometry */
} ContactSpec;

typedef struct _p_ContactPair *ContactPair;

/* One nonmortar edge with everything it meets. Nodes: the edge's two, then those outer neighbours that exist (they enter the nodal normals; 2 to 4 nonmortar
   nodes in all; a closed surface of three edges lists one twice: derivatives add), then the mortar nodes it meets. Derivatives with respect to the positions of
   all `num` nodes, 2 components each. */
typedef struct {
  PetscInt         edge;              /* nonmortar edge */
  PetscInt         node[2];           /* its nonmortar nodes: rows j = 0, 1 below */
  PetscInt         num;               /* nodes it depends on */
  const PetscInt  *nodes;             /* [num] nonmortar node id, or ~id (bitwise not) of a mortar node */
  PetscReal        gap[2], weight[2]; /* contributions to gt_j, w_j (raw: sums over edges give the nodal values) */
  const PetscReal *dgap;              /* [2][2*num] */
  const PetscReal *dweight;           /* [2][2*num] */
  const PetscReal *hessian;           /* [2*num][2*num] of sum_j z_j gap_j; NULL unless asked */
  PetscReal        area;              /* covered length (axisymmetric: area) */
  PetscReal        min_gap;
} ContactEdge;

/* One segment, for output and estimation: part [xi0, xi1] of a nonmortar edge that faces part [eta0, eta1] of a mortar edge (eta0 > eta1: the edges run
   against each other). Node to segment: a hit, xi0 = xi1 = -1 or 1. Ordered by listed edge, then along the edge. */
typedef struct {
  PetscInt  edge, mortar_edge;
  PetscReal xi[2], eta[2]; /* in [-1, 1] */
} ContactSegment;

PetscErrorCode ContactPairCreate(PetscBool axisymmetric, PetscBool node_to_segment, ContactPair *);
PetscErrorCode ContactPairDestroy(ContactPair *);

/* Candidate search at the given positions: for each listed nonmortar edge (edges[num], those this rank owns) the mortar edges it may meet while no
   node moves more than `margin`: edge normals N_s . N_m < -0.1, |g| < distance to both sides somewhere on the pair (margin > 0: more). Distances and
   normals are judged here only, so between two searches the evaluation is continuous. Bounding-volume tree, O(n log n). Call between Newton iterations only;
   the result is kept. Not collective. */
PetscErrorCode ContactPairSearch(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt num, const PetscInt edges[],
                                 PetscReal distance, PetscReal margin);

/* Evaluate all edges of the last search at current positions. z[nonmortar num_nodes] (only read when hessian is asked). A deterministic function of positions.
   Only edges that contribute are returned. Results stay valid until the next call. *failed (numerical status, no results): positions that are no
   numbers, an edge without length, a nonmortar node whose edge normals cancel. Surfaces must have the topology of the last search. Not collective. */
PetscErrorCode ContactPairEvaluate(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[], PetscBool derivatives,
                                   PetscBool hessian, PetscInt *num, const ContactEdge **edges, PetscBool *failed);
PetscErrorCode ContactPairGetSegments(ContactPair, PetscInt *num, const ContactSegment **segments);
/* Nodal normals of the last evaluation [num_nodes][2]. */
PetscErrorCode ContactPairGetNormals(ContactPair, const PetscReal **normals);
