/* What the constraints do not see of the gap. They know its mean over the multiplier's functions alone: there may be overlap and opening between nodes, where
   the functions are too coarse for what lies opposite, or chords of a round body press their corners in.

   A gap a cos(k x) between two bodies, of a wavelength that is small against them, presses with E* k a/2 and takes an energy of E* k a^2/8 per area,
   1/E* = (1 - nu^2)/E of one + that of the other (a rigid one: 0). In the squared energy norm that is s g^2 in the mean, s = E* k/2. The longest wave that
   functions of order p on a facet of size h miss is k = 2 pi p/h. So eta^2 = int s r^2 with r = g where surfaces overlap, and where they gape under a pressure
   z

     r = min(g - gn, z/s)

   Bodies that yield as a whole, as slender ones do, rather move apart by the deepest overlap of a facet: the squares of overlap there are no more than twice
   the work of the facet's force on it.

   A tied pair: r = g is the size of the distance of both surfaces' material points, all of it.

   gn: the gap that the nodes show, which EstimateComplementarity_Private has; no gap takes more than the pressure that closes it does.

   Exact geometry: g is less by what the round surfaces of both sides stand out of their facets, without its mean over the facet, which moves the bodies as a
   whole. That changes the energy by the work of the pressure on it, signed: it cancels where surfaces stand out here and in there. */
#include "estimateimpl.h"

/* Shares of the pressure's work on the bulges of both sides: signed and absolute sums of a pair, absolute ones of leaves. */
typedef struct {
  PetscReal  sum[2];
  PetscReal *leaf; /* owned [num_leaves] */
} BulgeWork;

/* (1 - nu^2)/E, from mu/kappa: 1/(4 mu) where kappa is infinite; flowed: such that a gap has the energy that flow leaves it (flow.c). */
PetscReal EstimateCompliance_Private(const EstimateSum *sum, PetscInt leaf, PetscBool flowed)
{
  const MaterialSpec *m = sum->spec->bodies[sum->t->leaf_body[leaf]].material;

  return m->law->rigid ? 0 : (3 + 4 * m->mu / m->kappa) / (4 * m->mu * (3 + m->mu / m->kappa)) / (flowed ? EstimateLeft_Private(sum, leaf) : 1);
}

/* Size of a facet over the order of its functions. */
PetscReal ContactFacetSize_Private(const SurfaceView *s, PetscInt facet)
{
  const PetscReal middle[2] = {0, 0};
  PetscReal       t[2][3];

  SurfaceTangents(s, facet, s->x, middle, t);
  const PetscReal measure = ContactMeasure_Private(t);
  return (s->dim == 3 ? PetscSqrtReal(4 * measure) : 2 * measure) / (PetscReal)s->order[facet];
}

/* How far the mortar side is from plane over a facet: int (y - c0 - c1 xi_1 - c2 xi_2)^2, y its height, by orthogonalising these functions one by one. */
static PetscReal Bend_Private(const GapPoints *points)
{
  PetscReal A[3][4] = {{0}}, square = 0;

  for (PetscInt i = 0; i < points->num; ++i) {
    const GapPoint *p = &points->points[i];
    const PetscReal y = p->height - points->points[0].height, v[4] = {1, p->xi[0], p->xi[1], y};
    for (PetscInt r = 0; r < 3; ++r) {
      for (PetscInt c = 0; c < 4; ++c) A[r][c] += p->weight * v[r] * v[c];
    }
    square += p->weight * PetscSqr(y);
  }
  for (PetscInt k = 0; k < 3; ++k) {
    if (!(A[k][k] > 0)) continue;
    square -= PetscSqr(A[k][3]) / A[k][k];
    for (PetscInt r = k + 1; r < 3; ++r) {
      const PetscReal factor = A[r][k] / A[k][k];
      for (PetscInt c = k; c < 4; ++c) A[r][c] -= factor * A[k][c];
    }
  }
  return PetscMax(square, 0);
}

/* Who is to be refined: share of the mortar cell. A gap that is not of the geometry is for the coarser side to follow or to let go, but a mortar side that is
   plane here and stiffer does neither: bend is how far it is from that, 0 to 1. A bulge is the facet's whose it is. */
