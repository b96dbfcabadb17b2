/* What the rows of friction do not see. They know means of the slip s over the multiplier's functions, and the cone |q| <= mu z at nodes.

   Between nodes the traction q on the mortar side misses the law by rho = q - P(q - k s), P the projection on the disc of radius mu z, k the stiffness of a
   wave of slip that the functions are too coarse for: that of a gap (gapterm.c), for a half plane answers both alike. So rho = k s where surfaces stick, no
   more than what q has left until they slip, and at least |q| - mu z outside the cone; 0 where they slip against q with |q| = mu z. eta^2 = int |rho|^2 / k, of
   the slip of the last step. */
#include "estimateimpl.h"

/* |rho|^2 */
static PetscReal Square_Private(PetscReal bound, PetscReal k, const PetscReal q[3], const PetscReal slip[3])
{
  PetscReal tau[3], square = 0;

  for (PetscInt c = 0; c < 3; ++c) tau[c] = q[c] - k * slip[c];
  const PetscReal length = PetscSqrtReal(Dot3(tau, tau)), share = length > bound ? bound / length : 1;
  for (PetscInt c = 0; c < 3; ++c) square += PetscSqr(q[c] - share * tau[c]);
  return square;
}

/* The coarser side is to be refined, the softer one gives way. */
static void Point_Private(EstimateSum *sum, const ContactTerm *term, const ContactSlipPoint *p)
{
  const SurfaceView *s = &term->view->nonmortar, *m = &term->view->mortar;
  const PetscInt     leaf = s->facet_leaf[p->facet], other = m->facet_leaf[p->mortar_facet];
  PetscReal          both, soft, square[2];
  const PetscReal    size[2] = {ContactFacetSize_Private(s, p->facet), ContactFacetSize_Private(m, p->mortar_facet)};
  PetscReal          n[3], q[3];

  const PetscReal z = ContactPressing_Private(term, (PetscBool)(sum->spec->kinematics == KINEMATICS_FINITE), p->facet, p->xi, n, q);
  for (int flowed = 1; flowed >= 0; --flowed) {
    soft = EstimateCompliance_Private(sum, other, (PetscBool)flowed);
    both = EstimateCompliance_Private(sum, leaf, (PetscBool)flowed) + soft;
    if (both == 0) return;
    const PetscReal k = PETSC_PI / (size[0] * both);
    square[flowed]    = p->weight * Square_Private(term->view->friction * PetscMax(z, 0), k, q, p->slip) / k;
  }
  const PetscReal share = PetscSqr(size[1]) / (PetscSqr(size[0]) + PetscSqr(size[1])) * soft / both;
  sum->eta2[leaf] += (1 - share) * square[0];
  sum->eta2[other] += share * square[0];
  sum->part[PART_CONTACT] += square[1];
}

PetscErrorCode EstimateSlip_Private(EstimateSum *sum)
{
  PetscMPIInt  rank;
  const Forest forest = HPSpaceGetForest(sum->space);

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  for (PetscInt i = 0; i < sum->contact->num; ++i) {
    const ContactTerm *term = &sum->contact->terms[i];
    ContactSlipPoint  *points;
    PetscInt           num;
    PetscCall(InterfaceGetSlipPoints(sum->contact->interface, i, &num, &points));
    for (PetscInt k = 0; k < num; ++k) {
      if (sum->t->leaf_rank[term->view->nonmortar.facet_leaf[points[k].facet]] == rank) Point_Private(sum, term, &points[k]);
    }
    PetscCall(PetscFree(points));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
