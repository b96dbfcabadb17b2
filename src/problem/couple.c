/* One contact pair on one mesh: multipliers, nodal gaps, activity, forces. */
#include "problemimpl.h"

static PetscReal EdgeMeasure_Private(const Surface *s, PetscInt e, PetscBool axisymmetric)
{
  const PetscReal *a = s->X + 2 * s->edges[2 * e], *b = s->X + 2 * s->edges[2 * e + 1], length = PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
  return axisymmetric ? length * PETSC_PI * (a[0] + b[0]) : length;
}

static PetscReal Young_Private(const MaterialSpec *m)
{
  return 9 * m->kappa * m->mu / (3 * m->kappa + m->mu);
}

/* Tributary measure w0 and the constant c = E / w0 of the complementarity; E of the softer body (a rigid one does not count). */
static PetscErrorCode NodeScales_Private(Problem p, Contact *c)
{
  const Surface      *s = &c->side[0];
  const ForestTables *t;
  PetscReal           young = PETSC_MAX_REAL;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(p->forest, &t));
  for (PetscInt side = 0; side < 2; ++side) {
    for (PetscInt e = 0; e < c->side[side].num_edges; ++e) {
      const MaterialSpec *m = p->scene->bodies[t->leaf_body[c->side[side].edge_leaf[e]]].material;
      if (!m->law->rigid) young = PetscMin(young, Young_Private(m));
    }
  }
  for (PetscInt e = 0; e < s->num_edges; ++e) {
    const PetscReal half = 0.5 * EdgeMeasure_Private(s, e, (PetscBool)(p->scene->mechanics.model == MODEL_AXISYMMETRIC));
    for (PetscInt k = 0; k < 2; ++k) c->w0[s->edges[2 * e + k]] += half;
  }
  for (PetscInt n = 0; n < s->num_nodes; ++n) c->c[n] = young / c->w0[n];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A node all of whose motion a support prescribes carries no multiplier: its constraint would have nothing of its own to act on.
   (Nodes of rigid bodies keep theirs: the other side moves.) */
