/* Which candidates a facet can see at the positions of an evaluation. A search keeps what may come into view while nodes move by its margin, which is most of
   the other side where facets are fine. Images are found only for mortar facets near the rays.

   All rays lie in a cone around the mean one: |x - X - s D| <= radius + |s| spread at length s. A mortar facet is seen when the ball around its nodes, twice as
   large since its picture in the chart has straight sides where its own are curved, meets the cone. */
#include "kernelimpl.h"

/* Mean of points, and the greatest distance of one from it. */
static void Grow_Private(PetscInt num, const PetscReal x[][4], RayBall *b)
{
  PetscReal square = 0;

  memset(b, 0, sizeof(*b));
  for (PetscInt a = 0; a < num; a++)
    for (int c = 0; c < 3; c++) b->x[c] += x[a][c] / (PetscReal)num;
  for (PetscInt a = 0; a < num; a++) {
    const PetscReal r[3] = {x[a][0] - b->x[0], x[a][1] - b->x[1], x[a][2] - b->x[2]};

    square = PetscMax(square, Dot3(r, r));
  }
  b->radius = PetscSqrtReal(square);
}

PetscErrorCode ContactRayBalls(RayWork w, const ContactSurface *mortar)
{
  RayLattice facet;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(mortar->num_facets, sizeof(RayBall), &w->size_ball, &w->ball));
  for (PetscInt f = 0; f < mortar->num_facets; f++) {
    ContactRayLatticeGather(mortar, f, &facet);
    Grow_Private(facet.num, facet.x, &w->ball[f]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactRayBundle(const RayFacet *f, RayBundle *b)
{
  Grow_Private(f->s.num, f->s.x, &b->from);
  Grow_Private(f->nv, f->d.x, &b->along);
  b->over = 1 / Dot3(b->along.x, b->along.x);
}

PetscBool ContactRayBundleMeets(const RayBundle *b, const RayBall *ball)
{
  const PetscReal *d = b->along.x, r[3] = {ball->x[0] - b->from.x[0], ball->x[1] - b->from.x[1], ball->x[2] - b->from.x[2]};
  const PetscReal  dot = Dot3(r, d), s = PetscAbsReal(dot) * b->over + 2 * ball->radius * PetscSqrtReal(b->over); /* farthest along the rays */

  return (PetscBool)(Dot3(r, r) - dot * dot * b->over <= PetscSqr(b->from.radius + 2 * ball->radius + s * b->along.radius));
}
