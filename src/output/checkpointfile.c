/* Checkpoints as files: HDF5, written by all ranks to a temporary beside the file, sealed, renamed. */
#include "outputimpl.h"
#include <unistd.h>

/* ---- writing --------------------------------------------------------------------------------------------------------------- */

/* A text with its end. All ranks create it, the first one writes. */
static PetscErrorCode WriteText_Private(Checkpoint c, hid_t file, const char *name, const char *text)
{
  hid_t       type, space, set;
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(c->comm, &rank));
  PetscCallH5Id(type, H5Tcopy(H5T_C_S1));
  PetscCallH5(H5Tset_size(type, strlen(text) + 1));
  PetscCallH5Id(space, H5Screate(H5S_SCALAR));
  PetscCallH5Id(set, H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (rank == 0) PetscCallH5(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text));
  PetscCallH5(H5Dclose(set));
  PetscCallH5(H5Sclose(space));
  PetscCallH5(H5Tclose(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries lo .. lo + num of a data set of total; ranks that write none pass num 0. Collective. */
static PetscErrorCode WriteArray_Private(hid_t file, const char *name, hid_t stored, hid_t type, PetscInt total, PetscInt lo, PetscInt num, const void *data)
{
  const hsize_t whole = (hsize_t)total, start = (hsize_t)lo, part = (hsize_t)num;
  hid_t         space, memory, set;

  PetscFunctionBegin;
  PetscCallH5Id(space, H5Screate_simple(1, &whole, NULL));
  PetscCallH5Id(set, H5Dcreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  if (num > 0) {
    PetscCallH5Id(memory, H5Screate_simple(1, &part, NULL));
    PetscCallH5(H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL, &part, NULL));
    PetscCallH5(H5Dwrite(set, type, memory, space, H5P_DEFAULT, data));
    PetscCallH5(H5Sclose(memory));
  }
  PetscCallH5(H5Dclose(set));
  PetscCallH5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteForest_Private(Checkpoint c, hid_t file)
{
  PetscMPIInt rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(c->comm, &rank));
  const PetscInt splits = rank ? 0 : c->num_splits, leaves = rank ? 0 : c->num_leaves; /* replicated: the first rank writes */
  PetscCall(WriteArray_Private(file, "split", H5T_STD_I8LE, H5T_NATIVE_INT8, c->num_splits, 0, splits, c->split));
  PetscCall(WriteArray_Private(file, "order", H5T_STD_I8LE, H5T_NATIVE_INT8, c->num_leaves, 0, leaves, c->order));
  PetscCall(WriteArray_Private(file, "owner", H5T_STD_I32LE, H5T_NATIVE_INT, c->num_leaves, 0, leaves, c->owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteFields_Private(Checkpoint c, hid_t file)
{
  hid_t group;

  PetscFunctionBegin;
  PetscCallH5Id(group, H5Gcreate2(file, "fields", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (PetscInt i = 0; i < c->pack.num; ++i) {
    const PetscReal *values;
    PetscInt         total, lo, hi;
    PetscCall(VecGetSize(c->pack.field[i].values, &total));
    PetscCall(VecGetOwnershipRange(c->pack.field[i].values, &lo, &hi));
    PetscCall(VecGetArrayRead(c->pack.field[i].values, &values));
    PetscCall(WriteArray_Private(group, c->pack.field[i].name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, total, lo, hi - lo, values));
    PetscCall(VecRestoreArrayRead(c->pack.field[i].values, &values));
  }
  PetscCallH5(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bytes of the file, at most. */
static PetscErrorCode Bytes_Private(Checkpoint c, int64_t *bytes)
{
  PetscFunctionBegin;
  *bytes = CHECKPOINT_SEAL + (int64_t)strlen(c->physics) + (int64_t)sizeof(c->note) + c->num_splits + (1 + (int64_t)sizeof(int)) * c->num_leaves +
           OUTPUT_SET * (8 + (int64_t)c->pack.num) + (int64_t)sizeof(CheckpointNumber) * c->num_numbers;
  for (PetscInt i = 0; i < c->pack.num; ++i) {
    PetscInt size;
    PetscCall(VecGetSize(c->pack.field[i].values, &size));
    *bytes += 8 * (int64_t)size;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteFile_Private(Checkpoint c, const char *path)
{
  hid_t       access, create, file, group;
  int64_t     bytes = 0;
  PetscMPIInt rank, size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(c->comm, &rank));
  PetscCallMPI(MPI_Comm_size(c->comm, &size));
  if (size > 1) PetscCall(Bytes_Private(c, &bytes));
  PetscCall(OutputAccess(c->comm, path, &access));
  PetscCallH5Id(create, H5Pcreate(H5P_FILE_CREATE));
  PetscCallH5(H5Pset_userblock(create, CHECKPOINT_SEAL));
  PetscCallH5Id(file, H5Fcreate(path, H5F_ACC_TRUNC, create, access));
  PetscCallH5(H5Pclose(create));
  PetscCallH5(H5Pclose(access));
  if (size > 1) PetscCall(OutputReserve(c->comm, path, bytes));
  PetscCall(WriteText_Private(c, file, "physics", c->physics));
  PetscCall(WriteText_Private(c, file, "note", c->note));
  PetscCall(OutputAttribute(file, "mesh", H5T_STD_U64LE, H5T_NATIVE_UINT64, &c->mesh));
  PetscCall(OutputAttributeInt(file, "revision", c->revision));
  PetscCall(OutputAttributeInt(file, "ranks", c->ranks));
  PetscCall(WriteForest_Private(c, file));
  PetscCall(WriteFields_Private(c, file));
  PetscCallH5Id(group, H5Gcreate2(file, "numbers", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (PetscInt i = 0; i < c->num_numbers; ++i) PetscCall(OutputAttributeReal(group, c->number[i].name, c->number[i].value));
  PetscCallH5(H5Gclose(group));
  PetscCallH5(H5Fflush(file, H5F_SCOPE_GLOBAL)); /* on every rank's node */
  PetscCallH5(H5Fclose(file));
  if (rank == 0 && size > 1) OutputGiveBack(path, bytes);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWrite(Checkpoint c, const char *path)
{
  char        temporary[PETSC_MAX_PATH_LEN];
  PetscMPIInt rank;
  int         failed = 0;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(c->comm, &rank));
  PetscCall(PetscSNPrintf(temporary, sizeof(temporary), "%s.tmp", path));
  if (rank == 0) (void)unlink(temporary); /* a link there would have another file written */
  PetscCallMPI(MPI_Barrier(c->comm));
  PetscCall(WriteFile_Private(c, temporary));
  if (rank == 0) failed = CheckpointSeal(temporary, path);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, c->comm));
  PetscCheck(!failed, c->comm, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", path, strerror(failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading: of a file whose seal holds ------------------------------------------------------------------------------------- */

static PetscErrorCode ReadText_Private(hid_t file, const char *name, char **text)
{
  hid_t set, type, space;

  PetscFunctionBegin;
  PetscCallH5Id(set, H5Dopen2(file, name, H5P_DEFAULT));
  PetscCallH5Id(type, H5Dget_type(set));
  PetscCallH5Id(space, H5Dget_space(set));
  PetscCheck(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Sget_simple_extent_npoints(space) == 1, PETSC_COMM_SELF,
             PETSC_ERR_FILE_READ, "%s is no text", name);
  PetscCallH5(H5Sclose(space));
  PetscCheck(H5Dget_storage_size(set) >= H5Tget_size(type), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s is not all there", name);
  PetscCall(PetscCalloc1(H5Tget_size(type) + 1, text));
  PetscCallH5(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, *text));
  PetscCallH5(H5Tclose(type));
  PetscCallH5(H5Dclose(set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers of the types that are written: of one with its sign beyond its bits HDF5's conversion writes past the end of its buffer. Takes the type. */
static PetscErrorCode CheckType_Private(hid_t type, const char *name)
{
  PetscBool known = PETSC_FALSE;

  PetscFunctionBegin;
  const hid_t written[] = {H5T_IEEE_F64LE, H5T_STD_I8LE, H5T_STD_I32LE, H5T_STD_I64LE, H5T_STD_U64LE};
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(written); ++i) known = (PetscBool)(known || H5Tequal(type, written[i]) > 0);
  PetscCheck(known, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s has numbers of another type", name);
  PetscCallH5(H5Tclose(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A list of numbers, all of which are in the file: memory is asked for what is there. */
static PetscErrorCode ReadSize_Private(hid_t file, const char *name, PetscInt *size)
{
  hid_t    set, space, type;
  hssize_t num;

  PetscFunctionBegin;
  PetscCallH5Id(set, H5Dopen2(file, name, H5P_DEFAULT));
  PetscCallH5Id(space, H5Dget_space(set));
  num   = H5Sget_simple_extent_npoints(space);
  *size = (PetscInt)num;
  PetscCheck(num >= 0 && num <= PETSC_MAX_INT, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%lld numbers in %s", (long long)num, name);
  PetscCallH5Id(type, H5Dget_type(set));
  PetscCheck(H5Sget_simple_extent_ndims(space) == 1 && (H5Tget_class(type) == H5T_INTEGER || H5Tget_class(type) == H5T_FLOAT), PETSC_COMM_SELF,
             PETSC_ERR_FILE_READ, "%s is no list of numbers", name);
  PetscCheck(H5Dget_storage_size(set) / H5Tget_size(type) >= (hsize_t)num, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s is not all there", name);
  PetscCallH5(H5Tclose(type));
  PetscCallH5(H5Sclose(space));
  PetscCallH5(H5Dclose(set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadArray_Private(hid_t file, const char *name, hid_t type, PetscInt lo, PetscInt num, void *data)
{
  const hsize_t start = (hsize_t)lo, part = (hsize_t)num;
  hid_t         set, space, memory, stored;

  PetscFunctionBegin;
  if (num == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallH5Id(set, H5Dopen2(file, name, H5P_DEFAULT));
  PetscCallH5Id(stored, H5Dget_type(set));
  PetscCall(CheckType_Private(stored, name));
  PetscCallH5Id(space, H5Dget_space(set));
  PetscCallH5Id(memory, H5Screate_simple(1, &part, NULL));
  PetscCallH5(H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, NULL, &part, NULL));
  PetscCallH5(H5Dread(set, type, memory, space, H5P_DEFAULT, data));
  PetscCallH5(H5Sclose(memory));
  PetscCallH5(H5Sclose(space));
  PetscCallH5(H5Dclose(set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadAttribute_Private(hid_t object, const char *name, hid_t type, void *value)
{
  hid_t attribute, space, stored;

  PetscFunctionBegin;
  PetscCallH5Id(attribute, H5Aopen(object, name, H5P_DEFAULT));
  PetscCallH5Id(stored, H5Aget_type(attribute));
  PetscCall(CheckType_Private(stored, name));
  PetscCallH5Id(space, H5Aget_space(attribute));
  PetscCheck(H5Sget_simple_extent_npoints(space) == 1, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s is not one number", name);
  PetscCallH5(H5Sclose(space));
  PetscCallH5(H5Aread(attribute, type, value));
  PetscCallH5(H5Aclose(attribute));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadForest_Private(Checkpoint c, hid_t file)
{
  int64_t  revision, ranks;
  PetscInt owners;

  PetscFunctionBegin;
  PetscCall(ReadAttribute_Private(file, "mesh", H5T_NATIVE_UINT64, &c->mesh));
  PetscCall(ReadAttribute_Private(file, "revision", H5T_NATIVE_INT64, &revision));
  PetscCall(ReadAttribute_Private(file, "ranks", H5T_NATIVE_INT64, &ranks));
  c->revision = (PetscInt)revision;
  c->ranks    = (PetscMPIInt)ranks;
  PetscCall(ReadSize_Private(file, "split", &c->num_splits));
  PetscCall(ReadSize_Private(file, "order", &c->num_leaves));
  PetscCall(ReadSize_Private(file, "owner", &owners));
  PetscCheck(owners == c->num_leaves, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%" PetscInt_FMT " owners of %" PetscInt_FMT " leaves", owners, c->num_leaves);
  PetscCall(PetscMalloc1(c->num_splits, &c->split));
  PetscCall(PetscMalloc1(c->num_leaves, &c->order));
  PetscCall(PetscMalloc1(c->num_leaves, &c->owner));
  PetscCall(ReadArray_Private(file, "split", H5T_NATIVE_INT8, 0, c->num_splits, c->split));
  PetscCall(ReadArray_Private(file, "order", H5T_NATIVE_INT8, 0, c->num_leaves, c->order));
  PetscCall(ReadArray_Private(file, "owner", H5T_NATIVE_INT, 0, c->num_leaves, c->owner));
  for (PetscInt l = 0; l < c->num_leaves; ++l) {
    PetscCheck(c->order[l] >= 1 && c->order[l] <= MORTISE_MAX_ORDER && c->owner[l] >= 0 && c->owner[l] < c->ranks, PETSC_COMM_SELF, PETSC_ERR_FILE_READ,
               "leaf %" PetscInt_FMT ": order %d, owner %d of %d", l, (int)c->order[l], (int)c->owner[l], (int)c->ranks);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFields_Private(Checkpoint c, hid_t file)
{
  hid_t      group;
  H5G_info_t info;
  PetscInt   strange = 0;

  PetscFunctionBegin;
  PetscCallH5Id(group, H5Gopen2(file, "fields", H5P_DEFAULT));
  PetscCallH5(H5Gget_info(group, &info));
  PetscCall(PetscCalloc1((size_t)info.nlinks, &c->pack.field));
  for (; c->pack.num < (PetscInt)info.nlinks; ++c->pack.num) {
    PackField *f = &c->pack.field[c->pack.num];
    PetscInt   total, lo, hi;
    PetscReal *values;
    PetscCallH5(H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, (hsize_t)c->pack.num, f->name, sizeof(f->name), H5P_DEFAULT));
    PetscCall(ReadSize_Private(group, f->name, &total));
    PetscCall(VecCreateMPI(c->comm, PETSC_DECIDE, total, &f->values));
    PetscCall(VecGetOwnershipRange(f->values, &lo, &hi));
    PetscCall(VecGetArray(f->values, &values));
    PetscCall(ReadArray_Private(group, f->name, H5T_NATIVE_DOUBLE, lo, hi - lo, values));
    for (PetscInt i = 0; i < hi - lo; ++i) strange += PetscIsInfOrNanReal(values[i]);
    PetscCall(VecRestoreArray(f->values, &values));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &strange, 1, MPIU_INT, MPI_SUM, c->comm)); /* each rank has seen its part */
  PetscCheck(!strange, PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%" PetscInt_FMT " numbers are not finite", strange);
  PetscCallH5(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadNumbers_Private(Checkpoint c, hid_t file)
{
  hid_t      group;
  H5O_info_t info;

  PetscFunctionBegin;
  PetscCallH5Id(group, H5Gopen2(file, "numbers", H5P_DEFAULT));
  PetscCallH5(H5Oget_info(group, &info));
  PetscCall(PetscCalloc1((size_t)info.num_attrs, &c->number));
  for (; c->num_numbers < (PetscInt)info.num_attrs; ++c->num_numbers) {
    CheckpointNumber *n = &c->number[c->num_numbers];
    PetscCallH5(H5Aget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, (hsize_t)c->num_numbers, n->name, sizeof(n->name), H5P_DEFAULT));
    PetscCall(ReadAttribute_Private(group, n->name, H5T_NATIVE_DOUBLE, &n->value));
  }
  PetscCallH5(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has it all that this version reads? Others may have written less. */
static PetscErrorCode Complete_Private(hid_t file, const char *path)
{
  static const char *const link[] = {"physics", "note", "split", "order", "owner", "fields", "numbers"}, *const attribute[] = {"mesh", "revision", "ranks"};

  PetscFunctionBegin;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(link); ++i)
    PetscCheckInput(H5Lexists(file, link[i], H5P_DEFAULT) > 0, "-restart %s: it has no %s: another version of mortise wrote it", path, link[i]);
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(attribute); ++i)
    PetscCheckInput(H5Aexists(file, attribute[i]) > 0, "-restart %s: it has no %s: another version of mortise wrote it", path, attribute[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFile_Private(Checkpoint c, const char *path)
{
  hid_t access, file;
  char *note;

  PetscFunctionBegin;
  PetscCall(OutputAccess(c->comm, path, &access));
  PetscCallH5Id(file, H5Fopen(path, H5F_ACC_RDONLY, access));
  PetscCallH5(H5Pclose(access));
  PetscCall(Complete_Private(file, path));
  PetscCall(ReadText_Private(file, "physics", &c->physics));
  PetscCall(ReadText_Private(file, "note", &note));
  PetscCall(PetscStrncpy(c->note, note, sizeof(c->note)));
  PetscCall(PetscFree(note));
  PetscCall(ReadForest_Private(c, file));
  PetscCall(ReadFields_Private(c, file));
  PetscCall(ReadNumbers_Private(c, file));
  PetscCallH5(H5Fclose(file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointRead(MPI_Comm comm, const char *path, Checkpoint *checkpoint)
{
  Checkpoint c;

  PetscFunctionBegin;
  PetscCall(CheckpointVerify(comm, path));
  PetscCall(PetscNew(&c));
  PetscCall(PetscCommDuplicate(comm, &c->comm, NULL));
  PetscCall(PetscStrncpy(c->path, path, sizeof(c->path)));
  GuardBegin("-restart %s: damaged, though its checksum holds", path);
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL)); /* the sentence below says it */
  const PetscErrorCode status = ReadFile_Private(c, path);
  PetscCall(PetscPopErrorHandler());
  GuardEnd();
  PetscCheckInput(!status || status == MORTISE_ERR_INPUT || status == PETSC_ERR_MEM, "-restart %s: damaged, though its checksum holds", path);
  PetscCall(status);
  *checkpoint = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}
