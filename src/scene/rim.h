/* Vertices (plane) or edges and vertices (space) of a contact side's outer facets. */
#ifndef MORTISE_SCENE_RIM_H
#define MORTISE_SCENE_RIM_H
#include "sceneimpl.h"

typedef struct {
  PetscInt  entity, side; /* vertex (plane) or edge (space) of the leaf facet, and side of the coarse mesh that this lies in: 2 dim cell + place */
  PetscInt  facet, place; /* of the leaf facet: number within the group, and place of the vertex or edge in its closure */
  uint64_t  groups;       /* of the leaf facet, one bit each */
  PetscReal N[3], T[3];   /* its unit normal there, and a tangent from there into it */
  PetscReal length;       /* of the leaf facet; in space the shorter one: long ones along an extruded edge wrap round nothing */
  PetscReal across;       /* the same from there on, to the opposite vertex or edge */
} Rim;

/* What meets at the vertices and, in space, edges of the group's outer facets, by entity. Collective; rim is the caller's to free. */
PetscErrorCode SceneRims(Forest, PetscInt group, PetscInt *num, Rim **rim);

#endif
