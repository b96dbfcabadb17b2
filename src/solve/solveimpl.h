/* Private to solve. */
#pragma once
#include "solve.h"

/* Active sets met so far, to notice a repetition. */
typedef struct {
  PetscInt   num, size;
  uint64_t  *hash; /* owned [size] */
  PetscReal *norm; /* owned [size] what goes with the set: contradiction of a pass, residual of an iterate */
} SetHistory;

typedef struct _p_Saddle    *Saddle;
typedef struct _p_Multigrid *Multigrid;

typedef enum { CONDENSE_AUTO, CONDENSE_YES, CONDENSE_NO } CondenseKind;
typedef enum { LINEAR_AUTO, LINEAR_DIRECT, LINEAR_ITERATIVE } LinearKind;

struct _p_Solver {
  Problem       problem; /* borrowed */
  SNES          snes;
  Vec           lift, rhs, y; /* of the matrix: effect of the motion to come, right-hand side, solution */
  Vec           best;         /* solution of the active-set pass that contradicts itself least */
  PetscReal    *pressure;     /* of the state being solved, borrowed during SolverSolve */
  PetscReal     rtol;
  PetscBool     symmetric; /* LDL^T of the symmetric form */
  PetscInt      max_it, passes, cuts;
  LinearKind    linear;   /* as asked */
  CondenseKind  condense; /* as asked */
  Saddle        saddle;   /* iterative solution, NULL: direct */
  PetscReal     linear_rtol;
  KSP           refine;          /* GMRES on the factor of an earlier tangent; made when first needed */
  PetscBool     reuse, factored; /* may an earlier factor serve; there is one */
  PetscBool     test;            /* -snes_test_jacobian was given */
  SetHistory    pass_sets;       /* active sets of the passes of one linearisation */
  SetHistory    iterate_sets;    /* active sets of the Newton iterates */
  PetscReal     first_norm;      /* residual after the first iteration */
  PetscReal     best_norm;       /* least residual of this solve … */
  PetscInt      best_iter;       /* … and its iteration */
  PetscInt      halvings;        /* steps shortened in this solve */
  SolverReport *report;
};

/* newton.c: the SNES type. */
PetscErrorCode SNESCreate_ContactNewton(SNES);
/* cycle.c: append a set. *repeats: an earlier one was the same with a different one between them, and (compare) had the same norm to round-off. */
PetscErrorCode SetHistoryAdd_Private(SetHistory *, uint64_t hash, PetscReal norm, PetscBool compare, PetscBool *repeats);
PetscErrorCode SetHistoryDestroy_Private(SetHistory *);
/* linear.c: direct solver by default, everything open to options. */
PetscErrorCode SolverLinear_Private(Solver);
PetscErrorCode SolverFactor_Private(Solver, Mat);
PetscErrorCode SolverRefine_Private(Solver, Mat, Vec rhs, PetscReal rtol, Vec x, PetscBool *ok);

/* saddle.c: iterative solution of the symmetric tangent. */
PetscErrorCode SaddleCreate_Private(Problem, Saddle *);
PetscErrorCode SaddleDestroy_Private(Saddle *);
PetscErrorCode SaddleSetUp_Private(Saddle, Mat);
PetscErrorCode SaddleSolve_Private(Saddle, Vec rhs, PetscReal rtol, PetscBool guess, Vec x, PetscBool *ok);
PetscErrorCode SaddleGetIterations_Private(Saddle, PetscInt *iterations);
/* multigrid.c: a cycle for the displacement block. */
PetscErrorCode MultigridCreate_Private(Problem, Multigrid *);
PetscErrorCode MultigridDestroy_Private(Multigrid *);
PetscErrorCode MultigridSetUp_Private(Multigrid, Mat, PetscBool keep);
PetscErrorCode MultigridApply_Private(Multigrid, Vec x, Vec y);
