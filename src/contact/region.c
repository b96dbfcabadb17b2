/* Candidate search for rays along a continuous direction: what a facet may meet while no node moves more than the pair's margin.

   A mortar facet is kept when the vectors of the facets oppose, N_s . N_m < -0.3, and the boxes around its lattice nodes and around the rays, `distance`
   long outwards and `depth` inwards, meet in the facet's own axes. With a margin the box of the rays grows by 2 margin (1 + distance / h), h the facet's
   shortest side, but not into the body: what lies deeper is no overlap but another body behind this one, which would be pulled through it. Sideways a facet
   that rays meet after a length L < distance has no more than 2 margin (1 + L / h): between plates side by side all others would be kept. The box of the rays
   also has an eighth of the facet's size to all sides but the rays' for the bulge of curved facets between their nodes. */
#include "kernelimpl.h"

static PetscReal Axes_Private(const ContactSurface *s, PetscInt facet, PetscReal axis[3][3])
{
  const PetscInt *node   = s->facets + 2 * (s->dim - 1) * facet;
  PetscReal       length = 0, size = ContactFacetNormal(s->dim, s->x, node, axis[2]);

  for (PetscInt c = 0; c < 3; c++) {
    axis[0][c] = c < s->dim ? s->x[s->dim * node[s->dim - 1] + c] - s->x[s->dim * node[0] + c] : 0;
    length += PetscSqr(axis[0][c]);
  }
  for (int c = 0; c < 3; c++) axis[0][c] /= PetscSqrtReal(length);
  Cross3(axis[2], axis[0], axis[1]);
  return size;
}

static void Enclose_Private(RayRegion *r, const PetscReal x[3], PetscReal slack)
{
  for (int i = 0; i < 3; i++) {
    const PetscReal y = Dot3(r->axis[i], x);

    r->box[i]     = PetscMin(r->box[i], x[i] - slack);
    r->box[3 + i] = PetscMax(r->box[3 + i], x[i] + slack);
    r->lo[i]      = PetscMin(r->lo[i], y - slack);
    r->hi[i]      = PetscMax(r->hi[i], y + slack);
  }
}

void ContactRayRegion(ContactPair pair, const ContactSurface *s, PetscInt facet, RayRegion *r)
{
  const PetscInt nv       = 2 * (s->dim - 1);
  PetscReal      shortest = PETSC_MAX_REAL, steepest = 1, size, reach, bulge;
  RayLattice     l;

  for (int i = 0; i < 3; i++) {
    r->box[i] = r->lo[i] = PETSC_MAX_REAL;
    r->box[3 + i] = r->hi[i] = -PETSC_MAX_REAL;
  }
  r->slack = -1;
  r->low   = PETSC_MAX_REAL;
  r->high  = -PETSC_MAX_REAL;
  size     = Axes_Private(s, facet, r->axis);
  for (PetscInt a = 0; a < nv; a++) {
    const PetscInt p = s->facets[nv * facet + a], q = s->facets[nv * facet + (a + 1) % nv];
    PetscReal      sum = 0;

    for (PetscInt c = 0; c < s->dim; c++) sum += PetscSqr(s->x[s->dim * p + c] - s->x[s->dim * q + c]);
    shortest = PetscMin(shortest, PetscSqrtReal(sum));
  }
  if (!(size > 0) || !(shortest > 0)) return; /* meets nothing; the evaluation says so */
  r->slack = 2 * pair->margin * (1 + pair->distance / shortest);
  reach    = pair->distance + r->slack;
  ContactRayLatticeGather(s, facet, &l);
  bulge = l.order > 1 ? (s->dim == 2 ? size : PetscSqrtReal(size)) / 8 : 0;
  for (PetscInt a = 0; a < l.num; a++) {
    Enclose_Private(r, l.x[a], r->slack + bulge);
    r->low  = PetscMin(r->low, Dot3(r->axis[2], l.x[a]));
    r->high = PetscMax(r->high, Dot3(r->axis[2], l.x[a]));
  }
  for (PetscInt a = 0; a < nv; a++) {
    const PetscInt   node = s->facets[nv * facet + a];
    const PetscReal *d = pair->ray->d + 3 * (nv * facet + a), length = PetscSqrtReal(Dot3(d, d));

    if (length > 0) steepest = PetscMin(steepest, Dot3(r->axis[2], d) / length);
    for (int side = -1; side <= 1 && length > 0; side += 2) {
      PetscReal end[3];

      for (PetscInt c = 0; c < 3; c++) end[c] = (c < s->dim ? s->x[s->dim * node + c] : 0) + (side > 0 ? reach : -pair->depth) / length * d[c];
      Enclose_Private(r, end, r->slack + bulge);
    }
  }
  r->lo[2]   = PetscMax(r->lo[2], r->low - pair->depth);
  r->shallow = r->low - pair->margin;
  r->base    = steepest > 0 ? 2 * pair->margin : r->slack;
  r->turn    = steepest > 0 ? 2 * pair->margin / (shortest * steepest) : 0;
  if (s->dim == 2) r->box[2] = r->box[5] = 0;
}

/* Do the boxes meet, in the facet's own axes? The room for motion is that of rays which are long enough to reach this one. */
static PetscBool Overlap_Private(const RayRegion *r, const PetscReal lo[3], const PetscReal hi[3])
{
  const PetscReal height = PetscMax(0, PetscMax(hi[2] - r->low, r->high - lo[2])), less = PetscMax(0, r->slack - r->base - r->turn * height);

  for (int i = 0; i < 2; i++)
    if (lo[i] > r->hi[i] - less || hi[i] < r->lo[i] + less) return PETSC_FALSE;
  return (PetscBool)(lo[2] <= r->hi[2] && hi[2] >= r->lo[2]);
}

PetscBool ContactRayRegionMeetsBox(const RayRegion *r, const PetscReal box[6])
{
  PetscReal lo[3], hi[3];

  for (int i = 0; i < 3; i++) {
    PetscReal middle = 0, half = 0;

    if (box[i] > r->box[3 + i] || box[3 + i] < r->box[i]) return PETSC_FALSE;
    for (int c = 0; c < 3; c++) {
      middle += 0.5 * r->axis[i][c] * (box[c] + box[3 + c]);
      half += 0.5 * PetscAbsReal(r->axis[i][c]) * (box[3 + c] - box[c]);
    }
    lo[i] = middle - half, hi[i] = middle + half;
  }
  return Overlap_Private(r, lo, hi);
}

PetscBool ContactRayRegionMeets(const RayRegion *r, const ContactSurface *mortar, PetscInt facet, PetscBool again)
{
  const PetscReal oppose = again ? 0 : CONTACT_OPPOSE;
  PetscReal       lo[3], hi[3], N[3];
  RayLattice      l;

  if (r->slack < 0) return PETSC_FALSE;
  ContactFacetVector(mortar->dim, mortar->x, mortar->facets + 2 * (mortar->dim - 1) * facet, N);
  if (!(Dot3(N, r->axis[2]) < -oppose * PetscSqrtReal(Dot3(N, N)))) return PETSC_FALSE;
  ContactRayLatticeGather(mortar, facet, &l);
  for (int i = 0; i < 3; i++) {
    lo[i] = PETSC_MAX_REAL, hi[i] = -PETSC_MAX_REAL;
    for (PetscInt a = 0; a < l.num; a++) {
      const PetscReal y = Dot3(r->axis[i], l.x[a]);

      lo[i] = PetscMin(lo[i], y), hi[i] = PetscMax(hi[i], y);
    }
  }
  return (PetscBool)(Overlap_Private(r, lo, hi) && (!again || hi[2] >= r->shallow));
}
