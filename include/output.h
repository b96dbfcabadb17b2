/* Floor 8. Files of a run: HDF5 + XDMF field files, csv tables, summary.json. */
#pragma once
#include "diagnose.h"
#include "path.h"
#include "transfer.h"

/* ---- field files (output/writer.c): one HDF5 file per state; fields.xdmf lists the last of each load step, passes.xdmf all where a step has several ---- */

typedef struct _p_Writer *Writer;
typedef enum { CELL_POLYLINE2, CELL_TRIANGLE3, CELL_QUAD4, CELL_HEX8 } CellShape; /* VTK/XDMF vertex order is applied by the writer; conn comes lexicographic */

/* Open directory/fields.xdmf for a new series (directory must exist). The index is rewritten (to a temporary, then renamed) after each state: readable at any
 * time. Collective. */
/* Index and fields_KKKK.h5 of an earlier series in the same directory are removed, so that what is there belongs together. */
PetscErrorCode WriterCreate(MPI_Comm, const char *directory, Writer *);
/* They are removed alone: fields of an earlier run beside the tables of one without. Collective. */
PetscErrorCode OutputForgetFields(MPI_Comm, const char *directory);
/* Go on with the series in directory: `num` states, the last of a load step; those of later steps are dropped when the next state is written. No index: it
 * begins with the next state, whose number is num. An input error when the index lists other states up to this step. Collective. */
PetscErrorCode WriterResume(MPI_Comm, const char *directory, PetscInt step, PetscInt num, Writer *);
/* Has the file of a state this attribute ("complete" is written last)? 1, 0, or -1: it cannot be opened. Not collective. */
int            OutputStateHas(const char *path, const char *attribute);
PetscErrorCode WriterNumStates(Writer, PetscInt *num); /* completed so far */
PetscErrorCode WriterDestroy(Writer *);
/* From now on the files tell units of fields (attribute unit of a data set; units of the file) and what the values of body, pair and side stand for
 * (attribute names), after the scene, borrowed. */
void WriterDescribe(Writer, const SceneData *);
/* Begin state number k (0, 1, …) at XDMF time `time` (the same within a load step, then increasing), with scalar attributes. One file directory/fields_KKKK.h5,
 * collective parallel HDF5, chunked + shuffle + deflate. */
PetscErrorCode WriterBegin(Writer, PetscReal time, PetscInt step, PetscInt pass, PetscReal load_time);
/* This rank's part of a grid: points X[np][3] and cells conn[nc][vertices], local point numbers, lexicographic (triangles: in order). Parts of ranks are
 * concatenated in rank order; ranks may have none. */
PetscErrorCode WriterGrid(Writer, const char *grid, CellShape, PetscInt np, const PetscReal *X, PetscInt nc, const PetscInt *conn);
/* A field of the last grid: at points ([np][ncomp]) or cells ([nc][ncomp]); ncomp 1 (Scalar), 3 (Vector), 6 (Tensor6: xx xy xz yy yz zz), 9 (Tensor, row by
 * row), integer-valued fields as PetscReal. */
PetscErrorCode WriterField(Writer, const char *name, PetscBool at_cells, PetscInt ncomp, const PetscReal *data);
PetscErrorCode WriterEnd(Writer); /* flush, attribute "complete", close, rewrite the index */
/* After an error between Begin and End (a full disk), before the run ends: the file of the open state goes, half of it is of no use. Not collective. */
void WriterAbandon(Writer);

/* ---- tables ------------------------------------------------------------------------------------------------------------ */

/* csv with named columns, written by rank 0, flushed after each row. Columns: names[n]; rows: values[n], %.12g; NaN: an empty
   field, there is no such figure. */
typedef struct _p_Table *Table;
PetscErrorCode           TableCreate(MPI_Comm, const char *path, PetscInt n, const char *const names[], Table *);
/* Where a table stands: after the rows of a step (first column; 0: before the first), which ended at t (column t). The path of loads may be computed several
 * times (adapt.repeat: path), by number: column pass; -1: it is not. Rows of the paths before may stand above (earlier). */
