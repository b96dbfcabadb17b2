/* Descent: the last resort where Newton's method with the active set finds no equilibrium.

   Frictionless contact of hyperelastic bodies is minimisation. Of the augmented Lagrangian Phi(u; lambda) (problem/energy.c) Newton's method with a shift
   against negative curvature and a line search on Phi itself finds a minimum from anywhere: each iterate lowers Phi, so that none comes back. The multipliers
   follow, lambda <- z, and once the constraints that press are known the exact problem is solved from there by SolverSolve. */
#include "solveimpl.h"

#define PENALTY 10         /* kappa over E / h: stiff against the cells, soft enough for the line search */
#define OUTER 3            /* descents, each with the multipliers of the one before: what helps does so after one or two */
#define ITERATIONS 300     /* of one descent: a slender strut that buckles between walls takes 160 to 220 */
#define MOVES 20           /* pieces of the prescribed motion */
#define FIRST_SHIFT 1e-9   /* over the rows' largest entries */
#define MORE_SHIFT 16      /* times the last, where the matrix is not positive yet; where it was, as many times smaller in the next iteration */
#define SHORTER_SHIFT 1e-3 /* at least, and MORE_SHIFT times the last, where that calls for a step shorter than 1 / MORE_SHIFT */
#define HALVINGS 10        /* of a step, in a line search that gives up */
#define LONGEST 64
#define DEEP 1 /* extents of a node along the surface: as deep as that it must not be lost, nor may a piece of the prescribed motion drive it in by more */

PetscBool SolverHasDescent(Solver s)
{
  return (PetscBool)(!s->saddle && ProblemHasEnergy(s->problem));
}

