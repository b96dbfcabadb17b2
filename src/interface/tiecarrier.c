/* Which nodes of a tied pair carry which components of the traction: see tie.c. */
#include "interfaceimpl.h"

/* Does the facet have this node, or one that follows it? Facets that hanging nodes join have rows of each other's nodes. */
static PetscBool Has_Private(const Surface *s, PetscInt facet, PetscInt node)
{
  const PetscInt *own, num = SurfaceNodes_Private(s, facet, &own);

  for (PetscInt k = 0; k < num; ++k) {
    const PetscReal *weight;
    const PetscInt  *master, rows = SurfaceRow_Private(s, &own[k], &master, &weight);
    for (PetscInt i = 0; i < rows; ++i)
      if (master[i] == node) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Functions of a facet that is covered in part and of which too little is covered say what the others say, and their multipliers would be as large as that is
   little: keep[n] those nodes of which one facet shows enough, and of a facet without any the one that is seen best. */
static PetscErrorCode Seen_Private(Interface p, const Contact *c, PetscBool keep[])
{
  ContactSurface      side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};
  const ContactFacet *facets;
  PetscInt            num;
  PetscBool           failed;

  PetscFunctionBegin;
  PetscCall(ContactPairSetCarriers(c->pair, &side[0], NULL));
  PetscCall(ContactPairTie(c->pair, &side[0], &side[1], &num, &facets, &failed));
  PetscCall(PetscArrayzero(keep, c->side[0].num_nodes));
  for (PetscInt i = 0; i < num; ++i) {
    const ContactFacet *f = &facets[i];
    for (PetscInt r = 0; r < f->num_rows && c->mine[f->facet]; ++r)
      if (f->weight[r] * f->whole[r] > CONTACT_SLIVER * PetscSqr(f->whole[r]) && Has_Private(&c->side[0], f->facet, f->nodes[r]))
        keep[f->nodes[r]] = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, keep, (PetscMPIInt)c->side[0].num_nodes, COMPAT_MPI_BOOL, MPI_LOR, p->comm));
  for (PetscInt i = 0; i < num; ++i) {
    const ContactFacet *f    = &facets[i];
    PetscBool           any  = PETSC_FALSE;
    PetscInt            best = -1;
    for (PetscInt r = 0; r < f->num_rows; ++r) {
      any = (PetscBool)(any || keep[f->nodes[r]]);
      if (!Has_Private(&c->side[0], f->facet, f->nodes[r])) continue;
      if (best < 0 || f->weight[r] * f->whole[best] > f->weight[best] * f->whole[r]) best = r;
    }
    if (!any && best >= 0 && c->mine[f->facet]) keep[f->nodes[best]] = PETSC_TRUE;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, keep, (PetscMPIInt)c->side[0].num_nodes, COMPAT_MPI_BOOL, MPI_LOR, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TieCarriers_Private(Interface p, Contact *c, PetscBool carries[])
{
  const Surface *s = &c->side[0];
  PetscBool     *crosses, *seen;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s->num_nodes, &crosses, s->num_nodes, &seen));
  PetscCall(ContactCrossings_Private(p, c, PETSC_TRUE, crosses));
  PetscCall(Seen_Private(p, c, seen));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    c->has_multiplier[n] = PETSC_FALSE;
    for (PetscInt k = 0; k < p->dim; ++k) {
      PetscBool *to = &carries[s->num_nodes * k + n];
      *to           = (PetscBool)(s->hang[n] == s->hang[n + 1] && !crosses[n] && seen[n] && ContactIsFree_Private(p, c, n, k));
      if (*to) c->has_multiplier[n] = PETSC_TRUE;
    }
  }
  PetscCall(PetscFree2(crosses, seen));
  PetscFunctionReturn(PETSC_SUCCESS);
}
