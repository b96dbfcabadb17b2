/* Floor 4. Contact between the bodies of one mesh: the surfaces of all pairs, their multipliers z_j and weighted gaps at the nodes of the nonmortar sides,
   which of them are active, nodal forces, and what all that has in a residual, a matrix and its right-hand side.

   Row of z_j: the complementarity  R_j = w0_j [ z_j - max(0, z_j - c_j gt_j / w_j) ]  (unit: force), c_j = E / extent_j, w0_j the reference tributary length
   (area) of the node. Local arrays are those of the space, [num_nodes][dim], in the frames of its nodes; vectors those of the problem that it is part of. */
#pragma once
#include "contact.h"
#include "mechanics.h"

typedef struct _p_Interface *Interface;

/* What is chosen, besides x: residual, gaps and tangent are functions of x and of this. Choices are made between Newton iterations (src/solve, its modifiers)
   and set by one call (ProblemSetForm). Sets of contact pairs: bit i for pair i. Of the residual, and kept with its state: */
typedef struct {
  PetscBool frozen_segmentation; /* contact forces with the lines of the mortar side frozen (ContactPairFreezeSegmentation) */
  PetscBool frozen_states;       /* nodes keep the states of the last evaluation, and so the branches of their rows: differences are those of one branch */
  /* of a linearisation only: */
  PetscBool    symmetric;       /* the tangent in its symmetric form, where there is one */
  uint64_t     released;        /* pairs that take no part in the tangent, their multipliers go to 0 */
  uint64_t     frozen_normals;  /* pairs with tangents at fixed directions */
  uint64_t     warm_start;      /* pairs whose active set begins as that of the last linear step (InterfaceKeepActiveSet), not as the residual tells */
  uint64_t     untouched;       /* pairs that have borne nothing yet: those nodes join the active set first that overlap the most */
  PetscBool    pressures_first; /* there nobody sticks or slips as yet */
  MaterialEdge edge;            /* what tangents expect of points on their yield surface */
  PetscReal    secant;          /* share of the secant stiffness of plastic flow in the tangent, the rest is its derivative */
  PetscReal    proximal;        /* share of the small stiffness of bodies that no support holds (MechanicsSetProximalShift) */
} Form;

#define ALL_PAIRS (~UINT64_C(0))
/* A set of one pair. Those that have no bit are in the set of all pairs alone. */
static inline uint64_t FormPair(PetscInt pair)
{
  return pair < 64 ? UINT64_C(1) << pair : 0;
}
static inline PetscBool FormHas(uint64_t pairs, PetscInt pair)
{
  return (PetscBool)(pairs == ALL_PAIRS || (pairs & FormPair(pair)));
}
/* The derivative itself, in its exact form. */
static inline Form FormPlain(PetscBool frozen_segmentation)
{
  return (Form){.frozen_segmentation = frozen_segmentation, .edge = EDGE_AS_IT_IS};
}

/* The linear system that contact writes to, as the form at hand wants it. Borrowed. */
typedef struct {
  Mat              matrix;
  PetscBool        symmetric;
  const PetscReal *increment; /* local array: of the Newton step under discussion, or the prescribed motion still to come */
  Vec              lift;      /* takes the forces of the latter; NULL: not wanted */
} InterfaceSystem;

/* ---- replicated topology, values where they are needed ---------------------------------------------------------------------- */

/* Tables of all nodes and facets of both sides are the same on every rank, and so is what belongs to the mesh. Values of the last evaluation are not: each rank
   has them at nodes it owns, at the nodes of its own facets (those of its leaves), and at those that its facets in contact depend on. Other entries are NaN;
   InterfaceGatherContactToAll knows all. */

