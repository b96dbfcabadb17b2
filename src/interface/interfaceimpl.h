/* Private to interface. */
#pragma once
#include "interface.h"

#include <petscsf.h>

#define NEAR 0.1     /* of an extent, of a distance: what may meet, or come to meet before the next search */
#define MOST_REALS 4 /* of a node in one message */
#define SLACK 1e-10  /* pressure over Young's modulus that is none: what round-off leaves */

#define MOST_LATTICE_MASTERS 64 /* of a hanging node of a lattice: two ends that hang on edges themselves, and so on */

/* Values of some nodes of a surface on their way between the ranks that own them and those that use them. */
typedef struct {
  PetscSF     sf;               /* roots and leaves have the nodes' numbers */
  PetscInt    num, *nodes;      /* that this rank uses and does not own, ascending */
  PetscMPIInt num_from, num_to; /* owners that this rank hears from, users that it tells */
  PetscInt    num_told;         /* entries told to all of them together */
} Link;

/* ---- contact laws (law/): what the multipliers of a node fulfil -------------------------------------------------------------- */

#define MOST_MULTIPLIERS 3 /* of a node */

/* What keeps the sides together at a node, in one component. weight 0: nothing does. */
typedef struct {
  PetscReal gap, weight, lift, spring;
} TiePoint;

/* A node of the nonmortar side: what its rows are made of. */
typedef struct {
  const ContactSpec *spec;
  int8_t             state;
  PetscInt           num;                                             /* multipliers */
  PetscReal          z[MOST_MULTIPLIERS], gap, weight, spring, w0, c; /* as in Contact; gap: with what the pressures of others add, S_jl z_l */
  PetscReal          lift;                                            /* change of the gap by the motion still to come */
  PetscInt           dim;
  PetscReal          friction;                           /* coefficient */
  PetscReal          slip[2], slip_weight, slip_lift[2]; /* of the step, as the gap; the weight where it began, 0: nothing was met there */
  PetscReal          aim[3];                             /* space: unit vector against the slip and a factor, from ContactLawOps.aim */
  PetscReal          q[2];                               /* tangential traction where the step began */
  PetscInt           held, plane;                        /* axes along which supports hold it, and of these, planes of symmetry; the first ones */
  TiePoint           tie[MOST_MULTIPLIERS];              /* law tied: of each component */
} ContactPoint;

/* One of its rows, linearised:  factor [grad (gt + S z)_j - mean grad w - along grad S_jj] . du + factor sum_l S_jl dz_l + sum_k z_k dz_k = side,  l other
   nodes. value: of a node that bears, the gap that has to vanish. push: the derivative of the forces by z_j (ContactFacet.push) stands for the gradient;
   slip: factors of the gradients of the slip along the axes, which are added; component: of a tied pair. */
typedef struct {
  PetscReal factor, mean, along, z[MOST_MULTIPLIERS], side, value, slip[2];
  PetscBool push;
  PetscInt  component;
} ContactRow;

/* num_multipliers of a node in this dimension; the first is the pressure. symmetric: its tangent is symmetric but for the factors of rows.
   ties: the multipliers are a traction that keeps together what faces each other at the reference positions.
   slips: the others are tangential tractions, and the slip of the step is known.
   aim: space: where rows of a node that slips are linearised, [3]; it stays as long as the node slips and nothing is evaluated anew.
   state: that of a node with these multipliers, gap and weight, 0: open. rows: one for each multiplier, in this state; the residual is -side without lift.
   symmetric: factor and z of a row such that it is a column of the symmetric tangent as well, its unknown z over c. */
typedef struct {
  const char *name;
  PetscBool   symmetric, slips, ties;
  PetscInt (*num_multipliers)(PetscInt dim);
  int8_t (*state)(const ContactPoint *);
  void (*rows)(const ContactPoint *, PetscBool symmetric, ContactRow row[]);
  PetscBool (*slides)(int8_t state); /* does it slip? */
  void (*aim)(const ContactPoint *, PetscReal aim[3]);
} ContactLawOps;

extern const ContactLawOps *const ContactLaws[];
/* frictionless.c: the pressure alone; its row, of a constraint with compliance S (length times measure over pressure) that grows with w by this slope. */
PetscInt ContactOneMultiplier_Private(PetscInt dim);
void     ContactCompliantRow_Private(const ContactPoint *, PetscReal S, PetscReal slope, PetscBool symmetric, ContactRow *);

