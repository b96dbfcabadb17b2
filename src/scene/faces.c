/* Faces of a contact side. Where the mortar side has an edge, a facet of the other side that lies across it sees two faces, and one multiplier for both
   would hold a mean of their gaps: of one that is closed under a punch and of one that is open beside it. So what lies across an edge is met by multipliers
   of its own: the pair is made once for each colour. Faces that share an edge or a corner have different ones, and so have two with one face between them: rays
   of a facet that pass the end of a flank run through the play along the next one and meet the flank behind it, and the gap would jump from one to the other.
   So is a pair of one surface made, of which a node on an edge may touch with one of its faces while the other one sees the far side of a hollow.

   A convex edge parts what no facet faces squarely on both sides (CONTACT_OPPOSE): over a blunter one both gaps are those of the facet, and constraints for
   each would be more than it has nodes. In a concave one a corner of the other side is held by both.

   Faces are those of the coarse mesh and its curved sides: refinement changes none. */
#include "sceneimpl.h"

#define MOST 64  /* colours that are told apart */
#define AROUND 8 /* most faces round one that is between two of them; what has more, as the front of a rack, is what they stand on */

typedef struct {
  PetscInt  entity, side; /* vertex (plane) or edge (space) of the leaf facet, and side of the coarse mesh that this lies in: 2 dim cell + place */
  PetscInt  facet;        /* number of the leaf facet */
  PetscReal N[3], T[3];   /* its unit normal there, and a tangent from there into it */
  PetscReal length;       /* of the leaf facet */
} Rim;

static PetscInt Root_Private(PetscInt parent[], PetscInt i)
{
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/* Normal, tangent and length of the side of a leaf at an entity of its closure. */
static void Axes_Private(const CoarseMesh *mesh, const ForestTables *t, PetscInt leaf, PetscInt place, PetscInt entity, Rim *r)
{
  const PetscInt  dim = t->dim, d = place / 2, a = (d + 1) % dim, b = dim == 3 ? (d + 2) % 3 : 2;
  const PetscInt *cl    = t->closure + t->closure_offset[t->first[dim] + leaf];
  PetscInt        index = 0;
  PetscReal       xi[3] = {0, 0, 0}, X[3], J[9], N[3], e[2][3] = {{0, 0, 0}, {0, 0, 1}}, outward = 0;

  while (cl[index] != entity) ++index;
  const PetscInt at[3] = {index % 3, index / 3 % 3, index / 9};
  for (PetscInt i = 0; i < dim; ++i)
    xi[i] = ((PetscReal)t->leaf_lo[3 * leaf + i] + 0.5 * (PetscReal)at[i] * (PetscReal)(1 << (FOREST_MAX_LEVEL - t->leaf_level[3 * leaf + i]))) /
            (PetscReal)(1 << FOREST_MAX_LEVEL);
  ForestCoarseMapPoint(mesh, t->leaf_root[leaf], xi, X, J);
  for (PetscInt c = 0; c < 3; ++c) {
    e[0][c] = J[c * dim + a];
    if (dim == 3) e[1][c] = J[c * dim + b];
  }
  Cross3(e[0], e[1], N);
  for (PetscInt c = 0; c < 3; ++c) outward += N[c] * J[c * dim + d] * (place % 2 ? 1 : -1);
  const PetscReal measure = PetscSqrtReal(Dot3(N, N)) * (outward < 0 ? -1 : 1);
  for (PetscInt c = 0; c < 3; ++c) {
    r->N[c] = N[c] / measure;
    r->T[c] = (PetscReal)(1 - at[a]) * e[0][c] + (dim == 3 ? (PetscReal)(1 - at[b]) * e[1][c] : 0);
  }
  r->length = PetscSqrtReal(Dot3(e[0], e[0])) / (PetscReal)(1 << t->leaf_level[3 * leaf + a]);
  if (dim == 3) r->length = PetscMax(r->length, PetscSqrtReal(Dot3(e[1], e[1])) / (PetscReal)(1 << t->leaf_level[3 * leaf + b]));
}

/* Do the two sides that meet in a vertex (plane) or an edge (space) belong to one face? */
static PetscBool IsJoined_Private(const Rim *a, const Rim *b)
{
  return (PetscBool)(Dot3(a->N, b->N) >= (Dot3(a->N, b->T) < 0 ? CONTACT_OPPOSE : CONTACT_SHARP));
}

static int Compare_Private(const void *a, const void *b)
{
  const Rim *x = a, *y = b;

  if (x->entity != y->entity) return x->entity < y->entity ? -1 : 1;
  return x->side < y->side ? -1 : x->side > y->side;
}

/* What meets at the vertices and, in space, edges of the group's outer facets, by entity. */
static PetscErrorCode Rims_Private(Forest forest, PetscInt group, PetscInt *num, Rim **rim)
{
  const CoarseMesh   *mesh = ForestGetCoarse(forest);
  const ForestTables *t    = ForestGetTables(forest);
  PetscInt            room = 0;

  PetscFunctionBegin;
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim]; ++f) room += t->boundary[f] >> group & 1 ? 2 * 4 : 0;
  PetscCall(PetscMalloc1(room, rim));
  *num = 0;
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim]; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - t->first[t->dim - 1]), *cl = t->closure + t->closure_offset[f];
    if (!(t->boundary[f] >> group & 1) || (leaf[0] >= 0 && leaf[1] >= 0)) continue;
    const PetscInt cell = leaf[0] >= 0 ? leaf[0] : leaf[1], side = ForestCoarseSide(t, cell, f);
    for (PetscInt k = 0; k < (t->dim == 2 ? 3 : 9); ++k) {
      if (cl[k] == f) continue;
      Rim *r    = *rim + (*num)++;
      r->entity = cl[k];
      r->side   = side;
      r->facet  = f;
      Axes_Private(mesh, t, cell, side % (2 * t->dim), cl[k], r);
    }
  }
  qsort(*rim, (size_t)*num, sizeof(Rim), Compare_Private);
  PetscFunctionReturn(PETSC_SUCCESS);
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

