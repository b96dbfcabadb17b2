/* Files of options that PETSc reads while it starts. One that names itself, by others or at once, would be read without end, and a quotation mark that is not
   closed would be left out: that is told beforehand. */
#include "appimpl.h"
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define BLANK " \t\r\n"

/* A file that is being read, and the one that named it. */
typedef struct _Reading {
  const struct _Reading *by;
  dev_t                  device;
  ino_t                  inode;
} Reading;

static PetscBool NamesItself_Private(const char *path, const Reading *by, char *told, size_t capacity);

/* Does a word begin with a quotation mark that the line does not close? */
static PetscBool IsOpen_Private(const char *line)
{
  for (line += strspn(line, BLANK); *line; line += strspn(line, BLANK)) {
    const char *const close = *line == '"' || *line == '\'' ? strchr(line + 1, *line) : line;
    if (!close) return PETSC_TRUE;
    line = close + strcspn(close, BLANK);
  }
  return PETSC_FALSE;
}

/* Is it a file in YAML, whose quotation marks may be closed in another line? */
static PetscBool IsYaml_Private(const char *path)
{
  const char *const end = strrchr(path, '.');

  return (PetscBool)(end && (!strcmp(end, ".yml") || !strcmp(end, ".yaml")));
}

/* Does a text of options lead to a file that names itself, or is wrong otherwise? told: how. */
static PetscBool Leads_Private(char *text, const Reading *by, char *told, size_t capacity)
{
  char     *at   = NULL;
  PetscBool file = PETSC_FALSE; /* the next word names one */

  for (const char *word = strtok_r(text, BLANK, &at); word; word = strtok_r(NULL, BLANK, &at)) {
    if (file && NamesItself_Private(word, by, told, capacity)) return PETSC_TRUE;
    file = (PetscBool)(!strcmp(word, "-options_file") || !strcmp(word, "-options_file_yaml") || !strcmp(word, "options_file:"));
  }
  return PETSC_FALSE;
}

/* PETSc says what is wrong with one that cannot be read. */
static PetscBool NamesItself_Private(const char *path, const Reading *by, char *told, size_t capacity)
{
  char       *line = NULL;
  size_t      room = 0;
  struct stat info;
  FILE       *file   = NULL;
  PetscBool   found  = PETSC_FALSE;
  int         number = 0;

  if (stat(path, &info) || !S_ISREG(info.st_mode)) return PETSC_FALSE;
  for (const Reading *r = by; r; r = r->by) {
    if (r->device != info.st_dev || r->inode != info.st_ino) continue;
    (void)snprintf(told, capacity, "%s names itself, so that reading it would not end", path);
    return PETSC_TRUE;
  }
  const Reading reading = {.by = by, .device = info.st_dev, .inode = info.st_ino};
  file                  = fopen(path, "r");
  while (file && !found && getline(&line, &room, file) >= 0) {
    ++number;
    line[strcspn(line, "#")] = 0;
    found                    = (PetscBool)(line[strspn(line, BLANK)] == '-' && !IsYaml_Private(path) && IsOpen_Private(line));
    if (found)
      (void)snprintf(told, capacity, "%s:%d: a quotation mark is not closed", path, number);
    else
      found = Leads_Private(line, &reading, told, capacity);
  }
  if (file) (void)fclose(file);
  free(line);
  return found;
}

PetscBool AppOptionsWrong(int argc, char **argv, size_t capacity, char told[])
{
  const char *const home = getenv("HOME"), *const given = getenv("PETSC_OPTIONS");
  char             *text      = given ? strdup(given) : NULL, of_home[PETSC_MAX_PATH_LEN];
  const char *const unasked[] = {of_home, ".petscrc", "petscrc"};
  PetscBool         found = PETSC_FALSE, skip = PETSC_FALSE;

  (void)snprintf(of_home, sizeof(of_home), "%s/.petscrc", home ? home : "");
  for (int i = 1; i < argc && !found; ++i) {
    skip = (PetscBool)(skip || !strcmp(argv[i], "-skip_petscrc"));
    if (i + 1 < argc && (!strcmp(argv[i], "-options_file") || !strcmp(argv[i], "-options_file_yaml")))
      found = NamesItself_Private(argv[i + 1], NULL, told, capacity);
  }
  if (text && !found) found = Leads_Private(text, NULL, told, capacity);
  for (int i = 0; i < 3 && !found && !skip; ++i) found = NamesItself_Private(unasked[i], NULL, told, capacity);
  free(text);
  return found;
}
