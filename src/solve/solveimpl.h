/* Private to solve. */
#pragma once
#include "solve.h"

#define SOLVER_LARGE 20000       /* unknowns in space from which a factor in double is not the cheapest: one in single, or of order 1 a hierarchy */
#define SOLVER_MOST_RESERVE 1000 /* percent of workspace above MUMPS's estimate at which we give up */

typedef enum { MODIFIER_AUTO, MODIFIER_ON, MODIFIER_OFF } ModifierMode;

typedef struct _p_Saddle    *Saddle;
typedef struct _p_Multigrid *Multigrid;

typedef enum { CONDENSE_AUTO, CONDENSE_YES, CONDENSE_NO } CondenseKind;
typedef enum { LINEAR_AUTO, LINEAR_DIRECT, LINEAR_ITERATIVE } LinearKind;
/* AUTO: smoothed aggregation, or a factorisation where the space of order 1 below higher ones is small. */
typedef enum { MULTIGRID_AUTO, MULTIGRID_GAMG, MULTIGRID_BOOMERAMG } MultigridKind;
typedef enum { FACTOR_AUTO, FACTOR_SINGLE, FACTOR_DOUBLE } FactorKind;

/* One iterate of Newton's method. */
typedef struct {
  PetscInt            number;
  Vec                 x, r;    /* borrowed; r: its residual */
  PetscReal           norm;    /* of r */
  uint64_t            set;     /* hash of its active set */
  const char         *trouble; /* why the solve is to be given up, NULL: it is not */
  SNESConvergedReason reason;  /* with trouble */
} Iterate;

/* What one solve remembers of its iterations. */
typedef struct {
  PetscReal first_norm; /* residual after the first iteration */
  PetscReal best_norm;  /* least residual … */
  PetscInt  best_iter;  /* … and its iteration */
  PetscReal last_norm;  /* residual of the last iterate, 0: prescribed motion was left … */
  uint64_t  last_set;   /* … and its active set */
  PetscBool shortened;  /* was the last step too far (line search)? */
  PetscBool grew, fell; /* has the residual grown while the set stayed, and fallen since? */
  PetscReal flow_start; /* residual that the share of the secant stiffness of flow counts from, 0: none is taken */
  PetscInt  halvings;   /* steps shortened */
} Course;

struct _p_Solver {
  Problem       problem; /* borrowed */
  SNES          snes;
  KSP           ksp;          /* borrowed: of the SNES */
  Vec           lift, rhs, y; /* of the matrix: effect of the motion to come, right-hand side, solution */
  Vec           balance;      /* residual with the element pressures found; NULL: none are condensed */
  PetscReal    *pressure;     /* of the state being solved, borrowed during SolverSolve */
  PetscReal    *end;          /* owned: the same at the end of a linear step (line search) */
  PetscInt      num_pressure;
  State        *state; /* borrowed, while it is solved for */
  PetscReal     rtol;
  PetscBool     symmetric; /* LDL^T of the symmetric form */
  PetscInt      passes, cuts;
  PetscBool     single_switches;   /* nodes may switch one at a time */
  PetscInt      max_it, max_funcs; /* as SNES has them, and */
  PetscReal     snes_rtol, snes_atol, snes_stol;
  Form          form;                        /* of the residual at hand; transient parts of the last tangent */
  ModifierMode  mode[SOLVER_MOST_MODIFIERS]; /* switches, as asked */
  PetscBool     no_solution;                 /* the last linear system has none that was found */
  LinearKind    linear;                      /* as asked */
  MultigridKind multigrid;                   /* as asked */
  FactorKind    factor;                      /* as asked */
  CondenseKind  condense;                    /* as asked */
  Saddle        saddle;                      /* iterative solution, NULL: direct */
  PetscInt      order;                       /* highest of a cell */
  PetscBool     choose;                      /* the first matrix says which of the two */
  PetscReal     linear_rtol;
  KSP           refine;          /* GMRES on a factor in single precision or of an earlier tangent; made when first needed */
  PetscReal     refine_first;    /* residual it started from */
  PetscBool     reuse, factored; /* may an earlier factor serve; there is one */
  PetscBool     single;          /* factors are in single precision */
  PetscBool     test;            /* -snes_test_jacobian was given */
  uint64_t     *pass_sets;       /* owned [pass_room] hashes of the active sets of the passes of one linearisation */
  PetscInt      pass_room;
  uint64_t      settled;      /* pairs whose active set agreed with the last linear step of this solve, 0: none did */
  uint64_t      settled_set;  /* its hash */
  PetscBool     no_set;       /* no set was found that agrees with the last linear step, whose problem is not convex */
  PetscBool     swap;         /* SolverSwapPredictor */
  PetscBool     never_freeze; /* SolverUnfreeze */
  PetscReal     step;         /* share of the last linear step that was gone */
  Course        course;       /* of this solve */
  PetscInt      negative;     /* pivots of the last factor of this solve beyond those of constraints, -1: not known */
  PetscBool     no_memory;    /* for the last factor */
  SolverReport *report;
};

