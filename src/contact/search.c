/* Candidate search: which mortar edges a nonmortar edge may meet while no node moves more than `margin`.

   A pair is kept when the unit normals oppose, N_s . N_m < -0.1, and the mortar edge reaches into the region swept by the nonmortar edge's rays up to
   `distance` to both sides, |g| < distance (with margin 0 exactly that; with a margin the region grows by
   slack = 2 margin (1 + distance / h): relative motion of the nodes plus the turn 2 margin / h of normals of edges of length h at that distance).
   Distances and normals are judged here and nowhere else: between two searches the result changes continuously with the positions. */
#include "contactimpl.h"

typedef struct {
  PetscReal reach, slack; /* distance along the normal and lateral allowance */
  PetscReal box[4];
} Region;

static PetscReal NodeDistance_Private(const ContactSurface *s, PetscInt a, PetscInt b)
{
  const PetscReal d[2] = {s->x[2 * a] - s->x[2 * b], s->x[2 * a + 1] - s->x[2 * b + 1]};

  return PetscSqrtReal(Dot2(d, d));
}

/* Box around x +- reach n / |n| along the edge. At the middle n is shorter than 1, so chords between the ray ends are lengthened by 1 / |n|. */
static void Region_Private(ContactPair pair, const ContactSurface *s, PetscInt edge, const EdgeFrame *f, Region *r)
{
  const PetscInt  a = s->edges[2 * edge], b = s->edges[2 * edge + 1];
  const PetscReal mid[2]   = {0.5 * (f->n[0][0] + f->n[1][0]), 0.5 * (f->n[0][1] + f->n[1][1])};
  PetscReal       shortest = f->length, stretch;

  if (pair->prev[a] >= 0) shortest = PetscMin(shortest, NodeDistance_Private(s, pair->prev[a], a));
  if (pair->next[b] >= 0) shortest = PetscMin(shortest, NodeDistance_Private(s, b, pair->next[b]));
  r->slack = 2 * pair->margin * (1 + pair->distance / shortest);
  r->reach = pair->distance + r->slack;
  stretch  = r->reach / PetscSqrtReal(Dot2(mid, mid));
  for (int i = 0; i < 2; i++) r->box[i] = PETSC_MAX_REAL, r->box[2 + i] = -PETSC_MAX_REAL;
  for (int k = 0; k < 2; k++)
    for (int side = -1; side <= 1; side += 2)
      for (int i = 0; i < 2; i++) {
        const PetscReal end = f->x[k][i] + side * stretch * f->n[k][i];

        r->box[i]     = PetscMin(r->box[i], end - r->slack);
        r->box[2 + i] = PetscMax(r->box[2 + i], end + r->slack);
      }
}

/* May the pair meet? */
static PetscBool Candidate_Private(ContactPair pair, const EdgeFrame *f, const Region *r, const ContactSurface *mortar, PetscInt edge)
{
  const PetscInt  *node = &mortar->edges[2 * edge];
  const PetscReal *c = &mortar->x[2 * node[0]], *d = &mortar->x[2 * node[1]], e[2] = {d[0] - c[0], d[1] - c[1]};
  const PetscReal  turn = Dot2(f->dx, e), length = PetscSqrtReal(Dot2(e, e)) * f->length; /* N_s . N_m = t_s . t_m */
  PetscReal        g[2], cosine, tau;
  Segment          s;

  if (!(turn < -CONTACT_OPPOSE * length)) return PETSC_FALSE;
  if (ContactRaySide(f->x[0], f->n[0], c) < -r->slack && ContactRaySide(f->x[0], f->n[0], d) < -r->slack) return PETSC_FALSE;
  if (ContactRaySide(f->x[1], f->n[1], c) > r->slack && ContactRaySide(f->x[1], f->n[1], d) > r->slack) return PETSC_FALSE;
  if (!ContactSegmentBuild(f, mortar, edge, &s)) return pair->margin > 0 || pair->node_to_segment ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2; k++) g[k] = ContactGapAt(f, c, d, s.lambda[k], &cosine, &tau);
  return (g[0] > r->reach && g[1] > r->reach) || (g[0] < -r->reach && g[1] < -r->reach) ? PETSC_FALSE : PETSC_TRUE;
}

