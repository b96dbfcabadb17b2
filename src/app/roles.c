/* Roles of contact pairs by what presses. Which corners will meet a smooth face nobody knows at the start. Where a load step tells that the side with corners
   had better carry the multipliers of a pair, the run begins anew with its roles exchanged. Where nothing is found with the side that has corners, it begins
   once more with the softer one, and that stays. */
#include "appimpl.h"

#define MOST 52 /* pairs whose roles may change, as bits of a number in a checkpoint */

static const char *const Names[] = {"exchanged", "settled"};

PetscErrorCode AppReadRoles(App *app)
{
  uint64_t *const bits[] = {&app->exchanged, &app->settled};

  PetscFunctionBegin;
  if (app->restart[0]) PetscCall(CheckpointRead(app->comm, app->restart, &app->snapshot));
  for (int k = 0; k < 2 && app->restart[0]; ++k) {
    PetscReal value;
    PetscCall(CheckpointGetNumber(app->snapshot, Names[k], &value));
    PetscCheckInput(value >= 0 && value < (PetscReal)(UINT64_C(1) << MOST), "-restart: %s of the checkpoint is %g, which tells of no pairs", Names[k],
                    (double)value);
    *bits[k] = (uint64_t)value;
  }
  SceneExchange(app->scene, app->exchanged, app->num_corners, app->corner);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pair's facets at the corner are refined, in the run that begins anew. */
static PetscErrorCode Refine_Private(App *app, const InterfaceCorner *c)
{
  PetscInt room = app->num_corners;

  PetscFunctionBegin;
  if (c->splits == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayGrow(app->num_corners + 1, sizeof(RefineSpec), &room, &app->corner));
  app->corner[app->num_corners++] = (RefineSpec){.group = c->pair, .X = {c->X[0], c->X[1], c->X[2]}, .levels = c->splits};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where no solution was found trial states tell nothing: contact at the last one that was accepted. */
static PetscErrorCode GoBack_Private(App *app)
{
  const Level  *l = &app->level;
  ProblemStatus status;
  Vec           r;

  PetscFunctionBegin;
  PetscCall(PathPrescribe(l->problem, l->accepted.t));
  PetscCall(ProblemSetState(l->problem, &l->accepted));
  PetscCall(ProblemSearch(l->problem, l->accepted.x));
  PetscCall(VecDuplicate(l->accepted.x, &r));
  PetscCall(ProblemResidual(l->problem, l->accepted.x, l->accepted.pressure, r, &status));
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Exchange_Private(App *app, const ContactSpec *c, const char *why)
{
  PetscFunctionBegin;
  app->exchanged ^= UINT64_C(1) << c->pair;
  app->anew = PETSC_TRUE;
  PetscCall(
      PetscPrintf(app->comm, "note: contact.%s: at t = %.6g %s: the run begins anew with their roles exchanged\n", c->name, (double)app->level.state.t, why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pairs that have not borne before, and whose roles may change. */
static uint64_t Candidates_Private(const App *app)
{
  uint64_t pairs = 0;

  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const ContactSpec *c = &app->data->contacts[i];
    if (!c->given && c->pair < MOST && !app->touched[c->pair]) pairs |= UINT64_C(1) << c->pair;
  }
  return pairs & ~(app->exchanged | app->settled);
}

/* The pair's corners are no longer those of its nonmortar side. */
static void Forget_Private(App *app, PetscInt pair)
{
  PetscInt num = 0;

  for (PetscInt k = 0; k < app->num_corners; ++k)
    if (app->corner[k].group != pair) app->corner[num++] = app->corner[k];
  app->num_corners = num;
}

static PetscErrorCode Return_Private(App *app, const ContactSpec *c, const char *why)
{
  PetscFunctionBegin;
  app->settled |= UINT64_C(1) << c->pair;
  Forget_Private(app, c->pair);
  PetscCall(Exchange_Private(app, c, why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A side as good as rigid, in which nothing makes many constraints felt, was to carry the multipliers for a corner that pressed alone. */
static PetscErrorCode ReturnWide_Private(App *app)
{
  uint64_t pairs = 0, wide;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const ContactSpec *c = &app->data->contacts[i];
    if (c->cornered && c->stiff && c->pair < MOST) pairs |= UINT64_C(1) << c->pair;
  }
  pairs &= app->exchanged & ~app->settled;
  if (!pairs) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InterfaceFindSpread(ProblemInterface(app->level.problem), pairs, &wide));
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const ContactSpec *c = &app->data->contacts[i];
    if (c->part == 0 && c->pair < MOST && wide >> c->pair & 1) PetscCall(Return_Private(app, c, "the stiff side presses beside its corner"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppCheckRoles(App *app, PetscBool found)
{
  const uint64_t   candidates = Candidates_Private(app);
  PetscInt         num;
  InterfaceCorner *corners;

  PetscFunctionBegin;
  if (found) PetscCall(ReturnWide_Private(app));
  if (!candidates || app->anew) PetscFunctionReturn(PETSC_SUCCESS);
  if (!found) PetscCall(GoBack_Private(app));
  PetscCall(InterfaceFindCorners(ProblemInterface(app->level.problem), candidates, (PetscBool)!found, &num, &corners));
  for (PetscInt k = 0; k < num; ++k) {
    const PetscInt     pair = corners[k].pair;
    const ContactSpec *c    = app->data->contacts;
    while (c->pair != pair) ++c;
    PetscCall(Refine_Private(app, &corners[k]));
    if (!(app->exchanged >> pair & 1)) PetscCall(Exchange_Private(app, c, "a sharp corner of the mortar side presses within a facet of the nonmortar side"));
  }
  PetscCall(PetscFree(corners));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppReturnRoles(App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const ContactSpec *c = &app->data->contacts[i];
    if (c->part > 0 || !c->cornered || c->pair >= MOST || app->settled >> c->pair & 1) continue;
    PetscCall(Return_Private(app, c, "no equilibrium was found with the side that has corners as the nonmortar side"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
