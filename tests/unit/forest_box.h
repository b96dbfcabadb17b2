/* A box of cells in memory for the forest tests: every cell has its own random axes (a proper rotation), vertex ids are shuffled, the
   geometry is a smooth curved map of order q > 1 that keeps the boundary of the box (q = 1: straight, unless box_distorted). Bit s of a facet's groups: side s
   = 2*axis + (high). */
#pragma once
#include "forestimpl.h"

#ifdef FOREST_BENCH /* benchmarks are not linked with cmocka */
#define OK(call) PetscCallAbort(PETSC_COMM_WORLD, call)
#else
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
/* cmocka needs the three above first */
#include <cmocka.h>
#define OK(call) assert_int_equal((call), 0)
#endif

typedef struct {
  PetscInt dim, n[3];                  /* cells per direction of the box [0, n0] x [0, n1] (x [0, n2]) */
  PetscInt axis[512][3], flip[512][3]; /* local axis s of a cell is box axis axis[s], reversed or not */
} Box;

static uint64_t box_random_state = 88172645463325252ULL;

/* Change before BoxForest: move inner vertices also when q = 1; bend the sides of the last axis; length of a coarse cell. */
static PetscBool box_distorted = PETSC_FALSE;
static PetscReal box_bend      = 0;
static PetscReal box_width     = 1;
static PetscInt  box_rotation  = -1; /* not negative: cell c has proper rotation number box_rotation + 5 c, instead of a random one */

static inline PetscInt BoxRandom(PetscInt n)
{
  box_random_state ^= box_random_state << 13;
  box_random_state ^= box_random_state >> 7;
  box_random_state ^= box_random_state << 17;
  return (PetscInt)((box_random_state >> 11) % (uint64_t)n);
}

/* Proper rotation: a permutation and reversals of positive determinant. */
static inline void BoxRotation(PetscInt dim, PetscInt axis[3], PetscInt flip[3])
{
  PetscInt sign = 1;

  for (PetscInt i = 0; i < 3; ++i) axis[i] = i, flip[i] = 0;
  for (PetscInt i = dim - 1; i > 0; --i) {
    const PetscInt j = BoxRandom(i + 1), t = axis[i];
    if (j == i) continue;
    axis[i] = axis[j];
    axis[j] = t;
    sign    = -sign;
  }
  for (PetscInt i = 0; i < dim; ++i) {
    flip[i] = BoxRandom(2);
    if (flip[i]) sign = -sign;
  }
  if (sign < 0) flip[0] = 1 - flip[0];
}

/* Proper rotation number k of all 24 (2-D: 4), counted round. */
static inline void BoxRotationNumber(PetscInt dim, PetscInt k, PetscInt axis[3], PetscInt flip[3])
{
  static const PetscInt order[6][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {2, 1, 0}, {2, 0, 1}, {0, 2, 1}}; /* even and odd ones in turn */
  const PetscInt        orders = dim == 2 ? 2 : 6, flips = 1 << (dim - 1), which = k / flips % orders;

  for (PetscInt i = 0, sign = which % 2; i < 3; ++i) { /* the last axis makes the determinant positive */
    axis[i] = order[which][i];
    flip[i] = i < dim - 1 ? k >> i & 1 : i == dim - 1 ? sign : 0;
    sign ^= flip[i];
  }
}

/* Box coordinates of a local lattice point t (0..q) of a cell, in units of 1/q. */
static inline void BoxLattice(const Box *box, PetscInt cell, PetscInt q, const PetscInt t[3], PetscInt g[3])
{
  const PetscInt at[3] = {cell % box->n[0], cell / box->n[0] % box->n[1], cell / (box->n[0] * box->n[1])};

  g[0] = g[1] = g[2] = 0;
  for (PetscInt s = 0; s < box->dim; ++s) {
    const PetscInt a = box->axis[cell][s];
    g[a]             = at[a] * q + (box->flip[cell][s] ? q - t[s] : t[s]);
  }
}

static inline void BoxCurve(const Box *box, PetscInt q, const PetscInt g[3], PetscReal X[3])
{
  PetscReal bump = 0.15;

  for (PetscInt a = 0; a < box->dim; ++a) bump *= PetscSinReal(PETSC_PI * g[a] / (q * box->n[a]));
  for (PetscInt a = 0; a < 3; ++a) X[a] = a < box->dim ? box_width * ((PetscReal)g[a] / q + (q > 1 || box_distorted ? bump * (1 - 0.5 * a) : 0)) : 0;
  for (PetscInt a = 0; a < box->dim - 1; ++a) X[box->dim - 1] += box_bend * PetscSqr(X[a]) / (1 + a);
}

