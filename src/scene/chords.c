/* Sides of contact pairs that are round in truth, most likely, and polygons in the mesh: a mesh of order 1 knows of its arcs the chords alone, and so does the
   error estimate, which measures against the geometry of the mesh. */
#include "sceneimpl.h"

#define SEVERAL 3 /* joints at which a side turns a little: a polygon has fewer of them than an arc */

static const PetscReal LittleLow = 0.99985, LittleHigh = 0.76604; /* cosines of 1 and of 40 degrees, beyond which an edge is one (contact/) */

/* Unit vector along (plane) or across (space) a facet. */
static PetscErrorCode Direction_Private(Forest forest, const ForestTables *t, PetscInt facet, PetscReal n[3])
{
  const PetscInt *closure = t->closure + t->closure_offset[facet];
  PetscReal       X[4][3], a[3], b[3];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < (t->dim == 2 ? 2 : 4); ++k) PetscCall(SceneVertex(forest, closure[2 * (k % 2) + 6 * (k / 2)], X[k])); /* of a table of 3^(dim-1) */
  for (PetscInt c = 0; c < 3; ++c) {
    a[c] = n[c] = X[1][c] - X[0][c];
    b[c]        = t->dim == 3 ? X[2][c] - X[0][c] : 0;
  }
  if (t->dim == 3) Cross3(a, b, n);
  const PetscReal length = PetscSqrtReal(Dot3(n, n));
  for (PetscInt c = 0; c < 3 && length > 0; ++c) n[c] /= length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How many joints between facets of the group turn a little; the largest such turn. */
static PetscErrorCode Turns_Private(Forest forest, const ForestTables *t, PetscInt group, PetscInt last[], PetscInt *num, PetscReal *least)
{
  const PetscInt first = t->first[t->dim - 1], low = t->first[t->dim - 2];

  PetscFunctionBegin;
  *num   = 0;
  *least = 1;
  for (PetscInt i = 0; i < first; ++i) last[i] = -1;
  for (PetscInt f = first; f < t->first[t->dim]; ++f) {
    const PetscInt *closure = t->closure + t->closure_offset[f];
    PetscReal       n[3], other[3];
    if (!(t->boundary[f] >> group & 1)) continue;
    PetscCall(Direction_Private(forest, t, f, n));
    for (PetscInt i = 0; i < (t->dim == 2 ? 3 : 9); ++i) {
      if (closure[i] < low || closure[i] >= first) continue;
      const PetscInt before = last[closure[i]];
      last[closure[i]]      = f;
      if (before < 0) continue;
      PetscCall(Direction_Private(forest, t, before, other));
      const PetscReal cosine = PetscAbsReal(Dot3(n, other));
      if (cosine >= LittleLow || cosine <= LittleHigh) continue;
      ++*num;
      *least = PetscMin(*least, cosine);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneTellChords(Scene s, Forest forest)
{
  const CoarseMesh   *m = ForestGetCoarse(forest);
  const ForestTables *t = ForestGetTables(forest);
  PetscInt           *last, num;
  PetscReal           cosine;

  PetscFunctionBegin;
  if (m->geometry_order > 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(t->first[t->dim - 1], &last));
  for (PetscInt i = 0; i < 2 * s->data.num_contacts; ++i) {
    const ContactSpec *c     = &s->data.contacts[i / 2];
    const PetscInt     group = i % 2 ? c->mortar : c->nonmortar;
    PetscCall(Turns_Private(forest, t, group, last, &num, &cosine));
    if (num < SEVERAL || c->part) continue;
    PetscCall(PetscPrintf(s->comm,
                          "note: the mesh is of order 1, and side %s of pair %s turns by up to %.2g degrees from facet to facet: if it is round in truth, a "
                          "mesh of order 2 or more (mesh.order) follows it, and the error estimate knows of it then\n",
                          m->boundary_name[group], c->name, (double)(PetscAcosReal(cosine) * 180 / PETSC_PI)));
  }
  PetscCall(PetscFree(last));
  PetscFunctionReturn(PETSC_SUCCESS);
}
