/* All contact pairs of one mesh: their life, places of their multipliers, search and evaluation. */
#include "interfaceimpl.h"

PetscErrorCode InterfaceCreate(HPSpace space, Mechanics mechanics, const MechanicsSpec *spec, const int8_t fixed[], PetscInt num, const ContactSpec contacts[],
                               Interface *interface)
{
  Interface p;

  PetscFunctionBegin;
  PetscCheckInput(num <= FORM_PAIRS, "%" PetscInt_FMT " contact pairs; at most %d are possible", num, FORM_PAIRS);
  PetscCall(PetscNew(&p));
  p->space        = space;
  p->mechanics    = mechanics;
  p->spec         = spec;
  p->fixed        = fixed;
  p->num_contacts = num;
  p->forest       = HPSpaceGetForest(space);
  p->tables       = ForestGetTables(p->forest);
  p->dim          = p->tables->dim;
  p->comm         = ForestComm(p->forest);
  PetscCallMPI(MPI_Comm_rank(p->comm, &p->rank));
  PetscCallMPI(MPI_Comm_size(p->comm, &p->size));
  for (PetscMPIInt k = 1; k <= MOST_REALS; ++k) {
    PetscCallMPI(MPI_Type_contiguous(k, MPIU_REAL, &p->unit[k]));
    PetscCallMPI(MPI_Type_commit(&p->unit[k]));
  }
  PetscCall(PetscCalloc1(num, &p->contacts));
  if (num) PetscCall(HullCreate_Private(p));
  for (PetscInt i = 0; i < num; ++i) PetscCall(ContactCreate_Private(p, &contacts[i], &p->contacts[i]));
  for (PetscInt i = 0; i < num; ++i) PetscCall(ContactShared_Private(p, &p->contacts[i]));
  for (PetscInt i = 0; i < num; ++i) PetscCall(TieCreate_Private(p, &p->contacts[i]));
  PetscCall(InterfaceSetTime(p, 0));
  *interface = p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceDestroy(Interface *interface)
{
  Interface p = *interface;

  PetscFunctionBegin;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscMPIInt k = 1; k <= MOST_REALS; ++k) PetscCallMPI(MPI_Type_free(&p->unit[k]));
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(ContactDestroy_Private(&p->contacts[i]));
  PetscCall(PetscFree(p->contacts));
  PetscCall(ContactHullDestroy(&p->hull));
  PetscCall(RowBufferDestroy(&p->work));
  PetscCall(PetscFree(p->hessian));
  PetscCall(PetscFree(p->part));
  PetscCall(PetscFree(*interface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceSetForm(Interface p, const Form *form)
{
  p->form = form;
  for (PetscInt i = 0; i < p->num_contacts; ++i) ContactPairFreezeSegmentation(p->contacts[i].pair, form->frozen_segmentation);
}

PetscBool InterfaceIsSymmetric(Interface p)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    if (!p->contacts[i].law->symmetric) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Multipliers live with the owner of their node. */
PetscErrorCode InterfaceNumber(Interface p, PetscInt counts[])
{
  const ForestTables *t = p->tables;

  PetscFunctionBegin;
  p->first_z = counts[p->rank];
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt n = 0; n < c->side[0].num_nodes; ++n) {
      const PetscMPIInt owner = t->leaf_rank[t->entity_leaf[c->side[0].node_entity[n]]];
      c->zdof[n] = c->zlocal[n] = -1;
      if (!c->has_multiplier[n]) continue;
      c->zdof[n] = counts[owner];
      counts[owner] += c->num;
      if (owner == p->rank) c->zlocal[n] = c->zdof[n];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceSetRows(Interface p, PetscInt counts[], const PetscInt offset[], const PetscInt row[], PetscInt num_inner)
{
  const ForestTables *t = p->tables;

  PetscFunctionBegin;
  p->num_inner = num_inner;
  PetscCall(InterfaceNumber(p, counts));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt n = 0; n < c->side[0].num_nodes; ++n) {
      if (c->zdof[n] >= 0) c->zdof[n] += offset[t->leaf_rank[t->entity_leaf[c->side[0].node_entity[n]]]];
    }
    for (PetscInt k = 0; k < 2; ++k) PetscCall(SurfaceIndices_Private(p, row, &c->side[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

const ContactView *InterfaceGetContact(Interface p, PetscInt pair)
{
  return &p->contacts[pair].view;
}

void InterfaceCost(Interface p, PetscInt pair, PetscReal *seconds, PetscReal *all, PetscBool *room)
{
  *all = 0;
  for (PetscInt i = 0; i < p->num_contacts; ++i) *all += p->contacts[i].seconds;
  *seconds = p->contacts[pair].seconds;
  *room    = (PetscBool)(p->contacts[pair].pattern_offset != NULL);
}

/* Add the time since `begin` to that of a pair. */
static PetscErrorCode Took_Private(Contact *c, PetscLogDouble begin)
{
  PetscLogDouble end;

  PetscFunctionBegin;
  PetscCall(PetscTime(&end));
  c->seconds += (PetscReal)(end - begin);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceSetMultipliers(Interface p, PetscInt pair, const PetscReal z[], Vec x)
{
  const Contact *c = &p->contacts[pair];
  PetscReal     *array;

  PetscFunctionBegin;
  PetscCall(VecGetArray(x, &array));
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    for (PetscInt k = 0; k < c->num && c->zlocal[j] >= 0; ++k) array[c->zlocal[j] + k] = z[c->side[0].num_nodes * k + j];
  }
  PetscCall(VecRestoreArray(x, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceGetMultipliers(Interface p, PetscInt pair, Vec x, PetscReal z[], PetscBool own[])
{
  const Contact   *c = &p->contacts[pair];
  const PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(x, &array));
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    for (PetscInt k = 0; k < c->num && c->zlocal[j] >= 0; ++k) z[c->side[0].num_nodes * k + j] = array[c->zlocal[j] + k];
    if (own) own[j] = (PetscBool)(c->zlocal[j] >= 0);
  }
  PetscCall(VecRestoreArrayRead(x, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceSearch(Interface p, Vec x, const PetscReal u[], PetscBool goes_on)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact       *c = &p->contacts[i];
    PetscLogDouble begin;
    PetscCall(PetscTime(&begin));
    PetscCall(SlipKeep_Private(p, c));
    if (p->spec->kinematics == KINEMATICS_SMALL || c->tie) continue;
    for (PetscInt k = 0; k < 2; ++k) {
      SurfaceForget_Private(&c->side[k]);
      SurfacePlace_Private(&c->side[k], u, ContactBase_Private(c, k), c->side[k].x);
    }
    ContactPairGoOn(c->pair, goes_on);
    PetscCall(ContactSearch_Private(p, c, PETSC_FALSE, NEAR * c->distance));
    ContactPairGoOn(c->pair, PETSC_FALSE);
    const PetscBool last = (PetscBool)(i + 1 == p->num_contacts || !p->contacts[i + 1].spec->part); /* of the pair's parts */
    if (c->spec->self && last) PetscCall(ContactRoles_Private(p, c->spec->part + 1, c - c->spec->part, x, u));
    PetscCall(Took_Private(c, begin));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceKeepSearch(Interface p)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) ContactPairKeepSearch(p->contacts[i].pair);
}

PetscErrorCode InterfaceEvaluate(Interface p, Vec x, const PetscReal u[], PetscReal pending, PetscBool hessian, PetscBool *failed)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact       *c = &p->contacts[i];
    PetscLogDouble begin;
    PetscCall(PetscTime(&begin));
    ContactPairFreezeNormals(c->pair, (PetscBool)(hessian && FormHas(p->form->frozen_normals, i)));
    PetscCall(ContactEvaluate_Private(p, c, x, u, pending, PETSC_TRUE, hessian, failed));
    ContactPairFreezeNormals(c->pair, PETSC_FALSE);
    PetscCall(Took_Private(c, begin));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