typedef struct {
  PetscInt         dim, corners; /* of a facet: 2 or 4 */
  PetscInt         num_nodes, num_facets;
  const PetscInt  *node_entity;        /* [num_nodes] global vertex entity */
  const PetscInt  *facets;             /* [num_facets][corners], body to the left; counterclockwise seen from outside */
  const PetscInt  *facet_leaf;         /* [num_facets] */
  const PetscInt  *facet_entity;       /* [num_facets] */
  const PetscInt  *hang, *hang_master; /* [num_nodes+1] offsets: masters of a hanging node, in this table; empty: it does not hang */
  const PetscReal *hang_weight;
  const PetscReal *X;     /* [num_nodes][dim] */
  const PetscReal *x;     /* [num_nodes][dim] at the last evaluation */
  const PetscReal *force; /* [num_nodes][dim] contact force at the last residual, of owned nodes; none at hanging nodes */
  const PetscBool *owned; /* [num_nodes] this rank answers for the node: sums over nodes run over these; hanging nodes belong to nobody */
  const int8_t    *order; /* of the facets and their lattices of nodes as in contact.h */
  const PetscInt  *first, *lattice;
  PetscBool        higher; /* facets of this side or the other one are of an order above 1 */
} SurfaceView;

#define SURFACE_MOST_NODES ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1)) /* of a facet */

/* Nodes that shape a facet, those of its lattice, and their number. */
static inline PetscInt SurfaceFacetNodes(const SurfaceView *s, PetscInt facet, const PetscInt **nodes)
{
  *nodes = s->lattice + s->first[facet];
  return s->first[facet + 1] - s->first[facet];
}
/* Functions of a lattice's nodes, lexicographic, at xi[dim-1] in [-1, 1], N[...], and their derivatives by xi (NULL: not wanted). */
void SurfaceShape(PetscInt dim, PetscInt order, const PetscReal xi[], PetscReal N[], PetscReal dN[][2]);
/* Tangents by xi of a facet at nodal positions x[num_nodes][dim]; two dimensions: the second is the unit vector across. */
void SurfaceTangents(const SurfaceView *, PetscInt facet, const PetscReal x[], const PetscReal xi[], PetscReal tangent[2][3]);

typedef struct {
  const ContactSpec *spec;
  SurfaceView        nonmortar, mortar;
  PetscInt           num_z;        /* multipliers of a node */
  const PetscReal   *z;            /* [num_z][nonmortar.num_nodes] at the last evaluation: the pressure first */
  const PetscReal   *gap, *weight; /* [nonmortar.num_nodes] gt_j, w_j there */
  const PetscReal *slip; /* [nonmortar.num_nodes] friction: s_j of the step over the weight where it began, of owned nodes; in space the first of both, of views
                            gathered to all the length; NULL: none */
  const PetscReal *traction;       /* [nonmortar.num_nodes][3] friction in space, of views gathered to all: tangential traction on the mortar side; else NULL */
  const int8_t    *active;         /* [nonmortar.num_nodes] as the residual decided: 0 open, else a state of the contact law */
  const PetscBool *has_multiplier; /* [nonmortar.num_nodes]; hanging nodes: no, their z is interpolated */
  ContactPair      pair;           /* segments of this rank's nonmortar facets */
  const PetscReal *normal;         /* [nonmortar.num_nodes][dim] of views gathered to all; else NULL: ContactPairGetNormals */
  PetscReal        area, min_gap;  /* totals over ranks */
  PetscInt         stabilised;     /* facets of the nonmortar side whose multipliers are stabilised */
  PetscInt         unusable;       /* overlaps at the last evaluation that could not be used: facets folded over in the other's view */
  PetscReal        adjusted;       /* largest mean initial gap, over or under, that was closed at a node (initial_gap: adjust) */
  PetscReal        interference;   /* at the time last set */
  PetscReal        friction;       /* the coefficient then */
  const PetscReal *initial_gap;    /* [nonmortar.num_nodes] those that initial_gap: adjust closes, means over the functions of the nodes; else 0 */
} ContactView;

