/* Contact in the tangent, rows of the multipliers, which change with the active set, and their right-hand sides. Blocks of facets: tangent.c. */
#include "interfaceimpl.h"

/* Room that the row of node j takes. */
static PetscInt RowSize_Private(const Contact *c, PetscInt j)
{
  const Surface *s   = &c->side[0];
  PetscInt       num = c->num;
  for (PetscInt k = s->node_first[j]; k < s->node_first[j + 1]; ++k) num += ContactPatternSize_Private(c, s->node_facet[k]);
  return num;
}

/* values += factor times the gradient of a row of node j that a facet has, g[dim num], at the columns dofs[num]. */
static PetscErrorCode AddGradient_Private(const Contact *c, const ContactFacet *e, const PetscReal g[], PetscReal factor, PetscInt num, const PetscInt dofs[],
                                          PetscReal values[])
{
  const PetscInt dim = c->side[0].dim;
  PetscInt       at;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < e->num; ++a) {
    const Surface *side = &c->side[NODE_SIDE(e->nodes[a])];
    const PetscInt node = NODE_INDEX(e->nodes[a]);
    PetscReal      v[3] = {0, 0, 0};
    for (PetscInt d = 0; d < dim; ++d) v[d] = g[dim * a + d];
    NodeTurn_Private(dim, NodeFrame_Private(c, e->nodes[a]), v, 1);
    for (PetscInt m = 0; m < c->num_q; ++m) {
      PetscReal dx[3];
      if (c->link[NODE_SIDE(e->nodes[a])][node] < 0 || c->links + c->link[NODE_SIDE(e->nodes[a])][node] != c->q_link[m]) continue;
      RigidDerivative(c->q_link[m], c->q_motion[m], side->X + dim * node, dim, dx);
      PetscCall(PetscFindInt(c->q_row[m], num, dofs, &at));
      PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "rigid body outside the pattern of its facet");
      for (PetscInt d = 0; d < dim; ++d) values[at] += factor * v[d] * dx[d];
    }
    for (PetscInt d = 0; d < dim; ++d) {
      if (side->dof[dim * node + d] < 0) continue;
      PetscCall(PetscFindInt(side->dof[dim * node + d], num, dofs, &at));
      PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "contact node outside the pattern of its facet");
      values[at] += factor * v[d];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The place of node j among the rows of a facet, -1: it has none, or no derivatives. */
static PetscInt RowOf_Private(const ContactFacet *e, PetscInt j)
{
  for (PetscInt row = 0; row < e->num_rows && e->dgap; ++row)
    if (e->nodes[row] == j) return row;
  return -1;
}

