/* Candidate search: which mortar facets a nonmortar facet may meet while no node moves more than `margin`.

   Edges by nodal normals (rays: rayregion.c): a pair is kept when the unit normals oppose, N_s . N_m < -0.3, and the
   mortar edge reaches into the region swept by the nonmortar edge's rays, -depth < g < distance, where the bodies' thickness says how deep an overlap may be
   (behind.c), without them the distance does (with margin 0 exactly that; with a
   margin the region grows by slack = 2 margin (1 + distance / h): relative motion of the nodes plus the turn 2 margin / h of normals of edges of length h at
   that distance; not into the body, where what lies deeper is no overlap but another body behind this one, which would be pulled through it). Of what
   is left the far sides of bodies behind go (behind.c). Distances and normals are judged here and nowhere else: between two searches the result changes
   continuously with the positions. */
#include "rayimpl.h"

typedef struct {
  PetscReal reach, slack; /* distance along the normal and lateral allowance */
  PetscReal box[6];
} Region;

static PetscReal NodeDistance_Private(const ContactSurface *s, PetscInt a, PetscInt b)
{
  const PetscReal d[2] = {s->x[2 * a] - s->x[2 * b], s->x[2 * a + 1] - s->x[2 * b + 1]};

  return PetscSqrtReal(Dot2(d, d));
}

/* Box around x +- reach n / |n| along the edge. At the middle n is shorter than 1, so chords between the ray ends are lengthened by 1 / |n|. */
static void Region_Private(ContactPair pair, const ContactSurface *s, PetscInt edge, const EdgeFrame *f, Region *r)
{
  const PetscInt  a = s->facets[2 * edge], b = s->facets[2 * edge + 1];
  const PetscReal mid[2]   = {0.5 * (f->n[0][0] + f->n[1][0]), 0.5 * (f->n[0][1] + f->n[1][1])};
  PetscReal       shortest = f->length, stretch;

  if (pair->prev[a] >= 0) shortest = PetscMin(shortest, NodeDistance_Private(s, pair->prev[a], a));
  if (pair->next[b] >= 0) shortest = PetscMin(shortest, NodeDistance_Private(s, b, pair->next[b]));
  r->slack = 2 * pair->margin * (1 + pair->distance / shortest);
  r->reach = pair->distance + r->slack;
  stretch  = 1 / PetscSqrtReal(Dot2(mid, mid));
  for (int i = 0; i < 2; i++) r->box[i] = PETSC_MAX_REAL, r->box[3 + i] = -PETSC_MAX_REAL;
  r->box[2] = r->box[5] = 0;
  for (int k = 0; k < 2; k++)
    for (int side = -1; side <= 1; side += 2)
      for (int i = 0; i < 2; i++) {
        const PetscReal end = f->x[k][i] + (side > 0 ? r->reach : -pair->depth) * stretch * f->n[k][i];

        r->box[i]     = PetscMin(r->box[i], end - r->slack);
        r->box[3 + i] = PetscMax(r->box[3 + i], end + r->slack);
      }
}

/* May the pair meet? */
static PetscBool Candidate_Private(ContactPair pair, const EdgeFrame *f, const Region *r, const ContactSurface *mortar, PetscInt edge)
{
  const PetscInt  *node = &mortar->facets[2 * edge];
  const PetscReal *c = &mortar->x[2 * node[0]], *d = &mortar->x[2 * node[1]], e[2] = {d[0] - c[0], d[1] - c[1]};
  const PetscReal  turn = Dot2(f->dx, e), length = PetscSqrtReal(Dot2(e, e)) * f->length; /* N_s . N_m = t_s . t_m */
  PetscReal        g[2], cosine, tau;
  Segment          s;

  if (!(turn < -CONTACT_OPPOSE * length)) return PETSC_FALSE;
  if (ContactRaySide(f->x[0], f->n[0], c) < -r->slack && ContactRaySide(f->x[0], f->n[0], d) < -r->slack) return PETSC_FALSE;
  if (ContactRaySide(f->x[1], f->n[1], c) > r->slack && ContactRaySide(f->x[1], f->n[1], d) > r->slack) return PETSC_FALSE;
  if (!ContactSegmentBuild(f, mortar, edge, &s)) return pair->margin > 0 || pair->node_to_segment ? PETSC_TRUE : PETSC_FALSE;
  for (int k = 0; k < 2; k++) g[k] = ContactGapAt(f, c, d, s.lambda[k], &cosine, &tau);
  return (g[0] > r->reach && g[1] > r->reach) || (g[0] < -pair->depth && g[1] < -pair->depth) ? PETSC_FALSE : PETSC_TRUE;
}

