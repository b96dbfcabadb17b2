/* Following a path of equilibria through limit points: pseudo-time t, the factor of all loads, is an unknown, and its equation one of

     t = the time that was set                                      (hold: the first step, the last one)
     n . (u - u1) / sqrt(N) = advance,  n = (u1 - u0) / |u1 - u0|    (follow: the plane across the last secant, u over the N displacement dofs)

   The plane is linear, so the first Newton iterate is the tangent's; its sense is the secant's, so that limit points need no decision. */
#include "problemimpl.h"

/* d = to - from (NULL: rest) in the displacements, 0 in all else. */
static PetscErrorCode Difference_Private(Problem p, Vec from, Vec to, Vec d)
{
  PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecCopy(to, d));
  if (from) PetscCall(VecAXPY(d, -1, from));
  PetscCall(VecGetArray(d, &array));
  PetscCall(PetscArrayzero(array + p->num_u, p->p_start[p->rank + 1] - p->start - p->num_u));
  PetscCall(VecRestoreArray(d, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemDistance(Problem p, Vec from, Vec to, PetscReal *distance)
{
  Vec d;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(p->prototype, &d));
  PetscCall(Difference_Private(p, from, to, d));
  PetscCall(VecNorm(d, NORM_2, distance));
  *distance /= PetscSqrtReal((PetscReal)PetscMax(1, p->u_start[p->size]));
  PetscCall(VecDestroy(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFollow(Problem p, Vec from, Vec to, PetscReal *length)
{
  PetscFunctionBegin;
  PetscCall(ProblemDistance(p, from, to, length));
  if (!p->path) PetscCall(VecDuplicate(p->prototype, &p->path));
  PetscCall(Difference_Private(p, from, to, p->path));
  if (*length > 0) PetscCall(VecScale(p->path, 1 / (*length * (PetscReal)PetscMax(1, p->u_start[p->size]))));
  PetscCall(VecDot(p->path, to, &p->path_start));
  p->path_advance = 0;
  p->following    = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ProblemGetPath(Problem p, Vec *direction)
{
  *direction = p->following ? p->path : NULL;
}

PetscErrorCode ProblemFollowAlong(Problem p, Vec direction, Vec to)
{
  PetscFunctionBegin;
  if (!p->path) PetscCall(VecDuplicate(p->prototype, &p->path));
  PetscCall(VecCopy(direction, p->path));
  PetscCall(VecDot(p->path, to, &p->path_start));
  p->path_advance = 0;
  p->following    = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ProblemAdvance(Problem p, PetscReal advance)
{
  p->path_advance = advance;
  p->following    = PETSC_TRUE;
}

void ProblemHold(Problem p)
{
  p->following = PETSC_FALSE;
}

PetscBool ProblemIsFollowing(Problem p)
{
  return p->following;
}

PetscErrorCode ProblemGetTime(Problem p, Vec x, PetscReal *t)
{
  PetscFunctionBegin;
  *t = p->t;
  if (p->num_scalars == p->num_controls + p->num_rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemGetScalars(p, x, p->scalar));
  *t = p->scalar[p->num_controls];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A force like those of the bodies: their modulus times an area. The equation is linear and met by the first whole step, so its size matters for round-off
 * only.
 */
static PetscReal Unit_Private(Problem p)
{
  PetscReal mu = 0;
  for (PetscInt b = 0; b < p->scene->mechanics.num_bodies; ++b) mu = PetscMax(mu, p->scene->mechanics.bodies[b].material->mu);
  return mu * (p->scene->mechanics.model == MODEL_PLANE_STRAIN ? p->extent : PetscSqr(p->extent));
}

PetscErrorCode PathResidual_Private(Problem p, Vec x, PetscReal *r)
{
  PetscReal along;

  PetscFunctionBegin;
  if (!p->following) {
    *r = Unit_Private(p) * (p->scalar[p->num_controls] - p->t) / p->scene->load.end;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecDot(p->path, x, &along));
  *r = Unit_Private(p) / p->extent * (along - p->path_start - p->path_advance);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For differences of loads, unit: time. */
static PetscReal Interval_Private(const Problem p)
{
  return PetscPowReal(PETSC_MACHINE_EPSILON, 1. / 3) * p->scene->load.end;
}

/* Largest change by t of what this process knows of a nodal force, from t0 to t1. */
static PetscErrorCode LoadRate_Private(Problem p, const PetscReal u[], PetscReal t0, PetscReal t1, PetscReal rate[], PetscReal *largest)
{
  PetscFunctionBegin;
  *largest = 0;
  PetscCall(PetscArrayzero(rate, p->num_local));
  PetscCall(MechanicsSetTime(p->mechanics, 0.5 * (t0 + t1)));
  PetscCall(MechanicsLoadRate(p->mechanics, u, 0.5 * (t1 - t0), rate));
  PetscCall(MechanicsSetTime(p->mechanics, p->t));
  for (PetscInt i = 0; i < p->num_local; ++i) *largest = PetscMax(*largest, PetscAbsReal(rate[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemLoadSpeed(Problem p, Vec x, PetscReal *speed)
{
  PetscReal *u, *rate, largest[2]; /* on the way here, from here on */

  PetscFunctionBegin;
  *speed = 0;
  if (p->t <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(p->num_local, &u, p->num_local, &rate));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(LoadRate_Private(p, u, 0, p->t, rate, &largest[0]));
  PetscCall(LoadRate_Private(p, u, p->t, p->t + Interval_Private(p), rate, &largest[1]));
  PetscCall(PetscFree2(u, rate));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPIU_REAL, MPI_MAX, p->comm));
  if (largest[1] > 0) *speed = largest[0] > 0 ? largest[1] / largest[0] : PETSC_INFINITY;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The row from what the rank owns, the column from the change of the loads with t. */
PetscErrorCode PathTangent_Private(Problem p, PetscInt row, const PetscReal u[])
{
  const PetscReal *n;
  PetscReal       *rate;

  PetscFunctionBegin;
  if (p->following) {
    PetscCall(VecGetArrayRead(p->path, &n));
    for (PetscInt i = 0; i < p->num_u; ++i) PetscCall(MatSetValue(p->matrix, row, p->first_row + i, Unit_Private(p) / p->extent * n[i], ADD_VALUES));
    PetscCall(VecRestoreArrayRead(p->path, &n));
  } else if (p->rank == p->size - 1)
    PetscCall(MatSetValue(p->matrix, row, row, Unit_Private(p) / p->scene->load.end, ADD_VALUES));
  PetscCall(PetscCalloc1(p->num_local, &rate));
  PetscCall(MechanicsLoadRate(p->mechanics, u, Interval_Private(p), rate));
  PetscCall(ScalarsColumn_Private(p, p->num_controls, rate));
  PetscCall(PetscFree(rate));
  PetscFunctionReturn(PETSC_SUCCESS);
}