/* The rim of the facet that meets this one in its vertex; -1: there is none. In the plane, where two facets at most meet in a vertex of an outline. */
static PetscInt Neighbour_Private(PetscInt num, const Rim rim[], PetscInt k)
{
  if (k + 1 < num && rim[k + 1].entity == rim[k].entity) return k + 1;
  return k > 0 && rim[k - 1].entity == rim[k].entity ? k - 1 : -1;
}

/* Angle between two rims, negative where the outline is concave: at a vertex tangents of convex facets point to the inner side of each other, within a facet
   those of its ends to the outer one. */
static PetscReal Turn_Private(const Rim *a, const Rim *b, PetscBool within)
{
  const PetscReal angle = acos(PetscMax(-1, PetscMin(1, Dot3(a->N, b->N)))), out = Dot3(a->N, b->T);

  return angle <= ROUND_LENGTH ? 0 : (within ? out < 0 : out > 0) ? -angle : angle;
}

/* From the end k of a facet on along the outline: the way within which it turns by the angle of a corner, all in all (arcs of a high order meet in kinks of
   either sign). Infinity: it does not, is straight or concave at first, or there is a shorter one. other[k]: the rim at the other end of the facet. */
static PetscReal Round_Private(PetscInt num, const Rim rim[], const PetscInt other[], PetscInt k, PetscReal most)
{
  const PetscReal sharp = acos(CONTACT_SHARP);
  const PetscInt  from  = Neighbour_Private(num, rim, k);
  PetscReal       way = 0, turned = from < 0 ? 0 : PetscMax(0, Turn_Private(&rim[from], &rim[k], PETSC_FALSE));

  for (PetscInt i = 0; i < num && k >= 0 && way < most; ++i) {
    const PetscInt  end    = other[k];
    const PetscReal within = Turn_Private(&rim[k], &rim[end], PETSC_TRUE), length = 0.5 * (rim[k].length + rim[end].length);
    if (i == 0 && within + turned <= 0) break;
    if (within > 0 && turned + within >= sharp) return way + length * PetscMax(0, sharp - turned) / within;
    turned += within;
    way += length;
    k = Neighbour_Private(num, rim, end);
    if (k < 0) break;
    turned += Turn_Private(&rim[end], &rim[k], PETSC_FALSE);
    if (turned >= sharp) return way;
  }
  return PETSC_INFINITY;
}

PetscErrorCode SceneCorner(Forest forest, PetscInt group, PetscReal *corner, PetscReal *rounded, PetscReal *longest)
{
  PetscInt num, *other, *first;
  Rim     *rim;

  PetscFunctionBegin;
  *corner = *rounded    = PETSC_INFINITY;
  *longest              = 0;
  const ForestTables *t = ForestGetTables(forest);
  if (t->dim != 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Rims_Private(forest, group, &num, &rim));
  PetscCall(PetscMalloc2(num, &other, t->first[2] - t->first[1], &first));
  for (PetscInt f = t->first[1]; f < t->first[2]; ++f) first[f - t->first[1]] = -1;
  for (PetscInt k = 0; k < num; ++k) {
    PetscInt *end = &first[rim[k].facet - t->first[1]];
    if (*end >= 0) other[other[k] = *end] = k;
    *end     = k;
    *longest = PetscMax(*longest, rim[k].length);
  }
  for (PetscInt k = 0; k < num; ++k) {
    const PetscInt next = Neighbour_Private(num, rim, k);
    if (next >= 0 && Turn_Private(&rim[k], &rim[next], PETSC_FALSE) >= acos(CONTACT_SHARP))
      *corner = PetscMin(*corner, PetscMax(rim[k].length, rim[next].length));
    else
      *rounded = PetscMin(*rounded, Round_Private(num, rim, other, k, *rounded));
  }
  PetscCall(PetscFree2(other, first));
  PetscCall(PetscFree(rim));
  PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscCall(Rims_Private(forest, group, &num, &rim));
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
