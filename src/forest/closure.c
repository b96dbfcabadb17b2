/* 1-irregular closure. Two leaves that meet in a facet or (3-D) in an edge may differ by one split in each direction they share there;
   a facet must not be split in one direction only from one side and in the other only from the other side. */
#include "forestimpl.h"

/* A thin slab just beyond a facet of a leaf, in the coarse cell on the other side. */
typedef struct {
  PetscInt root;         /* -1: the facet is on the boundary */
  PetscInt lo[3], hi[3]; /* in the axes of that cell */
  PetscInt axis[3];      /* [a]: the other cell's axis along axis a of the leaf (its tangential axes) */
} Slab;

/* Across a coarse facet: from the axes of the leaf's cell to the facet's frame and from there to the other cell's axes. */
static void SlabAcross_Private(const Coarse *coarse, const TreeNode *node, PetscInt normal, PetscInt side, Slab *slab)
{
  const PetscInt dim = coarse->mesh.dim, n = dim - 1, place = ForestPow3[dim] / 2 + (2 * side - 1) * ForestPow3[normal];
  const PetscInt entry = coarse->closure_offset[coarse->first[dim] + node->root] + place;
  const PetscInt f     = coarse->closure[entry] - coarse->first[n];
  const PetscInt self  = coarse->facet_cell[f][0] == node->root && coarse->facet_place[f][0] == place ? 0 : 1;
  PetscInt       lo[2] = {0, 0}, extent[2] = {0, 0}, from[2] = {0, 0};

  slab->root = coarse->facet_cell[f][1 - self];
  if (slab->root < 0) return;
  for (PetscInt a = 0, j = 0; a < dim; ++a) {
    if (a == normal) continue;
    const PetscInt axis = ForestFrameAxis(n, coarse->orientation[entry], j++);
    extent[axis]        = FOREST_ONE >> node->level[a];
    lo[axis]            = ForestFrameReversed(coarse->orientation[entry], axis) ? FOREST_ONE - node->lo[a] - extent[axis] : node->lo[a];
    from[axis]          = a;
  }
  const PetscInt other = coarse->facet_place[f][1 - self];
  const int8_t   code  = coarse->orientation[coarse->closure_offset[coarse->first[dim] + slab->root] + other];
  for (PetscInt a = 0, j = 0; a < dim; ++a) {
    const PetscInt t = (other / ForestPow3[a]) % 3;
    if (t != 1) {
      slab->lo[a] = t == 0 ? 0 : FOREST_ONE - 1;
      slab->hi[a] = slab->lo[a] + 1;
      continue;
    }
    const PetscInt axis    = ForestFrameAxis(n, code, j++);
    slab->lo[a]            = ForestFrameReversed(code, axis) ? FOREST_ONE - lo[axis] - extent[axis] : lo[axis];
    slab->hi[a]            = slab->lo[a] + extent[axis];
    slab->axis[from[axis]] = a;
  }
}

static void SlabBeyond_Private(const Coarse *coarse, const TreeNode *node, PetscInt normal, PetscInt side, Slab *slab)
{
  const PetscInt plane = node->lo[normal] + (side ? FOREST_ONE >> node->level[normal] : 0);

  if (plane == 0 || plane == FOREST_ONE) {
    SlabAcross_Private(coarse, node, normal, side, slab);
    return;
  }
  slab->root = node->root;
  for (PetscInt a = 0; a < coarse->mesh.dim; ++a) {
    slab->axis[a] = a;
    slab->lo[a]   = node->lo[a];
    slab->hi[a]   = node->lo[a] + (FOREST_ONE >> node->level[a]);
  }
  slab->lo[normal] = side ? plane : plane - 1;
  slab->hi[normal] = slab->lo[normal] + 1;
}

