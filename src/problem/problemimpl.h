/* Private to problem. */
#pragma once
#include "problem.h"

#include <petscsf.h>

#define COVERED_HIGHER 1e-9 /* the same for facets of higher order, whose forces have faded before: compliance.c in contact */
#define COVERED 1e-5        /* share of a node's tributary measure below which it counts as uncovered: its constraint would be all but free of its pressure */

#define SLACK 1e-10 /* pressure over Young's modulus that is none: what round-off leaves */

#define MOST_MASTERS 8          /* of a hanging vertex of a contact surface of order 1 */
#define MOST_LATTICE_MASTERS 64 /* of a hanging node of a lattice: two ends that hang on edges themselves, and so on */

/* Values of some nodes of a surface on their way between the ranks that own them and those that use them. */
typedef struct {
  PetscSF     sf;               /* roots and leaves have the nodes' numbers */
  PetscInt    num, *nodes;      /* that this rank uses and does not own, ascending */
  PetscMPIInt num_from, num_to; /* owners that this rank hears from, users that it tells */
  PetscInt    num_told;         /* entries told to all of them together */
} Link;

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
  int8_t    *order; /* facets of higher order as in contact.h; NULL: all are of order 1, their nodes the corners */
  PetscInt  *first, *lattice;
  PetscInt  *true_first, *true_node;  /* [num_facets+1] offsets, ascending: nodes of the facet, masters for those that hang, and of lattices that share a
 hanging corner with it: their multiplier functions are made together */
  PetscInt  *node_first, *node_facet; /* [num_nodes+1] offsets: facets that carry weight to the node, those with it as a true node */
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

typedef struct {
  const ContactSpec  *spec;
  ContactPair         pair;
  PetscInt           *part[2]; /* of the facets of both sides */
  Surface             side[2]; /* 0 nonmortar, 1 mortar */
  ContactView         view;
  PetscReal           freedom[2][9];                  /* of a translation of the bodies of either side, what supports leave free: slidelimit.c */
  PetscBool           drifts;                         /* they leave some */
  PetscInt           *zdof;                           /* [n] row of the matrix, -1: no multiplier */
  PetscInt           *zlocal;                         /* [n] position in this rank's part of the vector, -1: not here */
  PetscReal          *z, *gap, *weight, *spring;      /* [n] spring: K_j of contact.h */
  PetscReal          *softness;                       /* [n] extent / E */
  PetscReal          *w0, *extent, *c;                /* [n] reference measure, its extent along the surface, E / extent */
  PetscReal          *change;                         /* [n] work: change of gt_j at fixed measure under an increment */
  PetscReal          *lift;                           /* [n] the same for the prescribed motion still to come */
  PetscInt           *result;                         /* [num_facets] position of a facet in `facets`, -1: not evaluated here */
  PetscBool          *active, *has_multiplier, *near; /* [n] near: takes part in the next linear solve */
  PetscInt            num_listed, *listed;            /* nonmortar facets this rank evaluates */
  PetscBool          *mine;                           /* [num_facets] a side of this rank's leaves */
  PetscBool          *live;                           /* [num_facets] may meet the mortar side, as far as this rank is told (its own facets, those around) */
  PetscBool          *valued;                         /* [n] z, gap, weight, activity known here */
  PetscInt            num_valued, *valued_node;       /* their list */
  PetscReal          *pack;                           /* [n][3] work: gap, weight and spring in one message */
  PetscReal          *all_real[2];                    /* values gathered to all, see gather.c */
  PetscBool          *all_active;
  ContactView         all;
  PetscReal           distance;   /* search distance */
  PetscInt            num_facets; /* results of the last evaluation */
  const ContactFacet *facets;
  ContactFacet       *frozen; /* small kinematics: linearised once at the reference positions */
  PetscBool           is_frozen;
  PetscReal          *gap0;                     /* [n] reference gaps, small kinematics */
  PetscReal          *offset;                   /* [n] constant part of gt_j that does not count: initial gaps closed, interference */
  PetscReal          *misfit;                   /* [n] imbalance.c: what else does not count, times the share left */
  PetscInt           *pattern_offset, *pattern; /* [num_facets+1]: nodes each facet has room for in the matrix */
} Contact;

