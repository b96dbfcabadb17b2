/* The table of modifiers: what Newton's iteration does besides linearising, solving, moving and judging. Each row has
   its file, its switch -newton_<name> and its counter; docs/ablation.md says what each is needed for. Rows act in this
   order: who corrects a linear step sees what the rows above have made of it. */
#include "solveimpl.h"

static const Modifier *const Modifiers[] = {&ModifierFrozenSegmentation, &ModifierStall,      &ModifierProximalShift, &ModifierFrozenNormals,
                                            &ModifierWarmStart,          &ModifierFirstTouch, &ModifierYieldEdge,     &ModifierSlidePredictor,
                                            &ModifierCarriedForce,       &ModifierLineSearch, &ModifierSecantFlow};
#define NUM ((PetscInt)PETSC_STATIC_ARRAY_LENGTH(Modifiers))
_Static_assert(PETSC_STATIC_ARRAY_LENGTH(Modifiers) <= SOLVER_MOST_MODIFIERS, "SolverReport has no room for all modifiers");

PetscInt SolverNumModifiers(void)
{
  return NUM;
}

const char *SolverModifierName(PetscInt i)
{
  return Modifiers[i]->name;
}

const Modifier *SolverModifier_Private(PetscInt i)
{
  return Modifiers[i];
}

PetscErrorCode ModifiersLinearise_Private(Solver s, const Iterate *it)
{
  const Form last = s->form;

  PetscFunctionBegin;
  s->form           = FormPlain(last.frozen_segmentation);
  s->form.symmetric = s->symmetric;
  for (PetscInt i = 0; i < NUM; ++i) {
    PetscBool acts = PETSC_FALSE;
    if (s->mode[i] == MODIFIER_OFF || !Modifiers[i]->linearise) continue;
    PetscCall(Modifiers[i]->linearise(s, it, &last, s->mode[i] == MODIFIER_ON, &acts));
    if (acts) ++s->report->modifiers[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModifiersCorrect_Private(Solver s, const Iterate *it, Vec dx, PetscBool *again)
{
  PetscFunctionBegin;
  *again = PETSC_FALSE;
  for (PetscInt i = 0; i < NUM && !*again && !s->no_solution; ++i) {
    PetscBool acts = PETSC_FALSE;
    if (s->mode[i] == MODIFIER_OFF || !Modifiers[i]->correct) continue;
    PetscCall(Modifiers[i]->correct(s, it, dx, &acts, again));
    if (acts) ++s->report->modifiers[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModifiersMoved_Private(Solver s, const Iterate *it, Vec dx, PetscReal step)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < NUM && !s->report->status.bad; ++i) {
    PetscBool acts = PETSC_FALSE;
    if (s->mode[i] == MODIFIER_OFF || !Modifiers[i]->moved) continue;
    PetscCall(Modifiers[i]->moved(s, dx, &acts));
    if (!acts) continue;
    ++s->report->modifiers[i];
    PetscCall(ProblemStepMove(s->problem, dx, step, PETSC_FALSE, it->x));
    PetscCall(SNESComputeFunction(s->snes, it->x, it->r));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModifiersShorten_Private(Solver s, const Iterate *it, Vec dx, PetscReal *step)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < NUM && !s->report->status.bad; ++i) {
    PetscBool acts = PETSC_FALSE;
    if (s->mode[i] == MODIFIER_OFF || !Modifiers[i]->shorten) continue;
    PetscCall(Modifiers[i]->shorten(s, it, dx, step, &acts));
    if (acts) ++s->report->modifiers[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModifiersVerdict_Private(Solver s, Iterate *it)
{
  PetscFunctionBegin;
  it->trouble = NULL;
  for (PetscInt i = 0; i < NUM && !it->trouble; ++i) {
    PetscBool acts = PETSC_FALSE;
    if (s->mode[i] == MODIFIER_OFF || !Modifiers[i]->verdict) continue;
    PetscCall(Modifiers[i]->verdict(s, it, s->mode[i] == MODIFIER_ON, &acts));
    if (acts) ++s->report->modifiers[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
