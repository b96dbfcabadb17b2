/* Options that are keys of the scene, of the command line or of PETSc's database (-options_file, PETSC_OPTIONS): what path each one means (names may contain
   '_'), and the nearest known key. */
#include "sceneimpl.h"
#include <strings.h>

/* ---- nearest names ------------------------------------------------------------------------------------------------------------ */

typedef struct {
  const char *path; /* what was asked */
  char        separator;
  PetscInt    num; /* its words, when they can be told (separator '.'), else 0 */
  char        words[OPTION_DEPTH][MORTISE_NAME];
  PetscInt    distance;
  char       *nearest;
  size_t      capacity;
} Search;

static void Offer_Private(Search *s, PetscInt num, const char *const keys[])
{
  char     text[512] = "";
  size_t   n         = 0;
  PetscInt d;

  for (PetscInt i = 0; i < num && n < sizeof(text); ++i) n += (size_t)snprintf(text + n, sizeof(text) - n, "%.*s%s", i ? 1 : 0, &s->separator, keys[i]);
  d = NameDistance(s->path, text);
  if (s->num && num > s->num && !strcmp(s->words[s->num - 1], keys[num - 1])) d = PetscMin(d, 2); /* right word in the wrong place */
  if (d >= s->distance) return;
  s->distance = d;
  (void)snprintf(s->nearest, s->capacity, "%s", text);
}

/* Offer all paths of the row below keys[depth], names taken from the tree. */
static void Expand_Private(Search *s, PetscInt num, char words[OPTION_DEPTH][MORTISE_NAME], PetscInt depth, const char *keys[], const SceneNode *at)
{
  static const char *const axes[3] = {"x", "y", "z"};
  const char              *word    = words[depth];

  if (depth == s->num && s->num) Offer_Private(s, depth, keys);
  if (depth == num) {
    Offer_Private(s, num, keys);
    return;
  }
  if (word[0] != '<') {
    keys[depth] = word;
    Expand_Private(s, num, words, depth + 1, keys, NodeFind(at, word));
  } else if (!strcmp(word, "<axis>")) {
    for (int c = 0; c < 3; ++c) {
      keys[depth] = axes[c];
      Expand_Private(s, num, words, depth + 1, keys, NULL);
    }
  } else if (!strcmp(word, "<parameter>")) {
    for (const MaterialLaw *law = MaterialLaws; law->name; ++law) {
      for (const MaterialParameter *p = law->parameters; p && p->name; ++p) {
        keys[depth] = p->name;
        Expand_Private(s, num, words, depth + 1, keys, NULL);
      }
    }
  } else {
    for (SceneNode *child = at ? at->first : NULL; child; child = child->next) {
      keys[depth] = child->key;
      Expand_Private(s, num, words, depth + 1, keys, child);
    }
    if (!at) {
      keys[depth] = word;
      Expand_Private(s, num, words, depth + 1, keys, NULL);
    }
  }
}

/* Keys of earlier versions, by first and last word, and what to do instead. */
static const struct {
  const char *first, *last, *instead;
} Former[] = {
    {"load", "relax", "use the option -path_viscous auto|on|off"},
    {"contact", "projection", "leave it out: gaps are measured along continuous directions now, whatever the order"},
    {"contact", "hold_lines", "use the option -newton_frozen_segmentation on"},
};