struct _p_Problem {
  const SceneData *scene;
  Forest           forest;
  MPI_Comm         comm;
  PetscMPIInt      rank, size;
  PetscInt         dim;
  HPSpace          space;
  Supports         supports;
  Mechanics        mechanics;
  PetscInt         num_contacts;
  Contact         *contacts;
  int8_t          *leaf_order;
  ContactHull      hull; /* hull.c; NULL without contact */
  PetscInt        *part; /* [num_cells of the coarse mesh] */

  /* layout */
  PetscInt   num_u, num_z, start; /* this rank's displacement dofs and multipliers, first index */
  PetscInt  *u_start, *p_start;   /* [size+1] ranges of the space's and the problem's numbering */
  PetscInt  *index;               /* [num_nodes*dim] local dof -> problem index or -1 */
  PetscBool  condensed;           /* the matrix knows no unknowns inside cells */
  PetscInt   num_inner;           /* those of this rank, the first of its vector; 0: not condensed */
  PetscInt   num_rows, first_row; /* of the matrix on this rank: num_u + num_z - num_inner */
  PetscInt  *row_start;           /* [size+1] ranges of the matrix's rows */
  PetscInt  *row;                 /* [num_nodes*dim] local dof -> row of the matrix or -1 */
  Vec        u_global, u_local, r_local, prototype;
  PetscReal *target, *applied; /* [num_nodes*dim] prescribed values */
  PetscReal *increment;        /* [num_nodes*dim] of the Newton step under discussion */
  PetscReal *start_applied;    /* [num_nodes*dim] applied where the Newton step starts */
  Vec        start_x;
  Vec        imbalance; /* imbalance.c: forces noted, NULL: none */
  PetscReal  share;     /* of it that counts as being in balance */
  PetscInt   num_dofs;

  /* pressure.c: unknown pressures, behind the multipliers; of local cells, as MechanicsSetPressure takes them */
  PetscInt     num_pi, pi_first;  /* this rank's, and where they begin in its part of the vector */
  PetscInt    *pi_index, *pi_row; /* [local unknowns] problem index, row of the matrix */
  PetscMPIInt *pi_rank;           /* [local unknowns] owner */
  PetscReal   *pi_scale;          /* [num_pi] factor of the residual's row against that of the symmetric form, at the last tangent */
  Vec          pi_local;          /* values of all local unknowns; NULL: no rank has any */
  VecScatter   pi_scatter;

  /* scalar.c, path.c: unknowns that belong to no node */
  PetscInt   num_scalars, num_controls;        /* the last of the vector and of the matrix: pressures found, then pseudo-time where a path is followed */
  PetscReal *scalar;                           /* [num_scalars] of the vector last seen */
  PetscReal *factor, *norm, *measure;          /* [num_controls] of the rows; of the target; what is followed, at the last residual */
  PetscReal  extent, path_start, path_advance; /* of all bodies; place of the last state along `path`, and how far from there */
  PetscBool  following;                        /* along the path; else time is as set */
  Vec        path;                             /* (u1 - u0) / (|u1 - u0| sqrt(N)), 0 but for displacements */

  Mat              matrix;
  ptrdiff_t       *scatter_first; /* [num_owned_cells] where a cell's places start in scatter, -1: it goes by MatSetValues */
  uint16_t        *scatter;       /* scatter.c */
  PetscObjectState scatter_state; /* pattern the places belong to */
  Form             form;
  PetscBool        symmetric; /* the last tangent is in the symmetric form */
  PetscBool        lifting;
  PetscBool        viscous; /* there are viscous forces (ProblemSetViscosity) */
  Vec              lift;
  PetscReal        t;
  MPI_Datatype     unit[4]; /* as many reals */
  ContactTraffic   traffic;
  PetscInt        *work_index;
  PetscReal       *work_value;
  PetscInt         work_size;
  PetscReal       *hessian; /* work: of a facet */
  PetscInt         hessian_size;
};

PetscErrorCode ProblemLayout_Private(Problem);
/* scalar.c. Create: before the layout. Read: from a vector to where they act. Measure: what controls follow at the local displacements u. Residual: their rows
   in the rank's part r of the residual, after Read and Measure. Pattern, Tangent: their rows and columns. Column: a local array as column of scalar k. All
   collective. */
