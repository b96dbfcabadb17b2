/* Stress-like fields of a cell: sampled where the derivatives of the solution are most accurate, extended from there over the cell. */
#include "output.h"

void OutputCauchy(Kinematics kinematics, const PetscReal F[9], const PetscReal P[9], PetscReal sigma[6], PetscReal *J)
{
  static const PetscInt row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
  const PetscReal       det = Det3(F);

  for (PetscInt k = 0; k < 6; ++k) {
    sigma[k] = kinematics == KINEMATICS_SMALL ? P[3 * row[k] + column[k]] : Dot3(P + 3 * row[k], F + 3 * column[k]) / det;
  }
  if (J) *J = kinematics == KINEMATICS_SMALL ? F[0] + F[4] + F[8] - 2 : det;
}

PetscErrorCode OutputSampleCell(Problem problem, PetscInt cell, const PetscReal u[], PetscReal samples[])
{
  const SceneData    *scene;
  const ForestTables *t;
  const HPTables     *v;
  const Basis1D      *basis;
  HPSpace             space;
  Forest              forest;
  Mechanics           mechanics;
  PetscReal          *xi, *F, *P;

  PetscFunctionBegin;
  PetscCall(ProblemGetScene(problem, &scene));
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCall(ForestGetTables(forest, &t));
  PetscCall(ProblemGetSpace(problem, &space));
  PetscCall(HPSpaceGetTables(space, &v));
  const PetscInt p = v->cell_order[cell], np = ElementNumNodes(v->dim, p - 1); /* p points in each direction */
  if (scene->mechanics.bodies[t->leaf_body[v->cell_leaf[cell]]].material->law->rigid) {
    for (PetscInt i = 0; i < 7 * np; ++i) samples[i] = i % 7 == 6;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ProblemGetMechanics(problem, &mechanics));
  PetscCall(Basis1DGet(p, p, &basis));
  PetscCall(PetscMalloc3(np * v->dim, &xi, np * 9, &F, np * 9, &P));
  for (PetscInt i = 0; i < np; ++i) {
    const PetscInt place[3] = {i % p, i / p % p, i / (p * p)};
    for (PetscInt d = 0; d < v->dim; ++d) xi[i * v->dim + d] = basis->points[place[d]];
  }
  PetscCall(MechanicsPoints(mechanics, cell, np, xi, u, F, P, NULL));
  for (PetscInt i = 0; i < np; ++i) OutputCauchy(scene->mechanics.kinematics, F + 9 * i, P + 9 * i, samples + 7 * i, samples + 7 * i + 6);
  PetscCall(PetscFree3(xi, F, P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* E[node][point]: Lagrange polynomials of the p Gauss points at the p + 1 Gauss-Lobatto nodes. */
static void Extension_Private(PetscInt p, const PetscReal points[], const PetscReal nodes[], PetscReal E[])
{
  for (PetscInt n = 0; n <= p; ++n) {
    for (PetscInt i = 0; i < p; ++i) {
      PetscReal product = 1;
      for (PetscInt j = 0; j < p; ++j) product *= j == i ? 1 : (nodes[n] - points[j]) / (points[i] - points[j]);
      E[n * p + i] = product;
    }
  }
}

/* One direction after the other: before step d the array has p + 1 entries in the first d directions and p in the others. */
PetscErrorCode OutputExtend(PetscInt dim, PetscInt p, PetscInt num, const PetscReal samples[], PetscReal nodal[], PetscReal work[])
{
  const Basis1D   *basis;
  const PetscReal *from = samples;
  PetscReal        E[(MORTISE_MAX_ORDER + 1) * MORTISE_MAX_ORDER];
  PetscInt         inner = num, outer = ElementNumNodes(dim, p - 1) / p;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(p, p, &basis));
  Extension_Private(p, basis->points, basis->nodes, E);
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal *to = (dim - d) % 2 ? nodal : work; /* the last step ends in nodal */
    for (PetscInt o = 0; o < outer; ++o) {
      for (PetscInt n = 0; n <= p; ++n) {
        PetscReal *result = to + (o * (p + 1) + n) * inner;
        PetscCall(PetscArrayzero(result, inner));
        for (PetscInt i = 0; i < p; ++i) {
          const PetscReal *source = from + (o * p + i) * inner;
          for (PetscInt k = 0; k < inner; ++k) result[k] += E[n * p + i] * source[k];
        }
      }
    }
    from = to;
    inner *= p + 1;
    outer /= p;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
