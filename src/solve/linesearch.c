/* Modifier: steps that go too far. Along a linear step du, dz the residual with the multipliers of its end does the work
   g(s) = du . R(u + s du, z + dz), which is -du . K du at its start and would be 0 at its end. Where bodies answer more
   stiffly on the way than their tangent said (flow that turns, cells that are squeezed), g is positive there: balance
   along the step was left behind, and the next one comes back as far. Such a step is shortened to where little is left
   of g [Matthies & Strang 1979], with the multipliers of its end: those of its start would hide that gaps close. So with
   element pressures, which are multipliers of the volume: those that x implies would add the bulk modulus times an error
   of volume of second order, which the next step takes away whatever it is. */
#include "solveimpl.h"

#define LITTLE 0.5 /* share of the work, or of the residual, that may be left */
#define AWAY 0.1   /* of the interval: the next trial is no nearer to either of its ends */
#define TRIALS 6

PetscReal SolverInside_Private(const PetscReal s[2], const PetscReal g[2])
{
  const PetscReal share = g[0] / (g[0] - g[1]);

  return s[0] + PetscMax(AWAY, PetscMin(1 - AWAY, share)) * (s[1] - s[0]);
}

/* At x, with the element pressures of the end of the step: work along it, and norm of the residual. */
static PetscErrorCode Measure_Private(Solver s, const Iterate *it, Vec dx, PetscReal *work, PetscReal *norm)
{
  Vec           r = s->balance ? s->balance : it->r;
  ProblemStatus status;

  PetscFunctionBegin;
  if (s->balance) PetscCall(ProblemResidual(s->problem, it->x, s->end, r, &status));
  PetscCall(ProblemWork(s->problem, r, dx, work));
  PetscCall(VecNorm(r, NORM_2, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Residual at a share of the displacements of the step; whole: multipliers are those at its end. Then its work along the step, and its norm. */
static PetscErrorCode Try_Private(Solver s, const Iterate *it, Vec dx, PetscReal step, PetscBool whole, PetscReal *work, PetscReal *norm)
{
  PetscFunctionBegin;
  PetscCall(ProblemStepMove(s->problem, dx, step, whole, it->x));
  PetscCall(SNESComputeFunction(s->snes, it->x, it->r));
  PetscCall(Measure_Private(s, it, dx, work, norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Work with the multipliers of the end at the start of the step and at the length at hand: too far? */
static PetscErrorCode TooFar_Private(Solver s, const Iterate *it, Vec dx, PetscReal step, PetscReal g[2], PetscBool *yes)
{
  PetscReal norm, none;

  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  PetscCall(Measure_Private(s, it, dx, &g[1], &norm));
  if (g[1] <= 0 || norm <= LITTLE * it->norm) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Try_Private(s, it, dx, 0, PETSC_TRUE, &g[0], &none));
  *yes = (PetscBool)(g[0] < 0 && g[1] > -LITTLE * g[0]);
  if (!*yes) PetscCall(Try_Private(s, it, dx, step, PETSC_FALSE, &none, &none));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Element pressures at the end of the whole linear step. */
static PetscErrorCode End_Private(Solver s)
{
  PetscFunctionBegin;
  if (!s->balance) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(s->end, s->pressure, s->num_pressure));
  PetscCall(ProblemStepAccept(s->problem, 1, s->end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Not for bodies with an energy that nothing touches, glued or not: a load that carries them away, or past a limit point, is told by steps that fail. */
static PetscBool Applies_Private(Solver s)
{
  const SceneData *scene = ProblemGetScene(s->problem);

  for (PetscInt i = 0; i < scene->num_contacts; ++i)
    if (scene->contacts[i].law != CONTACT_TIED) return PETSC_TRUE;
  return (PetscBool)(!ProblemIsSymmetric(s->problem) || MechanicsIsPlastic(&scene->mechanics));
}

static PetscErrorCode Shorten_Private(Solver s, const Iterate *it, Vec dx, PetscReal *step, PetscBool *acts)
{
  PetscReal at[2] = {0, *step}, g[2] = {0, 0}, norm, now;

  PetscFunctionBegin;
  PetscCall(VecNorm(it->r, NORM_2, &norm));
  if (norm <= LITTLE * it->norm) PetscFunctionReturn(PETSC_SUCCESS);
  *acts = Applies_Private(s);
  if (!*acts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(End_Private(s));
  PetscCall(TooFar_Private(s, it, dx, *step, g, acts));
  const PetscReal first = g[0];
  s->course.shortened   = *acts;
  for (PetscInt trial = 0; trial < TRIALS && *acts; ++trial) {
    *step = SolverInside_Private(at, g);
    PetscCall(PetscInfo(s->snes, "step %g goes too far, work %g after %g: %g\n", (double)at[1], (double)g[1], (double)first, (double)*step));
    PetscCall(Try_Private(s, it, dx, *step, PETSC_TRUE, &now, &norm));
    if (s->report->status.bad || norm <= LITTLE * it->norm || PetscAbsReal(now) <= -LITTLE * first) break;
    at[now > 0] = *step;
    g[now > 0]  = now;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierLineSearch = {"line_search", "a step at whose end forces along it point back is shortened to where they balance",
                                     .shorten = Shorten_Private};
