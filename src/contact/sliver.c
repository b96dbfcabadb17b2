/* Compliance of the constraints of a facet of order 1 in space that little of it holds.

   Where the mortar side ends a little beyond a line of the nonmortar mesh, the dual constraint of a far node of the next facet says that the node is on the
   straight continuation of what the sliver sees: the force that does this is that of the cells, but it acts on the sliver alone, as a pressure of its size
   over w_j (10^3 E), and it is there at once when the sliver is: equilibrium hangs on whether there is one, and Newton's method finds none. With a compliance

     K_j = sum over facets of softness_j epsilon W_j q(w_j / (r W_j)),   q(x) = sqrt(x) (1 - x)^2 up to x = 1, then 0,

   (w_j and W_j here: the facet's parts of the weight and of the reference measure of the hat) the force fades with w_j over a good part of the facet; a
   narrower part would be a rim that is driven out of it. Nothing changes for a node that a facet carries by more than r of what it might. A strip of width s is
   x = s^2 / r of its far nodes, and 2 s / r of the near ones: these have other facets, next to whose weights K is nothing. K depends on w_j alone, and
   -1/2 sum_j K_j z_j^2 is part of the Lagrangian, so that the tangent stays symmetric. */
#include "facetimpl.h"

#define EPSILON 0.015 /* far nodes of a strip of three tenths of a facet are held as stiffly as the cells hold them */
#define LEAST 0.25    /* r: strips of half a facet */

/* The reference measure of the hats of the result's rows. */
static void Measures_Private(const Result *r, const ContactSurface *s, PetscInt facet, PetscReal W[])
{
  PetscReal N[3], share;

  ContactFacetVector(3, s->X, s->facets + 4 * facet, N);
  share = 0.25 * PetscSqrtReal(Dot3(N, N));
  for (PetscInt k = 0; k < r->num_rows; k++) W[k] = 0;
  for (PetscInt k = r->row_first[0]; k < r->row_first[4]; k++) W[r->row_node[k]] += r->row_weight[k] * share;
}

PetscErrorCode ContactSliver(ContactPair pair, const ContactSurface *nonmortar, PetscInt facet, Result *r, const PetscReal weight[], const PetscReal **spring)
{
  const PetscInt nr  = r->num_rows;
  PetscBool      any = PETSC_FALSE;
  PetscReal     *W, *K;

  PetscFunctionBegin;
  *spring = NULL;
  if (!pair->softness) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactStoreReserve(&r->store, 4 * nr, &K));
  W = K + 3 * nr;
  Measures_Private(r, nonmortar, facet, W);
  for (PetscInt k = 0; k < nr; k++) {
    const PetscReal x = weight[k] / (LEAST * W[k]), root = PetscSqrtReal(PetscMax(x, 0)), soft = pair->softness[r->node[k]];

    if (!(x > 0 && x < 1)) continue;
    any           = PETSC_TRUE;
    K[k]          = soft * EPSILON * W[k] * root * (1 - x) * (1 - x);
    K[nr + k]     = soft * EPSILON / LEAST * (1 - x) * (0.5 * (1 - x) / root - 2 * root);
    K[2 * nr + k] = soft * EPSILON / (LEAST * LEAST * W[k]) * (2 * root - 2 * (1 - x) / root - 0.25 * (1 - x) * (1 - x) / (x * root));
  }
  r->store.used -= any ? nr : 4 * nr;
  if (any) *spring = K;
  PetscFunctionReturn(PETSC_SUCCESS);
}
