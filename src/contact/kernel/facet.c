/* One nonmortar facet by rays along a continuous direction: gathers, integrates, and hands out weighted gaps with their derivatives by the nodes that do not
   hang. */
#include "kernelimpl.h"

PetscErrorCode ContactRayTopology(ContactPair pair, const ContactSurface *s)
{
  PetscFunctionBegin;
  if (!pair->ray) PetscCall(PetscNew(&pair->ray));
  PetscCheck(s->X, PETSC_COMM_SELF, PETSC_ERR_ARG_NULL, "contact along a continuous direction needs the reference positions of the nonmortar surface");
  PetscCall(PetscFree(pair->normal));
  pair->num_nodes  = s->num_nodes;
  pair->num_facets = s->num_facets;
  PetscCall(PetscCalloc1(s->dim * s->num_nodes, &pair->normal));
  PetscCall(ContactDirectionTopology(pair->ray, s, pair->friction));
  ContactDirections(pair->ray, s);
  if (!pair->multiplier) PetscCall(ContactMultiplierCreate(s, pair->axisymmetric, pair->standard, NULL, NULL, &pair->multiplier));
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

const PetscInt *ContactPairGetMortarParents(ContactPair pair)
{
  return pair->ray->mortar_parent;
}

PetscErrorCode ContactPairSetCarriers(ContactPair pair, const ContactSurface *nonmortar, const PetscBool carries[], const PetscBool late[])
{
  PetscFunctionBegin;
  pair->state.stands = PETSC_FALSE;
  PetscCall(ContactMultiplierDestroy(&pair->multiplier));
  PetscCall(ContactMultiplierCreate(nonmortar, pair->axisymmetric, pair->standard, carries, late, &pair->multiplier));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairSetSoftness(ContactPair pair, const PetscReal softness[])
{
  pair->softness     = softness;
  pair->state.stands = PETSC_FALSE;
}

void ContactPairSetStabilisation(ContactPair pair, const PetscReal kappa[])
{
  pair->stabilisation = kappa;
  pair->state.stands  = PETSC_FALSE;
}

PetscErrorCode ContactRayWorkDestroy(RayWork *work)
{
  RayWork w = *work;

  PetscFunctionBegin;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactResultDestroy(&w->result));
  PetscCall(PetscFree3(w->home, w->home_xi, w->frame));
  PetscCall(PetscFree7(w->ring_first, w->ring, w->sheet, w->end, w->parent, w->d, w->kept));
  PetscCall(PetscFree2(w->mortar_parent, w->mortar_middle));
  PetscCall(FreeAll(17, (void *[]){&w->along, &w->ball, &w->image, &w->overlap, &w->mortar, &w->vertex, &w->place, &w->first_place, &w->dq, &w->W, &w->J, &w->R,
                                   &w->WJ, &w->part, &w->buffer, &w->T, &w->rows}));
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
    const PetscReal *gauss = NULL;
    FacetLattice     l;

    if (!HasDirections_Private(pair, s, f)) continue;
    ContactFacetLattice(s, f, &l);
    if (ElementGetNodes(l.order, &gauss)) continue;
    for (PetscInt a = 0; a < l.num; a++) {
      const PetscReal xi[2] = {2 * gauss[a % (l.order + 1)] - 1, 2 * gauss[a / (l.order + 1)] - 1};
      PetscReal       d[3]  = {0, 0, 0}, length;

      ContactRayFunctions(m, 1, xi, 1, &V);
      for (PetscInt v = 0; v < nv; v++)
        for (int c = 0; c < 3; c++) d[c] += V.N[v] * pair->ray->d[3 * ContactCorner(nv, f, v) + c];
      length = PetscSqrtReal(Dot3(d, d));
      for (PetscInt c = 0; c < D; c++) pair->normal[D * l.node[a] + c] = length > 0 ? d[c] / length : 0;
    }
  }
}

/* ---- nodes --------------------------------------------------------------------------------------------------------------- */

