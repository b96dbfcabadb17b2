/* What equilibria are followed in: time, the arc length of a path of equilibria, what is left of an imbalance, and pseudo-time under viscous regularisation. */
#include "path.h"

#define GROWTH 1.5 /* of a step after an easy one */
#define TURN 2     /* a step along the path this many times as long as asked for has left its tangent */

/* ---- time ------------------------------------------------------------------------------------------------------------------------ */

/* The decimal number that a sum of steps is meant to be, where it is one but for round-off: an expression like t > 1 is not to be true at the end of twenty
   steps of 0.05. */
static PetscReal Decimal_Private(PetscReal t)
{
  char   text[32];
  double decimal;

  (void)snprintf(text, sizeof(text), "%.12g", (double)t);
  decimal = strtod(text, NULL);
  return PetscAbsReal(decimal - t) <= 2 * PETSC_MACHINE_EPSILON * PetscAbsReal(t) ? decimal : t;
}

PetscReal PathStepEnd(const SceneData *data, PetscReal t, PetscReal dt)
{
  const MechanicsSpec *m    = &data->mechanics;
  const PetscReal      tiny = PETSC_SQRT_MACHINE_EPSILON * data->load.end; /* times that differ by less are the same */
  PetscReal            last = data->load.end;

  for (PetscInt i = 0; i < m->num_boundaries; ++i) last = PetscMin(last, AmplitudeNext(&m->boundaries[i].amplitude, t + tiny));
  for (PetscInt i = 0; i < m->num_bodies; ++i) last = PetscMin(last, AmplitudeNext(&m->bodies[i].amplitude, t + tiny));
  return t + dt > last - tiny ? last : Decimal_Private(t + dt);
}

static PetscReal TimeEnd_Private(const Path *p, const PathLoop *loop)
{
  const PetscReal end = PathStepEnd(p->data, loop->s, loop->piece);

  return end > loop->stop - PETSC_SQRT_MACHINE_EPSILON * p->data->load.end ? loop->stop : end;
}

static PetscErrorCode TimeSet_Private(Path *p, const PathLoop *loop, PetscReal to)
{
  PetscBool turned;

  PetscFunctionBegin;
  ProblemHold(p->level->problem);
  PetscCall(ProblemSetTime(p->level->problem, to));
  PetscCall(ProblemTurn(p->level->problem, p->level->state.x, &turned));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TimeFound_Private(Path *p, const PathLoop *loop, PetscReal to, SolverReport *report)
{
  PetscFunctionBegin;
  p->level->state.t = to;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PathMetric PathTime = {"t", 0.5, GROWTH, PETSC_TRUE, TimeEnd_Private, TimeSet_Private, TimeFound_Private};

/* ---- arc length: root mean square of the displacements along the last secant (7.3) ------------------------------------------------ */

static PetscReal End_Private(const Path *p, const PathLoop *loop)
{
  return PetscMin(loop->s + loop->piece, loop->stop);
}

static PetscErrorCode ArcSet_Private(Path *p, const PathLoop *loop, PetscReal to)
{
  PetscFunctionBegin;
  ProblemAdvance(p->level->problem, to);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The end of the load was passed: from there back to it, at fixed time. */
static PetscErrorCode Finish_Private(Path *p, SolverReport *report)
{
  const PetscReal end    = p->data->load.end;
  const PathLoop  finish = {.metric = &PathTime, .stop = end};

  PetscFunctionBegin;
  PetscCall(PathAttempt(p, &finish, end, report));
  if (!report->converged) report->reason = "no equilibrium at load.end";
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ArcFound_Private(Path *p, const PathLoop *loop, PetscReal to, SolverReport *report)
{
  Level    *l = p->level;
  PetscReal length;

  PetscFunctionBegin;
  PetscCall(ProblemDistance(l->problem, l->accepted.x, l->state.x, &length));
  if (length > TURN * (to - loop->origin)) {
    report->converged = PETSC_FALSE;
    report->reason    = "the path of equilibria turns too sharply for steps of load.step_min";
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ProblemGetTime(l->problem, l->state.x, &l->state.t));
  if (l->state.t > p->data->load.end) PetscCall(Finish_Private(p, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PathMetric PathArc = {"arc length", 0.5, GROWTH, PETSC_TRUE, End_Private, ArcSet_Private, ArcFound_Private};

/* ---- the part of the overlap at the start that is taken away (7.5): ProblemNoteOverlap comes first ----------------------------------- */

static PetscErrorCode OverlapSet_Private(Path *p, const PathLoop *loop, PetscReal to)
{
  PetscFunctionBegin;
  ProblemLeaveOverlap(p->level->problem, 1 - to);
  PetscCall(loop->load->metric->set(p, loop->load, loop->at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OverlapFound_Private(Path *p, const PathLoop *loop, PetscReal to, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(loop->load->metric->found(p, loop->load, loop->at, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PathMetric PathOverlap = {"overlap", 0.5, 2, PETSC_FALSE, End_Private, OverlapSet_Private, OverlapFound_Private};

/* ---- pseudo-time of a gradient flow (7.0): implicit Euler steps; one of infinite length finds an equilibrium without viscosity ------ */

static PetscReal ViscousEnd_Private(const Path *p, const PathLoop *loop)
{
  return loop->piece >= loop->most ? loop->stop : loop->s + loop->piece;
}

static PetscErrorCode ViscousSet_Private(Path *p, const PathLoop *loop, PetscReal to)
{
  PetscFunctionBegin;
  PetscCall(ProblemSetViscosity(p->level->problem, to < loop->stop ? 1 / (to - loop->s) : 0, p->level->state.x));
  PetscCall(loop->load->metric->set(p, loop->load, loop->at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ViscousFound_Private(Path *p, const PathLoop *loop, PetscReal to, SolverReport *report)
{
  Level    *l = p->level;
  PetscReal work;

  PetscFunctionBegin;
  if (to >= loop->stop) {
    PetscCall(loop->load->metric->found(p, loop->load, loop->at, report));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ProblemGetTime(l->problem, l->state.x, &l->state.t));
  PetscCall(ProblemViscousWork(l->problem, l->state.x, &work));
  p->work.viscous += work;
  PetscCall(StateKeepOrigin(l->problem, &l->state)); /* friction opposes the motion in pseudo-time; against all since the step's start it would feed one back */
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PathMetric PathViscous = {"viscous", 0.25, 10, PETSC_FALSE, ViscousEnd_Private, ViscousSet_Private, ViscousFound_Private};