/* One side of a contact pair. Topology and what belongs to the mesh (reference positions, frames, places in the vector) are replicated on every rank; current
   values are not: a rank has those of nodes it owns, of nodes its cells or ghost cells depend on (positions), and of nodes that facets in contact need
   (exchange.c). All other entries are NaN. Hanging nodes have positions, which follow their masters', but no unknowns. */
typedef struct {
  PetscInt   dim, corners; /* 2 or 4 corners of a facet */
  PetscInt   num_nodes, num_facets;
  PetscInt  *node_entity;        /* [num_nodes] */
  PetscInt  *node_index;         /* [num_nodes] place among the entity's nodes; -1: a lattice node in an edge of lower order, which is no node of the space */
  PetscInt  *facets;             /* [num_facets][corners] body to the left; counterclockwise seen from outside */
  PetscInt  *facet_leaf;         /* [num_facets] */
  PetscInt  *facet_entity;       /* [num_facets] */
  PetscInt  *hang, *hang_master; /* [num_nodes+1] offsets, nodes of this surface; empty: does not hang */
  PetscReal *hang_weight;
  int8_t    *order; /* as in contact.h */
  PetscInt  *first, *lattice;
  PetscBool  higher;                  /* facets of this side or the other one are of an order above 1 */
  PetscInt  *true_first, *true_node;  /* [num_facets+1] offsets, ascending: nodes of the facet, masters for those that hang, and of lattices that share a
 hanging corner with it: their multiplier functions are made together */
  PetscInt  *node_first, *node_facet; /* [num_nodes+1] offsets: facets that carry weight to the node, those with it as a true node */
  PetscBool *rim;                     /* [num_nodes] as in ContactSurface; NULL: none */
  PetscBool *met;                     /* [num_facets] facets of the colour that is met; NULL: all of them */
  PetscReal *X, *x, *du;              /* [num_nodes][dim] reference and current position; increment under discussion */
  PetscReal *mirror;                  /* normals of symmetry planes as in ContactSurface, else 0 */
  PetscReal *frame;                   /* [num_nodes][dim][dim] rows: directions of the dofs */
  PetscInt  *dof;                     /* [num_nodes][dim] row of the matrix, -1: prescribed, hanging */
  PetscInt  *local;                   /* [num_nodes] local node on this rank or -1 */
  PetscBool *owned;                   /* [num_nodes] this rank owns the node and it does not hang */
  PetscReal *force;                   /* [num_nodes][dim] contact force at the last residual: of owned nodes, 0 at hanging ones */

  PetscMPIInt *owner;           /* [num_nodes] rank that knows the node's values: of a hanging one that of the first facet that has it */
  PetscInt     num_own, *own;   /* nodes with `owned` */
  PetscInt     num_mine, *mine; /* facets of this rank's leaves */
  PetscBool   *here;            /* [num_nodes] does not hang, displacement in the local array of this rank */
  PetscBool   *has;             /* [num_nodes] current position known here */
  Link         places, values;  /* of nodes that are not here; of nodes that are not owned */
} Surface;

/* Slip of a step (slip.c). */
typedef struct {
  PetscInt            size;
  PetscReal          *from;          /* [size] local displacements that it counts from */
  PetscBool           stale;         /* points are not kept there yet */
  Link                places[2];     /* of nodes that facets kept and their partners need */
  PetscReal          *slip, *weight; /* [dim - 1][n] s_j + (C dq)_j at the last evaluation, [n] w_j where it counts from */
  PetscReal          *q, *coupled;   /* [dim - 1][n] tractions where it counts from; (C dq)_j at the last evaluation */
  PetscReal          *mean;          /* [dim - 1][n] s_j / w_j */
  PetscReal          *change, *lift; /* [dim - 1][n] as those of the gaps */
  PetscReal          *aim;           /* space: [n][3] as in ContactPoint */
  PetscReal          *axis;          /* space: [n][3] along which a support holds it, else 0 */
  PetscInt           *held, *plane;  /* [n] as in ContactPoint */
  PetscInt           *result;        /* [num_facets] position of a facet in `facets`, -1: it met nothing */
  PetscInt            num_facets;
  const ContactFacet *facets;
} SlipHistory;

/* Tied pairs (tie.c), by components k of the traction along the axes of the nodes' frames. Facets: rows as those of contact, with storage of their own. tie:
   [rows][num][dim] by positions; arm: [rows][3][3] vectors by those of the facet; start: [rows] at the reference positions; soft: [rows][dim][rows] compliance
   by components of others, NULL: none. */
