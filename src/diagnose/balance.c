/* Balances of a state: what supports, loads and contact exert, and how well it adds up. Every sum here vanishes in exact equilibrium: contact forces of the two
   sides, their moments in the current configuration (O-90 of docs), and all forces on the deformable bodies together. */
#include "diagnose.h"

#define ROUND_OFF 1e-10 /* reactions below this share of the cells' nodal forces cancel: a closed boundary, say */

static PetscReal Norm_Private(const PetscReal a[3])
{
  return PetscSqrtReal(Dot3(a, a));
}

/* Diagonal of the box around a surface, current configuration. */
static PetscErrorCode Diameter_Private(MPI_Comm comm, const SurfaceView *s, PetscReal *diameter)
{
  PetscReal most[6], square = 0; /* - lowest, highest */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 6; ++i) most[i] = PETSC_MIN_REAL;
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    for (PetscInt c = 0; c < s->dim && s->owned[n]; ++c) {
      most[c]     = PetscMax(most[c], -s->x[s->dim * n + c]);
      most[3 + c] = PetscMax(most[3 + c], s->x[s->dim * n + c]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 6, MPIU_REAL, MPI_MAX, comm));
  for (PetscInt c = 0; c < s->dim; ++c) square += PetscSqr(most[3 + c] + most[c]);
  *diameter = s->num_nodes ? PetscSqrtReal(square) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Resultant and moment about a point of nodal forces; sum of their magnitudes. In small kinematics forces act where the nodes were: moments balance there.
 */
static PetscErrorCode SideForces_Private(MPI_Comm comm, const SurfaceView *s, PetscBool small, const PetscReal about[3], PetscReal force[3],
                                         PetscReal moment[3], PetscReal *magnitude)
{
  PetscReal sum[7] = {0};

  PetscFunctionBegin;
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal f[3] = {0, 0, 0}, x[3] = {0, 0, 0}, m[3];

    if (!s->owned[n]) continue;
    for (PetscInt c = 0; c < s->dim; ++c) {
      f[c] = s->force[s->dim * n + c];
      x[c] = (small ? s->X : s->x)[s->dim * n + c] - about[c];
    }
    Cross3(x, f, m);
    for (PetscInt c = 0; c < 3; ++c) {
      sum[c] += f[c];
      sum[3 + c] += m[c];
    }
    sum[6] += Norm_Private(f);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 7, MPIU_REAL, MPI_SUM, comm));
  PetscCall(PetscArraycpy(force, sum, 3));
  PetscCall(PetscArraycpy(moment, sum + 3, 3));
  *magnitude = sum[6];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Axisymmetric: radial forces are no vectors in space, only the axial ones have to balance, and no moment can arise. */
