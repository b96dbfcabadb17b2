/* Between a cell and the true dofs it depends on: values to the cell, residuals and matrices back. */
#include "hpimpl.h"

static inline void NodeAdd_Private(HPSpace hp, PetscInt node, const PetscReal r[], PetscReal local[])
{
  const PetscReal *q   = HPFrame_Private(hp, node);
  PetscReal       *dof = local + node * hp->dim;
  for (PetscInt k = 0; k < hp->dim; ++k) {
    if (!q)
      dof[k] += r[k];
    else
      for (PetscInt c = 0; c < hp->dim; ++c) dof[k] += q[3 * k + c] * r[c];
  }
}

PetscErrorCode HPSpaceGather(HPSpace hp, PetscInt cell, const PetscReal local[], PetscReal values[])
{
  const HPTables *v = &hp->view;
  const PetscInt  d = hp->dim, n = ElementNumNodes(d, v->cell_order[cell]), nm = v->cell_row[cell + 1] - v->cell_row[cell];
  const PetscInt *master = v->cell_master + v->cell_row[cell];

  PetscFunctionBegin;
  if (v->cell_weight[cell] < 0) {
    for (PetscInt i = 0; i < n; ++i) HPNodeValue_Private(hp, master[i], local, values + i * d);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const PetscReal *W = v->weight + v->cell_weight[cell];
  PetscCall(PetscArrayzero(values, n * d));
  for (PetscInt m = 0; m < nm; ++m) {
    PetscReal x[3];
    HPNodeValue_Private(hp, master[m], local, x);
    for (PetscInt i = 0; i < n; ++i) {
      for (PetscInt c = 0; c < d; ++c) values[i * d + c] += W[i * nm + m] * x[c];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceGatherPositions(HPSpace hp, PetscInt cell, PetscReal X[])
{
  const HPTables *v = &hp->view;
  const PetscInt  d = hp->dim, n = ElementNumNodes(d, v->cell_order[cell]), nm = v->cell_row[cell + 1] - v->cell_row[cell];
  const PetscInt *master = v->cell_master + v->cell_row[cell];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt c = 0; c < d; ++c) {
      if (v->cell_weight[cell] < 0)
        X[i * d + c] = v->X[3 * master[i] + c];
      else {
        const PetscReal *w = v->weight + v->cell_weight[cell] + i * nm;
        X[i * d + c]       = 0;
        for (PetscInt m = 0; m < nm; ++m) X[i * d + c] += w[m] * v->X[3 * master[m] + c];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HPSpaceScatterAdd(HPSpace hp, PetscInt cell, const PetscReal r[], PetscReal local[])
{
  const HPTables *v = &hp->view;
  const PetscInt  d = hp->dim, n = ElementNumNodes(d, v->cell_order[cell]), nm = v->cell_row[cell + 1] - v->cell_row[cell];
  const PetscInt *master = v->cell_master + v->cell_row[cell];

  PetscFunctionBegin;
  if (v->cell_weight[cell] < 0) {
    for (PetscInt i = 0; i < n; ++i) NodeAdd_Private(hp, master[i], r + i * d, local);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const PetscReal *W = v->weight + v->cell_weight[cell];
  for (PetscInt m = 0; m < nm; ++m) {
    PetscReal x[3] = {0, 0, 0};
    for (PetscInt i = 0; i < n; ++i) {
      for (PetscInt c = 0; c < d; ++c) x[c] += W[i * nm + m] * r[i * d + c];
    }
    NodeAdd_Private(hp, master[m], x, local);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Km = W^T K W for the scalar matrix W acting on each component: first columns, then rows. */
static PetscErrorCode Congruence_Private(PetscInt d, PetscInt n, PetscInt nm, const PetscReal *W, const PetscReal *K, PetscReal *half, PetscReal *Km)
{
  const PetscInt rows = n * d, cols = nm * d;
  PetscInt       num = 0, *entry, *first;

  PetscFunctionBegin;
  /* Most weights are 0: those that are not, row after row, are looked up once. */
  PetscCall(PetscMalloc2(n * nm, &entry, n + 1, &first));
  for (PetscInt j = 0; j < n; ++j) {
    first[j] = num;
    for (PetscInt m = 0; m < nm; ++m) {
      if (W[j * nm + m] != 0) entry[num++] = m;
    }
  }
  first[n] = num;
  PetscCall(PetscArrayzero(half, rows * cols));
  for (PetscInt r = 0; r < rows; ++r) {
    PetscReal *to = half + r * cols;
    for (PetscInt j = 0; j < n; ++j) {
      const PetscReal *from = K + r * rows + j * d;
      for (PetscInt k = first[j]; k < first[j + 1]; ++k) {
        const PetscReal w = W[j * nm + entry[k]];
        for (PetscInt c = 0; c < d; ++c) to[entry[k] * d + c] += w * from[c];
      }
    }
  }
  PetscCall(PetscFree2(entry, first));
  PetscCall(PetscArrayzero(Km, cols * cols));
  for (PetscInt i = 0; i < n; ++i) {
    for (PetscInt m = 0; m < nm; ++m) {
      const PetscReal w = W[i * nm + m];
      if (w == 0) continue;
      for (PetscInt c = 0; c < d; ++c) {
        PetscReal       *to   = Km + (m * d + c) * cols;
        const PetscReal *from = half + (i * d + c) * cols;
        for (PetscInt k = 0; k < cols; ++k) to[k] += w * from[k];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turn rows and columns of one master into the directions of its frame. */
static void Rotate_Private(PetscInt d, PetscInt size, PetscInt m, const PetscReal *q, PetscReal *K)
{
  for (PetscInt r = 0; r < size; ++r) {
    PetscReal x[3] = {0, 0, 0};
    for (PetscInt k = 0; k < d; ++k)
      for (PetscInt c = 0; c < d; ++c) x[k] += q[3 * k + c] * K[r * size + m * d + c];
    for (PetscInt k = 0; k < d; ++k) K[r * size + m * d + k] = x[k];
  }
  for (PetscInt j = 0; j < size; ++j) {
    PetscReal x[3] = {0, 0, 0};
    for (PetscInt k = 0; k < d; ++k)
      for (PetscInt c = 0; c < d; ++c) x[k] += q[3 * k + c] * K[(m * d + c) * size + j];
    for (PetscInt k = 0; k < d; ++k) K[(m * d + k) * size + j] = x[k];
  }
}

PetscErrorCode HPSpaceTransformMatrix(HPSpace hp, PetscInt cell, const PetscReal K[], PetscReal Km[], PetscInt dofs[], PetscInt *num_dofs)
{
  const HPTables *v = &hp->view;
  const PetscInt  d = hp->dim, n = ElementNumNodes(d, v->cell_order[cell]), nm = v->cell_row[cell + 1] - v->cell_row[cell];
  const PetscInt *master = v->cell_master + v->cell_row[cell];

  PetscFunctionBegin;
  if (v->cell_weight[cell] < 0)
    PetscCall(PetscArraycpy(Km, K, n * d * n * d));
  else
    PetscCall(Congruence_Private(d, n, nm, v->weight + v->cell_weight[cell], K, hp->work, Km));
  for (PetscInt m = 0; m < nm; ++m) {
    const PetscReal *q = HPFrame_Private(hp, master[m]);
    if (q) Rotate_Private(d, nm * d, m, q, Km);
    for (PetscInt c = 0; c < d; ++c) dofs[m * d + c] = master[m] * d + c;
  }
  *num_dofs = nm * d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of a cell's weights that boundary nodes have: W[num][masters but inner ones]. Inner nodes depend on themselves alone, the others never on them. */
static void BoundaryWeights_Private(HPSpace hp, PetscInt cell, PetscInt num, const PetscInt nodes[], PetscReal W[], PetscInt masters[], PetscInt *num_masters)
{
  const HPTables  *v  = &hp->view;
  const PetscInt   nm = v->cell_row[cell + 1] - v->cell_row[cell], *master = v->cell_master + v->cell_row[cell];
  const PetscReal *all  = v->weight + v->cell_weight[cell];
  PetscInt         kept = 0;

  for (PetscInt m = 0; m < nm; ++m) {
    if (master[m] < v->point_node[cell] || master[m] >= v->point_node[cell + 1]) masters[kept++] = m;
  }
  for (PetscInt i = 0; i < num; ++i)
    for (PetscInt m = 0; m < kept; ++m) W[i * kept + m] = all[nodes[i] * nm + masters[m]];
  for (PetscInt m = 0; m < kept; ++m) masters[m] = master[masters[m]];
  *num_masters = kept;
}

PetscErrorCode HPSpaceTransformBoundary(HPSpace hp, PetscInt cell, PetscInt num, const PetscInt nodes[], const PetscReal K[], PetscReal Km[], PetscInt dofs[],
                                        PetscInt *num_dofs)
{
  const HPTables *v = &hp->view;
  const PetscInt  d = hp->dim, *master = v->cell_master + v->cell_row[cell];
  PetscInt        nm = num, *masters;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(PetscMax(num, v->cell_row[cell + 1] - v->cell_row[cell]), &masters));
  if (v->cell_weight[cell] < 0) {
    for (PetscInt i = 0; i < num; ++i) masters[i] = master[nodes[i]];
    PetscCall(PetscArraycpy(Km, K, num * d * num * d));
  } else {
    PetscReal *W;
    PetscCall(PetscMalloc1(num * (v->cell_row[cell + 1] - v->cell_row[cell]), &W));
    BoundaryWeights_Private(hp, cell, num, nodes, W, masters, &nm);
    PetscCall(Congruence_Private(d, num, nm, W, K, hp->work, Km));
    PetscCall(PetscFree(W));
  }
  for (PetscInt m = 0; m < nm; ++m) {
    const PetscReal *q = HPFrame_Private(hp, masters[m]);
    if (q) Rotate_Private(d, nm * d, m, q, Km);
    for (PetscInt c = 0; c < d; ++c) dofs[m * d + c] = masters[m] * d + c;
  }
  *num_dofs = nm * d;
  PetscCall(PetscFree(masters));
  PetscFunctionReturn(PETSC_SUCCESS);
}
