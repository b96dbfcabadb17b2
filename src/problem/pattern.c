/* Room in the matrix for contact. An edge's pattern is a superset of the nodes it meets, so that sliding a little changes no pattern
   and the symbolic factorisation stands; it only grows. */
#include "problemimpl.h"

static PetscBool Has_Private(const PetscInt *list, PetscInt num, PetscInt value)
{
  for (PetscInt i = 0; i < num; ++i) {
    if (list[i] == value) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool ContactPatternHolds_Private(const Contact *c)
{
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    const ContactEdge *e = &c->edges[i];
    if (!c->pattern_offset) return PETSC_FALSE;
    const PetscInt *list = c->pattern + c->pattern_offset[e->edge], num = c->pattern_offset[e->edge + 1] - c->pattern_offset[e->edge];
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
  if (*num == *size) {
    *size = PetscMax(64, 2 * *size);
    PetscCall(PetscRealloc(*size * sizeof(PetscInt), list));
  }
  (*list)[(*num)++] = value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The node next to n along the surface, through its edge on the given side (0: before, 1: after); -1 at an end. */
static PetscInt Neighbour_Private(const Surface *s, PetscInt n, PetscInt which)
{
  const PetscInt e = s->node_edge[2 * n + which];
  return e < 0 ? -1 : s->edges[2 * e + which];
}

static PetscErrorCode AppendAround_Private(const Surface *s, PetscInt node, PetscInt depth, PetscInt **list, PetscInt *num, PetscInt *size, PetscInt from)
{
  PetscFunctionBegin;
  PetscCall(Append_Private(list, num, size, from, ~node));
  for (PetscInt which = 0; which < 2; ++which) {
    for (PetscInt k = 0, n = Neighbour_Private(s, node, which); k < depth && n >= 0; ++k, n = Neighbour_Private(s, n, which))
      PetscCall(Append_Private(list, num, size, from, ~n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactGrowPattern_Private(Contact *c)
{
  const PetscInt ne = c->side[0].num_edges;
  PetscInt      *offset, *list = NULL, num = 0, size = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(ne + 1, &offset));
  for (PetscInt edge = 0; edge < ne; ++edge) {
    offset[edge] = num;
    if (c->pattern_offset) {
      for (PetscInt k = c->pattern_offset[edge]; k < c->pattern_offset[edge + 1]; ++k)
        PetscCall(Append_Private(&list, &num, &size, offset[edge], c->pattern[k]));
    }
    if (c->result[edge] < 0) continue;
    const ContactEdge *e = &c->edges[c->result[edge]];
    for (PetscInt a = 0; a < e->num; ++a) {
      if (!NODE_SIDE(e->nodes[a]))
        PetscCall(Append_Private(&list, &num, &size, offset[edge], e->nodes[a]));
      else
        PetscCall(AppendAround_Private(&c->side[1], NODE_INDEX(e->nodes[a]), 2, &list, &num, &size, offset[edge]));
    }
  }
  offset[ne] = num;
  PetscCall(PetscFree(c->pattern_offset));
  PetscCall(PetscFree(c->pattern));
  c->pattern_offset = offset;
  c->pattern        = list;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ContactPatternDofs_Private(const Contact *c, PetscInt edge, PetscInt dofs[])
{
  PetscInt num = 0;
  if (!c->pattern_offset) return 0; /* none of the edges evaluated on this rank has met anything yet */
  for (PetscInt k = c->pattern_offset[edge]; k < c->pattern_offset[edge + 1] && num + 4 < MOST_PATTERN_DOFS; ++k) {
    const PetscInt *dof = c->side[NODE_SIDE(c->pattern[k])].dof + 2 * NODE_INDEX(c->pattern[k]);
    if (dof[0] >= 0) dofs[num++] = dof[0];
    if (dof[1] >= 0) dofs[num++] = dof[1];
  }
  if (num == 0) return 0;
  for (PetscInt k = 0; k < 2; ++k) {
    const PetscInt z = c->zdof[c->side[0].edges[2 * edge + k]];
    if (z >= 0) dofs[num++] = z;
  }
  return num;
}