static PetscErrorCode Imbalance_Private(MPI_Comm comm, Model model, PetscBool small, const ContactView *v, PairFigures *f)
{
  PetscReal       force[3], moment[3], sum[2], diameter;
  const PetscBool ring = (PetscBool)(model == MODEL_AXISYMMETRIC);

  PetscFunctionBegin;
  PetscCall(SideForces_Private(comm, &v->nonmortar, small, v->spec->about, f->force[0], f->moment[0], &sum[0]));
  PetscCall(SideForces_Private(comm, &v->mortar, small, v->spec->about, f->force[1], f->moment[1], &sum[1]));
  PetscCall(Diameter_Private(comm, &v->nonmortar, &diameter));
  for (PetscInt c = 0; c < 3; ++c) {
    force[c]  = ring && c == 0 ? 0 : f->force[0][c] + f->force[1][c];
    moment[c] = ring ? 0 : f->moment[0][c] + f->moment[1][c];
  }
  f->total            = sum[0];
  f->force_imbalance  = sum[0] > 0 ? Norm_Private(force) / sum[0] : 0;
  f->moment_imbalance = sum[0] > 0 ? Norm_Private(moment) / (sum[0] * diameter) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Resultant of all loads: minus the sum of the bulk residual over all dofs, because internal forces alone sum to zero. */
static PetscErrorCode Loads_Private(Problem problem, Vec x, Model model, PetscReal load[3])
{
  MechanicsStatus status;
  HPSpace         space = ProblemSpace(problem);
  const HPTables *v     = HPSpaceGetTables(space);
  PetscReal      *u, *r;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(v->num_nodes * v->dim, &u, v->num_nodes * v->dim, &r));
  PetscCall(ProblemLocalDisplacement(problem, x, u));
  PetscCall(MechanicsResidual(ProblemMechanics(problem), u, NULL, r, &status));
  load[0] = load[1] = load[2] = 0;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal *q, *f = r + n * v->dim;
    PetscCall(HPSpaceGetFrame(space, n, &q));
    for (PetscInt c = 0; c < v->dim; ++c) {
      for (PetscInt a = 0; a < v->dim; ++a) load[a] -= (q ? q[3 * c + a] : (PetscReal)(a == c)) * f[c];
    }
  }
  PetscCall(PetscFree2(u, r));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, 3, MPIU_REAL, MPI_SUM, ForestComm(ProblemForest(problem))));
  if (model == MODEL_AXISYMMETRIC) load[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the body behind a contact surface rigid? */
static PetscBool Rigid_Private(const MechanicsSpec *spec, const ForestTables *t, const SurfaceView *s)
{
  return (PetscBool)(s->num_facets && spec->bodies[t->leaf_body[s->facet_leaf[0]]].material->law->rigid);
}

/* All forces on the deformable bodies: supports, loads, and contact with rigid bodies (contact between deformable ones is internal). */
static void Supports_Private(const MechanicsSpec *spec, const ForestTables *t, const ContactView *const view[], Balance *b)
{
  const PetscInt first = spec->model == MODEL_AXISYMMETRIC ? 1 : 0;
  PetscReal      total[3], magnitude = Norm_Private(b->load);

  for (PetscInt c = 0; c < 3; ++c) total[c] = b->load[c];
  for (PetscInt i = 0; i < b->num_boundaries; ++i) {
    magnitude += Norm_Private(b->reaction[i]);
    for (PetscInt c = first; c < 3; ++c) total[c] += b->reaction[i][c];
  }
  for (PetscInt i = 0; i < b->num_contacts; ++i) {
    const PetscBool rigid[2] = {Rigid_Private(spec, t, &view[i]->nonmortar), Rigid_Private(spec, t, &view[i]->mortar)};
    for (PetscInt k = 0; k < 2; ++k) {
      if (rigid[k] || !rigid[1 - k]) continue;
      magnitude += Norm_Private(b->pair[i].force[k]);
      for (PetscInt c = first; c < 3; ++c) total[c] += b->pair[i].force[k][c];
    }
  }
  magnitude            = PetscMax(magnitude, b->status.scale); /* couples have no sum */
  b->support_imbalance = magnitude > 0 ? Norm_Private(total) / magnitude : 0;
}

/* A pair whose roles were exchanged: the side that the scene calls nonmortar comes first. */
static void ExchangeSides_Private(PairFigures *f)
{
  for (PetscInt c = 0; c < 3; ++c) {
    const PetscReal force = f->force[0][c], moment = f->moment[0][c];

    f->force[0][c]  = f->force[1][c];
    f->force[1][c]  = force;
    f->moment[0][c] = f->moment[1][c];
    f->moment[1][c] = moment;
  }
}

static PetscErrorCode Plastic_Private(Problem problem, Vec x, Balance *b)
{
  Forest          forest = ProblemForest(problem);
  const HPTables *v      = HPSpaceGetTables(ProblemSpace(problem));
  PetscReal      *u, (*integral)[2];

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(v->num_nodes * v->dim, &u, b->num_bodies, &integral));
  PetscCall(ProblemLocalDisplacement(problem, x, u));
  PetscCall(MechanicsPlastic(ProblemMechanics(problem), u, &b->plastic_strain, &b->plastic_work, integral));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &b->plastic_strain, 1, MPIU_REAL, MPI_MAX, ForestComm(forest)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &b->plastic_work, 1, MPIU_REAL, MPI_SUM, ForestComm(forest)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, integral, (PetscMPIInt)(2 * b->num_bodies), MPIU_REAL, MPI_SUM, ForestComm(forest)));
  for (PetscInt i = 0; i < b->num_bodies; ++i) b->mean_strain[i] = integral[i][1] > 0 ? integral[i][0] / integral[i][1] : 0;
  PetscCall(PetscFree2(u, integral));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Relative_Private(PetscReal from, PetscReal to)
{
  return from > 0 ? (to - from) / from : 0;
}

