/* Private to app: what a run holds. */
#pragma once
#include "diagnose.h"
#include "estimate.h"
#include "needs.h"
#include "path.h"
#include "transfer.h"

/* Reasons to end adaptation that decide how a run has ended (verdict.c). */
#define WITHIN_TOLERANCE "tolerance"
#define UNSTRESSED "free of stress"
#define FACES_FINE "contact faces fine enough"
#define NONE_FINER "no equilibrium found on a finer mesh"
#define NOTHING_LEFT "nothing left to refine"
#define INVERTS "refinement inverts a curved cell"

/* all: what is marked, states carried over; afresh: the same, states at rest; unfolded: all but the cells in which the state is folded. */
typedef enum { REFINE_ALL, REFINE_AFRESH, REFINE_UNFOLDED } RefineMode;

/* A load step whose estimated error stayed above the tolerance: at t, and why; norm: largest energy norm from it to the step at hand. */
/* What nothing holds of a body (AdriftFind), axes as bits: those that were free at every accepted step of this path, those of others that became so, first at
   time t. */
typedef struct {
  PetscInt  always, lost;
  PetscReal t;
} Adrift;

typedef struct {
  PetscReal t, error, norm;
  PetscInt  cause; /* verdict.c */
} Missed;

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
  Path             path;
  PetscInt         repeats; /* adapt.repeat: path: how often it has begun again; else 0 */
  Estimate         largest; /* with it: of the steps of this path that were above the tolerance */
  PetscInt         load_steps, adapt_passes, passes_in_step, told_cycles;
  uint64_t         exchanged, settled;                        /* pairs, by number: with other roles for a corner that presses; with roles that stay */
  PetscBool        anew;                                      /* the run is to begin again with other ones (roles.c) … */
  PetscInt         num_corners;                               /* … whose first mesh … */
  RefineSpec      *corner;                                    /* … is refined there, group: number of a pair; owned by what begins it */
  PetscLogDouble   start, accepted_at;                        /* of the run; when the last load step was accepted */
  PetscReal        later_solutions;                           /* seconds in the first solution of each load step but the first */
  PetscReal        arc, arc_first;                            /* along a path: length of the next step, of the first one; 0: not yet */
  PetscReal        speed;                                     /* limit-point indicator: displacement per time in the last step, over that since the start */
  const char      *failure;                                   /* why the run gave up, NULL while it goes on */
  char             reason[PETSC_MAX_PATH_LEN + MORTISE_NAME]; /* why it was, or what its solutions lack */
  const char      *adapt_stop;                                /* why the last adaptation ended: tolerance, max_passes, max_cells, … */
  PetscInt         num_missed;
  Missed          *missed;         /* owned [num_missed] */
  PetscBool        inversion_told; /* that refinement would invert a cell, once */
  int8_t          *first_level;    /* owned [coarse cells]: fewest splits of a leaf, all directions, before adaptation; NULL: nothing merges */
  PetscInt        *subdivided;     /* owned [num_contacts] by contact.<pair>.subdivide: auto, so often, or tried */
  FrictionFigures *friction;       /* owned, by ContactSpec.pair: of the last accepted load step of this run */
  PetscInt        *touched;        /* owned, by ContactSpec.pair: load step in which it was in contact first, at a node or between; 0: none */
  PetscReal        rough_error, rough_t, rough_norm; /* largest estimate of an accepted step, its time; largest norm */
  Folded           folded;                           /* most cells that an accepted step folded … */
  PetscReal        folded_t;                         /* … and its time */
  PetscReal        unstable_t;                       /* when a solution was first accepted though unstable */
  PetscBool        passage_told;                     /* that a surface passes through itself */
  PetscInt         flowed, flowed_coarse;            /* has material at the accepted state; meshes refined after that, which went on from there */
  PetscBool        apart_known;                      /* bodies that no pair is between: there are none, or that they pass through each other is told */
  PetscReal        most_scale;                       /* largest ProblemStatus.scale of an accepted step */
  Adrift          *adrift;                           /* owned [num_bodies] */
  PetscBool        mirror[3];                        /* planes of symmetry that are not used (NeedsFindMirrors) … */
  PetscReal        mirror_at[3];                     /* … and where they are */
  PetscReal        most_energy;                      /* stored at the end of an accepted load step */
  Needs            needs;                            /* what could have been left out */
  ReportRow        last;
  PetscReal        dt;                                                          /* length of the next load step */
  Checkpoint       snapshot;                                                    /* owned: copy of the state at the end of the last accepted load step */
  PetscInt         snapshot_revision;                                           /* of the forest it stands on */
  PetscBool        written;                                                     /* the file is this copy */
  char             checkpoint[PETSC_MAX_PATH_LEN], restart[PETSC_MAX_PATH_LEN]; /* file to write; file to go on from, "": none */
  char             before[PETSC_MAX_PATH_LEN];                                  /* the checkpoint before it */
} App;

