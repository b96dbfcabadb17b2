/* Was a body that nothing holds thrown off? Where it bears no load every place is an equilibrium for it, and under a dead load a place so far off that forces
   are less than the round-off of displacements passes for one. What moves such a body are those that are held: it cannot get farther than they do, but for its
   own size, in which it may slip out of them. */
#include "diagnoseimpl.h"

/* A body on its way from one state to another, by the corners of its outer facets: summed over ranks, and the largest. */
typedef struct {
  PetscReal way[3], num;
} Mean;
typedef struct {
  PetscReal way, box[6]; /* -low, high at the reference positions */
} Most;

static void Add_Private(PetscInt dim, const Piece *from, const Piece *to, Mean *mean, Most *most)
{
  for (PetscInt a = 0; a < dim; ++a) {
    PetscReal way2 = 0;
    for (PetscInt c = 0; c < dim; ++c) {
      const PetscReal way = to->x[3 * a + c] - from->x[3 * a + c], X = to->X[3 * a + c];
      mean->way[c] += way;
      way2 += PetscSqr(way);
      most->box[c]     = PetscMax(most->box[c], -X);
      most->box[3 + c] = PetscMax(most->box[3 + c], X);
    }
    mean->num += 1;
    most->way = PetscMax(most->way, PetscSqrtReal(way2));
  }
}

/* mean[body], most[body], the same on every rank. Collective. */
static PetscErrorCode Ways_Private(Problem problem, const PetscReal from[], const State *state, PetscInt num, Mean mean[], Most most[])
{
  MPI_Comm comm = ForestComm(ProblemForest(problem));
  Pieces   s[2] = {{0}, {0}};

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(mean, num));
  for (PetscInt b = 0; b < num; ++b) {
    most[b].way = 0;
    for (PetscInt c = 0; c < 6; ++c) most[b].box[c] = -PETSC_MAX_REAL;
  }
  PetscCall(PiecesAt_Private(problem, from, PETSC_TRUE, &s[0]));
  PetscCall(PiecesCollect_Private(problem, state, PETSC_TRUE, &s[1]));
  for (PetscInt i = 0; i < s[0].num; ++i) {
    const PetscInt b = s[0].piece[i].body;
    Add_Private(s[0].dim, &s[0].piece[i], &s[1].piece[i], &mean[b], &most[b]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, mean, (PetscMPIInt)(4 * num), MPIU_REAL, MPI_SUM, comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, (PetscMPIInt)(7 * num), MPIU_REAL, MPI_MAX, comm));
  for (PetscInt k = 0; k < 2; ++k) PetscCall(PetscFree(s[k].piece));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Diagonal of the body's box. */
static PetscReal Size_Private(const Most *m, PetscInt dim)
{
  PetscReal square = 0;

  for (PetscInt c = 0; c < dim; ++c) square += PetscSqr(m->box[c] + m->box[3 + c]);
  return PetscSqrtReal(square);
}

PetscErrorCode ThrownFind(Problem problem, const PetscReal from[], const State *state, PetscReal scale, PetscInt *body)
{
  const PetscInt num = ProblemGetScene(problem)->mechanics.num_bodies, dim = ForestGetCoarse(ProblemForest(problem))->dim;
  PetscReal      farthest = 0;
  PetscInt      *axes, adrift = 0;
  Mean          *mean;
  Most          *most;

  PetscFunctionBegin;
  *body = -1;
  PetscCall(PetscMalloc3(num, &axes, num, &mean, num, &most));
  PetscCall(AdriftFind(problem, scale, axes));
  for (PetscInt b = 0; b < num; ++b) adrift |= axes[b];
  if (adrift) PetscCall(Ways_Private(problem, from, state, num, mean, most));
  for (PetscInt b = 0; b < num && adrift; ++b)
    if (!axes[b]) farthest = PetscMax(farthest, most[b].way);
  for (PetscInt b = 0; b < num && *body < 0; ++b)
    for (PetscInt c = 0; c < dim && axes[b]; ++c)
      if (axes[b] >> c & 1 && PetscAbsReal(mean[b].way[c]) > (farthest + Size_Private(&most[b], dim)) * mean[b].num) *body = b;
  PetscCall(PetscFree3(axes, mean, most));
  PetscFunctionReturn(PETSC_SUCCESS);
}
