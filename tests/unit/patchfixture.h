/* Two blocks with meshes that do not match, one on the other, pressed by 5 %: the solution is uniform (a contact patch), so that whatever estimates or
   carries it over must do so exactly. Blocks [0,2] x [0,1] and [0,2] x [1,2]; plane strain or axisymmetric (x = r). */
#pragma once
#include "solve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
/* cmocka needs the three above first */
#include <cmocka.h>

#include "near.h"

#define OK(call) assert_int_equal((call), 0)

enum { BOTTOM, TOP, LEFT, RIGHT, LOWER_TOP, UPPER_BOTTOM, NUM_GROUPS };

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

/* n[0] cells side by side below, n[1] above; refined once. */
static inline Forest PatchForest(const PetscInt n[2])
{
  CoarseMesh mesh = {
      .dim = 2, .geometry_order = 1, .num_bodies = 2, .num_boundaries = NUM_GROUPS, .num_cells = n[0] + n[1], .num_vertices = 2 * (n[0] + n[1] + 2)};
  PetscInt *facets, num = 0, cell = 0, vertex = 0;
  uint64_t *groups;
  Forest    forest;

  OK(PetscMalloc2(4 * (mesh.num_cells + 2), &facets, 2 * (mesh.num_cells + 2), &groups));
  OK(PetscMalloc1(4 * mesh.num_cells, &mesh.cell_vertices));
  OK(PetscCalloc1(12 * mesh.num_cells, &mesh.cell_geometry));
  OK(PetscMalloc1(mesh.num_cells, &mesh.cell_body));
  OK(PetscCalloc1(2, &mesh.body_name));
  OK(PetscCalloc1(NUM_GROUPS, &mesh.boundary_name));
  for (PetscInt body = 0; body < 2; ++body) {
    for (PetscInt i = 0; i < n[body]; ++i, ++cell) {
      mesh.cell_body[cell] = body;
      for (PetscInt k = 0; k < 4; ++k) {
        mesh.cell_vertices[4 * cell + k]          = vertex + i + (k & 1) + (n[body] + 1) * (k >> 1);
        mesh.cell_geometry[12 * cell + 3 * k]     = 2. * (PetscReal)(i + (k & 1)) / (PetscReal)n[body];
        mesh.cell_geometry[12 * cell + 3 * k + 1] = (PetscReal)(body + (k >> 1));
      }
      for (PetscInt high = 0; high < 2; ++high, ++num) {
        facets[2 * num]     = vertex + i + (n[body] + 1) * high;
        facets[2 * num + 1] = facets[2 * num] + 1;
        groups[num]         = (uint64_t)1 << (body ? (high ? TOP : UPPER_BOTTOM) : (high ? LOWER_TOP : BOTTOM));
      }
    }
    for (PetscInt right = 0; right < 2; ++right, ++num) {
      facets[2 * num]     = vertex + n[body] * right;
      facets[2 * num + 1] = facets[2 * num] + n[body] + 1;
      groups[num]         = (uint64_t)1 << (right ? RIGHT : LEFT);
    }
    vertex += 2 * (n[body] + 1);
  }
  OK(ForestCreateFromCoarse(PETSC_COMM_WORLD, &mesh, num, facets, groups, 1, &forest));
  OK(PetscFree2(facets, groups));
  return forest;
}

static inline void PatchScene(Patch *p, PetscInt order, Model model, Kinematics kinematics, Formulation formulation)
{
  static const char *const group[NUM_GROUPS] = {"bottom", "top", "left", "right", "lower_top", "upper_bottom"};
  const char *const        names[]           = {"E", "nu"};
  const PetscReal          values[]          = {1, 0.3};

  *p = (Patch){.material = {.law = MaterialLawFind("neo_hookean"), .name = "rubber", .formulation = formulation}};
  OK(MaterialSetUp(&p->material, 2, names, values));
  for (PetscInt b = 0; b < 2; ++b) p->bodies[b] = (BodySpec){.material = &p->material, .order = order};
  for (PetscInt g = 0; g < NUM_GROUPS; ++g) {
    OK(PetscStrcpy(p->boundaries[g].name, group[g]));
    p->boundaries[g].group = g;
  }
  p->boundaries[BOTTOM].fix[1] = p->boundaries[LEFT].fix[0] = p->boundaries[RIGHT].fix[0] = PETSC_TRUE;
  OK(ExpressionCreate("top", "-0.1", &p->boundaries[TOP].displacement[1]));
  p->contact = (ContactSpec){.name = "pair", .nonmortar = UPPER_BOTTOM, .mortar = LOWER_TOP};
  p->data    = (SceneData){
         .mesh = {.dim = 2}, .num_contacts = 1, .contacts = &p->contact, .bodies = p->bodies, .boundaries = p->boundaries, .load = {.end = 1, .step = 1}};
  p->data.mechanics = (MechanicsSpec){
      .model = model, .kinematics = kinematics, .num_bodies = 2, .bodies = p->bodies, .num_boundaries = NUM_GROUPS, .boundaries = p->boundaries};
}

/* Problem at t = 1 with its prescribed motion applied; a state at rest. */
static inline void PatchProblem(const SceneData *data, Forest forest, const int8_t orders[], Problem *problem, State *state)
{
  OK(ProblemCreate(data, forest, orders, problem));
  OK(ProblemSetTime(*problem, 1));
  OK(StateCreate(*problem, state));
  state->t = 1;
}

static inline void PatchSolve(Problem problem, State *state)
{
  Solver       solver;
  SolverReport report;

  OK(SolverCreate(problem, &solver));
  OK(SolverSolve(solver, state, &report));
  assert_true(report.converged);
  OK(SolverDestroy(&solver));
}

/* Split about one leaf in three; coarsen: merge what may, of the others. */
static inline void PatchAdapt(Forest forest, PetscBool coarsen, Forest *adapted, ForestMap *map)
{
  const ForestTables *t;
  MarkList            marks;

  OK(ForestGetTables(forest, &t));
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    marks.split[l]   = PatchRandom(3) ? 0 : 3;
    marks.coarsen[l] = coarsen && !marks.split[l];
  }
  OK(ForestAdapt(forest, &marks, NULL, 0, NULL, adapted, map));
  OK(PetscFree(marks.split));
  OK(PetscFree(marks.coarsen));
}

static inline void PatchDestroy(Patch *p)
{
  OK(StateDestroy(&p->state));
  OK(ProblemDestroy(&p->problem));
  OK(ForestDestroy(&p->forest));
  OK(ExpressionDestroy(&p->boundaries[TOP].displacement[1]));
}