/* kernels.c: OpenBLAS takes the dense kernels that this processor can run, where it does not know the processor. Before threads and MPI. */
void AppKernels(void);

/* start.c: PetscInitialize, cheaply for a single process. A file of -options_file that cannot be read is an input error. */
PetscErrorCode AppInitialize(int argc, char **argv);
/* optionfiles.c: is a file of options that PETSc will read one that names itself, or has a quotation mark that is not closed? told: which, and how. Before
   anything is started. */
PetscBool AppOptionsWrong(int argc, char **argv, size_t capacity, char told[]);
/* roles.c. Before SceneSetUp: the run goes on with the roles of the checkpoint. Collective. */
PetscErrorCode AppReadRoles(App *);
/* At the solution of a load step, or where none was found: are there pairs whose corners press within facets of the other side? The run is to begin anew
   (app->anew) with their roles exchanged then. Collective. */
PetscErrorCode AppCheckRoles(App *, PetscBool found);
/* No solution was found, or none on finer meshes: where roles were exchanged the run is to begin anew with the former ones, which stay. Collective. */
PetscErrorCode AppReturnRoles(App *);
/* loadstep.c: all load steps; app->failure is set when the solver gives up. Collective. */
PetscErrorCode AppRun(App *);
/* The next step from the accepted state. */
PathLoop AppNextStep(const App *);
/* adaptstep.c: after a solution at the current time, refine and solve again until the tolerance or a limit is met. */
PetscErrorCode AppAdapt(App *);
/* Layers at contact faces to be subdivided first (subdivide: auto); layers->split NULL: none. Where nothing else is to be adapted, adaptation ends with the
   last one: app->adapt_stop. */
PetscErrorCode AppLayers(App *, const Estimate *, MarkList *layers);
/* Adapt to these layers (taken over), if any, else mark and adapt. The level is another one then, its states carried over or (afresh) at rest at t = 0, and the
   old one is the caller's; *adapted false when nothing may or need be refined, or (refused) the mesh could not be made, and app->adapt_stop says why.
   Collective. */
PetscErrorCode AppRefine(App *, const Estimate *, MarkList *layers, RefineMode, PetscBool *adapted, PetscBool *refused);
/* refine.c: to the mesh that the list asks for, states carried over; the level at hand is the caller's then. *refused: why not, else NULL. Collective. */
PetscErrorCode AppMoveTo(App *, MarkList *, const char **refused);
/* coarsen.c. Before the first load step: how far the mesh that the scene asks for is split, where states are carried over to other meshes. Not collective. */
PetscErrorCode AppNoteFirstMesh(App *, Forest);
/* A load step was not found: once more from the accepted state with one generation of the cells that adaptation made merged, those of bodies that deform, and
   again as long as there are any. converged: the level is the coarser one, loop as it ended there; else level and report are as before. Collective. */
PetscErrorCode AppCoarsen(App *, PathLoop *loop, SolverReport *);
/* verdict.c: adaptation of the state has ended at app->adapt_stop with this estimated error (absolute) and energy norm; refused: the mesh could not be refined
   as asked. */
PetscErrorCode AppJudge(App *, PetscReal error, PetscReal norm, PetscBool refused);
/* Status of the run as in summary.json, and the words that go with it, "" when there is nothing to say; valid as long as the run. */
const char    *AppStatus(const App *);
PetscErrorCode AppReason(App *, const char **reason);
/* repeat.c: is the mesh to be adapted at all? By the last estimate, do the sides of a pair that bears nothing overlap, so little that no node has seen it?
   Is there something to estimate an error of, stress or such an overlap? Not collective. */
PetscBool AppIsAdaptive(const App *);
PetscBool AppOverlaps(const App *);
PetscBool AppIsStressed(const App *);
/* A load step of a path that may be computed again was solved and its error estimated. */
PetscErrorCode AppRemember(App *);
/* At the end of the path: begin again, at rest at t = 0 on a finer mesh, where a step was above the tolerance and no limit is met; the results of the path are
   put aside until the next one has come to its end (OutputSetAside). Collective. */
