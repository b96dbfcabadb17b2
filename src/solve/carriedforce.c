/* Modifier: what a node takes on where its facets are covered in part goes along as a force. The linear step tells a
   pressure for the weight that the node has; where its cover grows on the way, as when an edge of the mortar side moves
   on to a facet of which it covers a sliver, that pressure over the new weight would be a force of a thousand times what
   balances the step (src/interface/carryforce.c). */
#include "solveimpl.h"

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  InterfaceKeepWeights(ProblemInterface(s->problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Moved_Private(Solver s, Vec dx, PetscBool *acts)
{
  PetscFunctionBegin;
  PetscCall(InterfaceCarryForces(ProblemInterface(s->problem), dx, acts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierCarriedForce = {"carried_force", "where the cover of facets grows in a step, nodes take on the force that it tells, not its pressure",
                                       .linearise = Linearise_Private, .moved = Moved_Private};
