/* Contact in the tangent, blocks of facets: Hessians, columns of the multipliers, and the first-order effect of prescribed motion still to come. Rows: rows.c.
 */
#include "interfaceimpl.h"

/* Indices of a facet's nodal dofs (dim*num, -1 where prescribed). */
static void FacetDofs_Private(const Contact *c, const ContactFacet *e, PetscInt dofs[])
{
  const PetscInt dim = c->side[0].dim;
  for (PetscInt a = 0; a < e->num; ++a) {
    const Surface *s = &c->side[NODE_SIDE(e->nodes[a])];
    const PetscInt n = NODE_INDEX(e->nodes[a]);
    for (PetscInt d = 0; d < dim; ++d) dofs[dim * a + d] = s->dof[dim * n + d];
  }
}

/* Nodes of a facet whose frames are not the axes. Returns their number. */
static PetscInt TurnedNodes_Private(const Contact *c, const ContactFacet *e, PetscInt turned[])
{
  const PetscInt dim = c->side[0].dim;
  PetscInt       num = 0;

  for (PetscInt b = 0; b < e->num; ++b) {
    const PetscReal *q     = NodeFrame_Private(c, e->nodes[b]);
    PetscBool        turns = PETSC_FALSE;
    for (PetscInt i = 0; i < dim * dim; ++i) turns = (PetscBool)(turns || q[i] != (i % (dim + 1) == 0));
    if (turns) turned[num++] = b;
  }
  return num;
}