typedef struct {
  PetscInt  step, path;
  PetscReal t;
  PetscBool earlier;
} TablePlace;
/* Go on with the table in path from there; what follows is dropped when the next row is written. No file: a new one. An input error when it has other columns,
 * or no row of this step at this t. */
PetscErrorCode TableResume(MPI_Comm, const char *path, PetscInt n, const char *const names[], const TablePlace *, Table *);
/* The number in a named column of a table's first row; NaN when there is none. One rank's. */
PetscErrorCode TableFirst(const char *path, const char *name, PetscReal *value);
PetscErrorCode TableRow(Table, const PetscReal values[]);
PetscErrorCode TableDestroy(Table *);

/* ---- summary (output/replace.c) ---------------------------------------------------------------------------------------- */

/* Write a JSON document (rank 0's; others may pass NULL) to path: to a temporary, then renamed, so that a reader never sees half of it. Numbers that are not
   finite become null. Collective. */
struct cJSON;
PetscErrorCode SummaryWrite(MPI_Comm, const char *path, const struct cJSON *document);

/* ---- fields of a state (output/state.c, stress.c, contactgrid.c, segments.c) -------------------------------------------------------- */

/* Write one state as the grids below. Points stand at reference positions; `displacement` moves them. estimate NULL: error is 0. Evaluates the residual when
   there is contact, so that its tables belong to this state. Collective.

   Grid bulk: owned cells of all ranks, each cut into n^dim pieces at the points of an equispaced lattice (HPSpaceLattice: neighbours meet, whatever their n);
   n is OutputSpec.divide, or the cell's order p (a cell of order 1 is straight), the next power of two in meshes of mixed order. Two layouts, one for a whole
   run:
   - A scene that only ever has cells of order 1, not divided, shares points between the cells of a rank; stress-like fields are per cell (value at its centre).
   - Any other scene gives each cell its own (n+1)^dim points; stress-like fields are per point, continuous within a cell only.
   - Per point: displacement. Per cell: order, level (largest number of halvings of the coarse cell in one direction), body, rank, error (square root of the
     indicator), cell (number of the leaf).
   - Stress-like: pressure (-tr(sigma)/3), stress (Cauchy: xx xy xz yy yz zz), von_mises, J, with plastic materials plastic_strain. They are evaluated at the
   p^dim Gauss points, where derivatives of the solution are most accurate (and the pressure of mixed cells lives), and extended over the cell by polynomials of
   degree p-1 in each direction. In rigid bodies the stress is 0 and J is 1; in small kinematics sigma is the linear law's stress and J = 1 + tr(grad u).

   - On demand (OutputSpec.quantities), at the same points in the same way: principal_stretches (square roots of the eigenvalues of F F^T, the largest first),
     logarithmic_strain (ln V = ln(F F^T)/2, spatial: xx xy xz yy yz zz), energy_density (W, per reference volume; what is stored, not what flow took),
     first_piola (P = dW/dF: xX xY xZ yX ... zZ). In rigid bodies stretches are 1, all others 0; in small kinematics the strain is the linear one, stretches
     are 1 + its eigenvalues, P is the stress.

   Grid contact: the facets (edges, quadrilaterals) of both sides of all pairs; no point belongs to two of them.
   - Per point: displacement, gap, contact_pressure, status (0 open, 1 in contact, -1 faces nothing or carries no multiplier), normal (unit, out of the body).
     Nonmortar side: gap gt_j/w_j (0 where status is -1), pressure z_j, normals as the contact uses them. At hanging nodes: pressure and gap of their masters,
     interpolated; status the largest of theirs.
     Mortar side: means of the nonmortar side's values over the node's segments, weighted by the node's hat (contactfield.c), status 1 where at least half of
     what faces the node touches; normals: sum of the unit normals of the node's facets, normalised.
   - Per cell: pair (index), side (0 nonmortar, 1 mortar), cell (leaf).

   Grid segments, with OutputSpec.segments: where a mortar facet faces a nonmortar facet.
   - Two dimensions: a quad for each segment, between the parts of both edges. Per point: displacement.
   - Three dimensions: a fan of triangles for each segment, on the nonmortar facet. Per point: displacement, gap (distance along the facet's normal at that
   point; initial_gap and interference do not enter).
   - Per cell: pair, facet, mortar_facet (numbers within the sides of their pair, in the order of grid contact). */
