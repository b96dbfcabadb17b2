/* Modifier: the side of the yield surface that the tangent takes points on it to be. The first linear step of a solve
   expects them to flow on; when it takes the load off most of them, it is made again elastic (src/problem/yieldedge.c).
   After a step that only carried bodies along, material is elastic, too: what was carried still stands on its yield
   surface, and where the pair was the load comes off. */
#include "solveimpl.h"

static PetscErrorCode Linearise_Private(Solver s, const Iterate *it, const Form *last, PetscBool always, PetscBool *acts)
{
  PetscFunctionBegin;
  if (!MechanicsIsPlastic(&ProblemGetScene(s->problem)->mechanics)) PetscFunctionReturn(PETSC_SUCCESS);
  s->form.edge = it->number == 0 ? (s->swap ? EDGE_RESTS : EDGE_FLOWS) : last->released ? EDGE_RESTS : EDGE_AS_IT_IS;
  *acts        = (PetscBool)(s->form.edge != EDGE_AS_IT_IS);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  PetscFunctionBegin;
  if (s->form.edge != EDGE_FLOWS || s->form.released) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemUnloads(s->problem, it->x, dx, acts));
  if (!*acts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscInfo(s->snes, "flow ends: the step begins elastic\n"));
  s->form.edge = EDGE_RESTS;
  *again       = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierYieldEdge = {"yield_edge", "steps of plastic material begin as flow, or elastic where the load comes off",
                                    .linearise = Linearise_Private, .correct = Correct_Private};
