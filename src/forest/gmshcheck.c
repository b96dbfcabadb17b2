/* Before PETSc reads a gmsh file: are the sections $Nodes and $Elements whole, has every node a number of its own and a place, and does every element name
   nodes that exist? PETSc 3.18 follows numbers without looking, so a damaged file would end in a signal or never. Formats 2.2 and 4.1, text and binary. */
#include "forestimpl.h"

#define WIDE 100000000 /* PETSc keeps an integer for each number between the least and the largest of a node: so many are 400 MB */

typedef struct {
  const char *at, *end;
  int         major;
  PetscBool   binary, fine;
  PetscInt    num_nodes, size;
  int64_t    *tag; /* owned [num_nodes], sorted after $Nodes */
} Scan;

/* Nodes of an element type of gmsh (orders 1 to 4); 0: a type that is left to the reader. */
static int TypeNodes_Private(int64_t type)
{
  static const struct {
    int type, nodes;
  } Table[] = {{1, 2},  {2, 3},  {3, 4},   {4, 4},   {5, 8},   {6, 6},  {7, 5},  {8, 3},   {9, 6},   {10, 9},  {11, 10}, {12, 27}, {13, 18}, {14, 14},
               {15, 1}, {16, 8}, {17, 20}, {21, 10}, {23, 15}, {26, 4}, {27, 5}, {29, 20}, {30, 35}, {36, 16}, {37, 25}, {92, 64}, {93, 125}};
  for (size_t i = 0; i < sizeof(Table) / sizeof(Table[0]); ++i) {
    if (Table[i].type == type) return Table[i].nodes;
  }
  return 0;
}

static int64_t Fail_Private(Scan *s)
{
  s->fine = PETSC_FALSE;
  s->at   = s->end;
  return 0;
}

static PetscBool IsSpace_Private(char c)
{
  return (PetscBool)(c == ' ' || c == '\n' || c == '\t' || c == '\r');
}

/* Next integer: a token of digits (text) or `bytes` bytes. */
static int64_t Integer_Private(Scan *s, int bytes)
{
  int64_t value = 0;
  int     sign = 1, digits = 0, i;

  if (s->binary) {
    if (s->end - s->at < bytes) return Fail_Private(s);
    if (bytes == 8)
      memcpy(&value, s->at, 8);
    else {
      memcpy(&i, s->at, sizeof(i));
      value = i;
    }
    s->at += bytes;
    return value;
  }
  while (s->at < s->end && IsSpace_Private(*s->at)) ++s->at;
  if (s->at < s->end && *s->at == '-') {
    sign = -1;
    ++s->at;
  }
  for (; s->at < s->end && *s->at >= '0' && *s->at <= '9' && digits < 18; ++s->at, ++digits) value = 10 * value + (*s->at - '0');
  if (!digits || s->at == s->end || !IsSpace_Private(*s->at)) return Fail_Private(s);
  return sign * value;
}

/* A count that something of at least one byte each must follow. */
static int64_t Count_Private(Scan *s, int bytes)
{
  const int64_t count = Integer_Private(s, bytes);
  return count < 0 || count > s->end - s->at ? Fail_Private(s) : count;
}

/* A count that stands as a line of text in binary files too. */
static int64_t TextCount_Private(Scan *s)
{
  const PetscBool binary = s->binary;

  s->binary           = PETSC_FALSE;
  const int64_t count = Count_Private(s, 4);
  s->binary           = binary;
  if (binary && s->at < s->end) ++s->at; /* the end of the line */
  return count;
}

/* Pass over n real numbers, which must be finite. */
static void SkipReals_Private(Scan *s, int64_t n)
{
  double value = 0;

  if (s->binary && n > (s->end - s->at) / 8) (void)Fail_Private(s);
  for (int64_t i = 0; i < n && s->fine; ++i) {
    char *stop = NULL;
    if (s->binary)
      memcpy(&value, s->at, sizeof(value));
    else
      value = strtod(s->at, &stop); /* the buffer ends with a zero byte */
    if (!s->binary && (stop == s->at || stop >= s->end || !IsSpace_Private(*stop))) (void)Fail_Private(s);
    if (PetscIsInfOrNanReal((PetscReal)value)) (void)Fail_Private(s);
    if (s->fine) s->at += s->binary ? 8 : stop - s->at;
  }
}

static void End_Private(Scan *s, const char *name)
{
  while (s->at < s->end && IsSpace_Private(*s->at)) ++s->at;
  if (s->fine && ((size_t)(s->end - s->at) < strlen(name) || memcmp(s->at, name, strlen(name)))) (void)Fail_Private(s);
}

