/* Leaf pairs that face each other in contact: the partition keeps them together where it can. */
#include "appimpl.h"

static int ComparePairs_Private(const void *a, const void *b)
{
  const PetscInt *p = a, *q = b;

  if (p[0] != q[0]) return p[0] < q[0] ? -1 : 1;
  return (p[1] > q[1]) - (p[1] < q[1]);
}

/* Sort, and drop what comes twice: leaves of three dimensions share many segments. */
static void Unique_Private(PetscInt *num, PetscInt pairs[][2])
{
  PetscInt kept = 0;

  if (*num > 1) qsort(pairs, (size_t)*num, sizeof(pairs[0]), ComparePairs_Private);
  for (PetscInt i = 0; i < *num; ++i) {
    if (kept > 0 && ComparePairs_Private(pairs[kept - 1], pairs[i]) == 0) continue;
    pairs[kept][0]   = pairs[i][0];
    pairs[kept++][1] = pairs[i][1];
  }
  *num = kept;
}

/* Those of this rank's segments. */
static PetscErrorCode Mine_Private(Problem problem, PetscInt num_contacts, PetscInt *num, PetscInt (**pairs)[2])
{
  const ContactView    *v;
  const ContactSegment *segments;
  PetscInt              n, count = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num_contacts; ++i) {
    v = InterfaceGetContact(ProblemInterface(problem), i);
    ContactPairGetSegments(v->pair, &n, &segments);
    count += n;
  }
  PetscCall(PetscMalloc1(count, pairs));
  *num = 0;
  for (PetscInt i = 0; i < num_contacts; ++i) {
    v = InterfaceGetContact(ProblemInterface(problem), i);
    ContactPairGetSegments(v->pair, &n, &segments);
    for (PetscInt s = 0; s < n; ++s, ++*num) {
      (*pairs)[*num][0] = v->nonmortar.facet_leaf[segments[s].facet];
      (*pairs)[*num][1] = v->mortar.facet_leaf[segments[s].mortar_facet];
    }
  }
  Unique_Private(num, *pairs);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AppContactPairs(App *app, PetscInt *num, PetscInt (**pairs)[2])
{
  PetscMPIInt size;
  PetscInt    num_mine, (*mine)[2];

  PetscFunctionBegin;
  *num   = 0;
  *pairs = NULL;
  PetscCallMPI(MPI_Comm_size(app->comm, &size));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Mine_Private(app->level.problem, app->data->num_contacts, &num_mine, &mine));
  PetscCall(GatherAll(app->comm, num_mine, sizeof(mine[0]), mine, num, pairs));
  PetscCall(PetscFree(mine));
  Unique_Private(num, *pairs);
  PetscFunctionReturn(PETSC_SUCCESS);
}
