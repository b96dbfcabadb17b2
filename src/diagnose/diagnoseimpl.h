/* Private to diagnose. */
#pragma once
#include "diagnose.h"

/* terminal.c: a terminal that shows \r and "erase to the end of the line" to somebody, also behind a launcher of MPI. */
PetscBool DiagnoseIsTerminal(FILE *stream);

/* ---- outer facets as they are drawn, in straight pieces (passage.c) ------------------------------------------------------- */

typedef struct {
  PetscReal x[9], X[9]; /* corners, counterclockwise seen from outside (plane: the body to the left), now and at the reference positions */
  PetscReal N[3], size; /* unit outward normal; longest edge */
  PetscReal box[6];
  uint64_t  groups; /* of its facet */
  PetscInt  part, body;
} Piece;

typedef struct {
  PetscInt         dim, num, room, num_parts;
  Piece           *piece; /* owned */
  const SceneData *scene;
} Pieces;

/* Those of this rank's cells at a state, of rigid bodies too if wanted; freed by the caller. Collective. */
PetscErrorCode PiecesCollect_Private(Problem, const State *, PetscBool rigid, Pieces *);
