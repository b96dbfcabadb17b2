/* Vectors that a gmsh file gives for its elements: the views $ElementData of three components, which PETSc passes over. ASCII only. */
#include "forestimpl.h"

typedef struct {
  int64_t  tag;
  PetscInt element; /* as DMPlex counts the elements of the highest dimension */
} Element;

typedef struct {
  const char *damage; /* what is wrong with the file, NULL: nothing */
  FILE       *file;
  int         major;
  PetscInt    dim, num, size, num_fields;
  PetscInt    simplices;            /* how many of them, which DMPlex numbers before quads and hexes */
  Element    *element;              /* owned [num], sorted by tag once all are known */
  char (*field_name)[MORTISE_NAME]; /* owned [num_fields] */
  PetscReal *value;                 /* owned [num_fields][num][3], NaN: no value */
} Fields;

/* Dimension of a type of element among those that are cells; simplex: triangle or tetrahedron. */
static PetscInt TypeDimension_Private(long type, PetscBool *simplex)
{
  static const long kind[4][12] = {{2, 9, 21, 23, 25}, {3, 10, 36, 37, 38}, {4, 11, 29, 30, 31}, {5, 12, 92, 93, 94}};

  for (int k = 0; k < 4; ++k)
    for (int i = 0; kind[k][i]; ++i) {
      *simplex = (PetscBool)(k % 2 == 0);
      if (kind[k][i] == type) return 2 + k / 2;
    }
  return 0;
}

static void SkipLine_Private(FILE *file)
{
  for (int c = getc(file); c != '\n' && c != EOF;) c = getc(file);
}

