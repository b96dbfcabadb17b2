/* Overlap that bodies start with, which no load brings about. As long as a share of it counts as none, one surface of the pair is taken to lie further in its
   body, by that share of the deepest overlap along constant directions: as if the body were as much smaller. Gaps and their derivatives are those of two
   surfaces in other places, so contact begins at the deepest place and spreads from there. Of the two sides the one is moved whose facets shrink the least by
   it: a tip, or the inside of a fold, would be turned inside out. */
#include "interfaceimpl.h"

/* Unit vectors into the body at the nodes, from the facets at the reference positions. */
static PetscErrorCode Inward_Private(const Surface *s, PetscReal inward[])
{
  const PetscInt dim = s->dim;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(inward, dim * s->num_nodes));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt *node, num = SurfaceNodes_Private(s, f, &node);
    PetscReal       N[3];
    ContactFacetVector(dim, s->X, s->facets + s->corners * f, N);
    for (PetscInt k = 0; k < num; ++k)
      for (PetscInt d = 0; d < dim; ++d) inward[dim * node[k] + d] -= N[d];
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal length = 0;
    for (PetscInt d = 0; d < dim; ++d) length += PetscSqr(inward[dim * n + d]);
    for (PetscInt d = 0; d < dim && length > 0; ++d) inward[dim * n + d] /= PetscSqrtReal(length);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Move_Private(const Surface *s, PetscReal way, const PetscReal inward[], PetscReal x[])
{
  for (PetscInt i = 0; i < s->dim * s->num_nodes; ++i) x[i] = s->X[i] + way * inward[i];
}

/* What moving all nodes in by this way leaves of the facet that shrinks most; below 0: it is turned over. */
static PetscReal Left_Private(const Surface *s, PetscReal way, const PetscReal inward[], PetscReal x[])
{
  PetscReal least = PETSC_MAX_REAL;

  Move_Private(s, way, inward, x);
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    PetscReal before[3] = {0, 0, 0}, after[3] = {0, 0, 0};
    ContactFacetVector(s->dim, s->X, s->facets + s->corners * f, before);
    ContactFacetVector(s->dim, x, s->facets + s->corners * f, after);
    least = PetscMin(least, Dot3(before, after) / Dot3(before, before));
  }
  return least;
}

/* The side that moves, its directions. */
static PetscErrorCode Choose_Private(Contact *c)
{
  PetscReal left[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) {
    const Surface *s = &c->side[k];
    if (!c->inward[k]) PetscCall(PetscMalloc2(s->dim * s->num_nodes, &c->inward[k], s->dim * s->num_nodes, &c->moved[k]));
    PetscCall(Inward_Private(s, c->inward[k]));
    left[k] = Left_Private(s, c->overlap, c->inward[k], c->moved[k]);
  }
  c->shrinks = left[0] > left[1] ? 0 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceNoteOverlap(Interface p, PetscReal *deepest)
{
  PetscFunctionBegin;
  *deepest = 0;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    c->overlap = 0;
    for (PetscInt k = 0; k < c->side[0].num_own && !c->tie; ++k) {
      const PetscInt j = c->side[0].own[k];
      if (c->has_multiplier[j] && ContactCovered_Private(c, j)) c->overlap = PetscMax(c->overlap, -c->gap[j] / c->weight[j]);
    }
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->overlap, 1, MPIU_REAL, MPI_MAX, p->comm));
    if (c->overlap > 0) PetscCall(Choose_Private(c));
    *deepest = PetscMax(*deepest, c->overlap);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceLeaveOverlap(Interface p, PetscReal share)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c   = &p->contacts[i];
    c->allowance = share * c->overlap;
    if (c->allowance > 0) Move_Private(&c->side[c->shrinks], c->allowance, c->inward[c->shrinks], c->moved[c->shrinks]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const PetscReal *ContactBase_Private(const Contact *c, PetscInt side)
{
  return c->allowance > 0 && side == c->shrinks ? c->moved[side] : c->side[side].X;
}
