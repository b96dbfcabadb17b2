/* Contact in the estimate. The pressure is z = sum z_j N_j (continuous, as reported), not the dual trace sum z_j psi_j that balances the discrete forces: it is
   the better approximation of the contact pressure. On facets covered in part it is as much Bernstein polynomials as the multipliers' functions are. Traction
   per reference area: -z n on the nonmortar facet (n: interpolated nodal normal), +z n at the projected point of the mortar facet, times current over reference
   measure (contactpoint.c); points outside all segments carry no traction. Nodal gaps are the weighted ones, gt_j / w_j; at a hanging node the mean of its
   masters' ones. */
#include "estimateimpl.h"

#define UNCOVERED 1e-8 /* w_j below this times the facet's measure: the node sees nothing, its gap is unknown */

static PetscErrorCode FacetPlaces_Private(const ForestTables *t, const SurfaceView *s, PetscInt **facet_place)
{
  const PetscInt first = t->first[t->dim - 1], num = t->first[t->dim] - first;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, facet_place));
  for (PetscInt f = 0; f < num; ++f) (*facet_place)[f] = -1;
  for (PetscInt e = 0; e < s->num_facets; ++e) (*facet_place)[s->facet_entity[e] - first] = e;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's segments by the rank of their mortar facet, each nonmortar facet's from the rank that owns its leaf: sorted[first[rank] .. first[rank+1]). */
static PetscErrorCode SortByRank_Private(const ForestTables *t, const ContactView *view, PetscMPIInt rank, PetscMPIInt size, PetscInt first[],
                                         ContactSegment **sorted)
{
  const ContactSegment *segments;
  PetscInt              num, *place;

  PetscFunctionBegin;
  ContactPairGetSegments(view->pair, &num, &segments);
  PetscCall(PetscArrayzero(first, size + 1));
  PetscCall(PetscMalloc1(size, &place));
  PetscCall(PetscMalloc1(num, sorted));
  for (PetscInt pass = 0; pass < 2; ++pass) {
    for (PetscInt i = 0; i < num; ++i) {
      if (t->leaf_rank[view->nonmortar.facet_leaf[segments[i].facet]] != rank) continue;
      const PetscInt to = t->leaf_rank[view->mortar.facet_leaf[segments[i].mortar_facet]];
      if (pass == 0)
        first[to + 1]++;
      else
        (*sorted)[place[to]++] = segments[i];
    }
    for (PetscMPIInt r = 0; r < size && pass == 0; ++r) {
      first[r + 1] += first[r];
      place[r] = first[r];
    }
  }
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Segments on the mortar facets of this rank, whoever found them. */
static PetscErrorCode GatherSegments_Private(MPI_Comm comm, const ForestTables *t, const ContactView *view, PetscInt *total, ContactSegment **all)
{
  PetscMPIInt     rank, size, *to, num_to = 0;
  PetscInt       *first, *sent, num;
  ContactSegment *sorted, *got, *send;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc3(size + 1, &first, size + 1, &sent, size, &to));
  PetscCall(SortByRank_Private(t, view, rank, size, first, &sorted));
  const PetscInt own = first[rank + 1] - first[rank];
  PetscCall(PetscMalloc1(first[size] - own, &send));
  sent[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) {
    const PetscInt count = first[r + 1] - first[r];
    if (r == rank || count == 0) continue;
    PetscCall(PetscArraycpy(send + sent[num_to], sorted + first[r], count));
    sent[num_to + 1] = sent[num_to] + count;
    to[num_to++]     = r;
  }
  PetscCall(SparseExchange(comm, num_to, to, sent, sizeof(ContactSegment), send, &num, &got));
  *total = own + num;
  PetscCall(PetscMalloc1(*total, all));
  PetscCall(PetscArraycpy(*all, sorted + first[rank], own));
  PetscCall(PetscArraycpy(*all + own, got, num));
  PetscCall(PetscFree3(first, sent, to));
  PetscCall(PetscFree(sorted));
  PetscCall(PetscFree(send));
  PetscCall(PetscFree(got));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multipliers and normals on this rank's nonmortar facets, and on those that its mortar facets face. */
static PetscErrorCode Fields_Private(Problem problem, PetscInt pair, const ForestTables *t, PetscInt num, const ContactSegment segments[], ContactTerm *term)
{
  const SurfaceView *s = &term->view->nonmortar;
  PetscBool         *wanted, *facet;
  PetscMPIInt        rank;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(ForestComm(ProblemForest(problem)), &rank));
  PetscCall(PetscCalloc2(s->num_nodes, &wanted, s->num_facets, &facet));
  for (PetscInt f = 0; f < s->num_facets; ++f) facet[f] = (PetscBool)(t->leaf_rank[s->facet_leaf[f]] == rank);
  for (PetscInt i = 0; i < num; ++i) facet[segments[i].facet] = PETSC_TRUE;
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    const PetscInt *node, count = SurfaceFacetNodes(s, f, &node);
    for (PetscInt k = 0; k < count && facet[f]; ++k) wanted[node[k]] = PETSC_TRUE;
  }
  PetscCall(PetscMalloc3(term->view->num_z * s->num_nodes, &term->z, s->dim * s->num_nodes, &term->normal, s->dim * s->num_nodes, &term->x));
  if (term->view->slip && s->dim == 3) PetscCall(PetscMalloc1(3 * s->num_nodes, &term->traction));
  PetscCall(InterfaceFetchContact(ProblemInterface(problem), pair, wanted, term->z, term->normal, term->x, term->traction));
  PetscCall(PetscFree2(wanted, facet));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The share of the dual functions in those of the same facets. */