typedef struct {
  ContactFacet facet, bend; /* bend: second derivatives alone, by the masters of the facet's corners */
  PetscBool    bends;
  PetscReal   *weight, *gap, *tie, *start, *arm, *dgap, *hessian, *soft;
} TieFacet;

/* The nodes' functions for what acts along a direction in which supports hold nodes (tiecarrier.c). The first of a pair: nothing is held. */
typedef struct {
  PetscReal  along[3];
  PetscBool *carries, *late;      /* [n] of ContactPairSetCarriers */
  PetscBool *here;                /* [num_facets] some of its nodes are held so */
  PetscInt  *donor_first, *donor; /* ContactPairGetDonors */
  PetscReal *donor_weight;
} TieFunctions;

typedef struct {
  PetscInt      num_facets[3], *result[3]; /* as those of Contact */
  TieFacet     *facets[3];
  PetscBool    *carries;             /* [dim][n] there is a row */
  PetscReal    *weight, *gap, *lift; /* [dim][n] as those of Contact; gap: with what compliances add, S z */
  PetscReal    *spring;              /* [dim][n] S_jj */
  PetscReal    *z;                   /* [dim][n] along the coordinates, what is shown: where there is no row, from other nodes */
  PetscInt      num_functions, room;
  TieFunctions *functions;
} Tie;

/* Of a nonmortar facet, plane: does the mortar side end within it (-1: it met nothing yet in this solve), and how often has that changed while it bore?
   (force.c) */
typedef struct {
  PetscInt ends, changes;
} EndWatch;

typedef struct {
  const ContactSpec   *spec;
  const ContactLawOps *law;
  PetscInt             num; /* multipliers of a node, which have rows and places side by side */
  ContactPair          pair;
  PetscInt            *part[2]; /* of the facets of both sides */
  Surface              side[2]; /* 0 nonmortar, 1 mortar */
  ContactView          view;
  PetscInt            *zdof;                     /* [n] row of the first in the matrix, -1: no multipliers */
  PetscInt            *zlocal;                   /* [n] its position in this rank's part of the vector, -1: not here */
  PetscReal           *z;                        /* [num][n] */
  PetscReal           *gap, *weight, *spring;    /* [n] spring: S_jj of contact.h */
  PetscReal           *before;                   /* [n] weight at the last linearisation of nodes of facets covered in part; else infinite */
  PetscReal           *coupled;                  /* [n] sum of S_jl z_l over other nodes */
  PetscReal           *softness;                 /* [n] extent / E */
  PetscReal           *stabilisation;            /* owned, by facet: kappa besides that of what is covered; NULL: none (stabilise.c) */
  PetscReal           *w0, *extent, *c;          /* [n] reference measure, its extent along the surface, E / extent */
  PetscReal           *change;                   /* [n] work: change of gt_j at fixed measure under an increment */
  PetscReal           *lift;                     /* [n] the same for the prescribed motion still to come */
  PetscInt            *result;                   /* [num_facets] position of a facet in `facets`, -1: not evaluated here */
  int8_t              *active;                   /* [n] state of the law; 0: open */
  PetscBool           *has_multiplier, *near;    /* [n] near: takes part in the next linear solve */
  PetscBool           *shared;                   /* [n] other pairs constrain it, too (shared.c); NULL: does not matter */
  PetscInt             num_listed, *listed;      /* nonmortar facets this rank evaluates */
  PetscBool           *mine;                     /* [num_facets] a side of this rank's leaves */
  PetscBool           *live;                     /* [num_facets] may meet the mortar side, as far as this rank is told (its own facets, those around) */
  PetscBool           *valued;                   /* [n] z, gap, weight, activity known here */
  PetscInt             num_valued, *valued_node; /* their list */
  PetscReal           *pack;                     /* [n][4] work: gap, weight, spring and coupled in one message */
  PetscReal           *all_real[2];              /* values gathered to all, see gather.c */
  int8_t              *kept;                     /* [n] of this rank's nodes: states that a warm start begins with */
  int8_t              *all_active;
  ContactView          all;
  EndWatch            *watch;      /* [num_facets] in the solve at hand */
  PetscReal            distance;   /* search distance */
  PetscInt             num_facets; /* results of the last evaluation */
  const ContactFacet  *facets;
  ContactFacet        *frozen;              /* small kinematics: those at the reference positions */
  PetscReal           *gap0, *mean0;        /* [n] small kinematics: gaps there, over weights; mean0 NULL: not yet, or finite */
  PetscReal           *offset;              /* [n] constant part of gt_j that does not count: initial gaps closed, interference */
  PetscReal           *initial_gap;         /* [n] see ContactView */
  PetscReal           *reach, *initial;     /* offset.c: [n] what an interference of 1 adds to the offset; initial gap that is closed */
  PetscReal           *closed, *corner_gap; /* offset.c: [n] length at corners that counts as no gap; initial gap there; NULL: offsets do all */
  PetscReal            ramped, ramp_share;  /* overlap.c: the deepest at the reference positions, where the scene ramps it, and the share that counts as none */
  PetscReal            overlap, overlap_share, allowance; /* the same where a recovery does; what of both counts as none … */
  PetscInt             shrinks;                           /* … for which this side … */
  PetscReal           *inward[2], *moved[2];              /* … lies further in: [n][dim] by 1, reference positions then; NULL: not yet made */
  int8_t              *link[2];                           /* rigid.c: [n] body of each side's nodes among the links; NULL: there are none */
  PetscInt             num_q, q_row[INTERFACE_MOTIONS], q_motion[INTERFACE_MOTIONS]; /* unknowns of the bodies of this pair */
  const RigidLink     *links, *q_link[INTERFACE_MOTIONS];
  PetscReal            seconds;                  /* in searches and evaluations */
  PetscInt            *pattern_offset, *pattern; /* [num_facets+1]: nodes each facet has room for in the matrix */
  SlipHistory         *slip;                     /* NULL: the law has no friction */
  Tie                 *tie;                      /* NULL: the pair is not tied */
  PetscInt            *precedence;               /* roles.c: [num_facets] of a surface with itself; NULL: not chosen yet */
} Contact;

