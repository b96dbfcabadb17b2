/* Private parts of the forest module.

   Integer coordinates of a coarse entity run from 0 to FOREST_ONE in each axis of its frame. A *box* is given per axis by its low end and its
   level: extent FOREST_ONE >> level; level FOREST_POINT means no extent. Frames of coarse entities: edge: from the lower to the higher vertex id;
   face: origin in its lowest vertex id, first axis towards the lower of that vertex's two neighbours; cell: its own axes.
   The identity of a leaf's sub-entity is the coarse entity in whose interior it lies and its box in that frame (EntityKey): neighbours of
   different coarse cells find the same key without any search. */
#pragma once
#include "forest.h"

#define FOREST_ONE ((PetscInt)1 << FOREST_MAX_LEVEL)
#define FOREST_POINT 31     /* level of an axis without extent; FOREST_ONE >> 31 is 0 */
#define FOREST_MAX_ORDER 10 /* of the coarse geometry */

/* 3^d, and for an index in tensor order (digits t_i) the number of axes inside (t_i = 1), i.e. the dimension of that sub-entity. */
extern const PetscInt ForestPow3[4];
extern const int8_t   ForestTensorDim[27];

/* Under an orientation code of an n-dimensional entity the owner's tangential axis j is frame axis ForestFrameAxis, reversed or not. */
static inline PetscInt ForestFrameAxis(PetscInt n, int8_t code, PetscInt j)
{
  return (n == 2 && (code & 4)) ? 1 - j : j;
}
static inline PetscInt ForestFrameReversed(int8_t code, PetscInt frame_axis)
{
  return (code >> frame_axis) & 1;
}

/* ---- entity.c: keys and their hash ---------------------------------------------------------------------------- */

/* Three low ends of 31 bits, from 0 to FOREST_ONE: two in `lo`, one in `hi`; `what`: three levels of 5 bits and the coarse entity. Axes beyond the frame: 0,
   FOREST_POINT. */
typedef struct {
  uint64_t lo, hi, what;
} EntityKey;
_Static_assert(FOREST_MAX_LEVEL < 31, "low ends and levels of an EntityKey have no room for so many splits");

typedef struct {
  EntityKey *key;   /* owned [mask + 1] */
  PetscInt  *value; /* owned [mask + 1] -1: empty */
  size_t     mask;
  PetscInt   count;
} EntityHash;

PetscErrorCode ForestHashCreate(PetscInt expected, EntityHash *);
PetscErrorCode ForestHashDestroy(EntityHash *);
/* Value of the key; if absent it is entered with the value `count` of before and *added is true. */
PetscErrorCode ForestHashInsert(EntityHash *, EntityKey, PetscInt *value, PetscBool *added);
PetscInt       ForestHashFind(const EntityHash *, EntityKey); /* -1: absent */

static inline EntityKey ForestKeyPack(PetscInt coarse, const PetscInt lo[3], const int8_t level[3])
{
  return (EntityKey){(uint64_t)lo[0] | (uint64_t)lo[1] << 32, (uint64_t)lo[2],
                     (uint64_t)level[0] | (uint64_t)level[1] << 5 | (uint64_t)level[2] << 10 | (uint64_t)coarse << 15};
}
static inline PetscInt ForestKeyUnpack(EntityKey key, PetscInt lo[3], int8_t level[3])
{
  lo[0] = (PetscInt)(key.lo & 0xffffffff);
  lo[1] = (PetscInt)(key.lo >> 32);
  lo[2] = (PetscInt)key.hi;
  for (PetscInt i = 0; i < 3; ++i) level[i] = (int8_t)((key.what >> (5 * i)) & 31);
  return (PetscInt)(key.what >> 15);
}

/* Closure of the entity at place `index` (dimension 1 or 2, orientation code `code`) of an owner, in the entity's own frame, from the owner's closure. */
void ForestSubClosure(PetscInt index, int8_t code, const PetscInt closure[], const int8_t orientation[], PetscInt sub_closure[], int8_t sub_orientation[]);

/* ---- coarse.c: topology of the coarse mesh --------------------------------------------------------------------- */

