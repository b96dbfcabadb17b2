/* Everything bound to one mesh. */
#include "path.h"

/* Takes the forest over. The states start at rest at time t. */
PetscErrorCode LevelCreate(const SceneData *data, Forest forest, const int8_t leaf_order[], PetscReal t, Level *level)
{
  const char *earlier;

  PetscFunctionBegin;
  PetscCall(ExpressionTrouble(ForestComm(forest), &earlier));
  PetscCall(StageBegin(STAGE_SETUP));
  level->forest = forest;
  PetscCall(ProblemCreate(data, forest, leaf_order, &level->problem));
  PetscCall(ProblemSetTime(level->problem, t));
  PetscCall(ProblemJump(level->problem));
  PetscCall(SolverCreate(level->problem, &level->solver));
  PetscCall(StateCreate(level->problem, &level->state));
  PetscCall(StateCreate(level->problem, &level->accepted));
  level->state.t = level->accepted.t = t;
  PetscCall(StageEnd(STAGE_SETUP));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MOST_TIMES 100 /* at which supports are compared, beside the corners of amplitudes */

/* Supports that meet must agree, at the end of each step planned at least where these are few. What is not finite then is told when its time comes. */
static PetscErrorCode CheckSupports_Private(const SceneData *data, const Level *level)
{
  const PetscReal dt            = PetscMax(data->load.step, data->load.end / MOST_TIMES);
  char            conflict[512] = "";
  const char     *words;

  PetscFunctionBegin;
  for (PetscReal t = level->state.t; t < data->load.end && !conflict[0];) {
    t = PathStepEnd(data, t, dt);
    PetscCall(ProblemFindConflict(level->problem, t, sizeof(conflict), conflict));
  }
  PetscCall(ExpressionTrouble(ForestComm(level->forest), &words));
  PetscCheckInput(!conflict[0], "%s", conflict);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LevelCheck(const SceneData *data, const Level *level)
{
  PetscInt    order, leaf;
  PetscReal   X[3];
  const char *words;

  PetscFunctionBegin;
  PetscCall(ExpressionTrouble(ForestComm(level->forest), &words));
  PetscCheckInput(!words, "%s", words);
  PetscCall(ProblemFindInverted(level->problem, &order, X, &leaf));
  PetscCheckInput(!order,
                  "mesh: a cell of order %" PetscInt_FMT " at (%g, %g, %g) is inverted, for sides that are straight or hang from coarser cells cut across "
                  "curved ones; take smaller cells there, a higher order or mesh.order: 1, or other refinements",
                  order, (double)X[0], (double)X[1], (double)X[2]);
  PetscCall(CheckSupports_Private(data, level));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LevelDestroy(Level *level)
{
  PetscFunctionBegin;
  PetscCall(StateDestroy(&level->state));
  PetscCall(StateDestroy(&level->accepted));
  PetscCall(SolverDestroy(&level->solver));
  PetscCall(ProblemDestroy(&level->problem));
  PetscCall(ForestDestroy(&level->forest));
  PetscFunctionReturn(PETSC_SUCCESS);
}