PetscErrorCode AppRepeat(App *, PetscBool *again);
/* advise.c. At its beginning: bodies that only contact holds, on standard output. Collective. */
PetscErrorCode AppTellFree(const App *);
/* watch.c. Before the first load step of a path: no body has been held yet. Not collective. */
void AppForgetAdrift(App *);
/* Axes in words, by their bits. */
const char *AppAxesName(PetscInt axes);
/* -check: symmetry that is not used. Collective. */
PetscErrorCode AppTellMirrors(const App *);
/* At the end of a run: what there is besides, what looks wrong, and what may help. Collective. */
PetscErrorCode AppAdvise(const App *);
PetscErrorCode AppEstimate(App *);
/* coupling.c: pairs of leaves that face each other in contact, each once, the same on every rank (one rank: none); freed by the caller. Collective. */
PetscErrorCode AppContactPairs(App *, PetscInt *num, PetscInt (**pairs)[2]);

/* restart.c. The options -restart and -max_seconds; signals are heard from now on. Collective. */
PetscErrorCode AppOptions(App *);
PetscErrorCode AppPrintHelp(MPI_Comm);
/* describe.c. Everything of the tables that a manual, an editor or a shell asks for, as one JSON object (-help json). Collective. */
PetscErrorCode AppDescribe(MPI_Comm);
/* What each exit status means, ended by text NULL (describe.c). */
typedef struct {
  int         status;
  const char *text;
} ExitStatus;
extern const ExitStatus ExitStatuses[];
/* new.c. `mortise new NAME`: a commented scene and its geometry to start from; an input error where one of both files is there. Collective. */
PetscErrorCode AppNew(MPI_Comm, int num_names, char *const names[]);
/* unknown.c. After all that ask for options of their own: is there one that nobody knows, PETSc included? An input error. Not collective. */
PetscErrorCode AppCheckOptions(Scene);
/* viewers.c. An input error where an option has PETSc write a file that cannot be written, is there, or is the run's own. Collective. */
PetscErrorCode AppCheckViewers(const App *);
/* Copy the accepted state and all counters; write the copy, if its file is not yet that; remove the file of an earlier run, and what
   it put aside. Collective. */
PetscErrorCode AppSnapshot(App *);
PetscErrorCode AppCheckpoint(App *);
PetscErrorCode AppForget(App *);
PetscErrorCode AppForgetSummary(App *); /* of an earlier run: how that has ended says nothing of this one */
/* At the end: the checkpoint before the last one goes, if that is whole. Collective. */
PetscErrorCode AppKeepLast(App *);
/* The run was asked to stop: write the copy and return to it. Collective. */
PetscErrorCode AppStop(App *);
/* Read the checkpoint to go on from and check it against scene and coarse mesh; then the level and all counters from it (destroys *coarse). Nothing is written.
   Collective. */
PetscErrorCode AppResume(App *, Forest *coarse);

/* watch.c. Path.refusal: states that no contact opposes though bodies lie inside each other, or went through each other, are no solutions. Collective. */
PetscErrorCode AppRefuseInside(Problem, const PetscReal from[], const State *, PetscReal scale, const char **reason);
PetscErrorCode AppRefuseThrough(Problem, const PetscReal from[], const State *, PetscReal scale, const char **reason);
PetscErrorCode AppRefuseThrown(Problem, const PetscReal from[], const State *, PetscReal scale, const char **reason);
/* After each accepted load step: does its state ask for a warning? Collective. */
PetscErrorCode AppWatch(App *);
/* Before the first load step: a warning of bodies that overlap where no pair is between them. Collective. */
PetscErrorCode AppTellOverlap(App *);
/* The warnings that sum up a run, before its summary is written. Collective. */
PetscErrorCode AppWarn(App *);

/* handover.c. -solution_view: the last accepted displacement through a viewer of PETSc; an input error where the option names none of these. Collective. */
#define APP_SOLUTION_VIEW "vtk:FILE.vtu|hdf5:FILE|binary:FILE"
PetscErrorCode AppCheckHandOver(void);
PetscErrorCode AppHandOver(App *);

/* summary.c. What the run took so far. Not collective. */
ReportRow AppTotal(const App *);
/* Write summary.json, of the last accepted state. Collective. */
PetscErrorCode AppSummary(App *, const char *status, const char *reason);

/* files.c. Tables and fields, afresh or after the load step to go on from: first everything that may refuse. Collective. */
PetscErrorCode AppOpenFiles(App *);
/* Would those in output.directory be refused to go on with? Writes nothing. Collective. */
PetscErrorCode AppCheckFiles(App *);
