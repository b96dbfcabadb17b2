/* Overlap that bodies start with, which no load brings about. As long as a share of it counts as none, one surface of the pair is taken to lie further in its
   body, by that share of the deepest overlap along constant directions: as if the body were as much smaller. Gaps and their derivatives are those of two
   surfaces in other places, so contact begins at the deepest place and spreads from there. Of the two sides the one is moved whose facets shrink the least by
   it: a tip, or the inside of a fold, would be turned inside out. The scene asks for it (initial_gap: ramp, a share that falls with time), or a recovery. */
#include "interfaceimpl.h"

/* Into the body, against the normal of a facet at a node of its lattice. */
static void Against_Private(const Surface *s, PetscInt f, const PetscReal xi[2], const PetscReal out[3], PetscReal inward[])
{
  const PetscInt *node, num = SurfaceNodes_Private(s, f, &node);
  PetscReal       N[SURFACE_MOST_NODES], tangent[2][3], n[3];

  SurfaceTangents_Private(s->dim, s->order[f], num, node, s->X, xi, N, tangent);
  Cross3(tangent[0], tangent[1], n);
  const PetscReal size = PetscSqrtReal(Dot3(n, n)), sign = Dot3(n, out) > 0 ? -1 : 1;
  for (PetscInt d = 0; d < s->dim && size > 0; ++d) inward[d] += sign * n[d] / size;
}

/* How nodes move where every facet moves by 1 into the body: m / m.m, m the mean of the vectors -n of the facets there, is such that m.(-n) is 1 in the mean.
   Within planes of symmetry; no further than where the surface turns back on itself, as at the tip of a blade. */
static PetscErrorCode Inward_Private(const Surface *s, PetscReal inward[])
{
  const PetscInt dim = s->dim, planes = dim - 1;
  PetscInt      *count;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(inward, dim * s->num_nodes));
  PetscCall(PetscCalloc1(s->num_nodes, &count));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt  *node, num = SurfaceNodes_Private(s, f, &node), n1 = s->order[f] + 1;
    const PetscReal *gauss;
    PetscReal        out[3] = {0, 0, 0};

    PetscCall(ElementGetNodes(s->order[f], &gauss));
    ContactFacetVector(dim, s->X, s->facets + s->corners * f, out);
    for (PetscInt k = 0; k < num; ++k) {
      const PetscReal xi[2] = {2 * gauss[k % n1] - 1, 2 * gauss[k / n1] - 1};

      Against_Private(s, f, xi, out, inward + dim * node[k]);
      ++count[node[k]];
    }
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    PetscReal *v = inward + dim * n, square = 0;

    for (PetscInt k = 0; k < planes; ++k) {
      const PetscReal *d      = s->mirror + dim * (planes * n + k);
      PetscReal        across = 0;

      for (PetscInt c = 0; c < dim; ++c) across += v[c] * d[c];
      for (PetscInt c = 0; c < dim; ++c) v[c] -= across * d[c];
    }
    for (PetscInt c = 0; c < dim; ++c) square += PetscSqr(v[c] / PetscMax(1, count[n]));
    for (PetscInt c = 0; c < dim; ++c) v[c] /= count[n] * PetscMax(square, CONTACT_SLIVER) + !count[n];
  }
  SurfaceFollow_Private(s, dim, inward);
  PetscCall(PetscFree(count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Move_Private(const Surface *s, PetscReal way, const PetscReal inward[], PetscReal x[])
{
  for (PetscInt i = 0; i < s->dim * s->num_nodes; ++i) x[i] = s->X[i] + way * inward[i];
}

/* What moving all nodes in by this way leaves of the facet that shrinks most; below 0: it is turned over. */
static PetscReal Left_Private(const Surface *s, PetscReal way, const PetscReal inward[], PetscReal x[])
{
  PetscReal least = PETSC_MAX_REAL;

  Move_Private(s, way, inward, x);
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    PetscReal before[3] = {0, 0, 0}, after[3] = {0, 0, 0};
    ContactFacetVector(s->dim, s->X, s->facets + s->corners * f, before);
    ContactFacetVector(s->dim, x, s->facets + s->corners * f, after);
    least = PetscMin(least, Dot3(before, after) / Dot3(before, before));
  }
  return least;
}

/* The side that moves, its directions, for an overlap. */
static PetscErrorCode Choose_Private(Contact *c, PetscReal overlap)
{
  PetscReal left[2];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) {
    const Surface *s = &c->side[k];
    if (!c->inward[k]) PetscCall(PetscMalloc2(s->dim * s->num_nodes, &c->inward[k], s->dim * s->num_nodes, &c->moved[k]));
    PetscCall(Inward_Private(s, c->inward[k]));
    left[k] = Left_Private(s, overlap, c->inward[k], c->moved[k]);
  }
  c->shrinks = left[0] > left[1] ? 0 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The deepest overlap at the nodes, as gaps are at the last evaluation. Collective. */
static PetscErrorCode Deepest_Private(Interface p, const Contact *c, PetscReal *deepest)
{
  PetscFunctionBegin;
  *deepest = 0;
  for (PetscInt k = 0; k < c->side[0].num_own && !c->tie; ++k) {
    const PetscInt j = c->side[0].own[k];
    if (c->has_multiplier[j] && ContactCovered_Private(c, j)) *deepest = PetscMax(*deepest, -c->gap[j] / c->weight[j]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, deepest, 1, MPIU_REAL, MPI_MAX, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Allow_Private(Contact *c)
{
  c->allowance = c->ramp_share * c->ramped + c->overlap_share * c->overlap;
  if (c->allowance > 0) Move_Private(&c->side[c->shrinks], c->allowance, c->inward[c->shrinks], c->moved[c->shrinks]);
}

PetscErrorCode ContactRamp_Private(Interface p, Contact *c)
{
  PetscFunctionBegin;
  PetscCall(Deepest_Private(p, c, &c->ramped));
  if (c->ramped > 0 && p->spec->kinematics != KINEMATICS_SMALL) PetscCall(Choose_Private(c, c->ramped));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactLeaveRamp_Private(Contact *c, PetscReal share)
{
  c->ramp_share = share;
  Allow_Private(c);
}

PetscErrorCode InterfaceNoteOverlap(Interface p, PetscReal *deepest)
{
  PetscFunctionBegin;
  *deepest = 0;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    PetscCall(Deepest_Private(p, c, &c->overlap));
    if (c->overlap > 0 && !(c->ramped > 0)) PetscCall(Choose_Private(c, c->overlap));
    *deepest = PetscMax(*deepest, c->overlap);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceLeaveOverlap(Interface p, PetscReal share)
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    p->contacts[i].overlap_share = share;
    Allow_Private(&p->contacts[i]);
  }
}

const PetscReal *ContactBase_Private(const Contact *c, PetscInt side)
{
  return c->allowance > 0 && side == c->shrinks ? c->moved[side] : c->side[side].X;
}
