/* How thick bodies are: a ray through one of them, from its outer facets at the reference positions. These are taken for larger than they are by
   CONTACT_ROUND: rays through corners leave the body, too, at once where they start at one. */
#include "contactimpl.h"

struct _p_ContactHull {
  PetscInt   dim, *part;
  PetscReal *X;
  Tree       tree;
};

static PetscInt Corners_Private(PetscInt dim)
{
  return dim == 2 ? 2 : 4;
}

static void Box_Private(PetscInt dim, const PetscReal X[], PetscReal box[6])
{
  PetscReal size = 0;

  box[2] = box[5] = 0;
  for (PetscInt i = 0; i < dim; i++) {
    box[i]     = PETSC_MAX_REAL;
    box[3 + i] = -PETSC_MAX_REAL;
    for (PetscInt a = 0; a < Corners_Private(dim); a++) {
      box[i]     = PetscMin(box[i], X[dim * a + i]);
      box[3 + i] = PetscMax(box[3 + i], X[dim * a + i]);
    }
    size += box[3 + i] - box[i];
  }
  for (int i = 0; i < 3; i++) box[i] -= 2 * CONTACT_ROUND * size, box[3 + i] += 2 * CONTACT_ROUND * size;
}

PetscErrorCode ContactHullCreate(PetscInt dim, PetscInt num, PetscInt part[], PetscReal X[], ContactHull *hull)
{
  PetscReal(*box)[6];

  PetscFunctionBegin;
  PetscCall(PetscNew(hull));
  (*hull)->dim  = dim;
  (*hull)->part = part;
  (*hull)->X    = X;
  PetscCall(PetscMalloc1(num, &box));
  for (PetscInt f = 0; f < num; f++) Box_Private(dim, X + dim * Corners_Private(dim) * f, box[f]);
  PetscCall(ContactTreeBuild(num, box, &(*hull)->tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactHullDestroy(ContactHull *hull)
{
  PetscFunctionBegin;
  if (!*hull) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactTreeDestroy(&(*hull)->tree));
  PetscCall(PetscFree((*hull)->part));
  PetscCall(PetscFree((*hull)->X));
  PetscCall(PetscFree(*hull));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where x + s d leaves through edge (a, b), the body to its left; else most. */
static PetscReal Edge_Private(const PetscReal a[2], const PetscReal b[2], const PetscReal x[2], const PetscReal d[2], PetscReal most)
{
  const PetscReal e[2] = {b[0] - a[0], b[1] - a[1]}, r[2] = {a[0] - x[0], a[1] - x[1]}, out = Cross2(d, e);
  PetscReal       s, at;

  if (!(out > 0)) return most; /* d . N = d x e with N = (e_y, -e_x) */
  s  = Cross2(r, e) / out;
  at = Cross2(r, d) / out;
  return Cross2(r, e) >= -CONTACT_ROUND * Dot2(e, e) && s < most && at >= -CONTACT_ROUND && at <= 1 + CONTACT_ROUND ? PetscMax(0, s) : most;
}

/* The same through a triangle, counterclockwise seen from outside. */
static PetscReal Triangle_Private(const PetscReal a[3], const PetscReal b[3], const PetscReal c[3], const PetscReal x[3], const PetscReal d[3], PetscReal most)
{
  PetscReal e[3], f[3], r[3], N[3], q[3], out, s, u, v, length;

  for (int i = 0; i < 3; i++) e[i] = b[i] - a[i], f[i] = c[i] - a[i], r[i] = a[i] - x[i];
  Cross3(e, f, N);
  length = PetscSqrtReal(PetscSqrtReal(Dot3(N, N)));
  out    = Dot3(d, N);
  if (!(out > 0)) return most;
  Cross3(r, d, q);
  s = Dot3(r, N) / out;
  u = Dot3(q, f) / out;
  v = -Dot3(q, e) / out;
  return Dot3(r, N) >= -CONTACT_ROUND * length * length * length && s < most && u >= -CONTACT_ROUND && v >= -CONTACT_ROUND && u + v <= 1 + CONTACT_ROUND
             ? PetscMax(0, s)
             : most;
}

static PetscReal Facet_Private(const ContactHull h, PetscInt facet, const PetscReal x[3], const PetscReal d[3], PetscReal most)
{
  const PetscReal *X = h->X + h->dim * Corners_Private(h->dim) * facet;

  if (h->dim == 2) return Edge_Private(X, X + 2, x, d, most);
  return Triangle_Private(X, X + 6, X + 9, x, d, Triangle_Private(X, X + 3, X + 6, x, d, most));
}

/* Does x + s d, 0 <= s <= most, meet the box? over: 1 / d, infinite across a direction that d has no part in. */
static PetscBool Meets_Private(const PetscReal box[6], const PetscReal x[3], const PetscReal over[3], PetscReal most)
{
  PetscReal from = 0, to = most;

  for (int i = 0; i < 3; i++) {
    if (PetscIsInfReal(over[i])) {
      if (x[i] < box[i] || x[i] > box[3 + i]) return PETSC_FALSE;
      continue;
    }
    const PetscReal s = (box[i] - x[i]) * over[i], t = (box[3 + i] - x[i]) * over[i];
    from = PetscMax(from, PetscMin(s, t));
    to   = PetscMin(to, PetscMax(s, t));
  }
  return from <= to ? PETSC_TRUE : PETSC_FALSE;
}

PetscReal ContactHullAcross(ContactHull h, PetscInt part, const PetscReal x[], const PetscReal d[], PetscReal most)
{
  const Tree     *t    = &h->tree;
  const PetscReal y[3] = {x[0], x[1], h->dim == 3 ? x[2] : 0}, e[3] = {d[0], d[1], h->dim == 3 ? d[2] : 0}, over[3] = {1 / e[0], 1 / e[1], 1 / e[2]};
  PetscInt        stack[TREE_DEPTH], top = 0;

  stack[top++] = 0;
  while (top) {
    const TreeNode *node = &t->node[stack[--top]];

    if (!Meets_Private(node->box, y, over, most)) continue;
    if (node->child >= 0) {
      stack[top++] = node->child;
      stack[top++] = node->child + 1;
      continue;
    }
    for (PetscInt k = node->first; k < node->first + node->count; k++)
      if (h->part[t->item[k]] == part && Meets_Private(t->box[t->item[k]], y, over, most)) most = Facet_Private(h, t->item[k], y, e, most);
  }
  return most;
}

/* ---- distance ------------------------------------------------------------------------------------------------------------------------ */

static PetscReal Clamp_Private(PetscReal s)
{
  return PetscMax(0, PetscMin(1, s));
}

/* Square of the distance from x to the segment a b. */
static PetscReal ToSegment_Private(const PetscReal a[3], const PetscReal b[3], const PetscReal x[3])
{
  PetscReal e[3], r[3], s;

  for (int i = 0; i < 3; i++) e[i] = b[i] - a[i], r[i] = x[i] - a[i];
  s = Dot3(e, e) > 0 ? Clamp_Private(Dot3(r, e) / Dot3(e, e)) : 0;
  for (int i = 0; i < 3; i++) r[i] -= s * e[i];
  return Dot3(r, r);
}

/* The same to a triangle: along its normal where that meets it, else to its sides. */
static PetscReal ToTriangle_Private(const PetscReal a[3], const PetscReal b[3], const PetscReal c[3], const PetscReal x[3])
{
  PetscReal e[3], f[3], r[3], N[3], q[3], u, v;

  for (int i = 0; i < 3; i++) e[i] = b[i] - a[i], f[i] = c[i] - a[i], r[i] = x[i] - a[i];
  Cross3(e, f, N);
  Cross3(r, f, q);
  u = Dot3(q, N) / Dot3(N, N);
  Cross3(e, r, q);
  v = Dot3(q, N) / Dot3(N, N);
  if (u >= 0 && v >= 0 && u + v <= 1) return PetscSqr(Dot3(r, N)) / Dot3(N, N);
  return PetscMin(ToSegment_Private(a, b, x), PetscMin(ToSegment_Private(b, c, x), ToSegment_Private(c, a, x)));
}

static PetscReal ToFacet_Private(const ContactHull h, PetscInt facet, const PetscReal x[3])
{
  const PetscReal *X = h->X + h->dim * Corners_Private(h->dim) * facet;

  if (h->dim == 2) {
    const PetscReal a[3] = {X[0], X[1], 0}, b[3] = {X[2], X[3], 0};
    return ToSegment_Private(a, b, x);
  }
  return PetscMin(ToTriangle_Private(X, X + 3, X + 6, x), ToTriangle_Private(X, X + 6, X + 9, x));
}

/* Unit normal of a facet, outward. */
static void Normal_Private(const ContactHull h, PetscInt facet, PetscReal N[3])
{
  static const PetscInt node[4] = {0, 1, 2, 3};

  (void)ContactFacetNormal(h->dim, h->X + h->dim * Corners_Private(h->dim) * facet, node, N);
}

PetscInt ContactHullBeside(ContactHull h, PetscInt part, const PetscReal x[], const PetscReal d[], PetscReal radius, PetscInt most, HullSide side[])
{
  const Tree     *t      = &h->tree;
  const PetscReal y[3]   = {x[0], x[1], h->dim == 3 ? x[2] : 0};
  const PetscReal box[6] = {y[0] - radius, y[1] - radius, y[2] - radius, y[0] + radius, y[1] + radius, y[2] + radius};
  PetscInt        stack[TREE_DEPTH], top = 0, num = 0;

  stack[top++] = 0;
  while (top) {
    const TreeNode *node = &t->node[stack[--top]];

    if (!ContactBoxesMeet(node->box, box)) continue;
    if (node->child >= 0) {
      stack[top++] = node->child;
      stack[top++] = node->child + 1;
      continue;
    }
    for (PetscInt k = node->first; k < node->first + node->count && num < most; k++) {
      if (h->part[t->item[k]] != part || !ContactBoxesMeet(t->box[t->item[k]], box)) continue;
      Normal_Private(h, t->item[k], side[num].N);
      if (PetscAbsReal(Dot3(side[num].N, d)) >= STEEP) continue;
      side[num].distance = PetscSqrtReal(ToFacet_Private(h, t->item[k], y));
      if (side[num].distance < radius) num++;
    }
  }
  return num;
}
