/* Floor 7. From one equilibrium to the next: the loop that follows a parameter in pieces, and the recoveries where a piece leads to no solution. */
#pragma once
#include "solve.h"

enum { PATH_UNFREEZE = 0, PATH_UNFOLDED = 6, PATH_COARSEN, PATH_RECOVERIES }; /* rows of the table of recoveries */
enum { PATH_INSIDE, PATH_THROUGH, PATH_THROWN, PATH_ROLLING, PATH_REFUSALS }; /* why solutions are refused */

/* The part of a run that lives on one mesh; replaced as a whole at each adaptation. */
typedef struct {
  Forest  forest;
  Problem problem;
  Solver  solver;
  State   state;    /* being computed; its history is that of the start of the step (or of the last piece of it) */
  State   accepted; /* at the end of the last accepted load step */
} Level;

/* Takes the forest over. The states start at rest at time t. Collective. */
PetscErrorCode LevelCreate(const SceneData *, Forest, const int8_t leaf_order[], PetscReal t, Level *);
/* An input error when a cell of it is inverted in the reference mesh, a value at its time is not finite, or supports contradict each other until the end.
   Collective. */
PetscErrorCode LevelCheck(const SceneData *, const Level *);
PetscErrorCode LevelDestroy(Level *);

typedef enum { RECOVERY_AUTO, RECOVERY_ON, RECOVERY_OFF } RecoveryMode;
typedef struct {
  RecoveryMode mode;
  PetscInt     tried, succeeded;
} RecoveryCount;

/* Is what was found, level->state, no solution after all? */
typedef struct {
  RecoveryMode mode; /* off: it is not asked */
  PetscInt     num;  /* how often it was none */
  /* from: displacements (local array) of the state that was set out from; scale: of the forces that were found (ProblemStatus). *reason says why, else NULL.
     Collective. */
  PetscErrorCode (*ask)(Problem, const PetscReal from[], const State *, PetscReal scale, const char **reason);
} Refusal;

/* Dissipated in a load step: by viscous regularisation, and by friction of the pairs in the pieces of it that were committed before the last. */
typedef struct {
  PetscReal viscous, friction[FORM_PAIRS];
} StepWork;

/* What a run knows of its path, whatever mesh it is on: what solves took, what recoveries did. */
typedef struct {
  Level           *level; /* borrowed */
  const SceneData *data;  /* borrowed */
  PetscInt         step_cuts, newton_iterations, set_changes, single_switches, set_cycles, factorisations, single_failures;
  PetscInt         descent_iterations;               /* tangents of descents, besides Newton's */
  PetscInt         unstable, judged;                 /* accepted though unstable; equilibria found of which it is known whether they are stable */
  PetscInt         stabilised;                       /* that took the place of unstable ones … */
  PetscReal        stabilised_t;                     /* … the last of them at this time */
  PetscInt         begun_anew;                       /* runs before this one that went on with other roles of contact pairs */
  PetscInt         folded_left;                      /* cells that were to be split and stayed as they were, for they are folded at a corner */
  PetscInt         unstable_now;                     /* directions in which the last equilibrium found is unstable, 0: none is known */
  PetscInt         modifiers[SOLVER_MOST_MODIFIERS]; /* interventions of Newton's modifiers */
  PetscInt         modifiers_in_step, iterations_in_step, cuts_in_step;
  PetscInt         failures;                  /* attempts of this load step in vain; a step shorter than asked for begins with one */
  uint64_t         pressed;                   /* contact pairs in which nodes bore in a linear step, in vain or not, as bits */
  StepWork         work;                      /* of the step at hand */
  PetscReal        all_viscous_work;          /* of all steps accepted */
  PetscReal        flow_error, energy;        /* of all steps accepted, in the energy norm (StateFlowError); strain energy of the accepted state */
  PetscReal        far_t;                     /* when a recovery that looks farther off first found an equilibrium */
  PetscBool        limit_point;               /* loads are near a limit point: no equilibrium farther off is looked for */
  PetscBool        stopped;                   /* the run was asked to stop */
  ProblemStatus    status;                    /* of the last solution */
  RecoveryCount    recovery[PATH_RECOVERIES]; /* by row of the table */
  Refusal          refusal[PATH_REFUSALS];
} Path;

/* critical.c. The softest mode of the accepted state. */
typedef struct {
  PetscBool known, neutral;   /* neutral: it has no stiffness but round-off */
  PetscReal X[3], lost, from; /* where it moves most; share of its stiffness lost since t = from, 0: none, or not known */
  PetscInt  body;             /* there */
} Softest;
/* level->state becomes the accepted one. Not known along a path, or at t = 0; what was lost not with friction or plastic flow either. Collective. */
PetscErrorCode PathSoftest(Path *, Softest *);

/* ---- the loop (follow.c) ----------------------------------------------------------------------------------------------------- */

typedef struct _p_PathLoop PathLoop;

/* A parameter s that equilibria are followed in (metric.c). All functions are collective; those that are NULL do nothing. */
typedef struct {
  const char *name;
  PetscReal   cut, growth; /* factors of the length of a piece: after one that failed, after one that was found at once (along the load: easily) */
  PetscBool   load;        /* it carries the load: each piece is committed before the next begins, its cuts count, it grows after easy pieces only */
  /* Where a piece of length loop->piece from loop->s ends. */
  PetscReal (*end)(const Path *, const PathLoop *);
  /* level->state is the start of the piece, the prescribed motion its own: the problem becomes that at `to`. */
  PetscErrorCode (*set)(Path *, const PathLoop *, PetscReal to);
  /* level->state is the solution at `to`: note what follows, or refuse it (report->converged false, report->reason). */
  PetscErrorCode (*found)(Path *, const PathLoop *, PetscReal to, SolverReport *);
} PathMetric;

