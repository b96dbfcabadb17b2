/* From an estimate to the level on a finer mesh: mark, adapt the forest, carry the states over or begin afresh. */
#include "appimpl.h"

/* The level on the adapted forest, its states at rest at time t. NULL where the mesh has inverted cells (sides that hang from coarser cells cut across curved
   ones), or a prescribed value is not finite at a new node: *refused says why, else NULL. */
static PetscErrorCode Create_Private(App *app, Forest forest, const int8_t old_order[], const ForestMap *map, PetscReal t, Level *next, const char **refused)
{
  int8_t   *orders;
  PetscReal X[3];
  PetscInt  order;

  PetscFunctionBegin;
  PetscCall(TransferOrders(map, old_order, &orders));
  PetscCall(LevelCreate(app->data, forest, orders, t, next));
  PetscCall(PetscFree(orders));
  PetscCall(ProblemFindInverted(next->problem, &order, X));
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
  if (*refused) PetscCall(LevelDestroy(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Both states carried over to the next level, each under the prescribed motion of its own time: new nodes near a support are interpolated from prescribed ones.
   Both take the history of the accepted one, made admissible there; of a step that went in pieces, too. */
static PetscErrorCode Carry_Private(const Level *old, const ForestMap *map, Level *next)
{
  PetscBool following;
  PetscReal length;

  PetscFunctionBegin;
  next->accepted.t = old->accepted.t;
  PetscCall(TransferState(old->problem, &old->state, next->problem, map, &next->state));
  PetscCall(PathPrescribe(old->problem, old->accepted.t));
  PetscCall(PathPrescribe(next->problem, next->accepted.t));
  PetscCall(TransferState(old->problem, &old->accepted, next->problem, map, &next->accepted));
  PetscCall(StateAdmit(next->problem, &next->accepted));
  PetscCall(PetscArraycpy(next->state.history, next->accepted.history, next->accepted.num_history));
  PetscCall(PathPrescribe(next->problem, next->state.t));
  PetscCall(ProblemIsFollowing(old->problem, &following));
  if (following) PetscCall(ProblemFollow(next->problem, next->accepted.x, next->state.x, &length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next level takes the place of the one at hand, which is the caller's then; refused: it stays. */
static PetscErrorCode MoveTo_Private(App *app, Forest forest, const int8_t old_order[], const ForestMap *map, PetscBool afresh, const char **refused)
{
  Level next;

  PetscFunctionBegin;
  PetscCall(Create_Private(app, forest, old_order, map, afresh ? 0 : app->level.state.t, &next, refused));
  if (*refused) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StageBegin(STAGE_TRANSFER));
  if (!afresh) PetscCall(Carry_Private(&app->level, map, &next));
  PetscCall(StageEnd(STAGE_TRANSFER));
  app->level = next;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppLayers(App *app, const Estimate *e, MarkList *layers)
{
  PetscInt  num;
  PetscBool room;

  PetscFunctionBegin;
  PetscCall(EstimateMarkLayers(e, app->data, app->level.forest, app->level.state.leaf_order, app->subdivided, layers, &num, &room));
  if (num > 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MarkListDestroy(layers));
  if (app->data->adapt.tolerance <= 0) app->adapt_stop = room ? FACES_FINE : "max_cells";
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppRefine(App *app, const Estimate *e, MarkList *layers, PetscBool afresh, PetscBool *adapted, PetscBool *refused)
{
  const ForestTables *t;
  MarkList            list   = *layers;
  PetscInt            marked = 1, num_pairs, (*pairs)[2];
  Forest              forest;
  ForestMap           map;
  int8_t             *order  = NULL;
  PetscReal          *weight = NULL;
  const char         *words  = NULL;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(app->level.forest, &t));
  if (app->data->adapt.strategy != ADAPT_H) PetscCall(PetscMalloc2(t->num_leaves, &order, t->num_leaves, &weight));
  if (!layers->split)
    PetscCall(EstimateMark(e, &app->data->adapt, app->level.forest, &list, order, &marked));
  else if (order)
    PetscCall(PetscArraycpy(order, app->level.state.leaf_order, t->num_leaves));
  for (PetscInt l = 0; order && l < t->num_leaves; ++l) weight[l] = PetscPowInt(order[l], t->dim);
  *adapted = (PetscBool)(marked > 0);
  if (!*adapted)
    app->adapt_stop = e->num_leaves >= app->data->adapt.max_cells / 2 ? "max_cells" : "nothing left to refine";
  else {
    PetscCall(AppContactPairs(app, &num_pairs, &pairs));
    PetscCall(StageBegin(STAGE_MESH));
    PetscCall(ForestAdapt(app->level.forest, &list, weight, num_pairs, (const PetscInt(*)[2])pairs, &forest, &map));
    PetscCall(StageEnd(STAGE_MESH));
    PetscCall(PetscFree(pairs));
    PetscCall(MoveTo_Private(app, forest, order ? order : app->level.state.leaf_order, &map, afresh, &words));
    if (words) app->adapt_stop = words;
    *adapted = (PetscBool)!words;
    PetscCall(ForestMapDestroy(&map));
  }
  *refused = (PetscBool)(words != NULL);
  PetscCall(MarkListDestroy(&list));
  PetscCall(PetscFree2(order, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}
