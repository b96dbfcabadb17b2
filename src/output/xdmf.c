/* The XDMF index of a series of states. Layout (XDMF 3, https://www.xdmf.org/index.php/XDMF_Model_and_Format): one Domain; in it one temporal Collection
   per grid name, whose members are Uniform grids that point into the HDF5 files. Every state has its own mesh. */
#include "outputimpl.h"

#define MAX_GRIDS 16

typedef struct {
  char       name[MORTISE_NAME];
  OutputText states; /* owned: the Uniform grids so far */
} IndexSeries;

struct _p_Index {
  PetscInt    num;                        /* grid names seen */
  IndexSeries series[MAX_GRIDS];          /* in order of first appearance */
  OutputText *open;                       /* entry being written, borrowed from series; NULL when none */
  char        prefix[PETSC_MAX_PATH_LEN]; /* "file:/grid" of the open entry */
  int64_t     num_points, num_cells;      /* of the open entry */
};

PetscInt CellShapeVertices(CellShape shape)
{
  return shape == CELL_POLYLINE2 ? 2 : shape == CELL_TRIANGLE3 ? 3 : shape == CELL_QUAD4 ? 4 : 8;
}

static const char *Topology_Private(CellShape shape)
{
  static const char *const topology[] = {
      [CELL_POLYLINE2] = "Polyline\" NodesPerElement=\"2", [CELL_TRIANGLE3] = "Triangle", [CELL_QUAD4] = "Quadrilateral", [CELL_HEX8] = "Hexahedron"};

  return topology[shape];
}

