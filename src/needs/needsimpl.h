/* Private to needs. */
#pragma once
#include "needs.h"
#include <cjson/cJSON.h>

#define NEEDS_SAME 1e-7 /* of the mesh's size: positions closer are one, as gmsh writes them with fewer digits than it has */

/* Something at a place: a cell or facet by its middle, a corner of a cell, a column of cells. Those with the same image across a plane, or over the same place
   of a section, have one key. */
typedef struct {
  PetscReal X[3], u[3], key;
  PetscReal height; /* of a cell */
  PetscInt  body;   /* -1: a facet */
  uint64_t  groups;
} Place;

/* places.c. key: by the distance from the plane across `axis` at `at`; at NULL: X becomes 0 along the axis. */
void PlaceKey(Place *, PetscInt axis, const PetscReal *at);
void PlacesSort(PetscInt num, Place[]);
/* Sorted places whose keys may be that of place i: [*first, returned). *first: that of the last i, 0 at first. */
PetscInt PlacesLike(PetscInt num, const Place[], PetscInt i, PetscReal size, PetscInt *first);
/* Is q where p is (sign 1), or where its image across the plane is (-1)? */
PetscBool PlaceIs(const Place *p, const Place *q, PetscInt axis, PetscReal at, int sign, PetscReal size);
/* Corners of the cells of all ranks with their displacements, sorted, the caller's; largest component of those. Collective. */
PetscErrorCode NeedsCorners(const NeedsRun *, PetscInt axis, const PetscReal *at, PetscInt *num, Place **, PetscReal *largest);
/* The box's longest side; lo, hi of the box. */
PetscReal NeedsSize(const CoarseMesh *, PetscReal lo[3], PetscReal hi[3]);
/* Middle of entity e of a leaf, by its place in the leaf's closure. Not collective. */
PetscErrorCode NeedsMiddle(Forest, const ForestTables *, PetscInt leaf, PetscInt e, PetscReal X[3]);

/* simpler.c, at the last accepted state. Of a pair the square of how far its sides slid along each other over the size of the zone, or the turn of their
   normals (radians, root mean square) if that is larger. Collective. */
PetscErrorCode NeedsContactTurn(const NeedsRun *, PetscInt pair, PetscReal *turn);
/* The motion that the supports of a body give it as a whole, by axis, for the caller to delete; held: they do, and nothing else loads it. Not collective. */
PetscErrorCode NeedsRigidMotion(const NeedsRun *, PetscInt body, cJSON **motion, PetscBool *held);
/* Strain along the way between two places that hold a body in the same direction, middles of supports and of contact zones, if one of them moved by 1 in it;
   the largest, 0: there are no two. Collective. */
PetscErrorCode NeedsStretch(const NeedsRun *, PetscInt body, PetscReal *strain);
/* Largest difference of displacements at corners of cells from those of their mirror images, over the largest displacement. Collective. */
PetscErrorCode NeedsAsymmetry(const NeedsRun *, PetscInt axis, PetscReal *off);
/* prism.c: is the mesh one of right prisms along the axis that reach from end to end? around: of such ones bent about it. layers: of its cells, 0: it is not.
   change: largest displacement along the axis (around it), or difference of those of corners over each other, over the largest displacement; over the length
   and the strain elsewhere if that is more. Collective. */
PetscErrorCode NeedsFindPrism(const NeedsRun *, PetscInt axis, PetscBool around, PetscReal strain, PetscInt *layers, PetscReal *change);
/* orders.c: energy mu |strain|^2 of what the displacements of a body lose with orders above `lower` along the axes of its cells that run mostly in this
   direction; -1: along all. Collective. */
PetscErrorCode NeedsLostByOrder(const NeedsRun *, PetscInt body, PetscInt direction, PetscInt lower, PetscReal *energy);
