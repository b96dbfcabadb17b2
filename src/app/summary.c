/* summary.json: the figures of the last accepted state, and what it took. */
#include "appimpl.h"

ReportRow AppTotal(const App *app)
{
  PetscLogDouble now = 0;

  (void)PetscTime(&now);
  return (ReportRow){.step              = app->load_steps,
                     .step_cuts         = app->path.step_cuts,
                     .newton_iterations = app->path.newton_iterations,
                     .t                 = app->level.accepted.t,
                     .seconds           = now - app->start};
}

/* Figures of the last accepted state, which is what a run that failed or was stopped leaves behind, and of one that had nothing left to do. */
static PetscErrorCode Figures_Private(App *app)
{
  const PetscBool given_up = (PetscBool)(app->failure || app->path.stopped), told = (PetscBool)(app->balance.reaction != NULL);
  Level          *l = &app->level;

  PetscFunctionBegin;
  if (!given_up && told) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PathPrescribe(l->problem, l->accepted.t));
  PetscCall(ProblemSearch(l->problem, l->accepted.x)); /* this mesh may not have seen any solution yet */
  if (told) PetscCall(BalanceDestroy(&app->balance));
  if (!given_up) PetscCall(AppEstimate(app));
  PetscCall(BalanceCompute(l->problem, &l->accepted, &app->balance));
  if (app->failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReportRowFill(l->problem, &l->accepted, given_up ? NULL : &app->estimate, &app->balance, &app->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSummary(App *app, const char *status, const char *reason)
{
  PetscFunctionBegin;
  PetscCall(Figures_Private(app));
  const ReportRow total      = AppTotal(app);
  RunSummary      summary    = {.status = status, .reason = reason, .t = total.t, .seconds = total.seconds, .load_steps = app->load_steps};
  summary.step_cuts          = app->path.step_cuts;
  summary.adapt_passes       = app->adapt_passes;
  summary.newton_iterations  = app->path.newton_iterations;
  summary.active_set_changes = app->path.set_changes;
  summary.active_set_cycles  = app->path.set_cycles;
  summary.factorisations     = app->path.factorisations;
  summary.single_failures    = app->path.single_failures;
  summary.path               = &app->path;
  summary.unstable           = app->path.judged ? (PetscReal)app->path.unstable : (PetscReal)NAN;
  summary.adapt_stop         = app->adapt_stop;
  summary.problem            = app->level.problem;
  summary.state              = &app->level.accepted;
  summary.balance            = &app->balance;
  summary.estimate           = app->estimated && !app->failure && !app->path.stopped && !PetscIsNanReal(app->last.estimated_error) ? &app->estimate : NULL;
  summary.probes             = app->probes;
  PetscCall(OutputHold(app->comm));
  PetscCall(OutputSummary(app->comm, app->data, &summary));
  PetscFunctionReturn(PETSC_SUCCESS);
}
