/* Two blocks of hexahedra whose meshes do not match, one on the other, pressed: a contact patch in three dimensions, free to spread along x and y. Blocks
   [0,2]^2 x [0,1] and [0,2]^2 x [1,2]; the cells of the lower one may be skewed, so that their facets are no parallelograms. */
#pragma once
#include "solve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
/* cmocka needs the three above first */
#include <cmocka.h>

#include "near.h"

#define OK(call) assert_int_equal((call), 0)

enum { BOTTOM, TOP, SIDE_X, SIDE_Y, FREE, LOWER_TOP, UPPER_BOTTOM, NUM_GROUPS };

typedef struct {
  SceneData    data;
  MaterialSpec material;
  BodySpec     bodies[2];
  BoundarySpec boundaries[NUM_GROUPS];
  ContactSpec  contact;
  Forest       forest;
  Problem      problem;
  State        state;
} Patch;

static uint64_t patch_random_state = 88172645463325252ULL;

static inline PetscInt PatchRandom(PetscInt n)
{
  patch_random_state ^= patch_random_state << 13;
  patch_random_state ^= patch_random_state >> 7;
  patch_random_state ^= patch_random_state << 17;
  return (PetscInt)((patch_random_state >> 11) % (uint64_t)n);
}

/* Change before PatchForest. */
static PetscReal patch_skew = 0.08;

/* Vertex at lattice place g of a body; n[body] x n[body] x 1 cells. */
static inline PetscInt PatchVertex(const PetscInt n[2], PetscInt body, const PetscInt g[3])
{
  const PetscInt m = n[body] + 1;
  return (body ? 2 * (n[0] + 1) * (n[0] + 1) : 0) + g[0] + m * (g[1] + m * g[2]);
}

static inline void PatchCell(const PetscInt n[2], PetscInt body, PetscInt i, PetscInt j, PetscInt cell, CoarseMesh *mesh)
{
  mesh->cell_body[cell] = body;
  for (PetscInt k = 0; k < 8; ++k) {
    const PetscInt  g[3] = {i + (k & 1), j + ((k >> 1) & 1), k >> 2};
    const PetscReal x = 2. * (PetscReal)g[0] / (PetscReal)n[body], y = 2. * (PetscReal)g[1] / (PetscReal)n[body];
    PetscReal      *X                 = mesh->cell_geometry + 24 * cell + 3 * k;
    mesh->cell_vertices[8 * cell + k] = PatchVertex(n, body, g);
    X[0]                              = x + (body ? 0 : patch_skew * x * (2 - x) * (1 - y));
    X[1]                              = y;
    X[2]                              = (PetscReal)(body + g[2]);
  }
}

/* Facets of one cell on the boundary. */
static inline PetscInt PatchFacets(const PetscInt n[2], PetscInt body, PetscInt i, PetscInt j, PetscInt num, PetscInt facets[], uint64_t groups[])
{
  for (PetscInt side = 0; side < 6; ++side) {
    const PetscInt d = side / 2, high = side % 2, at[3] = {i, j, 0}, last[3] = {n[body] - 1, n[body] - 1, 0};
    const PetscInt group[3] = {high ? FREE : SIDE_X, high ? FREE : SIDE_Y, body ? (high ? TOP : UPPER_BOTTOM) : (high ? LOWER_TOP : BOTTOM)};
    if (at[d] != (high ? last[d] : 0)) continue;
    for (PetscInt v = 0; v < 4; ++v) {
      PetscInt g[3] = {i, j, 0};
      g[d] += high;
      g[(d + 1) % 3] += v & 1;
      g[(d + 2) % 3] += v >> 1;
      facets[4 * num + v] = PatchVertex(n, body, g);
    }
    groups[num++] = (uint64_t)1 << group[d];
  }
  return num;
}

static inline Forest PatchForest(PetscInt lower, PetscInt upper)
{
  const PetscInt n[2] = {lower, upper};
  CoarseMesh     mesh = {.dim            = 3,
                         .geometry_order = 1,
                         .num_bodies     = 2,
                         .num_boundaries = NUM_GROUPS,
                         .num_cells      = lower * lower + upper * upper,
                         .num_vertices   = 2 * ((lower + 1) * (lower + 1) + (upper + 1) * (upper + 1))};
  PetscInt      *facets, num = 0, cell = 0;
  uint64_t      *groups;
  Forest         forest;

  OK(PetscMalloc2(24 * mesh.num_cells, &facets, 6 * mesh.num_cells, &groups));
  OK(PetscMalloc1(8 * mesh.num_cells, &mesh.cell_vertices));
  OK(PetscCalloc1(24 * mesh.num_cells, &mesh.cell_geometry));
  OK(PetscMalloc1(mesh.num_cells, &mesh.cell_body));
  OK(PetscCalloc1(2, &mesh.body_name));
  OK(PetscCalloc1(NUM_GROUPS, &mesh.boundary_name));
  for (PetscInt body = 0; body < 2; ++body)
    for (PetscInt j = 0; j < n[body]; ++j)
      for (PetscInt i = 0; i < n[body]; ++i, ++cell) {
        PatchCell(n, body, i, j, cell, &mesh);
        num = PatchFacets(n, body, i, j, num, facets, groups);
      }
  OK(ForestCreateFromCoarse(PETSC_COMM_WORLD, &mesh, num, facets, groups, 0, &forest));
  OK(PetscFree2(facets, groups));
  return forest;
}