static inline void BoxShuffle(PetscInt n, PetscInt id[])
{
  for (PetscInt i = 0; i < n; ++i) id[i] = i;
  for (PetscInt i = n - 1; i > 0; --i) {
    const PetscInt j = BoxRandom(i + 1), t = id[i];
    id[i] = id[j];
    id[j] = t;
  }
}

static inline PetscInt BoxVertex(const Box *box, const PetscInt id[], const PetscInt g[3])
{
  return id[g[0] + (box->n[0] + 1) * (g[1] + (box->n[1] + 1) * g[2])];
}

static inline void BoxCells(const Box *box, const PetscInt id[], CoarseMesh *mesh)
{
  const PetscInt q = mesh->geometry_order, nz = box->dim == 3 ? q + 1 : 1;

  for (PetscInt c = 0, v = 0, x = 0; c < mesh->num_cells; ++c) {
    PetscInt g[3];
    for (PetscInt i = 0; i < 1 << box->dim; ++i) {
      BoxLattice(box, c, 1, (const PetscInt[3]){i & 1, (i >> 1) & 1, i >> 2}, g);
      mesh->cell_vertices[v++] = BoxVertex(box, id, g);
    }
    for (PetscInt k = 0; k < nz; ++k)
      for (PetscInt j = 0; j <= q; ++j)
        for (PetscInt i = 0; i <= q; ++i, x += 3) {
          BoxLattice(box, c, q, (const PetscInt[3]){i, j, k}, g);
          BoxCurve(box, q, g, &mesh->cell_geometry[x]);
        }
    mesh->cell_body[c] = 0;
  }
}

/* All facets on the six (four) sides, with their group bits. */
static inline PetscInt BoxFacets(const Box *box, const PetscInt id[], PetscInt vertices[], uint64_t groups[])
{
  PetscInt num = 0, corners = 1 << (box->dim - 1);

  for (PetscInt side = 0; side < 2 * box->dim; ++side) {
    const PetscInt a = side / 2, b = (a + 1) % box->dim, c = box->dim == 3 ? (a + 2) % 3 : 2;
    for (PetscInt j = 0; j < (box->dim == 3 ? box->n[c] : 1); ++j)
      for (PetscInt i = 0; i < box->n[b]; ++i) {
        for (PetscInt v = 0; v < corners; ++v) {
          PetscInt g[3] = {0, 0, 0};
          g[a]          = side % 2 ? box->n[a] : 0;
          g[b]          = i + (v & 1);
          if (box->dim == 3) g[c] = j + (v >> 1);
          vertices[num * corners + v] = BoxVertex(box, id, g);
        }
        groups[num++] = (uint64_t)1 << side;
      }
  }
  return num;
}

static inline Forest BoxForest(MPI_Comm comm, PetscInt dim, const PetscInt n[3], PetscInt q, PetscInt refine, uint64_t seed, Box *box)
{
  CoarseMesh mesh = {.dim = dim, .geometry_order = q, .num_bodies = 1, .num_boundaries = 2 * dim, .num_cells = 1, .num_vertices = 1};
  PetscInt  *id, *facet_vertices, num_facets;
  uint64_t  *facet_groups;
  Forest     forest;

  box_random_state = 88172645463325252ULL + seed * 2654435761ULL;
  box->dim         = dim;
  for (PetscInt i = 0; i < 3; ++i) {
    box->n[i] = i < dim ? n[i] : 1;
    mesh.num_cells *= box->n[i];
    mesh.num_vertices *= i < dim ? n[i] + 1 : 1;
  }
  OK(mesh.num_cells <= 512 ? 0 : PETSC_ERR_ARG_SIZ);
  for (PetscInt c = 0; c < mesh.num_cells; ++c) {
    if (box_rotation < 0)
      BoxRotation(dim, box->axis[c], box->flip[c]);
    else
      BoxRotationNumber(dim, box_rotation + 5 * c, box->axis[c], box->flip[c]);
  }
  OK(PetscMalloc1(mesh.num_vertices, &id));
  BoxShuffle(mesh.num_vertices, id);
  OK(PetscMalloc1(mesh.num_cells << dim, &mesh.cell_vertices));
  OK(PetscMalloc1(3 * mesh.num_cells * (q + 1) * (q + 1) * (dim == 3 ? q + 1 : 1), &mesh.cell_geometry));
  OK(PetscMalloc1(mesh.num_cells, &mesh.cell_body));
  OK(PetscCalloc1(1, &mesh.body_name));
  OK(PetscCalloc1(2 * dim, &mesh.boundary_name));
  OK(PetscStrcpy(mesh.body_name[0], "box"));
  for (PetscInt s = 0; s < 2 * dim; ++s) OK(PetscSNPrintf(mesh.boundary_name[s], MORTISE_NAME, "side %d", (int)s));
  BoxCells(box, id, &mesh);
  OK(PetscMalloc1(24 * mesh.num_cells, &facet_vertices));
  OK(PetscMalloc1(6 * mesh.num_cells, &facet_groups));
  num_facets = BoxFacets(box, id, facet_vertices, facet_groups);
  OK(ForestCreateFromCoarse(comm, &mesh, num_facets, facet_vertices, facet_groups, refine, &forest));
  OK(PetscFree(id));
  OK(PetscFree(facet_vertices));
  OK(PetscFree(facet_groups));
  return forest;
}

