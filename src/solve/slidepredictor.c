/* Modifier: where contact moves along a surface, by what supports prescribe or else by what the first linear step says,
   one that only carries the bodies to their new places takes its place: by the prescribed motion, without the pairs
   that move, and without the residual, so that loads on a body that nothing but such a pair holds wait for the next
   iteration (src/interface/slide.c). */
#include "solveimpl.h"

static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  PetscReal pending;

  PetscFunctionBegin;
  if (it->number > 0 || s->form.released) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemPending(s->problem, &pending));
  PetscCall(InterfaceFindSliding(ProblemInterface(s->problem), pending, s->swap, &s->form.released));
  *acts = *again = (PetscBool)(s->form.released != 0);
  if (*acts) PetscCall(VecZeroEntries(it->r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierSlidePredictor = {"slide_predictor", "contact that moves along a surface: bodies are carried to their new places first",
                                         .correct = Correct_Private};