static PetscReal MortarShare_Private(const ContactTerm *term, const GapPoint *p, const PetscReal compliance[2], PetscReal bend)
{
  const PetscReal size[2] = {ContactFacetSize_Private(&term->view->nonmortar, p->segment->facet),
                             ContactFacetSize_Private(&term->view->mortar, p->segment->mortar_facet)};
  const PetscReal coarser = PetscSqr(size[1]) / (PetscSqr(size[0]) + PetscSqr(size[1])), softer = compliance[1] / (compliance[0] + compliance[1]);
  const PetscReal bulge[2] = {PetscSqr(p->bulge[0] - p->mean[0]), PetscSqr(p->bulge[1] - p->mean[1])}, gap = PetscSqr(p->gap);
  const PetscReal whole = gap + bulge[0] + bulge[1];

  return whole > 0 ? (coarser * PetscMax(softer, bend) * gap + bulge[1]) / whole : 0;
}

/* The gap with exact geometry. */
static PetscReal Gap_Private(const GapPoint *p)
{
  return p->pressure > 0 ? p->gap - (p->bulge[0] - p->mean[0]) - (p->bulge[1] - p->mean[1]) : p->gap;
}

/* s r^2 at a point, per weight. */
static PetscReal Square_Private(const GapPoint *p, PetscBool ties, PetscReal s)
{
  if (ties) return s * PetscSqr(p->gap);
  const PetscReal gap = Gap_Private(p);

  if (gap < 0) return s * PetscSqr(gap);
  return s * PetscSqr(PetscMin(PetscMax(gap - PetscMax(p->nodal, 0), 0), p->pressure / s));
}

/* s at a point, of the cells on either side; 0: both are rigid, there is no energy. compliance[2]: of either. */
static PetscReal Stiffness_Private(const EstimateSum *sum, const ContactTerm *term, const GapPoint *p, PetscReal size, PetscBool flowed,
                                   PetscReal compliance[2])
{
  compliance[0] = EstimateCompliance_Private(sum, term->view->nonmortar.facet_leaf[p->segment->facet], flowed);
  compliance[1] = EstimateCompliance_Private(sum, term->view->mortar.facet_leaf[p->segment->mortar_facet], flowed);
  return compliance[0] + compliance[1] == 0 ? 0 : PETSC_PI / (size * (compliance[0] + compliance[1]));
}

/* The share of the squares of overlap on a facet that counts: bodies that yield as a whole, as slender ones do, rather move apart by the deepest overlap, which
   takes the work of the facet's force on it. */
static PetscReal Yield_Private(const EstimateSum *sum, const ContactTerm *term, PetscReal size, PetscBool flowed, const GapPoints *points)
{
  PetscReal force = 0, deepest = 0, squares = 0, compliance[2];

  for (PetscInt i = 0; i < points->num; ++i) {
    const GapPoint *p   = &points->points[i];
    const PetscReal gap = PetscMin(Gap_Private(p), 0);
    force += p->weight * p->pressure;
    if (gap == 0) continue;
    deepest = PetscMax(deepest, -gap);
    squares += p->weight * Stiffness_Private(sum, term, p, size, flowed, compliance) * PetscSqr(gap);
  }
  return force > 0 && squares > 2 * force * deepest ? 2 * force * deepest / squares : 1;
}

/* Overlap that no node of the pair has seen. */
static void Overlap_Private(EstimateSum *sum, const ContactTerm *term, PetscReal size, const GapPoints *points)
{
  for (PetscInt i = 0; i < points->num && term->bare; ++i) {
    const PetscReal depth = -points->points[i].gap;
    if (depth > sum->overlap.share * size) sum->overlap = (EstimateOverlap){depth / size, depth, term->view->spec->pair};
  }
}