struct _p_Interface {
  MPI_Comm             comm;
  PetscMPIInt          rank, size;
  PetscInt             dim;
  Forest               forest;
  const ForestTables  *tables; /* of the forest */
  HPSpace              space;
  Mechanics            mechanics;
  const MechanicsSpec *spec;
  const int8_t        *fixed; /* as in Supports */
  const Form          *form;
  PetscInt             num_contacts;
  Contact             *contacts;
  ContactHull          hull;                 /* hull.c; NULL without contact */
  PetscInt            *part;                 /* [num_cells of the coarse mesh] */
  PetscInt             num_inner;            /* unknowns of this rank that the matrix lacks, the first of its vector */
  PetscInt             first_z;              /* place of the first multiplier in this rank's part of a vector */
  MPI_Datatype         unit[MOST_REALS + 1]; /* as many reals */
  ContactTraffic       traffic;
  PetscInt             num_links;
  const RigidLink     *links; /* borrowed */
  RowBuffer            work;
  PetscReal           *hessian; /* work: of a facet */
  PetscInt             hessian_size;
};

PetscErrorCode SurfaceFields_Private(Interface, Surface *); /* after the topology */
/* Facets of a boundary group; with face (ContactSpec) Surface.met tells those of the colour. */
typedef struct {
  PetscInt      group, colour;
  const int8_t *face;
} SurfaceFacets;
PetscErrorCode SurfaceCreate_Private(Interface, const char *pair, const SurfaceFacets *, Surface *);
/* lattice.c: after the corners: nodes on the lattices of the facets, rows of those that hang. */
PetscErrorCode SurfaceLattice_Private(HPSpace, const ForestTables *, Surface *);
/* Nodes of a facet's lattice; returns their number. */
static inline PetscInt SurfaceNodes_Private(const Surface *s, PetscInt facet, const PetscInt **nodes)
{
  *nodes = s->lattice + s->first[facet];
  return s->first[facet + 1] - s->first[facet];
}
/* The nodes that a node follows with their weights, itself where it does not hang; returns their number. */
static inline PetscInt SurfaceRow_Private(const Surface *s, const PetscInt *n, const PetscInt **master, const PetscReal **weight)
{
  static const PetscReal one = 1;
  const PetscInt         num = s->hang[*n + 1] - s->hang[*n];

  *master = num ? s->hang_master + s->hang[*n] : n;
  *weight = num ? s->hang_weight + s->hang[*n] : &one;
  return PetscMax(1, num);
}
PetscErrorCode SurfaceDestroy_Private(Surface *);
PetscErrorCode SurfaceIndices_Private(Interface, const PetscInt row[], Surface *);
ContactSurface SurfaceAt_Private(const Surface *, const PetscReal x[]);
/* shape.c: of a facet with nodes node[num] of an order as in SurfaceShape: the functions at xi and the tangents. */
void SurfaceTangents_Private(PetscInt dim, PetscInt order, PetscInt num, const PetscInt node[], const PetscReal x[], const PetscReal xi[], PetscReal N[],
                             PetscReal tangent[2][3]);
