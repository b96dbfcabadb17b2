/* Floor 1. The refinement forest: replicated compact trees over a coarse mesh of quads or hexes, and the leaf DMPlex of each rank.
   A Forest is immutable: ForestAdapt returns a new one. All global tables below are identical on every rank, whatever their number.

   Leaves are numbered in depth-first order, coarse cell by coarse cell. An *entity* is a vertex, edge, face (3-D) or cell of some leaf.
   Every entity of dimension d has a *frame* (its own reference coordinates in [0,1]^d), the same for all leaves that share it, and a
   closure table of 3^d entries in tensor order: index sum_i t_i 3^i, t_i = 0 low side, 1 inside, 2 high side; the middle one is the
   entity itself. Each entry has an orientation code that maps the owner's tangential axes to the frame of the sub-entity:
     edges:  bit 0: reversed;
     faces:  bit 2: the two axes are swapped, then bit 0 / bit 1: first / second *frame* axis reversed.
   ForestOrient() applies it. Cell entities: frame = axes of the coarse cell. */
#pragma once
#include "base.h"

typedef struct _p_Forest *Forest;

#define FOREST_MAX_LEVEL 30                            /* splits per direction: 2^30 is the largest power of 2 a PetscInt of 32 bits holds */
#define FOREST_PARTS 64                                /* of an entity, nodes or entries of its closure: entity * FOREST_PARTS + part is a PetscInt */
#define FOREST_ENTITIES (PETSC_MAX_INT / FOREST_PARTS) /* most of a forest, which ForestCreate and ForestAdapt see to */

typedef struct {
  char      file[PETSC_MAX_PATH_LEN]; /* .msh 2.2 or 4.1 */
  char      told[PETSC_MAX_PATH_LEN]; /* its name in messages, as of the .geo that it was made of; "": file */
  PetscInt  dim;                      /* 2 or 3 */
  PetscInt  refine;                   /* uniform refinements at once */
  PetscBool keep_flat;                /* cells of the plane with a flat corner stay as they are */
} ForestSpec;

/* Refinement before the first solve: the cells with a facet in a boundary group and within a distance of a place, either may be missing. */
typedef struct {
  char      name[MORTISE_NAME];
  PetscInt  group;  /* boundary group, -1: cells anywhere */
  PetscReal X[3];   /* reference position */
  PetscReal radius; /* cells no further from X; negative: all */
  PetscInt  levels; /* how often */
} RefineSpec;

/* Replicated description of the coarse mesh as read. */
typedef struct {
  PetscInt dim, num_cells, num_vertices, geometry_order;
  PetscInt num_bodies;                 /* physical groups of dimension dim */
  PetscInt num_boundaries;             /* physical groups of dimension dim-1 */
  char (*body_name)[MORTISE_NAME];     /* [num_bodies] */
  char (*boundary_name)[MORTISE_NAME]; /* [num_boundaries], at most 64 */
  PetscInt   num_unions;               /* the last of the boundaries, which are no group of the file (ForestUnite) … */
  uint64_t   united[64];               /* [num_unions] … but made of these */
  PetscInt  *cell_vertices;            /* [num_cells][2^dim] lexicographic */
  PetscReal *cell_geometry;            /* [num_cells][(q+1)^dim][3] positions at equispaced nodes, lexicographic, q = geometry_order */
  PetscInt  *cell_body;                /* [num_cells] index of the body, -1: in none (input error reported by the scene with the cell's place) */
  PetscInt   num_opened;               /* on rank 0, in the plane: cells that had a flat corner and share it with a neighbour now … */
  PetscReal  first_opened[3];          /* … where the first of them was */
  PetscBool  from_simplices;           /* in space: its cells were made out of tetrahedra */
  PetscInt   num_fields;               /* views $ElementData of three components in the file */
  char (*field_name)[MORTISE_NAME];    /* [num_fields] */
  PetscReal *field;                    /* [num_fields][num_cells][3] the vector of each cell as the file has it, NaN: none */
} CoarseMesh;

