/* From an estimate to the level on a finer mesh: mark, adapt the forest, carry the states over or begin afresh. */
#include "appimpl.h"

/* Split an old leaf in all directions, if it was not to be and there is room for so many cells more. */
static void MarkWhole_Private(PetscInt dim, PetscInt old, MarkList *list, PetscInt *room, PetscBool *more)
{
  const PetscInt added = (1 << dim) - (1 << __builtin_popcount((unsigned)list->split[old]));

  if (added == 0 || added > *room || list->coarsen[old]) return;
  list->split[old] = (int8_t)((1 << dim) - 1);
  *room -= added;
  *more = PETSC_TRUE;
}

/* A leaf of a finer forest is inverted: it is too long for its curved side, or sides of it hang from coarser cells cut across curved ones. Those are to be
   split too; *more: there is one that was not. */
static void MarkInverted_Private(Forest finer, const ForestMap *map, PetscInt leaf, PetscInt max_cells, MarkList *list, PetscBool *more)
{
  const ForestTables *t;

  t                   = ForestGetTables(finer);
  const PetscInt size = t->dim == 2 ? 9 : 27, *first = &t->closure_offset[t->first[t->dim]], *own = &t->closure[first[leaf]];
  PetscInt       room = max_cells - t->num_leaves;
  MarkWhole_Private(t->dim, map->old_first[leaf], list, &room, more);
  for (PetscInt i = 0; i < size * t->num_leaves; ++i) {
    const PetscInt entity = t->closure[first[i / size] + i % size];
    for (PetscInt k = 0; k < size; ++k) {
      if (t->parent[own[k]] == entity) MarkWhole_Private(t->dim, map->old_first[i / size], list, &room, more);
    }
  }
}

