/* Floor 6. Residual error estimate per leaf and marking (docs/theory.md, error estimation). */
#pragma once
#include "problem.h"

typedef struct {
  PetscInt   num_leaves;
  PetscReal *eta2;       /* owned [num_leaves] squared indicator of each leaf, replicated, unit: energy */
  PetscReal (*along)[3]; /* owned [num_leaves][3] what of eta2 can be told to come from each axis of the leaf, replicated; NULL: unknown */
  PetscReal total;       /* sqrt of the sum */
  PetscReal norm;        /* energy-like norm of the solution: sqrt(2 * strain energy) */
  PetscReal relative;    /* total / sqrt(norm^2 + total^2) */
  PetscReal part[5];     /* squared shares: interior, jumps, boundary, contact, incompressibility */
} Estimate;

/* Indicators at a converged state whose prescribed motion the problem stands at; evaluates the residual when there is contact. Collective. */
PetscErrorCode EstimateCompute(Problem, const State *, Estimate *);
PetscErrorCode EstimateDestroy(Estimate *);
/* Bulk (Dörfler) marking by spec->fraction; splits in all directions or, spec->anisotropic, in those that matter (src/estimate/split.c); coarsening of leaves
   whose eta2 is below spec->coarsen^2 times the mean; leaves of rigid bodies, eta2 = 0, never. Never more than spec->max_cells leaves expected (before the
   closure's extra splits); leaves whose eta2 agree to 1e-6 are split together or not at all. The list is freed by MarkListDestroy. *num_marked: leaves to
   split. Not collective (input is replicated). */
PetscErrorCode EstimateMark(const Estimate *, const AdaptSpec *, Forest, MarkList *, PetscInt *num_marked);
PetscErrorCode MarkListDestroy(MarkList *);
