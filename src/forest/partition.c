/* Distribution of the leaves: METIS on the graph of facet neighbours and contact couplings. */
#include "forestimpl.h"
#include <metis.h>

typedef struct {
  PetscInt num, capacity;
  PetscInt (*pair)[2]; /* owned */
} PairList;

static PetscErrorCode PairAdd_Private(PairList *list, PetscInt a, PetscInt b)
{
  PetscFunctionBegin;
  if (a < 0 || b < 0 || a == b) PetscFunctionReturn(PETSC_SUCCESS);
  if (list->num == list->capacity) {
    list->capacity = 2 * list->capacity + 64;
    PetscCall(PetscRealloc(sizeof(PetscInt[2]) * (size_t)list->capacity, &list->pair));
  }
  list->pair[list->num][0]   = a;
  list->pair[list->num++][1] = b;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves on either side of a facet, or of a facet and the one it hangs in. */
static PetscErrorCode FacetPairs_Private(const ForestTables *t, PairList *list)
{
  const PetscInt first = t->first[t->dim - 1];

  PetscFunctionBegin;
  for (PetscInt f = 0; f < t->first[t->dim] - first; ++f) {
    const PetscInt parent = t->parent[first + f] - first;
    PetscCall(PairAdd_Private(list, t->facet_leaf[2 * f], t->facet_leaf[2 * f + 1]));
    if (t->parent[first + f] < 0) continue;
    for (PetscInt s = 0; s < 2; ++s) PetscCall(PairAdd_Private(list, t->facet_leaf[2 * f], t->facet_leaf[2 * parent + s]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adjacency in METIS's compressed rows, without repetitions; xadj [n+1] and adjacency are allocated here. */
static PetscErrorCode BuildGraph_Private(PetscInt n, const PairList *list, idx_t **xadj_out, idx_t **adjacency_out)
{
  idx_t    *xadj, *raw, *adjacency, *start;
  PetscInt *seen, size = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(n + 1, &start));
  PetscCall(PetscMalloc1(2 * list->num, &raw));
  PetscCall(PetscMalloc1(n + 1, &xadj));
  PetscCall(PetscMalloc1(n, &seen));
  for (PetscInt p = 0; p < list->num; ++p)
    for (PetscInt s = 0; s < 2; ++s) ++start[list->pair[p][s] + 1];
  for (PetscInt i = 0; i < n; ++i) start[i + 1] += start[i], xadj[i] = start[i], seen[i] = -1;
  for (PetscInt p = 0; p < list->num; ++p)
    for (PetscInt s = 0; s < 2; ++s) raw[xadj[list->pair[p][s]]++] = (idx_t)list->pair[p][1 - s];
  PetscCall(PetscMalloc1(2 * list->num, &adjacency));
  for (PetscInt i = 0; i < n; ++i) {
    xadj[i] = size;
    for (idx_t k = start[i]; k < start[i + 1]; ++k) {
      if (seen[raw[k]] == i) continue;
      seen[raw[k]]      = i;
      adjacency[size++] = raw[k];
    }
  }
  xadj[n] = size;
  PetscCall(PetscFree(start));
  PetscCall(PetscFree(raw));
  PetscCall(PetscFree(seen));
  *xadj_out      = xadj;
  *adjacency_out = adjacency;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* METIS counts in integers: at least 1 each, total kept far below the 32-bit limit. */
static void IntegerWeights_Private(PetscInt n, const PetscReal weight[], idx_t result[])
{
  PetscReal total = 0;

  for (PetscInt i = 0; i < n; ++i) total += weight ? weight[i] : 1;
  const PetscReal scale = PetscMin(1e8, 1e3 * n) / total;
  for (PetscInt i = 0; i < n; ++i) result[i] = (idx_t)PetscMax(1, PetscFloorReal(0.5 + (weight ? weight[i] : 1) * scale));
}

static PetscErrorCode CallMetis_Private(PetscInt n, PetscInt num_parts, const PairList *list, const PetscReal weight[], PetscMPIInt part[])
{
  idx_t num = (idx_t)n, constraints = 1, parts = (idx_t)num_parts, cut, options[METIS_NOPTIONS], *xadj = NULL, *adjacency = NULL, *vertex_weight, *result;
  int   status;

  PetscFunctionBegin;
  PetscCall(BuildGraph_Private(n, list, &xadj, &adjacency));
  PetscCall(PetscMalloc1(n, &vertex_weight));
  PetscCall(PetscMalloc1(n, &result));
  IntegerWeights_Private(n, weight, vertex_weight);
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  /* Recursive bisection balances better for few parts. */
  status = (num_parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway)(&num, &constraints, xadj, adjacency, vertex_weight, NULL, NULL, &parts, NULL, NULL,
                                                                             options, &cut, result);
  PetscCheck(status == METIS_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "METIS failed with status %d on %" PetscInt_FMT " leaves", status, n);
  for (PetscInt i = 0; i < n; ++i) part[i] = (PetscMPIInt)result[i];
  PetscCall(PetscFree(xadj));
  PetscCall(PetscFree(adjacency));
  PetscCall(PetscFree(vertex_weight));
  PetscCall(PetscFree(result));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestPartition(MPI_Comm comm, const ForestTables *t, const PetscReal weight[], PetscInt num_pairs, const PetscInt pairs[][2],
                               PetscMPIInt leaf_rank[])
{
  const PetscInt n = t->num_leaves;
  PetscMPIInt    size, rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (size == 1 || n <= size) { /* fewer leaves than ranks: one each, the last ranks stay empty */
    for (PetscInt i = 0; i < n; ++i) leaf_rank[i] = size == 1 ? 0 : (PetscMPIInt)i;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (rank == 0) {
    PairList list = {0};
    PetscCall(FacetPairs_Private(t, &list));
    for (PetscInt p = 0; p < num_pairs; ++p) PetscCall(PairAdd_Private(&list, pairs[p][0], pairs[p][1]));
    if (list.num > 0)
      PetscCall(CallMetis_Private(n, size, &list, weight, leaf_rank));
    else /* no two cells touch: nothing to cut */
      for (PetscInt i = 0; i < n; ++i) leaf_rank[i] = (PetscMPIInt)(i * size / n);
    PetscCall(PetscFree(list.pair));
  }
  PetscCallMPI(MPI_Bcast(leaf_rank, (PetscMPIInt)n, MPI_INT, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
