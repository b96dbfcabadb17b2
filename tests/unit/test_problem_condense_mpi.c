/* The linear step with the nodes inside cells condensed is the one without, to 1e-12 of its largest entry, and solves the whole system to round-off: distorted
   meshes with hanging nodes, orders 1..5 at random, prescribed motion still to come, compressible and mixed laws; and cells whose inner block is indefinite,
   where the second alone is asked, since the whole matrix is close to singular too. Viscous forces: the same; its matrix is the derivative of its forces, and
   the energy it takes is their work. */
#include "mechanicsimpl.h"
#include "problemfixture.h"
#include "share.h"

/* One side moves, one is held across it, the rest is free. */
static void Create(Solved *s, PetscInt dim, PetscInt split, PetscBool mixed, uint64_t seed, const char *condense)
{
  OK(PetscOptionsSetValue(NULL, "-solve_condense", condense));
  HangingMesh(s, dim, 1, split, seed);
  BulkInit(&s->bulk, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
  BulkMaterial(&s->bulk.material, "neo_hookean", mixed ? VOLUMETRIC_SIMO : VOLUMETRIC_LOG, mixed ? FORMULATION_MIXED : FORMULATION_DISPLACEMENT, 1,
               mixed ? 50 : 8. / 3);
  for (PetscInt c = 0; c < dim; ++c) {
    s->bulk.boundaries[0].displacement[c] = BulkExpression("0.05*t*(%d+Y)", (int)c);
    s->bulk.boundaries[1].fix[c]          = PETSC_TRUE;
  }
  SolvedCreate(s, 1, 5);
  OK(ProblemSetTime(s->problem, 1));
}

/* Cells of which the inner block has been found indefinite, all ranks. */
static PetscInt Indefinite(const Solved *s)
{
  PetscInt num = 0;

  for (PetscInt g = 0; g < s->mechanics->num_groups; ++g) {
    const CellGroup *group = &s->mechanics->groups[g];
    for (PetscInt i = 0; i < group->num_cells && group->num_inner; ++i) num += group->pivot[i * group->num_inner * s->mechanics->dim] != 0;
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &num, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  return num;
}

/* One Newton step from x, with element pressures all of the given size (0: those that x implies); its matrix and right-hand side. */
static void LinearStep(Solved *s, Vec x, PetscReal pressure, Vec dx, Mat *A, Vec *rhs)
{
  ProblemStatus status;
  PetscReal    *pi = NULL;
  PetscBool     bad;
  Vec           r, lift, y;
  KSP           ksp;
  PC            pc;

  OK(PetscMalloc1(s->state.num_pressure, &pi));
  for (PetscInt i = 0; i < s->state.num_pressure; ++i) pi[i] = pressure;
  OK(VecDuplicate(x, &r));
  OK(ProblemCreateRightSide(s->problem, &lift));
  OK(VecDuplicate(lift, rhs));
  OK(VecDuplicate(lift, &y));
  OK(VecSet(lift, 0));
  OK(ProblemResidual(s->problem, x, NULL, r, &status));
  assert_false(status.bad);
  OK(ProblemTangent(s->problem, x, pressure != 0 ? pi : NULL, lift, &bad));
  assert_false(bad);
  OK(ProblemRightSide(s->problem, r, lift, *rhs));
  OK(ProblemGetMatrix(s->problem, A));
  OK(KSPCreate(PETSC_COMM_WORLD, &ksp));
  OK(KSPSetType(ksp, KSPPREONLY));
  OK(KSPSetOperators(ksp, *A, *A));
  OK(KSPGetPC(ksp, &pc));
  OK(PCSetType(pc, PCCHOLESKY));
  OK(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  OK(PetscOptionsSetValue(NULL, "-mat_mumps_icntl_14", "200")); /* beside busy processes the order of its messages, and with it the room it takes, varies */
  OK(KSPSolve(ksp, *rhs, y));
  OK(ProblemRecover(s->problem, y, dx));
  OK(KSPDestroy(&ksp));
  OK(VecDestroy(&r));
  OK(VecDestroy(&lift));
  OK(VecDestroy(&y));
  OK(PetscFree(pi));
}

static void SameStep(PetscInt dim, PetscInt split, PetscBool mixed, PetscReal pressure, PetscReal rate, uint64_t seed)
{
  Solved    s[2];
  PetscInt  rows[2], dofs, indefinite;
  PetscReal size, error, left, norm;
  Vec       x, dx[2], rhs[2];
  Mat       A[2];

  OK(PetscMemzero(s, sizeof(s)));
  Create(&s[0], dim, split, mixed, seed, "no");
  Create(&s[1], dim, split, mixed, seed, "yes");
  OK(VecDuplicate(s[0].state.x, &x));
  OK(VecSetRandom(x, NULL));
  OK(VecScale(x, 1e-3));
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDuplicate(x, &dx[k]));
    OK(ProblemSetViscosity(s[k].problem, rate, s[k].state.x));
    LinearStep(&s[k], x, pressure, dx[k], &A[k], &rhs[k]);
    OK(MatGetSize(A[k], &rows[k], NULL));
  }
  dofs = ProblemNumDofs(s[0].problem);
  assert_int_equal(rows[0], dofs);
  assert_true(rows[1] < dofs);
  OK(VecNorm(dx[0], NORM_INFINITY, &size));
  OK(MatNorm(A[0], NORM_INFINITY, &norm));
  OK(VecScale(rhs[0], -1));
  OK(MatMultAdd(A[0], dx[1], rhs[0], rhs[0]));
  OK(VecNorm(rhs[0], NORM_INFINITY, &left));
  OK(VecAXPY(dx[1], -1, dx[0]));
  OK(VecNorm(dx[1], NORM_INFINITY, &error));
  indefinite = Indefinite(&s[1]);
  if (!(left < 1e-13 * norm * size) || !(pressure != 0 || error < 1e-12 * size) || (indefinite > 0) != (pressure != 0))
    fail_msg("dim %d split %d mixed %d pressure %g seed %d: step of size %g errs by %g and leaves %g of %g, %d indefinite cells", (int)dim, (int)split, mixed,
             (double)pressure, (int)seed, (double)size, (double)error, (double)left, (double)(norm * size), (int)indefinite);
  OK(VecDestroy(&x));
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDestroy(&dx[k]));
    OK(VecDestroy(&rhs[k]));
    SolvedDestroy(&s[k]);
  }
}

