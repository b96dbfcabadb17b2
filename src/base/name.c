/* Names of keys and options: their rows of -help, lists of them, and how alike they are, for messages about those that are not known. */
#include "base.h"
#include <ctype.h>
#include <stdarg.h>

void TextAppend(size_t capacity, char text[], const char *more)
{
  const size_t used = strlen(text);

  (void)snprintf(text + used, capacity - used, "%s", more);
}

PetscInt NameDistance(const char *written, const char *name)
{
  PetscInt row[256], na = (PetscInt)strlen(written), nb = (PetscInt)strlen(name), least;

  if (na > 255 || nb > 255) return 1000;
  for (PetscInt j = 0; j <= nb; ++j) row[j] = j;
  for (PetscInt i = 1; i <= na; ++i) {
    PetscInt corner = row[0];
    row[0]          = i;
    for (PetscInt j = 1; j <= nb; ++j) {
      PetscInt up = row[j], change = corner + (written[i - 1] != name[j - 1]);
      row[j] = PetscMin(change, PetscMin(up, row[j - 1]) + 1);
      corner = up;
    }
  }
  least = row[nb];
  for (PetscInt j = 0; j < nb; ++j) least = PetscMin(least, row[j] + 2);
  return least;
}

const char *NameNearest(const char *name, PetscInt num, const char *const names[])
{
  const char *best     = "";
  PetscInt    distance = PETSC_MAX_INT;

  for (PetscInt i = 0; i < num; ++i) {
    PetscInt d = NameDistance(name, names[i]);
    if (d < distance) best = names[i], distance = d;
  }
  return best;
}

PetscBool TextIsPlain(const char *text, const char *allowed)
{
  for (const unsigned char *c = (const unsigned char *)text; *c; ++c) {
    if ((*c < ' ' || *c == 0x7f) && !strchr(allowed, *c)) return PETSC_FALSE;
    if (*c == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

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
