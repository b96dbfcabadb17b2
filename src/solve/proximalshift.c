/* Modifier: bodies that nothing holds get a small stiffness in the tangent (src/mechanics/free.c), the less the smaller
   the residual is, as far as the digits of the linear solver allow: the method of Levenberg and Marquardt. Without it
   the tangent of a body that no support holds may be singular. */
#include "solveimpl.h"

#define LEAST 1e-6 /* least part of it: round-off of factors is far below */

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  const PetscBool digits = (PetscBool)(!s->single && !s->saddle);

  PetscFunctionBegin;
  s->form.proximal = 1;
  if (it->number > 0 && digits && !always) s->form.proximal = PetscMax(LEAST, PetscMin(1, it->norm / s->course.first_norm));
  *acts = ProblemHasFreeBody(s->problem);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where friction alone holds a body the tangent is singular as soon as all nodes slip, which those at their bounds may as well do as stick: the step then
   carries the body off, and no set agrees with it. With all of the shift it stays. */
static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  PetscFunctionBegin;
  if (s->settled || s->passes == 0 || !(s->form.proximal < 1) || !ProblemHasFreeBody(s->problem)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "no active set agrees with the linear step: once more with all of the proximal shift\n"));
  s->form.proximal = 1;
  *acts = *again = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierProximalShift = {"proximal_shift", "a small stiffness of bodies that no support holds, less as Newton converges; on: all of it always",
                                        .linearise = Linearise_Private, .correct = Correct_Private};
