/* Stopping and going on: a copy of the state at the end of every accepted load step, checkpoints of it, and the run that begins from one. */
#include "appimpl.h"
#include <unistd.h>

#define AUTO "auto"

static const struct {
  const char *name;
  size_t      at;
} Counters[] = {
    {"path", offsetof(App, repeats)},
    {"load_steps", offsetof(App, load_steps)},
    {"step_cuts", offsetof(App, path.step_cuts)},
    {"adapt_passes", offsetof(App, adapt_passes)},
    {"newton_iterations", offsetof(App, path.newton_iterations)},
    {"active_set_changes", offsetof(App, path.set_changes)},
    {"single_switches", offsetof(App, path.single_switches)},
    {"active_set_cycles", offsetof(App, path.set_cycles)},
    {"reported_cycles", offsetof(App, told_cycles)},
    {"factorisations", offsetof(App, path.factorisations)},
    {"single_factor_failures", offsetof(App, path.single_failures)},
    {"unstable", offsetof(App, path.unstable)},
    {"judged", offsetof(App, path.judged)},
    {"refused", offsetof(App, path.refusal[PATH_INSIDE].num)},
    {"passed_through", offsetof(App, path.refusal[PATH_THROUGH].num)},
    {"thrown", offsetof(App, path.refusal[PATH_THROWN].num)},
    {"rolled", offsetof(App, path.refusal[PATH_ROLLING].num)},
    {"stabilised", offsetof(App, path.stabilised)},
    {"begun_anew", offsetof(App, path.begun_anew)},
    {"folded_left", offsetof(App, path.folded_left)},
    {"descent_iterations", offsetof(App, path.descent_iterations)},
    {"missed", offsetof(App, num_missed)},
    {"flowed", offsetof(App, flowed)},
    {"refined_after_flow", offsetof(App, flowed_coarse)},
};
static const struct {
  const char *name;
  size_t      at;
} Reals[] = {
    {"dt", offsetof(App, dt)},
    {"arc", offsetof(App, arc)},
    {"first_arc", offsetof(App, arc_first)},
    {"speed", offsetof(App, speed)},
    {"viscous_work", offsetof(App, path.all_viscous_work)},
    {"flow_error", offsetof(App, path.flow_error)},
    {"energy", offsetof(App, path.energy)},
    {"largest_displacement", offsetof(App, path.status.largest)},
    {"largest_error", offsetof(App, largest.relative)},
    {"first_unstable", offsetof(App, unstable_t)},
    {"first_far", offsetof(App, path.far_t)},
};
/* ---- options ------------------------------------------------------------------------------------------------------------------- */

static const struct {
  const char *name, *allowed, *text;
} Options[] = {
    {"-restart", "FILE|" AUTO,
     "go on from a checkpoint of this scene, on any number of processes; " AUTO ": from " CHECKPOINT_FILE
     " in output.directory, from t = 0 when there is none"},
    {"-max_seconds", "a number above 0", "stop after this much wall time: a checkpoint, a summary, exit status 3"},
    {"-solution_view", APP_SOLUTION_VIEW, "at the end, the displacement through a viewer of PETSc, on the leaf mesh with a PetscFE of the highest order"},
};

