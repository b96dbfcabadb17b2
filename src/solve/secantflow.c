/* Modifier: plastic flow by its secant stiffness far from a solution. Where material flows, stress hardly changes with the
   size of the strain's increment, and at once with its direction. Along the flow the tangent is as soft as hardening is:
   forces a tenth out of balance move it by many times the strain at yield, and where it moves the direction turns. The
   secant stiffness, stress over increment, is too stiff there (of small strain it lowers the energy at every step,
   Kačanov's iteration) and leaves a linear rate. So the tangent has a share of it: all of it at the first iterate of a
   step, and wherever the residual has risen or the last step was shortened; from there on the fourth power of what is
   left of the residual [Fraters, Bangerth, Thieulot, Glerum, Spakman 2019, the flow of rocks: the first power]. From the
   first power on Newton's order is kept; the fourth is nearer to Newton's method in steps that need none of this. */
#include "solveimpl.h"

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  const SceneData *scene;

  PetscFunctionBegin;
  PetscCall(ProblemGetScene(s->problem, &scene));
  if (!MechanicsIsPlastic(&scene->mechanics) || it->number == 0) PetscFunctionReturn(PETSC_SUCCESS);
  *acts = (PetscBool)(it->number == 1 || s->step < 1 || it->norm > s->flow_norm);
  if (*acts) s->flow_start = it->norm;
  s->flow_norm   = it->norm;
  s->form.secant = s->flow_start > 0 ? PetscSqr(PetscSqr(it->norm / s->flow_start)) : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierSecantFlow = {"secant_flow", "plastic flow by its secant stiffness far from a solution, by its tangent near it",
                                     .linearise = Linearise_Private};
