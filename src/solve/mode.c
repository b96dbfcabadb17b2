/* The mode in which an equilibrium is least stiff: the eigenvector of the eigenvalue nearest to 0 of its tangent K against D, which is as large as the entries
   of the rows of displacements; by inverse iteration with one factor. At a bifurcation or a limit point that eigenvalue is 0. */
#include "solveimpl.h"

/* Forces without symmetry, from the reference positions: the same on any number of ranks. */
static PetscErrorCode Start_Private(Solver s, Vec scale, Vec x)
{
  const HPTables *v = HPSpaceGetTables(ProblemSpace(s->problem));
  PetscReal      *local;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &local));
  SolverWithoutSymmetry_Private(v, local);
  PetscCall(VecSet(x, 1));
  PetscCall(ProblemSetDisplacement(s->problem, local, x));
  PetscCall(PetscFree(local));
  PetscCall(ProblemRightSide(s->problem, x, s->lift, s->rhs));
  PetscCall(VecPointwiseMult(s->rhs, s->rhs, scale));
  PetscCall(VecSet(x, 0)); /* nothing acts inside cells */
  PetscCall(ProblemRightSide(s->problem, x, s->lift, s->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Apply_Private(void *solver, PetscBool again, PetscBool *ok)
{
  Solver s = (Solver)solver;

  PetscFunctionBegin;
  PetscCall(SolverMatrixSolve_Private(s, s->rhs, again));
  *ok = (PetscBool)!s->no_solution;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* s->y: the mode, with the tangent that is assembled. */
static PetscErrorCode Lowest_Private(Solver s, Vec x, Lowest *low, PetscBool *known)
{
  Vec scale;
  Mat A;

  PetscFunctionBegin;
  PetscCall(ProblemGetMatrix(s->problem, &A));
  PetscCall(VecDuplicate(s->rhs, &scale));
  PetscCall(ProblemRowScale(s->problem, A, scale));
  PetscCall(Start_Private(s, scale, x));
  PetscCall(SolverInverseIteration_Private(Apply_Private, s, scale, s->rhs, s->y, low, known));
  PetscCall(VecDestroy(&scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverLowestMode(Solver s, State *state, PetscReal *stiffness, Vec mode, PetscBool *known)
{
  SolverReport report = {.reason = ""};
  Lowest       low    = {0};
  PetscBool    bad;
  Vec          r;

  PetscFunctionBegin;
  *known      = PETSC_FALSE;
  s->report   = &report;
  s->pressure = state->pressure;
  s->form     = state->form;
  PetscCall(ProblemSetState(s->problem, state));
  s->form.symmetric = s->symmetric;
  PetscCall(ProblemSetForm(s->problem, &s->form));
  PetscCall(ProblemSearch(s->problem, state->x));
  PetscCall(VecDuplicate(state->x, &r));
  PetscCall(ProblemResidual(s->problem, state->x, NULL, r, &report.status));
  PetscCall(VecZeroEntries(s->lift));
  PetscCall(ProblemTangent(s->problem, state->x, s->pressure, s->lift, &bad));
  if (!bad && s->symmetric && !ProblemGetSymmetric(s->problem)) PetscCall(SolverUnsymmetric_Private(s));
  if (!bad) PetscCall(Lowest_Private(s, r, &low, known));
  if (*known && mode) PetscCall(ProblemRecover(s->problem, s->y, mode));
  PetscCall(VecDestroy(&r));
  *stiffness = PetscAbsReal(low.theta) > low.round_off ? low.theta : 0;
  PetscCall(PetscInfo(s->snes, "softest mode: eigenvalue %g\n", (double)low.theta));
  s->report   = NULL;
  s->pressure = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
