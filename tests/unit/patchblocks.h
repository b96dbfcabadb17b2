/* What the contact patches of the plane (patchfixture.h) and of space (solidpatch.h) share: two blocks, the upper one's bottom pressed on the lower one's top
   by the prescribed motion of its own top. */
#pragma once
#include "forest_box.h"
#include "solve.h"
#include "transfer.h"

#include "near.h"

enum { BOTTOM, TOP, LOWER_TOP, UPPER_BOTTOM, PATCH_SIDES, PATCH_GROUPS = PATCH_SIDES + 3 };

typedef struct {
  SceneData    data;
  MaterialSpec material;
  BodySpec     bodies[2];
  BoundarySpec boundaries[PATCH_GROUPS];
  ContactSpec  contact;
  Forest       forest;
  Problem      problem;
  State        state;
} Patch;

/* Groups named in their order; the upper block's top moves by `press` along the last axis; the lower block's bottom stays at its height. */
static inline void PatchBlocks(Patch *p, PetscInt dim, PetscInt order, Model model, Kinematics kinematics, Formulation formulation, PetscInt num_groups,
                               const char *const group[], const char *press)
{
  const char *const names[]  = {"E", "nu"};
  const PetscReal   values[] = {1, 0.3};

  *p = (Patch){.material = {.law = MaterialLawFind("neo_hookean"), .name = "rubber", .formulation = formulation}};
  OK(MaterialSetUp(&p->material, 2, names, values));
  for (PetscInt b = 0; b < 2; ++b) p->bodies[b] = (BodySpec){.material = &p->material, .order = order};
  for (PetscInt g = 0; g < num_groups; ++g) {
    OK(PetscStrcpy(p->boundaries[g].name, group[g]));
    p->boundaries[g].group = g;
  }
  p->boundaries[BOTTOM].fix[dim - 1] = PETSC_TRUE;
  OK(ExpressionCreate("top", press, &p->boundaries[TOP].displacement[dim - 1]));
  p->contact = (ContactSpec){.name = "pair", .nonmortar = UPPER_BOTTOM, .mortar = LOWER_TOP};
  p->data    = (SceneData){
         .mesh = {.dim = dim}, .num_contacts = 1, .contacts = &p->contact, .bodies = p->bodies, .boundaries = p->boundaries, .load = {.end = 1, .step = 1}};
  p->data.mechanics = (MechanicsSpec){
      .model = model, .kinematics = kinematics, .num_bodies = 2, .bodies = p->bodies, .num_boundaries = num_groups, .boundaries = p->boundaries};
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
  OK(ProblemResidual(problem, x, NULL, r, status));
  assert_false(status->bad);
}

static inline PetscInt PatchHanging(const SurfaceView *s)
{
  PetscInt num = 0;
  for (PetscInt n = 0; n < s->num_nodes; ++n) num += s->hang[n + 1] > s->hang[n];
  return num;
}

/* Split about one leaf in one_in; coarsen: merge what may, of the others. */
static inline void PatchAdapt(Forest forest, PetscInt one_in, PetscBool coarsen, Forest *adapted, ForestMap *map)
{
  const ForestTables *t;
  MarkList            marks;

  t = ForestGetTables(forest);
  OK(PetscCalloc1(t->num_leaves, &marks.split));
  OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
  for (PetscInt l = 0; l < t->num_leaves; ++l) {
    marks.split[l]   = (int8_t)(BoxRandom(one_in) ? 0 : (1 << t->dim) - 1);
    marks.coarsen[l] = coarsen && !marks.split[l];
  }
  OK(ForestAdapt(forest, &marks, NULL, 0, NULL, adapted, map));
  MarksDestroy(&marks);
}

/* Adapt, carry the state over; raise: orders of the new leaves by 0 or 1 at random. */
static inline void PatchMove(Patch *p, PetscInt one_in, PetscBool coarsen, PetscBool raise)
{
  Forest    adapted;
  ForestMap map;
  Problem   problem;
  State     next;
  int8_t   *orders;

  PatchAdapt(p->forest, one_in, coarsen, &adapted, &map);
  OK(TransferOrders(&map, p->state.leaf_order, &orders));
  for (PetscInt l = 0; l < map.num && raise; ++l) orders[l] += (int8_t)BoxRandom(2);
  PatchProblem(&p->data, adapted, orders, &problem, &next);
  OK(ProblemJump(problem));
  OK(TransferState(p->problem, &p->state, problem, &map, &next));
  OK(PetscFree(orders));
  OK(ForestMapDestroy(&map));
  OK(StateDestroy(&p->state));
  OK(ProblemDestroy(&p->problem));
  OK(ForestDestroy(&p->forest));
  p->forest  = adapted;
  p->problem = problem;
  p->state   = next;
}

static inline void PatchDestroy(Patch *p)
{
  OK(StateDestroy(&p->state));
  OK(ProblemDestroy(&p->problem));
  OK(ForestDestroy(&p->forest));
  OK(ExpressionDestroy(&p->boundaries[TOP].displacement[p->data.mesh.dim - 1]));
}
