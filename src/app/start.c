/* Starting MPI cheaply: a single process needs no network and no daemon. Half the processor time of the start and 0.3 s of waiting go. */
#include "appimpl.h"
#include <errno.h>
#include <fcntl.h>
#include <petscblaslapack.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

static const char *const Alone[][2] = {
    {"OMPI_MCA_pml", "ob1"},
    {"OMPI_MCA_btl", "self"},
    {"OMPI_MCA_ess_singleton_isolated", "1"},
    {"OMPI_MCA_coll", "self,basic,libnbc"},
    {"OMPI_MCA_orte_create_session_dirs", "0"}, /* which another start, or end, may take away while it is made */
    {"OMPI_MCA_osc", "^ucx"},
    {"HWLOC_COMPONENTS", "-linuxio,-pci,-opencl,-cuda,-nvml,-gl,-x86"},
};
enum { NUM_ALONE = sizeof(Alone) / sizeof(Alone[0]) };

/* Our manual and catalogue, not PETSc's. */
static int Ours_Private(const char *argument)
{
  return !strcmp(argument, "-help") || !strcmp(argument, "--help") || !strcmp(argument, "-h") || !strcmp(argument, "--version") || !strcmp(argument, "-list");
}

/* The arguments without those; lives as long as the program (PETSc keeps the pointer). */
static char **Arguments_Private(int *argc, char **argv)
{
  char **kept = (char **)calloc((size_t)*argc + 1, sizeof(char *));
  int    num  = 0;

  if (!kept) return argv;
  for (int i = 0; i < *argc; ++i) {
    if (i == 0 || !Ours_Private(argv[i])) kept[num++] = argv[i];
  }
  *argc = num;
  return kept;
}

/* Where OpenBLAS is the BLAS. Fronts of plane problems are too small for its threads: waiting for each other they doubled the processor time of hertz2d.yml. */
extern void openblas_set_num_threads(int) __attribute__((weak));
static void OneThread_Private(void)
{
  if (openblas_set_num_threads && !getenv("OPENBLAS_NUM_THREADS") && !getenv("OMP_NUM_THREADS")) openblas_set_num_threads(1);
}

/* Each thread of MPI that asks for memory would reserve 64 MB of addresses for itself, at its own time: with few left (ulimit -v) MPI then finds no room for
   its modules in some runs, and says more than a sentence. */
static void OneArena_Private(void)
{
#if defined(M_ARENA_MAX)
  (void)mallopt(M_ARENA_MAX, 1);
#endif
}

#define BLAS_ROOM ((size_t)144 << 20)  /* bytes of its buffer, and of what comes before */
#define START_ROOM ((size_t)240 << 20) /* with what MPI and PETSc take */

/* OpenBLAS asks for its buffer at its first call, and where there is no room (ulimit -v) for ever; MPI says more than a sentence. Told before either. */
static void CheckRoom_Private(size_t bytes)
{
  void *volatile room = openblas_set_num_threads ? malloc(bytes) : NULL;

  if (openblas_set_num_threads && !room) {
    fprintf(stderr, "mortise: out of memory: fewer than %d MB are left to begin with (ulimit -v, ulimit -d)\n", (int)(bytes >> 20));
    fflush(stderr);
    _exit(2); /* mpiexec ends the other processes */
  }
  free(room);
}

/* Its buffer is taken while there is room: where the mesh has left none by its first call it would ask for ever. */
static void TakeRoom_Private(void)
{
  const PetscBLASInt one = 1;
  const PetscScalar  a = 1, b = 0;
  PetscScalar        c = 0;

  CheckRoom_Private(BLAS_ROOM);
  BLASsymm_("L", "U", &one, &one, &a, &a, &one, &a, &one, &b, &c, &one);
}

/* What PETSc says while it starts. Wrong then by a user's doing: a file of -options_file, what is no YAML, and more options than it has room for. */
static char words[1 << 14];

static PetscErrorCode Keep_Private(const char format[], ...)
{
  const size_t used = strlen(words);
  va_list      arguments;

  va_start(arguments, format);
  (void)vsnprintf(words + used, sizeof(words) - used, format, arguments);
  va_end(arguments);
  return PETSC_SUCCESS;
}

