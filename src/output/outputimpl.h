/* Private to output: the XDMF index that the writer keeps, and whole-file replacement. */
#pragma once
#include "output.h"

/* Rank 0 writes text to path.tmp and renames it to path; every rank returns the same error. Collective. */
PetscErrorCode OutputReplaceFile(MPI_Comm, const char *path, const char *text);

/* Growable text; {0} is empty and valid. */
typedef struct {
  char  *text; /* owned, zero-terminated once something was printed */
  size_t used, size;
} OutputText;
PetscErrorCode OutputTextPrint(OutputText *, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PetscErrorCode OutputTextDestroy(OutputText *);

/* ---- index of a series (output/xdmf.c): one temporal collection per grid name. Serial: rank 0 keeps it. ---------------- */

typedef struct _p_Index *Index;
typedef struct {
  PetscReal time, load_time;
  PetscInt  step, pass;
} IndexState;

PetscErrorCode IndexCreate(Index *);
PetscErrorCode IndexDestroy(Index *);
/* Open the entry of one grid at one state: points and cells of all ranks, data in file under /grid/{X,cells}. */
PetscErrorCode IndexGrid(Index, const IndexState *, const char *grid, CellShape, int64_t num_points, int64_t num_cells, const char *file);
/* A field /grid/name of the grid opened last. */
PetscErrorCode IndexField(Index, const char *name, PetscBool at_cells, PetscInt ncomp);
/* Close the open entry. */
PetscErrorCode IndexGridEnd(Index);
/* The whole document; the caller destroys the text. */
PetscErrorCode IndexText(Index, OutputText *);

/* Vertices of a cell shape and its XDMF name. */
PetscInt    CellShapeVertices(CellShape);
const char *CellShapeTopology(CellShape);
