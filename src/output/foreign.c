/* What stands in the output directory under names that a run writes or removes, but was not made by one: such files are never replaced unasked. Each kind of
   ours is known by how it begins; a file of ours that was cut off by a kill or a full disk is empty at the worst. */
#include "outputimpl.h"
#include <dirent.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct {
  const char *name, *begins;
} Kinds[] = {
    {"summary.json", "{\n\t\"mortise\":"},
    {"history.csv", "step,t,dt,"},
    {"adapt.csv", "step,pass,t,"},
    {INDEX_TIMES, "<?xml version=\"1.0\"?>\n<Xdmf "},
    {INDEX_PASSES, "<?xml version=\"1.0\"?>\n<Xdmf "},
    {CHECKPOINT_FILE, "mortise checkpoint, "},
    {CHECKPOINT_BEFORE, "mortise checkpoint, "},
    {LOCK_FILE, LOCK_BEGINS},
};

PetscInt OutputStateNumber(const char *name)
{
  int  number;
  char same[32];

  if (sscanf(name, "fields_%d.h5", &number) != 1 || number < 0) return -1;
  (void)snprintf(same, sizeof(same), "fields_%04d.h5", number);
  return strcmp(name, same) ? -1 : number;
}

/* Is it one of our state files? One that was not closed cannot be opened: then the index beside it tells whose directory it is. */
static PetscBool IsState_Private(const char *path, PetscBool series)
{
  const int ours = OutputStateHas(path, "load_time");

  return ours < 0 ? series : (PetscBool)ours;
}

/* Does the file begin like that, as far as it goes? */
static PetscBool Begins_Private(const char *path, const char *begins)
{
  char   head[64] = "";
  FILE  *file     = fopen(path, "rb");
  size_t num;

  if (!file) return PETSC_FALSE;
  num = fread(head, 1, PetscMin(strlen(begins), sizeof(head) - 1), file);
  (void)fclose(file);
  return (PetscBool)!strncmp(head, begins, num);
}

static PetscBool IsForeign_Private(const char *path, const char *name, PetscBool series)
{
  struct stat info;

  if (lstat(path, &info)) return PETSC_FALSE;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Kinds); ++i) {
    if (!strcmp(name, Kinds[i].name)) return (PetscBool)(!S_ISREG(info.st_mode) || !Begins_Private(path, Kinds[i].begins));
  }
  return (PetscBool)(OutputStateNumber(name) >= 0 && (!S_ISREG(info.st_mode) || (info.st_size && !IsState_Private(path, series))));
}

PetscBool OutputIsOurs(const char *name)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Kinds); ++i) {
    if (!strcmp(name, Kinds[i].name)) return PETSC_TRUE;
  }
  return (PetscBool)(OutputStateNumber(name) >= 0);
}

PetscErrorCode OutputTellForeign(const char *directory, const char *name)
{
  return ErrorInput("output.directory %s: %s in it is no file of a run of mortise; give another directory, or output.overwrite: true to lose it", directory,
                    name);
}

PetscErrorCode OutputCheckForeign(MPI_Comm comm, const char *directory, PetscBool overwrite)
{
  char           path[2 * PETSC_MAX_PATH_LEN], found[3][256] = {"", "", ""}; /* no file of ours, one that may not be written, a directory */
  struct dirent *entry;
  struct stat    info;
  PetscMPIInt    rank;
  DIR           *dir = NULL;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) dir = opendir(directory);
  (void)snprintf(path, sizeof(path), "%s/" INDEX_TIMES, directory);
  const PetscBool series = (PetscBool)(dir && Begins_Private(path, Kinds[3].begins));
  while (dir && !found[0][0] && (entry = readdir(dir))) {
    (void)snprintf(path, sizeof(path), "%s/%s", directory, entry->d_name);
    if (!overwrite && IsForeign_Private(path, entry->d_name, series)) (void)snprintf(found[0], sizeof(found[0]), "%s", entry->d_name);
    if (OutputIsOurs(entry->d_name) && access(path, W_OK) && errno == EACCES) (void)snprintf(found[1], sizeof(found[1]), "%s", entry->d_name);
    if (OutputIsOurs(entry->d_name) && !lstat(path, &info) && S_ISDIR(info.st_mode)) (void)snprintf(found[2], sizeof(found[2]), "%s", entry->d_name);
  }
  if (dir) (void)closedir(dir);
  PetscCallMPI(MPI_Bcast(found, (PetscMPIInt)sizeof(found), MPI_CHAR, 0, comm));
  if (found[0][0]) PetscCall(OutputTellForeign(directory, found[0]));
  PetscCheckInput(!found[1][0], "output.directory %s: %s in it may not be written; give another directory", directory, found[1]);
  PetscCheckInput(!found[2][0], "output.directory %s: %s in it is a directory, where a run writes a file; give another one, or remove it", directory, found[2]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
