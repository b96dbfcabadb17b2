/* Equilibrium from a state that is far from it, by taking its imbalance away little by little. */
#include "solveimpl.h"

#define FIRST 0.25      /* share of the imbalance that the first solve takes away */
#define LEAST (1. / 64) /* a smaller one is given up */
#define GROWTH 2        /* after one that succeeded */

/* What several solves took, and how the last one ended. */
static void Gather_Private(const SolverReport *last, SolverReport *all)
{
  const SolverReport before = *all;

  *all = *last;
  all->iterations += before.iterations;
  all->factorisations += before.factorisations;
  all->single_failures += before.single_failures;
  all->set_changes += before.set_changes;
  all->set_cycles += before.set_cycles;
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) all->modifiers[i] += before.modifiers[i];
}

PetscErrorCode SolverSettle(Solver s, State *state, SolverReport *report)
{
  PetscReal    left = 1, piece = FIRST; /* shares of the imbalance */
  State        start;
  SolverReport one;
  PetscBool    usable;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  report->reason = "the state to settle has an inverted cell";
  PetscCall(StateCreate(s->problem, &start));
  PetscCall(StateCopy(state, &start));
  PetscCall(ProblemSetState(s->problem, state));
  PetscCall(ProblemNoteImbalance(s->problem, state->x, &usable));
  while (usable && left > 0 && piece >= LEAST && !report->stopped) {
    const PetscReal next = PetscMax(0, left - piece);
    PetscCall(ProblemLeaveImbalance(s->problem, next));
    PetscCall(SolverSolve(s, state, &one));
    Gather_Private(&one, report);
    PetscCall(PetscInfo(s->snes, "%g of the imbalance left: %s\n", (double)next, one.converged ? "found" : one.reason));
    if (one.converged) {
      left = next;
      piece *= GROWTH;
    } else
      piece *= 0.5;
    PetscCall(StateCopy(one.converged ? state : &start, one.converged ? &start : state));
  }
  PetscCall(ProblemLeaveImbalance(s->problem, 0));
  report->converged = (PetscBool)(left == 0);
  PetscCall(StateDestroy(&start));
  PetscFunctionReturn(PETSC_SUCCESS);
}
