/* Rigid bodies that forces move (BodySpec.load, load_moment). Their unknowns stand among the scalars (scalar.c): translations d of the body along the
   directions with a load, and L times the angle theta about one axis through the body's point C, L the extent of all bodies:

     x = C + d + R(theta) (X - C),   dx = G dq,   R_q = G^T r - load,   K_qq += r . d2x/dq2                           (unit of the rows: force)

   r: forces at the body's nodes that hold it. */
#include "problemimpl.h"

#define SHIFT 1e-6 /* of Young's modulus times L^(dim - 2): a body that touches nothing yet is held in the first linear solve, like one that deforms */

PetscErrorCode RigidCreate_Private(Problem p)
{
  const MechanicsSpec *m = &p->scene->mechanics;
  const HPTables      *v;
  PetscReal            young = PETSC_MAX_REAL;

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->num_bodies; ++b) {
    const BodySpec *body = &m->bodies[b];
    if (!body->material->law->rigid) young = PetscMin(young, MaterialYoung(body->material));
    if (!BodyIsLoaded(body)) continue;
    PetscCheckInput(p->num_links < INTERFACE_LINKS, "body.%s.load: more than %d rigid bodies have a load; allowed: at most %d", body->name, INTERFACE_LINKS,
                    INTERFACE_LINKS);
    RigidLink *l = &p->links[p->num_links++];
    l->body      = b;
    l->axis      = BodyTurnAxis(body) >= 0 ? BodyTurnAxis(body) : 2;
    l->cosine    = 1;
    for (PetscInt c = 0; c < 3; ++c) l->point[c] = body->about[c];
    for (PetscInt k = 0; k < 4; ++k) {
      const PetscBool there = (PetscBool)(k < 3 ? body->load[k] != NULL : BodyTurnAxis(body) >= 0);
      l->row[k]             = -1;
      if (there) p->rigid[p->num_rigid++] = (RigidUnknown){p->num_links - 1, k, 0, 0};
    }
  }
  if (!p->num_links) PetscFunctionReturn(PETSC_SUCCESS);
  p->rigid_shift = SHIFT * young * (p->dim == 3 ? p->extent : 1);
  PetscCall(HPSpaceGetTables(p->space, &v));
  PetscCall(PetscMalloc1(v->num_nodes, &p->node_link));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    p->node_link[n] = -1;
    for (PetscInt l = 0; l < p->num_links; ++l)
      if (p->supports.cause[3 * n] == -2 - p->links[l].body) p->node_link[n] = (int8_t)l;
  }
  for (PetscInt l = 0; l < p->num_links; ++l) p->links[l].length = p->extent;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetRows_Private(Problem p, PetscInt first)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_rigid; ++k) p->links[p->rigid[k].link].row[p->rigid[k].motion] = first + k;
  PetscCall(InterfaceSetRigid(p->interface, p->num_links, p->links));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidRead_Private(Problem p, const PetscReal q[])
{
  PetscReal d[INTERFACE_LINKS][3] = {{0}}, angle[INTERFACE_LINKS] = {0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_rigid; ++k) {
    RigidUnknown *u = &p->rigid[k];
    u->q            = q[k];
    if (u->motion < 3)
      d[u->link][u->motion] = u->q;
    else
      angle[u->link] = u->q / p->extent;
  }
  for (PetscInt l = 0; l < p->num_links; ++l) {
    p->links[l].cosine = PetscCosReal(angle[l]);
    p->links[l].sine   = PetscSinReal(angle[l]);
    PetscCall(MechanicsSetFreeMotion(p->mechanics, p->links[l].body, d[l], angle[l] * 180 / PETSC_PI));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidMove_Private(Problem p, PetscReal local[])
{
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  for (PetscInt n = 0; n < v->num_nodes && p->num_links; ++n) {
    if (p->node_link[n] < 0) continue;
    const RigidLink *l = &p->links[p->node_link[n]];
    const PetscInt   i = (l->axis + 1) % 3, j = (l->axis + 2) % 3;
    const PetscReal  ri = v->X[3 * n + i] - l->point[i], rj = v->X[3 * n + j] - l->point[j];
    for (PetscInt k = 0; k < p->num_rigid; ++k)
      if (p->rigid[k].link == p->node_link[n] && p->rigid[k].motion < 3) local[n * p->dim + p->rigid[k].motion] += p->rigid[k].q;
    if (i < p->dim) local[n * p->dim + i] += (l->cosine - 1) * ri - l->sine * rj;
    if (j < p->dim) local[n * p->dim + j] += l->sine * ri + (l->cosine - 1) * rj;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidIncrement_Private(Problem p, const PetscReal dq[], PetscReal local[])
{
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(p->space, &v));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    for (PetscInt k = 0; k < p->num_rigid && p->node_link[n] >= 0; ++k) {
      PetscReal dx[3];
      if (p->rigid[k].link != p->node_link[n]) continue;
      RigidDerivative(&p->links[p->node_link[n]], p->rigid[k].motion, v->X + 3 * n, p->dim, dx);
      for (PetscInt c = 0; c < p->dim; ++c) local[n * p->dim + c] += dx[c] * dq[k];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidMeasure_Private(Problem p, const PetscReal r[])
{
  const HPTables *v;
  PetscReal       sum[5 * INTERFACE_LINKS + 1] = {0}; /* of each unknown, then curvature of each body */

  PetscFunctionBegin;
  if (!p->num_rigid) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HPSpaceGetTables(p->space, &v));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    for (PetscInt k = 0; k < p->num_rigid && p->node_link[n] >= 0; ++k) {
      const RigidLink *l = &p->links[p->node_link[n]];
      PetscReal        dx[3];
      if (p->rigid[k].link != p->node_link[n]) continue;
      RigidDerivative(l, p->rigid[k].motion, v->X + 3 * n, p->dim, dx);
      for (PetscInt c = 0; c < p->dim; ++c) sum[k] += dx[c] * r[n * p->dim + c];
      if (p->rigid[k].motion < 3) continue;
      /* d2x/dtheta2 is the axis times dx/dtheta */
      const PetscInt i = (l->axis + 1) % 3, j = (l->axis + 2) % 3;
      if (i < p->dim) sum[p->num_rigid + p->rigid[k].link] -= dx[j] * r[n * p->dim + i] / l->length;
      if (j < p->dim) sum[p->num_rigid + p->rigid[k].link] += dx[i] * r[n * p->dim + j] / l->length;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(p->num_rigid + p->num_links), MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt k = 0; k < p->num_rigid; ++k) p->rigid[k].force = sum[k];
  for (PetscInt l = 0; l < p->num_links; ++l) p->rigid_curvature[l] = sum[p->num_rigid + l];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidResidual_Private(Problem p, PetscReal r[])
{
  const PetscReal origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_rigid; ++k) {
    const RigidLink *l    = &p->links[p->rigid[k].link];
    const BodySpec  *body = &p->scene->mechanics.bodies[l->body];
    const PetscInt   m    = p->rigid[k].motion;
    PetscReal        load;
    PetscCall(MechanicsValue(m < 3 ? body->load[m] : body->load_moment[l->axis], &body->amplitude, origin, p->t, &load));
    r[k] = p->rigid[k].force - (m < 3 ? load : load / l->length);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidTangent_Private(Problem p)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_rigid && p->rank == p->size - 1; ++k) {
    const RigidLink *l   = &p->links[p->rigid[k].link];
    const PetscInt   row = l->row[p->rigid[k].motion];
    const PetscReal  own = p->form.proximal * p->rigid_shift + (p->rigid[k].motion == 3 ? p->rigid_curvature[p->rigid[k].link] : 0);
    PetscCall(MatSetValue(p->matrix, row, row, own, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
