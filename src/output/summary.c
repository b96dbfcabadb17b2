/* summary.json: the figures of a run, also of one that failed. Keys are the contract with users; a figure that is not known is null. */
#include "output.h"
#include <cjson/cJSON.h>
#include <errno.h>
#include <sys/resource.h>
#include <sys/stat.h>

/* Everything that needs all ranks, gathered before rank 0 writes. */
typedef struct {
  PetscReal   seconds[NUM_STAGES];
  PetscReal   memory[2]; /* MB: sum over ranks, largest of one */
  PetscInt    cells, dofs, order_min, order_max;
  PetscMPIInt ranks;
  PetscInt    num_probes;
  ProbeValue *probe; /* owned [num_probes] */
} Gathered;

static PetscInt Dim_Private(const SceneData *scene)
{
  return scene->mechanics.model == MODEL_3D ? 3 : 2;
}

/* ---- pieces of JSON --------------------------------------------------------------------------------------------------------- */

/* NaN and infinity have no number in JSON. */
static cJSON *Number_Private(PetscReal value)
{
  return PetscIsInfOrNanReal(value) ? cJSON_CreateNull() : cJSON_CreateNumber((double)value);
}

static void AddNumber_Private(cJSON *object, const char *key, PetscReal value)
{
  cJSON_AddItemToObject(object, key, Number_Private(value));
}

static void AddArray_Private(cJSON *object, const char *key, PetscInt num, const PetscReal values[])
{
  cJSON *array = cJSON_AddArrayToObject(object, key);
  for (PetscInt i = 0; i < num; ++i) cJSON_AddItemToArray(array, Number_Private(values[i]));
}

/* One number (about z) in two dimensions, three in space. */
static void AddMoment_Private(cJSON *object, const char *key, PetscInt dim, const PetscReal moment[3])
{
  AddArray_Private(object, key, dim == 2 ? 1 : 3, dim == 2 ? moment + 2 : moment);
}

static void AddWarnings_Private(cJSON *object)
{
  cJSON      *array = cJSON_AddArrayToObject(object, "warnings");
  const char *text;

  for (PetscInt i = 0; (text = WarningText(i)); ++i) cJSON_AddItemToArray(array, cJSON_CreateString(text));
}

/* ---- sections --------------------------------------------------------------------------------------------------------------- */

static void AddEstimate_Private(cJSON *root, const Estimate *e)
{
  static const char *const part[] = {"interior", "jumps", "boundary", "contact", "incompressibility"};

  AddNumber_Private(root, "estimated_error", e ? e->relative : NAN);
  if (!e) return;
  cJSON *object = cJSON_AddObjectToObject(root, "estimate");
  AddNumber_Private(object, "total", e->total);
  AddNumber_Private(object, "norm", e->norm);
  for (PetscInt i = 0; i < 5; ++i) AddNumber_Private(object, part[i], PetscSqrtReal(e->part[i]));
}

static void AddPair_Private(cJSON *contact, PetscInt dim, const ContactSpec *spec, const PairFigures *f)
{
  cJSON *pair = cJSON_AddObjectToObject(contact, spec->name);

  cJSON_AddBoolToObject(pair, "roles_exchanged", spec->exchanged);
  AddArray_Private(pair, "force", dim, f->force[0]);
  AddMoment_Private(pair, "moment", dim, f->moment[0]);
  AddArray_Private(pair, "mortar_force", dim, f->force[1]);
  AddMoment_Private(pair, "mortar_moment", dim, f->moment[1]);
  AddNumber_Private(pair, "force_imbalance", f->force_imbalance);
  AddNumber_Private(pair, "moment_imbalance", f->moment_imbalance);
  AddNumber_Private(pair, spec->law == CONTACT_TIED ? "max_traction" : "max_pressure", f->max_pressure);
  AddNumber_Private(pair, "area", f->area);
  if (spec->law == CONTACT_TIED) return;
  AddNumber_Private(pair, dim == 2 ? "radius" : "equivalent_radius", f->radius);
  AddNumber_Private(pair, "active_nodes", (PetscReal)f->active_nodes);
  AddNumber_Private(pair, "covered_nodes", (PetscReal)f->covered_nodes);
  AddNumber_Private(pair, "min_gap", f->min_gap);
  AddNumber_Private(pair, "max_gap", f->max_gap);
  AddNumber_Private(pair, "adjusted_gap", f->adjusted);
  AddNumber_Private(pair, "unusable_overlaps", (PetscReal)f->unusable);
  AddNumber_Private(pair, "stabilised_facets", (PetscReal)f->stabilised);
  if (spec->law != CONTACT_COULOMB) return;
  AddNumber_Private(pair, "dissipation", f->friction.dissipation);
  AddNumber_Private(pair, "max_slip", f->friction.max_slip);
  AddNumber_Private(pair, "sticking_nodes", (PetscReal)f->friction.sticking);
  AddNumber_Private(pair, "slipping_nodes", (PetscReal)f->friction.slipping);
}

