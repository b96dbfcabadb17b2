/* Modifier: tangents at fixed directions. Of pairs whose gaps are wide against their facets (src/interface/widegap.c); and of all, where no active set was
   found that agrees with the linear step (activeset.c) and its problem is not convex: pressure times the curvature of the gap (the geometric stiffness of
   contact) outweighs what holds the bodies there, a node that is closed then pulls and, open, overlaps. Without curvature of constraints the system is the one
   of a convex quadratic program, which has such a set (as sequential quadratic programming has its Hessian made convex). On: of all pairs at every iterate. */
#include "solveimpl.h"

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  if (always)
    s->form.frozen_normals = ALL_PAIRS;
  else
    PetscCall(InterfaceFindWide(ProblemInterface(s->problem), &s->form.frozen_normals));
  *acts = (PetscBool)(s->form.frozen_normals != 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  PetscFunctionBegin;
  if (!s->no_set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "no active set agrees with the linear step: once more at fixed directions\n"));
  s->form.frozen_normals = ALL_PAIRS;
  *acts = *again = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierFrozenNormals = {"frozen_normals",
                                        "tangents at fixed directions of contact where gaps are wide against facets or no active set agrees; on: always",
                                        .linearise = Linearise_Private, .correct = Correct_Private};
