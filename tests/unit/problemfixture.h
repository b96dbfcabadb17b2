/* A whole bulk problem in memory: a body on an adapted box (bulkfixture.h), no contact, solved by Problem and Solver on all ranks. */
#pragma once
#include "bulkfixture.h"
#include "solve.h"

typedef struct {
  Bulk            bulk; /* its forest, material, spec and boundaries; space and mechanics are the problem's */
  SceneData       scene;
  Problem         problem;
  Solver          solver;
  State           state;
  SolverReport    report;
  HPSpace         space;
  Mechanics       mechanics;
  const HPTables *tables;
  PetscReal      *u; /* local displacements of the solution */
} Solved;

/* The problem, before it is solved; orders random in low..high. s->bulk.forest, material and boundaries must be set. */
static inline void SolvedCreate(Solved *s, PetscInt low, PetscInt high)
{
  const ForestTables *t;

  t = ForestGetTables(s->bulk.forest);
  OK(PetscMalloc1(t->num_leaves, &s->bulk.orders));
  for (PetscInt l = 0; l < t->num_leaves; ++l) s->bulk.orders[l] = (int8_t)(low + BoxRandom(high - low + 1));
  s->scene.mechanics  = s->bulk.spec;
  s->scene.bodies     = &s->bulk.body;
  s->scene.boundaries = s->bulk.boundaries;
  s->scene.load       = (LoadSpec){.end = 1, .step = 1, .control = s->scene.load.control};
  OK(ProblemCreate(&s->scene, s->bulk.forest, s->bulk.orders, &s->problem));
  s->space     = ProblemSpace(s->problem);
  s->mechanics = ProblemMechanics(s->problem);
  s->tables    = HPSpaceGetTables(s->space);
  OK(ProblemSetTime(s->problem, 0));
  OK(ProblemJump(s->problem));
  OK(SolverCreate(s->problem, &s->solver));
  OK(StateCreate(s->problem, &s->state));
  OK(PetscCalloc1(s->tables->num_nodes * s->tables->dim, &s->u));
}

/* Equilibrium at t = 1 from the state as it is. */
static inline void SolvedSolve(Solved *s)
{
  OK(ProblemSetTime(s->problem, 1));
  OK(SolverSolve(s->solver, &s->state, &s->report));
  if (!s->report.converged) fail_msg("no equilibrium: %s", s->report.reason);
  OK(ProblemLocalDisplacement(s->problem, s->state.x, s->u));
}

static inline void SolvedDestroy(Solved *s)
{
  OK(PetscFree(s->u));
  OK(StateDestroy(&s->state));
  OK(SolverDestroy(&s->solver));
  OK(ProblemDestroy(&s->problem));
  OK(PetscFree(s->bulk.orders));
  OK(ForestDestroy(&s->bulk.forest));
  while (bulk_num_expressions) OK(ExpressionDestroy(&bulk_expressions[--bulk_num_expressions]));
}

/* Split one leaf (of any rank), or all of them (leaf -1). */
static inline void SplitLeaf(Forest *forest, PetscInt leaf, PetscInt split)
{
  const ForestTables *t;
  MarkList            marks;

  t = ForestGetTables(*forest);
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) marks.split[l] = (int8_t)(leaf < 0 || l == leaf ? split : 0);
  AdaptBy(forest, &marks);
}

/* Corner cell and one of its children split, on 2^dim rotated, distorted cells of geometry order q. */
static inline void HangingMesh(Solved *s, PetscInt dim, PetscInt q, PetscInt split, uint64_t seed)
{
  const ForestTables *t;
  Box                 box;

  box_distorted  = PETSC_TRUE;
  s->bulk.forest = BoxForest(PETSC_COMM_WORLD, dim, (const PetscInt[3]){2, 2, 2}, q, 0, seed, &box);
  box_distorted  = PETSC_FALSE;
  SplitLeaf(&s->bulk.forest, 0, split);
  SplitLeaf(&s->bulk.forest, BoxRandom(2), split);
  t = ForestGetTables(s->bulk.forest);
  assert_true(t->num_leaves > 1 << dim);
}

static inline PetscReal LargestOfRanks(PetscReal value)
{
  OK(MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  return value;
}

/* Errors of orders 1..num on one mesh: each order divides them by 4 at least, and their logarithm is off a straight line by less than its fall an order. */
static inline void CheckExponential(PetscInt num, const PetscReal error[])
{
  const PetscReal middle = (num - 1) / 2.;
  PetscReal       mean = 0, moment = 0, square = 0, slope;

  for (PetscInt i = 0; i < num; ++i) {
    if (i > 0 && !(error[i] < error[i - 1] / 4)) fail_msg("order %d divides the error by %g only", (int)i + 1, (double)(error[i - 1] / error[i]));
    mean += PetscLogReal(error[i]) / num;
    moment += (i - middle) * PetscLogReal(error[i]);
    square += PetscSqr(i - middle);
  }
  slope = moment / square;
  for (PetscInt i = 0; i < num; ++i) {
    const PetscReal off = PetscLogReal(error[i]) - mean - slope * (i - middle);
    print_message("p %d: log error off the line by %.2f of its fall of %.2f an order\n", (int)i + 1, (double)off, (double)-slope);
    assert_true(PetscAbsReal(off) < -slope);
  }
}

/* The tensor Gauss points of a cell with `num` points in each direction: xi[num^dim][dim], weights. Returns their number. */
static inline PetscInt CellGauss(PetscInt dim, PetscInt num, PetscReal xi[], PetscReal weight[])
{
  const Basis1D *gauss;
  PetscInt       points = 1;

  OK(Basis1DGet(1, num, &gauss));
  for (PetscInt d = 0; d < dim; ++d) points *= num;
  for (PetscInt q = 0; q < points; ++q) {
    weight[q] = 1;
    for (PetscInt d = 0, i = q; d < dim; ++d, i /= num) {
      xi[q * dim + d] = gauss->points[i % num];
      weight[q] *= gauss->weights[i % num];
    }
  }
  return points;
}
