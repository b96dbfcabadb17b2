/* Reading a gmsh file on one rank: PETSc parses it; shapes, geometry in lexicographic order, and named groups are extracted here. */
#include "forestimpl.h"
#include <petscdmplextransform.h>
#include <petscfe.h>

typedef struct {
  PetscInt dim, tag;
  char     name[MORTISE_NAME];
} GroupName;

typedef struct {
  const ForestSpec *spec;
  const char       *told;    /* name of the file in messages */
  char             *message; /* sentence about wrong input, empty: fine */
  size_t            length;
  GroupName        *name; /* owned [num_names] physical names of the file */
  PetscInt          num_names;
  int               major; /* of the format version */
  PetscBool         binary, simplices;
  DM                dm;
  CoarseMesh       *mesh;
  PetscInt          first_vertex, *vertex_id; /* owned, coarse vertex of each DMPlex vertex */
  PetscInt          num_elements, *source;    /* in the file; owned, that of each cell, NULL: its own */
  PetscInt          num_facets, *facet_vertices;
  uint64_t         *facet_groups;
} Reader;

#define FAIL(r, ...) PetscFunctionReturn(PetscSNPrintf((r)->message, (r)->length, __VA_ARGS__))

/* ---- header and names ----------------------------------------------------------------------------------------------- */

