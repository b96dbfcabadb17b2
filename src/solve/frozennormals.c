/* Modifier: tangents at fixed directions. Of pairs whose gaps are wide against their facets (src/interface/widegap.c); and of all, where no active set was
   found that agrees with the linear step (activeset.c) and its problem is not convex: pressure times the curvature of the gap (the geometric stiffness of
   contact) outweighs what holds the bodies there, a node that is closed then pulls and, open, overlaps. Without curvature of constraints the system is the one
   of a convex quadratic program, which has such a set (as sequential quadratic programming has its Hessian made convex). So, too, where sets of two linear
   steps in a row go in the same circle. Sets also go in circles where gap and pressure vanish together; they do so at fixed directions, too, which are not
   tried again in that solve then. On: of all pairs at every iterate. */
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

/* One step in a circle is no reason: the next tangent often has a set that agrees, and at fixed directions convergence is linear. */
static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  const PetscBool same = (PetscBool)(s->circle && s->circle == s->course.last_circle), bent = s->bent;

  PetscFunctionBegin;
  if (s->form.frozen_normals == ALL_PAIRS) {
    s->course.fixed_circle = (PetscBool)(s->circle != 0);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  s->course.last_circle = s->circle;
  if ((!same && !bent) || s->course.fixed_circle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "no active set agrees with the linear step: once more at fixed directions\n"));
  s->form.frozen_normals = ALL_PAIRS;
  *acts = *again = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierFrozenNormals = {"frozen_normals",
                                        "tangents at fixed directions of contact where gaps are wide against facets or no active set agrees; on: always",
                                        .linearise = Linearise_Private, .correct = Correct_Private};
