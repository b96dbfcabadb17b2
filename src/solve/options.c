/* Options of the solver: no keys of a scene but, like PETSc's own, of the command line. Wrong values are told as those of keys are. */
#include "solveimpl.h"

typedef enum { KIND_REAL, KIND_COUNT, KIND_BOOL, KIND_CHOICE } ValueKind;

typedef struct {
  const char *name;
  ValueKind   kind;
  const char *allowed; /* choices, value 0 first; bool: values 0 and 1 in turn */
  size_t      at;      /* in struct _p_Solver */
  const char *text;
} SolverOption;

#define NUMBER "a number above 0"
#define COUNT "an integer, 0 or more"
#define AT(member) offsetof(struct _p_Solver, member)

static const SolverOption Options[] = {
    {"-solve_rtol", KIND_REAL, NUMBER, AT(rtol), "residual against the root of the summed squared nodal forces; default 1e-10"},
    {"-solve_max_it", KIND_COUNT, COUNT, AT(max_it), "Newton iterations before a step is given up; default 25"},
    {"-solve_active_set_passes", KIND_COUNT, COUNT, AT(passes), "active-set passes against one linearisation; default 10"},
    {"-solve_cuts", KIND_COUNT, COUNT, AT(cuts), "halvings of a Newton step that leaves the domain; default 6"},
    {"-solve_symmetric", KIND_BOOL, "0|1|false|true|no|yes", AT(symmetric),
     "LDL^T of the tangent's symmetric form, or LU of the exact one; default: where possible"},
    {"-solve_linear", KIND_CHOICE, "auto|direct|iterative", AT(linear), "factorisation, or multigrid and GMRES; default auto: by size"},
    {"-solve_linear_rtol", KIND_REAL, NUMBER, AT(linear_rtol), "least residual of GMRES against the right-hand side; default 1e-9"},
    {"-solve_factor", KIND_CHOICE, "auto|single|double", AT(factor), "precision of factors; GMRES in double refines single ones; default auto: by size"},
    {"-solve_condense", KIND_CHOICE, "auto|yes|no", AT(condense), "eliminate the unknowns inside each cell before the linear solver; default auto: by order"},
};

/* Which of "a|b|c" the word is, -1: none. */
static PetscInt Word_Private(const char *allowed, const char *word)
{
  for (PetscInt k = 0;; ++k) {
    const size_t n = strcspn(allowed, "|");
    if (strlen(word) == n && !strncmp(allowed, word, n)) return k;
    if (!allowed[n]) return -1;
    allowed += n + 1;
  }
}

static PetscBool Parse_Private(const SolverOption *o, const char *text, void *to)
{
  const PetscInt word = Word_Private(o->allowed, text);
  char          *end;

  if (o->kind == KIND_CHOICE) { /* an enum from 0 on */
    if (word >= 0) *(int *)to = (int)word;
    return (PetscBool)(word >= 0);
  }
  if (o->kind == KIND_BOOL) {
    if (word >= 0) *(PetscBool *)to = (PetscBool)(word % 2);
    return (PetscBool)(word >= 0);
  }
  if (o->kind == KIND_COUNT) {
    const long count = strtol(text, &end, 10);
    *(PetscInt *)to  = (PetscInt)count;
    return (PetscBool)(end != text && !*end && count >= 0 && count <= PETSC_MAX_INT);
  }
  *(PetscReal *)to = (PetscReal)strtod(text, &end);
  return (PetscBool)(end != text && !*end && *(PetscReal *)to > 0);
}

PetscErrorCode SolverOptions_Private(Solver s)
{
  PetscFunctionBegin;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Options); ++i) {
    const SolverOption *o = &Options[i];
    char                text[64];
    PetscBool           set;
    PetscCall(PetscOptionsGetString(NULL, NULL, o->name, text, sizeof(text), &set));
    if (set) PetscCheckInput(Parse_Private(o, text, (char *)s + o->at), "%s is '%s'; allowed: %s", o->name, text, o->allowed);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *SolverNearestOption(const char *name)
{
  const char *names[PETSC_STATIC_ARRAY_LENGTH(Options)];

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Options); ++i) names[i] = Options[i].name + 1; /* without the dash */
  return NameNearest(name, PETSC_STATIC_ARRAY_LENGTH(Options), names);
}

PetscErrorCode SolverCheckOptions(void)
{
  struct _p_Solver nobody = {0};
  PetscInt         num;
  char           **names, **values, unknown[64] = "";

  PetscFunctionBegin;
  PetscCall(SolverOptions_Private(&nobody));
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values)); /* those of the table are asked for by now */
  for (PetscInt i = num - 1; i >= 0; --i) {
    if (!strncmp(names[i], "solve_", 6)) PetscCall(PetscStrncpy(unknown, names[i], sizeof(unknown)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  PetscCheckInput(!unknown[0], "-%s is no option of the solver; the nearest one is -%s", unknown, SolverNearestOption(unknown));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverPrintHelp(MPI_Comm comm)
{
  PetscFunctionBegin;
  PetscCall(PetscPrintf(comm, "\nOptions of the solver, on the command line only.\n\n"));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Options); ++i) PetscCall(HelpRow(comm, Options[i].name, Options[i].allowed, Options[i].text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