/* Read-only views of a forest's tables, borrowed, valid while the forest lives. */
typedef struct {
  PetscInt           dim;
  PetscInt           revision;   /* grows by one at each adaptation */
  PetscInt           num_leaves; /* on all ranks */
  const PetscInt    *leaf_root;  /* [num_leaves] coarse cell */
  const PetscInt    *leaf_lo;    /* [num_leaves][3] low corner in units of 2^-FOREST_MAX_LEVEL of the coarse cell */
  const int8_t      *leaf_level; /* [num_leaves][3] splits so far in each direction; extent = 2^(FOREST_MAX_LEVEL-level) */
  const PetscInt    *leaf_body;  /* [num_leaves] */
  const PetscMPIInt *leaf_rank;  /* [num_leaves] owner, from the METIS partition */

  PetscInt        num_entities;   /* ids: vertices, then edges, then faces (3-D), then cells; cell of leaf l is first[dim] + l */
  PetscInt        first[5];       /* [dim+2] first id of each dimension; first[dim+1] = num_entities */
  const PetscInt *closure_offset; /* [num_entities] start in the two arrays below; 3^d entries */
  const PetscInt *closure;        /* entity ids in tensor order */
  const int8_t   *orientation;    /* orientation codes, one for each closure entry */
  const PetscInt *parent;         /* [num_entities] entity in whose interior this one hangs, or -1. Its own parent may hang too. */
  const int8_t   *parent_place;   /* [num_entities][3] place in the parent's frame, per parent axis: 0 lower half, 1 upper half, 2 whole, 3 at the middle */
  const PetscInt *facet_leaf;     /* [num_facets][2] leaves that have this facet (entity of dimension dim-1, from first[dim-1]) as a whole one, -1: none */
  const uint64_t *boundary;       /* [num_entities] bit b: the entity lies in the closure of a leaf facet of boundary group b */
  const PetscInt *entity_leaf;    /* [num_entities] lowest leaf with this entity in its closure: its rank owns the entity */
} ForestTables;

/* What to do with each leaf, declared here because the forest consumes it. */
typedef struct {
  int8_t *split;   /* [num_leaves] bit d: split in direction d; 0: keep */
  int8_t *coarsen; /* [num_leaves] nonzero: may merge with its siblings if all of them agree and closure permits */
} MarkList;

/* Relation of the leaves of a new forest to those of the one it came from. */
typedef struct {
  PetscInt  num;       /* leaves of the new forest */
  PetscInt *old_first; /* [num] first old leaf that overlaps */
  PetscInt *old_count; /* [num] how many: 1 same or refined, >1 merged */
} ForestMap;

/* Boundary groups that a group stands for: itself, or those it is made of. */
static inline uint64_t CoarseMembers(const CoarseMesh *m, PetscInt group)
{
  const PetscInt num = m->num_boundaries - m->num_unions;
  return group < num ? UINT64_C(1) << group : m->united[group - num];
}

/* Read the mesh of spec on rank 0, replicate it, refine uniformly, partition. Input errors: file missing or not gmsh 2.2/4.1, mixed dimensions,
   no cells of dimension dim, inverted cell (number and centre), cell shapes other than quad/hex after conversion (triangles/tetrahedra are converted).
   Collective. */
PetscErrorCode ForestCreate(MPI_Comm, const ForestSpec *, Forest *);
/* The group that is made of these, bit by bit: one of the file, one there is, or a new one, here and on all forests that will come of this one. Input error:
   there are 64 already. The same on all ranks; not collective. */
PetscErrorCode ForestUnite(Forest, uint64_t groups, PetscInt *group);
/* Same from a coarse mesh in memory (tests, boxes); takes ownership of the arrays of mesh; facets: num_facets boundary facets by their
   2^(dim-1) vertices and bit mask of boundary groups. Collective. */
PetscErrorCode ForestCreateFromCoarse(MPI_Comm, CoarseMesh *mesh, PetscInt num_facets, const PetscInt facet_vertices[], const uint64_t facet_groups[],
                                      PetscInt refine, Forest *);
PetscErrorCode ForestDestroy(Forest *);

const CoarseMesh *ForestGetCoarse(Forest);
/* part[num_cells]: cells that share a vertex, and those that hang together by others, have the same number below *num. Not collective. */
PetscErrorCode ForestCoarseParts(const CoarseMesh *, PetscInt *num, PetscInt part[]);
/* The box of all geometry nodes. Not collective. */
void                ForestCoarseBox(const CoarseMesh *, PetscReal lo[3], PetscReal hi[3]);
const ForestTables *ForestGetTables(Forest);
MPI_Comm            ForestComm(Forest);

