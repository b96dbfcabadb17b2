/* Supports: which dofs are prescribed, in which frame, and by whom. */
#include "mechanicsimpl.h"

const char *const ModelNames[]      = {"plane_strain", "axisymmetric", "3d", "Model", "MODEL_", NULL};
const char *const KinematicsNames[] = {"finite", "small", "Kinematics", "KINEMATICS_", NULL};

/* Outward normal of a leaf facet from the corners of the part of it that goes up to `part` along each axis (2-D: edge, 3-D: the mean of a bilinear face). */
static PetscErrorCode FacetNormal_Private(Forest forest, const ForestTables *t, PetscInt facet, PetscReal part, PetscReal normal[3])
{
  const PetscInt leaf = t->facet_leaf[2 * (facet - t->first[t->dim - 1])], *cl = t->closure + t->closure_offset[t->first[t->dim] + leaf];
  PetscInt       index = 0, direction = 0;
  PetscReal      corner[4][3], a[3], b[3] = {0, 0, 1};

  PetscFunctionBegin;
  while (cl[index] != facet) ++index;
  PetscInt high = 0;
  for (PetscInt d = 0, j = index; d < t->dim; ++d, j /= 3) {
    if (j % 3 != 1) {
      direction = d;
      high      = j % 3 == 2;
    }
  }
  for (PetscInt k = 0; k < 1 << (t->dim - 1); ++k) {
    PetscReal xi[3] = {0, 0, 0};
    for (PetscInt d = 0, bit = 0; d < t->dim; ++d) xi[d] = d == direction ? high : part * ((k >> bit++) & 1);
    PetscCall(ForestMapPoint(forest, leaf, xi, corner[k]));
  }
  for (PetscInt c = 0; c < 3; ++c) {
    a[c] = t->dim == 2 ? corner[1][c] - corner[0][c] : corner[3][c] - corner[0][c];
    if (t->dim == 3) b[c] = corner[2][c] - corner[1][c];
  }
  const PetscReal sign = (direction == 1 ? -1 : 1) * (high ? 1 : -1);
  Cross3(a, b, normal);
  const PetscReal length = PetscSqrtReal(Dot3(normal, normal));
  for (PetscInt c = 0; c < 3; ++c) normal[c] *= sign / length;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The normal of a flat boundary group; an input error when it is not flat. Replicated: every rank sees all facets. */
static PetscErrorCode GroupNormal_Private(HPSpace space, const BoundarySpec *b, PetscReal normal[3])
{
  const Forest        forest = HPSpaceGetForest(space);
  const ForestTables *t      = ForestGetTables(forest);
  PetscBool           found  = PETSC_FALSE;

  PetscFunctionBegin;
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim]; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - t->first[t->dim - 1]);
    PetscReal       n[3];
    if (!((t->boundary[f] >> b->group) & 1) || leaf[0] < 0 || leaf[1] >= 0 || t->parent[f] >= 0) continue;
    PetscCall(FacetNormal_Private(forest, t, f, 1, n));
    if (!found) PetscCall(PetscArraycpy(normal, n, 3));
    found = PETSC_TRUE;
    PetscCheckInput(Dot3(n, normal) > 1 - 1e-6,
                    "boundary.%s.fix: normal needs a flat face, but the normals of this one turn; split it into flat groups or fix x, y, z", b->name);
  }
  PetscCheckInput(found, "boundary.%s: the group has no facets on the boundary of a body", b->name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a boundary hold its facets along their normals, all of them? Part of a facet tells whether it is curved. */
static PetscErrorCode HoldsNormals_Private(HPSpace space, const BoundarySpec *b, PetscBool *holds)
{
  const Forest        forest = HPSpaceGetForest(space);
  const ForestTables *t      = ForestGetTables(forest);

  PetscFunctionBegin;
  *holds = PETSC_TRUE;
  for (PetscInt f = t->first[t->dim - 1]; f < t->first[t->dim] && *holds && !b->fix_normal; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - t->first[t->dim - 1]);
    PetscReal       n[2][3];
    if (!((t->boundary[f] >> b->group) & 1) || leaf[0] < 0 || leaf[1] >= 0 || t->parent[f] >= 0) continue;
    for (int part = 0; part < 2; ++part) PetscCall(FacetNormal_Private(forest, t, f, part ? 0.3 : 1, n[part]));
    for (PetscInt c = 0; c < t->dim; ++c) {
      const PetscBool held = (PetscBool)(b->displacement[c] || b->fix[c]);
      if (!held && PetscMax(PetscAbsReal(n[0][c]), PetscAbsReal(n[1][c])) > 1e-6) *holds = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A pressure that is found has nothing to find there, one that is given loads the support alone. */
static PetscErrorCode CheckPressure_Private(HPSpace space, const BoundarySpec *b)
{
  PetscBool holds = PETSC_FALSE;

  PetscFunctionBegin;
  if (BoundarySupports(b) && BoundaryHasPressure(b)) PetscCall(HoldsNormals_Private(space, b, &holds));
  PetscCheckInput(!holds || !BoundaryIsControlled(b),
                  "boundary.%s.%s: the same boundary holds its surface along the normal (displacement, fix), so no pressure moves it; take one of them away",
                  b->name, BoundaryPressureKey(b));
  if (holds)
    PetscCall(WarningAdd(ForestComm(HPSpaceGetForest(space)),
                         "boundary.%s.pressure moves nothing: the same boundary holds its surface along the normal, whose reaction has the pressure in it",
                         b->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsUnit_Private(const PetscReal v[3])
{
  PetscInt ones = 0;
  for (PetscInt c = 0; c < 3; ++c) {
    if (PetscAbsReal(PetscAbsReal(v[c]) - 1) < 1e-12)
      ++ones;
    else if (PetscAbsReal(v[c]) > 1e-12)
      return PETSC_FALSE;
  }
  return (PetscBool)(ones == 1);
}

/* Turn the directions of a node into fixed components: axis-aligned ones need no frame. */
static void NodeResult_Private(PetscInt dim, PetscInt node, NodeSupport *s, Supports *out)
{
  PetscBool aligned = PETSC_TRUE;
  for (PetscInt k = 0; k < s->num; ++k) aligned = (PetscBool)(aligned && IsUnit_Private(s->direction[k]));
  for (PetscInt k = 0; k < s->num; ++k) {
    PetscInt c = k;
    if (aligned)
      for (c = 0; PetscAbsReal(s->direction[k][c]) < 0.5;) ++c;
    out->fixed[node] |= (int8_t)(1 << c);
  }
  if (aligned) return;
  const PetscInt given = s->num;
  for (PetscInt c = 0; c < dim; ++c) {
    PetscReal unit[3] = {0, 0, 0};
    unit[c]           = 1;
    MechanicsAsk_Private(dim, unit, 0, -1, s);
  }
  s->num                           = given;
  out->frame_node[out->num_frames] = node;
  for (PetscInt k = 0; k < 3; ++k)
    for (PetscInt c = 0; c < 3; ++c) out->frame[out->num_frames][3 * k + c] = k < dim ? s->direction[k][c] : (PetscReal)(k == c);
  out->num_frames++;
}

/* Nodes of rigid bodies: all components prescribed. */
static PetscErrorCode RigidNodes_Private(const HPTables *v, const ForestTables *t, const MechanicsSpec *spec, Supports *out)
{
  PetscFunctionBegin;
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    const PetscInt body = t->leaf_body[v->cell_leaf[c]];
    if (!spec->bodies[body].material->law->rigid) continue;
    for (PetscInt k = v->cell_row[c]; k < v->cell_row[c + 1]; ++k) {
      const PetscInt n = v->cell_master[k];
      out->fixed[n]    = (int8_t)((1 << v->dim) - 1);
      out->rigid[n]    = body;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSupportsCreate(HPSpace space, const MechanicsSpec *spec, Supports *out)
{
  const HPTables     *v      = HPSpaceGetTables(space);
  const Forest        forest = HPSpaceGetForest(space);
  const ForestTables *t      = ForestGetTables(forest);

  PetscFunctionBegin;
  PetscCall(PetscMemzero(out, sizeof(*out)));
  PetscCall(PetscCalloc1(v->num_nodes, &out->fixed));
  PetscCall(PetscMalloc1(v->num_nodes, &out->rigid));
  PetscCall(PetscMalloc2(v->num_nodes, &out->frame_node, v->num_nodes, &out->frame));
  PetscCall(PetscCalloc1(spec->num_boundaries, &out->normal));
  for (PetscInt n = 0; n < v->num_nodes; ++n) out->rigid[n] = -1;
  for (PetscInt b = 0; b < spec->num_boundaries; ++b) {
    if (spec->boundaries[b].fix_normal) PetscCall(GroupNormal_Private(space, &spec->boundaries[b], out->normal[b]));
    PetscCall(CheckPressure_Private(space, &spec->boundaries[b]));
  }
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    NodeSupport s = {0};
    PetscCall(MechanicsNodeSupport_Private(spec, out->normal, v, t, n, NULL, &s));
    if (s.num) NodeResult_Private(v->dim, n, &s, out);
  }
  PetscCall(RigidNodes_Private(v, t, spec, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsSupportsDestroy(Supports *s)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(s->fixed));
  PetscCall(PetscFree(s->rigid));
  PetscCall(PetscFree2(s->frame_node, s->frame));
  PetscCall(PetscFree(s->normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsNodeForces_Private(Mechanics m, PetscInt n, const PetscReal r[], NodeSupport *s, PetscReal force[3][3])
{
  const HPTables     *v      = HPSpaceGetTables(m->space);
  const Forest        forest = HPSpaceGetForest(m->space);
  const ForestTables *t      = ForestGetTables(forest);
  const PetscReal    *frame;
  PetscReal           rest[3] = {0, 0, 0};

  PetscFunctionBegin;
  *s = (NodeSupport){0};
  PetscCall(HPSpaceGetFrame(m->space, n, &frame));
  for (PetscInt c = 0; c < m->dim; ++c)
    for (PetscInt a = 0; a < m->dim; ++a) rest[a] += (frame ? frame[3 * c + a] : (PetscReal)(a == c)) * r[n * m->dim + c];
  if (m->supports->rigid[n] >= 0) {
    s->num      = 1;
    s->cause[0] = -2 - m->supports->rigid[n];
    PetscCall(PetscArraycpy(force[0], rest, 3));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MechanicsNodeSupport_Private(m->spec, (const PetscReal(*)[3])m->supports->normal, v, t, n, NULL, s));
  for (PetscInt k = s->num - 1; k >= 0; --k) { /* the last alone bears what lies along the last direction */
    const PetscReal size = Dot3(rest, s->direction[k]) / Dot3(s->wish[k], s->direction[k]);
    for (PetscInt a = 0; a < 3; ++a) {
      force[k][a] = size * s->wish[k][a];
      rest[a] -= force[k][a];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MechanicsReactions(Mechanics m, const PetscReal r[], PetscReal reaction[][3])
{
  const HPTables *v = HPSpaceGetTables(m->space);

  PetscFunctionBegin;
  for (PetscInt b = 0; b < m->spec->num_boundaries; ++b) reaction[b][0] = reaction[b][1] = reaction[b][2] = 0;
  for (PetscInt n = 0; n < v->num_nodes; ++n) {
    NodeSupport s;
    PetscReal   force[3][3];
    if (!m->supports->fixed[n]) continue;
    PetscCall(MechanicsNodeForces_Private(m, n, r, &s, force));
    for (PetscInt k = 0; k < s.num && s.cause[0] >= 0; ++k)
      for (PetscInt a = 0; a < 3; ++a) reaction[s.cause[k]][a] += force[k][a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
