/* Floor 6. Nonlinear and linear solution of one problem at one pseudo-time. */
#pragma once
#include "problem.h"

typedef struct _p_Solver *Solver;

#define SOLVER_MOST_MODIFIERS 12

typedef struct {
  PetscBool     converged;
  PetscBool     stopped;    /* given up because somebody asked to (StopAsked) */
  PetscBool     undefined;  /* a value of the scene is no number there: whatever the way, there is no equilibrium */
  const char   *reason;     /* why not, in words */
  PetscInt      iterations; /* tangent assemblies */
  PetscInt      factorisations;
  PetscInt      single_failures;                  /* factors in single precision that did not serve: a solver has at most one, then it takes double */
  PetscInt      set_changes;                      /* contact nodes that active-set passes switched */
  PetscInt      single_switches;                  /* of these, passes in which one node switched alone */
  PetscInt      set_cycles;                       /* linearisations whose active sets repeated, and 1 when Newton's own did */
  PetscInt      modifiers[SOLVER_MOST_MODIFIERS]; /* how often each modifier intervened */
  PetscInt      unstable;   /* converged: directions along which the energy falls that the constraints allow, of the last tangent factorised; -1: not known */
  PetscInt      indefinite; /* factorisations that told of such directions */
  PetscInt      descents;   /* of SolverDescend, each with multipliers of its own */
  PetscInt      descent_iterations; /* their tangent assemblies */
  PetscReal     fall;               /* of SolverStabilise: of the energy along the lowest eigenvector, in strain energies */
  PetscBool     neutral;            /* of SolverStabilise: the lowest eigenvalue is not below zero but by round-off */
  uint64_t      pressed;            /* contact pairs in which nodes bore in a linear step, as bits; the same on every rank */
  PetscReal     residual, scale;
  ProblemPlace  worst; /* of the iterate at which it was given up */
  ProblemStatus status;
} SolverReport;

/* Modifiers of Newton's iteration, mechanisms besides linearising, solving, moving and judging (src/solve/modifier.c): number and names; each has a switch
   -newton_<name> on|off|auto. Not collective. */
PetscInt    SolverNumModifiers(void);
const char *SolverModifierName(PetscInt);

/* SNES of the registered type "contactnewton" over the problem's residual and tangent. Options: ksp_*, pc_*, mat_mumps_*, -newton_<modifier>,
   -snes_max_it (25), -snes_rtol, -snes_atol, -snes_stol, -snes_max_funcs and monitors, and -solve_rtol (1e-10: residual against the nodal forces),
   -solve_active_set_passes (10), -solve_cuts (6),
   -solve_condense auto|yes|no (auto: from order 3 in the plane and 4 in space the unknowns of nodes inside cells are eliminated there, before the linear
   solver), -solve_linear auto|direct|iterative (auto: multigrid and GMRES for large three-dimensional problems of compressible material with a symmetric
   tangent; a factorisation where that fails and everywhere else), -solve_factor auto|single|double (precision of factors; auto: single in three dimensions from
   20 000 unknowns on, where MUMPS has it and no -pc_type was given; double where that fails), -solve_linear_rtol; saddle_ksp_* (GMRES), multigrid_pc_*,
   multigrid_smoother_*, again_ksp_* (GMRES on a factor in single precision or of an earlier tangent). Collective. */
PetscErrorCode SolverCreate(Problem, Solver *);
PetscErrorCode SolverDestroy(Solver *);
/* Are all -solve_*, -newton_* and -snes_* options known, can they act, and are their values allowed? An input error when one is not. Collective. */
PetscErrorCode SolverCheckOptions(void);
/* The one of them, without its dash, that is nearest to a name. Not collective. */
const char *SolverNearestOption(const char *name);
/* The -solve_*, -newton_* and -snes_* options as text for -help. */
PetscErrorCode SolverPrintHelp(MPI_Comm);

/* Solve at the problem's current time, starting from state (x, pressure), which is changed. The prescribed motion not yet applied enters the first linear
   solve. Active sets that repeat are noticed: passes of one linearisation that get no further switch one node at a time; Newton iterates that repeat fail at
   once, so that the load step is cut. A request to stop (StopAsked) is heard before each factorisation. Failure is a report, not an error: the state is then of
   no use (restore a copy). */
PetscErrorCode SolverSolve(Solver, State *, SolverReport *);
/* From now on slide_predictor carries the bodies of pairs with friction where else it would not, and does not where it would; plastic material begins elastic
   and goes on with its secant stiffness. Not collective. */
void SolverSwapPredictor(Solver, PetscBool swap);
/* From a solution with a frozen segmentation to one without: SolverSolve, given up where the segmentation would be frozen again. Collective. */
PetscErrorCode SolverUnfreeze(Solver, State *, SolverReport *);

/* As SolverSolve, where that finds nothing, by descent: from the state at the start of the step, with the prescribed motion put in by the bodies alone, down
   to a minimum of the augmented Lagrangian (ProblemMerit), each iterate lower than the one before; multipliers follow; then SolverSolve from there, as a rule
   after one descent or two. Slow, and nothing cycles. Collective. */
PetscErrorCode SolverDescend(Solver, State *, SolverReport *);
/* mode.c. The eigenvalue nearest to 0 of the tangent at an equilibrium, against the largest entries of the rows of displacements, 0 where it is round-off, and
   its eigenvector as a vector of the problem (NULL: not wanted). Not known where the tangent is singular. Collective. */
PetscErrorCode SolverLowestMode(Solver, State *, PetscReal *stiffness, Vec mode, PetscBool *known);
/* inertia.c. Directions in which an equilibrium is unstable: negative eigenvalues of the symmetric part of its tangent, round-off left out. num < 0: not
   known, with friction, bodies that contact alone holds, controls, multigrid or where a factor is not found. Leaves the problem's matrix with that part.
   IsSymmetric: are factors LDL^T, which count as they solve? Collective. */
PetscErrorCode SolverCountUnstable(Solver, State *, PetscInt *num);
PetscBool      SolverIsSymmetric(Solver);
/* From an equilibrium that is unstable (report.unstable) to one that is stable, or less so: along the eigenvector of the lowest eigenvalue, where the energy
   falls more, and by descent. Not converged: there is no such eigenvalue, or no equilibrium was found. HasDescent: is there an energy, and are there the
   factors? Collective. */
PetscBool      SolverHasDescent(Solver);
PetscErrorCode SolverStabilise(Solver, State *, SolverReport *);
