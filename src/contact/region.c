/* Candidate search in three dimensions: what a nonmortar facet may meet while no node moves more than the pair's margin.

   A mortar facet is kept when the unit normals of the vector areas oppose, N_s . N_m < -0.3, and some of it lies in the prism over the facet along its normal,
   up to `distance` above and `depth` below; with a margin the prism grows to all sides but into the body by slack = 2 margin (1 + distance / h), h the facet's
   shortest side: relative motion of the nodes plus the turn 2 margin / h of the normal at that distance. What lies deeper in the body is no overlap but another
   body behind this one, which would be pulled through it. */
#include "facetimpl.h"

static void Corners_Private(const ContactSurface *s, PetscInt facet, PetscReal x[4][3])
{
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 3; i++) x[a][i] = s->x[3 * s->facets[4 * facet + a] + i];
}

static PetscReal ShortestSide_Private(const PetscReal x[4][3])
{
  PetscReal least = PETSC_MAX_REAL;

  for (int a = 0; a < 4; a++) {
    const PetscReal *p = x[a], *q = x[(a + 1) % 4];

    least = PetscMin(least, PetscSqr(p[0] - q[0]) + PetscSqr(p[1] - q[1]) + PetscSqr(p[2] - q[2]));
  }
  return PetscSqrtReal(least);
}

void ContactRegionCreate(ContactPair pair, const ContactSurface *s, PetscInt facet, FacetRegion *r)
{
  PetscReal shortest;

  Corners_Private(s, facet, r->x);
  shortest = ShortestSide_Private(r->x);
  for (int i = 0; i < 3; i++) r->box[i] = PETSC_MAX_REAL, r->box[3 + i] = -PETSC_MAX_REAL;
  r->reach = r->slack = -1;
  if (!ContactFacetFrame(r->x, &r->frame) || !(shortest > 0)) return; /* meets nothing; the evaluation says so */
  r->slack = 2 * pair->margin * (1 + pair->distance / shortest);
  r->depth = pair->depth;
  r->reach = pair->distance + r->slack;
  for (int a = 0; a < 4; a++)
    for (int side = -1; side <= 1; side += 2)
      for (int i = 0; i < 3; i++) {
        const PetscReal end = r->x[a][i] + (side > 0 ? r->reach : -r->depth) * r->frame.E[2][i];

        r->box[i]     = PetscMin(r->box[i], end - r->slack);
        r->box[3 + i] = PetscMax(r->box[3 + i], end + r->slack);
      }
}

PetscBool ContactRegionMeets(const FacetRegion *r, const ContactSurface *mortar, PetscInt facet)
{
  static const PetscInt node[4] = {0, 1, 2, 3};
  PetscReal             x[4][3], X[4][3], N[3];

  if (r->reach < 0) return PETSC_FALSE;
  Corners_Private(mortar, facet, x);
  for (int a = 0; a < 4; a++) ContactFacetLocal(&r->frame, x[a], X[a]);
  ContactFacetVector(3, X[0], node, N);
  if (!(N[2] < -CONTACT_OPPOSE * PetscSqrtReal(Dot3(N, N)))) return PETSC_FALSE; /* N[2]: along the facet's own normal */
  for (int i = 0; i < 3; i++) {
    PetscReal lo[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[2] = {-PETSC_MAX_REAL, -PETSC_MAX_REAL};

    for (int a = 0; a < 4; a++) {
      lo[0] = PetscMin(lo[0], X[a][i]), hi[0] = PetscMax(hi[0], X[a][i]);
      lo[1] = PetscMin(lo[1], r->frame.X[a][i]), hi[1] = PetscMax(hi[1], r->frame.X[a][i]);
    }
    const PetscReal out = i == 2 ? r->reach : r->slack, in = i == 2 ? r->depth : r->slack;
    if (lo[0] > hi[1] + out || hi[0] < lo[1] - in) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
