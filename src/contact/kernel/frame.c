/* Friction in space: tangential axes at the nodes of the nonmortar surface that turn with the body, and vectors carried from there to points of the facets.

   Axes. m = d / |d|, d the direction of the rays at the node (direction.c) in one facet that has it, its home; e_1 along c - (c.m) m, c the home's first side,
   or a direction in which a support holds the node; e_2 = m x e_1. What e_1 is does not matter beside m: laws know no direction along the surface.

   Carried. From m to a unit normal n by the smallest rotation, t = Q - a (n + m), a = Q.n / (1 + m.n), so that lengths stay:
     dt = A (dQ - a dm) + B dn,   A = 1 - (n + m) n^T / (1 + m.n),   B = - a 1 - (n + m) (Q - a m)^T / (1 + m.n). */
#include "kernelimpl.h"

/* Homes: the first facet that has the node. Of a node that only hanging ones depend on, on an edge of a coarse cell behind the surface, say, that of the one of
   them that depends on it the most. */
static PetscErrorCode Homes_Private(RayWork w, const ContactSurface *s)
{
  PetscReal *most; /* weight of the node at home */

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(s->num_nodes, &w->home, s->num_nodes, &w->home_xi, s->num_nodes, &w->frame));
  PetscCall(PetscCalloc1(s->num_nodes, &most));
  for (PetscInt n = 0; n < s->num_nodes; n++) w->home[n] = -1;
  for (PetscInt i = 0; i < 2 * s->num_facets; i++) { /* first the nodes of facets, then all that they depend on */
    const PetscBool  own = (PetscBool)(i < s->num_facets);
    const PetscInt   f   = i % s->num_facets;
    const PetscReal *gauss;
    FacetLattice     l;

    ContactFacetLattice(s, f, &l);
    PetscCall(ElementGetNodes(l.order, &gauss));
    for (PetscInt a = 0; a < l.num; a++) {
      const PetscInt  *node = &l.node[a];
      const PetscReal *weight;
      const PetscInt   num = own ? 1 : ContactNodeRow(s, &l.node[a], &node, &weight);

      for (PetscInt k = 0; k < num; k++) {
        const PetscReal share = own ? PETSC_INFINITY : PetscAbsReal(weight[k]);

        if (share <= most[node[k]]) continue;
        most[node[k]]          = share;
        w->home[node[k]]       = f;
        w->home_xi[node[k]][0] = 2 * gauss[a % (l.order + 1)] - 1;
        w->home_xi[node[k]][1] = 2 * gauss[a / (l.order + 1)] - 1;
      }
    }
  }
  PetscCall(PetscFree(most));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Normalise_Private(PetscReal v[3], PetscReal *length)
{
  *length = PetscSqrtReal(Dot3(v, v));
  for (int c = 0; c < 3; c++) v[c] /= *length;
}

static void Axes_Private(NodeFrame *f)
{
  memcpy(f->m, f->d, sizeof(f->m));
  Normalise_Private(f->m, &f->size);
  const PetscReal along = Dot3(f->c, f->m);

  for (int c = 0; c < 3; c++) f->e[0][c] = f->c[c] - along * f->m[c];
  Normalise_Private(f->e[0], &f->across);
  Cross3(f->m, f->e[0], f->e[1]);
}

