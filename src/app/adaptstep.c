/* Adaptation at one time: estimate, mark, adapt the forest, transfer, find equilibrium again; until the tolerance or a limit is met. */
#include "appimpl.h"

#define NONE_FINER "no equilibrium found on a finer mesh"

#define STRESSED 10 /* nodal forces below this multiple of their round-off are nothing to estimate an error of: refining would chase noise */

#define MOST_PIECES 8 /* of the way from the accepted state, when equilibrium on a finer mesh is hard to find */

PetscErrorCode AppEstimate(App *app)
{
  PetscFunctionBegin;
  if (app->estimated) PetscCall(EstimateDestroy(&app->estimate));
  PetscCall(StageBegin(STAGE_ESTIMATE));
  PetscCall(EstimateCompute(app->level.problem, &app->level.state, &app->estimate));
  PetscCall(StageEnd(STAGE_ESTIMATE));
  app->estimated = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fields, tables and screen of the state just computed. */
static PetscErrorCode ReportPass_Private(App *app, PetscInt iterations, PetscBool accepted)
{
  Level         *l         = &app->level;
  Balance        before    = app->balance;
  PetscReal      change[3] = {0, 0, 0};
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCall(BalanceCompute(l->problem, &l->state, &app->balance));
  if (before.reaction && app->passes_in_step > 0) BalanceChange(&before, &app->balance, change);
  if (before.reaction) PetscCall(BalanceDestroy(&before));
  PetscCall(PetscMemzero(&app->last, sizeof(app->last)));
  PetscCall(ReportRowFill(l->problem, &l->state, app->estimated ? &app->estimate : NULL, &app->balance, &app->last));
  PetscCall(PetscTime(&now));
  app->last.step              = app->load_steps + 1;
  app->last.pass              = app->passes_in_step;
  app->last.newton_iterations = iterations;
  app->last.step_cuts         = app->cuts_in_step;
  app->last.set_cycles        = app->set_cycles - app->told_cycles;
  app->told_cycles            = app->set_cycles;
  app->last.seconds           = now - app->start;
  app->last.force_change      = change[0];
  app->last.work_change       = change[1];
  app->last.strain_change     = change[2];
  app->last.accepted          = accepted;
  app->last.dt                = l->state.t - l->accepted.t;
  PetscCall(HistoryPass(app->history, &app->last));
  PetscCall(MonitorRow(app->monitor, &app->last));
  if (!app->data->output.fields) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_OUTPUT));
  /* Passes at one load time follow each other a little apart: readers want times that grow. */
  const PetscReal apart = 1e-6 * app->data->load.end;
  const PetscReal time  = app->data->load.control == LOAD_TIME ? l->state.t : app->data->load.end * (app->load_steps + 1); /* on a path t may fall */
  PetscCall(OutputWriteState(app->writer, l->problem, &l->state, app->estimated ? &app->estimate : NULL, time + apart * app->passes_in_step,
                             app->load_steps + 1, app->passes_in_step));
  PetscCall(StageEnd(STAGE_OUTPUT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prescribed motion as it was at time t. */
static PetscErrorCode PrescribeAt_Private(Problem problem, PetscReal t)
{
  PetscFunctionBegin;
  PetscCall(ProblemSetTime(problem, t));
  PetscCall(ProblemJump(problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level on the adapted forest with both states carried over, each under the prescribed motion of its own time: new nodes near a support are
   interpolated from prescribed ones. Both take the history of the accepted one, made admissible there; of a step that went in pieces, too. Where the mesh has
   inverted cells (sides that hang from coarser cells cut across curved ones), or a prescribed value is not finite at a new node, the level stays: *refused says
   why, else NULL. */
static PetscErrorCode MoveTo_Private(App *app, Forest forest, const int8_t old_order[], const ForestMap *map, const char **refused)
{
  const Level *old = &app->level;
  Level        next;
  int8_t      *orders;
  PetscBool    following;
  PetscReal    length, X[3];
  PetscInt     order;

  PetscFunctionBegin;
  PetscCall(TransferOrders(map, old_order, &orders));
  PetscCall(LevelCreate(app->data, forest, orders, old->state.t, &next));
  PetscCall(PetscFree(orders));
  PetscCall(ProblemFindInverted(next.problem, &order, X));
  PetscCall(ExpressionTrouble(app->comm, refused));
  if (order > 0) *refused = "refinement inverts a curved cell";
  if (order > 0 && !app->inversion_told) {
    app->inversion_told = PETSC_TRUE;
    PetscCall(PetscPrintf(app->comm,
                          "note: refinement would invert a curved cell of order %" PetscInt_FMT
                          " at (%g, %g, %g): the coarser mesh stays; smaller cells there, "
                          "a higher order or mesh.order: 1 avoid it\n",
                          order, (double)X[0], (double)X[1], (double)X[2]));
  }
  if (*refused) {
    PetscCall(LevelDestroy(&next));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(StageBegin(STAGE_TRANSFER));
  next.accepted.t = old->accepted.t;
  PetscCall(TransferState(old->problem, &old->state, next.problem, map, &next.state));
  PetscCall(PrescribeAt_Private(old->problem, old->accepted.t));
  PetscCall(PrescribeAt_Private(next.problem, next.accepted.t));
  PetscCall(TransferState(old->problem, &old->accepted, next.problem, map, &next.accepted));
  PetscCall(StateAdmit(next.problem, &next.accepted));
  PetscCall(PetscArraycpy(next.state.history, next.accepted.history, next.accepted.num_history));
  PetscCall(PrescribeAt_Private(next.problem, next.state.t));
  PetscCall(ProblemIsFollowing(old->problem, &following));
  if (following) PetscCall(ProblemFollow(next.problem, next.accepted.x, next.state.x, &length));
  PetscCall(StageEnd(STAGE_TRANSFER));
  app->level = next;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* State between the last accepted one (share 0) and the transferred one (share 1), its prescribed motion likewise; the rest of the motion to time t is left to
   the solver. */
static PetscErrorCode StartBetween_Private(App *app, const State *transferred, PetscReal share)
{
  Level *l = &app->level;

  PetscFunctionBegin;
  PetscCall(StateBlend(&l->accepted, transferred, share, &l->state));
  PetscCall(PrescribeAt_Private(l->problem, l->accepted.t));
  PetscCall(ProblemSetTime(l->problem, transferred->t));
  PetscCall(ProblemApplyShare(l->problem, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equilibrium from the transferred state as its imbalance is taken away. */
static PetscErrorCode Settle_Private(App *app, const State *transferred, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(StateCopy(transferred, &app->level.state));
  PetscCall(PetscInfo(NULL, "the transferred state is to settle\n"));
  PetscCall(SolverSettle(app->level.solver, &app->level.state, report));
  AppCount(app, report);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equilibrium on the new mesh at the same load (along a path: on the same plane across it). Where the transferred state leads nowhere (a refined cell at a
   singular corner may start inverted), a state on the way to it does better; at last the way from the accepted state is gone again, in as many pieces as it
   takes. */
static PetscErrorCode Reequilibrate_Private(App *app, PetscInt *iterations, PetscBool *ok)
{
  static const PetscReal Shares[] = {1, 0.8, 0.5};
  Level                 *l        = &app->level;
  const PetscReal        t        = l->state.t;
  State                  transferred;
  PetscBool              following;

  PetscFunctionBegin;
  const PetscInt before = app->newton_iterations;
  PetscCall(StateCreate(l->problem, &transferred));
  PetscCall(StateCopy(&l->state, &transferred));
  *ok = PETSC_FALSE;
  for (size_t i = 0; i < sizeof(Shares) / sizeof(Shares[0]) && !*ok && !app->stopped; ++i) {
    SolverReport report;
    if (i > 0) PetscCall(StartBetween_Private(app, &transferred, Shares[i]));
    PetscCall(SolverSolve(l->solver, &l->state, &report));
    AppCount(app, &report);
    if (i == 0 && !report.converged && !app->stopped) PetscCall(Settle_Private(app, &transferred, &report));
    *ok = report.converged;
    if (!*ok) PetscCall(PetscInfo(NULL, "no equilibrium from %g of the transferred state: %s\n", (double)Shares[i], report.reason));
  }
  PetscCall(StateDestroy(&transferred));
  PetscCall(ProblemIsFollowing(l->problem, &following));
  l->state.t = t;
  if (following) PetscCall(ProblemGetTime(l->problem, l->state.x, &l->state.t));
  if (!*ok && !following && !app->stopped) {
    PetscCall(StateCopy(&l->accepted, &l->state));
    PetscCall(PrescribeAt_Private(l->problem, l->accepted.t));
    PetscCall(AppAdvance(app, t, (t - l->accepted.t) / MOST_PIECES, ok));
  }
  *iterations = app->newton_iterations - before;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adapt to the layers marked at contact faces, if any, else mark and adapt; *adapted false when nothing may or need be refined, and adaptation ends with that.
 */
static PetscErrorCode Refine_Private(App *app, MarkList *layers, PetscBool *adapted)
{
  const ForestTables *t;
  MarkList            list   = *layers;
  PetscInt            marked = 1, num_pairs, (*pairs)[2];
  Forest              forest;
  ForestMap           map;
  int8_t             *order  = NULL;
  PetscReal          *weight = NULL;
  const char         *refused;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(app->level.forest, &t));
  if (app->data->adapt.strategy != ADAPT_H) PetscCall(PetscMalloc2(t->num_leaves, &order, t->num_leaves, &weight));
  if (!layers->split)
    PetscCall(EstimateMark(&app->estimate, &app->data->adapt, app->level.forest, &list, order, &marked));
  else if (order)
    PetscCall(PetscArraycpy(order, app->level.state.leaf_order, t->num_leaves));
  for (PetscInt l = 0; order && l < t->num_leaves; ++l) weight[l] = PetscPowInt(order[l], t->dim);
  *adapted = (PetscBool)(marked > 0);
  if (!*adapted)
    app->adapt_stop = app->estimate.num_leaves >= app->data->adapt.max_cells / 2 ? "max_cells" : "nothing left to refine";
  else {
    PetscCall(AppContactPairs(app, &num_pairs, &pairs));
    PetscCall(StageBegin(STAGE_MESH));
    PetscCall(ForestAdapt(app->level.forest, &list, weight, num_pairs, (const PetscInt(*)[2])pairs, &forest, &map));
    PetscCall(StageEnd(STAGE_MESH));
    PetscCall(PetscFree(pairs));
    PetscCall(MoveTo_Private(app, forest, order ? order : app->level.state.leaf_order, &map, &refused));
    if (refused) app->adapt_stop = refused;
    *adapted = (PetscBool)!refused;
    PetscCall(ForestMapDestroy(&map));
  }
  PetscCall(MarkListDestroy(&list));
  PetscCall(PetscFree2(order, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refine and find equilibrium again. When there is none to be found on the finer mesh (material that collapses at a singular corner, say), the solution on
   the mesh at hand stands, and adaptation ends with that reason. *more: a finer mesh was reached. */
static PetscErrorCode Pass_Private(App *app, MarkList *layers, PetscInt *iterations, PetscBool *more)
{
  Level old = app->level;

  PetscFunctionBegin;
  PetscCall(Refine_Private(app, layers, more));
  if (!*more) {
    *iterations = 0;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Reequilibrate_Private(app, iterations, more));
  if (*more) {
    PetscCall(LevelDestroy(&old));
    ++app->passes_in_step;
    ++app->adapt_passes;
  } else {
    PetscCall(LevelDestroy(&app->level));
    app->level      = old;
    app->adapt_stop = NONE_FINER;
    PetscCall(PrescribeAt_Private(old.problem, old.state.t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why nothing more is to be done, "" when there may be. */
static const char *Stop_Private(const App *app)
{
  const AdaptSpec *spec = &app->data->adapt;

  if (spec->tolerance > 0 && app->estimate.relative <= spec->tolerance) return "tolerance";
  if (app->status.scale <= STRESSED * app->status.noise) return "free of stress";
  return app->passes_in_step >= spec->max_passes ? "max_passes" : "";
}

/* Layers at contact faces to be subdivided first (subdivide: auto); layers->split NULL: none. Where nothing else is to be adapted, adaptation ends with the
   last one. */
static PetscErrorCode Layers_Private(App *app, MarkList *layers)
{
  PetscInt  num;
  PetscBool room;

  PetscFunctionBegin;
  PetscCall(EstimateMarkLayers(&app->estimate, app->data, app->level.forest, app->level.state.leaf_order, app->subdivided, layers, &num, &room));
  if (num > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MarkListDestroy(layers));
  if (app->data->adapt.tolerance <= 0) app->adapt_stop = room ? "contact faces fine enough" : "max_cells";
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppAdapt(App *app)
{
  PetscInt  iterations = app->iterations_in_step;
  PetscBool adaptive = (PetscBool)(app->data->adapt.tolerance > 0), more = PETSC_TRUE;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) adaptive = (PetscBool)(adaptive || app->data->contacts[i].subdivide_auto);
  while (more) {
    MarkList layers = {0};
    PetscCall(AppEstimate(app));
    app->adapt_stop = adaptive ? Stop_Private(app) : "";
    if (adaptive && !app->adapt_stop[0]) PetscCall(Layers_Private(app, &layers));
    const PetscBool enough = (PetscBool)(!adaptive || app->adapt_stop[0]);
    PetscCall(ReportPass_Private(app, iterations, enough));
    if (enough) break;
    PetscCall(Pass_Private(app, &layers, &iterations, &more));
    if (more) continue;
    if (app->stopped) break;
    app->last.accepted          = PETSC_TRUE;
    app->last.newton_iterations = iterations;
    PetscCall(MonitorRow(app->monitor, &app->last));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where surfaces nearly fit, linear contact faces on a mesh that is curved miss each other by more than their clearance, and touch at corners. */
PetscErrorCode AppAdvise(const App *app)
{
  const CoarseMesh *mesh;

  PetscFunctionBegin;
  if (strcmp(app->adapt_stop, NONE_FINER)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForestGetCoarse(app->level.forest, &mesh));
  for (PetscInt i = 0; mesh->geometry_order > 1 && i < app->data->num_contacts; ++i) {
    const ContactSpec *pair = &app->data->contacts[i];
    if (!pair->full)
      PetscCall(PetscPrintf(app->comm, "note: the contact faces of pair %s are linear on a mesh that is curved; contact.%s.order: full follows it\n",
                            pair->name, pair->name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
