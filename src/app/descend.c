/* A step whose equilibrium Newton's method does not find: down to it on the energy (solve/descent.c). */
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
