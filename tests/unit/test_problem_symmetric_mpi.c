/* The symmetric part of a tangent that a follower pressure makes unsymmetric: w . S v is the mean of w . A v and v . A w for displacements, S is symmetric with
   the multipliers, too, and a shift adds that share of the rows' largest entries to the diagonal of displacements alone. Two blocks pressed on each other. */
#include "patchfixture.h"

enum { V, W, AV, AW, SV, SW, NUM };

static void SetUp(Patch *p, PetscInt order)
{
  PatchScene(p, order, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
  p->boundaries[RIGHT].fix[0] = PETSC_FALSE;
  OK(ExpressionCreate("right", "0.2", &p->boundaries[RIGHT].pressure));
  p->forest = PatchForest((const PetscInt[2]){3, 4});
  PatchStart(p);
  PatchSolve(p->problem, &p->state);
  assert_false(ProblemIsSymmetric(p->problem));
}

/* A random vector, 0 at multipliers where only displacements are asked for. */
static void Random(const Patch *p, PetscBool displacements, PetscRandom random, Vec v)
{
  PetscInt   num_u, num_z, dim, num;
  PetscReal *a;

  OK(VecSetRandom(v, random));
  ProblemGetBlocks(p->problem, &num_u, &num_z, &dim);
  OK(VecGetLocalSize(v, &num));
  OK(VecGetArray(v, &a));
  for (PetscInt i = num_u; i < num && displacements; ++i) a[i] = 0;
  OK(VecRestoreArray(v, &a));
}

static PetscReal Product(Vec a, Vec b)
{
  PetscReal product;

  OK(VecDot(a, b, &product));
  return product;
}

static void Part(void **unused)
{
  for (PetscInt order = 1; order <= 3; ++order) {
    Patch       p;
    PetscRandom random;
    PetscBool   bad, is_there;
    PetscReal   norm;
    Vec         v[NUM], scale;
    Mat         A;

    SetUp(&p, order);
    for (PetscInt k = 0; k < NUM; ++k) OK(ProblemCreateRightSide(p.problem, &v[k]));
    OK(VecDuplicate(v[0], &scale));
    OK(PetscRandomCreate(PETSC_COMM_WORLD, &random));
    for (PetscInt k = V; k <= W; ++k) Random(&p, PETSC_TRUE, random, v[k]);
    OK(ProblemTangent(p.problem, p.state.x, p.state.pressure, NULL, &bad));
    OK(ProblemGetMatrix(p.problem, &A));
    for (PetscInt k = V; k <= W; ++k) OK(MatMult(A, v[k], v[AV + k]));
    const PetscReal exact[2] = {Product(v[W], v[AV]), Product(v[V], v[AW])};
    OK(VecNorm(v[AV], NORM_2, &norm));
    assert_true(!bad && PetscAbsReal(exact[0] - exact[1]) > 1e-6 * norm);
    OK(ProblemSymmetricPart(p.problem, p.state.x, p.state.pressure, 0, &is_there));
    assert_true(is_there);
    OK(MatMult(A, v[V], v[SV]));
    assert_true(PetscAbsReal(Product(v[W], v[SV]) - (exact[0] + exact[1]) / 2) < 1e-12 * norm);
    const PetscReal plain = Product(v[V], v[SV]);
    OK(ProblemRowScale(p.problem, A, scale));
    OK(VecPointwiseMult(scale, scale, v[V]));
    OK(ProblemSymmetricPart(p.problem, p.state.x, p.state.pressure, 0.5, &is_there));
    OK(MatMult(A, v[V], v[SV]));
    assert_true(PetscAbsReal(Product(v[V], v[SV]) - plain - 0.5 * Product(v[V], scale)) < 1e-12 * norm);
    for (PetscInt k = V; k <= W; ++k) {
      Random(&p, PETSC_FALSE, random, v[k]);
      OK(MatMult(A, v[k], v[SV + k]));
    }
    assert_true(PetscAbsReal(Product(v[W], v[SV]) - Product(v[V], v[SW])) < 1e-12 * norm);
    for (PetscInt k = 0; k < NUM; ++k) OK(VecDestroy(&v[k]));
    OK(VecDestroy(&scale));
    OK(PetscRandomDestroy(&random));
    OK(ExpressionDestroy(&p.boundaries[RIGHT].pressure));
    PatchDestroy(&p);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Part)};

  if (PetscInitialize(&argc, &argv, NULL, NULL) || ErrorHandlerPush()) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
