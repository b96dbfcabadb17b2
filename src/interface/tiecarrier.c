/* Which nodes of a tied pair carry which components of the traction, and to whom the functions of the others go (tie.c).

   A node that supports hold along h has no function for what acts along h: that goes to the nodes of its facets which are free along h. Those that a support
   holds obliquely to h keep their own function and take no share: what acts there along their own held direction comes from others as well. Nodes that carry
   nothing give theirs before, the same for every direction: only so a constant traction is one. So each direction
   has functions of its own on facets with nodes that are held along it. Supports are flat: there are few. Nothing here knows the axes of the coordinates. */
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
  PetscCall(ContactPairSetCarriers(c->pair, &side[0], NULL, NULL));
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

/* Functions as those where nothing is held. */
static PetscErrorCode New_Private(Contact *c, TieFunctions **functions)
{
  const PetscInt n = c->side[0].num_nodes;
  Tie           *t = c->tie;
  TieFunctions  *f;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(t->num_functions + 1, sizeof(TieFunctions), &t->room, &t->functions));
  f = *functions = &t->functions[t->num_functions++];
  *f             = (TieFunctions){0};
  PetscCall(PetscCalloc3(n, &f->carries, n, &f->late, c->side[0].num_facets, &f->here));
  PetscCall(PetscArraycpy(f->carries, t->functions[0].carries, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsParallel_Private(const PetscReal a[3], const PetscReal b[3])
{
  return (PetscBool)(1 - PetscSqr(Dot3(a, b)) <= PetscSqr(ROUND_LENGTH));
}

/* Is h an axis along which supports hold the node? 1; at an angle to one 0, else -1. (A corner of two supports that are not at right angles has axes of its
   own, and directions for them: counted for both supports as well, what acts across the corner would count twice.) */
static int Hold_Private(const Surface *s, PetscInt n, const PetscReal h[3])
{
  int hold = -1;

  for (PetscInt d = 0; d < s->dim; ++d) {
    PetscReal axis[3];
    TieAxis_Private(s, n, d, axis);
    if (!TieHolds_Private(s, n, d)) continue;
    if (IsParallel_Private(axis, h)) return 1;
    if (PetscAbsReal(Dot3(axis, h)) > ROUND_LENGTH) hold = 0;
  }
  return hold;
}

/* Functions for the direction h. */
static PetscErrorCode Along_Private(Contact *c, const PetscReal h[3])
{
  const Surface *s = &c->side[0];
  TieFunctions  *f;

  PetscFunctionBegin;
  PetscCall(New_Private(c, &f));
  PetscCall(PetscArraycpy(f->along, h, 3));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (!c->tie->functions[0].carries[n]) continue;
    const int hold = Hold_Private(s, n, h);
    f->carries[n]  = (PetscBool)(hold < 1);
    f->late[n]     = (PetscBool)(hold >= 0);
    for (PetscInt i = s->node_first[n]; i < s->node_first[n + 1] && hold == 1; ++i) f->here[s->node_facet[i]] = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All directions in which nodes are held. */
static PetscErrorCode Directions_Private(Contact *c)
{
  const Surface *s = &c->side[0];
  PetscReal      h[3];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->dim * s->num_nodes; ++i) {
    PetscBool known = PETSC_FALSE;
    if (!c->tie->functions[0].carries[i / s->dim] || !TieHolds_Private(s, i / s->dim, i % s->dim)) continue;
    TieAxis_Private(s, i / s->dim, i % s->dim, h);
    for (PetscInt k = 1; k < c->tie->num_functions && !known; ++k) known = IsParallel_Private(c->tie->functions[k].along, h);
    if (!known) PetscCall(Along_Private(c, h));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TieCarriers_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];
  PetscBool     *crosses, *seen;
  TieFunctions  *all;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s->num_nodes, &crosses, s->num_nodes, &seen));
  PetscCall(ContactCrossings_Private(p, c, PETSC_TRUE, crosses));
  PetscCall(Seen_Private(p, c, seen));
  PetscCall(New_Private(c, &all));
  for (PetscInt n = 0; n < s->num_nodes; ++n)
    all->carries[n] = c->has_multiplier[n] = (PetscBool)(s->hang[n] == s->hang[n + 1] && !crosses[n] && seen[n] && ContactIsFree_Private(p, c, n));
  PetscCall(PetscFree2(crosses, seen));
  PetscCall(Directions_Private(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
