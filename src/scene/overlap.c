/* Bodies that overlap in the mesh by more than contact looks for: it would press nothing there, and no figure would tell. An overlap is told from the far side
   of a body behind as the search tells it (src/contact/behind.c): of depth d, along a ray into the own body of thickness t, the other one being t' thick, d <=
   (t + t')/2. */
#include "sceneimpl.h"

#define SAMPLES 64 /* facets of a side that are looked at: deep overlaps are wide */
#define ROUND 1e-9 /* of the ray's own facet: a hit nearer than that is the start */

typedef struct {
  PetscReal X[4][3], middle[3], N[3], size; /* corners in turn; unit outward normal; length, root of the area */
  PetscInt  part;
  uint64_t  groups;
} Face;

typedef struct {
  PetscInt dim, num;
  Face    *face; /* owned */
} Faces;

static PetscErrorCode Face_Private(Forest forest, const ForestTables *t, PetscInt facet, PetscInt leaf, Face *f)
{
  static const PetscInt corner[4] = {0, 2, 8, 6};
  const PetscInt        num       = t->dim == 2 ? 2 : 4;
  const PetscReal       mid[3]    = {0.5, 0.5, 0.5};
  PetscReal             a[3], b[3] = {0, 0, 1}, centre[3], length, out = 0;

  PetscFunctionBegin;
  *f = (Face){.groups = t->boundary[facet]};
  for (PetscInt k = 0; k < num; ++k) {
    PetscCall(SceneVertex(forest, t->closure[t->closure_offset[facet] + corner[k]], f->X[k]));
    for (PetscInt c = 0; c < 3; ++c) f->middle[c] += f->X[k][c] / (PetscReal)num;
  }
  for (PetscInt c = 0; c < 3; ++c) {
    a[c] = f->X[num - 1][c] - f->X[0][c];
    if (num == 2) continue;
    a[c] = f->X[2][c] - f->X[0][c];
    b[c] = 0.5 * (f->X[3][c] - f->X[1][c]);
  }
  Cross3(a, b, f->N);
  length  = PetscSqrtReal(Dot3(f->N, f->N));
  f->size = num == 2 ? length : PetscSqrtReal(length);
  PetscCall(ForestMapPoint(forest, leaf, mid, centre));
  for (PetscInt c = 0; c < 3; ++c) out += f->N[c] * (f->middle[c] - centre[c]);
  for (PetscInt c = 0; c < 3; ++c) f->N[c] *= length > 0 ? (out < 0 ? -1 : 1) / length : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FacesCreate_Private(Forest forest, Faces *s)
{
  const ForestTables *t;
  const CoarseMesh   *m;
  PetscInt            num_parts, *part;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(forest, &t));
  PetscCall(ForestGetCoarse(forest, &m));
  PetscCall(PetscMalloc1(m->num_cells, &part));
  PetscCall(ForestCoarseParts(m, &num_parts, part));
  s->dim = t->dim;
  s->num = 0;
  PetscCall(PetscMalloc1(t->first[t->dim] - t->first[t->dim - 1], &s->face));
  for (PetscInt e = t->first[t->dim - 1]; e < t->first[t->dim]; ++e) { /* nothing hangs yet: only uniform refinement so far */
    const PetscInt *leaf = t->facet_leaf + 2 * (e - t->first[t->dim - 1]);
    if ((leaf[0] < 0) == (leaf[1] < 0)) continue;
    const PetscInt of = PetscMax(leaf[0], leaf[1]);
    PetscCall(Face_Private(forest, t, e, of, &s->face[s->num]));
    s->face[s->num++].part = part[t->leaf_root[of]];
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distance from x along the unit vector n to the triangle or segment abc (plane: ab); PETSC_MAX_REAL: it is not met. */
static PetscReal Meet_Private(PetscInt dim, const PetscReal a[3], const PetscReal b[3], const PetscReal c[3], const PetscReal x[3], const PetscReal n[3])
{
  PetscReal A[9] = {0, 0, 0, 0, 0, 0, 0, 0, 1}, r[3], y[3];

  for (PetscInt i = 0; i < 3; ++i) {
    A[3 * i]     = n[i];
    A[3 * i + 1] = a[i] - b[i];
    if (dim == 3) A[3 * i + 2] = a[i] - c[i];
    r[i] = a[i] - x[i];
  }
  if (!Solve3(A, r, y) || y[1] < 0 || y[2] < 0 || y[1] + y[2] > 1) return PETSC_MAX_REAL;
  return y[0];
}

/* The nearest face, of a group (part < 0) or a part, that the ray from x along n leaves its body through. */
static PetscReal Leave_Private(const Faces *s, const PetscReal x[3], const PetscReal n[3], PetscReal least, PetscInt group, PetscInt part, PetscInt *at)
{
  PetscReal nearest = PETSC_MAX_REAL;

  for (PetscInt i = 0; i < s->num; ++i) {
    const Face *f = &s->face[i];
    if ((part < 0 ? !(f->groups >> group & 1) : f->part != part) || Dot3(f->N, n) <= 0) continue;
    for (PetscInt half = 0; half < (s->dim == 2 ? 1 : 2); ++half) {
      const PetscReal d = Meet_Private(s->dim, f->X[0], f->X[1 + half], f->X[2 + half < 4 ? 2 + half : 3], x, n);
      if (d > least && d < nearest) nearest = d, *at = i;
    }
  }
  return nearest;
}

/* How far contact looks into the bodies, as in src/problem/couple.c. */
static PetscReal Distance_Private(const Faces *s, const ContactSpec *c)
{
  const PetscInt group[2] = {c->nonmortar, c->mortar};
  PetscReal      least = PETSC_MAX_REAL, longest = 0;

  for (PetscInt side = 0; side < 2; ++side) {
    PetscReal lo[3] = {PETSC_MAX_REAL, PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[3] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL}, square = 0;
    for (PetscInt i = 0; i < s->num; ++i) {
      if (!(s->face[i].groups >> group[side] & 1)) continue;
      longest = PetscMax(longest, s->face[i].size);
      for (PetscInt k = 0; k < 3 * (s->dim == 2 ? 2 : 4); ++k) {
        lo[k % 3] = PetscMin(lo[k % 3], s->face[i].X[k / 3][k % 3]);
        hi[k % 3] = PetscMax(hi[k % 3], s->face[i].X[k / 3][k % 3]);
      }
    }
    for (PetscInt a = 0; a < 3; ++a) square += PetscSqr(hi[a] - lo[a]);
    least = PetscMin(least, PetscSqrtReal(square));
  }
  return c->search > 0 ? c->search * longest : 0.5 * least;
}

/* Facets of one side against the other. */
static PetscErrorCode CheckSide_Private(const ContactEntry *entry, const Faces *s, PetscInt side, PetscInt against)
{
  const ContactSpec *c        = &entry->spec;
  const PetscReal    distance = Distance_Private(s, c);
  PetscInt           num = 0, at = 0, other = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num; ++i) num += (PetscInt)(s->face[i].groups >> side & 1);
  const PetscInt every = num / SAMPLES + 1;
  for (PetscInt i = 0, count = 0; i < s->num; ++i) {
    const Face *f = &s->face[i];
    if (!(f->groups >> side & 1) || count++ % every) continue;
    const PetscReal least = ROUND * f->size, *N = f->N, into[3] = {-N[0], -N[1], -N[2]};
    const PetscReal d = Leave_Private(s, f->middle, into, least, against, -1, &at);
    if (d <= distance || d == PETSC_MAX_REAL) continue;
    const PetscReal y[3] = {f->middle[0] + d * into[0], f->middle[1] + d * into[1], f->middle[2] + d * into[2]};
    const PetscReal own = Leave_Private(s, f->middle, into, least, 0, f->part, &other), theirs = Leave_Private(s, y, N, least, 0, s->face[at].part, &other);
    if (own == PETSC_MAX_REAL || theirs == PETSC_MAX_REAL) continue;
    PetscCheckInput(
        d > 0.5 * (own + theirs),
        "%s: in the mesh the sides overlap by %.4g at (%.4g, %.4g, %.4g), deeper than contact looks for, which is %.4g; move the bodies apart, or set "
        "%s.search, which counts in lengths of the longest facet",
        NodeWhere(entry->node), (double)d, (double)f->middle[0], (double)f->middle[1], (double)f->middle[2], (double)distance, c->name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckOverlap(Scene s, Forest forest)
{
  Faces          faces;
  PetscErrorCode status = PETSC_SUCCESS;

  PetscFunctionBegin;
  if (s->data.num_contacts == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FacesCreate_Private(forest, &faces));
  for (PetscInt i = 0; i < s->data.num_contacts && !status; ++i) {
    const ContactSpec *c = &s->data.contacts[i];
    status               = CheckSide_Private(&s->contact[i], &faces, c->nonmortar, c->mortar);
    if (!status) status = CheckSide_Private(&s->contact[i], &faces, c->mortar, c->nonmortar);
  }
  PetscCall(PetscFree(faces.face));
  PetscCall(status);
  PetscFunctionReturn(PETSC_SUCCESS);
}