PetscErrorCode ScalarsCreate_Private(Problem);
PetscErrorCode ScalarsDestroy_Private(Problem);
PetscErrorCode ScalarsRead_Private(Problem, Vec x);
PetscErrorCode ScalarsMeasure_Private(Problem, const PetscReal u[]);
PetscErrorCode ScalarsResidual_Private(Problem, Vec x, PetscReal r[]);
PetscErrorCode ScalarsPattern_Private(Problem, PetscInt diagonal[], PetscInt other[]);
PetscErrorCode ScalarsTangent_Private(Problem, const PetscReal u[]);
PetscErrorCode ScalarsColumn_Private(Problem, PetscInt k, const PetscReal local[]);
/* path.c: the equation of pseudo-time and its row and column. Collective. */
PetscErrorCode PathResidual_Private(Problem, Vec x, PetscReal *r);
PetscErrorCode PathTangent_Private(Problem, PetscInt row, const PetscReal u[]);
/* scatter.c: places of cells in the matrix as it stands, made when its pattern is new; add a cell's matrix there (*added false: it has no places). */
PetscErrorCode ProblemScatter_Private(Problem);
PetscErrorCode ProblemScatterAdd_Private(Problem, PetscInt cell, PetscInt num_dofs, const PetscInt dofs[], const PetscReal K[], PetscBool *added);
/* This rank's diagonal block of the matrix. */
PetscErrorCode ProblemDiagonal_Private(Problem, Mat *);
/* insert.c: as MatSetValues(problem's matrix, ..), of contact: values in the diagonal block. */
PetscErrorCode ProblemInsert_Private(Problem, PetscInt num_rows, const PetscInt rows[], PetscInt num_columns, const PetscInt columns[], const PetscReal K[],
                                     InsertMode);
/* pressure.c: counts[rank] grow by the pressure unknowns; their indices, once the ranges of the ranks are known; their rows likewise. Collective. */
PetscErrorCode PressureNumber_Private(Problem, PetscInt counts[]);
PetscErrorCode PressureIndices_Private(Problem);
PetscErrorCode PressureRowNumbers_Private(Problem, const PetscInt inner[]);
PetscErrorCode PressureDestroy_Private(Problem);
/* Pressures of local cells from x to the mechanics. Collective. */
PetscErrorCode PressureSpread_Private(Problem, Vec x);
/* Rows of the last residual into this rank's part of it. */
PetscErrorCode PressureRows_Private(Problem, PetscReal r[]);
/* Entries of this rank's cells in the matrix: counted, or without counters written as explicit zeros. Columns of a cell in the rows of its nodes, appended. */
PetscErrorCode PressurePattern_Private(Problem, PetscInt diagonal[], PetscInt other[]);
PetscErrorCode PressureColumns_Private(Problem, PetscInt cell, PetscInt columns[], PetscInt *num);
/* Blocks of the last tangent (added), effect of the motion to come on the rows to the lift; right-hand side in the form of the rows. */
PetscErrorCode PressureBlocks_Private(Problem);
PetscErrorCode PressureSides_Private(Problem, Vec rhs);
/* condense.c: rows of the matrix from the layout. Collective. */
PetscErrorCode ProblemRows_Private(Problem);
PetscErrorCode ProblemReduce_Private(Problem, Vec r, Vec rhs);
PetscErrorCode ProblemMatrix_Private(Problem);
PetscErrorCode ProblemWork_Private(Problem, PetscInt size);
/* increment (local array) = free dofs of dx + share of the prescribed motion still to come. */
PetscErrorCode ProblemIncrement_Private(Problem, Vec dx, PetscReal share);

