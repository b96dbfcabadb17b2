/* Field files: one HDF5 file per state, written collectively, and the XDMF index over them: of times, and of passes of adaptation apart from it.
   A file holds a group per grid with X [n][3], cells [m][vertices] and the fields; its attribute "complete" is written last, so that a file cut off by a
   kill is recognised. Data sets are float64 and int64, chunked, shuffled, deflated. */
#include "outputimpl.h"
#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

#define CHUNK_BYTES 262144 /* one chunk at most: small enough for HDF5's 1 MB chunk cache of readers */
#define DEFLATE_LEVEL 1    /* with shuffle; levels 2 to 6 measured: up to 3 % smaller, up to 25 % slower */

struct _p_Writer {
  MPI_Comm         comm;
  PetscMPIInt      rank, size;
  char             directory[PETSC_MAX_PATH_LEN];
  Index            index;     /* owned; rank 0, else NULL */
  PetscInt         num;       /* states completed */
  int64_t          reserved;  /* bytes of the open file that there is room for; one rank: 0 */
  PetscBool        resumed;   /* files of later states are still there */
  IndexState       state;     /* the open state, or the last one */
  const SceneData *scene;     /* borrowed; NULL: fields have no units and no names */
  hid_t            file;      /* owned; -1 between states */
  PetscBool        open;      /* the file of a state may be there, unfinished */
  hid_t            group;     /* owned: the open grid; -1 when none */
  int64_t          total[2];  /* points and cells of the open grid, all ranks */
  int64_t          offset[2]; /* first point and cell of this rank */
  int64_t          local[2];  /* points and cells of this rank */
};

/* Remove the state files of an earlier series from number `from` on; names of exactly our form only. Rank 0. A directory that is not there is told by all ranks
   when the index is written. */