PetscErrorCode OutputWriteState(Writer, Problem, const State *, const Estimate *, PetscReal series_time, PetscInt step, PetscInt pass);
/* The contact and segments grids of it; tables as of the last evaluation. Collective. */
PetscErrorCode OutputWriteContact(Writer, Problem);

/* Cauchy stress sigma[6] (xx xy xz yy yz zz) and J (NULL: skip) from F and first Piola stress P, row-major. */
void OutputCauchy(Kinematics, const PetscReal F[9], const PetscReal P[9], PetscReal sigma[6], PetscReal *J);
/* Stress-like values of one cell: 7 numbers (sigma, J) at its p^dim Gauss points, samples[p^dim][7]; rigid bodies: zero stress, J = 1. u: local displacement
 * array. */
PetscErrorCode OutputSampleCell(Problem, PetscInt cell, const PetscReal u[], PetscReal samples[]);
/* Principal stretches, the largest first, and logarithmic strain (xx xy xz yy yz zz) of a deformation gradient with det F > 0. */
PetscErrorCode OutputStrain(Kinematics, const PetscReal F[9], PetscReal stretch[3], PetscReal strain[6]);
/* The fields on demand at the same points of one cell, samples[p^dim][OUTPUT_QUANTITIES]: stretches, strain, W, P. */
#define OUTPUT_QUANTITIES 19
PetscErrorCode OutputSampleQuantities(Problem, PetscInt cell, const PetscReal u[], PetscReal samples[]);
/* Plastic strain at the same points of one cell, samples[p^dim]. */
PetscErrorCode OutputSamplePlastic(Problem, PetscInt cell, const PetscReal u[], PetscReal samples[]);
/* Extension of num components from the p^dim Gauss points of a cell of order p to its equispaced lattice of (pieces+1)^dim points, lexicographic, components
   fastest. nodal and work: room for max(order, pieces+1)^dim * num numbers. */
PetscErrorCode OutputExtend(PetscInt dim, PetscInt order, PetscInt pieces, PetscInt num, const PetscReal samples[], PetscReal nodal[], PetscReal work[]);

/* ---- probes (output/probe.c) --------------------------------------------------------------------------------------------- */

/* The scene's probes, found once in the coarse mesh (exact geometry): places survive adaptation. A point outside all cells by more than 1 % of a cell is an
   input error that names the probe; one that lies outside by less is moved onto the cell. Where several bodies meet and the probe names none, the first one's,
   and a note. Collective. */
typedef struct _p_Probes *Probes;
PetscErrorCode            ProbesCreate(const SceneData *, Forest, Probes *);
PetscErrorCode            ProbesDestroy(Probes *);
/* Coarse cell and place in it, xi[3] in [0,1]. */
PetscErrorCode ProbesGetPlace(Probes, PetscInt probe, PetscInt *root, PetscReal xi[3]);
typedef struct {
  PetscReal displacement[3], stress[6], plastic_strain; /* Cauchy; strain 0 where nothing flows */
} ProbeValue;
/* value[num] of all probes, on all ranks. Collective. */
PetscErrorCode ProbesEvaluate(Probes, Problem, Vec x, ProbeValue value[]);

/* ---- history.csv and adapt.csv (output/history.c) ------------------------------------------------------------------------ */

/* What stands in the files of a run, by name (output/fields.c): the columns are made from these rows, and so is the manual. In names <boundary>, <pair>, …
   stand for any of a scene's. Ended by name NULL. */
typedef struct {
  const char *name, *unit, *help; /* unit: kind of quantity, as in the option table */
} OutputField;
extern const OutputField OutputAdaptColumns[], OutputHistoryColumns[], OutputSummaryFields[], OutputFieldFields[];
/* Name of a column with its unit in brackets, as it stands in a csv file; without one when the scene has no units, or the column none. Not collective. */
PetscErrorCode OutputColumnName(const SceneData *, const OutputField fields[], const char *name, size_t, char column[]);

