/* Messages between few of many ranks, of which only the sender knows beforehand; and what all ranks are to know of each other. */
#include "base.h"

/* Who sends here, and how many entries, in ascending order of rank. */
static PetscErrorCode Senders_Private(MPI_Comm comm, PetscMPIInt num_to, const PetscMPIInt to[], const PetscInt first[], PetscMPIInt *num_from,
                                      PetscMPIInt **from, PetscInt **count)
{
  PetscInt *counts;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num_to, &counts));
  for (PetscMPIInt i = 0; i < num_to; ++i) counts[i] = first[i + 1] - first[i];
  PetscCall(PetscCommBuildTwoSided(comm, 1, MPIU_INT, num_to, to, counts, num_from, from, count));
  PetscCall(PetscSortMPIIntWithIntArray(*num_from, *from, *count));
  PetscCall(PetscFree(counts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SparseExchange(MPI_Comm comm, PetscMPIInt num_to, const PetscMPIInt to[], const PetscInt first[], size_t entry, const void *send,
                              PetscInt *num_received, void *received)
{
  PetscMPIInt  num_from, *from, tag;
  PetscInt    *count, total = 0;
  MPI_Comm     inner;
  MPI_Request *request;
  char        *buffer;

  PetscFunctionBegin;
  PetscCall(Senders_Private(comm, num_to, to, first, &num_from, &from, &count));
  for (PetscMPIInt i = 0; i < num_from; ++i) total += count[i];
  PetscCall(PetscMalloc1((size_t)total * entry, &buffer));
  PetscCall(PetscMalloc1(num_to + num_from, &request));
  PetscCall(PetscCommDuplicate(comm, &inner, &tag));
  *num_received = 0;
  for (PetscMPIInt i = 0; i < num_from; ++i) {
    PetscCallMPI(MPI_Irecv(buffer + (size_t)*num_received * entry, (PetscMPIInt)((size_t)count[i] * entry), MPI_BYTE, from[i], tag, inner, &request[i]));
    *num_received += count[i];
  }
  for (PetscMPIInt i = 0; i < num_to; ++i) {
    PetscCallMPI(MPI_Isend((const char *)send + (size_t)first[i] * entry, (PetscMPIInt)((size_t)(first[i + 1] - first[i]) * entry), MPI_BYTE, to[i], tag, inner,
                           &request[num_from + i]));
  }
  PetscCallMPI(MPI_Waitall(num_to + num_from, request, MPI_STATUSES_IGNORE));
  PetscCall(PetscCommDestroy(&inner));
  PetscCall(PetscFree(request));
  PetscCall(PetscFree(from));
  PetscCall(PetscFree(count));
  *(void **)received = buffer;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherAll(MPI_Comm comm, PetscInt num, size_t entry, const void *mine, PetscInt *num_all, void *all)
{
  PetscMPIInt  size, own, *count, *offset;
  MPI_Datatype type;
  char        *buffer;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMPIIntCast(num, &own));
  PetscCall(PetscMalloc2(size, &count, size + 1, &offset));
  PetscCallMPI(MPI_Allgather(&own, 1, MPI_INT, count, 1, MPI_INT, comm));
  offset[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) offset[r + 1] = offset[r] + count[r];
  *num_all = offset[size];
  PetscCall(PetscMalloc1((size_t)offset[size] * entry, &buffer));
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)entry, MPI_BYTE, &type));
  PetscCallMPI(MPI_Type_commit(&type));
  PetscCallMPI(MPI_Allgatherv(mine, own, type, buffer, count, offset, type, comm));
  PetscCallMPI(MPI_Type_free(&type));
  PetscCall(PetscFree2(count, offset));
  *(void **)all = buffer;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VecDuplicateAll(Vec from, PetscInt num, Vec *const to[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; i++) PetscCall(VecDuplicate(from, to[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VecDestroyAll(PetscInt num, Vec *const x[])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; i++) PetscCall(VecDestroy(x[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BroadcastLargest(MPI_Comm comm, PetscReal value, void *bytes, size_t size)
{
  PetscMPIInt num;
  struct {
    double value;
    int    rank;
  } largest = {.value = (double)value};

  PetscFunctionBegin;
  PetscCall(PetscMPIIntCast((PetscInt)size, &num));
  PetscCallMPI(MPI_Comm_rank(comm, &largest.rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(bytes, num, MPI_BYTE, largest.rank, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RankFirst(MPI_Comm comm, PetscBool mine, PetscMPIInt *first)
{
  PetscMPIInt rank, size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!mine) rank = size;
  PetscCallMPI(MPI_Allreduce(&rank, first, 1, MPI_INT, MPI_MIN, comm));
  if (*first == size) *first = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}
