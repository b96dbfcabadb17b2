/* Moments of supports and of rigid bodies, from the nodal forces that hold them. Positions are interpolated like displacements, so that these moments are
   exactly what the virtual work of a rigid rotation gives, and balance those of all other forces to round-off. */
#include "mechanicsimpl.h"

/* Position of node n. */
static PetscErrorCode Place_Private(Mechanics m, const HPTables *v, PetscInt n, const PetscReal u[], PetscReal x[3])
{
  const PetscReal *frame;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetFrame(m->space, n, &frame));
  for (PetscInt a = 0; a < 3; ++a) {
    x[a] = v->X[3 * n + a];
    for (PetscInt c = 0; c < m->dim && a < m->dim && m->spec->kinematics == KINEMATICS_FINITE; ++c)
      x[a] += (frame ? frame[3 * c + a] : (PetscReal)(a == c)) * u[n * m->dim + c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* moment += sign (x - point) x f */
static void Add_Private(const PetscReal x[3], const PetscReal point[3], const PetscReal f[3], PetscReal sign, PetscReal moment[3])
{
  const PetscReal arm[3] = {x[0] - point[0], x[1] - point[1], x[2] - point[2]};
  PetscReal       m[3];

  Cross3(arm, f, m);
  for (PetscInt a = 0; a < 3; ++a) moment[a] += sign * m[a];
}

/* Points that moments on rigid bodies are counted about, where they are now. */
static PetscErrorCode Points_Private(Mechanics m, PetscReal (*point)[3])
{
  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->spec->num_bodies; ++b) {
    const BodySpec *body = &m->spec->bodies[b];
    PetscReal       u[3] = {0, 0, 0};
    if (body->material->law->rigid && m->spec->kinematics == KINEMATICS_FINITE) PetscCall(MechanicsBodyMotion(m, b, body->about, u));
    for (PetscInt a = 0; a < 3; ++a) point[b][a] = body->about[a] + u[a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsMoments(Mechanics m, const PetscReal r[], const PetscReal u[], PetscReal support[][3], Resultant body[])
{
  const HPTables *v = HPSpaceGetTables(m->space);
  PetscReal(*point)[3];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(m->spec->num_bodies, &point));
  PetscCall(Points_Private(m, point));
  for (PetscInt b = 0; b < m->spec->num_boundaries; ++b) support[b][0] = support[b][1] = support[b][2] = 0;
  PetscCall(PetscArrayzero(body, m->spec->num_bodies));
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    NodeSupport s;
    PetscReal   x[3], f[3][3];
    if (!m->supports->fixed[n]) continue;
    PetscCall(Place_Private(m, v, n, u, x));
    PetscCall(MechanicsNodeForces_Private(m, n, r, &s, f));
    for (PetscInt k = 0; k < s.num; ++k) {
      const PetscInt cause = s.cause[k], of = -2 - cause;
      if (cause >= 0)
        Add_Private(x, m->spec->boundaries[cause].about, f[k], 1, support[cause]);
      else {
        for (PetscInt a = 0; a < 3; ++a) body[of].force[a] -= f[k][a];
        Add_Private(x, point[of], f[k], -1, body[of].moment);
      }
    }
  }
  PetscCall(PetscFree(point));
  PetscFunctionReturn(PETSC_SUCCESS);
}
