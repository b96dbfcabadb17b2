/* What a mesh is that its user may not mean: bodies in pieces, nodes at one place that are not merged, hexahedra out of tetrahedra. All of it can be solved. */
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

static PetscErrorCode Places_Private(Forest forest, const ForestTables *t, Place **places)
{
  static const PetscReal along[3] = {0.540302305868, 0.628539361054, 0.559526129};

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

static PetscErrorCode TellCoincident_Private(Scene s, Forest forest, const CoarseMesh *m)
{
  const ForestTables *t;
  PetscReal           lo[3], hi[3], near;
  Coincident          c = {.num = {0, 0}};
  Place              *place;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(forest, &t));
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
  PetscCall(PetscFree(place));
  if (c.num[0])
    PetscCall(PetscPrintf(s->comm, "note: %" PetscInt_FMT " nodes coincide with others of their own body and are not merged, one of %s at (%.4g, %.4g, %.4g)\n",
                          c.num[0], m->body_name[c.body[0][0]], (double)c.X[0][0], (double)c.X[0][1], (double)c.X[0][2]));
  if (c.num[1])
    PetscCall(PetscPrintf(s->comm,
                          "note: %" PetscInt_FMT
                          " nodes coincide with those of another body, neither merged nor on the sides of a pair, one of %s and %s at (%.4g, "
                          "%.4g, %.4g)\n",
                          c.num[1], m->body_name[c.body[1][0]], m->body_name[c.body[1][1]], (double)c.X[1][0], (double)c.X[1][1], (double)c.X[1][2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneTellMesh(Scene s, Forest forest)
{
  const CoarseMesh *m;

  PetscFunctionBegin;
  PetscCall(ForestGetCoarse(forest, &m));
  if (m->from_simplices || s->subdivided)
    PetscCall(WarningAdd(s->comm, "the mesh is of tetrahedra, each split into 4 hexahedra: %" PetscInt_FMT " cells come of it, of worse shape than others",
                         m->num_cells));
  PetscCall(TellPieces_Private(s, m));
  PetscCall(TellCoincident_Private(s, forest, m));
  PetscFunctionReturn(PETSC_SUCCESS);
}
