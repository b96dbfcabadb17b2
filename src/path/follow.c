/* The one loop along which equilibria are found: attempt, accept, grow; or go back, recover, cut. What it follows is a PathMetric. */
#include "path.h"

#define EASY_ITERATIONS 6 /* a load step that took no more Newton iterations lets the next one grow */

PetscErrorCode PathPrescribe(Problem problem, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(ProblemSetTime(problem, t));
  PetscCall(ProblemJump(problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathRestore(Path *p, const State *from)
{
  PetscFunctionBegin;
  PetscCall(StateCopy(from, &p->level->state));
  PetscCall(PathPrescribe(p->level->problem, from->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void PathBegin(Path *p, PetscBool is_short)
{
  p->failures          = is_short;
  p->modifiers_in_step = p->iterations_in_step = p->cuts_in_step = 0;
  p->viscous_work                                                = 0;
}

void PathCount(Path *p, const SolverReport *report, PetscBool equilibrium)
{
  p->newton_iterations += report->iterations;
  p->iterations_in_step += report->iterations;
  p->set_changes += report->set_changes;
  p->set_cycles += report->set_cycles;
  p->factorisations += report->factorisations;
  p->single_failures += report->single_failures;
  p->descent_iterations += report->descent_iterations;
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) {
    p->modifiers[i] += report->modifiers[i];
    p->modifiers_in_step += report->modifiers[i];
  }
  if (report->stopped) p->stopped = PETSC_TRUE;
  if (!report->converged) return;
  p->status = report->status;
  if (equilibrium && report->unstable >= 0) ++p->judged;
  if (equilibrium && report->unstable > 0) ++p->unstable;
  if (equilibrium) p->unstable_now = (PetscBool)(report->unstable > 0);
}

PetscErrorCode PathFrom(const Path *p, PetscReal **from)
{
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(ProblemSpace(p->level->problem), &v));
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, from));
  PetscCall(ProblemLocalDisplacement(p->level->problem, p->level->state.x, *from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathRefuse(Path *p, const PetscReal from[], const char **reason)
{
  PetscFunctionBegin;
  *reason = NULL;
  for (PetscInt i = 0; i < PATH_REFUSALS && !*reason; ++i) {
    Refusal *r = &p->refusal[i];
    if (!r->ask || r->mode == RECOVERY_OFF) continue;
    PetscCall(r->ask(p->level->problem, from, &p->level->state, reason));
    if (*reason) ++r->num;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathFound(Path *p, const PathLoop *loop, const PetscReal from[], PetscReal to, SolverReport *report)
{
  const char *words;

  PetscFunctionBegin;
  if (!report->converged) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PathRefuse(p, from, &words));
  if (words) {
    report->converged = PETSC_FALSE;
    report->reason    = words;
  } else if (loop->metric->found)
    PetscCall(loop->metric->found(p, loop, to, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathAttempt(Path *p, const PathLoop *loop, PetscReal to, SolverReport *report)
{
  const MPI_Comm comm = ForestComm(p->level->forest);
  const char    *words;
  PetscReal     *from;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  PetscCall(PathFrom(p, &from));
  PetscCall(loop->metric->set(p, loop, to));
  PetscCall(ExpressionTrouble(comm, &words)); /* of prescribed motion and dead loads; the others are asked for on the way */
  if (!words) {
    PetscCall(SolverSolve(p->level->solver, &p->level->state, report));
    PathCount(p, report, (PetscBool)(loop->metric->load || to >= loop->stop));
    PetscCall(ExpressionTrouble(comm, &words));
  }
  if (words) {
    report->converged = PETSC_FALSE;
    report->reason    = words;
  }
  PetscCall(PathFound(p, loop, from, to, report));
  PetscCall(PetscFree(from));
  PetscCall(PetscInfo(NULL, "%s %g, %" PetscInt_FMT " iterations: %s\n", loop->metric->name, (double)to, report->iterations,
                      report->converged ? "found" : report->reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next piece after one to s = next that was found; at once: not after one that failed. */
static void Grow_Private(PathLoop *loop, PetscReal next, PetscBool at_once, const SolverReport *report)
{
  const PetscBool easy = (PetscBool)(!loop->metric->load || report->iterations <= EASY_ITERATIONS);

  loop->s = next;
  if (at_once && easy) loop->piece = PetscMin(loop->metric->growth * loop->piece, loop->most);
}

/* The next piece after one to s = next that was not. */
static void Cut_Private(Path *p, PathLoop *loop, PetscReal next)
{
  loop->piece = loop->metric->cut * PetscMin(next - loop->s, loop->most);
  if (!loop->metric->load) return;
  ++p->step_cuts;
  ++p->cuts_in_step;
}

PetscErrorCode PathFollow(Path *p, PathLoop *loop, SolverReport *report)
{
  Level    *l = p->level;
  State     start;
  PetscBool done = PETSC_FALSE, at_once = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(StateCreate(l->problem, &start));
  PetscCall(StateCopy(&l->state, &start));
  while (!done) {
    const PetscReal next = loop->metric->end(p, loop);
    PetscCall(PathAttempt(p, loop, next, report));
    if (report->converged) {
      Grow_Private(loop, next, at_once, report);
      at_once = PETSC_TRUE;
      done    = (PetscBool)(loop->step || loop->s >= loop->stop);
      if (!done && loop->metric->load) PetscCall(StateCommit(l->problem, &l->state)); /* the last piece stays open until the step is accepted */
      if (!done) PetscCall(StateCopy(&l->state, &start));
      continue;
    }
    PetscCall(PathRestore(p, &start));
    if (loop->step && !p->stopped) PetscCall(PathRecover(p, loop, next, NULL, report));
    if (report->converged) break;
    if (!p->stopped) Cut_Private(p, loop, next);
    at_once = PETSC_FALSE;
    done    = (PetscBool)(loop->piece < loop->least || p->stopped || --loop->attempts == 0);
  }
  PetscCall(StateDestroy(&start));
  PetscFunctionReturn(PETSC_SUCCESS);
}