/* Shared by all forests adapted from one another. Ids: vertices, edges, faces (3-D), cells. */
typedef struct {
  PetscInt   references;
  CoarseMesh mesh;           /* owned */
  PetscInt   first[5];       /* [dim+2] first id of each dimension */
  PetscInt  *closure_offset; /* owned [first[dim+1]] */
  PetscInt  *closure;        /* owned, 3^d ids each, as in ForestTables */
  int8_t    *orientation;    /* owned, a code for each */
  PetscInt (*facet_cell)[2]; /* owned [num_facets] coarse cells (index, not id), -1: none */
  int8_t (*facet_place)[2];  /* owned [num_facets] tensor index of the facet in those cells */
  uint64_t *facet_groups;    /* owned [num_facets] bit mask of boundary groups */
} Coarse;

/* Takes ownership of the arrays of mesh (also on error). Input errors: facet of three cells, inverted cell, cells that disagree on a shared curve. */
PetscErrorCode ForestCoarseCreate(CoarseMesh *mesh, PetscInt num_facets, const PetscInt facet_vertices[], const uint64_t facet_groups[], Coarse **);
PetscErrorCode ForestCoarseDestroy(Coarse **);
PetscErrorCode ForestCoarseMeshDestroy(CoarseMesh *);

/* Key of a box (lo, level: axes of the coarse cell) of a coarse cell; returns the orientation code from the tangential axes of the box to its
   frame: that of the key's coarse entity without the axes that have no extent. */
static inline int8_t ForestCoarseKey(const Coarse *coarse, PetscInt cell, const PetscInt lo[3], const int8_t level[3], EntityKey *key)
{
  const PetscInt dim   = coarse->mesh.dim;
  PetscInt       index = 0, axis[3], n = 0, d = 0, frame_lo[3] = {0, 0, 0};
  int8_t         frame_level[3] = {FOREST_POINT, FOREST_POINT, FOREST_POINT}, code, result;

  for (PetscInt i = 0, stride = 1; i < dim; ++i, stride *= 3) {
    const PetscInt t = level[i] != FOREST_POINT ? 1 : lo[i] == 0 ? 0 : lo[i] == FOREST_ONE ? 2 : 1;
    if (t == 1) axis[n++] = i;
    index += t * stride;
  }
  const PetscInt entry = coarse->closure_offset[coarse->first[dim] + cell] + index;
  code                 = coarse->orientation[entry];
  result               = 0;
  for (PetscInt j = 0; j < n; ++j) {
    const PetscInt a = axis[j], f = ForestFrameAxis(n, code, j), reversed = ForestFrameReversed(code, f);
    frame_level[f] = level[a];
    frame_lo[f]    = reversed ? FOREST_ONE - lo[a] - (FOREST_ONE >> level[a]) : lo[a];
    if (level[a] != FOREST_POINT) {
      result = (int8_t)reversed;
      ++d;
    }
  }
  *key = ForestKeyPack(coarse->closure[entry], frame_lo, frame_level);
  return d == 0 ? 0 : d == n ? code : d == 1 ? result : 0;
}

/* ---- jacobian.c --------------------------------------------------------------------------------------------------- */

/* Sign of the Jacobian determinant all over the cell: 1, -1, or 0 when it changes sign or vanishes. (Determinants of a degree above 11: at sample points.) */
PetscInt ForestCoarseJacobianSign(const CoarseMesh *, PetscInt cell);

/* ---- flat.c ------------------------------------------------------------------------------------------------------- */

/* Cells of the plane with a flat corner share it with a neighbour by two cells more, where that makes them sound. facet_vertices[num_facets][2]: sides that
   boundary groups name, which stay. Not collective. */
PetscErrorCode ForestOpenFlatCorners(CoarseMesh *, PetscInt num_facets, const PetscInt facet_vertices[]);

/* ---- tree.c -------------------------------------------------------------------------------------------------------- */

typedef struct {
  PetscInt root, child;          /* coarse cell; first child, -1: leaf. Children are contiguous, x-fastest in the split directions. */
  PetscInt hidden;               /* first child hidden by a tentative merge, -1: none (only while adapting) */
  PetscInt old_first, old_count; /* leaves of the previous forest that overlap */
  PetscInt lo[3];
  int8_t   level[3], split; /* split: directions of the children (also of hidden ones) */
} TreeNode;

