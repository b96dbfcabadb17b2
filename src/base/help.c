/* -help: its text, and rows of keys and options; or those rows alone that have a word in their name. */
#include "base.h"
#include <ctype.h>
#include <stdarg.h>

/* What -help asks for: rows with this in their name; "": everything. */
static const char *sought = "";
static PetscInt    shown;

/* Keys are a.b in a file and -a_b on the command line. */
static int Same_Private(char a, char b)
{
  const int x = a == '.' ? '_' : tolower((unsigned char)a), y = b == '.' ? '_' : tolower((unsigned char)b);

  return x == y;
}

static PetscBool IsSought_Private(const char *name)
{
  for (;; ++name) {
    size_t n = 0;
    while (sought[n] && name[n] && Same_Private(sought[n], name[n])) ++n;
    if (!sought[n]) return PETSC_TRUE;
    if (!*name) return PETSC_FALSE;
  }
}

void HelpSeek(const char *word)
{
  sought = word + strspn(word, "-");
  shown  = 0;
}

PetscInt HelpShown(void)
{
  return shown;
}

PetscErrorCode HelpText(MPI_Comm comm, const char *format, ...)
{
  char    text[4096];
  va_list arguments;

  PetscFunctionBegin;
  if (sought[0]) PetscFunctionReturn(PETSC_SUCCESS);
  va_start(arguments, format);
  (void)vsnprintf(text, sizeof(text), format, arguments);
  va_end(arguments);
  PetscCall(PetscPrintf(comm, "%s", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HelpRow(MPI_Comm comm, const char *name, const char *allowed, const char *text)
{
  PetscFunctionBegin;
  if (!IsSought_Private(name)) PetscFunctionReturn(PETSC_SUCCESS);
  ++shown;
  PetscCall(PetscPrintf(comm, "  %-39s %s\n  %-39s   %s\n", name, allowed, "", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
