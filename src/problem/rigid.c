/* Rigid bodies that forces move (BodySpec.load, load_moment). Their unknowns stand among the scalars (scalar.c): translations d of the body along the
   directions with a load, and L times the rotation vector phi about the body's point C, or its components along the axes with a moment; L: extent of all
   bodies.

     x = C + d + R (X - C),  w = J dphi,  dx = G dq = dd + w x R (X - C)

     R_d = sum r - force,  R_phi = (sum (x - c) x r - moment) / L                                                   (unit of the rows: force)

   r: forces at the body's nodes that hold it. Rows are balances in space: J, singular at full turns, is in the columns only. With one axis rows and columns are
   the same; with more the tangent is unsymmetric, as moments that keep their directions make it anyway. */
#include "problemimpl.h"

PetscErrorCode RigidCreate_Private(Problem p)
{
  const MechanicsSpec *m     = &p->scene->mechanics;
  const HPTables      *v     = p->tables;
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
    for (PetscInt c = 0; c < 3; ++c) l->point[c] = body->about[c];
    for (PetscInt k = 0; k < 6; ++k) {
      const PetscBool there = (PetscBool)(k < 3 ? body->load[k] != NULL : body->load_moment[k - 3] != NULL);
      l->row[k]             = -1;
      if (there) p->rigid[p->num_rigid++] = (RigidUnknown){p->num_links - 1, k, 0, 0, 0};
    }
  }
  if (!p->num_links) PetscFunctionReturn(PETSC_SUCCESS);
  /* a body that nothing holds is held in the first linear solve, like one that deforms; what is glued to it and to a support holds it */
  p->rigid_shift = MECHANICS_SHIFT * young * (p->dim == 3 ? p->extent : 1);
  PetscCall(PetscMalloc1(v->num_nodes, &p->node_link));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    p->node_link[n] = -1;
    for (PetscInt l = 0; l < p->num_links; ++l)
      if (p->supports.rigid[n] == p->links[l].body) p->node_link[n] = (int8_t)l;
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

/* Rotation vector of a body. */
static void Turn_Private(Problem p, PetscInt link, PetscReal phi[3])
{
  phi[0] = phi[1] = phi[2] = 0;
  for (PetscInt k = 0; k < p->num_rigid; ++k)
    if (p->rigid[k].link == link && p->rigid[k].motion >= 3) phi[p->rigid[k].motion - 3] = p->rigid[k].q / p->extent;
}

PetscErrorCode RigidRead_Private(Problem p, const PetscReal q[])
{
  PetscReal d[INTERFACE_LINKS][3] = {{0}};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_rigid; ++k) {
    RigidUnknown *u = &p->rigid[k];
    u->q            = q[k];
    if (u->motion < 3) d[u->link][u->motion] = u->q;
  }
  for (PetscInt i = 0; i < p->num_links; ++i) {
    RigidLink *l = &p->links[i];
    PetscReal  phi[3], J[9];
    Turn_Private(p, i, phi);
    RotationMatrix(phi, l->R);
    RotationSpin(phi, J);
    for (PetscInt k = 0; k < 9; ++k) l->spin[k % 3][k / 3] = J[k] / l->length;
    PetscCall(MechanicsSetFreeMotion(p->mechanics, l->body, d[i], phi));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void RigidMove_Private(Problem p, PetscReal local[])
{
  const HPTables *v = p->tables;

  for (PetscInt n = 0; n < v->num_nodes && p->num_links; ++n) {
    if (p->node_link[n] < 0) continue;
    const RigidLink *l = &p->links[p->node_link[n]];
    for (PetscInt k = 0; k < p->num_rigid; ++k)
      if (p->rigid[k].link == p->node_link[n] && p->rigid[k].motion < 3) local[n * p->dim + p->rigid[k].motion] += p->rigid[k].q;
    for (PetscInt c = 0; c < p->dim; ++c)
      for (PetscInt d = 0; d < p->dim; ++d) local[n * p->dim + c] += (l->R[3 * c + d] - (c == d)) * (v->X[3 * n + d] - l->point[d]);
  }
}

void RigidIncrement_Private(Problem p, const PetscReal dq[], PetscReal local[])
{
  const HPTables *v = p->tables;

  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    for (PetscInt k = 0; k < p->num_rigid && p->node_link[n] >= 0; ++k) {
      PetscReal dx[3];
      if (p->rigid[k].link != p->node_link[n]) continue;
      RigidDerivative(&p->links[p->node_link[n]], p->rigid[k].motion, v->X + 3 * n, p->dim, dx);
      for (PetscInt c = 0; c < p->dim; ++c) local[n * p->dim + c] += dx[c] * dq[k];
    }
  }
}