static PetscErrorCode HasMultiplier_Private(Problem p, Contact *c)
{
  const ForestTables *t;
  const Surface      *s = &c->side[0];

  PetscFunctionBegin;
  PetscCall(ForestGetTables(p->forest, &t));
  for (PetscInt n = 0; n < s->num_nodes; ++n) {
    const PetscInt  edge  = s->node_edge[2 * n] >= 0 ? s->node_edge[2 * n] : s->node_edge[2 * n + 1];
    const PetscBool rigid = p->scene->bodies[t->leaf_body[s->edge_leaf[edge]]].material->law->rigid;
    c->has_multiplier[n]  = (PetscBool)(rigid || s->dof[2 * n] != 3);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Edges evaluated here: those of owned leaves, and those next to an owned node, so that its owner knows the node's whole row. */
static PetscErrorCode ListEdges_Private(Problem p, Contact *c)
{
  const Surface      *s = &c->side[0];
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(p->forest, &t));
  PetscCall(PetscMalloc2(s->num_edges, &c->listed, s->num_edges, &c->mine));
  for (PetscInt e = 0; e < s->num_edges; ++e) {
    c->mine[e] = (PetscBool)(t->leaf_rank[s->edge_leaf[e]] == p->rank);
    if (c->mine[e] || s->owned[s->edges[2 * e]] || s->owned[s->edges[2 * e + 1]]) c->listed[c->num_listed++] = e;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Automatic search distance: the smaller side's extent; the caller's factor counts in units of the longest edge. */
static void SearchDistance_Private(Contact *c)
{
  PetscReal extent[2], longest = 0;
  for (PetscInt side = 0; side < 2; ++side) {
    const Surface *s     = &c->side[side];
    PetscReal      lo[2] = {PETSC_MAX_REAL, PETSC_MAX_REAL}, hi[2] = {PETSC_MIN_REAL, PETSC_MIN_REAL};
    for (PetscInt n = 0; n < s->num_nodes; ++n) {
      for (PetscInt a = 0; a < 2; ++a) {
        lo[a] = PetscMin(lo[a], s->X[2 * n + a]);
        hi[a] = PetscMax(hi[a], s->X[2 * n + a]);
      }
    }
    for (PetscInt e = 0; e < s->num_edges; ++e) longest = PetscMax(longest, EdgeMeasure_Private(s, e, PETSC_FALSE));
    extent[side] = PetscSqrtReal(PetscSqr(hi[0] - lo[0]) + PetscSqr(hi[1] - lo[1]));
  }
  c->distance = c->spec->search > 0 ? c->spec->search * longest : 0.5 * PetscMin(extent[0], extent[1]);
}

static void View_Private(Contact *c)
{
  ContactView *v     = &c->view;
  SurfaceView *sv[2] = {&v->nonmortar, &v->mortar};
  for (PetscInt k = 0; k < 2; ++k) {
    const Surface *s = &c->side[k];
    *sv[k]           = (SurfaceView){s->num_nodes, s->num_edges, s->node_entity, s->edges, s->edge_leaf, s->X, s->x, s->force};
  }
  v->spec           = c->spec;
  v->z              = c->z;
  v->gap            = c->gap;
  v->weight         = c->weight;
  v->active         = c->active;
  v->has_multiplier = c->has_multiplier;
  v->pair           = c->pair;
}

/* Sums over edges to nodes, over ranks; area. */
static PetscErrorCode NodeSums_Private(Problem p, Contact *c)
{
  const PetscInt n = c->side[0].num_nodes;
  PetscReal     *buffer;

  PetscFunctionBegin;
  PetscCall(PetscCalloc1(2 * n + 1, &buffer));
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    const ContactEdge *e = &c->edges[i];
    if (!c->mine[e->edge]) continue;
    for (PetscInt k = 0; k < 2; ++k) {
      buffer[e->node[k]] += e->gap[k];
      buffer[n + e->node[k]] += e->weight[k];
    }
    buffer[2 * n] += e->area;
  }
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, buffer, (PetscMPIInt)(2 * n + 1), MPIU_REAL, MPI_SUM, p->comm));
  PetscCall(PetscArraycpy(c->gap, buffer, n));
  PetscCall(PetscArraycpy(c->weight, buffer + n, n));
  c->view.area = buffer[2 * n];
  PetscCall(PetscFree(buffer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static ContactSurface SurfaceOf_Private(const Surface *s, const PetscReal *x)
{
  return (ContactSurface){s->num_nodes, s->num_edges, s->edges, x, s->mirror};
}

/* What counts as no gap: gt_j less a constant, so that forces and derivatives stay as they are. Initial gaps are those of this mesh at the reference
   positions; an interference is taken per reference length. */
static PetscErrorCode Offset_Private(Problem p, Contact *c)
{
  const PetscInt     n       = c->side[0].num_nodes;
  ContactSurface     side[2] = {SurfaceOf_Private(&c->side[0], c->side[0].X), SurfaceOf_Private(&c->side[1], c->side[1].X)};
  const ContactEdge *edges;
  PetscBool          failed;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(c->offset, n));
  if (!c->spec->adjust && c->spec->interference == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactPairSearch(c->pair, &side[0], &side[1], c->num_listed, c->listed, c->distance, 0));
  PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], NULL, PETSC_FALSE, PETSC_FALSE, &c->num_edges, &edges, &failed));
  c->edges = edges;
  PetscCall(NodeSums_Private(p, c));
  for (PetscInt j = 0; j < n; ++j) c->offset[j] = (c->spec->adjust ? c->gap[j] : 0) + c->spec->interference * c->weight[j];
  for (PetscInt j = 0; c->spec->adjust && j < n; ++j) {
    if (!ContactCovered_Private(c, j)) continue;
    c->view.adjusted = PetscMax(c->view.adjusted, PetscAbsReal(c->gap[j] / c->weight[j]));
  }
  c->num_edges = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Take off what counts as no gap; the smallest that is left. */
static void Subtract_Private(Contact *c)
{
  c->view.min_gap = PETSC_MAX_REAL;
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    c->gap[j] -= c->offset[j];
    if (ContactCovered_Private(c, j)) c->view.min_gap = PetscMin(c->view.min_gap, c->gap[j] / c->weight[j]);
  }
}

