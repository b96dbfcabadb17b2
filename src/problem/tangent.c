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
static PetscErrorCode CellSink_Private(void *context, PetscInt num, const PetscInt dofs[], const PetscReal K[])
{
  Problem   p          = (Problem)context;
  PetscBool prescribed = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(ProblemWork_Private(p, num));
  for (PetscInt i = 0; i < num; ++i) {
    p->work_index[i] = p->index[dofs[i]];
    if (p->work_index[i] < 0 && p->lifting && p->increment[dofs[i]] != 0) prescribed = PETSC_TRUE;
  }
  PetscCall(MatSetValues(p->matrix, num, p->work_index, num, p->work_index, K, ADD_VALUES));
  if (!prescribed) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < num; ++i) {
    p->work_value[i] = 0;
    for (PetscInt j = 0; j < num; ++j) p->work_value[i] += K[i * num + j] * p->increment[dofs[j]];
  }
  PetscCall(VecSetValues(p->lift, num, p->work_index, p->work_value, ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Indices of an edge's nodal dofs (2*num, -1 where prescribed or absent) and their frames. */
static void EdgeDofs_Private(const Contact *c, const ContactEdge *e, PetscInt dofs[], const PetscReal *frame[])
{
  for (PetscInt a = 0; a < e->num; ++a) {
    const Surface *s = &c->side[NODE_SIDE(e->nodes[a])];
    const PetscInt n = NODE_INDEX(e->nodes[a]);
    dofs[2 * a]      = s->dof[2 * n];
    dofs[2 * a + 1]  = s->dof[2 * n + 1];
    frame[a]         = s->frame + 4 * n;
  }
}

/* Components along the rows of the frame. */
static inline void Turn_Private(const PetscReal *q, PetscReal v[2], PetscInt stride)
{
  if (!q) return;
  const PetscReal a = v[0], b = v[stride];
  v[0]      = q[0] * a + q[1] * b;
  v[stride] = q[2] * a + q[3] * b;
}

static PetscErrorCode EdgeHessian_Private(Problem p, const Contact *c, const ContactEdge *e, const PetscInt dofs[], const PetscReal *frame[])
{
  const PetscInt n = 2 * e->num;
  PetscReal     *H;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(n * n, &H));
  for (PetscInt i = 0; i < n * n; ++i) H[i] = -e->hessian[i];
  if (p->lifting) {
    for (PetscInt i = 0; i < n; ++i) {
      p->work_value[i] = 0;
      for (PetscInt b = 0; b < e->num; ++b) {
        const PetscReal *du = c->side[NODE_SIDE(e->nodes[b])].du + 2 * NODE_INDEX(e->nodes[b]);
        p->work_value[i] += H[i * n + 2 * b] * du[0] + H[i * n + 2 * b + 1] * du[1];
      }
    }
    for (PetscInt a = 0; a < e->num; ++a) Turn_Private(frame[a], p->work_value + 2 * a, 1);
    PetscCall(VecSetValues(p->lift, n, dofs, p->work_value, ADD_VALUES));
  }
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt b = 0; b < e->num; ++b) Turn_Private(frame[b], H + i * n + 2 * b, 1);
  }
  for (PetscInt j = 0; j < n; ++j) {
    for (PetscInt a = 0; a < e->num; ++a) Turn_Private(frame[a], H + 2 * a * n + j, n);
  }
  PetscCall(MatSetValues(p->matrix, n, dofs, n, dofs, H, ADD_VALUES));
  PetscCall(PetscFree(H));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactBlocks_Private(Problem p, Contact *c)
{
  PetscFunctionBegin;
  if (p->lifting)
    PetscCall(ContactChange_Private(p, c, p->increment, c->lift));
  else
    PetscCall(PetscArrayzero(c->lift, c->side[0].num_nodes));
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    const ContactEdge *e = &c->edges[i];
    const PetscInt     n = 2 * e->num;
    const PetscReal  **frame;
    PetscInt          *dofs;
    if (!c->mine[e->edge]) continue;
    PetscCall(ProblemWork_Private(p, n));
    PetscCall(PetscMalloc2(n, &dofs, e->num, &frame));
    EdgeDofs_Private(c, e, dofs, frame);
    if (e->hessian) PetscCall(EdgeHessian_Private(p, c, e, dofs, frame));
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscInt z = c->zdof[e->node[k]];
      if (z < 0) continue;
      for (PetscInt a = 0; a < n; ++a) p->work_value[a] = -e->dgap[k * n + a];
      for (PetscInt a = 0; a < e->num; ++a) Turn_Private(frame[a], p->work_value + 2 * a, 1);
      PetscCall(MatSetValues(p->matrix, n, dofs, 1, &z, p->work_value, ADD_VALUES));
    }
    PetscCall(PetscFree2(dofs, frame));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row of node j from its (at most two) edges: w0 c / w_j (grad gt_j - gt_j/w_j grad w_j) when active, w0 on the diagonal when not.
   The whole pattern is written, so that a switch leaves nothing of the other form behind. */
