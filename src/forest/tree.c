/* Refinement trees in one array of nodes. */
#include "forestimpl.h"

PetscErrorCode ForestTreeCreate(PetscInt num_roots, Tree *tree)
{
  PetscFunctionBegin;
  tree->num      = num_roots;
  tree->capacity = PetscMax(num_roots, 16);
  PetscCall(PetscCalloc1(tree->capacity, &tree->node));
  for (PetscInt r = 0; r < num_roots; ++r) tree->node[r] = (TreeNode){.root = r, .child = -1, .hidden = -1, .old_first = r, .old_count = 1};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestTreeCopy(const Tree *from, Tree *to)
{
  PetscFunctionBegin;
  to->num      = from->num;
  to->capacity = 2 * from->num;
  PetscCall(PetscMalloc1(to->capacity, &to->node));
  PetscCall(PetscArraycpy(to->node, from->node, from->num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestTreeDestroy(Tree *tree)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(tree->node));
  tree->num = tree->capacity = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for `more` nodes beyond the present ones. */
static PetscErrorCode TreeReserve_Private(Tree *tree, PetscInt more)
{
  PetscFunctionBegin;
  if (tree->num + more > tree->capacity) {
    tree->capacity = 2 * (tree->num + more);
    PetscCall(PetscRealloc(sizeof(TreeNode) * (size_t)tree->capacity, &tree->node));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestTreeSplit(Tree *tree, PetscInt node, int8_t directions)
{
  const PetscInt num = ForestNumChildren(directions);

  PetscFunctionBegin;
  PetscCall(TreeReserve_Private(tree, num));
  TreeNode *parent = &tree->node[node], *children = &tree->node[tree->num];
  for (PetscInt c = 0; c < num; ++c) {
    children[c] = *parent;
    for (PetscInt i = 0, bit = 0; i < 3; ++i) {
      if (!((directions >> i) & 1)) continue;
      PetscCheck(parent->level[i] < FOREST_MAX_LEVEL, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
                 "Cell %" PetscInt_FMT " of the coarse mesh would be split more than %d times in one direction", parent->root, FOREST_MAX_LEVEL);
      children[c].level[i] = parent->level[i] + 1;
      if ((c >> bit++) & 1) children[c].lo[i] += FOREST_ONE >> children[c].level[i];
    }
    children[c].split = 0;
  }
  parent->child = tree->num;
  parent->split = directions;
  tree->num += num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void TreeCountLeaves_Private(const Tree *tree, PetscInt node, PetscInt *num, PetscInt *leaves)
{
  const TreeNode *n = &tree->node[node];
  if (n->child < 0) {
    if (leaves) leaves[*num] = node;
    ++*num;
    return;
  }
  for (PetscInt c = 0; c < ForestNumChildren(n->split); ++c) TreeCountLeaves_Private(tree, n->child + c, num, leaves);
}

PetscErrorCode ForestTreeLeaves(const Tree *tree, PetscInt num_roots, PetscInt *num_leaves, PetscInt **leaves)
{
  PetscFunctionBegin;
  *num_leaves = 0;
  PetscCall(PetscMalloc1(tree->num, leaves));
  for (PetscInt r = 0; r < num_roots; ++r) TreeCountLeaves_Private(tree, r, num_leaves, *leaves);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Index of a child among those of a split: `upper` has bit i set for the upper half in direction i. */
static PetscInt ChildIndex_Private(int8_t directions, PetscInt upper)
{
  PetscInt index = 0;

  for (PetscInt i = 0, bit = 0; i < 3; ++i)
    if ((directions >> i) & 1) index |= ((upper >> i) & 1) << bit++;
  return index;
}

/* Upper halves of child c of a split, the inverse of ChildIndex_Private. */
static PetscInt ChildUpper_Private(int8_t directions, PetscInt c)
{
  PetscInt upper = 0;

  for (PetscInt i = 0, bit = 0; i < 3; ++i)
    if ((directions >> i) & 1) upper |= ((c >> bit++) & 1) << i;
  return upper;
}

/* Move the split in the directions `common` from all children of a node to the node itself. What a child is split in beyond that stays below. */
static PetscErrorCode TreePullUp_Private(Tree *tree, PetscInt node, int8_t common)
{
  const TreeNode old  = tree->node[node];
  const int8_t   both = (int8_t)(old.split | common);

  PetscFunctionBegin;
  PetscCall(ForestTreeSplit(tree, node, both));
  for (PetscInt k = 0; k < ForestNumChildren(both); ++k) {
    const PetscInt upper = ChildUpper_Private(both, k), target = tree->node[node].child + k;
    const TreeNode child = tree->node[old.child + ChildIndex_Private(old.split, upper)];
    const int8_t   rest  = (int8_t)(child.split & ~common);
    if (!rest) {
      tree->node[target] = tree->node[child.child + ChildIndex_Private(child.split, upper)];
      continue;
    }
    PetscCall(ForestTreeSplit(tree, target, rest));
    for (PetscInt r = 0; r < ForestNumChildren(rest); ++r) {
      const PetscInt from                      = child.child + ChildIndex_Private(child.split, (upper & common) | ChildUpper_Private(rest, r));
      tree->node[tree->node[target].child + r] = tree->node[from];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Normal form below a node: a split in y of both halves of a split in x becomes one split in x and y, whatever came first. Merging then
   takes back together what was split in turn; two neighbours split in opposite order could else never merge, each waiting for the other. */
static PetscErrorCode TreeNormalize_Private(Tree *tree, PetscInt node)
{
  PetscFunctionBegin;
  if (tree->node[node].child < 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt c = 0; c < ForestNumChildren(tree->node[node].split); ++c) PetscCall(TreeNormalize_Private(tree, tree->node[node].child + c));
  while (PETSC_TRUE) {
    const TreeNode n      = tree->node[node];
    int8_t         common = (int8_t)~n.split;
    for (PetscInt c = 0; c < ForestNumChildren(n.split); ++c) common &= tree->node[n.child + c].child < 0 ? 0 : tree->node[n.child + c].split;
    if (!common) break;
    PetscCall(TreePullUp_Private(tree, node, common));
    for (PetscInt c = 0; c < ForestNumChildren(tree->node[node].split); ++c) PetscCall(TreeNormalize_Private(tree, tree->node[node].child + c));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestTreeNormalize(Tree *tree, PetscInt num_roots)
{
  PetscFunctionBegin;
  for (PetscInt r = 0; r < num_roots; ++r) PetscCall(TreeNormalize_Private(tree, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copy the children of node `from` under node `to`, then theirs: siblings stay contiguous, the rest is depth-first. */
static void TreeCompact_Private(const Tree *from, PetscInt source, Tree *to, PetscInt target)
{
  const TreeNode *n = &from->node[source];
  if (n->child < 0) return;
  const PetscInt num = ForestNumChildren(n->split), first = to->num;
  to->node[target].child = first;
  to->num += num;
  for (PetscInt c = 0; c < num; ++c) {
    to->node[first + c]        = from->node[n->child + c];
    to->node[first + c].hidden = -1;
  }
  for (PetscInt c = 0; c < num; ++c) TreeCompact_Private(from, n->child + c, to, first + c);
}

PetscErrorCode ForestTreeCompact(const Tree *from, PetscInt num_roots, Tree *to)
{
  PetscFunctionBegin;
  to->num = to->capacity = from->num; /* upper bound */
  PetscCall(PetscMalloc1(to->capacity, &to->node));
  PetscCall(PetscArraycpy(to->node, from->node, num_roots));
  to->num = num_roots;
  for (PetscInt r = 0; r < num_roots; ++r) {
    to->node[r].hidden = -1;
    TreeCompact_Private(from, r, to, r);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
