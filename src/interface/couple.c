/* One contact pair on one mesh: multipliers, nodal gaps, activity. */
#include "interfaceimpl.h"

/* Facets evaluated here: those of owned leaves, and those that carry weight to an owned node, so that its owner knows the node's whole row. */
static PetscErrorCode ListFacets_Private(Interface p, Contact *c)
{
  const Surface      *s = &c->side[0];
  const ForestTables *t = p->tables;
  PetscBool          *near;

  PetscFunctionBegin;
  PetscCall(PetscMalloc2(s->num_facets, &c->listed, s->num_facets, &c->mine));
  PetscCall(PetscMalloc1(s->num_facets, &near));
  for (PetscInt f = 0; f < s->num_facets; ++f) near[f] = c->mine[f] = (PetscBool)(t->leaf_rank[s->facet_leaf[f]] == p->rank);
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    for (PetscInt k = s->node_first[n]; s->owned[n] && k < s->node_first[n + 1]; ++k) near[s->node_facet[k]] = PETSC_TRUE;
  }
  for (PetscInt f = 0; f < s->num_facets; ++f) {
    if (near[f]) c->listed[c->num_listed++] = f;
  }
  PetscCall(PetscFree(near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Diameter of the box around sides, where they are in the mesh. */
static PetscReal Extent_Private(PetscInt num, const Surface side[])
{
  const PetscInt dim    = side[0].dim;
  PetscReal      square = 0;

  for (PetscInt a = 0; a < dim; ++a) {
    PetscReal lo = PETSC_MAX_REAL, hi = PETSC_MIN_REAL;
    for (const Surface *s = side; s < side + num; ++s) {
      for (PetscInt n = 0; n < s->num_nodes; ++n) {
        lo = PetscMin(lo, s->X[dim * n + a]);
        hi = PetscMax(hi, s->X[dim * n + a]);
      }
    }
    square += PetscSqr(hi - lo);
  }
  return PetscSqrtReal(square);
}

/* Automatic search distance: half of the smaller side's extent, of tied sides a tenth: what is further apart is not tied; facets of round surfaces are nearer,
   and refinement changes nothing. The caller's factor counts in units of the longest edge, as far as both sides reach: there is nothing beyond. */
static void SearchDistance_Private(Contact *c)
{
  PetscReal longest = 0;

  for (const Surface *s = c->side; s < c->side + 2; ++s) {
    for (PetscInt f = 0; f < s->num_facets; ++f) {
      const PetscReal measure = SurfaceFacetMeasure_Private(s, f, PETSC_FALSE);
      longest                 = PetscMax(longest, s->dim == 2 ? measure : PetscSqrtReal(measure));
    }
  }
  if (c->spec->search > 0)
    c->distance = PetscMin(c->spec->search * longest, Extent_Private(2, c->side));
  else
    c->distance = (c->law->ties ? NEAR : 0.5) * PetscMin(Extent_Private(1, &c->side[0]), Extent_Private(1, &c->side[1]));
}

static void View_Private(Contact *c)
{
  ContactView *v     = &c->view;
  SurfaceView *sv[2] = {&v->nonmortar, &v->mortar};
  for (PetscInt k = 0; k < 2; ++k) {
    const Surface *s = &c->side[k];
    *sv[k]           = (SurfaceView){s->dim,          s->corners, s->num_nodes,   s->num_facets,  s->node_entity, s->facets, s->facet_leaf,
                                     s->facet_entity, s->hang,    s->hang_master, s->hang_weight, s->X,           s->x,      s->force,
                                     s->owned,        s->order,   s->first,       s->lattice,     s->higher};
  }
  v->spec           = c->spec;
  v->num_z          = c->num;
  v->z              = c->z;
  v->gap            = c->gap;
  v->weight         = c->weight;
  v->initial_gap    = c->initial_gap;
  v->active         = c->active;
  v->has_multiplier = c->has_multiplier;
  v->pair           = c->pair;
}

/* Sums over facets to the nodes of this rank, which evaluates all facets that carry weight to them; area over ranks. */
PetscErrorCode ContactNodeSums_Private(Interface p, Contact *c)
{
  const Surface *s      = &c->side[0];
  PetscReal      sum[2] = {0, 0};

  PetscFunctionBegin;
  for (PetscInt i = 0; i < s->num_own; ++i) c->gap[s->own[i]] = c->weight[s->own[i]] = c->spring[s->own[i]] = 0;
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e = &c->facets[i];
    for (PetscInt k = 0; k < e->num_rows; ++k) {
      if (!s->owned[e->nodes[k]]) continue;
      c->gap[e->nodes[k]] += e->gap[k];
      c->weight[e->nodes[k]] += e->weight[k];
      if (e->compliance) c->spring[e->nodes[k]] += ContactCompliance_Private(e, k, k);
    }
    if (c->mine[e->facet]) sum[0] += e->area;
  }
  const PetscInt unusable = ContactPairGetDegenerate(c->pair);
  sum[1]                  = (PetscReal)unusable;
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, p->comm));
  c->view.area     = sum[0];
  c->view.unusable = (PetscInt)sum[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gaps, weights and what compliances add from the ranks of the nodes to those that use them. */
static PetscErrorCode ShareGaps_Private(Interface p, Contact *c)
{
  const Surface   *s        = &c->side[0];
  PetscReal *const value[4] = {c->gap, c->weight, c->spring, c->coupled};

  PetscFunctionBegin;
  if (p->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < s->num_own; ++i)
    for (PetscInt k = 0; k < 4; ++k) c->pack[4 * s->own[i] + k] = value[k][s->own[i]];
  PetscCall(LinkSpread_Private(p, &s->values, 4, c->pack));
  for (PetscInt i = 0; i < s->values.num; ++i)
    for (PetscInt k = 0; k < 4; ++k) value[k][s->values.nodes[i]] = c->pack[4 * s->values.nodes[i] + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Take off what counts as no gap; the smallest that is left. Then all users know. */
static PetscErrorCode Subtract_Private(Interface p, Contact *c)
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  c->view.min_gap = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < s->num_own; ++i) {
    const PetscInt j = s->own[i];
    c->gap[j] -= c->offset[j];
    if (ContactCovered_Private(c, j)) c->view.min_gap = PetscMin(c->view.min_gap, c->gap[j] / c->weight[j]);
  }
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &c->view.min_gap, 1, MPIU_REAL, MPI_MIN, p->comm));
  ContactCoupling_Private(c, c->z, c->coupled);
  PetscCall(ShareGaps_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactCreate_Private(Interface p, const ContactSpec *spec, Contact *c)
{
  const PetscBool     axisymmetric = (PetscBool)(p->spec->model == MODEL_AXISYMMETRIC);
  const SurfaceFacets own = {.group = spec->nonmortar}, other = {.group = spec->mortar, .colour = spec->part, .face = spec->face};

  PetscFunctionBegin;
  PetscCall(PetscMemzero(c, sizeof(*c)));
  c->spec = spec;
  c->law  = ContactLaws[spec->law];
  c->num  = c->law->num_multipliers(p->dim);
  PetscCall(SurfaceCreate_Private(p, spec->name, &own, &c->side[0]));
  PetscCall(SurfaceCreate_Private(p, spec->name, &other, &c->side[1]));
  const PetscBool higher = (PetscBool)(c->side[0].higher || c->side[1].higher);
  c->side[0].higher = c->side[1].higher = higher;
  PetscCall(ContactPairCreate(p->dim, axisymmetric, spec, &c->pair));
  for (PetscInt k = 0; k < 2; ++k) PetscCall(HullParts_Private(p, &c->side[k], &c->part[k]));
  PetscReal deepest;
  HullDepth_Private(p, c, &deepest);
  if (!spec->see_through && !c->law->ties) ContactPairSetHull(c->pair, p->hull, c->part[0], c->part[1], deepest);
  const PetscInt n = c->side[0].num_nodes;
  PetscCall(PetscCalloc6(c->num * n, &c->z, n, &c->gap, n, &c->weight, n, &c->w0, n, &c->extent, n, &c->c));
  PetscCall(PetscCalloc4(n, &c->spring, n, &c->coupled, n, &c->softness, n, &c->before));
  PetscCall(PetscCalloc5(n, &c->active, n, &c->has_multiplier, n, &c->lift, n, &c->change, n, &c->near));
  PetscCall(PetscCalloc1(n, &c->kept));
  PetscCall(PetscMalloc1(c->side[0].num_facets, &c->result));
  PetscCall(PetscMalloc4(n, &c->zdof, n, &c->zlocal, n, &c->gap0, n, &c->offset));
  PetscCall(PetscCalloc3(n, &c->reach, n, &c->initial, n, &c->initial_gap));
  PetscCall(PetscCalloc4(c->side[0].num_facets, &c->live, n, &c->valued, n, &c->valued_node, 4 * n, &c->pack));
  PetscCall(ContactNodeScales_Private(p, c));
  if (!c->law->ties) ContactCarriers_Private(p, c);
  const ContactSurface nonmortar = SurfaceAt_Private(&c->side[0], c->side[0].X);
  PetscCall(ContactPairSetCarriers(c->pair, &nonmortar, c->has_multiplier, NULL));
  for (PetscInt j = 0; j < n; ++j) c->softness[j] = 1 / c->c[j];
  /* With small kinematics what facets cover does not change, and constraints of order 1 stay exact. */
  if (c->law->ties || higher || p->spec->kinematics != KINEMATICS_SMALL) ContactPairSetSoftness(c->pair, c->softness);
  PetscCall(ListFacets_Private(p, c));
  PetscCall(ContactStabilise_Private(p, c));
  PetscCall(PetscCalloc1(c->side[0].num_facets, &c->watch));
  ContactPairSetMet(c->pair, c->side[1].met);
  SearchDistance_Private(c);
  View_Private(c);
  PetscCall(ContactOffset_Private(p, c));
  PetscCall(SlipCreate_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactDestroy_Private(Contact *c)
{
  PetscFunctionBegin;
  PetscCall(TieDestroy_Private(c));
  PetscCall(SlipDestroy_Private(c));
  PetscCall(FreeAll(16, (void *[]){&c->stabilisation, &c->kept, &c->watch, &c->frozen, &c->shared, &c->mean0, &c->all_real[0], &c->all_real[1], &c->all_active,
                                   &c->part[0], &c->part[1], &c->link[0], &c->link[1], &c->pattern_offset, &c->pattern, &c->result}));
  PetscCall(ContactPairDestroy(&c->pair));
  PetscCall(SurfaceDestroy_Private(&c->side[0]));
  PetscCall(SurfaceDestroy_Private(&c->side[1]));
  PetscCall(PetscFree6(c->z, c->gap, c->weight, c->w0, c->extent, c->c));
  PetscCall(PetscFree4(c->spring, c->coupled, c->softness, c->before));
  PetscCall(PetscFree5(c->active, c->has_multiplier, c->lift, c->change, c->near));
  PetscCall(PetscFree4(c->zdof, c->zlocal, c->gap0, c->offset));
  PetscCall(PetscFree3(c->reach, c->initial, c->initial_gap));
  PetscCall(PetscFree2(c->closed, c->corner_gap));
  PetscCall(PetscFree4(c->live, c->valued, c->valued_node, c->pack));
  PetscCall(PetscFree2(c->listed, c->mine));
  for (PetscInt k = 0; k < 2; ++k) PetscCall(PetscFree2(c->inward[k], c->moved[k]));
  if (!c->spec->part) PetscCall(PetscFree(c->precedence)); /* else borrowed from the first part */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactGatherMultipliers_Private(Interface p, Contact *c, Vec x)
{
  Surface         *s = &c->side[0];
  const PetscReal *array;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(x, &array));
  for (PetscInt i = 0; i < c->num * s->num_own; ++i) {
    const PetscInt j = s->own[i % s->num_own], k = i / s->num_own;
    c->z[s->num_nodes * k + j] = c->zlocal[j] >= 0 ? array[c->zlocal[j] + k] : 0;
  }
  PetscCall(VecRestoreArrayRead(x, &array));
  for (PetscInt k = 0; k < c->num; ++k) PetscCall(LinkSpread_Private(p, &s->values, 1, c->z + s->num_nodes * k));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Activity_Private(Interface p, Contact *c)
{
  for (PetscInt i = 0; i < c->num_valued; ++i) {
    const PetscInt j     = c->valued_node[i];
    ContactPoint   point = ContactPoint_Private(c, j, PETSC_FALSE);

    point.state = 0; /* a function of the positions and multipliers alone */
    if (!p->form->frozen_states) c->active[j] = c->has_multiplier[j] && ContactCovered_Private(c, j) ? c->law->state(&point) : 0;
    if (c->slip && c->side[0].dim == 3) c->law->aim(&point, c->slip->aim + 3 * j);
  }
}

/* Small kinematics: gaps are linear in the displacement. The weighted gap is frozen with its segments, measure and normals at the reference positions, where
   facets stay evaluated; grad gt - (gt/w) grad w is its derivative with the measure held. */
static PetscErrorCode Freeze_Private(Interface p, Contact *c, PetscBool *failed)
{
  const PetscInt num     = c->side[0].num_nodes;
  ContactSurface side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].X), SurfaceAt_Private(&c->side[1], c->side[1].X)};

  PetscFunctionBegin;
  PetscCall(ContactSearch_Private(p, c, PETSC_TRUE, 0));
  ContactPairFreezeNormals(c->pair, PETSC_TRUE);
  PetscCall(SlipFreeze_Private(p, c, failed));
  PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], NULL, NULL, PETSC_TRUE, PETSC_FALSE, &c->num_facets, &c->facets, failed));
  PetscCall(ContactNodeSums_Private(p, c));
  PetscCall(PetscArraycpy(c->gap0, c->gap, num));
  PetscCall(ShareGaps_Private(p, c));
  PetscCall(PetscCalloc1(num, &c->mean0));
  for (PetscInt j = 0; j < num; ++j) {
    if (ContactCovered_Private(c, j)) c->mean0[j] = c->gap[j] / c->weight[j];
  }
  PetscCall(PetscMalloc1(c->num_facets, &c->frozen));
  PetscCall(PetscArraycpy(c->frozen, c->facets, c->num_facets));
  for (PetscInt i = 0; i < c->num_facets; ++i) c->frozen[i].dshare = c->frozen[i].push = NULL; /* what is covered stays */
  c->facets = c->frozen;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ContactRows_Private(const Contact *c, PetscInt j, PetscBool lifted, PetscBool symmetric, ContactRow row[])
{
  const ContactPoint point = ContactPoint_Private(c, j, lifted);

  c->law->rows(&point, symmetric, row);
  for (PetscInt k = 0; k < c->num && c->mean0; ++k) row[k].mean = c->mean0[j];
}

