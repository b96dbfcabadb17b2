/* Modifier: the active set of a linear step begins as the last one of this solve ended (src/interface/warmstart.c), where that agreed with its step. */
#include "solveimpl.h"

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  s->form.warm_start = s->settled;
  *acts              = (PetscBool)(s->settled && s->settled_set != it->set);
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierWarmStart = {"warm_start", "the active set of a linear step begins as that of the last one, not as the residual tells",
                                    .linearise = Linearise_Private};