/* Collects the gradient of a row of node j from its facets: over the whole pattern, sorted indices, so that a switch leaves nothing of another form behind. */
static PetscErrorCode Gradient_Private(Interface p, const Contact *c, PetscInt j, const ContactRow *form, PetscInt *num)
{
  const Surface *s   = &c->side[0];
  const PetscInt dim = p->dim;
  PetscReal     *values, *g;
  PetscInt      *dofs;

  PetscFunctionBegin;
  PetscCall(RowBufferGrow(&p->work, RowSize_Private(c, j)));
  dofs   = p->work.index;
  values = p->work.value;
  *num   = 0;
  for (PetscInt k = s->node_first[j]; k < s->node_first[j + 1] && c->near[j]; ++k)
    if (ContactPatternHas_Private(c, s->node_facet[k], j)) *num += ContactPatternDofs_Private(c, s->node_facet[k], dofs + *num);
  for (PetscInt k = 0; k < c->num; ++k) dofs[(*num)++] = c->zdof[j] + k;
  PetscCall(PetscSortRemoveDupsInt(num, dofs));
  PetscCall(PetscArrayzero(values, *num));
  for (PetscInt k = s->node_first[j]; form->factor != 0 && k < s->node_first[j + 1]; ++k) {
    const ContactFacet *e = ContactResult_Private(c, form->component, s->node_facet[k]);
    const PetscInt      n = e ? dim * e->num : 0, row = e ? RowOf_Private(e, j) : -1;
    if (row < 0) continue;
    const PetscBool  push     = (PetscBool)(form->push && e->push);
    const PetscReal *gradient = (push ? e->push : e->dgap) + row * n, yield = push ? 0 : ContactYield_Private(c, e, row, form->along);
    PetscCall(PetscMalloc1(n, &g));
    for (PetscInt i = 0; i < n; ++i) g[i] = gradient[i] - (e->dweight ? form->mean * e->dweight[row * n + i] : 0) + (yield != 0 ? yield * e->dshare[i] : 0);
    PetscCall(AddGradient_Private(c, e, g, form->factor, *num, dofs, values));
    PetscCall(PetscFree(g));
  }
  for (PetscInt k = s->node_first[j]; c->slip && (form->slip[0] != 0 || form->slip[1] != 0) && k < s->node_first[j + 1]; ++k) {
    const PetscInt facet = s->node_facet[k];
    if (c->slip->result[facet] < 0) continue;
    const ContactFacet *e   = &c->slip->facets[c->slip->result[facet]];
    const PetscInt      row = RowOf_Private(e, j);
    for (PetscInt d = 0; d < dim - 1 && row >= 0; ++d)
      if (form->slip[d] != 0) PetscCall(AddGradient_Private(c, e, e->dgap + (e->num_rows * d + row) * dim * e->num, form->slip[d], *num, dofs, values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* factor S_jl at the columns of the multipliers of others; in the symmetric form of those that bear, whose unknown is z_l over c_l. */
static PetscErrorCode Couplings_Private(const InterfaceSystem *a, const Contact *c, PetscInt j, const ContactRow *form, PetscInt num, const PetscInt dofs[],
                                        PetscReal values[])
{
  const Surface *s = &c->side[0];
  PetscInt       at;

  PetscFunctionBegin;
  for (PetscInt i = s->node_first[j]; form->factor != 0 && i < s->node_first[j + 1]; ++i) {
    PetscInt            row;
    const ContactFacet *e = ContactCompliant_Private(c, form->component, j, i, &row);
    for (PetscInt k = 0; e && k < (c->tie ? c->num : 1) * e->num_rows; ++k) {
      const PetscInt l = e->nodes[k % e->num_rows], m = k / e->num_rows;
      if ((l == j && m == form->component) || c->zdof[l] < 0 || (a->symmetric && !c->active[l])) continue;
      PetscCall(PetscFindInt(c->zdof[l] + m, num, dofs, &at));
      PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "multiplier outside the pattern of its facet");
      values[at] += form->factor * ContactSoft_Private(c, form->component, e, row, k) * (a->symmetric ? c->c[l] : 1);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of a row with friction: compliance at the columns of the tangential tractions, its own too. */
static PetscErrorCode SlipCouplings_Private(const Contact *c, PetscInt j, const ContactRow *row, PetscInt num, const PetscInt dofs[], PetscReal values[])
{
  const Surface *s = &c->side[0];
  const PetscInt m = s->dim - 1;
  PetscInt       at;

  PetscFunctionBegin;
  for (PetscInt i = s->node_first[j]; c->slip && i < s->node_first[j + 1]; ++i) {
    const PetscInt place = c->slip->result[s->node_facet[i]];
    if (place < 0 || !c->slip->facets[place].micro) continue;
    const ContactFacet *e  = &c->slip->facets[place];
    const PetscInt      nr = e->num_rows, own = RowOf_Private(e, j);
    for (PetscInt k = 0; k < m * m * nr && own >= 0; ++k) {
      const PetscInt d = k / (m * nr), column = k % (m * nr), l = e->nodes[column % nr];
      if (row->slip[d] == 0 || c->zdof[l] < 0) continue;
      PetscCall(PetscFindInt(c->zdof[l] + 1 + column / nr, num, dofs, &at));
      PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "traction outside the pattern of its facet");
      values[at] += row->slip[d] * e->micro[(d * nr + own) * m * nr + column];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of node j, in the symmetric form its column as well: that differs from -grad gt_j by gt_j times the change of z_j, small of second order. There z_j =
   c_j times the unknown, and the row is c_j times that: a force by a length, as those of the displacements are, so that one norm over all rows means the same
   in every unit. */
PetscErrorCode ContactInsertRow_Private(Interface p, const InterfaceSystem *a, const Contact *c, PetscInt j, const ContactRow row[])
{
  PetscInt num, at;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->num; ++i) {
    const PetscInt line = c->zdof[j] + i;
    PetscCall(Gradient_Private(p, c, j, &row[i], &num));
    if (i == 0 || c->tie) PetscCall(Couplings_Private(a, c, j, &row[i], num, p->work.index, p->work.value));
    PetscCall(PetscFindInt(c->zdof[j], num, p->work.index, &at));
    for (PetscInt k = 0; k < c->num; ++k) p->work.value[at + k] += a->symmetric ? row[i].z[k] * c->c[j] : row[i].z[k];
    PetscCall(SlipCouplings_Private(c, j, &row[i], num, p->work.index, p->work.value));
    PetscCall(MatSetValues(a->matrix, 1, &line, num, p->work.index, p->work.value, INSERT_VALUES));
    if (a->symmetric) PetscCall(MatSetValues(a->matrix, num, p->work.index, 1, &line, p->work.value, INSERT_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode InsertRow_Private(Interface p, const InterfaceSystem *a, const Contact *c, PetscInt j)
{
  ContactRow row[MOST_MULTIPLIERS];

  PetscFunctionBegin;
  ContactRows_Private(c, j, PETSC_FALSE, a->symmetric, row);
  PetscCall(ContactInsertRow_Private(p, a, c, j, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Symmetric form, inactive: the known change -z_j of the multiplier goes to the forces (share: 1 to put it there, -1 to take it back). */
static PetscErrorCode InactiveShift_Private(Interface p, const InterfaceSystem *a, Contact *c, PetscInt j, PetscReal share, Vec rhs)
{
  const ContactRow forces = {.factor = -share * c->z[j], .mean = c->mean0 ? c->mean0[j] : 0, .push = PETSC_TRUE};
  PetscInt         num, at;

  PetscFunctionBegin;
  if (!a->symmetric || ContactIsReleased_Private(p, c) || c->z[j] == 0 || !c->near[j]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Gradient_Private(p, c, j, &forces, &num));
  PetscCall(PetscFindInt(c->zdof[j], num, p->work.index, &at));
  p->work.value[at] = 0;
  PetscCall(VecSetValues(rhs, num, p->work.index, p->work.value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rhs: of the matrix, which misses the first num_inner of the vector. */
static PetscErrorCode RowSides_Private(Interface p, const InterfaceSystem *a, Vec rhs)
{
  PetscReal *b;

  PetscFunctionBegin;
  PetscCall(VecGetArray(rhs, &b));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      ContactRow row[MOST_MULTIPLIERS];
      if (c->zlocal[j] < 0) continue;
      ContactRows_Private(c, j, PETSC_TRUE, a->symmetric, row);
      if (a->symmetric && c->active[j]) row[0].side -= c->c[j] * ContactIdle_Private(c, j);
      for (PetscInt k = 0; k < c->num; ++k) b[c->zlocal[j] + k - p->num_inner] = row[k].side;
    }
  }
  PetscCall(VecRestoreArray(rhs, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceRightSide(Interface p, const InterfaceSystem *a, Vec rhs)
{
  PetscFunctionBegin;
  PetscCall(RowSides_Private(p, a, rhs));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      if (c->zlocal[j] >= 0 && !c->active[j]) PetscCall(InactiveShift_Private(p, a, c, j, 1, rhs));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceScaleIncrement(Interface p, PetscReal dx[])
{
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      for (PetscInt k = 0; k < c->num && c->zlocal[j] >= 0; ++k) dx[c->zlocal[j] + k] *= c->c[j];
    }
  }
}

PetscErrorCode InterfaceOpenIncrement(Interface p, Vec dx)
{
  PetscReal *d;

  PetscFunctionBegin;
  PetscCall(VecGetArray(dx, &d));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes && !c->tie; ++j) {
      if (c->zlocal[j] < 0 || c->active[j]) continue;
      for (PetscInt k = 0; k < c->num; ++k) d[c->zlocal[j] + k] = -c->z[c->side[0].num_nodes * k + j];
    }
  }
  PetscCall(VecRestoreArray(dx, &d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceInsertRows(Interface p, const InterfaceSystem *a)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      if (c->zlocal[j] >= 0) PetscCall(InsertRow_Private(p, a, c, j));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The law's states of this rank's own nodes, [num_own], for the increment dx of the multipliers, and the points that they are of. */
static PetscErrorCode States_Private(Interface p, const InterfaceSystem *a, Contact *c, const PetscReal dx[], ContactPoint point[], int8_t state[])
{
  Surface        *s         = &c->side[0];
  const PetscBool untouched = FormHas(p->form->untouched, (PetscInt)(c - p->contacts));
  PetscReal       least     = 0;
  PetscReal      *z, *coupled, *slip;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(c->num * s->num_nodes, &z, s->num_nodes, &coupled, c->num * s->num_nodes, &slip));
  PetscCall(PetscArraycpy(z, c->z, c->num * s->num_nodes));
  for (PetscInt k = 0; k < c->num; ++k) {
    for (PetscInt i = 0; i < s->num_own; ++i) z[s->num_nodes * k + s->own[i]] += c->zlocal[s->own[i]] >= 0 ? dx[c->zlocal[s->own[i]] + k] : 0;
    PetscCall(LinkSpread_Private(p, &s->values, 1, z + s->num_nodes * k));
  }
  ContactCoupling_Private(c, z, coupled);
  if (c->slip) SlipCoupling_Private(c, z + s->num_nodes, slip);
  PetscCall(ContactChange_Private(p, c, a->increment, c->change));
  if (c->slip) PetscCall(SlipChange_Private(p, c, c->slip->change));
  if (untouched) PetscCall(ContactLeastOverlap_Private(p, c, &least));
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    state[i]         = c->active[j];
    if (c->zlocal[j] < 0 || !c->near[j] || !ContactCovered_Private(c, j)) continue;
    point[i] = ContactPoint_Private(c, j, PETSC_FALSE);
    for (PetscInt k = 0; k < c->num; ++k) point[i].z[k] += dx[c->zlocal[j] + k];
    point[i].gap += c->change[j] + coupled[j] - c->coupled[j];
    for (PetscInt d = 0; d < p->dim - 1 && c->slip; ++d) {
      const PetscInt at = s->num_nodes * d + j;
      point[i].slip[d] += c->slip->change[at] + slip[at] - c->slip->coupled[at];
    }
    if (untouched && p->form->pressures_first) point[i].friction = 0;
    const int8_t next = c->law->state(&point[i]);
    if (!untouched || !next || c->active[j] || ContactOverlap_Private(c, j) >= least) state[i] = next;
  }
  PetscCall(PetscFree3(z, coupled, slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows that switch are rewritten, [node] of `again`, and those that compliances couple to them. */
static PetscErrorCode Rewrite_Private(Interface p, const InterfaceSystem *a, Contact *c, const int8_t old[], PetscBool again[])
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e        = &c->facets[i];
    PetscBool           switches = PETSC_FALSE;
    for (PetscInt k = 0; k < e->num_rows && e->compliance; ++k) switches = (PetscBool)(switches || c->active[e->nodes[k]] != old[e->nodes[k]]);
    for (PetscInt k = 0; k < e->num_rows && switches; ++k) again[e->nodes[k]] = PETSC_TRUE;
  }
  for (PetscInt i = 0; i < s->num_own; ++i)
    if (again[s->own[i]] && c->zlocal[s->own[i]] >= 0) PetscCall(InsertRow_Private(p, a, c, s->own[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactShareStates_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_own; ++i) c->pack[s->own[i]] = c->active[s->own[i]];
  PetscCall(LinkSpread_Private(p, &s->values, 1, c->pack));
  for (PetscInt i = 0; i < s->values.num; ++i) c->active[s->values.nodes[i]] = (int8_t)c->pack[s->values.nodes[i]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New states of the nodes of one pair, or of node `only` of it (-1: of all): rows are rewritten, force shifts go to rhs. */
static PetscErrorCode Apply_Private(Interface p, const InterfaceSystem *a, Contact *c, const ContactPoint point[], const int8_t state[], PetscInt only, Vec rhs)
{
  const Surface *s = &c->side[0];
  int8_t        *old;
  PetscBool     *again;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_nodes, &old));
  PetscCall(PetscCalloc1(s->num_nodes, &again));
  PetscCall(PetscArraycpy(old, c->active, s->num_nodes));
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    if (state[i] != c->active[j] && (only < 0 || j == only)) {
      again[j] = PETSC_TRUE;
      if (p->dim == 3 && c->slip) c->law->aim(&point[i], c->slip->aim + 3 * j);
      c->active[j] = state[i];
    }
  }
  PetscCall(ContactShareStates_Private(p, c));
  for (PetscInt i = 0; i < s->num_own; ++i)
    if (again[s->own[i]]) PetscCall(InactiveShift_Private(p, a, c, s->own[i], c->active[s->own[i]] ? -1 : 1, rhs));
  PetscCall(Rewrite_Private(p, a, c, old, again));
  PetscCall(PetscFree(old));
  PetscCall(PetscFree(again));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the law says of one pair. */
typedef struct {
  ContactPoint *point; /* [num_own] */
  int8_t       *state; /* [num_own] */
} Verdict;

/* How far a node is from its state, as a force. */
static PetscReal Off_Private(const ContactPoint *p)
{
  return p->weight > 0 ? p->w0 * PetscAbsReal(p->z[0] - p->c * p->gap / p->weight) : 0;
}

/* Verdicts of all pairs; how many nodes disagree with their states, and one of them by the rule, pair << 32 + node, -1: there is none. Of two that are as far
   off the last one. */
static PetscErrorCode Judge_Private(Interface p, const InterfaceSystem *a, Vec dx, SwitchRule rule, Verdict verdict[], PetscInt *disagree, int64_t *one)
{
  const PetscReal *d;
  PetscReal        own = -1, most;

  PetscFunctionBegin;
  *disagree = 0;
  *one      = -1;
  PetscCall(VecGetArrayRead(dx, &d));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact       *c   = &p->contacts[i];
    const PetscInt num = c->side[0].num_own;
    if (ContactIsReleased_Private(p, c) || c->tie) continue;
    PetscCall(PetscMalloc2(num, &verdict[i].point, num, &verdict[i].state));
    PetscCall(States_Private(p, a, c, d, verdict[i].point, verdict[i].state));
    for (PetscInt k = 0; k < num; ++k) {
      const PetscInt j = c->side[0].own[k];
      if (verdict[i].state[k] == c->active[j]) continue;
      const PetscReal off = rule == SWITCH_WORST ? Off_Private(&verdict[i].point[k]) : 0;
      ++*disagree;
      if (off < own) continue;
      own  = off;
      *one = ((int64_t)i << 32) + j;
    }
  }
  PetscCall(VecRestoreArrayRead(dx, &d));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, disagree, 1, MPIU_INT, MPI_SUM, p->comm));
  if (rule == SWITCH_WORST) {
    PetscCallMPI(MPI_Allreduce(&own, &most, 1, MPIU_REAL, MPI_MAX, p->comm));
    if (own < most) *one = -1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, one, 1, MPI_INT64_T, MPI_MAX, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceSwitch(Interface p, const InterfaceSystem *a, Vec dx, SwitchRule rule, Vec rhs, PetscInt *disagree)
{
  const PetscBool single = (PetscBool)(rule != SWITCH_ALL);
  Verdict        *verdict;
  int64_t         one;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(p->num_contacts, &verdict));
  PetscCall(Judge_Private(p, a, dx, rule, verdict, disagree, &one));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    if (*disagree && verdict[i].state && (!single || i == one >> 32))
      PetscCall(Apply_Private(p, a, &p->contacts[i], verdict[i].point, verdict[i].state, single ? (PetscInt)(one & UINT32_MAX) : -1, rhs));
    PetscCall(PetscFree2(verdict[i].point, verdict[i].state));
  }
  PetscCall(PetscFree(verdict));
  if (!*disagree) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecAssemble(rhs));
  PetscCall(RowSides_Private(p, a, rhs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finaliser of splitmix64: well mixed bits. */
static uint64_t Mix_Private(uint64_t x)
{
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/* Sum over the active nodes, which each rank takes its part of. */
PetscErrorCode InterfaceActiveSetHash(Interface p, uint64_t *hash)
{
  PetscFunctionBegin;
  *hash = 0;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      const PetscInt j = c->side[0].own[k];
      if (c->active[j]) *hash += Mix_Private(((uint64_t)c->active[j] << 48) + ((uint64_t)i << 40) + (uint64_t)j);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, hash, 1, MPI_UINT64_T, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