typedef struct _p_History *History;
/* Open both in the output directory, which must exist: afresh (after NULL), or to go on after a load step (TableResume; `earlier` is set here: adapt.csv has
   the rows of all paths, history.csv those of the last). Collective. */
PetscErrorCode HistoryCreate(MPI_Comm, const SceneData *, Probes, const TablePlace *after, History *);
/* The path of loads begins again: so does history.csv, whose file has been moved (OutputSetAside). Collective. */
PetscErrorCode HistoryAgain(History);
PetscErrorCode HistoryPass(History, const ReportRow *);                                          /* a row of adapt.csv. Collective. */
PetscErrorCode HistoryStep(History, const ReportRow *, const Balance *, Problem, const State *); /* a row of history.csv. Collective. */
PetscErrorCode HistoryDestroy(History *);

/* ---- summary.json (output/summary.c) ------------------------------------------------------------------------------------- */

struct cJSON;
/* What could have been left out of the model, and what that would do. */
typedef struct {
  const char   *part;               /* of the model: contact, flow, fibers, ... */
  char          name[MORTISE_NAME]; /* of the pair, body, material, axis; of no one: scene */
  PetscReal     change;             /* estimate, relative: the largest change of forces and of the energy norm */
  PetscReal     saves;              /* estimate: share of the run's time */
  PetscBool     keeps;              /* the change is within the tolerance */
  struct cJSON *set;                /* owned, rank 0: keys of the scene with their new values, null: without */
  char          why[256];
} Need;
typedef struct {
  PetscReal tolerance; /* adapt.tolerance; without one, the estimated error */
  PetscInt  num;
  Need     *rows; /* owned */
} Needs;

typedef struct {
  const char     *status, *reason; /* "converged", "inaccurate" (the mesh could not be refined as asked), "failed", "stopped"; why, or what is lacking, or "" */
  const char     *adapt_stop;      /* why the last adaptation ended: "tolerance", "max_passes", "max_cells", …; NULL or "": there was none */
  PetscReal       t, seconds;      /* pseudo-time reached; wall time so far */
  PetscInt        load_steps, adapt_passes;
  const Path     *path;     /* what its solutions took; NULL: nothing was solved */
  Problem         problem;  /* of the last accepted state; NULL: nothing was solved */
  const State    *state;    /* with problem */
  const Balance  *balance;  /* with problem; NULL: no figures */
  const Estimate *estimate; /* NULL: not estimated */
  Probes          probes;   /* NULL: none */
  const Needs    *needs;    /* NULL: not known */
} RunSummary;

/* Write summary.json into the scene's output directory. Unknown figures are null. peak_memory_mb is the sum over ranks,
   peak_memory_rank_mb the largest of one; times are the largest of any rank. Collective. */
PetscErrorCode OutputSummary(MPI_Comm, const SceneData *, const RunSummary *);
/* Make the directory and its parents; an input error when that is impossible. Collective. */
PetscErrorCode OutputDirectoryCreate(MPI_Comm, const char *path);

/* ---- whose directory it is (output/lock.c, foreign.c) ---------------------------------------------------------------------- */

/* Take the directory for this run, until OutputUnlock or the end of all its processes; an input error that names the other run when there is one. overwrite:
   a file of the lock's name that is none goes. Collective. */
PetscErrorCode OutputLock(MPI_Comm, const char *directory, PetscBool overwrite);
/* Before anything is written: an error when the lock's file was taken away, and perhaps another run is there. Collective. */
PetscErrorCode OutputHold(MPI_Comm);
/* At any end; harmless without a lock. Not collective. */
void OutputUnlock(void);
/* An input error when the directory has files that a run would replace or remove and none has written, which may be with overwrite, or that may not be
   written. Collective. */
PetscErrorCode OutputCheckForeign(MPI_Comm, const char *directory, PetscBool overwrite);
PetscBool      OutputIsOurs(const char *name); /* is it a name in output.directory that a run writes or removes? Not collective. */

