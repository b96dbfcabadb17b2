/* One nonmortar facet in three dimensions: gathers its overlaps, integrates, and hands out weighted gaps with their derivatives by the nodes that do not hang.
 */
#include "facetimpl.h"

PetscErrorCode ContactFacetWorkDestroy(FacetWork *work)
{
  FacetWork w = *work;

  PetscFunctionBegin;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactResultDestroy(&w->result));
  PetscCall(PetscFree(w->overlap));
  PetscCall(PetscFree(w->mortar));
  PetscCall(PetscFree(w->corner));
  PetscCall(PetscFree(w->vertex));
  PetscCall(PetscFree(w->X));
  PetscCall(PetscFree(w->dq));
  PetscCall(PetscFree(w->W));
  PetscCall(PetscFree(w->row));
  PetscCall(PetscFree(*work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactFacetTopology(ContactPair pair, const ContactSurface *s)
{
  PetscFunctionBegin;
  if (!pair->facet) PetscCall(PetscNew(&pair->facet));
  PetscCall(PetscFree(pair->normal));
  pair->num_nodes  = s->num_nodes;
  pair->num_facets = s->num_facets;
  PetscCall(PetscCalloc1(3 * s->num_nodes, &pair->normal));
  for (PetscInt i = 0; i < 4 * s->num_facets; i++)
    PetscCheck(s->facets[i] >= 0 && s->facets[i] < s->num_nodes, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
               "nonmortar facet %" PetscInt_FMT " has node %" PetscInt_FMT ", must lie in [0, %" PetscInt_FMT ")", i / 4, s->facets[i], s->num_nodes);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool HasFacet_Private(const ContactSurface *s, const PetscInt node[4])
{
  return (PetscBool)(ContactHas(s, node[0]) && ContactHas(s, node[1]) && ContactHas(s, node[2]) && ContactHas(s, node[3]));
}

/* Mean unit normals at the nodes, for output and estimation; the gap does not use them. */
static void Normals_Private(ContactPair pair, const ContactSurface *s)
{
  for (PetscInt i = 0; i < 3 * s->num_nodes; i++) pair->normal[i] = 0;
  for (PetscInt f = 0; f < s->num_facets; f++) {
    const PetscInt *node = s->facets + 4 * f;
    PetscReal       N[3], length;

    for (int i = 0; i < 3; i++) N[i] = NAN;
    if (HasFacet_Private(s, node)) ContactFacetVector(3, s->x, node, N);
    length = PetscSqrtReal(Dot3(N, N));
    for (int a = 0; a < 4 && length != 0; a++)
      for (int i = 0; i < 3; i++) pair->normal[3 * node[a] + i] += N[i] / length;
  }
  for (PetscInt n = 0; n < s->num_nodes; n++) {
    PetscReal *m = pair->normal + 3 * n, length = PetscSqrtReal(Dot3(m, m));

    for (int i = 0; i < 3 && length > 0; i++) m[i] /= length;
  }
}

/* ---- gathering ---------------------------------------------------------------------------------------------------------------------- */

/* Place of a mortar node among the vertices; added when new. */
static PetscErrorCode Vertex_Private(FacetWork w, const ContactSurface *mortar, PetscInt node, PetscInt *place)
{
  PetscFunctionBegin;
  for (*place = 4; *place < w->num_vertices; (*place)++)
    if (w->vertex[*place] == node) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactGrow(w->num_vertices + 1, sizeof(PetscInt), &w->size_vertex, &w->vertex));
  PetscCall(ContactGrow(3 * (w->num_vertices + 1), sizeof(PetscReal), &w->size_X, &w->X));
  w->vertex[w->num_vertices] = node;
  ContactFacetLocal(&w->frame, mortar->x + 3 * node, w->X + 3 * w->num_vertices);
  w->num_vertices++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The mortar facet in the nonmortar facet's axes, its nodes backwards. */
static void PlaneOf_Private(const FacetWork w, const ContactSurface *mortar, PetscInt facet, PlaneQuad *s)
{
  for (int a = 0; a < 4; a++) {
    PetscReal X[3];

    ContactFacetLocal(&w->frame, mortar->x + 3 * mortar->facets[4 * facet + 3 - a], X);
    s->Y[a][0] = X[0], s->Y[a][1] = X[1], s->h[a] = X[2];
  }
}

static PetscErrorCode Gather_Private(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar, PetscInt slot, FacetWork w,
                                     PetscBool *failed)
{
  const PetscInt *node = nonmortar->facets + 4 * pair->listed[slot];
  PetscReal       x[4][3];
  PlaneQuad       own;

  PetscFunctionBegin;
  w->num_overlaps = 0;
  w->num_vertices = 4;
  for (int a = 0; a < 4; a++)
    for (int i = 0; i < 3; i++) x[a][i] = nonmortar->x[3 * node[a] + i];
  if (pair->start[slot] == pair->start[slot + 1]) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ContactFacetFrame(x, &w->frame)) {
    *failed = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ContactGrow(4, sizeof(PetscInt), &w->size_vertex, &w->vertex));
  PetscCall(ContactGrow(12, sizeof(PetscReal), &w->size_X, &w->X));
  for (int a = 0; a < 4; a++) {
    w->vertex[a] = node[a];
    for (int i = 0; i < 3; i++) w->X[3 * a + i] = w->frame.X[a][i];
    own.Y[a][0] = w->frame.X[a][0], own.Y[a][1] = w->frame.X[a][1], own.h[a] = w->frame.X[a][2];
  }
  for (PetscInt k = pair->start[slot]; k < pair->start[slot + 1]; k++) {
    Overlap o;

    o.side[0] = own;
    PlaneOf_Private(w, mortar, pair->candidate[k], &o.side[1]);
    if (!ContactQuadIsConvex(&o.side[1])) {
      pair->num_degenerate++;
      continue;
    }
    if (!ContactClip(&o, PetscSqrtReal(w->frame.area))) continue;
    PetscCall(ContactGrow(w->num_overlaps + 1, sizeof(Overlap), &w->size_overlap, &w->overlap));
    PetscCall(ContactGrow(w->num_overlaps + 1, sizeof(PetscInt), &w->size_mortar, &w->mortar));
    w->overlap[w->num_overlaps]  = o;
    w->mortar[w->num_overlaps++] = pair->candidate[k];
  }
  ContactUnfold(&w->num_overlaps, w->overlap, w->mortar, w->frame.area);
  PetscCall(ContactGrow(4 * w->num_overlaps, sizeof(PetscInt), &w->size_corner, &w->corner));
  for (PetscInt k = 0; k < w->num_overlaps; k++)
    for (int a = 0; a < 4; a++) PetscCall(Vertex_Private(w, mortar, mortar->facets[4 * w->mortar[k] + 3 - a], &w->corner[4 * k + a]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where number i (0..23) of an overlap stands among the facet's. */
static inline PetscInt Place_Private(const FacetWork w, PetscInt overlap, PetscInt i)
{
  return i < 12 ? i : 3 * w->corner[4 * overlap + (i - 12) / 3] + i % 3;
}

/* ---- integration -------------------------------------------------------------------------------------------------------------------- */

/* Moments of all overlaps; derivatives by U into dq[FACET_MOMENTS][n]. Overlaps that cannot be projected are dropped and counted. */
static PetscErrorCode Moments_Private(ContactPair pair, FacetWork w, PetscBool derivatives)
{
  const PetscInt n = 3 * w->num_vertices;
  PetscReal      dq[FACET_MOMENTS][FACET_LOCAL];
  PetscInt       kept = 0;

  PetscFunctionBegin;
  memset(&w->moments, 0, sizeof(w->moments));
  w->moments.min_gap = PETSC_MAX_REAL;
  w->covered         = 0;
  if (derivatives) {
    PetscCall(ContactGrow(FACET_MOMENTS * n, sizeof(PetscReal), &w->size_dq, &w->dq));
    PetscCall(PetscArrayzero(w->dq, FACET_MOMENTS * n));
  }
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    const FacetMoments before = w->moments;

    if (!ContactOverlapMoments(&w->overlap[k], &w->moments, derivatives ? dq : NULL)) {
      w->moments = before;
      pair->num_degenerate++;
      continue;
    }
    w->covered += w->overlap[k].area;
    if (kept != k) {
      w->overlap[kept] = w->overlap[k];
      w->mortar[kept]  = w->mortar[k];
      for (int a = 0; a < 4; a++) w->corner[4 * kept + a] = w->corner[4 * k + a];
    }
    for (int q = 0; derivatives && q < FACET_MOMENTS; q++)
      for (PetscInt i = 0; i < FACET_LOCAL; i++) w->dq[q * n + Place_Private(w, kept, i)] += dq[q][i];
    kept++;
  }
  w->num_overlaps = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* row = sum_q factor_q dq, by U; with the tilt: by X. */
static void Combine_Private(const FacetWork w, const PetscReal factor[FACET_MOMENTS], PetscReal row[])
{
  const PetscInt n = 3 * w->num_vertices;

  for (PetscInt i = 0; i < n; i++) row[i] = 0;
  for (int q = 0; q < FACET_MOMENTS; q++) {
    if (factor[q] == 0) continue;
    for (PetscInt i = 0; i < n; i++) row[i] += factor[q] * w->dq[q * n + i];
  }
}

/* Adds sum_j y_j w_j to what the Hessian is of, but for the tilt: the hats sum up to 1, so int N_j = sum_k int N_j N_k. */
static void AddWeights_Private(const PetscReal y[4], FacetWeights *f)
{
  for (int j = 0; j < 4; j++)
    for (int k = 0; k < 4; k++) f->D[j][k] += 0.5 * (y[j] + y[k]);
}

/* Second derivative of the tilt's factor in weights, (1 + |s|^2)^-1/2. */
static void TiltWeights_Private(FacetWork w, const PetscReal y[4])
{
  const PetscInt n   = 3 * w->num_vertices;
  PetscReal      sum = 0;

  for (int j = 0; j < 4; j++) sum += y[j] * w->moments.q[4 + j];
  for (int i = 0; i < 2 && sum != 0; i++)
    for (int a = 0; a < 12; a++)
      for (int b = 0; b < 12; b++) w->W[a * n + b] -= 0.5 * sum * w->frame.sigma[i][a] * w->frame.sigma[i][b];
}

/* W: half Hessian by X of sum_j z_j gt_j + y_j w_j over the facet's vertices, the latter part of f already. */
static PetscErrorCode HalfHessian_Private(FacetWork w, const FacetWeights *f, const PetscReal z[4], const PetscReal y[4])
{
  const PetscInt n = 3 * w->num_vertices;
  PetscReal      part[FACET_LOCAL][FACET_LOCAL], factor[FACET_MOMENTS] = {0}, *left = w->row, *right = w->row + n;

  PetscFunctionBegin;
  PetscCall(ContactGrow(n * n, sizeof(PetscReal), &w->size_W, &w->W));
  PetscCall(PetscArrayzero(w->W, n * n));
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    if (!ContactOverlapHessian(&w->overlap[k], f->g, f->D, part)) continue; /* cannot happen: its moments were found */
    for (PetscInt a = 0; a < FACET_LOCAL; a++) {
      PetscReal *to = w->W + n * Place_Private(w, k, a);

      for (PetscInt b = 0; b < 12; b++) to[b] += part[a][b];
      for (PetscInt c = 0; c < 4; c++)
        for (PetscInt i = 0; i < 3; i++) to[3 * w->corner[4 * k + c] + i] += part[a][12 + 3 * c + i];
    }
  }
  for (int p = 0; p < f->num_pairs; p++) {
    Combine_Private(w, f->left[p], left);
    Combine_Private(w, f->right[p], right);
    for (PetscInt a = 0; a < n; a++)
      for (PetscInt b = 0; b < n; b++) w->W[a * n + b] += left[a] * right[b];
  }
  for (int j = 0; j < 4; j++)
    for (int q = 0; q < FACET_MOMENTS; q++) factor[q] += z[j] * f->dgap[j][q] + (q == 4 + j ? y[j] : 0);
  Combine_Private(w, factor, left);
  ContactTiltHessian(&w->frame, n, w->X, left, w->W, right);
  TiltWeights_Private(w, y);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---- results for the nodes that do not hang ------------------------------------------------------------------------------------------ */

/* Masters of every vertex: rows of (place among the result's nodes, weight). */
static PetscErrorCode Masters_Private(FacetWork w, const ContactSurface *nonmortar, const ContactSurface *mortar)
{
  PetscInt num = 0;

  PetscFunctionBegin;
  w->result.num_nodes = w->result.num_rows = 0;
  PetscCall(ContactGrow(w->num_vertices + 1, sizeof(PetscInt), &w->result.size_row_first, &w->result.row_first));
  for (PetscInt v = 0; v < w->num_vertices; v++) {
    PetscCall(ContactResultRow(&w->result, v < 4 ? nonmortar : mortar, w->vertex[v], (PetscBool)(v >= 4), v, &num));
    if (v == 3) w->result.num_rows = w->result.num_nodes;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* to[3 * num_nodes] += the row by X, turned to the axes of space and carried to the masters. */
static void Carry_Private(const FacetWork w, const PetscReal row[], PetscReal to[])
{
  for (PetscInt v = 0; v < w->num_vertices; v++)
    for (int c = 0; c < 3; c++) {
      const PetscReal value = w->frame.E[0][c] * row[3 * v] + w->frame.E[1][c] * row[3 * v + 1] + w->frame.E[2][c] * row[3 * v + 2];

      for (PetscInt k = w->result.row_first[v]; k < w->result.row_first[v + 1]; k++) to[3 * w->result.row_node[k] + c] += w->result.row_weight[k] * value;
    }
}

/* Gradient of number j's gt (or w): to the rows of its masters. */
static void Distribute_Private(FacetWork w, int j, const PetscReal factor[FACET_MOMENTS], PetscReal out[])
{
  const PetscInt n = 3 * w->num_vertices, nn = 3 * w->result.num_nodes;
  PetscReal     *row = w->row, *carried = w->row + n;

  Combine_Private(w, factor, row);
  ContactTiltGradient(&w->frame, n, w->X, row);
  for (PetscInt i = 0; i < nn; i++) carried[i] = 0;
  Carry_Private(w, row, carried);
  for (PetscInt k = w->result.row_first[j]; k < w->result.row_first[j + 1]; k++)
    for (PetscInt i = 0; i < nn; i++) out[w->result.row_node[k] * nn + i] += w->result.row_weight[k] * carried[i];
}

/* H[3 * num_nodes][..] += P^T E^T (W + W^T) E P, rows first, then columns; half[3 * num_nodes][n] is work. */
static void CarryHessian_Private(const FacetWork w, PetscReal half[], PetscReal H[])
{
  const PetscInt n = 3 * w->num_vertices, nn = 3 * w->result.num_nodes;

  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j <= i; j++) w->W[i * n + j] = w->W[j * n + i] = w->W[i * n + j] + w->W[j * n + i];
  for (PetscInt v = 0; v < w->num_vertices; v++)
    for (PetscInt k = w->result.row_first[v]; k < w->result.row_first[v + 1]; k++)
      for (int c = 0; c < 3; c++) {
        PetscReal *to = half + (3 * w->result.row_node[k] + c) * n;

        for (int i = 0; i < 3; i++) {
          const PetscReal factor = w->result.row_weight[k] * w->frame.E[i][c], *from = w->W + (3 * v + i) * n;

          for (PetscInt j = 0; j < n; j++) to[j] += factor * from[j];
        }
      }
  for (PetscInt i = 0; i < nn; i++) Carry_Private(w, half + i * n, H + i * nn);
}

/* Hessian of sum_j z_j gt_j + K_j z_j^2 / 2; K: as sliver.c gives it, or NULL. */
static PetscErrorCode Hessian_Private(FacetWork w, FacetWeights *f, const PetscReal z[4], const PetscReal all_z[], const PetscReal K[], ContactFacet *out)
{
  const PetscInt n = 3 * w->num_vertices, nn = 3 * w->result.num_nodes, nr = w->result.num_rows;
  PetscReal      y[4] = {0, 0, 0, 0}, *half, *H;

  PetscFunctionBegin;
  for (int j = 0; j < 4 && K; j++)
    for (PetscInt k = w->result.row_first[j]; k < w->result.row_first[j + 1]; k++) {
      const PetscInt row = w->result.row_node[k];

      y[j] += 0.5 * w->result.row_weight[k] * K[nr + row] * PetscSqr(all_z[w->result.node[row]]);
    }
  if (K) AddWeights_Private(y, f);
  PetscCall(HalfHessian_Private(w, f, z, y));
  PetscCall(ContactStoreReserve(&w->result.store, nn * nn, &H));
  PetscCall(ContactStoreReserve(&w->result.store, nn * n, &half));
  CarryHessian_Private(w, half, H);
  w->result.store.used -= nn * n; /* only work */
  for (PetscInt row = 0; row < nr && K; row++) {
    const PetscReal bend = 0.5 * K[2 * nr + row] * PetscSqr(all_z[w->result.node[row]]), *dweight = out->dweight + row * nn;

    for (PetscInt a = 0; a < nn && bend != 0; a++)
      for (PetscInt b = 0; b < nn; b++) H[a * nn + b] += bend * dweight[a] * dweight[b];
  }
  out->hessian = H;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Weighted gaps, weights and what derivatives are asked for. */
static PetscErrorCode Result_Private(const EvaluateContext *ctx, PetscInt facet, FacetWeights *f, const PetscReal z[4], PetscBool derivatives,
                                     PetscBool hessian, ContactFacet *out)
{
  FacetWork      w = ctx->pair->facet;
  const PetscInt n = 3 * w->num_vertices, nn = 3 * w->result.num_nodes, nr = w->result.num_rows;
  PetscReal      factor[FACET_MOMENTS], *gap, *weight, *dgap, *dweight;

  PetscFunctionBegin;
  PetscCall(ContactStoreReserve(&w->result.store, 2 * nr, &gap));
  weight = gap + nr;
  for (int j = 0; j < 4; j++)
    for (PetscInt k = w->result.row_first[j]; k < w->result.row_first[j + 1]; k++) {
      gap[w->result.row_node[k]] += w->result.row_weight[k] * f->gap[j];
      weight[w->result.row_node[k]] += w->result.row_weight[k] * f->weight[j];
    }
  out->gap     = gap;
  out->weight  = weight;
  out->area    = w->covered;
  out->min_gap = w->moments.min_gap;
  out->dgap = out->dweight = out->push = out->hessian = out->reach = out->darea = NULL;
  PetscCall(ContactSliver(ctx->pair, ctx->nonmortar, facet, &w->result, weight, &out->spring));
  out->stiffening = out->spring ? out->spring + nr : NULL;
  if (!derivatives) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactGrow(3 * n + nn, sizeof(PetscReal), &w->size_row, &w->row));
  PetscCall(ContactStoreReserve(&w->result.store, 2 * nr * nn, &dgap));
  dweight = dgap + nr * nn;
  for (int j = 0; j < 4; j++) {
    Distribute_Private(w, j, f->dgap[j], dgap);
    for (int q = 0; q < FACET_MOMENTS; q++) factor[q] = q == 4 + j;
    Distribute_Private(w, j, factor, dweight);
  }
  out->dgap    = dgap;
  out->dweight = dweight;
  if (hessian) PetscCall(Hessian_Private(w, f, z, ctx->z, out->spring, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corners of the overlaps on both facets. The mortar facet's list is backwards, 3 2 1 0: (xi_1, xi_2) there is (xi_1, -xi_2) of its own. */
static PetscErrorCode Segments_Private(ContactPair pair, PetscInt slot, const FacetWork w)
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < w->num_overlaps; k++) {
    const Overlap  *o = &w->overlap[k];
    ContactSegment *s;

    PetscCall(ContactResultSegment(pair, pair->listed[slot], w->mortar[k], o->num, &s));
    for (PetscInt v = 0; v < o->num; v++) {
      PlanePoint p[2];

      for (int i = 0; i < 2; i++)
        if (!ContactQuadLocate(&o->side[i], o->v[v], &p[i])) p[i].xi[0] = p[i].xi[1] = 0; /* cannot happen: the overlap was integrated */
      s->xi[v][0] = p[0].xi[0], s->xi[v][1] = p[0].xi[1];
      s->eta[v][0] = p[1].xi[0], s->eta[v][1] = -p[1].xi[1];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void LocalMultipliers_Private(const EvaluateContext *ctx, const FacetWork w, PetscReal z[4])
{
  for (int j = 0; j < 4; j++) {
    z[j] = 0;
    for (PetscInt k = w->result.row_first[j]; ctx->z && k < w->result.row_first[j + 1]; k++)
      z[j] += w->result.row_weight[k] * ctx->z[w->result.node[w->result.row_node[k]]];
  }
}

/* One listed facet; *use stays false when nothing covers it. */
static PetscErrorCode Facet_Private(const EvaluateContext *ctx, PetscInt slot, ContactFacet *out, PetscBool *use, PetscBool *failed)
{
  ContactPair  pair = ctx->pair;
  FacetWork    w    = pair->facet;
  FacetWeights f;
  PetscReal    z[4];
  PetscBool    loaded, derivatives;

  PetscFunctionBegin;
  PetscCall(Gather_Private(pair, ctx->nonmortar, ctx->mortar, slot, w, failed));
  if (*failed || w->num_overlaps == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Masters_Private(w, ctx->nonmortar, ctx->mortar));
  LocalMultipliers_Private(ctx, w, z);
  loaded      = (PetscBool)(z[0] != 0 || z[1] != 0 || z[2] != 0 || z[3] != 0);
  derivatives = ContactResultDerivatives(ctx, w->result.num_rows, w->result.node, loaded);
  PetscCall(Moments_Private(pair, w, derivatives));
  if (w->num_overlaps == 0 || !ContactFacetWeights(pair->standard, w->moments.q, z, &f)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ctx->again) PetscCall(Segments_Private(pair, slot, w));
  PetscCall(Result_Private(ctx, pair->listed[slot], &f, z, derivatives, (PetscBool)(ctx->hessian && loaded && !pair->held), out));
  *use = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactFacetsEvaluate(const EvaluateContext *ctx, PetscBool *failed)
{
  PetscFunctionBegin;
  if (!ctx->again) Normals_Private(ctx->pair, ctx->nonmortar);
  PetscCall(ContactResultsEvaluate(ctx, &ctx->pair->facet->result, Facet_Private, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}