/* Place of a leaf in the box in units of 2^-FOREST_MAX_LEVEL of a coarse cell; level: by box axis. */
static inline void BoxLeaf(const Box *box, const ForestTables *t, PetscInt leaf, int64_t lo[3], int64_t hi[3])
{
  const PetscInt cell  = t->leaf_root[leaf];
  const PetscInt at[3] = {cell % box->n[0], cell / box->n[0] % box->n[1], cell / (box->n[0] * box->n[1])};

  for (PetscInt s = 0; s < 3; ++s) lo[s] = 0, hi[s] = 1;
  for (PetscInt s = 0; s < box->dim; ++s) {
    const PetscInt a = box->axis[cell][s], extent = FOREST_ONE >> t->leaf_level[3 * leaf + s], low = t->leaf_lo[3 * leaf + s];
    lo[a] = (int64_t)at[a] * FOREST_ONE + (box->flip[cell][s] ? FOREST_ONE - low - extent : low);
    hi[a] = lo[a] + extent;
  }
}

/* Random marks: about one leaf in `one_in` is split, in all directions or in a random set of them. */
static inline void BoxRandomMarks(PetscInt dim, PetscInt num_leaves, PetscInt one_in, PetscBool anisotropic, MarkList *marks)
{
  const PetscInt all = (1 << dim) - 1;

  OK(PetscCalloc1(num_leaves, &marks->split));
  OK(PetscCalloc1(num_leaves, &marks->coarsen));
  for (PetscInt l = 0; l < num_leaves; ++l) {
    if (BoxRandom(one_in)) continue;
    marks->split[l] = (int8_t)(anisotropic ? 1 + BoxRandom(all) : all);
  }
}

static inline void MarksDestroy(MarkList *marks)
{
  OK(PetscFree(marks->split));
  OK(PetscFree(marks->coarsen));
}

/* Adapt in place; the marks are destroyed. */
static inline void AdaptBy(Forest *forest, MarkList *marks)
{
  Forest    next;
  ForestMap map;

  OK(ForestAdapt(*forest, marks, NULL, 0, NULL, &next, &map));
  MarksDestroy(marks);
  OK(ForestMapDestroy(&map));
  OK(ForestDestroy(forest));
  *forest = next;
}

/* A box of 2 cells in each direction with geometry of order q, random leaves of which are split a few times, about one in `one_in`. */
static inline Forest BoxRandomForest(PetscInt dim, PetscInt q, PetscInt rounds, PetscInt one_in, PetscBool anisotropic, uint64_t seed)
{
  const PetscInt n[3] = {2, 2, 2};
  Box            box;
  Forest         forest = BoxForest(PETSC_COMM_WORLD, dim, n, q, 0, seed, &box);

  for (PetscInt round = 0; round < rounds; ++round) {
    MarkList marks;
    BoxRandomMarks(dim, forest->tables.num_leaves, one_in, anisotropic, &marks);
    AdaptBy(&forest, &marks);
  }
  return forest;
}

/* Position of the point eta of an entity's frame, through the closure of its lowest leaf. */
static inline void EntityPoint(Forest forest, PetscInt entity, const PetscReal eta[], PetscReal X[3])
{
  const ForestTables *t    = &forest->tables;
  const PetscInt      leaf = t->entity_leaf[entity], entry = t->closure_offset[t->first[t->dim] + leaf];
  PetscReal           xi[3];
  PetscInt            i = 0;

  while (t->closure[entry + i] != entity) ++i;
  const PetscInt d    = ForestTensorDim[i];
  const int8_t   code = t->orientation[entry + i];
  for (PetscInt a = 0, j = 0; a < t->dim; ++a) {
    const PetscInt s = (i / ForestPow3[a]) % 3;
    xi[a]            = 0.5 * s;
    if (s != 1) continue;
    if (d == t->dim) {
      xi[a] = eta[a];
      continue;
    }
    const PetscInt f = d == 2 && (code & 4) ? 1 - j : j;
    xi[a]            = ((code >> f) & 1) ? 1 - eta[f] : eta[f];
    ++j;
  }
  OK(ForestMapPoint(forest, leaf, xi, X));
}

static inline PetscReal Distance(const PetscReal a[3], const PetscReal b[3])
{
  return PetscSqrtReal(PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]) + PetscSqr(a[2] - b[2]));
}
