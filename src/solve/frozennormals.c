/* Modifier: tangents at fixed directions of pairs whose gaps are wide against their facets (src/interface/widegap.c); on:
   of all pairs. */
#include "solveimpl.h"

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  if (always)
    s->form.frozen_normals = ~(uint64_t)0;
  else
    PetscCall(InterfaceFindWide(ProblemInterface(s->problem), &s->form.frozen_normals));
  *acts = (PetscBool)(s->form.frozen_normals != 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierFrozenNormals = {"frozen_normals", "tangents at fixed directions of contact where gaps are wide against facets; on: always",
                                        .linearise = Linearise_Private};
