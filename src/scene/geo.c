/* A .geo is a program: gmsh runs others for it, and writes files where it likes. Whoever solves a scene of somebody else's asks for neither, so statements that
   can do it are refused, unless mesh.trust is true. What is looked at must be all that gmsh will read: files put in by a name that is made at run time, and
   statements whose first word is, are refused too; of files that are merged only kinds are let through of which is known what gmsh does with them. */
#include "sceneimpl.h"
#include <ctype.h>
#include <sys/stat.h>
#include <unistd.h>

#define GEO_DEPTH 8     /* files that include each other */
#define GEO_STRING 1023 /* characters at most; gmsh reads on behind them as if the string had ended */

/* Words, what they do, and the signs behind them with which they do it; a text behind them (a string, a variable's name) is such a sign for all of them. */
static const char *const Harmful[][3] = {
    {"SystemCall", "calls a program", "("},
    {"NonBlockingSystemCall", "calls a program", "("},
    {"System", "calls a program", "("},
    {"OnelabRun", "calls a program", "("},
    {"Save", "writes a file", "("},
    {"ExternalProcess", "calls a program", ";"},
    {"Print", "writes a file", "("},
    {"CreateDir", "makes a directory", "("},
    {"S2N", "makes a statement of a text", "[("},
    {"StringToName", "makes a statement of a text", "[("},
    {"Plugin", "may write a file", "("},
    {"Solver", "sets a program to call", ".[("},
};
static const char *const Includes[] = {"Include", "Merge", "MergeWithBoundingBox", "ShapeFromFile"};
static const char *const Printing[] = {"Printf", "Error"}; /* may lead to a file */
/* Kinds of files that are merged, by the ends of their names, which gmsh knows in these letters only. */
static const char *const Scripts[] = {".geo", ".pos", ".opt"};
static const char *const Data[]    = {".stl", ".STL", ".step", ".STEP", ".stp", ".STP", ".iges", ".IGES", ".igs", ".IGS", ".brep"};

/* One file as it is read. */
typedef struct {
  const char *file;
  const char *at; /* in the text, which ends with 0 */
  int         line;
  char        word[64];                 /* the last one */
  char        name[PETSC_MAX_PATH_LEN]; /* the last string in quotes */
} Geo;

typedef enum { GEO_END, GEO_WORD, GEO_TEXT, GEO_LONG, GEO_SIGN } GeoToken;

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

/* Where the comment ends that begins here, or here. */
static const char *CommentEnd_Private(const char *at)
{
  const char *end;

  if (at[0] == '/' && at[1] == '/') return at + strcspn(at, "\n");
  if (at[0] != '/' || at[1] != '*') return at;
  end = strstr(at + 2, "*/");
  return end ? end + 2 : at + strlen(at);
}

/* Strings stand in quotes of either kind and know no escapes. */
static const char *StringEnd_Private(const char *at)
{
  const char quote[2] = {*at, 0};

  if (*at != '"' && *at != '\'') return at;
  at += 1 + strcspn(at + 1, quote);
  return at + (*at != 0);
}

static void Pass_Private(Geo *g, const char *end)
{
  for (; g->at < end; ++g->at) g->line += *g->at == '\n';
}

/* Pass over spaces and comments. */
static void Skip_Private(Geo *g)
{
  const char *from;

  do {
    from = g->at;
    Pass_Private(g, from + strspn(from, " \t\n\r\f\v"));
    Pass_Private(g, CommentEnd_Private(g->at));
  } while (g->at != from);
}

static size_t WordLength_Private(const char *at)
{
  size_t n = 0;

  while (isalnum((unsigned char)at[n]) || at[n] == '_') ++n;
  return n;
}

static GeoToken Next_Private(Geo *g)
{
  const char *end;
  size_t      n;

  Skip_Private(g);
  if (!*g->at) return GEO_END;
  n = isdigit((unsigned char)*g->at) ? 0 : WordLength_Private(g->at);
  if (n) {
    (void)snprintf(g->word, sizeof(g->word), "%.*s", (int)PetscMin(n, sizeof(g->word)), g->at);
    g->at += n;
    return GEO_WORD;
  }
  end = StringEnd_Private(g->at);
  n   = (size_t)(end - g->at);
  if (n < 2) g->at += 1;
  if (n < 2) return GEO_SIGN;
  (void)snprintf(g->name, sizeof(g->name), "%.*s", (int)PetscMin(n - 2, sizeof(g->name)), g->at + 1);
  Pass_Private(g, end);
  return n - 2 > GEO_STRING ? GEO_LONG : GEO_TEXT;
}

static PetscBool IsSign_Private(const Geo *g, GeoToken token, const char *signs)
{
  return (PetscBool)(token == GEO_SIGN && strchr(signs, g->at[-1]));
}

