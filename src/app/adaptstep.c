/* Adaptation at one time: estimate, mark, adapt the forest, transfer, find equilibrium again; until the tolerance or a limit is met. */
#include "appimpl.h"

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

PetscErrorCode AppReportPass(App *app, PetscInt iterations, PetscBool accepted)
{
  Level         *l = &app->level;
  PetscLogDouble now;

  PetscFunctionBegin;
  if (app->balance.reaction) PetscCall(BalanceDestroy(&app->balance));
  PetscCall(BalanceCompute(l->problem, &l->state, &app->balance));
  PetscCall(PetscMemzero(&app->last, sizeof(app->last)));
  PetscCall(ReportRowFill(l->problem, &l->state, app->estimated ? &app->estimate : NULL, &app->balance, &app->last));
  PetscCall(PetscTime(&now));
  app->last.step              = app->load_steps + 1;
  app->last.pass              = app->passes_in_step;
  app->last.newton_iterations = iterations;
  app->last.step_cuts         = app->cuts_in_step;
  app->last.seconds           = now - app->start;
  app->last.accepted          = accepted;
  app->last.dt                = l->state.t - l->accepted.t;
  PetscCall(HistoryPass(app->history, &app->last));
  PetscCall(MonitorRow(app->monitor, &app->last));
  if (!app->data->output.fields) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_OUTPUT));
  /* Passes at one load time follow each other a little apart: readers want times that grow. */
  const PetscReal apart = 1e-6 * app->data->load.end;
  PetscCall(OutputWriteState(app->writer, l->problem, &l->state, app->estimated ? &app->estimate : NULL, l->state.t + apart * app->passes_in_step,
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
   interpolated from prescribed ones. */
static PetscErrorCode MoveTo_Private(App *app, Forest forest, const ForestMap *map)
{
  Level  *old = &app->level, next;
  int8_t *orders;

  PetscFunctionBegin;
  PetscCall(TransferOrders(map, old->state.leaf_order, &orders));
  PetscCall(LevelCreate(app->data, forest, orders, old->state.t, &next));
  PetscCall(StageBegin(STAGE_TRANSFER));
  next.accepted.t = old->accepted.t;
  PetscCall(TransferState(old->problem, &old->state, next.problem, map, &next.state));
  PetscCall(PrescribeAt_Private(old->problem, old->accepted.t));
  PetscCall(PrescribeAt_Private(next.problem, next.accepted.t));
  PetscCall(TransferState(old->problem, &old->accepted, next.problem, map, &next.accepted));
  PetscCall(PrescribeAt_Private(next.problem, next.state.t));
  PetscCall(StageEnd(STAGE_TRANSFER));
  PetscCall(PetscFree(orders));
  PetscCall(LevelDestroy(old));
  app->level = next;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equilibrium on the new mesh at the same load; from the last accepted state, in smaller pieces, when that fails. */
static PetscErrorCode Reequilibrate_Private(App *app, PetscInt *iterations, PetscBool *ok)
{
  Level          *l = &app->level;
  const PetscReal t = l->state.t;
  SolverReport    report;

  PetscFunctionBegin;
  const PetscInt before = app->newton_iterations;
  PetscCall(SolverSolve(l->solver, &l->state, &report));
  app->newton_iterations += report.iterations;
  app->iterations_in_step += report.iterations;
  *ok = report.converged;
  if (!*ok) {
    PetscCall(StateCopy(&l->accepted, &l->state));
    PetscCall(PrescribeAt_Private(l->problem, l->accepted.t));
    PetscCall(AppAdvance(app, t, ok));
  }
  *iterations = app->newton_iterations - before;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaf pairs that face each other in contact: the partition keeps them together where it can. */
static PetscErrorCode ContactPairs_Private(App *app, PetscInt *num, PetscInt (**pairs)[2])
{
  PetscMPIInt size;
  PetscInt    count = 0;

  PetscFunctionBegin;
  *num   = 0;
  *pairs = NULL;
  PetscCallMPI(MPI_Comm_size(app->comm, &size));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt pass = 0; pass < 2; ++pass) {
    count = 0;
    for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
      const ContactView    *v;
      const ContactSegment *segments;
      PetscInt              n;
      PetscCall(ProblemGetContact(app->level.problem, i, &v));
      PetscCall(ContactPairGetSegments(v->pair, &n, &segments));
      for (PetscInt s = 0; s < n; ++s, ++count) {
        if (!pass) continue;
        (*pairs)[count][0] = v->nonmortar.edge_leaf[segments[s].edge];
        (*pairs)[count][1] = v->mortar.edge_leaf[segments[s].mortar_edge];
      }
    }
    if (!pass) PetscCall(PetscMalloc1(count, pairs));
  }
  *num = count;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mark and adapt; *adapted false when nothing may or need be refined. */
static PetscErrorCode Refine_Private(App *app, PetscBool *adapted)
{
  MarkList  list;
  PetscInt  marked, num_pairs, (*pairs)[2];
  Forest    forest;
  ForestMap map;

  PetscFunctionBegin;
  PetscCall(EstimateMark(&app->estimate, &app->data->adapt, app->level.forest, &list, &marked));
  *adapted = (PetscBool)(marked > 0);
  if (*adapted) {
    PetscCall(ContactPairs_Private(app, &num_pairs, &pairs));
    PetscCall(StageBegin(STAGE_MESH));
    PetscCall(ForestAdapt(app->level.forest, &list, NULL, num_pairs, (const PetscInt(*)[2])pairs, &forest, &map));
    PetscCall(StageEnd(STAGE_MESH));
    PetscCall(PetscFree(pairs));
    PetscCall(MoveTo_Private(app, forest, &map));
    PetscCall(ForestMapDestroy(&map));
  }
  PetscCall(MarkListDestroy(&list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppAdapt(App *app, PetscBool *ok)
{
  const AdaptSpec *spec       = &app->data->adapt;
  PetscInt         iterations = app->iterations_in_step;
  PetscBool        more       = PETSC_TRUE;

  PetscFunctionBegin;
  *ok = PETSC_TRUE;
  while (more) {
    PetscCall(AppEstimate(app));
    const PetscBool enough = (PetscBool)(spec->tolerance <= 0 || app->estimate.relative <= spec->tolerance || app->passes_in_step >= spec->max_passes);
    PetscCall(AppReportPass(app, iterations, enough));
    more = PETSC_FALSE;
    if (enough) break;
    PetscCall(Refine_Private(app, &more));
    if (!more) break;
    ++app->passes_in_step;
    ++app->adapt_passes;
    PetscCall(Reequilibrate_Private(app, &iterations, ok));
    if (!*ok) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