PetscErrorCode SurfaceFields_Private(Problem, Surface *); /* after the topology */
/* lattice: nodes of facets of higher order, else their corners only, which must be of order 1. */
PetscErrorCode SurfaceCreate_Private(Problem, PetscInt group, PetscBool lattice, Surface *);
/* lattice.c: after the corners: nodes on the lattices of the facets, rows of those that hang. */
PetscErrorCode SurfaceLattice_Private(HPSpace, const ForestTables *, Surface *);
/* Nodes of a facet: its corners, or its lattice; returns their number. */
static inline PetscInt SurfaceNodes_Private(const Surface *s, PetscInt facet, const PetscInt **nodes)
{
  *nodes = s->order ? s->lattice + s->first[facet] : s->facets + s->corners * facet;
  return s->order ? s->first[facet + 1] - s->first[facet] : s->corners;
}
static inline PetscInt SurfaceOrder_Private(const Surface *s, PetscInt facet)
{
  return s->order ? s->order[facet] : 0;
}
PetscErrorCode SurfaceDestroy_Private(Surface *);
PetscErrorCode SurfaceIndices_Private(Problem, Surface *);
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
PetscErrorCode SurfaceGather_Private(Problem, const Surface *, const PetscReal local[], const PetscReal base[], PetscReal values[]);

/* exchange.c. Link: nodes (ascending, none owned) this rank uses from now on. Spread: owners' values[..][size] to the users; Collect: users' added to the
   owners'. All collective, messages only between ranks that share a node. */
PetscErrorCode LinkSet_Private(Problem, const Surface *, PetscInt num, const PetscInt nodes[], Link *);
PetscErrorCode LinkDestroy_Private(Link *);
PetscErrorCode LinkSpread_Private(Problem, const Link *, PetscInt size, PetscReal values[]);
PetscErrorCode LinkCollect_Private(Problem, const Link *, PetscInt size, PetscReal values[]);
PetscErrorCode TrafficReport_Private(Problem); /* with -info */
PetscErrorCode ExchangeBegin_Private(Problem);
PetscErrorCode ExchangeEnd_Private(Problem);
/* Positions known without exchange; `has` says so and everything else is forgotten. */
void SurfaceForget_Private(Surface *);
/* After a search: what this rank needs until the next one. */
PetscErrorCode ContactLink_Private(Problem, Contact *);
PetscBool      ContactSees_Private(const Contact *, PetscInt node);
/* nearby.c: search at the positions at hand, X when reference is set, where facets meet over the boundaries of ranks. Collective. */
PetscErrorCode ContactSearch_Private(Problem, Contact *, PetscBool reference, PetscReal margin);
/* gather.c */
PetscErrorCode ContactGatherDestroy_Private(Contact *);

/* Reference positions X[2 or 4][dim] of a facet's corners, in the order of Surface.facets. Not collective. */
PetscErrorCode SurfaceCorners_Private(Forest, PetscInt facet, PetscInt leaf, PetscReal X[]);
/* hull.c: p->hull and p->part; parts of a surface's facets, freed by the caller. Not collective. */
PetscErrorCode HullCreate_Private(Problem);
PetscErrorCode HullDestroy_Private(Problem);
PetscErrorCode HullParts_Private(Problem, const Surface *, PetscInt **part);
/* The deepest overlap of a pair that can be told from a far side: half of what both bodies measure; 0 where the scene limits the search. Not collective. */
PetscErrorCode HullDepth_Private(Problem, const Contact *, PetscReal *deepest);

PetscErrorCode ContactCreate_Private(Problem, const ContactSpec *, Contact *);
PetscErrorCode ContactDestroy_Private(Contact *);
PetscErrorCode ContactNumber_Private(Problem, PetscInt counts[]); /* multipliers of each rank, contacts' zdof as offsets in the rank's block */
PetscErrorCode ContactEvaluate_Private(Problem, Contact *, Vec x, const PetscReal local[], PetscBool derivatives, PetscBool hessian, PetscBool *failed);
PetscErrorCode ContactForces_Private(Problem, Contact *, PetscReal r[]);
/* force.c: nodal forces of both sides, 0; from this rank's facets to the owners of their nodes, and there off r, in the nodes' frames. Collective. */
void           ContactForcesZero_Private(Contact *);
PetscErrorCode ContactForcesSubtract_Private(Problem, Contact *, PetscReal r[]);
void           ContactRows_Private(const Contact *, PetscReal r[]);
/* Does the form take the pair out of the tangent? */
static inline PetscBool ContactIsReleased_Private(Problem p, const Contact *c)
{
  return FormHas(p->form.released, (PetscInt)(c - p->contacts));
}
/* Has the last evaluation active constraints whose forces hold the rim of the mortar side (ContactFacet.push)? Collective. */
PetscErrorCode ContactHoldsRims_Private(Problem, PetscBool *holds);
/* tangent.c: the matrix with room for all of contact, zero; a cell's matrix into it (MatrixSink); Hessians of contact, added; the gradient of node j's gap,
   normalised or not, times a factor, in work_index and work_value. */