/* To the line after the next one that begins with `section`. */
static PetscBool Find_Private(FILE *file, const char *section)
{
  char line[256];

  while (fgets(line, sizeof(line), file))
    if (!strncmp(line, section, strlen(section)) && strchr(" \r\n", line[strlen(section)])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Enter an element, quads and hexes from -1 down: they come after the simplices, whose number is not known yet. */
static PetscErrorCode Enter_Private(Fields *f, long type, long tag)
{
  PetscBool simplex;

  PetscFunctionBegin;
  if (TypeDimension_Private(type, &simplex) != f->dim) PetscFunctionReturn(PETSC_SUCCESS);
  if (f->num == f->size) {
    f->size = PetscMax(1024, 2 * f->size);
    PetscCall(PetscRealloc((size_t)f->size * sizeof(Element), &f->element));
  }
  f->element[f->num] = (Element){.tag = tag, .element = simplex ? f->simplices : f->simplices - f->num - 1};
  f->simplices += simplex;
  ++f->num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CompareElements_Private(const void *a, const void *b)
{
  const int64_t x = ((const Element *)a)->tag, y = ((const Element *)b)->tag;
  return x < y ? -1 : x > y;
}

/* The section $Elements, which ForestCheckGmsh found whole. */
static PetscErrorCode ReadElements_Private(Fields *f)
{
  long blocks = 1, num = 0, type = 0, tag;

  PetscFunctionBegin;
  f->damage = "has no elements";
  if (!Find_Private(f->file, "$Elements") || fscanf(f->file, "%ld", f->major == 2 ? &num : &blocks) != 1) PetscFunctionReturn(PETSC_SUCCESS);
  SkipLine_Private(f->file);
  for (long b = 0; b < blocks; ++b) {
    if (f->major == 4 && fscanf(f->file, "%*d %*d %ld %ld", &type, &num) != 2) PetscFunctionReturn(PETSC_SUCCESS);
    for (long e = 0; e < num; ++e) {
      if (fscanf(f->file, "%ld", &tag) != 1 || (f->major == 2 && fscanf(f->file, "%ld", &type) != 1)) PetscFunctionReturn(PETSC_SUCCESS);
      SkipLine_Private(f->file);
      PetscCall(Enter_Private(f, type, tag));
    }
  }
  f->damage = NULL;
  for (PetscInt i = 0; i < f->num; ++i)
    if (f->element[i].element < 0) f->element[i].element = f->simplices - 1 - f->element[i].element;
  qsort(f->element, (size_t)f->num, sizeof(Element), CompareElements_Private);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* String tags (the first is the name), real tags, integer tags (the second and third: components, elements) of a view. */
static PetscBool ReadTags_Private(FILE *file, char name[MORTISE_NAME], long *components, long *num)
{
  char line[4 * MORTISE_NAME];
  long strings, reals, integers;

  name[0] = 0;
  if (fscanf(file, "%ld", &strings) != 1) return PETSC_FALSE;
  SkipLine_Private(file);
  for (long i = 0; i < strings; ++i) {
    if (!fgets(line, sizeof(line), file)) return PETSC_FALSE;
    if (i == 0) (void)sscanf(line, " \"%63[^\"]", name);
  }
  if (fscanf(file, "%ld", &reals) != 1) return PETSC_FALSE;
  for (long i = 0; i < reals; ++i)
    if (fscanf(file, "%*s") == EOF) return PETSC_FALSE;
  if (fscanf(file, "%ld %*d %ld %ld", &integers, components, num) != 3 || integers < 3) return PETSC_FALSE;
  for (long i = 3; i < integers; ++i)
    if (fscanf(file, "%*d") == EOF) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* One view; elements of lower dimension are skipped. */
static PetscErrorCode ReadView_Private(Fields *f)
{
  char name[MORTISE_NAME];
  long components, num, tag;

  PetscFunctionBegin;
  f->damage = "has a section $ElementData without its tags";
  if (!ReadTags_Private(f->file, name, &components, &num)) PetscFunctionReturn(PETSC_SUCCESS);
  f->damage = NULL;
  if (components != 3) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscRealloc((size_t)(f->num_fields + 1) * sizeof(*f->field_name), &f->field_name));
  PetscCall(PetscRealloc((size_t)(f->num_fields + 1) * (size_t)f->num * 3 * sizeof(PetscReal), &f->value));
  PetscCall(PetscStrncpy(f->field_name[f->num_fields], name, MORTISE_NAME));
  PetscReal *value = f->value + 3 * f->num * f->num_fields++;
  for (PetscInt i = 0; i < 3 * f->num; ++i) value[i] = NAN;
  for (long e = 0; e < num; ++e) {
    double v[3];
    f->damage = "has a section $ElementData that ends too early";
    if (fscanf(f->file, "%ld %lf %lf %lf", &tag, &v[0], &v[1], &v[2]) != 4) PetscFunctionReturn(PETSC_SUCCESS);
    const Element *found = bsearch(&(Element){.tag = tag}, f->element, (size_t)f->num, sizeof(Element), CompareElements_Private);
    f->damage            = NULL;
    for (int c = 0; c < 3 && found; ++c) value[3 * found->element + c] = v[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the elements of the file to the cells of the mesh. */
static PetscErrorCode ToCells_Private(const Fields *f, const PetscInt source[], CoarseMesh *mesh)
{
  PetscFunctionBegin;
  PetscCall(PetscMalloc1(f->num_fields, &mesh->field_name));
  PetscCall(PetscMalloc1(3 * f->num_fields * mesh->num_cells, &mesh->field));
  PetscCall(PetscArraycpy(mesh->field_name, f->field_name, f->num_fields));
  mesh->num_fields = f->num_fields;
  for (PetscInt i = 0; i < f->num_fields; ++i)
    for (PetscInt c = 0; c < mesh->num_cells; ++c)
      PetscCall(PetscArraycpy(mesh->field + 3 * (i * mesh->num_cells + c), f->value + 3 * (i * f->num + (source ? source[c] : c)), 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestReadFields(const char *name, int major, PetscInt num_elements, const PetscInt source[], CoarseMesh *mesh, const char **damage)
{
  Fields f = {.major = major, .dim = mesh->dim, .file = fopen(name, "rb")};

  PetscFunctionBegin;
  *damage = NULL;
  if (!f.file || !Find_Private(f.file, "$ElementData")) {
    if (f.file) fclose(f.file);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  rewind(f.file);
  PetscCall(ReadElements_Private(&f));
  if (!f.damage && f.num != num_elements) f.damage = "has $ElementData, but elements of types for which that cannot be read";
  rewind(f.file);
  while (!f.damage && Find_Private(f.file, "$ElementData")) PetscCall(ReadView_Private(&f));
  fclose(f.file);
  *damage = f.damage;
  if (!f.damage) PetscCall(ToCells_Private(&f, source, mesh));
  PetscCall(PetscFree(f.element));
  PetscCall(PetscFree(f.field_name));
  PetscCall(PetscFree(f.value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
