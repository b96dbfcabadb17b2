/* Where the vertices of linear contact faces lie when the cells behind them are of higher order.

   On the exact surface they would span an inscribed polyhedron: for facets of length h on radius R its mean distance from a circle is h^2/(12 R), from a sphere
   h^2/(6 R): a spurious gap (and in nearly incompressible bodies a lack of volume) far above the error of the cells: 0.4 % of the force of rubber2d.yml at h =
   0.1. Instead they take the dual projection of the surface, int psi_j (X - X_h) = 0 with the functions psi_j that also test the gap: the weighted gap of the
   polyhedron is that of the surface, to the accuracy of the facets' sizes. Local, and exact on flat parts. Hanging vertices follow their masters, to which they
   hand down their share of the integrals (P^T). Where two linear surfaces meet in an edge, the facets of both count.

   Rim of a surface: at planes of symmetry it goes on as its mirror image. There the part on this side gives the same quotient as both together, without its
   component across the plane, which the image cancels. Elsewhere another boundary begins, which must keep its size (it may be loaded): the rim stays where it
   is. Behind cells of order 1 every boundary is an inscribed polyhedron and the error of the cells is of the same order: these facets have no moment. */
#include "hpimpl.h"

#define NUM_POINTS 3   /* Gauss points per direction: exact for geometry up to order 4 */
#define MAX_CORNERS 4  /* of a facet */
#define COLLINEAR 1e-3 /* sine of the angle below which two facets are of one plane */

typedef struct {
  PetscReal moment[3], weight;
} Share;

/* A vertex of the rim: orthonormal normals of the planes of symmetry through it; all directions where another boundary begins. */
typedef struct {
  PetscInt  num;
  PetscReal normal[3][3];
} Rim;

/* Corner k of an edge or face: bit a of k is its side along axis a. */
static PetscInt Corner_Private(const ForestTables *t, PetscInt entity, PetscInt k)
{
  return t->closure[t->closure_offset[entity] + 2 * (k & 1) + 6 * (k >> 1)];
}

static PetscInt NumCorners_Private(const ForestTables *t, PetscInt entity)
{
  return 1 << HPEntityDim_Private(t, entity);
}

static PetscInt FacetLeaf_Private(const ForestTables *t, PetscInt facet)
{
  const PetscInt *sides = t->facet_leaf + 2 * (facet - t->first[t->dim - 1]);
  return sides[0] >= 0 ? sides[0] : sides[1];
}

