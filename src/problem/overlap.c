/* Overlap at the start (src/interface/overlap.c). */
#include "problemimpl.h"

PetscErrorCode ProblemNoteOverlap(Problem p, Vec x, PetscReal *deepest)
{
  ProblemStatus status;
  Vec           r;

  PetscFunctionBegin;
  PetscCall(ProblemLeaveOverlap(p, 0));
  PetscCall(ProblemCreateVector(p, &r));
  PetscCall(ProblemSearch(p, x));
  PetscCall(ProblemResidual(p, x, NULL, r, &status));
  PetscCall(VecDestroy(&r));
  PetscCall(InterfaceNoteOverlap(p->interface, deepest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemLeaveOverlap(Problem p, PetscReal share)
{
  PetscFunctionBegin;
  PetscCall(InterfaceLeaveOverlap(p->interface, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
