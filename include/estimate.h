/* Floor 6. Residual error estimate per leaf and marking (docs/theory.md, error estimation). */
#pragma once
#include "problem.h"

enum {
  ESTIMATE_IRREGULAR_FACE   = 1, /* the cell has a contact face of order 1, whose error stays */
  ESTIMATE_IRREGULAR_RIM    = 2, /* it touches the edge of a contact zone, where the pressure starts like a root */
  ESTIMATE_IRREGULAR_CORNER = 4, /* it touches a place where the kind of condition on the boundary changes */
};

/* The deepest overlap, at a point, of the sides of a pair that bears nothing. */
typedef struct {
  double    share; /* over the size of the facet over its order; 0: there is none */
  PetscReal depth;
  PetscInt  pair; /* ContactSpec.pair */
} EstimateOverlap;

typedef struct {
  PetscInt   num_leaves;
  PetscReal *eta2;        /* owned [num_leaves] squared indicator of each leaf, as if nothing had flowed: they rank the leaves; replicated, unit: energy */
  PetscReal (*along)[3];  /* owned [num_leaves][3] what of eta2 can be told to come from each axis of the leaf, replicated; NULL: unknown */
  PetscReal *decay;       /* owned [num_leaves] rate at which the Legendre coefficients of the displacement fall from degree to degree (src/estimate/decay.c),
                             replicated; NULL: not wanted (strategy h) */
  int8_t         *order;  /* owned [num_leaves] of the cells, replicated; NULL with decay */
  int8_t         *lowest; /* owned [num_leaves] no order below: that of the scene; NULL with decay */
  int8_t         *irregular; /* owned [num_leaves] bits ESTIMATE_IRREGULAR_…, where a higher order gains little; NULL with decay */
  PetscReal       total;     /* sqrt of the sum of part: that of eta2 unless material flowed (src/estimate/flow.c) */
  PetscReal       norm;      /* energy-like norm of the solution: sqrt(2 * strain energy) */
  PetscReal       relative;  /* total / sqrt(norm^2 + total^2) */
  PetscReal       part[5];   /* squared shares: interior, jumps, boundary, contact, incompressibility, with what flow has left of the stiffness */
  EstimateOverlap overlap;   /* contact that no node has seen; none where contact is the lesser part of the estimate, which is round-off then */
} Estimate;

/* Indicators at a converged state whose prescribed motion the problem stands at; evaluates the residual when there is contact. Collective. */
PetscErrorCode EstimateCompute(Problem, const State *, Estimate *);
PetscErrorCode EstimateDestroy(Estimate *);
/* Over several states of one mesh: *most, all zero before the first, takes in the estimate of one more. Of each leaf the largest eta2 / (norm^2 + total^2),
   with what that state's estimate tells of the leaf besides; most->relative is the largest of all; total, norm and part stay 0. Not collective. */
PetscErrorCode EstimateLargest(const Estimate *, Estimate *most);
/* It as numbers, values[*num], freed by the caller, and back. Not collective. */
PetscErrorCode EstimateStore(const Estimate *most, PetscInt *num, PetscReal **values);
PetscErrorCode EstimateLoad(PetscInt num_leaves, PetscInt num, const PetscReal values[], Estimate *most);
/* What to do next. Bulk (Dörfler) marking by spec->fraction; splits in all directions or, spec->anisotropic, in those that matter (src/estimate/split.c), or
   higher orders (src/estimate/choose.c), written to order[num_leaves], the orders the leaves are to have (NULL with strategy h); coarsening or lower orders of
   leaves whose eta2 is below spec->coarsen^2 times the mean; leaves of rigid bodies, whose estimate comes from no axis, never. Never more than spec->max_cells
   leaves expected (before the closure's extra splits); leaves whose eta2 agree to 1e-6 are changed together or not at all. No leaf where those that nothing
   more can be done to hold more than spec->tolerance by themselves (strategies h and hp). The list is freed by MarkListDestroy. *num_marked: leaves to split or
   to raise. Not collective (input is replicated). */
PetscErrorCode EstimateMark(const Estimate *, const AdaptSpec *, Forest, MarkList *, int8_t order[], PetscInt *num_marked);
PetscErrorCode MarkListDestroy(MarkList *);
/* contact.<pair>.subdivide: auto. Marks (isotropic) of all leaves that touch either side of a pair whose layer, the leaves of order above 1 with a facet on
   either side, has a larger squared estimate than all leaves that touch no contact face. subdivided[num_contacts]: how often each pair's layer has been, at
   most its highest order + 1 times; counted up for the pairs marked. order[num_leaves]: of the leaves. *num_marked: leaves to split; *room: no pair was left
   out for fear of more than spec->max_cells leaves. The list is freed by MarkListDestroy. Not collective (input is replicated). */
PetscErrorCode EstimateMarkLayers(const Estimate *, const SceneData *, Forest, const int8_t order[], PetscInt subdivided[], MarkList *, PetscInt *num_marked,
                                  PetscBool *room);
