/* Test surfaces whose facets have any order: chains of edges, and the unit square of a quadtree with hanging nodes, flat or mapped. Include after cmocka.h. */
#pragma once
#include "contact.h"
#include "element.h"
#include <stdlib.h>
#include <string.h>

#define LATTICE_CELLS 512
#define LATTICE_ROW (2 * (MORTISE_MAX_ORDER + 1))
#define LATTICE_NODES ((MORTISE_MAX_ORDER + 1) * (MORTISE_MAX_ORDER + 1)) /* of a facet */

typedef struct {
  ContactSurface s;
  int8_t        *order;
  PetscInt      *facets, *first, *lattice, *hang, *master;
  PetscReal     *X, *weight;
} LatticeSurface;

/* Cells of a quadtree in units of the finest one; the square has side `side`. */
typedef struct {
  PetscInt num, side;
  struct {
    PetscInt x, y, size, order;
  } cell[LATTICE_CELLS];
} LatticeCells;

static inline void LatticeDestroy(LatticeSurface *l)
{
  free(l->order), free(l->facets), free(l->first), free(l->lattice), free(l->hang), free(l->master), free(l->X), free(l->weight);
  memset(l, 0, sizeof(*l));
}

static inline void LatticeClose(LatticeSurface *l, PetscInt dim, PetscInt num_nodes, PetscInt num_facets)
{
  l->s       = (ContactSurface){.dim = dim, .num_nodes = num_nodes, .num_facets = num_facets, .facets = l->facets, .x = l->X, .X = l->X, .order = l->order};
  l->s.first = l->first, l->s.lattice = l->lattice;
  l->s.hang = l->hang, l->s.hang_master = l->master, l->s.hang_weight = l->weight;
}

/* ---- two dimensions ---------------------------------------------------------------------------------------------------- */

/* Edges between x[0] .. x[num] on the line y = 0. */
static inline void LatticeChain(LatticeSurface *l, PetscInt num, const PetscReal x[], const PetscInt order[])
{
  PetscInt nodes = 1, places = 0;

  memset(l, 0, sizeof(*l));
  l->first = calloc((size_t)num + 1, sizeof(PetscInt));
  for (PetscInt e = 0; e < num; e++) l->first[e + 1] = l->first[e] + order[e] + 1;
  l->order   = calloc((size_t)num, 1);
  l->facets  = calloc((size_t)(2 * num), sizeof(PetscInt));
  l->lattice = calloc((size_t)l->first[num], sizeof(PetscInt));
  l->X       = calloc((size_t)(2 * l->first[num]), sizeof(PetscReal));
  l->X[0]    = x[0];
  for (PetscInt e = 0; e < num; e++) {
    const PetscReal *point;

    assert_int_equal(ElementGetNodes(order[e], &point), 0);
    l->order[e]      = (int8_t)order[e];
    l->facets[2 * e] = nodes - 1;
    for (PetscInt i = 0; i <= order[e]; i++) {
      l->lattice[places++]      = nodes - 1 + i;
      l->X[2 * (nodes - 1 + i)] = x[e] + point[i] * (x[e + 1] - x[e]);
    }
    nodes += order[e];
    l->facets[2 * e + 1] = nodes - 1;
  }
  LatticeClose(l, 2, nodes, num);
}

/* ---- three dimensions: cells ------------------------------------------------------------------------------------------- */

static inline void LatticeGrid(LatticeCells *c, PetscInt n, PetscInt levels, PetscInt order)
{
  const PetscInt size = 1 << levels;

  c->num  = 0;
  c->side = n * size;
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) {
      c->cell[c->num].x     = i * size;
      c->cell[c->num].y     = j * size;
      c->cell[c->num].size  = size;
      c->cell[c->num].order = order;
      c->num++;
    }
}

