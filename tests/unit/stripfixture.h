/* In the plane a strip under the parabola y = 1 + CURVE x^2, NUM cells of width `width` and geometry of order 2; its top is group 0, its end x = 0 group 1. */
#pragma once
#include "forest_box.h"
#include "hp.h"

enum { NUM = 6 };
#define CURVE 0.2
static const PetscReal width = 0.5;

static inline Forest Strip(void)
{
  CoarseMesh mesh = {.dim = 2, .num_cells = NUM, .num_vertices = 2 * (NUM + 1), .geometry_order = 2, .num_bodies = 1, .num_boundaries = 2};
  PetscInt   facets[NUM + 1][2];
  uint64_t   groups[NUM + 1];
  Forest     forest;

  OK(PetscCalloc1(1, &mesh.body_name));
  OK(PetscCalloc1(2, &mesh.boundary_name));
  OK(PetscStrcpy(mesh.body_name[0], "strip"));
  OK(PetscStrcpy(mesh.boundary_name[0], "top"));
  OK(PetscStrcpy(mesh.boundary_name[1], "plane"));
  OK(PetscMalloc1(4 * NUM, &mesh.cell_vertices));
  OK(PetscCalloc1(27 * NUM, &mesh.cell_geometry));
  OK(PetscCalloc1(NUM, &mesh.cell_body));
  for (PetscInt c = 0; c < NUM; ++c) {
    for (PetscInt v = 0; v < 4; ++v) mesh.cell_vertices[4 * c + v] = c + v % 2 + (NUM + 1) * (v / 2);
    for (PetscInt k = 0; k < 9; ++k) {
      PetscReal *X = mesh.cell_geometry + 3 * (9 * c + k);
      X[0]         = width * (c + 0.5 * (k % 3));
      X[1]         = 0.5 * (k / 3) * (1 + CURVE * X[0] * X[0]);
    }
    facets[c][0] = c + NUM + 1;
    facets[c][1] = c + NUM + 2;
    groups[c]    = 1;
  }
  facets[NUM][0] = 0; /* the end x = 0 */
  facets[NUM][1] = NUM + 1;
  groups[NUM]    = 2;
  OK(ForestCreateFromCoarse(PETSC_COMM_SELF, &mesh, NUM + 1, facets[0], groups, 0, &forest));
  return forest;
}
