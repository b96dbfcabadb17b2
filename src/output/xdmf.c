/* The XDMF index of a series of states. Layout (XDMF 3, https://www.xdmf.org/index.php/XDMF_Model_and_Format): one Domain; in it one temporal Collection
   per grid name, whose members are Uniform grids that point into the HDF5 files. Every state has its own mesh. Two documents of one index: the last state of
   each load step at its time, and all states, passes of adaptation too, which share their times, by number. */
#include "outputimpl.h"

#define MAX_GRIDS 16

typedef struct {
  PetscInt   number, step; /* of the state; its load step */
  PetscReal  time;
  OutputText text; /* owned: what follows the time */
} IndexEntry;

typedef struct {
  char        name[MORTISE_NAME];
  PetscInt    num, size;
  IndexEntry *entry; /* owned [size] */
} IndexSeries;

struct _p_Index {
  PetscInt    num;                        /* grid names seen */
  IndexSeries series[MAX_GRIDS];          /* in order of first appearance */
  PetscInt    num_states, *step;          /* owned: load step of each state, by number */
  OutputText *open;                       /* text of the entry being written, borrowed from series; NULL when none */
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
  for (PetscInt i = 0; i < (*index)->num; i++) {
    IndexSeries *series = &(*index)->series[i];

    for (PetscInt e = 0; e < series->num; e++) PetscCall(OutputTextDestroy(&series->entry[e].text));
    PetscCall(PetscFree(series->entry));
  }
  PetscCall(PetscFree((*index)->step));
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

/* A new entry of a series, empty. */
static PetscErrorCode IndexEntry_Private(Index index, const char *name, PetscInt number, PetscInt step, PetscReal time, IndexEntry **entry)
{
  IndexSeries *series = NULL;

  PetscFunctionBegin;
  PetscCall(IndexSeries_Private(index, name, &series));
  if (series->num == series->size) {
    series->size = 2 * series->size + 8;
    PetscCall(PetscRealloc((size_t)series->size * sizeof(IndexEntry), &series->entry));
  }
  *entry  = &series->entry[series->num++];
  **entry = (IndexEntry){.number = number, .step = step, .time = time};
  if (number >= index->num_states) {
    PetscCall(PetscRealloc((size_t)(number + 1) * sizeof(PetscInt), &index->step));
    for (PetscInt i = index->num_states; i < number; i++) index->step[i] = -1; /* of a series that had lost its index */
    index->num_states = number + 1;
  }
  index->step[number] = step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Did adaptation go on in the same load step after this state? */
static PetscBool IsPassed_Private(Index index, PetscInt number)
{
  return (PetscBool)(number + 1 < index->num_states && index->step[number + 1] == index->step[number]);
}

PetscBool IndexHasPasses(Index index)
{
  for (PetscInt i = 0; i < index->num_states; i++)
    if (IsPassed_Private(index, i)) return PETSC_TRUE;
  return PETSC_FALSE;
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
  IndexEntry *entry = NULL;

  PetscFunctionBegin;
  PetscCall(IndexEntry_Private(index, grid, state->number, state->step, state->time, &entry));
  index->open       = &entry->text;
  index->num_points = num_points;
  index->num_cells  = num_cells;
  PetscCall(PetscSNPrintf(index->prefix, sizeof(index->prefix), "%s:/%s", file, grid));
  PetscCall(OutputTextPrint(index->open, "        <Information Name=\"time\" Value=\"%.17g\"/>\n", (double)state->time));
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
  index->open = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Series_Private(Index index, const IndexSeries *series, PetscBool passes, OutputText *text)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "    <Grid Name=\"%s\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", series->name));
  for (PetscInt e = 0; e < series->num; e++) {
    const IndexEntry *entry = &series->entry[e];

    if (!passes && IsPassed_Private(index, entry->number)) continue;
    PetscCall(OutputTextPrint(text, "      <Grid Name=\"%s\" GridType=\"Uniform\">\n        <Time Value=\"%.17g\"/>\n%s      </Grid>\n", series->name,
                              passes ? (double)entry->number : (double)entry->time, entry->text.text));
  }
  PetscCall(OutputTextPrint(text, "    </Grid>\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The grid named first comes last: VTK takes all collections, meshio's TimeSeriesReader only the last one, and the bulk is written first. */
PetscErrorCode IndexText(Index index, PetscBool passes, OutputText *text)
{
  PetscFunctionBegin;
  PetscCall(OutputTextPrint(text, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"));
  for (PetscInt i = index->num - 1; i >= 0; i--) {
    if (index->series[i].num) PetscCall(Series_Private(index, &index->series[i], passes, text));
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
  static const char begin[] = "\n      <Grid Name=", stop[] = "\n      </Grid>\n";
  IndexSeries      *series = NULL;
  char              name[MORTISE_NAME];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%.*s", (int)strcspn(text, "\""), text));
  PetscCall(IndexSeries_Private(index, name, &series)); /* one without entries, too: the order of the series stays */
  for (const char *at = strstr(text, begin); at && at < end; at = strstr(at + 1, begin)) {
    const char *to = strstr(at, stop), *from = strstr(at, "        <Information Name=\"time\"");
    IndexEntry *entry = NULL;
    double      t, of, file;

    *ours = (PetscBool)(to && to < end && from && from < to && Number_Private(from, to, "Name=\"time\" Value=\"", &t) &&
                        Number_Private(from, to, "Name=\"step\" Value=\"", &of) && Number_Private(from, to, ">fields_", &file) && file >= 0 && file < 1e8);
    if (!*ours || of > step) break;
    PetscCall(IndexEntry_Private(index, name, (PetscInt)file, (PetscInt)of, (PetscReal)t, &entry));
    PetscCall(OutputTextPrint(&entry->text, "%.*s", (int)(to + 1 - from), from));
    *num  = PetscMax(*num, (PetscInt)file + 1);
    *time = PetscMax(*time, (PetscReal)t);
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
