/* Steps along the path of equilibria (load.control: arc_length): through limit points, where steps of time end. The first step is one of time; its length in
   the displacements, root mean square, is the unit of the others. */
#include "appimpl.h"

#define TURN 2 /* a step this many times as long as asked for has left the tangent: it is made shorter */

PetscErrorCode AppPathAccept(App *app)
{
  Level    *l = &app->level;
  PetscReal length;

  PetscFunctionBegin;
  if (app->data->load.control == LOAD_TIME) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemFollow(l->problem, l->accepted.x, l->state.x, &length));
  if (app->arc_first == 0) app->arc = app->arc_first = length;
  if (length == 0) app->failure = "the first load step moved nothing, so there is no path to follow: the loads do not change with t";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The end was passed: from there back to it, at fixed time. */
static PetscErrorCode Finish_Private(App *app, PetscBool *ok)
{
  Level       *l = &app->level;
  SolverReport report;

  PetscFunctionBegin;
  PetscCall(ProblemHold(l->problem));
  PetscCall(ProblemSetTime(l->problem, app->data->load.end));
  PetscCall(SolverSolve(l->solver, &l->state, &report));
  AppCount(app, &report);
  *ok        = report.converged;
  l->state.t = app->data->load.end;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One attempt, app->arc long, from the accepted state. */
static PetscErrorCode Attempt_Private(App *app, SolverReport *report)
{
  Level    *l = &app->level;
  PetscReal length;

  PetscFunctionBegin;
  PetscCall(ProblemAdvance(l->problem, app->arc));
  PetscCall(SolverSolve(l->solver, &l->state, report));
  AppCount(app, report);
  if (!report->converged) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemDistance(l->problem, l->accepted.x, l->state.x, &length));
  if (length > TURN * app->arc) {
    report->converged = PETSC_FALSE;
    report->reason    = "the path turns sharply";
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ProblemGetTime(l->problem, l->state.x, &l->state.t));
  if (l->state.t > app->data->load.end) PetscCall(Finish_Private(app, &report->converged));
  if (!report->converged) report->reason = "no equilibrium at load.end";
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppPathStep(App *app, PetscBool *ok)
{
  const LoadSpec *load = &app->data->load;
  SolverReport    report;

  PetscFunctionBegin;
  app->modifiers_in_step = app->iterations_in_step = app->cuts_in_step = app->passes_in_step = 0;
  for (;;) {
    PetscCall(Attempt_Private(app, &report));
    *ok = report.converged;
    if (*ok) break;
    PetscCall(StateCopy(&app->level.accepted, &app->level.state));
    if (app->stopped) PetscFunctionReturn(PETSC_SUCCESS);
    app->arc *= 0.5;
    ++app->step_cuts;
    ++app->cuts_in_step;
    if (app->arc >= app->arc_first * load->step_min / load->step) continue;
    app->failure = report.reason;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const PetscBool easy = (PetscBool)(report.iterations <= EASY_ITERATIONS && app->cuts_in_step == 0);
  PetscCall(AppAdapt(app));
  *ok = (PetscBool)!app->stopped;
  if (easy) app->arc = PetscMin(GROWTH * app->arc, app->arc_first * load->step_max / load->step);
  PetscFunctionReturn(PETSC_SUCCESS);
}
