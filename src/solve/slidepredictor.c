/* Modifier: where contact moves along a surface, by what supports prescribe or else by what the first linear step says,
   one that only carries the bodies to their new places takes its place: by the prescribed motion, without the pairs
   that move, and without the residual, so that loads on a body that nothing but such a pair holds wait for the next
   iteration (src/interface/slide.c). Contact may also move because a body rolls or bends while it is pressed: without
   the pair the whole motion would then go into the other body. Such pairs stay. */
#include "solveimpl.h"

static PetscErrorCode Begin_Private(Solver s)
{
  PetscFunctionBegin;
  s->carried = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step that carries bodies is there: pairs that it presses stay. */
static PetscErrorCode Judge_Private(Solver s, const Iterate *it, Vec dx, PetscBool *again)
{
  const uint64_t released = s->form.released;

  PetscFunctionBegin;
  s->carried = PETSC_TRUE;
  PetscCall(ProblemFindCarried(s->problem, dx, &s->form.released));
  *again = (PetscBool)(s->form.released != released);
  if (!s->form.released) PetscCall(SNESComputeFunction(s->snes, it->x, it->r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  PetscReal pending;

  PetscFunctionBegin;
  if (it->number > 0 || s->carried) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->form.released) {
    PetscCall(Judge_Private(s, it, dx, again));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ProblemPending(s->problem, &pending));
  PetscCall(InterfaceFindSliding(ProblemInterface(s->problem), pending, s->settled, s->swap, &s->form.released));
  *acts = *again = (PetscBool)(s->form.released != 0);
  if (*acts) PetscCall(VecZeroEntries(it->r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierSlidePredictor = {"slide_predictor", "contact that moves along a surface: bodies are carried to their new places first",
                                         .begin = Begin_Private, .correct = Correct_Private};
