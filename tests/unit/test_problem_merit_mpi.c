/* The augmented Lagrangian of contact: its gradient is the derivative of its value; its matrix, once the multipliers are eliminated, that of the gradient but
   for the small term of second derivatives of weights; at a solution with its multipliers the gradient vanishes. */
#include "patchfixture.h"

#define FACTOR 10.

static void Create(Patch *p, PetscInt order, Model model, Formulation formulation)
{
  PatchScene(p, order, model, KINEMATICS_FINITE, formulation);
  p->forest = PatchForest((const PetscInt[]){3, 4});
  PatchStart(p);
  PatchSolve(p->problem, &p->state);
}

/* A smooth direction of the displacements, other unknowns 0: of the reference positions, so that ranks agree. */
static void Direction(Problem problem, PetscReal phase, Vec v)
{
  const HPTables *t;
  PetscReal      *local;

  t = HPSpaceGetTables(ProblemSpace(problem));
  OK(PetscMalloc1(t->num_nodes * t->dim, &local));
  for (PetscInt i = 0; i < t->num_nodes * t->dim; ++i) {
    const PetscReal *X = t->X + 3 * (i / t->dim);
    local[i]           = PetscSinReal(phase + 2 * X[0] + 3 * X[1] + 5 * X[2] + (PetscReal)(i % t->dim));
  }
  OK(VecSet(v, 0));
  OK(ProblemSetDisplacement(problem, local, v));
  OK(PetscFree(local));
}

static PetscReal Merit(Problem problem, Vec lambda, Vec x, Vec gradient)
{
  ProblemStatus status;
  PetscReal     merit;

  OK(ProblemSearch(problem, x));
  OK(ProblemMerit(problem, FACTOR, lambda, x, gradient, &merit, &status));
  assert_false(status.bad);
  return merit;
}

static void Differences(PetscInt order, Model model, Formulation formulation)
{
  const PetscReal h = 1e-5;
  Patch           p;
  Vec             x, v, g, side[2], at[2], in, out, product;
  PetscReal       phi[2], slope, norm, off;
  PetscInt        num_u, num_z, dim;
  PetscBool       bad;
  Mat             A;

  Create(&p, order, model, formulation);
  OK(ProblemCreateVector(p.problem, &x));
  OK(VecDuplicate(x, &v));
  OK(VecDuplicate(x, &g));
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDuplicate(x, &side[k]));
    OK(VecDuplicate(x, &at[k]));
  }
  Direction(p.problem, 0.3, x);
  OK(VecAYPX(x, 0.01, p.state.x)); /* forces and gaps out of balance; the multipliers of lambda are the solution's */
  Direction(p.problem, 1.7, v);
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecWAXPY(at[k], k ? -h : h, v, x));
    phi[k] = Merit(p.problem, p.state.x, at[k], side[k]);
  }
  Merit(p.problem, p.state.x, x, g);
  OK(VecDot(g, v, &slope));
  OK(VecNorm(g, NORM_2, &norm));
  off = PetscAbsReal((phi[0] - phi[1]) / (2 * h) - slope) / PetscAbsReal(slope);
  print_message("order %d: |gradient| %g, slope %g, off by %g of it\n", (int)order, (double)norm, (double)slope, (double)off);
  assert_true(off < 1e-7);

  /* [u; z] moves along v: rows of multipliers vanish, rows of forces are the change of the gradient */
  OK(ProblemMeritTangent(p.problem, FACTOR, x, NULL, &bad));
  assert_false(bad);
  OK(ProblemGetMatrix(p.problem, &A));
  OK(MatCreateVecs(A, &in, &product));
  OK(VecDuplicate(in, &out));
  OK(VecAXPY(side[0], -1, side[1]));
  OK(VecAXPY(at[0], -1, at[1]));
  OK(VecScale(side[0], 1 / (2 * h)));
  OK(VecScale(at[0], 1 / (2 * h)));
  const ContactView *view;
  PetscReal         *a, *z;
  PetscBool         *own;
  view = InterfaceGetContact(ProblemInterface(p.problem), 0);
  OK(PetscMalloc2(view->nonmortar.num_nodes, &z, view->nonmortar.num_nodes, &own));
  OK(VecCopy(at[0], in));
  ProblemGetBlocks(p.problem, &num_u, &num_z, &dim);
  OK(ProblemMeritRecover(p.problem, in, x)); /* unknowns of the matrix to multipliers: c_j */
  OK(VecGetArray(in, &a));
  const PetscReal *scaled;
  OK(VecGetArrayRead(x, &scaled));
  for (PetscInt i = num_u; i < num_u + num_z; ++i) a[i] = scaled[i] != 0 ? a[i] * a[i] / scaled[i] : 0;
  OK(VecRestoreArrayRead(x, &scaled));
  OK(VecRestoreArray(in, &a));
  OK(MatMult(A, in, product));
  OK(VecCopy(side[0], out));
  OK(VecNorm(out, NORM_2, &norm));
  OK(VecAXPY(product, -1, out));
  OK(VecNorm(product, NORM_2, &off));
  print_message("         matrix: off by %g\n", (double)(off / norm));
  assert_true(off < 2e-3 * norm);
  OK(PetscFree2(z, own));
  OK(VecDestroy(&in));
  OK(VecDestroy(&out));
  OK(VecDestroy(&product));
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDestroy(&side[k]));
    OK(VecDestroy(&at[k]));
  }
  OK(VecDestroy(&g));
  OK(VecDestroy(&v));
  OK(VecDestroy(&x));
  PatchDestroy(&p);
}

static void Derivatives(void **state)
{
  Differences(1, MODEL_PLANE_STRAIN, FORMULATION_DISPLACEMENT);
  Differences(2, MODEL_PLANE_STRAIN, FORMULATION_AUTO);
  Differences(2, MODEL_AXISYMMETRIC, FORMULATION_MIXED);
}

static void VanishesAtSolution(void **state)
{
  Patch         p;
  Vec           x, g;
  PetscReal     norm, merit;
  ProblemStatus status;

  Create(&p, 2, MODEL_PLANE_STRAIN, FORMULATION_AUTO);
  OK(ProblemCreateVector(p.problem, &x));
  OK(VecDuplicate(x, &g));
  OK(VecCopy(p.state.x, x));
  OK(ProblemSearch(p.problem, x));
  OK(ProblemMerit(p.problem, FACTOR, p.state.x, x, g, &merit, &status));
  OK(VecNorm(g, NORM_2, &norm));
  assert_true(norm < 1e-9 * status.scale);
  OK(VecAXPY(x, -1, p.state.x));
  OK(VecNorm(x, NORM_2, &norm));
  assert_true(norm < 1e-9);
  OK(VecDestroy(&x));
  OK(VecDestroy(&g));
  PatchDestroy(&p);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Derivatives), cmocka_unit_test(VanishesAtSolution)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