/* Pressures that are found, and what they follow: in the objects `pressure`, `volume` and `advance`, by boundary; none where there are none. */
static void AddControls_Private(cJSON *root, const SceneData *scene, const Balance *b)
{
  static const char *const key[] = {"pressure", "volume", "advance"};

  for (PetscInt k = 0; k < 3; ++k) {
    cJSON *object = NULL;
    for (PetscInt i = 0; i < b->num_boundaries; ++i) {
      const BoundarySpec *spec = &scene->mechanics.boundaries[i];
      if (!BoundaryIsControlled(spec) || (k == 1 && !spec->volume) || (k == 2 && !spec->advance)) continue;
      if (!object) object = cJSON_AddObjectToObject(root, key[k]);
      AddNumber_Private(object, spec->name, k == 0 ? b->pressure[i] : b->control[i]);
    }
  }
}

/* What supports exert beside their forces, and what is exerted on rigid bodies. */
static void AddMoments_Private(cJSON *root, const SceneData *scene, const Balance *b)
{
  const PetscInt  dim    = Dim_Private(scene);
  const PetscBool ring   = (PetscBool)(scene->mechanics.model == MODEL_AXISYMMETRIC);
  cJSON          *bodies = cJSON_GetObjectItem(root, "body"), *moments = ring ? NULL : cJSON_AddObjectToObject(root, "reaction_moment");

  for (PetscInt i = 0; i < b->num_boundaries && moments; ++i) {
    const BoundarySpec *spec = &scene->mechanics.boundaries[i];
    if (BoundarySupports(spec)) AddMoment_Private(moments, spec->name, dim, b->support_moment[i]);
  }
  for (PetscInt i = 0; i < b->num_bodies; ++i) {
    const BodySpec *spec = &scene->mechanics.bodies[i];
    if (!spec->material->law->rigid) continue;
    if (!bodies) bodies = cJSON_AddObjectToObject(root, "body");
    cJSON *body = cJSON_AddObjectToObject(bodies, spec->name);
    AddArray_Private(body, "displacement", dim, b->motion[i]);
    if (!ring) AddMoment_Private(body, "rotation", dim, b->motion[i] + 3);
    AddArray_Private(body, "force", dim, b->body[i].force);
    if (!ring) AddMoment_Private(body, "moment", dim, b->body[i].moment);
  }
}

static void AddForces_Private(cJSON *root, const SceneData *scene, const Balance *b)
{
  const PetscInt dim      = Dim_Private(scene);
  cJSON         *reaction = cJSON_AddObjectToObject(root, "reaction"), *contact;

  for (PetscInt i = 0; b && i < b->num_boundaries; ++i) {
    if (BoundarySupports(&scene->mechanics.boundaries[i])) AddArray_Private(reaction, scene->mechanics.boundaries[i].name, dim, b->reaction[i]);
  }
  if (b) AddMoments_Private(root, scene, b);
  if (b) AddControls_Private(root, scene, b);
  contact = cJSON_AddObjectToObject(root, "contact");
  for (PetscInt i = 0; b && i < scene->num_contacts; ++i)
    if (scene->contacts[i].part == 0) AddPair_Private(contact, dim, &scene->contacts[i], &b->pair[scene->contacts[i].pair]);
  if (!b) return;
  cJSON *balance = cJSON_AddObjectToObject(root, "balance");
  AddArray_Private(balance, "load", dim, b->load);
  AddNumber_Private(balance, "contact_force", b->force_imbalance);
  AddNumber_Private(balance, "contact_moment", b->moment_imbalance);
  AddNumber_Private(balance, "supports", b->support_imbalance);
}

