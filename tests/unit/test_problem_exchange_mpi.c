/* Values of contact surfaces over ranks: a rank has the right ones or none at all (NaN), and ranks away from contact send nothing. */
#include "solidpatch.h"

/* Are values[num][size] all right where they are numbers? Returns how many nodes are without. */
static PetscInt Compare(PetscInt num, PetscInt size, const PetscReal values[], const PetscReal all[])
{
  PetscInt without = 0;

  for (PetscInt n = 0; n < num; ++n) {
    without += PetscIsNanReal(values[size * n]);
    for (PetscInt c = 0; c < size; ++c) {
      assert_false(PetscIsNanReal(all[size * n + c]));
      assert_int_equal(PetscIsNanReal(values[size * n + c]), PetscIsNanReal(values[size * n]));
      if (!PetscIsNanReal(values[size * n])) assert_near(values[size * n + c], all[size * n + c], 1e-14);
    }
  }
  return without;
}

/* What a rank has of a pair is what everybody has together; owned nodes it has whole. Returns the nodes it lacks. */
static PetscInt Known(Problem problem)
{
  const ContactView *v, *all;
  PetscInt           without = 0;

  v = InterfaceGetContact(ProblemInterface(problem), 0);
  OK(InterfaceGatherContactToAll(ProblemInterface(problem), 0, &all));
  for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n) {
    if (!v->nonmortar.owned[n]) continue;
    assert_false(PetscIsNanReal(v->z[n] + v->gap[n] + v->weight[n] + v->nonmortar.x[3 * n] + v->nonmortar.force[3 * n]));
    assert_int_equal(v->active[n], all->active[n]);
  }
  without += Compare(v->nonmortar.num_nodes, 3, v->nonmortar.x, all->nonmortar.x);
  without += Compare(v->nonmortar.num_nodes, 1, v->z, all->z);
  without += Compare(v->nonmortar.num_nodes, 1, v->gap, all->gap);
  without += Compare(v->nonmortar.num_nodes, 1, v->weight, all->weight);
  without += Compare(v->nonmortar.num_nodes, 3, v->nonmortar.force, all->nonmortar.force);
  without += Compare(v->mortar.num_nodes, 3, v->mortar.x, all->mortar.x);
  without += Compare(v->mortar.num_nodes, 3, v->mortar.force, all->mortar.force);
  return without;
}

/* On several ranks each lacks something, on one nothing. Finite and small kinematics, facets of higher order. */
static void RightOrNone(void **state)
{
  for (PetscInt kind = 0; kind < 3; ++kind) {
    Patch         p;
    Vec           r;
    ProblemStatus status;
    PetscMPIInt   size;
    MPI_Comm_size(PETSC_COMM_WORLD, &size);
    PatchScene(&p, kind == 2 ? 2 : 1, kind == 1 ? KINEMATICS_SMALL : KINEMATICS_FINITE, PETSC_FALSE, "-0.06 - 0.02*X*Y");
    p.contact.full = (PetscBool)(kind == 2);
    p.forest       = kind == 2 ? PatchForest(3, 4) : PatchForest(5, 6);
    PatchRefine(&p.forest, 2);
    PatchStart(&p);
    PatchSolve(p.problem, &p.state);
    OK(ProblemCreateVector(p.problem, &r));
    PatchEvaluate(p.problem, p.state.x, r, &status);
    const PetscInt without = Known(p.problem);
    if (size == 1)
      assert_int_equal(without, 0);
    else
      assert_true(without > 0);
    OK(VecDestroy(&r));
    PatchDestroy(&p);
  }
}

/* Distance of X from a corner of the blocks, along the farther axis. */
static PetscReal FromCorner(const PetscReal X[3], PetscInt corner)
{
  return PetscMax(corner & 1 ? 2 - X[0] : X[0], corner & 2 ? 2 - X[1] : X[1]);
}