static PetscErrorCode Shares_Private(PetscInt num, const ContactSegment segments[], ContactTerm *term)
{
  const PetscInt        num_facets = term->view->nonmortar.num_facets;
  const ContactSegment *own;
  PetscInt              num_own;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num_facets, &term->theta));
  for (PetscInt f = 0; f < num_facets; ++f) term->theta[f] = 1;
  for (PetscInt i = 0; i < num; ++i) term->theta[segments[i].facet] = segments[i].dual;
  ContactPairGetSegments(term->view->pair, &num_own, &own);
  for (PetscInt i = 0; i < num_own; ++i) term->theta[own[i].facet] = own[i].dual;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counting sort by nonmortar (key 0) or mortar facet (key 1); entries of one facet keep their order. first[num_facets + 1]. */
static PetscErrorCode SortSegments_Private(PetscInt key, PetscInt num_facets, PetscInt num, const ContactSegment from[], ContactSegment to[], PetscInt first[])
{
  PetscInt *next;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num_facets + 1, &next));
  PetscCall(PetscArrayzero(first, num_facets + 1));
  for (PetscInt i = 0; i < num; ++i) first[(key ? from[i].mortar_facet : from[i].facet) + 1]++;
  for (PetscInt e = 0; e < num_facets; ++e) first[e + 1] += first[e];
  PetscCall(PetscArraycpy(next, first, num_facets + 1));
  for (PetscInt i = 0; i < num; ++i) to[next[key ? from[i].mortar_facet : from[i].facet]++] = from[i];
  PetscCall(PetscFree(next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Segments by mortar facet, in an order that does not depend on who found them. Takes `all`. */
static PetscErrorCode KeepSegments_Private(PetscInt num, ContactSegment *all, ContactTerm *term)
{
  const PetscInt  num_facets[2] = {term->view->nonmortar.num_facets, term->view->mortar.num_facets};
  ContactSegment *sorted;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, &sorted));
  PetscCall(PetscMalloc1(PetscMax(num_facets[0], num_facets[1]) + 1, &term->segment_first));
  PetscCall(SortSegments_Private(0, num_facets[0], num, all, sorted, term->segment_first));
  PetscCall(SortSegments_Private(1, num_facets[1], num, sorted, all, term->segment_first));
  PetscCall(PetscFree(sorted));
  term->segments = all;
  if (term->view->mortar.dim == 2) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(num, &term->box));
  for (PetscInt i = 0; i < num; ++i) ContactSegmentBox_Private(&all[i], term->box[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a pair bear nothing where it could? */
static PetscErrorCode IsBare_Private(MPI_Comm comm, const ContactView *v, PetscBool *bare)
{
  PetscFunctionBegin;
  *bare = (PetscBool)(v->spec->law != CONTACT_TIED && !v->spec->adjust);
  for (PetscInt j = 0; j < v->nonmortar.num_nodes; ++j) *bare = (PetscBool)(*bare && (!v->nonmortar.owned[j] || v->z[j] == 0));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, bare, 1, MPIU_BOOL, MPI_LAND, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactTermsCreate_Private(Problem problem, ContactTerms *terms)
{
  const SceneData    *scene  = ProblemGetScene(problem);
  Forest              forest = ProblemForest(problem);
  const ForestTables *t      = ForestGetTables(forest);

  PetscFunctionBegin;
  terms->interface  = ProblemInterface(problem);
  terms->kinematics = scene->mechanics.kinematics;
  terms->model      = scene->mechanics.model;
  terms->num        = scene->num_contacts;
  PetscCall(PetscCalloc1(terms->num, &terms->terms));
  for (PetscInt i = 0; i < terms->num; ++i) {
    ContactTerm    *term = &terms->terms[i];
    ContactSegment *all;
    PetscInt        num;
    term->view = InterfaceGetContact(ProblemInterface(problem), i);
    PetscCall(IsBare_Private(ForestComm(forest), term->view, &term->bare));
    PetscCall(FacetPlaces_Private(t, &term->view->nonmortar, &term->facet_place[0]));
    PetscCall(FacetPlaces_Private(t, &term->view->mortar, &term->facet_place[1]));
    PetscCall(GatherSegments_Private(ForestComm(forest), t, term->view, &num, &all));
    PetscCall(Fields_Private(problem, i, t, num, all, term));
    PetscCall(Shares_Private(num, all, term));
    PetscCall(KeepSegments_Private(num, all, term));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactTermsDestroy_Private(ContactTerms *terms)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < terms->num; ++i) {
    PetscCall(PetscFree(terms->terms[i].theta));
    PetscCall(PetscFree(terms->terms[i].facet_place[0]));
    PetscCall(PetscFree(terms->terms[i].facet_place[1]));
    PetscCall(PetscFree(terms->terms[i].segment_first));
    PetscCall(PetscFree(terms->terms[i].segments));
    PetscCall(PetscFree(terms->terms[i].box));
    PetscCall(PetscFree3(terms->terms[i].z, terms->terms[i].normal, terms->terms[i].x));
    PetscCall(PetscFree(terms->terms[i].traction));
  }
  PetscCall(PetscFree(terms->terms));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ContactTermsHave_Private(const ContactTerms *terms, PetscInt facet)
{
  for (PetscInt i = 0; terms && i < terms->num; ++i) {
    if (terms->terms[i].facet_place[0][facet] >= 0 || terms->terms[i].facet_place[1][facet] >= 0) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool ContactNodalGap_Private(const ContactView *view, PetscInt node, PetscReal measure, PetscReal *gap)
{
  const SurfaceView *s   = &view->nonmortar;
  const PetscBool    own = (PetscBool)(s->hang[node] == s->hang[node + 1]);

  *gap = 0;
  if (own && !(view->weight[node] > UNCOVERED * measure)) return PETSC_FALSE;
  if (own) *gap = view->gap[node] / view->weight[node];
  for (PetscInt k = s->hang[node]; k < s->hang[node + 1]; ++k) {
    const PetscInt master = s->hang_master[k];
    if (!(view->weight[master] > UNCOVERED * measure)) return PETSC_FALSE;
    *gap += s->hang_weight[k] * view->gap[master] / view->weight[master];
  }
  return PETSC_TRUE;
}

PetscReal ContactTermsMeasure_Private(const ContactTerms *terms, const SurfaceView *s, PetscInt facet, const PetscReal xi[2], const PetscReal N[])
{
  const PetscReal *x = terms->kinematics == KINEMATICS_FINITE ? s->x : s->X;
  PetscReal        tangent[2][3], position[3];

  SurfaceTangents(s, facet, x, xi, tangent);
  if (terms->model != MODEL_AXISYMMETRIC) return ContactMeasure_Private(tangent);
  ContactPosition_Private(s, facet, x, N, position);
  return 2 * PETSC_PI * position[0] * ContactMeasure_Private(tangent);
}

/* int z+ g+ over a nonmortar facet (current measure), z and g by the functions of its nodes, order + 2 Gauss points in each direction. */
static PetscErrorCode FacetProduct_Private(const ContactTerms *terms, const ContactTerm *term, PetscInt facet, PetscReal *product)
{
  const SurfaceView *s = &term->view->nonmortar;
  const PetscInt    *node, num = SurfaceFacetNodes(s, facet, &node), points = s->order[facet] + 2;
  const PetscReal    middle[2] = {0, 0};
  const Basis1D     *gauss;
  PetscReal          N[SURFACE_MOST_NODES], V[SURFACE_MOST_NODES], g[SURFACE_MOST_NODES];

  PetscFunctionBegin;
  *product = 0;
  ContactShape_Private(s, facet, middle, N);
  const PetscReal measure = (s->dim == 3 ? 4 : 2) * ContactTermsMeasure_Private(terms, s, facet, middle, N);
  for (PetscInt a = 0; a < num; ++a) {
    if (!ContactNodalGap_Private(term->view, node[a], measure, &g[a])) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Basis1DGet(1, points, &gauss));
  for (PetscInt q = 0; q < (s->dim == 3 ? points : 1) * points; ++q) {
    const PetscInt  i = q % points, j = q / points;
    const PetscReal xi[2] = {2 * gauss->points[i] - 1, 2 * gauss->points[j] - 1};
    PetscReal       z = 0, gap = 0, weight = 2 * gauss->weights[i] * (s->dim == 3 ? 2 * gauss->weights[j] : 1);
    ContactShape_Private(s, facet, xi, N);
    ContactPressureShape_Private(term, facet, xi, N, V);
    weight *= ContactTermsMeasure_Private(terms, s, facet, xi, N);
    for (PetscInt a = 0; a < num; ++a) {
      z += V[a] * term->z[node[a]];
      gap += N[a] * g[a];
    }
    *product += weight * PetscMax(z, 0) * PetscMax(gap, 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateComplementarity_Private(EstimateSum *sum)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < sum->facets.num; ++i) {
    const FacetPlace *f    = &sum->facets.facets[i];
    const FacetSide  *side = f->side[0].cell >= 0 ? &f->side[0] : &f->side[1];
    if (side->cell >= sum->v->num_owned_cells) continue;
    for (PetscInt k = 0; k < sum->contact->num; ++k) {
      const ContactTerm *term = &sum->contact->terms[k];
      PetscReal          product;
      if (term->facet_place[0][f->facet] < 0 || term->view->spec->law == CONTACT_TIED) continue;
      PetscCall(FacetProduct_Private(sum->contact, term, term->facet_place[0][f->facet], &product));
      sum->eta2[sum->v->cell_leaf[side->cell]] += product;
      sum->part[PART_CONTACT] += product;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
