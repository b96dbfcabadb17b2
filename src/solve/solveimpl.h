/* Private to solve. */
#pragma once
#include "solve.h"

struct _p_Solver {
  Problem       problem; /* borrowed */
  SNES          snes;
  Vec           lift, rhs;
  PetscReal    *pressure; /* of the state being solved, borrowed during SolverSolve */
  PetscReal     rtol;
  PetscBool     symmetric; /* LDL^T of the symmetric form */
  PetscInt      max_it, passes, cuts;
  PetscBool     test; /* -snes_test_jacobian was given */
  SolverReport *report;
};

/* newton.c: the SNES type. */
PetscErrorCode SNESCreate_ContactNewton(SNES);
/* linear.c: direct solver by default, everything open to options. */
PetscErrorCode SolverLinear_Private(Solver);
