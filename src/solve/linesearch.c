/* Modifier: steps that go too far. Along a linear step du the residual does the work g(s) = du . R(u + s du), which is
   negative at its start and would be 0 at its end. Where bodies answer more stiffly on the way than their tangent said
   (flow that turns, cells that are squeezed), g is positive there: balance along the step was left behind, and the next
   one comes back as far. Such a step is shortened to where little is left of g [Matthies & Strang 1979]. Contact forces
   take no part, for linearised gaps of active nodes do not change along the step. */
#include "solveimpl.h"

#define LITTLE 0.5 /* share of the work, or of the residual, that may be left */
#define TRIALS 6

PetscErrorCode SolverSlope_Private(Solver s, Vec r, Vec dx, PetscReal *slope)
{
  PetscReal pending;

  PetscFunctionBegin;
  *slope = 0;
  PetscCall(ProblemPending(s->problem, &pending));
  if (pending == 0) PetscCall(ProblemWork(s->problem, r, dx, slope));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SolverInside_Private(const PetscReal s[2], const PetscReal g[2])
{
  const PetscReal share = g[0] / (g[0] - g[1]);

  return s[0] + PetscMax(0.1, PetscMin(0.9, share)) * (s[1] - s[0]);
}

/* slope: at the start of the step, 0 where motion was prescribed on the way. */
static PetscErrorCode Shorten_Private(Solver s, const Iterate *it, Vec dx, PetscReal slope, PetscReal *step, PetscBool *acts)
{
  PetscReal at[2] = {0, *step}, g[2] = {slope, 0}, norm, now;

  PetscFunctionBegin;
  if (slope >= 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt trial = 0; trial < TRIALS; ++trial) {
    PetscCall(VecNorm(it->r, NORM_2, &norm));
    PetscCall(SolverSlope_Private(s, it->r, dx, &now));
    if (norm <= LITTLE * it->norm || PetscAbsReal(now) <= -LITTLE * slope) break;
    if (now < 0 && !*acts) break; /* not too far */
    at[now > 0] = *step;
    g[now > 0]  = now;
    *acts       = PETSC_TRUE;
    *step       = SolverInside_Private(at, g);
    PetscCall(PetscInfo(s->snes, "step %g goes too far, work %g after %g: %g\n", (double)at[1], (double)g[1], (double)slope, (double)*step));
    PetscCall(ProblemStepMove(s->problem, dx, *step, it->x));
    PetscCall(SNESComputeFunction(s->snes, it->x, it->r));
    if (s->report->status.bad) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierLineSearch = {"line_search", "a step at whose end forces along it point back is shortened to where they balance",
                                     .shorten = Shorten_Private};
