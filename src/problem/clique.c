/* Cliques of rows of the matrix, each row coupled with all of its clique, that come from elsewhere than the cells around a rank's nodes: of contact, and of
   cells with hanging nodes, whose masters may be far from them. Both reach into rows of ranks that could not know: these are told before the matrix is made, so
   that every rank has room for all that comes to its rows. Cliques stand one behind the other in one array: number of rows, then these, ascending. */
#include "problemimpl.h"

typedef struct {
  PetscInt num, size, *entry;
} List;

/* A clique to every rank that has rows of it; others: not to this one. */
static PetscErrorCode Deal_Private(Problem p, PetscInt num, const PetscInt rows[], PetscBool others, List of[])
{
  PetscFunctionBegin;
  for (PetscMPIInt r = 0, a = 0; r < p->size && a < num; ++r) {
    List *l = &of[r];
    if (rows[a] >= p->row_start[r + 1]) continue;
    while (a < num && rows[a] < p->row_start[r + 1]) ++a;
    if (others && r == p->rank) continue;
    PetscCall(ArrayGrow(l->num + num + 1, sizeof(PetscInt), &l->size, &l->entry));
    l->entry[l->num] = num;
    PetscCall(PetscArraycpy(l->entry + l->num + 1, rows, num));
    l->num += num + 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Contact_Private(Problem p, List of[])
{
  PetscInt num, *cliques;

  PetscFunctionBegin;
  PetscCall(InterfaceCliques(p->interface, &num, &cliques));
  for (PetscInt i = 0; i < num; i += cliques[i] + 1) PetscCall(Deal_Private(p, cliques[i], cliques + i + 1, PETSC_FALSE, of));
  PetscCall(PetscFree(cliques));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells that depend on nodes beside their own, which need not be ghosts of the ranks that have these. */
static PetscErrorCode Hanging_Private(Problem p, List of[])
{
  const HPTables *v = p->tables;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < v->num_owned_cells && p->size > 1; ++c) {
    PetscInt num = 0, first, inner;
    if (v->cell_weight[c] < 0) continue;
    PetscCall(MechanicsUnknownRange(p->mechanics, c, &first, &inner));
    PetscCall(RowBufferGrow(&p->work, p->dim * (v->cell_row[c + 1] - v->cell_row[c]) + inner));
    for (PetscInt i = p->dim * v->cell_row[c]; i < p->dim * v->cell_row[c + 1]; ++i) {
      const PetscInt row = p->row[p->dim * v->cell_master[i / p->dim] + i % p->dim];
      if (row >= 0) p->work.index[num++] = row;
    }
    PetscCall(PressureColumns_Private(p, c, p->work.index, &num));
    PetscCall(PetscSortInt(num, p->work.index));
    PetscCall(Deal_Private(p, num, p->work.index, PETSC_TRUE, of));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists of others to them; *heard: what they send here. */
static PetscErrorCode Tell_Private(Problem p, const List of[], PetscInt *num_heard, PetscInt **heard)
{
  PetscMPIInt num_to = 0, *to;
  PetscInt   *first, *send, num = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(p->size, &to, p->size + 1, &first));
  for (PetscMPIInt r = 0; r < p->size; ++r) num += r == p->rank ? 0 : of[r].num;
  PetscCall(PetscMalloc1(num, &send));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < p->size; ++r) {
    if (r == p->rank || !of[r].num) continue;
    PetscCall(PetscArraycpy(send + first[num_to], of[r].entry, of[r].num));
    first[num_to + 1] = first[num_to] + of[r].num;
    to[num_to++]      = r;
  }
  PetscCall(SparseExchange(p->comm, num_to, to, first, sizeof(PetscInt), send, num_heard, heard));
  PetscCall(PetscFree2(to, first));
  PetscCall(PetscFree(send));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemCliques_Private(Problem p, PetscInt *num, PetscInt **cliques)
{
  List    *of;
  PetscInt num_heard = 0, *heard = NULL;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(p->size, &of));
  PetscCall(Contact_Private(p, of));
  PetscCall(Hanging_Private(p, of));
  if (p->size > 1) PetscCall(Tell_Private(p, of, &num_heard, &heard));
  List *own = &of[p->rank];
  PetscCall(ArrayGrow(own->num + num_heard, sizeof(PetscInt), &own->size, &own->entry));
  PetscCall(PetscArraycpy(own->entry + own->num, heard, num_heard));
  *num     = own->num + num_heard;
  *cliques = own->entry;
  for (PetscMPIInt r = 0; r < p->size; ++r)
    if (r != p->rank) PetscCall(PetscFree(of[r].entry));
  PetscCall(FreeAll(2, (void *[]){&heard, &of}));
  PetscFunctionReturn(PETSC_SUCCESS);
}
