/* A solved contact patch through all that reports it: two blocks with meshes that do not match, pressed by 5 %, uniform state known in closed form.
   Balances, probes and the written fields must all show it, on any number of ranks, for order 1 (shared points) and 2 (points of their own). */
#include "output.h"
#include "solve.h"
#include <hdf5.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "directory.h"
#include "near.h"

#define OK(call) assert_int_equal((call), 0)
#define LOWER 3 /* cells in a row below; above: 5 */
#define UPPER 5

enum { BOTTOM, TOP, LEFT, RIGHT, LOWER_TOP, UPPER_BOTTOM, NUM_GROUPS };

static PetscMPIInt rank;

/* O-01 energy NHq at F = diag(1, 0.95, 1), E = 1, nu = 0.3 */
static const PetscReal J = 0.95, mu = 1 / 2.6, kappa = 1 / 1.2;
static PetscReal       Sigma(PetscInt axis)
{
  const PetscReal b = axis == 1 ? J * J : 1;
  return kappa * (J - 1) + mu * PetscPowReal(J, -5. / 3) * (b - (2 + J * J) / 3);
}

/* ---- the scene ---------------------------------------------------------------------------------------------------------------- */

typedef struct {
  SceneData    data;
  MaterialSpec material;
  BodySpec     bodies[2];
  BoundarySpec boundaries[NUM_GROUPS];
  ContactSpec  contact;
  ProbeSpec    probes[2];
} TestScene;

/* Blocks [0,2] x [0,1] and [0,2] x [1,2]. */
static Forest Blocks(void)
{
  CoarseMesh mesh = {.dim = 2, .geometry_order = 1, .num_bodies = 2, .num_boundaries = NUM_GROUPS, .num_cells = LOWER + UPPER};
  PetscInt   facets[2 * (2 * (LOWER + UPPER) + 4)], num = 0, cell = 0, vertex = 0;
  uint64_t   groups[2 * (LOWER + UPPER) + 4];
  Forest     forest;

  mesh.num_vertices = 2 * (LOWER + UPPER + 2);
  OK(PetscMalloc1(4 * mesh.num_cells, &mesh.cell_vertices));
  OK(PetscMalloc1(12 * mesh.num_cells, &mesh.cell_geometry));
  OK(PetscMalloc1(mesh.num_cells, &mesh.cell_body));
  OK(PetscCalloc1(2, &mesh.body_name));
  OK(PetscCalloc1(NUM_GROUPS, &mesh.boundary_name));
  for (PetscInt body = 0; body < 2; ++body) {
    const PetscInt n = body ? UPPER : LOWER;
    for (PetscInt i = 0; i < n; ++i, ++cell) {
      mesh.cell_body[cell] = body;
      for (PetscInt k = 0; k < 4; ++k) {
        mesh.cell_vertices[4 * cell + k]          = vertex + i + (k & 1) + (n + 1) * (k >> 1);
        mesh.cell_geometry[12 * cell + 3 * k]     = 2. * (PetscReal)(i + (k & 1)) / (PetscReal)n;
        mesh.cell_geometry[12 * cell + 3 * k + 1] = (PetscReal)(body + (k >> 1));
        mesh.cell_geometry[12 * cell + 3 * k + 2] = 0;
      }
      for (PetscInt high = 0; high < 2; ++high, ++num) {
        facets[2 * num]     = vertex + i + (n + 1) * high;
        facets[2 * num + 1] = facets[2 * num] + 1;
        groups[num]         = (uint64_t)1 << (body ? (high ? TOP : UPPER_BOTTOM) : (high ? LOWER_TOP : BOTTOM));
      }
    }
    for (PetscInt right = 0; right < 2; ++right, ++num) {
      facets[2 * num]     = vertex + n * right;
      facets[2 * num + 1] = facets[2 * num] + n + 1;
      groups[num]         = (uint64_t)1 << (right ? RIGHT : LEFT);
    }
    vertex += 2 * (n + 1);
  }
  OK(ForestCreateFromCoarse(PETSC_COMM_WORLD, &mesh, num, facets, groups, 1, &forest));
  return forest;
}

