/* Numbers that cells carry, of history or element pressures: those of own cells group after group, then those of ghosts, which get them from their owners. */
#include "mechanicsimpl.h"

/* Places of cells; returns where the ghosts' numbers end. */
static PetscInt Layout_Private(Mechanics m, const HPTables *v, const PetscInt size[], CellNumbers *n)
{
  PetscInt total = 0;

  for (PetscInt c = 0; c < v->num_owned_cells; ++c) n->place[c] = -1;
  for (PetscInt g = 0; g < m->num_groups; ++g) {
    for (PetscInt i = 0; i < m->groups[g].num_cells; ++i, total += size[g]) n->place[m->groups[g].cells[i]] = total;
  }
  n->num = total;
  for (PetscInt c = v->num_owned_cells; c < v->num_cells; ++c) {
    n->place[c] = total;
    if (m->cell_group[c] >= 0) total += size[m->cell_group[c]];
  }
  return total;
}

/* Where the owners of ghosts have their numbers: place[ghosts]. */
static PetscErrorCode OwnerPlaces_Private(const HPTables *v, const ForestTables *t, MPI_Comm comm, const CellNumbers *n, PetscInt place[])
{
  const PetscInt ghosts = v->num_cells - v->num_owned_cells;
  PetscInt      *of_leaf;
  PetscSF        leaves;
  PetscSFNode   *remote;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(t->num_leaves, &of_leaf));
  PetscCall(PetscMalloc1(ghosts, &remote));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) of_leaf[v->cell_leaf[c]] = n->place[c];
  for (PetscInt i = 0; i < ghosts; ++i) {
    const PetscInt leaf = v->cell_leaf[v->num_owned_cells + i];
    remote[i]           = (PetscSFNode){t->leaf_rank[leaf], leaf};
  }
  PetscCall(PetscSFCreate(comm, &leaves));
  PetscCall(PetscSFSetGraph(leaves, t->num_leaves, ghosts, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFBcastBegin(leaves, MPIU_INT, of_leaf, place, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(leaves, MPIU_INT, of_leaf, place, MPI_REPLACE));
  PetscCall(PetscSFDestroy(&leaves));
  PetscCall(PetscFree(of_leaf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellNumbersCreate_Private(Mechanics m, const PetscInt size[], CellNumbers *n)
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);
  PetscInt            num    = 0, total, *owner, *here;
  PetscSFNode        *remote;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(v->num_cells, &n->place));
  total = Layout_Private(m, v, size, n);
  PetscCall(PetscCalloc1(total, &n->values));
  PetscCall(PetscMalloc1(v->num_cells - v->num_owned_cells, &owner));
  PetscCall(OwnerPlaces_Private(v, t, ForestComm(forest), n, owner));
  PetscCall(PetscMalloc1(total - n->num, &remote));
  PetscCall(PetscMalloc1(total - n->num, &here));
  for (PetscInt c = v->num_owned_cells; c < v->num_cells; ++c) {
    const PetscInt most = m->cell_group[c] < 0 ? 0 : size[m->cell_group[c]];
    for (PetscInt k = 0; k < most; ++k, ++num) {
      remote[num] = (PetscSFNode){t->leaf_rank[v->cell_leaf[c]], owner[c - v->num_owned_cells] + k};
      here[num]   = n->place[c] + k;
    }
  }
  PetscCall(PetscFree(owner));
  PetscCall(PetscSFCreate(ForestComm(forest), &n->ghosts));
  PetscCall(PetscSFSetGraph(n->ghosts, n->num, num, here, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellNumbersSet_Private(CellNumbers *n, const PetscReal own[])
{
  PetscFunctionBegin;
  if (!n->ghosts) PetscFunctionReturn(PETSC_SUCCESS);
  if (own != n->values) PetscCall(PetscArraycpy(n->values, own, n->num));
  PetscCall(PetscSFBcastBegin(n->ghosts, MPIU_REAL, n->values, n->values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(n->ghosts, MPIU_REAL, n->values, n->values, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellNumbersDestroy_Private(CellNumbers *n)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(n->place));
  PetscCall(PetscFree(n->values));
  PetscCall(PetscSFDestroy(&n->ghosts));
  PetscFunctionReturn(PETSC_SUCCESS);
}
