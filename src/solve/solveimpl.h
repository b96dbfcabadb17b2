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
typedef enum { FACTOR_AUTO, FACTOR_SINGLE, FACTOR_DOUBLE } FactorKind;

struct _p_Solver {
  Problem       problem; /* borrowed */
  SNES          snes;
  Vec           lift, rhs, y, hold; /* of the matrix: effect of the motion to come, right-hand side, solution, forces that hold bodies back */
  Vec           best;               /* solution of the active-set pass that contradicts itself least */
  Vec           balance;            /* residual with the element pressures found; NULL: none are condensed */
  PetscReal    *pressure;           /* of the state being solved, borrowed during SolverSolve */
  PetscReal     rtol;
  PetscBool     symmetric; /* LDL^T of the symmetric form */
  PetscInt      max_it, passes, cuts;
  LinearKind    linear;   /* as asked */
  FactorKind    factor;   /* as asked */
  CondenseKind  condense; /* as asked */
  Saddle        saddle;   /* iterative solution, NULL: direct */
  PetscReal     linear_rtol;
  KSP           refine;          /* GMRES on a factor in single precision or of an earlier tangent; made when first needed */
  PetscReal     refine_first;    /* residual it started from */
  PetscBool     reuse, factored; /* may an earlier factor serve; there is one */
  PetscBool     single;          /* factors are in single precision */
  PetscBool     test;            /* -snes_test_jacobian was given */
  SetHistory    pass_sets;       /* active sets of the passes of one linearisation */
  SetHistory    iterate_sets;    /* active sets of the Newton iterates */
  PetscReal     first_norm;      /* residual after the first iteration */
  PetscReal     best_norm;       /* least residual of this solve … */
  PetscInt      best_iter;       /* … and its iteration */
  PetscReal     last_norm;       /* residual of the last iterate, 0: prescribed motion was left … */
  uint64_t      last_set;        /* … and its active set */
  PetscBool     grew, fell;      /* has the residual grown in this solve while the set stayed, and fallen since? */
  PetscInt      halvings;        /* steps shortened in this solve */
  PetscInt      negative;        /* pivots of the last factor of this solve beyond those of constraints, -1: not known */
  PetscBool     no_memory;       /* for the last factor */
  SolverReport *report;
};

/* options.c: what the command line says of the solver, the rest stays as it is. */
PetscErrorCode SolverOptions_Private(Solver);
/* newton.c: the SNES type. */
PetscErrorCode SNESCreate_ContactNewton(SNES);
/* cycle.c: append a set. *repeats: an earlier one was the same with a different one between them, and (compare) had the same norm to round-off. */
PetscErrorCode SetHistoryAdd_Private(SetHistory *, uint64_t hash, PetscReal norm, PetscBool compare, PetscBool *repeats);
PetscErrorCode SetHistoryDestroy_Private(SetHistory *);
/* linear.c: direct solver by default, everything open to options. */
PetscErrorCode SolverLinear_Private(Solver);
/* From the next factorisation on, the exact tangent by LU. */
PetscErrorCode SolverUnsymmetric_Private(Solver);
PetscErrorCode SolverDirect_Private(Solver, Mat, Vec rhs, Vec x, PetscBool *ok);
PetscErrorCode SolverRefine_Private(Solver, Mat, Vec rhs, PetscReal rtol, Vec x, PetscBool *ok);
/* singlefactor.c: make a PC the factor in single precision of its matrix, LDL^T where that is symmetric; exists where MUMPS has it. */
PetscErrorCode SingleFactorSet_Private(PC, PetscBool symmetric);
PetscBool      SingleFactorExists_Private(void);
PetscErrorCode SingleFactorNegative_Private(PC, PetscInt *negative); /* pivots */

/* inertia.c: on several processes MUMPS counts negative pivots only when told to; once before the first factor. The count, after each: s->negative. */
PetscErrorCode SolverInertiaSetUp_Private(Solver);
PetscErrorCode SolverInertia_Private(Solver, PC);

/* descent.c: minimisation of the augmented Lagrangian Phi. */
typedef struct {
  Solver        solver;
  Problem       problem;
  KSP           ksp;
  Vec           trial, gradient, dx, lambda, depth, next; /* of the problem; depth: overlaps at the iterate (ProblemMeritDepth), next: at a trial */
  Vec           lift, rhs, y, diagonal, work;             /* of the matrix; diagonal: of the shift, 0 at multipliers */
  PetscBool     measured;                                 /* diagonal is known */
  PetscReal     shift;                                    /* of the last direction */
  PetscReal     least;                                    /* that the next one begins with */
  PetscReal     added;                                    /* to the matrix */
  PetscReal     merit;                                    /* at the iterate */
  ProblemStatus status;
  SolverReport *report;
} Descent;

PetscErrorCode DescentCreate_Private(Solver, SolverReport *, Descent *);
PetscErrorCode DescentDestroy_Private(Descent *);
/* Phi, its gradient and its matrix at x. *ok: they are to be had. *done: x is a stationary point. */
PetscErrorCode DescentLinearise_Private(Descent *, Vec x, PetscBool *done, PetscBool *ok);
/* dx = -(H + shift)^-1 gradient with the least of the shifts tried, from `least` on, for which the curvature is positive; its slope. */
PetscErrorCode DescentDirection_Private(Descent *, PetscReal *slope, PetscBool *ok);
/* y = A^-1 rhs with the last factor, dx from it. */
PetscErrorCode DescentApply_Private(Descent *, PetscBool *ok);
/* x += step dx with the longest step 1, 1/2, … that lowers Phi as the slope promises; where the direction is a short one, 2, 4, … as long as Phi falls. */
PetscErrorCode DescentSearch_Private(Descent *, Vec x, PetscReal slope, PetscBool *ok);
/* Phi at x + step dx, in trial; the largest number outside the domain. */
PetscErrorCode DescentTry_Private(Descent *, Vec x, PetscReal step, PetscReal *merit);
/* Down from the state, whose prescribed motion is put in, and to a solution of the exact problem; the report says whether. */
PetscErrorCode DescentFinish_Private(Descent *, State *);

/* saddle.c: iterative solution of the tangent, in its symmetric form or not. */
PetscErrorCode SaddleCreate_Private(Problem, Saddle *);
PetscErrorCode SaddleDestroy_Private(Saddle *);
PetscErrorCode SaddleSetUp_Private(Saddle, Mat, PetscBool symmetric);
PetscErrorCode SaddleSolve_Private(Saddle, Vec rhs, PetscReal rtol, PetscBool guess, Vec x, PetscBool *ok);
/* multigrid.c: a cycle for the displacement block. */
PetscErrorCode MultigridCreate_Private(Problem, Multigrid *);
PetscErrorCode MultigridDestroy_Private(Multigrid *);
PetscErrorCode MultigridSetUp_Private(Multigrid, Mat, PetscBool keep);
PetscErrorCode MultigridApply_Private(Multigrid, Vec x, Vec y);