PetscReal ContactFacetDot_Private(const Contact *c, const ContactFacet *e, const PetscReal *gradient)
{
  const PetscInt dim = c->side[0].dim;
  PetscReal      sum = 0;
  for (PetscInt a = 0; a < e->num; ++a) {
    const PetscReal *du = c->side[NODE_SIDE(e->nodes[a])].du + dim * NODE_INDEX(e->nodes[a]);
    for (PetscInt d = 0; d < dim; ++d) sum += gradient[dim * a + d] * du[d];
  }
  return sum;
}

PetscErrorCode ContactChange_Private(Interface p, Contact *c, const PetscReal increment[], PetscReal change[])
{
  const Surface *s = &c->side[0];

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) PetscCall(SurfaceGather_Private(p, &c->side[k], increment, NULL, c->side[k].du));
  for (PetscInt i = 0; i < s->num_own; ++i) change[s->own[i]] = 0;
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e = &c->facets[i];
    for (PetscInt k = 0; k < e->num_rows && e->dgap; ++k) {
      const PetscInt j = e->nodes[k];
      ContactRow     row[MOST_MULTIPLIERS];
      if (!s->owned[j]) continue;
      change[j] += ContactFacetDot_Private(c, e, e->dgap + p->dim * k * e->num);
      if (!ContactCovered_Private(c, j)) continue;
      ContactRows_Private(c, j, PETSC_FALSE, PETSC_FALSE, row);
      const PetscReal mean = c->active[j] || c->mean0 ? row[0].mean : c->gap[j] / c->weight[j];
      change[j] -= mean * ContactFacetDot_Private(c, e, e->dweight + p->dim * k * e->num);
      const PetscReal yield = ContactYield_Private(c, e, k, row[0].along);
      if (yield != 0) change[j] += yield * ContactFacetDot_Private(c, e, e->dshare);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gaps of this rank's nodes. */
static void LinearGaps_Private(Interface p, Contact *c)
{
  const Surface *own = &c->side[0];

  for (PetscInt side = 0; side < 2; ++side) {
    Surface *s = &c->side[side];
    for (PetscInt i = 0; i < p->dim * s->num_nodes; ++i) s->du[i] = s->x[i] - s->X[i];
  }
  for (PetscInt i = 0; i < own->num_own; ++i) c->gap[own->own[i]] = c->gap0[own->own[i]];
  for (PetscInt i = 0; i < c->num_facets; ++i) {
    const ContactFacet *e = &c->frozen[i];
    for (PetscInt k = 0; k < e->num_rows; ++k) {
      const PetscInt j = e->nodes[k], at = p->dim * k * e->num;
      if (own->owned[j]) c->gap[j] += ContactFacetDot_Private(c, e, e->dgap + at) - c->mean0[j] * ContactFacetDot_Private(c, e, e->dweight + at);
    }
  }
}

/* Nodes that may take part in the next linear solve: pressed, or closer (compliances of facets counted in) than half a facet beside what prescribed motion may
   still close. Three dimensions: the others get no row in the matrix, which they would only fill. Every rank that knows the node says the same. */
static void Near_Private(Interface p, Contact *c, PetscReal pending)
{
  const Surface *s     = &c->side[0];
  PetscInt       order = 1; /* extents are those of facets over it */

  for (PetscInt f = 0; f < s->num_facets; ++f) order = PetscMax(order, s->order[f]);
  for (PetscInt i = 0; i < c->num_valued; ++i) {
    const PetscInt  j = c->valued_node[i];
    const PetscBool reach =
        (PetscBool)(ContactCovered_Private(c, j) && (c->gap[j] + c->coupled[j]) / c->weight[j] < pending + 0.5 * (PetscReal)order * c->extent[j]);
    c->near[j] = (PetscBool)(c->has_multiplier[j] && (c->z[j] != 0 || reach));
    if (p->dim == 2) c->near[j] = PETSC_TRUE;
  }
}

/* The pressure at nodes without multiplier, shown there and used by the estimate. Supports hold them, or they lie on the axis: from the nodes that their
   functions went to, if all of those touch: else the zone of contact ends there, and nothing tells how; 0. So the tractions where the surface is oblique to the
   axis; else they are 0 there by symmetry. Hanging: their masters'. */
static PetscErrorCode ShownMultipliers_Private(Interface p, Contact *c)
{
  const Surface   *s = &c->side[0];
  const PetscInt  *first, *donor;
  const PetscReal *weight;

  PetscFunctionBegin;
  ContactPairGetDonors(c->pair, &first, &donor, &weight);
  for (PetscInt i = 0; i < s->num_own && first; ++i) {
    const PetscInt n = s->own[i], num = c->shared && c->shared[n] ? c->num : 1;
    PetscReal      z[3] = {0, 0, 0};
    if (c->has_multiplier[n]) continue;
    for (PetscInt d = 0; d < num; ++d) c->z[s->num_nodes * d + n] = 0;
    if (!ContactSees_Private(c, n)) continue;
    PetscBool touch = PETSC_TRUE;
    for (PetscInt k = first[n]; k < first[n + 1]; ++k) {
      for (PetscInt d = 0; d < num; ++d) z[d] += weight[k] * c->z[s->num_nodes * d + donor[k]];
      if (!c->active[donor[k]]) touch = PETSC_FALSE;
    }
    z[0] = PetscMax(z[0], 0);
    for (PetscInt d = 0; d < num && touch; ++d) c->z[s->num_nodes * d + n] = z[d];
  }
  for (PetscInt d = 0; d < c->num && first && first[s->num_nodes] > 0; ++d) PetscCall(LinkSpread_Private(p, &s->values, 1, c->z + s->num_nodes * d));
  for (PetscInt k = 0; k < c->num; ++k) SurfaceFollow_Private(s, 1, c->z + s->num_nodes * k);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactEvaluate_Private(Interface p, Contact *c, Vec x, const PetscReal local[], PetscReal pending, PetscBool derivatives, PetscBool hessian,
                                       PetscBool *failed)
{
  const PetscBool small = (PetscBool)(p->spec->kinematics == KINEMATICS_SMALL);

  PetscFunctionBegin;
  p->traffic.evaluations++;
  if (small && !c->mean0 && !c->tie) PetscCall(Freeze_Private(p, c, failed));
  PetscCall(ContactGatherMultipliers_Private(p, c, x));
  for (PetscInt k = 0; k < 2; ++k) PetscCall(SurfaceGather_Private(p, &c->side[k], local, ContactBase_Private(c, k), c->side[k].x));
  if (c->tie) {
    PetscCall(TieEvaluate_Private(p, c));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (small)
    LinearGaps_Private(p, c);
  else {
    const ContactSurface side[2] = {SurfaceAt_Private(&c->side[0], c->side[0].x), SurfaceAt_Private(&c->side[1], c->side[1].x)};
    if (hessian && p->dim == 3) { /* who is near is decided by the gaps here, not by those of the last evaluation */
      PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], c->z, NULL, PETSC_FALSE, PETSC_FALSE, &c->num_facets, &c->facets, failed));
      PetscCall(ContactNodeSums_Private(p, c));
      PetscCall(Subtract_Private(p, c));
    }
    Near_Private(p, c, pending);
    PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], c->z, c->near, derivatives, hessian, &c->num_facets, &c->facets, failed));
    PetscCall(ContactNodeSums_Private(p, c));
  }
  PetscCall(Subtract_Private(p, c));
  PetscCall(SlipEvaluate_Private(p, c));
  if (small) Near_Private(p, c, pending);
  for (PetscInt e = 0; e < c->side[0].num_facets; ++e) c->result[e] = -1;
  for (PetscInt i = 0; i < c->num_facets; ++i) c->result[c->facets[i].facet] = i;
  Activity_Private(p, c);
  if (hessian && FormHas(p->form->warm_start, (PetscInt)(c - p->contacts))) PetscCall(ContactWarmStart_Private(p, c));
  PetscCall(ShownMultipliers_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