void BalanceChange(const Balance *from, const Balance *to, PetscReal change[3])
{
  PetscReal size = 0, difference = 0;

  for (PetscInt i = 0; i < from->num_boundaries; ++i) {
    for (PetscInt c = 0; c < 3; ++c) {
      size += PetscSqr(from->reaction[i][c]);
      difference += PetscSqr(to->reaction[i][c] - from->reaction[i][c]);
    }
  }
  for (PetscInt i = 0; i < from->num_contacts; ++i) {
    size += PetscSqr(from->pair[i].total);
    difference += PetscSqr(to->pair[i].total - from->pair[i].total);
  }
  change[0] = PetscSqrtReal(size) > ROUND_OFF * from->status.scale ? PetscSqrtReal(difference / size) : 0;
  change[1] = Relative_Private(from->plastic_work, to->plastic_work);
  change[2] = Relative_Private(from->plastic_strain, to->plastic_strain);
}

static PetscErrorCode Controls_Private(Problem problem, Vec x, Balance *b)
{
  PetscInt        num;
  const PetscInt *boundary;
  PetscReal      *pressure, *value;

  PetscFunctionBegin;
  PetscCall(MechanicsGetControls(ProblemMechanics(problem), &num, &boundary));
  PetscCall(PetscMalloc2(num, &pressure, num, &value));
  PetscCall(ProblemGetControls(problem, x, pressure, value));
  for (PetscInt k = 0; k < num; ++k) {
    b->pressure[boundary[k]] = pressure[k];
    b->control[boundary[k]]  = value[k];
  }
  PetscCall(PetscFree2(pressure, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where rigid bodies are. */
static PetscErrorCode Motions_Private(Problem problem, const MechanicsSpec *spec, PetscReal (*motion)[6])
{
  Mechanics mechanics = ProblemMechanics(problem);

  PetscFunctionBegin;
  for (PetscInt b = 0; b < spec->num_bodies; ++b) {
    if (!spec->bodies[b].material->law->rigid) continue;
    PetscCall(MechanicsBodyMotion(mechanics, b, spec->bodies[b].about, motion[b]));
    PetscCall(MechanicsBodyRotation(mechanics, b, motion[b] + 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Figures of a pair's further parts to those of its first. */
static void AddPart_Private(const PairFigures *part, PairFigures *to)
{
  const PetscReal total = to->total + part->total;

  for (PetscInt k = 0; k < 2; ++k)
    for (PetscInt c = 0; c < 3; ++c) {
      to->force[k][c] += part->force[k][c];
      to->moment[k][c] += part->moment[k][c];
    }
  if (total > 0) {
    to->force_imbalance  = (to->force_imbalance * to->total + part->force_imbalance * part->total) / total;
    to->moment_imbalance = (to->moment_imbalance * to->total + part->moment_imbalance * part->total) / total;
  }
  to->total = total;
  if (part->covered_nodes) {
    to->min_gap = to->covered_nodes ? PetscMin(to->min_gap, part->min_gap) : part->min_gap;
    to->max_gap = to->covered_nodes ? PetscMax(to->max_gap, part->max_gap) : part->max_gap;
  }
  to->max_pressure = PetscMax(to->max_pressure, part->max_pressure);
  to->area += part->area;
  to->radius   = PetscMax(to->radius, part->radius);
  to->adjusted = PetscMax(to->adjusted, part->adjusted);
  to->unusable += part->unusable;
  to->stabilised = PetscMax(to->stabilised, part->stabilised);
  to->active_nodes += part->active_nodes;
  to->covered_nodes += part->covered_nodes;
  to->friction.dissipation += part->friction.dissipation;
  to->friction.max_slip = PetscMax(to->friction.max_slip, part->friction.max_slip);
  to->friction.sticking += part->friction.sticking;
  to->friction.slipping += part->friction.slipping;
}

/* Of one part of a pair. */
static PetscErrorCode Pair_Private(Problem problem, const SceneData *scene, PetscInt i, const ContactView *view, PairFigures *f)
{
  Forest forest = ProblemForest(problem);

  PetscFunctionBegin;
  PetscCall(BalanceZone(ForestComm(forest), view, f));
  PetscCall(InterfaceFriction(ProblemInterface(problem), i, &f->friction));
  PetscCall(Imbalance_Private(ForestComm(forest), scene->mechanics.model, (PetscBool)(scene->mechanics.kinematics == KINEMATICS_SMALL), view, f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BalanceCompute(Problem problem, const State *state, Balance *b)
{
  const SceneData    *scene;
  const ContactView **view, *v;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(b, sizeof(*b)));
  scene                 = ProblemGetScene(problem);
  const ForestTables *t = ForestGetTables(ProblemForest(problem));
  b->num_boundaries     = scene->mechanics.num_boundaries;
  b->num_contacts       = scene->num_contacts;
  b->num_bodies         = scene->mechanics.num_bodies;
  PetscCall(PetscCalloc5(b->num_boundaries, &b->reaction, b->num_contacts, &b->pair, b->num_boundaries, &b->pressure, b->num_boundaries, &b->control,
                         b->num_bodies, &b->mean_strain));
  PetscCall(PetscCalloc3(b->num_boundaries, &b->support_moment, b->num_bodies, &b->body, b->num_bodies, &b->motion));
  PetscCall(PetscMalloc1(b->num_contacts, &view));
  PetscCall(ProblemForces(problem, state, b->reaction, b->support_moment, b->body, NULL, NULL, &b->status));
  PetscCall(Motions_Private(problem, &scene->mechanics, b->motion));
  b->num_contacts = 0;
  for (PetscInt i = 0; i < scene->num_contacts; ++i) {
    PairFigures part;
    PetscCall(PetscMemzero(&part, sizeof(part)));
    v = InterfaceGetContact(ProblemInterface(problem), i);
    PetscCall(Pair_Private(problem, scene, i, v, &part));
    if (v->spec->part == 0) {
      b->num_contacts        = v->spec->pair + 1;
      view[v->spec->pair]    = v;
      b->pair[v->spec->pair] = part;
    } else
      AddPart_Private(&part, &b->pair[v->spec->pair]);
  }
  for (PetscInt i = 0; i < b->num_contacts; ++i) {
    b->force_imbalance  = PetscMax(b->force_imbalance, b->pair[i].force_imbalance);
    b->moment_imbalance = PetscMax(b->moment_imbalance, b->pair[i].moment_imbalance);
  }
  PetscCall(Loads_Private(problem, state->x, scene->mechanics.model, b->load));
  Supports_Private(&scene->mechanics, t, view, b);
  for (PetscInt i = 0; i < b->num_contacts; ++i)
    if (view[i]->spec->exchanged) ExchangeSides_Private(&b->pair[i]);
  PetscCall(Controls_Private(problem, state->x, b));
  PetscCall(PetscFree(view));
  if (MechanicsIsPlastic(&scene->mechanics)) PetscCall(Plastic_Private(problem, state->x, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool BalanceStaysElastic(const Balance *b, const MechanicsSpec *spec, PetscInt body)
{
  return (PetscBool)(spec->bodies[body].material->law->plastic && b->mean_strain && b->mean_strain[body] == 0);
}

PetscErrorCode BalanceDestroy(Balance *b)
{
  PetscFunctionBegin;
  PetscCall(PetscFree5(b->reaction, b->pair, b->pressure, b->control, b->mean_strain));
  PetscCall(PetscFree3(b->support_moment, b->body, b->motion));
  b->num_boundaries = b->num_contacts = b->num_bodies = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReportRowFill(Problem problem, const State *state, const Estimate *estimate, const Balance *b, ReportRow *row)
{
  const ForestTables *t = ForestGetTables(ProblemForest(problem));

  PetscFunctionBegin;
  row->dofs                = ProblemNumDofs(problem);
  row->t                   = state->t;
  row->cells               = t->num_leaves;
  row->frozen_segmentation = state->form.frozen_segmentation;
  row->active_nodes        = 0;
  row->contact_force       = 0;
  row->min_gap             = 0;
  for (PetscInt i = 0; i < b->num_contacts; ++i)
    if (!b->pair[i].tied) row->min_gap = PETSC_MAX_REAL;
  row->energy            = b->status.energy;
  row->min_det           = b->status.min_det;
  row->estimated_error   = estimate ? estimate->relative : NAN;
  row->estimate          = estimate ? estimate->total : NAN;
  row->force_imbalance   = b->force_imbalance;
  row->moment_imbalance  = b->moment_imbalance;
  row->support_imbalance = b->support_imbalance;
  row->plastic_strain    = b->plastic_strain;
  row->plastic_work      = b->plastic_work;
  for (PetscInt i = 0; i < b->num_contacts; ++i) {
    row->active_nodes += b->pair[i].active_nodes;
    row->contact_force += Norm_Private(b->pair[i].force[0]);
    if (!b->pair[i].tied) row->min_gap = PetscMin(row->min_gap, b->pair[i].min_gap);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
