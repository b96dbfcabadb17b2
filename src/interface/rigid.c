/* Rigid bodies that forces move: the positions of their nodes are functions of a few unknowns q (src/problem/rigid.c), dx = G dq. Their columns in the
   blocks of contact are those of the nodes times G, their rows those of the nodes times levers, facet by facet. */
#include "interfaceimpl.h"

/* Body behind each node of a side, as a place among the links; -1: none of them. */
static PetscErrorCode Bodies_Private(Interface p, const Surface *s, int8_t **link)
{
  const ForestTables *t = p->tables;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_nodes, link));
  for (PetscInt n = 0; n < s->num_nodes; ++n) (*link)[n] = -1;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt *node, num = SurfaceNodes_Private(s, f, &node);
    for (PetscInt l = 0; l < p->num_links; ++l) {
      if (t->leaf_body[s->facet_leaf[f]] != p->links[l].body) continue;
      for (PetscInt k = 0; k < num; ++k) (*link)[node[k]] = (int8_t)l;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of all unknowns of bodies on either side. */
static void Rows_Private(const Interface p, Contact *c)
{
  PetscBool has[INTERFACE_LINKS] = {PETSC_FALSE};

  for (PetscInt k = 0; k < 2; ++k)
    for (PetscInt n = 0; n < c->side[k].num_nodes; ++n)
      if (c->link[k][n] >= 0) has[c->link[k][n]] = PETSC_TRUE;
  c->num_q = 0;
  for (PetscInt l = 0; l < p->num_links; ++l) {
    for (PetscInt m = 0; m < 6 && has[l]; ++m) {
      if (p->links[l].row[m] < 0) continue;
      c->q_row[c->num_q]      = p->links[l].row[m];
      c->q_link[c->num_q]     = &p->links[l];
      c->q_motion[c->num_q++] = m;
    }
  }
}

PetscErrorCode InterfaceSetRigid(Interface p, PetscInt num, const RigidLink links[])
{
  PetscFunctionBegin;
  p->num_links = num;
  p->links     = links;
  for (PetscInt i = 0; i < p->num_contacts && num; ++i) {
    Contact *c = &p->contacts[i];
    c->links   = links;
    for (PetscInt k = 0; k < 2; ++k)
      if (!c->link[k]) PetscCall(Bodies_Private(p, &c->side[k], &c->link[k]));
    Rows_Private(p, c);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* spin x R (X - C) */
static void Turned_Private(const RigidLink *l, const PetscReal spin[3], const PetscReal X[], PetscInt dim, PetscReal dx[3])
{
  PetscReal arm[3] = {0, 0, 0};

  for (PetscInt c = 0; c < 3; ++c)
    for (PetscInt d = 0; d < dim; ++d) arm[c] += l->R[3 * c + d] * (X[d] - l->point[d]);
  Cross3(spin, arm, dx);
}

void RigidDerivative(const RigidLink *l, PetscInt motion, const PetscReal X[], PetscInt dim, PetscReal dx[3])
{
  for (PetscInt c = 0; c < 3; ++c) dx[c] = c == motion;
  if (motion >= 3) Turned_Private(l, l->spin[motion - 3], X, dim, dx);
}

void RigidLever(const RigidLink *l, PetscInt motion, const PetscReal X[], PetscInt dim, PetscReal lever[3])
{
  PetscReal axis[3];

  for (PetscInt c = 0; c < 3; ++c) {
    lever[c] = c == motion;
    axis[c]  = c + 3 == motion ? 1 / l->length : 0;
  }
  if (motion >= 3) Turned_Private(l, axis, X, dim, lever);
}

/* q[num_q] = sum of v[dim num] over the entries of a facet's nodes, each `stride` apart, with the levers of rows or the derivatives of columns. */
static void Gather_Private(const Contact *c, const ContactFacet *e, PetscBool rows, const PetscReal v[], PetscInt stride, PetscReal q[])
{
  const PetscInt dim = c->side[0].dim;

  for (PetscInt m = 0; m < c->num_q; ++m) {
    q[m] = 0;
    for (PetscInt a = 0; a < e->num; ++a) {
      const PetscInt k = NODE_SIDE(e->nodes[a]), n = NODE_INDEX(e->nodes[a]);
      PetscReal      dx[3];
      if (c->link[k][n] < 0 || c->links + c->link[k][n] != c->q_link[m]) continue;
      (rows ? RigidLever : RigidDerivative)(c->q_link[m], c->q_motion[m], c->side[k].X + dim * n, dim, dx);
      for (PetscInt d = 0; d < dim; ++d) q[m] += dx[d] * v[(dim * a + d) * stride];
    }
  }
}

void ContactRigidForces_Private(const Contact *c, const ContactFacet *e, const PetscReal v[], PetscReal q[])
{
  Gather_Private(c, e, PETSC_TRUE, v, 1, q);
}

PetscErrorCode ContactRigidHessian_Private(const InterfaceSystem *a, const Contact *c, const ContactFacet *e, const PetscInt dofs[], const PetscReal H[])
{
  const PetscInt n = c->side[0].dim * e->num, nq = c->num_q;
  PetscReal     *HG, *GH, *GHG;

  PetscFunctionBegin;
  if (!nq) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(n * nq, &HG, n * nq, &GH, nq * nq, &GHG));
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal q[INTERFACE_MOTIONS];
    Gather_Private(c, e, PETSC_FALSE, H + i * n, 1, HG + i * nq);
    Gather_Private(c, e, PETSC_TRUE, H + i, n, q);
    for (PetscInt m = 0; m < nq; ++m) GH[m * n + i] = q[m];
  }
  for (PetscInt m = 0; m < nq; ++m) Gather_Private(c, e, PETSC_FALSE, GH + m * n, 1, GHG + m * nq);
  PetscCall(MatSetValues(a->matrix, n, dofs, nq, c->q_row, HG, ADD_VALUES));
  PetscCall(MatSetValues(a->matrix, nq, c->q_row, n, dofs, GH, ADD_VALUES));
  PetscCall(MatSetValues(a->matrix, nq, c->q_row, nq, c->q_row, GHG, ADD_VALUES));
  PetscCall(PetscFree3(HG, GH, GHG));
  PetscFunctionReturn(PETSC_SUCCESS);
}
