/* The nonlinear iteration as a SNES type: linearise, solve with the active set iterated against that linearisation,
   move, judge. Prescribed motion still to come enters the linear solve (docs/theory.md, solution). There is no merit
   function: a step is shortened when it would leave the domain (det F <= 0), and the rest of the prescribed motion then
   stays for the next iteration. Whatever else is done is a row of modifier.c. */
#include "solveimpl.h"
#include <petsc/private/snesimpl.h>

/* The tangent at an iterate in the form chosen, and the linear step. */
static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, Vec dx)
{
  PetscBool bad, settled;

  PetscFunctionBegin;
  ++s->report->iterations;
  PetscCall(VecZeroEntries(s->lift));
  PetscCall(ProblemSetForm(s->problem, &s->form));
  PetscCall(ProblemTangent(s->problem, it->x, s->pressure, s->lift, &bad));
  if (s->symmetric && !ProblemGetSymmetric(s->problem)) PetscCall(SolverUnsymmetric_Private(s));
  s->no_solution = bad;
  if (bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemRightSide(s->problem, it->r, s->lift, s->rhs));
  if (!s->form.pressures_first) {
    PetscCall(SolverActiveSetSolve_Private(s, PETSC_FALSE, dx, &settled));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolverPressuresFirst_Private(s, dx, &settled));
  if (!settled && !s->report->stopped) PetscCall(Linearise_Private(s, it, dx)); /* anew: the tangent begins with the states that the residual tells */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step from an iterate, as modifiers choose and correct it. */
static PetscErrorCode Direction_Private(Solver s, const Iterate *it, Vec dx)
{
  PetscBool again = PETSC_TRUE;

  PetscFunctionBegin;
  if (s->test) PetscCall(SolverTest_Private(s, it->x));
  PetscCall(ModifiersLinearise_Private(s, it));
  while (again) {
    again = PETSC_FALSE;
    PetscCall(Linearise_Private(s, it, dx));
    if (!s->no_solution) PetscCall(ModifiersCorrect_Private(s, it, dx, &again));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x += step dx with the longest step 1, 1/2, … that stays in the domain, or a shorter one; residual there. */
static PetscErrorCode Move_Private(Solver s, const Iterate *it, Vec dx)
{
  PetscReal step = 1, pending;

  PetscFunctionBegin;
  PetscCall(ProblemPending(s->problem, &pending));
  PetscCall(ProblemStepBegin(s->problem, it->x, dx));
  for (PetscInt cut = 0; cut <= s->cuts; ++cut, step *= 0.5) {
    PetscCall(ProblemStepMove(s->problem, dx, step, PETSC_FALSE, it->x));
    PetscCall(SNESComputeFunction(s->snes, it->x, it->r));
    if (!s->report->status.bad) break;
    ++s->course.halvings;
    PetscCall(PetscInfo(s->snes, "step %g leaves the domain\n", (double)step));
  }
  if (!s->report->status.bad) PetscCall(ModifiersMoved_Private(s, it, dx, step));
  if (!s->report->status.bad && pending == 0) PetscCall(ModifiersShorten_Private(s, it, dx, &step));
  s->step = step;
  if (!s->report->status.bad) PetscCall(ProblemStepAccept(s->problem, step, s->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Finish_Private(Solver s, SNESConvergedReason reason, const char *words)
{
  s->snes->reason      = reason;
  s->report->converged = (PetscBool)(reason > 0);
  s->report->unstable  = s->negative;
  s->report->reason    = words;
}

/* Norm and active set of an iterate whose residual is there. */
PetscErrorCode SolverLook_Private(Solver s, Iterate *it)
{
  PetscFunctionBegin;
  PetscCall(VecNorm(it->r, NORM_2, &it->norm));
  PetscCall(InterfaceActiveSetHash(ProblemInterface(s->problem), &it->set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the iteration over at this iterate? Then snes->reason is set. */
static PetscErrorCode Judge_Private(Solver s, Iterate *it)
{
  SNES                snes = s->snes;
  SNESConvergedReason reason;

  PetscFunctionBegin;
  PetscCall(SolverConverged_Private(s, it, &reason));
  if (reason > 0)
    Finish_Private(s, reason, "");
  else if (reason < 0)
    Finish_Private(s, reason, "forces are too large or too small for their squares to be numbers: take other units");
  else if (it->trouble)
    Finish_Private(s, it->reason, SolverWords_Private(s, it->norm, it->trouble));
  else if (it->number == snes->max_its)
    Finish_Private(s, SNES_DIVERGED_MAX_IT, SolverWords_Private(s, it->norm, "Newton did not converge within -snes_max_it iterations"));
  else if (snes->max_funcs >= 0 && snes->nfuncs >= snes->max_funcs)
    Finish_Private(s, SNES_DIVERGED_FUNCTION_COUNT, "Newton did not converge within -snes_max_funcs residuals");
  else if (PetscIsInfOrNanReal(it->norm))
    Finish_Private(s, SNES_DIVERGED_FNORM_NAN, "the Newton residual is no number");
  else {
    PetscCall(StopAsked(PetscObjectComm((PetscObject)snes), &s->report->stopped));
    if (s->report->stopped) Finish_Private(s, SNES_DIVERGED_MAX_IT, "the run was asked to stop");
  }
  if (snes->reason < 0) PetscCall(ProblemFindWorst(s->problem, it->r, &s->report->worst));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Iterate_Private(Solver s, const Iterate *it, Vec dx)
{
  PetscFunctionBegin;
  PetscCall(Direction_Private(s, it, dx));
  if (!s->no_solution && it->number == 0 && !s->form.released) PetscCall(StateNoteWay(s->problem, it->x, dx, s->state));
  if (!s->no_solution) PetscCall(Move_Private(s, it, dx));
  if (s->no_solution)
    Finish_Private(s, SNES_DIVERGED_LINEAR_SOLVE, s->no_memory ? "out of memory for a factor of the tangent" : "the tangent is singular");
  else if (s->report->status.bad) {
    PetscCall(ProblemFindInvertedAt(s->problem, it->x, &s->report->worst));
    Finish_Private(s, SNES_DIVERGED_FUNCTION_DOMAIN, "every step along the Newton direction inverts a cell");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESSolve_ContactNewton(SNES snes)
{
  Solver  s  = NULL;
  Iterate it = {.x = snes->vec_sol, .r = snes->vec_func};

  PetscFunctionBegin;
  PetscCall(SNESGetApplicationContext(snes, &s));
  snes->reason   = SNES_CONVERGED_ITERATING;
  s->course      = (Course){.best_norm = PETSC_MAX_REAL};
  s->negative    = -1;
  s->settled     = 0;
  s->no_solution = PETSC_FALSE;
  PetscCall(ProblemSearch(s->problem, it.x));
  PetscCall(SNESComputeFunction(snes, it.x, it.r));
  if (s->report->status.bad) Finish_Private(s, SNES_DIVERGED_FUNCTION_DOMAIN, "the start of the step has an inverted cell");
  while (snes->reason == SNES_CONVERGED_ITERATING) {
    snes->iter = it.number;
    PetscCall(SolverLook_Private(s, &it));
    PetscCall(ModifiersVerdict_Private(s, &it));
    if (it.number == 1) s->course.first_norm = it.norm; /* the first iterate carries the whole prescribed motion */
    snes->norm          = it.norm;
    s->report->residual = it.norm;
    s->report->scale    = s->report->status.scale;
    PetscCall(SNESMonitor(snes, snes->iter, it.norm));
    PetscCall(Judge_Private(s, &it));
    if (snes->reason != SNES_CONVERGED_ITERATING) break;
    PetscCall(Iterate_Private(s, &it, snes->vec_sol_update));
    ++it.number;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SNESCreate_ContactNewton(SNES snes)
{
  PetscFunctionBegin;
  snes->ops->solve                  = SNESSolve_ContactNewton;
  snes->usesksp                     = PETSC_TRUE;
  snes->usesnpc                     = PETSC_FALSE;
  snes->alwayscomputesfinalresidual = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