/* Split about one leaf in one_in; coarsen: merge what may, of the others. */
static inline void PatchAdapt(Forest forest, PetscInt one_in, PetscBool coarsen, Forest *adapted, ForestMap *map)
{
  const ForestTables *t;
  MarkList            marks;

  OK(ForestGetTables(forest, &t));
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    marks.split[l]   = PatchRandom(one_in) ? 0 : 7;
    marks.coarsen[l] = coarsen && !marks.split[l];
  }
  OK(ForestAdapt(forest, &marks, NULL, 0, NULL, adapted, map));
  OK(PetscFree(marks.split));
  OK(PetscFree(marks.coarsen));
}

/* Split a leaf at a corner of the lower block and the last one of the upper block, so that both contact surfaces have nodes that hang; `times` times. */
static inline void PatchRefine(Forest *forest, PetscInt times)
{
  for (PetscInt k = 0; k < times; ++k) {
    const ForestTables *t;
    MarkList            marks;
    Forest              adapted;
    ForestMap           map;
    OK(ForestGetTables(*forest, &t));
    OK(PetscCalloc1(t->num_leaves, &marks.split));
    OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
    const PetscInt ends[2] = {k ? 4 : 0, t->num_leaves - 1};
    for (PetscInt i = 0; i < 2; ++i) marks.split[ends[i]] = 7;
    OK(ForestAdapt(*forest, &marks, NULL, 0, NULL, &adapted, &map));
    OK(PetscFree(marks.split));
    OK(PetscFree(marks.coarsen));
    OK(ForestMapDestroy(&map));
    OK(ForestDestroy(forest));
    *forest = adapted;
  }
}

/* The upper block is pressed down by `press`; p->forest is set by the caller. */
static inline void PatchScene(Patch *p, PetscInt order, Kinematics kinematics, PetscBool standard, const char *press)
{
  static const char *const group[NUM_GROUPS] = {"bottom", "top", "side_x", "side_y", "free", "lower_top", "upper_bottom"};
  const char *const        names[]           = {"E", "nu"};
  const PetscReal          values[]          = {1, 0.3};

  *p = (Patch){.material = {.law = MaterialLawFind("neo_hookean"), .name = "rubber", .formulation = FORMULATION_DISPLACEMENT}};
  OK(MaterialSetUp(&p->material, 2, names, values));
  for (PetscInt b = 0; b < 2; ++b) p->bodies[b] = (BodySpec){.material = &p->material, .order = order};
  for (PetscInt g = 0; g < NUM_GROUPS; ++g) {
    OK(PetscStrcpy(p->boundaries[g].name, group[g]));
    p->boundaries[g].group = g;
  }
  p->boundaries[BOTTOM].fix[2] = p->boundaries[SIDE_X].fix[0] = p->boundaries[SIDE_Y].fix[1] = PETSC_TRUE;
  OK(ExpressionCreate("top", press, &p->boundaries[TOP].displacement[2]));
  p->contact = (ContactSpec){.name = "pair", .nonmortar = UPPER_BOTTOM, .mortar = LOWER_TOP, .standard = standard};
  p->data    = (SceneData){
         .mesh = {.dim = 3}, .num_contacts = 1, .contacts = &p->contact, .bodies = p->bodies, .boundaries = p->boundaries, .load = {.end = 1, .step = 1}};
  p->data.mechanics = (MechanicsSpec){
      .model = MODEL_3D, .kinematics = kinematics, .num_bodies = 2, .bodies = p->bodies, .num_boundaries = NUM_GROUPS, .boundaries = p->boundaries};
}

/* Problem at t = 1 with its prescribed motion pending; a state at rest. */
static inline void PatchProblem(const SceneData *data, Forest forest, const int8_t orders[], Problem *problem, State *state)
{
  OK(ProblemCreate(data, forest, orders, problem));
  OK(ProblemSetTime(*problem, 1));
  OK(StateCreate(*problem, state));
  state->t = 1;
}

static inline void PatchStart(Patch *p)
{
  int8_t *orders;

  OK(ProblemInitialOrders(&p->data, p->forest, &orders));
  PatchProblem(&p->data, p->forest, orders, &p->problem, &p->state);
  OK(PetscFree(orders));
}

static inline void PatchSolve(Problem problem, State *state)
{
  Solver       solver;
  SolverReport report;

  OK(SolverCreate(problem, &solver));
  OK(SolverSolve(solver, state, &report));
  if (!report.converged) fail_msg("no equilibrium: %s", report.reason);
  OK(SolverDestroy(&solver));
}

/* Evaluate at the state: contact views show it then. */
static inline void PatchEvaluate(Problem problem, Vec x, Vec r, ProblemStatus *status)
{
  OK(ProblemSearch(problem, x));
  OK(ProblemResidual(problem, x, r, status));
  assert_false(status->bad);
}

static inline PetscInt PatchHanging(const SurfaceView *s)
{
  PetscInt num = 0;
  for (PetscInt n = 0; n < s->num_nodes; ++n) num += s->hang[n + 1] > s->hang[n];
  return num;
}

static inline void PatchDestroy(Patch *p)
{
  OK(StateDestroy(&p->state));
  OK(ProblemDestroy(&p->problem));
  OK(ForestDestroy(&p->forest));
  OK(ExpressionDestroy(&p->boundaries[TOP].displacement[2]));
}