static void SceneMake(TestScene *s, PetscInt order)
{
  static const char *const group[NUM_GROUPS] = {"bottom", "top", "left", "right", "lower_top", "upper_bottom"};
  const char *const        names[]           = {"E", "nu"};
  const PetscReal          values[]          = {1, 0.3};

  memset(s, 0, sizeof(*s));
  s->material.law = MaterialLawFind("neo_hookean");
  strcpy(s->material.name, "rubber");
  OK(MaterialSetUp(&s->material, 2, names, values));
  for (PetscInt b = 0; b < 2; ++b) {
    s->bodies[b].material = &s->material;
    s->bodies[b].order    = order;
  }
  for (PetscInt g = 0; g < NUM_GROUPS; ++g) {
    strcpy(s->boundaries[g].name, group[g]);
    s->boundaries[g].group = g;
  }
  s->boundaries[BOTTOM].fix[1] = s->boundaries[LEFT].fix[0] = s->boundaries[RIGHT].fix[0] = PETSC_TRUE;
  OK(ExpressionCreate("top", "-0.1", &s->boundaries[TOP].displacement[1]));
  s->contact        = (ContactSpec){.name = "pair", .nonmortar = UPPER_BOTTOM, .mortar = LOWER_TOP};
  s->probes[0]      = (ProbeSpec){.name = "low", .X = {0.7, 0.3, 0}};
  s->probes[1]      = (ProbeSpec){.name = "high", .X = {2, 1.5, 0}};
  s->data           = (SceneData){.file         = "patch.yml",
                                  .mesh         = {.dim = 2},
                                  .num_contacts = 1,
                                  .contacts     = &s->contact,
                                  .bodies       = s->bodies,
                                  .boundaries   = s->boundaries,
                                  .num_probes   = 2,
                                  .probes       = s->probes,
                                  .load         = {.end = 1, .step = 1},
                                  .output       = {.fields = PETSC_TRUE, .segments = PETSC_TRUE}};
  s->data.mechanics = (MechanicsSpec){.num_bodies = 2, .bodies = s->bodies, .num_boundaries = NUM_GROUPS, .boundaries = s->boundaries};
  strcpy(s->data.output.directory, directory);
}

/* ---- what was written --------------------------------------------------------------------------------------------------------- */

/* All of /grid/name as numbers; returns the number of rows. */
static PetscInt ReadField(const char *grid, const char *name, PetscInt *components, double **values)
{
  char    path[PETSC_MAX_PATH_LEN];
  hsize_t dims[2] = {0, 1};

  snprintf(path, sizeof(path), "%s/fields_0000.h5", directory);
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(file >= 0);
  snprintf(path, sizeof(path), "/%s/%s", grid, name);
  const hid_t data = H5Dopen(file, path, H5P_DEFAULT), space = H5Dget_space(data);
  assert_true(data >= 0);
  assert_true(H5Sget_simple_extent_ndims(space) <= 2);
  H5Sget_simple_extent_dims(space, dims, NULL);
  *values = calloc(dims[0] * dims[1] + 1, sizeof(double));
  assert_true(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, *values) >= 0);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(file);
  *components = (PetscInt)dims[1];
  return (PetscInt)dims[0];
}

/* A component of a field has one value everywhere. */
static void Uniform(const char *grid, const char *name, PetscInt rows, PetscInt component, PetscReal value, PetscReal tolerance)
{
  PetscInt components;
  double  *v;

  assert_int_equal(ReadField(grid, name, &components, &v), rows);
  for (PetscInt i = 0; i < rows; ++i) assert_near(v[i * components + component], value, tolerance);
  free(v);
}