PetscErrorCode DescentCreate_Private(Solver s, SolverReport *report, Descent *d)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(d, sizeof(*d)));
  const PetscInt dofs = ProblemNumDofs(s->problem);
  d->round_off        = PETSC_MACHINE_EPSILON * PetscSqrtReal((PetscReal)dofs);
  d->solver           = s;
  d->problem          = s->problem;
  d->report           = report;
  PetscCall(ProblemCreateVector(s->problem, &d->trial));
  PetscCall(VecDuplicateAll(d->trial, 5, (Vec *[]){&d->gradient, &d->dx, &d->lambda, &d->depth, &d->next}));
  PetscCall(ProblemCreateRightSide(s->problem, &d->lift));
  PetscCall(VecDuplicateAll(d->lift, 4, (Vec *[]){&d->rhs, &d->y, &d->diagonal, &d->work}));
  PetscCall(InertiaFactors_Private(PetscObjectComm((PetscObject)d->trial), &d->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DescentDestroy_Private(Descent *d)
{
  PetscFunctionBegin;
  PetscCall(KSPDestroy(&d->ksp));
  PetscCall(VecDestroyAll(11, (Vec *[]){&d->trial, &d->gradient, &d->dx, &d->lambda, &d->depth, &d->next, &d->lift, &d->rhs, &d->y, &d->diagonal, &d->work}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What shifts are measured by: the rows at the first matrix. */
static PetscErrorCode Measure_Private(Descent *d, Mat A)
{
  PetscFunctionBegin;
  if (!d->measured) PetscCall(ProblemRowScale(d->problem, A, d->diagonal));
  d->measured = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factorise the matrix, whose shift is there. */
static PetscErrorCode Factor_Private(Descent *d, Mat A, PetscInt *negative)
{
  PetscFunctionBegin;
  ++d->report->factorisations;
  PetscCall(InertiaFactor_Private(d->problem, d->ksp, A, negative));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DescentApply_Private(Descent *d, PetscBool *ok)
{
  PetscBool failed;

  PetscFunctionBegin;
  PetscCall(SolverFactorSolve_Private(d->ksp, d->rhs, d->y, &failed, ok));
  if (failed) {
    PetscCall(KSPDestroy(&d->ksp));
    PetscCall(InertiaFactors_Private(PetscObjectComm((PetscObject)d->trial), &d->ksp));
  }
  if (*ok) PetscCall(ProblemMeritRecover(d->problem, d->y, d->dx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DescentDirection_Private(Descent *d, PetscReal *slope, PetscBool *ok)
{
  PetscReal shift = d->least < FIRST_SHIFT ? 0 : d->least;
  PetscInt  negative;
  Mat       A;

  PetscFunctionBegin;
  PetscCall(ProblemGetMatrix(d->problem, &A));
  PetscCall(Measure_Private(d, A));
  PetscCall(ProblemMeritSide(d->problem, d->gradient, NULL, d->rhs));
  for (*ok = PETSC_FALSE; !*ok && shift * SHORTER_SHIFT < 1 && !d->report->stopped; shift = PetscMax(FIRST_SHIFT, MORE_SHIFT * shift)) {
    PetscCall(VecCopy(d->diagonal, d->work));
    PetscCall(VecScale(d->work, shift - d->added));
    if (shift != d->added) PetscCall(MatDiagonalSet(A, d->work, ADD_VALUES));
    d->added = d->shift = shift;
    PetscCall(Factor_Private(d, A, &negative));
    PetscCall(StopAsked(PetscObjectComm((PetscObject)A), &d->report->stopped));
    if (negative == INERTIA_NO_MEMORY) break;
    if (negative != 0) continue;
    PetscCall(DescentApply_Private(d, ok));
    if (!*ok) continue;
    PetscCall(VecDot(d->gradient, d->dx, slope));
    *ok = (PetscBool)(*slope <= 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is there a node that is deep in the other side at the iterate, or (pressed) presses on it, and has lost it at the trial? The energy falls when bodies pass
   through each other. *deeper: by how much one is deeper at the trial. */
static PetscErrorCode Through_Private(Descent *d, PetscBool pressed, PetscBool *yes, PetscReal *deeper)
{
  const PetscReal *depth, *next, *lambda;
  PetscInt         num;
  PetscReal        largest[2] = {0, 0};

  PetscFunctionBegin;
  PetscCall(InterfaceMeritDepth(ProblemInterface(d->problem), d->next));
  PetscCall(VecGetLocalSize(d->next, &num));
  PetscCall(VecGetArrayRead(d->depth, &depth));
  PetscCall(VecGetArrayRead(d->next, &next));
  PetscCall(VecGetArrayRead(d->lambda, &lambda));
  for (PetscInt i = 0; i < num; ++i) {
    if ((depth[i] > DEEP || (pressed && depth[i] >= 0 && lambda[i] > 0)) && next[i] < 0) largest[0] = 1;
    largest[1] = PetscMax(largest[1], next[i] - PetscMax(depth[i], 0));
  }
  PetscCall(VecRestoreArrayRead(d->lambda, &lambda));
  PetscCall(VecRestoreArrayRead(d->depth, &depth));
  PetscCall(VecRestoreArrayRead(d->next, &next));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPIU_REAL, MPI_MAX, PetscObjectComm((PetscObject)d->trial)));
  *yes    = (PetscBool)(largest[0] > 0);
  *deeper = largest[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DescentTry_Private(Descent *d, Vec x, PetscReal step, PetscReal *merit)
{
  ProblemStatus status;
  PetscReal     deeper;
  PetscBool     through;

  PetscFunctionBegin;
  PetscCall(VecWAXPY(d->trial, step, d->dx, x));
  PetscCall(ProblemSearchOn(d->problem, d->trial));
  PetscCall(ProblemMerit(d->problem, PENALTY, d->lambda, d->trial, NULL, merit, &status));
  PetscCall(Through_Private(d, PETSC_FALSE, &through, &deeper));
  if (through) *merit = PETSC_MAX_REAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DescentSearch_Private(Descent *d, Vec x, PetscReal slope, PetscBool *ok)
{
  PetscReal merit, further, step = 1;

  PetscFunctionBegin;
  *ok = PETSC_FALSE;
  for (PetscInt i = 0; i < HALVINGS; ++i, step *= 0.5) {
    PetscCall(DescentTry_Private(d, x, step, &merit));
    *ok = (PetscBool)(merit < d->merit);
    if (*ok) break;
  }
  while (*ok && d->shift > 0 && step >= 1 && step < LONGEST) {
    PetscCall(DescentTry_Private(d, x, 2 * step, &further));
    if (further >= merit) break;
    merit = further;
    step *= 2;
  }
  if (*ok) PetscCall(VecAXPY(x, step, d->dx));
  d->least = *ok && step * MORE_SHIFT >= 1 ? d->shift / MORE_SHIFT : PetscMax(SHORTER_SHIFT, MORE_SHIFT * d->shift);
  PetscCall(PetscInfo(d->ksp, "shift %g, slope %g, step %g%s\n", (double)d->shift, (double)slope, (double)step, *ok ? "" : ": nothing lower"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DescentLinearise_Private(Descent *d, Vec x, PetscBool *done, PetscBool *ok)
{
  PetscReal norm;
  PetscBool bad;

  PetscFunctionBegin;
  PetscCall(ProblemSearchOn(d->problem, x));
  InterfaceKeepSearch(ProblemInterface(d->problem));
  PetscCall(ProblemMerit(d->problem, PENALTY, d->lambda, x, d->gradient, &d->merit, &d->status));
  *ok = (PetscBool)!d->status.bad;
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InterfaceMeritDepth(ProblemInterface(d->problem), d->depth));
  PetscCall(VecNorm(d->gradient, NORM_2, &norm));
  PetscCall(PetscInfo(d->ksp, "Phi %.15g, forces out of balance %g of %g\n", (double)d->merit, (double)norm, (double)d->status.scale));
  *done = (PetscBool)(norm <= PetscSqrtReal(d->solver->rtol) * d->status.scale);
  ++d->report->descent_iterations;
  PetscCall(ProblemMeritTangent(d->problem, PENALTY, x, NULL, &bad));
  *ok      = (PetscBool)!bad;
  d->added = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Down to a minimum of Phi, whose multipliers x then has. *ok: it is one. */
static PetscErrorCode Minimise_Private(Descent *d, Vec x, PetscBool *ok)
{
  PetscReal slope;
  PetscBool found = PETSC_TRUE, moved = PETSC_TRUE, done = PETSC_FALSE;

  PetscFunctionBegin;
  *ok      = PETSC_FALSE;
  d->least = 0;
  for (PetscInt i = 0; i < ITERATIONS && !d->report->stopped; ++i) {
    if (moved) PetscCall(DescentLinearise_Private(d, x, &done, &found));
    if (!found) break;
    PetscCall(DescentDirection_Private(d, &slope, &found));
    *ok = (PetscBool)(found && done && (d->shift == 0 || -slope <= d->round_off * PetscAbsReal(d->merit)));
    if (!found || *ok || -slope <= d->round_off * PetscAbsReal(d->merit)) break;
    PetscCall(DescentSearch_Private(d, x, slope, &moved));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One piece of the prescribed motion that is left, put in by the bodies alone as if they were linear and did not touch: the largest share of 1, 1/2, … that
   inverts no cell and drives no node far into the other side. */
static PetscErrorCode Piece_Private(Descent *d, Vec x, PetscBool *ok)
{
  PetscBool bad, through;
  PetscReal deeper;
  PetscInt  negative;
  Mat       A;

  PetscFunctionBegin;
  *ok = PETSC_FALSE;
  PetscCall(ProblemSearch(d->problem, x));
  PetscCall(ProblemMerit(d->problem, PENALTY, d->lambda, x, NULL, &d->merit, &d->status));
  if (d->status.bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InterfaceMeritDepth(ProblemInterface(d->problem), d->depth));
  PetscCall(ProblemMeritTangent(d->problem, PENALTY, x, d->lift, &bad));
  if (bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemGetMatrix(d->problem, &A));
  PetscCall(VecSet(d->gradient, 0));
  PetscCall(ProblemMeritSide(d->problem, d->gradient, d->lift, d->rhs));
  PetscCall(Factor_Private(d, A, &negative));
  PetscCall(StopAsked(PetscObjectComm((PetscObject)A), &d->report->stopped));
  if (negative < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DescentApply_Private(d, ok));
  if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemStepBegin(d->problem, x, d->dx));
  PetscReal step = 1;
  *ok            = PETSC_FALSE;
  for (PetscInt i = 0; i < HALVINGS && !*ok; ++i, step *= 0.5) {
    PetscCall(ProblemStepMove(d->problem, d->dx, step, PETSC_FALSE, x));
    PetscCall(ProblemMerit(d->problem, PENALTY, d->lambda, x, NULL, &d->merit, &d->status));
    PetscCall(Through_Private(d, PETSC_TRUE, &through, &deeper));
    *ok = (PetscBool)(!d->status.bad && !through && deeper <= DEEP);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Move_Private(Descent *d, Vec x, PetscBool *ok)
{
  PetscReal pending;

  PetscFunctionBegin;
  *ok = PETSC_TRUE;
  PetscCall(ProblemPending(d->problem, &pending));
  for (PetscInt piece = 0; piece < MOVES && pending > 0 && *ok && !d->report->stopped; ++piece) {
    PetscCall(Piece_Private(d, x, ok));
    PetscCall(ProblemPending(d->problem, &pending));
  }
  *ok = (PetscBool)(*ok && pending == 0);
  PetscCall(PetscInfo(d->ksp, "prescribed motion %s\n", *ok ? "put in" : "cannot be put in"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Element pressures are those that x implies. */
static PetscErrorCode Pressures_Private(Descent *d, State *state)
{
  PetscBool bad;

  PetscFunctionBegin;
  PetscCall(ProblemMeritTangent(d->problem, PENALTY, state->x, NULL, &bad));
  if (bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecSet(d->dx, 0));
  PetscCall(ProblemStepBegin(d->problem, state->x, d->dx));
  PetscCall(ProblemStepAccept(d->problem, 1, state->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The exact problem from where the descent is; the state is its solution, or stays. */
static PetscErrorCode Exact_Private(Descent *d, State *state)
{
  SolverReport *total = d->report, last;
  State         trial;

  PetscFunctionBegin;
  PetscCall(Pressures_Private(d, state));
  PetscCall(StateCreate(d->problem, &trial));
  PetscCall(StateCopy(state, &trial));
  PetscCall(SolverSolve(d->solver, &trial, &last));
  last.iterations += total->iterations;
  last.factorisations += total->factorisations;
  last.single_failures += total->single_failures;
  last.set_changes += total->set_changes;
  last.single_switches += total->single_switches;
  last.set_cycles += total->set_cycles;
  for (PetscInt i = 0; i < SolverNumModifiers(); ++i) last.modifiers[i] += total->modifiers[i];
  last.descents           = total->descents;
  last.descent_iterations = total->descent_iterations;
  *total                  = last;
  if (last.converged) PetscCall(StateCopy(&trial, state));
  PetscCall(StateDestroy(&trial));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Down from the state, whose prescribed motion is put in, and to a solution of the exact problem; the report says whether. */
static PetscErrorCode Finish_Private(Descent *d, State *state)
{
  PetscBool ok = PETSC_TRUE;

  PetscFunctionBegin;
  for (PetscInt outer = 0; outer < OUTER && ok && !d->report->converged && !d->report->stopped; ++outer) {
    ++d->report->descents;
    PetscCall(Minimise_Private(d, state->x, &ok));
    PetscCall(PetscInfo(d->ksp, "descent %s\n", ok ? "has come down" : "ends early"));
    if (d->status.bad || d->report->stopped) break;
    PetscCall(VecCopy(state->x, d->lambda));
    PetscCall(Exact_Private(d, state));
    PetscCall(PetscInfo(d->ksp, "exact: %s\n", d->report->converged ? "found" : d->report->reason));
    if (d->report->converged && d->report->unstable < 0 && ok) d->report->unstable = 0; /* no tangent was factorised: the minimum it is */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DescentRun_Private(Solver s, DescentStart start, const char *reason, State *state, SolverReport *report)
{
  Descent   d;
  PetscBool ok;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  report->reason   = reason;
  report->unstable = -1;
  PetscCall(ProblemSetState(s->problem, state));
  PetscCall(DescentCreate_Private(s, report, &d));
  PetscCall(VecCopy(state->x, d.lambda));
  PetscCall(start(&d, state->x, &ok));
  if (ok) PetscCall(Finish_Private(&d, state));
  report->fall    = d.fall;
  report->neutral = d.neutral;
  PetscCall(DescentDestroy_Private(&d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverDescend(Solver s, State *state, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(DescentRun_Private(s, Move_Private, "no descent leads to an equilibrium", state, report));
  PetscFunctionReturn(PETSC_SUCCESS);
}
