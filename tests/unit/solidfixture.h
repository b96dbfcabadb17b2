/* Surfaces of quadrilaterals for the three-dimensional contact tests: grids over [0, 1]^2, nonmortar facing up, mortar facing down. */
#pragma once
#include "contactsum.h"

typedef struct {
  ContactSurface s;
  PetscInt      *facets;
  PetscReal     *x;
} Sheet;

/* n x m facets over [lo, hi] in x and y at height z; up: normal +z. */
static inline void SheetCreate(Sheet *c, PetscInt n, PetscInt m, PetscReal lo, PetscReal hi, PetscReal z, PetscBool up)
{
  c->facets = calloc((size_t)(4 * n * m), sizeof(PetscInt));
  c->x      = calloc((size_t)(3 * (n + 1) * (m + 1)), sizeof(PetscReal));
  for (PetscInt j = 0; j <= m; j++)
    for (PetscInt i = 0; i <= n; i++) {
      PetscReal *x = c->x + 3 * (j * (n + 1) + i);

      x[0] = lo + (hi - lo) * (PetscReal)i / (PetscReal)n;
      x[1] = lo + (hi - lo) * (PetscReal)j / (PetscReal)m;
      x[2] = z;
    }
  for (PetscInt j = 0; j < m; j++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscInt a = j * (n + 1) + i, around[4] = {a, a + 1, a + n + 2, a + n + 1};

      for (PetscInt k = 0; k < 4; k++) c->facets[4 * (j * n + i) + k] = around[up ? k : 3 - k];
    }
  c->s = (ContactSurface){.dim = 3, .num_nodes = (n + 1) * (m + 1), .num_facets = n * m, .facets = c->facets, .x = c->x, .X = c->x};
}

static inline void SheetDestroy(Sheet *c)
{
  free(c->facets);
  free(c->x);
}

/* x <- rotation about an axis by an angle, then shift, all nodes. */
static inline void SheetMove(Sheet *c, const PetscReal axis[3], PetscReal angle, const PetscReal shift[3])
{
  const PetscReal l = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]), k[3] = {axis[0] / l, axis[1] / l, axis[2] / l};

  for (PetscInt n = 0; n < c->s.num_nodes; n++) {
    PetscReal      *x     = c->x + 3 * n, y[3];
    const PetscReal along = k[0] * x[0] + k[1] * x[1] + k[2] * x[2];

    for (int i = 0; i < 3; i++)
      y[i] = cos(angle) * x[i] + sin(angle) * (k[(i + 1) % 3] * x[(i + 2) % 3] - k[(i + 2) % 3] * x[(i + 1) % 3]) + (1 - cos(angle)) * along * k[i] + shift[i];
    for (int i = 0; i < 3; i++) x[i] = y[i];
  }
}

static inline void SumCreate(Sum *s, PetscInt nn, PetscInt nm)
{
  SumCreateFor(s, 3, nn, nm);
}

#define SumEvaluate(sum, pair, nonmortar, mortar, z, hessian) SumSurfaces(sum, pair, &(nonmortar)->s, &(mortar)->s, z, PETSC_TRUE, hessian)
