/* Cells of the plane with a flat corner, as a mesh generator makes them that judges cells by their chords: where two sides of a cell lie on one smooth curve,
   the angle between them is 180 degrees once they are curved. The map of the cell is singular there, and the smaller cells that it is split into at that corner
   are all so: the error does not fall, and the least strain turns one inside out. Such a cell (A B C D, flat at B) and its neighbour beyond a side that B is
   not on (D C E F) become four, with two vertices more inside (O, P), and a line from B into the body:

        A--B--C--E            A--B--C--E
        |     |  |            |  |  |  |
        |     |  |     ->     |  O--P  |
        |     |  |            | /    \ |
        D-----+--F  (CD)      D--------F

   No vertex, side or group of the mesh changes but the side C-D. */
#include "forestimpl.h"

#define FLAT 165 /* degrees; 180 on smooth curves, however small the cells, and less than 160 in straight cells of good generators */

enum { FLAT_NODES = FOREST_MAX_ORDER + 1 };

/* Corners and sides of a quadrilateral, from one corner on, in either sense; side k goes from corner k to the next. */
typedef struct {
  PetscInt  vertex[4];
  PetscReal side[4][FLAT_NODES][3];
} Ring;

typedef struct {
  PetscReal worst; /* the largest angle of the four, degrees */
  PetscInt  neighbour;
  PetscBool mirrored; /* the neighbour is the one beyond D-A */
  Ring      ring[4];
} Opening;

/* Cells at each vertex: cell[first[v] .. first[v + 1]). */
typedef struct {
  PetscInt *first, *cell;
} Around;

static const PetscInt Corner[4]   = {0, 1, 3, 2}; /* round the cell, of the lexicographic ones */
static const PetscInt Place[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};

static PetscReal *Node_Private(const CoarseMesh *mesh, PetscInt cell, PetscInt side, PetscInt k)
{
  const PetscInt q = mesh->geometry_order, *from = Place[side], *to = Place[(side + 1) % 4];
  const PetscInt i = from[0] * (q - k) + to[0] * k, j = from[1] * (q - k) + to[1] * k;

  return mesh->cell_geometry + 3 * (((q + 1) * cell + j) * (q + 1) + i);
}

static void GetRing_Private(const CoarseMesh *mesh, PetscInt cell, PetscInt start, PetscBool mirrored, Ring *r)
{
  const PetscInt q = mesh->geometry_order;

  for (PetscInt s = 0; s < 4; ++s) {
    const PetscInt corner = mirrored ? (start + 4 - s) % 4 : (start + s) % 4;
    r->vertex[s]          = mesh->cell_vertices[4 * cell + Corner[corner]];
    for (PetscInt k = 0; k <= q; ++k)
      PetscCallVoid(PetscArraycpy(r->side[s][k], mirrored ? Node_Private(mesh, cell, (corner + 3) % 4, q - k) : Node_Private(mesh, cell, corner, k), 3));
  }
}

/* The ring as a cell: inside, sides are blended (Coons). */
static void PutRing_Private(CoarseMesh *mesh, PetscInt cell, const Ring *ring, PetscBool mirrored)
{
  const PetscInt q = mesh->geometry_order, n = q + 1;
  PetscReal     *X = mesh->cell_geometry + 3 * n * n * cell;

  for (PetscInt s = 0; s < 4; ++s) mesh->cell_vertices[4 * cell + Corner[mirrored ? (4 - s) % 4 : s]] = ring->vertex[s];
  for (PetscInt j = 0; j < n; ++j)
    for (PetscInt i = 0; i < n; ++i) {
      const PetscInt   a = mirrored ? j : i, b = mirrored ? i : j; /* along sides 0 and 1 of the ring */
      const PetscReal  s = (PetscReal)a / (PetscReal)q, t = (PetscReal)b / (PetscReal)q;
      const PetscReal *below = ring->side[0][a], *above = ring->side[2][q - a], *left = ring->side[3][q - b], *right = ring->side[1][b];
      for (PetscInt c = 0; c < 3; ++c) {
        const PetscReal corners =
            (1 - t) * ((1 - s) * ring->side[0][0][c] + s * ring->side[1][0][c]) + t * ((1 - s) * ring->side[3][0][c] + s * ring->side[2][0][c]);
        X[3 * (n * j + i) + c] = (1 - t) * below[c] + t * above[c] + (1 - s) * left[c] + s * right[c] - corners;
      }
    }
}

