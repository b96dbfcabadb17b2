/* Pressures of incompressible cells as unknowns of the problem (mechanics/incompressible.c): their places behind the multipliers, in the vector and in the
   matrix, their rows, and their blocks of the tangent.

   Row a of a cell: R_a = E/h int q_a g(J). With B its derivative before the factor, the exact form of the tangent has rows E/h B and columns B^T, the symmetric
   one B and B^T. */
#include "problemimpl.h"

PetscBool ProblemIsIncompressible(Problem p)
{
  for (PetscInt b = 0; b < p->scene->mechanics.num_bodies; ++b)
    if (p->scene->bodies[b].material->incompressible) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Pressure unknowns of a leaf, of any rank. */
static void LeafUnknowns_Private(Problem p, const ForestTables *t, PetscInt leaf, PetscInt *num)
{
  *num = 0;
  if (!p->scene->bodies[t->leaf_body[leaf]].material->incompressible) return;
  const PetscInt order = HPSpaceGetOrder(p->space, t->first[t->dim] + leaf);
  *num                 = MechanicsPressureCount(t->dim, order);
}

/* Unknowns live with the owner of their cell, in the order of the leaves. pi_index: place in the owner's block, until the next function. */
PetscErrorCode PressureNumber_Private(Problem p, PetscInt counts[])
{
  const ForestTables *t = ForestGetTables(p->forest);
  const HPTables     *v = p->tables;
  PetscInt           *place, first, num, owned, all;

  PetscFunctionBegin;
  PetscCall(MechanicsNumUnknowns(p->mechanics, &owned, &all));
  PetscCall(PetscMalloc3(all, &p->pi_index, all, &p->pi_row, all, &p->pi_rank));
  PetscCall(PetscMalloc1(owned, &p->pi_scale));
  PetscCall(PetscMalloc1(t->num_leaves, &place));
  p->pi_first = counts[p->rank];
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    LeafUnknowns_Private(p, t, l, &num);
    place[l] = counts[t->leaf_rank[l]];
    counts[t->leaf_rank[l]] += num;
  }
  p->num_pi = counts[p->rank] - p->pi_first;
  PetscCheck(p->num_pi == owned, PETSC_COMM_SELF, PETSC_ERR_PLIB, "%" PetscInt_FMT " pressure unknowns, mechanics has %" PetscInt_FMT, p->num_pi, owned);
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    PetscCall(MechanicsUnknownRange(p->mechanics, c, &first, &num));
    PetscCheck(c >= v->num_owned_cells || num == 0 || place[v->cell_leaf[c]] == p->pi_first + first, PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "cells are not in the order of their leaves");
    for (PetscInt a = 0; a < num; ++a) {
      p->pi_index[first + a] = place[v->cell_leaf[c]] + a;
      p->pi_rank[first + a]  = t->leaf_rank[v->cell_leaf[c]];
    }
  }
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureIndices_Private(Problem p)
{
  PetscInt        owned, all;
  const PetscBool any = ProblemIsIncompressible(p);
  IS              from;

  PetscFunctionBegin;
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MechanicsNumUnknowns(p->mechanics, &owned, &all));
  for (PetscInt i = 0; i < all; ++i) p->pi_index[i] += p->p_start[p->pi_rank[i]];
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, all, &p->pi_local));
  PetscCall(ISCreateGeneral(p->comm, all, p->pi_index, PETSC_USE_POINTER, &from));
  PetscCall(VecScatterCreate(p->prototype, from, p->pi_local, NULL, &p->pi_scatter));
  PetscCall(ISDestroy(&from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureRowNumbers_Private(Problem p, const PetscInt inner[])
{
  PetscInt owned, all;

  PetscFunctionBegin;
  PetscCall(MechanicsNumUnknowns(p->mechanics, &owned, &all));
  for (PetscInt i = 0; i < all; ++i) p->pi_row[i] = p->pi_index[i] - p->p_start[p->pi_rank[i]] - inner[p->pi_rank[i]] + p->row_start[p->pi_rank[i]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureDestroy_Private(Problem p)
{
  PetscFunctionBegin;
  PetscCall(PetscFree3(p->pi_index, p->pi_row, p->pi_rank));
  PetscCall(PetscFree(p->pi_scale));
  PetscCall(VecDestroy(&p->pi_local));
  PetscCall(VecScatterDestroy(&p->pi_scatter));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureSpread_Private(Problem p, Vec x)
{
  const PetscReal *values;

  PetscFunctionBegin;
  if (!p->pi_local) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecScatterBegin(p->pi_scatter, x, p->pi_local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(p->pi_scatter, x, p->pi_local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecGetArrayRead(p->pi_local, &values));
  PetscCall(MechanicsSetPressure(p->mechanics, values));
  PetscCall(VecRestoreArrayRead(p->pi_local, &values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSetPressures(Problem p, const PetscReal pressure[], Vec x)
{
  PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetArray(x, &array));
  PetscCall(PetscArraycpy(array + p->pi_first, pressure, p->num_pi));
  PetscCall(VecRestoreArray(x, &array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureColumns_Private(Problem p, PetscInt cell, PetscInt columns[], PetscInt *num)
{
  PetscInt first, n;

  PetscFunctionBegin;
  PetscCall(MechanicsUnknownRange(p->mechanics, cell, &first, &n));
  for (PetscInt a = 0; a < n; ++a) columns[(*num)++] = p->pi_row[first + a];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each row has its diagonal and the free dofs of its cell, which other ranks may own. */
PetscErrorCode PressurePattern_Private(Problem p, PetscInt diagonal[], PetscInt other[])
{
  const HPTables *v    = p->tables;
  PetscInt        most = 0, first, rows, *columns;
  PetscReal      *zeros;

  PetscFunctionBegin;
  if (!p->pi_local) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) most = PetscMax(most, p->dim * (v->cell_row[c + 1] - v->cell_row[c]) + 1);
  PetscCall(PetscMalloc1(most, &columns));
  PetscCall(PetscCalloc1(most, &zeros));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscInt num = 1;
    PetscCall(MechanicsUnknownRange(p->mechanics, c, &first, &rows));
    for (PetscInt i = p->dim * v->cell_row[c]; i < p->dim * v->cell_row[c + 1] && rows; ++i) {
      const PetscInt column = p->row[p->dim * v->cell_master[i / p->dim] + i % p->dim];
      if (column >= 0) columns[num++] = column;
    }
    for (PetscInt a = first; a < first + rows; ++a) {
      columns[0] = p->pi_row[a];
      if (!diagonal) PetscCall(MatSetValues(p->matrix, 1, &columns[0], num, columns, zeros, ADD_VALUES));
      for (PetscInt k = 0; k < num && diagonal; ++k) {
        const PetscBool mine = (PetscBool)(columns[k] >= p->first_row && columns[k] < p->first_row + p->num_rows);
        ++(mine ? diagonal : other)[columns[0] - p->first_row];
      }
    }
  }
  PetscCall(PetscFree(columns));
  PetscCall(PetscFree(zeros));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One cell: rows and columns of its pressures; prescribed motion still to come changes its volume, too. */
static PetscErrorCode Sink_Private(void *context, PetscInt cell, PetscInt num_rows, PetscInt num, const PetscInt dofs[], const PetscReal B[], PetscReal scale,
                                   const PetscReal hold[])
{
  Problem   p = (Problem)context;
  PetscInt  first, n;
  PetscReal form = p->symmetric ? 1 : scale;

  PetscFunctionBegin;
  PetscCall(RowBufferGrow(&p->work, num));
  for (PetscInt k = 0; k < num; ++k) p->work.index[k] = p->row[dofs[k]];
  PetscCall(MechanicsUnknownRange(p->mechanics, cell, &first, &n));
  for (PetscInt a = 0; a < num_rows; ++a) {
    const PetscInt   row    = p->pi_row[first + a];
    const PetscReal *b      = B + a * num;
    PetscReal        change = 0;
    p->pi_scale[first + a]  = scale;
    PetscCall(MatSetValues(p->matrix, num, p->work.index, 1, &row, b, ADD_VALUES));
    for (PetscInt k = 0; k < num; ++k) p->work.value[k] = form * b[k];
    PetscCall(MatSetValues(p->matrix, 1, &row, num, p->work.index, p->work.value, ADD_VALUES));
    PetscCall(MatSetValue(p->matrix, row, row, -form * hold[a], ADD_VALUES));
    for (PetscInt k = 0; k < num && p->lift; ++k) {
      if (p->work.index[k] < 0) change += b[k] * p->increment[dofs[k]];
    }
    if (p->lift) PetscCall(VecSetValue(p->lift, row, scale * change, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureBlocks_Private(Problem p)
{
  PetscFunctionBegin;
  PetscCall(MechanicsVolumeTangent(p->mechanics, Sink_Private, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PressureSides_Private(Problem p, Vec rhs)
{
  PetscReal *b;

  PetscFunctionBegin;
  if (!p->symmetric) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(rhs, &b));
  for (PetscInt i = 0; i < p->num_pi; ++i) b[p->pi_row[i] - p->first_row] /= p->pi_scale[i];
  PetscCall(VecRestoreArray(rhs, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
