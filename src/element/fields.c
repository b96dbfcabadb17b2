/* Fields of one cell at point after point. Directions are summed up one after the other, the slowest first, and a sum is kept as long as the points share its
   coordinates: on a lattice of points a value costs about p+1 terms in place of (p+1)^dim. All fields of a cell go through at once, one in each lane. */
#include "element.h"

void ElementFieldsBegin(ElementFields *f, PetscInt dim, PetscInt order)
{
  const Lanes zero = {0};

  f->dim   = dim;
  f->order = order;
  for (PetscInt d = 0; d < 3; ++d) f->at[d] = (PetscReal)NAN; /* nowhere yet */
  for (PetscInt i = 0; i < ElementNumNodes(dim, order); ++i) f->node[i] = zero;
}

void ElementFieldsAdd(ElementFields *f, PetscInt first, PetscInt num, const PetscReal values[])
{
  const PetscInt n = ElementNumNodes(f->dim, f->order);

  for (PetscInt i = 0; i < n; ++i)
    for (PetscInt c = 0; c < num; ++c) f->node[i][first + c] = values[i * num + c];
}

/* sum over k of weight[k] from[k * stride + i], i < stride: the slowest direction goes. */
static inline void Contract_Private(PetscInt n1, PetscInt stride, const PetscReal weight[], const Lanes from[], Lanes to[])
{
  for (PetscInt i = 0; i < stride; ++i) {
    Lanes sum = weight[0] * from[i];
    for (PetscInt k = 1; k < n1; ++k) sum += weight[k] * from[k * stride + i];
    to[i] = sum;
  }
}

PetscErrorCode ElementFieldsAt(ElementFields *f, const PetscReal xi[], Lanes value[])
{
  const PetscInt n1    = f->order + 1;
  PetscBool      moved = PETSC_FALSE;

  PetscFunctionBegin;
  if (f->dim == 3 && xi[2] != f->at[2]) {
    moved    = PETSC_TRUE;
    f->at[2] = xi[2];
    PetscCall(ElementEvaluate1D(f->order, xi[2], f->N[2], f->D[2]));
    Contract_Private(n1, n1 * n1, f->N[2], f->node, f->plane[0]);
    Contract_Private(n1, n1 * n1, f->D[2], f->node, f->plane[1]);
  }
  if (moved || xi[1] != f->at[1]) {
    const Lanes *plane = f->dim == 3 ? f->plane[0] : f->node;
    if (xi[1] != f->at[1]) PetscCall(ElementEvaluate1D(f->order, xi[1], f->N[1], f->D[1]));
    f->at[1] = xi[1];
    Contract_Private(n1, n1, f->N[1], plane, f->line[0]);
    Contract_Private(n1, n1, f->D[1], plane, f->line[1]);
    if (f->dim == 3) Contract_Private(n1, n1, f->N[1], f->plane[1], f->line[2]);
  }
  if (xi[0] != f->at[0]) PetscCall(ElementEvaluate1D(f->order, xi[0], f->N[0], f->D[0]));
  f->at[0] = xi[0];
  Contract_Private(n1, 1, f->N[0], f->line[0], &value[0]);
  Contract_Private(n1, 1, f->D[0], f->line[0], &value[1]);
  for (PetscInt d = 1; d < f->dim; ++d) Contract_Private(n1, 1, f->N[0], f->line[d], &value[1 + d]);
  PetscFunctionReturn(PETSC_SUCCESS);
}
