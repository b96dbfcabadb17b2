/* The element pressures seen from outside: where a cell's coefficients lie, and the polynomials they multiply: products of Legendre polynomials on [0,1],
   complete to degree order-1, the first direction fastest (as in cell.c). */
#include "mechanicsimpl.h"

/* Pressure functions at one reference point; returns their number. */
static PetscErrorCode Functions_Private(PetscInt dim, PetscInt order, const PetscReal xi[], PetscReal value[], PetscInt *num)
{
  PetscReal L[3][MORTISE_MAX_ORDER + 1];

  PetscFunctionBegin;
  L[2][0] = 1;
  *num    = 0;
  for (PetscInt d = 0; d < dim; ++d) PetscCall(ElementLegendre(order - 1, xi[d], L[d], NULL));
  for (PetscInt z = 0; z < (dim == 3 ? order : 1); ++z) {
    for (PetscInt y = 0; y + z < order; ++y) {
      for (PetscInt x = 0; x + y + z < order; ++x) value[(*num)++] = L[0][x] * L[1][y] * L[2][z];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPressureRange(Mechanics m, PetscInt cell, PetscInt *first, PetscInt *num)
{
  PetscFunctionBegin;
  *first = *num = 0;
  if (m->cell_group[cell] < 0 || m->cell_index[cell] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  const CellGroup *g = &m->groups[m->cell_group[cell]];
  *num               = g->m;
  *first             = g->pressure + m->cell_index[cell] * g->m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsStoredCreate_Private(Mechanics m)
{
  PetscInt *size;
  PetscBool any = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->spec->num_bodies; ++b) any = (PetscBool)(any || MaterialStoresPressure(m->spec->bodies[b].material));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(m->num_groups, &size));
  for (PetscInt g = 0; g < m->num_groups; ++g) size[g] = m->groups[g].m;
  PetscCall(CellNumbersCreate_Private(m, size, &m->stored));
  PetscCall(PetscFree(size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsStorePressure(Mechanics m, const PetscReal pressure[])
{
  PetscFunctionBegin;
  PetscCall(CellNumbersSet_Private(&m->stored, pressure));
  m->has_stored = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPressureEvaluate(PetscInt dim, PetscInt order, PetscInt np, const PetscReal xi[], const PetscReal pressure[], PetscReal values[])
{
  PetscReal q[MOST_PRESSURES];
  PetscInt  num;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < np; ++i) {
    PetscCall(Functions_Private(dim, order, xi + i * dim, q, &num));
    values[i] = 0;
    for (PetscInt a = 0; a < num; ++a) values[i] += q[a] * pressure[a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Solve the symmetric positive definite M x = b in place by Cholesky (lower triangle of M is used and overwritten). */
static void Solve_Private(PetscInt n, PetscReal M[], PetscReal b[])
{
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt i = j; i < n; ++i) {
      for (PetscInt k = 0; k < j; ++k) M[i * n + j] -= M[i * n + k] * M[j * n + k];
      M[i * n + j] = i == j ? PetscSqrtReal(M[j * n + j]) : M[i * n + j] / M[j * n + j];
    }
  }
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt k = 0; k < i; ++k) b[i] -= M[i * n + k] * b[k];
    b[i] /= M[i * n + i];
  }
  for (PetscInt i = n - 1; i >= 0; --i) {
    for (PetscInt k = i + 1; k < n; ++k) b[i] -= M[k * n + i] * b[k];
    b[i] /= M[i * n + i];
  }
}

PetscErrorCode MechanicsPressureProject(PetscInt dim, PetscInt order, PetscInt np, const PetscReal xi[], const PetscReal weights[], const PetscReal values[],
                                        PetscReal pressure[])
{
  const PetscInt num = MechanicsPressureCount(dim, order);
  PetscReal      q[MOST_PRESSURES], mass = 0, *M;
  PetscInt       n;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(pressure, num));
  if (num == 1) { /* the mean: the common case needs no matrix */
    for (PetscInt i = 0; i < np; ++i) {
      mass += weights[i];
      pressure[0] += weights[i] * values[i];
    }
    pressure[0] /= mass;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc1(num * num, &M));
  for (PetscInt i = 0; i < np; ++i) {
    PetscCall(Functions_Private(dim, order, xi + i * dim, q, &n));
    for (PetscInt a = 0; a < num; ++a) {
      pressure[a] += weights[i] * q[a] * values[i];
      for (PetscInt b = 0; b <= a; ++b) M[a * num + b] += weights[i] * q[a] * q[b];
    }
  }
  Solve_Private(num, M, pressure);
  PetscCall(PetscFree(M));
  PetscFunctionReturn(PETSC_SUCCESS);
}