PetscErrorCode IndexCreate(Index *index)
{
  PetscFunctionBegin;
  PetscCall(PetscNew(index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IndexDestroy(Index *index)
{
  PetscFunctionBegin;
  if (!*index) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < (*index)->num; i++) PetscCall(OutputTextDestroy(&(*index)->series[i].states));
  PetscCall(PetscFree(*index));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The series of a grid name, begun when the name is new. */
static PetscErrorCode IndexSeries_Private(Index index, const char *name, IndexSeries **series)
{
  PetscInt i = 0;

  PetscFunctionBegin;
  while (i < index->num && strcmp(index->series[i].name, name)) i++;
  PetscCheck(i < MAX_GRIDS, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "More than %d different grids in one series: %s", MAX_GRIDS, name);
  if (i == index->num) {
    PetscCall(PetscStrncpy(index->series[i].name, name, sizeof(index->series[i].name)));
    index->num++;
  }
  *series = &index->series[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One DataItem: rows x columns of a data set under the open grid. */
static PetscErrorCode IndexItem_Private(Index index, const char *data_set, const char *type, int64_t rows, PetscInt columns)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(index->open, "          <DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"8\" Dimensions=\"%lld", type, (long long)rows));
  if (columns > 1) PetscCall(OutputTextPrint(index->open, " %" PetscInt_FMT, columns));
  PetscCall(OutputTextPrint(index->open, "\">%s/%s</DataItem>\n", index->prefix, data_set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IndexGrid(Index index, const IndexState *state, const char *grid, CellShape shape, int64_t num_points, int64_t num_cells, const char *file)
{
  IndexSeries *series = NULL;

  PetscFunctionBegin;
  PetscCall(IndexSeries_Private(index, grid, &series));
  index->open       = &series->states;
  index->num_points = num_points;
  index->num_cells  = num_cells;
  PetscCall(PetscSNPrintf(index->prefix, sizeof(index->prefix), "%s:/%s", file, grid));
  PetscCall(OutputTextPrint(index->open, "      <Grid Name=\"%s\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n", grid, (double)state->time));
  PetscCall(OutputTextPrint(index->open, "        <Information Name=\"step\" Value=\"%" PetscInt_FMT "\"/>\n", state->step));
  PetscCall(OutputTextPrint(index->open, "        <Information Name=\"pass\" Value=\"%" PetscInt_FMT "\"/>\n", state->pass));
  PetscCall(OutputTextPrint(index->open, "        <Information Name=\"load_time\" Value=\"%.17g\"/>\n", (double)state->load_time));
  PetscCall(OutputTextPrint(index->open, "        <Topology TopologyType=\"%s\" NumberOfElements=\"%lld\">\n", Topology_Private(shape), (long long)num_cells));
  PetscCall(IndexItem_Private(index, "cells", "Int", num_cells, CellShapeVertices(shape)));
  PetscCall(OutputTextPrint(index->open, "        </Topology>\n        <Geometry GeometryType=\"XYZ\">\n"));
  PetscCall(IndexItem_Private(index, "X", "Float", num_points, 3));
  PetscCall(OutputTextPrint(index->open, "        </Geometry>\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IndexFact(Index index, const char *name, const char *value)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(index->open, "        <Information Name=\"%s\" Value=\"", name));
  for (; *value; ++value) {
    const char *special = *value == '&' ? "&amp;" : *value == '<' ? "&lt;" : *value == '>' ? "&gt;" : *value == '"' ? "&quot;" : NULL;
    if (special)
      PetscCall(OutputTextPrint(index->open, "%s", special));
    else
      PetscCall(OutputTextPrint(index->open, "%c", *value));
  }
  PetscCall(OutputTextPrint(index->open, "\"/>\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IndexField(Index index, const char *name, PetscBool at_cells, PetscInt ncomp)
{
  const char *type = ncomp == 1 ? "Scalar" : ncomp == 3 ? "Vector" : ncomp == 6 ? "Tensor6" : "Tensor";

  PetscFunctionBegin;
  PetscCall(OutputTextPrint(index->open, "        <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">\n", name, type, at_cells ? "Cell" : "Node"));
  PetscCall(IndexItem_Private(index, name, "Float", at_cells ? index->num_cells : index->num_points, ncomp));
  PetscCall(OutputTextPrint(index->open, "        </Attribute>\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IndexGridEnd(Index index)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(index->open, "      </Grid>\n"));
  index->open = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The grid named first comes last: VTK takes all collections, meshio's TimeSeriesReader only the last one, and the bulk is written first. */
PetscErrorCode IndexText(Index index, OutputText *text)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"));
  for (PetscInt i = index->num - 1; i >= 0; i--) {
    IndexSeries *series = &index->series[i];

    if (!series->states.used) continue;
    PetscCall(OutputTextPrint(text, "    <Grid Name=\"%s\" GridType=\"Collection\" CollectionType=\"Temporal\">\n%s    </Grid>\n", series->name,
                              series->states.text));
  }
  PetscCall(OutputTextPrint(text, "  </Domain>\n</Xdmf>\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- reading it again ---------------------------------------------------------------------------------------------------------- */

/* The number that follows these words in an entry. */
static PetscBool Number_Private(const char *entry, const char *end, const char *words, double *number)
{
  const char *at = strstr(entry, words);

  if (!at || at >= end) return PETSC_FALSE;
  *number = strtod(at + strlen(words), NULL);
  return PETSC_TRUE;
}

/* Take over the entries of one collection, text .. end, up to a load step. *num: states they belong to; *time: of the last one. */
static PetscErrorCode Collection_Private(Index index, const char *text, const char *end, PetscInt step, PetscInt *num, PetscReal *time, PetscBool *ours)
{
  IndexSeries *series = NULL;
  char         name[MORTISE_NAME];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%.*s", (int)strcspn(text, "\""), text));
  PetscCall(IndexSeries_Private(index, name, &series));
  for (const char *entry = strstr(text, "\n      <Grid Name="); entry && entry < end; entry = strstr(entry + 1, "\n      <Grid Name=")) {
    const char *stop = strstr(entry, "\n      </Grid>\n");
    double      at, of, file;
    *ours = (PetscBool)(stop && stop < end && Number_Private(entry, stop, "<Time Value=\"", &at) &&
                        Number_Private(entry, stop, "Name=\"step\" Value=\"", &of) && Number_Private(entry, stop, ">fields_", &file));
    if (!*ours || of > step) break;
    stop += strlen("\n      </Grid>\n");
    PetscCall(OutputTextPrint(&series->states, "%.*s", (int)(stop - entry - 1), entry + 1));
    *num  = PetscMax(*num, (PetscInt)file + 1);
    *time = PetscMax(*time, (PetscReal)at);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode IndexRead(Index index, const char *text, PetscInt step, PetscInt *num, PetscReal *time, PetscBool *ours)
{
  static const char begin[] = "\n    <Grid Name=\"";

  PetscFunctionBegin;
  *ours = PETSC_TRUE;
  *num  = 0;
  *time = 0;
  for (const char *at = strstr(text, begin); at && *ours; at = strstr(at + 1, begin)) {
    const char *end = strstr(at, "\n    </Grid>\n");
    *ours           = (PetscBool)(end != NULL);
    if (end) PetscCall(Collection_Private(index, at + strlen(begin), end + 1, step, num, time, ours));
  }
  for (PetscInt i = 0, k = index->num - 1; i < k; ++i, --k) { /* they stand in the opposite order */
    const IndexSeries swap = index->series[i];
    index->series[i]       = index->series[k];
    index->series[k]       = swap;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
