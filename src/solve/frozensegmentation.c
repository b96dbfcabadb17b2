/* Modifier: where a crease of the mortar side (in the plane: its end, with an open gap there) comes to lie on a side of a nonmortar facet, derivatives of
   weighted gaps jump (docs/theory.md, after (5.8)), and residuals come and go; in the plane the end goes over that side and comes back. From then on the
   segmentation is frozen in forces, which do not jump then; on: from the first iterate on. */
#include "solveimpl.h"

/* Does the residual come and go with the same active set? Near the solution it should not grow at all, elsewhere not
   after it has grown and fallen, if it is below that after the first iteration. A step that was too far would have made
   it grow: it is shortened at the jump, again and again. */
static PetscErrorCode ComesAndGoes_Private(Solver s, const Iterate *it, PetscBool *yes)
{
  const PetscReal last = s->course.last_norm;
  PetscReal       pending;

  PetscFunctionBegin;
  PetscCall(ProblemPending(s->problem, &pending));
  const PetscBool grows = (PetscBool)(it->norm >= last || s->course.shortened);
  const PetscBool same  = (PetscBool)(last > SolverTolerance_Private(s, &s->report->status) && it->set == s->course.last_set);
  *yes           = (PetscBool)(same && grows && (last <= PetscSqrtReal(s->rtol) * s->report->status.scale || (s->course.fell && last < s->course.first_norm)));
  s->course.grew = (PetscBool)(s->course.grew || (same && grows));
  s->course.fell = (PetscBool)(s->course.fell || (s->course.grew && it->norm < last));
  s->course.last_norm = pending == 0 ? it->norm : 0;
  s->course.last_set  = it->set;
  s->course.shortened = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Verdict_Private(Solver s, Iterate *it, PetscBool always, PetscBool *acts)
{
  PetscBool yes = always;

  PetscFunctionBegin;
  InterfaceWatchEnds(ProblemInterface(s->problem), (PetscBool)(it->number <= 1)); /* the first iterate carries the whole prescribed motion */
  if (s->form.frozen_segmentation || (it->number == 0 && !always)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!always) PetscCall(ComesAndGoes_Private(s, it, &yes));
  if (yes) PetscCall(ProblemMayFreezeSegmentation(s->problem, always, acts));
  if (s->never_freeze && (always || *acts)) {
    *acts       = PETSC_FALSE;
    it->trouble = "the residual of Newton's method goes in circles: contact forces jump where facets of both sides begin or cease to overlap";
    it->reason  = SNES_DIVERGED_LINE_SEARCH;
  }
  if (!*acts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "residuals come and go: the segmentation of mortar sides is frozen in forces from here on\n"));
  s->form.frozen_segmentation = PETSC_TRUE;
  s->course.best_norm         = PETSC_MAX_REAL;
  PetscCall(ProblemSetForm(s->problem, &s->form));
  PetscCall(SolverLook_Private(s, it));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierFrozenSegmentation = {"frozen_segmentation", "contact forces of a frozen segmentation where residuals come and go; on: always",
                                             .verdict = Verdict_Private};