struct _p_PathLoop {
  const PathMetric *metric;
  PetscReal         s, stop;     /* where it stands, where it ends */
  PetscReal         piece;       /* length of the next piece */
  PetscReal         least, most; /* a shorter one is given up; it does not grow beyond */
  PetscInt          attempts;    /* that are left; 0: as many as it takes */
  PetscBool         step;        /* a load step: recoveries are tried, and the first piece found is the last */
  PetscReal         origin;      /* of the load: s of the accepted state */
  const PathLoop   *load;        /* of a loop at fixed load: that, … */
  PetscReal         at;          /* … and where it stands */
};

extern const PathMetric PathTime, PathArc, PathOverlap, PathViscous;

/* Follow loop->s from level->state: attempt a piece; accept it and go on from there, or go back to its start and try a shorter one. report: of the last
   attempt; converged: level->state is the solution where the loop ended. Else level->state and prescribed motion are those of the start of the piece that
   failed. Collective. */
PetscErrorCode PathFollow(Path *, PathLoop *, SolverReport *);
/* One piece, to s = `to`; counted. Collective. */
PetscErrorCode PathAttempt(Path *, const PathLoop *, PetscReal to, SolverReport *);
/* Displacements (local array) of level->state, for the caller to free; those of the start of a piece are what is set out from. Collective. */
PetscErrorCode PathFrom(const Path *, PetscReal **from);
/* A solve that set out from there has found level->state at s = `to`: what the metric notes; refused: report->converged false, report->reason. Collective. */
PetscErrorCode PathFound(Path *, const PathLoop *, const PetscReal from[], PetscReal to, SolverReport *);
/* Ask all refusals of level->state, of which a solve reports, that are not off; counted. Collective. */
PetscErrorCode PathRefuse(Path *, const PetscReal from[], const SolverReport *, const char **reason);
/* What a solve took; equilibrium: what was found is one, not a step on the way to it. */
void PathCount(Path *, const SolverReport *, PetscBool equilibrium);
/* level->state := from, with its time and prescribed motion. Collective. */
PetscErrorCode PathRestore(Path *, const State *from);
/* Problem and contact become those at level->state, which is a solution, as a solve that ends there leaves them. Collective. */
PetscErrorCode PathRefresh(Path *);
/* Back to a solution with this status after another attempt at the same load and prescribed motion: level->state := found, and PathRefresh. Collective. */
PetscErrorCode PathReturn(Path *, const State *found, const ProblemStatus *status);
/* The prescribed motion as it was at time t. Collective. */
PetscErrorCode PathPrescribe(Problem, PetscReal t);
/* Did nodes of a pair (ContactSpec.pair) bear in a linear step of this run, in vain or not? Not collective. */
PetscBool PathPressed(const Path *, PetscInt pair);
/* A load step begins: counters of one step. is_short: it is shorter than asked for, since an earlier one failed. */
void PathBegin(Path *, PetscBool is_short);
/* Where a step of dt from t ends: not beyond load.end, nor beyond a corner of an amplitude. */
PetscReal PathStepEnd(const SceneData *, PetscReal t, PetscReal dt);

/* ---- recoveries (recover.c) --------------------------------------------------------------------------------------------------- */

/* Where an attempt at s = `to` of the load loop failed. guess: the state it began with if that is near `to` (after adaptation: carried over), NULL: it was the
   accepted one. */
typedef struct {
  const char *name, *help;
  PetscInt    far; /* what it finds may lie on another branch of equilibria: auto tries it where a load step has failed so often, and then each time failures
 have doubled, with friction once more before; 0: it does not */
  PetscBool (*applies)(const Path *, const State *guess);
  /* NULL: the row is not of this mesh; who adapts tries it (app/adaptstep.c), and counts. Look for level->state at `to`; level->state is any, and of no use
   * afterwards where report->converged is false. Collective. */
  PetscErrorCode (*run)(Path *, const PathLoop *load, PetscReal to, const State *guess, SolverReport *);
} Recovery;

/* Did the state carried over to another mesh take the place of an unstable one, to which the way of the load leads? guess NULL: no. Not collective. */
PetscBool PathWasUnstable(const Path *, const State *guess);
/* descend.c: the row of descent (solve/descent.c). */
PetscBool      PathCanDescend(const Path *, const State *guess);
PetscErrorCode PathDescend(Path *, const PathLoop *load, PetscReal to, const State *guess, SolverReport *);
/* load.stable: where the last equilibrium, level->state, is unstable, it gives way to a stable one, if that can be had. *changed: it did. Collective. */
PetscErrorCode PathStabilise(Path *, PetscBool *changed);

extern const Recovery PathRecoveries[PATH_RECOVERIES];

/* Try the rows of the table in turn until one finds level->state; *report is of that one then, else as it was. Collective. */
PetscErrorCode PathRecover(Path *, const PathLoop *load, PetscReal to, const State *guess, SolverReport *);
/* Equilibria of the run that recoveries found which look farther off. Not collective. */
PetscInt PathNumFar(const Path *);
/* Options -path_<name> on|off|auto of recoveries and of refusals: an input error when one is unknown or its value not allowed. */
PetscErrorCode PathOptions(Path *);
PetscErrorCode PathPrintHelp(MPI_Comm);
