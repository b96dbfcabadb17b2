/* Private to diagnose. */
#pragma once
#include "diagnose.h"

/* terminal.c: a terminal that shows \r and "erase to the end of the line" to somebody, also behind a launcher of MPI. */
PetscBool DiagnoseIsTerminal(FILE *stream);

/* ---- outer facets as they are drawn, in straight pieces (pieces.c) -------------------------------------------------------- */

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

/* Those of this rank's cells where displacements are u (local array), or at a state; of rigid bodies too if wanted; freed by the caller. At one mesh always
   the same pieces in the same order. Collective. */
PetscErrorCode PiecesAt_Private(Problem, const PetscReal u[], PetscBool rigid, Pieces *);
PetscErrorCode PiecesCollect_Private(Problem, const State *, PetscBool rigid, Pieces *);
/* (*is)[part][2 pair + side]: the part has facets of this side of the pair; freed by the caller. Collective. */
PetscErrorCode PiecesParts_Private(const Pieces *, MPI_Comm, int8_t **is);
/* bare[pair]: no node of it was in contact at the last evaluation; any: of one pair. Collective. */
PetscErrorCode PairsBare_Private(Problem, MPI_Comm, PetscInt num, PetscInt bare[], PetscBool *any);
/* The middle of a piece with these corners. */
static inline void PieceMiddle_Private(PetscInt dim, const PetscReal x[9], PetscReal middle[3])
{
  for (PetscInt c = 0; c < 3; ++c) {
    middle[c] = 0;
    for (PetscInt a = 0; a < dim; ++a) middle[c] += x[3 * a + c] / dim;
  }
}
/* The boundary group of a side, as a bit of Piece.groups. */
static inline uint64_t PairGroup_Private(const ContactSpec *c, PetscInt side)
{
  return UINT64_C(1) << (side ? c->mortar : c->nonmortar);
}

/* Does the line from x along d leave or enter through the piece? From a place inside a body an odd number does, along either of these (inside.c). */
PetscBool              LineCrosses_Private(PetscInt dim, const Piece *, const PetscReal x[3], const PetscReal d[3]);
extern const PetscReal LinesAlong_Private[2][3];

/* ---- points that go through pieces (crossing.c) ---------------------------------------------------------------------------- */

typedef struct {
  PetscReal s, N[3]; /* on the way; unit outward normal of the piece there */
  PetscBool out;     /* along it, else against it */
} Crossing;

/* Where, -1 < s < 1, a point that goes from y[0] (s = 0) to y[1] (s = 1) meets a piece (Piece.x) whose corners go from x[0] to x[1]. Returns their number. */
PetscInt CrossingsFind_Private(PetscInt dim, const PetscReal x[2][9], const PetscReal y[2][3], Crossing[3]);
/* Unit outward normal of such a piece at s. */
void MovingNormal_Private(PetscInt dim, const PetscReal x[2][9], PetscReal s, PetscReal N[3]);