static PetscErrorCode WriterClear_Private(const char *directory, PetscInt from)
{
  char           path[PETSC_MAX_PATH_LEN];
  DIR           *dir = opendir(directory);
  struct dirent *entry;

  PetscFunctionBegin;
  if (!dir) PetscFunctionReturn(PETSC_SUCCESS);
  while ((entry = readdir(dir))) {
    if (OutputStateNumber(entry->d_name) < from) continue;
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", directory, entry->d_name));
    unlink(path);
  }
  closedir(dir);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rewrite one document of the index. Collective. */
static PetscErrorCode WriterDocument_Private(Writer w, const char *name, PetscBool passes)
{
  char       path[PETSC_MAX_PATH_LEN];
  OutputText text = {0};

  PetscFunctionBegin;
  if (w->index) PetscCall(IndexText(w->index, passes, &text));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", w->directory, name));
  PetscCall(OutputReplaceFile(w->comm, path, text.text));
  PetscCall(OutputTextDestroy(&text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rewrite the index; that of passes first, as WriterResume reads it where it is there. Collective. */
static PetscErrorCode WriterIndex_Private(Writer w)
{
  char      path[PETSC_MAX_PATH_LEN];
  PetscBool passes = (PetscBool)(w->index && IndexHasPasses(w->index));

  PetscFunctionBegin;
  PetscCallMPI(MPI_Bcast(&passes, 1, COMPAT_MPI_BOOL, 0, w->comm));
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/" INDEX_PASSES, w->directory));
  if (passes)
    PetscCall(WriterDocument_Private(w, INDEX_PASSES, PETSC_TRUE));
  else if (w->rank == 0)
    (void)unlink(path);
  PetscCall(WriterDocument_Private(w, INDEX_TIMES, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode New_Private(MPI_Comm comm, const char *directory, Writer *writer)
{
  Writer w;

  PetscFunctionBegin;
  PetscCall(PetscNew(&w));
  w->comm = comm;
  w->file = w->group = -1;
  PetscCallMPI(MPI_Comm_rank(comm, &w->rank));
  PetscCallMPI(MPI_Comm_size(comm, &w->size));
  PetscCall(PetscStrncpy(w->directory, directory, sizeof(w->directory)));
  if (w->rank == 0) PetscCall(IndexCreate(&w->index));
  *writer = w;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WriterCreate(MPI_Comm comm, const char *directory, Writer *writer)
{
  PetscFunctionBegin;
  PetscCall(New_Private(comm, directory, writer));
  if ((*writer)->rank == 0) PetscCall(WriterClear_Private(directory, 0));
  PetscCall(WriterIndex_Private(*writer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputForgetFields(MPI_Comm comm, const char *directory)
{
  static const char *const indices[] = {INDEX_TIMES, INDEX_PASSES};
  PetscMPIInt              rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank != 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(WriterClear_Private(directory, 0));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(indices); ++i) {
    char path[PETSC_MAX_PATH_LEN];
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", directory, indices[i]));
    (void)unlink(path);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The whole file as text; NULL: there is none. */
static PetscErrorCode Load_Private(const char *path, char **text)
{
  FILE       *file = fopen(path, "r");
  struct stat info;

  PetscFunctionBegin;
  *text = NULL;
  if (!file) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(!fstat(fileno(file), &info), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "Cannot read %s: %s", path, strerror(errno));
  PetscCall(PetscCalloc1((size_t)info.st_size + 1, text));
  (*text)[fread(*text, 1, (size_t)info.st_size, file)] = 0;
  fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int OutputStateHas(const char *path, const char *attribute)
{
  hid_t  file;
  htri_t has;

  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return -1;
  has = H5Aexists(file, attribute);
  (void)H5Fclose(file);
  return has > 0;
}

PetscErrorCode WriterResume(MPI_Comm comm, const char *directory, PetscInt step, PetscInt num, Writer *writer)
{
  char      path[PETSC_MAX_PATH_LEN], *text = NULL;
  PetscInt  listed = num;
  PetscReal time   = 0;
  PetscBool ours   = PETSC_TRUE;

  PetscFunctionBegin;
  PetscCall(New_Private(comm, directory, writer));
  for (int i = 0; i < 2 && !text; ++i) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", directory, i ? INDEX_TIMES : INDEX_PASSES));
    if ((*writer)->rank == 0) PetscCall(Load_Private(path, &text));
  }
  if (text) PetscCall(IndexRead((*writer)->index, text, step, &listed, &time, &ours));
  if (!ours) listed = -1;
  PetscCall(PetscFree(text));
  PetscCallMPI(MPI_Bcast(&listed, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&time, 1, MPIU_REAL, 0, comm));
  PetscCheckInput(listed == num,
                  "-restart: %s is not of the run that wrote the checkpoint, it does not list %" PetscInt_FMT " states up to step %" PetscInt_FMT
                  "; give another output.directory",
                  path, num, step);
  (*writer)->num        = num;
  (*writer)->state.time = time;
  (*writer)->state.step = step;
  (*writer)->resumed    = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WriterNumStates(Writer w, PetscInt *num)
{
  PetscFunctionBegin;
  *num = w->num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A state left open is closed without "complete" and stays out of the index. Collective. */
PetscErrorCode WriterDestroy(Writer *writer)
{
  PetscFunctionBegin;
  if (!*writer) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*writer)->group >= 0) PetscCallH5(H5Gclose((*writer)->group));
  if ((*writer)->file >= 0) PetscCallH5(H5Fclose((*writer)->file));
  PetscCall(IndexDestroy(&(*writer)->index));
  PetscCall(PetscFree(*writer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void WriterDescribe(Writer w, const SceneData *scene)
{
  w->scene = scene;
}

PetscErrorCode WriterBegin(Writer w, PetscReal time, PetscInt step, PetscInt pass, PetscReal load_time)
{
  char  path[PETSC_MAX_PATH_LEN];
  hid_t access;

  PetscFunctionBegin;
  PetscCheck(w->file < 0, w->comm, PETSC_ERR_ORDER, "State %" PetscInt_FMT " was not ended", w->num);
  PetscCheck(w->num == 0 || time > w->state.time || (time == w->state.time && step == w->state.step), w->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Time of a load step must increase: %g after %g", (double)time, (double)w->state.time);
  if (w->resumed) PetscCall(WriterIndex_Private(w)); /* never lists files that have gone */
  if (w->resumed && w->rank == 0) PetscCall(WriterClear_Private(w->directory, w->num));
  w->resumed = PETSC_FALSE;
  w->state   = (IndexState){.time = time, .load_time = load_time, .step = step, .pass = pass, .number = w->num};
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/fields_%04" PetscInt_FMT ".h5", w->directory, w->num));
  PetscCall(OutputAccess(w->comm, path, &access));
  w->open     = PETSC_TRUE;
  w->reserved = 0;
  PetscCallH5Id(w->file, H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access));
  PetscCallH5(H5Pclose(access));
  PetscCall(OutputAttributeReal(w->file, "time", time));
  PetscCall(OutputAttributeInt(w->file, "step", step));
  PetscCall(OutputAttributeInt(w->file, "pass", pass));
  PetscCall(OutputAttributeReal(w->file, "load_time", load_time));
  if (w->scene && w->scene->units.text[0]) PetscCall(OutputAttributeTexts(w->file, "units", 1, (const char *[]){w->scene->units.text}));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creation list of a data set [rows][columns] of 8-byte numbers: chunk, shuffle, deflate. An empty one has no chunks. */
static PetscErrorCode WriterFilters_Private(int64_t rows, PetscInt columns, hid_t *create)
{
  hsize_t chunk[2] = {CHUNK_BYTES / (8 * (hsize_t)columns), (hsize_t)columns};

  PetscFunctionBegin;
  PetscCallH5Id(*create, H5Pcreate(H5P_DATASET_CREATE));
  if (rows == 0) PetscFunctionReturn(PETSC_SUCCESS);
  chunk[0] = PetscMin(chunk[0], (hsize_t)rows);
  PetscCallH5(H5Pset_chunk(*create, columns > 1 ? 2 : 1, chunk));
  PetscCallH5(H5Pset_shuffle(*create));
  PetscCallH5(H5Pset_deflate(*create, DEFLATE_LEVEL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Data set [total][columns] of the open grid from this rank's rows (kind 0: as points, 1: as cells). Collective; ranks without rows take part with an
   empty selection, as collective filtered writes require. */
static PetscErrorCode WriterData_Private(Writer w, const char *name, int kind, PetscInt columns, hid_t stored, hid_t type, const void *data)
{
  int     dims     = columns > 1 ? 2 : 1;
  hsize_t whole[2] = {(hsize_t)w->total[kind], (hsize_t)columns}, part[2] = {(hsize_t)w->local[kind], (hsize_t)columns};
  hsize_t start[2] = {(hsize_t)w->offset[kind], 0};
  hid_t   create, space, memory, set, transfer;

  PetscFunctionBegin;
  if (w->size > 1) {
    w->reserved += OUTPUT_SET + 8 * w->total[kind] * columns;
    PetscCall(OutputReserve(w->comm, OutputAccessed(), w->reserved));
  }
  PetscCall(WriterFilters_Private(w->total[kind], columns, &create));
  PetscCallH5Id(space, H5Screate_simple(dims, whole, NULL));
  PetscCallH5Id(memory, H5Screate_simple(dims, part, NULL));
  PetscCallH5Id(set, H5Dcreate2(w->group, name, stored, space, H5P_DEFAULT, create, H5P_DEFAULT));
  if (part[0])
    PetscCallH5(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, part, NULL));
  else {
    PetscCallH5(H5Sselect_none(space));
    PetscCallH5(H5Sselect_none(memory));
  }
  PetscCallH5Id(transfer, H5Pcreate(H5P_DATASET_XFER));
  if (w->size > 1) PetscCallH5(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE));
  if (w->total[kind]) PetscCallH5(H5Dwrite(set, type, memory, space, transfer, data));
  PetscCallH5(H5Pclose(transfer));
  PetscCallH5(H5Dclose(set));
  PetscCallH5(H5Sclose(memory));
  PetscCallH5(H5Sclose(space));
  PetscCallH5(H5Pclose(create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names end up in HDF5 paths and in XML, unquoted. */
static PetscErrorCode WriterName_Private(Writer w, const char *name)
{
  PetscFunctionBegin;
  PetscCheck(name[0] && strlen(name) < MORTISE_NAME && !strpbrk(name, "/:<>&\"'"), w->comm, PETSC_ERR_ARG_WRONG, "Not a name for a grid or field: \"%s\"",
             name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Close the open grid and its index entry, if any. */
static PetscErrorCode WriterGridEnd_Private(Writer w)
{
  PetscFunctionBegin;
  if (w->group < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallH5(H5Gclose(w->group));
  w->group = -1;
  if (w->index && w->total[1]) PetscCall(IndexGridEnd(w->index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Connectivity of this rank in file numbering and VTK order: a lexicographic quad 0 1 2 3 becomes 0 1 3 2, a hexahedron two such quads. */
static PetscErrorCode WriterCells_Private(Writer w, CellShape shape, const PetscInt *conn)
{
  static const int order[8] = {0, 1, 3, 2, 4, 5, 7, 6};
  PetscInt         vertices = CellShapeVertices(shape);
  int64_t         *cells;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)(w->local[1] * vertices), &cells));
  for (int64_t c = 0; c < w->local[1]; c++)
    for (PetscInt v = 0; v < vertices; v++) {
      PetscInt point = conn[c * vertices + (shape == CELL_TRIANGLE3 ? v : order[v])];

      PetscAssert(point >= 0 && point < w->local[0], PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "Cell %lld names point %" PetscInt_FMT, (long long)c, point);
      cells[c * vertices + v] = w->offset[0] + point;
    }
  PetscCall(WriterData_Private(w, "cells", 1, vertices, H5T_STD_I64LE, H5T_NATIVE_INT64, cells));
  PetscCall(PetscFree(cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the values 0, 1, ... of a field of cells stand for: *num names, which the caller frees; 0: nothing. */
static PetscErrorCode ValueNames_Private(const SceneData *scene, const char *field, PetscInt *num, const char ***names)
{
  const PetscBool body = (PetscBool)!strcmp(field, "body"), pair = (PetscBool)!strcmp(field, "pair"), side = (PetscBool)!strcmp(field, "side");

  PetscFunctionBegin;
  *num = body ? scene->mechanics.num_bodies : pair ? SceneNumPairs(scene) : side ? 2 : 0;
  PetscCall(PetscMalloc1(*num, names));
  for (PetscInt i = 0; i < *num; ++i) (*names)[i] = body ? scene->mechanics.bodies[i].name : i ? "mortar" : "nonmortar";
  for (PetscInt i = 0; pair && i < scene->num_contacts; ++i) (*names)[scene->contacts[i].pair] = scene->contacts[i].name;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unit of a field, and names of its values, beside the data set and in the index. */
static PetscErrorCode WriterWords_Private(Writer w, const char *field)
{
  const OutputField *row  = OutputFieldFields;
  OutputText         list = {0};
  const char       **names;
  char               unit[64];
  PetscInt           num;
  hid_t              set;

  PetscFunctionBegin;
  while (row->name && strcmp(row->name, field)) ++row;
  PetscCall(SceneUnit(w->scene, row->name ? row->unit : "", sizeof(unit), unit));
  PetscCall(ValueNames_Private(w->scene, field, &num, &names));
  PetscCallH5Id(set, H5Dopen2(w->group, field, H5P_DEFAULT));
  if (unit[0]) PetscCall(OutputAttributeTexts(set, "unit", 1, (const char *[]){unit}));
  if (num) PetscCall(OutputAttributeTexts(set, "names", num, names));
  PetscCallH5(H5Dclose(set));
  for (PetscInt i = 0; i < num; ++i) PetscCall(OutputTextPrint(&list, "%s%s", i ? ", " : "", names[i]));
  if (w->index && w->total[1] && num) PetscCall(IndexFact(w->index, field, list.text));
  PetscCall(OutputTextDestroy(&list));
  PetscCall(PetscFree(names));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A grid without any cell is in the file but not in the index: readers have nothing to draw. */
PetscErrorCode WriterGrid(Writer w, const char *grid, CellShape shape, PetscInt np, const PetscReal *X, PetscInt nc, const PetscInt *conn)
{
  char file[MORTISE_NAME];

  PetscFunctionBegin;
  PetscCheck(w->file >= 0, w->comm, PETSC_ERR_ORDER, "Grid %s outside WriterBegin and WriterEnd", grid);
  PetscCall(WriterName_Private(w, grid));
  PetscCall(WriterGridEnd_Private(w));
  w->local[0] = np;
  w->local[1] = nc;
  PetscCallMPI(MPI_Allreduce(w->local, w->total, 2, MPI_INT64_T, MPI_SUM, w->comm));
  PetscCallMPI(MPI_Scan(w->local, w->offset, 2, MPI_INT64_T, MPI_SUM, w->comm));
  for (int kind = 0; kind < 2; kind++) w->offset[kind] -= w->local[kind];
  PetscCallH5Id(w->group, H5Gcreate2(w->file, grid, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(WriterData_Private(w, "X", 0, 3, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, X));
  PetscCall(WriterCells_Private(w, shape, conn));
  if (w->index && w->total[1]) {
    PetscCall(PetscSNPrintf(file, sizeof(file), "fields_%04" PetscInt_FMT ".h5", w->num));
    PetscCall(IndexGrid(w->index, &w->state, grid, shape, w->total[0], w->total[1], file));
    if (w->scene && w->scene->units.text[0]) PetscCall(IndexFact(w->index, "units", w->scene->units.text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WriterField(Writer w, const char *name, PetscBool at_cells, PetscInt ncomp, const PetscReal *data)
{
  PetscFunctionBegin;
  PetscCheck(w->group >= 0, w->comm, PETSC_ERR_ORDER, "Field %s without a grid", name);
  PetscCheck(ncomp == 1 || ncomp == 3 || ncomp == 6 || ncomp == 9, w->comm, PETSC_ERR_ARG_OUTOFRANGE,
             "Field %s: %" PetscInt_FMT " components, not 1, 3, 6 or 9", name, ncomp);
  PetscCall(WriterName_Private(w, name));
  PetscCall(WriterData_Private(w, name, at_cells ? 1 : 0, ncomp, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, data));
  if (w->index && w->total[1]) PetscCall(IndexField(w->index, name, at_cells, ncomp));
  if (w->scene) PetscCall(WriterWords_Private(w, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void WriterAbandon(Writer w)
{
  char path[PETSC_MAX_PATH_LEN];

  (void)snprintf(path, sizeof(path), "%s/fields_%04d.h5", w->directory, (int)w->num);
  if (w->open) (void)unlink(path);
}

PetscErrorCode WriterEnd(Writer w)
{
  PetscFunctionBegin;
  PetscCheck(w->file >= 0, w->comm, PETSC_ERR_ORDER, "WriterEnd without WriterBegin");
  PetscCall(WriterGridEnd_Private(w));
  PetscCallH5(H5Fflush(w->file, H5F_SCOPE_GLOBAL)); /* "complete" must not reach the disk before the data */
  PetscCall(OutputAttributeInt(w->file, "complete", 1));
  PetscCallH5(H5Fclose(w->file));
  if (w->rank == 0 && w->reserved) OutputGiveBack(OutputAccessed(), w->reserved);
  w->file = -1;
  w->open = PETSC_FALSE;
  w->num++;
  PetscCall(WriterIndex_Private(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}
