/* The results of a path of loads put aside, into a directory of their own, while the path is computed again on a finer mesh (adapt.repeat: path). A kill at any
   moment leaves them whole, or half moved and told by history.csv, which goes last: moving then goes on where it ended. */
#include "outputimpl.h"
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

/* Is it a file of this path's: not tables of all paths, not the checkpoint. */
static PetscBool IsOfPath_Private(const char *name)
{
  return (PetscBool)(!strcmp(name, "summary.json") || !strcmp(name, INDEX_TIMES) || !strcmp(name, INDEX_PASSES) || OutputStateNumber(name) >= 0);
}

/* from/name to to/name; to NULL: it goes. What is not there is no error. errno. */
static int Move_Private(const char *from, const char *name, const char *to)
{
  char source[PETSC_MAX_PATH_LEN], target[PETSC_MAX_PATH_LEN];
  int  failed;

  if (snprintf(source, sizeof(source), "%s/%s", from, name) >= (int)sizeof(source)) return ENAMETOOLONG;
  if (to && snprintf(target, sizeof(target), "%s/%s", to, name) >= (int)sizeof(target)) return ENAMETOOLONG;
  failed = to ? rename(source, target) : unlink(source);
  return failed && errno != ENOENT ? errno : 0;
}

/* All files of a path, history.csv last. errno. */
static int MoveAll_Private(const char *from, const char *to)
{
  DIR           *dir = opendir(from);
  struct dirent *entry;
  int            failed = 0;

  if (!dir) return errno == ENOENT ? 0 : errno;
  while (!failed && (entry = readdir(dir)))
    if (IsOfPath_Private(entry->d_name)) failed = Move_Private(from, entry->d_name, to);
  closedir(dir);
  return failed ? failed : Move_Private(from, "history.csv", to);
}

static int Drop_Private(const char *directory, const char *aside)
{
  const int failed = MoveAll_Private(aside, NULL);

  (void)directory;
  return failed ? failed : rmdir(aside) && errno != ENOENT && errno != ENOTEMPTY && errno != EEXIST ? errno : 0;
}

static int SetAside_Private(const char *directory, const char *aside)
{
  char        whole[PETSC_MAX_PATH_LEN];
  struct stat info;
  int         failed = 0;

  (void)snprintf(whole, sizeof(whole), "%s/history.csv", aside);
  if (!stat(whole, &info)) failed = Drop_Private(directory, aside);
  if (!failed && mkdir(aside, 0777) && errno != EEXIST) failed = errno;
  return failed ? failed : MoveAll_Private(directory, aside);
}

static PetscErrorCode Name_Private(const char *directory, char aside[PETSC_MAX_PATH_LEN])
{
  PetscFunctionBegin;
  PetscCheckInput(snprintf(aside, PETSC_MAX_PATH_LEN, "%s/" OUTPUT_ASIDE, directory) < PETSC_MAX_PATH_LEN, "output.directory: its name is too long");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One rank acts, all know whether it could. */
static PetscErrorCode Act_Private(MPI_Comm comm, const char *directory, int (*act)(const char *directory, const char *aside), const char *what)
{
  char        aside[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  int         failed = 0;

  PetscFunctionBegin;
  PetscCall(Name_Private(directory, aside));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) failed = act(directory, aside);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  PetscCheck(!failed, comm, PETSC_ERR_FILE_WRITE, "Cannot %s %s: %s", what, aside, strerror(failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSetAside(MPI_Comm comm, const char *directory)
{
  PetscFunctionBegin;
  PetscCall(Act_Private(comm, directory, SetAside_Private, "move results to"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputFinishAside(MPI_Comm comm, const char *directory, PetscInt path)
{
  char        table[2 * PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  PetscReal   number = NAN;

  PetscFunctionBegin;
  (void)snprintf(table, sizeof(table), "%s/history.csv", directory);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) PetscCall(TableFirst(table, "pass", &number));
  PetscCallMPI(MPI_Bcast(&number, 1, MPIU_REAL, 0, comm));
  if (number < path) PetscCall(OutputSetAside(comm, directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputDropAside(MPI_Comm comm, const char *directory)
{
  PetscFunctionBegin;
  PetscCall(Act_Private(comm, directory, Drop_Private, "remove"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputHasAside(MPI_Comm comm, const char *directory, PetscBool *has)
{
  char        aside[PETSC_MAX_PATH_LEN], whole[2 * PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;

  PetscFunctionBegin;
  *has = PETSC_FALSE;
  PetscCall(Name_Private(directory, aside));
  (void)snprintf(whole, sizeof(whole), "%s/history.csv", aside);
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) *has = (PetscBool)!access(whole, R_OK);
  PetscCallMPI(MPI_Bcast(has, 1, COMPAT_MPI_BOOL, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
