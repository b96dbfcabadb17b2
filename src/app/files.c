/* What a run leaves in output.directory, opened: afresh, or where a checkpoint goes on. */
#include "appimpl.h"
#include <unistd.h>

static const char *const Tables[] = {"history.csv", "adapt.csv"};

/* Fields to go on with. */
static PetscErrorCode ResumeFields_Private(App *app)
{
  PetscReal states;

  PetscFunctionBegin;
  PetscCall(CheckpointGetNumber(app->snapshot, "states", &states));
  if (app->data->output.fields && states > 0) PetscCall(WriterResume(app->comm, app->data->output.directory, app->load_steps, (PetscInt)states, &app->writer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Tables_Private(App *app)
{
  const TablePlace place = {.step = app->load_steps, .t = app->level.accepted.t, .path = app->data->adapt.repeat == REPEAT_PATH ? app->repeats : -1};

  PetscFunctionBegin;
  PetscCall(HistoryCreate(app->comm, app->data, app->probes, app->restart[0] ? &place : NULL, &app->history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The run goes on where its checkpoint is: is what it had left there as well? Results are its user's, so that it does. */
static PetscErrorCode TellLost_Private(App *app)
{
  const char *directory                   = app->data->output.directory;
  char        lost[2][PETSC_MAX_PATH_LEN] = {"", ""}; /* the first file, "" or "and others" */
  PetscReal   states                      = 0;
  PetscMPIInt rank;

  PetscFunctionBegin;
  if (strcmp(app->restart, app->checkpoint) && strcmp(app->restart, app->before)) PetscFunctionReturn(PETSC_SUCCESS);
  if (app->data->output.fields) PetscCall(CheckpointGetNumber(app->snapshot, "states", &states));
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  for (PetscInt i = 0; i < (PetscInt)states + (PetscInt)PETSC_STATIC_ARRAY_LENGTH(Tables) && rank == 0; ++i) {
    const PetscInt table = i - (PetscInt)states;
    char           name[32], path[PETSC_MAX_PATH_LEN];
    if (table < 0)
      PetscCall(PetscSNPrintf(name, sizeof(name), "fields_%04d.h5", (int)i));
    else
      PetscCall(PetscStrncpy(name, Tables[table], sizeof(name)));
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", directory, name));
    if (table < 0 ? OutputStateHas(path, "complete") > 0 : app->load_steps == 0 || !access(path, F_OK)) continue;
    PetscCall(PetscStrncpy(lost[lost[0][0] != 0], lost[0][0] ? " and others" : name, sizeof(lost[0])));
  }
  PetscCallMPI(MPI_Bcast(lost, (PetscMPIInt)sizeof(lost), MPI_CHAR, 0, app->comm));
  if (lost[0][0])
    PetscCall(WarningAdd(app->comm, "-restart: %s%s of the steps up to t = %.6g are not in %s, or not whole: the results lack them", lost[0], lost[1],
                         (double)app->level.accepted.t, directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppOpenFiles(App *app)
{
  PetscFunctionBegin;
  PetscCall(OutputDirectoryCreate(app->comm, app->data->output.directory));
  PetscCall(OutputLock(app->comm, app->data->output.directory, app->data->output.overwrite));
  PetscCall(OutputCheckForeign(app->comm, app->data->output.directory, app->data->output.overwrite));
  if (!app->restart[0]) PetscCall(AppForget(app)); /* what was there before goes first: no file of it is taken for this run's */
  if (app->restart[0] && app->repeats > 0 && app->load_steps == 0) PetscCall(OutputFinishAside(app->comm, app->data->output.directory, app->repeats));
  if (app->restart[0]) PetscCall(TellLost_Private(app));
  if (app->restart[0]) PetscCall(ResumeFields_Private(app));
  PetscCall(Tables_Private(app));
  if (app->data->output.fields && !app->writer) PetscCall(WriterCreate(app->comm, app->data->output.directory, &app->writer));
  if (app->restart[0]) PetscCall(AppForgetSummary(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppCheckFiles(App *app)
{
  PetscBool   there = PETSC_TRUE;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCall(OutputCheckForeign(app->comm, app->data->output.directory, app->data->output.overwrite));
  if (!app->restart[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ResumeFields_Private(app));
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Tables) && rank == 0; ++i) {
    char path[PETSC_MAX_PATH_LEN];
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", app->data->output.directory, Tables[i]));
    there = (PetscBool)(there && !access(path, F_OK));
  }
  PetscCallMPI(MPI_Bcast(&there, 1, COMPAT_MPI_BOOL, 0, app->comm));
  if (there) PetscCall(Tables_Private(app)); /* those that are not there would be made */
  PetscFunctionReturn(PETSC_SUCCESS);
}
