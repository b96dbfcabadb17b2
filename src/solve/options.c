/* Options of the solver: no keys of a scene but, like PETSc's own, of the command line. Wrong values are told as those
   of keys are, and of PETSc's own those of SNES that cannot act in this iteration are refused by name. */
#include "solveimpl.h"

typedef enum { KIND_REAL, KIND_SMALL, KIND_TOLERANCE, KIND_SHARE, KIND_COUNT, KIND_BOOL, KIND_CHOICE } ValueKind;

typedef struct {
  const char *name;
  ValueKind   kind;
  const char *allowed; /* choices, value 0 first; bool: values 0 and 1 in turn */
  size_t      at;      /* in struct _p_Solver */
  const char *text;
} SolverOption;

#define NUMBER "a number above 0"
#define LOOSEST 1e-3 /* of an equilibrium that deserves the name */
#define SMALL "a number above 0, 1e-3 at most"
#define TOLERANCE "a number, 0 or more"
#define SHARE "a number, 0 or more, below 1"
#define COUNT "an integer, 0 or more"
#define AT(member) offsetof(struct _p_Solver, member)

static const SolverOption Options[] = {
    {"-solve_rtol", KIND_SMALL, SMALL, AT(rtol), "residual against the root of the summed squared nodal forces; default 1e-10"},
    {"-solve_active_set_passes", KIND_COUNT, COUNT, AT(passes),
     "active-set passes in a row that leave no fewer nodes in disagreement before nodes switch one at a time, 0: none switches; default 10"},
    {"-solve_single_switches", KIND_BOOL, "0|1|false|true|no|yes", AT(single_switches),
     "may nodes switch one at a time, or is the last linear step taken; default yes"},
    {"-solve_cuts", KIND_COUNT, COUNT, AT(cuts), "halvings of a Newton step that leaves the domain; default 6"},
    {"-solve_symmetric", KIND_BOOL, "0|1|false|true|no|yes", AT(symmetric),
     "LDL^T of the tangent's symmetric form, or LU of the exact one; default: where possible"},
    {"-solve_linear", KIND_CHOICE, "auto|direct|iterative", AT(linear), "factorisation, or multigrid and GMRES; default auto: by size"},
    {"-solve_multigrid", KIND_CHOICE, "auto|gamg|boomeramg", AT(multigrid),
     "where multigrid is taken: PETSc's smoothed aggregation, or hypre's BoomerAMG; default auto: by order and size"},
    {"-solve_linear_rtol", KIND_REAL, NUMBER, AT(linear_rtol), "least residual of GMRES against the right-hand side; default 1e-9"},
    {"-solve_factor", KIND_CHOICE, "auto|single|double", AT(factor), "precision of factors; GMRES in double refines single ones; default auto: by size"},
    {"-solve_condense", KIND_CHOICE, "auto|yes|no", AT(condense), "eliminate the unknowns inside each cell before the linear solver; default auto: by order"},
    {"-snes_max_it", KIND_COUNT, COUNT, AT(max_it), "Newton iterations before a step is given up; default 25"},
    {"-snes_max_funcs", KIND_COUNT, COUNT, AT(max_funcs), "residuals before a step is given up; default: any number"},
    {"-snes_rtol", KIND_SHARE, SHARE, AT(snes_rtol), "a residual this small against that of the first iterate is enough, too; default 0"},
    {"-snes_atol", KIND_TOLERANCE, TOLERANCE, AT(snes_atol), "a residual this small is enough, too; default 0"},
    {"-snes_stol", KIND_TOLERANCE, TOLERANCE, AT(snes_stol), "a Newton step this small against the unknowns is enough, too; default 0"},
};

#define SWITCH "auto|on|off"

/* Other options of SNES that act; what begins with one that ends in an underscore does, too. */
static const char *const SnesActs[] = {"snes_monitor", "snes_monitor_",      "snes_converged_reason", "snes_converged_reason_",     "snes_view",
                                       "snes_view_",   "snes_test_jacobian", "snes_test_jacobian_",   "snes_error_if_not_converged"};

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
  if (o->kind == KIND_SMALL && !(*(PetscReal *)to <= LOOSEST)) return PETSC_FALSE;
  if (o->kind == KIND_SHARE && !(*(PetscReal *)to < 1)) return PETSC_FALSE;
  return (PetscBool)(end != text && !*end && (*(PetscReal *)to > 0 || ((o->kind == KIND_TOLERANCE || o->kind == KIND_SHARE) && *(PetscReal *)to == 0)));
}

