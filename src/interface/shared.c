/* Nodes of a pair's nonmortar side that other pairs, other parts of the pair, or supports constrain, too.

   Where two blocks that are glued to each other, or held by friction, meet a wall, the gap of both corners to the wall and the motion of one corner along the
   other are three constraints of two motions. They do not contradict each other, but tractions are not unique: what is found is any of them, and nodes that
   press are told to be open. So there tractions have a compliance that does not see those which are constant on a facet (include/contact.h). So they have at
   the corner of a block that sticks to both walls of a groove, which are faces of one pair, and where a support leaves a node one direction, oblique to the
   surface, in which its gap and its slip are the same. */
#include "interfaceimpl.h"

/* A number that tells the nodes of a mesh apart. */
static PetscInt Name_Private(const Surface *s, PetscInt n)
{
  return s->node_entity[n] * (SURFACE_MOST_NODES + 1) + s->node_index[n] + 1;
}

PetscErrorCode ContactCrossings_Private(Interface p, const Contact *c, PetscBool ties, PetscBool crosses[])
{
  const Surface *s = &c->side[0];
  PetscInt      *own, *taken, num = s->num_facets, size = 0, at;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 2 * p->num_contacts; ++i) size += p->contacts[i / 2].side[i % 2].num_facets * SURFACE_MOST_NODES;
  PetscCall(PetscMalloc2(num, &own, size, &taken));
  PetscCall(PetscArraycpy(own, s->facet_entity, num));
  PetscCall(PetscSortInt(num, own));
  size = 0;
  for (PetscInt i = 0; i < 2 * p->num_contacts; ++i) {
    const Contact  *other  = &p->contacts[i / 2];
    const Surface  *o      = &other->side[i % 2];
    const PetscBool counts = (PetscBool)(ties ? other->law->ties && other != c : !other->law->ties && i % 2 == 0);
    for (PetscInt f = 0; f < o->num_facets && counts; ++f) {
      const PetscInt *node, nodes = SurfaceNodes_Private(o, f, &node);
      PetscCall(PetscFindInt(o->facet_entity[f], num, own, &at));
      for (PetscInt k = 0; k < nodes && at < 0; ++k) taken[size++] = Name_Private(o, node[k]);
    }
  }
  PetscCall(PetscSortRemoveDupsInt(&size, taken));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscCall(PetscFindInt(Name_Private(s, n), size, taken, &at));
    crosses[n] = (PetscBool)(at >= 0);
  }
  PetscCall(PetscFree2(own, taken));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is the pair made several times, for the faces of its mortar side? */
static PetscBool IsParted_Private(const Interface p, const Contact *c)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i)
    if (&p->contacts[i] != c && p->contacts[i].spec->pair == c->spec->pair) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode ContactShared_Private(Interface p, Contact *c)
{
  const PetscBool parted = IsParted_Private(p, c);
  PetscBool       any    = parted;

  PetscFunctionBegin;
  if (!c->law->ties && !c->law->slips) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(c->side[0].num_nodes, &c->shared));
  PetscCall(ContactCrossings_Private(p, c, PETSC_FALSE, c->shared));
  for (PetscInt n = 0; n < c->side[0].num_nodes; ++n) {
    if (c->law->slips && ContactHeldObliquely_Private(&c->side[0], n)) c->shared[n] = PETSC_TRUE;
    any = (PetscBool)(any || c->shared[n]);
  }
  if (!any) PetscCall(PetscFree(c->shared)); /* no facet has to look */
  ContactPairSetShared(c->pair, c->shared, parted);
  if (c->shared) ContactPairSetSoftness(c->pair, c->softness); /* with small kinematics constraints of order 1 have none otherwise */
  PetscFunctionReturn(PETSC_SUCCESS);
}