PetscErrorCode ContactFacetHessian_Private(Interface p, const InterfaceSystem *a, const Contact *c, const ContactFacet *e)
{
  const PetscInt dim = p->dim, n = dim * e->num;
  PetscInt      *dofs, *turned, num_turned;
  PetscReal     *H, q[INTERFACE_MOTIONS];

  PetscFunctionBegin;
  PetscCall(RowBufferGrow(&p->work, n + e->num));
  dofs   = p->work.index;
  turned = dofs + n;
  FacetDofs_Private(c, e, dofs);
  num_turned = TurnedNodes_Private(c, e, turned);
  PetscCall(ArrayGrow(n * n, sizeof(PetscReal), &p->hessian_size, &p->hessian));
  H = p->hessian;
  for (PetscInt i = 0; i < n * n; ++i) H[i] = -e->hessian[i];
  if (a->lift) {
    for (PetscInt i = 0; i < n; ++i) {
      p->work.value[i] = 0;
      for (PetscInt b = 0; b < e->num; ++b) {
        const PetscReal *du = c->side[NODE_SIDE(e->nodes[b])].du + dim * NODE_INDEX(e->nodes[b]);
        for (PetscInt d = 0; d < dim; ++d) p->work.value[i] += H[i * n + dim * b + d] * du[d];
      }
    }
    for (PetscInt k = 0; k < num_turned; ++k) NodeTurn_Private(dim, NodeFrame_Private(c, e->nodes[turned[k]]), p->work.value + dim * turned[k], 1);
    PetscCall(VecSetValues(a->lift, n, dofs, p->work.value, ADD_VALUES));
    ContactRigidForces_Private(c, e, p->work.value, q);
    PetscCall(VecSetValues(a->lift, c->num_q, c->q_row, q, ADD_VALUES));
  }
  for (PetscInt k = 0; k < num_turned; ++k) {
    const PetscInt   b    = turned[k];
    const PetscReal *axes = NodeFrame_Private(c, e->nodes[b]);
    for (PetscInt i = 0; i < n; ++i) NodeTurn_Private(dim, axes, H + i * n + dim * b, 1);
  }
  for (PetscInt k = 0; k < num_turned; ++k) {
    const PetscInt   b    = turned[k];
    const PetscReal *axes = NodeFrame_Private(c, e->nodes[b]);
    for (PetscInt j = 0; j < n; ++j) NodeTurn_Private(dim, axes, H + dim * b * n + j, n);
  }
  PetscCall(MatSetValues(a->matrix, n, dofs, n, dofs, H, ADD_VALUES));
  PetscCall(ContactRigidHessian_Private(a, c, e, dofs, H));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A column of the forces in work_value on the facet's nodes, whose dofs are in work_index. */
static PetscErrorCode Column_Private(Interface p, const InterfaceSystem *a, const Contact *c, const ContactFacet *e, PetscInt column)
{
  const PetscInt n = p->dim * e->num;
  PetscReal      q[INTERFACE_MOTIONS];

  PetscFunctionBegin;
  for (PetscInt b = 0; b < e->num; ++b) NodeTurn_Private(p->dim, NodeFrame_Private(c, e->nodes[b]), p->work.value + p->dim * b, 1);
  PetscCall(MatSetValues(a->matrix, n, p->work.index, 1, &column, p->work.value, ADD_VALUES));
  if (!c->num_q) PetscFunctionReturn(PETSC_SUCCESS);
  ContactRigidForces_Private(c, e, p->work.value, q);
  PetscCall(MatSetValues(a->matrix, c->num_q, c->q_row, 1, &column, q, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The factor of the weight's change in a multiplier's column. Exact is 0, and the column differs from the gradient of the node's row by its mean gap times that
   change. Where a pair has borne nothing yet the gaps are those between bodies that do not touch; with such columns active sets do not settle. There the
   column is the gradient, as in the symmetric form (rows.c): the difference vanishes at a solution. */
static PetscReal Mean_Private(const Interface p, const Contact *c, PetscInt j)
{
  if (c->mean0) return c->mean0[j];
  return FormHas(p->form->untouched, (PetscInt)(c - p->contacts)) && ContactCovered_Private(c, j) ? c->gap[j] / c->weight[j] : 0;
}

/* Columns of the multipliers of row k of a facet in contact: the pressure, and with friction the tangential tractions. */
static PetscErrorCode Columns_Private(Interface p, const InterfaceSystem *a, const Contact *c, const ContactFacet *e, PetscInt k)
{
  const PetscInt  n = p->dim * e->num, j = e->nodes[k], z = c->zdof[j];
  const PetscReal mean = Mean_Private(p, c, j), yield = e->push ? 0 : ContactYield_Private(c, e, k, 0);

  PetscFunctionBegin;
  if (z < 0 || !c->near[j]) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < n; ++i) p->work.value[i] = mean * e->dweight[k * n + i] - (e->push ? e->push : e->dgap)[k * n + i];
  for (PetscInt i = 0; i < n && yield != 0; ++i) p->work.value[i] -= yield * e->dshare[i];
  PetscCall(Column_Private(p, a, c, e, z));
  for (PetscInt d = 0; d < p->dim - 1 && e->shear; ++d) {
    for (PetscInt i = 0; i < n; ++i) p->work.value[i] = -e->shear[(e->num_rows * d + k) * n + i];
    PetscCall(Column_Private(p, a, c, e, z + 1 + d));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Blocks_Private of a tied pair. */
static PetscErrorCode TieBlocks_Private(Interface p, const InterfaceSystem *a, Contact *c)
{
  Tie *t = c->tie;

  PetscFunctionBegin;
  if (a->lift)
    PetscCall(TieChange_Private(p, c, a->increment, t->lift));
  else
    PetscCall(PetscArrayzero(t->lift, p->dim * c->side[0].num_nodes));
  for (PetscInt k = 0; k < p->dim; ++k)
    for (PetscInt i = 0; i < t->num_facets[k]; ++i) {
      const ContactFacet *e = &t->facets[k][i].facet;
      if (!c->mine[e->facet]) continue;
      if (t->facets[k][i].hessian) PetscCall(ContactFacetHessian_Private(p, a, c, &t->facets[k][i].bend));
      PetscCall(RowBufferGrow(&p->work, p->dim * e->num));
      FacetDofs_Private(c, e, p->work.index);
      for (PetscInt r = 0; r < e->num_rows && !a->symmetric; ++r) { /* in the symmetric form rows bring them */
        if (!t->carries[c->side[0].num_nodes * k + e->nodes[r]]) continue;
        for (PetscInt l = 0; l < p->dim * e->num; ++l) p->work.value[l] = -e->dgap[r * p->dim * e->num + l];
        PetscCall(Column_Private(p, a, c, e, c->zdof[e->nodes[r]] + k));
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Blocks of the last evaluation: Hessian and columns, added; the rows are inserted afterwards. */
static PetscErrorCode Blocks_Private(Interface p, const InterfaceSystem *a, Contact *c)
{
  const PetscInt dim = p->dim;

  PetscFunctionBegin;
  if (c->tie) {
    PetscCall(TieBlocks_Private(p, a, c));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (ContactIsReleased_Private(p, c)) {
    PetscCall(PetscArrayzero(c->active, c->side[0].num_nodes));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (a->lift)
    PetscCall(ContactChange_Private(p, c, a->increment, c->lift));
  else
    PetscCall(PetscArrayzero(c->lift, c->side[0].num_nodes));
  if (a->lift && c->slip) PetscCall(SlipChange_Private(p, c, c->slip->lift));
  if (!a->lift && c->slip) PetscCall(PetscArrayzero(c->slip->lift, (dim - 1) * c->side[0].num_nodes));
  for (PetscInt f = 0; f < c->num_facets; ++f) {
    const ContactFacet *e = &c->facets[f];
    const PetscInt      n = dim * e->num;
    if (!c->mine[e->facet] || !e->dgap) continue;
    PetscCall(RowBufferGrow(&p->work, n));
    FacetDofs_Private(c, e, p->work.index);
    if (e->hessian) PetscCall(ContactFacetHessian_Private(p, a, c, e));
    for (PetscInt k = 0; k < e->num_rows && !a->symmetric; ++k) PetscCall(Columns_Private(p, a, c, e, k));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceBlocks(Interface p, const InterfaceSystem *a)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(Blocks_Private(p, a, &p->contacts[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
