/* Private to output: the XDMF index that the writer keeps, whole-file replacement, fields of contact surfaces. */
#pragma once
#include "output.h"
#include <errno.h>
#include <hdf5.h>

/* Number of a state by the name of its file; -1: the name is of no such file (output/foreign.c). */
PetscInt OutputStateNumber(const char *name);

/* Rank 0 writes text to path.tmp and renames it to path; every rank returns the same error. Collective. */
PetscErrorCode OutputReplaceFile(MPI_Comm, const char *path, const char *text);

/* An error of HDF5, with the file that OutputAccess was last asked for. */
#define PetscCallH5(call)                                                                                                                                      \
  PetscCheck((call) >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: %s (HDF5 failed in %.24s)", OutputAccessed(), OutputErrno(), #call)
#define PetscCallH5Id(id, call) PetscCallH5((id) = (call))
const char *OutputAccessed(void);
const char *OutputErrno(void); /* errno in words */

/* Scalar attributes of an HDF5 object (output/hdf5.c): of any type, 64-bit integer, double. */
PetscErrorCode OutputAttribute(hid_t object, const char *name, hid_t stored, hid_t type, const void *value);
PetscErrorCode OutputAttributeInt(hid_t object, const char *name, PetscInt value);
PetscErrorCode OutputAttributeReal(hid_t object, const char *name, PetscReal value);
/* An array of texts; one alone: a scalar. */
PetscErrorCode OutputAttributeTexts(hid_t object, const char *name, PetscInt num, const char *const texts[]);
/* The access list with which all ranks open a file together; one rank: HDF5's own driver, which writes the same bytes and spares loading MPI-IO.
   path: for messages, until the next one. */
PetscErrorCode OutputAccess(MPI_Comm, const char *path, hid_t *access);

#define OUTPUT_SET 8192 /* bytes of a data set of HDF5, and its attributes, beside its numbers, at most */
/* reserve.c. Room for a file that is being written from its start to so many bytes; an error where there is none (collective). What was not used of it. */
PetscErrorCode OutputReserve(MPI_Comm, const char *path, int64_t bytes);
void           OutputGiveBack(const char *path, int64_t bytes);
/* foreign.c. The input error of a file in it that is no run's. */
PetscErrorCode OutputTellForeign(const char *directory, const char *name);
#define LOCK_FILE "lock"
#define LOCK_BEGINS "process "

/* Growable text; {0} is empty and valid. */
typedef struct {
  char  *text; /* owned, zero-terminated once something was printed */
  size_t used, size;
} OutputText;
PetscErrorCode OutputTextPrint(OutputText *, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
PetscErrorCode OutputTextDestroy(OutputText *);

/* ---- checkpoints (output/physics.c, seal.c) ----------------------------------------------------------------------- */

/* Model, bodies with their materials, contact pairs: what must be the same when a run is continued; a line each. */
PetscErrorCode OutputPhysics(const SceneData *, const CoarseMesh *, OutputText *);
#define OUTPUT_DIFFERENCE 256
/* Where two such texts first differ: what each has there, "" where it has ended. PETSC_FALSE: nowhere. */
PetscBool OutputFirstDifference(const char *a, const char *b, char what[2][OUTPUT_DIFFERENCE]);

/* To be raised when what stands under a name changes its meaning; what has come under a new name is missed where it is not. */
#define CHECKPOINT_FORMAT 1
struct _p_Checkpoint {
  MPI_Comm          comm;
  char              path[PETSC_MAX_PATH_LEN]; /* file it was read from; "": made in memory */
  char             *physics;                  /* owned */
  char              note[2 * MORTISE_NAME];   /* the caller's */
  uint64_t          mesh;                     /* ForestCoarseHash */
  PetscInt          num_splits, num_leaves, revision;
  int8_t           *split, *order; /* owned [num_splits] ForestGetSplits, [num_leaves] */
  PetscMPIInt       ranks, *owner; /* owned [num_leaves]: of so many ranks */
  PetscInt          num_numbers;
  CheckpointNumber *number; /* owned [num_numbers] */
  Pack              pack;
};
#define CHECKPOINT_SEAL 512 /* bytes */
/* Put the seal on a finished HDF5 file, force it to the disk, rename it to path; the file that had the name stays under CHECKPOINT_BEFORE. One rank's; returns
   errno. (output/seal.c) */
int CheckpointSeal(const char *temporary, const char *path);
/* Is the file whole and ours? An input error when not. Collective. */
PetscErrorCode CheckpointVerify(MPI_Comm, const char *path);

/* ---- index of a series (output/xdmf.c): one temporal collection per grid name. Serial: rank 0 keeps it. ---------------- */

#define INDEX_TIMES "fields.xdmf"  /* the last state of each load step */
#define INDEX_PASSES "passes.xdmf" /* all of them, where adaptation made several in one */

typedef struct _p_Index *Index;
typedef struct {
  PetscReal time, load_time;
  PetscInt  step, pass, number;
} IndexState;

PetscErrorCode IndexCreate(Index *);
PetscErrorCode IndexDestroy(Index *);
/* Open the entry of one grid at one state: points and cells of all ranks, data in file under /grid/{X,cells}. */
PetscErrorCode IndexGrid(Index, const IndexState *, const char *grid, CellShape, int64_t num_points, int64_t num_cells, const char *file);
/* A fact about the open entry, in words. */
PetscErrorCode IndexFact(Index, const char *name, const char *value);
/* A field /grid/name of the grid opened last. */
PetscErrorCode IndexField(Index, const char *name, PetscBool at_cells, PetscInt ncomp);
/* Close the open entry. */
PetscErrorCode IndexGridEnd(Index);
/* Has a load step more than one state? */
PetscBool IndexHasPasses(Index);
/* A whole document, at times or of all states by number; the caller destroys the text. */
PetscErrorCode IndexText(Index, PetscBool passes, OutputText *);

/* Fill an empty index from either document, states of later load steps left out. *num: number of the last state + 1; *time: its time. *ours PETSC_FALSE: the
 * text is not of our making. */
PetscErrorCode IndexRead(Index, const char *text, PetscInt step, PetscInt *num, PetscReal *time, PetscBool *ours);

PetscInt CellShapeVertices(CellShape);

/* ---- contact surfaces (output/contactfield.c, segments.c) ----------------------------------------------------------------- */

/* Values of `status`. */
#define CONTACT_ALONE (-1) /* faces nothing, or carries no multiplier */
#define CONTACT_OPEN 0
#define CONTACT_TOUCHING 1

/* Fields at the nodes of one side, [num_nodes] each; borrowed. Meaning: output.h. */
typedef struct {
  PetscReal *gap, *pressure, *status;
  PetscReal *shear, *slip; /* plane: tangential traction along e_z x n of the nonmortar side; slip of the step; 0 without friction */
  PetscReal *traction;     /* [num_nodes][3] on the body: of a tied pair, tangential in space; 0 without either */
} ContactFields;

/* Fields of the nonmortar side as of the last evaluation. */
void OutputContactFields(const ContactView *, ContactFields *);
/* The same on the mortar side, from those of the nonmortar side, on all ranks. Collective. */
PetscErrorCode OutputProjectFields(Problem, PetscInt pair, const ContactFields *nonmortar, ContactFields *mortar);

/* Point of a facet when its nodes are at x[num_nodes][dim]. */
void OutputFacetPoint(const SurfaceView *, const PetscReal x[], PetscInt facet, const PetscReal xi[], PetscReal point[3]);
/* Its unit normal there (order 1: in the middle), out of the body; zero for a facet without extent. */
void OutputFacetNormal(const SurfaceView *, const PetscReal x[], PetscInt facet, const PetscReal xi[], PetscReal normal[3]);

/* Grid segments of a state (output.h). Collective. */
PetscErrorCode OutputWriteSegments(Writer, Problem);
