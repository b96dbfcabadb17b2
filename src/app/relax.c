/* A step to an equilibrium that is not near the last one: bodies that snap, or material that flows so far at a new contact that Newton's method does not get
   there. Time and prescribed motion are those of the step's end; drag holds the bodies back (mechanics/drag.c), so that there is a solution near by, from which
   they creep on under less and less of it. The last solve is without any, so that what is found is an equilibrium like all others. The energy that drag took
   is what a snap sets free. */
#include "appimpl.h"

#define FIRST 1e-1 /* rate of the first solve; 1: as stiff as the material */
#define LEAST 1e-5 /* after a solve with no more, one without */
#define MOST 1e2   /* more leaves nothing to move */
#define EASE 0.1   /* factor after a solve that succeeded */
#define HARDER 4   /* after one that did not */
#define SOLVES 40  /* in one step */
#define FAILURES 5 /* one after another */

PetscErrorCode AppRelax(App *app, PetscReal t, PetscBool *ok)
{
  Level       *l    = &app->level;
  PetscReal    rate = FIRST, work;
  State        start; /* the accepted one, or that of the last solve that succeeded */
  SolverReport report;

  PetscFunctionBegin;
  app->drag_work = 0;
  *ok            = PETSC_FALSE;
  PetscCall(StateCreate(l->problem, &start));
  PetscCall(StateCopy(&l->accepted, &start));
  for (PetscInt solve = 0, failures = 0; solve < SOLVES && failures < FAILURES && rate <= MOST && !*ok && !app->stopped; ++solve) {
    PetscCall(StateCopy(&start, &l->state));
    PetscCall(AppPrescribeAt(l->problem, start.t));
    PetscCall(ProblemSetDrag(l->problem, rate, start.x));
    PetscCall(AppAttempt(app, t, &report));
    PetscCall(PetscInfo(NULL, "drag %g: %s\n", (double)rate, report.converged ? "found" : report.reason));
    failures = report.converged ? 0 : failures + 1;
    if (report.converged) {
      PetscCall(ProblemDragWork(l->problem, l->state.x, &work));
      PetscCall(StateCopy(&l->state, &start));
      app->drag_work += work;
      *ok  = (PetscBool)(rate == 0);
      rate = rate > LEAST ? EASE * rate : 0;
    } else
      rate = HARDER * PetscMax(rate, LEAST);
  }
  PetscCall(ProblemSetDrag(l->problem, 0, NULL));
  PetscCall(StateDestroy(&start));
  PetscFunctionReturn(PETSC_SUCCESS);
}
