/* Whether contact is close enough to its solution for the turning of its directions to mean anything.

   A gap is measured along a direction that turns with the nonmortar surface: by du/h. Across a gap g that moves the end of the ray by g du/h. At the solution g
   is small against h and Newton's method needs this. Where gaps are wide against the facets, as at the first touch of a large load, it outweighs the motion
   itself: a linear step then closes gaps by folding the surface facet by facet, and it does so with pressures that alternate. What pressure there is acts
   like a row of struts under compression that turn likewise: a negative stiffness that grows as z g/h^2. There directions are frozen in the linearisation,
   rows, forces and curvature alike, of the whole pair: where facets that are held meet others the surface folds, too. Overlaps are struts in tension and do no
   harm: a slide, which leaves gaps of both signs, is no such case. Before there is any pressure nothing tells how wide the gaps are that matter; where they are
   narrow, frozen directions change little. */
#include "interfaceimpl.h"

#define WIDE 0.1 /* mean open gap in lengths of facets */

static PetscErrorCode IsWide_Private(Interface p, const Contact *c, PetscBool *wide)
{
  const Surface *s      = &c->side[0];
  PetscReal      sum[3] = {0, 0, 0}; /* open gaps, forces, forces of a pressure as large as Young's modulus */

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_mine; ++i) {
    const PetscInt  e       = s->mine[i];
    const PetscReal measure = SurfaceMeasure_Private(s, s->x, e);
    const PetscReal length  = (s->dim == 2 ? measure : PetscSqrtReal(measure)) / (PetscReal)s->order[e];
    const PetscInt *node, num = SurfaceNodes_Private(s, e, &node);
    for (PetscInt k = 0; k < num; ++k) {
      const PetscInt j = node[k];
      sum[0] += c->z[j] * c->gap[j];
      sum[1] += c->z[j] * c->weight[j] * length;
      sum[2] += c->c[j] * c->extent[j] * c->weight[j] * length;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, p->comm));
  *wide = (PetscBool)(sum[1] <= SLACK * sum[2] || sum[0] > WIDE * sum[1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceFindWide(Interface p, uint64_t *pairs)
{
  PetscBool wide;

  PetscFunctionBegin;
  *pairs = 0;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    if (p->contacts[i].tie) continue;
    PetscCall(IsWide_Private(p, &p->contacts[i], &wide));
    if (wide) *pairs |= FormPair(i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
