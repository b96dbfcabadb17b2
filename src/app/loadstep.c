/* The load steps: in time or along the path of equilibria; adapt at each new state; report what was accepted. How a step is found: src/path. */
#include "appimpl.h"

#define FAST 10 /* times as fast as on the way there do displacements grow where the step ends at a limit point: at its distance d like d^(-1/2) */

/* Is a limit point of loads near? Bodies are ever faster while loads go on growing. Where loads hardly change, something else moves the bodies, as a support
   that is drawn from under one, and there may be an equilibrium farther off. */
static PetscErrorCode LimitPoint_Private(App *app, const PathLoop *loop, PetscBool *near)
{
  PetscReal loads = 0;

  PetscFunctionBegin;
  *near = (PetscBool)(loop->metric == &PathTime && app->speed > FAST);
  if (*near) PetscCall(ProblemLoadSpeed(app->level.problem, app->level.accepted.x, &loads));
  *near = (PetscBool)(*near && loads * FAST > 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PathLoop AppNextStep(const App *app)
{
  const LoadSpec *load = &app->data->load;
  const PetscReal t = app->level.accepted.t, unit = app->arc_first / load->step;

  if (app->arc_first > 0)
    return (PathLoop){
        .metric = &PathArc, .stop = PETSC_INFINITY, .piece = app->arc, .least = unit * load->step_min, .most = unit * load->step_max, .step = PETSC_TRUE};
  return (PathLoop){
      .metric = &PathTime, .s = t, .origin = t, .stop = load->end, .piece = app->dt, .least = load->step_min, .most = load->step_max, .step = PETSC_TRUE};
}

/* A step was not found, however short. Can the last equilibrium tell why? A mode of it that has no stiffness bears no load; where tangents on the way on had
   directions in which the energy falls, the load may be critical. */
static PetscErrorCode TellSoftest_Private(App *app, const SolverReport *report)
{
  char    where[256] = "", lost[64] = "";
  Softest s;

  PetscFunctionBegin;
  PetscCall(PathSoftest(&app->path, &s));
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);
  if (s.known)
    PetscCall(PetscSNPrintf(where, sizeof(where), "moves most at (%.4g, %.4g, %.4g) of body %s", (double)s.X[0], (double)s.X[1], (double)s.X[2],
                            mesh->body_name[s.body]));
  if (s.lost > 0) PetscCall(PetscSNPrintf(lost, sizeof(lost), ", and has lost %.2g %% of its stiffness since t = %.4g", 100 * (double)s.lost, (double)s.from));
  if (s.neutral) {
    PetscCall(PetscPrintf(app->comm, "note: the last equilibrium is neutral, a motion that %s meets no resistance: a load along it has nothing to balance it\n",
                          where));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (report->indefinite == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(app->comm,
                        "note: just beyond the last equilibrium, which is %s, the tangent has directions in which the energy falls, in %" PetscInt_FMT
                        " of %" PetscInt_FMT
                        " factorisations: the load may be critical there (bodies buckle, tilt or snap), with no equilibrium near by%s%s%s\n",
                        app->path.unstable_now ? "unstable" : "stable", report->indefinite, report->factorisations,
                        s.known ? "; the softest mode of that equilibrium " : "", where, lost));
  PetscCall(PetscSNPrintf(app->reason, sizeof(app->reason), "%s; the load may be critical (bodies buckle, tilt or snap)", report->reason));
  app->failure = app->reason;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the last attempt was out of balance when it was given up. */
static PetscErrorCode TellWorst_Private(const App *app, const ProblemPlace *place)
{
  const CoarseMesh *mesh                    = ForestGetCoarse(app->level.forest);
  char              body[MORTISE_NAME + 16] = "", pair[MORTISE_NAME + 16] = "";

  PetscFunctionBegin;
  if (!place->known) PetscFunctionReturn(PETSC_SUCCESS);
  if (place->body >= 0) PetscCall(PetscSNPrintf(body, sizeof(body), " of body %s", mesh->body_name[place->body]));
  if (place->pair >= 0) PetscCall(PetscSNPrintf(pair, sizeof(pair), ", on a side of pair %s", app->data->contacts[place->pair].name));
  if (place->inverted) {
    PetscCall(PetscPrintf(app->comm, "note: when the last attempt was given up, it had inverted the cell round (%.4g, %.4g, %.4g)%s\n", (double)place->X[0],
                          (double)place->X[1], (double)place->X[2], body));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscPrintf(app->comm, "note: when the last attempt was given up, forces were farthest out of balance at (%.4g, %.4g, %.4g)%s%s\n",
                        (double)place->X[0], (double)place->X[1], (double)place->X[2], body, pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadStep_Private(App *app, PetscBool *ok)
{
  PathLoop     loop = AppNextStep(app);
  SolverReport report;

  PetscFunctionBegin;
  PathBegin(&app->path, (PetscBool)(loop.piece < (app->arc_first > 0 ? app->arc_first : app->data->load.step)));
  app->passes_in_step = 0;
  PetscCall(LimitPoint_Private(app, &loop, &app->path.limit_point));
  PetscCall(PathFollow(&app->path, &loop, &report));
  if (!report.converged) PetscCall(AppCoarsen(app, &loop, &report));
  *(app->arc_first > 0 ? &app->arc : &app->dt) = loop.piece;
  *ok                                          = report.converged;
  if (!app->path.stopped) PetscCall(AppCheckRoles(app, report.converged));
  if (app->anew) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt missed = app->num_missed;
  if (*ok) PetscCall(AppAdapt(app));
  if (app->path.stopped) *ok = PETSC_FALSE;
  if (!app->path.stopped && (!*ok || (app->num_missed > missed && !strcmp(app->adapt_stop, NONE_FINER)))) PetscCall(AppReturnRoles(app));
  if (app->anew || *ok || app->path.stopped) PetscFunctionReturn(PETSC_SUCCESS);
  app->failure = report.reason;
  PetscCall(TellWorst_Private(app, &report.worst));
  if (!report.undefined) PetscCall(TellSoftest_Private(app, &report));
  if (app->path.limit_point)
    app->failure = InterfaceSlips(ProblemInterface(app->level.problem))
                       ? "the load has a limit point here: drive by volume, advance or displacement of a boundary"
                       : "the load has a limit point here: drive by volume, advance or displacement of a boundary, or set load.control: arc_length";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The state is about to become the accepted one: along a path the next one is looked for in the direction from there to here. The first step is one of time;
   its length in the displacements, root mean square, is the unit of the others. */
static PetscErrorCode Direction_Private(App *app)
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

static PetscErrorCode Accept_Private(App *app)
{
  const PetscInt  every = app->data->output.checkpoint;
  Level          *l     = &app->level;
  const PetscReal t0    = l->accepted.t;
  PetscReal       step, way, flow;

  PetscFunctionBegin;
  PetscCall(ProblemDistance(l->problem, l->accepted.x, l->state.x, &step));
  PetscCall(ProblemDistance(l->problem, NULL, l->state.x, &way));
  app->speed = way > 0 && l->state.t > t0 ? step / (l->state.t - t0) / (way / l->state.t) : 0;
  PetscCall(Direction_Private(app));
  app->path.energy = app->balance.status.energy;
  app->most_energy = PetscMax(app->most_energy, app->path.energy);
  PetscCall(StateCommit(l->problem, &l->state));
  PetscCall(StateFlowError(l->problem, &l->state, &flow));
  app->path.flow_error = PetscSqrtReal(2 * flow);
  PetscCall(StateCopy(&l->state, &l->accepted));
  ++app->load_steps;
  if (app->path.unstable_now && app->path.unstable++ == 0) app->unstable_t = l->state.t;
  app->path.all_viscous_work += app->path.work.viscous;
  app->last.dt                = l->state.t - t0;
  app->last.step              = app->load_steps;
  app->last.newton_iterations = app->path.iterations_in_step;
  app->last.step_cuts         = app->path.cuts_in_step;
  app->last.modifiers         = app->path.modifiers_in_step;
  app->last.viscous_work      = app->path.work.viscous;
  for (PetscInt i = 0; i < app->balance.num_contacts; ++i) {
    app->balance.pair[i].friction.dissipation += app->path.work.friction[i];
    app->friction[i] = app->balance.pair[i].friction;
  }
  PetscCall(HistoryStep(app->history, &app->last, &app->balance, l->problem, &l->state));
  PetscCall(AppWatch(app));
  PetscCall(AppSnapshot(app));
  if (every > 0 && app->load_steps % every == 0) PetscCall(AppCheckpoint(app));
  PetscCall(PetscTime(&app->accepted_at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Arrived_Private(const App *app)
{
  const LoadSpec *load = &app->data->load;

  return (PetscBool)(app->level.accepted.t >= load->end || (load->stop_displacement > 0 && app->path.status.largest >= load->stop_displacement));
}

PetscErrorCode AppRun(App *app)
{
  const LoadSpec *load = &app->data->load;
  PetscBool       ok   = PETSC_TRUE;

  PetscFunctionBegin;
  while (ok && !app->failure) {
    if (Arrived_Private(app)) {
      PetscCall(AppRepeat(app, &ok));
      continue;
    }
    PetscCall(StopAsked(app->comm, &app->path.stopped));
    if (app->path.stopped) break;
    if (app->load_steps == load->max_steps) {
      app->failure = "load.max_steps was reached before load.end";
      break;
    }
    PetscCall(LoadStep_Private(app, &ok));
    if (app->anew) PetscFunctionReturn(PETSC_SUCCESS);
    if (ok) PetscCall(Accept_Private(app));
  }
  if (app->path.stopped)
    PetscCall(AppStop(app));
  else if (app->data->output.checkpoint > 0 && app->load_steps > 0)
    PetscCall(AppCheckpoint(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}
