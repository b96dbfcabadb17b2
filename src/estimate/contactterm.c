/* Contact in the estimate. The pressure is z = sum z_j N_j (continuous, as reported), not the dual trace sum z_j psi_j that balances the discrete forces: it is
   the better approximation of the contact pressure. Traction per reference area: -z n on the nonmortar facet (n: interpolated nodal normal), +z n at the
   projected point of the mortar facet, times current over reference measure (contactpoint.c); points outside all segments carry no traction. Nodal gaps are the
   weighted ones, gt_j / w_j; at a hanging node the mean of its masters' ones. */
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

/* A segment with what its nonmortar facet exerts there. */
typedef struct {
  ContactSegment segment;
  PetscReal      z[4], normal[4][3];
} Sight;

static void Sight_Private(const ContactView *view, const PetscReal normal[], const ContactSegment *segment, Sight *sight)
{
  const SurfaceView *s = &view->nonmortar;

  memset(sight, 0, sizeof(*sight));
  sight->segment = *segment;
  for (PetscInt k = 0; k < s->corners; ++k) {
    const PetscInt node = s->facets[s->corners * segment->facet + k];
    sight->z[k]         = view->z[node];
    for (PetscInt c = 0; c < s->dim; ++c) sight->normal[k][c] = normal[s->dim * node + c];
  }
}

/* Segments on the mortar facets of this rank, found by the ranks of the nonmortar facets: each goes to the rank of its mortar facet. mail: [size + 1] where
   those for each rank start. */
