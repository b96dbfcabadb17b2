/* A .geo becomes a .msh by the program gmsh, run on rank 0 in a temporary directory; a .msh is taken as it is. */
#include "sceneimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define MESH_MAX_PARAMETERS 64
#define MESSAGE_LENGTH 512
#define LOG_FILE "log" /* in the temporary directory, as the mesh, whose name ends in .msh */
#define FORMAT_FILE "format.geo"
#define GRACE 3          /* seconds for gmsh to come to an end when the run is asked to stop … */
#define GRACE_KILLED 0.5 /* … by SIGTERM, after which mpiexec kills what is there a second later */

/* What rank 0 tells the others: a sentence about wrong input, "" if all is well. */
typedef struct {
  char message[PETSC_MAX_PATH_LEN + MESSAGE_LENGTH];
  char file[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  int  subdivided; /* hexahedra are made out of tetrahedra */
  int  stopped;    /* the run was asked to stop: that is the message */
} MeshResult;

static PetscBool HasSuffix_Private(const char *file, const char *suffix)
{
  size_t n = strlen(file), k = strlen(suffix);
  return n > k && !strcmp(file + n - k, suffix) ? PETSC_TRUE : PETSC_FALSE;
}

/* First error that gmsh wrote, without its prefix. */
static void FirstError_Private(const char *log, char *message, size_t capacity)
{
  char  line[MESSAGE_LENGTH];
  FILE *f = fopen(log, "r");

  message[0] = 0;
  while (f && fgets(line, sizeof(line), f)) {
    char *text = strstr(line, "Error");
    if (!text) continue;
    text += 5;
    text += strspn(text, " :");
    text[strcspn(text, "\r\n")] = 0;
    (void)snprintf(message, capacity, "%s", text);
    break;
  }
  if (f) (void)fclose(f);
}

/* Coordinates that are no numbers make gmsh ask for memory without end. It gets a quarter of the machine's: where the mesh takes more, the equations on it have
   no room. Less where the user allows less (ulimit -d). */
static struct rlimit Memory_Private(void)
{
  const rlim_t  quarter = (rlim_t)sysconf(_SC_PHYS_PAGES) * (rlim_t)sysconf(_SC_PAGESIZE) / 4;
  struct rlimit limit;

  if (getrlimit(RLIMIT_DATA, &limit)) limit = (struct rlimit){.rlim_cur = RLIM_INFINITY, .rlim_max = RLIM_INFINITY};
  if (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > quarter) limit.rlim_cur = quarter;
  return limit;
}

/* Does a file have the words in one of its lines? */
static PetscBool Says_Private(const char *file, const char *words)
{
  char      line[MESSAGE_LENGTH];
  PetscBool found = PETSC_FALSE;
  FILE     *f     = fopen(file, "r");

  while (f && !found && fgets(line, sizeof(line), f)) found = (PetscBool)(strstr(line, words) != NULL);
  if (f) (void)fclose(f);
  return found;
}

/* Wait for the program, which may never end. Once the run is asked to stop it has a little time left: a mesh that is nearly there makes a checkpoint possible.
   Returns errno. */
static int Wait_Private(pid_t pid, int *status, PetscBool *stopped)
{
  const struct timespec pause = {.tv_nsec = 2000000}; /* gmsh takes some 50 of them at least */
  PetscReal             spent = 0;
  pid_t                 ended;

  *stopped = PETSC_FALSE;
  while ((ended = waitpid(pid, status, *stopped ? 0 : WNOHANG)) == 0 || (ended < 0 && errno == EINTR)) {
    if (StopWish()[0]) spent += 1e-9 * (PetscReal)pause.tv_nsec;
    *stopped = (PetscBool)(spent >= (strcmp(StopWish(), "SIGTERM") ? GRACE : GRACE_KILLED));
    if (*stopped) (void)kill(pid, SIGKILL);
    (void)nanosleep(&pause, NULL);
  }
  return ended < 0 ? errno : 0;
}

/* The new process, which ends with this one. Between vfork and exec it runs in our memory: system calls only. Returns errno. */
static int Start_Private(char *const argv[], int in, int out, pid_t *pid)
{
  const pid_t         parent = getpid();
  const struct rlimit memory = Memory_Private();
  volatile int        failed = 0;

  *pid = vfork();
  if (*pid < 0) return errno;
  if (*pid) return failed;
  (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
  (void)setrlimit(RLIMIT_DATA, &memory);
  if (getppid() == parent && dup2(in, 0) >= 0 && dup2(out, 1) >= 0 && dup2(out, 2) >= 0) (void)execvp(argv[0], argv);
  failed = errno;
  _exit(127);
}

/* Run a program without a shell, both outputs to log. Returns errno of the start, and the program's exit status. */
static int Run_Private(char *const argv[], const char *log, int *status, PetscBool *stopped)
{
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC), out = open(log, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  pid_t     pid    = -1;
  const int failed = in < 0 || out < 0 ? errno : Start_Private(argv, in, out, &pid);

  if (in >= 0) (void)close(in);
  if (out >= 0) (void)close(out);
  if (pid > 0 && failed) (void)waitpid(pid, status, 0);
  return failed ? failed : Wait_Private(pid, status, stopped);
}

/* gmsh does not notice that there was no room for all of the mesh: then the last line is not the end of a section. */
static void CheckWhole_Private(const char *geo, MeshResult *r)
{
  char  last[32] = "", *line = last;
  FILE *f = fopen(r->file, "r");

  if (f && !fseek(f, -(long)sizeof(last) + 1, SEEK_END)) last[fread(last, 1, sizeof(last) - 1, f)] = 0;
  if (f) (void)fclose(f);
  for (char *c = last; *c; ++c)
    if (c[0] == '\n' && c[1]) line = c + 1;
  if (access(r->file, F_OK))
    (void)snprintf(r->message, sizeof(r->message), "mesh.file %s: gmsh ended without a mesh; a statement of it, as Exit, has it end before", geo);
  else if (strncmp(line, "$End", 4) || !strchr(line, '\n'))
    (void)snprintf(r->message, sizeof(r->message), "mesh.file %s: gmsh could not write all of its mesh to %s; is there no room? TMPDIR names another directory",
                   geo, r->temporary);
}

/* Cells in an ASCII .msh 4.1: highest dimension, and whether there are simplices of it. */
static void Scan_Private(const char *file, PetscInt *dim, PetscBool *simplices)
{
  static const int simplex[] = {2, 4, 9, 11, 20, 21, 22, 23, 24, 25, 29, 30, 31}; /* gmsh's types of triangles and tetrahedra */
  char             line[256];
  long             blocks, d, tag, type, num;
  FILE            *f = fopen(file, "r");

  *dim       = 0;
  *simplices = PETSC_FALSE;
  while (f && fgets(line, sizeof(line), f) && strncmp(line, "$Elements", 9)) continue;
  if (f && fscanf(f, "%ld %*s %*s %*s ", &blocks) == 1) {
    for (; blocks > 0 && fscanf(f, "%ld %ld %ld %ld ", &d, &tag, &type, &num) == 4; --blocks) {
      if (num > 0 && d > *dim) *dim = (PetscInt)d, *simplices = PETSC_FALSE;
      for (size_t i = 0; i < sizeof(simplex) / sizeof(simplex[0]); ++i)
        if (num > 0 && d == *dim && type == simplex[i]) *simplices = PETSC_TRUE;
      for (int c = 0; num > 0 && (c = getc(f)) != EOF;)
        if (c == '\n') --num;
    }
  }
  if (f) (void)fclose(f);
}

/* What gmsh reads behind the .geo, whose own statements about the format of the mesh would leave one that is not read here. */
static const char Format[] = "Mesh.Format = 1; Mesh.MshFileVersion = 4.1; Mesh.Binary = 0; Mesh.SaveParametric = 0;\n";

static int WriteFormat_Private(const char *path)
{
  FILE *f = fopen(path, "w");

  if (!f) return errno;
  (void)fputs(Format, f);
  return fclose(f) ? errno : 0;
}

/* gmsh on the .geo; subdivide: ask for quads or hexes from triangles or tetrahedra. A sentence in r->message when it fails. */
static void Gmsh_Private(Scene s, const char *geo, PetscBool subdivide, MeshResult *r)
{
  char        order[16], log[PETSC_MAX_PATH_LEN + 16], format[PETSC_MAX_PATH_LEN + 16], reason[MESSAGE_LENGTH];
  const char *argv[32 + 3 * MESH_MAX_PARAMETERS];
  int         n = 0, status = 0, error;
  PetscBool   stopped   = PETSC_FALSE;
  PetscInt    dim       = s->data.mesh.dim;
  SceneNode  *parameter = NodeFind(NodeFind(s->root, "mesh"), "parameter");

  (void)snprintf(order, sizeof(order), "%d", (int)s->mesh_order);
  (void)snprintf(log, sizeof(log), "%s/" LOG_FILE, r->temporary);
  (void)snprintf(format, sizeof(format), "%s/" FORMAT_FILE, r->temporary);
  const char *fixed[] = {"gmsh", dim == 2 ? "-2" : "-3", "-order", order, "-format", "msh41", "-v", "2", "-nt", "1", "-o", r->file};
  for (size_t i = 0; i < sizeof(fixed) / sizeof(fixed[0]); ++i) argv[n++] = fixed[i];
  for (SceneNode *p = parameter ? parameter->first : NULL; p; p = p->next) {
    argv[n++] = "-setnumber";
    argv[n++] = p->key;
    argv[n++] = p->text;
  }
  if (subdivide) {
    const char *more[] = {"-setnumber", "Mesh.RecombineAll", dim == 2 ? "1" : "0", "-setnumber", "Mesh.SubdivisionAlgorithm", dim == 2 ? "1" : "2"};
    for (int i = 0; i < 6; ++i) argv[n++] = more[i];
  }
  argv[n++] = geo;
  argv[n++] = format;
  argv[n]   = NULL;
  error     = WriteFormat_Private(format);
  if (error)
    (void)snprintf(r->message, sizeof(r->message), "mesh.file %s: %s cannot be written: %s; TMPDIR names another directory", geo, format, strerror(error));
  if (error) return;
  error = Run_Private((char *const *)(const void *)argv, log, &status, &stopped);
  FirstError_Private(log, reason, sizeof(reason));
  if (error == ENOENT)
    (void)snprintf(r->message, sizeof(r->message), "mesh.file %s needs the program gmsh, which is not installed (or not in PATH); install it or give a .msh",
                   geo);
  else if (error)
    (void)snprintf(r->message, sizeof(r->message), "mesh.file %s: gmsh could not be started: %s", geo, strerror(error));
  else if (stopped || (WIFSIGNALED(status) && StopWish()[0])) /* the terminal's SIGINT goes to both */
    r->stopped = snprintf(r->message, sizeof(r->message), "mesh.file %s: gmsh had not come to an end when the run was asked to stop (%s)", geo, StopWish()) > 0;
  else if (WIFSIGNALED(status) && Says_Private(log, "bad_alloc"))
    (void)snprintf(
        r->message, sizeof(r->message),
        "mesh.file %s: gmsh asks for more than %lld MB of memory (a quarter of this machine's, or ulimit -d); allowed: coordinates that are numbers, "
        "sizes in proportion to them",
        geo, (long long)(Memory_Private().rlim_cur >> 20));
  else if (WIFSIGNALED(status))
    (void)snprintf(r->message, sizeof(r->message), "mesh.file %s: gmsh crashed (%s); another Mesh.Algorithm or other sizes may help", geo,
                   strsignal(WTERMSIG(status)));
  else if (status || reason[0])
    (void)snprintf(r->message, sizeof(r->message), "gmsh rejects mesh.file %s: %s", geo, reason[0] ? reason : "it failed without saying why");
  else
    CheckWhole_Private(geo, r);
}

static void Generate_Private(Scene s, const char *geo, MeshResult *r)
{
  const char *base = getenv("TMPDIR"), *stem = strrchr(geo, '/') + 1; /* geo holds a '/' always */
  PetscInt    dim;
  PetscBool   simplices;

  if (!s->trust) GeoCheck(geo, sizeof(r->message), r->message);
  if (r->message[0]) return;
  (void)snprintf(r->temporary, sizeof(r->temporary), "%s/mortise-XXXXXX", base && base[0] ? base : "/tmp");
  if (!mkdtemp(r->temporary)) {
    (void)snprintf(r->message, sizeof(r->message), "no temporary directory for the mesh can be made: %s: %s", r->temporary, strerror(errno));
    r->temporary[0] = 0;
    return;
  }
  if (snprintf(r->file, sizeof(r->file), "%s/%.*s.msh", r->temporary, (int)(strlen(stem) - strlen(".geo")), stem) >= (int)sizeof(r->file)) {
    (void)snprintf(r->message, sizeof(r->message), "the name of mesh.file is too long");
    return;
  }
  Gmsh_Private(s, geo, PETSC_FALSE, r);
  if (r->message[0]) return;
  Scan_Private(r->file, &dim, &simplices);
  if (simplices && dim == s->data.mesh.dim) {
    Gmsh_Private(s, geo, PETSC_TRUE, r);
    r->subdivided = dim == 3;
    if (r->message[0]) return;
    Scan_Private(r->file, &dim, &simplices);
  }
  if (dim < s->data.mesh.dim)
    (void)snprintf(r->message, sizeof(r->message), "model is %s, but mesh.file %s has no cells of dimension %d (or no physical group of them)",
                   s->data.mesh.dim == 3 ? "3d" : "two-dimensional", geo, (int)s->data.mesh.dim);
}

const char *SceneMeshFile(Scene s)
{
  static char file[PETSC_MAX_PATH_LEN];

  (void)snprintf(file, sizeof(file), "%s%s", s->mesh_file[0] == '/' ? "" : s->directory, s->mesh_file);
  return file;
}

static void Find_Private(Scene s, MeshResult *r)
{
  const SceneNode *mesh      = NodeFind(s->root, "mesh");
  const SceneNode *parameter = NodeFind(mesh, "parameter");
  const char      *where     = NodeWhere(NodeFind(mesh, "file"));
  PetscBool        geo       = HasSuffix_Private(s->mesh_file, ".geo");
  struct stat      info;

  (void)snprintf(r->file, sizeof(r->file), "%s", SceneMeshFile(s));
  if (!geo && !HasSuffix_Private(s->mesh_file, ".msh"))
    (void)snprintf(r->message, sizeof(r->message), "%s is '%.80s'; its name must end in .geo or .msh, which mortise-import makes of others", where,
                   s->mesh_file);
  else if (stat(r->file, &info))
    (void)snprintf(r->message, sizeof(r->message), "%s: there is no file %s", where, r->file);
  else if (!S_ISREG(info.st_mode) || access(r->file, R_OK))
    (void)snprintf(r->message, sizeof(r->message), "%s: %s cannot be read", where, r->file);
  else if (!geo && parameter)
    (void)snprintf(r->message, sizeof(r->message), "%s: only a .geo has parameters, mesh.file is %s", NodeWhere(parameter), s->mesh_file);
  for (SceneNode *p = geo && parameter && !r->message[0] ? parameter->first : NULL; p && !r->message[0]; p = p->next) {
    const char *said = GeoCheckConstant(r->file, p->key);
    if (said[0]) (void)snprintf(r->message, sizeof(r->message), "%s: %s %s", NodeWhere(p), r->file, said);
  }
}

PetscErrorCode SceneMakeMesh(Scene s)
{
  const SceneNode *mesh = NodeFind(s->root, "mesh"), *parameter = NodeFind(mesh, "parameter"), *order = NodeFind(mesh, "order");
  MeshResult       r;
  PetscMPIInt      rank;
  PetscReal        value;

  PetscFunctionBegin;
  PetscCheckInput(NodeCount(parameter) <= MESH_MAX_PARAMETERS, "%s: at most %d constants", NodeWhere(parameter), MESH_MAX_PARAMETERS);
  for (SceneNode *p = parameter ? parameter->first : NULL; p; p = p->next)
    PetscCheckInput(OptionParseReal(p->text, &value), "%s is '%s'; it must be a number", NodeWhere(p), p->text);
  PetscCall(PetscMemzero(&r, sizeof(r)));
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  if (rank == 0) {
    Find_Private(s, &r);
    if (!r.message[0] && HasSuffix_Private(r.file, ".geo")) {
      char geo[PETSC_MAX_PATH_LEN];
      PetscCall(PetscStrncpy(geo, r.file, sizeof(geo)));
      Generate_Private(s, geo, &r);
    }
  }
  PetscCallMPI(MPI_Bcast(&r, (PetscMPIInt)sizeof(r), MPI_CHAR, 0, s->comm));
  PetscCall(PetscStrncpy(s->temporary, r.temporary, sizeof(s->temporary)));
  PetscCall(PetscStrncpy(s->data.mesh.file, r.file, sizeof(s->data.mesh.file)));
  if (r.temporary[0]) PetscCall(PetscStrncpy(s->data.mesh.told, s->mesh_file, sizeof(s->data.mesh.told)));
  s->subdivided = (PetscBool)r.subdivided;
  if (r.stopped) StopEarly();
  PetscCheckInput(!r.message[0], "%s", r.message);
  if (order && HasSuffix_Private(s->mesh_file, ".msh"))
    PetscCall(
        WarningAdd(s->comm, "%s acts on a .geo, which is meshed here; cells of mesh.file %.80s have the order that they have", NodeWhere(order), s->mesh_file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneRemoveMesh(Scene s)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  if (!s->temporary[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(s->comm, &rank));
  if (rank == 0) {
    static const char *const beside[] = {LOG_FILE, FORMAT_FILE};
    for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(beside); ++i) {
      char path[PETSC_MAX_PATH_LEN + 16];
      (void)snprintf(path, sizeof(path), "%s/%s", s->temporary, beside[i]);
      (void)unlink(path);
    }
    (void)unlink(s->data.mesh.file);
    (void)rmdir(s->temporary);
  }
  s->temporary[0] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}
