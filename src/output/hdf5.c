/* What the writers of HDF5 files share. */
#include "outputimpl.h"

/* A scalar attribute of an object. */
PetscErrorCode OutputAttribute(hid_t object, const char *name, hid_t stored, hid_t type, const void *value)
{
  hid_t space, attribute;

  PetscFunctionBegin;
  PetscCallH5Id(space, H5Screate(H5S_SCALAR));
  PetscCallH5Id(attribute, H5Acreate2(object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT));
  PetscCallH5(H5Awrite(attribute, type, value));
  PetscCallH5(H5Aclose(attribute));
  PetscCallH5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputAttributeInt(hid_t object, const char *name, PetscInt value)
{
  int64_t wide = value;

  PetscFunctionBegin;
  PetscCall(OutputAttribute(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &wide));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputAttributeReal(hid_t object, const char *name, PetscReal value)
{
  double wide = value;

  PetscFunctionBegin;
  PetscCall(OutputAttribute(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &wide));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Texts of fixed length: those of any would be written by one rank alone. */
PetscErrorCode OutputAttributeTexts(hid_t object, const char *name, PetscInt num, const char *const texts[])
{
  const hsize_t n       = (hsize_t)num;
  size_t        longest = 1;
  char         *all;
  hid_t         type, space, attribute;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num; ++i) longest = PetscMax(longest, strlen(texts[i]));
  PetscCall(PetscCalloc1((size_t)num * longest, &all));
  for (PetscInt i = 0; i < num; ++i) memcpy(all + (size_t)i * longest, texts[i], strlen(texts[i]));
  PetscCallH5Id(type, H5Tcopy(H5T_C_S1));
  PetscCallH5(H5Tset_size(type, longest));
  PetscCallH5(H5Tset_strpad(type, H5T_STR_NULLPAD));
  PetscCallH5(H5Tset_cset(type, H5T_CSET_UTF8));
  PetscCallH5Id(space, num == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, NULL));
  PetscCallH5Id(attribute, H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  PetscCallH5(H5Awrite(attribute, type, all));
  PetscCallH5(H5Aclose(attribute));
  PetscCallH5(H5Sclose(space));
  PetscCallH5(H5Tclose(type));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static char accessed[PETSC_MAX_PATH_LEN];

const char *OutputAccessed(void)
{
  return accessed;
}

const char *OutputErrno(void)
{
  return errno ? strerror(errno) : "no reason known";
}

PetscErrorCode OutputAccess(MPI_Comm comm, const char *path, hid_t *access)
{
  PetscMPIInt size;

  PetscFunctionBegin;
  PetscCall(PetscStrncpy(accessed, path, sizeof(accessed)));
  PetscCallH5(H5Eset_auto2(H5E_DEFAULT, NULL, NULL)); /* errors are told once, in one sentence */
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallH5Id(*access, H5Pcreate(H5P_FILE_ACCESS));
  if (size > 1) PetscCallH5(H5Pset_fapl_mpio(*access, comm, MPI_INFO_NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}
