/* Requests to stop: signals, and a limit of wall time. Signals belong to the process, so this is global; the handler only takes a note, and the ranks agree
   on it where they ask. */
#include "base.h"
#include <signal.h>
#include <time.h>

#define TIME_UP 1000 /* no signal has this number */

#define AT_ONCE 1 /* seconds: what asks twice within them, as `timeout` does (the process, then its group), means one request */

static volatile sig_atomic_t stop_signal;
static PetscBool             stop_watched;
static PetscLogDouble        stop_start;
static PetscReal             stop_seconds; /* 0: no limit */
static int                   stop_decided; /* by all ranks: signal or TIME_UP */
static PetscBool             stop_early;   /* before there was a mesh */

static const struct {
  int         number;
  const char *name;
  PetscBool   insists; /* another one of the kind after AT_ONCE ends the program */
} Signals[] = {
    {SIGTERM, "SIGTERM", PETSC_TRUE},  /* of kill, timeout and queues */
    {SIGUSR1, "SIGUSR1", PETSC_TRUE},  /* some time before the kill, of some queues … */
    {SIGUSR2, "SIGUSR2", PETSC_TRUE},  /* … and of others */
    {SIGINT, "SIGINT", PETSC_TRUE},    /* of the keyboard … */
    {SIGQUIT, "SIGQUIT", PETSC_TRUE},  /* … in earnest */
    {SIGHUP, "SIGHUP", PETSC_FALSE},   /* of terminal and shell, one after the other */
    {SIGXCPU, "SIGXCPU", PETSC_FALSE}, /* comes once a second */
    {SIGPIPE, "SIGPIPE", PETSC_FALSE}, /* at every line nobody reads */
};
static struct timespec stop_first[PETSC_STATIC_ARRAY_LENGTH(Signals)];   /* when the first of a kind came; 0: it has not */
static PetscBool       stop_ignored[PETSC_STATIC_ARRAY_LENGTH(Signals)]; /* before anything of ours and of libraries: as under nohup */

/* Calls nothing but what a handler may. */
static void Note_Private(int number)
{
  struct timespec now;

  stop_signal = number;
  if (clock_gettime(CLOCK_MONOTONIC, &now)) return;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Signals); ++i) {
    if (Signals[i].number != number || !Signals[i].insists) continue;
    const double since = (double)(now.tv_sec - stop_first[i].tv_sec) + 1e-9 * (double)(now.tv_nsec - stop_first[i].tv_nsec);
    if (!stop_first[i].tv_sec && !stop_first[i].tv_nsec)
      stop_first[i] = now;
    else if (since > AT_ONCE) {
      (void)signal(number, SIG_DFL);
      (void)raise(number); /* as soon as this handler is left */
    }
  }
}

static sigset_t Ours_Private(void)
{
  sigset_t ours;

  sigemptyset(&ours);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Signals); ++i) sigaddset(&ours, Signals[i].number);
  return ours;
}

void StopBegin(void)
{
  sigset_t         ours = Ours_Private();
  struct sigaction action;

  (void)signal(SIGCHLD, SIG_DFL); /* ignored, it would take from us how gmsh has ended */
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Signals); ++i)
    stop_ignored[i] = (PetscBool)(!sigaction(Signals[i].number, NULL, &action) && action.sa_handler == SIG_IGN);
  sigdelset(&ours, SIGPIPE);                 /* of -help cut short by `head` */
  (void)sigprocmask(SIG_BLOCK, &ours, NULL); /* MPI and PETSc have handlers of their own while they start */
}

void StopRelease(void)
{
  const sigset_t ours = Ours_Private();

  (void)sigprocmask(SIG_UNBLOCK, &ours, NULL); /* a starter that holds them back for itself does not mean us, either */
}

PetscErrorCode StopWatch(PetscReal seconds)
{
  struct sigaction action = {.sa_handler = Note_Private};

  PetscFunctionBegin;
  if (!stop_watched || stop_seconds == 0) PetscCall(PetscTime(&stop_start));
  stop_seconds = seconds;
  stop_watched = PETSC_TRUE;
  sigemptyset(&action.sa_mask);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Signals); ++i) {
    action.sa_handler = stop_ignored[i] ? SIG_IGN : Note_Private;
    action.sa_flags   = SA_RESTART;
    PetscCheck(!sigaction(Signals[i].number, &action, NULL), PETSC_COMM_SELF, PETSC_ERR_SYS, "sigaction failed for %s", Signals[i].name);
  }
  StopRelease();
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What this rank was asked: signal, TIME_UP or 0. */
static int Wish_Private(void)
{
  PetscLogDouble now = stop_start;

  if (stop_signal) return (int)stop_signal;
  (void)PetscTime(&now);
  return stop_watched && stop_seconds > 0 && now - stop_start >= stop_seconds ? TIME_UP : 0;
}

PetscErrorCode StopAsked(MPI_Comm comm, PetscBool *stop)
{
  int wish;

  PetscFunctionBegin;
  *stop = (PetscBool)(stop_decided != 0);
  if (!stop_watched || stop_decided) PetscFunctionReturn(PETSC_SUCCESS);
  wish = Wish_Private();
  PetscCallMPI(MPI_Allreduce(&wish, &stop_decided, 1, MPI_INT, MPI_MAX, comm));
  *stop = (PetscBool)(stop_decided != 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *Name_Private(int wish)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Signals); ++i) {
    if (wish == Signals[i].number) return Signals[i].name;
  }
  return wish == TIME_UP ? "-max_seconds" : "";
}

void StopEarly(void)
{
  stop_early = PETSC_TRUE;
}

PetscBool StopWasEarly(void)
{
  return stop_early;
}

void StopServed(void)
{
  sigset_t ours = Ours_Private();

  if (stop_signal) (void)sigprocmask(SIG_BLOCK, &ours, NULL);
}

const char *StopReason(void)
{
  return Name_Private(stop_decided);
}

const char *StopWish(void)
{
  return Name_Private(Wish_Private());
}