/* The angle between two sides at a corner, 0 to 360 degrees, and the largest of a cell. */
static PetscReal Angle_Private(const CoarseMesh *mesh, PetscInt cell, PetscInt corner)
{
  const PetscReal xi[3] = {(PetscReal)Place[corner][0], (PetscReal)Place[corner][1], 0}, sign = Place[corner][0] == Place[corner][1] ? 1 : -1;
  PetscReal       X[3], J[9];

  ForestCoarseMapPoint(mesh, cell, xi, X, J);
  const PetscReal angle = PetscAtan2Real(J[0] * J[3] - J[1] * J[2], sign * (J[0] * J[1] + J[2] * J[3])) * 180 / PETSC_PI;
  return angle < 0 ? angle + 360 : angle;
}

static PetscReal Widest_Private(const CoarseMesh *mesh, PetscInt cell, PetscInt *corner)
{
  PetscReal widest = -1;

  for (PetscInt k = 0; k < 4; ++k) {
    const PetscReal angle = Angle_Private(mesh, cell, k);
    if (angle <= widest) continue;
    widest  = angle;
    *corner = k;
  }
  return widest;
}

static PetscErrorCode AroundCreate_Private(const CoarseMesh *mesh, Around *a)
{
  const PetscInt *v = mesh->cell_vertices;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(mesh->num_vertices + 2, &a->first));
  PetscCall(PetscMalloc1(4 * mesh->num_cells, &a->cell));
  for (PetscInt i = 0; i < 4 * mesh->num_cells; ++i) ++a->first[v[i] + 2];
  for (PetscInt n = 0; n < mesh->num_vertices; ++n) a->first[n + 2] += a->first[n + 1];
  for (PetscInt i = 0; i < 4 * mesh->num_cells; ++i) a->cell[a->first[v[i] + 1]++] = i / 4;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a boundary group name the side between two vertices? */
