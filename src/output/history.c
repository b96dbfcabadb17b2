/* history.csv and adapt.csv: what happened, one row per accepted load step and per adaptive pass. */
#include "output.h"

#define ADAPT_COLUMNS 20  /* of OutputAdaptColumns */
#define PLASTIC_COLUMNS 5 /* the last of them */
#define COLUMN_NAME (2 * MORTISE_NAME + 64)

struct _p_History {
  MPI_Comm         comm;
  const SceneData *scene;  /* borrowed */
  Probes           probes; /* borrowed, may be NULL */
  Table            adapt, history;
  PetscInt         num;    /* columns of history.csv */
  PetscReal       *values; /* owned [num] */
};

static const char *const axis_name[]   = {"x", "y", "z"};
static const char *const stress_name[] = {"xx", "xy", "xz", "yy", "yz", "zz"};
static const char *const zone_name[]   = {"max_pressure", "area", "radius", "active_nodes", "min_gap"};
static const char *const slip_name[]   = {"dissipation", "max_slip", "sticking_nodes", "slipping_nodes"};

/* Columns of a table under construction. With names NULL they are counted only; a value is put beside its name, so that both cannot drift apart. */
typedef struct {
  PetscInt num;
  char (*names)[COLUMN_NAME];
  PetscReal *values;
} Columns;

