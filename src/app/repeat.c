/* The whole path of loads again on a finer mesh (adapt.repeat: path): bodies that flow remember the mesh they flowed on, so nothing is carried over. One mesh
   is for all steps of a path; it is refined where any of them that was above the tolerance needs it. */
#include "appimpl.h"

#define STRESSED 10 /* nodal forces below this multiple of their round-off are nothing to estimate an error of: refining would chase noise */

PetscBool AppIsAdaptive(const App *app)
{
  PetscBool adaptive = (PetscBool)(app->data->adapt.tolerance > 0);

  for (PetscInt i = 0; i < app->data->num_contacts; ++i) adaptive = (PetscBool)(adaptive || app->data->contacts[i].subdivide_auto);
  return adaptive;
}

PetscBool AppOverlaps(const App *app)
{
  return (PetscBool)(app->estimated && app->estimate.overlap.share > ROUND_LENGTH);
}

PetscBool AppIsStressed(const App *app)
{
  return (PetscBool)(app->path.status.scale > STRESSED * app->path.status.noise || AppOverlaps(app));
}

PetscErrorCode AppRemember(App *app)
{
  const AdaptSpec *spec = &app->data->adapt;

  PetscFunctionBegin;
  if (spec->repeat != REPEAT_PATH || !AppIsAdaptive(app) || !AppIsStressed(app) || app->estimate.relative <= spec->tolerance)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(EstimateLargest(&app->estimate, &app->largest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything that a path counts, as before its first step. */
static void Begin_Private(App *app)
{
  app->load_steps = app->path.unstable = 0;
  app->dt                              = app->data->load.step;
  app->arc = app->arc_first = app->speed = 0;
  app->path.flow_error = app->path.all_viscous_work = 0;
  app->path.status                                  = (ProblemStatus){0};
}

/* Files and screen: a checkpoint first, for it alone tells tables and fields of one path from those of another; then what the path left goes aside. */
static PetscErrorCode Tell_Private(App *app, PetscReal error)
{
  PetscFunctionBegin;
  if (app->writer) PetscCall(WriterDestroy(&app->writer)); /* the checkpoint is of a path without states */
  PetscCall(AppSnapshot(app));
  if (app->data->output.checkpoint > 0) PetscCall(AppCheckpoint(app));
  PetscCall(OutputSetAside(app->comm, app->data->output.directory));
  if (app->data->output.fields) PetscCall(WriterCreate(app->comm, app->data->output.directory, &app->writer));
  PetscCall(HistoryAgain(app->history));
  const ForestTables *t = ForestGetTables(app->level.forest);
  PetscCall(MonitorAgain(app->monitor, app->repeats, t->num_leaves, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The finer mesh, if there is to be one. */
static PetscErrorCode Refine_Private(App *app, PetscBool *refined)
{
  const AdaptSpec *spec    = &app->data->adapt;
  MarkList         layers  = {0};
  PetscBool        refused = PETSC_FALSE;

  PetscFunctionBegin;
  app->adapt_stop = !app->largest.num_leaves ? WITHIN_TOLERANCE : app->repeats >= spec->max_passes ? "max_passes" : "";
  if (!app->adapt_stop[0]) PetscCall(AppLayers(app, &app->largest, &layers));
  if (!app->adapt_stop[0]) {
    PetscCall(AppSummary(app, "inaccurate", "a finer path is under way"));
    PetscCall(AppRefine(app, &app->largest, &layers, REFINE_AFRESH, refined, &refused));
  }
  const PetscReal error = app->largest.num_leaves ? app->largest.relative : 0; /* of the step's own norm */
  if (!*refined) PetscCall(AppJudge(app, error, PetscSqrtReal(1 - PetscSqr(error)), refused));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppRepeat(App *app, PetscBool *again)
{
  Level old = app->level;

  PetscFunctionBegin;
  *again = PETSC_FALSE;
  if (app->data->adapt.repeat != REPEAT_PATH || !AppIsAdaptive(app)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Refine_Private(app, again));
  if (!*again) {
    PetscCall(OutputDropAside(app->comm, app->data->output.directory)); /* this path came to its end too */
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const PetscReal error = app->largest.relative;
  PetscCall(LevelDestroy(&old));
  PetscCall(EstimateDestroy(&app->largest));
  ++app->repeats;
  ++app->adapt_passes;
  Begin_Private(app);
  PetscCall(Tell_Private(app, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}
