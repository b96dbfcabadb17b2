/* csv tables, one row at a time: rank 0 writes, every row is flushed so that a run can be followed and survives a kill. */
#include "outputimpl.h"
#include <errno.h>

struct _p_Table {
  MPI_Comm comm;
  PetscInt n;                        /* columns */
  FILE    *file;                     /* owned; rank 0, else NULL */
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

/* Append values[n] (read on rank 0). Collective. */
PetscErrorCode TableRow(Table t, const PetscReal values[])
{
  int failed = 0;

  PetscFunctionBegin;
  if (t->file) {
    for (PetscInt i = 0; i < t->n; i++) fprintf(t->file, "%s%.12g", i ? "," : "", (double)values[i]);
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