/* options.c: what the command line says of the solver, the rest stays as it is. */
PetscErrorCode SolverOptions_Private(Solver);
/* types.c: an input error for types and numbers among PETSc's options that no solver could be set up with. Collective. */
PetscErrorCode SolverCheckTypes_Private(void);
/* newton.c: the SNES type. */
PetscErrorCode SNESCreate_ContactNewton(SNES);
/* Norm and active set of an iterate whose residual is there. Collective. */
PetscErrorCode SolverLook_Private(Solver, Iterate *);
/* activeset.c: solve tangent . dx = rhs with the active set iterated until it stays, or none may agree. again: the matrix has been factorised with other rows
   of this linearisation; settled: the last pass changed no state; s->no_solution: there is none. Collective. */
PetscErrorCode SolverActiveSetSolve_Private(Solver, PetscBool again, Vec dx, PetscBool *settled);
/* The same in two stages, of which the first is without friction. */
PetscErrorCode SolverPressuresFirst_Private(Solver, Vec dx, PetscBool *settled);
/* judge.c: is the residual small, do incompressible cells keep their volume, and is nothing prescribed left? reason > 0: yes. Collective. */
PetscErrorCode SolverConverged_Private(Solver, const Iterate *, SNESConvergedReason *reason);
/* A residual that counts as none, unit: force. */
PetscReal SolverTolerance_Private(const Solver, const ProblemStatus *);
/* What to say of an iteration that ends without a solution. */
const char *SolverWords_Private(const Solver, PetscReal norm, const char *usual);
/* solver.c: PETSc's finite-difference test of the tangent at x (-snes_test_jacobian), on a matrix whose pattern already fits x. Collective. */
PetscErrorCode SolverTest_Private(Solver, Vec x);

/* A modifier of Newton's iteration; NULL: it has nothing to say there. *acts: it changed something, which is counted. All collective. */
typedef struct {
  const char *name, *help;
  /* Chooses s->form for the tangent at an iterate; what is not chosen is plain. last: the one before. always: the switch is on. */
  PetscErrorCode (*linearise)(Solver, const Iterate *, const Form *last, PetscBool always, PetscBool *acts);
  /* Looks at the linear step dx and changes it, or changes s->form and asks for it again. */
  PetscErrorCode (*correct)(Solver, const Iterate *, Vec dx, PetscBool *acts, PetscBool *again);
  /* Looks at a step that has been moved along; acts: it has changed the multipliers of dx, which are put in anew. */
  PetscErrorCode (*moved)(Solver, Vec dx, PetscBool *acts);
  /* Looks at the residual after a step, it->r, and takes back part of the step; it->norm: at its start. Not where motion was prescribed
     on the way, whose work is not known. */
  PetscErrorCode (*shorten)(Solver, const Iterate *, Vec dx, PetscReal *step, PetscBool *acts);
  /* Looks at an iterate before it is judged: may change s->form and what of the iterate depends on it, or set it->trouble and it->reason. */
  PetscErrorCode (*verdict)(Solver, Iterate *, PetscBool always, PetscBool *acts);
} Modifier;

extern const Modifier ModifierFrozenSegmentation, ModifierStall, ModifierFrozenNormals, ModifierWarmStart, ModifierFirstTouch, ModifierProximalShift,
    ModifierYieldEdge, ModifierSecantFlow, ModifierSlidePredictor, ModifierLineSearch, ModifierCarriedForce;
/* modifier.c: all that are not off, in the order of the table. */
const Modifier *SolverModifier_Private(PetscInt);
PetscErrorCode  ModifiersLinearise_Private(Solver, const Iterate *);
PetscErrorCode  ModifiersCorrect_Private(Solver, const Iterate *, Vec dx, PetscBool *again);
PetscErrorCode  ModifiersMoved_Private(Solver, const Iterate *, Vec dx, PetscReal step);
PetscErrorCode  ModifiersShorten_Private(Solver, const Iterate *, Vec dx, PetscReal *step);
PetscErrorCode  ModifiersVerdict_Private(Solver, Iterate *);
/* linesearch.c: between s[0] and s[1], where g changes its sign: where it does if it is linear, a tenth of the way off either end. */
PetscReal SolverInside_Private(const PetscReal s[2], const PetscReal g[2]);
/* linear.c: solve with the matrix as it stands for rhs, to s->y; again: only the active set has changed since the last solution, which is there.
   s->no_solution: there is none. Collective. */
