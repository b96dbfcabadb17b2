/* Supports that all move as one rigid body turn the bodies with them. From the straight way of a large turn, on which bodies shrink, Newton's method may find
   another state: one with friction that has slipped, or a fold. So where the whole of what is prescribed is one rigid motion with a rotation, however it was
   written, a step starts from the last state moved so. */
#include "problemimpl.h"

typedef struct {
  PetscReal from[3], to[3], R[9]; /* x -> to + R (x - from) */
} Motion;

/* Where node n is with the displacements u. */
static void Place_Private(const HPTables *v, const PetscReal u[], PetscInt n, PetscReal x[3])
{
  for (PetscInt c = 0; c < 3; ++c) x[c] = v->X[3 * n + c] + (c < v->dim ? u[v->dim * n + c] : 0);
}

/* Sums over the nodes all of whose components are prescribed: their number, places before (3) and after (3), products of both about the origins `about` (9),
   and squares of the places before (1). Nodes that processes share count more than once, which changes nothing where the motion is rigid. */
static PetscErrorCode Sum_Private(Problem p, const PetscReal u[], const Motion *about, PetscReal sum[17])
{
  const HPTables *v   = p->tables;
  const int8_t    all = (int8_t)((1 << v->dim) - 1);

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(sum, 17));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    PetscReal a[3], b[3];

    if ((p->supports.fixed[n] & all) != all) continue;
    Place_Private(v, u, n, a);
    Place_Private(v, p->target, n, b);
    sum[0] += 1;
    for (PetscInt i = 0; i < 3; ++i) {
      sum[1 + i] += a[i];
      sum[4 + i] += b[i];
      sum[16] += PetscSqr(a[i] - about->from[i]);
      for (PetscInt j = 0; j < 3; ++j) sum[7 + 3 * i + j] += (a[i] - about->from[i]) * (b[j] - about->to[j]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 17, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rigid motion nearest to that of the supports from u to their target. *turns: there is one, and it has a rotation. Collective. */
static PetscErrorCode Motion_Private(Problem p, const PetscReal u[], Motion *m, PetscBool *turns)
{
  PetscReal sum[17], q[4], phi[3], length;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(m, sizeof(*m)));
  PetscCall(Sum_Private(p, u, m, sum));
  *turns = PETSC_FALSE;
  if (sum[0] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < 3; ++i) {
    m->from[i] = sum[1 + i] / sum[0];
    m->to[i]   = sum[4 + i] / sum[0];
  }
  PetscCall(Sum_Private(p, u, m, sum));
  PetscCall(RotationNearest(p->tables->dim, sum + 7, q, turns));
  length = PetscSqrtReal(Dot3(q + 1, q + 1));
  *turns = (PetscBool)(*turns && length > ROUND_LENGTH && sum[16] > PetscSqr(ROUND_LENGTH * p->extent) * sum[0]); /* nodes at one place tell of none */
  if (!*turns) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < 3; ++i) phi[i] = 2 * atan2(length, q[0]) * q[1 + i] / length;
  RotationMatrix(phi, m->R);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u: displacements, moved with the places that they lead to. */
static void Move_Private(const HPTables *v, const Motion *m, PetscReal u[])
{
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    PetscReal x[3];

    Place_Private(v, u, n, x);
    for (PetscInt c = 0; c < 3; ++c) x[c] -= m->from[c];
    for (PetscInt c = 0; c < v->dim; ++c) u[v->dim * n + c] = Dot3(m->R + 3 * c, x) + m->to[c] - v->X[3 * n + c];
  }
}

/* Can what is prescribed be one rigid motion with a rotation? Not where turning makes no sense, nor with supports along normals, whose components are not those
   of places, nor with rigid bodies that loads move: they are where they are. */
static PetscBool May_Private(const Problem p)
{
  const MechanicsSpec *m = &p->scene->mechanics;

  if (m->model == MODEL_AXISYMMETRIC || m->kinematics == KINEMATICS_SMALL || p->num_scalars) return PETSC_FALSE;
  for (PetscInt i = 0; i < m->num_boundaries; ++i)
    if (m->boundaries[i].fix_normal) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode ProblemTurn(Problem p, Vec x, PetscBool *turned)
{
  const HPTables *v = p->tables;
  Motion          motion;
  PetscReal       off = 0, *u;

  PetscFunctionBegin;
  *turned = PETSC_FALSE;
  if (!May_Private(p)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(p->num_local, &u));
  PetscCall(ProblemLocalDisplacement(p, x, u));
  PetscCall(Motion_Private(p, u, &motion, turned));
  if (*turned) {
    Move_Private(v, &motion, u);
    for (PetscInt i = 0; i < p->num_local; ++i)
      if (p->supports.fixed[i / v->dim] >> (i % v->dim) & 1) off = PetscMax(off, PetscAbsReal(u[i] - p->target[i]));
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &off, 1, MPIU_REAL, MPI_MAX, p->comm));
    *turned = (PetscBool)(off <= ROUND_LENGTH * p->extent);
  }
  if (*turned) {
    PetscCall(ProblemSetDisplacement(p, u, x));
    PetscCall(ProblemJump(p));
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
