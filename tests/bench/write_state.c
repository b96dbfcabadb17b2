/* Seconds and bytes of writing one state: hexahedra with displacement, stress, von Mises and four cell fields.   -n 64: cells in each direction (default 48) */
#include "output.h"
#include <sys/stat.h>

/* Seconds of writing `states` states of n^3 cells, and the bytes of the last file. */
static PetscErrorCode Measure_Private(const char *directory, PetscInt n, PetscInt states, PetscLogDouble *seconds, double *bytes)
{
  PetscMPIInt    rank, size;
  PetscInt       lo, hi, m = n + 1, np, nc, *conn;
  PetscReal     *X, *u, *s, *v, *c;
  PetscLogDouble start, end;
  Writer         w;
  struct stat    status;
  char           path[PETSC_MAX_PATH_LEN];

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
  lo = n * rank / size; /* slabs in z */
  hi = n * (rank + 1) / size;
  nc = (hi - lo) * n * n;
  np = (hi - lo + 1) * m * m;
  PetscCall(PetscMalloc6(8 * nc, &conn, 3 * np, &X, 3 * np, &u, 6 * np, &s, np, &v, nc, &c));
  for (PetscInt p = 0; p < np; p++) {
    PetscReal x = (p % m) / (PetscReal)n, y = (p / m % m) / (PetscReal)n, z = (lo + p / (m * m)) / (PetscReal)n;

    X[3 * p] = x, X[3 * p + 1] = y, X[3 * p + 2] = z;
    for (PetscInt i = 0; i < 3; i++) u[3 * p + i] = 0.1 * PetscSinReal(3 * x + i) * PetscCosReal(2 * y - z);
    for (PetscInt i = 0; i < 6; i++) s[6 * p + i] = PetscExpReal(-x * i) * PetscSinReal(5 * y + z);
    v[p] = PetscSqrtReal(x + y * z + 0.1);
  }
  for (PetscInt e = 0; e < nc; e++) {
    PetscInt p = e % n + m * (e / n % n) + m * m * (e / (n * n));

    c[e] = e % 7;
    for (PetscInt i = 0; i < 8; i++) conn[8 * e + i] = p + i % 2 + m * (i / 2 % 2) + m * m * (i / 4);
  }
  PetscCall(WriterCreate(PETSC_COMM_WORLD, directory, &w));
  PetscCall(PetscTime(&start));
  for (PetscInt k = 0; k < states; k++) {
    PetscCall(WriterBegin(w, k, k, 0, k));
    PetscCall(WriterGrid(w, "bulk", CELL_HEX8, np, X, nc, conn));
    PetscCall(WriterField(w, "displacement", PETSC_FALSE, 3, u));
    PetscCall(WriterField(w, "stress", PETSC_FALSE, 6, s));
    PetscCall(WriterField(w, "von_mises", PETSC_FALSE, 1, v));
    PetscCall(WriterField(w, "order", PETSC_TRUE, 1, c));
    PetscCall(WriterField(w, "level", PETSC_TRUE, 1, c));
    PetscCall(WriterField(w, "body", PETSC_TRUE, 1, c));
    PetscCall(WriterField(w, "error", PETSC_TRUE, 1, c));
    PetscCall(WriterEnd(w));
  }
  PetscCall(PetscTime(&end));
  *seconds = (end - start) / states;
  PetscCall(WriterDestroy(&w));
  PetscCall(PetscFree6(conn, X, u, s, v, c));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/fields_0000.h5", directory));
  *bytes = stat(path, &status) ? -1 : (double)status.st_size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  char           directory[] = "/tmp/mortise-bench-XXXXXX";
  PetscInt       n           = 48;
  PetscMPIInt    rank;
  PetscLogDouble seconds;
  double         bytes;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-n", &n, NULL));
  PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  PetscCheck(rank || mkdtemp(directory), PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "No temporary directory");
  PetscCallMPI(MPI_Bcast(directory, sizeof(directory), MPI_CHAR, 0, PETSC_COMM_WORLD));
  PetscCall(Measure_Private(directory, 4, 20, &seconds, &bytes));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "write_state: %8d cells %8.4f s/state %10.0f bytes\n", 4 * 4 * 4, seconds, bytes));
  PetscCall(Measure_Private(directory, n, 1, &seconds, &bytes));
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "write_state: %8" PetscInt_FMT " cells %8.4f s/state %10.0f bytes\n", n * n * n, seconds, bytes));
  if (rank == 0) PetscCall(PetscRMTree(directory));
  PetscCall(PetscFinalize());
  return 0;
}