static void CheckFields(PetscInt order)
{
  const PetscInt leaves = 4 * (LOWER + UPPER), pieces = leaves * order * order;
  PetscInt       components, points;
  double        *X, *u, *conn, area = 0;

  points = ReadField("bulk", "X", &components, &X);
  if (order > 1)
    assert_int_equal(points, leaves * (order + 1) * (order + 1));
  else
    assert_true(points < 2 * leaves + 40); /* shared within a rank */
  assert_int_equal(ReadField("bulk", "displacement", &components, &u), points);
  for (PetscInt i = 0; i < points; ++i) {
    assert_near(u[3 * i], 0, 1e-9);
    assert_near(u[3 * i + 1], -0.05 * X[3 * i + 1], 1e-9);
  }
  assert_int_equal(ReadField("bulk", "cells", &components, &conn), pieces);
  for (PetscInt c = 0; c < pieces; ++c) {
    /* the writer stores corners around the cell: shoelace */
    for (PetscInt k = 0; k < 4; ++k) {
      const double *a = X + 3 * (PetscInt)conn[4 * c + k], *b = X + 3 * (PetscInt)conn[4 * c + (k + 1) % 4];
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
  }
  assert_near(area, 4, 1e-12);
  const PetscInt rows = order > 1 ? points : pieces;
  Uniform("bulk", "J", rows, 0, J, 1e-9);
  for (PetscInt k = 0; k < 6; ++k) Uniform("bulk", "stress", rows, k, k == 0 ? Sigma(0) : k == 3 ? Sigma(1) : k == 5 ? Sigma(2) : 0, 1e-9);
  Uniform("bulk", "pressure", rows, 0, -kappa * (J - 1), 1e-9);
  Uniform("bulk", "von_mises", rows, 0, Sigma(0) - Sigma(1), 1e-9);
  Uniform("bulk", "order", pieces, 0, (PetscReal)order, 0);
  Uniform("bulk", "level", pieces, 0, 1, 0);
  Uniform("bulk", "error", pieces, 0, 0, 0);
  free(X);
  free(u);
  free(conn);
}

static void CheckContact(void)
{
  const PetscInt nodes[2] = {2 * UPPER + 1, 2 * LOWER + 1}, all = nodes[0] + nodes[1], facets[2] = {2 * UPPER, 2 * LOWER};
  PetscInt       components, num;
  double        *X, *u, *normal, *side, *facet[2], *conn;

  Uniform("contact", "contact_pressure", all, 0, -Sigma(1), 1e-9);
  Uniform("contact", "gap", all, 0, 0, 1e-9);
  Uniform("contact", "status", all, 0, 1, 0);
  Uniform("contact", "normal", all, 0, 0, 1e-9);
  Uniform("contact", "displacement", all, 1, -0.05, 1e-9);
  Uniform("contact", "pair", 2 * (UPPER + LOWER), 0, 0, 0);
  assert_int_equal(ReadField("contact", "normal", &components, &normal), all);
  for (PetscInt n = 0; n < all; ++n) assert_near(normal[3 * n + 1], n < nodes[0] ? -1 : 1, 1e-9);
  assert_int_equal(ReadField("contact", "side", &components, &side), facets[0] + facets[1]);
  for (PetscInt f = 0; f < facets[0] + facets[1]; ++f) assert_near(side[f], f < facets[0] ? 0 : 1, 0);
  /* 6 and 10 edges with ends in common at 0, 1 and 2: 14 segments; both sides of each stand at one place once moved */
  num = ReadField("segments", "X", &components, &X);
  assert_int_equal(num, 4 * 14);
  ReadField("segments", "displacement", &components, &u);
  double length = 0;
  ReadField("segments", "facet", &components, &facet[0]);
  ReadField("segments", "mortar_facet", &components, &facet[1]);
  ReadField("contact", "cells", &components, &conn);
  double *place;
  ReadField("contact", "X", &components, &place);
  for (PetscInt s = 0; s < 14; ++s) {
    for (PetscInt k = 0; k < 4; ++k) { /* corners 0, 1 lie on the nonmortar edge of that number, 2, 3 on the mortar one */
      const PetscInt cell = (PetscInt)facet[k / 2][s] + (k < 2 ? 0 : facets[0]);
      const double   a = place[3 * (PetscInt)conn[2 * cell]], b = place[3 * (PetscInt)conn[2 * cell + 1]], x = X[12 * s + 3 * k];
      assert_true(x >= PetscMin(a, b) - 1e-9 && x <= PetscMax(a, b) + 1e-9);
    }
    const PetscInt at = 12 * s;
    for (PetscInt c = 0; c < 3; ++c) {
      for (PetscInt k = 0; k < 2; ++k) assert_near(X[at + 3 * k + c] + u[at + 3 * k + c], X[at + 6 + 3 * k + c] + u[at + 6 + 3 * k + c], 1e-8);
    }
    length += fabs(X[at + 3] - X[at]);
  }
  assert_near(length, 2, 1e-8);
  free(X);
  free(u);
  free(normal);
  free(side);
  free(facet[0]);
  free(facet[1]);
  free(conn);
  free(place);
}

/* ---- the run ------------------------------------------------------------------------------------------------------------------ */

static void CheckBalance(Problem problem, const State *state)
{
  const PetscReal force = -2 * Sigma(1);
  Balance         b;
  ReportRow       row = {0};

  OK(BalanceCompute(problem, state, &b));
  assert_near(b.reaction[TOP][1], -force, 1e-9);
  assert_near(b.reaction[BOTTOM][1], force, 1e-9);
  assert_near(b.reaction[LEFT][0], -2 * J * Sigma(0), 1e-9); /* pushes right: compression */
  assert_near(b.pair[0].force[0][1], force, 1e-9);
  assert_near(b.pair[0].force[1][1], -force, 1e-9);
  assert_near(b.pair[0].moment[0][2], force, 1e-9); /* resultant at x = 1 */
  assert_near(b.pair[0].max_pressure, -Sigma(1), 1e-9);
  assert_near(b.pair[0].area, 2, 1e-9);
  assert_near(b.pair[0].radius, 2, 1e-9);
  assert_int_equal(b.pair[0].active_nodes, 2 * UPPER + 1);
  assert_near(b.force_imbalance, 0, 1e-12);
  assert_near(b.moment_imbalance, 0, 1e-9);
  assert_near(b.support_imbalance, 0, 1e-9);
  for (PetscInt c = 0; c < 3; ++c) assert_near(b.load[c], 0, 1e-12);
  assert_near(b.status.min_det, J, 1e-9);
  OK(ReportRowFill(problem, state, NULL, &b, &row));
  assert_int_equal(row.cells, 4 * (LOWER + UPPER));
  assert_near(row.contact_force, force, 1e-9);
  assert_true(PetscIsNanReal(row.estimated_error));
  OK(BalanceDestroy(&b));
}

static void CheckProbes(const TestScene *s, Problem problem, const State *state, Probes probes)
{
  ProbeValue value[2];

  OK(ProbesEvaluate(probes, problem, state->x, value));
  for (PetscInt i = 0; i < 2; ++i) {
    assert_near(value[i].displacement[0], 0, 1e-9);
    assert_near(value[i].displacement[1], -0.05 * s->probes[i].X[1], 1e-9);
    assert_near(value[i].stress[3], Sigma(1), 1e-9);
    assert_near(value[i].stress[5], Sigma(2), 1e-9);
    assert_true(value[i].plastic_strain == 0);
  }
}

static void Patch(PetscInt order)
{
  TestScene    s;
  Forest       forest;
  Problem      problem;
  Solver       solver;
  SolverReport report;
  State        state;
  Writer       writer;
  Probes       probes;
  int8_t      *orders;

  SceneMake(&s, order);
  forest = Blocks();
  OK(ProblemInitialOrders(&s.data, forest, &orders));
  OK(ProblemCreate(&s.data, forest, orders, &problem));
  OK(PetscFree(orders));
  OK(StateCreate(problem, &state));
  OK(SolverCreate(problem, &solver));
  OK(ProblemSetTime(problem, 1));
  OK(SolverSolve(solver, &state, &report));
  assert_true(report.converged);
  state.t = 1;
  OK(ProbesCreate(&s.data, forest, &probes));
  CheckBalance(problem, &state);
  CheckProbes(&s, problem, &state, probes);
  OK(WriterCreate(PETSC_COMM_WORLD, directory, &writer));
  OK(OutputWriteState(writer, problem, &state, NULL, 1, 1, 0));
  OK(WriterDestroy(&writer));
  const RunSummary summary = {.status = "converged", .reason = "", .problem = problem, .state = &state, .probes = probes};
  OK(OutputSummary(PETSC_COMM_WORLD, &s.data, &summary));
  if (!rank) {
    CheckFields(order);
    CheckContact();
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  OK(ProbesDestroy(&probes));
  OK(SolverDestroy(&solver));
  OK(StateDestroy(&state));
  OK(ProblemDestroy(&problem));
  OK(ForestDestroy(&forest));
  OK(ExpressionDestroy(&s.boundaries[TOP].displacement[1]));
}

static void PatchLinear(void **state)
{
  Patch(1);
}
static void PatchQuadratic(void **state)
{
  Patch(2);
}
static void PatchCubic(void **state)
{
  Patch(3);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(PatchLinear), cmocka_unit_test(PatchQuadratic), cmocka_unit_test(PatchCubic)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  failed = cmocka_run_group_tests(tests, DirectoryCreate, DirectoryRemove);
  if (PetscFinalize()) return 1;
  return failed;
}
