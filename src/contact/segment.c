/* Segments: parts of a nonmortar edge that see one mortar edge each.

   Bounds. A mortar node m lies on the ray of lambda where f(lambda) = n(lambda) x (m - x(lambda)) = 0: f > 0 says that m stands further along the edge. The
   signs at both ends decide: f(0) <= 0: bound is the end 0; f(1) >= 0: the end 1; f(0) > 0 > f(1): the one root of the quadratic between. f at a
   shared node is the same floating-point number for both edges (ContactRaySide is never inlined), so a mortar node belongs to exactly one side of every
   nonmortar node's ray: no gaps, no overlaps. f(0) < 0 < f(1): m lies behind the point where the rays cross, the edge does not see it.
   Roots within CONTACT_SNAP of an end are that end, with derivative zero: else a sliver of zero length would be dropped while the neighbour's bound
   still moves with m, and the fluxes psi g dlambda of both no longer cancel. Only segments of exactly no length are dropped.

   Fold rule. Where several mortar edges face the same part (folded mortar surface, layers), the part is cut at all their bounds and every piece goes to
   the mortar edge with the least |g| at the piece's middle; neighbouring pieces of one edge are joined again. A bound may then be the ray of a node
   that belongs to neither end of the segment's mortar edge ("foreign"): it moves with that node, and its derivative follows it. */
#include "contactimpl.h"

