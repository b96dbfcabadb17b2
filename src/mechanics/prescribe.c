/* What supports prescribe: displacements of nodes in time, and where two of them disagree. */
#include "mechanicsimpl.h"

#define NEW_DIRECTION 1e-6 /* the part of a direction beyond those before it, as a sine, that makes it one of its own */
#define DISAGREE 1e-6      /* of the larger one: values further apart are not one value with round-off … */
#define NOISE 1e-10        /* … nor, of the extent of the mesh, with that of its coordinates */

PetscErrorCode MechanicsValue(Expression expression, const Amplitude *amplitude, const PetscReal X[3], PetscReal t, PetscReal *value)
{
  PetscFunctionBegin;
  PetscCall(ExpressionEvaluate(expression, X, t, value));
  if (amplitude->num > 0 || !ExpressionUsesTime(expression)) *value *= AmplitudeEvaluate(amplitude, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Displacement of X under a rotation by an angle (degrees) about an axis through a point. */
static void RotationValue_Private(PetscInt axis, const PetscReal point[3], PetscReal degrees, const PetscReal X[3], PetscReal u[3])
{
  const PetscReal angle = degrees * PETSC_PI / 180, cosine = PetscCosReal(angle), sine = PetscSinReal(angle);
  const PetscInt  i = (axis + 1) % 3, j = (axis + 2) % 3;
  const PetscReal ri = X[i] - point[i], rj = X[j] - point[j];

  u[axis] = 0;
  u[i]    = cosine * ri - sine * rj - ri;
  u[j]    = sine * ri + cosine * rj - rj;
}

/* Cartesian displacement that a boundary prescribes at X; unprescribed components 0. A rotation comes first, translations are added. */
static PetscErrorCode BoundaryValue_Private(const BoundarySpec *b, PetscInt dim, const PetscReal X[3], PetscReal t, PetscReal u[3])
{
  PetscFunctionBegin;
  u[0] = u[1] = u[2] = 0;
  if (b->rotation) {
    PetscReal degrees;
    PetscCall(MechanicsValue(b->rotation_angle, &b->amplitude, X, t, &degrees));
    RotationValue_Private(b->rotation_axis, b->rotation_point, degrees, X, u);
  }
  for (PetscInt c = 0; c < dim; ++c) {
    PetscReal value;
    if (!b->displacement[c]) continue;
    PetscCall(MechanicsValue(b->displacement[c], &b->amplitude, X, t, &value));
    u[c] += value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Displacement of the material point at X of a rigid body: a rotation first, then the translation. */
static PetscErrorCode BodyMotion_Private(const BodySpec *body, PetscInt dim, const PetscReal X[3], PetscReal t, PetscReal u[3])
{
  const PetscReal origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  u[0] = u[1] = u[2] = 0;
  if (body->rotation_angle) {
    PetscReal degrees;
    PetscCall(MechanicsValue(body->rotation_angle, &body->amplitude, origin, t, &degrees));
    RotationValue_Private(body->rotation_axis, body->rotation_point, degrees, X, u);
  }
  for (PetscInt c = 0; c < dim; ++c) {
    PetscReal value;
    if (!body->motion[c]) continue;
    PetscCall(MechanicsValue(body->motion[c], &body->amplitude, origin, t, &value));
    u[c] += value;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsBodyMotion(Mechanics m, PetscInt body, const PetscReal X[3], PetscReal u[3])
{
  PetscFunctionBegin;
  u[0] = u[1] = u[2] = 0;
  const BodySpec *b  = &m->spec->bodies[body];
  if (m->t != 0) PetscCall(BodyMotion_Private(b, m->dim, X, m->t, u)); /* all is at rest at t = 0 */
  if (m->free_motion) {
    const PetscReal *free = m->free_motion[body];
    PetscReal        R[9];
    RotationMatrix(free + 3, R);
    for (PetscInt c = 0; c < m->dim; ++c) {
      u[c] += free[c] - (X[c] - b->about[c]);
      for (PetscInt d = 0; d < m->dim; ++d) u[c] += R[3 * c + d] * (X[d] - b->about[d]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSetFreeMotion(Mechanics m, PetscInt body, const PetscReal translation[3], const PetscReal rotation[3])
{
  PetscFunctionBegin;
  if (!m->free_motion) PetscCall(PetscCalloc1(m->spec->num_bodies, &m->free_motion));
  PetscCall(PetscArraycpy(m->free_motion[body], translation, 3));
  PetscCall(PetscArraycpy(m->free_motion[body] + 3, rotation, 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsBodyRotation(Mechanics m, PetscInt body, PetscReal rotation[3])
{
  const PetscReal origin[3] = {0, 0, 0};
  const BodySpec *b         = &m->spec->bodies[body];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < 3; ++c) rotation[c] = m->free_motion ? m->free_motion[body][3 + c] * 180 / PETSC_PI : 0;
  if (b->rotation_angle && m->t != 0) PetscCall(MechanicsValue(b->rotation_angle, &b->amplitude, origin, m->t, &rotation[b->rotation_axis]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- one node --------------------------------------------------------------------------------------------------------------------- */

void MechanicsAsk_Private(PetscInt dim, const PetscReal direction[3], PetscReal value, PetscInt cause, NodeSupport *s)
{
  PetscReal v[3] = {direction[0], direction[1], direction[2]}, rest = value, most = 0;
  PetscInt  with = 0;

  for (PetscInt k = 0; k < s->num; ++k) {
    const PetscReal along = Dot3(v, s->direction[k]);
    for (PetscInt c = 0; c < 3; ++c) v[c] -= along * s->direction[k][c];
    rest -= along * s->value[k];
    if (PetscAbsReal(along) > most) with = k;
    most = PetscMax(most, PetscAbsReal(along));
  }
  const PetscReal length = PetscSqrtReal(Dot3(v, v));
  if (s->num == dim || length < NEW_DIRECTION) {
    if (PetscAbsReal(rest) > PetscAbsReal(s->asked - s->given)) {
      s->rivals[0] = s->cause[with];
      s->rivals[1] = cause;
      s->given     = value - rest;
      s->asked     = value;
      for (PetscInt c = 0; c < 3; ++c) s->along[c] = direction[c];
    }
    return;
  }
  for (PetscInt c = 0; c < 3; ++c) {
    s->direction[s->num][c] = v[c] / length;
    s->wish[s->num][c]      = direction[c];
  }
  s->value[s->num]   = rest / length;
  s->cause[s->num++] = cause;
}

PetscErrorCode MechanicsNodeSupport_Private(const MechanicsSpec *spec, const PetscReal normal[][3], const HPTables *v, const ForestTables *t, PetscInt node,
                                            const PetscReal *time, NodeSupport *s)
{
  const PetscInt   entity = v->node_entity[node];
  const PetscReal *X      = v->X + 3 * node;

  PetscFunctionBegin;
  if (t->parent[entity] >= 0 || !t->boundary[entity]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < spec->num_boundaries; ++i) {
    const BoundarySpec *b    = &spec->boundaries[i];
    PetscReal           u[3] = {0, 0, 0};
    if (!((t->boundary[entity] >> b->group) & 1)) continue;
    if (time) PetscCall(BoundaryValue_Private(b, v->dim, X, *time, u));
    for (PetscInt c = 0; c < v->dim; ++c) {
      PetscReal unit[3] = {0, 0, 0};
      unit[c]           = 1;
      if (b->fix[c] || b->displacement[c] || b->rotation) MechanicsAsk_Private(v->dim, unit, u[c], i, s);
    }
    if (b->fix_normal) MechanicsAsk_Private(v->dim, normal[i], 0, i, s);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The displacement of a node as far as boundaries prescribe it, else 0: what they ask along directions that are not at right angles has to be met by all of
   them together. */
static PetscErrorCode NodeValue_Private(Mechanics m, const HPTables *v, const ForestTables *t, PetscInt node, PetscReal u[3])
{
  NodeSupport s = {0};

  PetscFunctionBegin;
  PetscCall(MechanicsNodeSupport_Private(m->spec, (const PetscReal(*)[3])m->supports->normal, v, t, node, &m->t, &s));
  u[0] = u[1] = u[2] = 0;
  for (PetscInt k = 0; k < s.num; ++k)
    for (PetscInt c = 0; c < 3; ++c) u[c] += s.value[k] * s.direction[k][c];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsPrescribe(Mechanics m, PetscReal local[])
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);

  PetscFunctionBegin;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    const PetscInt   rigid = m->supports->rigid[n];
    const PetscReal *frame;
    PetscReal        u[3];
    if (!m->supports->fixed[n]) continue;
    PetscCall(HPSpaceGetFrame(m->space, n, &frame));
    if (rigid >= 0)
      PetscCall(BodyMotion_Private(&m->spec->bodies[rigid], m->dim, v->X + 3 * n, m->t, u));
    else
      PetscCall(NodeValue_Private(m, v, t, n, u));
    for (PetscInt c = 0; c < m->dim; ++c) {
      if (!((m->supports->fixed[n] >> c) & 1)) continue;
      local[n * m->dim + c] = m->t == 0 ? 0 : frame ? Dot3(frame + 3 * c, u) : u[c]; /* at rest; asked all the same, for values that are not finite */
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- do they agree? ---------------------------------------------------------------------------------------------------------------- */

static void Name_Private(const MechanicsSpec *spec, PetscInt cause, size_t size, char name[])
{
  if (cause <= -2)
    (void)snprintf(name, size, "body.%s.motion", spec->bodies[-2 - cause].name);
  else
    (void)snprintf(name, size, "boundary.%s", spec->boundaries[cause].name);
}

static void Sentence_Private(const MechanicsSpec *spec, const NodeSupport *s, const PetscReal X[3], PetscReal time, size_t size, char words[])
{
  char name[2][MORTISE_NAME + 16], along[64];
  int  axis = -1;

  for (int c = 0; c < 3; ++c) {
    if (PetscAbsReal(s->along[c]) == 1) axis = c;
  }
  for (int k = 0; k < 2; ++k) Name_Private(spec, s->rivals[k], sizeof(name[k]), name[k]);
  if (axis >= 0)
    (void)snprintf(along, sizeof(along), "in %c", 'x' + axis);
  else
    (void)snprintf(along, sizeof(along), "along (%.4g, %.4g, %.4g)", (double)s->along[0], (double)s->along[1], (double)s->along[2]);
  (void)snprintf(words, size, "%s and %s move the point (%g, %g, %g), which both hold, by different displacements %s: %g and %g at t = %g", name[0], name[1],
                 (double)X[0], (double)X[1], (double)X[2], along, (double)s->given, (double)s->asked, (double)time);
}

PetscErrorCode MechanicsFindConflict(Mechanics m, PetscReal time, size_t size, char words[])
{
  PetscReal lo[3], hi[3], extent = 0;

  PetscFunctionBegin;
  words[0]                   = 0;
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);
  const CoarseMesh   *mesh   = ForestGetCoarse(forest);
  ForestCoarseBox(mesh, lo, hi);
  for (PetscInt c = 0; c < m->dim; ++c) extent = PetscMax(extent, hi[c] - lo[c]);
  for (PetscInt n = 0; n < v->num_nodes && !words[0]; ++n) {
    const PetscInt rigid = m->supports->rigid[n];
    NodeSupport    s     = {0};
    PetscReal      u[3];
    if (!m->supports->fixed[n]) continue;
    if (rigid >= 0) PetscCall(BodyMotion_Private(&m->spec->bodies[rigid], m->dim, v->X + 3 * n, time, u));
    for (PetscInt c = 0; c < m->dim && rigid >= 0; ++c) {
      PetscReal unit[3] = {0, 0, 0};
      unit[c]           = 1;
      MechanicsAsk_Private(m->dim, unit, u[c], -2 - rigid, &s);
    }
    PetscCall(MechanicsNodeSupport_Private(m->spec, (const PetscReal(*)[3])m->supports->normal, v, t, n, &time, &s));
    if (PetscAbsReal(s.asked - s.given) > PetscMax(NOISE * extent, DISAGREE * PetscMax(PetscAbsReal(s.asked), PetscAbsReal(s.given))))
      Sentence_Private(m->spec, &s, v->X + 3 * n, time, size, words);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
