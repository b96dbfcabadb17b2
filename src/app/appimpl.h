/* Private to app: what a run holds. */
#pragma once
#include "diagnose.h"
#include "estimate.h"
#include "output.h"
#include "solve.h"
#include "transfer.h"

#define EASY_ITERATIONS 6 /* a step that took no more Newton iterations lets the next one grow */
#define GROWTH 1.5
/* Reasons to end adaptation that decide how a run has ended (verdict.c). */
#define WITHIN_TOLERANCE "tolerance"
#define UNSTRESSED "free of stress"
#define FACES_FINE "contact faces fine enough"
#define NONE_FINER "no equilibrium found on a finer mesh"

/* The part of a run that lives on one mesh; replaced as a whole at each adaptation. */
typedef struct {
  Forest  forest;
  Problem problem;
  Solver  solver;
  State   state;    /* being computed; its history is that of the start of the step (or of the last piece of it) */
  State   accepted; /* at the end of the last accepted load step */
} Level;

typedef struct {
  MPI_Comm         comm;
  Scene            scene;
  const SceneData *data;
  Level            level;
  Estimate         estimate;
  PetscBool        estimated;
  Balance          balance;
  Probes           probes;
  Writer           writer;
  History          history;
  Monitor          monitor;
  PetscInt         path; /* adapt.repeat: path: how often it has begun again; else 0 */
  Estimate         most; /* with it: of the steps of this path that were above the tolerance */
  PetscInt       load_steps, step_cuts, adapt_passes, newton_iterations, passes_in_step, iterations_in_step, cuts_in_step, set_changes, set_cycles, told_cycles;
  PetscInt       factorisations, single_failures, unstable, judged;   /* judged: solutions of which it is known whether they are stable */
  PetscInt       modifiers[SOLVER_MOST_MODIFIERS], modifiers_in_step; /* interventions of Newton's modifiers; of all of them in this step */
  ProblemStatus  status;                                              /* of the last solution */
  PetscLogDouble start;
  PetscReal      arc, arc_first;                            /* along a path: length of the next step, of the first one; 0: not yet */
  PetscReal      haste;                                     /* displacement per time in the last step, over that since the start */
  PetscInt       relaxed_steps;                             /* steps to an equilibrium that was not near by */
  PetscReal      drag_work, all_drag_work;                  /* energy that drag took in the step at hand, in all */
  const char    *failure;                                   /* why the run gave up, NULL while it goes on */
  PetscBool      stopped;                                   /* the run was asked to stop */
  char           reason[PETSC_MAX_PATH_LEN + MORTISE_NAME]; /* why it was, or what its solutions lack */
  const char    *adapt_stop;                                /* why the last adaptation ended: tolerance, max_passes, max_cells, … */
  PetscReal      above_error;                               /* largest estimate of a load step that stayed above the tolerance; 0: none did */
  PetscInt       gave_up;                                   /* 1: in one of them a mesh as fine as asked had no solution that was found, or could not be made */
  PetscBool      inversion_told;                            /* that refinement would invert a cell, once */
  PetscInt      *subdivided;                                /* owned [num_contacts] by contact.<pair>.subdivide: auto, so often, or tried */
  PetscBool     *touched;                                   /* owned [num_contacts] a node was in contact at some time of this run */
  ReportRow      last;
  PetscReal      dt;                                                          /* length of the next load step */
  Checkpoint     snapshot;                                                    /* owned: copy of the state at the end of the last accepted load step */
  PetscInt       snapshot_revision;                                           /* of the forest it stands on */
  PetscBool      written;                                                     /* the file is this copy */
  char           checkpoint[PETSC_MAX_PATH_LEN], restart[PETSC_MAX_PATH_LEN]; /* file to write; file to go on from, "": none */
} App;

/* start.c: PetscInitialize, cheaply for a single process. */
PetscErrorCode AppInitialize(int argc, char **argv);
/* loadstep.c: all load steps; app->failure is set when the solver gives up. Collective. */
PetscErrorCode AppRun(App *);
/* adaptstep.c: after a solution at the current time, refine and solve again until the tolerance or a limit is met. */
PetscErrorCode AppAdapt(App *);
/* refine.c: the prescribed motion as it was at time t. Collective. */
PetscErrorCode AppPrescribeAt(Problem, PetscReal t);
/* Layers at contact faces to be subdivided first (subdivide: auto); layers->split NULL: none. Where nothing else is to be adapted, adaptation ends with the
   last one: app->adapt_stop. */
PetscErrorCode AppLayers(App *, const Estimate *, MarkList *layers);
/* Adapt to these layers (taken over), if any, else mark and adapt. The level is another one then, its states carried over or (afresh) at rest at t = 0, and the
   old one is the caller's; *adapted false when nothing may or need be refined, or (refused) the mesh could not be made, and app->adapt_stop says why.
   Collective. */
