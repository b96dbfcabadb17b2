/* Faces of a contact side. Where the mortar side has an edge, a facet of the other side that lies across it sees two faces, and one multiplier for both
   would hold a mean of their gaps: of one that is closed under a punch and of one that is open beside it. So what lies across an edge is met by multipliers
   of its own: the pair is made once for each colour. Faces that share an edge or a corner have different ones, and so have two with one face between them: rays
   of a facet that pass the end of a flank run through the play along the next one and meet the flank behind it, and the gap would jump from one to the other.
   So is a pair of one surface made, of which a node on an edge may touch with one of its faces while the other one sees the far side of a hollow.

   A convex edge parts what no facet faces squarely on both sides (CONTACT_OPPOSE): over a blunter one both gaps are those of the facet, and constraints for
   each would be more than it has nodes. In a concave one a corner of the other side is held by both.

   Faces are those of the coarse mesh and its curved sides: refinement changes none. */
#include "rim.h"

#define MOST 64  /* colours that are told apart */
#define AROUND 8 /* most faces round one that is between two of them; what has more, as the front of a rack, is what they stand on */

static PetscInt Root_Private(PetscInt parent[], PetscInt i)
{
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/* Do the two sides that meet in a vertex (plane) or an edge (space) belong to one face? */
static PetscBool IsJoined_Private(const Rim *a, const Rim *b)
{
  return (PetscBool)(Dot3(a->N, b->N) >= (Dot3(a->N, b->T) < 0 ? CONTACT_OPPOSE : CONTACT_SHARP));
}

static int ComparePairs_Private(const void *a, const void *b)
{
  const PetscInt *x = a, *y = b;

  if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
  return x[1] < y[1] ? -1 : x[1] > y[1];
}

/* The end of the run of one entity. */
static PetscInt End_Private(PetscInt num, const Rim rim[], PetscInt from)
{
  PetscInt end = from;
  while (end < num && rim[end].entity == rim[from].entity) ++end;
  return end;
}

/* Pairs of faces, by their roots, that meet in an edge or a corner, both ways, each once. */
static PetscErrorCode Beside_Private(PetscInt num, const Rim rim[], PetscInt parent[], PetscInt *num_pairs, PetscInt (**pair)[2])
{
  PetscInt room = 0;

  PetscFunctionBegin;
  *num_pairs = 0;
  for (PetscInt k = 0, end; k < num; k = end) {
    end = End_Private(num, rim, k);
    room += (end - k) * (end - k - 1);
  }
  PetscCall(PetscMalloc1(room, pair));
  for (PetscInt k = 0, end; k < num; k = end) {
    end = End_Private(num, rim, k);
    for (PetscInt i = k; i < end; ++i)
      for (PetscInt j = k; j < end; ++j) {
        const PetscInt a = Root_Private(parent, rim[i].side), b = Root_Private(parent, rim[j].side);
        if (a == b) continue;
        (*pair)[*num_pairs][0]     = a;
        (*pair)[(*num_pairs)++][1] = b;
      }
  }
  qsort(*pair, (size_t)*num_pairs, sizeof(**pair), ComparePairs_Private);
  room       = *num_pairs;
  *num_pairs = 0;
  for (PetscInt k = 0; k < room; ++k)
    if (k == 0 || ComparePairs_Private(&(*pair)[k], &(*pair)[*num_pairs - 1])) PetscCall(PetscArraycpy((*pair)[(*num_pairs)++], (*pair)[k], 2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Colours, one bit each, that faces before `before` have of those beside a face, pair[first[face]] .. pair[first[face + 1]]. */
static uint64_t Taken_Private(const PetscInt first[], PetscInt (*pair)[2], PetscInt face, PetscInt before, const int8_t colour[])
{
  uint64_t taken = 0;
  for (PetscInt k = first[face]; k < first[face + 1]; ++k)
    if (pair[k][1] < before) taken |= UINT64_C(1) << colour[pair[k][1]];
  return taken;
}

/* Colours of faces in the order of their roots, each the least that no face beside it has yet, nor one that a face is between. */
static PetscErrorCode Colours_Private(PetscInt num, const Rim rim[], PetscInt parent[], PetscInt num_sides, int8_t colour[], PetscInt *num_colours)
{
  PetscInt num_pairs, (*pair)[2], *first;

  PetscFunctionBegin;
  PetscCall(Beside_Private(num, rim, parent, &num_pairs, &pair));
  PetscCall(PetscCalloc1(num_sides + 1, &first));
  for (PetscInt k = 0; k < num_pairs; ++k) ++first[pair[k][0] + 1];
  for (PetscInt i = 0; i < num_sides; ++i) first[i + 1] += first[i];
  for (PetscInt i = 0; i < num_sides; ++i) colour[i] = -1;
  for (PetscInt i = 0; i < num; ++i) colour[Root_Private(parent, rim[i].side)] = 0;
  *num_colours = 1;
  for (PetscInt face = 0; face < num_sides; ++face) {
    if (first[face] == first[face + 1]) continue;
    uint64_t taken = Taken_Private(first, pair, face, face, colour);
    PetscInt own   = 0;
    for (PetscInt k = first[face]; k < first[face + 1]; ++k) {
      const PetscInt between = pair[k][1];
      if (first[between + 1] - first[between] <= AROUND) taken |= Taken_Private(first, pair, between, face, colour);
    }
    while (own < MOST - 1 && taken >> own & 1) ++own;
    colour[face] = (int8_t)own;
    *num_colours = PetscMax(*num_colours, own + 1);
  }
  for (PetscInt i = 0; i < num; ++i) colour[rim[i].side] = colour[Root_Private(parent, rim[i].side)];
  PetscCall(PetscFree(first));
  PetscCall(PetscFree(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneColourFaces(Forest forest, PetscInt group, PetscInt *num_colours, int8_t **colour)
{
  const ForestTables *t    = ForestGetTables(forest);
  const CoarseMesh   *mesh = ForestGetCoarse(forest);
  PetscInt            num, num_sides, *parent;
  Rim                *rim;

  PetscFunctionBegin;
  num_sides = 2 * t->dim * mesh->num_cells;
  PetscCall(SceneRims(forest, group, &num, &rim));
  PetscCall(PetscMalloc1(num_sides, colour));
  PetscCall(PetscMalloc1(num_sides, &parent));
  for (PetscInt i = 0; i < num_sides; ++i) parent[i] = i;
  for (PetscInt k = 0, end; k < num; k = end) {
    end = End_Private(num, rim, k);
    for (PetscInt i = k; i < end; ++i)
      for (PetscInt j = k; j < i; ++j)
        if ((t->dim == 2 || rim[k].entity >= t->first[1]) && IsJoined_Private(&rim[i], &rim[j]))
          parent[PetscMax(Root_Private(parent, rim[i].side), Root_Private(parent, rim[j].side))] =
              PetscMin(Root_Private(parent, rim[i].side), Root_Private(parent, rim[j].side));
  }
  PetscCall(Colours_Private(num, rim, parent, num_sides, *colour, num_colours));
  PetscCall(PetscFree(parent));
  PetscCall(PetscFree(rim));
  PetscFunctionReturn(PETSC_SUCCESS);
}
