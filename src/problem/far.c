/* Whether contact is close enough to its solution for the curvature of its constraints to mean anything.

   Pressure across an open gap is a row of struts under compression. They turn with the nodal normals, those with the facets, by du/h: their geometric stiffness
   is negative and grows like z g/h^2. At the solution g is small against h and Newton's method needs the term. Where the first linear step of a large load
   leaves gaps comparable to the facets, it outweighs the stiffness of the cells: rubber2d.yml on facets of 1/100 radius was cut. There the constraints are
   taken as linear. Overlaps are struts in tension and do no harm: a slide, which leaves gaps of both signs, keeps the term. */
#include "problemimpl.h"

#define FAR 0.1 /* mean open gap in lengths of facets */

/* Is the mean of gap / length of facet, weighted with the forces of the nodes at the last evaluation, above FAR? The same on every rank. */
PetscBool ContactIsFar_Private(const Contact *c)
{
  const Surface *s    = &c->side[0];
  PetscReal      open = 0, force = 0;

  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscReal measure = SurfaceMeasure_Private(s, s->x, e),
                    length  = (s->dim == 2 ? measure : PetscSqrtReal(measure)) / (PetscReal)PetscMax(1, SurfaceOrder_Private(s, e));
    const PetscInt *node, num = SurfaceNodes_Private(s, e, &node);
    for (PetscInt k = 0; k < num; ++k) {
      const PetscInt j = node[k];
      open += c->z[j] * c->gap[j];
      force += c->z[j] * c->weight[j] * length;
    }
  }
  return (PetscBool)(open > FAR * force);
}
