/* The scene's life: find and read the file, set up against the mesh, report, destroy. */
#include "sceneimpl.h"
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

#define SCENE_MAX_BYTES (4 << 20)

static PetscBool IsYAML_Private(const char *name)
{
  size_t n = strlen(name);
  return name[0] != '-' && ((n > 4 && !strcmp(name + n - 4, ".yml")) || (n > 5 && !strcmp(name + n - 5, ".yaml"))) ? PETSC_TRUE : PETSC_FALSE;
}

/* The first argument that ends in .yml or .yaml and is not the file of -options_file; else the first argument if it is no option. */
static PetscErrorCode FindFile_Private(int argc, char **argv, const char **file)
{
  int at = 0;

  PetscFunctionBegin;
  for (int i = 1; i < argc && !at; ++i)
    if (IsYAML_Private(argv[i]) && strncmp(argv[i - 1], "-options_file", 13)) at = i;
  if (!at && argc > 1 && argv[1][0] != '-') at = 1;
  PetscCheckInput(at, "no scene given; run: mortise SCENE.yml [options], or mortise -help");
  for (int i = at + 1; i < argc; ++i) {
    PetscBool stray = i == at + 1 && argv[i][0] != '-' ? PETSC_TRUE : PETSC_FALSE;
    if (IsYAML_Private(argv[i]) && (argv[i - 1][0] != '-' || !strcmp(argv[i - 1], "-check"))) stray = PETSC_TRUE;
    PetscCheckInput(!stray, "'%s' after the scene is neither an option nor its value; one run solves one scene", argv[i]);
  }
  *file = argv[at];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Text of the file on all ranks, with a 0 at its end. */
static PetscErrorCode Load_Private(MPI_Comm comm, const char *file, char **text, PetscInt *length)
{
  PetscInt    status[2] = {0, 0}; /* length, errno; length -1: no regular file */
  PetscMPIInt rank;
  struct stat info;
  FILE       *f = NULL;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    if (stat(file, &info))
      status[1] = errno;
    else if (!S_ISREG(info.st_mode))
      status[0] = -1;
    else if (!(f = fopen(file, "r")))
      status[1] = errno;
    else
      status[0] = (PetscInt)PetscMin(info.st_size, SCENE_MAX_BYTES + 1);
  }
  PetscCallMPI(MPI_Bcast(status, 2, MPIU_INT, 0, comm));
  PetscCheckInput(!status[1], "scene %s cannot be read: %s", file, strerror((int)status[1]));
  PetscCheckInput(status[0] >= 0, "scene %s is no file", file);
  PetscCheckInput(status[0] <= SCENE_MAX_BYTES, "scene %s is larger than %d bytes", file, SCENE_MAX_BYTES);
  PetscCall(PetscCalloc1(status[0] + 1, text));
  if (rank == 0) {
    status[0] = (PetscInt)fread(*text, 1, (size_t)status[0], f);
    (void)fclose(f);
  }
  PetscCallMPI(MPI_Bcast(status, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(*text, (PetscMPIInt)status[0], MPI_CHAR, 0, comm));
  *length = status[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The directory exists and is writable, or the nearest one above it that exists is. Nothing is created. */
static PetscErrorCode CheckOutput_Private(Scene s)
{
  const char *directory = s->data.output.directory;
  PetscMPIInt rank;
  PetscInt    error = 0;
  char        path[PETSC_MAX_PATH_LEN];
  struct stat info;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  PetscCall(PetscStrncpy(path, directory, sizeof(path)));
  while (rank == 0) {
    char *slash;
    if (!stat(path, &info)) {
      error = !S_ISDIR(info.st_mode) ? ENOTDIR : access(path, W_OK | X_OK) ? errno : 0;
      break;
    }
    error = errno;
    if (errno != ENOENT) break;
    slash = strrchr(path, '/');
    if (slash == path && path[1])
      path[1] = 0; /* the root */
    else if (slash && slash != path)
      *slash = 0;
    else
      PetscCall(PetscStrncpy(path, ".", sizeof(path)));
  }
  PetscCallMPI(MPI_Bcast(&error, 1, MPIU_INT, 0, s->comm));
  PetscCheckInput(!error, "output.directory is '%s', which cannot be written: %s", directory, strerror((int)error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create_Private(Scene s, int argc, char **argv)
{
  const char *file = "", *slash;
  PetscInt    length;

  PetscFunctionBegin;
  PetscCall(FindFile_Private(argc, argv, &file));
  PetscCheckInput(strlen(file) < sizeof(s->data.file) - 1, "the name of the scene is too long");
  PetscCall(PetscStrncpy(s->data.file, file, sizeof(s->data.file)));
  slash = strrchr(file, '/');
  if (slash)
    PetscCall(PetscSNPrintf(s->directory, sizeof(s->directory), "%.*s/", (int)(slash - file), file));
  else
    PetscCall(PetscStrncpy(s->directory, "./", sizeof(s->directory)));
  PetscCall(Load_Private(s->comm, file, &s->text, &length));
  PetscCall(SceneParse(s->data.file, s->text, (size_t)length, &s->root));
  PetscCall(SceneRead(s, argc, argv));
  PetscCall(CheckOutput_Private(s));
  for (int i = 1; i < argc; ++i)
    if (!strcmp(argv[i], "-check")) s->check = PETSC_TRUE;
  PetscCall(PetscOptionsClearValue(NULL, "-check"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCreate(MPI_Comm comm, int argc, char **argv, Scene *scene)
{
  Scene          s;
  PetscErrorCode status;

  PetscFunctionBegin;
  *scene = NULL;
  PetscCall(PetscNew(&s));
  s->comm = comm;
  status  = Create_Private(s, argc, argv);
  if (status) PetscCall(SceneDestroy(&s));
  PetscCall(status);
  *scene = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* contact.<pair>.subdivide: the contact faces stay linear, the layer of cells behind them is subdivided. A surface of several pairs as often as the one that
   asks for most. */
static PetscErrorCode Subdivide_Private(Scene s, Forest *forest)
{
  PetscInt levels[8 * sizeof(uint64_t)] = {0}; /* a boundary group is a bit */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->data.num_contacts; ++i) {
    const PetscInt side[2] = {s->data.contacts[i].nonmortar, s->data.contacts[i].mortar};
    for (int k = 0; k < 2; ++k) {
      if (s->contact[i].subdivide != SUBDIVIDE_AUTO) levels[side[k]] = PetscMax(levels[side[k]], s->contact[i].subdivide);
    }
  }
  for (PetscInt group = 0; group < (PetscInt)(8 * sizeof(uint64_t)); ++group) {
    const RefineSpec spec = {.group = group, .radius = -1, .levels = levels[group]};
    PetscCall(ForestRefine(forest, &spec));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneSetUp(Scene s, Forest *forest)
{
  SceneData     *d = &s->data;
  PetscErrorCode status;

  PetscFunctionBegin;
  *forest = NULL;
  PetscCheck(!s->setup, s->comm, PETSC_ERR_ORDER, "SceneSetUp was called before");
  status = SceneMakeMesh(s);
  if (!status) status = ForestCreate(s->comm, &d->mesh, forest);
  PetscCall(SceneRemoveMesh(s)); /* also after an error */
  PetscCall(status);
  status = SceneCheckMesh(s, *forest);
  if (status) PetscCall(ForestDestroy(forest));
  PetscCall(status);
  for (PetscInt i = 0; i < d->num_refines; ++i) PetscCall(ForestRefine(forest, &d->refines[i]));
  PetscCall(Subdivide_Private(s, forest));
  d->mechanics.num_bodies     = s->num_bodies;
  d->mechanics.bodies         = d->bodies;
  d->mechanics.num_boundaries = s->num_boundaries;
  d->mechanics.boundaries     = d->boundaries;
  s->setup                    = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneGetData(Scene s, const SceneData **data)
{
  PetscFunctionBegin;
  *data = &s->data;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SceneCheckOnly(Scene s)
{
  return s->check;
}

/* ---- report ---------------------------------------------------------------------------------------------------------------------------- */

static PetscErrorCode ViewBoundary_Private(const BoundarySpec *b, PetscViewer viewer)
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
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n", b->amplitude.num ? " (amplitude)" : ""));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViewContact_Private(const ContactEntry *c, PetscViewer viewer)
{
  char layer[64] = "";

  PetscFunctionBegin;
  if (c->spec.subdivide_auto)
    PetscCall(PetscStrncpy(layer, ", cells at both subdivided as the estimate asks", sizeof(layer)));
  else if (c->subdivide)
    PetscCall(PetscSNPrintf(layer, sizeof(layer), ", cells at both subdivided %dx", c->subdivide));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  contact %s: %s (nonmortar) on %s%s%s%s\n", c->spec.name, c->nonmortar, c->mortar,
                                   c->spec.full ? ", full order" : "", c->spec.node_to_segment ? ", node to segment" : "", layer));
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
  PetscCall(PetscViewerASCIIPrintf(viewer, "%s\n", b->amplitude.num ? " (amplitude)" : ""));
  PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many cells, and where: a wrong unit of length shows here. */
static PetscErrorCode ViewMesh_Private(const char *file, Forest forest, PetscViewer viewer)
{
  const ForestTables *t;
  const CoarseMesh   *mesh;
  PetscReal           lo[3], hi[3];

  PetscFunctionBegin;
  PetscCall(ForestGetTables(forest, &t));
  PetscCall(ForestGetCoarse(forest, &mesh));
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
  for (PetscInt i = 0; i < s->num_boundaries; ++i) PetscCall(ViewBoundary_Private(&d->boundaries[i], viewer));
  for (PetscInt i = 0; i < d->num_contacts; ++i) PetscCall(ViewContact_Private(&s->contact[i], viewer));
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
    PetscCall(PetscViewerASCIIPrintf(viewer, "  probe %s at (%.6g, %.6g, %.6g)\n", d->probes[i].name, (double)d->probes[i].X[0], (double)d->probes[i].X[1],
                                     (double)d->probes[i].X[2]));
  PetscCall(PetscViewerASCIIPrintf(viewer, "  output %s\n", d->output.directory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- end --------------------------------------------------------------------------------------------------------------------------------- */

static PetscErrorCode DestroyBoundary_Private(BoundarySpec *b)
{
  PetscFunctionBegin;
  for (int c = 0; c < 3; ++c) {
    PetscCall(ExpressionDestroy(&b->displacement[c]));
    PetscCall(ExpressionDestroy(&b->traction[c]));
  }
  PetscCall(ExpressionDestroy(&b->pressure));
  PetscCall(ExpressionDestroy(&b->volume));
  PetscCall(ExpressionDestroy(&b->advance));
  PetscCall(ExpressionDestroy(&b->rotation_angle));
  PetscCall(PetscFree(b->amplitude.pairs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDestroy(Scene *scene)
{
  Scene s = *scene;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; s->body && i < s->num_bodies; ++i) {
    for (int c = 0; c < 3; ++c) {
      PetscCall(ExpressionDestroy(&s->body[i].spec.motion[c]));
      PetscCall(ExpressionDestroy(&s->body[i].spec.force[c]));
    }
    PetscCall(PetscFree(s->body[i].spec.amplitude.pairs));
  }
  for (PetscInt i = 0; s->boundary && i < s->num_boundaries; ++i) PetscCall(DestroyBoundary_Private(&s->boundary[i].spec));
  PetscCall(PetscFree(s->material));
  PetscCall(PetscFree(s->body));
  PetscCall(PetscFree(s->boundary));
  PetscCall(PetscFree(s->contact));
  PetscCall(PetscFree(s->probe));
  PetscCall(PetscFree(s->refine));
  PetscCall(PetscFree(s->data.refines));
  PetscCall(PetscFree(s->data.materials));
  PetscCall(PetscFree(s->data.bodies));
  PetscCall(PetscFree(s->data.boundaries));
  PetscCall(PetscFree(s->data.contacts));
  PetscCall(PetscFree(s->data.probes));
  PetscCall(NodeDestroy(&s->root));
  PetscCall(PetscFree(s->text));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
