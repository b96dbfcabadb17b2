/* Topology of the coarse mesh: ids of its edges and faces, closures with orientation codes, cells of each facet. */
#include "forestimpl.h"

PetscErrorCode ForestCoarseMeshDestroy(CoarseMesh *mesh)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(mesh->body_name));
  PetscCall(PetscFree(mesh->boundary_name));
  PetscCall(PetscFree(mesh->cell_vertices));
  PetscCall(PetscFree(mesh->cell_geometry));
  PetscCall(PetscFree(mesh->cell_body));
  PetscCall(PetscFree(mesh->field_name));
  PetscCall(PetscFree(mesh->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestCoarseDestroy(Coarse **coarse)
{
  PetscFunctionBegin;
  if (!*coarse) PetscFunctionReturn(PETSC_SUCCESS);
  if (--(*coarse)->references == 0) {
    PetscCall(ForestCoarseMeshDestroy(&(*coarse)->mesh));
    PetscCall(PetscFree((*coarse)->closure_offset));
    PetscCall(PetscFree((*coarse)->closure));
    PetscCall(PetscFree((*coarse)->orientation));
    PetscCall(PetscFree((*coarse)->facet_cell));
    PetscCall(PetscFree((*coarse)->facet_place));
    PetscCall(PetscFree((*coarse)->facet_groups));
    PetscCall(PetscFree(*coarse));
  }
  *coarse = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Orientation code and key of an edge or face from its vertices in the owner's tensor order (x fastest). Closed form in the vertex ids:
   see the frames in forestimpl.h. */
static int8_t VertexKey_Private(PetscInt d, const PetscInt v[], EntityKey *key)
{
  PetscInt m = 0, frame[4];

  if (d == 1) {
    *key = (EntityKey){(uint64_t)PetscMin(v[0], v[1]) << 32 | (uint64_t)PetscMax(v[0], v[1]), 0, UINT64_MAX};
    return v[0] > v[1];
  }
  for (PetscInt i = 1; i < 4; ++i)
    if (v[i] < v[m]) m = i;
  const PetscInt swapped = v[m ^ 2] < v[m ^ 1];
  frame[0]               = v[m];
  frame[1]               = v[swapped ? m ^ 2 : m ^ 1];
  frame[2]               = v[swapped ? m ^ 1 : m ^ 2];
  frame[3]               = v[m ^ 3];
  *key                   = (EntityKey){(uint64_t)frame[0] << 32 | (uint64_t)frame[1], 0, (uint64_t)frame[2] << 32 | (uint64_t)frame[3]};
  return (int8_t)(swapped ? 4 | (m >> 1) | (m & 1) << 1 : m);
}

/* Vertices of the sub-entity at a place of a cell, in the cell's tensor order; corner[] are the cell's vertices. Returns the dimension. */
static PetscInt PlaceVertices_Private(PetscInt dim, PetscInt place, const PetscInt corner[], PetscInt v[])
{
  PetscInt d = 0, base = 0, bit[3];

  for (PetscInt i = 0; i < dim; ++i) {
    const PetscInt t = (place / ForestPow3[i]) % 3;
    if (t == 1) bit[d++] = 1 << i;
    if (t == 2) base |= 1 << i;
  }
  for (PetscInt c = 0; c < 1 << d; ++c) {
    PetscInt index = base;
    for (PetscInt j = 0; j < d; ++j)
      if ((c >> j) & 1) index |= bit[j];
    v[c] = corner[index];
  }
  return d;
}

typedef struct {
  PetscInt   dim, num_cells, num[3];
  EntityHash hash[3];    /* edges, faces by vertices */
  PetscInt  *closure[4]; /* by dimension, ids counted within each dimension */
  int8_t    *orientation[4];
} Builder;

static PetscErrorCode BuilderCreate_Private(const CoarseMesh *mesh, Builder *b)
{
  const PetscInt most[2][3] = {{0, 4, 0}, {0, 12, 6}}; /* sub-entities of a cell */

  PetscFunctionBegin;
  *b = (Builder){.dim = mesh->dim, .num_cells = mesh->num_cells, .num = {mesh->num_vertices, 0, 0}};
  for (PetscInt d = 1; d <= b->dim; ++d) {
    const PetscInt n = d == b->dim ? mesh->num_cells : mesh->num_cells * most[b->dim - 2][d];
    if (d < b->dim) PetscCall(ForestHashCreate(4 * mesh->num_cells, &b->hash[d])); /* a block of boxes has 2 (plane) or 3 of each to a cell; it grows */
    PetscCall(PetscMalloc2(n * ForestPow3[d], &b->closure[d], n * ForestPow3[d], &b->orientation[d]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuilderDestroy_Private(Builder *b)
{
  PetscFunctionBegin;
  for (PetscInt d = 1; d <= b->dim; ++d) {
    if (d < b->dim) PetscCall(ForestHashDestroy(&b->hash[d]));
    PetscCall(PetscFree2(b->closure[d], b->orientation[d]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Enter a cell: vertices first, then edges, then faces, since the closure of each is read off the cell's own. */
static PetscErrorCode BuilderAddCell_Private(Builder *b, PetscInt cell, const PetscInt corner[])
{
  const PetscInt n       = ForestPow3[b->dim];
  PetscInt      *closure = &b->closure[b->dim][n * cell], v[8];
  int8_t        *code    = &b->orientation[b->dim][n * cell];

  PetscFunctionBegin;
  for (PetscInt d = 0; d < b->dim; ++d)
    for (PetscInt i = 0; i < n; ++i) {
      EntityKey key;
      PetscBool added;
      if (ForestTensorDim[i] != d) continue;
      PlaceVertices_Private(b->dim, i, corner, v);
      code[i] = 0;
      if (d == 0) {
        closure[i] = v[0];
        continue;
      }
      code[i] = VertexKey_Private(d, v, &key);
      PetscCall(ForestHashInsert(&b->hash[d], key, &closure[i], &added));
      if (!added) continue;
      const PetscInt at = ForestPow3[d] * b->num[d]++;
      ForestSubClosure(i, code[i], closure, code, &b->closure[d][at], &b->orientation[d][at]);
    }
  closure[n / 2] = cell;
  code[n / 2]    = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gather the closures of all dimensions in one table with ids. */
static PetscErrorCode BuilderFinish_Private(const Builder *b, Coarse *coarse)
{
  PetscInt size = b->num[0], total = 0, at = 0;

  PetscFunctionBegin;
  for (PetscInt d = 0; d <= b->dim; ++d) {
    const PetscInt num = d == b->dim ? b->num_cells : b->num[d];
    coarse->first[d]   = total;
    total += num;
    if (d > 0) size += num * ForestPow3[d];
  }
  coarse->first[b->dim + 1] = total;
  PetscCall(PetscMalloc1(total, &coarse->closure_offset));
  PetscCall(PetscMalloc1(size, &coarse->closure));
  PetscCall(PetscMalloc1(size, &coarse->orientation));
  for (PetscInt d = 0, id = 0; d <= b->dim; ++d)
    for (PetscInt e = 0; e < coarse->first[d + 1] - coarse->first[d]; ++e, ++id) {
      coarse->closure_offset[id] = at;
      for (PetscInt i = 0; i < ForestPow3[d]; ++i, ++at) {
        coarse->closure[at]     = d == 0 ? e : coarse->first[ForestTensorDim[i]] + b->closure[d][e * ForestPow3[d] + i];
        coarse->orientation[at] = d == 0 ? 0 : b->orientation[d][e * ForestPow3[d] + i];
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Input error text needs the place of a cell. */
static void CellCentre_Private(const CoarseMesh *mesh, PetscInt cell, PetscReal X[3])
{
  const PetscReal half[3] = {0.5, 0.5, 0.5};
  ForestCoarseMapPoint(mesh, cell, half, X, NULL);
}

/* A determinant that numbers do not hold is no fault of the cell's shape. */
static PetscErrorCode CheckSize_Private(const CoarseMesh *mesh, PetscInt cell)
{
  const PetscInt   q = mesh->geometry_order + 1, n = q * q * (mesh->dim == 3 ? q : 1);
  const PetscReal *X      = mesh->cell_geometry + 3 * n * cell;
  PetscReal        extent = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < 3 * n; ++i) extent = PetscMax(extent, PetscAbsReal(X[i] - X[i % 3]));
  const PetscReal volume = PetscPowReal(extent, (PetscReal)mesh->dim);
  PetscCheckInput(!extent || PetscIsNormalReal(volume),
                  "mesh cell %" PetscInt_FMT " of %" PetscInt_FMT " is %g long, and its volume is none that a number can be; give it in other units", cell + 1,
                  mesh->num_cells, (double)extent);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Would a cell be sound with straight sides between its corners? */
static PetscBool IsSoundStraight_Private(const CoarseMesh *mesh, PetscInt cell)
{
  const PetscInt p = mesh->geometry_order, q = p + 1, n = q * q * (mesh->dim == 3 ? q : 1);
  CoarseMesh     one = *mesh;
  PetscReal      corner[8][3];

  for (PetscInt k = 0; k < 1 << mesh->dim; ++k) {
    const PetscInt node = p * ((k & 1) + q * ((k >> 1) & 1) + q * q * (k >> 2));
    for (PetscInt c = 0; c < 3; ++c) corner[k][c] = mesh->cell_geometry[3 * (n * cell + node) + c];
  }
  one.geometry_order = 1;
  one.cell_geometry  = corner[0];
  return (PetscBool)(ForestCoarseJacobianSign(&one, 0) > 0);
}

static PetscErrorCode CheckCells_Private(const CoarseMesh *mesh)
{
  PetscReal X[3];

  PetscFunctionBegin;
  for (PetscInt c = 0; c < mesh->num_cells; ++c) {
    if (ForestCoarseJacobianSign(mesh, c) > 0) continue;
    const PetscBool straight = (PetscBool)(mesh->geometry_order > 1 && IsSoundStraight_Private(mesh, c));
    CellCentre_Private(mesh, c, X);
    PetscCall(CheckSize_Private(mesh, c));
    return ErrorInput("mesh cell %" PetscInt_FMT " of %" PetscInt_FMT
                      ", centre (%g, %g, %g), is inverted or degenerate: its Jacobian determinant is not positive everywhere%s",
                      c + 1, mesh->num_cells, (double)X[0], (double)X[1], (double)X[2],
                      straight ? "; with straight sides it would be: smaller cells there, or a lower mesh.order" : "");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are they one cell, whatever the order of its vertices? */
static PetscBool Same_Private(const CoarseMesh *mesh, PetscInt a, PetscInt b)
{
  const PetscInt num = 1 << mesh->dim, *v = mesh->cell_vertices + a * num, *w = mesh->cell_vertices + b * num;

  for (PetscInt i = 0; i < num; ++i) {
    PetscInt j = 0;
    while (j < num && w[j] != v[i]) ++j;
    if (j == num) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Cells that share a facet differ. */
static PetscErrorCode Twice_Private(const CoarseMesh *mesh, PetscInt a, PetscInt b)
{
  PetscReal X[3];

  PetscFunctionBegin;
  if (!Same_Private(mesh, a, b)) PetscFunctionReturn(PETSC_SUCCESS);
  CellCentre_Private(mesh, b, X);
  PetscCall(ErrorInput("mesh cells %" PetscInt_FMT " and %" PetscInt_FMT
                       " (centre %g, %g, %g) are one cell listed twice; files of format 2.2 list a cell of two "
                       "groups twice: leave it in one",
                       a + 1, b + 1, (double)X[0], (double)X[1], (double)X[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facet table: the cells of each, at most two. */
static PetscErrorCode FacetCells_Private(Coarse *coarse)
{
  const CoarseMesh *mesh = &coarse->mesh;
  const PetscInt    dim = mesh->dim, n = ForestPow3[dim], first = coarse->first[dim - 1], num = coarse->first[dim] - first;
  PetscReal         X[3];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &coarse->facet_cell));
  PetscCall(PetscMalloc1(num, &coarse->facet_place));
  PetscCall(PetscCalloc1(num, &coarse->facet_groups));
  for (PetscInt f = 0; f < num; ++f) coarse->facet_cell[f][0] = coarse->facet_cell[f][1] = -1;
  for (PetscInt c = 0; c < mesh->num_cells; ++c)
    for (PetscInt i = 0; i < n; ++i) {
      if (ForestTensorDim[i] != dim - 1) continue;
      const PetscInt f    = coarse->closure[coarse->closure_offset[coarse->first[dim] + c] + i] - first;
      const PetscInt side = coarse->facet_cell[f][0] < 0 ? 0 : 1;
      for (PetscInt k = 0; k < 2 && coarse->facet_cell[f][k] >= 0; ++k) PetscCall(Twice_Private(mesh, coarse->facet_cell[f][k], c));
      if (coarse->facet_cell[f][side] >= 0) {
        CellCentre_Private(mesh, c, X);
        return ErrorInput("mesh cells %" PetscInt_FMT ", %" PetscInt_FMT " and %" PetscInt_FMT " (centre %g, %g, %g) all share one %s: two at most may",
                          coarse->facet_cell[f][0] + 1, coarse->facet_cell[f][1] + 1, c + 1, (double)X[0], (double)X[1], (double)X[2],
                          dim == 2 ? "edge" : "face");
      }
      coarse->facet_cell[f][side]  = c;
      coarse->facet_place[f][side] = (int8_t)i;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Position of a sample point of the frame of the sub-entity at a place of a cell: off the middle, so that a wrong orientation shows too. */
static void SamplePoint_Private(const Coarse *coarse, PetscInt cell, PetscInt place, PetscReal X[3])
{
  const PetscInt  n         = ForestTensorDim[place];
  const int8_t    code      = coarse->orientation[coarse->closure_offset[coarse->first[coarse->mesh.dim] + cell] + place];
  const PetscReal sample[2] = {0.3, 0.4};
  PetscReal       xi[3];

  for (PetscInt i = 0, j = 0; i < coarse->mesh.dim; ++i) {
    const PetscInt t = (place / ForestPow3[i]) % 3;
    xi[i]            = 0.5 * t;
    if (t != 1) continue;
    const PetscInt f = ForestFrameAxis(n, code, j++);
    xi[i]            = ForestFrameReversed(code, f) ? 1 - sample[f] : sample[f];
  }
  ForestCoarseMapPoint(&coarse->mesh, cell, xi, X, NULL);
}

/* Cells that share the vertices of a facet must share its points too; else a body would silently be torn or glued. */
static PetscErrorCode CheckShared_Private(const Coarse *coarse)
{
  const CoarseMesh *mesh = &coarse->mesh;
  const PetscInt    num  = coarse->first[mesh->dim] - coarse->first[mesh->dim - 1];
  PetscReal         X[2][3], centre[3];

  PetscFunctionBegin;
  for (PetscInt f = 0; f < num; ++f) {
    const PetscInt *cell = coarse->facet_cell[f];
    PetscReal       gap = 0, size = 0;
    if (cell[1] < 0) continue;
    for (PetscInt s = 0; s < 2; ++s) SamplePoint_Private(coarse, cell[s], coarse->facet_place[f][s], X[s]);
    CellCentre_Private(mesh, cell[0], centre);
    for (PetscInt i = 0; i < 3; ++i) {
      gap += PetscSqr(X[0][i] - X[1][i]);
      size += PetscSqr(X[0][i] - centre[i]);
    }
    PetscCheckInput(gap <= 1e-12 * size,
                    "mesh cells %" PetscInt_FMT " and %" PetscInt_FMT
                    " have the vertices of one %s in common, near (%g, %g, %g), but not the points between them",
                    cell[0] + 1, cell[1] + 1, mesh->dim == 2 ? "edge" : "face", (double)X[0][0], (double)X[0][1], (double)X[0][2]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vertices of a facet come in any order (of a quad): its smallest vertex, that one's neighbours and the fourth cannot be told from the
   sorted set alone, so all three pairings are tried. */
static PetscInt FindFacet_Private(const Builder *b, const PetscInt v[])
{
  static const PetscInt pairing[3][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}};
  EntityKey             key;

  if (b->dim == 2) {
    VertexKey_Private(1, v, &key);
    return ForestHashFind(&b->hash[1], key);
  }
  for (PetscInt p = 0; p < 3; ++p) {
    const PetscInt w[4] = {v[pairing[p][0]], v[pairing[p][1]], v[pairing[p][2]], v[pairing[p][3]]};
    VertexKey_Private(2, w, &key);
    const PetscInt f = ForestHashFind(&b->hash[2], key);
    if (f >= 0) return f;
  }
  return -1;
}

static PetscErrorCode MarkFacets_Private(const Builder *b, Coarse *coarse, PetscInt num_facets, const PetscInt vertices[], const uint64_t groups[])
{
  const PetscInt n = 1 << (b->dim - 1);

  PetscFunctionBegin;
  for (PetscInt i = 0; i < num_facets; ++i) {
    const PetscInt f = FindFacet_Private(b, &vertices[n * i]);
    PetscCheck(f >= 0, PETSC_COMM_SELF, PETSC_ERR_ARG_WRONG, "Boundary facet %" PetscInt_FMT " is not a facet of any cell", i);
    coarse->facet_groups[f] |= groups[i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestCoarseCreate(CoarseMesh *mesh, PetscInt num_facets, const PetscInt facet_vertices[], const uint64_t facet_groups[], Coarse **result)
{
  const PetscInt corners = 1 << mesh->dim;
  Coarse        *coarse;
  Builder        b;

  PetscFunctionBegin;
  PetscCheck(mesh->dim == 2 || mesh->dim == 3, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "Dimension %" PetscInt_FMT " must be 2 or 3", mesh->dim);
  PetscCheck(mesh->geometry_order >= 1 && mesh->geometry_order <= FOREST_MAX_ORDER, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "Geometry order %" PetscInt_FMT " must be from 1 to %d", mesh->geometry_order, FOREST_MAX_ORDER);
  PetscCall(PetscNew(&coarse));
  coarse->references = 1;
  coarse->mesh       = *mesh;
  *mesh              = (CoarseMesh){0};
  *result            = coarse;
  mesh               = &coarse->mesh;
  PetscCall(BuilderCreate_Private(mesh, &b));
  for (PetscInt c = 0; c < mesh->num_cells; ++c) PetscCall(BuilderAddCell_Private(&b, c, &mesh->cell_vertices[corners * c]));
  PetscCall(BuilderFinish_Private(&b, coarse));
  PetscCall(FacetCells_Private(coarse));
  PetscCall(CheckCells_Private(&coarse->mesh));
  PetscCall(CheckShared_Private(coarse));
  PetscCall(MarkFacets_Private(&b, coarse, num_facets, facet_vertices, facet_groups));
  PetscCall(BuilderDestroy_Private(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
