/* The writer puts down what it was given: two states of a hexahedral and a polyline grid, spread over ranks of which one is empty, are read back from the
   files. -directory DIR   write there and leave the files (for test_output_read.py); else a directory that is removed */
#include "output.h"
#include <cmocka.h>
#include <hdf5.h>
#include <unistd.h>

#include "directory.h"

enum { N = 12 }; /* cells in a row along x; each rank brings its own 8 points per cell */

static PetscBool   keep;
static PetscMPIInt rank, size;

/* Cells lo..hi of this rank: with 2 or more ranks rank 1 has none. */
static void Range(PetscInt *lo, PetscInt *hi)
{
  PetscInt workers = size > 1 ? size - 1 : 1, me = rank > 1 ? rank - 1 : rank;

  *lo = N * me / workers;
  *hi = rank == 1 ? *lo : N * (me + 1) / workers;
}

/* A row of hexahedra [c, c+1] x [0, 2] x [0, 3], points lexicographic in each. */
static void Bulk(Writer w)
{
  PetscInt   lo, hi, np, nc, *conn;
  PetscReal *X, *u, *s, *level;

  Range(&lo, &hi);
  nc = hi - lo;
  np = 8 * nc;
  assert_int_equal(PetscMalloc5(8 * nc, &conn, 3 * np, &X, 3 * np, &u, 6 * np, &s, nc, &level), 0);
  for (PetscInt p = 0; p < np; p++) {
    PetscReal x = lo + p / 8 + p % 2, y = 2 * (p / 2 % 2), z = 3 * (p / 4 % 2);

    conn[p]      = p;
    X[3 * p]     = x;
    X[3 * p + 1] = y;
    X[3 * p + 2] = z;
    u[3 * p]     = x / 3;
    u[3 * p + 1] = -y;
    u[3 * p + 2] = x * y * z;
    for (PetscInt i = 0; i < 6; i++) s[6 * p + i] = i + x / 7;
  }
  for (PetscInt c = 0; c < nc; c++) level[c] = lo + c;
  assert_int_equal(WriterGrid(w, "bulk", CELL_HEX8, np, X, nc, conn), 0);
  assert_int_equal(WriterField(w, "displacement", PETSC_FALSE, 3, u), 0);
  assert_int_equal(WriterField(w, "stress", PETSC_FALSE, 6, s), 0);
  assert_int_equal(WriterField(w, "level", PETSC_TRUE, 1, level), 0);
  assert_int_equal(PetscFree5(conn, X, u, s, level), 0);
}

/* Lines along the bottom, on rank 0 only and only in the second state. */
static void Contact(Writer w, PetscBool present)
{
  PetscReal X[3 * 5], gap[5];
  PetscInt  conn[8], np = rank == 0 && present ? 5 : 0, nc = np ? 4 : 0;

  for (PetscInt p = 0; p < 5; p++) {
    X[3 * p]     = p;
    X[3 * p + 1] = X[3 * p + 2] = 0;
    gap[p]                      = 0.1 * p;
    if (p < 4) conn[2 * p] = p, conn[2 * p + 1] = p + 1;
  }
  assert_int_equal(WriterGrid(w, "contact", CELL_POLYLINE2, np, X, nc, conn), 0);
  assert_int_equal(WriterField(w, "gap", PETSC_FALSE, 1, gap), 0);
}

static void Write(void **unused)
{
  Writer w;

  assert_int_equal(WriterCreate(PETSC_COMM_WORLD, directory, &w), 0);
  for (PetscInt state = 0; state < 2; state++) {
    assert_int_equal(WriterBegin(w, state ? 0.1 + 0.2 : 0.0, 4 + state, state, 0.25 * state), 0);
    Bulk(w);
    Contact(w, state == 1);
    assert_int_equal(WriterEnd(w), 0);
  }
  assert_int_equal(WriterDestroy(&w), 0);
}

static hid_t Open(int state)
{
  char  path[PETSC_MAX_PATH_LEN];
  hid_t file;

  snprintf(path, sizeof(path), "%s/fields_%04d.h5", directory, state);
  file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(file >= 0);
  return file;
}

/* Read a whole data set of n numbers. */
static void Read(hid_t file, const char *name, hid_t type, PetscInt n, void *data)
{
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space;

  assert_true(set >= 0);
  space = H5Dget_space(set);
  assert_int_equal(H5Sget_simple_extent_npoints(space), n);
  assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  H5Sclose(space);
  H5Dclose(set);
}

