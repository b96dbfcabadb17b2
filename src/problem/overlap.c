/* Overlap at the start (src/interface/overlap.c). */
#include "problemimpl.h"

PetscErrorCode ProblemNoteOverlap(Problem p, Vec x, PetscReal *deepest)
{
  PetscFunctionBegin;
  PetscCall(ProblemLeaveOverlap(p, 0));
  PetscCall(ProblemSearch(p, x));
  PetscCall(ProblemRefresh(p, x));
  PetscCall(InterfaceNoteOverlap(p->interface, deepest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemLeaveOverlap(Problem p, PetscReal share)
{
  PetscFunctionBegin;
  PetscCall(InterfaceLeaveOverlap(p->interface, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
