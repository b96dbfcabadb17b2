/* Does a corner of one side of a contact pair press into the inside of the other? Where facets carry the multiplier into which a corner is pressed, the mortar
   side ends within one of them, at a place that moves over its nodes, and gaps beside the corner count among those below it: the constraint nearest to the
   corner holds a mean of both, forces jump where the corner passes a node, and Newton's method finds nothing there. The side with the corner has a node at it
   and is covered whole, if its facets are no coarser. In the plane; at the reference positions. */
#include "sceneimpl.h"

#define FACES 0.70710678118654752 /* cosine of 45 degrees: of two faces of a right corner one at most looks at the other side */
#define BESIDE 1e-6               /* of a facet: corners that lie on each other are beside each other */

typedef struct {
  PetscInt  vertex[2];
  PetscReal X[2][3], N[3]; /* outward, unit */
} Edge;

/* Outer facets of the group. */
static PetscErrorCode Edges_Private(Forest forest, const ForestTables *t, PetscInt group, PetscInt *num, Edge **edges)
{
  static const PetscReal half[3] = {0.5, 0.5, 0.5};
  const PetscInt         first   = t->first[1];

  PetscFunctionBegin;
  *num = 0;
  PetscCall(PetscMalloc1(t->first[2] - first, edges));
  for (PetscInt f = first; f < t->first[2]; ++f) {
    const PetscInt *closure = t->closure + t->closure_offset[f], *leaf = t->facet_leaf + 2 * (f - first);
    Edge           *e = *edges + *num;
    PetscReal       middle[3];
    if (!(t->boundary[f] >> group & 1)) continue;
    ++*num;
    for (PetscInt k = 0; k < 2; ++k) {
      e->vertex[k] = closure[2 * k];
      PetscCall(SceneVertex(forest, e->vertex[k], e->X[k]));
    }
    PetscCall(ForestMapPoint(forest, leaf[0] >= 0 ? leaf[0] : leaf[1], half, middle));
    const PetscReal d[2] = {e->X[1][0] - e->X[0][0], e->X[1][1] - e->X[0][1]}, length = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);
    e->N[0] = d[1] / length, e->N[1] = -d[0] / length, e->N[2] = 0;
    const PetscReal inward = (middle[0] - e->X[0][0]) * e->N[0] + (middle[1] - e->X[0][1]) * e->N[1];
    for (PetscInt c = 0; c < 2 && inward > 0; ++c) e->N[c] = -e->N[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The edge that goes on where this one ends; NULL: none. */
static const Edge *Next_Private(PetscInt num, const Edge edge[], const Edge *e, PetscInt end)
{
  for (PetscInt i = 0; i < num; ++i)
    if (&edge[i] != e && (edge[i].vertex[0] == e->vertex[end] || edge[i].vertex[1] == e->vertex[end])) return &edge[i];
  return NULL;
}

/* Do the two meet in a corner, at this end of the first? From outside: as the corner of a block. */
static PetscBool IsCorner_Private(const Edge *a, PetscInt end, const Edge *b)
{
  PetscReal d = 0;

  if (Dot3(a->N, b->N) >= CONTACT_SHARP) return PETSC_FALSE;
  for (PetscInt c = 0; c < 2; ++c) d += (0.5 * (b->X[0][c] + b->X[1][c]) - a->X[end][c]) * a->N[c];
  return (PetscBool)(d < 0);
}

/* Is the corner opposite a place of the edge that is no end of its surface? deepest: how far inside it may lie. */
static PetscBool IsOver_Private(PetscInt num, const Edge edge[], const Edge *e, const PetscReal X[3], PetscReal deepest)
{
  PetscReal d[3], r[3];

  for (PetscInt c = 0; c < 3; ++c) {
    d[c] = e->X[1][c] - e->X[0][c];
    r[c] = X[c] - e->X[0][c];
  }
  const PetscReal at = Dot3(r, d) / Dot3(d, d);
  if (at < -BESIDE || at > 1 + BESIDE || Dot3(r, e->N) < -deepest) return PETSC_FALSE;
  if (at > BESIDE && at < 1 - BESIDE) return PETSC_TRUE;
  const PetscInt end   = at > 0.5;
  const Edge    *other = Next_Private(num, edge, e, end);
  return (PetscBool)(other && Dot3(e->N, other->N) >= CONTACT_SHARP);
}

static PetscReal Length_Private(const Edge *e)
{
  return PetscSqrtReal(PetscSqr(e->X[1][0] - e->X[0][0]) + PetscSqr(e->X[1][1] - e->X[0][1]));
}

/* Of the corner X: does its edge e face one that is no finer and lie over it? Coarser facets would have constraints between which the other side deforms. */
static PetscBool Meets_Private(const Edge *e, const PetscReal X[3], PetscInt num, const Edge other[])
{
  const PetscReal size = Length_Private(e);

  for (PetscInt i = 0; i < num; ++i) {
    if (Dot3(e->N, other[i].N) >= -FACES || size > (1 + BESIDE) * Length_Private(&other[i])) continue;
    if (IsOver_Private(num, other, &other[i], X, size)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscErrorCode SceneCornerMeets(Forest forest, PetscInt side, PetscInt other, PetscBool *yes)
{
  const ForestTables *t;
  PetscInt            num[2];
  Edge               *edge[2];

  PetscFunctionBegin;
  *yes = PETSC_FALSE;
  PetscCall(ForestGetTables(forest, &t));
  if (t->dim != 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Edges_Private(forest, t, side, &num[0], &edge[0]));
  PetscCall(Edges_Private(forest, t, other, &num[1], &edge[1]));
  for (PetscInt i = 0; i < 2 * num[0] && !*yes; ++i) {
    const Edge *a = &edge[0][i / 2], *b = Next_Private(num[0], edge[0], a, i % 2);
    if (!b || !IsCorner_Private(a, i % 2, b)) continue;
    *yes = (PetscBool)(Meets_Private(a, a->X[i % 2], num[1], edge[1]) || Meets_Private(b, a->X[i % 2], num[1], edge[1]));
  }
  PetscCall(PetscFree(edge[0]));
  PetscCall(PetscFree(edge[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
