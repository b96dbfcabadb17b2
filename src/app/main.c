/* mortise: finite-deformation contact with error control. The story goes on in loadstep.c and adaptstep.c. */
#include "appimpl.h"
#include <signal.h>

static PetscErrorCode Open_Private(App *app, Forest forest)
{
  int8_t *orders;

  PetscFunctionBegin;
  PetscCall(ProblemInitialOrders(app->data, forest, &orders));
  PetscCall(ProbesCreate(app->data, forest, &app->probes));
  PetscCall(LevelCreate(app->data, forest, orders, 0, &app->level));
  PetscCall(PetscFree(orders));
  PetscCall(OutputDirectoryCreate(app->comm, app->data->output.directory));
  if (app->data->output.fields) PetscCall(WriterCreate(app->comm, app->data->output.directory, &app->writer));
  PetscCall(HistoryCreate(app->comm, app->data, app->probes, &app->history));
  PetscCall(MonitorCreate(app->comm, app->data, &app->monitor));
  PetscCall(MonitorHeader(app->monitor, app->level.problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The last accepted state is what a failed run leaves behind. */
static PetscErrorCode Summarise_Private(App *app)
{
  const char    *status = app->failure ? "failed" : "converged";
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCall(PetscTime(&now));
  if (app->failure) {
    PetscCall(ProblemSetTime(app->level.problem, app->level.accepted.t));
    PetscCall(ProblemJump(app->level.problem));
    if (app->balance.reaction) PetscCall(BalanceDestroy(&app->balance));
    PetscCall(BalanceCompute(app->level.problem, &app->level.accepted, &app->balance));
  }
  RunSummary summary = {
      .status = status, .reason = app->failure ? app->failure : "", .t = app->level.accepted.t, .seconds = now - app->start, .load_steps = app->load_steps};
  summary.step_cuts          = app->step_cuts;
  summary.adapt_passes       = app->adapt_passes;
  summary.newton_iterations  = app->newton_iterations;
  summary.active_set_changes = app->set_changes;
  summary.active_set_cycles  = app->set_cycles;
  summary.factorisations     = app->factorisations;
  summary.single_failures    = app->single_failures;
  summary.unstable           = app->judged ? (PetscReal)app->unstable : (PetscReal)NAN;
  summary.adapt_stop         = app->adapt_stop;
  summary.problem            = app->level.problem;
  summary.state              = &app->level.accepted;
  summary.balance            = &app->balance;
  summary.estimate           = app->estimated && !app->failure ? &app->estimate : NULL;
  summary.probes             = app->probes;
  PetscCall(OutputSummary(app->comm, app->data, &summary));
  PetscCall(MonitorFooter(app->monitor, status, summary.reason, app->adapt_stop, app->load_steps ? &app->last : NULL));
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
  if (app->balance.reaction) PetscCall(BalanceDestroy(&app->balance));
  PetscCall(LevelDestroy(&app->level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve_Private(int argc, char **argv, PetscBool *gave_up)
{
  App    app = {.comm = PETSC_COMM_WORLD};
  Forest forest;

  PetscFunctionBegin;
  PetscCall(PetscTime(&app.start));
  PetscCheckInput(argc > 1, "no scene was named; say mortise SCENE.yml, or mortise -help");
  PetscCall(SceneCreate(app.comm, argc, argv, &app.scene));
  PetscCall(SolverCheckOptions());
  PetscCall(StageBegin(STAGE_MESH));
  PetscCall(SceneSetUp(app.scene, &forest));
  PetscCall(StageEnd(STAGE_MESH));
  PetscCall(SceneGetData(app.scene, &app.data));
  if (SceneCheckOnly(app.scene)) {
    PetscCall(SceneView(app.scene, PETSC_VIEWER_STDOUT_WORLD));
    PetscCall(ForestDestroy(&forest));
  } else {
    PetscCall(Open_Private(&app, forest));
    PetscCall(AppRun(&app));
    PetscCall(Summarise_Private(&app));
    PetscCall(Close_Private(&app));
  }
  PetscCall(SceneDestroy(&app.scene));
  *gave_up = (PetscBool)(app.failure != NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Asked_Private(int argc, char **argv, const char *option)
{
  for (int i = 1; i < argc; ++i) {
    if (!strcmp(argv[i], option)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Options of PETSc that nothing asked for are most likely mistyped: say so. */
static PetscErrorCode UnusedOptions_Private(void)
{
  PetscMPIInt rank;
  PetscInt    num;
  char      **names, **values;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCall(PetscOptionsLeftGet(NULL, &num, &names, &values));
  for (PetscInt i = 0; i < num && rank == 0; ++i) fprintf(stderr, "mortise: nothing used the option -%s; is it spelt right?\n", names[i]);
  PetscCall(PetscOptionsLeftRestore(NULL, &num, &names, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Help_Private(void)
{
  PetscFunctionBegin;
  PetscCall(ScenePrintHelp(PETSC_COMM_WORLD));
  PetscCall(SolverPrintHelp(PETSC_COMM_WORLD));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "\nOptions of PETSc work as everywhere: -snes_monitor, -ksp_monitor, -log_view, ...\n"
                                          "Exit status: 0 converged to the end; 1 bad input, nothing was solved; 2 the solver gave up.\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Main_Private(int argc, char **argv, PetscBool *gave_up)
{
  PetscFunctionBegin;
  PetscCall(StageRegister());
  if (Asked_Private(argc, argv, "-help") || Asked_Private(argc, argv, "--help") || Asked_Private(argc, argv, "-h"))
    PetscCall(Help_Private());
  else if (Asked_Private(argc, argv, "-list"))
    PetscCall(ScenePrintList(PETSC_COMM_WORLD));
  else {
    PetscCall(Solve_Private(argc, argv, gave_up));
    PetscCall(UnusedOptions_Private());
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  PetscBool      gave_up = PETSC_FALSE;
  PetscErrorCode ierr;

  ierr = AppInitialize(argc, argv);
  if (ierr) return 2;
  (void)signal(SIGPIPE, SIG_DFL); /* output cut short by `head` is no error to report */
  ierr = ErrorHandlerPush();
  if (!ierr) ierr = Main_Private(argc, argv, &gave_up);
  if (ierr) {
    /* An error other than wrong input leaves ranks anywhere: no orderly end. */
    if (ierr != MORTISE_ERR_INPUT) MPI_Abort(PETSC_COMM_WORLD, 2);
    (void)PetscFinalize();
    return 1;
  }
  ierr = PetscFinalize();
  return ierr ? 2 : gave_up ? 2 : 0;
}