PetscErrorCode ContactFrames(ContactPair pair, const ContactSurface *s)
{
  RayWork w = pair->ray;

  PetscFunctionBegin;
  if (!w->home) PetscCall(Homes_Private(w, s));
  for (PetscInt n = 0; n < s->num_nodes; n++) {
    const PetscInt   h    = w->home[n];
    const PetscReal *axis = pair->axis ? pair->axis + 3 * n : NULL;
    NodeFrame       *f    = &w->frame[n];
    RayFunctions     V;

    memset(f, 0, sizeof(*f));
    if (h < 0) continue;
    ContactRayFunctions(2, 1, w->home_xi[n], 0, &V);
    for (PetscInt v = 0; v < 4; v++)
      for (int c = 0; c < 3 && V.N[v] != 0; c++) f->d[c] += V.N[v] * w->d[3 * ContactCorner(4, h, v) + c];
    f->given = (PetscBool)(axis && Dot3(axis, axis) > 0);
    for (int c = 0; c < 3; c++) f->c[c] = f->given ? axis[c] : s->x[3 * s->facets[4 * h + 1] + c] - s->x[3 * s->facets[4 * h] + c];
    Axes_Private(f);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactFrameNodes(RayWork w, const ContactSurface *s, PetscInt node, Result *r)
{
  const PetscInt h = w->home[node];
  RayFunctions   V;

  PetscFunctionBegin;
  ContactRayFunctions(2, 1, w->home_xi[node], 0, &V);
  for (PetscInt v = 0; v < 4; v++)
    if (V.N[v] != 0) PetscCall(ContactDirectionNodes(w, s, ContactCorner(4, h, v), r));
  for (PetscInt k = 0; k < 2; k++) PetscCall(ContactResultMasters(r, s, s->facets[4 * h + k])); /* the home's side */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* J[6][nn]: d and c by the nodes of the result. */
static PetscErrorCode Numbers_Private(RayWork w, const ContactSurface *s, PetscInt node, Result *r, PetscInt nn, PetscReal J[])
{
  const PetscInt h = w->home[node];
  RayFunctions   V;

  PetscFunctionBegin;
  ContactRayFunctions(2, 1, w->home_xi[node], 0, &V);
  for (PetscInt v = 0; v < 4; v++)
    if (V.N[v] != 0) PetscCall(ContactDirectionRows(w, s, ContactCorner(4, h, v), V.N[v], r, J));
  for (PetscInt k = 0; k < 2 && !w->frame[node].given; k++) {
    const PetscReal *weight;
    const PetscInt  *master, masters = ContactNodeRow(s, &s->facets[4 * h + k], &master, &weight);
    PetscInt         place;

    for (PetscInt i = 0; i < masters; i++) {
      PetscCall(ContactResultNode(r, master[i], &place));
      for (int c = 0; c < 3; c++) J[(3 + c) * nn + 3 * place + c] += k ? weight[i] : -weight[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Changes of m and e by that of d and c. */
static void Turn_Private(const NodeFrame *f, const PetscReal dd[3], const PetscReal dc[3], PetscReal dm[3], PetscReal de[2][3])
{
  const PetscReal along = Dot3(f->m, dd), cm = Dot3(f->c, f->m);
  PetscReal       du[3], x[3], y[3], slope;

  for (int c = 0; c < 3; c++) dm[c] = (dd[c] - along * f->m[c]) / f->size;
  slope = Dot3(dc, f->m) + Dot3(f->c, dm);
  for (int c = 0; c < 3; c++) du[c] = dc[c] - slope * f->m[c] - cm * dm[c];
  slope = Dot3(f->e[0], du);
  for (int c = 0; c < 3; c++) de[0][c] = (du[c] - slope * f->e[0][c]) / f->across;
  Cross3(dm, f->e[0], x);
  Cross3(f->m, de[0], y);
  for (int c = 0; c < 3; c++) de[1][c] = x[c] + y[c];
}

PetscErrorCode ContactFrameRows(RayWork w, const ContactSurface *s, PetscInt node, Result *r, PetscReal rows[])
{
  const PetscInt nn = 3 * r->num_nodes;
  PetscReal     *J;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(6 * nn, &J));
  PetscCall(Numbers_Private(w, s, node, r, nn, J));
  for (PetscInt i = 0; i < nn; i++) {
    const PetscReal dd[3] = {J[i], J[nn + i], J[2 * nn + i]}, dc[3] = {J[3 * nn + i], J[4 * nn + i], J[5 * nn + i]};
    PetscReal       dm[3] = {0, 0, 0}, de[2][3] = {{0}};

    if (Dot3(dd, dd) + Dot3(dc, dc) > 0) Turn_Private(&w->frame[node], dd, dc, dm, de);
    for (int c = 0; c < 3; c++) rows[c * nn + i] = de[0][c], rows[(3 + c) * nn + i] = de[1][c], rows[(6 + c) * nn + i] = dm[c];
  }
  PetscCall(PetscFree(J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ContactCarry(const PetscReal m[3], const PetscReal n[3], const PetscReal Q[3], PetscReal t[3])
{
  const PetscReal a = Dot3(Q, n) / (1 + Dot3(m, n));

  for (int c = 0; c < 3; c++) t[c] = Q[c] - a * (n[c] + m[c]);
  return a;
}

void ContactCarryRows(const PetscReal m[3], const PetscReal n[3], const PetscReal Q[3], PetscReal A[3][3], PetscReal B[3][3])
{
  const PetscReal over = 1 / (1 + Dot3(m, n)), a = over * Dot3(Q, n);

  for (int c = 0; c < 3; c++)
    for (int e = 0; e < 3; e++) {
      A[c][e] = (c == e) - over * (n[c] + m[c]) * n[e];
      B[c][e] = -a * (c == e) - over * (n[c] + m[c]) * (Q[e] - a * m[e]);
    }
}

PetscErrorCode ContactPairGetTangents(ContactPair pair, PetscInt node, PetscReal e[2][3])
{
  PetscFunctionBegin;
  PetscCheck(pair->ray && pair->ray->home, PETSC_COMM_SELF, PETSC_ERR_ORDER, "tangents are known after an evaluation with friction in space");
  memcpy(e, pair->ray->frame[node].e, sizeof(pair->ray->frame[node].e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairSetAxes(ContactPair pair, const PetscReal axis[])
{
  pair->axis = axis;
}
