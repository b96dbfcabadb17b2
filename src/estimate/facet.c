/* Facets that carry a traction defect: who sits on their sides, and where their points lie in each of them. */
#include "estimateimpl.h"

/* Index in the 3^dim closure table of a side. */
static PetscInt SideIndex_Private(PetscInt dim, PetscInt side)
{
  PetscInt index = 0, stride = 1;
  for (PetscInt d = 0; d < dim; ++d, stride *= 3) index += (d == side / 2 ? 2 * (side % 2) : 1) * stride;
  return index;
}

/* Map from the frame of `facet` through the frame of `whole` (itself or an ancestor, which is a whole side of the leaf) to the leaf. */
static void SidePlace_Private(const ForestTables *t, PetscInt leaf, PetscInt facet, PetscInt whole, FacetSide *s)
{
  const PetscInt offset = t->closure_offset[t->first[t->dim] + leaf], d = t->dim - 1;
  PetscReal      start[2] = {0, 0}, slope[2] = {1, 1};
  int8_t         code;

  for (PetscInt f = facet; f != whole; f = t->parent[f]) {
    for (PetscInt a = 0; a < d; ++a) {
      const int8_t place = t->parent_place[3 * f + a];
      if (place == 2) continue;
      start[a] = 0.5 * (start[a] + place);
      slope[a] *= 0.5;
    }
  }
  for (s->side = 0; t->closure[offset + SideIndex_Private(t->dim, s->side)] != whole;) ++s->side;
  code = t->orientation[offset + SideIndex_Private(t->dim, s->side)];
  for (PetscInt a = 0; a < d; ++a) {
    const PetscBool flip = (PetscBool)((code >> a) & 1);
    const PetscInt  k    = d == 2 && (code & 4) ? 1 - a : a;
    s->axis[k]           = a;
    s->start[k]          = flip ? 1 - start[a] : start[a];
    s->slope[k]          = flip ? -slope[a] : slope[a];
  }
}

void FacetSidePoint_Private(const FacetSide *s, PetscInt dim, const PetscReal eta[], PetscReal xi[3])
{
  for (PetscInt d = 0, k = 0; d < dim; ++d) {
    if (d == s->side / 2)
      xi[d] = s->side % 2;
    else {
      xi[d] = s->start[k] + s->slope[k] * eta[s->axis[k]];
      ++k;
    }
  }
}

/* The leaf on the coarse side of a hanging facet: that of the nearest ancestor that is whole for someone. Not found: leaf -1. */
static void CoarseSide_Private(const ForestTables *t, PetscInt facet, PetscInt *leaf, PetscInt *whole)
{
  const PetscInt first = t->first[t->dim - 1];

  *leaf  = -1;
  *whole = facet;
  for (PetscInt f = t->parent[facet]; f >= 0 && *leaf < 0; f = t->parent[f]) {
    const PetscInt *side = t->facet_leaf + 2 * (f - first);
    *leaf                = side[0] >= 0 ? side[0] : side[1];
    *whole               = f;
  }
}

void FacetConditions_Private(const MechanicsSpec *spec, uint64_t groups, PetscInt dim, PetscInt *fixed, PetscBool *loaded)
{
  *fixed  = 0;
  *loaded = PETSC_FALSE;
  for (PetscInt b = 0; groups && b < spec->num_boundaries; ++b) {
    const BoundarySpec *s = &spec->boundaries[b];
    if (!((groups >> s->group) & 1)) continue;
    for (PetscInt c = 0; c < dim; ++c) {
      if (s->fix[c] || s->displacement[c] || s->rotation) *fixed |= 1 << c;
      if (s->traction[c]) *loaded = PETSC_TRUE;
    }
    if (s->fix_normal) *fixed |= 8;
    if (BoundaryHasPressure(s)) *loaded = PETSC_TRUE;
  }
}

static PetscBool Rigid_Private(const EstimateSum *sum, PetscInt leaf)
{
  return sum->spec->bodies[sum->t->leaf_body[leaf]].material->law->rigid;
}

