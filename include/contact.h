/* Floor 3. Mortar contact between two surfaces: search, segments, multiplier bases, weighted gaps, exact derivatives.
   This file knows deformed positions of facet nodes only: no bodies, no laws, no solver.

   Sides: the *nonmortar* side carries the multiplier z_j >= 0, the contact pressure at its nodes. Weighted gap gt_j = int psi_j g dgamma over the covered part
   of the nonmortar facets, w_j = int psi_j; Lagrangian L = Pi(u) - sum_j z_j gt_j(u). Measure: current length or area (axisymmetric: times 2 pi r).
   Basis of the multipliers: *dual*, one constant matrix per facet, dual in the reference measure (src/contact/function/functionimpl.h), or *standard*, psi = N;
   on a facet that is covered in part a blend of it with Bernstein polynomials, which depends on the covered share (src/contact/function/blend.c).

   Facets. Two dimensions: edges (a, b), the body to the left of a -> b; three: quadrilaterals, corners counterclockwise seen from outside. Of any order.
   Directions d at the corners of nonmortar facets are means of the vectors of the facets there (and of their mirror images in planes of symmetry), interpolated
   between them; across an edge where the surface turns by more than 40 degrees each side keeps its own. Gap: x_s + s d = x_m on the mortar side,
   g = s d.n, n the unit normal at x_s; positive when open. What of the mortar side a facet sees are the pictures of mortar facets by those of their corners
   (kernelimpl.h); where several lie behind one another the nearest counts, so nothing is covered twice; a change of that choice is a jump.
   Node to segment (comparison, two dimensions): the same integrals by the trapezoidal rule: w_j = rho L / 2, gt_j = g_j w_j for an edge of length L (rho = 1
   or 2 pi r_j), with exact derivatives.
   Nodes may hang (hang): their positions follow their masters', and results are given for the masters: gt_T = sum_L P_LT gt_L. */
#pragma once
#include "base.h"

#define CONTACT_SEGMENT 8                 /* most corners of a segment */
#define CONTACT_ROUND 1e-9                /* of a facet, of a coordinate on it, of a cosine: what round-off may leave */
#define CONTACT_SLIVER 0.1                /* of a facet, of its functions, of its normal: what is less tells nothing of its own */
#define FORM_PAIRS 64                     /* most contact pairs of a scene, each face of a mortar side counted */
#define CONTACT_SHARP 0.76604444311897804 /* cosine of 40 degrees: a surface that turns by more has an edge */
#define CONTACT_OPPOSE 0.3                /* facets face each other where N_s . N_m < -0.3: the search keeps these */

typedef struct {
  PetscInt         dim, num_nodes, num_facets;
  const PetscInt  *facets; /* [num_facets][2 or 4] */
  const PetscReal *x;      /* [num_nodes][dim] current positions, those of hanging nodes included */
  const PetscReal
      *mirror; /* unit normals of the symmetry planes through the node, zero: none; two dimensions: [num_nodes][2], three: [num_nodes][2][3]; may be NULL */
  const PetscInt  *hang;        /* three dimensions: [num_nodes+1] offsets of a hanging node's row, empty: a node of its own; NULL: none hangs */
  const PetscInt  *hang_master; /* nodes of this surface that do not hang */
  const PetscReal *hang_weight;
  /* Facets of higher order (all NULL: facets have order 1 and their corners for nodes). Nodes of facet f on the Gauss-Lobatto lattice of its order,
     lexicographic, first direction from corner 0 to 1, second from corner 0 to 3: lattice[first[f] .. first[f+1]). Nodes on a side of lower order hang on that
     side's. */
  const int8_t    *order; /* [num_facets] */
  const PetscInt  *first; /* [num_facets+1] */
  const PetscInt  *lattice;
  const PetscReal *X; /* [num_nodes][dim] reference positions, those of hanging nodes included */
  /* [num_nodes] Is the node's position known on this rank? NULL: all are. Searches pass over mortar facets with other nodes; normals beside them are NaN. */
  const PetscBool *has;
  const PetscBool *rim; /* [num_nodes] corners on an edge beyond which the side goes on with another face (ContactSpec.face); NULL: none */
} ContactSurface;

