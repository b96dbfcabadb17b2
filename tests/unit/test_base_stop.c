/* Requests to stop: none without a watch, a signal is heard once and stays, a second of its kind a second later would end the program, one at once does not.
   The order of the cases matters: a decision is never taken back. */
#include "base.h"
#include <cmocka.h>
#include <signal.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static void Silence(void **unused)
{
  PetscBool stop = PETSC_TRUE;

  assert_int_equal(StopAsked(PETSC_COMM_WORLD, &stop), 0);
  assert_false(stop);
  assert_int_equal(StopWatch(1000), 0);
  assert_int_equal(StopAsked(PETSC_COMM_WORLD, &stop), 0);
  assert_false(stop);
  assert_string_equal(StopReason(), "");
}

static void Signal(void **unused)
{
  struct sigaction now;
  struct timespec  later = {.tv_sec = 1, .tv_nsec = 100000000};
  PetscBool        stop;
  pid_t            child;
  int              status;

  assert_int_equal(raise(SIGUSR1), 0);
  assert_int_equal(raise(SIGUSR1), 0); /* as one */
  assert_int_equal(StopAsked(PETSC_COMM_WORLD, &stop), 0);
  assert_true(stop);
  assert_string_equal(StopReason(), "SIGUSR1");
  assert_int_equal(sigaction(SIGUSR1, NULL, &now), 0);
  assert_true(now.sa_handler != SIG_DFL);
  child = fork();
  if (!child) {
    (void)nanosleep(&later, NULL);
    (void)raise(SIGUSR1);
    _exit(0);
  }
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGUSR1);
  assert_int_equal(StopAsked(PETSC_COMM_WORLD, &stop), 0);
  assert_true(stop);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Silence), cmocka_unit_test(Signal)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
