/* mortise: finite-deformation contact with error control. The story goes on in loadstep.c and adaptstep.c. */
#include "appimpl.h"
#include <signal.h>
#include <unistd.h>

static PetscErrorCode Begin_Private(App *app, Forest *forest)
{
  int8_t *orders;

  PetscFunctionBegin;
  PetscCall(NeedsFindMirrors(app->data, *forest, app->mirror, app->mirror_at));
  PetscCall(ProblemInitialOrders(app->data, *forest, &orders));
  PetscCall(LevelCreate(app->data, *forest, orders, 0, &app->level));
  *forest = NULL;
  PetscCall(LevelCheck(app->data, &app->level));
  PetscCall(PetscFree(orders));
  app->dt         = app->data->load.step;
  app->adapt_stop = "";
  PetscCall(AppSnapshot(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything that may refuse before the first solve, but for what is found in output.directory. Takes the forest over. */
static PetscErrorCode Prepare_Private(App *app, Forest *forest)
{
  PetscFunctionBegin;
  PetscCall(ProbesCreate(app->data, *forest, &app->probes));
  PetscCall(PetscCalloc3(app->data->num_contacts, &app->subdivided, app->data->num_contacts, &app->touched, app->data->num_contacts, &app->friction));
  PetscCall(PetscMalloc1(app->data->mechanics.num_bodies, &app->adrift));
  AppForgetAdrift(app);
  PetscCall(AppNoteFirstMesh(app, *forest));
  if (app->restart[0])
    PetscCall(AppResume(app, forest));
  else
    PetscCall(Begin_Private(app, forest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* -check: what would be solved, and from what on. */
static PetscErrorCode View_Private(App *app)
{
  PetscFunctionBegin;
  PetscCall(AppCheckFiles(app));
  PetscCall(SceneView(app->scene, app->level.forest, PETSC_VIEWER_STDOUT_WORLD));
  const PetscInt dofs = ProblemNumDofs(app->level.problem);
  PetscCall(AppTellFree(app));
  PetscCall(AppTellOverlap(app));
  PetscCall(AppTellMirrors(app));
  PetscCall(PetscPrintf(app->comm, "  %" PetscInt_FMT " unknowns at t = %.6g\n", dofs, (double)app->level.accepted.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Open_Private(App *app)
{
  const ReportRow total = AppTotal(app);

  PetscFunctionBegin;
  PetscCall(AppOpenFiles(app));
  PetscCall(MonitorCreate(app->comm, app->data, &app->monitor));
  PetscCall(AppTellFree(app));
  PetscCall(AppTellOverlap(app));
  PetscCall(MonitorHeader(app->monitor, app->level.problem));
  if (app->restart[0]) PetscCall(MonitorResume(app->monitor, app->restart, &total));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Summarise_Private(App *app)
{
  const char *status = AppStatus(app), *reason;

  PetscFunctionBegin;
  PetscCall(AppWarn(app));
  PetscCall(AppReason(app, &reason));
  PetscCall(AppSummary(app, status, reason));
  const ReportRow total = AppTotal(app);
  PetscCall(MonitorFooter(app->monitor, status, reason, app->adapt_stop, app->written, &total, app->load_steps ? &app->last : NULL));
  PetscCall(AppAdvise(app));
  PetscCall(AppHandOver(app));
  PetscCall(AppKeepLast(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Close_Private(App *app)
{
  PetscFunctionBegin;
  PetscCall(MonitorDestroy(&app->monitor));
  PetscCall(HistoryDestroy(&app->history));
  if (app->writer) PetscCall(WriterDestroy(&app->writer));
  PetscCall(ProbesDestroy(&app->probes));
  if (app->estimated) PetscCall(EstimateDestroy(&app->estimate));
  PetscCall(EstimateDestroy(&app->largest));
  if (app->balance.body) PetscCall(BalanceDestroy(&app->balance));
  PetscCall(LevelDestroy(&app->level));
  PetscCall(CheckpointDestroy(&app->snapshot));
  OutputUnlock();
  PetscCall(NeedsDestroy(&app->needs));
  PetscCall(PetscFree3(app->subdivided, app->touched, app->friction));
  PetscCall(FreeAll(3, (void *[]){&app->first_level, &app->adrift, &app->missed}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One job, one scene: what each process would read by itself is one thing. */
static PetscErrorCode CheckArguments_Private(MPI_Comm comm, int argc, char **argv)
{
  uint64_t hash = 0, range[2];

  PetscFunctionBegin;
  for (int i = 1; i < argc; ++i) hash = HashBytes(hash, argv[i], strlen(argv[i]) + 1);
  range[0] = hash;
  range[1] = ~hash;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, range, 2, MPI_UINT64_T, MPI_MIN, comm));
  PetscCheckInput(range[0] == ~range[1], "the processes of this job were started with different arguments; a job has one scene and one set of options");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a run that begins anew with other roles of its pairs has from the one before. */
typedef struct {
  PetscBool      anew;
  PetscLogDouble start;
  uint64_t       exchanged, settled;
  PetscInt       num_corners;
  RefineSpec    *corner; /* owned */
  PetscInt       newton_iterations, factorisations, times;
} Begun;

/* One run, from the scene to the summary; anew: it ended where another one is to begin. */
static PetscErrorCode Run_Private(int argc, char **argv, Begun *begun, int *status)
{
  App    app = {.comm        = PETSC_COMM_WORLD,
                .start       = begun->start,
                .exchanged   = begun->exchanged,
                .settled     = begun->settled,
                .num_corners = begun->num_corners,
                .corner      = begun->corner};
  Forest forest;

  PetscFunctionBegin;
  PetscCall(SceneCreate(app.comm, argc, argv, &app.scene));
  PetscCall(SceneGetData(app.scene, &app.data));
  app.path.refusal[PATH_INSIDE].ask  = AppRefuseInside;
  app.path.refusal[PATH_THROUGH].ask = AppRefuseThrough;
  app.path.refusal[PATH_THROWN].ask  = AppRefuseThrown;
  app.path.level                     = &app.level;
  app.path.data                      = app.data;
  PetscCall(AppOptions(&app));
  if (begun->anew) app.restart[0] = 0;
  PetscCall(SolverCheckOptions());
  PetscCall(PathOptions(&app.path));
  PetscCall(AppCheckOptions(app.scene));
  PetscCall(AppCheckViewers(&app));
  PetscCall(StageBegin(STAGE_MESH));
  PetscCall(AppReadRoles(&app));
  PetscCall(SceneSetUp(app.scene, &forest));
  PetscCall(StageEnd(STAGE_MESH));
  PetscCall(Prepare_Private(&app, &forest));
  app.path.newton_iterations += begun->newton_iterations;
  app.path.factorisations += begun->factorisations;
  app.path.begun_anew += begun->times;
  if (SceneCheckOnly(app.scene))
    PetscCall(View_Private(&app));
  else {
    PetscCall(Open_Private(&app));
    PetscCall(AppRun(&app));
    if (!app.anew) PetscCall(Summarise_Private(&app));
  }
  PetscCall(Close_Private(&app));
  PetscCall(SceneDestroy(&app.scene));
  *status = app.failure ? 2 : app.path.stopped ? 3 : app.num_missed ? 2 : 0;
  *begun  = (Begun){.anew              = app.anew,
                    .start             = app.start,
                    .exchanged         = app.exchanged,
                    .settled           = app.settled,
                    .num_corners       = app.num_corners,
                    .corner            = app.corner,
                    .newton_iterations = app.path.newton_iterations,
                    .factorisations    = app.path.factorisations,
                    .times             = app.path.begun_anew + 1};
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve_Private(int argc, char **argv, int *status)
{
  Begun begun = {0};

  PetscFunctionBegin;
  PetscCall(PetscTime(&begun.start));
  PetscCall(StopWatch(0));
  PetscCheckInput(argc > 1, "no scene was named; say mortise SCENE.yml, or mortise -help");
  PetscCall(CheckArguments_Private(PETSC_COMM_WORLD, argc, argv));
  do {
    PetscCall(Run_Private(argc, argv, &begun, status));
    if (begun.anew) WarningForget();
  } while (begun.anew);
  PetscCall(PetscFree(begun.corner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Asked_Private(int argc, char **argv, const char *option)
{
  for (int i = 1; i < argc; ++i) {
    if (!strcmp(argv[i], option)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Options with a first word of PETSc's that nothing asked for are most likely mistyped: say so. PetscFinalize asks for two more. */
static PetscErrorCode UnusedOptions_Private(void)
{
  PetscInt  num;
  PetscBool set;
  char    **names, **values;

  PetscFunctionBegin;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-options_left", &set));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-options_view", &set));
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values));
  for (PetscInt i = 0; i < num; ++i)
    (void)ErrorInput("nothing used the option -%.80s: it is spelt wrong, or of something that this run did without", names[i]); /* told as one, no error */
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* word: keys and options that have it in their name, nothing else; "": everything. */
static PetscErrorCode Help_Private(const char *word)
{
  PetscFunctionBegin;
  HelpSeek(word);
  PetscCall(ScenePrintHelp(PETSC_COMM_WORLD));
  PetscCall(SolverPrintHelp(PETSC_COMM_WORLD));
  PetscCall(PathPrintHelp(PETSC_COMM_WORLD));
  PetscCall(AppPrintHelp(PETSC_COMM_WORLD));
  PetscCall(
      HelpText(PETSC_COMM_WORLD,
               "\nA run prints a line for each adaptive pass: load step, pass, t, cells, unknowns (dofs), Newton iterations, nodes under contact pressure,\n"
               "relative estimated error, magnitude of the contact force (of several pairs the sum of the magnitudes; one by one in history.csv),\n"
               "seconds since the start. What else is known of each pass and each load step: adapt.csv, history.csv, summary.json.\n"
               "A line \"warning: ...\" tells of something that a run can be right with but its user may not mean; summary.json lists them.\n"
               "\nOptions of PETSc work as everywhere: -snes_monitor, -ksp_monitor, -log_view, ...\n\nExit status:\n"));
  for (const ExitStatus *e = ExitStatuses; e->text; ++e) PetscCall(HelpText(PETSC_COMM_WORLD, "  %d  %s\n", e->status, e->text));
  PetscCheckInput(HelpShown(), "-help %.80s: no key or option has that in its name; -help alone tells all of them", word);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsHelp_Private(const char *word)
{
  return (PetscBool)(!strcmp(word, "-help") || !strcmp(word, "--help") || !strcmp(word, "-h"));
}

static PetscErrorCode Main_Private(int argc, char **argv, int *status)
{
  const PetscBool make = (PetscBool)(argc > 1 && !strcmp(argv[1], "new")), list = Asked_Private(argc, argv, "-list");
  PetscBool       help    = PETSC_FALSE;
  const PetscBool version = Asked_Private(argc, argv, "--version");

  PetscFunctionBegin;
  PetscCall(StageRegister());
  for (int i = 1; i < argc; ++i) help = (PetscBool)(help || IsHelp_Private(argv[i]));
  if (make || help || version || list) StopRelease();
  if (make)
    PetscCall(AppNew(PETSC_COMM_WORLD, argc - 2, argv + 2));
  else if (argc == 3 && !strcmp(argv[1], "-help") && !strcmp(argv[2], "json"))
    PetscCall(AppDescribe(PETSC_COMM_WORLD));
  else if (help)
    PetscCall(Help_Private(argc == 3 && IsHelp_Private(argv[1]) ? argv[2] : ""));
  else if (version)
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "mortise %s\n", MORTISE_VERSION));
  else if (list)
    PetscCall(ScenePrintList(PETSC_COMM_WORLD));
  else {
    PetscCall(Solve_Private(argc, argv, status));
    PetscCall(UnusedOptions_Private());
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One process ends without the words of MPI_Abort, and without those of libraries that would still close their files. */
static void End_Private(int status)
{
  PetscMPIInt size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  fflush(stdout);
  if (size == 1) _exit(status);
}

/* PETSc's own list of options that nothing used would repeat ours, or stand beside the sentence about wrong input: current releases print it unasked. */
static PetscErrorCode Finalize_Private(void)
{
  PetscBool asked;

  if (!PetscOptionsHasName(NULL, NULL, "-options_left", &asked) && !asked) (void)PetscOptionsSetValue(NULL, "-options_left", "0");
  return PetscFinalize();
}

/* Is what should be on the screen there? Who sends it to a file on a full disk has results, but no log of them. */
static void CheckScreen_Private(int *status)
{
  if (!fflush(stdout) && !ferror(stdout)) return;
  fputs("mortise: standard output could not be written to its end, as on a full disk\n", stderr);
  if (*status == 0) *status = 2;
}

static int Status_Private(PetscErrorCode ierr)
{
  return ErrorIsOption(ierr) ? 1 : 2;
}

int main(int argc, char **argv)
{
  int            status = 0;
  PetscErrorCode ierr;

  StopBegin();
  ierr = AppInitialize(argc, argv);
  if (ierr) return ierr == MORTISE_ERR_INPUT ? 1 : 2;
  (void)signal(SIGPIPE, SIG_DFL); /* output cut short by `head` is no error to report */
  (void)signal(SIGXFSZ, SIG_IGN); /* a file that may not grow is told of as a full disk is */
  ierr = ErrorHandlerPush();
  if (!ierr) ierr = Main_Private(argc, argv, &status);
  if (ierr) {
    OutputUnlock();
    /* An error other than wrong input leaves ranks anywhere: no orderly end. */
    status = Status_Private(ierr);
    if (ErrorIsPlain(ierr)) End_Private(status);
    if (ierr != MORTISE_ERR_INPUT) MPI_Abort(PETSC_COMM_WORLD, status);
    (void)PetscOptionsClear(NULL); /* -log_view of a run that was refused would still write its file */
    (void)Finalize_Private();
    (void)fflush(NULL);
    _exit(StopWasEarly() ? 3 : 1);
  }
  StopServed();
  CheckScreen_Private(&status);
  (void)fflush(NULL); /* now: mpiexec ends the other processes as soon as it sees one that has ended with a status */
  ierr = Finalize_Private();
  (void)fflush(NULL);
  _exit(ierr ? Status_Private(ierr)
             : status); /* OpenBLAS would wait for its threads, which have never begun where there is no room for their buffers (ulimit -v) */
}
