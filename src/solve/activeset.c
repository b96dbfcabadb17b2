/* The active set of a linear step: which nodes bear, stick and slip if gaps, slip and multipliers change as the tangent says. Every node whose state disagrees
   with the step switches at once, which mostly ends after a few passes, but may go in circles: where a fine side faces a coarser one, and round corners within
   a facet, few nodes bear, and each relieves others. Where no pass in s->passes leaves fewer nodes that disagree than any before, or a set comes again, one
   node alone switches, the last one, until fewer disagree: block principal pivoting with Murty's rule in reserve (J. J. Júdice, F. M. Pires, Computers &
   Operations Research 21 (1994) 587), which ends for any linear complementarity problem whose matrix is positive definite, but may take many passes: of the
   many nodes of a rigid side on one facet of the other few bear. So where as many passes more leave no fewer, that farthest off switches, and the last one
   again where a set comes again. Where the tangent has negative pivots beyond those of constraints it is not, and no set may agree: the tangent is made again
   at fixed directions then (frozennormals.c). Sets may come again although one node at a time switches, with friction above all. Where nothing says that single
   switches end they do after s->passes in a row that leave no fewer nodes in disagreement. Then the last linear step is taken. */
#include "solveimpl.h"

typedef struct {
  PetscInt   pass, first; /* number of the pass; of the first whose set may come again */
  PetscInt   least, idle; /* nodes that disagreed, at the fewest; passes since then */
  SwitchRule rule;        /* of the last pass */
  PetscBool  murty;       /* a set came again although the worst switched: the last one from now on */
} Passes;

static PetscErrorCode LinearSolve_Private(Solver s, PetscBool again, Vec dx)
{
  PetscFunctionBegin;
  PetscCall(SolverMatrixSolve_Private(s, s->rhs, again));
  if (s->no_solution) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemRecover(s->problem, s->y, dx));
  PetscCall(InterfaceOpenIncrement(ProblemInterface(s->problem), dx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Notes the set of this pass. *seen: it has been there before. */
static PetscErrorCode Note_Private(Solver s, const Passes *p, PetscBool *seen)
{
  PetscInt k = p->pass - 1;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(p->pass + 1, sizeof(*s->pass_sets), &s->pass_room, &s->pass_sets));
  PetscCall(InterfaceActiveSetHash(ProblemInterface(s->problem), &s->pass_sets[p->pass]));
  while (k >= p->first && s->pass_sets[k] != s->pass_sets[p->pass]) --k;
  *seen = (PetscBool)(k >= p->first);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes that disagree with the linear step switch: all, or one. */
static PetscErrorCode Switch_Private(Solver s, Passes *p, SwitchRule rule, Vec dx, PetscInt *disagree)
{
  const PetscBool single = (PetscBool)(rule != SWITCH_ALL);

  PetscFunctionBegin;
  if (single && p->rule != rule) p->first = p->pass;
  p->rule = rule;
  PetscCall(ProblemSwitchActiveSet(s->problem, dx, rule, s->rhs, disagree));
  s->report->set_changes += single ? *disagree > 0 : *disagree;
  s->report->single_switches += single && *disagree > 0;
  PetscCall(PetscInfo(s->snes, "active-set pass %" PetscInt_FMT ": %" PetscInt_FMT " nodes disagree%s\n", p->pass, *disagree, single ? ", one switches" : ""));
  if (*disagree >= p->least) {
    p->idle = single ? PetscMax(p->idle, s->passes) + 1 : p->idle + 1;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  p->least = *disagree;
  p->idle  = 0;
  p->murty = PETSC_FALSE;
  if (single) p->first = p->pass + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The set of the last pass may begin the next linear step, if this one was of the whole problem. */
static void Keep_Private(Solver s, const Passes *p, PetscBool settled)
{
  s->settled = settled && !s->no_solution ? ~(s->form.released | s->form.untouched) : 0;
  if (!s->settled) return;
  s->report->pressed |= InterfaceKeepActiveSet(ProblemInterface(s->problem));
  s->settled_set = s->pass_sets[p->pass - 1];
}

PetscErrorCode SolverActiveSetSolve_Private(Solver s, PetscBool again, Vec dx, PetscBool *settled)
{
  Passes          p            = {.least = PETSC_MAX_INT};
  PetscInt        disagree     = 1;
  PetscBool       convex       = PETSC_TRUE, seen;
  const PetscBool frictionless = (PetscBool)(s->form.pressures_first || !InterfaceSlips(ProblemInterface(s->problem)));

  PetscFunctionBegin;
  s->no_set = PETSC_FALSE;
  for (; disagree && !s->report->stopped; ++p.pass) {
    PetscCall(Note_Private(s, &p, &seen));
    if (seen && p.rule == SWITCH_LAST) {
      ++s->report->set_cycles;
      PetscCall(PetscInfo(s->snes, "active sets repeat after %" PetscInt_FMT " passes\n", p.pass));
      break;
    }
    PetscCall(LinearSolve_Private(s, (PetscBool)(again || p.pass > 0), dx));
    convex                 = (PetscBool)(convex && s->negative <= 0);
    const PetscBool single = (PetscBool)(seen || p.idle >= s->passes);
    if (s->no_solution || s->passes == 0) break;
    if (single && !convex && s->form.frozen_normals != ALL_PAIRS) {
      s->no_set = PETSC_TRUE;
      PetscCall(PetscInfo(s->snes, "no active set agrees after %" PetscInt_FMT " passes, and the linearised problem is not convex\n", p.pass));
      break;
    }
    if (single && (!s->single_switches || (p.idle >= 2 * s->passes && !(convex && frictionless)))) break;
    p.murty               = (PetscBool)(p.murty || (seen && p.rule == SWITCH_WORST));
    const PetscBool worst = (PetscBool)(frictionless && convex && p.idle >= 2 * s->passes && !p.murty);
    PetscCall(Switch_Private(s, &p, !single ? SWITCH_ALL : worst ? SWITCH_WORST : SWITCH_LAST, dx, &disagree));
    if (disagree) PetscCall(StopAsked(PetscObjectComm((PetscObject)s->snes), &s->report->stopped));
  }
  *settled = (PetscBool)(disagree == 0);
  Keep_Private(s, &p, *settled);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What friction bears is a share of pressures. At first touch there are none: where states go by those of the nodes that happen to be first, they never settle
   on slender bodies. So the nodes that press are found as without friction, and then who sticks and who slips. What nothing but friction holds may not settle
   so: then both at once. */
PetscErrorCode SolverPressuresFirst_Private(Solver s, Vec dx, PetscBool *settled)
{
  PetscInt changed;

  PetscFunctionBegin;
  PetscCall(SolverActiveSetSolve_Private(s, PETSC_FALSE, dx, settled));
  s->form.pressures_first = PETSC_FALSE;
  if (!*settled || s->no_solution) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemSetForm(s->problem, &s->form));
  PetscCall(ProblemSwitchActiveSet(s->problem, dx, SWITCH_ALL, s->rhs, &changed));
  s->report->set_changes += changed;
  if (changed) PetscCall(SolverActiveSetSolve_Private(s, PETSC_TRUE, dx, settled));
  *settled = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
