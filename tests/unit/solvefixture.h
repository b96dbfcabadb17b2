/* Solution of a bulk problem on one rank, and the energy of its error, for tests of the estimate. */
#pragma once
#include "bulkfixture.h"
#include "estimateimpl.h"
#include <petscksp.h>

typedef struct {
  Mat             A;
  const PetscInt *global;
} Assembly;

static inline PetscErrorCode Insert(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  const Assembly *a = context;
  PetscInt       *rows;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &rows));
  for (PetscInt i = 0; i < num; ++i) rows[i] = a->global[dofs[i]];
  PetscCall(MatSetValues(a->A, num, rows, num, rows, K, ADD_VALUES));
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* At most so many entries in each row: those of its cells, each counted for itself. Orders above 4 in space have too many for one bound for all rows. */
typedef struct {
  PetscInt       *entries;
  const PetscInt *global;
} RowCount;

static inline PetscErrorCode Count(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  const RowCount *c = context;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; ++i)
    if (c->global[dofs[i]] >= 0) c->entries[c->global[dofs[i]]] += num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline void CreateTangent(const Bulk *b, const PetscReal u[], const PetscInt global[], PetscInt n, Mat *A)
{
  RowCount  count = {.global = global};
  PetscBool bad;

  OK(PetscCalloc1(n, &count.entries));
  OK(MechanicsTangent(b->mechanics, u, NULL, Count, &count, &bad));
  for (PetscInt i = 0; i < n; ++i) count.entries[i] = PetscMin(count.entries[i], n);
  OK(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 0, count.entries, A));
  OK(PetscFree(count.entries));
}

/* Newton with a direct solver, one rank, from the nodal values of the exact field in u. */
static inline void BulkSolve(const Bulk *b, PetscReal u[])
{
  const HPTables *v;
  const PetscInt *global;
  PetscReal      *r, *x, first = 0;
  PetscInt        n = 0;

  v = HPSpaceGetTables(b->space);
  OK(HPSpaceGetGlobalDofs(b->space, &global));
  for (PetscInt i = 0; i < v->num_nodes * v->dim; ++i) n = PetscMax(n, global[i] + 1);
  OK(PetscMalloc1(v->num_nodes * v->dim, &r));
  OK(MechanicsPrescribe(b->mechanics, u));
  for (PetscInt it = 0; it < 10; ++it) {
    Assembly        a = {.global = global};
    MechanicsStatus status;
    PetscBool       bad;
    PetscReal       norm;
    Vec             rhs, dx;
    KSP             ksp;
    PC              pc;
    OK(PetscArrayzero(r, v->num_nodes * v->dim));
    OK(MechanicsResidual(b->mechanics, u, NULL, r, &status));
    assert_false(status.bad);
    OK(VecCreateSeq(PETSC_COMM_SELF, n, &rhs));
    OK(VecDuplicate(rhs, &dx));
    OK(VecGetArray(rhs, &x));
    for (PetscInt i = 0; i < v->num_nodes * v->dim; ++i)
      if (global[i] >= 0) x[global[i]] = -r[i];
    OK(VecRestoreArray(rhs, &x));
    OK(VecNorm(rhs, NORM_2, &norm));
    if (it == 0) first = norm;
    if (norm < 1e-11 * first) it = 100;
    CreateTangent(b, u, global, n, &a.A);
    OK(MechanicsTangent(b->mechanics, u, NULL, Insert, &a, &bad));
    OK(MatAssemblyBegin(a.A, MAT_FINAL_ASSEMBLY));
    OK(MatAssemblyEnd(a.A, MAT_FINAL_ASSEMBLY));
    OK(KSPCreate(PETSC_COMM_SELF, &ksp));
    OK(KSPSetOperators(ksp, a.A, a.A));
    OK(KSPSetType(ksp, KSPPREONLY));
    OK(KSPGetPC(ksp, &pc));
    OK(PCSetType(pc, PCCHOLESKY));
    OK(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    OK(KSPSolve(ksp, rhs, dx));
    OK(VecGetArray(dx, &x));
    for (PetscInt i = 0; i < v->num_nodes * v->dim; ++i)
      if (global[i] >= 0) u[i] += x[global[i]];
    OK(VecRestoreArray(dx, &x));
    OK(KSPDestroy(&ksp));
    OK(MatDestroy(&a.A));
    OK(VecDestroy(&rhs));
    OK(VecDestroy(&dx));
  }
  OK(PetscFree(r));
}

/* Small kinematics: |e|^2 = int 2 mu |dev eps(e)|^2 + (p - p_h)^2/kappa, p the mean stress, against the exact displacement gradient (or strain). */
static inline PetscReal BulkError(const Bulk *b, void (*gradient)(const PetscReal X[3], PetscReal H[9]), const PetscReal u[])
{
  const HPTables *v;
  const PetscReal mu = b->material.mu, kappa = b->material.kappa;
  PetscReal       sum = 0;

  v = HPSpaceGetTables(b->space);
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt p = v->cell_order[c], dim = v->dim;
    const Basis1D *gauss;
    PetscReal     *X, *xi, *J, *F, *P;
    PetscInt       np = 1;
    OK(Basis1DGet(p, p + 3, &gauss));
    for (PetscInt d = 0; d < dim; ++d) np *= gauss->num_points;
    OK(PetscMalloc5(3 * np, &X, np * dim, &xi, 9 * np, &J, 9 * np, &F, 9 * np, &P));
    for (PetscInt q = 0; q < np; ++q)
      for (PetscInt d = 0, i = q; d < dim; ++d, i /= gauss->num_points) xi[q * dim + d] = gauss->points[i % gauss->num_points];
    OK(MechanicsPoints(b->mechanics, c, np, xi, u, &(PointValues){.X = X, .J = J, .F = F, .P = P}));
    for (PetscInt q = 0; q < np; ++q) {
      PetscReal H[9], E[9], weight = 1, trace = 0, exact_trace, square = 0;
      for (PetscInt d = 0, i = q; d < dim; ++d, i /= gauss->num_points) weight *= gauss->weights[i % gauss->num_points];
      gradient(X + 3 * q, H);
      exact_trace = H[0] + H[4] + H[8];
      for (PetscInt i = 0; i < 3; ++i)
        for (PetscInt k = 0; k < 3; ++k) E[3 * i + k] = 0.5 * (F[9 * q + 3 * i + k] + F[9 * q + 3 * k + i] - H[3 * i + k] - H[3 * k + i]) - (i == k);
      trace = E[0] + E[4] + E[8];
      for (PetscInt k = 0; k < 9; ++k) square += 2 * mu * PetscSqr(E[k] - (k % 4 == 0 ? trace / 3 : 0));
      square += PetscSqr((P[9 * q] + P[9 * q + 4] + P[9 * q + 8]) / 3 - kappa * exact_trace) / kappa;
      sum += weight * Det3(J + 9 * q) * square;
    }
    OK(PetscFree5(X, xi, J, F, P));
  }
  return PetscSqrtReal(sum);
}
