/* Cells that are turned inside out at a corner: det F is positive at the integration points of every solution, between them and the corners it need not be. */
#include "diagnoseimpl.h"

/* Least det F at the corners of a cell, and where. On the axis of revolution the third stretch is not asked for: it is positive. */
static PetscErrorCode Corners_Private(Mechanics mechanics, PetscInt dim, PetscInt cell, const PetscReal u[], PetscReal *least, PetscReal X[3])
{
  PetscReal      xi[8 * 3], F[8 * 9], Y[8 * 3];
  const PetscInt num = 1 << dim;

  PetscFunctionBegin;
  *least = PETSC_MAX_REAL;
  for (PetscInt k = 0; k < num; ++k)
    for (PetscInt d = 0; d < dim; ++d) xi[k * dim + d] = k >> d & 1;
  PetscCall(MechanicsPoints(mechanics, cell, num, xi, u, &(PointValues){.X = Y, .F = F}));
  for (PetscInt k = 0; k < num; ++k) {
    const PetscReal *f = F + 9 * k, det = dim == 2 ? f[0] * f[4] - f[1] * f[3] : Det3(f);
    if (det >= *least) continue;
    *least = det;
    PetscCall(PetscArraycpy(X, Y + 3 * k, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FoldedFind(Problem problem, Vec x, Folded *folded, int8_t leaf[])
{
  const SceneData    *scene = ProblemGetScene(problem);
  const ForestTables *t     = ForestGetTables(ProblemForest(problem));
  const HPTables     *v     = HPSpaceGetTables(ProblemSpace(problem));
  PetscReal          *u, det, X[3];
  const MPI_Comm      comm = ForestComm(ProblemForest(problem));

  PetscFunctionBegin;
  *folded = (Folded){.det = PETSC_MAX_REAL};
  if (leaf) PetscCall(PetscArrayzero(leaf, t->num_leaves));
  PetscCall(PetscMalloc1(v->num_nodes * v->dim, &u));
  PetscCall(ProblemLocalDisplacement(problem, x, u));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt body = t->leaf_body[v->cell_leaf[c]];
    if (scene->mechanics.bodies[body].material->law->rigid) continue;
    PetscCall(Corners_Private(ProblemMechanics(problem), v->dim, c, u, &det, X));
    folded->num += det <= 0;
    if (leaf) leaf[v->cell_leaf[c]] = det <= 0;
    if (det >= folded->det) continue;
    folded->det  = det;
    folded->body = body;
    PetscCall(PetscArraycpy(folded->X, X, 3));
  }
  PetscCall(PetscFree(u));
  if (leaf) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, leaf, (PetscMPIInt)t->num_leaves, MPI_INT8_T, MPI_MAX, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &folded->num, 1, MPIU_INT, MPI_SUM, comm));
  PetscCall(BroadcastLargest(comm, -folded->det, folded, sizeof(*folded)));
  PetscFunctionReturn(PETSC_SUCCESS);
}