/* Nodes of the result: those of the facet's rows, then all that its directions and its mortar facets depend on. */
static PetscErrorCode Nodes_Private(const EvaluateContext *ctx, PetscInt facet)
{
  const ContactMultiplier *multiplier = ctx->pair->multiplier;
  RayWork                  w          = ctx->pair->ray;
  const PetscInt           na = w->facet.s.num, nv = w->facet.nv, first = multiplier->row_first[facet];
  FacetLattice             lattice;
  PetscInt                 num = 0, place;

  PetscFunctionBegin;
  w->result.num_nodes = 0;
  w->result.num_rows  = multiplier->row_first[facet + 1] - first;
  for (PetscInt r = 0; r < w->result.num_rows; r++) PetscCall(ContactResultNode(&w->result, multiplier->row_node[first + r], &place));
  ContactFacetLattice(ctx->nonmortar, facet, &lattice);
  PetscCall(ArrayGrow(na + w->num_mortar + 1, sizeof(PetscInt), &w->result.size_row_first, &w->result.row_first));
  for (PetscInt a = 0; a < na; a++) PetscCall(ContactResultRow(&w->result, ctx->nonmortar, lattice.node[a], PETSC_FALSE, a, &num));
  for (PetscInt v = 0; v < nv; v++) PetscCall(ContactDirectionNodes(w, ctx->nonmortar, nv * facet + v, &w->result));
  for (PetscInt r = 0; r < w->result.num_rows && ctx->pair->traction && w->facet.m == 2; r++)
    PetscCall(ContactFrameNodes(w, ctx->nonmortar, w->result.node[r], &w->result));
  for (PetscInt j = 0; j < w->num_mortar; j++) PetscCall(ContactResultRow(&w->result, ctx->mortar, w->vertex[j], PETSC_TRUE, na + j, &num));
  w->nn = w->facet.D * w->result.num_nodes;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- results ------------------------------------------------------------------------------------------------------------------------- */

/* psi_r = sum_a T[r][a] N_a and its derivative by the covered share, T[num_rows + r][a] (blend.c). */
static PetscErrorCode Functions_Private(RayWork w, const ContactMultiplier *multiplier, PetscInt facet, PetscReal share)
{
  const PetscInt   num  = w->result.num_rows * w->facet.s.num;
  const PetscReal *dual = multiplier->T + multiplier->offset[facet], *bernstein = multiplier->B + multiplier->offset[facet];

  PetscFunctionBegin;
  PetscCall(ArrayGrow(2 * num, sizeof(PetscReal), &w->size_T, &w->T));
  ContactShareOf(w->facet.m, w->facet.s.order, share, w->across, &w->share);
  for (PetscInt i = 0; i < num; i++) {
    w->T[i]       = w->share.part ? w->share.theta[0] * dual[i] + (1 - w->share.theta[0]) * bernstein[i] : dual[i];
    w->T[num + i] = w->share.part ? w->share.theta[1] * (dual[i] - bernstein[i]) : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* to[num_rows][nn] = derivatives of sum_a T[r][a] q[from + a]; held (unless NULL): the same with the images held. */
static PetscErrorCode Rows_Private(ContactPair pair, PetscInt from, PetscReal to[], PetscReal held[])
{
  RayWork          w  = pair->ray;
  const PetscInt   na = w->facet.s.num, n = w->n, nr = w->result.num_rows;
  const PetscReal *q = w->q + from, *dq = w->dq + from * n, *dshare = w->dq + 2 * na * n;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(n * nr, sizeof(PetscReal), &w->size_rows, &w->rows));
  PetscCall(PetscArrayzero(w->rows, n * nr));
  for (PetscInt r = 0; r < nr; r++) {
    PetscReal slope = 0;

    for (PetscInt a = 0; a < na; a++) {
      const PetscReal t = w->T[r * na + a];

      slope += w->T[(nr + r) * na + a] * q[a];
      if (t == 0) continue;
      for (PetscInt i = 0; i < n; i++) w->rows[i * nr + r] += t * dq[a * n + i];
    }
    for (PetscInt i = 0; i < n && slope != 0; i++) w->rows[i * nr + r] += slope * dshare[i];
  }
  if (held) ContactRayChainNodes(w, nr, w->rows, held);
  if (!pair->held) ContactRayChainImages(w, nr, w->rows);
  ContactRayChainNodes(w, nr, w->rows, to);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of sum_r z_r gt_r + z.S z / 2, y = T^T z. The share's terms: half of y'.(dG ds + ds dG) + (y''.G + kappa'' Q / 2) ds ds + (y'.G + kappa' Q / 2) d2s,
   Q = z.(S / kappa) z. */
static PetscErrorCode Hessian_Private(const EvaluateContext *ctx, PetscInt facet, const PetscReal y[], const PetscReal y1[], PetscReal Q, PetscReal H[])
{
  RayWork        w = ctx->pair->ray;
  const PetscInt n = w->n, na = w->facet.s.num;
  PetscReal     *gradient, *left, slope = 0.5 * w->share.kappa[1] * Q, curve = 0.25 * w->share.kappa[2] * Q;

  PetscFunctionBegin;
  PetscCall(ArrayGrow(2 * n, sizeof(PetscReal), &w->size_rows, &w->rows));
  PetscCall(PetscArrayzero(w->rows, 2 * n));
  gradient = w->rows, left = gradient + n;
  for (PetscInt a = 0; a < na && w->share.part; a++) slope += y1[a] * w->q[a];
  PetscCall(ContactRayHessian(ctx->pair, ctx->mortar, y, slope, gradient));
  if (w->share.part) {
    const PetscReal *dshare = w->dq + 2 * na * n, bend = w->share.theta[1] != 0 ? w->share.theta[2] / w->share.theta[1] : 0;

    for (PetscInt a = 0; a < na; a++) {
      for (PetscInt i = 0; i < n; i++) left[i] += y1[a] * w->dq[a * n + i];
      curve += 0.5 * bend * y1[a] * w->q[a];
    }
    for (PetscInt i = 0; i < n; i++) left[i] += curve * dshare[i];
    ContactRayProducts(1, 1, n, left, n, n, dshare, n, w->W, n);
  }
  PetscCall(ContactRayChainHessian(w, H));
  ContactRayChainImages(w, 1, gradient);
  PetscCall(ContactRayDirectionCurvature(w, ctx->nonmortar, facet, gradient, H));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactPairSetClosed(ContactPair pair, const PetscReal closed[])
{
  pair->closed       = closed;
  pair->state.stands = PETSC_FALSE;
}

void ContactPairSetShared(ContactPair pair, const PetscBool shared[], PetscBool parted)
{
  pair->shared = shared;
  pair->parted = parted;
}

/* Has the surface several directions at one of the facet's corners? */
static PetscBool HasSharpCorner_Private(RayWork w, const ContactSurface *s, PetscInt facet)
{
  const PetscInt nv = 2 * (s->dim - 1);

  for (PetscInt k = 0; k < nv; k++) {
    const PetscInt node = s->facets[nv * facet + k];

    for (PetscInt i = w->ring_first[node]; i < w->ring_first[node + 1]; i++)
      if (w->sheet[w->ring[i]] != w->sheet[nv * facet + k]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Has the facet whose rows are at hand nodes that other pairs constrain, too, or in their slip other parts of this pair? (Which of the faces round an edge a
   node meets, changes: pressures that were to be alike on the facet would be spread to where nothing touches, and sets go in circles.) */
static PetscBool IsShared_Private(ContactPair pair, const ContactSurface *s, PetscInt facet)
{
  RayWork w = pair->ray;

  for (PetscInt r = 0; r < w->result.num_rows && pair->shared; r++)
    if (pair->shared[w->result.node[r]]) return PETSC_TRUE;
  return (PetscBool)(pair->parted && pair->keeps && HasSharpCorner_Private(w, s, facet));
}

/* Compliance of a facet that is covered in part, has nodes that are shared, or is stabilised. */
static PetscErrorCode Compliance_Private(ContactPair pair, const ContactSurface *s, PetscInt facet, ContactFacet *out)
{
  RayWork                  w          = pair->ray;
  const ContactMultiplier *multiplier = pair->multiplier;
  const PetscInt           first = multiplier->row_first[facet], nr = w->result.num_rows;
  const PetscBool          shared     = IsShared_Private(pair, s, facet);
  const PetscReal          stabilised = pair->stabilisation ? pair->stabilisation[facet] : 0;
  PetscReal                sum = 0, softness = 0, *m;

  PetscFunctionBegin;
  out->compliance     = NULL;
  out->compliance_sum = 0;
  if (!(w->share.part || shared || stabilised > 0) || !pair->softness || nr == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactStoreReserve(&w->result.store, nr, &m));
  for (PetscInt r = 0; r < nr; r++) {
    sum += multiplier->measure[first + r];
    softness += multiplier->measure[first + r] * pair->softness[w->result.node[r]];
  }
  for (PetscInt r = 0; r < nr; r++) m[r] = multiplier->measure[first + r] * softness / sum;
  if (shared) w->share.kappa[0] = ContactShareMost(w->facet.s.order), w->share.kappa[1] = w->share.kappa[2] = 0;
  w->share.kappa[0] += stabilised;
  out->num_rows   = nr;
  out->compliance = m;
  for (int i = 0; i < 2; i++) out->kappa[i] = w->share.kappa[i];
  for (PetscInt r = 0; r < nr; r++) out->compliance_sum += m[r];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dshare[nn]: derivatives of the covered share. */
static PetscErrorCode Share_Private(ContactPair pair, PetscReal to[])
{
  RayWork w = pair->ray;

  PetscFunctionBegin;
  if (pair->held) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayGrow(w->n, sizeof(PetscReal), &w->size_rows, &w->rows));
  PetscCall(PetscArraycpy(w->rows, w->dq + 2 * w->facet.s.num * w->n, w->n));
  ContactRayChainImages(w, 1, w->rows);
  ContactRayChainNodes(w, 1, w->rows, to);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the functions make of the moments. */
static PetscErrorCode Values_Private(RayWork w, ContactFacet *out)
{
  const PetscInt na = w->facet.s.num, nr = w->result.num_rows;
  PetscReal     *gap, *weight, *length;

  PetscFunctionBegin;
  PetscCall(ContactStoreReserve(&w->result.store, 3 * nr, &gap));
  weight = gap + nr, length = weight + nr;
  for (PetscInt r = 0; r < nr; r++)
    for (PetscInt a = 0; a < na; a++) {
      gap[r] += w->T[r * na + a] * w->q[a];
      weight[r] += w->T[r * na + a] * w->q[na + a];
      length[r] += w->T[r * na + a] * w->length[a];
    }
  out->gap     = gap;
  out->weight  = weight;
  out->length  = length;
  out->reach   = w->facet.s.order == 1 ? length : weight;
  out->area    = w->covered;
  out->min_gap = w->min_gap;
  out->ends    = w->ends;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Derivatives_Private(const EvaluateContext *ctx, PetscInt facet, ContactFacet *out)
{
  RayWork        w  = ctx->pair->ray;
  const PetscInt nr = w->result.num_rows, nn = w->nn;
  PetscReal     *dgap, *dshare, *push = NULL;

  PetscFunctionBegin;
  PetscCall(ContactRayChain(w, ctx->nonmortar, facet, ctx->pair->held));
  PetscCall(ContactStoreReserve(&w->result.store, 2 * nr * nn, &dgap));
  out->dgap    = dgap;
  out->dweight = dgap + nr * nn;
  if (w->frozen) PetscCall(ContactStoreReserve(&w->result.store, nr * nn, &push));
  out->push = push;
  PetscCall(Rows_Private(ctx->pair, 0, dgap, push));
  PetscCall(Rows_Private(ctx->pair, w->facet.s.num, dgap + nr * nn, NULL));
  if (!w->share.part) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactStoreReserve(&w->result.store, nn, &dshare));
  PetscCall(Share_Private(ctx->pair, dshare));
  out->dshare = dshare;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Needs derivatives, or those of a facet that is covered from the last evaluation. */
static PetscErrorCode Curve_Private(const EvaluateContext *ctx, PetscInt facet, ContactFacet *out)
{
  RayWork        w  = ctx->pair->ray;
  const PetscInt na = w->facet.s.num, nr = w->result.num_rows;
  PetscReal      y[RAY_LATTICE] = {0}, y1[RAY_LATTICE] = {0}, Q = 0;

  PetscFunctionBegin;
  for (PetscInt r = 0; r < nr; r++)
    for (PetscInt a = 0; a < na; a++) {
      y[a] += ctx->z[w->result.node[r]] * w->T[r * na + a];
      y1[a] += ctx->z[w->result.node[r]] * w->T[(nr + r) * na + a];
    }
  if (out->compliance) Q = ContactFacetYield(out, w->result.node, ctx->z);
  PetscCall(ContactStoreReserve(&w->result.store, w->nn * w->nn, (PetscReal **)&out->hessian));
  PetscCall(Hessian_Private(ctx, facet, y, y1, Q, (PetscReal *)out->hessian));
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
    s->dual = w->share.theta[0];
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
  PetscInt       first, overlaps;
  PetscBool      derivatives, loaded = PETSC_FALSE;

  PetscFunctionBegin;
  PetscCall(ContactCover(pair, ctx->nonmortar, ctx->mortar, slot, failed));
  if (*failed || w->num_overlaps == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Nodes_Private(ctx, facet));
  for (PetscInt r = 0; r < w->result.num_rows && ctx->z; r++) loaded = (PetscBool)(loaded || ctx->z[w->result.node[r]] != 0);
  loaded      = (PetscBool)(loaded || ContactSlipLoads(ctx));
  derivatives = ContactResultDerivatives(ctx, w->result.num_rows, w->result.node, loaded);
  if (ctx->again && !pair->held && out->dgap && !out->dshare && w->first_place[slot] >= 0) { /* nothing else is missing */
    w->places = w->place + w->first_place[slot];
    PetscCall(Functions_Private(w, pair->multiplier, facet, 1));
    PetscCall(ContactRayChain(w, ctx->nonmortar, facet, PETSC_FALSE));
    PetscCall(Curve_Private(ctx, facet, out));
    *use = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  first = w->num_places, overlaps = w->num_overlaps;
  PetscCall(ContactRayMoments(pair, ctx->mortar, derivatives));
  w->first_place[slot] = w->num_overlaps == overlaps ? first : -1;
  w->places            = w->place + first;
  if (w->num_overlaps == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Functions_Private(w, pair->multiplier, facet, w->q[2 * w->facet.s.num]));
  if (!ctx->again) PetscCall(Segments_Private(ctx, facet));
  PetscCall(Values_Private(w, out));
  PetscCall(Compliance_Private(pair, ctx->nonmortar, facet, out));
  out->dgap = out->dweight = out->dshare = out->push = out->hessian = NULL;
  if (derivatives) PetscCall(Derivatives_Private(ctx, facet, out));
  if (derivatives && ctx->hessian && loaded && !pair->held) PetscCall(Curve_Private(ctx, facet, out));
  PetscCall(ContactSlipFacet(ctx, facet, derivatives, out));
  PetscCall(ContactTieFacet(ctx, facet, out));
  *use = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactRayEvaluate(const EvaluateContext *ctx, PetscBool *failed)
{
  RayWork w = ctx->pair->ray;

  PetscFunctionBegin;
  if (!ctx->again) {
    ContactDirectionImages(w, ctx->nonmortar, ctx->pair->friction);
    ContactDirections(w, ctx->nonmortar);
    Normals_Private(ctx->pair, ctx->nonmortar);
    if (ctx->pair->dim == 3 && (ctx->pair->traction || ctx->pair->keeps)) PetscCall(ContactFrames(ctx->pair, ctx->nonmortar));
    if (ctx->pair->start[ctx->pair->num_listed]) PetscCall(ContactRayBalls(w, ctx->mortar));
    w->num_places = 0;
    PetscCall(ArrayGrow(ctx->pair->num_listed, sizeof(PetscInt), &w->size_first_place, &w->first_place));
  }
  PetscCall(ContactResultsEvaluate(ctx, &w->result, Facet_Private, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