/* Lines  dim tag "name"  up to the section's end. These lines are text in binary files too. */
static PetscErrorCode ReadNames_Private(Reader *r, FILE *file)
{
  char line[4 * MORTISE_NAME];
  int  num = 0;

  PetscFunctionBegin;
  if (!fgets(line, sizeof(line), file) || sscanf(line, "%d", &num) != 1 || num < 0)
    FAIL(r, "mesh file '%s' is damaged: its section $PhysicalNames has no count", r->told);
  if (r->name) FAIL(r, "mesh file '%s' is damaged: it has two sections $PhysicalNames", r->told);
  PetscCall(PetscCalloc1(num, &r->name));
  for (int i = 0; i < num; ++i) {
    int         dim, tag, start = 0;
    const char *open  = fgets(line, sizeof(line), file) ? strchr(line, '"') : NULL;
    char       *close = open ? strrchr(line, '"') : NULL;
    if (!close || close == open || sscanf(line, "%d %d %n", &dim, &tag, &start) != 2)
      FAIL(r, "mesh file '%s' is damaged: its section $PhysicalNames ends too early", r->told);
    if (open != line + start || !strchr(" \t", line[start - 1])) /* PETSc takes what stands there for the number's */
      FAIL(r, "mesh file '%s' is damaged: a line of $PhysicalNames is not  dimension number \"name\"", r->told);
    *close = 0;
    if (!TextIsPlain(open + 1, "")) FAIL(r, "mesh file '%s': the name \"%s\" of a physical group has a control character in it", r->told, open + 1);
    if (strlen(open + 1) >= MORTISE_NAME)
      FAIL(r, "mesh file '%s': the name \"%s\" of a physical group is longer than %d characters", r->told, open + 1, MORTISE_NAME - 1);
    r->name[r->num_names] = (GroupName){.dim = dim, .tag = tag};
    PetscCall(PetscStrncpy(r->name[r->num_names++].name, open + 1, MORTISE_NAME));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One number of a 4.1 file: the text of it, or `size` bytes. False at the end of the file. */
static PetscBool ReadNumber_Private(FILE *file, PetscBool binary, size_t size, double *value)
{
  int    i;
  size_t n;

  if (!binary) return (PetscBool)(fscanf(file, "%lf", value) == 1);
  if (size == sizeof(int) && fread(&i, size, 1, file) == 1)
    *value = i;
  else if (size == sizeof(n) && fread(&n, size, 1, file) == 1)
    *value = (double)n;
  else
    return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Section $Entities of 4.1: a physical group that names an entity backwards appears there with a negative tag, and DMPlex cannot keep the
   tag -1 (it means "no label" to it): that part of the group would silently be missing. A damaged section is left to the reader of the rest. */
static PetscErrorCode CheckEntities_Private(Reader *r, FILE *file, PetscBool binary)
{
  double count[4], number, num;

  PetscFunctionBegin;
  for (int d = 0; d < 4; ++d)
    if (!ReadNumber_Private(file, binary, sizeof(size_t), &count[d])) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < 4; ++d)
    for (double e = 0; e < count[d]; ++e) {
      if (!ReadNumber_Private(file, binary, sizeof(int), &number)) PetscFunctionReturn(PETSC_SUCCESS);
      for (int i = 0; i < (d ? 6 : 3); ++i) /* bounds */
        if (!ReadNumber_Private(file, binary, sizeof(size_t), &number)) PetscFunctionReturn(PETSC_SUCCESS);
      for (int list = 0; list < (d ? 2 : 1); ++list) { /* physical tags, then bounding entities */
        if (!ReadNumber_Private(file, binary, sizeof(size_t), &num)) PetscFunctionReturn(PETSC_SUCCESS);
        for (double i = 0; i < num; ++i) {
          if (!ReadNumber_Private(file, binary, sizeof(int), &number)) PetscFunctionReturn(PETSC_SUCCESS);
          if (list == 0 && number == -1)
            FAIL(
                r,
                "mesh file '%s': physical group 1 of dimension %d names an entity backwards; write it without the minus sign, or give the group another number",
                r->told, d);
        }
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ScanHeader_Private(Reader *r, FILE *file)
{
  char line[4 * MORTISE_NAME];
  int  minor = 0, binary = 0;

  PetscFunctionBegin;
  if (!fgets(line, sizeof(line), file) || strncmp(line, "$MeshFormat", 11))
    FAIL(r, "mesh file '%s' is not a gmsh file: it does not begin with $MeshFormat", r->told);
  if (!fgets(line, sizeof(line), file) || sscanf(line, "%d.%d %d", &r->major, &minor, &binary) < 1)
    FAIL(r, "mesh file '%s' is damaged: it has no format version", r->told);
  if (!(r->major == 2 && minor == 2) && !(r->major == 4 && minor == 1))
    FAIL(r, "mesh file '%s' has gmsh format version %d.%d; 2.2 and 4.1 can be read (gmsh -format msh41)", r->told, r->major, minor);
  r->binary = (PetscBool)(binary == 1);
  while (!r->message[0] && fgets(line, sizeof(line), file) && strncmp(line, "$Nodes", 6)) {
    if (!strncmp(line, "$PhysicalNames", 14))
      PetscCall(ReadNames_Private(r, file));
    else if (r->major == 4 && !strncmp(line, "$Entities", 9))
      PetscCall(CheckEntities_Private(r, file, (PetscBool)(binary == 1)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadHeader_Private(Reader *r)
{
  FILE          *file = fopen(r->spec->file, "rb");
  PetscErrorCode status;

  PetscFunctionBegin;
  if (!file) FAIL(r, "mesh file '%s' cannot be opened", r->told);
  status = ScanHeader_Private(r, file);
  fclose(file);
  PetscCall(status);
  if (r->message[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscBool fine;
  int64_t   range;
  PetscCall(ForestCheckGmsh(r->spec->file, r->major, r->binary, &fine, &range));
  if (!fine)
    FAIL(r,
         "mesh file '%s' is truncated or damaged: its nodes or elements are incomplete, two nodes have one number, a position is no finite number, or an "
         "element "
         "names a node twice or one that is not there",
         r->told);
  if (range)
    FAIL(r, "mesh file '%s': the numbers of its nodes go up to %lld; number them from 1 on (gmsh does when it writes format 4.1)", r->told, (long long)range);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- loading ---------------------------------------------------------------------------------------------------------- */

/* Keep the text of the first error and say nothing: the caller puts it in its own sentence. */
static PetscErrorCode KeepMessage_Private(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code, PetscErrorType type,
                                          const char *message, void *context)
{
  char *kept = (char *)context;
  if (type == PETSC_ERROR_INITIAL && message && !kept[0]) strncpy(kept, message, 255);
  return code;
}

/* All physical tags of a point (in version 2.2 a second tag is the elementary one; there an element of two groups occurs twice), positions in
   space, no identification of periodic sides; an options database of our own keeps the user's out. */
static PetscErrorCode LoadWithOptions_Private(const char *file, int major, PetscBool curved, DM *dm)
{
  PetscOptions options;

  PetscFunctionBegin;
  PetscCall(PetscOptionsCreate(&options));
  PetscCall(PetscOptionsSetValue(options, "-dm_plex_gmsh_multiple_tags", major == 2 ? "0" : "1"));
  PetscCall(PetscOptionsSetValue(options, "-dm_plex_gmsh_periodic", "0"));
  PetscCall(PetscOptionsSetValue(options, "-dm_plex_gmsh_spacedim", "3"));
  if (!curved) PetscCall(PetscOptionsSetValue(options, "-dm_plex_gmsh_highorder", "0"));
  PetscCall(PetscOptionsPush(options));
  const PetscErrorCode status = DMPlexCreateGmshFromFile(PETSC_COMM_SELF, file, PETSC_TRUE, dm);
  PetscCall(PetscOptionsPop());
  PetscCall(PetscOptionsDestroy(&options));
  PetscFunctionReturn(status);
}

static PetscErrorCode Load_Private(Reader *r, PetscBool curved)
{
  char text[256] = "";

  PetscFunctionBegin;
  PetscCall(DMDestroy(&r->dm));
  PetscCall(PetscPushErrorHandler(KeepMessage_Private, text));
  GuardBegin("mesh file '%s' is damaged: its numbers contradict each other", r->told); /* what ForestCheckGmsh does not see: binary entities, say */
  const PetscErrorCode status = LoadWithOptions_Private(r->spec->file, r->major, curved, &r->dm);
  GuardEnd();
  PetscCall(PetscPopErrorHandler());
  if (status) {
    r->dm = NULL;
    if (strstr(text, "partially interpolated")) FAIL(r, "mesh file '%s' has no cells of dimension %" PetscInt_FMT, r->told, r->spec->dim);
    static const char unknown[] = "Plex facet for Gmsh element ";
    const char       *element   = strstr(text, unknown);
    if (element)
      FAIL(r,
           "mesh file '%s': element %d of a boundary group is no facet of a cell: the two have vertices of their own there, as where surfaces of a .geo lie on "
           "one another and do not share points and lines (Coherence; joins them; Geometry.AutoCoherence = 0 keeps what is extruded apart)",
           r->told, atoi(element + sizeof(unknown) - 1));
    FAIL(r, "mesh file '%s' cannot be read, it may be truncated or damaged (%s)", r->told, text[0] ? text : "no reason known");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Order of the coordinate field: 1 when there is none. */
static PetscErrorCode GeometryOrder_Private(DM dm, PetscInt *order)
{
  DM           cdm;
  PetscObject  field;
  PetscClassId id;
  PetscSpace   space;
  PetscInt     num_fields;

  PetscFunctionBegin;
  *order = 1;
  PetscCall(DMGetCoordinateDM(dm, &cdm));
  PetscCall(DMGetNumFields(cdm, &num_fields));
  if (num_fields == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMGetField(cdm, 0, NULL, &field));
  PetscCall(PetscObjectGetClassId(field, &id));
  if (id != PETSCFE_CLASSID) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFEGetBasisSpace((PetscFE)field, &space));
  PetscCall(PetscSpaceGetDegree(space, order, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which shapes occur. */
static PetscErrorCode FindShapes_Private(Reader *r, PetscBool *box, PetscBool *simplex, const char **other)
{
  PetscInt start, end;

  PetscFunctionBegin;
  *box = *simplex = PETSC_FALSE;
  *other          = NULL;
  PetscCall(DMPlexGetHeightStratum(r->dm, 0, &start, &end));
  for (PetscInt c = start; c < end; ++c) {
    DMPolytopeType type;
    PetscCall(DMPlexGetCellType(r->dm, c, &type));
    if (type == DM_POLYTOPE_QUADRILATERAL || type == DM_POLYTOPE_HEXAHEDRON)
      *box = PETSC_TRUE;
    else if (type == DM_POLYTOPE_TRIANGLE || type == DM_POLYTOPE_TETRAHEDRON)
      *simplex = PETSC_TRUE;
    else
      *other = DMPolytopeTypes[type];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckDimension_Private(Reader *r)
{
  PetscInt dim, start, end;

  PetscFunctionBegin;
  PetscCall(DMGetDimension(r->dm, &dim));
  PetscCall(DMPlexGetHeightStratum(r->dm, 0, &start, &end));
  if (end == start || dim < r->spec->dim) FAIL(r, "mesh file '%s' has no cells of dimension %" PetscInt_FMT, r->told, r->spec->dim);
  if (dim > r->spec->dim)
    FAIL(r, "mesh file '%s' has cells of dimension %" PetscInt_FMT ", but a mesh of dimension %" PetscInt_FMT " is asked for", r->told, dim, r->spec->dim);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Triangles and tetrahedra are cut into quads and hexes, with straight sides: PETSc 3.18 cannot carry curvature through. */
static PetscErrorCode Convert_Private(Reader *r)
{
  DMPlexTransform transform;
  DM              converted = NULL;
  DMPolytopeType  from, to;
  PetscInt        start, end, replica;

  PetscFunctionBegin;
  if (!r->simplices) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMPlexTransformCreate(PETSC_COMM_SELF, &transform));
  PetscCall(DMPlexTransformSetType(transform, DMPLEXREFINETOBOX));
  PetscCall(DMPlexTransformSetDM(transform, r->dm));
  PetscCall(DMPlexTransformSetUp(transform));
  PetscCall(DMPlexTransformApply(transform, r->dm, &converted));
  PetscCall(DMPlexGetHeightStratum(converted, 0, &start, &end));
  PetscCall(PetscMalloc1(end - start, &r->source));
  for (PetscInt c = start; c < end; ++c) PetscCall(DMPlexTransformGetSourcePoint(transform, c, &from, &to, &r->source[c - start], &replica));
  PetscCall(DMPlexTransformDestroy(&transform));
  PetscCall(DMDestroy(&r->dm));
  r->dm = converted;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LoadShapes_Private(Reader *r)
{
  PetscBool   box, simplex, hybrid = PETSC_FALSE;
  PetscInt    order = 1;
  const char *other;

  PetscFunctionBegin;
  PetscCall(Load_Private(r, PETSC_TRUE));
  if (r->message[0]) { /* curved meshes of more than one shape are refused; straight ones can be read */
    char first[1024];
    PetscCall(PetscStrncpy(first, r->message, sizeof(first)));
    r->message[0] = 0;
    PetscCall(Load_Private(r, PETSC_FALSE));
    if (r->message[0]) FAIL(r, "%s", first);
    hybrid = PETSC_TRUE;
  }
  PetscCall(CheckDimension_Private(r));
  if (r->message[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FindShapes_Private(r, &box, &simplex, &other));
  PetscCall(DMPlexGetHeightStratum(r->dm, 0, NULL, &r->num_elements));
  if (other) FAIL(r, "mesh file '%s' has cells of shape '%s'; only quads, hexes, triangles and tetrahedra can be used", r->told, other);
  if (!simplex) PetscFunctionReturn(PETSC_SUCCESS);
  if (box && r->spec->dim == 3)
    FAIL(r, "mesh file '%s' has hexes and tetrahedra in one mesh; use either, or let gmsh make hexes of all (Mesh.SubdivisionAlgorithm = 2)", r->told);
  if (!hybrid) {
    PetscCall(GeometryOrder_Private(r->dm, &order));
    if (order > 1) PetscCall(Load_Private(r, PETSC_FALSE));
    if (r->message[0]) PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (hybrid || order > 1)
    fprintf(stderr,
            "mortise: note: mesh file '%s': curved triangles or tetrahedra are cut into %s with straight sides; gmsh's Mesh.SubdivisionAlgorithm keeps the "
            "curvature\n",
            r->told, r->spec->dim == 2 ? "quads" : "hexes");
  r->simplices            = PETSC_TRUE;
  r->mesh->from_simplices = (PetscBool)(r->spec->dim == 3);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- cells ------------------------------------------------------------------------------------------------------------ */

/* Vertices of a cell in lexicographic order from DMPlex's cyclic one (hexes: bottom clockwise, top counterclockwise, both from the origin). */
static PetscErrorCode CellVertices_Private(DM dm, PetscInt dim, PetscInt cell, PetscInt first_vertex, PetscInt end_vertex, PetscInt vertex[])
{
  static const PetscInt quad[4] = {0, 1, 3, 2}, hex[8] = {0, 3, 1, 2, 4, 5, 7, 6};
  PetscInt             *closure = NULL, size, cyclic[8], n = 0;

  PetscFunctionBegin;
  PetscCall(DMPlexGetTransitiveClosure(dm, cell, PETSC_TRUE, &size, &closure));
  for (PetscInt i = 0; i < size; ++i)
    if (closure[2 * i] >= first_vertex && closure[2 * i] < end_vertex && n < 8) cyclic[n++] = closure[2 * i];
  PetscCall(DMPlexRestoreTransitiveClosure(dm, cell, PETSC_TRUE, &size, &closure));
  PetscCheck(n == 1 << dim, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Cell %" PetscInt_FMT " has %" PetscInt_FMT " vertices", cell, n);
  for (PetscInt i = 0; i < n; ++i) vertex[i] = cyclic[dim == 2 ? quad[i] : hex[i]];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is needed to read one cell after another. */
typedef struct {
  PetscInt           dim, q, n; /* order and number of geometry nodes */
  PetscInt           first_vertex, end_vertex;
  DM                 dm, cdm;
  PetscSection       section, tensor; /* borrowed, owned */
  Vec                coordinates;
  const PetscScalar *x;
} CellReader;

/* Order q >= 2: the corners of the geometry tell which vertex is where. Positions are copies of the same numbers, hence equal. */
static PetscErrorCode SortVertices_Private(const CellReader *k, const PetscReal position[][3], const PetscReal geometry[], PetscInt vertex[])
{
  const PetscInt q = k->q, corners = 1 << k->dim;
  PetscInt       sorted[8];

  PetscFunctionBegin;
  for (PetscInt i = 0; i < corners; ++i) {
    const PetscInt   at = (i & 1 ? q : 0) + (i & 2 ? q * (q + 1) : 0) + (i & 4 ? q * (q + 1) * (q + 1) : 0);
    const PetscReal *X  = &geometry[3 * at];
    PetscInt         v  = 0;
    while (v < corners && (X[0] != position[v][0] || X[1] != position[v][1] || X[2] != position[v][2])) ++v;
    PetscCheck(v < corners, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Corner of a curved cell is not one of its vertices");
    sorted[i] = vertex[v];
  }
  PetscCall(PetscArraycpy(vertex, sorted, corners));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Vertices (as DMPlex points) and geometry of a cell; beyond order 1 the closure in the coordinate field, permuted to tensor order. */
static PetscErrorCode ReadCell_Private(const CellReader *k, PetscInt cell, PetscInt vertex[], PetscReal geometry[])
{
  PetscReal    position[8][3];
  PetscScalar *values = NULL;
  PetscInt     size   = 0, offset;

  PetscFunctionBegin;
  PetscCall(CellVertices_Private(k->dm, k->dim, cell, k->first_vertex, k->end_vertex, vertex));
  for (PetscInt i = 0; i < 1 << k->dim; ++i) {
    PetscCall(PetscSectionGetOffset(k->section, vertex[i], &offset));
    for (PetscInt c = 0; c < 3; ++c) position[i][c] = PetscRealPart(k->x[offset + c]);
  }
  if (k->q == 1) {
    PetscCall(PetscArraycpy(geometry, &position[0][0], 3 * k->n));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(DMPlexVecGetClosure(k->cdm, k->tensor, k->coordinates, cell, &size, &values));
  PetscCheck(size == 3 * k->n, PETSC_COMM_SELF, PETSC_ERR_PLIB, "Cell %" PetscInt_FMT " has %" PetscInt_FMT " coordinates, not %" PetscInt_FMT, cell, size,
             3 * k->n);
  for (PetscInt i = 0; i < size; ++i) geometry[i] = PetscRealPart(values[i]);
  PetscCall(DMPlexVecRestoreClosure(k->cdm, k->tensor, k->coordinates, cell, &size, &values));
  PetscCall(SortVertices_Private(k, (const PetscReal(*)[3])position, geometry, vertex));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadCells_Private(Reader *r)
{
  CoarseMesh *mesh = r->mesh;
  CellReader  k    = {.dim = r->spec->dim, .dm = r->dm};
  PetscInt    start, end;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(r->dm, 0, &start, &end));
  PetscCall(DMPlexGetDepthStratum(r->dm, 0, &k.first_vertex, &k.end_vertex));
  PetscCall(GeometryOrder_Private(r->dm, &k.q));
  if (k.q > FOREST_MAX_ORDER) FAIL(r, "mesh file '%s' has cells of order %" PetscInt_FMT "; the highest is %d", r->told, k.q, FOREST_MAX_ORDER);
  k.n                  = k.dim == 2 ? (k.q + 1) * (k.q + 1) : (k.q + 1) * (k.q + 1) * (k.q + 1);
  mesh->dim            = k.dim;
  mesh->num_cells      = end - start;
  mesh->geometry_order = k.q;
  PetscCall(PetscMalloc1(mesh->num_cells << k.dim, &mesh->cell_vertices));
  PetscCall(PetscMalloc1(3 * k.n * mesh->num_cells, &mesh->cell_geometry));
  PetscCall(DMGetCoordinatesLocalSetUp(r->dm));
  PetscCall(DMGetCoordinatesLocal(r->dm, &k.coordinates));
  PetscCall(DMGetCoordinateDM(r->dm, &k.cdm));
  PetscCall(DMGetCoordinateSection(r->dm, &k.section));
  PetscCall(PetscSectionClone(k.section, &k.tensor));
  if (k.q > 1) PetscCall(DMPlexSetClosurePermutationTensor(k.cdm, 0, k.tensor));
  PetscCall(VecGetArrayRead(k.coordinates, &k.x));
  for (PetscInt c = 0; c < mesh->num_cells; ++c)
    PetscCall(ReadCell_Private(&k, start + c, &mesh->cell_vertices[c << k.dim], &mesh->cell_geometry[3 * k.n * c]));
  PetscCall(VecRestoreArrayRead(k.coordinates, &k.x));
  PetscCall(PetscSectionDestroy(&k.tensor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number the vertices that cells use; others (arc centres) are dropped. */
static PetscErrorCode NumberVertices_Private(Reader *r)
{
  CoarseMesh    *mesh = r->mesh;
  const PetscInt size = mesh->num_cells << mesh->dim;
  PetscInt       end;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(r->dm, 0, &r->first_vertex, &end));
  PetscCall(PetscMalloc1(end - r->first_vertex, &r->vertex_id));
  for (PetscInt v = 0; v < end - r->first_vertex; ++v) r->vertex_id[v] = -1;
  for (PetscInt i = 0; i < size; ++i) r->vertex_id[mesh->cell_vertices[i] - r->first_vertex] = 0;
  mesh->num_vertices = 0;
  for (PetscInt v = 0; v < end - r->first_vertex; ++v)
    if (r->vertex_id[v] == 0) r->vertex_id[v] = mesh->num_vertices++;
  for (PetscInt i = 0; i < size; ++i) mesh->cell_vertices[i] = r->vertex_id[mesh->cell_vertices[i] - r->first_vertex];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mirror a cell that is turned inside out as a whole (a surface whose loop runs clockwise): exchange its first two axes. */
static void Mirror_Private(CoarseMesh *mesh, PetscInt cell)
{
  const PetscInt q = mesh->geometry_order, n = q + 1, nz = mesh->dim == 3 ? n : 1, corners = 1 << mesh->dim;
  PetscReal     *geometry = &mesh->cell_geometry[3 * n * n * nz * cell];
  PetscInt      *vertex   = &mesh->cell_vertices[corners * cell];

  for (PetscInt v = 1; v < corners; v += 4) {
    const PetscInt swap = vertex[v];
    vertex[v]           = vertex[v + 1];
    vertex[v + 1]       = swap;
  }
  for (PetscInt k = 0; k < nz; ++k)
    for (PetscInt j = 0; j < n; ++j)
      for (PetscInt i = 0; i < j; ++i)
        for (PetscInt c = 0; c < 3; ++c) {
          PetscReal *a = &geometry[3 * (i + n * (j + n * k)) + c], *b = &geometry[3 * (j + n * (i + n * k)) + c], swap = *a;
          *a = *b;
          *b = swap;
        }
}

/* Plane meshes lie in a plane of constant z, which is then 0; cells get a positive Jacobian where a mirror image suffices. */
static PetscErrorCode Orient_Private(Reader *r)
{
  CoarseMesh    *mesh = r->mesh;
  const PetscInt q1 = mesh->geometry_order + 1, size = mesh->num_cells * q1 * q1 * (mesh->dim == 3 ? q1 : 1);

  PetscFunctionBegin;
  if (mesh->dim == 2) {
    const PetscReal z      = mesh->cell_geometry[2];
    PetscReal       extent = 0;
    for (PetscInt i = 0; i < size; ++i) extent = PetscMax(extent, PetscAbsReal(mesh->cell_geometry[3 * i] - mesh->cell_geometry[0]));
    for (PetscInt i = 0; i < size; ++i) {
      if (PetscAbsReal(mesh->cell_geometry[3 * i + 2] - z) > 1e-9 * extent)
        FAIL(r, "mesh file '%s' is not plane: a mesh of dimension 2 must have one z for all points, here %g and %g occur", r->told, (double)z,
             (double)mesh->cell_geometry[3 * i + 2]);
      mesh->cell_geometry[3 * i + 2] = 0;
    }
  }
  for (PetscInt c = 0; c < mesh->num_cells; ++c)
    if (ForestCoarseJacobianSign(mesh, c) < 0) Mirror_Private(mesh, c);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- groups ----------------------------------------------------------------------------------------------------------- */

/* Name of a physical group; without one its tag. The sign only tells that an entity was named backwards. */
static PetscErrorCode NameOf_Private(const Reader *r, PetscInt dim, PetscInt tag, char name[MORTISE_NAME])
{
  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(name, MORTISE_NAME, "%" PetscInt_FMT, PetscAbsInt(tag)));
  for (PetscInt i = 0; i < r->num_names; ++i)
    if (r->name[i].dim == dim && r->name[i].tag == PetscAbsInt(tag)) PetscCall(PetscStrncpy(name, r->name[i].name, MORTISE_NAME));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Index of a name in a list of *num names, entered at the end if it is new: tags of one name are one group. */
static PetscErrorCode Enter_Private(char (*list)[MORTISE_NAME], PetscInt *num, const char name[], PetscInt *index)
{
  PetscBool same = PETSC_FALSE;

  PetscFunctionBegin;
  for (*index = 0; *index < *num; ++*index) {
    PetscCall(PetscStrcmp(list[*index], name, &same));
    if (same) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscStrncpy(list[(*num)++], name, MORTISE_NAME));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tags in a label, ascending in absolute value, without 0 (elements saved though they are in no group); none when there is no label. */
static PetscErrorCode LabelTags_Private(DM dm, const char label_name[], DMLabel *label, PetscInt *num, PetscInt **tags)
{
  IS              values;
  const PetscInt *v;

  PetscFunctionBegin;
  *num  = 0;
  *tags = NULL;
  PetscCall(DMGetLabel(dm, label_name, label));
  if (!*label) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DMLabelGetValueIS(*label, &values));
  PetscCall(ISGetLocalSize(values, num));
  PetscCall(PetscMalloc1(*num, tags));
  PetscCall(ISGetIndices(values, &v));
  const PetscInt all = *num;
  *num               = 0;
  for (PetscInt i = 0; i < all; ++i) {
    PetscInt at = *num;
    if (v[i] == 0) continue;
    for (; at > 0 && PetscAbsInt((*tags)[at - 1]) > PetscAbsInt(v[i]); --at) (*tags)[at] = (*tags)[at - 1];
    (*tags)[at] = v[i];
    ++*num;
  }
  PetscCall(ISRestoreIndices(values, &v));
  PetscCall(ISDestroy(&values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Points with a tag; the caller frees them. */
static PetscErrorCode TaggedPoints_Private(DMLabel label, PetscInt tag, PetscInt *num, PetscInt **points)
{
  IS              set;
  const PetscInt *p;

  PetscFunctionBegin;
  *num    = 0;
  *points = NULL;
  PetscCall(DMLabelGetStratumIS(label, tag, &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ISGetLocalSize(set, num));
  PetscCall(PetscMalloc1(*num, points));
  PetscCall(ISGetIndices(set, &p));
  PetscCall(PetscArraycpy(*points, p, *num));
  PetscCall(ISRestoreIndices(set, &p));
  PetscCall(ISDestroy(&set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBodies_Private(Reader *r)
{
  CoarseMesh *mesh = r->mesh;
  DMLabel     label;
  PetscInt    num, *tags, start, end, body, num_points, *point;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(r->dm, 0, &start, &end));
  PetscCall(LabelTags_Private(r->dm, "Cell Sets", &label, &num, &tags));
  PetscCall(PetscMalloc1(mesh->num_cells, &mesh->cell_body));
  PetscCall(PetscCalloc1(num, &mesh->body_name));
  for (PetscInt c = 0; c < mesh->num_cells; ++c) mesh->cell_body[c] = -1;
  for (PetscInt i = 0; i < num; ++i) {
    char name[MORTISE_NAME];
    PetscCall(NameOf_Private(r, mesh->dim, tags[i], name));
    PetscCall(Enter_Private(mesh->body_name, &mesh->num_bodies, name, &body));
    PetscCall(TaggedPoints_Private(label, tags[i], &num_points, &point));
    for (PetscInt k = 0; k < num_points; ++k) {
      if (point[k] < start || point[k] >= end) continue;
      PetscInt *b = &mesh->cell_body[point[k] - start];
      if (*b >= 0 && *b != body) FAIL(r, "mesh file '%s': a cell is in two bodies, \"%s\" and \"%s\"", r->told, mesh->body_name[*b], name);
      *b = body;
    }
    PetscCall(PetscFree(point));
  }
  PetscCall(PetscFree(tags));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Vertices of a facet as coarse ids. A facet between cells is never made of other vertices than theirs. */
static PetscErrorCode FacetVertices_Private(const Reader *r, PetscInt facet, PetscInt vertices[])
{
  PetscInt *closure = NULL, size, n = 0, end;

  PetscFunctionBegin;
  PetscCall(DMPlexGetDepthStratum(r->dm, 0, NULL, &end));
  PetscCall(DMPlexGetTransitiveClosure(r->dm, facet, PETSC_TRUE, &size, &closure));
  for (PetscInt i = 0; i < size; ++i)
    if (closure[2 * i] >= r->first_vertex && closure[2 * i] < end) vertices[n++] = r->vertex_id[closure[2 * i] - r->first_vertex];
  PetscCall(DMPlexRestoreTransitiveClosure(r->dm, facet, PETSC_TRUE, &size, &closure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Middle of the vertices of a cell. */
static PetscErrorCode Middle_Private(DM dm, PetscInt cell, PetscReal X[3])
{
  Vec                coordinates;
  PetscSection       section;
  const PetscScalar *x;
  PetscInt          *closure = NULL, size, first, end, at, num = 0;

  PetscFunctionBegin;
  X[0] = X[1] = X[2] = 0;
  PetscCall(DMGetCoordinatesLocal(dm, &coordinates));
  PetscCall(DMGetCoordinateSection(dm, &section));
  PetscCall(DMPlexGetDepthStratum(dm, 0, &first, &end));
  PetscCall(VecGetArrayRead(coordinates, &x));
  PetscCall(DMPlexGetTransitiveClosure(dm, cell, PETSC_TRUE, &size, &closure));
  for (PetscInt i = 0; i < size; ++i) {
    if (closure[2 * i] < first || closure[2 * i] >= end) continue;
    PetscCall(PetscSectionGetOffset(section, closure[2 * i], &at));
    for (PetscInt d = 0; d < 3; ++d) X[d] += PetscRealPart(x[at + d]);
    ++num;
  }
  PetscCall(DMPlexRestoreTransitiveClosure(dm, cell, PETSC_TRUE, &size, &closure));
  PetscCall(VecRestoreArrayRead(coordinates, &x));
  for (PetscInt d = 0; d < 3; ++d) X[d] /= num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An element of a boundary group that joins vertices of a cell but is none of its facets, as a diagonal: DMPlex takes the cell itself for it. */
static PetscErrorCode CheckFacets_Private(Reader *r)
{
  DMLabel  label;
  PetscInt num, *tags, num_points, *point, start, end, cell = -1;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(r->dm, 0, &start, &end));
  PetscCall(LabelTags_Private(r->dm, "Face Sets", &label, &num, &tags));
  for (PetscInt i = 0; i < num && cell < 0; ++i) {
    char      name[MORTISE_NAME];
    PetscReal X[3];
    PetscCall(TaggedPoints_Private(label, tags[i], &num_points, &point));
    for (PetscInt k = 0; k < num_points && cell < 0; ++k)
      if (point[k] >= start && point[k] < end) cell = point[k];
    PetscCall(PetscFree(point));
    if (cell < 0) continue;
    PetscCall(NameOf_Private(r, r->spec->dim - 1, tags[i], name));
    PetscCall(Middle_Private(r->dm, cell, X));
    (void)snprintf(r->message, r->length,
                   "mesh file '%s': an element of boundary group '%s' joins nodes of the cell at (%g, %g, %g) and is none of its facets, as a diagonal",
                   r->told, name, (double)X[0], (double)X[1], (double)X[2]);
  }
  PetscCall(PetscFree(tags));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Bits of the boundary groups on every facet. mask: one word for each facet. */
static PetscErrorCode MarkFacets_Private(Reader *r, PetscInt start, PetscInt end, uint64_t mask[])
{
  static const char *const reserved[] = {"depth", "celltype", "body"};
  CoarseMesh              *mesh       = r->mesh;
  DMLabel                  label;
  PetscInt                 num, *tags, bit, num_points, *point;

  PetscFunctionBegin;
  PetscCall(LabelTags_Private(r->dm, "Face Sets", &label, &num, &tags));
  PetscCall(PetscCalloc1(num, &mesh->boundary_name));
  for (PetscInt i = 0; i < num; ++i) {
    char name[MORTISE_NAME];
    PetscCall(NameOf_Private(r, mesh->dim - 1, tags[i], name));
    for (PetscInt k = 0; k < 3; ++k)
      if (!strcmp(name, reserved[k])) FAIL(r, "mesh file '%s': a boundary group cannot be called \"%s\", that name is reserved", r->told, name);
    PetscCall(Enter_Private(mesh->boundary_name, &mesh->num_boundaries, name, &bit));
    if (bit >= 64) FAIL(r, "mesh file '%s' has more than 64 boundary groups", r->told);
    PetscCall(TaggedPoints_Private(label, tags[i], &num_points, &point));
    for (PetscInt k = 0; k < num_points; ++k)
      if (point[k] >= start && point[k] < end) mask[point[k] - start] |= (uint64_t)1 << bit;
    PetscCall(PetscFree(point));
  }
  PetscCall(PetscFree(tags));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBoundaries_Private(Reader *r)
{
  const PetscInt corners = 1 << (r->spec->dim - 1);
  PetscInt       start, end;
  uint64_t      *mask;

  PetscFunctionBegin;
  PetscCall(DMPlexGetHeightStratum(r->dm, 1, &start, &end));
  PetscCall(PetscCalloc1(end - start, &mask));
  PetscCall(MarkFacets_Private(r, start, end, mask));
  PetscCall(PetscMalloc1(corners * (end - start), &r->facet_vertices));
  PetscCall(PetscMalloc1(end - start, &r->facet_groups));
  for (PetscInt f = start; f < end && !r->message[0]; ++f) {
    if (!mask[f - start]) continue;
    PetscCall(FacetVertices_Private(r, f, &r->facet_vertices[corners * r->num_facets]));
    r->facet_groups[r->num_facets++] = mask[f - start];
  }
  PetscCall(PetscFree(mask));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadFields_Private(Reader *r)
{
  const char *damage;

  PetscFunctionBegin;
  if (r->binary) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForestReadFields(r->spec->file, r->major, r->num_elements, r->source, r->mesh, &damage));
  if (damage) FAIL(r, "mesh file '%s' %s", r->told, damage);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestReadGmsh(const ForestSpec *spec, CoarseMesh *mesh, PetscInt *num_facets, PetscInt **facet_vertices, uint64_t **facet_groups, size_t length,
                              char message[])
{
  static PetscErrorCode (*const step[])(Reader *) = {ReadHeader_Private,     LoadShapes_Private, CheckFacets_Private,    Convert_Private,
                                                     ReadCells_Private,      Orient_Private,     NumberVertices_Private, ReadBodies_Private,
                                                     ReadBoundaries_Private, ReadFields_Private};
  Reader r = {.spec = spec, .told = spec->told[0] ? spec->told : spec->file, .message = message, .length = length, .mesh = mesh};

  PetscFunctionBegin;
  message[0] = 0;
  *mesh      = (CoarseMesh){0};
  for (size_t i = 0; i < sizeof(step) / sizeof(step[0]) && !message[0]; ++i) PetscCall(step[i](&r));
  PetscCall(DMDestroy(&r.dm));
  PetscCall(PetscFree(r.name));
  PetscCall(PetscFree(r.vertex_id));
  PetscCall(PetscFree(r.source));
  *num_facets     = r.num_facets;
  *facet_vertices = r.facet_vertices;
  *facet_groups   = r.facet_groups;
  PetscFunctionReturn(PETSC_SUCCESS);
}
