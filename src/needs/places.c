/* Things that lie at one place, or at the place of each other's mirror image, found by a key that they share. */
#include "needsimpl.h"

void PlaceKey(Place *p, PetscInt axis, const PetscReal *at)
{
  const PetscReal weight[3] = {0.618033988749895, 0.414213562373095, 0.732050807568877};

  if (!at) p->X[axis] = 0;
  p->key = 0;
  for (PetscInt c = 0; c < 3; ++c) p->key += weight[c] * (c == axis && at ? PetscAbsReal(p->X[c] - *at) : p->X[c]);
}

static int CompareKey_Private(const void *a, const void *b)
{
  const PetscReal x = ((const Place *)a)->key, y = ((const Place *)b)->key;
  return (x > y) - (x < y);
}

void PlacesSort(PetscInt num, Place place[])
{
  qsort(place, (size_t)num, sizeof(*place), CompareKey_Private);
}

PetscInt PlacesLike(PetscInt num, const Place place[], PetscInt i, PetscReal size, PetscInt *first)
{
  PetscInt last = i;

  while (place[*first].key < place[i].key - 4 * NEEDS_SAME * size) ++*first;
  while (last < num && place[last].key < place[i].key + 4 * NEEDS_SAME * size) ++last;
  return last;
}

PetscBool PlaceIs(const Place *p, const Place *q, PetscInt axis, PetscReal at, int sign, PetscReal size)
{
  for (PetscInt c = 0; c < 3; ++c)
    if (PetscAbsReal((c == axis && sign < 0 ? 2 * at - p->X[c] : p->X[c]) - q->X[c]) > NEEDS_SAME * size) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode NeedsCorners(const NeedsRun *run, PetscInt axis, const PetscReal *at, PetscInt *num, Place **corner, PetscReal *largest)
{
  const ForestTables *t     = ForestGetTables(run->level->forest);
  HPSpace             space = ProblemSpace(run->level->problem);
  const HPTables     *v     = HPSpaceGetTables(space);
  PetscReal          *local, *X, *u;
  PetscInt            most = 1, num_mine = 0;
  Place              *mine;

  PetscFunctionBegin;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) most = PetscMax(most, v->cell_order[c]);
  most = ElementNumNodes(v->dim, most) * v->dim;
  PetscCall(PetscMalloc3(v->num_nodes * v->dim, &local, most, &X, most, &u));
  PetscCall(PetscCalloc1(v->num_owned_cells << v->dim, &mine));
  PetscCall(ProblemLocalDisplacement(run->level->problem, run->level->accepted.x, local));
  *largest = 0;
  for (PetscInt c = 0; c < v->num_owned_cells; ++c) {
    const PetscInt p = v->cell_order[c];
    PetscCall(HPSpaceGatherPositions(space, c, X));
    PetscCall(HPSpaceGather(space, c, local, u));
    for (PetscInt k = 0; k < 1 << v->dim; ++k) {
      const PetscInt node = p * ((k & 1) + (p + 1) * ((k >> 1 & 1) + (p + 1) * (k >> 2)));
      Place         *q    = &mine[num_mine++];
      q->body             = t->leaf_body[v->cell_leaf[c]];
      for (PetscInt d = 0; d < v->dim; ++d) {
        q->X[d]  = X[node * v->dim + d];
        q->u[d]  = u[node * v->dim + d];
        *largest = PetscMax(*largest, PetscAbsReal(q->u[d]));
      }
      PlaceKey(q, axis, at);
    }
  }
  PetscCall(PetscFree3(local, X, u));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, largest, 1, MPIU_REAL, MPI_MAX, run->comm));
  PetscCall(GatherAll(run->comm, num_mine, sizeof(Place), mine, num, corner)); /* what belongs together may be of several ranks */
  PetscCall(PetscFree(mine));
  PlacesSort(*num, *corner);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal NeedsSize(const CoarseMesh *mesh, PetscReal lo[3], PetscReal hi[3])
{
  PetscReal size = 0;

  ForestCoarseBox(mesh, lo, hi);
  for (PetscInt c = 0; c < mesh->dim; ++c) size = PetscMax(size, hi[c] - lo[c]);
  return size;
}

PetscErrorCode NeedsMiddle(Forest forest, const ForestTables *t, PetscInt leaf, PetscInt e, PetscReal X[3])
{
  const PetscInt *closure = t->closure + t->closure_offset[t->first[t->dim] + leaf];
  PetscInt        i       = 0;

  PetscFunctionBegin;
  while (closure[i] != e) ++i;
  const PetscReal xi[3] = {0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9)};
  X[2]                  = 0;
  PetscCall(ForestMapPoint(forest, leaf, xi, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}