static PetscErrorCode AddTag_Private(Scan *s, int64_t tag)
{
  PetscFunctionBegin;
  if (s->num_nodes == s->size) {
    s->size = PetscMax(1024, 2 * s->size);
    PetscCall(PetscRealloc((size_t)s->size * sizeof(int64_t), &s->tag));
  }
  s->tag[s->num_nodes++] = tag;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CompareTags_Private(const void *a, const void *b)
{
  const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return x < y ? -1 : x > y;
}

static PetscErrorCode ScanNodes_Private(Scan *s)
{
  PetscFunctionBegin;
  if (s->major == 2) {
    const int64_t num = TextCount_Private(s);
    for (int64_t i = 0; i < num && s->fine; ++i) {
      PetscCall(AddTag_Private(s, Integer_Private(s, 4)));
      SkipReals_Private(s, 3);
    }
  } else {
    const int64_t blocks = Count_Private(s, 8);
    for (int k = 0; k < 3; ++k) (void)Integer_Private(s, 8);
    for (int64_t b = 0; b < blocks && s->fine; ++b) {
      const int64_t dim = Integer_Private(s, 4);
      (void)Integer_Private(s, 4);
      const int64_t parametric = Integer_Private(s, 4), num = Count_Private(s, 8);
      for (int64_t i = 0; i < num && s->fine; ++i) PetscCall(AddTag_Private(s, Integer_Private(s, 8)));
      SkipReals_Private(s, num * (3 + (parametric && dim > 0 ? dim : 0)));
    }
  }
  End_Private(s, "$EndNodes");
  if (s->num_nodes) qsort(s->tag, (size_t)s->num_nodes, sizeof(int64_t), CompareTags_Private);
  for (PetscInt i = 1; i < s->num_nodes && s->fine; ++i) {
    if (s->tag[i] == s->tag[i - 1]) (void)Fail_Private(s);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of one element: there, and corners (the first eight at most) that differ. */
static void ElementNodes_Private(Scan *s, int nodes, int bytes)
{
  int64_t corner[8];

  for (int k = 0; k < nodes && s->fine; ++k) {
    const int64_t tag = Integer_Private(s, bytes);
    if (s->fine && !bsearch(&tag, s->tag, (size_t)s->num_nodes, sizeof(int64_t), CompareTags_Private)) (void)Fail_Private(s);
    for (int i = 0; i < k && k < 8; ++i) {
      if (corner[i] == tag) (void)Fail_Private(s);
    }
    if (k < 8) corner[k] = tag;
  }
}

/* Stops quietly at a type it does not know: the reader has its own word on those. */
static void ScanElements_Private(Scan *s)
{
  int64_t left = s->major == 2 ? TextCount_Private(s) : Count_Private(s, 8);

  for (int k = 0; s->major == 4 && k < 3; ++k) (void)Integer_Private(s, 8);
  while (left > 0 && s->fine) {
    int64_t type, num = 1, tags = 0;
    if (s->major == 4) {
      (void)Integer_Private(s, 4);
      (void)Integer_Private(s, 4);
      type = Integer_Private(s, 4);
      num  = Count_Private(s, 8);
    } else {
      if (!s->binary) (void)Integer_Private(s, 4);
      type = Integer_Private(s, 4);
      if (s->binary) num = Count_Private(s, 4);
      tags = Count_Private(s, 4);
    }
    const int nodes = TypeNodes_Private(type), bytes = s->major == 2 ? 4 : 8;
    if (!nodes) return;
    for (int64_t e = 0; e < num && s->fine; ++e) {
      if (s->major == 4 || s->binary) (void)Integer_Private(s, bytes);
      for (int64_t t = 0; t < tags; ++t) (void)Integer_Private(s, 4);
      ElementNodes_Private(s, nodes, bytes);
    }
    left -= s->major == 4 ? 1 : num;
  }
  if (s->fine) End_Private(s, "$EndElements");
}

/* To what follows the line `name`; the count of a 2.2 file is text there even when the rest is binary. False: there is no such section. */
static PetscBool FindSection_Private(Scan *s, const char *begin, const char *name)
{
  const size_t length = strlen(name);

  for (const char *line = begin; line && line < s->end; line = memchr(line, '\n', (size_t)(s->end - line))) {
    if (*line == '\n') ++line;
    if ((size_t)(s->end - line) > length && !memcmp(line, name, length) && IsSpace_Private(line[length])) {
      s->at = memchr(line, '\n', (size_t)(s->end - line));
      if (!s->at) return PETSC_FALSE;
      ++s->at;
      return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

static PetscErrorCode ScanText_Private(Scan *s, const char *begin)
{
  PetscFunctionBegin;
  s->fine = FindSection_Private(s, begin, "$Nodes");
  if (s->fine) PetscCall(ScanNodes_Private(s));
  if (s->fine) s->fine = FindSection_Private(s, s->at, "$Elements");
  if (s->fine) ScanElements_Private(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* *fine: sections whole, all nodes of elements there. *range: 0, or how far the numbers of nodes reach when that is too far for PETSc. Not collective. */
PetscErrorCode ForestCheckGmsh(const char *name, int major, PetscBool binary, PetscBool *fine, int64_t *range)
{
  Scan  s    = {.major = major, .binary = binary};
  FILE *file = fopen(name, "rb");
  long  size = 0;
  char *text;

  PetscFunctionBegin;
  *fine  = PETSC_TRUE;
  *range = 0;
  if (file && !fseek(file, 0, SEEK_END)) size = ftell(file);
  if (!file || size <= 0) {
    if (file) fclose(file);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  rewind(file);
  PetscCall(PetscMalloc1((size_t)size + 1, &text));
  const size_t got = fread(text, 1, (size_t)size, file);
  fclose(file);
  text[got] = 0;
  s.end     = text + got;
  PetscCall(ScanText_Private(&s, text));
  *fine = s.fine;
  if (s.num_nodes && (double)s.tag[s.num_nodes - 1] - (double)s.tag[0] > PetscMax(WIDE, (double)s.num_nodes)) *range = s.tag[s.num_nodes - 1];
  PetscCall(PetscFree(text));
  PetscCall(PetscFree(s.tag));
  PetscFunctionReturn(PETSC_SUCCESS);
}
