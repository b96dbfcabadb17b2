/* Bounding-volume tree: median split of box centres along the longest side, at most 4 items per leaf. Build O(n log n), query O(log n + hits). */
#include "contactimpl.h"

enum { LEAF = 4 };

static void Enclose_Private(const Tree *t, TreeNode *node)
{
  for (int i = 0; i < 3; i++) node->box[i] = PETSC_MAX_REAL, node->box[3 + i] = -PETSC_MAX_REAL;
  for (PetscInt k = node->first; k < node->first + node->count; k++)
    for (int i = 0; i < 3; i++) {
      node->box[i]     = PetscMin(node->box[i], t->box[t->item[k]][i]);
      node->box[3 + i] = PetscMax(node->box[3 + i], t->box[t->item[k]][3 + i]);
    }
}

static inline PetscReal Centre_Private(const Tree *t, PetscInt k, int axis)
{
  return t->box[t->item[k]][axis] + t->box[t->item[k]][3 + axis];
}

/* Hoare's selection: afterwards items before `middle` have centres no larger, those after no smaller. */
static void Select_Private(Tree *t, PetscInt lo, PetscInt hi, PetscInt middle, int axis)
{
  while (lo < hi) {
    const PetscReal pivot = Centre_Private(t, lo + (hi - lo) / 2, axis);
    PetscInt        i = lo, j = hi;

    while (i <= j) {
      while (Centre_Private(t, i, axis) < pivot) i++;
      while (pivot < Centre_Private(t, j, axis)) j--;
      if (i <= j) {
        const PetscInt swap = t->item[i];

        t->item[i++] = t->item[j];
        t->item[j--] = swap;
      }
    }
    if (middle <= j)
      hi = j;
    else if (middle >= i)
      lo = i;
    else
      return;
  }
}

/* Split node i in two when it is too large. */
static void Split_Private(Tree *t, PetscInt i)
{
  TreeNode      *node = &t->node[i];
  const PetscInt half = node->count / 2;
  int            axis = 0;

  for (int k = 1; k < 3; k++)
    if (node->box[3 + k] - node->box[k] > node->box[3 + axis] - node->box[axis]) axis = k;

  Select_Private(t, node->first, node->first + node->count - 1, node->first + half, axis);
  node->child               = t->num;
  t->node[t->num].first     = node->first;
  t->node[t->num].count     = half;
  t->node[t->num + 1].first = node->first + half;
  t->node[t->num + 1].count = node->count - half;
  t->num += 2;
}

/* box[num] = (xmin, ymin, zmin, xmax, ymax, zmax) of the items; the tree takes the array over. Not collective. */
PetscErrorCode ContactTreeBuild(PetscInt num, PetscReal (*box)[6], Tree *t)
{
  PetscFunctionBegin;
  t->box = box;
  t->num = 1;
  PetscCall(PetscMalloc1(num, &t->item));
  PetscCall(PetscMalloc1(2 * num + 1, &t->node));
  for (PetscInt k = 0; k < num; k++) t->item[k] = k;
  t->node[0].first = 0;
  t->node[0].count = num;
  for (PetscInt i = 0; i < t->num; i++) {
    Enclose_Private(t, &t->node[i]);
    t->node[i].child = -1;
    if (t->node[i].count > LEAF) Split_Private(t, i);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactTreeDestroy(Tree *t)
{
  PetscFunctionBegin;
  PetscCall(FreeAll(3, (void *[]){&t->item, &t->node, &t->box}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ContactBoxesMeet(const PetscReal a[6], const PetscReal b[6])
{
  return a[0] <= b[3] && b[0] <= a[3] && a[1] <= b[4] && b[1] <= a[4] && a[2] <= b[5] && b[2] <= a[5] ? PETSC_TRUE : PETSC_FALSE;
}
