/* Incompressible cells (kappa infinite), their pressures unknowns of the problem, on distorted meshes with hanging nodes and orders at random:
   a uniform strain without change of volume under a uniform pressure is found exactly (1e-11), whichever form the tangent has; the exact form is the derivative
   of the residual (1e-7 by central differences), the symmetric one is symmetric; the state goes to a finer mesh and stays in equilibrium there. */
#include "problemfixture.h"
#include "transfer.h"

#define MOST 125 /* points of a cell of order 4 in space */

static PetscReal worst[3]; /* error of u, of P, of the tangent */

/* F of determinant 1: in the plane a stretch and a shear. */
static void Strain(PetscInt dim, PetscReal F[9])
{
  const PetscReal stretch[2][3] = {{1.25, 0.8, 1}, {1.25, 0.9, 1 / (1.25 * 0.9)}}, shear[2][3] = {{0.2, 0, 0}, {0.2, -0.15, 0.1}};

  for (PetscInt k = 0; k < 9; ++k) F[k] = k % 4 ? 0 : stretch[dim - 2][k / 4];
  F[1] = shear[dim - 2][0];
  F[2] = shear[dim - 2][1];
  F[5] = shear[dim - 2][2];
}

/* P_iso(F) + pi cof F. */
static void Stress(const MaterialSpec *material, const PetscReal F[9], PetscReal pi, PetscReal P[9])
{
  MaterialPoints point = {.n = 1, .F = F, .P = P};

  OK(MaterialEvaluate(material, MATERIAL_ISOCHORIC, &point));
  assert_false(point.bad);
  for (PetscInt k = 0; k < 9; ++k) {
    const PetscInt i1 = (k / 3 + 1) % 3, i2 = (k / 3 + 2) % 3, J1 = (k % 3 + 1) % 3, J2 = (k % 3 + 2) % 3;
    P[k] += pi * (F[3 * i1 + J1] * F[3 * i2 + J2] - F[3 * i1 + J2] * F[3 * i2 + J1]);
  }
}

/* All sides but the one at the end of x moved as F says; there the traction of pressure pi. */
static void Create(Solved *s, PetscInt dim, PetscInt split, PetscInt low, PetscInt high, PetscReal pi, uint64_t seed)
{
  PetscReal F[9], P[9];

  HangingMesh(s, dim, 1, split, seed);
  BulkInit(&s->bulk, dim, dim == 2 ? MODEL_PLANE_STRAIN : MODEL_3D, KINEMATICS_FINITE);
  BulkMaterial(&s->bulk.material, "neo_hookean", seed % 2 ? VOLUMETRIC_SIMO : VOLUMETRIC_QUADRATIC, FORMULATION_AUTO, 1, INFINITY);
  Strain(dim, F);
  Stress(&s->bulk.material, F, pi, P);
  for (PetscInt c = 0; c < dim; ++c) {
    for (PetscInt b = 0; b < 2 * dim; ++b) {
      if (b == 1) continue;
      s->bulk.boundaries[b].displacement[c] =
          BulkExpression("%.17g*X + %.17g*Y + %.17g*Z", (double)(F[3 * c] - (c == 0)), (double)(F[3 * c + 1] - (c == 1)), (double)(F[3 * c + 2] - (c == 2)));
    }
    s->bulk.boundaries[1].traction[c] = BulkExpression("%.17g", (double)P[3 * c]);
  }
  SolvedCreate(s, low, high);
}

