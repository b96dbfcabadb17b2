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
  PetscCall(PathRestore(p, PathWasUnstable(p, guess) ? guess : &l->accepted));
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

/* From one unstable equilibrium, level->state, to the next while they are so in fewer directions each time. *stable: the last one is (or neutral). fall: of
   the energy along the first mode. neutral: the first one was no more than that. */
static PetscErrorCode Leave_Private(Path *p, PetscReal *fall, PetscBool *neutral, PetscBool *stable)
{
  Level       *l          = p->level;
  const char  *refused    = NULL;
  PetscInt     directions = PETSC_MAX_INT;
  PetscReal   *from;
  SolverReport report;

  PetscFunctionBegin;
  *stable = PETSC_FALSE;
  PetscCall(PathFrom(p, &from));
  for (PetscInt i = 0;; ++i) {
    PetscCall(SolverStabilise(l->solver, &l->state, &report));
    PetscCall(PetscInfo(NULL, "unstable equilibrium: %s\n", report.converged ? "another was found" : report.reason));
    if (i == 0) *fall = report.fall, *neutral = report.neutral;
    if (report.converged) PetscCall(PathRefuse(p, from, &report, &refused));
    *stable = (PetscBool)(!refused && (report.converged ? report.unstable == 0 : i > 0 && report.neutral));
    PathCount(p, &report, PETSC_FALSE);
    if (!report.converged || refused || *stable || report.unstable >= directions) break;
    directions = report.unstable;
  }
  if (*stable && report.neutral) PetscCall(PathRefresh(p));
  PetscCall(PetscFree(from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In how many directions is it unstable, where the factors at hand do not tell: of a tangent that is not symmetric, or without an energy to fall. Where the
   sign of the determinant is all there is, an eigenvalue that is round-off, as of a body that is free to turn, makes it nothing. */
static PetscErrorCode Count_Private(Path *p)
{
  Level    *l = p->level;
  PetscReal stiffness;
  PetscBool known;
  PetscInt  num;

  PetscFunctionBegin;
  PetscCall(SolverCountUnstable(l->solver, &l->state, &num));
  if (num < 0 && p->unstable_now != 1) PetscFunctionReturn(PETSC_SUCCESS);
  if (num >= 0)
    p->unstable_now = num;
  else {
    PetscCall(SolverLowestMode(l->solver, &l->state, &stiffness, NULL, &known));
    if (known && stiffness == 0) p->unstable_now = 0;
  }
  PetscCall(PathRefresh(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathStabilise(Path *p, PetscBool *changed)
{
  Level        *l      = p->level;
  ProblemStatus status = p->status;
  PetscInt      directions;
  PetscBool     neutral;
  PetscReal     fall;
  State         unstable;

  PetscFunctionBegin;
  *changed = PETSC_FALSE;
  if (!SolverIsSymmetric(l->solver) || (p->unstable_now && !PathCanDescend(p, NULL))) PetscCall(Count_Private(p));
  if (!p->unstable_now || !p->data->load.stable || !PathCanDescend(p, NULL)) PetscFunctionReturn(PETSC_SUCCESS);
  directions = p->unstable_now;
  PetscCall(StateCreate(l->problem, &unstable));
  PetscCall(StateCopy(&l->state, &unstable));
  PetscCall(Leave_Private(p, &fall, &neutral, changed));
  if (*changed) {
    p->unstable_now = 0;
    p->stabilised_t = l->state.t;
    if (p->stabilised++ == 0)
      PetscCall(PetscPrintf(
          ForestComm(l->forest),
          "note: the equilibrium found at t = %g is unstable; a stable one takes its place, there and where that happens again (load.stable); "
          "along the mode energy falls by %.2g %% of the strain energy; less than the mesh is off, as of a round body free to turn, means nothing\n",
          (double)l->state.t, (double)(100 * fall)));
  } else {
    PetscCall(PathReturn(p, &unstable, &status));
    p->unstable_now = neutral ? 0 : directions;
  }
  PetscCall(StateDestroy(&unstable));
  PetscFunctionReturn(PETSC_SUCCESS);
}