/* fixed[num_nodes]: as in Supports. All that is handed over must outlive the interface. Collective. */
PetscErrorCode InterfaceCreate(HPSpace, Mechanics, const MechanicsSpec *, const int8_t fixed[], PetscInt num, const ContactSpec[], Interface *);
PetscErrorCode InterfaceDestroy(Interface *);
/* Of linearisations, from now on; borrowed. Not collective. */
void InterfaceSetForm(Interface, const Form *);

/* Coefficients of friction, interferences and ramped initial overlaps are those of time t from now on; before, of t = 0. Not collective. */
PetscErrorCode InterfaceSetTime(Interface, PetscReal t);

/* rigid.c. Rigid bodies that forces move: x = C + d + R (X - C), C = point; unknowns d (0 to 2) and length times the components of the rotation vector (3 to 5)
   with rows of the matrix row[6], -1: not an unknown. spin[k]: of R by unknown 3 + k. Borrowed, and may change between evaluations; bodies must not. Before the
   pattern is asked for. */
#define INTERFACE_LINKS 8                       /* most such bodies */
#define INTERFACE_MOTIONS (6 * INTERFACE_LINKS) /* and unknowns of theirs */
typedef struct {
  PetscInt  body, row[6];
  PetscReal point[3], R[9], spin[3][3], length;
} RigidLink;
PetscErrorCode InterfaceSetRigid(Interface, PetscInt num, const RigidLink[]);
/* Derivative of the position of the material point X[dim] by an unknown (motion: its place in row), and what its row in the residual takes of the force there:
   the same, but for the spin a unit vector over length, so that rows are balances of moments about axes in space. Not collective. */
void RigidDerivative(const RigidLink *, PetscInt motion, const PetscReal X[], PetscInt dim, PetscReal dx[3]);
void RigidLever(const RigidLink *, PetscInt motion, const PetscReal X[], PetscInt dim, PetscReal lever[3]);

/* counts[rank] of unknowns grow by the multipliers of each rank, which have the places from there on in its part of a vector. Not collective. */
PetscErrorCode InterfaceNumber(Interface, PetscInt counts[]);
/* Rows of the matrix: of multipliers, counted as before, with offset[rank] added; of local dofs row[num_nodes*dim], -1: none. num_inner: unknowns of this rank
   that the matrix lacks, the first of its vector. Collective. */
PetscErrorCode InterfaceSetRows(Interface, PetscInt counts[], const PetscInt offset[], const PetscInt row[], PetscInt num_inner);

const ContactView *InterfaceGetContact(Interface, PetscInt pair);
/* Time on this rank in searches and evaluations of a pair, and of all; room: has the pair ever had room in the matrix for what faces it? Not collective. */
void InterfaceCost(Interface, PetscInt pair, PetscReal *seconds, PetscReal *all, PetscBool *room);
/* The same with the values of all nodes (forces too) and `normal` on every rank: one reduction over both surfaces, for output and the like. They stay valid
   until the next call for this pair. Collective. */
PetscErrorCode InterfaceGatherContactToAll(Interface, PetscInt pair, const ContactView **view);
/* Multipliers and (NULL: not wanted) nodal normals, positions and, of friction in space, tangential tractions on the mortar side of the last evaluation at
   wanted[nonmortar.num_nodes] nodes, from the ranks that know them: z[num_z][nonmortar num_nodes], normal[..][dim], x[..][dim], traction[..][3], NaN at others.
   Collective. */
PetscErrorCode InterfaceFetchContact(Interface, PetscInt pair, const PetscBool wanted[], PetscReal z[], PetscReal normal[], PetscReal x[],
                                     PetscReal traction[]);
/* What contact has sent from this rank since the problem was created. Values: between searches; search: positions and lists of facets, sent where boxes meet.
   Boxes of ranks and scalars, which all ranks reduce, are left out. */
