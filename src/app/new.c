/* `mortise new NAME`: NAME.yml and NAME.geo to start from, made from new.yml and new.geo beside this file (Makefile). */
#include "appimpl.h"
#include <errno.h>
#include <unistd.h>

#define MARK "@NAME@"

static const struct {
  const char *extension, *text;
} Files[] = {
    {
        ".yml",
#include "app/new.yml.inc"
    },
    {
        ".geo",
#include "app/new.geo.inc"
    },
};
enum { NUM_FILES = sizeof(Files) / sizeof(Files[0]) };

/* The text with the name for every mark; errno, 0 when it is written. */
static int Write_Private(const char *path, const char *text, const char *name)
{
  FILE       *file = fopen(path, "wx"); /* x: never what is there */
  const char *mark;

  if (!file) return errno;
  for (; (mark = strstr(text, MARK)); text = mark + strlen(MARK)) (void)fprintf(file, "%.*s%s", (int)(mark - text), text, name);
  (void)fputs(text, file);
  if (!fclose(file)) return 0;
  const int failed = errno;
  (void)unlink(path);
  return failed;
}

/* A name that scenes, gmsh and shells take as it is. */
static PetscBool IsName_Private(const char *name)
{
  return (PetscBool)(name[0] && name[0] != '-' && strlen(name) < MORTISE_NAME &&
                     strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-") == strlen(name));
}

PetscErrorCode AppNew(MPI_Comm comm, int num_names, char *const names[])
{
  const char *name = num_names ? names[0] : "";
  PetscMPIInt rank;
  char        path[NUM_FILES][MORTISE_NAME + 8];
  int         failed[2] = {0, 0}; /* errno; of which file */

  PetscFunctionBegin;
  PetscCheckInput(num_names < 2, "new: '%.80s' after '%.80s'; one scene has one name", names[1], name);
  PetscCheckInput(IsName_Private(name), "new: '%s' is no name for a scene; it needs letters, digits, _ and -, at most %d", name, MORTISE_NAME - 1);
  for (int i = 0; i < NUM_FILES; ++i) PetscCall(PetscSNPrintf(path[i], sizeof(path[i]), "%s%s", name, Files[i].extension));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  for (int i = 0; i < NUM_FILES && rank == 0 && !failed[0]; ++i) {
    if (access(path[i], F_OK) == 0) failed[0] = EEXIST, failed[1] = i;
  }
  for (int i = 0; i < NUM_FILES && rank == 0 && !failed[0]; ++i) {
    failed[0] = Write_Private(path[i], Files[i].text, name);
    failed[1] = i;
    for (int k = 0; k < i && failed[0]; ++k) (void)unlink(path[k]); /* one of them serves nobody */
  }
  PetscCallMPI(MPI_Bcast(failed, 2, MPI_INT, 0, comm));
  PetscCheckInput(!failed[0], "new: cannot write %s: %s", path[failed[1]], strerror(failed[0]));
  PetscCall(PetscPrintf(comm, "%s and %s are written; mortise %s solves the scene\n", path[0], path[1], path[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