PetscInt ContactFacetNodes(const ContactSurface *s, PetscInt facet, const PetscInt **node)
{
  const PetscInt corners = s->dim == 2 ? 2 : 4;

  *node = s->order ? s->lattice + s->first[facet] : s->facets + corners * facet;
  return s->order ? s->first[facet + 1] - s->first[facet] : corners;
}

void ContactFacetBox(const ContactSurface *s, PetscInt facet, PetscReal box[6])
{
  const PetscInt *node, num = ContactFacetNodes(s, facet, &node);

  box[2] = box[5] = 0;
  for (PetscInt i = 0; i < s->dim; i++) {
    box[i]     = PETSC_MAX_REAL;
    box[3 + i] = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < num; k++) {
      box[i]     = PetscMin(box[i], s->x[s->dim * node[k] + i]);
      box[3 + i] = PetscMax(box[3 + i], s->x[s->dim * node[k] + i]);
    }
  }
}

static PetscBool HasFacet_Private(const ContactSurface *s, PetscInt facet)
{
  const PetscInt *node, num = ContactFacetNodes(s, facet, &node);

  for (PetscInt k = 0; k < num; k++)
    if (!ContactHas(s, node[k])) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Tree over the boxes of those mortar facets that are known; item[i] of the tree is facet known[item[i]]. */
static PetscErrorCode MortarTree_Private(const ContactSurface *mortar, PetscInt known[], Tree *tree)
{
  PetscInt num = 0;
  PetscReal(*box)[6];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(mortar->num_facets, &box));
  for (PetscInt f = 0; f < mortar->num_facets; f++) {
    if (!HasFacet_Private(mortar, f)) continue;
    ContactFacetBox(mortar, f, box[num]);
    known[num++] = f;
  }
  PetscCall(ContactTreeBuild(num, box, tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copy the list of facets and make room for what is counted per listed edge. */
static PetscErrorCode ListFacets_Private(ContactPair pair, const ContactSurface *nonmortar, PetscInt num, const PetscInt facets[])
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
    PetscCheck(facets[i] >= 0 && facets[i] < nonmortar->num_facets, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "nonmortar facet %" PetscInt_FMT " is outside [0, %" PetscInt_FMT ")", facets[i], nonmortar->num_facets);
    pair->listed[i] = facets[i];
  }
  pair->num_listed   = num;
  pair->state.stands = PETSC_FALSE;
  pair->num_results = pair->num_segments = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The region of a listed facet, by the kernel in use. */
typedef struct {
  EdgeFrame edge;
  Region    swept;
  RayRegion rays;
} Reach;

static const PetscReal *Reach_Private(ContactPair pair, const ContactSurface *nonmortar, PetscInt facet, Reach *r)
{
  if (pair->rays) {
    ContactRayRegion(pair, nonmortar, facet, &r->rays);
    return r->rays.box;
  }
  ContactFrame(pair, nonmortar, facet, &r->edge);
  Region_Private(pair, nonmortar, facet, &r->edge, &r->swept);
  return r->swept.box;
}

static PetscBool Meets_Private(ContactPair pair, const Reach *r, const ContactSurface *mortar, PetscInt facet)
{
  if (pair->rays) return ContactRayRegionMeets(&r->rays, mortar, facet);
  return Candidate_Private(pair, &r->edge, &r->swept, mortar, facet);
}

/* Query the tree for every listed facet. found: room for all mortar facets. */
static PetscErrorCode Candidates_Private(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const Tree *tree,
                                         const PetscInt known[], PetscInt found[])
{
  PetscInt     total = 0;
  Reach        reach;
  FacetCorners corners;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < pair->num_listed; i++) {
    PetscInt num;

    pair->start[i] = total;
    num            = ContactTreeQuery(tree, Reach_Private(pair, nonmortar, pair->listed[i], &reach), mortar->num_facets, found);
    for (PetscInt k = 0; k < num; k++) found[k] = known[found[k]];
    ContactCorners(pair, nonmortar, pair->listed[i], &corners);
    PetscCall(PetscSortInt(num, found)); /* results must not depend on the tree */
    PetscCall(ContactGrow(total + num, sizeof(PetscInt), &pair->size_candidate, &pair->candidate));
    for (PetscInt k = 0; k < num; k++)
      if (Meets_Private(pair, &reach, mortar, found[k]) && !ContactBehind(pair, pair->listed[i], &corners, mortar, found[k]))
        pair->candidate[total++] = found[k];
  }
  pair->start[pair->num_listed] = total;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a search knows of the nonmortar side: neighbours, normals, the list. higher: the mortar side has facets of higher order. */
static PetscErrorCode Prepare_Private(ContactPair pair, const ContactSurface *nonmortar, PetscBool higher, PetscInt num, const PetscInt facets[],
                                      PetscReal distance, PetscReal margin)
{
  PetscBool failed = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCheck(distance > 0 && margin >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "search distance %g must be positive, margin %g not negative",
             (double)distance, (double)margin);
  pair->distance = distance;
  pair->margin   = margin;
  pair->untold   = 0;
  pair->depth    = pair->hull && pair->deepest > 0 ? pair->deepest : distance;
  pair->rays     = (PetscBool)(pair->dim == 3 || nonmortar->order || higher || pair->continuous);
  if (pair->rays)
    PetscCall(ContactRayTopology(pair, nonmortar));
  else {
    PetscCall(ContactTopologyBuild(pair, nonmortar));
    PetscCall(ContactNormalsBuild(pair, nonmortar, &failed)); /* a failure shows again, and is reported, in the evaluation */
  }
  PetscCall(ListFacets_Private(pair, nonmortar, num, facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairSearch(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt num, const PetscInt facets[],
                                 PetscReal distance, PetscReal margin)
{
  PetscInt *found, *known;
  Tree      tree;

  PetscFunctionBegin;
  PetscCall(Prepare_Private(pair, nonmortar, (PetscBool)(mortar->order != NULL), num, facets, distance, margin));
  pair->num_mortar_nodes  = mortar->num_nodes;
  pair->num_mortar_facets = mortar->num_facets;
  if (pair->rays) PetscCall(ContactRayMortarTopology(pair->ray, mortar));
  PetscCall(PetscMalloc2(mortar->num_facets, &found, mortar->num_facets, &known));
  PetscCall(MortarTree_Private(mortar, known, &tree));
  PetscCall(Candidates_Private(pair, nonmortar, mortar, &tree, known, found));
  PetscCall(PetscFree2(found, known));
  PetscCall(ContactTreeDestroy(&tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairGetCandidates(ContactPair pair, const PetscInt **start, const PetscInt **candidate)
{
  PetscFunctionBegin;
  *start     = pair->start;
  *candidate = pair->candidate;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairSetCandidates(ContactPair pair, const ContactSurface *nonmortar, PetscInt num, const PetscInt facets[], const PetscInt start[],
                                        const PetscInt candidate[])
{
  PetscFunctionBegin;
  PetscCall(ListFacets_Private(pair, nonmortar, num, facets));
  PetscCall(ContactGrow(start[num], sizeof(PetscInt), &pair->size_candidate, &pair->candidate));
  PetscCall(PetscArraycpy(pair->start, start, num + 1));
  PetscCall(PetscArraycpy(pair->candidate, candidate, start[num]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The upper nodes of the tree, split from the top while there is room. */
static void UpperBoxes_Private(const Tree *tree, PetscInt most, PetscInt *num, PetscReal box[][6])
{
  PetscInt node[1024], at = 0;

  *num    = 1;
  node[0] = 0;
  most    = PetscMin(most, 1024);
  while (at < *num && *num < most) {
    const PetscInt child = tree->node[node[at]].child;

    if (child < 0) {
      at++;
      continue;
    }
    for (PetscInt k = at; k + 1 < *num; k++) node[k] = node[k + 1]; /* halves go to the end: all of one level before the next */
    node[*num - 1] = child;
    node[(*num)++] = child + 1;
  }
  for (PetscInt k = 0; k < *num; k++)
    for (int i = 0; i < 6; i++) box[k][i] = tree->node[node[k]].box[i];
}

PetscErrorCode ContactPairReach(ContactPair pair, const ContactSurface *nonmortar, PetscInt num, const PetscInt facets[], PetscReal distance, PetscReal margin,
                                PetscInt most, PetscInt *num_boxes, PetscReal box[][6])
{
  PetscReal(*all)[6];
  Reach reach;
  Tree  tree;

  PetscFunctionBegin;
  *num_boxes = 0;
  PetscCall(Prepare_Private(pair, nonmortar, (PetscBool)(nonmortar->order != NULL), num, facets, distance, margin));
  if (num == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(num, &all));
  for (PetscInt i = 0; i < num; i++) {
    const PetscReal *own = Reach_Private(pair, nonmortar, facets[i], &reach);

    for (int k = 0; k < 6; k++) all[i][k] = own[k];
  }
  PetscCall(ContactTreeBuild(num, all, &tree));
  UpperBoxes_Private(&tree, most, num_boxes, box);
  PetscCall(ContactTreeDestroy(&tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}
