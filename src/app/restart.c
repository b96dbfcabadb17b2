/* Stopping and going on: a copy of the state at the end of every accepted load step, checkpoints of it, and the run that begins from one. */
#include "appimpl.h"
#include <unistd.h>

#define CHECKPOINT "checkpoint.h5"
#define AUTO "auto"

#define MODIFIER(i)                                                                                                                                            \
  {                                                                                                                                                            \
    "modifier_" #i, offsetof(App, modifiers) + (i) * sizeof(PetscInt)                                                                                          \
  }
static const struct {
  const char *name;
  size_t      at;
} Counters[] = {
    MODIFIER(0),
    MODIFIER(1),
    MODIFIER(2),
    MODIFIER(3),
    MODIFIER(4),
    MODIFIER(5),
    MODIFIER(6),
    MODIFIER(7),
    MODIFIER(8),
    MODIFIER(9),
    MODIFIER(10),
    MODIFIER(11),
    {"path", offsetof(App, path)},
    {"load_steps", offsetof(App, load_steps)},
    {"step_cuts", offsetof(App, step_cuts)},
    {"adapt_passes", offsetof(App, adapt_passes)},
    {"newton_iterations", offsetof(App, newton_iterations)},
    {"active_set_changes", offsetof(App, set_changes)},
    {"active_set_cycles", offsetof(App, set_cycles)},
    {"reported_cycles", offsetof(App, told_cycles)},
    {"factorisations", offsetof(App, factorisations)},
    {"single_factor_failures", offsetof(App, single_failures)},
    {"unstable", offsetof(App, unstable)},
    {"judged", offsetof(App, judged)},
    {"relaxed_steps", offsetof(App, relaxed_steps)},
    {"gave_up", offsetof(App, gave_up)},
};
static const struct {
  const char *name;
  size_t      at;
} Reals[] = {
    {"dt", offsetof(App, dt)},
    {"arc", offsetof(App, arc)},
    {"first_arc", offsetof(App, arc_first)},
    {"haste", offsetof(App, haste)},
    {"drag_work", offsetof(App, all_drag_work)},
    {"largest_displacement", offsetof(App, status.largest)},
    {"largest_error", offsetof(App, most.relative)},
    {"above_error", offsetof(App, above_error)},
};
enum {
  NUM_COUNTERS = PETSC_STATIC_ARRAY_LENGTH(Counters),
  NUM_REALS    = PETSC_STATIC_ARRAY_LENGTH(Reals),
  NUM_NUMBERS  = NUM_COUNTERS + NUM_REALS + 2 + NUM_STAGES
};

static PetscInt *Counter_Private(App *app, PetscInt i)
{
  return (PetscInt *)(void *)((char *)app + Counters[i].at);
}

static PetscReal *Real_Private(App *app, PetscInt i)
{
  return (PetscReal *)(void *)((char *)app + Reals[i].at);
}

/* ---- options ------------------------------------------------------------------------------------------------------------------- */

static const struct {
  const char *name, *allowed, *text;
} Options[] = {
    {"-restart", "FILE|" AUTO,
     "go on from a checkpoint of this scene, on any number of processes; " AUTO ": from " CHECKPOINT " in output.directory, from t = 0 when there is none"},
    {"-max_seconds", "a number above 0", "stop after this much wall time: a checkpoint, a summary, exit status 3"},
};

