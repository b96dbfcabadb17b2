/* Room on the disk. A rank that finds it full leaves a collective call of HDF5, in which the others wait for it for ever; so the first rank asks for the room
   before. File systems that cannot say are taken at their word later. */
#define _GNU_SOURCE
#include "outputimpl.h"
#include <fcntl.h>
#include <unistd.h>

PetscErrorCode OutputReserve(MPI_Comm comm, const char *path, int64_t bytes)
{
  PetscMPIInt rank;
  int         failed = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank == 0) {
    const int file = open(path, O_WRONLY | O_CLOEXEC);
    if (file >= 0 && fallocate(file, FALLOC_FL_KEEP_SIZE, 0, bytes) && (errno == ENOSPC || errno == EDQUOT)) failed = errno;
    if (file >= 0) (void)close(file);
  }
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  PetscCheck(!failed, comm, PETSC_ERR_FILE_WRITE, "%s: %s", path, strerror(failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void OutputGiveBack(const char *path, int64_t bytes)
{
  const int   file = open(path, O_WRONLY | O_CLOEXEC);
  const off_t end  = file >= 0 ? lseek(file, 0, SEEK_END) : 0;

  if (end > 0 && bytes > end) (void)fallocate(file, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, end, bytes - end);
  if (file >= 0) (void)close(file);
}