static void Plane(void **state)
{
  for (PetscInt split = 1; split <= 3; ++split)
    for (uint64_t seed = 0; seed < 4; ++seed)
      if (Share(split + (PetscInt)seed + (PetscInt)seed / 2, 2)) SameStep(2, split, (PetscBool)(seed % 2), 0, 0, seed);
}

static void Space(void **state)
{
  if (Share(0, 2)) SameStep(3, 7, PETSC_FALSE, 0, 0, 1);
  if (Share(1, 2)) SameStep(3, 6, PETSC_TRUE, 0, 0, 2);
  if (Share(0, 2)) SameStep(3, 3, PETSC_FALSE, 0, 0, 3);
}

/* Large stored pressures make the geometric part of the stiffness dominate: neither definite nor singular. */
static void IndefiniteCells(void **state)
{
  for (uint64_t seed = 0; seed < 3; ++seed)
    if (Share((PetscInt)seed, 2)) SameStep(2, 3, PETSC_TRUE, 60, 0, seed);
  if (Share(1, 2)) SameStep(3, 7, PETSC_TRUE, -60, 0, 1);
}

/* Viscous forces at x: those with it less those without. */
static void ViscousForces(Solved *s, PetscReal rate, Vec from, Vec x, Vec f)
{
  ProblemStatus status;
  Vec           r;

  OK(VecDuplicate(x, &r));
  OK(ProblemSetViscosity(s->problem, 0, NULL));
  OK(ProblemResidual(s->problem, x, NULL, r, &status));
  OK(ProblemSetViscosity(s->problem, rate, from));
  OK(ProblemResidual(s->problem, x, NULL, f, &status));
  OK(VecAXPY(f, -1, r));
  OK(VecDestroy(&r));
}

/* Linear in x; no force where nothing moved; f . (x - from) is the work; f and the matrix agree. */
static void Viscous(void **state)
{
  for (PetscInt dim = 2; dim <= 3; ++dim) {
    Solved    s;
    PetscReal work, along, size, error, none;
    Vec       x, from, f, Kx, lift;
    Mat       A, B;
    PetscBool bad;

    SameStep(dim, dim == 2 ? 3 : 7, (PetscBool)(dim == 2), 0, 0.3, 5);
    OK(PetscMemzero(&s, sizeof(s)));
    Create(&s, dim, dim == 2 ? 3 : 7, PETSC_FALSE, 7, "no");
    OK(VecDuplicate(s.state.x, &x));
    OK(VecDuplicate(s.state.x, &from));
    OK(VecDuplicate(s.state.x, &f));
    OK(VecDuplicate(s.state.x, &Kx));
    OK(VecSetRandom(x, NULL));
    OK(VecScale(x, 1e-3));
    OK(VecSetRandom(from, NULL));
    OK(VecScale(from, -2e-3));
    ViscousForces(&s, 0.3, x, x, f);
    OK(VecNorm(f, NORM_INFINITY, &none));
    ViscousForces(&s, 0.3, from, x, f);
    OK(VecNorm(f, NORM_INFINITY, &size));
    OK(ProblemViscousWork(s.problem, x, &work));
    OK(ProblemCreateRightSide(s.problem, &lift));
    OK(ProblemTangent(s.problem, x, NULL, lift, &bad));
    OK(ProblemGetMatrix(s.problem, &A));
    OK(MatDuplicate(A, MAT_COPY_VALUES, &B));
    OK(ProblemSetViscosity(s.problem, 0, NULL));
    OK(ProblemTangent(s.problem, x, NULL, lift, &bad));
    OK(MatAXPY(B, -1, A, SAME_NONZERO_PATTERN));
    OK(VecAXPY(x, -1, from));
    OK(MatMult(B, x, Kx));
    OK(VecDot(f, x, &along));
    OK(VecAXPY(Kx, -1, f));
    OK(VecNorm(Kx, NORM_INFINITY, &error));
    if (!(none < 1e-12 * size) || !(error < 1e-10 * size) || !(work > 0) || !(PetscAbsReal(along - work) < 1e-10 * work))
      fail_msg("dim %d: forces %g, %g where nothing moved; their matrix errs by %g; work %g, %g", (int)dim, (double)size, (double)none, (double)error,
               (double)work, (double)along);
    OK(MatDestroy(&B));
    for (int k = 0; k < 5; ++k) OK(VecDestroy((Vec *[]){&x, &from, &f, &Kx, &lift}[k]));
    SolvedDestroy(&s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(Plane),
      cmocka_unit_test(Space),
      cmocka_unit_test(IndefiniteCells),
      cmocka_unit_test(Viscous),
  };
  int failed;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 2;
  OK(PetscOptionsHasName(NULL, NULL, "-slow", &share_all));
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