typedef struct {
  PetscInt  evaluations, searches, messages, search_messages;
  PetscReal bytes, search_bytes;
} ContactTraffic;
void InterfaceGetTraffic(Interface, ContactTraffic *);
/* Components z[num_z][nonmortar.num_nodes], from the second on, of tangential tractions on the mortar side traction[..][3] along the axes of the last
   evaluation, friction in space: of this rank's own nodes. Not collective. */
PetscErrorCode InterfaceResolveTractions(Interface, PetscInt pair, const PetscReal traction[], PetscReal z[]);
/* Of a tied pair: z[dim][nonmortar.num_nodes] along the coordinates to the axes of the nodes, this rank's own. */
void InterfaceResolveTies(Interface, PetscInt pair, PetscReal z[]);
/* Set the multipliers of a pair from values[num_z][nonmortar.num_nodes] in x: each rank those of its own nodes. */
PetscErrorCode InterfaceSetMultipliers(Interface, PetscInt pair, const PetscReal z[], Vec x);
/* The opposite: values of this rank's own nodes from x, z[num_z][nonmortar.num_nodes]; others and nodes without multiplier stay as they are. Not collective.
   own[nonmortar.num_nodes] (NULL: not wanted): which these are. */
PetscErrorCode InterfaceGetMultipliers(Interface, PetscInt pair, Vec x, PetscReal z[], PetscBool own[]);
/* What room facets of a pair have been given in the matrix so far: facet f for nodes node[first[f] .. first[f+1]), mortar ones as ~node; borrowed, of facets
   evaluated on this rank; first NULL: none yet. Set: that room again, of all facets of the pair (those evaluated elsewhere are not looked at). Not
   collective. */
void           InterfaceGetPattern(Interface, PetscInt pair, const PetscInt **first, const PetscInt **node);
PetscErrorCode InterfaceSetPattern(Interface, PetscInt pair, const PetscInt first[], const PetscInt node[]);
/* The deepest overlap of a pair's sides, at the reference positions or where they are now, that the search passes over since it cannot tell it from the far
   side of a body behind; 0: none. The next solve searches anew. Collective. */
PetscErrorCode InterfaceUntoldOverlap(Interface, PetscInt pair, PetscBool reference, PetscReal *depth);

/* Is a pair tied? Not collective. */
PetscBool InterfaceTies(Interface);

/* Friction. Does a pair slip? Local displacements u of the state that slip counts from, the last accepted one, and this rank's multipliers there, as in its
   part of a vector, z[num_z of the problem]: from the next search on. Not collective. */
PetscBool      InterfaceSlips(Interface);
PetscErrorCode InterfaceSetSlipOrigin(Interface, const PetscReal u[], const PetscReal z[]);
/* What friction of a pair did from that state to that of the last evaluation; all 0 without friction. Collective. */
typedef struct {
  PetscReal dissipation; /* - sum_j q_j w_j (mean slip of node j) */
  PetscReal max_slip;    /* largest |s_j| / w_j of a node that touches */
  PetscInt  sticking, slipping;
} FrictionFigures;
PetscErrorCode InterfaceFriction(Interface, PetscInt pair, FrictionFigures *);
/* Slip from point to point of the nonmortar facets that this rank evaluates, at the last evaluation; none without friction. The caller frees it. Collective. */
PetscErrorCode InterfaceGetSlipPoints(Interface, PetscInt pair, PetscInt *num, ContactSlipPoint **points);

/* ---- residual ----------------------------------------------------------------------------------------------------------------- */

/* The candidate search at the local displacements u. Surfaces that may meet themselves are given their roles there, while they bear nothing by the multipliers
   of x and on a new mesh. goes_on: from the one kept (ContactPairGoOn). Collective. */
PetscErrorCode InterfaceSearch(Interface, Vec x, const PetscReal u[], PetscBool goes_on);
/* The last search is that of an iterate: searches that go on do so from it (ContactPairKeepSearch). Not collective. */
void InterfaceKeepSearch(Interface);
/* Gaps, weights, activity and facets at the multipliers of x and the displacements u, with derivatives of the gaps, and with Hessians too: then at the
   directions that the form wants. pending: prescribed motion still to come. Views show the last evaluation. *failed stays unless it fails. Collective. */
