/* Planes of symmetry that a scene does not use: mesh, bodies, supports and loads are their own mirror images, so half of it is enough. */
#include "needsimpl.h"

typedef struct {
  PetscInt  axis, num;
  PetscReal at, size; /* the plane; the mesh's size */
  Place    *place;    /* owned [num], by key */
  PetscInt *image;    /* owned [num] */
  uint64_t  partner[64];
} Mirror;

/* All cells, and all facets of a boundary group. */
static PetscErrorCode Places_Private(Forest forest, Mirror *m)
{
  const ForestTables *t = ForestGetTables(forest);

  PetscFunctionBegin;
  const PetscInt facets = t->first[t->dim] - t->first[t->dim - 1];
  PetscCall(PetscMalloc2(t->num_leaves + facets, &m->place, t->num_leaves + facets, &m->image));
  m->num = 0;
  for (PetscInt e = t->first[t->dim - 1]; e < t->first[t->dim] + t->num_leaves; ++e) {
    const PetscBool cell = (PetscBool)(e >= t->first[t->dim]);
    Place          *p    = &m->place[m->num];
    if (!cell && !t->boundary[e]) continue;
    PetscCall(NeedsMiddle(forest, t, cell ? e - t->first[t->dim] : t->entity_leaf[e], e, p->X));
    p->body   = cell ? t->leaf_body[e - t->first[t->dim]] : -1;
    p->groups = cell ? 0 : t->boundary[e];
    PlaceKey(p, m->axis, &m->at);
    ++m->num;
  }
  PlacesSort(m->num, m->place);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool Image_Private(const Mirror *m, PetscInt i, PetscInt j)
{
  const Place *p = &m->place[i], *q = &m->place[j];

  return (PetscBool)(p->body == q->body && !p->groups == !q->groups && PlaceIs(p, q, m->axis, m->at, -1, m->size));
}

/* The image of each place; none straddles the plane: then the mesh cannot be cut there. */
static PetscBool Images_Private(Mirror *m)
{
  for (PetscInt i = 0, first = 0; i < m->num; ++i) {
    const PetscInt last = PlacesLike(m->num, m->place, i, m->size, &first);
    PetscInt       j    = first;
    while (j < last && !Image_Private(m, i, j)) ++j;
    if (j == last || (j == i && m->place[i].body >= 0)) return PETSC_FALSE;
    m->image[i] = j;
  }
  return PETSC_TRUE;
}

/* Which group is the image of which: each facet's groups must go over into those of its image. */
static PetscBool Partners_Private(Mirror *m, PetscInt num_groups)
{
  for (PetscInt g = 0; g < num_groups; ++g) m->partner[g] = ~UINT64_C(0);
  for (PetscInt i = 0; i < m->num; ++i)
    for (PetscInt g = 0; g < num_groups; ++g)
      if (m->place[i].groups >> g & 1) m->partner[g] &= m->place[m->image[i]].groups;
  for (PetscInt g = 0; g < num_groups; ++g) {
    PetscInt k = m->partner[g] >> g & 1 ? g : 0;
    if (!m->partner[g]) return PETSC_FALSE;
    while (!(m->partner[g] >> k & 1)) ++k;
    m->partner[g] = (uint64_t)k;
  }
  for (PetscInt i = 0; i < m->num; ++i) {
    uint64_t groups = 0;
    for (PetscInt g = 0; g < num_groups; ++g)
      if (m->place[i].groups >> g & 1) groups |= UINT64_C(1) << m->partner[g];
    if (groups != m->place[m->image[i]].groups) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscReal Time_Private(PetscInt k, PetscReal end)
{
  return k ? end : 0.37 * end; /* a load that has been and gone is 0 at the end */
}

/* sign f(X, t) = g(image of X, t), or both are missing? At the facets of a group, at two times. */
static PetscErrorCode Same_Private(const Mirror *m, const BoundarySpec *a, const BoundarySpec *b, Expression f, Expression g, PetscReal sign, PetscReal end,
                                   PetscBool *same)
{
  PetscFunctionBegin;
  if (!f != !g) *same = PETSC_FALSE;
  for (PetscInt i = 0; i < m->num && *same && f; ++i) {
    if (m->place[i].body >= 0 || !(m->place[i].groups >> a->group & 1)) continue;
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscReal t = Time_Private(k, end);
      PetscReal       value[2];
      PetscCall(MechanicsValue(f, &a->amplitude, m->place[i].X, t, &value[0]));
      PetscCall(MechanicsValue(g, &b->amplitude, m->place[m->image[i]].X, t, &value[1]));
      if (!(PetscAbsReal(sign * value[0] - value[1]) <= NEEDS_SAME * (PetscAbsReal(value[0]) + PetscAbsReal(value[1])))) *same = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Boundaries_Private(const Mirror *m, const SceneData *data, PetscBool *same)
{
  const MechanicsSpec *s = &data->mechanics;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_boundaries && *same; ++i) {
    const BoundarySpec *a = &s->boundaries[i], *b = NULL;
    for (PetscInt j = 0; j < s->num_boundaries; ++j)
      if ((uint64_t)s->boundaries[j].group == m->partner[a->group]) b = &s->boundaries[j];
    if (!b || a->rotation || b->rotation || BoundaryIsControlled(a) || a->fix_normal != b->fix_normal) {
      *same = PETSC_FALSE;
      break;
    }
    PetscCall(Same_Private(m, a, b, a->pressure, b->pressure, 1, data->load.end, same));
    for (PetscInt c = 0; c < 3; ++c) {
      const PetscReal sign = c == m->axis ? -1 : 1;
      if (a->fix[c] != b->fix[c]) *same = PETSC_FALSE;
      PetscCall(Same_Private(m, a, b, a->displacement[c], b->displacement[c], sign, data->load.end, same));
      PetscCall(Same_Private(m, a, b, a->traction[c], b->traction[c], sign, data->load.end, same));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* No force or motion of a body across the plane, none that depends on the place, no fibres; sides of pairs are their own images. */
static PetscErrorCode Bodies_Private(const Mirror *m, const SceneData *data, PetscBool *same)
{
  const PetscReal origin[3] = {0, 0, 0};

  PetscFunctionBegin;
  for (PetscInt b = 0; b < data->mechanics.num_bodies; ++b) {
    const BodySpec *s = &data->mechanics.bodies[b];
    if (BodyIsLoaded(s) || s->rotation_angle || s->material->num_fibers) *same = PETSC_FALSE;
    for (PetscInt c = 0; c < 3; ++c)
      if (s->force[c] && ExpressionUsesPlace(s->force[c])) *same = PETSC_FALSE;
    for (PetscInt k = 0; k < 4; ++k) {
      const Expression across = k / 2 ? s->force[m->axis] : s->motion[m->axis];
      PetscReal        value  = 0;
      if (across) PetscCall(MechanicsValue(across, &s->amplitude, origin, Time_Private(k % 2, data->load.end), &value));
      if (value != 0) *same = PETSC_FALSE;
    }
  }
  for (PetscInt i = 0; i < data->num_contacts; ++i)
    if (m->partner[data->contacts[i].nonmortar] != (uint64_t)data->contacts[i].nonmortar ||
        m->partner[data->contacts[i].mortar] != (uint64_t)data->contacts[i].mortar)
      *same = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NeedsFindMirrors(const SceneData *data, Forest forest, PetscBool mirror[3], PetscReal at[3])
{
  const CoarseMesh *mesh = ForestGetCoarse(forest);
  PetscReal         lo[3], hi[3];

  PetscFunctionBegin;
  const PetscReal size = NeedsSize(mesh, lo, hi);
  for (PetscInt axis = 0; axis < 3; ++axis) {
    Mirror m = {.axis = axis, .at = 0.5 * (lo[axis] + hi[axis]), .size = size};

    mirror[axis] = PETSC_FALSE;
    at[axis]     = m.at;
    if (axis >= mesh->dim || (data->mechanics.model == MODEL_AXISYMMETRIC && axis == 0)) continue;
    PetscCall(Places_Private(forest, &m));
    mirror[axis] = (PetscBool)(Images_Private(&m) && Partners_Private(&m, mesh->num_boundaries));
    if (mirror[axis]) PetscCall(Boundaries_Private(&m, data, &mirror[axis]));
    if (mirror[axis]) PetscCall(Bodies_Private(&m, data, &mirror[axis]));
    PetscCall(PetscFree2(m.place, m.image));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