PetscErrorCode OptionCheckFormer(const char *where, const char *path, char separator)
{
  const size_t length = strlen(path);

  PetscFunctionBegin;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Former); ++i) {
    const size_t n = strlen(Former[i].first), m = strlen(Former[i].last);
    if (length <= n + m || strncmp(path, Former[i].first, n) || path[n] != separator) continue;
    if (path[length - m - 1] != separator || strcmp(path + length - m, Former[i].last)) continue;
    PetscCall(ErrorInput("%s is not a key any more; %s", where, Former[i].instead));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionNearest(const SceneNode *root, const char *path, char separator, size_t capacity, char nearest[])
{
  Search s;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&s, sizeof(s)));
  s.path      = path;
  s.separator = separator;
  s.num       = separator == '.' ? OptionSplit(path, s.words) : 0;
  s.distance  = PETSC_MAX_INT;
  s.nearest   = nearest;
  s.capacity  = capacity;
  nearest[0]  = 0;
  for (const Option *row = Options; row->pattern; ++row) {
    char        words[OPTION_DEPTH][MORTISE_NAME];
    const char *keys[OPTION_DEPTH];
    PetscInt    num = OptionSplit(row->pattern, words);
    Expand_Private(&s, num, words, 0, keys, root);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- from -a_b_c to a.b.c ------------------------------------------------------------------------------------------------------ */

typedef struct {
  PetscInt known, literal; /* names that the scene has; characters of fixed words */
  PetscInt num;
  char     keys[OPTION_DEPTH][MORTISE_NAME];
  KeyType  type;
} Match;

/* Only boundaries, probes, points, refinements and constants of the mesh may get a new name on the command line. */
static PetscBool MayBeNew_Private(const Match *m, const char *word)
{
  if (!strcmp(word, "<constant>")) return PETSC_TRUE;
  return !strcmp(m->keys[0], "boundary") || !strcmp(m->keys[0], "probe") || !strcmp(m->keys[0], "refine") || !strcmp(m->keys[0], "point") ? PETSC_TRUE
                                                                                                                                          : PETSC_FALSE;
}

/* Match words[depth..] with s; at: node of the tree reached so far, NULL if it is not there. Keeps the best in *best. */
static void Match_Private(PetscInt num, char words[OPTION_DEPTH][MORTISE_NAME], PetscInt depth, const char *s, const SceneNode *at, Match *m, Match *best)
{
  const char *word   = words[depth];
  size_t      length = strlen(s);

  for (size_t n = 1; n <= length; ++n) { /* the word takes n characters, then comes '_' or the end */
    PetscBool  fixed = word[0] != '<' ? PETSC_TRUE : PETSC_FALSE, good;
    SceneNode *child;
    Match      old = *m;
    if ((s[n] && s[n] != '_') || n >= MORTISE_NAME) continue;
    (void)snprintf(m->keys[depth], MORTISE_NAME, "%.*s", (int)n, s);
    child = NodeFind(at, m->keys[depth]);
    if (fixed)
      good = !strcmp(word, m->keys[depth]) ? PETSC_TRUE : PETSC_FALSE;
    else if (!strcmp(word, "<axis>"))
      good = n == 1 && s[0] >= 'x' && s[0] <= 'z' ? PETSC_TRUE : PETSC_FALSE;
    else if (!strcmp(word, "<parameter>"))
      good = OptionKnowsParameter(m->keys[depth]);
    else
      good = child || MayBeNew_Private(m, word) ? PETSC_TRUE : PETSC_FALSE;
    if (good) {
      if (fixed)
        m->literal += (PetscInt)n;
      else if (child)
        m->known += (PetscInt)n; /* the longest known name wins */
      if (depth + 1 == num && !s[n]) {
        m->num = num;
        if (!best->num || m->known > best->known || (m->known == best->known && m->literal > best->literal)) *best = *m;
      } else if (depth + 1 < num && s[n])
        Match_Private(num, words, depth + 1, s + n + 1, child, m, best);
    }
    *m = old;
  }
}

/* Value of a list: "[0,0, 1,1]" or "0,0,1,1"; names may have blanks in them: "[a, b c]". */
static PetscErrorCode SetList_Private(SceneNode *list, const char *value)
{
  const size_t    length = strlen(value);
  const PetscBool opens = (PetscBool)(value[0] == '['), closes = (PetscBool)(length > 0 && value[length - 1] == ']');
  char           *copy, *item, *rest;
  SceneNode      *node;

  PetscFunctionBegin;
  PetscCheckInput(opens == closes && length != 1, "%s is '%s'; a list that begins with [ ends with ]", NodeWhere(list), value);
  PetscCall(PetscStrallocpy(value + opens, &copy));
  if (closes) copy[length - 2] = 0;
  for (rest = copy[strspn(copy, " ")] ? copy : NULL; (item = strsep(&rest, ","));) {
    item += strspn(item, " ");
    for (size_t end = strlen(item); end > 0 && item[end - 1] == ' ';) item[--end] = 0;
    PetscCheckInput(item[0], "%s is '%s'; nothing stands between two of its commas, or at its end", NodeWhere(list), value);
    PetscCall(NodeCreate(list, "", NODE_SCALAR, list->origin, 0, &node));
    PetscCall(NodeSetText(node, item));
  }
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Set_Private(SceneNode *root, const Match *m, const char *value, PetscInt line)
{
  const NodeKind last = m->type == KEY_AMPLITUDE || (m->type == KEY_GROUPS && value[0] == '[') ? NODE_LIST : NODE_SCALAR;
  SceneNode     *at   = root;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num; ++i) {
    NodeKind   kind  = i + 1 < m->num ? NODE_MAP : last;
    SceneNode *child = NodeFind(at, m->keys[i]);
    if (!child) PetscCall(NodeCreate(at, m->keys[i], kind, root->origin, 0, &child));
    PetscCheckInput(kind != NODE_MAP || child->kind == NODE_MAP || NodeIsNull(child), "%s: a key below %s, which is %s; give it as a map {key: value}",
                    NodeOptions(line), NodeWhere(child), child->kind == NODE_LIST ? "a list" : child->text);
    if (kind == NODE_MAP) child->kind = NODE_MAP; /* an empty section becomes a map */
    at = child;
  }
  at->kind = last;
  at->line = line;
  for (SceneNode *child = at->first, *next; child; child = next) {
    next = child->next;
    PetscCall(NodeDestroy(&child));
  }
  at->first = at->last = NULL;
  at->quoted           = PETSC_TRUE;
  if (at->kind == NODE_LIST)
    PetscCall(SetList_Private(at, value));
  else
    PetscCall(NodeSetText(at, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Override_Private(SceneNode *root, const char *name, const char *value, PetscInt line)
{
  Match best, m;
  char  nearest[256];

  PetscFunctionBegin;
  PetscCall(PetscMemzero(&best, sizeof(best)));
  for (const Option *row = Options; row->pattern; ++row) {
    char     words[OPTION_DEPTH][MORTISE_NAME];
    PetscInt num = OptionSplit(row->pattern, words);
    PetscCall(PetscMemzero(&m, sizeof(m)));
    m.type = row->type;
    Match_Private(num, words, 0, name, root, &m, &best);
  }
  if (!best.num) {
    char option[320];
    PetscCall(PetscSNPrintf(option, sizeof(option), "%s: -%.200s", NodeOptions(line), name));
    PetscCall(OptionCheckFormer(option, name, '_'));
    PetscCall(OptionNearest(root, name, '_', sizeof(nearest), nearest));
    PetscCall(ErrorInput("%s: -%.80s is not a key of this scene; the nearest one is -%s", NodeOptions(line), name, nearest));
  }
  PetscCheckInput(value && value[0], "%s: -%s needs a value; one that begins with '-' and a letter needs a blank before it, in quotation marks: \" -t\"",
                  NodeOptions(line), name);
  PetscCheckInput(TextIsPlain(value, "\n\r\t"), "%s: a control character in the value of -%.80s", NodeOptions(line), name);
  PetscCall(Set_Private(root, &best, value, line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool OnCommandLine_Private(const char *name, int argc, char **argv)
{
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-' && !strcasecmp(argv[i] + strspn(argv[i], "-"), name)) return PETSC_TRUE; /* PETSc's names know no case */
  }
  return PETSC_FALSE;
}

/* Keys of the scene in PETSc's database that the command line does not give. */
static PetscErrorCode OverrideFromDatabase_Private(SceneNode *root, int argc, char **argv)
{
  PetscInt       num;
  char         **names, **values;
  PetscErrorCode status = PETSC_SUCCESS;

  PetscFunctionBegin;
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values));
  for (PetscInt i = 0; i < num && !status; ++i) {
    char option[1024];
    if (!OptionIsTopKey(names[i], strcspn(names[i], "_")) || OnCommandLine_Private(names[i], argc, argv)) continue;
    status = Override_Private(root, names[i], values[i], NODE_DATABASE);
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", names[i]));
    PetscCall(PetscOptionsClearValue(NULL, option));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  PetscCall(status);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionsOverride(SceneNode *root, int argc, char **argv)
{
  PetscFunctionBegin;
  PetscCall(OverrideFromDatabase_Private(root, argc, argv));
  for (int i = 1; i < argc; ++i) {
    const char *name = argv[i], *value = NULL;
    PetscBool   next;
    char        option[1024];
    if (name[0] != '-') continue;
    while (*name == '-') ++name;
    if (!OptionIsTopKey(name, strcspn(name, "_"))) continue;
    if (i + 1 < argc) { /* a value may be a negative number, but not an option */
      PetscCall(PetscOptionsValidKey(argv[i + 1], &next));
      if (!next) value = argv[++i];
    }
    PetscCall(Override_Private(root, name, value, NODE_COMMAND_LINE));
    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", name));
    PetscCall(PetscOptionsClearValue(NULL, option));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneNearestOption(Scene s, const char *name, size_t capacity, char nearest[])
{
  PetscFunctionBegin;
  PetscCall(OptionNearest(s->root, name, '_', capacity, nearest));
  PetscFunctionReturn(PETSC_SUCCESS);
}