static PetscErrorCode TellInverted_Private(App *app, PetscInt order, const PetscReal X[3])
{
  PetscFunctionBegin;
  if (app->inversion_told) PetscFunctionReturn(PETSC_SUCCESS);
  app->inversion_told = PETSC_TRUE;
  PetscCall(PetscPrintf(app->comm,
                        "note: refinement would invert a curved cell of order %" PetscInt_FMT " at (%g, %g, %g): the coarser mesh stays; smaller cells there, "
                        "a higher order or mesh.order: 1 avoid it\n",
                        order, (double)X[0], (double)X[1], (double)X[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The level on the adapted forest, its states at rest at time t. There is none where the mesh has inverted cells or a prescribed value is not finite at a new
   node: *refused says why, else NULL. *more: with the further cells that are marked then there may be. */
static PetscErrorCode Create_Private(App *app, Forest forest, const int8_t old_order[], const ForestMap *map, PetscReal t, MarkList *list, Level *next,
                                     const char **refused, PetscBool *more)
{
  const AdaptSpec *spec = &app->data->adapt;
  int8_t          *orders;
  PetscReal        X[3];
  PetscInt         order, leaf;

  PetscFunctionBegin;
  *more = PETSC_FALSE;
  PetscCall(TransferOrders(map, old_order, &orders));
  PetscCall(LevelCreate(app->data, forest, orders, t, next));
  PetscCall(PetscFree(orders));
  PetscCall(ProblemFindInverted(next->problem, &order, X, &leaf));
  PetscCall(ExpressionTrouble(app->comm, refused));
  if (order > 0) *refused = INVERTS;
  if (order > 0 && spec->strategy != ADAPT_P) MarkInverted_Private(forest, map, leaf, spec->max_cells, list, more);
  if (order > 0 && !*more) PetscCall(TellInverted_Private(app, order, X));
  if (*refused) PetscCall(LevelDestroy(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Both states carried over to the next level, each under the prescribed motion of its own time: new nodes near a support are interpolated from prescribed ones.
   Both take the history of the accepted one, made admissible there, and slip from it; of a step that went in pieces, too. */
static PetscErrorCode Carry_Private(const Level *old, const ForestMap *map, AdaptHistory kept, Level *next)
{
  PetscReal length;

  PetscFunctionBegin;
  next->accepted.t = old->accepted.t;
  PetscCall(TransferState(old->problem, &old->state, next->problem, map, &next->state));
  PetscCall(PathPrescribe(old->problem, old->accepted.t));
  PetscCall(PathPrescribe(next->problem, next->accepted.t));
  PetscCall(TransferState(old->problem, &old->accepted, next->problem, map, &next->accepted));
  PetscCall(StateAdmit(next->problem, &next->accepted));
  if (kept == HISTORY_NONE) { /* the naive way */
    PetscCall(PathPrescribe(next->problem, next->state.t));
    PetscCall(StateKeepOrigin(next->problem, &next->state));
    PetscCall(PetscArraycpy(next->accepted.before, next->state.before, next->accepted.num_before));
  }
  PetscCall(PetscArraycpy(next->state.history, next->accepted.history, next->accepted.num_history));
  PetscCall(PetscArraycpy(next->state.fine, next->accepted.fine, next->accepted.num_history));
  PetscCall(PetscArraycpy(next->state.from, next->accepted.from, next->accepted.num_from));
  PetscCall(PetscArraycpy(next->state.before, next->accepted.before, next->accepted.num_before));
  PetscCall(PathPrescribe(next->problem, next->state.t));
  const PetscBool following = ProblemIsFollowing(old->problem);
  if (following) PetscCall(ProblemFollow(next->problem, next->accepted.x, next->state.x, &length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Between its integration points a solution may be folded (at the end of a bonded edge, say): points of smaller cells see it, and there may be no equilibrium
   on them. The cells of the list where the state that was carried over is folded stay as they are; *more: there are some. */
static PetscErrorCode KeepFolded_Private(const Level *old, const ForestMap *map, const Level *next, MarkList *list, int8_t order[], PetscBool *more)
{
  int8_t *folded;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(map->num, &folded));
  PetscCall(ProblemFindFolded(next->problem, next->state.x, folded));
  for (PetscInt l = 0; l < map->num; ++l) {
    const PetscInt leaf = map->old_first[l];
    if (!folded[l] || (!list->split[leaf] && (!order || order[leaf] <= old->state.leaf_order[leaf]))) continue;
    list->split[leaf] = 0;
    if (order) order[leaf] = old->state.leaf_order[leaf];
    *more = PETSC_TRUE;
  }
  PetscCall(PetscFree(folded));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is anything left to refine? */
static PetscBool IsMarked_Private(const Level *l, PetscInt num_leaves, const MarkList *list, const int8_t order[])
{
  for (PetscInt leaf = 0; leaf < num_leaves; ++leaf)
    if (list->split[leaf] || (order && order[leaf] > l->state.leaf_order[leaf])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The level on the mesh that the list asks for takes the place of the one at hand, which is the caller's then; refused: it stays. *more: the list has changed.
 */
static PetscErrorCode MoveTo_Private(App *app, MarkList *list, int8_t order[], const PetscReal weight[], RefineMode mode, const char **refused, PetscBool *more)
{
  PetscInt  num_pairs, (*pairs)[2];
  Level     next;
  Forest    forest;
  ForestMap map;

  PetscFunctionBegin;
  PetscCall(AppContactPairs(app, &num_pairs, &pairs));
  PetscCall(StageBegin(STAGE_MESH));
  PetscCall(ForestAdapt(app->level.forest, list, weight, num_pairs, (const PetscInt(*)[2])pairs, &forest, &map));
  PetscCall(StageEnd(STAGE_MESH));
  PetscCall(PetscFree(pairs));
  PetscCall(Create_Private(app, forest, order ? order : app->level.state.leaf_order, &map, mode == REFINE_AFRESH ? 0 : app->level.state.t, list, &next, refused,
                           more));
  if (!*refused) {
    PetscCall(StageBegin(STAGE_TRANSFER));
    if (mode != REFINE_AFRESH) PetscCall(Carry_Private(&app->level, &map, app->data->adapt.history, &next));
    if (mode == REFINE_UNFOLDED) PetscCall(KeepFolded_Private(&app->level, &map, &next, list, order, more));
    PetscCall(StageEnd(STAGE_TRANSFER));
    if (*more)
      PetscCall(LevelDestroy(&next));
    else
      app->level = next;
  }
  PetscCall(ForestMapDestroy(&map));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppMoveTo(App *app, MarkList *list, const char **refused)
{
  PetscBool more;

  PetscFunctionBegin;
  *refused = NULL;
  PetscCall(MoveTo_Private(app, list, NULL, NULL, REFINE_ALL, refused, &more));
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

/* A cell that is turned inside out at a corner is at a place where strains grow without bound, as at the end of a bonded edge: smaller ones there are folded
   even more. It is not split while others are to be. */
static PetscErrorCode LeaveFolded_Private(App *app, PetscInt num_leaves, MarkList *list)
{
  PetscInt others = 0, left = 0;
  int8_t  *leaf;
  Folded   folded;

  PetscFunctionBegin;
  if (app->data->mechanics.kinematics == KINEMATICS_SMALL || app->path.recovery[PATH_UNFOLDED].mode == RECOVERY_OFF) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(num_leaves, &leaf));
  PetscCall(FoldedFind(app->level.problem, app->level.state.x, &folded, leaf));
  for (PetscInt l = 0; l < num_leaves; ++l) *(leaf[l] ? &left : &others) += list->split[l] != 0;
  for (PetscInt l = 0; l < num_leaves && others > 0; ++l)
    if (leaf[l]) list->split[l] = 0;
  if (others > 0) app->path.folded_left += left;
  PetscCall(PetscFree(leaf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppRefine(App *app, const Estimate *e, MarkList *layers, RefineMode mode, PetscBool *adapted, PetscBool *refused)
{
  const ForestTables *t      = ForestGetTables(app->level.forest);
  MarkList            list   = *layers;
  PetscInt            marked = 1;
  PetscBool           more   = PETSC_TRUE;
  int8_t             *order  = NULL;
  PetscReal          *weight = NULL;
  const char         *words  = NULL;

  PetscFunctionBegin;
  if (app->data->adapt.strategy != ADAPT_H) PetscCall(PetscMalloc2(t->num_leaves, &order, t->num_leaves, &weight));
  if (!layers->split)
    PetscCall(EstimateMark(e, &app->data->adapt, app->level.forest, &list, order, &marked));
  else if (order)
    PetscCall(PetscArraycpy(order, app->level.state.leaf_order, t->num_leaves));
  if (!layers->split && mode != REFINE_AFRESH) PetscCall(LeaveFolded_Private(app, t->num_leaves, &list));
  for (PetscInt l = 0; order && l < t->num_leaves; ++l) weight[l] = PetscPowInt(order[l], t->dim);
  if (marked == 0) app->adapt_stop = e->num_leaves >= app->data->adapt.max_cells / 2 ? "max_cells" : NOTHING_LEFT;
  while (marked > 0 && more) {
    PetscCall(MoveTo_Private(app, &list, order, weight, mode, &words, &more));
    if (!more || IsMarked_Private(&app->level, t->num_leaves, &list, order)) continue;
    words = NONE_FINER;
    more  = PETSC_FALSE;
  }
  if (words) app->adapt_stop = words;
  *adapted = (PetscBool)(marked > 0 && !words);
  *refused = (PetscBool)(words != NULL);
  PetscCall(MarkListDestroy(&list));
  PetscCall(PetscFree2(order, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}