/* Length of the common part of the sides of two cells. */
static inline PetscInt LatticeTouch(const LatticeCells *c, PetscInt a, PetscInt b)
{
  const PetscInt x = PetscMin(c->cell[a].x + c->cell[a].size, c->cell[b].x + c->cell[b].size) - PetscMax(c->cell[a].x, c->cell[b].x);
  const PetscInt y = PetscMin(c->cell[a].y + c->cell[a].size, c->cell[b].y + c->cell[b].size) - PetscMax(c->cell[a].y, c->cell[b].y);

  return x == 0 && y > 0 ? y : y == 0 && x > 0 ? x : 0;
}

/* Subdivides a cell, and before it neighbours that are larger. Cells before `cell` keep their numbers. */
static inline void LatticeRefine(LatticeCells *c, PetscInt cell)
{
  for (PetscInt k = 0; k < c->num; k++)
    if (c->cell[k].size > c->cell[cell].size && LatticeTouch(c, cell, k)) LatticeRefine(c, k);
  assert_true(c->cell[cell].size > 1 && c->num + 3 <= LATTICE_CELLS);
  c->cell[cell].size /= 2;
  for (int k = 1; k < 4; k++) {
    c->cell[c->num] = c->cell[cell];
    c->cell[c->num].x += (k % 2) * c->cell[cell].size;
    c->cell[c->num++].y += (k / 2) * c->cell[cell].size;
  }
}

/* The cell that has this point of the square inside. */
static inline PetscInt LatticeFind(const LatticeCells *c, PetscReal x, PetscReal y)
{
  for (PetscInt k = 0; k < c->num; k++) {
    const PetscReal u = x * (PetscReal)c->side - (PetscReal)c->cell[k].x, v = y * (PetscReal)c->side - (PetscReal)c->cell[k].y;

    if (PetscMin(u, v) > 0 && PetscMax(u, v) < (PetscReal)c->cell[k].size) return k;
  }
  fail_msg("no cell at %g %g", (double)x, (double)y);
  return -1;
}

/* ---- three dimensions: surface ----------------------------------------------------------------------------------------- */

/* An edge of the space: from (at) along `direction`, of the largest cell at it; order: least of all cells at it. */
typedef struct {
  PetscInt at[2], direction, length, order;
} LatticeEdge;

typedef struct {
  PetscInt  key[5]; /* edge (at, direction, length) and place in it; vertex: its own place, -1, 0, 0; -1 first: nobody shares it */
  PetscReal at[2];  /* in units of the finest cell */
  PetscInt  num, master[LATTICE_ROW];
  PetscReal weight[LATTICE_ROW];
} LatticeNode;

typedef struct {
  const LatticeCells *cells;
  LatticeNode        *node;
  PetscInt            num;
} LatticeBuild;

static inline PetscInt LatticeNodeGet(LatticeBuild *b, const PetscInt key[5], const PetscReal at[2], PetscBool *found)
{
  *found = PETSC_TRUE;
  for (PetscInt k = 0; k < b->num && key[0] >= 0; k++)
    if (!memcmp(b->node[k].key, key, sizeof(b->node[k].key))) return k;
  *found = PETSC_FALSE;
  memset(&b->node[b->num], 0, sizeof(LatticeNode));
  memcpy(b->node[b->num].key, key, sizeof(b->node->key));
  memcpy(b->node[b->num].at, at, sizeof(b->node->at));
  return b->num++;
}

/* The edge of which [at, at + length] is a part. */
static inline LatticeEdge LatticeEdgeAt(const LatticeCells *c, const PetscInt at[2], PetscInt direction, PetscInt length)
{
  LatticeEdge e = {{at[0], at[1]}, direction, length, MORTISE_MAX_ORDER};

  for (int pass = 0; pass < 2; pass++)
    for (PetscInt k = 0; k < c->num; k++) {
      const PetscInt low[2] = {c->cell[k].x, c->cell[k].y}, size = c->cell[k].size, d = direction;

      if (at[1 - d] != low[1 - d] && at[1 - d] != low[1 - d] + size) continue;
      if (pass && low[d] + size > e.at[d] && low[d] < e.at[d] + e.length) e.order = PetscMin(e.order, c->cell[k].order);
      if (pass || size <= e.length || low[d] > at[d] || low[d] + size < at[d] + length) continue;
      e.at[d]  = low[d];
      e.length = size;
    }
  return e;
}

