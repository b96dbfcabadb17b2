/* Where the entries of a cell's matrix go in this rank's diagonal block of the matrix: one number for each pair of nodes, the place of the second's first
   column in the rows of the first, since columns of a node stand side by side and its rows have the same columns. With it adding a cell takes no search. */
#include "problemimpl.h"

#define NOWHERE UINT16_MAX

/* Nodes of cell in the order of its matrix: all masters, or those that are not inside it. */
static PetscInt Nodes_Private(Problem p, const HPTables *v, PetscInt cell, PetscInt nodes[])
{
  PetscInt num = 0;
  for (PetscInt k = v->cell_row[cell]; k < v->cell_row[cell + 1]; ++k) {
    const PetscInt n = v->cell_master[k];
    if (!p->condensed || n < v->point_node[cell] || n >= v->point_node[cell + 1]) nodes[num++] = n;
  }
  return num;
}

/* Row in this rank's diagonal block of the node's first free dof, -1: none is free, -2: another rank's. */
static PetscInt FirstRow_Private(Problem p, PetscInt node)
{
  for (PetscInt c = 0; c < p->dim; ++c) {
    const PetscInt row = p->row[node * p->dim + c];
    if (row >= 0) return row >= p->first_row && row < p->first_row + p->num_rows ? row - p->first_row : -2;
  }
  return -1;
}

/* Places of one cell; false: some node is another rank's or not where it should be. */
static PetscErrorCode CellPlaces_Private(Problem p, PetscInt num, const PetscInt nodes[], const PetscInt first[], const PetscInt *ai, const PetscInt *aj,
                                         uint16_t place[], PetscBool *usable)
{
  const PetscInt dim = p->dim;
  PetscInt       at;

  PetscFunctionBegin;
  *usable = PETSC_TRUE;
  for (PetscInt a = 0; a < num; ++a) {
    if (first[a] == -2) *usable = PETSC_FALSE;
  }
  for (PetscInt a = 0; a < num && *usable; ++a) {
    for (PetscInt b = 0; b < num && *usable; ++b) {
      place[a * num + b] = NOWHERE;
      if (first[a] < 0 || first[b] < 0) continue;
      PetscCall(PetscFindInt(first[b], ai[first[a] + 1] - ai[first[a]], aj + ai[first[a]], &at));
      *usable = (PetscBool)(at >= 0 && at < NOWHERE);
      for (PetscInt c = 0; c < dim && *usable; ++c) {
        const PetscInt row = p->row[nodes[a] * dim + c] - p->first_row;
        if (p->row[nodes[a] * dim + c] >= 0) *usable = (PetscBool)(ai[row] + at < ai[row + 1] && aj[ai[row] + at] == first[b]);
      }
      place[a * num + b] = (uint16_t)at;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemScatter_Private(Problem p)
{
  const HPTables  *v = p->tables;
  const PetscInt  *ai, *aj;
  PetscObjectState state;
  PetscInt         rows, most = 0, *nodes, *first;
  size_t           size = 0;
  PetscBool        ok;
  Mat              A;

  PetscFunctionBegin;
  PetscCall(MatGetDiagonalBlock(p->matrix, &A));
  PetscCall(MatGetNonzeroState(A, &state));
  if (p->scatter_first && p->scatter_state == state) PetscFunctionReturn(PETSC_SUCCESS);
  p->scatter_state = state;
  PetscCall(PetscFree2(p->scatter_first, p->scatter));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt n = v->cell_row[c + 1] - v->cell_row[c];
    most             = PetscMax(most, n);
    size += (size_t)n * n;
  }
  PetscCall(PetscMalloc2(v->num_owned_cells, &p->scatter_first, size, &p->scatter));
  PetscCall(PetscMalloc2(most, &nodes, most, &first));
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows, &ai, &aj, &ok));
  PetscCheck(ok, PETSC_COMM_SELF, PETSC_ERR_PLIB, "the matrix does not show its rows");
  size = 0;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt num = Nodes_Private(p, v, c, nodes);
    PetscBool      usable;
    for (PetscInt a = 0; a < num; ++a) first[a] = FirstRow_Private(p, nodes[a]);
    PetscCall(CellPlaces_Private(p, num, nodes, first, ai, aj, p->scatter + size, &usable));
    p->scatter_first[c] = usable ? (ptrdiff_t)size : -1;
    if (usable) size += (size_t)num * num;
  }
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows, &ai, &aj, &ok));
  PetscCall(PetscFree2(nodes, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One row of a cell with prescribed dofs. */
static void AddRow_Private(Problem p, PetscInt num, const PetscInt dofs[], const uint16_t at[], const PetscReal k[], PetscReal to[])
{
  for (PetscInt b = 0; b < num; ++b) {
    PetscInt next = at[b];
    for (PetscInt i = b * p->dim; i < (b + 1) * p->dim; ++i) {
      if (p->row[dofs[i]] >= 0) to[next++] += k[i];
    }
  }
}

PetscErrorCode ProblemScatterAdd_Private(Problem p, PetscInt cell, PetscInt num_dofs, const PetscInt dofs[], const PetscReal K[], PetscBool *added)
{
  const PetscInt  dim = p->dim, num = num_dofs / dim;
  const PetscInt *ai, *aj;
  PetscInt        rows;
  PetscReal      *values;
  PetscBool       ok, whole = PETSC_TRUE; /* no dof is prescribed */
  Mat             A;

  PetscFunctionBegin;
  *added = (PetscBool)(cell >= 0 && p->scatter_first[cell] >= 0);
  if (!*added) PetscFunctionReturn(PETSC_SUCCESS);
  const uint16_t *place = p->scatter + p->scatter_first[cell];
  PetscCall(MatGetDiagonalBlock(p->matrix, &A));
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows, &ai, &aj, &ok));
  PetscCall(MatSeqAIJGetArray(A, &values));
  for (PetscInt i = 0; i < num_dofs; ++i) whole = (PetscBool)(whole && p->row[dofs[i]] >= 0);
  for (PetscInt i = 0; i < num_dofs; ++i) {
    if (p->row[dofs[i]] < 0) continue;
    PetscReal       *to = values + ai[p->row[dofs[i]] - p->first_row];
    const uint16_t  *at = place + i / dim * num;
    const PetscReal *k  = K + i * num_dofs;
    if (!whole)
      AddRow_Private(p, num, dofs, at, k, to);
    else if (dim == 3)
      for (PetscInt b = 0; b < num; ++b)
        for (PetscInt e = 0; e < 3; ++e) to[at[b] + e] += k[3 * b + e];
    else
      for (PetscInt b = 0; b < num; ++b)
        for (PetscInt e = 0; e < 2; ++e) to[at[b] + e] += k[2 * b + e];
  }
  PetscCall(MatSeqAIJRestoreArray(A, &values));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &rows, &ai, &aj, &ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}
