/* Blocks of contact into the matrix: rows of this rank whose columns have room there, without a search for each entry; the others by MatSetValues. */
#include "interfaceimpl.h"

#define FEW 8 /* columns: searches take less than a walk along the row */

typedef struct {
  PetscInt *column, *from,
      *place; /* [num] sorted, in this rank's diagonal block; where they stand in the caller's rows; where they go in a row of the matrix */
  PetscInt        num, first_row, last_row;
  PetscBool       mine; /* all columns are in the diagonal block */
  const PetscInt *ai, *aj;
  PetscReal      *values;
} Insertion;

static PetscErrorCode Columns_Private(PetscInt num, const PetscInt columns[], Insertion *s)
{
  PetscFunctionBegin;
  s->num  = 0;
  s->mine = PETSC_TRUE;
  for (PetscInt i = 0; i < num; ++i) {
    if (columns[i] < 0) continue;
    s->column[s->num] = columns[i] - s->first_row;
    s->from[s->num]   = i;
    if (columns[i] < s->first_row || columns[i] >= s->last_row) s->mine = PETSC_FALSE;
    ++s->num;
  }
  PetscCall(PetscSortIntWithArray(s->num, s->column, s->from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Places of the columns in a row of the diagonal block. */
static PetscErrorCode Places_Private(Insertion *s, PetscInt row, PetscBool *found)
{
  const PetscInt *column = s->aj + s->ai[row], num = s->ai[row + 1] - s->ai[row];
  PetscInt        at = 0;

  PetscFunctionBegin;
  *found = PETSC_TRUE;
  for (PetscInt i = 0; i < s->num && *found; ++i) {
    if (s->num <= FEW)
      PetscCall(PetscFindInt(s->column[i], num, column, &at));
    else
      while (at < num && column[at] < s->column[i]) ++at;
    *found      = (PetscBool)(at >= 0 && at < num && column[at] == s->column[i]);
    s->place[i] = at;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Open_Private(Mat A, Insertion *s)
{
  PetscInt  lines;
  PetscBool ok;

  PetscFunctionBegin;
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &lines, &s->ai, &s->aj, &ok));
  PetscCall(MatSeqAIJGetArray(A, &s->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Close_Private(Mat A, Insertion *s)
{
  PetscInt  lines;
  PetscBool ok;

  PetscFunctionBegin;
  PetscCall(MatSeqAIJRestoreArray(A, &s->values));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &lines, &s->ai, &s->aj, &ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactInsert_Private(Mat matrix, PetscInt num_rows, const PetscInt rows[], PetscInt num_columns, const PetscInt columns[], const PetscReal K[],
                                     InsertMode mode)
{
  PetscBool found;
  Insertion s;
  Mat       A;

  PetscFunctionBegin;
  PetscCall(MatGetDiagonalBlock(matrix, &A));
  PetscCall(MatGetOwnershipRange(matrix, &s.first_row, &s.last_row));
  PetscCall(PetscMalloc3(num_columns, &s.column, num_columns, &s.from, num_columns, &s.place));
  PetscCall(Columns_Private(num_columns, columns, &s));
  PetscCall(Open_Private(A, &s));
  for (PetscInt r = 0; r < num_rows; ++r) {
    const PetscInt   row  = rows[r] - s.first_row;
    const PetscReal *from = K + r * num_columns;

    if (rows[r] < 0) continue;
    found = PETSC_FALSE;
    if (s.mine && row >= 0 && rows[r] < s.last_row) PetscCall(Places_Private(&s, row, &found));
    if (found) {
      PetscReal *to = s.values + s.ai[row];
      for (PetscInt i = 0; i < s.num; ++i) to[s.place[i]] = from[s.from[i]] + (mode == ADD_VALUES ? to[s.place[i]] : 0);
      continue;
    }
    PetscCall(Close_Private(A, &s));
    PetscCall(MatSetValues(matrix, 1, &rows[r], num_columns, columns, from, mode));
    PetscCall(Open_Private(A, &s));
  }
  PetscCall(Close_Private(A, &s));
  PetscCall(PetscFree3(s.column, s.from, s.place));
  PetscFunctionReturn(PETSC_SUCCESS);
}
