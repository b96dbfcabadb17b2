/* A .geo is a program: gmsh runs others for it, and writes files where it likes. Whoever solves a scene of somebody else's asks for neither, so these
   statements are refused. Names of included files that are put together at run time are not followed. */
#include "sceneimpl.h"
#include <ctype.h>

#define GEO_DEPTH 8 /* files that include each other */

static const char *const Programs[] = {"SystemCall", "NonBlockingSystemCall", "System", "OnelabRun"};

/* One file as it is read. */
typedef struct {
  const char *file;
  const char *at; /* in the text, which ends with 0 */
  int         line;
  char        word[64];                 /* the last one */
  char        name[PETSC_MAX_PATH_LEN]; /* the last string in quotes */
} Geo;

typedef enum { GEO_END, GEO_WORD, GEO_STRING, GEO_SIGN } GeoToken;

/* Pass over spaces and comments. */
static void Skip_Private(Geo *g)
{
  for (; *g->at; ++g->at) {
    if (g->at[0] == '/' && g->at[1] == '/') g->at += strcspn(g->at, "\n");
    if (g->at[0] == '/' && g->at[1] == '*') {
      for (g->at += 2; *g->at && (g->at[0] != '*' || g->at[1] != '/'); ++g->at) g->line += *g->at == '\n';
      if (*g->at) g->at += 2;
    }
    g->line += *g->at == '\n';
    if (!isspace((unsigned char)*g->at)) break;
  }
}

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
  if (*g->at != '"') {
    ++g->at;
    return GEO_SIGN;
  }
  n = strcspn(++g->at, "\"");
  (void)snprintf(g->name, sizeof(g->name), "%.*s", (int)n, g->at);
  for (size_t i = 0; i < n; ++i) g->line += g->at[i] == '\n';
  g->at += n + (g->at[n] == '"');
  return GEO_STRING;
}

/* Behind Printf: its arguments in parentheses; does what follows them lead to a file? */
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

static char *Text_Private(const char *file)
{
  FILE *f    = fopen(file, "rb");
  long  size = 0;
  char *text = NULL;

  if (f && !fseek(f, 0, SEEK_END)) size = ftell(f);
  if (f && size >= 0) text = (char *)calloc((size_t)size + 1, 1);
  if (text) rewind(f);
  if (text && fread(text, 1, (size_t)size, f) < (size_t)size) text[0] = 0;
  if (f) (void)fclose(f);
  return text;
}

static void File_Private(const char *file, int depth, size_t capacity, char message[])
{
  Geo   g    = {.file = file, .line = 1};
  char *text = depth < GEO_DEPTH ? Text_Private(file) : NULL, path[2 * PETSC_MAX_PATH_LEN];

  g.at = text ? text : "";
  for (GeoToken token = Next_Private(&g); token != GEO_END && !message[0]; token = Next_Private(&g)) {
    if (token != GEO_WORD) continue;
    for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Programs); ++i) {
      if (!strcmp(g.word, Programs[i]))
        (void)snprintf(message, capacity, "mesh.file %s:%d: %s calls a program, which is not done for a scene; mesh it with gmsh yourself and give the .msh",
                       file, g.line, g.word);
    }
    if (!strcmp(g.word, "Printf") && Redirects_Private(&g))
      (void)snprintf(message, capacity, "mesh.file %s:%d: Printf writes a file, which is not done for a scene; mesh it with gmsh yourself and give the .msh",
                     file, g.line);
    if ((strcmp(g.word, "Include") && strcmp(g.word, "Merge")) || Next_Private(&g) != GEO_STRING) continue;
    const char *slash = strrchr(file, '/');
    (void)snprintf(path, sizeof(path), "%.*s%s", g.name[0] == '/' || !slash ? 0 : (int)(slash + 1 - file), file, g.name);
    if (!message[0]) File_Private(path, depth + 1, capacity, message);
  }
  free(text);
}

void GeoCheck(const char *file, size_t capacity, char message[])
{
  message[0] = 0;
  File_Private(file, 0, capacity, message);
}
