/* One run a directory. All processes of a run hold a shared lock on DIRECTORY/lock from before its first write to its end, in which stands whose it is; who
   comes asks for it alone, and is told of the other. The system gives the lock back with the last process, so neither a run that was killed nor its processes
   that have not noticed yet can disturb the next one. Where the file system knows no locks, the number of the process decides. It belongs to the process, so it
   is global, and given back however the process ends. */
#include "outputimpl.h"
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct {
  char host[256];
  int  pid;
} Holder;

static char  path[PETSC_MAX_PATH_LEN]; /* of the lock that is held, "": none */
static int   held = -1;                /* the open file */
static pid_t owner;                    /* who takes it away again: the first process; else 0 */

enum { LOCK_TAKEN, LOCK_OTHERS, LOCK_FAILED, LOCK_FOREIGN };

/* Who is in the file; pid 0: nobody. */
static Holder Read_Private(int file)
{
  char          text[512];
  Holder        h   = {"", 0};
  const ssize_t num = pread(file, text, sizeof(text) - 1, 0);

  text[num > 0 ? num : 0] = 0;
  if (sscanf(text, LOCK_BEGINS "%d on %255s", &h.pid, h.host) != 2) h.pid = 0;
  return h;
}

static Holder Me_Private(void)
{
  Holder h = {"", (int)getpid()};

  if (gethostname(h.host, sizeof(h.host) - 1)) (void)snprintf(h.host, sizeof(h.host), "unknown");
  return h;
}

/* Has the process of that number ended, though nobody has asked how? Then its number is still taken. */
static PetscBool HasEnded_Private(int pid)
{
  char  path_of[64], line[512] = "";
  FILE *file;

  (void)snprintf(path_of, sizeof(path_of), "/proc/%d/stat", pid);
  file = fopen(path_of, "r");
  if (!file) return PETSC_FALSE;
  const char *name = fgets(line, sizeof(line), file) ? strrchr(line, ')') : NULL; /* number (name) state */
  (void)fclose(file);
  return (PetscBool)(name && name[1] == ' ' && name[2] == 'Z');
}

/* Does a process of this machine have that number? Of other machines: yes. */
static PetscBool Lives_Private(const Holder *h)
{
  const Holder me = Me_Private();

  if (h->pid <= 0) return PETSC_FALSE;
  return (PetscBool)(strcmp(h->host, me.host) || (h->pid != me.pid && (!kill(h->pid, 0) || errno == EPERM) && !HasEnded_Private(h->pid)));
}

/* The lock on an open file; 0, EWOULDBLOCK when others have it. Where there are no locks who is in the file decides. */
static int Flock_Private(int file, int kind)
{
  if (!flock(file, kind | LOCK_NB)) return 0;
  if (errno == EWOULDBLOCK) return EWOULDBLOCK;
  const Holder h = Read_Private(file);
  return Lives_Private(&h) ? EWOULDBLOCK : 0;
}

/* Is it still the file of that name? Else its run has just ended, and taken the file away. */
static PetscBool Stands_Private(int file)
{
  struct stat mine, there;

  return (PetscBool)(!fstat(file, &mine) && !stat(path, &there) && mine.st_ino == there.st_ino && mine.st_dev == there.st_dev);
}

/* Has somebody else put a file of that name there? One of ours that was cut off by a full disk begins as far as it goes. */
static PetscBool IsForeign_Private(int file)
{
  char          text[sizeof(LOCK_BEGINS)];
  const ssize_t num = pread(file, text, sizeof(LOCK_BEGINS) - 1, 0);

  return (PetscBool)(num > 0 && strncmp(text, LOCK_BEGINS, (size_t)num));
}

/* The file, made where there is none; not by way of a link. -1: errno tells why. */
static int Open_Private(PetscBool overwrite)
{
  int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);

  if (file >= 0 && IsForeign_Private(file)) {
    (void)close(file);
    file  = -1;
    errno = ELOOP;
  }
  if (file < 0 && errno == ELOOP && overwrite && !unlink(path)) file = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  return file;
}

