/* Life of a Forest. */
#include "forestimpl.h"

PetscErrorCode ForestCreateFromTree(MPI_Comm comm, Coarse *coarse, Tree *tree, PetscInt revision, const PetscReal weight[], PetscInt num_pairs,
                                    const PetscInt pairs[][2], Forest *result)
{
  Forest       forest;
  PetscMPIInt *rank;

  PetscFunctionBegin;
  PetscCall(PetscNew(&forest));
  PetscCall(PetscCommDuplicate(comm, &forest->comm, NULL));
  forest->coarse          = coarse;
  forest->tree            = *tree;
  *tree                   = (Tree){0};
  forest->tables.revision = revision;
  PetscCall(ForestBuildTables(coarse, &forest->tree, &forest->tables));
  PetscCall(PetscMalloc1(forest->tables.num_leaves, &rank));
  forest->tables.leaf_rank = rank;
  PetscCall(ForestPartition(forest->comm, &forest->tables, weight, num_pairs, pairs, rank));
  *result = forest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestCreateFromCoarse(MPI_Comm comm, CoarseMesh *mesh, PetscInt num_facets, const PetscInt facet_vertices[], const uint64_t facet_groups[],
                                      PetscInt refine, Forest *forest)
{
  Coarse *coarse = NULL;
  Tree    tree, compact;

  PetscFunctionBegin;
  PetscCall(ForestCoarseCreate(mesh, num_facets, facet_vertices, facet_groups, &coarse));
  PetscCall(ForestTreeCreate(coarse->mesh.num_cells, &tree));
  for (PetscInt pass = 0, start = 0; pass < refine; ++pass) {
    const PetscInt end = tree.num;
    for (PetscInt node = start; node < end; ++node) PetscCall(ForestTreeSplit(&tree, node, (int8_t)((1 << coarse->mesh.dim) - 1)));
    start = end;
  }
  PetscCall(ForestTreeCompact(&tree, coarse->mesh.num_cells, &compact));
  PetscCall(ForestTreeDestroy(&tree));
  PetscCall(ForestCreateFromTree(comm, coarse, &compact, 0, NULL, 0, NULL, forest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestDestroy(Forest *forest)
{
  PetscFunctionBegin;
  if (!*forest) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForestTablesDestroy(&(*forest)->tables));
  PetscCall(ForestTreeDestroy(&(*forest)->tree));
  PetscCall(ForestCoarseDestroy(&(*forest)->coarse));
  PetscCall(DMDestroy(&(*forest)->leaf_dm));
  PetscCall(PetscFree((*forest)->point_entity));
  PetscCall(PetscCommDestroy(&(*forest)->comm));
  PetscCall(PetscFree(*forest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestView(Forest forest, PetscViewer viewer)
{
  const ForestTables *t       = &forest->tables;
  const CoarseMesh   *mesh    = &forest->coarse->mesh;
  PetscInt            hanging = 0, deepest = 0;

  PetscFunctionBegin;
  for (PetscInt e = 0; e < t->num_entities; ++e) hanging += t->parent[e] >= 0;
  for (PetscInt i = 0; i < 3 * t->num_leaves; ++i) deepest = PetscMax(deepest, t->leaf_level[i]);
  PetscCall(PetscViewerASCIIPrintf(
      viewer, "Forest: dimension %" PetscInt_FMT ", %" PetscInt_FMT " coarse cells of geometry order %" PetscInt_FMT ", revision %" PetscInt_FMT "\n", t->dim,
      mesh->num_cells, mesh->geometry_order, t->revision));
  PetscCall(PetscViewerASCIIPrintf(viewer,
                                   "  %" PetscInt_FMT " leaves, deepest level %" PetscInt_FMT ", %" PetscInt_FMT " vertices, %" PetscInt_FMT
                                   " facets, %" PetscInt_FMT " hanging entities\n",
                                   t->num_leaves, deepest, t->first[1], t->first[t->dim] - t->first[t->dim - 1], hanging));
  for (PetscInt b = 0; b < mesh->num_bodies; ++b) PetscCall(PetscViewerASCIIPrintf(viewer, "  body %s\n", mesh->body_name[b]));
  for (PetscInt b = 0; b < mesh->num_boundaries; ++b) PetscCall(PetscViewerASCIIPrintf(viewer, "  boundary %s\n", mesh->boundary_name[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestGetCoarse(Forest forest, const CoarseMesh **mesh)
{
  PetscFunctionBegin;
  *mesh = &forest->coarse->mesh;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestGetTables(Forest forest, const ForestTables **tables)
{
  PetscFunctionBegin;
  *tables = &forest->tables;
  PetscFunctionReturn(PETSC_SUCCESS);
}

MPI_Comm ForestComm(Forest forest)
{
  return forest->comm;
}
