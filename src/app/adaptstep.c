/* Adaptation at one time: estimate, refine, find equilibrium again; until the tolerance or a limit is met. */
#include "appimpl.h"

#define MOST_PIECES 8 /* of the way from the accepted state, when equilibrium on a finer mesh is hard to find */

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
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) app->touched[i] = (PetscBool)(app->touched[i] || app->balance.pair[i].active_nodes > 0);
  if (before.reaction && app->passes_in_step > 0) BalanceChange(&before, &app->balance, change);
  if (before.reaction) PetscCall(BalanceDestroy(&before));
  PetscCall(PetscMemzero(&app->last, sizeof(app->last)));
  PetscCall(ReportRowFill(l->problem, &l->state, AppIsStressed(app) ? &app->estimate : NULL, &app->balance, &app->last));
  PetscCall(PetscTime(&now));
  app->last.step              = app->load_steps + 1;
  app->last.pass              = app->path + app->passes_in_step;
  app->last.newton_iterations = iterations;
  app->last.step_cuts         = app->cuts_in_step;
  app->last.set_cycles        = app->set_cycles - app->told_cycles;
  app->told_cycles            = app->set_cycles;
  app->last.seconds           = now - app->start;
  app->last.force_change      = change[0];
  app->last.work_change       = change[1];
  app->last.strain_change     = change[2];
  app->last.accepted          = accepted;
  app->last.dt                = l->state.t - l->accepted.t;
  PetscCall(HistoryPass(app->history, &app->last));
  PetscCall(MonitorRow(app->monitor, &app->last));
  if (!app->data->output.fields) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_OUTPUT));
  /* Passes at one load time follow each other a little apart: readers want times that grow. */
  const PetscReal      apart  = 1e-6 * app->data->load.end;
  const PetscReal      time   = app->data->load.control == LOAD_TIME ? l->state.t : app->data->load.end * (app->load_steps + 1); /* on a path t may fall */
  const PetscErrorCode status = OutputWriteState(app->writer, l->problem, &l->state, app->estimated ? &app->estimate : NULL, time + apart * app->passes_in_step,
                                                 app->load_steps + 1, app->path + app->passes_in_step);
  if (status) WriterAbandon(app->writer);
  PetscCall(status);
  PetscCall(StageEnd(STAGE_OUTPUT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* State between the last accepted one (share 0) and the transferred one (share 1), its prescribed motion likewise; the rest of the motion to time t is left to
   the solver. */
static PetscErrorCode StartBetween_Private(App *app, const State *transferred, PetscReal share)
{
  Level *l = &app->level;

  PetscFunctionBegin;
  PetscCall(StateBlend(&l->accepted, transferred, share, &l->state));
  PetscCall(AppPrescribeAt(l->problem, l->accepted.t));
  PetscCall(ProblemSetTime(l->problem, transferred->t));
  PetscCall(ProblemApplyShare(l->problem, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equilibrium from the transferred state as its imbalance is taken away. */
static PetscErrorCode Settle_Private(App *app, const State *transferred, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(StateCopy(transferred, &app->level.state));
  PetscCall(PetscInfo(NULL, "the transferred state is to settle\n"));
  PetscCall(SolverSettle(app->level.solver, &app->level.state, report));
  AppCount(app, report);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equilibrium on the new mesh at the same load (along a path: on the same plane across it). Where the transferred state leads nowhere (a refined cell at a
   singular corner may start inverted), a state on the way to it does better; at last the way from the accepted state is gone again, in as many pieces as it
   takes. */
static PetscErrorCode Reequilibrate_Private(App *app, PetscInt *iterations, PetscBool *ok)
{
  static const PetscReal Shares[] = {1, 0.8, 0.5};
  Level                 *l        = &app->level;
  const PetscReal        t        = l->state.t;
  State                  transferred;
  PetscBool              following;

  PetscFunctionBegin;
  const PetscInt before = app->newton_iterations;
  PetscCall(StateCreate(l->problem, &transferred));
  PetscCall(StateCopy(&l->state, &transferred));
  *ok = PETSC_FALSE;
  for (size_t i = 0; i < sizeof(Shares) / sizeof(Shares[0]) && !*ok && !app->stopped; ++i) {
    SolverReport report;
    if (i > 0) PetscCall(StartBetween_Private(app, &transferred, Shares[i]));
    PetscCall(SolverSolve(l->solver, &l->state, &report));
    AppCount(app, &report);
    if (i == 0 && !report.converged && !app->stopped) PetscCall(Settle_Private(app, &transferred, &report));
    *ok = report.converged;
    if (!*ok) PetscCall(PetscInfo(NULL, "no equilibrium from %g of the transferred state: %s\n", (double)Shares[i], report.reason));
  }
  PetscCall(StateDestroy(&transferred));
  PetscCall(ProblemIsFollowing(l->problem, &following));
  l->state.t = t;
  if (following) PetscCall(ProblemGetTime(l->problem, l->state.x, &l->state.t));
  if (!*ok && !following && !app->stopped) {
    PetscCall(StateCopy(&l->accepted, &l->state));
    PetscCall(AppPrescribeAt(l->problem, l->accepted.t));
    PetscCall(AppAdvance(app, t, (t - l->accepted.t) / MOST_PIECES, ok));
  }
  *iterations = app->newton_iterations - before;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refine and find equilibrium again. When there is none to be found on the finer mesh (material that collapses at a singular corner, say), the solution on
   the mesh at hand stands, and adaptation ends with that reason. *more: a finer mesh was reached; *gave_up: it was not, and no limit is the reason. */
static PetscErrorCode Pass_Private(App *app, MarkList *layers, PetscInt *iterations, PetscBool *more, PetscBool *gave_up)
{
  Level old = app->level;

  PetscFunctionBegin;
  PetscCall(AppRefine(app, &app->estimate, layers, PETSC_FALSE, more, gave_up));
  if (!*more) {
    *iterations = 0;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Reequilibrate_Private(app, iterations, more));
  if (*more) {
    PetscCall(LevelDestroy(&old));
    ++app->passes_in_step;
    ++app->adapt_passes;
  } else {
    PetscCall(LevelDestroy(&app->level));
    app->level      = old;
    app->adapt_stop = NONE_FINER;
    *gave_up        = PETSC_TRUE;
    PetscCall(AppPrescribeAt(old.problem, old.state.t));
  }
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
  PetscInt        iterations = app->iterations_in_step;
  const PetscBool here       = (PetscBool)(AppIsAdaptive(app) && app->data->adapt.repeat == REPEAT_STEP);
  PetscBool       more = PETSC_TRUE, gave_up = PETSC_FALSE, judged = PETSC_FALSE;

  PetscFunctionBegin;
  while (more) {
    MarkList layers = {0};
    PetscCall(AppEstimate(app));
    app->adapt_stop = here ? Stop_Private(app) : "";
    if ((!here || app->adapt_stop[0]) && !judged) { /* of this step, and of coarser meshes nobody asks */
      PetscCall(AppStabilise(app, &judged));
      if (judged) continue;
    }
    if (here && !app->adapt_stop[0]) PetscCall(AppLayers(app, &app->estimate, &layers));
    const PetscBool enough = (PetscBool)(!here || app->adapt_stop[0]);
    PetscCall(ReportPass_Private(app, iterations, enough));
    if (enough) break;
    PetscCall(Pass_Private(app, &layers, &iterations, &more, &gave_up));
    if (more) continue;
    if (app->stopped) break;
    app->last.accepted          = PETSC_TRUE;
    app->last.newton_iterations = iterations;
    PetscCall(MonitorRow(app->monitor, &app->last));
  }
  if (here && !app->stopped) AppJudge(app, app->estimate.relative, gave_up);
  PetscCall(AppRemember(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}
