/* Searches in sorted arrays. */
#include "contactsum.h"

static int Compare(const void *a, const void *b)
{
  const PetscReal x = *(const PetscReal *)a, y = *(const PetscReal *)b;

  return (x > y) - (x < y);
}

/* Before, at, between, among equals of, and beyond the entries. */
static void test_from(void **state)
{
  const PetscReal array[] = {1, 2, 2, 2, 5}, key[] = {0, 1, 1.5, 2, 3, 5, 6};
  const PetscInt  first[] = {0, 0, 1, 1, 4, 4, 5};

  (void)state;
  for (int k = 0; k < 7; k++) assert_int_equal(SortedFrom(&key[k], array, 5, sizeof(PetscReal), Compare), first[k]);
  assert_int_equal(SortedFrom(&key[0], NULL, 0, sizeof(PetscReal), Compare), 0);
}

/* Room for the longest so far. */
static void test_row(void **state)
{
  RowBuffer b = {0};

  (void)state;
  for (PetscInt num = 1; num < 100; num += 7) {
    CHECK_CALL(RowBufferGrow(&b, num));
    assert_true(b.size >= num);
    b.index[num - 1] = 1, b.value[num - 1] = 1;
  }
  CHECK_CALL(RowBufferDestroy(&b));
  assert_null(b.index);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_from), cmocka_unit_test(test_row)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