typedef struct {
  PetscInt  num, capacity; /* the first nodes are the roots, one for each coarse cell */
  TreeNode *node;          /* owned */
} Tree;

PetscErrorCode ForestTreeCreate(PetscInt num_roots, Tree *);
PetscErrorCode ForestTreeCopy(const Tree *, Tree *);
PetscErrorCode ForestTreeDestroy(Tree *);
/* Children of a leaf node in the directions of the bits of `directions`. May move tree->node. Error when deeper than FOREST_MAX_LEVEL. */
PetscErrorCode ForestTreeSplit(Tree *, PetscInt node, int8_t directions);
/* Nodes that are leaves, depth-first, root by root; leaves is allocated here. */
PetscErrorCode ForestTreeLeaves(const Tree *, PetscInt num_roots, PetscInt *num_leaves, PetscInt **leaves);
/* Gather nested splits into one where all children agree: the tree then depends on the leaves only, not on the order of the splits. */
PetscErrorCode ForestTreeNormalize(Tree *, PetscInt num_roots);
/* The same tree with nodes in depth-first order and without nodes that are no longer reached. */
PetscErrorCode ForestTreeCompact(const Tree *, PetscInt num_roots, Tree *);

static inline PetscInt ForestNumChildren(int8_t directions)
{
  return 1 << ((directions & 1) + ((directions >> 1) & 1) + ((directions >> 2) & 1));
}

/* ---- closure.c ------------------------------------------------------------------------------------------------------ */

/* Split tree until it is 1-irregular; merged nodes get their hidden children back instead. Deterministic. Terminates because
   no direction is ever split deeper than the deepest leaf. fresh[num_fresh]: nodes that are new since the tree was 1-irregular. */
PetscErrorCode ForestTreeClose(const Coarse *, Tree *, PetscInt num_fresh, const PetscInt fresh[]);

/* ---- forest.c, entity tables, partition, leaf mesh ------------------------------------------------------------------------- */

struct _p_Forest {
  MPI_Comm     comm;    /* duplicated */
  Coarse      *coarse;  /* shared */
  Tree         tree;    /* owned, compact */
  ForestTables tables;  /* owned arrays */
  DM           leaf_dm; /* owned, NULL until asked for */
  PetscInt     num_owned_cells, num_points;
  PetscInt    *point_entity; /* owned [num_points] */
};

/* Forest of a compact tree (taken over); weights and pairs of the new leaves for the partition (may be NULL, 0). Collective. */
PetscErrorCode ForestCreateFromTree(MPI_Comm, Coarse *, Tree *, PetscInt revision, const PetscReal weight[], PetscInt num_pairs, const PetscInt pairs[][2],
                                    Forest *);
/* Fill leaf and entity tables (all but leaf_rank). Not collective. */
/* An input error beyond FOREST_ENTITIES. */
PetscErrorCode ForestCheckSize(PetscInt64 num_entities);
PetscErrorCode ForestBuildTables(const Coarse *, const Tree *, ForestTables *);
PetscErrorCode ForestTablesDestroy(ForestTables *);
/* Owner of each leaf, [num_leaves]. Collective. */
PetscErrorCode ForestPartition(MPI_Comm, const ForestTables *, const PetscReal weight[], PetscInt num_pairs, const PetscInt pairs[][2],
                               PetscMPIInt leaf_rank[]);
/* Read a gmsh file on this rank. Returns the sentence of an input error in message (empty: none). Not collective. */
PetscErrorCode ForestReadGmsh(const ForestSpec *, CoarseMesh *, PetscInt *num_facets, PetscInt **facet_vertices, uint64_t **facet_groups, size_t length,
                              char message[]);

/* gmshcheck.c: are the sections of a gmsh file whole, and all nodes that its elements name there? Not collective. */
PetscErrorCode ForestCheckGmsh(const char *file, int major, PetscBool binary, PetscBool *fine, int64_t *range);

/* gmshfield.c: the fields of mesh from an ASCII file that has num_elements of the mesh's dimension; source[num_cells]: the element, in the order of DMPlex, in
   which each cell lies (NULL: its own). *damage: what is wrong with the file, NULL: nothing. Not collective. */
PetscErrorCode ForestReadFields(const char *file, int major, PetscInt num_elements, const PetscInt source[], CoarseMesh *mesh, const char **damage);