static void AddProbes_Private(cJSON *root, const SceneData *scene, const Gathered *g)
{
  const PetscInt dim    = Dim_Private(scene);
  cJSON         *probes = cJSON_AddObjectToObject(root, "probe");

  for (PetscInt i = 0; i < g->num_probes; ++i) {
    cJSON *probe = cJSON_AddObjectToObject(probes, scene->probes[i].name);
    AddArray_Private(probe, "displacement", dim, g->probe[i].displacement);
    AddArray_Private(probe, "stress", 6, g->probe[i].stress);
    if (MechanicsIsPlastic(&scene->mechanics)) AddNumber_Private(probe, "plastic_strain", g->probe[i].plastic_strain);
  }
}

/* Plastic flow: largest strain, work, and the mean strain of each body that flows in the object `body`. */
static void AddPlastic_Private(cJSON *root, const SceneData *scene, const Balance *b)
{
  if (!MechanicsIsPlastic(&scene->mechanics)) return;
  AddNumber_Private(root, "plastic_strain", b->plastic_strain);
  AddNumber_Private(root, "plastic_work", b->plastic_work);
  cJSON *bodies = cJSON_AddObjectToObject(root, "body");
  for (PetscInt i = 0; i < b->num_bodies; ++i) {
    const BodySpec *spec = &scene->mechanics.bodies[i];
    if (!spec->material->law->plastic) continue;
    cJSON *body = cJSON_AddObjectToObject(bodies, spec->name);
    AddNumber_Private(body, "mean_plastic_strain", b->mean_strain[i]);
  }
}

/* What could have been left out: by part of the model and name. */
static void AddNeeds_Private(cJSON *root, const Needs *n)
{
  cJSON *needs = cJSON_AddObjectToObject(root, "needs");

  if (!n) return;
  AddNumber_Private(needs, "tolerance", n->tolerance);
  for (PetscInt i = 0; i < n->num; ++i) {
    const Need *row  = &n->rows[i];
    cJSON      *part = cJSON_GetObjectItem(needs, row->part);
    if (!part) part = cJSON_AddObjectToObject(needs, row->part);
    cJSON *need = cJSON_AddObjectToObject(part, row->name);
    AddNumber_Private(need, "change", row->change);
    AddNumber_Private(need, "saves", row->saves);
    cJSON_AddBoolToObject(need, "keeps", row->keeps);
    cJSON_AddItemToObject(need, "set", cJSON_Duplicate(row->set, 1));
    cJSON_AddStringToObject(need, "why", row->why);
  }
}

static void AddTimes_Private(cJSON *root, PetscReal total, const Gathered *g)
{
  cJSON *time = cJSON_AddObjectToObject(root, "time");

  AddNumber_Private(time, "total", total);
  for (PetscInt s = 0; s < NUM_STAGES; ++s) AddNumber_Private(time, StageNames[s], g->seconds[s]);
  AddNumber_Private(root, "peak_memory_mb", g->memory[0]);
  AddNumber_Private(root, "peak_memory_rank_mb", g->memory[1]);
}

/* What was tried where a step or a finer mesh had no solution, and how often one was found so. */
static void AddModifiers_Private(cJSON *root, const Path *path)
{
  cJSON *object = cJSON_AddObjectToObject(root, "modifiers");

  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) AddNumber_Private(object, SolverModifierName(i), (PetscReal)path->modifiers[i]);
}