static PetscErrorCode Post_Private(const ForestTables *t, const ContactView *view, PetscMPIInt rank, PetscMPIInt size, PetscInt mail[], Sight **sorted)
{
  const ContactSegment *segments;
  const PetscReal      *normal;
  PetscInt              num, *place;

  PetscFunctionBegin;
  PetscCall(ContactPairGetSegments(view->pair, &num, &segments));
  PetscCall(ContactPairGetNormals(view->pair, &normal));
  PetscCall(PetscArrayzero(mail, size + 1));
  PetscCall(PetscMalloc1(size, &place));
  PetscCall(PetscMalloc1(num, sorted));
  for (PetscInt pass = 0; pass < 2; ++pass) {
    for (PetscInt i = 0; i < num; ++i) {
      if (t->leaf_rank[view->nonmortar.facet_leaf[segments[i].facet]] != rank) continue;
      const PetscInt to = t->leaf_rank[view->mortar.facet_leaf[segments[i].mortar_facet]];
      if (pass == 0)
        mail[to + 1]++;
      else
        Sight_Private(view, normal, &segments[i], &(*sorted)[place[to]++]);
    }
    for (PetscMPIInt r = 0; r < size && pass == 0; ++r) {
      mail[r + 1] += mail[r];
      place[r] = mail[r];
    }
  }
  PetscCall(PetscFree(place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What goes to others leaves, what comes from others and what stays is put together. */
static PetscErrorCode Deliver_Private(MPI_Comm comm, PetscMPIInt rank, PetscMPIInt size, const PetscInt mail[], const Sight sorted[], PetscInt *total,
                                      Sight **all)
{
  PetscMPIInt *to, num_to = 0;
  PetscInt    *first, num;
  Sight       *send, *got;

  PetscFunctionBegin;
  PetscCall(PetscMalloc3(size, &to, size + 1, &first, mail[size], &send));
  first[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) {
    const PetscInt count = mail[r + 1] - mail[r];
    if (r == rank || count == 0) continue;
    PetscCall(PetscArraycpy(send + first[num_to], sorted + mail[r], count));
    first[num_to + 1] = first[num_to] + count;
    to[num_to++]      = r;
  }
  PetscCall(SparseExchange(comm, num_to, to, first, sizeof(Sight), send, &num, &got));
  const PetscInt own = mail[rank + 1] - mail[rank];
  PetscCall(PetscMalloc1(own + num, all));
  PetscCall(PetscArraycpy(*all, sorted + mail[rank], own));
  PetscCall(PetscArraycpy(*all + own, got, num));
  *total = own + num;
  PetscCall(PetscFree(got));
  PetscCall(PetscFree3(to, first, send));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multipliers and normals of the nodes of this rank's nonmortar facets, then of those that come with segments; the rest is NaN. */
static PetscErrorCode Fields_Private(const ForestTables *t, PetscMPIInt rank, PetscInt num, const Sight sights[], ContactTerm *term)
{
  const SurfaceView *s = &term->view->nonmortar;
  const PetscReal   *normal;

  PetscFunctionBegin;
  PetscCall(ContactPairGetNormals(term->view->pair, &normal));
  PetscCall(PetscMalloc2(s->num_nodes, &term->z, s->dim * s->num_nodes, &term->normal));
  for (PetscInt n = 0; n < s->num_nodes; ++n) term->z[n] = NAN;
  for (PetscInt i = 0; i < s->dim * s->num_nodes; ++i) term->normal[i] = NAN;
  for (PetscInt i = 0; i < s->corners * s->num_facets; ++i) {
    const PetscInt n = s->facets[i];
    if (t->leaf_rank[s->facet_leaf[i / s->corners]] != rank) continue;
    term->z[n] = term->view->z[n];
    PetscCall(PetscArraycpy(term->normal + s->dim * n, normal + s->dim * n, s->dim));
  }
  for (PetscInt i = 0; i < num; ++i) {
    for (PetscInt k = 0; k < s->corners; ++k) {
      const PetscInt n = s->facets[s->corners * sights[i].segment.facet + k];
      term->z[n]       = sights[i].z[k];
      PetscCall(PetscArraycpy(term->normal + s->dim * n, sights[i].normal[k], s->dim));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode GatherSegments_Private(MPI_Comm comm, const ForestTables *t, ContactTerm *term, PetscInt *total, ContactSegment **all)
{
  Sight      *sorted, *sights;
  PetscInt   *mail;
  PetscMPIInt rank, size;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(size + 1, &mail));
  PetscCall(Post_Private(t, term->view, rank, size, mail, &sorted));
  PetscCall(Deliver_Private(comm, rank, size, mail, sorted, total, &sights));
  PetscCall(Fields_Private(t, rank, *total, sights, term));
  PetscCall(PetscMalloc1(*total, all));
  for (PetscInt i = 0; i < *total; ++i) (*all)[i] = sights[i].segment;
  PetscCall(PetscFree(mail));
  PetscCall(PetscFree(sorted));
  PetscCall(PetscFree(sights));
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

PetscErrorCode ContactTermsCreate_Private(Problem problem, ContactTerms *terms)
{
  const SceneData    *scene;
  const ForestTables *t;
  Forest              forest;

  PetscFunctionBegin;
  PetscCall(ProblemGetScene(problem, &scene));
  PetscCall(ProblemGetForest(problem, &forest));
  PetscCall(ForestGetTables(forest, &t));
  terms->kinematics = scene->mechanics.kinematics;
  terms->model      = scene->mechanics.model;
  terms->num        = scene->num_contacts;
  PetscCall(PetscCalloc1(terms->num, &terms->terms));
  for (PetscInt i = 0; i < terms->num; ++i) {
    ContactTerm    *term = &terms->terms[i];
    ContactSegment *all;
    PetscInt        num;
    PetscCall(ProblemGetContact(problem, i, &term->view));
    PetscCall(FacetPlaces_Private(t, &term->view->nonmortar, &term->facet_place[0]));
    PetscCall(FacetPlaces_Private(t, &term->view->mortar, &term->facet_place[1]));
    PetscCall(GatherSegments_Private(ForestComm(forest), t, term, &num, &all));
    PetscCall(KeepSegments_Private(num, all, term));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactTermsDestroy_Private(ContactTerms *terms)
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < terms->num; ++i) {
    PetscCall(PetscFree(terms->terms[i].facet_place[0]));
    PetscCall(PetscFree(terms->terms[i].facet_place[1]));
    PetscCall(PetscFree(terms->terms[i].segment_first));
    PetscCall(PetscFree(terms->terms[i].segments));
    PetscCall(PetscFree(terms->terms[i].box));
    PetscCall(PetscFree2(terms->terms[i].z, terms->terms[i].normal));
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

/* Gap at a node from the weighted gap; PETSC_FALSE where the node, or one that it hangs on, sees (almost) nothing. */
static PetscBool NodalGap_Private(const ContactView *view, PetscInt node, PetscReal measure, PetscReal *gap)
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

/* Measure at a place of a nonmortar facet per unit of xi: length or area, axisymmetric: of the revolution. */
static PetscReal Measure_Private(const ContactTerms *terms, const SurfaceView *s, PetscInt facet, const PetscReal xi[2], const PetscReal N[4])
{
  const PetscReal *x = terms->kinematics == KINEMATICS_FINITE ? s->x : s->X;
  PetscReal        tangent[2][3], position[3];

  ContactTangents_Private(s, facet, x, xi, tangent);
  if (terms->model != MODEL_AXISYMMETRIC) return ContactMeasure_Private(tangent);
  ContactPosition_Private(s, facet, x, N, position);
  return 2 * PETSC_PI * position[0] * ContactMeasure_Private(tangent);
}

/* int z+ g+ and int g-^2 over a nonmortar facet (current measure), z and g by its hats, 3 Gauss points in each direction. */
static PetscErrorCode FacetIntegrals_Private(const ContactTerms *terms, const ContactTerm *term, PetscInt facet, PetscReal *product, PetscReal *penetration)
{
  const SurfaceView *s         = &term->view->nonmortar;
  const PetscInt    *node      = s->facets + s->corners * facet;
  const PetscReal    middle[2] = {0, 0};
  const Basis1D     *gauss;
  PetscReal          N[4], g[4];

  PetscFunctionBegin;
  *product = *penetration = 0;
  ContactHats_Private(s->dim, middle, N);
  const PetscReal measure = (s->dim == 3 ? 4 : 2) * Measure_Private(terms, s, facet, middle, N);
  for (PetscInt a = 0; a < s->corners; ++a) {
    if (!NodalGap_Private(term->view, node[a], measure, &g[a])) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Basis1DGet(1, 3, &gauss));
  for (PetscInt q = 0; q < (s->dim == 3 ? 9 : 3); ++q) {
    const PetscReal xi[2] = {2 * gauss->points[q % 3] - 1, 2 * gauss->points[q / 3] - 1};
    PetscReal       z = 0, gap = 0, weight = 2 * gauss->weights[q % 3] * (s->dim == 3 ? 2 * gauss->weights[q / 3] : 1);
    ContactHats_Private(s->dim, xi, N);
    weight *= Measure_Private(terms, s, facet, xi, N);
    for (PetscInt a = 0; a < s->corners; ++a) {
      z += N[a] * term->view->z[node[a]];
      gap += N[a] * g[a];
    }
    *product += weight * PetscMax(z, 0) * PetscMax(gap, 0);
    *penetration += weight * PetscSqr(PetscMin(gap, 0));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateComplementarity_Private(EstimateSum *sum, const PetscReal height[][3])
{
  PetscFunctionBegin;
  for (PetscInt i = 0; i < sum->facets.num; ++i) {
    const FacetPlace *f    = &sum->facets.facets[i];
    const FacetSide  *side = f->side[0].cell >= 0 ? &f->side[0] : &f->side[1];
    if (side->cell >= sum->v->num_owned_cells) continue;
    const PetscInt  leaf   = sum->v->cell_leaf[side->cell];
    const PetscReal factor = sum->spec->bodies[sum->t->leaf_body[leaf]].material->mu * f->order / height[side->cell][side->side / 2];
    for (PetscInt k = 0; k < sum->contact->num; ++k) {
      const ContactTerm *term = &sum->contact->terms[k];
      PetscReal          product, penetration;
      if (term->facet_place[0][f->facet] < 0) continue;
      PetscCall(FacetIntegrals_Private(sum->contact, term, term->facet_place[0][f->facet], &product, &penetration));
      sum->eta2[leaf] += product + factor * penetration;
      sum->part[PART_CONTACT] += product + factor * penetration;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