/* Fill one facet; *take PETSC_FALSE: it has no defect here (no owned deformable side, wholly prescribed, or its halves stand for it). */
static PetscErrorCode Place_Private(const EstimateSum *sum, PetscInt facet, const PetscBool has_child[], const PetscInt leaf_cell[], FacetPlace *f,
                                    PetscBool *take)
{
  const ForestTables *t      = sum->t;
  const PetscInt      entity = t->first[t->dim - 1] + facet, *side = t->facet_leaf + 2 * facet, full = (1 << t->dim) - 1;
  PetscInt            leaf[2] = {side[0] >= 0 ? side[0] : side[1], side[0] >= 0 ? side[1] : -1}, whole[2] = {entity, entity};
  PetscBool           owned = PETSC_FALSE;

  PetscFunctionBegin;
  *take = PETSC_FALSE;
  if (leaf[0] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (leaf[1] < 0 && t->parent[entity] >= 0)
    CoarseSide_Private(t, entity, &leaf[1], &whole[1]);
  else if (leaf[1] < 0 && has_child[facet])
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < 2; ++s) {
    f->side[s].cell = leaf[s] < 0 ? -1 : leaf_cell[leaf[s]];
    if (leaf[s] >= 0 && Rigid_Private(sum, leaf[s])) PetscFunctionReturn(PETSC_SUCCESS); /* the nodes of a shared face move with the rigid body */
    if (f->side[s].cell >= 0 && f->side[s].cell < sum->v->num_owned_cells) owned = PETSC_TRUE;
  }
  f->groups = t->boundary[entity];
  FacetConditions_Private(sum->spec, f->groups, t->dim, &f->fixed, &f->loaded);
  if (!owned || (f->fixed & full) == full) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt s = 0; s < 2; ++s) {
    PetscCheck(leaf[s] < 0 || f->side[s].cell >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "leaf %" PetscInt_FMT " faces an owned one but is not in the ghost layer",
               leaf[s]);
    if (f->side[s].cell >= 0) SidePlace_Private(t, leaf[s], entity, whole[s], &f->side[s]);
  }
  f->facet = facet;
  *take    = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CellFacets_Private(const HPTables *v, FacetList *list)
{
  PetscInt *points;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(v->num_cells + 1, &list->cell_first));
  PetscCall(PetscCalloc1(v->num_cells, &points));
  for (PetscInt i = 0; i < 2 * list->num; ++i) {
    const FacetPlace *f    = &list->facets[i / 2];
    const PetscInt    cell = f->side[i % 2].cell;
    if (cell < 0) continue;
    list->cell_first[cell + 1]++;
    points[cell] += v->dim == 2 ? f->num_1d : f->num_1d * f->num_1d;
  }
  for (PetscInt c = 0; c < v->num_cells; ++c) {
    list->cell_first[c + 1] += list->cell_first[c];
    list->most_points = PetscMax(list->most_points, points[c]);
  }
  PetscCall(PetscMalloc1(list->cell_first[v->num_cells], &list->cell_facet));
  PetscCall(PetscArrayzero(points, v->num_cells));
  for (PetscInt i = 0; i < 2 * list->num; ++i) {
    const PetscInt cell = list->facets[i / 2].side[i % 2].cell;
    if (cell >= 0) list->cell_facet[list->cell_first[cell] + points[cell]++] = i;
  }
  PetscCall(PetscFree(points));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gauss points per direction: those that integrate the square of a degree-p trace of the finer order. */
static PetscErrorCode Points_Private(const EstimateSum *sum, FacetPlace *f, FacetList *list)
{
  PetscFunctionBegin;
  f->order  = HPSpaceGetOrder(sum->space, sum->t->first[sum->t->dim - 1] + f->facet);
  f->num_1d = 0;
  for (PetscInt s = 0; s < 2; ++s) {
    if (f->side[s].cell >= 0) f->num_1d = PetscMax(f->num_1d, sum->v->cell_order[f->side[s].cell] + 1);
  }
  f->first_point = list->num_points;
  list->num_points += sum->t->dim == 2 ? f->num_1d : f->num_1d * f->num_1d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FacetListCreate_Private(const EstimateSum *sum, FacetList *list)
{
  const ForestTables *t     = sum->t;
  const PetscInt      first = t->first[t->dim - 1], num = t->first[t->dim] - first;
  PetscBool          *has_child;
  PetscInt           *leaf_cell, size = 0;

  PetscFunctionBegin;
  PetscCall(PetscMemzero(list, sizeof(*list)));
  PetscCall(PetscCalloc1(num, &has_child));
  PetscCall(PetscMalloc1(t->num_leaves, &leaf_cell));
  for (PetscInt l = 0; l < t->num_leaves; ++l) leaf_cell[l] = -1;
  for (PetscInt c = 0; c < sum->v->num_cells; ++c) leaf_cell[sum->v->cell_leaf[c]] = c;
  for (PetscInt f = 0; f < num; ++f) {
    if (t->parent[first + f] >= first) has_child[t->parent[first + f] - first] = PETSC_TRUE;
  }
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) size += 2 * t->dim;
  size = PetscMin(num, size << t->dim); /* every side may be met by 2^(dim-1) finer ones, twice halved in each direction at the most */
  PetscCall(PetscMalloc1(size, &list->facets));
  for (PetscInt f = 0; f < num; ++f) {
    FacetPlace place;
    PetscBool  take;
    PetscCall(Place_Private(sum, f, has_child, leaf_cell, &place, &take));
    if (!take) continue;
    PetscCheck(list->num < size, PETSC_COMM_SELF, PETSC_ERR_PLIB, "more than %" PetscInt_FMT " facets at owned cells", size);
    PetscCall(Points_Private(sum, &place, list));
    list->facets[list->num++] = place;
  }
  PetscCall(PetscFree(has_child));
  PetscCall(PetscFree(leaf_cell));
  PetscCall(CellFacets_Private(sum->v, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FacetListDestroy_Private(FacetList *list)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(list->facets));
  PetscCall(PetscFree(list->cell_first));
  PetscCall(PetscFree(list->cell_facet));
  PetscFunctionReturn(PETSC_SUCCESS);
}
