/* Nodes of the nonmortar side of a contact pair: their measure, extent and scale, and which of them carry a multiplier. */
#include "interfaceimpl.h"

/* Length or area of a facet at the reference positions (axisymmetric: area). */
PetscReal SurfaceFacetMeasure_Private(const Surface *s, PetscInt f, PetscBool axisymmetric)
{
  const PetscInt *node  = s->facets + s->corners * f;
  const PetscReal plain = SurfaceMeasure_Private(s, s->X, f);

  return axisymmetric ? plain * PETSC_PI * (s->X[2 * node[0]] + s->X[2 * node[1]]) : plain;
}

/* Shares of a facet's nodes in its measure (axisymmetric: of revolution) at the reference positions, and in its plain length or area as far as that tells how
   close nodes are. Corners have equal shares of both. On a lattice the first is int N_k, the second that of the trapezoidal rule on as many equal parts: nodes
   at a corner of a Gauss-Lobatto lattice have much less weight than room. */
static PetscErrorCode FacetShares_Private(const Surface *s, PetscInt f, PetscBool axisymmetric, PetscReal share[], PetscReal room[])
{
  const PetscInt  q = s->order[f], *node, num = SurfaceNodes_Private(s, f, &node);
  const PetscReal plain = SurfaceFacetMeasure_Private(s, f, PETSC_FALSE);
  const Basis1D  *gauss;
  PetscReal       N[SURFACE_MOST_NODES];

  PetscFunctionBegin;
  if (!s->higher) {
    const PetscReal whole = SurfaceFacetMeasure_Private(s, f, axisymmetric);
    for (PetscInt k = 0; k < num; ++k) {
      share[k] = whole / (PetscReal)s->corners;
      room[k]  = plain / (PetscReal)s->corners;
    }
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscArrayzero(share, num));
  PetscCall(Basis1DGet(1, q + 2, &gauss));
  for (PetscInt i = 0; i < (s->dim == 2 ? 1 : gauss->num_points) * gauss->num_points; ++i) {
    const PetscInt  a = i % gauss->num_points, b = i / gauss->num_points;
    const PetscReal xi[2]  = {2 * gauss->points[a] - 1, 2 * gauss->points[b] - 1};
    const PetscReal weight = 2 * gauss->weights[a] * (s->dim == 2 ? 1 : 2 * gauss->weights[b]) * SurfacePoint_Private(s, f, s->X, xi, axisymmetric, N);
    for (PetscInt k = 0; k < num; ++k) share[k] += weight * N[k];
  }
  for (PetscInt k = 0; k < num; ++k) {
    const PetscInt i = k % (q + 1), j = k / (q + 1);
    room[k] = plain / (s->dim == 2 ? q : q * q) * (i % q ? 1 : 0.5) * (s->dim == 2 || j % q ? 1 : 0.5);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tributary measure w0, its extent along the surface (an edge's length, the root of a face's area; of higher order: divided by the order), and the constant
   c = E / extent of the complementarity: a pressure per gap, in any model. E of the softer body (a rigid one does not count). */
PetscErrorCode ContactNodeScales_Private(Interface p, Contact *c)
{
  const Surface      *s            = &c->side[0];
  const PetscBool     axisymmetric = (PetscBool)(p->spec->model == MODEL_AXISYMMETRIC);
  const ForestTables *t            = p->tables;
  PetscReal           young        = PETSC_MAX_REAL, share[SURFACE_MOST_NODES], room[SURFACE_MOST_NODES];

  PetscFunctionBegin;
  for (PetscInt side = 0; side < 2; ++side) {
    for (PetscInt e = 0; e < c->side[side].num_facets; ++e) {
      const MaterialSpec *m = p->spec->bodies[t->leaf_body[c->side[side].facet_leaf[e]]].material;
      if (!m->law->rigid) young = PetscMin(young, MaterialYoung(m));
    }
  }
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt *node, num = SurfaceNodes_Private(s, f, &node);
    PetscCall(FacetShares_Private(s, f, axisymmetric, share, room));
    for (PetscInt k = 0; k < num; ++k) {
      const PetscInt n = node[k];
      c->w0[n] += share[k];
      c->extent[n] += room[k];
      for (PetscInt i = s->hang[n]; i < s->hang[n + 1]; ++i) {
        c->w0[s->hang_master[i]] += s->hang_weight[i] * share[k];
        c->extent[s->hang_master[i]] += PetscAbsReal(s->hang_weight[i]) * room[k];
      }
    }
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (p->dim == 3) c->extent[n] = PetscSqrtReal(c->extent[n]);
    c->c[n] = young / c->extent[n];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The corner of a facet in a plane through one of its nodes that is nearest to the node. */
static PetscInt CornerInPlane_Private(const Surface *s, PetscInt n, PetscInt facet, const PetscReal plane[3])
{
  PetscReal least = PETSC_MAX_REAL;
  PetscInt  at    = 0;

  for (PetscInt k = 0; k < s->corners; ++k) {
    PetscReal off = 0, distance2 = 0;

    for (PetscInt c = 0; c < s->dim; ++c) {
      const PetscReal way = s->X[s->dim * s->facets[s->corners * facet + k] + c] - s->X[s->dim * n + c];
      off += plane[c] * way;
      distance2 += PetscSqr(way);
    }
    if (distance2 < least && PetscSqr(off) <= PetscSqr(ROUND_LENGTH) * distance2) least = distance2, at = k;
  }
  return s->corners * facet + at;
}

/* The facet lies in the plane, or goes on into its image without an edge. */
static PetscBool HasImage_Private(const Surface *s, PetscInt n, PetscInt facet, const PetscReal plane[3], const PetscReal N[3])
{
  const ContactSurface at = SurfaceAt_Private(s, s->X);

  if (Dot3(plane, plane) == 0) return PETSC_FALSE;
  if (PetscAbsReal(Dot3(plane, N)) > (1 - ROUND_LENGTH) * PetscSqrtReal(Dot3(N, N))) return PETSC_TRUE;
  return (PetscBool)!ContactImageMakesEdge(&at, CornerInPlane_Private(s, n, facet, plane), plane);
}

/* Mean unit normal of the facets at a node, those between the corners, and of their mirror images in planes of symmetry, with friction where these make no
   edge; reference positions. */
static void NodeNormal_Private(const Surface *s, PetscInt n, PetscBool friction, PetscReal normal[3])
{
  const PetscInt dim = s->dim;
  PetscReal      N[3], length;

  for (PetscInt c = 0; c < 3; ++c) normal[c] = 0;
  for (PetscInt k = s->node_first[n]; k < s->node_first[n + 1]; ++k) {
    ContactFacetVector(s->dim, s->X, s->facets + s->corners * s->node_facet[k], N);
    length = PetscSqrtReal(Dot3(N, N));
    for (PetscInt i = 0; i < dim - 1; ++i) {
      const PetscReal *mirror = s->mirror + dim * ((dim - 1) * n + i), plane[3] = {mirror[0], mirror[1], dim == 3 ? mirror[2] : 0};
      const PetscReal  across = friction && !HasImage_Private(s, n, s->node_facet[k], plane, N) ? 0 : Dot3(N, plane);

      for (PetscInt c = 0; c < 3; ++c) N[c] -= across * plane[c];
    }
    for (PetscInt c = 0; c < 3; ++c) normal[c] += N[c] / length;
  }
  length = PetscSqrtReal(Dot3(normal, normal));
  for (PetscInt c = 0; c < 3 && length > 0; ++c) normal[c] /= length;
}

/* Do supports leave the node no motion in this direction, or a sliver of it? */
static PetscBool IsHeld_Private(const Surface *s, PetscInt n, const PetscReal direction[])
{
  const PetscInt fixed = s->dof[s->dim * n];
  PetscReal      free2 = 0;

  if (fixed == 0) return PETSC_FALSE;
  for (PetscInt d = 0; d < s->dim; ++d) {
    const PetscReal *axis = s->frame + s->dim * (s->dim * n + d);
    PetscReal        sum  = 0;
    for (PetscInt c = 0; c < s->dim; ++c) sum += axis[c] * direction[c];
    if (!((fixed >> d) & 1)) free2 += PetscSqr(sum);
  }
  return (PetscBool)(free2 < PetscSqr(CONTACT_SLIVER));
}

PetscInt ContactHeldAxes_Private(const Surface *s, PetscInt n, PetscReal axis[3])
{
  PetscReal normal[3], across[3], *frame = s->frame + 9 * n;

  NodeNormal_Private(s, n, PETSC_TRUE, normal);
  if (s->dim == 2) {
    axis[0] = -normal[1], axis[1] = normal[0], axis[2] = 0;
    return IsHeld_Private(s, n, axis);
  }
  for (PetscInt k = 0; k < 6; ++k) { /* the directions of supports, and what lies across those of the dofs */
    const PetscReal *d = frame + 3 * (k % 3), along = Dot3(d, normal);
    PetscReal        t[3], length;

    Cross3(normal, d, t);
    for (PetscInt c = 0; c < 3 && k < 3; ++c) t[c] = d[c] - along * normal[c];
    length = PetscSqrtReal(Dot3(t, t));
    if (!(length > CONTACT_SLIVER)) continue;
    for (PetscInt c = 0; c < 3; ++c) axis[c] = t[c] / length;
    if (!IsHeld_Private(s, n, axis)) continue;
    Cross3(normal, axis, across);
    return IsHeld_Private(s, n, across) ? 2 : 1;
  }
  return 0;
}

/* Does a support hold the node in a direction neither along the surface nor across it, and leave it others? Then what it may still do moves it both ways. */
PetscBool ContactHeldObliquely_Private(const Surface *s, PetscInt n)
{
  const PetscInt dim = s->dim, fixed = s->dof[dim * n];
  PetscReal      normal[3];

  if (fixed == 0 || fixed == (1 << dim) - 1) return PETSC_FALSE;
  NodeNormal_Private(s, n, PETSC_TRUE, normal);
  for (PetscInt d = 0; d < dim; ++d) {
    PetscReal across = 0;

    for (PetscInt c = 0; c < dim; ++c) across += s->frame[dim * (dim * n + d) + c] * normal[c];
    if (fixed >> d & 1 && PetscAbsReal(across) > CONTACT_SLIVER && 1 - PetscSqr(across) > PetscSqr(CONTACT_SLIVER)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* On the axis int N_j R dR = 0 from order 2 on, but for what the facet is curved: such a node carries nothing (ContactMultiplierCreate). */
static PetscBool IsWeightless_Private(const Interface p, const Contact *c, PetscInt n, PetscInt facet)
{
  const Surface *s = &c->side[0];

  if (p->spec->model != MODEL_AXISYMMETRIC || s->order[facet] < 2) return PETSC_FALSE;
  return (PetscBool)(PetscAbsReal(s->X[s->dim * n]) <= ROUND_LENGTH * c->extent[n]);
}

PetscBool ContactIsFree_Private(const Interface p, const Contact *c, PetscInt n)
{
  const Surface *s = &c->side[0];

  return (PetscBool)(s->dof[s->dim * n] != (1 << s->dim) - 1 && !IsWeightless_Private(p, c, n, s->node_facet[s->node_first[n]]));
}

/* Of a surface that may meet itself: is the node where two facets meet like the flanks of a notch? The gap is 0 there whatever moves, and has no row. */
static PetscBool IsCrease_Private(const Surface *s, PetscInt n)
{
  for (PetscInt k = s->node_first[n]; k < s->node_first[n + 1]; ++k) {
    for (PetscInt l = s->node_first[n]; l < s->node_first[n + 1]; ++l) {
      const PetscInt f = s->node_facet[k], g = s->node_facet[l];
      PetscReal      N[3], M[3], rise = 0;
      ContactFacetVector(s->dim, s->X, s->facets + s->corners * f, N);
      ContactFacetVector(s->dim, s->X, s->facets + s->corners * g, M);
      for (PetscInt a = 0; a < s->corners; ++a)
        for (PetscInt c = 0; c < s->dim; ++c) rise += N[c] * (s->X[s->dim * s->facets[s->corners * g + a] + c] - s->X[s->dim * n + c]);
      if (rise > 0 && Dot3(N, M) < CONTACT_OPPOSE * PetscSqrtReal(Dot3(N, N) * Dot3(M, M))) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

/* A node that a support holds across the surface carries no multiplier: its constraint would have nothing of its own to act on, and where the nonmortar side is
   finer a row of such nodes leaves no multiplier unique. (Nodes of rigid bodies keep theirs: the other side moves.) Hanging nodes have none: their masters act
   for them. */
void ContactCarriers_Private(Interface p, Contact *c)
{
  const ForestTables *t = p->tables;
  const Surface      *s = &c->side[0];

  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (s->hang[n] < s->hang[n + 1]) continue;
    const PetscInt facet = s->node_facet[s->node_first[n]];
    if (IsWeightless_Private(p, c, n, facet)) continue;
    if (c->spec->self && IsCrease_Private(s, n)) continue;
    const PetscBool rigid = p->spec->bodies[t->leaf_body[s->facet_leaf[facet]]].material->law->rigid;
    PetscReal       normal[3];
    NodeNormal_Private(s, n, c->law->slips, normal);
    c->has_multiplier[n] = (PetscBool)(rigid || !IsHeld_Private(s, n, normal));
  }
}
