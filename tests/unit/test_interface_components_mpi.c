/* Laws with several multipliers a node: their numbers, rows, values on other ranks, in checkpoints and on other meshes. The law here, in place of the program's
   table, gives each node companions of its pressure: z_k = (k + 1) z_0. */
#include "patchfixture.h"

#include "interfaceimpl.h"

static PetscInt Three(PetscInt dim)
{
  return 3;
}

static int8_t Pressed(const ContactPoint *p)
{
  return p->z[0] - p->c * p->gap / p->weight > 0 ? 2 : 0;
}

static void Companions(const ContactPoint *p, PetscBool symmetric, ContactRow row[])
{
  assert_false(symmetric);
  ContactCompliantRow_Private(p, p->spring, 0, symmetric, &row[0]);
  for (PetscInt k = 1; k < 3; ++k) {
    row[k]      = (ContactRow){.z = {-(k + 1) * p->w0}, .side = -p->w0 * (p->z[k] - (k + 1) * p->z[0])};
    row[k].z[k] = p->w0;
  }
}

static const ContactLawOps Law           = {.name = "companions", .num_multipliers = Three, .state = Pressed, .rows = Companions};
const ContactLawOps *const ContactLaws[] = {&Law, NULL};

/* Packed and unpacked it is what it was. */
static void CheckPack(Patch *p)
{
  Pack      pack;
  Vec       x;
  PetscReal jump, norm;

  OK(TransferPack(p->problem, &p->state, &pack));
  OK(VecDuplicate(p->state.x, &x));
  OK(VecCopy(p->state.x, x));
  OK(VecSet(p->state.x, 7));
  OK(TransferUnpack(p->problem, &pack, &p->state, &jump));
  OK(VecAXPY(x, -1, p->state.x));
  OK(VecNorm(x, NORM_INFINITY, &norm));
  assert_near(norm, 0, 0);
  OK(VecDestroy(&x));
  OK(PackDestroy(&pack));
}

/* The state is in equilibrium, the companions are there, and nodes that bear are in state 2. */
static void Check(Patch *p)
{
  const ContactView *v;
  ProblemStatus      status;
  PetscReal          norm;
  PetscBool          symmetric;
  Vec                r;

  OK(ProblemCreateVector(p->problem, &r));
  PatchEvaluate(p->problem, p->state.x, r, &status);
  OK(VecNorm(r, NORM_INFINITY, &norm));
  assert_near(norm, 0, 1e-9 * status.scale);
  OK(VecDestroy(&r));
  symmetric = ProblemIsSymmetric(p->problem);
  assert_false(symmetric);
  OK(InterfaceGatherContactToAll(ProblemInterface(p->problem), 0, &v));
  assert_int_equal(v->num_z, 3);
  for (PetscInt n = 0; n < v->nonmortar.num_nodes; ++n) {
    assert_near(v->z[n], 0.0688978527, 1e-6);
    assert_int_equal(v->active[n], 2);
    for (PetscInt k = 1; k < 3; ++k) assert_near(v->z[k * v->nonmortar.num_nodes + n], (k + 1) * v->z[n], 1e-10);
  }
}

static void Values(void **state)
{
  for (PetscInt order = 1; order < 3; ++order) {
    Patch p;
    PatchScene(&p, order, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_DISPLACEMENT);
    p.contact.full = (PetscBool)(order > 1);
    p.forest       = PatchForest((const PetscInt[2]){3, 5});
    PatchStart(&p);
    PatchSolve(p.problem, &p.state);
    CheckPack(&p);
    Check(&p);
    for (PetscInt step = 0; step < 3; ++step) {
      PatchMove(&p, 3, (PetscBool)(step % 2), PETSC_FALSE);
      Check(&p);
    }
    PatchDestroy(&p);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Values)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests_name("interface: multipliers with components", tests, NULL, NULL);
  return PetscFinalize() || failed;
}