PetscErrorCode ContactInsertRow_Private(Problem p, Contact *c, PetscInt j)
{
  const Surface *s   = &c->side[0];
  PetscInt       num = 0, *dofs;
  PetscReal     *values;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(2 * MOST_PATTERN_DOFS, &dofs, 2 * MOST_PATTERN_DOFS, &values));
  for (PetscInt k = 0; k < 2; ++k) {
    if (s->node_edge[2 * j + k] >= 0) num += ContactPatternDofs_Private(c, s->node_edge[2 * j + k], dofs + num);
  }
  dofs[num++] = c->zdof[j];
  PetscCall(PetscSortRemoveDupsInt(&num, dofs));
  PetscCall(PetscArrayzero(values, num));
  PetscInt at;
  PetscCall(PetscFindInt(c->zdof[j], num, dofs, &at));
  values[at] = c->active[j] ? 0 : c->w0[j];
  for (PetscInt k = 0; c->active[j] && k < 2; ++k) {
    const PetscInt edge = s->node_edge[2 * j + k];
    if (edge < 0 || c->result[edge] < 0) continue;
    const ContactEdge *e   = &c->edges[c->result[edge]];
    const PetscInt     row = e->node[0] == j ? 0 : 1, n = 2 * e->num;
    const PetscReal    factor = c->w0[j] * c->c[j] / c->weight[j], mean = c->gap[j] / c->weight[j];
    PetscCall(ProblemWork_Private(p, n));
    for (PetscInt a = 0; a < e->num; ++a) {
      const Surface  *side = &c->side[NODE_SIDE(e->nodes[a])];
      const PetscInt  node = NODE_INDEX(e->nodes[a]);
      const PetscReal g[2] = {e->dgap[row * n + 2 * a] - mean * e->dweight[row * n + 2 * a],
                              e->dgap[row * n + 2 * a + 1] - mean * e->dweight[row * n + 2 * a + 1]};
      for (PetscInt d = 0; d < 2; ++d) {
        if (side->dof[2 * node + d] < 0) continue;
        PetscCall(PetscFindInt(side->dof[2 * node + d], num, dofs, &at));
        PetscCheck(at >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "contact node outside the pattern of its edge");
        values[at] += factor * (side->frame[4 * node + 2 * d] * g[0] + side->frame[4 * node + 2 * d + 1] * g[1]);
      }
    }
  }
  PetscCall(MatSetValues(p->matrix, 1, &c->zdof[j], num, dofs, values, INSERT_VALUES));
  PetscCall(PetscFree2(dofs, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of all multipliers of this rank, and the lift of the active ones. */
static PetscErrorCode ContactRowsInsert_Private(Problem p, Contact *c)
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    if (c->zlocal[j] < 0) continue;
    PetscCall(ContactInsertRow_Private(p, c, j));
    if (p->lifting && c->active[j]) PetscCall(VecSetValue(p->lift, c->zdof[j], c->w0[j] * c->c[j] / c->weight[j] * c->lift[j], ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadyMatrix_Private(Problem p)
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemTangent(Problem p, Vec x, const PetscReal pressure[], Vec lift, PetscBool *bad)
{
  PetscReal      *local;
  PetscBool       failed = PETSC_FALSE;
  HPSpace         space  = p->space;
  const HPTables *v;

  PetscFunctionBegin;
  PetscCall(HPSpaceGetTables(space, &v));
  PetscCall(VecGetArray(p->u_local, &local));
  PetscCall(ProblemLocalDisplacement(p, x, local));
  PetscCall(StageBegin(STAGE_CONTACT));
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(ContactEvaluate_Private(p, &p->contacts[i], x, local, PETSC_TRUE, PETSC_TRUE, &failed));
  PetscCall(StageEnd(STAGE_CONTACT));
  p->lifting = (PetscBool)(lift != NULL);
  p->lift    = lift;
  if (lift) PetscCall(VecSetOption(lift, VEC_IGNORE_NEGATIVE_INDICES, PETSC_TRUE));
  for (PetscInt i = 0; i < v->num_nodes * p->dim; ++i) p->increment[i] = p->target[i] - p->applied[i];
  PetscCall(StageBegin(STAGE_ASSEMBLE));
  PetscCall(ReadyMatrix_Private(p));
  PetscCall(MechanicsTangent(p->mechanics, local, pressure, CellSink_Private, p, bad));
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

/* New activity of one pair for the increment dx; rewrites rows that switched. */
static PetscErrorCode ContactSwitch_Private(Problem p, Contact *c, Vec dx, Vec rhs, PetscInt *changed)
{
  const PetscInt   n = c->side[0].num_nodes;
  const PetscReal *d;
  PetscReal       *dz, *b;

  PetscFunctionBegin;
  PetscCall(ContactChange_Private(p, c, p->increment, c->change));
  PetscCall(PetscCalloc1(n, &dz));
  PetscCall(VecGetArrayRead(dx, &d));
  for (PetscInt j = 0; j < n; ++j) {
    if (c->zlocal[j] >= 0) dz[j] = d[c->zlocal[j]];
  }
  PetscCall(VecRestoreArrayRead(dx, &d));
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, dz, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, p->comm));
  PetscCall(VecGetArray(rhs, &b));
  for (PetscInt j = 0; j < n; ++j) {
    if (!c->has_multiplier[j] || c->weight[j] <= 1e-10 * c->w0[j]) continue;
    const PetscBool active = (PetscBool)(c->z[j] + dz[j] - c->c[j] * (c->gap[j] + c->change[j]) / c->weight[j] > 0);
    if (active == c->active[j]) continue;
    c->active[j] = active;
    ++*changed;
    if (c->zlocal[j] < 0) continue;
    PetscCall(ContactInsertRow_Private(p, c, j));
    b[c->zlocal[j]] = -c->w0[j] * (active ? c->c[j] * (c->gap[j] + c->lift[j]) / c->weight[j] : c->z[j]);
  }
  PetscCall(VecRestoreArray(rhs, &b));
  PetscCall(PetscFree(dz));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProblemSwitchActiveSet(Problem p, Vec x, Vec dx, Vec rhs, PetscInt *changed)
{
  PetscFunctionBegin;
  *changed = 0;
  if (!p->num_contacts) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ProblemIncrement_Private(p, dx, 1.0));
  for (PetscInt i = 0; i < p->num_contacts; ++i) PetscCall(ContactSwitch_Private(p, &p->contacts[i], dx, rhs, changed));
  if (*changed) {
    PetscCall(MatAssemblyBegin(p->matrix, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(p->matrix, MAT_FINAL_ASSEMBLY));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
