/* Down on the energy: where Newton's method finds no equilibrium (solve/descent.c), and where it finds one that is unstable (solve/stable.c). */
#include "path.h"

PetscBool PathCanDescend(const Path *p, const State *guess)
{
  return SolverHasDescent(p->level->solver);
}

PetscErrorCode PathDescend(Path *p, const PathLoop *load, PetscReal to, const State *guess, SolverReport *report)
{
  Level     *l = p->level;
  PetscReal *from;

  PetscFunctionBegin;
  p->work = (StepWork){0};
  PetscCall(PathRestore(p, &l->accepted));
  PetscCall(PathFrom(p, &from));
  PetscCall(load->metric->set(p, load, to));
  PetscCall(SolverDescend(l->solver, &l->state, report));
  PathCount(p, report, PETSC_TRUE);
  PetscCall(PathFound(p, load, from, to, report));
  PetscCall(PetscFree(from));
  PetscCall(PetscInfo(NULL, "%" PetscInt_FMT " descents, %" PetscInt_FMT " factorisations: %s\n", report->descents, report->factorisations,
                      report->converged ? "found" : report->reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Back to the solution there was. */
static PetscErrorCode Keep_Private(Level *l, const State *unstable)
{
  PetscFunctionBegin;
  PetscCall(StateCopy(unstable, &l->state));
  PetscCall(ProblemSetState(l->problem, &l->state));
  PetscCall(ProblemSearch(l->problem, l->state.x));
  PetscCall(ProblemRefresh(l->problem, l->state.x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathStabilise(Path *p, PetscBool *changed)
{
  Level       *l     = p->level;
  const char  *words = NULL;
  PetscBool    again = PETSC_TRUE, neutral = PETSC_FALSE;
  PetscReal    fall       = 0;
  PetscInt     directions = PETSC_MAX_INT;
  SolverReport report;
  State        unstable;
  PetscReal   *from;

  PetscFunctionBegin;
  *changed = PETSC_FALSE;
  if (!p->unstable_now || !p->data->load.stable || !PathCanDescend(p, NULL)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StateCreate(l->problem, &unstable));
  PetscCall(StateCopy(&l->state, &unstable));
  PetscCall(PathFrom(p, &from));
  for (PetscInt i = 0; again; ++i) {
    PetscCall(SolverStabilise(l->solver, &l->state, &report));
    PetscCall(PetscInfo(NULL, "unstable equilibrium: %s\n", report.converged ? "another was found" : report.reason));
    if (report.converged) PetscCall(PathRefuse(p, from, &report, &words));
    if (i == 0) fall = report.fall, neutral = report.neutral;
    *changed         = (PetscBool)(report.converged && report.unstable == 0 && !words);
    again            = (PetscBool)(report.converged && report.unstable > 0 && report.unstable < directions && !words); /* less unstable each time */
    directions       = report.unstable;
    report.converged = *changed;
    PathCount(p, &report, PETSC_FALSE);
  }
  if (*changed) {
    p->unstable_now = PETSC_FALSE;
    if (p->stabilised++ == 0)
      PetscCall(PetscPrintf(
          ForestComm(l->forest),
          "note: the equilibrium found at t = %g is unstable; a stable one takes its place, there and where that happens again (load.stable); "
          "along the mode energy falls by %.2g %% of the strain energy; less than the mesh is off, as of a round body free to turn, means nothing\n",
          (double)l->state.t, (double)(100 * fall)));
  } else {
    PetscCall(Keep_Private(l, &unstable));
    p->unstable_now = (PetscBool)!neutral;
  }
  PetscCall(StateDestroy(&unstable));
  PetscCall(PetscFree(from));
  PetscFunctionReturn(PETSC_SUCCESS);
}
