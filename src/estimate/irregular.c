/* Cells that a higher order gains little: those with a contact face of order 1 (its error stays), those at the rim of a contact zone, where the pressure
   starts like a root: all that share a vertex with a contact facet of which some nodes are pressed and others are not; likewise at the border between stick and
   slip, where the tangential traction does; and those that touch a place where the kind of condition on the boundary changes, which is taken for singular until
   the coefficients of their solution show (choose.c). */
#include "estimateimpl.h"

#define PRESSED 1e-8 /* of the largest nodal force: less is round-off of an open node */

/* pressed[node], the same on every rank: forces are known to the owners of the nodes alone. Collective. */
static PetscErrorCode Pressed_Private(MPI_Comm comm, const SurfaceView *s, int8_t pressed[])
{
  PetscReal most = 0;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_nodes * s->dim; ++i) {
    if (s->owned[i / s->dim]) most = PetscMax(most, PetscAbsReal(s->force[i]));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPI_MAX, comm));
  PetscCall(PetscArrayzero(pressed, s->num_nodes));
  for (PetscInt i = 0; i < s->num_nodes * s->dim; ++i) {
    if (s->owned[i / s->dim] && PetscAbsReal(s->force[i]) > PRESSED * most) pressed[i / s->dim] = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, pressed, (PetscMPIInt)s->num_nodes, MPI_SIGNED_CHAR, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Touch_Private(const SurfaceView *s, PetscInt facet, int8_t touched[])
{
  for (PetscInt k = 0; k < s->corners; ++k) touched[s->node_entity[s->facets[s->corners * facet + k]]] |= ESTIMATE_IRREGULAR_RIM;
}

/* touched[entity]: a node of a facet on the rim. Collective. */
static PetscErrorCode Rim_Private(MPI_Comm comm, const SurfaceView *s, int8_t touched[])
{
  int8_t *pressed;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_nodes, &pressed));
  PetscCall(Pressed_Private(comm, s, pressed));
  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscInt *node, num = SurfaceFacetNodes(s, e, &node);
    PetscInt        count[2] = {0, 0}; /* open, pressed */
    for (PetscInt k = 0; k < num; ++k) {
      if (s->hang[node[k]] == s->hang[node[k] + 1]) ++count[pressed[node[k]]]; /* a hanging one's masters carry its force */
    }
    if (count[0] && count[1]) Touch_Private(s, e, touched);
  }
  PetscCall(PetscFree(pressed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* touched[entity] of nonmortar facets with nodes in different states of friction, and of mortar facets that face them. Collective. */
static PetscErrorCode Border_Private(MPI_Comm comm, const ContactTerm *term, int8_t touched[])
{
  const SurfaceView *s = &term->view->nonmortar, *m = &term->view->mortar;
  int8_t            *state, *border, *facing;

  PetscFunctionBegin;
  if (!term->view->slip) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(s->num_nodes, &state, s->num_facets, &border, m->num_facets, &facing));
  for (PetscInt i = 0; i < s->num_nodes; ++i) {
    if (s->owned[i]) state[i] = term->view->active[i];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, state, (PetscMPIInt)s->num_nodes, MPI_SIGNED_CHAR, MPI_MAX, comm));
  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscInt *node, num = SurfaceFacetNodes(s, e, &node);
    int8_t          first = 0;
    for (PetscInt k = 0; k < num; ++k) {
      if (!state[node[k]]) continue; /* open, or it hangs: its masters have a state */
      if (first && state[node[k]] != first) border[e] = 1;
      first = state[node[k]];
    }
    if (border[e]) Touch_Private(s, e, touched);
  }
  for (PetscInt f = 0; f < m->num_facets; ++f) {
    for (PetscInt i = term->segment_first[f]; i < term->segment_first[f + 1]; ++i) facing[f] |= border[term->segments[i].facet];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, facing, (PetscMPIInt)m->num_facets, MPI_SIGNED_CHAR, MPI_MAX, comm));
  for (PetscInt f = 0; f < m->num_facets; ++f) {
    if (facing[f]) Touch_Private(m, f, touched);
  }
  PetscCall(PetscFree3(state, border, facing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Contact facets of order 1 on cells of a higher one; of this rank's cells. */
static PetscErrorCode Linear_Private(const EstimateSum *sum, const SurfaceView *s, const PetscInt leaf_cell[], int8_t irregular[])
{
  PetscFunctionBegin;
  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscInt cell = leaf_cell[s->facet_leaf[e]];
    PetscInt       order;
    if (cell < 0 || cell >= sum->v->num_owned_cells) continue;
    order = HPSpaceGetOrder(sum->space, s->facet_entity[e]);
    if (order == 1 && sum->v->cell_order[cell] > 1) irregular[s->facet_leaf[e]] |= ESTIMATE_IRREGULAR_FACE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Outer facets: components prescribed (bits 0..2, 3: the normal one), bit 4: of a contact pair. */
static PetscInt Condition_Private(const EstimateSum *sum, PetscInt facet)
{
  PetscBool loaded;
  PetscInt  condition;

  FacetConditions_Private(sum->spec, sum->t->boundary[facet], sum->t->dim, &condition, &loaded);
  return condition | (sum->contact && ContactTermsHave_Private(sum->contact, facet - sum->t->first[sum->t->dim - 1]) ? 16 : 0);
}

/* touched[entity] of vertices (plane) or edges (space) between outer facets of different conditions. */
static PetscErrorCode Corners_Private(const EstimateSum *sum, int8_t touched[])
{
  const ForestTables *t     = sum->t;
  const PetscInt      first = t->first[t->dim - 1], end = t->first[t->dim], low = t->first[t->dim - 2];
  PetscBool          *has_child;
  int8_t             *seen;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(end - first, &has_child));
  PetscCall(PetscMalloc1(first, &seen));
  for (PetscInt i = 0; i < first; ++i) seen[i] = -1;
  for (PetscInt f = first; f < end; ++f) {
    if (t->parent[f] >= 0) has_child[t->parent[f] - first] = PETSC_TRUE;
  }
  for (PetscInt f = first; f < end; ++f) {
    const PetscInt *leaf = t->facet_leaf + 2 * (f - first), *closure = t->closure + t->closure_offset[f];
    if ((leaf[0] >= 0 && leaf[1] >= 0) || t->parent[f] >= 0 || has_child[f - first]) continue;
    const int8_t condition = (int8_t)Condition_Private(sum, f);
    for (PetscInt i = 0; i < (t->dim == 2 ? 3 : 9); ++i) {
      if (closure[i] < low || closure[i] >= first) continue;
      if (seen[closure[i]] >= 0 && seen[closure[i]] != condition) touched[closure[i]] |= ESTIMATE_IRREGULAR_CORNER;
      seen[closure[i]] = condition;
    }
  }
  PetscCall(PetscFree(seen));
  PetscCall(PetscFree(has_child));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateIrregular_Private(const EstimateSum *sum, int8_t irregular[])
{
  const ForestTables *t = sum->t;
  int8_t             *touched;
  PetscInt           *leaf_cell;
  const Forest        forest = HPSpaceGetForest(sum->space);

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(t->num_entities, &touched));
  PetscCall(PetscMalloc1(t->num_leaves, &leaf_cell));
  for (PetscInt l = 0; l < t->num_leaves; ++l) leaf_cell[l] = -1;
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) leaf_cell[sum->v->cell_leaf[c]] = c;
  for (PetscInt i = 0; sum->contact && i < sum->contact->num; ++i) {
    const ContactView *view = sum->contact->terms[i].view;
    PetscCall(Rim_Private(ForestComm(forest), &view->nonmortar, touched));
    PetscCall(Rim_Private(ForestComm(forest), &view->mortar, touched));
    PetscCall(Border_Private(ForestComm(forest), &sum->contact->terms[i], touched));
    PetscCall(Linear_Private(sum, &view->nonmortar, leaf_cell, irregular));
    PetscCall(Linear_Private(sum, &view->mortar, leaf_cell, irregular));
  }
  PetscCall(Corners_Private(sum, touched));
  for (PetscInt c = 0; c < sum->v->num_owned_cells; ++c) {
    const PetscInt leaf = sum->v->cell_leaf[c], *closure = t->closure + t->closure_offset[t->first[t->dim] + leaf];
    for (PetscInt i = 0; i < (t->dim == 2 ? 9 : 27); ++i) {
      irregular[leaf] |= touched[closure[i]];
    }
  }
  PetscCall(PetscFree(leaf_cell));
  PetscCall(PetscFree(touched));
  PetscFunctionReturn(PETSC_SUCCESS);
}