/* Boxes of mortar edges; the tree owns them. */
static PetscErrorCode MortarTree_Private(const ContactSurface *mortar, Tree *tree)
{
  PetscReal(*box)[4];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mortar->num_edges, &box));
  for (PetscInt e = 0; e < mortar->num_edges; e++)
    for (int i = 0; i < 2; i++) {
      const PetscReal a = mortar->x[2 * mortar->edges[2 * e] + i], b = mortar->x[2 * mortar->edges[2 * e + 1] + i];

      box[e][i]     = PetscMin(a, b);
      box[e][2 + i] = PetscMax(a, b);
    }
  PetscCall(ContactTreeBuild(mortar->num_edges, box, tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copy the list of edges and make room for what is counted per listed edge. */
static PetscErrorCode ListEdges_Private(ContactPair pair, const ContactSurface *nonmortar, PetscInt num, const PetscInt edges[])
{
  PetscFunctionBegin;
  PetscCall(PetscFree(pair->listed));
  PetscCall(PetscFree(pair->start));
  PetscCall(PetscFree(pair->result));
  PetscCall(PetscFree2(pair->first_segment, pair->first_node));
  PetscCall(PetscMalloc1(num, &pair->listed));
  PetscCall(PetscMalloc1(num + 1, &pair->start));
  PetscCall(PetscMalloc1(num, &pair->result));
  PetscCall(PetscCalloc2(num + 1, &pair->first_segment, num + 1, &pair->first_node));
  for (PetscInt i = 0; i < num; i++) {
    PetscCheck(edges[i] >= 0 && edges[i] < nonmortar->num_edges, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "nonmortar edge %" PetscInt_FMT " is outside [0, %" PetscInt_FMT ")", edges[i], nonmortar->num_edges);
    pair->listed[i] = edges[i];
  }
  pair->num_listed  = num;
  pair->num_results = pair->num_segments = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Query the tree for every listed edge. found: room for all mortar edges. */
static PetscErrorCode Candidates_Private(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const Tree *tree, PetscInt found[])
{
  PetscInt  total = 0;
  EdgeFrame f;
  Region    region;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < pair->num_listed; i++) {
    PetscInt num;

    pair->start[i] = total;
    ContactFrame(pair, nonmortar, pair->listed[i], &f);
    Region_Private(pair, nonmortar, pair->listed[i], &f, &region);
    num = ContactTreeQuery(tree, region.box, mortar->num_edges, found);
    PetscCall(PetscSortInt(num, found)); /* results must not depend on the tree */
    PetscCall(ContactGrow(total + num, sizeof(PetscInt), &pair->size_candidate, &pair->candidate));
    for (PetscInt k = 0; k < num; k++)
      if (Candidate_Private(pair, &f, &region, mortar, found[k])) pair->candidate[total++] = found[k];
  }
  pair->start[pair->num_listed] = total;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairSearch(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt num, const PetscInt edges[],
                                 PetscReal distance, PetscReal margin)
{
  PetscInt *found;
  PetscBool failed = PETSC_FALSE;
  Tree      tree;

  PetscFunctionBegin;
  PetscCheck(distance > 0 && margin >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "search distance %g must be positive, margin %g not negative",
             (double)distance, (double)margin);
  pair->distance         = distance;
  pair->margin           = margin;
  pair->num_mortar_nodes = mortar->num_nodes;
  pair->num_mortar_edges = mortar->num_edges;
  PetscCall(ContactTopologyBuild(pair, nonmortar));
  PetscCall(ContactNormalsBuild(pair, nonmortar, &failed)); /* a failure shows again, and is reported, in the evaluation */
  PetscCall(ListEdges_Private(pair, nonmortar, num, edges));
  PetscCall(MortarTree_Private(mortar, &tree));
  PetscCall(PetscMalloc1(mortar->num_edges, &found));
  PetscCall(Candidates_Private(pair, nonmortar, mortar, &tree, found));
  PetscCall(PetscFree(found));
  PetscCall(ContactTreeDestroy(&tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}
