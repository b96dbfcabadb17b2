/* Tree -> SceneData and the entries of the sections: everything that can be read and checked without the mesh. */
#include "sceneimpl.h"

#define LEAST_STEP 1e-8    /* of load.end: t tells times apart down to its round-off, which the smallest step by default (1/1024) is to stay above */
#define MOST_STEPS 1000000 /* the most that load.max_steps may be */

static const char *Stem_Private(const char *file, char stem[MORTISE_NAME])
{
  const char *base = strrchr(file, '/') ? strrchr(file, '/') + 1 : file, *dot = strrchr(base, '.');

  (void)snprintf(stem, MORTISE_NAME, "%.*s", (int)(dot ? dot - base : (long)strlen(base)), base);
  return stem;
}

/* Steps that t can tell apart, and that may reach the end (unless a displacement ends the run before). */
static PetscErrorCode CheckSteps_Private(const char *origin, const LoadSpec *load)
{
  PetscFunctionBegin;
  PetscCheckInput(load->step <= load->end, "%s: load.step is %g; allowed: up to load.end, which is %g", origin, (double)load->step, (double)load->end);
  PetscCheckInput(load->step >= LEAST_STEP * load->end, "%s: load.step is %g; allowed: %g of load.end and more, %g", origin, (double)load->step, LEAST_STEP,
                  (double)(LEAST_STEP * load->end));
  PetscCheckInput(load->step_min >= LEAST_STEP / 1024 * load->end, "%s: load.step_min is %g; allowed: %g and more, which load.end = %g can tell apart", origin,
                  (double)load->step_min, (double)(LEAST_STEP / 1024 * load->end), (double)load->end);
  PetscCheckInput(load->step_min <= load->step && load->step <= load->step_max, "%s: load.step is %g; it must lie between step_min %g and step_max %g", origin,
                  (double)load->step, (double)load->step_min, (double)load->step_max);
  PetscCheckInput(load->stop_displacement > 0 || load->end / load->step_max <= MOST_STEPS,
                  "%s: to load.end = %g more than %d steps of at most %g (load.step_max, by default load.step) lead; allowed: %g and more", origin,
                  (double)load->end, MOST_STEPS, (double)load->step_max, (double)load->end / MOST_STEPS);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keys that act with another one alone: refused where that says otherwise, unless it does so on the command line, where it is for one run. */
static PetscErrorCode CheckInert_Private(Scene s)
{
  const SceneNode *adapt = NodeFind(s->root, "adapt"), *output = NodeFind(s->root, "output"), *fields = NodeFind(output, "fields");
  const struct {
    const char *key, *with, *value;
    PetscBool   acts;
  } inert[] = {
      {"share", "anisotropic", "true", s->data.adapt.anisotropic},
      {"aspect", "anisotropic", "true", s->data.adapt.anisotropic},
      {"max_order", "strategy", "p or hp", (PetscBool)(s->data.adapt.strategy != ADAPT_H)},
  };
  static const char *const drawn[] = {"quantities", "divide", "segments"};

  PetscFunctionBegin;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(inert); ++i) {
    const SceneNode *key = NodeFind(adapt, inert[i].key), *with = NodeFind(adapt, inert[i].with);
    PetscCheckInput(!key || inert[i].acts || (with && with->line <= 0), "%s acts with adapt.%s: %s alone; set that, or take this away", NodeWhere(key),
                    inert[i].with, inert[i].value);
  }
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(drawn); ++i) {
    const SceneNode *key = NodeFind(output, drawn[i]);
    if (key && !s->data.output.fields && fields->line > 0)
      PetscCall(PetscPrintf(s->comm, "note: %s does nothing, for output.fields is false\n", NodeWhere(key)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadGeneral_Private(Scene s)
{
  SceneData *d = &s->data;
  char       stem[MORTISE_NAME];

  PetscFunctionBegin;
  PetscCall(OptionsRead("", s->root, 3, s));
  d->mesh.dim = d->mechanics.model == MODEL_3D ? 3 : 2;
  if (d->units.text[0]) PetscCall(SceneReadUnits(NodeWhere(NodeFind(s->root, "units")), d->units.text, &d->units));
  if (!d->title[0]) PetscCall(PetscStrncpy(d->title, Stem_Private(d->file, stem), sizeof(d->title)));
  if (!d->output.directory[0]) PetscCall(PetscSNPrintf(d->output.directory, sizeof(d->output.directory), "out/%s", Stem_Private(d->file, stem)));
  if (d->load.step == 0) d->load.step = d->load.end / 10;
  if (d->load.step_max == 0) d->load.step_max = d->load.step;
  if (d->load.step_min == 0) d->load.step_min = d->load.step / 1024;
  PetscCall(CheckSteps_Private(s->root->origin, &d->load));
  PetscCheckInput(d->adapt.repeat == REPEAT_STEP || d->adapt.coarsen == 0,
                  "%s is %g, but with adapt.repeat: path one mesh is for all load steps and cells are refined only; allowed with it: 0",
                  NodeWhere(NodeFind(NodeFind(s->root, "adapt"), "coarsen")), (double)d->adapt.coarsen);
  PetscCheckInput(d->adapt.repeat == REPEAT_STEP || d->adapt.history == HISTORY_CARRIED,
                  "%s cannot act with adapt.repeat: path, which carries nothing over; allowed with it: carried",
                  NodeWhere(NodeFind(NodeFind(s->root, "adapt"), "history")));
  if (NodeFind(s->root, "adapt") && !NodeFind(NodeFind(s->root, "adapt"), "tolerance"))
    PetscCall(PetscPrintf(s->comm, "note: %s has no tolerance: nothing is adapted, and its other keys do nothing\n", NodeWhere(NodeFind(s->root, "adapt"))));
  PetscCall(CheckInert_Private(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- materials -------------------------------------------------------------------------------------------------------------------- */

static PetscErrorCode Law_Private(const SceneNode *node, const char *name, const MaterialLaw **law)
{
  char list[512] = "";

  PetscFunctionBegin;
  *law = MaterialLawFind(name);
  if (*law) PetscFunctionReturn(PETSC_SUCCESS);
  for (const MaterialLaw *row = MaterialLaws; row->name; ++row) {
    if (list[0]) TextAppend(sizeof(list), list, ", ");
    TextAppend(sizeof(list), list, row->name);
  }
  PetscCall(ErrorInput("%s is '%.64s', which is no law; allowed: %s", NodeWhere(node), name, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Laws first: the parameters of a law misspelt would be told before its name. */
static PetscErrorCode CheckLaws_Private(const SceneNode *root)
{
  const SceneNode *materials = NodeFind(root, "material");

  PetscFunctionBegin;
  for (SceneNode *node = materials && materials->kind == NODE_MAP ? materials->first : NULL; node; node = node->next) {
    const MaterialLaw *law;
    const SceneNode   *name = node->kind == NODE_MAP ? NodeFind(node, "law") : NULL;
    if (name && name->kind == NODE_SCALAR && !NodeIsEmpty(name)) PetscCall(Law_Private(name, name->text, &law));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A number, or infinity as YAML (.inf) and others (inf) write it. */
static PetscBool Parameter_Private(const char *text, PetscReal *value)
{
  PetscBool same;

  if (PetscStrcasecmp(text + (text[0] == '.'), "inf", &same) == PETSC_SUCCESS && same) {
    *value = INFINITY;
    return PETSC_TRUE;
  }
  return OptionParseReal(text, value);
}

/* One family: a direction, an angle, or a field of the mesh. */
static PetscErrorCode ReadFiber_Private(Scene s, const SceneNode *node, MaterialFiber *fiber)
{
  const SceneNode *direction = NodeFind(node, "direction"), *angle = NodeFind(node, "angle"), *field = NodeFind(node, "field");
  PetscReal        length = 0;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(fiber->name, node->key, MORTISE_NAME));
  PetscCall(OptionsRead("material.<name>.fiber", node, 3, fiber));
  fiber->straight = direction ? PETSC_TRUE : PETSC_FALSE;
  PetscCheckInput(!direction || !angle, "%s has an angle and a direction; allowed: one of them", NodeWhere(node));
  PetscCheckInput(!field || (!direction && !angle), "%s has a field and %s; allowed: one of them", NodeWhere(node), angle ? "an angle" : "a direction");
  PetscCheckInput(direction || angle || field, "%s needs an angle, or a direction {x, y, z}, or a field of the mesh", NodeWhere(node));
  for (int c = 0; c < 3; ++c) length += PetscSqr(fiber->direction[c]);
  length = PetscSqrtReal(length);
  PetscCheckInput(!direction || length > 0, "%s is zero; it must point somewhere", NodeWhere(direction));
  if (direction && PetscAbsReal(length - 1) > 1e-6)
    PetscCall(PetscPrintf(s->comm, "note: %s has length %.6g; made a unit vector\n", NodeWhere(direction), (double)length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Families of fibres and the frame of their angles. */
static PetscErrorCode ReadFibers_Private(Scene s, const SceneNode *node, MaterialEntry *m)
{
  const SceneNode *fibers = NodeFind(node, "fiber"), *frame = NodeFind(node, "frame"), *axis = NodeFind(frame, "axis");
  const Model      model = s->data.mechanics.model;
  const int        only  = model == MODEL_AXISYMMETRIC ? 1 : 2; /* axis of two-dimensional models */
  PetscBool        turns = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCheckInput(!fibers || m->spec.law->fibers, "%s: law %s has no fibres; hgo has", NodeWhere(fibers), m->law);
  PetscCheckInput(NodeCount(fibers) <= MATERIAL_MAX_FIBERS, "%s has %d families; allowed: at most %d", NodeWhere(fibers), (int)NodeCount(fibers),
                  MATERIAL_MAX_FIBERS);
  for (const SceneNode *child = fibers ? fibers->first : NULL; child; child = child->next) {
    PetscCall(ReadFiber_Private(s, child, &m->spec.fiber[m->spec.num_fibers++]));
    if (NodeFind(child, "angle")) turns = PETSC_TRUE;
  }
  PetscCheckInput(!frame || turns, "%s: no fibre of this material has an angle, so that nothing refers to a frame", NodeWhere(frame));
  PetscCheckInput(!axis || s->data.mesh.dim == 3 || m->spec.frame.axis == only, "%s is %s; allowed in this model: %c", NodeWhere(axis), axis->text, 'x' + only);
  PetscCheckInput(model != MODEL_AXISYMMETRIC || !NodeFind(frame, "point"), "%s: the axis of an axisymmetric model is x = 0",
                  NodeWhere(NodeFind(frame, "point")));
  if (!axis) m->spec.frame.axis = only;
  m->spec.frame.meridian = model == MODEL_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadMaterial_Private(Scene s, SceneNode *node, MaterialEntry *m)
{
  const char *names[64];
  PetscReal   values[64];
  PetscInt    num   = 0;
  PetscBool   small = s->data.mechanics.kinematics == KINEMATICS_SMALL ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  m->node = node;
  PetscCall(PetscStrncpy(m->spec.name, node->key, MORTISE_NAME));
  PetscCall(OptionsRead("material", node, s->data.mesh.dim, m));
  PetscCall(Law_Private(NodeFind(node, "law"), m->law, &m->spec.law));
  m->spec.volumetric  = (Volumetric)m->volumetric;
  m->spec.formulation = (Formulation)m->formulation;
  for (SceneNode *child = node->first; child; child = child->next) {
    if (!OptionKnowsParameter(child->key)) continue;
    PetscCheckInput(Parameter_Private(child->text, &values[num]), "%s is '%s'; it must be a number", NodeWhere(child), child->text);
    PetscCheckInput(num < 63, "%s has too many parameters", NodeWhere(node));
    PetscCall(MaterialCheckRange(m->spec.law, child->key, values[num], NodeWhere(child), child->text));
    names[num++] = child->key;
  }
  PetscCheckInput(!(m->spec.law->rigid || m->spec.law->small || m->spec.law->whole) || !NodeFind(node, "volumetric"),
                  "%s: law %s has no volumetric energy to choose", NodeWhere(NodeFind(node, "volumetric")), m->law);
  PetscCheckInput(!m->spec.law->rigid || !NodeFind(node, "formulation"), "%s: a rigid body is not solved for and has no formulation; take it away",
                  NodeWhere(NodeFind(node, "formulation")));
  PetscCheckInput(!m->spec.law->small || small, "%s: law %s is for small strains; set kinematics: small or take another law (neo_hookean)",
                  NodeWhere(NodeFind(node, "law")), m->law);
  PetscCheckInput(m->spec.law->small || m->spec.law->rigid || !small, "%s: kinematics: small needs law: linear, not %s", NodeWhere(NodeFind(node, "law")),
                  m->law);
  PetscCall(ReadFibers_Private(s, node, m));
  PetscCall(MaterialSetUp(&m->spec, num, names, values));
  if (MaterialSoftens(&m->spec))
    PetscCall(WarningAdd(s->comm, "the yield stress of material %s falls with plastic strain: zones of flow shrink to a cell, results depend on the mesh",
                         m->spec.name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- bodies, boundaries, contacts, probes ------------------------------------------------------------------------------------------- */

/* The body's order is the highest of its directions; order_along only where they differ. */
static PetscErrorCode ReadOrders_Private(Scene s, const SceneNode *orders, BodyEntry *b)
{
  const PetscInt dim    = s->data.mesh.dim;
  PetscInt      *along  = b->spec.order_along;
  PetscBool      differ = PETSC_FALSE;

  PetscFunctionBegin;
  if (!orders || orders->kind != NODE_MAP) PetscFunctionReturn(PETSC_SUCCESS);
  b->spec.order = 0;
  for (PetscInt c = 0; c < dim; ++c) {
    if (!along[c]) along[c] = s->order;
    if (along[c] != along[0]) differ = PETSC_TRUE;
    b->spec.order = PetscMax(b->spec.order, along[c]);
  }
  for (PetscInt c = 0; c < 3 && !differ; ++c) along[c] = 0;
  PetscCheckInput(!differ || !b->spec.material->mixed,
                  "%s: orders per direction and the mixed formulation of material %s do not go together; allowed: one order, or formulation: displacement",
                  NodeWhere(orders), b->material);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets of full order have the same order in both directions. */
static PetscErrorCode CheckFull_Private(Scene s)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_contacts; ++i) {
    for (PetscInt b = 0; b < s->num_bodies; ++b) {
      PetscCheckInput(!s->contact[i].spec.full || !s->body[b].spec.order_along[0],
                      "%s: contact faces of full order and orders per direction (body '%s') do not go together; allowed here: 1",
                      NodeWhere(NodeFind(s->contact[i].node, "order")), s->body[b].spec.name);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a rotation needs and where it may be, of a boundary or a rigid body. */
static PetscErrorCode CheckRotation_Private(Scene s, const SceneNode *rotation, Expression angle, PetscInt axis)
{
  PetscFunctionBegin;
  PetscCheckInput(angle, "%s.angle must be given, in degrees", NodeWhere(rotation));
  PetscCheckInput(s->data.mesh.dim == 3 || axis == 2, "%s: a two-dimensional model turns about z only", NodeWhere(rotation));
  PetscCheckInput(s->data.mechanics.model != MODEL_AXISYMMETRIC, "%s: an axisymmetric model cannot turn", NodeWhere(rotation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body turns as a whole, so that what turns it is no function of place. */
static PetscErrorCode ReadRotation_Private(Scene s, const SceneNode *rotation, BodyEntry *b)
{
  const Expression angle = b->spec.rotation_angle;

  PetscFunctionBegin;
  if (!rotation) PetscFunctionReturn(PETSC_SUCCESS);
  b->spec.rotation_axis = b->rotation_axis;
  PetscCall(CheckRotation_Private(s, rotation, angle, b->rotation_axis));
  PetscCheckInput(!ExpressionUsesPlace(angle), "%s is \"%s\": one number for the whole body, so an expression in t alone",
                  NodeWhere(NodeFind(rotation, "angle")), ExpressionText(angle));
  PetscCall(SceneCheckPath(s, rotation, angle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An amplitude multiplies what stands beside it. */
static PetscErrorCode CheckAmplitude_Private(const SceneNode *node, size_t num, const char *const keys[])
{
  const SceneNode *amplitude = NodeFind(node, "amplitude");
  char             list[256] = "";

  PetscFunctionBegin;
  for (size_t i = 0; i < num && amplitude; ++i) {
    if (NodeFind(node, keys[i])) PetscFunctionReturn(PETSC_SUCCESS);
    TextAppend(sizeof(list), list, i ? ", " : "");
    TextAppend(sizeof(list), list, keys[i]);
  }
  PetscCheckInput(!amplitude, "%s has nothing to multiply; it needs one of %s", NodeWhere(amplitude), list);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBody_Private(Scene s, SceneNode *node, BodyEntry *b)
{
  static const char *const driven[] = {"motion", "load", "force"};
  const char              *names[64];
  PetscInt                 num = s->data.num_materials;
  PetscBool                rigid;

  PetscFunctionBegin;
  b->node       = node;
  b->spec.order = s->order;
  PetscCall(PetscStrncpy(b->spec.name, node->key, MORTISE_NAME));
  PetscCall(OptionsRead("body", node, s->data.mesh.dim, b));
  PetscCall(CheckAmplitude_Private(node, PETSC_STATIC_ARRAY_LENGTH(driven), driven));
  for (PetscInt i = 0; i < num; ++i) {
    if (i < 64) names[i] = s->material[i].spec.name;
    if (strcmp(s->material[i].spec.name, b->material)) continue;
    s->material[i].used = PETSC_TRUE;
    b->spec.material    = &s->data.materials[i];
  }
  PetscCheckInput(b->spec.material, "%s is '%s', which is not under material%s%s", NodeWhere(NodeFind(node, "material")), b->material,
                  num ? "; the nearest name is " : "", NameNearest(b->material, PetscMin(num, 64), names));
  PetscCall(ReadOrders_Private(s, NodeFind(node, "order"), b));
  rigid = b->spec.material->law->rigid;
  PetscCheckInput(rigid || !NodeFind(node, "motion"), "%s: only a rigid body moves as told, and material %s is %s; prescribe a boundary instead",
                  NodeWhere(NodeFind(node, "motion")), b->material, b->spec.material->law->name);
  PetscCheckInput(rigid || !NodeFind(node, "moment_about"),
                  "%s: moments on a body are told of rigid ones, and material %s is %s; set moment_about of a boundary or a pair",
                  NodeWhere(NodeFind(node, "moment_about")), b->material, b->spec.material->law->name);
  PetscCall(SceneFindPoint(s, node, b->moment_about, b->spec.about));
  for (int c = 0; c < 3; ++c) {
    PetscCheckInput(!b->spec.motion[c] || !ExpressionUsesPlace(b->spec.motion[c]),
                    "%s.%c is \"%s\": one translation for the whole body, so an expression in t alone", NodeWhere(NodeFind(node, "motion")), 'x' + c,
                    ExpressionText(b->spec.motion[c]));
    PetscCall(SceneCheckPath(s, NodeFind(node, "motion"), b->spec.motion[c]));
  }
  PetscCall(ReadRotation_Private(s, NodeFind(NodeFind(node, "motion"), "rotation"), b));
  b->spec.amplitude.endless = (PetscBool)(s->data.load.control == LOAD_ARC_LENGTH);
  PetscCheckInput(!rigid || !NodeFind(node, "force"), "%s: the cells of a rigid body are not solved for and take no force per volume; give it a load",
                  NodeWhere(NodeFind(node, "force")));
  PetscCall(SceneCheckLoad(s, node, &b->spec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBoundary_Private(Scene s, SceneNode *node, BoundaryEntry *b)
{
  static const char *const driven[] = {"displacement", "rotation", "pressure", "volume", "advance", "traction"};
  const SceneNode         *rotation = NodeFind(node, "rotation");
  PetscBool                any      = PETSC_FALSE;

  PetscFunctionBegin;
  b->node       = node;
  b->spec.group = -1;
  PetscCall(PetscStrncpy(b->spec.name, node->key, MORTISE_NAME));
  PetscCall(OptionsRead("boundary", node, s->data.mesh.dim, b));
  PetscCall(CheckAmplitude_Private(node, PETSC_STATIC_ARRAY_LENGTH(driven), driven));
  if (rotation) PetscCall(CheckRotation_Private(s, rotation, b->spec.rotation_angle, b->rotation_axis));
  b->spec.rotation      = rotation ? PETSC_TRUE : PETSC_FALSE;
  b->spec.rotation_axis = b->rotation_axis;
  for (int c = 0; c < 3; ++c) {
    PetscCheckInput(!b->spec.displacement[c] || !b->spec.fix[c], "%s: %c is both fixed and displaced", NodeWhere(node), 'x' + c);
    PetscCheckInput(!rotation || !b->spec.fix[c], "%s prescribes all displacements; take fix away (a displacement is added to the rotation)",
                    NodeWhere(rotation));
    PetscCheckInput(!b->spec.fix_normal || !b->spec.displacement[c], "%s: fix: normal and displacement cannot be combined", NodeWhere(node));
    if (b->spec.displacement[c] || b->spec.fix[c] || b->spec.traction[c]) any = PETSC_TRUE;
  }
  PetscCheckInput(!rotation || !b->spec.fix_normal, "%s prescribes all displacements; take fix away (a displacement is added to the rotation)",
                  NodeWhere(rotation));
  PetscCheckInput(any || rotation || b->spec.fix_normal || BoundaryHasPressure(&b->spec),
                  "%s prescribes nothing; it needs one of displacement, fix, rotation, pressure, volume, advance, traction", NodeWhere(node));
  PetscCheckInput(BoundarySupports(&b->spec) || !NodeFind(node, "moment_about"),
                  "%s: this boundary holds nothing, so there is no moment; it needs one of displacement, fix, rotation",
                  NodeWhere(NodeFind(node, "moment_about")));
  PetscCall(SceneFindPoint(s, node, b->moment_about, b->spec.about));
  PetscCall(SceneCheckLoaded(s, node, &b->spec));
  PetscCall(SceneCheckControl(s, node, "volume", b->spec.volume, &b->spec));
  PetscCall(SceneCheckControl(s, node, "advance", b->spec.advance, &b->spec));
  for (int c = 0; c < 3; ++c) PetscCall(SceneCheckPath(s, NodeFind(node, "displacement"), b->spec.displacement[c]));
  PetscCall(SceneCheckPath(s, rotation, b->spec.rotation_angle));
  b->spec.amplitude.endless = (PetscBool)(s->data.load.control == LOAD_ARC_LENGTH);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is left to the program: faces of the order of their cells, unless the scene asks for what only linear ones can do. */
static PetscBool FacesAreFull_Private(const struct _p_Scene *s, const ContactEntry *c)
{
  if (c->order != 2) return c->order == 1 ? PETSC_TRUE : PETSC_FALSE;
  if (c->subdivide || c->spec.node_to_segment) return PETSC_FALSE;
  for (PetscInt b = 0; b < s->num_bodies; ++b) {
    if (s->body[b].spec.order_along[0]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Overlaps that change with t. */
static PetscErrorCode CheckOverlap_Private(Scene s, const SceneNode *node, const ContactEntry *c)
{
  const SceneNode *interference = NodeFind(node, "interference");
  const PetscBool  path         = (PetscBool)(s->data.load.control == LOAD_ARC_LENGTH);

  PetscFunctionBegin;
  PetscCheckInput(!interference || !ExpressionUsesPlace(c->spec.interference), "%s is \"%s\": one overlap for the whole pair, so an expression in t alone",
                  NodeWhere(interference), ExpressionText(c->spec.interference));
  PetscCheckInput(!interference || !path || !ExpressionUsesTime(c->spec.interference),
                  "%s is \"%s\", but with load.control: arc_length the factor of the loads is found, and no overlap may change with it; allowed here: a number",
                  NodeWhere(interference), ExpressionText(c->spec.interference));
  PetscCheckInput(
      !c->spec.ramp || !path,
      "%s is ramp, but with load.control: arc_length the factor of the loads is found, and no overlap may change with it; allowed here: keep|adjust",
      NodeWhere(NodeFind(node, "initial_gap")));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Never negative, as far as its values at SAMPLES times from start to end tell; later ones are refused where they are met. zero: it is the number 0. */
#define SAMPLES 100
static PetscErrorCode CheckCoefficient_Private(const SceneData *d, const SceneNode *given, Expression e, PetscBool *zero)
{
  const PetscReal origin[3] = {0, 0, 0};
  PetscReal       value;

  PetscFunctionBegin;
  PetscCheckInput(!ExpressionUsesPlace(e), "%s is \"%s\": one coefficient for the whole pair, so an expression in t alone", NodeWhere(given),
                  ExpressionText(e));
  for (PetscInt i = 0; i <= (ExpressionUsesTime(e) ? SAMPLES : 0); ++i) {
    const PetscReal t = d->load.end * (PetscReal)i / SAMPLES;
    PetscCall(ExpressionEvaluate(e, origin, t, &value));
    PetscCheckInput(value >= 0 || ExpressionUsesTime(e), "%s is %s; allowed: " CONTACT_FRICTION, NodeWhere(given), ExpressionText(e));
    PetscCheckInput(value >= 0, "%s is %s, which is %g at t = %g; allowed: " CONTACT_FRICTION, NodeWhere(given), ExpressionText(e), (double)value, (double)t);
  }
  *zero = (PetscBool)(!ExpressionUsesTime(e) && value == 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where there is friction, it is the pair's law. */
static PetscErrorCode CheckFriction_Private(Scene s, const SceneNode *node, ContactEntry *c)
{
  const SceneData *d     = &s->data;
  const SceneNode *given = NodeFind(node, "friction");
  const char      *value = ExpressionText(c->spec.friction);
  PetscBool        zero;

  PetscFunctionBegin;
  PetscCall(CheckCoefficient_Private(d, given, c->spec.friction, &zero));
  if (zero) {
    PetscCheckInput(c->spec.law != CONTACT_COULOMB, "%s: law: coulomb needs a coefficient of friction, a number above 0; friction is 0", NodeWhere(node));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCheckInput(c->spec.law != CONTACT_PENALTY, "%s is %s: law: penalty has no friction; allowed here: 0, or take the law away", NodeWhere(given), value);
  PetscCheckInput(c->spec.law == CONTACT_COULOMB || !NodeFind(node, "law"),
                  "%s is %s, but the law of this pair is frictionless; allowed here: 0, or take the law away", NodeWhere(given), value);
  PetscCheckInput(!c->spec.node_to_segment, "%s is %s: node-to-segment contact has no friction; allowed here: 0", NodeWhere(given), value);
  PetscCheckInput(d->load.control == LOAD_TIME, "%s is %s: friction needs load.control: time; allowed here: 0", NodeWhere(given), value);
  c->spec.law = CONTACT_COULOMB;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A tied pair is one by its kind, and has nothing of what contact may have besides. */
static PetscErrorCode CheckTied_Private(Scene s, const SceneNode *node, ContactEntry *c)
{
  static const char *const Foreign[] = {"law", "penalty", "friction", "interference", "node_to_segment", "see_through", "stabilise", "surface"};

  PetscFunctionBegin;
  if (c->kind == 0) {
    PetscCheckInput(c->spec.law != CONTACT_TIED, "%s is tied, but the pair is not; set kind: tied instead", NodeWhere(NodeFind(node, "law")));
    PetscCheckInput(c->initial_gap != 3, "%s is close, but that is for tied pairs (kind: tied); allowed here: keep|adjust|ramp",
                    NodeWhere(NodeFind(node, "initial_gap")));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (size_t k = 0; k < sizeof(Foreign) / sizeof(Foreign[0]); ++k) {
    const SceneNode *given = NodeFind(node, Foreign[k]);
    PetscCheckInput(!given, "%s does not go with kind: tied, whose sides neither part nor slide; take it away", NodeWhere(given));
  }
  PetscCheckInput(c->initial_gap == 0 || c->initial_gap == 3, "%s is %s, but the pair is tied; allowed here: keep|close",
                  NodeWhere(NodeFind(node, "initial_gap")), c->initial_gap == 1 ? "adjust" : "ramp");
  c->spec.law   = CONTACT_TIED;
  c->spec.close = c->initial_gap == 3 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two sides, or one surface that stands for both. */
static PetscErrorCode ReadSides_Private(Scene s, const SceneNode *node, ContactEntry *c)
{
  const SceneNode *surface = NodeFind(node, "surface");

  PetscFunctionBegin;
  if (!c->surface[0]) {
    PetscCheckInput(c->nonmortar[0] && c->mortar[0], "%s.%s must be given: a pair has two sides, nonmortar and mortar, or one surface that may meet itself",
                    NodeWhere(node), c->nonmortar[0] ? "mortar" : "nonmortar");
    PetscCheckInput(strcmp(c->nonmortar, c->mortar), "%s: both sides are '%s'; a surface that may meet itself is given by one name, surface: %s",
                    NodeWhere(node), c->mortar, c->mortar);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCheckInput(!c->nonmortar[0] && !c->mortar[0], "%s is '%s', but %s is given, too; a pair has two sides, nonmortar and mortar, or one surface",
                  NodeWhere(surface), c->surface, c->nonmortar[0] ? "nonmortar" : "mortar");
  PetscCheckInput(!NodeFind(node, "roles"), "%s is '%s': which facets of one surface carry the pressure is chosen; take roles away", NodeWhere(surface),
                  c->surface);
  PetscCheckInput(s->data.mechanics.kinematics == KINEMATICS_FINITE, "%s is '%s': a surface that may meet itself needs kinematics: finite", NodeWhere(surface),
                  c->surface);
  PetscCheckInput(c->initial_gap == 0 && !c->spec.interference,
                  "%s is '%s': of a surface that may meet itself gaps are those of the mesh; take initial_gap and interference away", NodeWhere(surface),
                  c->surface);
  c->spec.self = PETSC_TRUE;
  PetscCall(PetscStrncpy(c->nonmortar, c->surface, sizeof(c->nonmortar)));
  PetscCall(PetscStrncpy(c->mortar, c->surface, sizeof(c->mortar)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadContact_Private(Scene s, SceneNode *node, ContactEntry *c)
{
  const SceneNode *stiffness = NodeFind(node, "penalty");

  PetscFunctionBegin;
  c->node = node;
  PetscCall(PetscStrncpy(c->spec.name, node->key, MORTISE_NAME));
  PetscCall(OptionsRead("contact", node, s->data.mesh.dim, c));
  c->spec.full           = FacesAreFull_Private(s, c);
  c->spec.subdivide_auto = c->subdivide == SUBDIVIDE_AUTO ? PETSC_TRUE : PETSC_FALSE;
  c->spec.adjust         = c->initial_gap == 1 ? PETSC_TRUE : PETSC_FALSE;
  c->spec.ramp           = c->initial_gap == 2 ? PETSC_TRUE : PETSC_FALSE;
  c->spec.standard       = c->multiplier == 1 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(CheckTied_Private(s, node, c));
  PetscCheckInput(c->spec.law != CONTACT_PENALTY || stiffness,
                  "%s.penalty must be given: with law: penalty it is the stiffness of the contact, pressure per overlap, a number above 0", NodeWhere(node));
  PetscCheckInput(c->spec.law == CONTACT_PENALTY || !stiffness,
                  "%s is the stiffness of law: penalty, but the law of this pair is frictionless, without overlaps and so without a stiffness; take "
                  "penalty away, or set law: penalty",
                  NodeWhere(stiffness));
  PetscCall(CheckFriction_Private(s, node, c));
  PetscCall(SceneFindPoint(s, node, c->moment_about, c->spec.about));
  PetscCall(CheckOverlap_Private(s, node, c));
  PetscCheckInput(!strchr(node->key, '/'), "%s: the name of a pair has no '/' in it", NodeWhere(node));
  PetscCall(ReadSides_Private(s, node, c));
  for (PetscInt i = 0; &s->contact[i] < c; ++i) {
    const ContactEntry *e    = &s->contact[i];
    const PetscBool     same = (PetscBool)(!strcmp(c->nonmortar, e->nonmortar) && !strcmp(c->mortar, e->mortar));
    const PetscBool     swap = (PetscBool)(!strcmp(c->nonmortar, e->mortar) && !strcmp(c->mortar, e->nonmortar));
    PetscCheckInput(!same && !swap, "%s: '%s' and '%s' are the sides of pair '%s' already%s", NodeWhere(node), c->nonmortar, c->mortar, e->spec.name,
                    swap ? ", the other way round" : "");
  }
  PetscCheckInput(s->data.mesh.dim == 2 || !c->spec.node_to_segment,
                  "%s: node-to-segment contact is for comparison in two dimensions only; allowed here: false", NodeWhere(NodeFind(node, "node_to_segment")));
  PetscCheckInput(!c->spec.full || !c->spec.subdivide_auto, "%s is auto, but faces of full order need no finer layer; allowed here: 0|1|2|3|4|5|6|7|8",
                  NodeWhere(NodeFind(node, "subdivide")));
  PetscCheckInput(!c->spec.full || !c->spec.node_to_segment, "%s: faces of full order and node_to_segment do not go together; allowed here: 1",
                  NodeWhere(NodeFind(node, "order")));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadProbe_Private(Scene s, SceneNode *node, ProbeEntry *p)
{
  PetscFunctionBegin;
  p->node = node;
  PetscCall(PetscStrncpy(p->spec.name, node->key, MORTISE_NAME));
  PetscCall(OptionsRead("probe", node, s->data.mesh.dim, p));
  PetscCheckInput(NodeCount(node), "%s needs coordinates x, y%s", NodeWhere(node), s->data.mesh.dim == 3 ? ", z" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadRefine_Private(Scene s, SceneNode *node, RefineEntry *r)
{
  const PetscBool place = NodeFind(node, "x") || NodeFind(node, "y") || NodeFind(node, "z") ? PETSC_TRUE : PETSC_FALSE;

  PetscFunctionBegin;
  r->node       = node;
  r->spec.group = -1;
  PetscCall(PetscStrncpy(r->spec.name, node->key, MORTISE_NAME));
  PetscCall(OptionsRead("refine", node, s->data.mesh.dim, r));
  PetscCheckInput(place || r->boundary[0], "%s needs a boundary, a point x, y%s, or both", NodeWhere(node), s->data.mesh.dim == 3 ? ", z" : "");
  PetscCheckInput(place || !NodeFind(node, "radius"), "%s: a radius needs a point x, y%s", NodeWhere(NodeFind(node, "radius")),
                  s->data.mesh.dim == 3 ? ", z" : "");
  if (!place) r->spec.radius = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocate an entry per child of a section and read each. */
#define READ_SECTION(s, section, num, array, reader)                                                                                                           \
  do {                                                                                                                                                         \
    const SceneNode *map_ = NodeFind((s)->root, section);                                                                                                      \
    PetscInt         i_   = 0;                                                                                                                                 \
    (num)                 = NodeCount(map_);                                                                                                                   \
    PetscCall(PetscCalloc1(num, &(array)));                                                                                                                    \
    for (SceneNode *node_ = map_ ? map_->first : NULL; node_; node_ = node_->next) PetscCall(reader(s, node_, &(array)[i_++]));                                \
  } while (0)

PetscErrorCode SceneRead(Scene s, int argc, char **argv)
{
  SceneData *d = &s->data;

  PetscFunctionBegin;
  for (int pass = 0; pass < 2; ++pass) { /* the file alone, then with the command line */
    if (pass) PetscCall(OptionsOverride(s->root, argc, argv));
    PetscCall(CheckLaws_Private(s->root));
    PetscCall(OptionsCheckTree(s->root));
  }
  PetscCall(ReadGeneral_Private(s));
  READ_SECTION(s, "material", d->num_materials, s->material, ReadMaterial_Private);
  PetscCall(PetscMalloc1(d->num_materials, &d->materials));
  for (PetscInt i = 0; i < d->num_materials; ++i) d->materials[i] = s->material[i].spec;
  READ_SECTION(s, "point", s->num_points, s->point, SceneReadPoint);
  READ_SECTION(s, "body", s->num_bodies, s->body, ReadBody_Private);
  READ_SECTION(s, "boundary", s->num_boundaries, s->boundary, ReadBoundary_Private);
  READ_SECTION(s, "contact", s->num_contacts, s->contact, ReadContact_Private);
  d->num_contacts = s->num_contacts;
  PetscCall(CheckFull_Private(s));
  READ_SECTION(s, "probe", d->num_probes, s->probe, ReadProbe_Private);
  PetscCall(PetscMalloc1(d->num_probes, &d->probes));
  for (PetscInt i = 0; i < d->num_probes; ++i) d->probes[i] = s->probe[i].spec;
  READ_SECTION(s, "refine", d->num_refines, s->refine, ReadRefine_Private);
  PetscCheckInput(s->num_bodies, "%s: there is no body; each physical group of the mesh needs a line under body: name: {material: ...}", s->root->origin);
  for (PetscInt i = 0; i < d->num_materials; ++i) PetscCheckInput(s->material[i].used, "%s is used by no body", NodeWhere(s->material[i].node));
  for (PetscInt i = 0; i < s->num_points; ++i)
    if (!s->point[i].used) PetscCall(PetscPrintf(s->comm, "note: %s does nothing, for no moment_about names it\n", NodeWhere(s->point[i].node)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
