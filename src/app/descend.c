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

PetscErrorCode AppStabilise(App *app, PetscReal t, SolverReport *report)
{
  Level       *l = &app->level;
  SolverReport further;
  State        unstable;
  PetscBool    ok;

  PetscFunctionBegin;
  PetscCall(SolverHasDescent(l->solver, &ok));
  if (!report->converged || report->unstable <= 0 || !ok || !app->data->load.stable) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StateCreate(l->problem, &unstable));
  PetscCall(StateCopy(&l->state, &unstable));
  PetscCall(SolverStabilise(l->solver, &l->state, &further));
  PetscCall(PetscInfo(NULL, "unstable equilibrium: %s\n", further.converged ? "another was found" : further.reason));
  AppCountWork(app, report);
  if (further.converged)
    *report = further;
  else {
    AppCountWork(app, &further);
    PetscCall(StateCopy(&unstable, &l->state));
    PetscCall(ProblemSetState(l->problem, &l->state));
    PetscCall(ProblemSearch(l->problem, l->state.x));
    PetscCall(ProblemRefresh(l->problem, l->state.x));
    report->iterations = report->descent_iterations = report->factorisations = report->single_failures = report->set_changes = report->set_cycles =
        0; /* counted */
    report->stopped = further.stopped;
  }
  if (report->unstable == 0) ++app->stabilised_steps;
  if (report->unstable == 0 && app->stabilised_steps == 1)
    PetscCall(PetscPrintf(
        app->comm, "note: the equilibrium found first at t = %g is unstable; from there on stable ones that lie lower in energy are taken (load.stable)\n",
        (double)t));
  PetscCall(StateDestroy(&unstable));
  PetscFunctionReturn(PETSC_SUCCESS);
}