static PetscErrorCode FacetPoint_Private(HPSpace hp, PetscInt facet, const PetscReal eta[], PetscReal X[3])
{
  const PetscInt leaf  = FacetLeaf_Private(hp->tables, facet);
  PetscReal      xi[3] = {0, 0, 0};

  PetscFunctionBegin;
  HPEntityToLeaf_Private(hp->tables, leaf, facet, hp->dim - 1, eta, xi);
  PetscCall(ForestMapPoint(hp->forest, leaf, xi, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add scale times the position of a vertex before anything is moved: on the exact geometry, or where its masters put it. */
static PetscErrorCode AddVertex_Private(HPSpace hp, PetscInt vertex, PetscReal scale, PetscReal X[3])
{
  const ForestTables *t      = hp->tables;
  const PetscInt      parent = t->parent[vertex], leaf = t->entity_leaf[vertex];
  PetscReal           xi[3] = {0, 0, 0}, Y[3];

  PetscFunctionBegin;
  if (parent < 0) {
    HPEntityToLeaf_Private(t, leaf, vertex, 0, xi, xi);
    PetscCall(ForestMapPoint(hp->forest, leaf, xi, Y));
    for (PetscInt c = 0; c < 3; ++c) X[c] += scale * Y[c];
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  const PetscInt n = NumCorners_Private(t, parent);
  for (PetscInt k = 0; k < n; ++k) PetscCall(AddVertex_Private(hp, Corner_Private(t, parent, k), scale / n, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add scale times a share to a vertex, to its masters where it hangs. */
static void AddShare_Private(const ForestTables *t, PetscInt vertex, PetscReal scale, const Share *share, Share shares[])
{
  const PetscInt parent = t->parent[vertex], n = parent < 0 ? 0 : NumCorners_Private(t, parent);

  for (PetscInt k = 0; k < n; ++k) AddShare_Private(t, Corner_Private(t, parent, k), scale / n, share, shares);
  if (n) return;
  for (PetscInt c = 0; c < 3; ++c) shares[vertex].moment[c] += scale * share->moment[c];
  shares[vertex].weight += scale * share->weight;
}

/* Normal of the facet through these corners, as long as its length, or its area between the diagonals. */
static void AreaVector_Private(PetscInt dim, PetscReal X[][3], PetscReal normal[3])
{
  PetscReal a[3], b[3] = {0, 0, 1};

  for (PetscInt c = 0; c < 3; ++c) {
    a[c] = X[dim == 2 ? 1 : 3][c] - X[0][c];
    if (dim == 3) b[c] = 0.5 * (X[2][c] - X[1][c]);
  }
  Cross3(a, b, normal);
}

/* Hats and their dual functions 2 - 3s, 3s - 1 at a point, products of those along the axes. */
static void Hats_Private(PetscInt d, const PetscReal s[], PetscReal N[], PetscReal psi[])
{
  for (PetscInt k = 0; k < 1 << d; ++k) {
    N[k] = psi[k] = 1;
    for (PetscInt a = 0; a < d; ++a) {
      N[k] *= (k >> a) & 1 ? s[a] : 1 - s[a];
      psi[k] *= (k >> a) & 1 ? 3 * s[a] - 1 : 2 - 3 * s[a];
    }
  }
}

/* Shares of the corners: weight int psi_j, moment int psi_j (X - X_h) with the multilinear X_h through the corners. */
static PetscErrorCode FacetShares_Private(HPSpace hp, PetscInt facet, Share share[])
{
  const PetscInt d = hp->dim - 1, n = 1 << d, leaf = FacetLeaf_Private(hp->tables, facet);
  PetscReal      corner[MAX_CORNERS][3] = {{0}}, normal[3], N[MAX_CORNERS], psi[MAX_CORNERS], X[3];
  const Basis1D *gauss;

  PetscFunctionBegin;
  PetscCall(Basis1DGet(1, NUM_POINTS, &gauss));
  for (PetscInt k = 0; k < n; ++k) PetscCall(AddVertex_Private(hp, Corner_Private(hp->tables, facet, k), 1, corner[k]));
  AreaVector_Private(hp->dim, corner, normal);
  const PetscReal measure = PetscSqrtReal(Dot3(normal, normal));
  for (PetscInt k = 0; k < n; ++k) share[k] = (Share){.weight = measure / n};
  if (hp->entity_order[hp->tables->first[hp->dim] + leaf] == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt q = 0; q < (d == 1 ? 1 : NUM_POINTS) * NUM_POINTS; ++q) {
    const PetscInt  i = q % NUM_POINTS, j = q / NUM_POINTS;
    const PetscReal s[2] = {gauss->points[i], gauss->points[j]}, w = measure * gauss->weights[i] * (d == 1 ? 1 : gauss->weights[j]);
    Hats_Private(d, s, N, psi);
    PetscCall(FacetPoint_Private(hp, facet, s, X));
    for (PetscInt c = 0; c < 3; ++c) {
      for (PetscInt k = 0; k < n; ++k) X[c] -= N[k] * corner[k][c];
      for (PetscInt k = 0; k < n; ++k) share[k].moment[c] += w * psi[k] * X[c];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Subtract_Private(PetscReal v[3], const PetscReal n[3])
{
  const PetscReal s = Dot3(v, n);
  for (PetscInt c = 0; c < 3; ++c) v[c] -= s * n[c];
}

/* Add the part of a normal that is new. */
static void AddNormal_Private(Rim *rim, const PetscReal normal[3])
{
  PetscReal n[3] = {normal[0], normal[1], normal[2]};

  for (PetscInt i = 0; i < rim->num; ++i) Subtract_Private(n, rim->normal[i]);
  const PetscReal length = PetscSqrtReal(Dot3(n, n));
  if (length <= COLLINEAR * PetscSqrtReal(Dot3(normal, normal))) return;
  for (PetscInt c = 0; c < 3; ++c) rim->normal[rim->num][c] = n[c] / length;
  rim->num++;
}

/* A facet of another boundary at the rim. */
static PetscErrorCode AddBoundary_Private(HPSpace hp, PetscInt facet, PetscBool mirror, Rim *rim)
{
  PetscReal corner[MAX_CORNERS][3] = {{0}}, normal[3], unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  PetscFunctionBegin;
  if (!mirror) {
    for (PetscInt c = 0; c < 3; ++c) AddNormal_Private(rim, unit[c]);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < 1 << (hp->dim - 1); ++k) PetscCall(AddVertex_Private(hp, Corner_Private(hp->tables, facet, k), 1, corner[k]));
  AreaVector_Private(hp->dim, corner, normal);
  AddNormal_Private(rim, normal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets of the boundary outside the groups: one leaf, and nothing hangs on them or they on anything. */
static PetscErrorCode OtherBoundary_Private(const ForestTables *t, uint64_t groups, PetscBool **other)
{
  const PetscInt first = t->first[t->dim - 1], num = t->first[t->dim] - first;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, other));
  for (PetscInt f = 0; f < num; ++f) {
    const PetscInt *sides = t->facet_leaf + 2 * f;
    (*other)[f]           = (PetscBool)((sides[0] < 0 || sides[1] < 0) && t->parent[first + f] < 0 && !(t->boundary[first + f] & groups));
  }
  for (PetscInt e = 0; e < t->first[t->dim]; ++e) {
    if (t->parent[e] >= first) (*other)[t->parent[e] - first] = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rim vertices: index [num vertices] into rim, -1 elsewhere. */
static PetscErrorCode RimIndex_Private(const ForestTables *t, const PetscBool other[], const Share shares[], PetscInt index[], PetscInt *num_rim)
{
  const PetscInt first = t->first[t->dim - 1], n = 1 << (t->dim - 1);

  PetscFunctionBegin;
  *num_rim = 0;
  for (PetscInt v = 0; v < t->first[1]; ++v) index[v] = -1;
  for (PetscInt facet = first; facet < t->first[t->dim]; ++facet) {
    for (PetscInt k = 0; k < n && other[facet - first]; ++k) {
      const PetscInt v = Corner_Private(t, facet, k);
      if (shares[v].weight > 0 && index[v] < 0) index[v] = (*num_rim)++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Take out of the moments what would move the rim out of planes of symmetry, or into another boundary. */
static PetscErrorCode HoldRim_Private(HPSpace hp, uint64_t groups, uint64_t mirror_groups, Share shares[])
{
  const ForestTables *t     = hp->tables;
  const PetscInt      first = t->first[t->dim - 1], n = 1 << (t->dim - 1);
  PetscInt           *index, num_rim;
  PetscBool          *other;
  Rim                *rim;

  PetscFunctionBegin;
  PetscCall(OtherBoundary_Private(t, groups, &other));
  PetscCall(PetscMalloc1(t->first[1], &index));
  PetscCall(RimIndex_Private(t, other, shares, index, &num_rim));
  PetscCall(PetscCalloc1(num_rim, &rim));
  for (PetscInt facet = first; facet < t->first[t->dim]; ++facet) {
    const PetscBool mirror = (PetscBool)((t->boundary[facet] & mirror_groups) != 0);
    for (PetscInt k = 0; k < n && other[facet - first]; ++k) {
      const PetscInt v = Corner_Private(t, facet, k);
      if (index[v] >= 0) PetscCall(AddBoundary_Private(hp, facet, mirror, &rim[index[v]]));
    }
  }
  for (PetscInt v = 0; v < t->first[1]; ++v) {
    for (PetscInt i = 0; index[v] >= 0 && i < rim[index[v]].num; ++i) Subtract_Private(shares[v].moment, rim[index[v]].normal[i]);
  }
  PetscCall(PetscFree(rim));
  PetscCall(PetscFree(index));
  PetscCall(PetscFree(other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* shift [num vertices][3], zero where nothing moves (and at hanging vertices, which follow their masters); freed by the caller. */
PetscErrorCode HPSpaceSurfaceShift_Private(HPSpace hp, uint64_t groups, uint64_t mirror_groups, PetscReal **shift)
{
  const ForestTables *t   = hp->tables;
  const PetscInt      num = t->first[1], n = 1 << (t->dim - 1);
  Share              *shares, share[MAX_CORNERS];

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(3 * num, shift));
  if (!groups) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(num, &shares));
  for (PetscInt facet = t->first[t->dim - 1]; facet < t->first[t->dim]; ++facet) {
    if (!(t->boundary[facet] & groups)) continue;
    PetscCall(FacetShares_Private(hp, facet, share));
    for (PetscInt k = 0; k < n; ++k) AddShare_Private(t, Corner_Private(t, facet, k), 1, &share[k], shares);
  }
  PetscCall(HoldRim_Private(hp, groups, mirror_groups, shares));
  for (PetscInt v = 0; v < num; ++v) {
    for (PetscInt c = 0; c < 3; ++c) (*shift)[3 * v + c] = shares[v].weight > 0 ? shares[v].moment[c] / shares[v].weight : 0;
  }
  PetscCall(PetscFree(shares));
  PetscFunctionReturn(PETSC_SUCCESS);
}
