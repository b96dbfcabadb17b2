/* Places of the unknowns in the problem's vector, and the matrix with room for bulk and contact. */
#include "problemimpl.h"

static PetscInt RankOf_Private(Problem p, PetscInt u)
{
  PetscMPIInt r = 0;
  while (u >= p->u_start[r + 1]) ++r;
  return r;
}

PetscErrorCode ProblemLayout_Private(Problem p)
{
  const PetscInt *global;
  PetscInt       *counts;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetGlobalDofs(p->space, &global));
  const DM dm = HPSpaceGetDM(p->space);
  PetscCall(DMCreateGlobalVector(dm, &p->u_global));
  PetscCall(VecGetLocalSize(p->u_global, &p->num_u));
  PetscCall(PetscMalloc3(p->size + 1, &p->u_start, p->size + 1, &p->p_start, p->size + 1, &p->row_start));
  PetscCall(PetscMalloc1(p->size, &counts));
  PetscCallMPI(MPI_Allgather(&p->num_u, 1, MPIU_INT, counts, 1, MPIU_INT, p->comm));
  p->u_start[0] = 0;
  for (PetscMPIInt r = 0; r < p->size; ++r) p->u_start[r + 1] = p->u_start[r] + counts[r];
  PetscCall(InterfaceNumber(p->interface, counts)); /* appends the multipliers of each rank */
  p->num_z = counts[p->rank] - p->num_u;
  PetscCall(PressureNumber_Private(p, counts));
  counts[p->size - 1] += p->num_scalars;
  p->p_start[0] = 0;
  for (PetscMPIInt r = 0; r < p->size; ++r) p->p_start[r + 1] = p->p_start[r] + counts[r];
  p->start    = p->p_start[p->rank];
  p->num_dofs = p->p_start[p->size];
  PetscCall(PetscFree(counts));
  PetscCall(PetscMalloc2(p->num_local, &p->index, p->num_local, &p->row));
  for (PetscInt i = 0; i < p->num_local; ++i) {
    p->index[i] = global[i];
    if (global[i] < 0) continue;
    const PetscInt r = RankOf_Private(p, global[i]);
    p->index[i]      = global[i] - p->u_start[r] + p->p_start[r];
  }
  PetscCall(VecCreate(p->comm, &p->prototype));
  PetscCall(VecSetSizes(p->prototype, p->p_start[p->rank + 1] - p->start, PETSC_DETERMINE));
  PetscCall(VecSetType(p->prototype, VECSTANDARD));
  PetscCall(PressureIndices_Private(p));
  PetscCall(ProblemRows_Private(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* node -> local cells that depend on it, CSR. */
static PetscErrorCode NodeCells_Private(const HPTables *v, PetscInt **offset, PetscInt **cells)
{
  PetscInt *o, *l;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(v->num_nodes + 2, &o));
  PetscCall(PetscMalloc1(v->cell_row[v->num_cells], &l));
  for (PetscInt k = 0; k < v->cell_row[v->num_cells]; ++k) ++o[v->cell_master[k] + 2];
  for (PetscInt n = 0; n < v->num_nodes; ++n) o[n + 2] += o[n + 1];
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    for (PetscInt k = v->cell_row[c]; k < v->cell_row[c + 1]; ++k) l[o[v->cell_master[k] + 1]++] = c;
  }
  *offset = o;
  *cells  = l;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns of the bulk in the rows of node n, sorted; stamp[num_nodes] remembers whom a node was last seen by, work[num_nodes][2]. Returns their number. */
static PetscErrorCode NodeColumns_Private(Problem p, const HPTables *v, const PetscInt offset[], const PetscInt cells[], PetscInt n, PetscInt stamp[],
                                          PetscInt work[], PetscInt columns[], PetscInt *num)
{
  PetscInt nodes = 0, *first = work, *free = work + v->num_nodes; /* columns of a node stand side by side: first one, number */

  PetscFunctionBegin;
  for (PetscInt i = offset[n]; i < offset[n + 1]; ++i) {
    for (PetscInt k = v->cell_row[cells[i]]; k < v->cell_row[cells[i] + 1]; ++k) {
      const PetscInt m = v->cell_master[k];
      if (stamp[m] == n) continue;
      stamp[m]    = n;
      free[nodes] = 0;
      for (PetscInt c = 0; c < p->dim; ++c) {
        const PetscInt column = p->row[m * p->dim + c];
        if (column >= 0 && free[nodes]++ == 0) first[nodes] = column;
      }
      nodes += free[nodes] > 0;
    }
  }
  PetscCall(PetscSortIntWithArray(nodes, first, free));
  *num = 0;
  for (PetscInt m = 0; m < nodes; ++m)
    for (PetscInt c = 0; c < free[m]; ++c) columns[(*num)++] = first[m] + c;
  for (PetscInt i = offset[n]; i < offset[n + 1]; ++i) PetscCall(PressureColumns_Private(p, cells[i], columns, num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The bulk's entries in the rows of this rank: exact counts or, without counters, explicit zeros, in order. */
static PetscErrorCode BulkPattern_Private(Problem p, PetscInt diagonal[], PetscInt other[])
{
  const HPTables *v = p->tables;
  PetscInt       *offset, *cells, *stamp, *work, *columns, num, owned, all;
  PetscReal      *zeros;

  PetscFunctionBegin;
  PetscCall(NodeCells_Private(v, &offset, &cells));
  PetscCall(MechanicsNumUnknowns(p->mechanics, &owned, &all));
  PetscCall(PetscMalloc3(v->num_nodes, &stamp, 2 * v->num_nodes, &work, p->num_local + all, &columns));
  PetscCall(PetscCalloc1(p->num_local + all, &zeros));
  for (PetscInt n = 0; n < v->num_nodes; ++n) stamp[n] = -1;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    num = -1;
    for (PetscInt c = 0; c < p->dim; ++c) {
      const PetscInt row = p->row[n * p->dim + c] - p->first_row;
      if (p->row[n * p->dim + c] < 0 || row < 0 || row >= p->num_rows) continue;
      if (num < 0) PetscCall(NodeColumns_Private(p, v, offset, cells, n, stamp, work, columns, &num));
      if (!diagonal) {
        PetscCall(MatSetValues(p->matrix, 1, &p->row[n * p->dim + c], num, columns, zeros, ADD_VALUES));
        continue;
      }
      for (PetscInt k = 0; k < num; ++k) {
        const PetscBool mine = (PetscBool)(columns[k] >= p->first_row && columns[k] < p->first_row + p->num_rows);
        ++(mine ? diagonal : other)[row];
      }
    }
  }
  PetscCall(PetscFree3(stamp, work, columns));
  PetscCall(FreeAll(3, (void *[]){&zeros, &offset, &cells}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of cliques in the rows of this rank: an upper bound of their numbers or, without counters, explicit zeros. */
static PetscErrorCode CliquePattern_Private(Problem p, PetscInt num, const PetscInt cliques[], PetscInt diagonal[], PetscInt other[])
{
  PetscReal *zeros;
  PetscInt   most = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; i += cliques[i] + 1) most = PetscMax(most, cliques[i]);
  PetscCall(PetscCalloc1(most * most, &zeros));
  for (PetscInt i = 0; i < num; i += cliques[i] + 1) {
    const PetscInt *rows = cliques + i + 1, n = cliques[i];
    PetscInt        from = 0, mine = 0;
    while (from < n && rows[from] < p->first_row) ++from;
    while (from + mine < n && rows[from + mine] < p->first_row + p->num_rows) ++mine;
    if (!diagonal) PetscCall(MatSetValues(p->matrix, mine, rows + from, n, rows, zeros, ADD_VALUES));
    for (PetscInt a = from; a < from + mine && diagonal; ++a) {
      diagonal[rows[a] - p->first_row] += mine;
      other[rows[a] - p->first_row] += n - mine;
    }
  }
  PetscCall(PetscFree(zeros));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemMatrix_Private(Problem p)
{
  const PetscInt rows = p->num_rows;
  PetscInt      *diagonal, *other, *cliques, num;

  PetscFunctionBegin;
  PetscCall(StageBegin(STAGE_SETUP));
  PetscCall(ProblemCliques_Private(p, &num, &cliques));
  PetscCall(MatDestroy(&p->matrix));
  PetscCall(PetscCalloc2(rows, &diagonal, rows, &other));
  PetscCall(BulkPattern_Private(p, diagonal, other));
  PetscCall(PressurePattern_Private(p, diagonal, other));
  PetscCall(CliquePattern_Private(p, num, cliques, diagonal, other));
  PetscCall(ScalarsPattern_Private(p, diagonal, other));
  for (PetscInt i = 0; i < rows; ++i) {
    diagonal[i] = PetscMin(diagonal[i] + 1, rows);
    other[i]    = PetscMin(other[i], p->row_start[p->size] - rows);
  }
  PetscCall(MatCreate(p->comm, &p->matrix));
  PetscCall(MatSetSizes(p->matrix, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(p->matrix, MATAIJ));
  PetscCall(MatXAIJSetPreallocation(p->matrix, 1, diagonal, other, NULL, NULL));
  /* What was not foreseen after all would cost time, not the run. */
  PetscCall(MatSetOption(p->matrix, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
  PetscCall(PetscFree2(diagonal, other));
  PetscCall(BulkPattern_Private(p, NULL, NULL));
  PetscCall(PressurePattern_Private(p, NULL, NULL));
  PetscCall(CliquePattern_Private(p, num, cliques, NULL, NULL));
  PetscCall(ScalarsPattern_Private(p, NULL, NULL));
  PetscCall(MatAssemble(p->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(PetscFree(cliques));
  PetscCall(PetscFree2(p->scatter_first, p->scatter));
  PetscCall(StageEnd(STAGE_SETUP));
  PetscFunctionReturn(PETSC_SUCCESS);
}
