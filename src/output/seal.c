/* The seal of a checkpoint: the first 512 bytes (HDF5's user block) tell whose file it is, its format, length and checksum. HDF5 is given files only whose seal
   holds: it is not made to read damaged ones. */
#include "outputimpl.h"
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

#define MAGIC "mortise checkpoint, format "

static void Text_Private(int format, int64_t length, uint64_t hash, char seal[CHECKPOINT_SEAL])
{
  memset(seal, 0, CHECKPOINT_SEAL);
  snprintf(seal, CHECKPOINT_SEAL, MAGIC "%d\n%lld bytes\nchecksum %016llx\n", format, (long long)length, (unsigned long long)hash);
}

/* Hash of everything behind the seal. Returns errno. */
static int Hash_Private(FILE *file, uint64_t *hash)
{
  char   buffer[1 << 16];
  size_t num;

  *hash = 0;
  if (fseek(file, CHECKPOINT_SEAL, SEEK_SET)) return errno;
  while ((num = fread(buffer, 1, sizeof(buffer), file)) > 0) *hash = HashBytes(*hash, buffer, num);
  return ferror(file) ? EIO : 0;
}

static int Write_Private(const char *path)
{
  FILE       *file = fopen(path, "r+");
  char        seal[CHECKPOINT_SEAL];
  struct stat info;
  uint64_t    hash;
  int         failed;

  if (!file) return errno;
  failed = fstat(fileno(file), &info) ? errno : Hash_Private(file, &hash);
  if (!failed) {
    Text_Private(CHECKPOINT_FORMAT, (int64_t)info.st_size, hash, seal);
    rewind(file);
    if (fwrite(seal, 1, sizeof(seal), file) != sizeof(seal) || fflush(file) || fsync(fileno(file))) failed = errno ? errno : EIO;
  }
  if (fclose(file) && !failed) failed = errno;
  return failed;
}

/* A second name for the file that is there, by way of a third: at no time is there no file before. A file system without such names goes without. */
static void Keep_Private(const char *path)
{
  const char *slash = strrchr(path, '/');
  char        before[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];

  if (snprintf(before, sizeof(before), "%.*s" CHECKPOINT_BEFORE, slash ? (int)(slash + 1 - path) : 0, path) >= (int)sizeof(before)) return;
  if (snprintf(temporary, sizeof(temporary), "%s.tmp", before) >= (int)sizeof(temporary)) return;
  (void)unlink(temporary);
  if (link(path, temporary)) return;
  (void)rename(temporary, before);
  (void)unlink(temporary); /* still there where both were the same file */
}

/* The file is on the disk before it gets its name; whether the name is matters less: until then the earlier file has it. */
int CheckpointSeal(const char *temporary, const char *path)
{
  const int failed = Write_Private(temporary);

  if (!failed) Keep_Private(path);
  return failed ? failed : rename(temporary, path) ? errno : 0;
}

enum { SEAL_HOLDS, SEAL_UNREADABLE, SEAL_FOREIGN, SEAL_FORMAT, SEAL_SHORT, SEAL_BROKEN };

/* What is wrong with an open file, and two numbers for the sentence that says so. */
static int Judge_Private(FILE *file, long long number[2])
{
  char         seal[CHECKPOINT_SEAL] = "", right[CHECKPOINT_SEAL];
  struct stat  info;
  uint64_t     hash;
  int          format, failed;
  const size_t got = fread(seal, 1, sizeof(seal), file), known = PetscMin(got, sizeof(MAGIC) - 1);

  if (fstat(fileno(file), &info) || ferror(file)) return number[0] = errno, SEAL_UNREADABLE;
  number[0] = (long long)info.st_size;
  number[1] = CHECKPOINT_SEAL;
  if (known == 0 || strncmp(seal, MAGIC, known)) return SEAL_FOREIGN;
  if (got < sizeof(seal)) return SEAL_SHORT;
  seal[sizeof(seal) - 1] = 0;
  if (sscanf(seal + sizeof(MAGIC) - 1, "%d\n%lld bytes", &format, &number[1]) != 2) return SEAL_BROKEN;
  if (format != CHECKPOINT_FORMAT) return number[0] = format, SEAL_FORMAT;
  if (number[0] < number[1]) return SEAL_SHORT;
  if (number[0] > number[1]) return SEAL_BROKEN; /* it may be any size */
  failed = Hash_Private(file, &hash);
  if (failed) return number[0] = failed, SEAL_UNREADABLE;
  Text_Private(format, (int64_t)info.st_size, hash, right);
  return memcmp(seal, right, sizeof(seal)) ? SEAL_BROKEN : SEAL_HOLDS;
}

/* NULL: errno tells why, 0 for a pipe or a device, of which the one would be waited for and the other has no end. */
static FILE *Open_Private(const char *path)
{
  struct stat info;

  if (stat(path, &info) || S_ISREG(info.st_mode) || S_ISDIR(info.st_mode)) return fopen(path, "r");
  errno = 0;
  return NULL;
}

PetscBool CheckpointIsWhole(const char *path)
{
  FILE     *file = Open_Private(path);
  long long unused[2];

  if (!file) return PETSC_FALSE;
  const PetscBool whole = (PetscBool)(Judge_Private(file, unused) == SEAL_HOLDS);
  fclose(file);
  return whole;
}

PetscErrorCode CheckpointVerify(MPI_Comm comm, const char *path)
{
  PetscMPIInt rank;
  long long   found[3] = {SEAL_UNREADABLE, 0, 0};

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    FILE *file = Open_Private(path);
    if (file) {
      found[0] = Judge_Private(file, found + 1);
      fclose(file);
    } else if (errno)
      found[1] = errno;
    else
      found[0] = SEAL_FOREIGN;
  }
  PetscCallMPI(MPI_Bcast(found, 3, MPI_LONG_LONG, 0, comm));
  PetscCheckInput(found[0] != SEAL_UNREADABLE, "-restart %s: the file cannot be read: %s", path, strerror((int)found[1]));
  PetscCheckInput(found[0] != SEAL_FOREIGN, "-restart %s: this is no checkpoint of mortise", path);
  PetscCheckInput(found[0] != SEAL_FORMAT, "-restart %s: a checkpoint of format %lld; this program reads format %d", path, found[1], CHECKPOINT_FORMAT);
  PetscCheckInput(found[0] != SEAL_SHORT, "-restart %s: the checkpoint is cut short, %lld of %lld bytes", path, found[1], found[2]);
  PetscCheckInput(found[0] != SEAL_BROKEN, "-restart %s: the checkpoint is damaged, its checksum is wrong", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}
