/* Modifier: a solve that goes wrong is recognised early; a shorter load step, or another start, costs less than waiting
   for the iteration limit. */
#include "solveimpl.h"

#define STALLED 7 /* iterations without a new least residual; more halvings of steps that left the domain */

static PetscErrorCode Begin_Private(Solver s)
{
  PetscFunctionBegin;
  s->best_norm = PETSC_MAX_REAL;
  s->best_iter = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Verdict_Private(Solver s, Iterate *it, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  if (it->number == 1) s->best_norm = it->norm; /* the first iterate carries the whole prescribed motion: progress counts from there */
  if (it->norm < s->best_norm) {
    s->best_norm = it->norm;
    s->best_iter = it->number;
  }
  *acts = (PetscBool)(it->number - s->best_iter >= STALLED || s->halvings > STALLED);
  if (!*acts) PetscFunctionReturn(PETSC_SUCCESS);
  it->trouble = "Newton stalls";
  it->reason  = SNES_DIVERGED_LINE_SEARCH;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierStall = {"stall", "a solve whose residual does not fall for seven iterations is given up at once", .begin = Begin_Private,
                                .verdict = Verdict_Private};
