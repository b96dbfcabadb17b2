/* What a run prints: lines alone into a pipe; on a terminal a bar below them that leaves no trace. */
#include "diagnose.h"
#include <poll.h>
#include <pty.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <unistd.h>

#include <cmocka.h>

static SceneData scene;

/* Append what is there to read to text. A terminal may hand out a little at a time. */
static void Drain(int in, char text[], size_t size)
{
  struct pollfd wait = {.fd = in, .events = POLLIN};
  size_t        used = strlen(text);

  while (poll(&wait, 1, 100) > 0 && wait.revents & POLLIN) {
    const ssize_t got = read(in, text + used, size - 1 - used);
    assert_true(got > 0);
    used += (size_t)got;
    text[used] = 0;
  }
}

/* Two passes and the accepted end of a run, all that needs no mesh. Output goes to a file descriptor; *mid: what had come before the footer. */
static void Talk(int out, int in, char mid[], char all[], size_t size)
{
  FILE           *before = PETSC_STDOUT;
  Monitor         m;
  ReportRow       row   = {.step = 1, .pass = 0, .cells = 12, .dofs = 34, .newton_iterations = 5, .t = 0.5, .estimated_error = NAN, .energy = 2, .seconds = 1};
  const ReportRow total = {.step = 1, .t = 0.5, .newton_iterations = 17, .step_cuts = 3, .factorisations = 40, .seconds = 2};

  PETSC_STDOUT = fdopen(out, "w");
  assert_int_equal(MonitorCreate(PETSC_COMM_SELF, &scene, &m), 0);
  assert_int_equal(MonitorRow(m, &row), 0);
  row.estimated_error = 0.0123;
  row.pass            = 1;
  row.accepted        = PETSC_TRUE;
  row.step_cuts       = 2;
  assert_int_equal(MonitorRow(m, &row), 0);
  all[0] = 0;
  Drain(in, all, size);
  strcpy(mid, all);
  assert_int_equal(MonitorFooter(m, "failed", "a reason", NULL, PETSC_TRUE, &total, &row), 0);
  assert_int_equal(MonitorDestroy(&m), 0);
  Drain(in, all, size);
  fclose(PETSC_STDOUT);
  PETSC_STDOUT = before;
}

/* The screen after a stream of characters: \r, \n and "erase to the end of the line" are all the monitor may use. */
static void Screen(const char *stream, char screen[][256], int *lines)
{
  int column = 0, line = 0;

  memset(screen, 0, 32 * 256);
  for (const char *c = stream; *c; ++c) {
    if (*c == '\r')
      column = 0;
    else if (*c == '\n')
      ++line, column = 0;
    else if (!strncmp(c, "\033[K", 3)) {
      memset(screen[line] + column, 0, 256 - (size_t)column);
      c += 2;
    } else {
      assert_true(*c >= ' ' && line < 31 && column < 255);
      screen[line][column++] = *c;
    }
  }
  *lines = line;
}

static void PipeHasLinesOnly(void **state)
{
  int  ends[2];
  char mid[4096], all[4096];

  assert_int_equal(pipe(ends), 0);
  Talk(ends[1], ends[0], mid, all, sizeof(all));
  close(ends[0]);
  assert_null(strchr(all, '\r'));
  assert_null(strchr(all, '\033'));
  assert_null(strstr(all, "###"));
  assert_non_null(strstr(all, "accepted, 2 cuts\n"));
  assert_non_null(strstr(all, "1.230e-02"));
  assert_non_null(strstr(all, "failed, a reason: 1 load step to t = 0.5 of 2, 17 Newton iterations, 3 step cuts, 40 factorisations, 2.00 s\n"));
  assert_non_null(strstr(all, "estimated error 1.23 %"));
  assert_non_null(strstr(all, "results in out/x: "));
  assert_non_null(strstr(all, ", checkpoint.h5"));
}

static void TerminalHasABar(void **state)
{
  struct winsize window = {.ws_row = 24, .ws_col = 70};
  int            ends[2], lines;
  char           mid[4096], all[4096], screen[32][256];

  setenv("TERM", "xterm", 1);
  assert_int_equal(openpty(&ends[0], &ends[1], NULL, NULL, &window), 0);
  Talk(ends[1], ends[0], mid, all, sizeof(all));
  close(ends[0]);
  Screen(mid, screen, &lines);
  assert_int_equal(lines, 2);
  assert_non_null(strstr(screen[2], "[########........................]  25 %"));
  assert_non_null(strstr(screen[2], "left"));
  assert_true(strlen(screen[2]) < 70);
  Screen(all, screen, &lines);
  assert_int_equal(lines, 5);
  for (int i = 0; i <= lines; ++i) assert_null(strchr(screen[i], '#'));
  assert_non_null(strstr(screen[2], "failed, a reason"));
  assert_int_equal(screen[5][0], 0);
}

static void DumbTerminalHasNone(void **state)
{
  int  ends[2];
  char mid[4096], all[4096];

  setenv("TERM", "dumb", 1);
  assert_int_equal(openpty(&ends[0], &ends[1], NULL, NULL, NULL), 0);
  Talk(ends[1], ends[0], mid, all, sizeof(all));
  close(ends[0]);
  assert_null(strstr(all, "\033"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(PipeHasLinesOnly), cmocka_unit_test(TerminalHasABar), cmocka_unit_test(DumbTerminalHasNone)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  scene.load.end = 2;
  strcpy(scene.output.directory, "out/x");
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize()) return 1;
  return failed;
}
