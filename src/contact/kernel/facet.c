/* One nonmortar facet by rays along a continuous direction: gathers, integrates, and hands out weighted gaps with their derivatives by the nodes that do not
   hang. */
#include "kernelimpl.h"

#define TERMS RAY_TERMS

PetscErrorCode ContactRayTopology(ContactPair pair, const ContactSurface *s)
{
  PetscFunctionBegin;
  if (!pair->ray) PetscCall(PetscNew(&pair->ray));
  PetscCall(ContactRayLatticePrepare());
  PetscCheck(s->X, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "contact along a continuous direction needs the reference positions of the nonmortar surface");
  PetscCall(PetscFree(pair->normal));
  pair->num_nodes  = s->num_nodes;
  pair->num_facets = s->num_facets;
  PetscCall(PetscCalloc1(s->dim * s->num_nodes, &pair->normal));
  PetscCall(ContactDirectionTopology(pair->ray, s));
  ContactDirections(pair->ray, s);
  if (!pair->multiplier && s->order) PetscCall(ContactMultiplierCreate(s, pair->axisymmetric, pair->standard, NULL, &pair->multiplier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactRayMortarTopology(RayWork w, const ContactSurface *mortar)
{
  PetscInt *side;

  PetscFunctionBegin;
  PetscCall(PetscFree2(w->mortar_parent, w->mortar_middle));
  PetscCall(PetscMalloc2(2 * mortar->num_nodes, &w->mortar_parent, 4 * mortar->num_facets, &w->mortar_middle));
  PetscCall(ContactParents(mortar, w->mortar_parent, w->mortar_middle));
  side = w->mortar_middle;
  for (PetscInt i = 0; i < 4 * mortar->num_facets; i++) {
    if (side[i] < 0) continue;
    if (mortar->order && mortar->order[i / 4] > 1)
      w->mortar_parent[2 * side[i]] = w->mortar_parent[2 * side[i] + 1] = -1;
    else
      side[i] = -1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairGetMortarParents(ContactPair pair, const PetscInt **parent)
{
  PetscFunctionBegin;
  *parent = pair->ray->mortar_parent;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactPairSetCarriers(ContactPair pair, const ContactSurface *nonmortar, const PetscBool carries[])
{
  PetscFunctionBegin;
  pair->state.stands = PETSC_FALSE;
  PetscCall(ContactMultiplierDestroy(&pair->multiplier));
  if (nonmortar->order) PetscCall(ContactMultiplierCreate(nonmortar, pair->axisymmetric, pair->standard, carries, &pair->multiplier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactRayWorkDestroy(RayWork *work)
{
  RayWork w = *work;

  PetscFunctionBegin;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactResultDestroy(&w->result));
  PetscCall(PetscFree(w->along));
  PetscCall(PetscFree7(w->ring_first, w->ring, w->sheet, w->end, w->parent, w->d, w->kept));
  PetscCall(PetscFree2(w->mortar_parent, w->mortar_middle));
  PetscCall(PetscFree(w->ball));
  PetscCall(PetscFree(w->image));
  PetscCall(PetscFree(w->overlap));
  PetscCall(PetscFree(w->mortar));
  PetscCall(PetscFree(w->window));
  PetscCall(PetscFree(w->vertex));
  PetscCall(PetscFree(w->test));
  PetscCall(PetscFree(w->place));
  PetscCall(PetscFree(w->first_place));
  PetscCall(PetscFree(w->dq));
  PetscCall(PetscFree(w->W));
  PetscCall(PetscFree(w->J));
  PetscCall(PetscFree(w->R));
  PetscCall(PetscFree(w->WJ));
  PetscCall(PetscFree(w->part));
  PetscCall(PetscFree(w->buffer));
  PetscCall(PetscFree(w->T));
  PetscCall(PetscFree(w->softness));
  PetscCall(PetscFree(w->rows));
  PetscCall(PetscFree(*work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are the directions at the corners of a facet known here? */
static PetscBool HasDirections_Private(ContactPair pair, const ContactSurface *s, PetscInt facet)
{
  const PetscInt nv = 2 * (s->dim - 1);

  for (PetscInt v = 0; v < nv; v++)
    if (PetscIsNanReal(pair->ray->d[3 * (nv * facet + v)])) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Unit directions at the nodes of the nonmortar surface, for output and estimation; NaN where they are not known here. */
static void Normals_Private(ContactPair pair, const ContactSurface *s)
{
  const PetscInt D = s->dim, m = D - 1, nv = 2 * m;
  RayFunctions   V;

  for (PetscInt i = 0; i < D * s->num_nodes && s->has; i++) pair->normal[i] = NAN;
  for (PetscInt f = 0; f < s->num_facets; f++) {
    const PetscInt  *node;
    const PetscReal *gauss = NULL;
    PetscInt         order1[4], p;

    if (!HasDirections_Private(pair, s, f)) continue;
    p = ContactFacetLattice(s, f, &node, order1);
    if (ElementGetNodes(p, &gauss)) continue;
    for (PetscInt a = 0; a < ElementNumNodes(m, p); a++) {
      const PetscReal xi[2] = {2 * gauss[a % (p + 1)] - 1, 2 * gauss[a / (p + 1)] - 1};
      PetscReal       d[3]  = {0, 0, 0}, length;

      ContactRayFunctions(m, 1, xi, 1, &V);
      for (PetscInt v = 0; v < nv; v++)
        for (int c = 0; c < 3; c++) d[c] += V.N[v] * pair->ray->d[3 * (nv * f + (v < 2 ? v : 5 - v)) + c];
      length = PetscSqrtReal(Dot3(d, d));
      for (PetscInt c = 0; c < D; c++) pair->normal[D * node[a] + c] = length > 0 ? d[c] / length : 0;
    }
  }
}

/* ---- nodes --------------------------------------------------------------------------------------------------------------- */

/* Rows and T from the constant functions of a facet that is covered. */
static PetscErrorCode Functions_Private(RayWork w, const ContactMultiplier *multiplier, PetscInt facet)
{
  const PetscInt first = multiplier->row_first[facet], num = w->facet.s.num;
  PetscInt       place;

  PetscFunctionBegin;
  w->result.num_rows = multiplier->row_first[facet + 1] - first;
  for (PetscInt r = 0; r < w->result.num_rows; r++) PetscCall(ContactResultNode(&w->result, multiplier->row_node[first + r], &place));
  PetscCall(ContactGrow(w->result.num_rows * num, sizeof(PetscReal), &w->size_T, &w->T));
  PetscCall(PetscArraycpy(w->T, multiplier->T + multiplier->offset[facet], w->result.num_rows * num));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of the result and T, the multiplier functions by those of the lattice: constant ones where the facet is covered, else those of the true nodes. Hats
   of hanging nodes go to their masters in the ratio of the positive weights: functions stay positive, whatever is covered. */
static PetscErrorCode Nodes_Private(const EvaluateContext *ctx, PetscInt facet)
{
  RayWork         w  = ctx->pair->ray;
  const PetscInt  na = w->facet.s.num, nv = w->facet.nv;
  const PetscBool constant = (PetscBool)(ctx->pair->multiplier && w->full && w->facet.s.order > 1);
  const PetscInt *lattice;
  PetscInt        order1[4], num = 0, place;
  DirectionTerm   term[TERMS];

  PetscFunctionBegin;
  w->result.num_nodes = 0;
  ContactFacetLattice(ctx->nonmortar, facet, &lattice, order1);
  if (constant) PetscCall(Functions_Private(w, ctx->pair->multiplier, facet));
  PetscCall(ContactGrow(na + w->num_mortar + 1, sizeof(PetscInt), &w->result.size_row_first, &w->result.row_first));
  for (PetscInt a = 0; a < na; a++) PetscCall(ContactResultRow(&w->result, ctx->nonmortar, lattice[a], PETSC_FALSE, a, &num));
  if (!constant) {
    const PetscBool hats = w->test[0].hats;

    w->result.num_rows = w->result.num_nodes;
    PetscCall(ContactGrow(w->result.num_rows * na, sizeof(PetscReal), &w->size_T, &w->T));
    PetscCall(PetscArrayzero(w->T, w->result.num_rows * na));
    for (PetscInt a = 0; a < na; a++) {
      PetscReal sum = 0;

      for (PetscInt k = w->result.row_first[a]; k < w->result.row_first[a + 1]; k++) sum += PetscMax(0, w->result.row_weight[k]);
      for (PetscInt k = w->result.row_first[a]; k < w->result.row_first[a + 1]; k++)
        w->T[w->result.row_node[k] * na + a] += hats ? PetscMax(0, w->result.row_weight[k]) / sum : w->result.row_weight[k];
    }
  }
  for (PetscInt v = 0; v < nv; v++) {
    const PetscInt terms = ContactDirectionTerms(w, ctx->nonmortar, nv * facet + v, TERMS, term);

    for (PetscInt t = 0; t < terms; t++)
      for (PetscInt k = 0; k < nv; k++) {
        const PetscInt  *master;
        const PetscReal *weight;
        const PetscInt   masters = ContactNodeRow(ctx->nonmortar, &ctx->nonmortar->facets[nv * term[t].facet + k], &master, &weight);

        for (PetscInt i = 0; i < masters; i++) PetscCall(ContactResultNode(&w->result, master[i], &place));
      }
  }
  for (PetscInt j = 0; j < w->num_mortar; j++) PetscCall(ContactResultRow(&w->result, ctx->mortar, w->vertex[j], PETSC_TRUE, na + j, &num));
  w->nn = w->facet.D * w->result.num_nodes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- results ------------------------------------------------------------------------------------------------------------------------- */

/* Weighted gaps by the lattice: their derivatives by the moments are sparse (num_moments columns). */
typedef struct {
  PetscReal    gap[RAY_LATTICE], reach[RAY_LATTICE], y[RAY_LATTICE]; /* y: weights of the gap moments in sum z gt */
  PetscBool    dual;
  PetscInt     place[FACET_MOMENTS]; /* dual: where the moments stand among those of weights.c, -1 */
  FacetWeights f;
} Weights;

/* Dual functions of the covered part of a facet of order 1; an edge is a facet whose other two nodes stand apart. */
static PetscBool Dual_Private(const RayWork w, PetscReal z[4], Weights *o)
{
  static const int Edge[7]          = {0, 1, 4, 5, 8, 9, 12};
  PetscReal        q[FACET_MOMENTS] = {0};

  if (w->facet.m == 1) {
    q[15] = q[17] = 1;
    z[2] = z[3] = 0;
  }
  for (PetscInt i = 0; i < w->num_moments; i++) {
    o->place[i]    = w->facet.m == 1 ? Edge[i] : (int)i;
    q[o->place[i]] = w->q[i];
  }
  if (!ContactFacetWeights(q, z, &o->f)) return PETSC_FALSE;
  for (PetscInt a = 0; a < w->facet.nv; a++) {
    o->gap[a]   = o->f.gap[a];
    o->y[a]     = o->f.g[a];
    o->reach[a] = 0;
    for (PetscInt b = 0; b < w->facet.nv; b++) o->reach[a] += o->f.dgap[a][o->place[b]] * w->reach[b]; /* gaps are linear in their moments */
  }
  return PETSC_TRUE;
}

/* row[n] += factor * derivative of gap a */
static void GapRow_Private(const RayWork w, const Weights *o, PetscInt a, PetscReal factor, PetscReal row[])
{
  for (PetscInt q = 0; q < w->num_moments; q++) {
    const PetscReal f = factor * (o->dual ? o->f.dgap[a][o->place[q]] : q == a);

    if (f == 0) continue;
    for (PetscInt i = 0; i < w->n; i++) row[i] += f * w->dq[q * w->n + i];
  }
}

/* to[num_rows][nn] = sum_a T[r][a] (gap a; without o: weight a) J; held (unless NULL): the same with the images held. */
static PetscErrorCode Rows_Private(RayWork w, const Weights *o, PetscReal to[], PetscReal held[])
{
  const PetscInt na = w->facet.s.num, n = w->n, nr = w->result.num_rows;
  PetscReal     *row;

  PetscFunctionBegin;
  PetscCall(ContactGrow(n * nr + n * na, sizeof(PetscReal), &w->size_rows, &w->rows));
  PetscCall(PetscArrayzero(w->rows, n * nr + n * na));
  row = w->rows + n * nr;
  for (PetscInt a = 0; a < na; a++)
    if (o)
      GapRow_Private(w, o, a, 1, row + a * n);
    else
      PetscCall(PetscArraycpy(row + a * n, w->dq + (na + a) * n, n));
  for (PetscInt r = 0; r < nr; r++)
    for (PetscInt a = 0; a < na; a++) {
      const PetscReal t = w->T[r * na + a];

      if (t == 0) continue;
      for (PetscInt i = 0; i < n; i++) w->rows[i * nr + r] += t * row[a * n + i];
    }
  if (held) ContactRayChainNodes(w, nr, w->rows, held);
  ContactRayChainImages(w, nr, w->rows);
  ContactRayChainNodes(w, nr, w->rows, to);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Hessian_Private(const EvaluateContext *ctx, PetscInt facet, const Weights *o, const PetscReal y[], PetscReal H[])
{
  RayWork        w = ctx->pair->ray;
  const PetscInt n = w->n;
  PetscReal     *gradient, *left, *right;

  PetscFunctionBegin;
  PetscCall(ContactGrow(3 * n, sizeof(PetscReal), &w->size_rows, &w->rows));
  PetscCall(PetscArrayzero(w->rows, 3 * n));
  gradient = w->rows, left = gradient + n, right = left + n;
  PetscCall(ContactRayHessian(ctx->pair, ctx->mortar, o->dual ? o->f.g : y, o->dual ? o->f.D : NULL, gradient));
  for (int p = 0; o->dual && p < o->f.num_pairs; p++) {
    for (PetscInt i = 0; i < 2 * n; i++) left[i] = 0;
    for (PetscInt q = 0; q < w->num_moments; q++)
      for (PetscInt i = 0; i < n; i++) {
        left[i] += o->f.left[p][o->place[q]] * w->dq[q * n + i];
        right[i] += o->f.right[p][o->place[q]] * w->dq[q * n + i];
      }
    ContactRayProducts(1, 1, n, left, n, n, right, n, w->W, n);
  }
  PetscCall(ContactRayChainHessian(w, H));
  ContactRayChainImages(w, 1, gradient);
  PetscCall(ContactRayDirectionCurvature(w, ctx->nonmortar, facet, gradient, H));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Spring_Private(RayWork w, const RaySpring *spring, ContactFacet *out)
{
  const PetscInt nr = w->result.num_rows;
  PetscReal     *K;

  PetscFunctionBegin;
  out->spring = out->stiffening = NULL;
  if (!spring->on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactStoreReserve(&w->result.store, 2 * nr, &K));
  for (PetscInt r = 0; r < nr; r++)
    for (int i = 0; i < 2; i++) K[nr * i + r] = spring->share[i] * spring->softness[r];
  out->spring     = K;
  out->stiffening = K + nr;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Result_Private(const EvaluateContext *ctx, PetscInt facet, const Weights *o, const PetscReal y[], PetscBool derivatives,
                                     PetscBool hessian, ContactFacet *out)
{
  RaySpring      spring;
  RayWork        w  = ctx->pair->ray;
  const PetscInt na = w->facet.s.num, nr = w->result.num_rows, nn = w->nn;
  PetscReal     *gap, *weight, *reach, *dgap, *push = NULL;

  PetscFunctionBegin;
  PetscCall(ContactStoreReserve(&w->result.store, 3 * nr, &gap));
  weight = gap + nr, reach = weight + nr;
  for (PetscInt r = 0; r < nr; r++)
    for (PetscInt a = 0; a < na; a++) {
      gap[r] += w->T[r * na + a] * o->gap[a];
      weight[r] += w->T[r * na + a] * w->q[na + a];
      reach[r] += w->T[r * na + a] * o->reach[a];
    }
  out->gap     = gap;
  out->weight  = weight;
  out->reach   = w->facet.s.order == 1 ? reach : NULL; /* curved facets turn with their directions: a gap of 1 along the normal counts as its area */
  out->area    = w->covered;
  out->min_gap = w->min_gap;
  out->dgap = out->dweight = out->push = out->hessian = out->darea = NULL;
  PetscCall(ContactRaySpring(ctx->pair, ctx->nonmortar, facet, &spring));
  PetscCall(Spring_Private(w, &spring, out));
  if (!derivatives) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactRayChain(w, ctx->nonmortar, facet, ctx->pair->held));
  PetscCall(ContactStoreReserve(&w->result.store, 2 * nr * nn, &dgap));
  out->dgap    = dgap;
  out->dweight = dgap + nr * nn;
  if (w->frozen) PetscCall(ContactStoreReserve(&w->result.store, nr * nn, &push));
  out->push = push;
  PetscCall(Rows_Private(w, o, dgap, push));
  PetscCall(Rows_Private(w, NULL, dgap + nr * nn, NULL));
  if (spring.on) {
    PetscCall(ContactStoreReserve(&w->result.store, nn, (PetscReal **)&out->darea));
    for (PetscInt i = 0; i < nr * nn; i++) ((PetscReal *)out->darea)[i % nn] += out->dweight[i];
  }
  if (!hessian) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactStoreReserve(&w->result.store, nn * nn, (PetscReal **)&out->hessian));
  PetscCall(Hessian_Private(ctx, facet, o, y, (PetscReal *)out->hessian));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The Hessian of a result that has the rest. */
static PetscErrorCode Curve_Private(const EvaluateContext *ctx, PetscInt facet, const PetscReal y[], ContactFacet *out)
{
  const Weights plain = {.dual = PETSC_FALSE};
  RayWork       w     = ctx->pair->ray;

  PetscFunctionBegin;
  PetscCall(ContactRayChain(w, ctx->nonmortar, facet, PETSC_FALSE));
  PetscCall(ContactStoreReserve(&w->result.store, w->nn * w->nn, (PetscReal **)&out->hessian));
  PetscCall(Hessian_Private(ctx, facet, &plain, y, (PetscReal *)out->hessian));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corners of the overlaps on both facets. */
static PetscErrorCode Segments_Private(const EvaluateContext *ctx, PetscInt facet)
{
  RayWork    w = ctx->pair->ray;
  RayLattice mortar;
  RayGuess   at;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    const Overlap  *o = &w->overlap[k];
    ContactSegment *s;

    PetscCall(ContactResultSegment(ctx->pair, facet, w->mortar[k], w->facet.m == 1 ? 2 : o->num, &s));
    ContactRayLatticeGather(ctx->mortar, w->mortar[k], &mortar);
    ContactRayGuess(&w->facet, &mortar, o, &at);
    memcpy(s->xi, at.xi, sizeof(s->xi));
    memcpy(s->eta, at.eta, sizeof(s->eta));
    if (o->node < 0) continue;
    for (int i = 0; i < 2; i++) s->xi[1 - o->node][i] = s->xi[o->node][i], s->eta[1 - o->node][i] = s->eta[o->node][i];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One listed facet; *use is false when nothing covers it. */
static PetscErrorCode Facet_Private(const EvaluateContext *ctx, PetscInt slot, ContactFacet *out, PetscBool *use, PetscBool *failed)
{
  ContactPair    pair  = ctx->pair;
  RayWork        w     = pair->ray;
  const PetscInt facet = pair->listed[slot];
  PetscReal      y[RAY_LATTICE];
  PetscInt       first, overlaps;
  PetscBool      derivatives, loaded = PETSC_FALSE;
  Weights        o;

  PetscFunctionBegin;
  PetscCall(ContactCover(pair, ctx->nonmortar, ctx->mortar, slot, failed));
  if (*failed || w->num_overlaps == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Nodes_Private(ctx, facet));
  for (PetscInt a = 0; a < w->facet.s.num; a++) {
    y[a] = 0;
    for (PetscInt r = 0; r < w->result.num_rows && ctx->z; r++) y[a] += ctx->z[w->result.node[r]] * w->T[r * w->facet.s.num + a];
    if (y[a] != 0) loaded = PETSC_TRUE;
  }
  loaded      = (PetscBool)(loaded || ContactSlipLoads(ctx));
  derivatives = ContactResultDerivatives(ctx, w->result.num_rows, w->result.node, loaded);
  o.dual      = (PetscBool)(!pair->standard && w->facet.s.order == 1 && !w->test[0].hats);
  if (ctx->again && !pair->held && out->dgap && !o.dual && !out->spring && w->first_place[slot] >= 0) { /* nothing else is missing */
    w->places = w->place + w->first_place[slot];
    PetscCall(Curve_Private(ctx, facet, y, out));
    *use = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  first = w->num_places, overlaps = w->num_overlaps;
  PetscCall(ContactRayMoments(pair, ctx->mortar, o.dual, derivatives));
  w->first_place[slot] = w->num_overlaps == overlaps ? first : -1;
  w->places            = w->place + first;
  if (w->num_overlaps == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt a = 0; a < w->facet.s.num; a++) o.gap[a] = w->q[a], o.reach[a] = w->reach[a];
  if (o.dual && !Dual_Private(w, y, &o)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ctx->again) PetscCall(Segments_Private(ctx, facet));
  PetscCall(Result_Private(ctx, facet, &o, y, derivatives, (PetscBool)(ctx->hessian && loaded && !pair->held), out));
  PetscCall(ContactSlipFacet(ctx, facet, o.dual, derivatives, out));
  *use = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactRayEvaluate(const EvaluateContext *ctx, PetscBool *failed)
{
  RayWork w = ctx->pair->ray;

  PetscFunctionBegin;
  if (!ctx->again) {
    ContactDirections(w, ctx->nonmortar);
    Normals_Private(ctx->pair, ctx->nonmortar);
    if (ctx->pair->start[ctx->pair->num_listed]) PetscCall(ContactRayBalls(w, ctx->mortar));
    w->num_places = 0;
    PetscCall(ContactGrow(ctx->pair->num_listed, sizeof(PetscInt), &w->size_first_place, &w->first_place));
  }
  PetscCall(ContactResultsEvaluate(ctx, &w->result, Facet_Private, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