/* Measure at xi of a facet per unit of xi (length or area, axisymmetric: of revolution) and the functions of its nodes there. */
PetscReal SurfacePoint_Private(const Surface *, PetscInt facet, const PetscReal x[], const PetscReal xi[], PetscBool axisymmetric, PetscReal N[]);
/* Length or area of a facet at positions x, between its corners. */
PetscReal SurfaceMeasure_Private(const Surface *, const PetscReal x[], PetscInt facet);
void      SurfaceFollow_Private(const Surface *, PetscInt num, PetscReal values[]);
/* Cartesian values from a local array of dofs at the nodes that are here and those that follow them, added to base (NULL: 0). No exchange. */
void SurfacePlace_Private(const Surface *, const PetscReal local[], const PetscReal base[], PetscReal values[]);
/* The same at all nodes with `has`: through `places` from their owners. Collective. */
PetscErrorCode SurfaceGather_Private(Interface, const Surface *, const PetscReal local[], const PetscReal base[], PetscReal values[]);

/* exchange.c. Link: nodes (ascending, none owned) this rank uses from now on. Spread: owners' values[..][size] to the users; Collect: users' added to the
   owners'. All collective, messages only between ranks that share a node. */
PetscErrorCode LinkSet_Private(Interface, const Surface *, PetscInt num, const PetscInt nodes[], Link *);
PetscErrorCode LinkDestroy_Private(Link *);
PetscErrorCode LinkSpread_Private(Interface, const Link *, PetscInt size, PetscReal values[]);
PetscErrorCode LinkCollect_Private(Interface, const Link *, PetscInt size, PetscReal values[]);
/* Positions known without exchange; `has` says so and everything else is forgotten. */
void SurfaceForget_Private(Surface *);
/* After a search: what this rank needs until the next one. */
PetscErrorCode ContactLink_Private(Interface, Contact *);
PetscBool      ContactSees_Private(const Contact *, PetscInt node);
/* nearby.c: search at the positions at hand, X when reference is set, where facets meet over the boundaries of ranks. Collective. */
PetscErrorCode ContactSearch_Private(Interface, Contact *, PetscBool reference, PetscReal margin);
/* roles.c: of a surface with itself, after a search: which facet of two that face each other is the nonmortar one. Chosen where none are yet, and as long as
   the pair bears nothing; the same for all its parts. x, u: as in InterfaceSearch. Collective. */
PetscErrorCode ContactRoles_Private(Interface, PetscInt num, Contact part[], Vec x, const PetscReal u[]);
/* couple.c: multipliers from the vector to the ranks that use them. Collective. */
PetscErrorCode ContactGatherMultipliers_Private(Interface, Contact *, Vec x);

/* Reference positions X[2 or 4][dim] of a facet's corners, in the order of Surface.facets. Not collective. */
PetscErrorCode SurfaceCorners_Private(Forest, PetscInt facet, PetscInt leaf, PetscReal X[]);
/* hull.c: p->hull and p->part; parts of a surface's facets, freed by the caller. Not collective. */
PetscErrorCode HullCreate_Private(Interface);
PetscErrorCode HullParts_Private(Interface, const Surface *, PetscInt **part);
/* The deepest overlap of a pair that can be told from a far side: half of what both bodies measure; 0 where the scene limits the search. Not collective. */
void HullDepth_Private(Interface, const Contact *, PetscReal *deepest);

PetscErrorCode ContactCreate_Private(Interface, const ContactSpec *, Contact *);
PetscErrorCode ContactDestroy_Private(Contact *);
PetscErrorCode ContactEvaluate_Private(Interface, Contact *, Vec x, const PetscReal local[], PetscReal pending, PetscBool derivatives, PetscBool hessian,
                                       PetscBool *failed);
/* force.c: nodal forces sum_j z_j grad gt_j - measure_j grad w_j of this rank's facets on both sides; measure NULL: none, and held lines count
   (ContactFacet.push). From there to the owners of their nodes, and off r, in the nodes' frames. Collective. */
void           ContactFacetForces_Private(Contact *, const PetscReal z[], const PetscReal measure[]);
PetscErrorCode ContactForcesSubtract_Private(Interface, Contact *, PetscReal r[]);
/* Does the form take the pair out of the tangent? */
static inline PetscBool ContactIsReleased_Private(Interface p, const Contact *c)
{
  return FormHas(p->form->released, (PetscInt)(c - p->contacts));
}
/* rigid.c, where bodies move by forces. Forces: rows q[num_q] from the entries v[dim num] of a facet's nodes. Hessian: what a facet's adds to the rows and
   columns of q. */
