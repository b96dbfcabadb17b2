/* Residual and tangent are functions of x and of the form, whatever was evaluated or chosen in between, and whatever is
   chosen for tangents alone leaves the residual as it is. Two blocks pressed on each other, at random displacements
   near their solution. */
#include "patchfixture.h"

typedef struct {
  Patch p;
  Vec   x[2], r[2], v, y[2];
} Setup;

static void Create(Setup *s, PetscInt order)
{
  PetscRandom random;

  PatchScene(&s->p, order, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
  s->p.forest = PatchForest((const PetscInt[2]){3, 4});
  PatchStart(&s->p);
  PatchSolve(s->p.problem, &s->p.state);
  OK(PetscRandomCreate(PETSC_COMM_WORLD, &random));
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDuplicate(s->p.state.x, &s->x[k]));
    OK(VecDuplicate(s->p.state.x, &s->r[k]));
    OK(VecSetRandom(s->x[k], random));
    OK(VecAYPX(s->x[k], 1e-3, s->p.state.x));
    OK(ProblemCreateRightSide(s->p.problem, &s->y[k]));
  }
  OK(VecDuplicate(s->y[0], &s->v));
  OK(VecSetRandom(s->v, random));
  OK(PetscRandomDestroy(&random));
  OK(ProblemSearch(s->p.problem, s->x[0]));
}

static void Destroy(Setup *s)
{
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDestroy(&s->x[k]));
    OK(VecDestroy(&s->r[k]));
    OK(VecDestroy(&s->y[k]));
  }
  OK(VecDestroy(&s->v));
  PatchDestroy(&s->p);
}

/* Residual at x[k] to r, and the tangent there times v to y. */
static void Evaluate(Setup *s, const Form *form, PetscInt k, Vec r, Vec y)
{
  ProblemStatus status;
  PetscBool     bad;
  Mat           A;

  OK(ProblemSetForm(s->p.problem, form));
  OK(ProblemResidual(s->p.problem, s->x[k], NULL, r, &status));
  OK(ProblemTangent(s->p.problem, s->x[k], NULL, NULL, &bad));
  assert_false(status.bad || bad);
  OK(ProblemGetMatrix(s->p.problem, &A));
  OK(MatMult(A, s->v, y));
}

static PetscReal Difference(Vec a, Vec b)
{
  PetscReal size, difference;

  OK(VecNorm(b, NORM_2, &size));
  OK(VecAXPY(a, -1, b));
  OK(VecNorm(a, NORM_2, &difference));
  assert_true(size > 0);
  return difference / size;
}

static void NothingIsRemembered(void **unused)
{
  const Form plain = FormPlain(PETSC_FALSE), others[] = {{.released = 1},
                                                         {.frozen_normals = 1},
                                                         {.symmetric = PETSC_TRUE},
                                                         {.proximal = 1},
                                                         {.untouched = 1},
                                                         {.warm_start = 1},
                                                         {.untouched = 1, .pressures_first = PETSC_TRUE}};

  for (PetscInt order = 1; order <= 2; ++order) {
    Setup s;
    Create(&s, order);
    Evaluate(&s, &plain, 0, s.r[0], s.y[0]);
    for (size_t i = 0; i < sizeof(others) / sizeof(others[0]); ++i) {
      Evaluate(&s, &others[i], 1, s.r[1], s.y[1]);
      Evaluate(&s, &plain, 0, s.r[1], s.y[1]);
      assert_true(Difference(s.r[1], s.r[0]) == 0 && Difference(s.y[1], s.y[0]) < 1e-14);
    }
    Destroy(&s);
  }
}

/* Released: no contact in the tangent. Frozen normals: another tangent. The residual is the same with all of them. */
static void TangentsChangeResidualsDoNot(void **unused)
{
  const Form plain = FormPlain(PETSC_FALSE), others[] = {{.released = 1}, {.frozen_normals = 1}, {.symmetric = PETSC_TRUE}};
  Setup      s;

  Create(&s, 2);
  Evaluate(&s, &plain, 0, s.r[0], s.y[0]);
  for (size_t i = 0; i < sizeof(others) / sizeof(others[0]); ++i) {
    Evaluate(&s, &others[i], 0, s.r[1], s.y[1]);
    assert_true(Difference(s.r[1], s.r[0]) == 0 && Difference(s.y[1], s.y[0]) > 1e-6);
  }
  Destroy(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NothingIsRemembered), cmocka_unit_test(TangentsChangeResidualsDoNot)};

  if (PetscInitialize(&argc, &argv, NULL, NULL) || ErrorHandlerPush()) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
