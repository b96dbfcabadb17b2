/* Floor 0. What every module may lean on: input errors, timers with log events, expressions, small dense algebra. */
#pragma once
#include "compat.h"

#define MORTISE_VERSION "0.1.0"
#define MORTISE_MAX_ORDER 8 /* highest polynomial order of a cell */
#define MORTISE_NAME 64

/* Thresholds that several places share; all of them: docs/thresholds.md. */
#define ROUND_LENGTH 1e-6 /* of a length, an area, a cosine: what round-off of the coordinates in a mesh file leaves */
#define STEEP 0.7         /* cosine of 45 degrees and a little: of two faces at right angles one at least is nearer; at 45 degrees round-off does not choose */

/* ---- input errors (base/error.c) ------------------------------------------------------------------------------- */

/* Error code of wrong user input: main turns it into exit status 1 without a traceback. */
#define MORTISE_ERR_INPUT PETSC_ERR_USER_INPUT

/* Record one sentence about wrong input, printed once by rank 0 as "mortise: <sentence>", and return MORTISE_ERR_INPUT.
   Every rank must come here alike (input is replicated). Use: PetscCheckInput(cond, "…", …). */
PetscErrorCode ErrorInput(const char *format, ...) PETSC_ATTRIBUTE_FORMAT(1, 2);
#define PetscCheckInput(cond, ...)                                                                                                                             \
  do {                                                                                                                                                         \
    if (PetscUnlikely(!(cond))) return ErrorInput(__VA_ARGS__);                                                                                                \
  } while (0)

/* Levenshtein distance of what somebody wrote and a name, of at most 255 characters each (1000 beyond); whatever the name goes on with counts 2, for names are
   cut short. And the nearest of num > 0 names, the first of several. */
PetscInt    NameDistance(const char *written, const char *name);
const char *NameNearest(const char *name, PetscInt num, const char *const names[]);

/* Is it without control characters, C1 in UTF-8 included, but for those allowed? They would speak to the terminal. */
PetscBool TextIsPlain(const char *text, const char *allowed);

/* Append to a text in an array of capacity bytes; what has no room is cut. PetscStrlcat, when it has to cut, writes beyond the array: by one byte in PETSc
   3.26, by more in 3.18. */
void TextAppend(size_t capacity, char text[], const char *more);

/* -help: its text, and rows of a key or option: a name, what it may be, and on a line of its own what it means. After HelpSeek(word) no text, and those rows
   alone that have the word in their name; HelpShown: how many. "." and "_" are the same there, "-" before the word does not count; "": everything. The word is
   borrowed, a text has 4095 characters at most. Text and rows are collective. */
