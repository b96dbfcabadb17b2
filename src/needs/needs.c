/* What a run could have left out of its model, at the end of it: parts that did nothing, or of which the energy at the state found says that they change the
   results by less than the tolerance. Formulas: docs/theory.md, no more model than needed. */
#include "needsimpl.h"

#define FORCE_OF_ENERGY 1.5 /* relative change of forces where the energy's is 1: the first nonlinear term of it is cubic in the load */
#define LONG_STEP 5         /* iterations of a solution from which on a load step is a long one for Newton's method: no longer one then */
#define ROUND 1e-6          /* of a share that round-off may make */
#define MOST_CHANGE 0.1     /* first order tells little of larger changes, and no error of a coarse mesh excuses them */
#define MOST_STORED 0.99    /* of the energy once stored that the last state must have, but for what adaptation and steps change */

/* Shares of the time in assembly, estimate and transfer that go with a part of the material law: inputs/angioplasty2d.yml, tests/needs/plate.yml and tissue.yml
   with and without. */
static const PetscReal OfFlow[] = {0.4, 0.4, 0.8}, OfFibers[] = {0.15, 0.1, 0}, OfPressure[] = {0.3, 0.6, 0};

typedef struct {
  const NeedsRun *run;
  Needs          *needs;
  BodyTerms      *terms;                /* owned [num_bodies], over all ranks */
  PetscInt       *cells;                /* owned [num_bodies] */
  PetscReal       energy;               /* of all bodies */
  PetscReal       turn;                 /* work of follower pressures beyond that of dead loads */
  PetscInt        layers[3], rounds[3]; /* NeedsFindPrism, by axis: along it, around it */
  PetscReal       along[3], around[3];
  PetscReal       total;   /* seconds of the run */
  PetscReal       solving; /* share of it in Newton's iterations */
  PetscReal       mesh;    /* share of it that goes with the number of cells */
} Context;

/* ---- rows ----------------------------------------------------------------------------------------------------------------------------- */

