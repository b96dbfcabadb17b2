/* csv tables, one row at a time: rank 0 writes, every row is flushed so that a run can be followed and survives a kill. */
#include "outputimpl.h"
#include <errno.h>
#include <unistd.h>

struct _p_Table {
  MPI_Comm comm;
  PetscInt n;                        /* columns */
  FILE    *file;                     /* owned; rank 0, else NULL */
  long     keep;                     /* bytes that stay; the rest goes when the next row comes. -1: all */
  char     path[PETSC_MAX_PATH_LEN]; /* for messages */
};

/* All ranks fail when rank 0's last write failed; failed is read on rank 0. Collective. */
static PetscErrorCode TableCheck_Private(Table t, int failed)
{
  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, t->comm));
  PetscCheck(!failed, t->comm, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", t->path, strerror(failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Open path afresh and write the line of column names. Collective. */
PetscErrorCode TableCreate(MPI_Comm comm, const char *path, PetscInt n, const char *const names[], Table *table)
{
  Table       t;
  PetscMPIInt rank;
  int         failed = 0;

  PetscFunctionBegin;
  PetscCheck(n > 0, comm, PETSC_ERR_ARG_OUTOFRANGE, "A table needs at least one column, not %" PetscInt_FMT, n);
  PetscCall(PetscNew(&t));
  t->comm = comm;
  t->n    = n;
  t->keep = -1;
  PetscCall(PetscStrncpy(t->path, path, sizeof(t->path)));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    t->file = fopen(path, "w");
    if (t->file) {
      for (PetscInt i = 0; i < n; i++) fprintf(t->file, "%s%s", i ? "," : "", names[i]);
      fputc('\n', t->file);
    }
    if (!t->file || fflush(t->file)) failed = errno ? errno : EIO;
  }
  *table = t;
  PetscCall(TableCheck_Private(t, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- a table that goes on ------------------------------------------------------------------------------------------------------ */

enum { TABLE_FITS, TABLE_ABSENT, TABLE_COLUMNS, TABLE_OTHER };

/* The line of names of a file is this one. */
static PetscBool SameNames_Private(FILE *file, PetscInt n, const char *const names[])
{
  for (PetscInt i = 0; i < n; ++i) {
    for (const char *c = names[i]; *c; ++c)
      if (fgetc(file) != *c) return PETSC_FALSE;
    if (fgetc(file) != (i + 1 < n ? ',' : '\n')) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The number in a column of a line. */
static double Column_Private(const char *line, PetscInt column)
{
  for (; column > 0 && line; --column) line = strchr(line, ',') ? strchr(line, ',') + 1 : NULL;
  return line ? strtod(line, NULL) : NAN;
}

/* The number of a column. */
static PetscInt Number_Private(PetscInt n, const char *const names[], const char *name)
{
  PetscInt i = 0;

  while (i + 1 < n && strcmp(names[i], name)) ++i;
  return i;
}

/* Where the rows up to a place end, and whether the last of them is of its step and at its time. A row without its end (the run was killed) is none.
 */
static int Find_Private(FILE *file, PetscInt n, const char *const names[], const TablePlace *place, long *keep)
{
  char  *line    = NULL;
  size_t size    = 0;
  double last[2] = {0, 0};

  if (!SameNames_Private(file, n, names)) return TABLE_COLUMNS;
  const PetscInt time = Number_Private(n, names, "t"), pass = Number_Private(n, names, "pass");
  *keep = ftell(file);
  while (getline(&line, &size, file) > 0 && strchr(line, '\n')) {
    const double path = place->path < 0 ? -1 : Column_Private(line, pass);
    if (path != place->path && !(place->earlier && path < place->path)) break;
    if (path == place->path && Column_Private(line, 0) > place->step) break;
    last[0] = path == place->path ? Column_Private(line, 0) : 0;
    last[1] = path == place->path ? Column_Private(line, time) : 0;
    *keep   = ftell(file);
  }
  free(line);
  if (last[0] != place->step || PetscAbsReal(last[1] - place->t) > 1e-11 * PetscAbsReal(place->t)) return TABLE_OTHER; /* written with 12 digits */
  return TABLE_FITS;
}

PetscErrorCode TableResume(MPI_Comm comm, const char *path, PetscInt n, const char *const names[], const TablePlace *place, Table *table)
{
  PetscMPIInt rank;
  FILE       *file    = NULL;
  long        keep    = -1;
  int         verdict = TABLE_ABSENT;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) file = fopen(path, "r+");
  if (file) verdict = Find_Private(file, n, names, place, &keep);
  PetscCallMPI(MPI_Bcast(&verdict, 1, MPI_INT, 0, comm));
  if (file && verdict != TABLE_FITS) fclose(file);
  PetscCheckInput(verdict != TABLE_COLUMNS, "-restart: %s has other columns than this scene; give another output.directory", path);
  PetscCheckInput(verdict != TABLE_OTHER,
                  "-restart: %s is not of the run that wrote the checkpoint, it has no row of step %" PetscInt_FMT
                  " at t = %.12g; give another output.directory",
                  path, place->step, (double)place->t);
  if (verdict == TABLE_ABSENT) {
    PetscCall(TableCreate(comm, path, n, names, table));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscNew(table));
  (*table)->comm = comm;
  (*table)->n    = n;
  (*table)->file = file;
  (*table)->keep = keep;
  PetscCall(PetscStrncpy((*table)->path, path, sizeof((*table)->path)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TableFirst(const char *path, const char *name, PetscReal *value)
{
  FILE  *file = fopen(path, "r");
  char  *line = NULL, *at;
  size_t size = 0;

  PetscFunctionBegin;
  *value = NAN;
  if (file && getline(&line, &size, file) > 0) {
    PetscInt column           = 0;
    line[strcspn(line, "\n")] = 0;
    for (at = strtok(line, ","); at && strcmp(at, name); at = strtok(NULL, ",")) ++column;
    if (at && getline(&line, &size, file) > 0 && strchr(line, '\n')) *value = (PetscReal)Column_Private(line, column);
  }
  free(line);
  if (file) fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Drop the rows after the point from which a table goes on. errno. */
static int Cut_Private(Table t)
{
  if (t->keep < 0) return 0;
  if (fseek(t->file, t->keep, SEEK_SET) || ftruncate(fileno(t->file), t->keep)) return errno;
  t->keep = -1;
  return 0;
}

/* Append values[n] (read on rank 0). Collective. */
PetscErrorCode TableRow(Table t, const PetscReal values[])
{
  int failed = 0;

  PetscFunctionBegin;
  if (t->file && !(failed = Cut_Private(t))) {
    for (PetscInt i = 0; i < t->n; i++) {
      if (i) fputc(',', t->file);
      if (!PetscIsNanReal(values[i])) fprintf(t->file, "%.15g", (double)values[i]);
    }
    fputc('\n', t->file);
    if (fflush(t->file)) failed = errno ? errno : EIO;
  }
  PetscCall(TableCheck_Private(t, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TableDestroy(Table *t)
{
  PetscFunctionBegin;
  if (!*t) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*t)->file) fclose((*t)->file);
  PetscCall(PetscFree(*t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
