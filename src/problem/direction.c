/* Orders per direction: which direction of space an axis of a cell runs along. */
#include "problemimpl.h"

/* The line through the cell's centre from one side to the opposite one. */
static PetscErrorCode CellAxis_Private(Forest forest, PetscInt leaf, PetscInt axis, PetscReal line[3])
{
  PetscReal xi[3] = {0.5, 0.5, 0.5}, low[3];

  PetscFunctionBegin;
  xi[axis] = 0;
  PetscCall(ForestMapPoint(forest, leaf, xi, low));
  xi[axis] = 1;
  PetscCall(ForestMapPoint(forest, leaf, xi, line));
  for (PetscInt c = 0; c < 3; ++c) line[c] -= low[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The order along a line: that of the direction with the largest |cosine|, of several equal ones the highest. */
static PetscInt OrderAlong_Private(const BodySpec *body, const PetscReal line[3])
{
  const PetscReal length = PetscSqrtReal(Dot3(line, line));
  PetscReal       most   = 0;
  PetscInt        order  = 0;

  for (PetscInt c = 0; c < 3; ++c) most = PetscMax(most, PetscAbsReal(line[c]));
  for (PetscInt c = 0; c < 3; ++c) {
    if (PetscAbsReal(line[c]) >= most - ROUND_LENGTH * length) order = PetscMax(order, body->order_along[c] ? body->order_along[c] : body->order);
  }
  return order;
}

PetscErrorCode ProblemOrderCaps(const SceneData *scene, Forest forest, int8_t (**cap)[3])
{
  PetscBool lower = PETSC_FALSE;

  PetscFunctionBegin;
  *cap                  = NULL;
  const ForestTables *t = ForestGetTables(forest);
  for (PetscInt b = 0; b < scene->mechanics.num_bodies; ++b) {
    for (PetscInt c = 0; c < t->dim; ++c) lower = (PetscBool)(lower || scene->bodies[b].order_along[c]);
  }
  if (!lower) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(t->num_leaves, cap));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    const BodySpec *body = &scene->bodies[t->leaf_body[l]];
    for (PetscInt a = 0; a < 3; ++a) {
      PetscReal line[3];
      (*cap)[l][a] = MORTISE_MAX_ORDER;
      if (a >= t->dim) continue;
      PetscCall(CellAxis_Private(forest, l, a, line));
      const PetscInt order = OrderAlong_Private(body, line);
      if (order < body->order) (*cap)[l][a] = (int8_t)order;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
