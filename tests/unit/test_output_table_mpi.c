/* Tables and documents: a row is in the file as soon as it was written; a replaced file is whole; a place that cannot be written is an error on all ranks. */
#include "output.h"
#include <cjson/cJSON.h>
#include <cmocka.h>
#include <unistd.h>

#include "directory.h"

static char        path[PETSC_MAX_PATH_LEN];
static PetscMPIInt rank;

/* The file's text on rank 0; "" elsewhere. */
static const char *Text(void)
{
  static char text[4096];
  size_t      n = 0;

  if (rank == 0) {
    FILE *file = fopen(path, "r");

    assert_non_null(file);
    n = fread(text, 1, sizeof(text) - 1, file);
    fclose(file);
  }
  text[n] = 0;
  return text;
}

static void RowsAreThereAtOnce(void **unused)
{
  const char *const names[] = {"t", "cells", "error"};
  const PetscReal   first[] = {0.1, 123456789, 1.0 / 3}, second[] = {0.2, 2e10, -1e-300};
  Table             t;

  snprintf(path, sizeof(path), "%s/a.csv", directory);
  assert_int_equal(TableCreate(PETSC_COMM_WORLD, path, 3, names, &t), 0);
  if (rank == 0) assert_string_equal(Text(), "t,cells,error\n");
  assert_int_equal(TableRow(t, first), 0);
  if (rank == 0) assert_string_equal(Text(), "t,cells,error\n0.1,123456789,0.333333333333333\n");
  assert_int_equal(TableRow(t, second), 0);
  if (rank == 0) assert_string_equal(Text(), "t,cells,error\n0.1,123456789,0.333333333333333\n0.2,20000000000,-1e-300\n");
  assert_int_equal(TableDestroy(&t), 0);
  assert_null(t);
}

static void DocumentIsReplaced(void **unused)
{
  char temporary[PETSC_MAX_PATH_LEN + 8];

  snprintf(path, sizeof(path), "%s/summary.json", directory);
  snprintf(temporary, sizeof(temporary), "%s.tmp", path);
  for (int turn = 0; turn < 2; turn++) {
    cJSON *document = rank ? NULL : cJSON_CreateObject(), *back;

    if (rank == 0) {
      cJSON_AddStringToObject(document, "status", turn ? "converged" : "diverged, at some length");
      cJSON_AddNumberToObject(document, "energy", 0.1 + 0.2);
      cJSON_AddNumberToObject(document, "error", NAN);
    }
    assert_int_equal(SummaryWrite(PETSC_COMM_WORLD, path, document), 0);
    cJSON_Delete(document);
    if (rank) continue;
    assert_non_null(back = cJSON_Parse(Text()));
    assert_string_equal(cJSON_GetObjectItem(back, "status")->valuestring, turn ? "converged" : "diverged, at some length");
    assert_true(fabs(cJSON_GetObjectItem(back, "energy")->valuedouble - 0.3) < 1e-16); /* cJSON prints 15 digits when they are enough to within rounding */
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(back, "error")));
    cJSON_Delete(back);
    assert_int_not_equal(access(temporary, F_OK), 0);
  }
}

static void UnwritablePlaceFailsOnAllRanks(void **unused)
{
  const char *const names[]  = {"t"};
  cJSON            *document = rank ? NULL : cJSON_CreateObject();
  Table             t;

  assert_int_equal(PetscPushErrorHandler(PetscReturnErrorHandler, NULL), 0);
  assert_int_equal(TableCreate(PETSC_COMM_WORLD, "/nowhere/at/all.csv", 1, names, &t), PETSC_ERR_FILE_WRITE);
  assert_int_equal(SummaryWrite(PETSC_COMM_WORLD, "/nowhere/at/all.json", document), PETSC_ERR_FILE_WRITE);
  /* A device that is always full: the row does not fit. */
  assert_int_equal(TableCreate(PETSC_COMM_WORLD, "/dev/full", 1, names, &t), PETSC_ERR_FILE_WRITE);
  assert_int_equal(PetscPopErrorHandler(), 0);
  cJSON_Delete(document);
}

/* First rank: put a text into the file. */
static void Put(const char *text)
{
  FILE *file = rank ? NULL : fopen(path, "w");

  if (!file) return;
  fputs(text, file);
  fclose(file);
}

