/* Floor 7. Files of a run: HDF5 + XDMF field files, csv tables, summary.json. */
#pragma once
#include "base.h"

/* ---- field files (output/writer.c): fields.xdmf + one HDF5 file per state -------------------------------------------- */

typedef struct _p_Writer *Writer;
typedef enum { CELL_POLYLINE2, CELL_QUAD4, CELL_HEX8 } CellShape; /* VTK/XDMF vertex order is applied by the writer; conn comes lexicographic */

/* Open directory/fields.xdmf for a new series (directory must exist). The index is rewritten (to a temporary, then renamed) after each state: readable at any time. Collective. */
/* Index and fields_KKKK.h5 of an earlier series in the same directory are removed, so that what is there belongs together. */
PetscErrorCode WriterCreate(MPI_Comm, const char *directory, Writer *);
PetscErrorCode WriterDestroy(Writer *);
/* Begin state number k (0, 1, …) at XDMF time `time` (strictly increasing), with scalar attributes. One file directory/fields_KKKK.h5, collective parallel HDF5, chunked + shuffle + deflate. */
PetscErrorCode WriterBegin(Writer, PetscReal time, PetscInt step, PetscInt pass, PetscReal load_time);
/* This rank's part of a grid: points X[np][3] and cells conn[nc][2^d], local point numbers, lexicographic. Parts of ranks are concatenated in rank order; ranks may have none. */
PetscErrorCode WriterGrid(Writer, const char *grid, CellShape, PetscInt np, const PetscReal *X, PetscInt nc, const PetscInt *conn);
/* A field of the last grid: at points ([np][ncomp]) or cells ([nc][ncomp]); ncomp 1 (Scalar), 3 (Vector), 6 (Tensor6: xx xy xz yy yz zz), integer-valued fields as PetscReal. */
PetscErrorCode WriterField(Writer, const char *name, PetscBool at_cells, PetscInt ncomp, const PetscReal *data);
PetscErrorCode WriterEnd(Writer); /* flush, attribute "complete", close, rewrite the index */

/* ---- tables ------------------------------------------------------------------------------------------------------------ */

/* csv with named columns, written by rank 0, flushed after each row. Columns: names[n]; rows: values[n], %.12g. */
typedef struct _p_Table *Table;
PetscErrorCode TableCreate(MPI_Comm, const char *path, PetscInt n, const char *const names[], Table *);
PetscErrorCode TableRow(Table, const PetscReal values[]);
PetscErrorCode TableDestroy(Table *);

/* ---- summary (output/replace.c) ---------------------------------------------------------------------------------------- */

/* Write a JSON document (rank 0's; others may pass NULL) to path: to a temporary, then renamed, so that a reader never sees half of it. Numbers that are not
   finite become null. Collective. */
struct cJSON;
PetscErrorCode SummaryWrite(MPI_Comm, const char *path, const struct cJSON *document);
