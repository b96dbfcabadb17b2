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
  for (int i = 1; i < argc; ++i) { /* an option takes the word behind it as its value, unless that is an option itself */
    PetscBool option, value = PETSC_FALSE;
    PetscCall(PetscOptionsValidKey(argv[i], &option));
    if (i > 1 && strcmp(argv[i - 1], "-check")) PetscCall(PetscOptionsValidKey(argv[i - 1], &value));
    PetscCheckInput(i == at || option || value, "'%s' is neither the scene nor an option nor its value; one run solves one scene", argv[i]);
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

#define LONGEST_FILE 32 /* characters of a name in output.directory, with what stands before and behind it */

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
  PetscCheckInput(strlen(directory) + LONGEST_FILE < sizeof(path), "output.directory is longer than %d characters", (int)sizeof(path) - 1 - LONGEST_FILE);
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
  PetscCheckInput(TextIsPlain(file, ""), "the name of the scene has a control character in it: %s", file);
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
  PetscCall(PetscOptionsHasName(NULL, NULL, "-check", &s->check));
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
  for (PetscInt i = 0; i < s->num_contacts; ++i) {
    const PetscInt side[2] = {s->contact[i].spec.nonmortar, s->contact[i].spec.mortar};
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
  PetscCall(SceneTellMesh(s, *forest));
  for (PetscInt i = 0; i < d->num_refines; ++i) PetscCall(ForestRefine(forest, &d->refines[i]));
  PetscCall(Subdivide_Private(s, forest));
  for (PetscInt i = 0; i < s->num_corners; ++i) {
    RefineSpec at = s->corner[i];
    at.group      = s->contact[at.group].spec.nonmortar;
    PetscCall(ForestRefine(forest, &at));
  }
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

void SceneExchange(Scene s, uint64_t pairs, PetscInt num, const RefineSpec at[])
{
  s->exchange    = pairs;
  s->num_corners = num;
  s->corner      = at;
}

PetscBool SceneCheckOnly(Scene s)
{
  return s->check;
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
      PetscCall(ExpressionDestroy(&s->body[i].spec.load[c]));
      PetscCall(ExpressionDestroy(&s->body[i].spec.load_moment[c]));
    }
    PetscCall(ExpressionDestroy(&s->body[i].spec.rotation_angle));
    PetscCall(PetscFree(s->body[i].spec.amplitude.pairs));
  }
  for (PetscInt i = 0; s->boundary && i < s->num_boundaries; ++i) PetscCall(DestroyBoundary_Private(&s->boundary[i].spec));
  PetscCall(PetscFree(s->material));
  PetscCall(PetscFree(s->body));
  PetscCall(PetscFree(s->boundary));
  for (PetscInt i = 0; s->contact && i < s->num_contacts; ++i) {
    if (s->face) PetscCall(PetscFree(s->face[i]));
    PetscCall(ExpressionDestroy(&s->contact[i].spec.interference));
    PetscCall(ExpressionDestroy(&s->contact[i].spec.friction));
  }
  PetscCall(PetscFree(s->contact));
  PetscCall(PetscFree(s->face));
  PetscCall(PetscFree(s->probe));
  PetscCall(PetscFree(s->refine));
  PetscCall(PetscFree(s->point));
  PetscCall(PetscFree(s->data.refines));
  PetscCall(PetscFree(s->data.materials));
  PetscCall(PetscFree(s->data.bodies));
  PetscCall(PetscFree(s->data.boundaries));
  PetscCall(PetscFree(s->data.contacts));
  PetscCall(PetscFree(s->joined));
  PetscCall(PetscFree(s->data.probes));
  PetscCall(NodeDestroy(&s->root));
  PetscCall(PetscFree(s->text));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
