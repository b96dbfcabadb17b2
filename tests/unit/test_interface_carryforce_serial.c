/* What nodes of facets covered in part take on in a step is carried as a force where their weight grows. */
#include "base.h"
#include "interfaceimpl.h"

#include <cmocka.h>

#define NODES 4

static void Forces(void **state)
{
  /* a sliver that grows, a node covered wholly, a sliver that shrinks, a node without a multiplier */
  PetscReal           weight[NODES] = {1e-3, 1, 0.5, 1e-3}, spring[NODES] = {1e-6, 0, 1e-3, 1e-6}, before[NODES];
  PetscInt            own[NODES] = {0, 1, 2, 3}, zlocal[NODES] = {0, 2, 4, -1};
  Contact             contact   = {.num = 2, .weight = weight, .spring = spring, .before = before, .zlocal = zlocal};
  struct _p_Interface interface = {.comm = PETSC_COMM_SELF, .num_contacts = 1, .contacts = &contact};
  const PetscReal    *change;
  PetscBool           changed;
  Vec                 dx;

  contact.side[0].num_own = NODES;
  contact.side[0].own     = own;
  assert_int_equal(VecCreateSeq(PETSC_COMM_SELF, 6, &dx), 0);
  assert_int_equal(VecSet(dx, 200), 0);
  InterfaceKeepWeights(&interface);
  assert_int_equal(InterfaceCarryForces(&interface, dx, &changed), 0);
  assert_false(changed); /* nothing has moved */
  weight[0] = weight[3] = 0.8;
  weight[1]             = 1.5;
  weight[2]             = 0.1;
  assert_int_equal(InterfaceCarryForces(&interface, dx, &changed), 0);
  assert_true(changed);
  assert_int_equal(VecGetArrayRead(dx, &change), 0);
  for (PetscInt i = 0; i < 6; ++i) assert_float_equal(change[i], i < 2 ? 0.25 : 200, 1e-13);
  assert_int_equal(VecRestoreArrayRead(dx, &change), 0);
  assert_int_equal(VecDestroy(&dx), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Forces)};

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
