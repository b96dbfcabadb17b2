/* Modifier: plastic flow by its secant stiffness where Newton's method goes too far. Where material flows, stress hardly
   changes with the size of the strain's increment, and at once with its direction. Along the flow the tangent is as soft as
   hardening is: forces a tenth out of balance move it by many times the strain at yield, and where it moves the direction
   turns. The secant stiffness, stress over increment, is too stiff there (of small strain it lowers the energy at every
   step, Kačanov's iteration) and leaves a linear rate. So the first step of a solve that leaves the domain or goes too far
   is taken back, and from there on the tangent has a share of the secant stiffness: all of it there, and wherever the
   residual has risen or a step was shortened; then the fourth power of what is left of the residual [Fraters, Bangerth,
   Thieulot, Glerum, Spakman 2019, the flow of rocks: the first power]. From the first power on Newton's order is kept. A
   solve that begins elastic because one that began as flow has failed has it from its first iterate on. */
#include "solveimpl.h"

static PetscBool IsPlastic_Private(Solver s)
{
  return MechanicsIsPlastic(&ProblemGetScene(s->problem)->mechanics);
}

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  if (IsPlastic_Private(s) && s->swap && it->number == 1) s->course.flow_start = it->norm;
  if (s->course.flow_start == 0) PetscFunctionReturn(PETSC_SUCCESS);
  s->form.secant = PetscSqr(PetscSqr(it->norm / s->course.flow_start));
  *acts          = (PetscBool)(s->step < 1 || s->form.secant > last->secant);
  if (!*acts) PetscFunctionReturn(PETSC_SUCCESS);
  s->course.flow_start = it->norm;
  s->form.secant       = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Shorten_Private(Solver s, const Iterate *it, Vec dx, PetscReal *step, PetscBool *acts)
{
  PetscFunctionBegin;
  if (!IsPlastic_Private(s) || s->course.flow_start > 0 || *step == 1) PetscFunctionReturn(PETSC_SUCCESS);
  s->course.flow_start = it->norm;
  *step                = 0;
  PetscCall(ProblemStepMove(s->problem, dx, 0, PETSC_FALSE, it->x));
  PetscCall(SNESComputeFunction(s->snes, it->x, it->r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierSecantFlow = {"secant_flow", "plastic flow by its secant stiffness where a step of Newton's method goes too far",
                                     .linearise = Linearise_Private, .shorten = Shorten_Private};
