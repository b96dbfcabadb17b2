/* Node-to-segment contact, for comparison only: at every nonmortar node the gap g_j along the nodal normal to the mortar edge that its ray hits, weighted
   with half of each adjacent edge's current length (axisymmetric: times 2 pi r_j): contribution of one edge gt_j = rho_j L / 2 g_j, w_j = rho_j L / 2.
   Same variables and same exact derivatives as the mortar form: a "segment" is one point, lambda = 0 or 1, which does not move. */
#include "contactimpl.h"

/* The candidate whose edge node k's ray hits, least |g| first, lowest number among equals; -1: none. Both edges at a node decide alike. */
static PetscInt Hit_Private(ContactPair pair, PetscInt slot, const EdgeFrame *f, const ContactSurface *mortar, int k)
{
  PetscInt  best  = -1;
  PetscReal least = PETSC_MAX_REAL;

  for (PetscInt i = pair->start[slot]; i < pair->start[slot + 1]; i++) {
    const PetscInt  *node = &mortar->facets[2 * pair->candidate[i]];
    const PetscReal *c = &mortar->x[2 * node[0]], *d = &mortar->x[2 * node[1]];
    const PetscReal  fc = ContactRaySide(f->x[k], f->n[k], c), fd = ContactRaySide(f->x[k], f->n[k], d);
    PetscReal        cosine, tau, g;

    if (!(fd <= 0 && fc >= 0 && fd < fc)) continue;
    g = PetscAbsReal(ContactGapAt(f, c, d, k, &cosine, &tau));
    if (cosine < -CONTACT_GRAZE && g < least) best = pair->candidate[i], least = g;
  }
  return best;
}

