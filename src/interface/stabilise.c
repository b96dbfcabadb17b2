/* Stabilised multipliers of a stiff nonmortar side that has shorter facets than the mortar side; in the plane.

   Each node of the nonmortar side is a constraint, and something has to deform for it to be met. Where the nonmortar side is rigid, or much the stiffer one,
   that is the mortar side alone, and where its facets are longer there are more constraints than it has functions: the pair (displacements, multipliers) has
   no inf-sup constant, pressures are not unique, active sets go in circles, and the mortar side is too stiff. So gaps count as gt + S z (contact.h) on all
   facets, with

     kappa = STABILISED (1 - E_mortar / E_nonmortar)+ ((h_mortar / h)^3 - LONGER^3)+ ,

   h: length of the facet over its order, h_mortar: the least of those of the mortar side. On each facet S sees what of the pressure is not constant, h^2 times
   its slope squared. Sums over facets are int h_mortar^3 / E |grad z|^2 then: a pressure as long as mortar facets has a compliance like that of the cells
   behind, one twice as long an eighth of it, a constant one none. It is of order h_mortar^3, hardly depends on h, vanishes continuously as h grows, and is none
   where the mortar side has been refined. Theory (5.7b); such terms are known from stabilised elements of equal order.

   The least length, not that of the facets at hand: kappa is a number of the mesh, not of the positions, and does not jump where facets pass each other.

   Only in the plane: in space the force at the one node of a cube's corner leans by 3.5 degrees with it, for 1.8 (test_mortar_corner.py). */
#include "interfaceimpl.h"

#define STABILISED 0.02
#define LONGER 1.5 /* facets of the mortar side that are longer by less leave active sets as they are, and corners their one node without compliance */

static PetscReal Spacing_Private(const Surface *s, PetscInt f)
{
  const PetscReal measure = SurfaceFacetMeasure_Private(s, f, PETSC_FALSE);

  return measure / (PetscReal)(s->higher ? s->order[f] : 1);
}

static const MaterialSpec *Material_Private(const Interface p, const Surface *s, PetscInt f)
{
  return p->spec->bodies[p->tables->leaf_body[s->facet_leaf[f]]].material;
}

static PetscReal Kappa_Private(const Interface p, const Surface *s, PetscInt f, PetscReal spacing, PetscReal young)
{
  const MaterialSpec *m     = Material_Private(p, s, f);
  const PetscReal     ratio = spacing / Spacing_Private(s, f), stiff = m->law->rigid ? 1 : 1 - young / MaterialYoung(m);

  return ratio > LONGER && stiff > 0 ? STABILISED * stiff * (ratio * ratio * ratio - LONGER * LONGER * LONGER) : 0;
}

PetscErrorCode ContactStabilise_Private(Interface p, Contact *c)
{
  const Surface *own = &c->side[0], *other = &c->side[1];
  PetscReal      least[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}; /* spacing, Young's modulus of the mortar side */
  PetscInt       num      = 0;

  PetscFunctionBegin;
  if (p->dim == 3 || c->law->ties || !c->spec->stabilise || c->spec->node_to_segment) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt f = 0; f < other->num_facets; ++f) {
    const MaterialSpec *m = Material_Private(p, other, f);
    if (m->law->rigid) continue;
    least[0] = PetscMin(least[0], Spacing_Private(other, f));
    least[1] = PetscMin(least[1], MaterialYoung(m));
  }
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, 2, MPIU_REAL, MPI_MIN, p->comm));
  if (least[1] == PETSC_MAX_REAL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(own->num_facets, &c->stabilisation));
  for (PetscInt f = 0; f < own->num_facets; ++f) {
    c->stabilisation[f] = Kappa_Private(p, own, f, least[0], least[1]);
    num += c->mine[f] && c->stabilisation[f] > 0;
  }
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &num, 1, MPIU_INT, MPI_SUM, p->comm));
  c->view.stabilised = num;
  if (!num) PetscFunctionReturn(PETSC_SUCCESS);
  ContactPairSetStabilisation(c->pair, c->stabilisation);
  ContactPairSetSoftness(c->pair, c->softness); /* with small kinematics constraints of order 1 have none otherwise */
  PetscFunctionReturn(PETSC_SUCCESS);
}
