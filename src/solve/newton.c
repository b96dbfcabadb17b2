/* The nonlinear iteration as a SNES type: semi-smooth Newton with a contact-aware predictor.

   In each iteration the prescribed motion still to come enters the linear solve, and the active set is iterated against that same
   linearisation before the state is updated (docs/theory.md, solution). There is no merit function: a step is shortened only when it
   would leave the domain (det F <= 0), and the rest of the prescribed motion then stays for the next iteration. */
#include "solveimpl.h"
#include <petsc/private/snesimpl.h>

/* A solve that goes wrong is recognised early: a shorter load step, or another start, costs less than waiting for the iteration limit. */
#define STALLED 7  /* iterations without a new least residual */
#define HALVINGS 8 /* of steps that left the domain, in one solve */
#define LOOSE 1e-2 /* least part of what holds bodies that nothing else does: round-off of factors is far below */
#define NEAR 1e-5  /* residual over the nodal forces from which on it should not grow */
#define CLEAR 10   /* tolerances: what is less is round-off's */
#define HOLDS 3    /* pairs that are held back from sliding in one linear step */

/* What a cell of incompressible material may gain or lose of its volume, whatever the forces: where prescribed motion leaves it no choice, pressures grow
   without bounds, and next to them every residual is small. */
#define VOLUME 1e-8

/* A factor as preconditioner: with less than this, nodes at the edge of contact switch wrongly, and a slide that needs no cut is cut. */
#define REFINE_RTOL 1e-10

/* How far GMRES need go: so far that no Newton iteration is lost, which costs more than the few more of GMRES. */
static PetscReal Forcing_Private(Solver s)
{
  return PetscMin(1e-8, PetscMax(s->linear_rtol, 0.01 * s->report->residual / PetscMax(s->report->scale, PETSC_MIN_REAL)));
}

