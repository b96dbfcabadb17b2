/* Overlap at the start (src/interface/overlap.c). */
#include "problemimpl.h"

PetscErrorCode ProblemNoteOverlap(Problem p, Vec x, PetscReal *deepest)
{
  PetscFunctionBegin;
  ProblemLeaveOverlap(p, 0);
  PetscCall(ProblemSearch(p, x));
  PetscCall(ProblemRefresh(p, x));
  PetscCall(InterfaceNoteOverlap(p->interface, deepest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ProblemLeaveOverlap(Problem p, PetscReal share)
{
  InterfaceLeaveOverlap(p->interface, share);
}