/* What two leaves that face each other ask of one another. */
static void Compare_Private(const Tree *tree, PetscInt dim, PetscInt node, PetscInt normal, const Slab *slab, PetscInt other, int8_t required[])
{
  const int8_t *mine = tree->node[node].level, *theirs = tree->node[other].level;
  int8_t        coarser = 0, finer = 0; /* my directions; and in theirs: */
  int8_t        their_coarser = 0;

  for (PetscInt a = 0; a < dim; ++a) {
    if (a == normal) continue;
    const PetscInt difference = mine[a] - theirs[slab->axis[a]];
    if (difference <= -2) required[node] |= (int8_t)(1 << a);
    if (difference >= 2) required[other] |= (int8_t)(1 << slab->axis[a]);
    if (difference < 0) coarser |= (int8_t)(1 << a);
    if (difference > 0) finer |= (int8_t)(1 << a), their_coarser |= (int8_t)(1 << slab->axis[a]);
  }
  if (!coarser || !finer) return;
  required[node] |= coarser;
  required[other] |= their_coarser;
}

/* Compare a leaf with every leaf that overlaps the slab, by descent from the root. */
static void Facet_Private(const Coarse *coarse, const Tree *tree, PetscInt node, PetscInt normal, PetscInt side, int8_t required[])
{
  const PetscInt dim = coarse->mesh.dim;
  PetscInt       stack[8 * 3 * FOREST_MAX_LEVEL], depth = 0;
  Slab           slab;

  SlabBeyond_Private(coarse, &tree->node[node], normal, side, &slab);
  if (slab.root < 0) return;
  stack[depth++] = slab.root;
  while (depth > 0) {
    const PetscInt  current = stack[--depth];
    const TreeNode *n       = &tree->node[current];
    PetscBool       overlap = PETSC_TRUE;
    for (PetscInt a = 0; a < dim && overlap; ++a) overlap = (PetscBool)(n->lo[a] < slab.hi[a] && slab.lo[a] < n->lo[a] + (FOREST_ONE >> n->level[a]));
    if (!overlap) continue;
    if (n->child < 0)
      Compare_Private(tree, dim, node, normal, &slab, current, required);
    else
      for (PetscInt c = ForestNumChildren(n->split); c-- > 0;) stack[depth++] = n->child + c;
  }
}

/* Place in tensor order of edge number k (0..11) of a hex, and its axis. */
static PetscInt EdgePlace_Private(PetscInt k, PetscInt *axis)
{
  PetscInt place = 0;

  *axis = k / 4;
  for (PetscInt a = 0, bit = 0; a < 3; ++a) place += ForestPow3[a] * (a == *axis ? 1 : 2 * ((k >> bit++) & 1));
  return place;
}

static EntityKey EdgeKey_Private(const Coarse *coarse, const TreeNode *node, PetscInt k)
{
  PetscInt  axis, lo[3];
  int8_t    level[3];
  EntityKey key;

  const PetscInt place = EdgePlace_Private(k, &axis);
  for (PetscInt a = 0; a < 3; ++a) {
    lo[a]    = node->lo[a] + ((place / ForestPow3[a]) % 3 == 2 ? FOREST_ONE >> node->level[a] : 0);
    level[a] = a == axis ? node->level[a] : FOREST_POINT;
  }
  ForestCoarseKey(coarse, node->root, lo, level, &key);
  return key;
}

/* Flag every edge in the table that contains `key` and is at least four times as long. lowest: no edge has a lower level. */
static void FlagLong_Private(const EntityHash *hash, EntityKey key, int8_t lowest, PetscBool flag[])
{
  PetscInt lo[3], axis = 0;
  int8_t   level[3];

  const PetscInt coarse = ForestKeyUnpack(key, lo, level);
  while (level[axis] == FOREST_POINT) ++axis;
  for (level[axis] -= 2; level[axis] >= lowest; --level[axis]) {
    lo[axis] &= ~((FOREST_ONE >> level[axis]) - 1);
    const PetscInt e = ForestHashFind(hash, ForestKeyPack(coarse, lo, level));
    if (e >= 0) flag[e] = PETSC_TRUE;
  }
}

