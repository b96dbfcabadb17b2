/* A .geo is a program: gmsh runs others for it, and writes files where it likes. Whoever solves a scene of somebody else's asks for neither, so statements that
   can do it are refused, unless mesh.trust is true. What is looked at must be all that gmsh will read: files put in by a name that is made at run time, and
   statements whose first word is, are refused too. */
#include "sceneimpl.h"
#include <ctype.h>
#include <sys/stat.h>
#include <unistd.h>

#define GEO_DEPTH 8 /* files that include each other */

/* Words, and what they do. As categories of options (`Print.Format`) and left of `=` they do no harm. */
static const char *const Harmful[][2] = {
    {"SystemCall", "calls a program"},
    {"NonBlockingSystemCall", "calls a program"},
    {"System", "calls a program"},
    {"OnelabRun", "calls a program"},
    {"Save", "writes a file"},
    {"ExternalProcess", "calls a program"},
    {"Print", "writes a file"},
    {"CreateDir", "makes a directory"},
    {"S2N", "makes a statement of a text"},
    {"StringToName", "makes a statement of a text"},
};
static const char *const Includes[] = {"Include", "Merge", "MergeWithBoundingBox", "ShapeFromFile"};
/* Files that gmsh takes for data, not for statements, by the ends of their names. */
static const char *const Data[] = {".msh", ".stl", ".step", ".stp", ".iges", ".igs", ".brep"};

/* One file as it is read. */
typedef struct {
  const char *file;
  const char *at; /* in the text, which ends with 0 */
  int         line;
  char        word[64];                 /* the last one */
  char        name[PETSC_MAX_PATH_LEN]; /* the last string in quotes */
} Geo;

typedef enum { GEO_END, GEO_WORD, GEO_STRING, GEO_SIGN } GeoToken;

/* Where the sentence goes, and how to get out of it. */
typedef struct {
  size_t capacity;
  char  *text; /* "": nothing found yet */
} Found;

static void Tell_Private(const Geo *g, Found *found, const char *what, const char *does)
{
  if (!found->text[0])
    (void)snprintf(found->text, found->capacity, "mesh.file %.1000s:%d: %s %s, which is not done for a scene unless it says mesh.trust: true", g->file, g->line,
                   what, does);
}

/* Pass over spaces and comments. */
static void Skip_Private(Geo *g)
{
  for (;;) {
    if (g->at[0] == '/' && g->at[1] == '/')
      g->at += strcspn(g->at, "\n");
    else if (g->at[0] == '/' && g->at[1] == '*') {
      for (g->at += 2; *g->at && (g->at[0] != '*' || g->at[1] != '/'); ++g->at) g->line += *g->at == '\n';
      if (*g->at) g->at += 2;
    } else if (isspace((unsigned char)*g->at))
      g->line += *g->at++ == '\n';
    else
      return;
  }
}

/* Strings stand in quotes of either kind and know no escapes. */
static GeoToken Next_Private(Geo *g)
{
  size_t n = 0;

  Skip_Private(g);
  if (!*g->at) return GEO_END;
  if (isalpha((unsigned char)*g->at) || *g->at == '_') {
    while (isalnum((unsigned char)g->at[n]) || g->at[n] == '_') ++n;
    (void)snprintf(g->word, sizeof(g->word), "%.*s", (int)n, g->at);
    g->at += n;
    return GEO_WORD;
  }
  const char quote[2] = {*g->at++, 0};
  if (quote[0] != '"' && quote[0] != '\'') return GEO_SIGN;
  n = strcspn(g->at, quote);
  (void)snprintf(g->name, sizeof(g->name), "%.*s", (int)n, g->at);
  for (size_t i = 0; i < n; ++i) g->line += g->at[i] == '\n';
  g->at += n + (g->at[n] != 0);
  return GEO_STRING;
}

/* Behind Printf or Error: its arguments in parentheses; does what follows them lead to a file? */
static PetscBool Redirects_Private(Geo *g)
{
  int open = 0;

  do {
    const GeoToken token = Next_Private(g);
    if (token == GEO_END) return PETSC_FALSE;
    if (token == GEO_SIGN) open += g->at[-1] == '(' ? 1 : g->at[-1] == ')' ? -1 : 0;
  } while (open > 0);
  Skip_Private(g);
  return (PetscBool)(*g->at == '>');
}

