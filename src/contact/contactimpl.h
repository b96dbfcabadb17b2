/* Private to contact: what the parts of the pair share. The kernel's own: kernelimpl.h. */
#pragma once
#include "contact.h"

#define CONTACT_GRAZE 1e-3 /* angle, or distance over a facet's size, below which where lines cross, or where a ray meets a facet, tells nothing */

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

/* Of the last evaluation (result.c): positions and multipliers (loaded: they were given). */
typedef struct {
  PetscBool  stands, loaded;
  PetscReal *x[2], *z; /* owned */
  PetscInt   size_x[2], size_z;
} ContactState;

/* Mortar facets that a search found for each facet of its list, and (~facet) that it left out as only grazed: found[start[i] .. start[i+1]). */
typedef struct {
  PetscInt num, *start, *found, size_start, size_found; /* owned */
} Found;

typedef struct _p_RayWork *RayWork;

struct _p_ContactPair {
  PetscInt                  dim;
  PetscBool                 axisymmetric, node_to_segment, standard;
  PetscBool                 self;                /* both sides are one surface */
  const PetscInt           *precedence;          /* borrowed: of its facets; NULL: none */
  const PetscBool          *met;                 /* borrowed: mortar facets that cover others; NULL: all */
  PetscBool                 held;                /* directions do not vary */
  PetscBool                 frozen_segmentation; /* forces without the motion of lines of the mortar side */
  PetscInt                  num_degenerate;      /* overlaps of the last evaluation that could not be used */
  struct ContactMultiplier *multiplier;          /* functions of the facets */
  const PetscReal          *softness;            /* borrowed; NULL: no compliance */
  const PetscReal          *stabilisation;       /* borrowed; NULL: none */
  const PetscReal          *closed;              /* borrowed: of nonmortar corners; NULL: 0 */
  const PetscBool          *shared;              /* borrowed: of nodes; NULL: no node is */
  PetscBool                 parted;              /* one of several for the faces of the mortar side */
  PetscBool                 friction;            /* facets have no image in a plane of symmetry with which they make an edge */
  RayWork                   ray;                 /* work space; NULL before the first search */
  PetscInt                  num_nodes, num_facets, num_mortar_nodes, num_mortar_facets; /* of the last search */
  /* candidates: mortar facets of listed facet i are candidate[start[i] .. start[i+1]), ascending */
  PetscInt        num_listed, *listed, *start, *candidate, size_candidate; /* owned */
  Found           base, last;                                              /* of the search that others go on from, of the last one … */
  PetscBool       is_newer;                                                /* … which is not yet the former */
  PetscBool       goes_on;                                                 /* the next search, from there */
  PetscReal       distance, margin;
  PetscReal       depth;   /* of overlaps that are looked for */
  ContactHull     hull;    /* borrowed; NULL: thicknesses are not known */
  PetscReal       untold;  /* by the last search */
  PetscReal       deepest; /* overlap between its parts that can be told; 0: the search distance */
  const PetscInt *part[2]; /* borrowed: of the facets of both sides */
  /* results of the last evaluation, all owned; sizes only grow */
  PetscReal      *normal; /* [num_nodes][dim] */
  PetscInt        num_segments, size_segments;
  ContactSegment *output;
  PetscInt        num_results, num_ids, size_ids, *ids; /* ids: storage behind ContactFacet.nodes */
  ContactFacet   *result;                               /* [num_listed] */
  PetscInt       *slot, size_slot;                      /* [num_results] places of their facets in the list */
  ContactState    state;
  /* friction (kernel/slip.c) */
  const PetscReal    *traction; /* [dim - 1][num_nodes] borrowed: tangential; NULL: none */
  const PetscReal    *axis;     /* [num_nodes][3] borrowed, space: where the first axis is given, else 0; NULL: nowhere */
  struct ContactSlip *slip;     /* owned: points kept; NULL: none */
  PetscBool           keeps;    /* the evaluation at hand keeps its points */
  PetscBool           ties;     /* it wants what ties both sides (kernel/tie.c) */
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

/* search.c */
PetscErrorCode ContactTreeBuild(PetscInt num, PetscReal (*box)[6], Tree *);
PetscErrorCode ContactTreeDestroy(Tree *);

/* Nodes of a facet on its lattice, lexicographic; corner: room for those of a facet without one. */
typedef struct {
  PetscInt        order, num, corner[4];
  const PetscInt *node;
} FacetLattice;
void      ContactFacetLattice(const ContactSurface *, PetscInt facet, FacetLattice *);
PetscBool ContactNodeHangs(const ContactSurface *, PetscInt n);
/* Row of node n: the nodes it follows with their weights, itself when it does not hang; returns their number. */
PetscInt ContactNodeRow(const ContactSurface *, const PetscInt *n, const PetscInt **master, const PetscReal **weight);

/* hull.c: from x, inside or on a facet of this part of the bodies, along the unit vector d to where the ray leaves the part; most: not before. x, d: [dim],
   reference positions. */
PetscReal ContactHullAcross(ContactHull, PetscInt part, const PetscReal x[], const PetscReal d[], PetscReal most);
/* A side of a part near a place: its distance, its unit normal; reference positions. */
typedef struct {
  PetscReal distance, N[3];
} HullSide;
/* Facets of the part closer to x than the radius that run along the direction d rather than across it, at most `most`. Returns their number. */
PetscInt ContactHullBeside(ContactHull, PetscInt part, const PetscReal x[], const PetscReal d[], PetscReal radius, PetscInt most, HullSide side[]);
/* culling.c. A facet by its corners: now and at the reference positions, axes (the last one the outward normal); of a nonmortar facet, the unit directions of
   its rays. */
typedef struct {
  PetscInt  dim, nv;
  PetscReal x[4][3], X[4][3], axis[3][3], axis0[3][3], d[4][3];
} FacetCorners;

/* Once for a nonmortar facet, nothing where the pair knows no hull. */
void ContactCorners(ContactPair, const ContactSurface *nonmortar, PetscInt facet, FacetCorners *);
/* Does the mortar facet lie behind the nonmortar one and both bodies, or did the bodies come to overlap another way? Asked beyond this depth. */
PetscBool ContactBehind(ContactPair, PetscInt facet, const FacetCorners *nonmortar, const ContactSurface *mortar, PetscInt other, PetscReal shallow);

/* What an evaluation is asked for. */
typedef struct {
  ContactPair           pair;
  const ContactSurface *nonmortar, *mortar;
  const PetscReal      *z;
  const PetscBool      *wanted;
  PetscBool             derivatives, hessian;
  PetscBool             again; /* the positions of the last evaluation, whose results are completed */
} EvaluateContext;

/* reuse.c. Are these the positions of the last evaluation, and its multipliers? */
PetscBool      ContactStateStands(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar);
PetscBool      ContactStateLoads(ContactPair, const PetscReal z[]);
PetscErrorCode ContactStateKeep(ContactPair, const ContactSurface *nonmortar, const ContactSurface *mortar, const PetscReal z[]);

/* kernel/slip.c */
PetscErrorCode ContactSlipDestroy(struct ContactSlip **);
/* Before an evaluation: of the points kept those of the last one. */
void ContactSlipForget(ContactPair);

/* result.c. Storage of results: blocks that are kept and filled anew at each evaluation; pointers into them stay valid until then. */
typedef struct {
  PetscInt    num, size, at, *room, used;
  PetscReal **block;
} Store;
/* Room for num zeros. */
PetscErrorCode ContactStoreReserve(Store *, PetscInt num, PetscReal **array);

/* One facet's result in the making. Rows of the result belong to the first num_rows nodes. */
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
/* Those that a nonmortar node follows, itself where it does not hang. */
PetscErrorCode ContactResultMasters(Result *, const ContactSurface *, PetscInt node);
/* Row of vertex v by places among the nodes; row_first has room for v + 1, *num entries are there. */
PetscErrorCode ContactResultRow(Result *, const ContactSurface *, PetscInt node, PetscBool mortar, PetscInt v, PetscInt *num);
/* Do derivatives have a use? node[num_rows]: the facet's multipliers; loaded: one of them is not zero. */
PetscBool      ContactResultDerivatives(const EvaluateContext *, PetscInt num_rows, const PetscInt node[], PetscBool loaded);
PetscErrorCode ContactResultSegment(ContactPair, PetscInt facet, PetscInt mortar_facet, PetscInt num, ContactSegment **);
/* Calls the function for every listed facet and hands out those results it sets *use for. At the positions of the last evaluation (again) for those only
   whose results lack what is asked for; they stand in the function's ContactFacet when it is called. */
typedef PetscErrorCode (*ResultFunction)(const EvaluateContext *, PetscInt slot, ContactFacet *, PetscBool *use, PetscBool *failed);
PetscErrorCode ContactResultsEvaluate(const EvaluateContext *, Result *, ResultFunction, PetscBool *failed);