/* One solve with the matrix as it stands, to s->y; again: only the active set has changed since the last, whose solution is there. */
static PetscErrorCode MatrixSolve_Private(SNES snes, Solver s, PetscBool again, PetscBool *ok)
{
  Mat A;

  PetscFunctionBegin;
  PetscCall(ProblemGetMatrix(s->problem, &A));
  if (s->saddle) {
    PetscCall(StageBegin(STAGE_FACTOR));
    PetscCall(SaddleSetUp_Private(s->saddle, A, s->symmetric));
    PetscCall(StageEnd(STAGE_FACTOR));
    PetscCall(StageBegin(STAGE_SOLVE));
    PetscCall(SaddleSolve_Private(s->saddle, s->rhs, Forcing_Private(s), again, s->y, ok));
    PetscCall(StageEnd(STAGE_SOLVE));
    if (*ok) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(PetscInfo(snes, "multigrid failed: factorising\n"));
  }
  if (s->factored) {
    PetscCall(StageBegin(STAGE_SOLVE));
    PetscCall(SolverRefine_Private(s, A, s->rhs, PetscMin(REFINE_RTOL, Forcing_Private(s)), s->y, ok));
    PetscCall(StageEnd(STAGE_SOLVE));
    if (*ok) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SolverDirect_Private(s, A, s->rhs, s->y, ok));
  s->factored = (PetscBool)(*ok && s->reuse);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinearSolve_Private(SNES snes, Solver s, PetscBool again, Vec dx, PetscBool *ok)
{
  PetscFunctionBegin;
  PetscCall(MatrixSolve_Private(snes, s, again, ok));
  if (*ok) PetscCall(ProblemRecover(s->problem, s->y, dx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve tangent . dx = -(r + lift) with the active set iterated: until it stays, or repeats (then the solution that contradicted its own set least is taken),
   or the passes are used up. */
static PetscErrorCode LinearStep_Private(SNES snes, Solver s, Vec x, Vec dx, PetscBool *ok)
{
  PetscInt  changed = 1;
  PetscBool repeats = PETSC_FALSE;
  PetscReal least   = PETSC_MAX_REAL, violation;
  uint64_t  hash;

  PetscFunctionBegin;
  s->pass_sets.num = 0;
  for (PetscInt pass = 0; pass <= s->passes && changed && !repeats; ++pass) {
    PetscCall(ProblemActiveSetHash(s->problem, &hash));
    PetscCall(SetHistoryAdd_Private(&s->pass_sets, hash, 0, PETSC_FALSE, &repeats));
    if (repeats) break;
    PetscCall(LinearSolve_Private(snes, s, (PetscBool)(pass > 0), dx, ok));
    if (!*ok) PetscFunctionReturn(PETSC_SUCCESS);
    changed = 0;
    if (pass < s->passes) PetscCall(ProblemSwitchActiveSet(s->problem, dx, s->rhs, &changed, &violation));
    if (changed) PetscCall(StopAsked(PetscObjectComm((PetscObject)snes), &s->report->stopped));
    if (!changed || s->report->stopped) break;
    s->report->set_changes += changed;
    PetscCall(PetscInfo(snes, "active-set pass %" PetscInt_FMT ": %" PetscInt_FMT " nodes switched, contradiction %g\n", pass, changed, (double)violation));
    if (violation < least) PetscCall(VecCopy(dx, s->best));
    least = PetscMin(least, violation);
  }
  if (!repeats) PetscFunctionReturn(PETSC_SUCCESS);
  ++s->report->set_cycles;
  PetscCall(PetscInfo(snes, "active sets repeat after %" PetscInt_FMT " passes\n", s->pass_sets.num));
  PetscCall(VecCopy(s->best, dx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x += step dx with the longest step 1, 1/2, … that stays in the domain; residual there. */
static PetscErrorCode Step_Private(SNES snes, Solver s, Vec x, Vec dx, Vec r)
{
  PetscReal step = 1;

  PetscFunctionBegin;
  PetscCall(ProblemStepBegin(s->problem, x, dx));
  for (PetscInt cut = 0; cut <= s->cuts; ++cut, step *= 0.5) {
    PetscCall(ProblemStepMove(s->problem, dx, step, x));
    PetscCall(SNESComputeFunction(snes, x, r));
    if (!s->report->status.bad) break;
    ++s->halvings;
    PetscCall(PetscInfo(snes, "step %g leaves the domain\n", (double)step));
  }
  if (!s->report->status.bad) PetscCall(ProblemStepAccept(s->problem, step, s->pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Finish_Private(SNES snes, Solver s, SNESConvergedReason reason, const char *words)
{
  PetscFunctionBegin;
  snes->reason         = reason;
  s->report->converged = (PetscBool)(reason > 0);
  s->report->unstable  = s->negative > 0 ? 1 : s->negative;
  s->report->reason    = words;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The residual is small against the nodal forces, or down at the round-off of an unloaded body. */
static PetscBool Small_Private(const Solver s, const ProblemStatus *status, PetscReal norm)
{
  return (PetscBool)(norm <= PetscMax(s->rtol * status->scale, status->noise));
}

static PetscBool KeepsVolume_Private(const Solver s)
{
  return (PetscBool)(s->report->status.volume <= PetscMax(VOLUME, s->rtol));
}

/* What to say of an iteration that ends without a solution. */
static const char *Words_Private(const Solver s, PetscReal norm, const char *usual)
{
  return Small_Private(s, &s->report->status, norm) && !KeepsVolume_Private(s) ? "incompressible material cannot keep its volume" : usual;
}

/* Are the forces of the element pressures that Newton's method has found in balance? Round-off of the displacements times the bulk modulus is in those of the
   pressures that x implies, down to which the iteration ends, but not in these, so that they tell whether its last step was small. */
static PetscErrorCode Balanced_Private(Solver s, Vec x, PetscBool *yes)
{
  ProblemStatus status;
  PetscReal     norm;

  PetscFunctionBegin;
  PetscCall(ProblemResidual(s->problem, x, s->pressure, s->balance, &status));
  PetscCall(VecNorm(s->balance, NORM_2, &norm));
  *yes = Small_Private(s, &status, norm);
  PetscCall(PetscInfo(s->snes, "with the element pressures found: %g of %g\n", (double)norm, (double)status.scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Converged when the residual is small, incompressible cells keep their volume, and nothing prescribed is left. */
static PetscErrorCode Converged_Private(Solver s, Vec x, PetscReal norm, PetscBool *yes)
{
  PetscReal pending;

  PetscFunctionBegin;
  PetscCall(ProblemPending(s->problem, &pending));
  *yes = (PetscBool)(pending == 0 && KeepsVolume_Private(s) && Small_Private(s, &s->report->status, norm));
  if (*yes && s->balance) PetscCall(Balanced_Private(s, x, yes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc's finite-difference test of the tangent at x (-snes_test_jacobian), on a matrix whose pattern already fits x. */
static PetscErrorCode Test_Private(SNES snes, Solver s, Vec x)
{
  Mat       A;
  PetscBool bad;

  PetscFunctionBegin;
  PetscCall(ProblemSetSymmetric(s->problem, PETSC_FALSE));
  PetscCall(ProblemTangent(s->problem, x, NULL, NULL, &bad));
  PetscCall(ProblemGetMatrix(s->problem, &A));
  PetscCall(SNESSetJacobian(snes, A, A, NULL, NULL));
  PetscCall(SNESComputeJacobian(snes, x, A, A));
  PetscCall(ProblemSetSymmetric(s->problem, s->symmetric));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the residual come and go with the same active set? Near the solution it should not grow at all, elsewhere not after it has grown and fallen, if it is
   below that after the first iteration. */
static PetscErrorCode ComesAndGoes_Private(Solver s, PetscReal norm, uint64_t set, PetscBool *yes)
{
  const ProblemStatus *status = &s->report->status;
  const PetscReal      last = s->last_norm, tolerance = PetscMax(s->rtol * status->scale, status->noise);
  PetscReal            pending;

  PetscFunctionBegin;
  PetscCall(ProblemPending(s->problem, &pending));
  const PetscBool same = (PetscBool)(last > CLEAR * tolerance && set == s->last_set);
  *yes                 = (PetscBool)(same && norm >= last && (last <= NEAR * status->scale || (s->fell && last < s->first_norm)));
  s->grew              = (PetscBool)(s->grew || (same && norm >= last));
  s->fell              = (PetscBool)(s->fell || (s->grew && norm < last));
  s->last_norm         = pending == 0 ? norm : 0;
  s->last_set          = set;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where a crease of the mortar side comes to lie on a side of a nonmortar facet, derivatives of weighted gaps jump (docs/theory.md, after (5.8)), and residuals
   come and go. From then on forces are those at held lines, which do not jump, and so are r, its norm and the active set. */
static PetscErrorCode Lines_Private(SNES snes, Solver s, Vec x, Vec r, PetscReal *norm, uint64_t *set)
{
  PetscBool yes, changed;

  PetscFunctionBegin;
  if (s->report->held_lines) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ComesAndGoes_Private(s, *norm, *set, &yes));
  if (!yes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemHoldLines(s->problem, &changed));
  if (!changed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(snes, "residuals come and go: forces hold lines of mortar sides from here on\n"));
  s->report->held_lines = PETSC_TRUE;
  s->iterate_sets.num   = 0;
  s->best_norm          = PETSC_MAX_REAL;
  PetscCall(SNESComputeFunction(snes, x, r));
  PetscCall(VecNorm(r, NORM_2, norm));
  PetscCall(ProblemActiveSetHash(s->problem, set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the iteration over at residual norm? Then snes->reason is set. */
static PetscErrorCode Verdict_Private(SNES snes, Solver s, PetscReal norm, uint64_t set)
{
  PetscBool done, repeats;

  PetscFunctionBegin;
  PetscCall(Converged_Private(s, snes->vec_sol, norm, &done));
  PetscCall(SetHistoryAdd_Private(&s->iterate_sets, set, norm, PETSC_TRUE, &repeats));
  if (snes->iter == 1) s->first_norm = s->best_norm = norm; /* the first iterate carries the whole prescribed motion: progress counts from there */
  if (norm < s->best_norm) {
    s->best_norm = norm;
    s->best_iter = snes->iter;
  }
  if (done)
    PetscCall(Finish_Private(snes, s, SNES_CONVERGED_FNORM_RELATIVE, ""));
  else if (repeats) {
    ++s->report->set_cycles;
    PetscCall(Finish_Private(snes, s, SNES_DIVERGED_INNER, "the active set of contact repeats itself"));
  } else if (snes->iter - s->best_iter >= STALLED || s->halvings >= HALVINGS)
    PetscCall(Finish_Private(snes, s, SNES_DIVERGED_LINE_SEARCH, Words_Private(s, norm, "Newton stalls")));
  else if (snes->iter == s->max_it)
    PetscCall(Finish_Private(snes, s, SNES_DIVERGED_MAX_IT, Words_Private(s, norm, "Newton did not converge within -solve_max_it iterations")));
  else if (PetscIsInfOrNanReal(norm) || (snes->iter > 3 && norm > 1e4 * s->first_norm))
    PetscCall(Finish_Private(snes, s, SNES_DIVERGED_DTOL, "the Newton residual grew"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Give up when somebody asks to. */
static PetscErrorCode Obey_Private(SNES snes, Solver s)
{
  PetscFunctionBegin;
  PetscCall(StopAsked(PetscObjectComm((PetscObject)snes), &s->report->stopped));
  if (s->report->stopped) PetscCall(Finish_Private(snes, s, SNES_DIVERGED_MAX_IT, "the run was asked to stop"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bodies that nothing holds are held less the smaller the residual is, as far as the digits of the linear solver allow. */
static PetscErrorCode Loosen_Private(SNES snes, Solver s)
{
  const PetscBool digits = (PetscBool)(!s->single && !s->saddle);
  Mechanics       mechanics;

  PetscFunctionBegin;
  PetscCall(ProblemGetMechanics(s->problem, &mechanics));
  PetscCall(MechanicsLoosen(mechanics, snes->iter > 0 && digits ? PetscMax(LOOSE, PetscMin(1, s->report->residual / s->first_norm)) : 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the linear step slides bodies that only contact holds too far, the step with forces that hold them back. */
static PetscErrorCode Drift_Private(SNES snes, Solver s, Vec x, Vec dx, PetscBool *ok)
{
  PetscReal excess, slide;

  PetscFunctionBegin;
  for (PetscInt hold = 0; hold < HOLDS; ++hold) {
    PetscCall(ProblemDrift(s->problem, dx, s->hold, &excess));
    if (excess == 0) break;
    PetscCall(PetscInfo(snes, "a body that only contact holds would slide too far, by %g: it is held back\n", (double)excess));
    PetscCall(VecSwap(s->rhs, s->hold));
    PetscCall(MatrixSolve_Private(snes, s, PETSC_FALSE, ok));
    PetscCall(VecSwap(s->rhs, s->hold));
    if (!*ok) break;
    PetscCall(VecDot(s->hold, s->y, &slide));
    PetscCall(VecAXPY(s->rhs, -excess / slide, s->hold));
    PetscCall(LinearStep_Private(snes, s, x, dx, ok));
    if (!*ok) break;
    s->best_iter = snes->iter; /* a slide is progress */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The linearisation at x and its solution. */
static PetscErrorCode Linearise_Private(SNES snes, Solver s, Vec x, Vec r, Vec dx, PetscBool *ok)
{
  PetscBool bad, symmetric;

  PetscFunctionBegin;
  ++s->report->iterations;
  PetscCall(VecZeroEntries(s->lift));
  PetscCall(Loosen_Private(snes, s));
  PetscCall(ProblemTangent(s->problem, x, s->pressure, s->lift, &bad));
  PetscCall(ProblemGetSymmetric(s->problem, &symmetric));
  if (s->symmetric && !symmetric) PetscCall(SolverUnsymmetric_Private(s));
  *ok = (PetscBool)!bad;
  if (bad) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemRightSide(s->problem, r, s->lift, s->rhs));
  PetscCall(LinearStep_Private(snes, s, x, dx, ok));
  if (*ok) PetscCall(Drift_Private(snes, s, x, dx, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* When the first linear step takes the load off flowing material, it is replaced by that of elastic material. */
static PetscErrorCode Rest_Private(SNES snes, Solver s, Vec x, Vec r, Vec dx, PetscBool *ok)
{
  PetscBool rests;

  PetscFunctionBegin;
  PetscCall(ProblemRests(s->problem, x, dx, &rests));
  if (!rests) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(snes, "flow ends: the step begins elastic\n"));
  PetscCall(ProblemSetEdge(s->problem, EDGE_RESTS));
  PetscCall(Linearise_Private(snes, s, x, r, dx, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first linear step. Where contact moves along a surface, by what supports prescribe or else by what the linear step says, one that only carries the bodies
   to their new places takes its place: by the prescribed motion, without the pairs that move, and without the residual, so that loads on a body that nothing
   but such a pair holds wait for the next iteration. That one begins elastic: what was carried along still stands on its yield surface, and where the pair was
   the load comes off. */
static PetscErrorCode First_Private(SNES snes, Solver s, Vec x, Vec r, Vec dx, MaterialEdge *next, PetscBool *ok)
{
  PetscBool moved;

  PetscFunctionBegin;
  *ok   = PETSC_TRUE;
  *next = EDGE_AS_IT_IS;
  PetscCall(ProblemReleaseSlips(s->problem, &moved));
  if (!moved) {
    PetscCall(Linearise_Private(snes, s, x, r, dx, ok));
    if (*ok) PetscCall(Rest_Private(snes, s, x, r, dx, ok));
    if (*ok) PetscCall(ProblemRelease(s->problem, &moved));
  }
  if (!moved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(snes, "contact moves along: the bodies are carried to their new places first\n"));
  PetscCall(VecZeroEntries(r));
  PetscCall(Linearise_Private(snes, s, x, r, dx, ok));
  PetscCall(ProblemEngage(s->problem));
  *next = EDGE_RESTS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One linearisation and the step it gives; snes->reason is set when there is none to be had. */
static PetscErrorCode Iterate_Private(SNES snes, Solver s, Vec x, Vec r, Vec dx)
{
  PetscBool    ok;
  MaterialEdge next = EDGE_AS_IT_IS;

  PetscFunctionBegin;
  if (s->test) PetscCall(Test_Private(snes, s, x));
  if (snes->iter == 0) {
    PetscCall(ProblemSetEdge(s->problem, EDGE_FLOWS));
    PetscCall(First_Private(snes, s, x, r, dx, &next, &ok));
  } else
    PetscCall(Linearise_Private(snes, s, x, r, dx, &ok));
  PetscCall(ProblemSetEdge(s->problem, next));
  if (ok) PetscCall(Step_Private(snes, s, x, dx, r));
  if (!ok)
    PetscCall(Finish_Private(snes, s, SNES_DIVERGED_LINEAR_SOLVE, s->no_memory ? "out of memory for a factor of the tangent" : "the tangent is singular"));
  else if (s->report->status.bad)
    PetscCall(Finish_Private(snes, s, SNES_DIVERGED_FUNCTION_DOMAIN, "every step along the Newton direction inverts a cell"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SNESSolve_ContactNewton(SNES snes)
{
  Solver    s = NULL;
  Vec       x = snes->vec_sol, r = snes->vec_func;
  PetscReal norm;
  uint64_t  set;

  PetscFunctionBegin;
  PetscCall(SNESGetApplicationContext(snes, &s));
  snes->iter          = 0;
  snes->reason        = SNES_CONVERGED_ITERATING;
  s->iterate_sets.num = 0;
  s->best_norm        = PETSC_MAX_REAL;
  s->best_iter        = 0;
  s->halvings         = 0;
  s->negative         = -1;
  s->last_norm        = 0;
  s->last_set         = 0;
  s->grew = s->fell = PETSC_FALSE;
  PetscCall(ProblemSearch(s->problem, x));
  PetscCall(SNESComputeFunction(snes, x, r));
  if (s->report->status.bad) PetscCall(Finish_Private(snes, s, SNES_DIVERGED_FUNCTION_DOMAIN, "the start of the step has an inverted cell"));
  while (snes->reason == SNES_CONVERGED_ITERATING) {
    PetscCall(VecNorm(r, NORM_2, &norm));
    PetscCall(ProblemActiveSetHash(s->problem, &set));
    if (snes->iter > 0) PetscCall(Lines_Private(snes, s, x, r, &norm, &set));
    snes->norm          = norm;
    s->report->residual = norm;
    s->report->scale    = s->report->status.scale;
    PetscCall(SNESMonitor(snes, snes->iter, norm));
    PetscCall(Verdict_Private(snes, s, norm, set));
    if (snes->reason == SNES_CONVERGED_ITERATING) PetscCall(Obey_Private(snes, s));
    if (snes->reason != SNES_CONVERGED_ITERATING) break;
    PetscCall(Iterate_Private(snes, s, x, r, snes->vec_sol_update));
    ++snes->iter;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SNESCreate_ContactNewton(SNES snes)
{
  PetscFunctionBegin;
  snes->ops->solve                  = SNESSolve_ContactNewton;
  snes->usesksp                     = PETSC_TRUE;
  snes->usesnpc                     = PETSC_FALSE;
  snes->alwayscomputesfinalresidual = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