/* How two facets of a surface meet at the first corner that they share, at the reference positions: round an edge (CONTACT_SHARP, of the normals there) or not.
 */
typedef enum { JOINT_NONE, JOINT_SMOOTH, JOINT_SHARP } FacetJoint;
FacetJoint ContactFacetJoint(const ContactSurface *, PetscInt a, PetscInt b);

typedef enum { CONTACT_FRICTIONLESS, CONTACT_PENALTY, CONTACT_COULOMB, CONTACT_TIED } ContactLaw; /* in the order of the table of laws */

#define CONTACT_FRICTION "0 or a positive number" /* allowed as a coefficient of friction */

typedef struct {
  char          name[MORTISE_NAME];
  PetscInt      nonmortar, mortar; /* boundary groups */
  PetscBool     self;              /* both are one group: a surface that may meet itself */
  PetscBool     exchanged;         /* the scene names them the other way round, figures are of the sides as the scene names them */
  PetscBool     given;             /* they are not to be exchanged */
  PetscBool     cornered;          /* the nonmortar side was chosen for its corners; by stiffness it would be the other one */
  PetscBool     stiff;             /* it is so much stiffer than the other side that it is as rigid */
  ContactLaw    law;               /* what its multipliers fulfil (interface/law/) */
  PetscReal     penalty;           /* law penalty: stiffness, pressure over overlap */
  Expression    friction;          /* law coulomb: its coefficient, of t */
  PetscBool     full;              /* facets have the order of their cells; else order 1 */
  PetscReal     search;            /* search distance, in multiples of the larger edge length; default 0: automatic */
  PetscBool     node_to_segment;   /* comparison only */
  PetscBool     see_through;       /* comparison only: searches take far sides of bodies behind for overlaps */
  PetscBool     stabilise;         /* false, comparison only: multipliers of stiff facets that are shorter than the other side's are not stabilised */
  PetscBool     standard;          /* standard multipliers */
  PetscBool     adjust;            /* the gaps of the mesh at the reference positions count as closed */
  PetscBool     close;             /* law tied: gaps at the reference positions are closed, else they stay */
  PetscBool     ramp;              /* overlaps of the mesh there count by the share t, from t = 1 on whole */
  Expression    interference;      /* of t: overlap at the reference positions, besides that of the geometry; NULL: none */
  PetscReal     about[3];          /* point that moments of its forces are counted about, reference position */
  const int8_t *face;              /* faces of the mortar side (scene/faces.c): colour by side of the coarse mesh; NULL: it has one */
  PetscInt      pair, part;        /* number of the pair as the scene names it; the colour that is met: parts of a pair follow one another, from 0 on */
  PetscBool     subdivide_auto;    /* cells behind linear facets are subdivided as the estimate asks (estimate/layer.c) */
} ContactSpec;

/* Vector of a facet with these nodes, x[..][dim], outward and as long as its length or area: edge x the axis out of the plane; in space half the product of the
   diagonals, the exact vector area of the bilinear face. */
static inline void ContactFacetVector(PetscInt dim, const PetscReal x[], const PetscInt node[], PetscReal N[3])
{
  PetscReal d[3] = {0, 0, 0}, e[3] = {0, 0, 1};

  for (PetscInt c = 0; c < dim; c++) {
    d[c] = x[dim * node[dim - 1] + c] - x[dim * node[0] + c];
    if (dim == 3) e[c] = 0.5 * (x[3 * node[3] + c] - x[3 * node[1] + c]);
  }
  Cross3(d, e, N);
}
/* The same of length 1; returns what it was. */
static inline PetscReal ContactFacetNormal(PetscInt dim, const PetscReal x[], const PetscInt node[], PetscReal n[3])
{
  PetscReal size;

  ContactFacetVector(dim, x, node, n);
  size = PetscSqrtReal(Dot3(n, n));
  for (int c = 0; c < 3; c++) n[c] /= size;
  return size;
}

typedef struct _p_ContactPair *ContactPair;

/* One nonmortar facet with everything it meets. Nodes: first those that carry its multipliers (the facet's, hanging ones replaced by their masters), then other
   nonmortar nodes it depends on (those of facets around its corners, which enter the directions), then the mortar nodes it meets. Derivatives with respect to
   the positions of all `num` nodes, dim components each. */