void           HelpSeek(const char *word);
PetscInt       HelpShown(void);
PetscErrorCode HelpText(MPI_Comm, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PetscErrorCode HelpRow(MPI_Comm, const char *name, const char *allowed, const char *text);

/* Install the error handler that keeps quiet about input errors and prints PETSc's traceback for all others. */
PetscErrorCode ErrorHandlerPush(void);
/* What memory is asked for from now on, in few words that follow "out of memory for ": the size of a mesh, of a problem. Not collective. */
void ErrorAsked(const char *format, ...) PETSC_ATTRIBUTE_FORMAT(1, 2);
/* Errors of the machine (files that cannot be written, memory): told in one sentence, like input errors, though the run ends as after any other error. */
PetscBool ErrorIsPlain(PetscErrorCode);
/* Of options of PETSc that name a type or a solver that is not there: plain, and wrong input. */
PetscBool ErrorIsOption(PetscErrorCode);
/* By the processes of a job that leave the words to another one, before they end: a second, or less if that one has ended the job. */
void ErrorLetSpeak(void);
/* Between the two an error of PETSc whose message has these words is no end but an answer: *met, without a word on the screen; any other returns from the
   second call as ever. code: what the call in question returned, without PetscCall around it; it must return the same on all ranks. No nesting. */
PetscErrorCode ErrorForesee(const char *words);
PetscErrorCode ErrorForeseen(PetscErrorCode code, PetscBool *met);

/* Warn of something that has not stopped the run (base/warning.c): printed as "warning: <text>", kept for summary.json; the same text only once. The text is
   the same on every rank. Collective. */
PetscErrorCode WarningAdd(MPI_Comm, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
const char    *WarningText(PetscInt i); /* the i-th so far, from 0; NULL: there are no more */
void           WarningForget(void);     /* those so far are of a run that begins anew */

/* Between the two a signal that a library raises over the numbers of a file (SIGSEGV, SIGABRT, …) ends the process with exit status 1 and this sentence
   (base/guard.c). No nesting. */
void GuardBegin(const char *format, ...) PETSC_ATTRIBUTE_FORMAT(1, 2);
void GuardEnd(void);

/* ---- stages (base/log.c): a PetscLogEvent and accumulated wall seconds each ------------------------------------- */

typedef enum {
  STAGE_MESH,
  STAGE_SETUP,
  STAGE_ASSEMBLE,
  STAGE_CONDENSE, /* inside assemble */
  STAGE_CONTACT,
  STAGE_FACTOR,
  STAGE_SOLVE,
  STAGE_ESTIMATE,
  STAGE_TRANSFER,
  STAGE_OUTPUT,
  NUM_STAGES
} Stage;
extern const char *const StageNames[NUM_STAGES]; /* keys of "time" in summary.json */
PetscErrorCode           StageRegister(void);
PetscErrorCode           StageBegin(Stage);
PetscErrorCode           StageEnd(Stage);
PetscReal                StageSeconds(Stage);
PetscErrorCode           StageAdd(Stage, PetscReal seconds); /* time of an earlier run that this one continues */

/* ---- requests to stop (base/stop.c) ------------------------------------------------------------------------------ */

/* First of all in a program: signals that are ignored now, as under nohup, stay so, and requests to stop wait until StopWatch, or StopRelease where nothing
   watches. */
void StopBegin(void);
void StopRelease(void);
/* From now on SIGTERM, SIGUSR1, SIGUSR2, SIGINT, SIGQUIT, SIGHUP, SIGXCPU, SIGPIPE and (seconds > 0) this much wall time are requests to stop; a second one of
   the first five more than a second after the first does what it always did. */
PetscErrorCode StopWatch(PetscReal seconds);
/* Is there such a request on any rank of comm? It stays. Never without StopWatch. Collective. */
PetscErrorCode StopAsked(MPI_Comm comm, PetscBool *stop);
/* At the very end: a run that was stopped by a signal has done what was asked, and hears no more of them; others do. */
void StopServed(void);
/* The run ends before there is anything to go on from; its error is told like wrong input, its exit status is 3. Of all ranks, not collective. */
void        StopEarly(void);
PetscBool   StopWasEarly(void);
const char *StopReason(void); /* name of the signal, or -max_seconds; "": nobody asked */
const char *StopWish(void);   /* the same, of a request to this rank that the others need not know of yet. Not collective. */

/* ---- checksums (base/hash.c) --------------------------------------------------------------------------------------- */

/* Hash of num bytes, to go on from an earlier one (seed 0: begin). Bytes that differ in one place never have the same. */
uint64_t HashBytes(uint64_t seed, const void *bytes, size_t num);

/* ---- arrays (base/array.c) ----------------------------------------------------------------------------------------- */

/* The first place of a sorted array whose entry is not less than the key, num: all are less. compare as for qsort, the entry first. */
PetscInt SortedFrom(const void *key, const void *array, PetscInt num, size_t entry, int (*compare)(const void *, const void *));

/* A row on its way to a matrix: indices and values, room for the longest one so far. Zero: none yet. */
typedef struct {
  PetscInt   size;
  PetscInt  *index;
  PetscReal *value;
} RowBuffer;
PetscErrorCode RowBufferGrow(RowBuffer *, PetscInt num); /* what it holds is lost where it grows */
PetscErrorCode RowBufferDestroy(RowBuffer *);
/* Make room for num entries of *array, *size are there; contents are kept. */
PetscErrorCode ArrayGrow(PetscInt num, size_t entry, PetscInt *size, void *array);
/* PetscFree of each of `num` arrays, given by the addresses of the pointers to them. */
PetscErrorCode FreeAll(PetscInt num, void *const pointer[]);

/* ---- messages between few of many ranks (base/sparse.c) ---------------------------------------------------------- */

/* Message i, entries first[i] .. first[i+1] of `entry` bytes each of `send`, goes to rank to[i] (not this one; no message is empty); nobody else knows of it
   beforehand. *received: what others sent here, by ascending rank, num_received entries; the caller frees it. Collective. */
PetscErrorCode SparseExchange(MPI_Comm, PetscMPIInt num_to, const PetscMPIInt to[], const PetscInt first[], size_t entry, const void *send,
                              PetscInt *num_received, void *received);

/* Entries of `entry` bytes each of all ranks, by ascending rank, on every one of them; the caller frees *all. Collective. */
PetscErrorCode GatherAll(MPI_Comm, PetscInt num, size_t entry, const void *mine, PetscInt *num_all, void *all);

/* Of matrices and vectors, in one call; several vectors at once. Collective. */
static inline PetscErrorCode MatAssemble(Mat A, MatAssemblyType type)
{
  PetscFunctionBegin;
  PetscCall(MatAssemblyBegin(A, type));
  PetscCall(MatAssemblyEnd(A, type));
  PetscFunctionReturn(PETSC_SUCCESS);
}
static inline PetscErrorCode VecAssemble(Vec x)
{
  PetscFunctionBegin;
  PetscCall(VecAssemblyBegin(x));
  PetscCall(VecAssemblyEnd(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
PetscErrorCode VecDuplicateAll(Vec, PetscInt num, Vec *const to[]);
PetscErrorCode VecDestroyAll(PetscInt num, Vec *const x[]);

/* What the rank with the largest value has, the first of these: its `size` bytes, on every one. Collective. */
PetscErrorCode BroadcastLargest(MPI_Comm, PetscReal value, void *bytes, size_t size);
/* The first rank of which `mine` holds; -1: of none. Collective. */
PetscErrorCode RankFirst(MPI_Comm, PetscBool mine, PetscMPIInt *first);

/* ---- expressions in X, Y, Z, t (base/expression.c, on muParser) -------------------------------------------------- */

typedef struct _p_Expression *Expression;

/* Parse a number or an expression in X, Y, Z (reference position), t (pseudo-time) and pi. key names the scene key in messages.
   A text that is no expression is an input error that quotes key, text and the parser's reason. */
PetscErrorCode ExpressionCreate(const char *key, const char *text, Expression *);
PetscErrorCode ExpressionEvaluate(Expression, const PetscReal X[3], PetscReal t, PetscReal *value);
/* A value that its key does not allow, told as one that is not finite is (ExpressionTrouble). */
PetscErrorCode ExpressionRefuse(Expression, PetscReal t, PetscReal value, const char *allowed);
/* Was a value not finite, or refused, since this was last asked? Then a sentence that says which and where, which lives until it is asked again; else NULL.
 * Collective. */
PetscErrorCode ExpressionTrouble(MPI_Comm, const char **words);
PetscBool      ExpressionUsesTime(Expression);  /* t occurs in it */
PetscBool      ExpressionUsesPlace(Expression); /* X, Y or Z */
const char    *ExpressionText(Expression);      /* as given; borrowed */
PetscErrorCode ExpressionDestroy(Expression *);

/* Piecewise linear amplitude in t; num = 0 means the ramp 0,0 1,1. Constant beyond its ends, but for a ramp without end. */
typedef struct {
  PetscInt   num;     /* number of (t, value) pairs */
  PetscReal *pairs;   /* [num][2], owned */
  PetscBool  endless; /* the first and the last piece go on (of arc_length, whose t is found) */
} Amplitude;
PetscReal AmplitudeEvaluate(const Amplitude *, PetscReal t);
PetscReal AmplitudeNext(const Amplitude *, PetscReal t); /* the first of its times after t; PETSC_MAX_REAL: none */

/* ---- small dense algebra (base/tensor.c and inline) -------------------------------------------------------------- */

static inline PetscReal Det3(const PetscReal F[9])
{
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}
static inline PetscReal Dot3(const PetscReal a[3], const PetscReal b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b; c is none of them. */
static inline void Cross3(const PetscReal a[3], const PetscReal b[3], PetscReal c[3])
{
  for (int i = 0; i < 3; i++) c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* x = A^-1 b, A by rows, by cofactors, which need no pivots. False, x as it was: det A is zero, or not a number. */
static inline PetscBool Solve3(const PetscReal A[9], const PetscReal b[3], PetscReal x[3])
{
  const PetscReal det = Det3(A);
  PetscReal       cofactor[3][3];

  if (!(PetscAbsReal(det) > 0)) return PETSC_FALSE;
  for (int i = 0; i < 3; i++) Cross3(A + 3 * ((i + 1) % 3), A + 3 * ((i + 2) % 3), cofactor[i]);
  for (int i = 0; i < 3; i++) x[i] = (cofactor[0][i] * b[0] + cofactor[1][i] * b[1] + cofactor[2][i] * b[2]) / det;
  return PETSC_TRUE;
}

/* ---- sets that grow together: parent[i] leads to i's representative, which is its own parent ------------------------ */

static inline PetscInt GroupRoot(PetscInt parent[], PetscInt i)
{
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/* ---- lanes: several numbers in one register, each of another point or cell (GCC vector extension, portable) --------- */

#pragma GCC diagnostic ignored "-Wpsabi" /* lanes never cross a translation unit by value */
#define NUM_LANES 8
typedef PetscReal Lanes __attribute__((vector_size(NUM_LANES * sizeof(PetscReal)), may_alias));
typedef PetscReal LanesAny __attribute__((vector_size(NUM_LANES * sizeof(PetscReal)), may_alias, aligned(sizeof(PetscReal)))); /* in memory of any alignment */