static PetscErrorCode Row_Private(Context *c, const char *part, const char *name, PetscReal change, PetscReal saves, const char *why, Need **row)
{
  Needs *n = c->needs;

  PetscFunctionBegin;
  PetscCall(PetscRealloc((size_t)(n->num + 1) * sizeof(*n->rows), &n->rows));
  *row = &n->rows[n->num++];
  PetscCall(PetscMemzero(*row, sizeof(**row)));
  (*row)->part   = part;
  (*row)->change = PetscAbsReal(change);
  (*row)->saves  = PetscMax(0, saves);
  (*row)->keeps  = (PetscBool)((*row)->change <= PetscMin(n->tolerance, MOST_CHANGE));
  (*row)->set    = cJSON_CreateObject();
  PetscCall(PetscStrncpy((*row)->name, name, sizeof((*row)->name)));
  PetscCall(PetscStrncpy((*row)->why, why, sizeof((*row)->why)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row that goes by the energy of the last state, which tells nothing of a state before that stored more; or by there being no other way, where that was a
   barrier. */
static PetscErrorCode EnergyRow_Private(Context *c, const char *part, const char *name, PetscReal change, PetscReal saves, const char *why, Need **row)
{
  PetscFunctionBegin;
  PetscCall(Row_Private(c, part, name, change, saves, why, row));
  if (c->run->balance->status.energy < MOST_STORED * c->run->most_energy) (*row)->keeps = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The object of a key "<first>.<name><last>" in row->set. */
static cJSON *Object_Private(Need *row, const char *first, const char *name)
{
  char key[2 * MORTISE_NAME];

  (void)snprintf(key, sizeof(key), "%s.%s", first, name);
  return cJSON_AddObjectToObject(row->set, key);
}

static void Drop_Private(Need *row, const char *first, const char *name)
{
  char key[2 * MORTISE_NAME];

  (void)snprintf(key, sizeof(key), "%s.%s", first, name);
  cJSON_AddNullToObject(row->set, key);
}

/* An isotropic material of this law with the moduli of m. */
static void Elastic_Private(Need *row, const MaterialSpec *m, const char *law)
{
  cJSON          *object = Object_Private(row, "material", m->name);
  const PetscBool linear = (PetscBool)!strcmp(law, "linear");

  cJSON_AddStringToObject(object, "law", law);
  cJSON_AddNumberToObject(object, "mu", (double)m->mu);
  if (m->incompressible)
    cJSON_AddStringToObject(object, "kappa", "inf");
  else
    cJSON_AddNumberToObject(object, "kappa", (double)m->kappa);
  if (!linear) cJSON_AddStringToObject(object, "volumetric", VolumetricNames[m->volumetric]);
  cJSON_AddStringToObject(object, "formulation", m->mixed ? "mixed" : "displacement");
}

/* Saved in the cells of a material. */
static PetscReal Saves_Private(const Context *c, const MaterialSpec *m, const PetscReal share[])
{
  PetscInt cells = 0, all = 0;

  for (PetscInt b = 0; b < c->run->data->mechanics.num_bodies; ++b) {
    all += c->cells[b];
    if (c->run->data->mechanics.bodies[b].material == m) cells += c->cells[b];
  }
  return (PetscReal)cells / (PetscReal)all *
         (share[0] * StageSeconds(STAGE_ASSEMBLE) + share[1] * StageSeconds(STAGE_ESTIMATE) + share[2] * StageSeconds(STAGE_TRANSFER)) / c->total;
}

/* ---- parts that did nothing ----------------------------------------------------------------------------------------------------------- */

/* Of the time in contact the part of a pair; of the matrix, where it has room for what faces the pair's sides, in their rows and for them in the rows of that,
   twice the share of the nodes on them. */
static PetscErrorCode OfPair_Private(const Context *c, PetscInt pair, PetscReal *contact, PetscReal *matrix)
{
  Interface          interface = ProblemInterface(c->run->level->problem);
  const ContactView *v         = InterfaceGetContact(interface, pair);
  PetscReal          seconds, all;
  PetscBool          room;

  PetscFunctionBegin;
  InterfaceCost(interface, pair, &seconds, &all, &room);
  const HPTables *tables = HPSpaceGetTables(ProblemSpace(c->run->level->problem));
  PetscReal       sum[]  = {(PetscReal)(v->nonmortar.num_nodes + v->mortar.num_nodes), (PetscReal)tables->num_nodes, seconds, all, room};
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 5, MPIU_REAL, MPI_SUM, c->run->comm));
  *matrix  = sum[4] > 0 ? 2 * sum[0] / sum[1] : 0;
  *contact = sum[3] > 0 ? sum[2] / sum[3] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Contact_Private(Context *c)
{
  const SceneData *data = c->run->data;
  PetscReal        contact, matrix;
  Need            *row;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < data->num_contacts; ++i) {
    const PetscInt pair = data->contacts[i].pair;
    if (data->contacts[i].part || c->run->touched[pair] || PathPressed(c->run->path, pair) || c->run->balance->pair[pair].tied) continue;
    PetscCall(OfPair_Private(c, i, &contact, &matrix));
    const PetscReal system = StageSeconds(STAGE_SETUP) + StageSeconds(STAGE_FACTOR) + StageSeconds(STAGE_SOLVE);
    const PetscReal saves  = (contact * StageSeconds(STAGE_CONTACT) + matrix * system) / c->total;
    PetscCall(Row_Private(c, "contact", data->contacts[i].name, 0, saves, "its sides have not touched", &row));
    Drop_Private(row, "contact", data->contacts[i].name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is it the material of these bodies only that `alike` holds of? First: of them. */
static PetscBool All_Private(const Context *c, PetscInt material, PetscBool (*alike)(const Context *, PetscInt body))
{
  const SceneData *data = c->run->data;
  PetscBool        any  = PETSC_FALSE;

  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b) {
    if (data->mechanics.bodies[b].material != &data->materials[material]) continue;
    if (!alike(c, b)) return PETSC_FALSE;
    any = PETSC_TRUE;
  }
  return any;
}

static PetscBool Elastic(const Context *c, PetscInt body)
{
  return BalanceStaysElastic(c->run->balance, &c->run->data->mechanics, body);
}

/* Half of the factorisations' time, where nothing but this material makes the matrix unsymmetric. */
static PetscReal Symmetric_Private(const Context *c, const MaterialSpec *material)
{
  const PetscBool possible = ProblemIsSymmetricBut(c->run->level->problem, material);

  return possible && material->law->unsymmetric ? 0.5 * StageSeconds(STAGE_FACTOR) / c->total : 0;
}

static PetscErrorCode Flow_Private(Context *c)
{
  const SceneData *data = c->run->data;
  Need            *row;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < data->num_materials; ++i) {
    const MaterialSpec *m = &data->materials[i];
    if (!All_Private(c, i, Elastic)) continue;
    const PetscReal symmetric = Symmetric_Private(c, m);
    PetscCall(Row_Private(c, "flow", m->name, 0, Saves_Private(c, m, OfFlow) + symmetric,
                          "its material has not flowed: neo_hookean with the same moduli and volumetric gives the same", &row));
    Elastic_Private(row, m, "neo_hookean");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- materials ------------------------------------------------------------------------------------------------------------------------ */

/* Sum of an energy over the bodies of a material, relative to that of all bodies. */
static PetscReal Share_Private(const Context *c, PetscInt material, size_t offset)
{
  const SceneData *data = c->run->data;
  PetscReal        sum  = 0;

  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b)
    if (data->mechanics.bodies[b].material == &data->materials[material]) sum += *(const PetscReal *)((const char *)&c->terms[b] + offset);
  return c->energy > 0 ? sum / c->energy : 0;
}

/* Has its ground substance a second invariant? Then it is no neo_hookean without fibres. */
static PetscBool SecondInvariant_Private(const MaterialSpec *m)
{
  for (PetscInt k = 0; m->law->parameters[k].name; ++k)
    if (!strcmp(m->law->parameters[k].name, "c2") && m->parameter[k] > 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode Fibers_Private(Context *c)
{
  const SceneData *data = c->run->data;
  Need            *row;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < data->num_materials; ++i) {
    const MaterialSpec *m = &data->materials[i];
    if (!m->num_fibers || data->mechanics.kinematics == KINEMATICS_SMALL || SecondInvariant_Private(m)) continue;
    const PetscReal share = Share_Private(c, i, offsetof(BodyTerms, fibers));
    PetscCall(EnergyRow_Private(c, "fibers", m->name, FORCE_OF_ENERGY * share, Saves_Private(c, m, OfFibers),
                                share == 0 ? "they were slack everywhere" : "the share of the energy in its fibres", &row));
    Elastic_Private(row, m, "neo_hookean");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Root mean square of the strain in the bodies of a material (NULL: in all). Changes of volume of second order in it times kappa outweigh shear where it is
 * above mu / kappa.
 */
static PetscReal Strain_Private(const Context *c, const MaterialSpec *m)
{
  PetscReal volume = 0, strain2 = 0;

  for (PetscInt b = 0; b < c->run->data->mechanics.num_bodies; ++b) {
    if (m && c->run->data->mechanics.bodies[b].material != m) continue;
    volume += c->terms[b].volume;
    strain2 += c->terms[b].strain2;
  }
  return volume > 0 ? PetscSqrtReal(strain2 / volume) : 0;
}

static PetscErrorCode Mixed_Private(Context *c)
{
  const SceneData *data = c->run->data;
  Need            *row;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < data->num_materials; ++i) {
    const MaterialSpec *m = &data->materials[i];
    if (m->law->rigid || !MaterialStoresPressure(m) || m->volumetric == VOLUMETRIC_LOG) continue;
    const PetscReal share = Share_Private(c, i, offsetof(BodyTerms, projected));
    if (share == 0) continue;
    PetscCall(EnergyRow_Private(c, "mixed", m->name, PetscSqrtReal(PetscMax(0, share)), Saves_Private(c, m, OfPressure),
                                "root of the energy that the displacement form adds at the state found", &row));
    if (m->kappa / m->mu * Strain_Private(c, m) > 1) row->keeps = PETSC_FALSE; /* it costs Newton's method more than it saves */
    char key[2 * MORTISE_NAME];
    (void)snprintf(key, sizeof(key), "material.%s.formulation", m->name);
    cJSON_AddStringToObject(row->set, key, "displacement");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- kinematics ----------------------------------------------------------------------------------------------------------------------- */

/* Have both kinematics the same keys? */
static PetscBool MayBeSmall_Private(const SceneData *data)
{
  const MechanicsSpec *m = &data->mechanics;

  if (m->kinematics == KINEMATICS_SMALL || data->load.control == LOAD_ARC_LENGTH) return PETSC_FALSE;
  for (PetscInt b = 0; b < m->num_bodies; ++b)
    if (m->bodies[b].material->law->num_history || m->bodies[b].rotation_angle || BodyIsLoaded(&m->bodies[b])) return PETSC_FALSE;
  for (PetscInt i = 0; i < m->num_boundaries; ++i)
    if (m->boundaries[i].rotation || BoundaryIsControlled(&m->boundaries[i])) return PETSC_FALSE;
  for (PetscInt i = 0; i < data->num_contacts; ++i)
    if (data->contacts[i].law == CONTACT_COULOMB || data->contacts[i].self) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* What the strains that small kinematics leaves out, or adds, do to forces where a body is held in two places: stretched along the way
   between them it would resist, and a beam that bends between fixed ends pulls at them though that takes it little energy. Of the largest force. */
static PetscErrorCode Between_Private(Context *c, PetscReal *change)
{
  const MechanicsSpec *m       = &c->run->data->mechanics;
  const Balance       *balance = c->run->balance;
  PetscReal            largest = 0;

  PetscFunctionBegin;
  *change = 0;
  for (PetscInt i = 0; i < balance->num_boundaries; ++i) largest = PetscMax(largest, Dot3(balance->reaction[i], balance->reaction[i]));
  for (PetscInt i = 0; i < balance->num_contacts; ++i) largest = PetscMax(largest, Dot3(balance->pair[i].force[0], balance->pair[i].force[0]));
  for (PetscInt b = 0; b < m->num_bodies && largest > 0; ++b) {
    const MaterialSpec *s = m->bodies[b].material;
    PetscReal           strain;
    if (s->law->rigid) continue;
    PetscCall(NeedsStretch(c->run, b, &strain));
    const PetscReal modulus = 4 * s->mu * (s->incompressible ? 1 : (3 * s->kappa + s->mu) / (3 * s->kappa + 4 * s->mu)); /* across a plane */
    *change                 = PetscMax(*change, strain * PetscSqrtReal(c->terms[b].misfit * modulus * c->terms[b].volume / largest));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Kinematics_Private(Context *c)
{
  const SceneData *data     = c->run->data;
  const Path      *path     = c->run->path;
  const PetscInt   again    = PetscMax(0, path->factorisations - path->newton_iterations); /* for changes of the active set, which stay */
  const PetscInt   tangents = c->run->load_steps + c->run->adapt_passes + again;
  PetscReal        linear = c->turn, misfit = 0, slide = 0, between;
  Need            *row;

  PetscFunctionBegin;
  if (!MayBeSmall_Private(data) || c->energy <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b) {
    linear += c->terms[b].linear;
    misfit += c->terms[b].misfit;
  }
  for (PetscInt i = 0; i < data->num_contacts; ++i) {
    PetscReal turn;
    PetscCall(NeedsContactTurn(c->run, i, &turn));
    slide = PetscMax(slide, turn);
  }
  PetscCall(Between_Private(c, &between));
  const PetscReal fewer     = PetscMin(1, (PetscReal)tangents / (PetscReal)PetscMax(1, PetscMax(path->factorisations, path->newton_iterations)));
  const PetscReal of_energy = FORCE_OF_ENERGY * PetscAbsReal(linear) / c->energy, of_strain = PetscSqrtReal(misfit / (2 * c->energy));
  PetscCall(EnergyRow_Private(c, "kinematics", "scene", PetscMax(PetscMax(slide, between), PetscMax(of_energy, of_strain)), c->solving * (1 - fewer),
                              "the energy that the nonlinear terms add at the state found", &row));
  cJSON_AddStringToObject(row->set, "kinematics", "small");
  for (PetscInt i = 0; i < data->num_materials; ++i)
    if (!data->materials[i].law->rigid) Elastic_Private(row, &data->materials[i], "linear");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- load steps ----------------------------------------------------------------------------------------------------------------------- */

/* Nothing remembers the path, and nothing on it was other than plain. */
static PetscBool Forgets_Private(const NeedsRun *run)
{
  const SceneData *data = run->data;
  const Path      *p    = run->path;

  if (data->load.control == LOAD_ARC_LENGTH || data->load.stop_displacement > 0 || p->step_cuts || p->stabilised || (p->judged && p->unstable))
    return PETSC_FALSE;
  for (PetscInt i = 0; i < PATH_RECOVERIES; ++i)
    if (p->recovery[i].tried) return PETSC_FALSE;
  for (PetscInt i = 0; i < PATH_REFUSALS; ++i)
    if (p->refusal[i].num) return PETSC_FALSE;
  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b)
    if (data->mechanics.bodies[b].material->law->num_history && !BalanceStaysElastic(run->balance, &data->mechanics, b)) return PETSC_FALSE;
  for (PetscInt i = 0; i < data->num_contacts; ++i)
    if (data->contacts[i].law == CONTACT_COULOMB || data->contacts[i].self) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscErrorCode LoadSteps_Private(Context *c)
{
  const SceneData *data  = c->run->data;
  PetscInt         least = 1;
  Need            *row;

  PetscFunctionBegin;
  for (PetscReal t = PathStepEnd(data, 0, data->load.end); t < data->load.end; t = PathStepEnd(data, t, data->load.end)) ++least;
  if (c->run->load_steps <= least || !Forgets_Private(c->run)) PetscFunctionReturn(PETSC_SUCCESS);
  /* On the way to the end at once there is a solution on each mesh as well: what goes are the ones that later steps begin with. */
  const PetscReal fewer = (PetscReal)(c->run->load_steps - least) / (PetscReal)(c->run->load_steps - 1);
  PetscCall(EnergyRow_Private(c, "load_steps", "scene", 0, fewer * c->run->later / c->total,
                              "nothing remembers the path; of several equilibria another may be found", &row));
  if (c->run->path->newton_iterations >= LONG_STEP * (c->run->load_steps + c->run->adapt_passes)) row->keeps = PETSC_FALSE;
  for (PetscInt i = 0; i < data->num_contacts; ++i)
    if (c->run->touched[i] > 1) row->keeps = PETSC_FALSE; /* a first touch from far away costs Newton's method more than the steps */
  cJSON_AddNumberToObject(row->set, "load.step", (double)data->load.end);
  cJSON_AddNullToObject(row->set, "load.step_max");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- bodies, symmetry ----------------------------------------------------------------------------------------------------------------- */

/* Root mean square of the strain in a body over that in all others. A body that others stretch is soft, however little energy it takes: with stiffness of its
   own it would hold them. */
static PetscReal Stretched_Private(const Context *c, PetscInt body)
{
  PetscReal volume = 0, strain2 = 0;

  for (PetscInt k = 0; k < c->run->data->mechanics.num_bodies; ++k) {
    if (k == body) continue;
    volume += c->terms[k].volume;
    strain2 += c->terms[k].strain2;
  }
  return strain2 > 0 ? PetscSqrtReal(c->terms[body].strain2 / c->terms[body].volume / (strain2 / volume)) : PETSC_MAX_REAL;
}

static PetscInt Users_Private(const SceneData *data, const MaterialSpec *m)
{
  PetscInt users = 0;

  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b) users += data->mechanics.bodies[b].material == m;
  return users;
}

static PetscErrorCode Rigid_Private(Context *c)
{
  const SceneData *data = c->run->data;
  Need            *row;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < data->mechanics.num_bodies && c->energy > 0; ++b) {
    const BodySpec *s      = &data->mechanics.bodies[b];
    const PetscReal share  = c->terms[b].energy / c->energy;
    cJSON          *motion = NULL;
    PetscBool       held;
    if (s->material->law->rigid || share > 0.5 * (1 - ROUND)) continue; /* like bodies have half each */
    if (s->material->law->plastic && !BalanceStaysElastic(c->run->balance, &data->mechanics, b)) continue;
    PetscCall(NeedsRigidMotion(c->run, b, &motion, &held));
    if (held) {
      PetscInt all = 0;
      for (PetscInt k = 0; k < data->mechanics.num_bodies; ++k) all += c->cells[k];
      PetscCall(EnergyRow_Private(c, "rigid", s->name, PetscMax(share / (1 - share), Stretched_Private(c, b)),
                                  c->mesh * (PetscReal)c->cells[b] / (PetscReal)all, "the share of the energy in it", &row));
      cJSON *body = Object_Private(row, "body", s->name);
      cJSON_AddStringToObject(body, "material", "left_out_rigid");
      if (motion->child) cJSON_AddItemToObject(body, "motion", cJSON_Duplicate(motion, 1));
      cJSON_AddStringToObject(Object_Private(row, "material", "left_out_rigid"), "law", "rigid");
      if (Users_Private(data, s->material) == 1) Drop_Private(row, "material", s->material->name);
    }
    cJSON_Delete(motion);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Symmetry_Private(Context *c)
{
  Need *row;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < 3; ++a) {
    const char name[] = {(char)('x' + a), 0};
    PetscReal  off;
    if (!c->run->mirror[a] || (c->layers[a] && c->along[a] <= c->needs->tolerance)) continue; /* a section is less than half */
    PetscCall(NeedsAsymmetry(c->run, a, &off));
    PetscCall(Row_Private(c, "symmetry", name, off, 0.5 * c->mesh, "mesh, supports and loads are symmetric: half is enough", &row));
    cJSON *plane = cJSON_AddObjectToObject(row->set, "plane");
    cJSON_AddNumberToObject(plane, name, (double)c->run->mirror_at[a]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Prism_Private(Context *c)
{
  const SceneData *data = c->run->data;
  Need            *row;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b)
    if (data->mechanics.bodies[b].material->num_fibers || BodyIsLoaded(&data->mechanics.bodies[b])) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt a = 0; a < 3; ++a) {
    const char name[] = {(char)('x' + a), 0};
    PetscInt   order  = MORTISE_MAX_ORDER;
    if (!c->layers[a]) continue;
    for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b) order = PetscMin(order, data->mechanics.bodies[b].order);
    PetscCall(Row_Private(c, "prism", name, c->along[a], c->mesh * (1 - (2. / 3) / (PetscReal)(c->layers[a] * order + 1)),
                          "nothing moves or changes along this axis: model plane_strain is enough", &row));
    cJSON_AddStringToObject(row->set, "section", name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do the supports and loads of a boundary hold of a ring as well? */
static PetscBool GoesRound_Private(const BoundarySpec *b, PetscInt axis)
{
  if (b->rotation || BoundaryIsControlled(b) || (b->pressure && ExpressionUsesPlace(b->pressure))) return PETSC_FALSE;
  for (PetscInt c = 0; c < 3; ++c) {
    const Expression given[] = {b->displacement[c], b->traction[c]};
    for (PetscInt k = 0; k < 2; ++k)
      if (given[k] && (c != axis || ExpressionUsesPlace(given[k]))) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* A model of the section of a body of revolution. */
static PetscErrorCode Revolution_Private(Context *c)
{
  const MechanicsSpec *m = &c->run->data->mechanics;
  Need                *row;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->num_bodies; ++b) {
    const BodySpec *s = &m->bodies[b];
    if (s->material->num_fibers || s->material->law->rigid || s->force[0] || s->force[1] || s->force[2]) PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt a = 0; a < 3; ++a) {
    const char name[] = {(char)('x' + a), 0};
    PetscInt   order  = MORTISE_MAX_ORDER;
    PetscBool  round  = (PetscBool)(c->rounds[a] > 0);
    for (PetscInt i = 0; i < m->num_boundaries; ++i) round = (PetscBool)(round && GoesRound_Private(&m->boundaries[i], a));
    if (!round) continue;
    for (PetscInt b = 0; b < m->num_bodies; ++b) order = PetscMin(order, m->bodies[b].order);
    PetscCall(Row_Private(c, "revolution", name, c->around[a], c->mesh * (1 - (2. / 3) / (PetscReal)(c->rounds[a] * order + 1)),
                          "nothing moves or changes around this axis: model axisymmetric is enough", &row));
    cJSON_AddStringToObject(row->set, "revolve", name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- cells ---------------------------------------------------------------------------------------------------------------------------- */

/* The first mesh was fine enough at once, and a coarser one would have been: each halving of cells of order p leaves 2^-p of the error. */
static PetscErrorCode Cells_Private(Context *c)
{
  const SceneData *data  = c->run->data;
  PetscInt         order = MORTISE_MAX_ORDER;
  Need            *row;

  PetscFunctionBegin;
  if (data->adapt.tolerance <= 0 || c->run->adapt_passes || !c->run->estimate || data->mesh.refine < 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b)
    if (!data->mechanics.bodies[b].material->law->rigid) order = PetscMin(order, data->mechanics.bodies[b].order);
  const PetscReal dim = data->mechanics.model == MODEL_3D ? 3 : 2, change = c->run->estimate->relative * PetscPowRealInt(2, order);
  PetscCall(Row_Private(c, "cells", "scene", change, c->mesh * (1 - PetscPowReal(2, -dim)), "the error of a mesh twice as coarse, from the estimate", &row));
  cJSON_AddNumberToObject(row->set, "mesh.refine", (double)(data->mesh.refine - 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- orders --------------------------------------------------------------------------------------------------------------------------- */

/* Is the body in a contact pair? There orders per direction cost contact faces their curves. */
static PetscErrorCode InPair_Private(const Context *c, PetscInt body, PetscBool *yes)
{
  PetscFunctionBegin;
  *yes                  = PETSC_FALSE;
  const ForestTables *t = ForestGetTables(c->run->level->forest);
  for (PetscInt i = 0; i < c->run->data->num_contacts; ++i) {
    const uint64_t sides = UINT64_C(1) << c->run->data->contacts[i].nonmortar | UINT64_C(1) << c->run->data->contacts[i].mortar;
    for (PetscInt leaf = 0; leaf < t->num_leaves; ++leaf)
      if (t->leaf_body[leaf] == body && ForestLeafTouches(t, leaf, sides)) *yes = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, yes, 1, MPIU_BOOL, MPI_LOR, c->run->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The least order along a direction (-1: along all) with which the error keeps the tolerance; the body's own: none. */
static PetscErrorCode Least_Private(Context *c, PetscInt body, PetscInt direction, PetscInt *least, PetscReal *change)
{
  PetscFunctionBegin;
  *least = c->run->data->mechanics.bodies[body].order;
  for (PetscInt q = *least - 1; q > 0; --q) {
    PetscReal lost;
    PetscCall(NeedsLostByOrder(c->run, body, direction, q, &lost));
    const PetscReal off = PetscSqrtReal(PetscSqr(c->run->estimate->relative) + lost / c->energy);
    if (off > c->needs->tolerance) break;
    *least  = q;
    *change = off;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Order_Private(Context *c, PetscInt body, PetscInt direction, PetscInt dim, PetscInt *least)
{
  const BodySpec *s    = &c->run->data->mechanics.bodies[body];
  const char      axis = (char)('x' + direction);
  char            name[MORTISE_NAME + 2];
  PetscReal       change = 0;
  PetscInt        all    = 0;
  Need           *row;

  PetscFunctionBegin;
  PetscCall(Least_Private(c, body, direction, least, &change));
  if (*least == s->order) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < c->run->data->mechanics.num_bodies; ++k) all += c->cells[k];
  const PetscReal part = (PetscReal)*least / (PetscReal)s->order, nodes = direction < 0 ? PetscPowRealInt(part, dim) : part;
  if (direction < 0) {
    PetscCall(PetscStrncpy(name, s->name, sizeof(name)));
  } else {
    (void)snprintf(name, sizeof(name), "%s.%c", s->name, axis);
  }
  PetscCall(Row_Private(c, "order", name, change, c->mesh * (1 - nodes) * (PetscReal)c->cells[body] / (PetscReal)all,
                        "the strain that the displacements lose with it, and the estimate", &row));
  if (direction < 0) {
    char key[2 * MORTISE_NAME];
    (void)snprintf(key, sizeof(key), "body.%s.order", s->name);
    cJSON_AddNumberToObject(row->set, key, (double)*least);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  (void)snprintf(name, sizeof(name), "%s.order", s->name);
  cJSON *orders = Object_Private(row, "body", name);
  for (PetscInt a = 0; a < dim; ++a) cJSON_AddNumberToObject(orders, (const char[]){(char)('x' + a), 0}, (double)(a == direction ? *least : s->order));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* As with cells: the first mesh was fine enough at once. A direction of its own where it can do with less than all together. */
static PetscErrorCode Orders_Private(Context *c)
{
  const MechanicsSpec *m   = &c->run->data->mechanics;
  const PetscInt       dim = m->model == MODEL_3D ? 3 : 2;

  PetscFunctionBegin;
  if (c->run->data->adapt.tolerance <= 0 || c->run->adapt_passes || !c->run->estimate || !(c->energy > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < m->num_bodies; ++b) {
    const BodySpec *s = &m->bodies[b];
    PetscBool       paired;
    PetscInt        together, least;
    if (s->material->law->rigid || s->order_along[0] || s->order_along[1] || s->order_along[2]) continue;
    PetscCall(Order_Private(c, b, -1, dim, &together));
    PetscCall(InPair_Private(c, b, &paired));
    for (PetscInt a = 0; a < dim && !paired; ++a) {
      PetscReal change;
      PetscCall(Least_Private(c, b, a, &least, &change));
      if (least < together) PetscCall(Order_Private(c, b, a, dim, &least));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- all ------------------------------------------------------------------------------------------------------------------------------ */

/* Does any row ask for energies? Not of one body of linear material. */
static PetscBool Asked_Private(const NeedsRun *run)
{
  const SceneData *data = run->data;

  if (data->adapt.tolerance > 0 && !run->adapt_passes) return PETSC_TRUE;
  if (data->mechanics.model == MODEL_3D || data->mechanics.kinematics == KINEMATICS_FINITE || data->mechanics.num_bodies > 1) return PETSC_TRUE;
  return MaterialStoresPressure(data->mechanics.bodies[0].material);
}

static PetscErrorCode Terms_Private(Context *c)
{
  Level              *l         = c->run->level;
  const PetscInt      num       = c->run->data->mechanics.num_bodies;
  const HPTables     *v         = HPSpaceGetTables(ProblemSpace(l->problem));
  const ForestTables *t         = ForestGetTables(l->forest);
  Mechanics           mechanics = ProblemMechanics(l->problem);
  PetscReal          *u;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(num, &c->terms, num, &c->cells));
  for (PetscInt i = 0; i < t->num_leaves; ++i) ++c->cells[t->leaf_body[i]];
  if (!Asked_Private(c->run)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(ProblemSetState(l->problem, &l->accepted));
  PetscCall(ProblemLocalDisplacement(l->problem, l->accepted.x, u));
  PetscCall(MechanicsTerms(mechanics, u, c->terms));
  PetscCall(MechanicsFollowerTurn(mechanics, u, &c->turn));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->turn, 1, MPIU_REAL, MPI_SUM, c->run->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c->terms, (PetscMPIInt)((size_t)num * sizeof(*c->terms) / sizeof(PetscReal)), MPIU_REAL, MPI_SUM, c->run->comm));
  for (PetscInt i = 0; i < num; ++i) c->energy += c->terms[i].energy;
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NeedsFind(const NeedsRun *run, Needs *needs)
{
  static PetscErrorCode (*const parts[])(Context *) = {Contact_Private,    Flow_Private,       Fibers_Private, Mixed_Private,
                                                       Kinematics_Private, LoadSteps_Private,  Rigid_Private,  Symmetry_Private,
                                                       Prism_Private,      Revolution_Private, Cells_Private,  Orders_Private};
  static const Stage iterating[]                    = {STAGE_ASSEMBLE, STAGE_CONTACT, STAGE_FACTOR, STAGE_SOLVE};
  static const Stage meshed[]                       = {STAGE_SETUP, STAGE_ESTIMATE, STAGE_TRANSFER};
  Context            c                              = {.run = run, .needs = needs, .total = run->seconds};

  PetscFunctionBegin;
  needs->tolerance = run->data->adapt.tolerance > 0 ? run->data->adapt.tolerance : run->estimate ? run->estimate->relative : 0;
  for (size_t i = 0; i < sizeof(iterating) / sizeof(*iterating); ++i) c.solving += StageSeconds(iterating[i]) / c.total;
  c.mesh = c.solving;
  for (size_t i = 0; i < sizeof(meshed) / sizeof(*meshed); ++i) c.mesh += StageSeconds(meshed[i]) / c.total;
  PetscCall(Terms_Private(&c));
  for (PetscInt a = 0; a < 3; ++a) {
    PetscCall(NeedsFindPrism(run, a, PETSC_FALSE, Strain_Private(&c, NULL), &c.layers[a], &c.along[a]));
    PetscCall(NeedsFindPrism(run, a, PETSC_TRUE, Strain_Private(&c, NULL), &c.rounds[a], &c.around[a]));
  }
  for (size_t i = 0; i < sizeof(parts) / sizeof(*parts); ++i) PetscCall(parts[i](&c));
  PetscCall(PetscFree2(c.terms, c.cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NeedsDestroy(Needs *needs)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < needs->num; ++i) cJSON_Delete(needs->rows[i].set);
  PetscCall(PetscFree(needs->rows));
  needs->num = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
