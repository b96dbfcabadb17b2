/* Modifier: a solve that goes wrong is recognised early; a shorter load step, or another start, costs less than waiting
   for the iteration limit. */
#include "solveimpl.h"

#define STALLED 7 /* iterations without a new least residual; more halvings of steps that left the domain */

static PetscErrorCode Verdict_Private(Solver s, Iterate *it, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  if (it->number == 1) s->course.best_norm = it->norm; /* the first iterate carries the whole prescribed motion: progress counts from there */
  if (it->norm < s->course.best_norm) {
    s->course.best_norm = it->norm;
    s->course.best_iter = it->number;
  }
  *acts = (PetscBool)(it->number - s->course.best_iter >= STALLED || s->course.halvings > STALLED);
  if (!*acts) PetscFunctionReturn(PETSC_SUCCESS);
  it->trouble = "Newton stalls";
  it->reason  = SNES_DIVERGED_LINE_SEARCH;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierStall = {"stall", "a solve whose residual does not fall for seven iterations is given up at once", .verdict = Verdict_Private};
