/* Leaf and entity tables. Built on every rank alike: ids depend only on the tree. */
#include "forestimpl.h"

typedef struct {
  const Coarse *coarse;
  PetscInt      dim, num_leaves, num[4];
  EntityHash    hash[3];        /* by dimension, below dim */
  EntityKey    *key[3];         /* [num] */
  PetscInt     *leaf[3];        /* [num] lowest leaf */
  PetscInt     *closure[4];     /* [num][3^d] ids counted within each dimension */
  int8_t       *orientation[4]; /* [num][3^d] */
  PetscInt     *facet_leaf;     /* [num][2] */
  PetscInt      place[27];      /* tensor places of a leaf by dimension: first vertices, then edges, … */
} Builder;

/* Arrays are sized for leaves that share nothing: untouched pages cost nothing. */
static PetscErrorCode BuilderCreate_Private(const Coarse *coarse, PetscInt num_leaves, Builder *b)
{
  const PetscInt dim = coarse->mesh.dim, most[2][3] = {{4, 4, 0}, {8, 12, 6}};

  PetscFunctionBegin;
  *b = (Builder){.coarse = coarse, .dim = dim, .num_leaves = num_leaves};
  for (PetscInt d = 0, n = 0; d <= dim; ++d) {
    const PetscInt num = d < dim ? num_leaves * most[dim - 2][d] : num_leaves;
    PetscCall(PetscMalloc2(num * ForestPow3[d], &b->closure[d], num * ForestPow3[d], &b->orientation[d]));
    if (d < dim) PetscCall(PetscMalloc2(num, &b->key[d], num, &b->leaf[d]));
    if (d < dim) PetscCall(ForestHashCreate(d == 0 ? 2 * num_leaves : 3 * num_leaves, &b->hash[d]));
    for (PetscInt i = 0; i < ForestPow3[dim]; ++i)
      if (ForestTensorDim[i] == d) b->place[n++] = i;
  }
  PetscCall(PetscMalloc1(2 * num_leaves * most[dim - 2][dim - 1], &b->facet_leaf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuilderDestroy_Private(Builder *b)
{
  PetscFunctionBegin;
  for (PetscInt d = 0; d <= b->dim; ++d) {
    PetscCall(PetscFree2(b->closure[d], b->orientation[d]));
    if (d < b->dim) PetscCall(PetscFree2(b->key[d], b->leaf[d]));
    if (d < b->dim) PetscCall(ForestHashDestroy(&b->hash[d]));
  }
  PetscCall(PetscFree(b->facet_leaf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline void FacetLeaf_Private(Builder *b, PetscInt facet, PetscInt leaf, PetscBool added)
{
  if (added)
    b->facet_leaf[2 * facet] = leaf, b->facet_leaf[2 * facet + 1] = -1;
  else
    b->facet_leaf[2 * facet + 1] = leaf;
}

/* Enter the sub-entities of a leaf: each is identified by its key; the closure of a new one is read off the leaf's. */
static PetscErrorCode BuilderAddLeaf_Private(Builder *b, const TreeNode *node, PetscInt leaf)
{
  const PetscInt dim = b->dim, n = ForestPow3[dim];
  PetscInt      *closure = &b->closure[dim][n * leaf];
  int8_t        *code    = &b->orientation[dim][n * leaf];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < n - 1; ++k) {
    const PetscInt i = b->place[k], d = ForestTensorDim[i];
    PetscInt       lo[3] = {0, 0, 0};
    int8_t         level[3];
    EntityKey      key;
    PetscBool      added;
    for (PetscInt a = 0; a < dim; ++a) {
      const PetscInt t = (i / ForestPow3[a]) % 3;
      lo[a]            = node->lo[a] + (t == 2 ? FOREST_ONE >> node->level[a] : 0);
      level[a]         = t == 1 ? node->level[a] : FOREST_POINT;
    }
    code[i] = ForestCoarseKey(b->coarse, node->root, lo, level, &key);
    PetscCall(ForestHashInsert(&b->hash[d], key, &closure[i], &added));
    const PetscInt e = closure[i];
    if (d == dim - 1) FacetLeaf_Private(b, e, leaf, added);
    if (!added) continue;
    b->num[d]     = e + 1;
    b->key[d][e]  = key;
    b->leaf[d][e] = leaf;
    if (d > 0)
      ForestSubClosure(i, code[i], closure, code, &b->closure[d][e * ForestPow3[d]], &b->orientation[d][e * ForestPow3[d]]);
    else
      b->closure[0][e] = e, b->orientation[0][e] = 0;
  }
  closure[n / 2] = leaf;
  code[n / 2]    = 0;
  b->num[dim]    = leaf + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Key of the part of an entity at a place: per axis of its frame 0 lower half, 1 upper half, 2 whole, 3 at the middle. Returns its dimension,
   -1 when the entity is too small to have that part. The part lies inside the entity, hence in the same coarse entity and frame. */
static PetscInt PartKey_Private(EntityKey key, const int8_t place[], EntityKey *part)
{
  PetscInt lo[3], dim = 0;
  int8_t   level[3];

  const PetscInt coarse = ForestKeyUnpack(key, lo, level);
  for (PetscInt i = 0, a = 0; i < 3; ++i) {
    if (level[i] == FOREST_POINT) continue;
    const int8_t p = place[a++];
    dim += p != 3;
    if (p == 2) continue;
    if (level[i] == FOREST_MAX_LEVEL) return -1;
    if (p == 1 || p == 3) lo[i] += FOREST_ONE >> (level[i] + 1);
    level[i] = p == 3 ? FOREST_POINT : level[i] + 1;
  }
  *part = ForestKeyPack(coarse, lo, level);
  return dim;
}

/* Entities that hang inside edge or face e: those parts that exist. An edge comes before the faces around it, so that
   what lies in the middle of an edge which hangs itself becomes the child of that edge. */
static void FindChildren_Private(const Builder *b, const PetscInt first[], PetscInt d, PetscInt e, PetscInt parent[], int8_t parent_place[])
{
  static const int8_t edge_parts[3] = {3, 0, 1}; /* without the middle vertex there are no halves */
  const PetscInt      num_parts     = d == 1 ? 3 : 16;

  for (PetscInt n = 0; n < num_parts; ++n) {
    const int8_t place[3] = {d == 1 ? edge_parts[n] : (int8_t)((15 - n) & 3), d == 1 ? 2 : (int8_t)((15 - n) >> 2), 2};
    EntityKey    key;
    if (d == 2 && place[0] == 2 && place[1] == 2) continue;
    const PetscInt k = PartKey_Private(b->key[d][e], place, &key);
    const PetscInt c = k < 0 ? -1 : ForestHashFind(&b->hash[k], key);
    if (c < 0 && d == 1 && n == 0) return;
    if (c < 0 || parent[first[k] + c] >= 0) continue;
    parent[first[k] + c] = first[d] + e;
    for (PetscInt i = 0; i < 3; ++i) parent_place[3 * (first[k] + c) + i] = place[i];
  }
}

static PetscErrorCode BuildParents_Private(const Builder *b, ForestTables *t)
{
  PetscInt *parent;
  int8_t   *place;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->num_entities, &parent));
  PetscCall(PetscMalloc1(3 * t->num_entities, &place));
  for (PetscInt i = 0; i < t->num_entities; ++i) parent[i] = -1;
  for (PetscInt i = 0; i < 3 * t->num_entities; ++i) place[i] = 2;
  for (PetscInt d = 1; d < b->dim; ++d)
    for (PetscInt e = 0; e < b->num[d]; ++e) {
      /* A facet that two leaves have as a whole has nothing hanging in it. */
      if (d == b->dim - 1 && b->facet_leaf[2 * e + 1] >= 0) continue;
      FindChildren_Private(b, t->first, d, e, parent, place);
    }
  t->parent       = parent;
  t->parent_place = place;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestCheckSize(PetscInt64 num_entities)
{
  PetscFunctionBegin;
  PetscCheckInput(num_entities <= FOREST_ENTITIES,
                  "the mesh would have %lld vertices, edges, faces and cells, more than the %" PetscInt_FMT
                  " that fit this PETSc's %d-bit integers: refine less",
                  (long long)num_entities, FOREST_ENTITIES, (int)(8 * sizeof(PetscInt)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One table of closures with ids from those by dimension. */
static PetscErrorCode BuildClosures_Private(const Builder *b, ForestTables *t)
{
  PetscInt  *offset, *closure, *leaf, size = 0, at = 0;
  PetscInt64 entities = 0;
  int8_t    *orientation;

  PetscFunctionBegin;
  for (PetscInt d = 0; d <= b->dim; ++d) entities += b->num[d];
  PetscCall(ForestCheckSize(entities));
  for (PetscInt d = 0; d <= b->dim; ++d) {
    t->first[d + 1] = t->first[d] + b->num[d];
    size += b->num[d] * ForestPow3[d];
  }
  t->num_entities = t->first[b->dim + 1];
  PetscCall(PetscMalloc1(t->num_entities, &offset));
  PetscCall(PetscMalloc1(size, &closure));
  PetscCall(PetscMalloc1(size, &orientation));
  PetscCall(PetscMalloc1(t->num_entities, &leaf));
  for (PetscInt d = 0; d <= b->dim; ++d) {
    const PetscInt n = ForestPow3[d];
    PetscCall(PetscArraycpy(&orientation[at], b->orientation[d], n * b->num[d]));
    for (PetscInt e = 0; e < b->num[d]; ++e, at += n) {
      offset[t->first[d] + e] = at;
      leaf[t->first[d] + e]   = d < b->dim ? b->leaf[d][e] : e;
      for (PetscInt i = 0; i < n; ++i) closure[at + i] = t->first[ForestTensorDim[i]] + b->closure[d][e * n + i];
    }
  }
  t->closure_offset = offset;
  t->closure        = closure;
  t->orientation    = orientation;
  t->entity_leaf    = leaf;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Groups of the coarse facet in whose interior a leaf facet lies, pushed to the facet's closure. */
static PetscErrorCode BuildBoundary_Private(const Builder *b, ForestTables *t)
{
  const Coarse  *coarse = b->coarse;
  const PetscInt d = b->dim - 1, n = ForestPow3[d];
  uint64_t      *boundary;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(t->num_entities, &boundary));
  for (PetscInt e = 0; e < b->num[d]; ++e) {
    const PetscInt c = (PetscInt)(b->key[d][e].what >> 15) - coarse->first[d];
    if (c < 0 || c >= coarse->first[d + 1] - coarse->first[d] || !coarse->facet_groups[c]) continue;
    const PetscInt *closure = &t->closure[t->closure_offset[t->first[d] + e]];
    for (PetscInt i = 0; i < n; ++i) boundary[closure[i]] |= coarse->facet_groups[c];
  }
  t->boundary = boundary;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildLeaves_Private(const Coarse *coarse, const Tree *tree, PetscInt num_leaves, const PetscInt leaves[], ForestTables *t)
{
  PetscInt *root, *lo, *body;
  int8_t   *level;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num_leaves, &root));
  PetscCall(PetscMalloc1(3 * num_leaves, &lo));
  PetscCall(PetscMalloc1(num_leaves, &body));
  PetscCall(PetscMalloc1(3 * num_leaves, &level));
  for (PetscInt l = 0; l < num_leaves; ++l) {
    const TreeNode *node = &tree->node[leaves[l]];
    root[l]              = node->root;
    body[l]              = coarse->mesh.cell_body[node->root];
    for (PetscInt i = 0; i < 3; ++i) {
      lo[3 * l + i]    = node->lo[i];
      level[3 * l + i] = node->level[i];
    }
  }
  t->num_leaves = num_leaves;
  t->leaf_root  = root;
  t->leaf_lo    = lo;
  t->leaf_body  = body;
  t->leaf_level = level;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestBuildTables(const Coarse *coarse, const Tree *tree, ForestTables *t)
{
  PetscInt num_leaves, *leaves, *facet_leaf;
  Builder  b;

  PetscFunctionBegin;
  t->dim = coarse->mesh.dim;
  PetscCall(ForestTreeLeaves(tree, coarse->mesh.num_cells, &num_leaves, &leaves));
  PetscCall(BuildLeaves_Private(coarse, tree, num_leaves, leaves, t));
  PetscCall(BuilderCreate_Private(coarse, num_leaves, &b));
  for (PetscInt l = 0; l < num_leaves; ++l) PetscCall(BuilderAddLeaf_Private(&b, &tree->node[leaves[l]], l));
  PetscCall(BuildClosures_Private(&b, t));
  PetscCall(BuildParents_Private(&b, t));
  PetscCall(BuildBoundary_Private(&b, t));
  PetscCall(PetscMalloc1(2 * b.num[t->dim - 1], &facet_leaf));
  PetscCall(PetscArraycpy(facet_leaf, b.facet_leaf, 2 * b.num[t->dim - 1]));
  t->facet_leaf = facet_leaf;
  PetscCall(BuilderDestroy_Private(&b));
  PetscCall(PetscFree(leaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestTablesDestroy(ForestTables *t)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(t->leaf_root));
  PetscCall(PetscFree(t->leaf_lo));
  PetscCall(PetscFree(t->leaf_level));
  PetscCall(PetscFree(t->leaf_body));
  PetscCall(PetscFree(t->leaf_rank));
  PetscCall(PetscFree(t->closure_offset));
  PetscCall(PetscFree(t->closure));
  PetscCall(PetscFree(t->orientation));
  PetscCall(PetscFree(t->parent));
  PetscCall(PetscFree(t->parent_place));
  PetscCall(PetscFree(t->facet_leaf));
  PetscCall(PetscFree(t->boundary));
  PetscCall(PetscFree(t->entity_leaf));
  PetscFunctionReturn(PETSC_SUCCESS);
}
