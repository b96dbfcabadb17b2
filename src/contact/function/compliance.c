/* Compliance of the constraints of a facet of higher order that is covered in part.

   Where the mortar side ends a little beyond a node, all that is covered of the next node's hat is a sliver. Its constraint then says nearly the same as those
   of the nodes before it, and with a pressure that grows like a power of 1 / w_j (10^3 and more where the others are 0.1) it bends the facet so that the sliver
   fits, so that equilibrium hangs on the width of the sliver. With a compliance K_j, which vanishes with the covered share
   s slower than w_j does, the force of a sliver fades with it; K_j vanishes at s = 1, too, where the facet takes its constant functions, which stand well
   apart. It depends on the covered area only, so that all derivatives are those of the area. Facets of order 1 take the value at the node of the straight line
   that fits the gap best, on which that node alone acts: no need. Nor in the plane: slivers are few there, and where two mortar bodies meet on one facet the
   constraints stay exact. */
#include "kernelimpl.h"

#define EPSILON 0.002 /* order 2: a sliver of a fifth of the facet is as stiff as the cells */

PetscErrorCode ContactPairSetSoftness(ContactPair pair, const PetscReal softness[])
{
  PetscFunctionBegin;
  pair->softness     = softness;
  pair->state.stands = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Length or area of a facet between its corners at the reference positions (axisymmetric: of revolution). */
static PetscReal Measure_Private(const ContactSurface *s, PetscInt facet, PetscBool axisymmetric)
{
  const PetscInt *node = s->facets + 2 * (s->dim - 1) * facet;
  PetscReal       N[3];

  ContactFacetVector(s->dim, s->X, node, N);
  return PetscSqrtReal(Dot3(N, N)) * (axisymmetric ? PETSC_PI * (s->X[2 * node[0]] + s->X[2 * node[1]]) : 1);
}

PetscErrorCode ContactRaySpring(ContactPair pair, const ContactSurface *nonmortar, PetscInt facet, RaySpring *spring)
{
  RayWork          w = pair->ray;
  const PetscInt   p = w->facet.s.order, num = w->facet.s.num, nr = w->result.num_rows;
  const PetscReal  whole = Measure_Private(nonmortar, facet, pair->axisymmetric), s = w->covered / whole, factor = 4 * EPSILON / p;
  const PetscReal *x;

  PetscFunctionBegin;
  spring->on = (PetscBool)(nonmortar->dim == 3 && pair->softness && w->test[0].hats && s < 1);
  if (!spring->on) PetscFunctionReturn(PETSC_SUCCESS);
  spring->share[0] = factor * s * (1 - s);
  spring->share[1] = factor * (1 - 2 * s) / whole;
  PetscCall(ElementGetNodes(p, &x));
  PetscCall(ContactGrow(nr, sizeof(PetscReal), &w->size_softness, &w->softness));
  spring->softness = w->softness;
  for (PetscInt r = 0; r < nr; r++) {
    spring->softness[r] = 0;
    for (PetscInt a = 0; a < num; a++) {
      PetscReal hat = whole;

      for (PetscInt i = 0, at = a; i < w->facet.m; i++, at /= p + 1) hat *= 0.5 * (x[PetscMin(at % (p + 1) + 1, p)] - x[PetscMax(at % (p + 1) - 1, 0)]);
      spring->softness[r] += w->T[r * num + a] * hat;
    }
    spring->softness[r] *= pair->softness[w->result.node[r]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