/* One sentence of it, if it is of such a thing, else all. */
static PetscErrorCode Tell_Private(PetscErrorCode ierr)
{
  char       *file = strstr(words, "options file"), *line = file ? file : strstr(words, "-options_file filename"), *many = strstr(words, "Number of options ");
  char       *value   = strstr(words, "Unknown logical value"); /* of -fp_trap and the like; -info names a file that cannot be opened */
  int         running = 0;
  PetscMPIInt rank    = 0;

  MPI_Initialized(&running);
  if (running) MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (!value) value = strstr(words, "Unable to open file ");
  if (value && !line && !many) {
    value[strcspn(value, "\n")] = 0;
    (void)ErrorInput("an option of PETSc cannot act: %s", value);
  }
  if (strstr(words, "YAML"))
    return ErrorInput(
        "options in YAML (of -options_file, -options_file_yaml, -options_string_yaml or PETSC_OPTIONS_YAML) must be a mapping of names to values");
  if (!line && !many && !value) {
    fputs(words, stderr);
    return ierr;
  }
  while (line && line > words && line[-1] != '\n') --line;
  if (line) line[strcspn(line, "\n")] = 0;
  if (line) (void)ErrorInput("-options_file: %s", line);
  if (rank == 0 && !line && many)
    fprintf(stderr, "mortise: there are more than %d options, which PETSc has no room for; keys of the scene stand in its file\n", atoi(many + 18));
  if (running) MPI_Finalize();
  return MORTISE_ERR_INPUT;
}

/* Files of options that PETSc reads unasked, those of the working directory among them: whose they are a user may not know. They are named when they have any.
 */
static void TellFiles_Private(int argc, char **argv)
{
  static const char *const files[] = {".petscrc", "petscrc"};
  char                     line[1024];
  PetscMPIInt              rank = 0;

  for (int i = 1; i < argc; ++i) {
    if (!strcmp(argv[i], "-skip_petscrc")) return;
  }
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (int i = 0; i < 2 && rank == 0; ++i) {
    FILE     *file = fopen(files[i], "r");
    PetscBool acts = PETSC_FALSE;
    while (file && !acts && fgets(line, sizeof(line), file)) acts = (PetscBool)(line[strspn(line, " \t")] == '-');
    if (file) (void)fclose(file);
    if (acts)
      printf("note: options of %s in the working directory act, beginning with %.*s; -skip_petscrc leaves them out\n", files[i],
             (int)PetscMin(80, strcspn(line, "\n")), line);
  }
}

#define STACK_ROOM ((rlim_t)1 << 20) /* bytes; a run takes a fifth of it */
#define FILES_ROOM ((rlim_t)64)      /* open at a time; a run by itself takes 15, MPI some more for each process */

/* Make room where less is given but more allowed; true where that is too little: what is allowed. */
static PetscBool Lacks_Private(int resource, rlim_t room, rlim_t *allowed)
{
  struct rlimit limit;

  if (getrlimit(resource, &limit) || limit.rlim_cur >= room) return PETSC_FALSE; /* RLIM_INFINITY is the largest of all */
  *allowed       = limit.rlim_max;
  limit.rlim_cur = room;
  return (PetscBool)(*allowed < room || setrlimit(resource, &limit));
}

/* Files that the run opens are not taken for its screen where that is closed. */
static void OpenStandard_Private(void)
{
  int file = open("/dev/null", O_RDWR);

  while (file >= 0 && file <= STDERR_FILENO) file = dup(file);
  if (file >= 0) (void)close(file);
}

