/* What is tried, in this order, where a step has no solution that Newton's method finds from where it stands: after a failed load step, in time or along a
   path, and after adaptation on the new mesh. Each row can be switched: -path_<name> on|off|auto. */
#include "path.h"

#define MODES "auto|on|off"
#define PREFIX "path_"

#define LEAST_WAY (1. / 8) /* of the way of the load on another mesh: a shorter piece is given up */
#define LEAST (1. / 64)    /* the same of the first piece of other loops */
#define CREEP 10           /* first step of pseudo-time: cells answer to a change of shape with a tenth of their stiffness more */
#define CREEP_STEPS 20     /* attempts in all */

/* What the step took to come to another state than the accepted one is not on the way from there. */
static PetscErrorCode Begin_Private(Path *p, const State *guess)
{
  PetscFunctionBegin;
  if (!guess) p->work = (StepWork){0};
  PetscCall(PathRestore(p, guess ? guess : &p->level->accepted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- segmentation no longer frozen ------------------------------------------------------------------------------------------------- */

static PetscBool IsFrozen_Private(const Path *p, const State *guess)
{
  return guess ? guess->form.frozen_segmentation : p->level->accepted.form.frozen_segmentation;
}

static PetscErrorCode Unfreeze_Private(Path *p, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(Begin_Private(p, guess));
  p->level->state.form.frozen_segmentation = PETSC_FALSE;
  PetscCall(PathAttempt(p, load, to, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- from what was carried over to another mesh ------------------------------------------------------------------------------------ */

PetscBool PathWasUnstable(const Path *p, const State *guess)
{
  return (PetscBool)(guess && p->stabilised > 0 && p->stabilised_t == guess->t);
}

static PetscBool IsCarried_Private(const Path *p, const State *guess)
{
  return (PetscBool)(guess && !PathWasUnstable(p, guess));
}

/* ---- from bodies at rest that overlap ----------------------------------------------------------------------------------------------- */

static PetscBool IsAtRest_Private(const Path *p, const State *guess)
{
  PetscReal norm = 0;

  if (!p->data->num_contacts || p->data->mechanics.kinematics == KINEMATICS_SMALL) return PETSC_FALSE;
  (void)VecNorm(p->level->accepted.x, NORM_INFINITY, &norm);
  return (PetscBool)(norm == 0);
}

/* In as many pieces as it takes, with the whole load of the step from the start on: where that is not found with all of the overlap left, the load is at fault.
 */
static PetscErrorCode Overlap_Private(Path *p, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  PathLoop  loop    = {.metric = &PathOverlap, .stop = 1, .piece = PathOverlap.cut, .least = LEAST, .most = 1, .load = load, .at = to};
  Problem   problem = p->level->problem;
  PetscReal deepest;

  PetscFunctionBegin;
  PetscCall(Begin_Private(p, NULL));
  PetscCall(ProblemSetState(problem, &p->level->state));
  PetscCall(ProblemNoteOverlap(problem, p->level->state.x, &deepest));
  if (deepest > 0) PetscCall(PathAttempt(p, &loop, 0, report));
  if (report->converged) PetscCall(PathFollow(p, &loop, report));
  ProblemLeaveOverlap(problem, 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The way of the load from the accepted state again, in as many pieces as it takes. */
static PetscErrorCode Cut_Private(Path *p, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  const PetscReal way  = to - load->origin;
  PathLoop        loop = {.metric = load->metric, .s = load->origin, .stop = to, .piece = way, .least = LEAST_WAY * way, .most = way, .origin = load->origin};

  PetscFunctionBegin;
  PetscCall(Begin_Private(p, NULL));
  PetscCall(PathFollow(p, &loop, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- with the other predictor ------------------------------------------------------------------------------------------------------ */

static PetscBool HasTwo_Private(const Path *p, const State *guess)
{
  const PetscBool slides = (PetscBool)(p->data->mechanics.kinematics != KINEMATICS_SMALL && InterfaceSlips(ProblemInterface(p->level->problem)));

  return (PetscBool)(!guess && (slides || MechanicsIsPlastic(&p->data->mechanics)));
}

static PetscErrorCode Predictor_Private(Path *p, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(Begin_Private(p, NULL));
  SolverSwapPredictor(p->level->solver, PETSC_TRUE);
  PetscCall(PathAttempt(p, load, to, report));
  SolverSwapPredictor(p->level->solver, PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- to an equilibrium farther off ------------------------------------------------------------------------------------------------- */

static PetscBool Always_Private(const Path *p, const State *guess)
{
  return PETSC_TRUE;
}

/* Friction counted from each piece of pseudo-time, and what slipped in them is forgotten: the equilibrium once more, with slip from the start of the step.
   Where none is found, the one at hand stays. */
static PetscErrorCode Slipped_Private(Path *p, const PathLoop *load, PetscReal to, SolverReport *report)
{
  Level       *l = p->level;
  State        found;
  SolverReport again;

  PetscFunctionBegin;
  PetscCall(StateCreate(l->problem, &found));
  PetscCall(StateCopy(&l->state, &found));
  PetscCall(PetscArraycpy(l->state.before, l->accepted.before, l->state.num_before));
  PetscCall(PathAttempt(p, load, to, &again));
  if (again.converged)
    *report = again;
  else {
    PetscCall(PathPrescribe(l->problem, found.t)); /* of which an attempt in vain may have left a part */
    PetscCall(PathReturn(p, &found, &report->status));
  }
  PetscCall(StateDestroy(&found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Viscous_Private(Path *p, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  PathLoop loop = {.metric   = &PathViscous,
                   .stop     = PETSC_INFINITY,
                   .piece    = CREEP,
                   .least    = LEAST * CREEP,
                   .most     = 1 / MECHANICS_SHIFT,
                   .attempts = CREEP_STEPS,
                   .load     = load,
                   .at       = to};

  PetscFunctionBegin;
  PetscCall(Begin_Private(p, NULL));
  PetscCall(PathFollow(p, &loop, report));
  PetscCall(ProblemSetViscosity(p->level->problem, 0, NULL));
  if (report->converged && InterfaceSlips(ProblemInterface(p->level->problem))) PetscCall(Slipped_Private(p, load, to, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the table --------------------------------------------------------------------------------------------------------------------- */

const Recovery PathRecoveries[PATH_RECOVERIES] = {
    [PATH_UNFREEZE] = {"unfreeze",
                       "once more from the start of the step, with the segmentation of contact no longer frozen; in the plane also from what was found", 0,
                       IsFrozen_Private, Unfreeze_Private},
    {"cut", "on another mesh, the way of the load from the accepted state again, in pieces", 0, IsCarried_Private, Cut_Private},
    {"overlap", "overlap that bodies at rest begin with is taken away in pieces, the deepest place first", 0, IsAtRest_Private, Overlap_Private},
    {"predictor", "once more with the other predictor: with friction, bodies carried to their new places first, or not; plastic material first elastic", 0,
     HasTwo_Private, Predictor_Private},
    {"descent", "down on the energy of contact and bodies, each iterate lower than the one before, to an equilibrium that is not near by", 1, PathCanDescend,
     PathDescend},
    {"viscous", "viscous regularisation: bodies creep to an equilibrium that is not near by, as when they snap", 2, Always_Private, Viscous_Private},
    [PATH_UNFOLDED] =
        {"unfolded", "cells that are turned inside out at a corner are not split while others are; where a finer mesh has none, nor are those that fold there",
         0, Always_Private, NULL},
    [PATH_COARSEN] = {"coarsen", "a load step that was not found on an adapted mesh: cells that adaptation made merge, and it begins again", 0, Always_Private,
                      NULL},
};

/* Is it time for an equilibrium farther off? Bodies in contact snap, or flow far; the end of what a load can be is no such place, and the user is told. A
   descent tells soon whether it helps; for viscosity a shorter step failed too, and with friction, where what is found depends on the way, another one. Then
   again each time the failures have doubled: what was in vain at a step may not be at a much shorter one. */
static PetscBool FarNow_Private(const Path *p, PetscInt first, const State *guess)
{
  if (p->data->num_contacts == 0 || p->limit_point) return PETSC_FALSE;
  return (PetscBool)(guess || p->failures == first || (p->failures > first && !(p->failures & (p->failures - 1))));
}

static PetscBool Applies_Private(const Path *p, PetscInt row, const State *guess)
{
  const Recovery    *r     = &PathRecoveries[row];
  const RecoveryMode mode  = p->recovery[row].mode;
  const PetscBool    slips = InterfaceSlips(ProblemInterface(p->level->problem));

  if (mode == RECOVERY_OFF || !r->run) return PETSC_FALSE;
  if (mode == RECOVERY_AUTO && r->far && !FarNow_Private(p, r->far + (slips ? 1 : 0), guess)) return PETSC_FALSE;
  return r->applies(p, guess);
}

PetscInt PathNumFar(const Path *p)
{
  PetscInt num = 0;

  for (PetscInt row = 0; row < PATH_RECOVERIES; ++row) num += PathRecoveries[row].far ? p->recovery[row].succeeded : 0;
  return num;
}

/* Run a row; *report is replaced where it succeeds. */
static PetscErrorCode Try_Private(Path *p, PetscInt row, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  const StepWork work = p->work;
  SolverReport   own  = {.reason = "not tried"};

  PetscFunctionBegin;
  ++p->recovery[row].tried;
  PetscCall(PathRecoveries[row].run(p, load, to, guess, &own));
  PetscCall(PetscInfo(NULL, "recovery %s: %s\n", PathRecoveries[row].name, own.converged ? "found" : own.reason));
  if (!own.converged) p->work = work;
  if (!own.converged) PetscFunctionReturn(PETSC_SUCCESS);
  ++p->recovery[row].succeeded;
  *report = own;
  if (!PathRecoveries[row].far) PetscFunctionReturn(PETSC_SUCCESS);
  if (PathNumFar(p) == 1) p->far_t = p->level->state.t;
  const char *warns = InterfaceSlips(ProblemInterface(p->level->problem)) ? "; with friction it depends on the way there: compare with shorter load steps" : "";
  PetscCall(
      PetscPrintf(ForestComm(p->level->forest),
                  "note: Newton's method found no equilibrium at t = %g from the state before; recovery %s did, it may be another one than that near by%s\n",
                  (double)p->level->state.t, PathRecoveries[row].name, warns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathRecover(Path *p, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  PetscFunctionBegin;
  if (!guess) ++p->failures;
  for (PetscInt row = 0; row < PATH_RECOVERIES && !report->converged && !report->undefined && !p->stopped; ++row) {
    if (Applies_Private(p, row, guess)) PetscCall(Try_Private(p, row, load, to, guess, report));
  }
  if (!report->converged && !guess) PetscCall(PathRestore(p, &p->level->accepted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const struct {
  const char *name, *help;
} Refusals[PATH_REFUSALS] = {
    [PATH_INSIDE]  = {"inside", "a solution in which bodies lie inside each other while their contact pair bears nothing is none"},
    [PATH_THROUGH] = {"through", "nor is one for which a body went right through the other of a pair that bears nothing"},
    [PATH_THROWN]  = {"thrown", "nor is one for which a body that nothing holds moved farther than its own size and all that is held"},
    [PATH_ROLLING] = {"rolling", "a load step in which bodies roll on each other by more than 0.2 (radians) is made again, shorter"},
};

/* ---- options ------------------------------------------------------------------------------------------------------------------------ */

static PetscErrorCode Mode_Private(const char *row, RecoveryMode *mode)
{
  static const char *const modes[] = {"auto", "on", "off", "RecoveryMode", "", NULL};
  char                     name[64], text[64];
  PetscBool                set, found = PETSC_TRUE;
  PetscInt                 value = *mode;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "-" PREFIX "%s", row));
  PetscCall(PetscOptionsGetString(NULL, NULL, name, text, sizeof(text), &set));
  if (set) PetscCall(PetscEListFind(3, modes, text, &value, &found));
  PetscCheckInput(found, "%s is '%s'; allowed: %s", name, text, MODES);
  *mode = (RecoveryMode)value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathOptions(Path *p)
{
  const char *known[PATH_RECOVERIES + PATH_REFUSALS];
  char        unknown[64] = "", **names, **values;
  PetscInt    num;

  PetscFunctionBegin;
  for (PetscInt row = 0; row < PATH_RECOVERIES; ++row) {
    known[row] = PathRecoveries[row].name;
    PetscCall(Mode_Private(known[row], &p->recovery[row].mode));
  }
  for (PetscInt i = 0; i < PATH_REFUSALS; ++i) {
    known[PATH_RECOVERIES + i] = Refusals[i].name;
    PetscCall(Mode_Private(Refusals[i].name, &p->refusal[i].mode));
  }
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values));
  for (PetscInt i = num - 1; i >= 0; --i) {
    if (!strncmp(names[i], PREFIX, strlen(PREFIX))) PetscCall(PetscStrncpy(unknown, names[i] + strlen(PREFIX), sizeof(unknown)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  PetscCheckInput(!unknown[0], "-" PREFIX "%s is no recovery; the nearest one is -" PREFIX "%s", unknown,
                  NameNearest(unknown, PATH_RECOVERIES + PATH_REFUSALS, known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathPrintHelp(MPI_Comm comm)
{
  char name[64];

  PetscFunctionBegin;
  PetscCall(HelpText(comm,
                     "\nRecoveries where a step or a finer mesh has no equilibrium that is found, in this order; on the command line only, default auto.\n"
                     "summary.json counts them. on: whenever possible, not only after a shorter step has failed too.\n\n"));
  for (PetscInt row = 0; row < PATH_RECOVERIES; ++row) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-" PREFIX "%s", PathRecoveries[row].name));
    PetscCall(HelpRow(comm, name, MODES, PathRecoveries[row].help));
  }
  for (PetscInt i = 0; i < PATH_REFUSALS; ++i) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "-" PREFIX "%s", Refusals[i].name));
    PetscCall(HelpRow(comm, name, MODES, Refusals[i].help));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
