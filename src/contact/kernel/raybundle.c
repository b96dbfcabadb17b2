/* Which candidates a facet can see at the positions of an evaluation. A search keeps what may come into view while nodes move by its margin, which is most of
   the other side where facets are fine. Images are found only for mortar facets near the rays.

   All rays lie in a cone around the mean one: |x - X - s D| <= radius + |s| spread at length s. A mortar facet is seen when the ball around its nodes, twice as
   large since its picture in the chart has straight sides where its own are curved, meets the cone. */
#include "kernelimpl.h"

/* Mean of points, and the greatest distance of one from it. */
static PetscReal Ball_Private(PetscInt num, const PetscReal *x[], PetscInt dim, PetscReal middle[3])
{
  PetscReal square = 0;

  middle[0] = middle[1] = middle[2] = 0;
  for (PetscInt a = 0; a < num; a++)
    for (PetscInt c = 0; c < dim; c++) middle[c] += x[a][c] / (PetscReal)num;
  for (PetscInt a = 0; a < num; a++) {
    PetscReal sum = 0;

    for (PetscInt c = 0; c < dim; c++) sum += PetscSqr(x[a][c] - middle[c]);
    square = PetscMax(square, sum);
  }
  return PetscSqrtReal(square);
}

void ContactRayBundle(const RayFacet *f, RayBundle *b)
{
  const PetscReal *x[RAY_LATTICE], *d[4];

  for (PetscInt a = 0; a < f->s.num; a++) x[a] = f->s.x[a];
  for (PetscInt a = 0; a < f->nv; a++) d[a] = f->d.x[a];
  b->radius = Ball_Private(f->s.num, x, 3, b->X);
  b->spread = Ball_Private(f->nv, d, 3, b->D);
}

PetscBool ContactRayBundleMeets(const RayBundle *b, const ContactSurface *mortar, PetscInt facet)
{
  PetscInt         order1[4];
  const PetscInt  *node, num              = ElementNumNodes(mortar->dim - 1, ContactFacetLattice(mortar, facet, &node, order1));
  const PetscReal *x[RAY_LATTICE], square = Dot3(b->D, b->D);
  PetscReal        r[3], radius, s, away = 0;

  for (PetscInt a = 0; a < num; a++) x[a] = mortar->x + mortar->dim * node[a];
  radius = 2 * Ball_Private(num, x, mortar->dim, r);
  for (int c = 0; c < 3; c++) r[c] -= b->X[c];
  s = Dot3(r, b->D) / square;
  for (int c = 0; c < 3; c++) away += PetscSqr(r[c] - s * b->D[c]);
  return (PetscBool)(PetscSqrtReal(away) <= b->radius + radius + (PetscAbsReal(s) + radius / PetscSqrtReal(square)) * b->spread);
}