/* 3-D: edges of any leaves around a line, neighbours through a facet or not. */
static PetscErrorCode Edges_Private(const Coarse *coarse, const Tree *tree, PetscInt num_leaves, const PetscInt leaves[], int8_t required[])
{
  int8_t     lowest = FOREST_MAX_LEVEL, highest = 0;
  PetscInt  *edge;
  PetscBool *flag, added;
  EntityHash hash;

  PetscFunctionBegin;
  for (PetscInt l = 0; l < num_leaves; ++l)
    for (PetscInt a = 0; a < 3; ++a) {
      lowest  = PetscMin(lowest, tree->node[leaves[l]].level[a]);
      highest = PetscMax(highest, tree->node[leaves[l]].level[a]);
    }
  if (highest - lowest < 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForestHashCreate(4 * num_leaves, &hash));
  PetscCall(PetscMalloc1(12 * num_leaves, &edge));
  for (PetscInt i = 0; i < 12 * num_leaves; ++i)
    PetscCall(ForestHashInsert(&hash, EdgeKey_Private(coarse, &tree->node[leaves[i / 12]], i % 12), &edge[i], &added));
  PetscCall(PetscCalloc1(hash.count, &flag));
  for (size_t i = 0; i <= hash.mask; ++i)
    if (hash.value[i] >= 0) FlagLong_Private(&hash, hash.key[i], lowest, flag);
  for (PetscInt i = 0; i < 12 * num_leaves; ++i)
    if (flag[edge[i]]) required[leaves[i / 12]] |= (int8_t)(1 << ((i % 12) / 4));
  PetscCall(PetscFree(flag));
  PetscCall(PetscFree(edge));
  PetscCall(ForestHashDestroy(&hash));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Split the leaves that must be, in the order of leaves[]; the new nodes are the fresh ones of the next sweep. */
static PetscErrorCode Apply_Private(Tree *tree, PetscInt num_leaves, const PetscInt leaves[], const int8_t required[], PetscInt *num_fresh, PetscInt fresh[])
{
  PetscFunctionBegin;
  *num_fresh = 0;
  for (PetscInt l = 0; l < num_leaves; ++l) {
    TreeNode *n = &tree->node[leaves[l]];
    if (!required[leaves[l]]) continue;
    if (n->hidden >= 0) {
      n->child  = n->hidden;
      n->hidden = -1;
    } else {
      PetscCall(ForestTreeSplit(tree, leaves[l], required[leaves[l]]));
      n = &tree->node[leaves[l]];
    }
    for (PetscInt c = 0; c < ForestNumChildren(n->split); ++c) fresh[(*num_fresh)++] = n->child + c;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestTreeClose(const Coarse *coarse, Tree *tree, PetscInt num_fresh, const PetscInt fresh_in[])
{
  PetscInt *fresh, *leaves, num_leaves;
  int8_t   *required;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num_fresh, &fresh));
  PetscCall(PetscArraycpy(fresh, fresh_in, num_fresh));
  while (num_fresh > 0) {
    PetscCall(PetscCalloc1(tree->num, &required));
    for (PetscInt i = 0; i < num_fresh; ++i)
      for (PetscInt f = 0; f < 2 * coarse->mesh.dim && tree->node[fresh[i]].child < 0; ++f) Facet_Private(coarse, tree, fresh[i], f / 2, f % 2, required);
    PetscCall(ForestTreeLeaves(tree, coarse->mesh.num_cells, &num_leaves, &leaves));
    if (coarse->mesh.dim == 3) PetscCall(Edges_Private(coarse, tree, num_leaves, leaves, required));
    PetscCall(PetscFree(fresh));
    PetscCall(PetscMalloc1(8 * num_leaves, &fresh));
    PetscCall(Apply_Private(tree, num_leaves, leaves, required, &num_fresh, fresh));
    PetscCall(PetscFree(leaves));
    PetscCall(PetscFree(required));
  }
  PetscCall(PetscFree(fresh));
  PetscFunctionReturn(PETSC_SUCCESS);
}
