/* The load steps: advance pseudo-time, cut on failure, grow on ease; adapt at each new time; report what was accepted. */
#include "appimpl.h"

#define ROUND_OFF 1e-12
#define SHORT 0.75     /* of load.step: a step that was cut before */
#define AGAIN (1. / 8) /* of the last step that drag did not help */
#define HASTE 10       /* times as fast as on the way there do displacements grow where the step ends at a limit point: at its distance d like d^(-1/2) */

void AppCount(App *app, const SolverReport *report)
{
  app->newton_iterations += report->iterations;
  app->iterations_in_step += report->iterations;
  app->set_changes += report->set_changes;
  app->set_cycles += report->set_cycles;
  app->factorisations += report->factorisations;
  app->single_failures += report->single_failures;
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) {
    app->modifiers[i] += report->modifiers[i];
    app->modifiers_in_step += report->modifiers[i];
  }
  if (report->converged && report->unstable >= 0) ++app->judged;
  if (report->converged && report->unstable > 0) ++app->unstable;
  if (report->converged) app->status = report->status;
  if (report->stopped) app->stopped = PETSC_TRUE;
}

/* Back to a state and its time. */
static PetscErrorCode Restore_Private(App *app, const State *from)
{
  PetscFunctionBegin;
  PetscCall(StateCopy(from, &app->level.state));
  PetscCall(AppPrescribeAt(app->level.problem, from->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve at time t. Where forces hold lines of mortar sides since an earlier solve (solve/newton.c) and there is no solution to be found: once more from the
   start, with held rims only. */
static PetscErrorCode Solve_Private(App *app, PetscReal t, SolverReport *report)
{
  Level          *l    = &app->level;
  const PetscBool held = l->state.form.frozen_segmentation;
  State           start;

  PetscFunctionBegin;
  if (held) PetscCall(StateCreate(l->problem, &start));
  if (held) PetscCall(StateCopy(&l->state, &start));
  PetscCall(SolverSolve(l->solver, &l->state, report));
  if (held && !report->converged && !report->stopped) {
    PetscCall(PetscInfo(NULL, "lines are let go: %s\n", report->reason));
    AppCount(app, report);
    start.form.frozen_segmentation = PETSC_FALSE;
    PetscCall(Restore_Private(app, &start));
    PetscCall(ProblemSetTime(l->problem, t));
    PetscCall(SolverSolve(l->solver, &l->state, report));
  }
  if (held) PetscCall(StateDestroy(&start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppAttempt(App *app, PetscReal t, SolverReport *report)
{
  Level      *l = &app->level;
  const char *words;

  PetscFunctionBegin;
  PetscCall(ProblemSetTime(l->problem, t));
  PetscCall(ExpressionTrouble(app->comm, &words)); /* of prescribed motion and dead loads; the others are asked for on the way */
  PetscCall(PetscMemzero(report, sizeof(*report)));
  if (!words) {
    PetscCall(Solve_Private(app, t, report));
    PetscCall(ExpressionTrouble(app->comm, &words));
  }
  if (words) {
    report->converged = PETSC_FALSE;
    report->reason    = words;
  }
  AppCount(app, report);
  if (report->converged) l->state.t = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppAdvance(App *app, PetscReal t, PetscReal smallest, PetscBool *ok)
{
  Level       *l  = &app->level;
  PetscReal    dt = t - l->state.t;
  State        start;
  SolverReport report;
  PetscBool    arrived = PETSC_FALSE; /* at the end of a piece */

  PetscFunctionBegin;
  *ok = PETSC_TRUE;
  PetscCall(StateCreate(l->problem, &start));
  while (*ok && l->state.t < t - ROUND_OFF * app->data->load.end) {
    const PetscReal next = PetscMin(t, l->state.t + dt);
    if (arrived) PetscCall(StateCommit(l->problem, &l->state)); /* the last piece stays open, as a whole step does until it is accepted */
    arrived = PETSC_FALSE;
    PetscCall(StateCopy(&l->state, &start));
    PetscCall(AppAttempt(app, next, &report));
    arrived = report.converged;
    if (arrived) continue;
    PetscCall(Restore_Private(app, &start));
    dt *= 0.5;
    ++app->step_cuts;
    ++app->cuts_in_step;
    PetscCall(PetscInfo(NULL, "step to t = %g cut: %s\n", (double)next, report.reason));
    *ok = (PetscBool)(dt >= smallest && !app->stopped);
  }
  PetscCall(StateDestroy(&start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The path must not cut a corner of an amplitude. */
PetscReal AppStepEnd(const SceneData *data, PetscReal t0, PetscReal dt)
{
  const MechanicsSpec *m    = &data->mechanics;
  const PetscReal      tiny = ROUND_OFF * data->load.end;
  PetscReal            last = data->load.end;

  for (PetscInt i = 0; i < m->num_boundaries; ++i) last = PetscMin(last, AmplitudeNext(&m->boundaries[i].amplitude, t0 + tiny));
  for (PetscInt i = 0; i < m->num_bodies; ++i) last = PetscMin(last, AmplitudeNext(&m->bodies[i].amplitude, t0 + tiny));
  return t0 + dt > last - tiny ? last : t0 + dt;
}

/* Do loads drive the scene? */
static PetscBool Loaded_Private(const SceneData *data)
{
  for (PetscInt i = 0; i < data->mechanics.num_boundaries; ++i) {
    const BoundarySpec *b = &data->mechanics.boundaries[i];
    if (b->pressure || b->traction[0] || b->traction[1] || b->traction[2]) return PETSC_TRUE;
  }
  for (PetscInt i = 0; i < data->mechanics.num_bodies; ++i) {
    const BodySpec *b = &data->mechanics.bodies[i];
    if (b->force[0] || b->force[1] || b->force[2]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Is it time for an equilibrium that is not near by? Where contact is and a shorter step failed too; again when the step has become much shorter than the last
   one tried so. Not at limit points of loads, whose user is told. */
static PetscBool RelaxNow_Private(const App *app, PetscReal dt, PetscReal tried)
{
  if (!app->data->load.relax || app->data->num_contacts == 0 || (app->haste > HASTE && Loaded_Private(app->data))) return PETSC_FALSE;
  return (PetscBool)(tried > 0 ? dt <= AGAIN * tried : app->cuts_in_step > 0 || dt < SHORT * app->data->load.step);
}

static PetscErrorCode Relax_Private(App *app, PetscReal t, PetscBool *ok)
{
  PetscFunctionBegin;
  PetscCall(AppRelax(app, t, ok));
  if (*ok) {
    ++app->relaxed_steps;
    app->all_drag_work += app->drag_work;
    PetscCall(PetscPrintf(app->comm, "note: no equilibrium near by at t = %g; one farther off was found under drag, which took %.3g of energy\n", (double)t,
                          (double)app->drag_work));
  } else {
    app->drag_work = 0;
    PetscCall(Restore_Private(app, &app->level.accepted));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One accepted load step of at most app->dt: the first piece that converges, then adaptation at its time. */
static PetscErrorCode LoadStep_Private(App *app, PetscBool *ok)
{
  Level          *l  = &app->level;
  const PetscReal t0 = l->accepted.t;
  PetscReal      *dt = &app->dt, tried;
  SolverReport    report;

  PetscFunctionBegin;
  app->modifiers_in_step = app->iterations_in_step = app->cuts_in_step = app->passes_in_step = 0;
  app->drag_work = tried = 0;
  for (;;) {
    const PetscReal t = AppStepEnd(app->data, t0, *dt);
    PetscCall(AppAttempt(app, t, &report));
    *ok = report.converged;
    if (*ok) break;
    PetscCall(Restore_Private(app, &l->accepted));
    if (app->stopped) PetscFunctionReturn(PETSC_SUCCESS);
    if (RelaxNow_Private(app, t - t0, tried)) {
      tried = t - t0;
      PetscCall(Relax_Private(app, t, ok));
      if (*ok) break;
      if (app->stopped) PetscFunctionReturn(PETSC_SUCCESS);
    }
    *dt = 0.5 * (t - t0);
    ++app->step_cuts;
    ++app->cuts_in_step;
    if (*dt >= app->data->load.step_min) continue;
    app->failure = app->haste > HASTE && Loaded_Private(app->data)
                       ? "the load has a limit point here: drive by volume, advance or displacement of a boundary, or set load.control: arc_length"
                       : report.reason;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const PetscBool easy = (PetscBool)(report.converged && report.iterations <= EASY_ITERATIONS && app->cuts_in_step == 0);
  PetscCall(AppAdapt(app));
  *ok = (PetscBool)!app->stopped;
  if (easy) *dt = PetscMin(GROWTH * *dt, app->data->load.step_max);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Accept_Private(App *app, PetscReal t0)
{
  const PetscInt every = app->data->output.checkpoint;
  Level         *l     = &app->level;
  PetscReal      step, way;

  PetscFunctionBegin;
  PetscCall(ProblemDistance(l->problem, l->accepted.x, l->state.x, &step));
  PetscCall(ProblemDistance(l->problem, NULL, l->state.x, &way));
  app->haste = way > 0 && l->state.t > t0 ? step / (l->state.t - t0) / (way / l->state.t) : 0;
  PetscCall(AppPathAccept(app));
  PetscCall(StateCommit(l->problem, &l->state));
  PetscCall(StateCopy(&l->state, &l->accepted));
  ++app->load_steps;
  app->last.dt                = l->state.t - t0;
  app->last.step              = app->load_steps;
  app->last.newton_iterations = app->iterations_in_step;
  app->last.step_cuts         = app->cuts_in_step;
  app->last.modifiers         = app->modifiers_in_step;
  app->last.drag_work         = app->drag_work;
  PetscCall(HistoryStep(app->history, &app->last, &app->balance, l->problem, &l->state));
  PetscCall(AppSnapshot(app));
  if (every > 0 && app->load_steps % every == 0) PetscCall(AppCheckpoint(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Arrived_Private(const App *app)
{
  const LoadSpec *load = &app->data->load;

  return (PetscBool)(app->level.accepted.t >= load->end || (load->stop_displacement > 0 && app->status.largest >= load->stop_displacement));
}

PetscErrorCode AppRun(App *app)
{
  const LoadSpec *load = &app->data->load;
  PetscBool       ok   = PETSC_TRUE;

  PetscFunctionBegin;
  while (ok && !app->failure) {
    const PetscReal t0 = app->level.accepted.t;
    if (Arrived_Private(app)) {
      PetscCall(AppRepeat(app, &ok));
      continue;
    }
    PetscCall(StopAsked(app->comm, &app->stopped));
    if (app->stopped) break;
    if (app->load_steps == load->max_steps) {
      app->failure = "load.max_steps was reached before load.end";
      break;
    }
    if (app->arc_first > 0)
      PetscCall(AppPathStep(app, &ok));
    else
      PetscCall(LoadStep_Private(app, &ok));
    if (ok) PetscCall(Accept_Private(app, t0));
  }
  if (app->stopped)
    PetscCall(AppStop(app));
  else if (app->data->output.checkpoint > 0 && app->load_steps > 0)
    PetscCall(AppCheckpoint(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}