static inline PetscInt LatticeVertex(LatticeBuild *b, const PetscInt at[2]);

/* Node `place` of the edge. */
static inline PetscInt LatticeEdgeNode(LatticeBuild *b, const LatticeEdge *e, PetscInt place)
{
  const PetscInt   end[2] = {e->at[0] + (e->direction == 0) * e->length, e->at[1] + (e->direction == 1) * e->length};
  const PetscInt   key[5] = {e->at[0], e->at[1], e->direction, e->length, place};
  const PetscReal *point;
  PetscBool        found;

  if (place == 0 || place == e->order) return LatticeVertex(b, place ? end : e->at);
  assert_int_equal(ElementGetNodes(e->order, &point), 0);
  return LatticeNodeGet(
      b, key,
      (PetscReal[2]){(PetscReal)e->at[0] + point[place] * (PetscReal)(end[0] - e->at[0]), (PetscReal)e->at[1] + point[place] * (PetscReal)(end[1] - e->at[1])},
      &found);
}

static inline void LatticeAdd(LatticeNode *row, PetscInt master, PetscReal weight)
{
  PetscInt k = 0;

  while (k < row->num && row->master[k] != master) k++;
  assert_true(k < LATTICE_ROW);
  if (k == row->num) row->master[row->num++] = master;
  row->weight[k] += weight;
}

/* Makes the node hang at `place` of the edge; an end that hangs itself (the corner in the middle of a coarse edge) gives its masters. */
static inline void LatticeHang(LatticeBuild *b, PetscInt node, const LatticeEdge *e, PetscReal place)
{
  PetscReal   value[LATTICE_ROW];
  LatticeNode row = b->node[node];

  assert_int_equal(ElementEvaluate1D(e->order, place, value, NULL), 0);
  for (PetscInt k = 0; k <= e->order; k++) {
    const PetscInt     n = LatticeEdgeNode(b, e, k);
    const LatticeNode *m = &b->node[n];

    if (value[k] == 0) continue;
    if (m->num == 0) LatticeAdd(&row, n, value[k]);
    for (PetscInt i = 0; i < m->num; i++) LatticeAdd(&row, m->master[i], value[k] * m->weight[i]);
  }
  b->node[node] = row;
}

static inline PetscInt LatticeVertex(LatticeBuild *b, const PetscInt at[2])
{
  const LatticeCells *c      = b->cells;
  const PetscInt      key[5] = {at[0], at[1], -1, 0, 0};
  PetscBool           found;
  const PetscInt      node = LatticeNodeGet(b, key, (PetscReal[2]){(PetscReal)at[0], (PetscReal)at[1]}, &found);

  for (PetscInt k = 0; k < c->num && !found; k++) {
    const PetscInt low[2] = {c->cell[k].x, c->cell[k].y}, size = c->cell[k].size;

    for (int d = 0; d < 2 && !found; d++) {
      if ((at[1 - d] != low[1 - d] && at[1 - d] != low[1 - d] + size) || at[d] <= low[d] || at[d] >= low[d] + size) continue;
      LatticeEdge e = LatticeEdgeAt(c, (PetscInt[2]){d ? at[0] : low[0], d ? low[1] : at[1]}, d, size);

      LatticeHang(b, node, &e, (PetscReal)(at[d] - e.at[d]) / (PetscReal)e.length);
      found = PETSC_TRUE;
    }
  }
  return node;
}

