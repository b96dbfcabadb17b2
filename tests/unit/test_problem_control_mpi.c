/* Pressures that are found and paths: the enclosed volume and its gradient, the rows and columns they bring into the tangent. Distorted meshes with hanging
   nodes, orders 1..4 at random, in the plane, axisymmetric and in space. */
#include "problemfixture.h"

static const Model models[] = {MODEL_PLANE_STRAIN, MODEL_AXISYMMETRIC, MODEL_3D};

static PetscInt Dim(Model model)
{
  return model == MODEL_3D ? 3 : 2;
}

static void Mesh(Solved *s, Model model, uint64_t seed)
{
  Box box;

  OK(PetscMemzero(s, sizeof(*s)));
  box_distorted  = (PetscBool)(model != MODEL_AXISYMMETRIC);
  s->bulk.forest = BoxForest(PETSC_COMM_WORLD, Dim(model), (const PetscInt[3]){2, 2, 2}, 1, 0, seed, &box);
  box_distorted  = PETSC_FALSE;
  SplitLeaf(&s->bulk.forest, 0, (1 << Dim(model)) - 1);
  SplitLeaf(&s->bulk.forest, 1, 1);
  BulkInit(&s->bulk, Dim(model), model, KINEMATICS_FINITE);
  BulkMaterial(&s->bulk.material, "neo_hookean", VOLUMETRIC_LOG, FORMULATION_DISPLACEMENT, 1, 2);
}

/* Every side of the box follows a volume; together they are closed. */
static void AllSides(Solved *s, Model model, uint64_t seed)
{
  Mesh(s, model, seed);
  for (PetscInt b = 0; b < 2 * Dim(model); ++b) s->bulk.boundaries[b].volume = BulkExpression("t");
  SolvedCreate(s, 1, 4);
}

