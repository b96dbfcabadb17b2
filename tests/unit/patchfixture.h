/* Two blocks with meshes that do not match, one on the other, pressed by 5 %: the solution is uniform (a contact patch), so that whatever estimates or
   carries it over must do so exactly. Blocks [0,2] x [0,1] and [0,2] x [1,2]; plane strain or axisymmetric (x = r). */
#pragma once
#include "patchblocks.h"

enum { LEFT = PATCH_SIDES, RIGHT, PLANE_GROUPS };

/* n[0] cells side by side below, n[1] above; refined once. */
static inline Forest PatchForest(const PetscInt n[2])
{
  CoarseMesh mesh = {
      .dim = 2, .geometry_order = 1, .num_bodies = 2, .num_boundaries = PLANE_GROUPS, .num_cells = n[0] + n[1], .num_vertices = 2 * (n[0] + n[1] + 2)};
  PetscInt *facets, num = 0, cell = 0, vertex = 0;
  uint64_t *groups;
  Forest    forest;

  OK(PetscMalloc2(4 * (mesh.num_cells + 2), &facets, 2 * (mesh.num_cells + 2), &groups));
  OK(PetscMalloc1(4 * mesh.num_cells, &mesh.cell_vertices));
  OK(PetscCalloc1(12 * mesh.num_cells, &mesh.cell_geometry));
  OK(PetscMalloc1(mesh.num_cells, &mesh.cell_body));
  OK(PetscCalloc1(2, &mesh.body_name));
  OK(PetscCalloc1(PLANE_GROUPS, &mesh.boundary_name));
  for (PetscInt body = 0; body < 2; ++body) {
    for (PetscInt i = 0; i < n[body]; ++i, ++cell) {
      mesh.cell_body[cell] = body;
      for (PetscInt k = 0; k < 4; ++k) {
        mesh.cell_vertices[4 * cell + k]          = vertex + i + (k & 1) + (n[body] + 1) * (k >> 1);
        mesh.cell_geometry[12 * cell + 3 * k]     = 2. * (PetscReal)(i + (k & 1)) / (PetscReal)n[body];
        mesh.cell_geometry[12 * cell + 3 * k + 1] = (PetscReal)(body + (k >> 1));
      }
      for (PetscInt high = 0; high < 2; ++high, ++num) {
        facets[2 * num]     = vertex + i + (n[body] + 1) * high;
        facets[2 * num + 1] = facets[2 * num] + 1;
        groups[num]         = (uint64_t)1 << (body ? (high ? TOP : UPPER_BOTTOM) : (high ? LOWER_TOP : BOTTOM));
      }
    }
    for (PetscInt right = 0; right < 2; ++right, ++num) {
      facets[2 * num]     = vertex + n[body] * right;
      facets[2 * num + 1] = facets[2 * num] + n[body] + 1;
      groups[num]         = (uint64_t)1 << (right ? RIGHT : LEFT);
    }
    vertex += 2 * (n[body] + 1);
  }
  OK(ForestCreateFromCoarse(PETSC_COMM_WORLD, &mesh, num, facets, groups, 1, &forest));
  OK(PetscFree2(facets, groups));
  return forest;
}

static inline void PatchScene(Patch *p, PetscInt order, Model model, Kinematics kinematics, Formulation formulation)
{
  static const char *const group[PLANE_GROUPS] = {"bottom", "top", "lower_top", "upper_bottom", "left", "right"};

  PatchBlocks(p, 2, order, model, kinematics, formulation, PLANE_GROUPS, group, "-0.1");
  p->boundaries[LEFT].fix[0] = p->boundaries[RIGHT].fix[0] = PETSC_TRUE;
}