static PetscBool IsNamed_Private(PetscInt v, PetscInt w, PetscInt num_facets, const PetscInt facet_vertices[])
{
  for (PetscInt f = 0; f < num_facets; ++f) {
    const PetscInt a = facet_vertices[2 * f], b = facet_vertices[2 * f + 1];
    if ((a == v && b == w) || (a == w && b == v)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Another cell of the same body at two vertices, and the place of one of them round it. */
static PetscInt Neighbour_Private(const CoarseMesh *mesh, const Around *around, PetscInt cell, PetscInt v, PetscInt w, PetscInt *place)
{
  for (PetscInt i = around->first[v]; i < around->first[v + 1]; ++i) {
    const PetscInt other = around->cell[i], *vertex = mesh->cell_vertices + 4 * other;
    PetscBool      touches = PETSC_FALSE;
    if (other == cell || mesh->cell_body[other] != mesh->cell_body[cell]) continue;
    for (PetscInt s = 0; s < 4; ++s) {
      touches = (PetscBool)(touches || vertex[Corner[s]] == w);
      if (vertex[Corner[s]] == v) *place = s;
    }
    if (touches) return other;
  }
  return -1;
}

static void Side_Private(PetscInt q, const PetscReal a[], const PetscReal b[], PetscReal side[][3])
{
  for (PetscInt k = 0; k <= q; ++k)
    for (PetscInt c = 0; c < 3; ++c) side[k][c] = a[c] + (b[c] - a[c]) * (PetscReal)k / (PetscReal)q;
}

/* The four rings: A B O D, B C P O, C E F P, O P F D, of r: B C D A and n: C E F D. */
static void Rings_Private(PetscInt q, const Ring *r, const Ring *n, PetscInt new_vertex, Ring ring[4])
{
  const PetscReal *B = r->side[0][0], *C = r->side[1][0], *D = r->side[2][0], *F = n->side[2][0];
  PetscReal        O[3], P[3];

  /* Each in the middle of the three that it is joined with. */
  for (PetscInt c = 0; c < 3; ++c) {
    O[c] = (3 * (B[c] + D[c]) + C[c] + F[c]) / 8;
    P[c] = (3 * (C[c] + F[c]) + B[c] + D[c]) / 8;
  }
  const PetscInt        v[8]            = {r->vertex[3], r->vertex[0], r->vertex[1], r->vertex[2], n->vertex[1], n->vertex[2], new_vertex, new_vertex + 1};
  const PetscReal      *at[8]           = {r->side[3][0], B, C, D, n->side[1][0], F, O, P}; /* A B C D E F O P */
  static const PetscInt of[4][4]        = {{0, 1, 6, 3}, {1, 2, 7, 6}, {2, 4, 5, 7}, {6, 7, 5, 3}};
  const PetscReal(*const kept[4][4])[3] = {{r->side[3], NULL, NULL, r->side[2]}, {r->side[0]}, {n->side[0], n->side[1]}, {NULL, NULL, n->side[2]}};

  for (PetscInt k = 0; k < 4; ++k)
    for (PetscInt s = 0; s < 4; ++s) {
      ring[k].vertex[s] = v[of[k][s]];
      if (kept[k][s])
        PetscCallVoid(PetscArraycpy(ring[k].side[s][0], kept[k][s][0], 3 * (q + 1)));
      else
        Side_Private(q, at[of[k][s]], at[of[k][(s + 1) % 4]], ring[k].side[s]);
    }
}

/* What becomes of the cell, flat at a corner, with the neighbour beyond C-D, or, mirrored, beyond D-A; worst: more than 360 if nothing sound. */
static PetscErrorCode Try_Private(const CoarseMesh *mesh, const Around *around, PetscInt num_facets, const PetscInt facet_vertices[], const PetscBool changed[],
                                  PetscInt cell, PetscInt corner, PetscBool mirrored, Opening *o)
{
  PetscReal geometry[3 * FLAT_NODES * FLAT_NODES];
  PetscInt  vertices[4], place = 0, widest;
  Ring      r, n;

  PetscFunctionBegin;
  o->worst    = PETSC_MAX_REAL;
  o->mirrored = mirrored;
  GetRing_Private(mesh, cell, corner, mirrored, &r);
  o->neighbour = Neighbour_Private(mesh, around, cell, r.vertex[1], r.vertex[2], &place);
  if (o->neighbour < 0 || changed[o->neighbour] || IsNamed_Private(r.vertex[1], r.vertex[2], num_facets, facet_vertices)) PetscFunctionReturn(PETSC_SUCCESS);
  GetRing_Private(mesh, o->neighbour, place, mirrored, &n);
  if (n.vertex[3] != r.vertex[2]) PetscFunctionReturn(PETSC_SUCCESS); /* they are corners across from one another there */
  Rings_Private(mesh->geometry_order, &r, &n, mesh->num_vertices, o->ring);
  CoarseMesh one    = *mesh;
  one.cell_geometry = geometry;
  one.cell_vertices = vertices;
  o->worst          = 0;
  for (PetscInt k = 0; k < 4; ++k) {
    PutRing_Private(&one, 0, &o->ring[k], mirrored);
    o->worst = PetscMax(o->worst, ForestCoarseJacobianSign(&one, 0) > 0 ? Widest_Private(&one, 0, &widest) : PETSC_MAX_REAL);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Copy_Private(CoarseMesh *mesh, PetscInt from, PetscInt to)
{
  PetscFunctionBegin;
  mesh->cell_body[to] = mesh->cell_body[from];
  for (PetscInt f = 0; f < mesh->num_fields; ++f)
    PetscCall(PetscArraycpy(mesh->field + 3 * (f * mesh->num_cells + to), mesh->field + 3 * (f * mesh->num_cells + from), 3));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Room for more cells; fields lie one after another. */
static PetscErrorCode Resize_Private(CoarseMesh *mesh, PetscInt num)
{
  const PetscInt n = PetscSqr(mesh->geometry_order + 1), old = mesh->num_cells, kept = PetscMin(old, num);
  PetscReal     *field;

  PetscFunctionBegin;
  PetscCall(PetscRealloc((size_t)(4 * num) * sizeof(PetscInt), &mesh->cell_vertices));
  PetscCall(PetscRealloc((size_t)num * sizeof(PetscInt), &mesh->cell_body));
  PetscCall(PetscRealloc((size_t)(3 * n * num) * sizeof(PetscReal), &mesh->cell_geometry));
  PetscCall(PetscMalloc1(3 * mesh->num_fields * num, &field));
  for (PetscInt f = 0; f < mesh->num_fields; ++f) PetscCall(PetscArraycpy(field + 3 * f * num, mesh->field + 3 * f * old, 3 * kept));
  PetscCall(PetscFree(mesh->field));
  mesh->field     = field;
  mesh->num_cells = num;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The flat cell and its neighbour become the first and the third of the four; the others come last. */
static PetscErrorCode Open_Private(CoarseMesh *mesh, PetscInt cell, const Opening *o, PetscInt *num)
{
  const PetscInt to[4] = {cell, *num, o->neighbour, *num + 1};

  PetscFunctionBegin;
  PetscCall(Copy_Private(mesh, cell, to[1]));
  PetscCall(Copy_Private(mesh, o->neighbour, to[3]));
  for (PetscInt k = 0; k < 4; ++k) PutRing_Private(mesh, to[k], &o->ring[k], o->mirrored);
  mesh->num_vertices += 2;
  *num += 2;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is done in one go: a cell is part of one change only. */
static PetscErrorCode Pass_Private(CoarseMesh *mesh, PetscInt num_facets, const PetscInt facet_vertices[], PetscInt num_flat, const PetscInt flat[],
                                   const PetscInt corner[], PetscInt *opened)
{
  PetscInt   num = mesh->num_cells;
  PetscBool *changed;
  Around     around;

  PetscFunctionBegin;
  *opened = 0;
  PetscCall(AroundCreate_Private(mesh, &around));
  PetscCall(PetscCalloc1(num, &changed));
  PetscCall(Resize_Private(mesh, num + 2 * num_flat));
  for (PetscInt i = 0; i < num_flat; ++i) {
    const PetscReal limit = ForestCoarseJacobianSign(mesh, flat[i]) > 0 ? FLAT : 180;
    Opening         o[2];
    if (changed[flat[i]]) continue;
    for (PetscInt k = 0; k < 2; ++k) PetscCall(Try_Private(mesh, &around, num_facets, facet_vertices, changed, flat[i], corner[i], (PetscBool)k, &o[k]));
    const Opening *best = &o[o[1].worst < o[0].worst];
    if (best->worst >= limit) continue;
    if (mesh->num_opened++ == 0) PetscCall(PetscArraycpy(mesh->first_opened, best->ring[0].side[1][0], 3));
    changed[flat[i]] = changed[best->neighbour] = PETSC_TRUE;
    PetscCall(Open_Private(mesh, flat[i], best, &num));
    ++*opened;
  }
  PetscCall(Resize_Private(mesh, num));
  PetscCall(PetscFree(changed));
  PetscCall(PetscFree(around.first));
  PetscCall(PetscFree(around.cell));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestOpenFlatCorners(CoarseMesh *mesh, PetscInt num_facets, const PetscInt facet_vertices[])
{
  PetscInt opened = 1;

  PetscFunctionBegin;
  while (mesh->dim == 2 && opened) { /* each time fewer are flat */
    PetscInt num = 0, *flat, *corner;
    PetscCall(PetscMalloc2(mesh->num_cells, &flat, mesh->num_cells, &corner));
    for (PetscInt c = 0; c < mesh->num_cells; ++c) {
      flat[num] = c;
      num += Widest_Private(mesh, c, &corner[num]) > FLAT;
    }
    opened = 0;
    if (num) PetscCall(Pass_Private(mesh, num_facets, facet_vertices, num, flat, corner, &opened));
    PetscCall(PetscFree2(flat, corner));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
