/* From an unstable equilibrium to a stable one. The inertia of its tangent tells that it is unstable (inertia.c); Newton's method finds it as it finds others,
   and a body that buckles would stay straight. Along the eigenvector of the lowest eigenvalue the energy falls to both sides: down on the side that is lower,
   and from there to a minimum (descent.c). The start of the iteration for the eigenvector is a function of the reference positions, so that the side is the
   same on any number of ranks where both are equal, as for a body that may buckle either way. Where that eigenvalue is not below zero but by round-off, as of a
   body that is free to slide or turn, or nothing is strained, the equilibrium is neutral and not unstable. */
#include "solveimpl.h"

#define DOUBLINGS 40

static PetscErrorCode Start_Private(Descent *d)
{
  const HPTables *v = HPSpaceGetTables(ProblemSpace(d->problem));
  PetscReal      *local;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &local));
  SolverWithoutSymmetry_Private(v, local);
  PetscCall(VecSet(d->gradient, 0));
  PetscCall(ProblemSetDisplacement(d->problem, local, d->gradient));
  PetscCall(PetscFree(local));
  PetscCall(ProblemMeritSide(d->problem, d->gradient, NULL, d->rhs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Apply_Private(void *descent, PetscBool again, PetscBool *ok)
{
  PetscFunctionBegin;
  PetscCall(DescentApply_Private((Descent *)descent, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dx is the eigenvector of the lowest eigenvalue of H against D, which is as large as the rows' entries, *curvature = dx . H dx, of the displacements that the
   matrix knows, 0 where it is round-off of H. The factor, of H + shift D, is there. */
static PetscErrorCode Lowest_Private(Descent *d, PetscReal *curvature, PetscBool *ok)
{
  Lowest low;

  PetscFunctionBegin;
  *curvature = 0;
  PetscCall(Start_Private(d));
  PetscCall(DescentApply_Private(d, ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecSet(d->gradient, 0)); /* nothing acts inside cells */
  PetscCall(ProblemMeritSide(d->problem, d->gradient, NULL, d->rhs));
  PetscCall(VecPointwiseMult(d->rhs, d->diagonal, d->y));
  PetscCall(SolverInverseIteration_Private(Apply_Private, d, d->diagonal, d->rhs, d->y, &low, ok));
  const PetscReal lowest = low.theta - d->shift;
  if (PetscAbsReal(lowest) > low.round_off) *curvature = lowest * low.norm2;
  PetscCall(PetscInfo(d->ksp, "lowest eigenvalue %g, shift %g\n", (double)lowest, (double)d->shift));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lowest of Phi at +- first, 2 first, 4 first, … along dx as long as it falls; step 0: it does not. */
static PetscErrorCode Side_Private(Descent *d, Vec x, PetscReal first, PetscReal *step, PetscReal *merit)
{
  PetscReal next;

  PetscFunctionBegin;
  *merit = d->merit;
  *step  = 0;
  for (PetscInt i = 0; i < DOUBLINGS; ++i, first *= 2) {
    PetscCall(DescentTry_Private(d, x, first, &next));
    if (next >= *merit) break;
    *merit = next;
    *step  = first;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Off the equilibrium, down. */
static PetscErrorCode Leave_Private(Descent *d, Vec x, PetscBool *ok)
{
  PetscReal slope, curvature, first, step[2], merit[2];
  PetscBool done;

  PetscFunctionBegin;
  PetscCall(DescentLinearise_Private(d, x, &done, ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DescentDirection_Private(d, &slope, ok));
  d->neutral = (PetscBool)(*ok && d->shift == 0);
  *ok        = (PetscBool)(*ok && d->shift > 0 && d->added == d->shift);
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Lowest_Private(d, &curvature, ok));
  d->neutral = (PetscBool)(*ok && (curvature >= 0 || d->status.energy <= 0));
  *ok        = (PetscBool)(*ok && !d->neutral);
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  first = PetscSqrtReal(-2 * PETSC_SQRT_MACHINE_EPSILON * d->status.energy / curvature);
  for (PetscInt k = 0; k < 2; ++k) PetscCall(Side_Private(d, x, k ? -first : first, &step[k], &merit[k]));
  const PetscInt k = merit[1] < merit[0] - ROUND_LENGTH * PetscAbsReal(d->merit - merit[0]) ? 1 : 0;
  PetscCall(PetscInfo(d->ksp, "energy falls by %g at %g, by %g at %g\n", (double)(d->merit - merit[0]), (double)step[0], (double)(d->merit - merit[1]),
                      (double)step[1]));
  *ok     = (PetscBool)(step[k] != 0);
  d->fall = (d->merit - merit[k]) / d->status.energy;
  PetscCall(VecAXPY(x, step[k], d->dx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverStabilise(Solver s, State *state, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(DescentRun_Private(s, Leave_Private, "no stable equilibrium was found", state, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}
