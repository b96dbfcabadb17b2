/* Modifier: where the linear step slides bodies that only contact holds too far, the step is made with forces that hold
   them back (src/interface/slidelimit.c). */
#include "solveimpl.h"

#define MOST_PAIRS 3 /* that are held back in one linear step */

static PetscErrorCode Correct_Private(Solver s, const Iterate *it, Vec dx, PetscBool *acts, PetscBool *again)
{
  PetscReal excess, slide;
  PetscBool settled;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < MOST_PAIRS && !s->no_solution; ++i) {
    PetscCall(ProblemFindSlide(s->problem, dx, s->hold, &excess));
    if (excess == 0) break;
    *acts = PETSC_TRUE;
    PetscCall(PetscInfo(s->snes, "a body that only contact holds would slide too far, by %g: it is held back\n", (double)excess));
    PetscCall(SolverMatrixSolve_Private(s, s->hold, PETSC_FALSE));
    if (s->no_solution) break;
    PetscCall(VecDot(s->hold, s->y, &slide));
    PetscCall(VecAXPY(s->rhs, -excess / slide, s->hold));
    PetscCall(SolverActiveSetSolve_Private(s, PETSC_FALSE, dx, &settled));
    s->course.best_iter = it->number; /* a slide is progress */
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Modifier ModifierSlideLimiter = {"slide_limiter", "bodies that only contact holds slide at most half the distance of two nodes in a linear step",
                                       .correct = Correct_Private};