PetscErrorCode InterfaceEvaluate(Interface, Vec x, const PetscReal u[], PetscReal pending, PetscBool hessian, PetscBool *failed);
/* Of the last evaluation: forces off a local array; multipliers' rows into this rank's part of a vector; square of what round-off of positions leaves in both,
   this rank's part. Forces are collective. */
PetscErrorCode InterfaceForces(Interface, PetscReal local[]);
void           InterfaceRows(Interface, PetscReal r[]);
PetscReal      InterfaceNoise2(Interface);
/* Force and moment about the origin on the nonmortar side of a pair, on all ranks. Collective. */
PetscErrorCode InterfaceResultant(Interface, PetscInt pair, PetscReal force[3], PetscReal moment[3]);
/* Note: how deep the sides of each pair are in each other at most, a mean gap over a multiplier's function; the deepest of all pairs. Leave: one side
   of each pair is taken to lie further in by this share of it; at first: 0. With finite kinematics. */
PetscErrorCode InterfaceNoteOverlap(Interface, PetscReal *deepest);
void           InterfaceLeaveOverlap(Interface, PetscReal share);

/* ---- tangent, of the last evaluation -------------------------------------------------------------------------------------------- */

/* Is its tangent symmetric but for the factors of rows? */
PetscBool InterfaceIsSymmetric(Interface);
/* *grown: there is more to write than has had room so far; it has from the next matrix on. Not collective. */
PetscErrorCode InterfaceGrow(Interface, PetscBool *grown);
/* Cliques of rows of the matrix that contact couples, each row with all of its clique: those of the facets that this rank evaluates and of its multipliers. As
   one array, each clique its number of rows, then these in ascending order; the caller frees it. Not collective. */
PetscErrorCode InterfaceCliques(Interface, PetscInt *num, PetscInt **cliques);
/* Has it active constraints whose forces hold lines of the mortar side (ContactFacet.push)? Collective. */
PetscErrorCode InterfaceHoldsLines(Interface, PetscBool *holds);
/* Hessians and columns, added; then, after the matrix is flushed, rows, which replace what is there. Collective. */
PetscErrorCode InterfaceBlocks(Interface, const InterfaceSystem *);
PetscErrorCode InterfaceInsertRows(Interface, const InterfaceSystem *);
/* Right-hand side of the multipliers' rows, and what goes to the forces with it. Multipliers from the unknowns of the symmetric form, in this rank's part of a
   vector. Collective. */
PetscErrorCode InterfaceRightSide(Interface, const InterfaceSystem *, Vec rhs);
void           InterfaceScaleIncrement(Interface, PetscReal dx[]);
/* Of a Newton step: the multipliers of open nodes go to 0, as their rows say but for round-off. Collective. */
PetscErrorCode InterfaceOpenIncrement(Interface, Vec dx);
/* Which nodes that disagree with a linear step switch: all, the one farthest off as a force, or the last one. */
typedef enum { SWITCH_ALL, SWITCH_WORST, SWITCH_LAST } SwitchRule;
/* One pass of the active set: as ProblemSwitchActiveSet, but for the assembly of the matrix. */
PetscErrorCode InterfaceSwitch(Interface, const InterfaceSystem *, Vec dx, SwitchRule, Vec rhs, PetscInt *disagree);

/* ---- what a form may be chosen by, at the last evaluation. All collective ------------------------------------------------------- */

/* Pairs (of those not released) whose active set of the last linear step moves along the surface, while prescribed motion is still to come and kinematics are
   finite: gaps linearised at the old place say little of the new one. With friction: those that slip by a good part of the zone in the mean; swap: those that
   do not. */