/* A table goes on after the rows of a step; what follows them is dropped, but not before there is a row to put in its place. */
static void TableGoesOn(void **unused)
{
  const char *const names[] = {"step", "pass", "t"}, *const others[] = {"step", "t", "pass"};
  const PetscReal   row[]   = {3, 0, 1.0 / 3};
  static const char whole[] = "step,pass,t\n1,0,0.1\n2,0,0.2\n2,1,0.2\n3,0,0.4\n3,1,0.4\n4,";
  Table             t;

  snprintf(path, sizeof(path), "%s/b.csv", directory);
  Put(whole);
  assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 3, names, &(TablePlace){.step = 2, .path = -1, .t = 0.2}, &t), 0);
  if (rank == 0) assert_string_equal(Text(), whole);
  assert_int_equal(TableRow(t, row), 0);
  assert_int_equal(TableRow(t, row), 0);
  assert_int_equal(TableDestroy(&t), 0);
  if (rank == 0) assert_string_equal(Text(), "step,pass,t\n1,0,0.1\n2,0,0.2\n2,1,0.2\n3,0,0.333333333333333\n3,0,0.333333333333333\n");
  assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 3, names, &(TablePlace){.step = 0, .path = -1, .t = 0}, &t), 0); /* before the first step */
  assert_int_equal(TableRow(t, row), 0);
  assert_int_equal(TableDestroy(&t), 0);
  if (rank == 0) assert_string_equal(Text(), "step,pass,t\n3,0,0.333333333333333\n");

  assert_int_equal(ErrorHandlerPush(), 0);
  Put(whole);
  assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 3, others, &(TablePlace){.step = 2, .path = -1, .t = 0.2}, &t), MORTISE_ERR_INPUT);
  assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 2, names, &(TablePlace){.step = 2, .path = -1, .t = 0.2}, &t), MORTISE_ERR_INPUT);
  assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 3, names, &(TablePlace){.step = 2, .path = -1, .t = 0.3}, &t), MORTISE_ERR_INPUT); /* another run's */
  assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 3, names, &(TablePlace){.step = 4, .path = -1, .t = 0.5}, &t), MORTISE_ERR_INPUT); /* row 4 has no end */
  if (rank == 0) assert_string_equal(Text(), whole);
  assert_int_equal(PetscPopErrorHandler(), 0);
  if (rank == 0) unlink(path);
  assert_int_equal(MPI_Barrier(PETSC_COMM_WORLD), 0);
  assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 3, names, &(TablePlace){.step = 2, .path = -1, .t = 0.2}, &t), 0); /* not there: a new one */
  assert_int_equal(TableDestroy(&t), 0);
  if (rank == 0) assert_string_equal(Text(), "step,pass,t\n");
}

/* A path that is computed again: in a table of all paths, and in one of the last. */
static void TableOfPathsGoesOn(void **unused)
{
  const char *const names[] = {"step", "pass", "t"};
  const PetscReal   row[]   = {2, 1, 0.5};
  static const char all[] = "step,pass,t\n1,0,0.1\n2,0,0.2\n3,0,0.3\n1,1,0.1\n2,1,0.4\n3,1,0.5\n", last[] = "step,pass,t\n1,1,0.1\n2,1,0.4\n";
  static const struct {
    const char *before, *after; /* NULL: refused */
    TablePlace  place;
  } cases[] = {
      {all, "step,pass,t\n1,0,0.1\n2,0,0.2\n3,0,0.3\n1,1,0.1\n2,1,0.5\n", {.step = 1, .path = 1, .t = 0.1, .earlier = PETSC_TRUE}},
      {all, "step,pass,t\n1,0,0.1\n2,0,0.2\n3,0,0.3\n2,1,0.5\n", {.step = 0, .path = 1, .t = 0, .earlier = PETSC_TRUE}},
      {all, "step,pass,t\n1,0,0.1\n2,0,0.2\n2,1,0.5\n", {.step = 2, .path = 0, .t = 0.2, .earlier = PETSC_TRUE}},
      {all, NULL, {.step = 2, .path = 1, .t = 0.2, .earlier = PETSC_TRUE}},
      {all, NULL, {.step = 1, .path = 2, .t = 0.1, .earlier = PETSC_TRUE}},
      {last, "step,pass,t\n1,1,0.1\n2,1,0.5\n", {.step = 1, .path = 1, .t = 0.1}},
      {last, "step,pass,t\n2,1,0.5\n", {.step = 0, .path = 1, .t = 0}},
      {last, NULL, {.step = 1, .path = 0, .t = 0.1}}, /* the same time of another path */
      {last, NULL, {.step = 1, .path = 2, .t = 0.1}},
  };
  Table t;

  assert_int_equal(ErrorHandlerPush(), 0);
  snprintf(path, sizeof(path), "%s/c.csv", directory);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(cases); ++i) {
    Put(cases[i].before);
    assert_int_equal(TableResume(PETSC_COMM_WORLD, path, 3, names, &cases[i].place, &t), cases[i].after ? 0 : MORTISE_ERR_INPUT);
    if (!cases[i].after) continue;
    assert_int_equal(TableRow(t, row), 0);
    if (rank == 0) assert_string_equal(Text(), cases[i].after);
    assert_int_equal(TableDestroy(&t), 0);
  }
  assert_int_equal(PetscPopErrorHandler(), 0);
}

static void FirstRowIsRead(void **unused)
{
  static const struct {
    const char *text, *name;
    PetscReal   value; /* below 0: none */
  } cases[] = {{"step,pass,t\n1,3,0.1\n2,4,0.2\n", "pass", 3},
               {"step,pass,t\n1,3,0.1\n", "t", 0.1},
               {"step,pass,t\n1,3,0.1\n", "pas", -1},
               {"step,pass,t\n1,3,0.", "pass", -1},
               {"step,pass,t\n", "step", -1},
               {"", "step", -1}};
  PetscReal value;

  snprintf(path, sizeof(path), "%s/d%d.csv", directory, (int)rank);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(cases); ++i) {
    FILE *file = fopen(path, "w");
    fputs(cases[i].text, file);
    fclose(file);
    assert_int_equal(TableFirst(path, cases[i].name, &value), 0);
    assert_true(cases[i].value < 0 ? PetscIsNanReal(value) : value == cases[i].value);
  }
  unlink(path);
  assert_int_equal(TableFirst(path, "step", &value), 0);
  assert_true(PetscIsNanReal(value));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(RowsAreThereAtOnce), cmocka_unit_test(DocumentIsReplaced),
                                     cmocka_unit_test(TableGoesOn),        cmocka_unit_test(TableOfPathsGoesOn),
                                     cmocka_unit_test(FirstRowIsRead),     cmocka_unit_test(UnwritablePlaceFailsOnAllRanks)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  failed = cmocka_run_group_tests(tests, DirectoryCreate, DirectoryRemove);
  if (PetscFinalize()) return 1;
  return failed;
}
