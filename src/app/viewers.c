/* Files of PETSc's viewers (-log_view :FILE, -solution_view, -ksp_monitor ascii:FILE, ...): PETSc opens them late, and truncates whatever is there. So before
   anything is meshed: they can be written, and are nobody else's. */
#include "appimpl.h"
#include <ctype.h>
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

/* Types of viewers whose value is type:file:format:mode; the first one is the type of a value without. */
static const char *const Types[] = {"", "ascii", "binary", "hdf5", "vtk", "exodusii", "matlab", "cgns", "pyvista"};
/* Those without files, and options whose value is nothing but a viewer. */
static const char *const Others[] = {"draw", "socket", "saws", "glvis"}, *const Views[] = {"log_view", "snes_view", "ksp_view"};
enum { FILE_FINE, FILE_NO_ROOM, FILE_OF_RUN, FILE_THERE };

static PetscBool IsSame_Private(const char *path, const struct stat *file)
{
  struct stat info;

  return (PetscBool)(!stat(path, &info) && info.st_dev == file->st_dev && info.st_ino == file->st_ino);
}

/* Is it one that the run reads, or a name in output.directory that it writes or removes? */
static PetscBool IsOfRun_Private(const App *app, const char *file, const char *directory)
{
  const char *const read[] = {app->data->file, SceneMeshFile(app->scene), app->restart};
  const char *const slash = strrchr(file, '/'), *const output = app->data->output.directory;
  struct stat info;

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(read) && !stat(file, &info); ++i)
    if (IsSame_Private(read[i], &info)) return PETSC_TRUE;
  if (!OutputIsOurs(slash ? slash + 1 : file)) return PETSC_FALSE;
  return (PetscBool)(!strcmp(directory, output) || (!stat(directory, &info) && IsSame_Private(output, &info)));
}

/* One of FILE_...; *error: why the file cannot be written. The output directory is there by the end of a run, not before solvers and their viewers are. */
static int Look_Private(const App *app, const char *name, const char *file, const char *directory, int *error)
{
  const PetscBool last = (PetscBool)(!strcmp(name, "log_view") || !strcmp(name, "solution_view"));
  struct stat     info;

  if (access(directory, W_OK | X_OK) && !(last && errno == ENOENT && !strcmp(directory, app->data->output.directory))) return *error = errno, FILE_NO_ROOM;
  if (IsOfRun_Private(app, file, directory)) return FILE_OF_RUN;
  if (stat(file, &info)) return FILE_FINE;
  if (S_ISDIR(info.st_mode)) return *error = EISDIR, FILE_NO_ROOM;
  return S_ISREG(info.st_mode) && !app->data->output.overwrite ? FILE_THERE : FILE_FINE;
}

static PetscErrorCode CheckFile_Private(const App *app, const char *name, const char *text, const char *file)
{
  char        directory[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  int         found[2] = {FILE_FINE, 0};

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(directory, file, sizeof(directory)));
  char *const slash = strrchr(directory, '/');
  if (!slash)
    PetscCall(PetscStrncpy(directory, ".", sizeof(directory)));
  else
    slash[slash == directory] = 0; /* the root keeps its own */
  PetscCallMPI(MPI_Comm_rank(app->comm, &rank));
  if (rank == 0) found[0] = Look_Private(app, name, file, directory, &found[1]);
  PetscCallMPI(MPI_Bcast(found, 2, MPI_INT, 0, app->comm));
  PetscCheckInput(found[0] != FILE_NO_ROOM, "-%s is '%s': %s cannot be written to: %s", name, text, found[1] == EISDIR ? file : directory, strerror(found[1]));
  PetscCheckInput(found[0] != FILE_OF_RUN, "-%s is '%s': the run itself reads or writes that file; give another name", name, text);
  PetscCheckInput(found[0] != FILE_THERE, "-%s is '%s': there is a file %s; give another name, or output.overwrite: true to lose it", name, text, file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsIn_Private(const char *word, size_t num, const char *const list[])
{
  for (size_t i = 0; i < num; ++i)
    if (!strcmp(word, list[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}
#define IsIn(word, list) IsIn_Private(word, PETSC_STATIC_ARRAY_LENGTH(list), list)

/* One option of PETSc; values of other kinds pass. */
static PetscErrorCode Check_Private(const App *app, const char *name, const char *text)
{
  char      copy[PETSC_MAX_PATH_LEN], *word[4] = {copy, copy, copy, copy}; /* type, file, format, mode */
  PetscBool known = PETSC_TRUE;
  PetscEnum number;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(copy, text, sizeof(copy)));
  for (int k = 1; k < 4 && (word[k] = strchr(word[k - 1], ':')); ++k) *word[k]++ = 0;
  const PetscBool file = IsIn(word[0], Types);
  PetscCheckInput(file || IsIn(word[0], Others) || !IsIn(name, Views), "an option of PETSc cannot act: -%s: there is no viewer %s", name, text);
  if (!file || !word[1] || !strcmp(name, "info")) PetscFunctionReturn(PETSC_SUCCESS); /* -info FILE:CLASSES is open by now */
  if (word[2] && word[2][0]) PetscCall(PetscEnumFind(PetscViewerFormats, word[2], &number, &known));
  PetscCheckInput(known, "-%s is '%s': '%s' is no format of PETSc's viewers, whose files are TYPE:FILE:FORMAT:MODE", name, text, word[2]);
  if (word[1][0]) PetscCall(CheckFile_Private(app, name, text, word[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All options of the database, as "-name value -name ...": those that PETSc has asked for already, as -log_view, too. */
PetscErrorCode AppCheckViewers(const App *app)
{
  char *all, *at, *next;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (at = all; at && *at; at = next) {
    for (next = strstr(at, " -"); next && !isalpha((unsigned char)next[2]);) next = strstr(next + 1, " -");
    if (next) *next++ = 0;
    char *const value = strchr(at, ' ');
    if (!value) continue;
    *value = 0;
    for (size_t n = strlen(value + 1); n > 0 && value[n] == ' ';) value[n--] = 0;
    PetscCall(Check_Private(app, at + 1, value + 1));
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
