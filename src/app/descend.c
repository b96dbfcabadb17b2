/* Down on the energy: where Newton's method finds no equilibrium (solve/descent.c), and where it finds one that is unstable (solve/stable.c). */
#include "appimpl.h"

PetscErrorCode AppDescend(App *app, PetscReal t, PetscBool *ok)
{
  Level       *l = &app->level;
  SolverReport report;

  PetscFunctionBegin;
  PetscCall(SolverDescends(l->solver, ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetTime(l->problem, t));
  PetscCall(SolverDescend(l->solver, &l->state, &report));
  AppCount(app, &report);
  *ok = report.converged;
  if (*ok) {
    l->state.t = t;
    ++app->descended_steps;
    PetscCall(PetscPrintf(app->comm,
                          "note: no equilibrium near by at t = %g; %" PetscInt_FMT " descent%s of the energy, %" PetscInt_FMT " factorisations, led to one\n",
                          (double)t, report.descents, report.descents == 1 ? "" : "s", report.factorisations));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscInfo(NULL, "descent to t = %g: %s; %" PetscInt_FMT " factorisations\n", (double)t, report.reason, report.factorisations));
  PetscCall(StateCopy(&l->accepted, &l->state));
  PetscCall(AppPrescribeAt(l->problem, l->accepted.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Back to the solution there was. */
static PetscErrorCode Keep_Private(Level *l, const State *unstable)
{
  PetscFunctionBegin;
  PetscCall(StateCopy(unstable, &l->state));
  PetscCall(ProblemSetState(l->problem, &l->state));
  PetscCall(ProblemSearch(l->problem, l->state.x));
  PetscCall(ProblemRefresh(l->problem, l->state.x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppStabilise(App *app, PetscBool *changed)
{
  Level       *l = &app->level;
  SolverReport report;
  State        unstable;
  PetscBool    possible;

  PetscFunctionBegin;
  *changed = PETSC_FALSE;
  PetscCall(SolverHasDescent(l->solver, &possible));
  if (!app->unstable_now || !possible || !app->data->load.stable) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StateCreate(l->problem, &unstable));
  PetscCall(StateCopy(&l->state, &unstable));
  PetscCall(SolverStabilise(l->solver, &l->state, &report));
  PetscCall(PetscInfo(NULL, "unstable equilibrium: %s\n", report.converged ? "another was found" : report.reason));
  AppCountWork(app, &report);
  if (report.stopped) app->stopped = PETSC_TRUE;
  *changed = (PetscBool)(report.converged && report.unstable == 0);
  if (*changed) {
    --app->unstable; /* it is gone */
    app->unstable_now = PETSC_FALSE;
    app->status       = report.status;
    if (app->stabilised_steps++ == 0)
      PetscCall(PetscPrintf(
          app->comm,
          "note: the equilibrium found at t = %g is unstable; a stable one of less energy takes its place, there and where that happens again (load.stable)\n",
          (double)l->state.t));
  } else
    PetscCall(Keep_Private(l, &unstable));
  PetscCall(StateDestroy(&unstable));
  PetscFunctionReturn(PETSC_SUCCESS);
}
