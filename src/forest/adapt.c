/* A new forest from marks on an old one. */
#include "forestimpl.h"

/* Range of old leaves under each node of the copy: leaves are numbered depth-first. */
static PetscInt NumberLeaves_Private(Tree *tree, PetscInt node, PetscInt next)
{
  TreeNode *n = &tree->node[node];

  n->old_first = next;
  n->hidden    = -1;
  if (n->child < 0)
    ++next;
  else
    for (PetscInt c = 0; c < ForestNumChildren(n->split); ++c) next = NumberLeaves_Private(tree, n->child + c, next);
  n->old_count = next - n->old_first;
  return next;
}

/* Siblings that are all leaves, all marked for merging and none for splitting disappear, for the time being. A parent comes before its
   children in the array, so that only one generation goes. */
static void Merge_Private(Tree *tree, const MarkList *marks, PetscInt *num_fresh, PetscInt fresh[])
{
  for (PetscInt i = 0; i < tree->num; ++i) {
    TreeNode *n     = &tree->node[i];
    PetscBool merge = (PetscBool)(n->child >= 0 && marks->coarsen);
    for (PetscInt c = 0; merge && c < ForestNumChildren(n->split); ++c) {
      const TreeNode *child = &tree->node[n->child + c];
      if (child->child >= 0 || !marks->coarsen[child->old_first] || marks->split[child->old_first]) merge = PETSC_FALSE;
    }
    if (!merge) continue;
    n->hidden             = n->child;
    n->child              = -1;
    fresh[(*num_fresh)++] = i;
  }
}

/* Copy of the tree with merges and splits carried out and closed again. */
static PetscErrorCode AdaptTree_Private(Forest forest, const MarkList *marks, Tree *result)
{
  const PetscInt dim = forest->tables.dim, num_roots = forest->coarse->mesh.num_cells;
  const int8_t   all       = (int8_t)((1 << dim) - 1);
  PetscInt       num_fresh = 0, num_leaves, *leaves, *fresh, next = 0;
  PetscInt64     more = 0;
  Tree           tree;

  PetscFunctionBegin;
  for (PetscInt l = 0; l < forest->tables.num_leaves; ++l) more += ForestNumChildren(marks->split[l] & all);
  ErrorAsked("%lld cells", (long long)more);
  PetscCall(ForestCheckSize(more << dim)); /* a cell brings as many entities at least: before memory is asked for */
  PetscCall(ForestTreeCopy(&forest->tree, &tree));
  for (PetscInt r = 0; r < num_roots; ++r) next = NumberLeaves_Private(&tree, r, next);
  PetscCall(ForestTreeLeaves(&tree, num_roots, &num_leaves, &leaves));
  PetscCall(PetscMalloc1(8 * num_leaves + tree.num, &fresh));
  Merge_Private(&tree, marks, &num_fresh, fresh);
  for (PetscInt l = 0; l < num_leaves; ++l) {
    const int8_t directions = marks->split[l] & all;
    if (!directions) continue;
    PetscCall(ForestTreeSplit(&tree, leaves[l], directions));
    for (PetscInt c = 0; c < ForestNumChildren(directions); ++c) fresh[num_fresh++] = tree.node[leaves[l]].child + c;
  }
  PetscCall(ForestTreeClose(forest->coarse, &tree, num_fresh, fresh));
  PetscCall(ForestTreeNormalize(&tree, num_roots));
  PetscCall(ForestTreeCompact(&tree, num_roots, result));
  PetscCall(PetscFree(fresh));
  PetscCall(PetscFree(leaves));
  PetscCall(ForestTreeDestroy(&tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMap_Private(const Tree *tree, PetscInt num_roots, ForestMap *map)
{
  PetscInt *leaves;

  PetscFunctionBegin;
  PetscCall(ForestTreeLeaves(tree, num_roots, &map->num, &leaves));
  PetscCall(PetscMalloc1(map->num, &map->old_first));
  PetscCall(PetscMalloc1(map->num, &map->old_count));
  for (PetscInt l = 0; l < map->num; ++l) {
    map->old_first[l] = tree->node[leaves[l]].old_first;
    map->old_count[l] = tree->node[leaves[l]].old_count;
  }
  PetscCall(PetscFree(leaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestMapDestroy(ForestMap *map)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(map->old_first));
  PetscCall(PetscFree(map->old_count));
  map->num = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Weight of a new leaf: that of the old leaf it comes from, the largest of those merged. */
static PetscErrorCode InheritWeights_Private(const ForestMap *map, const PetscReal old[], PetscReal **weight)
{
  PetscFunctionBegin;
  *weight = NULL;
  if (!old) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(map->num, weight));
  for (PetscInt l = 0; l < map->num; ++l) {
    (*weight)[l] = 0;
    for (PetscInt o = 0; o < map->old_count[l]; ++o) (*weight)[l] = PetscMax((*weight)[l], old[map->old_first[l] + o]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pairs of new leaves: all combinations of the new leaves of either old one. */
static PetscErrorCode InheritPairs_Private(const ForestMap *map, PetscInt num_old, PetscInt num, const PetscInt old[][2], PetscInt *num_new,
                                           PetscInt (**pairs)[2])
{
  PetscInt(*range)[2], count = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num_old, &range)); /* first and end of the new leaves that overlap an old one */
  for (PetscInt l = 0; l < map->num; ++l)
    for (PetscInt o = map->old_first[l]; o < map->old_first[l] + map->old_count[l]; ++o) {
      if (range[o][1] == 0) range[o][0] = l;
      range[o][1] = l + 1;
    }
  for (PetscInt p = 0; p < num; ++p) count += (range[old[p][0]][1] - range[old[p][0]][0]) * (range[old[p][1]][1] - range[old[p][1]][0]);
  PetscCall(PetscMalloc1(count, pairs));
  *num_new = 0;
  for (PetscInt p = 0; p < num; ++p)
    for (PetscInt a = range[old[p][0]][0]; a < range[old[p][0]][1]; ++a)
      for (PetscInt b = range[old[p][1]][0]; b < range[old[p][1]][1]; ++b) {
        (*pairs)[*num_new][0]     = a;
        (*pairs)[(*num_new)++][1] = b;
      }
  PetscCall(PetscFree(range));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestAdapt(Forest forest, const MarkList *marks, const PetscReal leaf_weight[], PetscInt num_pairs, const PetscInt pairs[][2], Forest *adapted,
                           ForestMap *map)
{
  Coarse    *coarse = forest->coarse;
  PetscReal *weight;
  PetscInt   num_new_pairs = 0, (*new_pairs)[2] = NULL;
  Tree       tree;

  PetscFunctionBegin;
  PetscCall(AdaptTree_Private(forest, marks, &tree));
  PetscCall(CreateMap_Private(&tree, coarse->mesh.num_cells, map));
  PetscCall(InheritWeights_Private(map, leaf_weight, &weight));
  PetscCall(InheritPairs_Private(map, forest->tables.num_leaves, num_pairs, pairs, &num_new_pairs, &new_pairs));
  ++coarse->references;
  PetscCall(ForestCreateFromTree(forest->comm, coarse, &tree, forest->tables.revision + 1, weight, num_new_pairs, (const PetscInt(*)[2])new_pairs, adapted));
  PetscCall(PetscFree(weight));
  PetscCall(PetscFree(new_pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}