typedef struct {
  PetscInt         facet;        /* nonmortar facet */
  PetscInt         num_rows;     /* its multipliers: nodes[0 .. num_rows) */
  PetscInt         num;          /* nodes it depends on */
  const PetscInt  *nodes;        /* [num] nonmortar node id, or ~id (bitwise not) of a mortar node */
  const PetscReal *gap, *weight; /* [num_rows] contributions to gt_j, w_j (raw: sums over facets give the nodal values) */
  const PetscReal *length;       /* [num_rows] change of gt_j when gaps grow by 1 along the directions */
  const PetscReal *reach;        /* [num_rows] what an interference of 1 is: length, on curved facets, which turn with their directions, weight */
  const PetscReal *dgap;         /* [num_rows][dim*num]; NULL unless asked, or where z vanishes and no Hessian is asked */
  const PetscReal *dweight;      /* [num_rows][dim*num] */
  const PetscReal *push;         /* [num_rows][dim*num] force by z_j where that is not dgap: lines are held (theory (5.8)); with dgap. NULL: dgap */
  const PetscReal *hessian;      /* [dim*num][dim*num] derivatives of the forces (rows); NULL unless asked, or where z vanishes */
  const PetscReal *compliance;   /* [num_rows] m_j of S (below); NULL: none. kappa and its derivative by the share, sum of m_j */
  PetscReal        kappa[2], compliance_sum;
  const PetscReal *dshare; /* [dim*num] derivative of the covered share; with dgap where the facet is covered in part, else NULL */
  const PetscReal *shear;  /* [dim - 1][num_rows][dim*num] force by a tangential traction z_j (ContactPairSetTraction); with dgap. NULL: none */
  const PetscReal *micro;  /* ContactPairSlip: [((dim - 1) num_rows)^2] compliance C, slips count as s + C dq; NULL: none */
  const PetscReal *tie;    /* [num_rows][num] sum_a tie_ja x_a = int psi_j (x_m - x_s) dgamma, of ContactPairTie; else NULL */
  const PetscReal *whole;  /* [num_rows] with tie: what the weight would be if the facet were covered whole */
  PetscReal        area;   /* covered length or area (axisymmetric: area) */
  PetscReal        min_gap;
  PetscBool        ends; /* the mortar side ends within the facet */
} ContactFacet;

/* One segment, for output and estimation, by its corners in the parametric coordinates of both facets, [-1, 1] each. Two dimensions: num = 2, part [xi0, xi1]
   of a nonmortar edge that faces part [eta0, eta1] of a mortar edge (eta0 > eta1: the edges run against each other); node to segment: a hit, xi0 = xi1 = -1
   or 1. Three dimensions: polygon, counterclockwise on the nonmortar facet. Ordered by listed facet. */
typedef struct {
  PetscInt  facet, mortar_facet, num;
  PetscReal xi[CONTACT_SEGMENT][2], eta[CONTACT_SEGMENT][2];
  PetscReal dual; /* share of the dual functions in those of the nonmortar facet, the rest being Bernstein polynomials (blend.c) */
} ContactSegment;

PetscErrorCode ContactPairCreate(PetscInt dim, PetscBool axisymmetric, const ContactSpec *, ContactPair *);
PetscErrorCode ContactPairDestroy(ContactPair *);

/* What tells an overlap from the far side of a body that lies behind (src/contact/culling.c): all outer facets of the bodies at the reference positions,
   X[num][2 or 4][dim] with corners in the order of ContactSurface, part[num]: what is connected has one number. Takes both arrays over. Not collective. */
typedef struct _p_ContactHull *ContactHull;
PetscErrorCode                 ContactHullCreate(PetscInt dim, PetscInt num, PetscInt part[], PetscReal X[], ContactHull *);
PetscErrorCode                 ContactHullDestroy(ContactHull *);
/* How far its part of the bodies reaches behind a facet of the surface at the reference positions, straight inwards from the facet's middle: the most of all
   its facets. part[num_facets]. Not collective. */
