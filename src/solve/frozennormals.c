/* Modifier: tangents at fixed directions. Of pairs whose gaps are wide against their facets (src/interface/widegap.c); and of all, where the active sets of two
   linear steps in a row went in circles: pressure times the curvature of the gap (the geometric stiffness of contact) outweighs what holds the bodies there, a
   node that is closed then pulls and, open, overlaps, and no set agrees with the linear step. Without curvature of constraints the system is the one of a
   convex quadratic program, which has such a set (as sequential quadratic programming has its Hessian made convex); on: of all pairs at every iterate. */
#include "solveimpl.h"

#define ALL_PAIRS (~(uint64_t)0)

static PetscErrorCode Begin_Private(Solver s)
{
  PetscFunctionBegin;
  s->circled = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

/* One step in a circle is no reason: the next tangent often has a set that agrees, and at fixed directions convergence is linear. */
static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  const PetscBool before = s->circled;

  PetscFunctionBegin;
  if (s->form.frozen_normals == ALL_PAIRS) PetscFunctionReturn(PETSC_SUCCESS);
  s->circled = (PetscBool)!s->settled;
  if (!before || s->settled) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "no active set agrees with the linear step, as with the last one: once more at fixed directions\n"));
  s->form.frozen_normals = ALL_PAIRS;
  *acts = *again = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierFrozenNormals = {"frozen_normals",
                                        "tangents at fixed directions of contact where gaps are wide against facets or active sets go in circles; on: always",
                                        .begin = Begin_Private, .linearise = Linearise_Private, .correct = Correct_Private};
