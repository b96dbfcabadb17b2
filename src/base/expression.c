/* Expressions in X, Y, Z, t on muParser (BSD licence): numbers take a short way round it. */
#include "base.h"
#include <ctype.h>
#include <muParserDLL.h>

#define EXPRESSION_LENGTH 4000 /* characters; muParser itself stops at 5000 */
#define WORDS 80               /* of longer ones the place of an error is told only */

struct _p_Expression {
  char            *key, *text; /* owned */
  muParserHandle_t parser;     /* owned; NULL for a plain number */
  PetscReal        constant;   /* value when parser is NULL */
  double           variable[4];
  PetscBool        uses[4]; /* X, Y, Z, t occur in the text */
};

static char trouble[PETSC_MAX_PATH_LEN + 512]; /* the first value that was not finite or refused, since that was last asked for */

static const char *const VariableNames[4] = {"X", "Y", "Z", "t"};

/* muParser calls this at each error; the error is asked for afterwards instead. */
static void IgnoreError_Private(muParserHandle_t parser)
{
}

/* A single '=' would assign to a variable. */
static PetscBool Assigns_Private(const char *text)
{
  for (const char *c = text; *c; ++c) {
    if (*c != '=') continue;
    if (c[1] == '=')
      ++c;
    else if (c == text || !strchr("<>!", c[-1]))
      return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode Parse_Private(Expression e)
{
  int              num = 0;
  const muFloat_t *value;

  PetscFunctionBegin;
  PetscCheckInput(strlen(e->text) <= EXPRESSION_LENGTH, "%s: an expression may have at most %d characters", e->key, EXPRESSION_LENGTH);
  PetscCheckInput(!Assigns_Private(e->text), "%s: \"%s\" assigns with '='; compare with '=='", e->key, e->text);
  e->parser = mupCreate(0); /* 0: floating point */
  mupSetErrorHandler(e->parser, IgnoreError_Private);
  mupSetDecSep(e->parser, '.');
  mupSetArgSep(e->parser, ',');
  mupDefineConst(e->parser, "pi", PETSC_PI);
  for (int i = 0; i < 4; ++i) mupDefineVar(e->parser, VariableNames[i], &e->variable[i]);
  mupSetExpr(e->parser, e->text);
  value = mupEvalMulti(e->parser, &num);
  if (mupError(e->parser)) {
    char        place[64];
    const char *words = place;
    (void)snprintf(place, sizeof(place), "there is an error at character %d", PetscMax(mupGetErrorPos(e->parser) + 1, 1));
    /* muParser's own words repeat what they speak of, in a buffer that has room for little of it. For a sign without a number behind it it has none. */
    if (strlen(e->text) <= WORDS) words = mupGetErrorMsg(e->parser);
    if (!strcmp(words, "Internal error")) words = "a sign in it has nothing to act on";
    PetscCall(ErrorInput("%s: \"%s\" is neither a number nor an expression in X, Y, Z, t and pi: %s", e->key, e->text, words));
  }
  PetscCheckInput(value && num == 1, "%s: \"%s\" gives %d values, not one", e->key, e->text, num);
  for (int i = 0, n = mupGetExprVarNum(e->parser); i < n; ++i) {
    const muChar_t *name = NULL;
    muFloat_t      *address;
    mupGetExprVar(e->parser, (unsigned)i, &name, &address);
    for (int v = 0; v < 4; ++v)
      if (name && !strcmp(name, VariableNames[v])) e->uses[v] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExpressionCreate(const char *key, const char *text, Expression *out)
{
  Expression e;
  char      *end;

  PetscFunctionBegin;
  *out = NULL;
  PetscCall(PetscNew(&e));
  *out = e; /* the caller destroys it whether or not the text is good */
  PetscCall(PetscStrallocpy(key, &e->key));
  PetscCall(PetscStrallocpy(text, &e->text));
  e->constant = strtod(text, &end);
  if (end == text || *end) {
    PetscCall(Parse_Private(e));
    if (!e->uses[0] && !e->uses[1] && !e->uses[2] && !e->uses[3]) {
      e->constant = mupEval(e->parser);
      mupRelease(e->parser);
      e->parser = NULL;
    }
  }
  PetscCheckInput(e->parser || !PetscIsInfOrNanReal(e->constant), "%s: \"%s\" is no finite number", key, text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExpressionEvaluate(Expression e, const PetscReal X[3], PetscReal t, PetscReal *value)
{
  PetscFunctionBegin;
  *value = e->constant;
  if (e->parser) {
    for (int i = 0; i < 3; ++i) e->variable[i] = X[i];
    e->variable[3] = t;
    *value         = mupEval(e->parser);
    if (PetscIsInfOrNanReal(*value) && !trouble[0]) {
      PetscCall(PetscSNPrintf(trouble, sizeof(trouble), "%s: \"%.200s\" is not finite at X = %g, Y = %g, Z = %g, t = %g", e->key, e->text, (double)X[0],
                              (double)X[1], (double)X[2], (double)t));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExpressionRefuse(Expression e, PetscReal t, PetscReal value, const char *allowed)
{
  PetscFunctionBegin;
  if (!trouble[0])
    PetscCall(PetscSNPrintf(trouble, sizeof(trouble), "%s: \"%.200s\" is %g at t = %g; allowed: %s", e->key, e->text, (double)value, (double)t, allowed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExpressionTrouble(MPI_Comm comm, const char **words)
{
  static char told[sizeof(trouble)];
  PetscMPIInt first;

  PetscFunctionBegin;
  PetscCall(RankFirst(comm, (PetscBool)(trouble[0] != 0), &first));
  *words = NULL;
  if (first >= 0) {
    PetscCall(PetscStrncpy(told, trouble, sizeof(told)));
    PetscCallMPI(MPI_Bcast(told, sizeof(told), MPI_CHAR, first, comm));
    *words = told;
  }
  trouble[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ExpressionUsesTime(Expression e)
{
  return e->uses[3];
}

PetscBool ExpressionUsesPlace(Expression e)
{
  return (PetscBool)(e->uses[0] || e->uses[1] || e->uses[2]);
}

const char *ExpressionText(Expression e)
{
  return e->text;
}

PetscErrorCode ExpressionDestroy(Expression *e)
{
  PetscFunctionBegin;
  if (!*e) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*e)->parser) mupRelease((*e)->parser);
  PetscCall(PetscFree((*e)->key));
  PetscCall(PetscFree((*e)->text));
  PetscCall(PetscFree(*e));
  PetscFunctionReturn(PETSC_SUCCESS);
}
