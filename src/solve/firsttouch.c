/* Modifier: the active set of a pair that has borne nothing yet begins with the nodes that overlap the most
   (src/interface/firsttouch.c), and with friction it is found before states of stick and slip. */
#include "solveimpl.h"

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  PetscCall(InterfaceFindUntouched(ProblemInterface(s->problem), &s->form.untouched));
  s->form.pressures_first = (PetscBool)(s->form.untouched && InterfaceSlips(ProblemInterface(s->problem)));
  *acts                   = (PetscBool)(s->form.untouched != 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierFirstTouch = {"first_touch", "at first touch the active set begins with the nodes that overlap the most",
                                     .linearise = Linearise_Private};
