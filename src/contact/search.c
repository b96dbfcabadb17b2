/* Candidate search: which mortar facets a nonmortar facet may meet while no node moves more than `margin`.

   Which mortar facets reach into the region of a nonmortar facet's rays: region.c; of what is left the far sides of bodies are culled (culling.c).
   Distances and normals are judged here and nowhere else: between two searches the result changes continuously with the positions.

   From one search to the next it does not: a facet that tilts, or a corner that comes to lie on the other side, loses what it faces, or gains it. Gaps jump by
   that, and an iteration that searches anew at each iterate goes to and fro between two states neither of which is a solution. So searches of one solve go on
   from each other: what was found stays as long as it opposes at all and has not gone in deeper than nodes may move before the next search, and what was left
   out as only grazed stays out as long as a neighbour faces it more squarely. */
#include "kernelimpl.h"

void ContactFacetBox(const ContactSurface *s, PetscInt facet, PetscReal box[6])
{
  FacetLattice l;

  ContactFacetLattice(s, facet, &l);
  box[2] = box[5] = 0;
  for (PetscInt i = 0; i < s->dim; i++) {
    box[i]     = PETSC_MAX_REAL;
    box[3 + i] = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < l.num; k++) {
      box[i]     = PetscMin(box[i], s->x[s->dim * l.node[k] + i]);
      box[3 + i] = PetscMax(box[3 + i], s->x[s->dim * l.node[k] + i]);
    }
  }
}

