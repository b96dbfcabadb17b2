/* YAML text -> tree of keys, on libyaml's events. Stricter than YAML: no duplicate keys, no anchors, no tags, one document, bounded size. */
#include "sceneimpl.h"
#include <yaml.h>

#define YAML_MAX_DEPTH 16
#define YAML_MAX_NODES 10000

typedef struct {
  yaml_parser_t parser;
  yaml_event_t  event; /* the current one */
  PetscBool     live;  /* event is to be deleted */
  const char   *origin;
  PetscInt      num_nodes;
} Reader;

/* ---- nodes ------------------------------------------------------------------------------------------------------------------ */

PetscErrorCode NodeCreate(SceneNode *parent, const char *key, NodeKind kind, const char *origin, PetscInt line, SceneNode **out)
{
  SceneNode *node;

  PetscFunctionBegin;
  PetscCall(PetscNew(&node));
  PetscCall(PetscStrallocpy(key, &node->key));
  node->kind   = kind;
  node->origin = origin;
  node->line   = line;
  node->parent = parent;
  if (parent) {
    if (parent->last)
      parent->last->next = node;
    else
      parent->first = node;
    parent->last = node;
  }
  *out = node;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeDestroy(SceneNode **node)
{
  PetscFunctionBegin;
  if (!*node) PetscFunctionReturn(PETSC_SUCCESS);
  for (SceneNode *child = (*node)->first, *next; child; child = next) {
    next = child->next;
    PetscCall(NodeDestroy(&child));
  }
  PetscCall(PetscFree((*node)->key));
  PetscCall(PetscFree((*node)->text));
  PetscCall(PetscFree(*node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeSetText(SceneNode *node, const char *text)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(node->text));
  PetscCall(PetscStrallocpy(text, &node->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

SceneNode *NodeFind(const SceneNode *map, const char *key)
{
  for (SceneNode *child = map ? map->first : NULL; child; child = child->next)
    if (!strcmp(child->key, key)) return child;
  return NULL;
}

PetscInt NodeCount(const SceneNode *node)
{
  PetscInt num = 0;
  for (SceneNode *child = node ? node->first : NULL; child; child = child->next) ++num;
  return num;
}

PetscBool NodeIsEmpty(const SceneNode *node)
{
  return node->kind == NODE_SCALAR && !node->quoted && !node->text[0] ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool NodeIsNull(const SceneNode *node)
{
  static const char *const words[] = {"", "~", "null", "Null", "NULL"};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(words); ++i)
    if (node->kind == NODE_SCALAR && !node->quoted && !strcmp(node->text, words[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

const char *NodeOptions(PetscInt line)
{
  return line == NODE_DATABASE ? "-options_file or PETSC_OPTIONS" : "command line";
}

const char *NodeWhere(const SceneNode *node)
{
  static char      buffer[8][1024];
  static int       turn = 0;
  const SceneNode *chain[YAML_MAX_DEPTH + 2];
  char            *s   = buffer[turn = (turn + 1) % 8];
  int              num = 0;
  size_t           n;

  for (const SceneNode *up = node; up && up->parent && num < YAML_MAX_DEPTH; up = up->parent) chain[num++] = up;
  if (node->line > 0)
    n = (size_t)snprintf(s, sizeof(buffer[0]), "%s:%d: ", node->origin, (int)node->line);
  else
    n = (size_t)snprintf(s, sizeof(buffer[0]), "%s: ", NodeOptions(node->line));
  for (int i = num - 1; i >= 0 && n < sizeof(buffer[0]); --i) n += (size_t)snprintf(s + n, sizeof(buffer[0]) - n, "%s%s", chain[i]->key, i ? "." : "");
  return s;
}

/* ---- events ------------------------------------------------------------------------------------------------------------------- */

/* What the words of the parser most often come from. */
static const char *Hint_Private(const char *problem)
{
  if (strstr(problem, "cannot start any token"))
    return "; lines are indented by blanks, not by tabs, and a text that begins with @, ` or % needs quotation marks";
  if (strstr(problem, "mapping values")) return "; a text with a colon in it needs quotation marks, a key the indentation of its neighbours";
  return "";
}

static PetscErrorCode Next_Private(Reader *r)
{
  PetscFunctionBegin;
  if (r->live) yaml_event_delete(&r->event);
  r->live = PETSC_FALSE;
  if (!yaml_parser_parse(&r->parser, &r->event)) {
    const yaml_parser_t *p       = &r->parser;
    const char          *problem = p->problem ? p->problem : "unreadable text";
    PetscCall(ErrorInput("%s:%d:%d: not valid YAML: %s%s%s%s", r->origin, (int)p->problem_mark.line + 1, (int)p->problem_mark.column + 1, problem,
                         p->context ? " " : "", p->context ? p->context : "", Hint_Private(problem)));
  }
  r->live = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Line_Private(const Reader *r)
{
  return (PetscInt)r->event.start_mark.line + 1;
}

/* The current event is a scalar: check it and give its text. */
static PetscErrorCode Scalar_Private(Reader *r, const char **text)
{
  PetscFunctionBegin;
  PetscCheckInput(!r->event.data.scalar.anchor &&
                      !(r->event.data.scalar.tag && r->event.data.scalar.plain_implicit == 0 && r->event.data.scalar.quoted_implicit == 0),
                  "%s:%d: anchors and tags of YAML are not used in a scene", r->origin, (int)Line_Private(r));
  *text = (const char *)r->event.data.scalar.value;
  PetscCheckInput(strlen(*text) == r->event.data.scalar.length, "%s:%d: a zero character in a text", r->origin, (int)Line_Private(r));
  PetscCheckInput(TextIsPlain(*text, "\n\r\t"), "%s:%d: a control character in a text", r->origin, (int)Line_Private(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Key_Private(Reader *r, const SceneNode *map, char key[MORTISE_NAME])
{
  const char *text = "";
  SceneNode  *twin;

  PetscFunctionBegin;
  PetscCheckInput(r->event.type == YAML_SCALAR_EVENT, "%s:%d:%d: a key must be a plain word", r->origin, (int)Line_Private(r),
                  (int)r->event.start_mark.column + 1);
  PetscCall(Scalar_Private(r, &text));
  PetscCheckInput(text[0], "%s:%d: an empty key", r->origin, (int)Line_Private(r));
  PetscCheckInput(!text[strcspn(text, ",\"")] && TextIsPlain(text, ""), "%s:%d: key \"%.20s…\" has a comma, quotation mark or control character in it",
                  r->origin, (int)Line_Private(r), text);
  PetscCheckInput(strlen(text) < MORTISE_NAME, "%s:%d: key \"%.20s…\" is longer than %d characters", r->origin, (int)Line_Private(r), text, MORTISE_NAME - 1);
  twin = NodeFind(map, text);
  PetscCheckInput(!twin, "%s is given twice, in lines %d and %d", NodeWhere(twin), (int)twin->line, (int)Line_Private(r));
  PetscCall(PetscStrncpy(key, text, MORTISE_NAME));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The current event starts a value: read all of it into a new child of parent. */
static PetscErrorCode Value_Private(Reader *r, SceneNode *parent, const char *key, PetscInt depth, SceneNode **out)
{
  SceneNode  *node;
  const char *text = "";
  char        name[MORTISE_NAME];
  PetscInt    line = Line_Private(r);

  PetscFunctionBegin;
  PetscCheckInput(depth < YAML_MAX_DEPTH, "%s:%d: keys are nested deeper than %d", r->origin, (int)line, YAML_MAX_DEPTH);
  PetscCheckInput(++r->num_nodes <= YAML_MAX_NODES, "%s:%d: more than %d keys and values", r->origin, (int)line, YAML_MAX_NODES);
  switch (r->event.type) {
  case YAML_SCALAR_EVENT:
    PetscCall(NodeCreate(parent, key, NODE_SCALAR, r->origin, line, &node));
    *out         = node;
    node->quoted = r->event.data.scalar.style == YAML_PLAIN_SCALAR_STYLE ? PETSC_FALSE : PETSC_TRUE;
    PetscCall(NodeSetText(node, ""));
    PetscCall(Scalar_Private(r, &text));
    PetscCall(NodeSetText(node, text));
    break;
  case YAML_SEQUENCE_START_EVENT:
    PetscCall(NodeCreate(parent, key, NODE_LIST, r->origin, line, &node));
    *out = node;
    PetscCheckInput(!r->event.data.sequence_start.anchor, "%s:%d: anchors of YAML are not used in a scene", r->origin, (int)line);
    PetscCall(Next_Private(r));
    while (r->event.type != YAML_SEQUENCE_END_EVENT) {
      SceneNode *item;
      PetscCall(Value_Private(r, node, "", depth + 1, &item));
      PetscCall(Next_Private(r));
    }
    break;
  case YAML_MAPPING_START_EVENT:
    PetscCall(NodeCreate(parent, key, NODE_MAP, r->origin, line, &node));
    *out = node;
    PetscCheckInput(!r->event.data.mapping_start.anchor, "%s:%d: anchors of YAML are not used in a scene", r->origin, (int)line);
    PetscCall(Next_Private(r));
    while (r->event.type != YAML_MAPPING_END_EVENT) {
      SceneNode *child;
      PetscInt   key_line = Line_Private(r);
      PetscCall(Key_Private(r, node, name));
      PetscCall(Next_Private(r));
      PetscCall(Value_Private(r, node, name, depth + 1, &child));
      child->line = key_line;
      PetscCall(Next_Private(r));
    }
    break;
  default:
    PetscCall(ErrorInput("%s:%d: aliases of YAML (*name) are not used in a scene", r->origin, (int)line));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Document_Private(Reader *r, SceneNode **root)
{
  PetscFunctionBegin;
  PetscCall(Next_Private(r)); /* stream start */
  PetscCall(Next_Private(r));
  PetscCheckInput(r->event.type == YAML_DOCUMENT_START_EVENT, "%s: the scene is empty", r->origin);
  PetscCall(Next_Private(r));
  PetscCheckInput(r->event.type != YAML_SCALAR_EVENT || r->event.data.scalar.length, "%s: the scene is empty", r->origin);
  PetscCheckInput(r->event.type == YAML_MAPPING_START_EVENT, "%s:%d: a scene is a map of keys (key: value), this is not", r->origin, (int)Line_Private(r));
  PetscCall(Value_Private(r, NULL, "", 0, root));
  PetscCall(Next_Private(r)); /* document end */
  PetscCall(Next_Private(r));
  PetscCheckInput(r->event.type == YAML_STREAM_END_EVENT, "%s:%d: a second document starts here; a scene is one", r->origin, (int)Line_Private(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneParse(const char *origin, const char *text, size_t length, SceneNode **root)
{
  Reader         r;
  PetscErrorCode status;

  PetscFunctionBegin;
  *root = NULL;
  PetscCall(PetscMemzero(&r, sizeof(r)));
  r.origin = origin;
  PetscCheck(yaml_parser_initialize(&r.parser), PETSC_COMM_SELF, PETSC_ERR_MEM, "libyaml has no memory");
  yaml_parser_set_input_string(&r.parser, (const unsigned char *)text, length);
  status = Document_Private(&r, root);
  if (r.live) yaml_event_delete(&r.event);
  yaml_parser_delete(&r.parser);
  PetscCall(status);
  PetscFunctionReturn(PETSC_SUCCESS);
}