/* ---- results put aside (output/earlierpath.c) ----------------------------------------------------------------------------------- */

#define OUTPUT_ASIDE "earlier_path" /* in output.directory: results of the last path of loads that came to its end, until a finer one does */
/* Move history.csv, fields.xdmf and passes.xdmf with their files and summary.json there, in place of what is there. Collective. */
PetscErrorCode OutputSetAside(MPI_Comm, const char *directory);
/* Go on with that where it was broken off: when history.csv is of a path before this one. Collective. */
PetscErrorCode OutputFinishAside(MPI_Comm, const char *directory, PetscInt path);
/* Remove what was put aside, if anything. Collective. */
PetscErrorCode OutputDropAside(MPI_Comm, const char *directory);
PetscErrorCode OutputHasAside(MPI_Comm, const char *directory, PetscBool *has); /* collective */

/* ---- checkpoints (output/checkpoint.c, checkpointfile.c) ------------------------------------------------------------------- */

/* Everything that evolves, at the end of a load step, apart from any partition: forest, orders, state, and named numbers of the caller. A file of it is HDF5
   behind a seal of 512 bytes (format, length, checksum):
     /physics, /note                   texts: what must agree with the scene (OutputPhysics); the caller's
     attributes of /: mesh, revision, ranks   hash of the coarse mesh; revision of the forest; ranks that wrote it
     /split, /order, /owner            int8 by tree node (ForestGetSplits), int8 and int32 by leaf
     /fields/<name>                    float64, as in Pack; values: CheckpointPutValues
     attributes of /numbers            float64 each */
typedef struct _p_Checkpoint *Checkpoint;
typedef struct {
  char      name[MORTISE_NAME];
  PetscReal value;
} CheckpointNumber;

/* Copy a state, with the prescribed motion as applied; among its numbers is "t". Collective. */
PetscErrorCode CheckpointCreate(Problem, const State *, PetscInt num, const CheckpointNumber numbers[], const char *note, Checkpoint *);
PetscErrorCode CheckpointDestroy(Checkpoint *);
/* Any amount of further numbers of the caller, the same on every rank; put once. values[*num] is freed by the caller; none: *num 0. Collective. */
PetscErrorCode CheckpointPutValues(Checkpoint, PetscInt num, const PetscReal values[]);
PetscErrorCode CheckpointGetValues(Checkpoint, PetscInt *num, PetscReal **values);
#define CHECKPOINT_FILE "checkpoint.h5"
#define CHECKPOINT_BEFORE "checkpoint_before.h5" /* beside it: the one that had its name */
/* Write path, or leave the file that is there as it is: a kill at any moment leaves one of the two, whole. Collective. */
PetscErrorCode CheckpointWrite(Checkpoint, const char *path);
/* Does its seal hold? Not collective. */
PetscBool CheckpointIsWhole(const char *path);
/* Read a file on any number of ranks; one sentence (ErrorInput) when it is not there, cut short, damaged, of another format or no checkpoint. Collective. */
PetscErrorCode CheckpointRead(MPI_Comm, const char *path, Checkpoint *);
/* Does it belong to this scene on this coarse mesh? An input error when not. Not collective (input is replicated). */
PetscErrorCode CheckpointCheck(Checkpoint, const SceneData *, Forest coarse);
/* Its forest over the coarse mesh of another one: partitioned as it was, or anew when the number of ranks differs. Collective. */
PetscErrorCode CheckpointForest(Checkpoint, Forest coarse, Forest *);
PetscErrorCode CheckpointOrders(Checkpoint, const int8_t **leaf_order); /* [num_leaves], borrowed */
/* Its state into one created on that forest with those orders; the problem is at time t, its prescribed motion applied. Prescribed displacements that are not
   those of the checkpoint are an input error. Collective. */
PetscErrorCode CheckpointState(Checkpoint, Problem, State *);
PetscErrorCode CheckpointGetNumber(Checkpoint, const char *name, PetscReal *value); /* an input error when it is not there */
const char    *CheckpointNote(Checkpoint);                                          /* borrowed */
