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

const CoarseMesh *ForestGetCoarse(Forest forest)
{
  return &forest->coarse->mesh;
}

const ForestTables *ForestGetTables(Forest forest)
{
  return &forest->tables;
}

MPI_Comm ForestComm(Forest forest)
{
  return forest->comm;
}