static double Attribute(hid_t file, const char *name)
{
  double value;
  hid_t  attribute = H5Aopen(file, name, H5P_DEFAULT);

  assert_true(attribute >= 0);
  assert_true(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
  H5Aclose(attribute);
  return value;
}

static void ValuesComeBackExactly(void **unused)
{
  double  X[24 * N], u[24 * N], s[48 * N], level[N];
  int64_t cells[8 * N];
  hid_t   file;

  if (rank) return;
  file = Open(1);
  Read(file, "/bulk/X", H5T_NATIVE_DOUBLE, 24 * N, X);
  Read(file, "/bulk/displacement", H5T_NATIVE_DOUBLE, 24 * N, u);
  Read(file, "/bulk/stress", H5T_NATIVE_DOUBLE, 48 * N, s);
  Read(file, "/bulk/level", H5T_NATIVE_DOUBLE, N, level);
  Read(file, "/bulk/cells", H5T_NATIVE_INT64, 8 * N, cells);
  for (PetscInt p = 0; p < 8 * N; p++) {
    assert_true(X[3 * p] == p / 8 + p % 2); /* parts in rank order: cells come in the order of x */
    assert_true(u[3 * p] == X[3 * p] / 3 && u[3 * p + 1] == -X[3 * p + 1] && u[3 * p + 2] == X[3 * p] * X[3 * p + 1] * X[3 * p + 2]);
    for (PetscInt i = 0; i < 6; i++) assert_true(s[6 * p + i] == i + X[3 * p] / 7);
  }
  for (PetscInt c = 0; c < N; c++) {
    static const int vtk[8] = {0, 1, 3, 2, 4, 5, 7, 6};

    assert_true(level[c] == c);
    for (PetscInt v = 0; v < 8; v++) assert_int_equal(cells[8 * c + v], 8 * c + vtk[v]);
  }
  H5Fclose(file);
}

static void AttributesAreThere(void **unused)
{
  hid_t file;

  if (rank) return;
  file = Open(1);
  assert_true(Attribute(file, "time") == 0.1 + 0.2);
  assert_true(Attribute(file, "step") == 5);
  assert_true(Attribute(file, "pass") == 1);
  assert_true(Attribute(file, "load_time") == 0.25);
  assert_true(Attribute(file, "complete") == 1);
  H5Fclose(file);
}

/* A grid without cells is an empty data set in the file. */
static void EmptyGridIsEmpty(void **unused)
{
  hid_t  file;
  double gap[5];

  if (rank) return;
  file = Open(0);
  Read(file, "/contact/gap", H5T_NATIVE_DOUBLE, 0, gap);
  H5Fclose(file);
  file = Open(1);
  Read(file, "/contact/gap", H5T_NATIVE_DOUBLE, 5, gap);
  assert_true(gap[4] == 0.1 * 4);
  H5Fclose(file);
}

/* A state cut off before WriterEnd has no "complete" and no place in the index; the next series clears it away. */
static void UnfinishedStateShows(void **unused)
{
  char   path[PETSC_MAX_PATH_LEN];
  Writer w;
  hid_t  file;

  snprintf(path, sizeof(path), "%s/fields_0001.h5", directory);
  assert_int_equal(WriterCreate(PETSC_COMM_WORLD, directory, &w), 0);
  if (rank == 0) assert_int_not_equal(access(path, F_OK), 0);
  assert_int_equal(WriterBegin(w, 0, 0, 0, 0), 0);
  Bulk(w);
  assert_int_equal(WriterDestroy(&w), 0);
  if (rank == 0) {
    file = Open(0);
    assert_true(H5Aexists(file, "complete") == 0);
    H5Fclose(file);
  }
  Write(NULL); /* leave the good series behind */
}

/* The index as it stands, on the first rank; freed by the caller. */
static char *IndexNow(void)
{
  char  path[PETSC_MAX_PATH_LEN], *text = calloc(1, 1 << 16);
  FILE *file;

  if (rank) return text;
  snprintf(path, sizeof(path), "%s/fields.xdmf", directory);
  file = fopen(path, "r");
  assert_non_null(file);
  assert_in_range(fread(text, 1, (1 << 16) - 1, file), 100, (1 << 16) - 2);
  fclose(file);
  return text;
}

/* A series goes on after the states of a load step: the same index as if it had never been broken off. Later states stay until the next one is written. */
static void SeriesGoesOn(void **unused)
{
  Writer   w;
  PetscInt num;
  char    *before = IndexNow(), *after, later[PETSC_MAX_PATH_LEN];

  snprintf(later, sizeof(later), "%s/fields_0007.h5", directory);
  if (rank == 0) fclose(fopen(later, "w"));
  assert_int_equal(WriterResume(PETSC_COMM_WORLD, directory, 4, 1, &w), 0);
  assert_int_equal(WriterNumStates(w, &num), 0);
  assert_int_equal(num, 1);
  after = IndexNow();
  assert_string_equal(before, after);
  free(after);
  if (rank == 0) assert_int_equal(access(later, F_OK), 0);
  assert_int_equal(WriterBegin(w, 0.1 + 0.2, 5, 1, 0.25), 0);
  if (rank == 0) assert_int_not_equal(access(later, F_OK), 0);
  Bulk(w);
  Contact(w, PETSC_TRUE);
  assert_int_equal(WriterEnd(w), 0);
  after = IndexNow();
  assert_string_equal(before, after);
  free(after);
  free(before);
  assert_int_equal(WriterDestroy(&w), 0);

  assert_int_equal(ErrorHandlerPush(), 0);
  assert_int_equal(WriterResume(PETSC_COMM_WORLD, directory, 4, 2, &w), MORTISE_ERR_INPUT);
  assert_int_equal(WriterDestroy(&w), 0);
  assert_int_equal(WriterResume(PETSC_COMM_WORLD, directory, 5, 1, &w), MORTISE_ERR_INPUT);
  assert_int_equal(WriterDestroy(&w), 0);
  assert_int_equal(PetscPopErrorHandler(), 0);
}

/* Does a document of the index list this state? */
static PetscBool Lists(const char *name, int state)
{
  char  path[PETSC_MAX_PATH_LEN], text[1 << 14] = "", file[32];
  FILE *index;

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  snprintf(file, sizeof(file), ">fields_%04d.h5:", state);
  if (!(index = fopen(path, "r"))) return PETSC_FALSE;
  text[fread(text, 1, sizeof(text) - 1, index)] = 0;
  fclose(index);
  return (PetscBool)(strstr(text, file) != NULL);
}

/* Three states of load step 1 at one time, one of step 2: the first two are in the index of passes alone, which goes with the last of its passes. */
static void PassesStandApart(void **unused)
{
  static const PetscInt  step[]     = {1, 1, 1, 2};
  static const PetscBool at_times[] = {PETSC_FALSE, PETSC_FALSE, PETSC_TRUE, PETSC_TRUE};
  Writer                 w;

  assert_int_equal(WriterCreate(PETSC_COMM_WORLD, directory, &w), 0);
  for (PetscInt state = 0; state < 4; state++) {
    assert_int_equal(WriterBegin(w, step[state], step[state], state, step[state]), 0);
    Bulk(w);
    assert_int_equal(WriterEnd(w), 0);
    if (rank == 0) assert_true(Lists("fields.xdmf", state) && Lists("passes.xdmf", state) == (state > 0));
  }
  assert_int_equal(WriterDestroy(&w), 0);
  for (PetscInt state = 0; state < 4 && rank == 0; state++) {
    assert_true(Lists("passes.xdmf", state));
    assert_true(Lists("fields.xdmf", state) == at_times[state]);
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  assert_int_equal(WriterResume(PETSC_COMM_WORLD, directory, 1, 3, &w), 0);
  assert_int_equal(WriterBegin(w, 2, 2, 0, 2), 0);
  if (rank == 0) assert_true(!Lists("passes.xdmf", 3) && Lists("passes.xdmf", 2));
  assert_int_equal(WriterDestroy(&w), 0);
  Write(NULL);
  if (rank == 0) assert_true(!Lists("passes.xdmf", 0));
}

static void WrongUseIsAnError(void **unused)
{
  Writer    w;
  PetscReal value = 0;

  assert_int_equal(PetscPushErrorHandler(PetscReturnErrorHandler, NULL), 0);
  assert_int_equal(WriterCreate(PETSC_COMM_WORLD, "/nowhere/at/all", &w), PETSC_ERR_FILE_WRITE);
  assert_int_equal(WriterCreate(PETSC_COMM_WORLD, directory, &w), 0);
  assert_int_equal(WriterEnd(w), PETSC_ERR_ORDER);
  assert_int_equal(WriterBegin(w, 1.0, 0, 0, 0), 0);
  assert_int_equal(WriterField(w, "gap", PETSC_FALSE, 1, &value), PETSC_ERR_ORDER);
  Bulk(w);
  assert_int_equal(WriterField(w, "gap", PETSC_FALSE, 2, &value), PETSC_ERR_ARG_OUTOFRANGE);
  assert_int_equal(WriterField(w, "a<b", PETSC_FALSE, 1, &value), PETSC_ERR_ARG_WRONG);
  assert_int_equal(WriterBegin(w, 2.0, 0, 0, 0), PETSC_ERR_ORDER);
  assert_int_equal(WriterEnd(w), 0);
  assert_int_equal(WriterBegin(w, 0.5, 0, 1, 0), PETSC_ERR_ARG_OUTOFRANGE);
  assert_int_equal(WriterBegin(w, 1.0, 1, 0, 0), PETSC_ERR_ARG_OUTOFRANGE);
  assert_int_equal(WriterDestroy(&w), 0);
  assert_int_equal(PetscPopErrorHandler(), 0);
  Write(NULL);
}

/* The directory: told, or a fresh one. */
static int Begin(void **unused)
{
  if (PetscOptionsGetString(NULL, NULL, "-directory", directory, sizeof(directory), &keep)) return 1;
  return keep ? 0 : DirectoryCreate(unused);
}

static int End(void **unused)
{
  return keep ? 0 : DirectoryRemove(unused);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(Write),
      cmocka_unit_test(ValuesComeBackExactly),
      cmocka_unit_test(AttributesAreThere),
      cmocka_unit_test(EmptyGridIsEmpty),
      cmocka_unit_test(UnfinishedStateShows),
      cmocka_unit_test(SeriesGoesOn),
      cmocka_unit_test(PassesStandApart),
      cmocka_unit_test(WrongUseIsAnError),
  };
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  failed = cmocka_run_group_tests(tests, Begin, End);
  if (PetscFinalize()) return 1;
  return failed;
}
