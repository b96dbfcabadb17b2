/* Adaptation at one time: estimate, refine, find equilibrium again; until the tolerance or a limit is met. */
#include "appimpl.h"

PetscErrorCode AppEstimate(App *app)
{
  PetscFunctionBegin;
  if (app->estimated) PetscCall(EstimateDestroy(&app->estimate));
  PetscCall(StageBegin(STAGE_ESTIMATE));
  PetscCall(EstimateCompute(app->level.problem, &app->level.state, &app->estimate));
  PetscCall(StageEnd(STAGE_ESTIMATE));
  app->estimated = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fields, tables and screen of the state just computed. */
static PetscErrorCode ReportPass_Private(App *app, PetscInt iterations, PetscBool accepted)
{
  Level         *l         = &app->level;
  Balance        before    = app->balance;
  PetscReal      change[3] = {0, 0, 0};
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCall(BalanceCompute(l->problem, &l->state, &app->balance));
  for (PetscInt i = 0; i < app->balance.num_contacts; ++i)
    if (!app->touched[i] && (app->balance.pair[i].active_nodes > 0 || (AppOverlaps(app) && app->estimate.overlap.pair == i)))
      app->touched[i] = app->load_steps + 1;
  if (before.body && app->passes_in_step > 0) BalanceChange(&before, &app->balance, change);
  if (before.body) PetscCall(BalanceDestroy(&before));
  PetscCall(PetscMemzero(&app->last, sizeof(app->last)));
  PetscCall(ReportRowFill(l->problem, &l->state, AppIsStressed(app) ? &app->estimate : NULL, &app->balance, &app->last));
  PetscCall(PetscTime(&now));
  if (app->load_steps > 0 && app->passes_in_step == 0) app->later_solutions += now - app->accepted_at;
  app->last.step              = app->load_steps + 1;
  app->last.pass              = app->repeats + app->passes_in_step;
  app->last.newton_iterations = iterations;
  app->last.step_cuts         = app->path.cuts_in_step;
  app->last.set_cycles        = app->path.set_cycles - app->told_cycles;
  app->told_cycles            = app->path.set_cycles;
  app->last.seconds           = now - app->start;
  app->last.force_change      = change[0];
  app->last.work_change       = change[1];
  app->last.strain_change     = change[2];
  app->last.accepted          = accepted;
  app->last.dt                = l->state.t - l->accepted.t;
  PetscCall(OutputHold(app->comm));
  PetscCall(HistoryPass(app->history, &app->last));
  PetscCall(MonitorRow(app->monitor, &app->last));
  if (!app->data->output.fields) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_OUTPUT));
  const PetscReal      time   = app->data->load.control == LOAD_TIME ? l->state.t : app->data->load.end * (app->load_steps + 1); /* on a path t may fall */
  const PetscErrorCode status = OutputWriteState(app->writer, l->problem, &l->state, app->estimated ? &app->estimate : NULL, time, app->load_steps + 1,
                                                 app->repeats + app->passes_in_step);
  if (status) WriterAbandon(app->writer);
  PetscCall(status);
  PetscCall(StageEnd(STAGE_OUTPUT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the state carried over to a finer mesh turn cells inside out? */
static PetscErrorCode IsFolded_Private(Problem problem, const State *carried, PetscBool *yes)
{
  int8_t *folded;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(carried->num_leaves, &folded));
  PetscCall(ProblemFindFolded(problem, carried->x, folded));
  *yes = PETSC_FALSE;
  for (PetscInt l = 0; l < carried->num_leaves; ++l) *yes = (PetscBool)(*yes || folded[l]);
  PetscCall(PetscFree(folded));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equilibrium on the new mesh at the same load (along a path: on the plane across it through the state carried over). *folded: there is none, and cells where
   it was carried over are folded. */
static PetscErrorCode Reequilibrate_Private(App *app, PetscInt *iterations, PetscBool *ok, PetscBool *folded)
{
  Level          *l      = &app->level;
  const PetscInt  before = app->path.newton_iterations;
  PathLoop        load   = {.metric = &PathTime, .origin = l->accepted.t, .stop = l->state.t};
  State           carried;
  SolverReport    report;
  const PetscBool following = ProblemIsFollowing(l->problem);

  PetscFunctionBegin;
  if (following) {
    load = (PathLoop){.metric = &PathArc};
    PetscCall(ProblemDistance(l->problem, l->accepted.x, l->state.x, &load.origin));
    load.origin = -load.origin;
  }
  PetscCall(StateCreate(l->problem, &carried));
  PetscCall(StateCopy(&l->state, &carried));
  PetscCall(PathAttempt(&app->path, &load, load.stop, &report));
  if (!report.converged && !app->path.stopped) PetscCall(PathRecover(&app->path, &load, load.stop, &carried, &report));
  *ok     = report.converged;
  *folded = PETSC_FALSE;
  if (!*ok) PetscCall(IsFolded_Private(l->problem, &carried, folded));
  PetscCall(StateDestroy(&carried));
  *iterations += app->path.newton_iterations - before;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refine in this way and find equilibrium again; where there is none, the solution on the mesh at hand stands. *more: a finer mesh was reached; *gave_up: it
   was not, and no limit is the reason; *folded: nor where the state carried over was folded. */
static PetscErrorCode RefineOnce_Private(App *app, RefineMode mode, MarkList *layers, PetscInt *iterations, PetscBool *more, PetscBool *gave_up,
                                         PetscBool *folded)
{
  Level               old      = app->level;
  const ProblemStatus status   = app->path.status;
  const PetscInt      unstable = app->path.unstable_now;

  PetscFunctionBegin;
  *folded = PETSC_FALSE;
  PetscCall(AppRefine(app, &app->estimate, layers, mode, more, gave_up));
  if (!*more) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Reequilibrate_Private(app, iterations, more, folded));
  if (*more) {
    PetscCall(LevelDestroy(&old));
    ++app->passes_in_step;
    ++app->adapt_passes;
    app->flowed_coarse += app->flowed;
  } else {
    PetscCall(LevelDestroy(&app->level));
    app->level             = old;
    app->path.status       = status; /* of a solution that was refused, else */
    app->path.unstable_now = unstable;
    app->adapt_stop        = NONE_FINER;
    *gave_up               = PETSC_TRUE;
    PetscCall(PathPrescribe(old.problem, old.state.t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A finer mesh. When there is no equilibrium to be found on it (material that collapses at a singular corner, say), one that leaves the cells in which the
   solution is folded as they are; when there is none on that either, adaptation ends. */
static PetscErrorCode Pass_Private(App *app, MarkList *layers, PetscInt *iterations, PetscBool *more, PetscBool *gave_up)
{
  RecoveryCount *unfolded = &app->path.recovery[PATH_UNFOLDED];
  MarkList       none     = {0};
  PetscBool      folded;

  PetscFunctionBegin;
  *iterations = 0;
  PetscCall(RefineOnce_Private(app, REFINE_ALL, layers, iterations, more, gave_up, &folded));
  if (!folded || app->path.stopped || unfolded->mode == RECOVERY_OFF) PetscFunctionReturn(PETSC_SUCCESS);
  ++unfolded->tried;
  PetscCall(RefineOnce_Private(app, REFINE_UNFOLDED, &none, iterations, more, gave_up, &folded));
  unfolded->succeeded += *more;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why nothing more is to be done, "" when there may be. */
static const char *Stop_Private(const App *app)
{
  const AdaptSpec *spec = &app->data->adapt;

  if (spec->tolerance > 0 && app->estimate.relative <= spec->tolerance) return WITHIN_TOLERANCE;
  if (!AppIsStressed(app)) return UNSTRESSED;
  return app->passes_in_step >= spec->max_passes ? "max_passes" : "";
}

PetscErrorCode AppAdapt(App *app)
{
  PetscInt        iterations = app->path.iterations_in_step;
  const PetscBool here       = (PetscBool)(AppIsAdaptive(app) && app->data->adapt.repeat == REPEAT_STEP);
  PetscBool       more = PETSC_TRUE, gave_up = PETSC_FALSE, judged = PETSC_FALSE;

  PetscFunctionBegin;
  while (more) {
    MarkList layers = {0};
    PetscCall(AppEstimate(app));
    app->adapt_stop = here ? Stop_Private(app) : "";
    if ((!here || app->adapt_stop[0]) && !judged) { /* of this step, and of coarser meshes nobody asks */
      PetscCall(PathStabilise(&app->path, &judged));
      if (judged) continue;
    }
    if (here && !app->adapt_stop[0]) PetscCall(AppLayers(app, &app->estimate, &layers));
    const PetscBool enough = (PetscBool)(!here || app->adapt_stop[0]);
    PetscCall(ReportPass_Private(app, iterations, enough));
    if (enough) break;
    PetscCall(Pass_Private(app, &layers, &iterations, &more, &gave_up));
    judged = PETSC_FALSE;
    if (more) continue;
    if (app->path.stopped) break;
    app->last.accepted          = PETSC_TRUE;
    app->last.newton_iterations = iterations;
    PetscCall(MonitorRow(app->monitor, &app->last));
  }
  if (here && !app->path.stopped) PetscCall(AppJudge(app, app->estimate.total, app->estimate.norm, gave_up));
  PetscCall(AppRemember(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}
