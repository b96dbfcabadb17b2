/* Floor 6. Solution between two live meshes. */
#pragma once
#include "problem.h"

/* Fill *to (a created state of the new problem) from *from on the old one: displacements by nodal interpolation of the old field (exact under refinement
   of straight cells), element pressures as polynomials, histories as history.c says, multipliers by evaluation on the old nonmortar facets, scalars as they
   are; t and orders as given in to. Both problems and forests must be alive; any ranks may own any leaves. Collective. */
PetscErrorCode TransferState(Problem old_problem, const State *from, Problem new_problem, const ForestMap *, State *to);
/* Cell orders inherited: new leaves take the (highest) order of the old leaves they overlap. [map->num], freed by the caller. */
PetscErrorCode TransferOrders(const ForestMap *, const int8_t old_order[], int8_t **new_order);
