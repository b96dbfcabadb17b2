/* A rigid body: its cells are not assembled, only its surface and motion count. */
#include "materialimpl.h"

const MaterialParameter MaterialRigidParameters[] = {{NULL, NULL, NULL, 0, 0}};

PetscErrorCode MaterialRigidSetUp(MaterialSpec *spec)
{
  PetscFunctionBegin;
  PetscCheckInput(spec->formulation != FORMULATION_MIXED, "material.%s.formulation: a rigid body has none", spec->name);
  spec->mu = spec->lambda = spec->kappa = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