void ContactHullThickness(ContactHull, const ContactSurface *, const PetscInt part[], PetscReal *most);
/* From now on the pair's searches pass over far sides. part, mortar_part: parts of the facets of its surfaces, which need reference positions; borrowed, as
   is the hull. deepest: overlaps are looked for down to here, whatever the search distance is; 0: down to the search distance. Not collective. */
void ContactPairSetHull(ContactPair, ContactHull, const PetscInt part[], const PetscInt mortar_part[], PetscReal deepest);

/* A pair of one surface with itself (spec.self): both surfaces are given alike, facet by facet. Of two facets that face each other the one with the lower
   number precedence[num_facets] is the nonmortar one; no two are alike. What a facet sees first and that does not follow it hides what is behind, and covers
   nothing. NULL (as created): all facets see all that face them, both ways. Borrowed. Not collective. */
void ContactPairSetPrecedence(ContactPair, const PetscInt precedence[]);
/* Facets of the mortar surface that are not met[its num_facets] hide what is behind them, too, and cover nothing: they belong to another part of the pair. NULL
   (as created): all are met. Borrowed. Not collective. */
void ContactPairSetMet(ContactPair, const PetscBool met[]);

/* Does a surface make an edge with its image in a plane of symmetry, by its unit normal, at corner k of facet f, corner = (corners of a facet) f + k? It
   turns there by twice the angle between its normal and the plane. Reference positions. Not collective. */
PetscBool ContactImageMakesEdge(const ContactSurface *, PetscInt corner, const PetscReal plane[3]);
/* Facets whose multiplier functions are made together, those that share a corner that hangs: root[num_facets], the first of them. Not collective. */
PetscErrorCode ContactFacetGroups(const ContactSurface *, PetscInt root[]);
/* Facets of higher order: which nodes have multipliers (carries[nonmortar num_nodes], NULL: all), for the functions of covered facets, which are dual in the
   reference positions; before the search. Functions of the other nodes are added to theirs, extrapolated, so that all together still sum to 1. With late
   [nonmortar num_nodes] (NULL: none) that is done twice: first with functions of nodes that are neither in carries nor in late, which all others get; then with
   those of late nodes that are not in carries, which go to nodes in carries that are not late. Without a call the first search takes all nodes. The pair keeps
   the functions. Not collective. */
PetscErrorCode ContactPairSetCarriers(ContactPair, const ContactSurface *nonmortar, const PetscBool carries[], const PetscBool late[]);
/* Compliances of facets that are covered in part: gaps count as gt + S z, S = kappa [diag m - m m^T / sum m], kappa(share) as in
   src/contact/function/blend.c, m_j = softness times reference measure of j's function on the facet. A term z.S z / 2 of the Lagrangian, whose derivative by
   positions belongs to the forces. softness[nonmortar num_nodes]: facet size / Young's modulus, averaged on a facet; borrowed. Without it there are no
   compliances. Not collective. */
void ContactPairSetSoftness(ContactPair, const PetscReal softness[]);
/* What kappa has besides, whatever is covered, [nonmortar num_facets]; NULL (as created): nothing. Borrowed. Not collective. */
void ContactPairSetStabilisation(ContactPair, const PetscReal kappa[]);
/* Nodes of the nonmortar side that other pairs constrain as well (NULL: none): their facets have a compliance from then on, the largest one of a facet that is
   covered in part. parted: the pair is made once for each of several faces of the mortar side, and so are constraints of nodes on sharp edges of the nonmortar
   one: the same, but for slips alone. Borrowed. Not collective. */
void ContactPairSetShared(ContactPair, const PetscBool shared[], PetscBool parted);
/* Lengths along the rays that count as no gap (NULL: 0): gt_j = int psi_j (s - closed / |d|) d.n, closed linear on each facet between its corners. Forces and
   derivatives are those of what is left. closed[nonmortar num_nodes], of corners that do not hang, user's units of length; borrowed, and to be set again when a
   number changes. Not collective. */
