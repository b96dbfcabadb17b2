/* Whether contact is close enough to its solution for the curvature of its constraints to mean anything.

   Pressure across an open gap is a row of struts under compression. They turn with the nodal normals, those with the facets, by du/h: their geometric stiffness
   is negative and grows like z g/h^2. At the solution g is small against h and Newton's method needs the term. Where the first linear step of a large load
   leaves gaps comparable to the facets, it outweighs the stiffness of the cells: rubber2d.yml on facets of 1/100 radius was cut. There the constraints are
   taken as linear. Overlaps are struts in tension and do no harm: a slide, which leaves gaps of both signs, keeps the term. */
#include "problemimpl.h"

#define FAR 0.1 /* mean open gap in lengths of facets */

/* Length of an edge, square root of the area of a face, current. */
static PetscReal Length_Private(const Surface *s, PetscInt f)
{
  const PetscInt  *node = s->facets + s->corners * f;
  const PetscReal *a = s->x + s->dim * node[0], *b = s->x + s->dim * node[1];
  PetscReal        d[3], e[3], square = 0;

  if (s->dim == 2) return PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
  for (PetscInt c = 0; c < 3; ++c) {
    d[c] = s->x[3 * node[2] + c] - a[c];
    e[c] = s->x[3 * node[3] + c] - b[c];
  }
  for (PetscInt c = 0; c < 3; ++c) square += PetscSqr(d[c] * e[(c + 1) % 3] - d[(c + 1) % 3] * e[c]);
  return PetscSqrtReal(0.5 * PetscSqrtReal(square));
}

/* Is the mean of gap / length of facet, weighted with the forces of the nodes at the last evaluation, above FAR? The same on every rank. */
PetscBool ContactIsFar_Private(const Contact *c)
{
  const Surface *s    = &c->side[0];
  PetscReal      open = 0, force = 0;

  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscReal length = Length_Private(s, e);
    for (PetscInt k = 0; k < s->corners; ++k) {
      const PetscInt j = s->facets[s->corners * e + k];
      open += c->z[j] * c->gap[j];
      force += c->z[j] * c->weight[j] * length;
    }
  }
  return (PetscBool)(open > FAR * force);
}