PetscErrorCode ProblemReadyMatrix_Private(Problem);
PetscErrorCode ProblemCellSink_Private(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[]);
PetscErrorCode ContactHessians_Private(Problem, const Contact *);
PetscErrorCode ContactNodeGradient_Private(Problem, const Contact *, PetscInt j, PetscReal factor, PetscBool normalised, PetscInt *num);
/* tangent.c: multipliers from the unknowns of the symmetric form. dx: this rank's part of a vector. */
void ContactScaleIncrement_Private(Problem, PetscReal dx[]);
/* Change of every owned node's weighted gap, at fixed measure, under a local array of increments. Collective. */
PetscErrorCode          ContactChange_Private(Problem, Contact *, const PetscReal increment[], PetscReal change[]);
static inline PetscBool ContactCovered_Private(const Contact *c, PetscInt j)
{
  return (PetscBool)(c->weight[j] > (c->side[0].order ? COVERED_HIGHER : COVERED) * c->w0[j]);
}
/* Does node j bear? Less than SLACK is all there is where the whole pair is open. */
static inline PetscBool ContactPressed_Private(const Contact *c, PetscInt j)
{
  return (PetscBool)(c->has_multiplier[j] && c->z[j] > SLACK * c->c[j] * c->extent[j]);
}
/* How far node j and the other side are into each other, after the change as linearised. */
static inline PetscReal ContactOverlap_Private(const Contact *c, PetscInt j)
{
  return -(c->gap[j] + c->change[j]) / c->weight[j];
}
/* firsttouch.c: the overlap from which on nodes join the active set, of a pair that has borne nothing yet. Collective. */
PetscErrorCode ContactLeastOverlap_Private(Problem, const Contact *, PetscReal *least);
/* What the row of an active node is made of: (gt + K z) / Q, Q = w + c K, so that it stays of the size of a gap however small w is. */
static inline PetscReal ContactRowMeasure_Private(const Contact *c, PetscInt j)
{
  return c->weight[j] + c->c[j] * c->spring[j];
}
static inline PetscReal ContactRowGap_Private(const Contact *c, PetscInt j)
{
  return c->gap[j] + c->spring[j] * c->z[j];
}
/* slidelimit.c: which translations the supports of both sides' bodies leave free. */
PetscErrorCode ContactFreedom_Private(Problem, Contact *);
/* carrier.c: w0, extent and c of the nodes; which of them carry a multiplier. */
PetscErrorCode ContactNodeScales_Private(Problem, Contact *);
PetscErrorCode ContactCarriers_Private(Problem, Contact *);
PetscReal      SurfaceFacetMeasure_Private(const Surface *, PetscInt facet, PetscBool axisymmetric);
/* couple.c: factors of grad w and of grad area in a facet's part of a row's derivative, [grad gt - mean grad w + along grad area]; as a row of an active node,
   or (row false) of the forces by z_j. */
void ContactRowFactors_Private(const Contact *, const ContactFacet *, PetscInt k, PetscBool row, PetscReal *mean, PetscReal *along);
/* pattern.c: room in the matrix for what facets may meet until the next search. */
PetscErrorCode ContactGrowPattern_Private(Contact *);
PetscBool      ContactPatternHolds_Private(const Contact *);
/* Rows of the matrix of everything in the pattern of one facet, dofs[ContactPatternSize_Private]; returns their number. */
PetscInt ContactPatternDofs_Private(const Contact *, PetscInt facet, PetscInt dofs[]);
PetscInt ContactPatternSize_Private(const Contact *, PetscInt facet);

#define NODE_SIDE(id) ((id) < 0)
#define NODE_INDEX(id) ((id) < 0 ? ~(id) : (id))