void           ContactRigidForces_Private(const Contact *, const ContactFacet *, const PetscReal v[], PetscReal q[]);
PetscErrorCode ContactRigidHessian_Private(const InterfaceSystem *, const Contact *, const ContactFacet *, const PetscInt dofs[], const PetscReal H[]);
/* tangent.c: a facet's Hessian, added. rows.c: rows of node j, with their columns in the symmetric form. */
PetscErrorCode ContactFacetHessian_Private(Interface, const InterfaceSystem *, const Contact *, const ContactFacet *);
PetscErrorCode ContactInsertRow_Private(Interface, const InterfaceSystem *, const Contact *, PetscInt j, const ContactRow row[]);
/* Nodes of a facet's result: of which side, and which; their frame. */
#define NODE_SIDE(id) ((id) < 0)
#define NODE_INDEX(id) ((id) < 0 ? ~(id) : (id))

static inline const PetscReal *NodeFrame_Private(const Contact *c, PetscInt id)
{
  const Surface *s = &c->side[NODE_SIDE(id)];
  return s->frame + s->dim * s->dim * NODE_INDEX(id);
}

/* Components along the rows of the frame. */
static inline void NodeTurn_Private(PetscInt dim, const PetscReal *q, PetscReal v[], PetscInt stride)
{
  PetscReal t[3];
  for (PetscInt d = 0; d < dim; ++d) {
    t[d] = 0;
    for (PetscInt a = 0; a < dim; ++a) t[d] += q[dim * d + a] * v[a * stride];
  }
  for (PetscInt d = 0; d < dim; ++d) v[d * stride] = t[d];
}
/* tie.c: nothing where the pair is not tied, but for the others. Create: after all surfaces and before rows of the matrix are known. Evaluate: after positions
   and multipliers are gathered. Change: of every owned node's rows, [dim][n]. Forces: of this rank's facets, added. All but Point, Forces and Destroy
   collective. */
