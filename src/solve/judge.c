/* When is an iterate the solution? */
#include "solveimpl.h"
#include <float.h>
#include <petsc/private/snesimpl.h>

/* What a cell of incompressible material may gain or lose of its volume, whatever the forces: where prescribed motion
   leaves it no choice, pressures grow without bounds, and next to them every residual is small. */
#define VOLUME 1e-8

PetscReal SolverTolerance_Private(const Solver s, const ProblemStatus *status)
{
  return PetscMax(s->rtol * status->scale, status->noise);
}

/* Norms are roots of sums of squares: of forces whose squares are no numbers they judge nothing. */
static PetscErrorCode IsJudged_Private(Solver s, const Iterate *it, PetscBool *yes)
{
  const ProblemStatus *status  = &s->report->status;
  PetscReal            largest = 0; /* a norm of 0 may be one of squares that vanish */

  PetscFunctionBegin;
  if (SolverTolerance_Private(s, status) < PetscSqrtReal(DBL_MIN)) PetscCall(VecNorm(it->r, NORM_INFINITY, &largest));
  *yes = (PetscBool)(!PetscIsInfOrNanReal(status->scale) && largest == 0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The residual is small against the nodal forces, or down at the round-off of an unloaded body; or as small as
   -snes_atol or -snes_rtol ask. */
static PetscBool Small_Private(const Solver s, const ProblemStatus *status, PetscReal norm)
{
  return (PetscBool)(norm <= PetscMax(SolverTolerance_Private(s, status), PetscMax(s->snes->abstol, s->snes->rtol * s->course.first_norm)));
}

static PetscBool KeepsVolume_Private(const Solver s)
{
  return (PetscBool)(s->report->status.volume <= PetscMax(VOLUME, s->rtol));
}

const char *SolverWords_Private(const Solver s, PetscReal norm, const char *usual)
{
  return Small_Private(s, &s->report->status, norm) && !KeepsVolume_Private(s) ? "incompressible material cannot keep its volume" : usual;
}

/* Are the forces of the element pressures that Newton's method has found in balance, and are they those that x implies?
   Round-off of the displacements times the bulk modulus is in those of the pressures that x implies, down to which the
   iteration ends, but not in these, so that they tell whether its last step was small. A pressure that is constant in
   a body held all around has no residual: there the forces of its cells tell that it is not that of x. */
static PetscErrorCode Balanced_Private(Solver s, Vec x, PetscBool *yes)
{
  ProblemStatus status;
  PetscReal     norm;

  PetscFunctionBegin;
  PetscCall(ProblemResidual(s->problem, x, s->pressure, s->balance, &status));
  PetscCall(VecNorm(s->balance, NORM_2, &norm));
  const ProblemStatus *implied = &s->report->status;
  const PetscReal      apart   = PetscAbsReal(status.scale - implied->scale);
  const PetscReal      most    = PetscMax(PetscSqrtReal(s->rtol) * PetscMax(status.scale, implied->scale), implied->noise);
  *yes                         = (PetscBool)(Small_Private(s, &status, norm) && apart <= most);
  PetscCall(PetscInfo(s->snes, "with the element pressures found: %g of %g, %g off those implied\n", (double)norm, (double)status.scale, (double)apart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Was the last step as small as -snes_stol asks? */
static PetscErrorCode StepIsSmall_Private(Solver s, const Iterate *it, PetscBool *yes)
{
  PetscReal step, x;

  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  if (s->snes->stol <= 0 || it->number == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecNorm(s->snes->vec_sol_update, NORM_2, &step));
  PetscCall(VecNorm(it->x, NORM_2, &x));
  *yes = (PetscBool)(step < s->snes->stol * x);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverConverged_Private(Solver s, const Iterate *it, SNESConvergedReason *reason)
{
  PetscReal pending;
  PetscBool judged, small, step;

  PetscFunctionBegin;
  PetscCall(IsJudged_Private(s, it, &judged));
  *reason = judged ? SNES_CONVERGED_ITERATING : SNES_DIVERGED_FNORM_NAN;
  if (!judged) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemPending(s->problem, &pending));
  if (pending > 0 || !KeepsVolume_Private(s)) PetscFunctionReturn(PETSC_SUCCESS);
  small = Small_Private(s, &s->report->status, it->norm);
  if (small && s->balance) PetscCall(Balanced_Private(s, it->x, &small));
  PetscCall(StepIsSmall_Private(s, it, &step));
  if (small || step) *reason = small ? SNES_CONVERGED_FNORM_RELATIVE : SNES_CONVERGED_SNORM_RELATIVE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