/* The upper block, lifted away from the lower one but near a corner, as its top is: 3 per unit of length from 0.2 on, along either axis. */
static void Lift(Patch *p, PetscInt corner)
{
  const HPTables     *v;
  const ForestTables *t;
  PetscReal          *local;

  v = HPSpaceGetTables(ProblemSpace(p->problem));
  t = ForestGetTables(p->forest);
  OK(PetscCalloc1(3 * v->num_nodes, &local));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscReal x = v->X[3 * n], y = v->X[3 * n + 1], d[2] = {corner & 1 ? 2 - x : x, corner & 2 ? 2 - y : y};
    if (t->leaf_body[t->entity_leaf[v->node_entity[n]]] == 1) local[3 * n + 2] = 3 * (PetscMax(0, d[0] - 0.2) + PetscMax(0, d[1] - 0.2)) - 0.001;
  }
  OK(ProblemSetDisplacement(p->problem, local, p->state.x));
  OK(PetscFree(local));
}

static const char *const LiftTop[4] = {"3 * max(0, X - 0.2) + 3 * max(0, Y - 0.2) - 0.001", "3 * max(0, 1.8 - X) + 3 * max(0, Y - 0.2) - 0.001",
                                       "3 * max(0, X - 0.2) + 3 * max(0, 1.8 - Y) - 0.001", "3 * max(0, 1.8 - X) + 3 * max(0, 1.8 - Y) - 0.001"};

/* Are all facets of this rank away from the corner? Those in contact end at 0.4; they reach as far again along their normals, which are inclined. */
static PetscBool IsFar(const SurfaceView *s, const ForestTables *t, PetscInt corner)
{
  PetscMPIInt rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    if (t->leaf_rank[s->facet_leaf[f]] != rank) continue;
    for (PetscInt k = 0; k < 4; ++k) {
      if (FromCorner(s->X + 3 * s->facets[4 * f + k], corner) < 0.8 - 1e-9) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

/* Contact at one corner: is this rank far from it? counts: far ranks, messages of values, of the search. */
static void Corner(PetscInt corner, PetscInt counts[3])
{
  Patch               p;
  const ContactView  *view;
  const ForestTables *t;
  ContactTraffic      traffic;
  ProblemStatus       status;
  Vec                 r;

  PatchScene(&p, 1, KINEMATICS_FINITE, PETSC_FALSE, LiftTop[corner]);
  p.contact.search = 1;
  p.forest         = PatchForest(9, 10);
  PatchStart(&p);
  OK(ProblemJump(p.problem));
  Lift(&p, corner);
  t    = ForestGetTables(p.forest);
  view = InterfaceGetContact(ProblemInterface(p.problem), 0);
  OK(ProblemCreateVector(p.problem, &r));
  PatchEvaluate(p.problem, p.state.x, r, &status);
  PatchEvaluate(p.problem, p.state.x, r, &status);
  assert_true(view->area > 0.01 && view->area < 0.5);
  InterfaceGetTraffic(ProblemInterface(p.problem), &traffic);
  assert_int_equal(traffic.evaluations, 2);
  assert_int_equal(traffic.searches, 2);
  const PetscBool far = (PetscBool)(IsFar(&view->nonmortar, t, corner) && IsFar(&view->mortar, t, corner));
  if (far) {
    assert_int_equal(traffic.messages, 0);
    assert_int_equal(traffic.search_messages, 0);
    assert_near(traffic.bytes + traffic.search_bytes, 0, 0);
  }
  counts[0] += far;
  counts[1] += traffic.messages;
  counts[2] += traffic.search_messages;
  Known(p.problem);
  OK(VecDestroy(&r));
  PatchDestroy(&p);
}

/* All corners in turn: a partition in three has a part that lies away from one of them. */
static void FarRanksSendNothing(void **state)
{
  PetscInt    counts[3] = {0, 0, 0};
  PetscMPIInt size;

  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  for (PetscInt corner = 0; corner < 4; ++corner) Corner(corner, counts);
  OK(MPI_Allreduce(MPI_IN_PLACE, counts, 3, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD));
  if (size == 3) assert_true(counts[0] > 0 && counts[1] > 0 && counts[2] > 0); /* the test has something to say */
  if (size == 1) assert_int_equal(counts[0] + counts[1] + counts[2], 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(RightOrNone), cmocka_unit_test(FarRanksSendNothing)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
