/* Multiplier functions of a surface: which facets are made together, how far functions of held nodes are extrapolated, the result in one piece. */
#include "functionimpl.h"

PetscErrorCode ContactFacetGroups(const ContactSurface *s, PetscInt root[])
{
  const PetscInt corners = 2 * (s->dim - 1);
  PetscInt      *first; /* facet first seen at a corner */

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->num_nodes, &first));
  for (PetscInt n = 0; n < s->num_nodes; n++) first[n] = -1;
  for (PetscInt f = 0; f < s->num_facets; f++) root[f] = f;
  for (PetscInt i = 0; i < corners * s->num_facets; i++) {
    const PetscInt n = s->facets[i];

    if (!ContactNodeHangs(s, n)) continue;
    if (first[n] < 0) first[n] = i / corners;
    const PetscInt a = GroupRoot(root, i / corners), b = GroupRoot(root, first[n]);
    root[PetscMax(a, b)] = PetscMin(a, b);
  }
  for (PetscInt f = 0; f < s->num_facets; f++) root[f] = GroupRoot(root, f);
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Groups with facets of different order, or with a corner that hangs and belongs to one facet only, are left to P^T psi_L. */
static PetscErrorCode GroupsBuild_Private(MultiplierWork *w)
{
  const ContactSurface *s       = w->s;
  const PetscInt        corners = 2 * (s->dim - 1);
  PetscInt             *num; /* of facets at a corner */

  PetscFunctionBegin;
  PetscCall(ContactFacetGroups(s, w->root));
  PetscCall(PetscCalloc1(s->num_nodes, &num));
  for (PetscInt i = 0; i < corners * s->num_facets; i++) num[s->facets[i]]++;
  for (PetscInt i = 0; i < corners * s->num_facets; i++) {
    const PetscInt  f = i / corners, n = s->facets[i];
    const PetscBool differs = (PetscBool)(ContactLatticeSize(s, f) != ContactLatticeSize(s, w->root[f]));

    if (differs || (ContactNodeHangs(s, n) && num[n] == 1)) w->exact[w->root[f]] = PETSC_TRUE;
  }
  for (PetscInt f = 0; f < s->num_facets; f++) w->exact[f] = w->exact[w->root[f]];
  PetscCall(PetscFree(num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* weight += sign * int psi over the facet. */
static PetscErrorCode AddWeights_Private(MultiplierWork *w, PetscInt facet, PetscReal sign)
{
  const MultiplierRows *r = w->rows + facet;
  PetscReal             D[MULTIPLIER_LATTICE];
  FacetLattice          l;

  PetscFunctionBegin;
  ContactFacetLattice(w->s, facet, &l);
  PetscCall(ContactLatticeMass(w->s, &l, w->axisymmetric, NULL, D));
  for (PetscInt i = 0; i < r->num; i++)
    for (PetscInt a = 0; a < l.num; a++) w->weight[r->node[i]] += sign * r->T[l.num * i + a] * D[a];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* whole[num_nodes] = int chi_j. Axisymmetric: on the axis it vanishes from order 2 on (int chi_j R dR = 0 on a straight edge), and such a node carries nothing.
 */
static PetscErrorCode Whole_Private(const MultiplierWork *w, PetscReal whole[], PetscBool carries[])
{
  const PetscInt  *master;
  const PetscReal *weight;
  PetscReal        D[MULTIPLIER_LATTICE];
  FacetLattice     l;

  PetscFunctionBegin;
  for (PetscInt f = 0; f < w->s->num_facets; f++) {
    PetscReal area = 0;

    ContactFacetLattice(w->s, f, &l);
    PetscCall(ContactLatticeMass(w->s, &l, w->axisymmetric, NULL, D));
    for (PetscInt a = 0; a < l.num; a++) {
      const PetscInt masters = ContactNodeRow(w->s, l.node + a, &master, &weight);

      for (PetscInt i = 0; i < masters; i++) whole[master[i]] += weight[i] * D[a];
      area += D[a];
    }
    for (PetscInt end = 0; w->axisymmetric && end < 2; end++) /* an end's share of an edge is 1 / (p (p + 1)) */
      if (D[end * l.order] < CONTACT_SLIVER * area / (PetscReal)(l.num * l.order)) carries[l.node[end * l.order]] = PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Some function of the facets has too little weight left. */
static PetscBool IsLight_Private(const MultiplierWork *w, PetscInt num_facets, const PetscInt facet[], const PetscReal whole[])
{
  for (PetscInt f = 0; f < num_facets; f++)
    for (PetscInt i = 0; i < w->rows[facet[f]].num; i++) {
      const PetscInt n = w->rows[facet[f]].node[i];

      if (whole[n] > 0 && w->weight[n] < CONTACT_SLIVER * whole[n]) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* All groups: facets[start[g] .. start[g+1]). Where int psi_j beside held nodes comes out too small, again with a lower degree, round by
   round. */
static PetscErrorCode GroupsMake_Private(MultiplierWork *w, PetscInt num, const PetscInt start[], const PetscInt facets[], const PetscReal whole[])
{
  PetscInt(*degree)[2];
  PetscBool held, again;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &degree));
  for (w->round = 0; w->round < (w->late ? 2 : 1); w->round++) {
    PetscCall(PetscArrayzero(w->weight, w->s->num_nodes));
    for (PetscInt g = 0; g < num; g++) {
      PetscInt *own = &degree[g][w->round];
      *own          = MORTISE_MAX_ORDER;
      for (PetscInt i = start[g]; i < start[g + 1]; i++) *own = PetscMin(*own, (w->s->order ? w->s->order[facets[i]] : 1) - 1);
      PetscCall(ContactMultiplierGroup(w, start[g + 1] - start[g], facets + start[g], degree[g], &held));
      for (PetscInt i = start[g]; i < start[g + 1]; i++) PetscCall(AddWeights_Private(w, facets[i], 1));
      if (!held) *own = 0;
    }
    do {
      again = PETSC_FALSE;
      for (PetscInt g = 0; g < num; g++) {
        if (degree[g][w->round] == 0 || !IsLight_Private(w, start[g + 1] - start[g], facets + start[g], whole)) continue;
        for (PetscInt i = start[g]; i < start[g + 1]; i++) PetscCall(AddWeights_Private(w, facets[i], -1));
        --degree[g][w->round];
        PetscCall(ContactMultiplierGroup(w, start[g + 1] - start[g], facets + start[g], degree[g], &held));
        for (PetscInt i = start[g]; i < start[g + 1]; i++) PetscCall(AddWeights_Private(w, facets[i], 1));
        again = PETSC_TRUE;
      }
    } while (again);
  }
  PetscCall(PetscFree(degree));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Facets sorted by their roots. */
static PetscErrorCode Groups_Private(MultiplierWork *w, const PetscReal whole[])
{
  const PetscInt num_facets = w->s->num_facets;
  PetscInt      *root, *facets, *start, num = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(num_facets, &root, num_facets, &facets, num_facets + 1, &start));
  for (PetscInt f = 0; f < num_facets; f++) {
    root[f]   = w->root[f];
    facets[f] = f;
  }
  PetscCall(PetscSortIntWithArray(num_facets, root, facets));
  for (PetscInt f = 0; f < num_facets; f++)
    if (f == 0 || root[f] != root[f - 1]) start[num++] = f;
  start[num] = num_facets;
  PetscCall(GroupsMake_Private(w, num, start, facets, whole));
  PetscCall(PetscFree3(root, facets, start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows that vanish on their facet go (a node of a group that the facet does not have). */
static void Drop_Private(PetscInt num, MultiplierRows *r)
{
  PetscInt rows = 0;

  for (PetscInt i = 0; i < r->num; i++) {
    PetscBool zero = PETSC_TRUE;

    for (PetscInt a = 0; a < num; a++) {
      r->T[num * rows + a] = r->T[num * i + a];
      r->B[num * rows + a] = r->B[num * i + a];
      if (r->T[num * i + a] != 0 || r->B[num * i + a] != 0) zero = PETSC_FALSE;
    }
    r->node[rows] = r->node[i];
    rows += !zero;
  }
  r->num = rows;
}

/* int B_j of a facet's rows; axisymmetric: of revolution. */
static PetscErrorCode Measures_Private(const MultiplierWork *w, PetscInt facet, PetscReal measure[])
{
  const MultiplierRows *r = w->rows + facet;
  PetscReal             D[MULTIPLIER_LATTICE];
  FacetLattice          l;

  PetscFunctionBegin;
  ContactFacetLattice(w->s, facet, &l);
  PetscCall(ContactLatticeMass(w->s, &l, w->axisymmetric, NULL, D));
  for (PetscInt i = 0; i < r->num; i++) {
    measure[i] = 0;
    for (PetscInt a = 0; a < l.num; a++) measure[i] += (w->axisymmetric ? 2 * PETSC_PI : 1) * r->B[l.num * i + a] * D[a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Pack_Private(const MultiplierWork *w, ContactMultiplier **out)
{
  PetscInt           rows = 0, size = 0;
  ContactMultiplier *m;

  PetscFunctionBegin;
  PetscCall(PetscNew(&m));
  m->num_facets = w->s->num_facets;
  PetscCall(PetscMalloc2(m->num_facets + 1, &m->row_first, m->num_facets, &m->offset));
  for (PetscInt f = 0; f < m->num_facets; f++) {
    Drop_Private(ContactLatticeSize(w->s, f), w->rows + f);
    m->row_first[f] = rows;
    m->offset[f]    = size;
    rows += w->rows[f].num;
    size += w->rows[f].num * ContactLatticeSize(w->s, f);
  }
  m->row_first[m->num_facets] = rows;
  PetscCall(PetscMalloc4(rows, &m->row_node, rows, &m->measure, size, &m->T, size, &m->B));
  for (PetscInt f = 0; f < m->num_facets; f++) {
    const MultiplierRows *r = w->rows + f;

    PetscCall(Measures_Private(w, f, m->measure + m->row_first[f]));
    PetscCall(PetscArraycpy(m->row_node + m->row_first[f], r->node, r->num));
    PetscCall(PetscArraycpy(m->T + m->offset[f], r->T, r->num * ContactLatticeSize(w->s, f)));
    PetscCall(PetscArraycpy(m->B + m->offset[f], r->B, r->num * ContactLatticeSize(w->s, f)));
  }
  PetscCall(ContactDonorsPack(w, m));
  *out = m;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactMultiplierCreate(const ContactSurface *s, PetscBool axisymmetric, PetscBool standard, const PetscBool carries[], const PetscBool late[],
                                       ContactMultiplier **out)
{
  MultiplierWork w = {.s = s, .axisymmetric = axisymmetric, .standard = standard, .late = late};
  PetscBool     *own;
  PetscReal     *whole;

  PetscFunctionBegin;
  PetscCheck(s->X, PETSC_COMM_SELF, PETSC_ERR_PLIB, "multiplier functions need the surface's reference positions");
  PetscCheck(s->dim == 3 || !s->hang || s->hang[s->num_nodes] == 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a node of a curve hangs");
  PetscCheck(s->dim == 2 || !axisymmetric, PETSC_COMM_SELF, PETSC_ERR_PLIB, "axisymmetric surface in three dimensions");
  PetscCall(PetscMalloc3(s->num_facets, &w.root, s->num_nodes, &w.place, s->num_nodes, &own));
  PetscCall(PetscCalloc5(s->num_facets, &w.exact, s->num_nodes, &w.weight, s->num_facets, &w.rows, s->num_facets, &w.donors, s->num_nodes, &whole));
  for (PetscInt n = 0; n < s->num_nodes; n++) {
    w.place[n] = -1;
    own[n]     = (PetscBool)(!carries || carries[n]);
  }
  w.carries = own;
  PetscCall(Whole_Private(&w, whole, own));
  PetscCall(GroupsBuild_Private(&w));
  PetscCall(Groups_Private(&w, whole));
  PetscCall(Pack_Private(&w, out));
  for (PetscInt f = 0; f < s->num_facets; f++) {
    PetscCall(PetscFree3(w.rows[f].node, w.rows[f].T, w.rows[f].B));
    PetscCall(PetscFree3(w.donors[f].to, w.donors[f].from, w.donors[f].weight));
  }
  PetscCall(PetscFree3(w.root, w.place, own));
  PetscCall(PetscFree5(w.exact, w.weight, w.rows, w.donors, whole));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactMultiplierDestroy(ContactMultiplier **m)
{
  PetscFunctionBegin;
  if (!*m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*m)->row_first, (*m)->offset));
  PetscCall(PetscFree4((*m)->row_node, (*m)->measure, (*m)->T, (*m)->B));
  PetscCall(PetscFree((*m)->donor_first));
  PetscCall(PetscFree2((*m)->donor, (*m)->donor_weight));
  PetscCall(PetscFree(*m));
  PetscFunctionReturn(PETSC_SUCCESS);
}