/* New forest: splits, merges where permitted, 1-irregular closure (also across edges; conflicting anisotropic splits forced), repartition.
   leaf_weight[num_leaves] of the *old* leaves (NULL: 1) is inherited for METIS; contact couplings: num_pairs pairs of old leaves that face each
   other, added to the graph (may be 0/NULL). Collective. */
PetscErrorCode ForestAdapt(Forest, const MarkList *, const PetscReal leaf_weight[], PetscInt num_pairs, const PetscInt pairs[][2], Forest *adapted,
                           ForestMap *map);
PetscErrorCode ForestMapDestroy(ForestMap *);
/* Replace *forest by one refined isotropically as spec says, closed again after each level. Collective. */
PetscErrorCode ForestRefine(Forest *forest, const RefineSpec *spec);
/* Does a facet of the leaf belong to one of these boundary groups (bits)? Not collective. */
PetscBool ForestLeafTouches(const ForestTables *, PetscInt leaf, uint64_t groups);

/* Side of the coarse mesh in which an outer facet of a leaf lies: 2 dim cell + 2 direction, + 1 the upper one. Not collective. */
PetscInt ForestCoarseSide(const ForestTables *, PetscInt leaf, PetscInt facet);

/* The tree as a list, for ForestRestore: of every node, depth-first, coarse cell by coarse cell, the directions in which it is split (bits; 0: a leaf).
   split[*num] is freed by the caller. Not collective. */
PetscErrorCode ForestGetSplits(Forest, PetscInt *num, int8_t **split);
/* The forest with this list over the coarse mesh of source, its leaves numbered as they were. leaf_rank[num_leaves]: who owns which leaf; NULL: a new
   partition, leaves weighted by leaf_weight[num_leaves] (NULL: 1). A list of which no forest of so many leaves can be made is an input error. Collective. */
PetscErrorCode ForestRestore(Forest source, PetscInt num, const int8_t split[], PetscInt revision, PetscInt num_leaves, const PetscMPIInt leaf_rank[],
                             const PetscReal leaf_weight[], Forest *forest);
/* Hash of the coarse mesh: cells, positions, bodies and boundaries with their names; the same on every rank. Not collective. */
PetscErrorCode ForestCoarseHash(Forest, uint64_t *hash);

/* Leaf DMPlex of this rank: owned leaves, one ghost layer (leaves that share an entity with an owned one or with its parents), and recursively
   parent entities and their closures. Point SF set (owner: rank of entity_leaf), labels: one DMLabel per boundary group name on facets, "body" on
   cells. Cones oriented validly. point_entity[num_points]: entity id of each DMPlex point; points are numbered cells (owned first, then ghosts),
   vertices, then other dimensions. The DM and point_entity belong to the forest (built at first call). Collective. */
PetscErrorCode ForestGetLeafDM(Forest, DM *, PetscInt *num_owned_cells, PetscInt *num_points, const PetscInt **point_entity);

/* Exact position (polynomial geometry of the coarse cell) of the point xi in [0,1]^dim of a leaf. Not collective. */
PetscErrorCode ForestMapPoint(Forest, PetscInt leaf, const PetscReal xi[], PetscReal X[3]);
/* Position (and Jacobian [3][dim] unless NULL) at xi in [0,1]^dim of a coarse cell. Not collective. */
void ForestCoarseMapPoint(const CoarseMesh *, PetscInt cell, const PetscReal xi[], PetscReal X[3], PetscReal jacobian[]);

/* Map coordinates xi (owner's tangential axes, d of them) to the sub-entity's frame by its orientation code, in place order as documented above. */
static inline void ForestOrient(PetscInt d, int8_t code, const PetscReal xi[], PetscReal eta[])
{
  if (d == 0) return;
  if (d == 1) {
    eta[0] = (code & 1) ? 1 - xi[0] : xi[0];
    return;
  }
  if (d == 3) {
    for (PetscInt i = 0; i < 3; ++i) eta[i] = xi[i];
    return;
  }
  const PetscReal a = (code & 4) ? xi[1] : xi[0], b = (code & 4) ? xi[0] : xi[1];
  eta[0] = (code & 1) ? 1 - a : a;
  eta[1] = (code & 2) ? 1 - b : b;
}