/* Switches of the modifiers. */
static PetscErrorCode Switches_Private(Solver s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) {
    char      name[64], text[64];
    PetscBool set;
    PetscCall(PetscSNPrintf(name, sizeof(name), "-newton_%s", SolverModifierName(i)));
    PetscCall(PetscOptionsGetString(NULL, NULL, name, text, sizeof(text), &set));
    if (!set) continue;
    const PetscInt word = Word_Private(SWITCH, text);
    PetscCheckInput(word >= 0, "%s is '%s'; allowed: %s", name, text, SWITCH);
    s->mode[i] = (ModifierMode)word;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscCall(Switches_Private(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool ActsInSnes_Private(const char *name)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(SnesActs); ++i) {
    const size_t n = strlen(SnesActs[i]);
    if (SnesActs[i][n - 1] == '_' ? !strncmp(name, SnesActs[i], n) : !strcmp(name, SnesActs[i])) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

const char *SolverNearestOption(const char *name)
{
  static char modifier[SOLVER_MOST_MODIFIERS][64];
  const char *names[PETSC_STATIC_ARRAY_LENGTH(Options) + SOLVER_MOST_MODIFIERS];
  PetscInt    num = 0;

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Options); ++i) names[num++] = Options[i].name + 1; /* without the dash */
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) {
    (void)snprintf(modifier[i], sizeof(modifier[i]), "newton_%s", SolverModifierName(i));
    names[num++] = modifier[i];
  }
  return NameNearest(name, num, names);
}

/* An input error for an option of ours, or of SNES, that does nothing. */
static PetscErrorCode Refuse_Private(const char *unknown)
{
  PetscFunctionBegin;
  PetscCheckInput(
      strncmp(unknown, "snes_", 5),
      "-%s cannot act here; of PETSc's options of SNES these can: -snes_max_it, _max_funcs, _rtol, _atol, _stol, _monitor, _view, _converged_reason, "
      "_test_jacobian",
      unknown);
  PetscCheckInput(!unknown[0], "-%s is no option of the solver; the nearest one is -%s", unknown, SolverNearestOption(unknown));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverCheckOptions(void)
{
  struct _p_Solver nobody = {0};
  PetscInt         num;
  char           **names, **values, unknown[64] = "";

  PetscFunctionBegin;
  PetscCall(SolverOptions_Private(&nobody));
  PetscCall(SolverCheckTypes_Private()); /* first: of options that nobody has asked for */
  PetscCall(MultigridCheck_Private(nobody.multigrid, nobody.linear));
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values)); /* those of the table are asked for by now */
  for (PetscInt i = num - 1; i >= 0; --i) {
    const PetscBool ours = (PetscBool)(!strncmp(names[i], "solve_", 6) || !strncmp(names[i], "newton_", 7)), snes = (PetscBool)!strncmp(names[i], "snes_", 5);
    if (ours || (snes && !ActsInSnes_Private(names[i]))) PetscCall(PetscStrncpy(unknown, names[i], sizeof(unknown)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  if (unknown[0]) PetscCall(Refuse_Private(unknown));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverPrintHelp(MPI_Comm comm)
{
  PetscFunctionBegin;
  PetscCall(HelpText(comm, "\nOptions of the solver, on the command line only.\n\n"));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Options); ++i) PetscCall(HelpRow(comm, Options[i].name, Options[i].allowed, Options[i].text));
  PetscCall(
      HelpText(comm, "\nModifiers of Newton's iteration (docs/ablation.md). auto: each by its own criterion; on: as auto where nothing else is said.\n\n"));
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) {
    char name[64];
    PetscCall(PetscSNPrintf(name, sizeof(name), "-newton_%s", SolverModifierName(i)));
    PetscCall(HelpRow(comm, name, SWITCH, SolverModifier_Private(i)->help));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
