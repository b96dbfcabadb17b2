/* Old cells go to the ranks whose new leaves they overlap. Leaf ownership is replicated: everybody knows who needs what, in which order. */
#include "transferimpl.h"

PetscErrorCode TransferContextSetUp_Private(TransferContext *c)
{
  const Forest old_forest = HPSpaceGetForest(c->old_space);
  const Forest new_forest = HPSpaceGetForest(c->new_space);

  PetscFunctionBegin;
  c->old_v = HPSpaceGetTables(c->old_space);
  c->new_v = HPSpaceGetTables(c->new_space);
  c->old_t = ForestGetTables(old_forest);
  c->new_t = ForestGetTables(new_forest);
  c->comm  = ForestComm(new_forest);
  PetscCallMPI(MPI_Comm_rank(c->comm, &c->rank));
  PetscCallMPI(MPI_Comm_size(c->comm, &c->size));
  PetscCheck(c->map->num == c->new_t->num_leaves, c->comm, PETSC_ERR_ARG_INCOMP, "map of %" PetscInt_FMT " leaves for a forest of %" PetscInt_FMT, c->map->num,
             c->new_t->num_leaves);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Complete polynomials of degree order-1. */
static PetscErrorCode NumHistory_Private(const TransferContext *c, PetscInt body, PetscInt order, PetscInt *num)
{
  const PetscInt h = c->spec ? c->spec->bodies[body].material->law->num_history : 0;
  const Basis1D *basis;

  PetscFunctionBegin;
  *num = 0;
  if (!h) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MechanicsPointRule(order, &basis));
  *num = ElementNumNodes(c->old_t->dim, basis->num_points - 1) * h;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt TransferNumPressure_Private(const TransferContext *c, PetscInt body, PetscInt order)
{
  if (!c->spec || !c->spec->bodies[body].material->mixed) return 0;
  return MechanicsPressureCount(c->old_t->dim, order);
}

/* Displacement, position, pressure and history numbers of an old leaf. */
static PetscErrorCode LeafSize_Private(const TransferContext *c, PetscInt leaf, PetscInt *num)
{
  const PetscInt body = c->old_t->leaf_body[leaf];
  PetscInt       history;
  const PetscInt order = HPSpaceGetOrder(c->old_space, c->old_t->first[c->old_t->dim] + leaf);

  PetscFunctionBegin;
  PetscCall(NumHistory_Private(c, body, order, &history));
  *num = TransferNumNodal_Private(c->old_t->dim, order) + TransferNumPressure_Private(c, body, order) + history;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One journey: an old leaf to a rank. */
typedef struct {
  PetscInt    leaf;
  PetscMPIInt from, to;
} Journey;

static int Compare_Private(const void *a, const void *b)
{
  const Journey *x = a, *y = b;
  if (x->leaf != y->leaf) return x->leaf < y->leaf ? -1 : 1;
  return x->to < y->to ? -1 : x->to > y->to;
}

/* Journeys that begin or end here, each once, by increasing leaf: sender and receiver then agree on the order without a word. */
static PetscErrorCode Journeys_Private(const TransferContext *c, PetscInt *num, Journey **journeys)
{
  PetscInt size = 0, kept = 0;

  PetscFunctionBegin;
  for (PetscInt pass = 0; pass < 2; ++pass) {
    size = 0;
    for (PetscInt l = 0; l < c->map->num; ++l) {
      const PetscMPIInt to = c->new_t->leaf_rank[l];
      for (PetscInt k = c->map->old_first[l]; k < c->map->old_first[l] + c->map->old_count[l]; ++k) {
        const PetscMPIInt from = c->old_t->leaf_rank[k];
        if (to != c->rank && from != c->rank) continue;
        if (pass) (*journeys)[size] = (Journey){k, from, to};
        ++size;
      }
    }
    if (!pass) PetscCall(PetscMalloc1(size, journeys));
  }
  qsort(*journeys, (size_t)size, sizeof(Journey), Compare_Private);
  for (PetscInt i = 0; i < size; ++i) {
    if (!kept || Compare_Private(&(*journeys)[kept - 1], &(*journeys)[i])) (*journeys)[kept++] = (*journeys)[i];
  }
  *num = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers per partner and their offsets; counts[2][size], offsets[2][size+1]: 0 sent, 1 received. */
static PetscErrorCode Counts_Private(const TransferContext *c, PetscInt num, const Journey journeys[], PetscMPIInt *counts, PetscMPIInt *offsets)
{
  PetscFunctionBegin;
  PetscCall(PetscArrayzero(counts, 2 * c->size));
  for (PetscInt i = 0; i < num; ++i) {
    PetscInt n;
    PetscCall(LeafSize_Private(c, journeys[i].leaf, &n));
    if (journeys[i].from == c->rank) counts[journeys[i].to] += (PetscMPIInt)n;
    if (journeys[i].to == c->rank) counts[c->size + journeys[i].from] += (PetscMPIInt)n;
  }
  for (PetscInt k = 0; k < 2; ++k) {
    PetscMPIInt *o = offsets + k * (c->size + 1);
    o[0]           = 0;
    for (PetscMPIInt r = 0; r < c->size; ++r) o[r + 1] = o[r] + counts[k * c->size + r];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pack_Private(const TransferContext *c, const PetscInt leaf_cell[], PetscInt leaf, const OldFields *from, PetscReal to[])
{
  const PetscInt dim = c->old_t->dim;
  PetscInt       first, num;
  const PetscInt order = HPSpaceGetOrder(c->old_space, c->old_t->first[dim] + leaf);

  PetscFunctionBegin;
  PetscCall(HPSpaceGather(c->old_space, leaf_cell[leaf], from->u, to));
  PetscCall(HPSpaceGatherPositions(c->old_space, leaf_cell[leaf], to + ElementNumNodes(dim, order) * dim));
  if (!c->old_mechanics) PetscFunctionReturn(PETSC_SUCCESS);
  to += TransferNumNodal_Private(dim, order);
  PetscCall(MechanicsPressureRange(c->old_mechanics, leaf_cell[leaf], &first, &num));
  PetscCall(PetscArraycpy(to, from->pressure + first, num));
  to += num;
  PetscCall(MechanicsUnknownRange(c->old_mechanics, leaf_cell[leaf], &first, &num));
  PetscCall(MechanicsGetPressure(c->old_mechanics, first, num, to)); /* a cell has either */
  to += num;
  PetscCall(MechanicsHistoryRange(c->old_mechanics, leaf_cell[leaf], &first, &num));
  PetscCall(PetscArraycpy(to, from->history + first, num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Send_Private(const TransferContext *c, PetscInt num, const Journey journeys[], const PetscMPIInt offsets[], const OldFields *from,
                                   PetscReal buffer[])
{
  PetscInt    *leaf_cell;
  PetscMPIInt *next;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(c->old_t->num_leaves, &leaf_cell, c->size, &next));
  for (PetscInt i = 0; i < c->old_v->num_owned_cells; ++i) leaf_cell[c->old_v->cell_leaf[i]] = i;
  PetscCall(PetscArraycpy(next, offsets, c->size));
  for (PetscInt i = 0; i < num; ++i) {
    PetscInt n;
    if (journeys[i].from != c->rank) continue;
    PetscCall(Pack_Private(c, leaf_cell, journeys[i].leaf, from, buffer + next[journeys[i].to]));
    PetscCall(LeafSize_Private(c, journeys[i].leaf, &n));
    next[journeys[i].to] += (PetscMPIInt)n;
  }
  PetscCall(PetscFree2(leaf_cell, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Place_Private(const TransferContext *c, PetscInt num, const Journey journeys[], const PetscMPIInt offsets[], PetscInt offset[])
{
  PetscMPIInt *next;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(c->size, &next));
  PetscCall(PetscArraycpy(next, offsets, c->size));
  for (PetscInt l = 0; l < c->old_t->num_leaves; ++l) offset[l] = -1;
  for (PetscInt i = 0; i < num; ++i) {
    PetscInt n;
    if (journeys[i].to != c->rank) continue;
    PetscCall(LeafSize_Private(c, journeys[i].leaf, &n));
    offset[journeys[i].leaf] = next[journeys[i].from];
    next[journeys[i].from] += (PetscMPIInt)n;
  }
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OldCellsFetch_Private(const TransferContext *c, const OldFields *from, OldCells *old)
{
  Journey     *journeys;
  PetscInt     num;
  PetscMPIInt *counts, *offsets;
  PetscReal   *send;

  PetscFunctionBegin;
  PetscCall(Journeys_Private(c, &num, &journeys));
  PetscCall(PetscMalloc2(2 * c->size, &counts, 2 * (c->size + 1), &offsets));
  PetscCall(Counts_Private(c, num, journeys, counts, offsets));
  PetscMPIInt *received = offsets + c->size + 1;
  PetscCall(PetscMalloc1(offsets[c->size], &send));
  PetscCall(PetscMalloc1(c->old_t->num_leaves, &old->offset));
  PetscCall(PetscMalloc1(received[c->size], &old->values));
  PetscCall(Send_Private(c, num, journeys, offsets, from, send));
  PetscCall(Place_Private(c, num, journeys, received, old->offset));
  PetscCallMPI(MPI_Alltoallv(send, counts, offsets, MPIU_REAL, old->values, counts + c->size, received, MPIU_REAL, c->comm));
  PetscCall(PetscFree(send));
  PetscCall(PetscFree2(counts, offsets));
  PetscCall(PetscFree(journeys));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OldCellsDestroy_Private(OldCells *old)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(old->offset));
  PetscCall(PetscFree(old->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
