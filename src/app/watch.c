/* What is looked at after each accepted load step: states that the equations allow and their user may not mean. Told once. */
#include "appimpl.h"

#define ROUGH 0.5 /* estimate, of the norm of the largest solution, above which stresses say little */

static PetscErrorCode WatchPassage_Private(App *app)
{
  Passage p;
  char    contact[256];

  PetscFunctionBegin;
  if (app->passage_told || app->data->mechanics.kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PassageFind(app->level.problem, &app->level.accepted, -1, &p));
  if (!(p.depth > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  app->passage_told      = PETSC_TRUE;
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);
  if (p.pair < 0 || app->data->contacts[p.pair].law == CONTACT_TIED)
    PetscCall(PetscStrncpy(contact, "no contact is there to stop it", sizeof(contact)));
  else
    PetscCall(PetscSNPrintf(contact, sizeof(contact), "contact pair %s has one of the faces there and does not keep the other off: name both in one pair",
                            app->data->contacts[p.pair].name));
  PetscCall(WarningAdd(app->comm, "the surface of body %s passes through %s%s at t = %.6g, at (%.4g, %.4g, %.4g); %s", mesh->body_name[p.body[0]],
                       p.body[0] == p.body[1] ? "itself" : "body ", p.body[0] == p.body[1] ? "" : mesh->body_name[p.body[1]], (double)app->level.accepted.t,
                       (double)p.x[0], (double)p.x[1], (double)p.x[2], contact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies that no contact pair is between, in the mesh or at an accepted state. */
static PetscErrorCode WatchApart_Private(App *app, const char *where)
{
  Passage p;

  PetscFunctionBegin;
  if (app->apart_known) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PassageFindApart(app->level.problem, &app->level.accepted, &p));
  if (p.none) app->apart_known = PETSC_TRUE;
  if (!(p.depth > 0) && !p.whole) PetscFunctionReturn(PETSC_SUCCESS);
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);
  app->apart_known       = PETSC_TRUE;
  if (p.whole)
    PetscCall(WarningAdd(app->comm,
                         "body %s lies wholly inside body %s %s, at (%.4g, %.4g, %.4g), and no contact pair is between them: each is blind to the other",
                         mesh->body_name[p.body[0]], mesh->body_name[p.body[1]], where, (double)p.x[0], (double)p.x[1], (double)p.x[2]));
  else
    PetscCall(WarningAdd(app->comm, "bodies %s and %s overlap %s, at (%.4g, %.4g, %.4g), and no contact pair is between them: each passes through the other",
                         mesh->body_name[p.body[0]], mesh->body_name[p.body[1]], where, (double)p.x[0], (double)p.x[1], (double)p.x[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppTellOverlap(App *app)
{
  PetscFunctionBegin;
  if (!app->restart[0]) PetscCall(WatchApart_Private(app, "in the mesh"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest error of all steps, and the largest norm: a step with next to no load has an error that says little, be it as large as its solution. */
static void WatchEstimate_Private(App *app)
{
  const PetscReal error = app->last.estimate, whole = error / app->last.estimated_error;

  if (app->load_steps == 1) app->rough_error = app->rough_norm = 0; /* perhaps of a path before this one, on a coarser mesh */
  if (!(app->last.estimated_error > 0)) return;                     /* NaN: not estimated */
  app->rough_norm = PetscMax(app->rough_norm, whole);
  if (error > app->rough_error) app->rough_error = error, app->rough_t = app->level.accepted.t;
}

void AppForgetAdrift(App *app)
{
  for (PetscInt b = 0; b < app->data->mechanics.num_bodies; ++b) app->adrift[b] = (Adrift){.always = ~0};
}

/* Contact has let go of a body that nothing else holds: an equilibrium without load is anywhere, and is found. */
static PetscErrorCode WatchAdrift_Private(App *app)
{
  const PetscInt num = app->data->mechanics.num_bodies;
  PetscInt      *axes;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &axes));
  app->most_scale = PetscMax(app->most_scale, app->balance.status.scale);
  PetscCall(AdriftFind(app->level.problem, app->most_scale, axes));
  if (app->load_steps == 1) AppForgetAdrift(app); /* adapt.repeat: path begins anew */
  for (PetscInt b = 0; b < num; ++b) {
    Adrift *a = &app->adrift[b];
    if (!a->lost) a->lost = axes[b] & ~a->always, a->t = app->level.accepted.t;
    a->always &= axes[b];
  }
  PetscCall(PetscFree(axes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppRefuseInside(Problem problem, const PetscReal from[], const State *state, PetscReal scale, const char **reason)
{
  PetscInt pair, still;

  PetscFunctionBegin;
  PetscCall(InsideFind(problem, state, PETSC_FALSE, &pair, &still));
  *reason = pair < 0 ? NULL : "bodies of a contact pair lie inside each other, too deep for contact to be seen";
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppRefuseThrough(Problem problem, const PetscReal from[], const State *state, PetscReal scale, const char **reason)
{
  PetscInt pair;

  PetscFunctionBegin;
  PetscCall(ThroughFind(problem, from, state, &pair));
  *reason = pair < 0 ? NULL : "a body of a contact pair went right through the other one, without contact";
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppRefuseThrown(Problem problem, const PetscReal from[], const State *state, PetscReal scale, const char **reason)
{
  PetscInt body;

  PetscFunctionBegin;
  PetscCall(ThrownFind(problem, from, state, scale, &body));
  *reason = body < 0 ? NULL : "a body that nothing holds was thrown off";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step with most of them. */
static PetscErrorCode WatchFolded_Private(App *app)
{
  Folded folded;

  PetscFunctionBegin;
  if (app->load_steps == 1) app->folded.num = 0;
  if (app->data->mechanics.kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FoldedFind(app->level.problem, app->level.accepted.x, &folded, NULL));
  if (folded.num < PetscMax(1, app->folded.num)) PetscFunctionReturn(PETSC_SUCCESS);
  app->folded   = folded;
  app->folded_t = app->level.accepted.t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppWatch(App *app)
{
  char at[32];

  PetscFunctionBegin;
  WatchEstimate_Private(app);
  app->flowed = app->balance.plastic_strain > 0;
  PetscCall(WatchPassage_Private(app));
  PetscCall(PetscSNPrintf(at, sizeof(at), "at t = %.6g", (double)app->level.accepted.t));
  if (app->data->mechanics.kinematics == KINEMATICS_FINITE) PetscCall(WatchApart_Private(app, at));
  PetscCall(WatchAdrift_Private(app));
  PetscCall(WatchFolded_Private(app));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the estimate does not know of plastic flow: that of coarser cells, carried over; load steps too long for it, which leave more than was asked for, or
   than the mesh does. */
static PetscErrorCode WarnFlow_Private(App *app)
{
  const PetscReal norm = PetscSqrtReal(2 * app->path.energy), most = PetscMax(app->data->adapt.tolerance, app->last.estimated_error);

  PetscFunctionBegin;
  if (app->flowed_coarse)
    PetscCall(WarningAdd(app->comm,
                         "cells were refined after material had flowed: that is the flow of the coarser cells, and the error estimate does not know of "
                         "it; adapt.repeat: path begins again on the finer mesh"));
  if (norm > 0 && app->path.flow_error > most * norm)
    PetscCall(WarningAdd(app->comm,
                         "the load steps leave an error of about %.2g %% where material flows, in the energy norm: take shorter ones (load.step_max)",
                         100 * (double)(app->path.flow_error / norm)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WarnAdrift_Private(App *app)
{
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);

  PetscFunctionBegin;
  for (PetscInt b = 0; b < mesh->num_bodies; ++b) {
    const Adrift *a = &app->adrift[b];
    if (!a->lost) continue;
    PetscCall(WarningAdd(app->comm,
                         "at t = %.6g nothing holds body %s along %s any more, as contact did before: its displacement there means nothing from then on",
                         (double)a->t, mesh->body_name[b], AppAxesName(a->lost)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WarnFolded_Private(const App *app)
{
  const Folded *f = &app->folded;

  PetscFunctionBegin;
  if (!f->num) PetscFunctionReturn(PETSC_SUCCESS);
  const CoarseMesh *mesh = ForestGetCoarse(app->level.forest);
  PetscCall(WarningAdd(app->comm,
                       "%" PetscInt_FMT
                       " %s at t = %.6g, the worst at (%.4g, %.4g, %.4g) of body %s, det F = %.3g there: no body does that; take smaller cells "
                       "or round off what is sharp there, and doubt what depends on that place",
                       f->num, f->num == 1 ? "cell is turned inside out at a corner" : "cells are turned inside out at a corner", (double)app->folded_t,
                       (double)f->X[0], (double)f->X[1], (double)f->X[2], mesh->body_name[f->body], (double)f->det));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Contact at the end that cells are too coarse for. */
static PetscErrorCode WarnOverlap_Private(const App *app)
{
  const char *name = "";

  PetscFunctionBegin;
  if (!AppOverlaps(app)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < app->data->num_contacts; ++i)
    if (app->data->contacts[i].pair == app->estimate.overlap.pair) name = app->data->contacts[i].name;
  PetscCall(WarningAdd(app->comm,
                       "the sides of pair %s overlap by %.3g at the end, between nodes, and bear nothing: cells are too coarse there to see it; take smaller "
                       "ones, or let them be refined (adapt.tolerance)",
                       name, (double)app->estimate.overlap.depth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Overlap in the mesh that contact does not see, beyond the centre of a round side for instance, where its rays have crossed. */
static PetscErrorCode WarnInside_Private(App *app)
{
  PetscInt lost, still;

  PetscFunctionBegin;
  if (app->failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InsideFind(app->level.problem, &app->level.accepted, PETSC_TRUE, &lost, &still));
  if (still < 0) PetscFunctionReturn(PETSC_SUCCESS);
  app->touched[app->data->contacts[still].pair] = app->load_steps; /* they do */
  PetscCall(
      WarningAdd(app->comm,
                 "the bodies of pair %s lie inside each other at the end, as in the mesh, too deep for contact to be seen: nothing holds them apart; draw "
                 "them with less overlap, or with a flat side as the nonmortar one (roles: given)",
                 app->data->contacts[still].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppWarn(App *app)
{
  PetscFunctionBegin;
  PetscCall(WarnInside_Private(app));
  PetscCall(WarnOverlap_Private(app));
  PetscCall(WarnFolded_Private(app));
  PetscCall(WarnAdrift_Private(app));
  PetscCall(WarnFlow_Private(app));
  if (app->rough_error > ROUGH * app->rough_norm) {
    const PetscReal share = app->rough_error / app->rough_norm;
    PetscCall(WarningAdd(app->comm,
                         "the estimated error is up to %.3g %% of the largest solution, at t = %.6g: stresses of this run say little, and the %s may be off by "
                         "%.2g %%",
                         100 * (double)share, (double)app->rough_t, MechanicsIsPlastic(&app->data->mechanics) ? "elastic energy" : "energy, with it forces,",
                         100 * (double)PetscSqr(share)));
  }
  const PetscInt far = PathNumFar(&app->path);
  if (far > 0)
    PetscCall(WarningAdd(app->comm,
                         "%" PetscInt_FMT
                         " %s found by descent or viscous regularisation, the first at t = %.6g: Newton's method found none from the state before, "
                         "as where bodies snap, and there may be others nearer by",
                         far, far == 1 ? "equilibrium was" : "equilibria were", (double)app->path.far_t));
  if (app->path.unstable > 0)
    PetscCall(WarningAdd(app->comm, "%" PetscInt_FMT " %s unstable, the first at t = %.6g: the least disturbance would lead to another equilibrium",
                         app->path.unstable, app->path.unstable == 1 ? "solution is" : "solutions are", (double)app->unstable_t));
  PetscFunctionReturn(PETSC_SUCCESS);
}
