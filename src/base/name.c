/* Names of keys and options: lists of them, and how alike they are, for messages about those that are not known. */
#include "base.h"

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