static PetscBool IsOneOf_Private(const char *word, size_t num, const char *const words[])
{
  for (size_t i = 0; i < num; ++i) {
    if (!strcmp(word, words[i])) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscBool IsData_Private(const char *name)
{
  const char *dot = strrchr(name, '.');

  return (PetscBool)(dot && IsOneOf_Private(dot, PETSC_STATIC_ARRAY_LENGTH(Data), Data));
}

static char *Text_Private(const char *file, size_t *length)
{
  struct stat info;
  FILE       *f    = stat(file, &info) || !S_ISREG(info.st_mode) ? NULL : fopen(file, "rb"); /* a pipe would be waited for */
  long        size = 0;
  char       *text = NULL;

  *length = 0;
  if (f && !fseek(f, 0, SEEK_END)) size = ftell(f);
  if (f && size >= 0) text = (char *)calloc((size_t)size + 1, 1);
  if (text) rewind(f);
  if (text) *length = fread(text, 1, (size_t)size, f);
  if (f) (void)fclose(f);
  return text;
}

static void File_Private(const char *file, int depth, Found *found);

/* Behind the word that includes a file. */
static void Include_Private(Geo *g, int depth, Found *found)
{
  char        path[2 * PETSC_MAX_PATH_LEN], word[sizeof(g->word)];
  const char *slash = strrchr(g->file, '/');

  (void)snprintf(word, sizeof(word), "%s", g->word);
  Skip_Private(g);
  if (*g->at == '(') ++g->at; /* ShapeFromFile("name") */
  if (Next_Private(g) != GEO_STRING) {
    Tell_Private(g, found, word, "takes a file by a name that is made at run time");
    return;
  }
  (void)snprintf(path, sizeof(path), "%.*s%s", g->name[0] == '/' || !slash ? 0 : (int)(slash + 1 - g->file), g->file, g->name);
  if (!IsData_Private(path)) File_Private(path, depth + 1, found);
}

/* The statement that begins with the last word. */
static void Statement_Private(Geo *g, int depth, Found *found)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Harmful); ++i) {
    if (strcmp(g->word, Harmful[i][0])) continue;
    Skip_Private(g);
    if (*g->at != '.' && *g->at != '=') Tell_Private(g, found, Harmful[i][0], Harmful[i][1]);
    return;
  }
  if (!strcmp(g->word, "Printf") || !strcmp(g->word, "Error")) {
    const Geo at = *g;
    if (Redirects_Private(g)) Tell_Private(&at, found, at.word, "writes a file");
  } else if (IsOneOf_Private(g->word, PETSC_STATIC_ARRAY_LENGTH(Includes), Includes))
    Include_Private(g, depth, found);
}

/* gmsh leaves out statements of a last line that no line break ends. */
static void LastLine_Private(const char *file, const char *text, Found *found)
{
  const char *last = strrchr(text, '\n');

  last = last ? last + 1 : text;
  last += strspn(last, " \t\r");
  if (!*last || (last[0] == '/' && last[1] == '/') || found->text[0]) return;
  (void)snprintf(found->text, found->capacity, "mesh.file %.1000s: its last line, '%.40s', needs a line break at its end: gmsh would leave it out", file, last);
}

static void File_Private(const char *file, int depth, Found *found)
{
  Geo    g = {.file = file, .line = 1};
  size_t length;
  char  *text = depth < GEO_DEPTH ? Text_Private(file, &length) : NULL;

  if (depth == GEO_DEPTH) Tell_Private(&g, found, "this", "is included too deep");
  if (!text && !access(file, F_OK)) Tell_Private(&g, found, "this", "is no file that could be read here");
  g.at = text ? text : "";
  if (text && strlen(text) < length) Tell_Private(&g, found, "this", "is no text: it has a zero byte in it");
  while (!found->text[0]) {
    const GeoToken token = Next_Private(&g);
    if (token == GEO_END) break;
    if (token == GEO_WORD) Statement_Private(&g, depth, found);
  }
  if (text) LastLine_Private(file, text, found);
  free(text);
}

void GeoCheck(const char *file, size_t capacity, char message[])
{
  Found found = {.capacity = capacity, .text = message};
  char  options[PETSC_MAX_PATH_LEN + 8];

  message[0] = 0;
  File_Private(file, 0, &found);
  (void)snprintf(options, sizeof(options), "%s.opt", file); /* gmsh reads it too */
  if (!access(options, F_OK)) File_Private(options, 0, &found);
}