/* A pair on a facet: squares as if nothing had flowed rank the cells, those with what flow has left are told. */
static void Facet_Private(EstimateSum *sum, const ContactTerm *term, PetscInt facet, const GapPoints *points, BulgeWork *work)
{
  const PetscInt  leaf = term->view->nonmortar.facet_leaf[facet];
  const PetscReal size = ContactFacetSize_Private(&term->view->nonmortar, facet), bend = Bend_Private(points);
  const PetscBool ties = (PetscBool)(term->view->spec->law == CONTACT_TIED);
  PetscReal       gaps = 0, compliance[2], yield[2];

  Overlap_Private(sum, term, size, points);
  for (int flowed = 0; flowed < 2; ++flowed) yield[flowed] = ties ? 1 : Yield_Private(sum, term, size, (PetscBool)flowed, points);
  for (PetscInt i = 0; i < points->num; ++i) gaps += points->points[i].weight * PetscSqr(points->points[i].gap);
  for (PetscInt i = 0; i < points->num; ++i) {
    const GapPoint *p     = &points->points[i];
    const PetscInt  other = term->view->mortar.facet_leaf[p->segment->mortar_facet];
    PetscReal       square[2];
    for (int flowed = 1; flowed >= 0; --flowed) {
      const PetscReal s = Stiffness_Private(sum, term, p, size, (PetscBool)flowed, compliance);
      square[flowed]    = s == 0 ? 0 : p->weight * Square_Private(p, ties, s) * (!ties && Gap_Private(p) < 0 ? yield[flowed] : 1);
    }
    if (compliance[0] + compliance[1] == 0) continue; /* what is not a number is to show */
    const PetscReal share = MortarShare_Private(term, p, compliance, gaps > bend ? bend / gaps : 1);
    sum->eta2[leaf] += (1 - share) * square[0];
    sum->eta2[other] += share * square[0];
    sum->part[PART_CONTACT] += square[1];
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscReal done = 2 * p->weight * p->trace * p->bulge[k];
      work->sum[0] += done;
      work->sum[1] += PetscAbsReal(done);
      work->leaf[k ? other : leaf] += PetscAbsReal(done);
    }
  }
}

/* The work of a pair as a change of energy, to the leaves by what they take part in it. */
static PetscErrorCode Work_Private(EstimateSum *sum, MPI_Comm comm, const BulgeWork *work)
{
  PetscReal total[2];

  PetscFunctionBegin;
  PetscCallMPI(MPI_Allreduce(work->sum, total, 2, MPIU_REAL, MPI_SUM, comm));
  for (PetscInt l = 0; l < sum->t->num_leaves && total[1] > 0; ++l) {
    const PetscReal square = work->leaf[l] * PetscAbsReal(total[0]) / total[1];
    sum->eta2[l] += square;
    sum->part[PART_CONTACT] += square;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Segments come by nonmortar facet, each from the rank that owns its leaf. */
static PetscErrorCode Pair_Private(EstimateSum *sum, PetscMPIInt rank, const ContactTerm *term, GapPoints *points, BulgeWork *work)
{
  const ContactSegment *segments;
  PetscInt              num;

  PetscFunctionBegin;
  work->sum[0] = work->sum[1] = 0;
  PetscCall(PetscArrayzero(work->leaf, sum->t->num_leaves));
  ContactPairGetSegments(term->view->pair, &num, &segments);
  for (PetscInt i = 0, end; i < num; i = end) {
    const PetscInt facet = segments[i].facet;
    for (end = i; end < num && segments[end].facet == facet;) ++end;
    if (sum->t->leaf_rank[term->view->nonmortar.facet_leaf[facet]] != rank) continue;
    PetscCall(GapPointsFind_Private(sum, term, end - i, segments + i, points));
    Facet_Private(sum, term, facet, points, work);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EstimateGap_Private(EstimateSum *sum)
{
  GapPoints    points = {0};
  BulgeWork    work   = {.leaf = NULL};
  PetscMPIInt  rank;
  const Forest forest = HPSpaceGetForest(sum->space);

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(ForestComm(forest), &rank));
  PetscCall(PetscMalloc1(sum->t->num_leaves, &work.leaf));
  for (PetscInt i = 0; i < sum->contact->num; ++i) {
    PetscCall(Pair_Private(sum, rank, &sum->contact->terms[i], &points, &work));
    PetscCall(Work_Private(sum, ForestComm(forest), &work));
  }
  PetscCall(PetscFree(points.points));
  PetscCall(PetscFree(work.leaf));
  PetscFunctionReturn(PETSC_SUCCESS);
}
