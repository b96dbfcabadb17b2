/* The search over ranks. The rank of a nonmortar facet's leaf searches for it; positions within one ring around its facets it has from its own cells and ghost
   cells. 1. Every rank tells all others a few boxes that hold what its nonmortar facets may meet. 2. Mortar facets go, with their positions, to the ranks whose
   boxes theirs meets. 3. Each rank searches over its own and what arrived. 4. Facets that may meet something, and what, are told to the ranks that evaluate
   them too or have facets beside them: positions decide in one place only, and everybody agrees. */
#include "interfaceimpl.h"

#define BOXES 8 /* of a rank */

/* Messages to several ranks, by rank: pairs (rank, item), in any order of ranks but items of one rank in order. */
typedef struct {
  PetscInt    num, size, *rank, *item;
  PetscMPIInt num_to, *to;
  PetscInt   *first; /* [num_to+1] into sorted */
  PetscInt   *sorted;
} Mail;

static PetscErrorCode MailAdd_Private(Mail *m, PetscInt rank, PetscInt item)
{
  PetscFunctionBegin;
  if (m->num == m->size) {
    m->size = 2 * m->size + 64;
    PetscCall(PetscRealloc((size_t)m->size * sizeof(PetscInt), &m->rank));
    PetscCall(PetscRealloc((size_t)m->size * sizeof(PetscInt), &m->item));
  }
  m->rank[m->num]   = rank;
  m->item[m->num++] = item;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MailSort_Private(Mail *m, PetscMPIInt num_ranks)
{
  PetscInt *place;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num_ranks + 1, &place));
  for (PetscInt i = 0; i < m->num; ++i) place[m->rank[i] + 1]++;
  PetscCall(PetscMalloc3(num_ranks, &m->to, num_ranks + 1, &m->first, m->num, &m->sorted));
  m->num_to   = 0;
  m->first[0] = 0;
  for (PetscMPIInt r = 0; r < num_ranks; ++r) {
    if (place[r + 1] > 0) {
      m->to[m->num_to]        = r;
      m->first[m->num_to + 1] = m->first[m->num_to] + place[r + 1];
      m->num_to++;
    }
    place[r + 1] += place[r];
  }
  for (PetscInt i = 0; i < m->num; ++i) m->sorted[place[m->rank[i]]++] = m->item[i];
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MailDestroy_Private(Mail *m)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(m->rank));
  PetscCall(PetscFree(m->item));
  PetscCall(PetscFree3(m->to, m->first, m->sorted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Send_Private(Interface p, const Mail *m, const PetscInt first[], size_t entry, const void *send, PetscInt *num, void *received)
{
  PetscFunctionBegin;
  PetscCall(SparseExchange(p->comm, m->num_to, m->to, first, entry, send, num, received));
  p->traffic.search_messages += m->num_to;
  p->traffic.search_bytes += (PetscReal)first[m->num_to] * (PetscReal)entry;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* To which ranks do nodes of the mortar side have to go? Those of this rank's facets that meet one of a rank's boxes. boxes[size][BOXES] of all ranks. */
static PetscErrorCode Address_Private(Interface p, const Contact *c, const ContactSurface *mortar, PetscReal boxes[][6], Mail *m)
{
  const Surface *s = &c->side[1];
  PetscInt      *told; /* [num_nodes] rank + 1 */
  PetscReal      own[6];

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(s->num_nodes, &told));
  for (PetscMPIInt r = 0; r < p->size; ++r) {
    for (PetscInt i = 0; i < s->num_mine && r != p->rank; ++i) {
      const PetscInt *node, num = SurfaceNodes_Private(s, s->mine[i], &node);
      PetscBool       meets = PETSC_FALSE;
      ContactFacetBox(mortar, s->mine[i], own);
      for (PetscInt k = 0; k < BOXES && !meets; ++k) meets = ContactBoxesMeet(own, boxes[BOXES * r + k]);
      for (PetscInt k = 0; k < num && meets; ++k) {
        if (told[node[k]] != r + 1) PetscCall(MailAdd_Private(m, r, node[k]));
        told[node[k]] = r + 1;
      }
    }
  }
  PetscCall(PetscFree(told));
  PetscCall(MailSort_Private(m, p->size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of the mortar side with their positions to where their facets may be met; those that arrive enter x and has. A facet is known where all its nodes are.
 */
static PetscErrorCode Arrive_Private(Interface p, Contact *c, PetscReal boxes[][6])
{
  Surface             *s   = &c->side[1];
  const PetscInt       dim = s->dim, room = 1 + dim;
  const ContactSurface mortar = SurfaceAt_Private(s, s->x);
  Mail                 m      = {0};
  PetscReal           *send, *got;
  PetscInt             num;

  PetscFunctionBegin;
  PetscCall(Address_Private(p, c, &mortar, boxes, &m));
  PetscCall(PetscMalloc1(room * m.num, &send));
  for (PetscInt i = 0; i < m.num; ++i) {
    send[room * i] = (PetscReal)m.sorted[i];
    PetscCall(PetscArraycpy(send + room * i + 1, s->x + dim * m.sorted[i], dim));
  }
  PetscCall(Send_Private(p, &m, m.first, (size_t)room * sizeof(PetscReal), send, &num, &got));
  for (PetscInt i = 0; i < num; ++i) {
    const PetscInt n = (PetscInt)got[room * i];
    PetscCall(PetscArraycpy(s->x + dim * n, got + room * i + 1, dim));
    s->has[n] = PETSC_TRUE;
  }
  PetscCall(PetscFree(send));
  PetscCall(PetscFree(got));
  PetscCall(MailDestroy_Private(&m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Boxes_Private(Interface p, Contact *c, const ContactSurface *nonmortar, PetscReal margin)
{
  PetscReal(*boxes)[6], own[BOXES][6];
  PetscInt num;

  PetscFunctionBegin;
  PetscCall(ContactPairReach(c->pair, nonmortar, c->side[0].num_mine, c->side[0].mine, c->distance, margin, BOXES, &num, own));
  for (PetscInt k = num; k < BOXES; ++k)
    for (PetscInt i = 0; i < 6; ++i) own[k][i] = i < 3 ? PETSC_MAX_REAL : PETSC_MIN_REAL;
  PetscCall(PetscMalloc1(BOXES * p->size, &boxes));
  PetscCallMPI(MPI_Allgather(own, 6 * BOXES, MPIU_REAL, boxes, 6 * BOXES, MPIU_REAL, p->comm));
  PetscCall(Arrive_Private(p, c, boxes));
  PetscCall(PetscFree(boxes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ranks that evaluate a facet or have one beside it, this one left out. told[size]: work, facet + 1 where it is told already. */
static PetscErrorCode Concerned_Private(Interface p, const Contact *c, const ForestTables *t, PetscInt facet, PetscInt item, PetscInt told[], Mail *m)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  told[p->rank] = facet + 1;
  for (PetscInt i = s->true_first[facet]; i < s->true_first[facet + 1]; ++i) {
    const PetscInt n = s->true_node[i];
    for (PetscInt k = s->node_first[n] - 1; k < s->node_first[n + 1]; ++k) {
      const PetscInt r = k < s->node_first[n] ? s->owner[n] : t->leaf_rank[s->facet_leaf[s->node_facet[k]]];
      if (told[r] == facet + 1) continue;
      told[r] = facet + 1;
      PetscCall(MailAdd_Private(m, r, item));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Runs [first, last] of a list that ascends, into runs (NULL: only counted): the search distance is long, so candidates are most of the other side. */
static PetscInt Runs_Private(PetscInt num, const PetscInt list[], PetscInt runs[])
{
  PetscInt n = 0;

  for (PetscInt i = 0; i < num; ++i) {
    const PetscBool begins = (PetscBool)(i == 0 || list[i] != list[i - 1] + 1);
    if (begins && runs) runs[2 * n] = list[i];
    n += begins;
    if (runs) runs[2 * n - 1] = list[i];
  }
  return n;
}

/* From (facet, number, runs) to (facet, number, candidates…), which replaces it. */
static PetscErrorCode Unpack_Private(PetscInt *num, PetscInt **got)
{
  const PetscInt *g     = *got;
  PetscInt        total = 0, *list, *to;

  PetscFunctionBegin;
  for (PetscInt at = 0; at < *num; at += 2 + 2 * g[at + 1]) {
    total += 2;
    for (PetscInt k = 0; k < g[at + 1]; ++k) total += g[at + 3 + 2 * k] - g[at + 2 + 2 * k] + 1;
  }
  PetscCall(PetscMalloc1(total, &list));
  to = list;
  for (PetscInt at = 0; at < *num; at += 2 + 2 * g[at + 1]) {
    PetscInt *head = to;

    to += 2;
    for (PetscInt k = 0; k < g[at + 1]; ++k)
      for (PetscInt i = g[at + 2 + 2 * k]; i <= g[at + 3 + 2 * k]; ++i) *to++ = i;
    head[0] = g[at];
    head[1] = (PetscInt)(to - head) - 2;
  }
  PetscCall(PetscFree(*got));
  *got = list;
  *num = total;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Candidates of this rank's facets to those concerned; what others told as (facet, number, candidates…). */
static PetscErrorCode Tell_Private(Interface p, Contact *c, const PetscInt start[], const PetscInt candidate[], PetscInt *num, PetscInt **got)
{
  const Surface      *s = &c->side[0];
  const ForestTables *t = p->tables;
  Mail                m = {0};
  PetscInt           *told, *first, *send, at = 0, total = 0;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(p->size, &told));
  for (PetscInt i = 0; i < s->num_mine; ++i) {
    if (start[i] < start[i + 1]) PetscCall(Concerned_Private(p, c, t, s->mine[i], i, told, &m));
  }
  PetscCall(MailSort_Private(&m, p->size));
  for (PetscInt i = 0; i < m.num; ++i) total += 2 + 2 * Runs_Private(start[m.sorted[i] + 1] - start[m.sorted[i]], candidate + start[m.sorted[i]], NULL);
  PetscCall(PetscMalloc2(m.num_to + 1, &first, total, &send));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < m.num_to; ++r) {
    for (PetscInt i = m.first[r]; i < m.first[r + 1]; ++i) {
      const PetscInt slot = m.sorted[i];
      send[at]            = s->mine[slot];
      send[at + 1]        = Runs_Private(start[slot + 1] - start[slot], candidate + start[slot], send + at + 2);
      at += 2 + 2 * send[at + 1];
    }
    first[r + 1] = at;
  }
  PetscCall(Send_Private(p, &m, first, sizeof(PetscInt), send, num, got));
  PetscCall(Unpack_Private(num, got));
  PetscCall(PetscFree2(first, send));
  PetscCall(PetscFree(told));
  PetscCall(MailDestroy_Private(&m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The candidates of all facets evaluated here, from this rank's search and from what others told. */
static PetscErrorCode Merge_Private(Contact *c, const ContactSurface *nonmortar, const PetscInt start[], const PetscInt candidate[], PetscInt num,
                                    const PetscInt got[])
{
  const Surface   *s = &c->side[0];
  const PetscInt **list;
  PetscInt        *count, *first, *all;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s->num_facets, &list, c->num_listed + 1, &first));
  PetscCall(PetscCalloc1(s->num_facets, &count));
  for (PetscInt i = 0; i < s->num_mine; ++i) {
    list[s->mine[i]]  = candidate + start[i];
    count[s->mine[i]] = start[i + 1] - start[i];
  }
  for (PetscInt at = 0; at < num; at += 2 + got[at + 1]) {
    list[got[at]]  = got + at + 2;
    count[got[at]] = got[at + 1];
  }
  for (PetscInt f = 0; f < s->num_facets; ++f) c->live[f] = (PetscBool)(count[f] > 0);
  first[0] = 0;
  for (PetscInt i = 0; i < c->num_listed; ++i) first[i + 1] = first[i] + count[c->listed[i]];
  PetscCall(PetscMalloc1(first[c->num_listed], &all));
  for (PetscInt i = 0; i < c->num_listed; ++i) PetscCall(PetscArraycpy(all + first[i], count[c->listed[i]] ? list[c->listed[i]] : all, count[c->listed[i]]));
  PetscCall(ContactPairSetCandidates(c->pair, nonmortar, c->num_listed, c->listed, first, all));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree(count));
  PetscCall(PetscFree2(list, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactSearch_Private(Interface p, Contact *c, PetscBool reference, PetscReal margin)
{
  ContactSurface  side[2];
  const PetscInt *start, *candidate;
  PetscInt       *got, num;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) side[k] = SurfaceAt_Private(&c->side[k], reference ? c->side[k].X : c->side[k].x);
  c->num_facets = 0; /* results go with the search that found them */
  if (p->size > 1 && !reference) PetscCall(Boxes_Private(p, c, &side[0], margin));
  PetscCall(ContactPairSearch(c->pair, &side[0], &side[1], c->side[0].num_mine, c->side[0].mine, c->distance, margin));
  ContactPairGetCandidates(c->pair, &start, &candidate);
  PetscCall(Tell_Private(p, c, start, candidate, &num, &got));
  PetscCall(Merge_Private(c, &side[0], start, candidate, num, got));
  PetscCall(PetscFree(got));
  PetscCall(ContactLink_Private(p, c));
  p->traffic.searches++;
  PetscFunctionReturn(PETSC_SUCCESS);
}