/* Of node n of a body: (x - c) f^T, added. */
static void Arms_Private(const RigidLink *l, PetscInt dim, const PetscReal X[3], const PetscReal f[], PetscReal arms[9])
{
  for (PetscInt c = 0; c < dim; ++c) {
    PetscReal arm = 0;
    for (PetscInt d = 0; d < dim; ++d) arm += l->R[3 * c + d] * (X[d] - l->point[d]);
    for (PetscInt d = 0; d < dim; ++d) arms[3 * c + d] += arm * f[d];
  }
}

PetscErrorCode RigidMeasure_Private(Problem p, const PetscReal r[])
{
  const HPTables *v                                            = p->tables;
  PetscReal       sum[INTERFACE_MOTIONS + 9 * INTERFACE_LINKS] = {0}; /* of each unknown, then the arms of each body */

  PetscFunctionBegin;
  if (!p->num_rigid) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    if (p->node_link[n] < 0) continue;
    const RigidLink *l = &p->links[p->node_link[n]];
    Arms_Private(l, p->dim, v->X + 3 * n, r + n * p->dim, sum + p->num_rigid + 9 * p->node_link[n]);
    for (PetscInt k = 0; k < p->num_rigid; ++k) {
      PetscReal dx[3];
      if (p->rigid[k].link != p->node_link[n]) continue;
      RigidLever(l, p->rigid[k].motion, v->X + 3 * n, p->dim, dx);
      for (PetscInt c = 0; c < p->dim; ++c) sum[k] += dx[c] * r[n * p->dim + c];
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(p->num_rigid + 9 * p->num_links), MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt k = 0; k < p->num_rigid; ++k) p->rigid[k].force = sum[k];
  PetscCall(PetscArraycpy(&p->rigid_arms[0][0], sum + p->num_rigid, 9 * p->num_links));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RigidSetTime_Private(Problem p)
{
  const PetscReal origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_rigid; ++k) {
    const RigidLink *l    = &p->links[p->rigid[k].link];
    const BodySpec  *body = &p->scene->mechanics.bodies[l->body];
    const PetscInt   m    = p->rigid[k].motion;
    PetscCall(MechanicsValue(m < 3 ? body->load[m] : body->load_moment[m - 3], &body->amplitude, origin, p->t, &p->rigid[k].load));
    if (m >= 3) p->rigid[k].load /= l->length;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal RigidWork_Private(Problem p, const PetscReal r[], const PetscReal dq[])
{
  PetscReal work = 0;

  for (PetscInt k = 0; k < p->num_rigid; ++k) {
    const RigidUnknown *u   = &p->rigid[k];
    PetscReal           way = u->motion < 3 ? dq[k] : 0;
    for (PetscInt j = 0; j < p->num_rigid && u->motion >= 3; ++j) /* along the row's axis in space */
      if (p->rigid[j].link == u->link && p->rigid[j].motion >= 3)
        way += p->links[u->link].length * p->links[u->link].spin[p->rigid[j].motion - 3][u->motion - 3] * dq[j];
    work += r[k] * way;
  }
  return work;
}

/* Rotations i by j of one body: sum of (spin_j x arm) x r along axis i. */
static PetscReal Curvature_Private(Problem p, PetscInt link, PetscInt i, PetscInt j)
{
  const RigidLink *l    = &p->links[link];
  const PetscReal *arms = p->rigid_arms[link], *w = l->spin[j];

  return (Dot3(arms + 3 * i, w) - (arms[0] + arms[4] + arms[8]) * w[i]) / l->length;
}

PetscErrorCode RigidTangent_Private(Problem p)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < p->num_rigid && p->rank == p->size - 1; ++k) {
    const RigidLink *l   = &p->links[p->rigid[k].link];
    const PetscInt   row = l->row[p->rigid[k].motion];
    PetscCall(MatSetValue(p->matrix, row, row, MechanicsIsHeld(p->mechanics, l->body) ? 0 : p->form.proximal * p->rigid_shift, ADD_VALUES));
    for (PetscInt j = 0; j < 3 && p->rigid[k].motion >= 3; ++j) {
      if (l->row[3 + j] < 0) continue;
      PetscCall(MatSetValue(p->matrix, row, l->row[3 + j], Curvature_Private(p, p->rigid[k].link, p->rigid[k].motion - 3, j), ADD_VALUES));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool RigidIsSymmetric_Private(Problem p)
{
  for (PetscInt b = 0; b < p->scene->mechanics.num_bodies; ++b)
    if (BodyNumTurns(&p->scene->mechanics.bodies[b]) > 1) return PETSC_FALSE;
  return PETSC_TRUE;
}