static void AddRecoveries_Private(cJSON *root, const Path *path)
{
  cJSON *object = cJSON_AddObjectToObject(root, "recoveries");

  for (PetscInt i = 0; i < PATH_RECOVERIES; ++i) {
    cJSON *row = cJSON_AddObjectToObject(object, PathRecoveries[i].name);
    AddNumber_Private(row, "tried", (PetscReal)path->recovery[i].tried);
    AddNumber_Private(row, "succeeded", (PetscReal)path->recovery[i].succeeded);
  }
  AddNumber_Private(root, "viscous_work", path->all_viscous_work);
  AddNumber_Private(root, "flow_error", path->energy > 0 ? path->flow_error / PetscSqrtReal(2 * path->energy) : 0);
  AddNumber_Private(root, "descent_iterations", (PetscReal)path->descent_iterations);
  AddNumber_Private(root, "refused_solutions", (PetscReal)path->refusal[PATH_INSIDE].num);
  AddNumber_Private(root, "passed_through", (PetscReal)path->refusal[PATH_THROUGH].num);
  AddNumber_Private(root, "thrown_off", (PetscReal)path->refusal[PATH_THROWN].num);
  AddNumber_Private(root, "begun_anew", (PetscReal)path->begun_anew);
  AddNumber_Private(root, "rolled_too_far", (PetscReal)path->refusal[PATH_ROLLING].num);
  AddNumber_Private(root, "stabilised", (PetscReal)path->stabilised);
  AddNumber_Private(root, "folded_left", (PetscReal)path->folded_left);
}

static cJSON *Document_Private(const SceneData *scene, const RunSummary *s, const Gathered *g)
{
  const Path      none = {.judged = 0}, *path = s->path ? s->path : &none;
  const char     *slash = strrchr(scene->file, '/');
  const PetscReal nan   = NAN;
  cJSON          *root  = cJSON_CreateObject();

  cJSON_AddStringToObject(root, "mortise", MORTISE_VERSION);
  cJSON_AddStringToObject(root, "scene", slash ? slash + 1 : scene->file);
  cJSON_AddStringToObject(root, "title", scene->title);
  if (scene->units.text[0]) cJSON_AddStringToObject(root, "units", scene->units.text);
  cJSON_AddStringToObject(root, "status", s->status);
  cJSON_AddStringToObject(root, "reason", s->reason ? s->reason : "");
  AddWarnings_Private(root);
  AddNumber_Private(root, "t", s->t);
  cJSON_AddStringToObject(root, "model", ModelNames[scene->mechanics.model]);
  AddNumber_Private(root, "ranks", (PetscReal)g->ranks);
  AddNumber_Private(root, "load_steps", (PetscReal)s->load_steps);
  AddNumber_Private(root, "step_cuts", (PetscReal)path->step_cuts);
  cJSON_AddStringToObject(root, "adapt_stop", s->adapt_stop ? s->adapt_stop : "");
  AddNumber_Private(root, "adapt_passes", (PetscReal)s->adapt_passes);
  AddNumber_Private(root, "newton_iterations", (PetscReal)path->newton_iterations);
  AddNumber_Private(root, "active_set_changes", (PetscReal)path->set_changes);
  AddNumber_Private(root, "single_switches", (PetscReal)path->single_switches);
  AddNumber_Private(root, "active_set_cycles", (PetscReal)path->set_cycles);
  AddNumber_Private(root, "factorisations", (PetscReal)path->factorisations);
  AddNumber_Private(root, "single_factor_failures", (PetscReal)path->single_failures);
  AddModifiers_Private(root, path);
  AddRecoveries_Private(root, path);
  AddNumber_Private(root, "unstable_equilibria", path->judged ? (PetscReal)path->unstable : nan); /* not known of any */
  AddNumber_Private(root, "cells", s->problem ? (PetscReal)g->cells : nan);
  AddNumber_Private(root, "dofs", s->problem ? (PetscReal)g->dofs : nan);
  AddNumber_Private(root, "order_min", s->problem ? (PetscReal)g->order_min : nan);
  AddNumber_Private(root, "order_max", s->problem ? (PetscReal)g->order_max : nan);
  AddEstimate_Private(root, s->estimate);
  AddNumber_Private(root, "energy", s->balance ? s->balance->status.energy : nan);
  AddNumber_Private(root, "min_det", s->balance ? s->balance->status.min_det : nan);
  if (s->balance) AddPlastic_Private(root, scene, s->balance);
  AddForces_Private(root, scene, s->balance);
  AddProbes_Private(root, scene, g);
  AddNeeds_Private(root, s->needs);
  AddTimes_Private(root, s->seconds, g);
  return root;
}

