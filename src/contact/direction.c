/* Directions of the rays at the corners of the nonmortar facets: sums of the vectors of the facets around over their reference measure, with their mirror
   images at planes of symmetry; a corner that hangs on an edge has the mean of its ends, as the interpolation along that edge. Linear in the positions in the
   plane, quadratic in space. */
#include "rayimpl.h"

#define DEPTH 6   /* of corners that hang on edges whose ends hang */
#define SAME 1e-9 /* 1 - cosine between the normals of one plane, square of the sine between it and what lies in it */

typedef struct {
  PetscInt from, to, facet;
} Side;

static int CompareSides_Private(const void *a, const void *b)
{
  const Side *s = (const Side *)a, *t = (const Side *)b;

  if (s->from != t->from) return s->from < t->from ? -1 : 1;
  return (s->to > t->to) - (s->to < t->to);
}

/* First side from a node on. */
static PetscInt FirstSide_Private(PetscInt num, const Side side[], PetscInt from)
{
  PetscInt lo = 0, hi = num;

  while (lo < hi) {
    const PetscInt mid = (lo + hi) / 2;

    if (side[mid].from < from)
      lo = mid + 1;
    else
      hi = mid;
  }
  return lo;
}

static PetscBool HasSide_Private(PetscInt num, const Side side[], PetscInt from, PetscInt to)
{
  for (PetscInt k = FirstSide_Private(num, side, from); k < num && side[k].from == from; k++)
    if (side[k].to == to) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Does a node take its position from the facet: it hangs, or is one of its lattice? */
static PetscBool Follows_Private(const ContactSurface *s, PetscInt node, PetscInt facet)
{
  if (s->hang && s->hang[node] < s->hang[node + 1]) return PETSC_TRUE;
  for (PetscInt k = s->order ? s->first[facet] : 0; s->order && k < s->first[facet + 1]; k++)
    if (s->lattice[k] == node) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A side u -> v without partner, against which v -> h -> u run, carries h. */
PetscErrorCode ContactParents(const ContactSurface *s, PetscInt parent[], PetscInt middle[])
{
  const PetscInt num = 4 * s->num_facets;
  Side          *side;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 2 * s->num_nodes; i++) parent[i] = -1;
  for (PetscInt i = 0; i < num && middle; i++) middle[i] = -1;
  if (s->dim == 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(num, &side));
  for (PetscInt k = 0; k < num; k++) side[k] = (Side){s->facets[k], s->facets[4 * (k / 4) + (k + 1) % 4], k / 4};
  qsort(side, (size_t)num, sizeof(Side), CompareSides_Private);
  for (PetscInt k = 0; k < num; k++) {
    const PetscInt u = side[k].from, v = side[k].to;

    if (HasSide_Private(num, side, v, u)) continue;
    for (PetscInt l = FirstSide_Private(num, side, v); l < num && side[l].from == v; l++) {
      const PetscInt h = side[l].to;

      if (!HasSide_Private(num, side, h, u) || !Follows_Private(s, h, side[k].facet)) continue;
      parent[2 * h] = u, parent[2 * h + 1] = v;
      for (PetscInt i = 4 * side[k].facet; i < 4 * (side[k].facet + 1) && middle; i++)
        if (s->facets[i] == u) middle[i] = h;
    }
  }
  PetscCall(PetscFree(side));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do both ends of a side lie in one plane of symmetry? (Not in two that are parallel.) */
static PetscBool IsKept_Private(const ContactSurface *s, PetscInt a, PetscInt b)
{
  PetscReal e[3];

  for (int c = 0; c < 3; c++) e[c] = s->X[3 * b + c] - s->X[3 * a + c];
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const PetscReal *p = s->mirror + 6 * a + 3 * i, *q = s->mirror + 6 * b + 3 * j;

      if (PetscAbsReal(Dot3(p, q)) > 1 - SAME && PetscSqr(Dot3(p, e)) < SAME * Dot3(e, e)) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

PetscErrorCode ContactDirectionTopology(RayWork w, const ContactSurface *s)
{
  const PetscInt nv = s->dim == 2 ? 2 : 4, num = nv * s->num_facets;

  PetscFunctionBegin;
  PetscCall(PetscFree5(w->ring_first, w->ring_facet, w->parent, w->d, w->kept));
  PetscCall(PetscCalloc5(s->num_nodes + 2, &w->ring_first, num, &w->ring_facet, 2 * s->num_nodes, &w->parent, 3 * s->num_nodes, &w->d, num, &w->kept));
  for (PetscInt i = 0; i < num; i++) {
    PetscCheck(s->facets[i] >= 0 && s->facets[i] < s->num_nodes, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "nonmortar facet %" PetscInt_FMT " has node %" PetscInt_FMT ", must lie in [0, %" PetscInt_FMT ")", i / nv, s->facets[i], s->num_nodes);
    w->ring_first[s->facets[i] + 2]++;
  }
  for (PetscInt i = 2; i < s->num_nodes + 2; i++) w->ring_first[i] += w->ring_first[i - 1];
  for (PetscInt i = 0; i < num; i++) w->ring_facet[w->ring_first[s->facets[i] + 1]++] = i / nv;
  for (PetscInt k = 0; k < num && s->dim == 3 && s->mirror; k++) w->kept[k] = IsKept_Private(s, s->facets[k], s->facets[4 * (k / 4) + (k + 1) % 4]);
  PetscCall(ContactParents(s, w->parent, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mean over the images in the planes of symmetry through a node: 1 - n n^T for one, l l^T / l^2 for two with the common line l. */
static void Images_Private(const ContactSurface *s, PetscInt node, PetscReal R[9])
{
  PetscReal n[2][3] = {{0}}, l[3];
  int       num     = 0;

  for (int k = 0; s->mirror && k < (s->dim == 2 ? 1 : 2); k++) {
    for (PetscInt c = 0; c < s->dim; c++) n[num][c] = s->dim == 2 ? s->mirror[2 * node + c] : s->mirror[6 * node + 3 * k + c];
    if (Dot3(n[num], n[num]) > 0) num++;
  }
  if (num == 2) {
    Cross3(n[0], n[1], l);
    if (!(Dot3(l, l) > 1e-12)) num = 1;
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      R[3 * i + j] = i == j;
      if (num == 1) R[3 * i + j] = (i == j) - n[0][i] * n[0][j];
      if (num == 2) R[3 * i + j] = l[i] * l[j] / Dot3(l, l);
    }
}

/* Reference measure of the facets around a node, by which directions are divided: of length 1 or so everywhere, they change little along graded facets, beyond
   which they are continued to the images of mortar nodes. */
static PetscReal Around_Private(RayWork w, const ContactSurface *s, PetscInt node)
{
  const PetscInt nv  = s->dim == 2 ? 2 : 4;
  PetscReal      sum = 0, N[3];

  for (PetscInt k = w->ring_first[node]; k < w->ring_first[node + 1]; k++) {
    ContactFacetVector(s->dim, s->X, s->facets + nv * w->ring_facet[k], N);
    sum += PetscSqrtReal(Dot3(N, N));
  }
  return sum;
}

static PetscInt Terms_Private(RayWork w, const ContactSurface *s, PetscInt node, PetscReal weight, int depth, PetscInt max, DirectionTerm term[])
{
  PetscReal R[9];
  PetscInt  num = 0;

  if (w->parent[2 * node] >= 0 && depth < DEPTH) {
    num = Terms_Private(w, s, w->parent[2 * node], 0.5 * weight, depth + 1, max, term);
    return num + Terms_Private(w, s, w->parent[2 * node + 1], 0.5 * weight, depth + 1, max - num, term + num);
  }
  Images_Private(s, node, R);
  weight /= Around_Private(w, s, node);
  for (PetscInt k = w->ring_first[node]; k < w->ring_first[node + 1] && num < max; k++, num++) {
    term[num].facet = w->ring_facet[k];
    for (int i = 0; i < 9; i++) term[num].R[i] = weight * R[i];
  }
  return num;
}

PetscInt ContactDirectionTerms(RayWork w, const ContactSurface *s, PetscInt node, PetscInt max, DirectionTerm term[])
{
  return Terms_Private(w, s, node, 1, 0, max, term);
}

#define MOST 64

void ContactDirections(RayWork w, const ContactSurface *s)
{
  const PetscInt nv = s->dim == 2 ? 2 : 4;
  DirectionTerm  term[MOST];

  for (PetscInt n = 0; n < s->num_nodes; n++) {
    const PetscInt num = ContactDirectionTerms(w, s, n, MOST, term);
    PetscReal     *d   = w->d + 3 * n;

    d[0] = d[1] = d[2] = 0;
    for (PetscInt k = 0; k < num; k++) {
      PetscReal N[3];

      ContactFacetVector(s->dim, s->x, s->facets + nv * term[k].facet, N);
      for (int i = 0; i < 3; i++) d[i] += Dot3(term[k].R + 3 * i, N);
    }
  }
}

/* False where the vectors around a corner cancel. */
PetscBool ContactDirectionUsable(RayWork w, const ContactSurface *s, PetscInt node)
{
  const PetscInt nv = s->dim == 2 ? 2 : 4, num = w->ring_first[node + 1] - w->ring_first[node];
  PetscReal      sum = 0;

  for (PetscInt k = 0; k < num; k++) {
    PetscReal N[3];

    ContactFacetVector(s->dim, s->x, s->facets + nv * w->ring_facet[w->ring_first[node] + k], N);
    sum += PetscSqrtReal(Dot3(N, N));
  }
  return PetscSqrtReal(Dot3(w->d + 3 * node, w->d + 3 * node)) * Around_Private(w, s, node) > CONTACT_FOLDED * sum ? PETSC_TRUE : PETSC_FALSE;
}
