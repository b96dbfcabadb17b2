/* Was the tolerance reached? A run has converged only if it was in every load step, whatever the reason that it was not: no finer mesh with a solution, or a
   limit (max_passes, max_cells, max_order). Next to no load makes next to no error, however large it is against its own strain energy: an error that is left is
   judged by the largest energy norm from its step to the end. */
#include "appimpl.h"

/* Reasons to end adaptation; the last stands for any other. */
static const char *const Causes[] = {"max_passes", "max_cells", NOTHING_LEFT, NONE_FINER, INVERTS, "the mesh could not be refined"};
enum { NUM_CAUSES = PETSC_STATIC_ARRAY_LENGTH(Causes) };

/* Reasons to end adaptation with which nothing is lacking. */
static PetscBool IsEnough_Private(const char *stop)
{
  return (PetscBool)(!stop[0] || !strcmp(stop, WITHIN_TOLERANCE) || !strcmp(stop, UNSTRESSED) || !strcmp(stop, FACES_FINE));
}

static PetscReal Relative_Private(const Missed *m)
{
  return m->error / PetscSqrtReal(PetscSqr(m->norm) + PetscSqr(m->error));
}

/* What is still above the tolerance as of a step with this norm, without what a later entry stands for: its error is larger and its norm will always be as
   small. */
static void Prune_Private(App *app, PetscReal norm, PetscReal error)
{
  PetscInt kept = 0;

  for (PetscInt i = 0; i < app->num_missed; ++i) {
    Missed m = app->missed[i];
    m.norm   = PetscMax(m.norm, norm);
    if (m.error > error && Relative_Private(&m) > app->data->adapt.tolerance) app->missed[kept++] = m;
  }
  app->num_missed = kept;
}

PetscErrorCode AppJudge(App *app, PetscReal error, PetscReal norm, PetscBool refused)
{
  const PetscReal tolerance = app->data->adapt.tolerance;
  Missed          m         = {.t = app->level.state.t, .error = error, .norm = norm};

  PetscFunctionBegin;
  const PetscBool missed = (PetscBool)(!IsEnough_Private(app->adapt_stop) && (tolerance > 0 ? Relative_Private(&m) > tolerance : refused));
  Prune_Private(app, norm, missed ? error : 0);
  if (!missed) PetscFunctionReturn(PETSC_SUCCESS);
  while (m.cause < NUM_CAUSES - 1 && strcmp(Causes[m.cause], app->adapt_stop)) ++m.cause;
  PetscCall(PetscRealloc((size_t)(app->num_missed + 1) * sizeof(m), &app->missed));
  app->missed[app->num_missed++] = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *AppStatus(const App *app)
{
  return app->failure ? "failed" : app->path.stopped ? "stopped" : app->num_missed ? "inaccurate" : "converged";
}

PetscErrorCode AppReason(App *app, const char **reason)
{
  const Missed *worst    = app->missed;
  char          when[64] = "", asked[64] = "";

  PetscFunctionBegin;
  *reason = app->failure ? app->failure : app->reason;
  if (app->failure || app->path.stopped || !app->num_missed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 1; i < app->num_missed; ++i) {
    if (Relative_Private(&app->missed[i]) > Relative_Private(worst)) worst = &app->missed[i];
  }
  if (worst->t < app->level.accepted.t) PetscCall(PetscSNPrintf(when, sizeof(when), " at t = %.6g", (double)worst->t));
  if (app->data->adapt.tolerance > 0)
    PetscCall(PetscSNPrintf(asked, sizeof(asked), "adapt.tolerance %g was not reached (", (double)app->data->adapt.tolerance));
  PetscCall(PetscSNPrintf(app->reason, sizeof(app->reason), "%s%s%s%s, the estimated error is up to %.3g %%", asked,
                          Causes[PetscMin(worst->cause, NUM_CAUSES - 1)], when, asked[0] ? ")" : "", 100 * (double)Relative_Private(worst)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