/* Node (i, j) of a cell's lattice. */
static inline PetscInt LatticeCellNode(LatticeBuild *b, PetscInt cell, PetscInt i, PetscInt j)
{
  const PetscInt   p = b->cells->cell[cell].order, size = b->cells->cell[cell].size, low[2] = {b->cells->cell[cell].x, b->cells->cell[cell].y};
  const PetscInt   d = i == 0 || i == p, across = d ? i : j, along = d ? j : i; /* a side along d, if it is one */
  PetscInt         start[2] = {low[0], low[1]}, node;
  PetscBool        found;
  const PetscReal *point;

  assert_int_equal(ElementGetNodes(p, &point), 0);
  const PetscReal at[2] = {(PetscReal)low[0] + point[i] * (PetscReal)size, (PetscReal)low[1] + point[j] * (PetscReal)size};
  if (across % p) return LatticeNodeGet(b, (const PetscInt[5]){-1}, at, &found);
  if (along % p == 0) return LatticeVertex(b, (const PetscInt[2]){low[0] + i / p * size, low[1] + j / p * size});
  start[1 - d] += across / p * size;
  LatticeEdge e = LatticeEdgeAt(b->cells, start, d, size);
  if (e.length == size && e.order == p) return LatticeEdgeNode(b, &e, along);
  node = LatticeNodeGet(b, (const PetscInt[5]){-1}, at, &found);
  LatticeHang(b, node, &e, ((PetscReal)(start[d] - e.at[d]) + point[along] * (PetscReal)size) / (PetscReal)e.length);
  return node;
}

static inline void LatticeFlat(const PetscReal at[2], PetscReal X[3])
{
  X[0] = at[0], X[1] = at[1], X[2] = 0;
}

/* The surface of the cells; map: the unit square into space (true nodes only: hanging ones follow). */
static inline void LatticeSquare(LatticeSurface *l, const LatticeCells *c, void (*map)(const PetscReal at[2], PetscReal X[3]))
{
  LatticeBuild b    = {.cells = c};
  PetscInt     room = 0, rows = 0;

  memset(l, 0, sizeof(*l));
  l->first = calloc((size_t)c->num + 1, sizeof(PetscInt));
  for (PetscInt k = 0; k < c->num; k++) l->first[k + 1] = l->first[k] + (c->cell[k].order + 1) * (c->cell[k].order + 1);
  room       = 2 * l->first[c->num];
  b.node     = calloc((size_t)room, sizeof(LatticeNode));
  l->order   = calloc((size_t)c->num, 1);
  l->facets  = calloc((size_t)(4 * c->num), sizeof(PetscInt));
  l->lattice = calloc((size_t)l->first[c->num], sizeof(PetscInt));
  for (PetscInt k = 0; k < c->num; k++) {
    const PetscInt p = c->cell[k].order, corner[4] = {0, p, (p + 1) * (p + 1) - 1, p * (p + 1)};

    l->order[k] = (int8_t)p;
    for (PetscInt a = 0; a < (p + 1) * (p + 1); a++) l->lattice[l->first[k] + a] = LatticeCellNode(&b, k, a % (p + 1), a / (p + 1));
    for (int v = 0; v < 4; v++) l->facets[4 * k + v] = l->lattice[l->first[k] + corner[v]];
  }
  for (PetscInt n = 0; n < b.num; n++) rows += b.node[n].num;
  l->hang   = calloc((size_t)b.num + 1, sizeof(PetscInt));
  l->master = calloc((size_t)rows + 1, sizeof(PetscInt));
  l->weight = calloc((size_t)rows + 1, sizeof(PetscReal));
  l->X      = calloc(3 * (size_t)b.num, sizeof(PetscReal));
  for (PetscInt n = 0; n < b.num; n++) {
    if (b.node[n].num == 0) map((PetscReal[2]){b.node[n].at[0] / (PetscReal)c->side, b.node[n].at[1] / (PetscReal)c->side}, l->X + 3 * n);
    l->hang[n + 1] = l->hang[n] + b.node[n].num;
    for (PetscInt k = 0; k < b.node[n].num; k++) {
      l->master[l->hang[n] + k] = b.node[n].master[k];
      l->weight[l->hang[n] + k] = b.node[n].weight[k];
    }
  }
  for (PetscInt n = 0; n < b.num; n++)
    for (PetscInt k = l->hang[n]; k < l->hang[n + 1]; k++)
      for (int d = 0; d < 3; d++) l->X[3 * n + d] += l->weight[k] * l->X[3 * l->master[k] + d];
  free(b.node);
  LatticeClose(l, 3, b.num, c->num);
}
