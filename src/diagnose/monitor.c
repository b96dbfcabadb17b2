/* What a run prints: header, one line per adaptive pass and load step, closing lines. On a terminal a bar below the lines shows how far pseudo-time has come
   and how long the rest may take; into a file or a pipe nothing of it goes. */
#include "diagnoseimpl.h"
#include <petsctime.h>
#include <stdarg.h>
#include <sys/ioctl.h>
#include <unistd.h>

#define BAR_WIDTH 32

struct _p_Monitor {
  MPI_Comm         comm;
  PetscMPIInt      rank;
  const SceneData *scene;    /* borrowed */
  PetscBool        terminal; /* rank 0 only */
  PetscBool        shown;    /* the bar stands on the last line */
  PetscLogDouble   start;    /* of the run */
  PetscReal        t;        /* accepted pseudo-time */
};

PetscErrorCode MonitorCreate(MPI_Comm comm, const SceneData *scene, Monitor *monitor)
{
  Monitor m;

  PetscFunctionBegin;
  PetscCall(PetscNew(&m));
  m->comm  = comm;
  m->scene = scene;
  PetscCallMPI(MPI_Comm_rank(comm, &m->rank));
  m->terminal = (PetscBool)(m->rank == 0 && DiagnoseIsTerminal(PETSC_STDOUT));
  PetscCall(PetscTime(&m->start));
  *monitor = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Erase the bar, before something else is printed (no effect when there is none). */
static PetscErrorCode Hide_Private(Monitor m)
{
  PetscFunctionBegin;
  if (m->shown) {
    fputs("\r\033[K", PETSC_STDOUT);
    fflush(PETSC_STDOUT);
  }
  m->shown = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MonitorDestroy(Monitor *monitor)
{
  PetscFunctionBegin;
  if (!*monitor) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Hide_Private(*monitor));
  PetscCall(PetscFree(*monitor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- the bar ------------------------------------------------------------------------------------------------------------- */

/* A duration for people: 12 s, 3 min 20 s, 2 h 05 min. */
static void Duration_Private(PetscReal seconds, char text[], size_t size)
{
  const long s = (long)(seconds + 0.5);

  if (s < 60)
    snprintf(text, size, "%ld s", s);
  else if (s < 3600)
    snprintf(text, size, "%ld min %02ld s", s / 60, s % 60);
  else
    snprintf(text, size, "%ld h %02ld min", s / 3600, s % 3600 / 60);
}

static PetscInt TerminalWidth_Private(void)
{
  struct winsize size;

  return ioctl(fileno(PETSC_STDOUT), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/* Time left: the accepted part of pseudo-time taken for the part of the work done. The cursor stays at the start of the line, so that whatever else prints
   begins there. A line too long for the terminal would wrap and could not be erased: it is cut. */
static PetscErrorCode MonitorShow_Private(Monitor m)
{
  const PetscReal done = PetscMin(1., m->t / m->scene->load.end);
  PetscLogDouble  now;
  char            bar[BAR_WIDTH + 1], left[64] = "time left not known yet", spent[32], line[256];

  PetscFunctionBegin;
  if (!m->terminal) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&now));
  for (PetscInt i = 0; i < BAR_WIDTH; ++i) bar[i] = i < (PetscInt)(done * BAR_WIDTH + 0.5) ? '#' : '.';
  bar[BAR_WIDTH] = 0;
  Duration_Private(now - m->start, spent, sizeof(spent));
  if (done > 0) {
    char rest[32];
    Duration_Private((now - m->start) * (1 - done) / done, rest, sizeof(rest));
    snprintf(left, sizeof(left), "about %s left", rest);
  }
  snprintf(line, sizeof(line), "[%s] %3.0f %%, %s, %s", bar, 100 * (double)done, spent, left);
  fprintf(PETSC_STDOUT, "\r\033[K%.*s\r", (int)TerminalWidth_Private() - 1, line);
  fflush(PETSC_STDOUT);
  m->shown = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- lines --------------------------------------------------------------------------------------------------------------- */

/* Rank 0 prints (PetscPrintf would write 2 as "2."). */
static void Say_Private(Monitor m, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
static void Say_Private(Monitor m, const char *format, ...)
{
  va_list arguments;

  if (m->rank) return;
  va_start(arguments, format);
  vfprintf(PETSC_STDOUT, format, arguments);
  va_end(arguments);
  fflush(PETSC_STDOUT);
}

static const char *FileName_Private(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

PetscErrorCode MonitorHeader(Monitor m, Problem problem)
{
  const SceneData    *scene = m->scene;
  const ForestTables *t     = ForestGetTables(ProblemForest(problem));
  PetscInt            dofs, low = MORTISE_MAX_ORDER, high = 1;
  PetscMPIInt         size;
  char                orders[32], model[MORTISE_NAME];

  PetscFunctionBegin;
  dofs = ProblemNumDofs(problem);
  PetscCallMPI(MPI_Comm_size(m->comm, &size));
  const HPTables *v = HPSpaceGetTables(ProblemSpace(problem));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) { /* after -restart not those of the scene */
    if (scene->mechanics.bodies[t->leaf_body[v->cell_leaf[c]]].material->law->rigid) continue;
    low  = PetscMin(low, v->cell_order[c]);
    high = PetscMax(high, v->cell_order[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &low, 1, MPIU_INT, MPI_MIN, m->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &high, 1, MPIU_INT, MPI_MAX, m->comm));
  if (low >= high)
    snprintf(orders, sizeof(orders), "%d", (int)high);
  else
    snprintf(orders, sizeof(orders), "%d to %d", (int)low, (int)high);
  PetscCall(PetscStrncpy(model, ModelNames[scene->mechanics.model], sizeof(model)));
  for (char *c = model; *c; ++c) *c = *c == '_' ? ' ' : *c;
  Say_Private(m, "mortise " MORTISE_VERSION ": %s%s%s\n", scene->title, scene->title[0] ? ", " : "", FileName_Private(scene->file));
  Say_Private(m, "%s, %s kinematics, units of the scene; %" PetscInt_FMT " cells of order %s, %" PetscInt_FMT " dofs, %d %s\n", model,
              KinematicsNames[scene->mechanics.kinematics], t->num_leaves, orders, dofs, size, size == 1 ? "process" : "processes");
  Say_Private(m, "%5s %4s %11s %8s %9s %6s %6s %10s %12s %8s\n", "step", "pass", "t", "cells", "dofs", "newton", "active", "error",
              SceneNumPairs(scene) > 1 ? "sum |force|" : "|force|", "seconds");
  PetscCall(MonitorShow_Private(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MonitorResume(Monitor m, const char *file, const ReportRow *so_far)
{
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCall(Hide_Private(m));
  PetscCall(PetscTime(&now));
  m->start = now - so_far->seconds;
  m->t     = so_far->t;
  Say_Private(m, "goes on after load step %" PetscInt_FMT ", t = %g, from %s\n", so_far->step, (double)so_far->t, file);
  PetscCall(MonitorShow_Private(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MonitorAgain(Monitor m, PetscInt number, PetscInt cells, PetscReal error)
{
  PetscFunctionBegin;
  PetscCall(Hide_Private(m));
  m->t = 0;
  Say_Private(m, "pass %" PetscInt_FMT ": the path again from t = 0, on %" PetscInt_FMT " cells; the error before was up to %.3e\n", number, cells,
              (double)error);
  PetscCall(MonitorShow_Private(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MonitorRow(Monitor m, const ReportRow *row)
{
  char           error[16] = "-", force[16] = "-", end[80] = "";
  PetscLogDouble now;

  PetscFunctionBegin;
  PetscCall(Hide_Private(m));
  PetscCall(PetscTime(&now));
  m->start = now - row->seconds; /* the run began before its monitor: one clock for lines, bar and footer */
  if (!PetscIsNanReal(row->estimated_error)) snprintf(error, sizeof(error), "%.3e", (double)row->estimated_error);
  if (m->scene->num_contacts) snprintf(force, sizeof(force), "%.5e", (double)row->contact_force);
  if (row->accepted && row->step_cuts)
    snprintf(end, sizeof(end), "  accepted, %d %s", (int)row->step_cuts, row->step_cuts == 1 ? "cut" : "cuts");
  else if (row->accepted)
    snprintf(end, sizeof(end), "  accepted");
  if (row->set_cycles) {
    const size_t used = strlen(end);
    snprintf(end + used, sizeof(end) - used, "%s %d active-set %s", used ? "," : " ", (int)row->set_cycles, row->set_cycles == 1 ? "cycle" : "cycles");
  }
  if (row->frozen_segmentation) {
    const size_t used = strlen(end);
    snprintf(end + used, sizeof(end) - used, "%s frozen segmentation", used ? "," : " ");
  }
  Say_Private(m, "%5" PetscInt_FMT " %4" PetscInt_FMT " %11.5g %8" PetscInt_FMT " %9" PetscInt_FMT " %6" PetscInt_FMT " %6" PetscInt_FMT " %10s %12s %8.2f%s\n",
              row->step, row->pass, (double)row->t, row->cells, row->dofs, row->newton_iterations, row->active_nodes, error, force, (double)row->seconds, end);
  if (row->accepted) m->t = row->t;
  PetscCall(MonitorShow_Private(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MonitorFooter(Monitor m, const char *status, const char *reason, const char *adapt_stop, PetscBool checkpoint, const ReportRow *total,
                             const ReportRow *last)
{
  char spent[32], passes[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCall(Hide_Private(m));
  if (total->seconds < 60)
    snprintf(spent, sizeof(spent), "%.2f s", (double)total->seconds);
  else
    Duration_Private(total->seconds, spent, sizeof(spent));
  Say_Private(m, "%s%s%s: %" PetscInt_FMT " load %s to t = %g of %g, %" PetscInt_FMT " Newton %s, %" PetscInt_FMT " step %s, %" PetscInt_FMT " %s, %s\n",
              status, reason[0] ? ", " : "", reason, total->step, total->step == 1 ? "step" : "steps", (double)total->t, (double)m->scene->load.end,
              total->newton_iterations, total->newton_iterations == 1 ? "iteration" : "iterations", total->step_cuts, total->step_cuts == 1 ? "cut" : "cuts",
              total->factorisations, total->factorisations == 1 ? "factorisation" : "factorisations", spent);
  if (last) {
    if (PetscIsNanReal(last->estimated_error))
      Say_Private(m, "strain energy %.8g, error not estimated\n", (double)last->energy);
    else
      Say_Private(m, "strain energy %.8g, estimated error %.3g %% in the energy norm\n", (double)last->energy, 100 * (double)last->estimated_error);
  }
  if (adapt_stop && adapt_stop[0]) Say_Private(m, "adaptation ended: %s\n", adapt_stop);
  PetscCall(PetscSNPrintf(passes, sizeof(passes), "%s/passes.xdmf", m->scene->output.directory));
  Say_Private(m, "results in %s: summary.json, history.csv, adapt.csv%s%s%s\n", m->scene->output.directory, m->scene->output.fields ? ", fields.xdmf" : "",
              access(passes, F_OK) ? "" : ", passes.xdmf", checkpoint ? ", checkpoint.h5" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}
