/* Warnings of a run: told once each, on the screen at once and in summary.json at the end. */
#include "base.h"
#include <stdarg.h>

enum { MOST = 32, LENGTH = 512 };

static char     warning[MOST][LENGTH];
static PetscInt num_warnings;

PetscErrorCode WarningAdd(MPI_Comm comm, const char *format, ...)
{
  char    text[LENGTH];
  va_list arguments;

  PetscFunctionBegin;
  va_start(arguments, format);
  (void)vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  for (PetscInt i = 0; i < num_warnings; ++i) {
    if (!strcmp(warning[i], text)) PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (num_warnings == MOST) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(warning[num_warnings++], LENGTH, "%s", text);
  PetscCall(PetscPrintf(comm, "warning: %s\n", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void WarningForget(void)
{
  num_warnings = 0;
}

const char *WarningText(PetscInt i)
{
  return i < num_warnings ? warning[i] : NULL;
}