PetscErrorCode AppPrintHelp(MPI_Comm comm)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(comm, "\nOptions of the run, on the command line only.\n\n"));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Options); ++i) PetscCall(HelpRow(comm, Options[i].name, Options[i].allowed, Options[i].text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppOptions(App *app)
{
  char        text[64];
  char       *end     = text;
  PetscReal   seconds = 0;
  PetscBool   set, is_auto;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetString(NULL, NULL, Options[1].name, text, sizeof(text), &set));
  if (set) seconds = (PetscReal)strtod(text, &end);
  PetscCheckInput(!set || (end != text && !*end && seconds > 0), "%s is '%s'; allowed: %s", Options[1].name, text, Options[1].allowed);
  PetscCall(StopWatch(seconds));
  PetscCall(PetscOptionsGetString(NULL, NULL, Options[0].name, app->restart, sizeof(app->restart), &set));
  PetscCheckInput(!set || app->restart[0], "%s needs a file, or %s", Options[0].name, AUTO);
  PetscCall(PetscSNPrintf(app->checkpoint, sizeof(app->checkpoint), "%s/%s", app->data->output.directory, CHECKPOINT));
  PetscCall(PetscStrcmp(app->restart, AUTO, &is_auto));
  if (!is_auto) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrncpy(app->restart, app->checkpoint, sizeof(app->restart)));
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  if (rank == 0 && access(app->checkpoint, F_OK)) app->restart[0] = 0;
  PetscCallMPI(MPI_Bcast(app->restart, 1, MPI_CHAR, 0, app->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- copies and checkpoints ----------------------------------------------------------------------------------------------------- */

static void Number_Private(CheckpointNumber numbers[], PetscInt *num, const char *prefix, const char *name, PetscReal value)
{
  snprintf(numbers[*num].name, sizeof(numbers[0].name), "%s%s", prefix, name);
  numbers[(*num)++].value = value;
}

static PetscErrorCode PutMost_Private(App *app)
{
  PetscInt   num;
  PetscReal *values;

  PetscFunctionBegin;
  PetscCall(EstimateStore(&app->most, &num, &values));
  PetscCall(CheckpointPutValues(app->snapshot, num, values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GetMost_Private(App *app)
{
  PetscInt   num;
  PetscReal *values;

  PetscFunctionBegin;
  PetscCall(CheckpointGetValues(app->snapshot, &num, &values));
  if (num) PetscCall(EstimateLoad(app->level.accepted.num_leaves, num, values, &app->most));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppSnapshot(App *app)
{
  const PetscInt      num_contacts = app->data->num_contacts;
  CheckpointNumber   *numbers;
  char                pair[MORTISE_NAME];
  const ForestTables *t;
  PetscLogDouble      now;
  PetscReal           seconds[1 + NUM_STAGES];
  PetscInt            num = 0, states = 0;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_OUTPUT));
  PetscCall(PetscTime(&now));
  seconds[NUM_STAGES] = now - app->start;
  for (PetscInt s = 0; s < NUM_STAGES; ++s) seconds[s] = StageSeconds((Stage)s);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 1 + NUM_STAGES, MPIU_REAL, MPI_MAX, app->comm));
  if (app->writer) PetscCall(WriterNumStates(app->writer, &states));
  PetscCall(PetscMalloc1(NUM_NUMBERS + num_contacts, &numbers));
  for (PetscInt i = 0; i < NUM_COUNTERS; ++i) Number_Private(numbers, &num, "", Counters[i].name, (PetscReal)*Counter_Private(app, i));
  for (PetscInt i = 0; i < num_contacts; ++i) {
    PetscCall(PetscSNPrintf(pair, sizeof(pair), "%" PetscInt_FMT, i));
    Number_Private(numbers, &num, "subdivided.", pair, (PetscReal)app->subdivided[i]);
  }
  for (PetscInt i = 0; i < NUM_REALS; ++i) Number_Private(numbers, &num, "", Reals[i].name, *Real_Private(app, i));
  Number_Private(numbers, &num, "", "states", (PetscReal)states);
  Number_Private(numbers, &num, "", "seconds", seconds[NUM_STAGES]);
  for (PetscInt s = 0; s < NUM_STAGES; ++s) Number_Private(numbers, &num, "seconds.", StageNames[s], seconds[s]);
  PetscCall(CheckpointDestroy(&app->snapshot));
  PetscCall(CheckpointCreate(app->level.problem, &app->level.accepted, num, numbers, app->adapt_stop, &app->snapshot));
  PetscCall(PetscFree(numbers));
  if (app->most.num_leaves) PetscCall(PutMost_Private(app));
  PetscCall(ForestGetTables(app->level.forest, &t));
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
  PetscCall(CheckpointWrite(app->snapshot, app->checkpoint));
  PetscCall(StageEnd(STAGE_OUTPUT));
  app->written = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level of a checkpoint over the coarse mesh of a forest. */
static PetscErrorCode Level_Private(App *app, Checkpoint c, Forest coarse, Level *level)
{
  const ForestTables *tables;
  const int8_t       *orders;
  PetscReal           t;
  Forest              forest;

  PetscFunctionBegin;
  PetscCall(CheckpointGetNumber(c, "t", &t));
  PetscCall(CheckpointForest(c, coarse, &forest));
  PetscCall(CheckpointOrders(c, &orders));
  PetscCall(LevelCreate(app->data, forest, orders, t, level));
  PetscCall(LevelCheck(app->data, level));
  PetscCall(CheckpointState(c, level->problem, &level->state));
  PetscCall(StateCopy(&level->state, &level->accepted));
  PetscCall(ForestGetTables(forest, &tables));
  app->snapshot_revision = tables->revision;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppStop(App *app)
{
  const ForestTables *t;
  Level               old = app->level;

  PetscFunctionBegin;
  PetscCall(AppCheckpoint(app));
  PetscCall(PetscSNPrintf(app->reason, sizeof(app->reason), "%s; -restart %s goes on", StopReason(), app->checkpoint));
  app->adapt_stop = CheckpointNote(app->snapshot);
  PetscCall(ForestGetTables(old.forest, &t));
  if (t->revision == app->snapshot_revision) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Level_Private(app, app->snapshot, old.forest, &app->level)); /* the step that was given up had refined the mesh */
  PetscCall(LevelDestroy(&old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppForget(App *app)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  if (rank == 0) (void)unlink(app->checkpoint);
  PetscCall(OutputDropAside(app->comm, app->data->output.directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- going on --------------------------------------------------------------------------------------------------------------------- */

/* Read the checkpoint to go on from and check it against scene and coarse mesh. Collective. */
static PetscErrorCode Read_Private(App *app, Forest coarse)
{
  PetscReal t;

  PetscFunctionBegin;
  PetscCall(CheckpointRead(app->comm, app->restart, &app->snapshot));
  PetscCall(CheckpointCheck(app->snapshot, app->data, coarse));
  PetscCall(CheckpointGetNumber(app->snapshot, "t", &t));
  PetscCheckInput(t <= app->data->load.end, "-restart %s: it stands at t = %g, beyond load.end = %g", app->restart, (double)t, (double)app->data->load.end);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppResume(App *app, Forest *coarse)
{
  const LoadSpec *load = &app->data->load;
  char            name[MORTISE_NAME];
  PetscReal       value;

  PetscFunctionBegin;
  PetscCall(Read_Private(app, *coarse));
  PetscCall(Level_Private(app, app->snapshot, *coarse, &app->level));
  PetscCall(ForestDestroy(coarse));
  PetscCall(GetMost_Private(app));
  for (PetscInt i = 0; i < NUM_COUNTERS; ++i) {
    PetscCall(CheckpointGetNumber(app->snapshot, Counters[i].name, &value));
    *Counter_Private(app, i) = (PetscInt)value;
  }
  for (PetscInt i = 0; i < NUM_REALS; ++i) PetscCall(CheckpointGetNumber(app->snapshot, Reals[i].name, Real_Private(app, i)));
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "subdivided.%" PetscInt_FMT, i));
    PetscCall(CheckpointGetNumber(app->snapshot, name, &value));
    app->subdivided[i] = (PetscInt)value;
  }
  app->dt = PetscMax(PetscMin(app->dt, load->step_max), load->step_min);
  for (PetscInt s = 0; s < NUM_STAGES; ++s) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "seconds.%s", StageNames[s]));
    PetscCall(CheckpointGetNumber(app->snapshot, name, &value));
    PetscCall(StageAdd((Stage)s, value));
  }
  PetscCall(CheckpointGetNumber(app->snapshot, "seconds", &value));
  app->start -= value;
  app->adapt_stop = CheckpointNote(app->snapshot);
  PetscFunctionReturn(PETSC_SUCCESS);
}
