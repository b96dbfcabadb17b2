/* A forest from the splits of its tree, as a checkpoint keeps them, and a hash by which to know the coarse mesh again. */
#include "forestimpl.h"

static void Splits_Private(const Tree *tree, PetscInt node, PetscInt *num, int8_t split[])
{
  const TreeNode *n = &tree->node[node];

  split[(*num)++] = (int8_t)(n->child < 0 ? 0 : n->split);
  for (PetscInt c = 0; n->child >= 0 && c < ForestNumChildren(n->split); ++c) Splits_Private(tree, n->child + c, num, split);
}

PetscErrorCode ForestGetSplits(Forest forest, PetscInt *num, int8_t **split)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(forest->tree.num, split));
  *num = 0;
  for (PetscInt r = 0; r < forest->coarse->mesh.num_cells; ++r) Splits_Private(&forest->tree, r, num, *split);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The list may be anything. */
static PetscBool MaySplit_Private(const TreeNode *node, PetscInt dim, int8_t directions)
{
  if (directions < 0 || directions >= 1 << dim) return PETSC_FALSE;
  for (PetscInt i = 0; i < dim; ++i) {
    if ((directions >> i & 1) && node->level[i] >= FOREST_MAX_LEVEL) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Split a node and what comes below it as split[*at ..] says. */
static PetscErrorCode Replay_Private(Tree *tree, PetscInt dim, PetscInt node, PetscInt num, const int8_t split[], PetscInt *at)
{
  PetscFunctionBegin;
  PetscCheckInput(*at < num && MaySplit_Private(&tree->node[node], dim, split[*at]), "-restart: the splits of the checkpoint make no forest");
  const int8_t directions = split[(*at)++];
  if (!directions) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForestTreeSplit(tree, node, directions));
  for (PetscInt c = 0, first = tree->node[node].child; c < ForestNumChildren(directions); ++c) PetscCall(Replay_Private(tree, dim, first + c, num, split, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestRestore(Forest source, PetscInt num, const int8_t split[], PetscInt revision, PetscInt num_leaves, const PetscMPIInt leaf_rank[],
                             const PetscReal leaf_weight[], Forest *forest)
{
  Coarse        *coarse    = source->coarse;
  const PetscInt num_roots = coarse->mesh.num_cells;
  PetscInt       at        = 0, leaves, *list;
  Tree           tree, compact;

  PetscFunctionBegin;
  PetscCall(ForestTreeCreate(num_roots, &tree));
  for (PetscInt r = 0; r < num_roots; ++r) PetscCall(Replay_Private(&tree, coarse->mesh.dim, r, num, split, &at));
  PetscCall(ForestTreeLeaves(&tree, num_roots, &leaves, &list));
  const PetscInt nodes = tree.num;
  PetscCall(ForestTreeClose(coarse, &tree, leaves, list)); /* splits nothing: the forest was closed */
  PetscCall(PetscFree(list));
  PetscCheckInput(at == num && leaves == num_leaves && tree.num == nodes, "-restart: the splits of the checkpoint make no forest of %" PetscInt_FMT " cells",
                  num_leaves);
  PetscCall(ForestTreeCompact(&tree, num_roots, &compact));
  PetscCall(ForestTreeDestroy(&tree));
  ++coarse->references;
  PetscCall(ForestCreateFromTree(source->comm, coarse, &compact, revision, leaf_weight, 0, NULL, forest));
  if (leaf_rank) PetscCall(PetscArraycpy((PetscMPIInt *)(*forest)->tables.leaf_rank, leaf_rank, (*forest)->tables.num_leaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestCoarseHash(Forest forest, uint64_t *hash)
{
  const Coarse     *c          = forest->coarse;
  const CoarseMesh *m          = &c->mesh;
  const PetscInt    numbers[]  = {m->dim, m->num_cells, m->num_vertices, m->geometry_order, m->num_bodies, m->num_boundaries - m->num_unions};
  const size_t      num_facets = (size_t)(c->first[m->dim] - c->first[m->dim - 1]), cells = (size_t)m->num_cells;
  size_t            corners = (size_t)1 << m->dim, nodes = 1;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < m->dim; ++d) nodes *= (size_t)(m->geometry_order + 1);
  *hash = HashBytes(0, numbers, sizeof(numbers));
  *hash = HashBytes(*hash, m->cell_vertices, cells * corners * sizeof(PetscInt));
  *hash = HashBytes(*hash, m->cell_geometry, cells * nodes * 3 * sizeof(PetscReal));
  *hash = HashBytes(*hash, m->cell_body, cells * sizeof(PetscInt));
  for (size_t f = 0; f < num_facets; ++f) { /* of the file: unions are the scene's */
    const uint64_t groups = m->num_unions ? c->facet_groups[f] & ((UINT64_C(1) << numbers[5]) - 1) : c->facet_groups[f];
    *hash                 = HashBytes(*hash, &groups, sizeof(groups));
  }
  for (PetscInt b = 0; b < m->num_bodies; ++b) *hash = HashBytes(*hash, m->body_name[b], strlen(m->body_name[b]) + 1);
  for (PetscInt b = 0; b < numbers[5]; ++b) *hash = HashBytes(*hash, m->boundary_name[b], strlen(m->boundary_name[b]) + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}
