/* How far did bodies roll on each other in a step? Slip is measured along straight ways (5.9). Where a body rolls, what comes down on the other one goes along
   an arc: by an angle theta in one step, way and slip are wrong by theta^2 / 6 to theta^2 / 3 of the way. */
#include "problemimpl.h"

/* Three (two) edges through the middle of a cell at its corners' positions X + u, e[d][dim]. */
static PetscErrorCode Edges_Private(Problem p, PetscInt cell, const PetscReal u[], PetscReal work[], PetscReal e[3][3])
{
  const HPTables *v   = p->tables;
  const PetscInt  dim = v->dim, order = v->cell_order[cell], n = order + 1, size = ElementNumNodes(dim, order) * dim;
  PetscReal      *X = work, *values = work + size;

  PetscFunctionBegin;
  PetscCall(HPSpaceGatherPositions(p->space, cell, X));
  PetscCall(HPSpaceGather(p->space, cell, u, values));
  PetscCall(PetscArrayzero(e[0], 9));
  for (PetscInt k = 0; k < 1 << dim; ++k) {
    const PetscInt node = order * ((k & 1) + n * (k >> 1 & 1) + n * n * (k >> 2));
    for (PetscInt d = 0; d < dim; ++d)
      for (PetscInt c = 0; c < dim; ++c) e[d][c] += (k >> d & 1 ? 1 : -1) * (X[node * dim + c] + values[node * dim + c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* spread[body][9]: sums over the cells of a body of edges before (rows) times edges after (columns). Of a body in several parts the rotation is their mean. */
static PetscErrorCode Spread_Private(Problem p, const PetscReal from[], const PetscReal now[], PetscReal spread[])
{
  const HPTables     *v = p->tables;
  const ForestTables *t = ForestGetTables(p->forest);
  PetscReal           before[3][3], after[3][3], *work;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(2 * v->dim * ElementNumNodes(v->dim, MORTISE_MAX_ORDER), &work));
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    PetscReal *s = spread + 9 * t->leaf_body[v->cell_leaf[c]];
    PetscCall(Edges_Private(p, c, from, work, before));
    PetscCall(Edges_Private(p, c, now, work, after));
    for (PetscInt d = 0; d < v->dim; ++d)
      for (PetscInt i = 0; i < 9; ++i) s[i] += before[d][i / 3] * after[d][i % 3];
  }
  PetscCall(PetscFree(work));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, spread, (PetscMPIInt)(9 * p->scene->mechanics.num_bodies), MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The angle between two rotations, without their spin about n (in the plane there is none). */
static PetscReal Rolled_Private(PetscInt dim, const PetscReal a[4], const PetscReal b[4], const PetscReal n[3])
{
  PetscReal       turn[3], axis[3];
  const PetscReal w = a[0] * b[0] + Dot3(a + 1, b + 1);

  Cross3(a + 1, b + 1, turn);
  for (PetscInt c = 0; c < 3; ++c) turn[c] = a[0] * b[1 + c] - b[0] * a[1 + c] + turn[c];
  const PetscReal sine = PetscSqrtReal(Dot3(turn, turn)), angle = 2 * atan2(sine, PetscAbsReal(w)), length2 = Dot3(n, n);
  if (!(sine > 0)) return 0;
  for (PetscInt c = 0; c < 3; ++c) axis[c] = turn[c] * angle / sine;
  const PetscReal spin = dim == 3 && length2 > 0 ? Dot3(axis, n) / length2 : 0;
  for (PetscInt c = 0; c < 3; ++c) axis[c] -= spin * n[c];
  return PetscSqrtReal(Dot3(axis, axis));
}

/* has[side][body]: a pair has facets of the body on that side. */
static PetscErrorCode Bodies_Private(Problem p, PetscInt pair, PetscInt num, PetscInt has[])
{
  const ForestTables *t = ForestGetTables(p->forest);
  const ContactView  *v = InterfaceGetContact(p->interface, pair);

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(has, 2 * num));
  for (PetscInt e = 0; e < v->nonmortar.num_facets; ++e) has[t->leaf_body[v->nonmortar.facet_leaf[e]]] = 1;
  for (PetscInt e = 0; e < v->mortar.num_facets; ++e) has[num + t->leaf_body[v->mortar.facet_leaf[e]]] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, (PetscMPIInt)(2 * num), MPIU_INT, MPI_MAX, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pair_Private(Problem p, PetscInt pair, const PetscReal q[], PetscReal *angle)
{
  const PetscInt  num = p->scene->mechanics.num_bodies;
  PetscReal       force[3], moment[3];
  FrictionFigures friction;
  PetscInt       *has;

  PetscFunctionBegin;
  PetscCall(InterfaceFriction(p->interface, pair, &friction));
  if (friction.sticking + friction.slipping == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InterfaceResultant(p->interface, pair, force, moment));
  PetscCall(PetscMalloc1(2 * num, &has));
  PetscCall(Bodies_Private(p, pair, num, has));
  for (PetscInt i = 0; i < num * num; ++i) {
    const PetscInt a = i / num, b = i % num;
    if (a != b && has[a] && has[num + b]) *angle = PetscMax(*angle, Rolled_Private(p->tables->dim, q + 4 * a, q + 4 * b, force));
  }
  PetscCall(PetscFree(has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemRolls(Problem p, const PetscReal from[], Vec x, PetscReal *angle)
{
  const MechanicsSpec *m = &p->scene->mechanics;
  PetscReal           *spread, *q, *now;
  PetscBool            unique;

  PetscFunctionBegin;
  *angle = 0;
  if (m->kinematics == KINEMATICS_SMALL || m->model == MODEL_AXISYMMETRIC || !InterfaceSlips(p->interface)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(9 * m->num_bodies, &spread, 4 * m->num_bodies, &q, p->num_local, &now));
  PetscCall(ProblemLocalDisplacement(p, x, now));
  PetscCall(Spread_Private(p, from, now, spread));
  for (PetscInt b = 0; b < m->num_bodies; ++b) PetscCall(RotationNearest(p->tables->dim, spread + 9 * b, q + 4 * b, &unique));
  for (PetscInt i = 0; i < p->scene->num_contacts; ++i) PetscCall(Pair_Private(p, i, q, angle));
  PetscCall(PetscFree3(spread, q, now));
  PetscFunctionReturn(PETSC_SUCCESS);
}
