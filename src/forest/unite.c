/* Boundary groups made of others: what lies in one of them lies in the union. */
#include "forestimpl.h"

static PetscErrorCode Enter_Private(CoarseMesh *m, uint64_t groups)
{
  char *name;

  PetscFunctionBegin;
  PetscCheckInput(m->num_boundaries < 64, "the mesh has %" PetscInt_FMT " boundary groups, and lists of groups as sides of pairs make more; at most 64 fit",
                  m->num_boundaries - m->num_unions);
  PetscCall(PetscRealloc((size_t)(m->num_boundaries + 1) * sizeof(*m->boundary_name), &m->boundary_name));
  name    = m->boundary_name[m->num_boundaries];
  name[0] = 0;
  for (PetscInt g = 0; g < m->num_boundaries; ++g) {
    if (!(groups >> g & 1)) continue;
    if (name[0]) TextAppend(MORTISE_NAME, name, " + ");
    TextAppend(MORTISE_NAME, name, m->boundary_name[g]);
  }
  m->united[m->num_unions++] = groups;
  ++m->num_boundaries;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestUnite(Forest forest, uint64_t groups, PetscInt *group)
{
  Coarse        *coarse   = forest->coarse;
  uint64_t      *boundary = (uint64_t *)forest->tables.boundary;
  const PetscInt num      = coarse->first[coarse->mesh.dim] - coarse->first[coarse->mesh.dim - 1];

  PetscFunctionBegin;
  for (*group = 0; *group < coarse->mesh.num_boundaries; ++*group)
    if (CoarseMembers(&coarse->mesh, *group) == groups) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Enter_Private(&coarse->mesh, groups));
  for (PetscInt f = 0; f < num; ++f)
    if (coarse->facet_groups[f] & groups) coarse->facet_groups[f] |= UINT64_C(1) << *group;
  for (PetscInt e = 0; e < forest->tables.num_entities; ++e)
    if (boundary[e] & groups) boundary[e] |= UINT64_C(1) << *group;
  PetscFunctionReturn(PETSC_SUCCESS);
}