static PetscBool HasFacet_Private(const ContactSurface *s, PetscInt facet)
{
  FacetLattice l;

  ContactFacetLattice(s, facet, &l);
  for (PetscInt k = 0; k < l.num; k++)
    if (!ContactHas(s, l.node[k])) return PETSC_FALSE;
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
  PetscCall(FreeAll(3, (void *[]){&pair->listed, &pair->start, &pair->result}));
  PetscCall(PetscMalloc1(num, &pair->listed));
  PetscCall(PetscMalloc1(num + 1, &pair->start));
  PetscCall(PetscMalloc1(num, &pair->result));
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

/* What the search that this one goes on from made of a mortar facet at this place of the list. */
typedef enum { WAS_NOT_MET, WAS_FOUND, WAS_GRAZED } Was;

static Was Was_Private(const ContactPair pair, PetscInt slot, PetscInt met)
{
  if (!pair->goes_on) return WAS_NOT_MET;
  for (PetscInt k = pair->base.start[slot]; k < pair->base.start[slot + 1]; k++) {
    if (pair->base.found[k] == met) return WAS_FOUND;
    if (pair->base.found[k] == ~met) return WAS_GRAZED;
  }
  return WAS_NOT_MET;
}

/* Round a sharp edge of the nonmortar side one facet faces what the other one grazes. What the latter would see beside the edge is no gap of this contact: it
   came and went by CONTACT_OPPOSE as facets tilt, and with it the mean gap of the nodes on the edge. (Faces round an edge of the mortar side are pairs of their
   own.) Is the mortar facet one that this facet grazes and a neighbour faces? */
static PetscBool IsGrazed_Private(const RayWork w, const ContactSurface *nonmortar, PetscInt facet, const ContactSurface *mortar, PetscInt met, Was was)
{
  const PetscInt nv = 2 * (nonmortar->dim - 1);
  PetscReal      n[3], m[3], other[3];

  (void)ContactFacetNormal(nonmortar->dim, nonmortar->x, nonmortar->facets + nv * facet, n);
  (void)ContactFacetNormal(mortar->dim, mortar->x, mortar->facets + nv * met, m);
  const PetscReal squarely = Dot3(n, m), least = was == WAS_GRAZED ? PetscMin(squarely, -STEEP) : -STEEP;
  if (was == WAS_FOUND || squarely >= -CONTACT_OPPOSE || (was != WAS_GRAZED && squarely <= -STEEP)) return PETSC_FALSE;
  for (PetscInt a = 0; a < nv; a++) {
    const PetscInt node = nonmortar->facets[nv * facet + a];

    for (PetscInt k = w->ring_first[node]; k < w->ring_first[node + 1]; k++) {
      (void)ContactFacetNormal(nonmortar->dim, nonmortar->x, nonmortar->facets + nv * (w->ring[k] / nv), other);
      if (Dot3(other, m) < least && ContactFacetJoint(nonmortar, facet, w->ring[k] / nv) == JOINT_SHARP) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

static PetscBool Meets_Private(ContactPair pair, const ContactSurface *nonmortar, PetscInt slot, const RayRegion *region, const FacetCorners *corners,
                               const ContactSurface *mortar, PetscInt met, PetscBool *grazed)
{
  const PetscInt facet = pair->listed[slot];
  Was            was   = Was_Private(pair, slot, met);

  /* where a smooth surface has been folded the gap of neighbours is 0, whatever moves */
  if (pair->self && ContactFacetJoint(mortar, facet, met) == JOINT_SMOOTH) return PETSC_FALSE;
  if (was == WAS_FOUND && !ContactRayRegionMeets(region, mortar, met, PETSC_TRUE)) was = WAS_NOT_MET;
  if (was != WAS_FOUND && !ContactRayRegionMeets(region, mortar, met, PETSC_FALSE)) return PETSC_FALSE;
  *grazed = IsGrazed_Private(pair->ray, nonmortar, facet, mortar, met, was);
  return (PetscBool)!ContactBehind(pair, facet, corners, mortar, met, was == WAS_FOUND ? pair->margin : 0);
}

/* Facets met that are only grazed, but where a smooth surface goes on from them to others: it does not end there. */
static void Grazed_Private(const ContactSurface *mortar, PetscInt num, const PetscInt met[], PetscBool grazed[])
{
  PetscBool more = PETSC_TRUE;

  while (more) {
    more = PETSC_FALSE;
    for (PetscInt i = 0; i < num; i++)
      for (PetscInt k = 0; k < num && grazed[i]; k++)
        if (!grazed[k] && ContactFacetJoint(mortar, met[i], met[k]) == JOINT_SMOOTH) {
          grazed[i] = PETSC_FALSE;
          more      = PETSC_TRUE;
        }
  }
}

/* What the search has made of the num facets met by the next place of the list, for searches that go on from it. */
static PetscErrorCode Remember_Private(Found *f, PetscInt num, const PetscInt met[], const PetscBool grazed[])
{
  const PetscInt first = f->num ? f->start[f->num] : 0;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(f->num + 2, sizeof(PetscInt), &f->size_start, &f->start));
  PetscCall(ArrayGrow(first + num, sizeof(PetscInt), &f->size_found, &f->found));
  for (PetscInt k = 0; k < num; k++) f->found[first + k] = grazed[k] ? ~met[k] : met[k];
  f->start[0]        = 0;
  f->start[++f->num] = first + num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Items whose boxes the region may meet, at most max (room in items[]); returns their number. Median splits bound the depth by log2(num) + 1. */
static PetscInt Query_Private(const Tree *t, const RayRegion *region, PetscInt max, PetscInt items[])
{
  PetscInt stack[TREE_DEPTH], top = 0, found = 0;

  stack[top++] = 0;
  while (top) {
    const TreeNode *node = &t->node[stack[--top]];

    if (!ContactRayRegionMeetsBox(region, node->box)) continue;
    if (node->child >= 0) {
      stack[top++] = node->child;
      stack[top++] = node->child + 1;
      continue;
    }
    for (PetscInt k = node->first; k < node->first + node->count; k++)
      if (ContactRayRegionMeetsBox(region, t->box[t->item[k]]) && found < max) items[found++] = t->item[k];
  }
  return found;
}

/* Query the tree for every listed facet. found: room for all mortar facets. */
static PetscErrorCode Candidates_Private(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, const Tree *tree,
                                         const PetscInt known[], PetscInt found[], PetscBool grazed[])
{
  PetscInt     total = 0;
  RayRegion    region;
  FacetCorners corners;

  PetscFunctionBegin;
  pair->last.num = 0;
  for (PetscInt i = 0; i < pair->num_listed; i++) {
    PetscInt num, met = 0;

    pair->start[i] = total;
    ContactRayRegion(pair, nonmortar, pair->listed[i], &region);
    num = Query_Private(tree, &region, mortar->num_facets, found);
    for (PetscInt k = 0; k < num; k++) found[k] = known[found[k]];
    ContactCorners(pair, nonmortar, pair->listed[i], &corners);
    PetscCall(PetscSortInt(num, found)); /* results must not depend on the tree */
    for (PetscInt k = 0; k < num; k++)
      if (Meets_Private(pair, nonmortar, i, &region, &corners, mortar, found[k], &grazed[met])) found[met++] = found[k];
    Grazed_Private(mortar, met, found, grazed);
    PetscCall(Remember_Private(&pair->last, met, found, grazed));
    PetscCall(ArrayGrow(total + met, sizeof(PetscInt), &pair->size_candidate, &pair->candidate));
    for (PetscInt k = 0; k < met; k++)
      if (!grazed[k]) pair->candidate[total++] = found[k];
  }
  pair->start[pair->num_listed] = total;
  pair->is_newer                = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairKeepSearch(ContactPair pair)
{
  const Found base = pair->base;

  if (!pair->is_newer) return;
  pair->base     = pair->last;
  pair->last     = base;
  pair->is_newer = PETSC_FALSE;
}

void ContactPairGoOn(ContactPair pair, PetscBool yes)
{
  pair->goes_on = yes;
}

/* What a search knows of the nonmortar side: directions, the list. */
static PetscErrorCode Prepare_Private(ContactPair pair, const ContactSurface *nonmortar, PetscInt num, const PetscInt facets[], PetscReal distance,
                                      PetscReal margin)
{
  PetscFunctionBegin;
  PetscCheck(distance > 0 && margin >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "search distance %g must be positive, margin %g not negative",
             (double)distance, (double)margin);
  pair->distance = distance;
  pair->margin   = margin;
  pair->untold   = 0;
  pair->depth    = pair->hull && pair->deepest > 0 ? pair->deepest : distance;
  PetscCall(ContactRayTopology(pair, nonmortar));
  PetscCall(ListFacets_Private(pair, nonmortar, num, facets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairSearch(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt num, const PetscInt facets[],
                                 PetscReal distance, PetscReal margin)
{
  PetscInt  *found, *known;
  PetscBool *grazed;
  Tree       tree;

  PetscFunctionBegin;
  PetscCheck(!pair->goes_on || num == pair->base.num, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONGSTATE, "a search of other facets than the one it goes on from");
  PetscCall(Prepare_Private(pair, nonmortar, num, facets, distance, margin));
  pair->num_mortar_nodes  = mortar->num_nodes;
  pair->num_mortar_facets = mortar->num_facets;
  PetscCall(ContactRayMortarTopology(pair->ray, mortar));
  PetscCall(PetscMalloc3(mortar->num_facets, &found, mortar->num_facets, &known, mortar->num_facets, &grazed));
  PetscCall(MortarTree_Private(mortar, known, &tree));
  PetscCall(Candidates_Private(pair, nonmortar, mortar, &tree, known, found, grazed));
  if (!pair->goes_on) ContactPairKeepSearch(pair);
  PetscCall(PetscFree3(found, known, grazed));
  PetscCall(ContactTreeDestroy(&tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairGetCandidates(ContactPair pair, const PetscInt **start, const PetscInt **candidate)
{
  *start     = pair->start;
  *candidate = pair->candidate;
}

PetscErrorCode ContactPairSetCandidates(ContactPair pair, const ContactSurface *nonmortar, PetscInt num, const PetscInt facets[], const PetscInt start[],
                                        const PetscInt candidate[])
{
  PetscFunctionBegin;
  PetscCall(ListFacets_Private(pair, nonmortar, num, facets));
  PetscCall(ArrayGrow(start[num], sizeof(PetscInt), &pair->size_candidate, &pair->candidate));
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
  Tree tree;

  PetscFunctionBegin;
  *num_boxes = 0;
  PetscCall(Prepare_Private(pair, nonmortar, num, facets, distance, margin));
  if (num == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(num, &all));
  for (PetscInt i = 0; i < num; i++) {
    RayRegion region;

    ContactRayRegion(pair, nonmortar, facets[i], &region);
    for (int k = 0; k < 6; k++) all[i][k] = region.box[k];
  }
  PetscCall(ContactTreeBuild(num, all, &tree));
  UpperBoxes_Private(&tree, most, num_boxes, box);
  PetscCall(ContactTreeDestroy(&tree));
  PetscFunctionReturn(PETSC_SUCCESS);
}
