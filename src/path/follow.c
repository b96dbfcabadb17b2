/* The one loop along which equilibria are found: attempt, accept, grow; or go back, recover, cut. What it follows is a PathMetric. */
#include "path.h"

#define MOST_ROLL 0.2     /* radians by which bodies may roll on each other in a load step: the way is wrong by 0.7 to 1.3 % then */
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

PetscErrorCode PathRefresh(Path *p)
{
  Level *l = p->level;

  PetscFunctionBegin;
  PetscCall(ProblemSetState(l->problem, &l->state));
  PetscCall(ProblemSearch(l->problem, l->state.x));
  PetscCall(ProblemRefresh(l->problem, l->state.x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathReturn(Path *p, const State *found, const ProblemStatus *status)
{
  PetscFunctionBegin;
  PetscCall(StateCopy(found, &p->level->state));
  PetscCall(PathRefresh(p));
  p->status = *status;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool PathPressed(const Path *p, PetscInt pair)
{
  for (PetscInt i = 0; i < p->data->num_contacts; ++i)
    if (p->data->contacts[i].pair == pair && FormHas(p->pressed, i)) return PETSC_TRUE;
  return PETSC_FALSE;
}

void PathBegin(Path *p, PetscBool is_short)
{
  p->failures          = is_short;
  p->modifiers_in_step = p->iterations_in_step = p->cuts_in_step = 0;
  p->work                                                        = (StepWork){0};
}

void PathCount(Path *p, const SolverReport *report, PetscBool equilibrium)
{
  p->newton_iterations += report->iterations;
  p->iterations_in_step += report->iterations;
  p->set_changes += report->set_changes;
  p->single_switches += report->single_switches;
  p->set_cycles += report->set_cycles;
  p->factorisations += report->factorisations;
  p->single_failures += report->single_failures;
  p->descent_iterations += report->descent_iterations;
  p->pressed |= report->pressed;
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) {
    p->modifiers[i] += report->modifiers[i];
    p->modifiers_in_step += report->modifiers[i];
  }
  if (report->stopped) p->stopped = PETSC_TRUE;
  if (!report->converged) return;
  p->status = report->status;
  if (equilibrium && report->unstable >= 0) ++p->judged;
  if (equilibrium) p->unstable_now = PetscMax(report->unstable, 0);
}

PetscErrorCode PathFrom(const Path *p, PetscReal **from)
{
  const HPTables *v = HPSpaceGetTables(ProblemSpace(p->level->problem));

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, from));
  PetscCall(ProblemLocalDisplacement(p->level->problem, p->level->state.x, *from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathRefuse(Path *p, const PetscReal from[], const SolverReport *report, const char **reason)
{
  PetscFunctionBegin;
  *reason = NULL;
  for (PetscInt i = 0; i < PATH_REFUSALS && !*reason; ++i) {
    Refusal *r = &p->refusal[i];
    if (!r->ask || r->mode == RECOVERY_OFF) continue;
    PetscCall(r->ask(p->level->problem, from, &p->level->state, report->status.scale, reason));
    if (*reason) ++r->num;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathFound(Path *p, const PathLoop *loop, const PetscReal from[], PetscReal to, SolverReport *report)
{
  const char *words;

  PetscFunctionBegin;
  if (!report->converged) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PathRefuse(p, from, report, &words));
  if (words) {
    report->converged = PETSC_FALSE;
    report->reason    = words;
  } else if (loop->metric->found)
    PetscCall(loop->metric->found(p, loop, to, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A solution that was found with a frozen segmentation. In space lines that lie on sides stay there, and so does that form. In the plane ends go over a side
   and on: where Newton's method easily finds the solution without from there, it is taken. */
static PetscErrorCode Unfreeze_Private(Path *p, const PathLoop *loop, SolverReport *report)
{
  Level         *l     = p->level;
  RecoveryCount *count = &p->recovery[PATH_UNFREEZE];
  State          found;
  SolverReport   plain;

  PetscFunctionBegin;
  if (!report->converged || !loop->metric->load || !l->state.form.frozen_segmentation || count->mode == RECOVERY_OFF) PetscFunctionReturn(PETSC_SUCCESS);
  if (HPSpaceGetTables(ProblemSpace(l->problem))->dim == 3) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StateCreate(l->problem, &found));
  PetscCall(StateCopy(&l->state, &found));
  PetscCall(SolverUnfreeze(l->solver, &l->state, &plain));
  PathCount(p, &plain, PETSC_FALSE);
  const PetscBool easy = (PetscBool)(plain.converged && plain.iterations <= EASY_ITERATIONS);
  ++count->tried;
  count->succeeded += easy;
  if (easy) {
    p->unstable_now = PetscMax(plain.unstable, 0);
    plain.iterations += report->iterations;
    *report = plain;
  } else
    PetscCall(PathReturn(p, &found, &report->status));
  PetscCall(StateDestroy(&found));
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
    PetscCall(Unfreeze_Private(p, loop, report));
    PetscCall(ExpressionTrouble(comm, &words));
  }
  if (words) {
    report->converged = PETSC_FALSE;
    report->undefined = PETSC_TRUE;
    report->reason    = words;
  }
  PetscCall(PathFound(p, loop, from, to, report));
  PetscCall(PetscFree(from));
  PetscCall(PetscInfo(NULL, "%s %g, %" PetscInt_FMT " iterations: %s\n", loop->metric->name, (double)to, report->iterations,
                      report->converged ? "found" : report->reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next piece after one to s = next that was found; at once: not after one that failed. rolled: what bodies rolled on each other in it. */
static void Grow_Private(PathLoop *loop, PetscReal next, PetscBool at_once, PetscReal rolled, const SolverReport *report)
{
  const PetscBool easy   = (PetscBool)(!loop->metric->load || report->iterations <= EASY_ITERATIONS);
  const PetscReal growth = rolled * loop->metric->growth > MOST_ROLL ? 1 : loop->metric->growth;

  loop->s = next;
  if (at_once && easy) loop->piece = PetscMin(growth * loop->piece, loop->most);
}

/* Is it asked how far bodies rolled in a piece? */
static PetscBool MayRoll_Private(const Path *p, const PathLoop *loop)
{
  return (PetscBool)(loop->metric == &PathTime && p->refusal[PATH_ROLLING].mode != RECOVERY_OFF && InterfaceSlips(ProblemInterface(p->level->problem)));
}

/* Is a piece to s = next to be made again, for bodies rolled too far on each other in it? Then as much shorter as it takes, but not where that is too short.
   The step is no harder for it: it is not one that failed. */
static PetscBool IsTooLong_Private(Path *p, PathLoop *loop, PetscReal next, PetscReal rolled)
{
  PetscReal piece = next - loop->s;

  for (PetscReal left = rolled; left > MOST_ROLL; left *= loop->metric->cut) piece *= loop->metric->cut;
  if (!(rolled > MOST_ROLL) || piece < loop->least) return PETSC_FALSE;
  loop->piece = piece;
  ++p->refusal[PATH_ROLLING].num;
  ++p->step_cuts;
  ++p->cuts_in_step;
  return PETSC_TRUE;
}

/* The next piece after one to s = next that was not. */
static void Cut_Private(Path *p, PathLoop *loop, PetscReal next)
{
  loop->piece = loop->metric->cut * PetscMin(next - loop->s, loop->most);
  if (!loop->metric->load) return;
  ++p->step_cuts;
  ++p->cuts_in_step;
}

/* One piece, to s = next: an attempt, and recoveries where that fails; rolled: by how much bodies rolled on each other in it. To an equilibrium farther off
   they roll however short the piece is. */
static PetscErrorCode Piece_Private(Path *p, const PathLoop *loop, PetscReal next, const State *start, PetscReal *rolled, PetscBool *recovered,
                                    SolverReport *report)
{
  const PetscInt far  = PathNumFar(p);
  PetscReal     *from = NULL;

  PetscFunctionBegin;
  *recovered = PETSC_FALSE;
  *rolled    = 0;
  if (MayRoll_Private(p, loop)) PetscCall(PathFrom(p, &from));
  PetscCall(PathAttempt(p, loop, next, report));
  if (!report->converged) {
    PetscCall(PathRestore(p, start));
    if (loop->step && !p->stopped) PetscCall(PathRecover(p, loop, next, NULL, report));
    *recovered = report->converged;
  }
  if (report->converged && from && PathNumFar(p) == far) PetscCall(ProblemRolls(p->level->problem, from, p->level->state.x, rolled));
  PetscCall(PetscFree(from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A piece of the step is history: slip begins anew. */
static PetscErrorCode Commit_Private(Path *p)
{
  FrictionFigures f;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->data->num_contacts; ++i) {
    PetscCall(InterfaceFriction(ProblemInterface(p->level->problem), i, &f));
    p->work.friction[p->data->contacts[i].pair] += f.dissipation;
  }
  PetscCall(StateCommit(p->level->problem, &p->level->state));
  PetscFunctionReturn(PETSC_SUCCESS);
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
    const StepWork  work = p->work;
    PetscReal       rolled;
    PetscBool       recovered;
    PetscCall(Piece_Private(p, loop, next, &start, &rolled, &recovered, report));
    if (IsTooLong_Private(p, loop, next, rolled)) {
      p->work = work;
      PetscCall(PathRestore(p, &start));
      continue;
    }
    if (recovered) break;
    if (report->converged) {
      Grow_Private(loop, next, at_once, rolled, report);
      at_once = PETSC_TRUE;
      done    = (PetscBool)(loop->step || loop->s >= loop->stop);
      if (!done && loop->metric->load) PetscCall(Commit_Private(p)); /* the last piece stays open until the step is accepted */
      if (!done) PetscCall(StateCopy(&l->state, &start));
      continue;
    }
    if (!p->stopped) Cut_Private(p, loop, next);
    at_once = PETSC_FALSE;
    done    = (PetscBool)(loop->piece < loop->least || p->stopped || --loop->attempts == 0);
  }
  PetscCall(StateDestroy(&start));
  PetscFunctionReturn(PETSC_SUCCESS);
}