PetscErrorCode SolverMatrixSolve_Private(Solver, Vec rhs, PetscBool again);
/* direct solver by default, everything open to options. */
PetscErrorCode SolverLinear_Private(Solver);
/* x with the factor at hand, from which MUMPS may fail: then the factor is of no use any more. *ok: there is an x. Collective. */
PetscErrorCode SolverFactorSolve_Private(KSP, Vec rhs, Vec x, PetscBool *failed, PetscBool *ok);
/* From the next factorisation on, the exact tangent by LU. */
PetscErrorCode SolverUnsymmetric_Private(Solver);
/* singlefactor.c: make a PC the factor in single precision of its matrix, LDL^T where that is symmetric; exists where MUMPS has it. */
PetscErrorCode SingleFactorSet_Private(PC, PetscBool symmetric);
PetscBool      SingleFactorExists_Private(void);
PetscErrorCode SingleFactorNegative_Private(PC, PetscInt *negative); /* pivots */
/* Analyse the pattern of a matrix, if that was not done: operations that its factorisation will take, 0: not known. And the storage of that given back. */
PetscErrorCode SingleFactorOperations_Private(PC, Mat, PetscReal *operations);
PetscErrorCode SingleFactorForget_Private(PC);

/* inverse.c: y = A^-1 rhs; again: with the factor of the last time. */
typedef PetscErrorCode (*InverseApply)(void *context, PetscBool again, PetscBool *ok);
typedef struct {
  PetscReal theta, norm2, round_off; /* eigenvalue; y . D y; below this theta is none */
} Lowest;
/* Forces at the nodes, [num_nodes][dim], without symmetry, from the reference positions alone. */
void SolverWithoutSymmetry_Private(const HPTables *, PetscReal local[]);
/* The eigenvalue nearest to 0 of A against the diagonal D = scale, from rhs, which is overwritten; y is its eigenvector. Not ok: A is singular. Collective. */
PetscErrorCode SolverInverseIteration_Private(InverseApply, void *context, Vec scale, Vec rhs, Vec y, Lowest *, PetscBool *ok);

/* inertia.c: on several processes MUMPS counts negative pivots only when told to; once before the first factor. The count, after each: s->negative. */
PetscErrorCode SolverInertiaSetUp_Private(Solver);
PetscErrorCode SolverInertia_Private(Solver, PC);
/* A KSP that is MUMPS' LDL^T and counts all pivots. Factorise with it A, the matrix of a problem in a symmetric form; *negative: its negative eigenvalues
   beyond those of the constraints, or why there is no factor. Collective. */
enum { INERTIA_NO_FACTOR = -1 /* A is singular */, INERTIA_NO_MEMORY = -2 };
PetscErrorCode InertiaFactors_Private(MPI_Comm, KSP *);
PetscErrorCode InertiaFactor_Private(Problem, KSP, Mat A, PetscInt *negative);

/* descent.c: minimisation of the augmented Lagrangian Phi. */
typedef struct {
  Solver        solver;
  Problem       problem;
  KSP           ksp;
  Vec           trial, gradient, dx, lambda, depth, next; /* of the problem; depth: overlaps at the iterate (InterfaceMeritDepth), next: at a trial */
  Vec           lift, rhs, y, diagonal, work;             /* of the matrix; diagonal: of the shift, 0 at multipliers */
  PetscBool     measured;                                 /* diagonal is known */
  PetscReal     shift;                                    /* of the last direction */
  PetscReal     least;                                    /* that the next one begins with */
  PetscReal     added;                                    /* to the matrix */
  PetscReal     merit;                                    /* at the iterate */
  PetscReal     fall;                                     /* of the energy, along the lowest eigenvector, in strain energies (stable.c) */
  PetscBool     neutral;                                  /* the equilibrium at the start (stable.c) */
  PetscReal     round_off;                                /* of Phi: a smaller decrease is none; terms as many as unknowns */
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
/* A start, which moves x; down from there, and to a solution of the exact problem. The report says whether, else reason. */
typedef PetscErrorCode (*DescentStart)(Descent *, Vec x, PetscBool *ok);
PetscErrorCode DescentRun_Private(Solver, DescentStart, const char *reason, State *, SolverReport *);

/* saddle.c: iterative solution of the tangent, in its symmetric form or not. */
PetscErrorCode SaddleCreate_Private(Problem, MultigridKind, Saddle *);
PetscErrorCode SaddleDestroy_Private(Saddle *);
PetscErrorCode SaddleSetUp_Private(Saddle, Mat, PetscBool symmetric);
PetscErrorCode SaddleSolve_Private(Saddle, Vec rhs, PetscReal rtol, PetscBool guess, Vec x, PetscBool *ok);
/* multigrid.c: a cycle for the displacement block. */
PetscErrorCode MultigridCreate_Private(Problem, MultigridKind, Multigrid *);
/* Input errors: a kind that PETSc was built without, options of the kind that is not used. Not collective. */
PetscErrorCode MultigridCheck_Private(MultigridKind, LinearKind);
PetscErrorCode MultigridDestroy_Private(Multigrid *);
PetscErrorCode MultigridSetUp_Private(Multigrid, Mat, PetscBool keep);
PetscErrorCode MultigridApply_Private(Multigrid, Vec x, Vec y);