/* ---- gathering -------------------------------------------------------------------------------------------------------------- */

static PetscErrorCode GatherRun_Private(MPI_Comm comm, Gathered *g)
{
  struct rusage usage;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &g->ranks));
  for (PetscInt s = 0; s < NUM_STAGES; ++s) g->seconds[s] = StageSeconds((Stage)s);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, g->seconds, NUM_STAGES, MPIU_REAL, MPI_MAX, comm));
  PetscCheck(getrusage(RUSAGE_SELF, &usage) == 0, PETSC_COMM_SELF, PETSC_ERR_SYS, "getrusage: %s", strerror(errno));
  g->memory[0] = g->memory[1] = (PetscReal)usage.ru_maxrss / 1024; /* Linux counts kB */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &g->memory[0], 1, MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &g->memory[1], 1, MPIU_REAL, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells, dofs, orders of deformable cells, probes. */
static PetscErrorCode GatherState_Private(const SceneData *scene, const RunSummary *s, Gathered *g)
{
  const ForestTables *t = ForestGetTables(ProblemForest(s->problem));

  PetscFunctionBegin;
  g->dofs      = ProblemNumDofs(s->problem);
  g->cells     = t->num_leaves;
  g->order_min = MORTISE_MAX_ORDER;
  for (PetscInt leaf = 0; leaf < t->num_leaves; ++leaf) {
    if (scene->mechanics.bodies[t->leaf_body[leaf]].material->law->rigid) continue;
    g->order_min = PetscMin(g->order_min, s->state->leaf_order[leaf]);
    g->order_max = PetscMax(g->order_max, s->state->leaf_order[leaf]);
  }
  if (!s->probes) PetscFunctionReturn(PETSC_SUCCESS);
  g->num_probes = scene->num_probes;
  PetscCall(PetscMalloc1(g->num_probes, &g->probe));
  PetscCall(ProblemSetState(s->problem, s->state));
  PetscCall(ProbesEvaluate(s->probes, s->problem, s->state->x, g->probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSummary(MPI_Comm comm, const SceneData *scene, const RunSummary *s)
{
  Gathered    g = {0};
  PetscMPIInt rank;
  char        path[PETSC_MAX_PATH_LEN];
  cJSON      *document = NULL;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(GatherRun_Private(comm, &g));
  if (s->problem) PetscCall(GatherState_Private(scene, s, &g));
  if (rank == 0) document = Document_Private(scene, s, &g);
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/summary.json", scene->output.directory));
  PetscCall(SummaryWrite(comm, path, document));
  cJSON_Delete(document);
  PetscCall(PetscFree(g.probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mkdir -p; errno, 0 when the directory is there. */
static int MakeDirectory_Private(const char *path)
{
  char        part[PETSC_MAX_PATH_LEN];
  struct stat kind;

  if (snprintf(part, sizeof(part), "%s", path) >= (int)sizeof(part)) return ENAMETOOLONG;
  for (char *c = part + 1; *c; ++c) {
    if (*c != '/') continue;
    *c = 0;
    if (mkdir(part, 0777) && errno != EEXIST) return errno;
    *c = '/';
  }
  if (mkdir(part, 0777) && errno != EEXIST) return errno;
  if (stat(part, &kind)) return errno;
  return S_ISDIR(kind.st_mode) ? 0 : ENOTDIR;
}

PetscErrorCode OutputDirectoryCreate(MPI_Comm comm, const char *path)
{
  PetscMPIInt rank;
  int         failed = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) failed = MakeDirectory_Private(path);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  PetscCheckInput(!failed, "output.directory: cannot make %s: %s", path, strerror(failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
