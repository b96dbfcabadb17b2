/* Back to a coarser mesh. On fine cells at a corner a load step may have no equilibrium near by, however short it is, where the coarser mesh it was adapted
   from has one; adaptation after the step then refines as far as that leads. */
#include "appimpl.h"

static PetscInt Splits_Private(const ForestTables *t, PetscInt leaf)
{
  return t->leaf_level[3 * leaf] + t->leaf_level[3 * leaf + 1] + t->leaf_level[3 * leaf + 2];
}

PetscErrorCode AppNoteFirstMesh(App *app, Forest forest)
{
  const CoarseMesh   *coarse;
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(ForestGetCoarse(forest, &coarse));
  PetscCall(ForestGetTables(forest, &t));
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

PetscErrorCode AppCoarsen(App *app, PetscBool *merged)
{
  const Level         old = app->level;
  const ForestTables *t, *coarser;
  const char         *refused;
  MarkList            list;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(old.forest, &t));
  PetscCall(PetscCalloc2(t->num_leaves, &list.split, t->num_leaves, &list.coarsen));
  *merged = PETSC_FALSE;
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    list.coarsen[l] = (int8_t)MayMerge_Private(app, t, l);
    *merged         = (PetscBool)(*merged || list.coarsen[l]);
  }
  if (*merged) PetscCall(AppMoveTo(app, &list, &refused));
  PetscCall(PetscFree2(list.split, list.coarsen));
  if (!*merged) PetscFunctionReturn(PETSC_SUCCESS);
  if (refused) {
    *merged = PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ForestGetTables(app->level.forest, &coarser));
  *merged = (PetscBool)(coarser->num_leaves < t->num_leaves);
  if (*merged) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LevelDestroy(&app->level));
  app->level = old;
  PetscFunctionReturn(PETSC_SUCCESS);
}
