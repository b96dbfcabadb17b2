/* Wrong input is told once, in one sentence; every other error keeps PETSc's traceback. */
#include "base.h"
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

/* What comes from files does not speak to the terminal. */
static void Print_Private(const char *format, va_list arguments)
{
  char line[8192];

  (void)vsnprintf(line, sizeof(line), format, arguments);
  for (unsigned char *c = (unsigned char *)line; *c; ++c) {
    if (*c == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0) *c = '?', c[1] = '?'; /* C1 in UTF-8 */
    if (*c >= 0xc0 && (c[1] & 0xc0) != 0x80) *c = '?';                   /* the beginning of a character that was cut */
    if (*c < ' ' || *c == 0x7f) *c = '?';
  }
  fprintf(stderr, "mortise: %s\n", line);
  fflush(stderr);
}

#define ECHO "%.80s"

/* The format with values, which stand in quotes or behind "is", cut at 80 characters: a file may have much of anything where a word is due. */
static void Cut_Private(const char *format, size_t capacity, char cut[])
{
  static const char *const value[] = {"'%s'", "\"%s\"", " is %s"};
  size_t                   used    = 0;

  while (*format && used + sizeof(ECHO) + 8 < capacity) {
    const char *found = NULL;
    for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(value); ++i) {
      if (!strncmp(format, value[i], strlen(value[i]))) found = value[i];
    }
    if (found) {
      const size_t before = strcspn(found, "%");
      used += (size_t)snprintf(cut + used, capacity - used, "%.*s%s", (int)before, found, ECHO);
      format += before + 2;
    } else
      cut[used++] = *format++;
  }
  (void)snprintf(cut + used, capacity - used, "%s", format);
}

PetscErrorCode ErrorInput(const char *format, ...)
{
  PetscMPIInt rank = 0, initialized = 0, finalized = 0;
  va_list     arguments;
  char        cut[4096];

  /* No PetscCall here: this is the origin of an error, and it must work before PetscInitialize as well. */
  MPI_Initialized(&initialized);
  MPI_Finalized(&finalized);
  if (initialized && !finalized) MPI_Comm_rank(PetscInitializeCalled ? PETSC_COMM_WORLD : MPI_COMM_WORLD, &rank);
  if (rank == 0) {
    va_start(arguments, format);
    Cut_Private(format, sizeof(cut), cut);
    Print_Private(cut, arguments);
    va_end(arguments);
  }
  return MORTISE_ERR_INPUT;
}

PetscBool ErrorIsPlain(PetscErrorCode code)
{
  return (PetscBool)(code == PETSC_ERR_FILE_WRITE || code == PETSC_ERR_FILE_OPEN || code == PETSC_ERR_MEM || ErrorIsOption(code));
}

PetscBool ErrorIsOption(PetscErrorCode code)
{
  return (PetscBool)(code == PETSC_ERR_ARG_UNKNOWN_TYPE || code == PETSC_ERR_MISSING_FACTOR);
}

static char asked[128]; /* what memory is being asked for */

void ErrorAsked(const char *format, ...)
{
  va_list arguments;

  va_start(arguments, format);
  (void)vsnprintf(asked, sizeof(asked), format, arguments);
  va_end(arguments);
}

/* PETSc tells of memory in its own code of errors only where malloc does: realloc gives a line number (3.18), posix_memalign an error of a library (3.26).
   Values that it cannot read of an option, viewers among them, have the codes of faults of a program; who reads them tells them apart. */
static PetscErrorCode Code_Private(const char *function, PetscErrorCode code)
{
  if (!function) return code;
  if (!strcmp(function, "PetscReallocAlign") || !strcmp(function, "PetscMallocAlign")) return PETSC_ERR_MEM;
  return !strncmp(function, "PetscOptions", 12) || !strcmp(function, "PetscLogView") ? PETSC_ERR_ARG_UNKNOWN_TYPE : code;
}

static void Say_Private(const char *format, ...)
{
  va_list arguments;

  va_start(arguments, format);
  Print_Private(format, arguments);
  va_end(arguments);
}

/* mpiexec ends all processes as soon as one has ended, one that is still about to speak among them. Its signal ends the wait. */
void ErrorLetSpeak(void)
{
  (void)sleep(1);
}

/* No fault of the program: a sentence will do, of the first process or of the one whose own matter it is. Options are those of all. */
static void Plain_Private(MPI_Comm comm, PetscErrorCode code, const char *message)
{
  PetscMPIInt rank = 0;

  if (ErrorIsOption(code)) comm = PETSC_COMM_WORLD;
  if (comm != PETSC_COMM_SELF) MPI_Comm_rank(comm, &rank);
  if (rank) {
    ErrorLetSpeak();
    return;
  }
  if (code == PETSC_ERR_MEM)
    Say_Private("out of memory%s%s: take a smaller problem, or more processes on more machines", asked[0] ? " for " : "", asked);
  else
    Say_Private("%s%.*s", ErrorIsOption(code) ? "an option of PETSc cannot act: " : "", (int)strcspn(message, "\n"), message);
}

static const char *foreseen;
static PetscBool   foreseen_met;

/* PETSc calls the handler once per PetscCall level, with PETSC_ERROR_REPEAT from the second on: the code alone decides, and whether the first words were
   foreseen. */
static PetscErrorCode ErrorHandler_Private(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code, PetscErrorType type,
                                           const char *message, void *context)
{
  if (code == MORTISE_ERR_INPUT) return code;
  if (type == PETSC_ERROR_INITIAL) code = Code_Private(function, code);
  if (foreseen && type == PETSC_ERROR_INITIAL && message && strstr(message, foreseen)) foreseen_met = PETSC_TRUE;
  if (foreseen_met) return code;
  if (ErrorIsPlain(code)) {
    if (type == PETSC_ERROR_INITIAL) Plain_Private(comm, code, message);
    return code;
  }
  return PetscTraceBackErrorHandler(comm, line, function, file, code, type, message, context);
}

PetscErrorCode ErrorHandlerPush(void)
{
  PetscFunctionBegin;
  PetscCall(PetscPushErrorHandler(ErrorHandler_Private, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ErrorForesee(const char *words)
{
  PetscFunctionBegin;
  foreseen     = words;
  foreseen_met = PETSC_FALSE;
  PetscCall(ErrorHandlerPush());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ErrorForeseen(PetscErrorCode code, PetscBool *met)
{
  *met         = foreseen_met;
  foreseen     = NULL;
  foreseen_met = PETSC_FALSE;
  PetscFunctionBegin;
  PetscCall(PetscPopErrorHandler());
  if (!*met) PetscCall(code);
  PetscFunctionReturn(PETSC_SUCCESS);
}
