/* Private to output: the XDMF index that the writer keeps, whole-file replacement, fields of contact surfaces. */
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

/* ---- contact surfaces (output/contactfield.c, segments.c) ----------------------------------------------------------------- */

/* Values of `status`. */
#define CONTACT_ALONE (-1) /* faces nothing, or carries no multiplier */
#define CONTACT_OPEN 0
#define CONTACT_TOUCHING 1

/* Fields at the nodes of one side, [num_nodes] each; borrowed. Meaning: output.h. */
typedef struct {
  PetscReal *gap, *pressure, *status;
} ContactFields;

/* Fields of the nonmortar side as of the last evaluation. */
void OutputContactFields(const ContactView *, ContactFields *);
/* The same on the mortar side, from those of the nonmortar side, on all ranks. Collective. */
PetscErrorCode OutputProjectFields(Problem, PetscInt pair, const ContactFields *nonmortar, ContactFields *mortar);

/* Hats at xi[dim-1] in [-1, 1] of a facet's corners, of higher order: of the corners of the piece between nodes of the lattice that xi lies in; 2 or 4 of them
   and their nodes. */
void OutputFacetHats(const SurfaceView *, PetscInt facet, const PetscReal xi[], PetscReal N[4], PetscInt node[4]);
/* Point of a facet when its nodes are at x[num_nodes][dim]. */
void OutputFacetPoint(const SurfaceView *, const PetscReal x[], PetscInt facet, const PetscReal xi[], PetscReal point[3]);
/* Its unit normal there (order 1: in the middle), out of the body; zero for a facet without extent. */
void OutputFacetNormal(const SurfaceView *, const PetscReal x[], PetscInt facet, const PetscReal xi[], PetscReal normal[3]);

/* Grid segments of a state (output.h). Collective. */
PetscErrorCode OutputWriteSegments(Writer, Problem);
