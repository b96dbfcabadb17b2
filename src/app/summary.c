/* summary.json: the figures of the last accepted state, and what it took. */
#include "appimpl.h"

ReportRow AppTotal(const App *app)
{
  PetscLogDouble now = 0;

  (void)PetscTime(&now);
  return (ReportRow){.step              = app->load_steps,
                     .step_cuts         = app->path.step_cuts,
                     .newton_iterations = app->path.newton_iterations,
                     .factorisations    = app->path.factorisations,
                     .t                 = app->level.accepted.t,
                     .seconds           = now - app->start};
}

/* Figures of the last accepted state, which is what a run that failed or was stopped leaves behind, and of one that had nothing left to do. */
static PetscErrorCode Figures_Private(App *app)
{
  const PetscBool given_up = (PetscBool)(app->failure || app->path.stopped), told = (PetscBool)(app->balance.body != NULL);
  Level          *l = &app->level;

  PetscFunctionBegin;
  if (!given_up && told) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PathPrescribe(l->problem, l->accepted.t));
  PetscCall(ProblemSetState(l->problem, &l->accepted));
  PetscCall(ProblemSearch(l->problem, l->accepted.x)); /* this mesh may not have seen any solution yet */
  if (told) PetscCall(BalanceDestroy(&app->balance));
  if (!given_up) PetscCall(AppEstimate(app));
  PetscCall(BalanceCompute(l->problem, &l->accepted, &app->balance));
  for (PetscInt i = 0; i < app->balance.num_contacts && given_up; ++i) /* of the step that led there, if this run made one */
    if (app->friction[i].slipping + app->friction[i].sticking > 0) app->balance.pair[i].friction = app->friction[i];
  if (app->failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReportRowFill(l->problem, &l->accepted, given_up ? NULL : &app->estimate, &app->balance, &app->last));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Needs_Private(App *app, PetscReal seconds)
{
  const NeedsRun run = {.comm         = app->comm,
                        .data         = app->data,
                        .level        = &app->level,
                        .path         = &app->path,
                        .balance      = &app->balance,
                        .estimate     = app->estimated ? &app->estimate : NULL,
                        .touched      = app->touched,
                        .mirror       = app->mirror,
                        .mirror_at    = app->mirror_at,
                        .most_energy  = app->most_energy,
                        .seconds      = seconds,
                        .load_steps   = app->load_steps,
                        .adapt_passes = app->adapt_passes,
                        .later        = app->later_solutions};

  PetscFunctionBegin;
  PetscCall(NeedsFind(&run, &app->needs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSummary(App *app, const char *status, const char *reason)
{
  PetscFunctionBegin;
  PetscCall(Figures_Private(app));
  const PetscBool given_up  = (PetscBool)(app->failure || app->path.stopped);
  const PetscBool estimated = (PetscBool)(app->estimated && !given_up && !PetscIsNanReal(app->last.estimated_error));
  const PetscBool whole     = (PetscBool)(!given_up && !app->restart[0] && app->load_steps > 0);
  const ReportRow total     = AppTotal(app);
  if (whole) PetscCall(Needs_Private(app, total.seconds));
  const RunSummary summary = {.status       = status,
                              .reason       = reason,
                              .adapt_stop   = app->adapt_stop,
                              .t            = total.t,
                              .seconds      = total.seconds,
                              .load_steps   = app->load_steps,
                              .adapt_passes = app->adapt_passes,
                              .path         = &app->path,
                              .problem      = app->level.problem,
                              .state        = &app->level.accepted,
                              .balance      = &app->balance,
                              .estimate     = estimated ? &app->estimate : NULL,
                              .probes       = app->probes,
                              .needs        = whole ? &app->needs : NULL};
  PetscCall(OutputHold(app->comm));
  PetscCall(OutputSummary(app->comm, app->data, &summary));
  PetscFunctionReturn(PETSC_SUCCESS);
}