/* Behind a word: does it act, on a text or with one of the signs? A word before `In` is the variable of a loop. */
static PetscBool Acts_Private(Geo g, const char *signs)
{
  const GeoToken token = Next_Private(&g);

  if (token == GEO_WORD) return (PetscBool)(strcmp(g.word, "In") != 0);
  return (PetscBool)(token == GEO_TEXT || token == GEO_LONG || IsSign_Private(&g, token, signs));
}

static PetscBool IsOneOf_Private(const char *word, size_t num, const char *const words[])
{
  for (size_t i = 0; i < num; ++i) {
    if (!strcmp(word, words[i])) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Behind Printf or Error: its arguments in parentheses, in which the statement does not end and no other begins. What it does that it should not, or NULL. */
static const char *Redirects_Private(Geo g)
{
  int open = 0;

  do {
    const GeoToken token = Next_Private(&g);
    if (token == GEO_END || IsSign_Private(&g, token, ";")) return NULL;
    if (token == GEO_WORD && IsOneOf_Private(g.word, PETSC_STATIC_ARRAY_LENGTH(Printing), Printing)) return NULL;
    if (token == GEO_LONG) return "has a string of more than 1023 characters";
    open += IsSign_Private(&g, token, "(") - IsSign_Private(&g, token, ")");
  } while (open > 0);
  Skip_Private(&g);
  return *g.at == '>' ? "writes a file" : NULL;
}

/* The text of a file. A pipe would be waited for, and files of the system that have no size tell each program something else. */
static char *Text_Private(const char *file, size_t *length)
{
  struct stat info;
  FILE       *f    = stat(file, &info) || !S_ISREG(info.st_mode) ? NULL : fopen(file, "rb");
  char       *text = f ? (char *)calloc((size_t)info.st_size + 1, 1) : NULL;

  *length = text ? fread(text, 1, (size_t)info.st_size, f) : 0;
  if (text && getc(f) != EOF) {
    free(text);
    text = NULL;
  }
  if (f) (void)fclose(f);
  return text;
}

static void File_Private(const char *file, int depth, Found *found);

/* What gmsh reads unasked behind a file, and behind that. */
static void Options_Private(const char *file, int depth, Found *found)
{
  char options[2 * PETSC_MAX_PATH_LEN + 8];

  (void)snprintf(options, sizeof(options), "%s.opt", file);
  if (found->text[0] || access(options, F_OK)) return;
  File_Private(options, depth, found);
  Options_Private(options, depth + 1, found);
}

/* A mesh tells so in its first line; else gmsh takes the file for a script. */
static PetscBool IsMesh_Private(const char *file)
{
  static const char first[]             = "$MeshFormat";
  char              line[sizeof(first)] = "";
  FILE             *f                   = fopen(file, "rb");

  const PetscBool mesh = (PetscBool)(f && fgets(line, sizeof(line), f) && !strcmp(line, first));
  if (f) (void)fclose(f);
  return mesh;
}

/* Behind Include, which takes any file for a script, or Merge. */
static void Include_Private(Geo g, const char *word, int depth, Found *found)
{
  char            path[2 * PETSC_MAX_PATH_LEN];
  const PetscBool include = (PetscBool)!strcmp(word, "Include");
  const char     *slash   = strrchr(g.file, '/'), *dot;

  Skip_Private(&g);
  if (*g.at == '(') ++g.at; /* ShapeFromFile("name") */
  const PetscBool given = (PetscBool)(Next_Private(&g) == GEO_TEXT && !strpbrk(g.name, "\\:"));
  if (!given) Tell_Private(&g, found, word, "takes a file by a name that is made at run time, longer than gmsh reads, or with \\ or : in it");
  if (!given) return;
  (void)snprintf(path, sizeof(path), "%.*s%s", g.name[0] == '/' || !slash ? 0 : (int)(slash + 1 - g.file), g.file, g.name);
  dot = strrchr(g.name, '.');
  dot = dot ? dot : "";
  if (include || IsOneOf_Private(dot, PETSC_STATIC_ARRAY_LENGTH(Scripts), Scripts))
    File_Private(path, depth + 1, found);
  else if (!strcmp(dot, ".msh")) {
    if (!access(path, F_OK) && !IsMesh_Private(path)) Tell_Private(&g, found, word, "takes a .msh that does not begin with $MeshFormat for a script");
  } else if (!IsOneOf_Private(dot, PETSC_STATIC_ARRAY_LENGTH(Data), Data))
    Tell_Private(&g, found, word, "takes a file that is no .geo, .msh, .pos, .stl, .step, .stp, .iges, .igs or .brep");
  Options_Private(path, depth + 1, found);
}

static PetscBool Ends_Private(const Geo *g, size_t n, const char *end)
{
  const size_t m = strlen(end);

  return (PetscBool)(n >= m && !memcmp(g->at - m, end, m));
}

/* A word of length n has been passed. gmsh may have begun to read within it. */
static void Statement_Private(const Geo *g, size_t n, int depth, Found *found)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Harmful); ++i) {
    if (Ends_Private(g, n, Harmful[i][0]) && Acts_Private(*g, Harmful[i][2])) Tell_Private(g, found, Harmful[i][0], Harmful[i][1]);
  }
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Includes); ++i) {
    if (Ends_Private(g, n, Includes[i]) && Acts_Private(*g, "(")) Include_Private(*g, Includes[i], depth, found);
  }
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Printing); ++i) {
    const char *does = Ends_Private(g, n, Printing[i]) ? Redirects_Private(*g) : NULL;
    if (does) Tell_Private(g, found, Printing[i], does);
  }
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