PetscErrorCode ContactCreate_Private(Problem p, const ContactSpec *spec, Contact *c)
{
  const PetscBool axisymmetric = (PetscBool)(p->scene->mechanics.model == MODEL_AXISYMMETRIC);

  PetscFunctionBegin;
  PetscCall(PetscMemzero(c, sizeof(*c)));
  PetscCheckInput(p->dim == 2, "contact.%s: contact in three dimensions is not built yet", spec->name);
  c->spec = spec;
  PetscCall(SurfaceCreate_Private(p, spec->nonmortar, &c->side[0]));
  PetscCall(SurfaceCreate_Private(p, spec->mortar, &c->side[1]));
  PetscCall(ContactPairCreate(axisymmetric, spec->node_to_segment, &c->pair));
  const PetscInt n = c->side[0].num_nodes;
  PetscCall(PetscCalloc5(n, &c->z, n, &c->gap, n, &c->weight, n, &c->w0, n, &c->c));
  PetscCall(PetscCalloc4(n, &c->active, n, &c->has_multiplier, n, &c->lift, n, &c->change));
  PetscCall(PetscMalloc1(c->side[0].num_edges, &c->result));
  PetscCall(PetscMalloc4(n, &c->zdof, n, &c->zlocal, n, &c->gap0, n, &c->offset));
  PetscCall(NodeScales_Private(p, c));
  PetscCall(HasMultiplier_Private(p, c));
  PetscCall(ListEdges_Private(p, c));
  SearchDistance_Private(c);
  View_Private(c);
  PetscCall(Offset_Private(p, c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FrozenDestroy_Private(Contact *c)
{
  PetscFunctionBegin;
  if (!c->frozen) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    PetscCall(PetscFree(c->frozen[i].nodes));
    PetscCall(PetscFree(c->frozen[i].dgap));
    PetscCall(PetscFree(c->frozen[i].dweight));
  }
  PetscCall(PetscFree(c->frozen));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactDestroy_Private(Contact *c)
{
  PetscFunctionBegin;
  PetscCall(FrozenDestroy_Private(c));
  PetscCall(ContactPairDestroy(&c->pair));
  PetscCall(SurfaceDestroy_Private(&c->side[0]));
  PetscCall(SurfaceDestroy_Private(&c->side[1]));
  PetscCall(PetscFree5(c->z, c->gap, c->weight, c->w0, c->c));
  PetscCall(PetscFree4(c->active, c->has_multiplier, c->lift, c->change));
  PetscCall(PetscFree(c->result));
  PetscCall(PetscFree4(c->zdof, c->zlocal, c->gap0, c->offset));
  PetscCall(PetscFree2(c->listed, c->mine));
  PetscCall(PetscFree(c->pattern_offset));
  PetscCall(PetscFree(c->pattern));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multipliers live with the owner of their node; counts[rank] grows. */
PetscErrorCode ContactNumber_Private(Problem p, PetscInt counts[])
{
  const ForestTables *t;

  PetscFunctionBegin;
  PetscCall(ForestGetTables(p->forest, &t));
  for (PetscInt i = 0; i < p->num_contacts; ++i) {
    Contact *c = &p->contacts[i];
    for (PetscInt n = 0; n < c->side[0].num_nodes; ++n) {
      const PetscMPIInt owner = t->leaf_rank[t->entity_leaf[c->side[0].node_entity[n]]];
      c->zdof[n] = c->zlocal[n] = -1;
      if (!c->has_multiplier[n]) continue;
      c->zdof[n] = counts[owner]++;
      if (owner == p->rank) c->zlocal[n] = c->zdof[n];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Multipliers of all nodes on all ranks from the vector. */
static PetscErrorCode GatherMultipliers_Private(Problem p, Contact *c, Vec x)
{
  const PetscReal *array;
  const PetscInt   n = c->side[0].num_nodes;

  PetscFunctionBegin;
  PetscCall(VecGetArrayRead(x, &array));
  for (PetscInt i = 0; i < n; ++i) c->z[i] = c->zlocal[i] >= 0 ? array[c->zlocal[i]] : 0;
  PetscCall(VecRestoreArrayRead(x, &array));
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c->z, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Activity_Private(Contact *c)
{
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    c->active[j] = (PetscBool)(c->has_multiplier[j] && ContactCovered_Private(c, j) && c->z[j] - c->c[j] * c->gap[j] / c->weight[j] > 0);
  }
}

/* Small kinematics: gaps are linear in the displacement. The weighted gap is frozen with its segments, measure and normals at the reference
   positions; grad gt - (gt/w) grad w is its derivative with the measure held. */
static PetscErrorCode Freeze_Private(Problem p, Contact *c, PetscBool *failed)
{
  ContactSurface     side[2] = {SurfaceOf_Private(&c->side[0], c->side[0].X), SurfaceOf_Private(&c->side[1], c->side[1].X)};
  const ContactEdge *edges;

  PetscFunctionBegin;
  PetscCall(ContactPairSearch(c->pair, &side[0], &side[1], c->num_listed, c->listed, c->distance, 0));
  PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], NULL, PETSC_TRUE, PETSC_FALSE, &c->num_edges, &edges, failed));
  PetscCall(PetscMalloc1(c->num_edges, &c->frozen));
  c->edges = edges;
  PetscCall(NodeSums_Private(p, c));
  PetscCall(PetscArraycpy(c->gap0, c->gap, c->side[0].num_nodes));
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    const PetscInt n = 2 * edges[i].num;
    PetscInt      *nodes;
    PetscReal     *dgap, *dweight;
    PetscCall(PetscMalloc1(edges[i].num, &nodes));
    PetscCall(PetscMalloc1(2 * n, &dgap));
    PetscCall(PetscCalloc1(2 * n, &dweight));
    PetscCall(PetscArraycpy(nodes, edges[i].nodes, edges[i].num));
    for (PetscInt k = 0; k < 2; ++k) {
      const PetscInt  j    = edges[i].node[k];
      const PetscReal mean = ContactCovered_Private(c, j) ? c->gap[j] / c->weight[j] : 0;
      for (PetscInt a = 0; a < n; ++a) dgap[k * n + a] = edges[i].dgap[k * n + a] - mean * edges[i].dweight[k * n + a];
    }
    c->frozen[i]         = edges[i];
    c->frozen[i].nodes   = nodes;
    c->frozen[i].dgap    = dgap;
    c->frozen[i].dweight = dweight;
    c->frozen[i].hessian = NULL;
  }
  c->edges     = c->frozen;
  c->is_frozen = PETSC_TRUE; /* also on a rank that has no edges: the next evaluation must not come here again */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Increment of the row of node k of an edge under nodal increments du of both sides. */
static PetscReal EdgeDot_Private(const Contact *c, const ContactEdge *e, const PetscReal *gradient)
{
  PetscReal sum = 0;
  for (PetscInt a = 0; a < e->num; ++a) {
    const PetscReal *du = c->side[NODE_SIDE(e->nodes[a])].du + 2 * NODE_INDEX(e->nodes[a]);
    sum += gradient[2 * a] * du[0] + gradient[2 * a + 1] * du[1];
  }
  return sum;
}

PetscErrorCode ContactChange_Private(Problem p, Contact *c, const PetscReal increment[], PetscReal change[])
{
  const PetscInt n = c->side[0].num_nodes;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) PetscCall(SurfaceGather_Private(p, &c->side[k], increment, NULL, c->side[k].du));
  PetscCall(PetscArrayzero(change, n));
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    const ContactEdge *e = &c->edges[i];
    for (PetscInt k = 0; k < 2 && c->mine[e->edge]; ++k) {
      const PetscInt j = e->node[k];
      change[j] += EdgeDot_Private(c, e, e->dgap + 2 * k * e->num);
      if (ContactCovered_Private(c, j)) change[j] -= c->gap[j] / c->weight[j] * EdgeDot_Private(c, e, e->dweight + 2 * k * e->num);
    }
  }
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, change, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, p->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinearGaps_Private(Problem p, Contact *c)
{
  const PetscInt n = c->side[0].num_nodes;

  PetscFunctionBegin;
  for (PetscInt side = 0; side < 2; ++side) {
    Surface *s = &c->side[side];
    for (PetscInt i = 0; i < 2 * s->num_nodes; ++i) s->du[i] = s->x[i] - s->X[i];
  }
  PetscCall(PetscArrayzero(c->gap, n));
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    const ContactEdge *e = &c->frozen[i];
    for (PetscInt k = 0; k < 2 && c->mine[e->edge]; ++k) c->gap[e->node[k]] += EdgeDot_Private(c, e, e->dgap + 2 * k * e->num);
  }
  if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, c->gap, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, p->comm));
  for (PetscInt j = 0; j < n; ++j) c->gap[j] += c->gap0[j];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ContactEvaluate_Private(Problem p, Contact *c, Vec x, const PetscReal local[], PetscBool derivatives, PetscBool hessian, PetscBool *failed)
{
  PetscFunctionBegin;
  PetscCall(GatherMultipliers_Private(p, c, x));
  for (PetscInt k = 0; k < 2; ++k) PetscCall(SurfaceGather_Private(p, &c->side[k], local, c->side[k].X, c->side[k].x));
  if (p->scene->mechanics.kinematics == KINEMATICS_SMALL) {
    if (!c->is_frozen) PetscCall(Freeze_Private(p, c, failed));
    PetscCall(LinearGaps_Private(p, c));
  } else {
    ContactSurface side[2] = {SurfaceOf_Private(&c->side[0], c->side[0].x), SurfaceOf_Private(&c->side[1], c->side[1].x)};
    PetscCall(ContactPairEvaluate(c->pair, &side[0], &side[1], c->z, derivatives, hessian, &c->num_edges, &c->edges, failed));
    PetscCall(NodeSums_Private(p, c));
  }
  Subtract_Private(c);
  for (PetscInt e = 0; e < c->side[0].num_edges; ++e) c->result[e] = -1;
  for (PetscInt i = 0; i < c->num_edges; ++i) c->result[c->edges[i].edge] = i;
  Activity_Private(c);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodal contact forces -dL_c/dx = z_j grad gt_j on both sides; residual r -= force (at the owner, in the node's frame). */
PetscErrorCode ContactForces_Private(Problem p, Contact *c, PetscReal r[])
{
  PetscFunctionBegin;
  for (PetscInt k = 0; k < 2; ++k) PetscCall(PetscArrayzero(c->side[k].force, 2 * c->side[k].num_nodes));
  for (PetscInt i = 0; i < c->num_edges; ++i) {
    const ContactEdge *e = &c->edges[i];
    if (!c->mine[e->edge]) continue;
    for (PetscInt a = 0; a < e->num; ++a) {
      PetscReal *f = c->side[NODE_SIDE(e->nodes[a])].force + 2 * NODE_INDEX(e->nodes[a]);
      for (PetscInt k = 0; k < 2; ++k) {
        f[0] += c->z[e->node[k]] * e->dgap[2 * (k * e->num + a)];
        f[1] += c->z[e->node[k]] * e->dgap[2 * (k * e->num + a) + 1];
      }
    }
  }
  for (PetscInt k = 0; k < 2; ++k) {
    Surface *s = &c->side[k];
    if (p->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->force, (PetscMPIInt)(2 * s->num_nodes), MPIU_REAL, MPI_SUM, p->comm));
    for (PetscInt n = 0; n < s->num_nodes; ++n) {
      if (!s->owned[n]) continue;
      for (PetscInt d = 0; d < 2; ++d) r[2 * s->local[n] + d] -= s->frame[4 * n + 2 * d] * s->force[2 * n] + s->frame[4 * n + 2 * d + 1] * s->force[2 * n + 1];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Complementarity rows into this rank's part of the residual. */
PetscErrorCode ContactRows_Private(Problem p, const Contact *c, PetscReal r[])
{
  PetscFunctionBegin;
  for (PetscInt j = 0; j < c->side[0].num_nodes; ++j) {
    if (c->zlocal[j] < 0) continue;
    r[c->zlocal[j]] = c->w0[j] * (c->active[j] ? c->c[j] * c->gap[j] / c->weight[j] : c->z[j]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
