/* Where mortar facets lie behind one another in a facet's view (folds, thin bodies, layers), the nearest counts: overlaps are taken by growing distance, and
   one is dropped of which those already taken hide more than a millionth of the facet and a tenth of its own area. What is hidden of one that stays counts
   twice. (Neighbours on curved surfaces may share slivers where nodes hang.) How much all of them cover does not tell: where what is nearest ends within the
   facet, as one ring of a stack seen from the shoulder of the next, what lies behind it may be hidden although the sum is less than the facet. */
#include "kernelimpl.h"

enum { MOST = 2 * FACET_VERTICES };

/* Of the mortar facet at the middle of the overlap. */
static PetscReal Distance_Private(const Overlap *o)
{
  const PlaneQuad *q    = &o->side[1];
  PetscReal        Y[2] = {0, 0}, xi[2] = {0, 0}, c[4][2];

  for (PetscInt k = 0; k < o->num; k++)
    for (int i = 0; i < 2; i++) Y[i] += o->v[k][i] / (PetscReal)o->num;
  ContactBilinear(q->Y, c);
  if (!ContactBilinearLocate(c, Y, xi)) return PETSC_MAX_REAL;
  return PetscAbsReal(0.25 * ((1 - xi[1]) * ((1 - xi[0]) * q->h[0] + (1 + xi[0]) * q->h[1]) + (1 + xi[1]) * ((1 + xi[0]) * q->h[2] + (1 - xi[0]) * q->h[3])));
}

/* Area that two convex polygons share. */
static PetscReal Shared_Private(const Overlap *a, const Overlap *b)
{
  PetscReal v[MOST][2], to[MOST][2], sum = 0;
  PetscInt  num = a->num;

  for (PetscInt k = 0; k < num; k++) v[k][0] = a->v[k][0], v[k][1] = a->v[k][1];
  for (PetscInt i = 0; i < b->num && num; i++) {
    const PetscReal *p = b->v[i], *q = b->v[(i + 1) % b->num], e[2] = {q[0] - p[0], q[1] - p[1]};
    PetscInt         kept = 0;

    for (PetscInt k = 0; k < num && kept + 2 <= MOST; k++) {
      const PetscReal *x = v[k], *y = v[(k + 1) % num], dx[2] = {x[0] - p[0], x[1] - p[1]}, dy[2] = {y[0] - p[0], y[1] - p[1]};
      const PetscReal  s = Cross2(e, dx), t = Cross2(e, dy);

      if (s > 0) to[kept][0] = x[0], to[kept++][1] = x[1];
      if ((s > 0) != (t > 0)) {
        for (int c = 0; c < 2; c++) to[kept][c] = x[c] + s / (s - t) * (y[c] - x[c]);
        kept++;
      }
    }
    num = kept;
    memcpy(v, to, sizeof(v));
  }
  for (PetscInt k = 1; k + 1 < num; k++) {
    const PetscReal d[2] = {v[k][0] - v[0][0], v[k][1] - v[0][1]}, e[2] = {v[k + 1][0] - v[0][0], v[k + 1][1] - v[0][1]};

    sum += 0.5 * Cross2(d, e);
  }
  return sum;
}

/* The nearest of those that are not judged yet; -1: all are. */
static PetscInt Nearest_Private(PetscInt num, const Overlap overlap[])
{
  PetscInt nearest = -1;

  for (PetscInt i = 0; i < num; i++)
    if (overlap[i].seen < 0 && (nearest < 0 || overlap[i].distance < overlap[nearest].distance)) nearest = i;
  return nearest;
}

void ContactUnfold(PetscInt *num, Overlap overlap[], PetscInt mortar[], PetscReal area)
{
  PetscInt kept = 0;

  if (*num < 2) return;
  for (PetscInt i = 0; i < *num; i++) {
    overlap[i].seen     = -1;
    overlap[i].distance = Distance_Private(&overlap[i]);
  }
  for (PetscInt i = Nearest_Private(*num, overlap); i >= 0; i = Nearest_Private(*num, overlap)) {
    PetscReal hidden = 0;

    for (PetscInt k = 0; k < *num; k++)
      if (overlap[k].seen > 0) hidden += Shared_Private(&overlap[k], &overlap[i]);
    overlap[i].seen = hidden > PetscMax(ROUND_LENGTH * area, CONTACT_SLIVER * overlap[i].area) ? 0 : 1;
  }
  for (PetscInt i = 0; i < *num; i++)
    if (overlap[i].seen) overlap[kept] = overlap[i], mortar[kept++] = mortar[i];
  *num = kept;
}
