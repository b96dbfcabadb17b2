/* Words before and after a run: what looks wrong, what there is besides, and what may help. */
#include "appimpl.h"
#include <cjson/cJSON.h>

/* Largest first. */
static int Larger_Private(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;
  return (x < y) - (x > y);
}

/* The fewest cells that hold half of the squared estimate. */
static PetscErrorCode Half_Private(const Estimate *e, PetscInt *num)
{
  PetscReal *eta2, half = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(e->num_leaves, &eta2));
  PetscCall(PetscArraycpy(eta2, e->eta2, e->num_leaves));
  qsort(eta2, (size_t)e->num_leaves, sizeof(*eta2), Larger_Private);
  for (PetscInt l = 0; l < e->num_leaves; ++l) half += 0.5 * eta2[l];
  for (*num = 0; *num < e->num_leaves && half > 0;) half -= eta2[(*num)++];
  PetscCall(PetscFree(eta2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where half of the error is, when it is in few cells: round a few singular points, say; of what is spread over a surface or a body it is a share of all
   cells. */
static PetscErrorCode Worst_Private(const App *app)
{
  const Estimate     *e     = &app->estimate;
  const PetscReal     mid[] = {0.5, 0.5, 0.5};
  const ForestTables *t     = ForestGetTables(app->level.forest);
  PetscInt            worst = 0, half;
  PetscReal           X[3];

  PetscFunctionBegin;
  if (!app->estimated || e->num_leaves != t->num_leaves || !(e->total > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt l = 1; l < e->num_leaves; ++l)
    if (e->eta2[l] > e->eta2[worst]) worst = l;
  PetscCall(Half_Private(e, &half));
  if (half * half > e->num_leaves) PetscFunctionReturn(PETSC_SUCCESS);
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);
  PetscCall(ForestMapPoint(app->level.forest, worst, mid, X));
  PetscCall(PetscPrintf(app->comm,
                        "note: half of the squared error estimate is in %" PetscInt_FMT " of %" PetscInt_FMT
                        " cells, the worst at (%.4g, %.4g, %.4g) of body %s: a sharp "
                        "corner or the end of a support there may be in the way; rounded off it would not be\n",
                        half, e->num_leaves, (double)X[0], (double)X[1], (double)X[2], mesh->body_name[t->leaf_body[worst]]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where friction holds no more. */
static PetscErrorCode Slips_Private(const App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const ContactSpec     *c = &app->data->contacts[i];
    const FrictionFigures *f = &app->friction[c->pair];
    if (c->part || f->slipping <= f->sticking) continue;
    PetscCall(PetscPrintf(app->comm,
                          "note: %" PetscInt_FMT " of %" PetscInt_FMT " touching nodes of pair %s slipped in the last step: if friction there is all that "
                          "holds a body, it slides away where that holds no more, and there is no equilibrium then\n",
                          f->slipping, f->slipping + f->sticking, c->name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rigid bodies that nothing held when the run gave up: contact alone bears their loads. */
static PetscErrorCode Loose_Private(const App *app)
{
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);
  PetscInt         *axes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mesh->num_bodies, &axes));
  PetscCall(AdriftFind(app->level.problem, app->most_scale, axes));
  for (PetscInt b = 0; b < mesh->num_bodies; ++b)
    if (axes[b] && BodyIsLoaded(&app->data->mechanics.bodies[b]))
      PetscCall(PetscPrintf(app->comm,
                            "note: nothing held rigid body %s along %s when the run gave up: no contact bears on it there, and its load (body.%s.load) has "
                            "nothing to balance it\n",
                            mesh->body_name[b], AppAxesName(axes[b]), mesh->body_name[b]));
  PetscCall(PetscFree(axes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Overlaps that the search cannot tell from the far sides of bodies behind. */
static PetscErrorCode TellOverlap_Private(const App *app, PetscInt pair, PetscBool reference)
{
  const ContactSpec *c     = &app->data->contacts[pair];
  PetscReal          depth = 0, part;

  PetscFunctionBegin;
  if (c->part) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = pair; i == pair || (i < app->data->num_contacts && app->data->contacts[i].part); ++i) {
    PetscCall(InterfaceUntoldOverlap(ProblemInterface(app->level.problem), i, reference, &part));
    depth = PetscMax(depth, part);
  }
  if (depth > 0)
    PetscCall(PetscPrintf(app->comm,
                          "note: the sides of pair %s overlap by %.4g%s, more than half of what both bodies measure there: that is taken for the far side of a "
                          "body behind, and does not count\n",
                          c->name, (double)depth, reference ? " at the start" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A pair whose nodes bore on the way to a state, and in no state that was found. */
static PetscErrorCode CameApart_Private(const App *app, const char *pair, const PairFigures *f)
{
  char apart[64] = "";

  PetscFunctionBegin;
  if (f->covered_nodes) PetscCall(PetscSNPrintf(apart, sizeof(apart), " (at the end they are %.3g apart)", (double)f->min_gap));
  PetscCall(PetscPrintf(app->comm,
                        "note: the sides of pair %s were in contact on the way to a state found, but are in none of these%s: they came apart; "
                        "where they are meant to press on each other, support the bodies so that they cannot leave\n",
                        pair, apart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Pairs that were in vain; most likely a group is of other facets than was meant. Of a run that goes on from another one nobody knows. */
static PetscErrorCode Untouched_Private(const App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) {
    const PetscInt     pair = app->data->contacts[i].pair;
    const PairFigures *f    = &app->balance.pair[pair];
    if (app->data->contacts[i].part || app->touched[pair] || f->tied) continue;
    PetscCall(TellOverlap_Private(app, i, PETSC_FALSE));
    if (PathPressed(&app->path, pair))
      PetscCall(CameApart_Private(app, app->data->contacts[i].name, f));
    else if (f->covered_nodes)
      PetscCall(PetscPrintf(app->comm, "note: the sides of pair %s have not touched; at the end they are %.3g apart\n", app->data->contacts[i].name,
                            (double)f->min_gap));
    else
      PetscCall(PetscPrintf(app->comm, "note: the sides of pair %s have not touched; at the end they do not face each other\n", app->data->contacts[i].name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What could have been left out within the tolerance. Keys of its own lines would be long: they are in summary.json. */
static PetscErrorCode Needless_Private(const App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->needs.num; ++i) {
    const Need *n    = &app->needs.rows[i];
    char       *keys = cJSON_PrintUnformatted(n->set);
    if (n->keeps)
      PetscCall(PetscPrintf(app->comm, "note: not needed: %s of %s (%s); changes %.2g, saves about %.0f %% of the time: %s\n", n->part, n->name, n->why,
                            (double)n->change, 100 * (double)n->saves, keys));
    cJSON_free(keys);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppTellMirrors(const App *app)
{
  PetscFunctionBegin;
  for (PetscInt a = 0; a < 3; ++a)
    if (app->mirror[a])
      PetscCall(PetscPrintf(app->comm, "note: mesh, supports and loads are symmetric about %c = %.6g: half is enough (scripts/simplify cuts it)\n",
                            'x' + (int)a, (double)app->mirror_at[a]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *AppAxesName(PetscInt axes)
{
  static const char *const name[] = {"", "x", "y", "x and y", "z", "x and z", "y and z", "x, y and z"};

  return name[axes];
}

PetscErrorCode AppTellFree(const App *app)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < app->data->num_contacts; ++i) PetscCall(TellOverlap_Private(app, i, PETSC_TRUE));
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);
  for (PetscInt b = 0; b < mesh->num_bodies; ++b) {
    PetscInt  axes;
    PetscBool turns;

    if (app->data->mechanics.bodies[b].material->law->rigid) continue; /* its load says that it is free */
    PetscCall(ProblemFreeAxes(app->level.problem, b, &axes, &turns));
    if (axes)
      PetscCall(PetscPrintf(app->comm,
                            "note: no support holds body %s along %s: it takes contact for an equilibrium; where contact does not hold it either, as along a "
                            "flat face, its displacement along %s means nothing\n",
                            mesh->body_name[b], AppAxesName(axes), AppAxesName(axes)));
    if (turns) PetscCall(PetscPrintf(app->comm, "note: the supports of body %s let it turn: it takes contact for an equilibrium\n", mesh->body_name[b]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppAdvise(const App *app)
{
  const PetscBool stuck = (PetscBool)!strcmp(app->adapt_stop, NONE_FINER);
  PetscBool       whole;

  PetscFunctionBegin;
  PetscCall(OutputHasAside(app->comm, app->data->output.directory, &whole));
  if (whole)
    PetscCall(
        PetscPrintf(app->comm, "note: the path on the mesh before came to its end; its results are in %s/" OUTPUT_ASIDE "\n", app->data->output.directory));
  if (!app->failure && !app->path.stopped && !app->restart[0]) {
    PetscCall(Untouched_Private(app));
    PetscCall(Needless_Private(app));
  }
  if (app->failure) PetscCall(Loose_Private(app));
  if (app->failure && app->path.cuts_in_step > 0) PetscCall(Slips_Private(app));
  if (stuck || (app->failure && app->path.cuts_in_step > 0)) PetscCall(Worst_Private(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}