/* What PETSc, or this program, does not live through, said by one process of a job. */
static PetscBool Refused_Private(int argc, char **argv, PetscBool speaks)
{
  rlim_t allowed;
  char   here[PETSC_MAX_PATH_LEN], told[256] = "";

  if (Lacks_Private(RLIMIT_STACK, STACK_ROOM, &allowed)) {
    if (speaks) fprintf(stderr, "mortise: the stack may not grow beyond %ld kB (ulimit -s); %ld are needed\n", (long)(allowed >> 10), (long)(STACK_ROOM >> 10));
    return PETSC_TRUE;
  }
  if (Lacks_Private(RLIMIT_NOFILE, FILES_ROOM, &allowed)) {
    if (speaks) fprintf(stderr, "mortise: no more than %ld files may be open at a time (ulimit -n); %ld are needed\n", (long)allowed, (long)FILES_ROOM);
    return PETSC_TRUE;
  }
  if (!getcwd(here, sizeof(here))) {
    if (speaks) fprintf(stderr, "mortise: the working directory cannot be found: %s; start in one that is there\n", strerror(errno));
    return PETSC_TRUE;
  }
  if (!AppOptionsWrong(argc, argv, sizeof(told), told)) return PETSC_FALSE;
  if (speaks) (void)ErrorInput("-options_file: %s", told);
  return PETSC_TRUE;
}

/* PETSc passes over the words of PETSC_OPTIONS that are neither an option nor its value, so that one without its dash would not act. */
static PetscErrorCode Words_Private(void)
{
  const char *const given = getenv("PETSC_OPTIONS");
  char             *text, *at = NULL, told[80] = "";
  PetscBool         option, value = PETSC_FALSE; /* may the word be the value of the one before? */

  PetscFunctionBegin;
  if (!given) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrallocpy(given, &text));
  for (const char *word = strtok_r(text, " \t\r\n", &at); word && !told[0]; word = strtok_r(NULL, " \t\r\n", &at)) {
    PetscCall(PetscOptionsValidKey(word, &option));
    if (!option && !value) PetscCall(PetscStrncpy(told, word, sizeof(told)));
    value = option;
  }
  PetscCall(PetscFree(text));
  PetscCheckInput(!told[0], "PETSC_OPTIONS: '%s' is neither an option, which begins with '-', nor the value of one", told);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc's trap of floating-point exceptions would end every run at the first NaN that says "not there". */
static PetscErrorCode Trap_Private(void)
{
  PetscBool trap = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-fp_trap", &trap, NULL));
  if (trap) PetscCall(PetscSetFPTrap(PETSC_FP_TRAP_OFF));
  PetscCheckInput(!trap, "-fp_trap cannot act here: numbers that are none stand for what is not known, and libraries compute with infinities");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PetscInitialize with those settings when no launcher started this process; what the user has set wins. */
PetscErrorCode AppInitialize(int argc, char **argv)
{
  static char   **arguments;
  int             set[NUM_ALONE] = {0};
  const int       alone          = !getenv("OMPI_COMM_WORLD_SIZE") && !getenv("PMIX_RANK") && !getenv("PMI_RANK");
  const char     *rank           = getenv("OMPI_COMM_WORLD_RANK");
  const PetscBool speaks         = (PetscBool)(!rank || !strcmp(rank, "0"));
  PetscErrorCode  ierr;

  for (int i = 0; alone && i < NUM_ALONE; ++i) set[i] = !getenv(Alone[i][0]) && !setenv(Alone[i][0], Alone[i][1], 1);
  OpenStandard_Private();
  OneThread_Private();
  AppKernels();
  OneArena_Private();
  CheckRoom_Private(START_ROOM);
  arguments = Arguments_Private(&argc, argv);
  if (Refused_Private(argc, arguments, speaks)) {
    if (!speaks) ErrorLetSpeak();
    return MORTISE_ERR_INPUT;
  }
  PetscErrorCode (*const print)(const char[], ...) = PetscErrorPrintf;
  PetscErrorPrintf                                 = Keep_Private;
  ierr                                             = PetscInitialize(&argc, &arguments, NULL, NULL);
  if (PetscErrorPrintf == Keep_Private) PetscErrorPrintf = print; /* options may have set another one */
  if (ierr) return Tell_Private(ierr);
  for (int i = 0; i < NUM_ALONE; ++i) {
    if (set[i]) unsetenv(Alone[i][0]); /* programs we start (gmsh) do not inherit them */
  }
  TakeRoom_Private();
  TellFiles_Private(argc, argv);
  ierr = Words_Private();
  if (!ierr) ierr = Trap_Private();
  if (ierr) (void)PetscOptionsClear(NULL), (void)PetscFinalize();
  return ierr;
}