PetscErrorCode TieCreate_Private(Interface, Contact *);
/* tiecarrier.c: the functions, before the rows of the matrix are known. has_multiplier: nodes that carry any component. Collective. */
PetscErrorCode TieCarriers_Private(Interface, Contact *);
/* tiesum.c: facets and their rows; weights and compliances of the nodes. Collective. */
PetscErrorCode TieSum_Private(Interface, Contact *);
/* Diagonals e[0], e[1] of a facet with these corners and its vector e[2]; plane: e[1] = e_z. */
void TieFrame_Private(const Surface *, const PetscReal x[], PetscInt facet, PetscReal e[3][3]);
/* Axis k of the frame of a node. */
static inline void TieAxis_Private(const Surface *s, PetscInt node, PetscInt k, PetscReal axis[3])
{
  for (PetscInt d = 0; d < 3; ++d) axis[d] = d < s->dim ? s->frame[s->dim * (s->dim * node + k) + d] : 0;
}
/* Does a support hold the node along it? Until the rows of the matrix are known. */
static inline PetscBool TieHolds_Private(const Surface *s, PetscInt node, PetscInt k)
{
  return (PetscBool)((s->dof[s->dim * node] >> k) & 1);
}
PetscErrorCode TieDestroy_Private(Contact *);
PetscErrorCode TieEvaluate_Private(Interface, Contact *);
PetscErrorCode TieChange_Private(Interface, Contact *, const PetscReal increment[], PetscReal change[]);
void           TieForces_Private(Contact *);
void           TiePoint_Private(const Contact *, PetscInt j, PetscBool lifted, ContactPoint *);
/* Node j as its law sees it, and its rows. lifted: with the motion still to come. */
static inline ContactPoint ContactPoint_Private(const Contact *c, PetscInt j, PetscBool lifted)
{
  ContactPoint point = {.spec   = c->spec,
                        .num    = c->num,
                        .state  = c->active[j],
                        .gap    = c->gap[j] + c->coupled[j],
                        .weight = c->weight[j],
                        .spring = c->spring[j],
                        .w0     = c->w0[j],
                        .c      = c->c[j]};

  if (lifted) point.lift = c->lift[j];
  point.dim      = c->side[0].dim;
  point.friction = c->view.friction;
  if (c->slip) {
    point.slip_weight = c->slip->weight[j];
    for (PetscInt i = 0; i < point.dim - 1; ++i) {
      point.slip[i] = c->slip->slip[c->side[0].num_nodes * i + j];
      point.q[i]    = c->slip->q[c->side[0].num_nodes * i + j];
      if (lifted) point.slip_lift[i] = c->slip->lift[c->side[0].num_nodes * i + j];
    }
    for (PetscInt i = 0; i < 3 && point.dim == 3; ++i) point.aim[i] = c->slip->aim[3 * j + i];
    point.held  = c->slip->held[j];
    point.plane = c->slip->plane[j];
  }
  if (c->tie) TiePoint_Private(c, j, lifted, &point);
  for (PetscInt k = 0; k < c->num; ++k) point.z[k] = c->z[c->side[0].num_nodes * k + j];
  return point;
}
/* compliance.c: (S z)_j without S_jj z_j at this rank's nodes; idle: of open nodes only, at node j. */
void      ContactCoupling_Private(const Contact *, const PetscReal z[], PetscReal coupled[]);
PetscReal ContactIdle_Private(const Contact *, PetscInt j);
/* S_jl of facet e between rows k and l. */
static inline PetscReal ContactCompliance_Private(const ContactFacet *e, PetscInt k, PetscInt l)
{
  return e->kappa[0] * e->compliance[k] * ((PetscReal)(k == l) - e->compliance[l] / e->compliance_sum);
}
/* A facet's last result; of a tied pair that of a component. NULL: it meets nothing. */
static inline const ContactFacet *ContactResult_Private(const Contact *c, PetscInt component, PetscInt facet)
{
  const PetscInt at = c->tie ? c->tie->result[component][facet] : c->result[facet];

  if (at < 0) return NULL;
  return c->tie ? &c->tie->facets[component][at].facet : &c->facets[at];
}
/* Of a tied pair: compliance of component k of a row by the others, [dim][rows]; NULL: none. */
static inline const PetscReal *TieSoft_Private(const Contact *c, PetscInt k, const ContactFacet *e, PetscInt row)
{
  const TieFacet *f = &c->tie->facets[k][c->tie->result[k][e->facet]];
  return f->soft ? f->soft + c->num * e->num_rows * row : NULL;
}
/* S between row k of facet e, of this component, and row l; of a tied pair row l % num_rows, component l / num_rows. */
static inline PetscReal ContactSoft_Private(const Contact *c, PetscInt component, const ContactFacet *e, PetscInt k, PetscInt l)
{
  return c->tie ? TieSoft_Private(c, component, e, k)[l] : ContactCompliance_Private(e, k, l);
}
/* Of the facets around node j, place i of node_facet: the facet where it has a compliance, and the row of j there; else NULL. */
static inline const ContactFacet *ContactCompliant_Private(const Contact *c, PetscInt component, PetscInt j, PetscInt i, PetscInt *row)
{
  const ContactFacet *e = ContactResult_Private(c, component, c->side[0].node_facet[i]);

  if (!e || !(c->tie ? TieSoft_Private(c, component, e, 0) : e->compliance)) return NULL;
  for (*row = 0; *row < e->num_rows; ++*row)
    if (e->nodes[*row] == j) return e;
  return NULL;
}
/* Derivative of (S z)_j - along S_jj by the facet's covered share, row k. */
PetscReal ContactYield_Private(const Contact *, const ContactFacet *, PetscInt k, PetscReal along);
/* Change of every owned node's weighted gap, at fixed measure, under a local array of increments. Collective. */
PetscErrorCode ContactChange_Private(Interface, Contact *, const PetscReal increment[], PetscReal change[]);
/* More than round-off of its tributary measure: forces have faded before (blend.c in contact). */
static inline PetscBool ContactCovered_Private(const Contact *c, PetscInt j)
{
  return (PetscBool)(c->weight[j] > CONTACT_ROUND * c->w0[j]);
}
/* Does node j bear? Less than SLACK is all there is where the whole pair is open. */
static inline PetscBool ContactPressed_Private(const Contact *c, PetscInt j)
{
  return (PetscBool)(c->has_multiplier[j] && c->z[j] > SLACK * c->c[j] * c->extent[j]);
}
/* overlap.c: the deepest overlap at the gaps of the last evaluation, which is at the reference positions, is ramped. Collective. */
PetscErrorCode ContactRamp_Private(Interface, Contact *);
/* The share of it that counts as none. */
void ContactLeaveRamp_Private(Contact *, PetscReal share);
/* The positions that displacements of a side count from. */
const PetscReal *ContactBase_Private(const Contact *, PetscInt side);
void             ContactRows_Private(const Contact *, PetscInt j, PetscBool lifted, PetscBool symmetric, ContactRow row[]);
/* Increment of a row of a facet, by its gradient, under nodal increments du of both sides. */
PetscReal ContactFacetDot_Private(const Contact *, const ContactFacet *, const PetscReal *gradient);
/* How far node j and the other side are into each other, after the change as linearised. */
static inline PetscReal ContactOverlap_Private(const Contact *c, PetscInt j)
{
  return -(c->gap[j] + c->change[j]) / c->weight[j];
}
/* couple.c: gaps, weights and compliances of the facets at hand at the nodes. Collective. */
PetscErrorCode ContactNodeSums_Private(Interface, Contact *);
/* offset.c: what counts as no gap, from the reference positions, at t = 0. Collective. */
PetscErrorCode ContactOffset_Private(Interface, Contact *);
/* warmstart.c: the states that were kept, of nodes that are covered. Collective. */
PetscErrorCode ContactWarmStart_Private(Interface, Contact *);
/* rows.c: states of this rank's nodes, to all that use them. Collective. */
PetscErrorCode ContactShareStates_Private(Interface, Contact *);
/* firsttouch.c: the overlap from which on nodes join the active set, of a pair that has borne nothing yet. Collective. */
PetscErrorCode ContactLeastOverlap_Private(Interface, const Contact *, PetscReal *least);
/* shared.c: nodes of the pair's nonmortar side at which facets of other pairs meet it that are not its own: of tied pairs those of both sides, or of contact
   pairs those of the nonmortar side; whose facets have a compliance. After all surfaces are created. */