/* The first process: alone for a moment, in which it writes who it is. *other: who had it before, or has it; number: errno of a failure. */
static int First_Private(PetscBool overwrite, Holder *other, int *number)
{
  const Holder me     = Me_Private();
  int          failed = 0;

  for (int attempt = 0; attempt < 10; ++attempt) {
    held = Open_Private(overwrite);
    if (held < 0) return *number = errno, errno == ELOOP ? LOCK_FOREIGN : LOCK_FAILED;
    failed = Flock_Private(held, LOCK_EX);
    if (failed) (void)flock(held, LOCK_SH); /* who has it for itself is writing its name: a moment */
    *other = Read_Private(held);
    if (failed) return LOCK_OTHERS;
    if (Stands_Private(held)) break;
    (void)close(held);
    held = -1;
  }
  if (held < 0) return *number = EAGAIN, LOCK_FAILED;
  owner = getpid();
  if (ftruncate(held, 0) || dprintf(held, LOCK_BEGINS "%d on %s\n", me.pid, me.host) < 0) return *number = errno, LOCK_FAILED;
  (void)flock(held, LOCK_SH | LOCK_NB); /* from now on with the others */
  return LOCK_TAKEN;
}

/* The others, once the first one has it. */
static int Join_Private(int *number)
{
  held = open(path, O_RDWR | O_CLOEXEC);
  if (held < 0) return *number = errno, LOCK_FAILED;
  return flock(held, LOCK_SH | LOCK_NB) && errno == EWOULDBLOCK ? LOCK_OTHERS : LOCK_TAKEN;
}

PetscErrorCode OutputLock(MPI_Comm comm, const char *directory, PetscBool overwrite)
{
  struct {
    int    verdict, number;
    Holder other;
  } found = {LOCK_TAKEN, 0, {"", 0}};
  PetscMPIInt rank;
  int         verdict;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCheckInput(snprintf(path, sizeof(path), "%s/" LOCK_FILE, directory) < (int)sizeof(path), "output.directory: its name is too long");
  if (rank == 0) found.verdict = First_Private(overwrite, &found.other, &found.number);
  PetscCallMPI(MPI_Bcast(&found, (PetscMPIInt)sizeof(found), MPI_CHAR, 0, comm));
  const int first = found.verdict;
  if (rank && found.verdict == LOCK_TAKEN) found.verdict = Join_Private(&found.number);
  PetscCallMPI(MPI_Allreduce(&found.verdict, &verdict, 1, MPI_INT, MPI_MAX, comm));
  if (verdict != LOCK_TAKEN) OutputUnlock();
  PetscCheckInput(verdict != LOCK_FAILED || first != LOCK_TAKEN,
                  "output.directory %s: not all processes see it; it has to be on a file system that they share, under the same name", directory);
  PetscCheckInput(verdict != LOCK_FAILED, "output.directory: %s cannot be made: %s", path, strerror(found.number));
  if (verdict == LOCK_FOREIGN) PetscCall(OutputTellForeign(directory, LOCK_FILE));
  PetscCheckInput(verdict != LOCK_OTHERS || found.other.pid,
                  "output.directory %s: another run is about to write there; give another directory, or wait for its end", directory);
  PetscCheckInput(verdict != LOCK_OTHERS, "output.directory %s: %s process %d on %s, writes there; give another directory, or wait for its end", directory,
                  Lives_Private(&found.other) ? "another run," : "what is left of a run,", found.other.pid, found.other.host);
  if (found.other.pid)
    PetscCall(PetscPrintf(comm, "note: the run before in %s, process %d on %s, did not come to its end\n", directory, found.other.pid, found.other.host));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputHold(MPI_Comm comm)
{
  int gone;

  PetscFunctionBegin;
  gone = held >= 0 && owner == getpid() && !Stands_Private(held);
  PetscCallMPI(MPI_Bcast(&gone, 1, MPI_INT, 0, comm));
  PetscCheck(!gone, comm, PETSC_ERR_FILE_WRITE, "Nothing more is written: %s, the mark of this run, was taken away", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void OutputUnlock(void)
{
  if (held >= 0 && owner == getpid() && Stands_Private(held)) (void)unlink(path);
  if (held >= 0) (void)close(held);
  held  = -1;
  owner = 0;
}
