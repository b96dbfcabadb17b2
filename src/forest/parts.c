/* Which cells of the coarse mesh hang together. */
#include "forestimpl.h"

PetscErrorCode ForestCoarseParts(const CoarseMesh *mesh, PetscInt *num, PetscInt part[])
{
  const PetscInt corners = 1 << mesh->dim;
  PetscInt      *root, *number;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(mesh->num_vertices, &root, mesh->num_vertices, &number));
  for (PetscInt v = 0; v < mesh->num_vertices; ++v) root[v] = v, number[v] = -1;
  for (PetscInt i = 0; i < corners * mesh->num_cells; ++i) {
    const PetscInt a = GroupRoot(root, mesh->cell_vertices[i]), b = GroupRoot(root, mesh->cell_vertices[i - i % corners]);
    root[PetscMax(a, b)] = PetscMin(a, b);
  }
  *num = 0;
  for (PetscInt c = 0; c < mesh->num_cells; ++c) {
    const PetscInt at = GroupRoot(root, mesh->cell_vertices[corners * c]);
    if (number[at] < 0) number[at] = (*num)++;
    part[c] = number[at];
  }
  PetscCall(PetscFree2(root, number));
  PetscFunctionReturn(PETSC_SUCCESS);
}