PetscErrorCode ContactGrow(PetscInt num, size_t entry, PetscInt *size, void *array)
{
  PetscFunctionBegin;
  if (num <= *size) PetscFunctionReturn(PETSC_SUCCESS);
  *size = num + num / 2 + 16;
  PetscCall(PetscRealloc((size_t)*size * entry, array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* n x (m - x): on which side of the ray from x along n the point m stands. One compiled body, so that equal input gives equal bits everywhere. */
__attribute__((noinline)) PetscReal ContactRaySide(const PetscReal x[2], const PetscReal n[2], const PetscReal m[2])
{
  const PetscReal d[2] = {m[0] - x[0], m[1] - x[1]};

  return Cross2(n, d);
}

/* lambda of the mortar node's ray; *fixed: the bound is an end of the edge. False: the edge does not see m. */
static PetscBool Bound_Private(const EdgeFrame *f, const PetscReal m[2], PetscReal *lambda, PetscBool *fixed)
{
  const PetscReal f0 = ContactRaySide(f->x[0], f->n[0], m), f1 = ContactRaySide(f->x[1], f->n[1], m);
  PetscReal       root, num, den, mid;

  *fixed = PETSC_TRUE;
  if (f0 <= 0 || f1 >= 0) {
    *lambda = f0 <= 0 ? 0 : 1;
    return f0 < 0 && f1 > 0 ? PETSC_FALSE : PETSC_TRUE;
  }
  /* Bernstein form f0 (1-l)^2 + 2 mid l (1-l) + f1 l^2; its positive root l/(1-l) = num/den, written without cancellation */
  mid  = 0.5 * (ContactRaySide(f->x[1], f->n[0], m) + ContactRaySide(f->x[0], f->n[1], m));
  root = PetscSqrtReal(mid * mid - f0 * f1);
  num  = mid >= 0 ? mid + root : f0;
  den  = mid >= 0 ? -f1 : root - mid;
  if (num <= CONTACT_SNAP * (num + den))
    *lambda = 0;
  else if (den <= CONTACT_SNAP * (num + den))
    *lambda = 1;
  else {
    *lambda = num / (num + den);
    *fixed  = PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Gap from lambda to the line through c and d; *cosine = unit normals' product there (< 0: facing), *tau: place on the mortar edge, 0 at c, 1 at d. */
PetscReal ContactGapAt(const EdgeFrame *f, const PetscReal c[2], const PetscReal d[2], PetscReal lambda, PetscReal *cosine, PetscReal *tau)
{
  const PetscReal e[2] = {d[0] - c[0], d[1] - c[1]}, n[2] = {f->n[0][0] + lambda * f->dn[0], f->n[0][1] + lambda * f->dn[1]};
  const PetscReal v[2] = {c[0] - f->x[0][0] - lambda * f->dx[0], c[1] - f->x[0][1] - lambda * f->dx[1]};
  const PetscReal B = Cross2(n, e), R = PetscSqrtReal(Dot2(n, n));

  *cosine = B / (R * PetscSqrtReal(Dot2(e, e)));
  *tau    = Cross2(v, n) / B;
  return Cross2(v, e) * R / B;
}

/* The part of the nonmortar edge that faces mortar_facet; false when there is none. The mortar edge c -> d runs against the nonmortar edge. */
PetscBool ContactSegmentBuild(const EdgeFrame *f, const ContactSurface *mortar, PetscInt mortar_facet, Segment *s)
{
  const PetscInt  *node = &mortar->facets[2 * mortar_facet];
  const PetscReal *c = &mortar->x[2 * node[0]], *d = &mortar->x[2 * node[1]];
  PetscBool        fixed;
  PetscReal        cosine, tau;

  s->mortar_facet = mortar_facet;
  for (int b = 0; b < 2; b++) {
    if (!Bound_Private(f, b ? c : d, &s->lambda[b], &fixed)) return PETSC_FALSE;
    s->bound[b] = fixed ? -1 : node[1 - b];
  }
  if (!(s->lambda[0] < s->lambda[1])) return PETSC_FALSE;
  for (int b = 0; b < 2; b++) {
    (void)ContactGapAt(f, c, d, s->lambda[b], &cosine, &tau);
    if (!(cosine < -CONTACT_GRAZE)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Place of a mortar node in the list of the edge that is being built; added when new. Neighbouring segments share nodes: look from the end. */
static PetscErrorCode LocalNode_Private(ContactPair pair, PetscInt first, PetscInt node, PetscInt *place)
{
  PetscFunctionBegin;
  *place = -1;
  if (node < 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = pair->num_local; i-- > first;)
    if (pair->node[i] == node) {
      *place = i - first;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  PetscCall(ContactGrow(pair->num_local + 1, sizeof(PetscInt), &pair->size_local, &pair->node));
  *place                        = pair->num_local - first;
  pair->node[pair->num_local++] = node;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Append a segment of `edge` (the listed edge whose list of mortar nodes is open: first_node of its slot is set) to the results. */
PetscErrorCode ContactSegmentsPush(ContactPair pair, PetscInt slot, const EdgeFrame *f, const ContactSurface *mortar, const Segment *s)
{
  const PetscInt *node = &mortar->facets[2 * s->mortar_facet], first = pair->first_node[slot];
  PetscInt        size = pair->size_segments;
  Segment        *to;
  ContactSegment *out;
  PetscReal       cosine, tau;

  PetscFunctionBegin;
  PetscCall(ContactGrow(pair->num_segments + 1, sizeof(Segment), &size, &pair->segment));
  PetscCall(ContactGrow(pair->num_segments + 1, sizeof(ContactSegment), &pair->size_segments, &pair->output));
  to  = &pair->segment[pair->num_segments];
  out = &pair->output[pair->num_segments++];
  *to = *s;
  for (int k = 0; k < 2; k++) PetscCall(LocalNode_Private(pair, first, node[k], &to->local[k]));
  for (int k = 0; k < 2; k++) PetscCall(LocalNode_Private(pair, first, s->bound[k], &to->local[2 + k]));
  out->facet        = pair->listed[slot];
  out->mortar_facet = s->mortar_facet;
  out->num          = 2;
  for (int k = 0; k < 2; k++) {
    (void)ContactGapAt(f, &mortar->x[2 * node[0]], &mortar->x[2 * node[1]], s->lambda[k], &cosine, &tau);
    out->xi[k][0]  = 2 * s->lambda[k] - 1;
    out->eta[k][0] = 2 * tau - 1;
    out->xi[k][1] = out->eta[k][1] = 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Order by first bound, then second, then mortar edge: independent of the order of candidates. */
static int CompareSegments_Private(const void *a, const void *b)
{
  const Segment *s = (const Segment *)a, *t = (const Segment *)b;

  for (int k = 0; k < 2; k++)
    if (s->lambda[k] != t->lambda[k]) return s->lambda[k] < t->lambda[k] ? -1 : 1;
  return (s->mortar_facet > t->mortar_facet) - (s->mortar_facet < t->mortar_facet);
}

static PetscBool Overlap_Private(PetscInt num, const Segment s[])
{
  for (PetscInt i = 1; i < num; i++)
    if (s[i].lambda[0] < s[i - 1].lambda[1]) return PETSC_TRUE;
  return PETSC_FALSE;
}

typedef struct {
  PetscReal lambda;
  PetscInt  bound;
} Cut;

static int CompareCuts_Private(const void *a, const void *b)
{
  const Cut *s = (const Cut *)a, *t = (const Cut *)b;

  if (s->lambda != t->lambda) return s->lambda < t->lambda ? -1 : 1;
  return (s->bound > t->bound) - (s->bound < t->bound);
}

/* Among num segments the one over the piece (l0, l1) with the least |g| at its middle; -1: none. */
static PetscInt Nearest_Private(const EdgeFrame *f, const ContactSurface *mortar, PetscInt num, const Segment s[], PetscReal l0, PetscReal l1)
{
  PetscInt  best  = -1;
  PetscReal least = PETSC_MAX_REAL, cosine, tau;

  for (PetscInt i = 0; i < num; i++) {
    const PetscInt *node = &mortar->facets[2 * s[i].mortar_facet];
    PetscReal       g;

    if (s[i].lambda[0] > l0 || s[i].lambda[1] < l1) continue;
    g = PetscAbsReal(ContactGapAt(f, &mortar->x[2 * node[0]], &mortar->x[2 * node[1]], 0.5 * (l0 + l1), &cosine, &tau));
    if (g < least) best = i, least = g;
  }
  return best;
}

/* The fold rule for one edge. cut: room for 2 num entries. */
static PetscErrorCode Unfold_Private(ContactPair pair, PetscInt slot, const EdgeFrame *f, const ContactSurface *mortar, PetscInt num, const Segment s[],
                                     Cut *cut)
{
  PetscInt open = -1;
  Segment  part = {0};

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 2 * num; i++) {
    cut[i].lambda = s[i / 2].lambda[i % 2];
    cut[i].bound  = s[i / 2].bound[i % 2];
  }
  qsort(cut, (size_t)(2 * num), sizeof(Cut), CompareCuts_Private);
  for (PetscInt i = 0; i + 1 < 2 * num; i++) {
    PetscInt best;

    if (cut[i].lambda == cut[i + 1].lambda) continue;
    best = Nearest_Private(f, mortar, num, s, cut[i].lambda, cut[i + 1].lambda);
    if (best != open) {
      if (open >= 0) PetscCall(ContactSegmentsPush(pair, slot, f, mortar, &part));
      open = best;
      if (best < 0) continue;
      part           = s[best];
      part.lambda[0] = cut[i].lambda;
      if (s[best].lambda[0] != cut[i].lambda) part.bound[0] = cut[i].bound;
    }
    if (best < 0) continue;
    part.lambda[1] = cut[i + 1].lambda;
    part.bound[1]  = s[best].lambda[1] == cut[i + 1].lambda ? s[best].bound[1] : cut[i + 1].bound;
  }
  if (open >= 0) PetscCall(ContactSegmentsPush(pair, slot, f, mortar, &part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Segments of all listed edges, in order of edges and along each edge. Needs current normals. */
PetscErrorCode ContactSegmentsBuild(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar)
{
  PetscInt  most = 0;
  Segment  *raw;
  Cut      *cut;
  EdgeFrame f;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < pair->num_listed; i++) most = PetscMax(most, pair->start[i + 1] - pair->start[i]);
  PetscCall(PetscMalloc2(most, &raw, 2 * most, &cut));
  pair->num_segments = pair->num_local = 0;
  for (PetscInt i = 0; i < pair->num_listed; i++) {
    PetscInt num = 0;

    pair->first_segment[i] = pair->num_segments;
    pair->first_node[i]    = pair->num_local;
    ContactFrame(pair, nonmortar, pair->listed[i], &f);
    for (PetscInt k = pair->start[i]; k < pair->start[i + 1]; k++)
      if (ContactSegmentBuild(&f, mortar, pair->candidate[k], &raw[num])) num++;
    if (num > 1) qsort(raw, (size_t)num, sizeof(Segment), CompareSegments_Private);
    if (Overlap_Private(num, raw))
      PetscCall(Unfold_Private(pair, i, &f, mortar, num, raw, cut));
    else
      for (PetscInt k = 0; k < num; k++) PetscCall(ContactSegmentsPush(pair, i, &f, mortar, &raw[k]));
  }
  pair->first_segment[pair->num_listed] = pair->num_segments;
  pair->first_node[pair->num_listed]    = pair->num_local;
  PetscCall(PetscFree2(raw, cut));
  PetscFunctionReturn(PETSC_SUCCESS);
}