void ContactPairSetClosed(ContactPair, const PetscReal closed[]);
/* Mean of z by m on a facet with compliance; (S z)_j = kappa m_j (z_j - mean). */
static inline PetscReal ContactFacetMean(const ContactFacet *f, const PetscInt node[], const PetscReal z[])
{
  PetscReal mz = 0;

  for (PetscInt r = 0; r < f->num_rows; r++) mz += f->compliance[r] * z[node[r]];
  return mz / f->compliance_sum;
}
/* z.S z / kappa */
static inline PetscReal ContactFacetYield(const ContactFacet *f, const PetscInt node[], const PetscReal z[])
{
  const PetscReal mean = ContactFacetMean(f, node, z);
  PetscReal       sum  = 0;

  for (PetscInt r = 0; r < f->num_rows; r++) sum += f->compliance[r] * z[node[r]] * (z[node[r]] - mean);
  return sum;
}
/* Nodes that carry no multiplier, of facets of higher order: the pressure there is z_n = sum_k weight[k] z_donor[k], k from first[n] to first[n+1] (empty:
   nothing says), since their functions went to those nodes. All NULL: facets of order 1. Valid as long as the carriers. Not collective. */
void ContactPairGetDonors(ContactPair, const PetscInt **first, const PetscInt **donor, const PetscReal **weight);

/* Candidate search at the given positions: for each listed nonmortar facet (facets[num], those this rank owns) the mortar facets it may meet while no
   node moves more than `margin`: facet normals N_s . N_m < -0.3, -depth < g < distance somewhere on the pair (margin > 0: more, but no deeper); depth is the
   distance, or what ContactPairSetHull says.
   Distances and normals are judged here only, so between two searches the evaluation is continuous. Bounding-volume tree, O(n log n). Call between Newton
   iterations only; the result is kept. Not collective. */
PetscErrorCode ContactPairSearch(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt num, const PetscInt facets[],
                                 PetscReal distance, PetscReal margin);
/* Do searches from now on go on from the one that was kept last, with the same list of facets? Pairs of facets that it found stay as long as their normals
   oppose at all and none has gone in deeper than the margin: what it takes to be found, which changes by jumps, is asked once. Off to begin with. */
void ContactPairGoOn(ContactPair, PetscBool yes);
/* The last search is that of an iterate, from which those of trial steps go on, however many there are; one that does not go on is kept by itself. */
void ContactPairKeepSearch(ContactPair);

/* How deep the last search found sides of another body that it took for far ones, though they are not clearly as deep as both bodies measure: overlaps beyond
   what can be told. 0: none. Not collective. */
void ContactPairGetUntold(ContactPair, PetscReal *depth);

/* Boxes (xmin, ymin, zmin, xmax, ymax, zmax), at most `most`, that meet the box (ContactFacetBox) of every mortar facet that ContactPairSearch with the same
   arguments may find; either both sides have facets of higher order or none. Not collective. */
PetscErrorCode ContactPairReach(ContactPair, const ContactSurface *nonmortar, PetscInt num, const PetscInt facets[], PetscReal distance, PetscReal margin,
                                PetscInt most, PetscInt *num_boxes, PetscReal box[][6]);
void           ContactFacetBox(const ContactSurface *, PetscInt facet, PetscReal box[6]);
PetscBool      ContactBoxesMeet(const PetscReal a[6], const PetscReal b[6]);
/* The pictures of mortar corners that hang in the middle of an edge follow those of its ends,
   parent[mortar num_nodes][2], -1: does not hang. After a search. Not collective. */
const PetscInt *ContactPairGetMortarParents(ContactPair);
/* Candidates of the last search: mortar facets of listed facet i are candidate[start[i] .. start[i+1]), ascending. Set: the search went on elsewhere, these
   facets are evaluated here (and listed from now on) with these candidates. */
void           ContactPairGetCandidates(ContactPair, const PetscInt **start, const PetscInt **candidate);
PetscErrorCode ContactPairSetCandidates(ContactPair, const ContactSurface *nonmortar, PetscInt num, const PetscInt facets[], const PetscInt start[],
                                        const PetscInt candidate[]);

/* Evaluate all facets of the last search at current positions. z[nonmortar num_nodes] (NULL: not known; needed for the Hessian). wanted[nonmortar num_nodes]
   (NULL: all): derivatives are needed of facets that carry weight to such a node only (three dimensions). A deterministic function of positions. Only facets
   that contribute are returned. Results stay valid until the next call. *failed (numerical status, no results): positions that are no numbers, a facet without
   extent, a nonmortar node whose edge normals cancel. Surfaces must have the topology of the last search. Not collective. */
