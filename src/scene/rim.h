/* Vertices (plane) or edges and vertices (space) of a contact side's outer facets. */
#ifndef MORTISE_SCENE_RIM_H
#define MORTISE_SCENE_RIM_H
#include "sceneimpl.h"

typedef struct {
  PetscInt  entity, side; /* vertex (plane) or edge (space) of the leaf facet, and side of the coarse mesh that this lies in: 2 dim cell + place */
  PetscInt  facet, place; /* of the leaf facet: number within the group, and place of the vertex or edge in its closure */
  PetscBool is_vertex;    /* in space */
  uint64_t  groups;       /* of the leaf facet, one bit each */
  PetscReal N[3], T[3];   /* its unit normal there, and a tangent from there into it */
  PetscReal length;       /* of the leaf facet; in space the shorter one: long ones along an extruded edge wrap round nothing */
  PetscReal across;       /* the same from there on, to the opposite vertex or edge */
} Rim;

/* What meets at the vertices and, in space, edges of the group's outer facets, by entity. Not collective; rim is the caller's to free. */
PetscErrorCode SceneRims(Forest, PetscInt group, PetscInt *num, Rim **rim);

/* Shape of a contact side, as far as roles depend on it (corner.c). */
typedef struct {
  PetscInt  num, *other; /* rims, and the opposite one of the same facet */
  Rim      *rim;
  PetscReal longest; /* of its facets; in space of the shorter lengths of each */
  PetscReal hollow;  /* the most that a facet turns concavely */
  PetscReal corner;  /* plane: of convex corners of more than 40 degrees the least length of the longer of both facets; infinity: it has none */
  PetscReal held;    /* share of its facets that supports hold along their normals */
} SideShape;
/* Not collective. */
PetscErrorCode SideShapeCreate(Forest, PetscInt group, PetscInt num_boundaries, const BoundarySpec[], SideShape *);
PetscErrorCode SideShapeDestroy(SideShape *);
/* The least way on the surface within which it turns convexly by the angle, beside sharp corners; infinity: it does nowhere. */
PetscReal SideShapeRounded(const SideShape *, PetscReal angle);

#endif
