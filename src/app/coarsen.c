/* Back to a coarser mesh. On fine cells at a corner a load step may have no equilibrium near by, however short it is, where the coarser mesh it was adapted
   from has one; adaptation after the step then refines as far as that leads. */
#include "appimpl.h"

static PetscInt Splits_Private(const ForestTables *t, PetscInt leaf)
{
  return t->leaf_level[3 * leaf] + t->leaf_level[3 * leaf + 1] + t->leaf_level[3 * leaf + 2];
}

PetscErrorCode AppNoteFirstMesh(App *app, Forest forest)
{
  PetscFunctionBegin;
  if (!AppIsAdaptive(app) || app->data->adapt.repeat != REPEAT_STEP) PetscFunctionReturn(PETSC_SUCCESS);
  const CoarseMesh   *coarse = ForestGetCoarse(forest);
  const ForestTables *t      = ForestGetTables(forest);
  PetscCall(PetscMalloc1(coarse->num_cells, &app->first_level));
  for (PetscInt c = 0; c < coarse->num_cells; ++c) app->first_level[c] = INT8_MAX;
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    int8_t *least = &app->first_level[t->leaf_root[l]];
    *least        = (int8_t)PetscMin(*least, Splits_Private(t, l));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells that adaptation made of bodies that deform; the surface of rigid ones is geometry. */
static PetscBool MayMerge_Private(const App *app, const ForestTables *t, PetscInt leaf)
{
  const BodySpec *body = &app->data->mechanics.bodies[t->leaf_body[leaf]];

  return (PetscBool)(!body->material->law->rigid && Splits_Private(t, leaf) > app->first_level[t->leaf_root[leaf]]);
}

/* Merge one generation of cells; *merged false: there are none, or they must stay, and so does the level. Else that at hand before is the caller's. */
static PetscErrorCode Merge_Private(App *app, PetscBool *merged)
{
  const Level         before  = app->level;
  const ForestTables *t       = ForestGetTables(before.forest);
  const char         *refused = NULL;
  MarkList            list;
  PetscInt            num = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(t->num_leaves, &list.split, t->num_leaves, &list.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) num += list.coarsen[l] = (int8_t)MayMerge_Private(app, t, l);
  if (num) PetscCall(AppMoveTo(app, &list, &refused));
  PetscCall(PetscFree2(list.split, list.coarsen));
  const ForestTables *coarser = ForestGetTables(app->level.forest);
  *merged                     = (PetscBool)(coarser->num_leaves < t->num_leaves);
  if (*merged || app->level.forest == before.forest) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LevelDestroy(&app->level)); /* sides that would hang from cells twice as small had them split again */
  app->level = before;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Tell_Private(const App *app, Forest fine)
{
  const ForestTables *before = ForestGetTables(fine);
  const ForestTables *after  = ForestGetTables(app->level.forest);

  PetscFunctionBegin;
  PetscCall(PetscPrintf(
      app->comm, "note: no equilibrium was found from t = %g on the %" PetscInt_FMT " cells of the adapted mesh; on %" PetscInt_FMT " cells there is one\n",
      (double)app->level.accepted.t, before->num_leaves, after->num_leaves));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppCoarsen(App *app, PathLoop *loop, SolverReport *report)
{
  RecoveryCount     *row   = &app->path.recovery[PATH_COARSEN];
  const PetscReal    whole = app->arc_first > 0 ? app->arc_first : app->data->load.step;
  const SolverReport first = *report;
  Level              fine  = app->level;
  PetscBool          more  = (PetscBool)(app->first_level && row->mode != RECOVERY_OFF && !app->path.limit_point && !first.undefined);

  PetscFunctionBegin;
  while (more && !report->converged && !app->path.stopped) {
    Level before = app->level;
    PetscCall(Merge_Private(app, &more));
    if (!more) break;
    if (before.forest != fine.forest) PetscCall(LevelDestroy(&before));
    ++row->tried;
    *loop              = AppNextStep(app);
    loop->piece        = PetscMax(loop->piece, whole);
    app->path.failures = 0;
    PetscCall(PathFollow(&app->path, loop, report));
  }
  if (app->level.forest == fine.forest) PetscFunctionReturn(PETSC_SUCCESS);
  row->succeeded += report->converged;
  if (report->converged) {
    PetscCall(Tell_Private(app, fine.forest));
    PetscCall(LevelDestroy(&fine));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(LevelDestroy(&app->level));
  app->level = fine;
  *report    = first;
  PetscCall(PathPrescribe(fine.problem, fine.state.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
