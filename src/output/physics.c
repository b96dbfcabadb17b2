/* What a scene must share with the one that wrote a checkpoint, as text: one line each, so that a difference can be shown. */
#include "outputimpl.h"
#include <inttypes.h>

static PetscErrorCode Fibers_Private(const MaterialSpec *m, PetscInt num_cells, OutputText *text)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < m->num_fibers; ++i) {
    const MaterialFiber *f = &m->fiber[i];
    PetscCall(OutputTextPrint(text, ", fiber %s k1 %.15g k2 %.15g%s", f->name, (double)f->k1, (double)f->k2, f->compression ? " in compression too" : ""));
    if (f->straight)
      PetscCall(OutputTextPrint(text, " along (%.15g %.15g %.15g)", (double)f->direction[0], (double)f->direction[1], (double)f->direction[2]));
    else if (f->along)
      PetscCall(OutputTextPrint(text, " along field %s %016" PRIx64, f->field, HashBytes(0, f->along, (size_t)num_cells * sizeof(*f->along))));
    else
      PetscCall(OutputTextPrint(text, " at %.15g degrees, frame about %c through (%.15g %.15g %.15g)", (double)f->angle, 'x' + m->frame.axis,
                                (double)m->frame.point[0], (double)m->frame.point[1], (double)m->frame.point[2]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Material_Private(const MaterialSpec *m, PetscInt num_cells, OutputText *text)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "%s", m->law->name));
  if (!m->law->rigid) PetscCall(OutputTextPrint(text, ", volumetric %s, %s", VolumetricNames[m->volumetric], m->mixed ? "mixed" : "displacement"));
  for (const MaterialParameter *p = m->law->parameters; p && p->name; ++p) {
    const PetscReal value = m->parameter[p - m->law->parameters]; /* NaN: not given */
    if (!PetscIsNanReal(value)) PetscCall(OutputTextPrint(text, ", %s %.15g", p->name, (double)value));
  }
  PetscCall(Fibers_Private(m, num_cells, text));
  PetscCall(OutputTextPrint(text, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Side_Private(const CoarseMesh *mesh, const char *side, PetscInt group, OutputText *text)
{
  const uint64_t groups = CoarseMembers(mesh, group);
  const char    *before = side;

  PetscFunctionBegin;
  for (PetscInt g = 0; g < mesh->num_boundaries; ++g) {
    if (!(groups >> g & 1)) continue;
    PetscCall(OutputTextPrint(text, "%s %s", before, mesh->boundary_name[g]));
    before = " +";
  }
  PetscCall(OutputTextPrint(text, ", "));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pair_Private(const ContactSpec *c, const CoarseMesh *mesh, OutputText *text)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "contact.%s: ", c->name));
  PetscCall(Side_Private(mesh, "nonmortar", c->nonmortar, text));
  PetscCall(Side_Private(mesh, "mortar", c->mortar, text));
  PetscCall(OutputTextPrint(text, "order %s, multiplier %s, initial_gap %s, friction %s, ", c->full ? "full" : "1", c->standard ? "standard" : "dual",
                            c->adjust  ? "adjust"
                            : c->ramp  ? "ramp"
                            : c->close ? "close"
                                       : "keep",
                            c->friction ? ExpressionText(c->friction) : "0"));
  PetscCall(OutputTextPrint(text, "interference %s, penalty %.15g%s\n", c->interference ? ExpressionText(c->interference) : "0", (double)c->penalty,
                            c->node_to_segment       ? ", node_to_segment"
                            : c->law == CONTACT_TIED ? ", tied"
                                                     : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the steps so far of a path that may be computed again were judged by. */
static PetscErrorCode Repeat_Private(const AdaptSpec *a, OutputText *text)
{
  static const char *const strategy[] = {[ADAPT_H] = "h", [ADAPT_P] = "p", [ADAPT_HP] = "hp"};

  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "adapt.repeat: %s", a->repeat == REPEAT_PATH ? "path" : "step"));
  if (a->repeat == REPEAT_PATH) PetscCall(OutputTextPrint(text, ", tolerance %.15g, strategy %s", (double)a->tolerance, strategy[a->strategy]));
  PetscCall(OutputTextPrint(text, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What holds the group, and whether its pressure is found. What a support prescribes may go on otherwise; a state without it is out of balance. */
static PetscErrorCode Group_Private(const MechanicsSpec *m, PetscInt group, const char *name, OutputText *text)
{
  const BoundarySpec none = {.group = group}, *spec = &none;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->num_boundaries; ++b)
    if (m->boundaries[b].group == group) spec = &m->boundaries[b];
  PetscCall(OutputTextPrint(text, "boundary.%s: ", name));
  for (PetscInt c = 0; c < 3; ++c)
    if (spec->fix[c] || spec->displacement[c]) PetscCall(OutputTextPrint(text, "%c", 'x' + (int)c));
  PetscCall(OutputTextPrint(text, "%s%s%s\n",
                            spec->fix_normal         ? "normal"
                            : spec->rotation         ? "rotation"
                            : BoundarySupports(spec) ? ""
                                                     : "free",
                            spec->volume ? ", volume" : "", spec->advance ? ", advance" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What was refined before the first solve. */
static PetscErrorCode Refines_Private(const SceneData *scene, const CoarseMesh *mesh, OutputText *text)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "mesh.refine: %" PetscInt_FMT "\n", scene->mesh.refine));
  for (PetscInt i = 0; i < scene->num_refines; ++i) {
    const RefineSpec *r = &scene->refines[i];
    PetscCall(OutputTextPrint(text, "refine.%s: levels %" PetscInt_FMT ", ", r->name, r->levels));
    if (r->group >= 0) PetscCall(OutputTextPrint(text, "boundary %s, ", mesh->boundary_name[r->group]));
    if (r->radius >= 0)
      PetscCall(OutputTextPrint(text, "radius %.15g, x %.15g, y %.15g, z %.15g", (double)r->radius, (double)r->X[0], (double)r->X[1], (double)r->X[2]));
    PetscCall(OutputTextPrint(text, "\n"));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputPhysics(const SceneData *scene, const CoarseMesh *mesh, OutputText *text)
{
  const MechanicsSpec *m = &scene->mechanics;

  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "model: %s\nkinematics: %s\n", ModelNames[m->model], KinematicsNames[m->kinematics]));
  PetscCall(OutputTextPrint(text, "load.control: %s\n", scene->load.control == LOAD_TIME ? "time" : "arc_length"));
  PetscCall(Repeat_Private(&scene->adapt, text));
  PetscCall(Refines_Private(scene, mesh, text));
  for (PetscInt g = 0; g < mesh->num_boundaries - mesh->num_unions; ++g) PetscCall(Group_Private(m, g, mesh->boundary_name[g], text));
  for (PetscInt b = 0; b < m->num_bodies; ++b) {
    const PetscInt *along = m->bodies[b].order_along;
    PetscCall(OutputTextPrint(text, "body.%s: ", mesh->body_name[b]));
    if (along[0] || along[1] || along[2])
      PetscCall(OutputTextPrint(text, "order %" PetscInt_FMT ", along x, y, z %" PetscInt_FMT " %" PetscInt_FMT " %" PetscInt_FMT ", ", m->bodies[b].order,
                                along[0], along[1], along[2]));
    for (PetscInt c = 0; c < 3; ++c) {
      if (m->bodies[b].load[c]) PetscCall(OutputTextPrint(text, "load %c, ", 'x' + (int)c));
      if (m->bodies[b].load_moment[c]) PetscCall(OutputTextPrint(text, "load moment_%c, ", 'x' + (int)c));
    }
    PetscCall(Material_Private(m->bodies[b].material, mesh->num_cells, text));
  }
  for (PetscInt i = 0; i < scene->num_contacts; ++i)
    if (scene->contacts[i].part == 0) PetscCall(Pair_Private(&scene->contacts[i], mesh, text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Length of the item of a list "a, b, c" that begins here, in a line of so many characters. */
static size_t Item_Private(const char *item, size_t rest)
{
  const char *comma = strstr(item, ", ");

  return comma && comma < item + rest ? (size_t)(comma - item) : rest;
}

/* Where two lines that begin with the same key differ. */
static void Narrow_Private(const char *a, size_t m, const char *b, size_t n, char what[2][OUTPUT_DIFFERENCE])
{
  const size_t key = strcspn(a, ":");
  size_t       at  = key + 2; /* a list of items follows */

  while (at < m && at < n) {
    const size_t i = Item_Private(a + at, m - at), k = Item_Private(b + at, n - at);
    if (i != k || strncmp(a + at, b + at, i)) break;
    at += i + 2;
  }
  const size_t i = at < m ? Item_Private(a + at, m - at) : 0, k = at < n ? Item_Private(b + at, n - at) : 0;
  snprintf(what[0], OUTPUT_DIFFERENCE, "%.*s: %.*s", (int)key, a, (int)i, a + PetscMin(at, m));
  snprintf(what[1], OUTPUT_DIFFERENCE, "%.*s: %.*s", (int)key, b, (int)k, b + PetscMin(at, n));
}

PetscBool OutputFirstDifference(const char *a, const char *b, char what[2][OUTPUT_DIFFERENCE])
{
  while (*a || *b) {
    const size_t m = strcspn(a, "\n"), n = strcspn(b, "\n"), key = strcspn(a, ":");
    if (m != n || strncmp(a, b, m)) {
      if (m && key == strcspn(b, ":") && !strncmp(a, b, key))
        Narrow_Private(a, m, b, n, what);
      else {
        snprintf(what[0], OUTPUT_DIFFERENCE, "%.*s", (int)strcspn(a, ":\n"), a);
        snprintf(what[1], OUTPUT_DIFFERENCE, "%.*s", (int)strcspn(b, ":\n"), b);
      }
      return PETSC_TRUE;
    }
    a += m + (a[m] == '\n');
    b += n + (b[n] == '\n');
  }
  return PETSC_FALSE;
}
