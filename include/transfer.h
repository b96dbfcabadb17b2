/* Floor 6. Solution between two live meshes, and packed for other partitions. */
#pragma once
#include "problem.h"

/* Fill *to (a created state of the new problem) from *from on the old one: displacements by nodal interpolation of the old field (exact under refinement
   of straight cells), element pressures as polynomials, histories as history.c says, multipliers by evaluation on the old nonmortar facets, scalars as they
   are; whether lines are held, as they are; t and orders as given in to. Both problems and forests must be alive; any ranks may own any leaves. Collective. */
PetscErrorCode TransferState(Problem old_problem, const State *from, Problem new_problem, const ForestMap *, State *to);
/* Cell orders inherited: new leaves take the (highest) order of the old leaves they overlap. [map->num], freed by the caller. */
PetscErrorCode TransferOrders(const ForestMap *, const int8_t old_order[], int8_t **new_order);

/* ---- a state by itself, for another partition or another run (transfer/pack.c) ------------------------------------------ */

/* The solution as named fields whose order does not depend on the partition: `displacement` (Cartesian, all true nodes, prescribed values among them; vertices,
   edges, faces, cells by number, the nodes of an entity in its frame), `pressure`, `unknown_pressure` and `history` (by leaf), `multiplier.<pair>` (by node of
   the nonmortar side), `pattern.<pair>` (transfer/pattern.c: what room the pair has in the matrix), `scalars`, and `path`, like `displacement`: the direction
   of a path that is followed. */
typedef struct {
  char name[2 * MORTISE_NAME];
  Vec  values; /* owned; spread over the ranks in equal parts */
} PackField;
typedef struct {
  PetscInt   num;
  PackField *field; /* owned [num] */
} Pack;

/* Fields of a state at the prescribed motion as applied. Collective. */
PetscErrorCode TransferPack(Problem, const State *, Pack *);
/* The other way, on any partition of the same forest with the same orders and physics: solution, pressures, history and multipliers of a created state; t and
   orders stay. The problem's matrix is made anew. *jump: largest difference between a prescribed displacement as applied and as packed, against the largest
   displacement packed. Fields that are missing or of another size (of other versions) are an input error. Collective. */
PetscErrorCode TransferUnpack(Problem, const Pack *, State *, PetscReal *jump);
PetscErrorCode PackDestroy(Pack *);
