/* What covers a nonmortar facet: images of the mortar facets' corners, polygons in the chart. */
#include "kernelimpl.h"

static void Between_Private(const RayImage *a, const RayImage *b, RayImage *to)
{
  to->found = (PetscBool)(a->found && b->found);
  to->s     = 0.5 * (a->s + b->s);
  for (int i = 0; i < 2; i++) to->Y[i] = 0.5 * (a->Y[i] + b->Y[i]);
}

/* Place of an image; found when new. */
static PetscErrorCode Image_Private(RayWork w, const ContactSurface *mortar, PetscInt node, PetscInt *place)
{
  PetscInt  parent[2], end[2] = {-1, -1};
  RayImage *image;

  PetscFunctionBegin;
  for (*place = 0; *place < w->num_images; (*place)++)
    if (w->image[*place].node == node) PetscFunctionReturn(PETSC_SUCCESS);
  ContactRayParents(w, mortar, node, parent);
  for (int k = 0; k < 2 && parent[0] >= 0; k++) PetscCall(Image_Private(w, mortar, parent[k], &end[k]));
  PetscCall(ArrayGrow(w->num_images + 1, sizeof(RayImage), &w->size_image, &w->image));
  *place           = w->num_images++;
  image            = &w->image[*place];
  image->node      = node;
  image->parent[0] = parent[0], image->parent[1] = parent[1];
  if (end[0] >= 0) {
    Between_Private(&w->image[end[0]], &w->image[end[1]], image);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt c = 0; c < 3; c++) image->v[c] = c < mortar->dim ? mortar->x[mortar->dim * node + c] : 0;
  ContactImageFind(&w->facet, image);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of an interval that the image covers, as a strip; its ends' images, or -1, in line[0] and line[1]. */
static PetscBool ClipInterval_Private(Overlap *o)
{
  const PetscReal lo = o->side[0].Y[0][0], hi = o->side[0].Y[1][0], on = CONTACT_ROUND * (hi - lo);
  PetscReal       a = o->side[1].Y[0][0], b = o->side[1].Y[1][0];

  o->line[0] = a > lo + on ? 0 : -1;
  o->line[1] = b < hi - on ? 1 : -1;
  if (o->line[0] < 0) a = lo;
  if (o->line[1] < 0) b = hi;
  if (!(a < b) || a >= hi - on || b <= lo + on) return PETSC_FALSE; /* the neighbour then reaches the end and does not move */
  o->num = 4;
  for (int k = 0; k < 4; k++) {
    o->v[k][0] = k == 0 || k == 3 ? a : b;
    o->v[k][1] = k < 2 ? -1 : 1;
  }
  o->area = 2 * (b - a);
  return PETSC_TRUE;
}

/* One piece of a mortar facet seen in the facet. Its corners run backwards. *known: all images were found, and their overlap is one. */
static PetscErrorCode Meet_Private(RayWork w, const ContactSurface *mortar, const PetscInt corner[4], Overlap *o, PetscBool *known, PetscBool *meets)
{
  const RayFacet *f      = &w->facet;
  PetscReal       sum[3] = {0, 0, 0}, length;

  PetscFunctionBegin;
  *known = PETSC_TRUE, *meets = PETSC_FALSE;
  o->node    = -1;
  o->side[0] = f->chart;
  for (PetscInt a = 0; a < f->nv; a++)
    for (int c = 0; c < 3; c++) sum[c] += f->d.x[a][c] / (PetscReal)f->nv;
  length = PetscSqrtReal(Dot3(sum, sum));
  for (PetscInt k = 0; k < f->nv; k++) {
    PetscInt place;

    o->corner[k] = corner[f->nv - 1 - k];
    PetscCall(Image_Private(w, mortar, o->corner[k], &place));
    if (!w->image[place].found) *known = PETSC_FALSE;
    for (int i = 0; i < 2; i++) o->side[1].Y[k][i] = w->image[place].Y[i];
    o->side[1].h[k] = length * w->image[place].s;
  }
  if (!*known) PetscFunctionReturn(PETSC_SUCCESS);
  if (f->m == 1) {
    for (int k = 0; k < 2; k++) {
      o->side[1].Y[3 - k][0] = o->side[1].Y[k][0];
      o->side[1].Y[k][1] = -1, o->side[1].Y[3 - k][1] = 1;
      o->side[1].h[3 - k] = o->side[1].h[k];
    }
    *meets = ClipInterval_Private(o);
  } else {
    *meets = ContactClip(o, PetscSqrtReal(f->area));
    if (o->num > FACET_VERTICES) *known = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Push_Private(RayWork w, const Overlap *o, PetscInt mortar)
{
  PetscFunctionBegin;
  PetscCall(ArrayGrow(w->num_overlaps + 1, sizeof(Overlap), &w->size_overlap, &w->overlap));
  PetscCall(ArrayGrow(w->num_overlaps + 1, sizeof(PetscInt), &w->size_mortar, &w->mortar));
  w->overlap[w->num_overlaps]  = *o;
  w->mortar[w->num_overlaps++] = mortar;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All of a mortar facet that the nonmortar facet sees. */
static PetscErrorCode See_Private(ContactPair pair, const ContactSurface *mortar, PetscInt facet)
{
  RayWork        w = pair->ray;
  PetscInt       corner[4][4];
  const PetscInt num = ContactRayPieces(w, mortar, facet, corner);

  PetscFunctionBegin;
  for (PetscInt k = 0; k < num; k++) {
    Overlap   o;
    PetscBool known, meets;

    PetscCall(Meet_Private(w, mortar, corner[k], &o, &known, &meets));
    if (!known) pair->num_degenerate++;
    if (meets) PetscCall(Push_Private(w, &o, facet));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is an image a corner of what counts, or one in the middle of which one of images [from, ..) lies? */
static PetscBool Used_Private(const RayWork w, PetscInt i, PetscInt from)
{
  const PetscInt nv = w->facet.nv, node = w->image[i].node;

  for (PetscInt k = 0; k < w->num_overlaps; k++)
    for (PetscInt a = 0; a < nv; a++)
      if (w->overlap[k].corner[a] == node) return PETSC_TRUE;
  for (PetscInt k = from; k < w->num_images; k++)
    if (w->image[k].parent[0] == node || w->image[k].parent[1] == node) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode AddVertex_Private(RayWork w, PetscInt node)
{
  PetscFunctionBegin;
  for (PetscInt at = 0; at < w->num_mortar; at++)
    if (w->vertex[at] == node) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayGrow(w->num_mortar + 1, sizeof(PetscInt), &w->size_vertex, &w->vertex));
  w->vertex[w->num_mortar++] = node;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Keep the images of the facets that count, and those they hang on; list the mortar nodes. */
static PetscErrorCode Nodes_Private(RayWork w, const ContactSurface *mortar)
{
  PetscInt first = w->num_images;

  PetscFunctionBegin;
  for (PetscInt i = w->num_images - 1; i >= 0; i--) /* from the back, where those that hang are */
    if (Used_Private(w, i, first)) w->image[--first] = w->image[i];
  w->num_images -= first;
  memmove(w->image, w->image + first, (size_t)w->num_images * sizeof(RayImage));
  w->num_mortar = 0;
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    FacetLattice l;

    if (k && w->mortar[k] == w->mortar[k - 1]) continue;
    ContactFacetLattice(mortar, w->mortar[k], &l);
    for (PetscInt a = 0; a < l.num; a++) PetscCall(AddVertex_Private(w, l.node[a]));
  }
  for (PetscInt i = 0; i < w->num_images; i++)
    if (w->image[i].parent[0] < 0) PetscCall(AddVertex_Private(w, w->image[i].node));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the nonmortar facet carry the constraint where it faces the mortar facet? Not where that one belongs to another part of the pair or, of a surface with
   itself, is the nonmortar one. */
static PetscBool Carries_Private(const ContactPair pair, PetscInt facet, PetscInt mortar)
{
  if (pair->met && !pair->met[mortar]) return PETSC_FALSE;
  return (PetscBool)(!pair->precedence || pair->precedence[facet] <= pair->precedence[mortar]);
}

/* Is there a candidate for which it does? */
static PetscBool CarriesAny_Private(const ContactPair pair, PetscInt slot)
{
  for (PetscInt k = pair->start[slot]; k < pair->start[slot + 1]; k++)
    if (Carries_Private(pair, pair->listed[slot], pair->candidate[k])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Overlaps for which it does not. Only now, since they hide what lies behind them. */
static void LeaveOut_Private(ContactPair pair, PetscInt facet)
{
  RayWork  w    = pair->ray;
  PetscInt kept = 0;

  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    if (!Carries_Private(pair, facet, w->mortar[k])) continue;
    w->overlap[kept] = w->overlap[k], w->mortar[kept++] = w->mortar[k];
  }
  w->num_overlaps = kept;
}

/* Are lines of the mortar side held in the forces? In space where it ends within the facet, and creases where the
   segmentation is frozen; in the plane, where creases are met exactly, ends where it is frozen. */
static PetscBool Freezes_Private(const ContactPair pair, const RayWork w)
{
  if (pair->held) return PETSC_FALSE;
  if (w->facet.D == 2) return (PetscBool)(w->ends && pair->frozen_segmentation);
  return (PetscBool)(w->ends || (pair->frozen_segmentation && w->facet.s.order > 1));
}

/* Does what covers the facet end at an edge beyond which the mortar side goes on with another face? */
static PetscBool IsAcross_Private(const RayWork w, const ContactSurface *mortar)
{
  for (PetscInt k = 0; k < w->num_overlaps && mortar->rim; k++) {
    const Overlap *o = &w->overlap[k];

    for (PetscInt a = 0; a < w->facet.nv; a++) {
      const PetscInt i = o->corner[a], j = o->corner[(a + 1) % w->facet.nv];

      if (w->facet.m == 1 && o->line[a] < 0) continue;
      if (i < mortar->num_nodes && mortar->rim[i] && (w->facet.m == 1 || (j < mortar->num_nodes && mortar->rim[j]))) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

/* Of a corner that hangs the mean of its edge's ends. */
static PetscReal Closed_Private(const ContactPair pair, PetscInt node)
{
  const PetscInt *parent = pair->ray->parent + 2 * node;

  return parent[0] < 0 ? pair->closed[node] : (Closed_Private(pair, parent[0]) + Closed_Private(pair, parent[1])) / 2;
}

PetscErrorCode ContactCover(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt slot, PetscBool *failed)
{
  RayWork        w       = pair->ray;
  RayFacet      *f       = &w->facet;
  const PetscInt facet   = pair->listed[slot];
  PetscReal      covered = 0;
  RayBundle      rays;

  PetscFunctionBegin;
  w->num_images = w->num_overlaps = w->num_mortar = 0;
  if (!CarriesAny_Private(pair, slot)) PetscFunctionReturn(PETSC_SUCCESS);
  f->D       = nonmortar->dim;
  f->m       = f->D - 1;
  f->nv      = 2 * f->m;
  f->ring    = pair->axisymmetric ? 2 * PETSC_PI : 0;
  f->closes  = (PetscBool)(pair->closed != NULL);
  f->d.order = 1, f->d.num = f->nv;
  ContactRayLatticeGather(nonmortar, facet, &f->s);
  for (PetscInt a = 0; a < f->nv; a++) {
    const PetscInt corner = ContactCorner(f->nv, facet, a);

    for (int c = 0; c < 3; c++) f->d.x[a][c] = w->d[3 * corner + c];
    if (f->closes) f->closed[a] = Closed_Private(pair, nonmortar->facets[corner]);
    if (!ContactDirectionUsable(w, nonmortar, corner)) *failed = PETSC_TRUE;
  }
  if (f->m == 2) ContactRayLatticePolynomial(&f->d);
  if (!ContactChartCreate(nonmortar, facet, f)) *failed = PETSC_TRUE;
  if (*failed) PetscFunctionReturn(PETSC_SUCCESS);
  if (f->m == 2) ContactRayBeyondSides(w->kept + 4 * facet, &f->beyond);
  ContactImagesPrepare(f);
  ContactRayBundle(f, &rays);
  for (PetscInt k = pair->start[slot]; k < pair->start[slot + 1]; k++)
    if (ContactRayBundleMeets(&rays, &w->ball[pair->candidate[k]])) PetscCall(See_Private(pair, mortar, pair->candidate[k]));
  ContactUnfold(&w->num_overlaps, w->overlap, w->mortar, f->area);
  LeaveOut_Private(pair, facet);
  if (pair->node_to_segment) ContactNodeHits(w);
  for (PetscInt k = 0; k < w->num_overlaps; k++) covered += w->overlap[k].area;
  w->ends   = (PetscBool)(covered < (1 - CONTACT_ROUND) * f->area);
  w->across = (PetscBool)(w->ends && IsAcross_Private(w, mortar));
  w->frozen = Freezes_Private(pair, w);
  PetscCall(Nodes_Private(w, mortar));
  w->n = f->D * (f->s.num + f->nv + w->num_mortar) + f->m * w->num_images;
  PetscFunctionReturn(PETSC_SUCCESS);
}
