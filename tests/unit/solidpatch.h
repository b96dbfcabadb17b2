/* Two blocks of hexahedra whose meshes do not match, one on the other, pressed: a contact patch in three dimensions, free to spread along x and y. Blocks
   [0,2]^2 x [0,1] and [0,2]^2 x [1,2]; the cells of the lower one may be skewed, so that their facets are no parallelograms. */
#pragma once
#include "patchblocks.h"

enum { SIDE_X = PATCH_SIDES, SIDE_Y, FREE, SOLID_GROUPS };

/* Change before PatchForest. */
static PetscReal patch_skew = 0.08;

/* Vertex at lattice place g of a body; n[body] x n[body] x 1 cells. */
static inline PetscInt PatchVertex(const PetscInt n[2], PetscInt body, const PetscInt g[3])
{
  const PetscInt m = n[body] + 1;
  return (body ? 2 * (n[0] + 1) * (n[0] + 1) : 0) + g[0] + m * (g[1] + m * g[2]);
}

static inline void PatchCell(const PetscInt n[2], PetscInt body, PetscInt i, PetscInt j, PetscInt cell, CoarseMesh *mesh)
{
  mesh->cell_body[cell] = body;
  for (PetscInt k = 0; k < 8; ++k) {
    const PetscInt  g[3] = {i + (k & 1), j + ((k >> 1) & 1), k >> 2};
    const PetscReal x = 2. * (PetscReal)g[0] / (PetscReal)n[body], y = 2. * (PetscReal)g[1] / (PetscReal)n[body];
    PetscReal      *X                 = mesh->cell_geometry + 24 * cell + 3 * k;
    mesh->cell_vertices[8 * cell + k] = PatchVertex(n, body, g);
    X[0]                              = x + (body ? 0 : patch_skew * x * (2 - x) * (1 - y));
    X[1]                              = y;
    X[2]                              = (PetscReal)(body + g[2]);
  }
}

/* Facets of one cell on the boundary. */
static inline PetscInt PatchFacets(const PetscInt n[2], PetscInt body, PetscInt i, PetscInt j, PetscInt num, PetscInt facets[], uint64_t groups[])
{
  for (PetscInt side = 0; side < 6; ++side) {
    const PetscInt d = side / 2, high = side % 2, at[3] = {i, j, 0}, last[3] = {n[body] - 1, n[body] - 1, 0};
    const PetscInt group[3] = {high ? FREE : SIDE_X, high ? FREE : SIDE_Y, body ? (high ? TOP : UPPER_BOTTOM) : (high ? LOWER_TOP : BOTTOM)};
    if (at[d] != (high ? last[d] : 0)) continue;
    for (PetscInt v = 0; v < 4; ++v) {
      PetscInt g[3] = {i, j, 0};
      g[d] += high;
      g[(d + 1) % 3] += v & 1;
      g[(d + 2) % 3] += v >> 1;
      facets[4 * num + v] = PatchVertex(n, body, g);
    }
    groups[num++] = (uint64_t)1 << group[d];
  }
  return num;
}

static inline Forest PatchForest(PetscInt lower, PetscInt upper)
{
  const PetscInt n[2] = {lower, upper};
  CoarseMesh     mesh = {.dim            = 3,
                         .geometry_order = 1,
                         .num_bodies     = 2,
                         .num_boundaries = SOLID_GROUPS,
                         .num_cells      = lower * lower + upper * upper,
                         .num_vertices   = 2 * ((lower + 1) * (lower + 1) + (upper + 1) * (upper + 1))};
  PetscInt      *facets, num = 0, cell = 0;
  uint64_t      *groups;
  Forest         forest;

  OK(PetscMalloc2(24 * mesh.num_cells, &facets, 6 * mesh.num_cells, &groups));
  OK(PetscMalloc1(8 * mesh.num_cells, &mesh.cell_vertices));
  OK(PetscCalloc1(24 * mesh.num_cells, &mesh.cell_geometry));
  OK(PetscMalloc1(mesh.num_cells, &mesh.cell_body));
  OK(PetscCalloc1(2, &mesh.body_name));
  OK(PetscCalloc1(SOLID_GROUPS, &mesh.boundary_name));
  for (PetscInt body = 0; body < 2; ++body)
    for (PetscInt j = 0; j < n[body]; ++j)
      for (PetscInt i = 0; i < n[body]; ++i, ++cell) {
        PatchCell(n, body, i, j, cell, &mesh);
        num = PatchFacets(n, body, i, j, num, facets, groups);
      }
  OK(ForestCreateFromCoarse(PETSC_COMM_WORLD, &mesh, num, facets, groups, 0, &forest));
  OK(PetscFree2(facets, groups));
  return forest;
}

/* Split a leaf at a corner of the lower block and the last one of the upper block, so that both contact surfaces have nodes that hang; `times` times. */
static inline void PatchRefine(Forest *forest, PetscInt times)
{
  for (PetscInt k = 0; k < times; ++k) {
    const ForestTables *t;
    MarkList            marks;
    t = ForestGetTables(*forest);
    OK(PetscCalloc1(t->num_leaves, &marks.split));
    OK(PetscCalloc1(t->num_leaves, &marks.coarsen));
    marks.split[k ? 4 : 0] = marks.split[t->num_leaves - 1] = 7;
    AdaptBy(forest, &marks);
  }
}

static inline void PatchScene(Patch *p, PetscInt order, Kinematics kinematics, PetscBool standard, const char *press)
{
  static const char *const group[SOLID_GROUPS] = {"bottom", "top", "lower_top", "upper_bottom", "side_x", "side_y", "free"};

  PatchBlocks(p, 3, order, MODEL_3D, kinematics, FORMULATION_DISPLACEMENT, SOLID_GROUPS, group, press);
  p->contact.standard          = standard;
  p->boundaries[SIDE_X].fix[0] = p->boundaries[SIDE_Y].fix[1] = PETSC_TRUE;
}