PetscErrorCode ContactNodeHitsBuild(ContactPair pair, const ContactSurface *nonmortar, const ContactSurface *mortar)
{
  EdgeFrame f;

  PetscFunctionBegin;
  pair->num_segments = pair->num_local = 0;
  for (PetscInt i = 0; i < pair->num_listed; i++) {
    pair->first_segment[i] = pair->num_segments;
    pair->first_node[i]    = pair->num_local;
    ContactFrame(pair, nonmortar, pair->listed[i], &f);
    for (int k = 0; k < 2; k++) {
      const Segment hit = {.mortar_facet = Hit_Private(pair, i, &f, mortar, k), .lambda = {k, k}, .bound = {-1, -1}};

      if (hit.mortar_facet >= 0) PetscCall(ContactSegmentsPush(pair, i, &f, mortar, &hit));
    }
  }
  pair->first_segment[pair->num_listed] = pair->num_segments;
  pair->first_node[pair->num_listed]    = pair->num_local;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dy = factor rho L / 2 with its gradient parts: v = rho_k L / 2 differentiates by x_0, x_1 only. */
static PetscReal Weight_Private(const EdgeFrame *f, int k, const PetscReal dL[4], PetscReal dv[4])
{
  const PetscReal rho = f->ring > 0 ? f->ring * f->x[k][0] : 1;

  for (int a = 0; a < 4; a++) dv[a] = 0.5 * (rho * dL[a] + (a == 2 * k ? f->ring * f->length : 0));
  return 0.5 * rho * f->length;
}

/* One node of the edge: gap, weight, gradients; with a Hessian also z times the second derivatives into W (half form) and z times the gradient into dz. */
static void Node_Private(const EvaluateContext *ctx, const EdgeFrame *f, const Segment *s, const EdgeChain *chain, PetscReal *dz, PetscReal *W,
                         ContactFacet *out)
{
  const int       k  = s->lambda[0] > 0.5;
  const PetscInt  ny = chain->num_y;
  PetscReal       dL[4], ddL[4][4], dv[4], local[CONTACT_LOCAL] = {0}, w[CONTACT_LOCAL][CONTACT_LOCAL], *dy = dz + ny, v, z;
  SegmentGeometry g;
  GapPoint        p;
  HessianSum      h;

  ContactGeometry(ctx->mortar, s, &g);
  ContactPointGap(f, &g, k, ctx->derivatives, &p);
  ContactLengthDerivative(f, dL, ddL);
  v                             = Weight_Private(f, k, dL, dv);
  out->min_gap                  = PetscMin(out->min_gap, p.g);
  ((PetscReal *)out->weight)[k] = v;
  ((PetscReal *)out->gap)[k]    = v * p.g;
  out->area += v;
  if (!ctx->derivatives) return;
  for (PetscInt i = 0; i < ny; i++) dy[i] = i < 4 ? dv[i] : 0;
  ContactChainGradient(chain, dy, (PetscReal *)out->dweight + k * chain->num_u);
  for (int i = 0; i < 12; i++) local[i] = v * p.dg[i] + (i < 4 ? dv[i] * p.g : 0);
  for (PetscInt i = 0; i < ny; i++) dy[i] = 0;
  ContactScatterVector(s->local, local, dy);
  ContactChainGradient(chain, dy, (PetscReal *)out->dgap + k * chain->num_u);
  if (!ctx->hessian) return;
  z = ctx->z[out->nodes[k]];
  for (PetscInt i = 0; i < ny; i++) dz[i] += z * dy[i];
  ContactHessianClear(&h);
  ContactHessianPoint(f, &p, &g, z * v, 0, &h);
  for (int i = 0; i < CONTACT_LOCAL; i++) h.left[h.num][i] = i < 4 ? z * dv[i] : 0, h.right[h.num][i] = i < 12 ? p.dg[i] : 0;
  h.num++;
  ContactHessianFinish(&h, w);
  for (int a = 0; a < 4; a++) /* z g Hess v */
    for (int b = 0; b < 4; b++)
      w[a][b] += 0.25 * z * p.g * ((f->ring > 0 ? f->ring * f->x[k][0] : 1) * ddL[a][b] + f->ring * ((a == 2 * k) * dL[b] + (b == 2 * k) * dL[a]));
  ContactScatter(s->local, ny, w, W);
}

/* Fill one result; *use is false when neither node's ray hits the mortar side. */
void ContactNodeEdge(const EvaluateContext *ctx, PetscInt slot, ContactFacet *out, PetscBool *use)
{
  ContactPair    pair       = ctx->pair;
  const PetscInt num_mortar = pair->first_node[slot + 1] - pair->first_node[slot];
  PetscReal     *dz         = pair->work, *W;
  EdgeFrame      f;
  EdgeChain      chain;
  PetscInt       num;

  *use = pair->first_segment[slot + 1] > pair->first_segment[slot] ? PETSC_TRUE : PETSC_FALSE;
  if (!*use) return;
  ContactFrame(pair, ctx->nonmortar, pair->listed[slot], &f);
  ContactChainBuild(pair, ctx->nonmortar, pair->listed[slot], num_mortar, &chain, (PetscInt *)out->nodes, &num);
  W            = dz + 2 * chain.num_y;
  out->area    = 0;
  out->min_gap = PETSC_MAX_REAL;
  if (ctx->hessian)
    for (PetscInt i = 0; i < chain.num_y * (chain.num_y + 2); i++) dz[i] = 0;
  for (int k = 0; k < 2; k++) ((PetscReal *)out->gap)[k] = ((PetscReal *)out->weight)[k] = 0;
  if (ctx->derivatives)
    for (PetscInt i = 0; i < 2 * chain.num_u; i++) ((PetscReal *)out->dgap)[i] = ((PetscReal *)out->dweight)[i] = 0;
  for (PetscInt i = pair->first_segment[slot]; i < pair->first_segment[slot + 1]; i++) Node_Private(ctx, &f, &pair->segment[i], &chain, dz, W, out);
  if (ctx->hessian) ContactChainHessian(&chain, dz, W, (PetscReal *)out->hessian);
}
