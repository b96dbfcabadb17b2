/* Values of contact surfaces between ranks: only those that somebody needs, only between ranks that share a node.

   A node's values belong to one rank, its owner, which evaluates all nonmortar facets that carry weight to it and so has its gap and weight without asking.
   After a search every rank knows which of its facets may meet the mortar side (live). It then needs: positions of all nodes of the facets around a live one
   and of its mortar candidates; multipliers, gaps and weights of the former, and of the nodes of its own facets beside a live one. Owners tell users
   (LinkSpread); contact forces go back (LinkCollect). A rank whose facets meet nothing sends and receives nothing.

   Entries that a rank has not got are NaN, so that a value nobody sent cannot be used unseen. */
#include "interfaceimpl.h"

PetscErrorCode LinkDestroy_Private(Link *l)
{
  PetscFunctionBegin;
  PetscCall(PetscSFDestroy(&l->sf));
  PetscCall(PetscFree(l->nodes));
  PetscCall(PetscMemzero(l, sizeof(*l)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LinkSet_Private(Interface p, const Surface *s, PetscInt num, const PetscInt nodes[], Link *l)
{
  PetscSFNode       *remote;
  PetscInt          *local;
  const PetscMPIInt *rank;
  const PetscInt    *offset;

  PetscFunctionBegin;
  PetscCall(LinkDestroy_Private(l));
  PetscCall(PetscMalloc1(num, &l->nodes));
  PetscCall(PetscArraycpy(l->nodes, nodes, num));
  l->num = num;
  PetscCall(PetscMalloc1(num, &remote));
  PetscCall(PetscMalloc1(num, &local));
  for (PetscInt i = 0; i < num; ++i) {
    local[i]  = nodes[i];
    remote[i] = (PetscSFNode){s->owner[nodes[i]], nodes[i]};
  }
  PetscCall(PetscSFCreate(p->comm, &l->sf));
  PetscCall(PetscSFSetGraph(l->sf, s->num_nodes, num, local, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(l->sf));
  PetscCall(PetscSFGetRootRanks(l->sf, &l->num_from, NULL, NULL, NULL, NULL));
  PetscCall(PetscSFGetLeafRanks(l->sf, &l->num_to, &rank, &offset, NULL));
  l->num_told = l->num_to ? offset[l->num_to] : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Owned nodes are no leaves and others no roots: one array serves both. */
PetscErrorCode LinkSpread_Private(Interface p, const Link *l, PetscInt size, PetscReal values[])
{
  PetscFunctionBegin;
  if (!l->sf) PetscFunctionReturn(PETSC_SUCCESS); /* one rank, or no search yet */
  PetscCall(PetscSFBcastBegin(l->sf, p->unit[size], values, values, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(l->sf, p->unit[size], values, values, MPI_REPLACE));
  p->traffic.messages += l->num_to;
  p->traffic.bytes += (PetscReal)l->num_told * (PetscReal)size * sizeof(PetscReal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LinkCollect_Private(Interface p, const Link *l, PetscInt size, PetscReal values[])
{
  PetscFunctionBegin;
  if (!l->sf) PetscFunctionReturn(PETSC_SUCCESS); /* one rank, or no search yet */
  PetscCall(PetscSFReduceBegin(l->sf, p->unit[size], values, values, MPI_SUM));
  PetscCall(PetscSFReduceEnd(l->sf, p->unit[size], values, values, MPI_SUM));
  p->traffic.messages += l->num_from;
  p->traffic.bytes += (PetscReal)l->num * (PetscReal)size * sizeof(PetscReal);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Hanging nodes have what all their masters have. */
static void Hanging_Private(const Surface *s, PetscBool has[])
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (s->hang[n] == s->hang[n + 1]) continue;
    has[n] = PETSC_TRUE;
    for (PetscInt k = s->hang[n]; k < s->hang[n + 1]; ++k) has[n] = (PetscBool)(has[n] && has[s->hang_master[k]]);
  }
}

/* Poison what is not known. */
static void Poison_Private(PetscInt num, const PetscBool has[], PetscInt size, PetscReal values[])
{
  for (PetscInt n = 0; n < num; ++n) {
    for (PetscInt c = 0; c < size && !has[n]; ++c) values[size * n + c] = NAN;
  }
}

void SurfaceForget_Private(Surface *s)
{
  for (PetscInt n = 0; n < s->num_nodes; ++n) s->has[n] = s->here[n];
  Hanging_Private(s, s->has);
  Poison_Private(s->num_nodes, s->has, s->dim, s->x);
  Poison_Private(s->num_nodes, s->has, s->dim, s->du);
}

static void Mark_Private(const Surface *s, PetscInt facet, PetscBool mark[])
{
  for (PetscInt k = s->true_first[facet]; k < s->true_first[facet + 1]; ++k) mark[s->true_node[k]] = PETSC_TRUE;
}

/* Ends of the edges on which a corner hangs, and those they hang on themselves. */
static void MarkParents_Private(const Surface *s, const PetscInt parent[], PetscInt node, PetscBool mark[])
{
  for (PetscInt e = 0; e < 2 && parent[2 * node] >= 0; ++e) {
    const PetscReal *weight;
    const PetscInt  *master, *end = &parent[2 * node + e], num = SurfaceRow_Private(s, end, &master, &weight);
    for (PetscInt k = 0; k < num; ++k) mark[master[k]] = PETSC_TRUE;
    MarkParents_Private(s, parent, *end, mark);
  }
}

/* Is a facet that carries weight to the node live? Known at owned nodes and those of this rank's facets. */
PetscBool ContactSees_Private(const Contact *c, PetscInt node)
{
  const Surface *s = &c->side[0];

  for (PetscInt k = s->node_first[node]; k < s->node_first[node + 1]; ++k) {
    if (c->live[s->node_facet[k]]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Nodes of both sides that this rank needs: for the facets it evaluates, to know the values on its own facets, and for the pressure at owned nodes without
   multiplier. own: set for all nodes of its own facets. */
static void Need_Private(const Contact *c, PetscBool *need[2], PetscBool own[])
{
  const Surface   *s = &c->side[0], *m = &c->side[1];
  const PetscInt  *start, *candidate, *donor;
  const PetscReal *weight;

  ContactPairGetCandidates(c->pair, &start, &candidate);
  const PetscInt *parent = ContactPairGetMortarParents(c->pair);
  for (PetscInt i = 0; i < c->num_listed; ++i) {
    const PetscInt f = c->listed[i];
    for (PetscInt k = s->true_first[f]; start[i] < start[i + 1] && k < s->true_first[f + 1]; ++k) {
      const PetscInt n = s->true_node[k];
      for (PetscInt j = s->node_first[n]; j < s->node_first[n + 1]; ++j) Mark_Private(s, s->node_facet[j], need[0]);
    }
    for (PetscInt k = start[i]; k < start[i + 1]; ++k) {
      Mark_Private(m, candidate[k], need[1]);
      for (PetscInt v = 0; parent && v < m->corners; ++v) MarkParents_Private(m, parent, m->facets[m->corners * candidate[k] + v], need[1]);
    }
  }
  for (PetscInt i = 0; i < s->num_mine; ++i) Mark_Private(s, s->mine[i], own);
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (own[n] && ContactSees_Private(c, n)) need[0][n] = PETSC_TRUE;
  }
  ContactPairGetDonors(c->pair, &start, &donor, &weight);
  for (PetscInt n = 0; n < s->num_nodes && start; ++n) {
    for (PetscInt k = start[n]; k < start[n + 1] && s->owned[n] && ContactSees_Private(c, n); ++k) need[0][donor[k]] = PETSC_TRUE;
  }
}

/* Both links of a side made for what is needed, if that is not what they are made for. */
static PetscErrorCode Links_Private(Interface p, Surface *s, const PetscBool need[])
{
  PetscInt *nodes[2], num[2] = {0, 0};
  PetscBool same = PETSC_FALSE;
  int       all;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s->num_nodes, &nodes[0], s->num_nodes, &nodes[1]));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    if (!need[n] || s->owned[n]) continue;
    nodes[0][num[0]++] = n;
    if (!s->here[n]) nodes[1][num[1]++] = n;
  }
  if (s->values.sf && s->values.num == num[0]) PetscCall(PetscArraycmp(s->values.nodes, nodes[0], num[0], &same));
  all = same;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, p->comm));
  if (!all) {
    PetscCall(LinkSet_Private(p, s, num[0], nodes[0], &s->values));
    PetscCall(LinkSet_Private(p, s, num[1], nodes[1], &s->places));
  }
  PetscCall(PetscFree2(nodes[0], nodes[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values that nobody needs to send are 0: nodes of this rank's facets that see nothing. */
static void Values_Private(Contact *c, const PetscBool need[], const PetscBool own[])
{
  Surface       *s   = &c->side[0];
  const PetscInt num = s->num_nodes, lists = 2 + c->num;
  PetscReal     *values[2 + MOST_MULTIPLIERS] = {c->gap, c->weight};

  for (PetscInt k = 0; k < c->num; ++k) values[2 + k] = c->z + num * k;
  for (PetscInt n = 0; n < num; ++n) {
    c->valued[n] = (PetscBool)(s->owned[n] || need[n] || own[n]);
    for (PetscInt k = 0; k < lists && own[n] && !s->owned[n] && !need[n]; ++k) values[k][n] = 0;
  }
  Hanging_Private(s, c->valued);
  c->num_valued = 0;
  for (PetscInt n = 0; n < num; ++n) {
    if (c->valued[n]) c->valued_node[c->num_valued++] = n;
    if (!c->valued[n]) c->active[n] = c->near[n] = PETSC_FALSE;
    if (s->hang[n] < s->hang[n + 1]) c->gap[n] = c->weight[n] = 0;
  }
  for (PetscInt k = 0; k < lists; ++k) Poison_Private(num, c->valued, 1, values[k]);
}

PetscErrorCode ContactLink_Private(Interface p, Contact *c)
{
  PetscBool *need[2], *own;

  PetscFunctionBegin;
  PetscCall(PetscCalloc3(c->side[0].num_nodes, &need[0], c->side[1].num_nodes, &need[1], c->side[0].num_nodes, &own));
  Need_Private(c, need, own);
  for (PetscInt k = 0; k < 2; ++k) {
    Surface *s = &c->side[k];
    if (p->size > 1) PetscCall(Links_Private(p, s, need[k]));
    for (PetscInt n = 0; n < s->num_nodes; ++n) s->has[n] = (PetscBool)(s->here[n] || need[k][n]);
    Hanging_Private(s, s->has);
    Poison_Private(s->num_nodes, s->has, s->dim, s->x);
    Poison_Private(s->num_nodes, s->has, s->dim, s->du);
  }
  Values_Private(c, need[0], own);
  PetscCall(PetscFree3(need[0], need[1], own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void InterfaceGetTraffic(Interface p, ContactTraffic *traffic)
{
  *traffic = p->traffic;
}
