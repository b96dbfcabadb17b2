/* -check: what would be solved. */
#include "sceneimpl.h"

/* Where the facets of a boundary group are: a group of others shows here. */
static PetscErrorCode ViewGroup_Private(PetscInt group, Forest forest, PetscViewer viewer)
{
  const ForestTables *t     = ForestGetTables(forest);
  PetscReal           lo[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL}, X[3];

  PetscFunctionBegin;
  for (PetscInt v = 0; v < t->first[1]; ++v) {
    if (!(t->boundary[v] >> group & 1)) continue;
    PetscCall(SceneVertex(forest, v, X));
    for (PetscInt c = 0; c < t->dim; ++c) {
      lo[c] = PetscMin(lo[c], X[c]);
      hi[c] = PetscMax(hi[c], X[c]);
    }
  }
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  for (PetscInt c = 0; c < t->dim; ++c) {
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s%c = %.6g", c ? ", " : " [", 'x' + (int)c, (double)lo[c]));
    if (hi[c] > lo[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " .. %.6g", (double)hi[c]));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, "]"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewBoundary_Private(const BoundarySpec *b, Forest forest, PetscViewer viewer)
{
  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  boundary %s:", b->name));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  if (b->fix_normal) PetscCall(PetscViewerASCIIPrintf(viewer, " fix normal"));
  for (int c = 0; c < 3; ++c)
    if (b->fix[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " fix %c", 'x' + c));
  for (int c = 0; c < 3; ++c)
    if (b->displacement[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " u_%c = %s", 'x' + c, ExpressionText(b->displacement[c])));
  if (b->rotation)
    PetscCall(PetscViewerASCIIPrintf(viewer, " rotation about %c by %s degrees", 'x' + (int)b->rotation_axis, ExpressionText(b->rotation_angle)));
  if (b->pressure) PetscCall(PetscViewerASCIIPrintf(viewer, " pressure %s", ExpressionText(b->pressure)));
  if (b->volume) PetscCall(PetscViewerASCIIPrintf(viewer, " enclosed volume changes by %s, pressure found", ExpressionText(b->volume)));
  if (b->advance) PetscCall(PetscViewerASCIIPrintf(viewer, " advances by %s, pressure found", ExpressionText(b->advance)));
  for (int c = 0; c < 3; ++c)
    if (b->traction[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " traction_%c = %s", 'x' + c, ExpressionText(b->traction[c])));
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s", b->amplitude.num ? " (amplitude)" : ""));
  PetscCall(ViewGroup_Private(b->group, forest, viewer));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  PetscCall(PetscViewerASCIIPrintf(viewer, "\n"));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewContact_Private(const ContactEntry *c, Forest forest, PetscViewer viewer)
{
  char layer[64] = "";

  PetscFunctionBegin;
  if (c->spec.subdivide_auto)
    PetscCall(PetscStrncpy(layer, ", cells at both subdivided as the estimate asks", sizeof(layer)));
  else if (c->subdivide)
    PetscCall(PetscSNPrintf(layer, sizeof(layer), ", cells at both subdivided %dx", c->subdivide));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  contact %s: %s (nonmortar)", c->spec.name, c->spec.exchanged ? c->mortar : c->nonmortar));
  PetscCall(ViewGroup_Private(c->spec.nonmortar, forest, viewer));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  PetscCall(PetscViewerASCIIPrintf(viewer, " on %s", c->spec.exchanged ? c->nonmortar : c->mortar));
  PetscCall(ViewGroup_Private(c->spec.mortar, forest, viewer));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s%s%s%s\n", c->spec.full ? "" : ", linear faces", c->spec.node_to_segment ? ", node to segment" : "", layer,
                                   c->spec.exchanged ? ", roles exchanged: the other side of the scene carries the pressure" : ""));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewBody_Private(const BodySpec *b, PetscViewer viewer)
{
  const MaterialSpec *m = b->material;

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "  body %s: order %d", b->name, (int)b->order));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  for (PetscInt c = 0; c < 3 && b->order_along[c]; ++c)
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s%c: %d", c ? ", " : " (along ", (int)('x' + c), (int)b->order_along[c]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s, material %s (%s", b->order_along[0] ? ")" : "", m->name, m->law->name));
  if (!m->law->rigid)
    PetscCall(PetscViewerASCIIPrintf(viewer, ", mu = %.6g, kappa = %.6g, %s", (double)m->mu, (double)m->kappa,
                                     m->incompressible ? "incompressible"
                                     : m->mixed        ? "mixed"
                                                       : "displacement"));
  for (PetscInt f = 0; f < m->num_fibers; ++f) {
    const MaterialFiber *fiber = &m->fiber[f];
    if (fiber->straight)
      PetscCall(PetscViewerASCIIPrintf(viewer, ", fibres %s along (%.6g, %.6g, %.6g)", fiber->name, (double)fiber->direction[0], (double)fiber->direction[1],
                                       (double)fiber->direction[2]));
    else if (fiber->field[0])
      PetscCall(PetscViewerASCIIPrintf(viewer, ", fibres %s along field %s", fiber->name, fiber->field));
    else
      PetscCall(PetscViewerASCIIPrintf(viewer, ", fibres %s at %.6g degrees around %c", fiber->name, (double)fiber->angle, 'x' + m->frame.axis));
    if (fiber->compression) PetscCall(PetscViewerASCIIPrintf(viewer, ", in compression too"));
  }
  PetscCall(PetscViewerASCIIPrintf(viewer, ")"));
  for (int c = 0; c < 3; ++c) {
    if (b->motion[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " motion_%c = %s", 'x' + c, ExpressionText(b->motion[c])));
    if (b->force[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " force_%c = %s", 'x' + c, ExpressionText(b->force[c])));
  }
  for (int c = 0; c < 3; ++c) {
    if (b->load[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " load_%c = %s", 'x' + c, ExpressionText(b->load[c])));
    if (b->load_moment[c]) PetscCall(PetscViewerASCIIPrintf(viewer, " load_moment_%c = %s", 'x' + c, ExpressionText(b->load_moment[c])));
  }
  if (b->rotation_angle)
    PetscCall(PetscViewerASCIIPrintf(viewer, " rotation about %c by %s degrees", 'x' + (int)b->rotation_axis, ExpressionText(b->rotation_angle)));
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n", b->amplitude.num ? " (amplitude)" : ""));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many cells, and where: a wrong unit of length shows here. */
static PetscErrorCode ViewMesh_Private(const char *file, Forest forest, PetscViewer viewer)
{
  const ForestTables *t    = ForestGetTables(forest);
  const CoarseMesh   *mesh = ForestGetCoarse(forest);
  PetscReal           lo[3], hi[3];

  PetscFunctionBegin;
  ForestCoarseBox(mesh, lo, hi);
  PetscCall(PetscViewerASCIIPrintf(viewer, "  mesh %s: %" PetscInt_FMT " cells", file, t->num_leaves));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
  for (PetscInt c = 0; c < mesh->dim; ++c)
    PetscCall(PetscViewerASCIIPrintf(viewer, ", %c = %.6g .. %.6g%s", 'x' + (int)c, (double)lo[c], (double)hi[c], c == mesh->dim - 1 ? "\n" : ""));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneView(Scene s, Forest forest, PetscViewer viewer)
{
  static const char *const models[] = {"plane strain", "axisymmetric", "3d"};
  const SceneData         *d        = &s->data;

  PetscFunctionBegin;
  PetscCheck(s->setup, s->comm, PETSC_ERR_ORDER, "SceneView before SceneSetUp");
  PetscCall(PetscViewerASCIIPrintf(viewer, "scene %s: %s\n", d->file, d->title));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  model %s, %s kinematics\n", models[d->mechanics.model],
                                   d->mechanics.kinematics == KINEMATICS_SMALL ? "small" : "finite"));
  PetscCall(ViewMesh_Private(s->mesh_file, forest, viewer));
  for (PetscInt i = 0; i < s->num_bodies; ++i) PetscCall(ViewBody_Private(&d->bodies[i], viewer));
  for (PetscInt i = 0; i < s->num_boundaries; ++i) PetscCall(ViewBoundary_Private(&d->boundaries[i], forest, viewer));
  for (PetscInt i = 0; i < s->num_contacts; ++i) PetscCall(ViewContact_Private(&s->contact[i], forest, viewer));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  load t = 0 .. %.6g, first step %.6g, steps %.6g .. %.6g%s\n", (double)d->load.end, (double)d->load.step,
                                   (double)d->load.step_min, (double)d->load.step_max, d->load.control == LOAD_ARC_LENGTH ? ", by arc length" : ""));
  if (d->adapt.tolerance > 0)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  adaptation to a relative error of %.6g, at most %d passes and %d cells%s%s\n", (double)d->adapt.tolerance,
                                     (int)d->adapt.max_passes, (int)d->adapt.max_cells, d->adapt.anisotropic ? ", anisotropic" : "",
                                     d->adapt.strategy == ADAPT_H   ? ""
                                     : d->adapt.strategy == ADAPT_P ? ", by orders (p)"
                                                                    : ", by size and order (hp)"));
  else
    PetscCall(PetscViewerASCIIPrintf(viewer, "  no adaptation\n"));
  for (PetscInt i = 0; i < d->num_probes; ++i)
    PetscCall(PetscViewerASCIIPrintf(viewer, "  probe %s at (%.6g, %.6g, %.6g)%s%s\n", d->probes[i].name, (double)d->probes[i].X[0], (double)d->probes[i].X[1],
                                     (double)d->probes[i].X[2], d->probes[i].body[0] ? " of body " : "", d->probes[i].body));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  output %s\n", d->output.directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}
