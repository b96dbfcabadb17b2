/* Room in the matrix for contact. An edge's pattern is a superset of the nodes it meets, so that sliding a little changes no pattern
   and the symbolic factorisation stands; it only grows. */
#include "interfaceimpl.h"

static PetscBool Has_Private(const PetscInt *list, PetscInt num, PetscInt value)
{
  for (PetscInt i = 0; i < num; ++i) {
    if (list[i] == value) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscErrorCode Replace_Private(Contact *c, PetscInt offset[], PetscInt list[])
{
  PetscFunctionBegin;
  PetscCall(PetscFree(c->pattern_offset));
  PetscCall(PetscFree(c->pattern));
  c->pattern_offset = offset;
  c->pattern        = list;
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { LISTS = 2 + MOST_MULTIPLIERS }; /* of facets: contact, slip, each component of a tied pair */

/* A list's results by facet (-1: none), NULL: the pair has no such list. */
static const PetscInt *Results_Private(const Contact *c, PetscInt list)
{
  if (list == 0) return c->result;
  if (list == 1) return c->slip ? c->slip->result : NULL;
  return c->tie && list - 2 < c->num ? c->tie->result[list - 2] : NULL;
}

/* What a facet of this list meets, NULL: nothing, or nothing that takes part in the next linear solve. */
static const ContactFacet *Met_Private(const Contact *c, PetscInt list, PetscInt facet)
{
  const PetscInt     *result = Results_Private(c, list), at = result ? result[facet] : -1;
  const ContactFacet *e;

  if (at < 0) return NULL;
  e = list == 0 ? &c->facets[at] : list == 1 ? &c->slip->facets[at] : &c->tie->facets[list - 2][at].facet;
  for (PetscInt i = 0; i < e->num_rows; ++i) {
    if (c->near[e->nodes[i]]) return e;
  }
  return NULL;
}

static PetscBool Holds_Private(const Contact *c)
{
  for (PetscInt i = 0; i < LISTS * c->side[0].num_facets; ++i) {
    const ContactFacet *e = Met_Private(c, i % LISTS, i / LISTS);
    if (!e) continue;
    if (!c->pattern_offset) return PETSC_FALSE;
    const PetscInt *list = c->pattern + c->pattern_offset[e->facet], num = c->pattern_offset[e->facet + 1] - c->pattern_offset[e->facet];
    for (PetscInt a = 0; a < e->num; ++a) {
      if (!Has_Private(list, num, e->nodes[a])) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

static PetscErrorCode Append_Private(PetscInt **list, PetscInt *num, PetscInt *size, PetscInt from, PetscInt value)
{
  PetscFunctionBegin;
  if (Has_Private(*list + from, *num - from, value)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayGrow(*num + 1, sizeof(PetscInt), size, list));
  (*list)[(*num)++] = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In the plane also all nodes of the facets at the node, and (depth 2) of those at these. In three dimensions the ring of neighbours would cost more in the
   factors than a new pattern now and then. */
static PetscErrorCode AppendAround_Private(const Surface *s, PetscInt node, PetscInt depth, PetscInt **list, PetscInt *num, PetscInt *size, PetscInt from)
{
  PetscFunctionBegin;
  PetscCall(Append_Private(list, num, size, from, ~node));
  for (PetscInt k = s->node_first[node]; k < s->node_first[node + 1] && s->dim == 2 && depth; ++k) {
    const PetscInt facet = s->node_facet[k];
    for (PetscInt i = s->first[facet]; i < s->first[facet + 1]; ++i) PetscCall(AppendAround_Private(s, s->lattice[i], depth - 1, list, num, size, from));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AppendMet_Private(const Contact *c, const ContactFacet *e, PetscInt **list, PetscInt *num, PetscInt *size, PetscInt from)
{
  PetscFunctionBegin;
  for (PetscInt a = 0; a < e->num; ++a) {
    if (!NODE_SIDE(e->nodes[a]))
      PetscCall(Append_Private(list, num, size, from, e->nodes[a]));
    else
      PetscCall(AppendAround_Private(&c->side[1], NODE_INDEX(e->nodes[a]), c->side[1].higher ? 1 : 2, list, num, size, from));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Grow_Private(Contact *c)
{
  const PetscInt ne = c->side[0].num_facets;
  PetscInt      *offset, *list = NULL, num = 0, size = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(ne + 1, &offset));
  for (PetscInt edge = 0; edge < ne; ++edge) {
    offset[edge] = num;
    if (c->pattern_offset) {
      for (PetscInt k = c->pattern_offset[edge]; k < c->pattern_offset[edge + 1]; ++k)
        PetscCall(Append_Private(&list, &num, &size, offset[edge], c->pattern[k]));
    }
    for (PetscInt l = 0; l < LISTS; ++l) {
      const ContactFacet *e = Met_Private(c, l, edge);
      if (e) PetscCall(AppendMet_Private(c, e, &list, &num, &size, offset[edge]));
    }
  }
  offset[ne] = num;
  PetscCall(Replace_Private(c, offset, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceGrow(Interface p, PetscBool *grown)
{
  PetscFunctionBegin;
  *grown = PETSC_FALSE;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    if (Holds_Private(&p->contacts[i])) continue;
    PetscCall(Grow_Private(&p->contacts[i]));
    *grown = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ContactPatternSize_Private(const Contact *c, PetscInt facet)
{
  if (!c->pattern_offset) return 0; /* none of the facets evaluated on this rank has met anything yet */
  const PetscInt num = c->pattern_offset[facet + 1] - c->pattern_offset[facet];
  return (c->side[0].dim + c->num) * num + (num ? c->num_q : 0);
}

PetscBool ContactPatternHas_Private(const Contact *c, PetscInt facet, PetscInt node)
{
  if (!c->pattern_offset) return PETSC_FALSE;
  return Has_Private(c->pattern + c->pattern_offset[facet], c->pattern_offset[facet + 1] - c->pattern_offset[facet], node);
}

/* Is the nonmortar node one of the facet's multipliers? In two dimensions its outer neighbours stand in the pattern too. */
static PetscBool CarriesRow_Private(const Surface *s, PetscInt facet, PetscInt node)
{
  const PetscInt *own, num = SurfaceNodes_Private(s, facet, &own);
  return (PetscBool)(s->dim == 3 || Has_Private(own, num, node));
}

PetscInt ContactPatternDofs_Private(const Contact *c, PetscInt facet, PetscInt dofs[])
{
  const PetscInt dim = c->side[0].dim;
  PetscInt       num = 0;
  if (!c->pattern_offset) return 0;
  for (PetscInt k = c->pattern_offset[facet]; k < c->pattern_offset[facet + 1]; ++k) {
    const PetscInt node = NODE_INDEX(c->pattern[k]), *dof = c->side[NODE_SIDE(c->pattern[k])].dof + dim * node;
    for (PetscInt d = 0; d < dim; ++d) {
      if (dof[d] >= 0) dofs[num++] = dof[d];
    }
    if (NODE_SIDE(c->pattern[k]) || c->zdof[node] < 0 || !CarriesRow_Private(&c->side[0], facet, node)) continue;
    for (PetscInt i = 0; i < c->num; ++i) dofs[num++] = c->zdof[node] + i;
  }
  for (PetscInt m = 0; m < c->num_q && c->pattern_offset[facet + 1] > c->pattern_offset[facet]; ++m) dofs[num++] = c->q_row[m];
  return num;
}

/* A clique of `num` rows, which the array ends with, in ascending order. */
static PetscErrorCode Close_Private(PetscInt num, PetscInt *total, PetscInt array[])
{
  PetscFunctionBegin;
  if (!num) PetscFunctionReturn(PETSC_SUCCESS);
  array[*total] = num;
  PetscCall(PetscSortInt(num, array + *total + 1)); /* new entries then move those behind them less */
  *total += num + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InterfaceCliques(Interface p, PetscInt *num, PetscInt **cliques)
{
  PetscInt size = 0;

  PetscFunctionBegin;
  *num     = 0;
  *cliques = NULL;
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    const Contact *c = &p->contacts[i];
    for (PetscInt e = 0; e < c->side[0].num_facets && c->pattern_offset; ++e) {
      PetscCall(ArrayGrow(*num + 1 + ContactPatternSize_Private(c, e), sizeof(PetscInt), &size, cliques));
      PetscCall(Close_Private(ContactPatternDofs_Private(c, e, *cliques + *num + 1), num, *cliques));
    }
    for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
      if (c->zlocal[j] < 0) continue;
      PetscCall(ArrayGrow(*num + 1 + c->num, sizeof(PetscInt), &size, cliques));
      for (PetscInt k = 0; k < c->num; ++k) (*cliques)[*num + 1 + k] = c->zdof[j] + k;
      PetscCall(Close_Private(c->num, num, *cliques));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceGetPattern(Interface p, PetscInt pair, const PetscInt **first, const PetscInt **node)
{
  *first = p->contacts[pair].pattern_offset;
  *node  = p->contacts[pair].pattern;
}

PetscErrorCode InterfaceSetPattern(Interface p, PetscInt pair, const PetscInt first[], const PetscInt node[])
{
  Contact       *c   = &p->contacts[pair];
  const PetscInt num = c->side[0].num_facets;
  PetscInt      *offset, *list;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num + 1, &offset));
  for (PetscInt i = 0; i < c->num_listed; ++i) offset[c->listed[i] + 1] = first[c->listed[i] + 1] - first[c->listed[i]];
  for (PetscInt f = 0; f < num; ++f) offset[f + 1] += offset[f];
  PetscCall(PetscMalloc1(offset[num], &list));
  for (PetscInt f = 0; f < num; ++f) PetscCall(PetscArraycpy(list + offset[f], node + first[f], offset[f + 1] - offset[f]));
  PetscCall(Replace_Private(c, offset, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}