static PetscBool GoesOn_Private(const char *at, const char *end)
{
  static const char *const behind[] = {"EndIf", "Else", "EndFor", "Return"};

  for (; at < end; ++at) {
    for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(behind); ++i)
      if (!strncmp(at, behind[i], strlen(behind[i]))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Does gmsh find the comments and strings that one finds who reads from the top? It goes back to the line behind that of `For` or `Macro`, on behind `EndIf` or
   `Return`, wherever these are; it ends a string after 1023 characters, and a line after some thousands. */
static PetscBool IsPlain_Private(const char *at)
{
  PetscBool begun = PETSC_FALSE; /* the line, before what is looked at */

  for (const char *line = at; *at;) {
    const char *string = StringEnd_Private(at), *end = PetscMax(string, CommentEnd_Private(at));
    if (memchr(at, '\n', (size_t)(end - at)) ? begun || string > at : end > at && end - line > GEO_STRING) return PETSC_FALSE;
    if (GoesOn_Private(at, end)) return PETSC_FALSE;
    begun = (PetscBool)(*at != '\n' && (begun || !isspace((unsigned char)*at)));
    line  = *at == '\n' ? at + 1 : line;
    at    = end > at ? end : at + 1;
  }
  return PETSC_TRUE;
}

/* The next word that gmsh could read in a statement: its length, 0 at the end. */
static size_t Word_Private(Geo *g, PetscBool plain)
{
  size_t n = 0;

  while (*g->at && (n = WordLength_Private(g->at)) == 0) {
    const char *end = plain ? PetscMax(CommentEnd_Private(g->at), StringEnd_Private(g->at)) : g->at;
    Pass_Private(g, end > g->at ? end : g->at + 1);
  }
  g->at += n;
  return n;
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
  const PetscBool plain = IsPlain_Private(g.at);
  for (size_t n = Word_Private(&g, plain); n && !found->text[0]; n = Word_Private(&g, plain)) Statement_Private(&g, n, depth, found);
  if (text) LastLine_Private(file, text, found);
  free(text);
}

void GeoCheck(const char *file, size_t capacity, char message[])
{
  Found found = {.capacity = capacity, .text = message};

  message[0] = 0;
  File_Private(file, 0, &found);
  Options_Private(file, 0, &found);
}

/* Behind the first mention of a constant, outside of brackets: is it given a value that gmsh does not ask for? */
static PetscBool IsGiven_Private(Geo g)
{
  const GeoToken token = Next_Private(&g);

  return (PetscBool)(IsSign_Private(&g, token, "=") && *g.at != '=' && !(Next_Private(&g) == GEO_WORD && !strcmp(g.word, "DefineNumber")));
}

/* How much deeper in brackets, or in what depends on a condition, one is behind a token. */
static int Deeper_Private(const Geo *g, GeoToken token)
{
  if (token == GEO_WORD) return !strcmp(g->word, "If") - !strcmp(g->word, "EndIf");
  return IsSign_Private(g, token, "([{") - IsSign_Private(g, token, ")]}");
}

/* The first mention tells; in DefineConstant it is in brackets. Behind files that are included or merged, which are not looked into, everything may be. */
static const char *FirstMention_Private(Geo g, const char *constant)
{
  PetscBool option = PETSC_FALSE; /* a dot before it: not a constant */
  int       depth  = 0;

  for (GeoToken token = Next_Private(&g); token != GEO_END; token = Next_Private(&g)) {
    if (token == GEO_WORD && IsOneOf_Private(g.word, PETSC_STATIC_ARRAY_LENGTH(Includes), Includes)) return "";
    if (token == GEO_TEXT && !strcmp(g.name, constant)) return ""; /* Name "constant" */
    if (token == GEO_WORD && !option && !strcmp(g.word, constant))
      return !depth && IsGiven_Private(g) ? "gives it a value before it declares it, so no other would act; take that statement away" : "";
    option = IsSign_Private(&g, token, ".");
    depth += Deeper_Private(&g, token);
  }
  return "declares no such constant";
}

const char *GeoCheckConstant(const char *file, const char *constant)
{
  size_t      length;
  char       *text = Text_Private(file, &length);
  const char *said = text ? FirstMention_Private((Geo){.at = text}, constant) : "cannot be read";

  free(text);
  return said;
}