/* Errors of nodal displacements and of P at quadrature points. */
static void Errors(const Solved *s, PetscReal pi, PetscReal *u, PetscReal *stress)
{
  const HPTables *v = s->tables;
  PetscReal       F[9], P[9], xi[3 * MOST], weight[MOST], Fq[9 * MOST], Pq[9 * MOST], X[3 * MOST], value[3 * MOST];

  Strain(v->dim, F);
  Stress(&s->bulk.material, F, pi, P);
  *u = *stress = 0;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt np = CellGauss(v->dim, v->cell_order[c] + 1, xi, weight);
    OK(MechanicsPoints(s->mechanics, c, np, xi, s->u, &(PointValues){.F = Fq, .P = Pq}));
    for (PetscInt q = 0; q < 9 * np; ++q) *stress = PetscMax(*stress, PetscAbsReal(Pq[q] - P[q % 9]));
    OK(HPSpaceGatherPositions(s->space, c, X));
    OK(HPSpaceGather(s->space, c, s->u, value));
    for (PetscInt i = 0; i < np * v->dim; ++i) {
      PetscReal exact = -X[i];
      for (PetscInt k = 0; k < v->dim; ++k) exact += F[3 * (i % v->dim) + k] * X[i - i % v->dim + k];
      *u = PetscMax(*u, PetscAbsReal(value[i] - exact));
    }
  }
  *u      = LargestOfRanks(*u);
  *stress = LargestOfRanks(*stress);
}

static void UniformStrain(PetscInt dim, PetscInt split, PetscInt high, PetscBool symmetric, uint64_t seed)
{
  const PetscReal pi = -0.5;
  Solved          s  = {0};
  PetscReal       u, P;
  PetscInt        dofs, unknowns, ghosts;

  OK(PetscOptionsSetValue(NULL, "-solve_symmetric", symmetric ? "1" : "0"));
  Create(&s, dim, split, 2, high, pi, seed);
  dofs = ProblemNumDofs(s.problem);
  OK(MechanicsNumUnknowns(s.mechanics, &unknowns, &ghosts));
  OK(MPI_Allreduce(MPI_IN_PLACE, &unknowns, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  assert_true(unknowns > 0 && unknowns < dofs);
  assert_int_equal(s.state.num_pressure, 0);
  SolvedSolve(&s);
  assert_true(s.report.iterations <= 7);
  Errors(&s, pi, &u, &P);
  worst[0] = PetscMax(worst[0], u);
  worst[1] = PetscMax(worst[1], P);
  if (!(u < 1e-11 && P < 1e-10))
    fail_msg("dim %d split %d symmetric %d seed %d: u errs by %g, P by %g", (int)dim, (int)split, symmetric, (int)seed, (double)u, (double)P);
  SolvedDestroy(&s);
  OK(PetscOptionsClearValue(NULL, "-solve_symmetric"));
}

static void UniformPlane(void **state)
{
  for (uint64_t seed = 0; seed < 4; ++seed)
    for (PetscInt split = 1; split <= 3; ++split) UniformStrain(2, split, 4, (PetscBool)(seed % 2), seed);
}

static void UniformSpace(void **state)
{
  UniformStrain(3, 7, 3, PETSC_TRUE, 1);
  UniformStrain(3, 6, 2, PETSC_FALSE, 2);
}

static void Derivative(PetscInt dim, PetscInt split, uint64_t seed)
{
  const PetscReal h              = 3e-6;
  const Form      symmetric_form = {.symmetric = PETSC_TRUE};
  Solved          s              = {0};
  ProblemStatus   status;
  PetscBool       bad, symmetric;
  PetscReal       error, size;
  Vec             x, v, y, r[2], Av;
  Mat             A;

  Create(&s, dim, split, 1, 3, 0.5, seed);
  OK(ProblemSetTime(s.problem, 0.3));
  OK(ProblemJump(s.problem));
  OK(VecDuplicate(s.state.x, &x));
  OK(VecDuplicate(x, &v));
  OK(VecDuplicate(x, &y));
  OK(VecDuplicate(x, &Av));
  OK(VecSetRandom(x, NULL));
  OK(VecScale(x, 1e-2));
  OK(VecSetRandom(v, NULL));
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDuplicate(x, &r[k]));
    OK(VecWAXPY(y, k ? -h : h, v, x));
    OK(ProblemResidual(s.problem, y, NULL, r[k], &status));
    assert_false(status.bad);
  }
  OK(ProblemTangent(s.problem, x, NULL, NULL, &bad));
  assert_false(bad);
  OK(ProblemGetMatrix(s.problem, &A));
  OK(MatMult(A, v, Av));
  OK(VecAXPY(r[0], -1, r[1]));
  OK(VecAXPY(r[0], -2 * h, Av));
  OK(VecNorm(r[0], NORM_INFINITY, &error));
  OK(VecNorm(Av, NORM_INFINITY, &size));
  worst[2] = PetscMax(worst[2], error / (2 * h * size));
  if (!(error < 1e-7 * 2 * h * size))
    fail_msg("dim %d split %d seed %d: tangent errs by %g of %g", (int)dim, (int)split, (int)seed, (double)(error / (2 * h)), (double)size);
  OK(ProblemSetForm(s.problem, &symmetric_form));
  OK(ProblemTangent(s.problem, x, NULL, NULL, &bad));
  OK(MatIsSymmetric(A, 1e-12, &symmetric));
  assert_true(symmetric);
  OK(VecDestroy(&x));
  OK(VecDestroy(&v));
  OK(VecDestroy(&y));
  OK(VecDestroy(&Av));
  OK(VecDestroy(&r[0]));
  OK(VecDestroy(&r[1]));
  SolvedDestroy(&s);
}

