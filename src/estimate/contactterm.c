/* Contact in the estimate (two dimensions). The pressure is z = sum z_j N_j (continuous, as reported), not the dual trace sum z_j psi_j that balances the
   discrete forces: it is the better approximation of the contact pressure. Traction per reference area: -z n on the nonmortar edge (n: interpolated nodal
   normal), +z n at the projected point of the mortar edge, times current over reference measure. On a mortar edge the projection is taken linear within
   each segment; points outside all segments carry no traction. Nodal gaps are the weighted ones, gt_j / w_j. */
#include "estimateimpl.h"

#define UNCOVERED 1e-8 /* w_j below this times the tributary length: the node sees nothing, its gap is unknown */

static PetscErrorCode FacetEdges_Private(const ForestTables *t, const SurfaceView *s, PetscInt **facet_place)
{
  const PetscInt sides[4] = {1, 3, 5, 7}, num = t->first[2] - t->first[1];

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(num, facet_place));
  for (PetscInt f = 0; f < num; ++f) (*facet_place)[f] = -1;
  for (PetscInt e = 0; e < s->num_facets; ++e) {
    const PetscInt *cl      = t->closure + t->closure_offset[t->first[2] + s->facet_leaf[e]];
    const PetscInt  want[2] = {s->node_entity[s->facets[2 * e]], s->node_entity[s->facets[2 * e + 1]]};
    PetscInt        found   = -1;
    for (PetscInt i = 0; i < 4; ++i) {
      const PetscInt stride = sides[i] == 1 || sides[i] == 7 ? 1 : 3, a = cl[sides[i] - stride], b = cl[sides[i] + stride];
      if ((a == want[0] && b == want[1]) || (a == want[1] && b == want[0])) found = cl[sides[i]];
    }
    PetscCheck(found >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "contact edge %" PetscInt_FMT " is no side of its leaf %" PetscInt_FMT, e, s->facet_leaf[e]);
    (*facet_place)[found - t->first[1]] = e;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Segments of all ranks, each edge's from the rank that owns its leaf. */
static PetscErrorCode GatherSegments_Private(MPI_Comm comm, const ForestTables *t, const ContactView *view, PetscInt *total, ContactSegment **all)
{
  const ContactSegment *segments;
  ContactSegment       *mine;
  PetscInt              num, kept = 0;
  PetscMPIInt           rank, size, bytes, *counts, *offsets;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(ContactPairGetSegments(view->pair, &num, &segments));
  PetscCall(PetscMalloc1(num, &mine));
  for (PetscInt i = 0; i < num; ++i) {
    if (t->leaf_rank[view->nonmortar.facet_leaf[segments[i].facet]] == rank) mine[kept++] = segments[i];
  }
  PetscCall(PetscMalloc2(size, &counts, size + 1, &offsets));
  bytes = (PetscMPIInt)(kept * (PetscInt)sizeof(*mine));
  PetscCallMPI(MPI_Allgather(&bytes, 1, MPI_INT, counts, 1, MPI_INT, comm));
  offsets[0] = 0;
  for (PetscMPIInt r = 0; r < size; ++r) offsets[r + 1] = offsets[r] + counts[r];
  *total = offsets[size] / (PetscInt)sizeof(*mine);
  PetscCall(PetscMalloc1(*total, all));
  PetscCallMPI(MPI_Allgatherv(mine, bytes, MPI_BYTE, *all, counts, offsets, MPI_BYTE, comm));
  PetscCall(PetscFree2(counts, offsets));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sort segments by mortar edge (counting sort: order within an edge as gathered). */
static PetscErrorCode SortSegments_Private(PetscInt num_facets, PetscInt num, const ContactSegment all[], ContactTerm *term)
{
  PetscInt *first, *next;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(num_facets + 1, &first));
  PetscCall(PetscMalloc1(num_facets + 1, &next));
  PetscCall(PetscMalloc1(num, &term->segments));
  for (PetscInt i = 0; i < num; ++i) first[all[i].mortar_facet + 1]++;
  for (PetscInt e = 0; e < num_facets; ++e) first[e + 1] += first[e];
  PetscCall(PetscArraycpy(next, first, num_facets + 1));
  for (PetscInt i = 0; i < num; ++i) term->segments[next[all[i].mortar_facet]++] = all[i];
  PetscCall(PetscFree(next));
  term->segment_first = first;
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
    PetscCall(ContactPairGetNormals(term->view->pair, &term->normal));
    PetscCall(FacetEdges_Private(t, &term->view->nonmortar, &term->facet_place[0]));
    PetscCall(FacetEdges_Private(t, &term->view->mortar, &term->facet_place[1]));
    PetscCall(GatherSegments_Private(ForestComm(forest), t, term->view, &num, &all));
    PetscCall(SortSegments_Private(term->view->mortar.num_facets, num, all, term));
    PetscCall(PetscFree(all));
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

/* Fraction of reference position X along an edge (0 at its first node), and current over reference measure there. */
static PetscReal AlongEdge_Private(const ContactTerms *terms, const SurfaceView *s, PetscInt edge, const PetscReal X[], PetscReal *stretch)
{
  const PetscReal *Xa = s->X + 2 * s->facets[2 * edge], *Xb = s->X + 2 * s->facets[2 * edge + 1], *xa = s->x + 2 * s->facets[2 * edge],
                  *xb  = s->x + 2 * s->facets[2 * edge + 1];
  const PetscReal E[2] = {Xb[0] - Xa[0], Xb[1] - Xa[1]}, e[2] = {xb[0] - xa[0], xb[1] - xa[1]}, square = E[0] * E[0] + E[1] * E[1];
  const PetscReal lambda = ((X[0] - Xa[0]) * E[0] + (X[1] - Xa[1]) * E[1]) / square;

  *stretch = 1;
  if (terms->kinematics == KINEMATICS_FINITE) {
    *stretch = PetscSqrtReal((e[0] * e[0] + e[1] * e[1]) / square);
    if (terms->model == MODEL_AXISYMMETRIC) *stretch *= (xa[0] + lambda * e[0]) / X[0];
  }
  return lambda;
}

/* T += factor * z n at fraction lambda of a nonmortar edge. */
static void Push_Private(const ContactTerm *term, PetscInt edge, PetscReal lambda, PetscReal factor, PetscReal T[3])
{
  const PetscInt *node = term->view->nonmortar.facets + 2 * edge;
  const PetscReal N[2] = {1 - lambda, lambda}, z = N[0] * term->view->z[node[0]] + N[1] * term->view->z[node[1]];
  PetscReal       n[2];

  for (PetscInt c = 0; c < 2; ++c) n[c] = N[0] * term->normal[2 * node[0] + c] + N[1] * term->normal[2 * node[1] + c];
  const PetscReal length = PetscSqrtReal(n[0] * n[0] + n[1] * n[1]);
  for (PetscInt c = 0; c < 2 && length > 0; ++c) T[c] += factor * z * n[c] / length;
}

/* The segment of a mortar edge that holds eta in [-1, 1], and the fraction along its nonmortar edge there. */
static PetscInt FindSegment_Private(const ContactTerm *term, PetscInt mortar_facet, PetscReal eta, PetscReal *lambda)
{
  for (PetscInt i = term->segment_first[mortar_facet]; i < term->segment_first[mortar_facet + 1]; ++i) {
    const ContactSegment *s = &term->segments[i];
    const PetscReal       a = (eta - s->eta[0][0]) / (s->eta[1][0] - s->eta[0][0]);
    if (!(a >= 0 && a <= 1)) continue;
    *lambda = 0.5 * (1 + s->xi[0][0] + a * (s->xi[1][0] - s->xi[0][0]));
    return i;
  }
  return -1;
}

void ContactTermsTraction_Private(const ContactTerms *terms, PetscInt facet, const PetscReal X[3], PetscReal T[3])
{
  for (PetscInt i = 0; i < terms->num; ++i) {
    const ContactTerm *term      = &terms->terms[i];
    const PetscInt     nonmortar = term->facet_place[0][facet], mortar = term->facet_place[1][facet];
    PetscReal          stretch, lambda;
    if (nonmortar >= 0) {
      lambda = AlongEdge_Private(terms, &term->view->nonmortar, nonmortar, X, &stretch);
      Push_Private(term, nonmortar, lambda, -stretch, T);
    }
    if (mortar < 0) continue;
    const PetscReal eta   = 2 * AlongEdge_Private(terms, &term->view->mortar, mortar, X, &stretch) - 1;
    const PetscInt  found = FindSegment_Private(term, mortar, eta, &lambda);
    if (found >= 0) Push_Private(term, term->segments[found].facet, lambda, stretch, T);
  }
}

/* Gap at a node from the weighted gap; PETSC_FALSE where the node sees (almost) nothing. */
static PetscBool NodalGap_Private(const ContactView *view, PetscInt node, PetscReal length, PetscReal *gap)
{
  if (!(view->weight[node] > UNCOVERED * length)) return PETSC_FALSE;
  *gap = view->gap[node] / view->weight[node];
  return PETSC_TRUE;
}

/* int z+ g+ and int g-^2 over a nonmortar edge (current measure), linear z and g by 3 Gauss points. */
static PetscErrorCode EdgeIntegrals_Private(const ContactTerms *terms, const ContactTerm *term, PetscInt edge, PetscReal *product, PetscReal *penetration)
{
  const SurfaceView *s    = &term->view->nonmortar;
  const PetscInt    *node = s->facets + 2 * edge;
  const PetscReal   *x = terms->kinematics == KINEMATICS_FINITE ? s->x : s->X, *xa = x + 2 * node[0], *xb = x + 2 * node[1];
  const PetscReal    length = PetscSqrtReal(PetscSqr(xb[0] - xa[0]) + PetscSqr(xb[1] - xa[1]));
  const Basis1D     *gauss;
  PetscReal          g[2];

  PetscFunctionBegin;
  *product = *penetration = 0;
  if (!NodalGap_Private(term->view, node[0], length, &g[0]) || !NodalGap_Private(term->view, node[1], length, &g[1])) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Basis1DGet(1, 3, &gauss));
  for (PetscInt q = 0; q < 3; ++q) {
    const PetscReal b = gauss->points[q], a = 1 - b, z = a * term->view->z[node[0]] + b * term->view->z[node[1]], gap = a * g[0] + b * g[1];
    PetscReal       weight = gauss->weights[q] * length;
    if (terms->model == MODEL_AXISYMMETRIC) weight *= 2 * PETSC_PI * (a * xa[0] + b * xb[0]);
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
      PetscCall(EdgeIntegrals_Private(sum->contact, term, term->facet_place[0][f->facet], &product, &penetration));
      sum->eta2[leaf] += product + factor * penetration;
      sum->part[PART_CONTACT] += product + factor * penetration;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
