/* What a load step that is not found may have come to: a critical load, a bifurcation or a limit point, at which an equilibrium loses its stability. The last
   equilibrium found is soft in one mode then, and ever softer; or contact changes and takes the stiffness at once, so that tangents just beyond, at other
   active sets, have directions in which the energy falls. */
#include "path.h"

#define BACK 0.05 /* of the time: how far before the stiffness is asked for, too */

/* Where a mode at x moves a node most, and of what body that is. */
static PetscErrorCode Place_Private(Problem problem, Vec x, Vec mode, Softest *soft)
{
  const HPTables *v = HPSpaceGetTables(ProblemSpace(problem));
  PetscReal      *u[2], most = -1, size, way;
  PetscInt        node = -1;
  Vec             moved;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(v->num_nodes * v->dim, &u[0], v->num_nodes * v->dim, &u[1]));
  PetscCall(VecNorm(mode, NORM_INFINITY, &size));
  PetscCall(VecNorm(x, NORM_INFINITY, &way));
  PetscCall(VecDuplicate(x, &moved));
  PetscCall(VecWAXPY(moved, PETSC_SQRT_MACHINE_EPSILON * (way > 0 ? way : 1) / size, mode, x)); /* rigid bodies turn, which is linear for a small step alone */
  PetscCall(ProblemLocalDisplacement(problem, moved, u[1]));
  PetscCall(ProblemLocalDisplacement(problem, x, u[0]));
  PetscCall(VecDestroy(&moved));
  for (PetscInt i = 0; i < v->num_nodes; ++i) {
    PetscReal length2 = 0;
    for (PetscInt c = 0; c < v->dim; ++c) length2 += PetscSqr(u[1][i * v->dim + c] - u[0][i * v->dim + c]);
    if (v->node_hang[i + 1] > v->node_hang[i] || length2 <= most) continue;
    most = length2;
    PetscCall(PetscArraycpy(soft->X, v->X + 3 * i, 3));
    node = i;
  }
  if (node >= 0) soft->body = ProblemNodeBody(problem, node);
  PetscCall(PetscFree2(u[0], u[1]));
  PetscCall(BroadcastLargest(ForestComm(ProblemForest(problem)), most, soft, sizeof(*soft)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stiffness of the softest mode a little before the state at hand. */
static PetscErrorCode Before_Private(Path *p, Vec mode, PetscReal *stiffness, PetscBool *known)
{
  Level       *l = p->level;
  SolverReport report;

  PetscFunctionBegin;
  PetscCall(ProblemSetTime(l->problem, (1 - BACK) * l->accepted.t));
  PetscCall(SolverSolve(l->solver, &l->state, &report));
  PathCount(p, &report, PETSC_FALSE);
  *known = report.converged;
  if (*known) PetscCall(SolverLowestMode(l->solver, &l->state, stiffness, mode, known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PathSoftest(Path *p, Softest *soft)
{
  Level    *l = p->level;
  PetscReal now, before;
  PetscBool known;
  Vec       mode;

  PetscFunctionBegin;
  const PetscBool forgets = (PetscBool)(InterfaceSlips(ProblemInterface(l->problem)) || MechanicsIsPlastic(&p->data->mechanics)); /* the way back is another */
  *soft                   = (Softest){.known = PETSC_FALSE};
  if (!(l->accepted.t > 0) || p->data->load.control != LOAD_TIME) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PathRestore(p, &l->accepted));
  PetscCall(VecDuplicate(l->state.x, &mode));
  PetscCall(SolverLowestMode(l->solver, &l->state, &now, mode, &soft->known));
  if (soft->known) {
    PetscCall(Place_Private(l->problem, l->state.x, mode, soft));
    soft->neutral = (PetscBool)(now == 0);
    soft->from    = (1 - BACK) * l->accepted.t;
    if (now > 0 && !forgets) PetscCall(Before_Private(p, mode, &before, &known));
    if (now > 0 && !forgets && known && before > 0) soft->lost = 1 - now / before;
  }
  PetscCall(VecDestroy(&mode));
  PetscCall(PathRestore(p, &l->accepted));
  PetscFunctionReturn(PETSC_SUCCESS);
}