static void TangentIsDerivative(void **state)
{
  for (uint64_t seed = 0; seed < 3; ++seed) Derivative(2, 1 + (PetscInt)seed, seed);
  Derivative(3, 5, 4);
}

/* The uniform strain on its mesh, then on one with every cell split, without another iteration. */
static void Transferred(void **state)
{
  const ForestTables *t;
  const PetscReal     pi = -0.5;
  Solved              s  = {0}, fine;
  ForestMap           map;
  MarkList            marks;
  ProblemStatus       status;
  PetscReal           u, P, norm;
  int8_t             *orders;
  Vec                 r;

  Create(&s, 2, 3, 2, 4, pi, 7);
  SolvedSolve(&s);
  s.state.t = 1;
  t         = ForestGetTables(s.bulk.forest);
  OK(PetscMalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) marks.split[l] = 3;
  fine = s;
  OK(ForestAdapt(s.bulk.forest, &marks, NULL, 0, NULL, &fine.bulk.forest, &map));
  MarksDestroy(&marks);
  OK(TransferOrders(&map, s.state.leaf_order, &orders));
  OK(ProblemCreate(&s.scene, fine.bulk.forest, orders, &fine.problem));
  OK(PetscFree(orders));
  fine.space     = ProblemSpace(fine.problem);
  fine.mechanics = ProblemMechanics(fine.problem);
  fine.tables    = HPSpaceGetTables(fine.space);
  OK(ProblemSetTime(fine.problem, 1));
  OK(ProblemJump(fine.problem));
  OK(StateCreate(fine.problem, &fine.state));
  OK(TransferState(s.problem, &s.state, fine.problem, &map, &fine.state));
  OK(ForestMapDestroy(&map));
  OK(ProblemCreateVector(fine.problem, &r));
  OK(ProblemResidual(fine.problem, fine.state.x, NULL, r, &status));
  OK(VecNorm(r, NORM_2, &norm));
  assert_true(norm < 1e-11 * status.scale && status.volume < 1e-12);
  OK(PetscCalloc1(fine.tables->num_nodes * fine.tables->dim, &fine.u));
  OK(ProblemLocalDisplacement(fine.problem, fine.state.x, fine.u));
  Errors(&fine, pi, &u, &P);
  assert_true(u < 1e-11 && P < 1e-10);
  OK(VecDestroy(&r));
  OK(PetscFree(fine.u));
  OK(StateDestroy(&fine.state));
  OK(ProblemDestroy(&fine.problem));
  OK(ForestDestroy(&fine.bulk.forest));
  SolvedDestroy(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(UniformPlane), cmocka_unit_test(UniformSpace), cmocka_unit_test(TangentIsDerivative),
                                     cmocka_unit_test(Transferred)};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || StageRegister()) return 1;
  OK(PetscOptionsSetValue(NULL, "-solve_rtol", "1e-13"));
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  print_message("u errs by %.1e, P by %.1e, the tangent by %.1e at most\n", (double)worst[0], (double)worst[1], (double)worst[2]);
  return PetscFinalize() || failed;
}
