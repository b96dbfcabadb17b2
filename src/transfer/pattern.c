/* The room that a contact pair has been given in the matrix, as a field: for each facet of the nonmortar side the number of nodes it has room for, then these
   nodes facet after facet. It is no part of the state, but in what order unknowns are eliminated depends on it, and so does the round-off of solutions, which
   next to a large bulk modulus shows in pressures: a run that goes on with the room it had repeats what it would have done bit by bit. */
#include "transferimpl.h"

/* Facets of this rank's leaves: their places in the field, and what is there. */
static PetscErrorCode Fill_Private(MPI_Comm comm, const SurfaceView *s, const ForestTables *t, const PetscInt first[], const PetscInt node[], Places *p)
{
  PetscMPIInt rank;
  PetscInt   *offset, own = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscCalloc1(s->num_facets + 1, &offset));
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    if (t->leaf_rank[s->facet_leaf[f]] != rank) continue;
    if (first) offset[f + 1] = first[f + 1] - first[f];
    own += 1 + offset[f + 1];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, offset, (PetscMPIInt)(s->num_facets + 1), MPIU_INT, MPI_SUM, comm));
  for (PetscInt f = 0; f < s->num_facets; ++f) offset[f + 1] += offset[f];
  PetscCall(PlacesCreate_Private(own, s->num_facets + offset[s->num_facets], p));
  own = 0;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    if (t->leaf_rank[s->facet_leaf[f]] != rank) continue;
    p->index[own]   = f;
    p->value[own++] = (PetscReal)(offset[f + 1] - offset[f]);
    for (PetscInt k = offset[f]; k < offset[f + 1]; ++k) {
      p->index[own]   = s->num_facets + k;
      p->value[own++] = (PetscReal)node[first[f] + k - offset[f]];
    }
  }
  PetscCall(PetscFree(offset));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PatternPack_Private(Problem problem, PetscInt pair, Vec *field)
{
  const ContactView *view;
  const PetscInt    *first, *node;
  Forest             forest = ProblemForest(problem);
  Places             p;

  PetscFunctionBegin;
  view                  = InterfaceGetContact(ProblemInterface(problem), pair);
  const ForestTables *t = ForestGetTables(forest);
  InterfaceGetPattern(ProblemInterface(problem), pair, &first, &node);
  PetscCall(Fill_Private(ForestComm(forest), &view->nonmortar, t, first, node, &p));
  PetscCall(PlacesSend_Private(ForestComm(forest), &p, field));
  PetscCall(PlacesDestroy_Private(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PatternUnpack_Private(Problem problem, PetscInt pair, Vec field)
{
  const ContactView *view = InterfaceGetContact(ProblemInterface(problem), pair);
  PetscInt           total, *first, *node;
  Places             p;

  PetscFunctionBegin;
  const PetscInt num = view->nonmortar.num_facets;
  PetscCall(VecGetSize(field, &total));
  const SceneData *scene = ProblemGetScene(problem);
  PetscCheckInput(total >= num, "-restart: pattern.%s of the checkpoint has %" PetscInt_FMT " numbers, less than faces: another version of mortise wrote it",
                  scene->contacts[pair].name, total);
  PetscCall(PlacesCreate_Private(total, total, &p)); /* a rank needs those of facets around its own, too */
  for (PetscInt i = 0; i < total; ++i) p.index[i] = i;
  PetscCall(PlacesFetch_Private(field, &p));
  PetscCall(PetscMalloc2(num + 1, &first, total - num, &node));
  first[0] = 0;
  for (PetscInt f = 0; f < num; ++f) first[f + 1] = first[f] + (PetscInt)PetscClipInterval(p.value[f], 0, total - first[f]);
  PetscCheckInput(num + first[num] == total,
                  "-restart: pattern.%s of the checkpoint has %" PetscInt_FMT " numbers, not %" PetscInt_FMT ": another version of mortise wrote it",
                  scene->contacts[pair].name, total, num + first[num]);
  for (PetscInt i = 0; i < first[num]; ++i) {
    const PetscReal value = p.value[num + i];
    PetscCheckInput(value >= -view->mortar.num_nodes && value < view->nonmortar.num_nodes,
                    "-restart: pattern.%s of the checkpoint names node %g, which is not there", scene->contacts[pair].name, (double)value);
    node[i] = (PetscInt)value;
  }
  PetscCall(ProblemSetPattern(problem, pair, first, node));
  PetscCall(PetscFree2(first, node));
  PetscCall(PlacesDestroy_Private(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
