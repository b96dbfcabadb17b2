/* Rigid bodies that forces move: the positions of their nodes are functions of a few unknowns q (src/problem/rigid.c), dx = G dq. Their rows and columns in the
   blocks of contact are G^T and G times those of the nodes, facet by facet. */
#include "interfaceimpl.h"

/* Body behind each node of a side, as a place among the links; -1: none of them. */
static PetscErrorCode Bodies_Private(Interface p, const Surface *s, int8_t **link)
{
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(p->forest, &t));
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
    for (PetscInt m = 0; m < 4 && has[l]; ++m) {
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

void RigidDerivative(const RigidLink *l, PetscInt motion, const PetscReal X[], PetscInt dim, PetscReal dx[3])
{
  const PetscInt i = (l->axis + 1) % 3, j = (l->axis + 2) % 3;

  dx[0] = dx[1] = dx[2] = 0;
  if (motion < 3) {
    dx[motion] = 1;
    return;
  }
  const PetscReal ri = (i < dim ? X[i] : 0) - l->point[i], rj = (j < dim ? X[j] : 0) - l->point[j];
  dx[i] = -(l->sine * ri + l->cosine * rj) / l->length;
  dx[j] = (l->cosine * ri - l->sine * rj) / l->length;
}

void ContactRigidForces_Private(const Contact *c, const ContactFacet *e, const PetscReal v[], PetscInt stride, PetscReal q[])
{
  const PetscInt dim = c->side[0].dim;

  for (PetscInt m = 0; m < c->num_q; ++m) {
    q[m] = 0;
    for (PetscInt a = 0; a < e->num; ++a) {
      const PetscInt k = NODE_SIDE(e->nodes[a]), n = NODE_INDEX(e->nodes[a]);
      PetscReal      dx[3];
      if (c->link[k][n] < 0 || c->links + c->link[k][n] != c->q_link[m]) continue;
      RigidDerivative(c->q_link[m], c->q_motion[m], c->side[k].X + dim * n, dim, dx);
      for (PetscInt d = 0; d < dim; ++d) q[m] += dx[d] * v[(dim * a + d) * stride];
    }
  }
}

PetscErrorCode ContactRigidHessian_Private(const InterfaceSystem *a, const Contact *c, const ContactFacet *e, const PetscInt dofs[], const PetscReal H[])
{
  const PetscInt n = c->side[0].dim * e->num, nq = c->num_q;
  PetscReal     *HG, *GH, GHG[4 * INTERFACE_LINKS * 4 * INTERFACE_LINKS];

  PetscFunctionBegin;
  if (!nq) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(n * nq, &HG, n * nq, &GH));
  for (PetscInt i = 0; i < n; ++i) {
    PetscReal q[4 * INTERFACE_LINKS];
    ContactRigidForces_Private(c, e, H + i * n, 1, HG + i * nq);
    ContactRigidForces_Private(c, e, H + i, n, q);
    for (PetscInt m = 0; m < nq; ++m) GH[m * n + i] = q[m];
  }
  for (PetscInt m = 0; m < nq; ++m) ContactRigidForces_Private(c, e, GH + m * n, 1, GHG + m * nq);
  PetscCall(ContactInsert_Private(a->matrix, n, dofs, nq, c->q_row, HG, ADD_VALUES));
  PetscCall(ContactInsert_Private(a->matrix, nq, c->q_row, n, dofs, GH, ADD_VALUES));
  PetscCall(ContactInsert_Private(a->matrix, nq, c->q_row, nq, c->q_row, GHG, ADD_VALUES));
  PetscCall(PetscFree2(HG, GH));
  PetscFunctionReturn(PETSC_SUCCESS);
}