PetscErrorCode InterfaceFindSliding(Interface, PetscReal pending, PetscBool swap, uint64_t *pairs);
/* Pairs whose open gaps under pressure are too wide, against their facets, for the turning of directions to mean anything; and those without pressure. */
PetscErrorCode InterfaceFindWide(Interface, uint64_t *pairs);
/* carryforce.c: weights at the state that was evaluated last are kept; then, after a step dx along which weights have grown where facets were covered in part,
   the change of the multipliers there is taken as one of forces. changed: there was one. Collective. */
void           InterfaceKeepWeights(Interface);
PetscErrorCode InterfaceCarryForces(Interface, Vec dx, PetscBool *changed);
/* corner.c: sharp corners (in space the ends of sharp edges) of mortar sides of these pairs (bits ContactSpec.pair) that press within facets of the nonmortar
   side, or at nodes of it, while nothing beside them does: the side with the corner is the better one to carry the multipliers. */
typedef struct {
  PetscInt  pair;   /* ContactSpec.pair */
  PetscInt  splits; /* of facets at the corner, until they are less than twice as long as those that it presses on */
  PetscReal X[3];   /* reference position */
} InterfaceCorner;
/* At the last evaluation; near: also those that are about to, off by less than a tenth of the facet. Freed by the caller. Collective. */
PetscErrorCode InterfaceFindCorners(Interface, uint64_t pairs, PetscBool near, PetscInt *num, InterfaceCorner **corners);
/* Of these pairs those whose nonmortar sides press beside the facets at their sharp corners, and on one side of each of these alone: there zones of contact
   end. Collective. */
PetscErrorCode InterfaceFindSpread(Interface, uint64_t pairs, uint64_t *spread);
/* Pairs that have borne nothing yet. */
PetscErrorCode InterfaceFindUntouched(Interface, uint64_t *pairs);
/* At each iterate of a solve: notes in which facets the mortar side ends, and which that changed for while they bore. begin: what was noted is forgotten, as at
   the first iterate. Not collective. */
void InterfaceWatchEnds(Interface, PetscBool begin);
/* Are there facets under pressure whose forces frozen segmentation would change? In the plane those in which the mortar side ends: any of them, if that is set
   or the surface may meet itself; else those over whose end it went and came back (InterfaceWatchEnds). Collective. */
PetscErrorCode InterfaceMayFreezeSegmentation(Interface, PetscBool any, PetscBool *yes);
/* The states at hand are those that a warm start begins with. Returns the pairs in which a node of this rank bears, as bits. Not collective. */
uint64_t InterfaceKeepActiveSet(Interface);
/* A number that tells active sets and their states apart, the same on every rank. Collective. */
PetscErrorCode InterfaceActiveSetHash(Interface, uint64_t *hash);

/* ---- augmented Lagrangian (merit.c): z_j = max(0, lambda_j - kappa_j g_j), kappa_j = factor c_j --------------------------------- */

/* Its contact part at the displacements u, added to *energy (this rank's part); forces off the local array r (NULL: not wanted); x gets its multipliers from
   those of lambda. Collective. */
PetscErrorCode InterfaceMerit(Interface, PetscReal factor, Vec lambda, const PetscReal u[], PetscReal pending, PetscReal r[], Vec x, PetscReal *energy,
                              PetscBool *failed);
/* At the last one, in a vector of the problem: overlap at each node over its extent along the surface, 0: open, -1: it meets nothing. */
PetscErrorCode InterfaceMeritDepth(Interface, Vec depth);
/* Contact at x with its Hessian and which nodes press (open: none do); Hessians into the matrix, rows and columns of the multipliers. Collective. */
PetscErrorCode InterfaceMeritEvaluate(Interface, Vec x, const PetscReal u[], PetscReal pending, PetscBool open, PetscBool *failed);
PetscErrorCode InterfaceMeritHessians(Interface, const InterfaceSystem *);
PetscErrorCode InterfaceMeritRows(Interface, const InterfaceSystem *, PetscReal factor);
