/* Was the tolerance reached? A run whose mesh could not be refined as it asks has solutions at the end of all load steps, but not those that were asked for:
   its status is not "converged". Limits that the user sets (max_passes, max_cells, max_order) are met as they are asked for: the run has converged, and says
   what it lacks. */
#include "appimpl.h"

/* Reasons to end adaptation with which nothing is lacking. */
static PetscBool IsEnough_Private(const char *stop)
{
  return (PetscBool)(!stop[0] || !strcmp(stop, WITHIN_TOLERANCE) || !strcmp(stop, UNSTRESSED) || !strcmp(stop, FACES_FINE));
}

void AppJudge(App *app, PetscReal error, PetscBool gave_up)
{
  const PetscReal tolerance = app->data->adapt.tolerance;

  if (IsEnough_Private(app->adapt_stop) || (tolerance <= 0 && !gave_up)) return;
  if (tolerance > 0 && error <= tolerance) return;
  if (gave_up) app->gave_up = 1;
  app->above_error = PetscMax(app->above_error, error);
}

const char *AppStatus(const App *app)
{
  return app->failure ? "failed" : app->path.stopped ? "stopped" : app->gave_up ? "inaccurate" : "converged";
}

PetscErrorCode AppReason(App *app, const char **reason)
{
  const PetscReal tolerance = app->data->adapt.tolerance;
  char            asked[64] = "the mesh could not be refined";

  PetscFunctionBegin;
  *reason = app->failure ? app->failure : app->reason;
  if (app->failure || app->path.stopped || !(app->above_error > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  if (tolerance > 0) PetscCall(PetscSNPrintf(asked, sizeof(asked), "adapt.tolerance %g was not reached", (double)tolerance));
  PetscCall(PetscSNPrintf(app->reason, sizeof(app->reason), "%s (%s), the estimated error is up to %.3g %%", asked,
                          IsEnough_Private(app->adapt_stop) ? "in an earlier load step" : app->adapt_stop, 100 * (double)app->above_error));
  PetscFunctionReturn(PETSC_SUCCESS);
}