PetscErrorCode AppRefine(App *, const Estimate *, MarkList *layers, PetscBool afresh, PetscBool *adapted, PetscBool *refused);
/* verdict.c: adaptation has ended at app->adapt_stop with this estimate; gave_up: for want of a finer mesh with a solution, not by a limit. */
void AppJudge(App *, PetscReal error, PetscBool gave_up);
/* Status of the run as in summary.json, and the words that go with it, "" when there is nothing to say; valid as long as the run. */
const char    *AppStatus(const App *);
PetscErrorCode AppReason(App *, const char **reason);
/* repeat.c: is the mesh to be adapted at all? Is there stress of which an error can be estimated? Not collective. */
PetscBool AppIsAdaptive(const App *);
PetscBool AppIsStressed(const App *);
/* A load step of a path that may be computed again was solved and its error estimated. */
PetscErrorCode AppRemember(App *);
/* At the end of the path: begin again, at rest at t = 0 on a finer mesh, where a step was above the tolerance and no limit is met; the results of the path are
   put aside until the next one has come to its end (OutputSetAside). Collective. */
PetscErrorCode AppRepeat(App *, PetscBool *again);
/* advise.c. At its beginning: bodies that only contact holds, on standard output. Collective. */
PetscErrorCode AppTellFree(const App *);
/* At the end of a run: what there is besides, what looks wrong, and what may help. Collective. */
PetscErrorCode AppAdvise(const App *);
/* arcstep.c. A step of app->arc along the path; app->failure is set when there is none. Collective. */
PetscErrorCode AppPathStep(App *, PetscBool *ok);
/* The state is about to become the accepted one: the path goes on in the direction from there to here. Collective. */
PetscErrorCode AppPathAccept(App *);
/* Where a step of dt from t ends: not beyond the end, nor beyond a corner of an amplitude. */
PetscReal AppStepEnd(const SceneData *, PetscReal t, PetscReal dt);
/* Count what a solve took. */
void AppCount(App *, const SolverReport *);
/* One solve from level.state for time t; counted; converged: level.state is at t. Collective. */
PetscErrorCode AppAttempt(App *, PetscReal t, SolverReport *);
/* Bring level.state from its time to t on the current mesh, in as many pieces as it takes, all but the last committed; *ok false when even one of length
 * `smallest` failed. */
PetscErrorCode AppAdvance(App *, PetscReal t, PetscReal smallest, PetscBool *ok);
/* relax.c: from the accepted state to an equilibrium at t that may be far from it; app->drag_work is what drag took on the way. Collective. */
PetscErrorCode AppRelax(App *, PetscReal t, PetscBool *ok);
PetscErrorCode AppEstimate(App *);
/* coupling.c: pairs of leaves that face each other in contact, each once, the same on every rank (one rank: none); freed by the caller. Collective. */
PetscErrorCode AppContactPairs(App *, PetscInt *num, PetscInt (**pairs)[2]);

/* restart.c. The options -restart and -max_seconds; signals are heard from now on. Collective. */
PetscErrorCode AppOptions(App *);
PetscErrorCode AppPrintHelp(MPI_Comm);
/* Copy the accepted state and all counters; write the copy, if its file is not yet that; remove the file of an earlier run, and what
   it put aside. Collective. */
PetscErrorCode AppSnapshot(App *);
PetscErrorCode AppCheckpoint(App *);
PetscErrorCode AppForget(App *);
/* The run was asked to stop: write the copy and return to it. Collective. */
PetscErrorCode AppStop(App *);
/* Read the checkpoint to go on from and check it against scene and coarse mesh; then the level and all counters from it (destroys *coarse). Nothing is written.
   Collective. */
PetscErrorCode AppResume(App *, Forest *coarse);

/* summary.c. What the run took so far. Not collective. */
ReportRow AppTotal(const App *);
/* Write summary.json, of the last accepted state. Collective. */
PetscErrorCode AppSummary(App *, const char *status, const char *reason);

/* files.c. Tables and fields, afresh or after the load step to go on from: first everything that may refuse. Collective. */
PetscErrorCode AppOpenFiles(App *);
/* Would those in output.directory be refused to go on with? Writes nothing. Collective. */
PetscErrorCode AppCheckFiles(App *);

PetscErrorCode LevelCreate(const SceneData *, Forest, const int8_t leaf_order[], PetscReal t, Level *);
/* An input error when a cell of it is inverted in the reference mesh, a value at its time is not finite, or supports contradict each other until the end.
   Collective. */
PetscErrorCode LevelCheck(const SceneData *, const Level *);
PetscErrorCode LevelDestroy(Level *);
