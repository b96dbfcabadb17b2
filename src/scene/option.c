/* From nodes of the tree to values by the rows of the option table: shapes, types, ranges, defaults, nearest names. */
#include "sceneimpl.h"
#include <ctype.h>
#include <errno.h>

PetscInt OptionSplit(const char *pattern, char words[OPTION_DEPTH][MORTISE_NAME])
{
  PetscInt num = 0;

  for (const char *s = pattern; num < OPTION_DEPTH;) {
    size_t n = strcspn(s, ".");
    (void)snprintf(words[num++], MORTISE_NAME, "%.*s", (int)n, s);
    if (!s[n]) break;
    s += n + 1;
  }
  return num;
}

PetscBool OptionKnowsParameter(const char *name)
{
  for (const MaterialLaw *law = MaterialLaws; law->name; ++law)
    for (const MaterialParameter *p = law->parameters; p && p->name; ++p)
      if (!strcmp(p->name, name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscBool OptionIsTopKey(const char *s, size_t length)
{
  for (const Option *row = Options; row->pattern; ++row)
    if (strcspn(row->pattern, ".") == length && !strncmp(row->pattern, s, length)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool WordMatches_Private(const char *word, const char *key)
{
  if (word[0] != '<') return !strcmp(word, key) ? PETSC_TRUE : PETSC_FALSE;
  if (!strcmp(word, "<axis>")) return key[0] >= 'x' && key[0] <= 'z' && !key[1] ? PETSC_TRUE : PETSC_FALSE;
  if (!strcmp(word, "<parameter>")) return OptionKnowsParameter(key);
  return PETSC_TRUE;
}

/* ---- shape of the tree ---------------------------------------------------------------------------------------------------- */

/* The row that the path keys[num] names, NULL if none; *prefix: some row goes on below it. */
static const Option *Find_Private(PetscInt num, const char *const keys[], PetscBool *prefix)
{
  const Option *found = NULL;

  *prefix = PETSC_FALSE;
  for (const Option *row = Options; row->pattern; ++row) {
    char     words[OPTION_DEPTH][MORTISE_NAME];
    PetscInt n = OptionSplit(row->pattern, words), i = 0;
    if (n < num) continue;
    while (i < num && WordMatches_Private(words[i], keys[i])) ++i;
    if (i < num) continue;
    if (n > num)
      *prefix = PETSC_TRUE;
    else if (!found)
      found = row;
  }
  return found;
}

static PetscErrorCode Unknown_Private(const SceneNode *root, const SceneNode *node, PetscInt num, const char *const keys[])
{
  char path[OPTION_DEPTH * (MORTISE_NAME + 1)] = "", nearest[256];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; ++i) {
    if (i) TextAppend(sizeof(path), path, ".");
    TextAppend(sizeof(path), path, keys[i]);
  }
  PetscCall(OptionCheckFormer(NodeWhere(node), path, '.'));
  PetscCall(OptionNearest(root, path, '.', sizeof(nearest), nearest));
  PetscCheckInput(strcmp(path, nearest), "%s is not a key of a scene; keys stand in each other, %.*s: {%s: ...}", NodeWhere(node), (int)strcspn(nearest, "."),
                  nearest, nearest + strcspn(nearest, ".") + 1);
  PetscCall(ErrorInput("%s is not a key of a scene; the nearest one is %s", NodeWhere(node), nearest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *Shape_Private(const SceneNode *node)
{
  return node->kind == NODE_MAP ? "a map of keys" : node->kind == NODE_LIST ? "a list" : NodeIsEmpty(node) ? "empty" : node->text;
}

static const char *Wanted_Private(KeyType type)
{
  static const char *const wanted[] = {"a text",
                                       "a word",
                                       "an integer",
                                       "a number",
                                       "true or false",
                                       "a number or an expression",
                                       "a list [t0,v0, t1,v1, ...]",
                                       "a word like xy",
                                       "a number",
                                       "words with commas between",
                                       "a name or a list of names [a, b]"};
  return wanted[type];
}

/* A list of names, each once. */
static PetscErrorCode CheckNames_Private(const SceneNode *list)
{
  PetscFunctionBegin;
  PetscCheckInput(list->first, "%s is a list without a name", NodeWhere(list));
  for (const SceneNode *item = list->first; item; item = item->next) {
    PetscCheckInput(item->kind == NODE_SCALAR && item->text[0], "%s: names stand in the list, one of them is %s", NodeWhere(list), Shape_Private(item));
    for (const SceneNode *twin = list->first; twin != item; twin = twin->next)
      PetscCheckInput(strcmp(twin->text, item->text), "%s: '%s' is there twice", NodeWhere(list), item->text);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckNode_Private(const SceneNode *root, const SceneNode *node, PetscInt num, const char *keys[])
{
  PetscBool     prefix;
  const Option *row;

  PetscFunctionBegin;
  for (SceneNode *child = node->first; child; child = child->next) {
    PetscCheckInput(num < OPTION_DEPTH, "%s: keys are nested too deep", NodeWhere(child));
    keys[num] = child->key;
    row       = Find_Private(num + 1, keys, &prefix);
    if (!row && !prefix) PetscCall(Unknown_Private(root, child, num + 1, keys));
    if (row && !(prefix && child->kind == NODE_MAP)) { /* body.<name>.order is a number or a map of directions */
      NodeKind kind = row->type == KEY_AMPLITUDE || (row->type == KEY_GROUPS && child->kind == NODE_LIST) ? NODE_LIST : NODE_SCALAR;
      PetscCheckInput(child->kind == kind && !NodeIsEmpty(child), "%s must be %s, it is %s", NodeWhere(child), Wanted_Private(row->type), Shape_Private(child));
      PetscCheckInput(kind == NODE_LIST || child->text[0], "%s is ''; it must be %s", NodeWhere(child), Wanted_Private(row->type));
      if (row->type == KEY_GROUPS && kind == NODE_LIST) PetscCall(CheckNames_Private(child));
    } else {
      PetscCheckInput(child->kind == NODE_MAP || NodeIsNull(child), "%s must be a map of keys {key: value, ...}, it is %s", NodeWhere(child),
                      Shape_Private(child));
      PetscCall(CheckNode_Private(root, child, num + 1, keys));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionsCheckTree(const SceneNode *root)
{
  const char *keys[OPTION_DEPTH + 1];

  PetscFunctionBegin;
  PetscCall(CheckNode_Private(root, root, 0, keys));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- values ------------------------------------------------------------------------------------------------------------------ */

PetscBool OptionParseReal(const char *text, PetscReal *value)
{
  char  *end;
  double v = strtod(text, &end);

  if (end == text || *end || isspace((unsigned char)text[0]) || PetscIsInfOrNanReal(v)) return PETSC_FALSE;
  *value = v;
  return PETSC_TRUE;
}

/* Is v within "[a,b)" and the like? */
static PetscBool InRange_Private(const char *range, PetscReal v)
{
  char  *end;
  double lo, hi;

  if (range[0] != '[' && range[0] != '(') return PETSC_TRUE;
  lo = strtod(range + 1, &end);
  hi = strtod(end + 1, &end);
  if (range[0] == '[' ? v < lo : v <= lo) return PETSC_FALSE;
  return (*end == ']' ? v <= hi : v < hi) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscErrorCode Word_Private(const Option *row, const char *where, const char *text, int *value)
{
  const char *s = row->range;

  PetscFunctionBegin;
  for (int i = 0;; ++i) {
    size_t n = strcspn(s, "|");
    if (strlen(text) == n && !strncmp(s, text, n)) {
      *value = i;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    if (!s[n]) break;
    s += n + 1;
  }
  PetscCall(ErrorInput("%s is '%s'; allowed: %s", where, text, row->range));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Words with commas between, in any order, each once. */
static PetscErrorCode Words_Private(const Option *row, const char *where, const char *text, int *mask)
{
  PetscFunctionBegin;
  *mask = 0;
  for (const char *s = text; *s; s += *s == ',') {
    char   word[MORTISE_NAME];
    int    which = 0;
    size_t n;

    while (*s == ' ') ++s;
    n = strcspn(s, ",");
    (void)snprintf(word, sizeof(word), "%.*s", (int)n, s);
    for (size_t end = strlen(word); end > 0 && word[end - 1] == ' ';) word[--end] = 0;
    PetscCall(Word_Private(row, where, word, &which));
    PetscCheckInput(!(*mask & 1 << which), "%s is '%s': %s is there twice", where, text, word);
    *mask |= 1 << which;
    s += n;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Integer_Private(const Option *row, const char *where, const char *text, PetscInt *value)
{
  char *end;
  long  v;

  PetscFunctionBegin;
  errno = 0;
  v     = strtol(text, &end, 10);
  if (end != text && *end == '.') end += 1 + strspn(end + 1, "0"); /* a number without a fraction is one, as in JSON */
  PetscCheckInput(end != text && !*end && !isspace((unsigned char)text[0]), "%s is '%s'; it must be an integer in %s", where, text, row->range);
  PetscCheckInput(!errno && InRange_Private(row->range, (PetscReal)v), "%s is %s; allowed: an integer in %s", where, text, row->range);
  *value = (PetscInt)v;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Bool_Private(const char *where, const char *text, PetscBool *value)
{
  static const char *const words[2][5] = {{"false", "no", "off", "False", "0"}, {"true", "yes", "on", "True", "1"}};

  PetscFunctionBegin;
  for (int b = 0; b < 2; ++b) {
    for (int i = 0; i < 5; ++i) {
      if (strcmp(text, words[b][i])) continue;
      *value = b ? PETSC_TRUE : PETSC_FALSE;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
  PetscCall(ErrorInput("%s is '%s'; allowed: true, false", where, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Axes_Private(const char *where, const char *text, PetscInt dim, BoundaryEntry *entry)
{
  PetscFunctionBegin;
  if (!strcmp(text, "normal")) {
    entry->spec.fix_normal = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (const char *c = text; *c; ++c) {
    PetscCheckInput(*c >= 'x' && *c <= 'z', "%s is '%s'; allowed: letters of %s, or normal", where, text, dim == 2 ? "xy" : "xyz");
    PetscCheckInput(*c < 'x' + dim, "%s is '%s', but a two-dimensional model has no z", where, text);
    PetscCheckInput(!entry->spec.fix[*c - 'x'], "%s is '%s': %c is there twice", where, text, *c);
    entry->spec.fix[*c - 'x'] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Items may be constant expressions ("pi/2"). */
static PetscErrorCode Amplitude_Private(const SceneNode *node, Amplitude *amplitude)
{
  const char *where = NodeWhere(node);
  PetscInt    num = NodeCount(node), i = 0;

  PetscFunctionBegin;
  PetscCheckInput(num >= 2 && num % 2 == 0, "%s has %d numbers; it needs pairs t0,v0, t1,v1, ...", where, (int)num);
  PetscCall(PetscCalloc1(num, &amplitude->pairs));
  amplitude->num = num / 2;
  for (SceneNode *item = node->first; item; item = item->next, ++i) {
    Expression     e;
    PetscErrorCode status;
    PetscReal      at[2][3] = {{0.3, 0.7, 0.9}, {-1.1, 0.2, 2.3}}, other;

    PetscCheckInput(item->kind == NODE_SCALAR, "%s must be one flat list of numbers", where);
    status = ExpressionCreate(where, item->text, &e);
    if (!status) PetscCall(ExpressionEvaluate(e, at[0], 0.4, &amplitude->pairs[i]));
    if (!status) PetscCall(ExpressionEvaluate(e, at[1], 1.7, &other));
    PetscCall(ExpressionDestroy(&e));
    PetscCall(status);
    PetscCheckInput(other == amplitude->pairs[i], "%s: '%s' is not a constant; expressions in t belong in the value itself", where, item->text);
    PetscCheckInput(i % 2 || i == 0 || amplitude->pairs[i] > amplitude->pairs[i - 2], "%s: t must rise, but %g follows %g", where, (double)amplitude->pairs[i],
                    (double)amplitude->pairs[i - 2]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Text_Private(const Option *row, const char *where, const char *text, char *place)
{
  PetscFunctionBegin;
  PetscCheckInput(strlen(text) < row->size, "%s is longer than %d characters", where, (int)row->size - 1);
  PetscCheckInput(!strcmp(row->pattern, "title") || TextIsPlain(text, ""), "%s is '%s', with a control character or the end of a line in it", where, text);
  PetscCall(PetscStrncpy(place, text, row->size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "a + b" of a list. */
static PetscErrorCode Groups_Private(const Option *row, const char *where, const SceneNode *node, char *place)
{
  char text[SIDE_TEXT + 4] = "";

  PetscFunctionBegin;
  if (!node->first) PetscCall(Text_Private(row, where, node->text, place));
  if (!node->first) PetscFunctionReturn(PETSC_SUCCESS);
  for (const SceneNode *item = node->first; item; item = item->next) {
    if (text[0]) TextAppend(sizeof(text), text, " + ");
    TextAppend(sizeof(text), text, item->text);
  }
  PetscCall(Text_Private(row, where, text, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Store the value of node (NULL: the default) at its place in object, component c of an <axis>. */
static PetscErrorCode Store_Private(const Option *row, const SceneNode *node, const char *where, PetscInt dim, PetscInt c, void *object)
{
  const char *text  = node ? node->text : row->fallback;
  char       *place = (char *)object + row->offset;

  PetscFunctionBegin;
  if (row->type == KEY_AMPLITUDE) {
    if (node) PetscCall(Amplitude_Private(node, (Amplitude *)(void *)place));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!node && !text[0]) PetscFunctionReturn(PETSC_SUCCESS);
  switch (row->type) {
  case KEY_TEXT:
    PetscCall(Text_Private(row, where, text, place));
    break;
  case KEY_GROUPS:
    PetscCall(Groups_Private(row, where, node, place));
    break;
  case KEY_WORD:
    PetscCall(Word_Private(row, where, text, (int *)(void *)place));
    break;
  case KEY_WORDS:
    PetscCall(Words_Private(row, where, text, (int *)(void *)place));
    break;
  case KEY_INT:
    PetscCall(Integer_Private(row, where, text, (PetscInt *)(void *)place + c));
    break;
  case KEY_REAL:
    PetscCheckInput(OptionParseReal(text, (PetscReal *)(void *)place + c), "%s is '%s'; it must be a number", where, text);
    PetscCheckInput(InRange_Private(row->range, ((PetscReal *)(void *)place)[c]), "%s is %s; allowed: a number in %s", where, text, row->range);
    break;
  case KEY_BOOL:
    PetscCall(Bool_Private(where, text, (PetscBool *)(void *)place));
    break;
  case KEY_EXPRESSION:
    PetscCall(ExpressionCreate(where, text, (Expression *)(void *)place + c));
    break;
  case KEY_AXES:
    PetscCall(Axes_Private(where, text, dim, (BoundaryEntry *)object));
    break;
  default: /* parameters are read by their sections, amplitudes above */
    break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "scene.yml:3: material.rubber.law" of a key that is not there. */
static const char *Missing_Private(const SceneNode *up, PetscInt num, char words[OPTION_DEPTH][MORTISE_NAME])
{
  static char text[1100];
  size_t      n = (size_t)(up->parent ? snprintf(text, sizeof(text), "%s.", NodeWhere(up)) : snprintf(text, sizeof(text), "%s: ", up->origin));

  for (PetscInt i = 0; i < num && n < sizeof(text); ++i) n += (size_t)snprintf(text + n, sizeof(text) - n, "%s%s", i ? "." : "", words[i]);
  return text;
}

static PetscErrorCode ReadRow_Private(const Option *row, PetscInt num, char words[OPTION_DEPTH][MORTISE_NAME], const SceneNode *at, PetscInt dim, void *object)
{
  static const char *const axes[3] = {"x", "y", "z"};
  const SceneNode         *up      = at;
  PetscInt                 last    = num - 1;
  PetscBool                axis    = !strcmp(words[last], "<axis>") ? PETSC_TRUE : PETSC_FALSE;
  char                     where[1024];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < last && at; ++i) at = NodeFind(at, words[i]);
  for (PetscInt c = 0; c < (axis ? 3 : 1); ++c) {
    const SceneNode *node = NodeFind(at, axis ? axes[c] : words[last]);
    if (node && node->kind == NODE_MAP) node = NULL; /* given by other rows */
    PetscCheckInput(node || row->fallback, "%s must be given%s%s", Missing_Private(up, num, words), row->range[0] || row->help[0] ? ": " : "",
                    row->range[0] ? row->range : row->help);
    PetscCheckInput(!node || c < dim, "%s is given, but a two-dimensional model has no z", NodeWhere(node));
    PetscCall(PetscStrncpy(where, node ? NodeWhere(node) : row->pattern, sizeof(where)));
    PetscCall(Store_Private(row, node, where, dim, c, object));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many words of a row come before the keys of its object: <section>.<name>, whatever stands in the section; 0 without a name. */
static PetscInt Skip_Private(PetscInt num, char words[OPTION_DEPTH][MORTISE_NAME])
{
  while (num > 0 && (words[num - 1][0] != '<' || !strcmp(words[num - 1], "<axis>"))) --num;
  return num;
}

/* Whether the first num words joined by '.' are the section. */
static PetscBool IsSection_Private(PetscInt num, char words[OPTION_DEPTH][MORTISE_NAME], const char *section)
{
  for (PetscInt i = 0; i < num; ++i) {
    const size_t n = strlen(words[i]);
    if (strncmp(section, words[i], n)) return PETSC_FALSE;
    section += n;
    if (i + 1 < num && *section++ != '.') return PETSC_FALSE;
  }
  return !*section ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode OptionsRead(const char *section, const SceneNode *node, PetscInt dim, void *object)
{
  PetscFunctionBegin;
  for (const Option *row = Options; row->pattern; ++row) {
    char     words[OPTION_DEPTH][MORTISE_NAME];
    PetscInt num = OptionSplit(row->pattern, words), skip = Skip_Private(num, words);
    if (row->type == KEY_PARAMETER || !IsSection_Private(PetscMax(0, skip - 1), words, section)) continue;
    PetscCall(ReadRow_Private(row, num - skip, words + skip, node, dim, object));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
