/* Does what we print reach a terminal? A launcher of MPI may give its ranks a terminal of its own that it reads and copies to wherever its own output goes: a
   file, a pipe, a real terminal. There the launcher's output decides. */
#include "diagnoseimpl.h"
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static int Launched_Private(void)
{
  return getenv("OMPI_COMM_WORLD_SIZE") || getenv("PMI_RANK"); /* not PMIX_RANK: MPI_Init sets it in a process of its own too */
}

/* Parent of a process, 0 when it cannot be told. */
static long Parent_Private(long pid)
{
  char  path[64], text[512], *end;
  FILE *file;
  long  parent = 0;

  (void)snprintf(path, sizeof(path), "/proc/%ld/stat", pid);
  file = fopen(path, "r");
  if (!file) return 0;
  text[fread(text, 1, sizeof(text) - 1, file)] = 0;
  (void)fclose(file);
  end = strrchr(text, ')'); /* the name in parentheses may contain anything */
  return end && sscanf(end + 1, " %*c %ld", &parent) == 1 ? parent : 0;
}

PetscBool DiagnoseIsTerminal(FILE *stream)
{
  struct stat mine, theirs;
  const char *kind = getenv("TERM");
  long        pid  = getppid();
  char        path[64];

  if (!isatty(fileno(stream)) || !kind || !strcmp(kind, "dumb") || fstat(fileno(stream), &mine)) return PETSC_FALSE;
  if (!Launched_Private()) return PETSC_TRUE;
  for (; pid > 1; pid = Parent_Private(pid)) { /* scripts between launcher and us share our terminal */
    (void)snprintf(path, sizeof(path), "/proc/%ld/fd/1", pid);
    if (stat(path, &theirs)) return PETSC_FALSE;
    if (theirs.st_rdev == mine.st_rdev && S_ISCHR(theirs.st_mode)) continue;
    const int       fd  = open(path, O_WRONLY | O_NOCTTY | O_NONBLOCK);
    const PetscBool yes = (PetscBool)(fd >= 0 && isatty(fd));
    if (fd >= 0) (void)close(fd);
    return yes;
  }
  return PETSC_FALSE;
}
