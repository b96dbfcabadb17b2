/* Does the motion that supports prescribe slide the bodies of a pair along each other, by a good part of the zone that is under pressure? That can be told
   before anything is solved where supports prescribe how a body moves along the surface of contact. */
#include "problemimpl.h"

#define SLIPS 0.15     /* share of the zone's extent */
#define UNKNOWN 1e-6   /* least share of the mean in the determinant of directions with a prescribed motion */
#define MOTION (9 + 3) /* numbers of a body: sum q q^T, sum q du over prescribed dofs along q */

/* What supports still prescribe, over the nodes of each body: [num_bodies][MOTION], summed over ranks. */
static PetscErrorCode Prescribed_Private(Problem p, PetscReal motion[])
{
  const HPTables     *v;
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(ForestGetTables(p->forest, &t));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscInt   leaf  = t->entity_leaf[v->node_entity[n]];
    PetscReal       *m     = motion + MOTION * t->leaf_body[leaf];
    const PetscInt   fixed = p->supports.fixed[n];
    const PetscReal *frame;
    if (fixed == 0 || t->leaf_rank[leaf] != p->rank) continue;
    PetscCall(HPSpaceGetFrame(p->space, n, &frame));
    for (PetscInt d = 0; d < p->dim; ++d) {
      const PetscReal du = p->target[p->dim * n + d] - p->applied[p->dim * n + d];
      PetscReal       q[3];
      if (!((fixed >> d) & 1)) continue;
      for (PetscInt i = 0; i < 3; ++i) q[i] = frame ? frame[3 * d + i] : (PetscReal)(i == d);
      for (PetscInt i = 0; i < 3; ++i) {
        for (PetscInt j = 0; j < 3; ++j) m[3 * i + j] += q[i] * q[j];
        m[9 + i] += q[i] * du;
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, motion, (PetscMPIInt)(MOTION * p->scene->mechanics.num_bodies), MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Least-squares translation of a body, what lies along n free: its part across n in slip. False: some other direction has no prescribed motion. */
static PetscBool Translation_Private(PetscInt dim, const PetscReal m[MOTION], const PetscReal n[3], PetscReal slip[3])
{
  const PetscReal trace = m[0] + m[4] + m[8];
  PetscReal       A[9], x[3];

  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) A[3 * i + j] = m[3 * i + j] + trace * (n[i] * n[j] + (PetscReal)(dim == 2 && i == 2 && j == 2));
  if (!(Det3(A) > UNKNOWN * trace * trace * trace) || !Solve3(A, m + 9, x)) return PETSC_FALSE;
  for (int j = 0; j < 3; ++j) slip[j] = x[j] - Dot3(x, n) * n[j];
  return PETSC_TRUE;
}

/* Sums over the nodes under pressure of one pair: force on the nonmortar side, extent of the zone, and each side's forces by the body of the node. */
static PetscErrorCode Zone_Private(Problem p, const Contact *c, PetscReal force[3], PetscReal *extent, PetscReal share[])
{
  const PetscInt      dim = p->dim, nb = p->scene->mechanics.num_bodies;
  const ForestTables *t;
  PetscReal           sum[4] = {0, 0, 0, 0};

  PetscFunctionBegin;
  PetscCall(ForestGetTables(p->forest, &t));
  PetscCall(PetscArrayzero(share, 2 * nb));
  for (PetscInt k = 0; k < 2; ++k) {
    const Surface *s = &c->side[k];
    for (PetscInt i = 0; i < s->num_own; ++i) {
      const PetscInt   j      = s->own[i];
      const PetscReal *f      = s->force + dim * j;
      PetscReal        square = 0;
      for (PetscInt d = 0; d < dim; ++d) {
        square += PetscSqr(f[d]);
        if (k == 0) sum[d] += f[d];
      }
      share[nb * k + t->leaf_body[t->entity_leaf[s->node_entity[j]]]] += PetscSqrtReal(square);
      if (k == 0 && ContactPressed_Private(c, j)) sum[3] += dim == 2 ? c->extent[j] : PetscSqr(c->extent[j]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, p->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, share, (PetscMPIInt)(2 * nb), MPIU_REAL, MPI_SUM, p->comm));
  PetscCall(PetscArraycpy(force, sum, 3));
  *extent = dim == 2 ? sum[3] : PetscSqrtReal(sum[3]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* share: of each body in the forces of both sides; work. */
static PetscErrorCode Slips_Private(Problem p, const Contact *c, const PetscReal motion[], PetscReal share[], PetscBool *slips)
{
  const PetscInt nb = p->scene->mechanics.num_bodies;
  PetscReal      n[3], extent, length, slip[3] = {0, 0, 0};

  PetscFunctionBegin;
  *slips = PETSC_FALSE;
  PetscCall(Zone_Private(p, c, n, &extent, share));
  length = PetscSqrtReal(Dot3(n, n));
  if (extent == 0 || length == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < 3; ++i) n[i] /= length;
  for (PetscInt k = 0; k < 2; ++k) {
    PetscReal whole = 0;
    for (PetscInt b = 0; b < nb; ++b) whole += share[nb * k + b];
    for (PetscInt b = 0; b < nb; ++b) {
      PetscReal step[3];
      if (share[nb * k + b] == 0) continue;
      if (!Translation_Private(p->dim, motion + MOTION * b, n, step)) PetscFunctionReturn(PETSC_SUCCESS);
      for (PetscInt i = 0; i < 3; ++i) slip[i] += (k ? -1 : 1) * share[nb * k + b] / whole * step[i];
    }
  }
  *slips = (PetscBool)(Dot3(slip, slip) > PetscSqr(SLIPS * extent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemFindSliding(Problem p, uint64_t *pairs)
{
  const PetscInt nb = p->scene->mechanics.num_bodies;
  PetscReal     *motion, *share, pending;
  PetscBool      slides;

  PetscFunctionBegin;
  *pairs = 0;
  if (p->num_contacts == 0 || p->scene->mechanics.kinematics == KINEMATICS_SMALL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemPending(p, &pending));
  if (pending == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(MOTION * nb, &motion, 2 * nb, &share));
  PetscCall(Prescribed_Private(p, motion));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    PetscCall(Slips_Private(p, &p->contacts[i], motion, share, &slides));
    if (slides) *pairs |= (uint64_t)1 << i;
  }
  PetscCall(PetscFree2(motion, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
