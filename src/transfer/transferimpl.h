/* Private to transfer. Fields live in root coordinates: a leaf is a dyadic box of its coarse cell, so that a point of a new leaf has exact
   coordinates in the old leaf that contains it, and no geometry is inverted. */
#pragma once
#include "transfer.h"

/* What belongs to both problems. Borrowed. */
typedef struct {
  HPSpace              old_space, new_space;
  Mechanics            old_mechanics, new_mechanics; /* NULL: displacements only */
  const MechanicsSpec *spec;                         /* NULL without mechanics */
  const ForestMap     *map;
  AdaptHistory         kept; /* of plastic flow */
  const HPTables      *old_v, *new_v;
  const ForestTables  *old_t, *new_t;
  PetscMPIInt          rank, size;
  MPI_Comm             comm;
} TransferContext;

/* What travels, arrays of this rank: local displacements; with mechanics the pressures and histories of its cells. */
typedef struct {
  const PetscReal *u, *pressure, *history;
} OldFields;

/* Tensor nodal displacements [(p+1)^dim][dim] and reference positions [(p+1)^dim][dim], then pressure coefficients, then history [points][num_history], of
   every old leaf that overlaps an owned new one. */
typedef struct {
  PetscInt  *offset; /* owned [old num_leaves] into values, -1: not here */
  PetscReal *values; /* owned */
} OldCells;

/* Completes the tables of a context. */
PetscErrorCode TransferContextSetUp_Private(TransferContext *);
/* exchange.c. Collective. */
PetscErrorCode OldCellsFetch_Private(const TransferContext *, const OldFields *, OldCells *);
PetscErrorCode OldCellsDestroy_Private(OldCells *);
/* solution.c: old coordinates xi of the point `place` of a new leaf; PETSC_FALSE: outside. */
PetscBool TransferPlace_Private(const TransferContext *, PetscInt new_leaf, const PetscReal place[], PetscInt old_leaf, PetscReal xi[3]);
/* The old fields at a point of a leaf: place, displacement, and their derivatives by the reference coordinates, [component][coordinate] (1 on the diagonal of
   dX beyond the leaf's dimension). */
typedef struct {
  PetscReal X[3], u[3], dX[3][3], du[3][3];
} OldPoint;
/* work: [(1 + dim) (p+1)^dim] for its order. */
PetscErrorCode TransferOldPoint_Private(const TransferContext *, const OldCells *, PetscInt old_leaf, const PetscReal xi[], PetscReal work[], OldPoint *);
/* Cartesian components as dofs of a node, or (back) dofs as Cartesian components. */
PetscErrorCode TransferTurn_Private(HPSpace, PetscInt dim, PetscInt node, PetscBool back, const PetscReal from[], PetscReal to[]);
/* Dofs of the new space's true nodes owned here, in the frames of the new space; other entries of local stay. Not collective. */
PetscErrorCode TransferDisplacement_Private(const TransferContext *, const OldCells *, PetscReal local[]);
/* pressure.c: coefficients of the new mixed cells owned here, of incompressible ones in unknown (NULL: there are none). Not collective. */
PetscErrorCode TransferPressure_Private(const TransferContext *, const OldCells *, PetscReal pressure[], PetscReal unknown[]);
/* history.c: at the integration points of the new cells owned here; the displacement that was fetched is the one that goes with the history. Not collective. */
PetscErrorCode TransferHistory_Private(const TransferContext *, const OldCells *, PetscReal history[]);
/* Numbers at the nodes of a leaf of this order. */
static inline PetscInt TransferNumNodal_Private(PetscInt dim, PetscInt order)
{
  return 2 * ElementNumNodes(dim, order) * dim;
}
/* Pressure coefficients of a leaf of this order and body. */
PetscInt TransferNumPressure_Private(const TransferContext *, PetscInt body, PetscInt order);
/* multiplier.c: z on this rank's new nonmortar nodes from the old ones, of which those are needed that Needs says (the others are not read); has_multiplier:
   where old values mean something. Not collective. */
PetscErrorCode TransferMultiplierNeeds_Private(const ForestTables *old_t, const SurfaceView *old_view, const SurfaceView *new_view, const ForestMap *,
                                               PetscBool wanted[]);
PetscErrorCode TransferMultiplier_Private(const ForestTables *old_t, const SurfaceView *old_view, const PetscReal z[], const PetscBool has_multiplier[],
                                          const ForestTables *new_t, const SurfaceView *new_view, const ForestMap *, PetscReal new_z[]);

/* This rank's values of a field and their places in it. */
typedef struct {
  PetscInt   num, total;
  PetscInt  *index; /* owned [num] */
  PetscReal *value; /* owned [num] */
} Places;

/* places.c. Send: a field from what all ranks have of it; entries that nobody has are 0. Fetch: this rank's values from a field. Both collective. */
PetscErrorCode PlacesCreate_Private(PetscInt num, PetscInt total, Places *);
PetscErrorCode PlacesDestroy_Private(Places *);
PetscErrorCode PlacesSend_Private(MPI_Comm, const Places *, Vec *field);
/* An input error when the field has another size. */
PetscErrorCode PlacesFetch_Private(Vec field, Places *);
/* pattern.c: a pair's room in the matrix as a field, and back. Collective. */
PetscErrorCode PatternPack_Private(Problem, PetscInt pair, Vec *field);
PetscErrorCode PatternUnpack_Private(Problem, PetscInt pair, Vec field);
