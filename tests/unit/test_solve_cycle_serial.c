/* Sets that repeat: only with another one between them, and where residuals are compared only when those agree. */
#include "solveimpl.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static PetscBool Add(SetHistory *h, uint64_t hash, PetscReal norm, PetscBool compare)
{
  PetscBool repeats;

  assert_int_equal(SetHistoryAdd_Private(h, hash, norm, compare, &repeats), 0);
  return repeats;
}

static void SettledSetIsNoCycle(void **state)
{
  SetHistory h = {0};

  for (int i = 0; i < 40; ++i) assert_false(Add(&h, 7, 1, PETSC_TRUE));
  assert_int_equal(h.num, 40);
  assert_int_equal(SetHistoryDestroy_Private(&h), 0);
}

static void CyclesAreSeen(void **state)
{
  SetHistory h = {0};

  assert_false(Add(&h, 1, 0, PETSC_FALSE));
  assert_false(Add(&h, 2, 0, PETSC_FALSE));
  assert_false(Add(&h, 3, 0, PETSC_FALSE));
  assert_true(Add(&h, 1, 0, PETSC_FALSE));
  h.num = 0;
  assert_false(Add(&h, 1, 1.0, PETSC_TRUE));
  assert_false(Add(&h, 2, 0.5, PETSC_TRUE));
  assert_false(Add(&h, 1, 0.1, PETSC_TRUE)); /* the same set on the way down: progress */
  assert_false(Add(&h, 2, 0.4, PETSC_TRUE));
  assert_true(Add(&h, 1, 0.1 * (1 + 1e-12), PETSC_TRUE));
  assert_int_equal(SetHistoryDestroy_Private(&h), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(SettledSetIsNoCycle), cmocka_unit_test(CyclesAreSeen)};
  int                     failed;

  if (PetscInitializeNoArguments()) return 2;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() ? 2 : failed;
}