/* Sum of all controls at u over all ranks; gradient and force (local arrays, this rank's part), NULL: skip. */
static PetscReal Sum(const Solved *s, const PetscReal u[], PetscReal gradient[], PetscReal force[])
{
  const PetscInt *boundary;
  PetscInt        num;
  PetscReal       sum = 0;

  OK(MechanicsGetControls(s->mechanics, &num, &boundary));
  for (PetscInt k = 0; k < num; ++k) {
    PetscReal value;
    OK(MechanicsControl(s->mechanics, k, u, &value, gradient, force));
    sum += value;
  }
  OK(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

/* The box turned inside out to a point gives its volume; x = A X + b then changes what its outside encloses by (1 - det A) of it. */
static void AffineVolumesAreExact(void **state)
{
  const PetscReal A[9] = {1.3, 0.2, -0.1, 0.1, 0.8, 0.3, 0.2, -0.2, 1.1};

  for (PetscInt m = 0; m < 3; ++m) {
    const PetscInt  dim  = Dim(models[m]);
    const PetscReal B[9] = {A[0],
                            dim == 3 || m == 0 ? A[1] : 0,
                            dim == 3 ? A[2] : 0,
                            m == 1 ? 0 : A[3],
                            A[4],
                            dim == 3 ? A[5] : 0,
                            dim == 3 ? A[6] : 0,
                            dim == 3 ? A[7] : 0,
                            dim == 3 ? A[8] : 1};
    const PetscReal det  = m == 1 ? B[0] * B[0] * B[4] : Det3(B);
    Solved          s;
    AllSides(&s, models[m], (uint64_t)m + 3);
    for (PetscInt i = 0; i < s.tables->num_nodes * dim; ++i) s.u[i] = -s.tables->X[3 * (i / dim) + i % dim];
    const PetscReal volume = Sum(&s, s.u, NULL, NULL);
    assert_true(volume > 0.5);
    for (PetscInt i = 0; i < s.tables->num_nodes * dim; ++i) {
      const PetscReal *X = s.tables->X + 3 * (i / dim);
      s.u[i]             = (models[m] == MODEL_AXISYMMETRIC && i % dim == 0 ? 0 : 0.3) + Dot3(B + 3 * (i % dim), X) - X[i % dim];
    }
    assert_near(Sum(&s, s.u, NULL, NULL), (1 - det) * volume, 1e-12 * volume);
    SolvedDestroy(&s);
  }
}

/* Is the largest entry of |a + share b| below bound, over all ranks? Local arrays hold parts of sums: they are added up first. */
static PetscReal Largest(const Solved *s, const PetscReal a[], const PetscReal b[])
{
  const PetscInt n = s->tables->num_nodes * s->tables->dim;
  PetscReal      largest;
  Vec            local, global;
  PetscReal     *array;
  DM             dm;

  dm = HPSpaceGetDM(s->space);
  OK(VecCreateSeq(PETSC_COMM_SELF, n, &local));
  OK(VecGetArray(local, &array));
  for (PetscInt i = 0; i < n; ++i) array[i] = a[i] + (b ? b[i] : 0);
  OK(VecRestoreArray(local, &array));
  OK(DMCreateGlobalVector(dm, &global));
  OK(VecSet(global, 0));
  OK(DMLocalToGlobalBegin(dm, local, ADD_VALUES, global));
  OK(DMLocalToGlobalEnd(dm, local, ADD_VALUES, global));
  OK(VecNorm(global, NORM_INFINITY, &largest));
  OK(VecDestroy(&local));
  OK(VecDestroy(&global));
  return largest;
}

/* Random displacement, the same whatever the ranks: a polynomial of the place. */
static void Bend(const Solved *s, PetscReal size, PetscReal u[])
{
  const PetscInt dim = s->tables->dim;

  for (PetscInt i = 0; i < s->tables->num_nodes * dim; ++i) {
    const PetscReal *X = s->tables->X + 3 * (i / dim);
    const PetscInt   c = i % dim;
    u[i]               = size * (0.3 * c + X[0] * X[1] - 0.7 * X[(c + 1) % dim] * X[(c + 1) % dim] + 0.4 * X[0] * X[0] * (dim == 3 ? X[2] : 1));
    if (s->bulk.spec.model == MODEL_AXISYMMETRIC && c == 0) u[i] *= X[0];
  }
}

/* On a closed surface the gradient of the volume is minus the force of a unit pressure, whatever the displacement; of one side alone it is not. */
static void ClosedSurfacesAreSymmetric(void **state)
{
  for (PetscInt m = 0; m < 3; ++m) {
    const PetscInt dim = Dim(models[m]);
    PetscReal     *gradient, *force;
    Solved         s;
    AllSides(&s, models[m], (uint64_t)m + 5);
    const PetscInt n = s.tables->num_nodes * dim;
    OK(PetscCalloc2(n, &gradient, n, &force));
    Bend(&s, 0.2, s.u);
    (void)Sum(&s, s.u, gradient, force);
    assert_true(Largest(&s, gradient, force) < 1e-13 * Largest(&s, force, NULL) + 1e-14);
    for (PetscInt k = 0; k < 2; ++k) {
      PetscReal value;
      OK(PetscArrayzero(k ? force : gradient, n));
      OK(MechanicsControl(s.mechanics, 2, s.u, &value, k ? NULL : gradient, k ? force : NULL));
    }
    assert_true(Largest(&s, gradient, force) > 1e-3 * Largest(&s, force, NULL));
    OK(PetscFree2(gradient, force));
    SolvedDestroy(&s);
  }
}

/* Tangent times a random direction against differences of the residual, scalars included. */
static void CheckTangent(Solved *s, const char *what)
{
  const PetscReal h = 1e-6;
  PetscReal       error, size;
  ProblemStatus   status;
  PetscBool       bad;
  Vec             x, d, r[2], Ad;
  Mat             A;

  OK(VecDuplicate(s->state.x, &x));
  OK(VecDuplicate(x, &d));
  OK(VecDuplicate(x, &Ad));
  OK(VecSetRandom(d, NULL));
  OK(ProblemTangent(s->problem, s->state.x, NULL, NULL, &bad));
  assert_false(bad);
  OK(ProblemGetMatrix(s->problem, &A));
  OK(MatMult(A, d, Ad));
  for (PetscInt k = 0; k < 2; ++k) {
    OK(VecDuplicate(x, &r[k]));
    OK(VecWAXPY(x, k ? h : -h, d, s->state.x));
    OK(ProblemResidual(s->problem, x, NULL, r[k], &status));
    assert_false(status.bad);
  }
  OK(VecAXPY(r[1], -1, r[0]));
  OK(VecScale(r[1], 1 / (2 * h)));
  OK(VecNorm(Ad, NORM_INFINITY, &size));
  OK(VecAXPY(r[1], -1, Ad));
  OK(VecNorm(r[1], NORM_INFINITY, &error));
  if (!(error < 1e-8 * size)) fail_msg("%s: the tangent is off by %g of %g", what, (double)error, (double)size);
  for (PetscInt k = 0; k < 2; ++k) OK(VecDestroy(&r[k]));
  OK(VecDestroy(&x));
  OK(VecDestroy(&d));
  OK(VecDestroy(&Ad));
}

/* One side follows a volume, another advances, a third is held in a skew direction as far as it is flat; the path likewise with given loads. */
static void TangentsAreExact(void **state)
{
  OK(PetscOptionsSetValue(NULL, "-solve_condense", "no")); /* the whole matrix */
  for (PetscInt m = 0; m < 3; ++m) {
    for (PetscInt path = 0; path < 3; ++path) { /* pressures found; time held; along a path */
      PetscReal values[2] = {0.4, -0.3}, length;
      Solved    s;
      Vec       from;
      Mesh(&s, models[m], (uint64_t)m + 7);
      if (path) {
        s.scene.load.control             = LOAD_ARC_LENGTH;
        s.bulk.boundaries[1].pressure    = BulkExpression("0.3*t*(1+t)+0.1*X");
        s.bulk.boundaries[2].traction[0] = BulkExpression("0.2*t");
        s.bulk.body.force[1]             = BulkExpression("0.5*t*X");
      } else {
        s.bulk.boundaries[1].volume  = BulkExpression("0.1*t");
        s.bulk.boundaries[2].advance = BulkExpression("0.05*t");
      }
      for (PetscInt c = 0; c < 3; ++c) s.bulk.boundaries[0].fix[c] = PETSC_TRUE; /* a body that is free in some way has a tangent of its own */
      s.bulk.boundaries[3].fix_normal = PETSC_TRUE;
      SolvedCreate(&s, 1, 4);
      OK(ProblemSetTime(s.problem, 1));
      Bend(&s, 0.02, s.u);
      OK(ProblemSetDisplacement(s.problem, s.u, s.state.x));
      OK(VecDuplicate(s.state.x, &from));
      OK(ProblemSetScalars(s.problem, values, s.state.x));
      if (path == 2) OK(ProblemFollow(s.problem, from, s.state.x, &length));
      if (path == 2) ProblemAdvance(s.problem, 0.7 * length);
      CheckTangent(&s, path == 0 ? "pressures found" : path == 1 ? "time held" : "along a path");
      OK(VecDestroy(&from));
      SolvedDestroy(&s);
    }
  }
}

/* The volume is reached, the mean displacement too, and the pressures work: they are what a run under those pressures leads to. */
static void TargetsAreReached(void **state)
{
  PetscReal pressure[2], value[2];
  Solved    s[2];

  OK(PetscOptionsSetValue(NULL, "-solve_condense", "yes"));
  for (PetscInt given = 0; given < 2; ++given) {
    Mesh(&s[given], MODEL_3D, 11);
    BoundarySpec *b = s[given].bulk.boundaries;
    b[0].fix[0] = b[0].fix[1] = b[0].fix[2] = PETSC_TRUE;
    if (given) {
      b[1].pressure = BulkExpression("%.17g", (double)pressure[0]);
      b[4].pressure = BulkExpression("%.17g", (double)pressure[1]);
    } else {
      b[1].volume  = BulkExpression("-0.06*t");
      b[4].advance = BulkExpression("0.02*t");
    }
    SolvedCreate(&s[given], 1, 3);
    SolvedSolve(&s[given]);
    if (!given) OK(ProblemGetControls(s[0].problem, s[0].state.x, pressure, value));
  }
  assert_near(value[0], -0.06, 1e-11);
  assert_near(value[1], 0.02, 1e-11);
  assert_true(PetscAbsReal(pressure[0]) > 1e-3 && PetscAbsReal(pressure[1]) > 1e-3);
  for (PetscInt i = 0; i < s[0].tables->num_nodes * 3; ++i) assert_near(s[0].u[i], s[1].u[i], 1e-9);
  SolvedDestroy(&s[1]);
  SolvedDestroy(&s[0]);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(AffineVolumesAreExact),
      cmocka_unit_test(ClosedSurfacesAreSymmetric),
      cmocka_unit_test(TangentsAreExact),
      cmocka_unit_test(TargetsAreReached),
  };
  int failed;
  if (PetscInitializeNoArguments()) return 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