/* Name: kind.owner, then .what and .component where not NULL. */
static PetscErrorCode Column_Private(Columns *c, PetscReal value, const char *kind, const char *owner, const char *what, const char *component)
{
  PetscFunctionBegin;
  if (c->names) {
    PetscCall(PetscSNPrintf(c->names[c->num], COLUMN_NAME, "%s.%s%s%s%s%s", kind, owner, what ? "." : "", what ? what : "", component ? "." : "",
                            component ? component : ""));
  }
  if (c->values) c->values[c->num] = value;
  c->num++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One moment (about z) in two dimensions, three in space. */
static PetscErrorCode MomentColumns_Private(Columns *c, PetscInt dim, const char *kind, const char *name, const PetscReal moment[3])
{
  PetscFunctionBegin;
  for (PetscInt a = dim == 2 ? 2 : 0; a < 3; ++a) PetscCall(Column_Private(c, moment[a], kind, name, "moment", dim == 2 ? NULL : axis_name[a]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PairColumns_Private(Columns *c, PetscInt dim, const ContactSpec *spec, const PairFigures *f)
{
  const char     *name   = spec->name;
  const PetscReal slip[] = {f->friction.dissipation, f->friction.max_slip, (PetscReal)f->friction.sticking, (PetscReal)f->friction.slipping};
  const PetscReal zone[] = {f->max_pressure, f->area, f->radius, (PetscReal)f->active_nodes, f->min_gap};

  PetscFunctionBegin;
  for (PetscInt a = 0; a < dim; ++a) PetscCall(Column_Private(c, f->force[0][a], "contact", name, "force", axis_name[a]));
  PetscCall(MomentColumns_Private(c, dim, "contact", name, f->moment[0]));
  if (spec->law == CONTACT_TIED) {
    PetscCall(Column_Private(c, f->max_pressure, "contact", name, "max_traction", NULL));
    PetscCall(Column_Private(c, f->area, "contact", name, "area", NULL));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < 5; ++k) {
    if (k == 2 && dim == 3) continue;
    PetscCall(Column_Private(c, zone[k], "contact", name, zone_name[k], NULL));
  }
  for (PetscInt k = 0; k < 4 && spec->law == CONTACT_COULOMB; ++k) PetscCall(Column_Private(c, slip[k], "contact", name, slip_name[k], NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces and moments on rigid bodies. */
static PetscErrorCode BodyColumns_Private(Columns *c, const MechanicsSpec *m, PetscInt dim, const Balance *balance)
{
  const Resultant none = {0};

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->num_bodies; ++b) {
    const Resultant *on = balance ? &balance->body[b] : &none;
    if (!m->bodies[b].material->law->rigid) continue;
    for (PetscInt a = 0; a < dim; ++a)
      PetscCall(Column_Private(c, balance ? balance->motion[b][a] : 0, "body", m->bodies[b].name, "displacement", axis_name[a]));
    for (PetscInt a = dim == 2 ? 2 : 0; a < 3 && m->model != MODEL_AXISYMMETRIC; ++a)
      PetscCall(Column_Private(c, balance ? balance->motion[b][3 + a] : 0, "body", m->bodies[b].name, "rotation", dim == 2 ? NULL : axis_name[a]));
    for (PetscInt a = 0; a < dim; ++a) PetscCall(Column_Private(c, on->force[a], "body", m->bodies[b].name, "force", axis_name[a]));
    if (m->model != MODEL_AXISYMMETRIC) PetscCall(MomentColumns_Private(c, dim, "body", m->bodies[b].name, on->moment));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All columns after the fixed ones. balance and probe may be NULL: names only. */
static PetscErrorCode Columns_Private(const SceneData *scene, PetscInt num_probes, const Balance *balance, const ProbeValue probe[], Columns *c)
{
  const PetscInt    dim     = scene->mechanics.model == MODEL_3D ? 3 : 2;
  const PairFigures none    = {0};
  const PetscReal   zero[3] = {0};

  PetscFunctionBegin;
  if (MechanicsIsPlastic(&scene->mechanics)) {
    PetscCall(Column_Private(c, balance ? balance->plastic_strain : 0, "plastic", "strain", NULL, NULL));
    PetscCall(Column_Private(c, balance ? balance->plastic_work : 0, "plastic", "work", NULL, NULL));
  }
  for (PetscInt b = 0; b < scene->mechanics.num_bodies; ++b) {
    const BodySpec *spec = &scene->mechanics.bodies[b];
    if (spec->material->law->plastic) PetscCall(Column_Private(c, balance ? balance->mean_strain[b] : 0, "body", spec->name, "mean_plastic_strain", NULL));
  }
  for (PetscInt b = 0; b < scene->mechanics.num_boundaries; ++b) {
    const BoundarySpec *spec = &scene->mechanics.boundaries[b];
    if (!BoundarySupports(spec)) continue;
    for (PetscInt a = 0; a < dim; ++a) PetscCall(Column_Private(c, balance ? balance->reaction[b][a] : 0, "reaction", spec->name, NULL, axis_name[a]));
    if (scene->mechanics.model == MODEL_AXISYMMETRIC) continue; /* forces on rings have no moment */
    PetscCall(MomentColumns_Private(c, dim, "reaction", spec->name, balance ? balance->support_moment[b] : zero));
  }
  PetscCall(BodyColumns_Private(c, &scene->mechanics, dim, balance));
  for (PetscInt b = 0; b < scene->mechanics.num_boundaries; ++b) {
    const BoundarySpec *spec = &scene->mechanics.boundaries[b];
    if (!BoundaryIsControlled(spec)) continue;
    PetscCall(Column_Private(c, balance ? balance->pressure[b] : 0, "pressure", spec->name, NULL, NULL));
    PetscCall(Column_Private(c, balance ? balance->control[b] : 0, spec->volume ? "volume" : "advance", spec->name, NULL, NULL));
  }
  for (PetscInt i = 0; i < scene->num_contacts; ++i) {
    const ContactSpec *pair = &scene->contacts[i];
    if (pair->part == 0) PetscCall(PairColumns_Private(c, dim, pair, balance ? &balance->pair[pair->pair] : &none));
  }
  for (PetscInt i = 0; i < num_probes; ++i) {
    const char *name = scene->probes[i].name;
    for (PetscInt a = 0; a < dim; ++a) PetscCall(Column_Private(c, probe ? probe[i].displacement[a] : 0, "probe", name, "displacement", axis_name[a]));
    for (PetscInt k = 0; k < 6; ++k) {
      if (dim == 2 && (k == 2 || k == 4)) continue;
      PetscCall(Column_Private(c, probe ? probe[i].stress[k] : 0, "probe", name, "stress", stress_name[k]));
    }
    if (MechanicsIsPlastic(&scene->mechanics)) PetscCall(Column_Private(c, probe ? probe[i].plastic_strain : 0, "probe", name, "plastic_strain", NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Open_Private(History h, const char *file, PetscInt n, const char *const names[], const TablePlace *after, Table *table)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", h->scene->output.directory, file));
  if (after)
    PetscCall(TableResume(h->comm, path, n, names, after, table));
  else
    PetscCall(TableCreate(h->comm, path, n, names, table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns that every scene has stand first in their table. */
static PetscInt NumFixed_Private(const OutputField *field)
{
  PetscInt num = 0;

  while (field[num].name && !strchr(field[num].name, '<') && strncmp(field[num].name, "plastic.", 8)) ++num;
  return num;
}

static PetscErrorCode OpenAdapt_Private(History h, const TablePlace *after)
{
  const char *names[ADAPT_COLUMNS];
  char        columns[ADAPT_COLUMNS][COLUMN_NAME];
  PetscInt    num = 0;

  PetscFunctionBegin;
  while (num < ADAPT_COLUMNS && OutputAdaptColumns[num].name) {
    PetscCall(OutputColumnName(h->scene, OutputAdaptColumns, OutputAdaptColumns[num].name, COLUMN_NAME, columns[num]));
    names[num] = columns[num];
    ++num;
  }
  if (!MechanicsIsPlastic(&h->scene->mechanics)) num -= PLASTIC_COLUMNS;
  PetscCall(Open_Private(h, "adapt.csv", num, names, after, &h->adapt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* history.csv: fixed columns, then those of the scene. */
static PetscErrorCode OpenHistory_Private(History h, const TablePlace *after)
{
  const PetscInt fixed = NumFixed_Private(OutputHistoryColumns), num_probes = h->probes ? h->scene->num_probes : 0;
  const char   **names;
  char(*columns)[COLUMN_NAME];
  Columns c = {0};

  PetscFunctionBegin;
  PetscCall(Columns_Private(h->scene, num_probes, NULL, NULL, &c));
  h->num = fixed + c.num;
  PetscCall(PetscMalloc1(h->num, &h->values));
  PetscCall(PetscMalloc3(c.num, &c.names, h->num, &columns, h->num, &names));
  c.num = 0;
  PetscCall(Columns_Private(h->scene, num_probes, NULL, NULL, &c));
  for (PetscInt i = 0; i < h->num; ++i) {
    PetscCall(OutputColumnName(h->scene, OutputHistoryColumns, i < fixed ? OutputHistoryColumns[i].name : c.names[i - fixed], COLUMN_NAME, columns[i]));
    names[i] = columns[i];
  }
  PetscCall(Open_Private(h, "history.csv", h->num, names, after, &h->history));
  PetscCall(PetscFree3(c.names, columns, names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryCreate(MPI_Comm comm, const SceneData *scene, Probes probes, const TablePlace *after, History *history)
{
  TablePlace all = after ? *after : (TablePlace){0};
  History    h;

  PetscFunctionBegin;
  PetscCall(PetscNew(&h));
  *history    = h;
  h->comm     = comm;
  h->scene    = scene;
  h->probes   = probes;
  all.earlier = PETSC_TRUE;
  PetscCall(OpenHistory_Private(h, after));
  PetscCall(OpenAdapt_Private(h, after ? &all : NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryAgain(History h)
{
  PetscFunctionBegin;
  PetscCall(TableDestroy(&h->history));
  PetscCall(PetscFree(h->values));
  PetscCall(OpenHistory_Private(h, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryDestroy(History *history)
{
  PetscFunctionBegin;
  if (!*history) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TableDestroy(&(*history)->adapt));
  PetscCall(TableDestroy(&(*history)->history));
  PetscCall(PetscFree((*history)->values));
  PetscCall(PetscFree(*history));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Order of OutputAdaptColumns. */
PetscErrorCode HistoryPass(History h, const ReportRow *r)
{
  const PetscReal values[] = {(PetscReal)r->step,
                              (PetscReal)r->pass,
                              r->t,
                              (PetscReal)r->cells,
                              (PetscReal)r->dofs,
                              (PetscReal)r->newton_iterations,
                              (PetscReal)r->active_nodes,
                              r->estimated_error,
                              r->estimate,
                              r->energy,
                              r->min_det,
                              r->min_gap,
                              r->contact_force,
                              r->seconds,
                              r->accepted ? 1. : 0.,
                              r->plastic_strain,
                              r->plastic_work,
                              r->force_change,
                              r->work_change,
                              r->strain_change};

  PetscFunctionBegin;
  PetscCall(TableRow(h->adapt, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Order of OutputHistoryColumns. */
PetscErrorCode HistoryStep(History h, const ReportRow *r, const Balance *balance, Problem problem, const State *state)
{
  const PetscReal fixed[]   = {(PetscReal)r->step,
                               r->t,
                               r->dt,
                               (PetscReal)r->pass,
                               (PetscReal)r->step_cuts,
                               (PetscReal)r->cells,
                               (PetscReal)r->dofs,
                               (PetscReal)r->newton_iterations,
                               (PetscReal)r->active_nodes,
                               r->estimated_error,
                               r->energy,
                               r->min_det,
                               r->min_gap,
                               r->contact_force,
                               r->force_imbalance,
                               r->moment_imbalance,
                               r->support_imbalance,
                               r->seconds,
                               r->viscous_work,
                               (PetscReal)r->frozen_segmentation,
                               (PetscReal)r->modifiers};
  const PetscInt  num_fixed = (PetscInt)PETSC_STATIC_ARRAY_LENGTH(fixed), num_probes = h->probes ? h->scene->num_probes : 0;
  Columns         c = {0, NULL, h->values + num_fixed};
  ProbeValue     *probe;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num_probes, &probe));
  if (num_probes) PetscCall(ProblemSetState(problem, state));
  if (num_probes) PetscCall(ProbesEvaluate(h->probes, problem, state->x, probe));
  PetscCall(PetscArraycpy(h->values, fixed, num_fixed));
  PetscCall(Columns_Private(h->scene, num_probes, balance, probe, &c));
  PetscCall(TableRow(h->history, h->values));
  PetscCall(PetscFree(probe));
  PetscFunctionReturn(PETSC_SUCCESS);
}
