/* What a mesh is that its user may not mean: bodies in pieces, nodes at one place that are not merged, nodes on sides of larger cells, hexahedra out of
   tetrahedra. All of it can be solved. */
#include "sceneimpl.h"

#define COINCIDE 1e-6 /* of the diagonal of the model; gmsh merges what is closer than 1e-8 of it */

static PetscErrorCode TellPieces_Private(Scene s, const CoarseMesh *m)
{
  PetscInt num_parts, nodes = 1, *part;
  int8_t  *seen;

  PetscFunctionBegin;
  for (PetscInt d = 0; d < m->dim; ++d) nodes *= m->geometry_order + 1;
  PetscCall(PetscMalloc1(m->num_cells, &part));
  PetscCall(ForestCoarseParts(m, &num_parts, part));
  PetscCall(PetscMalloc1(num_parts, &seen));
  for (PetscInt body = 0; body < m->num_bodies; ++body) {
    PetscInt  num = 0, second = 0;
    PetscReal X[3] = {0, 0, 0};
    PetscCall(PetscMemzero(seen, (size_t)num_parts));
    for (PetscInt c = 0; c < m->num_cells; ++c) {
      if (m->cell_body[c] != body || seen[part[c]]) continue;
      seen[part[c]] = 1;
      if (++num == 2) second = c;
    }
    if (num < 2) continue;
    for (PetscInt i = 0; i < 3 * nodes; ++i) X[i % 3] += m->cell_geometry[3 * nodes * second + i] / nodes;
    PetscCall(WarningAdd(s->comm, "body %s is in %" PetscInt_FMT " pieces that hang together nowhere; one of them is at (%.4g, %.4g, %.4g)", m->body_name[body],
                         num, (double)X[0], (double)X[1], (double)X[2]));
  }
  PetscCall(PetscFree(seen));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- nodes at one place --------------------------------------------------------------------------------------------------------------- */

typedef struct {
  PetscReal key; /* along a direction in which no structured mesh has two vertices alike */
  PetscReal X[3];
  PetscInt  vertex;
} Place;

static int Compare_Private(const void *a, const void *b)
{
  const PetscReal x = ((const Place *)a)->key, y = ((const Place *)b)->key;
  return x < y ? -1 : x > y;
}

static const PetscReal along[3] = {0.540302305868, 0.628539361054, 0.559526129};

static PetscErrorCode Places_Private(Forest forest, const ForestTables *t, Place **places)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->first[1], places));
  for (PetscInt v = 0; v < t->first[1]; ++v) {
    Place *p  = *places + v;
    p->vertex = v;
    PetscCall(SceneVertex(forest, v, p->X));
    p->key = Dot3(along, p->X);
  }
  qsort(*places, (size_t)t->first[1], sizeof(Place), Compare_Private);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The two sides of a pair may begin where they touch. */