PetscErrorCode ContactCrossings_Private(Interface, const Contact *, PetscBool ties, PetscBool crosses[]);
PetscErrorCode ContactShared_Private(Interface, Contact *);
/* stabilise.c: of pairs that have facets to be stabilised; after the softness of the nodes. Collective. */
PetscErrorCode ContactStabilise_Private(Interface, Contact *);
/* carrier.c: w0, extent and c of the nodes; which of them carry a multiplier. */
PetscErrorCode ContactNodeScales_Private(Interface, Contact *);
void           ContactCarriers_Private(Interface, Contact *);
/* Do supports leave a node of the nonmortar side any motion, and has it weight there? Until the rows of the matrix are known. */
PetscBool ContactIsFree_Private(const Interface, const Contact *, PetscInt node);
/* The number of directions along the surface in which supports hold the node; of one, axis. Until the rows of the matrix are known. */
PetscInt ContactHeldAxes_Private(const Surface *, PetscInt node, PetscReal axis[3]);
/* With friction: does a support hold the node in a direction oblique to the surface, so that what is left to it changes gap and slip alike? */
PetscBool ContactHeldObliquely_Private(const Surface *, PetscInt node);
PetscReal SurfaceFacetMeasure_Private(const Surface *, PetscInt facet, PetscBool axisymmetric);
/* slip.c: nothing where the law has no friction. Create: after the multipliers. Keep: before a search; points where slip counts from, if they are not kept yet.
   Freeze: small kinematics, after the search at the reference positions and before the facets are evaluated: points are kept there, once for all.
   Evaluate: after positions are gathered. Change: of every owned node's slip under the increment du of both sides, which is there. All but Destroy collective.
 */
PetscErrorCode SlipCreate_Private(Interface, Contact *);
PetscErrorCode SlipDestroy_Private(Contact *);
PetscErrorCode SlipKeep_Private(Interface, Contact *);
void           SlipCoupling_Private(const Contact *, const PetscReal q[], PetscReal coupled[]);
PetscErrorCode SlipFreeze_Private(Interface, Contact *, PetscBool *failed);
PetscErrorCode SlipEvaluate_Private(Interface, Contact *);
PetscErrorCode SlipChange_Private(Interface, Contact *, PetscReal change[]);
/* pattern.c: room in the matrix for what facets may meet until the next search. */
/* Rows of the matrix of everything in the pattern of one facet, dofs[ContactPatternSize_Private]; returns their number. */
PetscInt ContactPatternDofs_Private(const Contact *, PetscInt facet, PetscInt dofs[]);
PetscInt ContactPatternSize_Private(const Contact *, PetscInt facet);
/* Is the nonmortar node in the pattern of the facet? One that carries weight to a node need not have evaluated a row of it. */
PetscBool ContactPatternHas_Private(const Contact *, PetscInt facet, PetscInt node);
