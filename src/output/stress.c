/* Stress-like fields of a cell: sampled where the derivatives of the solution are most accurate, extended from there over the cell. */
#include "output.h"
#include <petscblaslapack.h>

void OutputCauchy(Kinematics kinematics, const PetscReal F[9], const PetscReal P[9], PetscReal sigma[6], PetscReal *J)
{
  static const PetscInt row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  const PetscReal       det = Det3(F);

  for (PetscInt k = 0; k < 6; ++k) {
    sigma[k] = kinematics == KINEMATICS_SMALL ? P[3 * row[k] + column[k]] : Dot3(P + 3 * row[k], F + 3 * column[k]) / det;
  }
  if (J) *J = kinematics == KINEMATICS_SMALL ? F[0] + F[4] + F[8] - 2 : det;
}

/* Eigenvalues w of a symmetric matrix (row-major), the largest first, and unit eigenvectors, v[k] of w[k]. */
static PetscErrorCode Principal_Private(const PetscReal A[9], PetscReal w[3], PetscReal v[3][3])
{
  PetscReal    work[32], rising[3], vectors[9];
  PetscBLASInt n = 3, size = 32, info;

  PetscFunctionBegin;
  PetscCall(PetscArraycpy(vectors, A, 9));
  PetscCallBLAS("LAPACKsyev", LAPACKsyev_("V", "U", &n, vectors, &n, rising, work, &size, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "eigenvalues of a 3-square matrix: LAPACK says %d", (int)info);
  for (PetscInt k = 0; k < 3; ++k) {
    w[k] = rising[2 - k];
    for (PetscInt i = 0; i < 3; ++i) v[k][i] = vectors[3 * (2 - k) + i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputStrain(Kinematics kinematics, const PetscReal F[9], PetscReal stretch[3], PetscReal strain[6])
{
  static const PetscInt row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  PetscReal             A[9], w[3], v[3][3];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 9; ++i) A[i] = kinematics == KINEMATICS_SMALL ? 0.5 * (F[i] + F[3 * (i % 3) + i / 3]) : Dot3(F + 3 * (i / 3), F + 3 * (i % 3));
  PetscCall(Principal_Private(A, w, v));
  for (PetscInt k = 0; k < 3; ++k) stretch[k] = kinematics == KINEMATICS_SMALL ? w[k] : PetscSqrtReal(w[k]);
  for (PetscInt c = 0; c < 6; ++c) {
    strain[c] = kinematics == KINEMATICS_SMALL ? A[3 * row[c] + column[c]] - (row[c] == column[c]) : 0;
    for (PetscInt k = 0; k < 3 && kinematics != KINEMATICS_SMALL; ++k) strain[c] += 0.5 * PetscLogReal(w[k]) * v[k][row[c]] * v[k][column[c]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tensor products of the points of a rule. */
static void Points_Private(PetscInt dim, const Basis1D *rule, PetscInt num, PetscReal xi[])
{
  const PetscInt n = rule->num_points;

  for (PetscInt i = 0; i < num; ++i) {
    const PetscInt place[3] = {i % n, i / n % n, i / (n * n)};
    for (PetscInt d = 0; d < dim; ++d) xi[i * dim + d] = rule->points[place[d]];
  }
}

PetscErrorCode OutputSampleCell(Problem problem, PetscInt cell, const PetscReal u[], PetscReal samples[])
{
  const SceneData    *scene = ProblemGetScene(problem);
  const ForestTables *t     = ForestGetTables(ProblemForest(problem));
  const HPTables     *v     = HPSpaceGetTables(ProblemSpace(problem));
  const Basis1D      *basis;
  PetscReal          *xi, *F, *P;

  PetscFunctionBegin;
  const PetscInt p = v->cell_order[cell], np = ElementNumNodes(v->dim, p - 1); /* p points in each direction */
  if (scene->mechanics.bodies[t->leaf_body[v->cell_leaf[cell]]].material->law->rigid) {
    for (PetscInt i = 0; i < 7 * np; ++i) samples[i] = i % 7 == 6;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Basis1DGet(p, p, &basis));
  PetscCall(PetscMalloc3(np * v->dim, &xi, np * 9, &F, np * 9, &P));
  Points_Private(v->dim, basis, np, xi);
  PetscCall(MechanicsPoints(ProblemMechanics(problem), cell, np, xi, u, &(PointValues){.F = F, .P = P}));
  for (PetscInt i = 0; i < np; ++i) OutputCauchy(scene->mechanics.kinematics, F + 9 * i, P + 9 * i, samples + 7 * i, samples + 7 * i + 6);
  PetscCall(PetscFree3(xi, F, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSampleQuantities(Problem problem, PetscInt cell, const PetscReal u[], PetscReal samples[])
{
  const SceneData    *scene = ProblemGetScene(problem);
  const ForestTables *t     = ForestGetTables(ProblemForest(problem));
  const HPTables     *v     = HPSpaceGetTables(ProblemSpace(problem));
  const Basis1D      *basis;
  PetscReal          *xi, *F, *P, *W;

  PetscFunctionBegin;
  const PetscInt p = v->cell_order[cell], np = ElementNumNodes(v->dim, p - 1);
  if (scene->mechanics.bodies[t->leaf_body[v->cell_leaf[cell]]].material->law->rigid) {
    for (PetscInt i = 0; i < OUTPUT_QUANTITIES * np; ++i) samples[i] = i % OUTPUT_QUANTITIES < 3;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Basis1DGet(p, p, &basis));
  PetscCall(PetscMalloc4(np * v->dim, &xi, np * 9, &F, np * 9, &P, np, &W));
  Points_Private(v->dim, basis, np, xi);
  PetscCall(MechanicsPoints(ProblemMechanics(problem), cell, np, xi, u, &(PointValues){.F = F, .P = P, .W = W}));
  for (PetscInt i = 0; i < np; ++i) {
    PetscReal *s = samples + OUTPUT_QUANTITIES * i;
    PetscCall(OutputStrain(scene->mechanics.kinematics, F + 9 * i, s, s + 3));
    s[9] = W[i];
    PetscCall(PetscArraycpy(s + 10, P + 9 * i, 9));
  }
  PetscCall(PetscFree4(xi, F, P, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSamplePlastic(Problem problem, PetscInt cell, const PetscReal u[], PetscReal samples[])
{
  const HPTables *v = HPSpaceGetTables(ProblemSpace(problem));
  const Basis1D  *basis;
  PetscReal      *xi;

  PetscFunctionBegin;
  const PetscInt p = v->cell_order[cell], np = ElementNumNodes(v->dim, p - 1);
  PetscCall(Basis1DGet(p, p, &basis));
  PetscCall(PetscMalloc1(np * v->dim, &xi));
  Points_Private(v->dim, basis, np, xi);
  PetscCall(MechanicsPlasticStrain(ProblemMechanics(problem), cell, np, xi, u, samples));
  PetscCall(PetscFree(xi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* E[node][point]: Lagrange polynomials of the p Gauss points at the points k/n. */
static void Extension_Private(PetscInt p, const PetscReal points[], PetscInt n, PetscReal E[])
{
  for (PetscInt k = 0; k <= n; ++k) {
    for (PetscInt i = 0; i < p; ++i) {
      PetscReal product = 1;
      for (PetscInt j = 0; j < p; ++j) product *= j == i ? 1 : ((PetscReal)k / n - points[j]) / (points[i] - points[j]);
      E[k * p + i] = product;
    }
  }
}

PetscErrorCode OutputExtend(PetscInt dim, PetscInt p, PetscInt pieces, PetscInt num, const PetscReal samples[], PetscReal nodal[], PetscReal work[])
{
  const Basis1D *basis;
  PetscReal      E[(MORTISE_MAX_ORDER + 1) * MORTISE_MAX_ORDER];

  PetscFunctionBegin;
  PetscCall(Basis1DGet(p, p, &basis));
  Extension_Private(p, basis->points, pieces, E);
  PetscCall(ElementTransform(dim, p, pieces + 1, num, E, samples, nodal, work));
  PetscFunctionReturn(PETSC_SUCCESS);
}