PetscErrorCode AppPrintHelp(MPI_Comm comm)
{
  PetscFunctionBegin;
  PetscCall(HelpText(comm, "\nOptions of the run, on the command line only.\n\n"));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Options); ++i) PetscCall(HelpRow(comm, Options[i].name, Options[i].allowed, Options[i].text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The file to go on from: the checkpoint, or the one before it where the disk has lost it. Without either from the start. Collective. */
static PetscErrorCode Newest_Private(App *app)
{
  PetscMPIInt rank;
  PetscBool   older = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(app->restart, app->checkpoint, sizeof(app->restart)));
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  if (rank == 0) older = (PetscBool)(!CheckpointIsWhole(app->checkpoint) && CheckpointIsWhole(app->before));
  if (rank == 0 && older) PetscCall(PetscStrncpy(app->restart, app->before, sizeof(app->restart)));
  if (rank == 0 && !older && access(app->checkpoint, F_OK)) app->restart[0] = 0;
  PetscCallMPI(MPI_Bcast(app->restart, (PetscMPIInt)sizeof(app->restart), MPI_CHAR, 0, app->comm));
  PetscCallMPI(MPI_Bcast(&older, 1, COMPAT_MPI_BOOL, 0, app->comm));
  if (older) PetscCall(PetscPrintf(app->comm, "note: %s is not whole, the one before it is taken\n", app->checkpoint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppOptions(App *app)
{
  char      text[64];
  char     *end     = text;
  PetscReal seconds = 0;
  PetscBool set, is_auto;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, Options[1].name, text, sizeof(text), &set));
  if (set) seconds = (PetscReal)strtod(text, &end);
  PetscCheckInput(!set || (end != text && !*end && seconds > 0), "%s is '%s'; allowed: %s", Options[1].name, text, Options[1].allowed);
  PetscCall(StopWatch(seconds));
  PetscCall(AppCheckHandOver());
  PetscCall(PetscOptionsGetString(NULL, NULL, Options[0].name, app->restart, sizeof(app->restart), &set));
  PetscCheckInput(!set || app->restart[0], "%s needs a file, or %s", Options[0].name, AUTO);
  PetscCall(PetscSNPrintf(app->checkpoint, sizeof(app->checkpoint), "%s/" CHECKPOINT_FILE, app->data->output.directory));
  PetscCall(PetscSNPrintf(app->before, sizeof(app->before), "%s/" CHECKPOINT_BEFORE, app->data->output.directory));
  PetscCall(PetscStrcmp(app->restart, AUTO, &is_auto));
  if (is_auto) PetscCall(Newest_Private(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- copies and checkpoints ----------------------------------------------------------------------------------------------------- */

/* Numbers of a checkpoint, gathered for one or taken from one. */
typedef struct {
  Checkpoint        from; /* NULL: gathered */
  PetscInt          num, room;
  CheckpointNumber *number; /* owned [room] */
} Numbers;

/* One more, which is *real or else *integer; name: prefix, index (negative: none), suffix. */
static PetscErrorCode Number_Private(Numbers *n, const char *prefix, PetscInt index, const char *suffix, PetscInt *integer, PetscReal *real)
{
  CheckpointNumber one;
  char             at[16] = "";

  PetscFunctionBegin;
  if (index >= 0) PetscCall(PetscSNPrintf(at, sizeof(at), "%" PetscInt_FMT, index));
  PetscCall(PetscSNPrintf(one.name, sizeof(one.name), "%s%s%s", prefix, at, suffix));
  if (n->from) {
    PetscCall(CheckpointGetNumber(n->from, one.name, &one.value));
    PetscCheckInput(real || (one.value >= 0 && one.value <= PETSC_MAX_INT), "-restart: %s of the checkpoint is %g, which counts nothing", one.name,
                    (double)one.value);
    if (real)
      *real = one.value;
    else
      *integer = (PetscInt)one.value;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  one.value = real ? *real : (PetscReal)*integer;
  PetscCall(ArrayGrow(n->num + 1, sizeof(one), &n->room, &n->number));
  n->number[n->num++] = one;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything a run counts, but for its times. Steps go on as they are, unless the scene asks for others now. */
static PetscErrorCode Numbers_Private(App *app, Numbers *n)
{
  PetscReal asked = app->data->load.step;

  PetscFunctionBegin;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Counters); ++i)
    PetscCall(Number_Private(n, "", -1, Counters[i].name, (PetscInt *)(void *)((char *)app + Counters[i].at), NULL));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Reals); ++i)
    PetscCall(Number_Private(n, "", -1, Reals[i].name, NULL, (PetscReal *)(void *)((char *)app + Reals[i].at)));
  PetscCall(Number_Private(n, "", -1, "load_step", NULL, &asked));
  if (asked != app->data->load.step) app->dt = app->data->load.step;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) PetscCall(Number_Private(n, "subdivided.", i, "", &app->subdivided[i], NULL));
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) PetscCall(Number_Private(n, "touched.", i, "", &app->touched[i], NULL));
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) PetscCall(Number_Private(n, "modifier.", -1, SolverModifierName(i), &app->path.modifiers[i], NULL));
  for (PetscInt i = 0; i < PATH_RECOVERIES; ++i) {
    PetscCall(Number_Private(n, "tried.", -1, PathRecoveries[i].name, &app->path.recovery[i].tried, NULL));
    PetscCall(Number_Private(n, "succeeded.", -1, PathRecoveries[i].name, &app->path.recovery[i].succeeded, NULL));
  }
  PetscCheckInput(!n->from || app->num_missed <= app->load_steps + 1,
                  "-restart: of %" PetscInt_FMT " steps of the checkpoint more, %" PetscInt_FMT ", missed the tolerance", app->load_steps, app->num_missed);
  if (n->from) PetscCall(PetscRealloc((size_t)app->num_missed * sizeof(*app->missed), &app->missed));
  for (PetscInt i = 0; i < app->num_missed; ++i) {
    Missed *m = &app->missed[i];
    PetscCall(Number_Private(n, "missed.", i, ".t", NULL, &m->t));
    PetscCall(Number_Private(n, "missed.", i, ".error", NULL, &m->error));
    PetscCall(Number_Private(n, "missed.", i, ".norm", NULL, &m->norm));
    PetscCall(Number_Private(n, "missed.", i, ".cause", &m->cause, NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PutLargest_Private(App *app)
{
  PetscInt   num;
  PetscReal *values;

  PetscFunctionBegin;
  PetscCall(EstimateStore(&app->largest, &num, &values));
  PetscCall(CheckpointPutValues(app->snapshot, num, values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetLargest_Private(App *app)
{
  PetscInt   num;
  PetscReal *values;

  PetscFunctionBegin;
  PetscCall(CheckpointGetValues(app->snapshot, &num, &values));
  if (num) PetscCall(EstimateLoad(app->level.accepted.num_leaves, num, values, &app->largest));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSnapshot(App *app)
{
  Numbers        n = {0};
  PetscLogDouble now;
  PetscReal      seconds[1 + NUM_STAGES];
  PetscInt       states = 0;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_OUTPUT));
  PetscCall(PetscTime(&now));
  seconds[NUM_STAGES] = now - app->start;
  for (PetscInt s = 0; s < NUM_STAGES; ++s) seconds[s] = StageSeconds((Stage)s);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 1 + NUM_STAGES, MPIU_REAL, MPI_MAX, app->comm));
  if (app->writer) PetscCall(WriterNumStates(app->writer, &states));
  PetscCall(Numbers_Private(app, &n));
  PetscReal exchanged = (PetscReal)app->exchanged, settled = (PetscReal)app->settled;
  PetscCall(Number_Private(&n, "", -1, "exchanged", NULL, &exchanged));
  PetscCall(Number_Private(&n, "", -1, "settled", NULL, &settled));
  PetscCall(Number_Private(&n, "", -1, "states", &states, NULL));
  PetscCall(Number_Private(&n, "", -1, "seconds", NULL, &seconds[NUM_STAGES]));
  for (PetscInt s = 0; s < NUM_STAGES; ++s) PetscCall(Number_Private(&n, "seconds.", -1, StageNames[s], NULL, &seconds[s]));
  PetscCall(CheckpointDestroy(&app->snapshot));
  PetscCall(CheckpointCreate(app->level.problem, &app->level.accepted, n.num, n.number, app->adapt_stop, &app->snapshot));
  PetscCall(PetscFree(n.number));
  if (app->largest.num_leaves) PetscCall(PutLargest_Private(app));
  const ForestTables *t  = ForestGetTables(app->level.forest);
  app->snapshot_revision = t->revision;
  app->written           = PETSC_FALSE;
  PetscCall(StageEnd(STAGE_OUTPUT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppCheckpoint(App *app)
{
  PetscFunctionBegin;
  if (app->written) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_OUTPUT));
  PetscCall(OutputHold(app->comm));
  PetscCall(CheckpointWrite(app->snapshot, app->checkpoint));
  PetscCall(StageEnd(STAGE_OUTPUT));
  app->written = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level of a checkpoint over the coarse mesh of a forest. */
static PetscErrorCode Level_Private(App *app, Checkpoint c, Forest coarse, Level *level)
{
  const int8_t *orders;
  PetscReal     t;
  Forest        forest;

  PetscFunctionBegin;
  PetscCall(CheckpointGetNumber(c, "t", &t));
  PetscCall(CheckpointForest(c, coarse, &forest));
  PetscCall(CheckpointOrders(c, &orders));
  PetscCall(LevelCreate(app->data, forest, orders, t, level));
  PetscCall(LevelCheck(app->data, level));
  PetscCall(CheckpointState(c, level->problem, &level->state));
  PetscCall(StateKeepOrigin(level->problem, &level->state));
  PetscCall(StateKeepFrom(level->problem, &level->state));
  PetscCall(StateCopy(&level->state, &level->accepted));
  const ForestTables *tables = ForestGetTables(forest);
  app->snapshot_revision     = tables->revision;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppStop(App *app)
{
  Level old = app->level;

  PetscFunctionBegin;
  PetscCall(AppCheckpoint(app));
  PetscCall(PetscSNPrintf(app->reason, sizeof(app->reason), "%s; -restart %s goes on", StopReason(), app->checkpoint));
  app->adapt_stop       = CheckpointNote(app->snapshot);
  const ForestTables *t = ForestGetTables(old.forest);
  if (t->revision == app->snapshot_revision) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Level_Private(app, app->snapshot, old.forest, &app->level)); /* the step that was given up had refined the mesh */
  PetscCall(LevelDestroy(&old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppForget(App *app)
{
  static const char *const tables[] = {"history.csv", "adapt.csv"}; /* a link, or a pipe, would be written */
  PetscMPIInt              rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  PetscCall(AppForgetSummary(app));
  if (rank == 0) (void)unlink(app->before);
  if (rank == 0) (void)unlink(app->checkpoint);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(tables) && rank == 0; ++i) {
    char path[PETSC_MAX_PATH_LEN];
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", app->data->output.directory, tables[i]));
    (void)unlink(path);
  }
  if (!app->data->output.fields) PetscCall(OutputForgetFields(app->comm, app->data->output.directory));
  PetscCall(OutputDropAside(app->comm, app->data->output.directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppForgetSummary(App *app)
{
  char        path[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/summary.json", app->data->output.directory));
  if (rank == 0) (void)unlink(path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppKeepLast(App *app)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  if (rank == 0 && !access(app->before, F_OK) && CheckpointIsWhole(app->checkpoint)) (void)unlink(app->before);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- going on --------------------------------------------------------------------------------------------------------------------- */

/* Check the checkpoint to go on from against scene and coarse mesh. Collective. */
static PetscErrorCode CheckCheckpoint_Private(App *app, Forest coarse)
{
  PetscReal t;

  PetscFunctionBegin;
  PetscCall(CheckpointCheck(app->snapshot, app->data, coarse));
  PetscCall(CheckpointGetNumber(app->snapshot, "t", &t));
  PetscCheckInput(!PetscIsInfOrNanReal(t), "-restart %s: it stands at t = %g", app->restart, (double)t);
  PetscCheckInput(t <= app->data->load.end, "-restart %s: it stands at t = %g, beyond load.end = %g", app->restart, (double)t, (double)app->data->load.end);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Orders of cells go on as they were: adaptation may have raised them, never below what the scene had asked for. */
static PetscErrorCode TellOrders_Private(const App *app)
{
  const State *s = &app->level.accepted;
  int8_t      *order;
  PetscBool    other = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(ProblemInitialOrders(app->data, app->level.forest, &order));
  for (PetscInt l = 0; l < s->num_leaves; ++l)
    other = (PetscBool)(other || s->leaf_order[l] < order[l] || (app->data->adapt.strategy == ADAPT_H && s->leaf_order[l] > order[l]));
  PetscCall(PetscFree(order));
  if (other) PetscCall(PetscPrintf(app->comm, "note: cells keep the orders that they have in %s, whatever the scene says of order now\n", app->restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppResume(App *app, Forest *coarse)
{
  const LoadSpec *load = &app->data->load;
  Numbers         n    = {0};
  PetscReal       value;

  PetscFunctionBegin;
  PetscCall(CheckCheckpoint_Private(app, *coarse));
  PetscCall(Level_Private(app, app->snapshot, *coarse, &app->level));
  PetscCall(ForestDestroy(coarse));
  PetscCall(GetLargest_Private(app));
  n.from = app->snapshot;
  PetscCall(Numbers_Private(app, &n));
  app->dt = PetscMax(PetscMin(app->dt, load->step_max), load->step_min);
  for (PetscInt s = 0; s < NUM_STAGES; ++s) {
    PetscCall(Number_Private(&n, "seconds.", -1, StageNames[s], NULL, &value));
    PetscCall(StageAdd((Stage)s, value));
  }
  PetscCall(CheckpointGetNumber(app->snapshot, "seconds", &value));
  app->start -= value;
  app->adapt_stop = CheckpointNote(app->snapshot);
  PetscCall(TellOrders_Private(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}
