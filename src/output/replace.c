/* Files replaced as a whole: the text goes to a temporary beside the file, which is then renamed over it. A reader, or a run that is killed,
   sees the old file or the new one, never half of either. */
#include "outputimpl.h"
#include <cjson/cJSON.h>
#include <errno.h>
#include <stdarg.h>
#include <unistd.h>

/* Append formatted text. Not collective. */
PetscErrorCode OutputTextPrint(OutputText *t, const char *format, ...)
{
  va_list args;
  int     length;

  PetscFunctionBegin;
  va_start(args, format);
  length = vsnprintf(NULL, 0, format, args);
  va_end(args);
  PetscCheck(length >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB, "vsnprintf failed on \"%s\"", format);
  if (t->used + (size_t)length + 1 > t->size) {
    t->size = 2 * (t->used + (size_t)length + 1);
    PetscCall(PetscRealloc(t->size, &t->text));
  }
  va_start(args, format);
  vsnprintf(t->text + t->used, (size_t)length + 1, format, args);
  va_end(args);
  t->used += (size_t)length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputTextDestroy(OutputText *t)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(t->text));
  t->used = t->size = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* errno of writing text to path by way of a temporary, 0 when all went well. */
static int Replace_Private(const char *path, const char *text)
{
  char   temporary[PETSC_MAX_PATH_LEN];
  size_t length = strlen(text);
  FILE  *file;
  int    failed;

  if (snprintf(temporary, sizeof(temporary), "%s.tmp", path) >= (int)sizeof(temporary)) return ENAMETOOLONG;
  (void)unlink(temporary); /* a link there would have another file written */
  errno = 0;
  if (!(file = fopen(temporary, "w"))) return errno ? errno : EIO;
  failed = fwrite(text, 1, length, file) != length;
  if (length && text[length - 1] != '\n') failed = fputc('\n', file) == EOF || failed; /* cJSON ends without */
  failed = fclose(file) != 0 || failed;                                                /* a full disk may show only here */
  if (!failed && rename(temporary, path) == 0) return 0;
  failed = errno ? errno : EIO;
  unlink(temporary);
  return failed;
}

PetscErrorCode OutputReplaceFile(MPI_Comm comm, const char *path, const char *text)
{
  PetscMPIInt rank;
  int         failed = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) failed = Replace_Private(path, text);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  PetscCheck(!failed, comm, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", path, strerror(failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bytes of names and values from elsewhere that are no UTF-8, which JSON has to be, become question marks. */
static void Clean_Private(char *text)
{
  for (unsigned char *c = (unsigned char *)text; *c;) {
    const int more = *c < 0x80 ? 0 : *c >= 0xc2 && *c < 0xe0 ? 1 : *c >= 0xe0 && *c < 0xf0 ? 2 : *c >= 0xf0 && *c < 0xf5 ? 3 : -1;
    int       k    = 1;
    while (k <= more && (c[k] & 0xc0) == 0x80) ++k;
    if (k <= more || more < 0)
      *c++ = '?';
    else
      c += more + 1;
  }
}

PetscErrorCode SummaryWrite(MPI_Comm comm, const char *path, const cJSON *document)
{
  PetscMPIInt rank;
  char       *text = NULL;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    text = cJSON_Print(document);
    PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_MEM, "Cannot print the document for %s", path);
    Clean_Private(text);
  }
  PetscCall(OutputReplaceFile(comm, path, text));
  cJSON_free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
