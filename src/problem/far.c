/* Whether contact is close enough to its solution for the curvature of its constraints to mean anything.

   Pressure across an open gap is a row of struts under compression. They turn with the nodal normals, those with the facets, by du/h: their geometric stiffness
   is negative and grows like z g/h^2. At the solution g is small against h and Newton's method needs the term. Where the first linear step of a large load
   leaves gaps comparable to the facets, it outweighs the stiffness of the cells: rubber2d.yml on facets of 1/100 radius was cut. There the constraints are
   taken as linear. Overlaps are struts in tension and do no harm: a slide, which leaves gaps of both signs, keeps the term. */
#include "problemimpl.h"

#define FAR 0.1 /* mean open gap in lengths of facets */

/* Is the mean of gap / length of facet, weighted with the forces of the nodes at the last evaluation, above FAR? The same on every rank. */
PetscErrorCode ContactIsFar_Private(Problem p, const Contact *c, PetscBool *far)
{
  const Surface *s      = &c->side[0];
  PetscReal      sum[2] = {0, 0}; /* open gaps, forces */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_mine; ++i) {
    const PetscInt  e       = s->mine[i];
    const PetscReal measure = SurfaceMeasure_Private(s, s->x, e),
                    length  = (s->dim == 2 ? measure : PetscSqrtReal(measure)) / (PetscReal)PetscMax(1, SurfaceOrder_Private(s, e));
    const PetscInt *node, num = SurfaceNodes_Private(s, e, &node);
    for (PetscInt k = 0; k < num; ++k) {
      const PetscInt j = node[k];
      sum[0] += c->z[j] * c->gap[j];
      sum[1] += c->z[j] * c->weight[j] * length;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, p->comm));
  *far = (PetscBool)(sum[0] > FAR * sum[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
