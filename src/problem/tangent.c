/* The tangent: bulk, contact Hessian, columns and rows of the multipliers, and the first-order effect of prescribed motion still to come. */
#include "problemimpl.h"

PetscErrorCode ProblemWork_Private(Problem p, PetscInt size)
{
  PetscFunctionBegin;
  if (size > p->work_size) {
    p->work_size = 2 * size;
    PetscCall(PetscFree2(p->work_index, p->work_value));
    PetscCall(PetscMalloc2(p->work_size, &p->work_index, p->work_size, &p->work_value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A cell's matrix: free rows and columns to the matrix, columns of prescribed dofs times their motion to the lift. */
PetscErrorCode ProblemCellSink_Private(void *context, PetscInt cell, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  Problem   p          = (Problem)context;
  PetscBool prescribed = PETSC_FALSE, added;

  PetscFunctionBegin;
  PetscCall(ProblemWork_Private(p, num));
  for (PetscInt i = 0; i < num; ++i) {
    p->work_index[i] = p->row[dofs[i]];
    if (p->work_index[i] < 0 && p->lifting && p->increment[dofs[i]] != 0) prescribed = PETSC_TRUE;
  }
  PetscCall(ProblemScatterAdd_Private(p, cell, num, dofs, K, &added));
  if (!added) PetscCall(MatSetValues(p->matrix, num, p->work_index, num, p->work_index, K, ADD_VALUES));
  if (!prescribed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < num; ++i) {
    p->work_value[i] = 0;
    for (PetscInt j = 0; j < num; ++j) p->work_value[i] += K[i * num + j] * p->increment[dofs[j]];
  }
  PetscCall(VecSetValues(p->lift, num, p->work_index, p->work_value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The frame of a facet's node. */
static inline const PetscReal *Frame_Private(const Contact *c, PetscInt id)
{
  const Surface *s = &c->side[NODE_SIDE(id)];
  return s->frame + s->dim * s->dim * NODE_INDEX(id);
}

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

/* Components along the rows of the frame. */
static inline void Turn_Private(PetscInt dim, const PetscReal *q, PetscReal v[], PetscInt stride)
{
  PetscReal t[3];
  for (PetscInt d = 0; d < dim; ++d) {
    t[d] = 0;
    for (PetscInt a = 0; a < dim; ++a) t[d] += q[dim * d + a] * v[a * stride];
  }
  for (PetscInt d = 0; d < dim; ++d) v[d * stride] = t[d];
}

static PetscErrorCode FacetHessian_Private(Problem p, const Contact *c, const ContactFacet *e, const PetscInt dofs[])
{
  const PetscInt dim = p->dim, n = dim * e->num;
  PetscReal     *H;

  PetscFunctionBegin;
  if (n * n > p->hessian_size) {
    p->hessian_size = 2 * n * n;
    PetscCall(PetscFree(p->hessian));
    PetscCall(PetscMalloc1(p->hessian_size, &p->hessian));
  }
  H = p->hessian;
  for (PetscInt i = 0; i < n * n; ++i) H[i] = -e->hessian[i];
  if (p->lifting) {
    for (PetscInt i = 0; i < n; ++i) {
      p->work_value[i] = 0;
      for (PetscInt b = 0; b < e->num; ++b) {
        const PetscReal *du = c->side[NODE_SIDE(e->nodes[b])].du + dim * NODE_INDEX(e->nodes[b]);
        for (PetscInt d = 0; d < dim; ++d) p->work_value[i] += H[i * n + dim * b + d] * du[d];
      }
    }
    for (PetscInt a = 0; a < e->num; ++a) Turn_Private(dim, Frame_Private(c, e->nodes[a]), p->work_value + dim * a, 1);
    PetscCall(VecSetValues(p->lift, n, dofs, p->work_value, ADD_VALUES));
  }
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt b = 0; b < e->num; ++b) Turn_Private(dim, Frame_Private(c, e->nodes[b]), H + i * n + dim * b, 1);
  }
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt a = 0; a < e->num; ++a) Turn_Private(dim, Frame_Private(c, e->nodes[a]), H + dim * a * n + j, n);
  }
  PetscCall(ProblemInsert_Private(p, n, dofs, n, dofs, H, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactHessians_Private(Problem p, const Contact *c)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e = &c->facets[i];
    if (!c->mine[e->facet] || !e->hessian) continue;
    PetscCall(ProblemWork_Private(p, p->dim * e->num));
    FacetDofs_Private(c, e, p->work_index);
    PetscCall(FacetHessian_Private(p, c, e, p->work_index));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Blocks of the last evaluation: Hessian and columns, added; the rows are inserted afterwards. */
static PetscErrorCode ContactBlocks_Private(Problem p, Contact *c)
{
  const PetscInt dim = p->dim;

  PetscFunctionBegin;
  if (ContactIsReleased_Private(p, c)) {
    PetscCall(PetscArrayzero(c->active, c->side[0].num_nodes));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (p->lifting)
    PetscCall(ContactChange_Private(p, c, p->increment, c->lift));
  else
    PetscCall(PetscArrayzero(c->lift, c->side[0].num_nodes));
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e = &c->facets[i];
    const PetscInt      n = dim * e->num;
    if (!c->mine[e->facet] || !e->dgap) continue;
    PetscCall(ProblemWork_Private(p, n));
    FacetDofs_Private(c, e, p->work_index);
    if (e->hessian) PetscCall(FacetHessian_Private(p, c, e, p->work_index));
    for (PetscInt k = 0; k < e->num_rows && !p->symmetric; ++k) {
      const PetscInt z = c->zdof[e->nodes[k]];
      if (z < 0 || !c->near[e->nodes[k]]) continue;
      PetscReal mean, along;
      ContactRowFactors_Private(c, e, k, PETSC_FALSE, &mean, &along);
      for (PetscInt a = 0; a < n; ++a) p->work_value[a] = (e->push ? -e->push[k * n + a] : -e->dgap[k * n + a]) + mean * e->dweight[k * n + a];
      for (PetscInt a = 0; a < e->num; ++a) Turn_Private(dim, Frame_Private(c, e->nodes[a]), p->work_value + dim * a, 1);
      PetscCall(ProblemInsert_Private(p, n, p->work_index, 1, &z, p->work_value, ADD_VALUES));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room that the row of node j takes. */
static PetscInt RowSize_Private(const Contact *c, PetscInt j)
{
  const Surface *s   = &c->side[0];
  PetscInt       num = 1;
  for (PetscInt k = s->node_first[j]; k < s->node_first[j + 1]; ++k) num += ContactPatternSize_Private(c, s->node_facet[k]);
  return num;
}

/* Collects the gradient of node j's normalised gap, times a factor, from its facets, in work_index and work_value: over the whole pattern, sorted indices, so
   that a switch leaves nothing of another form behind. normalised false: the plain derivative of the forces by z_j. */
PetscErrorCode ContactNodeGradient_Private(Problem p, const Contact *c, PetscInt j, PetscReal factor, PetscBool normalised, PetscInt *num)
{
  const Surface *s   = &c->side[0];
  const PetscInt dim = p->dim;
  PetscReal      mean, along, *values;
  PetscInt       at, *dofs;

  PetscFunctionBegin;
  PetscCall(ProblemWork_Private(p, RowSize_Private(c, j)));
  dofs   = p->work_index;
  values = p->work_value;
  *num   = 0;
  for (PetscInt k = s->node_first[j]; k < s->node_first[j + 1] && c->near[j]; ++k) *num += ContactPatternDofs_Private(c, s->node_facet[k], dofs + *num);
  dofs[(*num)++] = c->zdof[j];
  PetscCall(PetscSortRemoveDupsInt(num, dofs));
  PetscCall(PetscArrayzero(values, *num));
  for (PetscInt k = s->node_first[j]; factor != 0 && k < s->node_first[j + 1]; ++k) {
    const PetscInt facet = s->node_facet[k];
    if (c->result[facet] < 0) continue;
    const ContactFacet *e   = &c->facets[c->result[facet]];
    const PetscInt      n   = dim * e->num;
    PetscInt            row = 0;
    while (row < e->num_rows && e->nodes[row] != j) ++row;
    if (row == e->num_rows || !e->dgap) continue;
    const PetscReal *gradient = (!normalised && e->push ? e->push : e->dgap) + row * n;
    ContactRowFactors_Private(c, e, row, normalised, &mean, &along);
    for (PetscInt a = 0; a < e->num; ++a) {
      const Surface *side = &c->side[NODE_SIDE(e->nodes[a])];
      const PetscInt node = NODE_INDEX(e->nodes[a]);
      PetscReal      g[3] = {0, 0, 0};
      for (PetscInt d = 0; d < dim; ++d)
        g[d] = gradient[dim * a + d] - mean * e->dweight[row * n + dim * a + d] + (along != 0 ? along * e->darea[dim * a + d] : 0);
      Turn_Private(dim, Frame_Private(c, e->nodes[a]), g, 1);
      for (PetscInt d = 0; d < dim; ++d) {
        if (side->dof[dim * node + d] < 0) continue;
        PetscCall(PetscFindInt(side->dof[dim * node + d], *num, dofs, &at));
        PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "contact node outside the pattern of its facet");
        values[at] += factor * g[d];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row of node j. Exact form: w0 c / w_j (grad gt_j - gt_j/w_j grad w_j) when active, w0 on the diagonal when not. Symmetric form: minus the normalised gradient
   as row *and* column when active, -w0/c on the diagonal when not; its column differs from -grad gt_j by gt_j times the change of z_j, small of second order.
   There z_j = c_j times the unknown, and the row is c_j times that: a force by a length, as those of the displacements are, so that one norm over all rows
   means the same in every unit. */
static PetscErrorCode ContactInsertRow_Private(Problem p, Contact *c, PetscInt j)
{
  const PetscReal active = p->symmetric ? -c->c[j] : c->active[j] ? c->w0[j] * c->c[j] / ContactRowMeasure_Private(c, j) : 0;
  PetscInt        num, at;

  PetscFunctionBegin;
  PetscCall(ContactNodeGradient_Private(p, c, j, c->active[j] ? active : 0, PETSC_TRUE, &num));
  PetscCall(PetscFindInt(c->zdof[j], num, p->work_index, &at));
  p->work_value[at] = c->active[j] ? active * c->spring[j] : p->symmetric ? -c->w0[j] : c->w0[j];
  if (p->symmetric) p->work_value[at] *= c->c[j];
  PetscCall(ProblemInsert_Private(p, 1, &c->zdof[j], num, p->work_index, p->work_value, INSERT_VALUES));
  if (p->symmetric) PetscCall(ProblemInsert_Private(p, num, p->work_index, 1, &c->zdof[j], p->work_value, INSERT_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Right-hand side of multiplier row j in the form of its row. Symmetric form, inactive: the known change -z_j of the multiplier goes to the forces
   (share: 1 to put it there, -1 to take it back). */
static PetscErrorCode RowSide_Private(Problem p, const Contact *c, PetscInt j, PetscReal *value)
{
  PetscFunctionBegin;
  if (!p->symmetric)
    *value = -c->w0[j] * (c->active[j] ? c->c[j] * (ContactRowGap_Private(c, j) + c->lift[j]) / ContactRowMeasure_Private(c, j) : c->z[j]);
  else
    *value = c->active[j] ? c->c[j] * (ContactRowGap_Private(c, j) + c->lift[j]) : c->w0[j] * c->z[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode InactiveShift_Private(Problem p, Contact *c, PetscInt j, PetscReal share, Vec rhs)
{
  PetscInt num, at;

  PetscFunctionBegin;
  if (!p->symmetric || ContactIsReleased_Private(p, c) || c->z[j] == 0 || !c->near[j]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactNodeGradient_Private(p, c, j, -share * c->z[j], PETSC_FALSE, &num));
  PetscCall(PetscFindInt(c->zdof[j], num, p->work_index, &at));
  p->work_value[at] = 0;
  PetscCall(VecSetValues(rhs, num, p->work_index, p->work_value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* rhs: of the matrix, which misses the first num_inner of the vector. */
static PetscErrorCode RowSides_Private(Problem p, Vec rhs)
{
  PetscReal *b;

  PetscFunctionBegin;
  PetscCall(VecGetArray(rhs, &b));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      if (c->zlocal[j] >= 0) PetscCall(RowSide_Private(p, c, j, &b[c->zlocal[j] - p->num_inner]));
    }
  }
  PetscCall(VecRestoreArray(rhs, &b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemRightSide(Problem p, Vec r, Vec lift, Vec rhs)
{
  PetscFunctionBegin;
  PetscCall(ProblemReduce_Private(p, r, rhs));
  PetscCall(VecAXPY(rhs, 1.0, lift));
  PetscCall(VecScale(rhs, -1.0));
  PetscCall(PressureSides_Private(p, rhs));
  PetscCall(RowSides_Private(p, rhs));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      if (c->zlocal[j] >= 0 && !c->active[j]) PetscCall(InactiveShift_Private(p, c, j, 1, rhs));
    }
  }
  PetscCall(VecAssemblyBegin(rhs));
  PetscCall(VecAssemblyEnd(rhs));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactScaleIncrement_Private(Problem p, PetscReal dx[])
{
  for (PetscInt i = 0; i < p->num_contacts && p->symmetric; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      if (c->zlocal[j] >= 0) dx[c->zlocal[j]] *= c->c[j];
    }
  }
}

/* Rows of all multipliers of this rank. */
static PetscErrorCode ContactRowsInsert_Private(Problem p, Contact *c)
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    if (c->zlocal[j] >= 0) PetscCall(ContactInsertRow_Private(p, c, j));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The matrix with room for all of contact, zero. */
PetscErrorCode ProblemReadyMatrix_Private(Problem p)
{
  int ok = p->matrix ? 1 : 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    if (!ContactPatternHolds_Private(&p->contacts[i])) {
      PetscCall(ContactGrowPattern_Private(&p->contacts[i]));
      ok = 0;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &ok, 1, MPI_INT, MPI_MIN, p->comm));
  if (!ok)
    PetscCall(ProblemMatrix_Private(p));
  else
    PetscCall(MatZeroEntries(p->matrix));
  PetscCall(ProblemScatter_Private(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemTangent(Problem p, Vec x, const PetscReal pressure[], Vec lift, PetscBool *bad)
{
  PetscReal      *local;
  PetscBool       failed = PETSC_FALSE, holds = PETSC_FALSE;
  HPSpace         space = p->space;
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(space, &v));
  PetscCall(VecGetArray(p->u_local, &local));
  PetscCall(ProblemLocalDisplacement(p, x, local));
  PetscCall(StageBegin(STAGE_CONTACT));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    PetscCall(ContactPairHold(c->pair, FormHas(p->form.frozen_normals, i)));
    PetscCall(ContactEvaluate_Private(p, c, x, local, PETSC_TRUE, PETSC_TRUE, &failed));
    PetscCall(ContactPairHold(c->pair, PETSC_FALSE));
  }
  if (p->form.symmetric) PetscCall(ContactHoldsRims_Private(p, &holds));
  p->symmetric = (PetscBool)(p->form.symmetric && !holds);
  PetscCall(StageEnd(STAGE_CONTACT));
  p->lifting = (PetscBool)(lift != NULL);
  p->lift    = lift;
  if (lift) PetscCall(VecSetOption(lift, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) p->increment[i] = p->target[i] - p->applied[i];
  PetscCall(StageBegin(STAGE_ASSEMBLE));
  PetscCall(ProblemReadyMatrix_Private(p));
  PetscCall(MechanicsTangent(p->mechanics, local, pressure, ProblemCellSink_Private, p, bad));
  if (!*bad) PetscCall(PressureBlocks_Private(p));
  PetscCall(ScalarsTangent_Private(p, local));
  PetscCall(StageEnd(STAGE_ASSEMBLE));
  PetscCall(VecRestoreArray(p->u_local, &local));
  PetscCall(StageBegin(STAGE_CONTACT));
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(ContactBlocks_Private(p, &p->contacts[i]));
  if (p->num_contacts) {
    PetscCall(MatAssemblyBegin(p->matrix, MAT_FLUSH_ASSEMBLY));
    PetscCall(MatAssemblyEnd(p->matrix, MAT_FLUSH_ASSEMBLY));
    for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(ContactRowsInsert_Private(p, &p->contacts[i]));
  }
  PetscCall(StageEnd(STAGE_CONTACT));
  PetscCall(MatAssemblyBegin(p->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(p->matrix, MAT_FINAL_ASSEMBLY));
  if (lift) {
    PetscCall(VecAssemblyBegin(lift));
    PetscCall(VecAssemblyEnd(lift));
  }
  p->lifting = PETSC_FALSE;
  p->lift    = NULL;
  int any    = *bad || failed;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, p->comm));
  *bad = (PetscBool)any;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New activity of this rank's nodes of one pair for the increment dx: rows that switch are rewritten, multiplier right-hand sides go to b, force shifts to rhs.
   dx: this rank's part of the increment; num grows by the switches. */
static PetscErrorCode ContactSwitch_Private(Problem p, Contact *c, const PetscReal dx[], Vec rhs, PetscInt *num)
{
  const Surface *s     = &c->side[0];
  PetscReal      least = 0;

  PetscFunctionBegin;
  if (ContactIsReleased_Private(p, c)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactChange_Private(p, c, p->increment, c->change));
  if (FormHas(p->form.deepest_first, (PetscInt)(c - p->contacts))) PetscCall(ContactLeastOverlap_Private(p, c, &least));
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    if (c->zlocal[j] < 0 || !c->near[j] || !ContactCovered_Private(c, j)) continue;
    const PetscReal pushed = c->z[j] + dx[c->zlocal[j]] - c->c[j] * (c->gap[j] + c->change[j]) / c->weight[j];
    const PetscBool active = (PetscBool)(pushed > 0);
    if (active == c->active[j] || (active && ContactOverlap_Private(c, j) < least)) continue;
    c->active[j] = active;
    ++*num;
    PetscCall(ContactInsertRow_Private(p, c, j));
    PetscCall(InactiveShift_Private(p, c, j, active ? -1 : 1, rhs));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSwitchActiveSet(Problem p, Vec dx, Vec rhs, PetscInt *changed)
{
  const PetscReal *d;

  PetscFunctionBegin;
  *changed = 0;
  if (!p->num_contacts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  PetscCall(VecGetArrayRead(dx, &d));
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(ContactSwitch_Private(p, &p->contacts[i], d, rhs, changed));
  PetscCall(VecRestoreArrayRead(dx, &d));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, changed, 1, MPIU_INT, MPI_SUM, p->comm));
  if (*changed) {
    PetscCall(VecAssemblyBegin(rhs));
    PetscCall(VecAssemblyEnd(rhs));
    PetscCall(RowSides_Private(p, rhs));
    PetscCall(MatAssemblyBegin(p->matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(p->matrix, MAT_FINAL_ASSEMBLY));
  }
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
PetscErrorCode ProblemActiveSetHash(Problem p, uint64_t *hash)
{
  PetscFunctionBegin;
  *hash = 0;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt k = 0; k < c->side[0].num_own; ++k) {
      if (c->active[c->side[0].own[k]]) *hash += Mix_Private(((uint64_t)i << 40) + (uint64_t)c->side[0].own[k]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, hash, 1, MPI_UINT64_T, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
