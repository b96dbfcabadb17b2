/* Was a body that nothing holds thrown off? Where it bears no load every place is an equilibrium for it, and under a dead load a place so far off that forces
   are less than the round-off of displacements passes for one. What moves such a body are those that are held: it cannot get farther than they do, but for its
   own size, in which it may slip out of them. */
#include "diagnoseimpl.h"

/* A body on its way from one state to another. */
typedef struct {
  PetscReal way[3], num; /* sum over the corners of its outer facets, how many there are */
  PetscReal most;        /* the longest way of one */
  PetscReal size;        /* diagonal of its box at the reference positions */
} Journey;

static void Add_Private(PetscInt dim, const Piece *from, const Piece *to, Journey *j, PetscReal box[6])
{
  for (PetscInt a = 0; a < dim; ++a) {
    PetscReal way2 = 0;
    for (PetscInt c = 0; c < dim; ++c) {
      const PetscReal way = to->x[3 * a + c] - from->x[3 * a + c];
      j->way[c] += way;
      way2 += PetscSqr(way);
      box[c]     = PetscMax(box[c], -to->X[3 * a + c]);
      box[3 + c] = PetscMax(box[3 + c], to->X[3 * a + c]);
    }
    j->num += 1;
    j->most = PetscMax(j->most, PetscSqrtReal(way2));
  }
}

/* journey[body], the same on every rank. Collective. */
static PetscErrorCode Journeys_Private(Problem problem, const PetscReal from[], const State *state, PetscInt num, Journey journey[])
{
  MPI_Comm   comm = ForestComm(ProblemForest(problem));
  Pieces     s[2] = {{0}, {0}};
  PetscReal *sum, *most; /* [num][4], [num][7]: the longest way and the box */

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(journey, num));
  PetscCall(PetscMalloc2(4 * num, &sum, 7 * num, &most));
  for (PetscInt i = 0; i < 7 * num; ++i) most[i] = -PETSC_MAX_REAL;
  PetscCall(PiecesAt_Private(problem, from, PETSC_TRUE, &s[0]));
  PetscCall(PiecesCollect_Private(problem, state, PETSC_TRUE, &s[1]));
  for (PetscInt i = 0; i < s[0].num; ++i) {
    const PetscInt b = s[0].piece[i].body;
    Add_Private(s[0].dim, &s[0].piece[i], &s[1].piece[i], &journey[b], most + 7 * b + 1);
  }
  for (PetscInt b = 0; b < num; ++b) {
    for (PetscInt c = 0; c < 3; ++c) sum[4 * b + c] = journey[b].way[c];
    sum[4 * b + 3] = journey[b].num;
    most[7 * b]    = journey[b].most;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(4 * num), MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, (PetscMPIInt)(7 * num), MPIU_REAL, MPI_MAX, comm));
  for (PetscInt b = 0; b < num; ++b) {
    PetscReal size2 = 0;
    for (PetscInt c = 0; c < s[0].dim; ++c) size2 += PetscSqr(most[7 * b + 1 + c] + most[7 * b + 4 + c]);
    journey[b] = (Journey){{sum[4 * b], sum[4 * b + 1], sum[4 * b + 2]}, sum[4 * b + 3], most[7 * b], PetscSqrtReal(size2)};
  }
  PetscCall(PetscFree2(sum, most));
  for (PetscInt k = 0; k < 2; ++k) PetscCall(PetscFree(s[k].piece));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Scale of the forces at the state; those of contact are then its own. */
static PetscErrorCode Scale_Private(Problem problem, const State *state, PetscReal *scale)
{
  ProblemStatus status;
  Vec           residual;

  PetscFunctionBegin;
  PetscCall(VecDuplicate(state->x, &residual));
  PetscCall(ProblemResidual(problem, state->x, NULL, residual, &status));
  PetscCall(VecDestroy(&residual));
  *scale = status.scale;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ThrownFind(Problem problem, const PetscReal from[], const State *state, PetscInt *body)
{
  const SceneData *scene = ProblemGetScene(problem);
  const PetscInt   num   = scene->mechanics.num_bodies;
  PetscReal        scale, farthest = 0;
  PetscInt        *axes;
  Journey         *journey;
  PetscBool        free;

  PetscFunctionBegin;
  *body = -1;
  PetscCall(AdriftMay(problem, &free));
  if (!free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(num, &axes, num, &journey));
  PetscCall(Scale_Private(problem, state, &scale));
  PetscCall(AdriftFind(problem, scale, axes));
  PetscCall(Journeys_Private(problem, from, state, num, journey));
  for (PetscInt b = 0; b < num; ++b)
    if (!axes[b]) farthest = PetscMax(farthest, journey[b].most);
  for (PetscInt b = 0; b < num && *body < 0; ++b)
    for (PetscInt c = 0; c < 3; ++c)
      if (axes[b] >> c & 1 && PetscAbsReal(journey[b].way[c]) > (farthest + journey[b].size) * journey[b].num) *body = b;
  PetscCall(PetscFree2(axes, journey));
  PetscFunctionReturn(PETSC_SUCCESS);
}