static PetscBool Facing_Private(Scene s, uint64_t a, uint64_t b)
{
  for (PetscInt i = 0; i < s->data.num_contacts; ++i) {
    const PetscInt n = s->data.contacts[i].nonmortar, m = s->data.contacts[i].mortar;
    if (((a >> n & 1) && (b >> m & 1)) || ((a >> m & 1) && (b >> n & 1))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Nodes that coincide with others of the body (0), or of another one (1): how many, and of which bodies and where the first is. */
typedef struct {
  PetscInt  num[2], body[2][2];
  PetscReal X[2][3];
} Coincident;

static void Note_Private(Coincident *c, const ForestTables *t, const Place *p, const Place *q)
{
  const PetscInt a = t->leaf_body[t->entity_leaf[p->vertex]], b = t->leaf_body[t->entity_leaf[q->vertex]], k = a != b;

  if (c->num[k]++) return;
  c->body[k][0] = a, c->body[k][1] = b;
  for (PetscInt i = 0; i < 3; ++i) c->X[k][i] = p->X[i];
}

/* ---- nodes on sides of cells ---------------------------------------------------------------------------------------------------------- */

/* The free side of a cell, straight between its corners. */
typedef struct {
  PetscInt  num, corner[4];
  PetscReal X[4][3], lo, hi; /* lo, hi: its range along the direction of the places */
  uint64_t  boundary;        /* groups of it, its edges and corners */
} Side;

/* Is the place on the side, away from its corners? Newton's method for the nearest point of the bilinear surface, of the straight line where there are two. */
static PetscBool IsOn_Private(const Side *f, const PetscReal X[3], PetscReal near)
{
  PetscReal r = 0.5, s = f->num == 4 ? 0.5 : 0, d[3];

  for (PetscInt i = 0; i < f->num; ++i) {
    const PetscReal *C = f->X[i];
    if (PetscMax(PetscMax(PetscAbsReal(C[0] - X[0]), PetscAbsReal(C[1] - X[1])), PetscAbsReal(C[2] - X[2])) <= near) return PETSC_FALSE;
  }
  for (int iteration = 0; iteration < 8; ++iteration) {
    PetscReal a[3], b[3];
    for (PetscInt c = 0; c < 3; ++c) {
      const PetscReal x0 = f->X[0][c], x1 = f->X[1][c], x2 = f->num == 4 ? f->X[2][c] : x0, x3 = f->num == 4 ? f->X[3][c] : x1;
      d[c] = X[c] - ((1 - s) * ((1 - r) * x0 + r * x1) + s * ((1 - r) * x2 + r * x3));
      a[c] = (1 - s) * (x1 - x0) + s * (x3 - x2);
      b[c] = (1 - r) * (x2 - x0) + r * (x3 - x1);
    }
    const PetscReal aa = Dot3(a, a), ab = Dot3(a, b), bb = f->num == 4 ? Dot3(b, b) : 1, det = aa * bb - ab * ab;
    if (!(det > 0)) return PETSC_FALSE;
    const PetscReal dr = (bb * Dot3(a, d) - ab * Dot3(b, d)) / det, ds = f->num == 4 ? (aa * Dot3(b, d) - ab * Dot3(a, d)) / det : 0;
    r = PetscClipInterval(r + dr, -1, 2);
    s = PetscClipInterval(s + ds, -1, 2);
    if (PetscAbsReal(dr) + PetscAbsReal(ds) < 1e-12) break;
  }
  return (PetscBool)(r >= -COINCIDE && r <= 1 + COINCIDE && s >= -COINCIDE && s <= 1 + COINCIDE && Dot3(d, d) <= PetscSqr(near));
}

/* The sides of cells that have no neighbour there; the vertices on them are marked. groups: of those of each body. */
static PetscErrorCode FreeSides_Private(const ForestTables *t, PetscInt *num, PetscInt **facet, int8_t free_vertex[], uint64_t groups[])
{
  const PetscInt first = t->first[t->dim - 1], all = t->first[t->dim] - first, n = t->dim == 2 ? 3 : 9;

  PetscFunctionBegin;
  *num = 0;
  PetscCall(PetscMalloc1(all, facet));
  for (PetscInt e = 0; e < all; ++e) {
    if (t->facet_leaf[2 * e] >= 0 && t->facet_leaf[2 * e + 1] >= 0) continue;
    (*facet)[(*num)++] = first + e;
    groups[t->leaf_body[t->entity_leaf[first + e]]] |= t->boundary[first + e];
    for (PetscInt i = 0; i < n; ++i) {
      const PetscInt v = t->closure[t->closure_offset[first + e] + i];
      if (v < t->first[1]) free_vertex[v] = 1;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Side_Private(Forest forest, const ForestTables *t, PetscInt facet, Side *f)
{
  const PetscInt n = t->dim == 2 ? 3 : 9;

  PetscFunctionBegin;
  *f = (Side){.lo = PETSC_MAX_REAL, .hi = PETSC_MIN_REAL};
  for (PetscInt i = 0; i < n; ++i) {
    const PetscInt v = t->closure[t->closure_offset[facet] + i];
    f->boundary |= t->boundary[v];
    if (v >= t->first[1]) continue;
    PetscCall(SceneVertex(forest, v, f->X[f->num]));
    const PetscReal key = Dot3(along, f->X[f->num]);
    f->lo               = PetscMin(f->lo, key);
    f->hi               = PetscMax(f->hi, key);
    f->corner[f->num++] = v;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Such a mesh hangs: what meets there is not joined. */
static PetscErrorCode TellHanging_Private(Scene s, Forest forest, const CoarseMesh *m, const Place places[], PetscReal near)
{
  const ForestTables *t = ForestGetTables(forest);
  PetscInt            num, *facet, told = 0, bodies[2] = {0, 0};
  PetscReal           X[3] = {0, 0, 0};
  int8_t             *free_vertex;
  uint64_t           *groups;

  PetscFunctionBegin;
  PetscCall(PetscCalloc2(t->first[1], &free_vertex, m->num_bodies, &groups));
  PetscCall(FreeSides_Private(t, &num, &facet, free_vertex, groups));
  for (PetscInt k = 0; k < num; ++k) {
    Side f;
    PetscCall(Side_Private(forest, t, facet[k], &f));
    const Place first = {.key = f.lo - near};
    for (PetscInt i = SortedFrom(&first, places, t->first[1], sizeof(Place), Compare_Private); i < t->first[1] && places[i].key <= f.hi + near; ++i) {
      const Place   *p       = places + i;
      const PetscInt body[2] = {t->leaf_body[t->entity_leaf[p->vertex]], t->leaf_body[t->entity_leaf[facet[k]]]};
      if (!free_vertex[p->vertex] || !IsOn_Private(&f, p->X, near) || Facing_Private(s, t->boundary[p->vertex], f.boundary)) continue;
      if (body[0] != body[1] && Facing_Private(s, groups[body[0]], groups[body[1]])) continue; /* bodies in contact may overlap */
      free_vertex[p->vertex] = 0;                                                              /* once */
      if (told++) continue;
      PetscCall(PetscArraycpy(bodies, body, 2));
      PetscCall(PetscArraycpy(X, p->X, 3));
    }
  }
  PetscCall(PetscFree2(free_vertex, groups));
  PetscCall(PetscFree(facet));
  if (told)
    PetscCall(WarningAdd(s->comm,
                         "%" PetscInt_FMT " nodes lie on sides of cells whose corners they are not, one of body %s on a side of body %s at (%.4g, %.4g, %.4g): "
                         "cells of different sizes meet there, and nothing joins them",
                         told, m->body_name[bodies[0]], m->body_name[bodies[1]], (double)X[0], (double)X[1], (double)X[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TellCoincident_Private(Scene s, Forest forest, const CoarseMesh *m)
{
  const ForestTables *t = ForestGetTables(forest);
  PetscReal           lo[3], hi[3], near;
  Coincident          c = {.num = {0, 0}};
  Place              *place;

  PetscFunctionBegin;
  PetscCall(Places_Private(forest, t, &place));
  ForestCoarseBox(m, lo, hi);
  near = COINCIDE * PetscSqrtReal(PetscSqr(hi[0] - lo[0]) + PetscSqr(hi[1] - lo[1]) + PetscSqr(hi[2] - lo[2]));
  for (PetscInt i = 0; i < t->first[1]; ++i) {
    for (PetscInt j = i + 1; j < t->first[1] && place[j].key - place[i].key <= near; ++j) {
      const Place    *p = place + i, *q = place + j;
      const PetscBool same =
          (PetscBool)(PetscAbsReal(p->X[0] - q->X[0]) <= near && PetscAbsReal(p->X[1] - q->X[1]) <= near && PetscAbsReal(p->X[2] - q->X[2]) <= near);
      if (!same || Facing_Private(s, t->boundary[p->vertex], t->boundary[q->vertex])) continue;
      Note_Private(&c, t, p, q);
      break;
    }
  }
  PetscCall(TellHanging_Private(s, forest, m, place, near));
  PetscCall(PetscFree(place));
  if (c.num[0])
    PetscCall(WarningAdd(s->comm, "%" PetscInt_FMT " nodes coincide with others of their own body and are not merged, one of %s at (%.4g, %.4g, %.4g)",
                         c.num[0], m->body_name[c.body[0][0]], (double)c.X[0][0], (double)c.X[0][1], (double)c.X[0][2]));
  if (c.num[1])
    PetscCall(WarningAdd(s->comm,
                         "%" PetscInt_FMT " nodes coincide with those of another body, neither merged nor on the sides of a pair, one of %s and %s at (%.4g, "
                         "%.4g, %.4g)",
                         c.num[1], m->body_name[c.body[1][0]], m->body_name[c.body[1][1]], (double)c.X[1][0], (double)c.X[1][1], (double)c.X[1][2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define DIGITS 1e-10 /* of the mesh's size, to which its coordinates must be told: the residual's default tolerance */

/* Coordinates far from the origin have few digits left for what happens in the bodies. */
static PetscErrorCode TellFar_Private(Scene s, const CoarseMesh *m)
{
  PetscReal lo[3], hi[3], far = 0, size = 0;

  PetscFunctionBegin;
  ForestCoarseBox(m, lo, hi);
  for (PetscInt c = 0; c < 3; ++c) {
    far = PetscMax(far, PetscMax(PetscAbsReal(lo[c]), PetscAbsReal(hi[c])));
    size += PetscSqr(hi[c] - lo[c]);
  }
  size = PetscSqrtReal(size);
  if (far * PETSC_MACHINE_EPSILON > DIGITS * size)
    PetscCall(WarningAdd(
        s->comm, "the mesh is %.2g times as far from the origin as it is large: its coordinates have few digits left, and Newton's method may stall; move it",
        (double)(far / size)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneTellMesh(Scene s, Forest forest)
{
  const CoarseMesh *m = ForestGetCoarse(forest);

  PetscFunctionBegin;
  if (m->from_simplices || s->subdivided)
    PetscCall(WarningAdd(s->comm, "the mesh is of tetrahedra, each split into 4 hexahedra: %" PetscInt_FMT " cells come of it, of worse shape than others",
                         m->num_cells));
  PetscCall(TellFar_Private(s, m));
  PetscCall(TellPieces_Private(s, m));
  PetscCall(TellCoincident_Private(s, forest, m));
  PetscCall(SceneTellChords(s, forest));
  PetscFunctionReturn(PETSC_SUCCESS);
}