PetscErrorCode ContactPairEvaluate(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[], const PetscBool wanted[],
                                   PetscBool derivatives, PetscBool hessian, PetscInt *num, const ContactFacet **facets, PetscBool *failed);
/* From now on normals are frozen (or follow the surface again): first derivatives are those at fixed directions of the nonmortar side and a fixed segmentation,
   gaps and weights do not change, there are no Hessians. Where gaps are wide against facets that tells more than the derivative itself. Not collective. */
void ContactPairFreezeNormals(ContactPair, PetscBool frozen);
/* Forces of facets in space that are covered in part are those of a frozen segmentation (`push`), without the motion of lines of the mortar side; from now on
   those of all facets of higher order, in the plane of those covered in part, or (as created) not. Gaps, weights and their derivatives do not change. Not
   collective. */
void ContactPairFreezeSegmentation(ContactPair, PetscBool frozen);
/* Friction. Tangential tractions traction[dim - 1][nonmortar num_nodes] of evaluations from now on, borrowed (NULL: none), on the mortar side, in the plane
   along the nonmortar facets, in space along the node's two axes, which turn with the body: results have `shear`, and Hessians the derivatives of those forces
   too, not symmetric (theory (5.10)). Not collective. */
void ContactPairSetTraction(ContactPair, const PetscReal traction[]);
/* Space: axis[nonmortar num_nodes][3] across the normal is the node's first axis, 0: the pair chooses one; NULL: all of them. Borrowed. Not collective. */
void ContactPairSetAxes(ContactPair, const PetscReal axis[]);
/* Space: the axes of a node at the last evaluation; NaN without known neighbours. Not collective. */
PetscErrorCode ContactPairGetTangents(ContactPair, PetscInt node, PetscReal e[2][3]);
/* Evaluate at these positions and keep the points of the integration with their partners. Then: slip since there (theory (5.9)) of every facet kept, as results
   with the slip for gap[dim - 1][rows] and dgap, and the weights where the points were kept; positive where the mortar side moves along the nonmortar facets.
   from[2] (NULL: nothing): both sides where the points were kept. Facets that met nothing there and do at the last evaluation, which was at these positions,
   then have slip, too: how far the points that face each other now have come, dgap with these points held.
   Surfaces must have the topology of the last search; positions of all nodes of facets kept and of their partners are needed. Valid until the next call. Not
   collective. */
PetscErrorCode ContactPairKeepPoints(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscBool *failed);
PetscErrorCode ContactPairSlip(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, const ContactSurface from[2], PetscInt *num,
                               const ContactFacet **facets);
/* The points kept, those of the last ContactPairSlip included, at positions of both sides as there: how far the mortar side has gone along the nonmortar facet
   at each, a vector. increment (NULL: none): slip is linear in these increments, the positions being those where the points were kept. The caller frees the
   array. Not collective. */
typedef struct {
  PetscInt  facet, mortar_facet;
  PetscReal xi[2], weight, slip[3]; /* place on the nonmortar facet; its part of the surface where the point was kept */
} ContactSlipPoint;
PetscErrorCode ContactPairSlipPoints(ContactPair, const ContactSurface side[2], const ContactSurface increment[2], PetscInt *num, ContactSlipPoint **points);
/* Evaluate at these positions, with `tie` in the results. Valid until the next evaluation. Not collective. */
PetscErrorCode ContactPairTie(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt *num, const ContactFacet **facets,
                              PetscBool *failed);
void           ContactPairGetSegments(ContactPair, PetscInt *num, const ContactSegment **segments);
/* Nodal normals of the last evaluation [num_nodes][dim]; NaN at nodes with neighbours that are not known here. */
const PetscReal *ContactPairGetNormals(ContactPair);
/* Bernstein polynomials of a facet of this order in m dimensions at xi of [-1, 1]^m, in the order of its lattice. */
void ContactBernstein(PetscInt m, PetscInt order, const PetscReal xi[], PetscReal B[]);
/* Overlaps of the last evaluation that could not be used: mortar facets whose corners have no picture, lie folded over or are not convex in the facet's view,
   or that rays miss. */
PetscInt ContactPairGetDegenerate(ContactPair);
