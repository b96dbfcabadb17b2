/* Life cycle of the solver; the functions SNES calls. */
#include "solveimpl.h"

static PetscErrorCode Function_Private(SNES snes, Vec x, Vec r, void *context)
{
  Solver s = (Solver)context;

  PetscFunctionBegin;
  PetscCall(ProblemResidual(s->problem, x, NULL, r, &s->report->status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Called only by PETSc's Jacobian test, which needs the exact derivative of the residual: consistent pressures, no lift. */
static PetscErrorCode Jacobian_Private(SNES snes, Vec x, Mat J, Mat P, void *context)
{
  Solver    s = (Solver)context;
  PetscBool bad;

  PetscFunctionBegin;
  PetscCall(ProblemTangent(s->problem, x, NULL, NULL, &bad));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where surfaces that rest on each other touch first, and where nodes that slipped begin a step, rows are at their kinks: differences with states that come
   and go across them are those of no tangent. */
PetscErrorCode SolverTest_Private(Solver s, Vec x)
{
  Form      form = FormPlain(s->form.frozen_segmentation);
  Mat       A;
  PetscBool bad;

  PetscFunctionBegin;
  PetscCall(ProblemSetForm(s->problem, &form));
  PetscCall(ProblemTangent(s->problem, x, NULL, NULL, &bad));
  form.frozen_states = PETSC_TRUE;
  PetscCall(ProblemSetForm(s->problem, &form));
  PetscCall(ProblemGetMatrix(s->problem, &A));
  PetscCall(SNESSetJacobian(s->snes, A, A, NULL, NULL));
  PetscCall(SNESComputeJacobian(s->snes, x, A, A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Options_Private(Solver s)
{
  PetscFunctionBegin;
  s->rtol            = 1e-10;
  s->max_it          = 25;
  s->max_funcs       = PETSC_MAX_INT;
  s->passes          = 10;
  s->single_switches = PETSC_TRUE;
  s->cuts            = 6;

  s->linear                = LINEAR_AUTO;
  s->factor                = FACTOR_AUTO;
  s->linear_rtol           = 1e-9;
  const PetscBool possible = ProblemIsSymmetric(s->problem);
  s->symmetric             = possible;
  PetscCall(SolverOptions_Private(s));
  PetscCall(MultigridCheck_Private(s->multigrid, s->linear));
  s->symmetric = (PetscBool)(s->symmetric && possible);
  PetscCall(PetscOptionsHasName(NULL, NULL, "-snes_test_jacobian", &s->test));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Highest order of a cell. */
static PetscErrorCode Highest_Private(Problem p, PetscInt *order)
{
  const HPTables *v = HPSpaceGetTables(ProblemSpace(p));

  PetscFunctionBegin;
  *order = 1;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) *order = PetscMax(*order, v->cell_order[c]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, order, 1, MPIU_INT, MPI_MAX, ForestComm(ProblemForest(p))));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multigrid or a factorisation? In the plane factors stay cheap; in space the matrix has to be looked at where it is large (linear.c). Multigrid is poor on
   nearly incompressible material, knows no pressure unknowns and needs symmetry. */
static PetscErrorCode UseMultigrid_Private(Solver s, PetscBool *yes)
{
  const SceneData *scene = ProblemGetScene(s->problem);
  PetscInt         num_u, num_z, dim;
  const PetscInt   dofs = ProblemNumDofs(s->problem);

  PetscFunctionBegin;
  ProblemGetBlocks(s->problem, &num_u, &num_z, &dim);
  *yes = (PetscBool)(dim == 3 && dofs >= SOLVER_LARGE);
  for (PetscInt b = 0; b < scene->mechanics.num_bodies; ++b) {
    if (scene->mechanics.bodies[b].material->mixed) *yes = PETSC_FALSE;
  }
  s->reuse = (PetscBool)(dim == 3);
  if (s->linear == LINEAR_DIRECT) *yes = PETSC_FALSE;
  if (s->linear == LINEAR_ITERATIVE) *yes = PETSC_TRUE;
  const PetscBool incompressible = ProblemIsIncompressible(s->problem);
  PetscCheckInput(!*yes || !incompressible, "-solve_linear iterative: not with incompressible material (kappa: inf, nu: 0.5); take auto or direct");
  const PetscInt scalars = ProblemNumScalars(s->problem);
  if (!s->symmetric || scalars) *yes = PETSC_FALSE;
  PetscCheckInput(
      s->linear != LINEAR_ITERATIVE || !scalars,
      "-solve_linear iterative: not with pressures that are found (volume, advance), loads of rigid bodies or load.control: arc_length; take direct");
  s->choose = (PetscBool)(*yes && s->linear == LINEAR_AUTO);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first material whose cells have an unsymmetric tangent, NULL: none. */
static const MaterialSpec *Unsymmetric_Private(const SceneData *scene)
{
  for (PetscInt b = 0; b < scene->mechanics.num_bodies; ++b) {
    if (scene->mechanics.bodies[b].material->law->unsymmetric) return scene->mechanics.bodies[b].material;
  }
  return NULL;
}

/* Condense the nodes inside cells? PETSc's test of the tangent and the equation of a path want the whole matrix, nodes inside a cell that is constrained to a
   lower order in some direction are not of its own alone, those of incompressible cells meet its pressures, and cells are condensed by LDL^T. */
static PetscErrorCode Condense_Private(Solver s)
{
  PetscInt            num_u, num_z, dim;
  PetscBool           yes, directional, whole;
  const SceneData    *scene = ProblemGetScene(s->problem);
  const MaterialSpec *unsymmetric;

  PetscFunctionBegin;
  unsymmetric = Unsymmetric_Private(scene);
  PetscCheckInput(!unsymmetric || s->condense != CONDENSE_YES, "-solve_condense yes: not with material %s, whose tangent (law %s) is not symmetric; take no",
                  unsymmetric->name, unsymmetric->law->name);
  PetscCall(HPSpaceIsDirectional(ProblemSpace(s->problem), &directional));
  PetscCheckInput(!directional || s->condense != CONDENSE_YES, "-solve_condense yes: not with orders per direction (body.<name>.order: {x: ...}); take no");
  const PetscBool incompressible = ProblemIsIncompressible(s->problem);
  PetscCheckInput(!incompressible || s->condense != CONDENSE_YES, "-solve_condense yes: not with incompressible material (kappa: inf, nu: 0.5); take no");
  whole = (PetscBool)(s->test || scene->load.control == LOAD_ARC_LENGTH);
  PetscCheckInput(scene->load.control != LOAD_ARC_LENGTH || s->condense != CONDENSE_YES,
                  "-solve_condense yes: not with load.control: arc_length, whose equation has all displacements in it; take no");
  PetscCheckInput(!s->test || s->condense != CONDENSE_YES, "-solve_condense yes: not with -snes_test_jacobian, which needs the whole matrix");
  ProblemGetBlocks(s->problem, &num_u, &num_z, &dim);
  yes = (PetscBool)(s->condense == CONDENSE_YES || (s->condense == CONDENSE_AUTO && !directional && !incompressible && !unsymmetric &&
                                                    s->order > dim)); /* from there on it pays (docs/results.md) */
  if (yes && !whole) PetscCall(ProblemSetCondense(s->problem));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are there element pressures that are condensed? */
static PetscBool StoresPressure_Private(Problem p)
{
  const MechanicsSpec *m = &ProblemGetScene(p)->mechanics;

  for (PetscInt b = 0; b < m->num_bodies; ++b)
    if (MaterialStoresPressure(m->bodies[b].material)) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode SolverCreate(Problem problem, Solver *solver)
{
  Solver    s;
  Mat       A;
  Vec       r;
  PetscBool multigrid;

  PetscFunctionBegin;
  PetscCall(PetscNew(&s));
  s->problem = problem;
  PetscCall(SNESRegister("contactnewton", SNESCreate_ContactNewton));
  PetscCall(ProblemCreateVector(problem, &r));
  PetscCall(SNESCreate(PetscObjectComm((PetscObject)r), &s->snes));
  PetscCall(Options_Private(s));
  PetscCall(Highest_Private(problem, &s->order));
  PetscCall(SNESSetType(s->snes, "contactnewton"));
  PetscCall(SNESSetApplicationContext(s->snes, s));
  PetscCall(SolverLinear_Private(s));
  PetscCall(UseMultigrid_Private(s, &multigrid));
  PetscCall(Condense_Private(s));
  if (multigrid && !s->choose) PetscCall(SaddleCreate_Private(problem, s->multigrid, &s->saddle));
  PetscCall(SNESSetTolerances(s->snes, s->snes_atol, s->snes_rtol, s->snes_stol, s->max_it, s->max_funcs));
  PetscCall(SNESSetFromOptions(s->snes));
  PetscCall(SNESSetFunction(s->snes, r, Function_Private, s));
  PetscCall(VecDestroy(&r));
  PetscCall(ProblemGetMatrix(problem, &A));
  PetscCall(SNESSetJacobian(s->snes, A, A, Jacobian_Private, s));
  PetscCall(ProblemCreateRightSide(problem, &s->lift));
  PetscCall(VecDuplicateAll(s->lift, 2, (Vec *[]){&s->rhs, &s->y}));
  if (StoresPressure_Private(problem)) PetscCall(ProblemCreateVector(problem, &s->balance));
  *solver = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SolverSwapPredictor(Solver s, PetscBool swap)
{
  s->swap = swap;
}

PetscErrorCode SolverDestroy(Solver *solver)
{
  Solver s = *solver;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESDestroy(&s->snes));
  PetscCall(SaddleDestroy_Private(&s->saddle));
  PetscCall(KSPDestroy(&s->refine));
  PetscCall(VecDestroyAll(4, (Vec *[]){&s->lift, &s->rhs, &s->y, &s->balance}));
  PetscCall(PetscFree(s->pass_sets));
  PetscCall(PetscFree(s->end));
  PetscCall(PetscFree(*solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverSolve(Solver s, State *state, SolverReport *report)
{
  PetscFunctionBegin;
  PetscCall(PetscMemzero(report, sizeof(*report)));
  report->reason  = "";
  s->report       = report;
  s->state        = state;
  s->pressure     = state->pressure;
  s->num_pressure = state->num_pressure;
  if (s->balance && !s->end) PetscCall(PetscMalloc1(s->num_pressure, &s->end));
  s->form = state->form;
  PetscCall(ProblemSetState(s->problem, state));
  PetscCall(SNESSolve(s->snes, NULL, state->x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &report->pressed, 1, MPI_UINT64_T, MPI_BOR, PetscObjectComm((PetscObject)s->snes)));
  state->form = FormPlain(s->form.frozen_segmentation);
  PetscCall(ProblemSetState(s->problem, state)); /* points tell of the pressures found */
  s->report   = NULL;
  s->state    = NULL;
  s->pressure = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverUnfreeze(Solver s, State *state, SolverReport *report)
{
  PetscFunctionBegin;
  state->form.frozen_segmentation = PETSC_FALSE;
  s->never_freeze                 = PETSC_TRUE;
  PetscCall(SolverSolve(s, state, report));
  s->never_freeze = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
